//! The cut locus of the spin problem (Lemma 4.4): the first return of each extremal to the equator, by the closed form.
//!
//! The cut time is where the angle λ of the point about the momentum is π, so no return can be skipped; the cut point is `θ = atan2(k sin β, −cos β)` on the
//! equator. `p_φ(0) = −2`, `p_θ ≥ 0`; θ falls from π at `p_θ = 0` towards the start as `p_θ → ∞`. `p_θ < 0` is the mirror image `θ → −θ`, and both signs of
//! `p_φ` have the same cut points: that is why they are. Angles in radians, times in the unit that `H = 1` fixes.
//!
//! Sampled starts stand as densely as their cut points need, which is not where their conjugate points do: for small k the cut point leaves that of
//! the meridian at momenta of `e^(−π/k)`, below the conjugate locus's smallest. Then samples begin below the range's `from`.

use super::chart::{Place, distance, extend};
use super::momenta::Momenta;
use super::starts::{Starts, ascending};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::{CutPoint, cut_point};
use crate::geometry::spin::reference::cut_point_to_reference;
use crate::geometry::spin::start::Start;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// Intervals per decade of `p_θ` before any halving.
const INTERVALS_PER_DECADE: f64 = 2.0;
/// The gap between `p_θ = 0` and the next sample, in units of `step`: where `from` leaves more, smaller momenta are taken.
const GAP: f64 = 0.1;
/// By which factor.
const FALL: f64 = 0.1;
/// The least momentum taken: below, nothing changes for any `k ≥ 0.02`.
const SMALLEST: f64 = 1e-250;

