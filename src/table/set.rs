//! Tables by name: what a picture, named values and claims are given to read.

use super::build::Table;
use super::error::TableError;
use std::collections::BTreeMap;

/// A set of tables, each with its logical digest.
#[derive(Clone, Debug, Default)]
pub struct Tables {
    tables: BTreeMap<String, (Table, [u8; 32])>,
}

impl Tables {
    /// An empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a table under a name of its own (which need not be the table's name: many nodes make tables of one name).
    ///
    /// # Errors
    /// A name that is there already.
    pub fn insert(&mut self, name: impl Into<String>, table: Table) -> Result<(), TableError> {
        let name = name.into();
        if self.tables.contains_key(&name) {
            return Err(TableError::DuplicateTable { name });
        }
        let digest = table.logical_digest();
        self.tables.insert(name, (table, digest));
        Ok(())
    }

    /// The table of that name.
    ///
    /// # Errors
    /// No such table.
    pub fn get(&self, name: &str) -> Result<&Table, TableError> {
        self.tables.get(name).map(|(table, _)| table).ok_or_else(|| TableError::NoSuchTable {
            name: name.to_owned(),
            known: self.tables.keys().cloned().collect(),
        })
    }

    /// All tables, in order of their names.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Table)> {
        self.tables.iter().map(|(name, (table, _))| (name.as_str(), table))
    }

    /// The tables whose names begin with `prefix`, in order of their names: the values of a sweep.
    pub fn starting_with<'a>(&'a self, prefix: &'a str) -> impl Iterator<Item = (&'a str, &'a Table)> {
        self.iter().filter(move |(name, _)| name.starts_with(prefix))
    }

    /// The logical digests, in order of the names: for the metadata of a picture.
    pub fn digests(&self) -> impl Iterator<Item = (&str, [u8; 32])> {
        self.tables.iter().map(|(name, (_, digest))| (name.as_str(), *digest))
    }

    /// The number of tables.
    pub fn len(&self) -> usize {
        self.tables.len()
    }

    /// Whether there are no tables.
    pub fn is_empty(&self) -> bool {
        self.tables.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_found_by_their_names_in_the_set() {
        let table = Table::builder("locus", "").column("x", "1", "", vec![1.0]).build().expect("a good table");
        let mut tables = Tables::new();
        tables.insert("locus/k=0.8", table.clone()).expect("new");
        tables.insert("front", table.clone()).expect("new");
        assert!(matches!(tables.insert("front", table.clone()), Err(TableError::DuplicateTable { .. })));
        assert_eq!(tables.get("locus/k=0.8"), Ok(&table));
        assert!(matches!(tables.get("locus"), Err(TableError::NoSuchTable { known, .. }) if known.len() == 2));
        assert_eq!(tables.starting_with("locus").count(), 1);
        assert!(tables.digests().all(|(_, digest)| digest == table.logical_digest()));
    }
}
