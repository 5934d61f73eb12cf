//! Double points of one branch of a spin conjugate locus: two momenta with the same first conjugate point, solved to full precision.
//!
//! The polygon of the sampled branch in the chart (θ, φ), ended by the start itself, is searched for crossings of its segments; each crossing is then polished
//! by Newton's method on `(ln p_a, ln p_b) ↦ difference of the two points`. A loop smaller than the polygon's distance from the curve, `step²/25`,
//! would be missed; for k ≥ 1 loops are large: the strand that comes from the cusp crosses the arc that leaves the start.
//!
//! The table is that of a conjugate locus with two rows for each double point, so that the second route applies to it unchanged.

use super::branch::{BranchPoint, conjugate_point, conjugate_point_in, sample_in};
use super::chart::{distance, wrapped};
use super::momenta::Momenta;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::ConjugatePoint;
use crate::geometry::spin::place::first_conjugate_place;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-double-points",
    summary: "double points of one branch of a conjugate locus of the spin problem",
    code: &[
        "effects/spin/double_points.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Newton steps after which a crossing is given up; four are usual.
const MOST_STEPS: u32 = 40;
/// Steps in double-double: from some thirteen digits, eight more each.
const LONG_STEPS: u32 = 3;
/// The largest Newton step in `ln p_θ`.
const LARGEST_STEP: f64 = 0.3;
/// A residual that can only be a double point's.
const SMALL: f64 = 1e-9;
/// Step of the difference quotients in `ln p_θ`: their error, of order its square, only slows the convergence.
const DIFFERENCE: f64 = 1e-6;
/// Samples that are nearer than this to the cusp stand as dense as their rounding errors, and are left out of the search.
const AT_CUSP: f64 = 1e-6;
/// Rounding of a point's coordinates beyond that of its time.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The double points of one branch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DoublePoints {
    /// The ratio of the couplings.
    pub k: f64,
    /// How the branch is sampled.
    pub p_theta: Momenta,
}

/// A double point.
#[derive(Clone, Copy, Debug)]
pub struct DoublePoint {
    /// The two momenta, the smaller first, each with a bound on its relative error.
    pub p_theta: [(f64, f64); 2],
    /// The two conjugate points.
    pub points: [ConjugatePoint; 2],
    /// Their distance.
    pub residual: f64,
    /// A bound on the error of the place, radians.
    pub error: f64,
    /// The length of the loop between the two, on the sphere.
    pub loop_length: f64,
}

/// Where two segments cross, as fractions of each; none when they don't.
fn crossing(a: [(f64, f64); 2], b: [(f64, f64); 2]) -> Option<(f64, f64)> {
    let (ax, ay) = (a[1].0 - a[0].0, a[1].1 - a[0].1);
    let (bx, by) = (b[1].0 - b[0].0, b[1].1 - b[0].1);
    let (x, y) = (b[0].0 - a[0].0, b[0].1 - a[0].1);
    let cross = ax * by - ay * bx;
    let (s, t) = ((x * by - y * bx) / cross, (x * ay - y * ax) / cross);
    // NaN and infinities of parallel segments are in no range.
    ((0.0..1.0).contains(&s) && (0.0..1.0).contains(&t)).then_some((s, t))
}

/// The solver of one k.
struct Polish {
    k: f64,
    work: Work,
}

impl Polish {
    fn point(&mut self, log_p: f64) -> Result<ConjugatePoint, NodeError> {
        let point = conjugate_point(self.k, libm::exp(log_p))?;
        self.work.roots_solved += 1;
        self.work.elliptic_calls += u64::from(point.elliptic_calls);
        Ok(point)
    }

    /// The derivative of the place by `ln p_θ`.
    fn slope(&mut self, log_p: f64) -> Result<(f64, f64), NodeError> {
        let (before, after) = (self.point(log_p - DIFFERENCE)?, self.point(log_p + DIFFERENCE)?);
        let half = 0.5 / DIFFERENCE;
        Ok((wrapped(after.theta - before.theta) * half, (after.phi - before.phi) * half))
    }

