//! Queries of bodies over which balls are swept (`ShapeOptions::swept_radius`). Points and segments have closed forms. Of other
//! bodies the ladder searches among the polyhedra, and takes the radii off as it fills an answer. This file does so with what the
//! ladder leaves open: curved bodies, common points, budgets, and sides that only integers tell.

use super::cache::PairCache;
use super::ladder;
use super::ladder::{BallQuery, Balls, PairQuery};
use super::round::{AnswerPlace, Round, are_round};
use super::signed_distance::{SignedDistance, SignedDistanceCache, of_polyhedra};
use crate::answer::{
    DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, PairConfig, PlacedPoints, Query, Radii, Side, fill_nothing,
    move_points, moved,
};
use crate::base::error::Result;
use crate::base::math::{Vector, clamp};
use crate::base::memory::in_integers;
use crate::base::simd::environment::{self, with_default};
use crate::depth;
use crate::depth::{DepthAnswer, DepthCache, DepthConfig, DepthEnding, DepthStatistics};
use crate::placed::Pair;
use crate::placed::exact::{self, ExactDistance};
use crate::shape::Placed;
use std::cmp::Ordering;

const NOWHERE: [f64; 3] = [f64::NAN; 3];

/// As the query of the polyhedra.
#[inline(never)]
pub(super) fn query(
    query: Query,
    bodies: &[Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !environment::is_default() {
        return with_default(|| self::query(query, bodies, cache, config, answer));
    }
    if !config.is_in_range(query) {
        return Err(config.first_fault());
    }
    let radii = &Radii::of_both(bodies);
    let is_verdict = query == Query::Intersection && config.max_distance == f64::INFINITY;
    let tolerance = if is_verdict { 0.0 } else { config.max_distance };
    if are_round(bodies) {
        // Here a verdict costs no more than a distance.
        let round = Round { bodies, radii, tolerance: config.max_distance };
        if round.answers(AnswerPlace::Pair(query, answer)) {
            return Ok(());
        }
    }
    // With the radii as a tolerance a verdict tells whether polyhedra are nearer, but not with more than that: integers, which tell
    // how near, are not asked of curved bodies.
    let needs_distance = !is_verdict || radii.deviation > 0.0;
    let asked = if query == Query::Intersection && needs_distance { Query::Distance } else { query };
    let of_bodies = match query {
        Query::Intersection if is_verdict => BallQuery::Verdict,
        Query::Intersection => BallQuery::VerdictWithin,
        _ => BallQuery::Distance,
    };
    let mut balls = Balls::new(radii, of_bodies, tolerance);
    // A refusal leaves the answer as it was.
    ladder::ask_checked(PairQuery { query: asked, bodies, cache, config, answer, sweep: &mut balls })?;
    if balls.are_taken_off {
        return Ok(());
    }
    let is_open = query == Query::Approximate && is_too_wide(answer, radii, config);
    if is_open {
        ladder::ask_checked(PairQuery { query: Query::Distance, bodies, cache, config, answer, sweep: &mut balls })
            .inspect_err(|_| *answer = PairAnswer::UNSAID)?;
    }
    if balls.are_taken_off {
        return Ok(());
    }
    if let Err(error) = take_off(query, bodies, radii, tolerance, answer) {
        *answer = PairAnswer::UNSAID;
        return Err(error);
    }
    if is_verdict && answer.outcome == Outcome::Beyond {
        answer.outcome = Outcome::Separated;
    }
    Ok(())
}

/// Whether an interval was narrow enough for the polyhedra, and is not for the bodies.
fn is_too_wide(found: &PairAnswer, radii: &Radii, config: &PairConfig) -> bool {
    // For polyhedra that intersect, the answer is already complete.
    found.outcome == Outcome::Separated
        && found.decided_by != DecidedBy::Budget
        && radii.is_too_wide(radii.off([found.lower, found.upper]), config)
}

/// Makes the answer about the polyhedra one about the bodies.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none.
#[cold]
fn take_off(query: Query, bodies: &[Placed; 2], radii: &Radii, tolerance: f64, answer: &mut PairAnswer) -> Result<()> {
    let interval = [answer.lower, answer.upper];
    match answer.outcome {
        Outcome::None | Outcome::Intersecting => return Ok(()),
        Outcome::Undecided => {
            *answer = undecided(radii, answer);
            return Ok(());
        }
        Outcome::Separated if answer.decided_by == DecidedBy::Budget => {
            let [lower, upper] = radii.off(interval);
            if lower <= 0.0 && upper > 0.0 {
                *answer = undecided(radii, answer);
                return Ok(());
            }
        }
        Outcome::Separated | Outcome::Beyond => {}
    }
    let (side, [lower, upper]) = judge(bodies, radii, tolerance, answer.outcome == Outcome::Beyond, interval)?;
    let found = answer.distance;
    (answer.lower, answer.upper) = (lower, upper);
    match side {
        Side::Beyond => {
            answer.outcome = Outcome::Beyond;
            answer.distance = lower;
            let normal = answer.normal;
            fill_nothing(answer);
            answer.normal = normal;
        }
        Side::Apart | Side::Hidden => {
            answer.outcome = Outcome::Separated;
            if side == Side::Hidden {
                (answer.outcome, answer.lower) = (Outcome::Undecided, 0.0);
            }
            let [lower, upper] = [answer.lower, answer.upper];
            answer.distance = clamp(found - radii.each[0] - radii.each[1], lower, upper).min(f64::MAX);
            // A verdict has none.
            if answer.feature1.kind != FeatureKind::None {
                let PairAnswer { local1, local2, world1, world2, normal, .. } = answer;
                let poses = [bodies[0].pose, bodies[1].pose];
                move_points([local1, local2], [world1, world2], poses, normal, radii.outwards());
            }
        }
        Side::Within => {
            answer.outcome = Outcome::Intersecting;
            (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
            if query == Query::Contact {
                fill_common_point(answer, bodies, radii, found);
            } else {
                fill_nothing(answer);
            }
        }
    }
    Ok(())
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
fn fill_common_point(answer: &mut PairAnswer, bodies: &[Placed; 2], radii: &Radii, distance: f64) {
    let [radius1, radius2] = radii.each;
    let from2 = 0.5 * ((distance - radius1).max(0.0) + distance.min(radius2));
    let share = clamp(from2 / distance, 0.0, 1.0);
    let points = PlacedPoints { local: [answer.local1, answer.local2], world: [answer.world1, answer.world2] };
    let poses = bodies.map(|body| body.pose);
    // An eighth of everything, so that terms which cancel cannot overflow.
    let [place1, place2] = poses.map(|pose| 0.125 * pose.translation());
    let [arm1, arm2] = [0, 1].map(|i| poses[i].rotate(&(0.125 * Vector::from(points.local[i]))));
    let eighth = (place1 - place2) + (arm1 - arm2);
    let points = moved(&points, poses, &eighth.into(), [8.0 * (share - 1.0), 8.0 * share]);
    ([answer.local1, answer.local2], [answer.world1, answer.world2]) = (points.local, points.world);
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
    config.check()?;
    let mut signed = SignedDistance::default();
    if are_round(&bodies) {
        let round = Round { bodies: &bodies, radii, tolerance: 0.0 };
        if round.answers(AnswerPlace::Signed(&mut signed)) {
            fill_depth(answer, &signed, DepthEnding::Narrow, DepthStatistics::default());
            return Ok(());
        }
    }
    // A point or a segment is mostly outside where its ball is inside; a distance takes half the time of a depth that finds that.
    let is_thin = bodies.iter().any(|body| body.shape.polyhedron().dimension < 2);
    let mut found = DepthAnswer { ending: DepthEnding::Narrow, ..DepthAnswer::default() };
    let seem_apart = is_thin || cache.apart().is_some();
    if seem_apart && signed_distance_apart(&bodies, radii, cache, &mut signed)? {
        fill_depth(answer, &signed, found.ending, found.statistics);
        return Ok(());
    }
    depth::of_polyhedra(&bodies, cache, config, &mut found)?;
    if found.outcome != Outcome::Intersecting {
        found.ending = DepthEnding::Narrow;
        signed_distance_apart(&bodies, radii, cache, &mut signed)?;
    } else {
        of_bodies(&bodies, radii, 0.0, &SignedDistance::from(&found), &mut signed)?;
    }
    fill_depth(answer, &signed, found.ending, found.statistics);
    Ok(())
}

/// The signed distance of bodies whose polyhedra are apart; whether these are.
fn signed_distance_apart(
    bodies: &[Placed; 2],
    radii: &Radii,
    cache: &mut DepthCache,
    signed: &mut SignedDistance,
) -> Result<bool> {
    let (mut found, mut from) = (PairAnswer::default(), PairCache::default());
    if let Some(state) = cache.apart() {
        from.remember_features(state);
    }
    let mut balls = Balls::new(radii, BallQuery::SignedDistance, 0.0);
    let (config, query) = (&PairConfig::default(), Query::Distance);
    let (cached, answer) = (&mut from, &mut found);
    ladder::ask_checked(PairQuery { query, bodies, cache: cached, config, answer, sweep: &mut balls })?;
    let are_apart = balls.are_taken_off || found.outcome != Outcome::Intersecting;
    match from.features() {
        Some(state) if are_apart => cache.keep_apart(state),
        _ if cache.apart().is_some() => cache.rest_no_more(),
        _ => {}
    }
    let of_polyhedra = SignedDistance::from(&found);
    if balls.are_taken_off {
        *signed = of_polyhedra;
    } else if are_apart {
        of_bodies(bodies, radii, 0.0, &of_polyhedra, signed)?;
    }
    Ok(are_apart)
}

/// A depth from the signed distance of the bodies; of bodies that may be apart it is from 0 on.
fn fill_depth(answer: &mut DepthAnswer, signed: &SignedDistance, ending: DepthEnding, statistics: DepthStatistics) {
    let &SignedDistance { normal, feature1, feature2, local1, local2, world1, world2, .. } = signed;
    if matches!(signed.outcome, Outcome::Separated | Outcome::Beyond) {
        let (outcome, ending) = (Outcome::Separated, DepthEnding::Separated);
        let nothing = DepthAnswer { outcome, ending, depth: 0.0, lower: 0.0, upper: 0.0, normal, ..Default::default() };
        *answer = DepthAnswer { statistics, ..nothing };
        return;
    }
    *answer = DepthAnswer {
        outcome: signed.outcome,
        ending,
        // No −0.
        depth: (0.0 - signed.distance).max(0.0),
        lower: (0.0 - signed.upper).max(0.0),
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
}

/// The signed distance, from that of the polyhedra.
#[inline(never)]
pub(super) fn signed_distance(
    bodies: &[Placed; 2],
    radii: &Radii,
    cache: &mut SignedDistanceCache,
    config: &PairConfig,
    answer: &mut SignedDistance,
) -> Result<()> {
    config.check(Query::Distance)?;
    if are_round(bodies) {
        let round = Round { bodies, radii, tolerance: config.max_distance };
        if round.answers(AnswerPlace::Signed(answer)) {
            return Ok(());
        }
    }
    signed_distance_by_search(bodies, radii, cache, config, answer)
}

#[inline(never)]
fn signed_distance_by_search(
    bodies: &[Placed; 2],
    radii: &Radii,
    cache: &mut SignedDistanceCache,
    config: &PairConfig,
    answer: &mut SignedDistance,
) -> Result<()> {
    let mut balls = Balls::new(radii, BallQuery::SignedDistance, config.max_distance);
    let mut found = SignedDistance::default();
    of_polyhedra(bodies, cache, config, &mut balls, &mut found)?;
    if balls.are_taken_off {
        *answer = found;
        return Ok(());
    }
    of_bodies(bodies, radii, config.max_distance, &found, answer)
}

/// The signed distance of bodies from that of their polyhedra, which is beyond the tolerance only if the bodies are.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none.
fn of_bodies(
    bodies: &[Placed; 2],
    radii: &Radii,
    tolerance: f64,
    found: &SignedDistance,
    answer: &mut SignedDistance,
) -> Result<()> {
    let is_beyond = found.outcome == Outcome::Beyond;
    let (side, [lower, upper]) = judge(bodies, radii, tolerance, is_beyond, [found.lower, found.upper])?;
    if side == Side::Beyond {
        *answer = without_points(&SignedDistance { outcome: Outcome::Beyond, distance: lower, lower, upper, ..*found });
        return Ok(());
    }
    let points = PlacedPoints { local: [found.local1, found.local2], world: [found.world1, found.world2] };
    let points = moved(&points, bodies.map(|body| body.pose), &found.normal, radii.outwards());
    let ([local1, local2], [world1, world2]) = (points.local, points.world);
    let outcome = match side {
        Side::Apart => Outcome::Separated,
        Side::Hidden => Outcome::Undecided,
        Side::Within | Side::Beyond => Outcome::Intersecting,
    };
    let distance = clamp(found.distance - radii.each[0] - radii.each[1], lower, upper);
    *answer = SignedDistance { outcome, distance, lower, upper, local1, local2, world1, world2, ..*found };
    Ok(())
}

/// From an interval of the polyhedra's signed distance, or a lower end beyond the radii and the tolerance: the side, and the
/// interval of the bodies'. Integers are asked where the interval does not tell.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none.
#[inline(always)]
fn judge(
    bodies: &[Placed; 2],
    radii: &Radii,
    tolerance: f64,
    is_beyond: bool,
    of_polyhedra: [f64; 2],
) -> Result<(Side, [f64; 2])> {
    let interval = radii.off(of_polyhedra);
    match radii.side(interval, tolerance, is_beyond) {
        Some(known) => Ok(known),
        None => in_integers(|| judge_exactly(bodies, radii, tolerance, is_beyond, interval)),
    }
}

/// The same by integers, of an interval of the bodies'.
#[cold]
#[inline(never)]
fn judge_exactly(
    bodies: &[Placed; 2],
    radii: &Radii,
    tolerance: f64,
    is_beyond: bool,
    mut interval: [f64; 2],
) -> (Side, [f64; 2]) {
    let mut truth = Truth { bodies: *bodies, of_polyhedra: None };
    let mut is_apart = interval[0] > 0.0;
    let is_unbounded = interval[1] == f64::INFINITY && !is_beyond;
    if (!is_apart && interval[1] >= 0.0) || is_unbounded {
        (is_apart, interval) = sign(truth.get(), radii, interval);
    }
    if !is_apart {
        return (Side::Within, interval);
    }
    let [lower, upper] = interval;
    if is_beyond || truth.is_beyond(radii, tolerance, interval) {
        return (Side::Beyond, [lower.max(tolerance.min(f64::MAX)), f64::INFINITY]);
    }
    (Side::Apart, [lower, upper.min(tolerance)])
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
        self.of_polyhedra.get_or_insert_with(|| exact::distance(&Pair::of(&[body1, body2]), &[]))
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
