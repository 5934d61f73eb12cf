//! Polynomial flows, their tangent columns, and how the two are put together at compile time.
//!
//! A [`Flow`] says how the coefficient `n` of its right-hand side follows from the coefficients `0..=n` of its state
//! (and of auxiliary series, such as products that occur more than once). A [`Tangent`] says the same of one solution
//! of the linearised equations, a *column*. [`WithColumns`] joins a flow and `K` columns into a flow again: the type of
//! the state is the base state plus `K` columns, so a column that is not asked for does not exist.
//!
//! Everything here needs only [`Algebra`]: sums and products, no comparison, so the same flow runs on packs of numbers.
//!
//! Not known here: step lengths, time, accuracy.

use crate::numerics::real::Real;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Highest order of a series. A request of `1e-32` needs order 39 (see [`crate::numerics::taylor::step::order_for`]).
pub const MAX_ORDER: usize = 39;

/// Number of coefficients that a series has room for.
pub const CAPACITY: usize = MAX_ORDER + 1;

/// Taylor coefficients in time of one component, lowest order first.
pub type Series<S> = [S; CAPACITY];

/// What a flow may do with numbers: no branch on a value, so that packs of numbers, member by member, qualify too.
pub trait Algebra:
    Copy + 'static + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The number itself, or all members of a pack set to it.
    fn number(x: f64) -> Self;
    /// Absolute value.
    fn size(self) -> Self;
    /// The larger of two.
    fn larger(self, other: Self) -> Self;
}

impl<S: Real> Algebra for S {
    #[inline(always)]
    fn number(x: f64) -> Self {
        S::from_f64(x)
    }
    #[inline(always)]
    fn size(self) -> Self {
        self.abs()
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        self.max(other)
    }
}

/// The largest absolute value: the common scale of components that turn into each other.
#[inline(always)]
pub fn largest<S: Algebra>(components: &[S]) -> S {
    let mut scale = S::number(0.0);
    for x in components {
        scale = scale.larger(x.size());
    }
    scale
}

/// A fixed-size collection of `T`, addressed by index: an array, or arrays joined by [`Joined`] and [`Columns`].
pub trait Elements<T: Copy>: Copy {
    /// Number of elements.
    const LEN: usize;
    /// All elements set to one value.
    fn filled(value: T) -> Self;
    /// Element `i < LEN`.
    fn get(&self, i: usize) -> &T;
    /// Element `i < LEN`, to be changed.
    fn get_mut(&mut self, i: usize) -> &mut T;
}

impl<T: Copy, const N: usize> Elements<T> for [T; N] {
    const LEN: usize = N;
    #[inline(always)]
    fn filled(value: T) -> Self {
        [value; N]
    }
    #[inline(always)]
    fn get(&self, i: usize) -> &T {
        &self[i]
    }
    #[inline(always)]
    fn get_mut(&mut self, i: usize) -> &mut T {
        &mut self[i]
    }
}

/// The elements of a base flow followed by those of its columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joined<A, B> {
    /// What belongs to the base flow.
    pub base: A,
    /// What belongs to the columns.
    pub columns: B,
}

impl<T: Copy, A: Elements<T>, B: Elements<T>> Elements<T> for Joined<A, B> {
    const LEN: usize = A::LEN + B::LEN;
    #[inline(always)]
    fn filled(value: T) -> Self {
        Joined { base: A::filled(value), columns: B::filled(value) }
    }
    #[inline(always)]
    fn get(&self, i: usize) -> &T {
        if i < A::LEN { self.base.get(i) } else { self.columns.get(i - A::LEN) }
    }
    #[inline(always)]
    fn get_mut(&mut self, i: usize) -> &mut T {
        if i < A::LEN { self.base.get_mut(i) } else { self.columns.get_mut(i - A::LEN) }
    }
}

/// `K` collections of one kind, one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Columns<E, const K: usize>(pub [E; K]);

