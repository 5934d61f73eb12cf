//! Section 5.2.1, Figure 4, and beyond: the exact values of k at which the first conjugate point passes a pole or the equator.
//!
//! For p_θ → 0 the cusp is at `(cos t1, sin t1, 0)`: a pole where t1 = (n + ½)π, the equator where t1 = nπ. There w tan t = tan(wt) has the elementary
//! solutions `w = (2n − 1)/(2n + 1)`, `w = (n − 1)/n`, that is `k = (2n + 1)/√(8n)` and `k = n/√(2n − 1)`. For p_θ > 0 the locus crosses the equator where
//! δβ = 0 on the n-th return: there the conjugate time has a vertical tangent.

use super::differences::{Wide, wide};
use super::spin_closed_form_regimes::Closed;
use super::spin_limits::{meridian_phase, meridian_time};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::switch_points::{Passage, switch_points};
use crate::numerics::real::Real;
use crate::numerics::roots::{RootTolerance, bracketed, newton_bracketed};

/// The statements.
pub const ALL: &[Statement] = &[
    POLE_LAW,
    EQUATOR_LAW,
    ONLY_ONE,
    K_1,
    K_2,
    K_3,
    K_BAR,
    K_BAR_PRIME,
    INTERLACED,
    STEPS,
    PASSAGES,
    TRIPLE_ZERO,
    VERTICAL_TANGENT,
];

const PLACE: &str = "beyond the article, section 5.2.1 and Figure 4";
const FIGURE: &str = "section 5.2.1 and Figure 4";

/// How many switches the laws are checked for.
const SWITCHES: u32 = 120;

/// The phase at `t = (n + shift)π` on the meridian, in half turns, for the switches of a law from this n on.
fn law(k: impl Fn(Wide) -> Wide, from: u32, shift: f64) -> Test {
    let mut worst = Worst::default();
    for n in from..from + SWITCHES {
        let n = wide(f64::from(n));
        let turns = n + wide(shift);
        worst.see((meridian_phase(k(n), turns * Wide::PI) / Wide::PI - Wide::ONE).to_f64());
    }
    worst.at_most(1e-25, &format!("double-double over up to {} half turns", from + SWITCHES))
}

const POLE_LAW: Statement = Statement {
    id: "spin_pole_law",
    place: PLACE,
    says: "For p_θ → 0 the first conjugate point is at a pole for the n-th time when k = (2n + 1)/√(8n), n = 1, 2, …, with t1 = (n + ½)π.",
    method: "the phase of the limit equation at that k and t is π, in double-double, for as many n as the test counts",
    shape: Shape::Direct,
    forms: &["derived here", "(2n − 1)/√(8n)", "(2n + 1)/√(8n + 1)", "(n + 1)/√(2n + 1)"],
    examine: |form| {
        Ok(law(
            |n| {
                let (one, two, eight) = (Wide::ONE, wide(2.0), wide(8.0));
                match form {
                    1 => (two * n - one) / (eight * n).sqrt(),
                    2 => (two * n + one) / (eight * n + one).sqrt(),
                    3 => (n + one) / (two * n + one).sqrt(),
                    _ => (two * n + one) / (eight * n).sqrt(),
                }
            },
            1,
            0.5,
        ))
    },
    note: "The article gives the first three to three decimals: they are 3/√8, 5/4 and 7/√24.",
};

const EQUATOR_LAW: Statement = Statement {
    id: "spin_equator_law",
    place: PLACE,
    says: "For p_θ → 0 the first conjugate point is on the equator for k = n/√(2n − 1), n = 2, 3, …, with t1 = nπ.",
    method: "the phase of the limit equation at that k and t is π, in double-double, for as many n as the test counts",
    shape: Shape::Direct,
    forms: &["derived here", "n/√(2n + 1)", "(n − 1)/√(2n − 1)", "n/√(2n)"],
    examine: |form| {
        Ok(law(
            |n| {
                let (one, two) = (Wide::ONE, wide(2.0));
                match form {
                    1 => n / (two * n + one).sqrt(),
                    2 => (n - one) / (two * n - one).sqrt(),
                    3 => n / (two * n).sqrt(),
                    _ => n / (two * n - one).sqrt(),
                }
            },
            2,
            0.0,
        ))
    },
    note: "The article's k̄ is n = 2.",
};

