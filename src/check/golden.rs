//! Goldens: the text that pins an experiment's numbers, tables, verdicts and work.
//!
//! One line an entry, in order of names, so that a difference in a text tool is a difference in meaning. Values stand with
//! 12 significant digits: results are the same bits everywhere, so this leaves out noise that a better algorithm may
//! change. The stored files `golden/<id>.snap` are snapshots of insta, which compares them in the tests; at run time the
//! text is compared here, without insta.

use super::verdict::Verdict;
use crate::contract::digest::Digest;
use crate::contract::value::NamedValue;
use crate::contract::work::Work;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The first line: the version of the text form.
const VERSION: &str = "golden 1";

/// What an experiment's golden pins.
#[derive(Clone, Debug, PartialEq)]
pub struct Golden {
    /// The experiment's id.
    pub experiment: String,
    /// The digest of its config ([`crate::contract::config::digest`]).
    pub config: Digest,
    /// Its named values.
    pub values: Vec<NamedValue>,
    /// The logical digests of its tables, by the address of the node that makes them.
    pub tables: Vec<(String, Digest)>,
    /// The verdicts on its claims, by the claims' ids.
    pub verdicts: Vec<(String, Verdict)>,
    /// The work of its nodes, by their addresses.
    pub work: Vec<(String, Work)>,
}

/// The name of the file below the folder of goldens.
pub fn file_name(experiment: &str) -> String {
    format!("{experiment}.snap")
}

/// The golden as text.
pub fn render(golden: &Golden) -> String {
    let mut text = format!("{VERSION}\nexperiment: {}\nconfig: {}\n", golden.experiment, golden.config);
    let mut section = "";
    for (place, entry) in entries(golden) {
        if place.0 != section {
            section = place.0;
            text.push_str(&format!("\n[{section}]\n"));
        }
        text.push_str(&format!("{}: {entry}\n", place.1));
    }
    text
}

/// The sections, in order.
const SECTIONS: [&str; 4] = [VERDICTS, "values", "tables", "work"];
/// The section whose differences are differences of verdicts.
const VERDICTS: &str = "verdicts";

type Entries<'a> = Vec<((&'a str, String), String)>;

fn entries(golden: &Golden) -> Entries<'static> {
    let value = |value: &NamedValue| {
        let unit = if value.unit.is_empty() { "1" } else { &value.unit };
        (value.name.clone(), format!("{:.11e} {unit}", value.value))
    };
    let sections: [Vec<(String, String)>; 4] = [
        golden.verdicts.iter().map(|(id, verdict)| (id.clone(), verdict.to_string())).collect(),
        golden.values.iter().map(value).collect(),
        golden.tables.iter().map(|(node, digest)| (node.clone(), digest.to_string())).collect(),
        golden.work.iter().map(|(node, work)| (node.clone(), counted(work))).collect(),
    ];
    let mut all = Vec::new();
    for (name, mut section) in SECTIONS.into_iter().zip(sections) {
        section.sort();
        all.extend(section.into_iter().map(|(key, entry)| ((name, key), entry)));
    }
    all
}

/// The work that was done: what is zero was not asked for and is left out.
fn counted(work: &Work) -> String {
    let Work {
        state_dimension,
        steps,
        flow_evaluations,
        tangent_evaluations,
        event_evaluations,
        elliptic_calls,
        roots_solved,
        dense_points,
        kept_coefficients,
        monitor_evaluations,
        rows,
    } = work;
    let counts = [
        ("state_dimension", state_dimension),
        ("steps", steps),
        ("flow_evaluations", flow_evaluations),
        ("tangent_evaluations", tangent_evaluations),
        ("event_evaluations", event_evaluations),
        ("elliptic_calls", elliptic_calls),
        ("roots_solved", roots_solved),
        ("dense_points", dense_points),
        ("kept_coefficients", kept_coefficients),
        ("monitor_evaluations", monitor_evaluations),
        ("rows", rows),
    ];
    let done: Vec<String> =
        counts.iter().filter(|(_, count)| **count > 0).map(|(name, count)| format!("{name} {count}")).collect();
    if done.is_empty() { "none".to_owned() } else { done.join(", ") }
}

