//! The SVG document: groups, paths, texts, clip paths; sizes in millimetres, coordinates in points.
//!
//! Everything that reaches the page is a whole number of hundredths of a point, written exactly. The document remembers the
//! box of every text, so that a test can ask whether texts overlap or leave the page. It knows no time, host or path.

use super::colour::Colour;
use super::error::PlotError;
use super::label::Label;
use super::pdf::Ink;
use super::rect::{Rect, TextBox};
use super::svg_text::{TextStyle, element, text_rect};
use std::fmt::Write as _;

/// Points in a millimetre: 72/25.4.
pub const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// The line and fill that shapes inherit from their group.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pen {
    colour: Colour,
    width: i32,
    filled: bool,
}

/// An SVG document under way.
#[derive(Debug)]
pub struct Document {
    width: i32,
    height: i32,
    width_mm: f64,
    height_mm: f64,
    defs: String,
    body: String,
    pens: Vec<Option<Pen>>,
    panel: Option<usize>,
    boxes: Vec<TextBox>,
    notes: Vec<String>,
    ink: Ink,
}

/// Points to whole hundredths.
pub fn hundredths(points: f64) -> i32 {
    libm::round(points * 100.0) as i32
}

/// Writes hundredths as a decimal number without needless zeros.
fn number(out: &mut String, value: i32) {
    let size = value.unsigned_abs();
    let sign = if value < 0 { "-" } else { "" };
    let _ = match size % 100 {
        0 => write!(out, "{sign}{}", size / 100),
        part if part % 10 == 0 => write!(out, "{sign}{}.{}", size / 100, part / 10),
        part => write!(out, "{sign}{}.{part:02}", size / 100),
    };
}

/// Hundredths as a decimal number.
pub(super) fn text_of(value: i32) -> String {
    let mut out = String::new();
    number(&mut out, value);
    out
}

/// The points of a line without those that lie within a hundredth of a point of the line through the others (Ramer, Douglas
/// and Peucker). All products are whole numbers below 2^53, so `f64` compares them exactly or rounds them alike everywhere.
fn simplified(points: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let mut keep = vec![false; points.len()];
    let mut open = Vec::new();
    if let Some(last) = points.len().checked_sub(1) {
        (keep[0], keep[last]) = (true, true);
        open.push((0, last));
    }
    while let Some((from, to)) = open.pop() {
        let (a, b) = (points[from], points[to]);
        let (dx, dy) = (f64::from(b.0 - a.0), f64::from(b.1 - a.1));
        let size = dx * dx + dy * dy;
        let (mut farthest, mut worst) = (from, 1.0);
        for (i, p) in points.iter().enumerate().take(to).skip(from + 1) {
            let (x, y) = (f64::from(p.0 - a.0), f64::from(p.1 - a.1));
            let forward = x * dx + y * dy;
            // Squared distance from the segment (not from the line through it: a curve may turn back), times 1.
            let distance = if forward <= 0.0 {
                x * x + y * y
            } else if forward >= size {
                (x - dx) * (x - dx) + (y - dy) * (y - dy)
            } else {
                let cross = x * dy - y * dx;
                cross * cross / size
            };
            if distance > worst {
                (farthest, worst) = (i, distance);
            }
        }
        if farthest != from {
            keep[farthest] = true;
            open.push((from, farthest));
            open.push((farthest, to));
        }
    }
    points.iter().zip(keep).filter_map(|(&point, keep)| keep.then_some(point)).collect()
}

/// Writes a text so that XML reads it back; characters that XML forbids become U+FFFD.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\t' | '\n' => out.push(letter),
            '\u{0}'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => out.push('\u{fffd}'),
            _ => out.push(letter),
        }
    }
    out
}

impl Document {
    /// An empty page.
    pub fn new(width_mm: f64, height_mm: f64) -> Self {
        Self {
            width: hundredths(width_mm * POINTS_PER_MM),
            height: hundredths(height_mm * POINTS_PER_MM),
            width_mm,
            height_mm,
            defs: String::new(),
            body: String::new(),
            pens: Vec::new(),
            panel: None,
            boxes: Vec::new(),
            notes: Vec::new(),
            ink: Ink::new(hundredths(height_mm * POINTS_PER_MM)),
        }
    }

