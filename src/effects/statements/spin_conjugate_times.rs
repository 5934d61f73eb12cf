//! Beyond the article: what follows from the monotone phase Θ of `spin_closed_form`, held against integration.
//!
//! Returns to the equator, the cut point, the first conjugate time and all others up to a time: λ, β and Θ in closed form, in double-double, at instants
//! that integration of the lift (with its Jacobi field) finds.

use super::differences::{Wide, wide};
use super::spin_closed_form_regimes::{Closed, random_starts};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::lift::{
    conjugate_times_by_integration, equator_crossings, first_conjugate_time_by_integration,
};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[RETURNS, CUT_POINT, FIRST_TIME, COUNT, ROTATING, HALF_TURNS];

/// Accuracy of the integrations.
const TOLERANCE: f64 = 1e-15;
/// What an integrated time and a closed form may differ by in the phase: rounding of both, times the growth of the flow.
const INTEGRATED: f64 = 1e-12;
const PLACE: &str = "beyond the article, section 4.3";

const RETURNS: Statement = Statement {
    id: "spin_returns",
    place: PLACE,
    says: "The n-th return to the equator is the only solution of λ = nπ.",
    method: "λ in closed form, in all regimes, at the first three returns by integration, random k and p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "λ with G for G/2", "λ without the third kind"],
    examine: |form| {
        let mut worst = Worst::default();
        for (k, p) in random_starts(505, 100) {
            let closed = Closed::new(wide(k), wide(p));
            let (returns, _) = equator_crossings(k, p, TOLERANCE, 60.0 + 30.0 * k * k, 3).map_err(unexamined)?;
            for (n, crossing) in returns.iter().enumerate() {
                let lambda = match form {
                    1 => wide(2.0) * closed.at(wide(crossing.time)).lambda,
                    2 => wide(2.0 * crossing.time) / closed.casimir(),
                    _ => closed.at(wide(crossing.time)).lambda,
                };
                worst.see((lambda / Wide::PI - wide(n as f64 + 1.0)).to_f64());
            }
        }
        Ok(worst.at_most(INTEGRATED, "rounding of the integration, times the growth of the flow"))
    },
    note: "",
};

const CUT_POINT: Statement = Statement {
    id: "spin_cut_point",
    place: PLACE,
    says: "The cut point of an extremal (Lemma 4.4) is θ = arg(−cos β + i k sin β) at λ = π, φ = π/2.",
    method: "the first return by integration, β in closed form there, random k and p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "sin β/k", "the sign of cos β", "θ = π − β"],
    examine: |form| {
        let mut worst = Worst::default();
        for (k, p) in random_starts(506, 100) {
            let (returns, _) = equator_crossings(k, p, TOLERANCE, 60.0 + 30.0 * k * k, 1).map_err(unexamined)?;
            let first = returns.first().ok_or_else(|| unexamined("no return"))?;
            let state = Closed::new(wide(k), wide(p)).at(wide(first.time));
            let (sine, cosine) = (state.sine.to_f64(), state.cosine.to_f64());
            let theta = match form {
                1 => libm::atan2(sine / k, -cosine),
                2 => libm::atan2(k * sine, cosine),
                3 => libm::atan2(sine, -cosine),
                _ => libm::atan2(k * sine, -cosine),
            };
            let (s, c) = libm::sincos(theta);
            worst.see(first.r[0] * s - first.r[2] * c);
            worst.see(1.0 - (first.r[0] * c + first.r[2] * s));
        }
        Ok(worst.at_most(INTEGRATED, "rounding of the integration, times the growth of the flow"))
    },
    note: "",
};

const FIRST_TIME: Statement = Statement {
    id: "spin_first_conjugate_time",
    place: PLACE,
    says: "The first conjugate time is the solution of Θ = π, with λ, β and δβ in Jacobi functions and the third kind.",
    method: "Θ in closed form, in all regimes, at the first conjugate time by integration of the lift with its Jacobi field, random k and p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "A = G δβ", "the sign of p_θ β'", "Θ = 2π"],
    examine: |form| {
        let mut worst = Worst::default();
        for (k, p) in random_starts(507, 100) {
            let t_max = 60.0 + 30.0 * k * k;
            let (first, _) = first_conjugate_time_by_integration(k, p, TOLERANCE, t_max).map_err(unexamined)?;
            let phase = Closed::new(wide(k), wide(p)).phase(wide(first.t1), form);
            worst.see((phase / Wide::PI).to_f64() - if form == 3 { 2.0 } else { 1.0 });
        }
        Ok(worst.at_most(INTEGRATED, "rounding of the integration, times the growth of the flow"))
    },
    note: "",
};

