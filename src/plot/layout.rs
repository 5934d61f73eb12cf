//! Where the panels' frames stand: cells of the page, margins shared along edges, aspect.

use super::error::PlotError;
use super::frame::{Frame, LABEL_SIZE, Margins, Span, axis_margins};
use super::legend::key_width;
use super::picture::{Aspect, Layout, Letter, Panel, Picture};
use super::rect::Rect;

/// Between neighbouring cells, in points.
const GUTTER: f64 = 7.0;
/// A frame smaller than this is of no use.
const LEAST: f64 = 18.0;

/// The cells of the page above the legend strip, one for each panel.
pub fn cells(picture: &Picture, page: &Rect, strip: f64) -> Result<Vec<Rect>, PlotError> {
    let count = picture.panels.len();
    let (width, height) = (page.width(), page.height() - strip);
    let grid = |columns: &[f64], rows: &[f64]| -> Result<Vec<Rect>, PlotError> {
        let sound = |weights: &[f64]| !weights.is_empty() && weights.iter().all(|w| w.is_finite() && *w > 0.0);
        if !sound(columns) || !sound(rows) || columns.len() * rows.len() < count {
            let panel = if sound(columns) && sound(rows) { columns.len() * rows.len() } else { 0 };
            return Err(PlotError::NoCell { panel });
        }
        let edges = |weights: &[f64], room: f64| -> Vec<(f64, f64)> {
            let (total, gaps): (f64, f64) = (weights.iter().sum(), GUTTER * (weights.len() as f64 - 1.0));
            let mut at = 0.0;
            let place = |&weight: &f64| {
                let size = (room - gaps) * weight / total;
                let ends = (at, at + size);
                at += size + GUTTER;
                ends
            };
            weights.iter().map(place).collect()
        };
        let (across, down) = (edges(columns, width), edges(rows, height));
        let cell = |(top, bottom): (f64, f64), (left, right): (f64, f64)| Rect { left, right, top, bottom };
        Ok(down.iter().flat_map(|&row| across.iter().map(move |&column| cell(row, column))).take(count).collect())
    };
    match &picture.layout {
        Layout::Columns(columns) => {
            let columns = if *columns == 0 { count.max(1) } else { *columns };
            grid(&vec![1.0; columns], &vec![1.0; count.div_ceil(columns).max(1)])
        }
        Layout::Weighted { columns, rows } => grid(columns, rows),
        Layout::Cells(list) => {
            let cell = |panel: usize| {
                let cell = list.get(panel).ok_or(PlotError::NoCell { panel })?;
                let (right, bottom) = (cell.left + cell.width, cell.top + cell.height);
                let inside = |v: f64| (-1e-9..=1.0 + 1e-9).contains(&v);
                if !(inside(cell.left) && inside(cell.top) && inside(right) && inside(bottom)) {
                    return Err(PlotError::NoCell { panel });
                }
                let half = GUTTER / 2.0;
                // Half a gutter on every side that is not the page's edge.
                let from = |v: f64| if v < 1e-9 { 0.0 } else { half };
                let to = |v: f64| if v > 1.0 - 1e-9 { 0.0 } else { half };
                Ok(Rect {
                    left: cell.left * width + from(cell.left),
                    right: right * width - to(right),
                    top: cell.top * height + from(cell.top),
                    bottom: bottom * height - to(bottom),
                })
            };
            (0..count).map(cell).collect()
        }
    }
}

/// The letter of a panel, if it has one.
pub fn letter(panel: &Panel, index: usize, count: usize) -> Option<char> {
    match panel.letter {
        Letter::None => None,
        Letter::Is(letter) => Some(letter),
        Letter::Auto if count > 1 => char::from_digit(index as u32 + 10, 36),
        Letter::Auto => None,
    }
}

fn margins(panel: &Panel, frame: &Frame, titled: bool) -> Margins {
    let mut out = if panel.sphere.is_some() {
        Margins { left: 1.5, right: 1.5, top: 1.5, bottom: 1.5 }
    } else {
        axis_margins(frame, &panel.x, &panel.y, false)
    };
    if titled {
        out.top = out.top.max(LABEL_SIZE + 5.5);
    }
    if let Some(key) = &panel.tone_key {
        out.right = out.right.max(key_width(key) + 1.0);
    }
    out
}

