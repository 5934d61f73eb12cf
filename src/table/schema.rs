//! One column: name, unit, meaning and typed values.

/// The values of a column.
///
/// Equality is that of the numbers; the logical digest is what tells `0.0` from `-0.0` and one NaN from another.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Floats.
    F64(Vec<f64>),
    /// Integers.
    I64(Vec<i64>),
    /// Booleans.
    Bool(Vec<bool>),
    /// Texts.
    Text(Vec<String>),
}

impl Data {
    /// The number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::I64(values) => values.len(),
            Self::Bool(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    /// Whether there are no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The name of the type, as it stands in schemas: `f64`, `i64`, `bool`, `text`.
    pub fn type_name(&self) -> &'static str {
        match self {
            Self::F64(_) => "f64",
            Self::I64(_) => "i64",
            Self::Bool(_) => "bool",
            Self::Text(_) => "text",
        }
    }

    /// The row and value of the first number that is not finite.
    pub fn first_not_finite(&self) -> Option<(usize, f64)> {
        match self {
            Self::F64(values) => values.iter().copied().enumerate().find(|(_, x)| !x.is_finite()),
            _ => None,
        }
    }

    /// The value in a row as text: floats in the shortest form that reads back to the same bits, a NaN as nothing.
    ///
    /// An empty text where there is no such row.
    pub fn cell(&self, row: usize) -> String {
        match self {
            Self::F64(values) => values.get(row).filter(|x| !x.is_nan()).map(|x| format!("{x:?}")),
            Self::I64(values) => values.get(row).map(i64::to_string),
            Self::Bool(values) => values.get(row).map(bool::to_string),
            Self::Text(values) => values.get(row).cloned(),
        }
        .unwrap_or_default()
    }
}

impl From<Vec<f64>> for Data {
    fn from(values: Vec<f64>) -> Self {
        Self::F64(values)
    }
}

impl From<&[f64]> for Data {
    fn from(values: &[f64]) -> Self {
        Self::F64(values.to_vec())
    }
}

impl From<Vec<i64>> for Data {
    fn from(values: Vec<i64>) -> Self {
        Self::I64(values)
    }
}

impl From<Vec<bool>> for Data {
    fn from(values: Vec<bool>) -> Self {
        Self::Bool(values)
    }
}

impl From<Vec<String>> for Data {
    fn from(values: Vec<String>) -> Self {
        Self::Text(values)
    }
}

impl From<Vec<&str>> for Data {
    fn from(values: Vec<&str>) -> Self {
        Self::Text(values.into_iter().map(str::to_owned).collect())
    }
}

/// A column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The name, unique in its table: `p_theta`.
    pub name: String,
    /// The unit: `rad`, `1`, `length`; empty where it is not known (files from elsewhere).
    pub unit: String,
    /// What it is, in a few words.
    pub meaning: String,
    /// Whether numbers that are not finite are allowed: a NaN is a value that does not exist.
    pub gaps: bool,
    /// The values.
    pub data: Data,
}
