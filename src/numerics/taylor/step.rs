//! One step: the order and the step length from the requested error, and the coefficients of the solution's series.
//!
//! Jorba and Zou (2005), section 3: the order `p = ⌈1 − ½ ln ε⌉` minimises work per unit of time when the work grows as
//! `p²`; the step is `ρ e^−2 e^(−0.7/(p−1))` with the radius of convergence ρ estimated from the last two coefficients,
//! so that the first term left out is below ε of the state's scale. At ε = 2.2e-16 that is order 20 and a truncation
//! error of e^−42 ≈ 6e-19 of the scale: only rounding is left.
//!
//! Norms are largest absolute values of components over their own scales ([`Flow::scales`]), so that a momentum of 1e8
//! does not drown a unit vector beside it.

use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{CAPACITY, Elements, Flow, MAX_ORDER, Series};

/// Lowest order of a step: with less the estimate of the radius means nothing.
pub const MIN_ORDER: usize = 5;

/// Which components decide the step length.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorNorm {
    /// Base flow and columns: the error of the columns is controlled too.
    #[default]
    WithColumns,
    /// The base flow alone: adding a column leaves the bits of the base trajectory as they were.
    BaseOnly,
}

/// The order for a requested relative error: `⌈1 − ½ ln ε⌉`, between [`MIN_ORDER`] and [`MAX_ORDER`].
pub fn order_for(tolerance: f64) -> usize {
    let order = (1.0 - 0.5 * libm::log(tolerance)).ceil();
    // NaN and negative values end up at the lowest order.
    if order >= MAX_ORDER as f64 { MAX_ORDER } else { (order.max(MIN_ORDER as f64)) as usize }
}

/// The series of state and auxiliaries about the start of a step. Made once, and reused by every step.
pub struct Jet<S: Real, F: Flow<S>> {
    /// Series of the state, coefficients `0..=order`.
    pub state: F::State<Series<S>>,
    /// Series of the auxiliaries, coefficients `0..order`.
    pub auxiliary: F::Auxiliary<Series<S>>,
    order: usize,
    reciprocals: Series<S>,
}

impl<S: Real, F: Flow<S>> Jet<S, F> {
    /// Room for series of this order.
    pub fn new(order: usize) -> Self {
        let order = order.clamp(MIN_ORDER, MAX_ORDER);
        let mut reciprocals = [S::ONE; CAPACITY];
        for (n, reciprocal) in reciprocals.iter_mut().enumerate().skip(1) {
            *reciprocal = S::ONE / S::from_f64(n as f64);
        }
        let zero = [S::ZERO; CAPACITY];
        Jet { state: Elements::filled(zero), auxiliary: Elements::filled(zero), order, reciprocals }
    }

    /// The order of the series.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Computes the series of the solution that starts at this state.
    #[inline(always)]
    pub fn expand(&mut self, flow: &F, start: &F::State<S>) {
        let dimension = <F::State<S> as Elements<S>>::LEN;
        for i in 0..dimension {
            self.state.get_mut(i)[0] = *start.get(i);
        }
        for n in 0..self.order {
            let rate = flow.coefficients(n, &self.state, &mut self.auxiliary);
            let reciprocal = self.reciprocals[n + 1];
            for i in 0..dimension {
                self.state.get_mut(i)[n + 1] = *rate.get(i) * reciprocal;
            }
        }
    }

