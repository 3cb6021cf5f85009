//! Edges with next to no dihedral angle: in double precision the normal cone of such an edge is a line, and a direction into the
//! body must not pass for one out of it.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::placed::Pair;
use swiftprox::placed::exact::solve;
use testkit::caches::cache_of_features;
use testkit::random::Random;
use testkit::shapes::hull;

/// An edge of B lies deep inside A, under a ridge of A that is all but flat, and nearly parallel to it: the difference of the
/// edges' nearest points is perpendicular to both, but points the wrong way for A.
#[test]
fn an_edge_under_a_flat_ridge_is_inside() {
    let mut random = Random::new(0x1f1a7);
    let mut wrong = Vec::new();
    for round in 0..400 {
        let drop = 2f64.powi(-20 - round % 36);
        let slope = random.power(-30, -1);
        let turn = random.rotation();
        let turned = |points: &[[f64; 3]]| points.iter().map(|p| turn * Vector::from(*p)).collect::<Vec<_>>();
        let a = turned(&[[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.1, 1.0, -drop], [-0.1, -1.0, -drop], [0.0, 0.0, -2.0]]);
        let b = turned(&[[0.4, 0.4 * slope, -0.5], [-0.4, -0.4 * slope, -0.5], [0.0, 0.3, -1.0], [0.0, -0.3, -1.0]]);
        let shapes = [hull(&a), hull(&b)];
        let poses = [Pose::new(&Matrix::identity(), &random.vector()); 2];
        for e in 0..shapes[0].polyhedron().edges.len() as u32 {
            for f in 0..shapes[1].polyhedron().edges.len() as u32 {
                let (mut cache, config) = (cache_of_features(6, [e, f]), PairConfig::default());
                let mut answer = PairAnswer::default();
                distance([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &mut cache, &config, &mut answer).unwrap();
                if answer.outcome != Outcome::Intersecting {
                    wrong.push((drop, slope, answer));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong, for one {:?}", wrong.len(), wrong[0]);
}

/// Squares of a plate's thickness underflow.
#[test]
fn the_thinnest_plate_across_a_cube_meets_it() {
    let corner =
        |half: [f64; 3], k: usize| Vector::from_fn(|axis, _| half[axis] * (1.0 - 2.0 * f64::from(k >> axis & 1 == 1)));
    let cuboid = |half: [f64; 3]| hull(&(0..8).map(|k| corner(half, k)).collect::<Vec<_>>());
    let cube = cuboid([32.0; 3]);
    for thickness in [5e-324, 2e-308, 1e-300, 1e-200, 1e-150, 1e-100, 1e-15] {
        for half in [thickness, -thickness] {
            let plate = cuboid([32.0, 32.0, half]);
            let mut pose = Pose::new(&Matrix::identity(), &Vector::new(-32.0, -32.0, -32.0));
            pose.rows[0][0] = 1.00390625;
            let at = Pose::new(&Matrix::identity(), &Vector::new(-32.0, 0.0, -32.0));
            let mut answer = PairAnswer::default();
            let config = PairConfig::default();
            distance([cube.at(&at), plate.at(&pose)], &mut PairCache::default(), &config, &mut answer).unwrap();
            assert_eq!(answer.outcome, Outcome::Intersecting, "{half:e}: {answer:?}");
        }
    }
}

/// The long sides of a triangle are so near each other that their computed planes diverge beyond its tip, where a body a
/// thousand times as large looks at its plane: the foot is in none of its faces. Found by reading: a margin in proportion to
/// the triangle's own size let the foot pass.
#[test]
fn beyond_the_tip_of_a_needle_is_no_face() {
    let mut random = Random::new(0x4eed1e);
    let mut wrong = Vec::new();
    for _ in 0..4_000 {
        let (tip, blunt) = (random.direction(), random.power(-40, -10) * random.direction());
        let mut points = vec![tip, blunt, blunt + random.power(-57, -50) * random.vector()];
        points.extend((0..random.below(2)).map(|_| 0.1 * random.vector()));
        let needle = hull(&points);
        let faces = &needle.polyhedron().faces;
        for (index, face) in faces.iter().enumerate() {
            let size = random.power(4, 14);
            let above = |random: &mut Random| size * (face.normal + 0.5 * random.vector());
            let large = hull(&[Vector::zeros(), above(&mut random), above(&mut random), above(&mut random)]);
            let vertex = large.polyhedron().vertex_labels.iter().position(|label| *label == 0);
            let Some(vertex) = vertex else { continue };
            let at = tip + (tip - blunt) * (size * random.uniform(0.0, 1.0)) + face.normal * random.power(-40, 0);
            let poses = [at, Vector::zeros()].map(|t| Pose::new(&Matrix::identity(), &t));
            let truth = solve(
                &Pair { polyhedra: [large.polyhedron(), needle.polyhedron()], poses: [&poses[0], &poses[1]] },
                &[],
            );
            let (mut cache, config) = (cache_of_features(4, [vertex as u32, index as u32]), PairConfig::default());
            let mut answer = PairAnswer::default();
            distance([large.at(&poses[0]), needle.at(&poses[1])], &mut cache, &config, &mut answer).unwrap();
            let is_right = truth.intersecting == (answer.outcome == Outcome::Intersecting)
                && answer.lower <= truth.upper
                && truth.lower <= answer.upper;
            if !is_right {
                wrong.push((points.clone(), truth.lower, answer));
            }
        }
    }
    assert!(wrong.is_empty(), "{} wrong, for one {:?}", wrong.len(), wrong[0]);
}