impl<T: Copy, E: Elements<T>, const K: usize> Elements<T> for Columns<E, K> {
    const LEN: usize = K * E::LEN;
    #[inline(always)]
    fn filled(value: T) -> Self {
        Columns([E::filled(value); K])
    }
    #[inline(always)]
    fn get(&self, i: usize) -> &T {
        self.0[i / E::LEN].get(i % E::LEN)
    }
    #[inline(always)]
    fn get_mut(&mut self, i: usize) -> &mut T {
        self.0[i / E::LEN].get_mut(i % E::LEN)
    }
}

/// A polynomial flow `x' = f(x)`.
pub trait Flow<S: Algebra> {
    /// The state, with `T` for each component.
    type State<T: Copy>: Elements<T>;
    /// Auxiliary series that the right-hand side reuses, with `T` for each.
    type Auxiliary<T: Copy>: Elements<T>;
    /// Number of leading components that belong to the base flow.
    const BASE_DIMENSION: usize = <Self::State<S> as Elements<S>>::LEN;
    /// Number of tangent columns.
    const COLUMNS: usize = 0;

    /// Coefficient `n` of the right-hand side.
    ///
    /// Given are the coefficients `0..=n` of the state and `0..n` of the auxiliary series; coefficient `n` of every
    /// auxiliary series must be set. The caller then sets coefficient `n + 1` of the state to the result `/ (n + 1)`.
    fn coefficients(
        &self,
        n: usize,
        state: &Self::State<Series<S>>,
        auxiliary: &mut Self::Auxiliary<Series<S>>,
    ) -> Self::State<S>;

    /// The size of each component to which relative errors refer at this state (positive): components that turn into
    /// each other share one scale, components of different units do not.
    fn scales(&self, state: &Self::State<S>) -> Self::State<S>;
}

/// The series of a base flow's state and of its auxiliaries.
pub type BaseSeries<'a, S, F> = (&'a <F as Flow<S>>::State<Series<S>>, &'a <F as Flow<S>>::Auxiliary<Series<S>>);

/// A flow whose linearised equations are known, one solution of them being a *column*.
pub trait Tangent<S: Algebra>: Flow<S> {
    /// One column, with `T` for each component.
    type Column<T: Copy>: Elements<T>;
    /// Auxiliary series of one column.
    type ColumnAuxiliary<T: Copy>: Elements<T>;
    /// What is constant along one column (the variation of a conserved parameter), or `()`.
    type ColumnParameter: Copy;

    /// Coefficient `n` of the right-hand side of one column. Given are the coefficients `0..=n` of base state, base
    /// auxiliaries and column, and `0..n` of the column's auxiliaries, whose coefficient `n` must be set.
    fn column_coefficients(
        &self,
        n: usize,
        parameter: &Self::ColumnParameter,
        base: BaseSeries<'_, S, Self>,
        column: &Self::Column<Series<S>>,
        auxiliary: &mut Self::ColumnAuxiliary<Series<S>>,
    ) -> Self::Column<S>;

    /// As [`Flow::scales`], for one column.
    fn column_scales(&self, state: &Self::State<S>, column: &Self::Column<S>) -> Self::Column<S>;
}

/// A flow with `K` tangent columns beside it. Columns of a flow that has no [`Tangent`] do not compile:
///
/// ```compile_fail
/// use polhode::numerics::taylor::flow::{Flow, Series, WithColumns};
/// struct Decay;
/// impl Flow<f64> for Decay {
///     type State<T: Copy> = [T; 1];
///     type Auxiliary<T: Copy> = [T; 0];
///     fn coefficients(&self, n: usize, x: &[Series<f64>; 1], _: &mut [Series<f64>; 0]) -> [f64; 1] {
///         [-x[0][n]]
///     }
///     fn scales(&self, _: &[f64; 1]) -> [f64; 1] {
///         [1.0]
///     }
/// }
/// fn needs_a_flow<F: Flow<f64>>(_: F) {}
/// needs_a_flow(WithColumns { flow: Decay, parameters: [()] });
/// ```
#[derive(Clone, Copy, Debug)]
pub struct WithColumns<F, P, const K: usize> {
    /// The base flow.
    pub flow: F,
    /// What is constant along each column.
    pub parameters: [P; K],
}

