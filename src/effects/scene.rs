//! The scene of a config: a metric, its parameters and start, the effects that are called for, the accuracy.
//!
//! Every figure's config holds one. Only the effects that it lists become nodes.

use crate::contract::accuracy::Accuracy;
use crate::contract::config::{Invalid, Validate};
use crate::contract::sweep::Sweep;
use crate::effects::spin::momenta::Momenta;
use crate::geometry::rotation_group::euler_angles::SMALLEST_SINE;
use crate::geometry::serret_andoyer::Metric;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An effect that a scene can call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Effect {
    /// Trajectories of the metric.
    Geodesics,
    /// First conjugate points of all directions, by the first route and by the second.
    ConjugateLocus,
    /// The cut locus.
    CutLocus,
    /// Points at equal distance from the start.
    WaveFront,
    /// Gauss curvature and the metric's coefficient.
    Curvature,
    /// The potential of the Clairaut reduction.
    Potential,
    /// Period and first return.
    Period,
    /// Attitude of the body: Euler angles along a trajectory.
    Attitude,
    /// First two conjugate times of single trajectories, by the first route and by the second.
    ConjugateTimes,
    /// What a trajectory on SO(3) projects to in the Serret-Andoyer variables.
    Projection,
    /// Parameters at which the first conjugate point passes a pole or the equator.
    SwitchPoints,
    /// Trajectories sorted into types by what they do up to a first exit.
    TrajectoryTypes,
}

impl Effect {
    /// The name in configs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Geodesics => "geodesics",
            Self::ConjugateLocus => "conjugate-locus",
            Self::CutLocus => "cut-locus",
            Self::WaveFront => "wave-front",
            Self::Curvature => "curvature",
            Self::Potential => "potential",
            Self::Period => "period",
            Self::Attitude => "attitude",
            Self::ConjugateTimes => "conjugate-times",
            Self::Projection => "projection",
            Self::SwitchPoints => "switch-points",
            Self::TrajectoryTypes => "trajectory-types",
        }
    }
}

/// The name of the Serret-Andoyer metric in configs.
pub const SERRET_ANDOYER: &str = "serret-andoyer";
/// The name of the spin problem's metric in configs.
pub const SPIN: &str = "spin";
/// The name of the metric on SO(3) in configs.
pub const ROTATION_GROUP: &str = "rotation-group";

/// The metrics, and the effects that each supports: in a scene, and in every figure of that metric. A figure can have effects of its own
/// beside them.
pub const METRICS: &[(&str, &[Effect])] = &[
    (
        SERRET_ANDOYER,
        &[
            Effect::Geodesics,
            Effect::ConjugateLocus,
            Effect::CutLocus,
            Effect::WaveFront,
            Effect::Curvature,
            Effect::Potential,
            Effect::Period,
        ],
    ),
    (SPIN, &[Effect::Geodesics, Effect::ConjugateLocus, Effect::CutLocus, Effect::WaveFront]),
    (ROTATION_GROUP, &[Effect::Attitude, Effect::ConjugateTimes, Effect::Projection]),
];

/// The effects that a metric supports; none for a name that is no metric.
pub fn supported(metric: &str) -> &'static [Effect] {
    METRICS.iter().find(|(name, _)| *name == metric).map_or(&[], |(_, effects)| effects)
}

/// A scene: `M` is the metric's part of the config, `S` the start's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene<M, S> {
    /// The metric and its parameters.
    pub metric: M,
    /// Where extremals start, and with which momenta.
    pub start: S,
    /// The effects called for: nothing else is computed.
    pub effects: Vec<Effect>,
    /// How accurate results are asked to be: `"draft"` (1e-4), `"article"` (1e-14), `"reference"` (double-double arithmetic, rounded), or a relative error from 1e-28 to 0.1.
    #[serde(default)]
    pub accuracy: Accuracy,
}

impl<M, S> Scene<M, S> {
    /// Whether the scene calls for an effect.
    pub fn asks_for(&self, effect: Effect) -> bool {
        self.effects.contains(&effect)
    }

