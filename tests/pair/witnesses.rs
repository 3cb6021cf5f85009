//! Small pairs, each about one promise: which feature holds a witness point, that a contact's point is common to both, answers
//! about the smallest bodies.

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::contact;
use swiftprox::pair::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::shapes::at;

use testkit::models::{ellipsoid, random_hull};
use testkit::random::Random;

const OPTIONS: fn() -> ShapeOptions = || ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };

fn hull(points: &[[f64; 3]]) -> Shape {
    let points: Vec<Vector> = points.iter().map(|&p| p.into()).collect();
    Shape::from_points(&points, &OPTIONS()).unwrap()
}

/// The answer to [`distance`] from a cold cache.
fn ask(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let config = PairConfig::default();
    distance([shape1.at(pose1), shape2.at(pose2)], &mut PairCache::default(), &config, &mut answer).unwrap();
    answer
}

/// Differences of vertices, and terms of a pose that cancel, are beyond the doubles; the witness points are not.
#[test]
fn witness_points_of_the_largest_bodies_are_finite() {
    let corner = |k: usize| [7e182, f64::MAX, 2.875].map(|half| half * if k & 1 == 0 { -1.0 } else { 1.0 });
    let corners: Vec<[f64; 3]> = (0..8)
        .map(|k| {
            let [x, y, z] = [corner(k), corner(k >> 1), corner(k >> 2)];
            [x[0], y[1], z[2]]
        })
        .collect();
    let small = hull(&[[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    let turn = |y: f64| Pose { rows: [[0.0, -1.0, 0.0, 1.0], [0.0, 0.0, 1.0, y], [-1.0, 0.0, 0.0, f64::MAX]] };
    let mut beside = turn(f64::MAX);
    beside.rows[0][3] = f64::MAX;
    let answer = ask(&hull(&corners), &beside, &small, &turn(1.797_693_134_862_310_3e308));
    assert_eq!(answer.outcome, Outcome::Separated);
    let points = [answer.local1, answer.local2, answer.world1, answer.world2];
    assert!(points.as_flattened().iter().all(|x| x.is_finite()), "{answer:?}");
}

/// Vertices are farther apart than any double; directions between them are looked at all the same.
#[test]
fn contacts_of_the_largest_bodies_end() {
    let cube = |half: f64| {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { half } else { -half });
        hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner))
    };
    let (largest, small) = (cube(1.7e308), cube(1.0));
    for other in [&largest, &small] {
        let mut answer = PairAnswer::default();
        let (pose, config) = (&Pose::IDENTITY, PairConfig::default());
        contact([largest.at(pose), other.at(pose)], &mut PairCache::default(), &config, &mut answer).unwrap();
        assert_eq!(answer.outcome, Outcome::Intersecting);
        assert!(answer.normal.iter().all(|x| x.is_finite()), "{answer:?}");
    }
}

/// Two triangles make each side of this cube: either is found as such, by marching and by the fallback.
#[test]
fn the_face_is_the_callers_triangle_that_holds_the_point() {
    let corner = |k: usize| Vector::from_fn(|axis, _| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let top = [4, 5, 7, 4, 7, 6];
    let others = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1];
    let mesh = PolygonMesh::new((0..8).map(corner).collect(), [&top[..], &others].concat(), None).unwrap();
    let cube = Shape::from_mesh(&mesh, &ShapeOptions::default()).unwrap();
    let point = hull(&[[0.0; 3]]);
    let spike = hull(&[[0.0; 3], [1.0, 0.0, 4.0], [-1.0, 1.0, 4.0], [-1.0, -1.0, 4.0]]);
    for above in [point, spike] {
        for (x, y, triangle) in [(0.5, -0.25, 0), (-0.5, 0.25, 1)] {
            let answer = ask(&cube, &Pose::IDENTITY, &above, &at(x, y, 2.0));
            assert_eq!(answer.local1, [x, y, 1.0]);
            assert_eq!(answer.feature1, Feature { kind: FeatureKind::Face, ids: [triangle, 0] }, "{answer:?}");
        }
    }
}

