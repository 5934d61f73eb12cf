//! Elliptic integrals and functions, every one of them with the complementary parameter `m' = 1 − m` as an input.

pub mod carlson;
