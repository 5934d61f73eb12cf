//! Statements of section 3.3.3 on the conjugate locus: Theorem 3.24 and its proof, Remark 3.25.
//!
//! At arc length, `2h = 1`. Integrals over φ are taken over `y`, `dφ = dy/√(C − Z)`; conjugate points are zeros of the integrated variation of
//! (9), or, where they are differentiated by `p_θ`, the closed form of the `geometry` room in double-double.

use super::bodies::{Body, Motion, direct, identity, integral, unit};
use super::darboux_form::{body_and_phi, z_at};
use super::differences::{Wide, slope_of_order_4, slopes_of_order_4, wide};
use super::first_return::{first_return, motion, step_of};
use super::kinds_of_motion::states;
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::{SerretAndoyerFlow, first_conjugate_time_by_integration};
use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Metric, Start, first_conjugate_point};
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{Settings, integrate};

/// `f`, `∂f/∂p_θ`, `∂²f/∂p_θ²` where `μ` is `1/Z`.
fn f(z: Wide, p: Wide) -> [Wide; 3] {
    let rest = Wide::ONE - p * p * z;
    let root = rest.sqrt();
    [p * z / root, z / (rest * root), wide(3.0) * p * z * z / (rest * rest * root)]
}

/// The integral of one of these over φ, between two y short of the turning points.
///
/// With `sin a = −cos y = √ξ1 tanh u` the root `1 − p_θ² Z = p_θ² (B − A) ξ1/cosh² u` is no singularity any more.
fn over_phi(body: &Body, p: Wide, which: usize, from: Wide, to: Wide) -> Wide {
    let Body { a, b, c } = *body;
    let (one, gain) = (Wide::ONE, ((one_over_square(p) - a) / (b - a)).sqrt());
    let u_of = |y: Wide| {
        let x = -(y.cos() / gain);
        ((one + x) / (one - x)).ln() / wide(2.0)
    };
    let along = |u: Wide| {
        let tanh = u.tanh();
        let (sine, sech_squared) = (gain * tanh, (one - tanh) * (one + tanh));
        let z = a + (b - a) * sine * sine;
        // dy = √ξ1/(cosh² u cos a) du.
        let dy = gain * sech_squared / ((one - sine) * (one + sine)).sqrt();
        let root = p * gain * ((b - a) * sech_squared).sqrt();
        let value = match which {
            0 => p * z / root,
            1 => z / (root * root * root),
            _ => wide(3.0) * p * z * z / (root * root * root * root * root),
        };
        value * dy / (c - z).sqrt()
    };
    integral(along, u_of(from), u_of(to), 8)
}

fn one_over_square(p: Wide) -> Wide {
    Wide::ONE / (p * p)
}

fn slopes_of_f(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1008), Worst::default());
    for _ in 0..100 {
        let (body, phi) = body_and_phi(&mut samples);
        let mu = Wide::ONE / z_at(&body, phi);
        let part = unit(&mut samples);
        let p = wide(part) * mu.sqrt();
        let f_at = |p: Wide| p / (mu.sqrt() * (mu - p * p).sqrt());
        // f is singular at p_θ = √μ only.
        let step = 1e-5 * (1.0 - part) * mu.sqrt().to_f64();
        let first = slope_of_order_4(f_at, p, step);
        let second = slope_of_order_4(|p| slope_of_order_4(f_at, p, step), p, step);
        let rest = mu - p * p;
        let (one, two) = match form {
            1 => (-(mu.sqrt() / (rest * rest.sqrt())), second),
            2 => (first, wide(3.0) * p * mu.sqrt() / (rest * rest.sqrt())),
            _ => (mu.sqrt() / (rest * rest.sqrt()), wide(3.0) * p * mu.sqrt() / (rest * rest * rest.sqrt())),
        };
        super::bodies::see(&mut worst, [first, one, Wide::ZERO]);
        super::bodies::see(&mut worst, [second, two, Wide::ZERO]);
        worst.see(if first > Wide::ZERO && second > Wide::ZERO { 0.0 } else { 1.0 });
    }
    Ok(worst.at_most(1e-12, "error of difference quotients of fourth order"))
}

