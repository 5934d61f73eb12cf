//! A table as text for people: what it is, what its columns are, and its rows.

use super::build::Table;
use super::schema::Data;

/// The table as text: name and meaning, one line a column with unit, type and meaning, then at most `max_rows` rows, the
/// first and the last ones when there are more.
///
/// Floats are in the shortest form that reads back to the same bits; a gap is a dash.
pub fn render_text(table: &Table, max_rows: usize) -> String {
    let rows = table.rows();
    let mut text = String::new();
    if !(table.name().is_empty() && table.meaning().is_empty()) {
        text.push_str(&format!("{}: {}\n", table.name(), table.meaning()));
    }
    text.push_str(&format!("{rows} rows, {} columns\n\n", table.columns().len()));

    let mut legend = vec![["column", "unit", "type", "meaning"].map(str::to_owned).to_vec()];
    for column in table.columns() {
        let unit = if column.unit.is_empty() { "-".to_owned() } else { column.unit.clone() };
        legend.push(vec![column.name.clone(), unit, column.data.type_name().to_owned(), column.meaning.clone()]);
    }
    text.push_str(&aligned(&legend, &[false; 4]));
    text.push('\n');

    let (head, tail) = if rows <= max_rows { (rows, 0) } else { (max_rows - max_rows / 2, max_rows / 2) };
    let line = |row: usize| -> Vec<String> {
        table.columns().iter().map(|column| Some(column.data.cell(row)).filter(|c| !c.is_empty())).map(dash).collect()
    };
    let mut grid = vec![table.columns().iter().map(|column| column.name.clone()).collect::<Vec<_>>()];
    grid.extend((0..head).map(line));
    if rows > head + tail {
        grid.push(table.columns().iter().map(|_| "…".to_owned()).collect());
    }
    grid.extend((rows - tail..rows).map(line));
    let right: Vec<bool> =
        table.columns().iter().map(|column| matches!(column.data, Data::F64(_) | Data::I64(_))).collect();
    text.push_str(&aligned(&grid, &right));
    text
}

fn dash(cell: Option<String>) -> String {
    cell.unwrap_or_else(|| "-".to_owned())
}

/// Lines of cells, two spaces apart, each column as wide as its widest cell.
fn aligned(lines: &[Vec<String>], right: &[bool]) -> String {
    let width = |index: usize| lines.iter().filter_map(|line| line.get(index)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..right.len()).map(|index| width(index).unwrap_or(0)).collect();
    let mut text = String::new();
    for line in lines {
        let mut shown = String::new();
        for ((cell, width), right) in line.iter().zip(&widths).zip(right) {
            let padding = " ".repeat(width - cell.chars().count());
            let (before, after) = if *right { (padding.as_str(), "") } else { ("", padding.as_str()) };
            shown.push_str(&format!("{before}{cell}{after}  "));
        }
        text.push_str(shown.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_meanings_and_both_ends_are_shown() {
        let table = Table::builder("locus", "a curve")
            .column("k", "1", "parameter", vec![0.5, 1.25, 2.0, 3.0, 4.0])
            .column_with_gaps("t1", "time", "conjugate time", vec![1.0, f64::NAN, 3.0, 4.0, 5.0])
            .build()
            .expect("a good table");
        let expected = "\
locus: a curve
5 rows, 2 columns

column  unit  type  meaning
k       1     f64   parameter
t1      time  f64   conjugate time

   k   t1
 0.5  1.0
1.25    -
   …    …
 4.0  5.0
";
        assert_eq!(render_text(&table, 3), expected);
        assert!(!render_text(&table, 5).contains('…'));
        assert!(render_text(&table, 0).contains('…'));
    }
}
