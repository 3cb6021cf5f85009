//! The pair of witness points as a manifold's point.

use super::answer::ManifoldPoint;
use super::id::id_of;
use super::sink::Sink;
use super::steady::name_by_place;
use crate::body::polyhedron::Polyhedron;
use crate::pair::SignedDistance;

/// The pair of witness points.
pub fn witness(contact: &SignedDistance) -> ManifoldPoint {
    let &SignedDistance { local1, local2, world1, world2, feature1, feature2, .. } = contact;
    let (gap_lower, gap_upper) = (contact.lower, contact.upper);
    let id = id_of(&feature1, &feature2);
    ManifoldPoint { local1, local2, world1, world2, gap_lower, gap_upper, feature1, feature2, id }
}

/// The pair of witness points as the manifold's point.
pub fn push_witness(polyhedra: [&Polyhedron; 2], contact: &SignedDistance, points: &mut Sink) {
    points.push(|point| {
        *point = witness(contact);
        name_by_place(polyhedra, point);
    });
}
