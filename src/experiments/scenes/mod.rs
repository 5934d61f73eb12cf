//! What scenes are made of, metric by metric: nodes, panels, words, values. A config of kind `scene` is nothing else; in a figure, the effects that
//! the figure itself does not have come from here.

pub mod attitude;
pub mod curvature;
pub mod curves;
pub mod findings;
pub mod more;
pub mod page;
pub mod potential;
pub mod rotation_group;
pub mod scenery;
pub mod serret_andoyer;
pub mod spin;
