//! Queries of bodies over which balls are swept (`ShapeOptions::swept_radius`): those of the polyhedra, and the radii off what
//! they answer. If the interval does not tell on which side of 0 or of the tolerance the rest is, integers do.

use super::answer::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer};
use super::cache::PairCache;
use super::config::{PairConfig, Query};
use super::contact::PlacedPoints;
use super::depth::{self, DepthAnswer, DepthCache, DepthConfig, DepthEnding};
use super::ladder::{self, Glances};
use super::placed::Placed;
use super::radii::{Radii, moved};
use super::signed_distance::{SignedDistance, SignedDistanceCache, of_polyhedra};
use crate::base::error::Result;
use crate::base::math::{Vector, clamp};
use crate::base::memory::in_integers;
use crate::base::simd::environment::with_default;
use crate::solve::exact::{self, ExactDistance};
use std::cmp::Ordering;

const NOWHERE: [f64; 3] = [f64::NAN; 3];

/// As the query of the polyhedra.
#[cold]
#[inline(never)]
pub(super) fn query(
    query: Query,
    bodies: [Placed; 2],
    radii: &Radii,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    config.check(query)?;
    let mut found = PairAnswer::default();
    let is_verdict = query == Query::Intersection && config.distance_tolerance == f64::INFINITY;
    let enough = if is_verdict { 0.0 } else { config.distance_tolerance };
    let of_polyhedra = PairConfig { distance_tolerance: radii.with(enough), ..*config };
    // No verdict tells whether polyhedra are nearer than the radii.
    let asked = if query == Query::Intersection { Query::Distance } else { query };
    ladder::ask(asked, Glances::Asked, &bodies, cache, &of_polyhedra, &mut found)?;
    if query == Query::Approximate && is_too_wide(&found, radii, config) {
        ladder::ask(Query::Distance, Glances::Asked, &bodies, cache, &of_polyhedra, &mut found)?;
    }
    *answer = in_integers(|| less(query, bodies, radii, enough, &found))?;
    if is_verdict && answer.outcome == Outcome::Beyond {
        answer.outcome = Outcome::Separated;
    }
    Ok(())
}

/// Whether an interval was narrow enough for the polyhedra, and is not for the remaining distance, whose `lower` is less.
fn is_too_wide(found: &PairAnswer, radii: &Radii, config: &PairConfig) -> bool {
    let [lower, upper] = radii.off([found.lower, found.upper]);
    let width = upper - lower;
    let may_be_wide = config.absolute_error > 0.0 || config.relative_error > 0.0;
    let is_narrow = width <= config.absolute_error || (lower > 0.0 && width <= config.relative_error * lower);
    // For polyhedra that intersect, the answer is already complete.
    let is_apart = found.outcome == Outcome::Separated && upper > 0.0;
    may_be_wide && is_apart && !is_narrow && found.decided_by != DecidedBy::Budget
}

