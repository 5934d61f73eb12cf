//! How far the numbers of one run are from those of another: named values, and tables row by row.
//!
//! Tables are compared where they match row by row: as many rows, the same columns, the same integers, booleans and texts. Where samples are placed by what
//! was computed, rows may differ: then the table is told as not comparable, never forced. Columns that hold errors and differences are left
//! out: they say how far results are off, and are no results ([`NO_RESULTS`]). Rows whose `k` differs are other starts: there `k` alone is compared.
//!
//! A difference of a column is relative to the largest number in the reference's column; of positions (angles, lengths) below one, absolute: a coordinate near
//! zero is not wrong by its own size, nor is a column of them.

use crate::contract::value::NamedValue;
use crate::table::{Data, Table};

/// What the names of columns and values contain that are no results: errors and differences, what rounding left out (`k_rest`), what vanishes but for
/// rounding, and the θ of a cusp, which has no value at the k where the cusp is a pole.
pub const NO_RESULTS: [&str; 10] = [
    "error",
    "difference",
    "allowed",
    "residual",
    "distance",
    "gap",
    "round_trip",
    "curvature_by_differences_at_zero",
    "k_rest",
    "cusp_theta",
];

/// Units of positions.
const POSITIONS: [&str; 2] = ["rad", "length"];

/// The column whose numbers may be a sample's place and a result in one: beside a switch, k is placed by the switch as found, an ulp apart at two levels,
/// and t1 has a vertical tangent there. It is compared itself; other columns are where it is the same.
const START: &str = "k";

/// The largest difference, and where it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Largest {
    /// How large.
    pub size: f64,
    /// Where: a value's name, a table's and a column's.
    pub place: String,
}

impl Largest {
    fn take(&mut self, size: f64, place: impl FnOnce() -> String) {
        // NaN counts as a difference.
        if size > self.size || size.is_nan() {
            (self.size, self.place) = (size, place());
        }
    }
}

/// Differences of two runs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Differences {
    /// Of named values, relative (absolute where the reference is zero).
    pub values: Largest,
    /// How many named values were compared.
    pub values_compared: usize,
    /// Of columns of tables, relative to the column's largest number; of positions, to one at least.
    pub columns: Largest,
    /// How many tables matched row by row.
    pub tables_compared: usize,
    /// The tables that did not.
    pub not_comparable: Vec<String>,
}

fn is_result(name: &str) -> bool {
    !NO_RESULTS.iter().any(|part| name.contains(part))
}

impl Differences {
    /// Adds the named values of one experiment.
    pub fn add_values(&mut self, experiment: &str, ours: &[NamedValue], reference: &[NamedValue]) {
        for value in reference.iter().filter(|value| is_result(&value.name)) {
            let Some(own) = ours.iter().find(|own| own.name == value.name) else { continue };
            let scale = if value.value == 0.0 { 1.0 } else { value.value.abs() };
            let size = (own.value - value.value).abs() / scale;
            self.values.take(size, || format!("{experiment}/{}", value.name));
            self.values_compared += 1;
        }
    }

    /// Adds a table, by its name.
    pub fn add_table(&mut self, name: &str, ours: &Table, reference: &Table) {
        if !matches(ours, reference) {
            self.not_comparable.push(name.to_owned());
            return;
        }
        self.tables_compared += 1;
        let is_same_start = |row: usize| {
            let k = |table: &Table| table.f64s(START).ok().and_then(|k| k.get(row).copied());
            k(ours).map(f64::to_bits) == k(reference).map(f64::to_bits)
        };
        for (own, other) in ours.columns().iter().zip(reference.columns()).filter(|(own, _)| is_result(&own.name)) {
            let (Data::F64(own_numbers), Data::F64(numbers)) = (&own.data, &other.data) else { continue };
            let least: f64 = if POSITIONS.contains(&other.unit.as_str()) { 1.0 } else { 0.0 };
            let scale = numbers.iter().filter(|x| x.is_finite()).fold(least, |scale, x| scale.max(x.abs()));
            let rows = own_numbers.iter().zip(numbers).enumerate().filter(|(_, (x, y))| !(x.is_nan() && y.is_nan()));
            for (_, (x, y)) in rows.filter(|(row, _)| own.name == START || is_same_start(*row)) {
                let apart = (x - y).abs();
                self.columns.take(if apart > 0.0 { apart / scale } else { 0.0 }, || format!("{name}: {}", own.name));
            }
        }
    }
}

