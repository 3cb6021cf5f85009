//! Features and the pairs of features that marching visits.

use crate::body::polyhedron::Polyhedron;

/// A feature of one polyhedron.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FeatureId {
    /// Index in `vertices`.
    Vertex(u32),
    /// Index in `edges`.
    Edge(u32),
    /// Index in `faces`.
    Face(u32),
}

/// The states of V-Clip (Mirtich 1998, §3): the kinds of the features of body 1 and body 2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum StateKind {
    /// A vertex and a vertex.
    VertexVertex = 1,
    /// A vertex of body 1 and an edge of body 2.
    VertexEdge = 2,
    /// An edge of body 1 and a vertex of body 2.
    EdgeVertex = 3,
    /// A vertex of body 1 and a face of body 2.
    VertexFace = 4,
    /// A face of body 1 and a vertex of body 2.
    FaceVertex = 5,
    /// An edge and an edge.
    EdgeEdge = 6,
}

/// A pair of features. No array of indices: marching would write its halves and soon read it as a whole, for which the processor
/// waits until both have left the store queue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct State {
    /// The kind of the features.
    pub kind: StateKind,
    /// The index of body 1's feature.
    pub first: u32,
    /// That of body 2's.
    pub second: u32,
}

impl State {
    #[inline(always)]
    fn new(kind: StateKind, [first, second]: [u32; 2]) -> State {
        State { kind, first, second }
    }

    /// The indices of both features.
    #[inline(always)]
    pub fn indices(self) -> [u32; 2] {
        [self.first, self.second]
    }

    /// A vertex of each body.
    #[inline(always)]
    pub fn vertex_vertex(indices: [u32; 2]) -> State {
        State::new(StateKind::VertexVertex, indices)
    }

    /// An edge of each body.
    #[inline(always)]
    pub fn edge_edge(indices: [u32; 2]) -> State {
        State::new(StateKind::EdgeEdge, indices)
    }

    /// A vertex of body `near` (0 or 1) and an edge of the other.
    #[inline(always)]
    pub fn vertex_edge(near: usize, vertex: u32, edge: u32) -> State {
        let kind = if near == 0 { StateKind::VertexEdge } else { StateKind::EdgeVertex };
        State::new(kind, ordered(near, vertex, edge))
    }

    /// A vertex of body `near` (0 or 1) and a face of the other.
    #[inline(always)]
    pub fn vertex_face(near: usize, vertex: u32, face: u32) -> State {
        let kind = if near == 0 { StateKind::VertexFace } else { StateKind::FaceVertex };
        State::new(kind, ordered(near, vertex, face))
    }

    /// A vertex of body `near` (0 or 1) and what lies across a lane of an edge's planes: a vertex across the first two, a face
    /// across the others. Looked up (R4).
    #[inline(always)]
    pub fn across_edge(near: usize, vertex: u32, lane: usize, across: u32) -> State {
        use StateKind::{FaceVertex, VertexFace, VertexVertex};
        const KINDS: [[StateKind; 4]; 2] = [
            [VertexVertex, VertexVertex, VertexFace, VertexFace],
            [VertexVertex, VertexVertex, FaceVertex, FaceVertex],
        ];
        State::new(KINDS[near][lane & 3], ordered(near, vertex, across))
    }

    /// The features of body 1 and body 2.
    #[inline(always)]
    pub fn features(self) -> [FeatureId; 2] {
        use FeatureId::{Edge, Face, Vertex};
        let State { first, second, .. } = self;
        match self.kind {
            StateKind::VertexVertex => [Vertex(first), Vertex(second)],
            StateKind::VertexEdge => [Vertex(first), Edge(second)],
            StateKind::EdgeVertex => [Edge(first), Vertex(second)],
            StateKind::VertexFace => [Vertex(first), Face(second)],
            StateKind::FaceVertex => [Face(first), Vertex(second)],
            StateKind::EdgeEdge => [Edge(first), Edge(second)],
        }
    }

