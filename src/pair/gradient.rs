//! How a signed distance changes as its objects move, from an answer's normal and witness points, without a further search.
//!
//! A signed distance is n·(x − y) for the witness points x and y of objects 1 and 2. While they move, n changes across itself,
//! x − y is along n, and other points that come nearer begin at the same distance: only the motion of x and y along n counts
//! (J. M. Danskin, "The theory of max-min, with applications", 1966). Where other points are as near, the derivative along a
//! motion is the least of all pairs of nearest points.

use super::signed_distance::SignedDistance;
use crate::answer::Outcome;
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::body::polyhedron::Polyhedron;
use crate::shape::Placed;

/// The derivative of a signed distance by the motions of both objects. Each has six numbers: by the linear velocity along the
/// world's axes, then by the angular velocity about these axes, in lengths per radian. The object turns about its reference point
/// and moves with it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Gradient {
    /// By the motion of object 1.
    pub object1: [f64; 6],
    /// By the motion of object 2.
    pub object2: [f64; 6],
    /// 1: no other points of the objects are as near along the normal, and this is the derivative. 0: a face or an edge is parallel
    /// to one of the other object, up to rounding and the interval's width. Then the numbers are for the answer's own witness
    /// points, and the signed distance grows along no motion faster than they say. Of overlapping objects both are meant along the
    /// answer's normal: whether another direction is as deep is not looked for.
    pub is_unique: i32,
}

impl Default for Gradient {
    fn default() -> Self {
        Gradient { object1: [f64::NAN; 6], object2: [f64::NAN; 6], is_unique: 0 }
    }
}

/// The gradient of an answer for the same bodies, about reference points in the world; without them about the translations of the
/// poses. It takes time in proportion to the number of vertices, and no memory.
///
/// Of overlapping objects it is along the answer's normal. That another direction is as deep is not looked for: there the signed
/// distance has a ridge, and along a motion it changes as the direction that stays least deep says.
///
/// # Errors
/// [`Error::Argument`] for an answer without a normal and witness points, for a cylinder, cone or ellipsoid, and for a reference
/// point that is not finite;
/// [`Error::Pose`] for a pose that is refused.
pub fn gradient(bodies: [Placed; 2], answer: &SignedDistance, references: [Option<[f64; 3]>; 2]) -> Result<Gradient> {
    for body in bodies {
        body.pose.check()?;
        body.shape.refuse_deviation("gradients")?;
    }
    let SignedDistance { outcome, lower, upper, world1, world2, normal, .. } = *answer;
    let are_there = [normal, world1, world2].as_flattened().iter().all(|x| x.is_finite());
    if !(matches!(outcome, Outcome::Separated | Outcome::Intersecting) && are_there) {
        return Err(Error::Argument(
            "the answer has no normal and witness points: ask for the signed distance, within max_distance".into(),
        ));
    }
    let (normal, worlds) = (Vector::from(normal), [world1, world2].map(Vector::from));
    let mut derivatives = [[0.0; 6]; 2];
    for (i, derivative) in derivatives.iter_mut().enumerate() {
        let about = references[i].map_or_else(|| bodies[i].pose.translation(), Vector::from);
        if !about.iter().all(|x| x.is_finite()) {
            return Err(Error::Argument(format!("reference{} is not finite", i + 1)));
        }
        let along = if i == 0 { normal } else { -normal };
        let turning = (worlds[i] - about).cross(&along);
        *derivative = [along.x, along.y, along.z, turning.x, turning.y, turning.z];
    }
    let is_unique = has_one_pair(bodies, &normal, upper - lower);
    let [object1, object2] = derivatives;
    Ok(Gradient { object1, object2, is_unique: i32::from(is_unique) })
}

/// The sine of an angle below which edges are as good as parallel.
const PARALLEL: f64 = f64::from_bits((1023 - 40) << 52);

/// Vertices that are as near along the normal, up to rounding and to what the interval leaves open.
enum NearestPoints {
    Point,
    /// A line, along a direction of the world.
    Line(Vector),
    Plane,
}

/// Whether the bodies have one pair of nearest points along a normal: one has a single vertex there, or both have an edge and these
/// cross.
fn has_one_pair(bodies: [Placed; 2], normal: &Vector, width: f64) -> bool {
    let polyhedra = bodies.map(|body| body.shape.polyhedron());
    let size = polyhedra[0].radius + polyhedra[1].radius;
    // A normal that is off by ε widens the interval by ε times the sizes. Heights g·p err by 10u of them, and count twice.
    let within = 2.0 * width + 64.0 * U * size;
    let nearest = [0, 1].map(|i| {
        let towards = bodies[i].pose.rotate_back(&if i == 0 { -normal } else { *normal });
        nearest(polyhedra[i], &towards, within)
    });
    match nearest {
        [NearestPoints::Point, _] | [_, NearestPoints::Point] => true,
        [NearestPoints::Line(first), NearestPoints::Line(second)] => {
            let [first, second] = [bodies[0].pose.rotate(&first), bodies[1].pose.rotate(&second)];
            first.cross(&second).norm() > PARALLEL * first.norm() * second.norm()
        }
        _ => false,
    }
}

/// The vertices of a body that are farthest along a direction of its own frame, up to `within`; the line is in that frame.
fn nearest(polyhedron: &Polyhedron, towards: &Vector, within: f64) -> NearestPoints {
    let positions = || polyhedron.vertices.iter().map(|vertex| vertex.position);
    let highest = positions().map(|p| p.dot(towards)).fold(f64::NEG_INFINITY, f64::max);
    let near = || positions().filter(|p| p.dot(towards) >= highest - within);
    let Some(first) = near().next() else { return NearestPoints::Plane };
    let along = near().map(|p| p - first).fold(Vector::zeros(), |a, b| if b.norm() > a.norm() { b } else { a });
    let length = along.norm();
    if length == 0.0 {
        return NearestPoints::Point;
    }
    // Differences of positions err by u of the radius, products by 3u.
    let off_line = |p: Vector| (p - first).cross(&(along / length)).norm();
    if near().map(off_line).fold(0.0, f64::max) <= 16.0 * U * polyhedron.radius {
        NearestPoints::Line(along / length)
    } else {
        NearestPoints::Plane
    }
}
