//! A shape where it is.

use crate::base::math::Pose;
use crate::shape::Shape;

/// A body where it is: what a query takes two of, see [`Shape::at`].
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    /// Its geometry.
    pub shape: &'a Shape,
    /// Where it is.
    pub pose: &'a Pose,
}

impl Shape {
    /// The shape where `pose` says.
    #[inline(always)]
    pub fn at<'a>(&'a self, pose: &'a Pose) -> Placed<'a> {
        Placed { shape: self, pose }
    }
}
