//! One step of a pair: its stages, the estimate of its error, its interpolant.
//!
//! The steps keep all of their memory, and none is allocated. A step's own evaluations are made at once; those of the
//! interpolant only when somebody looks inside the step.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::runge_kutta::rate::{Rate, StateOf};
use crate::numerics::runge_kutta::tableau::{Pair, Weights};
use crate::numerics::taylor::flow::{Elements, Flow};
use crate::numerics::taylor::step::Jet;

/// Chebyshev's polynomials `T_j(2θ − 1)`, lowest power of θ first: integers, hence exact.
#[rustfmt::skip]
const SHIFTED_CHEBYSHEV: [[f64; 7]; 7] = [
    [ 1.0,   0.0,    0.0,     0.0,    0.0,     0.0,    0.0],
    [-1.0,   2.0,    0.0,     0.0,    0.0,     0.0,    0.0],
    [ 1.0,  -8.0,    8.0,     0.0,    0.0,     0.0,    0.0],
    [-1.0,  18.0,  -48.0,    32.0,    0.0,     0.0,    0.0],
    [ 1.0, -32.0,  160.0,  -256.0,  128.0,     0.0,    0.0],
    [-1.0,  50.0, -400.0,  1120.0, -1280.0,  512.0,    0.0],
    [ 1.0, -72.0,  840.0, -3584.0,  6912.0, -6144.0, 2048.0],
];

/// The stages of one step after the other, and its interpolant.
pub struct Stepper<P: Pair, S: Real, R: Rate<S>> {
    rates: P::Stages<StateOf<S, R>>,
    workspace: R::Workspace,
    interpolant: Jet<S, R::Seen>,
}

impl<P: Pair, S: Real, R: Rate<S>> Stepper<P, S, R> {
    const DIMENSION: usize = <StateOf<S, R> as Elements<S>>::LEN;
    /// Degree of the interpolant.
    const DEGREE: usize = P::DENSE.len() + 1;

    /// Room for the steps of this flow.
    pub fn new() -> Self {
        let zero = StateOf::<S, R>::filled(S::ZERO);
        Stepper { rates: P::Stages::filled(zero), workspace: R::workspace(), interpolant: Jet::new(Self::DEGREE) }
    }

    /// Evaluates the right-hand side, and counts it.
    #[inline(always)]
    pub fn evaluate(&mut self, flow: &R, time: S, state: &StateOf<S, R>, work: &mut Work) -> StateOf<S, R> {
        work.flow_evaluations += 1;
        work.tangent_evaluations += <R::Seen as Flow<S>>::COLUMNS as u64;
        flow.rate(time, state, &mut self.workspace)
    }

    /// The first stage: the rate at the start of the step.
    pub fn start(&self) -> &StateOf<S, R> {
        self.rates.get(0)
    }

    /// Sets the first stage to the rate at the start of the step.
    pub fn set_start(&mut self, rate: StateOf<S, R>) {
        *self.rates.get_mut(0) = rate;
    }

    /// The rate at the end of the step, once [`Self::finish`] has evaluated it.
    pub fn end(&self) -> &StateOf<S, R> {
        self.rates.get(P::STAGES)
    }

    /// `length · Σ w_j k_j`.
    #[inline(always)]
    fn combined(&self, weights: Weights, length: S) -> StateOf<S, R> {
        let mut sum = StateOf::<S, R>::filled(S::ZERO);
        for &(j, weight) in weights {
            let (rate, weight) = (self.rates.get(j), S::from_f64(weight));
            for i in 0..Self::DIMENSION {
                *sum.get_mut(i) += weight * *rate.get(i);
            }
        }
        for i in 0..Self::DIMENSION {
            *sum.get_mut(i) *= length;
        }
        sum
    }

    #[inline(always)]
    fn stage(&mut self, i: usize, flow: &R, time: S, state: &StateOf<S, R>, length: S, work: &mut Work) {
        let mut at = self.combined(P::WEIGHTS[i], length);
        for c in 0..Self::DIMENSION {
            *at.get_mut(c) += *state.get(c);
        }
        *self.rates.get_mut(i) = self.evaluate(flow, time + S::from_f64(P::NODES[i]) * length, &at, work);
    }

