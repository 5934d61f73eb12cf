//! Hard cases on SO(3): starts that run into each limit of the first conjugate time, answered as `point` answers them.
//!
//! Inputs of every case are exact `f64`; the truth is [`first_two_conjugate_times_to_reference`], or for long times the direction of the
//! momentum in double-double. The condition number is the largest difference quotient over inputs moved by one ε, in double-double as
//! well where the closed form resolves the start. What a straightforward program loses is in `rotation_group_naive.rs`.
//!
//! Where a family says nothing else the body is the one given, and the momentum `MOMENTUM`.

use super::family::{Case, Refused, Told, check_ends, distances, table};
use super::rotation_group_naive::{cosines_in_the_chart, first_sign_change, printed_momentum};
use super::told::{nothing, told};
use crate::contract::accuracy::ARTICLE;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::point::{self, Given};
use crate::effects::product::{failed, product};
use crate::effects::rotation_group::start::Body;
use crate::geometry::rotation_group::euler_angles::EulerPoint;
use crate::geometry::rotation_group::first_two::{
    FirstTwo, first_two_conjugate_times, first_two_conjugate_times_to_reference, relative_change, steady_cosine,
    steady_period,
};
use crate::geometry::rotation_group::metric::Metric;
use crate::geometry::rotation_group::polhode_curve::{Polhode, Start};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A momentum near no limit, of any body.
const MOMENTUM: [f64; 3] = [0.5, -0.3, 0.8];
/// Φ2's companions at a pole: Φ3, p2, p3, and q, the momentum that the printed formula cancels.
const PHI3: f64 = 0.7;
const P2: f64 = 0.4;
const P3: f64 = 1.0;
const Q: f64 = 0.5;
/// Long times end this part of a period after a whole number of them: where the momentum moves.
const PART: f64 = 0.3;

/// Relative step of difference quotients in `f64`: their errors are 1e-9 by rounding and 1e-6 by curvature.
const COARSE: f64 = 1e-6;

/// A family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// `B/A − 1 = ½ (C/A − 1) → 0`: double conjugate times.
    NearSphere,
    /// `B/A − 1 → 0`.
    NearOblate,
    /// `C/B − 1 → 0`.
    NearProlate,
    /// The momentum tends to the third principal axis.
    StableAxis,
    /// The momentum tends to the first principal axis.
    StableAxisFirst,
    /// The momentum tends to the middle principal axis.
    MiddleAxis,
    /// The momentum tends to the separating polhode, away from the middle axis.
    SeparatingPolhode,
    /// `Φ2 → 0` with a momentum across the axis.
    EulerPole,
    /// `Φ2 → 0` with `p1 = p3`: the limit exists.
    EulerPoleLimit,
    /// The cosine of the angle between M and the third axis after `1/distance` periods.
    LongTime,
    /// `A/C → 0` with B = 4A/3.
    LargeAnisotropy,
}

