//! Elliptic integrals and functions, every one of them with the complementary parameter `m' = 1 − m` as an input.

pub mod carlson;
pub mod complete;
pub mod incomplete;
pub mod jacobi;
pub mod mean;
#[cfg(test)]
pub(crate) mod oracle;
pub mod third_kind;
