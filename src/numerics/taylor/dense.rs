//! States between steps, from the steps' own polynomials: streamed at given times, or kept to be asked later.
//!
//! [`SampleAt`] evaluates inside the step in which a time falls and keeps no coefficient. [`Kept`] stores the series of
//! every step, only because it was asked to. The accuracy is that of the steps: the polynomial that is evaluated is the
//! one that carries the integration on.

use crate::numerics::counts::Work;
use crate::numerics::real::Real;
use crate::numerics::taylor::flow::{Elements, Flow};
use crate::numerics::taylor::integrator::{Compensated, IntegrationError, Observer, Settings, Step, integrate};
use std::ops::ControlFlow;

/// Evaluates the state at given times, ordered in the direction of the integration.
pub struct SampleAt<'t, S: Real, F: Flow<S>> {
    times: &'t [S],
    /// The states at the times passed so far.
    pub states: Vec<F::State<S>>,
}

impl<'t, S: Real, F: Flow<S>> SampleAt<'t, S, F> {
    /// The times must be ordered in the direction of the integration, none before its start.
    pub fn new(times: &'t [S]) -> Self {
        SampleAt { times, states: Vec::with_capacity(times.len()) }
    }
}

impl<S: Real, F: Flow<S>> Observer<S, F> for SampleAt<'_, S, F> {
    fn looks_into(&self, start: &Compensated<S>, length: S) -> bool {
        let next = self.times.get(self.states.len());
        next.is_some_and(|&time| ((time - start.value) - start.rest).abs() <= length.abs())
    }

    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        while let Some(&time) = self.times.get(self.states.len()) {
            let offset = (time - step.start.value) - step.start.rest;
            if offset.abs() > step.length.abs() {
                return ControlFlow::Continue(());
            }
            work.dense_points += 1;
            self.states.push(step.state(offset));
        }
        ControlFlow::Break(())
    }
}

/// The states at the given times (any order, before or after the start), for a solution that is at `initial` at `start`.
///
/// # Errors
/// [`IntegrationError`], with time and state; nothing is returned of a trajectory that can't be completed.
pub fn sample<S: Real, F: Flow<S>>(
    flow: &F,
    initial: &F::State<S>,
    start: S,
    times: &[S],
    settings: &Settings,
) -> Result<(Vec<F::State<S>>, Work), IntegrationError> {
    let mut states = vec![*initial; times.len()];
    let mut work = Work { state_dimension: <F::State<S> as Elements<S>>::LEN as u64, ..Work::default() };
    for &time in times {
        if !time.is_finite() {
            return Err(IntegrationError::Request { name: "time", value: time.to_f64() });
        }
    }
    let mut order: Vec<usize> = (0..times.len()).collect();
    order.sort_by(|&i, &j| times[i].to_f64().total_cmp(&times[j].to_f64()));
    let (mut before, after): (Vec<usize>, Vec<usize>) = order.iter().partition(|&&i| times[i] < start);
    before.reverse();
    for indices in [before, after] {
        let ordered: Vec<S> = indices.iter().map(|&i| times[i]).collect();
        let Some(&end) = ordered.last() else { continue };
        let mut observer = SampleAt::<S, F>::new(&ordered);
        let arrival = integrate(flow, initial, (start, end), settings, &mut observer)?;
        work = work.plus(arrival.work);
        // A span that ends at its start has no step: its times keep the initial state.
        for (&i, state) in indices.iter().zip(&observer.states) {
            states[i] = *state;
        }
    }
    Ok((states, work))
}

/// The series of one step, kept.
#[derive(Clone, Debug)]
struct KeptStep<S> {
    start: S,
    start_rest: S,
    length: S,
    components: usize,
    /// Coefficients of all components, `order + 1` each.
    coefficients: Vec<S>,
}

/// Keeps the series of every step, to be evaluated at any time of the span afterwards.
#[derive(Clone, Debug, Default)]
pub struct Kept<S> {
    steps: Vec<KeptStep<S>>,
}

impl<S: Real> Kept<S> {
    /// Nothing kept yet.
    pub fn new() -> Self {
        Kept { steps: Vec::new() }
    }

