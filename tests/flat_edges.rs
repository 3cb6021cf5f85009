//! Edges with next to no dihedral angle: in double precision the normal cone of such an edge is a line, and a direction into the
//! body must not pass for one out of it.

#[path = "../benches/common/mod.rs"]
mod common;
#[path = "oracle/cases.rs"]
#[allow(dead_code)] // the cases themselves: only their random numbers are drawn here
mod cases;
#[allow(dead_code)] // what other tests ask of it
mod oracle;
mod shapes;

use cases::Random;
use common::caches::cache_of_features;
use shapes::hull;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, distance};

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
                distance(&shapes[0], &poses[0], &shapes[1], &poses[1], &mut cache, &config, &mut answer).unwrap();
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
            distance(&cube, &at, &plate, &pose, &mut PairCache::default(), &config, &mut answer).unwrap();
            assert_eq!(answer.outcome, Outcome::Intersecting, "{half:e}: {answer:?}");
        }
    }
}
