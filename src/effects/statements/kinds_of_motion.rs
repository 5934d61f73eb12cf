//! Statements of section 3.1 on the kinds of motion, Proposition 3.1: oscillations, rotations, separatrices, and their mirrors.
//!
//! Motions are integrated by the flow (9) of the `geometry` room, which knows no closed form.

use super::bodies::{Body, Motion, direct, exact};
use super::differences::{Wide, wide};
use super::pendulum::state;
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::trajectory;
use crate::numerics::real::Real;

/// `[x, y, p_y]` of a motion at these times.
pub fn states(motion: &Motion, p_y: f64, times: &[f64]) -> Result<Vec<[f64; 3]>, Unexamined> {
    let [a, b, c] = motion.body.short();
    let (states, _) =
        trajectory(a, b, c, motion.y0().to_f64(), motion.p.to_f64(), p_y, times, 1e-16).map_err(unexamined)?;
    Ok(states)
}

/// Times of a motion: random fractions of `turns` quarter periods.
pub fn times_of(motion: &Motion, samples: &mut Samples, turns: f64) -> [f64; 4] {
    [0; 4].map(|_| samples.even(0.0, turns) * (motion.k / motion.speed).to_f64())
}

fn range_of_oscillation(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(408), Worst::default());
    for _ in 0..100 {
        let motion = Motion::ordinary(&mut samples);
        let xi1 = motion.xi1.to_f64();
        let low = match form {
            1 => libm::acos(xi1),
            2 => libm::asin(xi1.sqrt()),
            _ => libm::acos(xi1.sqrt()),
        };
        // The extremes of y: a step of the secant method finds where p_y vanishes, from the closest of many states.
        let period = 4.0 * (motion.k / motion.speed).to_f64();
        let p_y = motion.p_y().to_f64();
        let times: Vec<f64> = (0..=400).map(|i| f64::from(i) * period / 400.0).collect();
        let path = states(&motion, p_y, &times)?;
        let at_turn = |sign: f64| {
            let pairs = path.windows(2).zip(&times);
            let turn = pairs.filter(|(pair, _)| pair[0][2] * sign > 0.0 && pair[1][2] * sign <= 0.0);
            turn.map(|(pair, time)| time + period / 400.0 * pair[0][2] / (pair[0][2] - pair[1][2])).next()
        };
        for (sign, end) in [(1.0, std::f64::consts::PI - low), (-1.0, low)] {
            let Some(time) = at_turn(sign) else { return Err(Unexamined("no turning point in a period".to_owned())) };
            let mut time = time;
            for _ in 0..3 {
                let step = 1e-4 * period;
                let near = states(&motion, p_y, &[time - step, time, time + step])?;
                time -= near[1][2] * 2.0 * step / (near[2][2] - near[0][2]);
            }
            worst.see(states(&motion, p_y, &[time])?[0][1] - end);
        }
    }
    Ok(worst.at_most(1e-12, "rounding of an integration"))
}

