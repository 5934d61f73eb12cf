//! Node kinds: what a scene can call for. A kind belongs to its effect, never to a figure.

pub mod counted;
pub mod point;
pub mod product;
pub mod quantities;
pub mod scene;
pub mod serret_andoyer;
