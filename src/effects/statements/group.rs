//! The statements as nodes: one a group, and one table of what became of its statements.

use super::statement::{Statement, Unexamined};
use crate::contract::claim::{Evidence, Test};
use crate::contract::node::{Compute, Inputs, Kind, NodeError, Product};
use crate::contract::work::Work;
use crate::effects::product::{failed, product};
use crate::table::Table;
use rayon::prelude::*;
use serde::Serialize;

/// The groups: a name, and the statements of one file.
pub const GROUPS: &[(&str, &[Statement])] = &[
    ("euler-poinsot", super::euler_poinsot::ALL),
    ("sub-riemannian", super::sub_riemannian::ALL),
    ("euler-angles", super::euler_angles::ALL),
    ("quadratures", super::quadratures::ALL),
    ("serret-andoyer-transformation", super::serret_andoyer_transformation::ALL),
    ("serret-andoyer-flow", super::serret_andoyer_flow::ALL),
    ("pendulum", super::pendulum::ALL),
    ("kinds-of-motion", super::kinds_of_motion::ALL),
    ("parameterization", super::parameterization::ALL),
    ("starting-phase", super::starting_phase::ALL),
    ("end-point-map", super::end_point_map::ALL),
    ("conjugate-times", super::conjugate_times::ALL),
    ("conjugate-roots", super::conjugate_roots::ALL),
    ("rotations", super::rotations::ALL),
    ("surfaces-of-revolution", super::surfaces_of_revolution::ALL),
    ("jacobi-fields", super::jacobi_fields::ALL),
    ("darboux-form", super::darboux_form::ALL),
    ("first-return", super::first_return::ALL),
    ("conjugate-locus", super::conjugate_locus::ALL),
    ("cusp", super::cusp::ALL),
    ("spin-system", super::spin_system::ALL),
    ("spin-metric", super::spin_metric::ALL),
    ("left-invariant", super::left_invariant::ALL),
    ("spin-curvature", super::spin_curvature::ALL),
    ("spin-fronts", super::spin_fronts::ALL),
    ("spin-pendulum", super::spin_pendulum::ALL),
    ("spin-pendulum-energy", super::spin_pendulum_energy::ALL),
    ("spin-parametrisation", super::spin_parametrisation::ALL),
    ("spin-integrability", super::spin_integrability::ALL),
    ("spin-closed-form", super::spin_closed_form::ALL),
    ("spin-conjugate-times", super::spin_conjugate_times::ALL),
    ("spin-closed-form-regimes", super::spin_closed_form_regimes::ALL),
    ("spin-closed-form-special", super::spin_closed_form_special::ALL),
    ("spin-limits", super::spin_limits::ALL),
    ("spin-switch-points", super::spin_switch_points::ALL),
    ("spin-trajectories", super::spin_trajectories::ALL),
];

/// The kind.
pub const KIND: Kind = Kind {
    name: "statements",
    summary: "statements of the article, each examined as printed, corrected, and wrong on purpose",
    code: &["effects/statements", "effects/product.rs", "contract/claim.rs", "geometry", "numerics", "table"],
    measurement: false,
};

/// Examines a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Statements {
    /// The group's name.
    pub group: &'static str,
}

/// How far a test is from its limit: measured over allowed; none where cases are counted.
fn margin(test: &Test) -> Option<f64> {
    match test {
        Test::Equal { printed, ours, tolerance, .. } => Some((printed - ours).abs() / tolerance),
        Test::AtMost { measured, tolerance, .. } => Some(measured / tolerance),
        Test::None { .. } => None,
    }
}

/// The test of the form that is claimed to hold.
fn own(evidence: &Evidence) -> Option<&Test> {
    match evidence {
        Evidence::Direct(test) => Some(test),
        Evidence::Slip { corrected, .. } => Some(corrected),
        Evidence::OnlyWhen { inside, .. } => Some(inside),
        Evidence::NotChecked { .. } => None,
    }
}

