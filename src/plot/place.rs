//! Places for labels: beside what they name, inside the frame, off other texts, and off curves and points where possible.
//!
//! Every candidate (a point of the curve, a side of it) has a cost; the cheapest wins, the first of equals: no randomness.

use super::label::Label;
use super::mark::Side;
use super::rect::Rect;
use super::svg_text::{Anchor, text_rect};

type Point = (f64, f64);

/// From a point to its label, in points.
pub const GAP: f64 = 2.4;

/// All eight sides in the order of preference.
pub const SIDES: [Side; 8] = [
    Side::AboveRight,
    Side::Right,
    Side::Above,
    Side::BelowRight,
    Side::Below,
    Side::AboveLeft,
    Side::Left,
    Side::BelowLeft,
];

/// What already stands on a part of the page.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where labels may stand.
    pub bounds: Rect,
    /// Segments of curves.
    pub segments: Vec<(Point, Point)>,
    /// Markers.
    pub dots: Vec<Rect>,
    /// Texts, insets, legends.
    pub taken: Vec<Rect>,
}

/// A text at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Its base line's start, middle or end.
    pub at: Point,
    /// Which of these.
    pub anchor: Anchor,
    /// Its box.
    pub rect: Rect,
}

/// The place of a text on one side of a point, `gap` away from it.
pub fn beside(label: &Label, size: f64, point: Point, side: Side, gap: f64) -> Spot {
    let (up, down) = label.extent(size);
    let middle = 0.36 * size;
    let near = 0.75 * gap;
    let (anchor, x, y) = match side {
        Side::Above => (Anchor::Middle, point.0, point.1 - gap - down * 0.6),
        Side::Below => (Anchor::Middle, point.0, point.1 + gap + up),
        Side::Left => (Anchor::End, point.0 - gap, point.1 + middle),
        Side::Right => (Anchor::Start, point.0 + gap, point.1 + middle),
        Side::AboveLeft => (Anchor::End, point.0 - near, point.1 - near - down * 0.6),
        Side::AboveRight => (Anchor::Start, point.0 + near, point.1 - near - down * 0.6),
        Side::BelowLeft => (Anchor::End, point.0 - near, point.1 + near + up),
        Side::BelowRight => (Anchor::Start, point.0 + near, point.1 + near + up),
        Side::Centre => (Anchor::Middle, point.0, point.1 + middle),
    };
    Spot { at: (x, y), anchor, rect: text_rect(label, (x, y), size, anchor, false) }
}

/// The same spot moved by the least that brings it inside.
pub fn moved_inside(spot: Spot, bounds: &Rect) -> Spot {
    let mut shift = (0.0, 0.0);
    if spot.rect.right > bounds.right {
        shift.0 = bounds.right - spot.rect.right;
    }
    if spot.rect.left + shift.0 < bounds.left {
        shift.0 = bounds.left - spot.rect.left;
    }
    if spot.rect.bottom > bounds.bottom {
        shift.1 = bounds.bottom - spot.rect.bottom;
    }
    if spot.rect.top + shift.1 < bounds.top {
        shift.1 = bounds.top - spot.rect.top;
    }
    let rect = Rect {
        left: spot.rect.left + shift.0,
        right: spot.rect.right + shift.0,
        top: spot.rect.top + shift.1,
        bottom: spot.rect.bottom + shift.1,
    };
    Spot { at: (spot.at.0 + shift.0, spot.at.1 + shift.1), rect, ..spot }
}

impl Scene {
    /// How bad it is to cover this rectangle.
    pub fn cost(&self, rect: &Rect) -> f64 {
        self.cost_up_to(rect, f64::INFINITY)
    }

    /// The cost when it is below `limit`, else anything not below it: what is already too dear is not looked at further.
    fn cost_up_to(&self, rect: &Rect, limit: f64) -> f64 {
        let outside = if self.bounds.holds(rect, 0.0) { 0.0 } else { 1e6 };
        let texts = self.taken.iter().filter(|taken| taken.overlaps(&rect.grown(0.8), 0.0)).count() as f64;
        let dots = self.dots.iter().filter(|dot| dot.overlaps(&rect.grown(0.4), 0.0)).count() as f64;
        let room = rect.grown(0.9);
        let mut cost = outside + 1e4 * texts + 40.0 * dots;
        for &(a, b) in &self.segments {
            if cost >= limit {
                return cost;
            }
            cost += 6.0 * length_inside(a, b, &room);
        }
        cost
    }