const ONLY_ONE: Statement = Statement {
    id: "spin_switches_are_unique",
    place: PLACE,
    says: "There are no other switches: at a fixed t on the meridian the phase falls with k, so that each t is the first conjugate time of one k at most.",
    method: "the phase at neighbouring k > 1 and random t in double-double",
    shape: Shape::Direct,
    forms: &["derived here", "the phase rises", "the phase less t/(2k²) falls"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(541), Cases::default());
        for _ in 0..600 {
            let k = 1.0 + samples.log(1e-4, 20.0);
            let (k, step, t) = (wide(k), wide(samples.log(1e-9, 1e-3)), wide(samples.log(0.1, 60.0)));
            let value = |k: Wide| {
                let phase = meridian_phase(k, t);
                if form == 2 { phase - t / (wide(2.0) * k * k) } else { phase }
            };
            let change = value(k + step) - value(k);
            let holds = if form == 1 { change > Wide::ZERO } else { change < Wide::ZERO };
            cases.see(holds, || format!("k = {:?}, t = {:?}: {:?}", k.to_f64(), t.to_f64(), change.to_f64()));
        }
        Ok(cases.none())
    },
    note: "",
};

/// A switch for two small p_θ, extrapolated to p_θ → 0 (corrections are quadratic), against a value.
fn limit(passage: Passage, index: u32, expected: f64) -> Result<Test, Unexamined> {
    let at = |p_theta: f64| -> Result<f64, Unexamined> {
        let found = switch_points(passage, p_theta, 1.001, 1.5).map_err(unexamined)?;
        let switch = found.iter().find(|switch| switch.index == index).ok_or_else(|| unexamined("no such switch"))?;
        Ok(switch.k)
    };
    let (coarse, middle, fine) = (at(8e-3)?, at(4e-3)?, at(2e-3)?);
    let first = ((4.0 * middle - coarse) / 3.0, (4.0 * fine - middle) / 3.0);
    let ours = (16.0 * first.1 - first.0) / 15.0;
    let reason = "two steps of Richardson's extrapolation in p_θ² from full precision".to_owned();
    Ok(Test::Equal { printed: expected, ours, tolerance: 1e-13, reason })
}

/// A statement on one switch.
const fn switch(
    id: &'static str,
    says: &'static str,
    forms: &'static [&'static str],
    examine: fn(Form) -> Result<Test, Unexamined>,
) -> Statement {
    Statement {
        id,
        place: FIGURE,
        says,
        method: "the switch at three small p_θ by the closed form, extrapolated to p_θ → 0",
        shape: Shape::Direct,
        forms,
        examine,
        note: "",
    }
}

const K_1: Statement = switch(
    "spin_k1_exact",
    "k1 → 3/√8 as p_θ → 0, not a mere decimal.",
    &["derived here", "the printed decimal as it stands", "√(10/9)", "2/√3"],
    |form| limit(Passage::Pole, 1, [3.0 / 8f64.sqrt(), 1.061, (10.0 / 9f64).sqrt(), 2.0 / 3f64.sqrt()][form.min(3)]),
);

const K_2: Statement = switch(
    "spin_k2_exact",
    "k2 → 5/4 as p_θ → 0: the printed decimal is exact.",
    &["derived here", "(k1 + k3)/2", "√(k1 k3)", "6/5"],
    |form| {
        let (k1, k3) = (3.0 / 8f64.sqrt(), 7.0 / 24f64.sqrt());
        limit(Passage::Pole, 2, [1.25, 0.5 * (k1 + k3), (k1 * k3).sqrt(), 1.2][form.min(3)])
    },
);

const K_3: Statement = switch(
    "spin_k3_exact",
    "k3 → 7/√24 as p_θ → 0.",
    &["derived here", "the printed decimal as it stands", "10/7", "√2"],
    |form| limit(Passage::Pole, 3, [7.0 / 24f64.sqrt(), 1.429, 10.0 / 7.0, 2f64.sqrt()][form.min(3)]),
);

const K_BAR: Statement = switch(
    "spin_k_bar_exact",
    "k̄ → 2/√3 as p_θ → 0 (the article gives no value).",
    &["derived here", "(k1 + k2)/2", "√(k1 k2)", "15/13"],
    |form| {
        let (k1, k2) = (3.0 / 8f64.sqrt(), 1.25);
        limit(Passage::Equator, 2, [2.0 / 3f64.sqrt(), 0.5 * (k1 + k2), (k1 * k2).sqrt(), 15.0 / 13.0][form.min(3)])
    },
);

const K_BAR_PRIME: Statement = switch(
    "spin_k_bar_prime_exact",
    "The second crossing of the equator, between k2 and k3, is at 3/√5 as p_θ → 0 (not in the article).",
    &["derived here", "(k2 + k3)/2", "√(k2 k3)", "4/3"],
    |form| {
        let (k2, k3) = (1.25, 7.0 / 24f64.sqrt());
        limit(Passage::Equator, 3, [3.0 / 5f64.sqrt(), 0.5 * (k2 + k3), (k2 * k3).sqrt(), 4.0 / 3.0][form.min(3)])
    },
);

