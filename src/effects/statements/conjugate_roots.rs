//! Statements of section 3.2.2, Lemma 3.6 to Theorem 3.9: where the roots of `I(τ) = Λτ` lie.
//!
//! Roots are counted by structure, not by scanning: between two poles of `I`, at `2jK − ψ0`, `I(τ) − Λτ` grows, since `I' = 1/sn² ≥ 1 ≥ Λ`;
//! so it has one root on an interval without a pole exactly when its signs at the ends differ.

use super::bodies::{Body, Motion, by_differences, direct, exact, unit};
use super::conjugate_times::{lambda, rest_of_i};
use super::differences::{Wide, slope_of_order_4, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, TRANSCRIPTION, Unexamined, unexamined};
use crate::contract::claim::Test;
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::numerics::elliptic::complete::{complete_e, complete_k_minus_e};
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

/// `I(τ) − Λτ`.
fn excess(motion: &Motion, tau: Wide) -> Wide {
    tau - rest_of_i(motion, tau) - lambda(&motion.body, motion.xi1) * tau
}

/// The roots in `(from, to)`, without that at zero.
fn roots(motion: &Motion, from: Wide, to: Wide) -> u32 {
    let (two_k, tiny) = (motion.k + motion.k, wide(1e-20) * motion.k);
    let pole = |j: i32| two_k * wide(f64::from(j)) - motion.psi0;
    let mut count = 0;
    for j in -6..6 {
        // The part between the poles j and j + 1, with what is known of the signs at poles: minus after, plus before.
        let (low, high) = (pole(j).max(from), pole(j + 1).min(to));
        if low >= high {
            continue;
        }
        let below = low == pole(j) || excess(motion, low + tiny) < Wide::ZERO;
        let above = high == pole(j + 1) || excess(motion, high - tiny) > Wide::ZERO;
        count += u32::from(below && above);
    }
    count
}

fn roots_on(intervals: impl Fn(&Motion, f64) -> [Wide; 2], expected: u32) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(701), Cases::default());
    for case in 0..150 {
        let motion = Motion::oscillating(&mut samples);
        let i = f64::from(1 + case % 3);
        let [from, to] = intervals(&motion, i);
        let found = roots(&motion, from, to);
        cases.see(found == expected, || {
            format!("{found} roots, i = {i}, ξ1 = {}, m = {}", motion.xi1.to_f64(), motion.m.to_f64())
        });
    }
    Ok(cases.none())
}

fn positive_roots(form: Form) -> Result<Test, Unexamined> {
    roots_on(
        |motion, i| {
            let two_k = wide(2.0) * motion.k;
            match form {
                1 => [two_k * wide(i) - motion.psi0, two_k * wide(i)],
                2 => [two_k * wide(i - 1.0), two_k * wide(i)],
                _ => [two_k * wide(i), two_k * wide(i + 1.0) - motion.psi0],
            }
        },
        1,
    )
}

fn negative_roots(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(701), Cases::default());
    for case in 0..150 {
        let motion = Motion::oscillating(&mut samples);
        let i = 1 + case % 3;
        let (two_k, count) = (wide(2.0) * motion.k, wide(f64::from(i)));
        let [from, to] = match form {
            0 => [-(two_k * (count + Wide::ONE)) - motion.psi0, -(two_k * count)],
            2 => [-(two_k * count), -(two_k * count) + motion.psi0],
            3 => [-(two_k * (count + Wide::ONE)), -(two_k * count) - motion.psi0],
            _ => [-(two_k * count) - motion.psi0, -(two_k * count)],
        };
        // One on the interval, and as many as intervals down to its end.
        let (found, all) = (roots(&motion, from, to), roots(&motion, from, Wide::ZERO));
        cases.see(found == 1 && all == i, || {
            format!("{found} roots of {all}, i = {i}, ξ1 = {}, m = {}", motion.xi1.to_f64(), motion.m.to_f64())
        });
    }
    Ok(cases.none())
}

fn no_root_behind_poles(form: Form) -> Result<Test, Unexamined> {
    roots_on(
        |motion, i| {
            let two_k = wide(2.0) * motion.k;
            match form {
                1 => [two_k * wide(i), two_k * wide(i + 1.0) - motion.psi0],
                2 => [two_k * wide(i) - motion.psi0, two_k * wide(i + 1.0) - motion.psi0],
                _ => [two_k * wide(i) - motion.psi0, two_k * wide(i)],
            }
        },
        0,
    )
}

