//! Statements of section 3.3.1: geodesics and conjugate points on a surface of revolution `dφ² + μ(φ) dθ²`.
//!
//! Most are checked on the surfaces of [`super::surface`], tame ones and others.

use super::bodies::{by_differences, direct, identity};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, TRANSCRIPTION, Unexamined, Worst};
use super::surface::Surface;
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// `(a, b, φ, p_φ, p_θ)` of a surface without symmetry, `1/μ = 1 + aφ + bφ²`.
pub fn point(samples: &mut Samples) -> [Wide; 5] {
    let [a, b] = [0; 2].map(|_| wide(samples.even(0.1, 0.9)));
    [a, b, wide(samples.even(-0.8, 0.8)), wide(samples.even(-2.0, 2.0)), wide(samples.sign() * samples.even(0.2, 3.0))]
}

/// H there.
pub fn energy([a, b, phi, p_phi, p_theta]: [Wide; 5]) -> Wide {
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

const PLACE: &str = "section 3.3.1";

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
