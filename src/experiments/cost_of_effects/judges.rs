//! What each claim says of one row of counts.

use super::Counts;
use crate::contract::node::NodeError;
use crate::experiments::three_problems::{ROTATION_GROUP, SERRET_ANDOYER, SPIN};

/// Whether a row fails; none where the statement says nothing about it.
pub(super) type Judge = fn(&str, &Counts<'_>, usize) -> Result<Option<bool>, NodeError>;
/// The judges of the claims, in their order.
pub(super) const JUDGES: [Judge; 5] = [unasked, larger_state, steered, disturbed, not_less];

/// The number of columns in a set of effects.
fn columns(problem: &str, set: &str) -> f64 {
    match set.split("-column").next() {
        Some("one") => 1.0,
        Some("two") => 2.0,
        Some("three") => 3.0,
        Some("conjugate") if problem == ROTATION_GROUP => 2.0,
        Some("conjugate") => 1.0,
        _ => 0.0,
    }
}

/// The counts that one set of effects asks for.
const OWN: [(&str, &str); 6] = [
    ("event_evaluations", "conjugate"),
    ("root_isolations", "conjugate"),
    ("roots_found", "conjugate"),
    ("states_inside", "states-at-times"),
    ("kept_coefficients", "series-kept"),
    ("monitor_evaluations", "monitor"),
];

/// On SO(3) conjugate times are told apart, double ones too, by phases at states inside steps.
fn reads_phases(problem: &str, set: &str, count: &str) -> bool {
    problem == ROTATION_GROUP && set == "conjugate" && count == "states_inside"
}

fn unasked(problem: &str, counts: &Counts<'_>, row: usize) -> Result<Option<bool>, NodeError> {
    let set = counts.sets[row].as_str();
    let mut fault = columns(problem, set) == 0.0 && counts.of("tangent_evaluations", row)? != 0.0;
    for (count, asked_by) in OWN {
        fault |= set != asked_by && !reads_phases(problem, set, count) && counts.of(count, row)? != 0.0;
    }
    Ok(Some(fault))
}

fn larger_state(problem: &str, counts: &Counts<'_>, row: usize) -> Result<Option<bool>, NodeError> {
    let (base, column) = match problem {
        SPIN => (6.0, 3.0),
        SERRET_ANDOYER => (5.0, 2.0),
        _ => (3.0, 6.0),
    };
    let set = counts.sets[row].as_str();
    let least = if set == "attitude" { 4.0 } else { base + columns(problem, set) * column };
    Ok(Some(counts.of("state_dimension", row)? != least))
}

/// Whether steps and coefficients of the flow are not those of the base flow.
fn other_steps(counts: &Counts<'_>, row: usize) -> Result<bool, NodeError> {
    let base = counts.row("base", counts.asked[row])?;
    let differs = |count: &str| Ok::<_, NodeError>(counts.of(count, row)? != counts.of(count, base)?);
    Ok(differs("steps")? || differs("flow_evaluations")?)
}

fn steered(_: &str, counts: &Counts<'_>, row: usize) -> Result<Option<bool>, NodeError> {
    if counts.sets[row].ends_with("not-steering") { other_steps(counts, row).map(Some) } else { Ok(None) }
}

fn disturbed(_: &str, counts: &Counts<'_>, row: usize) -> Result<Option<bool>, NodeError> {
    let watches = ["series-kept", "states-at-times", "monitor"].contains(&counts.sets[row].as_str());
    if watches { other_steps(counts, row).map(Some) } else { Ok(None) }
}

fn not_less(problem: &str, counts: &Counts<'_>, row: usize) -> Result<Option<bool>, NodeError> {
    let set = counts.sets[row].as_str();
    let own = OWN.iter().find(|(_, asked_by)| *asked_by == set).map(|(count, _)| *count);
    let counted = own.or((columns(problem, set) > 0.0).then_some("tangent_evaluations"));
    let Some(count) = counted else { return Ok(None) };
    let base = counts.row("base", counts.asked[row])?;
    Ok(Some(counts.of(count, row)? <= counts.of(count, base)?))
}
