//! The command `polhode`: arguments, one file a verb, progress, exit codes.

pub mod arguments;
pub mod check;
pub mod collected;
pub mod console;
pub mod dispatch;
pub mod exit;
pub mod figures;
pub mod graph;
pub mod list;
pub mod new;
pub mod point;
pub mod progress;
pub mod session;
pub mod show;
pub mod version;
pub mod why;
pub mod workspace;