/// A segment has no faces, so only the fallback answers for it.
#[test]
fn a_point_inside_a_segment_is_on_its_edge() {
    let segment = hull(&[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let answer = ask(&segment, &Pose::IDENTITY, &hull(&[[0.0; 3]]), &at(0.25, 0.0, 1.0));
    assert_eq!(answer.local1, [0.25, 0.0, 0.0]);
    assert_eq!(answer.feature1, Feature { kind: FeatureKind::Edge, ids: [0, 1] }, "{answer:?}");
}

/// A square with a tip a billionth above its middle: in double precision the normals of its four upper faces are as near to
/// upward as one another, yet one face holds the point.
#[test]
fn of_nearly_coplanar_faces_the_one_that_holds_the_point() {
    let square = [[1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]];
    let plate = hull(&[square[0], square[1], square[2], square[3], [0.0, 0.0, 1e-9]]);
    let polyhedron = plate.polyhedron();
    for (x, y, side) in [(0.5, 0.1, [3, 0]), (0.1, 0.5, [0, 1]), (-0.5, 0.1, [1, 2]), (0.1, -0.5, [2, 3])] {
        let answer = ask(&plate, &Pose::IDENTITY, &hull(&[[0.0; 3]]), &at(x, y, 1.0));
        let Feature { kind: FeatureKind::Face, ids: [face, _] } = answer.feature1 else { panic!("{answer:?}") };
        let on_face = |v: u32| {
            let of = |&e: &u32| [polyhedron.edges[e as usize].tail(), polyhedron.edges[e as usize].head()];
            let record = &polyhedron.faces[face as usize];
            let sides = &polyhedron.sides[record.first_side as usize..][..record.side_count as usize];
            sides.iter().flat_map(of).any(|w| polyhedron.vertex_labels[w as usize] == v)
        };
        assert!(on_face(4) && side.into_iter().all(on_face), "at {x}, {y}: {answer:?}");
    }
}

/// Long segments through a cube: the weights of the tetrahedron that proves the contact are small differences.
#[test]
fn the_point_of_a_contact_is_common() {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let cube = hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner));
    for exponent in 0..=8 {
        let length = 10f64.powi(exponent);
        for tilt in [0.1, 0.3, 0.7] {
            let end = Vector::new(0.6 - tilt, 0.3 + tilt, 0.8 * tilt + 0.1) * length;
            let segment = hull(&[(end * 1.1).into(), (-end * 0.7).into()]);
            let pose = at(0.3, -0.2, 0.4);
            let mut answer = PairAnswer::default();
            let (cache, config) = (&mut PairCache::default(), PairConfig::default());
            contact([segment.at(&pose), cube.at(&Pose::IDENTITY)], cache, &config, &mut answer).unwrap();
            assert_eq!(answer.outcome, Outcome::Intersecting);
            let apart = (Vector::from(answer.world1) - Vector::from(answer.world2)).norm();
            // As wide as the widest interval of a hard pair.
            assert!(apart <= 1e-13 * (2.0 * length + 4.0), "length {length:e}: {apart:e} apart, {answer:?}");
        }
    }
}

/// A body at the origin keeps the digits of its witness point however far away the other one is.
#[test]
fn a_witness_point_is_as_accurate_as_its_own_body_allows() {
    let mut random = Random::new(1);
    for exponent in 0..=12 {
        for seed in 0..40 {
            let shape = Shape::from_mesh(&random_hull(20, seed).unwrap(), &OPTIONS()).unwrap();
            let near = Pose::new(&random.rotation(), &Vector::zeros());
            let far = Pose::new(&random.rotation(), &(4.0 * 10f64.powi(exponent) * random.direction()));
            for [pose1, pose2] in [[near, far], [far, near]] {
                let answer = ask(&shape, &pose1, &shape, &pose2);
                let points = [(pose1, answer.local1, answer.world1), (pose2, answer.local2, answer.world2)];
                for (pose, local, world) in points {
                    let error = (Vector::from(world) - pose.transform(&Vector::from(local))).norm();
                    // A dozen roundings of numbers up to the body's size, and of its place.
                    let allowed = 16.0 * f64::EPSILON / 2.0 * (1.0 + pose.translation().norm());
                    assert!(error <= allowed, "1e{exponent}: {error:e} off, {answer:?}");
                }
            }
        }
    }
}

