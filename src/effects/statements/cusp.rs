//! Statements of section 3.3.3 on the two ends of the conjugate locus: the proof of Theorem 3.24 for p_θ close to its limits, Remark 3.25.
//!
//! At arc length, `2h = 1`. Starts at rest in y are integrated; the locus itself is the closed form of the `geometry` room in double-double.

use super::bodies::{Body, Motion, direct, exact, unit};
use super::conjugate_locus::{locus, over_strip};
use super::darboux_form::{body_and_phi, jacobi, z_at};
use super::differences::{Wide, slopes_of_order_4, wide};
use super::first_return::{body_and_clairaut, constants, motion};
use super::kinds_of_motion::states;
use super::statement::{Form, Samples, Shape, Statement, TRANSCRIPTION, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::numerics::elliptic::jacobi::Jacobi;
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

fn limits_of_f(form: Form, at_start: bool) -> Result<Test, Unexamined> {
    exact(1015, |samples| {
        let (body, phi0) = body_and_phi(samples);
        let phi = phi0 * wide(samples.even(0.05, 0.95));
        let (Body { a, b, .. }, j, j0) = (body, jacobi(&body, phi), jacobi(&body, phi0));
        let (z, z0) = (z_at(&body, phi), z_at(&body, phi0));
        // μ and p_θ in (22), at p_θ² = 1/B and at p_θ² = 2/z(φ0).
        let (mu, p) = (Wide::ONE / z, Wide::ONE / if at_start { z0.sqrt() } else { b.sqrt() });
        let below = match (at_start, form) {
            (false, 1) => (b - a) * j.sn * j.sn,
            (false, 2) => (b - a) * j.cn,
            (false, _) => (b - a) * j.cn * j.cn,
            (true, 1) => a * (j.cn * j.cn - j0.cn * j0.cn) + b * (j0.sn * j0.sn - j.sn * j.sn),
            (true, 2) => a * (j0.sn * j0.sn - j.sn * j.sn) + b * (j.cn * j.cn - j0.cn * j0.cn),
            (true, _) => a * (j0.cn * j0.cn - j.cn * j.cn) + b * (j0.sn * j0.sn - j.sn * j.sn),
        };
        [mu * (mu - p * p) / (p * p), below.abs() / (z * z), wide(1e-2) * (b - a) / (z * z)]
    })
}

fn values_at_rest(form: Form) -> Result<Test, Unexamined> {
    exact(1016, |samples| {
        let mc = wide(unit(samples));
        // η(0) = cn(ψ0|m) at ψ0 = 0, as ξ(0) = ξ1; cn⁻¹(0|m) is K.
        let value = match form {
            0 => complete_k(mc),
            2 => Jacobi::new(Wide::ZERO, Wide::ONE - mc, mc).sn,
            3 => Jacobi::new(complete_k(mc), Wide::ONE - mc, mc).cn,
            _ => Jacobi::new(Wide::ZERO, Wide::ONE - mc, mc).cn,
        };
        [value, Wide::ONE, Wide::ZERO]
    })
}

fn phases_at_rest(form: Form) -> Result<Test, Unexamined> {
    exact(1017, |samples| {
        let (body, p) = body_and_clairaut(samples);
        let ([m, mc, speed], count) = (constants(&body, p), f64::from(1 + (samples.even(0.0, 3.0)) as u32));
        let k = complete_k(mc);
        let phase = wide(count)
            * match form {
                0 => wide(2.0) * k / speed,
                2 => k,
                3 => k / wide(2.0),
                _ => wide(2.0) * k,
            };
        // φ' = 0 where η² = cn² = 1.
        let cn = Jacobi::new(phase, m, mc).cn;
        [cn * cn, Wide::ONE, Wide::ZERO]
    })
}

fn both_ends_of_cusp(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1018), Worst::default());
    for _ in 0..100 {
        // At rest in y at φ0 < 0, where p_θ² = 2/z(φ0), for half a period.
        let motion = at_rest(motion(&mut samples));
        let half = 2.0 * (motion.k / motion.speed).to_f64();
        let time = if form == 1 { 0.5 * half } else { half };
        let y = states(&motion, 0.0, &[time])?[0][1];
        let (sine, cosine) = libm::sincos(y);
        // sin y is cn(αφ|k); the end is −φ0, on the other side of the equator.
        worst.see(if form == 2 { cosine * cosine } else { sine * sine } - (Wide::ONE - motion.xi1).to_f64());
        let y0 = motion.y0().to_f64();
        worst.see(y - if form == 3 { y0 } else { std::f64::consts::PI - y0 });
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over half a period"))
}

/// The motion of the same constants that starts at rest in y: `cos² y0 = ξ1`.
fn at_rest(motion: Motion) -> Motion {
    Motion::posed(motion.body, motion.p, motion.xi1, Wide::ONE)
}

