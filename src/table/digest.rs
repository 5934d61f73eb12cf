//! The logical digest of a table: what it says, not how a file encodes it.

use super::build::Table;
use super::schema::Data;
use sha2::{Digest as _, Sha256};

impl Table {
    /// SHA-256 over name, meaning, schema (names, units, meanings, types, gaps) and the bits of the columns.
    ///
    /// Every field is framed by its length, so no two tables run together. Row groups, compression, the footer's other
    /// entries and the encoder's version are not in it.
    pub fn logical_digest(&self) -> [u8; 32] {
        let mut hash = Sha256::new();
        let mut field = |bytes: &[u8]| {
            hash.update((bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        field(b"polhode table 1");
        field(self.name().as_bytes());
        field(self.meaning().as_bytes());
        field(&(self.rows() as u64).to_le_bytes());
        for column in self.columns() {
            field(column.name.as_bytes());
            field(column.unit.as_bytes());
            field(column.meaning.as_bytes());
            field(column.data.type_name().as_bytes());
            field(&[u8::from(column.gaps)]);
            match &column.data {
                Data::F64(values) => field(&flat(values.iter().map(|x| x.to_bits().to_le_bytes()))),
                Data::I64(values) => field(&flat(values.iter().map(|x| x.to_le_bytes()))),
                Data::Bool(values) => field(&flat(values.iter().map(|x| [u8::from(*x)]))),
                Data::Text(values) => values.iter().for_each(|text| field(text.as_bytes())),
            }
        }
        hash.finalize().into()
    }
}

fn flat<const N: usize>(chunks: impl Iterator<Item = [u8; N]>) -> Vec<u8> {
    chunks.flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::Column;

    fn digest(change: impl FnOnce(&mut Column)) -> [u8; 32] {
        let mut column = Column {
            name: "x".to_owned(),
            unit: "rad".to_owned(),
            meaning: "an angle".to_owned(),
            gaps: false,
            data: vec![0.0, 1.5].into(),
        };
        change(&mut column);
        let table = Table::builder("t", "a test").push(column).build().expect("a good table");
        table.logical_digest()
    }

    #[test]
    fn each_part_of_the_schema_and_each_bit_counts() {
        let original = digest(|_| {});
        assert_eq!(original, digest(|_| {}));
        assert_ne!(original, digest(|c| c.name = "y".to_owned()));
        assert_ne!(original, digest(|c| c.unit = "1".to_owned()));
        assert_ne!(original, digest(|c| c.meaning = "another".to_owned()));
        assert_ne!(original, digest(|c| c.gaps = true));
        assert_ne!(original, digest(|c| c.data = vec![-0.0, 1.5].into()));
        assert_ne!(original, digest(|c| c.data = vec![0.0, 1.5 + f64::EPSILON].into()));
        // The same bytes as integers are another table.
        assert_ne!(original, digest(|c| c.data = vec![0_i64, 1.5_f64.to_bits() as i64].into()));
    }

    #[test]
    fn texts_do_not_run_together() {
        assert_ne!(digest(|c| c.data = vec!["ab", "c"].into()), digest(|c| c.data = vec!["a", "bc"].into()));
    }
}
