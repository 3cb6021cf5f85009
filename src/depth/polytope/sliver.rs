//! Better planes for triangles that are so thin that their normals, as computed, are noise.
//!
//! Whatever vector m proves |m·v|/|m| as the distance of a triangle, so that a plane may be replaced by any other.

use super::PairRounding;
use super::storage::{NO_PLANE, Polytope};
use crate::base::double_double::{WideVector, narrow, wide_cross, wide_difference};
use crate::base::math::{Vector, divisor};
use crate::base::simd::Lanes;
use crate::placed::frame::Frame;

/// Steps of Gilbert's iteration towards the nearest point of a triangle; the cases that they leave open, the three sides settle.
const GILBERT_STEPS: u32 = 12;

/// Gives a triangle the plane whose normal is the cross product of its edges in double-double arithmetic, these from the bodies'
/// own edges: of nearly parallel ones a rounded product is noise, and differences of vertices cancel. Whether the plane is another
/// one.
pub fn straighten<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    triangle: usize,
) -> bool {
    let pairs = polytope.pairs_of(triangle);
    let columns =
        [0, 1].map(|i| [Vector::x(), Vector::y(), Vector::z()].map(|axis| frame.bodies[i].rotate(&axis).to_vector()));
    let edge = |k: usize| {
        let [along1, along2] = [0, 1].map(|i| {
            let vertices = &frame.bodies[i].polyhedron.vertices;
            let [from, to] = [pairs[0][i], pairs[k][i]].map(|v| vertices[v as usize].position);
            rotate(&columns[i], &wide_difference(&to, &from))
        });
        [0, 1, 2].map(|axis| along1[axis] - along2[axis])
    };
    let normal = narrow(&wide_cross(&edge(1), &edge(2)));
    let before = polytope.normal(triangle);
    give_plane(polytope, rounding, triangle, &normal) && polytope.normal(triangle) != before
}

/// R·p from the columns of R.
fn rotate([x, y, z]: &[Vector; 3], p: &WideVector) -> WideVector {
    [0, 1, 2].map(|k| p[0] * x[k].into() + p[1] * y[k].into() + p[2] * z[k].into())
}

/// Gives a triangle the plane that proves most of its distance from the origin, of a few: along the direction of the best upper
/// bound, towards its nearest point, towards those of its sides. Whether that is more than before.
pub fn sharpen<const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    triangle: usize,
    direction: Option<&Vector>,
) -> bool {
    let corners = polytope.positions_of(triangle);
    let mut best = (polytope.distances[triangle], None);
    let mut consider = |normal: Vector| {
        if let Some((normal, distance)) = plane(rounding, &corners, &normal)
            && distance > best.0
        {
            best = (distance, Some(normal));
        }
    };
    direction.into_iter().for_each(|direction| consider(*direction));
    // Gilbert (1966): towards the corner that lies lowest along the point so far.
    let shorter = |a: Vector, b: &Vector| if b.norm_squared() < a.norm_squared() { *b } else { a };
    let mut point = corners.iter().fold(corners[0], shorter);
    for _ in 0..GILBERT_STEPS {
        consider(point);
        let lower = |a: Vector, b: &Vector| if point.dot(b) < point.dot(&a) { *b } else { a };
        let lowest = corners.iter().fold(corners[0], lower);
        let Some(nearer) = nearest_between(&point, &lowest) else { break };
        point = nearer;
    }
    for k in 0..3 {
        if let Some(nearest) = nearest_between(&corners[k], &corners[(k + 1) % 3]) {
            consider(nearest);
        }
    }
    let (distance, Some(normal)) = best else { return false };
    polytope.distances[triangle] = distance;
    set_normal(polytope, triangle, &normal);
    true
}

/// The point of a segment nearest to the origin, unless that is its first end.
fn nearest_between(from: &Vector, to: &Vector) -> Option<Vector> {
    let along = to - from;
    // Both ends may be one point.
    let t = -from.dot(&along) / divisor(along.norm_squared());
    (t > 0.0).then(|| from + along * t.min(1.0))
}

fn give_plane<const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    triangle: usize,
    normal: &Vector,
) -> bool {
    let Some((normal, distance)) = plane(rounding, &polytope.positions_of(triangle), normal) else { return false };
    polytope.distances[triangle] = distance;
    set_normal(polytope, triangle, &normal);
    true
}

fn set_normal<const V: usize, const T: usize>(polytope: &mut Polytope<V, T>, triangle: usize, normal: &Vector) {
    for k in 0..3 {
        polytope.normals[k][triangle] = normal[k];
    }
}

/// The unit normal and the distance that it proves for three corners.
fn plane(rounding: &PairRounding, corners: &[Vector; 3], normal: &Vector) -> Option<(Vector, f64)> {
    let largest = normal.amax();
    // False for a NaN; so scaled no square underflows that counts.
    if !(f64::MIN_POSITIVE..f64::INFINITY).contains(&largest) {
        return None;
    }
    let scaled = normal / largest;
    let unit = scaled / scaled.norm();
    let least = corners.iter().map(|corner| unit.dot(corner)).fold(f64::INFINITY, f64::min);
    let distance = least - rounding.plane;
    (distance > NO_PLANE).then_some((unit, distance))
}
