//! Packs of numbers: one formula for one number or for eight beside each other.
//!
//! A formula that is generic over [`Pack`] has no branch on a value. Where members of a pack would go different ways, both
//! ways are computed and [`Pack::select`] takes, member by member, what each would have taken alone; a loop goes on while
//! any member needs it, and the others keep what they have. So a member's result has the same bits alone (every [`Real`] is
//! a pack of one), in any place of a pack, and beside any others.
//!
//! Operations are IEEE-exact or, member by member, those of [`Real`]. Not known here: which instructions carry them out
//! ([`crate::numerics::lanes`]).

use crate::numerics::real::Real;
use crate::numerics::rough::{rough_exp2, rough_log2};
use crate::numerics::taylor::flow::Algebra;
use std::fmt::Debug;
use std::ops::{AddAssign, DivAssign, MulAssign, SubAssign};

/// One truth value for each member of a pack.
pub trait Mask: Copy + Debug {
    /// The same for all members.
    fn splat(value: bool) -> Self;
    /// Member `index` set to `member(index)`.
    fn from_lanes(member: impl FnMut(usize) -> bool) -> Self;
    /// Whether it is true of any member.
    fn any(self) -> bool;
    /// Whether it is true of every member.
    fn all(self) -> bool;
    /// Of member `index`.
    fn lane(self, index: usize) -> bool;
    /// Both.
    fn and(self, other: Self) -> Self;
    /// At least one of both.
    fn or(self, other: Self) -> Self;
    /// The opposite.
    fn not(self) -> Self;
}

impl Mask for bool {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        value
    }
    #[inline(always)]
    fn from_lanes(mut member: impl FnMut(usize) -> bool) -> Self {
        member(0)
    }
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
    #[inline(always)]
    fn all(self) -> bool {
        self
    }
    #[inline(always)]
    fn lane(self, _: usize) -> bool {
        self
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }
    #[inline(always)]
    fn not(self) -> Self {
        !self
    }
}

/// A number, or several of one kind beside each other.
pub trait Pack: Algebra + Debug + AddAssign + SubAssign + MulAssign + DivAssign {
    /// What a member is.
    type Scalar: Real;
    /// A truth value for each member.
    type Mask: Mask;
    /// Number of members.
    const WIDTH: usize;
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// π rounded to the scalar.
    const PI: Self;
    /// [`Real::EPSILON`].
    const EPSILON: Self;
    /// [`Real::EPSILON_ROOT_8`].
    const EPSILON_ROOT_8: Self;

    /// All members set to one scalar.
    fn splat(value: Self::Scalar) -> Self;
    /// Member `index` set to `member(index)`, in order.
    fn from_lanes(member: impl FnMut(usize) -> Self::Scalar) -> Self;
    /// Member `index < WIDTH`.
    fn lane(self, index: usize) -> Self::Scalar;
    /// The pack with one member changed.
    fn with_lane(self, index: usize, value: Self::Scalar) -> Self;
    /// A function of each member.
    fn map(self, function: impl FnMut(Self::Scalar) -> Self::Scalar) -> Self;

    /// Square root.
    fn sqrt(self) -> Self;
    /// The largest integer that is not larger.
    fn floor(self) -> Self;
    /// `self < other`; false where one is not a number.
    fn less(self, other: Self) -> Self::Mask;
    /// `self ≤ other`; false where one is not a number.
    fn at_most(self, other: Self) -> Self::Mask;
    /// `self = other`; false where one is not a number.
    fn equals(self, other: Self) -> Self::Mask;
    /// `yes` where the mask is true, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// The smaller: `self` where `self < other`, else `other`.
    fn smaller(self, other: Self) -> Self;

    /// A literal.
    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self::number(x)
    }
    /// `self > other`; false where one is not a number.
    #[inline(always)]
    fn more(self, other: Self) -> Self::Mask {
        other.less(self)
    }
    /// `self ≥ other`; false where one is not a number.
    #[inline(always)]
    fn at_least(self, other: Self) -> Self::Mask {
        other.at_most(self)
    }
    /// Absolute value.
    #[inline(always)]
    fn abs(self) -> Self {
        self.size()
    }
    /// The larger: `self` where `self > other`, else `other`.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.larger(other)
    }
    /// The smaller: `self` where `self < other`, else `other`.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.smaller(other)
    }
    /// The square.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
    /// [`crate::numerics::rough::rough_log2`] of each member.
    #[inline(always)]
    fn rough_log2(self) -> Self {
        self.map(|x| <Self::Scalar as Real>::from_f64(rough_log2(Real::to_f64(x))))
    }
    /// [`crate::numerics::rough::rough_exp2`] of each member.
    #[inline(always)]
    fn rough_exp2(self) -> Self {
        self.map(|x| <Self::Scalar as Real>::from_f64(rough_exp2(Real::to_f64(x))))
    }
    /// Sine and cosine.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let mut cosine = Self::ZERO;
        let sine = Self::from_lanes(|i| {
            let (s, c) = Real::sin_cos(self.lane(i));
            cosine = cosine.with_lane(i, c);
            s
        });
        (sine, cosine)
    }
    /// The angle in `(−π, π]` of the point `(x, self)`.
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::from_lanes(|i| Real::atan2(self.lane(i), x.lane(i)))
    }
    /// Arc tangent.
    #[inline(always)]
    fn atan(self) -> Self {
        self.map(Real::atan)
    }
    /// Hyperbolic sine.
    #[inline(always)]
    fn sinh(self) -> Self {
        self.map(Real::sinh)
    }
    /// Hyperbolic cosine.
    #[inline(always)]
    fn cosh(self) -> Self {
        self.map(Real::cosh)
    }
    /// Hyperbolic tangent.
    #[inline(always)]
    fn tanh(self) -> Self {
        self.map(Real::tanh)
    }
    /// Inverse hyperbolic sine.
    #[inline(always)]
    fn asinh(self) -> Self {
        self.map(Real::asinh)
    }
}

/// Every real scalar is a pack of one.
impl<S: Real> Pack for S {
    type Scalar = S;
    type Mask = bool;
    const WIDTH: usize = 1;
    const ZERO: Self = <S as Real>::ZERO;
    const ONE: Self = <S as Real>::ONE;
    const PI: Self = <S as Real>::PI;
    const EPSILON: Self = <S as Real>::EPSILON;
    const EPSILON_ROOT_8: Self = <S as Real>::EPSILON_ROOT_8;

    #[inline(always)]
    fn splat(value: S) -> Self {
        value
    }
    #[inline(always)]
    fn from_lanes(mut member: impl FnMut(usize) -> S) -> Self {
        member(0)
    }
    #[inline(always)]
    fn lane(self, _: usize) -> S {
        self
    }
    #[inline(always)]
    fn with_lane(self, _: usize, value: S) -> Self {
        value
    }
    #[inline(always)]
    fn map(self, mut function: impl FnMut(S) -> S) -> Self {
        function(self)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        <S as Real>::sqrt(self)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        <S as Real>::floor(self)
    }
    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }
    #[inline(always)]
    fn equals(self, other: Self) -> bool {
        self == other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        <S as Real>::min(self, other)
    }
}
