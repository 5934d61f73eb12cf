//! Hard cases of the Serret-Andoyer metric: starts that run into each limit of the conjugate time, answered as `point` answers them.
//!
//! Inputs of every case are exact `f64`; the truth is [`first_conjugate_point_to_reference`], or for long times the path in double-double, and the
//! condition number is the largest difference quotient over inputs moved by one ε, in double-double as well. What the program would lose
//! that knows the printed formulas is in `serret_andoyer_naive.rs`.
//!
//! Where a family says nothing else, the body is the one given, φ0 is at `START` of the way from the equator to the turning point, ascending, h = 1/2.

use super::family::{Case, Refused, Told, check_ends, distances, table};
use super::serret_andoyer_naive::{Chart, Printed, by_integration};
use super::told::{nothing, told};
use crate::contract::accuracy::ARTICLE;
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::point::{self, Given};
use crate::effects::product::{failed, product};
use crate::effects::serret_andoyer::body::Body;
use crate::geometry::serret_andoyer::darboux::FromEquator;
use crate::geometry::serret_andoyer::reference::first_conjugate_point_to_reference;
use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Metric, Start};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sine of the starting angle in units of that at the turning point.
const START: f64 = -0.6;
/// Starting place of the families that near the separatrix from a fixed place.
const PHI0: f64 = -0.5;
/// Starting place of the cusp: so near to the equator that a tenth below the largest `p_θ` is still oscillating.
const CUSP_PHI0: f64 = -0.25;
/// `y0` of the families that start from momenta; `p_x = 1` there.
const Y0: f64 = 1.0;
/// `δ` of the long path: near the separatrix, where the printed period is worst.
const LONG_DELTA: f64 = 1e-6;

/// A family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// `δ → 0`, given.
    Separatrix,
    /// `1 − p_y²(C − Z)/((B − A) p_x² cos²a) → 0`: the same posed by `y0, p_x, p_y`.
    SeparatrixMomenta,
    /// `ψ0 → 0` by `p_θ → √μ(φ0)`, posed by `p_θ`.
    Cusp,
    /// `ξ1 → 0` by `p_θ → A^(−1/2)`, posed by `p_θ`.
    Equator,
    /// `1 − |φ0| α/K → 0`, with δ half of the largest one there.
    StripEnd,
    /// The same with δ smaller than the largest one by the same factor again.
    StripEndWithSeparatrix,
    /// `B/A − 1 → 0`.
    NearOblate,
    /// `C/B − 1 → 0`.
    NearProlate,
    /// The same from momenta, `p_y → p_x` with it, so that the trajectory keeps its kind.
    NearProlateMomenta,
    /// `B/A − 1 = ½ (C/A − 1) → 0`.
    NearSphere,
    /// `1 − ξ1 = (C − B)/(B − A) → 0`: the characteristic of Π tends to 1, its parameter does not. The answer is `x(t1)`.
    ThirdKind,
    /// The place φ after `1/distance` periods.
    LongTime,
}

impl Family {
    /// The name in configs and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Separatrix => "separatrix",
            Self::SeparatrixMomenta => "separatrix-momenta",
            Self::Cusp => "cusp",
            Self::Equator => "equator",
            Self::StripEnd => "strip-end",
            Self::StripEndWithSeparatrix => "strip-end-with-separatrix",
            Self::NearOblate => "near-oblate",
            Self::NearProlate => "near-prolate",
            Self::NearProlateMomenta => "near-prolate-momenta",
            Self::NearSphere => "near-sphere",
            Self::ThirdKind => "third-kind",
            Self::LongTime => "long-time",
        }
    }

    /// What tends to zero, and what is asked.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Separatrix => "t1 near the separatrix: distance is delta",
            Self::SeparatrixMomenta => {
                "t1 near the separatrix, from momenta: distance is 1 - p_y²/(p_y on the separatrix)²"
            }
            Self::Cusp => "t1 from beside the turning point: distance is 1 - p_theta/sqrt(mu(phi0))",
            Self::Equator => "t1 near the steady rotation: distance is 1 - p_theta sqrt(A)",
            Self::StripEnd => {
                "t1 from the edge of the strip: distance is 1 - |phi0| alpha/K, delta half its largest value"
            }
            Self::StripEndWithSeparatrix => {
                "t1 from the edge of the strip, delta smaller than its largest value by the distance"
            }
            Self::NearOblate => "t1 as A and B become equal: distance is B/A - 1",
            Self::NearProlate => "t1 as B and C become equal: distance is C/B - 1",
            Self::NearProlateMomenta => "t1 as B and C become equal, from momenta that do so too: distance is C/B - 1",
            Self::NearSphere => "t1 as A, B and C become equal: distance is B/A - 1",
            Self::ThirdKind => "x(t1) as the characteristic of Pi tends to 1: distance is 1 - xi1 = (C - B)/(B - A)",
            Self::LongTime => "phi after many periods: distance is one over their number",
        }
    }

    /// The unit of what is asked.
    fn unit(self) -> &'static str {
        match self {
            Self::ThirdKind => "rad",
            Self::LongTime => "length",
            _ => "time",
        }
    }

    /// The smallest distance that a sweep is made for.
    fn farthest(self) -> f64 {
        match self {
            // δ is an input: it ends where m' leaves the numbers that can be squared and multiplied.
            Self::Separatrix => 1e-200,
            Self::Cusp => 1e-16,
            // A path of 1e9 periods: φ then has some five digits left.
            Self::LongTime => 1e-9,
            // Below, rounding of the inputs puts the start, or the body, in the limit itself.
            _ => 1e-15,
        }
    }

    /// Whether this family can be swept between two distances with this body.
    ///
    /// # Errors
    /// [`Refused`]: ends in the wrong order or beyond the family's; a first distance at which there is nothing to answer, such as a cusp
    /// whose trajectory rotates.
    pub fn validate(self, body: Body, from: f64, to: f64) -> Result<(), Refused> {
        check_ends(from, to, 1.0, self.farthest())?;
        let sweep = HardCasesSerretAndoyer { family: self, body, from, to, per_decade: 1 };
        let none = match sweep.posed(from).map(|posed| posed.ours()) {
            Ok((told, ..)) if !told.value.is_nan() => return Ok(()),
            Ok((_, reason, _)) => reason,
            Err(error) => error.to_string(),
        };
        Refused::unless(false, "from", from, format!("a distance with an answer for this body ({none})"))
    }
}

