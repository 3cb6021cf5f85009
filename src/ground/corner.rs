//! The corner of a triangle that reaches farthest behind a face of the body. The face, and the box in the body's frame, tell
//! triangles that are out of reach; where all other faces are farther from the corner, it is the nearest point, or the deepest.

use super::PlacedGround;
use super::lowest::{Limit, Lowest, local_point};
use super::tree::Bounds;
use crate::answer::label;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector, is_unit};
use crate::body::polyhedron::{NONE, Polyhedron};
use crate::pair::{Feature, FeatureKind, Placed, SignedDistance};
use crate::placed::state::FeatureId;
use crate::shape::Triangle;

/// Rotations with no entry of RᵀR − I above this are taken for rigid, and their transpose for the inverse.
const RIGID: f64 = 16.0 * U;

/// The verdict of a face of the body on a triangle.
pub(super) enum Behind {
    /// The triangle is farther from the body than `max_distance`.
    Beyond,
    Nearest(SignedDistance),
    /// They have points in common.
    Meets,
    Open,
}

/// Looks at the body's own box, and at the face most parallel to a triangle among those at the lowest vertex, for poses that are
/// accepted.
///
/// For a face with the plane n·x = o and the slack σ, all of the body has n·x ≤ o + σ, and all of the face |n·x − o| ≤ σ. So the
/// signed distance is at least that of the triangle from the plane, less σ. A point with n·x < o − σ for all faces is not on the
/// surface. The set of these is convex, and inside if the centre, which is inside, is one of them. Such a point is as deep as the
/// least of o − n·x − σ.
pub(super) fn behind_face(
    body: Placed,
    ground: PlacedGround,
    triangle: &Triangle,
    lowest: &Lowest,
    limit: Limit,
) -> Behind {
    let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
    if pose.rotation_defect() > RIGID {
        return Behind::Open;
    }
    // The bound of `Lowest` holds twice over for points in the body's frame: the transpose is off by three times the defect.
    let error = 2.0 * lowest.error;
    let world = triangle.corners.map(|corner| ground.pose.transform(&corner));
    let corners = world.map(|corner| pose.rotate_back(&(corner - pose.translation())) - polyhedron.centre);
    if limit.is_beyond(gap_of_own_box(body, &Bounds::of(&corners)) - error) {
        return Behind::Beyond;
    }
    if polyhedron.dimension < 3 || body.shape.extent().inner_radius <= 0.0 {
        return Behind::Open;
    }
    let meets_if_pierced = || if pierces(polyhedron, &corners, error) { Behind::Meets } else { Behind::Open };
    let Some(face) = most_parallel(polyhedron, lowest.vertex, &pose.rotate_back(&-lowest.up)) else {
        return meets_if_pierced();
    };
    let plane = &polyhedron.faces[face as usize];
    let heights = corners.map(|corner| plane.planes.value(0, &corner));
    let least = (1..3).fold(0, |least, k| if heights[k] < heights[least] { k } else { least });
    let lower = heights[least] - plane.slack - error;
    if limit.is_beyond(lower) {
        return Behind::Beyond;
    }
    let is_deep = heights[least] + plane.slack + error < 0.0;
    // For bodies that are apart, a point a little behind the foot on the face.
    let inner = if is_deep { 0.0 } else { 2.0 * (plane.slack + error) };
    let way = if is_deep { 0.0 } else { heights[least] + inner };
    let point = corners[least] - plane.normal * way;
    let Some(depth) = depth_of(polyhedron, &point, error) else { return meets_if_pierced() };
    let upper = if is_deep { -depth } else { way + error };
    // The corner is inside, but another face is nearer.
    if is_deep && upper > heights[least] + plane.slack + error {
        return Behind::Meets;
    }
    // The sum with +0 turns −0 into 0.
    let normal = (-pose.rotate(&plane.normal)).add_scalar(0.0);
    let Some(distance) = limit.distance([lower, upper], heights[least]) else { return Behind::Open };
    let world1 = world[least] + normal * distance.distance;
    Behind::Nearest(SignedDistance {
        local1: local_point(pose, &world1).into(),
        local2: triangle.corners[least].into(),
        world1: world1.into(),
        world2: world[least].into(),
        normal: normal.into(),
        feature1: label(polyhedron, FeatureId::Face(face), &point),
        feature2: Feature { kind: FeatureKind::Vertex, ids: [triangle.labels[least], 0] },
        ..distance
    })
}

