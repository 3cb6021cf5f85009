//! Pairs at rest: the facet that proved a depth before.

use super::answer::{DepthAnswer, DepthEnding, DepthStatistics};
use super::cache::DepthCache;
use crate::answer::{Feature, Outcome, contact};
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::depth::facets::{self, Facet, Proved};
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::state::FeatureId;

/// A pair rests whose overlap is at most this, over its size …
const SHALLOW: f64 = 1.0 / 64.0;

/// … and whose direction of least overlap has turned by at most the angle of this cosine, 8°, since the last search.
const STEADY: f64 = 0.99;

/// The depth that the facet of before proves, or one near it, for a frame that is in range. It is kept; if none does, the next
/// search decides whether the pair still rests.
#[inline(always)]
pub fn prove_at_rest<L: Lanes>(frame: &Frame<L>, cache: &mut DepthCache) -> Option<Proved<L>> {
    match facets::prove(frame, cache.resting()?) {
        Ok(proved) => {
            cache.rest_on(proved.facet);
            Some(proved)
        }
        Err(last) => {
            cache.rest_on(last);
            None
        }
    }
}

/// Answers by the facet of before, if it proves a depth.
#[inline(always)]
pub fn look_at_facet<L: Lanes>(frame: &Frame<L>, cache: &mut DepthCache, answer: &mut DepthAnswer) -> bool {
    let Some(proved) = prove_at_rest(frame, cache) else { return false };
    (answer.outcome, answer.ending) = (Outcome::Intersecting, DepthEnding::Narrow);
    (answer.lower, answer.depth, answer.upper) = (proved.lower, proved.depth, proved.upper);
    answer.statistics = DepthStatistics { steps: 0, supports: 1 + proved.steps, triangles: 0, exact_iterations: 0 };
    let DepthAnswer { local1, local2, world1, world2, normal, feature1, feature2, .. } = answer;
    let witness = DepthPlaces { direction: proved.direction, points: proved.points, features: proved.features };
    witness.fill(frame, [local1, local2, world1, world2, normal], [feature1, feature2]);
    true
}

/// A depth's place, in centred coordinates.
pub struct DepthPlaces<L> {
    pub direction: L,
    pub points: [L; 2],
    pub features: [FeatureId; 2],
}

impl<L: Lanes> DepthPlaces<L> {
    /// Says the points in both frames, the normal and the features.
    #[inline(always)]
    pub fn fill(
        &self,
        frame: &Frame<L>,
        [local1, local2, world1, world2, normal]: [&mut [f64; 3]; 5],
        features: [&mut Feature; 2],
    ) {
        let ([body1, body2], [point1, point2]) = (&frame.bodies, self.points);
        self.direction.negate().store_vector(normal);
        point1.add(L::from_vector(&body1.polyhedron.centre)).store_vector(local1);
        point2.add(L::from_vector(&body2.polyhedron.centre)).store_vector(local2);
        body1.rotate_lanes(point1).add(body1.translation).store_vector(world1);
        body2.rotate_lanes(point2).add(body2.translation).store_vector(world2);
        *features[0] = contact::label(body1.polyhedron, self.features[0], &point1.to_vector());
        *features[1] = contact::label(body2.polyhedron, self.features[1], &point2.to_vector());
    }
}

/// The facet of least overlap that a search found.
pub struct LeastFacet {
    pub upper: f64,
    pub direction: Vector,
    /// Vertices that reach farthest along the direction, where many would have to be looked at for them.
    pub farthest: VertexPair,
    /// If the search found which it is.
    pub facet: Option<Facet>,
}

impl LeastFacet {
    /// Whether a pair of a size that was least deep along a direction seems to rest.
    #[inline(always)]
    pub fn rests(&self, before: Option<Vector>, size: f64) -> bool {
        let is_steady = |before: Vector| self.direction.dot(&before) > STEADY * before.norm();
        self.is_shallow(size) && before.is_some_and(is_steady)
    }

    /// Whether the overlap is small beside a pair of a size. A facet seldom lasts where it is not.
    #[inline(always)]
    pub fn is_shallow(&self, size: f64) -> bool {
        self.upper <= SHALLOW * size
    }
}
