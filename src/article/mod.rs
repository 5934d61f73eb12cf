//! The article as a page: reads findings, pictures and tables, computes nothing.
//!
//! One file of HTML that can be opened from disk: complete without a script and without a network, text and formulas in HTML and MathML,
//! pictures inlined. The words that stand in `template/` hold no digit of a result; every number on the page comes from findings and tables.

pub mod claims;
pub mod content;
pub mod figure;
pub mod loci;
pub mod markup;
pub mod page;
pub mod tables;
pub mod zip;
