//! Every statement of the article: what became of it, and how clearly its check tells right from wrong.
//!
//! The statements and their checks stand in `effects/statements`, one file a topic. The figure shows for each identity what was measured
//! over what was allowed: the claimed form must lie below one, every form that is wrong on purpose above. Statements that are decided by counting
//! cases have no such ratio and are not drawn.

use super::definition::{Definition, Experiment, findings_kind, picture_kind};
use super::findings::{claim, unread, value};
use super::nodes::Nodes;
use crate::contract::accuracy::Accuracy;
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::config::{Invalid, Validate};
use crate::contract::node::{Kind, NodeError};
use crate::contract::value::NamedValue;
use crate::effects::statements::group::{GROUPS, Statements};
use crate::plot::axis::Axis;
use crate::plot::label::Label;
use crate::plot::mark::{Points, RuleLine};
use crate::plot::picture::{Panel, Picture, Width};
use crate::plot::role::Role;
use crate::table::{Table, Tables};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// Groups of statements; none means all.
    pub groups: Vec<String>,
}

impl Validate for Params {
    fn validate(&self) -> Result<(), Invalid> {
        for (i, group) in self.groups.iter().enumerate() {
            let known: Vec<&str> = GROUPS.iter().map(|(name, _)| *name).collect();
            let accepted = format!("one of: {}", known.join(", "));
            Invalid::unless(known.contains(&group.as_str()), format!("groups[{i}]"), format!("{group:?}"), accepted)?;
        }
        Ok(())
    }
}

impl Params {
    /// The groups asked for, in their order.
    fn asked(&self) -> impl Iterator<Item = &'static str> {
        let is_asked = |name: &str| self.groups.is_empty() || self.groups.iter().any(|group| group == name);
        GROUPS.iter().map(|(name, _)| *name).filter(move |name| is_asked(name))
    }
}

/// The experiment.
pub const EXPERIMENT: Experiment = Experiment::of::<Every>();

const CODE: &[&str] = &[
    "experiments/statements.rs",
    "experiments/definition.rs",
    "experiments/findings.rs",
    "experiments/scenes",
    "experiments/spin_branches.rs",
    "plot",
    "table",
];
const PICTURE: Kind = picture_kind("statements-picture", CODE);
const FINDINGS: Kind = findings_kind(
    "statements-findings",
    &[
        "contract/claim.rs",
        "contract/value.rs",
        "experiments/statements.rs",
        "experiments/definition.rs",
        "experiments/findings.rs",
        "experiments/scenes",
        "experiments/spin_branches.rs",
        "table",
    ],
);

struct Every;

/// The ratios shown: below and above these they stand on the border.
const SHOWN: (f64, f64) = (1e-6, 1e16);

impl Definition for Every {
    type Params = Params;

    const ID: &'static str = "statements";
    const TITLE: &'static str = "every statement, and how clearly its check tells right from wrong";
    const PLACE: &'static str = "sections 1 to 5";
    const PICTURE: &'static Kind = &PICTURE;
    const FINDINGS: &'static Kind = &FINDINGS;

    fn set_accuracy(_: &mut Params, _: Accuracy) {
        // Checks have tolerances of their own.
    }

    fn nodes(params: &Params, nodes: &mut Nodes) -> Result<(), NodeError> {
        for group in params.asked() {
            nodes.add(group, &[], Statements { group }, &[], &[("group", "groups".to_owned())])?;
        }
        Ok(())
    }

