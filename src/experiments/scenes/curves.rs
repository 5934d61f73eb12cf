//! Small things that several figures and scenes draw with: the curves of a table, mirror images, minus signs.

use crate::contract::node::NodeError;
use crate::experiments::findings::unread;
use crate::table::Table;

/// The curves (θ, φ) of a table that holds several, told apart by the column `id`.
///
/// # Errors
/// A table of another form.
pub fn curves(table: &Table, id: &str) -> Result<Vec<Vec<(f64, f64)>>, NodeError> {
    let (index, theta) = (table.ints(id).map_err(unread)?, table.f64s("theta").map_err(unread)?);
    let phi = table.f64s("phi").map_err(unread)?;
    let mut curves: Vec<Vec<(f64, f64)>> = Vec::new();
    for row in 0..table.rows() {
        if row == 0 || index[row] != index[row - 1] {
            curves.push(Vec::new());
        }
        if let Some(curve) = curves.last_mut() {
            curve.push((theta[row], phi[row]));
        }
    }
    Ok(curves)
}

/// A curve mirrored at the meridian of the start: `θ → −θ`.
pub fn mirrored(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    points.iter().map(|(theta, phi)| (-theta, *phi)).collect()
}

/// A number with a minus sign for print.
pub fn minus(x: f64) -> String {
    format!("{x}").replace('-', "−")
}

/// Characters of a number that a title has room for.
const ROOM: usize = 8;

/// `= 0.8`, or `≈ 1.07796` where the number itself is too long for a title; with a minus sign for print.
pub fn equals(x: f64) -> String {
    let exact = minus(x);
    if exact.chars().count() <= ROOM { format!("= {exact}") } else { format!("≈ {}", minus_rounded(x)) }
}

/// A number with a minus sign for print, to five decimals where it is long.
pub fn minus_rounded(x: f64) -> String {
    let exact = minus(x);
    if exact.chars().count() <= ROOM { exact } else { format!("{x:.5}").replace('-', "−") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_fit_a_title() {
        assert_eq!((equals(0.8), equals(-0.75)), ("= 0.8".to_owned(), "= −0.75".to_owned()));
        assert_eq!(equals(1.0779636363636362), "≈ 1.07796");
        assert_eq!(minus_rounded(-1.0 / 3.0), "−0.33333");
    }
}
