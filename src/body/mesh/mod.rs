//! Polygons as the caller gives them, in arrays or in a file. Nothing is known of them yet: not whether they are closed, convex or
//! even flat.

mod polygon_mesh;
mod precision;
pub mod io;

pub use polygon_mesh::*;
pub use precision::coordinate_unit;