/// `8·k²` of the n-th pole and `k²` of the equator after it, as fractions: exact in integers.
fn squares(n: u64) -> ((u64, u64), (u64, u64)) {
    (((2 * n + 1).pow(2), 8 * n), ((n + 1).pow(2), 2 * n + 1))
}

const INTERLACED: Statement = Statement {
    id: "spin_switches_interlaced",
    place: "section 5.2.3",
    says: "For growing k the cusp passes pole and equator in turn, for ever: (2n + 1)/√(8n) < (n + 1)/√(2n + 1) < (2n + 3)/√(8n + 8) for all n ≥ 1.",
    method: "the squares, as fractions of integers, for n up to a thousand",
    shape: Shape::Direct,
    forms: &["derived here", "the equator first", "two poles between"],
    examine: |form| {
        let mut cases = Cases::default();
        let less = |a: (u64, u64), b: (u64, u64)| a.0 * b.1 < b.0 * a.1;
        for n in 1..=1000 {
            let ((pole, equator), (next, _)) = (squares(n), squares(n + 1));
            let holds = match form {
                1 => less(equator, pole),
                2 => less(next, equator),
                _ => less(pole, equator) && less(equator, next),
            };
            cases.see(holds, || format!("n = {n}"));
        }
        Ok(cases.none())
    },
    note: "",
};

const STEPS: Statement = Statement {
    id: "spin_steps_shrink",
    place: FIGURE,
    says: "The steps between the switches differ, k2 − k1 ≠ k3 − k2, and shrink for ever; k_n ~ √(n/2).",
    method: "steps of (2n + 1)/√(8n) in double-double for n up to a thousand, and k_n²/n",
    shape: Shape::Direct,
    forms: &["as printed, with the law found here", "the steps are equal to three decimals", "the steps grow"],
    examine: |form| {
        let mut cases = Cases::default();
        let k = |n: u32| {
            let n = wide(f64::from(n));
            (wide(2.0) * n + Wide::ONE) / (wide(8.0) * n).sqrt()
        };
        for n in 1..=1000 {
            let (step, next) = (k(n + 1) - k(n), k(n + 2) - k(n + 1));
            let holds = match form {
                1 => (step - next).to_f64().abs() < 5e-4,
                2 => next > step,
                _ => next < step,
            };
            cases.see(holds, || format!("n = {n}: {:?}, {:?}", step.to_f64(), next.to_f64()));
        }
        let far = k(1000);
        cases.see((far * far / wide(1000.0) - wide(0.5)).to_f64().abs() < 1e-3, || "k² is not n/2".to_owned());
        Ok(cases.none())
    },
    note: "",
};

const PASSAGES: Statement = Statement {
    id: "spin_number_of_passages",
    place: PLACE,
    says: "For p_θ → 0 the cusp has passed a pole as often as there are n with (2n + 1)/√(8n) ≤ k, and lies beyond as many returns to the equator as there are n ≥ 1 with n/√(2n − 1) ≤ k.",
    method: "whole turns in the solution of the limit equation in double-double for random k from 1 to 6",
    shape: Shape::Direct,
    forms: &["derived here", "one pole less", "k² ≥ n for poles and returns"],
    examine: |form| {
        let (mut samples, mut cases) = (Samples::new(542), Cases::default());
        for _ in 0..150 {
            let k = samples.even(1.001, 6.0);
            let turns = (meridian_time(wide(k))? / Wide::PI).to_f64();
            let number =
                |square: &dyn Fn(f64) -> f64| (1..400).filter(|n| square(f64::from(*n)) <= k * k).count() as f64;
            let (poles, returns) = match form {
                2 => (number(&|n| n), number(&|n| n)),
                _ => (number(&|n| (2.0 * n + 1.0) * (2.0 * n + 1.0) / (8.0 * n)), number(&|n| n * n / (2.0 * n - 1.0))),
            };
            let poles = if form == 1 { poles - 1.0 } else { poles };
            // One pole lies before the first return: the n-th switch takes the cusp over the next one.
            let holds = (turns - 0.5).floor() == poles && turns.floor() == returns;
            cases.see(holds, || format!("k = {k:?}: t1/π = {turns:?}, {poles:?}, {returns:?}"));
        }
        Ok(cases.none())
    },
    note: "So the number of loops of the half locus is the number of returns less one.",
};

