//! The body that a Serret-Andoyer node reads, and the columns that its tables of conjugate points share.
//!
//! A start is `φ0` with `δ = B p_θ² − 1` and the sign of `φ'`: exact inputs, so that the second route solves the same problem.

use crate::contract::node::NodeError;
use crate::effects::product::failed;
use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Metric, Start, StartError};
use crate::numerics::real::Real;
use crate::table::{Table, TableError};
use serde::Serialize;

/// Inverse moments of inertia, `A < B < C`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Body {
    /// Inverse of the largest moment of inertia.
    #[serde(rename = "A")]
    pub a: f64,
    /// Inverse of the middle moment of inertia.
    #[serde(rename = "B")]
    pub b: f64,
    /// Inverse of the smallest moment of inertia.
    #[serde(rename = "C")]
    pub c: f64,
}

impl Body {
    /// The metric in any scalar.
    ///
    /// # Errors
    /// Not `0 < A < B < C`.
    pub fn metric<S: Real>(&self) -> Result<Metric<S>, NodeError> {
        Metric::new(S::from_f64(self.a), S::from_f64(self.b), S::from_f64(self.c)).map_err(failed("metric"))
    }

    /// `(p_x, p_y)` at arc length, `h = 1/2`, of the ascending extremal with this `ξ1` (between cos² y0 and 1: oscillating) that starts
    /// at `y0`: by (7), and `p_x² = 1/(A + ξ1 (B − A))`. Sums as they stand: inputs of a problem, not results.
    pub fn ascending_momenta(&self, y0: f64, xi1: f64) -> [f64; 2] {
        let Self { a, b, c } = *self;
        let (sine, cosine) = libm::sincos(y0);
        let nu = a * sine * sine + b * cosine * cosine;
        let square = 1.0 / (a + xi1 * (b - a));
        [square.sqrt(), ((1.0 - square * nu) / (c - nu)).sqrt()]
    }
}

/// The largest `δ = B μ(φ0) − 1` at a start, that of the cusp: `(B − A) cn²/Z`, where nothing cancels.
pub fn largest_delta<S: Real>(metric: &Metric<S>, phi0: S) -> S {
    let jacobi = metric.jacobi_of_phi(phi0);
    (metric.b() - metric.a()) * jacobi.cn * jacobi.cn / metric.z_of_sine(jacobi.sn)
}

/// Whether `δ` exceeds that of the cusp by no more than the roundings of `f64`, in a scalar that is longer.
fn is_rounded_cusp<S: Real>(delta: S, largest: S) -> bool {
    let rounding = S::from_f64(8.0 * f64::EPSILON);
    S::EPSILON < S::from_f64(f64::EPSILON) && delta - largest <= rounding * (S::ONE + largest)
}

/// `δ` in a scalar; what only rounding to `f64` puts beyond the cusp of a start is that of the cusp.
pub fn delta_at<S: Real>(metric: &Metric<S>, phi0: f64, delta: f64) -> S {
    let (delta, largest) = (S::from_f64(delta), largest_delta(metric, S::from_f64(phi0)));
    if delta > largest && is_rounded_cusp(delta, largest) { largest } else { delta }
}

/// A start at `(θ, φ) = (0, φ0)` with arc length as time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClairautStart {
    /// Distance from the equator.
    pub phi0: f64,
    /// `δ = B p_θ² − 1`, positive when oscillating.
    pub delta: f64,
    /// The sign of `φ'`: 1 or −1.
    pub branch: i64,
}

impl ClairautStart {
    /// The extremal that starts there, the start taken as exact; one that only rounding of `δ` to `f64` puts beyond the cusp is taken as that of the cusp.
    ///
    /// # Errors
    /// No such start.
    pub fn extremal<S: Real>(&self, metric: &Metric<S>) -> Result<Extremal<S>, NodeError> {
        let branch = if self.branch < 0 { Branch::Descending } else { Branch::Ascending };
        let (phi0, delta) = (S::from_f64(self.phi0), S::from_f64(self.delta));
        let start = |delta| Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch };
        match Extremal::new(metric, start(delta)) {
            Err(StartError::ClairautTooLarge { .. }) if is_rounded_cusp(delta, largest_delta(metric, phi0)) => {
                Extremal::new(metric, start(largest_delta(metric, phi0)))
            }
            found => found,
        }
        .map_err(failed(&self.to_string()))
    }

    /// The starts in a table's columns `phi0`, `delta`, `branch`.
    ///
    /// # Errors
    /// A column that is missing.
    pub fn of_table(table: &Table) -> Result<Vec<Self>, TableError> {
        let (phi0, delta, branch) = (table.f64s("phi0")?, table.f64s("delta")?, table.ints("branch")?);
        Ok((0..table.rows()).map(|i| Self { phi0: phi0[i], delta: delta[i], branch: branch[i] }).collect())
    }
}

impl std::fmt::Display for ClairautStart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "phi0 = {:?}, delta = {:?}, branch = {}", self.phi0, self.delta, self.branch)
    }
}
