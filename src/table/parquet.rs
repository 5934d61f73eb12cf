//! Tables to and from Parquet, with the schema's units and meanings in the footer.
//!
//! The bytes depend on the table and the footer entries alone: one chunk, fixed row groups, a fixed compression level, no
//! parallel encoding, no time, host or path. Bits survive, those of NaN payloads and of `-0.0` too.

use super::build::{Builder, Table};
use super::error::TableError;
use super::schema::{Column, Data};
use polars::polars_utils::compression::ZstdLevel;
use polars::prelude as pl;
use polars::prelude::{NamedFrom as _, SerReader as _};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Cursor;

/// Rows in a row group. Part of the bytes of every file: large enough for one group in nearly all tables.
const ROW_GROUP: usize = 1 << 18;
/// Level of compression. Part of the bytes of every file: zstd's own default.
const ZSTD_LEVEL: i32 = 3;

const NAME: &str = "polhode.name";
const MEANING: &str = "polhode.meaning";
const LOGICAL: &str = "polhode.logical";
const SCHEMA: &str = "polhode.schema";

/// A column's schema, as JSON in the footer.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct Described {
    name: String,
    unit: String,
    meaning: String,
    r#type: String,
    gaps: bool,
}

fn failed(error: impl std::fmt::Display) -> TableError {
    TableError::Parquet { message: error.to_string() }
}

