//! Section 4.2, from the isothermal coordinates to Lemma 4.4: the curvature of the almost-Riemannian metric, conjugate points and the cut locus.
//!
//! Curvature by Brioschi's formula from the printed coefficients in (φ, θ), that is without isothermal coordinates. Conjugate points and
//! returns to the equator by integration of the lift.

use super::differences::{Wide, slope_of_order_2, slopes_of_order_2, wide};
use super::spin_points::{ChartPoint, QUOTIENT, anisotropy, chart_points, gap, reason};
use super::spin_trajectories::travelled;
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::lift::{equator_crossings, first_conjugate_time_by_integration};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] =
    &[ISOTHERMAL, CURVATURE_BY_LAMBDA, CURVATURE, NEGATIVE, SUPREMUM, NO_CONJUGATE_BEFORE, SYMMETRIC_PAIR, CUT_LOCUS];

/// `λ = 1/(1 − x² − y²/k²)` with named changes.
fn lambda(k: Wide, [x, y]: [Wide; 2], form: Form) -> Wide {
    let k2 = k * k;
    match form {
        1 => Wide::ONE / (Wide::ONE - x * x - y * y),
        2 => Wide::ONE / (Wide::ONE - x * x - y * y * k2),
        3 => Wide::ONE - x * x - y * y / k2,
        _ => Wide::ONE / (Wide::ONE - x * x - y * y / k2),
    }
}

/// `(x, y) = (r1, k r3)`.
fn plane(point: &ChartPoint) -> [Wide; 2] {
    let [r1, _, r3] = point.position();
    [r1, point.k * r3]
}

/// The metric of Lemma 4.1: coefficients of dφ², dφ dθ (half of its 2), dθ².
fn coefficients(point: &ChartPoint) -> [Wide; 3] {
    let ((st, ct), tan) = (point.theta.sin_cos(), point.phi.tan());
    let k2 = point.k * point.k;
    [ct * ct + k2 * st * st, (k2 - Wide::ONE) * tan * st * ct, tan * tan * (st * st + k2 * ct * ct)]
}

