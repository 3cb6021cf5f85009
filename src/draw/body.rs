//! The edges of a body or a ground, and features.

use super::target::{DrawKind, Pen};
use crate::base::math::Vector;
use crate::body::polyhedron::Polyhedron;
use crate::ground::PlacedGround;
use crate::placed::state::FeatureId;
use crate::shape::Placed;

/// The corners of a drawn circle.
const CIRCLE: u32 = 24;

impl Pen<'_> {
    /// A shape where it is.
    pub fn shape(&mut self, body: Placed) {
        let (polyhedron, radius) = (body.shape.polyhedron(), body.shape.swept_radius());
        if radius > 0.0 && polyhedron.faces.is_empty() {
            return self.round(body);
        }
        for edge in &polyhedron.edges {
            let [tail, head] = [edge.tail(), edge.head()].map(|vertex| place(body, vertex));
            if radius > 0.0 {
                for out in edge.normals.map(|normal| body.pose.rotate(&normal) * radius) {
                    self.line(DrawKind::Edge, tail + out, head + out);
                }
            } else {
                self.line(DrawKind::Edge, tail, head);
            }
        }
        if polyhedron.edges.is_empty() {
            self.point(DrawKind::Edge, place(body, 0));
        }
    }

    /// A ground where it is: edge by edge, with no memory for all of them.
    pub fn ground(&mut self, placed: PlacedGround) {
        for edge in placed.ground.edges() {
            let [tail, head] = edge.map(|end| placed.pose.transform(&end));
            self.line(DrawKind::Edge, tail, head);
        }
    }

    /// A sphere or a capsule: three circles about each end, and four lines from one to the other.
    fn round(&mut self, body: Placed) {
        let (polyhedron, radius) = (body.shape.polyhedron(), body.shape.swept_radius());
        let along = polyhedron
            .edges
            .first()
            .map_or(Vector::x(), |edge| (place(body, edge.head()) - place(body, edge.tail())).normalize());
        let mut least = Vector::zeros();
        least[along.iamin()] = 1.0;
        let across = along.cross(&least).normalize();
        let axes = [along, across, along.cross(&across)].map(|axis| axis * radius);
        for vertex in 0..polyhedron.vertices.len() as u32 {
            let centre = place(body, vertex);
            for [u, v] in [[0, 1], [1, 2], [2, 0]] {
                let at = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(CIRCLE);
                let corners = (0..CIRCLE).map(|k| centre + axes[u] * at(k).cos() + axes[v] * at(k).sin());
                self.polygon(DrawKind::Edge, corners);
            }
        }
        for edge in &polyhedron.edges {
            let [tail, head] = [edge.tail(), edge.head()].map(|vertex| place(body, vertex));
            for out in [axes[1], -axes[1], axes[2], -axes[2]] {
                self.line(DrawKind::Edge, tail + out, head + out);
            }
        }
    }

    /// A feature of a shape's polyhedron.
    pub fn feature(&mut self, body: Placed, feature: FeatureId) {
        let polyhedron = body.shape.polyhedron();
        match feature {
            FeatureId::Vertex(vertex) => self.point(DrawKind::Feature, place(body, vertex)),
            FeatureId::Edge(edge) => {
                let [tail, head] = ends(polyhedron, edge).map(|vertex| place(body, vertex));
                self.line(DrawKind::Feature, tail, head);
            }
            FeatureId::Face(face) => {
                let sides = 0..polyhedron.faces[face as usize].side_count;
                let corners = sides.map(|side| place(body, polyhedron.corner(face, side)));
                self.polygon(DrawKind::Feature, corners);
            }
        }
    }
}

/// A vertex in the world.
pub fn place(body: Placed, vertex: u32) -> Vector {
    body.pose.transform(&body.shape.polyhedron().local_position(vertex))
}

/// The vertices of an edge.
pub fn ends(polyhedron: &Polyhedron, edge: u32) -> [u32; 2] {
    let edge = &polyhedron.edges[edge as usize];
    [edge.tail(), edge.head()]
}