    fn picture(params: &Params, tables: &Tables) -> Result<Picture, NodeError> {
        let (low, high) = SHOWN;
        let mut rows: Vec<(String, Vec<f64>, Vec<f64>)> = Vec::new();
        let mut count = 0;
        for group in params.asked() {
            let table = tables.get(group).map_err(unread)?;
            let shown = |column: &str| -> Result<Vec<f64>, NodeError> {
                let values = table.f64s(column).map_err(unread)?;
                Ok(values.iter().filter(|x| !x.is_nan()).map(|x| x.clamp(low, high)).collect())
            };
            count += table.rows();
            rows.push((group.replace('-', " "), shown("margin")?, shown("least_wrong_margin")?));
        }
        let ticks = rows.iter().enumerate().map(|(i, (name, ..))| (i as f64, Label::from(name.as_str())));
        let decades =
            [(-6, "10^{−6}"), (-3, "10^{−3}"), (0, "1"), (4, "10^4"), (8, "10^8"), (12, "10^{12}"), (16, "10^{16}")];
        let x = Axis::new("measured over allowed")
            .log()
            .fixed(low / 3.0, high * 3.0)
            .ticks_at(decades.map(|(n, words)| (libm::pow(10.0, f64::from(n)), words)));
        let y = Axis::new("").fixed(-0.6, rows.len().max(1) as f64 - 0.4).ticks_at(ticks).reversed();
        let mut panel = Panel::new(x, y).mark(RuleLine::vertical(Role::Reference, 1.0));
        let at = |values: &[f64], shift: f64, row: usize| {
            values.iter().map(|x| (*x, row as f64 + shift)).collect::<Vec<_>>()
        };
        let mut right = Vec::new();
        let mut wrong = Vec::new();
        for (row, (_, own, least)) in rows.iter().enumerate() {
            right.extend(at(own, -0.15, row));
            wrong.extend(at(least, 0.15, row));
        }
        panel = panel
            .mark(Points::new(Role::SeriesA, right).legend("the claimed form"))
            .mark(Points::new(Role::SeriesB, wrong).legend("the nearest form that is wrong on purpose"));
        let height = 24.0 + 6.0 * rows.len() as f64;
        Ok(Picture::new(Width::Double, height, "Every statement of the article, examined").panel(panel).caption(format!(
            "{count} statements of the article in {} groups. For each that is decided by a measured number: that number over what is allowed, for the form \
             claimed to hold and for the least wrong of the forms that are wrong on purpose (a sign, a factor, an exponent), by the same check. Left of the line \
             a form is accepted, right of it refused; marks on the borders stand for smaller or larger ratios. Statements decided by counting cases \
             are in the table of claims only.",
            rows.len(),
        )))
    }

    fn values(params: &Params, tables: &Tables) -> Result<Vec<NamedValue>, NodeError> {
        let (mut statements, mut wrong, mut refused) = (0, 0, 0);
        for group in params.asked() {
            let table = tables.get(group).map_err(unread)?;
            statements += table.rows();
            wrong += table.ints("wrong_forms").map_err(unread)?.iter().sum::<i64>();
            refused += table.ints("refused").map_err(unread)?.iter().sum::<i64>();
        }
        let count = |name: &str, count: f64, meaning: &str| value(name, (count, 0.0), "1", meaning, "counted");
        Ok(vec![
            count("statements", statements as f64, "statements of the article that have a check"),
            count("wrong_forms", wrong as f64, "forms of them that are wrong on purpose"),
            count("wrong_forms_refused", refused as f64, "of these, those that the same check refused"),
        ])
    }

    fn claims(params: &Params, tables: &Tables) -> Result<Vec<Claim>, NodeError> {
        let mut claims = Vec::new();
        let (mut survivors, mut cases, mut example) = (0, 0, String::new());
        for group in params.asked() {
            let table: &Table = tables.get(group).map_err(unread)?;
            let (ids, texts) = (table.texts("id").map_err(unread)?, table.texts("claim").map_err(unread)?);
            let wrong = table.ints("wrong_forms").map_err(unread)?;
            let refused = table.ints("refused").map_err(unread)?;
            let left = table.texts("survivors").map_err(unread)?;
            for row in 0..table.rows() {
                let claim: Claim = serde_json::from_str(&texts[row])
                    .map_err(|error| NodeError::new(format!("{group}/{}: {error}", ids[row])))?;
                claims.push(claim);
                cases += wrong[row].unsigned_abs();
                survivors += (wrong[row] - refused[row]).unsigned_abs();
                if example.is_empty() && !left[row].is_empty() {
                    example = format!("{}: {}", ids[row], left[row]);
                }
            }
        }
        claims.push(claim(
            "no_wrong_form_survives",
            "not in the article: how statements are checked",
            "Every form that is wrong on purpose is refused by the check that accepts the claimed one.",
            Evidence::Direct(Test::None { counterexamples: survivors, cases, example }),
            "",
        ));
        Ok(claims)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::experiments::preview;

    /// As many claims as statements, and the one about wrong forms, which holds.
    #[test]
    fn every_statement_is_a_claim() {
        let preview = preview::run(&EXPERIMENT, |text| text);
        let count: usize = GROUPS.iter().map(|(_, statements)| statements.len()).sum();
        assert_eq!(preview.findings.claims.len(), count + 1);
        let last = preview.findings.claims.last().unwrap();
        assert!(matches!(&last.evidence, Evidence::Direct(test) if test.holds()), "{last:?}");
    }

    #[test]
    fn an_unknown_group_is_refused_by_key() {
        let text = include_str!("../../experiments/statements.toml");
        preview::refuses::<Params>(text, &[("groups = []", "groups = [\"nothing\"]", "groups[0]")]);
    }
}
