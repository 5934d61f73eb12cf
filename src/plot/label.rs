//! Texts with italics, sub- and superscripts, and the room they take.
//!
//! Markup: `*p*` is italic, `**a**` bold, `_x` and `_{…}` a subscript, `^x` and `^{…}` a superscript (one character, or an
//! italic group, or braces), a combining macron (k̄) a line over the character before it, `\` takes the next character as it
//! is. A sub- and a superscript that follow each other stand one over the other. Every string is a valid label: a mark that
//! is never closed is text. A hyphen before a digit stays a hyphen: write the minus sign `−` (U+2212).

use super::font;
use std::fmt::Write as _;

/// Where a run of letters stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Script {
    /// On the base line.
    Base,
    /// Subscript.
    Sub,
    /// Superscript.
    Super,
}

/// Letters that look alike.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The letters.
    pub text: String,
    /// Slanted.
    pub italic: bool,
    /// Heavy.
    pub bold: bool,
    /// With a line over it.
    pub over: bool,
    /// Where they stand.
    pub script: Script,
}

/// A text with italics, sub- and superscripts.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Label {
    runs: Vec<Run>,
}

impl From<&str> for Label {
    fn from(markup: &str) -> Self {
        Label::parse(markup)
    }
}

impl From<String> for Label {
    fn from(markup: String) -> Self {
        Label::parse(&markup)
    }
}

impl From<&String> for Label {
    fn from(markup: &String) -> Self {
        Label::parse(markup)
    }
}

/// The style in which the parser appends letters.
#[derive(Clone, Copy)]
struct Style {
    italic: bool,
    bold: bool,
    script: Script,
}

impl Label {
    /// Reads the markup (see the module).
    pub fn parse(markup: &str) -> Self {
        let letters: Vec<char> = markup.chars().collect();
        let mut label = Label::default();
        label.read(&letters, Style { italic: false, bold: false, script: Script::Base });
        label
    }

    /// Letters exactly as they are: no markup is read.
    pub fn plain(text: &str) -> Self {
        let mut label = Label::default();
        for letter in text.chars() {
            label.push(letter, Style { italic: false, bold: false, script: Script::Base }, false);
        }
        label
    }

    /// The same text, bold.
    pub fn bold(mut self) -> Self {
        for run in &mut self.runs {
            run.bold = true;
        }
        self
    }

    /// This label followed by another.
    pub fn then(mut self, other: &Label) -> Self {
        self.runs.extend(other.runs.iter().cloned());
        self
    }

    /// The runs, in order.
    pub fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// The letters without their looks; sub- and superscripts stay marked by `_` and `^`.
    pub fn to_plain(&self) -> String {
        let mut plain = String::new();
        let mut script = Script::Base;
        for run in &self.runs {
            if run.script != script {
                match run.script {
                    Script::Base => {}
                    Script::Sub => plain.push('_'),
                    Script::Super => plain.push('^'),
                }
                script = run.script;
            }
            let _ = write!(plain, "{}", run.text);
        }
        plain
    }

    fn push(&mut self, letter: char, style: Style, over: bool) {
        match self.runs.last_mut() {
            Some(run)
                if run.italic == style.italic
                    && run.bold == style.bold
                    && run.script == style.script
                    && run.over == over =>
            {
                run.text.push(letter);
            }
            _ => self.runs.push(Run {
                text: letter.to_string(),
                italic: style.italic,
                bold: style.bold,
                over,
                script: style.script,
            }),
        }
    }

    fn read(&mut self, letters: &[char], style: Style) {
        let mut at = 0;
        while at < letters.len() {
            match letters[at] {
                '\\' if at + 1 < letters.len() => {
                    self.push(letters[at + 1], style, false);
                    at += 2;
                }
                '*' if letters.get(at + 1) == Some(&'*') => match find(letters, at + 2, &['*', '*']) {
                    Some(end) => {
                        self.read(&letters[at + 2..end], Style { bold: true, ..style });
                        at = end + 2;
                    }
                    None => {
                        self.push('*', style, false);
                        self.push('*', style, false);
                        at += 2;
                    }
                },
                '*' => match find(letters, at + 1, &['*']) {
                    Some(end) => {
                        self.read(&letters[at + 1..end], Style { italic: true, ..style });
                        at = end + 1;
                    }
                    None => {
                        self.push('*', style, false);
                        at += 1;
                    }
                },
                mark @ ('_' | '^') if style.script == Script::Base && at + 1 < letters.len() => {
                    let script = if mark == '_' { Script::Sub } else { Script::Super };
                    at = self.read_script(letters, at + 1, Style { script, ..style });
                }
                letter => {
                    let over = matches!(letters.get(at + 1), Some('\u{304}' | '\u{305}'));
                    self.push(letter, style, over);
                    at += if over { 2 } else { 1 };
                }
            }
        }
    }

