//! Statements of section 3.3.1 on Jacobi fields and conjugate points of a surface of revolution: the field of Lemma 3.13, Lemmas 3.14 to 3.19.
//!
//! Variations are integrated on the surfaces of [`super::surface`], tame ones and others.

use super::bodies::{by_differences, direct, integral};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Statement, Unexamined, Worst, unexamined};
use super::surface::Surface;
use super::surfaces_of_revolution::{energy, point};
use crate::contract::claim::Test;
use crate::numerics::real::Real;
use crate::numerics::roots::{RootTolerance, bracketed};

fn euler_field(form: Form) -> Result<Test, Unexamined> {
    by_differences(907, |samples| {
        let x = point(samples);
        // H⃗ at (φ; p_φ, p_θ) with p scaled: [H⃗, V] = DV·H⃗ − DH⃗·V for V = p ∂_p.
        let field = |scale: Wide, i: usize| {
            let p = [x[3] * scale, x[4] * scale];
            match i {
                0 => p[0],
                1 => p[1] * (Wide::ONE + x[0] * x[2] + x[1] * x[2] * x[2]),
                _ => -slope_of_order_4(|phi| energy([x[0], x[1], phi, p[0], p[1]]), x[2], 1e-5),
            }
        };
        let i = (samples.even(0.0, 3.0) as usize).min(2);
        let here = field(Wide::ONE, i);
        let along = if i == 2 { here } else { Wide::ZERO };
        let commutator = along - slope_of_order_4(|scale| field(scale, i), Wide::ONE, 1e-5);
        let right = match form {
            1 => here,
            2 => -(wide(2.0) * here),
            _ => -here,
        };
        [commutator, right, wide(1e-3)]
    })
}

fn collinearity(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(908), Worst::default());
    for case in 0..100 {
        let surface = if case % 2 == 0 { Surface::tame(&mut samples) } else { Surface::any(&mut samples) };
        let x = surface.after(&surface.start(), samples.even(0.1, 0.9) * surface.period())?;
        let left = match form {
            1 => x[1] * x[3] - surface.p * x[5],
            2 => surface.p * x[3] + x[1] * x[5],
            _ => x[1] * x[3] + surface.p * x[5],
        };
        worst.compare(left, 0.0, x[3].abs() + x[5].abs());
    }
    Ok(worst.at_most(1e-12, "error of a Runge-Kutta pair over a period"))
}

fn no_point_while_ascending(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(909), Cases::default());
    for case in 0..100 {
        let surface = if case % 2 == 0 { Surface::tame(&mut samples) } else { Surface::hard(&mut samples) };
        let part = match form {
            1 => 0.75,
            2 => 0.5,
            _ => 0.25,
        };
        cases.see(surface.no_conjugate_point(part * surface.period())?, || format!("{surface:?}"));
    }
    Ok(cases.none())
}

fn tame_flow(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(910), Cases::default());
    for _ in 0..100 {
        let surface = if form == 1 { Surface::hard(&mut samples) } else { Surface::tame(&mut samples) };
        let p = wide(surface.p);
        let falls = slope_of_order_4(|p| surface.returns(p)[1], p, 1e-5 * surface.p) < Wide::ZERO;
        let part = if form == 2 { 0.75 } else { 0.5 };
        let none = surface.no_conjugate_point(part * surface.period())?;
        cases.see(falls != (form == 1) && none, || format!("{surface:?}"));
    }
    Ok(cases.none())
}

fn equator_point(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(913), Cases::default());
    for case in 0..100 {
        let mut surface = Surface::tame(&mut samples);
        // G(0) = a, the largest value on these surfaces. On the equator, p_θ = 1 and p_φ = 0, δφ starts with δp_φ.
        let time = match form {
            1 => std::f64::consts::PI / surface.a,
            2 => 2.0 * std::f64::consts::PI / surface.a.sqrt(),
            _ => std::f64::consts::PI / surface.a.sqrt(),
        };
        // max G = G(0), looked at where geodesics go.
        let top = surface.turning(wide(surface.p)).to_f64().max(0.5 / surface.a.sqrt());
        let highest = (1..=20).all(|i| surface.curvature(top * f64::from(i) / 20.0) < surface.curvature(0.0));
        let holds = highest
            && if case % 2 == 0 {
                surface.p = 1.0;
                let along = |t: f64| surface.after(&[0.0, 0.0, 0.0, 0.0, -1.0, 0.0], t);
                along(time * (1.0 - 1e-6))?[3] < along(time * (1.0 + 1e-6))?[3] && along(time)?[3].abs() < 1e-10
            } else {
                surface.no_conjugate_point(time)?
            };
        cases.see(holds, || format!("{surface:?}"));
    }
    Ok(cases.none())
}

