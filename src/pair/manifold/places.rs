//! The points of a manifold: where outlines have corners in common, seen along the normal, and what is said of them.

use super::answer::ManifoldPoint;
use super::clip::{CommonCorner, Precision, Spot, common_part};
use super::id::id_of;
use super::outline::Outline;
use super::overlay::Overlay;
use crate::base::math::{Pose, Vector};
use crate::pair::answer::{Feature, FeatureKind};
use crate::pair::contact::{PlacedPoints, label, placed_points};
use crate::polyhedron::Polyhedron;
use crate::solve::state::FeatureId;

/// Two outlines seen along the normal, and the pair of witness points.
pub struct View<'a> {
    pub outlines: [Outline<'a>; 2],
    pub polyhedra: [&'a Polyhedron; 2],
    pub poses: [&'a Pose; 2],
    pub precision: Precision,
    pub margin: f64,
    /// The pair of witness points, and where they are.
    pub witness: &'a ManifoldPoint,
    pub witness_spots: [Vector; 2],
}

/// What a point is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// A corner of what both patches cover.
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
    /// Fills what holds no place yet.
    pub const NOWHERE: CommonPoint =
        CommonPoint { origin: Origin::Witness, spots: [Vector::new(0.0, 0.0, 0.0); 2], error: 0.0 };

    pub fn gap(&self) -> f64 {
        self.spots[0].z - self.spots[1].z
    }

    /// A number, other than 0, that tells it from others of the same two patches; of very large patches perhaps not from all.
    pub fn key(&self) -> u32 {
        match self.origin {
            Origin::Witness => 1,
            Origin::Corner(CommonCorner::Vertex { body, corner }) => 2 + body as u32 + ((corner as u32) << 2),
            Origin::Corner(CommonCorner::Crossing { sides }) => {
                let [first, second] = sides.map(|side| side as u32);
                (first << 2 ^ second.rotate_right(14)) & !3 | 1 << 31 | 1
            }
        }
    }
}

impl View<'_> {
    /// Calls `visit` with each point whose gap is at most the margin, and last, if others are there and none is as deep, with the
    /// witness points: patches most parallel to the normal need not hold them. How many it were.
    pub fn visit(&self, mut visit: impl FnMut(&CommonPoint)) -> usize {
        let (mut count, mut is_deep) = (0, false);
        let mut look_at = |spot: &Spot| {
            if let Some(place) = self.place(spot)
                && place.gap() - place.error <= self.margin
            {
                is_deep |= place.gap() - place.error <= self.witness.gap_upper + self.precision.rounding;
                count += 1;
                visit(&place);
            }
        };
        match Overlay::of(&self.outlines, &self.precision) {
            Some(overlay) => overlay.spots().iter().for_each(&mut look_at),
            None => common_part(&self.outlines, &self.precision, look_at),
        }
        if count > 0 && !is_deep {
            let error = 0.5 * (self.witness.gap_upper - self.witness.gap_lower);
            visit(&CommonPoint { origin: Origin::Witness, spots: self.witness_spots, error });
            count += 1;
        }
        count
    }

    fn place(&self, spot: &Spot) -> Option<CommonPoint> {
        let rounding = self.precision.rounding;
        let mut spots = spot.spots;
        let error = match spot.corner {
            CommonCorner::Vertex { body, .. } => {
                let (height, error) = self.outlines[1 - body].height_at(spots[0].x, spots[0].y, rounding)?;
                spots[1 - body].z = height;
                error + self.outlines[body].slack() + rounding
            }
            CommonCorner::Crossing { .. } => {
                let [first, second] = self.outlines.each_ref().map(Outline::slack);
                spot.error + first + second + 2.0 * rounding
            }
        };
        error.is_finite().then_some(CommonPoint { origin: Origin::Corner(spot.corner), spots, error })
    }

    pub fn point(&self, place: &CommonPoint) -> ManifoldPoint {
        let Origin::Corner(corner) = place.origin else { return *self.witness };
        let centred = [0, 1].map(|i| match corner {
            CommonCorner::Vertex { body, corner } if body == i => {
                let vertex = self.outlines[i].vertex(corner);
                self.polyhedra[i].vertices[vertex as usize].position
            }
            // R has an inverse: det R > 0.
            _ => self.outlines[i].local(&place.spots[i]).unwrap_or_else(Vector::zeros),
        });
        let features = [0, 1].map(|i| self.feature(corner, i, &centred[i]));
        let PlacedPoints { local, world } = placed_points(self.polyhedra, self.poses, &centred);
        let gap = place.gap();
        ManifoldPoint {
            local1: local[0],
            local2: local[1],
            world1: world[0],
            world2: world[1],
            gap_lower: gap - place.error,
            gap_upper: gap + place.error,
            feature1: features[0],
            feature2: features[1],
            id: id_of(&features[0], &features[1]),
        }
    }

    /// What holds the point on a body: its own vertex, its side, or its patch.
    fn feature(&self, corner: CommonCorner, body: usize, point: &Vector) -> Feature {
        let (outline, polyhedron) = (&self.outlines[body], self.polyhedra[body]);
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
