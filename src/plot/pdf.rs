//! The same page as PDF, for LaTeX: a document with one page of the figure's own size, written beside the SVG from the same shapes.
//!
//! Operators of PDF 1.4 (ISO 32000-1, sections 8 and 9) in plain text, not compressed. Lengths are points, y grows upwards. Texts are set in Helvetica,
//! Helvetica-Oblique, Helvetica-Bold and Symbol, four of the standard fonts that every reader has: they are named, not embedded. What none of
//! them has is an error. Nothing of time or place is written, so equal
//! figures are equal files.

use super::colour::Colour;
use super::error::PlotError;
use super::font;
use super::label::{Label, Run, Script};
use std::fmt::Write as _;

/// How far the control points of a quarter circle stand from its ends, in radii.
const QUARTER: f64 = 0.552_284_75;
/// Slant of italic letters in a font that has none.
const SLANT: f64 = 0.21;
/// Characters that only move the pen: the space and the thin space.
const BLANKS: [char; 2] = [' ', '\u{2009}'];
/// Width of the white rim around letters, points; half of it lies outside.
const RIM: f64 = 1.5;

/// The operators of a page under way.
#[derive(Debug, Default)]
pub struct Ink {
    height: f64,
    operators: String,
    clips: Vec<(String, [f64; 4])>,
    /// The first character that no font has, and the run that it stands in.
    missing: Option<(char, String)>,
}

/// A coordinate in points.
fn points(value: i32) -> f64 {
    f64::from(value) / 100.0
}

fn rgb(colour: Colour) -> String {
    let part = |x: u8| format!("{:.3}", f64::from(x) / 255.0);
    format!("{} {} {}", part(colour.0), part(colour.1), part(colour.2))
}

/// The face that has a character, and its code there.
fn code(letter: char) -> Option<(bool, u8)> {
    const GREEK: &str = "ABΓΔEZHΘIKΛMNΞOΠPΣTYΦXΨΩαβγδεζηθικλμνξοπρσςτυφχψω";
    const SYMBOL: &str = "ABGDEZHQIKLMNXOPRSTUFCYWabgdezhqiklmnxoprsVtufcyw";
    let in_symbol = match letter {
        ' '..='~' => return Some((false, letter as u8)),
        '\u{a0}'..='\u{ff}' => return Some((false, u32::from(letter) as u8)),
        '–' => return Some((false, 0x96)),
        '—' => return Some((false, 0x97)),
        '…' => return Some((false, 0x85)),
        '‘' => return Some((false, 0x91)),
        '’' => return Some((false, 0x92)),
        '“' => return Some((false, 0x93)),
        '”' => return Some((false, 0x94)),
        '−' => 0x2d,
        '′' => 0xa2,
        '″' => 0xb2,
        '≤' => 0xa3,
        '≥' => 0xb3,
        '≈' => 0xbb,
        '≠' => 0xb9,
        '∞' => 0xa5,
        '→' => 0xae,
        '←' => 0xac,
        '∂' => 0xb6,
        '√' => 0xd6,
        '∈' => 0xce,
        '⋅' => 0xd7,
        _ => GREEK.chars().position(|known| known == letter).and_then(|at| SYMBOL.as_bytes().get(at).copied())?,
    };
    Some((true, in_symbol))
}

impl Ink {
    /// A page of this height in hundredths of a point.
    pub fn new(height: i32) -> Self {
        Self { height: points(height), ..Self::default() }
    }

    fn op(&mut self, text: std::fmt::Arguments<'_>) {
        // Writing to a String does not fail.
        let _ = self.operators.write_fmt(text);
        self.operators.push('\n');
    }

    /// Remembers a rectangle to clip with.
    pub fn clip(&mut self, id: &str, (left, top): (i32, i32), (right, bottom): (i32, i32)) {
        let rect = [points(left), self.height - points(bottom), points(right - left), points(bottom - top)];
        self.clips.push((id.to_owned(), rect));
    }

