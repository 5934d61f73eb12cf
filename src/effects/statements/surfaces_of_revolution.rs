//! Statements of section 3.3.1: geodesics and conjugate points on a surface of revolution `dφ² + μ(φ) dθ²`.
//!
//! Most are checked on the surfaces of [`super::surface`], tame ones and others.

use super::bodies::{by_differences, direct, identity, integral};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use super::surface::Surface;
use crate::contract::claim::Test;
use crate::numerics::real::Real;
use crate::numerics::roots::{RootTolerance, bracketed};

/// `(a, b, φ, p_φ, p_θ)` of a surface without symmetry, `1/μ = 1 + aφ + bφ²`.
fn point(samples: &mut Samples) -> [Wide; 5] {
    let [a, b] = [0; 2].map(|_| wide(samples.even(0.1, 0.9)));
    [a, b, wide(samples.even(-0.8, 0.8)), wide(samples.even(-2.0, 2.0)), wide(samples.sign() * samples.even(0.2, 3.0))]
}

fn energy([a, b, phi, p_phi, p_theta]: [Wide; 5]) -> Wide {
    (p_phi * p_phi + p_theta * p_theta * (Wide::ONE + a * phi + b * phi * phi)) / wide(2.0)
}

fn flow_21(form: Form) -> Result<Test, Unexamined> {
    by_differences(901, |samples| {
        let x = point(samples);
        let [a, b, phi, _, p_theta] = x;
        let mu = |phi: Wide| Wide::ONE / (Wide::ONE + a * phi + b * phi * phi);
        let left = -slope_of_order_4(|phi| energy([a, b, phi, x[3], p_theta]), phi, 1e-5);
        let printed = slope_of_order_4(mu, phi, 1e-5) / (wide(2.0) * mu(phi) * mu(phi));
        let right = match form {
            0 => printed,
            2 => -(printed * p_theta * p_theta),
            3 => printed * p_theta * p_theta * mu(phi),
            _ => printed * p_theta * p_theta,
        };
        [left, right, wide(1e-3)]
    })
}

fn slope_22(form: Form) -> Result<Test, Unexamined> {
    by_differences(902, |samples| {
        let [a, b, phi, ..] = point(samples);
        let mu = Wide::ONE / (Wide::ONE + a * phi + b * phi * phi);
        let p = wide(samples.even(0.05, 0.95)) * mu.sqrt();
        // Arc length: p_φ² = 1 − p_θ²/μ; dθ/dφ from the derivatives of H.
        let p_phi = (Wide::ONE - p * p / mu).sqrt();
        let theta = slope_of_order_4(|p| energy([a, b, phi, p_phi, p]), p, 1e-6);
        let along = slope_of_order_4(|x| energy([a, b, phi, x, p]), p_phi, 1e-6);
        let right = match form {
            1 => p / (mu.sqrt() * (mu + p * p).sqrt()),
            2 => p / (mu - p * p).sqrt(),
            _ => p / (mu.sqrt() * (mu - p * p).sqrt()),
        };
        // φ'² + μθ'² = 1 comes with it.
        let length = along * along + mu * theta * theta;
        [theta / along * length, right, Wide::ZERO]
    })
}

fn range_of_clairaut(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(903), Cases::default());
    for _ in 0..300 {
        let [a, b, phi, ..] = point(&mut samples);
        let mu = Wide::ONE / (Wide::ONE + a * phi + b * phi * phi);
        let limit = match form {
            0 => mu,
            2 => mu * mu,
            3 => Wide::ONE / mu.sqrt(),
            _ => mu.sqrt(),
        };
        // H = 1/2 leaves p_φ² ≥ 0 just inside and not just outside.
        let real = |p: Wide| energy([a, b, phi, Wide::ZERO, p]) <= wide(0.5);
        let holds = real(limit * wide(1.0 - 1e-9)) && !real(limit * wide(1.0 + 1e-9));
        cases.see(holds, || format!("μ(φ0) = {}", mu.to_f64()));
    }
    Ok(cases.none())
}

fn parallels(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(904), Cases::default());
    for case in 0..300 {
        let [a, b, ..] = point(&mut samples);
        let critical = -(a / (wide(2.0) * b));
        let phi = match (form, case % 2) {
            (1, 0) => Wide::ZERO,
            (_, 0) => critical,
            _ => critical + wide(samples.sign() * samples.even(0.01, 1.0)),
        };
        let rate = -slope_of_order_4(|phi| energy([a, b, phi, Wide::ZERO, Wide::ONE]), phi, 1e-5);
        let rests = rate.abs() < wide(1e-18);
        let expected = if form == 2 { case % 2 == 1 } else { case % 2 == 0 };
        cases.see(rests == expected, || format!("φ = {}", phi.to_f64()));
    }
    Ok(cases.none())
}

