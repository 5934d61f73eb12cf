//! Shapes onto the paper, through plotters: layers by role, line pieces cut at the frame, markers, arrow heads.
//!
//! Layers are groups with an `id` (panel, then role) and `data-role`, so that a page can switch them. Lines and fills are
//! clipped by the frame; markers whose centre is inside are drawn whole.

use super::backend::Paper;
use super::clip;
use super::colour::{Colour, batlow};
use super::error::PlotError;
use super::frame::{Frame, Mapping};
use super::pieces::{Piece, Shape};
use super::place::{Scene, at_length};
use super::rect::Rect;
use super::role::{Level, Marker};
use super::svg::hundredths;
use plotters::drawing::DrawingArea;
use plotters::element::{Drawable, PathElement, PointCollection, Polygon};
use plotters::style::{RGBAColor, ShapeStyle};
use plotters_backend::{BackendCoord, DrawingBackend, DrawingErrorKind};
use std::cell::RefCell;
use std::rc::Rc;

/// The paper, shared with plotters' drawing areas.
pub type SharedPaper = Rc<RefCell<Paper>>;

/// Lines are cut this many points outside the frame, where the clip path hides their ends.
const OVERHANG: f64 = 2.0;

/// How a piece looks, its tone and its side of a sphere considered.
pub fn looks(piece: &Piece) -> (Colour, f64) {
    let look = piece.role.look();
    let colour = piece.tone.map_or(look.colour, batlow);
    if piece.back { (colour.tint(42), (0.55 * look.width).max(0.25)) } else { (colour, look.width) }
}

fn style(colour: Colour, width: f64, filled: bool) -> ShapeStyle {
    let stroke_width = hundredths(width).unsigned_abs();
    ShapeStyle { color: RGBAColor(colour.0, colour.1, colour.2, 1.0), filled, stroke_width }
}

/// A marker as a plotters element.
struct Glyph {
    at: (f64, f64),
    marker: Marker,
    radius: f64,
    colour: Colour,
    width: f64,
}

impl<'a> PointCollection<'a, (f64, f64)> for &'a Glyph {
    type Point = &'a (f64, f64);
    type IntoIter = std::iter::Once<&'a (f64, f64)>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once(&self.at)
    }
}

impl<DB: DrawingBackend> Drawable<DB> for Glyph {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        mut points: I,
        backend: &mut DB,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<DB::ErrorType>> {
        let Some(at) = points.next() else { return Ok(()) };
        draw_glyph(backend, at, self.marker, self.radius, self.colour, self.width)
    }
}

/// The corners of a marker around (0, 0), in units of its radius, y downwards.
fn corners(marker: Marker) -> &'static [(f64, f64)] {
    match marker {
        Marker::Square | Marker::OpenSquare => &[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)],
        Marker::Diamond | Marker::OpenDiamond => &[(0.0, -1.2), (1.0, 0.0), (0.0, 1.2), (-1.0, 0.0)],
        Marker::Triangle | Marker::OpenTriangle => &[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)],
        Marker::TriangleDown => &[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)],
        Marker::Disc | Marker::Circle | Marker::Dot | Marker::Plus | Marker::Cross => &[],
    }
}

/// Draws a marker at a place given in hundredths of a point.
pub fn draw_glyph<DB: DrawingBackend>(
    backend: &mut DB,
    at: BackendCoord,
    marker: Marker,
    radius: f64,
    colour: Colour,
    width: f64,
) -> Result<(), DrawingErrorKind<DB::ErrorType>> {
    let moved = |(x, y): (f64, f64)| (at.0 + hundredths(radius * x), at.1 + hundredths(radius * y));
    let round = hundredths(radius).unsigned_abs();
    let (line, fill) = (style(colour, width, false), style(colour, 0.0, true));
    let white = style(Colour::WHITE, 0.0, true);
    match marker {
        Marker::Disc | Marker::Dot => backend.draw_circle(at, round, &fill, true),
        Marker::Circle => {
            backend.draw_circle(at, round, &white, true)?;
            backend.draw_circle(at, round, &line, false)
        }
        Marker::Square | Marker::Diamond | Marker::Triangle | Marker::TriangleDown => {
            backend.fill_polygon(corners(marker).iter().map(|&c| moved(c)), &fill)
        }
        Marker::OpenSquare | Marker::OpenDiamond | Marker::OpenTriangle => {
            let outline = corners(marker);
            backend.fill_polygon(outline.iter().map(|&c| moved(c)), &white)?;
            // A little over the first edge again, so that the last corner is joined.
            let again = outline.iter().chain(outline.iter().take(2));
            backend.draw_path(again.map(|&c| moved(c)), &line)
        }
        Marker::Plus | Marker::Cross => {
            let arm = if marker == Marker::Plus { [(1.0, 0.0), (0.0, 1.0)] } else { [(0.8, 0.8), (0.8, -0.8)] };
            for (x, y) in arm {
                backend.draw_line(moved((-x, -y)), moved((x, y)), &line)?;
            }
            Ok(())
        }
    }
}

fn failed<E: std::fmt::Debug>(error: E) -> PlotError {
    PlotError::Drawing(format!("{error:?}"))
}

