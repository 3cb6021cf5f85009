//! The smallest distance over a motion.

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Clearance, ClearanceConfig, Motion, Moving, Screw, clearance};
use swiftprox::pair::{self, PairAnswer, PairCache, PairConfig};
use testkit::random::Random;
use testkit::shapes::{cuboid, hull};

use crate::{at, moving, run, straight};

fn smallest(bodies: [Moving; 2], config: &ClearanceConfig) -> Clearance {
    let mut answer = Clearance::default();
    clearance(bodies, &mut PairCache::default(), config, &mut answer).unwrap();
    answer
}

#[test]
fn a_cube_that_passes_a_cube() {
    let cube = cuboid([0.5; 3]);
    let (still, passing) = (Motion::Fixed(Pose::IDENTITY), straight(at(-3.0, 0.0, 1.25), [8.0, 0.0, 0.0]));
    let bodies = moving([&cube, &cube], [&passing, &still]);
    for (absolute_error, relative_error) in [(0.0, 0.01), (1e-6, 0.0), (0.0, 0.0), (1.0, 0.0)] {
        let config = ClearanceConfig { absolute_error, relative_error, ..ClearanceConfig::default() };
        let answer = smallest(bodies, &config);
        assert!(answer.lower <= 0.25 && 0.25 <= answer.upper, "{answer:?}");
        let allowed = absolute_error.max(relative_error * answer.lower).max(1e-12);
        assert!(answer.upper - answer.lower <= allowed, "{answer:?}");
        assert!(answer.queries < 60, "{answer:?}");
    }
    let through = straight(at(-3.0, 0.0, 0.75), [8.0, 0.0, 0.0]);
    let answer = smallest(moving([&cube, &cube], [&through, &still]), &ClearanceConfig::default());
    assert_eq!((answer.lower, answer.upper), (0.0, 0.0));
}

#[test]
fn intervals_hold_what_samples_find_and_what_casts_prove() {
    let mut random = Random::new(0xc1);
    let mut free = 0;
    for round in 0..60 {
        let shapes = [0, 1].map(|_| {
            let points: Vec<Vector> = (0..20).map(|_| random.direction()).collect();
            hull(&points)
        });
        let motions = [0, 1].map(|i| {
            let start = Pose::new(&random.rotation(), &(random.vector() * 2.5 * f64::from(i)));
            let [velocity, rotation] = [0, 1].map(|_| random.vector() * 2.0);
            Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation })
        });
        let bodies = moving([&shapes[0], &shapes[1]], [&motions[0], &motions[1]]);
        let config = ClearanceConfig { relative_error: [0.01, 1e-4][round % 2], ..ClearanceConfig::default() };
        let answer = smallest(bodies, &config);
        assert!(answer.lower <= answer.upper, "{answer:?}");
        let width = answer.upper - answer.lower;
        assert!(width <= config.relative_error * answer.lower * (1.0 + 1e-9) || answer.upper < 1e-12, "{answer:?}");
        let cast = run(bodies, &CastConfig::default());
        if answer.lower > 0.0 {
            free += 1;
            assert_eq!(cast.outcome, CastOutcome::Free);
            assert!(cast.clearance <= answer.upper);
        } else {
            assert_eq!(cast.outcome, CastOutcome::Hit);
        }
        for k in 0..=100 {
            let t = f64::from(k) / 100.0;
            let poses = motions.map(|motion| {
                let Motion::Screw(screw) = motion else { unreachable!() };
                let angle = screw.rotation.norm();
                let turn = testkit::random::rotation(&(screw.rotation / angle), angle * t);
                Pose::new(&(turn * screw.start.rotation()), &(screw.start.translation() + screw.velocity * t))
            });
            let mut sample = PairAnswer::default();
            let placed = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
            pair::distance(placed, &mut PairCache::default(), &PairConfig::default(), &mut sample).unwrap();
            assert!(sample.upper >= answer.lower - 1e-12, "{t}: {sample:?} {answer:?}");
        }
    }
    assert!(free > 10 && free < 58, "{free}");
}
