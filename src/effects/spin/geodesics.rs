//! Extremals of the spin problem up to their first conjugate points, by integrating the lift, for drawing.
//!
//! `count` extremals with `p_φ(0) = −2`, `p_θ ≥ 0`, whose ends stand equally far apart along the branch of the conjugate locus
//! (measured on the sphere): the first ends at `p_θ = 0`, the last one step short of the start, where extremals shrink to nothing. So
//! one rule serves every k, although the momenta in question range from 1e-9 to 1e2.
//!
//! Each is integrated once and read off the steps' own polynomials, as densely as the chart (θ, φ) needs; in double-double where
//! rounding in f64 would show ([`super::branch::rounding`]). Every point is compared with the closed form.

use super::branch::{BranchPoint, conjugate_point_in, rounding, slopes};
use super::by_integration::DOUBLE_DOUBLE_TOLERANCE;
use super::chart::{Place, coarse, continuous, distance, extend};
use super::starts::Starts;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::of_tolerance;
use crate::effects::counted::integrated;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::position;
use crate::geometry::spin::lift::SpinLift;
use crate::geometry::spin::reference::position_to_reference;
use crate::geometry::spin::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use crate::numerics::taylor::dense::Kept;
use crate::numerics::taylor::integrator::{Settings, integrate};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-geodesics",
    summary: "extremals of the spin problem up to their first conjugate points, by integrating the lift",
    code: &[
        "effects/spin/geodesics.rs",
        "effects/spin/by_integration.rs",
        "effects/spin/branch.rs",
        "effects/spin/chart.rs",
        "effects/spin/momenta.rs",
        "effects/spin/starts.rs",
        "effects/counted.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// Error of a drawn point from which on f64 is not enough, unless a larger one was asked for.
const SHOWS: f64 = 1e-11;
/// Time between samples before any halving.
const INTERVAL: f64 = 0.5;

/// Extremals up to their first conjugate points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Geodesics {
    /// The ratio of the couplings.
    pub k: f64,
    /// The branch along which their ends are spread; of listed momenta, all where there are no more than `count`.
    pub p_theta: Starts,
    /// How many.
    pub count: u32,
    /// Largest distance of neighbouring points, radians.
    pub step: f64,
    /// Relative error per step of the integration; below the ε of f64 in double-double.
    pub tolerance: f64,
}

/// The momenta of `count` points that stand equally far apart along the branch, the first at `p_θ = 0`.
fn spread(branch: &[BranchPoint], count: u32) -> Vec<f64> {
    let mut along = vec![0.0];
    for pair in branch.windows(2) {
        along.push(along[along.len() - 1] + distance(pair[0].point.r, pair[1].point.r));
    }
    let length = along[along.len() - 1];
    let at = |i: u32| {
        let wanted = length * f64::from(i) / f64::from(count);
        let right = along.partition_point(|s| *s < wanted).clamp(1, along.len() - 1);
        let (p, q) = (branch[right - 1].p_theta, branch[right].p_theta);
        let share = (wanted - along[right - 1]) / (along[right] - along[right - 1]);
        if p > 0.0 { libm::pow(p, 1.0 - share) * libm::pow(q, share) } else { q }
    };
    (0..count).map(|i| if i == 0 { 0.0 } else { at(i) }).collect()
}

/// At most `count` of the momenta of a listed branch: those whose conjugate points stand nearest to equally far apart along it.
fn chosen(branch: &[BranchPoint], count: u32) -> Vec<f64> {
    let all = branch.iter().map(|row| row.p_theta);
    if branch.len() <= count as usize {
        return all.collect();
    }
    let mut along = vec![0.0];
    for pair in branch.windows(2) {
        along.push(along[along.len() - 1] + distance(pair[0].point.r, pair[1].point.r));
    }
    let length = along[along.len() - 1];
    let wanted = |i: u32| length * f64::from(i) / f64::from(count - 1).max(1.0);
    let mut chosen: Vec<f64> =
        (0..count).map(|i| branch[along.partition_point(|s| *s < wanted(i)).min(branch.len() - 1)].p_theta).collect();
    chosen.dedup();
    chosen
}

struct Trajectory {
    t: Vec<f64>,
    r: Vec<[f64; 3]>,
    theta: Vec<f64>,
    phi: Vec<f64>,
    difference: Vec<f64>,
    work: Work,
}

/// Integrates in the scalar `S` and samples; the work's dense points are those asked for.
fn trajectory<S: Real>(
    k: f64,
    p: f64,
    t1: f64,
    step: f64,
    tolerance: f64,
) -> Result<(Vec<(f64, Place)>, Work), NodeError> {
    let doing = format!("k = {k:?}, p_theta = {p:?}");
    let (zero, one, two) = (S::ZERO, S::ONE, S::from_f64(2.0));
    let start = [one, zero, zero, zero, -S::from_f64(p), two];
    let mut kept = Kept::<S>::new();
    let span = (zero, S::from_f64(t1));
    let settings = Settings::new(tolerance);
    let arrival =
        integrate(&SpinLift::new(S::from_f64(k)), &start, span, &settings, &mut kept).map_err(failed(&doing))?;
    let mut work = integrated(arrival.work);
    let mut at = |t: f64| {
        work.dense_points += 1;
        let state = kept.at(S::from_f64(t)).ok_or_else(|| NodeError::new(format!("{doing}: nothing at t = {t:?}")))?;
        Ok::<_, NodeError>(Place::of([0, 1, 2].map(|i| state[i].to_f64())))
    };
    let intervals = (t1 / INTERVAL).ceil().max(1.0);
    let mut samples = vec![(0.0, at(0.0)?)];
    for i in 1..=intervals as u32 {
        let end = t1 * (f64::from(i) / intervals);
        let right = (end, at(end)?);
        extend(&mut samples, right, |a, b| 0.5 * (a + b), &mut at, |a, b, c| coarse(a, b, c, step))?;
    }
    Ok((samples, work))
}

