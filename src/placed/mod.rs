//! Two polyhedra in one frame: their features, the tests of Voronoi regions, and the same in integers, which always decide.

pub mod state;
pub(crate) mod side_search;
pub mod voronoi;
pub mod frame;
pub mod exact;

use crate::base::math::Pose;
use crate::body::polyhedron::Polyhedron;

/// Two bodies and where they are.
#[derive(Clone, Copy)]
pub struct Pair<'a> {
    pub polyhedra: [&'a Polyhedron; 2],
    /// The bodies' poses in the world.
    pub poses: [&'a Pose; 2],
}
