//! Pairs at rest: the facet that proved a depth before, or where it is small beside the depth a pyramid, for later queries.

use super::answer::{DepthAnswer, DepthEnding, DepthStatistics};
use super::cache::{DepthCache, PYRAMIDS};
use crate::answer::{Feature, Outcome, contact};
use crate::base::math::{Pose, Vector, clamp};
use crate::base::simd::{self, Kernel, Lanes, Work};
use crate::depth::facets::{self, Facet, Proved};
use crate::depth::polytope::{self, PairRounding, ProofFailure, Pyramid, Rest};
use crate::placed::Pair;
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

/// Answers by an earlier pyramid, if one still proves a depth.
#[inline(always)]
pub fn look_at_pyramids<L: Lanes>(
    frame: &Frame<L>,
    poses: [&Pose; 2],
    cache: &mut DepthCache,
    answer: &mut DepthAnswer,
) -> bool {
    if !cache.has_pyramid() {
        return false;
    }
    let rounding = PairRounding::of(frame);
    match cache.pyramid(0).prove(frame, &rounding) {
        Ok(rest) => {
            fill(answer, frame, poses, cache, &rest);
            true
        }
        Err(failure) => L::out_of_line(&mut LookFurther { frame, rounding: &rounding, poses, cache, answer, failure }),
    }
}

/// The remaining steps after the first pyramid has failed: to move it, and to try the second one.
struct LookFurther<'a, L> {
    frame: &'a Frame<'a, L>,
    rounding: &'a PairRounding,
    poses: [&'a Pose; 2],
    cache: &'a mut DepthCache,
    answer: &'a mut DepthAnswer,
    failure: ProofFailure,
}

impl<L: Lanes> Work for LookFurther<'_, L> {
    type Output = bool;

    #[inline(always)]
    fn run(&mut self) -> bool {
        let LookFurther { frame, rounding, poses, cache, answer, failure } = self;
        for place in 0..PYRAMIDS {
            let mut failure = *failure;
            if place > 0 {
                match cache.pyramid(place).prove(frame, rounding) {
                    Ok(rest) => {
                        cache.put_first(place);
                        fill(answer, frame, *poses, cache, &rest);
                        return true;
                    }
                    Err(other) => failure = other,
                }
            }
            if failure == ProofFailure::Reach
                && let Some(moved) = moved(frame, rounding, cache.pyramid(place))
                && let Ok(rest) = moved.prove(frame, rounding)
            {
                cache.replace_pyramid(place, &moved);
                cache.put_first(place);
                fill(answer, frame, *poses, cache, &rest);
                return true;
            }
        }
        false
    }
}

/// A pyramid over a face, moved to the vertex below it that is the deepest now.
#[inline(always)]
fn moved<L: Lanes>(frame: &Frame<L>, rounding: &PairRounding, pyramid: &Pyramid) -> Option<Pyramid> {
    let direction = pyramid.direction(frame);
    pyramid.moved_to(polytope::support(frame, rounding, &direction, Some(pyramid.first()), f64::INFINITY).pair)
}

/// The answer of a pair whose first pyramid proves a depth.
#[inline(always)]
fn fill<L: Lanes>(
    answer: &mut DepthAnswer,
    frame: &Frame<L>,
    poses: [&Pose; 2],
    cache: &mut DepthCache,
    rest: &Rest<L>,
) {
    let features = features_of(&Pair { polyhedra: frame.polyhedra(), poses }, cache, rest);
    cache.has_proved();
    (answer.outcome, answer.ending) = (Outcome::Intersecting, DepthEnding::Narrow);
    (answer.lower, answer.upper) = (rest.lower, rest.upper);
    answer.depth = clamp(rest.depth, rest.lower, rest.upper);
    answer.statistics = DepthStatistics { steps: 0, supports: 1, triangles: rest.triangles, exact_iterations: 0 };
    let DepthAnswer { local1, local2, world1, world2, normal, feature1, feature2, .. } = answer;
    let witness = DepthPlaces { direction: rest.direction, points: rest.points, features };
    witness.fill(frame, [local1, local2, world1, world2, normal], [feature1, feature2]);
}

/// The features that hold the witness points of the first pyramid: the earlier ones, if the pyramid is still made of the same
/// vertices.
#[inline(always)]
fn features_of<L: Lanes>(pair: &Pair, cache: &mut DepthCache, rest: &Rest<L>) -> [FeatureId; 2] {
    let [a, b, c] = rest.pairs;
    if let Some(features @ [first, second]) = cache.features(rest.triangle)
        && contact::is_feature_of(pair.polyhedra[0], first, [a[0], b[0], c[0]])
        && contact::is_feature_of(pair.polyhedra[1], second, [a[1], b[1], c[1]])
    {
        return features;
    }
    let (within, normal) = (rest.upper - rest.lower, rest.direction.negate().to_vector());
    let points = [rest.points[0].to_vector(), rest.points[1].to_vector()];
    let features = contact::features_of_pairs(pair, &rest.pairs, &points, &normal, within);
    cache.keep_features(rest.triangle, features);
    features
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

    /// Whether the overlap is small beside a pair of a size. A pyramid seldom lasts where it is not.
    #[inline(always)]
    pub fn is_shallow(&self, size: f64) -> bool {
        self.upper <= SHALLOW * size
    }
}

/// Raises a pyramid over a facet for later queries, if there is one that lasts.
#[inline(always)]
pub fn raise<L: Lanes>(frame: &Frame<L>, cache: &mut DepthCache, facet: LeastFacet) {
    L::out_of_line(&mut Raise { cache, frame, facet });
}

struct Raise<'a, L> {
    cache: &'a mut DepthCache,
    frame: &'a Frame<'a, L>,
    facet: LeastFacet,
}

impl<L: Lanes> Work for Raise<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(&mut self) {
        let Raise { cache, frame, facet: LeastFacet { upper, direction, farthest, .. } } = self;
        if let Some(pyramid) = polytope::raise(frame, direction, *upper, *farthest)
            && pyramid.prove(frame, &PairRounding::of(frame)).is_ok()
        {
            cache.raised(Some(&pyramid));
        } else {
            cache.raised(None);
        }
    }
}

/// In which triangle of its base a pyramid has the witness points of the depth that it proves in the poses of a pair, if it does.
pub fn triangle_of(pair: &Pair, pyramid: &Pyramid) -> Option<u8> {
    simd::dispatch_to_avx2(&mut Proving { pair: *pair, pyramid })
}

struct Proving<'a> {
    pair: Pair<'a>,
    pyramid: &'a Pyramid,
}

impl Kernel for Proving<'_> {
    type Output = Option<u8>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<u8> {
        let frame = Frame::<L>::new(&self.pair);
        if !frame.in_range {
            return None;
        }
        self.pyramid.prove(&frame, &PairRounding::of(&frame)).ok().map(|rest| rest.triangle)
    }
}
