//! Where everything stands in a picture of the graph, in rows and columns: no pixels, no colours.
//!
//! Every experiment is a band of rows. A *cell* is a node or, where there are many, all nodes of an experiment that differ in their
//! axis values only. The first column is a forest: a cell that reads from one cell and is read by others stands below what it reads
//! from, indented. What reads from several cells, or is read by none, is a *collector* and stands further right, beside its sources.
//! Collectors with the same sources share a *track*, a vertical line before their column, which their sources' rows run into.
//! A row has one cell a column, and a row that a line runs through has none there: no line crosses a cell.

use super::graph::Graph;
use super::select::Selection;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ops::Range;

/// Up to so many nodes each has a cell of its own.
const ALONE: usize = 16;

/// A node, or nodes that differ in their axis values.
#[derive(Debug)]
pub(super) struct Cell {
    /// The nodes, by their index in the graph; at least one.
    pub nodes: Vec<usize>,
    /// The plan that they come from.
    pub plan: usize,
    pub row: usize,
    pub column: usize,
    /// How far it is indented within its column.
    pub depth: usize,
    /// The cell that it stands below.
    pub parent: Option<usize>,
    sources: BTreeSet<usize>,
    /// Those that stand further right and read from it.
    readers: Vec<usize>,
}

/// A vertical line before a column, from what is read to what reads it.
#[derive(Debug)]
pub(super) struct Track {
    pub column: usize,
    /// Its place among the column's tracks, from the left.
    pub lane: usize,
    pub sources: Vec<usize>,
    pub readers: Vec<usize>,
}

/// Everything in its place.
#[derive(Debug, Default)]
pub(super) struct Diagram {
    pub cells: Vec<Cell>,
    pub tracks: Vec<Track>,
    /// The rows of each plan that has any.
    pub bands: Vec<(usize, Range<usize>)>,
}

impl Diagram {
    /// Places the selected nodes.
    pub fn of(graph: &Graph, selection: &Selection) -> Self {
        // Nodes taken together may read from each other both ways; then each stands alone, where order is certain.
        let together = (selection.nodes.len() > ALONE).then(|| Self::placed(cells(graph, selection, true))).flatten();
        together.or_else(|| Self::placed(cells(graph, selection, false))).unwrap_or_default()
    }

    /// Places cells; none where some read from each other.
    fn placed(cells: Vec<Cell>) -> Option<Self> {
        let order = order(&cells)?;
        let mut diagram = Self { cells, ..Self::default() };
        diagram.set_columns(&order);
        diagram.set_rows(&order);
        diagram.set_tracks();
        Some(diagram)
    }

    fn set_columns(&mut self, order: &[usize]) {
        let mut is_read = vec![false; self.cells.len()];
        for cell in &self.cells {
            cell.sources.iter().filter(|s| self.cells[**s].plan == cell.plan).for_each(|s| is_read[*s] = true);
        }
        for &index in order {
            let mut sources = self.cells[index].sources.iter().copied();
            let (first, second) = (sources.next(), sources.next());
            match (first, second) {
                (None, _) => {}
                (Some(only), None) if is_read[index] && self.cells[only].plan == self.cells[index].plan => {
                    let (column, depth) = (self.cells[only].column, self.cells[only].depth + 1);
                    let cell = &mut self.cells[index];
                    (cell.parent, cell.column, cell.depth) = (Some(only), column, depth);
                }
                _ => {
                    let sources: Vec<usize> = self.cells[index].sources.iter().copied().collect();
                    let right = sources.iter().map(|source| self.cells[*source].column).max().unwrap_or(0);
                    self.cells[index].column = right + 1;
                    sources.into_iter().for_each(|source| self.cells[source].readers.push(index));
                }
            }
        }
    }

