//! What stands in a panel: curves, points, stripes, areas, rules, texts, arrows, and curves and points on the unit sphere.
//!
//! A mark carries a [`Role`], never a colour. Plane coordinates are (x, y) in the axes' own values (on a log axis the values,
//! not their logarithms); sphere coordinates are unit vectors with the north pole at (0, 0, 1).

use super::label::Label;
use super::role::{Marker, Role};

/// Anything that can stand in a panel.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A curve.
    Curve(Curve),
    /// Isolated points.
    Points(Points),
    /// A stripe across the whole panel.
    Band(Band),
    /// The region between two curves.
    Area(Area),
    /// A line across the whole panel.
    Rule(RuleLine),
    /// Words.
    Text(Text),
    /// An arrow.
    Arrow(Arrow),
    /// A curve on the sphere.
    SphereCurve(SphereCurve),
    /// Points on the sphere.
    SpherePoints(SpherePoints),
}

/// On which side of its point a text stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Above.
    Above,
    /// Below.
    Below,
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// Above, to the left.
    AboveLeft,
    /// Above, to the right.
    AboveRight,
    /// Below, to the left.
    BelowLeft,
    /// Below, to the right.
    BelowRight,
    /// On it.
    Centre,
}

/// Where along a curve its label stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum At {
    /// Wherever it covers least.
    Auto,
    /// At the curve's first visible point.
    Start,
    /// At the curve's last visible point.
    End,
    /// At this fraction of the list of its points, 0 to 1.
    Fraction(f64),
}

/// The name of a curve written beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct DirectLabel {
    /// The words.
    pub text: Label,
    /// Where along the curve.
    pub at: At,
    /// On which side; `None` for the side where it covers least.
    pub side: Option<Side>,
}

impl DirectLabel {
    /// Wherever it covers least.
    pub fn new(text: impl Into<Label>) -> Self {
        Self { text: text.into(), at: At::Auto, side: None }
    }

    /// At this place.
    pub fn at(mut self, at: At) -> Self {
        self.at = at;
        self
    }

    /// On this side.
    pub fn side(mut self, side: Side) -> Self {
        self.side = Some(side);
        self
    }
}

impl<T: Into<Label>> From<T> for DirectLabel {
    fn from(text: T) -> Self {
        Self::new(text)
    }
}

