//! The runner: constructive traces one level deep over a content-addressed store.
//!
//! It knows nodes, keys and bytes, and has never heard of a geodesic. The caller plans ([`Plan`]s from experiments),
//! the rest goes in four steps, none of which prints:
//!
//! ```text
//! let graph     = Graph::join(plans)?;                  // all defects of the plans as values
//! let selection = graph.select(&targets)?;              // experiment ids, output paths, addresses; none: everything
//! let store     = Store::below(&root);                  // touches nothing yet
//! let options   = Options::new(&root, &out);
//! let report    = run(&graph, &selection, &store, &options, &mut events);   // or forecast(…), why(…), stored(…)
//! ```
//!
//! - [`run`](run::run) brings store and outputs to where they should be. Its [`Report`](report::Report) has everything a
//!   caller shows: per node status, work, time; per output what became of it; damage and repairs; failures.
//!   [`Outcome`](report::Outcome) maps to the exit code.
//! - [`forecast`](forecast::forecast) says what `run` would do, writing nothing: `--dry-run`.
//! - [`why`](why::why) is the forecast of what stands behind one target, with the origin of its present bytes.
//! - [`stored`](stored::stored) gives a stored artifact by address, for `show` and `check`;
//!   [`Store::artifact`](store::Store::artifact) by key, for old values ([`NodeReport::previous`](report::NodeReport)).
//! - [`verify`](verify::verify) reads the whole store and computes a sample of it again; [`gc`](gc::gc) drops what no last
//!   run needs.
//! - [`settled`](settled::settled) says, before anything is planned, that a whole run would find nothing to do.
//! - [`Events`](events::Events) hears of everything as it happens, on the caller's thread.
//!
//! Nodes run on threads of their own, at most `jobs` at once; what they do in parallel inside goes to rayon's global
//! pool, which the caller sizes. Panics are caught here; whoever does not want rust's own message about them sets a hook.
//!
//! Map: `graph` joins plans, `select` finds what targets need; `schedule` decides what runs (its states are listed there;
//! `examine` and `start` are its two questions), `work` does it; `record`,
//! `store`, `format`, `heads`, `settled`, `runs` are the files of the store, `disk` all calls to the file system (with a place for fault
//! injection), `exports` the output folder; `forecast`, `reason`, `locate`, `why` explain; `render` writes the graph, `diagram` and `picture` draw it.
//!
//! Invariants: nothing is believed that was not hashed in this run. Objects are durable before the record that names
//! them. A lock is taken before its node starts, and never waited for on a pool's thread. No time, host or path enters a
//! record. Nothing here deletes a file that it did not make; only `gc` deletes results, and never a lock file.
//!
//! [`Plan`]: crate::contract::plan::Plan

mod diagram;
pub mod disk;
pub mod events;
mod examine;
mod exports;
pub mod forecast;
pub mod format;
pub mod gc;
pub mod graph;
pub mod heads;
mod locate;
mod parallel;
mod picture;
pub mod reason;
pub mod record;
pub mod render;
pub mod report;
pub mod run;
pub mod runs;
mod schedule;
pub mod select;
pub mod settled;
mod start;
pub mod store;
pub mod stored;
pub mod verify;
pub mod why;
mod work;
