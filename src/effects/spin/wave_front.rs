//! The wave front of the spin problem: the points at time t along the extremals of all momenta, by the closed form.
//!
//! Start on the equator, `p_φ(0) = −2`, `p_θ ≥ 0`, `H = 1`; the other three quarters of the front are mirror images, and together they are a closed
//! curve through the start, whose cusps lie on the conjugate loci (all of them, not only the first: there are infinitely many as `p_θ → ∞`). Angles in
//! radians, φ from the pole; times in the unit that `H = 1` fixes.
//!
//! **Which momenta.** Rows begin at `p_θ = 0`; the next one is so small that its point is within a tenth of `step`. Up to 1 the grid is logarithmic, from
//! there on it follows the angle λ of the point about the momentum, `dλ/dp_θ → t/(2k)`, an eighth of a half turn apart, so that no oscillation is stepped
//! over; intervals are halved where the chart needs it. `|r2| ≤ 2 max(1, k)/p_θ`: the front ends where that is half a `step`; what is left
//! of it lies that near to the equator, between the last row and the start.

use super::chart::{Place, coarse, continuous, extend, far};
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::position;
use crate::geometry::spin::reference::position_to_reference;
use crate::geometry::spin::start::Start;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::PI;

/// The gap between `p_θ = 0` and the next row, in units of `step`.
const GAP: f64 = 0.1;
/// From which `p_θ` the smallest one is looked for, and by which factor it falls.
const NOT_SMALL: (f64, f64) = (1e-2, 0.1);
/// The least momentum looked for: below, nothing that is drawn changes for any `k ≥ 0.02`.
const SMALLEST: f64 = 1e-250;
/// Intervals per decade up to `p_θ = 1`, before any halving.
const INTERVALS_PER_DECADE: f64 = 2.0;
/// The change of λ from row to row beyond, before any halving.
const TURN: f64 = PI / 8.0;
/// Height over the equator at which the front ends, in units of `step`.
const HEIGHT: f64 = 0.5;
/// Carlson functions of one point, and of the constants of its extremal.
const ELLIPTIC_CALLS: u64 = 6;