/// The cut points of one k.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutLocus {
    /// The ratio of the couplings.
    pub k: f64,
    /// Which momenta.
    pub p_theta: Starts,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-cut-locus",
    summary: "cut points of the spin problem: first returns to the equator, by the closed form",
    code: &[
        "effects/spin/cut_locus.rs",
        "effects/spin/starts.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

fn cut(arithmetic: Arithmetic, k: f64, p_theta: f64) -> Result<CutPoint, NodeError> {
    let doing = || format!("k = {k:?}, p_theta = {p_theta:?}");
    let start = Start::new(k, p_theta).map_err(failed(&doing()))?;
    let point = match arithmetic {
        Arithmetic::F64 => cut_point(&start),
        Arithmetic::DoubleDouble => cut_point_to_reference(&start),
    };
    point.map_err(failed(&doing()))
}

/// Cut points so dense that neighbours on the equator are at most `step` apart.
fn sampled(k: f64, momenta: &Momenta, work: &mut Work) -> Result<Vec<(f64, CutPoint)>, NodeError> {
    let Momenta { from, to, step } = *momenta;
    let mut at = |p_theta: f64| {
        let point = cut(Arithmetic::F64, k, p_theta)?;
        count(&point, work);
        Ok::<_, NodeError>(point)
    };
    let far = |left: &CutPoint, right: &CutPoint, step: f64| distance(left.r, right.r) > step;
    let mut points = vec![(0.0, at(0.0)?)];
    let (mut low, mut lowest) = (from, at(from)?);
    while far(&points[0].1, &lowest, GAP * step) {
        low *= FALL;
        if low < SMALLEST {
            return Err(NodeError::new(format!("k = {k:?}: no momentum is small enough to be that of the meridian")));
        }
        lowest = at(low)?;
    }
    points.push((low, lowest));
    let intervals = (libm::log10(to / low) * INTERVALS_PER_DECADE).ceil().max(1.0);
    for i in 1..=intervals as u32 {
        let share = f64::from(i) / intervals;
        let end = if share < 1.0 { libm::pow(low, 1.0 - share) * libm::pow(to, share) } else { to };
        let right = (end, at(end)?);
        let middle = |a: f64, b: f64| libm::sqrt(a) * libm::sqrt(b);
        extend(&mut points, right, middle, &mut at, |left, _, right| far(left, right, step))?;
    }
    Ok(points)
}

fn count(point: &CutPoint, work: &mut Work) {
    work.roots_solved += 1;
    work.elliptic_calls += u64::from(point.elliptic_calls);
}

impl Compute for CutLocus {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn heeds_arithmetic(&self) -> bool {
        true
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        self.run_in(Arithmetic::F64, inputs)
    }

    fn run_in(&self, arithmetic: Arithmetic, _: &Inputs) -> Result<Product, NodeError> {
        let mut work = Work::default();
        let mut computed = |momenta: &[f64]| {
            let points = momenta.par_iter().map(|p| Ok((*p, cut(arithmetic, self.k, *p)?)));
            let points = points.collect::<Result<Vec<_>, NodeError>>()?;
            points.iter().for_each(|(_, point)| count(point, &mut work));
            Ok::<_, NodeError>(points)
        };
        let points = match &self.p_theta {
            Starts::Listed(listed) => computed(ascending(self.k, listed)?)?,
            Starts::Branch(momenta) => {
                let mut sampling = Work::default();
                let points = sampled(self.k, momenta, &mut sampling)?;
                let points = match arithmetic {
                    Arithmetic::F64 => points,
                    Arithmetic::DoubleDouble => computed(&points.iter().map(|(p, _)| *p).collect::<Vec<f64>>())?,
                };
                work += sampling;
                points
            }
        };
        let column = |of: fn(&CutPoint) -> f64| points.iter().map(|(_, point)| of(point)).collect::<Vec<f64>>();
        let table = Table::builder("spin-cut-locus", "cut points for p_φ(0) = −2, p_θ(0) ≥ 0, on the equator")
            .column("p_theta", "1", "p_θ(0), ascending", points.iter().map(|(p, _)| *p).collect::<Vec<f64>>())
            .column("t", "time", "cut time: first return to the equator", column(|point| point.t_cut))
            .column("theta", "rad", "θ there, in (−π, π]", column(|point| Place::of(point.r).theta))
            .column("r1", "1", "first coordinate on the unit sphere", column(|point| point.r[0]))
            .column("r3", "1", "third coordinate", column(|point| point.r[2]))
            .column("error", "1", "bound on the relative error of t", column(|point| point.error))
            .build()
            .map_err(failed(&format!("k = {:?}", self.k)))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const MOMENTA: Momenta = Momenta { from: 1e-9, to: 1e4, step: 0.1 };

    fn table(k: f64, p_theta: Starts) -> Table {
        let product = CutLocus { k, p_theta }.run(&Inputs::default()).unwrap();
        Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap()
    }

    /// Lemma 4.4: the cut points run over the equator from the far point towards the start, once. The round metric, k = 1: every extremal
    /// is a great circle in the frame that turns about the momentum; p_θ = 0 is the meridian, cut at t = π for every k.
    #[test]
    fn they_run_over_the_equator_once() {
        for k in [0.1, 0.5, 0.8, 1.0, 1.2, 1.4] {
            let table = table(k, MOMENTA.into());
            let (theta, t) = (table.f64s("theta").unwrap(), table.f64s("t").unwrap());
            assert!((40..200).contains(&table.rows()), "k = {k}: {}", table.rows());
            assert_eq!(theta[0], PI, "k = {k}");
            assert!((t[0] - PI).abs() <= 4.0 * f64::EPSILON * PI);
            assert!(theta.windows(2).all(|pair| pair[1] <= pair[0] && pair[0] - pair[1] < 0.11), "k = {k}");
            let last = theta[theta.len() - 1];
            assert!(last > 0.0 && last < 1e-2 / k, "k = {k}: {last}");
        }
    }

    #[test]
    fn a_list_has_its_rows() {
        let table = table(0.5, Starts::Listed(vec![0.0, 0.5, 2.0]));
        assert_eq!(table.f64s("p_theta").unwrap(), [0.0, 0.5, 2.0]);
    }
}
