//! Four planes side by side.

use crate::base::math::Vector;

/// Four planes, one in each lane: the value of lane i at p is `x[i]·p.x + y[i]·p.y + z[i]·p.z + offset[i]`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct PlaneBlock {
    /// First components of the four unit normals.
    pub x: [f64; 4],
    /// Second components.
    pub y: [f64; 4],
    /// Third components.
    pub z: [f64; 4],
    /// Constant terms.
    pub offset: [f64; 4],
}

impl PlaneBlock {
    /// The value of one plane at a point.
    pub fn value(&self, lane: usize, point: &Vector) -> f64 {
        self.x[lane] * point.x + self.y[lane] * point.y + self.z[lane] * point.z + self.offset[lane]
    }
}