/// Where the locus crosses the equator for this k: p_θ and t with λ = 2π, δβ = 0.
fn crossing(k: f64) -> Result<(Wide, Wide), Unexamined> {
    let k = wide(k);
    let second_return = |p: Wide| -> Result<Wide, Unexamined> {
        let closed = Closed::new(k, p);
        let two_turns = wide(2.0) * Wide::PI;
        // λ' lies between G/2k² and G/2.
        let (low, high) = (two_turns * wide(2.0) / closed.casimir(), two_turns * wide(2.0) * k * k / closed.casimir());
        let function = |t: Wide| {
            let state = closed.at(t);
            let ellipse = state.cosine.squared() + (k * state.sine).squared();
            (state.lambda - two_turns, closed.casimir() / (wide(2.0) * ellipse))
        };
        let middle = wide(0.5) * (low + high);
        Ok(newton_bracketed(function, low * wide(0.99), high, middle, RootTolerance::full()).map_err(unexamined)?.x)
    };
    let mut fault = None;
    let function = |p: Wide| match second_return(p) {
        Ok(t) => Closed::new(k, p).at(t).delta,
        Err(error) => {
            fault = Some(error);
            wide(f64::NAN)
        }
    };
    let low = wide(1e-3);
    let high = wide(1.999) * ((k - Wide::ONE) * (k + Wide::ONE)).sqrt();
    let root = bracketed(function, low, high, RootTolerance::full());
    if let Some(error) = fault {
        return Err(error);
    }
    let p = root.map_err(unexamined)?.x;
    Ok((p, second_return(p)?))
}

/// Values of k for which the locus crosses the equator on the second return.
const CROSSED: [f64; 3] = [1.17, 1.3, 1.45];

const TRIPLE_ZERO: Statement = Statement {
    id: "spin_triple_zero",
    place: PLACE,
    says: "Where the conjugate locus crosses the equator (δβ = 0 on a return) the Jacobi field has a triple zero: Θ − π ~ c (t − t1)³.",
    method: "the phase in closed form on both sides of that zero, several k: halving the distance leaves an eighth",
    shape: Shape::Direct,
    forms: &["derived here", "a simple zero: a half", "a double zero: a quarter, of the same sign"],
    examine: |form| {
        let mut worst = Worst::default();
        for k in CROSSED {
            let (p, t) = crossing(k)?;
            let closed = Closed::new(wide(k), p);
            let beyond = |s: f64| closed.phase(t + wide(s), 0) - Wide::PI;
            // The odd part: the next term, of fourth order, is even.
            let odd = |s: f64| beyond(s) - beyond(-s);
            let ratio = if form == 2 { beyond(1e-5) / -beyond(-5e-6) } else { odd(1e-5) / odd(5e-6) };
            worst.see((ratio / wide([8.0, 2.0, 4.0][form.min(2)]) - Wide::ONE).to_f64());
        }
        Ok(worst.at_most(1e-8, "the fifth order of a distance of 1e-5"))
    },
    note: "So it is never double, and beside it there is one real zero: nothing to skip.",
};

const VERTICAL_TANGENT: Statement = Statement {
    id: "spin_vertical_tangent",
    place: PLACE,
    says: "There t1(p_θ) has a vertical tangent: t1 − t_c ~ −C·sign(p_θ − p_c) |p_θ − p_c|^(1/3), C > 0.",
    method: "t1 where Θ = π beside the crossing by the closed form, several k: an eighth of the distance in p_θ leaves half of that in t1",
    shape: Shape::Direct,
    forms: &["derived here", "the square root", "an ordinary slope"],
    examine: |form| {
        let mut worst = Worst::default();
        let exponent = [1.0 / 3.0, 0.5, 1.0][form.min(2)];
        for k in CROSSED {
            let (p, t) = crossing(k)?;
            let moved = |relative: f64| -> Result<f64, Unexamined> {
                let closed = Closed::new(wide(k), p * (Wide::ONE + wide(relative)));
                let root = bracketed(
                    |s: Wide| closed.phase(t + s, 0) - Wide::PI,
                    wide(-0.3),
                    wide(0.3),
                    RootTolerance::full(),
                );
                Ok(root.map_err(unexamined)?.x.to_f64())
            };
            for side in [1.0, -1.0] {
                let (far, near) = (moved(8e-12 * side)?, moved(1e-12 * side)?);
                worst.see(libm::log(far / near) / libm::log(8.0) / exponent - 1.0);
                // Later for smaller p_θ.
                worst.see(if far * side < 0.0 { 0.0 } else { 1.0 });
            }
        }
        Ok(worst.at_most(1e-5, "the next terms, of the order of the cube root of 1e-12 in t1"))
    },
    note: "A relative error of one ε in p_θ moves t1 by about its cube root there: the condition of the problem, not of a method.",
};
