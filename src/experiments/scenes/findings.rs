//! What scenes say of any table: how many points it has, and how far its second route is from its first.

use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::node::NodeError;
use crate::contract::value::NamedValue;
use crate::experiments::findings::{claim, unread, value};
use crate::table::{Table, Tables};

/// A second route among the tables of a scene: where its tables are, and what is compared.
pub struct SecondRoute {
    /// The node's name; one table a value of the sweep.
    pub node: &'static str,
    /// The column of differences; that of allowed ones is `allowed`.
    pub difference: &'static str,
    /// What differs: `first conjugate times (relative)`.
    pub what: &'static str,
}

/// The tables of a node, one a value of its sweep.
fn tables_of<'a>(tables: &'a Tables, node: &str) -> Vec<(&'a str, &'a Table)> {
    tables
        .iter()
        .filter(|(name, _)| *name == node || name.strip_prefix(node).is_some_and(|rest| rest.starts_with('/')))
        .collect()
}

/// `points_NODE_AXIS=VALUE` for each table of these nodes.
pub fn counts(tables: &Tables, nodes: &[&str]) -> Vec<NamedValue> {
    let found = nodes.iter().flat_map(|node| tables_of(tables, node));
    found
        .map(|(name, table)| {
            let (name, meaning) =
                (format!("points_{}", name.replace(['-', '/'], "_")), format!("points of {name}: {}", table.meaning()));
            value(name, (table.rows() as f64, 0.0), "1", meaning, "counted")
        })
        .collect()
}

/// `largest_route_difference_NODE` for each second route that is there.
///
/// # Errors
/// A table of another form.
pub fn differences(tables: &Tables, routes: &[SecondRoute]) -> Result<Vec<NamedValue>, NodeError> {
    let mut values = Vec::new();
    for SecondRoute { node, difference, what } in routes {
        let (mut worst, mut rows): (f64, usize) = (0.0, 0);
        for (_, table) in tables_of(tables, node) {
            worst = table.f64s(difference).map_err(unread)?.iter().copied().fold(worst, f64::max);
            rows += table.rows();
        }
        if rows > 0 {
            values.push(value(
                format!("largest_route_difference_{}", node.replace('-', "_")),
                // The differences of nearby numbers are exact; their own rounding is that of the two routes.
                (worst, 4.0 * f64::EPSILON),
                "1",
                format!("largest difference of {what} between the two routes, {rows} rows"),
                "first route against integration (f64, double-double where rounding would show)",
            ));
        }
    }
    Ok(values)
}

/// The claim that all second routes agree with the first ones, each row within what is allowed for it; none where there is no second route.
///
/// # Errors
/// A table of another form.
pub fn agreement(tables: &Tables, routes: &[SecondRoute], id: &str) -> Result<Option<Claim>, NodeError> {
    let (mut worst, mut largest_allowed, mut rows): (f64, f64, usize) = (0.0, 0.0, 0);
    let mut compared = Vec::new();
    for SecondRoute { node, difference, what } in routes {
        let found = tables_of(tables, node);
        if !found.is_empty() {
            compared.push(*what);
        }
        for (_, table) in found {
            let allowed = table.f64s("allowed").map_err(unread)?;
            for (difference, allowed) in table.f64s(difference).map_err(unread)?.iter().zip(allowed) {
                worst = worst.max(difference / allowed);
                largest_allowed = largest_allowed.max(*allowed);
                rows += 1;
            }
        }
    }
    let test = Test::AtMost {
        measured: worst,
        tolerance: 1.0,
        reason: format!(
            "difference in units of what is allowed for the row, at most {largest_allowed:.1e}; {rows} rows"
        ),
    };
    let statement = format!("Two independent routes give the same {}.", compared.join(" and "));
    let agreed = claim(id, "all second routes of this scene", statement, Evidence::Direct(test), "");
    Ok((rows > 0).then_some(agreed))
}
