//! The hard cases of the spin problem: first conjugate times (and a place, and a position) towards each limit of `k` and `p_θ`.
//!
//! Truth: the closed form in double-double for the inputs as given ([`crate::geometry::spin::reference`]), which the tests hold against
//! integration at 60 digits. Ours: the same call that `point` makes. Naive: the formulation that each family names, in `spin_naive`.
//! Where an angle is answered, it is `θ + π` with θ in (−π, π]: its relative errors are then absolute ones in radians, up to a factor of 2π.
//! The condition number is `max |Δ ln answer|/ε` over the inputs, each moved by one ε up and down.
//!
//! | family | distance | naive |
//! |---|---|---|
//! | `small-momentum` | `p_θ` | the lift, integrated |
//! | `large-momentum` | `1/p_θ` | closed form as first written |
//! | `separatrix` | `abs(p_θ/q − 1)`, `q = 2√(k² − 1)` | closed form as first written |
//! | `equator-crossing` | `abs(p_θ/p_c − 1)`, vertical tangent of t1 at `p_c` | the lift, integrated |
//! | `pole` | `abs(k − k_s)`, the conjugate point in the pole's meridian at `k_s` | the chart, integrated |
//! | `round` | `abs(k − 1)` | the chart, integrated |
//! | `large-k` | `1/k` | the lift, integrated (up to k = 18) |
//! | `small-k` | `k` | the chart, integrated |
//! | `long-time` | one over the number of half periods; the answer is the angle of the point | the lift, integrated (up to 3000) |
//!
//! Times are in the unit that `H = 1` fixes.

use super::family::{Case, Refused, Told, check_ends, distances, table};
use super::spin_limit::{crossings_begin, limit, pole_passages};
use super::spin_naive::{by_chart, by_lift, by_printed_forms, points_by_lift};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::geometry::spin::conjugate::{extremal, first_conjugate_point, position, position_error};
use crate::geometry::spin::extremal::CALLS_FOR_CONSTANTS;
use crate::geometry::spin::phase::CALLS_FOR_STATE;
use crate::geometry::spin::reference::{first_conjugate_point_in_double_double, position_in_double_double};
use crate::geometry::spin::solve::SpinError;
use crate::geometry::spin::start::Start;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// The kind.
pub const KIND: Kind = Kind {
    name: "hard-cases-spin",
    summary: "a family of hard cases of the spin problem: naive formulation, ours, truth, condition, verdict",
    code: &[
        "effects/hard_cases/family.rs",
        "effects/hard_cases/spin.rs",
        "effects/hard_cases/spin_limit.rs",
        "effects/hard_cases/spin_naive.rs",
        "effects/product.rs",
        "geometry/spin",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// A naive integration is asked for up to this multiple of the true time.
const BEYOND: f64 = 1.2;
/// Times after which the lift is not integrated: thousands of half periods, a second of work.
const LONGEST_INTEGRATION: f64 = 2000.0;
/// Half periods after which positions are not integrated.
const MOST_HALF_PERIODS: f64 = 3000.0;
/// The anisotropies of a family that keeps one: below, momenta near the meridian are no start ([`Start::new`]); above, the scan of the
/// printed forms for a change of sign takes seconds.
const K: (f64, f64) = (0.02, 1000.0);
/// The largest k whose equator crossing is looked for: far above it the crossing comes nearer to the separatrix than the bracket does.
const LARGEST_K_OF_CROSSING: f64 = 5.0;
/// The momenta of a family that keeps one. Below, a long time passes so near to a pole that no digit of its angle is left; above, their
/// powers leave double-double where k is large too.
const MOMENTUM: (f64, f64) = (1e-8, 1e8);
/// The largest momentum that pole passages are looked for with: far above it the first one lies beyond the k that are scanned.
const LARGEST_MOMENTUM_OF_POLE: f64 = 1.0;

/// The side from which a limit is approached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// From smaller values.
    Below,
    /// From larger values.
    Above,
}

/// What is answered at a pole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Answered {
    /// The first conjugate time.
    Time,
    /// θ of the first conjugate point.
    Theta,
}

