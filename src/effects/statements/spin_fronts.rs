//! Lemma 4.4 once more: that the cut does not come earlier. Wave fronts inside the open hemisphere, and the brackets that make the metric almost-Riemannian.
//!
//! The front at time t is a polygon in the isothermal plane `(x, y) = (r1, k r3)` through extremals with p_θ from −∞ to ∞ that have not returned to the equator;
//! two extremals that meet there at the same time would make it cross itself. Beyond the equator the plane shows an extremal and the mirror image of its
//! continuation alike: a crossing there is a meeting of two extremals, with p_φ(0) = −2 or 2.

use super::differences::{Wide, slope_of_order_2, wide};
use super::spin_points::{QUOTIENT, cross, dot, reason};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::lift::{equator_crossings, trajectory};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[ALMOST_RIEMANNIAN, FRONTS];

const ALMOST_RIEMANNIAN: Statement = Statement {
    id: "spin_almost_riemannian",
    place: "section 4.2, after (28)",
    says: "The metric is almost-Riemannian: where X1 and X3 are parallel, on the equator, their bracket [X1, X3] = r1 ∂3 − r3 ∂1 (up to sign) is not: every point of the equator is a Grushin point.",
    method: "the bracket by difference quotients of the fields at random points of the equator, and its angle to X1 and X3",
    shape: Shape::Direct,
    forms: &["derived here", "r1 ∂3 + r3 ∂1", "r1 ∂2 − r2 ∂1", "half of it"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(571), Worst::default());
        let first = |r: [Wide; 3]| [Wide::ZERO, r[2], -r[1]];
        let third = |r: [Wide; 3]| [r[1], -r[0], Wide::ZERO];
        for _ in 0..100 {
            let (s, c) = wide(samples.even(-3.0, 3.0)).sin_cos();
            let r = [c, Wide::ZERO, s];
            let along = |field: &dyn Fn([Wide; 3]) -> [Wide; 3], v: [Wide; 3], i: usize| {
                slope_of_order_2(|t| field(std::array::from_fn(|j| r[j] + t * v[j]))[i], Wide::ZERO)
            };
            let bracket: [Wide; 3] = std::array::from_fn(|i| along(&third, first(r), i) - along(&first, third(r), i));
            let expected = match form {
                1 => [r[2], Wide::ZERO, r[0]],
                2 => [-r[1], r[0], Wide::ZERO],
                3 => [-(r[2] / wide(2.0)), Wide::ZERO, r[0] / wide(2.0)],
                _ => [-r[2], Wide::ZERO, r[0]],
            };
            // Up to its sign.
            let sign = if dot(bracket, expected) < Wide::ZERO { -Wide::ONE } else { Wide::ONE };
            (0..3).for_each(|i| worst.see((bracket[i] - sign * expected[i]).to_f64()));
            // Perpendicular to X1 and X3, which point along ∂2 here, and of length one.
            worst.see(dot(bracket, first(r)).to_f64());
            worst.see(dot(bracket, third(r)).to_f64());
            let normal = cross(bracket, [Wide::ZERO, Wide::ONE, Wide::ZERO]);
            worst.see((dot(normal, normal) - Wide::ONE).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

/// Times and values of k of the fronts.
const FRONTS_AT: [(f64, f64); 8] =
    [(0.4, 1.0), (0.4, 2.5), (0.8, 1.5), (0.8, 3.0), (1.0, 2.9), (1.3, 1.5), (1.3, 3.0), (2.0, 2.9)];
/// Points on half a front.
const HALF_FRONT: i32 = 60;

const FRONTS: Statement = Statement {
    id: "spin_fronts_do_not_cross",
    place: "Lemma 4.4, proof",
    says: "In the open hemisphere no two extremals meet at the same time: wave fronts have no double points before the equator, so that the cut is not earlier than the return.",
    method: "fronts as polygons in the isothermal plane, by integration, for several k and times; all pairs of edges",
    shape: Shape::Direct,
    forms: &[
        "derived here",
        "fronts continued beyond the equator, at twice the time",
        "fronts continued beyond the equator, at one and a half times the time",
    ],
    examine: fronts,
    note: "A polygon is not a proof; that there is no focal point before the return is proved by the curvature.",
};

fn fronts(form: Form) -> Result<Test, Unexamined> {
    let mut cases = Cases::default();
    for (k, t) in FRONTS_AT {
        let time = t * [1.0, 2.0, 1.5][form.min(2)];
        let mut points = Vec::new();
        for step in -HALF_FRONT..=HALF_FRONT {
            let size = f64::from(step.abs());
            // From 0 to 100 times the scale of p_θ, denser near 0.
            let p = f64::from(step.signum()) * 0.05 * k * libm::expm1(0.125 * size);
            let (returns, _) = equator_crossings(k, p, 1e-12, time, 1).map_err(unexamined)?;
            if form > 0 || returns.is_empty() {
                let (at, _) = trajectory(k, p, &[time], 1e-12).map_err(unexamined)?;
                points.extend(at.into_iter().map(|[r1, _, r3]| [r1, k * r3]));
            }
        }
        let crossed = crossing_edges(&points);
        cases.see(crossed.is_none(), || format!("k = {k:?}, t = {time:?}: edges {crossed:?} of {}", points.len()));
    }
    Ok(cases.none())
}

/// The first two edges, not neighbours, that cross.
fn crossing_edges(points: &[[f64; 2]]) -> Option<(usize, usize)> {
    let side = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    for (i, first) in points.windows(2).enumerate() {
        for (j, second) in points.windows(2).enumerate().skip(i + 2) {
            let apart = side(first[0], first[1], second[0]) * side(first[0], first[1], second[1]) < 0.0;
            if apart && side(second[0], second[1], first[0]) * side(second[0], second[1], first[1]) < 0.0 {
                return Some((i, j));
            }
        }
    }
    None
}