/// Whether two tables match row by row.
fn matches(ours: &Table, reference: &Table) -> bool {
    ours.rows() == reference.rows()
        && ours.columns().len() == reference.columns().len()
        && ours.columns().iter().zip(reference.columns()).all(|(own, other)| {
            own.name == other.name
                && match (&own.data, &other.data) {
                    (Data::F64(_), Data::F64(_)) => true,
                    // How a row was computed is no part of which row it is.
                    (Data::Bool(_), Data::Bool(_)) => true,
                    (own, other) => own == other,
                }
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(t: Vec<f64>, error: Vec<f64>, rows: Vec<i64>) -> Table {
        Table::builder("points", "test")
            .column("index", "1", "which", rows)
            .column("t", "time", "time", t)
            .column("error", "1", "bound", error)
            .build()
            .unwrap()
    }

    #[test]
    fn tables_that_match_are_compared_and_others_are_told() {
        let reference = table(vec![2.0, 4.0], vec![1.0, 1.0], vec![0, 1]);
        let mut differences = Differences::default();
        differences.add_table("a", &table(vec![2.0, 4.5], vec![0.0, 9.0], vec![0, 1]), &reference);
        assert_eq!(differences.columns.size, 0.125);
        assert_eq!((differences.columns.place.as_str(), differences.tables_compared), ("a: t", 1));
        // Another k is another start: how far k itself is off counts, what comes of it does not.
        let at = |k: f64, t1| {
            Table::builder("beside", "test")
                .column("k", "1", "k", vec![k])
                .column("t1", "time", "t1", vec![t1])
                .build()
                .unwrap()
        };
        let mut beside = Differences::default();
        beside.add_table("beside", &at(1.25, 9.0), &at(1.0, 6.0));
        assert_eq!((beside.columns.size, beside.columns.place.as_str()), (0.25, "beside: k"));
        beside.add_table("same", &at(1.0, 9.0), &at(1.0, 6.0));
        assert_eq!((beside.columns.size, beside.columns.place.as_str()), (0.5, "same: t1"));
        // An angle that is zero but for rounding is right.
        let angle = |x| Table::builder("points", "test").column("phi", "rad", "φ", vec![x]).build().unwrap();
        differences.add_table("angles", &angle(1e-16), &angle(-2e-16));
        assert_eq!(differences.columns.size, 0.125);
        differences.add_table("b", &table(vec![2.0, 4.0], vec![1.0, 1.0], vec![0, 2]), &reference);
        differences.add_table("c", &table(vec![2.0], vec![1.0], vec![0]), &reference);
        assert_eq!(differences.not_comparable, ["b", "c"]);
    }

    #[test]
    fn values_are_compared_by_name() {
        let value = |name: &str, value| NamedValue {
            name: name.to_owned(),
            value,
            unit: String::new(),
            meaning: String::new(),
            route: String::new(),
            error: 0.0,
        };
        let mut differences = Differences::default();
        let reference = [value("k1", 2.0), value("largest_route_difference", 1e-15), value("none", 1.0)];
        differences.add_values("fig4", &[value("k1", 2.5), value("largest_route_difference", 1.0)], &reference);
        assert_eq!((differences.values.size, differences.values_compared), (0.25, 1));
        assert_eq!(differences.values.place, "fig4/k1");
    }
}
