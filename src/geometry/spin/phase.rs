//! The state of an extremal and of its Jacobi field at one instant, in closed form.
//!
//! Not in the article; derived for this program (the derivation belongs to the article page). With β the pendulum of
//! `extremal`, `δβ = ∂β/∂p` and `P = cos²β + k² sin²β`:
//!
//! ```text
//! λ(t) = (G/2) ∫₀ᵗ dt/P                        the angle of r about h; λ = nπ at the n-th return to the equator
//! A = 2G δβ,   B_q = G² δβ' − p β'             r·δh = 0  ⇔  A cos λ = B_q sin λ
//! χ = arg(B_q + iA), continuous from χ(0) = 0
//! Θ = λ − χ,   Θ' = (G/2k²) P sin²χ ≥ 0        j-th conjugate time: Θ = jπ
//! ```
//!
//! The second form of Θ' follows from `2G³ P δβ²/(k²(A² + B_q²))` by `A = 2Gδβ`. All elliptic pieces are
//! `F`, `Z = ∫(nd² − 1) = (m/3) s³ R_D(c², 1, d²)` and `Π = F + (N/3) s³ R_J(c², d², 1, c² + (1−N)s²)`, sums of positive
//! terms; with `Y` and `V` below nothing is divided by `m'`, so that the separatrix is no special place:
//! `∫nd² = F + Z`, `∫dn² = m'(F + Z) + m s c/d`; oscillating: `δβ = (s/d − cZ)/(2kw)`, `δβ' = (c + s d Z)/(2k)`.
//!
//! Source of the integrals: B. C. Carlson, Numer. Algorithms 10 (1995) 13-26; DLMF 19.25.

use super::extremal::{Elliptic, Extremal, Regime};
use super::landen::Amplitude;
use crate::numerics::elliptic::carlson::{r_d, r_f, r_j};
use crate::numerics::real::Real;

/// An extremal at one instant.
#[derive(Debug, Clone, Copy)]
pub struct State<S> {
    /// The time.
    pub t: S,
    /// The angle λ of the point about the momentum.
    pub lambda: S,
    /// `sin β = h1/(2k)`.
    pub sin_beta: S,
    /// `cos β = h3/2`.
    pub cos_beta: S,
    /// `β' = −h2/(2k)`.
    pub beta_rate: S,
    /// A positive multiple of `A = 2G δβ`.
    pub a: S,
    /// The same multiple of `B_q = G² δβ' − p β'`.
    pub b_q: S,
    /// `χ = arg(B_q + iA)`, continuous from zero.
    pub chi: S,
    /// `Θ = λ − χ`.
    pub phase: S,
    /// `δβ = ∂β/∂p_θ`.
    pub delta_beta: S,
    /// `δβ' = ∂β'/∂p_θ`.
    pub delta_beta_rate: S,
    /// Carlson functions called.
    pub elliptic_calls: u32,
}

impl<S: Real> State<S> {
    /// `dΘ/dt = (G/2k²) P sin²χ`.
    pub fn phase_rate(&self, extremal: &Extremal<S>) -> S {
        let square = self.a * self.a / (self.a * self.a + self.b_q * self.b_q);
        let scale = extremal.casimir / (S::from_f64(2.0) * extremal.k * extremal.k);
        scale * extremal.ellipse(self.sin_beta, self.cos_beta) * square
    }

    /// The momentum `h = (2k sin β, −2k β', 2 cos β)`.
    pub fn momentum(&self, k: S) -> [S; 3] {
        let two = S::from_f64(2.0);
        [two * k * self.sin_beta, -(two * k * self.beta_rate), two * self.cos_beta]
    }
}

/// The phase at a whole number of quarter turns, where only complete integrals are needed.
#[derive(Debug, Clone, Copy)]
pub struct QuarterPhase<S> {
    /// Θ.
    pub phase: S,
    /// dΘ/dt.
    pub phase_rate: S,
    /// dλ/dt.
    pub lambda_rate: S,
}

