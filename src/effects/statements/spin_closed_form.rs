//! Beyond the article: the first conjugate time of the spin problem in closed form, and why no root can be skipped.
//!
//! Statement. Put `h = (2k sin β, −2k β', 2 cos β)`; then `β'² = b² − w² sin²β`, `β(0) = 0`, `b = p_θ/(2k)`, `w² = 1 − 1/k²`. With `P = cos²β + k² sin²β`,
//! `λ' = G/(2P)`, `A = 2G δβ`, `B = G² δβ' − p_θ β'` (δ = ∂/∂p_θ), conjugate points are where `A cos λ = B sin λ`; the phase
//! `Θ = λ − arg(B + iA)` has `Θ' = 2G³ P δβ²/(k² (A² + B²)) ≥ 0`, so that the j-th conjugate time is the only solution of Θ = jπ.
//! Here the differential identities, at random instants that need no closed form; the Jacobi functions are in `spin_closed_form_regimes`.

use super::spin_closed_form_regimes::{Closed, random_starts};
use super::spin_points::{ALGEBRA, POINTS, QUOTIENT, Wide, anisotropy, cross, dot, reason, slopes, wide};
use super::statement::{Cases, Form, Samples, Shape, Statement, Unexamined, Worst, unexamined};
use crate::contract::claim::Test;
use crate::geometry::spin::lift::{
    conjugate_times_by_integration, equator_crossings, first_conjugate_time_by_integration,
};
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] =
    &[BETA, NODE_ANGLE, SCALAR, PHASE_RATE, RETURNS, CUT_POINT, FIRST_TIME, COUNT, ROTATING, HALF_TURNS];

/// Accuracy of the integrations.
const TOLERANCE: f64 = 1e-15;
/// What an integrated time and a closed form may differ by in the phase: rounding of both, times the growth of the flow.
const INTEGRATED: f64 = 1e-12;
const PLACE: &str = "beyond the article, section 4.3";

/// An extremal at some instant: β, β' with the energy of its p_θ, any node angle λ, any δβ and the δβ' that the energy leaves.
struct Instant {
    k: Wide,
    p: Wide,
    sine: Wide,
    cosine: Wide,
    rate: Wide,
    lambda: Wide,
    delta: Wide,
    delta_rate: Wide,
}

