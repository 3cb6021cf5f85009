//! The corner of a triangle that reaches farthest behind a face of the body. The face, and the box in the body's frame, tell
//! triangles that are out of reach; where all other faces are farther from the corner, it is the nearest point, or the deepest.

use super::lowest::{Limit, Lowest, PlacedTriangle, local_point};
use super::reach::GroundReach;
use crate::answer::label;
use crate::base::math::{Vector, is_unit};
use crate::body::polyhedron::{MergedFace, NONE, Polyhedron};
use crate::pair::{Feature, FeatureKind, Placed, SignedDistance};
use crate::placed::state::FeatureId;

/// The verdict of a face of the body on a triangle.
pub(super) enum FaceVerdict {
    /// The triangle is farther from the body than `max_distance`.
    Beyond,
    Nearest(SignedDistance),
    /// They have points in common.
    Meets,
    Open,
}

/// Looks at the face most parallel to a triangle among those at the lowest vertex.
///
/// For a face with the plane n·x = o and the slack σ, all of the body has n·x ≤ o + σ, and all of the face |n·x − o| ≤ σ. So the
/// signed distance is at least that of the triangle from the plane, less σ.
///
/// A corner δ below the plane is in the body if the way to it from the centre, H below the plane and in a ball inside the body,
/// goes on into the face: it gets there a·δ / (H − δ) from the corner's foot, if that is a from the centre's. The face's own
/// corners, seen from the centre, are off by σ/H of how far they are aside.
///
/// No direction within 90° of the face's inward normal overlaps less than that, if the foot is δ inside the face (`is_least` of
/// [`Lowest`] has why). If all normals that contacts may have are within 45° of the triangle's own, and so is this one, it is the
/// least of them. Without that, it may still be the least of all: the points with n·x < o − σ for all faces are in the body, and as
/// deep as the least of o − n·x − σ.
pub(super) fn behind_face(
    body: Placed,
    reach: &GroundReach,
    triangle: &PlacedTriangle,
    lowest: &Lowest,
    limit: Limit,
) -> FaceVerdict {
    let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
    if !reach.is_rigid || polyhedron.dimension < 3 || body.shape.extent().inner_radius <= 0.0 {
        return FaceVerdict::Open;
    }
    // The bound of `PlacedTriangle` holds twice over for points in the body's frame: the transpose is off by three times the
    // defect.
    let error = 2.0 * lowest.error;
    let Some(face) = most_parallel(polyhedron, lowest.vertex, &pose.rotate_back(&-lowest.up)) else {
        return FaceVerdict::Open;
    };
    let world = &triangle.corners;
    let corners = world.map(|corner| pose.rotate_back(&(corner - pose.translation())) - polyhedron.centre);
    let plane = &polyhedron.faces[face as usize];
    let heights = corners.map(|corner| plane.planes.value(0, &corner));
    let least = (1..3).fold(0, |least, k| if heights[k] < heights[least] { k } else { least });
    let lower = heights[least] - plane.slack - error;
    if limit.is_beyond(lower) {
        return FaceVerdict::Beyond;
    }
    let upper = heights[least] + plane.slack + error;
    let inside = inside_face(polyhedron, plane, &corners[least]);
    // The sum with +0 turns −0 into 0.
    let normal = (-pose.rotate(&plane.normal)).add_scalar(0.0);
    if upper < 0.0 {
        let (centre, depth) = (-plane.planes.offset[0], -lower);
        let aside = (corners[least] - plane.normal * plane.normal.dot(&corners[least])).norm();
        let off = 4.0 * (error + plane.slack) * (1.0 + polyhedron.radius / centre);
        let is_within = centre > depth && inside >= aside * depth / (centre - depth) + off;
        let is_least = inside >= depth * (1.0 + 1e-9) + off
            && triangle.marks.are_gentle()
            && normal.dot(&triangle.up) > std::f64::consts::FRAC_1_SQRT_2;
        if !(is_within && is_least) {
            match depth_of(polyhedron, &corners[least], error) {
                // Another face is nearer.
                Some(depth) if -depth > upper => return FaceVerdict::Meets,
                Some(_) => {}
                None if is_within => return FaceVerdict::Meets,
                None => return FaceVerdict::Open,
            }
        }
    } else if inside < 4.0 * (error + plane.slack) {
        return FaceVerdict::Open;
    }
    let Some(distance) = limit.distance([lower, upper], heights[least]) else { return FaceVerdict::Open };
    let world1 = world[least] + normal * distance.distance;
    FaceVerdict::Nearest(SignedDistance {
        local1: local_point(pose, &world1).into(),
        local2: triangle.own.corners[least].into(),
        world1: world1.into(),
        world2: world[least].into(),
        normal: normal.into(),
        feature1: label(polyhedron, FeatureId::Face(face), &corners[least]),
        feature2: Feature { kind: FeatureKind::Vertex, ids: [triangle.own.labels[least], 0] },
        ..distance
    })
}

