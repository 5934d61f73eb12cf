//! Sections 5.2 and 5.2.3, and beyond: the limits p_θ → 0 (the cusp on the meridian) and p_θ → ∞ (the contact at the start), and k = 1.
//!
//! On the meridian β = 0, λ = t, and the phase of the closed form is elementary: `Θ = t − arg(w cos wt + i sin wt)` for k > 1, `w² = 1 − 1/k²`, and
//! `Θ = t − arg(l cosh lt + i sinh lt)` for k < 1, `l² = 1/k² − 1`; the cusp is at `r = (cos t1, sin t1, 0)`.

use super::differences::{Wide, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::conjugate::first_conjugate_point;
use crate::geometry::spin::lift::first_conjugate_time_by_integration;
use crate::geometry::spin::start::Start;
use crate::numerics::real::Real;
use crate::numerics::roots::{RootTolerance, bracketed};

/// The statements.
pub const ALL: &[Statement] = &[ABOVE, BELOW, ROUND, FAST, CONTACT, CUSP_BELOW_ONE, CUSP_MOVES, SMALL_K, LARGE_K];

/// Accuracy of the integrations.
const TOLERANCE: f64 = 1e-15;
const PLACE: &str = "beyond the article, section 5.2";

/// The phase on the meridian, for p_θ → 0.
pub(super) fn meridian_phase(k: Wide, t: Wide) -> Wide {
    let excess = (k - Wide::ONE) * (k + Wide::ONE);
    let rate = excess.abs().sqrt() / k;
    if excess < Wide::ZERO {
        // For k → 0 the hyperbolic functions overflow, their ratio does not.
        return t - (rate * t).tanh().atan2(rate);
    }
    // (w c + i s) exp(−iwt) = w c² + s² + i (1 − w) s c.
    let (s, c) = (rate * t).sin_cos();
    let short = Wide::ONE / (k * k * (Wide::ONE + rate));
    short * t - (short * s * c).atan2(rate * c * c + s * s)
}

/// The first conjugate time on the meridian, k ≠ 1: where the phase is π.
pub(super) fn meridian_time(k: Wide) -> Result<Wide, Unexamined> {
    let excess = (k - Wide::ONE) * (k + Wide::ONE);
    let (low, high) = if excess < Wide::ZERO {
        (Wide::PI, wide(1.5) * Wide::PI)
    } else {
        // The argument differs from wt by less than π/2.
        let short = Wide::ONE / (k * k * (Wide::ONE + excess.sqrt() / k));
        (wide(0.5) * Wide::PI / short, wide(1.5) * Wide::PI / short)
    };
    let root = bracketed(|t| meridian_phase(k, t) - Wide::PI, low, high, RootTolerance::full()).map_err(unexamined)?;
    Ok(root.x)
}

/// The first positive root of tan x = x.
fn tangent_root() -> Result<Wide, Unexamined> {
    let function = |x: Wide| x.sin() - x * x.cos();
    let root = bracketed(function, Wide::PI, wide(1.5) * Wide::PI, RootTolerance::full()).map_err(unexamined)?;
    Ok(root.x)
}

const ABOVE: Statement = Statement {
    id: "spin_meridian_above",
    place: PLACE,
    says: "For k > 1 and p_θ → 0 the first conjugate time solves w tan t = tan(wt), w² = 1 − 1/k²: where t − arg(w cos wt + i sin wt) = π.",
    method: "integration of the lift at p_θ = 1e-7 (corrections are quadratic), random k; the phase there",
    shape: Shape::Direct,
    forms: &["derived here", "tan t = w tan(wt)", "w² = k² − 1", "tan t = tan(wt)"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(531), Worst::default());
        for _ in 0..100 {
            let k = samples.log(1.005, 2.2);
            let (first, _) =
                first_conjugate_time_by_integration(k, 1e-7, TOLERANCE, 20.0 + 9.0 * k * k).map_err(unexamined)?;
            let t = first.t1;
            let w = ((k - 1.0) * (k + 1.0)).sqrt() / if form == 2 { 1.0 } else { k };
            let (s, c) = libm::sincos(w * t);
            let (across, along) = match form {
                1 => (w * s, c),
                3 => (s, c),
                _ => (s, w * c),
            };
            // The argument on the branch of wt.
            let argument = w * t + libm::atan2(across * c - along * s, along * c + across * s);
            worst.see((t - argument) / f64::PI - 1.0);
        }
        Ok(worst.at_most(1e-12, "rounding of the integration over up to ten turns, and the square of p_θ"))
    },
    note: "",
};