/// The cases of one family.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HardCasesSerretAndoyer {
    /// The family.
    pub family: Family,
    /// The body; of some families its A alone, or A and B.
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
    name: "hard-cases-serret-andoyer",
    summary: "starts of the Serret-Andoyer metric that run into a limit: our answer, a naive one, and the truth",
    code: &[
        "effects/hard_cases/serret_andoyer.rs",
        "effects/hard_cases/serret_andoyer_naive.rs",
        "effects/hard_cases/family.rs",
        "effects/hard_cases/told.rs",
        "effects/counted.rs",
        "effects/point",
        "effects/point.rs",
        "effects/product.rs",
        "effects/serret_andoyer/body.rs",
        "geometry",
        "numerics",
        "table",
    ],
    measurement: false,
};

/// A start with its body, and what is asked of it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Posed {
    /// `A, B, C`.
    inertia: [f64; 3],
    start: Start,
    asked: Asked,
}

/// What is asked of a start.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Asked {
    /// The first conjugate time.
    ConjugateTime,
    /// `x` at the first conjugate time.
    ConjugateX,
    /// φ at a time.
    Phi(f64),
}

impl Posed {
    /// The exact answer; NaN where there is none.
    fn truth(&self) -> DoubleDouble {
        let none = DoubleDouble::from_f64(f64::NAN);
        let found = || first_conjugate_point_to_reference(self.inertia, self.start);
        match self.asked {
            Asked::ConjugateTime => found().map_or(none, |point| point.t1),
            Asked::ConjugateX => found().map_or(none, |point| point.x),
            Asked::Phi(t) => {
                let metric = Metric::new_exact(self.inertia);
                let extremal = metric.and_then(|metric| Extremal::new(&metric, self.start.exact()));
                extremal.map_or(none, |extremal| extremal.position(DoubleDouble::from_f64(t)).phi)
            }
        }
    }

    /// The inputs, which an answer may depend on.
    fn inputs(&self) -> [f64; 7] {
        let [a, b, c] = self.inertia;
        let [first, second, third] = match self.start {
            Start::Momenta { y0, p_x, p_y } => [y0, p_x, p_y],
            Start::Darboux { phi0, clairaut: Clairaut::PTheta(p) | Clairaut::Delta(p), .. } => [phi0, p, 0.0],
        };
        [a, b, c, first, second, third, if let Asked::Phi(t) = self.asked { t } else { 0.0 }]
    }

    fn with_inputs(&self, [a, b, c, first, second, third, t]: [f64; 7]) -> Self {
        let start = match self.start {
            Start::Momenta { .. } => Start::Momenta { y0: first, p_x: second, p_y: third },
            Start::Darboux { clairaut: Clairaut::PTheta(_), branch, .. } => {
                Start::Darboux { phi0: first, clairaut: Clairaut::PTheta(second), branch }
            }
            Start::Darboux { clairaut: Clairaut::Delta(_), branch, .. } => {
                Start::Darboux { phi0: first, clairaut: Clairaut::Delta(second), branch }
            }
        };
        let asked = if let Asked::Phi(_) = self.asked { Asked::Phi(t) } else { self.asked };
        Self { inertia: [a, b, c], start, asked }
    }

