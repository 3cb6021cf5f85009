//! Verdicts from bounding spheres and from a separating axis: right, verified, and what most queries of a coherent motion come
//! from.

use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::contact;
use swiftprox::pair::{
    DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, Placed, approximate, distance, intersection,
};
use swiftprox::shape::{Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::models::{self, ellipsoid};
use testkit::orbits::{ORBITS, Orbit, Step, poses};
use testkit::random::Random;

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<(), Error>;

const COUNT: usize = 400;

fn bodies() -> Vec<PolygonMesh> {
    let half_axes = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [0.1, 0.1, 1.0]];
    let mut bodies: Vec<_> = half_axes.iter().flat_map(|axes| [12, 102, 1002].map(|n| ellipsoid(*axes, n))).collect();
    bodies.extend([models::prism(4, 0.5), models::prism(40, 1.0), models::cone(200, 1.0)]);
    bodies.into_iter().map(Result::unwrap).collect()
}

/// Each answer against that of a cold exact query; returns, of the disjoint pairs, how many the spheres decided, an axis, and
/// neither.
fn fly(shape: &Shape, orbit: Orbit, step: &str) -> [usize; 3] {
    let mut counts = [0; 3];
    let (mut cache, mut answer, mut exact) = (PairCache::default(), PairAnswer::default(), PairAnswer::default());
    for (number, pose) in poses(orbit, step.parse::<Step>().unwrap(), COUNT).into_iter().enumerate() {
        // Now and then with a tolerance: the answer is on the side of it that the distance is.
        let max_distance = if number % 8 == 7 { 1.0 } else { f64::INFINITY };
        let config = PairConfig { max_distance, ..PairConfig::default() };
        let [pose1, pose2] = [&pose[..12], &pose[12..]].map(|m| Pose::from_row_major(m.try_into().unwrap()));
        intersection([shape.at(&pose1), shape.at(&pose2)], &mut cache, &config, &mut answer).unwrap();
        distance([shape.at(&pose1), shape.at(&pose2)], &mut PairCache::default(), &config, &mut exact).unwrap();
        assert_eq!(answer.outcome, exact.outcome);
        verify([shape.at(&pose1), shape.at(&pose2)], &answer).unwrap();
        assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?}\n{exact:?}");
        if answer.outcome == Outcome::Separated && number % 8 != 7 {
            counts[match answer.decided_by {
                DecidedBy::BoundingSpheres => 0,
                DecidedBy::Coherence => 1,
                _ => 2,
            }] += 1;
        }
    }
    counts
}

#[test]
fn verdicts_of_every_motion_are_right() {
    for mesh in bodies() {
        let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
        for orbit in ORBITS {
            for step in ["0.1", "5", "45", "random"] {
                fly(&shape, orbit, step);
            }
        }
    }
}

#[test]
fn bodies_that_stay_apart_seldom_need_more() {
    let large = ORBITS[1];
    // Near enough for the spheres to overlap, too far for thin bodies to meet often.
    let near = Orbit { name: "near", radius: 1.25 };
    let shapes: Vec<Shape> =
        bodies().iter().map(|mesh| Shape::from_mesh(mesh, &ShapeOptions::default()).unwrap()).collect();
    for (step, least) in [("0.1", 0.98), ("1", 0.95), ("10", 0.8)] {
        let (mut by_axes, mut rest) = (0, 0);
        for shape in &shapes {
            let [by_spheres, ..] = fly(shape, large, step);
            assert!(by_spheres > 3 * COUNT / 4, "{by_spheres} by spheres at {step} degrees");
            let [_, by_axis, others] = fly(shape, near, step);
            by_axes += by_axis;
            rest += others;
        }
        assert!(by_axes > 3 * COUNT, "{by_axes} at {step} degrees");
        assert!(by_axes as f64 >= least * (by_axes + rest) as f64, "{by_axes}, and {rest} not, at {step} degrees");
    }
}

/// The spheres alone: pairs about as far apart as the sum of the radii, and a tolerance about as large as what is left; for all
/// queries, from any pose, the answer is that of the query without.
#[test]
fn spheres_decide_where_they_may() {
    let shape = Shape::from_mesh(&ellipsoid([1.0, 0.7, 0.4], 302).unwrap(), &ShapeOptions::default()).unwrap();
    let radius = shape.polyhedron().radius;
    let mut random = Random::new(3);
    let mut counts = [0; 4];
    for round in 0..4_000 {
        let max_distance = [f64::INFINITY, 0.0, 0.3][round % 3];
        let beyond = if max_distance < f64::INFINITY { max_distance } else { 0.0 };
        let near = [0.0, 1e-15, 1e-12, 1e-2][random.below(4)] * random.uniform(-1.0, 1.0);
        let away = random.direction() * ((2.0 * radius + beyond) * (1.0 + near));
        let [pose1, pose2] = [Vector::zeros(), away].map(|t| Pose::new(&random.rotation(), &t));
        let config = PairConfig { max_distance, ..PairConfig::default() };
        let mut exact = PairAnswer::default();
        let ask = |query: Query, config: &PairConfig, answer: &mut PairAnswer| {
            query([shape.at(&pose1), shape.at(&pose2)], &mut PairCache::default(), config, answer).unwrap();
        };
        ask(distance, &PairConfig::default(), &mut exact);
        for (i, query) in [intersection as Query, distance, contact, approximate].into_iter().enumerate() {
            let mut answer = PairAnswer::default();
            ask(query, &config, &mut answer);
            verify([shape.at(&pose1), shape.at(&pose2)], &answer).unwrap();
            assert!(answer.lower <= exact.upper && exact.lower <= answer.upper, "{answer:?}\n{exact:?}");
            let is_beyond = answer.outcome == Outcome::Beyond;
            assert!(if is_beyond { answer.lower >= max_distance } else { answer.upper <= max_distance });
            counts[i] += usize::from(answer.decided_by == DecidedBy::BoundingSpheres);
        }
    }
    // Without a tolerance only the verdict is for the spheres.
    let [verdicts, distances, contacts, approximations] = counts;
    assert!(verdicts > 700 && verdicts < 1_300 && distances > 450, "{counts:?}");
    assert!(distances < verdicts && contacts == distances && approximations == distances, "{counts:?}");
}

/// The axis beside the features does no harm to queries that ask for more, and the other way round.
#[test]
fn verdicts_and_distances_take_turns() {
    let shape = Shape::from_mesh(&ellipsoid([1.0, 0.6, 0.3], 502).unwrap(), &ShapeOptions::default()).unwrap();
    let (mut cache, mut answer, mut steps) = (PairCache::default(), PairAnswer::default(), 0);
    let near = Orbit { name: "near", radius: 1.25 };
    for (number, pose) in poses(near, "0.1".parse().unwrap(), COUNT).iter().enumerate() {
        let [pose1, pose2] = [&pose[..12], &pose[12..]].map(|m| Pose::from_row_major(m.try_into().unwrap()));
        let query = if number % 2 == 0 { intersection } else { distance };
        query([shape.at(&pose1), shape.at(&pose2)], &mut cache, &PairConfig::default(), &mut answer).unwrap();
        verify([shape.at(&pose1), shape.at(&pose2)], &answer).unwrap();
        if number > 1 {
            assert_eq!(answer.decided_by == DecidedBy::Coherence, number % 2 == 0, "{number}");
            steps += answer.statistics.marching_steps;
        }
    }
    assert!(steps < 3 * COUNT as u32, "{steps}");
}
