//! The goldens: `golden/<id>.snap` pins each experiment's verdicts, values (12 digits), tables and work.
//!
//! `just bless` writes them anew; read the difference before committing it. All experiments are computed afresh here, in a
//! folder of their own, so that nothing old can be compared with itself.

mod support;

use std::collections::BTreeSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use support::{Workspace, all_experiments, files, goldens, repository};

#[test]
fn experiments_are_as_their_goldens_say() {
    let ids = all_experiments();
    let workspace = Workspace::with(&ids);
    let goldens = goldens(&workspace);
    let found: BTreeSet<&String> = goldens.iter().map(|(id, _)| id).collect();
    assert_eq!(found, ids.iter().collect(), "every config is an experiment");

    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../golden");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let different: Vec<&String> = goldens
        .iter()
        .filter(|(id, text)| {
            let compare = || settings.bind(|| insta::assert_snapshot!(id.as_str(), text));
            catch_unwind(AssertUnwindSafe(compare)).is_err()
        })
        .map(|(id, _)| id)
        .collect();
    assert!(different.is_empty(), "other than their goldens: {different:?}; `just bless` accepts them");

    // The files themselves, as the command reads them: all of them, and none too many.
    let stored = files(&repository().join("golden"));
    let expected: BTreeSet<String> = ids.iter().map(|id| format!("{id}.snap")).collect();
    let names: BTreeSet<String> = stored.keys().filter(|name| name.ends_with(".snap")).cloned().collect();
    assert_eq!(names, expected, "golden/ holds one snapshot an experiment");
    for (name, bytes) in &stored {
        workspace.write(&format!("golden/{name}"), bytes);
    }
    let ran = workspace.line("check --strict --json");
    let report = ran.json();
    for golden in report["goldens"].as_array().expect("goldens") {
        assert_eq!(golden["outcome"], "same", "{golden:#}");
    }
    ran.ends(0);
}