fn no_root_behind_negative_poles(form: Form) -> Result<Test, Unexamined> {
    roots_on(
        |motion, i| {
            let two_k = wide(2.0) * motion.k;
            match form {
                0 => [-(two_k * wide(i)) - motion.psi0, -(two_k * wide(i))],
                2 => [-(two_k * wide(i + 1.0)) - motion.psi0, -(two_k * wide(i)) - motion.psi0],
                3 => [-(two_k * wide(i + 1.0)), -(two_k * wide(i))],
                _ => [-(two_k * wide(i + 1.0)), -(two_k * wide(i)) - motion.psi0],
            }
        },
        0,
    )
}

fn no_early_root(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(705), Cases::default());
    for _ in 0..300 {
        let motion = Motion::oscillating(&mut samples);
        // On (−ψ0, 2K − ψ0) I is a plain integral; the root at zero is none of a conjugate time.
        let part = wide(unit(&mut samples));
        let tau =
            if samples.sign() > 0.0 { part * (wide(2.0) * motion.k - motion.psi0) } else { -(part * motion.psi0) };
        let i = tau - rest_of_i(&motion, tau);
        let holds = match form {
            1 => i / tau < Wide::ONE,
            2 => i / tau > Wide::ONE / lambda(&motion.body, motion.xi1),
            _ => i / tau > lambda(&motion.body, motion.xi1).max(Wide::ONE),
        };
        cases.see(holds, || format!("τ = {}, ψ0 = {}", tau.to_f64(), motion.psi0.to_f64()));
    }
    Ok(cases.none())
}

fn period_of_equation(form: Form) -> Result<Test, Unexamined> {
    exact(706, |samples| {
        let motion = Motion::oscillating(samples);
        let tau = wide(samples.even(0.1, 0.8)) * motion.k;
        let two = wide(2.0);
        let growth = excess(&motion, tau + two * motion.k) - excess(&motion, tau);
        let (gap, slope) = (complete_k_minus_e(motion.m, motion.mc), lambda(&motion.body, motion.xi1));
        let expected = match form {
            0 => Wide::ZERO,
            2 => two * gap,
            3 => two * (gap + slope * motion.k),
            _ => two * (gap - slope * motion.k),
        };
        [growth, expected, wide(1e-3) * motion.k]
    })
}

fn value_at_2k(form: Form) -> Result<Test, Unexamined> {
    exact(707, |samples| {
        let motion = Motion::oscillating(samples);
        let two_k = wide(2.0) * motion.k;
        let e = complete_e(motion.mc);
        let right = match form {
            1 => wide(2.0) * e,
            2 => motion.k - e,
            _ => wide(2.0) * (motion.k - e),
        };
        [two_k - rest_of_i(&motion, two_k), right, wide(1e-3) * motion.k]
    })
}

fn shapes_of_both(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(708), Cases::default());
    for _ in 0..300 {
        let body = Body::any(&mut samples);
        let xi3 = (body.c - body.a) / (body.b - body.a);
        let (x, y) = (wide(unit(&mut samples)), wide(unit(&mut samples)));
        if x == y {
            continue;
        }
        let m = |xi: Wide| xi * (xi3 - Wide::ONE) / (xi3 - xi);
        let l = |xi: Wide| lambda(&body, xi);
        let half = wide(0.5);
        let bend = |f: &dyn Fn(Wide) -> Wide| f((x + y) * half) - (f(x) + f(y)) * half;
        let grows = |f: &dyn Fn(Wide) -> Wide| (f(x) - f(y)) * (x - y) > Wide::ZERO;
        let holds = match form {
            1 => bend(&l) < Wide::ZERO,
            2 => l(x) < m(x),
            3 => bend(&m) > Wide::ZERO,
            _ => grows(&l) && grows(&m) && bend(&l) > Wide::ZERO && bend(&m) < Wide::ZERO && l(x) > m(x),
        };
        let ends = l(Wide::ZERO) == Wide::ZERO && l(Wide::ONE) == Wide::ONE;
        cases.see(holds && ends, || format!("ξ1 = {}, {}", x.to_f64(), y.to_f64()));
    }
    Ok(cases.none())
}