impl Family {
    /// The name in configs and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::NearSphere => "near-sphere",
            Self::NearOblate => "near-oblate",
            Self::NearProlate => "near-prolate",
            Self::StableAxis => "stable-axis",
            Self::StableAxisFirst => "stable-axis-first",
            Self::MiddleAxis => "middle-axis",
            Self::SeparatingPolhode => "separating-polhode",
            Self::EulerPole => "euler-pole",
            Self::EulerPoleLimit => "euler-pole-limit",
            Self::LongTime => "long-time",
            Self::LargeAnisotropy => "large-anisotropy",
        }
    }

    /// What tends to zero, and what is asked.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::NearSphere => "t1 as A, B and C become equal: distance is B/A - 1",
            Self::NearOblate => "t1 as A and B become equal: distance is B/A - 1",
            Self::NearProlate => "t1 as B and C become equal: distance is C/B - 1",
            Self::StableAxis => "t1 near the rotation about the third axis: distance is the part of M across it",
            Self::StableAxisFirst => "t1 near the rotation about the first axis: distance is the part of M across it",
            Self::MiddleAxis => "t1 near the rotation about the middle axis: distance is the part of M across it",
            Self::SeparatingPolhode => "t1 near the separating polhode: distance is H3/(H3 there) - 1",
            Self::EulerPole => "t1 from Euler angles near their pole: distance is Phi2",
            Self::EulerPoleLimit => "t1 from Euler angles near their pole, p1 = p3: distance is Phi2",
            Self::LongTime => {
                "cosine between momentum and third axis after many periods: distance is one over their number"
            }
            Self::LargeAnisotropy => "t1 of a body that turns faster and faster about its third axis: distance is A/C",
        }
    }

    /// The unit of what is asked.
    fn unit(self) -> &'static str {
        if self == Self::LongTime { "1" } else { "time" }
    }

    /// The smallest distance that a sweep is made for: below it the inputs are those of the limit itself, or the work too much.
    fn farthest(self) -> f64 {
        match self {
            Self::LongTime => 1e-4,
            // Most of the way by integration in double-double; the closed form in double-double holds as far.
            Self::MiddleAxis | Self::SeparatingPolhode | Self::LargeAnisotropy => 1e-12,
            _ => 1e-15,
        }
    }

    /// Whether this family can be swept between two distances.
    ///
    /// # Errors
    /// [`Refused`]: ends in the wrong order or beyond the family's.
    pub fn validate(self, from: f64, to: f64) -> Result<(), Refused> {
        check_ends(from, to, 1.0, self.farthest())
    }
}

/// The cases of one family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HardCasesRotationGroup {
    /// The family.
    pub family: Family,
    /// The body; of some families its A alone, or A and B, or B and C.
    pub body: Body,
    /// The first distance, and the last one, which is smaller.
    pub from: f64,
    /// The last distance.
    pub to: f64,
    /// Distances a decade.
    pub per_decade: u32,
}

/// The kind.
pub const KIND: Kind = Kind {
    name: "hard-cases-rotation-group",
    summary: "starts on SO(3) that run into a limit: our answer, a naive one, and the truth",
    code: &[
        "effects/hard_cases/rotation_group.rs",
        "effects/hard_cases/rotation_group_naive.rs",
        "effects/hard_cases/family.rs",
        "effects/hard_cases/told.rs",
        "effects/counted.rs",
        "effects/point",
        "effects/point.rs",
        "effects/product.rs",
        "effects/arithmetic.rs",
        "effects/rotation_group/start.rs",
        "geometry",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// How a momentum is given.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Given3 {
    /// In the body.
    Body([f64; 3]),
    /// By Φ2, Φ3 and p1, p2, p3.
    Euler([f64; 2], [f64; 3]),
}

/// A start with its body, and the time at which the cosine is asked, if that is.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Posed {
    /// `A, B, C`.
    inertia: [f64; 3],
    momentum: Given3,
    /// When; none: the first conjugate time is asked.
    time: Option<f64>,
}

impl Posed {
    /// The start.
    ///
    /// # Errors
    /// A body or a momentum that is none.
    fn start(&self) -> Result<Start, NodeError> {
        let [a, b, c] = self.inertia;
        let metric = Metric::new(a, b, c).map_err(failed("hard cases"))?;
        match self.momentum {
            Given3::Body(momentum) => Start::new(&metric, momentum).map_err(failed("hard cases")),
            Given3::Euler([phi2, phi3], momenta) => {
                let point = EulerPoint { angles: [0.0, phi2, phi3], momenta };
                Start::from_euler(&metric, &point).map_err(failed("hard cases"))
            }
        }
    }

    fn inputs(&self) -> [f64; 9] {
        let [a, b, c] = self.inertia;
        let [phi2, phi3, x, y, z] = match self.momentum {
            Given3::Body([x, y, z]) => [0.0, 0.0, x, y, z],
            Given3::Euler([phi2, phi3], [x, y, z]) => [phi2, phi3, x, y, z],
        };
        [a, b, c, phi2, phi3, x, y, z, self.time.unwrap_or(0.0)]
    }

    fn with_inputs(&self, [a, b, c, phi2, phi3, x, y, z, t]: [f64; 9]) -> Self {
        let momentum = match self.momentum {
            Given3::Body(_) => Given3::Body([x, y, z]),
            Given3::Euler(..) => Given3::Euler([phi2, phi3], [x, y, z]),
        };
        Self { inertia: [a, b, c], momentum, time: self.time.map(|_| t) }
    }