    /// Refuses effects that neither the experiment itself (`own`) nor its metric supports, repeated ones, and an empty list.
    ///
    /// # Errors
    /// Which one.
    pub fn validate_effects(&self, own: &[Effect], metric: &str) -> Result<(), Invalid> {
        let more = supported(metric).iter().filter(|effect| !own.contains(effect));
        let supported: Vec<Effect> = own.iter().chain(more).copied().collect();
        let names: Vec<&str> = supported.iter().map(|effect| effect.name()).collect();
        let accepted = format!("a list of at least one of: {}", names.join(", "));
        Invalid::unless(!self.effects.is_empty(), "scene.effects", "[]", accepted.as_str())?;
        for (index, effect) in self.effects.iter().enumerate() {
            let key = format!("scene.effects[{index}]");
            if !supported.contains(effect) {
                let found = format!("{:?}, which neither this experiment nor its metric has", effect.name());
                return Err(Invalid::new(key, found, accepted));
            }
            if self.effects[..index].contains(effect) {
                return Err(Invalid::new(key, format!("{:?} again", effect.name()), "each effect once"));
            }
        }
        Ok(())
    }
}

/// `metric.serret-andoyer = { A = 1.5, B = 2.0, C = 2.8 }`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SerretAndoyerMetric {
    /// The metric's parameters.
    #[serde(rename = "serret-andoyer")]
    pub serret_andoyer: Inertia,
}

/// `metric.rotation-group = { A = 1.5, B = 2.0, C = 2.8 }`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RotationGroupMetric {
    /// The metric's parameters.
    #[serde(rename = "rotation-group")]
    pub rotation_group: Inertia,
}

/// The inverse moments of inertia, `A < B < C`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inertia {
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

impl From<Inertia> for crate::effects::serret_andoyer::body::Body {
    fn from(inertia: Inertia) -> Self {
        Self { a: inertia.a, b: inertia.b, c: inertia.c }
    }
}

impl From<Inertia> for crate::effects::rotation_group::start::Body {
    fn from(inertia: Inertia) -> Self {
        Self { a: inertia.a, b: inertia.b, c: inertia.c }
    }
}

/// `start = { cases = [{ Phi = [0.0, 2.8506, -0.32175], p = [0.0, 0.0, 0.3155946] }] }`: single extremals on SO(3).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EulerCases {
    /// The extremals, in the order of their panels.
    pub cases: Vec<EulerCase>,
}

/// Euler angles and their momenta.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EulerCase {
    /// Φ1, Φ2, Φ3 (rad), sin Φ2 not zero.
    #[serde(rename = "Phi")]
    pub phi: [f64; 3],
    /// p1, p2, p3, not all zero.
    pub p: [f64; 3],
}

impl From<EulerCase> for crate::effects::rotation_group::start::EulerStart {
    fn from(case: EulerCase) -> Self {
        Self { phi: case.phi, p: case.p }
    }
}

impl EulerCases {
    /// Refuses an empty list, numbers that are not finite, poles of the chart and bodies at rest.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self) -> Result<(), Invalid> {
        Invalid::unless(!self.cases.is_empty(), "scene.start.cases", "[]", "a list of at least one start")?;
        for (i, EulerCase { phi, p }) in self.cases.iter().enumerate() {
            let key = |name: &str| format!("scene.start.cases[{i}].{name}");
            for j in 0..3 {
                Invalid::number(phi[j].is_finite(), key(&format!("Phi[{j}]")), phi[j], "a finite number")?;
                Invalid::number(p[j].is_finite(), key(&format!("p[{j}]")), p[j], "a finite number")?;
            }
            let away = libm::sin(phi[1]).abs() >= SMALLEST_SINE;
            Invalid::number(
                away,
                key("Phi[1]"),
                phi[1],
                "a number with sin Phi2 not 0: there Euler angles have a pole",
            )?;
            Invalid::unless(*p != [0.0; 3], key("p"), "[0, 0, 0]", "momenta that are not all zero")?;
        }
        Ok(())
    }
}

/// `start = { phi0 = 0.0 }`: where extremals of the Serret-Andoyer metric start, in all directions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phi0Start {
    /// Distance from the equator (length), `|phi0| < K(k)/alpha`: a number, a list or a range.
    pub phi0: Sweep,
}

