//! Conjugate points by integration: the second route beside the closed forms, row by row of their table.
//!
//! The flow (9) with one Jacobi field from `y0 = π/2 + am(αφ0|k)`, `p_x = √((1+δ)/B)`, `p_y = ±√((1 − p_x² Z)/(C − Z))`, until δy vanishes
//! first. No elliptic integral of the extremal enters; the chart is needed only to start and to read φ.
//!
//! **What integration can give.** The separatrix multiplies every error made near the start by up to `e^(M t) ~ 1/δ`. Measured on the article's body, five
//! starts, δ from 0.1 to 1e-12: in f64 `t1` is lost by `ε/(40 δ)`, 1e-13 at `δ = 5e-5`; starts between a turning point and the edge lose more, since y0 is
//! rounded. So a row whose f64 time differs from the first route's by more than a tenth of what is allowed is integrated again in double-double
//! arithmetic, and that is what counts: one allowed difference serves all rows. Starts and δ are exact inputs of both routes, so the difference is all error.

use super::body::{Body, ClairautStart};
use crate::contract::accuracy::{ARTICLE, Accuracy, Arithmetic};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::{ROUNDED_TWICE, long_tolerance, of_tolerance};
use crate::effects::counted::integrated;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::serret_andoyer::flow::first_conjugate_time_by_integration;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The input: a table with columns `phi0`, `delta`, `branch`, `t1`, `theta`, `phi`.
pub const INPUT: &str = "points";
/// The part of the allowed difference beyond which a row is integrated again in double-double.
const TENTH: f64 = 0.1;
/// The relative difference of the two routes that is allowed at full accuracy.
pub const ALLOWED: f64 = 1e-12;

/// The least relative error per step asked for in double-double: a few thousand of its ε.
const DOUBLE_DOUBLE_TOLERANCE: f64 = 1e-28;

/// The second route of a table of conjugate points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ConjugatePointsByIntegration {
    /// The body.
    pub body: Body,
    /// Relative error per step; below the ε of f64 in double-double.
    pub tolerance: f64,
    /// Largest relative difference allowed between the routes.
    pub allowed: f64,
}

