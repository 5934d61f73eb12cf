//! What a figure shows, said without colours, widths or positions on paper: pictures, panels, their grid, insets.
//!
//! A picture is built by an experiment and handed to [`render`](super::render::render). Nothing here computes.

use super::axis::Axis;
use super::label::Label;
use super::mark::Mark;

/// The two widths a journal page offers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// One column: 89 mm.
    Single,
    /// The whole page: 183 mm.
    Double,
}

impl Width {
    /// The width in millimetres.
    pub const fn millimetres(self) -> f64 {
        match self {
            Width::Single => 89.0,
            Width::Double => 183.0,
        }
    }
}

/// A whole figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width on paper.
    pub width: Width,
    /// Height on paper in millimetres, legend strip included.
    pub height_mm: f64,
    /// Short title: the SVG's `<title>`, which is also its text for those who cannot see it. Plain text.
    pub title: String,
    /// Caption: written to `<desc>`, not drawn. Plain text.
    pub caption: String,
    /// Where the panels stand.
    pub layout: Layout,
    /// The panels, in reading order.
    pub panels: Vec<Panel>,
    /// Written to `<metadata>` as they are: experiment, parameters, logical hashes of the tables drawn.
    pub metadata: Vec<(String, String)>,
}

impl Picture {
    /// An empty picture: one row, as many columns as panels.
    pub fn new(width: Width, height_mm: f64, title: impl Into<String>) -> Self {
        Self {
            width,
            height_mm,
            title: title.into(),
            caption: String::new(),
            layout: Layout::Columns(0),
            panels: Vec::new(),
            metadata: Vec::new(),
        }
    }

    /// Sets the caption.
    pub fn caption(mut self, caption: impl Into<String>) -> Self {
        self.caption = caption.into();
        self
    }

    /// Sets the layout.
    pub fn layout(mut self, layout: Layout) -> Self {
        self.layout = layout;
        self
    }

    /// Adds a panel.
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// Adds a pair to the metadata.
    pub fn meta(mut self, key: impl Into<String>, value: impl Into<String>) -> Self {
        self.metadata.push((key.into(), value.into()));
        self
    }
}

/// Where the panels stand on the page.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// Equal cells, filled row by row; 0 means one row that holds all panels.
    Columns(usize),
    /// Rows and columns of unequal weight, filled row by row.
    Weighted {
        /// Relative widths of the columns, all > 0.
        columns: Vec<f64>,
        /// Relative heights of the rows, all > 0.
        rows: Vec<f64>,
    },
    /// One cell for each panel.
    Cells(Vec<Cell>),
}

/// A rectangle of the page in fractions of its width and height, from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Left edge, 0 to 1.
    pub left: f64,
    /// Upper edge, 0 to 1.
    pub top: f64,
    /// Width, 0 to 1.
    pub width: f64,
    /// Height, 0 to 1.
    pub height: f64,
}

/// The letter of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Letter {
    /// (a), (b), … when the picture has more than one panel.
    #[default]
    Auto,
    /// No letter.
    None,
    /// This letter.
    Is(char),
}

/// Whether one unit is as long on both axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Aspect {
    /// The frame fills its cell.
    #[default]
    Free,
    /// One unit of x is as long as one unit of y: the frame is made smaller in one direction.
    Equal,
}

/// Where the explanations of a panel's named marks stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Legend {
    /// In a strip under all panels, merged with those of the other panels: never in the way of data.
    #[default]
    Strip,
    /// In that corner of the panel.
    Corner(Corner),
    /// In the corner of the panel that covers least.
    FreeCorner,
    /// Nowhere.
    None,
}

/// A corner of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Upper left.
    UpperLeft,
    /// Upper right.
    UpperRight,
    /// Lower left.
    LowerLeft,
    /// Lower right.
    LowerRight,
}

/// A colour key for marks that carry a tone: a bar to the right of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneKey {
    /// What the tone stands for.
    pub label: Label,
    /// Values along the bar: (tone in [0, 1], text).
    pub ticks: Vec<(f64, Label)>,
}

/// The direction from which a sphere is seen: the viewer is far away over this point of the sphere, north is up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Longitude of the point that faces the viewer, radians.
    pub longitude: f64,
    /// Latitude (from the equator, north positive) of the point that faces the viewer, radians, in [−π/2, π/2].
    pub latitude: f64,
    /// Number of meridians of the graticule (half circles from pole to pole); 0 for none.
    pub meridians: u32,
    /// Number of parallels of the graticule, the equator not counted; 0 for none.
    pub parallels: u32,
}

