//! The effects on SO(3): Euler's equations of the momentum in the body, up to the second conjugate time.
//!
//! Three equations; a column is (δM, ξ), six more. Which variations the columns are makes no difference to their cost: the unit vectors.
//! Conjugate times need two columns that keep the energy, and no attitude. The attitude is a quaternion under a constant momentum
//! in space, four equations in place of three: the momentum in the body follows from it. Watched: the energy.

use crate::contract::node::{Kind, NodeError};
use crate::effects::cost_of_effects::problem::{EffectSet, Problem, times_until};
use crate::effects::product::failed;
use crate::effects::rotation_group::directions::spread_evenly;
use crate::effects::rotation_group::start::Body;
use crate::geometry::rotation_group::attitude_route::AttitudeFlow;
use crate::geometry::rotation_group::body_flow::BodyFlow;
use crate::geometry::rotation_group::conjugate::first_conjugate_times;
use crate::geometry::rotation_group::metric::Metric;
use crate::numerics::counting::Counting;
use crate::numerics::counts::Work;
use crate::numerics::taylor::dense::{Kept, SampleAt};
use crate::numerics::taylor::flow::{Columns, Joined, WithColumns};
use crate::numerics::taylor::integrator::{IntegrationError, Settings, integrate};
use crate::numerics::taylor::monitor::Invariant;
use crate::numerics::taylor::multiplications::multiplications_in_a_step;
use crate::numerics::taylor::step::ErrorNorm;
use serde::Serialize;
use std::hint::black_box;

/// Conjugate times that are asked for.
const WANTED: usize = 2;

/// The left-invariant metric with its starts: momenta of length 1, spread evenly over all directions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotationGroup {
    /// The body.
    pub body: Body,
    /// Number of directions.
    pub directions: usize,
}

const CODE: &[&str] = &[
    "effects/cost_of_effects/counted.rs",
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/rotation_group.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/rotation_group/directions.rs",
    "effects/arithmetic.rs",
    "effects/rotation_group/start.rs",
    "geometry/rotation_group",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];
const CODE_TIMED: &[&str] = &[
    "effects/cost_of_effects/problem.rs",
    "effects/cost_of_effects/rotation_group.rs",
    "effects/cost_of_effects/timed.rs",
    "effects/counted.rs",
    "effects/product.rs",
    "effects/rotation_group/directions.rs",
    "effects/arithmetic.rs",
    "effects/rotation_group/start.rs",
    "geometry/rotation_group",
    "geometry/serret_andoyer",
    "numerics",
    "table",
];

/// One start.
pub struct Posed {
    metric: Metric<f64>,
    state: [f64; 3],
    end: f64,
    times: Vec<f64>,
}

