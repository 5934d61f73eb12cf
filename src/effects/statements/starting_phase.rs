//! Statements of section 3.2 on the phase ψ0 at which a motion starts: which solution of cn(ψ0) = η(0) it is, and when it is zero.
//!
//! The formulas of Proposition 3.2 are those of [`super::parameterization`], compared with integrated motions from any start.

use super::bodies::{Motion, direct};
use super::differences::{Wide, wide};
use super::kinds_of_motion::{states, times_of};
use super::parameterization::{any_start, path_from, proposition};
use super::statement::{Cases, Form, Samples, Shape, Statement, TRANSCRIPTION, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

fn branch_of_phase(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(514), Worst::default());
    for case in 0..100 {
        let motion =
            if case % 2 == 0 { Motion::ordinary(&mut samples) } else { Motion::ordinary_rotating(&mut samples) };
        // Starts under the condition have the positive ψ0; outside, all others.
        let start = loop {
            let (start, sign) = any_start(&motion, &mut samples);
            if (sign > Wide::ZERO) == (form != 1) {
                break start;
            }
        };
        let psi0 = match form {
            2 => -motion.psi0,
            3 => motion.k - motion.psi0,
            _ => motion.psi0,
        };
        let t = samples.even(0.1, 0.9) * (motion.k / motion.speed).to_f64();
        let y = path_from(&motion, start, &[t])?[0][1];
        let found = proposition(&Motion { psi0, ..motion }, wide(t), 0)[0].to_f64();
        worst.see(found - libm::cos(y) * libm::cos(y));
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over a quarter period"))
}

fn descending_branch(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(515), Worst::default());
    for case in 0..100 {
        let motion =
            if case % 2 == 0 { Motion::ordinary(&mut samples) } else { Motion::ordinary_rotating(&mut samples) };
        let t = times_of(&motion, &mut samples, 4.0)[0];
        let [x, y, _] = states(&motion, -motion.p_y().to_f64(), &[t])?[0];
        let [xi, grown] = proposition(&motion, wide(if form == 1 { t } else { -t }), 0).map(|value| value.to_f64());
        worst.see(xi - if form == 2 { libm::sin(y) * libm::sin(y) } else { libm::cos(y) * libm::cos(y) });
        // Backward in time x falls.
        worst.compare(if form == 1 || form == 3 { grown } else { -grown }, x, 0.0);
    }
    Ok(worst.at_most(1e-12, "rounding of an integration over a period"))
}

fn rest_is_zero_phase(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(516), Cases::default());
    for case in 0..200 {
        let motion = Motion::oscillating(&mut samples);
        // Phases ψ0 = jK, and any others. At rest cos² y0 = ξ1; cos² y0 at this phase is that of the proposition at t = 0.
        let j = (case % 9) - 4;
        let part = if case % 2 == 0 { 0.0 } else { samples.even(0.01, 0.99) };
        let psi0 = wide(f64::from(j) + part) * motion.k;
        let xi0 = proposition(&Motion { psi0, ..motion }, Wide::ZERO, 0)[0];
        let rests = ((motion.xi1 - xi0) / motion.xi1).abs() < wide(1e-20);
        let multiple = match form {
            1 => 1,
            2 => 4,
            _ => 2,
        };
        let claimed = part == 0.0 && j % multiple == 0;
        cases.see(rests == claimed, || format!("ψ0/K = {}", f64::from(j) + part));
    }
    Ok(cases.none())
}

fn starting_phase(form: Form, rotating: bool) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(511), Worst::default());
    for _ in 0..200 {
        let motion = if rotating { Motion::rotating(&mut samples) } else { Motion::oscillating(&mut samples) };
        let (one, xi0, xi1) = (Wide::ONE, motion.cosine0 * motion.cosine0, motion.xi1);
        let quotient = if rotating { (xi1 - one) * xi0 / (xi1 - xi0) } else { (one - xi1) * xi0 / (xi1 * (one - xi0)) };
        let cn = match form {
            0 => quotient,
            2 => quotient * motion.cosine0,
            3 if rotating => ((xi1 - one) * xi0 / xi1).sqrt(),
            3 => ((one - xi1) * xi0 / xi1).sqrt(),
            _ => quotient.sqrt(),
        };
        // The proposition's own cos² y at t = 0 with sn² = 1 − cn² must be cos² y0.
        let (c2, s2) = (cn * cn, one - cn * cn);
        let start = if rotating { xi1 * c2 / (xi1 - s2) } else { xi1 * c2 / (one - xi1 * s2) };
        super::bodies::see(&mut worst, [start, xi0, Wide::ZERO]);
    }
    Ok(worst.at_most(1e-20, "double-double"))
}

const FIRST: &str = "Proposition 3.2 i";

const SECOND: &str = "Proposition 3.2 ii";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    Statement {
        id: "starting_phase",
        place: FIRST,
        says: "cn(ψ0|m) = (1 − ξ1) cos² y0/(ξ1 sin² y0).",
        method: "cos² y(0) of the proposition with this cn",
        shape: Shape::Slip { correction: "cn(ψ0|m) is the square root of that, η(0) of (14)" },
        forms: &["as printed", "with the root", "one cos y0 too many", "without sin² y0"],
        examine: |form| starting_phase(form, false),
        note: TRANSCRIPTION,
    },
    Statement {
        id: "starting_phase_rotating",
        place: SECOND,
        says: "cn(ψ0|m) = (ξ1 − 1) cos² y0/(ξ1 − cos² y0).",
        method: "cos² y(0) of the proposition with this cn",
        shape: Shape::Slip { correction: "cn(ψ0|m) is the square root of that" },
        forms: &["as printed", "with the root", "one cos y0 too many", "ξ1 below"],
        examine: |form| starting_phase(form, true),
        note: TRANSCRIPTION,
    },
    Statement {
        id: "branch_of_starting_phase",
        place: "after Lemma 3.6",
        says: "By construction ψ0 is in [0, K(m)].",
        method: "cos² y of the proposition with the ψ0 of (14) against integrated motions, both kinds, y0 on either side of the equator",
        shape: Shape::OnlyWhen { condition: "p_y(0) cos y0 ≥ 0; else −ψ0 is the phase, in [−K(m), 0]" },
        forms: &["p_y cos y0 > 0", "p_y cos y0 < 0", "−ψ0", "K − ψ0"],
        examine: branch_of_phase,
        note: "cn knows ψ0 up to its sign only. The other starts are the mirror images, and their conjugate times are those of t < 0.",
    },
    direct(
        [
            "rest_is_zero_phase",
            "proof of Lemma 3.4",
            "cos² y0 = ξ1 if and only if ψ0 = 0 mod 2K(m).",
            "cos² y0 of the proposition at multiples of K and between them",
        ],
        &["as printed", "mod K", "mod 4K"],
        rest_is_zero_phase,
        "",
    ),
    direct(
        [
            "descending_branch",
            "after eq. (13)",
            "With the other sign in (12), or with t < 0, the same formulas give the descending branch.",
            "the proposition at −t against integrated motions with −p_y",
        ],
        &["as printed", "t for −t", "sin² y", "x not turned"],
        descending_branch,
        "",
    ),
];