/// A family, with the parameters that stay.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Family {
    /// `p_θ → 0`.
    SmallMomentum {
        /// Anisotropy.
        k: f64,
    },
    /// `p_θ → ∞`.
    LargeMomentum {
        /// Anisotropy.
        k: f64,
    },
    /// `p_θ → 2√(k² − 1)`.
    Separatrix {
        /// Anisotropy, above 1.
        k: f64,
        /// From rotating (above) or oscillating (below) extremals.
        side: Side,
    },
    /// `p_θ` to where the second return to the equator is conjugate: a triple root.
    EquatorCrossing {
        /// Anisotropy, above 1.1547 or so: below, there is none.
        k: f64,
        /// Side of `p_θ`.
        side: Side,
    },
    /// k to where the conjugate point passes a pole.
    Pole {
        /// Momentum, small.
        p_theta: f64,
        /// Which passage above k = 1, from 1.
        passage: u32,
        /// Side of k.
        side: Side,
        /// Time or place.
        answered: Answered,
    },
    /// `k → 1`.
    Round {
        /// Momentum.
        p_theta: f64,
        /// Side of k.
        side: Side,
    },
    /// `k → ∞`.
    LargeK {
        /// Momentum.
        p_theta: f64,
    },
    /// `k → 0`.
    SmallK {
        /// Momentum.
        p_theta: f64,
    },
    /// Many half periods of β.
    LongTime {
        /// Anisotropy, not 1.
        k: f64,
        /// Momentum, not zero.
        p_theta: f64,
    },
}

/// One family swept towards its limit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HardCasesSpin {
    /// The family.
    pub family: Family,
    /// The first distance, the largest.
    pub from: f64,
    /// The last distance, the smallest.
    pub to: f64,
    /// Cases per decade.
    pub per_decade: u32,
}