fn theta_by_phi(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1009), Worst::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        // The phase from the turning point before: the next is passed at 2K, the equator downwards at 3K.
        let phase = wide(samples.even(2.35, 3.65)) * motion.k;
        let t = ((phase - motion.psi0) / motion.speed).to_f64();
        let [x, y, _] = states(&motion, motion.p_y().to_f64(), &[t])?[0];
        let (body, p, equator) = (motion.body, motion.p, Wide::PI / wide(2.0));
        let to_equator = over_phi(&body, p, 0, motion.y0(), equator);
        let beyond = over_phi(&body, p, 0, equator, wide(y));
        let around = first_return(&body, p, 0);
        let theta = match form {
            1 => to_equator + around + beyond,
            2 => around - to_equator - beyond,
            _ => to_equator + around - beyond,
        };
        worst.compare(x, theta.to_f64(), 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration, and Gauss-Legendre with eight panels"))
}

/// `y` of the first conjugate point, and its time in units of `T/4`.
fn conjugate(motion: &Motion, y0: f64) -> Result<[f64; 2], Unexamined> {
    let ([a, b, c], quarter) = (motion.body.short(), (motion.k / motion.speed).to_f64());
    let (p, p_y) = (motion.p.to_f64(), motion.p_y().to_f64());
    let found =
        first_conjugate_time_by_integration(a, b, c, y0, p, p_y, 0.0, 5.0 * quarter, 1e-16).map_err(unexamined)?;
    Ok([found.y, found.t1 / quarter])
}

fn conjugacy(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1010), Worst::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        let (body, p, equator) = (motion.body, motion.p, Wide::PI / wide(2.0));
        let [y, _] = conjugate(&motion, motion.y0().to_f64())?;
        let left = -over_phi(&body, p, 1, equator, wide(y));
        let start = over_phi(&body, p, 1, motion.y0(), equator);
        let change = slope_of_order_4(|p| first_return(&body, p, 0), p, step_of(&body, p));
        let right = match form {
            1 => -start + change,
            2 => start - change,
            3 => -(change / wide(2.0)) - start,
            _ => -start - change,
        };
        worst.see(((left - right) / (left.abs() + start.abs() + change.abs())).to_f64());
    }
    Ok(worst.at_most(1e-11, "rounding of an integration, and Gauss-Legendre with eight panels"))
}

fn right_side_is_positive(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1011), Cases::default());
    for case in 0..100 {
        let motion = motion(&mut samples);
        let (body, p, equator) = (motion.body, motion.p, Wide::PI / wide(2.0));
        // The integral from φ0 to 0: below the equator, on it, or above it, where y is π − y0.
        let below = over_phi(&body, p, 1, motion.y0(), equator);
        let start = match (form, case % 3) {
            (1, _) => below,
            (_, 0) => Wide::ZERO,
            _ => -below,
        };
        let change = slope_of_order_4(|p| first_return(&body, p, 0), p, step_of(&body, p));
        let value = match form {
            2 => -start + change,
            3 => -start + wide(0.5) * change,
            _ => -start - change,
        };
        cases.see(value > Wide::ZERO, || {
            format!("ξ1 = {}, cos² y0 = {}", motion.xi1.to_f64(), (motion.cosine0 * motion.cosine0).to_f64())
        });
    }
    Ok(cases.none())
}

