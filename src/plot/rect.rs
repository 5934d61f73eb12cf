//! Rectangles on the page, and the room that texts take there.

/// What a text is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextKind {
    /// At a tick of a horizontal axis.
    TickX,
    /// At a tick of a vertical axis.
    TickY,
    /// Name of an axis.
    AxisLabel,
    /// Letter or title of a panel.
    PanelTitle,
    /// Beside a curve, a point or a line, or where the experiment put it.
    Direct,
    /// In a legend or a colour key.
    Legend,
}

/// An upright rectangle on the page, in points from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Rect {
    /// Width.
    pub fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height.
    pub fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Whether the two have more than `slack` points in common in both directions.
    pub fn overlaps(&self, other: &Rect, slack: f64) -> bool {
        self.left + slack < other.right
            && other.left + slack < self.right
            && self.top + slack < other.bottom
            && other.top + slack < self.bottom
    }

    /// Whether `other` lies inside, up to `slack` points.
    pub fn holds(&self, other: &Rect, slack: f64) -> bool {
        other.left >= self.left - slack
            && other.right <= self.right + slack
            && other.top >= self.top - slack
            && other.bottom <= self.bottom + slack
    }

    /// Larger by `by` points on every side.
    pub fn grown(&self, by: f64) -> Rect {
        Rect { left: self.left - by, top: self.top - by, right: self.right + by, bottom: self.bottom + by }
    }
}

/// A text on the page and the room it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct TextBox {
    /// The letters.
    pub text: String,
    /// What it is for.
    pub kind: TextKind,
    /// Its panel, counted from 0; `None` for the figure's own texts.
    pub panel: Option<usize>,
    /// Its box.
    pub rect: Rect,
}
