//! Limits of the spin problem in which the first conjugate time is the root of an elementary equation.
//!
//! - `p_θ → 0`, `k > 1`: `w tan t = tan(w t)`, `w² = 1 − 1/k²`; `k = 1`: `tan t = t`; `k < 1`: `l tan t = tanh(l t)`,
//!   `l² = 1/k² − 1`. The point is then `r = (cos t, sin t, 0)`: on the meridian of the start.
//! - `p_θ → ∞`: `p_θ t1/(2k) → x`, the first positive root of `tan x = x`; the conjugate locus touches its start.
//! - `k = 1`: `t1 = 2x/√(p_θ² + 4)` for every `p_θ`.
//!
//! These are written down independently of the closed form in `phase` and serve as its oracle. Each equation is solved
//! in the form "phase = π" with a phase that never decreases, so that the root is the first one and no pole is met.

use super::solve::SpinError;
use crate::numerics::real::Real;

/// The first positive root of `tan x = x`, rounded to `f64` (4.493409457909064175…, the first zero of the spherical Bessel function j1).
pub const TANGENT_ROOT: f64 = 4.493_409_457_909_064_2;
/// Newton steps, bisection included, after which the iteration is cut off: enough for bisection alone.
const MOST_STEPS: u32 = 120;

/// `t1` at `k = 1`: `2x/√(p_θ² + 4)`, exactly, with `tan x = x`.
pub fn round_conjugate_time<S: Real>(p_theta: S) -> S {
    let two = S::from_f64(2.0);
    two * S::from_f64(TANGENT_ROOT) / super::extremal::hypotenuse(p_theta.abs(), two)
}

/// The limit of `|p_θ| t1` as `p_θ → ∞`: `2k x` with `tan x = x`.
pub fn large_momentum_coefficient<S: Real>(k: S) -> S {
    S::from_f64(2.0) * k * S::from_f64(TANGENT_ROOT)
}

/// The limit of `t1` as `p_θ → 0` (it is also the value at `p_θ = 0`).
///
/// Domain: `k > 0`. Guarantee: a few ε times the condition number of the equation. Errors: `k` outside its domain.
pub fn meridian_conjugate_time<S: Real>(k: S) -> Result<S, SpinError> {
    let one = S::ONE;
    let half_pi = S::PI / S::from_f64(2.0);
    if !(k > S::ZERO && k.is_finite()) {
        return Err(SpinError::OutOfDomain { what: "k", found: k.to_f64(), accepted: "positive and finite" });
    }
    if k == one {
        return Ok(round_conjugate_time(S::ZERO));
    }
    if k < one {
        let l = ((one - k) * (one + k)).sqrt() / k;
        // t − atan(tanh(lt)/l) = π; the derivative is (1 + l²) tanh²/(l² + tanh²), and below (sin²/k²)/(w² cos² + sin²).
        return Ok(increasing_root(S::PI, S::PI + half_pi, |t| {
            let tanh = (l * t).tanh();
            let (l2, square) = (l * l, tanh * tanh);
            (t - (tanh / l).atan() - S::PI, square * (one + l2) / (l2 + square))
        }));
    }
    let w = ((k - one) * (k + one)).sqrt() / k;
    let short = one / (k * k * (one + w)); // 1 − w
    // The continuous argument of w cos(wt) + i sin(wt) is wt plus an angle below π/2 in size.
    let (low, high) = (half_pi / short, (S::PI + half_pi) / short);
    Ok(increasing_root(low, high, |t| {
        let (s, c) = (w * t).sin_cos();
        let square = w * c * c + s * s;
        let lead = (short * s * c).atan2(square);
        (short * t - lead - S::PI, s * s / (k * k * (w * w * c * c + s * s)))
    }))
}

