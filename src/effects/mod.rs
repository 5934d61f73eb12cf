//! Node kinds: what a scene can call for. A kind belongs to its effect, never to a figure.

pub mod counted;
pub mod product;
pub mod scene;
pub mod spin;