fn below_the_line(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(709), Cases::default());
    for _ in 0..300 {
        let motion = Motion::oscillating(&mut samples);
        let (m, gap) = (motion.m, complete_k_minus_e(motion.m, motion.mc));
        // mK ≥ K − E, hence I < mτ between the pole 2K − ψ0 and 2K.
        let tau = wide(2.0) * motion.k - wide(unit(&mut samples)) * motion.psi0;
        let i = tau - rest_of_i(&motion, tau);
        let holds = match form {
            1 => m * motion.k <= gap,
            2 => m * m * motion.k >= gap && i < m * tau,
            3 => i > m * tau,
            _ => m * motion.k >= gap && i < m * tau,
        };
        cases.see(holds, || format!("m = {}", m.to_f64()));
    }
    Ok(cases.none())
}

fn backward_bounds(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(710), Cases::default());
    for _ in 0..150 {
        let motion = Motion::ordinary(&mut samples);
        let [a, b, c] = motion.body.short();
        let (y0, p_x, p_y) = (motion.y0().to_f64(), motion.p.to_f64(), motion.p_y().to_f64());
        let end = -5.0 * (motion.k / motion.speed).to_f64();
        let found = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, 0.0, end, 1e-16).map_err(unexamined)?;
        let phase = wide(found.t1.abs()) * motion.speed;
        let two_k = wide(2.0) * motion.k;
        let upper = match form {
            1 => two_k + motion.psi0 / wide(2.0),
            2 => two_k * wide(2.0) - motion.psi0,
            _ => two_k + motion.psi0,
        };
        let lower = if form == 2 { two_k + motion.psi0 / wide(2.0) } else { two_k };
        cases.see(lower < phase && phase < upper, || format!("ψ0/K = {}", (motion.psi0 / motion.k).to_f64()));
    }
    Ok(cases.none())
}

fn slope_of_half_period(form: Form) -> Result<Test, Unexamined> {
    by_differences(711, |samples| {
        let motion = Motion::oscillating(samples);
        let (Body { a, b, .. }, p, one) = (motion.body, motion.p, Wide::ONE);
        let xi3 = motion.xi3;
        let half = |xi1: Wide| {
            // At a fixed p_x as printed; at a fixed energy in one wrong form.
            let p = if form == 3 { p * ((a + (b - a) * motion.xi1) / (a + (b - a) * xi1)).sqrt() } else { p };
            let mc = xi3 * (one - xi1) / (xi3 - xi1);
            wide(2.0) * complete_k(mc) / ((b - a) * p * (xi3 - xi1).sqrt())
        };
        let xi1 = motion.xi1;
        let step = 1e-4 * (one - xi1).min(xi1).to_f64();
        let gap = complete_k_minus_e(motion.m, motion.mc);
        let up = match form {
            1 => -gap - xi1 * motion.k,
            _ => xi1 * motion.k - gap,
        };
        let down = if form == 2 { (one - xi1) * motion.speed } else { (one - xi1) * xi1 * motion.speed };
        [slope_of_order_4(half, xi1, step), up / down, Wide::ZERO]
    })
}

fn slope_of_xi1(form: Form) -> Result<Test, Unexamined> {
    by_differences(712, |samples| {
        let motion = Motion::oscillating(samples);
        let (Body { a, b, .. }, p, h2) = (motion.body, motion.p, wide(2.0) * motion.h);
        let left = slope_of_order_4(|p| (h2 - a * p * p) / (p * p * (b - a)), p, 1e-5 * p.to_f64());
        let printed = -(wide(2.0) * h2 / (p * p * p));
        let right = match form {
            0 => printed,
            2 => -(printed / (b - a)),
            3 => printed * p / (b - a),
            _ => printed / (b - a),
        };
        [left, right, Wide::ZERO]
    })
}

