//! The report of a check, as data and as text: claims, goldens, references, agreement of routes.
//!
//! What fails: a verdict that is not the pinned one, a wrong form of a claim that is not refused, a reference missed, two routes that disagree (class 5 of the exit
//! codes); any other difference from a golden (class 6). A statement of the article that is found false, as pinned, is a
//! result. With `strict`, a golden that is missing or belongs to another config fails as well.
//!
//! By convention, a claim whose id begins with `routes` says that two routes agree; it is listed apart, and always fails
//! the check when it does not hold.

use super::golden::{Comparison, Golden, compare, pinned_verdicts};
use super::reference::{Agreement, Compared, References};
use super::verdict::{Verdict, judge};
use crate::contract::claim::{Claim, Evidence, Test};
use crate::contract::manifest::Line;
use crate::contract::value::Findings;
use serde::Serialize;
use std::fmt::Write as _;

/// Ids of claims that two routes agree begin so.
const ROUTES: &str = "routes";

/// What an experiment gives to check.
#[derive(Clone, Debug)]
pub struct Subject {
    /// What it found.
    pub findings: Findings,
    /// The leaves of its config ([`crate::contract::config::leaves`]).
    pub config: Vec<Line>,
    /// What a golden of it would pin now. Its verdicts are filled in by [`check`].
    pub golden: Golden,
    /// The text of the stored golden, if there is one.
    pub stored: Option<String>,
}

/// The whole report: the machine output of `check`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The version of this form.
    pub schema: u32,
    /// Whether goldens that are missing or belong to another config count as failures.
    pub strict: bool,
    /// The claims, those that need attention first.
    pub claims: Vec<ClaimLine>,
    /// Two routes to the same numbers.
    pub routes: Vec<RouteLine>,
    /// The references.
    pub references: Vec<Compared>,
    /// The goldens.
    pub goldens: Vec<GoldenLine>,
}

/// A claim with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClaimLine {
    /// The experiment.
    pub experiment: String,
    /// The claim's name in it.
    pub id: String,
    /// Where it stands in the article.
    pub place: String,
    /// What is claimed.
    pub statement: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict that the golden pins, where it pins one.
    pub pinned: Option<Verdict>,
    /// The evidence in one line.
    pub evidence: String,
    /// Why numbers differ, or under which condition the statement holds.
    pub note: String,
    /// Forms of it that are wrong on purpose.
    pub wrong_forms: Vec<String>,
    /// Those of them that the same check takes for right.
    pub surviving: Vec<String>,
}

impl ClaimLine {
    /// Whether the verdict differs from the pinned one.
    pub fn is_surprise(&self) -> bool {
        self.pinned.is_some_and(|pinned| pinned != self.verdict)
    }
}

/// Two routes to the same numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RouteLine {
    /// The experiment.
    pub experiment: String,
    /// The name of the claim.
    pub id: String,
    /// What is compared, and how.
    pub statement: String,
    /// The largest difference, where the evidence is one.
    pub largest: Option<f64>,
    /// What is allowed.
    pub allowed: Option<f64>,
    /// Whether they agree.
    pub agree: bool,
    /// The evidence in one line.
    pub evidence: String,
}

/// An experiment beside its golden.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GoldenLine {
    /// The experiment.
    pub experiment: String,
    /// What the comparison gave.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// The class of failure, in the terms of the command's exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// A verdict or a reference differs, or two routes disagree: exit code 5.
    VerdictOrReference,
    /// A golden differs: exit code 6.
    Golden,
}

impl Failure {
    /// The exit code.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::VerdictOrReference => 5,
            Self::Golden => 6,
        }
    }
}

/// The verdicts on claims, by their ids: what a golden pins.
pub fn verdicts(claims: &[Claim]) -> Vec<(String, Verdict)> {
    claims.iter().map(|claim| (claim.id.clone(), judge(&claim.evidence).verdict)).collect()
}

