//! The faces of a shape, for reading: the meaning of a face's id in an answer.

use crate::body::polyhedron::Polyhedron;
use crate::shape::Shape;

/// A face of a shape's hull: all coplanar triangles, a convex polygon.
#[derive(Debug, Clone, Copy)]
pub struct Face<'a> {
    polyhedron: &'a Polyhedron,
    index: u32,
}

impl Shape {
    /// How many faces the hull has; none without a plane.
    pub fn face_count(&self) -> usize {
        self.polyhedron.faces.len()
    }

    /// A face by its place, from 0 to below [`Shape::face_count`].
    pub fn face(&self, index: usize) -> Option<Face<'_>> {
        let index = u32::try_from(index).ok().filter(|index| (*index as usize) < self.face_count())?;
        Some(Face { polyhedron: &self.polyhedron, index })
    }

    /// The place of a face that the caller's polygon `label`, the id of a face in an answer, is a part of; if there are several,
    /// the first. It takes time in proportion to the faces.
    pub fn find_face(&self, label: u32) -> Option<usize> {
        (0..self.face_count()).find(|&face| self.polyhedron.labels_of_face(face as u32).contains(&label))
    }
}

impl<'a> Face<'a> {
    /// Outward, a unit vector up to rounding, in the local frame.
    pub fn normal(&self) -> [f64; 3] {
        self.polyhedron.faces[self.index as usize].normal.into()
    }

    /// The product of the normal with a corner, in the local frame, rounded. No vertex is farther out than rounding and what the
    /// face was merged within make of it.
    pub fn offset(&self) -> f64 {
        let normal = self.polyhedron.faces[self.index as usize].normal;
        let product = |corner: u32| normal.dot(&self.polyhedron.local_position(corner));
        self.corners().map(product).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Its corners as places among the hull's vertices, counter-clockwise seen from outside.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = u32> + use<'a> {
        let Face { polyhedron, index } = *self;
        (0..polyhedron.faces[index as usize].side_count).map(move |side| polyhedron.corner(index, side))
    }

    /// The caller's polygons that are merged in it, ascending; for a hull made without polygons, its own number.
    pub fn labels(&self) -> &'a [u32] {
        self.polyhedron.labels_of_face(self.index)
    }
}
