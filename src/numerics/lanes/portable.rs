//! Eight lanes in plain Rust, which the compiler makes AVX2 of ([`super::dispatch`]).

#![cfg(target_arch = "x86_64")]

use crate::numerics::pack::{Mask, Pack};
use crate::numerics::taylor::flow::Algebra;
use std::array::from_fn;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Eight numbers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Portable([f64; 8]);

/// Eight truth values: all bits set, or none.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct PortableMask([u64; 8]);

#[inline(always)]
fn zip(a: Portable, b: Portable, f: impl Fn(f64, f64) -> f64) -> Portable {
    Portable(from_fn(|i| f(a.0[i], b.0[i])))
}

#[inline(always)]
fn compare(a: Portable, b: Portable, f: impl Fn(f64, f64) -> bool) -> PortableMask {
    PortableMask(from_fn(|i| if f(a.0[i], b.0[i]) { u64::MAX } else { 0 }))
}

macro_rules! arithmetic {
    ($($operation:ident $method:ident, $assigning:ident $assign:ident, $symbol:tt;)*) => {$(
        impl $operation for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                zip(self, other, |a, b| a $symbol b)
            }
        }
        impl $assigning for Portable {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    )*};
}

arithmetic! {
    Add add, AddAssign add_assign, +;
    Sub sub, SubAssign sub_assign, -;
    Mul mul, MulAssign mul_assign, *;
    Div div, DivAssign div_assign, /;
}

impl Neg for Portable {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(from_fn(|i| -self.0[i]))
    }
}

impl Mask for PortableMask {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self([if value { u64::MAX } else { 0 }; 8])
    }
    #[inline(always)]
    fn from_lanes(mut member: impl FnMut(usize) -> bool) -> Self {
        Self(from_fn(|i| if member(i) { u64::MAX } else { 0 }))
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0.iter().fold(0, |sum, bits| sum | bits) != 0
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0.iter().fold(u64::MAX, |product, bits| product & bits) == u64::MAX
    }
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        self.0[index] != 0
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(from_fn(|i| !self.0[i]))
    }
}

impl Algebra for Portable {
    #[inline(always)]
    fn number(x: f64) -> Self {
        Self([x; 8])
    }
    #[inline(always)]
    fn size(self) -> Self {
        Self(from_fn(|i| self.0[i].abs()))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        zip(self, other, |a, b| if a > b { a } else { b })
    }
}

impl Pack for Portable {
    type Scalar = f64;
    type Mask = PortableMask;
    const WIDTH: usize = 8;
    const ZERO: Self = Self([0.0; 8]);
    const ONE: Self = Self([1.0; 8]);
    const PI: Self = Self([std::f64::consts::PI; 8]);
    const EPSILON: Self = Self([f64::EPSILON; 8]);
    const EPSILON_ROOT_8: Self = Self([<f64 as crate::numerics::real::Real>::EPSILON_ROOT_8; 8]);

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; 8])
    }
    #[inline(always)]
    fn from_lanes(member: impl FnMut(usize) -> f64) -> Self {
        Self(from_fn(member))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0[index]
    }
    #[inline(always)]
    fn with_lane(mut self, index: usize, value: f64) -> Self {
        self.0[index] = value;
        self
    }
    #[inline(always)]
    fn map(self, mut function: impl FnMut(f64) -> f64) -> Self {
        Self(from_fn(|i| function(self.0[i])))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(from_fn(|i| self.0[i].sqrt()))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        Self(from_fn(|i| self.0[i].floor()))
    }
    #[inline(always)]
    fn less(self, other: Self) -> PortableMask {
        compare(self, other, |a, b| a < b)
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> PortableMask {
        compare(self, other, |a, b| a <= b)
    }
    #[inline(always)]
    fn equals(self, other: Self) -> PortableMask {
        compare(self, other, |a, b| a == b)
    }
    #[inline(always)]
    fn select(mask: PortableMask, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| f64::from_bits((yes.0[i].to_bits() & mask.0[i]) | (no.0[i].to_bits() & !mask.0[i]))))
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        super::elementary::atan2(self, x)
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        zip(self, other, |a, b| if a < b { a } else { b })
    }
}