    /// Number of coefficients kept.
    pub fn coefficients(&self) -> usize {
        self.steps.iter().map(|step| step.coefficients.len()).sum()
    }

    /// The components at a time, or none when the time was not integrated over.
    pub fn at(&self, time: S) -> Option<Vec<S>> {
        let inside = |step: &&KeptStep<S>| {
            let offset = (time - step.start) - step.start_rest;
            offset * step.length >= S::ZERO && offset.abs() <= step.length.abs()
        };
        let step = self.steps.iter().find(inside)?;
        let offset = (time - step.start) - step.start_rest;
        let chunk = step.coefficients.len() / step.components.max(1);
        Some(
            step.coefficients
                .chunks_exact(chunk.max(1))
                .map(|series| series.iter().rev().fold(S::ZERO, |sum, &c| sum * offset + c))
                .collect(),
        )
    }
}

impl<S: Real, F: Flow<S>> Observer<S, F> for Kept<S> {
    fn observe(&mut self, step: &Step<'_, S, F>, work: &mut Work) -> ControlFlow<()> {
        let components = <F::State<S> as Elements<S>>::LEN;
        let mut coefficients = Vec::with_capacity(components * (step.jet.order() + 1));
        for i in 0..components {
            coefficients.extend_from_slice(&step.jet.state.get(i)[..=step.jet.order()]);
        }
        work.kept_coefficients += coefficients.len() as u64;
        let (start, start_rest) = (step.start.value, step.start.rest);
        self.steps.push(KeptStep { start, start_rest, length: step.length, components, coefficients });
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::taylor::flow::Series;
    use crate::numerics::taylor::step::order_for;

    /// `x'' = −x`: cosine and sine.
    struct Circle;
    impl Flow<f64> for Circle {
        type State<T: Copy> = [T; 2];
        type Auxiliary<T: Copy> = [T; 0];
        fn coefficients(&self, n: usize, x: &[Series<f64>; 2], _: &mut [Series<f64>; 0]) -> [f64; 2] {
            [-x[1][n], x[0][n]]
        }
        fn scales(&self, _: &[f64; 2]) -> [f64; 2] {
            [1.0; 2]
        }
    }

    #[test]
    fn samples_in_any_order_on_both_sides_of_the_start() {
        // Oracle: cosine and sine of libm (below one ε); an entire function over a few steps: 5 ε.
        let times = [3.0, -2.0, 0.0, 10.0, -7.5, 0.25, 10.0];
        let (states, work) = sample(&Circle, &[1.0, 0.0], 0.0, &times, &Settings::new(f64::EPSILON)).unwrap();
        for (t, [x, y]) in times.iter().zip(states) {
            assert!((x - libm::cos(*t)).abs() < 5.0 * f64::EPSILON, "{t}: {x}");
            assert!((y - libm::sin(*t)).abs() < 5.0 * f64::EPSILON, "{t}: {y}");
        }
        assert_eq!((work.dense_points, work.event_evaluations, work.state_dimension), (7, 0, 2));
        assert!(sample(&Circle, &[1.0, 0.0], 0.0, &[f64::NAN], &Settings::new(1e-9)).is_err());
        assert!(sample(&Circle, &[1.0, 0.0], 0.0, &[], &Settings::new(1e-9)).unwrap().0.is_empty());
    }

    #[test]
    fn kept_polynomials_answer_later() {
        let mut kept = Kept::new();
        let end = integrate(&Circle, &[1.0, 0.0], (0.0, -20.0), &Settings::new(1e-12), &mut kept).unwrap();
        assert_eq!(kept.coefficients() as u64, end.work.steps * 2 * (order_for(1e-12) as u64 + 1));
        assert_eq!(kept.coefficients() as u64, end.work.kept_coefficients);
        for i in 0..=100 {
            let t = -0.2 * f64::from(i);
            let state = kept.at(t).unwrap();
            assert!((state[0] - libm::cos(t)).abs() < 1e-12 && (state[1] - libm::sin(t)).abs() < 1e-12, "{t}");
        }
        assert_eq!(kept.at(0.1), None);
        assert_eq!(kept.at(-20.1), None);
    }
}