impl Family {
    /// In tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::SmallMomentum { .. } => "small-momentum",
            Self::LargeMomentum { .. } => "large-momentum",
            Self::Separatrix { .. } => "separatrix",
            Self::EquatorCrossing { .. } => "equator-crossing",
            Self::Pole { .. } => "pole",
            Self::Round { .. } => "round",
            Self::LargeK { .. } => "large-k",
            Self::SmallK { .. } => "small-k",
            Self::LongTime { .. } => "long-time",
        }
    }

    /// The unit of what is asked.
    fn unit(&self) -> &'static str {
        match self {
            Self::Pole { answered: Answered::Theta, .. } | Self::LongTime { .. } => "rad",
            _ => "time",
        }
    }

    /// The largest and the smallest distance that a sweep is made for.
    fn ends(&self) -> (f64, f64) {
        match self {
            // p_θ is an input: only the range of numbers ends it.
            Self::SmallMomentum { .. } => (1.0, 1e-300),
            // Powers of p_θ leave double-double beyond.
            Self::LargeMomentum { .. } => (1.0, 1e-100),
            // Below, the nearest number to the limit is nearer to it than what is asked for.
            Self::Separatrix { .. } | Self::EquatorCrossing { .. } | Self::Pole { .. } => (1.0, f64::EPSILON),
            // k below 1 must stay away from 0.
            Self::Round { .. } => (0.9, f64::EPSILON),
            // As far as double-double is known to hold the truth.
            Self::LargeK { .. } | Self::SmallK { .. } => (1.0, 1e-12),
            Self::LongTime { .. } => (1.0, 1e-10),
        }
    }

    /// Whether this family, with its parameters, can be swept between two distances.
    ///
    /// # Errors
    /// [`Refused`]: ends in the wrong order or beyond the family's; a parameter outside the range that its limit is looked for in, a
    /// passage of a pole that does not happen, a long time whose β has no period.
    pub fn validate(&self, from: f64, to: f64) -> Result<(), Refused> {
        let (nearest, farthest) = self.ends();
        check_ends(from, to, nearest, farthest)?;
        let key = |parameter: &str| format!("family.{}.{parameter}", self.name());
        let check = |parameter: &str, found: f64, (least, most): (f64, f64)| {
            let holds = (least..=most).contains(&found);
            Refused::unless(holds, key(parameter), found, format!("{least:?} to {most:?}"))
        };
        let above = |k: f64, (least, most): (f64, f64)| {
            Refused::unless(k > least && k <= most, key("k"), k, format!("above {least:?}, at most {most:?}"))
        };
        match *self {
            Self::SmallMomentum { k } | Self::LargeMomentum { k } => check("k", k, K),
            Self::Separatrix { k, .. } => above(k, (1.0, K.1)),
            Self::EquatorCrossing { k, .. } => above(k, (crossings_begin(), LARGEST_K_OF_CROSSING)),
            Self::Round { p_theta, .. } | Self::LargeK { p_theta } | Self::SmallK { p_theta } => {
                check("p_theta", p_theta, MOMENTUM)
            }
            Self::Pole { p_theta, passage, .. } => {
                check("p_theta", p_theta, (MOMENTUM.0, LARGEST_MOMENTUM_OF_POLE))?;
                let found = pole_passages(p_theta).map_or(0, |found| found.len());
                let accepted = format!("1 to {found}, the number of a pole passage");
                let holds = passage >= 1 && passage as usize <= found;
                Refused::unless(holds, key("passage"), f64::from(passage), accepted)
            }
            Self::LongTime { k, p_theta } => {
                check("k", k, K)?;
                Refused::unless(k != 1.0, key("k"), k, "not 1, where β has no period")?;
                check("p_theta", p_theta, MOMENTUM)?;
                let has_period = Start::new(k, p_theta).is_ok_and(|start| extremal(&start).elliptic.is_some());
                Refused::unless(has_period, key("p_theta"), p_theta, "not on the separatrix, where β has no period")
            }
        }
    }

    fn meaning(&self) -> String {
        match self {
            Self::SmallMomentum { k } => {
                format!("spin, k = {k}: first conjugate time as p_theta -> 0; naive: the lift")
            }
            Self::LargeMomentum { k } => {
                format!(
                    "spin, k = {k}: first conjugate time as p_theta -> infinity; naive: closed form as first written"
                )
            }
            Self::Separatrix { k, side } => format!(
                "spin, k = {k}: first conjugate time as p_theta -> 2 sqrt(k^2 - 1) from {side:?}; naive: closed form as first written"
            ),
            Self::EquatorCrossing { k, side } => format!(
                "spin, k = {k}: first conjugate time as p_theta -> the equator crossing from {side:?}; naive: the lift"
            ),
            Self::Pole { p_theta, passage, side, answered } => format!(
                "spin, p_theta = {p_theta}: {} of the first conjugate point as k -> pole passage {passage} from {side:?}; naive: the chart",
                if answered == &Answered::Time { "time" } else { "angle theta + pi" }
            ),
            Self::Round { p_theta, side } => {
                format!("spin, p_theta = {p_theta}: first conjugate time as k -> 1 from {side:?}; naive: the chart")
            }
            Self::LargeK { p_theta } => {
                format!(
                    "spin, p_theta = {p_theta}: first conjugate time as k -> infinity; naive: the lift up to k = 18"
                )
            }
            Self::SmallK { p_theta } => {
                format!("spin, p_theta = {p_theta}: first conjugate time as k -> 0; naive: the chart")
            }
            Self::LongTime { k, p_theta } => {
                format!(
                    "spin, k = {k}, p_theta = {p_theta}: angle theta + pi after many half periods; naive: the lift up to 3000"
                )
            }
        }
    }
}

impl Compute for HardCasesSpin {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let family = &self.family;
        let cases = self.cases()?;
        let table = table(family.name(), family.unit(), &family.meaning(), &cases).map_err(failed(family.name()))?;
        let work = cases.iter().fold(Work::default(), |sum, case| sum + case.work);
        product(&table, work)
    }
}