const COUNT: Statement = Statement {
    id: "spin_conjugate_count",
    place: PLACE,
    says: "The number of conjugate times in (0, t] is the whole part of Θ(t)/π.",
    method: "all conjugate times by integration up to random t (roots of each step's polynomial isolated), random k and p_θ",
    shape: Shape::Direct,
    forms: &["derived here", "the whole part of λ/π", "rounded to the nearest", "one more"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(508), Cases::default());
        for (k, p) in random_starts(509, 100) {
            let t = samples.even(1.0, 30.0) / (1.0 + 0.3 * p);
            let (times, _) = conjugate_times_by_integration(k, p, TOLERANCE, t, usize::MAX).map_err(unexamined)?;
            let closed = Closed::new(wide(k), wide(p));
            let turns = if form == 1 { closed.at(wide(t)).lambda } else { closed.phase(wide(t), 0) } / Wide::PI;
            let turns = turns.to_f64();
            let counted = match form {
                2 => (turns + 0.5).floor(),
                3 => turns.floor() + 1.0,
                _ => turns.floor(),
            };
            cases.see(counted == times.len() as f64, || {
                format!("k = {k:?}, p_θ = {p:?}, t = {t:?}: {turns:?}, {}", times.len())
            });
        }
        Ok(cases.none())
    },
    note: "",
};

const ROTATING: Statement = Statement {
    id: "spin_rotating_has_no_turning_variation",
    place: PLACE,
    says: "While β rotates (k ≤ 1, or k > 1 and p_θ ≥ 2√(k² − 1)) δβ > 0 for all t > 0; so the first conjugate point lies between the first and the second return: π < λ(t1) < 2π.",
    method: "δβ in closed form at random t > 0 and λ at the integrated t1, random k and p_θ that rotate",
    shape: Shape::Direct,
    forms: &["derived here", "while β oscillates", "π/2 < λ(t1) < π"],
    examine: |form| rotating(form),
    note: "",
};

fn rotating(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(510), Cases::default());
    for (k, p) in random_starts(511, 260) {
        let oscillates = k > 1.0 && p < 2.0 * ((k - 1.0) * (k + 1.0)).sqrt();
        if oscillates != (form == 1) {
            continue;
        }
        let closed = Closed::new(wide(k), wide(p));
        let t = samples.even(0.0, 20.0);
        let delta = closed.at(wide(t)).delta.to_f64();
        cases.see(delta > 0.0, || format!("k = {k:?}, p_θ = {p:?}, t = {t:?}: δβ = {delta:?}"));
        let t_max = 60.0 + 30.0 * k * k;
        let (first, _) = first_conjugate_time_by_integration(k, p, TOLERANCE, t_max).map_err(unexamined)?;
        let turns = (closed.at(wide(first.t1)).lambda / Wide::PI).to_f64();
        let inside = if form == 2 { turns > 0.5 && turns < 1.0 } else { turns > 1.0 && turns < 2.0 };
        cases.see(inside, || format!("k = {k:?}, p_θ = {p:?}: λ(t1)/π = {turns:?}"));
    }
    Ok(cases.none())
}

const HALF_TURNS: Statement = Statement {
    id: "spin_argument_follows_amplitude",
    place: PLACE,
    says: "While β oscillates, arg(B + iA), continuous from 0, differs from am(wt|m) by less than π: no branch has to be followed.",
    method: "the argument followed in small steps of t from 0, against am plus a principal value, random k > 1 and p_θ < 2√(k² − 1)",
    shape: Shape::Direct,
    forms: &["derived here", "the principal value alone", "by less than π/8"],
    examine: |form| {
        let mut cases = Cases::default();
        for (k, p) in random_starts(512, 70) {
            if k <= 1.0 || p >= 2.0 * ((k - 1.0) * (k + 1.0)).sqrt() {
                continue;
            }
            let closed = Closed::new(wide(k), wide(p));
            let mut followed = 0.0;
            for step in 1..=40 {
                let t = wide(0.25 * f64::from(step));
                let (a, b, amplitude) = closed.argument_and_amplitude(t);
                let principal = libm::atan2(a, b);
                let turn = 2.0 * f64::PI;
                // The argument turns by less than half a turn in a quarter of a unit of time.
                followed += principal - followed - turn * ((principal - followed) / turn + 0.5).floor();
                let holds = match form {
                    1 => (principal - followed).abs() < 1e-9,
                    2 => (followed - amplitude).abs() < f64::PI / 8.0,
                    _ => (followed - amplitude).abs() < f64::PI,
                };
                cases.see(holds, || {
                    format!("k = {k:?}, p_θ = {p:?}, t = {:?}: {followed:?}, {amplitude:?}", t.to_f64())
                });
            }
        }
        Ok(cases.none())
    },
    note: "",
};
