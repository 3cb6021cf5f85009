//! A shape that is one triangle, then another: a query of many triangles passes it to the pair layer.

use super::{InputPolicy, LookupKind, LookupOptions, Shape, ShapeOptions};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::body::build::assembly::{move_inner, move_outline};
use crate::body::polyhedron::Polyhedron;
use crate::shape::levels::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions};

/// A triangle as a shape, to be moved to others' places.
#[derive(Debug, PartialEq)]
pub(crate) struct TriangleShape {
    shape: Shape,
    /// The corner that each vertex is.
    corner_of: [usize; 3],
    /// The face from which the corners go around counter-clockwise.
    front: usize,
}

/// A triangle of a surface in the caller's numbering.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Triangle {
    pub corners: [Vector; 3],
    /// The unit normal of the side from which they go around counter-clockwise, right to a few u.
    pub normal: Vector,
    /// The labels of the corners; that of the triangle is next.
    pub labels: [u32; 3],
    pub label: u32,
}

impl TriangleShape {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new() -> Result<TriangleShape> {
        let corners = [Vector::zeros(), Vector::x(), Vector::y()];
        let options = ShapeOptions {
            input: InputPolicy::Hull,
            hierarchy: HierarchyOptions { kind: HierarchyKind::None, ..HierarchyOptions::default() },
            // A table would hold the corners of before.
            lookup: LookupOptions { kind: LookupKind::None, ..LookupOptions::default() },
            ..ShapeOptions::default()
        };
        let shape = Shape::from_points(&corners, &options)?;
        let Polyhedron { vertex_labels, faces, .. } = &shape.polyhedron;
        let corner_of = [0, 1, 2].map(|v| vertex_labels[v] as usize);
        let front = usize::from(faces[0].normal.z < 0.0);
        Ok(TriangleShape { shape, corner_of, front })
    }

    /// One for another query.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn copy(&self) -> Result<TriangleShape> {
        let levels = Hierarchy { kind: HierarchyKind::None, levels: Vec::new() };
        let shape = Shape::from_parts(self.shape.polyhedron.copy()?, levels, 0.0)?;
        Ok(TriangleShape { shape, ..*self })
    }

    /// The shape of a triangle that is not on a line, whose coordinates are within the range that
    /// [`move_outline`](crate::body::build::assembly::move_outline) says.
    pub fn of(&mut self, triangle: &Triangle) -> &Shape {
        self.show(triangle);
        self.complete()
    }

    /// Makes it a triangle, as [`of`](TriangleShape::of) takes it, for which only a [manifold](TriangleShape::shown) may be
    /// queried.
    pub fn show(&mut self, triangle: &Triangle) {
        let polyhedron = &mut self.shape.polyhedron;
        let corners = self.corner_of.map(|corner| triangle.corners[corner]);
        let mut normals = [-triangle.normal; 2];
        normals[self.front] = triangle.normal;
        move_outline(polyhedron, &corners, &normals);
        let labels = self.corner_of.map(|corner| triangle.labels[corner]);
        polyhedron.vertex_labels.copy_from_slice(&labels);
        for edge in &mut polyhedron.edges {
            edge.labels = [edge.tail(), edge.head()].map(|v| labels[v as usize]);
        }
        polyhedron.face_labels.fill(triangle.label);
        for face in &mut polyhedron.faces {
            face.label = triangle.label;
        }
    }

    /// The shape of the triangle that was [shown](TriangleShape::show), for all queries.
    pub fn complete(&mut self) -> &Shape {
        move_inner(&mut self.shape.polyhedron);
        &self.shape
    }

    /// The triangle that was shown, for its manifolds.
    pub fn shown(&self) -> &Shape {
        &self.shape
    }
}
