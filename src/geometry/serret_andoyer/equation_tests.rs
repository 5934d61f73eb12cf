//! The equation in a scalar longer than `f64`; in `f64` it is tested where it is used (`conjugate_tests.rs`, `lanes_tests.rs`).

use crate::geometry::serret_andoyer::{Branch, Clairaut, Extremal, Metric, Start, first_conjugate_point};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::real::Real;

/// A decimal of about 25 digits.
fn long(text: &str) -> DoubleDouble {
    if let Some(size) = text.strip_prefix('-') {
        return -long(size);
    }
    let (whole, decimals) = text.split_once('.').unwrap();
    let digits = format!("{whole}{decimals}");
    let (head, tail) = digits.split_at(digits.len().min(15));
    let exact = |text: &str| DoubleDouble::from_f64(if text.is_empty() { 0.0 } else { text.parse().unwrap() });
    // Powers of ten up to 22 are exact.
    let power = |n: usize| DoubleDouble::from_f64(format!("1e{n}").parse().unwrap());
    let integer = exact(head) * power(tail.len()) + exact(tail);
    integer / power(decimals.len().min(22)) / power(decimals.len().saturating_sub(22))
}

/// The same source in a longer scalar, against the digits of the oracle (`tests/oracle/serret_andoyer_extra.json`).
#[test]
fn the_equation_in_double_double_has_the_digits_of_the_oracle() {
    let rows: serde_json::Value =
        serde_json::from_str(include_str!("../../../tests/oracle/serret_andoyer_extra.json")).unwrap();
    let (mut worst, mut most_steps, mut count) = (0.0_f64, 0, 0);
    for row in rows.as_array().unwrap() {
        let number = |name: &str| DoubleDouble::from_f64(row[name].as_f64().unwrap());
        let input = |i: usize| DoubleDouble::from_f64(row["inputs"][i].as_f64().unwrap());
        let branch = if row["inputs"][2].as_f64().unwrap() < 0.0 { Branch::Descending } else { Branch::Ascending };
        let start = match row["kind"].as_str().unwrap() {
            "mom" => Start::Momenta { y0: input(0), p_x: input(1), p_y: input(2) },
            "delta" => Start::Darboux { phi0: input(0), clairaut: Clairaut::Delta(input(1)), branch },
            _ => Start::Darboux { phi0: input(0), clairaut: Clairaut::PTheta(input(1)), branch },
        };
        let metric = Metric::new(number("A"), number("B"), number("C")).unwrap();
        let point = first_conjugate_point(&Extremal::new(&metric, start).unwrap()).unwrap();
        for (got, expected) in [(point.t1, &row["t1"]), (point.x, &row["x"])] {
            let expected = long(expected.as_str().unwrap());
            let condition = row["condition"].as_str().unwrap().parse::<f64>().unwrap().max(1.0);
            let error = ((got - expected) / expected).abs().to_f64();
            // The oracle is printed to 25 digits.
            let allowed = 2e-24 + 1e-29 * condition;
            worst = worst.max(error / allowed);
            assert!(error <= allowed, "{row}: {error:e}");
        }
        most_steps = most_steps.max(point.iterations);
        count += 1;
    }
    println!("{count} rows, {worst:.2} of what is allowed, at most {most_steps} steps");
    assert!(count >= 100);
}
