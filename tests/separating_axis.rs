//! Verdicts from a separating axis: right, verified, and what most queries of a coherent motion come from.

#[path = "../benches/common/mod.rs"]
mod common;

use common::models::{self, ellipsoid};
use common::orbits::{ORBITS, Step, poses};
use swiftprox::math::Pose;
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, Status, distance, intersection};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify;

const COUNT: usize = 400;

fn bodies() -> Vec<PolygonMesh> {
    let half_axes = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [0.1, 0.1, 1.0]];
    let mut bodies: Vec<_> = half_axes.iter().flat_map(|axes| [12, 102, 1002].map(|n| ellipsoid(*axes, n))).collect();
    bodies.extend([models::prism(4, 0.5), models::prism(40, 1.0), models::cone(200, 1.0)]);
    bodies.into_iter().map(Result::unwrap).collect()
}

/// Each answer against that of a cold exact query; returns how many came from an axis, and of how many disjoint pairs.
fn fly(shape: &Shape, orbit: usize, step: &str) -> [usize; 2] {
    let mut counts = [0; 2];
    let (mut cache, mut answer, mut exact) = (PairCache::default(), PairAnswer::default(), PairAnswer::default());
    for (number, pose) in poses(ORBITS[orbit], step.parse::<Step>().unwrap(), COUNT).into_iter().enumerate() {
        // Now and then with a tolerance: the answer is on the side of it that the distance is.
        let distance_tolerance = if number % 8 == 7 { 1.0 } else { f64::INFINITY };
        let config = PairConfig { distance_tolerance, ..PairConfig::default() };
        let [pose1, pose2] = [&pose[..12], &pose[12..]].map(|m| Pose::from_row_major(m.try_into().unwrap()));
        intersection(shape, &pose1, shape, &pose2, &mut cache, &config, &mut answer).unwrap();
        distance(shape, &pose1, shape, &pose2, &mut PairCache::default(), &config, &mut exact).unwrap();
        assert_eq!(answer.outcome, exact.outcome);
        verify(shape, &pose1, shape, &pose2, &answer).unwrap();
        assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?}\n{exact:?}");
        let is_disjoint = answer.outcome == Outcome::Separated;
        let is_disjoint = is_disjoint && number % 8 != 7;
        counts[0] += usize::from(is_disjoint && answer.status == Status::Coherent);
        counts[1] += usize::from(is_disjoint);
    }
    counts
}

#[test]
fn verdicts_of_every_motion_are_right() {
    for mesh in bodies() {
        let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
        for orbit in 0..ORBITS.len() {
            for step in ["0.1", "5", "45", "random"] {
                fly(&shape, orbit, step);
            }
        }
    }
}

#[test]
fn bodies_that_stay_apart_seldom_need_more() {
    let large = ORBITS.iter().position(|orbit| orbit.name == "large").unwrap();
    for mesh in bodies() {
        let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
        for (step, least) in [("0.1", 0.99), ("1", 0.98), ("10", 0.95)] {
            let [by_axis, disjoint] = fly(&shape, large, step);
            assert!(disjoint > 3 * COUNT / 4);
            assert!(by_axis as f64 >= least * disjoint as f64, "{by_axis} of {disjoint} at {step} degrees");
        }
    }
}

/// The axis beside the features does no harm to queries that ask for more, and the other way round.
#[test]
fn verdicts_and_distances_take_turns() {
    let shape = Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], 502).unwrap(), &ShapeOptions::default()).unwrap();
    let (mut cache, mut answer, mut steps) = (PairCache::default(), PairAnswer::default(), 0);
    for (number, pose) in poses(ORBITS[0], "0.1".parse().unwrap(), COUNT).iter().enumerate() {
        let [pose1, pose2] = [&pose[..12], &pose[12..]].map(|m| Pose::from_row_major(m.try_into().unwrap()));
        let query = if number % 2 == 0 { intersection } else { distance };
        query(&shape, &pose1, &shape, &pose2, &mut cache, &PairConfig::default(), &mut answer).unwrap();
        verify(&shape, &pose1, &shape, &pose2, &answer).unwrap();
        if number > 1 {
            assert_eq!(answer.status == Status::Coherent, number % 2 == 0, "{number}");
            steps += answer.statistics.marching_steps;
        }
    }
    assert!(steps < 3 * COUNT as u32, "{steps}");
}