fn hexadecimal(digest: &[u8; 32]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Runs the decoder, which panics on some damaged files, and makes an error of that.
///
/// Damage can also make it ask for absurd amounts of memory, which nothing catches: bytes of the store are verified by
/// their digest before they get here; only a user's own file can do this.
fn guarded<T>(decode: impl FnOnce() -> Result<T, TableError>) -> Result<T, TableError> {
    let damaged = || TableError::Parquet { message: "the file is damaged".to_owned() };
    // What a panic leaves half done is dropped here and never seen again.
    std::panic::catch_unwind(std::panic::AssertUnwindSafe(decode)).unwrap_or_else(|_| Err(damaged()))
}

impl Table {
    /// The table as the bytes of a Parquet file, with more footer entries in the order given.
    ///
    /// The table's own entries are `polhode.name`, `polhode.meaning`, `polhode.logical` (the logical digest, hexadecimal)
    /// and `polhode.schema` (a JSON list of name, unit, meaning, type and gaps).
    ///
    /// # Errors
    /// A footer key that is the table's own, or whatever the encoder reports.
    pub fn to_parquet(&self, footer: &[(String, String)]) -> Result<Vec<u8>, TableError> {
        if let Some((key, _)) = footer.iter().find(|(key, _)| key.starts_with("polhode.") || key.starts_with("ARROW:"))
        {
            return Err(TableError::ReservedKey { key: key.clone() });
        }
        let schema: Vec<Described> = self.columns().iter().map(described).collect();
        let mut entries = vec![
            (NAME.to_owned(), self.name().to_owned()),
            (MEANING.to_owned(), self.meaning().to_owned()),
            (LOGICAL.to_owned(), hexadecimal(&self.logical_digest())),
            (SCHEMA.to_owned(), serde_json::to_string(&schema).map_err(failed)?),
        ];
        entries.extend_from_slice(footer);

        let columns = self.columns().iter().map(encoded).collect();
        let mut frame = pl::DataFrame::new(self.rows(), columns).map_err(failed)?;
        // The chunk layout would show in the bytes.
        frame.rechunk_mut();
        let mut bytes = Vec::new();
        pl::ParquetWriter::new(&mut bytes)
            .with_compression(pl::ParquetCompression::Zstd(Some(ZstdLevel::try_new(ZSTD_LEVEL).map_err(failed)?)))
            .with_row_group_size(Some(ROW_GROUP))
            .with_key_value_metadata(Some(pl::KeyValueMetadata::from_static(entries)))
            .set_parallel(false)
            .finish(&mut frame)
            .map_err(failed)?;
        Ok(bytes)
    }

    /// Reads a table from the bytes of a Parquet file.
    ///
    /// A file written by [`Table::to_parquet`] gives back the same table, and its logical digest is checked. A file from
    /// elsewhere gives columns without units and meanings and a table without a name; floats and integers of other
    /// widths become `f64` and `i64`, missing floats become NaN.
    ///
    /// # Errors
    /// No Parquet file, columns of other types, missing values in columns that are not floats, a file whose content does
    /// not fit its footer.
    pub fn from_parquet(bytes: &[u8]) -> Result<Self, TableError> {
        let entries: BTreeMap<String, String> = footer(bytes)?.into_iter().collect();
        let frame = guarded(|| {
            let reader = pl::ParquetReader::new(Cursor::new(bytes)).read_parallel(pl::ParallelStrategy::None);
            reader.set_rechunk(true).finish().map_err(failed)
        })?;
        let schema = entries.get(SCHEMA).map(|text| serde_json::from_str::<Vec<Described>>(text)).transpose();
        let schema = schema.map_err(|error| TableError::Corrupt { message: error.to_string() })?;
        let entry = |key: &str| entries.get(key).cloned().unwrap_or_default();
        let mut builder = Self::builder(entry(NAME), entry(MEANING));
        match schema {
            None => {
                for column in frame.columns() {
                    builder = foreign(builder, decoded(column)?);
                }
                builder.build()
            }
            Some(schema) => {
                if schema.len() != frame.columns().len() {
                    return Err(TableError::Corrupt { message: "number of columns".to_owned() });
                }
                for (column, said) in frame.columns().iter().zip(schema) {
                    let Described { name, unit, meaning, gaps, .. } = said;
                    let column = Column { name, unit, meaning, gaps, data: decoded(column)?.1 };
                    builder = builder.push(column);
                }
                let table = builder.build()?;
                let (said, found) = (entry(LOGICAL), hexadecimal(&table.logical_digest()));
                if said == found {
                    Ok(table)
                } else {
                    Err(TableError::Corrupt { message: format!("logical digest {said} in the footer, {found} found") })
                }
            }
        }
    }
}

/// The footer's entries of a Parquet file, without the encoder's own.
///
/// # Errors
/// No Parquet file.
pub fn footer(bytes: &[u8]) -> Result<Vec<(String, String)>, TableError> {
    let mut reader = pl::ParquetReader::new(Cursor::new(bytes));
    let metadata = guarded(|| reader.get_metadata().cloned().map_err(failed))?;
    let entries = metadata.key_value_metadata().iter().flatten();
    Ok(entries
        .filter(|entry| !entry.key.starts_with("ARROW:"))
        .map(|entry| (entry.key.clone(), entry.value.clone().unwrap_or_default()))
        .collect())
}

fn described(column: &Column) -> Described {
    Described {
        name: column.name.clone(),
        unit: column.unit.clone(),
        meaning: column.meaning.clone(),
        r#type: column.data.type_name().to_owned(),
        gaps: column.gaps,
    }
}

fn encoded(column: &Column) -> pl::Column {
    let name = pl::PlSmallStr::from_str(&column.name);
    match &column.data {
        Data::F64(values) => pl::Series::new(name, values),
        Data::I64(values) => pl::Series::new(name, values),
        Data::Bool(values) => pl::Series::new(name, values),
        Data::Text(values) => pl::Series::new(name, values),
    }
    .into()
}

/// Name and values of a column; missing floats become NaN.
fn decoded(column: &pl::Column) -> Result<(String, Data), TableError> {
    use pl::DataType as Type;
    let name = column.name().to_string();
    let missing = |row| TableError::Missing { column: name.clone(), row };
    let whole = |wide: &pl::DataType| column.cast(wide).map_err(failed);
    let data = match column.dtype() {
        Type::Float64 | Type::Float32 => {
            let wide = whole(&Type::Float64)?;
            Data::F64(wide.f64().map_err(failed)?.iter().map(|x| x.unwrap_or(f64::NAN)).collect())
        }
        Type::Int8 | Type::Int16 | Type::Int32 | Type::Int64 | Type::UInt8 | Type::UInt16 | Type::UInt32 => {
            let wide = whole(&Type::Int64)?;
            let values = wide.i64().map_err(failed)?;
            Data::I64(
                values.iter().enumerate().map(|(row, x)| x.ok_or_else(|| missing(row))).collect::<Result<_, _>>()?,
            )
        }
        Type::Boolean => {
            let values = column.bool().map_err(failed)?;
            Data::Bool(
                values.iter().enumerate().map(|(row, x)| x.ok_or_else(|| missing(row))).collect::<Result<_, _>>()?,
            )
        }
        Type::String => {
            let values = column.str().map_err(failed)?;
            let text = |(row, x): (usize, Option<&str>)| x.map(str::to_owned).ok_or_else(|| missing(row));
            Data::Text(values.iter().enumerate().map(text).collect::<Result<_, _>>()?)
        }
        other => return Err(TableError::Unsupported { column: name, found: other.to_string() }),
    };
    Ok((name, data))
}

/// Adds a column of which only name and values are known: it has gaps when it turns out to.
pub(super) fn foreign(builder: Builder, (name, data): (String, Data)) -> Builder {
    let gaps = data.first_not_finite().is_some();
    builder.push(Column { name, unit: String::new(), meaning: String::new(), gaps, data })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Table {
        Table::builder("locus", "a curve with a gap")
            .column("k", "1", "parameter", vec![0.1, -0.0, 5e-324])
            .column_with_gaps(
                "t1",
                "time",
                "conjugate time",
                vec![1.0, f64::from_bits(0x7ff8_0000_dead_beef), f64::INFINITY],
            )
            .column("n", "1", "a count", vec![1_i64, i64::MIN, i64::MAX])
            .column("first", "", "a flag", vec![true, false, true])
            .column("kind", "", "größe, with \"quotes\"", vec!["a", "", "ψ0"])
            .build()
            .expect("a good table")
    }

    #[test]
    fn a_round_trip_keeps_schema_and_bits() {
        let table = sample();
        let bytes = table.to_parquet(&[("polhode-experiment".to_owned(), "fig7".to_owned())]).expect("writes");
        let back = Table::from_parquet(&bytes).expect("reads");
        assert_eq!(back.logical_digest(), table.logical_digest());
        assert_eq!(back.columns()[1].unit, "time");
        assert_eq!(back.meaning(), table.meaning());
        let entries = footer(&bytes).expect("reads");
        assert!(entries.contains(&("polhode-experiment".to_owned(), "fig7".to_owned())), "{entries:?}");
        assert!(entries.contains(&(LOGICAL.to_owned(), hexadecimal(&table.logical_digest()))));
    }

    /// Oracle: the number of threads and the moment of writing are not inputs, so the bytes are those of the first time;
    /// more than one row group, to cover the writer's loop.
    #[test]
    fn bytes_do_not_depend_on_threads() {
        let rows = ROW_GROUP + 1000;
        let values: Vec<f64> = (0..rows).map(|i| 1.0 / (1.0 + i as f64)).collect();
        let table = Table::builder("t", "").column("x", "1", "", values).build().expect("a good table");
        let first = table.to_parquet(&[]).expect("writes");
        let others: Vec<_> = std::thread::scope(|scope| {
            let writers: Vec<_> = (0..3).map(|_| scope.spawn(|| table.to_parquet(&[]).expect("writes"))).collect();
            writers.into_iter().map(|writer| writer.join().expect("no panic")).collect()
        });
        assert!(others.iter().all(|bytes| *bytes == first));
        assert_eq!(Table::from_parquet(&first).map(|t| t.logical_digest()), Ok(table.logical_digest()));
    }

    #[test]
    fn an_empty_table_is_a_table() {
        let table = Table::builder("t", "").column("x", "1", "", Vec::<f64>::new()).build().expect("a good table");
        let bytes = table.to_parquet(&[]).expect("writes");
        assert_eq!(Table::from_parquet(&bytes), Ok(table));
    }

    #[test]
    fn damage_and_reserved_keys_are_refused() {
        let table = sample();
        let bytes = table.to_parquet(&[]).expect("writes");
        assert!(matches!(Table::from_parquet(&bytes[..bytes.len() / 2]), Err(TableError::Parquet { .. })));
        assert!(matches!(Table::from_parquet(b""), Err(TableError::Parquet { .. })));
        assert!(matches!(footer(b"PAR1"), Err(TableError::Parquet { .. })));
        // A digit of the digest in the footer, changed in place: the content no longer fits it.
        let digest = hexadecimal(&table.logical_digest());
        let at = bytes.windows(64).position(|window| window == digest.as_bytes()).expect("stands in the footer");
        let mut hurt = bytes.clone();
        hurt[at] = if hurt[at] == b'0' { b'1' } else { b'0' };
        assert!(matches!(Table::from_parquet(&hurt), Err(TableError::Corrupt { .. })));
        // Flipped bits in pages, where the decoder itself panics.
        for at in [286, 424, 862, 922] {
            let mut hurt = bytes.clone();
            hurt[at] ^= 1;
            assert!(matches!(Table::from_parquet(&hurt), Err(TableError::Parquet { .. })), "{at}");
        }
        let own = table.to_parquet(&[(NAME.to_owned(), "x".to_owned())]);
        assert!(matches!(own, Err(TableError::ReservedKey { .. })));
    }

    /// Files from elsewhere: other widths, missing values, no schema of ours.
    #[test]
    fn foreign_files_are_read() {
        let columns = vec![
            pl::Series::new("A".into(), [Some(1.5_f32), None]).into(),
            pl::Series::new("n".into(), [7_u32, 8]).into(),
            pl::Series::new("id".into(), ["x", "y"]).into(),
        ];
        let mut frame = pl::DataFrame::new(2, columns).expect("a good frame");
        let mut bytes = Vec::new();
        pl::ParquetWriter::new(&mut bytes).finish(&mut frame).expect("writes");
        let table = Table::from_parquet(&bytes).expect("reads");
        let a = table.column("A").expect("there");
        assert!(a.gaps && a.unit.is_empty() && a.data.cell(0) == "1.5" && a.data.cell(1).is_empty());
        assert_eq!(table.ints("n"), Ok(&[7, 8][..]));

        let columns = vec![pl::Series::new("n".into(), [Some(1_i64), None]).into()];
        let mut frame = pl::DataFrame::new(2, columns).expect("a good frame");
        let mut bytes = Vec::new();
        pl::ParquetWriter::new(&mut bytes).finish(&mut frame).expect("writes");
        assert_eq!(Table::from_parquet(&bytes), Err(TableError::Missing { column: "n".to_owned(), row: 1 }));
    }
}
