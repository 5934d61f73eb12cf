//! Statements of section 3.2.3: rotations have no conjugate points, Lemma 3.10 and Corollary 3.11.
//!
//! The left side of (20) is compared with the integrated variation of (9).

use super::bodies::{Body, Motion, direct};
use super::differences::{Wide, wide};
use super::statement::{Cases, Form, Samples, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::SerretAndoyerFlow;
use crate::numerics::elliptic::jacobi::jacobi_epsilon;
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{Settings, integrate};

/// The variation `δy` of a rotating motion with the energy kept, and `y'`, by integration.
fn variation(motion: &Motion, t: f64) -> Result<[f64; 3], Unexamined> {
    let (flow, base) =
        SerretAndoyerFlow::new(motion.body.short(), motion.y0().to_f64(), motion.p.to_f64(), motion.p_y().to_f64());
    let (column, parameter) = flow.column(&base);
    let system = WithColumns { flow, parameters: [parameter] };
    let start = Joined { base, columns: Columns([column]) };
    let arrival = integrate(&system, &start, (0.0, t), &Settings::new(1e-16), &mut ()).map_err(unexamined)?;
    Ok([arrival.state.columns.0[0][0], flow.velocity(&arrival.state.base).1, parameter])
}

/// Left side of (20), with `∫ sn² = (T − E)/m`.
fn left_of_20(motion: &Motion, t: Wide, form: Form) -> Wide {
    let (Body { a, b, .. }, xi1, one) = (motion.body, motion.xi1, Wide::ONE);
    let epsilon = |u: Wide| jacobi_epsilon(u, motion.m, motion.mc);
    let squares = (t - epsilon(t + motion.psi0) + epsilon(motion.psi0)) / motion.m;
    match form {
        1 => b * t * xi1 - (b * xi1 + a * (xi1 - one)) * squares,
        2 => b * t - (b * xi1 - a * (xi1 - one)) * squares,
        3 => a * t * xi1 - (a * xi1 - b * (xi1 - one)) * squares,
        _ => b * t * xi1 - (b * xi1 - a * (xi1 - one)) * squares,
    }
}

fn equation_20(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(714), Worst::default());
    for _ in 0..100 {
        let motion = Motion::ordinary_rotating(&mut samples);
        let quarter = (motion.k / motion.speed).to_f64();
        let (early, late) = (samples.even(0.2, 0.8) * quarter, samples.even(1.0, 4.0) * quarter);
        // δy/y' is the left side of (20) times a constant of the motion: its quotient at two times.
        let ([first, first_rate, _], [second, second_rate, _]) =
            (variation(&motion, early)?, variation(&motion, late)?);
        let left = |t: f64| left_of_20(&motion, wide(t) * motion.speed, form).to_f64();
        worst.compare(second / second_rate * first_rate / first, left(late) / left(early), 0.0);
    }
    Ok(worst.at_most(1e-11, "rounding of an integration over two turns"))
}

fn rotations_have_none(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(715), Cases::default());
    for case in 0..150 {
        let motion = match form {
            1 => Motion::oscillating(&mut samples),
            _ => Motion::rotating(&mut samples),
        };
        let (Body { a, b, .. }, xi1, one) = (motion.body, motion.xi1, Wide::ONE);
        let t = wide(samples.log(1e-2, 100.0)) * motion.k;
        let epsilon = |u: Wide| jacobi_epsilon(u, motion.m, motion.mc);
        let squares = (t - epsilon(t + motion.psi0) + epsilon(motion.psi0)) / motion.m;
        let sign = if form == 2 { -one } else { one };
        let sum = b * xi1 * (t - squares) + sign * a * (xi1 - one) * squares;
        let same = form != 0 || ((sum - left_of_20(&motion, t, 0)) / sum).abs() < wide(1e-15);
        // Every third case by integration too: the variation keeps its sign.
        let kept = form != 0 || case % 3 != 0 || {
            let motion = Motion::ordinary_rotating(&mut samples);
            let [delta, rate, parameter] =
                variation(&motion, samples.even(1.0, 12.0) * (motion.k / motion.speed).to_f64())?;
            -delta * rate * parameter > 0.0
        };
        worst.see(sum > Wide::ZERO && same && kept, || {
            format!("ξ1 = {}, T/K = {}", xi1.to_f64(), (t / motion.k).to_f64())
        });
    }
    Ok(worst.none())
}

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "equation_20",
            "eq. (20), Lemma 3.10",
            "Along rotations δy/y' is proportional to BTξ1 − (Bξ1 − A(ξ1 − 1)) ∫ sn²(u) du, from ψ0 to ψ0 + T.",
            "integrated variation of (9) at two times",
        ],
        &["as printed", "the sign of A(ξ1 − 1)", "without ξ1 in the first term", "A and B exchanged"],
        equation_20,
        "",
    ),
    direct(
        [
            "rotations_have_none",
            "Corollary 3.11",
            "(20) is Bξ1 ∫ cn² + A(ξ1 − 1) ∫ sn² = 0, a sum of positive terms: rotations have no conjugate points.",
            "both forms up to fifty turns, and the sign of the integrated variation",
        ],
        &["as printed", "for oscillating motions", "the sign of the second term"],
        rotations_have_none,
        "",
    ),
];
