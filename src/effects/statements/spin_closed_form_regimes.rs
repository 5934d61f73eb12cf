//! Beyond the article: the closed form of `spin_closed_form` in Jacobi's functions, regime by regime.
//!
//! Written out here a second time, from the derivation and in its plainest form, not the stable one of `geometry::spin`; in double-double the
//! cancellation does not matter. Each line is held against its definition: β against the pendulum by difference quotients in t, δβ against the derivative
//! of β by p_θ, λ against G/(2P).

use super::differences::{Wide, slopes_of_order_2, wide};
use super::spin_points::{POINTS, QUOTIENT, reason};
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::elliptic::incomplete::incomplete_pi;
use crate::numerics::elliptic::jacobi::{Jacobi, jacobi_epsilon};
use crate::numerics::elliptic::mean::complete_k;
use crate::numerics::real::Real;

/// Which Jacobi functions describe the extremal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Regime {
    /// k < 1: β rotates.
    Below,
    /// k > 1, p_θ > 2√(k² − 1): β rotates.
    Rotating,
    /// k > 1, p_θ < 2√(k² − 1): β oscillates.
    Oscillating,
}

use Regime::{Below, Oscillating, Rotating};

/// An extremal at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    /// sin β.
    pub(super) sine: Wide,
    /// cos β.
    pub(super) cosine: Wide,
    /// β'.
    pub(super) rate: Wide,
    /// ∂β/∂p_θ.
    pub(super) delta: Wide,
    /// ∂β'/∂p_θ.
    pub(super) delta_rate: Wide,
    /// λ.
    pub(super) lambda: Wide,
}

/// The constants of an extremal with k ≠ 1, p_θ > 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Closed {
    k: Wide,
    p: Wide,
    regime: Regime,
    /// The elliptic parameter and its complement.
    m: Wide,
    mc: Wide,
    /// The argument is `scale·t`: c0, b, w.
    scale: Wide,
}

impl Closed {
    /// The constants.
    pub(super) fn new(k: Wide, p: Wide) -> Self {
        let excess = (k - Wide::ONE) * (k + Wide::ONE);
        let (b, four) = (p / (k + k), wide(4.0));
        if k < Wide::ONE {
            let l2 = -excess / (k * k);
            let square = b * b + l2;
            let (m, mc) = (l2 / square, b * b / square);
            return Self { k, p, regime: Below, m, mc, scale: square.sqrt() };
        }
        let (q2, p2) = (four * excess, p * p);
        if p2 > q2 {
            Self { k, p, regime: Rotating, m: q2 / p2, mc: (p2 - q2) / p2, scale: b }
        } else {
            Self { k, p, regime: Oscillating, m: p2 / q2, mc: (q2 - p2) / q2, scale: excess.sqrt() / k }
        }
    }

    /// G.
    pub(super) fn casimir(&self) -> Wide {
        (self.p * self.p + wide(4.0)).sqrt()
    }

    fn jacobi(&self, t: Wide) -> Jacobi<Wide> {
        Jacobi::new(self.scale * t, self.m, self.mc)
    }

    /// `(sin β, cos β, β')`.
    fn pendulum(&self, t: Wide, form: Form) -> [Wide; 3] {
        let Jacobi { sn: s, cn: c, dn: d, .. } = self.jacobi(t);
        let b = self.p / (self.k + self.k);
        let ratio = b / self.scale;
        let [sine, cosine, rate] = match self.regime {
            Below => [ratio * s / d, c / d, b / d],
            Rotating => [s, c, b * d],
            Oscillating => [ratio * s, d, b * c],
        };
        match form {
            1 => [sine, cosine, b],
            2 => [sine * d, cosine, rate],
            3 => [sine, cosine, rate * self.k],
            _ => [sine, cosine, rate],
        }
    }

