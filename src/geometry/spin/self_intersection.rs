//! Points that a trajectory on the sphere visits twice, up to its first exit from 0 ≤ θ ≤ π (section 5.2.1).
//!
//! In the chart (θ, φ), which is one to one there but for the poles, the trajectory is drawn as a polygon whose sides
//! turn neither angle by more than [`LONGEST_SIDE`]; crossings of its sides are then polished by Gauss-Newton on `r(s)
//! = r(t)` in R³, and kept only when they converge. Not guaranteed: two crossings so close to a tangency that the
//! polygon has none.

use super::theta::phi_of;
use crate::numerics::taylor::dense::Kept;

/// No side of the polygon is longer than this in either angle, radians.
pub const LONGEST_SIDE: f64 = 0.1;
/// Uniform pieces of time to begin with.
const FIRST_PIECES: u32 = 40;
/// Halvings of a piece: enough for passes at a distance of 1e-7 from a pole.
const MOST_HALVINGS: u32 = 26;
/// Newton steps; from a polygon's crossing three or four do, where a loop has just closed some ten.
const MOST_STEPS: u32 = 40;
/// How much of the way to an end of the span one step may go.
const MOST_OF_THE_WAY: f64 = 0.75;
/// Residual |r(s) − r(t)| below which a crossing counts as found.
const RESIDUAL: f64 = 1e-13;

/// One point of a trajectory in the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartPoint {
    /// The time.
    pub t: f64,
    /// The point on the unit sphere.
    pub r: [f64; 3],
    /// θ in [0, π]: only for points before the first exit.
    pub theta: f64,
    /// φ from the pole.
    pub phi: f64,
}

/// A point visited twice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfIntersection {
    /// First time.
    pub s: f64,
    /// Second time.
    pub t: f64,
    /// The point.
    pub r: [f64; 3],
}

/// Position and velocity at a time of a path that holds r and h.
fn state(path: &Kept<f64>, k: f64, t: f64) -> Option<([f64; 3], [f64; 3])> {
    let state = path.at(t)?;
    let &[r1, r2, r3, h1, _, h3] = state.as_slice() else { return None };
    let (w1, w3) = (h1 / (2.0 * k * k), h3 / 2.0);
    Some(([r1, r2, r3], [-w3 * r2, w3 * r1 - w1 * r3, w1 * r2]))
}

/// The trajectory on `[0, t_end]` as a polygon in the chart.
///
/// Domain: `path` holds r and h on that span, with `r3 ≥ 0` there. None when it does not.
pub fn polygon(path: &Kept<f64>, k: f64, t_end: f64) -> Option<Vec<ChartPoint>> {
    let point = |t: f64| {
        let (r, _) = state(path, k, t)?;
        // At the ends r3 is a rounding error of either sign.
        Some(ChartPoint { t, r, theta: libm::atan2(r[2].max(0.0), r[0]), phi: phi_of(r) })
    };
    let mut points = vec![point(0.0)?];
    for piece in 1..=FIRST_PIECES {
        let mut waiting = vec![(point(t_end * f64::from(piece) / f64::from(FIRST_PIECES))?, 0)];
        while let Some(&(next, halvings)) = waiting.last() {
            let last = points[points.len() - 1];
            let long = (next.theta - last.theta).abs() > LONGEST_SIDE || (next.phi - last.phi).abs() > LONGEST_SIDE;
            if long && halvings < MOST_HALVINGS {
                waiting.pop();
                waiting.push((next, halvings + 1));
                waiting.push((point(0.5 * (last.t + next.t))?, halvings + 1));
            } else {
                points.push(next);
                waiting.pop();
            }
        }
    }
    Some(points)
}

