//! Approximate distances from maps of support functions: what a look-up says holds, and so do the intervals that come of it.
//! Integers tell the truth, and `verify` proves every answer.

use swiftprox::base::simd::{Portable, Twins};
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::body::tables::support_map::{Choice, MapGrid, SupportMap};
use swiftprox::distance::support_search::look_up;
use swiftprox::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector};
use swiftprox::pair::{self, DecidedBy, Levels, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;
use swiftprox::progress::Progress;
use swiftprox::shape::{LookupKind, LookupOptions, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::caches::{WORDS, cache_of_words};
use testkit::models::{cuboid, ellipsoid, prism};
use testkit::random::{Random, rotation};

/// Bodies with maps, round and thin, smooth and with edges, of many sizes.
fn shapes() -> Vec<Shape> {
    let meshes = [
        (ellipsoid([1.0, 1.0, 1.0], 1_002), 1.0),
        (ellipsoid([1.0, 1.0, 0.1], 800), 1e-3),
        (ellipsoid([1.0, 0.1, 0.1], 800), 1e3),
        (ellipsoid([1.0, 0.01, 0.005], 600), 2f64.powi(150)),
        (ellipsoid([1.0, 0.6, 0.3], 700), 1.0),
        (prism(300, 0.3), 1.0),
    ];
    let shape = |(mesh, scale): (Result<_, _>, f64)| {
        Shape::from_mesh(&mesh.unwrap(), &ShapeOptions { scale, ..ShapeOptions::default() }).unwrap()
    };
    meshes.into_iter().map(shape).collect()
}

/// The height that a look-up says is never less than that of any vertex, and the point is in the body, up to what the grid says:
/// along directions of any kind, at nodes of the map and between them, along the normals of faces and across edges.
#[test]
fn a_look_up_bounds_the_body_and_names_a_point_of_it() {
    let mut random = Random::new(0x5a9);
    for shape in shapes() {
        let body = shape.polyhedron();
        let map = SupportMap::new(body).unwrap();
        map.insist(body).unwrap();
        for k in 0..600 {
            let direction = match k % 4 {
                0 => random.direction(),
                // At the middle and the corners of the cube.
                1 => Vector::from_fn(|_, _| random.below(3) as f64 - 1.0),
                2 => body.faces[random.below(body.faces.len())].normal,
                _ => body.vertices[random.below(body.vertices.len())].position.normalize(),
            };
            if direction == Vector::zeros() {
                continue;
            }
            let errors = [0.3, 0.1, 0.05, 0.02, 0.01].map(|error| error * body.radius);
            for error in errors {
                let Choice::Grids(grids) = map.choose(error) else { continue };
                for grid in [grids.coarse, grids.fine] {
                    check_look_up(body, grid, &direction);
                }
            }
        }
        // Something is fine enough for every body, and less than that for a prism.
        assert!(matches!(map.choose(body.radius), Choice::Grids(_)));
    }
}

fn check_look_up(body: &Polyhedron, grid: &MapGrid, direction: &Vector) {
    let [x, y, z] = direction.map(|x| x as f32).into();
    let both = [x, y, z, 0.0];
    let found = look_up::<Portable>([grid, grid], Twins::load(&both, &both));
    // What single precision holds is the direction that counts.
    let direction = &Vector::new(x.into(), y.into(), z.into());
    let points = found.points.to_array().map(f64::from);
    assert_eq!((points[..4].to_vec(), found.heights[0]), (points[4..].to_vec(), found.heights[1]));
    let point = Vector::new(points[0], points[1], points[2]) * grid.unit;
    let height = f64::from(found.heights[0]) * grid.unit;
    let length = direction.lp_norm(1);
    // What the doubles of this test err by.
    let rounding = 4.0 * U * length * body.radius;
    let highest = body.vertices.iter().map(|v| v.position.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
    assert!(height + grid.misfit * direction.norm() + rounding >= highest, "{height} {highest}");
    assert!(point.dot(direction) <= highest + grid.point_error * direction.norm() + rounding);
    for face in &body.faces {
        let outside = face.planes.value(0, &point);
        assert!(outside <= face.slack + grid.point_error + 16.0 * U * body.radius, "{outside:e}");
    }
}

fn ask(shapes: [&Shape; 2], poses: &[Pose; 2], cache: &mut PairCache, config: &PairConfig) -> PairAnswer {
    let mut answer = PairAnswer::default();
    pair::approximate([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], cache, config, &mut answer).unwrap();
    answer
}

fn is_by_maps(answer: &PairAnswer) -> bool {
    answer.decided_by == DecidedBy::Tolerance && answer.statistics.levels == [0, 0]
}

/// Bodies that touch nearly, at some distance or far from the origin, with rotations that are right or stretched.
fn any_poses(shapes: [&Shape; 2], random: &mut Random) -> [Pose; 2] {
    let size = shapes[0].polyhedron().radius + shapes[1].polyhedron().radius;
    let far = if random.below(4) == 0 { random.direction() * (1e6 * size) } else { Vector::zeros() };
    let skew = if random.below(4) == 0 { 1e-3 } else { 0.0 };
    let apart = random.direction() * (size * random.uniform(0.6, 2.0));
    [Vector::zeros(), apart].map(|place| {
        let turn = random.rotation() + Matrix::from_fn(|_, _| skew * random.signed());
        Pose::new(&turn, &(far + place))
    })
}

/// A step of body 2, mostly a small one.
fn step(pose: &Pose, size: f64, random: &mut Random) -> Pose {
    let by = 10f64.powi(-1 - random.below(3) as i32);
    let turn = rotation(&random.direction(), by);
    Pose::new(&(turn * pose.rotation()), &(pose.translation() + random.vector() * (by * size)))
}

#[test]
fn intervals_from_maps_hold_the_true_distance() {
    let mut random = Random::new(0xd157);
    let shapes = shapes();
    let small = Shape::from_mesh(&cuboid([0.4, 0.9, 0.2]).unwrap(), &ShapeOptions::default()).unwrap();
    let (mut by_maps, mut answers) = (0, 0);
    for chunk in 0..90 {
        let unlike = chunk % 9 == 8;
        let second = if unlike { &small } else { &shapes[random.below(shapes.len())] };
        let pair = [&shapes[random.below(shapes.len())], second];
        let sizes = pair.map(|shape| shape.polyhedron().radius);
        let mut poses = any_poses(pair, &mut random);
        let mut warm = PairCache::default();
        for k in 0..12 {
            let error = [0.3, 0.1, 0.03, 0.01][random.below(4)] * sizes[0].max(sizes[1]);
            let relative_error = if k % 5 == 4 { 0.05 } else { 0.0 };
            let max_distance =
                if k % 6 == 5 { random.uniform(0.0, 1.0) * (sizes[0] + sizes[1]) } else { f64::INFINITY };
            let config = PairConfig { absolute_error: error, relative_error, max_distance, ..Default::default() };
            let mut cache = match k % 4 {
                0 => PairCache::default(),
                1 => garbage(&mut random),
                _ => warm,
            };
            let answer = ask(pair, &poses, &mut cache, &config);
            // What garbage leaves may pause look-ups for long.
            warm = if k % 4 == 1 { PairCache::default() } else { cache };
            answers += 1;
            by_maps += usize::from(is_by_maps(&answer));
            verify([pair[0].at(&poses[0]), pair[1].at(&poses[1])], &answer).unwrap();
            let polyhedra = pair.map(Shape::polyhedron);
            let truth = exact::distance(&Pair { polyhedra, poses: [&poses[0], &poses[1]] }, &[]);
            assert_eq!(answer.outcome == Outcome::Intersecting, truth.is_zero());
            assert!(truth.compare(answer.lower).is_ge() && truth.compare(answer.upper).is_le(), "{answer:?}");
            if answer.outcome == Outcome::Separated {
                let asked = error.max(relative_error * answer.lower);
                assert!(answer.upper - answer.lower <= asked && answer.upper <= max_distance, "{answer:?}");
            }
            // What the cache held changes the answer within its interval alone.
            let cold = ask(pair, &poses, &mut PairCache::default(), &config);
            assert_eq!(cold.outcome, answer.outcome);
            assert!(cold.lower <= answer.upper && answer.lower <= cold.upper);
            poses[1] = step(&poses[1], sizes[0] + sizes[1], &mut random);
            if poses[1].rotation_defect() > 5e-3 {
                poses = any_poses(pair, &mut random);
            }
        }
    }
    assert!(by_maps * 4 > answers, "{by_maps} of {answers}");
}

/// A cache that holds features or a direction, most of them of no body.
fn garbage(random: &mut Random) -> PairCache {
    let words: [u32; WORDS] = std::array::from_fn(|i| match i {
        0 => [32, 1 + random.below(6) as u32, random.next_u64() as u32][random.below(3)],
        8 => u32::from_ne_bytes(*b"axis"),
        _ => random.next_u64() as u32,
    });
    cache_of_words(words)
}

/// Who asks for levels, for none, or for bodies without tables is not answered by maps; nor is who asks for too much.
#[test]
fn maps_answer_who_leaves_the_choice_and_some_error() {
    let mesh = ellipsoid([1.0, 1.0, 0.1], 1_002).unwrap();
    let shape = |kind| {
        let lookup = LookupOptions { kind, ..LookupOptions::DEFAULT };
        Shape::from_mesh(&mesh, &ShapeOptions { lookup, ..ShapeOptions::default() }).unwrap()
    };
    let (with, without) = (shape(LookupKind::Automatic), shape(LookupKind::None));
    let poses = [Vector::zeros(), Vector::new(1.4, 1.1, 1.3)].map(|place| Pose::new(&Matrix::identity(), &place));
    let asked = |shape: &Shape, config: PairConfig| ask([shape; 2], &poses, &mut PairCache::default(), &config);
    let coarse = PairConfig { absolute_error: 0.02, ..PairConfig::default() };
    let answer = asked(&with, coarse);
    assert!(is_by_maps(&answer) && answer.local1.iter().all(|x| x.is_nan()), "{answer:?}");
    assert!(answer.upper - answer.lower > 1e-6, "{answer:?}");
    for config in [
        PairConfig { levels: Levels::None, ..coarse },
        PairConfig { levels: Levels::All, ..coarse },
        PairConfig { step_budget: 50, ..coarse },
        PairConfig { absolute_error: 1e-4, ..coarse },
    ] {
        assert!(!is_by_maps(&asked(&with, config)), "{config:?}");
    }
    assert!(!is_by_maps(&asked(&without, coarse)));
}

/// Maps are made by the first query that needs them, only as fine as it needs them, counted, and the same for all who ask later.
#[test]
fn maps_are_made_as_they_are_needed() {
    let make = || Shape::from_mesh(&ellipsoid([1.0; 3], 1_002).unwrap(), &ShapeOptions::default()).unwrap();
    let poses = [Vector::zeros(), Vector::new(1.4, 1.1, 1.3)].map(|place| Pose::new(&Matrix::identity(), &place));
    let asked = |shape: &Shape, absolute_error: f64| {
        let config = PairConfig { absolute_error, ..PairConfig::default() };
        ask([shape; 2], &poses, &mut PairCache::default(), &config)
    };
    let shape = make();
    let bytes = [1e-6, 0.1, 0.01].map(|error| {
        asked(&shape, error);
        shape.bytes()
    });
    assert!(bytes[1] > bytes[0] && bytes[1] < bytes[0] + 50_000, "{bytes:?}");
    assert!(bytes[2] > bytes[1] + 50_000 && bytes[2] < bytes[1] + 500_000, "{bytes:?}");
    // Whoever asked before, and whatever is made, the answers are the same to the last bit.
    let (fresh, prepared) = (make(), make());
    prepared.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    let before = prepared.bytes();
    for error in [0.1, 0.03, 0.01] {
        let answers = [&shape, &fresh, &prepared].map(|shape| asked(shape, error));
        assert!(is_by_maps(&answers[0]));
        for answer in &answers[1..] {
            assert_eq!(
                (answer.lower, answer.upper, answer.normal),
                (answers[0].lower, answers[0].upper, answers[0].normal)
            );
        }
    }
    assert_eq!(prepared.bytes(), before);
    // A refused query makes nothing.
    let refused = make();
    let before = refused.bytes();
    let config = PairConfig { absolute_error: 0.1, ..PairConfig::default() };
    let mirrored = Pose::new(&Matrix::from_diagonal_element(-1.0), &Vector::new(5.0, 0.0, 0.0));
    let bodies = [refused.at(&poses[0]), refused.at(&mirrored)];
    pair::approximate(bodies, &mut PairCache::default(), &config, &mut PairAnswer::default()).unwrap_err();
    assert_eq!(refused.bytes(), before);
}

/// Marching from the last features costs less than a look-up while a pair hardly moves, and more when it jumps.
#[test]
fn a_pair_that_hardly_moves_marches_and_one_that_jumps_looks_up() {
    let shape = Shape::from_mesh(&ellipsoid([1.0, 1.0, 0.5], 1_002).unwrap(), &ShapeOptions::default()).unwrap();
    let config = PairConfig { absolute_error: 0.02, ..PairConfig::default() };
    let (mut random, mut cache) = (Random::new(0x57e9), PairCache::default());
    let apart = Vector::new(1.2, 1.1, 1.3);
    let mut ask_at =
        |turn: Matrix| is_by_maps(&ask([&shape; 2], &[Pose::IDENTITY, Pose::new(&turn, &apart)], &mut cache, &config));
    let axis = random.direction();
    let creeping: Vec<bool> = (0..60).map(|k| ask_at(rotation(&axis, 1e-3 * f64::from(k)))).collect();
    let jumping: Vec<bool> = (0..60).map(|_| ask_at(random.rotation())).collect();
    assert!(creeping[0] && creeping[20..].iter().all(|by_maps| !by_maps), "{creeping:?}");
    assert!(jumping[20..].iter().filter(|by_maps| **by_maps).count() > 35, "{jumping:?}");
}
