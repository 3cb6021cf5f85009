//! Points and directions whose answer is known.

use swiftprox::base::simd::environment::Environment;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::point::{PointLocation, locate_point, support};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::models;
use testkit::shapes::{at, cuboid, hull};

#[test]
fn a_cube_from_outside_to_inside() {
    let mesh = models::cuboid([1.0; 3]).unwrap();
    let cube = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    let pose = at(10.0, 0.0, 0.0);
    for (x, location, distance) in [
        (13.0, PointLocation::Outside, 2.0),
        (11.0_f64.next_up(), PointLocation::Outside, 11.0_f64.next_up() - 11.0),
        (11.0, PointLocation::On, 0.0),
        (11.0_f64.next_down(), PointLocation::Inside, 11.0_f64.next_down() - 11.0),
        (10.75, PointLocation::Inside, -0.25),
    ] {
        let answer = locate_point(cube.at(&pose), [x, 0.25, 0.5]).unwrap();
        assert_eq!(answer.location, location, "{x} {answer:?}");
        assert!(answer.lower <= distance && distance <= answer.upper, "{x} {answer:?}");
        assert!(answer.upper - answer.lower < 1e-12, "{x} {answer:?}");
        assert_eq!((answer.normal, answer.feature.kind), ([1.0, 0.0, 0.0], FeatureKind::Face), "{x} {answer:?}");
        let polygon = mesh.face(answer.feature.ids[0] as usize);
        assert!(polygon.iter().all(|&v| mesh.vertices[v as usize].x == 1.0), "{x} {answer:?}");
        assert!((Vector::from(answer.world) - Vector::new(11.0, 0.25, 0.5)).norm() < 1e-12, "{x} {answer:?}");
        assert!((Vector::from(answer.local) - Vector::new(1.0, 0.25, 0.5)).norm() < 1e-12, "{x} {answer:?}");
    }
    let corner = locate_point(cube.at(&pose), [12.0, 2.0, 2.0]).unwrap();
    let vertex = mesh.vertices[corner.feature.ids[0] as usize];
    assert_eq!((corner.feature.kind, vertex), (FeatureKind::Vertex, Vector::repeat(1.0)));
}

/// A body without interior has points on it and none inside.
#[test]
fn bodies_without_interior() {
    let square = hull(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vector::new(x, y, 0.0)));
    let segment = hull(&[Vector::zeros(), Vector::new(2.0, 4.0, 6.0)]);
    let point = hull(&[Vector::new(1.0, 2.0, 3.0)]);
    let locate = |shape: &Shape, at: [f64; 3]| locate_point(shape.at(&Pose::IDENTITY), at).unwrap();
    for (shape, on, beside) in [
        (&square, [1.0, 2.0, 0.0], [1.0, 2.0, f64::MIN_POSITIVE]),
        (&segment, [1.0, 2.0, 3.0], [1.0, 2.0, 3.0_f64.next_up()]),
        (&point, [1.0, 2.0, 3.0], [1.0_f64.next_down(), 2.0, 3.0]),
    ] {
        assert_eq!(locate(shape, on).location, PointLocation::On);
        assert_eq!(locate(shape, beside).location, PointLocation::Outside);
    }
}

#[test]
fn magnitudes_of_all_doubles() {
    for scale in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
        let cube = cuboid([scale; 3]);
        for (x, location) in [(0.5, PointLocation::Inside), (1.0, PointLocation::On), (2.0, PointLocation::Outside)] {
            let answer = locate_point(cube.at(&Pose::IDENTITY), [x * scale, 0.0, 0.25 * scale]).unwrap();
            assert_eq!(answer.location, location, "{scale:e} {answer:?}");
            let distance = x * scale - scale;
            assert!(answer.lower <= distance && distance <= answer.upper, "{scale:e} {answer:?}");
        }
        let farthest = support(cube.at(&Pose::IDENTITY), [scale, -scale, 0.5 * scale]).unwrap();
        assert_eq!(farthest.local, [scale, -scale, scale], "{scale:e}");
    }
}

/// Of a lattice on a cube the corners are farthest, by whatever little.
#[test]
fn a_direction_that_hardly_leans() {
    let points = testkit::shapes::lattice_box([1.0; 3], 6);
    let cube = hull(&points);
    for lean in [1e-3, 1e-9, 1e-17, 1e-200] {
        let answer = support(cube.at(&Pose::IDENTITY), [1.0, lean, -lean]).unwrap();
        assert_eq!(points[answer.vertex as usize], Vector::new(1.0, 1.0, -1.0), "{lean:e} {answer:?}");
    }
}

#[test]
fn the_floating_point_environment_changes_no_bit() {
    let body = Shape::from_mesh(&models::ellipsoid([1.0, 0.5, 0.3], 200).unwrap(), &ShapeOptions::default()).unwrap();
    let pose = at(0.1, 0.2, 0.3);
    let ask = || {
        let inside = locate_point(body.at(&pose), [0.3, 0.3, 0.3]).unwrap();
        let outside = locate_point(body.at(&pose), [1.3, 0.7, 0.3]).unwrap();
        // As text, since NaN is not equal to itself.
        format!("{inside:?} {outside:?} {:?}", support(body.at(&pose), [0.1, 2.0, -0.7]).unwrap())
    };
    let plain = ask();
    for environment in Environment::all() {
        assert_eq!(environment.run(ask), plain);
    }
}

/// The nearest point is on the round surface, and its feature the hull's; the support point is on it, too, by a vertex of the hull.
#[test]
fn round_bodies() {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.5, ..ShapeOptions::default() };
    let ends = [Vector::new(0.0, 0.0, -2.0), Vector::new(0.0, 0.0, 2.0)];
    let capsule = Shape::from_points(&ends, &options).unwrap();
    let pose = at(10.0, 0.0, 0.0);
    for (point, location, distance, world, kind) in [
        ([13.0, 0.0, 1.0], PointLocation::Outside, 2.5, [10.5, 0.0, 1.0], FeatureKind::Edge),
        ([10.0, 0.25, 1.0], PointLocation::Inside, -0.25, [10.0, 0.5, 1.0], FeatureKind::Edge),
        ([10.0, 0.0, 2.5], PointLocation::On, 0.0, [10.0, 0.0, 2.5], FeatureKind::Vertex),
        ([10.3, 0.4, 2.0], PointLocation::On, 0.0, [10.3, 0.4, 2.0], FeatureKind::Vertex),
    ] {
        let answer = locate_point(capsule.at(&pose), point).unwrap();
        // No double is 10.3.
        assert!(answer.location == location || point[0] == 10.3, "{answer:?}");
        assert!((answer.distance - distance).abs() < 1e-14 && answer.upper - answer.lower < 1e-13, "{answer:?}");
        assert!((Vector::from(answer.world) - Vector::from(world)).norm() < 1e-12, "{answer:?}");
        assert_eq!(answer.feature.kind, kind, "{answer:?}");
    }
    let farthest = support(capsule.at(&pose), [3.0, 0.0, 1.0]).unwrap();
    let expected = Vector::new(10.0, 0.0, 2.0) + Vector::new(3.0, 0.0, 1.0).normalize() * 0.5;
    assert!(farthest.vertex == 1 && (Vector::from(farthest.world) - expected).norm() < 1e-14, "{farthest:?}");
}