/// Checks experiments against their goldens, the references, and the rules of verdicts.
pub fn check(subjects: &[Subject], references: &References, strict: bool) -> Report {
    let mut report = Report { schema: 1, strict, claims: vec![], routes: vec![], references: vec![], goldens: vec![] };
    for subject in subjects {
        let Subject { findings, config, golden, stored } = subject;
        let golden = Golden { verdicts: verdicts(&findings.claims), ..golden.clone() };
        let pinned = pinned_verdicts(stored.as_deref(), golden.config);
        for claim in &findings.claims {
            let experiment = golden.experiment.clone();
            if claim.id.starts_with(ROUTES) {
                report.routes.push(route(experiment, claim));
            } else {
                let pinned = pinned.get(&claim.id).copied();
                report.claims.push(judged(experiment, claim, pinned));
            }
        }
        report.references.extend(references.compare(&golden.experiment, &findings.values, config));
        let comparison = compare(stored.as_deref(), &golden);
        report.goldens.push(GoldenLine { experiment: golden.experiment, comparison });
    }
    // Stable: within a verdict, the order of experiments and of their claims stays.
    report.claims.sort_by_key(|line| (!line.is_surprise(), line.verdict));
    report.routes.sort_by_key(|line| line.agree);
    report.references.sort_by_key(|line| !missed(line));
    report
}

fn judged(experiment: String, claim: &Claim, pinned: Option<Verdict>) -> ClaimLine {
    let Claim { id, place, statement, evidence, note, wrong } = claim.clone();
    let surviving = claim.survivors().map(|survivor| survivor.form.clone()).collect();
    let judgement = judge(&evidence);
    let (verdict, evidence) = (judgement.verdict, judgement.evidence);
    let wrong_forms = wrong.into_iter().map(|wrong| wrong.form).collect();
    ClaimLine { experiment, id, place, statement, verdict, pinned, evidence, note, wrong_forms, surviving }
}

fn route(experiment: String, claim: &Claim) -> RouteLine {
    let judgement = judge(&claim.evidence);
    let (largest, allowed) = match &claim.evidence {
        Evidence::Direct(Test::AtMost { measured, tolerance, .. }) => (Some(*measured), Some(*tolerance)),
        Evidence::Direct(Test::Equal { printed, ours, tolerance, .. }) => {
            (Some((printed - ours).abs()), Some(*tolerance))
        }
        _ => (None, None),
    };
    RouteLine {
        experiment,
        id: claim.id.clone(),
        statement: claim.statement.clone(),
        largest,
        allowed,
        agree: judgement.verdict == Verdict::Holds,
        evidence: judgement.evidence,
    }
}

fn missed(line: &Compared) -> bool {
    matches!(line.agreement, Agreement::Differs | Agreement::NoSuchValue)
}

impl Report {
    /// The failure that decides the exit code, if there is one: the first of the classes.
    pub fn failure(&self) -> Option<Failure> {
        let verdict = |golden: &GoldenLine| match &golden.comparison {
            Comparison::Different { differences } => differences.iter().any(super::golden::Difference::is_verdict),
            _ => false,
        };
        let number = |golden: &GoldenLine| match &golden.comparison {
            Comparison::Same => false,
            Comparison::Different { .. } => true,
            Comparison::NotComparable { .. } | Comparison::Missing => self.strict,
        };
        if self.goldens.iter().any(verdict)
            || self.claims.iter().any(|line| !line.surviving.is_empty())
            || self.routes.iter().any(|line| !line.agree)
            || self.references.iter().any(missed)
        {
            Some(Failure::VerdictOrReference)
        } else if self.goldens.iter().any(number) {
            Some(Failure::Golden)
        } else {
            None
        }
    }

