//! Beyond the article: the first conjugate time of the spin problem in closed form, and why no root can be skipped.
//!
//! Statement. Put `h = (2k sin β, −2k β', 2 cos β)`; then `β'² = b² − w² sin²β`, `β(0) = 0`, `b = p_θ/(2k)`, `w² = 1 − 1/k²`. With `P = cos²β + k² sin²β`,
//! `λ' = G/(2P)`, `A = 2G δβ`, `B = G² δβ' − p_θ β'` (δ = ∂/∂p_θ), conjugate points are where `A cos λ = B sin λ`; the phase
//! `Θ = λ − arg(B + iA)` has `Θ' = 2G³ P δβ²/(k² (A² + B²)) ≥ 0`, so that the j-th conjugate time is the only solution of Θ = jπ.
//! Here the differential identities, at random instants that need no closed form; the Jacobi functions are in `spin_closed_form_regimes`, what
//! follows for conjugate times, against integration, in `spin_conjugate_times`.

use super::differences::{Wide, slopes_of_order_2, wide};
use super::spin_points::{ALGEBRA, POINTS, QUOTIENT, anisotropy, cross, dot, reason};
use super::statement::{Form, Samples, Shape, Statement, Unexamined, Worst};
use crate::contract::claim::Test;
use crate::numerics::real::Real;

/// The statements.
pub const ALL: &[Statement] = &[BETA, NODE_ANGLE, SCALAR, PHASE_RATE, ANY_START];

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
            let rates = slopes_of_order_2(
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
            let found =
                slopes_of_order_2(|s| Instant { lambda: at.lambda + s * rate, ..at.moved(s) }.position(), Wide::ZERO);
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
            let [found] = slopes_of_order_2(|s| [phase(s)], Wide::ZERO);
            worst.see(((found - printed) / size).to_f64());
        }
        Ok(worst
            .at_most(1e-12, "difference quotients in double-double, of angles that turn up to 1e4 times as fast as Θ"))
    },
    note: "Hence: the first conjugate time is the only solution of Θ = π, zeros of the Jacobi field are simple, or triple where δβ = 0 with λ = nπ, and never double.",
};

const ANY_START: Statement = Statement {
    id: "spin_phase_for_any_start",
    place: PLACE,
    says: "For every start r0, and every kinetic energy H = Σ h_i²/(2 I_i) with some I_i infinite or none: the angle Θ of r from δh in the plane across h has \
           Θ' = G δh·δω/|δh⊥|² ≥ 0 (ω = ∂H/∂h, δH = 0), so that conjugate times are counted by a monotone phase there too.",
    method: "the derivative of the angle by difference quotients along r' = ω × r, h' = ω × h, δh' = ω × δh + δω × h, at random r, h, δh and moments",
    shape: Shape::Direct,
    forms: &["derived here", "for variations with δH ≠ 0", "G²", "h·δω in the place of δh·δω"],
    examine: any_start,
    note: "",
};

fn any_start(form: Form) -> Result<Test, Unexamined> {
    let (mut samples, mut worst) = (Samples::new(513), Worst::default());
    for index in 0..POINTS {
        // Inverse moments; one of them 0 in every other case, as for the spins.
        let mut inverse: [Wide; 3] = std::array::from_fn(|_| wide(samples.log(0.05, 20.0)));
        if index.is_multiple_of(2) {
            inverse[1] = Wide::ZERO;
        }
        let mut vector = || -> [Wide; 3] { std::array::from_fn(|_| wide(samples.even(-1.0, 1.0))) };
        let (h, any, variation) = (vector(), vector(), vector());
        let omega = |h: [Wide; 3]| -> [Wide; 3] { std::array::from_fn(|i| inverse[i] * h[i]) };
        let (w, g2) = (omega(h), dot(h, h));
        let r = cross(h, any);
        let excess = dot(w, variation) / dot(w, w);
        let delta: [Wide; 3] =
            if form == 1 { variation } else { std::array::from_fn(|i| variation[i] - excess * w[i]) };
        let (turning, twisted) = (cross(w, delta), cross(omega(delta), h));
        let (r_rate, h_rate) = (cross(w, r), cross(w, h));
        let moved =
            |x: [Wide; 3], rate: [Wide; 3], s: Wide| -> [Wide; 3] { std::array::from_fn(|i| x[i] + s * rate[i]) };
        // Sine and cosine, times positive factors, of the angle from δh to r about h.
        let pair = |s: Wide| {
            let (r, h) = (moved(r, r_rate, s), moved(h, h_rate, s));
            let delta = moved(delta, std::array::from_fn(|i| turning[i] + twisted[i]), s);
            let along = dot(delta, h) / dot(h, h);
            let across: [Wide; 3] = std::array::from_fn(|i| delta[i] - along * h[i]);
            (dot(cross(across, r), h) / dot(h, h).sqrt(), dot(across, r))
        };
        let (sine, cosine) = pair(Wide::ZERO);
        let turned = |s: Wide| {
            let (s1, c1) = pair(s);
            [(s1 * cosine - c1 * sine).atan2(c1 * cosine + s1 * sine)]
        };
        let across2 = dot(delta, delta) - dot(delta, h).squared() / g2;
        let product = dot(if form == 3 { h } else { delta }, omega(delta));
        let length = if form == 2 { g2 } else { g2.sqrt() };
        let expected = length * product / across2;
        let size = expected.abs() + dot(w, w).sqrt();
        worst.see(((slopes_of_order_2(turned, Wide::ZERO)[0] - expected) / size).to_f64());
        worst.see(expected.min(Wide::ZERO).to_f64());
    }
    Ok(worst.at_most(QUOTIENT, reason(QUOTIENT)))
}