impl View {
    /// Seen from over (longitude, latitude), in radians, with meridians every 30° and parallels every 30°.
    pub const fn new(longitude: f64, latitude: f64) -> Self {
        Self { longitude, latitude, meridians: 12, parallels: 4 }
    }
}

/// One pair of axes, or one sphere, and what stands in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Letter, bold, above the frame.
    pub letter: Letter,
    /// Title, above the frame.
    pub title: Option<Label>,
    /// Horizontal axis (of a sphere's panel: not drawn).
    pub x: Axis,
    /// Vertical axis (of a sphere's panel: not drawn).
    pub y: Axis,
    /// Aspect.
    pub aspect: Aspect,
    /// What is drawn. The order on paper is that of the roles (fills, lines, points, text), then that of the list.
    pub marks: Vec<Mark>,
    /// Magnified parts.
    pub insets: Vec<Inset>,
    /// Given: the panel shows the unit sphere in orthographic projection instead of axes; sphere marks are allowed and plane
    /// marks are in projected coordinates, [−1, 1] in both directions.
    pub sphere: Option<View>,
    /// Where marks with a `legend` text are explained.
    pub legend: Legend,
    /// Colour key of the tones.
    pub tone_key: Option<ToneKey>,
}

impl Panel {
    /// A panel with these axes and nothing in it.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self {
            letter: Letter::Auto,
            title: None,
            x,
            y,
            aspect: Aspect::Free,
            marks: Vec::new(),
            insets: Vec::new(),
            sphere: None,
            legend: Legend::default(),
            tone_key: None,
        }
    }

    /// A panel that shows the unit sphere.
    pub fn sphere(view: View) -> Self {
        let side = Axis::new("").fixed(-1.03, 1.03);
        Self { sphere: Some(view), aspect: Aspect::Equal, ..Self::new(side.clone(), side) }
    }

    /// Sets the title.
    pub fn title(mut self, title: impl Into<Label>) -> Self {
        self.title = Some(title.into());
        self
    }

    /// Makes one unit as long on both axes.
    pub fn equal(mut self) -> Self {
        self.aspect = Aspect::Equal;
        self
    }

    /// Adds a mark.
    pub fn mark(mut self, mark: impl Into<Mark>) -> Self {
        self.marks.push(mark.into());
        self
    }

    /// Adds marks.
    pub fn marks<M: Into<Mark>>(mut self, marks: impl IntoIterator<Item = M>) -> Self {
        self.marks.extend(marks.into_iter().map(Into::into));
        self
    }

    /// Adds an inset.
    pub fn inset(mut self, inset: Inset) -> Self {
        self.insets.push(inset);
        self
    }

    /// Sets where the legend stands.
    pub fn legend(mut self, legend: Legend) -> Self {
        self.legend = legend;
        self
    }

    /// Sets the colour key.
    pub fn tone_key(mut self, key: ToneKey) -> Self {
        self.tone_key = Some(key);
        self
    }
}

/// Where an inset stands in its panel's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// In a corner.
    Corner(Corner),
    /// In the corner that covers least.
    FreeCorner,
    /// With its lower left corner at this fraction of the frame, from the lower left.
    At(f64, f64),
}

/// A part of a panel drawn again at its own scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Inset {
    /// Horizontal axis: its range must be fixed. Its label is not drawn.
    pub x: Axis,
    /// Vertical axis: its range must be fixed. Its label is not drawn.
    pub y: Axis,
    /// Where it stands.
    pub place: Place,
    /// Its width and height, tick labels included, in fractions of the panel's frame.
    pub size: (f64, f64),
    /// What it shows; `None` for the panel's own marks.
    pub marks: Option<Vec<Mark>>,
    /// Whether the part of the panel that it magnifies is framed and tied to it.
    pub source: bool,
}

impl Inset {
    /// An inset of these ranges of the panel's own marks.
    pub fn new(x: (f64, f64), y: (f64, f64), place: Place, size: (f64, f64)) -> Self {
        let (x, y) = (Axis::new("").fixed(x.0, x.1), Axis::new("").fixed(y.0, y.1));
        Self { x, y, place, size, marks: None, source: true }
    }
}
