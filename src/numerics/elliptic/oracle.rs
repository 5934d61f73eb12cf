//! Reads `tests/oracle/elliptic.json` for the tests of this room: mpmath 1.3, 25 digits (its origin is in the `.md` beside it).

/// One row: the function, its arguments, its values.
type Row = (String, Vec<f64>, Vec<String>);

/// The rows of one function: arguments and values (rounded to `f64`).
pub(crate) fn rows(function: &str) -> Vec<(Vec<f64>, Vec<f64>)> {
    let text = include_str!("../../../tests/oracle/elliptic.json");
    let all: Vec<Row> = serde_json::from_str(text).expect("the oracle file is JSON");
    let found: Vec<_> = all
        .into_iter()
        .filter(|row| row.0 == function)
        .map(|row| (row.1, row.2.iter().map(|v| v.parse().expect("a number")).collect()))
        .collect();
    assert!(found.len() >= 10, "the oracle holds too few rows of {function}");
    found
}

/// The largest error in units of `ε × scale` over the rows, and the arguments where it occurs.
pub(crate) fn worst(function: &str, error: impl Fn(&[f64], &[f64]) -> f64) -> (f64, Vec<f64>) {
    rows(function).iter().fold((0.0, vec![]), |worst, (arguments, values)| {
        let e = error(arguments, values) / f64::EPSILON;
        if e > worst.0 || e.is_nan() { (e, arguments.clone()) } else { worst }
    })
}

/// Relative error; zero where both are infinite or zero.
pub(crate) fn relative(got: f64, expected: f64) -> f64 {
    if got == expected { 0.0 } else { ((got - expected) / expected).abs() }
}
