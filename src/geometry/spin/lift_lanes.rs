//! Conjugate times of many starts by the lifted flow, eight at a time: [`super::lift`] in lanes.
//!
//! Result for result the bits of [`super::lift::first_conjugate_time_by_integration`].

use super::lift::{ConjugateScalar, IntegratedConjugate, LiftError, Lifted, LiftedState, SpinLift, posed};
use crate::numerics::counts::Work;
use crate::numerics::lanes::dispatch::{LaneWork, dispatch};
use crate::numerics::pack::Pack;
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{IntegrationError, Settings};
use crate::numerics::taylor::lanes::{FirstZero, LaneArrival, Starts, integrate_lanes};

/// The order to which J vanishes at the start (see [`super::lift`]).
const VANISHING_ORDER: usize = 3;

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
        let outcomes = starts.iter().map(|_| Err(LiftError::NoneBefore { t_max })).collect();
        let mut queue = Queue { starts, t_max, next: 0, loaded: [0; 8], outcomes };
        let flow = WithColumns { flow: SpinLift { half_inverse_k_squared: P::ONE }, parameters: [()] };
        let settings = Settings::new(tolerance);
        integrate_lanes(flow, &FirstZero(ConjugateScalar), VANISHING_ORDER, &settings, &mut queue);
        queue.outcomes
    }
}

/// The starts that are left, and what became of the others.
struct Queue<'a> {
    starts: &'a [(f64, f64)],
    t_max: f64,
    next: usize,
    /// Which start each lane has.
    loaded: [usize; 8],
    outcomes: Vec<Outcome>,
}

impl<P: Pack<Scalar = f64>> Starts<P, Lifted<P>> for Queue<'_> {
    #[inline(always)]
    fn load(&mut self, lane: usize, flow: &mut Lifted<P>, state: &mut LiftedState<P>) -> Option<f64> {
        while let Some(&(k, p_theta)) = self.starts.get(self.next) {
            let index = self.next;
            self.next += 1;
            match posed(k, p_theta) {
                Err(refused) => self.outcomes[index] = Err(refused),
                Ok((one, base)) => {
                    self.loaded[lane] = index;
                    let number = &mut flow.flow.half_inverse_k_squared;
                    *number = number.with_lane(lane, one.half_inverse_k_squared);
                    let start: LiftedState<f64> = Joined { base, columns: Columns([[0.0, -1.0, 0.0]]) };
                    for (member, value) in state.base.iter_mut().zip(start.base) {
                        *member = member.with_lane(lane, value);
                    }
                    for (member, value) in state.columns.0[0].iter_mut().zip(start.columns.0[0]) {
                        *member = member.with_lane(lane, value);
                    }
                    return Some(self.t_max);
                }
            }
        }
        None
    }

    fn finish(&mut self, lane: usize, result: Result<LaneArrival<LiftedState<f64>>, IntegrationError>) {
        let t_max = self.t_max;
        self.outcomes[self.loaded[lane]] = match result {
            Err(error) => Err(LiftError::Integration(error)),
            Ok(LaneArrival { event: None, .. }) => Err(LiftError::NoneBefore { t_max }),
            Ok(LaneArrival { time: t1, state, event: Some((blur, multiplicity)), work }) => {
                let [r1, r2, r3, h1, h2, h3] = state.base;
                Ok((IntegratedConjugate { t1, r: [r1, r2, r3], h: [h1, h2, h3], blur, multiplicity }, work))
            }
        };
    }
}
