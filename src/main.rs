//! The `polhode` command.
fn main() {}
