//! Casts of moving bodies at grounds: what is known in closed form, and certain distances at times before and after.

use super::{hills, level};
use swiftprox::error::Error;
use swiftprox::ground::{Ground, ground_cast, ground_distance};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, Moving, Screw};
use swiftprox::pair::{Outcome, PairConfig, Query};
use swiftprox::shape::Shape;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

fn screw(start: Pose, velocity: Vector, turn: Vector) -> Motion<'static> {
    Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation: turn })
}

/// The pose of such a motion, up to rounding.
fn pose_at(start: &Pose, velocity: &Vector, turn: &Vector, time: f64) -> Pose {
    let angle = turn.norm() * time;
    let turned = if angle == 0.0 { Matrix::identity() } else { rotation(&turn.normalize(), angle) };
    Pose::new(&(turned * start.rotation()), &(start.translation() + velocity * time))
}

/// Cubes and balls that fall on a level grid, from near and from far away.
#[test]
fn bodies_that_fall_meet_level_ground_when_they_are_there() {
    let ground = level(101, 101, 1.0);
    let place = ground.at(&Pose::IDENTITY);
    for shape in [cuboid([0.5; 3]), Shape::from_sphere(0.5).unwrap()] {
        for height in [0.75, 3.0, 1e3] {
            let motion = screw(at(50.25, 50.75, height), Vector::new(0.5, 0.0, -4.0 * (height - 0.5)), Vector::zeros());
            let body = Moving { shape: &shape, motion: &motion };
            let found = ground_cast(body, place, &CastConfig::default()).unwrap();
            assert_eq!(found.answer.outcome, CastOutcome::Hit);
            let (lower, upper) = (found.answer.time_lower, found.answer.time_upper);
            assert!(lower <= 0.25 && 0.25 <= upper && upper - lower <= 1.000001e-9, "{lower} to {upper} from {height}");
            assert!(found.triangle < 20_000 && (found.answer.contact.normal[2] - 1.0).abs() < 1e-12);
            // Within a distance it comes sooner: 0.25·(1 − 0.1/(height − 0.5)).
            let near = CastConfig { max_distance: 0.1, ..CastConfig::default() };
            let found = ground_cast(body, place, &near).unwrap().answer;
            let time = 0.25 * (1.0 - 0.1 / (height - 0.5));
            assert!(found.time_lower <= time + 1e-12 && time - 1e-12 <= found.time_upper, "{found:?} {time}");
            // It ends before.
            let short = CastConfig { time_end: 0.125, ..CastConfig::default() };
            let found = ground_cast(body, place, &short).unwrap();
            assert_eq!((found.answer.outcome, found.triangle), (CastOutcome::Free, 20_000));
            assert!(found.answer.clearance > 0.0 && found.answer.clearance <= 0.5 * (height - 0.5));
        }
    }
}