    /// The best of some spots, with the cost of taking each as such.
    pub fn best(&self, spots: impl IntoIterator<Item = (Spot, f64)>) -> Option<Spot> {
        let mut best: Option<(Spot, f64)> = None;
        for (spot, own) in spots {
            let least = best.map_or(f64::INFINITY, |(_, least)| least);
            let cost = own + self.cost_up_to(&spot.rect, least - own);
            if best.is_none() || cost < least {
                best = Some((spot, cost));
            }
        }
        best.map(|(spot, _)| spot)
    }
}

/// Length of the part of a segment inside a rectangle.
pub fn length_inside(a: Point, b: Point, rect: &Rect) -> f64 {
    // Most segments are far away.
    if a.0.max(b.0) < rect.left || a.0.min(b.0) > rect.right || a.1.max(b.1) < rect.top || a.1.min(b.1) > rect.bottom {
        return 0.0;
    }
    let distance = |a: Point, b: Point| ((b.0 - a.0) * (b.0 - a.0) + (b.1 - a.1) * (b.1 - a.1)).sqrt();
    super::clip::line(&[a, b], rect).iter().flat_map(|part| part.windows(2).map(|s| distance(s[0], s[1]))).sum()
}

/// `count` points spread evenly over the length of some lines, with their fraction of it.
pub fn along(parts: &[Vec<Point>], count: usize) -> Vec<Point> {
    let distance = |a: Point, b: Point| ((b.0 - a.0) * (b.0 - a.0) + (b.1 - a.1) * (b.1 - a.1)).sqrt();
    let total: f64 = parts.iter().flat_map(|part| part.windows(2).map(|s| distance(s[0], s[1]))).sum();
    (0..count)
        .filter_map(|i| at_length(parts, total * (i as f64 + 0.5) / count as f64).map(|(point, _)| point))
        .collect()
}

/// The point at this length along some lines, and the direction there (not normalised).
pub fn at_length(parts: &[Vec<Point>], length: f64) -> Option<(Point, Point)> {
    let mut left = length;
    let mut last = None;
    for pair in parts.iter().flat_map(|part| part.windows(2)) {
        let (a, b) = (pair[0], pair[1]);
        let direction = (b.0 - a.0, b.1 - a.1);
        let size = (direction.0 * direction.0 + direction.1 * direction.1).sqrt();
        if size == 0.0 {
            continue;
        }
        if left <= size {
            let part = left / size;
            return Some(((a.0 + part * direction.0, a.1 + part * direction.1), direction));
        }
        left -= size;
        last = Some((b, direction));
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_label_goes_where_nothing_is() {
        let bounds = Rect { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        // A curve passes right through the preferred place above to the right of the point.
        let scene = Scene { bounds, segments: vec![((50.0, 40.0), (90.0, 40.0))], dots: vec![], taken: vec![] };
        let label = Label::plain("name");
        let spots = SIDES.iter().map(|&side| (beside(&label, 7.0, (50.0, 46.0), side, GAP), 0.0));
        let best = scene.best(spots).unwrap();
        assert!(best.rect.top > 41.0 || best.rect.right < 50.0, "{best:?}");
        // In the corner only one side remains inside.
        let spots = SIDES.iter().map(|&side| (beside(&label, 7.0, (99.0, 99.0), side, GAP), 0.0));
        let best = scene.best(spots).unwrap();
        assert!(bounds.holds(&best.rect, 0.0), "{best:?}");
    }

    #[test]
    fn moving_inside_moves_no_further_than_needed() {
        let bounds = Rect { left: 0.0, top: 0.0, right: 30.0, bottom: 30.0 };
        let spot = beside(&Label::plain("abc"), 7.0, (28.0, 2.0), Side::Right, GAP);
        let moved = moved_inside(spot, &bounds);
        assert!(bounds.holds(&moved.rect, 1e-9));
        assert_eq!(moved.rect.right, 30.0);
    }

    #[test]
    fn lengths_along_several_parts() {
        let parts = vec![vec![(0.0, 0.0), (1.0, 0.0)], vec![(5.0, 0.0), (5.0, 3.0)]];
        assert_eq!(at_length(&parts, 2.0), Some(((5.0, 1.0), (0.0, 3.0))));
        assert_eq!(along(&parts, 2), [(0.5 + 0.5, 0.0), (5.0, 2.0)]);
    }
}
