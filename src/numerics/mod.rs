//! Pure mathematics on floating-point numbers. Knows no geometry and no files.

pub mod double_double;
pub mod elliptic;
pub mod real;
pub mod roots;
pub mod ulp;
