//! The faces of a shape, as a program reads them: each is a polygon of the caller's, or the hull's own.

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{FeatureKind, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

/// A prism over a hexagon whose top is two polygons: they are one face, with the labels of both.
#[test]
fn a_face_has_the_labels_of_all_that_was_merged_in_it() {
    let ring = |z: f64| {
        (0..6).map(move |k| {
            let angle = std::f64::consts::FRAC_PI_3 * f64::from(k);
            Vector::new(angle.cos(), angle.sin(), z)
        })
    };
    let vertices: Vec<Vector> = ring(-1.0).chain(ring(1.0)).collect();
    let mut faces: Vec<Vec<u32>> = vec![vec![5, 4, 3, 2, 1, 0], vec![6, 7, 8, 9], vec![6, 9, 10, 11]];
    faces.extend((0..6).map(|k| vec![k, (k + 1) % 6, 6 + (k + 1) % 6, 6 + k]));
    let counts: Vec<u32> = faces.iter().map(|face| face.len() as u32).collect();
    let mesh = PolygonMesh::new(vertices, faces.concat(), Some(&counts)).unwrap();
    let prism = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    assert_eq!(prism.face_count(), 8);
    let top = prism.find_face(1).unwrap();
    assert_eq!(prism.find_face(2), Some(top));
    let top = prism.face(top).unwrap();
    assert_eq!((top.labels(), top.normal(), top.offset()), (&[1, 2][..], [0.0, 0.0, 1.0], 1.0));
    let labels = &prism.polyhedron().vertex_labels;
    let around: Vec<u32> = top.corners().map(|corner| labels[corner as usize]).collect();
    let first = around.iter().position(|&label| label == 6).unwrap();
    assert_eq!((0..6).map(|k| around[(first + k) % 6]).collect::<Vec<_>>(), [6, 7, 8, 9, 10, 11]);
    assert_eq!((prism.find_face(9), prism.face(8).is_none()), (None, true));
}

/// Of any hull: corners are in the plane, all vertices behind it, and they go around counter-clockwise.
#[test]
fn faces_bound_the_hull() {
    let mut random = Random::new(0xface);
    for count in [4, 8, 30, 100] {
        let cloud: Vec<Vector> = (0..count).map(|_| random.direction() * 3.0 + Vector::new(5.0, 0.0, 0.0)).collect();
        let shape = hull(&cloud);
        for index in 0..shape.face_count() {
            let face = shape.face(index).unwrap();
            assert_eq!((face.labels(), shape.find_face(index as u32)), (&[index as u32][..], Some(index)));
            let normal = Vector::from(face.normal());
            let position = |corner: u32| shape.polyhedron().local_position(corner);
            let corners: Vec<Vector> = face.corners().map(position).collect();
            assert!(corners.iter().all(|corner| (normal.dot(corner) - face.offset()).abs() < 1e-13));
            assert!(cloud.iter().all(|point| normal.dot(point) < face.offset() + 1e-13));
            for k in 0..corners.len() {
                let [a, b, c] = [0, 1, 2].map(|step| corners[(k + step) % corners.len()]);
                assert!((b - a).cross(&(c - b)).dot(&normal) > 0.0);
            }
        }
    }
}

/// The face of an answer is found, and the witness point is in its plane.
#[test]
fn a_face_of_an_answer_is_found() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from);
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let (tetrahedron, cube) = (Shape::from_points(&corners, &options).unwrap(), cuboid([0.1; 3]));
    let mut answer = PairAnswer::default();
    let poses = [Pose::IDENTITY, at(1.0, 1.0, 1.0)];
    let bodies = [tetrahedron.at(&poses[0]), cube.at(&poses[1])];
    distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
    assert_eq!(answer.feature1.kind, FeatureKind::Face);
    let face = tetrahedron.face(tetrahedron.find_face(answer.feature1.ids[0]).unwrap()).unwrap();
    assert!((Vector::from(face.normal()).dot(&Vector::from(answer.local1)) - face.offset()).abs() < 1e-15);
    assert!((Vector::from(face.normal()) - Vector::from([3.0_f64.sqrt().recip(); 3])).norm() < 1e-15);
}
