//! Independent reference values, and how close the named values come to them.
//!
//! They stand in `tests/oracle/values.toml`, whose head explains the form, and are part of the program. A reference may
//! state leaves of the config that it belongs to; under an edited config it is not compared.

use crate::contract::config::leaves;
use crate::contract::manifest::Line;
use crate::contract::value::NamedValue;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The committed references.
const EMBEDDED: &str = include_str!("../../tests/oracle/values.toml");
/// The file they stand in, for messages.
const FILE: &str = "tests/oracle/values.toml";
/// Fewer significant digits than these do not judge the last bit of a float with certainty.
const FEWEST_DIGITS: usize = 20;

/// One reference value as it stands in the file.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    value: String,
    origin: String,
    tolerance: f64,
    #[serde(default)]
    config: toml::Table,
}

/// One reference value.
#[derive(Clone, Debug, PartialEq)]
struct Reference {
    decimal: String,
    nearest: f64,
    origin: String,
    tolerance: f64,
    config: Vec<Line>,
}

/// Reference values by experiment and name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct References {
    entries: BTreeMap<String, BTreeMap<String, Reference>>,
}

/// References that can't be read: a defect of the program, not of a user's files.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{FILE}: {message}")]
pub struct ReferenceError {
    /// What is wrong.
    pub message: String,
}

/// How a comparison with a reference ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Agreement {
    /// Within the tolerance.
    Agrees,
    /// Not within the tolerance.
    Differs,
    /// The experiment has no value of that name.
    NoSuchValue,
    /// The reference belongs to another config.
    NotComparable,
}

/// One named value beside its reference.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Compared {
    /// The name, with its experiment: `remark_3_25/t_star`.
    pub name: String,
    /// How it ended.
    pub agreement: Agreement,
    /// The value computed here, where there is one.
    pub ours: Option<f64>,
    /// The reference, as a decimal.
    pub reference: String,
    /// |ours − reference|/|reference|, or |ours| where the reference is 0.
    pub difference: Option<f64>,
    /// The number of floats from the one nearest to the reference to ours: 0 is correctly rounded.
    pub ulps: Option<u64>,
    /// What is accepted for `difference`.
    pub tolerance: f64,
    /// Where the reference comes from.
    pub origin: String,
}

impl References {
    /// The references that are part of the program.
    ///
    /// # Errors
    /// A malformed file, which a test excludes.
    pub fn embedded() -> Result<Self, ReferenceError> {
        Self::parse(EMBEDDED)
    }

    /// Reads references from the text of a file.
    ///
    /// # Errors
    /// A text of another form; a decimal that is no finite number or has fewer than 20 significant digits; a tolerance
    /// that is not positive.
    pub fn parse(text: &str) -> Result<Self, ReferenceError> {
        let wrong = |message: String| ReferenceError { message };
        let file: BTreeMap<String, BTreeMap<String, Entry>> =
            toml::from_str(text).map_err(|error| wrong(error.to_string()))?;
        let mut entries: BTreeMap<String, BTreeMap<String, Reference>> = BTreeMap::new();
        for (experiment, named) in file {
            for (name, entry) in named {
                let reference = checked(entry).map_err(|message| wrong(format!("{experiment}.{name}: {message}")))?;
                entries.entry(experiment.clone()).or_default().insert(name, reference);
            }
        }
        Ok(Self { entries })
    }

    /// Compares the named values of an experiment with the references that there are for it.
    ///
    /// `config` are the leaves of the experiment's config ([`leaves`]).
    pub fn compare(&self, experiment: &str, values: &[NamedValue], config: &[Line]) -> Vec<Compared> {
        let references = self.entries.get(experiment).into_iter().flatten();
        references
            .map(|(name, reference)| {
                let comparable = reference.config.iter().all(|line| config.contains(line));
                let ours = values.iter().find(|value| value.name == *name).map(|value| value.value);
                let difference = ours.map(|ours| difference(ours, reference.nearest));
                let agreement = match difference {
                    _ if !comparable => Agreement::NotComparable,
                    None => Agreement::NoSuchValue,
                    Some(difference) if difference <= reference.tolerance => Agreement::Agrees,
                    Some(_) => Agreement::Differs,
                };
                Compared {
                    name: format!("{experiment}/{name}"),
                    agreement,
                    ours,
                    reference: reference.decimal.clone(),
                    difference,
                    ulps: ours.map(|ours| ulps_between(ours, reference.nearest)),
                    tolerance: reference.tolerance,
                    origin: reference.origin.clone(),
                }
            })
            .collect()
    }
}

