//! Numbers that count: whatever is written over a scalar runs on them unchanged, with the same bits, and its operations are known.
//!
//! A computation's work is then the same on every machine, and the same measure serves power series, Runge-Kutta pairs and closed forms,
//! roots, dense output and events included. What a computation does in `f64` beside its scalar (the length of a step) is not counted.
//!
//! Not known here: time. A machine multiplies several numbers at once, and additions are not counted at all.

use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// What was counted. Units: plain counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Multiplications.
    pub products: u64,
    /// Divisions.
    pub quotients: u64,
    /// Square roots.
    pub roots: u64,
    /// Values of elementary functions; a sine and a cosine together are two.
    pub functions: u64,
}

impl Operations {
    const NONE: Self = Self { products: 0, quotients: 0, roots: 0, functions: 0 };

    /// These and the others together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            products: self.products + other.products,
            quotients: self.quotients + other.quotients,
            roots: self.roots + other.roots,
            functions: self.functions + other.functions,
        }
    }

    /// In multiplications of `f64`, when they were carried out on this scalar: a division or a root of `f64` counts as one.
    pub fn multiplications<S: Multiplications>(&self) -> u64 {
        self.products * S::PRODUCT + self.quotients * S::QUOTIENT + self.roots * S::ROOT + self.functions * S::FUNCTION
    }
}

/// How many multiplications, divisions and roots of `f64` an operation on a scalar takes.
pub trait Multiplications: Real {
    /// Of a product.
    const PRODUCT: u64;
    /// Of a quotient.
    const QUOTIENT: u64;
    /// Of a square root.
    const ROOT: u64;
    /// Of an elementary function, about: they differ.
    const FUNCTION: u64;
}

impl Multiplications for f64 {
    const PRODUCT: u64 = 1;
    const QUOTIENT: u64 = 1;
    const ROOT: u64 = 1;
    /// A polynomial of degree ten or so, and the reduction of its argument.
    const FUNCTION: u64 = 15;
}

/// Counted in the source of [`DoubleDouble`]: an exact product is seven.
impl Multiplications for DoubleDouble {
    const PRODUCT: u64 = 9;
    const QUOTIENT: u64 = 10;
    const ROOT: u64 = 10;
    /// Fourteen terms of a series, a product and a quotient each.
    const FUNCTION: u64 = 14 * (9 + 10);
}

thread_local! {
    static OPERATIONS: Cell<Operations> = const { Cell::new(Operations::NONE) };
}

/// What `work` gives, and the operations on counting numbers of this thread meanwhile.
pub fn counted<T>(work: impl FnOnce() -> T) -> (T, Operations) {
    let before = OPERATIONS.replace(Operations::NONE);
    let result = work();
    let during = OPERATIONS.replace(before);
    OPERATIONS.set(before.plus(during));
    (result, during)
}

fn count<S>(value: S, change: impl FnOnce(&mut Operations)) -> Counting<S> {
    OPERATIONS.with(|cell| {
        let mut operations = cell.get();
        change(&mut operations);
        cell.set(operations);
    });
    Counting(value)
}

fn product<S>(value: S) -> Counting<S> {
    count(value, |operations| operations.products += 1)
}

fn quotient<S>(value: S) -> Counting<S> {
    count(value, |operations| operations.quotients += 1)
}

fn root<S>(value: S) -> Counting<S> {
    count(value, |operations| operations.roots += 1)
}

fn function<S>(value: S) -> Counting<S> {
    count(value, |operations| operations.functions += 1)
}

/// A number that counts the operations of its thread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counting<S = f64>(
    /// The number.
    pub S,
);

impl<S: PartialOrd> PartialOrd for Counting<S> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

impl<S: Real> Add for Counting<S> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Counting(self.0 + other.0)
    }
}

impl<S: Real> Sub for Counting<S> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        Counting(self.0 - other.0)
    }
}

impl<S: Real> Mul for Counting<S> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        product(self.0 * other.0)
    }
}

impl<S: Real> Div for Counting<S> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        quotient(self.0 / other.0)
    }
}

impl<S: Real> Neg for Counting<S> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Counting(-self.0)
    }
}

impl<S: Real> AddAssign for Counting<S> {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Real> SubAssign for Counting<S> {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Real> MulAssign for Counting<S> {
    #[inline]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl<S: Real> DivAssign for Counting<S> {
    #[inline]
    fn div_assign(&mut self, other: Self) {
        *self = *self / other;
    }
}

impl<S: Real> Real for Counting<S> {
    const ZERO: Self = Counting(S::ZERO);
    const ONE: Self = Counting(S::ONE);
    const PI: Self = Counting(S::PI);
    const EPSILON: Self = Counting(S::EPSILON);
    const EPSILON_ROOT_8: Self = Counting(S::EPSILON_ROOT_8);

    #[inline]
    fn from_f64(x: f64) -> Self {
        Counting(S::from_f64(x))
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }
    fn sqrt(self) -> Self {
        root(self.0.sqrt())
    }
    #[inline]
    fn abs(self) -> Self {
        Counting(self.0.abs())
    }
    #[inline]
    fn floor(self) -> Self {
        Counting(self.0.floor())
    }
    fn exp(self) -> Self {
        function(self.0.exp())
    }
    fn ln(self) -> Self {
        function(self.0.ln())
    }
    fn ln_1p(self) -> Self {
        function(self.0.ln_1p())
    }
    fn exp_m1(self) -> Self {
        function(self.0.exp_m1())
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos();
        (function(sine), function(cosine))
    }
    fn atan2(self, x: Self) -> Self {
        function(self.0.atan2(x.0))
    }
    fn sinh(self) -> Self {
        function(self.0.sinh())
    }
    fn cosh(self) -> Self {
        function(self.0.cosh())
    }
    fn tanh(self) -> Self {
        function(self.0.tanh())
    }
    fn asinh(self) -> Self {
        function(self.0.asinh())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: Horner's scheme of degree n takes n products; one quotient, one root and two functions after it.
    #[test]
    fn operations_are_counted_once_each_and_nested_counts_are_part_of_the_whole() {
        fn formula<S: Real>(x: S) -> S {
            let polynomial = (0..5).fold(S::ONE, |sum, _| sum * x + S::ONE);
            let (sine, cosine) = x.sin_cos();
            polynomial.sqrt() / (sine - cosine)
        }
        let (value, operations) = counted(|| {
            let (inner, part) = counted(|| formula(Counting(0.3)));
            assert_eq!(part, Operations { products: 5, quotients: 1, roots: 1, functions: 2 });
            inner * Counting(2.0)
        });
        // The same bits.
        assert_eq!(value.0.to_bits(), (formula(0.3) * 2.0).to_bits());
        assert_eq!(operations, Operations { products: 6, quotients: 1, roots: 1, functions: 2 });
        assert_eq!(operations.multiplications::<f64>(), 6 + 1 + 1 + 2 * 15);
        assert_eq!(operations.multiplications::<DoubleDouble>(), 6 * 9 + 10 + 10 + 2 * 14 * 19);
        assert_eq!(counted(|| ()).1, Operations::NONE);
    }
}
