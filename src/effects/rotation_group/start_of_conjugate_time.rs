//! Which Φ2 would give a printed first conjugate time, all other numbers of the start as they are.
//!
//! A secant on Φ2, from the start's own: by how much an input would have to be off for a printed result to follow from it.

use super::start::{Body, EulerStart, MomentumStart};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::of_tolerance;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::geometry::rotation_group::conjugate::first_conjugate_times;
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::numerics::counts;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;

/// First step of the secant: printed angles have four decimals.
const FIRST_STEP: f64 = 1e-4;
/// Steps after which it gives up; it needs about five.
const STEPS: usize = 25;
/// Relative difference to the printed time at which it stops: printed times have nine digits.
const ENOUGH: f64 = 1e-12;

/// The same in double-double: the secant's last step gains half as many digits again.
const ENOUGH_LONG: f64 = 1e-20;

/// The question.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StartOfConjugateTime {
    /// The body.
    pub body: Body,
    /// The start as printed.
    pub start: EulerStart,
    /// The first conjugate time as printed.
    pub t1: f64,
    /// Relative error per step of the integrations; below the ε of f64 in double-double.
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
        "effects/arithmetic.rs",
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
        match of_tolerance(self.tolerance) {
            Arithmetic::F64 => self.secant(ENOUGH.max(self.tolerance), |phi2: f64| self.time(phi2)),
            Arithmetic::DoubleDouble => self.secant(ENOUGH_LONG, |phi2: DoubleDouble| self.long_time(phi2)),
        }
    }
}

impl StartOfConjugateTime {
    /// The first conjugate time for Φ2, from a momentum that is rounded once.
    fn time(&self, phi2: f64) -> Result<(f64, counts::Work), NodeError> {
        let [phi1, _, phi3] = self.start.phi;
        let start = MomentumStart::Euler(EulerStart { phi: [phi1, phi2, phi3], p: self.start.p });
        let momentum = start.body_momentum(&self.body)?;
        let found = first_conjugate_times(&self.body.metric()?, momentum, 1, self.tolerance);
        let found = found.map_err(failed(&start.to_string()))?;
        Ok((found.times[0], found.work))
    }

    /// The same in double-double throughout.
    fn long_time(&self, phi2: DoubleDouble) -> Result<(DoubleDouble, counts::Work), NodeError> {
        let doing = format!("Phi2 = {:?}", phi2.to_f64());
        let [phi1, _, phi3] = self.start.phi.map(DoubleDouble::from);
        let point = EulerPoint { angles: [phi1, phi2, phi3], momenta: self.start.p.map(DoubleDouble::from) };
        let momentum = point.body_momentum().map_err(failed(&doing))?;
        let found = first_conjugate_times(&self.body.metric()?, momentum, 1, self.tolerance).map_err(failed(&doing))?;
        Ok((found.times[0], found.work))
    }

    fn secant<S: Real>(
        &self,
        enough: f64,
        found: impl Fn(S) -> Result<(S, counts::Work), NodeError>,
    ) -> Result<Product, NodeError> {
        let mut work = Work::default();
        let mut time = |phi2: S| -> Result<S, NodeError> {
            let (time, counted) = found(phi2)?;
            work += integrated(counted);
            Ok(time)
        };
        let (given, t1) = (S::from_f64(self.start.phi[1]), S::from_f64(self.t1));
        let (mut before, mut at) = (given, given + S::from_f64(FIRST_STEP));
        let (mut off_before, mut off) = (time(before)? - t1, time(at)? - t1);
        let mut steps = 0;
        while off.abs() > S::from_f64(enough * self.t1) {
            let next = at - off * (at - before) / (off - off_before);
            steps += 1;
            if steps > STEPS || !next.is_finite() {
                return Err(NodeError::new(format!(
                    "no Phi2 near {:?} has the conjugate time {:?}",
                    given.to_f64(),
                    self.t1
                )));
            }
            (before, off_before) = (at, off);
            (at, off) = (next, time(next)? - t1);
        }
        let table = Table::builder("start-of-conjugate-time", "the Φ2 that gives a printed conjugate time")
            .column("Phi2", "rad", "Φ2 that gives it", vec![at.to_f64()])
            .column("change", "rad", "its difference to the Φ2 printed", vec![(at - given).to_f64()])
            .column("t1", "time", "first conjugate time as printed", vec![self.t1])
            .build()
            .map_err(failed("start of a conjugate time"))?;
        product(&table, work)
    }
}