fn checked(entry: Entry) -> Result<Reference, String> {
    let Entry { value: decimal, origin, tolerance, config } = entry;
    let nearest = decimal.parse::<f64>().ok().filter(|x| x.is_finite());
    let nearest = nearest.ok_or_else(|| format!("{decimal:?} is no finite number"))?;
    let mantissa = decimal.split(['e', 'E']).next().unwrap_or("");
    let digits = mantissa.chars().filter(char::is_ascii_digit).skip_while(|digit| *digit == '0' && nearest != 0.0);
    if digits.count() < FEWEST_DIGITS {
        return Err(format!("{decimal:?} has fewer than {FEWEST_DIGITS} significant digits"));
    }
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(format!("tolerance {tolerance} is not positive"));
    }
    if origin.is_empty() {
        return Err("no origin".to_owned());
    }
    // Through the reader of configs, so that `2` and `2.0` are one leaf on both sides.
    let text = toml::to_string(&config).map_err(|error| error.to_string())?;
    let config = leaves(FILE, &text).map_err(|error| error.to_string())?;
    Ok(Reference { decimal, nearest, origin, tolerance, config })
}

fn difference(ours: f64, reference: f64) -> f64 {
    let absolute = (ours - reference).abs();
    if reference == 0.0 { absolute } else { absolute / reference.abs() }
}

/// The number of steps from one float to the next that lead from `a` to `b`; the largest number where one is a NaN.
fn ulps_between(a: f64, b: f64) -> u64 {
    // Floats in order, as integers in order: those with a sign go downwards from zero.
    let rank = |x: f64| {
        let magnitude = i128::from(x.abs().to_bits());
        if x.is_sign_negative() { -magnitude } else { magnitude }
    };
    if a.is_nan() || b.is_nan() {
        return u64::MAX;
    }
    u64::try_from((rank(a) - rank(b)).unsigned_abs()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(name: &str, value: f64) -> NamedValue {
        let (unit, meaning, route) = ("time".to_owned(), String::new(), String::new());
        NamedValue { name: name.to_owned(), value, unit, meaning, route, error: 0.0 }
    }

    fn config(text: &str) -> Vec<Line> {
        leaves("f", text).expect("TOML")
    }

    const T_STAR: f64 = 4.772_421_833_446_836;

    #[test]
    fn the_embedded_references_are_read() {
        let references = References::embedded().expect("well formed");
        let config =
            config("kind = \"remark_3_25\"\n[scene.metric.serret-andoyer]\nA = 1.5\nB = 2 # an integer\nC = 2.80\n");
        let next = T_STAR.next_up();
        let compared = references.compare("remark_3_25", &[value("t_star", next)], &config);
        let t_star = compared.iter().find(|c| c.name == "remark_3_25/t_star").expect("there");
        assert_eq!((t_star.agreement, t_star.ulps), (Agreement::Agrees, Some(1)));
        let theta_star = compared.iter().find(|c| c.name == "remark_3_25/theta_star").expect("there");
        assert_eq!((theta_star.agreement, theta_star.ours), (Agreement::NoSuchValue, None));
        assert!(references.compare("no_such_experiment", &[], &config).is_empty());
    }

    #[test]
    fn the_tolerance_and_the_config_decide() {
        let references = References::embedded().expect("well formed");
        let compare = |ours: f64, text: &str| {
            let compared = references.compare(
                "remark_3_25",
                &[value("t_star", ours)],
                &config(&format!("[scene.metric.serret-andoyer]\n{text}")),
            );
            compared.iter().find(|c| c.name == "remark_3_25/t_star").expect("there").agreement
        };
        let own = "A = 1.5\nB = 2.0\nC = 2.8\n";
        assert_eq!(compare(T_STAR * (1.0 + 2e-14), own), Agreement::Differs);
        assert_eq!(compare(f64::NAN, own), Agreement::Differs);
        assert_eq!(compare(T_STAR * (1.0 + 5e-15), own), Agreement::Agrees);
        assert_eq!(compare(T_STAR, "A = 1.5\nB = 2.0\nC = 2.9\n"), Agreement::NotComparable);
        assert_eq!(compare(T_STAR, "A = 1.5\n"), Agreement::NotComparable);
    }

    #[test]
    fn careless_references_are_refused() {
        let parse = |value: &str, origin: &str, tolerance: &str| {
            References::parse(&format!("[a.b]\nvalue = \"{value}\"\norigin = \"{origin}\"\ntolerance = {tolerance}\n"))
        };
        assert!(parse("0.00012345678901234567890", "x", "1e-14").is_ok());
        assert!(parse("-1.2345678901234567890e-5", "x", "1e-14").is_ok());
        assert!(parse("0.000123456789012345678", "x", "1e-14").is_err());
        assert!(parse("1.5", "x", "1e-14").is_err());
        assert!(parse("nan", "x", "1e-14").is_err());
        assert!(parse("1.2345678901234567890", "x", "0.0").is_err());
        assert!(parse("1.2345678901234567890", "", "1e-14").is_err());
    }

    #[test]
    fn floats_between() {
        assert_eq!(ulps_between(1.0, 1.0 + f64::EPSILON), 1);
        assert_eq!(ulps_between(0.0, -0.0), 0);
        assert_eq!(ulps_between(5e-324, -5e-324), 2);
        assert_eq!(ulps_between(f64::NAN, 1.0), u64::MAX);
    }
}