    /// Rows, band by band: the forest of the first column in order, then collectors from left to right.
    fn set_rows(&mut self, order: &[usize]) {
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); self.cells.len()];
        let mut roots: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for &index in order {
            match self.cells[index].parent {
                Some(parent) => children[parent].push(index),
                None => roots.entry(self.cells[index].plan).or_default().push(index),
            }
        }
        let mut next = 0;
        for (plan, mut roots) in roots {
            let begin = next;
            roots.sort_by_key(|root| self.cells[*root].column);
            // The last column that the line of a row of this band reaches, and the columns with a cell.
            let mut rows: Vec<(usize, BTreeSet<usize>)> = Vec::new();
            for root in roots {
                let column = self.cells[root].column;
                let is_single = children[root].is_empty() && column > 0;
                let found = is_single.then(|| self.free_row(root, begin, &rows)).flatten();
                let mut open = vec![root];
                while let Some(index) = open.pop() {
                    open.extend(children[index].iter().rev());
                    let row = found.unwrap_or(rows.len());
                    if row == rows.len() {
                        rows.push((0, BTreeSet::new()));
                    }
                    let reach = self.cells[index].readers.iter().map(|reader| self.cells[*reader].column).max();
                    rows[row].0 = rows[row].0.max(reach.unwrap_or(0));
                    rows[row].1.insert(column);
                    self.cells[index].row = begin + row;
                }
            }
            next += rows.len();
            self.bands.push((plan, begin..next));
        }
    }

    /// The free row of a band that is nearest to the middle of a collector's sources.
    fn free_row(&self, index: usize, begin: usize, rows: &[(usize, BTreeSet<usize>)]) -> Option<usize> {
        let Cell { column, plan, sources, .. } = &self.cells[index];
        let near: Vec<usize> = sources.iter().filter(|s| self.cells[**s].plan == *plan).copied().collect();
        let middle = near.iter().map(|source| self.cells[*source].row - begin).sum::<usize>() / near.len().max(1);
        let is_free = |row: &usize| {
            let (reach, taken) = &rows[*row];
            !taken.contains(column) && (reach <= column || taken.iter().all(|left| left > column))
        };
        // Of two rows as near, the lower: the first collector then stands above the second.
        (0..rows.len()).rev().filter(is_free).min_by_key(|row| row.abs_diff(middle))
    }

    fn set_tracks(&mut self) {
        let mut shared: BTreeMap<(usize, Vec<usize>), Vec<usize>> = BTreeMap::new();
        for (index, cell) in self.cells.iter().enumerate() {
            if cell.parent.is_none() && !cell.sources.is_empty() {
                shared.entry((cell.column, cell.sources.iter().copied().collect())).or_default().push(index);
            }
        }
        let track = |((column, sources), readers)| Track { column, lane: 0, sources, readers };
        let mut tracks: Vec<Track> = shared.into_iter().map(track).collect();
        tracks.sort_by_key(|track| (track.column, self.rows_of(track).start));
        // The lanes of a column, by the last row that is taken.
        let mut lanes: HashMap<usize, Vec<usize>> = HashMap::new();
        for track in &mut tracks {
            let rows = self.rows_of(track);
            let taken = lanes.entry(track.column).or_default();
            let lane = taken.iter().position(|last| *last < rows.start).unwrap_or(taken.len());
            if lane == taken.len() {
                taken.push(0);
            }
            taken[lane] = rows.end;
            track.lane = lane;
        }
        self.tracks = tracks;
    }

    /// From the first row of a track to its last.
    pub fn rows_of(&self, track: &Track) -> Range<usize> {
        let rows = || track.sources.iter().chain(&track.readers).map(|cell| self.cells[*cell].row);
        rows().min().unwrap_or(0)..rows().max().unwrap_or(0)
    }
}

/// The cells, with what they read from; in the order of their first nodes.
fn cells(graph: &Graph, selection: &Selection, is_grouped: bool) -> Vec<Cell> {
    let mut cells: Vec<Cell> = Vec::new();
    let mut known: HashMap<(usize, String), usize> = HashMap::new();
    let mut cell_of: HashMap<usize, usize> = HashMap::new();
    for &node in &selection.nodes {
        let placed = &graph.nodes[node];
        let address = graph.address(node);
        let name = if is_grouped { address.node.clone() } else { address.to_string() };
        let index = *known.entry((placed.plan, name)).or_insert(cells.len());
        if index == cells.len() {
            let (nodes, sources, readers) = (Vec::new(), BTreeSet::new(), Vec::new());
            let plan = placed.plan;
            cells.push(Cell { nodes, plan, row: 0, column: 0, depth: 0, parent: None, sources, readers });
        }
        cells[index].nodes.push(node);
        cells[index].sources.extend(placed.inputs.iter().filter_map(|input| cell_of.get(input)));
        cell_of.insert(node, index);
    }
    cells
}