fn slope_at_cusp(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1024), Worst::default());
    for _ in 0..30 {
        let motion = at_rest(motion(&mut samples));
        let (body, phi0) = (motion.body, -over_strip(&motion));
        // dθ/dφ along the locus, at p_θ short of the limit by this part.
        let slope_at = |short: f64| {
            let p = motion.p * wide(1.0 - short);
            let along = |p: Wide| {
                let [theta, phi, _] = locus(&body, phi0, p);
                [theta, phi]
            };
            let [by_theta, by_phi] = slopes_of_order_4(along, p, 1e-3 * short * p.to_f64());
            (by_theta / by_phi).abs()
        };
        // Ten times as steep for a hundredth of the distance.
        let growth = slope_at(1e-12) / slope_at(1e-10);
        let expected = match form {
            1 => 1.0,
            2 => 0.1,
            3 => 100.0,
            _ => 10.0,
        };
        worst.see(growth.to_f64() / expected - 1.0);
    }
    Ok(worst.at_most(1e-3, "the next power of the root of the distance from the limit"))
}

fn angle_of_equator(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(1019), Worst::default());
    for _ in 0..100 {
        let body = Body::ordinary(&mut samples);
        let [a, b, c] = body.short();
        let p = 1.0 / a.sqrt();
        let y0 = std::f64::consts::FRAC_PI_2;
        let root = ((b - a) * (c - a)).sqrt();
        let found = first_conjugate_time_by_integration(a, b, c, y0, p, 0.0, 0.0, 10.0 * p * c / root, 1e-16);
        let found = found.map_err(unexamined)?;
        let pi = std::f64::consts::PI;
        let (time, angle) = match form {
            0 => (pi * a.sqrt() / root, pi * a * a.sqrt() / root),
            2 => (pi * a / root, pi * a / root),
            3 => (pi * a.sqrt() / root, pi * a.sqrt() / root),
            _ => (pi * a.sqrt() / root, pi * a / root),
        };
        worst.compare(found.t1, time, 0.0);
        worst.compare(found.x, angle, 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over half a turn"))
}

const PROOF: &str = "proof of Theorem 3.24";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "limit_at_separatrix",
            PROOF,
            "For p_θ → B^(−1/2): f → (A cn² + B sn²)/√((B − A) cn²), at αφ*.",
            "(22) at the limit, random φ",
        ],
        &["as printed", "sn² below", "cn for cn²"],
        |form| limits_of_f(form, false),
        "",
    ),
    direct(
        [
            "limit_at_start",
            PROOF,
            "For p_θ² → 2/z(φ0): f → (A cn² + B sn²)/√(A(cn0² − cn²) + B(sn0² − sn²)), cn0 at αφ0.",
            "(22) at the limit, random φ nearer to the equator than φ0",
        ],
        &["as printed", "cn² − cn0²", "A and B exchanged"],
        |form| limits_of_f(form, true),
        "",
    ),
    Statement {
        id: "eta_at_rest",
        place: PROOF,
        says: "η(0) = cn⁻¹(0|m) = 1.",
        method: "cn and its inverse at random m",
        shape: Shape::Slip { correction: "η(0) = cn(0|m) = 1" },
        forms: &["as printed", "cn", "sn", "cn at K"],
        examine: values_at_rest,
        note: "cn⁻¹(0|m) is K(m). Known to us through a transcription of the page, which may have lost a sign, a root or a factor.",
    },
    Statement {
        id: "phases_at_rest",
        place: PROOF,
        says: "φ' = 0 at the start means ψ0 = 0 mod 2K(m)/M.",
        method: "cn² = 1 at multiples",
        shape: Shape::Slip { correction: "ψ0 = 0 mod 2K(m): ψ0 is a phase, no time" },
        forms: &["as printed", "mod 2K", "mod K", "mod K/2"],
        examine: phases_at_rest,
        note: TRANSCRIPTION,
    },
    direct(
        [
            "both_ends_of_cusp",
            PROOF,
            "For p_θ² = 2/z(φ0) the extremal is at φ* = −φ0 after 2K(m)/M, and cn²(αφ*|k) = cn²(αφ0|k) = 1 − ξ1.",
            "integrated motions that start at rest in y",
        ],
        &["as printed", "after K(m)/M", "sn² for cn²", "φ* = φ0"],
        both_ends_of_cusp,
        "",
    ),
    direct(
        [
            "slope_at_cusp",
            "Theorem 3.24 and its proof",
            "For p_θ → √μ(φ0) the slope dθ/dφ of the conjugate locus tends to infinity, like (√μ(φ0) − p_θ)^(−1/2): the cusp is horizontal.",
            "difference quotients of the closed form of the conjugate points, at two distances from the limit",
        ],
        &["as printed, with the power", "it tends to a limit", "dφ/dθ tends to infinity", "like the inverse distance"],
        slope_at_cusp,
        "",
    ),
    Statement {
        id: "equator_time_and_angle",
        place: "Remark 3.25; Lemma 3.18",
        says: "On the equator t1 = π√A/√((B − A)(C − A)) and θ(t1) = πA√A/√((B − A)(C − A)).",
        method: "integrated equators of random bodies with their variation",
        shape: Shape::Slip { correction: "θ(t1) = πA/√((B − A)(C − A)); the time as printed" },
        forms: &["as printed", "without √A in the angle", "A for √A in the time", "√A for A in the angle"],
        examine: angle_of_equator,
        note: "θ' = p_θ/μ = √A there. The figure's body is looked at on its own in Remark 3.25's experiment.",
    },
];