/// The frames of all panels.
pub fn frames(picture: &Picture, cells: &[Rect], spans: &[(Span, Span)]) -> Result<Vec<Frame>, PlotError> {
    let count = picture.panels.len();
    let titled = |i: usize| letter(&picture.panels[i], i, count).is_some() || picture.panels[i].title.is_some();
    let inner = |cell: &Rect, m: &Margins| Rect {
        left: cell.left + m.left,
        right: cell.right - m.right,
        top: cell.top + m.top,
        bottom: cell.bottom - m.bottom,
    };
    let frame = |i: usize, rect: Rect| Frame { rect, x: spans[i].0, y: spans[i].1 };
    // The number of ticks depends on the frame, the frame on the width of their labels: three rounds settle it.
    let mut rects: Vec<Rect> =
        cells.iter().map(|cell| inner(cell, &Margins { left: 28.0, right: 4.0, top: 12.0, bottom: 24.0 })).collect();
    for _ in 0..3 {
        for (i, rect) in rects.iter().enumerate() {
            if !(rect.width() >= LEAST && rect.height() >= LEAST) {
                return Err(PlotError::NoRoom { panel: i, width: rect.width(), height: rect.height() });
            }
        }
        let own: Vec<Margins> = (0..count)
            .map(|i| margins(&picture.panels[i], &frame(i, shaped(&picture.panels[i], rects[i], &spans[i])), titled(i)))
            .collect();
        // Panels whose cells share an edge share the margin there, so that their frames line up.
        let shared = |i: usize, edge: fn(&Rect) -> f64, margin: fn(&Margins) -> f64| {
            let beside = (0..count).filter(|&j| (edge(&cells[i]) - edge(&cells[j])).abs() < 0.01);
            beside.map(|j| margin(&own[j])).fold(0.0, f64::max)
        };
        rects = (0..count)
            .map(|i| {
                let margins = Margins {
                    left: shared(i, |r| r.left, |m| m.left),
                    right: shared(i, |r| r.right, |m| m.right),
                    top: shared(i, |r| r.top, |m| m.top),
                    bottom: shared(i, |r| r.bottom, |m| m.bottom),
                };
                inner(&cells[i], &margins)
            })
            .collect();
    }
    let mut out = Vec::with_capacity(count);
    for (i, rect) in rects.into_iter().enumerate() {
        let rect = shaped(&picture.panels[i], rect, &spans[i]);
        if !(rect.width() >= LEAST && rect.height() >= LEAST) {
            return Err(PlotError::NoRoom { panel: i, width: rect.width(), height: rect.height() });
        }
        out.push(frame(i, rect));
    }
    Ok(out)
}

/// The rectangle made smaller in one direction, about its middle, where one unit must be as long on both axes.
fn shaped(panel: &Panel, rect: Rect, spans: &(Span, Span)) -> Rect {
    if panel.aspect == Aspect::Free {
        return rect;
    }
    let scale = (rect.width() / spans.0.size()).min(rect.height() / spans.1.size());
    let (spare_x, spare_y) = (rect.width() - scale * spans.0.size(), rect.height() - scale * spans.1.size());
    Rect {
        left: rect.left + spare_x / 2.0,
        right: rect.right - spare_x / 2.0,
        top: rect.top + spare_y / 2.0,
        bottom: rect.bottom - spare_y / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Axis;
    use crate::plot::picture::{Cell, Width};

    fn panel(x: (f64, f64), y: (f64, f64)) -> Panel {
        Panel::new(Axis::new("*x*").fixed(x.0, x.1), Axis::new("*y*").fixed(y.0, y.1))
    }

    fn laid_out(picture: &Picture) -> Vec<Frame> {
        let page = Rect { left: 0.0, top: 0.0, right: 518.74, bottom: 200.0 };
        let spans: Vec<_> = picture
            .panels
            .iter()
            .map(|p| (Span::new(&p.x, &[], 0, 'x').unwrap(), Span::new(&p.y, &[], 0, 'y').unwrap()))
            .collect();
        frames(picture, &cells(picture, &page, 0.0).unwrap(), &spans).unwrap()
    }

    #[test]
    fn frames_of_one_row_line_up_although_their_labels_differ() {
        let picture = Picture::new(Width::Double, 70.0, "t")
            .panel(panel((0.0, 1.0), (0.0, 1.0)))
            .panel(panel((0.0, 1.0), (-12345.0, 0.001)))
            .panel(Panel { title: Some("title".into()), ..panel((0.0, 1.0), (0.0, 1.0)) });
        let frames = laid_out(&picture);
        assert!(frames.windows(2).all(|f| f[0].rect.top == f[1].rect.top && f[0].rect.bottom == f[1].rect.bottom));
    }

    #[test]
    fn equal_aspect_is_equal() {
        let picture = Picture::new(Width::Double, 70.0, "t").panel(panel((0.0, 4.0), (0.0, 1.0)).equal());
        let rect = laid_out(&picture)[0].rect;
        assert!((rect.width() / rect.height() - 4.0).abs() < 1e-12, "{rect:?}");
    }

    #[test]
    fn cells_that_do_not_exist_are_refused() {
        let page = Rect { left: 0.0, top: 0.0, right: 100.0, bottom: 100.0 };
        let two = || {
            Picture::new(Width::Double, 70.0, "t")
                .panel(panel((0.0, 1.0), (0.0, 1.0)))
                .panel(panel((0.0, 1.0), (0.0, 1.0)))
        };
        let one = Layout::Cells(vec![Cell { left: 0.0, top: 0.0, width: 1.0, height: 1.0 }]);
        assert_eq!(cells(&two().layout(one), &page, 0.0), Err(PlotError::NoCell { panel: 1 }));
        let few = Layout::Weighted { columns: vec![1.0], rows: vec![1.0] };
        assert_eq!(cells(&two().layout(few), &page, 0.0), Err(PlotError::NoCell { panel: 1 }));
    }

    #[test]
    fn too_small_a_page_is_refused() {
        let picture = Picture::new(Width::Single, 12.0, "t").panel(panel((0.0, 1.0), (0.0, 1.0)));
        let page = Rect { left: 0.0, top: 0.0, right: 252.0, bottom: 34.0 };
        let span = Span::new(&picture.panels[0].x, &[], 0, 'x').unwrap();
        let result = frames(&picture, &cells(&picture, &page, 0.0).unwrap(), &[(span, span)]);
        assert!(matches!(result, Err(PlotError::NoRoom { panel: 0, .. })));
    }
}