    /// `(δβ, δβ')`, by `ε(u) = ∫ dn²`.
    fn variation(&self, t: Wide, form: Form) -> [Wide; 2] {
        let Jacobi { sn: s, cn: c, dn: d, .. } = self.jacobi(t);
        let (m, mc, two_k) = (self.m, self.mc, self.k + self.k);
        let epsilon = match form {
            1 => self.scale * t,
            _ => jacobi_epsilon(self.scale * t, m, mc),
        };
        let mc = if form == 2 { Wide::ONE } else { mc };
        let [delta, delta_rate] = match self.regime {
            Below => [epsilon / (two_k * self.scale * d), (d + m * epsilon * s * c / (d * d)) / two_k],
            Rotating => {
                let x = (epsilon - m * s * c / d) / mc;
                [d * x / (two_k * self.scale), (Wide::ONE / d - m * s * c * x) / two_k]
            }
            Oscillating => {
                let integral = (epsilon - self.mc * self.scale * t) / m;
                let y = (s * d - m * c * integral) / mc;
                let v = (c * (d * d - m) + m * s * d * integral) / mc;
                [y / (two_k * self.scale), v / two_k]
            }
        };
        match form {
            2 if self.regime == Below => [delta * self.m, delta_rate],
            3 => [delta, -delta_rate],
            _ => [delta, delta_rate],
        }
    }

    /// λ.
    fn node_angle(&self, t: Wide, form: Form) -> Wide {
        let Jacobi { sn: s, cn: c, dn: d, am } = self.jacobi(t);
        let (k, p, g, m, mc) = (self.k, self.p, self.casimir(), self.m, self.mc);
        let (two, four) = (wide(2.0), wide(4.0));
        let below = match self.regime {
            Below => k * k * mc,
            Rotating => mc / (k * k),
            Oscillating => four * mc / (g * g),
        };
        let below = if form == 2 { mc } else { below };
        let third_kind = incomplete_pi(am, Wide::ONE - below, below, m, mc);
        let third_kind = if form == 1 { -third_kind } else { third_kind };
        let excess = (k - Wide::ONE) * (k + Wide::ONE);
        let tangent = match self.regime {
            Below => Wide::ZERO,
            Rotating => excess * g * s * c / (k * p * d),
            Oscillating => p * p * s * c / (two * self.scale * g * d),
        };
        let arc = if form == 3 { -tangent.atan() } else { tangent.atan() };
        match self.regime {
            Below if form == 3 => two / g * (t + p * p / (two * self.scale) * third_kind),
            Below => two / g * (t + p * p / (four * self.scale) * third_kind),
            Rotating => two / g * t + two * self.scale * mc / g * third_kind + arc,
            Oscillating => g * t / (two * k * k) + two * self.scale * mc / g * third_kind + arc,
        }
    }

    /// The state at t.
    pub(super) fn at(&self, t: Wide) -> State {
        let ([sine, cosine, rate], [delta, delta_rate]) = (self.pendulum(t, 0), self.variation(t, 0));
        State { sine, cosine, rate, delta, delta_rate, lambda: self.node_angle(t, 0) }
    }

    /// `A = 2G δβ`, `B = G² δβ' − p β'`; form 1: A without its 2; form 2: the sign of p β'.
    fn a_and_b(&self, state: &State, form: Form) -> (Wide, Wide) {
        let g = self.casimir();
        let drag = if form == 2 { -(self.p * state.rate) } else { self.p * state.rate };
        let two = if form == 1 { Wide::ONE } else { wide(2.0) };
        (two * g * state.delta, g * g * state.delta_rate - drag)
    }

    /// Θ.
    pub(super) fn phase(&self, t: Wide, form: Form) -> Wide {
        let state = self.at(t);
        let (a, b) = self.a_and_b(&state, form);
        if self.regime != Oscillating {
            return state.lambda - a.atan2(b);
        }
        let at = self.jacobi(t);
        state.lambda - (at.am + (a * at.cn - b * at.sn).atan2(b * at.cn + a * at.sn))
    }

    /// A, B and the amplitude, rounded.
    pub(super) fn argument_and_amplitude(&self, t: Wide) -> (f64, f64, f64) {
        let ([sine, cosine, rate], [delta, delta_rate]) = (self.pendulum(t, 0), self.variation(t, 0));
        let (a, b) = self.a_and_b(&State { sine, cosine, rate, delta, delta_rate, lambda: Wide::ZERO }, 0);
        (a.to_f64(), b.to_f64(), self.jacobi(t).am.to_f64())
    }

