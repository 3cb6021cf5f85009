//! How deep compounds are in each other: known depths, bounds by brute force, and the check of each answer.

use super::bodies::{self, Body, for_each_pair};
use std::sync::Arc;
use swiftprox::compound::{Compound, CompoundDepth, Piece, PlacedCompound, depth, verify_depth};
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, DepthConfig, Outcome, SignedDistance, SignedDistanceCache};
use testkit::random::Random;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(&Matrix::identity(), &Vector::new(x, y, z))
}

/// Boxes from corner to corner, their points in the body's frame.
fn boxes(corners: &[[[f64; 3]; 2]]) -> Body {
    let cloud = |[low, high]: &[[f64; 3]; 2]| {
        (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 0 { low[k] } else { high[k] })).collect()
    };
    Body::new(corners.iter().map(|ends| (cloud(ends), Pose::IDENTITY)).collect())
}

fn asked(placed: [PlacedCompound; 2]) -> CompoundDepth {
    let mut answer = CompoundDepth::default();
    depth(placed, &DepthConfig::default(), &mut answer).unwrap();
    verify_depth(placed, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?}"));
    let mut again = CompoundDepth::default();
    depth(placed, &DepthConfig::default(), &mut again).unwrap();
    assert_eq!(format!("{answer:?}"), format!("{again:?}"));
    assert!(frees(placed, &answer), "{answer:?}");
    answer
}

/// The least signed distance of all pairs of pieces, one by one.
fn least(placed: [PlacedCompound; 2]) -> [f64; 2] {
    let mut least = [f64::INFINITY; 2];
    for_each_pair(placed, |_, bodies| {
        let mut found = SignedDistance::default();
        let cache = &mut SignedDistanceCache::default();
        pair::signed_distance(bodies, cache, &Default::default(), &mut found).unwrap();
        least = [least[0].min(found.lower), least[1].min(found.upper)];
    });
    least
}

fn moved(placed: PlacedCompound, way: &Vector) -> Pose {
    Pose::new(&placed.pose.rotation(), &(placed.pose.translation() + way))
}

/// Whether the translation of an answer leaves no two pieces that overlap.
fn frees(placed: [PlacedCompound; 2], answer: &CompoundDepth) -> bool {
    let there = moved(placed[0], &answer.translation.into());
    least([placed[0].compound.at(&there), placed[1]])[0] >= 0.0
}

#[track_caller]
fn expect(placed: [PlacedCompound; 2], lower: f64, upper: f64) -> CompoundDepth {
    let found = asked(placed);
    let is = |found: f64, expected: f64| (found - expected).abs() <= 1e-12 * (1.0 + expected);
    assert!(is(found.lower, lower) && is(found.upper, upper), "{found:?}");
    assert_eq!(found.deepest.distance.outcome, Outcome::Intersecting);
    found
}

#[test]
fn single_boxes_have_their_depth() {
    let cube = boxes(&[[[-0.5; 3], [0.5; 3]]]);
    for (pose, deep) in [(at(0.75, 0.1, 0.0), 0.25), (at(0.1, 0.2, -0.95), 0.05), (at(0.0, 0.0, 0.0), 1.0)] {
        expect([cube.compound.at(&pose), cube.compound.at(&Pose::IDENTITY)], deep, deep);
    }
    let mut random = Random::new(0xd0);
    for _ in 0..50 {
        let [one, two] = [bodies::pose(&mut random, 0.3), bodies::pose(&mut random, 0.3)];
        let found = asked([cube.compound.at(&one), cube.compound.at(&two)]);
        assert!(found.upper - found.lower <= 1e-13, "{found:?}");
    }
}

/// A U of three boxes, open upwards, 4 long: between its walls there is room for 2.
fn channel() -> Body {
    boxes(&[
        [[-2.0, -2.0, -1.0], [2.0, 2.0, 0.0]],
        [[-2.0, -2.0, -1.0], [-1.0, 2.0, 3.0]],
        [[1.0, -2.0, -1.0], [2.0, 2.0, 3.0]],
    ])
}