fn parallels_are_extrema(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(905), Cases::default());
    for _ in 0..200 {
        let [a, b, _, _, p] = point(&mut samples);
        let sign = wide(samples.sign());
        // V = p²/μ around a parallel at φ = 0: 1/μ = 1 ± aφ² + bφ³, or without the square.
        let square = if form == 1 { Wide::ZERO } else { sign * a };
        let v = |phi: Wide| {
            let linear = if form == 2 { a } else { Wide::ZERO };
            let inverse = Wide::ONE + linear * phi + square * phi * phi + b * phi * phi * phi;
            p * p * inverse
        };
        let near = wide(1e-4);
        let (left, right) = (v(-near) - v(Wide::ZERO), v(near) - v(Wide::ZERO));
        let opposite = left * right < Wide::ZERO;
        cases.see(opposite == (form == 3), || format!("a = {}, b = {}", square.to_f64(), b.to_f64()));
    }
    Ok(cases.none())
}

fn gauss_curvature(form: Form) -> Result<Test, Unexamined> {
    by_differences(906, |samples| {
        let (big, small) = (wide(samples.even(1.2, 3.0)), wide(samples.even(0.3, 1.0)));
        let u = wide(samples.even(-1.2, 1.2));
        let torus = samples.sign() > 0.0;
        // A torus and an ellipsoid of revolution in space: distance from the axis √μ, arc length along the meridian, and the product of the
        // principal curvatures.
        let radius = |u: Wide| if torus { big + small * u.cos() } else { big * u.cos() };
        let stretch = |u: Wide| {
            let (s, c) = u.sin_cos();
            if torus { small } else { (big * big * s * s + small * small * c * c).sqrt() }
        };
        let (s, c) = u.sin_cos();
        let square = big * big * s * s + small * small * c * c;
        let truth = if torus { c / (small * radius(u)) } else { small * small / (square * square) };
        let first = |u: Wide| slope_of_order_4(radius, u, 1e-4) / stretch(u);
        let second = slope_of_order_4(first, u, 1e-4) / stretch(u);
        let value = match form {
            1 => second / radius(u),
            2 => -second,
            3 => {
                -(slope_of_order_4(|u| slope_of_order_4(|u| radius(u) * radius(u), u, 1e-4) / stretch(u), u, 1e-4)
                    / stretch(u))
                    / (radius(u) * radius(u))
            }
            _ => -(second / radius(u)),
        };
        [truth, value, wide(0.1)]
    })
}

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

fn period_and_return(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(911), Worst::default());
    for case in 0..80 {
        let surface = if case % 2 == 0 { Surface::tame(&mut samples) } else { Surface::any(&mut samples) };
        let [period, first_return] = surface.returns(wide(surface.p)).map(|x| x.to_f64());
        let period = if form == 1 { 2.0 * period } else { period };
        // Half a period later: on the equator, descending, θ grown by the first return; a quarter: at φ+.
        let half = surface.after(&surface.start(), period / 2.0)?;
        worst.see(half[0]);
        worst.compare(half[2], if form == 2 { 2.0 * first_return } else { first_return }, 0.0);
        let quarter = surface.after(&surface.start(), period / 4.0)?;
        worst.see(quarter[1]);
    }
    Ok(worst.at_most(1e-12, "error of a Runge-Kutta pair over half a period"))
}

