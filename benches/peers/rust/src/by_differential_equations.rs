//! `differential-equations`: DOP853 with the crate's own event and interpolant.

use crate::Problem;
use differential_equations::prelude::*;

struct Adapter<P>(P);

impl<P: Problem<N>, const N: usize> ODE<f64, [f64; N]> for Adapter<P> {
    #[inline(always)]
    fn diff(&self, _: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        *dydt = self.0.rates(y);
    }
}

impl<P: Problem<N>, const N: usize> Event<f64, [f64; N]> for Adapter<P> {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Negative, Some(1))
    }
    fn event(&self, _: f64, y: &[f64; N]) -> f64 {
        self.0.event(y)
    }
}

pub fn first<P: Problem<N>, const N: usize>(problem: P, y: [f64; N], tolerance: f64, _: f64) -> Option<f64> {
    let system = Adapter(problem);
    let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance);
    let solution = IVP::ode(&system, 0.0, 100.0, y).t_eval(vec![1e3]).event(&system).method(method).solve().ok()?;
    solution.t.last().copied()
}
