//! Eight lanes in one AVX-512 register.
//!
//! `unsafe` because every operation is an instruction that a processor may lack: a value of [`Avx512`] exists only inside
//! [`super::dispatch::dispatch`], after the processor was asked. Measured before it was written by hand: Carlson's R_F of
//! 512 arguments, in nanoseconds a value, on a Xeon with AVX-512: one at a time 35.7; eight lanes left to the compiler
//! 21.9 (with AVX2 17.7); these instructions 14.0.

#![cfg(target_arch = "x86_64")]
#![expect(unsafe_code, reason = "instructions chosen at run time; the measurement is in the module page")]

use crate::numerics::pack::{Mask, Pack};
use crate::numerics::rough::{
    EXP2_BEND, EXPONENT_BIAS, LARGEST_EXPONENT, LOG2_BEND, MANTISSA, MANTISSA_WIDTH, ONE_BITS,
};
use crate::numerics::taylor::flow::Algebra;
use std::arch::x86_64::*;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// Eight numbers in a register.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(__m512d);

/// Eight truth values, a bit each.
#[derive(Clone, Copy, Debug)]
pub struct Avx512Mask(__mmask8);

const fn constant(x: f64) -> Avx512 {
    // SAFETY: eight numbers in memory are what the register type is made of.
    Avx512(unsafe { std::mem::transmute::<[f64; 8], __m512d>([x; 8]) })
}

macro_rules! arithmetic {
    ($($operation:ident $method:ident, $assigning:ident $assign:ident, $instruction:ident;)*) => {$(
        impl $operation for Avx512 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: an `Avx512` exists only where the processor has AVX-512.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
        impl $assigning for Avx512 {
            #[inline(always)]
            fn $assign(&mut self, other: Self) {
                *self = self.$method(other);
            }
        }
    )*};
}

arithmetic! {
    Add add, AddAssign add_assign, _mm512_add_pd;
    Sub sub, SubAssign sub_assign, _mm512_sub_pd;
    Mul mul, MulAssign mul_assign, _mm512_mul_pd;
    Div div, DivAssign div_assign, _mm512_div_pd;
}

impl Neg for Avx512 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: as above. The sign bit alone is flipped, as by `-x`.
        Self(unsafe { _mm512_xor_pd(self.0, constant(-0.0).0) })
    }
}

impl Avx512 {
    #[inline(always)]
    fn array(self) -> [f64; 8] {
        // SAFETY: the register type has the size and content of eight numbers.
        unsafe { std::mem::transmute::<__m512d, [f64; 8]>(self.0) }
    }
    #[inline(always)]
    fn of(array: [f64; 8]) -> Self {
        // SAFETY: as above.
        Self(unsafe { std::mem::transmute::<[f64; 8], __m512d>(array) })
    }
}

impl Mask for Avx512Mask {
    #[inline(always)]
    fn splat(value: bool) -> Self {
        Self(if value { 0xff } else { 0 })
    }
    #[inline(always)]
    fn from_lanes(mut member: impl FnMut(usize) -> bool) -> Self {
        Self((0..8).fold(0, |bits, i| bits | (u8::from(member(i)) << i)))
    }
    #[inline(always)]
    fn any(self) -> bool {
        self.0 != 0
    }
    #[inline(always)]
    fn all(self) -> bool {
        self.0 == 0xff
    }
    #[inline(always)]
    fn lane(self, index: usize) -> bool {
        (self.0 >> index) & 1 == 1
    }
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

impl Algebra for Avx512 {
    #[inline(always)]
    fn number(x: f64) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_set1_pd(x) })
    }
    #[inline(always)]
    fn size(self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: as above. `VMAXPD` is `if a > b { a } else { b }`, for NaN and signed zeros too.
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
}

impl Pack for Avx512 {
    type Scalar = f64;
    type Mask = Avx512Mask;
    const WIDTH: usize = 8;
    const ZERO: Self = constant(0.0);
    const ONE: Self = constant(1.0);
    const PI: Self = constant(std::f64::consts::PI);
    const EPSILON: Self = constant(f64::EPSILON);
    const EPSILON_ROOT_8: Self = constant(<f64 as crate::numerics::real::Real>::EPSILON_ROOT_8);

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::number(value)
    }
    #[inline(always)]
    fn from_lanes(member: impl FnMut(usize) -> f64) -> Self {
        Self::of(std::array::from_fn(member))
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.array()[index]
    }
    #[inline(always)]
    fn with_lane(self, index: usize, value: f64) -> Self {
        let mut array = self.array();
        array[index] = value;
        Self::of(array)
    }
    #[inline(always)]
    fn map(self, function: impl FnMut(f64) -> f64) -> Self {
        Self::of(self.array().map(function))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_roundscale_pd::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Avx512Mask {
        // SAFETY: as above.
        Avx512Mask(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Avx512Mask {
        // SAFETY: as above.
        Avx512Mask(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn equals(self, other: Self) -> Avx512Mask {
        // SAFETY: as above.
        Avx512Mask(unsafe { _mm512_cmp_pd_mask::<_CMP_EQ_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Avx512Mask, yes: Self, no: Self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_mask_blend_pd(mask.0, no.0, yes.0) })
    }
    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        super::elementary::atan2(self, x)
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: as above. `VMINPD` is `if a < b { a } else { b }`.
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn rough_log2(self) -> Self {
        // SAFETY: as above. The operations of `rough::rough_log2`, in its order.
        let (exponent, mantissa) = unsafe {
            let bits = _mm512_castpd_si512(self.0);
            let exponent = _mm512_cvtepi64_pd(_mm512_srli_epi64::<MANTISSA_WIDTH>(bits));
            let mantissa = _mm512_and_si512(bits, _mm512_set1_epi64(MANTISSA as i64));
            let mantissa = _mm512_or_si512(mantissa, _mm512_set1_epi64(ONE_BITS as i64));
            (Self(exponent), Self(_mm512_castsi512_pd(mantissa)))
        };
        let beyond = mantissa - Self::ONE;
        let exponent = exponent - Self::number(f64::from(EXPONENT_BIAS));
        exponent + beyond + Self::number(LOG2_BEND) * beyond * (Self::ONE - beyond)
    }
    #[inline(always)]
    fn rough_exp2(self) -> Self {
        let shifted = self + Self::number(f64::from(EXPONENT_BIAS));
        let shifted = Self::number(LARGEST_EXPONENT).smaller(Self::ONE.larger(shifted));
        // SAFETY: as above. The operations of `rough::rough_exp2`, in its order; NaN stays NaN by `beyond`.
        let (whole, power) = unsafe {
            let whole = _mm512_cvttpd_epi64(shifted.0);
            (Self(_mm512_cvtepi64_pd(whole)), Self(_mm512_castsi512_pd(_mm512_slli_epi64::<MANTISSA_WIDTH>(whole))))
        };
        let beyond = shifted - whole;
        power * (Self::ONE + beyond - Self::number(EXP2_BEND) * beyond * (Self::ONE - beyond))
    }
}