/// Squares of these coordinates underflow or overflow.
#[test]
fn answers_at_the_ends_of_the_range_verify() {
    let point = hull(&[[0.0; 3]]);
    for size in [1e-300, 1e-241, 1e-162, 1e162, 1e300] {
        let pose = at(0.0, size, 0.0);
        let answer = ask(&point, &pose, &point, &Pose::IDENTITY);
        assert!(answer.lower <= size && size <= answer.upper && answer.outcome == Outcome::Separated);
        assert_eq!(verify([point.at(&pose), point.at(&Pose::IDENTITY)], &answer), Ok(()), "{size:e}: {answer:?}");
    }
}

/// A matrix entry of 2⁻¹⁰⁰⁰ takes y = 2⁻⁵⁰⁰ to x = 2⁻¹⁵⁰⁰: apart, though by less than any double.
#[test]
fn apart_by_less_than_any_double_is_not_intersecting() {
    let tiny = hull(&[[0.0, 2f64.powi(-500), 0.0]]);
    let mut skewed = Pose::IDENTITY;
    skewed.rows[0][1] = 2f64.powi(-1000);
    let answer = ask(&tiny, &skewed, &tiny, &Pose::IDENTITY);
    assert_eq!((answer.outcome, answer.decided_by), (Outcome::Separated, DecidedBy::Integers), "{answer:?}");
}

