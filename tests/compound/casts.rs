//! Casts of compounds, against all pairs of pieces cast one by one and against closed forms.

use super::bodies::{self, Body};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use swiftprox::compound::{
    Compound, CompoundAnswer, CompoundCache, CompoundCastAnswer, MovingCompound, Piece, cast, distance, verify_cast,
};
use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{self, Callback, CastAnswer, CastConfig, CastOutcome, Motion, Moving, Screw};
use swiftprox::pair::{PairCache, PairConfig};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::new(&Matrix::identity(), &Vector::new(x, y, z))
}

fn asked(bodies: [MovingCompound; 2], cache: &mut CompoundCache, config: &CastConfig) -> CompoundCastAnswer {
    let mut answer = CompoundCastAnswer::default();
    cast(bodies, cache, config, &mut answer).unwrap();
    answer
}

fn cold(bodies: [MovingCompound; 2], config: &CastConfig) -> CompoundCastAnswer {
    asked(bodies, &mut CompoundCache::default(), config)
}

fn screw(random: &mut Random, spread: f64) -> Motion<'static> {
    let start = bodies::pose(random, spread);
    let velocity = random.vector() * 3.0 - start.translation();
    let rotation = random.vector() * [0.0, 1.0, 4.0][random.below(3)];
    Motion::Screw(Screw { start, centre: random.vector(), velocity, rotation })
}

/// The first and the last time that any two pieces, which are at the identity, say of their contact, and whether one is undecided.
struct BruteForce {
    first: [f64; 2],
    hits: bool,
    is_open: bool,
}

fn brute_force(bodies: [MovingCompound; 2], config: &CastConfig) -> BruteForce {
    let mut all = BruteForce { first: [f64::INFINITY; 2], hits: false, is_open: false };
    for one in bodies[0].compound.pieces() {
        for two in bodies[1].compound.pieces() {
            assert!(one.pose == Pose::IDENTITY && two.pose == Pose::IDENTITY);
            let moving = [(&one.shape, bodies[0].motion), (&two.shape, bodies[1].motion)]
                .map(|(shape, motion)| Moving { shape, motion });
            let mut answer = CastAnswer::default();
            motion::cast(moving, &mut PairCache::default(), config, &mut answer).unwrap();
            match answer.outcome {
                CastOutcome::Free => continue,
                CastOutcome::Hit => {
                    all.hits = true;
                    all.first[1] = all.first[1].min(answer.time_upper);
                }
                _ => all.is_open = true,
            }
            all.first[0] = all.first[0].min(answer.time_lower);
        }
    }
    all
}

/// Rings and gears on screws, one cache for many motions.
#[test]
fn the_first_contact_is_that_of_all_pairs() {
    let mut random = Random::new(0xca);
    let pairs: [[Body; 2]; 3] = [
        [bodies::torus(12), bodies::gear(7)],
        [bodies::gear(9), bodies::gear(8)],
        [bodies::torus(16), bodies::torus(3)],
    ];
    let mut seen = [0; 2];
    let (mut queries, mut most) = (0, 0);
    for [one, two] in &pairs {
        let mut cache = CompoundCache::default();
        for round in 0..40 {
            let motions = [screw(&mut random, 1.0), screw(&mut random, 4.0)];
            let motions =
                if round % 4 == 0 { [Motion::Fixed(bodies::pose(&mut random, 1.0)), motions[1]] } else { motions };
            let max_distance = [0.0, 0.0, 0.25][round % 3];
            let config = CastConfig { max_distance, time_begin: -0.5, ..CastConfig::default() };
            let moving = |i: usize| MovingCompound { compound: [&one.compound, &two.compound][i], motion: &motions[i] };
            let placed = [moving(0), moving(1)];
            let all = brute_force(placed, &config);
            let found = asked(placed, &mut cache, &config);
            let said = &found.answer;
            verify_cast(placed, &config, &found).unwrap();
            if all.hits {
                assert_eq!(said.outcome, CastOutcome::Hit);
                assert!(
                    said.time_lower <= all.first[1] && all.first[0] <= said.time_upper,
                    "{found:?} {:?}",
                    all.first
                );
                assert!(all.is_open || said.time_upper - said.time_lower <= config.time_tolerance, "{found:?}");
                seen[0] += 1;
            } else if !all.is_open {
                assert_eq!(said.outcome, CastOutcome::Free);
                let counts = [one.compound.piece_count() as u32, two.compound.piece_count() as u32];
                assert!([found.piece1, found.piece2] == counts && said.clearance >= max_distance);
                for k in 0..=10 {
                    let time = -0.5 + 0.15 * f64::from(k);
                    let poses = motions.map(|motion| pose_at(&motion, time));
                    let mut answer = CompoundAnswer::default();
                    let placed = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
                    distance(placed, &mut CompoundCache::default(), &PairConfig::default(), &mut answer).unwrap();
                    assert!(answer.answer.upper >= said.clearance);
                }
                seen[1] += 1;
            }
            queries += said.queries as usize;
            most += one.compound.piece_count() * two.compound.piece_count();
        }
    }
    assert!(seen.iter().all(|count| *count > 15), "{seen:?}");
    assert!(3 * queries < most, "{queries} queries, {most} pairs of pieces");
}