    /// A double point polished in double-double, its momenta rounded. The derivatives are those of `f64`: good to some eight digits, so that
    /// each step gains as many.
    fn long(&mut self, found: DoublePoint) -> Result<DoublePoint, NodeError> {
        let (wide, k) = (DoubleDouble::from, DoubleDouble::from(self.k));
        let mut p = found.p_theta.map(|(p, _)| wide(p));
        let slopes = [self.slope(libm::log(found.p_theta[0].0))?, self.slope(libm::log(found.p_theta[1].0))?];
        let ((ax, ay), (bx, by)) = (slopes[0], slopes[1]);
        let cross = ax * by - ay * bx;
        for _ in 0..LONG_STEPS {
            let mut place = |p: DoubleDouble| {
                self.work.roots_solved += 1;
                first_conjugate_place(k, p).map_err(failed(&format!("k = {:?}, p_theta = {:?}", self.k, p.to_f64())))
            };
            let (a, b) = (place(p[0])?, place(p[1])?);
            let turn = DoubleDouble::PI * wide(2.0);
            let x = b.theta - a.theta;
            let x = x - turn * wide((x.to_f64() / turn.to_f64()).round());
            let y = b.phi - a.phi;
            p[0] += p[0] * (x * wide(by) - y * wide(bx)) / wide(cross);
            p[1] += p[1] * (x * wide(ay) - y * wide(ax)) / wide(cross);
        }
        let p_theta = p.map(|p| (p.to_f64(), 0.5 * f64::EPSILON));
        let points = [0, 1].map(|i| conjugate_point_in(Arithmetic::DoubleDouble, self.k, p_theta[i].0));
        let [p, q] = points;
        let points = [p?, q?];
        // What rounding of the momenta leaves, along either arc.
        let along = libm::hypot(ax, ay).max(libm::hypot(bx, by));
        let residual = distance(points[0].r, points[1].r);
        Ok(DoublePoint { p_theta, points, residual, error: 2.0 * f64::EPSILON * (1.0 + along), ..found })
    }

    fn newton(&mut self, mut a: f64, mut b: f64) -> Result<DoublePoint, NodeError> {
        let mut best: Option<(f64, DoublePoint)> = None;
        for _ in 0..MOST_STEPS {
            let (p, q) = (self.point(a)?, self.point(b)?);
            let (x, y) = (wrapped(q.theta - p.theta), q.phi - p.phi);
            let size = libm::hypot(x, y);
            let ((ax, ay), (bx, by)) = (self.slope(a)?, self.slope(b)?);
            let cross = ax * by - ay * bx;
            match best {
                // Rounding has stopped the residual from falling.
                Some((least, found)) if size >= 0.5 * least && least <= SMALL => return Ok(found),
                Some((least, _)) if size >= least => {}
                _ => {
                    let (along_a, along_b) = (libm::hypot(ax, ay), libm::hypot(bx, by));
                    // The times as given by the momenta, and the momenta as rounded.
                    let point_error =
                        |p: &ConjugatePoint, along: f64| p.t1 * p.error + ROUNDING + 4.0 * f64::EPSILON * along;
                    let uncertain = size + point_error(&p, along_a) + point_error(&q, along_b);
                    // To close a gap, a moves by (gap × slope of b)/cross.
                    let relative = |other: f64| uncertain * other / cross.abs() + f64::EPSILON;
                    let found = DoublePoint {
                        p_theta: [(libm::exp(a), relative(along_b)), (libm::exp(b), relative(along_a))],
                        points: [p, q],
                        residual: distance(p.r, q.r),
                        error: uncertain * (1.0 + along_a * along_b / cross.abs()),
                        loop_length: 0.0,
                    };
                    best = Some((size, found));
                }
            }
            let clamped = |step: f64| step.clamp(-LARGEST_STEP, LARGEST_STEP);
            a += clamped((x * by - y * bx) / cross);
            b += clamped((x * ay - y * ax) / cross);
        }
        let residual = best.map_or(f64::INFINITY, |(size, _)| size);
        let place = (libm::exp(a), libm::exp(b));
        Err(NodeError::new(format!(
            "k = {:?}: no double point near p_theta = {place:?}; residual {residual:e}",
            self.k
        )))
    }
}

/// The double points of a sampled branch, in order of the smaller momentum.
///
/// # Errors
/// A crossing of the polygon that is none of the curve.
pub fn find(k: f64, branch: &[BranchPoint]) -> Result<(Vec<DoublePoint>, Work), NodeError> {
    find_in(Arithmetic::F64, k, branch)
}

/// The same in an arithmetic: found in `f64`, polished once more in the other, and the momenta rounded.
///
/// # Errors
/// As [`find`].
pub fn find_in(arithmetic: Arithmetic, k: f64, branch: &[BranchPoint]) -> Result<(Vec<DoublePoint>, Work), NodeError> {
    let away = |row: &&BranchPoint| distance(row.point.r, branch[0].point.r) > AT_CUSP;
    let rows: Vec<&BranchPoint> = branch.iter().skip_while(|row| !away(row)).collect();
    let mut chart: Vec<(f64, f64)> = rows.iter().map(|row| (row.theta, row.point.phi)).collect();
    let mut logs: Vec<f64> = rows.iter().map(|row| libm::log(row.p_theta)).collect();
    // The start, the limit p_θ → ∞: a decade beyond the last sample on the straight chord.
    chart.push((0.0, FRAC_PI_2));
    logs.push(logs.last().map_or(0.0, |last| last + std::f64::consts::LN_10));
    let mut polish = Polish { k, work: Work::default() };
    let mut found: Vec<DoublePoint> = Vec::new();
    for i in 0..chart.len().saturating_sub(1) {
        for j in i + 2..chart.len() - 1 {
            let Some((s, t)) = crossing([chart[i], chart[i + 1]], [chart[j], chart[j + 1]]) else { continue };
            let between = |at: usize, share: f64| logs[at] + share * (logs[at + 1] - logs[at]);
            let mut double = polish.newton(between(i, s), between(j, t))?;
            if arithmetic == Arithmetic::DoubleDouble {
                double = polish.long(double)?;
            }
            let inside = i + 1..=j.min(rows.len() - 1);
            let mut last = double.points[0].r;
            for row in &rows[inside] {
                double.loop_length += distance(last, row.point.r);
                last = row.point.r;
            }
            double.loop_length += distance(last, double.points[1].r);
            found.push(double);
        }
    }
    Ok((found, polish.work))
}