    /// The report for people.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing to a String can't fail.
        let _ = self.write_claims(&mut text);
        let _ = self.write_routes(&mut text);
        let _ = self.write_references(&mut text);
        let _ = self.write_goldens(&mut text);
        text
    }

    fn write_claims(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "Claims of the article")?;
        for line in &self.claims {
            let ClaimLine { experiment, id, place, statement, verdict, pinned, evidence, note, wrong_forms, surviving } =
                line;
            let surprise = match pinned {
                Some(pinned) if line.is_surprise() => format!(" (pinned: {pinned})"),
                _ => String::new(),
            };
            writeln!(text, "  {verdict:<24}{experiment}/{id}{surprise}")?;
            writeln!(text, "      {place}: {statement}")?;
            writeln!(text, "      {evidence}")?;
            if !note.is_empty() {
                writeln!(text, "      {note}")?;
            }
            for form in surviving {
                writeln!(text, "      NOT REFUSED, though wrong: {form}")?;
            }
            if surviving.is_empty() && !wrong_forms.is_empty() {
                writeln!(text, "      wrong forms refused: {}", wrong_forms.len())?;
            }
        }
        Ok(())
    }

    fn write_routes(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "\nAgreement of routes")?;
        for RouteLine { experiment, id, statement, agree, evidence, .. } in &self.routes {
            let verdict = if *agree { "agree" } else { "DISAGREE" };
            writeln!(text, "  {verdict:<24}{experiment}/{id}: {statement}: {evidence}")?;
        }
        Ok(())
    }

    fn write_references(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "\nReference values")?;
        for line in &self.references {
            let Compared { name, agreement, difference, ulps, tolerance, origin, .. } = line;
            let measured = match (difference, ulps) {
                (Some(difference), Some(ulps)) => format!("difference {difference:.1e}, {ulps} ulp"),
                _ => "no value".to_owned(),
            };
            match agreement {
                Agreement::Agrees => writeln!(text, "  {:<24}{name}: {measured} (allowed {tolerance:.1e})", "agrees")?,
                Agreement::NotComparable => {
                    writeln!(text, "  {:<24}{name}: the reference is for another config", "not comparable")?;
                }
                Agreement::Differs | Agreement::NoSuchValue => {
                    writeln!(text, "  {:<24}{name}: {measured} (allowed {tolerance:.1e})", "DIFFERS")?;
                    writeln!(text, "      ours {:?}, reference {}", line.ours, line.reference)?;
                    writeln!(text, "      {origin}")?;
                }
            }
        }
        Ok(())
    }

    fn write_goldens(&self, text: &mut String) -> std::fmt::Result {
        writeln!(text, "\nGoldens")?;
        for GoldenLine { experiment, comparison } in &self.goldens {
            match comparison {
                Comparison::Same => writeln!(text, "  {:<24}{experiment}", "same")?,
                Comparison::Missing => writeln!(text, "  {:<24}{experiment}", "missing")?,
                Comparison::NotComparable { .. } => {
                    writeln!(text, "  {:<24}{experiment}: the golden is for another config", "not comparable")?;
                }
                Comparison::Different { differences } => {
                    writeln!(text, "  {:<24}{experiment}: {} entries", "DIFFERS", differences.len())?;
                    differences.iter().try_for_each(|difference| writeln!(text, "      {difference}"))?;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::golden::render;
    use crate::contract::digest::Digest;
    use crate::contract::value::NamedValue;

    fn claim(id: &str, ours: f64) -> Claim {
        Claim {
            id: id.to_owned(),
            place: "Theorem 3.9".to_owned(),
            statement: "t1 = 1".to_owned(),
            evidence: Evidence::Direct(Test::Equal { printed: 1.0, ours, tolerance: 0.1, reason: String::new() }),
            note: String::new(),
            wrong: Vec::new(),
        }
    }

    fn subject(claims: Vec<Claim>) -> Subject {
        let value = NamedValue {
            name: "x".to_owned(),
            value: 1.5,
            unit: "1".to_owned(),
            meaning: String::new(),
            route: String::new(),
            error: 0.0,
        };
        let golden = Golden {
            experiment: "e".to_owned(),
            config: Digest::of(b"config"),
            values: vec![value.clone()],
            tables: vec![],
            verdicts: verdicts(&claims),
            work: vec![],
        };
        let stored = Some(render(&golden));
        Subject { findings: Findings { values: vec![value], claims }, config: vec![], golden, stored }
    }

    fn references(decimal: &str) -> References {
        let text = format!("[e.x]\nvalue = \"{decimal}\"\norigin = \"by hand\"\ntolerance = 1e-14\n");
        References::parse(&text).expect("well formed")
    }

    fn good() -> References {
        references("1.5000000000000000000")
    }

    #[test]
    fn a_false_statement_as_pinned_is_a_result() {
        let report = check(&[subject(vec![claim("good", 1.0), claim("bad", 2.0)])], &good(), true);
        assert_eq!(report.failure(), None);
        assert_eq!((report.claims[0].id.as_str(), report.claims[0].verdict), ("bad", Verdict::Fails));
    }

    #[test]
    fn a_verdict_other_than_the_pinned_one_fails_first() {
        let mut subject = subject(vec![claim("always", 2.0), claim("now", 1.0)]);
        subject.findings.claims[1] = claim("now", 2.0);
        subject.golden.values[0].value = 1.6;
        let report = check(&[subject], &good(), false);
        assert_eq!(report.failure().map(Failure::exit_code), Some(5));
        assert_eq!((report.claims[0].id.as_str(), report.claims[0].pinned), ("now", Some(Verdict::Holds)));
        let text = report.text();
        assert!(text.contains("e/now (pinned: holds)"), "{text}");
        assert!(text.contains("values x: 1.50000000000e0 1 → 1.60000000000e0 1"), "{text}");
    }

    #[test]
    fn a_number_that_differs_from_the_golden_is_class_six() {
        let mut subject = subject(vec![]);
        subject.golden.values[0].value = 1.6;
        assert_eq!(check(&[subject], &good(), false).failure().map(Failure::exit_code), Some(6));
    }

    #[test]
    fn another_config_and_a_missing_golden_fail_only_when_strict() {
        let mut edited = subject(vec![claim("c", 1.0)]);
        edited.golden.config = Digest::of(b"another");
        let mut fresh = subject(vec![]);
        fresh.stored = None;
        for subject in [edited, fresh] {
            assert_eq!(check(std::slice::from_ref(&subject), &good(), false).failure(), None);
            assert_eq!(check(&[subject], &good(), true).failure(), Some(Failure::Golden));
        }
    }

    #[test]
    fn a_reference_missed_is_class_five() {
        let report = check(&[subject(vec![])], &references("1.5000000000000100000"), false);
        assert_eq!(report.failure(), None, "6.7e-15 is within the tolerance");
        let report = check(&[subject(vec![])], &references("1.5000000000001000000"), false);
        assert_eq!(report.failure(), Some(Failure::VerdictOrReference));
        let mut without = subject(vec![]);
        without.findings.values.clear();
        let report = check(&[without], &good(), false);
        assert_eq!(report.failure(), Some(Failure::VerdictOrReference));
    }

    #[test]
    fn routes_that_disagree_fail_even_when_pinned() {
        let agree = |measured: f64| {
            let mut claim = claim("routes-t1", 1.0);
            claim.evidence =
                Evidence::Direct(Test::AtMost { measured, tolerance: 1e-12, reason: "two routes".to_owned() });
            check(&[subject(vec![claim])], &good(), false)
        };
        let report = agree(1e-13);
        assert_eq!((report.failure(), report.claims.len()), (None, 0));
        assert_eq!((report.routes[0].largest, report.routes[0].allowed), (Some(1e-13), Some(1e-12)));
        assert_eq!(agree(1e-11).failure(), Some(Failure::VerdictOrReference));
    }

    #[test]
    fn the_report_is_data() {
        let json = serde_json::to_value(check(&[subject(vec![claim("c", 1.0)])], &good(), false)).expect("serialises");
        assert_eq!(json["schema"], 1);
        assert_eq!(json["claims"][0]["verdict"], "holds");
        assert_eq!(json["goldens"][0]["outcome"], "same");
        assert_eq!(json["references"][0]["agreement"], "agrees");
    }
}
