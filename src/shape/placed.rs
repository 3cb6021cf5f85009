//! A shape where it is.

use crate::base::math::Pose;
use crate::placed::Pair;
use crate::shape::Shape;

/// A body at a pose: a query takes two of them, see [`Shape::at`].
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    /// Its geometry.
    pub shape: &'a Shape,
    /// The pose of the body.
    pub pose: &'a Pose,
}

impl Shape {
    /// The shape, placed by `pose`.
    #[inline(always)]
    pub fn at<'a>(&'a self, pose: &'a Pose) -> Placed<'a> {
        Placed { shape: self, pose }
    }
}

impl<'a> Pair<'a> {
    /// The polyhedra of two shapes.
    #[inline(always)]
    pub fn of(bodies: &[Placed<'a>; 2]) -> Pair<'a> {
        Pair { polyhedra: bodies.map(|body| body.shape.polyhedron()), poses: bodies.map(|body| body.pose) }
    }
}