impl Compute for DoublePoints {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, _: &Inputs) -> Result<Product, NodeError> {
        let (branch, work) = sample_in(arithmetic, self.k, &self.p_theta)?;
        let (found, polishing) = find_in(arithmetic, self.k, &branch)?;
        let rows: Vec<(usize, &DoublePoint, usize)> =
            found.iter().enumerate().flat_map(|(i, double)| [(i, double, 0), (i, double, 1)]).collect();
        let number = |of: fn(&DoublePoint, usize) -> f64| -> Vec<f64> {
            rows.iter().map(|(_, double, s)| of(double, *s)).collect()
        };
        let table =
            Table::builder("spin-double-points", "double points of the branch p_φ(0) = −2, p_θ(0) ≥ 0, two rows each")
                .column(
                    "index",
                    "1",
                    "which double point, from 0",
                    rows.iter().map(|row| row.0 as i64).collect::<Vec<_>>(),
                )
                .column("p_theta", "1", "p_θ(0)", number(|double, s| double.p_theta[s].0))
                .column("p_theta_error", "1", "bound on its relative error", number(|double, s| double.p_theta[s].1))
                .column("t1", "time", "first conjugate time", number(|double, s| double.points[s].t1))
                .column("theta", "rad", "θ there, in (−π, π]", number(|double, s| double.points[s].theta))
                .column("phi", "rad", "φ there, from the pole", number(|double, s| double.points[s].phi))
                .column("r1", "1", "first coordinate on the unit sphere", number(|double, s| double.points[s].r[0]))
                .column(
                    "r2",
                    "1",
                    "second coordinate, along the axis of the poles",
                    number(|double, s| double.points[s].r[1]),
                )
                .column("r3", "1", "third coordinate", number(|double, s| double.points[s].r[2]))
                .column("error", "1", "bound on the relative error of t1", number(|double, s| double.points[s].error))
                .column("residual", "1", "distance of the two points", number(|double, _| double.residual))
                .column("place_error", "rad", "bound on the error of the place", number(|double, _| double.error))
                .column(
                    "loop_length",
                    "rad",
                    "length of the loop on the sphere",
                    number(|double, _| double.loop_length),
                )
                .build()
                .map_err(failed(&format!("k = {:?}", self.k)))?;
        product(&table, work + polishing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::spin::branch::sample;

    const MOMENTA: Momenta = Momenta { from: 1e-9, to: 1e4, step: 0.1 };

    /// None below k̄ = 2/√3 = 1.1547, one up to k3 and on to 4/√7 = 1.5119, where the cusp crosses the equator the next time; then two.
    #[test]
    fn how_many_there_are() {
        for (k, expected) in
            [(1.0, 0), (1.05, 0), (1.09, 0), (1.15, 0), (1.16, 1), (1.18, 1), (1.2, 1), (1.4, 1), (1.51, 1), (1.53, 2)]
        {
            let (branch, _) = sample(k, &MOMENTA).unwrap();
            let (found, _) = find(k, &branch).unwrap();
            assert_eq!(found.len(), expected, "k = {k}");
            for double in found {
                // The bound is that of t1 there (7e-13 where δβ cancels, k = 1.53) times the speeds at the crossing: 3.4e-11.
                assert!(double.residual <= double.error && double.error < 5e-11, "{double:?}");
                assert!(double.p_theta[0].0 < double.p_theta[1].0);
            }
        }
    }

    #[test]
    fn segments() {
        assert_eq!(crossing([(0.0, 0.0), (2.0, 2.0)], [(0.0, 2.0), (2.0, 0.0)]), Some((0.5, 0.5)));
        assert_eq!(crossing([(0.0, 0.0), (2.0, 2.0)], [(0.0, 2.0), (0.5, 1.5)]), None);
        assert_eq!(crossing([(0.0, 0.0), (2.0, 2.0)], [(1.0, 0.0), (3.0, 2.0)]), None);
        assert_eq!(crossing([(1.0, 1.0), (1.0, 1.0)], [(1.0, 0.0), (3.0, 2.0)]), None);
    }

    #[test]
    fn all_code_is_declared() {
        assert_eq!(crate::contract::code::undeclared(&KIND), Ok(vec![]));
        assert_eq!(crate::contract::code::undeclared(&crate::effects::spin::loops::KIND), Ok(vec![]));
    }
}
