//! Each piece by itself: its triangles are those of the mesh, once each, and lie on its hull; the hull is inside of the body.

use std::f64::consts::TAU;

use swiftprox::base::predicates::ExactPoints;
use swiftprox::body::decomposition::{Decomposition, decompose};
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, PairAnswer, PairCache, PairConfig, Placed};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, NO_FACE, Shape, ShapeOptions};
use testkit::random::Random;

use crate::bodies::{bodies, l_shape, sheets, torus, turned, turned_round};

pub fn pieces_of(mesh: &PolygonMesh, tolerance: f64) -> Decomposition {
    decompose(mesh, tolerance, &mut Progress::new(&mut |_| true)).unwrap()
}

fn area(points: &[Vector], corners: &[u32]) -> Vector {
    let origin = points[corners[0] as usize];
    let offset = |v: u32| points[v as usize] - origin;
    corners[1..].windows(2).map(|pair| 0.5 * offset(pair[0]).cross(&offset(pair[1]))).sum()
}

/// The area vectors of the triangles of each face add up to the face's: nothing is missing, nothing is there twice.
fn check_cover(name: &str, mesh: &PolygonMesh, pieces: &Decomposition) {
    let mut covered = vec![(Vector::zeros(), 0.0); mesh.face_count()];
    for (corners, face) in pieces.triangles.iter().zip(&pieces.faces) {
        assert!(corners.iter().all(|v| mesh.face(*face as usize).contains(v)), "{name}: {corners:?} of face {face}");
        let area = area(&mesh.vertices, corners);
        covered[*face as usize].0 += area;
        covered[*face as usize].1 += area.norm();
    }
    for (f, (vector, sum)) in covered.iter().enumerate() {
        let whole = area(&mesh.vertices, mesh.face(f));
        assert!((vector - whole).norm() < 1e-12 && (sum - whole.norm()).abs() < 1e-12, "{name}: face {f}");
    }
    let piece_ends = pieces.starts.windows(2).all(|ends| ends[0] < ends[1]);
    assert!(piece_ends && *pieces.starts.last().unwrap() as usize == pieces.triangles.len(), "{name}");
}

/// No vertex of a piece lies above one of its triangles.
fn check_convex(name: &str, mesh: &PolygonMesh, pieces: &Decomposition) {
    let exact = ExactPoints::new(&mesh.vertices).unwrap();
    for piece in (0..pieces.piece_count()).map(|k| pieces.piece(k)) {
        for (corners, v) in piece.iter().flat_map(|corners| piece.iter().flatten().map(move |v| (corners, v))) {
            assert!(exact.orientation(*corners, *v) <= 0.0, "{name}: vertex {v} above {corners:?}");
        }
    }
}

/// How often the surface winds around a point (A. van Oosterom & J. Strackee, "The solid angle of a plane triangle", 1983).
fn winding(mesh: &PolygonMesh, triangles: &[[u32; 3]], point: &Vector) -> f64 {
    let solid_angle = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| mesh.vertices[v as usize] - point);
        let [x, y, z] = [a, b, c].map(|v| v.norm());
        let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        2.0 * a.dot(&b.cross(&c)).atan2(below)
    };
    triangles.iter().map(solid_angle).sum::<f64>() / (2.0 * TAU)
}

/// The least distance of a point from triangles.
fn distance_from(mesh: &PolygonMesh, triangles: &[[u32; 3]], point: &Vector) -> f64 {
    let shape = |points: &[Vector]| Shape::from_points(points, &with(InputPolicy::Hull)).unwrap();
    let to_triangle = |corners: &[u32; 3]| {
        let pair = [shape(&corners.map(|v| mesh.vertices[v as usize])), shape(&[*point])];
        let mut answer = PairAnswer::default();
        let bodies = [0, 1].map(|i| Placed { shape: &pair[i], pose: &Pose::IDENTITY });
        pair::distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
        answer.upper
    };
    triangles.iter().map(to_triangle).fold(f64::INFINITY, f64::min)
}

