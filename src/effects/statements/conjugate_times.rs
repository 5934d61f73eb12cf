//! Statements of section 3.2.2 on the equation of the conjugate times: Lemma 3.5, (15), (17), (18), Lemma 3.8.
//!
//! Conjugate times are zeros of the integrated variation of (9).

use super::bodies::{Body, Motion, by_differences, direct, exact, integral};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::numerics::elliptic::jacobi::{Jacobi, jacobi_epsilon};
use crate::numerics::real::Real;

/// `Λ`.
pub fn lambda(body: &Body, xi1: Wide) -> Wide {
    body.b * xi1 / (body.b * xi1 + body.a * (Wide::ONE - xi1))
}

/// `T − I(T)` by (17): finite but at the zeros of sn.
pub fn rest_of_i(motion: &Motion, t: Wide) -> Wide {
    let (m, mc) = (motion.m, motion.mc);
    let value = |u: Wide| {
        let j = Jacobi::new(u, m, mc);
        jacobi_epsilon(u, m, mc) + j.cn * j.dn / j.sn
    };
    value(t + motion.psi0) - value(motion.psi0)
}

/// A motion with a phase at which no function of it vanishes.
pub fn motion_and_phase(samples: &mut Samples) -> (Motion, Wide) {
    let motion = Motion::ordinary(samples);
    let quarter = samples.even(0.1, 0.9) + f64::from((samples.even(1.0, 5.0)) as u32);
    (motion, wide(quarter) * motion.k - motion.psi0)
}

fn second_kind(form: Form) -> Result<Test, Unexamined> {
    by_differences(607, |samples| {
        let (motion, phase) = motion_and_phase(samples);
        // The derivative of (17) by T: both sides vanish at T = 0.
        let left = match form {
            1 => slope_of_order_4(
                |t| {
                    let j = Jacobi::new(t + motion.psi0, motion.m, motion.mc);
                    jacobi_epsilon(t + motion.psi0, motion.m, motion.mc) - j.cn * j.dn / j.sn
                },
                phase,
                1e-6,
            ),
            _ => slope_of_order_4(|t| rest_of_i(&motion, t), phase, 1e-6),
        };
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        let right = match form {
            2 => Wide::ONE - Wide::ONE / (j.cn * j.cn),
            3 => Wide::ONE + Wide::ONE / (j.sn * j.sn),
            _ => Wide::ONE - Wide::ONE / (j.sn * j.sn),
        };
        [left, right, Wide::ONE]
    })
}

fn integral_of_15(form: Form) -> Result<Test, Unexamined> {
    super::bodies::identity(616, 30, 1e-12, "Gauss-Legendre with 24 panels of ten points", |samples| {
        let motion = Motion::ordinary(samples);
        let motion = Motion { psi0: wide(samples.even(0.3, 1.0)) * motion.k, ..motion };
        let pole = wide(2.0) * motion.k;
        // Up to the first zero of sn, or beyond it with a small interval around it left out.
        let end =
            if form == 1 { pole * wide(1.0 + samples.even(0.1, 0.4)) } else { pole * wide(samples.even(0.55, 0.85)) };
        let under = |u: Wide| {
            let j = Jacobi::new(u, motion.m, motion.mc);
            match form {
                2 => Wide::ONE / (j.cn * j.cn),
                3 => Wide::ONE / j.sn,
                _ => Wide::ONE / (j.sn * j.sn),
            }
        };
        let value = if form == 1 {
            let off = pole * wide(0.05);
            integral(under, motion.psi0, pole - off, 24) + integral(under, pole + off, end, 24)
        } else {
            integral(under, motion.psi0, end, 24)
        };
        let t = end - motion.psi0;
        [value, t - rest_of_i(&motion, t), Wide::ONE]
    })
}

/// The conjugate time after a given one, by the integrated variation.
fn conjugate_after(motion: &Motion, p_y: f64, y0: f64, after: f64) -> Result<f64, Unexamined> {
    let [a, b, c] = motion.body.short();
    let end = after + 6.0 * (motion.k / motion.speed).to_f64();
    let found = first_conjugate_time_by_integration(a, b, c, y0, motion.p.to_f64(), p_y, after, end, 1e-16);
    Ok(found.map_err(unexamined)?.t1)
}

