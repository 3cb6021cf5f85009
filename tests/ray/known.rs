//! Rays whose answer is known.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use swiftprox::base::simd::environment::Environment;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::ray::{Ray, RayAnswer, RayOutcome, cast_ray};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models;
use testkit::shapes::{at, cuboid, hull};

fn cast(shape: &Shape, pose: &Pose, origin: [f64; 3], direction: [f64; 3]) -> RayAnswer {
    cast_ray(shape.at(pose), &Ray { origin, direction, t_max: f64::INFINITY }).unwrap()
}

#[test]
fn through_a_cube() {
    let mesh = models::cuboid([1.0; 3]).unwrap();
    let cube = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    let answer = cast(&cube, &at(10.0, 0.0, 0.0), [0.0, 0.25, 0.5], [2.0, 0.0, 0.0]);
    assert_eq!((answer.outcome, answer.exact), (RayOutcome::Hit, 0));
    assert!(answer.entry[0] <= 4.5 && 4.5 <= answer.entry[1] && answer.entry[1] - answer.entry[0] < 1e-13);
    assert!(answer.exit[0] <= 5.5 && 5.5 <= answer.exit[1] && answer.exit[1] - answer.exit[0] < 1e-13);
    assert_eq!((answer.normal, answer.feature.kind), ([-1.0, 0.0, 0.0], FeatureKind::Face));
    // The polygon of the mesh on that side.
    let polygon = mesh.face(answer.feature.ids[0] as usize);
    assert!(polygon.iter().all(|&v| mesh.vertices[v as usize].x == -1.0), "{answer:?}");
}

#[test]
fn what_only_touches_is_a_hit() {
    let cube = cuboid([1.0; 3]);
    // Along a face, along an edge, at a corner, across an edge.
    for (origin, direction, entry, exit) in [
        ([-3.0, 0.5, 1.0], [1.0, 0.0, 0.0], 2.0, 4.0),
        ([-3.0, 1.0, 1.0], [1.0, 0.0, 0.0], 2.0, 4.0),
        ([-3.0, 1.0, 0.0], [2.0, 0.0, 1.0], 1.0, 1.0),
        ([2.0, 0.0, 0.5], [-1.0, 1.0, 0.0], 1.0, 1.0),
    ] {
        let answer = cast(&cube, &Pose::IDENTITY, origin, direction);
        assert_eq!((answer.outcome, answer.entry, answer.exit), (RayOutcome::Hit, [entry; 2], [exit; 2]), "{origin:?}");
    }
    let beside = cast(&cube, &Pose::IDENTITY, [-3.0, 0.5, 1.0_f64.next_up()], [1.0, 0.0, 0.0]);
    assert_eq!((beside.outcome, beside.exact), (RayOutcome::Miss, 1));
    let before = cast(&cube, &Pose::IDENTITY, [2.0, 0.0, 0.5], [-1.0, 1.0_f64.next_up(), 0.0]);
    assert_eq!(before.outcome, RayOutcome::Miss);
}

#[test]
fn from_inside_entry_is_0() {
    let cube = cuboid([1.0; 3]);
    let answer = cast(&cube, &Pose::IDENTITY, [0.0, 0.25, 0.0], [0.0, 0.0, 4.0]);
    assert_eq!((answer.outcome, answer.entry, answer.feature.kind), (RayOutcome::Inside, [0.0; 2], FeatureKind::None));
    assert!(answer.exit[0] <= 0.25 && 0.25 <= answer.exit[1] && answer.normal[0].is_nan());
    // On the surface, inwards and outwards.
    let inwards = cast(&cube, &Pose::IDENTITY, [0.0, 0.25, -1.0], [0.0, 0.0, 1.0]);
    assert_eq!((inwards.outcome, inwards.entry, inwards.normal), (RayOutcome::Hit, [0.0; 2], [0.0, 0.0, -1.0]));
    let outwards = cast(&cube, &Pose::IDENTITY, [0.0, 0.25, 1.0], [0.0, 0.0, 1.0]);
    assert_eq!((outwards.outcome, outwards.exit), (RayOutcome::Inside, [0.0; 2]));
}

#[test]
fn it_ends_at_t_max() {
    let cube = cuboid([1.0; 3]);
    let until = |t_max: f64| {
        let ray = Ray { origin: [-3.0, 0.25, 0.5], direction: [1.0, 0.0, 0.0], t_max };
        cast_ray(cube.at(&Pose::IDENTITY), &ray).unwrap()
    };
    assert_eq!(until(2.0_f64.next_down()).outcome, RayOutcome::Miss);
    let touching = until(2.0);
    assert_eq!((touching.outcome, touching.entry, touching.exit), (RayOutcome::Hit, [2.0; 2], [2.0; 2]));
    assert_eq!(until(3.5).exit, [3.5; 2]);
    assert_eq!(until(0.0).outcome, RayOutcome::Miss);
}

