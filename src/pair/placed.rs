//! A shape where it is.

use crate::base::math::Pose;
use crate::shape::Shape;

/// A body where it is.
#[derive(Clone, Copy)]
pub struct Placed<'a> {
    /// Its geometry.
    pub shape: &'a Shape,
    /// Where it is.
    pub pose: &'a Pose,
}