/// Whether a side of a triangle certainly has a point in a solid body: the middle of what the faces leave of it.
///
/// Corners and points are in the body's centred frame. That of the middle is off by less than 8u of the corners, which `error`
/// covers many times.
fn pierces(polyhedron: &Polyhedron, corners: &[Vector; 3], error: f64) -> bool {
    (0..3).any(|k| {
        let [tail, head] = [corners[k], corners[(k + 1) % 3]];
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for face in &polyhedron.faces {
            let [before, after] = [tail, head].map(|point| face.planes.value(0, &point));
            match (before < 0.0, after < 0.0) {
                (true, true) => {}
                (true, false) => to = to.min(before / (before - after)),
                (false, true) => from = from.max(before / (before - after)),
                (false, false) => return false,
            }
        }
        from < to && depth_of(polyhedron, &(tail + (head - tail) * (0.5 * (from + to))), error).is_some()
    })
}

/// How far a box in the centred frame of a body is from the body's own box along one of its axes, or less than 0.
fn gap_of_own_box(body: Placed, bounds: &Bounds) -> f64 {
    let (middle, half) = body.shape.extent().box_about_centre();
    let aside = (bounds.lower - middle).sup(&(middle - bounds.upper)) - half;
    aside.max()
}

/// The face of a solid body at a vertex that is most parallel to a direction. `None` for a vertex without edges.
fn most_parallel(polyhedron: &Polyhedron, vertex: u32, towards: &Vector) -> Option<u32> {
    debug_assert!(is_unit(towards));
    let edges = polyhedron.neighbour_blocks(vertex).flat_map(|block| block.edge).filter(|edge| *edge != NONE);
    let mut best = (None, f64::NEG_INFINITY);
    for edge in edges {
        // Around the vertex each face comes with one edge as its left one.
        let edge = &polyhedron.edges[edge as usize];
        let face = if edge.tail() == vertex { edge.left() } else { edge.right() };
        let parallel = polyhedron.faces[face as usize].normal.dot(towards);
        if parallel > best.1 {
            best = (Some(face), parallel);
        }
    }
    best.0
}

/// How deep a point in centred coordinates is in a solid body, at least; `None` unless it and the centre are certainly inside.
fn depth_of(polyhedron: &Polyhedron, point: &Vector, error: f64) -> Option<f64> {
    let mut least = f64::INFINITY;
    for face in &polyhedron.faces {
        let depth = -face.planes.value(0, point) - face.slack - error;
        if !(depth > 0.0 && face.planes.offset[0] + face.slack < 0.0) {
            return None;
        }
        least = least.min(depth);
    }
    Some(least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Pose;
    use crate::pair::{Outcome, PairAnswer, PairCache, PairConfig, intersection};
    use crate::random::Random;
    use crate::shape::{InputPolicy, Shape, ShapeOptions};

    /// Only triangles that meet a body pierce it, also by little; of those that meet it by more than rounding most do.
    #[test]
    fn what_pierces_a_body_meets_it() {
        let mut random = Random::new(0x91e);
        let (mut pierced, mut met) = (0, 0);
        for _ in 0..if cfg!(miri) { 5 } else { 2_000 } {
            let points: Vec<Vector> = (0..8).map(|_| random.direction()).collect();
            let body = Shape::from_points(&points, &ShapeOptions::default()).unwrap();
            let polyhedron = body.polyhedron();
            // One corner about as far out as the face that the way from the centre leaves through.
            let way = random.direction();
            let out =
                polyhedron.faces.iter().map(|face| -face.planes.value(0, &Vector::zeros()) / face.normal.dot(&way));
            let on = way * out.filter(|t| *t > 0.0).fold(f64::INFINITY, f64::min);
            // The centre may be outside.
            if !on.norm().is_finite() {
                continue;
            }
            let nearly = on * (1.0 + random.vector().x * random.power(-50, 0));
            let corners = [nearly, way * 3.0 + random.vector(), way * 3.0 + random.vector()];
            let corners_of_shape = corners.map(|corner| corner + polyhedron.centre);
            let flat = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
            let triangle = Shape::from_points(&corners_of_shape, &flat).unwrap();
            let mut answer = PairAnswer::default();
            let bodies = [body.at(&Pose::IDENTITY), triangle.at(&Pose::IDENTITY)];
            intersection(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
            let is_meeting = answer.outcome == Outcome::Intersecting;
            let is_piercing = pierces(polyhedron, &corners, 1e-14);
            assert!(is_meeting || !is_piercing);
            (met, pierced) = (met + usize::from(is_meeting), pierced + usize::from(is_piercing));
        }
        assert!(cfg!(miri) || pierced * 2 > met, "{pierced} of {met}");
    }
}
