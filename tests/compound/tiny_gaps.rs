//! Gaps that rounding nearly hides: no verdict is wrong, judged by rational numbers.

use super::bodies::{self, Body, least_truth};
use swiftprox::compound::{CompoundAnswer, CompoundCache, distance, intersection};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig};
use testkit::random::Random;

/// Bodies brought so close along the normal of their nearest pieces; gaps below 0 overlap.
fn brought_near(bodies: [&Body; 2], poses: [Pose; 2], gap: f64) -> Option<[Pose; 2]> {
    let placed = [bodies[0].compound.at(&poses[0]), bodies[1].compound.at(&poses[1])];
    let mut answer = CompoundAnswer::default();
    distance(placed, &mut CompoundCache::default(), &PairConfig::default(), &mut answer).unwrap();
    let answer = answer.answer;
    if answer.outcome != Outcome::Separated {
        return None;
    }
    let way = Vector::from(answer.normal) * (gap - answer.distance);
    Some([Pose::new(&poses[0].rotation(), &(poses[0].translation() + way)), poses[1]])
}

#[test]
fn no_verdict_is_wrong_at_tiny_gaps() {
    let mut random = Random::new(0x717);
    let pairs = [
        [bodies::torus(6), bodies::torus(6)],
        [bodies::gear(4), bodies::torus(5)],
        [bodies::placed_torus(5), bodies::gear(3)],
    ];
    let mut seen = [[0; 2]; 3];
    for [one, two] in &pairs {
        for round in 0..12 {
            let poses = [
                Pose::new(&random.rotation(), &(random.direction() * 3.5)),
                Pose::new(&random.rotation(), &Vector::zeros()),
            ];
            for (place, gap) in [1e-7, 1e-10, 1e-13].into_iter().enumerate() {
                let gap = if round % 4 == 3 { -gap } else { gap };
                let Some(near) = brought_near([one, two], poses, gap) else { continue };
                let truth = least_truth([one, two], [&near[0], &near[1]]);
                let placed = [one.compound.at(&near[0]), two.compound.at(&near[1])];
                let mut cache = CompoundCache::default();
                for _ in 0..2 {
                    let (mut verdict, mut far) = (CompoundAnswer::default(), CompoundAnswer::default());
                    intersection(placed, &mut cache, &PairConfig::default(), &mut verdict).unwrap();
                    distance(placed, &mut cache, &PairConfig::default(), &mut far).unwrap();
                    assert_eq!(verdict.answer.outcome == Outcome::Intersecting, truth.intersecting());
                    assert_eq!(far.answer.outcome, verdict.answer.outcome);
                    assert!(truth.lies_between(far.answer.lower, far.answer.upper), "{far:?}");
                    assert!(truth.lies_between(verdict.answer.lower, verdict.answer.upper));
                }
                seen[place][usize::from(truth.intersecting())] += 1;
            }
        }
    }
    assert!(seen.iter().all(|[apart, overlapping]| *apart >= 12 && *overlapping >= 5), "{seen:?}");
}
