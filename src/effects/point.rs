//! One first conjugate point from named inputs: what the command's `point` answers, and its tables row by row.
//!
//! Each metric reads exactly the keys of its row in [`Metric::keys`]; anything else is refused by name. The answer names its
//! route, its own estimate of the relative error of `t1`, and the work done.

use crate::contract::accuracy::ARTICLE;
use crate::contract::work::Work;
use std::collections::BTreeMap;

mod reference;
mod rotation_group;
mod serret_andoyer;
mod spin;

/// A metric that points are asked of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// The Serret-Andoyer metric.
    SerretAndoyer,
    /// The almost-Riemannian metric of the three coupled spins.
    Spin,
    /// Left-invariant metrics on SO(3).
    RotationGroup,
}

impl Metric {
    /// All metrics.
    pub const ALL: [Self; 3] = [Self::SerretAndoyer, Self::Spin, Self::RotationGroup];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::SerretAndoyer => "serret-andoyer",
            Self::Spin => "spin",
            Self::RotationGroup => "rotation-group",
        }
    }

    /// The keys it accepts.
    pub fn keys(self) -> &'static [&'static str] {
        match self {
            Self::SerretAndoyer => &["A", "B", "C", "y0", "p_x", "p_y", "phi0", "p_theta", "delta", "branch"],
            Self::Spin => &["k", "p_theta"],
            Self::RotationGroup => &["A", "B", "C", "H1", "H2", "H3", "Phi1", "Phi2", "Phi3", "p1", "p2", "p3"],
        }
    }

    /// The numbers it answers with, in order, with unit and meaning.
    pub fn answers(self) -> &'static [(&'static str, &'static str, &'static str)] {
        match self {
            Self::SerretAndoyer => &[
                ("t1", "time", "first conjugate time"),
                ("x", "rad", "x at the conjugate point"),
                ("y", "rad", "y at the conjugate point, on the universal cover"),
                ("theta", "rad", "theta = x at the conjugate point"),
                ("phi", "length", "Darboux angle from the equator at the conjugate point"),
                ("t1_lower_bound", "time", "half period 2K/M, the lower bound of Theorem 3.9"),
            ],
            Self::Spin => &[
                ("t1", "time", "first conjugate time"),
                ("theta", "rad", "longitude of the conjugate point, in (-pi, pi]"),
                ("phi", "rad", "angle from the pole of the conjugate point"),
                ("r1", "1", "conjugate point in R^3"),
                ("r2", "1", "conjugate point in R^3"),
                ("r3", "1", "conjugate point in R^3"),
            ],
            Self::RotationGroup => &[
                ("t1", "time", "first conjugate time"),
                ("t2", "time", "second conjugate time, counted with multiplicity"),
            ],
        }
    }
}

/// A given input: a number, or a word such as `ascending`.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

impl Given {
    /// A number where the text is one, else a word.
    pub fn parse(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Word(text.to_owned()), Self::Number)
    }
}

/// Inputs by key.
pub type Inputs = BTreeMap<String, Given>;

/// Why inputs are refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PointError {
    /// A key that the metric does not read.
    #[error("{metric} has no key {key:?}; it reads {accepted}")]
    UnknownKey {
        /// The metric.
        metric: &'static str,
        /// The key.
        key: String,
        /// The keys it reads.
        accepted: String,
    },
    /// A key that is needed and not given.
    #[error("{metric}: {key} is missing; {accepted}")]
    Missing {
        /// The metric.
        metric: &'static str,
        /// The key.
        key: &'static str,
        /// What makes a start.
        accepted: &'static str,
    },
    /// Keys that say the same thing twice.
    #[error("{metric}: {first} and {second} can't both be given; {accepted}")]
    Conflict {
        /// The metric.
        metric: &'static str,
        /// One key.
        first: &'static str,
        /// The other key.
        second: &'static str,
        /// What makes a start.
        accepted: &'static str,
    },
    /// A value of the wrong kind.
    #[error("{key} = {found} is not accepted: {accepted}")]
    Value {
        /// The key.
        key: String,
        /// What was found.
        found: String,
        /// What is accepted.
        accepted: String,
    },
    /// A start that the metric refuses.
    #[error("{0}")]
    Refused(String),
    /// A computation that failed.
    #[error("{0}")]
    Failed(String),
}

/// An answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The numbers, in the order of [`Metric::answers`]; absent where there is no conjugate point.
    pub numbers: Vec<Option<f64>>,
    /// Why there is no conjugate point, where there is none.
    pub reason: Option<String>,
    /// An estimate of the relative error of `t1`.
    pub error: Option<f64>,
    /// How it was computed.
    pub route: String,
    /// What it took.
    pub work: Work,
}