/// How far a point in centred coordinates is inside the sides of a face; less than 0 beside it.
fn inside_face(polyhedron: &Polyhedron, face: &MergedFace, point: &Vector) -> f64 {
    let first = (1..4).map(|lane| face.planes.value(lane, point)).fold(f64::INFINITY, f64::min);
    let further = (face.side_count as usize).saturating_sub(3).div_ceil(4);
    let blocks = &polyhedron.more_sides[face.first_more as usize..][..further];
    blocks.iter().flat_map(|block| (0..4).map(|lane| block.value(lane, point))).fold(first, f64::min)
}

/// The face of a solid body at a vertex that is most parallel to a direction. `None` for a vertex without edges.
pub(super) fn most_parallel(polyhedron: &Polyhedron, vertex: u32, towards: &Vector) -> Option<u32> {
    debug_assert!(is_unit(towards));
    let mut best = (None, f64::NEG_INFINITY);
    for block in polyhedron.neighbour_blocks(vertex) {
        for (lane, edge) in block.edge.into_iter().enumerate() {
            // Neighbours along edges come first, and lanes that are unused repeat the first.
            if edge == NONE || lane > 0 && edge == block.edge[0] {
                break;
            }
            // Around the vertex each face comes with one edge as its left one.
            let edge = &polyhedron.edges[edge as usize];
            let face = if edge.tail() == vertex { edge.left() } else { edge.right() };
            let parallel = polyhedron.faces[face as usize].normal.dot(towards);
            if parallel > best.1 {
                best = (Some(face), parallel);
            }
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
    use super::super::contacts::near_hills::near_hills;
    use super::*;
    use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig};
    use crate::shape::TriangleShape;

    /// Verdicts and distances are those of the pair layer; no allowed normal overlaps less than that of the face.
    #[test]
    fn what_a_face_tells_is_so() {
        let mut shape = TriangleShape::new().unwrap();
        let (mut seen, mut deep) = ([0; 3], 0);
        near_hills(0xc02, 150, |near, random| {
            let triangle = near.triangle;
            let limit = Limit { radius: 0.0, max_distance: random.uniform(0.0, 0.3) };
            let lowest = Lowest::new(near.vertices, triangle, &triangle.up, 0);
            let found = behind_face(near.vertices.body, near.reach, triangle, &lowest, limit);
            let bodies = [near.vertices.body, shape.of(&triangle.own).at(near.place)];
            let mut truth = PairAnswer::default();
            pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut truth).unwrap();
            match found {
                FaceVerdict::Beyond => assert!(truth.upper > limit.max_distance),
                FaceVerdict::Meets => assert_eq!(truth.outcome, Outcome::Intersecting),
                FaceVerdict::Nearest(contact) => {
                    assert_eq!(truth.outcome, contact.outcome);
                    if contact.outcome == Outcome::Separated {
                        assert!(contact.lower <= truth.upper && truth.lower <= contact.upper);
                        return;
                    }
                    deep += 1;
                    for _ in 0..50 {
                        let way = random.direction() * random.uniform(0.0, 1.0);
                        let normal = (triangle.up + way).normalize();
                        if !near.ground.allows(&triangle.own, &near.reach.local_normal(&normal)) {
                            continue;
                        }
                        let vertex = near.vertices.lowest(&normal, 0);
                        let height = |point: &Vector| normal.dot(point);
                        let high = triangle.corners.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
                        assert!(height(&near.vertices.point(vertex)) - high <= contact.upper + 1e-12);
                    }
                }
                FaceVerdict::Open => {}
            }
            seen[match found {
                FaceVerdict::Beyond => 0,
                FaceVerdict::Meets => 1,
                FaceVerdict::Nearest(_) => 2,
                FaceVerdict::Open => return,
            }] += 1;
        });
        assert!(cfg!(miri) || seen.iter().all(|count| *count > 20) && deep > 20, "{seen:?} {deep}");
    }
}
