//! Distances of points from polyhedra against integer arithmetic.

use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::math::{Pose, Vector};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;
use swiftprox::shape::levels::point_distance::PointDistance;
use testkit::models::{ELLIPSOIDS, cuboid, ellipsoid, prism, random_hull};
use testkit::random::Random;

fn bodies() -> Vec<(String, Polyhedron)> {
    let mut all: Vec<(String, Vec<Vector>)> = Vec::new();
    for (name, half_axes) in ELLIPSOIDS {
        all.push((name.into(), ellipsoid(half_axes, 300).unwrap().vertices));
    }
    let mut random = Random::new(4);
    for half_axes in [[1.0, 1e-5, 1e-5], [1.0, 1.0, 1e-5], [1.0, 1.0, 1e-10], [1.0, 1e-3, 1e-8], [1.0, 1.0, 0.0]] {
        let points = (0..300).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
        all.push((format!("{half_axes:?}"), points));
    }
    all.push(("box".into(), cuboid([1.0, 2.0, 3.0]).unwrap().vertices));
    all.push(("prism".into(), prism(200, 0.1).unwrap().vertices));
    all.push(("cone".into(), prism(200, 0.1).unwrap().vertices[..200].iter().copied().chain([Vector::z()]).collect()));
    all.push(("random hull".into(), random_hull(500, 3).unwrap().vertices));
    all.push(("tetrahedron".into(), vec![Vector::zeros(), Vector::x(), Vector::y(), Vector::z()]));
    all.push(("square".into(), vec![Vector::zeros(), Vector::x(), Vector::x() + Vector::y(), Vector::y()]));
    all.push(("segment".into(), vec![Vector::zeros(), Vector::new(1.0, 2.0, 3.0)]));
    all.push(("point".into(), vec![Vector::new(1.0, 2.0, 3.0)]));
    all.into_iter().map(|(name, points)| (name, build(&points, None).unwrap())).collect()
}

#[test]
fn the_bound_holds_and_is_tight() {
    let mut random = Random::new(8);
    let probe = build(&[Vector::zeros()], None).unwrap();
    let mut inside = 0;
    for (name, mut body) in bodies() {
        // Centred coordinates.
        body.centre = Vector::zeros();
        let distance = PointDistance::new(&body).unwrap();
        let mut hint = 0;
        for k in 0..400 {
            let near = body.vertices[random.next_u64() as usize % body.vertices.len()].position;
            // Far away, about the body, close to a vertex, on it.
            let scale = [100.0, 2.0, 0.1, 1e-6, 1e-12, 0.0][k % 6] * body.radius.max(1.0);
            let point = near + random.direction() * scale;
            let pose = Pose::new(&Pose::IDENTITY.rotation(), &point);
            let truth = exact::solve(&Pair { polyhedra: [&probe, &body], poses: [&pose, &Pose::IDENTITY] }, &[]);
            let found = distance.nearest(&point, hint);
            assert!(found.upper >= truth.lower, "{name}: {:e} below {:e}", found.upper, truth.lower);
            let excess = found.upper - truth.upper;
            assert!(excess <= 1e-14 * (body.radius + truth.upper), "{name}, {scale:e}: {excess:e} too much");
            let apart = (found.point - point).norm();
            assert!((apart - found.upper).abs() <= 1e-14 * (body.radius + apart), "{name}");
            inside += usize::from(truth.intersecting && scale > 0.0);
            // Any hint will do.
            hint = if k % 3 == 0 { random.next_u64() as u32 % body.vertices.len() as u32 } else { found.vertex };
        }
    }
    assert!(inside > 200, "{inside}");
}