impl HardCasesSpin {
    /// The cases, from the largest distance to the smallest.
    ///
    /// # Errors
    /// A sweep that [`Family::validate`] refuses; a truth that double-double can't tell.
    pub fn cases(&self) -> Result<Vec<Case>, NodeError> {
        self.family.validate(self.from, self.to).map_err(failed(self.family.name()))?;
        self.answered().map_err(failed(self.family.name()))
    }

    fn answered(&self) -> Result<Vec<Case>, SpinError> {
        let distances = distances(self.from, self.to, self.per_decade);
        if let Family::LongTime { k, p_theta } = self.family {
            return long_times(k, p_theta, &distances);
        }
        let limit = limit(&self.family)?;
        distances.into_iter().map(|distance| self.case(limit, distance)).collect()
    }

    fn case(&self, limit: DoubleDouble, wanted: f64) -> Result<Case, SpinError> {
        let offset = |side: Side| DoubleDouble::from(if side == Side::Below { -wanted } else { wanted });
        let beside = |side: Side| (limit * (DoubleDouble::ONE + offset(side))).to_f64();
        let (k, p) = match self.family {
            Family::SmallMomentum { k } => (k, wanted),
            Family::LargeMomentum { k } => (k, 1.0 / wanted),
            Family::Separatrix { k, side } | Family::EquatorCrossing { k, side } => (k, beside(side)),
            Family::Pole { p_theta, side, .. } | Family::Round { p_theta, side } => {
                ((limit + offset(side)).to_f64(), p_theta)
            }
            Family::LargeK { p_theta } => (1.0 / wanted, p_theta),
            Family::SmallK { p_theta } | Family::LongTime { p_theta, .. } => (wanted, p_theta),
        };
        // The distance of the inputs as rounded.
        let distance = match self.family {
            Family::Separatrix { .. } | Family::EquatorCrossing { .. } => {
                ((DoubleDouble::from(p) - limit) / limit).abs().to_f64()
            }
            Family::Pole { .. } | Family::Round { .. } => (DoubleDouble::from(k) - limit).abs().to_f64(),
            _ => wanted,
        };
        let of_theta = matches!(self.family, Family::Pole { answered: Answered::Theta, .. });
        let answer = |inputs: &[DoubleDouble]| {
            let point = first_conjugate_point_in_double_double(inputs[0], inputs[1])?;
            Ok(if of_theta { point.theta + DoubleDouble::PI } else { point.t1 })
        };
        let (truth, condition) = with_condition(&[k, p], answer)?;
        let start = Start::new(k, p)?;
        let (ours, naive, route, work) = match first_conjugate_point(&start) {
            Ok(point) => {
                let calls = u64::from(point.elliptic_calls);
                let work = Work { elliptic_calls: calls, roots_solved: 1, rows: 1, ..Work::default() };
                // θ turns by what the point moves, over its distance from the axis.
                let angle = point.theta + PI;
                let turned = turned(point.place_error(&start), libm::sin(point.phi), angle);
                let told = match of_theta {
                    true => Told { value: angle, claimed: turned },
                    false => Told { value: point.t1, claimed: point.error },
                };
                (told, self.naive(k, p, point.t1, of_theta), point.route(), work)
            }
            Err(reason) => (Told { value: f64::NAN, claimed: f64::NAN }, f64::NAN, reason.to_string(), Work::default()),
        };
        Ok(case(distance, truth, naive, ours, condition, route, work))
    }

    /// The naive formulation's answer; NaN too where its integration up to a little more than `t1` would take too long.
    fn naive(&self, k: f64, p: f64, t1: f64, of_theta: bool) -> f64 {
        if t1 > LONGEST_INTEGRATION {
            return f64::NAN;
        }
        let t_max = BEYOND * t1;
        match self.family {
            Family::LargeMomentum { .. } | Family::Separatrix { .. } => by_printed_forms(k, p, t_max),
            Family::Pole { .. } if of_theta => by_chart(k, p, t_max).theta + PI,
            Family::Pole { .. } | Family::Round { .. } | Family::SmallK { .. } => by_chart(k, p, t_max).time,
            _ => by_lift(k, p, t_max),
        }
    }
}