/// The root of a function that does not decrease on a bracket; `f` returns value and derivative.
fn increasing_root<S: Real>(mut low: S, mut high: S, f: impl Fn(S) -> (S, S)) -> S {
    let half = S::from_f64(0.5);
    let mut t = half * (low + high);
    for _ in 0..MOST_STEPS {
        let (value, slope) = f(t);
        if value == S::ZERO {
            break;
        }
        if value > S::ZERO {
            high = t;
        } else {
            low = t;
        }
        let newton = t - value / slope;
        // Newton's step, unless it leaves the bracket or the derivative vanishes (a triple root is near).
        let next = if newton > low && newton < high { newton } else { half * (low + high) };
        if (next - t).abs() <= S::EPSILON * t {
            t = next;
            break;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::spin::conjugate::{first_conjugate_point, nth_conjugate_time};
    use crate::geometry::spin::start::Start;

    /// Oracle: mpmath 1.3 at 40 digits, roots of the printed limit equations.
    #[test]
    fn meridian_limit_against_mpmath() {
        let table = [
            (0.05, 3.1916135103955632559),
            (0.3, 3.4462853074317107106),
            (0.75, 3.9887815044120587993),
            (0.999, 4.4904213865950008403),
            (1.001, 4.4964126598880527762),
            (1.1, 4.9268324662334651629),
            (1.3, 8.2194727366408812005),
            (2.0, 23.509540510966290362),
            (3.0, 54.955427823850186643),
            (10.0, 626.74576597217735165),
        ];
        for (k, expected) in table {
            let t: f64 = meridian_conjugate_time(k).unwrap();
            assert!((t / expected - 1.0).abs() < 8.0 * f64::EPSILON, "{k}: {t} {expected}");
        }
    }

    /// The elementary equations against the closed form at p_θ = 0 and at p_θ = 1e-9, 400 values of k.
    #[test]
    fn the_closed_form_has_these_limits() {
        for i in 0..400 {
            let k = 0.05 * libm::exp(f64::from(i) / 399.0 * libm::log(100.0));
            let limit: f64 = meridian_conjugate_time(k).unwrap();
            let start = Start::new(k, 0.0).unwrap();
            let point = first_conjugate_point(&start).unwrap();
            assert!((point.t1 / limit - 1.0).abs() <= 2.0 * point.error, "{k}: {} {limit}", point.t1);
            let close = nth_conjugate_time(&Start::new(k, 1e-9).unwrap(), 1).unwrap();
            // The correction is of order p² times a growth that is below 1e7 for k ≥ 0.2.
            if k > 0.2 {
                assert!((close / limit - 1.0).abs() <= 2.0 * point.error + 1e-10, "{k}: {close} {limit}");
            }
            let (sine, cosine) = libm::sincos(point.t1);
            assert!((point.r[0] - cosine).abs() < 1e-13 && (point.r[1] - sine).abs() < 1e-13 && point.r[2] == 0.0);
        }
    }

    #[test]
    fn large_momentum_and_round_case() {
        for k in [0.05, 0.3, 1.0, 1.7, 3.0] {
            let t = nth_conjugate_time(&Start::new(k, 1e9).unwrap(), 1).unwrap();
            assert!((t * 1e9 / large_momentum_coefficient(k) - 1.0).abs() < 8.0 * f64::EPSILON, "{k}");
        }
        for p in [0.0, 1e-6, 0.3, 2.0, 1e5] {
            let exact = round_conjugate_time(p);
            let near = nth_conjugate_time(&Start::new(1.0 + 1e-15, p).unwrap(), 1).unwrap();
            let at = nth_conjugate_time(&Start::new(1.0, p).unwrap(), 1).unwrap();
            assert!((at / exact - 1.0).abs() < 4.0 * f64::EPSILON, "{p}");
            assert!((near / exact - 1.0).abs() < 16.0 * f64::EPSILON, "{p}");
        }
        assert!((libm::tan(TANGENT_ROOT) - TANGENT_ROOT).abs() < 1e-13);
    }
}