/// Hulls that turn as they fly over hills and through soups, over grounds that are turned and moved: the ground is certainly
/// farther away before, and certainly touched after, by distances that integers decide where rounding hides them.
#[test]
fn times_are_between_certain_distances() {
    let mut random = Random::new(0xca57);
    let (mut hits, mut free) = (0, 0);
    for round in 0..240 {
        let (mut vertices, mut triangles) = hills(&mut random, 6, 0.8);
        if round % 4 == 0 {
            vertices = (0..20).map(|_| random.vector() * 3.0).collect();
            triangles = (0..20).map(|_| std::array::from_fn(|_| random.below(20) as u32)).collect();
        }
        let Ok(ground) = Ground::from_triangles(&vertices, &triangles) else { continue };
        let place = match round % 3 {
            0 => Pose::IDENTITY,
            _ => Pose::new(&random.rotation(), &(random.vector() * 100.0)),
        };
        let cloud: Vec<Vector> = (0..10).map(|_| random.vector() * 0.3).collect();
        let shape = hull(&cloud);
        let from = place.transform(&Vector::new(random.uniform(-1.0, 6.0), random.uniform(-1.0, 6.0), 2.0));
        let to = place.transform(&Vector::new(random.uniform(-1.0, 6.0), random.uniform(-1.0, 6.0), random.signed()));
        let (start, velocity) = (Pose::new(&random.rotation(), &from), to - from);
        let turn = if round % 5 == 0 { Vector::zeros() } else { random.vector() * 3.0 };
        let motion = screw(start, velocity, turn);
        let config = CastConfig { time_tolerance: 1e-7, ..CastConfig::default() };
        let found = ground_cast(Moving { shape: &shape, motion: &motion }, ground.at(&place), &config).unwrap();
        let distance = |time: f64| {
            let pose = pose_at(&start, &velocity, &turn, time);
            ground_distance(Query::Distance, shape.at(&pose), ground.at(&place), &PairConfig::default()).unwrap().answer
        };
        /// Poses of this test are off by less.
        const OFF: f64 = 1e-11;
        let end = match found.answer.outcome {
            CastOutcome::Free => {
                free += 1;
                assert_eq!(found.triangle as usize, triangles.len());
                1.0
            }
            CastOutcome::Hit => {
                hits += 1;
                let after = distance(found.answer.time_upper);
                assert!(after.outcome == Outcome::Intersecting || after.lower <= OFF, "{after:?} of {found:?}");
                assert!((found.triangle as usize) < triangles.len());
                found.answer.time_lower
            }
            other => panic!("{other:?}: {found:?}"),
        };
        for k in 0..20 {
            let before = distance(end * f64::from(k) / 20.0);
            assert!(end == 0.0 || before.outcome == Outcome::Separated, "{before:?} at {k}/20 of {end}");
            if found.answer.outcome == CastOutcome::Free {
                assert!(found.answer.clearance <= before.upper + OFF, "{before:?} {found:?}");
            }
        }
    }
    assert!(hits > 60 && free > 30, "{hits} {free}");
}

#[test]
fn casts_at_grounds_refuse_what_they_cannot_do() {
    let ground = level(2, 2, 1.0);
    let shape = cuboid([0.5; 3]);
    let motion = screw(at(0.0, 0.0, 3.0), Vector::zeros(), Vector::zeros());
    let ask = |config: CastConfig| {
        ground_cast(Moving { shape: &shape, motion: &motion }, ground.at(&Pose::IDENTITY), &config)
    };
    assert!(matches!(ask(CastConfig { ignores_parting: true, ..CastConfig::default() }), Err(Error::Argument(_))));
    assert!(matches!(ask(CastConfig { time_end: -1.0, ..CastConfig::default() }), Err(Error::Argument(_))));
    assert!(ask(CastConfig::default()).is_ok());
}

/// A cylinder that falls on level ground touches it when it is there, up to what its deviation hides.
#[test]
fn curved_bodies_meet_ground_within_their_deviation() {
    let ground = level(5, 5, 1.0);
    let shape = Shape::from_cylinder(0.5, 0.5, 1e-2).unwrap();
    let motion = screw(at(2.25, 2.75, 1.5), Vector::new(0.0, 0.0, -4.0), Vector::zeros());
    let moving = Moving { shape: &shape, motion: &motion };
    let found = ground_cast(moving, ground.at(&Pose::IDENTITY), &CastConfig::default()).unwrap().answer;
    assert_eq!(found.outcome, CastOutcome::Hit);
    // What the deviation takes at that speed.
    let hidden = 0.25 * shape.deviation();
    assert!((0.25 - hidden - 1e-9..=0.25).contains(&found.time_lower), "{found:?}");
    assert!((0.25..=0.25 + hidden).contains(&found.time_upper), "{found:?}");
    let short = CastConfig { time_end: 0.2, ..CastConfig::default() };
    assert_eq!(ground_cast(moving, ground.at(&Pose::IDENTITY), &short).unwrap().answer.outcome, CastOutcome::Free);
}
