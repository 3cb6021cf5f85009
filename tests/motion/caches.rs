//! The same cast gives the same bits; with any other cache what it says holds as well.

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Screw, cast, verify_cast};
use swiftprox::pair::PairCache;
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::shapes::hull;

use crate::moving;

fn cache_of(random: &mut Random) -> PairCache {
    let words: [u32; 24] = std::array::from_fn(|k| match k {
        0 => random.below(24) as u32,
        _ => random.below(40) as u32,
    });
    assert!(size_of::<PairCache>() <= size_of_val(&words));
    // SAFETY: a `PairCache` is made of integers alone, and as many bytes are there.
    unsafe { std::mem::transmute_copy(&words) }
}

#[test]
fn any_cache_gives_an_answer_that_holds() {
    let mut random = Random::new(0xca);
    let (mut free, mut hit) = (0, 0);
    for _ in 0..60 {
        let shapes: [Shape; 2] = [0, 1].map(|_| {
            let points: Vec<Vector> = (0..30).map(|_| random.direction()).collect();
            hull(&points)
        });
        let motions = [0, 1].map(|i| {
            let start = Pose::new(&random.rotation(), &(random.vector() * 3.0 * f64::from(i)));
            let [velocity, rotation] = [0, 1].map(|_| random.vector() * 2.0);
            Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation })
        });
        let bodies = moving([&shapes[0], &shapes[1]], [&motions[0], &motions[1]]);
        let config = CastConfig::default();
        let with = |mut cache: PairCache| {
            let mut answer = CastAnswer::default();
            cast(bodies, &mut cache, &config, &mut answer).unwrap();
            (answer, cache)
        };
        let (cold, left) = with(PairCache::default());
        let bits = |answer: &CastAnswer| {
            [answer.time_lower, answer.time_upper, answer.clearance, answer.upper, answer.contact.lower]
                .map(f64::to_bits)
        };
        assert_eq!(bits(&with(PairCache::default()).0), bits(&cold));
        for cache in [left, cache_of(&mut random), cache_of(&mut random)] {
            let (answer, _) = with(cache);
            verify_cast(bodies, &config, &answer).unwrap();
            assert_eq!(answer.outcome, cold.outcome);
            if answer.outcome == CastOutcome::Hit {
                // Both intervals hold the first contact.
                assert!(
                    answer.time_lower <= cold.time_upper && cold.time_lower <= answer.time_upper,
                    "{answer:?} {cold:?}"
                );
                hit += 1;
            } else {
                free += 1;
            }
        }
    }
    assert!(free > 15 && hit > 15, "{free} {hit}");
}
