//! Conjugate times of many starts by the flow (9), eight at a time: [`super::flow`] in lanes.
//!
//! Result for result the bits of [`super::flow::first_conjugate_time_by_integration`] with `armed_after = 0`.

use super::flow::{FlowError, IntegratedConjugate, SerretAndoyerFlow, posed};
use crate::numerics::lanes::dispatch::{LaneWork, dispatch};
use crate::numerics::pack::Pack;
use crate::numerics::taylor::events::Component;
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{IntegrationError, Settings};
use crate::numerics::taylor::lanes::{FirstZero, LaneArrival, Starts, integrate_lanes};

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
        let outcomes = starts.iter().map(|_| Err(FlowError::NoneBefore { t_max })).collect();
        let mut queue = Queue { starts, t_max, next: 0, loaded: [0; 8], outcomes };
        let flow = SerretAndoyerFlow { inverse_inertia: [P::ONE; 3], p_x: P::ONE, alpha: P::ONE, beta: P::ONE };
        let system = WithColumns { flow, parameters: [P::ZERO] };
        integrate_lanes(system, &FirstZero(Component(5)), 1, &Settings::new(tolerance), &mut queue);
        queue.outcomes
    }
}

/// The starts that are left, and what became of the others.
struct Queue<'a> {
    starts: &'a [FlowStart],
    t_max: f64,
    next: usize,
    /// Which start each lane has.
    loaded: [usize; 8],
    outcomes: Vec<Outcome>,
}

impl<P: Pack<Scalar = f64>> Starts<P, System<P>> for Queue<'_> {
    #[inline(always)]
    fn load(&mut self, lane: usize, system: &mut System<P>, state: &mut State<P>) -> Option<f64> {
        while let Some(start) = self.starts.get(self.next) {
            let index = self.next;
            self.next += 1;
            match posed(start.inverse_inertia, start.y0, start.p_x, start.p_y) {
                Err(refused) => self.outcomes[index] = Err(refused),
                Ok((flow, base)) => {
                    self.loaded[lane] = index;
                    let (column, parameter) = flow.column(&base);
                    let set = |member: &mut P, value: f64| *member = member.with_lane(lane, value);
                    for (member, value) in system.flow.inverse_inertia.iter_mut().zip(flow.inverse_inertia) {
                        set(member, value);
                    }
                    set(&mut system.flow.p_x, flow.p_x);
                    set(&mut system.flow.alpha, flow.alpha);
                    set(&mut system.flow.beta, flow.beta);
                    set(&mut system.parameters[0], parameter);
                    for (member, value) in state.base.iter_mut().zip(base) {
                        set(member, value);
                    }
                    for (member, value) in state.columns.0[0].iter_mut().zip(column) {
                        set(member, value);
                    }
                    return Some(self.t_max);
                }
            }
        }
        None
    }

    fn finish(&mut self, lane: usize, result: Result<LaneArrival<State<f64>>, IntegrationError>) {
        let t_max = self.t_max;
        self.outcomes[self.loaded[lane]] = match result {
            Err(error) => Err(FlowError::Integration(error)),
            Ok(LaneArrival { event: None, .. }) => Err(FlowError::NoneBefore { t_max }),
            Ok(LaneArrival { time: t1, state, event: Some((blur, _)), work }) => {
                let [x, y, ..] = state.base;
                Ok(IntegratedConjugate { t1, x, y, blur, steps: work.steps, work })
            }
        };
    }
}