fn equation_15(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(608), Worst::default());
    for _ in 0..100 {
        let motion = Motion::ordinary(&mut samples);
        let t1 = conjugate_after(&motion, motion.p_y().to_f64(), motion.y0().to_f64(), 0.0)?;
        let phase = wide(t1) * motion.speed;
        let (Body { a, b, .. }, xi1) = (motion.body, motion.xi1);
        let lambda = match form {
            1 => b * xi1 / (b * xi1 + a),
            2 => a * xi1 / (a * xi1 + b * (Wide::ONE - xi1)),
            3 => Wide::ONE - lambda(&motion.body, xi1),
            _ => lambda(&motion.body, xi1),
        };
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        // The residual of ΛT = I(T) as an error of T.
        let residual = lambda * phase - phase + rest_of_i(&motion, phase);
        worst.see((residual / (Wide::ONE / (j.sn * j.sn) - lambda) / phase).to_f64());
    }
    Ok(worst.at_most(1e-12, "rounding of an integration, times the condition of the problem"))
}

fn zeros_of_sn(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(609), Cases::default());
    for _ in 0..100 {
        let motion = Motion::ordinary(&mut samples);
        let zero = wide(2.0) * motion.k - motion.psi0;
        let phase = match form {
            1 => wide(conjugate_after(&motion, motion.p_y().to_f64(), motion.y0().to_f64(), 0.0)?) * motion.speed,
            2 => motion.k * wide(1e-15),
            _ => zero * wide(1.0 + samples.sign() * 1e-12),
        };
        // Left side of (18), in units of what multiplies the integral. The pole of I at the zero of sn is cn dn/sn in (17).
        let j = Jacobi::new(phase + motion.psi0, motion.m, motion.mc);
        let pole = if form == 3 { j.cn * j.dn / j.sn } else { Wide::ZERO };
        let integral = phase - rest_of_i(&motion, phase) + pole;
        let left = j.sn * (lambda(&motion.body, motion.xi1) * phase - integral);
        cases.see(left.abs() > wide(1e-6), || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

fn starts_at_rest(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(610), Worst::default());
    for _ in 0..100 {
        let motion = Motion::ordinary(&mut samples);
        let y0 = motion.xi1.sqrt().atan2((Wide::ONE - motion.xi1).sqrt()).to_f64();
        let y0 = std::f64::consts::FRAC_PI_2 - y0;
        let half = 2.0 * (motion.k / motion.speed).to_f64();
        let mut time = 0.0;
        for count in 1..=3 {
            time = conjugate_after(&motion, 0.0, y0, time * (1.0 + 1e-6))?;
            let expected = match form {
                1 => half * (f64::from(count) - 0.5),
                2 => 2.0 * half * f64::from(count),
                _ => half * f64::from(count),
            };
            worst.compare(time, expected, 0.0);
        }
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over three half periods"))
}

fn sine_of_start(form: Form) -> Result<Test, Unexamined> {
    exact(611, |samples| {
        let motion = Motion::oscillating(samples);
        let (one, xi0, xi1) = (Wide::ONE, motion.cosine0 * motion.cosine0, motion.xi1);
        let sn = Jacobi::new(motion.psi0, motion.m, motion.mc).sn;
        let right = match form {
            1 => (xi1 - xi0) / (one - xi0),
            2 => (xi1 - xi0) / (xi1 * (one - xi1)),
            _ => (xi1 - xi0) / (xi1 * (one - xi0)),
        };
        [sn * sn, right, Wide::ZERO]
    })
}

fn root_of_start(form: Form) -> Result<Test, Unexamined> {
    exact(612, |samples| {
        let motion = Motion::oscillating(samples);
        let (one, xi0, Motion { xi1, xi3, .. }) = (Wide::ONE, motion.cosine0 * motion.cosine0, motion);
        let j = Jacobi::new(motion.psi0, motion.m, motion.mc);
        let front = match form {
            0 => j.sn,
            2 => j.sn * j.dn,
            3 => j.sn / j.cn,
            _ => j.sn / j.dn,
        };
        [((xi1 - xi0) / (xi3 - xi0)).sqrt(), front * (xi1 * (one - xi1) / (xi3 - xi1)).sqrt(), Wide::ZERO]
    })
}

const LEMMA_8: &str = "Lemma 3.8 and its proof";

const BY_VARIATION: &str = "zeros of the integrated variation of (9), random bodies and starts";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "second_kind",
            "eq. (17)",
            "E(T + ψ0) − E(ψ0) + cn dn/sn − cn0 dn0/sn0 = T − ∫ du/sn²(u), from ψ0 to T + ψ0.",
            "derivatives of both sides; they vanish together at T = 0",
        ],
        &["as printed", "a minus before cn dn/sn", "cn² below", "plus the integral"],
        second_kind,
        "From one side of a zero of sn to the other the integral diverges: there the left side defines I, as its continuation.",
    ),
    Statement {
        id: "integral_of_15",
        place: "eq. (15), (17)",
        says: "I(T) = ∫ du/sn²(u|m), from ψ0 to T + ψ0, is T − E(T + ψ0) + E(ψ0) − cn dn/sn + cn0 dn0/sn0.",
        method: "quadrature; beyond the first zero of sn with an interval around it left out",
        shape: Shape::OnlyWhen {
            condition: "T + ψ0 < 2K(m); beyond it the integral diverges, and the right side, its continuation, is what the conjugate times solve",
        },
        forms: &["before the first zero of sn", "beyond it", "cn² for sn²", "sn for sn²"],
        examine: integral_of_15,
        note: "Every conjugate time lies beyond it.",
    },
    direct(
        [
            "equation_15",
            "eq. (15), (18), Lemma 3.5",
            "Conjugate times solve ΛMt = I(Mt), Λ = Bξ1/(Bξ1 + A(1 − ξ1)), I(T) = ∫ du/sn²(u) from ψ0 to T + ψ0.",
            BY_VARIATION,
        ],
        &["as printed", "A for A(1 − ξ1)", "A and B exchanged", "1 − Λ"],
        equation_15,
        "Every conjugate time lies beyond T = 2K − ψ0, where the integral diverges; it holds for the continuation of I by (17).",
    ),
    direct(
        [
            "zeros_of_sn",
            "after eq. (18)",
            "The zeros of sn do not solve (18): only those of the bracket do.",
            "left side of (18) beside T = 2K − ψ0, with I by (17)",
        ],
        &["as printed", "at a conjugate time", "at T = 0", "I without its pole"],
        zeros_of_sn,
        "",
    ),
    direct(
        ["starts_at_rest", LEMMA_8, "For cos² y0 = ξ1 the conjugate times are 2iK(m)/M, i = 1, 2, …", BY_VARIATION],
        &["as printed", "half a step earlier", "4iK/M"],
        starts_at_rest,
        "The first three are looked at; backward in time they are the same by symmetry.",
    ),
    direct(
        ["sine_of_start", LEMMA_8, "sn0² = (ξ1 − cos² y0)/(ξ1 (1 − cos² y0)).", "sn at the phase that (14) gives"],
        &["as printed", "without ξ1 below", "1 − ξ1 below"],
        sine_of_start,
        "",
    ),
    Statement {
        id: "root_of_start",
        place: LEMMA_8,
        says: "√((ξ1 − cos² y0)/(ξ3 − cos² y0)) = sn0 √(ξ1(1 − ξ1)/(ξ3 − ξ1)).",
        method: "sn and dn at the phase that (14) gives",
        shape: Shape::Slip { correction: "sn0/dn0 for sn0" },
        forms: &["as printed", "with dn0", "sn0 dn0", "sn0/cn0"],
        examine: root_of_start,
        note: "dn0 → 1 for ψ0 → 0, where the proof uses it. Known to us through a transcription of the page, which may have lost a sign, a root or a factor.",
    },
];
