//! Whatever floating-point environment a program has set, the library builds the same shapes and gives the same answers bit for
//! bit, calls the program's own functions in the program's environment, and leaves that as it was.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use swiftprox::base::simd::environment::{Environment, Rounding, is_invalid};
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_contacts, ground_distance};
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::mesh_io::{Format, parse_mesh, register_mesh_reader, unregister_mesh_reader};
use swiftprox::object::ObjectOptions;
use swiftprox::pair::{self, Levels, ManifoldConfig, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::progress::Progress;
use swiftprox::scene::{PairResult, Scene, SceneOptions, SceneQuery};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::shape_file;
use swiftprox::solve::exact;
use swiftprox::verify::verify;
use testkit::hard::flight::{poses, shapes};
use testkit::hard::{Sequence, families};
use testkit::shapes::{at, cuboid};

const DEFAULT: Environment = Environment { rounding: Rounding::Nearest, flushes: false, traps: false };

/// What can be told of answers bit by bit: NaN is NaN.
type Bits = Vec<String>;

fn bits(answer: &PairAnswer) -> String {
    format!("{answer:?}")
}

/// Runs `body` as a program would that has set the environment; it is still set afterwards.
fn inside<T>(environment: Environment, body: impl FnOnce() -> T) -> T {
    environment.run(|| {
        let made = body();
        assert!(environment.is_set(), "{environment:?} is not put back");
        made
    })
}

const QUERIES: [Query; 4] = [pair::distance, pair::intersection, pair::contact, pair::approximate];
type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

/// Every query at some poses, each with a cache of its own carried on.
fn answers(environment: Environment, shapes: [&Shape; 2], poses: &[[Pose; 2]]) -> Bits {
    let mut said = Vec::new();
    let config = PairConfig { relative_error: 0.01, levels: Levels::All, ..PairConfig::default() };
    for query in QUERIES {
        let mut cache = PairCache::default();
        for [pose1, pose2] in poses {
            let mut answer = PairAnswer::default();
            let asked = inside(environment, || {
                query([shapes[0].at(pose1), shapes[1].at(pose2)], &mut cache, &config, &mut answer)
            });
            let verified = inside(environment, || verify([shapes[0].at(pose1), shapes[1].at(pose2)], &answer));
            said.push(format!("{asked:?} {verified:?} {}", bits(&answer)));
        }
    }
    said
}

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

#[test]
fn shapes_and_answers_are_the_same_in_every_environment() {
    let mut count = 0;
    for (sequence, poses) in sequences() {
        let saved = |shapes: &[Shape; 2]| shapes.each_ref().map(|shape| shape_file::to_bytes(shape).unwrap());
        let made = with_levels(&sequence).unwrap_or_else(|| shapes(&sequence).unwrap());
        let expected = answers(DEFAULT, [&made[0], &made[1]], &poses);
        for environment in Environment::all().skip(1) {
            let again = inside(environment, || with_levels(&sequence));
            let again = again.unwrap_or_else(|| inside(environment, || shapes(&sequence)).unwrap());
            assert!(saved(&again) == saved(&made), "{environment:?} {}: other shapes", sequence.name);
            let loaded = saved(&made).map(|bytes| inside(environment, || shape_file::from_bytes(&bytes)).unwrap());
            assert!(loaded == made, "{environment:?} {}: loaded as others", sequence.name);
            assert_eq!(
                answers(environment, [&again[0], &again[1]], &poses),
                expected,
                "{environment:?} {}",
                sequence.name
            );
            count += expected.len();
        }
    }
    assert!(count > 10_000, "{count} answers");
}

/// Scenes, and what refuses poses and options.
#[test]
fn scenes_list_the_same_in_every_environment() {
    let body = Arc::new(cuboid([1.0, 1.5, 0.5]));
    let list = |environment: Environment| {
        let mut scene = Scene::new(&SceneOptions::default()).unwrap();
        let mut said = Vec::new();
        let refused = SceneOptions { rotation_limit: -1e-310 };
        assert!(inside(environment, || Scene::new(&refused)).is_err(), "{environment:?}");
        let ids = [0.0, 1.9, 3.6, 12.0].map(|x| {
            let options = ObjectOptions { pose: at(x, 0.3 * x, 1e-310), ..ObjectOptions::default() };
            inside(environment, || scene.add_object(vec![Arc::clone(&body)], &options)).unwrap()
        });
        let query = SceneQuery { distance_tolerance: 5.0, relative_error: 0.1, ..SceneQuery::default() };
        for step in 0..4 {
            let pose = at(0.4 * f64::from(step), 0.1, 0.7);
            inside(environment, || scene.set_pose(ids[1], &pose)).unwrap();
            // Not the ids, which no two scenes share.
            let listed = |pairs: &[PairResult]| pairs.iter().map(|pair| pair.answer).collect::<Vec<_>>();
            let intersecting = inside(environment, || listed(scene.query_intersection(&query).unwrap().pairs));
            let contacts = inside(environment, || listed(scene.query_contact(&query).unwrap().pairs));
            let approximate = inside(environment, || listed(scene.query_approximate(&query).unwrap().pairs));
            said.push(format!("{intersecting:?} {contacts:?} {approximate:?}"));
        }
        said
    };
    let expected = list(DEFAULT);
    for environment in Environment::all() {
        assert_eq!(list(environment), expected, "{environment:?}");
    }
}

/// A gap of 1e-310, which programs that flush subnormals see as contact.
#[test]
fn a_gap_below_the_normal_numbers_is_one() {
    let cube = cuboid([0.5; 3]);
    for environment in Environment::all() {
        for (x, outcome) in [(1.0, Outcome::Intersecting), (1.0_f64.next_up(), Outcome::Separated)] {
            let mut answer = PairAnswer::default();
            let (here, there) = (at(x, 0.0, 0.0), Pose::IDENTITY);
            let (mut cache, config) = (PairCache::default(), PairConfig::default());
            inside(environment, || pair::distance([cube.at(&here), cube.at(&there)], &mut cache, &config, &mut answer))
                .unwrap();
            assert_eq!(answer.outcome, outcome, "{environment:?} {x:e}");
        }
    }
    // Corners at 0 and 1, so that the gap is that of the translations.
    let corners: Vec<Vector> =
        (0..8).map(|k| Vector::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let unit = Shape::from_points(&corners, &ShapeOptions::default()).unwrap();
    let low: Vec<Vector> = corners.iter().map(|corner| corner - Vector::x()).collect();
    let below = Shape::from_points(&low, &ShapeOptions::default()).unwrap();
    for environment in Environment::all() {
        for (x, outcome) in
            [(1e-310, Outcome::Separated), (0.0, Outcome::Intersecting), (-1e-310, Outcome::Intersecting)]
        {
            for query in QUERIES {
                let mut answer = PairAnswer::default();
                let (mut cache, config) = (PairCache::default(), PairConfig::default());
                let here = at(x, 0.0, 0.0);
                inside(environment, || {
                    query([unit.at(&here), below.at(&Pose::IDENTITY)], &mut cache, &config, &mut answer)
                })
                .unwrap();
                assert_eq!(answer.outcome, outcome, "{environment:?} {x:e}");
                if outcome == Outcome::Separated {
                    assert!(answer.lower <= 1e-310 && answer.upper >= 1e-310, "{environment:?} {answer:?}");
                }
            }
        }
    }
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
                let answer = exact::solve(body.polyhedron(), &pose, body.polyhedron(), &Pose::IDENTITY, &[[0, 1]]);
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

#[test]
fn files_are_read_alike_in_every_environment() {
    let mut text = String::from("OFF 36 0 0\n");
    let mut number = 0.1_f64;
    for _ in 0..36 {
        for _ in 0..3 {
            number = (number * 7.3 + 0.123_456_789_012_345_67).fract();
            text += &format!("{number:.17} ");
        }
        text += "\n";
    }
    let read = |environment| {
        let mesh = inside(environment, || parse_mesh(text.as_bytes(), Some(Format::Off), "numbers")).unwrap();
        mesh.vertices.iter().flat_map(|v| v.iter().map(|x| x.to_bits())).collect::<Vec<_>>()
    };
    let expected = read(DEFAULT);
    assert_eq!(expected.len(), 108);
    for environment in Environment::all() {
        assert!(read(environment) == expected, "{environment:?}");
    }
}

#[test]
fn grounds_are_alike_in_every_environment() {
    let heights: Vec<f64> = (0..64).map(|at| if at == 9 { f64::NAN } else { f64::from(at * 37 % 11) * 0.03 }).collect();
    let grid = HeightGrid { rows: 8, columns: 8, spacing: [0.3, 0.7], heights: &heights };
    let round = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.4, ..ShapeOptions::default() };
    let bodies = [cuboid([0.5; 3]), Shape::from_points(&[Vector::zeros()], &round).unwrap()];
    let turn = testkit::random::rotation(&Vector::new(0.3, 0.2, 0.9).normalize(), 0.35);
    let poses = [0.45, 0.9, 3.0].map(|height| Pose::new(&turn, &Vector::new(1.1, 2.3, height)));
    let ask = || {
        let ground = Ground::from_heights(&grid).unwrap();
        let (mut distances, mut contacts) = (Vec::new(), Vec::new());
        for (body, pose) in bodies.iter().flat_map(|body| poses.iter().map(move |pose| (body, pose))) {
            let (body, ground) = (body.at(pose), ground.at(&Pose::IDENTITY));
            for query in [pair::Query::Distance, pair::Query::Intersection] {
                let found = ground_distance(query, body, ground, &PairConfig::default());
                distances.push(found);
            }
            for (margin, reduces) in [(0.1, true), (1.0, false)] {
                let config = ManifoldConfig { margin, reduces, ..ManifoldConfig::default() };
                let mut found = GroundContacts::default();
                ground_contacts(body, ground, &config, &mut found).unwrap();
                contacts.push(found);
            }
        }
        (distances, contacts)
    };
    let expected = format!("{:?}", ask());
    for environment in Environment::all() {
        assert!(format!("{:?}", inside(environment, ask)) == expected, "{environment:?}");
    }
    assert!(!is_invalid(ask));
}

/// Whoever calls the library from a function that it called is a caller like any other.
#[test]
fn the_programs_functions_find_the_programs_environment() {
    let corners: Vec<Vector> =
        (0..40).map(|k| Vector::new(f64::from(k).sin(), f64::from(k * k).cos(), f64::from(3 * k).sin())).collect();
    let unit = Shape::from_points(&corners, &ShapeOptions::default()).unwrap();
    for environment in Environment::all() {
        for other in [environment, DEFAULT, Environment { rounding: Rounding::Up, flushes: true, traps: true }] {
            let mut calls = 0;
            let mut learn = |_: f64| {
                assert!(environment.is_set(), "{environment:?} is not that of the callback");
                calls += 1;
                // From another environment, which calls back in its turn.
                other.run(|| {
                    let mut calls = 0;
                    let mut learn = |_: f64| {
                        calls += 1;
                        other.is_set()
                    };
                    let again =
                        Shape::from_points_in_steps(&corners, &ShapeOptions::default(), &mut Progress::new(&mut learn));
                    assert!(again.unwrap() == unit && calls > 0 && other.is_set(), "{other:?}");
                });
                true
            };
            let options = ShapeOptions::default();
            let made =
                inside(environment, || Shape::from_points_in_steps(&corners, &options, &mut Progress::new(&mut learn)));
            assert!(made.unwrap() == unit && calls > 0, "{environment:?}");
        }
    }
}

#[test]
fn a_mesh_reader_finds_the_programs_environment_and_leaves_no_trace_of_its_own() {
    static CALLS: AtomicUsize = AtomicUsize::new(0);
    let expected = Environment { rounding: Rounding::Down, flushes: true, traps: false };
    let reader = move |_: &[u8]| {
        assert!(expected.is_set());
        CALLS.fetch_add(1, Ordering::Relaxed);
        let corners = vec![Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
        PolygonMesh::new(corners, vec![0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2], None)
    };
    register_mesh_reader(b"ENVIRONMENT", Arc::new(reader)).unwrap();
    let mesh = inside(expected, || parse_mesh(b"ENVIRONMENT", None, "a file"));
    assert_eq!(mesh.unwrap().vertices.len(), 4);
    assert!(unregister_mesh_reader(b"ENVIRONMENT") && CALLS.load(Ordering::Relaxed) == 1);
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
                        invalid.push(format!("{} at pose {number}: {}", sequence.name, bits(&answer)));
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
