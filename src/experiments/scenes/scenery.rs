//! A scene of whichever metric.

use super::page::Block;
use super::rotation_group::RotationGroup;
use super::serret_andoyer::SerretAndoyer;
use super::spin::Spin;
use crate::contract::claim::Claim;
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::experiments::nodes::Nodes;
use crate::table::Tables;

/// A scene of one of the metrics.
#[derive(Clone, Debug)]
pub enum Scenery {
    /// Of the Serret-Andoyer metric.
    SerretAndoyer(SerretAndoyer),
    /// Of the spin problem.
    Spin(Spin),
    /// Of the rotation group.
    RotationGroup(RotationGroup),
}

impl Scenery {
    /// Asks for the nodes of its effects, and no others.
    ///
    /// # Errors
    /// Parameters that can't be written as a manifest.
    pub fn nodes(&self, nodes: &mut Nodes) -> Result<(), NodeError> {
        match self {
            Self::SerretAndoyer(scene) => scene.nodes(nodes),
            Self::Spin(scene) => scene.nodes(nodes),
            Self::RotationGroup(scene) => scene.nodes(nodes),
        }
    }

    /// Its panels.
    ///
    /// # Errors
    /// A table that is missing or of another form.
    pub fn blocks(&self, tables: &Tables) -> Result<Vec<Block>, NodeError> {
        match self {
            Self::SerretAndoyer(scene) => scene.blocks(tables),
            Self::Spin(scene) => scene.blocks(tables),
            Self::RotationGroup(scene) => scene.blocks(tables),
        }
    }

    /// What they show.
    ///
    /// # Errors
    /// A table that is missing.
    pub fn caption(&self, tables: &Tables) -> Result<String, NodeError> {
        match self {
            Self::SerretAndoyer(scene) => scene.caption(tables),
            Self::Spin(scene) => scene.caption(tables),
            Self::RotationGroup(scene) => Ok(scene.caption()),
        }
    }

    /// Its named values.
    ///
    /// # Errors
    /// A table of another form.
    pub fn values(&self, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        match self {
            Self::SerretAndoyer(scene) => scene.values(tables),
            Self::Spin(scene) => scene.values(tables),
            Self::RotationGroup(scene) => scene.values(tables),
        }
    }

    /// The claim `id` that its routes agree, where it has second routes.
    ///
    /// # Errors
    /// A table of another form.
    pub fn claims(&self, tables: &Tables, id: &str) -> Result<Vec<Claim>, NodeError> {
        match self {
            Self::SerretAndoyer(scene) => scene.claims(tables, id),
            Self::Spin(scene) => scene.claims(tables, id),
            Self::RotationGroup(scene) => scene.claims(tables, id),
        }
    }
}
