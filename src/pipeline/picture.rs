//! The graph as an SVG picture: what [`Diagram`] placed, with names, counts and files. Whole numbers only: the same bytes everywhere.

use super::diagram::{Cell, Diagram};
use super::graph::Graph;
use super::select::Selection;
use std::fmt::Write;

/// All lengths are in units of 1/96 inch. The height of a row, and of the box in it.
const ROW: usize = 18;
const BOX: usize = 14;
/// The blank between bands.
const BAND: usize = 14;
const MARGIN: usize = 12;
const INDENT: usize = 14;
/// Between neighbouring tracks.
const LANE: usize = 7;
/// Between boxes and tracks.
const GAP: usize = 12;
/// The width of 100 letters (DejaVu Sans Mono, 10 px: 6.02 each; other fixed-width fonts are narrower), and of bold ones of 11 px.
const LETTERS: usize = 602;
const BOLD: usize = 663;

const STYLE: &str = "text{font:10px 'DejaVu Sans Mono',Menlo,Consolas,monospace;fill:#1a1a1a}.id{font-size:11px;font-weight:bold}\
.dim{fill:#666}.band{fill:#f4f5f7}.cell{fill:#fff;stroke:#4a6a8a}.out{fill:#fdf3dc;stroke:#a8771a}.time{stroke-dasharray:3 2}\
.line{fill:none;stroke:#8a97a5}.end{fill:#5f6c7a}";

fn wide(text: &str, hundred: usize) -> usize {
    (text.chars().count() * hundred).div_ceil(100)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// What stands in a box: the name, and in grey how many nodes, by which axes, and what file a collector leaves.
fn words(graph: &Graph, selection: &Selection, cell: &Cell) -> (String, String) {
    let address = graph.address(cell.nodes[0]);
    let (name, mut more) = if let [_] = cell.nodes.as_slice() {
        let whole = address.to_string();
        (whole.split_once('/').map_or(whole.clone(), |(_, name)| name.to_owned()), String::new())
    } else {
        let axes: Vec<&str> = address.axes.iter().map(|(axis, _)| axis.as_str()).collect();
        (address.node.clone(), format!(" ×{} {}", cell.nodes.len(), axes.join(", ")).trim_end().to_owned())
    };
    if let (true, [file]) = (cell.column > 0, files(graph, selection, cell).as_slice()) {
        more.push_str(&format!(" {file}"));
    }
    (name, more)
}

/// The files of a cell, of those selected.
fn files<'g>(graph: &'g Graph, selection: &Selection, cell: &Cell) -> Vec<&'g str> {
    let exports = cell.nodes.iter().flat_map(|node| &graph.nodes[*node].exports);
    let selected = exports.filter(|export| selection.exports.binary_search(export).is_ok());
    selected.map(|export| graph.exports[*export].export.path.as_str()).collect()
}

/// What a viewer shows of a box under the pointer.
fn title(graph: &Graph, selection: &Selection, cell: &Cell) -> String {
    let kind = graph.nodes[cell.nodes[0]].node.compute.kind();
    let addresses = cell.nodes.iter().map(|node| graph.address(*node).to_string());
    let files = files(graph, selection, cell).into_iter().map(|file| format!("→ {file}"));
    let lines: Vec<String> = addresses.chain(files).collect();
    format!("{}: {}\n{}", kind.name, kind.summary, lines.join("\n"))
}

/// Where a cell is drawn.
struct Place {
    x: usize,
    /// The middle of its height.
    y: usize,
    width: usize,
}