/// Points inside of each piece's hull are inside of the body.
fn check_inside(name: &str, mesh: &PolygonMesh, pieces: &Decomposition) {
    let mut random = Random::new(7);
    for piece in (0..pieces.piece_count()).map(|k| pieces.piece(k)) {
        let corners: Vec<u32> = piece.concat();
        for _ in 0..30 {
            let weights: Vec<f64> = corners.iter().map(|_| random.uniform(0.0, 1.0).powi(4)).collect();
            let weighted = corners.iter().zip(&weights).map(|(v, w)| mesh.vertices[*v as usize] * *w);
            let point = weighted.sum::<Vector>() / weights.iter().sum::<f64>();
            let found = winding(mesh, &pieces.triangles, &point);
            // Of a flat piece they are on the surface, where rounding decides between 0, a half and 1.
            let is_inside = found > 0.99 || distance_from(mesh, &pieces.triangles, &point) < 1e-13;
            assert!(is_inside, "{name}: {found} at {point:?}");
        }
    }
}

#[test]
fn pieces_are_convex_cover_the_surface_once_and_are_inside() {
    for (name, mesh) in bodies() {
        let pieces = pieces_of(&mesh, 0.0);
        check_cover(name, &mesh, &pieces);
        check_convex(name, &mesh, &pieces);
        check_inside(name, &mesh, &pieces);
    }
}

#[test]
fn pieces_of_open_surfaces_are_flat() {
    for (name, mesh) in sheets() {
        let pieces = pieces_of(&mesh, 0.0);
        check_cover(name, &mesh, &pieces);
        check_convex(name, &mesh, &pieces);
        for piece in (0..pieces.piece_count()).map(|k| pieces.piece(k)) {
            // Exactly as large as its triangles: it covers nothing beside the surface.
            let corners: Vec<Vector> = piece.iter().flatten().map(|v| mesh.vertices[*v as usize]).collect();
            let hull = Shape::from_points(&corners, &with(InputPolicy::Hull)).unwrap();
            assert_eq!(hull.polyhedron().dimension, 2, "{name}");
            let [sum, whole] = [
                piece.iter().map(|t| area(&mesh.vertices, t).norm()).sum::<f64>(),
                hull.polyhedron().triangles.iter().map(|t| triangle_area(&hull, t)).sum::<f64>() / 2.0,
            ];
            assert!((sum - whole).abs() < 1e-12, "{name}: {sum} of {whole}");
        }
    }
}

fn triangle_area(hull: &Shape, corners: &[u32; 3]) -> f64 {
    let [a, b, c] = corners.map(|v| hull.polyhedron().local_position(v));
    0.5 * (b - a).cross(&(c - a)).norm()
}

fn with(input: InputPolicy) -> ShapeOptions {
    ShapeOptions { input, ..Default::default() }
}

/// So many and no more: a change for the worse shows.
#[test]
fn there_are_few_pieces() {
    let counts: Vec<(&str, usize)> =
        bodies().iter().chain(&sheets()).map(|(name, mesh)| (*name, pieces_of(mesh, 0.0).piece_count())).collect();
    let count = |name: &str| counts.iter().find(|(other, _)| *other == name).unwrap().1;
    assert_eq!(count("two Ls"), 2 * count("L"));
    let most =
        [("cuboid", 1), ("L", 2), ("slot", 3), ("star", 4), ("gear", 7), ("torus", 25), ("grid", 1), ("leaf", 4)];
    for (name, most) in most {
        assert!(count(name) <= most, "{name}: {}", count(name));
    }
}

