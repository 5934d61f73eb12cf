//! The effects that a figure's scene calls for beyond those that the figure itself shows.
//!
//! Every figure takes every effect of its metric. What it does not know itself is computed and drawn here, as in a scene of its own: panels under those of the
//! figure, values, a claim. A start that the figure's scene does not have is the default of the metric's module; of a sweep of many values, [`MOST`]
//! evenly chosen ones are computed and drawn.

use super::page::under;
use super::scenery::Scenery;
use super::serret_andoyer::{self, SerretAndoyer};
use super::spin::{self, Keyed, Spin, chosen};
use crate::contract::claim::Claim;
use crate::contract::node::NodeError;
use crate::contract::sweep::Sweep;
use crate::effects::scene::{Effect, Scene, SerretAndoyerMetric, SpinMetric, supported};
use crate::effects::spin::momenta::Momenta;
use crate::experiments::nodes::Nodes;
use crate::plot::picture::Picture;
use crate::table::Tables;

/// Most values of a figure's sweep for which further effects are computed.
pub const MOST: usize = 6;
/// The claim of the further effects.
const CLAIM: &str = "more_routes_agree";

/// What a figure's scene calls for.
#[derive(Clone, Debug)]
pub struct Asked {
    /// Whether any effect of the figure's own.
    pub own: bool,
    /// Further ones.
    pub more: Option<Scenery>,
}

/// The values of a sweep with their keys.
pub fn keyed(sweep: &Sweep, key: &str) -> Vec<Keyed> {
    sweep.values().into_iter().enumerate().map(|(i, value)| (value, sweep.key_of(key, i))).collect()
}

/// Values that stand in no config.
pub fn defaults(values: &[f64]) -> Vec<Keyed> {
    values.iter().map(|value| (*value, String::new())).collect()
}

/// The effects that are not the figure's own, and whether there is one that is.
fn parted<M, S>(scene: &Scene<M, S>, own: &[Effect], metric: &str) -> (bool, Vec<Effect>) {
    let (mine, further): (Vec<Effect>, Vec<Effect>) =
        scene.effects.iter().copied().partition(|effect| own.contains(effect));
    (!mine.is_empty(), further.into_iter().filter(|effect| supported(metric).contains(effect)).collect())
}

impl Asked {
    /// Only effects of the figure's own.
    pub fn own() -> Self {
        Self { own: true, more: None }
    }

    /// In a figure of the spin problem.
    pub fn spin<S>(scene: &Scene<SpinMetric, S>, own: &[Effect], p_theta: Option<Momenta>) -> Self {
        let (own, effects) = parted(scene, own, crate::effects::scene::SPIN);
        let more = (!effects.is_empty()).then(|| {
            Scenery::Spin(Spin {
                effects,
                k: chosen(&keyed(&scene.metric.spin.k, "scene.metric.spin.k"), MOST),
                starts: p_theta.unwrap_or(spin::DEFAULT_STARTS).into(),
                trajectories: spin::DEFAULT_TRAJECTORIES,
                times: defaults(&spin::DEFAULT_TIMES),
                accuracy: scene.accuracy,
            })
        });
        Self { own, more }
    }

    /// In a figure of the Serret-Andoyer metric.
    pub fn serret_andoyer<S>(
        scene: &Scene<SerretAndoyerMetric, S>,
        own: &[Effect],
        phi0: Option<&Sweep>,
        p_theta: Option<&Sweep>,
    ) -> Self {
        let (own, effects) = parted(scene, own, crate::effects::scene::SERRET_ANDOYER);
        let more = (!effects.is_empty()).then(|| {
            let starts =
                phi0.map_or_else(|| defaults(&[serret_andoyer::DEFAULT_PHI0]), |phi0| keyed(phi0, "scene.start.phi0"));
            Scenery::SerretAndoyer(SerretAndoyer {
                effects,
                metric: scene.metric,
                phi0: chosen(&starts, MOST),
                p_theta: p_theta.map(Sweep::values).unwrap_or_default(),
                times: defaults(&serret_andoyer::DEFAULT_TIMES),
                turns: serret_andoyer::DEFAULT_TURNS,
                accuracy: scene.accuracy,
            })
        });
        Self { own, more }
    }

    /// Asks for the nodes of the further effects.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn nodes(&self, nodes: &mut Nodes) -> Result<(), NodeError> {
        self.more.as_ref().map_or(Ok(()), |more| more.nodes(nodes))
    }

    /// A figure's picture with their panels under it.
    ///
    /// # Errors
    /// A table that is missing or can't be drawn.
    pub fn drawn_under(&self, picture: Picture, tables: &Tables) -> Result<Picture, NodeError> {
        match &self.more {
            Some(more) => Ok(under(picture, &more.caption(tables)?, more.blocks(tables)?)),
            None => Ok(picture),
        }
    }

    /// The claims about them.
    ///
    /// # Errors
    /// A table of another form.
    pub fn claims(&self, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        self.more.as_ref().map_or_else(|| Ok(Vec::new()), |more| more.claims(tables, CLAIM))
    }
}
