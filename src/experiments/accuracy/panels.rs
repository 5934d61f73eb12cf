//! The methods as they are drawn, their table of achieved errors, and the panels of both rows.

use crate::contract::node::NodeError;
use crate::experiments::findings::unread;
use crate::plot::axis::Axis;
use crate::plot::mark::{At, Curve, DirectLabel, Points, RuleLine, Side, Text};
use crate::plot::picture::Panel;
use crate::plot::role::{Marker, Role};
use crate::table::Table;

pub(super) const CLOSED_FORM: &str = "closed-form";
const CLOSED_FORM_LANES: &str = "closed-form-lanes";
pub(super) const TAYLOR: &str = "taylor";
pub(super) const TAYLOR_LANES: &str = "taylor-lanes";
pub(super) const TAYLOR_DOUBLE_DOUBLE: &str = "taylor-double-double";
pub(super) const DOP853: &str = "dop853";
const VERNER98: &str = "verner98";
pub(super) const PRINTED_CHART: &str = "printed-chart";

/// What rounding is, for a method.
pub(super) fn epsilon_of(method: &str) -> f64 {
    // 2^-104 and 2^-52.
    if method == TAYLOR_DOUBLE_DOUBLE { 4.930380657631324e-32 } else { f64::EPSILON }
}

/// A method as it is drawn: table, role, shape, words.
struct Drawn {
    method: &'static str,
    role: Role,
    marker: Option<Marker>,
    words: &'static str,
}

const fn drawn(method: &'static str, role: Role, marker: Option<Marker>, words: &'static str) -> Drawn {
    Drawn { method, role, marker, words }
}

const METHODS: [Drawn; 8] = [
    drawn(CLOSED_FORM, Role::SeriesF, None, "closed form"),
    drawn(CLOSED_FORM_LANES, Role::SeriesF, Some(Marker::OpenSquare), "closed form, 8 lanes"),
    drawn(TAYLOR, Role::SeriesA, None, "power series"),
    drawn(TAYLOR_LANES, Role::SeriesA, Some(Marker::OpenTriangle), "power series, 8 lanes"),
    drawn(TAYLOR_DOUBLE_DOUBLE, Role::SeriesD, None, "power series, double-double"),
    drawn(DOP853, Role::SeriesB, None, "DOP853"),
    drawn(VERNER98, Role::SeriesC, None, "Verner 9(8)"),
    drawn(PRINTED_CHART, Role::SeriesE, None, "DOP853 in the angles of Lemma 4.1"),
];

/// A table of achieved errors, read.
pub(super) struct Errors<'t> {
    table: &'t Table,
    pub(super) methods: &'t [String],
    pub(super) asked: &'t [f64],
    pub(super) largest: &'t [f64],
    /// Multiplications per start, or microseconds.
    pub(super) work: Vec<f64>,
}

impl<'t> Errors<'t> {
    pub(super) fn read(table: &'t Table) -> Result<Self, NodeError> {
        let (counts, starts) =
            (table.numbers("multiplications").map_err(unread)?, table.numbers("starts").map_err(unread)?);
        Self::with(table, counts.iter().zip(&starts).map(|(count, starts)| count / starts).collect())
    }

    pub(super) fn timed(table: &'t Table) -> Result<Self, NodeError> {
        Self::with(table, table.f64s("microseconds").map_err(unread)?.to_vec())
    }

    pub(super) fn with(table: &'t Table, work: Vec<f64>) -> Result<Self, NodeError> {
        Ok(Self {
            table,
            methods: table.texts("method").map_err(unread)?,
            asked: table.f64s("asked").map_err(unread)?,
            largest: table.f64s("largest_error").map_err(unread)?,
            work,
        })
    }

    pub(super) fn rows(&self) -> usize {
        self.table.rows()
    }

    pub(super) fn column(&self, name: &str) -> Result<&'t [f64], NodeError> {
        self.table.f64s(name).map_err(unread)
    }

    pub(super) fn of<'a>(&'a self, method: &'a str) -> impl Iterator<Item = usize> + 'a {
        (0..self.rows()).filter(move |row| self.methods[*row] == method)
    }

    pub(super) fn row(&self, method: &str, asked: f64) -> Option<usize> {
        self.of(method).find(|row| self.asked[*row] == asked)
    }

    /// Whether a row of this method has no more error and no more work.
    pub(super) fn is_beaten(&self, row: usize, method: &str) -> bool {
        self.of(method).any(|other| self.largest[other] <= self.largest[row] && self.work[other] <= self.work[row])
    }
}

/// Marks with a line through them, and their name; that of a single mark stands above it.
fn marked(panel: Panel, drawn: &Drawn, points: Vec<(f64, f64)>, label: Option<DirectLabel>) -> Panel {
    let Drawn { role, marker, words, .. } = *drawn;
    let marks = |points| Points { marker, ..Points::new(role, points) }.legend(words);
    match (points.len(), label) {
        (0, _) => panel,
        (1, Some(label)) => panel.mark(marks(points).labels([label.text]).side(Side::Above)),
        (1, None) => panel.mark(marks(points)),
        (_, label) => panel.mark(Curve { label, ..Curve::new(role, points.clone()) }).mark(marks(points)),
    }
}

/// The range of errors drawn: beyond the roundings of double-double, and above careless answers.
const ERRORS: (f64, f64) = (1e-33, 1.0);

