//! How far what is drawn has moved between two pictures of one experiment, in millimetres: ink to ink, as an eye compares them.
//!
//! A picture's curves and points stand in groups, one for each role of each panel (`<g id="a-conjugate-locus">`). The movement of a group is the
//! Hausdorff distance of its ink: the largest distance from a vertex of a curve, or a point, of one picture to the nearest curve or point of the same group in the
//! other, and the other way round. A curve drawn through other points, but along the same line, has not moved; nor has one of many equal curves that
//! took the place of another. A group that only one of the pictures has is told as such.
//!
//! What it reads is the SVG that the plot room writes: absolute `M` and `L` in points (1/72 inch), circles with `cx`, `cy`. Texts are not compared.

/// Millimetres in a point.
const MM_PER_POINT: f64 = 25.4 / 72.0;
/// Half the width of the thinnest lines, 0.5 pt: a line that has moved by more no longer covers its own middle.
pub const VISIBLE_MM: f64 = 0.25 * MM_PER_POINT;

/// What has moved most.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Movement {
    /// How far, in millimetres.
    pub mm: f64,
    /// The group that did: `a-conjugate-locus`.
    pub group: String,
    /// Groups that only one of the pictures has.
    pub unmatched: Vec<String>,
}

impl Movement {
    /// Whether an eye could see it.
    pub fn is_visible(&self) -> bool {
        self.mm > VISIBLE_MM || !self.unmatched.is_empty()
    }
}

type Point = (f64, f64);

/// The ink of one group: polylines; a point is a polyline of one vertex.
#[derive(Debug, Default)]
struct Ink {
    id: String,
    lines: Vec<Vec<Point>>,
}

/// How far the ink of `svg` is from that of `reference`.
pub fn movement(svg: &str, reference: &str) -> Movement {
    let (ours, theirs) = (ink_of(svg), ink_of(reference));
    let mut moved = Movement::default();
    let lone = |all: &[Ink], ink: &Ink| !all.iter().any(|other| other.id == ink.id);
    moved.unmatched.extend(ours.iter().filter(|ink| lone(&theirs, ink)).map(|ink| ink.id.clone()));
    moved.unmatched.extend(theirs.iter().filter(|ink| lone(&ours, ink)).map(|ink| ink.id.clone()));
    for ink in &ours {
        let Some(other) = theirs.iter().find(|other| other.id == ink.id) else { continue };
        let mm = MM_PER_POINT * one_sided(ink, other).max(one_sided(other, ink));
        if mm > moved.mm {
            (moved.mm, moved.group) = (mm, ink.id.clone());
        }
    }
    moved
}

/// The largest distance from a vertex of `from` to the ink of `to`.
fn one_sided(from: &Ink, to: &Ink) -> f64 {
    let nearest = |point: Point| to.lines.iter().map(|line| to_line(point, line)).fold(f64::INFINITY, f64::min);
    // The same polyline in the same place needs no search.
    let moved = |(i, line): (usize, &Vec<Point>)| to.lines.get(i) != Some(line);
    let moved = from.lines.iter().enumerate().filter(|(i, line)| moved((*i, line))).flat_map(|(_, line)| line);
    moved.map(|point| nearest(*point)).fold(0.0, f64::max)
}

fn to_line(point: Point, line: &[Point]) -> f64 {
    match line {
        [only] => distance(point, *only),
        _ => line.windows(2).map(|side| to_segment(point, side[0], side[1])).fold(f64::INFINITY, f64::min),
    }
}

fn distance(a: Point, b: Point) -> f64 {
    let (x, y) = (a.0 - b.0, a.1 - b.1);
    (x * x + y * y).sqrt()
}

fn to_segment(point: Point, a: Point, b: Point) -> f64 {
    let (x, y) = (b.0 - a.0, b.1 - a.1);
    let square = x * x + y * y;
    let along = ((point.0 - a.0) * x + (point.1 - a.1) * y) / square;
    let share = if square > 0.0 { along.clamp(0.0, 1.0) } else { 0.0 };
    distance(point, (a.0 + share * x, a.1 + share * y))
}

