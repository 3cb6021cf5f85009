//! Distances and verdicts, against all triangles in rational numbers.

use super::hills;
use swiftprox::error::Error;
use swiftprox::ground::{Ground, HeightGrid, ground_distance};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, Query};
use swiftprox::shape::Shape;
use testkit::oracle::{Polytope, Truth, truth};
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

fn rows(pose: &Pose) -> [f64; 12] {
    std::array::from_fn(|k| pose.rows[k / 4][k % 4])
}

/// Of each triangle the truth.
fn of_all(cloud: &[Vector], pose: &Pose, vertices: &[Vector], triangles: &[[u32; 3]], place: &Pose) -> Vec<Truth> {
    let body = Polytope::new(&cloud.iter().map(|p| (*p).into()).collect::<Vec<_>>());
    let of = |corners: &[u32; 3]| {
        let triangle = Polytope::new(&corners.map(|v| vertices[v as usize].into()));
        truth(&body, &rows(pose), &triangle, &rows(place))
    };
    triangles.iter().map(of).collect()
}

/// Hulls near hills and soups, grounds turned and moved, rotations that are skewed: the interval holds the least distance, the
/// verdict is right, the triangle that is named has that distance.
#[test]
fn intervals_hold_the_least_over_all_triangles() {
    let mut random = Random::new(0x6e0);
    let mut seen = [0; 3];
    for round in 0..60 {
        let (mut vertices, mut triangles) = hills(&mut random, 4, 0.5);
        if round % 3 == 0 {
            vertices = (0..12).map(|_| random.vector() * 2.0).collect();
            triangles = (0..12).map(|_| std::array::from_fn(|_| random.below(12) as u32)).collect();
        }
        let Ok(ground) = Ground::from_triangles(&vertices, &triangles) else { continue };
        let cloud: Vec<Vector> = (0..6).map(|_| random.vector() * 0.5).collect();
        let shape = hull(&cloud);
        let skewed = Matrix::identity() + Matrix::from_diagonal(&(random.vector() * 1e-3));
        let place = match round % 4 {
            0 => Pose::IDENTITY,
            1 => Pose::new(&(random.rotation() * skewed), &random.vector()),
            _ => Pose::new(&random.rotation(), &(random.vector() * 1e3)),
        };
        let near = place.transform(&Vector::new(random.uniform(0.0, 3.0), random.uniform(0.0, 3.0), random.signed()));
        let pose = Pose::new(&random.rotation(), &near);
        let has_area = |corners: &[u32; 3]| {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            (b - a).cross(&(c - a)) != Vector::zeros()
        };
        let truths = of_all(&cloud, &pose, &vertices, &triangles, &place);
        let counted = || truths.iter().zip(&triangles).filter(|(_, corners)| has_area(corners)).map(|(truth, _)| truth);
        let least = counted().min_by(|a, b| a.squared_distance.cmp(&b.squared_distance)).unwrap();

        let ask =
            |query, config: &PairConfig| ground_distance(query, shape.at(&pose), ground.at(&place), config).unwrap();
        let found = ask(Query::Distance, &PairConfig::default());
        let answer = &found.answer;
        assert!(least.lies_between(answer.lower, answer.upper), "{round}: {answer:?}");
        assert_eq!(answer.outcome == Outcome::Intersecting, least.intersecting());
        let named = &truths[found.triangle as usize];
        assert!(named.lies_between(answer.lower, answer.upper));
        let verdict = ask(Query::Intersection, &PairConfig::default()).answer;
        assert_eq!(verdict.outcome, answer.outcome);
        assert!(least.lies_between(verdict.lower, verdict.upper) && (verdict.lower > 0.0) != least.intersecting());
        seen[usize::from(least.intersecting())] += 1;
        if answer.outcome == Outcome::Separated {
            assert!(answer.upper - answer.lower <= 1e-12 * (1.0 + near.norm()));
            let known = |v: u32| triangles[found.triangle as usize].contains(&v);
            match answer.feature2.kind {
                FeatureKind::Face => assert_eq!(answer.feature2.ids[0], found.triangle),
                FeatureKind::Edge => assert!(answer.feature2.ids.into_iter().all(known)),
                FeatureKind::Vertex => assert!(known(answer.feature2.ids[0])),
                FeatureKind::None => panic!("{answer:?}"),
            }
            for query in [Query::Distance, Query::Intersection] {
                let below = ask(query, &PairConfig { max_distance: 0.5 * answer.lower, ..PairConfig::default() });
                assert_eq!(below.answer.outcome, Outcome::Beyond);
                assert!(
                    least.lies_between(below.answer.lower, f64::INFINITY) && below.answer.lower >= 0.5 * answer.lower
                );
                let above = ask(query, &PairConfig { max_distance: 2.0 * answer.upper, ..PairConfig::default() });
                assert_eq!(above.answer.outcome, Outcome::Separated);
                seen[2] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
}

#[test]
fn what_is_asked_is_checked() {
    let ground = super::level(2, 2, 1.0);
    let (cube, here) = (cuboid([1.0; 3]), at(9.0, 9.0, 9.0));
    let skewed = Pose::new(&Matrix::from_diagonal_element(1.1), &Vector::zeros());
    let ask = |query, pose, place, config: &PairConfig| ground_distance(query, cube.at(pose), ground.at(place), config);
    let config = PairConfig::default();
    assert!(matches!(ask(Query::Contact, &here, &here, &config), Err(Error::Argument(_))));
    assert!(matches!(ask(Query::Distance, &skewed, &here, &config), Err(Error::Pose(_))));
    assert!(matches!(ask(Query::Distance, &here, &skewed, &config), Err(Error::Pose(_))));
    let refused = PairConfig { max_distance: -1.0, ..config };
    assert!(matches!(ask(Query::Distance, &here, &here, &refused), Err(Error::Argument(_))));
}

/// A body so far away that the distance is no double. Cause: a triangle was taken for the nearest where its upper end was less than
/// the one before, which is infinite at first; so no triangle was named.
#[test]
fn a_distance_beyond_the_doubles_names_its_triangle() {
    let corners = [[0.5, -0.3, -0.8], [0.6, 0.8, -0.2], [-0.9, -0.2, -0.5]].map(Vector::from);
    let ground = Ground::from_triangles(&corners, &[[0, 1, 2]]).unwrap();
    let point = hull(&[Vector::new(-32.0, -23.0, f64::MAX)]);
    let stretched = |by: f64| Pose { rows: [[by, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, by, 0.0]] };
    let place = stretched(1.00390625);
    let found = ground_distance(Query::Distance, point.at(&place), ground.at(&Pose::IDENTITY), &PairConfig::default());
    let found = found.unwrap();
    assert_eq!((found.answer.outcome, found.triangle), (Outcome::Separated, 0), "{found:?}");
    assert!(found.answer.lower > 1e308 && found.answer.upper == f64::INFINITY, "{found:?}");
}

/// From far above, all triangles of a ground are about as far: few are asked about. Asking all takes 300 times as long as a
/// look at all heights.
#[test]
fn few_triangles_are_asked_about_from_far_away() {
    let side = 500;
    let mut random = Random::new(0xfa4);
    for rough in [0.0, 1.0] {
        let height = |i: usize, j: usize| rough * (2.0 * (0.05 * i as f64).sin() + (0.07 * j as f64).cos());
        let heights: Vec<f64> = (0..side * side).map(|k| height(k / side, k % side)).collect();
        let grid = HeightGrid { rows: side, columns: side, spacing: [0.5; 2], heights: &heights };
        let ground = Ground::from_heights(&grid).unwrap();
        let body = cuboid([0.5; 3]);
        for above in [50.0, 500.0, 5000.0] {
            let pose = Pose::new(&random.rotation(), &Vector::new(120.0, 125.0, above));
            let least = |mut work: Box<dyn FnMut() + '_>| {
                let times = (0..5).map(|_| {
                    let begin = std::time::Instant::now();
                    work();
                    begin.elapsed()
                });
                times.min().unwrap()
            };
            let mut distance = 0.0;
            let asked = least(Box::new(|| {
                let (config, place) = (PairConfig::default(), Pose::IDENTITY);
                let found = ground_distance(Query::Distance, body.at(&pose), ground.at(&place), &config).unwrap();
                distance = found.answer.distance;
            }));
            let mut nearest = f64::INFINITY;
            let scanned = least(Box::new(|| {
                for (k, height) in heights.iter().enumerate() {
                    let place = Vector::new((k % side) as f64 * 0.5, (k / side) as f64 * 0.5, *height);
                    nearest = nearest.min((pose.translation() - place).norm());
                }
            }));
            assert!(nearest - 1.5 < distance && distance < nearest, "{above}: {distance} {nearest}");
            assert!(asked < 20 * scanned, "{above}: {asked:?}, all heights {scanned:?}");
        }
    }
}

/// Squares of lengths from 1.3·10¹⁵⁴ on are no doubles: the bound of a verdict was infinite, though the distance was not.
#[test]
fn the_bound_of_a_verdict_is_finite_where_squares_are_not() {
    let vertices = [[0.0, 0.0, 29.0], [1.0, 0.0, 0.0], [1.0, 29.0, 29.0]].map(Vector::from);
    let ground = Ground::from_triangles(&vertices, &[[0, 1, 2]]).unwrap();
    for size in [7e162, 1.6e268, 1.2e308] {
        let cloud = [Vector::new(size, 0.5 * size, -32.0)];
        let body = hull(&cloud);
        let pose = Pose::new(&Matrix::identity(), &Vector::new(size / 3.0, 0.0, 0.0));
        let truths = of_all(&cloud, &pose, &vertices, &[[0, 1, 2]], &Pose::IDENTITY);
        for query in [Query::Intersection, Query::Distance] {
            let config = PairConfig::default();
            let found = ground_distance(query, body.at(&pose), ground.at(&Pose::IDENTITY), &config).unwrap();
            let PairAnswer { outcome, lower, upper, .. } = found.answer;
            assert_eq!(outcome, Outcome::Separated);
            assert!(lower.is_finite() && truths[0].lies_between(lower, upper), "{query:?} {size:e}: {found:?}");
        }
    }
}

/// Cylinders, cones and ellipsoids: the least of what pairs say of each triangle, undecided where the deviation hides the verdict.
#[test]
fn curved_bodies_are_as_far_as_pairs_say() {
    let mut random = Random::new(0xc0de);
    let shapes = [
        Shape::from_cylinder(0.4, 0.5, 1e-2).unwrap(),
        Shape::from_cone(0.4, 0.5, 1e-2).unwrap(),
        Shape::from_ellipsoid(&Vector::new(0.5, 0.3, 0.4), 1e-2).unwrap(),
    ];
    let mut seen = [0; 3];
    for round in 0..150 {
        let (vertices, triangles) = hills(&mut random, 4, 1.0);
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        let place = Pose::new(&random.rotation(), &random.vector());
        let shape = &shapes[round % 3];
        let from = place.transform(&(Vector::new(1.5, 1.5, 0.0) + random.vector() * 1.5));
        let mut pose = Pose::new(&random.rotation(), &from);
        for again in 0..2 {
            let config = PairConfig::default();
            let (mut least, mut outcome) = ([f64::INFINITY; 2], Outcome::Separated);
            for corners in &triangles {
                let triangle = hull(&corners.map(|v| vertices[v as usize]));
                let mut answer = PairAnswer::default();
                let bodies = [shape.at(&pose), triangle.at(&place)];
                pair::distance(bodies, &mut PairCache::default(), &config, &mut answer).unwrap();
                least = [least[0].min(answer.lower), least[1].min(answer.upper)];
                outcome = match (outcome, answer.outcome) {
                    (Outcome::Intersecting, _) | (_, Outcome::Intersecting) => Outcome::Intersecting,
                    (Outcome::Undecided, _) | (_, Outcome::Undecided) => Outcome::Undecided,
                    _ => Outcome::Separated,
                };
            }
            let found = ground_distance(Query::Distance, shape.at(&pose), ground.at(&place), &config).unwrap();
            let PairAnswer { lower, upper, .. } = found.answer;
            assert_eq!(found.answer.outcome, outcome, "{found:?}");
            assert!((lower - least[0]).abs() < 1e-12 && (upper - least[1]).abs() < 1e-12, "{found:?} {least:?}");
            let verdict = ground_distance(Query::Intersection, shape.at(&pose), ground.at(&place), &config).unwrap();
            assert_eq!(verdict.answer.outcome, outcome, "{verdict:?}");
            assert!(outcome == Outcome::Separated || (verdict.triangle as usize) < triangles.len());
            seen[match outcome {
                Outcome::Separated => 0,
                Outcome::Undecided => 1,
                _ => 2,
            }] += 1;
            if again == 0 && outcome == Outcome::Separated {
                // To where the polyhedron is half the deviation away.
                let way = Vector::from(found.answer.normal) * (upper - 0.5 * shape.deviation());
                pose = Pose::new(&pose.rotation(), &(pose.translation() - way));
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 30), "{seen:?}");
}
