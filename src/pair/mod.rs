//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns.

mod answer;
mod normal_cone;
mod contact_direction;
mod contact;
#[doc(hidden)]
pub mod start;
mod descent;
mod config;
mod cache;
mod acceptance;
mod glance;
mod attempt;
mod decision;
mod level_glance;
mod levels;
pub mod verify;

use attempt::Coherent;
pub use cache::PairCache;
pub(crate) use config::check_accuracy;
use config::check_config;
pub use config::{Bounds, Levels, PairConfig, Start};
use glance::Separation;

use crate::base::error::Result;
use crate::base::math::{Pose, clamp};
use crate::base::simd;
use crate::base::simd::environment::{self, with_default};
pub use crate::pair::answer::{Feature, FeatureKind, Outcome, PairAnswer, Statistics, Status};
pub use crate::pair::descent::Refinement;
use crate::polyhedron::Polyhedron;
use crate::shape::Shape;
use crate::solve::certificate::Interval;
use crate::solve::state::State;

/// What is asked of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Query {
    Intersection,
    Distance,
    Contact,
    Approximate,
}

/// Exact distance with its interval, witness points, normal and features.
///
/// Of an intersecting pair the distance and its interval are 0, `proof` holds the vertex pairs; points, normal and features are
/// not said (see [`contact()`]). Of a pair beyond `config.distance_tolerance` only `lower` is said.
///
/// # Errors
/// [`Error::Pose`](crate::base::error::Error::Pose) for a pose that is not accepted (not finite, a reflection, an entry of RᵀR − I
/// above `config.rotation_limit`), [`Error::Argument`](crate::base::error::Error::Argument) for a tolerance that is NaN or negative and
/// for a rotation limit that is not from 0 to [`ROTATION_LIMIT`](crate::base::math::ROTATION_LIMIT). Then `answer` and `cache` are as
/// they were. What of `config` is for [`approximate`] alone is not looked at.
pub fn distance(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(move || distance(shape1, pose1, shape2, pose2, cache, config, answer));
    }
    query(Query::Distance, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// The verdict alone: [`Outcome::Separated`] with `lower` > 0 and a valid but not tight `upper`, or [`Outcome::Intersecting`]; and
/// [`Outcome::Beyond`] with a finite `config.distance_tolerance`.
///
/// # Errors
/// As [`distance`].
pub fn intersection(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(move || intersection(shape1, pose1, shape2, pose2, cache, config, answer));
    }
    query(Query::Intersection, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// As [`distance`], and for an intersecting pair a common point (as witness points of both objects), a unit normal along which
/// the objects overlap little (where they only touch along a face it separates them) and features. It is no least depth, and
/// where the objects overlap it may depend on the cache. Features of objects that touch are those that hold the point; of objects
/// deeper in each other than a millionth of the smaller one's radius they are the faces that reach farthest: of object 1 against
/// the normal, of object 2 along it.
///
/// # Errors
/// As [`distance`].
pub fn contact(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(move || contact(shape1, pose1, shape2, pose2, cache, config, answer));
    }
    query(Query::Contact, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// The distance as narrow as asked for, or as exact answers are: the interval holds the true distance, and the query stops as
/// soon as `upper − lower` ≤ max(`config.absolute_error`, `config.relative_error` · `lower`). Both 0 ask for the exact
/// distance.
///
/// The verdict is as certain as that of [`distance`], unless the step budget ran out ([`Status::BudgetSpent`]). Points and
/// features are not said of an answer that comes from levels of detail. Of a pair beyond `config.distance_tolerance` only
/// `lower` is said.
///
/// # Errors
/// As [`distance`]; [`Error::Argument`](crate::base::error::Error::Argument) for an error tolerance that is NaN or negative and a
/// step budget of 0.
pub fn approximate(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(move || approximate(shape1, pose1, shape2, pose2, cache, config, answer));
    }
    levels::approximate([shape1, shape2], [pose1, pose2], cache, config, answer)
}

#[inline(always)]
fn query(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    // Mostly. A NaN is neither.
    if config.distance_tolerance >= f64::INFINITY && config.admits_rounding() {
        let enough = (query == Query::Intersection).then_some(0.0);
        return query_beyond(query, enough, shapes, poses, cache, config, answer);
    }
    // Arrays of their own: those lent to it would have to live in memory here, too.
    let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
    query_with_limits(query, shapes, poses, cache, config, answer)
}

/// With a distance tolerance, most likely. Out of line, with all that follows.
#[inline(never)]
fn query_with_limits(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if config.distance_tolerance >= 0.0 && config.admits_rounding() {
        return query_beyond(query, Some(config.distance_tolerance), shapes, poses, cache, config, answer);
    }
    query_strictly(query, shapes, poses, cache, config, answer)
}

/// With a rotation limit below rounding, which asks for a closer look at the poses, or with limits that are none.
#[cold]
#[inline(never)]
fn query_strictly(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    check_config(config)?;
    if query == Query::Intersection && levels::help_verdicts(shapes, cache, config) {
        return levels::of_large(query, shapes, poses, cache, config, answer);
    }
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    PairQuery { query, polyhedra, poses, cache, config, answer }.begin(shapes)
}

/// A query that needs to know no more than that the bodies are farther apart than is `enough`, if they are. The distance tolerance
/// is one, and the rotation limit [admits rounding](PairConfig::admits_rounding).
#[inline(always)]
fn query_beyond(
    query: Query,
    enough: Option<f64>,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    // Made in place and lent: moving it would copy pairs of pointers just written as one, which stalls.
    let mut pair = PairQuery { query, polyhedra, poses, cache, config, answer };
    if let Some(enough) = enough
        && pair.is_farther_than(enough)
    {
        return Ok(());
    }
    if (query == Query::Intersection) && levels::help_verdicts(shapes, pair.cache, config) {
        // Arrays of their own: those lent to it would have to live in memory here, too.
        let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
        return levels::of_large(query, shapes, poses, pair.cache, config, pair.answer);
    }
    if polyhedra[0].ordinary & polyhedra[1].ordinary & config.start.asks_cache() {
        if query == Query::Intersection
            && pair.cache.recall_axis(polyhedra).is_some()
            && simd::dispatch(&mut Separation { pair: &mut pair })
        {
            return Ok(());
        }
        match simd::dispatch(&mut Coherent { pair: &mut pair }) {
            Attempt::Done => Ok(()),
            attempt => pair.go_on(attempt, shapes),
        }
    } else {
        pair.begin(shapes)
    }
}

/// What became of an attempt.
enum Attempt {
    /// The answer is there.
    Done,
    /// Marching left it open at this state, or its certificate did at a minimum.
    Open { at: State, is_minimum: bool, steps: u32 },
    /// The cache holds no features that the bodies have.
    Cold,
    /// Poses that are not rigid or not of ordinary magnitude.
    Unusual,
}

/// One query.
struct PairQuery<'a> {
    query: Query,
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    cache: &'a mut PairCache,
    config: &'a PairConfig,
    answer: &'a mut PairAnswer,
}

/// Outcome, interval and best estimate (`distance`, put into the interval) of a separated pair. The interval settles the
/// tolerance: its upper end is beyond it just where the true distance is.
#[inline(always)]
fn set_interval(answer: &mut PairAnswer, interval: &Interval, distance: f64, distance_tolerance: f64) {
    answer.lower = interval.lower;
    answer.proof_count = 0;
    if interval.upper > distance_tolerance {
        answer.outcome = Outcome::Beyond;
        answer.upper = f64::INFINITY;
        answer.distance = interval.lower;
    } else {
        answer.outcome = Outcome::Separated;
        answer.upper = interval.upper;
        answer.distance = clamp(distance, interval.lower, interval.upper);
    }
}