    /// Opens a group, clipped where its attributes say so.
    pub fn open(&mut self, attributes: &[(&str, &str)]) {
        self.op(format_args!("q"));
        let clip = attributes.iter().find(|(key, _)| *key == "clip-path").map(|(_, value)| *value);
        let id = clip.and_then(|value| value.strip_prefix("url(#")).and_then(|value| value.strip_suffix(')'));
        let rect = id.and_then(|id| self.clips.iter().find(|(known, _)| known == id)).map(|(_, rect)| *rect);
        if let Some([x, y, width, height]) = rect {
            self.op(format_args!("{x:.2} {y:.2} {width:.2} {height:.2} re W n"));
        }
    }

    /// The dash of the group's lines.
    pub fn dash(&mut self, pattern: &[f64]) {
        let lengths: Vec<String> = pattern.iter().map(|length| format!("{length:.2}")).collect();
        self.op(format_args!("{} J [{}] 0 d", u8::from(pattern.is_empty()), lengths.join(" ")));
    }

    /// Closes the group.
    pub fn close(&mut self) {
        self.op(format_args!("Q"));
    }

    fn paint(&mut self, filled: bool, colour: Colour, width: i32) {
        if filled {
            self.op(format_args!("{} rg", rgb(colour)));
        } else {
            self.op(format_args!("{} RG {:.2} w", rgb(colour), points(width)));
        }
    }

    /// A polygonal line, or a polygon.
    pub fn path(&mut self, line: &[(i32, i32)], closed: bool, filled: bool, colour: Colour, width: i32) {
        self.paint(filled, colour, width);
        for (i, (x, y)) in line.iter().enumerate() {
            let letter = if i == 0 { 'm' } else { 'l' };
            self.op(format_args!("{:.2} {:.2} {letter}", points(*x), self.height - points(*y)));
        }
        self.op(format_args!(
            "{}",
            if filled {
                "f"
            } else if closed {
                "s"
            } else {
                "S"
            }
        ));
    }

    /// A rectangle.
    pub fn rect(&mut self, a: (i32, i32), b: (i32, i32), filled: bool, colour: Colour, width: i32) {
        self.path(&[a, (b.0, a.1), b, (a.0, b.1)], true, filled, colour, width);
    }

    /// A circle.
    pub fn circle(&mut self, centre: (i32, i32), radius: i32, filled: bool, colour: Colour, width: i32) {
        self.paint(filled, colour, width);
        let (x, y, r) = (points(centre.0), self.height - points(centre.1), points(radius));
        let c = QUARTER * r;
        self.op(format_args!("{:.2} {y:.2} m", x + r));
        for (sx, sy, tx, ty) in
            [(1.0, 0.0, 0.0, 1.0), (0.0, 1.0, -1.0, 0.0), (-1.0, 0.0, 0.0, -1.0), (0.0, -1.0, 1.0, 0.0)]
        {
            let (ax, ay) = (x + r * sx + c * tx, y + r * sy + c * ty);
            let (bx, by) = (x + r * tx + c * sx, y + r * ty + c * sy);
            self.op(format_args!("{ax:.2} {ay:.2} {bx:.2} {by:.2} {:.2} {:.2} c", x + r * tx, y + r * ty));
        }
        self.op(format_args!("{}", if filled { "f" } else { "s" }));
    }

    /// A text whose base line begins at `at` (points, y downwards), turned by a quarter if `upright`.
    pub fn text(&mut self, label: &Label, at: (f64, f64), size: f64, colour: Colour, halo: bool, upright: bool) {
        let origin = (at.0, self.height - at.1);
        let (starts, _) = label.advances(size);
        for rim in [true, false] {
            if rim && !halo {
                continue;
            }
            self.op(format_args!("q"));
            if rim {
                self.op(format_args!("1 1 1 RG {RIM:.2} w 1 j"));
            } else {
                self.op(format_args!("{} rg {} RG 0.5 w", rgb(colour), rgb(colour)));
            }
            for (run, start) in label.runs().iter().zip(&starts) {
                self.run(run, size, *start, origin, upright, rim);
            }
            self.op(format_args!("Q"));
        }
    }

