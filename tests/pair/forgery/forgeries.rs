//! Every member of an answer changed, by a unit in the last place up to all of it.

use swiftprox::math::Vector;
use swiftprox::pair::{Feature, FeatureKind, Outcome, PairAnswer};

use super::judge::Judge;

/// Parts by which members are changed; the first stands for a unit in the last place.
const PARTS: [f64; 13] = [0.0, 4e-16, 1e-15, 1e-14, 3.2e-14, 1e-12, 1e-9, 1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0];

/// A double farther up or down, by a part of a scale.
fn changed(x: f64, part: f64, up: bool, scale: f64) -> f64 {
    match (part == 0.0, up) {
        (true, true) => x.next_up(),
        (true, false) => x.next_down(),
        (false, true) => x + part * scale,
        (false, false) => x - part * scale,
    }
}

/// Changed answers, each with what was changed.
pub fn forgeries(answer: &PairAnswer, judge: &Judge) -> Vec<(String, PairAnswer)> {
    let mut forged = Vec::new();
    for part in PARTS {
        for up in [true, false] {
            let by = format!("{}{part:e}", if up { '+' } else { '-' });
            let mut put = |what: &str, change: &dyn Fn(&mut PairAnswer)| {
                let mut changed = *answer;
                change(&mut changed);
                forged.push((format!("{what} {by}"), changed));
            };
            let ends = [answer.lower, answer.distance, answer.upper];
            let distance = |x: f64| changed(x, part, up, x.abs());
            put("lower", &|a| a.lower = distance(a.lower));
            put("distance", &|a| a.distance = distance(a.distance));
            put("upper", &|a| a.upper = distance(a.upper));
            put("the whole interval", &|a| (a.lower, a.distance, a.upper) = ends.map(distance).into());
            if let Some([below, above]) = judge.bounds {
                let size = judge.size;
                let of_size = |x: f64| changed(x, part, up, size).max(0.0);
                put("lower from the truth", &|a| {
                    a.lower = distance(above);
                    (a.distance, a.upper) = (a.lower, a.upper.max(a.lower));
                });
                put("upper from the truth", &|a| {
                    a.upper = distance(below);
                    (a.distance, a.lower) = (a.upper, a.lower.min(a.upper));
                });
                put("lower from the truth, of the size", &|a| {
                    a.lower = of_size(above);
                    (a.distance, a.upper) = (a.lower, a.upper.max(a.lower));
                });
                put("upper from the truth, of the size", &|a| {
                    a.upper = of_size(below);
                    (a.distance, a.lower) = (a.upper, a.lower.min(a.upper));
                });
                put("nothing but the distance", &|a| {
                    a.distance = distance(below);
                    (a.lower, a.upper) = (a.distance, a.distance);
                });
            }
            for axis in 0..3 {
                put(["normal x", "normal y", "normal z"][axis], &|a| {
                    a.normal[axis] = changed(a.normal[axis], part, up, 1.0);
                });
                put(["normal about x", "normal about y", "normal about z"][axis], &|a| {
                    let normal = Vector::from(a.normal);
                    let across = normal.cross(&Vector::ith(axis, 1.0));
                    let angle = if up { part } else { -part };
                    a.normal = (normal + angle * across).normalize().into();
                });
                let moved = |x: f64| changed(x, part, up, judge.size);
                put(["local 1 x", "local 1 y", "local 1 z"][axis], &|a| a.local1[axis] = moved(a.local1[axis]));
                put(["local 2 x", "local 2 y", "local 2 z"][axis], &|a| a.local2[axis] = moved(a.local2[axis]));
                put(["world 1 x", "world 1 y", "world 1 z"][axis], &|a| a.world1[axis] = moved(a.world1[axis]));
                put(["world 2 x", "world 2 y", "world 2 z"][axis], &|a| a.world2[axis] = moved(a.world2[axis]));
                put(["points x", "points y", "points z"][axis], &|a| {
                    for point in [&mut a.local1, &mut a.world1] {
                        point[axis] = moved(point[axis]);
                    }
                });
            }
        }
    }
    forged.extend(others(answer, judge));
    forged
}

const NOWHERE: [f64; 3] = [f64::NAN; 3];