fn equation_24(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(914), Worst::default());
    for _ in 0..100 {
        let surface = Surface::tame(&mut samples);
        let (period, p) = (surface.period(), wide(surface.p));
        let middle = surface.after(&surface.start(), period / 2.0)?;
        let variation = |t: f64| surface.after(&middle, t).map_or(f64::NAN, |x| x[3]);
        let root = bracketed(variation, 0.0, period / 4.0, RootTolerance::full()).map_err(unexamined)?;
        let phi = wide(surface.after(&middle, root.x)?[0]);
        let (a, b, top) = (wide(surface.a), wide(surface.b), surface.turning(p));
        // ∂f/∂p_θ = W/(1 − p_θ² W)^(3/2); with φ = φ+ sin s and τ = tan s no root vanishes.
        let along = |tau: Wide| {
            let cosine2 = Wide::ONE / (Wide::ONE + tau * tau);
            let x = top * top * tau * tau * cosine2;
            let w = Wide::ONE + x * (a + b * x);
            let rest = p * p * top * top * cosine2 * (a + b * (top * top + x));
            let dphi = top * cosine2 * cosine2.sqrt();
            dphi * if form == 2 { w / rest.sqrt() } else { w / (rest * rest.sqrt()) }
        };
        let sine = phi / top;
        let tail = integral(along, sine / ((Wide::ONE - sine) * (Wide::ONE + sine)).sqrt(), Wide::ZERO, 16);
        let slope_of_return = slope_of_order_4(|p| surface.returns(p)[1], p, 1e-4 * surface.p);
        let left = match form {
            1 => slope_of_return - tail,
            3 => slope_of_return / wide(2.0) + tail,
            _ => slope_of_return + tail,
        };
        worst.see((left / tail).to_f64());
    }
    Ok(worst.at_most(1e-11, "error of the integration, magnified where the geodesic turns"))
}

/// `P(t)/p_θ` at a random place: the variation that starts with `δp = p`, carried along by the flow; the time, and the energy.
fn carried(samples: &mut Samples) -> Result<(Surface, [f64; 6], f64, f64), Unexamined> {
    let surface = if samples.sign() > 0.0 { Surface::tame(samples) } else { Surface::hard(samples) };
    // Any energy below that of the motion that the surface is made for.
    let [_, p_phi, ..] = surface.start();
    let from = surface.after(&surface.start(), samples.even(0.0, 1.0) * surface.period())?;
    let p_phi = if samples.sign() > 0.0 { from[1] } else { 0.9 * samples.even(-1.0, 1.0) * p_phi.min(from[1].abs()) };
    let t = samples.even(0.1, 1.0) * surface.period();
    let end = surface.after(&[from[0], p_phi, 0.0, 0.0, p_phi / surface.p, 0.0], t)?;
    let [w, ..] = surface.inverse_mu(from[0]);
    Ok((surface, end, t, 0.5 * (p_phi * p_phi + surface.p * surface.p * w)))
}

fn energy_of_field(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(915), Worst::default());
    for _ in 0..100 {
        let (surface, end, t, h) = carried(&mut samples)?;
        let p = surface.p;
        let value = p * (end[1] * end[3] + p * end[5]);
        let factor = match form {
            1 => 1.0,
            2 => 4.0,
            _ => 2.0,
        };
        // What is added up: two products that may cancel.
        let scale = p * ((end[1] * end[3]).abs() + (p * end[5]).abs());
        worst.compare(value, factor * t * h, scale);
    }
    Ok(worst.at_most(1e-12, "error of a Runge-Kutta pair over a period"))
}

fn field_is_sum(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(919), Worst::default());
    for _ in 0..100 {
        let (surface, end, t, _) = carried(&mut samples)?;
        let p = surface.p;
        let [w, w1, _] = surface.inverse_mu(end[0]);
        let t = match form {
            1 => -t,
            2 => 2.0 * t,
            _ => t,
        };
        // V = p ∂_p at the end, and H⃗ there.
        let sum = [t * end[1], end[1] - t * 0.5 * p * p * w1, t * p * w];
        let size = sum.iter().map(|x| x.abs()).fold(p, f64::max);
        (0..3).for_each(|i| worst.see((p * end[3 + i] - sum[i]) / size));
    }
    Ok(worst.at_most(1e-11, "error of a Runge-Kutta pair over a period"))
}