    /// Size of the page in hundredths of a point.
    pub fn size(&self) -> (u32, u32) {
        (self.width.unsigned_abs(), self.height.unsigned_abs())
    }

    /// The page as a rectangle.
    pub fn page(&self) -> Rect {
        Rect { left: 0.0, top: 0.0, right: f64::from(self.width) / 100.0, bottom: f64::from(self.height) / 100.0 }
    }

    /// The boxes of all texts written so far.
    pub fn boxes(&self) -> &[TextBox] {
        &self.boxes
    }

    /// What went wrong with the layout without stopping it.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Remembers that something went wrong with the layout.
    pub fn note(&mut self, what: String) {
        self.notes.push(what);
    }

    /// The panel to which the following texts belong.
    pub fn set_panel(&mut self, panel: Option<usize>) {
        self.panel = panel;
    }

    fn indent(&mut self) {
        let depth = self.pens.len() + 1;
        self.body.extend(std::iter::repeat_n(' ', depth));
    }

    /// Opens a group with these attributes (values are escaped).
    pub fn open(&mut self, attributes: &[(&str, &str)]) {
        self.indent();
        self.body.push_str("<g");
        for (key, value) in attributes {
            let _ = write!(self.body, " {key}=\"{}\"", escape(value));
        }
        self.body.push_str(">\n");
        self.ink.open(attributes);
        let inherited = self.pens.last().copied().flatten();
        self.pens.push(inherited);
    }

    /// Opens a layer of lines: its shapes inherit colour, width and dash.
    pub fn open_lines(&mut self, attributes: &[(&str, &str)], colour: Colour, width: f64, dash: &[f64]) {
        let pattern: Vec<String> = dash.iter().map(|&length| text_of(hundredths(length))).collect();
        let (stroke, thick, pattern) = (colour.hex(), text_of(hundredths(width)), pattern.join(" "));
        let mut all = attributes.to_vec();
        all.extend([("fill", "none"), ("stroke", stroke.as_str()), ("stroke-width", thick.as_str())]);
        all.push(("stroke-linecap", if dash.is_empty() { "round" } else { "butt" }));
        if !dash.is_empty() {
            all.push(("stroke-dasharray", pattern.as_str()));
        }
        self.open(&all);
        self.ink.dash(dash);
        self.set_pen(Pen { colour, width: hundredths(width), filled: false });
    }

    /// Opens a layer of fills: its shapes inherit the colour.
    pub fn open_fills(&mut self, attributes: &[(&str, &str)], colour: Colour) {
        let paint = colour.hex();
        let mut all = attributes.to_vec();
        all.extend([("fill", paint.as_str()), ("stroke", "none")]);
        self.open(&all);
        self.set_pen(Pen { colour, width: 0, filled: true });
    }

    fn set_pen(&mut self, pen: Pen) {
        if let Some(last) = self.pens.last_mut() {
            *last = Some(pen);
        }
    }

    /// Closes the group opened last.
    pub fn close(&mut self) {
        self.pens.pop();
        self.ink.close();
        self.indent();
        self.body.push_str("</g>\n");
    }

    /// Defines a rectangle to clip with, in hundredths of a point.
    pub fn clip(&mut self, id: &str, (left, top): (i32, i32), (right, bottom): (i32, i32)) {
        self.ink.clip(id, (left, top), (right, bottom));
        let _ = write!(self.defs, "  <clipPath id=\"{}\"><rect", escape(id));
        for (key, value) in [("x", left), ("y", top), ("width", right - left), ("height", bottom - top)] {
            let _ = write!(self.defs, " {key}=\"{}\"", text_of(value));
        }
        self.defs.push_str("/></clipPath>\n");
    }