/// What is not changed by a little: outcomes, features, proofs, what is said or not.
fn others(answer: &PairAnswer, judge: &Judge) -> Vec<(String, PairAnswer)> {
    let mut forged = Vec::new();
    let mut put = |what: String, changed: PairAnswer| forged.push((what, changed));
    let proof = [[0, 0], [1, 1], [2, 2], [3, 3]];
    for outcome in [Outcome::None, Outcome::Separated, Outcome::Beyond, Outcome::Intersecting, Outcome::Undecided] {
        let said = PairAnswer { outcome, ..*answer };
        put(format!("{outcome:?}"), said);
        let none = PairAnswer { local1: NOWHERE, local2: NOWHERE, world1: NOWHERE, world2: NOWHERE, ..said };
        let none = PairAnswer { feature1: Feature::default(), feature2: Feature::default(), ..none };
        put(format!("{outcome:?} without points"), none);
        let nothing = PairAnswer { normal: NOWHERE, ..none };
        let normal = PairAnswer { normal: [1.0, 0.0, 0.0], ..none };
        for (what, mut said) in [("", none), (" without a normal", nothing), (" with another normal", normal)] {
            said.proof_count = 0;
            let mut put = |which: &str, [lower, distance, upper]: [f64; 3], proof_count: u32| {
                let said = PairAnswer { lower, distance, upper, proof_count, proof, ..said };
                put(format!("{outcome:?}{what}, {which}"), said);
            };
            put("nothing", [0.0; 3], 0);
            put("anything", [0.0, 0.0, f64::INFINITY], 0);
            put("the size", [judge.size; 3], 0);
            put("the size or more", [judge.size, judge.size, f64::INFINITY], 0);
            put("the size or less", [0.0, 0.0, judge.size], 0);
            put("the least of doubles", [5e-324; 3], 0);
            put("what rounding hides", [0.0, 0.0, judge.size * 1e-16], 0);
            put("less than rounding", [judge.size * 1e-18, judge.size * 1e-17, judge.size * 1e-16], 0);
            put("no numbers", [f64::NAN; 3], 0);
            for count in 1..=4 {
                put(&format!("{count} of a proof"), [0.0; 3], count);
            }
            put("too much of a proof", [0.0; 3], 5);
        }
    }
    for id in [0, 1, 2, 3, 4, 7, 2_000, u32::MAX] {
        for kind in [FeatureKind::None, FeatureKind::Vertex, FeatureKind::Edge, FeatureKind::Face] {
            let feature = Feature { kind, ids: [id, 0] };
            put(format!("{kind:?} {id} of object 1"), PairAnswer { feature1: feature, ..*answer });
            put(format!("{kind:?} {id} of object 2"), PairAnswer { feature2: feature, ..*answer });
        }
    }
    for k in 0..answer.proof_count.min(4) as usize {
        for side in 0..2 {
            for label in [0, 1, 2, 3, 100] {
                let mut changed = *answer;
                changed.proof[k][side] = label;
                put(format!("vertex {label} in proof {k} of {side}"), changed);
            }
        }
        put(format!("{k} of the proof"), PairAnswer { proof_count: k as u32, ..*answer });
    }
    for (what, change) in [
        ("no local point", (|a: &mut PairAnswer| a.local1 = NOWHERE) as fn(&mut PairAnswer)),
        ("no world point", |a| a.world2 = NOWHERE),
        ("no points but features", |a| (a.local1, a.local2, a.world1, a.world2) = (NOWHERE, NOWHERE, NOWHERE, NOWHERE)),
        ("no normal", |a| a.normal = NOWHERE),
        ("the normal turned round", |a| a.normal = a.normal.map(|x| -x)),
        ("a normal of nothing", |a| a.normal = [0.0; 3]),
        ("an endless normal", |a| a.normal = [f64::INFINITY, 0.0, 0.0]),
        ("the points swapped", |a| {
            std::mem::swap(&mut a.local1, &mut a.local2);
            std::mem::swap(&mut a.world1, &mut a.world2);
        }),
        ("the origins for points", |a| (a.local1, a.local2) = ([0.0; 3], [0.0; 3])),
    ] {
        let mut changed = *answer;
        change(&mut changed);
        put(what.into(), changed);
    }
    forged
}