fn rotations_are_monotone(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(409), Cases::default());
    for _ in 0..100 {
        let motion = match form {
            1 => Motion::ordinary(&mut samples),
            _ => Motion::ordinary_rotating(&mut samples),
        };
        // A whole turn, and a second one.
        let end = 8.0 * (motion.k / motion.speed).to_f64();
        let times: Vec<f64> = (0..=100).map(|i| f64::from(i) * end / 100.0).collect();
        let path = states(&motion, motion.p_y().to_f64(), &times)?;
        let grows = path.windows(2).all(|pair| pair[1][1] > pair[0][1]) && path.iter().all(|state| state[2] > 0.0);
        let falls = path.windows(2).all(|pair| pair[1][1] < pair[0][1]);
        cases.see(if form == 2 { falls } else { grows }, || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

fn minor_axis(form: Form) -> Result<Test, Unexamined> {
    exact(410, |samples| {
        let (body, y, p_x, _) = state(samples);
        // At h = C p_x²/2 (or another h in the wrong forms) p_y² from the energy must be p_x², whatever y: the momentum lies along E3.
        let h2 = match form {
            1 => body.b * p_x * p_x,
            2 => body.c * p_x * p_x / wide(2.0),
            _ => body.c * p_x * p_x,
        };
        let half_z = body.z_half(y);
        [(h2 - p_x * p_x * half_z) / (body.c - half_z), p_x * p_x, Wide::ZERO]
    })
}

fn separatrix_joins(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(411), Worst::default());
    for _ in 0..100 {
        let body = Body::ordinary(&mut samples);
        let Body { a, b, c } = body;
        let motion = Motion::posed(body, Wide::ONE, Wide::ONE, wide(samples.even(0.05, 0.95)));
        let rate = match form {
            1 => (b - a) * (c - a),
            2 => (c - b) * (c - b),
            _ => (b - a) * (c - b),
        };
        // Close to 0 (backward) and to π (forward) the distance falls by e in 1/λ, λ of the linearised system.
        let turn = 1.0 / ((b - a) * (c - b)).sqrt().to_f64();
        let sign = samples.sign();
        let start = sign * samples.even(8.0, 9.0) * turn;
        let path = states(&motion, motion.p_y().to_f64(), &[start, start + sign * turn])?;
        let end = if sign > 0.0 { std::f64::consts::PI } else { 0.0 };
        let fall = ((path[0][1] - end) / (path[1][1] - end)).abs();
        worst.see(libm::log(fall) / (rate.sqrt().to_f64() * turn) - 1.0);
    }
    Ok(worst.at_most(1e-5, "the square of the distance, and rounding that the unstable equilibrium magnifies"))
}

/// A motion of one of the three kinds, oscillating, separatrix, rotating, in turn.
fn of_kind(kind: u32, samples: &mut Samples) -> Motion {
    match kind % 3 {
        0 => Motion::ordinary(samples),
        1 => Motion::posed(Body::ordinary(samples), Wide::ONE, Wide::ONE, wide(samples.even(0.05, 0.95))),
        _ => Motion::ordinary_rotating(samples),
    }
}

/// The time in which a motion closes; on the separatrix, which does not, one in which it leaves one equilibrium for the other.
fn long_time(motion: &Motion) -> f64 {
    let Body { a, b, c } = motion.body;
    if motion.xi1 == Wide::ONE {
        12.0 / (((b - a) * (c - b)).sqrt() * motion.p).to_f64()
    } else {
        4.0 * (motion.k / motion.speed).to_f64()
    }
}

fn reflected(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(412), Cases::default());
    for case in 0..100 {
        // Outside: separatrices and rotations.
        let motion = of_kind(if form == 1 { 1 + case % 2 } else { 0 }, &mut samples);
        let (p_y, end) = (motion.p_y().to_f64(), long_time(&motion));
        let times: Vec<f64> = (0..=100).map(|i| f64::from(i) * end / 100.0).collect();
        let path = states(&motion, p_y, &times)?;
        // The image (y0, −p_y) is met only if p_y changes its sign; an oscillation is there a period less twice ψ0 after the start.
        let turns = path.iter().any(|state| state[2] < 0.0);
        let time = match form {
            2 => 0.5 * end,
            3 => end,
            _ => end - 2.0 * (motion.psi0 / motion.speed).to_f64(),
        };
        let met = turns && {
            let there = states(&motion, p_y, &[time])?[0];
            let (off_y, off_p) = (libm::sin(there[1] - motion.y0().to_f64()), (there[2] + p_y) / motion.p.to_f64());
            off_y.abs() < 1e-12 && off_p.abs() < 1e-12
        };
        cases.see(met, || {
            let sign = if turns { "changes" } else { "keeps" };
            format!("ξ1 = {}: p_y {sign} its sign", motion.xi1.to_f64())
        });
    }
    Ok(cases.none())
}

