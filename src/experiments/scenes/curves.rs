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