impl<S, F, const K: usize> Flow<S> for WithColumns<F, F::ColumnParameter, K>
where
    S: Algebra,
    F: Tangent<S>,
{
    type State<T: Copy> = Joined<F::State<T>, Columns<F::Column<T>, K>>;
    type Auxiliary<T: Copy> = Joined<F::Auxiliary<T>, Columns<F::ColumnAuxiliary<T>, K>>;
    const BASE_DIMENSION: usize = F::BASE_DIMENSION;
    const COLUMNS: usize = F::COLUMNS + K;

    #[inline(always)]
    fn coefficients(
        &self,
        n: usize,
        state: &Self::State<Series<S>>,
        auxiliary: &mut Self::Auxiliary<Series<S>>,
    ) -> Self::State<S> {
        let base = self.flow.coefficients(n, &state.base, &mut auxiliary.base);
        let mut columns = Columns::<F::Column<S>, K>::filled(S::number(0.0));
        for k in 0..K {
            columns.0[k] = self.flow.column_coefficients(
                n,
                &self.parameters[k],
                (&state.base, &auxiliary.base),
                &state.columns.0[k],
                &mut auxiliary.columns.0[k],
            );
        }
        Joined { base, columns }
    }

    #[inline(always)]
    fn scales(&self, state: &Self::State<S>) -> Self::State<S> {
        let columns = state.columns.0.map(|column| self.flow.column_scales(&state.base, &column));
        Joined { base: self.flow.scales(&state.base), columns: Columns(columns) }
    }
}

/// Coefficient `n` of the product of two series, `Σ a_i b_{n−i}`.
#[inline(always)]
pub fn convolve<S: Algebra>(a: &Series<S>, b: &Series<S>, n: usize) -> S {
    reversed_dot(&a[..=n], &b[..=n])
}

/// `Σ a_i b_{len−1−i}` of two slices of one length. Four sums run beside each other, so that none waits for the last
/// addition of another; their order is fixed by the source, hence the bits too.
#[inline(always)]
fn reversed_dot<S: Algebra>(a: &[S], b: &[S]) -> S {
    let mut sums = [S::number(0.0); 4];
    let (a_fours, b_fours) = (a.chunks_exact(4), b.rchunks_exact(4));
    let (a_rest, b_rest) = (a_fours.remainder(), b_fours.remainder());
    for (u, v) in a_fours.zip(b_fours) {
        for (j, sum) in sums.iter_mut().enumerate() {
            *sum = *sum + u[j] * v[3 - j];
        }
    }
    let mut sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    for (u, v) in a_rest.iter().zip(b_rest.iter().rev()) {
        sum = sum + *u * *v;
    }
    sum
}

/// Coefficient `n` of several products of series at once, `Σ a_i b_{n−i}` of each pair.
///
/// One loop for all of them: a series that stands in several pairs is read once, and the sums do not wait for each other.
/// The newest coefficients are added last, so that a processor can begin before they are known.
#[inline(always)]
pub fn convolve_each<S: Algebra, const K: usize>(pairs: [(&Series<S>, &Series<S>); K], n: usize) -> [S; K] {
    let n = n.min(MAX_ORDER);
    let (mut even, mut odd) = ([S::number(0.0); K], [S::number(0.0); K]);
    let mut i = 1;
    while i + 1 < n {
        let j = (n - i).min(MAX_ORDER);
        for k in 0..K {
            even[k] = even[k] + pairs[k].0[i] * pairs[k].1[j];
            odd[k] = odd[k] + pairs[k].0[i + 1] * pairs[k].1[j - 1];
        }
        i += 2;
    }
    if i < n {
        for k in 0..K {
            even[k] = even[k] + pairs[k].0[i] * pairs[k].1[1];
        }
    }
    for k in 0..K {
        let (first, second) = (pairs[k].0, pairs[k].1);
        let mut ends = first[0] * second[n];
        if n > 0 {
            ends = ends + first[n] * second[0];
        }
        even[k] = (even[k] + odd[k]) + ends;
    }
    even
}

