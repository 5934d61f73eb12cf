//! Pure mathematics on floating-point numbers. Knows no geometry and no files.

pub mod counting;
pub mod counts;
pub mod double_double;
pub mod elliptic;
pub mod lanes;
pub mod pack;
pub mod polynomial_roots;
pub mod real;
pub mod roots;
pub mod rough;
pub mod runge_kutta;
pub mod taylor;
pub mod ulp;
