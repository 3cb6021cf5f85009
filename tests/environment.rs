//! The floating-point environment where the door of C does not set it: integers that decide in any, panics that unwind, and no
//! number without a value. c_tests/process/environment.c tests that every call answers alike in all environments.

use std::panic::{AssertUnwindSafe, catch_unwind};

use swiftprox::base::simd::environment::{Environment, is_invalid};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::manifold::{ManifoldConfig, ManifoldPoint, half_space_manifold, manifold};
use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, Motion, Moving, cast};
use swiftprox::pair::{self, HalfSpace, Levels, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;
use swiftprox::point::locate_point;
use swiftprox::progress::Progress;
use swiftprox::ray::{Ray, cast_ray};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::shape_file;
use swiftprox::verify::verify;
use testkit::hard::flight::{poses, shapes};
use testkit::hard::{Sequence, families};
use testkit::shapes::at;

const QUERIES: [Query; 4] = [pair::distance, pair::intersection, pair::contact, pair::approximate];
type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

/// The bodies of a sequence with levels.
fn with_levels(sequence: &Sequence) -> Option<[Shape; 2]> {
    let hierarchy =
        HierarchyOptions { kind: HierarchyKind::Quadric, minimum_triangles: 4, ..HierarchyOptions::default() };
    let options = ShapeOptions { input: InputPolicy::Hull, hierarchy, ..ShapeOptions::default() };
    let [first, second] = sequence.bodies.each_ref().map(|body| Shape::from_mesh(body, &options));
    Some([first.ok()?, second.ok()?])
}

/// Two sequences a family, a few poses each.
fn sequences() -> impl Iterator<Item = (Sequence, Vec<[Pose; 2]>)> {
    families().flat_map(|family| [0, family.sweep / 2].map(|index| family.sequence(1, index))).map(|sequence| {
        let some = sequence.poses.iter().step_by(sequence.poses.len().div_ceil(6)).map(poses).collect();
        (sequence, some)
    })
}

/// The integers decide by bits: what they say is the same in every environment, without anybody's help.
#[test]
fn integers_decide_alike_in_every_environment() {
    let needle = |scale: f64| {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 1.0, 0.2], [0.2, 0.3, 1.0], [0.8, 0.9, 0.7]];
        let points: Vec<Vector> = points.iter().map(|p| scale * Vector::from(*p)).collect();
        Shape::from_points(&points, &ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() }).unwrap()
    };
    for scale in [1e300, 1.7e308, 1e150, 1.0, 1e-150, 1e-290, 1e-307, 1e-310, 2e-322] {
        let body = needle(scale);
        for gap in [-0.5, 0.0, 1e-300, 0.3, 0.9999, 1.0, 1.5, 1.7] {
            let pose = at(gap * scale, 0.25 * gap * scale, if gap == 0.0 { -scale } else { 0.0 });
            let solve = || {
                let answer = exact::solve(
                    &Pair { polyhedra: [body.polyhedron(), body.polyhedron()], poses: [&pose, &Pose::IDENTITY] },
                    &[[0, 1]],
                );
                (answer.intersecting, answer.lower.to_bits(), answer.upper.to_bits(), answer.pairs, answer.iterations)
            };
            let expected = solve();
            // Their filter overflows for the largest bodies, which is no fault where it is not trapped.
            for environment in Environment::all().filter(|environment| !environment.traps) {
                assert_eq!(environment.run(solve), expected, "{environment:?} {scale:e} {gap}");
            }
        }
    }
}

/// Round bodies answer alike in every environment, from Rust, too. Their radii were added outside the default one: rounded down,
/// the upper end of a depth was an ulp short; where subnormal numbers are flushed a tiny radius counted as none.
#[test]
fn round_bodies_answer_alike_in_every_environment() {
    let tetrahedron = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 1.0, 0.2], [0.2, 0.3, 1.0]].map(Vector::from);
    let round = |swept_radius: f64| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
        Shape::from_points(&tetrahedron, &options).unwrap()
    };
    for radii in [[0.1, 0.3], [1e-17, 0.7], [0.0, 0.3], [0.0, 5e-324], [2e-310, 3e-310]] {
        let [first, second] = radii.map(round);
        for x in [0.25, 1.0, 1.3, 4.0] {
            let pose = at(x, 0.1, 0.05);
            let bodies = [first.at(&pose), second.at(&Pose::IDENTITY)];
            let ask = || {
                let answers = QUERIES.map(|query| {
                    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                    query(bodies, &mut cache, &PairConfig::default(), &mut answer).unwrap();
                    answer
                });
                let mut depth = pair::DepthAnswer::default();
                pair::depth(bodies, &mut Default::default(), &Default::default(), &mut depth).unwrap();
                (answers, depth)
            };
            let expected = format!("{:?}", ask());
            for environment in Environment::all() {
                let told = environment.run(ask);
                assert_eq!(format!("{told:?}"), expected, "{environment:?} {radii:?} {x}");
            }
        }
    }
}

