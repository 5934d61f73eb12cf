//! A start as it is solved: the constants of its extremal, and starts beyond the range of the arithmetic by their limits.
//!
//! Three limits of the first conjugate and cut points are reached to far below rounding before numbers leave their range:
//!
//! - `p_θ → ∞`: `p t1`, `p r2` and `p² r3` tend to functions of k, with relative corrections of order `(max(1, k)/p)²`;
//! - `k → 0`, `p_θ ≠ 0`: `t1/k`, `r2/k` and `r3/k` tend to functions of `p_θ`, with relative corrections of order `t1²` (β reaches π/2,
//!   where the ellipse `cos²β + k² sin²β` is smallest, at `t1`; times and coordinates are those of a rotation about the first axis);
//! - `k → ∞` with `p_θ/k` constant and above 4: `t1` and the point tend to functions of `p_θ/k`, with corrections of order `1/k²`.
//!
//! There a start is replaced by one further inside, and the result is multiplied by a power of two.

use super::extremal::Extremal;
use super::start::Start;
use crate::numerics::real::Real;

/// What the members of a result are to be multiplied by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    /// The time, and r2.
    pub(super) time: f64,
    /// r3.
    pub(super) along: f64,
}

impl Scale {
    /// By one.
    pub(super) const NONE: Self = Self { time: 1.0, along: 1.0 };
}

/// Where the limits take over.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Largest `p/max(1, k)`.
    momentum: f64,
    /// Smallest k, for `p ≠ 0`.
    k: f64,
    /// Largest k, for `p > 4k`.
    large_k: f64,
    /// Largest k at all.
    any_k: f64,
}

impl Limits {
    /// An argument `u` known to ε cannot come nearer to the quarter period than ε, and the transition there is k wide.
    const SMALLEST_K: f64 = 1e-12;
    /// In a transition 1/k wide (k large) the same holds, and χ is known to kε only.
    const LARGE_K: f64 = 1e12;
    /// For results in `f64`: its range of numbers is enough for every `p`; for larger k the point is not told.
    pub(super) const F64: Self =
        Self { momentum: f64::INFINITY, k: Self::SMALLEST_K, large_k: Self::LARGE_K, any_k: 1e7 };
    /// For double-double: squares of much larger numbers leave its range.
    pub(super) const DOUBLE_DOUBLE: Self =
        Self { momentum: 1e30, k: Self::SMALLEST_K, large_k: Self::LARGE_K, any_k: f64::INFINITY };
    /// For positions and conjugate times after any time, which know the first limit only.
    pub(super) const POSITION: Self = Self { momentum: 1e30, k: 0.0, large_k: f64::INFINITY, any_k: f64::INFINITY };

    /// Whether a start lies inside.
    pub(super) fn hold(&self, start: &Start) -> bool {
        let (k, p) = (start.k(), start.p_theta().abs());
        (k >= self.k || p == 0.0) && p <= self.momentum * k.max(1.0) && !self.is_beyond(start)
    }

    /// Whether k is too large for this arithmetic.
    pub(super) fn is_beyond(&self, start: &Start) -> bool {
        start.k() > self.any_k
    }
}

/// A start as it is solved.
#[derive(Debug, Clone, Copy)]
pub(super) struct Posed<S: Real> {
    /// The constants.
    pub(super) extremal: Extremal<S>,
    /// What its results are to be multiplied by.
    pub(super) scale: Scale,
    /// −1 for `p_θ < 0`, else 1.
    pub(super) mirror: S,
}

impl<S: Real> Posed<S> {
    /// The start itself, or one at the limits.
    pub(super) fn new(start: &Start, limits: Limits) -> Self {
        let (mut k, mut p) = (start.k(), start.p_theta().abs());
        let mut scale = Scale::NONE;
        if k < limits.k && p > 0.0 {
            let factor = power_of_two(limits.k, k);
            k *= factor;
            scale = Scale { time: 1.0 / factor, along: 1.0 / factor };
        }
        if k > limits.large_k && p > 4.0 * k {
            let factor = power_of_two(limits.large_k, k);
            k *= factor;
            p *= factor;
        }
        let largest = limits.momentum * k.max(1.0);
        if p > largest {
            let factor = power_of_two(largest, p);
            p *= factor;
            scale = Scale { time: scale.time * factor, along: scale.along * factor * factor };
        }
        let extremal = Extremal::new(S::from_f64(k), S::from_f64(p));
        Self { extremal, scale, mirror: S::from_f64(start.mirror()) }
    }
}

/// A power of two near `target/x`.
fn power_of_two(target: f64, x: f64) -> f64 {
    libm::exp2(f64::from(libm::ilogb(target) - libm::ilogb(x)))
}
