//! `figures/values.toml`: every named value of every experiment, to be cited and compared.
//!
//! One table a value, `[fig4.k1]`, with the number in 17 significant digits (which read back to the same bits), unit,
//! route, error and meaning. The text depends on the values alone.

use super::number::significant;
use crate::contract::value::NamedValue;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// The head of the file.
const HEAD: &str = "# Every named value, written by `polhode figures`. Edits are undone by the next run.\n\
    # value: 17 significant digits; error: a bound on the absolute error.\n";

/// Named values that can't be written or read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValuesError {
    /// A number that is not finite.
    #[error("{name}: {what} is {number}, which is not finite")]
    NotFinite {
        /// The value's name with its experiment.
        name: String,
        /// `value` or `error`.
        what: &'static str,
        /// The number.
        number: f64,
    },
    /// Two values of one name.
    #[error("{name} is there twice")]
    Twice {
        /// The value's name with its experiment.
        name: String,
    },
    /// A text of another form.
    #[error("not a list of values: {message}")]
    Form {
        /// What is wrong.
        message: String,
    },
}

/// Values by experiment and name.
pub type Values = BTreeMap<String, BTreeMap<String, NamedValue>>;

/// The text of the file: experiments in order of their ids, values in the order of their experiment.
///
/// # Errors
/// A number that is not finite, or two values of one name.
pub fn write<'a>(experiments: impl IntoIterator<Item = (&'a str, &'a [NamedValue])>) -> Result<String, ValuesError> {
    let mut order: Vec<_> = experiments.into_iter().collect();
    order.sort_by_key(|(id, _)| *id);
    let mut text = HEAD.to_owned();
    let mut seen = std::collections::BTreeSet::new();
    for (id, values) in order {
        for value in values {
            let NamedValue { name, value, unit, meaning, route, error } = value;
            let full = || format!("{id}/{name}");
            for (what, number) in [("value", *value), ("error", *error)] {
                if !number.is_finite() {
                    return Err(ValuesError::NotFinite { name: full(), what, number });
                }
            }
            if !seen.insert((id, name)) {
                return Err(ValuesError::Twice { name: full() });
            }
            text.push_str(&format!("\n[{}.{}]\n", key(id), key(name)));
            text.push_str(&format!("value = {}\nunit = {}\n", significant(*value, 17), quoted(unit)));
            // Always with an exponent, so that a whole number stays a float.
            text.push_str(&format!("route = {}\nerror = {error:e}\n", quoted(route)));
            text.push_str(&format!("meaning = {}\n", quoted(meaning)));
        }
    }
    Ok(text)
}

/// Reads the file back.
///
/// # Errors
/// A text of another form.
pub fn parse(text: &str) -> Result<Values, ValuesError> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Entry {
        value: f64,
        unit: String,
        route: String,
        error: f64,
        meaning: String,
    }
    let file: BTreeMap<String, BTreeMap<String, Entry>> =
        toml::from_str(text).map_err(|error| ValuesError::Form { message: error.to_string() })?;
    let named = |(name, entry): (String, Entry)| {
        let Entry { value, unit, route, error, meaning } = entry;
        (name.clone(), NamedValue { name, value, unit, meaning, route, error })
    };
    Ok(file.into_iter().map(|(id, entries)| (id, entries.into_iter().map(named).collect())).collect())
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn key(name: &str) -> String {
    let bare = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    if bare { name.to_owned() } else { quoted(name) }
}

/// A named value that changed between two runs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// The name with its experiment: `fig4/k1`.
    pub name: String,
    /// What it was, if it was there.
    pub old: Option<f64>,
    /// What it is, if it is there.
    pub new: Option<f64>,
}

impl fmt::Display for Change {
    /// Both numbers with enough digits to see the difference: `fig4/k1: 1.06063… → 1.06071…`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const FEWEST: usize = 6;
        let digits = match (self.old, self.new) {
            (Some(old), Some(new)) => {
                (FEWEST..17).find(|digits| significant(old, *digits) != significant(new, *digits)).unwrap_or(17)
            }
            _ => 17,
        };
        let cut = if digits < 17 { "…" } else { "" };
        let side = |x: Option<f64>| x.map_or("nothing".to_owned(), |x| format!("{}{cut}", significant(x, digits)));
        write!(f, "{}: {} → {}", self.name, side(self.old), side(self.new))
    }
}

