//! `ode_solvers`: DOP853; its `solout` stops after the step in which the event falls through zero.

use crate::{Problem, cubic_root, newton};
use nalgebra::SVector;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};

#[derive(Clone, Copy)]
struct Last<const N: usize> {
    t: f64,
    y: [f64; N],
    event: f64,
    slope: f64,
}

struct Watched<'a, P, const N: usize> {
    problem: P,
    watch: Option<&'a std::cell::Cell<(Last<N>, Last<N>)>>,
}

impl<P: Problem<N>, const N: usize> System<f64, SVector<f64, N>> for Watched<'_, P, N> {
    #[inline(always)]
    fn system(&self, _: f64, y: &SVector<f64, N>, dy: &mut SVector<f64, N>) {
        *dy = SVector::from(self.problem.rates(&y.data.0[0]));
    }
    fn solout(&mut self, t: f64, y: &SVector<f64, N>, dy: &SVector<f64, N>) -> bool {
        let Some(watch) = self.watch else { return false };
        let y = y.data.0[0];
        let here = Last { t, y, event: self.problem.event(&y), slope: self.problem.event_rate(&y, &dy.data.0[0]) };
        let (_, before) = watch.get();
        watch.set((before, here));
        before.event > 0.0 && here.event <= 0.0
    }
}

fn go<P: Problem<N>, const N: usize>(problem: P, y: [f64; N], length: f64, tolerance: f64) -> Option<[f64; N]> {
    if length == 0.0 {
        return Some(y);
    }
    let system = Watched { problem, watch: None };
    // One step, split only if it must be.
    let mut solver = Dop853::from_param(
        system, 0.0, length, length, SVector::from(y), tolerance, tolerance, 0.9, 0.0, 0.333, 6.0, length, length, 100_000, 1000,
        OutputType::Sparse,
    );
    solver.integrate().ok()?;
    solver.y_out().last().map(|y| y.data.0[0])
}

pub fn first<P: Problem<N>, const N: usize>(problem: P, y: [f64; N], tolerance: f64, _: f64) -> Option<f64> {
    let start = Last { t: 0.0, y, event: 0.0, slope: 0.0 };
    let watch = std::cell::Cell::new((start, start));
    let system = Watched { problem, watch: Some(&watch) };
    let mut solver = Dop853::new(system, 0.0, 1e3, 1e3, SVector::from(y), tolerance, tolerance);
    solver.set_output(OutputType::Sparse);
    solver.integrate().ok()?;
    let (before, after) = watch.get();
    let offset = cubic_root(after.t - before.t, [before.event, after.event], [before.slope, after.slope]);
    let at = go(problem, before.y, offset, tolerance)?;
    Some(newton(&problem, before.t + offset, at, tolerance, |length, y| go(problem, y, length, tolerance).unwrap_or(y)))
}