/// Coefficient `n`, which may be beyond the order, of several products of polynomials of this order.
#[inline(always)]
pub fn product_each<S: Algebra, const K: usize>(
    pairs: [(&Series<S>, &Series<S>); K],
    order: usize,
    n: usize,
) -> [S; K] {
    let order = order.min(MAX_ORDER);
    let (mut even, mut odd) = ([S::number(0.0); K], [S::number(0.0); K]);
    let (mut i, end) = (n.saturating_sub(order), n.min(order));
    while i < end {
        let j = (n - i).min(MAX_ORDER);
        for k in 0..K {
            even[k] = even[k] + pairs[k].0[i] * pairs[k].1[j];
            odd[k] = odd[k] + pairs[k].0[i + 1] * pairs[k].1[j - 1];
        }
        i += 2;
    }
    if i == end {
        let j = (n - i).min(MAX_ORDER);
        for k in 0..K {
            even[k] = even[k] + pairs[k].0[i] * pairs[k].1[j];
        }
    }
    for k in 0..K {
        even[k] = even[k] + odd[k];
    }
    even
}

/// Coefficient `n` of the product of two polynomials given by all their coefficients (of any number).
#[inline(always)]
pub fn product<S: Algebra>(a: &[S], b: &[S], n: usize) -> S {
    let (first, end) = ((n + 1).saturating_sub(b.len()), a.len().min(n + 1));
    if first < end { reversed_dot(&a[first..end], &b[n + 1 - end..n + 1 - first]) } else { S::number(0.0) }
}

/// Coefficient `n` of the square of a series: half the products of [`convolve`].
#[inline(always)]
pub fn convolve_square<S: Algebra>(a: &Series<S>, n: usize) -> S {
    let half = n.div_ceil(2);
    let sum = reversed_dot(&a[..half], &a[n + 1 - half..=n]);
    let doubled = sum + sum;
    if n.is_multiple_of(2) { doubled + a[n / 2] * a[n / 2] } else { doubled }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_series_match_the_exponential() {
        // exp(t)·exp(2t) = exp(3t): coefficient n is 3^n/n!. Sums of positive terms: a few ε.
        let (mut one, mut two, mut three) = ([0.0; CAPACITY], [0.0; CAPACITY], [0.0; CAPACITY]);
        (one[0], two[0], three[0]) = (1.0, 1.0, 1.0);
        for n in 1..CAPACITY {
            one[n] = one[n - 1] / n as f64;
            two[n] = two[n - 1] * 2.0 / n as f64;
            three[n] = three[n - 1] * 3.0 / n as f64;
        }
        for n in 0..CAPACITY {
            assert!((convolve(&one, &two, n) / three[n] - 1.0).abs() < 30.0 * f64::EPSILON, "order {n}");
            assert!((convolve_square(&one, n) / two[n] - 1.0).abs() < 30.0 * f64::EPSILON, "order {n}");
        }
    }

    #[test]
    fn products_of_polynomials_have_all_their_coefficients() {
        // (1 + 2t + 3t²)(4 + 5t) = 4 + 13t + 22t² + 15t³, exactly.
        let all: Vec<f64> = (0..6).map(|n| product(&[1.0, 2.0, 3.0], &[4.0, 5.0], n)).collect();
        assert_eq!(all, [4.0, 13.0, 22.0, 15.0, 0.0, 0.0]);
    }

    #[test]
    fn joined_elements_are_addressed_base_first() {
        let mut joined = Joined { base: [0, 1, 2], columns: Columns([[3, 4], [5, 6]]) };
        type Seven = Joined<[i32; 3], Columns<[i32; 2], 2>>;
        assert_eq!(<Seven as Elements<i32>>::LEN, 7);
        for i in 0..7 {
            assert_eq!(*joined.get(i), i as i32);
            *joined.get_mut(i) += 10;
        }
        assert_eq!(joined, Joined { base: [10, 11, 12], columns: Columns([[13, 14], [15, 16]]) });
    }
}