fn reflected_in_y(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(414), Worst::default());
    let pi = std::f64::consts::PI;
    for case in 0..120 {
        // From the crossing of the equator, which the mirror y → −y mod π keeps: the motion after a time and before it.
        let motion = of_kind(case, &mut samples);
        let ([a, b, c], p) = (motion.body.short(), motion.p.to_f64());
        let p_y = p * ((b - a) * motion.xi1.to_f64() / (c - a)).sqrt();
        let t = samples.even(0.05, 0.25) * long_time(&motion);
        let at = |t: f64| trajectory(a, b, c, 0.5 * pi, p, p_y, &[t], 1e-16).map(|(states, _)| states[0]);
        let (after, before) = (at(t).map_err(unexamined)?, at(-t).map_err(unexamined)?);
        let mirror = match form {
            1 => 0.5 * pi - before[1],
            2 => before[1],
            _ => pi - before[1],
        };
        worst.see(libm::sin(after[1] - mirror));
        worst.see((after[2] - if form == 3 { -before[2] } else { before[2] }) / p);
    }
    Ok(worst.at_most(1e-12, "rounding of two integrations"))
}

fn all_cross_the_equator(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(413), Cases::default());
    for case in 0..150 {
        let motion = of_kind(case, &mut samples);
        let time = 0.5 * long_time(&motion);
        let target = match form {
            1 => 0.0,
            2 => std::f64::consts::PI,
            _ => std::f64::consts::FRAC_PI_2,
        };
        let end = states(&motion, motion.p_y().to_f64(), &[time])?[0][1];
        let start = motion.y0().to_f64();
        cases.see((start - target) * (end - target) < 0.0, || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

const PLACE: &str = "section 3.1";

const BY_FLOW: &str = "power series of the flow (9), random bodies and starts";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        [
            "range_of_oscillation",
            PLACE,
            "An oscillating y runs from arccos √ξ1 to π − arccos √ξ1.",
            "extremes of integrated motions",
        ],
        &["as printed", "arccos ξ1", "arcsin √ξ1"],
        range_of_oscillation,
        "",
    ),
    direct(
        [
            "rotations_are_monotone",
            PLACE,
            "For B p_x² < 2h < C p_x² the motion rotates: y grows (p_y > 0) for ever.",
            "power series of the flow (9), on a grid over two turns",
        ],
        &["as printed", "2h < B p_x²", "y falls"],
        rotations_are_monotone,
        "The article counts 2h = B p_x², the separatrix, to both cases.",
    ),
    direct(
        [
            "minor_axis",
            PLACE,
            "2h = C p_x² is the steady rotation about the axis of least moment: p_y = ±p_x at every y.",
            "p_y from the energy at random y",
        ],
        &["as printed", "2h = B p_x²", "h for 2h"],
        minor_axis,
        "In the chart y goes on turning, as the node is not defined there.",
    ),
    direct(
        [
            "separatrix_joins",
            "Proposition 3.1",
            "Motions with 2h = B p_x² join y = 0 to y = π; both ends are approached like exp(−√((B − A)(C − B)) p_x |t|).",
            BY_FLOW,
        ],
        &["as printed", "C − A for C − B", "C − B for B − A"],
        separatrix_joins,
        "The rate is that of the linearised system at y = 0.",
    ),
    Statement {
        id: "reflected",
        place: "Proposition 3.1",
        says: "All phase trajectories are symmetric with respect to the axis p_y = 0.",
        method: "whether an integrated motion comes to the mirror image (y0, −p_y) of its start, over a period or from one equilibrium to the other",
        shape: Shape::OnlyWhen {
            condition: "the motion oscillates; p_y → −p_y maps a rotation, and a separatrix, to another one, in the other direction",
        },
        forms: &["oscillating", "rotating and separatrices", "half a period", "a period"],
        examine: reflected,
        note: "The level set of H_a is symmetric in every case; a rotation or a separatrix is one of its two parts.",
    },
    direct(
        [
            "reflected_in_y",
            "Proposition 3.1",
            "All phase trajectories on the cylinder y mod π are symmetric with respect to the axis y = 0.",
            "oscillations, separatrices and rotations integrated forward and backward from the equator, which the mirror keeps",
        ],
        &["as printed", "the axis y = π/4", "no mirror", "p_y turned too"],
        reflected_in_y,
        "",
    ),
    direct(
        [
            "all_cross_the_equator",
            "after Proposition 3.1",
            "Every motion but those that rest crosses y = π/2 mod π: starts there are enough to have all.",
            "sides of π/2 half a period apart, oscillations and rotations; on separatrices over a time long enough",
        ],
        &["as printed", "y = 0", "y = π"],
        all_cross_the_equator,
        "",
    ),
];
