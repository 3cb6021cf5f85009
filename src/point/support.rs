//! The vertex of a placed body that is farthest along a direction: doubles climb to it, integers go on where they cannot tell.

use super::answer::SupportVertex;
use super::check_finite;
use crate::answer::{moved, normalised, placed_points};
use crate::base::error::{Error, Result};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, binary_order};
use crate::base::memory::in_integers;
use crate::base::simd::environment::with_default;
use crate::base::simd::{Lanes, Portable};
use crate::body::polyhedron::{LARGEST, Polyhedron, SMALLEST};
use crate::depth::polytope::farthest;
use crate::pair::Placed;
use crate::placed::Pair;
use crate::placed::exact::body::ExactBody;
use crate::placed::exact::dyadic::DyadicVector;

/// The support vertex of a body along a direction of the world, of any length but 0: guaranteed, whatever the magnitudes. For a
/// body with a swept radius, place and height are those of the ball about the vertex. Of a curved body vertex and place are the
/// polyhedron's, and the height is the body's.
///
/// # Errors
/// [`Error::Argument`] for a direction that is 0 or not finite, [`Error::Pose`] for a pose that is not accepted, as in
/// [`crate::pair::distance`], [`Error::Memory`] where there is none for integers.
pub fn support(body: Placed, direction: [f64; 3]) -> Result<SupportVertex> {
    with_default(|| {
        check_finite("direction", &direction)?;
        if direction == [0.0; 3] {
            return Err(Error::Argument("the direction is 0: give it a length".into()));
        }
        body.pose.check()?;
        let polyhedron = body.shape.polyhedron();
        let (vertex, is_certain) = climb(polyhedron, body.pose, &direction.into());
        let vertex = match is_certain {
            true => vertex,
            false => in_integers(|| climb_exactly(polyhedron, body.pose, direction, vertex))?,
        };
        let position = polyhedron.vertices[vertex as usize].position;
        let radius = body.shape.swept_radius();
        let points = placed_points(&Pair { polyhedra: [polyhedron; 2], poses: [body.pose; 2] }, &[position; 2]);
        let outwards = normalised(&direction.into());
        let points = if radius > 0.0 { moved(&points, [body.pose; 2], &outwards, [radius; 2]) } else { points };
        Ok(SupportVertex {
            vertex: polyhedron.vertex_labels[vertex as usize],
            exact: i32::from(!is_certain),
            local: points.local[0],
            world: points.world[0],
            height: height(body, &direction.into(), vertex),
        })
    })
}

/// The farthest vertex as far as doubles tell, and whether they tell.
fn climb(polyhedron: &Polyhedron, pose: &Pose, direction: &Vector) -> (u32, bool) {
    if !(SMALLEST..=LARGEST).contains(&polyhedron.radius) {
        return (0, false);
    }
    // A power of two, in two parts as neither end of the range has its inverse among the doubles: less than 1 long, and no digit
    // is lost that could turn it by 2⁻¹⁰⁰⁰.
    let exponent = binary_order(direction.amax()).clamp(-1073, 1023) + 2;
    let halves = [exponent / 2, exponent - exponent / 2];
    let scaled = halves.iter().fold(*direction, |d, &half| d * f64::powi(2.0, -half));
    let (vertex, excess) = farthest(polyhedron, Portable::from_vector(&pose.rotate_back(&scaled)), None);
    (vertex, excess == 0.0)
}

/// The farthest vertex by integers, from one that may be it.
#[cold]
#[inline(never)]
fn climb_exactly(polyhedron: &Polyhedron, pose: &Pose, direction: [f64; 3], from: u32) -> u32 {
    let body = ExactBody::new(polyhedron, pose);
    let towards = body.local_direction(&DyadicVector::from_doubles(direction).components);
    body.support(from, &towards)
}

/// Two doubles that enclose the height of the ball about a vertex along a direction.
///
/// Each of its terms d·R·c, d·R·p, d·T and r·|d|, summed, goes through at most nine roundings: 9u of their absolute values, which
/// are themselves rounded as often. Values that underflow are below the smallest normal number; |d| is in units of its largest
/// component, of which the radius makes a length first, so that no square does.
fn height(body: Placed, direction: &Vector, vertex: u32) -> [f64; 2] {
    let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
    let (centre, position) = (polyhedron.centre, polyhedron.vertices[vertex as usize].position);
    let (local, parts) = (centre + position, centre.abs() + position.abs());
    let (mut value, mut terms) = (0.0, 0.0);
    for (d, [x, y, z, t]) in direction.iter().zip(pose.rows) {
        value += d * (x * local.x + y * local.y + z * local.z + t);
        terms += d.abs() * (x.abs() * parts.x + y.abs() * parts.y + z.abs() * parts.z + t.abs());
    }
    let largest = direction.amax();
    let times_length = |length: f64| length * largest * (direction / largest).norm();
    let (ball, deviation) = (times_length(body.shape.swept_radius()), times_length(body.shape.deviation()));
    (value, terms) = (value + ball, terms + ball + deviation);
    let error = 12.0 * U * terms + f64::MIN_POSITIVE;
    // A value that overflows says nothing.
    match value.is_finite() && error.is_finite() {
        true => [(value - error).next_down(), (value + deviation + error).next_up()],
        false => [f64::NEG_INFINITY, f64::INFINITY],
    }
}