const BELOW: Statement = Statement {
    id: "spin_meridian_below",
    place: PLACE,
    says: "For k < 1 and p_θ → 0 the first conjugate time solves l tan t = tanh(lt), l² = 1/k² − 1, π < t < 3π/2.",
    method: "integration of the lift at small p_θ, one that the growth exp(lt) leaves small, random k",
    shape: Shape::Direct,
    forms: &["derived here", "tan t = l tanh(lt)", "l tan t = tan(lt)", "l² = 1 − k²"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(532), Worst::default());
        for _ in 0..100 {
            let k = samples.log(0.3, 0.99);
            let l = ((1.0 - k) * (1.0 + k)).sqrt() / if form == 3 { 1.0 } else { k };
            let (first, _) = first_conjugate_time_by_integration(k, 1e-13, TOLERANCE, 20.0).map_err(unexamined)?;
            let t = first.t1;
            let growth = if form == 2 { libm::tan(l * t) } else { libm::tanh(l * t) };
            let tangent = if form == 1 { l * growth } else { growth / l };
            worst.see((t - libm::atan(tangent)) / f64::PI - 1.0);
        }
        Ok(worst.at_most(1e-12, "the square of p_θ exp(lt), and rounding"))
    },
    note: "",
};

const ROUND: Statement = Statement {
    id: "spin_round_time",
    place: PLACE,
    says: "For k = 1 the first conjugate time is 2x/√(p_θ² + 4), x the first positive root of tan x = x.",
    method: "integration of the lift at random p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "x/√(p_θ² + 4)", "2x/√(p_θ² + 2)", "2x/(p_θ + 2)"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(533), Worst::default());
        let x = tangent_root()?.to_f64();
        for _ in 0..100 {
            let p = samples.log(1e-3, 1e3);
            let (first, _) = first_conjugate_time_by_integration(1.0, p, TOLERANCE, 10.0).map_err(unexamined)?;
            let time = match form {
                1 => x / (p * p + 4.0).sqrt(),
                2 => 2.0 * x / (p * p + 2.0).sqrt(),
                3 => 2.0 * x / (p + 2.0),
                _ => 2.0 * x / (p * p + 4.0).sqrt(),
            };
            worst.compare(first.t1, time, 0.0);
        }
        Ok(worst.at_most(1e-13, "rounding of the integration"))
    },
    note: "The Grushin case of [6], [7]: every extremal has Θ = s − arctan s, s = Gt/2.",
};

const FAST: Statement = Statement {
    id: "spin_fast_time",
    place: PLACE,
    says: "As p_θ → ∞, p_θ t1/(2k) → x, the first positive root of tan x = x, for every k.",
    method: "integration of the lift at p_θ/k = 1e8, where the correction (quadratic) is below rounding, random k",
    shape: Shape::Direct,
    forms: &["derived here", "p_θ t1/k", "p_θ t1/2", "x = 3π/2"],
    examine: |form| {
        let (mut samples, mut worst) = (Samples::new(534), Worst::default());
        let x = if form == 3 { 1.5 * f64::PI } else { tangent_root()?.to_f64() };
        for _ in 0..100 {
            let k = samples.log(0.05, 20.0);
            let p = 1e8 * k.max(1.0);
            let (first, _) = first_conjugate_time_by_integration(k, p, TOLERANCE, 20.0 * k / p).map_err(unexamined)?;
            let below = [2.0 * k, k, 2.0, 2.0 * k][form.min(3)];
            worst.compare(p * first.t1 / below, x, 0.0);
        }
        Ok(worst.at_most(1e-12, "rounding of the integration"))
    },
    note: "",
};

const CONTACT: Statement = Statement {
    id: "spin_contact_constant",
    place: "section 5.2, contact of order two as p_θ → ∞",
    says: "For any k the conjugate locus has a contact of order two at the start: θ ~ x/(2k) (φ − π/2)², x the first positive root of tan x = x.",
    method: "θ/(φ − π/2)² at conjugate points by integration, two steps of Richardson's extrapolation in 1/p_θ², random k",
    shape: Shape::Direct,
    forms: &[
        "the order as printed, the constant derived here",
        "x/k",
        "kx/2",
        "order one: θ/(φ − π/2) tends to a limit",
    ],
    examine: contact,
    note: "The order is the article's; the constant is new.",
};

fn contact(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(535), Worst::default());
    let x = tangent_root()?.to_f64();
    for _ in 0..100 {
        let k = samples.log(0.2, 5.0);
        let quotient = |scale: f64| -> Result<f64, Unexamined> {
            let p = scale * k.max(1.0);
            let (first, _) = first_conjugate_time_by_integration(k, p, TOLERANCE, 20.0 * k / p).map_err(unexamined)?;
            let (theta, phi) = first.angles();
            let off = phi - 0.5 * f64::PI;
            Ok(theta / if form == 3 { off } else { off * off })
        };
        let (a, b, c) = (quotient(200.0)?, quotient(400.0)?, quotient(800.0)?);
        let (ab, bc) = ((4.0 * b - a) / 3.0, (4.0 * c - b) / 3.0);
        let limit = (16.0 * bc - ab) / 15.0;
        let constant = match form {
            1 => x / k,
            2 => 0.5 * k * x,
            _ => 0.5 * x / k,
        };
        worst.compare(limit, constant, 0.0);
    }
    Ok(worst.at_most(1e-10, "extrapolation, of differences of angles that keep ten digits"))
}

