//! Which Φ2 would give a printed first conjugate time, all other numbers of the start as they are.
//!
//! A secant on Φ2, from the start's own: by how much an input would have to be off for a printed result to follow from it.

use super::start::{Body, EulerStart, MomentumStart};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::geometry::rotation_group::conjugate::first_conjugate_times;
use crate::table::Table;
use serde::Serialize;

/// First step of the secant: printed angles have four decimals.
const FIRST_STEP: f64 = 1e-4;
/// Steps after which it gives up; it needs about five.
const STEPS: usize = 25;
/// Relative difference to the printed time at which it stops: printed times have nine digits.
const ENOUGH: f64 = 1e-12;

/// The question.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StartOfConjugateTime {
    /// The body.
    pub body: Body,
    /// The start as printed.
    pub start: EulerStart,
    /// The first conjugate time as printed.
    pub t1: f64,
    /// Relative error per step of the integrations.
    pub tolerance: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "rotation-group-start-of-conjugate-time",
    summary: "the Euler angle Φ2 that would give a printed first conjugate time on SO(3)",
    code: &[
        "effects/rotation_group/start_of_conjugate_time.rs",
        "effects/rotation_group/start.rs",
        "effects/counted.rs",
        "effects/product.rs",
        "geometry/rotation_group",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl Compute for StartOfConjugateTime {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let metric = self.body.metric()?;
        let mut work = Work::default();
        let mut time = |phi2: f64| -> Result<f64, NodeError> {
            let [phi1, _, phi3] = self.start.phi;
            let start = MomentumStart::Euler(EulerStart { phi: [phi1, phi2, phi3], p: self.start.p });
            let momentum = start.body_momentum(&self.body)?;
            let found =
                first_conjugate_times(&metric, momentum, 1, self.tolerance).map_err(failed(&start.to_string()))?;
            work += integrated(found.work);
            Ok(found.times[0])
        };
        let given = self.start.phi[1];
        let (mut before, mut at) = (given, given + FIRST_STEP);
        let (mut off_before, mut off) = (time(before)? - self.t1, time(at)? - self.t1);
        let mut steps = 0;
        while off.abs() > ENOUGH.max(self.tolerance) * self.t1 {
            let next = at - off * (at - before) / (off - off_before);
            steps += 1;
            if steps > STEPS || !next.is_finite() {
                return Err(NodeError::new(format!("no Phi2 near {given:?} has the conjugate time {:?}", self.t1)));
            }
            (before, off_before) = (at, off);
            (at, off) = (next, time(next)? - self.t1);
        }
        let table = Table::builder("start-of-conjugate-time", "the Φ2 that gives a printed conjugate time")
            .column("Phi2", "rad", "Φ2 that gives it", vec![at])
            .column("change", "rad", "its difference to the Φ2 printed", vec![at - given])
            .column("t1", "time", "first conjugate time as printed", vec![self.t1])
            .build()
            .map_err(failed("start of a conjugate time"))?;
        product(&table, work)
    }
}
