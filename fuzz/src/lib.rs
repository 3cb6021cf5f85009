//! The fuzz targets, and what they share: numbers, points and poses from arbitrary bytes, a C program made of them, and the checks
//! of the tests. The programs in `fuzz_targets/` hand them libFuzzer's bytes, `tests/corpora.rs` the committed ones.

pub mod c_program;
pub mod contacts;
pub mod geometry;
pub mod targets;