/// An entry that differs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// The section: `verdicts`, `values`, `tables`, `work`; empty for the head of the text.
    pub section: String,
    /// The entry's name.
    pub name: String,
    /// What the golden says, if it has the entry.
    pub golden: Option<String>,
    /// What was found, if it was.
    pub now: Option<String>,
}

impl Difference {
    /// Whether a verdict differs, which weighs more than a number.
    pub fn is_verdict(&self) -> bool {
        self.section == VERDICTS
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = |side: &Option<String>| side.clone().unwrap_or_else(|| "nothing".to_owned());
        let section = if self.section.is_empty() { String::new() } else { format!("{} ", self.section) };
        write!(f, "{section}{}: {} → {}", self.name, side(&self.golden), side(&self.now))
    }
}

/// What a comparison with the stored golden gives.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "outcome")]
pub enum Comparison {
    /// Nothing differs.
    Same,
    /// The golden belongs to another config.
    NotComparable {
        /// The config's digest in the golden.
        golden: Digest,
        /// The config's digest now.
        now: Digest,
    },
    /// Some entries differ.
    Different {
        /// The entries.
        differences: Vec<Difference>,
    },
    /// There is no golden.
    Missing,
}

/// Compares the text of a stored snapshot (`None`: there is no file) with what was found.
pub fn compare(stored: Option<&str>, current: &Golden) -> Comparison {
    let Some(stored) = stored else { return Comparison::Missing };
    let rendered = render(current);
    let (old, new) = (parsed(body(stored)), parsed(&rendered));
    let config = old.get(&(String::new(), "config".to_owned())).and_then(|text| text.parse::<Digest>().ok());
    if let Some(golden) = config.filter(|golden| *golden != current.config) {
        return Comparison::NotComparable { golden, now: current.config };
    }
    let mut places: Vec<_> = old.keys().chain(new.keys()).collect();
    places.sort_by_key(|(section, name)| (SECTIONS.iter().position(|s| s == section), name.as_str()));
    places.dedup();
    let differences: Vec<Difference> = places
        .into_iter()
        .filter(|place| old.get(place) != new.get(place))
        .map(|place| Difference {
            section: place.0.clone(),
            name: place.1.clone(),
            golden: old.get(place).cloned(),
            now: new.get(place).cloned(),
        })
        .collect();
    if differences.is_empty() { Comparison::Same } else { Comparison::Different { differences } }
}

/// The verdicts that a stored snapshot pins; none where it belongs to another config.
pub fn pinned_verdicts(stored: Option<&str>, config: Digest) -> BTreeMap<String, Verdict> {
    let entries = parsed(stored.map_or("", body));
    let same = entries.get(&(String::new(), "config".to_owned())) == Some(&config.to_string());
    let verdicts = entries.into_iter().filter(|((section, _), _)| same && section == VERDICTS);
    verdicts.filter_map(|((_, id), verdict)| Some((id, verdict.parse().ok()?))).collect()
}

/// The text of a snapshot without insta's front matter, which stands between two lines of three dashes.
pub fn body(snapshot: &str) -> &str {
    let Some(rest) = snapshot.strip_prefix("---\n").or_else(|| snapshot.strip_prefix("---\r\n")) else {
        return snapshot;
    };
    let mut start = 0;
    for line in rest.split_inclusive('\n') {
        start += line.len();
        if line.trim_end() == "---" {
            return &rest[start..];
        }
    }
    snapshot
}