/// The cells, each after those that it reads from; none where some read from each other.
fn order(cells: &[Cell]) -> Option<Vec<usize>> {
    let mut waiting: Vec<usize> = cells.iter().map(|cell| cell.sources.len()).collect();
    let mut readers: Vec<Vec<usize>> = vec![Vec::new(); cells.len()];
    for (index, cell) in cells.iter().enumerate() {
        cell.sources.iter().for_each(|source| readers[*source].push(index));
    }
    let mut ready: BTreeSet<usize> = (0..cells.len()).filter(|index| waiting[*index] == 0).collect();
    let mut order = Vec::with_capacity(cells.len());
    while let Some(index) = ready.pop_first() {
        order.push(index);
        for &reader in &readers[index] {
            waiting[reader] -= 1;
            if waiting[reader] == 0 {
                ready.insert(reader);
            }
        }
    }
    (order.len() == cells.len()).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells of some plans, each reading from some of the earlier ones, mostly of its own plan: a fixed sequence of numbers by
    /// a linear congruence.
    fn random_cells(seed: u64, count: usize) -> Vec<Cell> {
        let mut state = seed;
        let mut below = |end: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as usize % end.max(1)
        };
        let mut cells: Vec<Cell> = Vec::new();
        for index in 0..count {
            let plan = below(3);
            let own: Vec<usize> = (0..index).filter(|other| cells[*other].plan == plan).collect();
            let mut sources = BTreeSet::new();
            for _ in 0..below(4) {
                if !own.is_empty() {
                    sources.insert(own[below(own.len())]);
                }
            }
            if below(8) == 0 && index > 0 {
                sources.insert(below(index));
            }
            let (nodes, readers) = (vec![index], Vec::new());
            cells.push(Cell { nodes, plan, row: 0, column: 0, depth: 0, parent: None, sources, readers });
        }
        cells
    }

    #[test]
    fn every_edge_is_drawn_and_no_line_crosses_a_cell() {
        for seed in 0..300 {
            let diagram = Diagram::placed(random_cells(seed, 3 + seed as usize % 40)).expect("an order");
            let cells = &diagram.cells;
            let taken: BTreeSet<(usize, usize)> = cells.iter().map(|cell| (cell.row, cell.column)).collect();
            assert_eq!(taken.len(), cells.len(), "two cells in one place");
            for (index, cell) in cells.iter().enumerate() {
                let of_track = diagram.tracks.iter().filter(|track| track.readers.contains(&index));
                let mut drawn: Vec<usize> = of_track.flat_map(|track| track.sources.iter().copied()).collect();
                drawn.extend(cell.parent);
                drawn.sort_unstable();
                assert_eq!(drawn, cell.sources.iter().copied().collect::<Vec<_>>(), "seed {seed}, cell {index}");
                let band = diagram.bands.iter().find(|(plan, _)| *plan == cell.plan).expect("a band");
                assert!(band.1.contains(&cell.row));
                let Some(parent) = cell.parent.map(|parent| &cells[parent]) else { continue };
                assert!(parent.row < cell.row && (parent.column, parent.depth + 1) == (cell.column, cell.depth));
                // Between them, in their column, stand only cells that are indented further.
                let mut between = cells.iter().filter(|other| (parent.row + 1..cell.row).contains(&other.row));
                assert!(between.all(|other| other.column != cell.column || other.depth > parent.depth), "seed {seed}");
            }
            for track in &diagram.tracks {
                for source in track.sources.iter().map(|source| &cells[*source]) {
                    assert!(source.column < track.column);
                    let mut columns = source.column + 1..track.column;
                    assert!(
                        columns.all(|column| !taken.contains(&(source.row, column))),
                        "seed {seed}: a line crosses"
                    );
                }
                let is_apart = |other: &Track| {
                    let (own, others) = (diagram.rows_of(track), diagram.rows_of(other));
                    own.end < others.start || others.end < own.start
                };
                let same =
                    diagram.tracks.iter().filter(|other| (other.column, other.lane) == (track.column, track.lane));
                assert!(same.filter(|other| !std::ptr::eq(*other, track)).all(is_apart), "seed {seed}: one lane");
            }
        }
    }

    #[test]
    fn cells_that_read_from_each_other_have_no_order() {
        let mut cells = random_cells(1, 4);
        cells[0].sources = BTreeSet::from([1]);
        cells[1].sources = BTreeSet::from([0]);
        assert!(Diagram::placed(cells).is_none());
    }
}
