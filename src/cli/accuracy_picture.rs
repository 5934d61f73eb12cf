//! The work-precision plot of `polhode accuracy`: how far each level's numbers are from the reference, against the time they took here.

use crate::cli::accuracy::Measured;
use crate::contract::accuracy::Accuracy;
use crate::plot::axis::Axis;
use crate::plot::mark::{Points, RuleLine};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;

/// Where a difference of zero is drawn: below the ε of `f64`.
const NONE: f64 = 1e-17;

/// The whole decades around numbers above zero.
fn decades(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = numbers.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let power = |exponent: f64| libm::pow(10.0, exponent);
    if !(low > 0.0 && high.is_finite() && low <= high) {
        return (1e-3, 1.0);
    }
    (power((libm::log10(low) - 0.05).floor()), power((libm::log10(high) + 0.05).ceil()))
}

/// The plot of what was measured; `machine` is told in the caption.
pub fn picture(name: &str, measured: &[Measured], machine: &str) -> Picture {
    let others = || measured.iter().filter(|found| found.level != Accuracy::Reference);
    let drawn = |size: f64| if size.is_finite() { size.max(NONE) } else { 1.0 };
    let values: Vec<(f64, f64)> =
        others().map(|found| (found.compute_seconds, drawn(found.differences.values.size))).collect();
    let tables: Vec<(f64, f64)> =
        others().map(|found| (found.compute_seconds, drawn(found.differences.columns.size))).collect();
    let times = decades(measured.iter().map(|found| found.compute_seconds));
    let errors = decades(values.iter().chain(&tables).map(|point| point.1));
    let names = others().map(|found| found.level.to_string());
    let mut panel = Panel::new(
        Axis::new("time of the compute nodes").unit("s").log().fixed(times.0, times.1),
        Axis::new("largest difference to the reference, relative").log().fixed(errors.0, errors.1),
    )
    .mark(Points::new(Role::SeriesA, tables).legend("columns of tables").labels(names))
    .mark(Points::new(Role::SeriesB, values).legend("named values"));
    if let Some(reference) = measured.iter().find(|found| found.level == Accuracy::Reference) {
        panel =
            panel.mark(RuleLine::vertical(Role::Reference, reference.compute_seconds).legend("time of the reference"));
    }
    Picture::new(Width::Double, 92.0, format!("What accuracy costs in time: {name}"))
        .caption(format!(
            "Measured on one core of {machine}: time of all compute nodes of {name} at each level, run one after another from nothing, against the largest \
             difference of its numbers to those at the level reference (double-double arithmetic, integrations to 1e-28, rounded). Differences of \
             named values are relative; those of table columns are relative to the column's largest number (of positions: absolute below one), for tables that match row by row. A \
             difference of zero is drawn at 1e-17. Closed forms have no tolerance: at all levels but the reference they are evaluated in f64."
        ))
        .panel(panel)
}