/// The first conjugate point for the given inputs; `relative_error` is what is asked for where a route integrates. Below that of `article` all is
/// computed in double-double arithmetic and rounded: the route says so.
///
/// # Errors
/// Inputs that are unknown, missing, of the wrong kind or out of range; a computation that failed.
pub fn answer(metric: Metric, given: &Inputs, relative_error: f64) -> Result<Answer, PointError> {
    let reader = Reader::new(metric, given)?;
    if relative_error < ARTICLE {
        return reference::answer(&reader);
    }
    match metric {
        Metric::SerretAndoyer => serret_andoyer::answer(&reader),
        Metric::Spin => spin::answer(&reader),
        Metric::RotationGroup => rotation_group::answer(&reader, relative_error),
    }
}

/// The answers of [`answer`] to many rows, in their order and with the same bits: closed forms run in lanes.
pub fn answers(metric: Metric, rows: &[Inputs], relative_error: f64) -> Vec<Result<Answer, PointError>> {
    let readers: Vec<Result<Reader<'_>, PointError>> = rows.iter().map(|given| Reader::new(metric, given)).collect();
    let good: Vec<Reader<'_>> = readers.iter().filter_map(|reader| reader.as_ref().ok()).copied().collect();
    let answers = match metric {
        _ if relative_error < ARTICLE => good.iter().map(|reader| reference::answer(reader)).collect(),
        Metric::SerretAndoyer => serret_andoyer::answers(&good),
        Metric::Spin => spin::answers(&good),
        Metric::RotationGroup => good.iter().map(|reader| rotation_group::answer(reader, relative_error)).collect(),
    };
    in_place(readers, answers)
}

/// Reads starts, solves the good ones together, and tells each.
fn in_lanes<T, P>(
    readers: &[Reader<'_>],
    read: impl Fn(&Reader<'_>) -> Result<T, PointError>,
    solve: impl Fn(&[T]) -> Vec<P>,
    told: impl Fn(P) -> Result<Answer, PointError>,
) -> Vec<Result<Answer, PointError>> {
    let (mut starts, mut places) = (Vec::with_capacity(readers.len()), Vec::with_capacity(readers.len()));
    for reader in readers {
        places.push(read(reader).map(|start| starts.push(start)));
    }
    in_place(places, solve(&starts).into_iter().map(told).collect())
}

/// Puts answers, one for each `Ok` and in their order, in the places of these.
fn in_place<T>(
    places: Vec<Result<T, PointError>>,
    answers: Vec<Result<Answer, PointError>>,
) -> Vec<Result<Answer, PointError>> {
    let mut answers = answers.into_iter();
    let none = || Err(PointError::Failed("a start was left without an answer: please report this input".into()));
    places.into_iter().map(|place| place.and_then(|_| answers.next().unwrap_or_else(none))).collect()
}

/// Reads inputs by key.
#[derive(Clone, Copy)]
struct Reader<'a> {
    metric: Metric,
    given: &'a Inputs,
}

impl<'a> Reader<'a> {
    fn new(metric: Metric, given: &'a Inputs) -> Result<Self, PointError> {
        match given.keys().find(|key| !metric.keys().contains(&key.as_str())) {
            Some(key) => Err(PointError::UnknownKey {
                metric: metric.name(),
                key: key.clone(),
                accepted: metric.keys().join(", "),
            }),
            None => Ok(Reader { metric, given }),
        }
    }

    fn has(&self, key: &str) -> bool {
        self.given.contains_key(key)
    }

    fn number(&self, key: &'static str, accepted: &'static str) -> Result<f64, PointError> {
        match self.given.get(key) {
            None => Err(PointError::Missing { metric: self.metric.name(), key, accepted }),
            Some(Given::Number(number)) if number.is_finite() => Ok(*number),
            Some(other) => Err(PointError::Value {
                key: key.to_owned(),
                found: match other {
                    Given::Number(number) => format!("{number}"),
                    Given::Word(word) => format!("{word:?}"),
                },
                accepted: "a finite number".to_owned(),
            }),
        }
    }

    fn exclusive(&self, first: &'static str, second: &'static str, accepted: &'static str) -> Result<(), PointError> {
        if self.has(first) && self.has(second) {
            return Err(PointError::Conflict { metric: self.metric.name(), first, second, accepted });
        }
        Ok(())
    }
}
