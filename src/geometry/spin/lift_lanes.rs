//! Conjugate times of many starts by the lifted flow, eight at a time: [`super::lift`] in lanes.
//!
//! Result for result the bits of [`super::lift::first_conjugate_time_by_integration`].

use super::lift::{
    ConjugateScalar, IntegratedConjugate, LiftError, Lifted, LiftedState, SpinLift, VANISHING_ORDER, posed,
};
use crate::numerics::counts::Work;
use crate::numerics::lanes::dispatch::{LaneWork, dispatch};
use crate::numerics::pack::Pack;
use crate::numerics::taylor::flow::WithColumns;
use crate::numerics::taylor::integrator::{IntegrationError, Settings};
use crate::numerics::taylor::lanes::{FirstZero, LaneArrival, Slice, integrate_lanes, set_lane};

/// The outcome for one start.
pub type Outcome = Result<(IntegratedConjugate<f64>, Work), LiftError>;

/// The first conjugate times up to `t_max` of the starts `(k, p_θ)`, in their order.
///
/// Domain, guarantee and errors of each as for [`super::lift::first_conjugate_time_by_integration`].
pub fn first_conjugate_times_by_integration(starts: &[(f64, f64)], tolerance: f64, t_max: f64) -> Vec<Outcome> {
    dispatch(Integrate { starts, tolerance, t_max })
}

struct Integrate<'a> {
    starts: &'a [(f64, f64)],
    tolerance: f64,
    t_max: f64,
}

impl LaneWork for Integrate<'_> {
    type Output = Vec<Outcome>;

    #[inline(always)]
    fn run<P: Pack<Scalar = f64>>(self) -> Vec<Outcome> {
        let Self { starts, tolerance, t_max } = self;
        let load = |&(k, p_theta): &(f64, f64), lane: usize, flow: &mut Lifted<P>, state: &mut LiftedState<P>| {
            let (one, base) = posed(k, p_theta).map_err(|error| Box::new(Err(error)))?;
            set_lane(lane, std::slice::from_mut(&mut flow.flow.half_inverse_k_squared), &[one.half_inverse_k_squared]);
            set_lane(lane, &mut state.base, &base);
            set_lane(lane, &mut state.columns.0[0], &[0.0, -1.0, 0.0]);
            Ok(t_max)
        };
        let done = |_: &(f64, f64), result: Result<LaneArrival<LiftedState<f64>>, IntegrationError>| {
            let LaneArrival { time: t1, state, event, work } = result?;
            let (blur, multiplicity) = event.ok_or(LiftError::NoneBefore { t_max })?;
            let [r1, r2, r3, h1, h2, h3] = state.base;
            Ok((IntegratedConjugate { t1, r: [r1, r2, r3], h: [h1, h2, h3], blur, multiplicity }, work))
        };
        let mut queue = Slice::new(starts, load, done);
        let flow = WithColumns { flow: SpinLift { half_inverse_k_squared: P::ONE }, parameters: [()] };
        let settings = Settings::new(tolerance);
        integrate_lanes(flow, &FirstZero(ConjugateScalar), VANISHING_ORDER, &settings, &mut queue);
        queue.outcomes()
    }
}
