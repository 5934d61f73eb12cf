//! A record: what a node gave back, under its key. The text form is made of three lines:
//!
//! ```text
//! polhode-record 1 SHA-256-OF-THE-REST
//! {"key":…,"outputs":[{"name":…,"object":…,"logical":…,"size":…}],"work":{…}}
//! {"lines":[…the manifest…]}
//! ```
//!
//! The checksum tells a damaged record; the key inside tells one that lies under a wrong name. The manifest comes last
//! since only `why` reads it. No time is in here: the same work gives the same record.

use crate::contract::digest::Digest;
use crate::contract::manifest::Manifest;
use crate::contract::work::Work;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// One output of a node, as stored.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Output {
    /// The artifact's name: `table.parquet`.
    pub name: String,
    /// The digest of its bytes: its name in the store.
    pub object: Digest,
    /// The digest of what it says: what keys downstream hold.
    pub logical: Digest,
    /// Its size in bytes.
    pub size: u64,
}

/// What a node gave back.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// The key it stands under.
    pub key: Digest,
    /// The outputs.
    pub outputs: Vec<Output>,
    /// The counted work.
    pub work: Work,
}

/// Why a text is no record (or no other sealed text).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Malformed {
    /// The first line is not that of this kind of text.
    #[error("it does not begin with {0:?}")]
    Header(&'static str),
    /// The checksum differs: truncated, flipped, edited.
    #[error("its checksum differs")]
    Checksum,
    /// The checksum is right but the text is not understood.
    #[error("it is not understood: {0}")]
    Content(String),
    /// It is the record of another key.
    #[error("it is the record of {0}")]
    OtherKey(Digest),
}

const HEADER: &str = "polhode-record 1";

impl Record {
    /// The output of that name.
    pub fn output(&self, name: &str) -> Option<&Output> {
        self.outputs.iter().find(|output| output.name == name)
    }

    /// The text form.
    ///
    /// # Errors
    /// None that can be reached with these types; serde's interface has one.
    pub fn to_text(&self, manifest: &Manifest) -> Result<String, Malformed> {
        let json = |text: Result<String, serde_json::Error>| text.map_err(|e| Malformed::Content(e.to_string()));
        let body = format!("{}\n{}\n", json(serde_json::to_string(self))?, json(serde_json::to_string(manifest))?);
        Ok(seal(HEADER, &body))
    }

    /// Reads the text form of the record of `key`, all of it checked, the manifest not parsed.
    ///
    /// # Errors
    /// Anything that is not, to the bit, a record of that key.
    pub fn from_text(text: &[u8], key: Digest) -> Result<Self, Malformed> {
        let body = unseal(HEADER, text)?;
        let record: Self = parse(body.lines().next().unwrap_or_default())?;
        if record.key == key { Ok(record) } else { Err(Malformed::OtherKey(record.key)) }
    }

    /// Reads the manifest in a record's text.
    ///
    /// # Errors
    /// As for [`Self::from_text`]; also a manifest whose key is another one.
    pub fn manifest_from_text(text: &[u8], key: Digest) -> Result<Manifest, Malformed> {
        let manifest: Manifest = parse(unseal(HEADER, text)?.lines().nth(1).unwrap_or_default())?;
        let own = manifest.key();
        if own == key { Ok(manifest) } else { Err(Malformed::OtherKey(own)) }
    }
}

fn parse<T: DeserializeOwned>(line: &str) -> Result<T, Malformed> {
    serde_json::from_str(line).map_err(|error| Malformed::Content(error.to_string()))
}

/// A text with its kind and checksum in the first line.
pub(super) fn seal(header: &str, body: &str) -> String {
    format!("{header} {}\n{body}", Digest::of(body.as_bytes()))
}

/// The body of a sealed text, when it is whole.
pub(super) fn unseal<'a>(header: &'static str, text: &'a [u8]) -> Result<&'a str, Malformed> {
    let rest = text.strip_prefix(header.as_bytes()).and_then(|rest| rest.strip_prefix(b" "));
    let rest = rest.ok_or(Malformed::Header(header))?;
    let (sum, body) = rest.split_at_checked(64).ok_or(Malformed::Checksum)?;
    let body = body.strip_prefix(b"\n").ok_or(Malformed::Checksum)?;
    let sum = std::str::from_utf8(sum).ok().and_then(|sum| sum.parse::<Digest>().ok());
    if sum != Some(Digest::of(body)) {
        return Err(Malformed::Checksum);
    }
    std::str::from_utf8(body).map_err(|error| Malformed::Content(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contract::manifest::{Leaf, Part};

    fn sample() -> (Record, Manifest) {
        let mut manifest = Manifest::default();
        manifest.push(Part::Param, "k", Leaf::float(0.8));
        let output = Output { name: "a".into(), object: Digest::of(b"a"), logical: Digest::of(b"b"), size: 1 };
        (Record { key: manifest.key(), outputs: vec![output], work: Work { steps: 3, ..Work::default() } }, manifest)
    }

    #[test]
    fn a_record_reads_back() {
        let (record, manifest) = sample();
        let text = record.to_text(&manifest).expect("text");
        assert_eq!(Record::from_text(text.as_bytes(), record.key).as_ref(), Ok(&record));
        assert_eq!(Record::manifest_from_text(text.as_bytes(), record.key), Ok(manifest));
    }

    /// Every truncation and every flip of one bit of a record is noticed.
    #[test]
    fn every_truncation_and_every_flipped_bit_is_noticed() {
        let (record, manifest) = sample();
        let text = record.to_text(&manifest).expect("text").into_bytes();
        for length in 0..text.len() {
            assert!(Record::from_text(&text[..length], record.key).is_err(), "truncated to {length}");
        }
        for bit in 0..text.len() * 8 {
            let mut flipped = text.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert!(Record::from_text(&flipped, record.key).is_err(), "bit {bit}");
        }
    }

    #[test]
    fn a_record_under_a_wrong_name_is_noticed() {
        let (record, manifest) = sample();
        let text = record.to_text(&manifest).expect("text");
        let other = Digest::of(b"other");
        assert_eq!(Record::from_text(text.as_bytes(), other), Err(Malformed::OtherKey(record.key)));
    }
}