    fn run(&mut self, run: &Run, base: f64, start: f64, origin: (f64, f64), upright: bool, rim: bool) {
        let (size, raise) = match run.script {
            Script::Base => (base, 0.0),
            Script::Sub => (font::SCRIPT_SIZE * base, -font::SUB_SHIFT * base),
            Script::Super => (font::SCRIPT_SIZE * base, font::SUPER_SHIFT * base),
        };
        // Along the base line and above it, to the page.
        let place = |along: f64, above: f64| {
            if upright { (origin.0 - above, origin.1 + along) } else { (origin.0 + along, origin.1 + above) }
        };
        let mut pen = start;
        for letter in run.text.chars() {
            let advance = f64::from(font::advance(letter, run.bold)) / 1000.0 * size;
            let found = code(letter);
            if found.is_none() && !BLANKS.contains(&letter) {
                self.missing.get_or_insert_with(|| (letter, run.text.clone()));
            }
            if let Some((is_symbol, code)) = found.filter(|_| !BLANKS.contains(&letter)) {
                let face = match (is_symbol, run.bold, run.italic) {
                    (true, ..) => "S",
                    (_, true, _) => "B",
                    (_, _, true) => "I",
                    _ => "R",
                };
                let slant = if is_symbol && run.italic { SLANT } else { 0.0 };
                let (x, y) = place(pen, raise);
                let matrix = if upright { format!("0 1 -1 {slant:.2}") } else { format!("1 0 {slant:.2} 1") };
                let mode = u8::from(rim);
                self.op(format_args!(
                    "BT /{face} {size:.2} Tf {mode} Tr {matrix} {x:.2} {y:.2} Tm (\\{code:03o}) Tj ET"
                ));
            }
            pen += advance;
        }
        if run.over {
            let (from, to) = (place(start, raise + 0.8 * size), place(pen, raise + 0.8 * size));
            self.op(format_args!("{:.2} {:.2} m {:.2} {:.2} l S", from.0, from.1, to.0, to.1));
        }
    }

    /// The whole file.
    ///
    /// # Errors
    /// A text with a character that no font has.
    pub fn finish(&self, width: i32, title: &str) -> Result<Vec<u8>, PlotError> {
        if let Some((character, text)) = self.missing.clone() {
            return Err(PlotError::NoCharacter { character, text });
        }
        let font =
            |name: &str, encoding: &str| format!("<< /Type /Font /Subtype /Type1 /BaseFont /{name}{encoding} >>");
        let latin = " /Encoding /WinAnsiEncoding";
        let content = format!("1 j 1 J\n1 1 1 rg 0 0 {:.2} {:.2} re f\n{}", points(width), self.height, self.operators);
        let objects = [
            "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
            "<< /Type /Pages /Kids [3 0 R] /Count 1 >>".to_owned(),
            format!(
                "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.2} {:.2}] /Contents 4 0 R /Resources << /Font << /R 5 0 R /I 6 0 R /B 7 0 R /S 8 0 R >> >> >>",
                points(width),
                self.height
            ),
            format!("<< /Length {} >>\nstream\n{content}\nendstream", content.len()),
            font("Helvetica", latin),
            font("Helvetica-Oblique", latin),
            font("Helvetica-Bold", latin),
            font("Symbol", ""),
            format!("<< /Title {} /Producer (polhode) >>", utf16(title)),
        ];
        let mut file = String::from("%PDF-1.4\n");
        let mut places = Vec::new();
        for (i, object) in objects.iter().enumerate() {
            places.push(file.len());
            let _ = write!(file, "{} 0 obj\n{object}\nendobj\n", i + 1);
        }
        let table = file.len();
        let count = objects.len() + 1;
        let _ = write!(file, "xref\n0 {count}\n0000000000 65535 f \n");
        for place in places {
            let _ = writeln!(file, "{place:010} 00000 n ");
        }
        let _ = write!(
            file,
            "trailer\n<< /Size {count} /Root 1 0 R /Info {} 0 R >>\nstartxref\n{table}\n%%EOF\n",
            objects.len()
        );
        Ok(file.into_bytes())
    }
}