impl<S: Real> Extremal<S> {
    /// The state near time `t ≥ 0`: exactly at `t` in the elementary regimes; else at the time, returned in the state,
    /// of an amplitude that differs from that of `t` by a few rounding errors.
    pub fn state_near(&self, t: S) -> State<S> {
        match &self.elliptic {
            Some(elliptic) => {
                self.state_at_amplitude(elliptic, elliptic.landen.amplitude(self.rate * t, elliptic.quarter))
            }
            None => self.elementary_state(t),
        }
    }

    fn elementary_state(&self, t: S) -> State<S> {
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let (k, g) = (self.k, self.casimir);
        let u = self.rate * t;
        let (lambda, sin_beta, cos_beta, beta_rate, a, b_q, delta_beta, delta_beta_rate);
        match self.regime {
            Regime::Meridian => {
                // A : B_q = tanh(lt)/l : 1
                lambda = t;
                (sin_beta, cos_beta, beta_rate) = (S::ZERO, one, S::ZERO);
                a = u.tanh() / self.rate;
                b_q = one;
                delta_beta = u.sinh() / (two * k * self.rate);
                delta_beta_rate = u.cosh() / (two * k);
            }
            Regime::Separatrix => {
                // s = tanh u, c = sech u; A and B_q are multiplied by 2kc.
                let s = u.tanh();
                let c = one / u.cosh();
                let w = self.rate;
                lambda = t / k + (k * w * s).atan();
                (sin_beta, cos_beta, beta_rate) = (s, c, w * c);
                a = g * (c * c * u + s) / w;
                b_q = g * g * (one + c * c - s * c * c * u) / two - two * k * self.p * w * c * c;
                delta_beta = (c * u + s / c) / (S::from_f64(4.0) * k * w);
                delta_beta_rate = ((one + c * c) / c - s * c * u) / (S::from_f64(4.0) * k);
            }
            _ => {
                // k = 1: tan Θ-equation tan u = u, u = Gt/2.
                lambda = u;
                (sin_beta, cos_beta) = (self.b * t).sin_cos();
                beta_rate = self.b;
                a = u;
                b_q = one;
                delta_beta = t / two;
                delta_beta_rate = one / two;
            }
        }
        let chi = a.atan2(b_q);
        State {
            t,
            lambda,
            sin_beta,
            cos_beta,
            beta_rate,
            a,
            b_q,
            chi,
            phase: lambda - chi,
            delta_beta,
            delta_beta_rate,
            elliptic_calls: 0,
        }
    }

    fn state_at_amplitude(&self, elliptic: &Elliptic<S>, amplitude: Amplitude<S>) -> State<S> {
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let third = one / S::from_f64(3.0);
        let (k, p, g, b) = (self.k, self.p, self.casimir, self.b);
        let (m, complementary) = (elliptic.m, elliptic.complementary);
        let Amplitude { half_turns, sign, sine: s, cosine: c } = amplitude;
        let turns = half_turns + half_turns;
        let (c2, s2) = (c * c, s * s);
        let d2 = c2 + complementary * s2;
        let d = d2.sqrt();
        let cubed = s * s2;
        let f = s * r_f(c2, d2, one);
        let u = f + turns * elliptic.quarter;
        let z = m * third * cubed * r_d(c2, one, d2) + turns * elliptic.quarter_z;
        let pi = f + elliptic.n * third * cubed * r_j(c2, d2, one, c2 + elliptic.one_minus_n * s2);
        let secular = self.secular_lambda(elliptic, f, pi) + turns * elliptic.quarter_lambda;
        let t = u / self.rate;
        let (lambda, sin_beta, cos_beta, beta_rate, a, b_q, chi, delta_beta, delta_beta_rate);
        match self.regime {
            Regime::RotatingBelow => {
                let l = self.anisotropy;
                let (l2, inverse) = (l * l, one / self.rate);
                let second = complementary * (u + z) + m * s * c / d;
                lambda = secular;
                (sin_beta, cos_beta, beta_rate) = (sign * b * inverse * s / d, sign * c / d, b / d);
                a = (one + inverse * inverse).sqrt() * second / k;
                b_q = d2 + l2 * (c2 + (one + inverse * inverse) * second * s * c / d);
                chi = a.atan2(b_q);
                delta_beta = second / (two * k * self.rate * d);
                delta_beta_rate = (d + m * second * s * c / d2) / (two * k);
            }
            Regime::RotatingAbove => {
                let w2 = self.anisotropy * self.anisotropy;
                let k2 = k * k;
                let x = u + z;
                lambda = secular + (w2 * k * (g / p) * s * c / d).atan();
                (sin_beta, cos_beta, beta_rate) = (sign * s, sign * c, b * d);
                a = (g / p) * d2 * x / k;
                b_q = s2 + c2 / k2 - (w2 + m / k2) * s * c * d * x;
                chi = a.atan2(b_q);
                delta_beta = d * x / p;
                delta_beta_rate = (one / d - m * s * c * x) / (two * k);
            }
            _ => {
                let w = self.rate;
                let y = s / d - c * z;
                let v = c + s * d * z;
                lambda = secular + (p * p * s * c / (two * w * g * d)).atan();
                (sin_beta, cos_beta, beta_rate) = (sign * b / w * s, d, sign * b * c);
                a = sign * g * y / (k * w);
                b_q = sign * (two * c / k + g * g / (two * k) * s * d * z);
                chi = half_turns * S::PI + continuous_angle(sign * a, sign * b_q, s, c);
                delta_beta = sign * y / (two * k * w);
                delta_beta_rate = sign * v / (two * k);
            }
        }
        State {
            t,
            lambda,
            sin_beta,
            cos_beta,
            beta_rate,
            a,
            b_q,
            chi,
            phase: lambda - chi,
            delta_beta,
            delta_beta_rate,
            elliptic_calls: 3,
        }
    }

