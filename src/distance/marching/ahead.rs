//! The memory that is requested before it is known to be needed.

use crate::base::simd::Lanes;
use crate::body::polyhedron::{Edge, NONE, Polyhedron};
use crate::placed::voronoi::Corner;

/// Asks the memory for all that lies across the planes of an edge: a step there waits for it otherwise.
#[inline(always)]
pub(super) fn prefetch_across<L: Lanes>(polyhedron: &Polyhedron, edge: &Edge) {
    L::prefetch(&polyhedron.faces, edge.left());
    L::prefetch(&polyhedron.faces, edge.right());
    prefetch_ends::<L>(polyhedron, edge);
}

#[inline(always)]
pub(super) fn prefetch_ends<L: Lanes>(polyhedron: &Polyhedron, edge: &Edge) {
    L::prefetch(&polyhedron.vertices, edge.tail());
    L::prefetch(&polyhedron.vertices, edge.head());
}

/// Asks the memory for the edges to most neighbours (a vertex of a large hull has six on average): marching goes on along one of
/// them if that neighbour is ahead. No edge has no place; to ask for what is there costs less than to ask for what is nowhere.
#[inline(always)]
pub(super) fn prefetch_edges<L: Lanes>(corner: Corner) {
    let neighbours = &corner.record.neighbours;
    let [first, ..] = neighbours.edge;
    for &edge in &neighbours.edge[..6] {
        L::prefetch(&corner.polyhedron.edges, if edge == NONE { first } else { edge });
    }
}
