//! Manifolds of pairs at rest, along the normal of the facet that a cache keeps: against manifolds from nothing, the independent
//! check, and whatever bytes stand where the facet does.

use super::{ALL, FOUR, check, ids, query};
use swiftprox::manifold::ManifoldCache;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::Outcome;
use swiftprox::shape::Shape;
use swiftprox::verify::verify_manifold;
use testkit::models::prism;
use testkit::random::{Random, rotation};
use testkit::shapes::{cuboid, hull};

/// Boxes, drums, hulls, and a box and a drum whose turned corners are rounded to single precision.
fn bodies(random: &mut Random) -> Vec<Shape> {
    let drum = |sides: u32| prism(sides, 0.5).unwrap().vertices;
    let float = |points: &[Vector], turn: Matrix| {
        hull(&points.iter().map(|p| (turn * p).map(|x| f64::from(x as f32))).collect::<Vec<_>>())
    };
    let corner = |k: usize| Vector::from_fn(|i, _| if k >> i & 1 == 0 { -0.5 } else { 0.5 });
    let cube: Vec<Vector> = (0..8).map(corner).collect();
    let mut shapes = vec![cuboid([0.5; 3]), cuboid([2.0, 2.0, 0.5]), cuboid([0.5, 0.25, 0.25])];
    shapes.extend([5, 16, 40].map(|sides| hull(&drum(sides))));
    shapes.extend([12, 42].map(|n| hull(&(0..n).map(|_| random.direction() * 0.5).collect::<Vec<_>>())));
    shapes.extend([float(&cube, random.rotation()), float(&drum(12), random.rotation())]);
    shapes.push(hull(&cube.iter().map(|p| p + Vector::new(64.0, 0.0, 32.0)).collect::<Vec<_>>()));
    shapes
}

/// The pose at which a body lies on another, turned and aside, so deep.
fn lying(shapes: [&Shape; 2], turns: [Matrix; 2], aside: Vector, deep: f64) -> [Pose; 2] {
    let heights = |shape: &Shape, turn: &Matrix| {
        let polyhedron = shape.polyhedron();
        let heights = (0..polyhedron.vertices.len() as u32).map(|v| (turn * polyhedron.local_position(v)).z);
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| [low.min(z), high.max(z)])
    };
    let centre = |i: usize| turns[i] * shapes[i].polyhedron().centre;
    let up = heights(shapes[0], &turns[0])[1] - heights(shapes[1], &turns[1])[0] - deep;
    let across = centre(0) - centre(1) + aside;
    [Pose::new(&turns[0], &Vector::zeros()), Pose::new(&turns[1], &Vector::new(across.x, across.y, up))]
}

/// Puts any facet in the place of that which a cache has.
#[allow(unsafe_code)]
fn corrupt(cache: &mut ManifoldCache, random: &mut Random) {
    const FACET: std::ops::Range<usize> = 104..116;
    // SAFETY: all members of a cache are integers without gaps between them.
    let mut bytes: [u8; size_of::<ManifoldCache>()] = unsafe { std::mem::transmute(*cache) };
    let numbers = [random.below(5) as u32, random.below(60) as u32, random.below(60) as u32];
    for (place, number) in bytes[FACET].chunks_exact_mut(4).zip(numbers) {
        place.copy_from_slice(&number.to_ne_bytes());
    }
    // SAFETY: any bytes are values of them.
    *cache = unsafe { std::mem::transmute::<[u8; size_of::<ManifoldCache>()], ManifoldCache>(bytes) };
}

/// With a cache and from nothing there are the same points, on four corners or on sides that cross, and all that is said is right.
/// Then anything in the place of the facet: no answer is wrong.
#[test]
fn what_rests_has_the_manifold_of_nothing_before() {
    let mut random = Random::new(95);
    let shapes = bodies(&mut random);
    let (mut same, mut asked) = (0, 0);
    for round in 0..90 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let skew = Matrix::from_fn(|_, _| random.signed()) * if round % 9 == 8 { 1e-4 } else { 0.0 };
        let mut yaw = [Matrix::identity(), rotation(&Vector::z(), random.pick(&[0.0, 0.4, 3.0])) + skew];
        let mut aside = random.vector() * random.pick(&[0.0, 0.2, 0.4]);
        let mut caches = [ManifoldCache::default(); 2];
        for _ in 0..8 {
            let tilt = rotation(&random.direction(), 1e-4 * random.signed());
            let poses = lying(pair, [yaw[0], tilt * yaw[1]], aside, 2e-3 + 1e-3 * random.signed());
            let placed = poses.each_ref();
            for (cache, config) in caches.iter_mut().zip([ALL, FOUR]) {
                if random.below(4) == 0 {
                    corrupt(cache, &mut random);
                }
                let (answer, points) = query(pair, placed, cache, &config);
                let (alone, others) = query(pair, placed, &mut ManifoldCache::default(), &config);
                let told = || format!("{answer:?}\n{points:?}\nalone {alone:?}\n{others:?}\n{poses:?}");
                assert!(answer.lower <= alone.upper && alone.lower <= answer.upper, "{}", told());
                assert_eq!(answer.outcome, alone.outcome, "{}", told());
                if answer.outcome == Outcome::Beyond {
                    continue;
                }
                check(pair, placed, &config, &answer, &points);
                let bodies = [pair[0].at(placed[0]), pair[1].at(placed[1])];
                verify_manifold(bodies, cache, &config, &answer, &points)
                    .unwrap_or_else(|error| panic!("{error}: {}", told()));
                let are_alike = (Vector::from(answer.normal) - Vector::from(alone.normal)).norm() < 1e-9;
                if answer.outcome == Outcome::Intersecting && are_alike && !config.reduces {
                    asked += 1;
                    same += usize::from(ids(&points) == ids(&others));
                }
            }
            yaw[1] = rotation(&Vector::z(), 1e-3 * random.signed()) * yaw[1];
            aside += Vector::new(random.signed(), random.signed(), 0.0) * 1e-3;
        }
    }
    println!("{same} of {asked}");
    assert!(asked > 500 && 100 * same >= 99 * asked, "{same} of {asked}");
}
