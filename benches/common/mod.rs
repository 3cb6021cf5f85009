//! The scenes that tests, benchmarks and examples share: models and motions, seeded by what they are, so that one cell
//! of a large run is the same as that cell run alone.
//!
//! Include with `#[path = "../benches/common/mod.rs"] mod common;`.

#![allow(dead_code)] // every program that includes this uses a part of it

pub mod caches;
pub mod files;
pub mod hard;
pub mod models;
pub mod orbits;
pub mod random;

/// The poses of a pair: the row-major 3x4 `[R|T]` of object 1 and then of object 2.
pub type PosePair = [f64; 24];