impl Compute for Statements {
    fn kind(&self) -> &'static Kind {
        &KIND
    }

    fn run(&self, _: &Inputs) -> Result<Product, NodeError> {
        let (name, statements) = GROUPS
            .iter()
            .find(|(name, _)| *name == self.group)
            .ok_or_else(|| NodeError::new(format!("no group of statements is called {:?}", self.group)))?;
        let examined = statements
            .par_iter()
            .map(Statement::examined)
            .collect::<Result<Vec<_>, Unexamined>>()
            .map_err(failed(name))?;
        let mut claims = Vec::with_capacity(examined.len());
        for done in &examined {
            claims.push(serde_json::to_string(&done.claim).map_err(failed(&done.claim.id))?);
        }
        let text = |of: &dyn Fn(usize) -> String| (0..examined.len()).map(of).collect::<Vec<String>>();
        let counts = |of: &dyn Fn(usize) -> usize| (0..examined.len()).map(|i| of(i) as i64).collect::<Vec<i64>>();
        let gap = |margin: Option<f64>| margin.unwrap_or(f64::NAN);
        let least = |i: usize| examined[i].claim.wrong.iter().filter_map(|wrong| margin(&wrong.test)).reduce(f64::min);
        let table = Table::builder("statements", "statements of the article and what became of them")
            .column("id", "", "the statement's name", text(&|i| examined[i].claim.id.clone()))
            .column("place", "", "where it stands in the article", text(&|i| examined[i].claim.place.clone()))
            .column("method", "", "how it was checked", text(&|i| examined[i].method.clone()))
            .column("wrong_forms", "1", "forms that are wrong on purpose", counts(&|i| examined[i].claim.wrong.len()))
            .column(
                "refused",
                "1",
                "of them, those that the same check refused",
                counts(&|i| examined[i].claim.wrong.len() - examined[i].claim.survivors().count()),
            )
            .column_with_gaps(
                "margin",
                "1",
                "measured over allowed, of the form that is claimed to hold",
                examined.iter().map(|done| gap(own(&done.claim.evidence).and_then(margin))).collect::<Vec<f64>>(),
            )
            .column_with_gaps(
                "least_wrong_margin",
                "1",
                "the same, the least of the wrong forms",
                (0..examined.len()).map(|i| gap(least(i))).collect::<Vec<f64>>(),
            )
            .column("survivors", "", "wrong forms that were not refused", {
                text(&|i| examined[i].claim.survivors().map(|wrong| wrong.form.clone()).collect::<Vec<_>>().join("; "))
            })
            .column("claim", "", "the claim with its evidence, as JSON", claims)
            .build()
            .map_err(failed(name))?;
        product(&table, Work::default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::code::undeclared;
    use std::collections::BTreeSet;

    /// Every statement stands as its shape says, has one name and at least two wrong forms, and no wrong form passes.
    #[test]
    fn statements_stand_and_wrong_forms_are_refused() {
        let all: Vec<&Statement> = GROUPS.iter().flat_map(|(_, statements)| *statements).collect();
        let names: BTreeSet<_> = all.iter().map(|statement| statement.id).collect();
        assert_eq!(names.len(), all.len(), "two statements of one name");
        let wrong: Vec<String> = all.par_iter().filter_map(|statement| what_is_wrong(statement)).collect();
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
        assert_eq!(undeclared(&KIND), Ok(vec![]));
    }

    /// What a statement does not show that it must.
    fn what_is_wrong(statement: &Statement) -> Option<String> {
        let done = match statement.examined() {
            Ok(done) => done,
            Err(error) => return Some(error.to_string()),
        };
        let stands = match &done.claim.evidence {
            Evidence::Direct(test) => test.holds(),
            Evidence::Slip { printed, corrected, .. } => !printed.holds() && corrected.holds(),
            Evidence::OnlyWhen { inside, outside, .. } => inside.holds() && !outside.holds(),
            Evidence::NotChecked { .. } => return None,
        };
        let survivors: Vec<_> = done.claim.survivors().collect();
        let is_right = stands && done.claim.wrong.len() >= 2 && survivors.is_empty();
        (!is_right).then(|| format!("{}: {:?}, surviving: {survivors:?}", statement.id, done.claim.evidence))
    }
}
