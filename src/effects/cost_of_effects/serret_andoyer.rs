//! The Serret-Andoyer flow's effects: oscillating extremals of one start, up to the first conjugate time.
//!
//! Five equations; a column is (δy, δy'), two more. The first column is the variation that keeps the energy, the second the flow's own
//! direction: which one it is makes no difference to its cost. Watched: H of (7). Time is arc length, h = 1/2.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_effects::problem::{EffectSet, Problem, no_such_set, times_until};
use crate::effects::product::failed;
use crate::effects::serret_andoyer::body::Body;
use crate::geometry::serret_andoyer::flow::{
    FlowError, IntegratedConjugate, SerretAndoyerFlow, first_conjugate_time_by_integration,
};
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

/// The Serret-Andoyer flow with its starts: ascending extremals from `(0, y0)`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SerretAndoyer {
    /// The body.
    pub body: Body,
    /// The angle y at the start.
    pub y0: f64,
    /// `ξ1` of the extremals, between cos² y0 and 1.
    pub xi1: Vec<f64>,
}

const CODE: &[&str] = &[
    "effects/cost_of_effects/counted.rs",
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/serret_andoyer.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/serret_andoyer/body.rs",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];
const CODE_TIMED: &[&str] = &[
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/serret_andoyer.rs",
    "effects/cost_of_effects/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/serret_andoyer/body.rs",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];

/// One start.
pub struct Posed {
    xi1: f64,
    momenta: [f64; 2],
    flow: SerretAndoyerFlow<f64>,
    state: [f64; 5],
    end: f64,
    times: Vec<f64>,
}

impl SerretAndoyer {
    fn conjugate(&self, [p_x, p_y]: &[f64; 2], tolerance: f64) -> Result<IntegratedConjugate<f64>, FlowError> {
        let Body { a, b, c } = self.body;
        first_conjugate_time_by_integration(a, b, c, self.y0, *p_x, *p_y, 0.0, T_MAX, tolerance)
    }
}

impl Problem for SerretAndoyer {
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
        name: "serret-andoyer-cost-of-effects",
        summary: "counted work of the Serret-Andoyer flow's integration, by effects and accuracy",
        code: CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "serret-andoyer-time-of-effects",
        summary: "time of the Serret-Andoyer flow's integration on this machine, by effects and accuracy",
        code: CODE_TIMED,
        measurement: true,
    };

    fn pose(&self, samples: usize) -> Result<Vec<Posed>, NodeError> {
        let Body { a, b, c } = self.body;
        let one = |&xi1: &f64| {
            let doing = format!("A, B, C = {a:?}, {b:?}, {c:?}, y0 = {:?}, xi1 = {xi1:?}", self.y0);
            let momenta = self.body.ascending_momenta(self.y0, xi1);
            let found = self.conjugate(&momenta, f64::EPSILON).map_err(failed(&doing))?;
            let (flow, state) = SerretAndoyerFlow::new([a, b, c], self.y0, momenta[0], momenta[1]);
            Ok(Posed { xi1, momenta, flow, state, end: found.t1, times: times_until(found.t1, samples) })
        };
        self.xi1.iter().map(one).collect()
    }

    fn integrate(&self, posed: &Posed, set: EffectSet, tolerance: f64) -> Result<Work, NodeError> {
        let Posed { xi1, momenta, flow, state, end, times } = posed;
        let flow = *flow;
        let span = (0.0, *end);
        let steering = Settings::new(tolerance);
        let columns = Settings { norm: ErrorNorm::BaseOnly, ..steering };
        let doing = format!("y0 = {:?}, xi1 = {xi1:?}, {}", self.y0, set.name());
        let (first, parameter) = flow.column(state);
        let one = |settings: &Settings| {
            let start = Joined { base: *state, columns: Columns([first]) };
            let system = WithColumns { flow, parameters: [parameter] };
            integrate(&system, &start, span, settings, &mut ()).map(|end| end.work)
        };
        // (y', y'') at the start, with p_x as it is.
        let second = [state[2], (flow.alpha + flow.beta * state[4]) * state[3]];
        let two = |settings: &Settings| {
            let start = Joined { base: *state, columns: Columns([first, second]) };
            let system = WithColumns { flow, parameters: [parameter, 0.0] };
            integrate(&system, &start, span, settings, &mut ()).map(|end| end.work)
        };
        let work = match set {
            EffectSet::Base => integrate(&flow, state, span, &steering, &mut ()).map(|end| end.work),
            EffectSet::OneColumn => one(&steering),
            EffectSet::OneColumnNotSteering => one(&columns),
            EffectSet::TwoColumns => two(&steering),
            EffectSet::TwoColumnsNotSteering => two(&columns),
            EffectSet::Conjugate => {
                let found = self.conjugate(momenta, tolerance).map_err(failed(&doing))?;
                Ok(black_box(found).work)
            }
            EffectSet::SeriesKept => {
                let mut kept = Kept::new();
                let arrival = integrate(&flow, state, span, &steering, &mut kept);
                black_box(&kept);
                arrival.map(|end| end.work)
            }
            EffectSet::StatesAtTimes => {
                let mut sampled = SampleAt::<f64, SerretAndoyerFlow<f64>>::new(times);
                let arrival = integrate(&flow, state, span, &steering, &mut sampled);
                black_box(&sampled.states);
                arrival.map(|end| end.work)
            }
            EffectSet::Monitor => {
                let mut monitor = Invariant::relative(|state: &[f64; 5]| flow.energy(state));
                let arrival = integrate(&flow, state, span, &steering, &mut monitor);
                black_box(monitor.largest_drift());
                arrival.map(|end| end.work)
            }
            other => return Err(no_such_set(other)),
        };
        work.map_err(failed(&doing))
    }

    fn multiplications(&self, set: EffectSet, order: usize) -> Result<u64, NodeError> {
        let one = Counting(1.0);
        let flow = SerretAndoyerFlow { inverse_inertia: [one; 3], p_x: one, alpha: one, beta: one };
        match set {
            EffectSet::Base | EffectSet::SeriesKept | EffectSet::StatesAtTimes | EffectSet::Monitor => {
                Ok(multiplications_in_a_step(&flow, order))
            }
            EffectSet::OneColumn | EffectSet::OneColumnNotSteering | EffectSet::Conjugate => {
                Ok(multiplications_in_a_step(&WithColumns { flow, parameters: [one] }, order))
            }
            EffectSet::TwoColumns | EffectSet::TwoColumnsNotSteering => {
                Ok(multiplications_in_a_step(&WithColumns { flow, parameters: [one; 2] }, order))
            }
            other => Err(no_such_set(other)),
        }
    }
}
