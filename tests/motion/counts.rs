//! How many queries casts make: where bodies turn, each step near contact has to leave a share of the distance that shrinks.

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, verify_cast};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::random_hull;
use testkit::random::Random;
use testkit::shapes::cuboid;

use super::{moving, run, screw};

/// Both turn, one flies into the other. Along directions that keep still a cast made 22 queries, as the faces stick out along them
/// long before contact: each step left a twentieth of the distance or more.
#[test]
fn turning_bodies_are_met_in_few_queries() {
    let mut random = Random::new(0xc057);
    let hulls = [1, 2].map(|seed| Shape::from_mesh(&random_hull(20, seed).unwrap(), &ShapeOptions::default()).unwrap());
    let (mut queries, mut hits) = (0, 0);
    const MOTIONS: u32 = 60;
    for _ in 0..MOTIONS {
        let velocity = random.direction() * random.uniform(4.0, 8.0);
        let start = Pose::new(&random.rotation(), &(random.vector() * 0.5 - velocity * 0.5));
        let other = Pose::new(&random.rotation(), &Vector::zeros());
        let spins = [0, 1].map(|_| random.direction() * 2.0);
        let motions = [screw(start, velocity.into(), spins[0].into()), screw(other, [0.0; 3], spins[1].into())];
        let bodies = moving([&hulls[0], &hulls[1]], [&motions[0], &motions[1]]);
        let answer = run(bodies, &CastConfig::default());
        verify_cast(bodies, &CastConfig::default(), &answer).unwrap();
        queries += answer.queries;
        if answer.outcome == CastOutcome::Hit {
            assert!(answer.time_upper - answer.time_lower <= 1.01e-9, "{answer:?}");
            hits += 1;
        }
    }
    assert!(hits > MOTIONS / 2 && queries <= 12 * MOTIONS, "{queries} queries, {hits} hits");
}

/// A corner passes a wall at 1e-12: steps grow as they leave, and by the curve of the distance they grow fast. It took 30 queries.
#[test]
fn a_corner_passes_a_wall_in_few_queries() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let [prism, wall] = [cuboid([half, half, 0.3]), cuboid([0.5, 5.0, 5.0])];
    let mut random = Random::new(0x94a2e);
    let mut queries = 0;
    const MOTIONS: u32 = 20;
    for _ in 0..MOTIONS {
        let world = Pose::new(&random.rotation(), &random.vector());
        let stands = Pose::new(&world.rotation(), &world.transform(&Vector::new(1.5 + 1e-12, 0.0, 0.0)));
        let motions = [screw(world, [0.0; 3], (world.rotate(&Vector::z()) * 1.5).into()), Motion::Fixed(stands)];
        let bodies = moving([&prism, &wall], [&motions[0], &motions[1]]);
        let answer = run(bodies, &CastConfig::default());
        assert_eq!(answer.outcome, CastOutcome::Free);
        verify_cast(bodies, &CastConfig::default(), &answer).unwrap();
        queries += answer.queries;
    }
    assert!(queries <= 18 * MOTIONS, "{queries} queries");
}
