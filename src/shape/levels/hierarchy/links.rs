//! Which features of neighbouring levels belong together.

use crate::base::error::Result;
use crate::base::memory::filled;
use crate::body::polyhedron::Polyhedron;
use crate::placed::state::FeatureId;

/// For each feature of a polyhedron one of a neighbouring level.
#[derive(Debug, Clone, PartialEq)]
pub struct Links {
    /// For each vertex.
    pub vertices: Vec<FeatureId>,
    /// For each edge.
    pub edges: Vec<FeatureId>,
    /// For each face.
    pub faces: Vec<FeatureId>,
}

impl Links {
    /// All to vertex 0.
    pub(super) fn new(polyhedron: &Polyhedron) -> Result<Links> {
        let links = |count: usize| filled(FeatureId::Vertex(0), count);
        Ok(Links {
            vertices: links(polyhedron.vertices.len())?,
            edges: links(polyhedron.edges.len())?,
            faces: links(polyhedron.faces.len())?,
        })
    }

    /// Whether there is one for each feature of a polyhedron, to a feature that the other has.
    pub(super) fn lead(&self, from: &Polyhedron, to: &Polyhedron) -> bool {
        let exists = |feature: &FeatureId| match *feature {
            FeatureId::Vertex(v) => (v as usize) < to.vertices.len(),
            FeatureId::Edge(e) => (e as usize) < to.edges.len(),
            FeatureId::Face(f) => (f as usize) < to.faces.len(),
        };
        let Links { vertices, edges, faces } = self;
        (vertices.len(), edges.len(), faces.len()) == (from.vertices.len(), from.edges.len(), from.faces.len())
            && vertices.iter().chain(edges).chain(faces).all(exists)
    }

    /// The feature that a feature is linked to.
    #[inline]
    pub fn of(&self, feature: FeatureId) -> FeatureId {
        match feature {
            FeatureId::Vertex(v) => self.vertices[v as usize],
            FeatureId::Edge(e) => self.edges[e as usize],
            FeatureId::Face(f) => self.faces[f as usize],
        }
    }

    /// Memory held, in bytes.
    pub fn heap_bytes(&self) -> usize {
        let Links { vertices, edges, faces } = self;
        size_of_val(&vertices[..]) + size_of_val(&edges[..]) + size_of_val(&faces[..])
    }
}