/// What was plane before it was turned is plane within rounding: exactly taken, it comes to pieces; with a tolerance it does not.
#[test]
fn a_tolerance_takes_plane_faces_for_plane() {
    let gear = bodies().into_iter().find(|(name, _)| *name == "gear").unwrap().1;
    let [plain, exact, tolerant] =
        [pieces_of(&gear, 0.0), pieces_of(&turned(&gear), 0.0), pieces_of(&turned(&gear), 1e-12)];
    assert!(exact.piece_count() > 2 * plain.piece_count(), "{} and {}", exact.piece_count(), plain.piece_count());
    assert_eq!(tolerant.piece_count(), plain.piece_count());
    check_cover("gear", &turned(&gear), &tolerant);
}

/// All the same up to the order of corners.
#[test]
fn a_mesh_that_is_inside_out_is_turned() {
    for mesh in [l_shape(), torus(9, 6)] {
        let [right, wrong] = [pieces_of(&mesh, 0.0), pieces_of(&turned_round(&mesh), 0.0)];
        check_inside("turned", &mesh, &wrong);
        assert_eq!(right.triangles.len(), wrong.triangles.len());
    }
}

/// Hull faces between the pieces have no number, the others the caller's; vertices as well.
#[test]
fn shapes_of_pieces_know_the_callers_numbers() {
    for (name, mesh) in bodies() {
        let pieces = pieces_of(&mesh, 0.0);
        for k in 0..pieces.piece_count() {
            let patch = PolygonMesh::new(mesh.vertices.clone(), pieces.piece(k).concat(), None).unwrap();
            let shape = Shape::from_mesh(&patch, &with(InputPolicy::Patch)).unwrap();
            let polyhedron = shape.polyhedron();
            for (v, label) in polyhedron.vertex_labels.iter().enumerate() {
                assert_eq!(polyhedron.local_position(v as u32), mesh.vertices[*label as usize], "{name}");
            }
            let mut found: Vec<u32> =
                polyhedron.face_labels.iter().copied().filter(|label| *label != NO_FACE).collect();
            found.sort_unstable();
            assert!(found.iter().copied().eq(0..patch.face_count() as u32), "{name}: {found:?}");
            if name == "cuboid" {
                assert!(!polyhedron.face_labels.contains(&NO_FACE));
            }
        }
    }
}

/// Where a T-junction is closed by a triangle without area, and where a face runs along a line twice (a hole with a bridge to it).
#[test]
fn triangles_without_area_and_bridges_are_taken() {
    let mut sliver = PolygonMesh::default();
    for [x, y, z] in [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0], [1.0, 0.0, 0.0]] {
        sliver.push_vertex(Vector::new(x, y, z)).unwrap();
    }
    for face in [&[0, 2, 4][..], &[4, 2, 1], &[0, 1, 3], &[0, 4, 1], &[1, 2, 3], &[0, 3, 2]] {
        sliver.push_face(face).unwrap();
    }
    assert_eq!(pieces_of(&sliver, 0.0).piece_count(), 1);

    // A square ring, each cap one polygon that goes in to the hole and out again.
    let mut ring = PolygonMesh::default();
    for (k, z) in [(2.0, -0.5), (1.0, -0.5), (2.0, 0.5), (1.0, 0.5)] {
        [[-k, -k], [k, -k], [k, k], [-k, k]]
            .iter()
            .for_each(|[x, y]| ring.push_vertex(Vector::new(*x, *y, z)).unwrap());
    }
    let cap = [8, 9, 10, 11, 8, 12, 15, 14, 13, 12];
    ring.push_face(&cap).unwrap();
    ring.push_face(&cap.map(|v| v - 8).into_iter().rev().collect::<Vec<_>>()).unwrap();
    for (i, next) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        ring.push_face(&[i, next, next + 8, i + 8]).unwrap();
        ring.push_face(&[next + 4, i + 4, i + 12, next + 12]).unwrap();
    }
    let pieces = pieces_of(&ring, 0.0);
    check_convex("ring", &ring, &pieces);
    check_inside("ring", &ring, &pieces);
    assert!(pieces.piece_count() <= 8, "{}", pieces.piece_count());
}