impl Problem for RotationGroup {
    type Posed = Posed;
    const SETS: &'static [EffectSet] = &[
        EffectSet::Base,
        EffectSet::OneColumn,
        EffectSet::OneColumnNotSteering,
        EffectSet::TwoColumns,
        EffectSet::TwoColumnsNotSteering,
        EffectSet::ThreeColumns,
        EffectSet::ThreeColumnsNotSteering,
        EffectSet::Conjugate,
        EffectSet::SeriesKept,
        EffectSet::StatesAtTimes,
        EffectSet::Attitude,
        EffectSet::Monitor,
    ];
    const COUNTED: &'static Kind = &Kind {
        name: "rotation-group-cost-of-effects",
        summary: "counted work of the integration on SO(3), by effects and accuracy",
        code: CODE,
        measurement: false,
    };
    const TIMED: &'static Kind = &Kind {
        name: "rotation-group-time-of-effects",
        summary: "time of the integration on SO(3) on this machine, by effects and accuracy",
        code: CODE_TIMED,
        measurement: true,
    };

    fn pose(&self, samples: usize) -> Result<Vec<Posed>, NodeError> {
        let metric = self.body.metric()?;
        let one = |state: [f64; 3]| {
            let found = first_conjugate_times(&metric, state, WANTED, f64::EPSILON)
                .map_err(failed(&format!("{:?}, momentum {state:?}", self.body)))?;
            let end = found.times.last().copied().unwrap_or_default();
            Ok(Posed { metric, state, end, times: times_until(end, samples) })
        };
        spread_evenly(self.directions).map(one).collect()
    }

    fn integrate(&self, posed: &Posed, set: EffectSet, tolerance: f64) -> Result<Work, NodeError> {
        let Posed { metric, state, end, times } = posed;
        let inverse_inertia = metric.inverse_inertia();
        let flow = BodyFlow { inverse_inertia };
        let span = (0.0, *end);
        let steering = Settings::new(tolerance);
        let columns = Settings { norm: ErrorNorm::BaseOnly, ..steering };
        let doing = format!("{:?}, momentum {state:?}, {}", self.body, set.name());
        let work = match set {
            EffectSet::Base => integrate(&flow, state, span, &steering, &mut ()).map(|end| end.work),
            EffectSet::OneColumn => with_columns::<1>(posed, &steering),
            EffectSet::OneColumnNotSteering => with_columns::<1>(posed, &columns),
            EffectSet::TwoColumns => with_columns::<2>(posed, &steering),
            EffectSet::TwoColumnsNotSteering => with_columns::<2>(posed, &columns),
            EffectSet::ThreeColumns => with_columns::<3>(posed, &steering),
            EffectSet::ThreeColumnsNotSteering => with_columns::<3>(posed, &columns),
            EffectSet::Conjugate => {
                let found = first_conjugate_times(metric, *state, WANTED, tolerance).map_err(failed(&doing))?;
                Ok(black_box(found).work)
            }
            EffectSet::SeriesKept => {
                let mut kept = Kept::new();
                let arrival = integrate(&flow, state, span, &steering, &mut kept);
                black_box(&kept);
                arrival.map(|end| end.work)
            }
            EffectSet::StatesAtTimes => {
                let mut sampled = SampleAt::<f64, BodyFlow<f64>>::new(times);
                let arrival = integrate(&flow, state, span, &steering, &mut sampled);
                black_box(&sampled.states);
                arrival.map(|end| end.work)
            }
            EffectSet::Attitude => {
                // At the attitude 1 the momentum in space is that in the body.
                let flow = AttitudeFlow { inverse_inertia, space_momentum: *state };
                integrate(&flow, &[1.0, 0.0, 0.0, 0.0], span, &steering, &mut ()).map(|end| end.work)
            }
            EffectSet::Monitor => {
                let mut monitor = Invariant::relative(|state: &[f64; 3]| metric.energy(state));
                let arrival = integrate(&flow, state, span, &steering, &mut monitor);
                black_box(monitor.largest_drift());
                arrival.map(|end| end.work)
            }
        };
        work.map_err(failed(&doing))
    }

    fn multiplications(&self, set: EffectSet, order: usize) -> Result<u64, NodeError> {
        let one = [Counting(1.0); 3];
        let flow = BodyFlow { inverse_inertia: one };
        Ok(match set {
            EffectSet::Base | EffectSet::SeriesKept | EffectSet::StatesAtTimes | EffectSet::Monitor => {
                multiplications_in_a_step(&flow, order)
            }
            EffectSet::OneColumn | EffectSet::OneColumnNotSteering => {
                multiplications_in_a_step(&WithColumns { flow, parameters: [()] }, order)
            }
            EffectSet::TwoColumns | EffectSet::TwoColumnsNotSteering | EffectSet::Conjugate => {
                multiplications_in_a_step(&WithColumns { flow, parameters: [(); 2] }, order)
            }
            EffectSet::ThreeColumns | EffectSet::ThreeColumnsNotSteering => {
                multiplications_in_a_step(&WithColumns { flow, parameters: [(); 3] }, order)
            }
            EffectSet::Attitude => {
                multiplications_in_a_step(&AttitudeFlow { inverse_inertia: one, space_momentum: one }, order)
            }
        })
    }
}

/// The flow with columns from the first unit vectors.
fn with_columns<const K: usize>(posed: &Posed, settings: &Settings) -> Result<Work, IntegrationError> {
    let flow = BodyFlow { inverse_inertia: posed.metric.inverse_inertia() };
    let mut columns = Columns([[0.0; 6]; K]);
    columns.0.iter_mut().enumerate().for_each(|(i, column)| column[i] = 1.0);
    let start = Joined { base: posed.state, columns };
    let system = WithColumns { flow, parameters: [(); K] };
    integrate(&system, &start, (0.0, posed.end), settings, &mut ()).map(|end| end.work)
}
