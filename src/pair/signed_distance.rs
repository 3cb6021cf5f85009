//! How far apart two objects are, or how deep in each other, as one number: the distance where they are apart, minus the depth
//! where they overlap. One interval goes through zero; so do the normal and the witness points.

use super::cache::PairCache;
use super::ladder;
use super::ladder::{PairQuery, Sweep};
use crate::answer::{Feature, Outcome, PairAnswer, PairConfig, Query};
use crate::base::error::Result;
use crate::base::simd::Lanes;
use crate::depth;
use crate::depth::facets::Proved;
use crate::depth::{DepthAnswer, DepthCache, DepthConfig, DepthPlaces};
use crate::placed::frame::Frame;
use crate::shape::Placed;

/// A pair's memory of its signed distance. Any bytes are safe; all zero is cold. It changes how fast an answer comes, and
/// which of several least directions is said; never the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct SignedDistanceCache {
    distance: PairCache,
    depth: DepthCache,
}

impl SignedDistanceCache {
    /// The cached depth.
    pub(crate) fn depth(&self) -> &DepthCache {
        &self.depth
    }

    /// The same, to keep what was found.
    pub(crate) fn depth_mut(&mut self) -> &mut DepthCache {
        &mut self.depth
    }
}

/// A distance that is negative where objects overlap. Unset numbers are NaN, features of no kind.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SignedDistance {
    /// [`Outcome::Intersecting`] (touching included), [`Outcome::Separated`], or [`Outcome::Beyond`]
    /// `max_distance`: then `lower` is all that is known, which `distance` repeats, and `upper` is infinite.
    pub outcome: Outcome,
    /// The best estimate, `lower ≤ distance ≤ upper`: how far the objects are apart, or minus how deep they are in each other.
    pub distance: f64,
    /// Lower end of the rigorous interval; more than 0 only of objects that are apart, and of all of those.
    pub lower: f64,
    /// Upper end of the rigorous interval; at most 0 of objects that overlap or touch.
    pub upper: f64,
    /// Witness point on object 1, in its local frame.
    pub local1: [f64; 3],
    /// Witness point on object 2, in its local frame.
    pub local2: [f64; 3],
    /// Witness point on object 1, in the world frame; `world1 − world2` is `distance · normal` up to rounding.
    pub world1: [f64; 3],
    /// Witness point on object 2, in the world frame.
    pub world2: [f64; 3],
    /// Unit normal in the world frame, from object 2 to object 1: moving object 1 along it makes the distance grow as much.
    pub normal: [f64; 3],
    /// Feature that holds the witness point of object 1.
    pub feature1: Feature,
    /// Feature that holds the witness point of object 2.
    pub feature2: Feature,
}

impl Default for SignedDistance {
    fn default() -> Self {
        SignedDistance::from(&PairAnswer::UNSAID)
    }
}

/// The signed distance of objects that are apart.
impl From<&PairAnswer> for SignedDistance {
    fn from(answer: &PairAnswer) -> Self {
        let &PairAnswer { outcome, distance, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
        let &PairAnswer { feature1, feature2, .. } = answer;
        SignedDistance { outcome, distance, lower, upper, local1, local2, world1, world2, normal, feature1, feature2 }
    }
}

/// The signed distance of objects that intersect.
impl From<&DepthAnswer> for SignedDistance {
    fn from(answer: &DepthAnswer) -> Self {
        let &DepthAnswer { outcome, depth, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
        let &DepthAnswer { feature1, feature2, .. } = answer;
        SignedDistance {
            outcome,
            distance: -depth,
            lower: -upper,
            upper: -lower,
            local1,
            local2,
            world1,
            world2,
            normal,
            feature1,
            feature2,
        }
    }
}

/// The signed distance of a pair whose depth a facet proves: that of the depth's answer.
#[inline(always)]
pub(crate) fn fill_at_rest<L: Lanes>(answer: &mut SignedDistance, frame: &Frame<L>, proved: &Proved<L>) {
    answer.outcome = Outcome::Intersecting;
    (answer.lower, answer.distance, answer.upper) = (-proved.upper, -proved.depth, -proved.lower);
    let SignedDistance { local1, local2, world1, world2, normal, feature1, feature2, .. } = answer;
    let places = DepthPlaces { direction: proved.direction, points: proved.points, features: proved.features };
    places.fill(frame, [local1, local2, world1, world2, normal], [feature1, feature2]);
}

/// The signed distance of two polyhedra; that of the bodies, where what is swept over them has settled it.
///
/// # Errors
/// As of [`signed_distance`](crate::pair::signed_distance).
pub(crate) fn of_polyhedra(
    bodies: &[Placed; 2],
    cache: &mut SignedDistanceCache,
    config: &PairConfig,
    sweep: &mut impl Sweep,
    answer: &mut SignedDistance,
) -> Result<()> {
    // The query that matches the last outcome runs first.
    if cache.depth.expects_overlap() {
        if overlaps(bodies, cache, answer)? {
            return Ok(());
        }
        cache.depth.expect_apart();
    }
    let mut apart = PairAnswer::default();
    let (query, cached, answer_apart) = (Query::Distance, &mut cache.distance, &mut apart);
    ladder::ask(PairQuery { query, bodies, cache: cached, config, answer: answer_apart, sweep: &mut *sweep })?;
    let are_in_each_other = apart.outcome == Outcome::Intersecting && !sweep.has_settled();
    if !(are_in_each_other && overlaps(bodies, cache, answer)?) {
        *answer = SignedDistance::from(&apart);
    }
    Ok(())
}

/// Whether objects overlap, with the answer if they do.
fn overlaps(bodies: &[Placed; 2], cache: &mut SignedDistanceCache, answer: &mut SignedDistance) -> Result<bool> {
    let mut overlap = DepthAnswer::default();
    depth::of_polyhedra(bodies, &mut cache.depth, &DepthConfig::default(), &mut overlap)?;
    let is_there = overlap.outcome == Outcome::Intersecting;
    if is_there {
        *answer = SignedDistance::from(&overlap);
    }
    Ok(is_there)
}
