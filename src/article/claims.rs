//! The claims table: every statement with its evidence and its verdict, those that need attention first.
//!
//! Verdicts come from the evidence by the rules of the `check` room. Where a part has a table with the columns `id` and `method`, a claim of that id
//! also says how it was checked; each says how many wrong forms of it the same check refused.

use super::content::{Content, Part};
use super::markup::{escape, formulas, row};
use crate::check::verdict::{Verdict, judge};
use crate::contract::claim::{Claim, Evidence};
use std::fmt::Write as _;

/// A claim with its verdict.
pub struct Judged<'c> {
    /// Its part.
    pub part: &'c Part,
    /// The claim.
    pub claim: &'c Claim,
    /// The verdict.
    pub verdict: Verdict,
    /// The evidence in one line.
    pub evidence: String,
}

/// All claims, those that need attention first; else in the order of the parts.
pub fn judged(content: &Content) -> Vec<Judged<'_>> {
    let mut all: Vec<Judged<'_>> = content
        .parts
        .iter()
        .flat_map(|part| part.findings.claims.iter().map(move |claim| (part, claim)))
        .map(|(part, claim)| {
            let judgement = judge(&claim.evidence);
            Judged { part, claim, verdict: judgement.verdict, evidence: judgement.evidence }
        })
        .collect();
    all.sort_by_key(|judged| judged.verdict);
    all
}

/// A verdict in words.
pub fn words(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Fails => "fails",
        Verdict::HoldsPrintedWithSlip => "holds, printed with a slip",
        Verdict::HoldsOnlyWhen => "holds only when",
        Verdict::NotChecked => "not checked by computing",
        Verdict::Holds => "holds",
    }
}

const ORDER: [Verdict; 5] =
    [Verdict::Holds, Verdict::HoldsPrintedWithSlip, Verdict::HoldsOnlyWhen, Verdict::Fails, Verdict::NotChecked];

/// The line on top: how many statements, and what became of them.
pub fn verdict_line(claims: &[Judged<'_>]) -> String {
    let mut line = format!("<strong>{} statements checked</strong>", claims.len());
    for verdict in ORDER {
        let count = claims.iter().filter(|judged| judged.verdict == verdict).count();
        if count > 0 {
            // Writing to a String does not fail.
            let _ = write!(line, " <span class=\"badge {}\">{count} {}</span>", verdict.name(), words(verdict));
        }
    }
    line
}

/// How a claim was checked.
fn method(judged: &Judged<'_>) -> Option<String> {
    judged.part.tables.iter().find_map(|(_, _, table)| {
        let at = table.texts("id").ok()?.iter().position(|id| *id == judged.claim.id)?;
        table.texts("method").ok()?.get(at).cloned()
    })
}

/// Adds the table.
pub fn add(page: &mut String, claims: &[Judged<'_>]) {
    page.push_str(
        "<div class=\"wide\"><table id=\"claims-table\">\n<thead><tr><th scope=\"col\">verdict</th><th scope=\"col\">where</th><th scope=\"col\">statement</th>\
         <th scope=\"col\">evidence</th></tr></thead>\n<tbody>\n",
    );
    for judged in claims {
        let Judged { part, claim, verdict, evidence } = judged;
        let mut statement =
            format!("<span id=\"claim-{0}-{1}\">{2}</span>", part.id, claim.id, formulas(&claim.statement));
        if let Evidence::Slip { correction, .. } = &claim.evidence {
            let _ = write!(statement, "<br><em>corrected:</em> {}", formulas(correction));
        }
        if let Evidence::OnlyWhen { condition, .. } = &claim.evidence {
            let _ = write!(statement, "<br><em>when</em> {}", formulas(condition));
        }
        if !claim.note.is_empty() {
            let _ = write!(statement, "<br><small>{}</small>", formulas(&claim.note));
        }
        let mut shown = formulas(evidence);
        if let Some(method) = method(judged) {
            let _ = write!(shown, "<br><small>{}</small>", formulas(&method));
        }
        if !claim.wrong.is_empty() {
            let (all, survivors) = (claim.wrong.len(), claim.survivors().count());
            let forms: Vec<&str> = claim.wrong.iter().map(|wrong| wrong.form.as_str()).collect();
            let (refused, forms) = (all - survivors, escape(&forms.join("; ")));
            let _ = write!(shown, "<br><small title=\"{forms}\">wrong forms refused: {refused} of {all}</small>");
        }
        let cells = [
            format!("<span class=\"badge {}\">{}</span>", verdict.name(), words(*verdict)),
            format!("{}<br><a href=\"#{1}\"><code>{1}/{2}</code></a>", escape(&claim.place), part.id, claim.id),
            statement,
            shown,
        ];
        row(page, "td", &cells);
    }
    page.push_str("</tbody></table></div>\n");
}
