//! `numeris`: Verner's pair of order 9(8) without interpolation stages. It has neither events nor a stopping rule, so it is told what nobody
//! knows beforehand: it integrates to 1.001 times the conjugate time and goes back by Newton's method.

use crate::{Problem, newton};
use numeris::Vector;
use numeris::ode::{AdaptiveSettings, RKAdaptive, RKV98NoInterp};

fn go<P: Problem<N>, const N: usize>(problem: &P, y: [f64; N], length: f64, settings: &AdaptiveSettings<f64>) -> Option<[f64; N]> {
    if length == 0.0 {
        return Some(y);
    }
    let rates = |_: f64, y: &Vector<f64, N>| Vector::from_array(problem.rates(&core::array::from_fn(|i| y[i])));
    let end = RKV98NoInterp::integrate(0.0, length, &Vector::from_array(y), rates, settings).ok()?;
    Some(core::array::from_fn(|i| end.y[i]))
}

pub fn first<P: Problem<N>, const N: usize>(problem: P, y: [f64; N], tolerance: f64, t1: f64) -> Option<f64> {
    let settings = |step| AdaptiveSettings {
        abs_tol: tolerance,
        rel_tol: tolerance,
        min_step: 1e-12,
        initial_step: step,
        ..AdaptiveSettings::default()
    };
    let end = 1.001 * t1;
    let y = go(&problem, y, end, &settings(None))?;
    Some(newton(&problem, end, y, tolerance, |length, y| go(&problem, y, length, &settings(Some(length.abs()))).unwrap_or(y)))
}
