//! The queries of a pair.

use super::answer::PairAnswer;
use super::cache::PairCache;
use super::config::{PairConfig, Query};
use super::ladder::{self, Glances, PairQuery};
use super::placed::Placed;
#[cfg(doc)]
use super::{DecidedBy, Outcome, depth};
use crate::base::error::Result;
use crate::base::simd::environment::{self, with_default};

/// Exact distance with its interval, witness points, normal and features.
///
/// Of an intersecting pair the distance and its interval are 0, `proof` holds the vertex pairs; points, normal and features stay
/// unset (see [`contact()`]). Of a pair beyond `config.distance_tolerance` only `lower` is set.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted (not finite, a reflection, an entry of RᵀR − I
/// above `config.rotation_limit`), [`Error::Argument`](crate::base::error::Error::Argument) for a tolerance that is NaN or negative
/// and for a rotation limit that is not from 0 to [`ROTATION_LIMIT`](crate::base::math::ROTATION_LIMIT). Then `answer` and `cache`
/// are as they were. What of `config` is for [`approximate`] alone is not looked at.
pub fn distance(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_with(Query::Distance, Glances::Asked, bodies, cache, config, answer)
}

/// The verdict alone: [`Outcome::Separated`] with `lower` > 0 and a valid but not tight `upper`, or [`Outcome::Intersecting`]; and
/// [`Outcome::Beyond`] with a finite `config.distance_tolerance`.
///
/// # Errors
/// As [`distance`].
pub fn intersection(
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_with(Query::Intersection, Glances::Asked, bodies, cache, config, answer)
}

/// As [`distance`], and for an intersecting pair a common point (as witness points of both objects), the unit normal along which
/// the objects overlap least and the features that meet there: those of [`depth()`], which says how deep, and where.
///
/// # Errors
/// As [`distance`].
pub fn contact(bodies: [Placed; 2], cache: &mut PairCache, config: &PairConfig, answer: &mut PairAnswer) -> Result<()> {
    query_with(Query::Contact, Glances::Asked, bodies, cache, config, answer)
}

/// The distance as narrow as asked for, or as exact answers are: the interval holds the true distance, and the query stops as
/// soon as `upper − lower` ≤ max(`config.absolute_error`, `config.relative_error` · `lower`). Both 0 ask for the exact
/// distance.
///
/// The verdict is as certain as that of [`distance`], unless the step budget ran out ([`DecidedBy::Budget`]). Points and
/// features stay unset in an answer that comes from maps of support functions or from levels of detail. Of a pair beyond `config.distance_tolerance` only
/// `lower` is set.
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
    query_with(Query::Approximate, Glances::Asked, bodies, cache, config, answer)
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
    query_with(Query::Intersection, Glances::LeftOut, bodies, cache, config, answer)
}

#[inline(always)]
fn query_with(
    query: Query,
    glances: Glances,
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    let mut pair = PairQuery::new(query, &bodies, cache, config, answer)?;
    if !environment::is_default() {
        return with_default(move || ladder::answer(&mut pair, glances));
    }
    ladder::answer(&mut pair, glances)
}
