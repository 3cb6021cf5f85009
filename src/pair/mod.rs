//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns. [`ladder`] shows every
//! way in which an answer comes about.

mod answer;
mod contact;
mod placed;
#[doc(hidden)]
pub mod start;
mod descent;
mod config;
mod cache;
mod depth;
mod query;
mod acceptance;
mod glance;
mod attempt;
mod decision;
mod levels;
mod level_glance;
mod ladder;
mod manifold;
pub mod verify;

use crate::base::error::Result;
use crate::base::simd::environment::{self, with_default};

pub use answer::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, Statistics};
pub use cache::PairCache;
pub(crate) use config::check_accuracy;
pub use config::{Levels, PairConfig, Start};
pub(crate) use contact::{label, normalised};
pub use depth::{DepthAnswer, DepthCache, DepthConfig, DepthEnding, DepthStatistics, depth};
pub use descent::Refinement;
use ladder::climb;
pub(crate) use manifold::{Known, Reference, Sink, manifold_into, manifold_of};
pub use manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, manifold};
pub use placed::Placed;
use query::PairQuery;
pub use query::Query;
#[doc(hidden)]
pub use query::Rungs;

/// Exact distance with its interval, witness points, normal and features.
///
/// Of an intersecting pair the distance and its interval are 0, `proof` holds the vertex pairs; points, normal and features are
/// not said (see [`contact()`]). Of a pair beyond `config.distance_tolerance` only `lower` is said.
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
    query_with(Query::Distance, Rungs::ALL, bodies, cache, config, answer)
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
    query_with(Query::Intersection, Rungs::ALL, bodies, cache, config, answer)
}

/// As [`distance`], and for an intersecting pair a common point (as witness points of both objects), the unit normal along which
/// the objects overlap least and the features that meet there: those of [`depth()`], which says how deep, and where.
///
/// # Errors
/// As [`distance`].
pub fn contact(bodies: [Placed; 2], cache: &mut PairCache, config: &PairConfig, answer: &mut PairAnswer) -> Result<()> {
    query_with(Query::Contact, Rungs::ALL, bodies, cache, config, answer)
}

/// The distance as narrow as asked for, or as exact answers are: the interval holds the true distance, and the query stops as
/// soon as `upper − lower` ≤ max(`config.absolute_error`, `config.relative_error` · `lower`). Both 0 ask for the exact
/// distance.
///
/// The verdict is as certain as that of [`distance`], unless the step budget ran out ([`DecidedBy::Budget`]). Points and
/// features are not said of an answer that comes from levels of detail. Of a pair beyond `config.distance_tolerance` only
/// `lower` is said.
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
    query_with(Query::Approximate, Rungs::ALL, bodies, cache, config, answer)
}

/// As the function of that query, with some rungs of the ladder left out: for benchmarks and tests.
///
/// # Errors
/// As the function.
#[doc(hidden)]
#[inline(always)]
pub fn query_with(
    query: Query,
    rungs: Rungs,
    bodies: [Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(move || climb(&mut PairQuery { query, bodies: &bodies, cache, config, answer }, rungs));
    }
    climb(&mut PairQuery { query, bodies: &bodies, cache, config, answer }, rungs)
}