#[test]
fn a_peg_leaves_a_channel_by_the_shortest_way() {
    let channel = channel();
    let peg = |half: f64| boxes(&[[[-half, -1.0, 0.0], [half, 1.0, 2.0]]]);
    let ask = |half: f64, pose: Pose, lower: f64, upper: f64| {
        expect([peg(half).compound.at(&pose), channel.compound.at(&Pose::IDENTITY)], lower, upper)
    };
    // Up from the floor, between the walls.
    ask(0.9, at(0.0, 0.0, -0.25), 0.25, 0.25);
    // The same where it fits exactly: touching both walls is allowed.
    ask(1.0, at(0.0, 0.0, -0.25), 0.25, 0.25);
    // From floor and wall at once.
    ask(0.9, at(0.3, 0.0, -0.15), 0.2, (0.2_f64 * 0.2 + 0.15 * 0.15).sqrt());
    // Too wide: out of the mouth, sideways beyond the wall or lengthwise, whichever is the least.
    ask(1.25, at(0.0, 0.0, 1.75), 0.25, 1.25);
    ask(1.25, at(0.0, 0.0, 0.5), 0.25, 2.5);
    ask(1.25, at(0.0, 2.5, 0.5), 0.25, 0.5);
    // Wider by a rounding than the room.
    let hidden = asked([peg(1.0 + 1e-15).compound.at(&at(0.0, 0.0, 1.75)), channel.compound.at(&Pose::IDENTITY)]);
    assert!(hidden.lower <= 1e-14 && (hidden.upper - 1.25).abs() <= 1e-12, "{hidden:?}");
}

/// Combs of teeth as wide as the gaps, or a little less wide.
#[test]
fn interlocked_combs_go_back_or_apart() {
    let comb = |width: f64| {
        let mut corners = vec![[[-0.5, -0.5, -1.0], [10.0, 0.5, 0.0]]];
        corners.extend((0..10).map(|k| [[f64::from(k), -0.5, 0.0], [f64::from(k) + width, 0.5, 2.0]]));
        boxes(&corners)
    };
    let over = |x: f64, z: f64| {
        // Upside down.
        let turn = Matrix::from_diagonal(&Vector::new(1.0, -1.0, -1.0));
        Pose::new(&turn, &Vector::new(x, 0.0, z))
    };
    let fixed = comb(0.4);
    // Teeth of 0.4 in gaps of 0.6, pushed into the teeth beside them.
    let found = asked([fixed.compound.at(&over(0.3, 3.0)), fixed.compound.at(&Pose::IDENTITY)]);
    assert!((found.lower - 0.1).abs() < 1e-12 && (found.upper - 0.1).abs() < 1e-12, "{found:?}");
    // Too deep as well.
    let found = asked([fixed.compound.at(&over(0.3, 1.7)), fixed.compound.at(&Pose::IDENTITY)]);
    let truth = (0.1_f64 * 0.1 + 0.3 * 0.3).sqrt();
    assert!((found.lower - 0.3).abs() < 1e-12 && (found.upper - truth).abs() < 1e-12, "{found:?}");
    // Teeth that do not fit come out upwards or go out sideways.
    let wide = comb(0.7);
    let found = asked([wide.compound.at(&over(0.3, 3.5)), fixed.compound.at(&Pose::IDENTITY)]);
    assert!(found.lower < 0.4 && (found.upper - 0.5).abs() < 1e-12, "{found:?}");
}

/// Links of a chain: one ring through the other, wedged against its inside.
#[test]
fn links_of_a_chain_stay_linked() {
    let ring = bodies::torus(24);
    let turn = testkit::random::rotation(&Vector::x(), std::f64::consts::FRAC_PI_2);
    for (x, least, most) in [(0.75, 0.0, 0.1), (1.0, 0.0, 0.08), (1.45, 0.05, 0.2), (1.8, 0.4, 0.6)] {
        let pose = Pose::new(&turn, &Vector::new(x, 0.03, 0.02));
        let found = asked([ring.compound.at(&pose), ring.compound.at(&Pose::IDENTITY)]);
        assert!((least..most).contains(&found.upper), "{x}: {found:?}");
    }
}

/// The pieces' obstacles along many directions: a certain depth of small bodies, from below for the directions looked at.
fn sampled(placed: [PlacedCompound; 2], random: &mut Random, count: usize) -> f64 {
    let clear = |way: &Vector| {
        let there = moved(placed[0], way);
        let mut answer = swiftprox::compound::CompoundAnswer::default();
        let bodies = [placed[0].compound.at(&there), placed[1]];
        let cache = &mut swiftprox::compound::CompoundCache::default();
        swiftprox::compound::intersection(bodies, cache, &Default::default(), &mut answer).unwrap();
        answer.answer.outcome != Outcome::Intersecting
    };
    let mut best = 20.0;
    for _ in 0..count {
        let direction = random.direction();
        let mut t = 0.0;
        while t < best && !clear(&(direction * t)) {
            t += 0.01;
        }
        best = f64::min(best, t);
    }
    best
}

/// Hulls of a few points, most of which overlap.
fn clump(random: &mut Random, count: usize) -> Body {
    let mut part = || {
        let axes = Vector::from_fn(|_, _| random.uniform(0.15, 0.6));
        let middle = random.vector() * 0.6;
        let points = (0..5 + random.below(6)).map(|_| random.direction().component_mul(&axes) + middle).collect();
        (points, if random.below(2) == 0 { Pose::IDENTITY } else { bodies::pose(random, 0.3) })
    };
    Body::new((0..count).map(|_| part()).collect())
}

