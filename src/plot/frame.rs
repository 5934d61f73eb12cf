//! A pair of axes on the page: which values they span, where the frame stands, what is written around it.
//!
//! Values are mapped to the page by plotters' `Cartesian2d`, which is given linear coordinates: on a log axis the decimal
//! logarithms, computed here.

use super::axis::{Axis, Range, Scale};
use super::colour::Colour;
use super::error::PlotError;
use super::label::Label;
use super::rect::{Rect, TextKind};
use super::svg::{Document, hundredths};
use super::svg_text::{Anchor, TextStyle};
use super::ticks::{self, TickSet};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::{Cartesian2d, CoordTranslate};

/// Size of tick labels in points.
pub const TICK_SIZE: f64 = 7.0;
/// Size of axis labels and titles in points.
pub const LABEL_SIZE: f64 = 8.0;
/// Size of direct labels and legends in points.
pub const TEXT_SIZE: f64 = 7.5;
/// Width of axes in points.
pub const AXIS_WIDTH: f64 = 0.5;
/// Length of a tick in points; a small one is half as long.
pub const TICK_LENGTH: f64 = 2.5;
/// From a tick to its label, and from tick labels to the axis label, in points.
const GAP: f64 = 2.5;

/// The part of one axis that is shown, in its linear coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Scale.
    pub scale: Scale,
    /// Whether values grow to the left or downwards.
    pub reversed: bool,
}

impl Span {
    /// The span of an axis over these values (in the axis' own values).
    pub fn new(axis: &Axis, data: &[f64], panel: usize, name: char) -> Result<Self, PlotError> {
        let make = |low, high| Span { low, high, scale: axis.scale, reversed: axis.reversed };
        let checked = |value: f64| {
            if axis.scale == Scale::Log && value <= 0.0 {
                return Err(PlotError::NotPositive { panel, axis: name, value });
            }
            Ok(ticks::coordinate(axis.scale, value))
        };
        match axis.range {
            Range::Fixed(low, high) => {
                if !(low.is_finite() && high.is_finite() && low < high) {
                    return Err(PlotError::EmptyRange { panel, axis: name, low, high });
                }
                Ok(make(checked(low)?, checked(high)?))
            }
            Range::Auto => {
                let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                for &value in data {
                    let at = checked(value)?;
                    (low, high) = (low.min(at), high.max(at));
                }
                if low > high {
                    return Err(PlotError::NoRange { panel, axis: name });
                }
                // A constant still gets a frame around it.
                let size = high - low;
                let margin =
                    if size > 1e-12 * high.abs().max(low.abs()) { 0.04 * size } else { 0.5 * high.abs().max(1.0) };
                Ok(make(low - margin, high + margin))
            }
        }
    }

    /// Length in the linear coordinate.
    pub fn size(&self) -> f64 {
        self.high - self.low
    }

    /// The linear coordinate of a value.
    pub fn coordinate(&self, value: f64) -> f64 {
        ticks::coordinate(self.scale, value)
    }

    fn ends(&self) -> std::ops::Range<f64> {
        if self.reversed { self.high..self.low } else { self.low..self.high }
    }
}

/// How plotters maps a frame's linear coordinates to hundredths of a point.
pub type Mapping = Cartesian2d<RangedCoordf64, RangedCoordf64>;

/// A frame on the page.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Where it stands, in points.
    pub rect: Rect,
    /// Horizontal span.
    pub x: Span,
    /// Vertical span.
    pub y: Span,
}

impl Frame {
    /// Upper left and lower right corners in hundredths of a point.
    pub fn corners(&self) -> ((i32, i32), (i32, i32)) {
        (
            (hundredths(self.rect.left), hundredths(self.rect.top)),
            (hundredths(self.rect.right), hundredths(self.rect.bottom)),
        )
    }

    /// plotters' mapping for this frame.
    pub fn mapping(&self) -> Mapping {
        let ((left, top), (right, bottom)) = self.corners();
        Cartesian2d::new(self.x.ends(), self.y.ends(), (left..right, bottom..top))
    }