/// By Rodrigues' formula.
fn pose_at(motion: &Motion, time: f64) -> Pose {
    let Motion::Screw(Screw { start, centre, velocity, rotation }) = motion else {
        let Motion::Fixed(pose) = motion else { panic!("of screws") };
        return *pose;
    };
    let turn = match rotation.norm() * time {
        0.0 => Matrix::identity(),
        angle => testkit::random::rotation(&rotation.normalize(), angle),
    };
    let turned = turn * start.rotation();
    Pose::new(&turned, &(start.transform(centre) + velocity * time - turned * centre))
}

fn cube(half: f64) -> Arc<Shape> {
    Arc::new(testkit::shapes::cuboid([half; 3]))
}

fn row(places: &[[f64; 3]]) -> Compound {
    let shape = cube(1.0);
    let piece = |[x, y, z]: &[f64; 3]| Piece { shape: shape.clone(), pose: at(*x, *y, *z) };
    Compound::new(&places.iter().map(piece).collect::<Vec<_>>()).unwrap()
}

/// A staircase of cubes and a cube that comes from above: which step it meets, and when, in closed form.
#[test]
fn translations_in_closed_form() {
    let stairs = row(&[[0.0, 0.0, 0.0], [3.0, 0.0, 1.0], [6.0, 0.0, 2.0], [9.0, 0.0, 3.0]]);
    let block = row(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.5]]);
    let still = Motion::Fixed(Pose::IDENTITY);
    for (x, step, part) in [(0.0, 1, 1), (3.0, 2, 1), (6.0, 3, 1), (9.0, 3, 0), (-3.0, 0, 1), (12.0, 4, 2)] {
        // The second cube of the block is half a unit above the first, the steps rise by one.
        let fall = Motion::Affine { start: at(x, 0.0, 16.0), end: at(x, 0.0, 0.0) };
        let bodies =
            [MovingCompound { compound: &stairs, motion: &still }, MovingCompound { compound: &block, motion: &fall }];
        for max_distance in [0.0, 0.5] {
            let config = CastConfig { max_distance, ..CastConfig::default() };
            let found = cold(bodies, &config);
            assert_eq!([found.piece1, found.piece2], [step, part]);
            verify_cast(bodies, &config, &found).unwrap();
            if step == 4 {
                // One apart along x all the way down.
                assert_eq!(found.answer.outcome, CastOutcome::Free);
                assert!(max_distance <= found.answer.clearance && found.answer.clearance <= 1.0, "{found:?}");
                continue;
            }
            let top = f64::from(step) + 1.0 + max_distance;
            let bottom = if part == 0 { 15.0 } else { 15.5 };
            let time = (bottom - top) / 16.0;
            let said = &found.answer;
            assert!(said.time_lower <= time && time <= said.time_upper && said.time_upper - said.time_lower <= 1e-9);
            assert!(
                (said.contact.normal[2] + 1.0).abs() < 1e-12 && said.contact.lower <= max_distance + 1e-7,
                "{said:?}"
            );
        }
    }
}