    /// All stages but the first; the increment of the state over the step.
    pub fn advance(&mut self, flow: &R, time: S, state: &StateOf<S, R>, length: S, work: &mut Work) -> StateOf<S, R> {
        // Written out, each stage has its numbers in its code: a quarter less time on nine equations than in a loop.
        const { assert!(P::STAGES <= 16, "more stages than are written out") };
        macro_rules! stages {
            ($($i:literal)*) => {$(
                if $i < P::STAGES {
                    self.stage($i, flow, time, state, length, work);
                }
            )*};
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        self.combined(P::WEIGHTS[P::STAGES], length)
    }

    /// The estimated error of the step just made, relative to the scales, over the leading components: their largest
    /// (Hairer's program takes the root mean square). Not a number if a stage is not finite.
    pub fn error(&self, scales: &StateOf<S, R>, components: usize, length: S) -> f64 {
        let mut norms = [0.0_f64; 2];
        for (norm, weights) in norms.iter_mut().zip(P::ESTIMATES) {
            let difference = self.combined(weights, length);
            for i in 0..components {
                let error = difference.get(i).to_f64();
                // A component without error counts nothing, even on a scale of zero.
                let relative = if error == 0.0 { 0.0 } else { (error / scales.get(i).to_f64()).abs() };
                *norm = if relative > *norm || relative.is_nan() { relative } else { *norm };
            }
        }
        if norms.iter().any(|norm| norm.is_nan()) { f64::NAN } else { P::estimate(norms) }
    }

    /// Evaluates the rate at the end of the step, which is the next step's first stage.
    pub fn finish(&mut self, flow: &R, time: S, state: &StateOf<S, R>, work: &mut Work) {
        *self.rates.get_mut(P::STAGES) = self.evaluate(flow, time, state, work);
    }

    /// Evaluates the further stages and forms the interpolant, after [`Self::advance`] and [`Self::finish`].
    ///
    /// It is the polynomial that runs from the state to the state plus increment. Error inside the step:
    /// `h^(DENSE_ORDER + 1)`, beside a few ε of the increment.
    pub fn interpolate(
        &mut self,
        flow: &R,
        time: S,
        state: &StateOf<S, R>,
        increment: &StateOf<S, R>,
        length: S,
        work: &mut Work,
    ) {
        for i in P::STAGES + 1..P::WEIGHTS.len() {
            self.stage(i, flow, time, state, length, work);
        }
        let zero = StateOf::<S, R>::filled(S::ZERO);
        // Coefficients of Q in y(θ) = y + θ Δ + θ (1 − θ) Q(θ), by powers of θ.
        let mut powers = [zero; SHIFTED_CHEBYSHEV.len()];
        for (degree, (weights, chebyshev)) in P::DENSE.iter().zip(&SHIFTED_CHEBYSHEV).enumerate() {
            let part = self.combined(weights, length);
            for (power, &integer) in powers.iter_mut().zip(&chebyshev[..=degree]) {
                for i in 0..Self::DIMENSION {
                    *power.get_mut(i) += S::from_f64(integer) * *part.get(i);
                }
            }
        }
        let inverse = S::ONE / length;
        for i in 0..Self::DIMENSION {
            let series = self.interpolant.state.get_mut(i);
            series[0] = *state.get(i);
            series[1] = (*increment.get(i) + *powers[0].get(i)) * inverse;
            let mut unit = inverse;
            for n in 2..=Self::DEGREE {
                unit *= inverse;
                let above = if n < Self::DEGREE { *powers[n - 1].get(i) } else { S::ZERO };
                series[n] = (above - *powers[n - 2].get(i)) * unit;
            }
        }
    }

    /// The interpolant as observers see it: series of the state about the start of the step. Its auxiliaries are zero.
    pub fn interpolant(&self) -> &Jet<S, R::Seen> {
        &self.interpolant
    }
}

impl<P: Pair, S: Real, R: Rate<S>> Default for Stepper<P, S, R> {
    fn default() -> Self {
        Self::new()
    }
}