/// A text string as big-endian UTF-16 in hexadecimal digits.
fn utf16(text: &str) -> String {
    let digits: String = text.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    format!("<FEFF{digits}>")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The letters of all texts of an SVG.
    fn letters(svg: &str) -> String {
        let texts = svg.split("<text").skip(1).filter_map(|rest| rest.split_once('>')?.1.split_once("</text>"));
        // What is left of a tag after its '<' ends at '>'.
        let plain = |text: &str| text.split('<').map(|part| part.rsplit('>').next().unwrap_or("").to_owned()).collect();
        let escaped: String = texts.map(|(text, _)| plain(text)).collect::<Vec<String>>().concat();
        [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#39;", "'"), ("&amp;", "&")]
            .iter()
            .fold(escaped, |text, (from, to)| text.replace(from, to))
    }

    /// Every letter of every committed figure, of which there are fifteen.
    #[test]
    fn every_character_of_our_figures_has_a_code() {
        let folder = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/figures")).unwrap();
        let is_svg = |path: &std::path::PathBuf| path.extension().is_some_and(|ending| ending == "svg");
        let figures: Vec<_> = folder.map(|entry| entry.unwrap().path()).filter(is_svg).collect();
        assert!(figures.len() >= 15, "{figures:?}");
        for figure in figures {
            let text = letters(&std::fs::read_to_string(&figure).unwrap());
            assert!(text.chars().filter(|letter| letter.is_alphabetic()).count() > 10, "{figure:?}: {text}");
            let missing: String = text.chars().filter(|letter| code(*letter).is_none()).collect();
            assert!(missing.is_empty(), "{figure:?}: {missing}");
        }
        assert_eq!((code('θ'), code('Ω'), code('−')), (Some((true, b'q')), Some((true, b'W')), Some((true, 0x2d))));
        assert_eq!(letters("<text x=\"1\">a&lt;<tspan dy=\"2\">b</tspan>c</text><desc>中</desc>"), "a<bc");
    }

    #[test]
    fn a_character_that_no_font_has_is_named() {
        let mut ink = Ink::new(5000);
        ink.text(&Label::parse("a\u{2009}b"), (10.0, 20.0), 8.0, Colour::BLACK, true, false);
        assert!(ink.finish(5000, "中").is_ok(), "a thin space moves the pen; titles are in Unicode");
        ink.text(&Label::parse("a 中 b"), (10.0, 20.0), 8.0, Colour::BLACK, true, false);
        let refused = ink.finish(5000, "").unwrap_err();
        assert_eq!(refused, PlotError::NoCharacter { character: '中', text: "a 中 b".to_owned() });
        assert!(refused.to_string().starts_with("'中' (U+4E2D) in \"a 中 b\""), "{refused}");
    }

    /// The cross-reference table points at the objects, the stream is as long as it says.
    #[test]
    fn the_file_is_what_its_table_says() {
        let mut ink = Ink::new(5000);
        ink.clip("c", (0, 0), (1000, 1000));
        ink.open(&[("clip-path", "url(#c)")]);
        ink.path(&[(0, 0), (100, 100)], false, false, Colour::BLACK, 50);
        ink.circle((500, 500), 100, true, Colour::BLUE, 0);
        ink.close();
        ink.text(&Label::parse("*θ*_1 = π/2"), (10.0, 20.0), 8.0, Colour::BLACK, true, false);
        let text = String::from_utf8(ink.finish(5000, "Ä title").unwrap()).unwrap();
        assert!(text.contains("0.00 40.00 10.00 10.00 re W n"));
        let table = text.rfind("xref\n0 ").map(|at| text[at..].lines().skip(3).take(9).collect::<Vec<_>>()).unwrap();
        for (i, line) in table.iter().enumerate() {
            let at: usize = line[..10].parse().unwrap();
            assert!(text[at..].starts_with(&format!("{} 0 obj", i + 1)), "{line}");
        }
        let length: usize = text.split("/Length ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
        let start = text.find("stream\n").unwrap() + 7;
        assert_eq!(&text[start + length..start + length + 10], "\nendstream");
    }
}