    /// The condition number: the largest `|∂ ln answer/∂ ln input|`, by differences over one ε to each side; at the edge of what is possible, to
    /// the side that is.
    fn condition(&self, truth: DoubleDouble) -> f64 {
        let inputs = self.inputs();
        let mut most = 0.0_f64;
        for index in (0..inputs.len()).filter(|index| inputs[*index] != 0.0) {
            for factor in [1.0 + f64::EPSILON, 1.0 - f64::EPSILON] {
                let mut moved = inputs;
                moved[index] *= factor;
                let step = ((moved[index] - inputs[index]) / inputs[index]).abs();
                let quotient = ((self.with_inputs(moved).truth() - truth) / truth).to_f64().abs() / step;
                // No number where the neighbour has no answer.
                most = most.max(quotient);
            }
        }
        most
    }

    /// The keys of `point`.
    fn given(&self) -> point::Inputs {
        let [a, b, c, first, second, third, _] = self.inputs();
        let number = |key: &str, x: f64| (key.to_owned(), Given::Number(x));
        let mut given = point::Inputs::from([number("A", a), number("B", b), number("C", c)]);
        match self.start {
            Start::Momenta { .. } => given.extend([number("y0", first), number("p_x", second), number("p_y", third)]),
            Start::Darboux { clairaut, branch, .. } => {
                let key = if let Clairaut::PTheta(_) = clairaut { "p_theta" } else { "delta" };
                let word = if branch == Branch::Ascending { "ascending" } else { "descending" };
                given.extend([number("phi0", first), number(key, second)]);
                given.insert("branch".to_owned(), Given::Word(word.to_owned()));
            }
        }
        given
    }

    /// Our answer, its route and its work.
    fn ours(&self) -> (Told, String, Work) {
        if let Asked::Phi(t) = self.asked {
            let [a, b, c] = self.inertia;
            return match Metric::new(a, b, c).and_then(|metric| Extremal::new(&metric, self.start)) {
                Ok(extremal) => {
                    let at = extremal.position(t);
                    // The phase at a few ε, as `path.rs` guarantees; φ' = p_y √(C − Z).
                    let rate = at.p_y * extremal.metric().c_minus_z_of_cosine(libm::sin(at.y)).sqrt();
                    let claimed = 8.0 * f64::EPSILON * (1.0 + (t * rate / at.phi).abs());
                    let work = Work { elliptic_calls: PATH_CALLS, rows: 1, ..Work::default() };
                    (Told { value: at.phi, claimed }, "closed form of the path".to_owned(), work)
                }
                Err(error) => nothing(error.to_string()),
            };
        }
        let index = if self.asked == Asked::ConjugateX { 1 } else { 0 };
        let answer = point::answer(point::Metric::SerretAndoyer, &self.given(), ARTICLE);
        let (Told { value, claimed }, route, work) = told(answer, index);
        // x' ≤ B p_x, and x ≥ A p_x t: an error of t1 is at most B/A times as large in x; and its own roundings.
        let [a, b, _] = self.inertia;
        let claimed = if index == 1 { b / a * claimed + 8.0 * f64::EPSILON } else { claimed };
        (Told { value, claimed }, route, work)
    }

    fn naive(&self, family: Family, truth: f64) -> f64 {
        let chart = Chart::new(self.inertia, self.start);
        if family == Family::SeparatrixMomenta {
            return by_integration(chart, 2.0 * truth);
        }
        let printed = Printed::new(chart);
        match self.asked {
            Asked::ConjugateTime => printed.conjugate_time(),
            Asked::ConjugateX => printed.x(printed.conjugate_time()),
            Asked::Phi(t) => printed.phi(t),
        }
    }
}

/// Elliptic functions of one position on a path: K, F, two J, sn cn dn am, J, F.
const PATH_CALLS: u64 = 7;

