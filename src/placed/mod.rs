//! Two polyhedra in one frame: their features, the tests of Voronoi regions, and the same in integers, which always decide.

pub mod state;
pub(crate) mod side_search;
pub mod voronoi;
pub mod frame;
pub mod exact;
