//! A wrong config, as data and as a compiler-like message.

use super::place::line_and_column;
use serde::Serialize;
use std::fmt;
use std::ops::{Deref, Range};

/// What is wrong in a config and where, as data: the fields of the machine output.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct ConfigProblem {
    /// The file, as the user would name it.
    pub file: String,
    /// The line, counted from 1.
    pub line: usize,
    /// The column, counted in characters from 1.
    pub column: usize,
    /// The key: `scene.metric.spin.k[1]`; empty where none is concerned (syntax).
    pub key: String,
    /// What was found.
    pub found: String,
    /// What is accepted.
    pub accepted: String,
    /// The accepted key or name most like the one found, where one is alike.
    pub nearest: Option<String>,
    /// What is wrong, in one line.
    pub message: String,
    /// The line of the file.
    pub source_line: String,
    /// The number of characters to mark, from the column on.
    pub width: usize,
}

/// A wrong config. Its fields are those of [`ConfigProblem`]; its `Display` is the message for people.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, thiserror::Error)]
#[serde(transparent)]
pub struct ConfigError(Box<ConfigProblem>);

impl Deref for ConfigError {
    type Target = ConfigProblem;
    fn deref(&self) -> &ConfigProblem {
        &self.0
    }
}

impl ConfigError {
    /// A problem at some bytes of the text. Line, column, source line and width are filled in.
    pub(super) fn at(file: &str, text: &str, span: Range<usize>, problem: ConfigProblem) -> Self {
        let (line, column) = line_and_column(text, span.start);
        let source_line = text.split('\n').nth(line - 1).unwrap_or("").trim_end_matches('\r').to_owned();
        let marked = text.get(span).and_then(|marked| marked.lines().next()).map_or(0, |line| line.chars().count());
        let room = (source_line.chars().count() + 1).saturating_sub(column);
        let width = marked.clamp(1, room.max(1));
        Self(Box::new(ConfigProblem { file: file.to_owned(), line, column, source_line, width, ..problem }))
    }

    /// A problem of a file as a whole, such as one that can't be read: line and column are 1.
    pub fn whole_file(file: impl Into<String>, message: impl Into<String>, accepted: impl Into<String>) -> Self {
        let (file, message, accepted) = (file.into(), message.into(), accepted.into());
        Self(Box::new(ConfigProblem { file, line: 1, column: 1, width: 1, message, accepted, ..Default::default() }))
    }

    /// What to do next, in one line.
    pub fn next_action(&self) -> String {
        match (&self.nearest, self.key.is_empty()) {
            (Some(nearest), _) => format!("did you mean `{nearest}`?"),
            (None, true) => format!("correct {} and run again", self.file),
            (None, false) => format!("correct `{}` in {} and run again", self.key, self.file),
        }
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.line.to_string();
        let gutter = " ".repeat(number.len());
        writeln!(f, "{}", self.message)?;
        writeln!(f, "{gutter}--> {}:{}:{}", self.file, self.line, self.column)?;
        if !self.source_line.is_empty() {
            // Tabs stay tabs, so that the caret stands where the terminal shows the value.
            let before = self.source_line.chars().take(self.column - 1);
            let blank: String = before.map(|c| if c == '\t' { '\t' } else { ' ' }).collect();
            writeln!(f, "{gutter} |\n{number} | {}", self.source_line)?;
            writeln!(f, "{gutter} | {blank}{}", "^".repeat(self.width))?;
        }
        for (name, value) in [("key", &self.key), ("found", &self.found), ("accepted", &self.accepted)] {
            if !value.is_empty() {
                writeln!(f, "{gutter} = {name}: {value}")?;
            }
        }
        write!(f, "{gutter} = next: {}", self.next_action())
    }
}