/// Every eighth power of ten from `10^-(8 first)` to 1e-32.
fn eighth_powers(first: i32) -> impl Iterator<Item = (f64, String)> {
    let words = |power: i32| if power == 0 { "1".to_owned() } else { format!("10^{{−{power}}}") };
    (first..=4).map(move |i| (libm::pow(10.0, f64::from(-8 * i)), words(8 * i)))
}

pub(super) fn error_axis() -> Axis {
    Axis::new("largest relative error").log().fixed(ERRORS.0, ERRORS.1).ticks_at(eighth_powers(0))
}

pub(super) fn rounding() -> RuleLine {
    let label = DirectLabel::new("*ε* of f64").at(At::Start).side(Side::BelowRight);
    RuleLine::horizontal(Role::PoleLine, f64::EPSILON).label(label)
}

/// The methods' marks, largest error against work; the first panel names what stands apart.
pub(super) fn work_marks(mut panel: Panel, errors: &Errors<'_>, first: bool) -> Panel {
    for drawn in &METHODS {
        let label = |words: &str, at: At, side: Side| Some(DirectLabel::new(words).at(at).side(side));
        let label = match drawn.method {
            CLOSED_FORM if first => label("closed form", At::End, Side::Above),
            TAYLOR if first => label("power series", At::Fraction(0.3), Side::Left),
            TAYLOR_DOUBLE_DOUBLE if first => label("double-double", At::End, Side::Left),
            PRINTED_CHART if first => label("Lemma 4.1", At::Start, Side::AboveRight),
            _ => None,
        };
        let points = errors.of(drawn.method).map(|row| (errors.work[row], errors.largest[row].max(ERRORS.0))).collect();
        panel = marked(panel, drawn, points, label);
    }
    panel
}

pub(super) fn work_panel(title: &str, errors: &Errors<'_>, first: bool) -> Panel {
    let decades = (3..=7).map(|i| (libm::pow(10.0, f64::from(i)), format!("10^{i}")));
    let x = Axis::new("multiplications per conjugate time").log().fixed(200.0, 1.3e7).ticks_at(decades);
    let mut panel = Panel::new(x, error_axis()).title(title.to_owned()).mark(rounding());
    for (beside, power, words, side) in [(2.5, 8.0, "−8", Side::AboveRight), (1.6, 9.0, "−9", Side::AboveLeft)] {
        if let Some(guide) = power_guide(errors, beside, power) {
            let label = DirectLabel::new(words).at(At::Start).side(side);
            panel = panel.mark(Curve::new(Role::Reference, guide).label(label));
        }
    }
    if let Some(guide) = logarithmic_guide(errors) {
        let label = DirectLabel::new("ln^2").at(At::End).side(Side::Right);
        panel = panel.mark(Curve::new(Role::Reference, guide).label(label));
    }
    work_marks(panel, errors, first)
}

/// Error proportional to work to a power, over four decades, to the right of the marks of the pair of order 9.
fn power_guide(errors: &Errors<'_>, beside: f64, power: f64) -> Option<Vec<(f64, f64)>> {
    let from = errors.of(VERNER98).next()?;
    let through =
        |decades: f64| (beside * errors.work[from] * libm::pow(10.0, decades / power), libm::pow(10.0, -2.0 - decades));
    Some([0.0, 4.0].map(through).to_vec())
}

/// Work growing with the square of the order of power series, to the right of the marks of double-double.
fn logarithmic_guide(errors: &Errors<'_>) -> Option<Vec<(f64, f64)>> {
    let rows: Vec<usize> = errors.of(TAYLOR_DOUBLE_DOUBLE).collect();
    let middle = *rows.get(rows.len() / 2).filter(|_| rows.len() > 2)?;
    let order = |error: f64| 2.0 - 0.5 * libm::log(error);
    let through = |decades: i32| {
        let error = libm::pow(10.0, f64::from(-decades));
        let ratio = order(error) / order(errors.largest[middle]);
        (1.35 * errors.work[middle] * ratio * ratio, error)
    };
    Some((18..=30).map(through).collect())
}

pub(super) fn request_panel(title: &str, errors: &Errors<'_>, first: bool) -> Result<Panel, NodeError> {
    let x = Axis::new("relative error asked for").log().fixed(1e-30, 0.1).ticks_at(eighth_powers(1)).reversed();
    let y = Axis::new("achieved over asked").log().fixed(3e-5, 20.0);
    let equal = DirectLabel::new("as asked").at(At::End).side(Side::AboveLeft);
    let mut panel =
        Panel::new(x, y).title(title.to_owned()).mark(RuleLine::horizontal(Role::Reference, 1.0).label(equal));
    if first {
        panel = panel.mark(Text::new((0.05, 9.0), Side::Right, "marks: largest; lines: median"));
    }
    let median = errors.column("median_error")?;
    // Nothing is asked of a closed form.
    for drawn in METHODS.iter().filter(|drawn| drawn.method != CLOSED_FORM) {
        let over = |error: &[f64]| -> Vec<(f64, f64)> {
            errors
                .of(drawn.method)
                .map(|row| (errors.asked[row], error[row].max(ERRORS.0) / errors.asked[row]))
                .collect()
        };
        let medians = over(median);
        if medians.is_empty() {
            continue;
        }
        if medians.len() > 1 {
            panel = panel.mark(Curve::new(drawn.role, medians));
        }
        panel = panel
            .mark(Points { marker: drawn.marker, ..Points::new(drawn.role, over(errors.largest)) }.legend(drawn.words));
    }
    Ok(panel)
}
