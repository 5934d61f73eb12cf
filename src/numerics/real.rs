//! The scalar that every formula of this crate is written over.
//!
//! A formula that is generic over [`Real`] runs unchanged in `f64` and in any longer format that implements the trait.
//! Every operation is either IEEE-exact (`+ − × ÷ √`, comparison, `abs`, `floor`) or comes from the pure-Rust `libm`
//! crate: the platform's own `sin`, `exp`, … never reach a result, so that results have the same bits everywhere.

use super::double_double::{two_product, two_sum};
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real scalar with the elementary functions that the formulas of this crate need.
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + PartialOrd
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// π rounded to this scalar.
    const PI: Self;
    /// The distance from one to the next larger number.
    const EPSILON: Self;
    /// `EPSILON^(1/8)`, rounded down: where a series truncated after degree 7 has reached full accuracy.
    const EPSILON_ROOT_8: Self;

    /// The nearest scalar to a literal (exact for scalars at least as long as `f64`).
    fn from_f64(x: f64) -> Self;
    /// Rounds to the nearest `f64`.
    fn to_f64(self) -> f64;
    /// Square root, correctly rounded in `f64`.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The largest integer that is not larger.
    fn floor(self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// `ln(1 + x)`, accurate near zero.
    fn ln_1p(self) -> Self;
    /// `exp(x) − 1`, accurate near zero.
    fn exp_m1(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// The angle in `(−π, π]` whose tangent is `self / x`, in the quadrant of `(x, self)`.
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Inverse hyperbolic sine.
    fn asinh(self) -> Self;

    /// The rounded product, and what rounding took from it: with both a difference of products can be taken before it is rounded. Zero
    /// where the scalar has digits to spare, and where the parts leave its range.
    fn product_and_rest(self, other: Self) -> (Self, Self) {
        (self * other, Self::ZERO)
    }
    /// The same of a difference.
    fn difference_and_rest(self, other: Self) -> (Self, Self) {
        (self - other, Self::ZERO)
    }

    /// Sine.
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine.
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// Tangent.
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }
    /// Arc tangent in `(−π/2, π/2)`.
    fn atan(self) -> Self {
        self.atan2(Self::ONE)
    }
    /// The smaller of two.
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    /// The larger of two.
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    /// The square.
    #[inline]
    fn squared(self) -> Self {
        self * self
    }
    /// Whether it is neither infinite nor "not a number".
    #[inline]
    fn is_finite(self) -> bool {
        self.to_f64().is_finite()
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const PI: Self = std::f64::consts::PI;
    const EPSILON: Self = f64::EPSILON;
    /// 2^(−52/8) = 2^−6.5 = 0.01104…
    const EPSILON_ROOT_8: Self = 0.011;

    #[inline]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline]
    fn floor(self) -> Self {
        f64::floor(self)
    }
    fn product_and_rest(self, other: Self) -> (Self, Self) {
        let (product, rest) = two_product(self, other);
        if rest.is_finite() { (product, rest) } else { (self * other, 0.0) }
    }
    fn difference_and_rest(self, other: Self) -> (Self, Self) {
        let (difference, rest) = two_sum(self, -other);
        if rest.is_finite() { (difference, rest) } else { (self - other, 0.0) }
    }
    fn exp(self) -> Self {
        libm::exp(self)
    }
    fn ln(self) -> Self {
        libm::log(self)
    }
    fn ln_1p(self) -> Self {
        libm::log1p(self)
    }
    fn exp_m1(self) -> Self {
        libm::expm1(self)
    }
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    fn sinh(self) -> Self {
        libm::sinh(self)
    }
    fn cosh(self) -> Self {
        libm::cosh(self)
    }
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    fn asinh(self) -> Self {
        libm::asinh(self)
    }
}