    /// The state of two features, where there is one: not for an edge and a face, nor for two faces.
    pub fn of_features(features: [FeatureId; 2]) -> Option<State> {
        use FeatureId::{Edge, Face, Vertex};
        Some(match features {
            [Vertex(first), Vertex(second)] => State::vertex_vertex([first, second]),
            [Vertex(vertex), Edge(edge)] => State::vertex_edge(0, vertex, edge),
            [Edge(edge), Vertex(vertex)] => State::vertex_edge(1, vertex, edge),
            [Vertex(vertex), Face(face)] => State::vertex_face(0, vertex, face),
            [Face(face), Vertex(vertex)] => State::vertex_face(1, vertex, face),
            [Edge(first), Edge(second)] => State::edge_edge([first, second]),
            _ => return None,
        })
    }

    /// A state from the number of its kind, and of indices that may be anything.
    #[inline(always)]
    pub fn unchecked(kind: u32, indices: [u32; 2]) -> Option<State> {
        use StateKind::{EdgeEdge, EdgeVertex, FaceVertex, VertexEdge, VertexFace, VertexVertex};
        let kind = match kind {
            1 => VertexVertex,
            2 => VertexEdge,
            3 => EdgeVertex,
            4 => VertexFace,
            5 => FaceVertex,
            6 => EdgeEdge,
            _ => return None,
        };
        Some(State::new(kind, indices))
    }

    /// A state from the number of its kind and its indices, if the polyhedra have such features.
    #[inline(always)]
    pub fn checked(kind: u32, indices: [u32; 2], polyhedra: [&Polyhedron; 2]) -> Option<State> {
        let state = State::unchecked(kind, indices)?;
        let [first, second] = state.features();
        (first.is_of(polyhedra[0]) && second.is_of(polyhedra[1])).then_some(state)
    }

    /// A vertex of each feature.
    #[inline(always)]
    pub fn vertices(self, polyhedra: [&Polyhedron; 2]) -> [u32; 2] {
        let [first, second] = self.features();
        [first.vertex(polyhedra[0]), second.vertex(polyhedra[1])]
    }
}

impl FeatureId {
    /// Whether the polyhedron has it.
    #[inline(always)]
    fn is_of(self, polyhedron: &Polyhedron) -> bool {
        match self {
            FeatureId::Vertex(v) => (v as usize) < polyhedron.vertices.len(),
            FeatureId::Edge(e) => (e as usize) < polyhedron.edges.len(),
            FeatureId::Face(f) => (f as usize) < polyhedron.faces.len(),
        }
    }

    /// A vertex of the feature, one of this polyhedron.
    #[inline(always)]
    pub fn vertex(self, polyhedron: &Polyhedron) -> u32 {
        match self {
            FeatureId::Vertex(v) => v,
            FeatureId::Edge(e) => polyhedron.edges[e as usize].tail(),
            FeatureId::Face(f) => polyhedron.faces[f as usize].vertex,
        }
    }
}

/// The index of body `near`'s feature and that of the other body's, in the order of the bodies.
#[inline(always)]
pub fn ordered(near: usize, near_index: u32, far_index: u32) -> [u32; 2] {
    if near == 0 { [near_index, far_index] } else { [far_index, near_index] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn states_and_features_correspond() {
        let states = [
            State::vertex_vertex([3, 4]),
            State::vertex_edge(0, 3, 4),
            State::vertex_edge(1, 3, 4),
            State::vertex_face(0, 3, 4),
            State::vertex_face(1, 3, 4),
            State::edge_edge([3, 4]),
        ];
        for state in states {
            assert_eq!(State::of_features(state.features()), Some(state));
        }
        assert_eq!(State::vertex_face(1, 3, 4).features(), [FeatureId::Face(4), FeatureId::Vertex(3)]);
        assert_eq!(State::of_features([FeatureId::Edge(0), FeatureId::Face(0)]), None);
    }
}