fn half_period_falls(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut cases) = (Samples::new(713), Cases::default());
    for _ in 0..300 {
        let motion = Motion::oscillating(&mut samples);
        let Body { a, b, c } = motion.body;
        let h2 = wide(2.0) * motion.h;
        // At a fixed energy, p_x between √(2h/B) and √(2h/A).
        let half = |p: Wide| {
            let over = (b - a) * (c * p * p - h2);
            wide(2.0) * complete_k((c - a) * (b * p * p - h2) / over) / over.sqrt()
        };
        let (low, high) = ((h2 / b).sqrt(), (h2 / a).sqrt());
        let at = |part: f64| low + (high - low) * wide(part);
        let (x, y) = (unit(&mut samples), unit(&mut samples));
        let (x, y) = (x.min(y), x.max(y));
        let energy = match form {
            2 => h2 / wide(2.0),
            3 => h2 * wide(2.0),
            _ => h2,
        };
        let limit = Wide::PI * (a / (energy * (b - a) * (c - a))).sqrt();
        let reached = (half(at(1.0 - 1e-12)) / limit - Wide::ONE).abs() < wide(1e-6);
        let positive =
            complete_e(motion.mc) - (Wide::ONE - motion.m) * motion.k >= Wide::ZERO && motion.xi1 >= motion.m;
        let holds = match form {
            1 => half(at(x)) < half(at(y)),
            _ => half(at(x)) > half(at(y)) && reached,
        };
        cases.see(x == y || (holds && positive), || format!("ξ1 = {}", motion.xi1.to_f64()));
    }
    Ok(cases.none())
}

/// What I is at conjugate times, for the notes.
macro_rules! continued {
    () => {
        "Beyond the first zero of sn the integral I diverges; it stands for its continuation by (17)."
    };
}

const LEMMA: &str = "Lemma 3.6";

const PROOF: &str = "proof of Lemma 3.6";

const COUNTED: &str = "roots counted between the poles of I, where I(τ) − Λτ grows; random bodies, i up to three";

const THEOREM: &str = "proof of Theorem 3.9";