impl Instant {
    fn all(seed: u64) -> impl Iterator<Item = Self> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |index| {
            let k = wide(anisotropy(&mut samples, index));
            let p = wide(samples.log(0.01, 100.0));
            let (b, w2) = (p / (k + k), Self::stiffness(k));
            let widest = if b * b < w2 { b / w2.sqrt() } else { Wide::ONE };
            let sine = widest * wide(samples.even(-0.999, 0.999));
            let cosine = wide(samples.sign()) * (Wide::ONE - sine * sine).sqrt();
            let rate = wide(samples.sign()) * (b * b - w2 * sine * sine).sqrt();
            let delta = wide(samples.sign() * samples.log(0.01, 10.0));
            // The variation of β'² = p²/(4k²) − w² sin²β.
            let delta_rate = (p / (wide(4.0) * k * k) - w2 * sine * cosine * delta) / rate;
            Self { k, p, sine, cosine, rate, lambda: wide(samples.even(-3.0, 3.0)), delta, delta_rate }
        })
    }

    /// `w²`.
    fn stiffness(k: Wide) -> Wide {
        (k - Wide::ONE) * (k + Wide::ONE) / (k * k)
    }

    /// The instant after a time s, to first order in everything.
    fn moved(&self, s: Wide) -> Self {
        let w2 = Self::stiffness(self.k);
        let double = self.cosine * self.cosine - self.sine * self.sine;
        let (turn_sine, turn_cosine) = (s * self.rate).sin_cos();
        Self {
            sine: self.sine * turn_cosine + self.cosine * turn_sine,
            cosine: self.cosine * turn_cosine - self.sine * turn_sine,
            rate: self.rate - s * w2 * self.sine * self.cosine,
            lambda: self.lambda + s * self.node_rate(),
            delta: self.delta + s * self.delta_rate,
            delta_rate: self.delta_rate - s * w2 * double * self.delta,
            ..*self
        }
    }

    fn casimir(&self) -> Wide {
        (self.p * self.p + wide(4.0)).sqrt()
    }

    /// `P = cos²β + k² sin²β`.
    fn ellipse(&self) -> Wide {
        self.cosine.squared() + (self.k * self.sine).squared()
    }

    /// `G/(2P)`.
    fn node_rate(&self) -> Wide {
        self.casimir() / (wide(2.0) * self.ellipse())
    }

    fn momentum(&self) -> [Wide; 3] {
        let two = wide(2.0);
        [two * self.k * self.sine, -(two * self.k * self.rate), two * self.cosine]
    }

    fn momentum_variation(&self) -> [Wide; 3] {
        let two = wide(2.0);
        [two * self.k * self.cosine * self.delta, -(two * self.k * self.delta_rate), -(two * self.sine * self.delta)]
    }

    /// The point at the angle λ from the node line `e_y × h`.
    fn position(&self) -> [Wide; 3] {
        let [h1, h2, h3] = self.momentum();
        let rho = (h1 * h1 + h3 * h3).sqrt();
        let (sine, cosine) = self.lambda.sin_cos();
        let across = sine / self.casimir();
        [(cosine * h3 - across * h1 * h2) / rho, across * rho, (-(cosine * h1) - across * h2 * h3) / rho]
    }

    fn velocity(&self) -> [Wide; 3] {
        [self.sine / self.k, Wide::ZERO, self.cosine]
    }

    /// `A = 2G δβ`, `B = G² δβ' − p β'`, with named changes.
    fn a_and_b(&self, form: Form) -> (Wide, Wide) {
        let g = self.casimir();
        let a = if form == 1 { g * self.delta } else { wide(2.0) * g * self.delta };
        let drag = match form {
            2 => -(self.p * self.rate),
            3 => Wide::ZERO,
            _ => self.p * self.rate,
        };
        (a, g * g * self.delta_rate - drag)
    }
}

