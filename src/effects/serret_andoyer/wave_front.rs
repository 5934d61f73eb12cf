//! The wave front of a start `(0, φ0)` at the time t: the points at arc length t along the extremals of all directions, in closed form.
//!
//! A direction is the angle χ from the meridian: `φ'(0) = cos χ`, `p_θ = √μ(φ0) sin χ`, `0 ≤ χ ≤ 2π`. Among them are oscillating, rotating and unphysical ones
//! (`|p_θ| < C^(−1/2)`), and both meridians. Starts are momenta, so that nothing is lost where `φ' → 0`. `χ → 2π − χ` mirrors θ: half of the front is computed.
//!
//! Directions are halved until the middle of each piece lies within `flatness` of its chord; the front is stretched by `e^(Mt)` near the
//! separatrices, which a uniform fan would miss.

use super::body::Body;
use crate::contract::accuracy::Arithmetic;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::arithmetic::in_arithmetic;
use crate::effects::product::{failed, product};
use crate::geometry::serret_andoyer::{Extremal, Metric, Position, Start};
use crate::numerics::real::Real;
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;
use std::f64::consts::PI;

/// Pieces of half a turn that are refined independently.
const PIECES: usize = 48;
/// Halvings of one piece at most: directions then differ by 1e-6.
const DEPTH: usize = 16;
/// Elliptic integrals and functions of one point: three for the start, three for the position, two for the path.
const ELLIPTIC_CALLS: u64 = 8;

