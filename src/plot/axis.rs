//! Axes as an experiment asks for them: label, unit, range, scale, ticks.

use super::label::Label;

/// Which values an axis shows.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Range {
    /// All data (curves, areas, points, arrows, texts of the panel), with a margin of 4 % at each end.
    #[default]
    Auto,
    /// From the first to the second, which must be greater.
    Fixed(f64, f64),
}

/// How values are laid out along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scale {
    /// Equal differences are equally long.
    #[default]
    Linear,
    /// Equal ratios are equally long; every value must be positive.
    Log,
}

/// Where an axis has its ticks.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum Ticks {
    /// At round numbers, as many as there is room for.
    #[default]
    Auto,
    /// At simple multiples of π, as many as there is room for.
    PiMultiples,
    /// At these values with these texts; values outside the range are left out.
    Fixed(Vec<(f64, Label)>),
    /// None.
    None,
}

/// One axis of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it shows, in the markup of [`Label`]: `"*θ*"`.
    pub label: Label,
    /// Unit, drawn in parentheses after the label.
    pub unit: Option<Label>,
    /// Range.
    pub range: Range,
    /// Scale.
    pub scale: Scale,
    /// Ticks.
    pub ticks: Ticks,
    /// Whether values grow to the left or downwards.
    pub reversed: bool,
}

impl Axis {
    /// A linear axis over all data with ticks at round numbers.
    pub fn new(label: impl Into<Label>) -> Self {
        Self {
            label: label.into(),
            unit: None,
            range: Range::Auto,
            scale: Scale::Linear,
            ticks: Ticks::Auto,
            reversed: false,
        }
    }

    /// Sets the unit.
    pub fn unit(mut self, unit: impl Into<Label>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Sets the range.
    pub fn fixed(mut self, low: f64, high: f64) -> Self {
        self.range = Range::Fixed(low, high);
        self
    }

    /// Makes the scale logarithmic.
    pub fn log(mut self) -> Self {
        self.scale = Scale::Log;
        self
    }

    /// Puts the ticks at multiples of π.
    pub fn pi_ticks(mut self) -> Self {
        self.ticks = Ticks::PiMultiples;
        self
    }

    /// Puts the ticks at given values.
    pub fn ticks_at<L: Into<Label>>(mut self, ticks: impl IntoIterator<Item = (f64, L)>) -> Self {
        self.ticks = Ticks::Fixed(ticks.into_iter().map(|(value, text)| (value, text.into())).collect());
        self
    }

    /// Lets values grow to the left or downwards.
    pub fn reversed(mut self) -> Self {
        self.reversed = true;
        self
    }
}
