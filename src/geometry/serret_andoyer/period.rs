//! Period and first return of oscillating extremals at arc length (section 3.3.3, Proposition 3.23), and the cut point.
//!
//! `T = 4K(m)/M`; over half a period θ grows by `Δθ(p_θ) = R(p_θ) = p_θ [A T/2 + 2 (B − A)(G²/M) J(K)]`, all terms positive (the
//! printed form is a difference). `R' = T'/(2 p_θ)` (Lemma 3.20), so `R'' = (T'' − T'/p_θ)/(2 p_θ)`.
//!
//! `dK/dm = B(m)/(2m')` with the associate integral `B = (E − m'K)/m`; `d²K/dm²` from Legendre's equation
//! `m m' K'' = K/4 − (1 − 2m) K'`, by its series near `m = 0` where that cancels. Derivatives of `m` and `M` as printed in the proof of
//! Proposition 3.23, which are right.

use super::extremal::clairaut_energies;
use super::metric::Metric;
use super::start::{Branch, Clairaut, Start, StartError};
use crate::geometry::serret_andoyer::extremal::{Extremal, ExtremalClass};
use crate::numerics::elliptic::complete::complete_b;
use crate::numerics::real::Real;

/// Below this parameter `d²K/dm²` is summed as a series: fewer than 40 terms to ε, where the closed form loses `1/m`.
const SERIES_BELOW: f64 = 0.3;

/// Period and first return as functions of `p_θ`, with derivatives by `p_θ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period<S: Real = f64> {
    /// `p_θ`.
    pub p_theta: S,
    /// The period `T = 4K/M` of φ.
    pub period: S,
    /// The half period `T/2`: time between crossings of the equator, and of the cut point.
    pub half_period: S,
    /// The first return `Δθ = R(p_θ)`: growth of θ in half a period.
    pub first_return: S,
    /// `T' < 0`.
    pub period_slope: S,
    /// `R' = T'/(2p_θ) < 0`: the flow is tame.
    pub first_return_slope: S,
    /// `T'' > 0`.
    pub period_bend: S,
    /// `R'' = (T'' − T'/p_θ)/(2p_θ) > 0`.
    pub first_return_bend: S,
}

/// The limits for `p_θ → A^(−1/2)`, the equator. For `p_θ → B^(−1/2)` period and first return are infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquatorLimits<S: Real = f64> {
    /// `T → 2π √(A/((B − A)(C − A)))`.
    pub period: S,
    /// `Δθ → π A/√((B − A)(C − A))`. Remark 3.25 prints `π A √A/…`.
    pub first_return: S,
}

/// The cut point of a start at `(θ, φ) = (0, φ0)`: both branches of one `p_θ` meet there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPoint<S: Real = f64> {
    /// Time, the half period.
    pub t: S,
    /// `θ = Δθ(p_θ)`.
    pub theta: S,
    /// `φ = −φ0`.
    pub phi: S,
}

/// Period, first return and their derivatives for a Clairaut constant.
///
/// Domain: `B^(−1/2) < |p_θ| ≤ A^(−1/2)`, `0 < δ ≤ B/A − 1` (up to rounding); a negative `p_θ` mirrors θ. Guarantee: a few ε times
/// the condition (δ as the input keeps it near 1). Errors: [`StartError`].
pub fn period<S: Real>(metric: &Metric<S>, clairaut: Clairaut<S>) -> Result<Period<S>, StartError> {
    let start = Start::Darboux { phi0: S::ZERO, clairaut, branch: Branch::Ascending };
    let extremal = Extremal::new(metric, start)?;
    if !matches!(extremal.class(), ExtremalClass::Oscillating | ExtremalClass::Equator) {
        let (p_theta, energies) = clairaut_energies(metric, clairaut)?;
        let (p_theta, delta) = (p_theta.to_f64(), energies.to_separatrix.to_f64());
        return Err(StartError::NotOscillating { p_theta, delta });
    }
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    let (two, four) = (S::from_f64(2.0), S::from_f64(4.0));
    let (m, mc, k, speed) = (extremal.m, extremal.mc, extremal.complete_k, extremal.speed);
    let p = extremal.p_x;
    let half_period = two * k / speed;
    let first_return = extremal.x_after(half_period, two * extremal.complete_third_kind());
    // With X3 = C p² − 1: m' = −2(C−A)(C−B)p/((B−A)X3²), M' = M C p/X3, and the two combinations of T''.
    let x3 = extremal.energies.to_minor_axis;
    let scale = (c - a) * (c - b) / (b - a);
    let m_slope = -(two * scale * p / (x3 * x3));
    let speed_slope = speed * c * p / x3;
    let cpp = c * p * p;
    let slopes = two * scale * (S::ONE + S::from_f64(5.0) * cpp) * speed / (x3 * x3 * x3);
    let speeds = (b - a) * c * (S::ONE + two * cpp) / x3;
    let k_slope = complete_b(mc) / (two * mc);
    let period_slope = four / speed * (k_slope * m_slope - k * speed_slope / speed);
    let period_bend = four
        * (k * speeds / (speed * speed * speed)
            + k_slope * slopes / (speed * speed)
            + complete_k_bend(m, mc, k, k_slope) * m_slope * m_slope / speed);
    Ok(Period {
        p_theta: p,
        period: two * half_period,
        half_period,
        first_return,
        period_slope,
        first_return_slope: period_slope / (two * p),
        period_bend,
        first_return_bend: (period_bend - period_slope / p) / (two * p),
    })
}

/// The limits of period and first return on the equator.
pub fn equator_limits<S: Real>(metric: &Metric<S>) -> EquatorLimits<S> {
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    let product = (b - a) * (c - a);
    EquatorLimits { period: (S::PI + S::PI) * (a / product).sqrt(), first_return: S::PI * a / product.sqrt() }
}

/// The cut point of the start `(0, φ0)` for a Clairaut constant: `(Δθ(p_θ), −φ0)` at `t = T/2`.
///
/// Domain: `|φ0| < K(k)/α`, oscillating, `|p_θ| ≤ √μ(φ0)` (where it is the end of the cut locus, the cusp of the conjugate
/// locus). Errors: [`StartError`].
pub fn cut_point<S: Real>(metric: &Metric<S>, phi0: S, clairaut: Clairaut<S>) -> Result<CutPoint<S>, StartError> {
    // The start itself must exist.
    Extremal::new(metric, Start::Darboux { phi0, clairaut, branch: Branch::Ascending })?;
    let period = period(metric, clairaut)?;
    Ok(CutPoint { t: period.half_period, theta: period.first_return, phi: -phi0 })
}

/// `d²K/dm²`.
fn complete_k_bend<S: Real>(m: S, mc: S, k: S, k_slope: S) -> S {
    if m >= S::from_f64(SERIES_BELOW) {
        return (S::from_f64(0.25) * k - (S::ONE - m - m) * k_slope) / (m * mc);
    }
    // K = (π/2) Σ c_n mⁿ, c_n = ((2n−1)!!/(2n)!!)².
    let half = S::from_f64(0.5);
    let mut coefficient = S::ONE;
    let mut power = S::ONE;
    let mut sum = S::ZERO;
    let mut n = S::ONE;
    loop {
        coefficient *= ((n - half) / n).squared();
        if n > S::ONE {
            let term = coefficient * n * (n - S::ONE) * power;
            sum += term;
            if term <= S::EPSILON * S::EPSILON_ROOT_8 * sum {
                return S::PI * half * sum;
            }
            power *= m;
        }
        n += S::ONE;
    }
}

#[cfg(test)]
#[path = "period_tests.rs"]
mod tests;
