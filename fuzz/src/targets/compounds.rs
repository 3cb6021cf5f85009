//! Two bodies of several pieces, placed in them or not, at poses that touch or miss each other by a few roundings. The cache is
//! carried on, stale or of any bytes. Checked: verdict, distance and signed distance against all pairs of pieces asked one by one,
//! `verify` of each and of the depth, and a pair of few corners against exact rationals. The last two steps are the ends of a
//! motion, whose cast is held against its own check and against distances on the way.

use std::sync::Arc;

use arbitrary::{Result, Unstructured};
use swiftprox::compound::{
    Compound, CompoundAnswer, CompoundCache, CompoundCastAnswer, CompoundDepth, CompoundSignedDistance, MovingCompound,
    Piece, PlacedCompound, cast, depth, distance, intersection, signed_distance, verify, verify_cast, verify_depth,
};
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, motion_between};
use swiftprox::pair::{self, DepthConfig, Outcome, PairConfig, SignedDistance, SignedDistanceCache};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::oracle::{Polytope, truth};

use crate::geometry::{points, pose, poses};

const MOST_PIECES: usize = 4;
const MOST_POINTS: usize = 6;
const MOST_STEPS: usize = 4;

struct Body {
    compound: Compound,
    clouds: Vec<Vec<Vector>>,
}

pub fn run(bytes: &[u8]) {
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes));
}

fn run_from(u: &mut Unstructured) -> Result<()> {
    let (one, two) = (body(u)?, body(u)?);
    let mut cache = CompoundCache::default();
    let mut last: Option<[Pose; 2]> = None;
    for _ in 0..MOST_STEPS {
        let poses = match &last {
            Some(before) if u.arbitrary()? => moved(u, before)?,
            _ => poses(u, [&one.clouds[0], &two.clouds[0]])?,
        };
        match u.int_in_range(0..=5)? {
            0 => cache = any_cache(u)?,
            1 => cache = scrambled(u, &cache)?,
            _ => {}
        }
        let is_accepted = |body: &Body, pose: &Pose| {
            let at = |k| placed(body.compound.at(pose), k).check().is_ok();
            pose.check().is_ok() && (0..body.clouds.len()).all(at)
        };
        if is_accepted(&one, &poses[0]) && is_accepted(&two, &poses[1]) {
            check([&one, &two], [&poses[0], &poses[1]], &mut cache);
            if let Some(before) = last.replace(poses) {
                check_cast([&one, &two], [before, poses], &mut cache);
            }
        } else {
            let (before, mut answer) = (cache.clone(), CompoundAnswer::default());
            let placed = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
            assert!(distance(placed, &mut cache, &PairConfig::default(), &mut answer).is_err());
            assert!(cache == before && answer.answer.outcome == Outcome::None);
        }
        if u.is_empty() {
            break;
        }
    }
    Ok(())
}

fn body(u: &mut Unstructured) -> Result<Body> {
    let (mut pieces, mut clouds) = (Vec::new(), Vec::new());
    for _ in 0..u.int_in_range(1..=MOST_PIECES)? {
        let cloud = points(u, MOST_POINTS)?;
        let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        let shape = Arc::new(Shape::from_points(&cloud, &options).expect("finite points"));
        let own = if u.arbitrary()? { Pose::IDENTITY } else { pose(u)? };
        let own = if own.check().is_ok() { own } else { Pose::IDENTITY };
        pieces.push(Piece { shape, pose: own });
        clouds.push(cloud);
    }
    Ok(Body { compound: Compound::new(&pieces).expect("accepted poses"), clouds })
}

/// Where a piece is.
fn placed(body: PlacedCompound, k: usize) -> Pose {
    let own = body.compound.pieces()[k].pose;
    if own == Pose::IDENTITY {
        return *body.pose;
    }
    Pose::new(&(body.pose.rotation() * own.rotation()), &body.pose.transform(&own.translation()))
}

fn insist_on_proof(checked: std::result::Result<(), Error>, answer: &CompoundAnswer) {
    match checked {
        // What is too large or too far apart.
        Ok(()) | Err(Error::Argument(_)) => {}
        Err(error) => panic!("{error}: {answer:?}"),
    }
}