/// The answer about the bodies, from that about the polyhedra.
fn less(query: Query, bodies: [Placed; 2], radii: &Radii, tolerance: f64, found: &PairAnswer) -> PairAnswer {
    match found.outcome {
        Outcome::None | Outcome::Intersecting => return *found,
        Outcome::Undecided => return undecided(radii, found),
        Outcome::Separated if found.decided_by == DecidedBy::Budget => {
            let [lower, upper] = radii.off([found.lower, found.upper]);
            if lower <= 0.0 && upper > 0.0 {
                return undecided(radii, found);
            }
        }
        Outcome::Separated | Outcome::Beyond => {}
    }
    let signed = of_bodies(bodies, radii, tolerance, &found.into());
    let mut answer = PairAnswer { statistics: found.statistics, decided_by: found.decided_by, ..PairAnswer::UNSAID };
    answer.outcome = signed.outcome;
    if signed.outcome == Outcome::Intersecting {
        (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
        if query == Query::Contact {
            fill_common_point(&mut answer, bodies, radii, found);
        }
        return answer;
    }
    let SignedDistance { distance, lower, upper, local1, local2, world1, world2, normal, .. } = signed;
    let SignedDistance { feature1, feature2, .. } = signed;
    PairAnswer { distance, lower, upper, local1, local2, world1, world2, normal, feature1, feature2, ..answer }
}

/// The answer for a pair that a budget left undecided.
fn undecided(radii: &Radii, found: &PairAnswer) -> PairAnswer {
    let [_, upper] = radii.off([found.lower, found.upper]);
    let said = PairAnswer { decided_by: found.decided_by, statistics: found.statistics, ..PairAnswer::UNSAID };
    if upper <= 0.0 {
        return PairAnswer { outcome: Outcome::Intersecting, distance: 0.0, lower: 0.0, upper: 0.0, ..said };
    }
    let distance = clamp(found.distance - radii.upper, 0.0, upper);
    PairAnswer { outcome: Outcome::Undecided, distance, lower: 0.0, upper, ..said }
}

/// For polyhedra that are apart and bodies that are not: the middle of the part of the shortest connection that both bodies
/// cover. It is one point on the line between the witness points. The normal may lead beside that line: for thin parallel bodies
/// by 1e-8 of the way.
fn fill_common_point(answer: &mut PairAnswer, bodies: [Placed; 2], radii: &Radii, found: &PairAnswer) {
    let [radius1, radius2] = radii.each;
    let from2 = 0.5 * ((found.distance - radius1).max(0.0) + found.distance.min(radius2));
    let share = clamp(from2 / found.distance, 0.0, 1.0);
    let points = PlacedPoints { local: [found.local1, found.local2], world: [found.world1, found.world2] };
    let poses = bodies.map(|body| body.pose);
    // An eighth of everything, so that terms which cancel cannot overflow.
    let [place1, place2] = poses.map(|pose| 0.125 * pose.translation());
    let [arm1, arm2] = [0, 1].map(|i| poses[i].rotate(&(0.125 * Vector::from(points.local[i]))));
    let eighth = (place1 - place2) + (arm1 - arm2);
    let points = moved(&points, poses, &eighth.into(), [8.0 * (share - 1.0), 8.0 * share]);
    ([answer.local1, answer.local2], [answer.world1, answer.world2]) = (points.local, points.world);
    (answer.normal, answer.feature1, answer.feature2) = (found.normal, found.feature1, found.feature2);
}

/// How deep bodies are in each other, from the polyhedra's depth, or from their distance where they are apart.
#[cold]
#[inline(never)]
pub(super) fn depth(
    bodies: [Placed; 2],
    radii: &Radii,
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    let mut found = DepthAnswer::default();
    depth::of_polyhedra(&bodies, cache, config, &mut found)?;
    let (mut of_polyhedra, mut ending) = (SignedDistance::from(&found), found.ending);
    if found.outcome != Outcome::Intersecting {
        let within = PairConfig {
            distance_tolerance: radii.upper,
            rotation_limit: config.rotation_limit,
            ..PairConfig::default()
        };
        let mut apart = PairAnswer::default();
        ladder::ask(Query::Distance, Glances::Asked, &bodies, &mut PairCache::default(), &within, &mut apart)?;
        (of_polyhedra, ending) = ((&apart).into(), DepthEnding::Narrow);
    }
    let signed = in_integers(|| with_default(|| of_bodies(bodies, radii, 0.0, &of_polyhedra)))?;
    let statistics = found.statistics;
    let SignedDistance { normal, feature1, feature2, .. } = signed;
    if signed.outcome != Outcome::Intersecting {
        let (outcome, ending) = (Outcome::Separated, DepthEnding::Separated);
        let nothing = DepthAnswer { outcome, ending, depth: 0.0, lower: 0.0, upper: 0.0, normal, ..Default::default() };
        *answer = DepthAnswer { statistics, ..nothing };
        return Ok(());
    }
    let SignedDistance { local1, local2, world1, world2, .. } = signed;
    *answer = DepthAnswer {
        outcome: Outcome::Intersecting,
        ending,
        // No −0.
        depth: 0.0 - signed.distance,
        lower: 0.0 - signed.upper,
        upper: 0.0 - signed.lower,
        local1,
        local2,
        world1,
        world2,
        normal,
        feature1,
        feature2,
        statistics,
    };
    Ok(())
}

/// The signed distance, from that of the polyhedra.
#[cold]
#[inline(never)]
pub(super) fn signed_distance(
    bodies: [Placed; 2],
    radii: &Radii,
    cache: &mut SignedDistanceCache,
    config: &PairConfig,
    answer: &mut SignedDistance,
) -> Result<()> {
    config.check(Query::Distance)?;
    let mut found = SignedDistance::default();
    let grown = PairConfig { distance_tolerance: radii.with(config.distance_tolerance), ..*config };
    of_polyhedra(&bodies, cache, &grown, &mut found)?;
    *answer = in_integers(|| with_default(|| of_bodies(bodies, radii, config.distance_tolerance, &found)))?;
    Ok(())
}

/// The signed distance of bodies from that of their polyhedra, which is beyond the tolerance only if the bodies are.
fn of_bodies(bodies: [Placed; 2], radii: &Radii, tolerance: f64, found: &SignedDistance) -> SignedDistance {
    let mut truth = Truth { bodies, of_polyhedra: None };
    let mut interval = radii.off([found.lower, found.upper]);
    let mut is_apart = interval[0] > 0.0;
    if !is_apart && interval[1] >= 0.0 {
        (is_apart, interval) = sign(truth.get(), radii, interval);
    }
    let [lower, upper] = interval;
    if is_apart && (found.outcome == Outcome::Beyond || truth.is_beyond(radii, tolerance, interval)) {
        let lower = lower.max(tolerance.min(f64::MAX));
        let (distance, upper) = (lower, f64::INFINITY);
        return without_points(&SignedDistance { outcome: Outcome::Beyond, distance, lower, upper, ..*found });
    }
    let upper = if is_apart { upper.min(tolerance) } else { upper };
    let points = PlacedPoints { local: [found.local1, found.local2], world: [found.world1, found.world2] };
    let points = moved(&points, bodies.map(|body| body.pose), &found.normal, radii.outwards());
    let ([local1, local2], [world1, world2]) = (points.local, points.world);
    let outcome = if is_apart { Outcome::Separated } else { Outcome::Intersecting };
    let distance = clamp(found.distance - radii.each[0] - radii.each[1], lower, upper);
    SignedDistance { outcome, distance, lower, upper, local1, local2, world1, world2, ..*found }
}

/// Whether bodies are apart whose polyhedra are apart by a distance, and the part of an interval around 0 where their signed
/// distance is.
#[cold]
pub(super) fn sign(of_polyhedra: &ExactDistance, radii: &Radii, [lower, upper]: [f64; 2]) -> (bool, [f64; 2]) {
    match (of_polyhedra.excess(&radii.each), of_polyhedra.compare_sum(&radii.each)) {
        (Some((least, most)), _) => (true, [least.max(lower), most.min(upper)]),
        (None, Ordering::Equal) => (false, [0.0, 0.0]),
        (None, _) => (false, [lower, 0.0]),
    }
}

fn without_points(answer: &SignedDistance) -> SignedDistance {
    const NO_FEATURE: Feature = Feature { kind: FeatureKind::None, ids: [0; 2] };
    let (local1, local2, world1, world2) = (NOWHERE, NOWHERE, NOWHERE, NOWHERE);
    SignedDistance { local1, local2, world1, world2, feature1: NO_FEATURE, feature2: NO_FEATURE, ..*answer }
}

/// The distance of the polyhedra in integers, found when it is first asked for.
struct Truth<'a> {
    bodies: [Placed<'a>; 2],
    of_polyhedra: Option<ExactDistance>,
}

impl Truth<'_> {
    fn get(&mut self) -> &ExactDistance {
        let [body1, body2] = self.bodies;
        self.of_polyhedra.get_or_insert_with(|| {
            exact::distance(body1.shape.polyhedron(), body1.pose, body2.shape.polyhedron(), body2.pose, &[])
        })
    }

    /// Whether bodies are farther apart than the tolerance, if the interval of their distance does not tell.
    fn is_beyond(&mut self, radii: &Radii, tolerance: f64, [lower, upper]: [f64; 2]) -> bool {
        if lower > tolerance || upper <= tolerance {
            return lower > tolerance;
        }
        let [radius1, radius2] = radii.each;
        self.get().compare_sum(&[tolerance, radius1, radius2]).is_gt()
    }
}
