//! The table and its builder: every table in the program has passed the checks here.

use super::error::TableError;
use super::schema::{Column, Data};

/// A table: a name, a meaning and checked columns.
///
/// Guaranteed: at least one column, unique names, equal lengths, no NaN and no infinity outside columns with gaps.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    name: String,
    meaning: String,
    columns: Vec<Column>,
}

/// A table in the making.
#[derive(Clone, Debug)]
pub struct Builder {
    table: Table,
}

impl Builder {
    /// Adds a column of values that all exist.
    #[must_use]
    pub fn column(
        self,
        name: impl Into<String>,
        unit: impl Into<String>,
        meaning: impl Into<String>,
        values: impl Into<Data>,
    ) -> Self {
        let (name, unit, meaning) = (name.into(), unit.into(), meaning.into());
        self.push(Column { name, unit, meaning, gaps: false, data: values.into() })
    }

    /// Adds a column in which NaN stands for a value that does not exist; infinities are allowed too.
    #[must_use]
    pub fn column_with_gaps(
        self,
        name: impl Into<String>,
        unit: impl Into<String>,
        meaning: impl Into<String>,
        values: impl Into<Data>,
    ) -> Self {
        let (name, unit, meaning) = (name.into(), unit.into(), meaning.into());
        self.push(Column { name, unit, meaning, gaps: true, data: values.into() })
    }

    /// Adds a column that is there already, such as one of another table.
    #[must_use]
    pub fn push(mut self, column: Column) -> Self {
        self.table.columns.push(column);
        self
    }

    /// Checks everything and gives the table.
    ///
    /// # Errors
    /// No column at all, columns of different lengths or of the same name, numbers that are not finite in a column
    /// without gaps.
    pub fn build(self) -> Result<Table, TableError> {
        let table = self.table;
        let Some(first) = table.columns.first() else {
            return Err(TableError::NoColumns { table: table.name });
        };
        let expected = first.data.len();
        for (index, column) in table.columns.iter().enumerate() {
            let (name, found) = (column.name.clone(), column.data.len());
            if table.columns[..index].iter().any(|earlier| earlier.name == name) {
                return Err(TableError::DuplicateColumn { table: table.name, column: name });
            }
            if found != expected {
                return Err(TableError::UnequalLengths { table: table.name, column: name, expected, found });
            }
            if let (false, Some((row, value))) = (column.gaps, column.data.first_not_finite()) {
                return Err(TableError::NotFinite { table: table.name, column: name, row, value });
            }
        }
        Ok(table)
    }
}

impl Table {
    /// Starts a table.
    pub fn builder(name: impl Into<String>, meaning: impl Into<String>) -> Builder {
        Builder { table: Self { name: name.into(), meaning: meaning.into(), columns: Vec::new() } }
    }

    /// Starts a table with all columns of this one, to add more to them.
    pub fn to_builder(&self) -> Builder {
        Builder { table: self.clone() }
    }