fn within_three_quarters(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(1012), Cases::default());
    for _ in 0..100 {
        let motion = motion(&mut samples);
        let y0 = motion.y0().to_f64();
        let y0 = if form == 1 { y0 } else { std::f64::consts::PI - y0 };
        let [_, ratio] = conjugate(&motion, y0)?;
        let (low, high) = match form {
            2 => (2.0, 2.5),
            3 => (2.5, 3.0),
            _ => (2.0, 3.0),
        };
        cases.see(low <= ratio && ratio < high, || format!("ξ1 = {}, y0 = {y0}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

/// `(θ, φ)` of the first conjugate point of the ascending extremal from a φ0, and its `y`.
pub fn locus(body: &Body, phi0: Wide, p: Wide) -> [Wide; 3] {
    let start = Start::Darboux { phi0, clairaut: Clairaut::PTheta(p), branch: Branch::Ascending };
    let found = Metric::new(body.a, body.b, body.c).and_then(|metric| Extremal::new(&metric, start));
    let found = found.ok().and_then(|extremal| first_conjugate_point(&extremal).ok());
    found.map_or([wide(f64::NAN); 3], |point| [point.theta, point.phi, point.y])
}

/// A motion, its φ0 < 0, and a step in `p_θ`.
fn locus_start(samples: &mut Samples) -> (Motion, Wide, f64) {
    let motion = motion(samples);
    let phi0 = -over_strip(&motion);
    let step = 1e-2 * step_of(&motion.body, motion.p);
    (motion, phi0, step)
}

/// `|φ0|` of the start.
pub fn over_strip(motion: &Motion) -> Wide {
    let body = motion.body;
    integral(|y| Wide::ONE / (body.c - body.z_half(y)).sqrt(), motion.y0(), Wide::PI / wide(2.0), 16)
}

fn motion_of_locus(form: Form) -> Result<Test, Unexamined> {
    identity(1013, 100, 1e-11, "difference quotients, and Gauss-Legendre with eight panels", |samples| {
        let (motion, phi0, step) = locus_start(samples);
        let (body, p, equator) = (motion.body, motion.p, Wide::PI / wide(2.0));
        let y = locus(&body, phi0, p)[2];
        let along = slope_of_order_4(|p| locus(&body, phi0, p)[1], p, step);
        let large = 50.0 * step;
        let bend = slope_of_order_4(|p| slope_of_order_4(|p| first_return(&body, p, 0), p, large), p, large);
        let (start, end) = (over_phi(&body, p, 2, motion.y0(), equator), over_phi(&body, p, 2, equator, y));
        let right = match form {
            1 => bend - start + end,
            2 => -bend - start - end,
            _ => -bend - start + end,
        };
        [-(f(body.z_half(y), p)[1] * along), right, bend]
    })
}

fn tangent_of_locus(form: Form) -> Result<Test, Unexamined> {
    identity(1014, 100, 1e-12, "difference quotients of the closed form", |samples| {
        let (motion, phi0, step) = locus_start(samples);
        let (body, p) = (motion.body, motion.p);
        let y = locus(&body, phi0, p)[2];
        let [by_theta, by_phi] = slopes_of_order_4(
            |p| {
                let [theta, phi, _] = locus(&body, phi0, p);
                [theta, phi]
            },
            p,
            step,
        );
        let f_there = f(body.z_half(y), p)[0];
        let right = match form {
            1 => f_there * by_phi,
            2 => -(by_phi / f_there),
            _ => -(f_there * by_phi),
        };
        [by_theta, right, Wide::ZERO]
    })
}

/// `[x, y, δy]` after a time, the variation that keeps the energy; `p_x` of either sign.
fn varied(motion: &Motion, y0: f64, [p_x, p_y]: [f64; 2], t: f64) -> Result<[f64; 3], Unexamined> {
    let (flow, base) = SerretAndoyerFlow::new(motion.body.short(), y0, p_x, p_y);
    let (column, parameter) = flow.column(&base);
    let system = WithColumns { flow, parameters: [parameter] };
    let start = Joined { base, columns: Columns([column]) };
    let state = integrate(&system, &start, (0.0, t), &Settings::new(1e-16), &mut ()).map_err(unexamined)?.state;
    Ok([state.base[0], state.base[1], state.columns.0[0][0]])
}

fn mirrored_locus(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1025), Worst::default());
    for case in 0..60 {
        let motion = motion(&mut samples);
        let ([a, b, c], y0) = (motion.body.short(), motion.y0().to_f64());
        let y0 = if case % 2 == 0 { y0 } else { std::f64::consts::PI - y0 };
        let quarter = (motion.k / motion.speed).to_f64();
        let (p, p_y) = (motion.p.to_f64(), motion.p_y().to_f64());
        let right = first_conjugate_time_by_integration(a, b, c, y0, p, p_y, 0.0, 5.0 * quarter, 1e-16);
        let right = right.map_err(unexamined)?;
        let other = if form == 2 { [p, -p_y] } else { [-p, p_y] };
        // The other one is conjugate at the same time.
        let (left, before) = (varied(&motion, y0, other, right.t1)?, varied(&motion, y0, other, quarter)?);
        worst.see(left[2] / before[2]);
        worst.compare(right.x, if form == 1 { left[0] } else { -left[0] }, 0.0);
        worst.see(right.y - if form == 3 { std::f64::consts::PI - left[1] } else { left[1] });
    }
    Ok(worst.at_most(1e-11, "rounding of an integration, times the condition of the problem"))
}

const PROOF: &str = "proof of Theorem 3.24";

const BY_SLOPES: &str = "difference quotients in double-double, any body, p_θ close to both ends too";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "slopes_of_f",
            PROOF,
            "∂f/∂p_θ > 0 and ∂²f/∂p_θ² > 0; they are √μ/(μ − p_θ²)^(3/2) and 3p_θ √μ/(μ − p_θ²)^(5/2).",
            BY_SLOPES,
        ],
        &["as printed", "the sign of the first", "3/2 for 5/2"],
        slopes_of_f,
        "The article has the signs only.",
    ),
    direct(
        [
            "theta_by_phi",
            PROOF,
            "Descending, before 3T/4: θ = ∫ f dζ (φ0 to 0) + Δθ − ∫ f dζ (0 to φ).",
            "integrated extremals from φ0 < 0 upwards",
        ],
        &["as printed", "the sign of the last", "the sign of the first"],
        theta_by_phi,
        "",
    ),
    direct(
        [
            "conjugacy_condition",
            PROOF,
            "−∫ f' dζ (0 to φ*) = −∫ f' dζ (φ0 to 0) − Δθ', ' for ∂/∂p_θ.",
            "first conjugate points of integrated extremals from φ0 < 0 upwards",
        ],
        &["as printed", "the sign of Δθ'", "the sign of the right side", "half of Δθ'"],
        conjugacy,
        "",
    ),
    Statement {
        id: "right_side_is_positive",
        place: PROOF,
        says: "−∫ f' dζ (φ0 to 0) − Δθ' > 0, hence φ* < 0.",
        method: "quadrature and difference quotients at random starts",
        shape: Shape::OnlyWhen {
            condition: "φ0 ≥ 0; below the equator it fails for p_θ close enough to √μ(φ0)"
        },
        forms: &["from φ0 ≥ 0", "from φ0 < 0", "the sign of Δθ'", "that sign and half of it"],
        examine: right_side_is_positive,
        note: "It is derived by an integral of f' from −K(k)/α, where f is not real and past a turning point at which f' is not integrable. \
               Near the cusp φ* is close to −φ0 > 0.",
    },
    Statement {
        id: "within_three_quarters",
        place: PROOF,
        says: "On the ascending extremals the first conjugate time lies in [T/2, 3T/4).",
        method: "zeros of the integrated variation of (9)",
        shape: Shape::OnlyWhen {
            condition: "0 ≤ φ0 < K(k)/α; for φ0 < 0, which the proof takes, later ones occur, up to T",
        },
        forms: &["φ0 ≥ 0", "φ0 < 0", "[T/2, 5T/8)", "[5T/8, 3T/4)"],
        examine: within_three_quarters,
        note: "Theorem 3.9 bounds the smaller |t| of both signs, not the first t > 0.",
    },
    direct(
        [
            "motion_of_locus",
            PROOF,
            "−f'(φ*) φ*' = −Δθ'' − ∫ f'' dζ (φ0 to 0) + ∫ f'' dζ (0 to φ*).",
            "difference quotients of the closed form of the conjugate points",
        ],
        &["as printed", "the sign of Δθ''", "the sign of the last"],
        motion_of_locus,
        "",
    ),
    direct(
        [
            "tangent_of_locus",
            PROOF,
            "The tangent of the conjugate locus is φ*' (∂θ/∂φ ∂_θ + ∂_φ), with ∂θ/∂φ = −f(φ*, p_θ) where the extremal descends.",
            "difference quotients of the closed form of the conjugate points",
        ],
        &["as printed", "+f", "1/f"],
        tangent_of_locus,
        "",
    ),
    direct(
        [
            "mirrored_locus",
            "Theorem 3.24",
            "The conjugate locus has two components, symmetric about θ = 0: −p_θ leads to the mirror image.",
            "first conjugate points of integrated extremals of p_θ and −p_θ, from both sides of the equator",
        ],
        &["as printed", "not mirrored", "−p_φ for −p_θ", "mirrored at the equator too"],
        mirrored_locus,
        "",
    ),
];
