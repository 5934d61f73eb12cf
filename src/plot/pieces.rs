//! From marks to shapes: checks every coordinate, takes logarithms, projects spheres, and lists what wants a label.
//!
//! What comes out is in the frame's linear coordinates and knows nothing of paper yet.

use super::error::PlotError;
use super::frame::Span;
use super::label::Label;
use super::mark::{Along, At, DirectLabel, Mark, Side};
use super::picture::{Panel, View};
use super::role::{Level, Marker, Role};
use super::sphere::Projection;

/// Something to draw.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// An open line.
    Line(Vec<(f64, f64)>),
    /// A filled polygon.
    Polygon(Vec<(f64, f64)>),
    /// Points.
    Glyphs(Vec<(f64, f64)>, Marker),
}

/// A shape and its looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Role.
    pub role: Role,
    /// On the back of a sphere.
    pub back: bool,
    /// Place in an ordered family.
    pub tone: Option<f64>,
    /// Fractions of its length at which there are arrow heads; 1 for an arrow.
    pub arrows: Vec<f64>,
    /// The shape.
    pub shape: Shape,
}

impl Piece {
    /// The order of drawing: the back first, then by layer and role.
    pub fn order(&self) -> (bool, Level, Role) {
        (!self.back, self.level(), self.role)
    }

    /// The layer: points are over lines even when their role is a line's.
    pub fn level(&self) -> Level {
        match self.shape {
            Shape::Glyphs(..) => Level::Point,
            _ => self.role.look().level,
        }
    }
}

/// What a label belongs to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A curve, as the list of its points (NaN lifts the pen).
    Curve(Vec<(f64, f64)>),
    /// A line across the panel.
    Rule(Along, f64),
    /// A point with a marker of this radius.
    Point((f64, f64), f64),
}

/// A label that wants a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The words, and how free their place is.
    pub label: DirectLabel,
    /// What it belongs to.
    pub target: Target,
    /// Whose colour it takes.
    pub role: Option<Role>,
    /// Place in an ordered family.
    pub tone: Option<f64>,
}

/// What a panel or an inset draws.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Pieces {
    /// Shapes in the order of drawing.
    pub shapes: Vec<Piece>,
    /// Labels.
    pub wishes: Vec<Wish>,
}

/// All plane values of a panel on one axis, for its automatic range.
pub fn values(marks: &[Mark], pick: impl Fn((f64, f64)) -> f64) -> Vec<f64> {
    let mut out = Vec::new();
    let mut take = |points: &[(f64, f64)]| {
        // Where the pen is lifted, neither coordinate counts.
        out.extend(points.iter().filter(|p| !p.0.is_nan() && !p.1.is_nan()).map(|&p| pick(p)));
    };
    for mark in marks {
        match mark {
            Mark::Curve(curve) => take(&curve.points),
            Mark::Points(points) => take(&points.points),
            Mark::Area(area) => {
                take(&area.lower);
                take(&area.upper);
            }
            Mark::Arrow(arrow) => take(&[arrow.from, arrow.to]),
            Mark::Text(text) => take(&[text.at]),
            Mark::Band(_) | Mark::Rule(_) | Mark::SphereCurve(_) | Mark::SpherePoints(_) => {}
        }
    }
    out
}

