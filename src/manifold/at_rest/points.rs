//! The corners of the part that two patches have in common, as points of a manifold.

use super::slid::{Seen, Slid};
use crate::answer::{Feature, FeatureKind};
use crate::base::math::Vector;
use crate::base::simd::{Lanes, Work};
use crate::manifold::answer::ManifoldPoint;
use crate::manifold::id::id_of;
use crate::manifold::places::{key_of_crossing, key_of_vertex};
use crate::manifold::reduction::Place;
use crate::placed::frame::Frame;

/// A corner of the common part.
#[derive(Clone, Copy)]
pub struct RestSpot {
    /// Coordinates across the normal; set where one of many is to be chosen.
    pub across: [f64; 2],
    pub gap: f64,
    /// By how much the gap may be off.
    pub error: f64,
    /// A crossing's place along its side of the incident face.
    pub share: f64,
    pub corner: SpotOrigin,
}

/// The origin of a spot.
#[derive(Clone, Copy)]
pub enum SpotOrigin {
    /// A corner of a body's face.
    Of(u8, u8),
    /// Two sides.
    Crossing(u8, u8),
}

impl Place for RestSpot {
    fn across(&self) -> [f64; 2] {
        self.across
    }

    fn gap(&self) -> f64 {
        self.gap
    }

    fn error(&self) -> f64 {
        self.error
    }

    fn key(&self) -> u32 {
        match self.corner {
            SpotOrigin::Of(body, corner) => key_of_vertex(body.into(), corner.into()),
            SpotOrigin::Crossing(first, second) => key_of_crossing([first.into(), second.into()]),
        }
    }
}

/// The corners of a common part.
pub struct Spots<const F: usize> {
    /// A common part has as many corners as both faces.
    pub spots: [[RestSpot; 8]; F],
    pub count: usize,
    /// Whether one may be as deep as the bodies.
    pub is_deep: bool,
    pub max_distance: f64,
    pub deepest: f64,
}

impl<const F: usize> Spots<F> {
    /// Adds one whose gap is at most `max_distance`. `None` where there is no room.
    #[inline(always)]
    pub fn push(&mut self, gap: f64, error: f64, share: f64, corner: SpotOrigin) -> Option<()> {
        if !(error.is_finite() && gap - error <= self.max_distance) {
            return Some(());
        }
        self.is_deep |= gap - error <= self.deepest;
        *self.spots.as_flattened_mut().get_mut(self.count)? = RestSpot { across: [0.0; 2], gap, error, share, corner };
        self.count += 1;
        Some(())
    }

    pub fn all(&mut self) -> &mut [RestSpot] {
        &mut self.spots.as_flattened_mut()[..self.count]
    }
}

/// The parts of a manifold.
pub struct Found<'a, L, const F: usize> {
    pub seen: &'a Seen<'a, L>,
    pub slid: &'a [Slid<F>; 2],
}

impl<L: Lanes, const F: usize> Found<'_, L, F> {
    /// The place of a spot in the axes of the reference's body, along the normal.
    #[inline(always)]
    pub fn seen(&self, spot: &RestSpot) -> L {
        let on = &self.slid[self.seen.reference];
        match spot.corner {
            SpotOrigin::Of(body, corner) if usize::from(body) == self.seen.reference => {
                L::from_vector(&self.seen.corners[self.seen.reference].position(corner.into()))
            }
            SpotOrigin::Of(_, corner) => L::from_vector(&on.place(corner.into())),
            SpotOrigin::Crossing(first, second) => {
                let edge = usize::from(if self.seen.reference == 0 { second } else { first });
                let from = L::from_vector(&on.place(edge));
                let to = L::from_vector(&on.place(self.seen.corners[1 - self.seen.reference].next(edge)));
                to.sub(from).mul_add(L::splat(spot.share), from)
            }
        }
    }

    /// Sets the coordinates of all across the normal.
    #[inline(always)]
    pub fn see_across(&self, frame: &Frame<L>, spots: &mut Spots<F>) {
        let normal = frame.bodies[self.seen.reference].rotate_back(self.seen.out);
        let [x, y, z, _] = self.seen.corners[self.seen.reference].side_plane(0);
        let side = L::from_vector(&Vector::new(x, y, z));
        let aside = normal.negated_mul_add(L::splat(normal.dot(side)), side);
        let first = aside.mul(L::splat(1.0 / aside.dot(aside).sqrt()));
        let second = normal.cross(first);
        for spot in spots.all() {
            let place = self.seen(spot);
            spot.across = [first.dot(place), second.dot(place)];
        }
    }

    /// Says all of a point.
    #[inline(always)]
    pub fn fill(&self, frame: &Frame<L>, labels: [u32; 2], spot: &RestSpot, point: &mut ManifoldPoint) {
        let face = |body: usize| Feature { kind: FeatureKind::Face, ids: [labels[body], 0] };
        let (mut places, features);
        match spot.corner {
            SpotOrigin::Of(body, corner) => {
                let (body, corner) = (usize::from(body), usize::from(corner));
                let own = &self.seen.corners[body];
                let vertex = own.vertex(corner) as usize;
                let label = Feature { kind: FeatureKind::Vertex, ids: [own.polyhedron.vertex_labels[vertex], 0] };
                let other = L::from_vector(&self.slid[1 - body].place(corner));
                places = [L::from_vector(&own.polyhedron.vertices[vertex].position), other];
                features = if body == 0 { [label, face(1)] } else { [face(0), label] };
                if body == 1 {
                    places = [places[1], places[0]];
                }
            }
            SpotOrigin::Crossing(first, second) => {
                let incident = &self.seen.corners[1 - self.seen.reference];
                let edge = usize::from(if self.seen.reference == 0 { second } else { first });
                let from = L::from_vector(&incident.position(edge));
                let to = L::from_vector(&incident.position(incident.next(edge)));
                places = [self.seen(spot), to.sub(from).mul_add(L::splat(spot.share), from)];
                if self.seen.reference == 1 {
                    places = [places[1], places[0]];
                }
                features =
                    [self.seen.corners[0].side_label(first.into()), self.seen.corners[1].side_label(second.into())];
            }
        }
        let [body1, body2] = &frame.bodies;
        places[0].add(L::from_vector(&body1.polyhedron.centre)).store_vector(&mut point.local1);
        places[1].add(L::from_vector(&body2.polyhedron.centre)).store_vector(&mut point.local2);
        body1.rotate_lanes(places[0]).add(body1.translation).store_vector(&mut point.world1);
        body2.rotate_lanes(places[1]).add(body2.translation).store_vector(&mut point.world2);
        (point.gap_lower, point.gap_upper) = (spot.gap - spot.error, spot.gap + spot.error);
        point.id = id_of(&features[0], &features[1]);
        [point.feature1, point.feature2] = features;
    }
}

/// Says all of a point, called by the caller of lanes' code (R2).
pub struct Filling<'a, L, const F: usize> {
    pub found: &'a Found<'a, L, F>,
    pub frame: &'a Frame<'a, L>,
    /// Labels of both patches.
    pub labels: [u32; 2],
    pub spot: &'a RestSpot,
    pub point: &'a mut ManifoldPoint,
}

impl<L: Lanes, const F: usize> Work for Filling<'_, L, F> {
    type Output = ();

    #[inline(always)]
    fn run(&mut self) {
        self.found.fill(self.frame, self.labels, self.spot, self.point);
    }
}
