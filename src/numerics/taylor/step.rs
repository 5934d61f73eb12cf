//! One step: the order and the step length from the requested error, and the coefficients of the solution's series.
//!
//! **Order.** Work per unit of time grows as `p²/h`, and a series cut at order `p` reaches `h = ρ ε^(1/p)` (ρ: radius of
//! convergence), so the best order is `½ ln(1/ε)` (Jorba and Zou 2005, section 3); the minimum is flat and what a step
//! costs beside its products favours two more.
//!
//! **Step.** Not the asymptotic `ρ e^−2`, which leaves errors up to a thousand times below the request, but the length at
//! which the last two terms that are kept have the size that was asked for:
//! `h = min((τ/‖x_p‖)^(1/p), (τ/‖x_{p−1}‖)^(1/(p−1)))` with `τ = TERM_TO_TOLERANCE · ε`. What is left
//! out is smaller than the last term by about `h/ρ`, 0.15 for tight to 0.4 for loose requests. Measured on random starts
//! of the spin lift, of the Serret-Andoyer flow and of the body flow (tests/taylor_accuracy.rs): the median error is a
//! hundredth to a tenth of the request, the more the looser it is. Towards the scalar's ε the steps are held shorter, so
//! that only rounding is left there.
//!
//! A step needs no transcendental function: `p`-th roots are taken with logarithms that are good to one part in a
//! hundred, which the root divides by `p`. Exact operations only, so the same bits everywhere.
//!
//! Norms are largest absolute values of components over their own scales ([`Flow::scales`]), so that a momentum of 1e8
//! does not drown a unit vector beside it.

use crate::numerics::pack::{Mask, Pack};
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Algebra, CAPACITY, Elements, Flow, MAX_ORDER, Series};

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

/// Size of the last terms that are kept, in units of the request. With 1/2 the largest error of some thousand random
/// starts was just under 30 requests, at Serret-Andoyer starts near the separatrix where the flow multiplies errors by
/// thousands (elsewhere at most 15); with 1 it was above 40.
pub const TERM_TO_TOLERANCE: f64 = 0.5;

/// Requests below this many of the scalar's ε are tightened, in proportion to how near they are: a step rounds by an ε or
/// so anyway, and truncation is to stay out of sight there.
pub const TIGHTENED_BELOW: f64 = 8.0;

/// Largest size of the last terms that are kept, whatever is asked: a step of order 5 then ends at 0.4 of the radius of
/// convergence.
pub const LARGEST_TERM: f64 = 1e-2;

/// The order for a requested relative error: `⌈2 − ½ ln ε⌉`, between [`MIN_ORDER`] and [`MAX_ORDER`].
pub fn order_for(tolerance: f64) -> usize {
    let order = (2.0 - 0.5 * libm::log(tolerance)).ceil();
    // NaN and negative values end up at the lowest order.
    if order >= MAX_ORDER as f64 { MAX_ORDER } else { (order.max(MIN_ORDER as f64)) as usize }
}

/// What a requested error means for the steps: made once for an integration, the same for every lane that asks the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepPolicy {
    /// The relative error asked for, not below the scalar's ε.
    pub tolerance: f64,
    /// Order `p` of the series.
    pub order: usize,
    /// `1/p` and `1/(p − 1)`.
    roots: [f64; 2],
    /// `log₂ τ` times these.
    logarithms: [f64; 2],
}

impl StepPolicy {
    /// For this relative error, in a scalar with this ε. Requests below ε are taken as ε.
    pub fn new(tolerance: f64, epsilon: f64) -> Self {
        let asked = tolerance.max(epsilon);
        let order = order_for(asked);
        let tightened = asked / (asked + TIGHTENED_BELOW * epsilon);
        let term = (TERM_TO_TOLERANCE * asked * tightened).min(LARGEST_TERM);
        let roots = [1.0 / order as f64, 1.0 / (order - 1) as f64];
        let logarithm = libm::log2(term);
        StepPolicy { tolerance: asked, order, roots, logarithms: roots.map(|root| logarithm * root) }
    }
}