/// Checks all marks of a panel, whatever its ranges are going to be.
pub fn check(marks: &[Mark], panel: usize, sphere: bool) -> Result<(), PlotError> {
    for (index, mark) in marks.iter().enumerate() {
        let finite = |points: &[(f64, f64)], role: Option<Role>, breaks: bool| {
            let wrong = points.iter().find(|p| {
                let lifted = p.0.is_nan() || p.1.is_nan();
                if breaks && lifted { false } else { !(p.0.is_finite() && p.1.is_finite()) }
            });
            wrong.map_or(Ok(()), |&(x, y)| Err(PlotError::NotFinite { panel, mark: index, role, x, y }))
        };
        let fraction = |value: Option<f64>| match value {
            Some(value) if !(0.0..=1.0).contains(&value) => Err(PlotError::NotFraction { panel, mark: index, value }),
            _ => Ok(()),
        };
        let place = |label: &Option<DirectLabel>| match label.as_ref().map(|label| label.at) {
            Some(At::Fraction(value)) => fraction(Some(value)),
            _ => Ok(()),
        };
        let count = |labels: usize, points: usize| {
            if labels != 0 && labels != points {
                return Err(PlotError::LabelCount { panel, mark: index, labels, points });
            }
            Ok(())
        };
        let on_sphere = |points: &[[f64; 3]], breaks: bool| {
            for r in points {
                if breaks && r.iter().any(|c| c.is_nan()) {
                    continue;
                }
                let norm = (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]).sqrt();
                if !(norm > 1.0 - 1e-6 && norm < 1.0 + 1e-6) {
                    return Err(PlotError::NotOnSphere { panel, mark: index, norm });
                }
            }
            if sphere { Ok(()) } else { Err(PlotError::NoSphere { panel, mark: index }) }
        };
        match mark {
            Mark::Curve(curve) => {
                finite(&curve.points, Some(curve.role), true)?;
                fraction(curve.tone)?;
                place(&curve.label)?;
                for &at in &curve.arrows {
                    fraction(Some(at))?;
                }
            }
            Mark::Points(points) => {
                finite(&points.points, Some(points.role), false)?;
                fraction(points.tone)?;
                count(points.labels.len(), points.points.len())?;
            }
            Mark::Band(band) => finite(&[(band.from, band.to)], Some(band.role), false)?,
            Mark::Area(area) => {
                finite(&area.lower, Some(area.role), false)?;
                finite(&area.upper, Some(area.role), false)?;
            }
            Mark::Rule(rule) => {
                finite(&[(rule.at, 0.0)], Some(rule.role), false)?;
                place(&rule.label)?;
            }
            Mark::Text(text) => finite(&[text.at], text.role, false)?,
            Mark::Arrow(arrow) => finite(&[arrow.from, arrow.to], Some(arrow.role), false)?,
            Mark::SphereCurve(curve) => {
                on_sphere(&curve.points, true)?;
                fraction(curve.tone)?;
                place(&curve.label)?;
            }
            Mark::SpherePoints(points) => {
                on_sphere(&points.points, false)?;
                count(points.labels.len(), points.points.len())?;
            }
        }
    }
    Ok(())
}

