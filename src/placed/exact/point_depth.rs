//! How deep a point is in a body: as far as the nearest of the planes of the hull's triangles, in integers.

use super::answer::ExactDistance;
use super::body::ExactBody;
use super::dyadic::{cross, dot, leading_bits};
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF, Vector};
use crate::body::polyhedron::Polyhedron;
use dashu_int::IBig;

/// The way out for a point inside a body.
pub struct WayOut {
    /// Through which face.
    pub face: u32,
    /// How far that is, between neighbouring doubles.
    pub depth: [f64; 2],
    /// The face's outward unit normal in the world, rounded.
    pub normal: Vector,
}

/// The shortest way out of a body with interior for a body that is one point in it.
pub fn way_out(polyhedron: &Polyhedron, pose: &Pose, point: &Polyhedron, place: &Pose) -> Option<WayOut> {
    debug_assert!(polyhedron.dimension == 3 && point.dimension == 0);
    let body = ExactBody::new(polyhedron, pose);
    let at = ExactBody::new(point, place).world_vertex(0);
    let near = NearFaces::new(polyhedron, pose, &place.transform(&point.local_position(0)));
    let mut best: Option<(u32, ExactDistance, Vector)> = None;
    for (triangle, &face) in polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle) {
        if !near.may_be_nearest(face) {
            continue;
        }
        let mut corners = triangle.map(|v| body.world_vertex(v).difference(at.clone()));
        let exponent = corners.iter().map(|corner| corner.exponent).min().unwrap_or(0);
        corners.iter_mut().for_each(|corner| corner.refine(exponent));
        let [a, b, c] = corners.map(|corner| corner.components);
        // The normal of a triangle of which the point is on the inner side: det R > 0.
        let normal = cross(&[0, 1, 2].map(|k| &b[k] - &a[k]), &[0, 1, 2].map(|k| &c[k] - &a[k]));
        let distance = ExactDistance { height: dot(&normal, &a), square: dot(&normal, &normal), exponent };
        debug_assert!(distance.height >= IBig::ZERO);
        if best.as_ref().is_none_or(|(_, least, _)| distance.is_less_than(least)) {
            best = Some((face, distance, leading_bits(&normal)));
        }
    }
    best.map(|(face, distance, normal)| WayOut { face, depth: distance.bounds().into(), normal: normal.normalize() })
}

/// The faces that may hold the place of a body's surface that is nearest to a point inside, as far as doubles tell.
struct NearFaces<'a> {
    polyhedron: &'a Polyhedron,
    /// The point in the body's centred frame, about.
    point: Vector,
    /// Faces that are farther away than this hold it not.
    far: f64,
}

impl<'a> NearFaces<'a> {
    fn new(polyhedron: &'a Polyhedron, pose: &Pose, world: &Vector) -> NearFaces<'a> {
        let translation = pose.translation();
        let inverse = pose.rotation().try_inverse().unwrap_or_else(Matrix::zeros);
        let point = inverse * (world - translation) - polyhedron.centre;
        // Some thirty roundings of such sizes, at most 2u each.
        let sizes = [*world, translation, polyhedron.centre].iter().map(|v| v.lp_norm(1)).sum::<f64>();
        let rounding = ROUNDING * (sizes + polyhedron.radius) + f64::MIN_POSITIVE;
        let mut near = NearFaces { polyhedron, point, far: f64::INFINITY };
        // The planes of the body's normals that hold it are at most a slack farther out than a vertex of the face. The depth d is
        // at most as far as any of them, and the face that holds the nearest place is no farther than d and its own slack. Lengths
        // along a normal are others in the world by 1.6 % at most: |RᵀR − I| ≤ 1e-2 in each entry, so 3e-2 as a norm.
        let farthest = |face: u32| near.distance(face) + polyhedron.faces[face as usize].slack + rounding;
        let depth = (0..polyhedron.faces.len() as u32).map(farthest).fold(f64::INFINITY, f64::min);
        near.far = STRETCH * depth + rounding;
        near
    }

    /// How far the plane through a vertex of a face is from the point.
    fn distance(&self, face: u32) -> f64 {
        let face = &self.polyhedron.faces[face as usize];
        face.normal.dot(&(self.polyhedron.vertices[face.vertex as usize].position - self.point))
    }

    fn may_be_nearest(&self, face: u32) -> bool {
        // False for a NaN alone.
        !(self.distance(face) - self.polyhedron.faces[face as usize].slack > self.far)
    }
}

/// See [`NearFaces::new`].
const ROUNDING: f64 = 64.0 * UNIT_ROUNDOFF;

/// The ratio of the longest to the shortest that a length may become, (1 + 3e-2) / (1 − 3e-2) of squares, rounded up.
const STRETCH: f64 = 1.04;