/// Draws sorted pieces into a frame. `id` begins the ids of the layers; `over` says whether these are the markers, which are
/// drawn over the frame, or the lines and fills, which are clipped by it.
pub fn draw(paper: &SharedPaper, frame: &Frame, pieces: &[Piece], id: &str, over: bool) -> Result<(), PlotError> {
    let root: DrawingArea<Paper, _> = paper.into();
    let area = root.apply_coord_spec(frame.mapping());
    let ours: Vec<&Piece> = pieces.iter().filter(|piece| (piece.level() == Level::Point) == over).collect();
    for layer in ours.chunk_by(|a, b| a.order() == b.order()) {
        let first = layer[0];
        let (colour, width) = looks(&Piece { tone: None, ..first.clone() });
        let back = if first.back { "-back" } else { "" };
        let marks = if over && first.role.look().level != Level::Point { "-points" } else { "" };
        let name = format!("{id}-{}{marks}{back}", first.role.id());
        let mut attributes = vec![("id", name.as_str()), ("data-role", first.role.id())];
        if first.back {
            attributes.push(("data-side", "back"));
        }
        {
            let page = &mut paper.borrow_mut().document;
            if over {
                page.open_lines(&attributes, colour, 0.8, &[]);
            } else if first.level() == Level::Fill {
                page.open_fills(&attributes, colour);
            } else {
                page.open_lines(&attributes, colour, width, first.role.look().dash);
            }
        }
        for piece in layer {
            draw_piece(&area, frame, piece)?;
        }
        paper.borrow_mut().document.close();
    }
    Ok(())
}

fn draw_piece(area: &DrawingArea<Paper, Mapping>, frame: &Frame, piece: &Piece) -> Result<(), PlotError> {
    let (colour, width) = looks(piece);
    let window = frame.window(OVERHANG);
    match &piece.shape {
        Shape::Line(points) => {
            for part in clip::line(points, &window) {
                area.draw(&PathElement::new(part, style(colour, width, false))).map_err(failed)?;
            }
            if piece.arrows.is_empty() {
                return Ok(());
            }
            let on_page = visible(frame, points);
            let total: f64 = on_page.iter().flat_map(|part| part.windows(2).map(length)).sum();
            for &fraction in &piece.arrows {
                if let Some((tip, direction)) = at_length(&on_page, fraction * total) {
                    let head = arrow_head(tip, direction, width, fraction >= 1.0);
                    let root = area.strip_coord_spec();
                    root.draw(&Polygon::new(head, style(colour, 0.0, true))).map_err(failed)?;
                }
            }
        }
        Shape::Polygon(points) => {
            let inside = clip::polygon(points, &window);
            area.draw(&Polygon::new(inside, style(colour, 0.0, true))).map_err(failed)?;
        }
        Shape::Glyphs(points, marker) => {
            let look = piece.role.look();
            let radius = if piece.back { 0.75 * look.radius } else { look.radius };
            let room = frame.window(0.02);
            let inside = points
                .iter()
                .filter(|p| p.0 >= room.left && p.0 <= room.right && p.1 >= room.top && p.1 <= room.bottom);
            for &at in inside {
                let width = if piece.back { 0.5 } else { 0.8 };
                area.draw(&Glyph { at, marker: *marker, radius, colour, width }).map_err(failed)?;
            }
        }
    }
    Ok(())
}

fn length(pair: &[(f64, f64)]) -> f64 {
    let (dx, dy) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
    (dx * dx + dy * dy).sqrt()
}

/// The parts of a line that are seen in a frame, on the page, in points.
pub fn visible(frame: &Frame, points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
    let parts = clip::line(points, &frame.window(0.0));
    parts.into_iter().map(|part| part.into_iter().map(|p| frame.on_page(p)).collect()).collect()
}

/// A slim triangle; `at_tip` with its point at the place, else centred on it. Hundredths of a point.
fn arrow_head(at: (f64, f64), direction: (f64, f64), width: f64, at_tip: bool) -> Vec<(i32, i32)> {
    let size = length(&[(0.0, 0.0), direction]);
    let (ux, uy) = (direction.0 / size, direction.1 / size);
    let (long, half) = (4.2 + 1.6 * width, 1.4 + 0.6 * width);
    let tip = if at_tip { 0.0 } else { long / 2.0 };
    let corner = |forward: f64, aside: f64| {
        (hundredths(at.0 + forward * ux - aside * uy), hundredths(at.1 + forward * uy + aside * ux))
    };
    vec![corner(tip, 0.0), corner(tip - long, half), corner(tip - 0.75 * long, 0.0), corner(tip - long, -half)]
}

/// What the pieces cover of a frame, for placing labels.
pub fn scene(frame: &Frame, pieces: &[Piece], bounds: Rect) -> Scene {
    let mut scene = Scene { bounds, segments: Vec::new(), dots: Vec::new(), taken: Vec::new() };
    for piece in pieces {
        match &piece.shape {
            Shape::Line(points) if piece.role != super::role::Role::Grid => {
                for part in visible(frame, points) {
                    // Steps of a point are fine enough to keep a label off a curve.
                    let mut from = part[0];
                    for (i, &to) in part.iter().enumerate() {
                        if i + 1 == part.len() || length(&[from, to]) > 1.0 {
                            scene.segments.push((from, to));
                            from = to;
                        }
                    }
                }
            }
            Shape::Glyphs(points, _) => {
                let radius = piece.role.look().radius;
                for &at in points {
                    let (x, y) = frame.on_page(at);
                    scene.dots.push(Rect { left: x, right: x, top: y, bottom: y }.grown(radius));
                }
            }
            Shape::Line(_) | Shape::Polygon(_) => {}
        }
    }
    scene
}
