//! Depths of bodies of any magnitude, and of any two.

use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{DepthCache, Outcome};
use swiftprox::shape::Shape;
use swiftprox::verify::verify_depth;
use testkit::shapes::hull;

use crate::{Random, query};

fn ball(random: &mut Random, scale: f64) -> Shape {
    let points: Vec<Vector> = (0..30).map(|_| random.direction() * scale).collect();
    hull(&points)
}

/// Beyond 2^±200 the interval was that of the world's axes, from 0 on; next to 2⁻²⁰⁰ its lower end was 0. A depth of 2e59 was
/// refused by the check, whose double-double arithmetic ended at 2²⁰⁰ for all lengths together.
#[test]
fn intervals_are_as_narrow_at_any_magnitude() {
    let mut random = Random::new(91);
    for scale in [1e-300, 1e-200, 1e-80, 1e-61, 1e-60, 1e-31, 1e-30, 1e30, 1e31, 2e59, 1e60, 1.5e60, 1e61, 1e200, 1e300]
    {
        let shapes = [ball(&mut random, scale), ball(&mut random, scale)];
        let mut cache = DepthCache::default();
        for _ in 0..4 {
            let poses = [0.0, 0.7].map(|away| Pose::new(&random.rotation(), &(random.direction() * (away * scale))));
            let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            assert_eq!(answer.outcome, Outcome::Intersecting);
            let width = (answer.upper - answer.lower) / scale;
            assert!(width <= 4e-14 && answer.lower > 0.5 * scale, "{scale:e}: {answer:?}");
            verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
                .unwrap_or_else(|error| panic!("{scale:e}: {error}: {answer:?}"));
        }
    }
}

#[test]
fn intervals_hold_for_any_two_magnitudes() {
    let mut random = Random::new(92);
    let scales = [1e-310, 1e-200, 1e-61, 1e-30, 1.0, 1e30, 1e60, 1e200];
    for large in scales {
        for small in scales.into_iter().filter(|small| *small <= large) {
            let shapes = [ball(&mut random, large), ball(&mut random, small)];
            let away = random.direction() * (0.3 * large);
            let poses = [Pose::new(&random.rotation(), &Vector::zeros()), Pose::new(&random.rotation(), &away)];
            let mut cache = DepthCache::default();
            let answer = query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut cache);
            verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &answer)
                .unwrap_or_else(|error| panic!("{large:e} {small:e}: {error}: {answer:?}"));
            // Of coordinates so far apart no unit of length holds all exactly.
            if small < 1e-290 * large {
                continue;
            }
            // Next to the least of doubles an interval is as wide as they are apart.
            let width = (answer.upper - answer.lower).max(f64::from_bits(4)) - f64::from_bits(4);
            assert!(width <= 4e-14 * large && answer.lower > 0.01 * large, "{large:e} {small:e}: {answer:?}");
        }
    }
}
