//! The inputs of one extremal of the spin problem: the anisotropy `k` and the covector `p_θ` at the equatorial point.
//!
//! Section 5.2 of the article: `φ(0) = π/2`, `θ(0) = 0`, `p_φ(0) = −2`, `H = 1`, one extremal for each real `p_θ`.
//! Both inputs are pure numbers. Nothing is computed here; the constants of motion live in `extremal`.

use thiserror::Error;

/// Smallest `k` accepted: `1/k²` and its products must stay finite.
pub const SMALLEST_K: f64 = 1e-70;
/// Largest `k` accepted: `k²` and its products must stay finite. (Digits are lost long before: see `error` of a result.)
pub const LARGEST_K: f64 = 1e70;
/// Largest `|p_θ|/k` and `|p_θ|` accepted, so that the angular momentum is a finite number.
pub const LARGEST_MOMENTUM: f64 = 1e300;
/// Below this `|p_θ|/√(1−k²)`, for `k < 1`, the square of the complementary modulus leaves the normal numbers, and the
/// extremal is replaced by the meridian `p_θ = 0`.
pub const MERIDIAN_MOMENTUM: f64 = 1e-145;
/// The replacement by the meridian is right to 1e-20 only if the growth `e^(t1 √(1/k²−1))` along it is below 1e120.
pub const SMALLEST_K_NEAR_MERIDIAN: f64 = 0.02;

/// Why two numbers are no start of the spin problem.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum StartError {
    /// `k` is not a finite number.
    #[error("k = {0} is not a finite number")]
    KNotFinite(f64),
    /// `k` is zero or negative.
    #[error("k = {0} must be positive: it is the ratio of two coupling constants")]
    KNotPositive(f64),
    /// `k` is outside the range in which its powers are finite numbers.
    #[error("k = {k} is outside [{SMALLEST_K:e}, {LARGEST_K:e}], where its powers are finite numbers")]
    KOutOfRange {
        /// The value given.
        k: f64,
    },
    /// `p_θ` is not a finite number.
    #[error("p_theta = {0} is not a finite number")]
    MomentumNotFinite(f64),
    /// `p_θ` is so large that the angular momentum overflows.
    #[error(
        "p_theta = {p_theta} is too large for k = {k}: |p_theta| and |p_theta|/k must be at most {LARGEST_MOMENTUM:e}"
    )]
    MomentumTooLarge {
        /// The value given.
        p_theta: f64,
        /// The anisotropy given.
        k: f64,
    },
    /// `p_θ` is not zero, but too close to zero for so small a `k`.
    #[error(
        "p_theta = {p_theta:e} is not zero but too small for k = {k}: below k = {SMALLEST_K_NEAR_MERIDIAN} the growth \
         along the meridian needs p_theta = 0 or |p_theta| > {MERIDIAN_MOMENTUM:e}"
    )]
    MomentumTooSmall {
        /// The value given.
        p_theta: f64,
        /// The anisotropy given.
        k: f64,
    },
}

/// A start of the spin problem: `r(0) = (1, 0, 0)`, `h(0) = (0, −p_θ, 2)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Start {
    k: f64,
    p_theta: f64,
}

impl Start {
    /// Checks the inputs.
    ///
    /// Domain: `k` in `[SMALLEST_K, LARGEST_K]`; `p_θ` any real with `|p_θ|` and `|p_θ|/k` at most
    /// [`LARGEST_MOMENTUM`]. Special cases: `p_θ = 0` is an ordinary start for every `k`; `p_θ < 0` is the mirror
    /// image `θ → −θ`. Errors: [`StartError`] names the value and what is accepted.
    pub fn new(k: f64, p_theta: f64) -> Result<Self, StartError> {
        if !k.is_finite() {
            return Err(StartError::KNotFinite(k));
        }
        if k <= 0.0 {
            return Err(StartError::KNotPositive(k));
        }
        if !(SMALLEST_K..=LARGEST_K).contains(&k) {
            return Err(StartError::KOutOfRange { k });
        }
        if !p_theta.is_finite() {
            return Err(StartError::MomentumNotFinite(p_theta));
        }
        let size = p_theta.abs();
        if size > LARGEST_MOMENTUM || size > LARGEST_MOMENTUM * k {
            return Err(StartError::MomentumTooLarge { p_theta, k });
        }
        if size > 0.0 && k < SMALLEST_K_NEAR_MERIDIAN && size < MERIDIAN_MOMENTUM {
            return Err(StartError::MomentumTooSmall { p_theta, k });
        }
        Ok(Self { k, p_theta })
    }

    /// The anisotropy `k = √(I1/I3)`.
    pub fn k(&self) -> f64 {
        self.k
    }

    /// The covector `p_θ` at the start.
    pub fn p_theta(&self) -> f64 {
        self.p_theta
    }

    /// `−1` if the extremal is the mirror image of one with `p_θ > 0`, else `1`.
    pub fn mirror(&self) -> f64 {
        if self.p_theta < 0.0 { -1.0 } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_outside_the_domain_are_refused_with_their_value() {
        assert_eq!(Start::new(0.0, 1.0), Err(StartError::KNotPositive(0.0)));
        assert_eq!(Start::new(-2.0, 1.0), Err(StartError::KNotPositive(-2.0)));
        assert!(matches!(Start::new(f64::NAN, 1.0), Err(StartError::KNotFinite(_))));
        assert!(matches!(Start::new(f64::INFINITY, 1.0), Err(StartError::KNotFinite(_))));
        assert!(matches!(Start::new(1.0, f64::NAN), Err(StartError::MomentumNotFinite(_))));
        assert_eq!(Start::new(1e-80, 1.0), Err(StartError::KOutOfRange { k: 1e-80 }));
        assert!(matches!(Start::new(1.0, 1e301), Err(StartError::MomentumTooLarge { .. })));
        assert!(matches!(Start::new(0.01, 1e-200), Err(StartError::MomentumTooSmall { .. })));
        assert!(Start::new(0.01, 0.0).is_ok() && Start::new(0.05, 1e-300).is_ok() && Start::new(3.0, -1e8).is_ok());
        let message = Start::new(-2.0, 1.0).unwrap_err().to_string();
        assert!(message.contains("k = -2") && message.contains("positive"), "{message}");
    }
}
