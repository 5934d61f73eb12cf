//! Tables to and from CSV: a header row of names, then one line a row.
//!
//! CSV carries neither units nor types. Reading infers the type of each column from all of its cells; writing uses the
//! shortest decimal that reads back to the same bits, always with a point or an exponent, so floats stay floats.

use super::build::Table;
use super::error::TableError;
use super::parquet::foreign;
use super::schema::Data;

fn failed(error: &::csv::Error) -> TableError {
    TableError::Csv { line: error.position().map_or(0, ::csv::Position::line), message: error.to_string() }
}

impl Table {
    /// Reads a table from CSV text with a header row.
    ///
    /// A column is of integers when every cell is a plain integer; of floats when every cell is a number, `NaN`, `inf`,
    /// `-inf` or empty (a gap) and at least one is a number; of booleans when every cell is `true` or `false`; else of
    /// texts, kept as they are. Cells such as `007` are texts, since a number would not give them back; `-0` is a float.
    ///
    /// # Errors
    /// No header, two columns of one name, rows of different lengths.
    pub fn from_csv(text: &str) -> Result<Self, TableError> {
        // Spreadsheets begin their files with a byte-order mark; it is no part of the first name.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = ::csv::ReaderBuilder::new().trim(::csv::Trim::All).from_reader(text.as_bytes());
        let names: Vec<String> = reader.headers().map_err(|e| failed(&e))?.iter().map(str::to_owned).collect();
        let mut cells: Vec<Vec<String>> = vec![Vec::new(); names.len()];
        for record in reader.records() {
            let record = record.map_err(|e| failed(&e))?;
            cells.iter_mut().zip(&record).for_each(|(column, cell)| column.push(cell.to_owned()));
        }
        let columns = names.into_iter().zip(cells.into_iter().map(inferred));
        columns.fold(Self::builder("", ""), foreign).build()
    }

    /// The table as CSV text: names in the first line, gaps as empty cells.
    ///
    /// # Errors
    /// Whatever the writer reports.
    pub fn to_csv(&self) -> Result<String, TableError> {
        let mut writer = ::csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns().iter().map(|column| column.name.as_str())).map_err(|e| failed(&e))?;
        for row in 0..self.rows() {
            writer.write_record(self.columns().iter().map(|column| column.data.cell(row))).map_err(|e| failed(&e))?;
        }
        let unwritten = |message: String| TableError::Csv { line: 0, message };
        let bytes = writer.into_inner().map_err(|error| unwritten(error.to_string()))?;
        String::from_utf8(bytes).map_err(|error| unwritten(error.to_string()))
    }
}

fn inferred(cells: Vec<String>) -> Data {
    let all = |good: fn(&str) -> bool| cells.iter().all(|cell| good(cell));
    if !cells.is_empty() && all(|cell| integer(cell).is_some()) {
        return Data::I64(cells.iter().filter_map(|cell| integer(cell)).collect());
    }
    if !cells.is_empty() && all(|cell| matches!(cell, "true" | "false")) {
        return Data::Bool(cells.iter().map(|cell| cell == "true").collect());
    }
    let some_number = cells.is_empty() || cells.iter().any(|cell| !cell.is_empty());
    if some_number && all(|cell| cell.is_empty() || float(cell).is_some()) {
        return Data::F64(cells.iter().map(|cell| float(cell).unwrap_or(f64::NAN)).collect());
    }
    Data::Text(cells)
}

/// A plain integer: one that is written back in the same way.
fn integer(cell: &str) -> Option<i64> {
    cell.parse::<i64>().ok().filter(|x| x.to_string() == cell)
}

/// A number, or a name of one that is not finite. Zeros in front of digits are refused.
fn float(cell: &str) -> Option<f64> {
    let digits = cell.strip_prefix(['-', '+']).unwrap_or(cell).as_bytes();
    if digits.first() == Some(&b'0') && digits.get(1).is_some_and(u8::is_ascii_digit) {
        return None;
    }
    cell.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_inferred_from_all_cells() {
        let text = "A,n,name,ok,t1,id\n1.5,1,x,true,3.0,007\n2,2,\"y, z\",false,,008\n";
        let table = Table::from_csv(text).expect("good CSV");
        assert_eq!(table.f64s("A"), Ok(&[1.5, 2.0][..]));
        assert_eq!(table.ints("n"), Ok(&[1, 2][..]));
        assert_eq!(table.texts("name").map(|texts| texts[1].as_str()), Ok("y, z"));
        assert_eq!(table.bools("ok"), Ok(&[true, false][..]));
        let t1 = table.column("t1").expect("there");
        assert!(t1.gaps && t1.data.cell(1).is_empty());
        assert_eq!(table.texts("id").map(|texts| texts[0].as_str()), Ok("007"));
    }

    #[test]
    fn negative_zero_keeps_its_sign() {
        let table = Table::from_csv("p_theta\n-0\n1\n").expect("good CSV");
        assert_eq!(table.f64s("p_theta").map(|values| values[0].to_bits()), Ok((-0.0_f64).to_bits()));
    }

    #[test]
    fn floats_read_back_to_the_same_bits() {
        let values = vec![0.1, 1.0 / 3.0, 1e-300, -0.0, 5e-324, f64::MAX, 1e16, 0.30000000000000004, 1.0];
        let table = Table::builder("t", "").column("x", "1", "", values.clone()).build().expect("a good table");
        let text = table.to_csv().expect("writes");
        let back = Table::from_csv(&text).expect("reads");
        let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(back.f64s("x").map(bits), Ok(bits(&values)), "{text}");
    }

    #[test]
    fn errors_name_the_line() {
        let ragged = Table::from_csv("a,b\n1,2\n3\n");
        assert!(matches!(ragged, Err(TableError::Csv { line: 3, .. })), "{ragged:?}");
        assert!(matches!(Table::from_csv("a,a\n1,2\n"), Err(TableError::DuplicateColumn { .. })));
        assert!(matches!(Table::from_csv(""), Err(TableError::NoColumns { .. })));
        assert_eq!(Table::from_csv("\u{feff}a,b\n").map(|table| table.rows()), Ok(0));
    }
}
