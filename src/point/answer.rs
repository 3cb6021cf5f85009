//! Answers on points and support vertices: plain data, laid out for C.

use crate::pair::{Feature, SignedDistance};

/// Position of a point relative to a closed body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum PointLocation {
    /// No answer yet: the value of a fresh answer.
    #[default]
    None = 0,
    /// In the body's interior. A body without interior has no such point.
    Inside = 1,
    /// On its surface; for a body without interior, any point of it.
    On = 2,
    /// Not in the body.
    Outside = 3,
    /// Inside, on or outside: the deviation of a cylinder, cone or ellipsoid hides it.
    Undecided = 4,
}

/// Position of a point relative to a body, and the nearest feature of the surface. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct PointAnswer {
    /// Guaranteed, whatever the magnitudes.
    pub location: PointLocation,
    /// The feature of the body's surface that holds its nearest point, in the caller's numbering.
    pub feature: Feature,
    /// The best estimate of how far the point is from the surface, `lower ≤ distance ≤ upper`: negative inside, 0 on it.
    pub distance: f64,
    /// Lower end of the rigorous interval; above 0 only outside.
    pub lower: f64,
    /// Upper end of the rigorous interval; at most 0 unless outside or undecided.
    pub upper: f64,
    /// The nearest point of the surface, in the body's local frame.
    pub local: [f64; 3],
    /// The same in the world.
    pub world: [f64; 3],
    /// Unit normal in the world: moving the point along it makes the distance grow as much.
    pub normal: [f64; 3],
}

impl Default for PointAnswer {
    fn default() -> Self {
        PointAnswer::new(PointLocation::None, &SignedDistance::default())
    }
}

impl PointAnswer {
    /// From the signed distance of a point, which is object 1, and the body.
    pub(super) fn new(location: PointLocation, signed: &SignedDistance) -> PointAnswer {
        let &SignedDistance { distance, lower, upper, local2, world2, normal, feature2, .. } = signed;
        PointAnswer { location, feature: feature2, distance, lower, upper, local: local2, world: world2, normal }
    }
}

/// A vertex farthest along a direction. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SupportVertex {
    /// The vertex's index in the caller's array: no other is farther, provably. If several are as far, it is any of them.
    pub vertex: u32,
    /// Whether integers decided what rounding hides: 1 or 0. They allocate.
    pub exact: i32,
    /// The body's support point in its local frame: the vertex, or a point of the ball about it.
    pub local: [f64; 3],
    /// The same in the world, rounded.
    pub world: [f64; 3],
    /// `height[0]` ≤ direction · x ≤ `height[1]` for its exact place x in the world: the largest over the body, the ball that is
    /// swept over it included, or the deviation of a curved body at the upper end.
    pub height: [f64; 2],
}

impl Default for SupportVertex {
    fn default() -> Self {
        SupportVertex { vertex: 0, exact: 0, local: [f64::NAN; 3], world: [f64::NAN; 3], height: [f64::NAN; 2] }
    }
}
