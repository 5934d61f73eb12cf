//! How the panels of a scene stand on the page: blocks of equal cells, one below the other, alone or under the panels of a figure.

use crate::plot::picture::{Cell, Layout, Panel, Picture, Width};

/// Room for the legend under all panels, and for the lines that more panels add to it (mm).
const LEGEND_MM: f64 = 12.0;
const MORE_LEGEND_MM: f64 = 6.0;

/// Panels of one kind, in rows of equal cells.
pub struct Block {
    /// The panels, in reading order.
    pub panels: Vec<Panel>,
    /// Panels of one row, on a page of double width.
    pub columns: usize,
    /// Height of a row (mm).
    pub row_mm: f64,
}

impl Block {
    fn rows(&self, width: Width) -> usize {
        self.panels.len().div_ceil(self.in_row(width))
    }

    fn in_row(&self, width: Width) -> usize {
        let most = if width == Width::Single { 1 } else { self.columns };
        most.min(self.panels.len()).max(1)
    }
}

/// Blocks that have a panel at all.
fn filled(blocks: Vec<Block>) -> Vec<Block> {
    blocks.into_iter().filter(|block| !block.panels.is_empty()).collect()
}

/// A page of these blocks.
pub fn page(title: &str, caption: String, blocks: Vec<Block>) -> Picture {
    under(Picture::new(Width::Double, LEGEND_MM - MORE_LEGEND_MM, title).caption(caption), "", blocks)
}

/// A picture with blocks under its own panels, and a sentence more in its caption.
pub fn under(own: Picture, caption: &str, blocks: Vec<Block>) -> Picture {
    let (width, blocks) = (own.width, filled(blocks));
    let own_mm = if own.panels.is_empty() { 0.0 } else { own.height_mm };
    let above = if own.panels.is_empty() { own.height_mm } else { 0.0 };
    let blocks_mm: f64 = blocks.iter().map(|block| block.row_mm * block.rows(width) as f64).sum();
    let cells_mm = own_mm + blocks_mm;
    let mut cells = scaled(&own, own_mm / cells_mm);
    let mut panels = own.panels;
    let mut top = own_mm / cells_mm;
    for block in blocks {
        let columns = block.in_row(width);
        let (across, down) = (1.0 / columns as f64, block.row_mm / cells_mm);
        let count = block.panels.len();
        for (i, panel) in block.panels.into_iter().enumerate() {
            if i > 0 && i % columns == 0 {
                top += down;
            }
            // A last row that is not full stands in the middle.
            let in_row = columns.min(count - (i - i % columns));
            let left = across * ((i % columns) as f64 + 0.5 * (columns - in_row) as f64);
            cells.push(Cell { left, top, width: across, height: down });
            panels.push(panel);
        }
        top += down;
    }
    let caption = if own.caption.is_empty() { caption.to_owned() } else { format!("{} {caption}", own.caption) };
    Picture {
        height_mm: cells_mm + above + MORE_LEGEND_MM,
        layout: Layout::Cells(cells),
        panels,
        caption: caption.trim_end().to_owned(),
        ..own
    }
}

/// The cells of a picture's own layout, squeezed to the upper part of a higher page.
fn scaled(picture: &Picture, part: f64) -> Vec<Cell> {
    let count = picture.panels.len();
    let grid = |columns: &[f64], rows: &[f64]| -> Vec<Cell> {
        let ends = |weights: &[f64]| -> Vec<(f64, f64)> {
            let total: f64 = weights.iter().sum();
            let mut at = 0.0;
            let place = |weight: &f64| {
                let from = at;
                at += weight / total;
                (from, weight / total)
            };
            weights.iter().map(place).collect()
        };
        let (across, down) = (ends(columns), ends(rows));
        let cell = |(top, height): (f64, f64), (left, width): (f64, f64)| Cell { left, top, width, height };
        down.iter().flat_map(|row| across.iter().map(move |column| cell(*row, *column))).take(count).collect()
    };
    let cells = match &picture.layout {
        Layout::Columns(columns) => {
            let columns = if *columns == 0 { count.max(1) } else { *columns };
            grid(&vec![1.0; columns], &vec![1.0; count.div_ceil(columns).max(1)])
        }
        Layout::Weighted { columns, rows } => grid(columns, rows),
        Layout::Cells(cells) => cells.clone(),
    };
    cells.into_iter().map(|cell| Cell { top: cell.top * part, height: cell.height * part, ..cell }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::axis::Axis;

    fn panels(count: usize) -> Vec<Panel> {
        (0..count).map(|_| Panel::new(Axis::new("*x*"), Axis::new("*y*"))).collect()
    }

    /// Every panel has its own cell inside the page, rows don't overlap, and nothing is lost.
    #[test]
    fn blocks_stand_under_each_other() {
        let blocks = || {
            vec![
                Block { panels: panels(3), columns: 2, row_mm: 40.0 },
                Block { panels: Vec::new(), columns: 2, row_mm: 99.0 },
                Block { panels: panels(1), columns: 3, row_mm: 60.0 },
            ]
        };
        let alone = page("t", "c".to_owned(), blocks());
        assert_eq!((alone.panels.len(), alone.height_mm), (4, 152.0));
        let own = Picture { panels: panels(2), ..Picture::new(Width::Double, 80.0, "t") };
        let joined = under(own, "more", blocks());
        assert_eq!((joined.panels.len(), joined.height_mm), (6, 226.0));
        for picture in [alone, joined] {
            let Layout::Cells(cells) = &picture.layout else { panic!("cells") };
            assert_eq!(cells.len(), picture.panels.len());
            for (i, a) in cells.iter().enumerate() {
                assert!(a.left + a.width <= 1.0 + 1e-12 && a.top + a.height <= 1.0 + 1e-12, "{a:?}");
                for b in &cells[i + 1..] {
                    let apart = |p: f64, q: f64, from: f64, to: f64| p + q <= from + 1e-12 || from + to <= p + 1e-12;
                    let beside = apart(a.left, a.width, b.left, b.width);
                    assert!(beside || apart(a.top, a.height, b.top, b.height), "{a:?} {b:?}");
                }
            }
        }
    }
}