const BETA: Statement = Statement {
    id: "spin_beta",
    place: PLACE,
    says: "With h = (2k sin β, −2k β', 2 cos β) the lift is the pendulum β'² = b² − w² sin²β, b = p_θ/(2k), w² = 1 − 1/k², β(0) = 0, and G² = p_θ² + 4.",
    method: "h' = ω × h with ω = (h1/(2k²), 0, h3/2) against the derivative of these three along β'' = −w² sin β cos β, and |h|², at random instants",
    shape: Shape::Direct,
    forms: &["derived here", "the sign of h2", "w² = 1 − k²", "h1 = 2 sin β"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Instant::all(501) {
            let k2 = at.k * at.k;
            let change = |at: &Instant| {
                let [h1, h2, h3] = at.momentum();
                match form {
                    1 => [h1, -h2, h3],
                    3 => [h1 / at.k, h2, h3],
                    _ => [h1, h2, h3],
                }
            };
            let h = change(&at);
            let omega = [h[0] / (wide(2.0) * k2), Wide::ZERO, h[2] / wide(2.0)];
            let turned = cross(omega, h);
            let rates = slopes(
                |s| {
                    let mut after = at.moved(s);
                    if form == 2 {
                        after.rate = at.rate - s * (Wide::ONE - k2) * at.sine * at.cosine;
                    }
                    change(&after)
                },
                Wide::ZERO,
            );
            let size = dot(omega, omega).sqrt() * at.casimir();
            (0..3).for_each(|i| worst.see(((rates[i] - turned[i]) / size).to_f64()));
            worst.see((dot(h, h) / at.casimir().squared() - Wide::ONE).to_f64());
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "It is (31) with β = π/2 − α and the sign of the momentum reversed.",
};

const NODE_ANGLE: Statement = Statement {
    id: "spin_node_angle",
    place: PLACE,
    says: "r = [cos λ (h3, 0, −h1) + (sin λ/G)(−h1 h2, ρ², −h2 h3)]/ρ, ρ² = h1² + h3², with λ' = G/(2(cos²β + k² sin²β)) > 0: regular at poles and equator; r2 = ρ sin λ/G.",
    method: "r' against ω × r at random instants, by difference quotients",
    shape: Shape::Direct,
    forms: &["derived here", "λ' = G/(cos²β + k² sin²β)", "cos²β + sin²β/k² below", "λ reversed"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Instant::all(502) {
            let k2 = at.k * at.k;
            let rate = match form {
                1 => wide(2.0) * at.node_rate(),
                2 => at.casimir() / (wide(2.0) * (at.cosine.squared() + at.sine.squared() / k2)),
                3 => -at.node_rate(),
                _ => at.node_rate(),
            };
            let found = slopes(|s| Instant { lambda: at.lambda + s * rate, ..at.moved(s) }.position(), Wide::ZERO);
            let expected = cross(at.velocity(), at.position());
            let size = at.casimir() + dot(at.velocity(), at.velocity()).sqrt() + at.node_rate();
            (0..3).for_each(|i| worst.see(((found[i] - expected[i]) / size).to_f64()));
        }
        Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
    },
    note: "So the n-th return to the equator is λ = nπ.",
};

const SCALAR: Statement = Statement {
    id: "spin_conjugate_scalar",
    place: PLACE,
    says: "The Jacobi field is parallel to h, and −r·δh = (2k/(Gρ)) (B sin λ − A cos λ), A = 2G δβ, B = G² δβ' − p_θ β'.",
    method: "both sides at random instants and variations",
    shape: Shape::Direct,
    forms: &["derived here", "A = G δβ", "the sign of p_θ β'", "without p_θ β'"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Instant::all(503) {
            let (sine, cosine) = at.lambda.sin_cos();
            let (a, b) = at.a_and_b(form);
            let rho = wide(2.0) * at.ellipse().sqrt();
            let factor = wide(2.0) * at.k / (at.casimir() * rho);
            let left = -dot(at.position(), at.momentum_variation());
            let size = factor * (a.abs() + b.abs());
            worst.see(((left - factor * (b * sine - a * cosine)) / size).to_f64());
        }
        Ok(worst.at_most(ALGEBRA, reason(ALGEBRA)))
    },
    note: "",
};

const PHASE_RATE: Statement = Statement {
    id: "spin_phase_rate",
    place: PLACE,
    says: "Θ = λ − arg(B + iA) has Θ' = 2G³ P δβ²/(k² (A² + B²)) ≥ 0, P = cos²β + k² sin²β: it never decreases.",
    method: "the derivative of Θ along the flow by difference quotients at random instants and variations",
    shape: Shape::Direct,
    forms: &["derived here", "A = G δβ", "the sign of p_θ β'", "without p_θ β'", "without k² below", "G²"],
    examine: |form| {
        let mut worst = Worst::default();
        for at in Instant::all(504) {
            let (a, b) = at.a_and_b(form);
            let phase = |s: Wide| {
                let after = at.moved(s);
                let (a1, b1) = after.a_and_b(form);
                after.lambda - (a1 * b - b1 * a).atan2(b1 * b + a1 * a)
            };
            let g = at.casimir();
            let power = if form == 5 { g * g } else { g * g * g };
            let k2 = if form == 4 { Wide::ONE } else { at.k * at.k };
            let printed = wide(2.0) * power * at.ellipse() * at.delta.squared() / (k2 * (a * a + b * b));
            let size = at.node_rate().max(printed);
            let [found] = slopes(|s| [phase(s)], Wide::ZERO);
            worst.see(((found - printed) / size).to_f64());
        }
        Ok(worst
            .at_most(1e-12, "difference quotients in double-double, of angles that turn up to 1e4 times as fast as Θ"))
    },
    note: "Hence: the first conjugate time is the only solution of Θ = π, zeros of the Jacobi field are simple, or triple where δβ = 0 with λ = nπ, and never double.",
};

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

#[cfg(test)]
mod tests {
    #[test]
    fn statements_stand_and_wrong_forms_are_refused() {
        crate::effects::statements::spin_points::expected::stand(super::ALL, &[]);
    }
}
