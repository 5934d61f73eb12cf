//! A text as SVG: its element with a tspan for each run, and the box that it takes.

use super::colour::Colour;
use super::font;
use super::label::{Label, Run, Script, run_width};
use super::rect::{Rect, TextKind};
use super::svg::{escape, hundredths, text_of};
use std::fmt::Write as _;

/// Which point of a text its position is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

/// How a text is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextStyle {
    /// Font size in points.
    pub size: f64,
    /// Colour.
    pub colour: Colour,
    /// Which point of it its position is (vertically: always the base line).
    pub anchor: Anchor,
    /// With a white rim.
    pub halo: bool,
    /// Turned by a quarter, to be read from the right side of the page.
    pub upright: bool,
    /// What it is for.
    pub kind: TextKind,
}

/// The box a text would take, in points, with its base line at `at`.
pub fn text_rect(label: &Label, at: (f64, f64), size: f64, anchor: Anchor, upright: bool) -> Rect {
    let width = label.width(size);
    let (up, down) = label.extent(size);
    let before = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => width / 2.0,
        Anchor::End => width,
    };
    if upright {
        // Read from the right: letters run upwards, their tops to the left.
        Rect { left: at.0 - up, right: at.0 + down, top: at.1 - (width - before), bottom: at.1 + before }
    } else {
        Rect { left: at.0 - before, right: at.0 - before + width, top: at.1 - up, bottom: at.1 + down }
    }
}

/// The text element with its base line at `at` (points).
pub fn element(label: &Label, at: (f64, f64), style: TextStyle) -> String {
    let (x, y) = (text_of(hundredths(at.0)), text_of(hundredths(at.1)));
    let mut out = String::new();
    let _ = write!(out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"", text_of(hundredths(style.size)));
    let _ = write!(out, " fill=\"{}\"", style.colour.hex());
    match style.anchor {
        Anchor::Start => {}
        Anchor::Middle => out.push_str(" text-anchor=\"middle\""),
        Anchor::End => out.push_str(" text-anchor=\"end\""),
    }
    if style.halo {
        out.push_str(" stroke=\"#ffffff\" stroke-width=\"1.5\" paint-order=\"stroke\"");
    }
    if style.upright {
        let _ = write!(out, " transform=\"rotate(-90 {x} {y})\"");
    }
    out.push('>');
    let (starts, _) = label.advances(style.size);
    let (mut shift, mut pen) = (0, 0.0_f64);
    for (run, start) in label.runs().iter().zip(starts) {
        tspan(&mut out, run, style.size, start - pen, &mut shift);
        pen = start + run_width(run, style.size);
    }
    out.push_str("</text>\n");
    out
}

/// One run as a tspan: moved by `move_by` points from where the pen is, raised or lowered from the current `shift`.
fn tspan(out: &mut String, run: &Run, size: f64, move_by: f64, shift: &mut i32) {
    let wanted = match run.script {
        Script::Base => 0,
        Script::Sub => hundredths(font::SUB_SHIFT * size),
        Script::Super => -hundredths(font::SUPER_SHIFT * size),
    };
    let mut attributes = String::new();
    let dx = hundredths(move_by);
    if dx != 0 {
        let _ = write!(attributes, " dx=\"{}\"", text_of(dx));
    }
    if wanted != *shift {
        let _ = write!(attributes, " dy=\"{}\"", text_of(wanted - *shift));
        *shift = wanted;
    }
    if run.script != Script::Base {
        let _ = write!(attributes, " font-size=\"{}\"", text_of(hundredths(font::SCRIPT_SIZE * size)));
    }
    if run.italic {
        attributes.push_str(" font-style=\"italic\"");
    }
    if run.bold {
        attributes.push_str(" font-weight=\"bold\"");
    }
    if run.over {
        attributes.push_str(" text-decoration=\"overline\"");
    }
    let letters = escape(&run.text);
    let _ = if attributes.is_empty() {
        write!(out, "{letters}")
    } else {
        write!(out, "<tspan{attributes}>{letters}</tspan>")
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_are_moved_and_moved_back() {
        let style = TextStyle {
            size: 10.0,
            colour: Colour::BLACK,
            anchor: Anchor::Start,
            halo: false,
            upright: false,
            kind: TextKind::Direct,
        };
        let text = element(&Label::parse("x_1^2y"), (10.0, 20.0), style);
        // 5.56·0.72 = 4.00 back to the start of the subscript; −3.6 − 1.8 up; 3.6 down again.
        assert!(text.contains(">x<tspan dy=\"1.8\" font-size=\"7.2\">1</tspan>"), "{text}");
        assert!(
            text.contains("<tspan dx=\"-4\" dy=\"-5.4\" font-size=\"7.2\">2</tspan><tspan dy=\"3.6\">y</tspan>"),
            "{text}"
        );
    }
}