/// A carousel of balls against a wall: the k-th ball of n, a radius L from the axis, meets it where L·cos(ωt + 2πk/n) = d − r.
#[test]
fn turns_in_closed_form() {
    let mut random = Random::new(0xcb);
    let (count, lever, radius) = (7, 2.0, 0.25);
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, ..ShapeOptions::default() };
    let ball = Arc::new(Shape::from_points(&[Vector::zeros()], &options).unwrap());
    let angle_of = |k: usize| TAU * k as f64 / count as f64;
    let piece =
        |k: usize| Piece { shape: ball.clone(), pose: at(lever * angle_of(k).cos(), lever * angle_of(k).sin(), 0.0) };
    let carousel = Compound::new(&(0..count).map(piece).collect::<Vec<_>>()).unwrap();
    let wall = row(&[[1.0, -4.0, 0.0], [1.0, -2.0, 0.0], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 4.0, 0.0]]);
    for _ in 0..60 {
        let (phase, speed) = (random.uniform(0.0, TAU), random.uniform(0.2, 9.0));
        let wall_at = random.uniform(1.9, 2.2);
        let (still, start) = (
            Motion::Fixed(at(wall_at + radius, 0.0, 0.0)),
            Pose::new(&testkit::random::rotation(&Vector::z(), phase), &Vector::zeros()),
        );
        let turns = Motion::Screw(Screw {
            start,
            centre: Vector::zeros(),
            velocity: Vector::zeros(),
            rotation: Vector::z() * speed,
        });
        let bodies = [
            MovingCompound { compound: &carousel, motion: &turns },
            MovingCompound { compound: &wall, motion: &still },
        ];
        let found = cold(bodies, &CastConfig::default());
        verify_cast(bodies, &CastConfig::default(), &found).unwrap();
        let meets = |k: usize| {
            // The first angle from here on at which the cosine is so large; NaN where it never is.
            let reached = (wall_at / lever).acos();
            let now = (phase + angle_of(k) + PI).rem_euclid(TAU) - PI;
            let ahead = if now.abs() <= reached { 0.0 } else { (-reached - now).rem_euclid(TAU) };
            ahead / speed
        };
        let time = (0..count).map(meets).fold(f64::INFINITY, f64::min);
        let said = &found.answer;
        if time <= 1.0 - 1e-6 {
            assert_eq!(said.outcome, CastOutcome::Hit);
            assert!(said.time_lower - 1e-12 <= time && time <= said.time_upper + 1e-12, "{time} {said:?}");
            assert!((meets(found.piece1 as usize) - time).abs() < 1e-8);
        } else if !(time < 1.0 + 1e-6) {
            assert_eq!(said.outcome, CastOutcome::Free);
            assert!(said.clearance <= (wall_at - lever).max(0.0) + lever, "{said:?}");
        }
    }
}

/// A pair that is far apart all along takes no query, nor do pairs that go along with each other.
#[test]
fn boxes_alone_free_what_is_far() {
    let (one, two) = (bodies::gear(40), bodies::placed_torus(60));
    let mut random = Random::new(0xcc);
    for _ in 0..20 {
        let turn = |x: f64, random: &mut Random| {
            Motion::Screw(Screw {
                start: Pose::new(&random.rotation(), &Vector::new(x, 0.0, 0.0)),
                centre: Vector::zeros(),
                velocity: Vector::new(50.0, 0.0, 0.0),
                rotation: random.vector() * 3.0,
            })
        };
        let motions = [turn(0.0, &mut random), turn(2.8, &mut random)];
        let bodies = [
            MovingCompound { compound: &one.compound, motion: &motions[0] },
            MovingCompound { compound: &two.compound, motion: &motions[1] },
        ];
        let found = cold(bodies, &CastConfig::default());
        assert_eq!(found.answer.outcome, CastOutcome::Free);
        assert!(found.answer.clearance > 0.0 && found.answer.clearance <= 2.8, "{found:?}");
        verify_cast(bodies, &CastConfig::default(), &found).unwrap();
        let away = Motion::Fixed(at(-9.0, 0.0, 0.0));
        let found = cold([MovingCompound { motion: &away, ..bodies[0] }, bodies[1]], &CastConfig::default());
        assert_eq!((found.answer.outcome, found.answer.queries), (CastOutcome::Free, 0));
        assert!(found.answer.clearance > 1.0);
    }
}

