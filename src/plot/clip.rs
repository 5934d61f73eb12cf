//! Cutting lines and polygons off at a window, so that no coordinate on the page is far outside its frame.
//!
//! Lines: Liang and Barsky, segment by segment. Polygons: Sutherland and Hodgman. A window's `top` is its smallest y.

use super::rect::Rect;

type Point = (f64, f64);

/// The part of the segment from `a` to `b` inside the window, as fractions of it.
fn inside(a: Point, b: Point, window: &Rect) -> Option<(f64, f64)> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let sides =
        [(-dx, a.0 - window.left), (dx, window.right - a.0), (-dy, a.1 - window.top), (dy, window.bottom - a.1)];
    for (speed, room) in sides {
        if speed == 0.0 {
            if room < 0.0 {
                return None;
            }
            continue;
        }
        let at = room / speed;
        if speed < 0.0 { from = from.max(at) } else { to = to.min(at) }
    }
    (from <= to).then_some((from, to))
}

fn between(a: Point, b: Point, part: f64) -> Point {
    (a.0 + part * (b.0 - a.0), a.1 + part * (b.1 - a.1))
}

/// The parts of a line inside the window; a point with a NaN in it ends a part.
pub fn line(points: &[Point], window: &Rect) -> Vec<Vec<Point>> {
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        if a.0.is_nan() || a.1.is_nan() || b.0.is_nan() || b.1.is_nan() {
            open = false;
            continue;
        }
        let Some((from, to)) = inside(a, b, window) else {
            open = false;
            continue;
        };
        if !open || from > 0.0 {
            parts.push(vec![if from > 0.0 { between(a, b, from) } else { a }]);
        }
        let end = if to < 1.0 { between(a, b, to) } else { b };
        if let Some(part) = parts.last_mut() {
            part.push(end);
        }
        open = to >= 1.0;
    }
    parts
}

/// The part of a polygon inside the window.
pub fn polygon(points: &[Point], window: &Rect) -> Vec<Point> {
    let mut edge = points.to_vec();
    // Signed distances from the four sides, positive inside.
    let sides: [&dyn Fn(Point) -> f64; 4] =
        [&|p| p.0 - window.left, &|p| window.right - p.0, &|p| p.1 - window.top, &|p| window.bottom - p.1];
    for distance in sides {
        let mut kept = Vec::with_capacity(edge.len() + 4);
        for (i, &b) in edge.iter().enumerate() {
            let a = edge[(i + edge.len() - 1) % edge.len()];
            let (da, db) = (distance(a), distance(b));
            if (da < 0.0) != (db < 0.0) {
                kept.push(between(a, b, da / (da - db)));
            }
            if db >= 0.0 {
                kept.push(b);
            }
        }
        edge = kept;
    }
    edge
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Rect = Rect { left: 0.0, top: 0.0, right: 1.0, bottom: 1.0 };

    #[test]
    fn lines_are_cut_at_the_window() {
        let parts = line(&[(-1.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.75, 2.0), (0.75, -1.0)], &UNIT);
        assert_eq!(parts, [vec![(0.0, 0.5), (0.5, 0.5), (0.5, 1.0)], vec![(0.75, 1.0), (0.75, 0.0)]]);
        assert!(line(&[(-1.0, -1.0), (-1.0, 2.0)], &UNIT).is_empty());
        // Both ends outside, the middle inside.
        assert_eq!(line(&[(-1.0, 0.25), (3.0, 0.25)], &UNIT), [vec![(0.0, 0.25), (1.0, 0.25)]]);
    }

    #[test]
    fn a_nan_ends_a_part() {
        let nan = (f64::NAN, f64::NAN);
        assert_eq!(line(&[(0.1, 0.1), (0.2, 0.2), nan, (0.3, 0.3), (0.4, 0.4)], &UNIT).len(), 2);
    }

    #[test]
    fn polygons_are_cut_at_the_window() {
        let cut = polygon(&[(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)], &UNIT);
        let area: f64 = (0..cut.len())
            .map(|i| {
                let (a, b) = (cut[i], cut[(i + 1) % cut.len()]);
                (a.0 * b.1 - b.0 * a.1) / 2.0
            })
            .sum();
        assert!((area - 1.0).abs() < 1e-15, "{cut:?}");
        assert!(polygon(&[(2.0, 2.0), (3.0, 2.0), (3.0, 3.0)], &UNIT).is_empty());
    }
}
