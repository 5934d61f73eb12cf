//! One branch of a spin conjugate locus, `p_φ(0) = −2`, `p_θ ≥ 0`, sampled adaptively by the closed form.
//!
//! The points are functions of `log p_θ`, over many decades: for k = 0.1 the end of the branch lies in p_θ from 1e-8 to 1e-4. So
//! intervals of `log p_θ` are halved until neighbours are near each other (module [`super::chart`]), and denser about the cusp. Next to a vertical
//! tangent of `t1(p_θ)`, where the locus crosses the equator, the points move like a cube root and the halving follows them.
//!
//! θ is the continuous branch that is 0 at the start (`p_θ → ∞`); φ is measured from the pole. The other three
//! branches are mirror images: `p_θ < 0` is `θ → −θ`, `p_φ = +2` is `φ → π − φ`.

use super::chart::{Place, coarse, continuous, distance, extend, far, wrapped};
use super::momenta::Momenta;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::NodeError;
use crate::contract::work::Work;
use crate::effects::product::failed;
use crate::geometry::spin::conjugate::{ConjugatePoint, first_conjugate_point};
use crate::geometry::spin::reference::first_conjugate_point_to_reference;
use crate::geometry::spin::start::Start;
use rayon::prelude::*;

/// Intervals per decade of `p_θ` before any halving: what two samples and the one between them can't show is not missed.
const INTERVALS_PER_DECADE: f64 = 2.0;
/// The gap between the sample `from` and `p_θ = 0`, in units of `step`.
const GAP: f64 = 0.1;
/// How far from the cusp its own scale counts, in R³.
const CUSP: f64 = 0.3;
/// Distance from the cusp at which that ends, in units of `step`: 1e-7 for a step of 0.1.
const CUSP_END: f64 = 1e-6;
/// The largest ratio of neighbours' distances from the cusp, and of their distances from its meridian.
const CUSP_RATIO: f64 = 1.5;
/// Rounding errors of an integration in f64, in ε of the state: steps and series.
const ROUNDING: f64 = 4.0;

/// A conjugate point of a branch.
#[derive(Clone, Copy, Debug)]
pub struct BranchPoint {
    /// The momentum `p_θ(0)`.
    pub p_theta: f64,
    /// θ, continuous along the branch.
    pub theta: f64,
    /// The conjugate point; its own θ is in (−π, π].
    pub point: ConjugatePoint,
}

/// The first conjugate point for `p_θ ≥ 0`.
///
/// # Errors
/// k or p_θ outside the domain, named.
pub fn conjugate_point(k: f64, p_theta: f64) -> Result<ConjugatePoint, NodeError> {
    conjugate_point_in(Arithmetic::F64, k, p_theta)
}

/// The same in an arithmetic, rounded.
///
/// # Errors
/// As [`conjugate_point`].
pub fn conjugate_point_in(arithmetic: Arithmetic, k: f64, p_theta: f64) -> Result<ConjugatePoint, NodeError> {
    let doing = || format!("k = {k:?}, p_theta = {p_theta:?}");
    let start = Start::new(k, p_theta).map_err(failed(&doing()))?;
    let point = match arithmetic {
        Arithmetic::F64 => first_conjugate_point(&start),
        Arithmetic::DoubleDouble => first_conjugate_point_to_reference(&start),
    };
    point.map_err(failed(&doing()))
}

/// The branch of these momenta, ascending, in an arithmetic: θ continuous from the largest on.
///
/// # Errors
/// As [`conjugate_point`].
pub fn branch_of(arithmetic: Arithmetic, k: f64, momenta: &[f64]) -> Result<(Vec<BranchPoint>, Work), NodeError> {
    let points = momenta.par_iter().map(|p| conjugate_point_in(arithmetic, k, *p));
    let points = points.collect::<Result<Vec<_>, NodeError>>()?;
    let elliptic_calls = points.iter().map(|point| u64::from(point.elliptic_calls)).sum();
    let work = Work { roots_solved: points.len() as u64, elliptic_calls, ..Work::default() };
    let mut theta = continuous(points.iter().rev().map(|point| point.theta));
    theta.reverse();
    let branch = momenta.iter().zip(points).zip(theta);
    Ok((branch.map(|((p_theta, point), theta)| BranchPoint { p_theta: *p_theta, theta, point }).collect(), work))
}

/// The branch as [`sample`] samples it, its points in an arithmetic.
///
/// # Errors
/// As [`sample`].
pub fn sample_in(arithmetic: Arithmetic, k: f64, momenta: &Momenta) -> Result<(Vec<BranchPoint>, Work), NodeError> {
    let (sampled, work) = sample(k, momenta)?;
    if arithmetic == Arithmetic::F64 {
        return Ok((sampled, work));
    }
    let momenta: Vec<f64> = sampled.iter().map(|row| row.p_theta).collect();
    let (branch, more) = branch_of(arithmetic, k, &momenta)?;
    Ok((branch, work + more))
}

/// Where a conjugate point stands.
pub fn place(point: &ConjugatePoint) -> Place {
    Place { theta: point.theta, phi: point.phi, r: point.r }
}

/// Whether two neighbours are too far apart for the scale that a cusp has.
///
/// A cusp is `(p_θ³, p_θ²)`; for small k it is thinner than 1e-6. Distances from it must not grow too fast, to be drawn at any scale.
fn coarse_for_cusp(cusp: &Place, left: &Place, right: &Place, step: f64) -> bool {
    let (near, away) = (distance(cusp.r, left.r), distance(cusp.r, right.r));
    let (thin, wide) = (wrapped(left.theta - cusp.theta).abs(), wrapped(right.theta - cusp.theta).abs());
    (CUSP_END * step..CUSP).contains(&away) && (away > CUSP_RATIO * near || wide > CUSP_RATIO * thin)
}

