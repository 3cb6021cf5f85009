//! What the fuzz targets share: numbers, points and poses from arbitrary bytes, a C program made of them, and the checks of the
//! tests.

pub mod c_program;
pub mod geometry;

#[path = "../../tests/million/bodies.rs"]
pub mod bodies;
#[path = "../../tests/oracle/cases.rs"]
pub mod cases;
#[path = "../../benches/common/mod.rs"]
pub mod common;
#[path = "../../tests/oracle/mod.rs"]
pub mod oracle;
#[path = "../../tests/million/properties.rs"]
pub mod properties;