/// The step length for the norms `‖x_p‖` and `‖x_{p−1}‖` of the last two coefficients.
///
/// Positive; infinite when both vanish (the solution is a polynomial, or constant); NaN when one is not finite. Within
/// one percent of the module page's `h`. Pure, without table or transcendental call: fit for lanes.
#[inline(always)]
pub fn step_length_from_norms<P: Pack<Scalar = f64>>(policy: &StepPolicy, last: P, before: P) -> P {
    let ([root, root_before], [term, term_before]) =
        (policy.roots.map(P::from_f64), policy.logarithms.map(P::from_f64));
    let (by_last, by_before) = (term - root * last.rough_log2(), term_before - root_before * before.rough_log2());
    let length = by_last.min(by_before).rough_exp2();
    let infinity = P::from_f64(f64::INFINITY);
    let finite = last.less(infinity).and(before.less(infinity));
    let vanish = last.equals(P::ZERO).and(before.equals(P::ZERO));
    P::select(finite, P::select(vanish, infinity, length), P::from_f64(f64::NAN))
}

/// The series of state and auxiliaries about the start of a step. Made once, and reused by every step.
pub struct Jet<S: Algebra, F: Flow<S>> {
    /// Series of the state, coefficients `0..=order`.
    pub state: F::State<Series<S>>,
    /// Series of the auxiliaries, coefficients `0..order`.
    pub auxiliary: F::Auxiliary<Series<S>>,
    order: usize,
    reciprocals: Series<S>,
}

impl<S: Algebra, F: Flow<S>> Jet<S, F> {
    /// Room for series of this order.
    pub fn new(order: usize) -> Self {
        let order = order.clamp(MIN_ORDER, MAX_ORDER);
        let mut reciprocals = [S::number(1.0); CAPACITY];
        for (n, reciprocal) in reciprocals.iter_mut().enumerate().skip(1) {
            *reciprocal = S::number(1.0) / S::number(n as f64);
        }
        let zero = [S::number(0.0); CAPACITY];
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

    /// The norms of the last two coefficients and a number that is zero where both are finite, else NaN.
    #[inline(always)]
    pub fn norms(&self, flow: &F, start: &F::State<S>, norm: ErrorNorm) -> Norms<S> {
        let components = match norm {
            ErrorNorm::WithColumns => <F::State<S> as Elements<S>>::LEN,
            ErrorNorm::BaseOnly => F::BASE_DIMENSION,
        };
        let scales = flow.scales(start);
        let p = self.order;
        let zero = S::number(0.0);
        let mut norms = Norms { last: zero, before: zero, probe: zero };
        for i in 0..components {
            let series = self.state.get(i);
            let inverse = S::number(1.0) / *scales.get(i);
            let (a, b) = ((series[p] * inverse).size(), (series[p - 1] * inverse).size());
            norms.probe = norms.probe + (zero * a + zero * b);
            norms.last = norms.last.larger(a);
            norms.before = norms.before.larger(b);
        }
        norms
    }
}

/// What the step length is made of.
#[derive(Clone, Copy, Debug)]
pub struct Norms<S> {
    /// `‖x_p‖`.
    pub last: S,
    /// `‖x_{p−1}‖`.
    pub before: S,
    /// Zero where both are finite, else NaN.
    pub probe: S,
}

impl<P: Pack<Scalar = f64>> Norms<P> {
    /// The step length by this policy (see [`step_length_from_norms`]).
    #[inline(always)]
    pub fn step_length(&self, policy: &StepPolicy) -> P {
        step_length_from_norms(policy, self.last + self.probe, self.before + self.probe)
    }
}

impl<S: Real, F: Flow<S>> Jet<S, F> {
    /// The step length by this policy, whose order must be the jet's.
    pub fn step_length(&self, flow: &F, start: &F::State<S>, norm: ErrorNorm, policy: &StepPolicy) -> f64 {
        let Norms { last, before, probe } = self.norms(flow, start, norm);
        Norms { last: last.to_f64(), before: before.to_f64(), probe: probe.to_f64() }.step_length(policy)
    }
}

/// The value at `offset` of a series cut after `order`.
#[inline(always)]
pub fn horner<S: Algebra>(series: &Series<S>, order: usize, offset: S) -> S {
    let mut sum = series[order];
    for n in (0..order).rev() {
        sum = sum * offset + series[n];
    }
    sum
}

/// The change of a series over `offset`: its value without the constant term.
#[inline(always)]
pub fn horner_increment<S: Algebra>(series: &Series<S>, order: usize, offset: S) -> S {
    let mut sum = series[order];
    for n in (1..order).rev() {
        sum = sum * offset + series[n];
    }
    sum * offset
}

/// [`horner_increment`] of every component, side by side: a processor need not wait for one to begin the next.
#[inline(always)]
pub fn horner_increments<S: Algebra, F: Flow<S>>(state: &F::State<Series<S>>, order: usize, offset: S) -> F::State<S> {
    let dimension = <F::State<S> as Elements<S>>::LEN;
    let order = order.min(MAX_ORDER);
    let mut sums = F::State::<S>::filled(S::number(0.0));
    for i in 0..dimension {
        *sums.get_mut(i) = state.get(i)[order];
    }
    for n in (1..order).rev() {
        for i in 0..dimension {
            let sum = sums.get_mut(i);
            *sum = *sum * offset + state.get(i)[n];
        }
    }
    for i in 0..dimension {
        let sum = sums.get_mut(i);
        *sum = *sum * offset;
    }
    sums
}

/// An upper bound of a series' absolute value on `[0, length]`: the sum of the absolute values of its terms.
#[inline(always)]
pub fn absolute_sum<S: Algebra>(series: &Series<S>, order: usize, length: S) -> S {
    let mut sum = series[order].size();
    let length = length.size();
    for n in (0..order).rev() {
        sum = sum * length + series[n].size();
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
    fn orders_grow_by_one_for_each_factor_of_e_squared() {
        // ⌈2 − ½ ln ε⌉ by hand.
        assert_eq!([1e-3, 1e-6, 1e-9, 1e-12, 2.2e-16, 1e-32].map(order_for), [6, 9, 13, 16, 21, 39]);
        assert_eq!([0.0, f64::NAN, 10.0].map(order_for), [39, 5, 5]);
    }

    #[test]
    fn the_last_terms_have_the_size_asked_for() {
        for tolerance in [1e-3, 1e-9, 1e-14, f64::EPSILON] {
            let policy = StepPolicy::new(tolerance, f64::EPSILON);
            let p = policy.order as i32;
            for (last, before) in [(3.0, 1e-3), (1e-7, 1e20), (0.0, 1.0), (1e-200, 0.0)] {
                let h = step_length_from_norms(&policy, last, before);
                let power = |n: i32| libm::pow(h, f64::from(n));
                let largest = (last * power(p)).max(before * power(p - 1));
                let asked = TERM_TO_TOLERANCE * tolerance * tolerance / (tolerance + TIGHTENED_BELOW * f64::EPSILON);
                // 0.4 % of h to the power p, and 0.01 of the logarithm: 10 %.
                assert!((largest / asked - 1.0).abs() < 0.1, "{tolerance}: {last} {before} {h}");
            }
            assert_eq!(step_length_from_norms(&policy, 0.0, 0.0), f64::INFINITY);
            for (last, before) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::INFINITY, 1.0), (0.0, f64::INFINITY)] {
                assert!(step_length_from_norms(&policy, last, before).is_nan());
            }
        }
        // A careless request does not step beyond the radius of convergence (1 here).
        assert!(step_length_from_norms(&StepPolicy::new(1e3, f64::EPSILON), 1.0, 1.0) < 0.5);
        // Requests below ε are requests of ε.
        assert_eq!(StepPolicy::new(1e-30, f64::EPSILON), StepPolicy::new(f64::EPSILON, f64::EPSILON));
    }