/// The values whose bits differ, in order of their names; those that came or went among them.
pub fn changes(old: &Values, new: &Values) -> Vec<Change> {
    let flat = |values: &Values| -> BTreeMap<String, f64> {
        let named = |id: &String, value: &NamedValue| (format!("{id}/{}", value.name), value.value);
        values.iter().flat_map(|(id, values)| values.values().map(move |value| named(id, value))).collect()
    };
    let (old, new) = (flat(old), flat(new));
    let names: std::collections::BTreeSet<&String> = old.keys().chain(new.keys()).collect();
    let change =
        |name: &String| Change { name: name.clone(), old: old.get(name).copied(), new: new.get(name).copied() };
    let differs = |change: &Change| change.old.map(f64::to_bits) != change.new.map(f64::to_bits);
    names.into_iter().map(change).filter(differs).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(name: &str, value: f64) -> NamedValue {
        NamedValue {
            name: name.to_owned(),
            value,
            unit: "1".to_owned(),
            meaning: "a \"switch\" point\\, φ".to_owned(),
            route: "closed form".to_owned(),
            error: 3e-15,
        }
    }

    #[test]
    fn written_text_reads_back_to_the_same_bits() {
        let fig4 = [value("k3", 1.0 / 3.0), value("k1", 1.0606601717798212), value("odd name", -0.0)];
        let fig1 = [value("tau", 1e-9)];
        let text = write([("fig4", &fig4[..]), ("fig1", &fig1[..])]).expect("writes");
        let expected =
            "\n[fig4.k3]\nvalue = 0.33333333333333331\nunit = \"1\"\nroute = \"closed form\"\nerror = 3e-15\n";
        assert!(text.contains(expected), "{text}");
        assert!(text.find("fig1.tau") < text.find("fig4.k3") && text.find("fig4.k3") < text.find("fig4.k1"), "{text}");
        let back = parse(&text).expect("reads");
        for value in &fig4 {
            assert_eq!(&back["fig4"][&value.name], value);
            assert_eq!(back["fig4"][&value.name].value.to_bits(), value.value.to_bits());
        }
        assert_eq!(back["fig1"]["tau"], fig1[0]);
    }

    #[test]
    fn whole_errors_stay_floats() {
        for error in [0.0, 1.0, 100.0] {
            let one = [NamedValue { error, ..value("x", 2.0) }];
            let text = write([("e", &one[..])]).expect("writes");
            assert_eq!(parse(&text).map(|values| values["e"]["x"].error), Ok(error), "{text}");
        }
    }

    #[test]
    fn what_is_refused() {
        let bad = [value("x", f64::NAN)];
        assert!(matches!(write([("e", &bad[..])]), Err(ValuesError::NotFinite { what: "value", .. })));
        let twice = [value("x", 1.0), value("x", 1.0)];
        assert_eq!(write([("e", &twice[..])]), Err(ValuesError::Twice { name: "e/x".to_owned() }));
        assert!(matches!(parse("[a]\nb = 1"), Err(ValuesError::Form { .. })));
    }

    #[test]
    fn changes_show_where_the_digits_part() {
        let values = |k1: f64, name: &str| {
            let list = [value("k1", k1), value(name, 1.0)];
            parse(&write([("fig4", &list[..])]).expect("writes")).expect("reads")
        };
        let shown =
            |old: &Values, new: &Values| -> Vec<String> { changes(old, new).iter().map(Change::to_string).collect() };
        let old = values(1.0606601717798212, "k2");
        assert_eq!(shown(&old, &old), Vec::<String>::new());
        assert_eq!(shown(&old, &values(1.0607, "k2")), ["fig4/k1: 1.06066… → 1.06070…"]);
        let last_bit = values(1.0606601717798214, "k2");
        assert_eq!(shown(&old, &last_bit), ["fig4/k1: 1.0606601717798212 → 1.0606601717798214"]);
        let other = shown(&old, &values(1.0606601717798212, "k3"));
        assert_eq!(other, ["fig4/k2: 1.0000000000000000 → nothing", "fig4/k3: nothing → 1.0000000000000000"]);
    }
}
