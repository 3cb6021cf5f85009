//! The queries of a pair.

use super::cache::PairCache;
use super::ladder::{self, NoBalls, PairQuery};
use super::signed_distance::{self, SignedDistance, SignedDistanceCache};
use super::swept;
#[cfg(doc)]
use super::{DecidedBy, Outcome};
use crate::answer::{PairAnswer, PairConfig, Query, Radii};
use crate::base::error::Result;
use crate::base::simd::environment::with_default;
use crate::depth::{DepthAnswer, DepthCache, DepthConfig, of_polyhedra};
use crate::shape::Placed;

/// Exact distance with its interval, witness points, normal and features.
///
/// For an intersecting pair the distance and its interval are 0, and `proof` holds the vertex pairs. Points, normal and features
/// stay unset (see [`contact()`]). For a pair beyond `config.max_distance` only `lower` is set.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted (not finite, a reflection, an entry of RᵀR −
/// I above [`ROTATION_LIMIT`](crate::base::math::ROTATION_LIMIT)), [`Error::Argument`](crate::base::error::Error::Argument) for a
/// `max_distance` that is NaN or negative. Then `answer` and `cache` are as they were.
/// [`Error::Memory`](crate::base::error::Error::Memory) may leave an unset answer. The fields of `config` that only [`approximate`]
/// uses are ignored.
pub fn distance(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_with(Query::Distance, &bodies, cache, config, answer)
}

/// The verdict alone: [`Outcome::Separated`] with `lower` > 0 and a valid but not tight `upper`, or [`Outcome::Intersecting`]; and
/// [`Outcome::Beyond`] with a finite `config.max_distance`.
///
/// # Errors
/// As [`distance`].
pub fn intersection(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_with(Query::Intersection, &bodies, cache, config, answer)
}

/// As [`distance`], and for an intersecting pair a common point (as witness points of both objects), the unit normal along which
/// the objects overlap least and the features that meet there: those of [`depth()`], which reports how deep, and where.
///
/// # Errors
/// As [`distance`].
pub fn contact(bodies: [Placed; 2], cache: &mut PairCache, config: &PairConfig, answer: &mut PairAnswer) -> Result<()> {
    query_with(Query::Contact, &bodies, cache, config, answer)
}

/// The distance as narrow as asked for, or as exact answers are: the interval holds the true distance, and the query stops as
/// soon as `upper − lower` ≤ max(`config.absolute_error`, `config.relative_error` · `lower`). Both 0 ask for the exact
/// distance.
///
/// The verdict is as certain as that of [`distance`], unless the step budget ran out ([`DecidedBy::Budget`]). Points and features
/// stay unset in an answer that comes from maps of support functions or from levels of detail. For a pair beyond
/// `config.max_distance` only `lower` is set.
///
/// # Errors
/// As [`distance`]; [`Error::Argument`](crate::base::error::Error::Argument) for an error tolerance that is NaN or negative and a
/// step budget of 0.
pub fn approximate(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_with(Query::Approximate, &bodies, cache, config, answer)
}

/// As [`intersection`], by marching as Ehmann & Lin had it: neither bounding spheres nor the last separating axis are asked. For
/// the figures.
///
/// # Errors
/// As [`distance`].
#[doc(hidden)]
pub fn intersection_by_marching(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if Radii::are_there(&bodies) {
        return swept::query(Query::Intersection, &bodies, cache, config, answer);
    }
    ladder::intersection_by_marching(&bodies, cache, config, answer)
}

#[inline(always)]
fn query_with(
    query: Query,
    bodies: &[Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if Radii::are_there(bodies) {
        return swept::query(query, bodies, cache, config, answer);
    }
    ladder::ask(PairQuery { query, bodies, cache, config, answer, sweep: &mut NoBalls })
}

/// How deep two objects are in each other, see [`DepthAnswer`]. Separated objects are detected, but only a normal that separates
/// them is reported: [`distance`] tells how far apart they are.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted, as in [`distance`], and
/// [`Error::Argument`](crate::base::error::Error::Argument) for a member of `config` that is out of range. Then `answer` and
/// `cache` are as they were.
pub fn depth(
    bodies: [Placed; 2],
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    if Radii::are_there(&bodies) {
        return with_default(|| swept::depth(bodies, &Radii::of_both(&bodies), cache, config, answer));
    }
    of_polyhedra(&bodies, cache, config, answer)
}

/// The distance of objects that are apart, minus the depth of those that intersect; each is as certain and as narrow as those of
/// [`distance`] and [`depth()`]. For a pair beyond `config.max_distance` only `lower` is reported.
///
/// The query uses `max_distance`, the start and the levels of `config`.
///
/// # Errors
/// As of [`distance`]; then `answer` is as it was.
pub fn signed_distance(
    bodies: [Placed; 2],
    cache: &mut SignedDistanceCache,
    config: &PairConfig,
    answer: &mut SignedDistance,
) -> Result<()> {
    if Radii::are_there(&bodies) {
        return with_default(|| swept::signed_distance(&bodies, &Radii::of_both(&bodies), cache, config, answer));
    }
    signed_distance::of_polyhedra(&bodies, cache, config, &mut NoBalls, answer)
}
