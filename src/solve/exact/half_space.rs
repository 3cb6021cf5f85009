//! How high a placed polyhedron is over a plane, in integers.

use super::answer::ExactDistance;
use super::body::Body;
use super::dyadic::{DyadicVector, decode, dot};
use crate::base::math::Pose;
use crate::polyhedron::Polyhedron;
use dashu_int::IBig;

/// The lowest vertex over a plane, and its height.
pub struct Lowest {
    /// The vertex.
    pub vertex: u32,
    /// Whether it is below the plane.
    pub is_below: bool,
    /// How far it is from the plane.
    pub distance: ExactDistance,
}

/// The lowest vertex of a body over the plane of the points x with `normal`·x = `offset`, on the side where the product is more;
/// `normal` is finite and not 0. The climb to it begins at `start`, which may be any number.
pub fn lowest(polyhedron: &Polyhedron, pose: &Pose, normal: [f64; 3], offset: f64, start: u32) -> Lowest {
    let body = Body::new(polyhedron, pose);
    let normal = DyadicVector::from_doubles(normal);
    let down = normal.components.clone().map(|component| -component);
    let start = if (start as usize) < body.vertex_count() { start } else { 0 };
    let vertex = body.support(start, &body.local_direction(&down));
    let position = body.world_vertex(vertex);
    // n·x − offset, over one power of two.
    let (mut product, mut exponent) =
        (dot(&normal.components, &position.components), normal.exponent + position.exponent);
    let (mantissa, of_offset) = decode(offset);
    if mantissa != 0 {
        let least = exponent.min(of_offset);
        product = (product << (exponent - least) as usize) - (IBig::from(mantissa) << (of_offset - least) as usize);
        exponent = least;
    }
    let is_below = product < IBig::ZERO;
    let height = if is_below { -product } else { product };
    // Over |n|, whose own power of two is taken off.
    let square = dot(&normal.components, &normal.components);
    Lowest { vertex, is_below, distance: ExactDistance { height, square, exponent: exponent - normal.exponent } }
}