/// The statements of this page.
pub const ALL: &[Statement] = &[
    direct(
        ["positive_roots", LEMMA, "I(τ) = Λτ has exactly one root on every (2iK, 2(i+1)K − ψ0), i = 1, 2, …", COUNTED],
        &["as printed", "on (2iK − ψ0, 2iK)", "with i = 0 too"],
        positive_roots,
        continued!(),
    ),
    Statement {
        id: "negative_roots",
        place: LEMMA,
        says: "I(τ) = Λτ has exactly one root between −2iK and −2(i+1)K − ψ0, i = 1, 2, …",
        method: COUNTED,
        shape: Shape::Slip {
            correction: "exactly one root on every (−2iK − ψ0, −2iK), i = 1, 2, …, and no other negative one",
        },
        forms: &["as printed", "on (−2iK − ψ0, −2iK)", "on (−2iK, −2iK + ψ0)", "on (−2(i+1)K, −2iK − ψ0)"],
        examine: negative_roots,
        note: concat!(
            "The printed intervals overlap, and each holds a second root. Known to us through a transcription of the page, which may have lost a \
             sign, a root or a factor. ",
            continued!()
        ),
    },
    direct(
        ["no_root_behind_poles", PROOF, "There is no root on (2iK − ψ0, 2iK), i = 1, 2, …", COUNTED],
        &["as printed", "none on (2iK, 2(i+1)K − ψ0)", "none on (2iK − ψ0, 2(i+1)K − ψ0)"],
        no_root_behind_poles,
        continued!(),
    ),
    Statement {
        id: "no_root_behind_negative_poles",
        place: PROOF,
        says: "By the same argument there is no root between −2iK − ψ0 and −2iK.",
        method: COUNTED,
        shape: Shape::Slip { correction: "there is no root between −2(i+1)K and −2iK − ψ0, i = 1, 2, …" },
        forms: &[
            "as printed",
            "none on (−2(i+1)K, −2iK − ψ0)",
            "none on (−2(i+1)K − ψ0, −2iK − ψ0)",
            "none on (−2(i+1)K, −2iK)",
        ],
        examine: no_root_behind_negative_poles,
        note: concat!(
            "The argument turns round with the sign of τ: I(−2iK) = −2i(K − E) lies above −2iKΛ, so that every negative root is there, as the \
             corrected Lemma 3.6 says. It is this first negative root that gives the bound \
             3K/M of Corollary 3.7. The text at hand has the printed interval three times, once garbled. ",
            continued!()
        ),
    },
    direct(
        [
            "no_early_root",
            PROOF,
            "On (−ψ0, 2K − ψ0) there is no root but zero: I(τ)/τ ≥ 1 ≥ Λ.",
            "random τ of the interval, some close to its ends",
        ],
        &["as printed", "I(τ) < τ", "I(τ) > τ/Λ"],
        no_early_root,
        "",
    ),
    Statement {
        id: "period_of_equation",
        place: PROOF,
        says: "Equation (15) is periodic: I(τ) − Λτ has the period 2K.",
        method: "growth over 2K at random τ",
        shape: Shape::Slip { correction: "over 2K it changes by 2(K − E − ΛK) < 0, whatever τ" },
        forms: &["as printed", "by 2(K − E − ΛK)", "by 2(K − E)", "by 2(K − E + ΛK)"],
        examine: period_of_equation,
        note: concat!(
            "The change is negative, since K − E ≤ mK < ΛK: what is shown for one interval follows for the later ones all the same, but \
             successive conjugate times are farther apart than the half period. ",
            continued!()
        ),
    },
    direct(
        ["value_at_2k", PROOF, "I(2K) = 2(K(m) − E(m)).", "(17) at random ψ0"],
        &["as printed", "2E", "half of it"],
        value_at_2k,
        continued!(),
    ),
    direct(
        [
            "shapes_of_lambda_and_m",
            PROOF,
            "Λ(ξ1) grows from 0 to 1 and is strictly concave, m(ξ1) grows and is strictly convex, and Λ > m on (0, 1).",
            "random pairs of ξ1, some close to 0 and 1, and their means",
        ],
        &["as printed", "Λ convex", "Λ < m", "m concave"],
        shapes_of_both,
        "",
    ),
    direct(
        [
            "below_the_line",
            PROOF,
            "mK ≥ K − E, and so I(τ) < mτ on (2K − ψ0, 2K).",
            "random m from a millionth to one minus that",
        ],
        &["as printed", "mK ≤ K − E", "m² for m", "I above the line"],
        below_the_line,
        continued!(),
    ),
    direct(
        [
            "backward_bounds",
            "Corollary 3.7; definition of t_*^1",
            "The first negative conjugate time obeys 2K < M|t| < 2K + ψ0, so that the smaller |t| of both signs is below 3K/M for ψ0 ≤ K.",
            "zeros of the variation of (9), integrated backward",
        ],
        &["derived from the corrected Lemma 3.6", "2K + ψ0/2 above", "the bounds of positive times"],
        backward_bounds,
        "Not in the article: the reason why Corollary 3.7 is true for t_*^1 = min |t_*|.",
    ),
    direct(
        [
            "slope_of_half_period",
            THEOREM,
            "d/dξ1 (2K(m)/M) = (E − K + ξ1 K)/((1 − ξ1) ξ1 (B − A) √(p_x²(ξ3 − ξ1))) ≥ 0.",
            "difference quotients at a fixed p_x",
        ],
        &["as printed", "−ξ1 K", "without ξ1 below", "at a fixed energy"],
        slope_of_half_period,
        "It holds at a fixed p_x; with the energy fixed, as in the theorem, p_x changes too and the slope is steeper, of the same sign.",
    ),
    Statement {
        id: "slope_of_xi1",
        place: THEOREM,
        says: "dξ1/dp_x = −4h/p_x³.",
        method: "difference quotients at a fixed energy",
        shape: Shape::Slip { correction: "dξ1/dp_x = −4h/((B − A) p_x³)" },
        forms: &["as printed", "with B − A", "the sign", "p_x² below"],
        examine: slope_of_xi1,
        note: TRANSCRIPTION,
    },
    direct(
        [
            "half_period_falls",
            "Theorem 3.9, part 2 and its proof",
            "At a fixed energy 2K(m)/M falls in p_x on (√(2h/B), √(2h/A)), towards π√A/√(2h(B − A)(C − A)); ξ1 ≥ m and E − K + mK ≥ 0.",
            "random pairs of p_x, some close to the ends, and a trillionth of the interval before its end",
        ],
        &["as printed", "it grows", "h for 2h in the limit", "4h for 2h in the limit"],
        half_period_falls,
        "",
    ),
];