    /// The keys of `point`.
    fn given(&self) -> point::Inputs {
        let number = |(key, x): (&str, f64)| (key.to_owned(), Given::Number(x));
        let [a, b, c, phi2, phi3, x, y, z, _] = self.inputs();
        let mut given = point::Inputs::from([("A", a), ("B", b), ("C", c)].map(number));
        match self.momentum {
            Given3::Body(_) => given.extend([("H1", x), ("H2", y), ("H3", z)].map(number)),
            Given3::Euler(..) => {
                given.extend([("Phi2", phi2), ("Phi3", phi3), ("p1", x), ("p2", y), ("p3", z)].map(number));
            }
        }
        given
    }

    /// The exact answer.
    ///
    /// # Errors
    /// No answer.
    fn truth(&self) -> Result<Truth, NodeError> {
        let start = self.start()?;
        match self.time {
            Some(time) => {
                let none = || NodeError::new("hard cases: the momentum of a long time is on the separating polhode");
                let (cosine, _) = steady_cosine(&start, time, |polhode| *polhode).ok_or_else(none)?;
                Ok(Truth::Cosine(cosine))
            }
            None => {
                let found = first_two_conjugate_times_to_reference(&start).map_err(failed("hard cases: the truth"))?;
                Ok(Truth::Times(found))
            }
        }
    }

    /// The condition number: the largest `|∂ ln answer/∂ ln input|`, by differences over one ε.
    ///
    /// # Errors
    /// No answer beside the start.
    fn condition(&self, truth: &Truth) -> Result<f64, NodeError> {
        let inputs = self.inputs();
        let mut most = 0.0_f64;
        for index in (0..inputs.len()).filter(|index| inputs[*index] != 0.0) {
            let mut moved = inputs;
            moved[index] *= 1.0 + f64::EPSILON;
            let step = (moved[index] - inputs[index]) / inputs[index];
            let moved = self.with_inputs(moved);
            let direct = match truth {
                Truth::Times(found) => relative_change(found, &moved.start()?).map(|[first, _]| first),
                Truth::Cosine(_) => None,
            };
            let quotient = match (direct, truth) {
                (Some(change), _) => change / step,
                (None, Truth::Times(found)) => self.quotient(index, found.times[0])?,
                (None, Truth::Cosine(cosine)) => ((moved.truth()?.value() - *cosine) / *cosine).to_f64() / step,
            };
            most = most.max(quotient.abs());
        }
        Ok(most)
    }

    /// The difference quotient of t1 over [`COARSE`], by our own answers: where the closed form does not resolve the start, t1 depends on it
    /// smoothly.
    ///
    /// # Errors
    /// No answer beside the start.
    fn quotient(&self, index: usize, first: f64) -> Result<f64, NodeError> {
        let mut moved = self.inputs();
        moved[index] *= 1.0 + COARSE;
        let there = first_two_conjugate_times(&self.with_inputs(moved).start()?).map_err(failed("hard cases"))?;
        Ok((there.times[0] / first - 1.0) / COARSE)
    }

    /// Our answer, its route and its work.
    fn ours(&self) -> Result<(Told, String, Work), NodeError> {
        if let Some(time) = self.time {
            let found = steady_cosine(&self.start()?, time, Polhode::rounded);
            let work = Work { elliptic_calls: COSINE_CALLS, rows: 1, ..Work::default() };
            return Ok(found.map_or_else(
                || nothing("on the separating polhode".to_owned()),
                |(value, claimed)| (Told { value, claimed }, "closed form of the momentum".to_owned(), work),
            ));
        }
        Ok(told(point::answer(point::Metric::RotationGroup, &self.given(), ARTICLE), 0))
    }

    fn naive(&self) -> f64 {
        let momentum = match self.momentum {
            Given3::Body(momentum) => momentum,
            Given3::Euler([phi2, phi3], momenta) => printed_momentum(phi2, phi3, momenta),
        };
        first_sign_change(self.inertia, momentum)
    }
}

