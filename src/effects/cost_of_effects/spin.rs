//! The spin problem's effects: the lift to R³ × so(3)*, starts on the equator, up to the first conjugate time.
//!
//! Six equations; a column is δh, three more. The first column is the variation in p_θ, the second the flow's own direction: which one
//! it is makes no difference to its cost. Watched: `H`.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_effects::problem::{EffectSet, Problem, no_such_set, times_until};
use crate::effects::product::failed;
use crate::geometry::spin::lift::{SpinLift, first_conjugate_time_by_integration};
use crate::numerics::counting::Counting;
use crate::numerics::counts::Work;
use crate::numerics::taylor::dense::{Kept, SampleAt};
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{Settings, integrate};
use crate::numerics::taylor::monitor::Invariant;
use crate::numerics::taylor::multiplications::multiplications_in_a_step;
use crate::numerics::taylor::step::ErrorNorm;
use serde::Serialize;
use std::hint::black_box;

/// Later than every conjugate time that is asked for here.
const T_MAX: f64 = 1e6;

/// The spin problem with its starts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spin {
    /// `k > 0`.
    pub k: f64,
    /// `p_θ(0)` of the starts.
    pub p_theta: Vec<f64>,
}

const CODE: &[&str] = &[
    "effects/cost_of_effects/counted.rs",
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/spin.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "geometry/spin",
    "numerics",
    "table",
];
const CODE_TIMED: &[&str] = &[
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/spin.rs",
    "effects/cost_of_effects/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "geometry/spin",
    "numerics",
    "table",
];

/// One start.
pub struct Posed {
    p_theta: f64,
    state: [f64; 6],
    end: f64,
    times: Vec<f64>,
}

impl Problem for Spin {
    type Posed = Posed;
    const SETS: &'static [EffectSet] = &[
        EffectSet::Base,
        EffectSet::OneColumn,
        EffectSet::OneColumnNotSteering,
        EffectSet::TwoColumns,
        EffectSet::TwoColumnsNotSteering,
        EffectSet::Conjugate,
        EffectSet::SeriesKept,
        EffectSet::StatesAtTimes,
        EffectSet::Monitor,
    ];
    const COUNTED: &'static Kind = &Kind {
        name: "spin-cost-of-effects",
        summary: "counted work of the spin problem's integration, by effects and accuracy",
        code: CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "spin-time-of-effects",
        summary: "time of the spin problem's integration on this machine, by effects and accuracy",
        code: CODE_TIMED,
        measurement: true,
    };

    fn pose(&self, samples: usize) -> Result<Vec<Posed>, NodeError> {
        let one = |&p_theta: &f64| {
            let doing = format!("k = {:?}, p_theta = {p_theta:?}", self.k);
            let (found, _) =
                first_conjugate_time_by_integration(self.k, p_theta, f64::EPSILON, T_MAX).map_err(failed(&doing))?;
            let state = [1.0, 0.0, 0.0, 0.0, -p_theta, 2.0];
            Ok(Posed { p_theta, state, end: found.t1, times: times_until(found.t1, samples) })
        };
        self.p_theta.iter().map(one).collect()
    }

    fn integrate(&self, posed: &Posed, set: EffectSet, tolerance: f64) -> Result<Work, NodeError> {
        let Posed { p_theta, state, end, times } = posed;
        let flow = SpinLift::new(self.k);
        let span = (0.0, *end);
        let steering = Settings::new(tolerance);
        let columns = Settings { norm: ErrorNorm::BaseOnly, ..steering };
        let doing = format!("k = {:?}, p_theta = {p_theta:?}, {}", self.k, set.name());
        let first = [0.0, -1.0, 0.0];
        let one = |settings: &Settings| {
            let start = Joined { base: *state, columns: Columns([first]) };
            integrate(&WithColumns { flow, parameters: [()] }, &start, span, settings, &mut ()).map(|end| end.work)
        };
        // h' at the start.
        let second = [*p_theta, 0.0, 0.0];
        let two = |settings: &Settings| {
            let start = Joined { base: *state, columns: Columns([first, second]) };
            integrate(&WithColumns { flow, parameters: [(); 2] }, &start, span, settings, &mut ()).map(|end| end.work)
        };
        let work = match set {
            EffectSet::Base => integrate(&flow, state, span, &steering, &mut ()).map(|end| end.work),
            EffectSet::OneColumn => one(&steering),
            EffectSet::OneColumnNotSteering => one(&columns),
            EffectSet::TwoColumns => two(&steering),
            EffectSet::TwoColumnsNotSteering => two(&columns),
            EffectSet::Conjugate => {
                let (found, work) =
                    first_conjugate_time_by_integration(self.k, *p_theta, tolerance, T_MAX).map_err(failed(&doing))?;
                black_box(found);
                Ok(work)
            }
            EffectSet::SeriesKept => {
                let mut kept = Kept::new();
                let arrival = integrate(&flow, state, span, &steering, &mut kept);
                black_box(&kept);
                arrival.map(|end| end.work)
            }
            EffectSet::StatesAtTimes => {
                let mut sampled = SampleAt::<f64, SpinLift<f64>>::new(times);
                let arrival = integrate(&flow, state, span, &steering, &mut sampled);
                black_box(&sampled.states);
                arrival.map(|end| end.work)
            }
            EffectSet::Monitor => {
                let mut monitor = Invariant::relative(|state: &[f64; 6]| flow.energy(state));
                let arrival = integrate(&flow, state, span, &steering, &mut monitor);
                black_box(monitor.largest_drift());
                arrival.map(|end| end.work)
            }
            other => return Err(no_such_set(other)),
        };
        work.map_err(failed(&doing))
    }

    fn multiplications(&self, set: EffectSet, order: usize) -> Result<u64, NodeError> {
        let flow = SpinLift { half_inverse_k_squared: Counting(1.0) };
        match set {
            EffectSet::Base | EffectSet::SeriesKept | EffectSet::StatesAtTimes | EffectSet::Monitor => {
                Ok(multiplications_in_a_step(&flow, order))
            }
            EffectSet::OneColumn | EffectSet::OneColumnNotSteering | EffectSet::Conjugate => {
                Ok(multiplications_in_a_step(&WithColumns { flow, parameters: [()] }, order))
            }
            EffectSet::TwoColumns | EffectSet::TwoColumnsNotSteering => {
                Ok(multiplications_in_a_step(&WithColumns { flow, parameters: [(); 2] }, order))
            }
            other => Err(no_such_set(other)),
        }
    }
}
