//! What a cache holds changes no verdict, and no depth beyond its interval; nor does the floating-point environment.

use swiftprox::base::simd::environment::Environment;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::verify::verify_depth;

use crate::bodies::{large, placed_deep};
use crate::{Random, query};

/// A cache from bytes, as C may hand over. It is plain old data.
pub fn of_bytes(bytes: &[u8; size_of::<DepthCache>()]) -> DepthCache {
    // SAFETY: all its members are integers, and any bytes are values of them.
    unsafe { std::mem::transmute(*bytes) }
}

pub fn bytes_of(cache: &DepthCache) -> [u8; size_of::<DepthCache>()] {
    // SAFETY: all its members are integers without gaps between them.
    unsafe { std::mem::transmute(*cache) }
}

#[test]
fn corrupted_caches_change_no_answer_beyond_its_interval() {
    let mut random = Random::new(51);
    let shapes = large(&mut random);
    for _ in 0..1_500 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let poses = placed_deep(&mut random, pair);
        let placed = [&poses[0], &poses[1]];
        let mut cache = DepthCache::default();
        let clean = query(pair, placed, &mut cache);
        for _ in 0..4 {
            let mut bytes = bytes_of(&cache);
            match random.below(3) {
                0 => bytes.iter_mut().for_each(|byte| *byte = random.next_u64() as u8),
                1 => (0..1 + random.below(4))
                    .for_each(|_| bytes[random.below(size_of::<DepthCache>())] ^= 1 << random.below(8)),
                _ => {
                    // Small numbers look most like indices.
                    for _ in 0..1 + random.below(40) {
                        bytes[random.below(size_of::<DepthCache>())] = random.below(70) as u8;
                    }
                }
            }
            let mut corrupted = of_bytes(&bytes);
            let answer = query(pair, placed, &mut corrupted);
            assert_eq!(answer.outcome, clean.outcome, "{answer:?} {clean:?}");
            assert!(answer.lower <= clean.upper && clean.lower <= answer.upper, "{answer:?} {clean:?}");
            verify_depth([pair[0].at(placed[0]), pair[1].at(placed[1])], &corrupted, &answer).unwrap();
        }
    }
}

#[test]
fn the_environment_changes_no_bit() {
    let mut random = Random::new(52);
    let shapes = large(&mut random);
    for _ in 0..100 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let poses = placed_deep(&mut random, pair);
        let answer_in = |environment: Environment| -> (DepthAnswer, DepthCache) {
            let mut cache = DepthCache::default();
            let mut answer = DepthAnswer::default();
            for _ in 0..2 {
                answer = environment.run(|| query(pair, [&poses[0], &poses[1]], &mut cache));
            }
            (answer, cache)
        };
        let told = Environment::all().map(|environment| format!("{:?}", answer_in(environment).0)).collect::<Vec<_>>();
        assert!(told.iter().all(|other| *other == told[0]), "{told:?}");
    }
}

/// Bodies that are as deep in each other along several directions: where nothing moves but rounding the direction stays.
#[test]
fn at_ties_the_direction_stays() {
    let cube = testkit::shapes::cuboid([0.5, 0.5, 0.5]);
    let mut random = Random::new(53);
    for _ in 0..50 {
        let mut cache = DepthCache::default();
        let at = |x: f64, y: f64, z: f64| Pose::new(&swiftprox::math::Matrix::identity(), &Vector::new(x, y, z));
        let first = query([&cube, &cube], [&at(0.0, 0.0, 0.0), &at(0.25, 0.25, 0.25)], &mut cache);
        for _ in 0..20 {
            let mut jitter = || 0.25 + random.signed() * 2e-16;
            let moved = at(jitter(), jitter(), jitter());
            let answer = query([&cube, &cube], [&at(0.0, 0.0, 0.0), &moved], &mut cache);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            assert!((Vector::from(answer.normal) - Vector::from(first.normal)).norm() < 1e-12, "{first:?} {answer:?}");
        }
    }
}