    #[test]
    fn series_are_those_of_the_solution() {
        // x' = x², x = x0/(1 − x0 t): every coefficient is x0^(n+1), radius 1/x0 exactly.
        let policy = StepPolicy::new(f64::EPSILON, f64::EPSILON);
        let p = policy.order;
        let mut jet = Jet::<f64, Riccati>::new(p);
        jet.expand(&Riccati, &[4.0]);
        for n in 0..=p as i32 {
            let exact = libm::ldexp(1.0, 2 * (n + 1));
            assert!((jet.state[0][n as usize] / exact - 1.0).abs() < 20.0 * f64::EPSILON, "order {n}");
        }
        // ‖x_n‖ = 4^n: the length is a fixed fraction of the radius.
        let expected =
            0.25 * libm::pow(TERM_TO_TOLERANCE * f64::EPSILON / (1.0 + TIGHTENED_BELOW), 1.0 / (p - 1) as f64);
        let length = jet.step_length(&Riccati, &[4.0], ErrorNorm::WithColumns, &policy);
        assert!((length / expected - 1.0).abs() < 0.01, "{length} {expected}");
        let value = horner(&jet.state[0], p, expected);
        let exact = 4.0 / (1.0 - 4.0 * expected);
        assert!((value / exact - 1.0).abs() < 4.0 * f64::EPSILON, "{value} {exact}");
        assert!(absolute_sum(&jet.state[0], p, -expected) >= exact * (1.0 - 1e-15));
    }
}