    /// The name: `conjugate-locus`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What the table holds, in one sentence.
    pub fn meaning(&self) -> &str {
        &self.meaning
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.data.len())
    }

    /// Whether there is a column of that name.
    pub fn has(&self, column: &str) -> bool {
        self.columns.iter().any(|c| c.name == column)
    }

    /// The column of that name.
    ///
    /// # Errors
    /// No such column.
    pub fn column(&self, name: &str) -> Result<&Column, TableError> {
        self.columns.iter().find(|column| column.name == name).ok_or_else(|| TableError::NoSuchColumn {
            table: self.name.clone(),
            column: name.to_owned(),
            known: self.columns.iter().map(|column| column.name.clone()).collect(),
        })
    }

    fn wrong_type(&self, column: &Column, expected: &'static str) -> TableError {
        let (table, name, found) = (self.name.clone(), column.name.clone(), column.data.type_name());
        TableError::WrongType { table, column: name, expected, found }
    }

    /// The values of a column of floats.
    ///
    /// # Errors
    /// No such column, or one of another type.
    pub fn f64s(&self, name: &str) -> Result<&[f64], TableError> {
        let column = self.column(name)?;
        let Data::F64(values) = &column.data else { return Err(self.wrong_type(column, "f64")) };
        Ok(values)
    }

    /// The values of a column of integers.
    ///
    /// # Errors
    /// No such column, or one of another type.
    pub fn ints(&self, name: &str) -> Result<&[i64], TableError> {
        let column = self.column(name)?;
        let Data::I64(values) = &column.data else { return Err(self.wrong_type(column, "i64")) };
        Ok(values)
    }

    /// The values of a column of booleans.
    ///
    /// # Errors
    /// No such column, or one of another type.
    pub fn bools(&self, name: &str) -> Result<&[bool], TableError> {
        let column = self.column(name)?;
        let Data::Bool(values) = &column.data else { return Err(self.wrong_type(column, "bool")) };
        Ok(values)
    }

    /// The values of a column of texts.
    ///
    /// # Errors
    /// No such column, or one of another type.
    pub fn texts(&self, name: &str) -> Result<&[String], TableError> {
        let column = self.column(name)?;
        let Data::Text(values) = &column.data else { return Err(self.wrong_type(column, "text")) };
        Ok(values)
    }

    /// The values of a column of floats or integers as floats: for tables from elsewhere, where `1` may stand for `1.0`.
    ///
    /// # Errors
    /// No such column, or one of another type; an integer beyond 2⁵³ in size, which a float does not hold exactly.
    pub fn numbers(&self, name: &str) -> Result<Vec<f64>, TableError> {
        const EXACT: u64 = 1 << f64::MANTISSA_DIGITS;
        let column = self.column(name)?;
        match &column.data {
            Data::F64(values) => Ok(values.clone()),
            Data::I64(values) if values.iter().all(|x| x.unsigned_abs() <= EXACT) => {
                Ok(values.iter().map(|x| *x as f64).collect())
            }
            _ => Err(self.wrong_type(column, "numbers that a float can hold")),
        }
    }

    /// The one value of a column of floats in the first row whose text column `key` reads `value`: a named number.
    ///
    /// # Errors
    /// No such columns, or no such row.
    pub fn lookup(&self, key: &str, value: &str, wanted: &str) -> Result<f64, TableError> {
        let row = self.row_of_text(key, value)?;
        Ok(self.f64s(wanted)?[row])
    }

    /// The first row in which a column of texts reads `value`.
    ///
    /// # Errors
    /// No such column, or no such row.
    pub fn row_of_text(&self, column: &str, value: &str) -> Result<usize, TableError> {
        self.texts(column)?.iter().position(|text| text == value).ok_or_else(|| self.no_such_row(column, value))
    }

    /// The first row in which a column of floats equals `value`.
    ///
    /// # Errors
    /// No such column, or no such row.
    pub fn row_of(&self, column: &str, value: f64) -> Result<usize, TableError> {
        let found = self.f64s(column)?.iter().position(|x| *x == value);
        found.ok_or_else(|| self.no_such_row(column, &format!("{value:?}")))
    }

    /// The table with those rows only for which `keep` says so, in their order; same name and schema.
    #[must_use]
    pub fn filter(&self, keep: impl Fn(usize) -> bool) -> Self {
        fn kept<T: Clone>(values: &[T], keep: &impl Fn(usize) -> bool) -> Vec<T> {
            values.iter().enumerate().filter(|(row, _)| keep(*row)).map(|(_, value)| value.clone()).collect()
        }
        let mut table = self.clone();
        for column in &mut table.columns {
            column.data = match &column.data {
                Data::F64(values) => Data::F64(kept(values, &keep)),
                Data::I64(values) => Data::I64(kept(values, &keep)),
                Data::Bool(values) => Data::Bool(kept(values, &keep)),
                Data::Text(values) => Data::Text(kept(values, &keep)),
            };
        }
        table
    }

    fn no_such_row(&self, column: &str, value: &str) -> TableError {
        TableError::NoSuchRow { table: self.name.clone(), column: column.to_owned(), value: value.to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_rows() -> Builder {
        Table::builder("t", "a test").column("x", "rad", "an angle", vec![1.0, 2.0]).column(
            "name",
            "",
            "a name",
            vec!["a", "b"],
        )
    }

    #[test]
    fn columns_are_found_by_name_and_type() {
        let table = two_rows().build().expect("a good table");
        assert_eq!(table.rows(), 2);
        assert_eq!(table.f64s("x"), Ok(&[1.0, 2.0][..]));
        assert_eq!(table.lookup("name", "b", "x"), Ok(2.0));
        assert_eq!(table.row_of("x", 1.0), Ok(0));
        assert!(matches!(table.lookup("name", "c", "x"), Err(TableError::NoSuchRow { .. })));
        assert!(matches!(table.ints("x"), Err(TableError::WrongType { expected: "i64", found: "f64", .. })));
        let Err(TableError::NoSuchColumn { known, .. }) = table.f64s("y") else { panic!("y is not there") };
        assert_eq!(known, ["x", "name"]);
        assert_eq!(table.filter(|row| row == 1).texts("name"), Ok(&["b".to_owned()][..]));
    }

    #[test]
    fn a_table_is_refused_for_each_of_its_rules() {
        let empty = Table::builder("t", "").build();
        assert!(matches!(empty, Err(TableError::NoColumns { .. })));
        let short = two_rows().column("y", "1", "", vec![1.0]).build();
        assert!(matches!(short, Err(TableError::UnequalLengths { expected: 2, found: 1, .. })));
        let twice = two_rows().column("x", "1", "", vec![1.0, 2.0]).build();
        assert!(matches!(twice, Err(TableError::DuplicateColumn { .. })));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let result = two_rows().column("y", "1", "", vec![0.0, bad]).build();
            assert!(matches!(result, Err(TableError::NotFinite { row: 1, .. })), "{bad}");
            assert!(two_rows().column_with_gaps("y", "1", "", vec![0.0, bad]).build().is_ok(), "{bad}");
        }
    }

    #[test]
    fn integers_count_as_numbers_as_long_as_a_float_holds_them() {
        let table = |x: i64| Table::builder("t", "").column("n", "1", "", vec![x]).build().expect("a good table");
        assert_eq!(table(1 << 53).numbers("n"), Ok(vec![9007199254740992.0]));
        assert!(table((1 << 53) + 1).numbers("n").is_err());
    }
}
