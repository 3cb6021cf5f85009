//! Bodies with thousands of neighbours at a vertex or sides at a face: right, and in time that grows with their number.

use swiftprox::math::{Matrix, Pose, UNIT_ROUNDOFF, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, DecidedBy, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::models;
use testkit::random::Random;

const SIDES: u32 = 3000;

fn shape(mesh: swiftprox::error::Result<PolygonMesh>) -> Shape {
    Shape::from_mesh(&mesh.unwrap(), &ShapeOptions::default()).unwrap()
}

fn contact(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose) -> PairAnswer {
    let mut answer = PairAnswer::default();
    pair::contact([shape1.at(pose1), shape2.at(pose2)], &mut PairCache::default(), &PairConfig::default(), &mut answer)
        .unwrap();
    answer
}

/// How far the bodies overlap along the normal, by a look at all vertices.
fn overlap(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose, answer: &PairAnswer) -> f64 {
    let normal = Vector::from(answer.normal);
    let heights = |shape: &Shape, pose: &Pose| -> Vec<f64> {
        let polyhedron = shape.polyhedron();
        (0..polyhedron.vertices.len() as u32)
            .map(|v| normal.dot(&pose.transform(&polyhedron.local_position(v))))
            .collect()
    };
    let lowest = heights(shape1, pose1).into_iter().fold(f64::INFINITY, f64::min);
    heights(shape2, pose2).into_iter().fold(f64::NEG_INFINITY, f64::max) - lowest
}

fn assert_touching(shape1: &Shape, shape2: &Shape, pose2: &Pose) -> PairAnswer {
    for (a, pose_a, b, pose_b) in [(shape1, &Pose::IDENTITY, shape2, pose2), (shape2, pose2, shape1, &Pose::IDENTITY)] {
        let answer = contact(a, pose_a, b, pose_b);
        assert_eq!(answer.outcome, Outcome::Intersecting, "{pose2:?}");
        let overlap = overlap(a, pose_a, b, pose_b, &answer);
        assert!(overlap.abs() <= 64.0 * UNIT_ROUNDOFF, "{overlap:e} along {:?} at {pose2:?}", answer.normal);
    }
    contact(shape1, &Pose::IDENTITY, shape2, pose2)
}

/// The rotations by multiples of a right angle, which are exact.
fn right_angles() -> Vec<Matrix> {
    let units = [Vector::x(), Vector::y(), Vector::z(), -Vector::x(), -Vector::y(), -Vector::z()];
    let pairs = units.iter().flat_map(|a| units.iter().map(move |b| (*a, *b)));
    pairs.filter(|(a, b)| a.dot(b) == 0.0).map(|(a, b)| Matrix::from_columns(&[a, b, a.cross(&b)])).collect()
}

#[test]
fn the_apexes_of_two_cones_touch() {
    // The last ones have flush edges where the axes are at right angles up to rounding: (1, 0, 0) - (0, 0, 1) is one of each.
    for (height1, height2) in [(2.0, 2.0), (4.0, 0.5), (0.25, 2.0), (1.0, 1.0)] {
        let (cone1, cone2) = (shape(models::cone(SIDES, height1)), shape(models::cone(SIDES, height2)));
        let mut touching = 0;
        for rotation in right_angles() {
            let axis = rotation * Vector::z();
            // Cones side by side overlap if their half angles, whose tangents are 1/height, sum to more than a right angle.
            if axis.z == 1.0 || (axis.z == 0.0 && height1 * height2 < 1.0) {
                continue;
            }
            let pose2 = Pose::new(&rotation, &(Vector::z() * height1 - axis * height2));
            assert_touching(&cone1, &cone2, &pose2);
            touching += 1;
        }
        assert_eq!(touching, if height1 * height2 < 1.0 { 4 } else { 20 });
    }
}

#[test]
fn an_apex_touches_a_face_of_thousands_of_sides() {
    let (cone, prism) = (shape(models::cone(SIDES, 2.0)), shape(models::prism(SIDES, 1.0)));
    for (x, y) in [(0.0, 0.0), (0.25, 0.5), (-0.5, 0.75), (-1.0, 0.0)] {
        let answer = assert_touching(&cone, &prism, &Pose::new(&Matrix::identity(), &Vector::new(x, y, 3.0)));
        if x != -1.0 {
            let normal = Vector::from(answer.normal);
            assert!((normal + Vector::z()).norm() <= 4.0 * UNIT_ROUNDOFF, "{normal:?}");
        }
    }
}

#[test]
fn an_apex_touches_an_edge() {
    let (cone, cube) = (shape(models::cone(SIDES, 2.0)), shape(models::cuboid([1.0; 3])));
    for (x, z) in [(0.25, 3.0), (-0.75, 3.0), (1.0, 3.0)] {
        assert_touching(&cone, &cube, &Pose::new(&Matrix::identity(), &Vector::new(x, 1.0, z)));
    }
}

/// The short edges of the caps lean out of their merged planes by rounding; the certificate's closer look allows for that.
#[test]
fn rotated_prisms_of_many_sides_are_marched() {
    let mut random = Random::new(3);
    for half_height in [1.0, 0.1, 0.01] {
        let mut mesh = models::prism(1000, half_height).unwrap();
        let turned = random.rotation();
        mesh.vertices.iter_mut().for_each(|v| *v = turned * *v);
        let prism = shape(Ok(mesh));
        for _ in 0..200 {
            let pose1 = Pose::new(&random.rotation(), &Vector::zeros());
            let pose2 = Pose::new(&random.rotation(), &(random.direction() * random.uniform(3.0, 4.0)));
            let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
            pair::distance([prism.at(&pose1), prism.at(&pose2)], &mut cache, &PairConfig::default(), &mut answer)
                .unwrap();
            assert_eq!(answer.decided_by, DecidedBy::Marching);
            verify([prism.at(&pose1), prism.at(&pose2)], &answer).unwrap();
        }
    }
}

/// Work that grows with the square of a valence would take minutes here.
#[test]
fn bodies_of_thirty_thousand_sides_are_built() {
    const MANY: u32 = 30_000;
    let families: [fn(u32) -> swiftprox::error::Result<PolygonMesh>; 5] = [
        |n| models::cone(n, 1.0),
        |n| models::bipyramid(n, 1.0),
        |n| models::trapezohedron(n, 1.0),
        |n| models::prism(n, 1.0),
        |n| models::moment_curve(n as usize),
    ];
    for mesh in families {
        let mesh = mesh(MANY).unwrap();
        assert_eq!(shape(Ok(mesh.clone())).polyhedron().vertices.len(), mesh.vertices.len());
    }
}
