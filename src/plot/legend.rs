//! Legends and colour keys: what direct labels do not say.
//!
//! Marks with the same role, tone and words are explained once, a line and its points together.

use super::backend::Paper;
use super::colour::{Colour, batlow};
use super::draw::draw_glyph;
use super::frame::{TEXT_SIZE, TICK_SIZE};
use super::label::Label;
use super::mark::Mark;
use super::picture::ToneKey;
use super::rect::{Rect, TextKind};
use super::role::{Level, Marker, Role};
use super::svg::{Document, hundredths};
use super::svg_text::{Anchor, TextStyle};

/// Length of a sample line in points.
const SAMPLE: f64 = 17.0;
/// Between sample and words, in points.
const GAP: f64 = 3.5;
/// Between entries of a strip, in points.
const APART: f64 = 12.0;
/// Height of a line of a legend in points.
pub const LINE: f64 = 10.0;

/// One explanation.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    role: Role,
    tone: Option<f64>,
    line: bool,
    marker: Option<Marker>,
    text: Label,
}

/// The explanations that marks ask for, added to those already there.
pub fn collect(entries: &mut Vec<Entry>, marks: &[Mark]) {
    for mark in marks {
        let (role, tone, text, line, marker) = match mark {
            Mark::Curve(m) => (m.role, m.tone, &m.legend, true, None),
            Mark::SphereCurve(m) => (m.role, m.tone, &m.legend, true, None),
            Mark::Rule(m) => (m.role, None, &m.legend, true, None),
            Mark::Points(m) => (m.role, m.tone, &m.legend, false, Some(m.marker.unwrap_or(m.role.look().marker))),
            Mark::SpherePoints(m) => (m.role, None, &m.legend, false, Some(m.marker.unwrap_or(m.role.look().marker))),
            Mark::Band(m) => (m.role, None, &m.legend, false, None),
            Mark::Area(m) => (m.role, None, &m.legend, false, None),
            Mark::Text(_) | Mark::Arrow(_) => continue,
        };
        let Some(text) = text else { continue };
        let same = |e: &&mut Entry| e.role == role && e.tone == tone && e.text == *text;
        match entries.iter_mut().find(same) {
            Some(entry) => {
                entry.line |= line;
                entry.marker = entry.marker.or(marker);
            }
            None => entries.push(Entry { role, tone, line, marker, text: text.clone() }),
        }
    }
}

fn entry_width(entry: &Entry) -> f64 {
    sample_width(entry) + GAP + entry.text.width(TEXT_SIZE)
}

fn sample_width(entry: &Entry) -> f64 {
    if entry.line {
        SAMPLE
    } else if entry.marker.is_some() {
        5.0
    } else {
        9.0
    }
}

/// Entries in lines no wider than this.
fn wrapped(entries: &[Entry], width: f64) -> Vec<&[Entry]> {
    let mut lines = Vec::new();
    let mut start = 0;
    while start < entries.len() {
        let mut used = entry_width(&entries[start]);
        let mut end = start + 1;
        while end < entries.len() && used + APART + entry_width(&entries[end]) <= width {
            used += APART + entry_width(&entries[end]);
            end += 1;
        }
        lines.push(&entries[start..end]);
        start = end;
    }
    lines
}

/// Height of a strip in points.
pub fn strip_height(entries: &[Entry], width: f64) -> f64 {
    if entries.is_empty() { 0.0 } else { wrapped(entries, width - 8.0).len() as f64 * LINE + 3.0 }
}

/// Draws a strip whose upper edge is at `top`, its lines centred.
pub fn draw_strip(paper: &mut Paper, entries: &[Entry], top: f64, width: f64) {
    if entries.is_empty() {
        return;
    }
    paper.document.open(&[("id", "legend"), ("data-role", "legend")]);
    for (row, line) in wrapped(entries, width - 8.0).into_iter().enumerate() {
        let used = line.iter().map(entry_width).sum::<f64>() + APART * (line.len() as f64 - 1.0);
        let mut left = (width - used) / 2.0;
        for entry in line {
            draw_entry(paper, entry, left, top + 2.0 + LINE * (row as f64 + 0.5));
            left += entry_width(entry) + APART;
        }
    }
    paper.document.close();
}

/// Width and height of a legend in a corner.
pub fn box_size(entries: &[Entry]) -> (f64, f64) {
    (entries.iter().map(entry_width).fold(0.0, f64::max) + 6.0, entries.len() as f64 * LINE + 3.0)
}

/// Draws a legend in a box.
pub fn draw_box(paper: &mut Paper, entries: &[Entry], rect: &Rect, id: &str) {
    let (a, b) = ((hundredths(rect.left), hundredths(rect.top)), (hundredths(rect.right), hundredths(rect.bottom)));
    paper.document.open(&[("id", id), ("data-role", "legend")]);
    paper.document.rect(a, b, true, Colour::WHITE, 0);
    let column = entries.iter().map(sample_width).fold(0.0, f64::max);
    for (row, entry) in entries.iter().enumerate() {
        let indent = (column - sample_width(entry)) / 2.0;
        draw_sample(paper, entry, rect.left + 3.0 + indent, rect.top + 1.5 + LINE * (row as f64 + 0.5));
        words(paper, entry, rect.left + 3.0 + column + GAP, rect.top + 1.5 + LINE * (row as f64 + 0.5));
    }
    paper.document.close();
}

fn draw_entry(paper: &mut Paper, entry: &Entry, left: f64, middle: f64) {
    draw_sample(paper, entry, left, middle);
    words(paper, entry, left + sample_width(entry) + GAP, middle);
}

