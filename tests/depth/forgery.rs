//! What the check of a depth refuses.

use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::verify::verify_depth;

use crate::bodies::{large, placed_deep};
use crate::{Random, query};
use testkit::shapes::{at, cuboid};

/// Ways to make an answer false by more than rounding.
const FORGERIES: [fn(&mut DepthAnswer); 10] = [
    |answer| answer.upper = answer.lower * (1.0 - 1e-12),
    |answer| {
        let higher = answer.upper * (1.0 + 1e-12);
        (answer.lower, answer.depth, answer.upper) = (higher, higher, higher);
    },
    |answer| {
        let less = answer.lower * (1.0 - 1e-12);
        (answer.lower, answer.depth, answer.upper) = (0.5 * less, less, less);
    },
    |answer| (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, 0.0),
    |answer| answer.normal = answer.normal.map(|x| -x),
    |answer| answer.normal[0] += 1e-9,
    |answer| answer.depth = answer.upper * 1.1,
    |answer| answer.world1[1] += 1e-6,
    |answer| answer.local2[0] += 1e-6,
    |answer| answer.lower = f64::NAN,
];

#[test]
fn forged_depths_are_refused() {
    let mut random = Random::new(61);
    let shapes = large(&mut random);
    let mut tried = 0;
    while tried < 100 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let poses = placed_deep(&mut random, pair);
        // Far out the allowance for what is rounded is larger than the forgeries.
        if poses[0].translation().norm() > 2.0 {
            continue;
        }
        let mut cache = DepthCache::default();
        let answer = query(pair, [&poses[0], &poses[1]], &mut cache);
        if answer.outcome != Outcome::Intersecting || answer.lower < 1e-3 {
            continue;
        }
        tried += 1;
        for (number, forge) in FORGERIES.iter().enumerate() {
            let mut forged = answer;
            forge(&mut forged);
            let verdict = verify_depth([pair[0].at(&poses[0]), pair[1].at(&poses[1])], &cache, &forged);
            assert!(verdict.is_err(), "forgery {number}: {forged:?}");
        }
        let mut forged = answer;
        forged.outcome = Outcome::Separated;
        assert!(verify_depth([pair[0].at(&poses[0]), pair[1].at(&poses[1])], &cache, &forged).is_err());
        // The proof is looked for where the cache has none.
        verify_depth([pair[0].at(&poses[0]), pair[1].at(&poses[1])], &DepthCache::default(), &answer).unwrap();
    }
}

#[test]
fn separated_and_touching_objects_are_told_apart() {
    let cube = cuboid([0.5, 0.5, 0.5]);
    let (here, beside, next) = (at(0.0, 0.0, 0.0), at(1.0, 0.25, 0.0), at(1.0_f64.next_up(), 0.25, 0.0));
    let mut cache = DepthCache::default();
    let touching = query([&cube, &cube], [&here, &beside], &mut cache);
    assert_eq!((touching.outcome, touching.upper), (Outcome::Intersecting, 0.0));
    assert_eq!(touching.normal, [-1.0, 0.0, 0.0]);
    verify_depth([cube.at(&here), cube.at(&beside)], &cache, &touching).unwrap();
    assert!(verify_depth([cube.at(&here), cube.at(&next)], &cache, &touching).is_err());
    let apart = query([&cube, &cube], [&here, &next], &mut cache);
    assert_eq!(apart.outcome, Outcome::Separated);
    verify_depth([cube.at(&here), cube.at(&next)], &cache, &apart).unwrap();
    assert!(verify_depth([cube.at(&here), cube.at(&beside)], &cache, &apart).is_err());
    // A claim of touching of bodies that overlap, and the other way round.
    let inside = at(1.0_f64.next_down(), 0.25, 0.0);
    let overlapping = query([&cube, &cube], [&here, &inside], &mut cache);
    assert!(overlapping.upper > 0.0);
    verify_depth([cube.at(&here), cube.at(&inside)], &cache, &overlapping).unwrap();
    assert!(verify_depth([cube.at(&here), cube.at(&inside)], &cache, &touching).is_err());
    assert!(verify_depth([cube.at(&here), cube.at(&beside)], &cache, &overlapping).is_err());
}