    /// Where a point (in linear coordinates) falls on the page, in points.
    pub fn on_page(&self, point: (f64, f64)) -> (f64, f64) {
        let (x, y) = self.mapping().translate(&point);
        (f64::from(x) / 100.0, f64::from(y) / 100.0)
    }

    /// The frame's ranges in linear coordinates, larger by `by` points on every side.
    pub fn window(&self, by: f64) -> Rect {
        let (dx, dy) = (by * self.x.size() / self.rect.width(), by * self.y.size() / self.rect.height());
        Rect { left: self.x.low - dx, right: self.x.high + dx, top: self.y.low - dy, bottom: self.y.high + dy }
    }

    /// The ticks of both axes that fit without touching each other.
    pub fn ticks(&self, x: &Axis, y: &Axis, dense: bool) -> (TickSet, TickSet) {
        let (width, height) = (self.rect.width(), self.rect.height());
        let most_x = (width / if dense { 22.0 } else { 26.0 }).clamp(2.0, 9.0) as usize;
        let most_y = (height / if dense { 14.0 } else { 18.0 }).clamp(2.0, 8.0) as usize;
        let fits = |set: &TickSet| {
            let mut edge = f64::NEG_INFINITY;
            let mut labelled: Vec<_> =
                set.ticks.iter().filter_map(|t| t.label.as_ref().map(|label| (t.at, label))).collect();
            labelled.sort_by(|a, b| a.0.total_cmp(&b.0));
            labelled.into_iter().all(|(at, label)| {
                let (middle, half) = ((at - self.x.low) / self.x.size() * width, label.width(TICK_SIZE) / 2.0);
                let free = middle - half > edge + 4.0;
                edge = middle + half;
                free
            })
        };
        let candidates = (2..=most_x).rev().map(|want| ticks::ticks(&x.ticks, x.scale, self.x.low, self.x.high, want));
        let mut candidates = candidates.collect::<Vec<_>>().into_iter();
        let first = candidates.next().unwrap_or_default();
        let along = if fits(&first) { first } else { candidates.find(fits).unwrap_or(first) };
        (along, ticks::ticks(&y.ticks, y.scale, self.y.low, self.y.high, most_y))
    }
}

/// An axis' label with its unit and the power of ten its numbers share.
fn full_label(axis: &Axis, exponent: i32) -> Label {
    let power = match exponent {
        0 => None,
        e if e < 0 => Some(Label::parse(&format!("×10^{{−{}}}", -e))),
        e => Some(Label::parse(&format!("×10^{{{e}}}"))),
    };
    let inside = match (power, &axis.unit) {
        (None, None) => return axis.label.clone(),
        (Some(power), None) => power,
        (None, Some(unit)) => unit.clone(),
        (Some(power), Some(unit)) => power.then(&Label::plain("\u{a0}")).then(unit),
    };
    let open = if axis.label.is_empty() { "(" } else { " (" };
    axis.label.clone().then(&Label::plain(open)).then(&inside).then(&Label::plain(")"))
}

/// Room around a frame, in points.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Margins {
    /// Left.
    pub left: f64,
    /// Right.
    pub right: f64,
    /// Above.
    pub top: f64,
    /// Below.
    pub bottom: f64,
}