/// The self-intersections of a trajectory, in the order of their second times.
///
/// Domain: as for [`polygon`], whose result `points` is.
pub fn self_intersections(path: &Kept<f64>, k: f64, points: &[ChartPoint]) -> Vec<SelfIntersection> {
    let mut found: Vec<SelfIntersection> = Vec::new();
    let t_end = points.last().map_or(0.0, |point| point.t);
    let sides: Vec<Bounds> = points.windows(2).map(|side| Bounds::of(side[0], side[1])).collect();
    let blocks: Vec<Bounds> =
        sides.chunks(BLOCK).map(|block| block.iter().copied().fold(Bounds::NOTHING, Bounds::with)).collect();
    for (j, second) in points.windows(2).enumerate() {
        let (c, d) = (second[0], second[1]);
        let earlier = j.saturating_sub(1);
        let near = (0..earlier.div_ceil(BLOCK)).filter(|block| !blocks[*block].is_apart(&sides[j]));
        for i in near.flat_map(|block| block * BLOCK..((block + 1) * BLOCK).min(earlier)) {
            // Boxes that are apart: nearly all pairs end here, and most with their blocks.
            if sides[i].is_apart(&sides[j]) {
                continue;
            }
            let (a, b) = (points[i], points[i + 1]);
            let Some((u, v)) = crossing((a, b), (c, d)) else { continue };
            let guess = (a.t + u * (b.t - a.t), c.t + v * (d.t - c.t));
            let Some(polished) = polish(path, k, t_end, guess) else { continue };
            // A crossing at a corner of the polygon is seen by two pairs of sides.
            let apart = |other: &SelfIntersection| (other.s - polished.s).abs() + (other.t - polished.t).abs() > 1e-6;
            if found.iter().all(apart) {
                found.push(polished);
            }
        }
    }
    found
}

/// Sides that are compared together first.
const BLOCK: usize = 16;

/// What sides cover of the chart.
#[derive(Clone, Copy)]
struct Bounds {
    theta: (f64, f64),
    phi: (f64, f64),
}

impl Bounds {
    const NOTHING: Self = Self { theta: (f64::INFINITY, f64::NEG_INFINITY), phi: (f64::INFINITY, f64::NEG_INFINITY) };

    fn of(a: ChartPoint, b: ChartPoint) -> Self {
        Self { theta: (a.theta.min(b.theta), a.theta.max(b.theta)), phi: (a.phi.min(b.phi), a.phi.max(b.phi)) }
    }

    fn with(self, other: Self) -> Self {
        let joined = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        Self { theta: joined(self.theta, other.theta), phi: joined(self.phi, other.phi) }
    }

    fn is_apart(&self, other: &Self) -> bool {
        let apart = |a: (f64, f64), b: (f64, f64)| a.1 < b.0 || b.1 < a.0;
        apart(self.phi, other.phi) || apart(self.theta, other.theta)
    }
}

/// Where on two sides, as fractions, they cross.
fn crossing((a, b): (ChartPoint, ChartPoint), (c, d): (ChartPoint, ChartPoint)) -> Option<(f64, f64)> {
    let (bx, by) = (b.theta - a.theta, b.phi - a.phi);
    let (dx, dy) = (d.theta - c.theta, d.phi - c.phi);
    let (cx, cy) = (c.theta - a.theta, c.phi - a.phi);
    let determinant = bx * dy - by * dx;
    if determinant == 0.0 {
        return None;
    }
    let (u, v) = ((cx * dy - cy * dx) / determinant, (cx * by - cy * bx) / determinant);
    ((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v)).then_some((u, v))
}

/// Newton's iteration on `r(s) = r(t)`: the two arcs as straight lines in their common tangent plane.
///
/// By cross products, since the arcs may cross at an angle of 1e-7, of which normal equations would leave nothing. Iterates
/// stay inside `[0, t_end]`: where a loop has just closed, the crossing lies near both ends, and whole first steps
/// would leave the span, beyond which the path need not be known.
fn polish(path: &Kept<f64>, k: f64, t_end: f64, (mut s, mut t): (f64, f64)) -> Option<SelfIntersection> {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross =
        |a: &[f64; 3], b: &[f64; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    for _ in 0..MOST_STEPS {
        let ((r, u), (q, v)) = (state(path, k, s)?, state(path, k, t)?);
        let gap = [q[0] - r[0], q[1] - r[1], q[2] - r[2]];
        if dot(&gap, &gap) <= RESIDUAL * RESIDUAL {
            return (t > s).then_some(SelfIntersection { s, t, r });
        }
        // gap = u ds − v dt.
        let normal = cross(&u, &v);
        let square = dot(&normal, &normal);
        if square <= 0.0 {
            return None;
        }
        let (ds, dt) = (dot(&cross(&gap, &v), &normal) / square, dot(&cross(&gap, &u), &normal) / square);
        // The largest part of the step that goes most of the way to an end of the span and not beyond.
        let (back, ahead) = (s * MOST_OF_THE_WAY / -ds, (t_end - t) * MOST_OF_THE_WAY / dt);
        let mut part = 1.0;
        for limit in [back, ahead] {
            if limit > 0.0 && limit < part {
                part = limit;
            }
        }
        s += part * ds;
        t += part * dt;
        if !(s >= 0.0 && t > s) {
            return None;
        }
    }
    None
}