    /// Random extremals of a regime, m' from 1e-4 to 1 − 1e-4, each with a time of up to one and a half periods of β.
    fn all(seed: u64, regime: Regime) -> impl Iterator<Item = (Self, Wide)> {
        let mut samples = Samples::new(seed);
        (0..POINTS).map(move |index| {
            let k = wide(if regime == Below { samples.log(0.05, 0.99) } else { samples.log(1.01, 10.0) });
            let mc = match index % 4 {
                2 => wide(samples.log(1e-4, 0.1)),
                3 => Wide::ONE - wide(samples.log(1e-4, 0.1)),
                _ => wide(samples.even(0.05, 0.95)),
            };
            let (m, excess) = (Wide::ONE - mc, ((k - Wide::ONE) * (k + Wide::ONE)).abs());
            let p = wide(2.0)
                * match regime {
                    Below => (excess * mc / m).sqrt(),
                    Rotating => (excess / m).sqrt(),
                    Oscillating => (excess * m).sqrt(),
                };
            let closed = Self::new(k, p);
            let t = wide(samples.even(0.02, 6.0)) * complete_k(closed.mc) / closed.scale;
            (closed, t)
        })
    }
}

/// Random k and p_θ whose first conjugate time integration reaches with all digits.
pub(super) fn random_starts(seed: u64, count: usize) -> impl Iterator<Item = (f64, f64)> {
    let mut samples = Samples::new(seed);
    (0..count).map(move |index| {
        let k = if index % 2 == 0 { samples.log(0.4, 0.995) } else { samples.log(1.005, 2.0) };
        (k, samples.log(0.05, 20.0))
    })
}

fn pendulum(seed: u64, regime: Regime, form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for (closed, t) in Closed::all(seed, regime) {
        let (k, b) = (closed.k, closed.p / (closed.k + closed.k));
        let w2 = (k - Wide::ONE) * (k + Wide::ONE) / (k * k);
        let [sine, cosine, rate] = closed.pendulum(t, form);
        let [sine_rate, cosine_rate] = slopes_of_order_2(
            |t| {
                let [sine, cosine, _] = closed.pendulum(t, form);
                [sine, cosine]
            },
            t,
        );
        let fastest = (b * b + w2.abs()).sqrt();
        worst.see((sine * sine + cosine * cosine - Wide::ONE).to_f64());
        worst.see(((sine_rate - cosine * rate) / fastest).to_f64());
        worst.see(((cosine_rate + sine * rate) / fastest).to_f64());
        worst.see(((rate * rate - b * b + w2 * sine * sine) / (fastest * fastest)).to_f64());
        worst.see(closed.pendulum(Wide::ZERO, form)[0].to_f64());
    }
    Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
}

fn variation(seed: u64, regime: Regime, form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for (closed, t) in Closed::all(seed, regime) {
        let [sine, cosine, _] = closed.pendulum(t, 0);
        // β relative to its value, and β', as functions of p = p_θ (1 + s).
        let turned = |s: Wide| {
            let [s1, c1, rate] = Closed::new(closed.k, closed.p * (Wide::ONE + s)).pendulum(t, 0);
            [(s1 * cosine - c1 * sine).atan2(c1 * cosine + s1 * sine), rate]
        };
        let expected = slopes_of_order_2(turned, Wide::ZERO).map(|slope| slope / closed.p);
        let found = closed.variation(t, form);
        let size = expected[0].abs() + expected[1].abs() / closed.scale;
        worst.see(((found[0] - expected[0]) / size).to_f64());
        worst.see(((found[1] - expected[1]) / (size * closed.scale)).to_f64());
    }
    Ok(worst.at_most(1e-12, "difference quotients in p_θ, which changes m' down to 1e-4"))
}

fn node_angle(seed: u64, regime: Regime, form: Form) -> Result<Test, Unexamined> {
    let mut worst = Worst::default();
    for (closed, t) in Closed::all(seed, regime) {
        let [sine, cosine, _] = closed.pendulum(t, 0);
        let expected = closed.casimir() / (wide(2.0) * (cosine.squared() + (closed.k * sine).squared()));
        let [found] = slopes_of_order_2(|t| [closed.node_angle(t, form)], t);
        worst.see(((found - expected) / expected).to_f64());
        worst.see(closed.node_angle(Wide::ZERO, form).to_f64());
    }
    Ok(worst.at_most(1e-12, "difference quotients of the third kind in double-double"))
}

const PENDULUM: [&str; 4] = ["derived here", "β' uniform", "sin β multiplied by dn", "β' with a factor k"];
const VARIATION: [&str; 4] =
    ["derived here", "u in the place of ε(u)", "a complementary parameter left out", "the sign of δβ'"];