/// The room that ticks, their labels and the axis labels take around a frame.
pub fn axis_margins(frame: &Frame, x: &Axis, y: &Axis, dense: bool) -> Margins {
    let (along, up) = frame.ticks(x, y, dense);
    let labelled = |set: &TickSet| set.ticks.iter().any(|tick| tick.label.is_some());
    let widest = up.ticks.iter().filter_map(|t| t.label.as_ref()).map(|l| l.width(TICK_SIZE)).fold(0.0, f64::max);
    let tall = along
        .ticks
        .iter()
        .filter_map(|t| t.label.as_ref())
        .map(|l| l.extent(TICK_SIZE))
        .fold((0.0_f64, 0.0_f64), |a, b| (a.0.max(b.0), a.1.max(b.1)));
    let mut out = Margins { left: 1.5, right: 1.5, top: 3.0, bottom: 1.5 };
    if labelled(&up) {
        out.left += TICK_LENGTH + GAP - 0.5 + widest;
    }
    if labelled(&along) {
        out.bottom += TICK_LENGTH + GAP - 0.5 + tall.0 + tall.1;
    }
    for tick in &along.ticks {
        if let Some(label) = &tick.label {
            let (half, at) = (label.width(TICK_SIZE) / 2.0, frame.on_page((tick.at, frame.y.low)).0);
            out.left = out.left.max(half - (at - frame.rect.left) + 1.0);
            out.right = out.right.max(half - (frame.rect.right - at) + 1.0);
        }
    }
    if !y.label.is_empty() || y.unit.is_some() || up.exponent != 0 {
        let (height, depth) = full_label(y, up.exponent).extent(LABEL_SIZE);
        out.left += height + depth + GAP;
    }
    if !x.label.is_empty() || x.unit.is_some() || along.exponent != 0 {
        let (height, depth) = full_label(x, along.exponent).extent(LABEL_SIZE);
        out.bottom += height + depth + GAP - 1.0;
    }
    out
}

/// A span from its beginning to its end on the page, and whether these are powers of ten: `0 3.5 lin`, `-4 2 log`.
fn read_out(span: &Span) -> String {
    let ends = span.ends();
    let scale = if span.scale == Scale::Log { "log" } else { "lin" };
    format!("{:?} {:?} {scale}", ends.start, ends.end)
}

