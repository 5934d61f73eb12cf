//! Where a wave front crosses itself (`p_θ > 0`), found from the front alone, and how far from the cut ray that is.
//!
//! Crossings of the front's chords are refined by Newton's method on `q(χ1) = q(χ2)` with difference quotients (an inexact Jacobian costs steps, not
//! accuracy). Nothing of the theory enters: that `p_θ` is the same in both directions, that `t = T(p_θ)/2`, that the place is
//! `(Δθ(p_θ), −φ0)`, are results. Crossings are in the order of χ1: the first joins the parts of the front that are still shortest; later ones
//! (`t > T` for some of the extremals) lie inside and belong to extremals beyond their cut points.

use super::body::Body;
use super::wave_front::Directions;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, input_table, product};
use crate::geometry::serret_andoyer::Clairaut;
use crate::geometry::serret_andoyer::period::period;
use crate::numerics::real::Real;
use crate::table::Table;
use serde::Serialize;
use std::f64::consts::PI;

/// The input: a wave front with columns `chi`, `theta`, `phi`.
pub const INPUT: &str = "front";
/// Steps of Newton's method at most.
const STEPS: usize = 30;
/// Step of the difference quotients (radians): their error, 1e-10, is what Newton's method gains in each step.
const QUOTIENT: f64 = 1e-5;
/// Change of a direction at which Newton's method is at rest (radians): rounding.
const AT_REST: f64 = 1e-14;

/// The self-crossings of one front.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WaveFrontCrossings {
    /// The body.
    pub body: Body,
    /// Distance of the start from the equator.
    pub phi0: f64,
    /// Time, arc length.
    pub t: f64,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "serret-andoyer-wave-front-crossings",
    summary: "self-crossings of a wave front, found from the front, and their distance from the cut locus",
    code: &[
        "effects/serret_andoyer/wave_front_crossings.rs",
        "effects/arithmetic.rs",
        "effects/serret_andoyer/wave_front.rs",
        "effects/serret_andoyer/body.rs",
        "effects/product.rs",
        "geometry/serret_andoyer",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// A crossing: both directions, the place, and how far apart the two points are.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    chi: (f64, f64),
    theta: f64,
    phi: f64,
    gap: f64,
}

/// Where on `a → b` (0 to 1) and on `c → d` the two chords meet, if they do.
fn chords_meet(a: (f64, f64), b: (f64, f64), c: (f64, f64), d: (f64, f64)) -> Option<(f64, f64)> {
    let (u, v, w) = ((b.0 - a.0, b.1 - a.1), (d.0 - c.0, d.1 - c.1), (c.0 - a.0, c.1 - a.1));
    let cross = u.0 * v.1 - u.1 * v.0;
    if cross == 0.0 {
        return None;
    }
    let (s, r) = ((w.0 * v.1 - w.1 * v.0) / cross, (w.0 * u.1 - w.1 * u.0) / cross);
    let on = |x: f64| (0.0..1.0).contains(&x);
    (on(s) && on(r)).then_some((s, r))
}