impl ConjugatePointsByIntegration {
    /// At an accuracy: full accuracy for `article`, a tenth of what is asked above, double-double below.
    pub fn new(body: Body, accuracy: Accuracy) -> Self {
        let asked = accuracy.relative_error();
        if let Some(tolerance) = long_tolerance(accuracy) {
            return Self { body, tolerance, allowed: ROUNDED_TWICE.max(100.0 * asked) };
        }
        let full = asked <= ARTICLE;
        let tolerance = if full { f64::EPSILON } else { asked / 10.0 };
        Self { body, tolerance, allowed: if full { ALLOWED } else { asked.max(ALLOWED) } }
    }
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-conjugate-points-by-integration",
    summary: "first conjugate points by integrating the flow with a Jacobi field: the second route",
    code: &[
        "effects/serret_andoyer/by_integration.rs",
        "effects/serret_andoyer/body.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// A conjugate point, and what finding it took.
struct Found {
    t1: f64,
    theta: f64,
    phi: f64,
    double_double: bool,
    work: Work,
}

/// One row in the scalar `S`; `t_max` is a time before which there is a conjugate point.
fn integrate<S: Real>(body: &Body, start: &ClairautStart, t_max: f64, tolerance: f64) -> Result<Found, NodeError> {
    let metric = body.metric::<S>()?;
    let (a, b, c) = (metric.a(), metric.b(), metric.c());
    let (phi0, delta) = (S::from_f64(start.phi0), S::from_f64(start.delta));
    let jacobi = metric.jacobi_of_phi(phi0);
    let (z, c_minus_z) = (metric.z_of_sine(jacobi.sn), metric.c_minus_z_of_cosine(jacobi.cn));
    let p_x = ((S::ONE + delta) / b).sqrt();
    // 1 − p_x² Z = [(B − Z) − Zδ]/B; at a cusp it is zero up to the rounding of δ.
    let in_y = ((b - a) * jacobi.cn * jacobi.cn - z * delta) / b;
    let p_y = (in_y.max(S::ZERO) / c_minus_z).sqrt();
    let p_y = if start.branch < 0 { -p_y } else { p_y };
    let y0 = S::PI * S::from_f64(0.5) + jacobi.am;
    let found = first_conjugate_time_by_integration(a, b, c, y0, p_x, p_y, S::ZERO, S::from_f64(t_max), tolerance)
        .map_err(failed(&start.to_string()))?;
    let phi = metric.phi_of_y(found.y).to_f64();
    let (t1, theta) = (found.t1.to_f64(), found.x.to_f64());
    Ok(Found { t1, theta, phi, double_double: false, work: integrated(found.work) })
}

impl Compute for ConjugatePointsByIntegration {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let points = input_table(inputs, INPUT)?;
        let starts = ClairautStart::of_table(&points).map_err(failed("second route"))?;
        let read = |name: &str| points.f64s(name).map_err(failed("second route"));
        let (t1, theta, phi) = (read("t1")?, read("theta")?, read("phi")?);
        let rows = (starts.par_iter().zip(t1))
            .map(|(start, t1)| {
                // The first conjugate time lies between T/2 and T: twice the first route's is beyond it.
                if of_tolerance(self.tolerance) == Arithmetic::DoubleDouble {
                    let long = integrate::<DoubleDouble>(&self.body, start, 2.0 * t1, self.tolerance)?;
                    return Ok(Found { double_double: true, ..long });
                }
                let near = |found: &Found| (found.t1 - t1).abs() <= TENTH * self.allowed * t1.abs();
                let mut before = Work::default();
                // Below full accuracy what the separatrix multiplies is the error of steps: then smaller steps do.
                let full = (self.tolerance > f64::EPSILON).then_some(f64::EPSILON);
                for tolerance in [Some(self.tolerance), full].into_iter().flatten() {
                    // An extremal that is lost near the separatrix has no conjugate time, or a late one.
                    let Ok(short) = integrate::<f64>(&self.body, start, 2.0 * t1, tolerance) else { continue };
                    if near(&short) {
                        return Ok(Found { work: before + short.work, ..short });
                    }
                    before += short.work;
                }
                // Errors of steps grow by less than 1/δ: a hundredth of what is allowed is left for them.
                let tolerance = (0.01 * self.allowed * start.delta).max(DOUBLE_DOUBLE_TOLERANCE);
                let long = integrate::<DoubleDouble>(&self.body, start, 2.0 * t1, tolerance)?;
                Ok(Found { work: before + long.work, double_double: true, ..long })
            })
            .collect::<Result<Vec<Found>, NodeError>>()?;
        let pairs = |first: &[f64], second: fn(&Found) -> f64, scale: fn(f64) -> f64| -> Vec<f64> {
            first.iter().zip(&rows).map(|(x, row)| (x - second(row)).abs() / scale(*x)).collect()
        };
        let work = rows.iter().map(|row| row.work).sum();
        let table = Table::builder("conjugate-points-by-integration", "first conjugate points by integration")
            .column("phi0", "length", "distance of the start from the equator", read("phi0")?)
            .column("delta", "1", "B p_θ² − 1", read("delta")?)
            .column("branch", "1", "sign of φ' at the start", starts.iter().map(|s| s.branch).collect::<Vec<_>>())
            .column("t1", "length", "first conjugate time", rows.iter().map(|r| r.t1).collect::<Vec<_>>())
            .column("theta", "rad", "θ there", rows.iter().map(|r| r.theta).collect::<Vec<_>>())
            .column("phi", "length", "φ there", rows.iter().map(|r| r.phi).collect::<Vec<_>>())
            .column("t1_difference", "1", "relative difference of t1 to the first route", pairs(t1, |r| r.t1, f64::abs))
            .column("theta_difference", "rad", "difference of θ to the first route", pairs(theta, |r| r.theta, |_| 1.0))
            .column("phi_difference", "length", "difference of φ to the first route", pairs(phi, |r| r.phi, |_| 1.0))
            .column("allowed", "1", "largest difference of t1 allowed", vec![self.allowed; rows.len()])
            .column(
                "double_double",
                "",
                "integrated with 106 bits",
                rows.iter().map(|r| r.double_double).collect::<Vec<_>>(),
            )
            .build()
            .map_err(failed("second route"))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::serret_andoyer::first_conjugate_point;

    const BODY: Body = Body { a: 1.5, b: 2.0, c: 2.8 };

    /// Oracle: mpmath, 25 digits (closed form and integration): start on the equator, p_θ = √((1 + δ)/B), ascending; t1 for the floats 1e-12, ….
    const LOCUS: [(f64, f64, f64, f64); 3] = [
        (1e-12, 94.923_630_070_232_339_7, 132.235_392_812_206_867, -1.549_757_611_065_575_684),
        (1e-8, 64.031_209_267_122_236, 88.546_912_367_555_205, -1.549_522_811_950_645_616),
        (1e-4, 33.138_561_953_168_241, 44.858_407_980_240_192_5, -1.526_043_894_948_913_808),
    ];

    #[test]
    fn double_double_reaches_the_separatrix() {
        for (delta, t1, theta, phi) in LOCUS {
            let start = ClairautStart { phi0: 0.0, delta, branch: 1 };
            let found = integrate::<DoubleDouble>(&BODY, &start, 2.0 * t1, 0.01 * ALLOWED * delta).unwrap();
            assert!((found.t1 / t1 - 1.0).abs() <= 4.0 * f64::EPSILON, "{delta}: t1 = {:?}", found.t1);
            assert!((found.theta / theta - 1.0).abs() <= 4.0 * f64::EPSILON, "{delta}: theta = {:?}", found.theta);
            assert!((found.phi - phi).abs() <= 1e-14, "{delta}: phi = {:?}", found.phi);
        }
    }

    /// The law stated above, with a factor of eight.
    #[test]
    fn f64_loses_as_stated() {
        let metric = BODY.metric::<f64>().unwrap();
        for (phi0, branch) in [(0.0, 1), (-0.75, 1), (-0.75, -1), (0.6, 1)] {
            for delta in [3e-2, 3e-4, 1e-4, 3e-7] {
                let start = ClairautStart { phi0, delta, branch };
                let t1 = first_conjugate_point(&start.extremal(&metric).unwrap()).unwrap().t1;
                let found = integrate::<f64>(&BODY, &start, 2.0 * t1, f64::EPSILON).unwrap();
                let allowed = f64::EPSILON * (16.0 + 0.2 / delta);
                assert!((found.t1 / t1 - 1.0).abs() <= allowed, "{start}: {:?}, {t1:?}", found.t1);
            }
        }
    }
}
