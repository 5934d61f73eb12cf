//! What can go wrong with a table, as values with data.

/// A table that can't be built, read, written or looked into.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TableError {
    /// A table without a single column.
    #[error("table {table:?} has no columns")]
    NoColumns {
        /// The table.
        table: String,
    },
    /// Two columns of one name.
    #[error("table {table:?} has two columns named {column:?}")]
    DuplicateColumn {
        /// The table.
        table: String,
        /// The name.
        column: String,
    },
    /// A column whose length is not that of the first one.
    #[error("table {table:?}: column {column:?} has {found} rows, the first column has {expected}")]
    UnequalLengths {
        /// The table.
        table: String,
        /// The column.
        column: String,
        /// Rows of the first column.
        expected: usize,
        /// Rows of this one.
        found: usize,
    },
    /// A NaN or an infinity in a column whose schema does not allow it.
    #[error(
        "table {table:?}: column {column:?} holds {value} in row {row}; only columns built with gaps may hold numbers that are not finite"
    )]
    NotFinite {
        /// The table.
        table: String,
        /// The column.
        column: String,
        /// The first such row, counted from 0.
        row: usize,
        /// What stands there.
        value: f64,
    },
    /// A column that is not there.
    #[error("table {table:?} has no column {column:?}; it has {}", known.join(", "))]
    NoSuchColumn {
        /// The table.
        table: String,
        /// The name asked for.
        column: String,
        /// The names it has.
        known: Vec<String>,
    },
    /// A column of another type than asked for.
    #[error("table {table:?}: column {column:?} holds {found}, not {expected}")]
    WrongType {
        /// The table.
        table: String,
        /// The column.
        column: String,
        /// The type asked for.
        expected: &'static str,
        /// The type it has.
        found: &'static str,
    },
    /// A row that is not there.
    #[error("table {table:?} has no row whose {column} is {value}")]
    NoSuchRow {
        /// The table.
        table: String,
        /// The column searched.
        column: String,
        /// The value searched for.
        value: String,
    },
    /// A table that is not in the set.
    #[error("there is no table {name:?}; there are {}", known.join(", "))]
    NoSuchTable {
        /// The name asked for.
        name: String,
        /// The names in the set.
        known: Vec<String>,
    },
    /// Two tables of one name in a set.
    #[error("there are two tables named {name:?}")]
    DuplicateTable {
        /// The name.
        name: String,
    },
    /// A file that is no Parquet file, or one that can't be written.
    #[error("Parquet: {message}")]
    Parquet {
        /// What the encoder or decoder said.
        message: String,
    },
    /// A column of a Parquet file that is none of float, integer, boolean, text.
    #[error("column {column:?} is of type {found}; a table holds floats, integers, booleans and texts")]
    Unsupported {
        /// The column.
        column: String,
        /// Its type.
        found: String,
    },
    /// A missing value in a column of a Parquet file that is not of floats.
    #[error("column {column:?} has no value in row {row}; only columns of floats may have gaps")]
    Missing {
        /// The column.
        column: String,
        /// The first such row, counted from 0.
        row: usize,
    },
    /// A Parquet file whose footer and content do not belong together.
    #[error("the file's content does not fit its footer: {message}")]
    Corrupt {
        /// What does not fit.
        message: String,
    },
    /// A key of the footer that is the table's own.
    #[error(
        "footer key {key:?} is reserved: keys beginning with \"polhode.\" or \"ARROW:\" are written by the table itself"
    )]
    ReservedKey {
        /// The key.
        key: String,
    },
    /// A text that is no CSV table.
    #[error("CSV, line {line}: {message}")]
    Csv {
        /// The line, counted from 1; 0 when it is not known.
        line: u64,
        /// What is wrong.
        message: String,
    },
}
