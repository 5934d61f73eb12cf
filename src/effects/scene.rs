//! The scene of a config: a metric, its parameters and start, the effects that are called for, the accuracy.
//!
//! Every figure's config holds one. Only the effects that it lists become nodes.

use crate::contract::accuracy::Accuracy;
use crate::contract::config::{Invalid, Validate};
use crate::contract::sweep::Sweep;
use serde::{Deserialize, Serialize};

/// An effect that a scene can call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
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
            Self::SwitchPoints => "switch-points",
            Self::TrajectoryTypes => "trajectory-types",
        }
    }
}

/// A scene: `M` is the metric's part of the config, `S` the start's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene<M, S> {
    /// The metric and its parameters.
    pub metric: M,
    /// Where extremals start, and with which momenta.
    pub start: S,
    /// The effects called for: nothing else is computed.
    pub effects: Vec<Effect>,
    /// How accurate results are asked to be.
    #[serde(default)]
    pub accuracy: Accuracy,
}

impl<M, S> Scene<M, S> {
    /// Whether the scene calls for an effect.
    pub fn asks_for(&self, effect: Effect) -> bool {
        self.effects.contains(&effect)
    }

    /// Refuses effects that the experiment can't show, repeated ones, and an empty list.
    ///
    /// # Errors
    /// Which one.
    pub fn validate_effects(&self, supported: &[Effect]) -> Result<(), Invalid> {
        let names: Vec<&str> = supported.iter().map(|effect| effect.name()).collect();
        let accepted = format!("a list of at least one of: {}", names.join(", "));
        Invalid::unless(!self.effects.is_empty(), "scene.effects", "[]", accepted.as_str())?;
        for (index, effect) in self.effects.iter().enumerate() {
            let key = format!("scene.effects[{index}]");
            if !supported.contains(effect) {
                let found = format!("{:?}, which this experiment does not show", effect.name());
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SerretAndoyerMetric {
    /// The metric's parameters.
    #[serde(rename = "serret-andoyer")]
    pub serret_andoyer: Inertia,
}

/// `metric.rotation-group = { A = 1.5, B = 2.0, C = 2.8 }`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RotationGroupMetric {
    /// The metric's parameters.
    #[serde(rename = "rotation-group")]
    pub rotation_group: Inertia,
}

/// The inverse moments of inertia, `A < B < C`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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

impl Inertia {
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

impl Validate for RotationGroupMetric {
    fn validate(&self) -> Result<(), Invalid> {
        self.rotation_group.validate("scene.metric.rotation-group")
    }
}

/// `metric.spin = { k = [0.8, 0.5] }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpinMetric {
    /// The metric's parameters.
    pub spin: SpinParameters,
}

/// The ratio of the couplings of the three spins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpinParameters {
    /// `k = J23/J12 > 0`: a number, a list or a range; one node a value.
    pub k: Sweep,
}

/// `start = { p_theta = 1e-4 }`: one start on the equator of the spin problem, φ(0) = π/2, θ(0) = 0, p_φ(0) = −2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EquatorStart {
    /// `p_θ(0)`, any finite number.
    pub p_theta: f64,
}

/// `start = { p_theta = { from = 1e-4, to = 50, count = 400, spacing = "log" } }`: the same for many `p_θ`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