/// A curve. A point with a NaN in it lifts the pen.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Role.
    pub role: Role,
    /// Points in order.
    pub points: Vec<(f64, f64)>,
    /// Name beside the curve.
    pub label: Option<DirectLabel>,
    /// Place of the curve in an ordered family, 0 to 1: it then takes its colour from batlow, all else from its role.
    pub tone: Option<f64>,
    /// Fractions of the curve's length, 0 to 1, at which an arrow head shows the direction.
    pub arrows: Vec<f64>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl Curve {
    /// A curve with no label.
    pub fn new(role: Role, points: Vec<(f64, f64)>) -> Self {
        Self { role, points, label: None, tone: None, arrows: Vec::new(), legend: None }
    }

    /// Names the curve beside it.
    pub fn label(mut self, label: impl Into<DirectLabel>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Gives the curve its place in an ordered family.
    pub fn tone(mut self, tone: f64) -> Self {
        self.tone = Some(tone);
        self
    }

    /// Shows the direction at this fraction of its length.
    pub fn arrow(mut self, fraction: f64) -> Self {
        self.arrows.push(fraction);
        self
    }

    /// Explains the curve in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// Isolated points; every coordinate must be finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Points {
    /// Role.
    pub role: Role,
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// Shape; `None` for the role's own.
    pub marker: Option<Marker>,
    /// Texts beside the points: none, or one for each point.
    pub labels: Vec<Label>,
    /// On which side the texts stand; `None` for the side where they cover least.
    pub side: Option<Side>,
    /// Place in an ordered family, 0 to 1.
    pub tone: Option<f64>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl Points {
    /// Points with no labels.
    pub fn new(role: Role, points: Vec<(f64, f64)>) -> Self {
        Self { role, points, marker: None, labels: Vec::new(), side: None, tone: None, legend: None }
    }

    /// Writes texts beside the points, one for each.
    pub fn labels<L: Into<Label>>(mut self, labels: impl IntoIterator<Item = L>) -> Self {
        self.labels = labels.into_iter().map(Into::into).collect();
        self
    }

    /// On this side.
    pub fn side(mut self, side: Side) -> Self {
        self.side = Some(side);
        self
    }

    /// Gives the points their place in an ordered family.
    pub fn tone(mut self, tone: f64) -> Self {
        self.tone = Some(tone);
        self
    }

    /// Explains the points in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// The direction of a rule or of a stripe's edges, and the axis its values belong to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Horizontal: the values are values of y.
    X,
    /// Vertical: the values are values of x.
    Y,
}

/// A filled stripe across the whole panel, under everything.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Role.
    pub role: Role,
    /// Direction of the stripe.
    pub along: Along,
    /// One edge.
    pub from: f64,
    /// The other edge.
    pub to: f64,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl Band {
    /// A horizontal stripe between two values of y.
    pub fn horizontal(role: Role, from: f64, to: f64) -> Self {
        Self { role, along: Along::X, from, to, legend: None }
    }

    /// A vertical stripe between two values of x.
    pub fn vertical(role: Role, from: f64, to: f64) -> Self {
        Self { role, along: Along::Y, from, to, legend: None }
    }

    /// Explains the stripe in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// The filled region between two curves; every coordinate must be finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Role.
    pub role: Role,
    /// One edge.
    pub lower: Vec<(f64, f64)>,
    /// The other edge, in the same direction.
    pub upper: Vec<(f64, f64)>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl Area {
    /// The region between two curves that run in the same direction.
    pub fn new(role: Role, lower: Vec<(f64, f64)>, upper: Vec<(f64, f64)>) -> Self {
        Self { role, lower, upper, legend: None }
    }

    /// Explains the region in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// A straight line across the whole panel; left out when its value is outside the range.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleLine {
    /// Role.
    pub role: Role,
    /// Direction.
    pub along: Along,
    /// Where it crosses the other axis.
    pub at: f64,
    /// Name beside the line.
    pub label: Option<DirectLabel>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl RuleLine {
    /// A horizontal line at a value of y.
    pub fn horizontal(role: Role, at: f64) -> Self {
        Self { role, along: Along::X, at, label: None, legend: None }
    }

    /// A vertical line at a value of x.
    pub fn vertical(role: Role, at: f64) -> Self {
        Self { role, along: Along::Y, at, label: None, legend: None }
    }

    /// Names the line beside it.
    pub fn label(mut self, label: impl Into<DirectLabel>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Explains the line in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// Words at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    /// Where.
    pub at: (f64, f64),
    /// On which side of that place.
    pub side: Side,
    /// The words.
    pub text: Label,
    /// Whose colour they take.
    pub role: Option<Role>,
}

impl Text {
    /// Black words.
    pub fn new(at: (f64, f64), side: Side, text: impl Into<Label>) -> Self {
        Self { at, side, text: text.into(), role: None }
    }
}

/// An arrow.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrow {
    /// Role.
    pub role: Role,
    /// Tail.
    pub from: (f64, f64),
    /// Head.
    pub to: (f64, f64),
}

/// A curve on the unit sphere; a point with a NaN in it lifts the pen. Its back part is drawn thinner and lighter.
#[derive(Clone, Debug, PartialEq)]
pub struct SphereCurve {
    /// Role.
    pub role: Role,
    /// Unit vectors in order (to 1e-6).
    pub points: Vec<[f64; 3]>,
    /// Name beside the curve (beside its front part when it has one).
    pub label: Option<DirectLabel>,
    /// Place in an ordered family, 0 to 1.
    pub tone: Option<f64>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl SphereCurve {
    /// A curve with no label.
    pub fn new(role: Role, points: Vec<[f64; 3]>) -> Self {
        Self { role, points, label: None, tone: None, legend: None }
    }

    /// Names the curve beside it.
    pub fn label(mut self, label: impl Into<DirectLabel>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// Gives the curve its place in an ordered family.
    pub fn tone(mut self, tone: f64) -> Self {
        self.tone = Some(tone);
        self
    }

    /// Explains the curve in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

/// Isolated points on the unit sphere. Those on the back are smaller and lighter.
#[derive(Clone, Debug, PartialEq)]
pub struct SpherePoints {
    /// Role.
    pub role: Role,
    /// Unit vectors (to 1e-6).
    pub points: Vec<[f64; 3]>,
    /// Shape; `None` for the role's own.
    pub marker: Option<Marker>,
    /// Texts beside the points: none, or one for each point.
    pub labels: Vec<Label>,
    /// On which side the texts stand; `None` for the side where they cover least.
    pub side: Option<Side>,
    /// Explanation in the legend.
    pub legend: Option<Label>,
}

impl SpherePoints {
    /// Points with no labels.
    pub fn new(role: Role, points: Vec<[f64; 3]>) -> Self {
        Self { role, points, marker: None, labels: Vec::new(), side: None, legend: None }
    }

    /// Writes texts beside the points, one for each.
    pub fn labels<L: Into<Label>>(mut self, labels: impl IntoIterator<Item = L>) -> Self {
        self.labels = labels.into_iter().map(Into::into).collect();
        self
    }

    /// Explains the points in the legend.
    pub fn legend(mut self, text: impl Into<Label>) -> Self {
        self.legend = Some(text.into());
        self
    }
}

macro_rules! into_mark {
    ($($variant:ident from $type:ty),*) => {
        $(impl From<$type> for Mark {
            fn from(mark: $type) -> Self {
                Mark::$variant(mark)
            }
        })*
    };
}

into_mark!(Curve from Curve, Points from Points, Band from Band, Area from Area, Rule from RuleLine, Text from Text,
    Arrow from Arrow, SphereCurve from SphereCurve, SpherePoints from SpherePoints);