    /// What a shape must say because its group does not.
    fn paint(&self, colour: Colour, width: i32, filled: bool) -> String {
        let pen = self.pens.last().copied().flatten();
        let mut out = String::new();
        let same = pen.is_some_and(|pen| pen.filled == filled && pen.colour == colour);
        if filled && !same {
            let _ = write!(out, " fill=\"{}\"", colour.hex());
            if pen.is_some_and(|pen| !pen.filled) {
                out.push_str(" stroke=\"none\"");
            }
        } else if !filled {
            if pen.is_none_or(|pen| pen.filled) {
                out.push_str(" fill=\"none\"");
            }
            if !same {
                let _ = write!(out, " stroke=\"{}\"", colour.hex());
            }
            if pen.is_none_or(|pen| pen.filled || pen.width != width) {
                let _ = write!(out, " stroke-width=\"{}\"", text_of(width));
            }
        }
        out
    }

    /// A polygonal line, or a filled or closed polygon. Of an open line only the points are written that move it by more
    /// than a hundredth of a point; a single point draws nothing.
    pub fn path(
        &mut self,
        points: impl IntoIterator<Item = (i32, i32)>,
        closed: bool,
        filled: bool,
        colour: Colour,
        width: i32,
    ) {
        let mut points: Vec<(i32, i32)> = points.into_iter().collect();
        points.dedup();
        if !closed {
            points = simplified(&points);
        }
        if points.len() < 2 {
            return;
        }
        self.ink.path(&points, closed, filled, colour, width);
        let mut data = String::new();
        for (count, point) in points.into_iter().enumerate() {
            // The first command after M is L; further points need no letter.
            data.push_str(match count {
                0 => "M",
                1 => "L",
                _ => " ",
            });
            number(&mut data, point.0);
            if point.1 >= 0 {
                data.push(' ');
            }
            number(&mut data, point.1);
        }
        if closed {
            data.push('Z');
        }
        self.indent();
        let paint = self.paint(colour, width, filled);
        let _ = writeln!(self.body, "<path d=\"{data}\"{paint}/>");
    }

    /// A rectangle.
    pub fn rect(&mut self, a: (i32, i32), b: (i32, i32), filled: bool, colour: Colour, width: i32) {
        let (left, top) = (a.0.min(b.0), a.1.min(b.1));
        self.ink.rect(a, b, filled, colour, width);
        self.indent();
        self.body.push_str("<rect");
        for (key, value) in [("x", left), ("y", top), ("width", (a.0 - b.0).abs()), ("height", (a.1 - b.1).abs())] {
            let _ = write!(self.body, " {key}=\"{}\"", text_of(value));
        }
        let paint = self.paint(colour, width, filled);
        let _ = writeln!(self.body, "{paint}/>");
    }

    /// A circle.
    pub fn circle(&mut self, centre: (i32, i32), radius: i32, filled: bool, colour: Colour, width: i32) {
        self.ink.circle(centre, radius, filled, colour, width);
        self.indent();
        self.body.push_str("<circle");
        for (key, value) in [("cx", centre.0), ("cy", centre.1), ("r", radius)] {
            let _ = write!(self.body, " {key}=\"{}\"", text_of(value));
        }
        let paint = self.paint(colour, width, filled);
        let _ = writeln!(self.body, "{paint}/>");
    }

    /// Writes a text with its base line at `at` (points) and remembers its box.
    pub fn text(&mut self, label: &Label, at: (f64, f64), style: TextStyle) {
        if label.is_empty() {
            return;
        }
        let rect = text_rect(label, at, style.size, style.anchor, style.upright);
        self.boxes.push(TextBox { text: label.to_plain(), kind: style.kind, panel: self.panel, rect });
        let before = if style.upright { rect.bottom - at.1 } else { at.0 - rect.left };
        let start = if style.upright { (at.0, at.1 + before) } else { (at.0 - before, at.1) };
        self.ink.text(label, start, style.size, style.colour, style.halo, style.upright);
        self.indent();
        self.body.push_str(&element(label, at, style));
    }

    /// The same page as PDF.
    ///
    /// # Errors
    /// A character that the fonts of a PDF do not have.
    pub fn pdf(&self, title: &str) -> Result<Vec<u8>, PlotError> {
        self.ink.finish(self.width, title)
    }

