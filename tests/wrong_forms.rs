//! Every claim about the article carries at least two forms that are wrong on purpose, and its own check refuses all of them.
//!
//! Claims about this program itself ("not in the article", "all … of this experiment") are no statements of the article.

mod support;

use polhode::cli::collected;
use support::{Workspace, all_experiments};

#[test]
fn no_wrong_form_of_a_claim_survives() {
    let ids = all_experiments();
    let workspace = Workspace::with(&ids);
    workspace.line("figures --no-progress").ends(0);
    let (mut claims, mut wrong) = (0, Vec::new());
    for id in &ids {
        let findings = workspace.read(&format!("figures/data/{id}/findings.json"));
        let findings = collected::findings(findings.as_bytes()).unwrap_or_else(|error| panic!("{id}: {error}"));
        for claim in &findings.claims {
            let is_ours = ["not in the article", "all "].iter().any(|words| claim.place.starts_with(words));
            let is_judged = !matches!(claim.evidence, polhode::contract::claim::Evidence::NotChecked { .. });
            if is_judged && !is_ours && claim.wrong.len() < 2 {
                wrong.push(format!("{id}/{}: {} wrong forms", claim.id, claim.wrong.len()));
            }
            wrong.extend(claim.survivors().map(|form| format!("{id}/{}: not refused: {}", claim.id, form.form)));
            claims += 1;
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(claims > 350, "{claims}");
}