impl HardCasesSerretAndoyer {
    /// The case at a distance.
    ///
    /// # Errors
    /// A body that is none.
    fn posed(&self, distance: f64) -> Result<Posed, NodeError> {
        let Body { a, b, c } = self.body;
        let asked = Asked::ConjugateTime;
        let [a, b, c] = match self.family {
            Family::NearOblate => [a, a + a * distance, c],
            Family::NearProlate | Family::NearProlateMomenta => [a, b, b + b * distance],
            Family::NearSphere => [a, a + a * distance, a + 2.0 * a * distance],
            Family::ThirdKind => [a, b, b + (b - a) * distance],
            _ => [a, b, c],
        };
        let inertia = [a, b, c];
        let metric = Metric::new(a, b, c).map_err(failed("hard cases"))?;
        let darboux = |phi0: f64, delta: f64| Posed {
            inertia,
            start: Start::Darboux { phi0, clairaut: Clairaut::Delta(delta), branch: Branch::Ascending },
            asked,
        };
        // At START of the way to the turning point of the extremal of δ, and with 1 − ξ1 = Bδ/((1 + δ)(B − A)).
        let on_the_way = |delta: f64| {
            let xi1 = ((b - a) - a * delta) / ((1.0 + delta) * (b - a));
            let sine = START * xi1.max(0.0).sqrt();
            let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
            darboux(metric.phi_of_angle(FromEquator { half_turns: 0.0, sine, cosine }), delta)
        };
        let most = (b - a) / a;
        let momenta = |part: f64| {
            let sine = libm::sin(Y0);
            let separatrix = ((b - a) / metric.c_minus_z_of_cosine(sine)).sqrt() * sine;
            Posed { inertia, start: Start::Momenta { y0: Y0, p_x: 1.0, p_y: part * separatrix }, asked }
        };
        let with_p_theta = |posed: Posed, p_theta: f64| match posed.start {
            Start::Darboux { phi0, branch, .. } => {
                Posed { start: Start::Darboux { phi0, clairaut: Clairaut::PTheta(p_theta), branch }, ..posed }
            }
            Start::Momenta { .. } => posed,
        };
        Ok(match self.family {
            Family::Separatrix => darboux(PHI0, distance),
            Family::SeparatrixMomenta | Family::NearProlateMomenta => {
                self.on_this_side(momenta((1.0 - distance).sqrt()))
            }
            Family::Cusp => {
                let largest = 1.0 / metric.z(CUSP_PHI0).sqrt();
                with_p_theta(darboux(CUSP_PHI0, 0.0), largest * (1.0 - distance))
            }
            Family::Equator => {
                let p_theta = metric.equator_clairaut() * (1.0 - distance);
                with_p_theta(on_the_way(most - (most + 1.0) * distance * (2.0 - distance)), p_theta)
            }
            Family::StripEnd | Family::StripEndWithSeparatrix => {
                let phi0 = -metric.half_width() * (1.0 - distance);
                let jacobi = metric.jacobi_of_phi(phi0);
                // δ ≤ B/Z − 1 there.
                let largest = (b - a) * jacobi.cn * jacobi.cn / metric.z_of_sine(jacobi.sn);
                let part = if self.family == Family::StripEnd { 1.0 } else { distance };
                darboux(phi0, 0.5 * largest * part)
            }
            Family::NearOblate | Family::NearProlate | Family::NearSphere => on_the_way(0.5 * most),
            Family::ThirdKind => {
                let gap = (b - a) * distance;
                Posed { asked: Asked::ConjugateX, ..on_the_way(gap / (b - gap)) }
            }
            Family::LongTime => {
                let posed = darboux(PHI0, LONG_DELTA);
                let extremal = Extremal::new(&metric, posed.start).map_err(failed("hard cases"))?;
                let period = 4.0 * extremal.complete_k() / extremal.speed();
                // A quarter of a unit of time past whole periods: φ is neither zero nor at rest.
                Posed { asked: Asked::Phi((1.0 / distance + 0.5).floor() * period + 0.25), ..posed }
            }
        })
    }

    /// The start with `p_y` moved towards zero, one ε at a time, until it lies on the oscillating side of the separatrix.
    fn on_this_side(&self, posed: Posed) -> Posed {
        let mut inputs = posed.inputs();
        for _ in 0..16 {
            if posed.with_inputs(inputs).truth().is_finite() {
                break;
            }
            inputs[5] *= 1.0 - f64::EPSILON;
        }
        posed.with_inputs(inputs)
    }

    /// All cases, the farthest first.
    ///
    /// # Errors
    /// A sweep that [`Family::validate`] refuses; a body that is none.
    pub fn cases(&self) -> Result<Vec<Case>, NodeError> {
        self.family.validate(self.body, self.from, self.to).map_err(failed(self.family.name()))?;
        let case = |distance: f64| -> Result<Case, NodeError> {
            let posed = self.posed(distance)?;
            let truth = posed.truth();
            let (ours, route, work) = posed.ours();
            Ok(Case {
                distance,
                truth: truth.high(),
                truth_rest: truth.low(),
                naive: posed.naive(self.family, truth.high()),
                ours,
                condition: posed.condition(truth),
                route,
                work,
            })
        };
        distances(self.from, self.to, self.per_decade).into_iter().map(case).collect()
    }
}

impl Compute for HardCasesSerretAndoyer {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let cases = self.cases()?;
        let family = self.family;
        let table = table(family.name(), family.unit(), family.meaning(), &cases).map_err(failed(family.name()))?;
        product(&table, cases.iter().map(|case| case.work).sum())
    }
}

#[cfg(test)]
#[path = "serret_andoyer_tests.rs"]
mod tests;