/// The groups with ink, by the id of the nearest group around them that has one.
fn ink_of(svg: &str) -> Vec<Ink> {
    let mut all: Vec<Ink> = Vec::new();
    let mut around: Vec<String> = Vec::new();
    let mut defined = 0_u32;
    for tag in svg.split('<').skip(1) {
        let name = tag.split([' ', '>', '/']).next().unwrap_or_default();
        let closed = tag.split('>').next().is_some_and(|inside| inside.ends_with('/'));
        match name {
            "defs" | "clipPath" if !closed => defined += 1,
            "g" if !closed => {
                let outer = around.last().cloned().unwrap_or_default();
                around.push(attribute(tag, "id").map_or(outer, str::to_owned));
            }
            "" if tag.starts_with("/g>") => drop(around.pop()),
            "" if tag.starts_with("/defs>") || tag.starts_with("/clipPath>") => defined = defined.saturating_sub(1),
            _ if defined > 0 => {}
            "path" => add(&mut all, &around, attribute(tag, "d").map(lines_of).unwrap_or_default()),
            "circle" => {
                let number = |name| attribute(tag, name).and_then(|text| text.parse().ok());
                if let (Some(x), Some(y)) = (number("cx"), number("cy")) {
                    add(&mut all, &around, vec![vec![(x, y)]]);
                }
            }
            _ => {}
        }
    }
    all
}

fn add(all: &mut Vec<Ink>, around: &[String], lines: Vec<Vec<Point>>) {
    let id = around.last().cloned().unwrap_or_default();
    match all.iter_mut().find(|ink| ink.id == id) {
        Some(ink) => ink.lines.extend(lines),
        None => all.push(Ink { id, lines }),
    }
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let from = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    tag.get(from..)?.split('"').next()
}

/// The polylines of a path's data.
fn lines_of(data: &str) -> Vec<Vec<Point>> {
    let mut lines: Vec<Vec<Point>> = Vec::new();
    for part in data.split('M').skip(1) {
        let numbers = part.split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-' || c == 'e'));
        let numbers: Vec<f64> = numbers.filter_map(|text| text.parse().ok()).collect();
        let line: Vec<Point> = numbers.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        if !line.is_empty() {
            lines.push(line);
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(curve: &str, point: &str) -> String {
        format!(
            "<svg><defs><clipPath id=\"c\"><path d=\"M0 0L9 9\"/></clipPath></defs><g id=\"panel-a\"><g id=\"a-geodesic\" data-role=\"geodesic\">\
             <path d=\"{curve}\"/></g><g id=\"a-start\"><circle cx=\"{point}\" cy=\"1\" r=\"2\"/></g></g></svg>"
        )
    }

    /// A vertex more on the same line is no movement; 0.72 pt is 0.254 mm, more than half the thinnest line's width.
    #[test]
    fn ink_to_ink() {
        let straight = picture("M0 0L10 0", "1");
        assert_eq!(movement(&straight, &picture("M0 0L5 0 10 0", "1")), Movement::default());
        let bent = movement(&picture("M0 0L5 0.72 10 0", "1"), &straight);
        assert!((bent.mm - 0.254).abs() < 1e-12 && bent.group == "a-geodesic" && bent.is_visible());
        let shifted = movement(&straight, &picture("M0 0L10 0", "1.1"));
        assert!((shifted.mm - 0.1 * MM_PER_POINT).abs() < 1e-12 && shifted.group == "a-start" && !shifted.is_visible());
        let lost = movement(&straight, &straight.replace("a-start", "a-end"));
        assert!(lost.unmatched == ["a-start", "a-end"] && lost.is_visible() && lost.mm == 0.0);
    }
}
