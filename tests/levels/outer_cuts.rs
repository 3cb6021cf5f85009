//! Levels cut out of a box: how far they stand off for their size, that they contain the body and each other, degenerate
//! bodies, the work they take, cancelling. What holds for levels of every kind is in `tests/levels/hierarchy`.

use swiftprox::base::predicates::ExactPoints;
use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::progress::Progress;
use swiftprox::shape::levels::outer_cuts::outer_cuts;
use swiftprox::shape::levels::point_distance::PointDistance;
use testkit::models::{ELLIPSOIDS, ellipsoid, random_hull, spiral};
use testkit::random::{Random, rotation};

fn hull(points: &[Vector]) -> Polyhedron {
    build(points, None).unwrap()
}

fn levels(base: &Polyhedron, plane_counts: &[usize]) -> Vec<Polyhedron> {
    outer_cuts(base, plane_counts, &mut Progress::new(&mut |_| true)).unwrap()
}

/// The largest distance of a vertex from the body, rounded up.
fn deviation(level: &Polyhedron, base: &Polyhedron) -> f64 {
    let distance = PointDistance::new(base).unwrap();
    level.vertices.iter().map(|v| distance.nearest(&v.position, 0).upper).fold(0.0, f64::max)
}

/// Every triangle of the level against every vertex of the body, exactly.
fn assert_contains(level: &Polyhedron, base: &Polyhedron) {
    let mut points: Vec<Vector> = level.vertices.iter().map(|v| v.position).collect();
    let first = points.len() as u32;
    points.extend(base.vertices.iter().map(|v| v.position));
    let exact = ExactPoints::new(&points).unwrap();
    for triangle in &level.triangles {
        let plane = exact.plane(*triangle);
        assert!((first..points.len() as u32).all(|v| exact.height(&plane, v) <= 0.0));
    }
}

/// The polyhedron of as many planes that touch an ellipsoid where a Fibonacci spiral touches the ball that it was made from: what
/// one would do without looking at the body.
fn spread_evenly(half_axes: [f64; 3], count: usize) -> Polyhedron {
    // Planes n·x = 1 meet where the polar of the normals' hull has its vertices.
    let polar = hull(&spiral(count));
    let corners: Vec<Vector> = polar
        .triangles
        .iter()
        .map(|corners| {
            let [a, b, c] = corners.map(|v| polar.vertices[v as usize].position + polar.centre);
            let normal = (b - a).cross(&(c - a));
            (normal / normal.dot(&a)).component_mul(&Vector::from(half_axes))
        })
        .collect();
    hull(&corners)
}

/// On a ball there is nothing to look at; on thin bodies planes spread evenly are wasted.
#[test]
fn they_stand_off_less_than_planes_spread_evenly() {
    const COUNTS: [usize; 4] = [12, 28, 60, 124];
    for (name, half_axes) in ELLIPSOIDS {
        let body = hull(&ellipsoid(half_axes, 1002).unwrap().vertices);
        for (level, count) in levels(&body, &COUNTS).iter().zip(COUNTS) {
            let reached = deviation(level, &body) / body.mass.radius;
            let even = deviation(&spread_evenly(half_axes, count), &body) / body.mass.radius;
            println!("{name}, {count} planes: {reached:.4}, spread evenly {even:.4}");
            let most = if half_axes == [1.0; 3] { even } else { 0.5 * even };
            assert!(reached <= most, "{name}, {count} planes: {reached}");
            assert_eq!(level.faces.len(), count);
            assert!(level.vertices.len() <= 2 * count - 4);
            assert_contains(level, &body);
        }
    }
}

/// Of many planes each level lies in those that are coarser, up to the rounding of its vertices.
#[test]
fn large_ones_are_nested() {
    for seed in 0..4 {
        let body = hull(&random_hull(6000, seed).unwrap().vertices);
        let levels = levels(&body, &[50, 60, 80, 100, 110]);
        assert_eq!(levels.len(), 5);
        let mut last = f64::INFINITY;
        for pair in levels.windows(2) {
            for vertex in &pair[1].vertices {
                let above = pair[0].faces.iter().map(|face| face.planes.value(0, &vertex.position));
                assert!(above.fold(0.0, f64::max) <= 1e-14 * pair[0].radius);
            }
            let now = deviation(&pair[1], &body);
            assert!(now <= last);
            last = now;
        }
    }
}