impl WaveFrontCrossings {
    fn refined(&self, directions: &Directions, start: (f64, f64)) -> Result<(Crossing, u64), NodeError> {
        let (mut first, mut second) = start;
        let place = |chi: f64| directions.at(chi, self.t).map(|at| (at.theta, at.phi));
        let slope = |chi: f64| -> Result<(f64, f64), NodeError> {
            let (up, down) = (place(chi + QUOTIENT)?, place(chi - QUOTIENT)?);
            Ok(((up.0 - down.0) / (2.0 * QUOTIENT), (up.1 - down.1) / (2.0 * QUOTIENT)))
        };
        for step in 1..=STEPS {
            let (p, q) = (place(first)?, place(second)?);
            let (a, b) = (slope(first)?, slope(second)?);
            let gap = (q.0 - p.0, q.1 - p.1);
            // first·a − second·b = gap
            let cross = a.1 * b.0 - a.0 * b.1;
            let (x, y) = ((gap.1 * b.0 - gap.0 * b.1) / cross, (a.0 * gap.1 - a.1 * gap.0) / cross);
            if !(x.is_finite() && y.is_finite()) {
                break;
            }
            if x.abs().max(y.abs()) <= AT_REST {
                let gap = (gap.0 * gap.0 + gap.1 * gap.1).sqrt();
                let place = (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
                let chi = (first, second);
                return Ok((Crossing { chi, theta: place.0, phi: place.1, gap }, step as u64));
            }
            first += x;
            second += y;
            if step == STEPS {
                // Directions no longer settle below rounding: accept what is left if it is rounding, too.
                let gap = (gap.0 * gap.0 + gap.1 * gap.1).sqrt();
                if gap <= 1e-12 {
                    let place = (0.5 * (p.0 + q.0), 0.5 * (p.1 + q.1));
                    return Ok((Crossing { chi: (first, second), theta: place.0, phi: place.1, gap }, step as u64));
                }
            }
        }
        Err(NodeError::new(format!("t = {:?}: the crossing near chi = {start:?} does not settle", self.t)))
    }
}

impl Compute for WaveFrontCrossings {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, inputs: &Inputs) -> Result<Product, NodeError> {
        let front = input_table(inputs, INPUT)?;
        let read = |name: &str| front.f64s(name).map_err(failed("front"));
        let (chi, theta, phi) = (read("chi")?, read("theta")?, read("phi")?);
        let right = chi.iter().take_while(|chi| **chi <= PI).count();
        let at = |i: usize| (theta[i], phi[i]);
        let metric = self.body.metric::<f64>()?;
        let directions = Directions::new(&metric, self.phi0)?;
        let mut found: Vec<Crossing> = Vec::new();
        let mut steps = 0;
        for i in 0..right.saturating_sub(1) {
            for j in i + 2..right - 1 {
                let Some((s, r)) = chords_meet(at(i), at(i + 1), at(j), at(j + 1)) else { continue };
                let start = (chi[i] + s * (chi[i + 1] - chi[i]), chi[j] + r * (chi[j + 1] - chi[j]));
                let (crossing, own) = self.refined(&directions, start)?;
                steps += own;
                // Two chords beside each other may give one crossing twice.
                if found.iter().all(|other| (other.chi.0 - crossing.chi.0).abs() > 1e-9) {
                    found.push(crossing);
                }
            }
        }
        found.sort_by(|a, b| a.chi.0.total_cmp(&b.chi.0));
        // The end of the cut ray: the cusp of the conjugate locus.
        let jacobi = metric.jacobi_of_phi(self.phi0);
        let largest = (metric.b() - metric.a()) * jacobi.cn * jacobi.cn / metric.z_of_sine(jacobi.sn);
        let end = period(&metric, Clairaut::Delta(largest)).map_err(failed("cusp"))?.first_return;
        let distance = |crossing: &Crossing| {
            let aside = crossing.phi + self.phi0;
            let before = (end - crossing.theta).max(0.0);
            (aside * aside + before * before).sqrt()
        };
        let half_period = |crossing: &Crossing| {
            // p_θ² B − 1 from the direction, at the largest constant less what the direction takes.
            let cosine = Real::cos(crossing.chi.0);
            let delta = largest - (1.0 + largest) * cosine * cosine;
            period(&metric, Clairaut::Delta(delta)).map(|period| period.half_period - self.t)
        };
        let late = found.iter().map(half_period).collect::<Result<Vec<_>, _>>().map_err(failed("half period"))?;
        let column = |f: &dyn Fn(&Crossing) -> f64| found.iter().map(f).collect::<Vec<_>>();
        let table =
            Table::builder("wave-front-crossings", "self-crossings of a wave front, p_θ > 0, in the order of χ1")
                .column("chi1", "rad", "direction of the one extremal", column(&|c| c.chi.0))
                .column("chi2", "rad", "direction of the other", column(&|c| c.chi.1))
                .column("p_theta1", "1", "Clairaut's constant of the one", column(&|c| directions.p_theta(c.chi.0)))
                .column("p_theta2", "1", "Clairaut's constant of the other", column(&|c| directions.p_theta(c.chi.1)))
                .column("theta", "rad", "θ of the crossing", column(&|c| c.theta))
                .column("phi", "length", "φ of the crossing", column(&|c| c.phi))
                .column("gap", "1", "distance of the two points", column(&|c| c.gap))
                .column("distance", "1", "distance from the cut ray φ = −φ0, θ ≥ Δθ(√μ(φ0))", column(&distance))
                .column("half_period_difference", "length", "T(p_θ)/2 − t", late)
                .build()
                .map_err(failed("crossings"))?;
        let positions = 6 * steps;
        let roots_solved = found.len() as u64;
        product(
            &table,
            Work { elliptic_calls: 8 * positions, roots_solved, dense_points: positions, ..Work::default() },
        )
    }
}