fn slopes_of_both(form: Form) -> Result<Test, Unexamined> {
    identity(912, 100, 1e-11, "means of 24 values, difference quotients", |samples| {
        let surface = if samples.sign() > 0.0 { Surface::tame(samples) } else { Surface::any(samples) };
        let p = wide(surface.p);
        let by = |i: usize| slope_of_order_4(|p| surface.returns(p)[i], p, 1e-4 * surface.p);
        let right = match form {
            1 => by(0) / p,
            2 => by(0) * p / wide(2.0),
            3 => -(by(0) / (wide(2.0) * p)),
            _ => by(0) / (wide(2.0) * p),
        };
        [by(1), right, wide(1e-3)]
    })
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

fn rest_of_21(form: Form) -> Result<Test, Unexamined> {
    by_differences(916, |samples| {
        let x = point(samples);
        let [a, b, phi, p_phi, p_theta] = x;
        let w = Wide::ONE + a * phi + b * phi * phi;
        if samples.sign() > 0.0 {
            let left = slope_of_order_4(|p| energy([a, b, phi, p, p_theta]), p_phi, 1e-5);
            [left, if form == 1 { -p_phi } else { p_phi }, Wide::ONE]
        } else {
            let left = slope_of_order_4(|p| energy([a, b, phi, p_phi, p]), p_theta, 1e-5);
            let right = match form {
                2 => p_theta / w,
                3 => p_theta * p_theta * w,
                _ => p_theta * w,
            };
            [left, right, wide(1e-3)]
        }
    })
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
const TRANSCRIPTION: &str =
    "Known to us through a transcription of the page, which may have lost a sign, a root, an exponent or a factor.";
const SURFACES: &str = "geodesics of 1/μ = 1 + aφ² + bφ⁴ with their variation, by a Runge-Kutta pair";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    Statement {
        id: "flow_21",
        place: "eq. (21)",
        says: "p_φ' = ½ μ'/μ².",
        method: "difference quotients of H on surfaces without symmetry",
        shape: Shape::Slip { correction: "p_φ' = ½ p_θ² μ'/μ²" },
        forms: &["as printed", "with p_θ²", "the sign", "μ for μ²"],
        examine: flow_21,
        note: TRANSCRIPTION,
    },
    direct(
        [
            "rest_of_21",
            "eq. (21)",
            "φ' = p_φ and θ' = p_θ/μ.",
            "difference quotients of H on surfaces without symmetry",
        ],
        &["as printed", "−p_φ", "p_θ μ", "p_θ²/μ"],
        rest_of_21,
        "",
    ),
    direct(
        [
            "slope_22",
            "eq. (22)",
            "At arc length dθ/dφ = p_θ/(√μ √(μ − p_θ²)) on the ascending branch.",
            "difference quotients of H",
        ],
        &["as printed", "μ + p_θ²", "without √μ"],
        slope_22,
        "The text at hand writes g(φ, θ) for g(φ, p_θ) before it.",
    ),
    Statement {
        id: "range_of_clairaut",
        place: PLACE,
        says: "Geodesics through φ0 with p_θ > 0 have p_θ in (0, μ(φ0)).",
        method: "whether H = 1/2 leaves a real p_φ just inside and just outside, on surfaces without symmetry",
        shape: Shape::Slip { correction: "p_θ in (0, √μ(φ0))" },
        forms: &["as printed", "√μ", "μ²", "1/√μ"],
        examine: range_of_clairaut,
        note: "Lemma 3.14 and Definition 3.15 have the root. Known to us through a transcription of the page, which may have lost a sign, a root or a factor.",
    },
    direct(
        [
            "parallels",
            PLACE,
            "φ(t) = φ0 with p_φ = 0 is a solution if and only if μ'(φ0) = 0.",
            "p_φ' at and beside critical points of μ",
        ],
        &["as printed", "at φ = 0", "where μ' ≠ 0"],
        parallels,
        "",
    ),
    Statement {
        id: "parallels_are_extrema",
        place: PLACE,
        says: "Parallel solutions correspond to local extrema of V(p_θ, ·) = p_θ²/μ.",
        method: "V on both sides of a parallel",
        shape: Shape::OnlyWhen {
            condition: "the first derivative of μ that does not vanish there is of even order; else, as at φ = 0 of 1/μ = 1 + bφ³, it is a parallel \
                        and no extremum",
        },
        forms: &["μ'' ≠ 0", "μ'' = 0, μ''' ≠ 0", "μ' ≠ 0", "V grows or falls through it"],
        examine: parallels_are_extrema,
        note: "",
    },
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
        [
            "period_and_first_return",
            "Definition 3.15",
            "T/4 = ∫ g dφ and Δθ = 2 ∫ f dφ from 0 to φ+; the equator is met again at T/2.",
            SURFACES,
        ],
        &["as printed", "T for T/2", "4 ∫ f"],
        period_and_return,
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
            "gauss_curvature_formula",
            PLACE,
            "G = −(√μ)''/√μ.",
            "product of the principal curvatures of tori and ellipsoids in space",
        ],
        &["as printed", "the sign", "without 1/√μ", "μ for √μ"],
        gauss_curvature,
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
    direct(
        [
            "slopes_of_return_and_period",
            "Lemma 3.20",
            "R'(p_θ) = T'(p_θ)/(2 p_θ).",
            "difference quotients of both integrals, tame and other surfaces",
        ],
        &["as printed", "without the two", "p_θ above", "the sign"],
        slopes_of_both,
        "",
    ),
];