/// Thin bodies in any direction: what the fraction of the radius is for a ball is at most as much for them.
#[test]
fn needles_and_wafers() {
    let mut random = Random::new(3);
    for half_axes in [[1.0, 1e-5, 1e-5], [1.0, 1.0, 1e-5], [1.0, 1e-3, 1e-6], [1.0, 1.0, 1e-9], [1.0, 1e-9, 1e-9]] {
        let turned = rotation(&random.direction(), 1.0);
        let points: Vec<Vector> =
            (0..500).map(|_| turned * random.direction().component_mul(&Vector::from(half_axes))).collect();
        let body = hull(&points);
        for (level, count) in levels(&body, &[20, 60]).iter().zip([20, 60]) {
            let reached = deviation(level, &body);
            println!("{half_axes:?}, {count} planes: {reached:.3e}");
            assert!(reached <= if count == 20 { 0.3 } else { 0.08 }, "{half_axes:?}, {count}: {reached}");
            assert_contains(level, &body);
        }
    }
}

/// What few planes bound exactly needs no more of them.
#[test]
fn a_body_of_few_faces_is_reached() {
    let tetrahedron = hull(&[Vector::zeros(), Vector::x(), Vector::y(), Vector::z()]);
    let corners = (0..8).map(|i| Vector::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)));
    let cube = hull(&(corners.map(|p| p - Vector::repeat(0.5)).collect::<Vec<_>>()));
    for (body, planes) in [(tetrahedron, 16), (cube, 6)] {
        let levels = levels(&body, &[100, 200]);
        assert_eq!(levels.len(), 1);
        assert!(levels[0].faces.len() <= planes, "{}", levels[0].faces.len());
        let reached = deviation(&levels[0], &body);
        assert!(reached <= 1e-9, "{reached:e}");
        assert_contains(&levels[0], &body);
    }
}

#[test]
fn bodies_without_interior_get_none() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vector::new(x, y, 0.0));
    let flat = hull(&square);
    assert_eq!(flat.dimension, 2);
    assert!(levels(&flat, &[10]).is_empty());
    assert!(levels(&hull(&square[..2]), &[10]).is_empty());
    assert!(levels(&hull(&square[..1]), &[10]).is_empty());
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let body = hull(&ellipsoid([1.0, 1.0, 0.1], 300).unwrap().vertices);
    assert_eq!(levels(&body, &[20, 50]), levels(&body, &[20, 50]));
    assert!(levels(&body, &[]).is_empty());
}

#[test]
fn large_bodies() {
    let body = hull(&ellipsoid([1.0, 0.1, 0.1], 100_002).unwrap().vertices);
    let mut reports = Vec::new();
    let mut progress = |fraction| {
        reports.push(fraction);
        true
    };
    let levels = outer_cuts(&body, &[100, 1000], &mut Progress::new(&mut progress)).unwrap();
    assert!(reports.is_sorted() && reports.len() > 10 && reports.last() == Some(&1.0), "{reports:?}");
    let reached = deviation(&levels[1], &body);
    assert!(reached < 7e-4, "{reached}");
}

#[test]
fn it_can_be_cancelled() {
    let body = hull(&ellipsoid([1.0, 1.0, 1.0], 1002).unwrap().vertices);
    let result = outer_cuts(&body, &[200], &mut Progress::new(&mut |_| false));
    assert!(matches!(result, Err(Error::Cancelled(_))));
}

/// One vertex 10¹⁶ times as far out as the others: the planes of the first block have the same directions, up to rounding, and
/// bound nothing. Found by fuzzing.
#[test]
fn a_body_whose_first_block_rounding_opens_has_no_levels_or_sound_ones() {
    let far = 4.683743612465316e17;
    let points = [
        [2.75, -3.125, -13.0],
        [-12.999999999999998, -6979321855.999999, -0.25],
        [-0.25, -0.25, -0.25],
        [2.625, 0.0, 29.0],
        [3.75, 15.0, 2.625],
        [-2.625, 3.0, 29.0],
        [far, far, -far],
        [0.750000000000004, -32.0, -32.0],
    ]
    .map(Vector::from);
    let body = hull(&points);
    for counts in [&[6][..], &[4, 8, 12], &[60]] {
        assert!(
            levels(&body, counts)
                .iter()
                .all(|level| swiftprox::shape::levels::containment::contains(level, &body).unwrap())
        );
    }
}