fn check(bodies: [&Body; 2], poses: [&Pose; 2], cache: &mut CompoundCache) {
    let both = [bodies[0].compound.at(poses[0]), bodies[1].compound.at(poses[1])];
    let (mut lower, mut upper, mut outcome) = (f64::INFINITY, f64::INFINITY, Outcome::Separated);
    let rows = |pose: &Pose| std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
    let mut truths = Vec::new();
    let is_small = bodies.iter().all(|body| body.clouds.len() <= 2);
    for i in 0..bodies[0].clouds.len() {
        for j in 0..bodies[1].clouds.len() {
            let places = [placed(both[0], i), placed(both[1], j)];
            let pieces = [&both[0].compound.pieces()[i].shape, &both[1].compound.pieces()[j].shape];
            let mut found = SignedDistance::default();
            let mut cold = SignedDistanceCache::default();
            let pair = [pieces[0].at(&places[0]), pieces[1].at(&places[1])];
            pair::signed_distance(pair, &mut cold, &PairConfig::default(), &mut found).expect("accepted poses");
            lower = lower.min(found.lower);
            upper = upper.min(found.upper);
            if found.outcome == Outcome::Intersecting {
                outcome = found.outcome;
            }
            if is_small {
                let polytope = |cloud: &[Vector]| Polytope::new(&cloud.iter().map(|p| (*p).into()).collect::<Vec<_>>());
                let [one, two] = [polytope(&bodies[0].clouds[i]), polytope(&bodies[1].clouds[j])];
                truths.push(truth(&one, &rows(&places[0]), &two, &rows(&places[1])));
            }
        }
    }
    for _ in 0..2 {
        for query in [distance, intersection] {
            let mut found = CompoundAnswer::default();
            query(both, cache, &PairConfig::default(), &mut found).expect("accepted poses");
            assert_eq!(found.answer.outcome, outcome, "{found:?}");
            let said = &found.answer;
            assert!(outcome == Outcome::Intersecting || said.lower <= upper && lower <= said.upper, "{found:?}");
            insist_on_proof(verify(both, &found), &found);
            if let Some(least) = truths.iter().min_by(|a, b| a.squared_distance.cmp(&b.squared_distance)) {
                assert!(least.lies_between(said.lower, said.upper), "{found:?}");
            }
            let tolerance = said.lower;
            let mut within = CompoundAnswer::default();
            let config = PairConfig { max_distance: tolerance, ..PairConfig::default() };
            query(both, cache, &config, &mut within).expect("accepted poses");
            assert_eq!(within.answer.outcome == Outcome::Intersecting, outcome == Outcome::Intersecting);
            insist_on_proof(verify(both, &within), &within);
        }
        let mut found = CompoundSignedDistance::default();
        signed_distance(both, cache, &PairConfig::default(), &mut found).expect("accepted poses");
        assert!(found.distance.lower <= upper && lower <= found.distance.upper, "{found:?} {lower:e} {upper:e}");
        assert_eq!(found.distance.outcome, outcome);
    }
    let mut deep = CompoundDepth::default();
    depth(both, &DepthConfig { step_budget: 50, ..DepthConfig::default() }, &mut deep).expect("accepted poses");
    assert_eq!(deep.deepest.distance.outcome, outcome);
    assert!(0.0 <= deep.lower && deep.lower <= deep.upper && deep.lower <= (-lower).max(0.0), "{deep:?}");
    match verify_depth(both, &deep) {
        Ok(()) | Err(Error::Argument(_)) => {}
        // Of very long bodies a proof need not be found from nothing.
        Err(Error::Unverified(text)) if text.contains("is not proved") => {}
        Err(error) => panic!("{error}: {deep:?}"),
    }
}

/// A cast from some poses to others.
fn check_cast(bodies: [&Body; 2], [from, to]: [[Pose; 2]; 2], cache: &mut CompoundCache) {
    let mut screws = Vec::new();
    for k in 0..2 {
        // What moves too far is refused.
        let Ok((screw, _)) = motion_between(&from[k], &to[k], &Vector::zeros(), 0.0) else { return };
        screws.push(Motion::Screw(screw));
    }
    let moving = |k: usize| MovingCompound { compound: &bodies[k].compound, motion: &screws[k] };
    let both = [moving(0), moving(1)];
    let config = CastConfig { step_budget: 200, time_tolerance: 1e-6, ..CastConfig::default() };
    let mut found = CompoundCastAnswer::default();
    if cast(both, cache, &config, &mut found).is_err() {
        assert_eq!(found.answer.outcome, CastOutcome::None);
        return;
    }
    match verify_cast(both, &config, &found) {
        Ok(()) | Err(Error::Argument(_)) => {}
        Err(error) => panic!("{error}: {found:?}"),
    }
    // Poses at the beginning are exact.
    let places = [bodies[0].compound.at(&from[0]), bodies[1].compound.at(&from[1])];
    let mut at_first = CompoundAnswer::default();
    distance(places, cache, &PairConfig::default(), &mut at_first).expect("accepted poses");
    let is_free = found.answer.outcome == CastOutcome::Free;
    assert!(!is_free || at_first.answer.upper >= found.answer.clearance, "{found:?} {at_first:?}");
}

/// The same cache with some of its words changed: its front is for the place that it was for.
fn scrambled(u: &mut Unstructured, cache: &CompoundCache) -> Result<CompoundCache> {
    // SAFETY: as below.
    let mut words = unsafe { std::mem::transmute::<CompoundCache, [u32; WORDS]>(cache.clone()) };
    for _ in 0..u.int_in_range(1..=8)? {
        // The front's steps are in the words from 22 on.
        let most = if u.arbitrary()? { 83 } else { WORDS - 1 };
        words[u.int_in_range(20..=most)?] = u.arbitrary()?;
    }
    // SAFETY: as below.
    Ok(unsafe { std::mem::transmute::<[u32; WORDS], CompoundCache>(words) })
}

/// Poses a little off others, turned by up to the defect that is accepted.
fn moved(u: &mut Unstructured, before: &[Pose; 2]) -> Result<[Pose; 2]> {
    let mut poses = *before;
    for k in 0..3 {
        let step = f64::from(u.arbitrary::<i8>()?) * 1e-3;
        poses[0].rows[k][3] += step * (1.0 + before[0].rows[k][3].abs());
        poses[1].rows[k][(k + 1) % 3] += f64::from(u.arbitrary::<i8>()?) * 1e-5;
    }
    Ok(poses)
}

const WORDS: usize = size_of::<CompoundCache>() / 4;

/// A cache of any words, most of them small, as numbers of pieces and kinds are.
fn any_cache(u: &mut Unstructured) -> Result<CompoundCache> {
    let (seed, step): (u32, u32) = (u.arbitrary()?, u.arbitrary()?);
    let mut words = [0_u32; WORDS];
    for (k, word) in (0_u32..).zip(words.iter_mut()) {
        let mixed = seed.wrapping_add(step.wrapping_mul(k)).wrapping_mul(0x9e37_79b1);
        *word = if mixed >> 28 == 0 { mixed } else { mixed >> 29 };
    }
    // SAFETY: a `repr(C)` struct of unsigned integers only, without gaps, so of the same size and valid for any bits.
    Ok(unsafe { std::mem::transmute::<[u32; WORDS], CompoundCache>(words) })
}