/// The front at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WaveFront {
    /// The ratio of the couplings.
    pub k: f64,
    /// The time.
    pub t: f64,
    /// Largest distance of neighbouring points, radians; see the chart's module for how near the polygon is to the curve.
    pub step: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "spin-wave-front",
    summary: "points at one time from the start for all momenta of the spin problem, by the closed form",
    code: &[
        "effects/spin/wave_front.rs",
        "effects/spin/chart.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

impl WaveFront {
    /// The last `p_θ`.
    pub fn end(&self) -> f64 {
        2.0 * self.k.max(1.0) / (HEIGHT * self.step)
    }

    fn rows(&self) -> Result<(Vec<(f64, Place)>, u64), NodeError> {
        let mut computed = 0;
        let mut at = |p_theta: f64| {
            let doing = || format!("k = {:?}, p_theta = {p_theta:?}, t = {:?}", self.k, self.t);
            let start = Start::new(self.k, p_theta).map_err(failed(&doing()))?;
            computed += 1;
            Ok::<_, NodeError>(Place::of(position(&start, self.t).map_err(failed(&doing()))?))
        };
        let mut rows = vec![(0.0, at(0.0)?)];
        let (mut low, fall) = NOT_SMALL;
        let mut first = at(low)?;
        while far(&rows[0].1, &first, GAP * self.step) {
            low *= fall;
            if low < SMALLEST {
                let message = format!(
                    "k = {:?}, t = {:?}: no momentum is small enough to be that of the meridian",
                    self.k, self.t
                );
                return Err(NodeError::new(message));
            }
            first = at(low)?;
        }
        rows.push((low, first));
        let coarse = |left: &Place, between: &Place, right: &Place| coarse(left, between, right, self.step);
        let decades = (-libm::log10(low) * INTERVALS_PER_DECADE).ceil().max(1.0);
        for i in 1..=decades as u32 {
            let p = libm::pow(low, 1.0 - f64::from(i) / decades);
            let right = (p, at(p)?);
            extend(&mut rows, right, |a, b| libm::sqrt(a) * libm::sqrt(b), &mut at, coarse)?;
        }
        let end = self.end();
        let turns = ((end - 1.0) * self.t / (2.0 * self.k.min(1.0) * TURN)).ceil().max(1.0);
        for i in 1..=turns as u32 {
            let p = 1.0 + (end - 1.0) * (f64::from(i) / turns);
            let right = (p, at(p)?);
            extend(&mut rows, right, |a, b| 0.5 * (a + b), &mut at, coarse)?;
        }
        Ok((rows, computed))
    }
}

impl Compute for WaveFront {
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
        let Self { k, t, step } = *self;
        if !(t > 0.0 && t.is_finite() && step > 0.0 && step <= 1.0 && k > 0.0) {
            return Err(NodeError::new(format!(
                "k = {k:?}, t = {t:?}, step = {step:?}: above 0, step up to 1 are needed"
            )));
        }
        let (mut rows, mut computed) = self.rows()?;
        if arithmetic == Arithmetic::DoubleDouble {
            let place = |(p_theta, _): &(f64, Place)| {
                let doing = || format!("k = {k:?}, p_theta = {p_theta:?}, t = {t:?}");
                let start = Start::new(k, *p_theta).map_err(failed(&doing()))?;
                let r = position_to_reference(&start, t).map_err(failed(&doing()))?;
                Ok((*p_theta, Place::of(r)))
            };
            rows = rows.par_iter().map(place).collect::<Result<Vec<_>, NodeError>>()?;
            computed += rows.len() as u64;
        }
        let mut theta = continuous(rows.iter().rev().map(|(_, place)| place.theta));
        theta.reverse();
        let column = |of: fn(&Place) -> f64| rows.iter().map(|(_, place)| of(place)).collect::<Vec<f64>>();
        let table = Table::builder("spin-wave-front", "points at one time from the start, p_φ(0) = −2, p_θ(0) ≥ 0")
            .column("p_theta", "1", "p_θ(0), ascending from 0", rows.iter().map(|(p, _)| *p).collect::<Vec<f64>>())
            .column("theta", "rad", "θ, continuous along the front from near the start", theta)
            .column("phi", "rad", "φ, from the pole", column(|place| place.phi))
            .column("r1", "1", "first coordinate on the unit sphere", column(|place| place.r[0]))
            .column("r2", "1", "second coordinate, along the axis of the poles", column(|place| place.r[1]))
            .column("r3", "1", "third coordinate", column(|place| place.r[2]))
            .build()
            .map_err(failed(&format!("k = {k:?}, t = {t:?}")))?;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * computed, dense_points: computed, ..Work::default() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::spin::chart::distance;
    use crate::geometry::spin::conjugate::nth_conjugate_time;

    fn table(k: f64, t: f64) -> Table {
        let product = WaveFront { k, t, step: 0.1 }.run(&Inputs::default()).unwrap();
        Table::from_parquet(&product.artifacts[0].bytes(&[]).unwrap()).unwrap()
    }

    /// The meridian has unit speed; neighbours are near each other; the end is as near to the equator as promised.
    #[test]
    fn the_front_is_resolved_from_the_meridian_to_the_equator() {
        for (k, t) in [(0.1, 3.0), (0.5, 1.0), (0.5, 3.0), (0.8, 4.0), (1.0, 2.0), (1.3, 6.0)] {
            let table = table(k, t);
            let column = |name: &str| table.f64s(name).unwrap();
            let r: Vec<[f64; 3]> = (0..table.rows()).map(|i| ["r1", "r2", "r3"].map(|name| column(name)[i])).collect();
            println!("k = {k}, t = {t}: {} rows", table.rows());
            assert!((60..4000).contains(&table.rows()));
            // p_θ = 0 is the meridian, at unit speed over the pole r2 = 1.
            assert!(distance(r[0], [libm::cos(t), libm::sin(t), 0.0]) < 1e-14, "k = {k}, t = {t}: {:?}", r[0]);
            assert!(r.windows(2).all(|pair| distance(pair[0], pair[1]) <= 0.1));
            assert!(r[r.len() - 1][1].abs() <= 0.05);
        }
    }

    /// Where a conjugate time passes t the front turns back: the rows on both sides of such a momentum, found by the phase, are a cusp.
    #[test]
    fn cusps_lie_on_the_conjugate_locus() {
        let (k, t) = (0.8, 2.0);
        let time = |p: f64| nth_conjugate_time(&Start::new(k, p).unwrap(), 1).unwrap();
        let (mut low, mut high) = (1.0, 40.0);
        assert!(time(low) > t && time(high) < t);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if time(middle) > t { low = middle } else { high = middle }
        }
        let at = |p: f64| position(&Start::new(k, p).unwrap(), t).unwrap();
        let (h, cusp) = (1e-3, at(low));
        let [before, after] = [at(low - h), at(low + h)].map(|r| [0, 1, 2].map(|i| r[i] - cusp[i]));
        let dot: f64 = (0..3).map(|i| before[i] * after[i]).sum();
        assert!(dot > 0.0, "both sides leave the cusp in the same direction");
        let rows = table(k, t);
        let (r1, r2, r3) = (rows.f64s("r1").unwrap(), rows.f64s("r2").unwrap(), rows.f64s("r3").unwrap());
        let nearest = (0..rows.rows()).map(|i| distance([r1[i], r2[i], r3[i]], cusp)).fold(f64::INFINITY, f64::min);
        assert!(nearest < 0.03, "{nearest}");
    }
}
