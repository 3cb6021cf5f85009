//! The policy of starts: the start of a search depends on what has moved since the last query, by how much, and which tables
//! there are. The numbers are in [`tuning`](crate::body::tables::tuning).

use crate::base::math::{Pose, Vector};
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::{Plan, Table};
use crate::body::tables::tables;
use crate::body::tables::tuning::{COME_APART, FAR, ONE_ROUND, TWO_ROUNDS};
use crate::placed::Pair;
use crate::placed::frame::{Frame, Marker};
use crate::placed::state::State;

/// From what a search starts, if not from the features of the last query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StartFrom {
    /// The vertices where the last query ended, and this many rounds of look-ups from them.
    LastVertices {
        /// One of each body.
        vertices: [u32; 2],
        /// See [`Shells::rounds`](crate::body::polyhedron::lookup::Shells::rounds).
        rounds: u32,
    },
    /// The centres of mass, and as many rounds of look-ups as the bodies want.
    Centres,
    /// The vertices farthest along the line of the bodies' origins; no table is asked.
    Farthest,
}

/// The start of a search whose last query ended at `last`: there (`None`) while the pair has moved little, else from the tables.
#[inline(always)]
pub fn choose<L: Lanes>(frame: &Frame<L>, marker: &Marker, last: State) -> Option<StartFrom> {
    if !has_jumped(frame, marker) {
        return None;
    }
    let least = square_jump(frame);
    let is_within = |squares: f64| {
        let square = squares * least;
        !(frame.has_moved(marker, square) | frame.has_rolled(marker, square))
    };
    Some(if !is_within(TWO_ROUNDS) {
        StartFrom::Centres
    } else {
        let rounds = if is_within(ONE_ROUND) { 1 } else { 2 };
        StartFrom::LastVertices { vertices: last.vertices(frame.polyhedra()), rounds }
    })
}

/// Whether a pair has moved so far that a look into the tables pays. A NaN has not.
#[inline(always)]
pub fn has_jumped<L: Lanes>(frame: &Frame<L>, marker: &Marker) -> bool {
    frame.has_moved(marker, square_jump(frame))
}

/// Whether a pair that intersected when it had this marker has jumped, and may be apart: it is for marching, from the tables. If
/// spheres inside the bodies may overlap, and the jump is not far, the last enclosure is the better hint.
pub fn may_have_come_apart<L: Lanes>(frame: &Frame<L>, marker: &Marker, poses: [&Pose; 2]) -> bool {
    frame.has_moved(marker, FAR)
        || (frame.has_moved(marker, COME_APART * square_jump(frame))
            && !may_cores_overlap(&Pair { polyhedra: frame.polyhedra(), poses }))
}

#[inline(always)]
fn square_jump<L: Lanes>(frame: &Frame<L>) -> f64 {
    let [first, second] = frame.polyhedra();
    first.lookup.square_jump(&second.lookup)
}

/// Whether spheres inside two bodies overlap, as far as their tables know any; beside a body that needs no table they may.
fn may_cores_overlap(pair: &Pair) -> bool {
    let Pair { polyhedra, poses } = *pair;
    let Some([Table::Shells(first), Table::Shells(second)]) = tables(polyhedra) else {
        return polyhedra.iter().any(|polyhedron| matches!(polyhedron.lookup.plan, Plan::AllVertices { .. }));
    };
    let between = centre_of_mass(polyhedra[0], poses[0]) - centre_of_mass(polyhedra[1], poses[1]);
    let radii = first.core * polyhedra[0].mass.radius + second.core * polyhedra[1].mass.radius;
    between.norm_squared() < radii * radii
}

/// In the world, in plain rounding.
#[inline(always)]
pub(super) fn centre_of_mass(polyhedron: &Polyhedron, pose: &Pose) -> Vector {
    pose.transform(&polyhedron.mass.centre_of_mass)
}
