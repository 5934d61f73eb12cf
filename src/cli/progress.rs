//! Shows a run while it goes on: one line that is written over on a terminal, plain lines elsewhere.

use crate::cli::console;
use crate::contract::node::Address;
use crate::contract::work::Work;
use crate::pipeline::events::{Events, Progress};
use crate::pipeline::report::{Damage, Failure};
use std::io::{IsTerminal, Write};
use std::time::Duration;

/// How much is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// One line that is written over.
    Line,
    /// A line for every node that ran.
    Plain,
    /// Only what went wrong.
    Quiet,
}

impl Style {
    /// The style that fits standard error.
    pub fn fitting(no_progress: bool) -> Self {
        match (no_progress, std::io::stderr().is_terminal()) {
            (true, _) => Self::Quiet,
            (false, true) => Self::Line,
            (false, false) => Self::Plain,
        }
    }
}

/// Listens to a run and shows it.
pub struct Shown {
    style: Style,
    running: Vec<String>,
    line_is_up: bool,
}

impl Shown {
    /// A listener.
    pub fn new(style: Style) -> Self {
        Self { style, running: Vec::new(), line_is_up: false }
    }

    fn say(&mut self, text: &str) {
        self.clear();
        console::message(text);
    }

    /// Takes the line away.
    pub fn clear(&mut self) {
        if self.line_is_up {
            let _ = write!(std::io::stderr().lock(), "\r\x1b[K");
            self.line_is_up = false;
        }
    }

    fn ended(&mut self, address: &Address) {
        let address = address.to_string();
        self.running.retain(|running| *running != address);
    }
}

impl Events for Shown {
    fn started(&mut self, address: &Address, _last: Option<Duration>) {
        self.running.push(address.to_string());
    }

    fn finished(&mut self, address: &Address, duration: Duration, _work: &Work) {
        self.ended(address);
        if self.style == Style::Plain {
            self.say(&format!("ran {address} in {:.2} s", duration.as_secs_f64()));
        }
    }

    fn failed(&mut self, address: &Address, failure: &Failure) {
        self.ended(address);
        self.say(&format!("{} {address}: {failure}", console::paint("failed", "1;31")));
    }

    fn waiting(&mut self, address: Option<&Address>, holder: &str) {
        let what = address.map_or_else(|| "the run".to_owned(), ToString::to_string);
        self.say(&format!("{what} waits: {holder}"));
    }

    fn damaged(&mut self, damage: &Damage) {
        self.say(&format!("{} {damage}", console::paint("repair:", "33")));
    }

    fn noted(&mut self, note: &str) {
        self.say(&format!("note: {note}"));
    }

    fn unknown_file(&mut self, path: &str) {
        self.say(&format!("note: {path} in the output folder is made by no experiment; it is left alone"));
    }

    fn tick(&mut self, progress: Progress) {
        if self.style != Style::Line || progress.running == 0 {
            return;
        }
        let mut line = format!("[{}/{}]", progress.settled, progress.nodes);
        if !progress.remaining.is_zero() {
            line.push_str(&format!(" about {:.0} s left,", progress.remaining.as_secs_f64().max(1.0)));
        }
        line.push(' ');
        line.push_str(&self.running.join(", "));
        let short: String = line.chars().take(100).collect();
        let _ = write!(std::io::stderr().lock(), "\r\x1b[K{short}");
        let _ = std::io::stderr().flush();
        self.line_is_up = true;
    }
}
