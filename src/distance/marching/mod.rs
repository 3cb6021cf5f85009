//! Voronoi marching between two convex polyhedra: from a pair of features to the pair that holds the nearest points.
//!
//! A state moves to the neighbour across the most violated plane (Ehmann & Lin 2000, §5.1; Lin & Canny 1991; Mirtich 1998),
//! all planes of a state being tested in one short vector chain. In a minimum the optimality conditions hold: each nearest
//! point lies in its feature, and the direction between them in the normal cones of both features.
//!
//! Marching proposes. Its results are accepted by the certificate alone, which is fused with the last step; a case that it cannot
//! finish (a suspected penetration, a cycle, the step limit) is decided elsewhere.

mod step;
mod ahead;
mod shortcuts;
mod walks;
mod states;

use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::distance::certificate::Certify;
use crate::placed::frame::Frame;
use crate::placed::state::{State, StateKind};
pub use states::{
    between_feet, correction, error_along, from_foot, misfit_across_edge, misfit_between_edges, projected,
};
use states::{edge_edge, vertex_edge, vertex_face, vertex_vertex};
pub use step::{Step, Transition};

/// The result of marching.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum March {
    /// A minimum at this state; the certifier has seen it.
    Minimum(State),
    /// The step limit was met on the way to this state.
    Limit(State),
    /// A penetration is suspected, or a cycle was met, at this state.
    Open(State),
}

/// Tests one state; a minimum goes to `certifier`.
#[inline(always)]
pub fn visit<L: Lanes, C: Certify<L>>(frame: &Frame<L>, state: State, certifier: &mut C) -> Step {
    let State { first, second, .. } = state;
    match state.kind {
        StateKind::VertexVertex => vertex_vertex(frame, [first, second], certifier),
        StateKind::VertexEdge => vertex_edge::<L, C, 0>(frame, first, second, certifier),
        StateKind::EdgeVertex => vertex_edge::<L, C, 1>(frame, second, first, certifier),
        StateKind::VertexFace => vertex_face::<L, C, 0>(frame, first, second, certifier),
        StateKind::FaceVertex => vertex_face::<L, C, 1>(frame, second, first, certifier),
        StateKind::EdgeEdge => edge_edge(frame, [first, second], certifier),
    }
}

/// More steps than any start needs; only cycles that the cycle detection misses meet it.
#[inline(always)]
pub fn step_limit(polyhedra: [&Polyhedron; 2]) -> u32 {
    64 + polyhedra[0].vertices.len().max(polyhedra[1].vertices.len()) as u32
}

/// Marches from `start`; a minimum goes to `certifier`. Returns the number of states visited too.
#[inline(always)]
pub fn march<L: Lanes, C: Certify<L>>(
    frame: &Frame<L>,
    start: State,
    step_limit: u32,
    certifier: &mut C,
) -> (March, u32) {
    let mut state = start;
    // Brent's cycle detection: a state seen at a power of two and met again.
    let mut mark = start;
    let mut steps = 0;
    let mut jumped = false;
    loop {
        steps += 1;
        let Step { transition, at: next } = visit(frame, state, certifier);
        if transition == Transition::Minimum {
            return (March::Minimum(next), steps);
        }
        if transition != Transition::Move {
            // A local minimum of Voronoi marching (Mirtich 1998, §4.3) is left once; the second time penetration is likely, and
            // decided elsewhere.
            if transition != Transition::Behind || jumped {
                return (March::Open(next), steps);
            }
            jumped = true;
        }
        if next == mark {
            return (March::Open(next), steps);
        }
        if steps >= step_limit {
            return (March::Limit(next), steps);
        }
        if steps.is_power_of_two() {
            mark = next;
        }
        state = next;
    }
}