/// Refusals read alike in every environment: a NaN is compared and printed there. Refused half-spaces, and tolerances of pairs,
/// ended programs that trap invalid operations.
#[test]
fn what_is_refused_is_told_in_every_environment() {
    let tetrahedron = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.9, 1.0, 0.2], [0.2, 0.3, 1.0]].map(Vector::from);
    let body = Shape::from_points(&tetrahedron, &ShapeOptions::default()).unwrap();
    let round = ShapeOptions { swept_radius: 0.5, ..ShapeOptions::default() };
    let round = Shape::from_points(&tetrahedron, &round).unwrap();
    let [here, there] = [Pose::IDENTITY, at(3.0, 0.0, 0.0)];
    let bodies = [body.at(&here), body.at(&there)];
    let mut skewed = here;
    skewed.rows[0][1] = f64::NAN;
    for number in [f64::NAN, f64::NEG_INFINITY, -5e-324] {
        let pair_config = PairConfig { max_distance: number, ..PairConfig::default() };
        let points = || vec![ManifoldPoint::default(); 8];
        let manifold_config = ManifoldConfig { max_distance: number, ..ManifoldConfig::default() };
        let floor = HalfSpace { normal: [0.0, 0.0, number], offset: number };
        let ask = || {
            let mut told = Vec::new();
            for query in QUERIES {
                let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                told.push(query(bodies, &mut cache, &pair_config, &mut answer).err());
                let swept = [round.at(&here), bodies[1]];
                told.push(query(swept, &mut cache, &pair_config, &mut answer).err());
                let unplaced = [body.at(&skewed), body.at(&there)];
                told.push(query(unplaced, &mut cache, &PairConfig::default(), &mut answer).err());
            }
            let mut signed = pair::SignedDistance::default();
            told.push(pair::signed_distance(bodies, &mut Default::default(), &pair_config, &mut signed).err());
            let deep = pair::DepthConfig { absolute_error: number, ..Default::default() };
            told.push(pair::depth(bodies, &mut Default::default(), &deep, &mut Default::default()).err());
            told.push(manifold(bodies, &mut Default::default(), &manifold_config, &mut points()).err());
            told.push(pair::half_space_distance(bodies[0], &floor).err().filter(|_| !number.is_finite()));
            told.push(half_space_manifold(bodies[0], &floor, &manifold_config, &mut points()).err());
            told.push(locate_point(bodies[0], [number; 3]).err().filter(|_| !number.is_finite()));
            told.push(body.scaled(number, &mut Progress::new(&mut |_| true)).err());
            let ray = Ray { origin: [0.0; 3], direction: [1.0; 3], t_max: number };
            told.push(cast_ray(bodies[0], &ray).err());
            told.push(
                Shape::from_points(&tetrahedron, &ShapeOptions { swept_radius: number, ..Default::default() }).err(),
            );
            let (fixed, time) = (Motion::Fixed(here), CastConfig { time_tolerance: number, ..Default::default() });
            let moving = [Moving { shape: &body, motion: &fixed }; 2];
            told.push(cast(moving, &mut PairCache::default(), &time, &mut CastAnswer::default()).err());
            format!("{told:?}")
        };
        let expected = ask();
        for environment in Environment::all() {
            assert_eq!(environment.run(ask), expected, "{environment:?} {number:e}");
        }
    }
}

/// A panic of the program's own, through frames of the library.
#[test]
fn unwinding_puts_the_environment_back() {
    let corners: Vec<Vector> = (0..40).map(|k| Vector::new(f64::from(k), f64::from(k * k), f64::from(k % 7))).collect();
    for environment in Environment::all() {
        environment.run(|| {
            let ended = catch_unwind(AssertUnwindSafe(|| {
                let mut learn = |_: f64| -> bool { std::panic::resume_unwind(Box::new("the program's own")) };
                Shape::from_points_in_steps(&corners, &ShapeOptions::default(), &mut Progress::new(&mut learn))
            }));
            assert!(ended.is_err() && environment.is_set(), "{environment:?}");
            let built = Shape::from_points(&corners, &ShapeOptions::default());
            assert!(built.is_ok() && environment.is_set(), "{environment:?}");
        });
    }
}

/// No 0/0, no ∞ − ∞, no division by zero: what has no value is not computed and thrown away.
#[test]
fn nothing_without_a_value_is_computed() {
    let mut invalid = Vec::new();
    for (sequence, poses) in sequences() {
        if is_invalid(|| shapes(&sequence)) {
            invalid.push(format!("{}: its shapes", sequence.name));
        }
        if is_invalid(|| with_levels(&sequence)) {
            invalid.push(format!("{}: its levels", sequence.name));
        }
        let plain = shapes(&sequence).unwrap();
        for made in [Some(plain), with_levels(&sequence)].into_iter().flatten() {
            if is_invalid(|| shape_file::from_bytes(&shape_file::to_bytes(&made[0]).unwrap())) {
                invalid.push(format!("{}: loading", sequence.name));
            }
            for query in QUERIES {
                let mut cache = PairCache::default();
                for (number, [pose1, pose2]) in poses.iter().enumerate() {
                    let config = PairConfig { relative_error: 0.01, levels: Levels::All, ..PairConfig::default() };
                    let mut answer = PairAnswer::default();
                    let ask = || query([made[0].at(pose1), made[1].at(pose2)], &mut cache, &config, &mut answer);
                    if is_invalid(ask) {
                        invalid.push(format!("{} at pose {number}: {answer:?}", sequence.name));
                    }
                    if is_invalid(|| verify([made[0].at(pose1), made[1].at(pose2)], &answer)) {
                        invalid.push(format!("{} at pose {number}: verified", sequence.name));
                    }
                }
            }
        }
    }
    assert!(invalid.is_empty(), "{} of them: {:#?}", invalid.len(), &invalid[..invalid.len().min(20)]);
}