/// Of one momentum: K, B, J, F of the start with its B and J, sn cn dn am.
const COSINE_CALLS: u64 = 7;

/// An exact answer.
enum Truth {
    Times(FirstTwo),
    Cosine(DoubleDouble),
}

impl Truth {
    fn value(&self) -> DoubleDouble {
        match self {
            Self::Times(found) => DoubleDouble::from_sum(found.times[0], found.rests[0]),
            Self::Cosine(cosine) => *cosine,
        }
    }
}

impl HardCasesRotationGroup {
    /// The case at a distance.
    ///
    /// # Errors
    /// A body that has no separating polhode, where a period is needed.
    fn posed(&self, distance: f64) -> Result<Posed, NodeError> {
        let (Body { a, b, c }, d) = (self.body, distance);
        let inertia = match self.family {
            Family::NearSphere => [a, a + a * d, a + 2.0 * a * d],
            Family::NearOblate => [a, a + a * d, c],
            Family::NearProlate => [a, b, b + b * d],
            Family::LargeAnisotropy => [a, a * 4.0 / 3.0, a / d],
            _ => [a, b, c],
        };
        let momentum = match self.family {
            Family::StableAxis => Given3::Body([0.6 * d, 0.8 * d, 1.0]),
            Family::StableAxisFirst => Given3::Body([1.0, 0.6 * d, 0.8 * d]),
            Family::MiddleAxis => Given3::Body([0.6 * d, 1.0, 0.8 * d]),
            Family::SeparatingPolhode => {
                let there = libm::sqrt((b - a) / (c - b));
                Given3::Body([0.8, 0.6, 0.8 * there * (1.0 + d)])
            }
            Family::EulerPole => {
                let (sine, cosine) = libm::sincos(d);
                Given3::Euler([d, PHI3], [P3 * cosine + Q * sine, P2, P3])
            }
            Family::EulerPoleLimit => Given3::Euler([d, PHI3], [P3, P2, P3]),
            _ => Given3::Body(MOMENTUM),
        };
        let posed = Posed { inertia, momentum, time: None };
        if self.family != Family::LongTime {
            return Ok(posed);
        }
        let none = || NodeError::new("long-time: the momentum of this body has no period");
        let period = steady_period(&posed.start()?).ok_or_else(none)?;
        Ok(Posed { time: Some(period * ((1.0 / d).floor() + PART)), ..posed })
    }

    /// The cases.
    ///
    /// # Errors
    /// A sweep that [`Family::validate`] refuses; a truth that could not be found.
    pub fn cases(&self) -> Result<Vec<Case>, NodeError> {
        self.family.validate(self.from, self.to).map_err(failed(self.family.name()))?;
        let distances = distances(self.from, self.to, self.per_decade);
        let posed = distances.iter().map(|distance| self.posed(*distance)).collect::<Result<Vec<_>, _>>()?;
        // One integration for all times.
        let long: Option<Vec<f64>> = posed.iter().map(|posed| posed.time).collect();
        let Body { a, b, c } = self.body;
        let in_chart = long.map(|times| cosines_in_the_chart([a, b, c], MOMENTUM, &times));
        let mut cases = Vec::with_capacity(posed.len());
        for (i, (posed, distance)) in posed.iter().zip(distances).enumerate() {
            let truth = posed.truth()?;
            let (ours, route, work) = posed.ours()?;
            cases.push(Case {
                distance,
                truth: truth.value().high(),
                truth_rest: truth.value().low(),
                naive: in_chart.as_ref().map_or_else(|| posed.naive(), |values| values[i]),
                ours,
                condition: posed.condition(&truth)?,
                route,
                work,
            });
        }
        Ok(cases)
    }
}

impl Compute for HardCasesRotationGroup {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let cases = self.cases()?;
        let family = self.family;
        let table = table(family.name(), family.unit(), family.meaning(), &cases).map_err(failed(family.name()))?;
        let mut work = Work::default();
        cases.iter().for_each(|case| work += case.work);
        product(&table, work)
    }
}

#[cfg(test)]
#[path = "rotation_group_tests.rs"]
mod tests;