    /// The whole file.
    pub fn finish(&self, title: &str, caption: &str, metadata: &[(String, String)]) -> Vec<u8> {
        let mut out = String::with_capacity(self.body.len() + 4096);
        let (width, height) = (text_of(self.width), text_of(self.height));
        out.push_str("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"");
        let _ = write!(out, " width=\"{}mm\"", text_of(hundredths(self.width_mm)));
        let _ = write!(out, " height=\"{}mm\" viewBox=\"0 0 {width} {height}\"", text_of(hundredths(self.height_mm)));
        out.push_str(" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" stroke-linejoin=\"round\"");
        out.push_str(" role=\"img\" xml:space=\"preserve\">\n");
        let _ = writeln!(out, " <title>{}</title>", escape(title));
        if !caption.is_empty() {
            let _ = writeln!(out, " <desc>{}</desc>", escape(caption));
        }
        if !metadata.is_empty() {
            out.push_str(" <metadata>\n  <polhode xmlns=\"urn:polhode:figure\">\n");
            for (key, value) in metadata {
                let _ = writeln!(out, "   <entry key=\"{}\">{}</entry>", escape(key), escape(value));
            }
            out.push_str("  </polhode>\n </metadata>\n");
        }
        if !self.defs.is_empty() {
            let _ = write!(out, " <defs>\n{} </defs>\n", self.defs);
        }
        let _ = writeln!(out, " <rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
        out.push_str(&self.body);
        out.push_str("</svg>\n");
        out.into_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_exactly_and_shortly() {
        for (value, text) in [(0, "0"), (5, "0.05"), (-5, "-0.05"), (1230, "12.3"), (-1200, "-12"), (1201, "12.01")] {
            assert_eq!(text_of(value), text);
        }
        assert_eq!(hundredths(1.005000001), 101);
    }

    #[test]
    fn xml_reads_texts_back() {
        assert_eq!(escape("a<b & \"c\" > 'd'\u{7}"), "a&lt;b &amp; &quot;c&quot; &gt; &#39;d&#39;\u{fffd}");
    }

    #[test]
    fn shapes_say_only_what_their_group_does_not() {
        let mut page = Document::new(89.0, 50.0);
        page.open_lines(&[("id", "x")], Colour::BLUE, 0.5, &[2.0, 1.0]);
        page.path([(0, 0), (0, 0), (150, -20)], false, false, Colour::BLUE, 50);
        page.path([(0, 0), (10, 10)], false, false, Colour::ORANGE, 50);
        page.path([(7, 7), (7, 7)], false, false, Colour::BLUE, 50);
        page.close();
        let text = String::from_utf8(page.finish("t", "", &[])).unwrap();
        assert!(text.contains("<path d=\"M0 0L1.5-0.2\"/>"), "{text}");
        assert!(text.contains("stroke-dasharray=\"2 1\""));
        assert!(text.contains("<path d=\"M0 0L0.1 0.1\" stroke=\"#e69f00\"/>"));
        assert_eq!(text.matches("<path").count(), 2, "a path of one point draws nothing");
        assert!(text.contains("width=\"89mm\" height=\"50mm\" viewBox=\"0 0 252.28 141.73\""));
    }

    #[test]
    fn lines_lose_only_points_that_cannot_be_seen() {
        // A circle of radius 50 pt with 20 000 points, and a curve that runs back on itself.
        let circle: Vec<(i32, i32)> = (0..=20_000)
            .map(|i| 2.0 * std::f64::consts::PI * f64::from(i) / 20_000.0)
            .map(|t| (hundredths(100.0 + 50.0 * libm::cos(t)), hundredths(100.0 + 50.0 * libm::sin(t))))
            .collect();
        let short = simplified(&circle);
        // The sagitta s²/8R of a chord s is a hundredth of a point for s = 2 pt, half of it for s = √2 pt: 157 or 222 chords go
        // round, and more because the points themselves are rounded by up to half of it.
        assert!(short.len() > 150 && short.len() < 600, "{}", short.len());
        assert_eq!((short.first(), short.last()), (circle.first(), circle.last()));
        assert_eq!(simplified(&[(0, 0), (500, 0), (1000, 0), (300, 0)]), [(0, 0), (1000, 0), (300, 0)]);
        assert_eq!(simplified(&[]), []);
    }
}