fn pairing(form: Form) -> Result<Test, Unexamined> {
    by_differences(917, |samples| {
        let [a, b, phi, _, part] = point(samples);
        let w = Wide::ONE + a * phi + b * phi * phi;
        let p = part / wide(3.2) / w.sqrt();
        // All p with H = 1/2 over one point: δp is the derivative along them.
        let p_phi = |p: Wide| (Wide::ONE - p * p * w).sqrt();
        let change = slope_of_order_4(p_phi, p, 1e-6 * p.to_f64());
        let left = match form {
            1 => p_phi(p) * change + p,
            2 => p_phi(p) * change - p * w,
            _ => p_phi(p) * change + p * w,
        };
        [left, Wide::ZERO, p * w]
    })
}

/// `δφ`, `δθ` by the impulses `p_φ` and `p_θ` at the start, as one determinant.
fn determinant(surface: &Surface, t: f64) -> Result<f64, Unexamined> {
    let [_, p_phi, ..] = surface.start();
    let column = |by_p_phi: f64| surface.after(&[0.0, p_phi, 0.0, 0.0, by_p_phi, 0.0], t);
    let (first, second) = (column(0.0)?, column(1.0)?);
    Ok(first[3] * second[5] - first[5] * second[3])
}

fn conjugate_points_by_field(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(918), Worst::default());
    for _ in 0..25 {
        let surface = Surface::tame(&mut samples);
        let (low, high) = (0.5 * surface.period(), 0.75 * surface.period());
        let value = |t: f64| determinant(&surface, t).unwrap_or(f64::NAN);
        let root = bracketed(value, low, high, RootTolerance::full()).map_err(unexamined)?;
        let from = match form {
            // Variations that change the energy.
            1 => [0.0, surface.start()[1], 0.0, 0.0, 0.0, 0.0],
            2 => surface.start().map(|x| x.abs()),
            _ => surface.start(),
        };
        let (end, before) = (surface.after(&from, root.x)?, surface.after(&from, low)?);
        // Relative to what the field is half a period after the start.
        worst.see(end[3] / before[3].abs());
        worst.see(end[5] / (before[3].abs() * surface.start()[1] / surface.p));
    }
    Ok(worst.at_most(1e-10, "error of a Runge-Kutta pair, and a root of a determinant that cancels"))
}

/// `[t, φ, θ]` of the first conjugate point of a geodesic with `p_θ < 1`, between T/2 and 3T/4.
fn conjugate_point(surface: &Surface) -> Result<[f64; 3], Unexamined> {
    let period = surface.period();
    let middle = surface.after(&surface.start(), period / 2.0)?;
    let variation = |t: f64| surface.after(&middle, t).map_or(f64::NAN, |x| x[3]);
    let root = bracketed(variation, 0.0, period / 4.0, RootTolerance::full()).map_err(unexamined)?;
    let [phi, _, theta, ..] = surface.after(&middle, root.x)?;
    Ok([period / 2.0 + root.x, phi, theta])
}

fn cusp_on_equator(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(920), Worst::default());
    for _ in 0..60 {
        let surface = Surface::tame(&mut samples);
        let end = std::f64::consts::PI / surface.a.sqrt();
        // Conjugate points of two geodesics close to the equator, the squares of their p_φ one to four.
        let at = |square: f64| conjugate_point(&Surface { p: (1.0 - square).sqrt(), ..surface });
        let (near, far) = (at(1e-5)?, at(4e-5)?);
        let [along, across] = [(far[2] - end) / (near[2] - end), far[1] / near[1]];
        let (expected_along, expected_across) = match form {
            1 => (8.0, 4.0),
            2 => (2.0, 4.0),
            3 => (4.0, 4.0),
            _ => (4.0, 8.0),
        };
        worst.see(along / expected_along - 1.0);
        worst.see(across / expected_across - 1.0);
        worst.see(if far[0] > near[0] && near[0] > end { 0.0 } else { 1.0 });
    }
    Ok(worst.at_most(1e-2, "the next power of the distance from the equator"))
}

const PLACE: &str = "section 3.3.1";