/// Draws the frame, its ticks and what is written around it.
pub fn draw_axes(page: &mut Document, frame: &Frame, x: &Axis, y: &Axis, id: &str, dense: bool) {
    let (along, up) = frame.ticks(x, y, dense);
    let ((left, top), (right, bottom)) = frame.corners();
    let Rect { left: l, top: t, right: r, bottom: b } = frame.rect;
    let (place, across, upwards) = (format!("{l:.2} {t:.2} {r:.2} {b:.2}"), read_out(&frame.x), read_out(&frame.y));
    // What a reader of the file needs to turn a place on the page into data again.
    let attributes =
        [("id", id), ("data-role", "axes"), ("data-frame", &place), ("data-x", &across), ("data-y", &upwards)];
    page.open_lines(&attributes, Colour::BLACK, AXIS_WIDTH, &[]);
    let width = hundredths(AXIS_WIDTH);
    page.rect((left, top), (right, bottom), false, Colour::BLACK, width);
    let length = |label: &Option<Label>| hundredths(if label.is_some() { TICK_LENGTH } else { TICK_LENGTH / 2.0 });
    for tick in &along.ticks {
        let at = hundredths(frame.on_page((tick.at, frame.y.low)).0);
        page.path([(at, bottom), (at, bottom + length(&tick.label))], false, false, Colour::BLACK, width);
    }
    for tick in &up.ticks {
        let at = hundredths(frame.on_page((frame.x.low, tick.at)).1);
        page.path([(left, at), (left - length(&tick.label), at)], false, false, Colour::BLACK, width);
    }
    page.close();

    page.open(&[("data-role", "axis-text")]);
    let style =
        |size, anchor, upright, kind| TextStyle { size, colour: Colour::BLACK, anchor, halo: false, upright, kind };
    let (mut lowest, mut leftmost) = (frame.rect.bottom, frame.rect.left);
    let tallest =
        along.ticks.iter().filter_map(|t| t.label.as_ref()).map(|l| l.extent(TICK_SIZE).0).fold(0.0, f64::max);
    for tick in &along.ticks {
        if let Some(label) = &tick.label {
            let at = frame.on_page((tick.at, frame.y.low)).0;
            let base = frame.rect.bottom + TICK_LENGTH + GAP - 0.5 + tallest;
            page.text(label, (at, base), style(TICK_SIZE, Anchor::Middle, false, TextKind::TickX));
            lowest = lowest.max(base + label.extent(TICK_SIZE).1);
        }
    }
    for tick in &up.ticks {
        if let Some(label) = &tick.label {
            let at = frame.on_page((frame.x.low, tick.at)).1;
            let edge = frame.rect.left - TICK_LENGTH - GAP + 0.5;
            page.text(label, (edge, at + 0.36 * TICK_SIZE), style(TICK_SIZE, Anchor::End, false, TextKind::TickY));
            leftmost = leftmost.min(edge - label.width(TICK_SIZE));
        }
    }
    let label = full_label(x, along.exponent);
    let middle = (frame.rect.left + frame.rect.right) / 2.0;
    let base = lowest + GAP - 1.0 + label.extent(LABEL_SIZE).0;
    page.text(&label, (middle, base), style(LABEL_SIZE, Anchor::Middle, false, TextKind::AxisLabel));
    let label = full_label(y, up.exponent);
    let middle = (frame.rect.top + frame.rect.bottom) / 2.0;
    let base = leftmost - GAP - label.extent(LABEL_SIZE).1;
    page.text(&label, (base, middle), style(LABEL_SIZE, Anchor::Middle, true, TextKind::AxisLabel));
    page.close();
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(x: (f64, f64), y: (f64, f64)) -> (Frame, Axis, Axis) {
        let (ax, ay) = (Axis::new("x").fixed(x.0, x.1), Axis::new("y").fixed(y.0, y.1));
        let rect = Rect { left: 20.0, top: 10.0, right: 120.0, bottom: 60.0 };
        let make = |axis: &Axis| Span::new(axis, &[], 0, 'x').unwrap();
        (Frame { rect, x: make(&ax), y: make(&ay) }, ax, ay)
    }

    #[test]
    fn corners_fall_on_the_frame() {
        let (frame, _, _) = frame((-1.0, 3.0), (0.0, 1.0));
        assert_eq!(frame.on_page((-1.0, 0.0)), (20.0, 60.0));
        assert_eq!(frame.on_page((3.0, 1.0)), (120.0, 10.0));
        let reversed = Frame { y: Span { reversed: true, ..frame.y }, ..frame };
        assert_eq!(reversed.on_page((-1.0, 0.0)), (20.0, 10.0));
    }

    #[test]
    fn wrong_ranges_are_refused() {
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY)] {
            let axis = Axis::new("x").fixed(low, high);
            assert!(matches!(Span::new(&axis, &[], 3, 'y'), Err(PlotError::EmptyRange { panel: 3, axis: 'y', .. })));
        }
        assert!(matches!(Span::new(&Axis::new("x"), &[], 0, 'x'), Err(PlotError::NoRange { .. })));
        let log = Axis::new("x").log();
        assert!(matches!(Span::new(&log, &[1.0, 0.0], 0, 'x'), Err(PlotError::NotPositive { value: 0.0, .. })));
    }

    #[test]
    fn an_automatic_range_has_a_margin_and_a_constant_a_width() {
        let span = Span::new(&Axis::new("x"), &[0.0, 10.0], 0, 'x').unwrap();
        assert_eq!((span.low, span.high), (-0.4, 10.4));
        let span = Span::new(&Axis::new("x"), &[3.0, 3.0], 0, 'x').unwrap();
        assert_eq!((span.low, span.high), (1.5, 4.5));
    }

    #[test]
    fn tick_labels_of_both_axes_never_touch() {
        for (low, high) in [(0.0, 1.0), (-123456.0, 1234567.0), (1.6001, 1.6003), (-1e-9, 3e-9), (99990.0, 100020.0)] {
            let (frame, x, y) = frame((low, high), (low, high));
            let mut page = Document::new(89.0, 40.0);
            draw_axes(&mut page, &frame, &x, &y, "a", false);
            let ticks: Vec<_> = page.boxes().iter().filter(|b| b.kind != TextKind::AxisLabel).collect();
            assert!(ticks.len() >= 4, "{low} {high}");
            for (i, a) in ticks.iter().enumerate() {
                assert!(ticks[i + 1..].iter().all(|b| !a.rect.overlaps(&b.rect, 0.0)), "{low} {high}: {}", a.text);
            }
        }
    }
}
