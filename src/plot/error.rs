//! What can be wrong with a picture, as values.

use super::role::Role;

/// Why a picture cannot be drawn. Panels and marks are counted from 0, in the order of the picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// A coordinate is infinite, or NaN where the pen cannot be lifted.
    #[error("panel {panel}, mark {mark} ({role:?}): the point ({x}, {y}) is not finite")]
    NotFinite {
        /// Panel.
        panel: usize,
        /// Mark.
        mark: usize,
        /// Its role.
        role: Option<Role>,
        /// First coordinate.
        x: f64,
        /// Second coordinate.
        y: f64,
    },
    /// A value on a logarithmic axis is not positive.
    #[error("panel {panel}: {value} cannot stand on the logarithmic {axis} axis")]
    NotPositive {
        /// Panel.
        panel: usize,
        /// `x` or `y`.
        axis: char,
        /// The value.
        value: f64,
    },
    /// A fixed range is empty, reversed or not finite.
    #[error("panel {panel}: the range of the {axis} axis, {low} to {high}, is empty")]
    EmptyRange {
        /// Panel.
        panel: usize,
        /// `x` or `y`.
        axis: char,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// An automatic range has no data to look at, or an inset's range is automatic.
    #[error("panel {panel}: there is nothing from which the range of the {axis} axis follows")]
    NoRange {
        /// Panel.
        panel: usize,
        /// `x` or `y`.
        axis: char,
    },
    /// A tone or a fraction is outside [0, 1].
    #[error("panel {panel}, mark {mark}: {value} is not between 0 and 1")]
    NotFraction {
        /// Panel.
        panel: usize,
        /// Mark.
        mark: usize,
        /// The value.
        value: f64,
    },
    /// A mark on the sphere in a panel with axes.
    #[error("panel {panel}, mark {mark}: it stands on the sphere, and the panel shows none")]
    NoSphere {
        /// Panel.
        panel: usize,
        /// Mark.
        mark: usize,
    },
    /// A point that should be on the unit sphere is not.
    #[error("panel {panel}, mark {mark}: a point at distance {norm} from the centre is not on the unit sphere")]
    NotOnSphere {
        /// Panel.
        panel: usize,
        /// Mark.
        mark: usize,
        /// Its distance from the centre.
        norm: f64,
    },
    /// As many labels as points are needed, or none.
    #[error("panel {panel}, mark {mark}: {labels} labels for {points} points")]
    LabelCount {
        /// Panel.
        panel: usize,
        /// Mark.
        mark: usize,
        /// Number of labels.
        labels: usize,
        /// Number of points.
        points: usize,
    },
    /// The layout has no cell, or no sensible cell, for a panel.
    #[error("the layout has no room for panel {panel}")]
    NoCell {
        /// Panel.
        panel: usize,
    },
    /// Labels and titles leave no room for the frame.
    #[error("panel {panel}: labels leave {width:.1} pt by {height:.1} pt for the frame")]
    NoRoom {
        /// Panel.
        panel: usize,
        /// What is left, in points.
        width: f64,
        /// What is left, in points.
        height: f64,
    },
    /// The picture's height is not a positive length.
    #[error("a height of {height_mm} mm is not possible")]
    BadHeight {
        /// The height.
        height_mm: f64,
    },
    /// No font of a PDF has a character.
    #[error(
        "{character:?} (U+{code:04X}) in {text:?}: the standard fonts of a PDF do not have it; write the text with others, or give the \
         character a code in plot/pdf.rs",
        code = u32::from(*character)
    )]
    NoCharacter {
        /// The character.
        character: char,
        /// The run of letters that it stands in.
        text: String,
    },
    /// plotters gave up.
    #[error("drawing failed: {0}")]
    Drawing(String),
}