    /// Θ and Θ' after `n` quarter turns (`u = nK`); `None` in the elementary regimes, which have no quarter turns.
    pub fn quarter_phase(&self, n: S) -> Option<QuarterPhase<S>> {
        let elliptic = self.elliptic.as_ref()?;
        let (one, two) = (S::ONE, S::from_f64(2.0));
        let (k, g) = (self.k, self.casimir);
        let half = (n / two).floor();
        let even = n - two * half < S::from_f64(0.5);
        let (m, complementary) = (elliptic.m, elliptic.complementary);
        let d = complementary.sqrt();
        let z = n * elliptic.quarter_z;
        let x = n * (elliptic.quarter + elliptic.quarter_z);
        let k2 = k * k;
        let (a, b_q, ellipse);
        match self.regime {
            Regime::RotatingBelow => {
                let inverse = one / self.rate;
                a = (one + inverse * inverse).sqrt() * complementary * x / k;
                b_q = if even { one + self.anisotropy * self.anisotropy } else { complementary };
                ellipse = if even { one } else { k2 };
            }
            Regime::RotatingAbove => {
                a = (g / self.p) * if even { x } else { complementary * x } / k;
                b_q = if even { one / k2 } else { one };
                ellipse = if even { one } else { k2 };
            }
            _ => {
                a = g / (k * self.rate) * if even { -z } else { one / d };
                b_q = if even { two / k } else { g * g / (two * k) * d * z };
                ellipse = if even { one } else { one + (k2 - one) * m };
            }
        }
        let turns = if self.regime == Regime::Oscillating { half * S::PI } else { S::ZERO };
        let chi = turns + a.atan2(b_q);
        let square = a * a / (a * a + b_q * b_q);
        let phase_rate = g / (two * k2) * ellipse * square;
        Some(QuarterPhase { phase: n * elliptic.quarter_lambda - chi, phase_rate, lambda_rate: g / (two * ellipse) })
    }
}

/// The angle of `(b_q, a)` that differs by less than π from `φ = atan2(s, c)`, `|φ| ≤ π/2`.
fn continuous_angle<S: Real>(a: S, b_q: S, s: S, c: S) -> S {
    let angle = a.atan2(b_q);
    let half = S::PI / S::from_f64(2.0);
    let ahead = a * c - b_q * s;
    if angle > half && ahead < S::ZERO {
        angle - (S::PI + S::PI)
    } else if angle < -half && ahead > S::ZERO {
        angle + (S::PI + S::PI)
    } else {
        angle
    }
}