/// The shapes and labels of checked marks in these spans.
pub fn pieces(marks: &[Mark], panel: usize, x: &Span, y: &Span, view: Option<&View>) -> Result<Pieces, PlotError> {
    let mut out = Pieces::default();
    let axis = |span: &Span, value: f64, axis: char| {
        let at = span.coordinate(value);
        // log10 of what is not positive is −∞ or NaN.
        if value.is_finite() && !at.is_finite() { Err(PlotError::NotPositive { panel, axis, value }) } else { Ok(at) }
    };
    let point = |p: (f64, f64)| -> Result<(f64, f64), PlotError> { Ok((axis(x, p.0, 'x')?, axis(y, p.1, 'y')?)) };
    let list = |points: &[(f64, f64)]| points.iter().map(|&p| point(p)).collect::<Result<Vec<_>, _>>();
    let eye = view.map(Projection::new);
    for mark in marks {
        match mark {
            Mark::Curve(curve) => {
                let points = list(&curve.points)?;
                if let Some(label) = &curve.label {
                    let target = Target::Curve(points.clone());
                    out.wishes.push(Wish { label: label.clone(), target, role: Some(curve.role), tone: curve.tone });
                }
                out.line(curve.role, false, curve.tone, points, curve.arrows.clone());
            }
            Mark::Points(points) => {
                let at = list(&points.points)?;
                out.name_points(&at, &points.labels, points.side, points.role, points.tone);
                let marker = points.marker.unwrap_or(points.role.look().marker);
                out.glyphs(points.role, false, points.tone, at, marker);
            }
            Mark::Band(band) => {
                let (across, name, low, high) = match band.along {
                    Along::X => (y, 'y', x.low, x.high),
                    Along::Y => (x, 'x', y.low, y.high),
                };
                let (a, b) = (axis(across, band.from, name)?, axis(across, band.to, name)?);
                let corners = match band.along {
                    Along::X => vec![(low, a), (high, a), (high, b), (low, b)],
                    Along::Y => vec![(a, low), (b, low), (b, high), (a, high)],
                };
                out.polygon(band.role, corners);
            }
            Mark::Area(area) => {
                let mut edge = list(&area.lower)?;
                edge.extend(list(&area.upper)?.into_iter().rev());
                out.polygon(area.role, edge);
            }
            Mark::Rule(rule) => {
                let (at, ends, inside) = match rule.along {
                    Along::X => {
                        let at = axis(y, rule.at, 'y')?;
                        (at, vec![(x.low, at), (x.high, at)], at >= y.low && at <= y.high)
                    }
                    Along::Y => {
                        let at = axis(x, rule.at, 'x')?;
                        (at, vec![(at, y.low), (at, y.high)], at >= x.low && at <= x.high)
                    }
                };
                if inside {
                    if let Some(label) = &rule.label {
                        let target = Target::Rule(rule.along, at);
                        out.wishes.push(Wish { label: label.clone(), target, role: Some(rule.role), tone: None });
                    }
                    out.line(rule.role, false, None, ends, Vec::new());
                }
            }
            Mark::Text(text) => {
                let label = DirectLabel { text: text.text.clone(), at: At::Start, side: Some(text.side) };
                let target = Target::Point(point(text.at)?, 0.0);
                out.wishes.push(Wish { label, target, role: text.role, tone: None });
            }
            Mark::Arrow(arrow) => out.line(arrow.role, false, None, list(&[arrow.from, arrow.to])?, vec![1.0]),
            Mark::SphereCurve(curve) => {
                let parts = eye.as_ref().map(|eye| eye.split(&curve.points)).unwrap_or_default();
                if let Some(label) = &curve.label {
                    // The front part is named; a curve that is all behind is named there.
                    let all_behind = parts.iter().all(|part| part.back);
                    let mut named = Vec::new();
                    for part in parts.iter().filter(|part| all_behind || !part.back) {
                        named.extend(part.points.iter().copied());
                        named.push((f64::NAN, f64::NAN));
                    }
                    let target = Target::Curve(named);
                    out.wishes.push(Wish { label: label.clone(), target, role: Some(curve.role), tone: curve.tone });
                }
                for part in parts {
                    out.line(curve.role, part.back, curve.tone, part.points, Vec::new());
                }
            }
            Mark::SpherePoints(points) => {
                let Some(eye) = &eye else { continue };
                let seen: Vec<_> = points.points.iter().map(|&r| eye.see(r)).collect();
                let at: Vec<_> = seen.iter().map(|s| (s.x, s.y)).collect();
                out.name_points(&at, &points.labels, points.side, points.role, None);
                let marker = points.marker.unwrap_or(points.role.look().marker);
                for back in [true, false] {
                    let side = seen.iter().filter(|s| (s.depth < 0.0) == back).map(|s| (s.x, s.y)).collect();
                    out.glyphs(points.role, back, None, side, marker);
                }
            }
        }
    }
    if let Some((view, eye)) = view.zip(eye.as_ref()) {
        for line in Projection::graticule(view) {
            for part in eye.split(&line) {
                out.line(Role::Grid, part.back, None, part.points, Vec::new());
            }
        }
        for part in eye.split(&Projection::parallel(0.0)) {
            out.line(Role::Equator, part.back, None, part.points, Vec::new());
        }
    }
    out.shapes.sort_by_key(Piece::order);
    Ok(out)
}

/// The spans of a panel.
pub fn spans(panel: &Panel, index: usize) -> Result<(Span, Span), PlotError> {
    let x = Span::new(&panel.x, &values(&panel.marks, |p| p.0), index, 'x')?;
    let y = Span::new(&panel.y, &values(&panel.marks, |p| p.1), index, 'y')?;
    Ok((x, y))
}