#[test]
fn bodies_without_interior() {
    let square = hull(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(|[x, y]| Vector::new(x, y, 0.0)));
    let across = cast(&square, &Pose::IDENTITY, [1.0, 2.0, 3.0], [0.0, 0.0, -1.0]);
    assert_eq!((across.outcome, across.exact, across.normal), (RayOutcome::Hit, 0, [0.0, 0.0, 1.0]));
    let edge_on = cast(&square, &Pose::IDENTITY, [-1.0, 2.0, 0.0], [1.0, 0.0, 0.0]);
    assert_eq!((edge_on.outcome, edge_on.entry, edge_on.exit), (RayOutcome::Hit, [1.0; 2], [5.0; 2]));
    assert_eq!(edge_on.normal[2].abs(), 1.0);
    let segment = hull(&[Vector::zeros(), Vector::new(1.0, 2.0, 3.0)]);
    let crossing = cast(&segment, &Pose::IDENTITY, [0.5, 1.0, 3.5], [0.0, 0.0, -2.0]);
    assert_eq!((crossing.outcome, crossing.entry, crossing.exit), (RayOutcome::Hit, [1.0; 2], [1.0; 2]));
    assert_eq!((crossing.feature.kind, crossing.normal), (FeatureKind::Edge, [0.0, 0.0, 1.0]));
    let along = cast(&segment, &Pose::IDENTITY, [3.0, 6.0, 9.0], [-1.0, -2.0, -3.0]);
    assert_eq!((along.entry, along.exit), ([2.0; 2], [3.0; 2]));
    let point = hull(&[Vector::new(1.0, 1.0, 1.0)]);
    let met = cast(&point, &at(1.0, 0.0, 0.0), [0.0; 3], [2.0, 1.0, 1.0]);
    assert_eq!((met.outcome, met.entry, met.feature.kind), (RayOutcome::Hit, [1.0; 2], FeatureKind::Vertex));
    assert_eq!(cast(&point, &Pose::IDENTITY, [0.0; 3], [2.0, 1.0, 1.0]).outcome, RayOutcome::Miss);
}

#[test]
fn magnitudes_of_all_doubles() {
    for scale in [5e-324, 1e-300, 1e-160, 1.0, 1e160, 1e300] {
        let cube = cuboid([scale; 3]);
        let answer = cast(&cube, &Pose::IDENTITY, [-4.0 * scale, 0.0, 0.0], [scale, 0.0, 0.0]);
        assert_eq!(answer.outcome, RayOutcome::Hit, "{scale:e}");
        assert!(answer.entry[0] <= 3.0 && 3.0 <= answer.entry[1] && answer.entry[1] - answer.entry[0] < 1e-13);
    }
    // Where it is, no double says.
    let cube = cuboid([1.0; 3]);
    let slow = cast(&cube, &Pose::IDENTITY, [-1e300, 0.0, 0.0], [5e-324, 0.0, 0.0]);
    assert_eq!((slow.outcome, slow.entry), (RayOutcome::Hit, [f64::MAX, f64::INFINITY]));
}

/// A rotation may be off by as much as a pose may: the ray meets the body that the doubles describe.
#[test]
fn a_skewed_rotation_is_taken_as_it_is() {
    let cube = cuboid([1.0; 3]);
    let stretched = Pose::new(&(Matrix::identity() * 1.004), &Vector::zeros());
    let answer = cast(&cube, &stretched, [-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    let entry = 3.0 - 1.004;
    assert!((answer.entry[0] - entry).abs() < 1e-13 && answer.entry[1] - answer.entry[0] < 1e-13, "{answer:?}");
}

#[test]
fn a_rim_of_a_thousand_sides() {
    let prism = Shape::from_mesh(&models::prism(1000, 0.5).unwrap(), &ShapeOptions::default()).unwrap();
    let pose = Pose::new(
        &testkit::random::rotation(&Vector::new(1.0, 2.0, 3.0).normalize(), 0.7),
        &Vector::new(5.0, 0.0, 1.0),
    );
    for k in 0..100 {
        let (angle, radius) = (0.1 + 2.0 * PI * k as f64 / 100.0, 0.99 * (k as f64 / 100.0).sqrt());
        let local = Vector::new(radius * angle.cos(), radius * angle.sin(), 3.0);
        let (origin, direction) = (pose.transform(&local), pose.rotate(&-Vector::z()));
        let answer = cast(&prism, &pose, origin.into(), direction.into());
        assert_eq!((answer.outcome, answer.exact), (RayOutcome::Hit, 0), "{k}");
        assert!((answer.entry[0] - 2.5).abs() < 1e-12 && (answer.exit[1] - 3.5).abs() < 1e-12, "{answer:?}");
    }
}

#[test]
fn the_floating_point_environment_changes_no_bit() {
    let body = Shape::from_mesh(&models::ellipsoid([1.0, 0.5, 0.3], 200).unwrap(), &ShapeOptions::default()).unwrap();
    let pose = Pose::new(
        &testkit::random::rotation(&Vector::new(1.0, -2.0, 3.0).normalize(), 2.1),
        &Vector::new(0.1, 0.2, 0.3),
    );
    for direction in [[1.0, 0.1, FRAC_1_SQRT_2], [-0.3, 1.0, 0.0]] {
        let origin = [-2.0 * direction[0], -2.0 * direction[1], 0.3];
        // As text, since NaN is not equal to itself.
        let plain = format!("{:?}", cast(&body, &pose, origin, direction));
        for environment in Environment::all() {
            let answer = environment.run(|| cast(&body, &pose, origin, direction));
            assert_eq!(format!("{answer:?}"), plain, "{environment:?}");
        }
    }
}
