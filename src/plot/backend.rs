//! A plotters backend that writes our SVG: what plotters calls a pixel is a hundredth of a point.
//!
//! plotters maps coordinates and hands shapes over; [`Paper`] passes them to a [`Document`], which knows real units, layers
//! and dashes. Stroke widths, radii and font sizes that reach it are hundredths of a point too. A path's dash is that of the
//! layer that is open, since plotters has none. Texts are read as markup (see [`Label`]).

use super::colour::Colour;
use super::label::Label;
use super::rect::TextKind;
use super::svg::Document;
use super::svg_text::{Anchor, TextStyle};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
};
use std::convert::Infallible;

/// The page on which plotters draws.
#[derive(Debug)]
pub struct Paper {
    /// The document, for what plotters has no words for: layers, rich texts, clip paths.
    pub document: Document,
}

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

fn colour(of: BackendColor) -> Colour {
    Colour(of.rgb.0, of.rgb.1, of.rgb.2)
}

fn width(style: &impl BackendStyle) -> i32 {
    i32::try_from(style.stroke_width()).unwrap_or(i32::MAX)
}

impl DrawingBackend for Paper {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.document.size()
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, point: BackendCoord, of: BackendColor) -> Drawn {
        self.document.rect(point, (point.0 + 1, point.1 + 1), true, colour(of), 0);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Drawn {
        self.document.path([from, to], false, false, colour(style.color()), width(style));
        Ok(())
    }

    fn draw_rect<S: BackendStyle>(&mut self, a: BackendCoord, b: BackendCoord, style: &S, fill: bool) -> Drawn {
        self.document.rect(a, b, fill, colour(style.color()), width(style));
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Drawn {
        self.document.path(path, false, false, colour(style.color()), width(style));
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, centre: BackendCoord, radius: u32, style: &S, fill: bool) -> Drawn {
        let radius = i32::try_from(radius).unwrap_or(i32::MAX);
        self.document.circle(centre, radius, fill, colour(style.color()), width(style));
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, vertices: I, style: &S) -> Drawn {
        self.document.path(vertices, true, true, colour(style.color()), 0);
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Drawn {
        let label = Label::parse(text);
        let size = style.size() / 100.0;
        let (up, down) = label.extent(size);
        let drop = match style.anchor().v_pos {
            VPos::Top => up,
            VPos::Center => (up - down) / 2.0,
            VPos::Bottom => -down,
        };
        let anchor = match style.anchor().h_pos {
            HPos::Left => Anchor::Start,
            HPos::Center => Anchor::Middle,
            HPos::Right => Anchor::End,
        };
        let upright = matches!(style.transform(), FontTransform::Rotate270);
        let (x, y) = (f64::from(at.0) / 100.0, f64::from(at.1) / 100.0);
        let base = if upright { (x + drop, y) } else { (x, y + drop) };
        let colour = colour(style.color());
        self.document.text(
            &label,
            base,
            TextStyle { size, colour, anchor, halo: false, upright, kind: TextKind::Direct },
        );
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let label = Label::parse(text);
        let (up, down) = label.extent(style.size());
        Ok((label.width(style.size()) as u32, (up + down) as u32))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use plotters::prelude::*;
    use std::cell::RefCell;
    use std::rc::Rc;

    #[test]
    fn plotters_own_charts_draw_on_it() {
        let paper = Rc::new(RefCell::new(Paper { document: Document::new(89.0, 60.0) }));
        {
            let root: DrawingArea<Paper, _> = (&paper).into();
            let mut chart = ChartBuilder::on(&root)
                .margin(500)
                .x_label_area_size(1500)
                .y_label_area_size(2500)
                .build_cartesian_2d(0.0..1.0, 0.0..1.0)
                .unwrap();
            chart.configure_mesh().label_style(("sans-serif", 700)).draw().unwrap();
            chart
                .draw_series(LineSeries::new([(0.0, 0.0), (0.5, 0.25), (1.0, 1.0)], Color::stroke_width(&BLUE, 120)))
                .unwrap();
        }
        let text = String::from_utf8(paper.borrow().document.finish("", "", &[])).unwrap();
        assert!(text.contains("stroke-width=\"1.2\""), "{text}");
        assert!(text.contains(">0.5</text>"), "{text}");
    }
}