/// Bars 10¹⁴ times as long as they are thick, crossing: each round that refines the weights of the enclosing tetrahedron gains
/// but two digits. Found by fuzzing.
#[test]
fn crossing_bars_of_extreme_length_have_one_common_point() {
    let far = [-1_970_324_836_974_585.0, 1_970_324_836_974_599.0];
    let corners: Vec<[f64; 3]> =
        (0..8).map(|k| [[3.0, -25.0][k & 1], far[k >> 2], [17.625, -10.375][k >> 1 & 1]]).collect();
    let bar = hull(&corners);
    let pose1 = Pose {
        rows: [
            [1.0, 1.0269562977782692e-15, 1.0963452368173427e-15, 9.0],
            [-1.0269562977782704e-15, 1.0, 1.0547118733938981e-15, 8.999999999999977],
            [0.0019531249999989037, -1.0547118733938993e-15, 1.0, -26.0],
        ],
    };
    let pose2 = Pose {
        rows: [
            [0.31701631701631716, 0.8298368298368298, -0.4592074592074592, 0.0],
            [-0.9137529137529138, 0.1375291375291377, -0.38228438225527844, -31.0],
            [-0.254079254079254, 0.5407925407925408, 0.801864801864802, -13.0],
        ],
    };
    let mut answer = PairAnswer::default();
    contact([bar.at(&pose1), bar.at(&pose2)], &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
    assert_eq!(answer.outcome, Outcome::Intersecting);
    verify([bar.at(&pose1), bar.at(&pose2)], &answer).unwrap();
}

/// Marching measures in the bodies' frames with transposed matrices; what it finds is put right where these are not the
/// inverse, so that matrices off by 1e-4 need the fallback hardly more often than orthonormal ones.
#[test]
fn matrices_off_orthonormal_are_marched() {
    let mut random = Random::new(5);
    let shapes: Vec<Shape> =
        (0..8).map(|seed| Shape::from_mesh(&random_hull(30, seed).unwrap(), &OPTIONS()).unwrap()).collect();
    for exponent in [-3, -4, -6, -8, -10, -12] {
        let mut spoilt = || random.rotation().map(|x| x + 10f64.powi(exponent) * random.uniform(-1.0, 1.0));
        let poses: Vec<[Pose; 2]> = (0..200)
            .map(|_| [Pose::new(&spoilt(), &Vector::zeros()), Pose::new(&spoilt(), &Vector::new(0.0, 2.5, 0.3))])
            .collect();
        let mut marched = 0;
        for (k, [pose1, pose2]) in poses.iter().enumerate() {
            let [shape1, shape2] = [&shapes[k % 8], &shapes[k / 8 % 8]];
            let answer = ask(shape1, pose1, shape2, pose2);
            verify([shape1.at(pose1), shape2.at(pose2)], &answer).unwrap();
            assert!(answer.upper - answer.lower <= 2e-14 * answer.upper.max(2.0));
            marched += usize::from(answer.decided_by == DecidedBy::Marching);
        }
        println!("1e{exponent}: {marched} of 200");
        assert!(marched >= if exponent == -3 { 150 } else { 195 }, "1e{exponent}: {marched} of 200");
    }
}

/// Features of bodies deep in each other are those where they overlap least: a vertex and a face, or two edges.
#[test]
fn features_of_a_deep_contact_look_along_the_normal() {
    let body = Shape::from_mesh(&ellipsoid([1.0, 0.8, 0.6], 400).unwrap(), &OPTIONS()).unwrap();
    let mut random = Random::new(0xdee9);
    let mut faces = 0;
    for _ in 0..500 {
        let away = random.direction() * random.uniform(0.2, 1.0);
        let [pose1, pose2] = [Vector::zeros(), away].map(|t| Pose::new(&random.rotation(), &t));
        let mut answer = PairAnswer::default();
        let config = PairConfig::default();
        contact([body.at(&pose1), body.at(&pose2)], &mut PairCache::default(), &config, &mut answer).unwrap();
        assert_eq!(answer.outcome, Outcome::Intersecting);
        let normal = Vector::from(answer.normal);
        let kinds = [answer.feature1.kind, answer.feature2.kind];
        let vertex_face = [FeatureKind::Vertex, FeatureKind::Face];
        assert!(
            kinds == vertex_face || [kinds[1], kinds[0]] == vertex_face || kinds == [FeatureKind::Edge; 2],
            "{kinds:?}"
        );
        for (feature, outward) in
            [(answer.feature1, pose1.rotate_back(&-normal)), (answer.feature2, pose2.rotate_back(&normal))]
        {
            if feature.kind == FeatureKind::Face {
                let polyhedron = body.polyhedron();
                let face = polyhedron.faces.iter().position(|face| face.label == feature.ids[0]).unwrap();
                let slope = polyhedron.faces[face].normal.dot(&outward);
                assert!(slope > 1.0 - 1e-12, "{slope}: {answer:?}");
                faces += 1;
            }
        }
    }
    assert!(faces > 150, "{faces}");
}

/// Boxes overlap least along a face normal or a cross product of edges; the normal of a contact is as good.
#[test]
fn normals_of_contacts_overlap_little() {
    let cube = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let cube = hull(&[0, 1, 2, 3, 4, 5, 6, 7].map(cube));
    let mut random = Random::new(0xc0be5);
    let (mut contacts, mut worst) = (0, 1.0_f64);
    for _ in 0..4_000 {
        let [pose1, pose2] = [Vector::zeros(), random.vector() * 2.0].map(|t| Pose::new(&random.rotation(), &t));
        let mut answer = PairAnswer::default();
        let config = PairConfig::default();
        contact([cube.at(&pose1), cube.at(&pose2)], &mut PairCache::default(), &config, &mut answer).unwrap();
        if answer.outcome != Outcome::Intersecting {
            continue;
        }
        let [rotation1, rotation2] = [pose1.rotation(), pose2.rotation()];
        let between = pose2.translation() - pose1.translation();
        let overlap = |n: &Vector| {
            (rotation1.transpose() * n).lp_norm(1) + (rotation2.transpose() * n).lp_norm(1) + n.dot(&between)
        };
        let mut axes: Vec<Vector> = Vec::new();
        for i in 0..3 {
            axes.extend([rotation1.column(i).into_owned(), rotation2.column(i).into_owned()]);
            axes.extend((0..3).filter_map(|j| rotation1.column(i).cross(&rotation2.column(j)).try_normalize(1e-9)));
        }
        let least = axes.iter().flat_map(|n| [overlap(n), overlap(&-n)]).fold(f64::INFINITY, f64::min);
        worst = worst.max(overlap(&answer.normal.into()) / least);
        contacts += 1;
    }
    println!("{contacts} contacts, {worst} times the least overlap at worst");
    assert!(contacts > 3_000 && worst < 1.0 + 1e-10, "{worst}");
}