const CUSP_BELOW_ONE: Statement = Statement {
    id: "spin_cusp_below_one",
    place: "section 5.2.3",
    says: "For every k < 1 the cusp does not cross the equator: π < t1 < x for p_θ → 0, x the first positive root of tan x = x, so that it stays between the antipode of the start and \
           the cusp of k = 1.",
    method: "first conjugate points in closed form at p_θ = 0 for random k, half of them evenly in the logarithm down to 1e-4, half close to 1",
    shape: Shape::Direct,
    forms: &["as printed, with the bounds derived here", "for k > 1 too", "below 5π/4"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(536), Cases::default());
        let x = tangent_root()?.to_f64();
        for case in 0..150 {
            let k = match (form, case % 2) {
                (1, _) => samples.log(1.01, 3.0),
                (_, 0) => samples.log(1e-4, 1.0),
                _ => 1.0 - samples.log(1e-6, 0.9999),
            };
            let start = Start::new(k, 0.0).map_err(unexamined)?;
            let point = first_conjugate_point(&start).map_err(unexamined)?;
            let high = if form == 2 { 1.25 * f64::PI } else { x };
            let inside = point.t1 > f64::PI && point.t1 < high && point.r[1] < 0.0;
            cases.see(inside, || format!("k = {k:?}: t1 = {:?}, r2 = {:?}", point.t1, point.r[1]));
        }
        Ok(cases.none())
    },
    note: "",
};

const CUSP_MOVES: Statement = Statement {
    id: "spin_cusp_moves",
    place: "section 5.2.3",
    says: "The cusp moves along the meridian with k in one direction: t1 for p_θ → 0 increases with k over the whole range, from π without bound.",
    method: "the solution of the limit equations at neighbouring k from 1e-3 to 30 in double-double, k = 1 included between",
    shape: Shape::Direct,
    forms: &["as printed, with the direction", "decreasing", "increasing by more than π a step"],
    examine: |form| {
        let mut cases = Cases::default();
        let mut before = Wide::PI;
        for step in 0..100 {
            let k = libm::exp(libm::log(1e-3) + libm::log(3e4) * f64::from(step) / 99.0);
            let time = meridian_time(wide(k))?;
            let holds = match form {
                1 => time < before,
                2 => time - before > Wide::PI,
                _ => time > before,
            };
            cases.see(holds, || format!("k = {k:?}: t1 = {:?}", time.to_f64()));
            before = time;
        }
        Ok(cases.none())
    },
    note: "So for k > 1 the cusp passes pole and equator in turn, for ever.",
};

const SMALL_K: Statement = Statement {
    id: "spin_cusp_for_small_k",
    place: PLACE,
    says: "As k → 0 the cusp tends to the antipode of the start on the equator, t1 = π + k + O(k³).",
    method: "the limit equation in double-double at small k, extrapolated",
    shape: Shape::Direct,
    forms: &["derived here", "π + 2k", "π + k²", "π + k/2"],
    examine: |form| {
        let mut worst = Worst::default();
        for step in 1..=100 {
            let k = wide(1e-4 * f64::from(step));
            let coefficient = |k: Wide| -> Result<Wide, Unexamined> { Ok((meridian_time(k)? - Wide::PI) / k) };
            // Quadratic corrections: one step of Richardson's extrapolation leaves k⁴.
            let limit = (wide(4.0) * coefficient(k / wide(2.0))? - coefficient(k)?) / wide(3.0);
            let expected = match form {
                1 => wide(2.0),
                2 => k,
                3 => wide(0.5),
                _ => Wide::ONE,
            };
            worst.see((limit - expected).to_f64());
        }
        Ok(worst.at_most(1e-8, "the fourth power of k ≤ 0.01"))
    },
    note: "",
};

const LARGE_K: Statement = Statement {
    id: "spin_cusp_for_large_k",
    place: PLACE,
    says: "As k → ∞, t1 ~ 2πk² for p_θ → 0.",
    method: "the limit equation in double-double at k from 10 to 1000, the part that is linear in 1/k² extrapolated away",
    shape: Shape::Direct,
    forms: &["derived here", "πk²", "2πk", "4πk²"],
    examine: |form| {
        let mut worst = Worst::default();
        for step in 0..100 {
            let k = wide(10.0 + 10.0 * f64::from(step));
            let expected = |k: Wide| match form {
                1 => Wide::PI * k * k,
                2 => wide(2.0) * Wide::PI * k,
                3 => wide(4.0) * Wide::PI * k * k,
                _ => wide(2.0) * Wide::PI * k * k,
            };
            let ratio = |k: Wide| -> Result<Wide, Unexamined> { Ok(meridian_time(k)? / expected(k)) };
            let limit = (wide(4.0) * ratio(wide(2.0) * k)? - ratio(k)?) / wide(3.0);
            worst.see((limit - Wide::ONE).to_f64());
        }
        Ok(worst.at_most(1e-5, "higher powers of 1/k for k ≥ 10"))
    },
    note: "",
};