/// The entries of a golden's text by section and name. A line that is no entry is one of its own, so that it differs.
fn parsed(text: &str) -> BTreeMap<(String, String), String> {
    let mut section = String::new();
    let mut entries = BTreeMap::new();
    for line in text.lines().map(str::trim_end).filter(|line| !line.is_empty()) {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
            section = name.to_owned();
        } else {
            let (name, entry) = line.split_once(": ").unwrap_or((line, ""));
            entries.insert((section.clone(), name.to_owned()), entry.to_owned());
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    fn golden() -> Golden {
        let value = |name: &str, value: f64| NamedValue {
            name: name.to_owned(),
            value,
            unit: "rad".to_owned(),
            meaning: "an angle".to_owned(),
            route: "closed form".to_owned(),
            error: 1e-15,
        };
        Golden {
            experiment: "fig4".to_owned(),
            config: Digest::of(b"config"),
            values: vec![value("k2", 1.0 / 3.0), value("k1", -0.0)],
            tables: vec![("spin/k=0.8".to_owned(), Digest::of(b"table"))],
            verdicts: vec![("bound".to_owned(), Verdict::HoldsPrintedWithSlip)],
            work: vec![("spin/k=0.8".to_owned(), Work { steps: 12, rows: 3, ..Work::default() })],
        }
    }

    /// As insta 1.49 writes it: front matter, then the text without its last newline, then a newline.
    fn stored(golden: &Golden) -> String {
        format!("---\nsource: tests/golden.rs\nexpression: text\n---\n{}\n", render(golden).trim_end())
    }

    #[test]
    fn the_text_form() {
        let (config, table) = (Digest::of(b"config"), Digest::of(b"table"));
        let expected = format!(
            "\
golden 1
experiment: fig4
config: {config}

[verdicts]
bound: holds-printed-with-slip

[values]
k1: -0.00000000000e0 rad
k2: 3.33333333333e-1 rad

[tables]
spin/k=0.8: {table}

[work]
spin/k=0.8: steps 12, rows 3
"
        );
        assert_eq!(render(&golden()), expected);
    }

    #[test]
    fn the_same_and_the_missing() {
        assert_eq!(compare(Some(&stored(&golden())), &golden()), Comparison::Same);
        assert_eq!(compare(Some(&stored(&golden()).replace('\n', "\r\n")), &golden()), Comparison::Same);
        assert_eq!(compare(None, &golden()), Comparison::Missing);
        let mut reordered = golden();
        reordered.values.reverse();
        assert_eq!(compare(Some(&stored(&golden())), &reordered), Comparison::Same);
        // A value is pinned to 12 digits, not to its last bit.
        reordered.values[1].value += f64::EPSILON / 8.0;
        assert_eq!(compare(Some(&stored(&golden())), &reordered), Comparison::Same);
    }

    #[test]
    fn differences_name_the_entry_and_both_sides() {
        let mut now = golden();
        now.values[0].value = 0.5;
        now.verdicts[0].1 = Verdict::Fails;
        now.work[0].0 = "spin/k=0.9".to_owned();
        let Comparison::Different { differences } = compare(Some(&stored(&golden())), &now) else {
            panic!("they differ")
        };
        let shown: Vec<String> = differences.iter().map(Difference::to_string).collect();
        assert_eq!(
            shown,
            [
                "verdicts bound: holds-printed-with-slip → fails",
                "values k2: 3.33333333333e-1 rad → 5.00000000000e-1 rad",
                "work spin/k=0.8: steps 12, rows 3 → nothing",
                "work spin/k=0.9: nothing → steps 12, rows 3",
            ]
        );
        assert!(differences[0].is_verdict() && !differences[1].is_verdict());
    }

    #[test]
    fn another_config_is_not_comparable_and_pins_nothing() {
        let mut now = golden();
        now.config = Digest::of(b"another");
        let text = stored(&golden());
        let expected = Comparison::NotComparable { golden: golden().config, now: now.config };
        assert_eq!(compare(Some(&text), &now), expected);
        assert!(pinned_verdicts(Some(&text), now.config).is_empty());
        let pinned = pinned_verdicts(Some(&text), golden().config);
        assert_eq!(pinned.get("bound"), Some(&Verdict::HoldsPrintedWithSlip));
    }

    #[test]
    fn a_text_that_is_no_golden_differs() {
        assert!(matches!(compare(Some("rubbish"), &golden()), Comparison::Different { .. }));
        assert!(matches!(compare(Some("---\nno end"), &golden()), Comparison::Different { .. }));
        assert!(matches!(compare(Some(""), &golden()), Comparison::Different { .. }));
        let spoilt = stored(&golden()).replace("golden 1", "golden 0");
        let Comparison::Different { differences } = compare(Some(&spoilt), &golden()) else { panic!("they differ") };
        assert_eq!(differences.len(), 2);
    }
}
