//! The points of a manifold: where outlines have corners in common, seen along the normal, and what is reported for them.

use super::answer::ManifoldPoint;
use super::clip::{CommonCorner, Precision, Spot, common_part};
use super::id::id_of;
use super::outline::Outline;
use crate::answer::{Feature, FeatureKind, PlacedPoints, label, placed_points};
use crate::base::math::{Pose, Vector};
use crate::pair::SignedDistance;
use crate::placed::Pair;
use crate::placed::state::FeatureId;

/// Two outlines seen along the normal, and the pair of witness points.
pub struct View<'a> {
    pub outlines: &'a [Outline<'a>; 2],
    pub poses: [&'a Pose; 2],
    pub precision: Precision,
    pub max_distance: f64,
    /// The pair of witness points, and where they are.
    pub contact: &'a SignedDistance,
    pub witness_spots: [Vector; 2],
}

/// The origin of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A corner of the part that both patches cover.
    Corner(CommonCorner),
    /// The pair of witness points.
    Witness,
}

/// A point, with the heights of both patches there.
#[derive(Debug, Clone, Copy)]
pub struct CommonPoint {
    pub origin: Origin,
    pub spots: [Vector; 2],
    /// By how much the gap may be off.
    pub error: f64,
}

impl CommonPoint {
    /// Fills what holds no place yet: zeros.
    pub const NOWHERE: CommonPoint = CommonPoint {
        origin: Origin::Corner(CommonCorner::Vertex { body: 0, corner: 0 }),
        spots: [Vector::new(0.0, 0.0, 0.0); 2],
        error: 0.0,
    };

    pub fn gap(&self) -> f64 {
        self.spots[0].z - self.spots[1].z
    }

    /// A number, other than 0, that distinguishes it from others of the same two patches; of very large patches perhaps not from
    /// all.
    pub fn key(&self) -> u32 {
        match self.origin {
            Origin::Witness => 1,
            Origin::Corner(CommonCorner::Vertex { body, corner }) => key_of_vertex(body, corner),
            Origin::Corner(CommonCorner::Crossing { sides }) => key_of_crossing(sides),
        }
    }
}

/// See [`CommonPoint::key`].
#[inline(always)]
pub fn key_of_vertex(body: usize, corner: usize) -> u32 {
    2 + body as u32 + ((corner as u32) << 2)
}

/// See [`CommonPoint::key`].
#[inline(always)]
pub fn key_of_crossing(sides: [usize; 2]) -> u32 {
    let [first, second] = sides.map(|side| side as u32);
    (first << 2 ^ second.rotate_right(14)) & !3 | 1 << 31 | 1
}

impl View<'_> {
    /// Calls `visit` with each point whose gap is at most `max_distance`, and last, if others are there and none is as deep, with
    /// the witness points: patches most parallel to the normal need not hold them. How many it were.
    pub fn sweep(&self, mut visit: impl FnMut(&CommonPoint)) -> usize {
        let (mut count, mut is_deep) = (0, false);
        common_part(self.outlines, &self.precision, |spot: &Spot| {
            let place = CommonPoint { origin: Origin::Corner(spot.corner), spots: spot.spots, error: spot.error };
            if self.is_near(&place) {
                is_deep |= self.is_deep(&place);
                count += 1;
                visit(&place);
            }
        });
        if count > 0 && !is_deep {
            visit(&self.witness());
            count += 1;
        }
        count
    }

    /// Whether a place may have a gap of at most `max_distance`, which is then known to within something.
    fn is_near(&self, place: &CommonPoint) -> bool {
        place.error.is_finite() && place.gap() - place.error <= self.max_distance
    }

    /// Whether a place may be as deep as the witness points.
    fn is_deep(&self, place: &CommonPoint) -> bool {
        place.gap() - place.error <= self.contact.upper + self.precision.rounding
    }

    /// The pair of witness points as a place.
    fn witness(&self) -> CommonPoint {
        let error = 0.5 * (self.contact.upper - self.contact.lower);
        CommonPoint { origin: Origin::Witness, spots: self.witness_spots, error }
    }

    /// Says all of a point at a corner of the common part.
    pub fn fill(&self, point: &mut ManifoldPoint, place: &CommonPoint, corner: CommonCorner) {
        let polyhedra = [0, 1].map(|i| self.outlines[i].polyhedron);
        let centred = [0, 1].map(|i| match corner {
            CommonCorner::Vertex { body, corner } if body == i => {
                let vertex = self.outlines[i].vertex(corner);
                polyhedra[i].vertices[vertex as usize].position
            }
            // R has an inverse: det R > 0.
            _ => self.outlines[i].local(&place.spots[i]).unwrap_or_else(Vector::zeros),
        });
        let [feature1, feature2] = [0, 1].map(|i| self.feature(corner, i, &centred[i]));
        let PlacedPoints { local, world } = placed_points(&Pair { polyhedra, poses: self.poses }, &centred);
        [point.local1, point.local2] = local;
        [point.world1, point.world2] = world;
        let gap = place.gap();
        (point.gap_lower, point.gap_upper) = (gap - place.error, gap + place.error);
        (point.feature1, point.feature2) = (feature1, feature2);
        point.id = id_of(&feature1, &feature2);
    }

    /// The feature that holds the point on a body: its own vertex, its side, or its patch.
    fn feature(&self, corner: CommonCorner, body: usize, point: &Vector) -> Feature {
        let outline = &self.outlines[body];
        let polyhedron = outline.polyhedron;
        match corner {
            CommonCorner::Vertex { body: own, corner } if own == body => {
                label(polyhedron, FeatureId::Vertex(outline.vertex(corner)), point)
            }
            CommonCorner::Crossing { sides } => {
                Feature { kind: FeatureKind::Edge, ids: outline.side_labels(sides[body]) }
            }
            CommonCorner::Vertex { .. } => match outline.patch {
                Some(patch) => Feature { kind: FeatureKind::Face, ids: [patch.label(polyhedron), 0] },
                None => Feature { kind: FeatureKind::Edge, ids: outline.side_labels(0) },
            },
        }
    }
}