impl Phi0Start {
    /// Refuses starts outside the strip of a metric, whose `K(k)/α` is `half_width`.
    ///
    /// # Errors
    /// The first value outside.
    pub fn validate(&self, half_width: f64) -> Result<(), Invalid> {
        let accepted = format!("|phi0| < K(k)/alpha = {half_width:.6}");
        self.phi0.validate_each("scene.start.phi0", &accepted, |phi0| phi0.abs() < half_width)
    }
}

/// `start = { phi0 = 0.0, p_theta = [0.62, 0.75] }`: a fan of extremals of the Serret-Andoyer metric from one point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FanStart {
    /// Distance from the equator (length), `|phi0| < K(k)/alpha`.
    pub phi0: f64,
    /// Clairaut constants, `|p_theta| ≤ √μ(phi0)`: a number, a list or a range.
    pub p_theta: Sweep,
}

impl FanStart {
    /// Refuses a start outside the strip of a metric and constants that no direction has.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self, inertia: Inertia) -> Result<(), Invalid> {
        let Inertia { a, b, c } = inertia;
        let Ok(metric) = Metric::new(a, b, c) else { return inertia.validate("scene.metric.serret-andoyer") };
        let accepted = format!("|phi0| < K(k)/alpha = {:.6}", metric.half_width());
        let inside = self.phi0.abs() < metric.half_width();
        Invalid::number(inside, "scene.start.phi0", self.phi0, accepted)?;
        let largest = metric.mu(self.phi0).sqrt();
        let accepted = format!("0 <= p_theta <= sqrt(mu(phi0)) = {largest:.6}");
        self.p_theta.validate_each("scene.start.p_theta", &accepted, |p_theta| (0.0..=largest).contains(&p_theta))
    }
}

/// `start = { phi0 = -0.75, p_theta = [0.64, 0.75] }`: a start, and Clairaut constants that it need not have itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phi0Family {
    /// Distance from the equator (length), `|phi0| < K(k)/alpha`.
    pub phi0: f64,
    /// Clairaut constants, `0 ≤ p_theta ≤ A^(−1/2)`: a number, a list or a range.
    pub p_theta: Sweep,
}

impl Phi0Family {
    /// Refuses a start outside the strip of a metric and constants that no extremal has.
    ///
    /// # Errors
    /// The first value that is not accepted.
    pub fn validate(&self, inertia: Inertia) -> Result<(), Invalid> {
        let Inertia { a, b, c } = inertia;
        let Ok(metric) = Metric::new(a, b, c) else { return inertia.validate("scene.metric.serret-andoyer") };
        let accepted = format!("|phi0| < K(k)/alpha = {:.6}", metric.half_width());
        let inside = self.phi0.abs() < metric.half_width();
        Invalid::number(inside, "scene.start.phi0", self.phi0, accepted)?;
        let largest = metric.equator_clairaut();
        let accepted = format!("0 <= p_theta <= A^(-1/2) = {largest:.6}");
        self.p_theta.validate_each("scene.start.p_theta", &accepted, |p_theta| (0.0..=largest).contains(&p_theta))
    }
}

/// `start = { xi1 = [0.4, 0.9], starts = 71 }`: oscillating extremals by `ξ1`, each from several phases.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OscillatingStart {
    /// `ξ1`, between 0 and 1: a number, a list or a range; one node a value.
    pub xi1: Sweep,
    /// Number of starts of each, 1 to 9999.
    pub starts: usize,
}

impl Validate for OscillatingStart {
    fn validate(&self) -> Result<(), Invalid> {
        self.xi1.validate_each("scene.start.xi1", "0 < xi1 < 1 (oscillating)", |xi1| xi1 > 0.0 && xi1 < 1.0)?;
        Invalid::unless((1..=9999).contains(&self.starts), "scene.start.starts", self.starts, "1 to 9999")
    }
}

impl Inertia {
    /// Which config keys the leaves below `body` of a node come from.
    pub fn origins(metric: &str) -> Vec<(&'static str, String)> {
        [("body.A", "A"), ("body.B", "B"), ("body.C", "C")]
            .map(|(leaf, name)| (leaf, format!("scene.metric.{metric}.{name}")))
            .to_vec()
    }

