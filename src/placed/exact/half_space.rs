//! How high a placed polyhedron is over a plane, in integers.

use super::answer::ExactDistance;
use super::body::ExactBody;
use super::dyadic::{DyadicVector, decode, dot};
use crate::base::math::Pose;
use crate::body::polyhedron::Polyhedron;
use dashu_int::IBig;

/// A body over the plane of the points x with `normal`·x = `offset`.
pub struct OverPlane<'a> {
    body: ExactBody<'a>,
    normal: DyadicVector,
    offset: f64,
}

/// The height of a vertex.
pub struct Height {
    /// Whether it is below the plane, where the product is less than the offset.
    pub is_below: bool,
    /// How far it is from the plane.
    pub distance: ExactDistance,
}

impl<'a> OverPlane<'a> {
    /// `normal` is finite and not 0, `offset` is finite.
    pub fn new(polyhedron: &'a Polyhedron, pose: &Pose, normal: [f64; 3], offset: f64) -> OverPlane<'a> {
        OverPlane { body: ExactBody::new(polyhedron, pose), normal: DyadicVector::from_doubles(normal), offset }
    }

    /// The lowest vertex. The climb to it begins at `start`, which may be any number.
    pub fn lowest(&self, start: u32) -> u32 {
        let down = self.normal.components.clone().map(|component| -component);
        let start = if (start as usize) < self.body.vertex_count() { start } else { 0 };
        self.body.support(start, &self.body.local_direction(&down))
    }

    /// How high a vertex is.
    pub fn height(&self, vertex: u32) -> Height {
        let (normal, position) = (&self.normal, self.body.world_vertex(vertex));
        // n·x − offset, over one power of two.
        let (mut product, mut exponent) =
            (dot(&normal.components, &position.components), normal.exponent + position.exponent);
        let (mantissa, of_offset) = decode(self.offset);
        if mantissa != 0 {
            let least = exponent.min(of_offset);
            product = (product << (exponent - least) as usize) - (IBig::from(mantissa) << (of_offset - least) as usize);
            exponent = least;
        }
        let is_below = product < IBig::ZERO;
        let height = if is_below { -product } else { product };
        // Over |n|, whose own power of two is taken off.
        let square = dot(&normal.components, &normal.components);
        Height { is_below, distance: ExactDistance { height, square, exponent: exponent - normal.exponent } }
    }
}

impl Height {
    /// Between which neighbouring doubles it is: negative below the plane.
    pub fn bounds(&self) -> [f64; 2] {
        let (lower, upper) = self.distance.bounds();
        if self.is_below { [-upper, -lower] } else { [lower, upper] }
    }
}