    /// The step length (positive; infinite when the solution is constant; NaN when a coefficient is).
    pub fn step_length(&self, flow: &F, start: &F::State<S>, norm: ErrorNorm) -> f64 {
        let components = match norm {
            ErrorNorm::WithColumns => <F::State<S> as Elements<S>>::LEN,
            ErrorNorm::BaseOnly => F::BASE_DIMENSION,
        };
        let scales = flow.scales(start);
        let p = self.order;
        let (mut last, mut before) = (0.0_f64, 0.0_f64);
        let mut finite = true;
        for i in 0..components {
            let series = self.state.get(i);
            let scale = scales.get(i).to_f64();
            let (a, b) = ((series[p].to_f64() / scale).abs(), (series[p - 1].to_f64() / scale).abs());
            finite &= a.is_finite() && b.is_finite();
            last = last.max(a);
            before = before.max(b);
        }
        if !finite {
            return f64::NAN;
        }
        // ρ = min(‖x_p‖^(−1/p), ‖x_{p−1}‖^(−1/(p−1))); a vanishing norm says nothing.
        let inverse_radius =
            |norm: f64, n: usize| if norm > 0.0 { libm::log(norm) / n as f64 } else { f64::NEG_INFINITY };
        let exponent = inverse_radius(last, p).max(inverse_radius(before, p - 1));
        libm::exp(-exponent - 2.0 - 0.7 / (p - 1) as f64)
    }
}

/// The value at `offset` of a series cut after `order`.
#[inline(always)]
pub fn horner<S: Real>(series: &Series<S>, order: usize, offset: S) -> S {
    let mut sum = series[order];
    for n in (0..order).rev() {
        sum = sum * offset + series[n];
    }
    sum
}

/// The change of a series over `offset`: its value without the constant term.
#[inline(always)]
pub fn horner_increment<S: Real>(series: &Series<S>, order: usize, offset: S) -> S {
    let mut sum = series[order];
    for n in (1..order).rev() {
        sum = sum * offset + series[n];
    }
    sum * offset
}

/// An upper bound of a series' absolute value on `[0, length]`: the sum of the absolute values of its terms.
#[inline(always)]
pub fn absolute_sum<S: Real>(series: &Series<S>, order: usize, length: S) -> S {
    let mut sum = series[order].abs();
    let length = length.abs();
    for n in (0..order).rev() {
        sum = sum * length + series[n].abs();
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Riccati;
    impl Flow<f64> for Riccati {
        type State<T: Copy> = [T; 1];
        type Auxiliary<T: Copy> = [T; 0];
        fn coefficients(&self, n: usize, x: &[Series<f64>; 1], _: &mut [Series<f64>; 0]) -> [f64; 1] {
            [crate::numerics::taylor::flow::convolve_square(&x[0], n)]
        }
        fn scales(&self, x: &[f64; 1]) -> [f64; 1] {
            [x[0].abs()]
        }
    }

    #[test]
    fn orders_are_those_of_jorba_and_zou() {
        assert_eq!([1e-3, 1e-6, 1e-9, 1e-12, 2.2e-16, 1e-32].map(order_for), [5, 8, 12, 15, 20, 38]);
        assert_eq!([0.0, f64::NAN, 10.0].map(order_for), [39, 5, 5]);
    }

    #[test]
    fn the_radius_of_convergence_is_seen() {
        // x' = x², x = x0/(1 − x0 t): every coefficient is x0^(n+1), radius 1/x0 exactly.
        let mut jet = Jet::<f64, Riccati>::new(20);
        jet.expand(&Riccati, &[4.0]);
        for n in 0..=20 {
            let exact = libm::ldexp(1.0, 2 * (n + 1));
            assert!((jet.state[0][n as usize] / exact - 1.0).abs() < 20.0 * f64::EPSILON, "order {n}");
        }
        let expected = 0.25 * libm::exp(-2.0 - 0.7 / 19.0);
        assert!((jet.step_length(&Riccati, &[4.0], ErrorNorm::WithColumns) / expected - 1.0).abs() < 1e-14);
        let value = horner(&jet.state[0], 20, expected);
        let exact = 4.0 / (1.0 - 4.0 * expected);
        assert!((value / exact - 1.0).abs() < 4.0 * f64::EPSILON, "{value} {exact}");
        assert!(absolute_sum(&jet.state[0], 20, -expected) >= exact * (1.0 - 1e-15));
    }
}