    /// Refuses anything but `0 < A < B < C`, finite, and names the key below `prefix`.
    ///
    /// # Errors
    /// The first value out of order.
    pub fn validate(&self, prefix: &str) -> Result<(), Invalid> {
        let checks = [
            ("A", self.a, self.a > 0.0, "a number above 0".to_owned()),
            ("B", self.b, self.b > self.a, format!("a number above A = {:?} (A < B < C)", self.a)),
            ("C", self.c, self.c > self.b, format!("a number above B = {:?} (A < B < C)", self.b)),
        ];
        for (name, value, right, accepted) in checks {
            Invalid::unless(right && value.is_finite(), format!("{prefix}.{name}"), value, accepted)?;
        }
        Ok(())
    }
}

impl Validate for SerretAndoyerMetric {
    fn validate(&self) -> Result<(), Invalid> {
        self.serret_andoyer.validate("scene.metric.serret-andoyer")
    }
}

impl SerretAndoyerMetric {
    /// The half-width `K(k)/α` of the strip in which starts lie; zero where the inertia is refused.
    pub fn half_width(&self) -> f64 {
        let Inertia { a, b, c } = self.serret_andoyer;
        Metric::new(a, b, c).map_or(0.0, |metric| metric.half_width())
    }
}

impl SerretAndoyerMetric {
    /// The largest Clairaut constant `√μ(φ0)` of a start; zero where the inertia is refused.
    pub fn largest_p_theta(&self, phi0: f64) -> f64 {
        let Inertia { a, b, c } = self.serret_andoyer;
        Metric::new(a, b, c).map_or(0.0, |metric| metric.mu(phi0).sqrt())
    }

    /// The Clairaut constant `A^(−1/2)` of the equator, the largest of all; zero where the inertia is refused.
    pub fn equator_p_theta(&self) -> f64 {
        let Inertia { a, b, c } = self.serret_andoyer;
        Metric::new(a, b, c).map_or(0.0, |metric| metric.equator_clairaut())
    }
}

impl Validate for RotationGroupMetric {
    fn validate(&self) -> Result<(), Invalid> {
        self.rotation_group.validate("scene.metric.rotation-group")
    }
}

/// `metric.spin = { k = [0.8, 0.5] }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinMetric {
    /// The metric's parameters.
    pub spin: SpinParameters,
}

/// The ratio of the couplings of the three spins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinParameters {
    /// `k = J23/J12 > 0`: a number, a list or a range; one node a value.
    pub k: Sweep,
}

/// `start = { p_theta = 1e-4 }`: one start on the equator of the spin problem, φ(0) = π/2, θ(0) = 0, p_φ(0) = −2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EquatorStart {
    /// `p_θ(0)`, any finite number.
    pub p_theta: f64,
}

/// `start = { p_theta = { from = 1e-9, to = 1e4, step = 0.1 } }`: all starts of a branch, θ(0) = 0, φ(0) = π/2, p_φ(0) = −2, H = 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BranchStart {
    /// The momenta `p_θ(0) ≥ 0`; inside a node they are its rows.
    pub p_theta: Momenta,
}

impl Validate for BranchStart {
    fn validate(&self) -> Result<(), Invalid> {
        let Momenta { from, to, step } = self.p_theta;
        let key = |name: &str| format!("scene.start.p_theta.{name}");
        Invalid::number((1e-290..=1.0).contains(&from), key("from"), from, "a number from 1e-290 to 1")?;
        let accepted = format!("a number from 10 to 1e12, above from = {from:?}");
        Invalid::number((10.0..=1e12).contains(&to), key("to"), to, accepted)?;
        Invalid::number((1e-3..=0.5).contains(&step), key("step"), step, "a number from 0.001 to 0.5 (radians)")
    }
}

/// `start = { p_theta = { from = 1e-4, to = 50, count = 400, spacing = "log" } }`: the same for many `p_θ`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EquatorStarts {
    /// `p_θ(0)`: a number, a list or a range.
    pub p_theta: Sweep,
}

impl Validate for SpinMetric {
    fn validate(&self) -> Result<(), Invalid> {
        self.spin.k.validate_each("scene.metric.spin.k", "k > 0", |k| k > 0.0)
    }
}