#[test]
fn random_unions_are_as_deep_as_sampling_finds() {
    let mut random = Random::new(0xd1);
    let (mut ratios, mut shares) = (Vec::new(), Vec::new());
    let rounds = 80;
    for _ in 0..rounds {
        let counts = [1 + random.below(6), 1 + random.below(6)];
        let [one, two] = counts.map(|count| clump(&mut random, count));
        let poses = [bodies::pose(&mut random, 0.3), bodies::pose(&mut random, 0.3)];
        let placed = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
        let found = asked(placed);
        let [lower, upper] = least(placed);
        if lower >= 0.0 {
            assert_eq!([found.lower, found.upper], [0.0; 2]);
            continue;
        }
        assert!(found.lower <= -lower && found.lower >= -upper - 1e-14 && found.lower <= found.upper, "{found:?}");
        let sampled = sampled(placed, &mut random, 1000);
        if sampled > 0.05 {
            ratios.push(found.upper / sampled);
            shares.push(found.upper / found.lower);
        }
    }
    ratios.sort_by(f64::total_cmp);
    let mean = |all: &[f64]| (all.iter().map(|x| x.ln()).sum::<f64>() / all.len() as f64).exp();
    println!(
        "{} cases; upper over sampled: mean {:.3}, median {:.3}, greatest {:.3}; upper over lower: mean {:.3}",
        ratios.len(),
        mean(&ratios),
        ratios[ratios.len() / 2],
        ratios.last().unwrap(),
        mean(&shares)
    );
    assert!(mean(&ratios) < 1.02 && *ratios.last().unwrap() < 1.5, "{ratios:?}");
}

#[test]
fn gears_and_tori_are_freed() {
    let mut random = Random::new(0xd2);
    for [one, two] in [[bodies::gear(12), bodies::gear(12)], [bodies::torus(20), bodies::placed_torus(16)]] {
        let mut shares = Vec::new();
        for _ in 0..12 {
            let poses = [bodies::pose(&mut random, 0.6), bodies::pose(&mut random, 0.6)];
            let found = asked([one.compound.at(&poses[0]), two.compound.at(&poses[1])]);
            if found.lower > 0.0 {
                shares.push(found.upper / found.lower);
            }
        }
        assert!(shares.len() > 5);
    }
}

#[test]
fn what_does_not_overlap_has_depth_0() {
    let cube = boxes(&[[[0.0; 3], [1.0; 3]], [[1.0, 0.0, 0.0], [2.0, 1.0, 1.0]]]);
    for (pose, outcome) in [
        (at(2.0, 0.0, 0.0), Outcome::Intersecting),
        (at(1.0, 1.0, 0.5), Outcome::Intersecting),
        (at(2.0, 1.0, 1.0), Outcome::Intersecting),
        (at(2.5, 0.0, 0.0), Outcome::Separated),
        (at(1e9, 0.0, 0.0), Outcome::Separated),
    ] {
        let found = asked([cube.compound.at(&pose), cube.compound.at(&Pose::IDENTITY)]);
        assert_eq!(found.deepest.distance.outcome, outcome);
        assert_eq!((found.lower, found.upper, found.translation), (0.0, 0.0, [0.0; 3]));
    }
    // A plate in a face of a cube is no deeper than 0, across it is.
    let plate = boxes(&[[[0.25, 0.25, 0.0], [0.75, 0.75, 0.0]]]);
    expect([plate.compound.at(&at(0.0, 0.0, 0.125)), cube.compound.at(&Pose::IDENTITY)], 0.125, 0.125);
    let found = asked([plate.compound.at(&Pose::IDENTITY), cube.compound.at(&Pose::IDENTITY)]);
    assert_eq!(found.upper, 0.0);
    let point = boxes(&[[[0.25; 3]; 2]]);
    expect([point.compound.at(&Pose::IDENTITY), cube.compound.at(&Pose::IDENTITY)], 0.25, 0.25);
}