fn is_unverified(bodies: [MovingCompound; 2], config: &CastConfig, answer: &CompoundCastAnswer) -> bool {
    matches!(verify_cast(bodies, config, answer), Err(Error::Unverified(_)))
}

#[test]
fn forgeries_are_not_proved() {
    let stairs = row(&[[0.0, 0.0, 0.0], [3.0, 0.0, 1.0]]);
    let block = row(&[[0.0, 0.0, 0.0], [3.0, 0.0, 0.0]]);
    let (still, fall) =
        (Motion::Fixed(Pose::IDENTITY), Motion::Affine { start: at(0.0, 0.0, 9.0), end: at(0.0, 0.0, 0.0) });
    let bodies =
        [MovingCompound { compound: &stairs, motion: &still }, MovingCompound { compound: &block, motion: &fall }];
    let config = CastConfig::default();
    let found = cold(bodies, &config);
    assert_eq!([found.piece1, found.piece2], [1, 1]);
    // What holds of the pieces that are named, and not of all: the lower step alone, cast as a compound of its own.
    let lower = row(&[[0.0, 0.0, 0.0]]);
    let alone = [MovingCompound { compound: &lower, ..bodies[0] }, MovingCompound { compound: &lower, ..bodies[1] }];
    let later = cold(alone, &config);
    verify_cast(alone, &config, &later).unwrap();
    assert!(later.answer.time_lower > found.answer.time_upper);
    assert!(is_unverified(bodies, &config, &later));
    let mut swapped = found;
    (swapped.piece1, swapped.piece2) = (0, 0);
    assert!(is_unverified(bodies, &config, &swapped));
    swapped.piece1 = 2;
    assert!(matches!(verify_cast(bodies, &config, &swapped), Err(Error::Argument(_))));

    let away = Motion::Affine { start: at(0.0, 5.0, 9.0), end: at(0.0, 5.0, 0.0) };
    let bodies = [bodies[0], MovingCompound { motion: &away, ..bodies[1] }];
    let mut free = cold(bodies, &config);
    assert_eq!(free.answer.outcome, CastOutcome::Free);
    verify_cast(bodies, &config, &free).unwrap();
    free.answer.clearance = 2.9;
    verify_cast(bodies, &config, &free).unwrap();
    free.answer.clearance = 3.1;
    assert!(is_unverified(bodies, &config, &free));
    let mut free = found;
    free.answer = CastAnswer { outcome: CastOutcome::Free, time_lower: 1.0, clearance: 0.0, ..CastAnswer::default() };
    (free.piece1, free.piece2) = (2, 2);
    assert!(is_unverified(bodies_of(&stairs, &still, &block, &fall), &config, &free));
}

fn bodies_of<'a>(
    one: &'a Compound,
    motion1: &'a Motion<'a>,
    two: &'a Compound,
    motion2: &'a Motion<'a>,
) -> [MovingCompound<'a>; 2] {
    [MovingCompound { compound: one, motion: motion1 }, MovingCompound { compound: two, motion: motion2 }]
}