/// Writes the picture of the selected part of the graph.
pub(super) fn write(graph: &Graph, selection: &Selection, text: &mut String) -> std::fmt::Result {
    let diagram = Diagram::of(graph, selection);
    let labels: Vec<(String, String)> = diagram.cells.iter().map(|cell| words(graph, selection, cell)).collect();
    let columns = diagram.cells.iter().map(|cell| cell.column + 1).max().unwrap_or(0);
    let rows = diagram.bands.last().map_or(0, |(_, rows)| rows.end);

    // Columns: what stands in them, behind the tracks before them.
    let names: Vec<&str> = diagram.bands.iter().map(|(plan, _)| graph.experiments[*plan].0.as_str()).collect();
    let mut right = MARGIN + names.iter().map(|name| wide(name, BOLD)).max().unwrap_or(0) + GAP;
    let (mut lefts, mut tracks) = (Vec::new(), Vec::new());
    let box_width = |cell: usize| wide(&labels[cell].0, LETTERS) + wide(&labels[cell].1, LETTERS) + 12;
    for column in 0..columns {
        let lanes = diagram.tracks.iter().filter(|track| track.column == column).map(|track| track.lane + 1).max();
        tracks.push(right + GAP);
        lefts.push(right + lanes.map_or(0, |lanes| GAP + (lanes - 1) * LANE + GAP + 4));
        let widths = (0..diagram.cells.len()).filter(|cell| diagram.cells[*cell].column == column);
        let width = widths.map(|cell| diagram.cells[cell].depth * INDENT + box_width(cell)).max();
        right = lefts[column] + width.unwrap_or(0);
    }
    // Rows: bands apart from each other; every other column half a row lower, so that the lines into it run beside those out of
    // the column before it.
    let top = MARGIN + ROW;
    let mut band_of = vec![0; rows];
    diagram.bands.iter().enumerate().for_each(|(band, (_, rows))| band_of[rows.clone()].fill(band));
    let row_y = |row: usize| top + row * ROW + band_of[row] * BAND + ROW / 2;
    let place = |cell: usize| {
        let Cell { row, column, depth, .. } = diagram.cells[cell];
        let y = row_y(row) + column % 2 * (ROW / 2);
        Place { x: lefts[column] + depth * INDENT, y, width: box_width(cell) }
    };
    let (nodes, exports) = (selection.nodes.len(), selection.exports.len());
    let note =
        format!("{nodes} nodes, {exports} files. ×n: so many nodes, which differ in the values of the axes named.");
    let width = right.max(MARGIN + wide(&note, LETTERS)) + MARGIN;
    let height = top + rows * ROW + diagram.bands.len() * BAND + MARGIN;

    writeln!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
         <style>{STYLE}</style>\n<rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>"
    )?;
    writeln!(text, "<text class=\"dim\" x=\"{MARGIN}\" y=\"{}\">{note}</text>", MARGIN + 6)?;
    for (band, (_, rows)) in diagram.bands.iter().enumerate() {
        let (y, tall) = (row_y(rows.start) - ROW / 2 - 2, rows.len() * ROW + BAND - 2);
        if band % 2 == 0 {
            writeln!(text, "<rect class=\"band\" y=\"{y}\" width=\"{width}\" height=\"{tall}\"/>")?;
        }
        let name = escaped(names[band]);
        writeln!(text, "<text class=\"id\" x=\"{MARGIN}\" y=\"{}\">{name}</text>", row_y(rows.start) + 4)?;
    }
    for (index, cell) in diagram.cells.iter().enumerate() {
        let Some(parent) = cell.parent else { continue };
        let (from, to) = (place(parent), place(index));
        let x = from.x + INDENT / 2;
        writeln!(text, "<path class=\"line\" d=\"M{x} {}V{}H{}\"/>", from.y + BOX / 2, to.y, to.x - 3)?;
        arrow(text, to.x, to.y)?;
    }
    for track in &diagram.tracks {
        let x = tracks[track.column] + track.lane * LANE;
        let ends = || track.sources.iter().chain(&track.readers).map(|cell| place(*cell).y);
        let (first, last) = (ends().min().unwrap_or(0), ends().max().unwrap_or(0));
        writeln!(text, "<path class=\"line\" d=\"M{x} {first}V{last}\"/>")?;
        for source in &track.sources {
            let from = place(*source);
            writeln!(text, "<path class=\"line\" d=\"M{} {}H{x}\"/>", from.x + from.width, from.y)?;
            writeln!(text, "<circle class=\"end\" cx=\"{x}\" cy=\"{}\" r=\"2\"/>", from.y)?;
        }
        for reader in &track.readers {
            let to = place(*reader);
            writeln!(text, "<path class=\"line\" d=\"M{x} {}H{}\"/>", to.y, to.x - 3)?;
            arrow(text, to.x, to.y)?;
        }
    }
    for (index, cell) in diagram.cells.iter().enumerate() {
        let Place { x, y, width } = place(index);
        let (name, more) = &labels[index];
        let look = if cell.column == 0 { "cell" } else { "out" };
        let is_measured = graph.nodes[cell.nodes[0]].node.compute.kind().measurement;
        let look = if is_measured { format!("{look} time") } else { look.to_owned() };
        writeln!(
            text,
            "<g><title>{}</title><rect class=\"{look}\" x=\"{x}\" y=\"{}\" width=\"{width}\" height=\"{BOX}\" rx=\"3\"/>\
             <text x=\"{}\" y=\"{}\" xml:space=\"preserve\">{}<tspan class=\"dim\">{}</tspan></text></g>",
            escaped(&title(graph, selection, cell)),
            y - BOX / 2,
            x + 6,
            y + 4,
            escaped(name),
            escaped(more)
        )?;
    }
    writeln!(text, "</svg>")
}

fn arrow(text: &mut String, x: usize, y: usize) -> std::fmt::Result {
    writeln!(text, "<path class=\"end\" d=\"M{x} {y}l-6 -3v6z\"/>")
}
