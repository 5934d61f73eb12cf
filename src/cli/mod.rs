//! The command `polhode`: arguments, one file a verb, progress, exit codes.

pub mod arguments;
pub mod check;
pub mod collected;
pub mod completions;
pub mod console;
pub mod dispatch;
pub mod exit;
pub mod figures;
pub mod gc;
pub mod graph;
pub mod init;
pub mod list;
pub mod log;
pub mod new;
pub mod page;
pub mod point;
pub mod progress;
pub mod session;
pub mod show;
pub mod verify;
pub mod version;
pub mod watch;
pub mod why;
pub mod workspace;
