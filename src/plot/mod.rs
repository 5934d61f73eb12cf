//! Pictures: a declarative [`Picture`](picture::Picture) in, deterministic SVG bytes out. The only room that names plotters.
//!
//! An experiment says *what* is drawn (panels, axes, marks, each with a [`Role`](role::Role)); this room decides *how*:
//! colours, dashes, widths, ticks, places of labels. One role keeps one look in all figures.
//!
//! - `picture`, `axis`, `mark`, `role`, `label`: the data model an experiment builds.
//! - `render`: checks the picture, lays the panels out, draws them; [`render::render`] is the one way out.
//! - `layout`, `frame`, `ticks`, `pieces`, `sphere`, `clip`, `draw`, `place`, `legend`, `colour`, `font`: how.
//! - `backend`: the plotters backend that reads plotters' integers as hundredths of a point; `svg`, `svg_text`, `rect`:
//!   the document it writes; `pdf`: the same page as PDF.
//!
//! Lengths on paper are points (1 pt = 1/72 inch) unless a name says millimetres. Coordinates that reach the page are
//! whole hundredths of a point, so the bytes do not depend on how a platform prints floating-point numbers. This room does
//! not know what a geodesic is, and it takes no data but the numbers it is handed.

pub mod axis;
pub mod backend;
pub mod clip;
pub mod colour;
pub mod draw;
pub mod error;
pub mod font;
pub mod frame;
pub mod label;
pub mod layout;
pub mod legend;
pub mod mark;
pub mod pdf;
pub mod picture;
pub mod pieces;
pub mod place;
pub mod rect;
pub mod render;
pub mod role;
pub mod sphere;
pub mod svg;
pub mod svg_text;
pub mod ticks;

#[cfg(test)]
mod gallery;