/// Sizes near the ends of the doubles, places far from the origin, and swept radii.
#[test]
fn any_size_is_freed() {
    for scale in [1e-300, 1e-160, 1e-60, 1e60, 1e140, 1e152] {
        let cube = boxes(&[[[0.0; 3], [scale; 3]], [[2.0 * scale, 0.0, 0.0], [3.0 * scale, scale, scale]]]);
        let pose = at(0.0, 0.75 * scale, 0.0);
        let placed = [cube.compound.at(&pose), cube.compound.at(&Pose::IDENTITY)];
        let mut found = CompoundDepth::default();
        depth(placed, &DepthConfig::default(), &mut found).unwrap();
        let parts = [found.lower / scale, found.upper / scale];
        assert!((parts[0] - 0.25).abs() < 1e-9 && (parts[1] - 0.25).abs() < 1e-9, "{scale:e} {found:?}");
        match verify_depth(placed, &found) {
            Ok(()) | Err(Error::Argument(_)) => {}
            Err(error) => panic!("{error}: {found:?}"),
        }
    }
    let cube = boxes(&[[[0.0; 3], [1.0; 3]], [[2.0, 0.0, 0.0], [3.0, 1.0, 1.0]]]);
    for far in [1e3, 1e6, 1e9] {
        let found = asked([cube.compound.at(&at(far, far + 0.75, far)), cube.compound.at(&at(far, far, far))]);
        assert!((found.upper - 0.25).abs() <= 1e-14 * far, "{found:?}");
    }
    use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.5, ..ShapeOptions::default() };
    let ball = Arc::new(Shape::from_points(&[Vector::zeros()], &options).unwrap());
    let pair = |x: f64| Piece { shape: ball.clone(), pose: at(x, 0.0, 0.0) };
    let balls = Compound::new(&[pair(0.0), pair(1.5)]).unwrap();
    expect([balls.at(&at(0.25, 0.6, 0.0)), balls.at(&Pose::IDENTITY)], 0.35, 0.35);
}

#[test]
fn budgets_and_errors_end_early() {
    let mut random = Random::new(0xd3);
    let gear = bodies::gear(10);
    for _ in 0..6 {
        let poses = [bodies::pose(&mut random, 0.4), bodies::pose(&mut random, 0.4)];
        let placed = [gear.compound.at(&poses[0]), gear.compound.at(&poses[1])];
        let best = asked(placed);
        let mut last = f64::INFINITY;
        for step_budget in [1, 5, 30, 300, u32::MAX] {
            let mut found = CompoundDepth::default();
            depth(placed, &DepthConfig { step_budget, ..DepthConfig::default() }, &mut found).unwrap();
            verify_depth(placed, &found).unwrap();
            assert!(found.upper <= last && found.lower == best.lower);
            last = found.upper;
        }
        assert_eq!(last, best.upper);
        let mut rough = CompoundDepth::default();
        depth(placed, &DepthConfig { relative_error: 1e9, ..DepthConfig::default() }, &mut rough).unwrap();
        verify_depth(placed, &rough).unwrap();
        assert!(rough.upper >= best.upper);
        let refused = depth(placed, &DepthConfig { absolute_error: f64::NAN, ..DepthConfig::default() }, &mut rough);
        assert!(matches!(refused, Err(Error::Argument(_))));
    }
}

#[test]
fn spoilt_answers_are_refused() {
    let channel = channel();
    let peg = boxes(&[[[-0.9, -1.0, 0.0], [0.9, 1.0, 2.0]]]);
    let pose = at(0.3, 0.0, -0.15);
    let placed = [peg.compound.at(&pose), channel.compound.at(&Pose::IDENTITY)];
    let right = asked(placed);
    let refused = |spoil: &dyn Fn(&mut CompoundDepth)| {
        let mut wrong = right;
        spoil(&mut wrong);
        let outcome = verify_depth(placed, &wrong);
        assert!(matches!(outcome, Err(Error::Unverified(_) | Error::Argument(_))), "{wrong:?}");
    };
    refused(&|wrong| wrong.upper *= 1.0 - 1e-9);
    refused(&|wrong| wrong.lower = right.upper);
    refused(&|wrong| wrong.lower = f64::NAN);
    refused(&|wrong| wrong.upper = f64::NAN);
    refused(&|wrong| wrong.translation = wrong.translation.map(|x| 0.999 * x));
    refused(&|wrong| wrong.translation = [0.0; 3]);
    refused(&|wrong| wrong.translation[0] = f64::NAN);
    refused(&|wrong| (wrong.lower, wrong.upper, wrong.translation) = (0.0, 0.0, [0.0; 3]));
    refused(&|wrong| wrong.deepest.piece2 = 3);
    refused(&|wrong| wrong.deepest.piece2 = 1);
    refused(&|wrong| wrong.deepest.distance.lower *= 0.99);
    refused(&|wrong| wrong.deepest.distance.upper *= 1.01);
    refused(&|wrong| wrong.deepest.distance.outcome = Outcome::Separated);
    refused(&|wrong| wrong.deepest.distance.normal[0] += 0.1);
    verify_depth(placed, &CompoundDepth { upper: 2.0 * right.upper, lower: 0.0, ..right }).unwrap();
    let apart = at(9.0, 0.0, 0.0);
    let placed = [peg.compound.at(&apart), channel.compound.at(&Pose::IDENTITY)];
    let mut wrong = asked(placed);
    wrong.upper = 1.0;
    assert!(verify_depth(placed, &wrong).is_err());
}
