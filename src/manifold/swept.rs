//! Between the manifold of polyhedra and that of bodies over which balls are swept.

use super::answer::ManifoldPoint;
use crate::answer::{PlacedPoints, Radii, moved};
use crate::base::math::Pose;
use crate::pair::SignedDistance;

/// The contact of the polyhedra, from that of the bodies.
pub fn contact_of_polyhedra(radii: &Radii, poses: [&Pose; 2], contact: &SignedDistance) -> SignedDistance {
    let points = PlacedPoints { local: [contact.local1, contact.local2], world: [contact.world1, contact.world2] };
    let points = moved(&points, poses, &contact.normal, radii.inwards());
    let ([local1, local2], [world1, world2]) = (points.local, points.world);
    let [lower, upper] = radii.back_on([contact.lower, contact.upper]);
    SignedDistance { lower, upper, local1, local2, world1, world2, ..*contact }
}

/// A point of the bodies' manifold, from one of the polyhedra's. Where the gap of these is beyond the doubles it is that of the
/// contact, the bodies', and so is the bodies' gap.
pub fn point_of_bodies(
    radii: &Radii,
    poses: [&Pose; 2],
    contact: &SignedDistance,
    point: &ManifoldPoint,
) -> ManifoldPoint {
    let points = PlacedPoints { local: [point.local1, point.local2], world: [point.world1, point.world2] };
    let points = moved(&points, poses, &contact.normal, radii.outwards());
    let ([local1, local2], [world1, world2]) = (points.local, points.world);
    let [gap_lower, gap_upper] = if point.gap_upper == f64::INFINITY {
        [contact.lower, contact.upper]
    } else {
        radii.off([point.gap_lower, point.gap_upper])
    };
    ManifoldPoint { local1, local2, world1, world2, gap_lower, gap_upper, ..*point }
}