/// Contact at the beginning, ranges of no length, spins of thousands of turns, sizes near the ends, callbacks, a budget of one.
#[test]
fn hard_motions_end() {
    let (ring, gear) = (bodies::torus(9), bodies::gear(5));
    let spin = |x: f64, speed: f64, scale: f64| {
        Motion::Screw(Screw {
            start: at(x * scale, 0.0, 0.0),
            centre: Vector::zeros(),
            velocity: Vector::zeros(),
            rotation: Vector::new(0.1, 0.2, 1.0) * speed,
        })
    };
    let (fast, faster) = (spin(0.0, 1e4, 1.0), spin(2.6, 2e4, 1.0));
    let bodies = bodies_of(&ring.compound, &fast, &gear.compound, &faster);
    let config = CastConfig { time_tolerance: 1e-7, step_budget: 50, ..CastConfig::default() };
    let found = cold(bodies, &config);
    assert!(matches!(found.answer.outcome, CastOutcome::Hit | CastOutcome::Free | CastOutcome::Budget), "{found:?}");
    verify_cast(bodies, &config, &found).unwrap();

    let here = Motion::Fixed(at(1.0, 0.0, 0.0));
    let met = bodies_of(&ring.compound, &here, &gear.compound, &faster);
    for time_end in [0.0, 1.0] {
        let config = CastConfig { time_end, ..CastConfig::default() };
        let found = cold(met, &config);
        assert_eq!(
            (found.answer.outcome, found.answer.time_lower, found.answer.time_upper),
            (CastOutcome::Hit, 0.0, 0.0)
        );
        verify_cast(met, &config, &found).unwrap();
    }

    let pose = |time: f64| at(5.0 - 4.0 * time * time, 0.0, 0.0);
    let called = Motion::Callback(Callback { pose: &pose, bend: 8.0, rounding: 1e-15 });
    let rests = Motion::Fixed(Pose::IDENTITY);
    let line = row(&[[0.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, -5.0, 0.0]]);
    let bodies = bodies_of(&line, &rests, &line, &called);
    let found = cold(bodies, &CastConfig::default());
    let time = 0.75_f64.sqrt();
    assert!(found.answer.time_lower <= time + 1e-12 && time - 1e-12 <= found.answer.time_upper, "{found:?}");
    verify_cast(bodies, &CastConfig::default(), &found).unwrap();

    for scale in [1e-160, 1e55] {
        let piece = |x: f64| {
            let corners: Vec<Vector> =
                (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 0 { 0.0 } else { scale })).collect();
            (corners, at(x * scale, 0.0, 0.0))
        };
        let body = Body::new(vec![piece(0.0), piece(2.0)]);
        let falls = Motion::Affine { start: at(0.5 * scale, 0.0, 9.0 * scale), end: at(0.5 * scale, 0.0, 0.0) };
        let bodies = bodies_of(&body.compound, &rests, &body.compound, &falls);
        let found = cold(bodies, &CastConfig::default()).answer;
        let time = 8.0 / 9.0;
        assert!(found.time_lower <= time + 1e-12 && time - 1e-12 <= found.time_upper, "{scale:e}: {found:?}");
    }
}

#[test]
fn refusals_say_what_is_wrong() {
    let body = row(&[[0.0; 3]]);
    let rests = Motion::Fixed(Pose::IDENTITY);
    let mut answer = CompoundCastAnswer::default();
    let mut refused = |motion: &Motion, config: &CastConfig| {
        let bodies = bodies_of(&body, &rests, &body, motion);
        let said = cast(bodies, &mut CompoundCache::default(), config, &mut answer).unwrap_err().message().to_string();
        assert_eq!(answer.answer.outcome, CastOutcome::None);
        said
    };
    let parts = CastConfig { ignores_parting: true, ..CastConfig::default() };
    assert!(refused(&rests, &parts).contains("ignores_parting"));
    assert!(refused(&rests, &CastConfig { max_distance: -1.0, ..CastConfig::default() }).contains("max_distance"));
    let skewed = Motion::Fixed(Pose::new(&(Matrix::identity() * 2.0), &Vector::zeros()));
    assert!(refused(&skewed, &CastConfig::default()).starts_with("object 2: the rotation"));
}