const SURFACES: &str = "geodesics of 1/μ = 1 + aφ² + bφ⁴ with their variation, by a Runge-Kutta pair";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "poincare_commutator",
            PLACE,
            "[H⃗, V] = −H⃗ for V = p ∂_p, so that P(t) = V + tH⃗.",
            "difference quotients; [X, Y] = DY·X − DX·Y",
        ],
        &["as printed", "the sign", "twice that"],
        euler_field,
        "",
    ),
    direct(
        [
            "poincare_field",
            PLACE,
            "The flow carries V = p ∂_p along to P(t) = V + tH⃗.",
            "the integrated variation that starts with δp = p, against both fields where it ends",
        ],
        &["as printed", "V − tH⃗", "V + 2tH⃗"],
        field_is_sum,
        "",
    ),
    direct(
        [
            "poincare_field_is_transversal",
            PLACE,
            "ω(P(t)) = t p ∂H/∂p = 2tH.",
            "p δq of the integrated variation that starts with δp = p, any energy",
        ],
        &["as printed", "tH", "4tH"],
        energy_of_field,
        "",
    ),
    direct(
        [
            "variation_of_impulse",
            "before Definition 3.12",
            "At arc length ⟨p, δp⟩ = p_φ δp_φ + p_θ δp_θ/μ = 0 for variations with δq = 0.",
            "p_φ as a function of p_θ at H = 1/2, by difference quotients",
        ],
        &["as printed", "without 1/μ", "a sign"],
        pairing,
        "The product is that of H: with the plain one, p_φ δp_φ + p_θ δp_θ, it is false.",
    ),
    direct(
        [
            "conjugate_points_by_field",
            "Lemma 3.13",
            "The end-point map degenerates where δφ = ∂φ/∂p_θ and δθ = ∂θ/∂p_θ, at a fixed energy, vanish together.",
            "the field where the determinant of the derivatives by both impulses vanishes",
        ],
        &["as printed", "p_φ held, not the energy", "δp_φ of the other sign"],
        conjugate_points_by_field,
        "",
    ),
    direct(
        [
            "collinearity",
            "eq. (23), Lemma 3.13",
            "p_φ ∂φ/∂p_θ + p_θ ∂θ/∂p_θ = 0 for all t, at a fixed energy.",
            SURFACES,
        ],
        &["as printed", "a sign", "p_φ and p_θ exchanged"],
        collinearity,
        "So a point is conjugate as soon as ∂φ/∂p_θ = 0, where p_θ ≠ 0.",
    ),
    direct(
        ["no_point_while_ascending", "Lemma 3.14", "While φ' > 0 there is no conjugate point.", SURFACES],
        &["as printed", "up to 3T/4", "up to T/2 on every surface"],
        no_point_while_ascending,
        "",
    ),
    direct(
        ["tame_flow", "Proposition 3.17", "If R'(p_θ) < 0 the extremal has no conjugate point on (0, T/2).", SURFACES],
        &["as printed", "R' > 0", "on (0, 3T/4)"],
        tame_flow,
        "",
    ),
    direct(
        [
            "equator_point",
            "Lemma 3.18",
            "If G(0) = max G > 0, the first conjugate time on the equator is π/√G(0), and no geodesic from there has an earlier one.",
            "geodesics of 1/μ = 1 + aφ² + bφ⁴ with their variation, any p_θ, by a Runge-Kutta pair; G on a grid",
        ],
        &["as printed", "π/G(0)", "2π/√G(0)"],
        equator_point,
        "",
    ),
    direct(
        [
            "cusp_on_equator",
            "Lemma 3.18",
            "The conjugate locus of (0, 0) has a cusp at the equator's conjugate point, and later conjugate times beside it: for p_φ(0) → 0, \
             θ* − θ*(0) falls like p_φ(0)² and φ* like its cube.",
            "conjugate points of two geodesics close to the equator",
        ],
        &["as printed, with the powers", "the powers exchanged", "the first and the second power", "both squares"],
        cusp_on_equator,
        "",
    ),
    direct(
        [
            "equation_24",
            "eq. (24), Lemma 3.19",
            "The conjugate time in (T/2, 3T/4) solves Δθ'(p_θ) + ∫ ∂f/∂p_θ dζ = 0, from φ to 0.",
            "conjugate times of integrated variations",
        ],
        &["as printed", "a sign", "an exponent of ∂f/∂p_θ", "half of Δθ'"],
        equation_24,
        "",
    ),
];
