//! Conjugate times of many starts by the flow (9), eight at a time: [`super::flow`] in lanes.
//!
//! Result for result the bits of [`super::flow::first_conjugate_time_by_integration`] with `armed_after = 0`.

use super::flow::{FlowError, IntegratedConjugate, SerretAndoyerFlow, posed};
use crate::numerics::lanes::dispatch::{LaneWork, dispatch};
use crate::numerics::pack::Pack;
use crate::numerics::taylor::events::Component;
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{IntegrationError, Settings};
use crate::numerics::taylor::lanes::{FirstZero, LaneArrival, Slice, integrate_lanes, set_lane};

type System<S> = WithColumns<SerretAndoyerFlow<S>, S, 1>;
type State<T> = Joined<[T; 5], Columns<[T; 2], 1>>;

/// One start: the metric and the momenta of (9).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowStart {
    /// A, B, C: the inverse moments of inertia.
    pub inverse_inertia: [f64; 3],
    /// The angle y (x is zero).
    pub y0: f64,
    /// The conserved momentum.
    pub p_x: f64,
    /// The momentum p_y.
    pub p_y: f64,
}

/// The outcome for one start.
pub type Outcome = Result<IntegratedConjugate<f64>, FlowError>;

/// The first conjugate times up to `t_max > 0` of the starts, in their order.
///
/// Domain, guarantee and errors of each as for [`super::flow::first_conjugate_time_by_integration`].
pub fn first_conjugate_times_by_integration(starts: &[FlowStart], tolerance: f64, t_max: f64) -> Vec<Outcome> {
    dispatch(Integrate { starts, tolerance, t_max })
}

struct Integrate<'a> {
    starts: &'a [FlowStart],
    tolerance: f64,
    t_max: f64,
}

impl LaneWork for Integrate<'_> {
    type Output = Vec<Outcome>;

    #[inline(always)]
    fn run<P: Pack<Scalar = f64>>(self) -> Vec<Outcome> {
        let Self { starts, tolerance, t_max } = self;
        let load = |start: &FlowStart, lane: usize, system: &mut System<P>, state: &mut State<P>| {
            let (flow, base) =
                posed(start.inverse_inertia, start.y0, start.p_x, start.p_y).map_err(|error| Box::new(Err(error)))?;
            let (column, parameter) = flow.column(&base);
            let of = &mut system.flow;
            set_lane(lane, &mut of.inverse_inertia, &flow.inverse_inertia);
            for (member, value) in [(&mut of.p_x, flow.p_x), (&mut of.alpha, flow.alpha), (&mut of.beta, flow.beta)] {
                *member = member.with_lane(lane, value);
            }
            set_lane(lane, &mut system.parameters, &[parameter]);
            set_lane(lane, &mut state.base, &base);
            set_lane(lane, &mut state.columns.0[0], &column);
            Ok(t_max)
        };
        let done = |_: &FlowStart, result: Result<LaneArrival<State<f64>>, IntegrationError>| {
            let LaneArrival { time: t1, state, event, work } = result?;
            let (blur, _) = event.ok_or(FlowError::NoneBefore { t_max })?;
            let [x, y, ..] = state.base;
            Ok(IntegratedConjugate { t1, x, y, blur, steps: work.steps, work })
        };
        let mut queue = Slice::new(starts, load, done);
        let flow = SerretAndoyerFlow { inverse_inertia: [P::ONE; 3], p_x: P::ONE, alpha: P::ONE, beta: P::ONE };
        let system = WithColumns { flow, parameters: [P::ZERO] };
        integrate_lanes(system, &FirstZero(Component(5)), 1, &Settings::new(tolerance), &mut queue);
        queue.outcomes()
    }
}