const ANGLE: [&str; 4] = [
    "derived here",
    "the sign of the third kind",
    "the characteristic m",
    "the sign of the arc tangent (a factor 2 for k < 1)",
];
const PENDULUM_METHOD: &str =
    "β'² = b² − w² sin²β and (sin β)' = cos β β' by difference quotients in t, at random k, p_θ, t";
const VARIATION_METHOD: &str =
    "∂β/∂p_θ and ∂β'/∂p_θ by difference quotients in p_θ of the formulas for β, at random k, p_θ, t";
const ANGLE_METHOD: &str = "λ' = G/(2(cos²β + k² sin²β)) by difference quotients in t, λ(0) = 0, at random k, p_θ, t";

/// A statement of this file.
const fn found(
    id: &'static str,
    says: &'static str,
    (method, forms): (&'static str, &'static [&'static str]),
    examine: fn(Form) -> Result<Test, Unexamined>,
) -> Statement {
    Statement {
        id,
        place: "beyond the article, section 4.3",
        says,
        method,
        shape: Shape::Direct,
        forms,
        examine,
        note: "",
    }
}

/// The statements.
pub const ALL: &[Statement] = &[
    found(
        "spin_below_beta",
        "k < 1, c0² = b² + 1/k² − 1, u = c0 t, m' = b²/c0²: sin β = (b/c0) sn/dn, cos β = cn/dn, β' = b/dn.",
        (PENDULUM_METHOD, &PENDULUM),
        |form| pendulum(521, Below, form),
    ),
    found(
        "spin_below_variation",
        "k < 1: δβ = ε(u)/(2k c0 dn), δβ' = (dn + m ε(u) sn cn/dn²)/(2k), ε(u) = ∫dn².",
        (VARIATION_METHOD, &VARIATION),
        |form| variation(522, Below, form),
    ),
    found(
        "spin_below_node_angle",
        "k < 1: λ = (2/G) [t + p_θ²/(4 c0) Π(1 − k² m'; u|m)].",
        (ANGLE_METHOD, &ANGLE),
        |form| node_angle(523, Below, form),
    ),
    found(
        "spin_rotating_beta",
        "k > 1, p_θ > 2√(k² − 1), u = bt, m = 4(k² − 1)/p_θ²: sin β = sn, cos β = cn, β' = b dn.",
        (PENDULUM_METHOD, &PENDULUM),
        |form| pendulum(524, Rotating, form),
    ),
    found(
        "spin_rotating_variation",
        "k > 1, rotating, X = (ε(u) − m sn cn/dn)/m': δβ = dn X/(2kb), δβ' = (1/dn − m sn cn X)/(2k).",
        (VARIATION_METHOD, &VARIATION),
        |form| variation(525, Rotating, form),
    ),
    found(
        "spin_rotating_node_angle",
        "k > 1, rotating: λ = (2/G) t + (2b m'/G) Π(1 − m'/k²; u|m) + arctan((k² − 1) G sn cn/(k p_θ dn)).",
        (ANGLE_METHOD, &ANGLE),
        |form| node_angle(526, Rotating, form),
    ),
    found(
        "spin_oscillating_beta",
        "k > 1, p_θ < 2√(k² − 1), u = wt, m = p_θ²/(4(k² − 1)): sin β = (b/w) sn, cos β = dn, β' = b cn.",
        (PENDULUM_METHOD, &PENDULUM),
        |form| pendulum(527, Oscillating, form),
    ),
    found(
        "spin_oscillating_variation",
        "k > 1, oscillating, C = (ε(u) − m'u)/m: δβ = (sn dn − m cn C)/(2kw m'), δβ' = (cn (dn² − m) + m sn dn C)/(2k m').",
        (VARIATION_METHOD, &VARIATION),
        |form| variation(528, Oscillating, form),
    ),
    found(
        "spin_oscillating_node_angle",
        "k > 1, oscillating: λ = G t/(2k²) + (2w m'/G) Π(1 − 4m'/G²; u|m) + arctan(p_θ² sn cn/(2w G dn)).",
        (ANGLE_METHOD, &ANGLE),
        |form| node_angle(529, Oscillating, form),
    ),
];