impl Pieces {
    fn line(&mut self, role: Role, back: bool, tone: Option<f64>, points: Vec<(f64, f64)>, arrows: Vec<f64>) {
        self.shapes.push(Piece { role, back, tone, arrows, shape: Shape::Line(points) });
    }

    fn polygon(&mut self, role: Role, points: Vec<(f64, f64)>) {
        self.shapes.push(Piece { role, back: false, tone: None, arrows: Vec::new(), shape: Shape::Polygon(points) });
    }

    fn glyphs(&mut self, role: Role, back: bool, tone: Option<f64>, points: Vec<(f64, f64)>, marker: Marker) {
        if !points.is_empty() {
            let shape = Shape::Glyphs(points, marker);
            self.shapes.push(Piece { role, back, tone, arrows: Vec::new(), shape });
        }
    }

    fn name_points(&mut self, at: &[(f64, f64)], labels: &[Label], side: Option<Side>, role: Role, tone: Option<f64>) {
        for (&point, text) in at.iter().zip(labels) {
            let label = DirectLabel { text: text.clone(), at: At::Start, side };
            self.wishes.push(Wish { label, target: Target::Point(point, role.look().radius), role: Some(role), tone });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Axis;
    use crate::plot::mark::{Curve, Points, SphereCurve};

    #[test]
    fn what_cannot_be_drawn_is_refused_with_its_place() {
        let ok = Mark::from(Curve::new(Role::Geodesic, vec![(0.0, 0.0), (f64::NAN, 1.0), (1.0, 1.0)]));
        assert_eq!(check(std::slice::from_ref(&ok), 0, false), Ok(()));
        let infinite = Mark::from(Curve::new(Role::Geodesic, vec![(0.0, f64::INFINITY)]));
        assert!(matches!(check(&[ok, infinite], 2, false), Err(PlotError::NotFinite { panel: 2, mark: 1, .. })));
        let nan = Mark::from(Points::new(Role::Start, vec![(0.0, f64::NAN)]));
        assert!(matches!(check(&[nan], 0, false), Err(PlotError::NotFinite { .. })));
        let labels = Mark::from(Points::new(Role::Start, vec![(0.0, 0.0)]).labels(["a", "b"]));
        assert!(matches!(check(&[labels], 0, false), Err(PlotError::LabelCount { labels: 2, points: 1, .. })));
        let tone = Mark::from(Curve::new(Role::Geodesic, vec![]).tone(1.5));
        assert!(matches!(check(&[tone], 0, false), Err(PlotError::NotFraction { .. })));
        let sphere = Mark::from(SphereCurve::new(Role::Geodesic, vec![[1.0, 0.0, 0.0]]));
        assert_eq!(check(std::slice::from_ref(&sphere), 0, false), Err(PlotError::NoSphere { panel: 0, mark: 0 }));
        assert_eq!(check(&[sphere], 0, true), Ok(()));
        let off = Mark::from(SphereCurve::new(Role::Geodesic, vec![[1.1, 0.0, 0.0]]));
        assert!(matches!(check(&[off], 0, true), Err(PlotError::NotOnSphere { .. })));
    }

    #[test]
    fn points_beyond_a_lifted_pen_do_not_widen_the_range() {
        let curve = Mark::from(Curve::new(Role::Geodesic, vec![(0.0, 1.0), (99.0, f64::NAN), (1.0, 2.0)]));
        assert_eq!(values(&[curve], |p| p.0), [0.0, 1.0]);
    }

    #[test]
    fn logarithms_of_what_is_not_positive_are_refused() {
        let log = Span::new(&Axis::new("x").log().fixed(1.0, 10.0), &[], 0, 'x').unwrap();
        let curve = Mark::from(Curve::new(Role::Geodesic, vec![(0.0, 1.0)]));
        assert!(matches!(pieces(&[curve], 0, &log, &log, None), Err(PlotError::NotPositive { axis: 'x', .. })));
    }
}
