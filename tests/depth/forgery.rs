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

/// A translation that parts two boxes is not the least one, though all else of the answer is true of it: normal, points, features
/// and an overlap along the normal. Only the lower end is false, and only its proof refuses it. Found by a mutant of the check,
/// which left that proof out; all other forgeries fail elsewhere, too.
#[test]
fn an_overlap_along_another_direction_is_no_depth() {
    let (large, small) = (cuboid([1.0; 3]), cuboid([0.5; 3]));
    // In the middle of a face of the large one, a quarter deep.
    let origin = at(0.0, 0.0, 0.0);
    let middle = query([&large, &small], [&origin, &at(1.25, 0.0, 0.0)], &mut DepthCache::default());
    let [_, y, z] = middle.local2;
    assert!(middle.depth == 0.25 && y.abs() == 0.5, "{middle:?}");
    // The same at an edge, an eighth deep along another axis.
    let there = at(1.25, -1.375 * y.signum(), 0.0);
    let bodies = [large.at(&origin), small.at(&there)];
    let mut cache = DepthCache::default();
    let honest = query([&large, &small], [&origin, &there], &mut cache);
    assert!((honest.depth - 0.125).abs() < 1e-12, "{honest:?}");
    let beside = y - 1.375 * y.signum();
    let forged =
        DepthAnswer { local1: [1.0, beside, z], world1: [1.0, beside, z], world2: [0.75, beside, z], ..middle };
    for cache in [cache, DepthCache::default()] {
        verify_depth(bodies, &cache, &honest).unwrap();
        verify_depth(bodies, &cache, &forged).unwrap_err();
        // With a lower end that holds there is nothing to refuse.
        verify_depth(bodies, &cache, &DepthAnswer { lower: honest.lower, ..forged }).unwrap();
        verify_depth(bodies, &cache, &DepthAnswer { lower: 0.0, ..forged }).unwrap();
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

/// Every number of an answer, with its name.
fn members(answer: &mut DepthAnswer) -> Vec<(String, &mut f64)> {
    let DepthAnswer { depth, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
    let mut members = vec![("depth".into(), depth), ("lower".into(), lower), ("upper".into(), upper)];
    for (name, vector) in
        [("local1", local1), ("local2", local2), ("world1", world1), ("world2", world2), ("normal", normal)]
    {
        members.extend(vector.iter_mut().enumerate().map(|(axis, x)| (format!("{name}[{axis}]"), x)));
    }
    members
}

/// Two cubes that overlap by a quarter, touch, or are a quarter apart: what is put into an answer and is no number must be refused,
/// and no interval may pass that misses the truth by a unit in the last place. A NaN in `world1` passed: see the same of distances.
#[test]
fn no_number_may_be_none() {
    let cube = cuboid([0.5, 0.5, 0.5]);
    let here = at(0.0, 0.0, 0.0);
    for (apart, truth) in [(0.75, 0.25), (1.0, 0.0), (1.25, 0.0)] {
        let there = at(apart, 0.125, 0.0625);
        let mut cache = DepthCache::default();
        let found = query([&cube, &cube], [&here, &there], &mut cache);
        let exact = DepthAnswer { lower: truth, depth: truth, upper: truth, ..found };
        for answer in [found, exact] {
            verify_depth([cube.at(&here), cube.at(&there)], &cache, &answer).unwrap();
            for member in 0..18 {
                let before = *members(&mut answer.clone())[member].1;
                for put in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, before.next_up(), before.next_down()] {
                    let mut forged = answer;
                    let (what, number) = members(&mut forged).swap_remove(member);
                    *number = put;
                    let is_same = before == put || before.is_nan() && put.is_nan();
                    let holds = forged.lower <= truth && truth <= forged.upper;
                    let is_in_order = forged.lower <= forged.depth && forged.depth <= forged.upper;
                    let is_lie = !is_same && (!put.is_finite() || before.is_nan()) || !holds || !is_in_order;
                    let checked = verify_depth([cube.at(&here), cube.at(&there)], &cache, &forged);
                    assert!(!is_lie || checked.is_err(), "{what} {put:e} for {before:e}: {forged:?}");
                    assert!(!is_same || checked.is_ok(), "{what} {put:e} for {before:e}: {checked:?}");
                }
            }
        }
    }
}
