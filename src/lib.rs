//! `polhode` regenerates the article *Riemannian metrics on 2D-manifolds related to the Euler-Poinsot rigid body motion*
//! (Bonnard, Cots, Pomet, Shcherbakova, ESAIM COCV 20, 2014) from its experiment configs: every figure, every number, with
//! the same bits on every machine. It is a command, `polhode`, and this library.
//!
//! # Bird's eye
//!
//! A config (`experiments/fig7.toml`) says what is wanted. Its experiment turns it into *nodes*: pieces of work that know
//! their parameters and inputs. The runner gives every node a key, the digest of all that its result depends on, and runs
//! those whose key the store does not have. Compute nodes make tables (Parquet); a picture node draws them (SVG); a findings
//! node reads named values and evidence for the article's claims off them. Verdicts follow from evidence by fixed rules.
//!
//! ```text
//! experiments/*.toml ─▶ experiments ─▶ nodes ─▶ pipeline ─▶ store ─▶ figures/*.svg, data/**.parquet, values.toml
//!                          │  asks for            │ runs
//!                          ▼                      ▼
//!                       effects ─▶ geometry ─▶ numerics
//! ```
//!
//! # The rooms
//!
//! | room | holds | may use |
//! |---|---|---|
//! | [`numerics`] | elliptic functions, power series, roots, double-double: pure mathematics | outside crates |
//! | [`geometry`] | the article's mathematics: the three metrics, their flows, closed forms | numerics |
//! | [`effects`] | node kinds: conjugate locus, geodesics, wave front, …; single points | geometry, numerics, table, contract |
//! | [`table`] | typed columns with unit and meaning, to and from Parquet and CSV; alone names polars | outside crates |
//! | [`plot`] | pictures: roles, panels, axes, spheres, SVG; alone names plotters | outside crates |
//! | [`contract`] | what experiments, effects and the runner promise each other | outside crates |
//! | [`experiments`] | one file an experiment: what it asks for, draws, names and claims | effects, contract, table, plot |
//! | [`pipeline`] | graph, keys, store, scheduler; has never heard of a geodesic | contract |
//! | [`check`] | verdicts, goldens, references, `values.toml` | contract, table |
//! | [`cli`] | arguments, one file a verb, progress, exit codes; alone joins experiments to the pipeline | all |
//!
//! `tests/layers.rs` fails on any other arrow. The same arrows decide what a change of code makes stale.
//!
//! # Invariants
//!
//! - Only IEEE-exact operations and the `libm` crate reach a result; no sum depends on the order of threads.
//! - A compute kind knows no figure, a picture does no numerics, a table holds no NaN that its schema does not allow.
//! - Every conjugate time has a second, independent route beside it in the data.
//! - Nothing is believed that was not hashed in this run; an output's bytes depend on experiment, config values and tables only.
//! - The library never prints, panics on input, or exits; errors are values that carry data and say what to do next.
//!
//! # Where to begin
//!
//! One point: [`effects::point::answer`]. One formula: [`geometry`]. A new figure: `polhode new fig10`.

pub mod article;
pub mod check;
pub mod cli;
pub mod contract;
pub mod effects;
pub mod experiments;
pub mod geometry;
pub mod numerics;
pub mod pipeline;
pub mod plot;
pub mod table;