impl Geodesics {
    fn one(&self, p_theta: f64, slope: f64) -> Result<Trajectory, NodeError> {
        let arithmetic = of_tolerance(self.tolerance);
        let t1 = conjugate_point_in(arithmetic, self.k, p_theta)?.t1;
        let (samples, work) = if arithmetic == Arithmetic::DoubleDouble {
            trajectory::<DoubleDouble>(self.k, p_theta, t1, self.step, self.tolerance)?
        } else if rounding(p_theta, slope) * t1 > SHOWS.max(self.tolerance) {
            trajectory::<DoubleDouble>(self.k, p_theta, t1, self.step, DOUBLE_DOUBLE_TOLERANCE)?
        } else {
            trajectory::<f64>(self.k, p_theta, t1, self.step, self.tolerance)?
        };
        let doing = format!("k = {:?}, p_theta = {p_theta:?}", self.k);
        let start = Start::new(self.k, p_theta).map_err(failed(&doing))?;
        let difference = samples
            .iter()
            .map(|(t, place)| {
                let exact = match arithmetic {
                    Arithmetic::F64 => position(&start, *t),
                    Arithmetic::DoubleDouble => position_to_reference(&start, *t),
                };
                Ok(distance(exact.map_err(failed(&doing))?, place.r))
            })
            .collect::<Result<Vec<f64>, NodeError>>()?;
        Ok(Trajectory {
            t: samples.iter().map(|(t, _)| *t).collect(),
            r: samples.iter().map(|(_, place)| place.r).collect(),
            theta: continuous(samples.iter().map(|(_, place)| place.theta)),
            phi: samples.iter().map(|(_, place)| place.phi).collect(),
            difference,
            work,
        })
    }
}

impl Compute for Geodesics {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let (branch, mut work) = self.p_theta.branch(self.k)?;
        let (p_theta, t1): (Vec<f64>, Vec<f64>) = branch.iter().map(|row| (row.p_theta, row.point.t1)).unzip();
        let slopes = slopes(&p_theta, &t1);
        let slope = |p: f64| slopes[p_theta.partition_point(|other| *other < p).min(slopes.len() - 1)];
        let momenta = match &self.p_theta {
            Starts::Branch(_) => spread(&branch, self.count),
            Starts::Listed(_) => chosen(&branch, self.count),
        };
        let trajectories =
            momenta.par_iter().map(|p| self.one(*p, slope(*p))).collect::<Result<Vec<Trajectory>, NodeError>>()?;
        work += trajectories.iter().map(|trajectory| trajectory.work).sum();
        let rows = || trajectories.iter().enumerate().flat_map(|(i, one)| one.t.iter().map(move |_| i));
        let number = |of: fn(&Trajectory) -> &Vec<f64>| trajectories.iter().flat_map(of).copied().collect::<Vec<f64>>();
        let r = |c: usize| trajectories.iter().flat_map(|one| &one.r).map(|r| r[c]).collect::<Vec<f64>>();
        let table = Table::builder("spin-geodesics", "extremals up to their first conjugate points, p_φ(0) = −2")
            .column("index", "1", "which extremal, from 0", rows().map(|i| i as i64).collect::<Vec<_>>())
            .column("p_theta", "1", "its p_θ(0)", rows().map(|i| momenta[i]).collect::<Vec<_>>())
            .column("t", "time", "time; the last one of an extremal is t1", number(|one| &one.t))
            .column("theta", "rad", "θ, continuous in t from 0", number(|one| &one.theta))
            .column("phi", "rad", "φ, from the pole", number(|one| &one.phi))
            .column("r1", "1", "first coordinate on the unit sphere", r(0))
            .column("r2", "1", "second coordinate, along the axis of the poles", r(1))
            .column("r3", "1", "third coordinate", r(2))
            .column("difference", "1", "distance in R³ to the closed form's point", number(|one| &one.difference))
            .build()
            .map_err(failed(&format!("k = {:?}", self.k)))?;
        product(&table, work)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::spin::momenta::Momenta;

    /// Oracle: the closed form, at every sample; and the ends are conjugate points spread as promised.
    #[test]
    fn integration_and_closed_form_agree() {
        let p_theta = Momenta { from: 1e-9, to: 1e4, step: 0.2 };
        for k in [0.1, 0.2, 0.5, 0.8, 1.0, 1.2, 1.4] {
            let geodesics = Geodesics { k, p_theta: p_theta.into(), count: 15, step: 0.1, tolerance: f64::EPSILON };
            let product = geodesics.run(&Inputs::default()).unwrap();
            let table = Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap();
            let largest = table.f64s("difference").unwrap().iter().copied().fold(0.0, f64::max);
            println!("k = {k}: {} rows, {largest:e}", table.rows());
            assert!(largest < 1e-11, "k = {k}: {largest:e}");
            assert_eq!(table.ints("index").unwrap().last(), Some(&14));
        }
    }
}
