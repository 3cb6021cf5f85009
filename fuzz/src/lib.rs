//! What the fuzz targets share: numbers, points and poses from arbitrary bytes, a C program made of them, and the checks of the
//! tests.

pub mod c_program;
pub mod contacts;
pub mod geometry;