    /// Reads what follows a script mark: braces, an italic group, or one character. Returns where reading goes on.
    fn read_script(&mut self, letters: &[char], at: usize, style: Style) -> usize {
        let style = Style { italic: false, ..style };
        match letters[at] {
            '{' => match find(letters, at + 1, &['}']) {
                Some(end) => {
                    self.read(&letters[at + 1..end], style);
                    end + 1
                }
                None => {
                    self.push('{', style, false);
                    at + 1
                }
            },
            '*' => match find(letters, at + 1, &['*']) {
                Some(end) => {
                    self.read(&letters[at..=end], style);
                    end + 1
                }
                None => {
                    self.push('*', style, false);
                    at + 1
                }
            },
            letter => {
                let over = matches!(letters.get(at + 1), Some('\u{304}' | '\u{305}'));
                self.push(letter, style, over);
                if over { at + 2 } else { at + 1 }
            }
        }
    }

    /// Where each run starts, and where the text ends, in points, at this font size.
    pub fn advances(&self, size: f64) -> (Vec<f64>, f64) {
        let mut starts = Vec::with_capacity(self.runs.len());
        let (mut pen, mut group_start, mut group_end) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut previous = Script::Base;
        for run in &self.runs {
            // A script that follows the other kind of script starts where that one started.
            let stacked = run.script != Script::Base && previous != Script::Base && run.script != previous;
            if run.script == Script::Base {
                pen = pen.max(group_end);
            } else if stacked {
                group_end = group_end.max(pen);
                pen = group_start;
            } else if previous == Script::Base {
                group_start = pen;
            }
            starts.push(pen);
            pen += run_width(run, size);
            group_end = group_end.max(pen);
            previous = run.script;
        }
        (starts, pen.max(group_end))
    }

    /// Width in points at this font size.
    pub fn width(&self, size: f64) -> f64 {
        self.advances(size).1
    }

    /// Height over and depth under the base line, in points, at this font size.
    pub fn extent(&self, size: f64) -> (f64, f64) {
        let has = |script| self.runs.iter().any(|run| run.script == script);
        let up = if has(Script::Super) {
            font::SUPER_SHIFT + font::SCRIPT_SIZE * font::CAP_HEIGHT
        } else {
            font::CAP_HEIGHT
        };
        let down = if has(Script::Sub) { font::SUB_SHIFT + font::SCRIPT_SIZE * font::DESCENT } else { font::DESCENT };
        (up.max(font::CAP_HEIGHT) * size, down.max(font::DESCENT) * size)
    }
}

/// Width of one run in points.
pub fn run_width(run: &Run, size: f64) -> f64 {
    let size = if run.script == Script::Base { size } else { size * font::SCRIPT_SIZE };
    let thousandths: u32 = run.text.chars().map(|letter| u32::from(font::advance(letter, run.bold))).sum();
    f64::from(thousandths) * size / 1000.0
}

/// The first place at or after `from` where `what` stands outside braces and escapes.
fn find(letters: &[char], from: usize, what: &[char]) -> Option<usize> {
    let mut at = from;
    while at + what.len() <= letters.len() {
        if letters[at] == '\\' {
            at += 2;
            continue;
        }
        if letters[at..].starts_with(what) {
            return Some(at);
        }
        at += 1;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shape(markup: &str) -> Vec<(String, bool, Script)> {
        Label::parse(markup).runs.into_iter().map(|run| (run.text, run.italic, run.script)).collect()
    }

    #[test]
    fn scripts_and_italics() {
        let base = Script::Base;
        assert_eq!(
            shape("*p*_θ = 10^{−4}"),
            [
                ("p".into(), true, base),
                ("θ".into(), false, Script::Sub),
                (" = 10".into(), false, base),
                ("−4".into(), false, Script::Super)
            ]
        );
        assert_eq!(
            shape("*p*_*θ*x"),
            [("p".into(), true, base), ("θ".into(), true, Script::Sub), ("x".into(), false, base)]
        );
    }

    #[test]
    fn whatever_is_not_closed_is_text() {
        for text in ["*", "**", "a*b", "_", "a_", "a^", "_{", "x^{2", "\\", "**bold*"] {
            let plain: String = Label::parse(text).to_plain();
            assert!(!plain.is_empty(), "{text}");
        }
        assert_eq!(Label::parse("a\\_b\\*").to_plain(), "a_b*");
        assert_eq!(Label::parse("").runs().len(), 0);
    }

    #[test]
    fn a_macron_becomes_a_line_over_the_letter() {
        let label = Label::parse("*k\u{304}*′");
        assert_eq!(label.runs().iter().map(|run| run.over).collect::<Vec<_>>(), [true, false]);
        assert_eq!(label.to_plain(), "k′");
    }

    #[test]
    fn widths_are_those_of_helvetica() {
        // Helvetica AFM: H 722, e 556, l 222, v 500, t 278, i 222, c 500, a 556.
        let expected = f64::from(722 + 556 + 222 + 500 + 556 + 278 + 222 + 500 + 556) * 8.0 / 1000.0;
        assert!((Label::plain("Helvetica").width(8.0) - expected).abs() < 1e-12);
    }

    #[test]
    fn scripts_stand_over_each_other() {
        let both = Label::parse("x_{12}^2y");
        let (starts, width) = both.advances(10.0);
        assert_eq!(starts[1], starts[2]);
        assert_eq!(starts[3], starts[1] + run_width(&both.runs()[1], 10.0));
        assert!((width - (5.0 + 2.0 * 5.56 * font::SCRIPT_SIZE + 5.0)).abs() < 1e-12);
    }
}