const ISOTHERMAL: Statement = Statement {
    id: "spin_isothermal",
    place: "section 4.2, isothermal coordinates",
    says: "With x = r1, y = k r3, g = λ (dx² + dy²), λ = 1/(1 − x² − y²/k²) > 0.",
    method: "the metric of Lemma 4.1 against the pull-back of λ (dx² + dy²) by difference quotients",
    shape: Shape::Direct,
    forms: &["as printed", "y² without 1/k²", "k² y²", "the inverse of λ"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in chart_points(451) {
            let along_phi = slopes_of_order_2(|phi| plane(&ChartPoint { phi, ..point }), point.phi);
            let along_theta = slopes_of_order_2(|theta| plane(&ChartPoint { theta, ..point }), point.theta);
            let lambda = lambda(point.k, plane(&point), form);
            let product = |a: [Wide; 2], b: [Wide; 2]| lambda * (a[0] * b[0] + a[1] * b[1]);
            let [e, f, g] = coefficients(&point);
            worst.see(gap(product(along_phi, along_phi), e));
            worst.see(((product(along_phi, along_theta) - f) / (e * g).sqrt()).to_f64());
            worst.see(gap(product(along_theta, along_theta), g));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

/// Points at a distance from the equator and the poles, where second difference quotients of the chart's coefficients keep their digits.
fn calm_points(seed: u64) -> impl Iterator<Item = ChartPoint> {
    chart_points(seed).into_iter().chain(chart_points(seed + 50)).filter(|point| {
        let (sine, cosine) = point.phi.sin_cos();
        sine.to_f64() > 0.05 && cosine.to_f64().abs() > 0.05
    })
}

/// Fourth-order second derivatives: `∂²/∂a²`, `∂²/∂b²`, `∂²/∂a∂b` of three functions.
fn second_slopes(f: impl Fn(Wide, Wide) -> [Wide; 3]) -> [[Wide; 3]; 3] {
    let centre = f(Wide::ZERO, Wide::ZERO);
    let at = |h: f64| {
        let (h, o) = (wide(h), Wide::ZERO);
        let (east, west, north, south) = (f(h, o), f(-h, o), f(o, h), f(o, -h));
        let (ne, sw, nw, se) = (f(h, h), f(-h, -h), f(-h, h), f(h, -h));
        let two = wide(2.0);
        let h2 = h * h;
        [
            std::array::from_fn(|i| (east[i] + west[i] - two * centre[i]) / h2),
            std::array::from_fn(|i| (north[i] + south[i] - two * centre[i]) / h2),
            std::array::from_fn::<Wide, 3, _>(|i| (ne[i] + sw[i] - nw[i] - se[i]) / (wide(4.0) * h2)),
        ]
    };
    let (fine, coarse) = (at(1e-6), at(2e-6));
    std::array::from_fn(|i| std::array::from_fn(|j| (wide(4.0) * fine[i][j] - coarse[i][j]) / wide(3.0)))
}

fn determinant(m: [[Wide; 3]; 3]) -> Wide {
    let minor = |a: usize, b: usize| m[1][a] * m[2][b] - m[1][b] * m[2][a];
    m[0][0] * minor(1, 2) - m[0][1] * minor(0, 2) + m[0][2] * minor(0, 1)
}

/// The Gauss curvature from the first fundamental form alone (Brioschi).
fn brioschi(point: &ChartPoint) -> Wide {
    let metric = |a: Wide, b: Wide| coefficients(&ChartPoint { phi: point.phi + a, theta: point.theta + b, ..*point });
    let [e, f, g] = metric(Wide::ZERO, Wide::ZERO);
    let [eu, fu, gu] = slopes_of_order_2(|a| metric(a, Wide::ZERO), Wide::ZERO);
    let [ev, fv, gv] = slopes_of_order_2(|b| metric(Wide::ZERO, b), Wide::ZERO);
    let [uu, vv, uv] = second_slopes(metric);
    let half = wide(0.5);
    let corner = uv[1] - half * vv[0] - half * uu[2];
    let first = [[corner, half * eu, fu - half * ev], [fv - half * gu, e, f], [half * gv, f, g]];
    let second = [[Wide::ZERO, half * ev, half * gu], [half * ev, e, f], [half * gu, f, g]];
    (determinant(first) - determinant(second)) / (e * g - f * f).squared()
}

/// The printed curvature with named changes.
fn printed_curvature(k: Wide, at: [Wide; 2], form: Form) -> Wide {
    let (k2, [x, y]) = (k * k, at);
    let two = wide(if form == 1 { 1.0 } else { 2.0 });
    let across = if form == 2 { y * y / k2 } else { y * y / (k2 * k2) };
    let constant = if form == 3 { Wide::ONE + k2 } else { Wide::ONE + Wide::ONE / k2 };
    -constant - two * lambda(k, at, 0) * (x * x + across)
}

/// Second difference quotients lose more digits than first ones: the coefficients vary over a twentieth, steps of 1e-6, rounding 1e-32 by 1e-12.
const SECOND_QUOTIENT: f64 = 1e-12;

const CURVATURE_BY_LAMBDA: Statement = Statement {
    id: "spin_curvature_by_lambda",
    place: "section 4.2, before Lemma 4.4",
    says: "The Gauss curvature is G = −Δ ln λ/(2λ), Δ = ∂xx + ∂yy.",
    method: "Brioschi's formula on the metric of Lemma 4.1 against the Laplacian by difference quotients, at points off equator and poles",
    shape: Shape::Direct,
    forms: &["as printed", "without the one half", "the other sign", "multiplied by λ"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in calm_points(452) {
            let at = plane(&point);
            // x and y/k are of the same size: steps in y are k times as long.
            let log = |a: Wide, b: Wide| [lambda(point.k, [at[0] + a, at[1] + point.k * b], 0).ln(); 3];
            let [xx, yy, _] = second_slopes(log);
            let laplacian = xx[0] + yy[0] / (point.k * point.k);
            let (two, value) = (wide(2.0), lambda(point.k, at, 0));
            let curvature = match form {
                1 => -laplacian / value,
                2 => laplacian / (two * value),
                3 => -(laplacian * value) / two,
                _ => -laplacian / (two * value),
            };
            worst.see(gap(curvature, brioschi(&point)));
        }
        Ok(worst.at_most(SECOND_QUOTIENT, "second difference quotients in double-double"))
    },
    note: "",
};

const CURVATURE: Statement = Statement {
    id: "spin_curvature",
    place: "section 4.2, before Lemma 4.4",
    says: "G = −1 − 1/k² − 2λ(x, y)(x² + y²/k⁴).",
    method: "Brioschi's formula on the metric of Lemma 4.1 by difference quotients, at points off equator and poles",
    shape: Shape::Direct,
    forms: &["as printed", "without the 2", "y²/k²", "1 + k²"],
    examine: |form| {
        let mut worst = Worst::default();
        for point in calm_points(453) {
            worst.see(gap(printed_curvature(point.k, plane(&point), form), brioschi(&point)));
        }
        Ok(worst.at_most(SECOND_QUOTIENT, "second difference quotients in double-double"))
    },
    note: "",
};

const NEGATIVE: Statement = Statement {
    id: "spin_curvature_negative",
    place: "Lemma 4.4, proof",
    says: "G is strictly negative in each open hemisphere, for every k.",
    method: "the sign of Brioschi's curvature at random points off equator and poles; close to them that of the formula it confirms",
    shape: Shape::Direct,
    forms: &["as printed", "below −1 − k² everywhere", "above −1/2 for large k"],
    examine: |form| {
        let mut cases = Cases::default();
        let calm: Vec<_> = calm_points(454).map(|point| (point, brioschi(&point))).collect();
        let close = chart_points(455).into_iter().map(|point| (point, printed_curvature(point.k, plane(&point), 0)));
        for (point, curvature) in calm.into_iter().chain(close) {
            let curvature = curvature.to_f64();
            let holds = match form {
                1 => curvature < -1.0 - point.k.to_f64() * point.k.to_f64(),
                2 => point.k.to_f64() < 2.0 || curvature > -0.5,
                _ => curvature < 0.0,
            };
            cases.see(holds, || format!("k = {:?}, G = {curvature:?}", point.k.to_f64()));
        }
        Ok(cases.none())
    },
    note: "",
};

const SUPREMUM: Statement = Statement {
    id: "spin_curvature_supremum",
    place: "beyond the article, Lemma 4.4",
    says: "The largest curvature is −1 − 1/k², attained at the two poles; towards the equator G r2² tends to −2 (r1² + r3²/k²): unbounded for every k.",
    method: "the value and the gradient of the printed curvature at a pole, and G r2² at points of decreasing r2, extrapolated, for random k",
    shape: Shape::Direct,
    forms: &["derived here", "−1 − k² at the poles", "r1² + r3² at the equator", "without the 2 at the equator"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(456), Worst::default());
        for index in 0..120 {
            let (k, theta) = (wide(anisotropy(&mut samples, index)), wide(samples.even(-3.0, 3.0)));
            let k2 = k * k;
            let top = -Wide::ONE - if form == 1 { k2 } else { Wide::ONE / k2 };
            worst.see(gap(printed_curvature(k, [Wide::ZERO; 2], 0), top));
            worst.see(slope_of_order_2(|x| printed_curvature(k, [x, Wide::ZERO], 0), Wide::ZERO).to_f64());
            let (st, ct) = theta.sin_cos();
            let scaled = |r2: f64| {
                let r2 = wide(r2);
                let across = (Wide::ONE - r2 * r2).sqrt();
                printed_curvature(k, [across * ct, k * across * st], 0) * r2 * r2
            };
            // An even function of r2: one step of Richardson's extrapolation.
            let limit = (wide(4.0) * scaled(1e-5) - scaled(2e-5)) / wide(3.0);
            let third = if form == 2 { st * st } else { st * st / k2 };
            worst.see(gap(limit, wide(if form == 3 { -1.0 } else { -2.0 }) * (ct * ct + third)));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "",
};

/// Random k and p_θ for integrations: no hour-long extremals (k ≫ 1) and no separatrix that f64 does not resolve (k ≪ 1 with p_θ → 0).
fn starts(seed: u64, count: usize) -> impl Iterator<Item = (f64, f64)> {
    let mut samples = Samples::new(seed);
    (0..count).map(move |_| (samples.log(0.2, 2.5), samples.log(1e-2, 50.0)))
}

/// Accuracy of the integrations.
const TOLERANCE: f64 = 1e-15;

/// A time that no first return or conjugate time of [`starts`] exceeds.
fn long(k: f64) -> f64 {
    20.0 + 8.0 * k * k
}

const NO_CONJUGATE_BEFORE: Statement = Statement {
    id: "spin_no_conjugate_before_return",
    place: "Lemma 4.4, proof",
    says: "An extremal from the equator has no conjugate point before it returns to the equator.",
    method: "first conjugate time and returns by integration of the lift, random k and p_θ",
    shape: Shape::Direct,
    forms: &["as printed", "before the second return", "before the first return and half as much again"],
    examine: |form| {
        let mut cases = Cases::default();
        for (k, p_theta) in starts(457, 120) {
            let (point, _) =
                first_conjugate_time_by_integration(k, p_theta, TOLERANCE, 4.0 * long(k)).map_err(unexamined)?;
            let (returns, _) = equator_crossings(k, p_theta, TOLERANCE, long(k), 2).map_err(unexamined)?;
            let time = |n: usize| returns.get(n).map(|crossing| crossing.time).ok_or_else(|| unexamined("no return"));
            let before = match form {
                1 => time(1)?,
                2 => 1.5 * time(0)?,
                _ => time(0)?,
            };
            cases.see(point.t1 > before, || format!("k = {k:?}, p_θ = {p_theta:?}: t1 = {:?}, {before:?}", point.t1));
        }
        Ok(cases.none())
    },
    note: "Nor at the return itself: the inequality is strict.",
};

const SYMMETRIC_PAIR: Statement = Statement {
    id: "spin_symmetric_pair",
    place: "Lemma 4.4, proof",
    says: "The two extremals with p_φ(0) = ±2 and the same p_θ meet on the equator, at the same time: at the first return of either, and not before.",
    method: "both integrated to the first return of one of them and to a random time before, random k and p_θ",
    shape: Shape::Direct,
    forms: &["as printed", "with the opposite p_θ", "meeting on the meridian r3 = 0", "after half the time"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(458), Worst::default());
        for (k, p) in starts(458, 60) {
            let (returns, _) = equator_crossings(k, p, TOLERANCE, long(k), 1).map_err(unexamined)?;
            let time = returns.first().ok_or_else(|| unexamined("no return"))?.time;
            let time = if form == 3 { 0.5 * time } else { time };
            let pair = |t: f64| -> Result<[[f64; 6]; 2], Unexamined> {
                Ok([travelled(k, p, -2.0, t)?, travelled(k, if form == 1 { -p } else { p }, 2.0, t)?])
            };
            let [down, up] = pair(time)?;
            (0..3).for_each(|i| worst.see(down[i] - up[i]));
            worst.see(if form == 2 { down[2] } else { down[1] });
            let [down, up] = pair(samples.even(0.01, 0.99) * time)?;
            worst.see(if down[1] * up[1] < 0.0 { 0.0 } else { 1.0 });
        }
        Ok(worst.at_most(1e-12, "rounding of the integrations"))
    },
    note: "",
};

const CUT_LOCUS: Statement = Statement {
    id: "spin_lemma_4_4",
    place: "Lemma 4.4",
    says: "The cut locus of the equatorial point is the equator without that point: as p_θ falls from ∞ to 0, the first return runs through the half equator 0 < θ ≤ π once.",
    method: "first returns by integration for p_θ from large to small and several k: θ rises, begins near 0, ends near π; the other half is the mirror image",
    shape: Shape::Direct,
    forms: &["as printed", "the second return", "a half equator that ends at π/2", "θ falls"],
    examine: cut_locus,
    note: "That nothing meets before is the proof's part (negative curvature, and the reflection); what is computed is that every point of the equator but the start is reached, once.",
};

fn cut_locus(form: Form) -> Result<Test, Unexamined> {
    let mut cases = Cases::default();
    let end = if form == 2 { 0.5 * f64::PI } else { f64::PI };
    let steps = 40;
    for k in [0.3, 0.7, 1.0, 1.3, 2.0] {
        let mut before = 0.0;
        for step in 0..=steps {
            let p_theta = libm::exp(libm::log(1e4) - libm::log(1e11) * f64::from(step) / f64::from(steps));
            let wanted = if form == 1 { 2 } else { 1 };
            let (returns, _) = equator_crossings(k, p_theta, TOLERANCE, long(k), wanted).map_err(unexamined)?;
            let [r1, _, r3] = returns.last().ok_or_else(|| unexamined("no return"))?.r;
            let theta = libm::atan2(r3, r1);
            let rises = if form == 3 { theta < before } else { theta > before };
            cases
                .see(rises && theta <= end, || format!("k = {k:?}, p_θ = {p_theta:?}: θ = {theta:?} after {before:?}"));
            if step == 0 {
                cases.see(theta < 1e-3, || format!("k = {k:?}, p_θ = {p_theta:?}: θ = {theta:?}"));
            }
            before = theta;
        }
        cases.see((before - end).abs() < 0.01, || format!("k = {k:?}: θ ends at {before:?}"));
    }
    Ok(cases.none())
}