fn words(paper: &mut Paper, entry: &Entry, left: f64, middle: f64) {
    let style = TextStyle {
        size: TEXT_SIZE,
        colour: Colour::BLACK,
        anchor: Anchor::Start,
        halo: false,
        upright: false,
        kind: TextKind::Legend,
    };
    paper.document.text(&entry.text, (left, middle + 0.36 * TEXT_SIZE), style);
}

fn draw_sample(paper: &mut Paper, entry: &Entry, left: f64, middle: f64) {
    let look = entry.role.look();
    let colour = entry.tone.map_or(look.colour, batlow);
    let y = hundredths(middle);
    if entry.line {
        paper.document.open_lines(&[("data-role", entry.role.id())], colour, look.width, look.dash);
        let ends = [(hundredths(left), y), (hundredths(left + SAMPLE), y)];
        paper.document.path(ends, false, false, colour, hundredths(look.width));
        paper.document.close();
    }
    if let Some(marker) = entry.marker {
        paper.document.open_lines(&[("data-role", entry.role.id())], colour, 0.8, &[]);
        let at = (hundredths(left + sample_width(entry) / 2.0), y);
        let Ok(()) = draw_glyph(paper, at, marker, look.radius, colour, 0.8).map_err(|_| ()) else { return };
        paper.document.close();
    } else if look.level == Level::Fill {
        let (a, b) = ((hundredths(left), y - 300), (hundredths(left + 9.0), y + 300));
        paper.document.rect(a, b, true, colour, 0);
        paper.document.rect(a, b, false, Colour::GREY, 25);
    }
}

/// Width of a colour key in points, the gap to the frame included.
pub fn key_width(key: &ToneKey) -> f64 {
    let widest = key.ticks.iter().map(|(_, label)| label.width(TICK_SIZE)).fold(0.0, f64::max);
    let (up, down) = key.label.extent(TEXT_SIZE);
    let words = if key.label.is_empty() { 0.0 } else { up + down + 2.5 };
    6.0 + 6.0 + 4.0 + widest + words
}

/// Draws a colour key to the right of a frame.
pub fn draw_key(page: &mut Document, key: &ToneKey, frame: &Rect, id: &str) {
    const STEPS: u32 = 64;
    let (left, right) = (frame.right + 6.0, frame.right + 12.0);
    let at = |tone: f64| frame.bottom - tone * frame.height();
    page.open(&[("id", id), ("data-role", "tone-key")]);
    for i in 0..STEPS {
        let (low, high) = (f64::from(i) / f64::from(STEPS), f64::from(i + 1) / f64::from(STEPS));
        // Each step reaches a little under the next, or thin white lines would show between them.
        let top = (at(high) - 0.3).max(frame.top);
        let (a, b) = ((hundredths(left), hundredths(top)), (hundredths(right), hundredths(at(low))));
        page.rect(a, b, true, batlow((low + high) / 2.0), 0);
    }
    let (a, b) = ((hundredths(left), hundredths(frame.top)), (hundredths(right), hundredths(frame.bottom)));
    page.rect(a, b, false, Colour::BLACK, 50);
    let style = |size, anchor, upright| TextStyle {
        size,
        colour: Colour::BLACK,
        anchor,
        halo: false,
        upright,
        kind: TextKind::Legend,
    };
    let mut edge = right;
    for (tone, label) in key.ticks.iter().filter(|(tone, _)| (0.0..=1.0).contains(tone)) {
        let y = hundredths(at(*tone));
        page.path([(hundredths(right), y), (hundredths(right + 1.5), y)], false, false, Colour::BLACK, 50);
        page.text(label, (right + 3.0, at(*tone) + 0.36 * TICK_SIZE), style(TICK_SIZE, Anchor::Start, false));
        edge = edge.max(right + 3.0 + label.width(TICK_SIZE));
    }
    let base = edge + 2.5 + key.label.extent(TEXT_SIZE).0;
    page.text(&key.label, (base, (frame.top + frame.bottom) / 2.0), style(TEXT_SIZE, Anchor::Middle, true));
    page.close();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::mark::{Curve, Points};

    #[test]
    fn a_line_and_its_points_are_explained_once() {
        let line = Curve::new(Role::SeriesA, vec![(0.0, 0.0)]).legend("Taylor");
        let dots = Points::new(Role::SeriesA, vec![(0.0, 0.0)]).legend("Taylor");
        let other = Curve::new(Role::SeriesB, vec![]).legend("Runge");
        let mut entries = Vec::new();
        collect(&mut entries, &[line.into(), dots.into(), other.into()]);
        assert_eq!(entries.len(), 2);
        assert!(entries[0].line && entries[0].marker == Some(Marker::Disc));
    }

    #[test]
    fn lines_are_no_wider_than_the_page() {
        let marks: Vec<Mark> =
            (0..12).map(|i| Curve::new(Role::Geodesic, vec![]).legend(format!("curve number {i}")).into()).collect();
        let mut entries = Vec::new();
        collect(&mut entries, &marks);
        let mut paper = Paper { document: Document::new(89.0, 60.0) };
        draw_strip(&mut paper, &entries, 10.0, 252.28);
        let page = paper.document.page();
        assert!(paper.document.boxes().iter().all(|text| page.holds(&text.rect, 0.0)));
        assert_eq!(strip_height(&entries, 252.28), wrapped(&entries, 244.28).len() as f64 * LINE + 3.0);
    }
}