/// The branch in order of ascending `p_θ`, `p_θ = 0` first.
///
/// Domain: `k > 0`, `0 < from < to`, `step > 0`. Guarantee: each point to the closed form's accuracy; neighbours as
/// [`Momenta`] says. Deterministic.
///
/// # Errors
/// A start outside the domain; `from` too large for the gap between it and `p_θ = 0`.
pub fn sample(k: f64, momenta: &Momenta) -> Result<(Vec<BranchPoint>, Work), NodeError> {
    let Momenta { from, to, step } = *momenta;
    let mut work = Work::default();
    let mut at = |p_theta: f64| {
        let point = conjugate_point(k, p_theta)?;
        work.roots_solved += 1;
        work.elliptic_calls += u64::from(point.elliptic_calls);
        Ok::<_, NodeError>(point)
    };
    let intervals = (libm::log10(to / from) * INTERVALS_PER_DECADE).ceil().max(1.0);
    let mut points = vec![(0.0, at(0.0)?), (from, at(from)?)];
    if far(&place(&points[0].1), &place(&points[1].1), GAP * step) {
        let message = format!("k = {k:?}: from = {from:?} leaves a gap to the limit p_theta = 0; make it smaller");
        return Err(NodeError::new(message));
    }
    let cusp = place(&points[0].1);
    let coarse = |left: &ConjugatePoint, between: &ConjugatePoint, right: &ConjugatePoint| {
        let (left, between, right) = (place(left), place(between), place(right));
        coarse(&left, &between, &right, step) || coarse_for_cusp(&cusp, &left, &right, step)
    };
    for i in 1..=intervals as u32 {
        let share = f64::from(i) / intervals;
        let end = if share < 1.0 { libm::pow(from, 1.0 - share) * libm::pow(to, share) } else { to };
        let right = (end, at(end)?);
        extend(&mut points, right, |a, b| libm::sqrt(a) * libm::sqrt(b), &mut at, coarse)?;
    }
    let mut theta = continuous(points.iter().rev().map(|(_, point)| point.theta));
    theta.reverse();
    let branch = points.into_iter().zip(theta);
    Ok((branch.map(|((p_theta, point), theta)| BranchPoint { p_theta, theta, point }).collect(), work))
}

/// What rounding does to an integration in f64, relative to `t1`, from the slope `|∂ ln t1/∂ ln p_θ|`.
///
/// The momentum is known from the Casimir `G² = 4 + p_θ²` of the integrated state, which rounding changes by a few ε; that
/// changes `p_θ²` by `ε G²/p_θ²` relative. (k = 0.1, p_θ = 1e-6: seen 4e-6, this gives 5e-5.) For `p_θ = 0`, where h1 and h2 vanish
/// exactly, there is no such loss, and the slope is 0.
pub fn rounding(p_theta: f64, slope: f64) -> f64 {
    let lost = if slope > 0.0 { slope * (1.0 + 4.0 / (p_theta * p_theta)) } else { 0.0 };
    ROUNDING * f64::EPSILON * (1.0 + lost)
}

/// `|∂ ln t1/∂ ln p_θ|` for each row of a branch: the steeper of the two secants.
pub fn slopes(p_theta: &[f64], t1: &[f64]) -> Vec<f64> {
    let secant = |i: usize| {
        if p_theta[i] > 0.0 {
            (libm::log(t1[i + 1] / t1[i]) / libm::log(p_theta[i + 1] / p_theta[i])).abs()
        } else {
            0.0
        }
    };
    let last = p_theta.len().saturating_sub(1);
    (0..p_theta.len())
        .map(|i| {
            let left = if i > 0 { secant(i - 1) } else { 0.0 };
            let right = if i < last { secant(i) } else { 0.0 };
            left.max(right)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::spin::chart::{FLATNESS, TURN, bulge};

    const MOMENTA: Momenta = Momenta { from: 1e-9, to: 1e4, step: 0.1 };

    /// The promise about neighbours, at samples four times denser: the gap and the distance from the polygon.
    #[test]
    fn the_polygon_is_near_the_curve() {
        for k in [0.1, 0.5, 0.8, 1.0, 1.1, 1.2, 1.3, 1.4] {
            let (branch, _) = sample(k, &MOMENTA).unwrap();
            println!("k = {k}: {} rows", branch.len());
            assert!((60..400).contains(&branch.len()));
            for pair in branch.windows(2) {
                let (left, right) = (place(&pair[0].point), place(&pair[1].point));
                assert!(!far(&left, &right, MOMENTA.step), "k = {k}, p = {}", pair[0].p_theta);
                assert!((pair[1].theta - pair[0].theta).abs() <= TURN * MOMENTA.step);
                if pair[0].p_theta == 0.0 {
                    continue;
                }
                for share in [0.25, 0.5, 0.75] {
                    let p = libm::pow(pair[0].p_theta, 1.0 - share) * libm::pow(pair[1].p_theta, share);
                    let bulge = bulge(&left, &place(&conjugate_point(k, p).unwrap()), &right);
                    // The bulge off the middle of a piece may be larger than there: by 2 at most here.
                    assert!(bulge <= 2.0 * FLATNESS * MOMENTA.step * MOMENTA.step, "k = {k}, p = {p}: {bulge:e}");
                }
            }
        }
    }

    #[test]
    fn a_gap_at_the_cusp_is_refused() {
        let refused = sample(0.1, &Momenta { from: 1e-5, ..MOMENTA }).unwrap_err();
        assert!(refused.message.contains("k = 0.1: from = 1e-5 leaves a gap"), "{refused}");
    }
}