fn case(distance: f64, truth: DoubleDouble, naive: f64, ours: Told, condition: f64, route: String, work: Work) -> Case {
    Case { distance, truth: truth.high(), truth_rest: truth.low(), naive, ours, condition, route, work }
}

/// The relative error of the angle of a point that may be off by `moved`, at a distance from the axis.
fn turned(moved: f64, distance: f64, angle: f64) -> f64 {
    (moved / distance + 4.0 * f64::EPSILON) / angle
}

/// The value, and by how many ε (relative) it changes at most when one input is moved by one ε.
fn with_condition(
    inputs: &[f64],
    value: impl Fn(&[DoubleDouble]) -> Result<DoubleDouble, SpinError>,
) -> Result<(DoubleDouble, f64), SpinError> {
    let exact: Vec<DoubleDouble> = inputs.iter().map(|x| DoubleDouble::from(*x)).collect();
    let center = value(&exact)?;
    let mut largest: f64 = 0.0;
    for i in 0..exact.len() {
        for factor in [1.0 + f64::EPSILON, 1.0 - f64::EPSILON] {
            let mut moved = exact.clone();
            moved[i] *= DoubleDouble::from(factor);
            let change = ((value(&moved)? - center) / center).abs().to_f64();
            largest = largest.max(change / f64::EPSILON);
        }
    }
    Ok((center, largest))
}

/// θ after `1/distance` half periods of β, whole ones.
fn long_times(k: f64, p_theta: f64, distances: &[f64]) -> Result<Vec<Case>, SpinError> {
    let start = Start::new(k, p_theta)?;
    let constants = extremal(&start);
    let elliptic = constants.elliptic.ok_or(SpinError::OutOfDomain {
        what: "p_theta",
        found: p_theta,
        accepted: "not on the separatrix, not zero, and k not 1: β must have a period",
    })?;
    let half_period = 2.0 * elliptic.quarter / constants.rate;
    // A little more than whole half periods: after exactly as many, β is back at the equator and θ has a closed form of its own.
    let times: Vec<f64> = distances.iter().map(|d| (libm::round(1.0 / d) + 0.3) * half_period).collect();
    let known = distances.iter().filter(|d| libm::round(1.0 / **d) <= MOST_HALF_PERIODS).count();
    let integrated = points_by_lift(k, p_theta, &times[..known]);
    let angle = |inputs: &[DoubleDouble]| {
        let [r1, _, r3] = position_in_double_double(inputs[0], inputs[1], inputs[2])?;
        Ok(r3.atan2(r1) + DoubleDouble::PI)
    };
    let mut cases = Vec::with_capacity(times.len());
    for (i, (t, distance)) in times.iter().zip(distances).enumerate() {
        let (truth, condition) = with_condition(&[k, p_theta, *t], angle)?;
        let r = position(&start, *t)?;
        let value = libm::atan2(r[2], r[0]) + PI;
        let claimed = turned(position_error(&start, *t)?, libm::hypot(r[0], r[2]), value);
        let naive = integrated.get(i).map_or(f64::NAN, |r| libm::atan2(r[2], r[0]) + PI);
        let calls = u64::from(CALLS_FOR_CONSTANTS + CALLS_FOR_STATE);
        let work = Work { elliptic_calls: calls, rows: 1, ..Work::default() };
        let route = "closed form: the angle about the momentum".to_owned();
        let whole = 1.0 / libm::round(1.0 / distance);
        cases.push(case(whole, truth, naive, Told { value, claimed }, condition, route, work));
    }
    Ok(cases)
}

#[cfg(test)]
#[path = "spin_tests.rs"]
mod tests;