/// The front at one time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WaveFront {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Time, arc length.
    pub t: f64,
    /// Largest distance of a piece's middle from its chord.
    pub flatness: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-wave-front",
    summary: "points at one distance from a start in all directions, in closed form",
    code: &[
        "effects/serret_andoyer/wave_front.rs",
        "effects/serret_andoyer/body.rs",
        "effects/arithmetic.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// All directions from one point.
#[derive(Clone, Copy, Debug)]
pub struct Directions<S: Real = f64> {
    metric: Metric<S>,
    y0: S,
    largest_p_theta: S,
    p_y_scale: S,
}

impl<S: Real> Directions<S> {
    /// The directions from `(0, φ0)`.
    ///
    /// # Errors
    /// A start outside the strip.
    pub fn new(metric: &Metric<S>, phi0: f64) -> Result<Self, NodeError> {
        let width = metric.half_width();
        if phi0.is_nan() || S::from_f64(phi0).abs() >= width {
            let width = width.to_f64();
            return Err(NodeError::new(format!("phi0 = {phi0:?}: |phi0| < K(k)/alpha = {width:?} is needed")));
        }
        let phi0 = S::from_f64(phi0);
        let jacobi = metric.jacobi_of_phi(phi0);
        Ok(Self {
            metric: *metric,
            y0: metric.y_of_phi(phi0),
            largest_p_theta: S::ONE / metric.z_of_sine(jacobi.sn).sqrt(),
            p_y_scale: S::ONE / metric.c_minus_z_of_cosine(jacobi.cn).sqrt(),
        })
    }

    /// `p_θ = √μ(φ0) sin χ`.
    pub fn p_theta(&self, chi: S) -> S {
        self.largest_p_theta * Real::sin(chi)
    }

    /// The point at arc length `t` in the direction χ.
    ///
    /// # Errors
    /// A start that is refused.
    pub fn at(&self, chi: S, t: f64) -> Result<Position<S>, NodeError> {
        let p_y = self.p_y_scale * Real::cos(chi);
        let start = Start::Momenta { y0: self.y0, p_x: self.p_theta(chi), p_y };
        let extremal = Extremal::new(&self.metric, start).map_err(failed(&format!("chi = {:?}", chi.to_f64())))?;
        Ok(extremal.position(S::from_f64(t)))
    }
}

/// A point of the front: χ, θ, φ.
type Point = (f64, f64, f64);

impl WaveFront {
    /// The same directions in another scalar, rounded.
    fn again<S: Real>(&self, points: &[Point]) -> Result<Vec<Point>, NodeError> {
        let directions = Directions::new(&self.body.metric::<S>()?, self.phi0)?;
        let place = |point: &Point| {
            let at = directions.at(S::from_f64(point.0), self.t)?;
            Ok((point.0, at.theta.to_f64(), at.phi.to_f64()))
        };
        points.par_iter().map(place).collect()
    }

    /// Clairaut's constants of the points.
    fn p_theta<S: Real>(&self, points: &[Point]) -> Result<Vec<f64>, NodeError> {
        let directions = Directions::new(&self.body.metric::<S>()?, self.phi0)?;
        Ok(points.iter().map(|point| directions.p_theta(S::from_f64(point.0)).to_f64()).collect())
    }

    fn point(&self, directions: &Directions, chi: f64) -> Result<Point, NodeError> {
        let at = directions.at(chi, self.t)?;
        Ok((chi, at.theta, at.phi))
    }

    /// The points after `from` up to `to`.
    fn refined(
        &self,
        directions: &Directions,
        (from, to): (Point, Point),
        depth: usize,
        points: &mut Vec<Point>,
    ) -> Result<(), NodeError> {
        let middle = self.point(directions, 0.5 * (from.0 + to.0))?;
        let (x, y) = (to.1 - from.1, to.2 - from.2);
        let (u, v) = (middle.1 - from.1, middle.2 - from.2);
        let length = (x * x + y * y).sqrt();
        let along = if length > 0.0 { (u * x + v * y) / length } else { 0.0 };
        let (clamped, aside) = (along.clamp(0.0, length), if length > 0.0 { (u * y - v * x) / length } else { 0.0 });
        let beyond = if length > 0.0 { along - clamped } else { (u * u + v * v).sqrt() };
        let flat = (aside * aside + beyond * beyond).sqrt() <= self.flatness;
        if flat || depth == 0 {
            points.push(to);
            return Ok(());
        }
        self.refined(directions, (from, middle), depth - 1, points)?;
        self.refined(directions, (middle, to), depth - 1, points)
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
        if !(self.t > 0.0 && self.flatness > 0.0) {
            return Err(NodeError::new(format!("t = {:?}, flatness = {:?}: above 0 is needed", self.t, self.flatness)));
        }
        let metric = self.body.metric::<f64>()?;
        let directions = Directions::new(&metric, self.phi0)?;
        let piece = |i: usize| {
            let chi = |i: usize| PI * (i as f64 / PIECES as f64);
            let ends = (self.point(&directions, chi(i))?, self.point(&directions, chi(i + 1))?);
            let mut points = Vec::new();
            self.refined(&directions, ends, DEPTH, &mut points)?;
            Ok(points)
        };
        let pieces = (0..PIECES).into_par_iter().map(piece).collect::<Result<Vec<_>, NodeError>>()?;
        let mut points = vec![self.point(&directions, 0.0)?];
        points.extend(pieces.into_iter().flatten());
        let right = points.len();
        if arithmetic == Arithmetic::DoubleDouble {
            points = in_arithmetic!(arithmetic, S => self.again::<S>(&points))?;
        }
        // The mirror image, on around the start; both meridians are in it once.
        let mirrored: Vec<Point> = points[..right - 1].iter().rev().map(|p| (2.0 * PI - p.0, -p.1, p.2)).collect();
        points.extend(mirrored);
        let column = |f: fn(&Point) -> f64| points.iter().map(f).collect::<Vec<_>>();
        let p_theta = in_arithmetic!(arithmetic, S => self.p_theta::<S>(&points))?;
        let table = Table::builder("wave-front", "points at one arc length from a start, around it")
            .column("chi", "rad", "direction, from the meridian", column(|p| p.0))
            .column("p_theta", "1", "Clairaut's constant", p_theta)
            .column("theta", "rad", "θ", column(|p| p.1))
            .column("phi", "length", "φ on the universal cover", column(|p| p.2))
            .build()
            .map_err(failed("wave front"))?;
        // Each kept point is the end of a piece, and each piece had a middle.
        let again = if arithmetic == Arithmetic::F64 { 0 } else { right as u64 };
        let computed = 2 * (right as u64 - 1) + PIECES as u64 + 1 + again;
        product(&table, Work { elliptic_calls: ELLIPTIC_CALLS * computed, dense_points: computed, ..Work::default() })
    }
}
