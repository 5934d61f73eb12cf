//! The data of the slider: conjugate loci of the spin problem for many k, as JSON that the page's script reads.
//!
//! One branch each (`p_φ = −2`, `p_θ ≥ 0`); the other three are its mirror images. Coordinates are rounded to 1e-4 of a unit: they are drawn, not
//! read; the table that they come from has all digits.

use super::content::PageError;
use crate::table::Table;

/// The JSON: `{"k": [...], "loci": [[θ, r1, r2, r3, θ, …], …]}`, the numbers in 1e-4.
///
/// # Errors
/// A table without the columns.
pub fn json(table: &Table) -> Result<String, PageError> {
    let column = |name: &str| {
        table.f64s(name).map_err(|error| PageError::Table { part: "loci".to_owned(), why: error.to_string() })
    };
    let k = column("k")?;
    let coordinates = [column("theta")?, column("r1")?, column("r2")?, column("r3")?];
    let mut values: Vec<String> = Vec::new();
    let mut loci: Vec<Vec<String>> = Vec::new();
    for (row, value) in k.iter().enumerate() {
        let text = format!("{value}");
        if values.last() != Some(&text) {
            values.push(text);
            loci.push(Vec::new());
        }
        if let Some(locus) = loci.last_mut() {
            locus.extend(coordinates.iter().map(|x| format!("{}", libm::round(x[row] * 1e4) as i64)));
        }
    }
    let loci: Vec<String> = loci.iter().map(|locus| format!("[{}]", locus.join(","))).collect();
    Ok(format!("{{\"k\":[{}],\"loci\":[{}]}}", values.join(","), loci.join(",")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_locus_a_value_of_k() {
        let table = Table::builder("loci", "")
            .column("k", "1", "", vec![0.5, 0.5, 1.0])
            .column("theta", "rad", "", vec![0.0, 1.0, 2.0])
            .column("r1", "1", "", vec![1.0, 0.5, -1.0])
            .column("r2", "1", "", vec![0.0, 0.12345, 0.0])
            .column("r3", "1", "", vec![0.0, 0.0, 0.0])
            .build()
            .unwrap();
        let expected = "{\"k\":[0.5,1],\"loci\":[[0,10000,0,0,10000,5000,1235,0],[20000,-10000,0,0]]}";
        assert_eq!(json(&table).unwrap(), expected);
    }
}
