//! The check of answers: right ones pass however odd the bodies, wrong ones do not.

use swiftprox::body::build::hull::convex_hull;
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

fn distance(a: &Shape, pose_a: &Pose, b: &Shape, pose_b: &Pose) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let mut cache = PairCache::default();
    pair::distance([a.at(pose_a), b.at(pose_b)], &mut cache, &PairConfig::default(), &mut answer).unwrap();
    answer
}

/// Four corners 1e-4 apart in one direction and less than 1e-15 in the others: planes through them miss corners by far more than
/// rounding.
#[test]
fn a_witness_point_on_a_sliver_is_in_its_body() {
    let plate = hull(&[
        Vector::new(0.133219564231972, 3.23015270312512e-10, 3.5073772010529396e-19),
        Vector::new(0.6358577205379135, 8.3300246309407e-10, -1.5915651801453824e-20),
        Vector::new(0.37173868327303317, 2.9035964723042463e-10, -9.258296667645484e-19),
        Vector::new(-0.7200739416610624, 4.283565955930167e-10, 3.1839484862437663e-19),
        Vector::new(0.5230955265302073, -4.884679880035127e-10, -1.348637730759519e-19),
        Vector::new(-0.41728007026542846, 3.9147327615491557e-10, -2.4046901046354586e-19),
        Vector::new(-0.2523141340892956, 2.5631509367280827e-10, -2.808707784060003e-19),
        Vector::new(-0.740169576830934, 1.8953385420669357e-10, 4.683968653475268e-19),
        Vector::new(-0.7403056164072654, 4.779047187009234e-10, -3.5219261942441296e-19),
    ]);
    let sliver = hull(&[
        Vector::new(1.241375334439475e-43, 9.767468106466141e-05, -1.0912525746740991e-36),
        Vector::new(-6.106915172227032e-16, -2.3592782236472713e-05, 3.3596481174385933e-65),
        Vector::new(1.6514598508405787e-81, 8.960716753888421e-30, -1.0493613615709189e-36),
        Vector::new(-2.644655076885476e-64, -4.7380002370609665e-50, 8.623243232131164e-38),
    ]);
    let (pose1, pose2) = (
        Pose {
            rows: [
                [6.123233995736766e-17, -1.0, 0.0, 1e+16],
                [1.0, 6.123233995736766e-17, 0.0, 0.0],
                [0.0, 0.0, 1.0, 0.0],
            ],
        },
        Pose {
            rows: [
                [1.0, 0.0, 0.0, 1e+16],
                [0.0, -0.7781788123400206, -0.6280427820022096, -0.586056510901311],
                [0.0, 0.6280427820022096, -0.7781788123400206, 0.2968600768254634],
            ],
        },
    );
    let answer = distance(&plate, &pose1, &sliver, &pose2);
    verify([plate.at(&pose1), sliver.at(&pose2)], &answer).unwrap();
}

#[test]
fn answers_for_bodies_of_subnormal_size_verify() {
    let least = f64::from_bits(1);
    let mut random = Random::new(2);
    for case in 0..300 {
        let mut coordinate = || least * (2000.0 * random.uniform(0.0, 1.0)).floor();
        let mut body = || hull(&(0..6).map(|_| Vector::from_fn(|_, _| coordinate())).collect::<Vec<_>>());
        let (a, b) = (body(), body());
        let away = at(least * (4000.0 * random.uniform(0.0, 1.0)).floor(), 0.0, 0.0);
        let answer = distance(&a, &at(0.0, 0.0, 0.0), &b, &away);
        let checked = verify([a.at(&at(0.0, 0.0, 0.0)), b.at(&away)], &answer);
        assert!(checked.is_ok(), "case {case}: {checked:?}, {answer:?}");
    }
}

/// Without witness points the gap along the normal still refutes an upper end below it.
#[test]
fn an_upper_end_below_the_gap_is_refuted() {
    let tetrahedron = hull(&[Vector::zeros(), Vector::x(), Vector::y(), Vector::z()]);
    let (here, there) = (at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0));
    let mut answer = PairAnswer::default();
    let mut cache = PairCache::default();
    let config = PairConfig::default();
    pair::intersection([tetrahedron.at(&here), tetrahedron.at(&there)], &mut cache, &config, &mut answer).unwrap();
    assert_eq!(answer.outcome, Outcome::Separated);
    verify([tetrahedron.at(&here), tetrahedron.at(&there)], &answer).unwrap();
    (answer.lower, answer.distance, answer.upper) = (0.5, 1.0, 1.5);
    let refused = verify([tetrahedron.at(&here), tetrahedron.at(&there)], &answer);
    assert!(matches!(&refused, Err(Error::Unverified(message)) if message.contains("1.5e0")), "{refused:?}");
}

/// An answer with one thing in it changed.
struct Forgery {
    what: &'static str,
    /// A part of the message that refuses it.
    refused: &'static str,
    change: fn(&mut PairAnswer),
}

const fn forgery(what: &'static str, refused: &'static str, change: fn(&mut PairAnswer)) -> Forgery {
    Forgery { what, refused, change }
}

/// Two cubes of side 2, the second of them 1 off in x; the nearest features are faces.
fn cubes() -> ([Shape; 2], [Pose; 2]) {
    let corners: Vec<Vector> = (0..8)
        .map(|i| Vector::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)).map(|x| 2.0 * x - 1.0))
        .collect();
    ([hull(&corners), hull(&corners)], [at(0.0, 0.0, 0.0), at(3.0, 0.5, 0.25)])
}

#[track_caller]
fn each_is_refused(forgeries: &[Forgery], shapes: &[Shape; 2], poses: &[Pose; 2], answer: &PairAnswer) {
    let check = |answer: &PairAnswer| verify([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], answer);
    check(answer).unwrap();
    for Forgery { what, refused, change } in forgeries {
        let mut forged = *answer;
        change(&mut forged);
        let checked = check(&forged);
        assert!(matches!(&checked, Err(Error::Unverified(m)) if m.contains(refused)), "{what}: {checked:?}");
    }
}

const NOWHERE: [f64; 3] = [f64::NAN; 3];

#[test]
fn whatever_a_separated_answer_says_is_checked() {
    let (shapes, poses) = cubes();
    let answer = distance(&shapes[0], &poses[0], &shapes[1], &poses[1]);
    assert_eq!((answer.outcome, answer.distance), (Outcome::Separated, 1.0));
    let forgeries = [
        forgery("a lower end above the distance", "lower", |a| a.lower = 1.5),
        forgery("an interval below the distance", "their distance", |a| {
            (a.lower, a.distance, a.upper) = (0.5, 0.5, 0.5)
        }),
        forgery("an interval above it", "their distance", |a| (a.lower, a.distance, a.upper) = (1.5, 1.5, 1.5)),
        forgery("a NaN", "lower", |a| a.upper = f64::NAN),
        forgery("a long normal", "unit", |a| a.normal[0] *= 1.0 + 1e-14),
        forgery("a normal of NaN", "unit", |a| a.normal = NOWHERE),
        forgery("a normal the wrong way", "apart, not", |a| a.normal[0] *= -1.0),
        forgery("a witness point out of its body", "out of its object", |a| (a.local1[0], a.world1[0]) = (1.1, 1.1)),
        forgery("one within it", "off Feature", |a| (a.local1[0], a.world1[0]) = (0.9, 0.9)),
        forgery("one elsewhere on the face", "the witness points are", |a| {
            (a.local1[1], a.world1[1]) = (-1.0, -1.0);
        }),
        forgery("a world point off its local one", "in the world", |a| a.world2[2] += 1e-13),
        forgery("no world point", "in the world", |a| a.world1 = NOWHERE),
        forgery("no local point", "witness point", |a| a.local2 = NOWHERE),
        forgery("no points, but features", "witness point", |a| {
            (a.local1, a.local2, a.world1, a.world2) = (NOWHERE, NOWHERE, NOWHERE, NOWHERE);
        }),
        forgery("no feature", "has no", |a| a.feature1 = Feature::default()),
        forgery("another face", "off Feature", |a| a.feature1.ids[0] = (a.feature1.ids[0] + 1) % 6),
        forgery("an unknown face", "has no", |a| a.feature2 = Feature { kind: FeatureKind::Face, ids: [6, 0] }),
        forgery("a vertex", "off Feature", |a| a.feature1 = Feature { kind: FeatureKind::Vertex, ids: [7, 0] }),
        forgery("an unknown vertex", "has no", |a| {
            a.feature1 = Feature { kind: FeatureKind::Vertex, ids: [8, 0] };
        }),
        forgery("an edge", "off Feature", |a| a.feature2 = Feature { kind: FeatureKind::Edge, ids: [1, 3] }),
        forgery("a diagonal", "has no", |a| a.feature2 = Feature { kind: FeatureKind::Edge, ids: [0, 3] }),
        forgery("a proof", "proof", |a| a.proof_count = 1),
    ];
    each_is_refused(&forgeries, &shapes, &poses, &answer);
}

#[test]
fn whatever_a_contact_says_is_checked() {
    let (shapes, poses) = cubes();
    let touching = [poses[0], at(2.0, 0.5, 0.25)];
    let mut answer = PairAnswer::default();
    let (mut cache, config) = (PairCache::default(), PairConfig::default());
    pair::contact([shapes[0].at(&touching[0]), shapes[1].at(&touching[1])], &mut cache, &config, &mut answer).unwrap();
    assert_eq!((answer.outcome, answer.feature1.kind), (Outcome::Intersecting, FeatureKind::Face));
    let forgeries = [
        forgery("a distance", "not 0", |a| a.upper = 1e-300),
        forgery("no proof", "proof", |a| a.proof_count = 0),
        forgery("half a proof", "hull", |a| a.proof = [a.proof[0]; 4]),
        forgery("a long normal", "unit", |a| a.normal[0] *= 1.0 + 1e-14),
        forgery("no normal", "unit", |a| a.normal = NOWHERE),
        forgery("a point out of its body", "out of its object", |a| (a.local1[0], a.world1[0]) = (1.1, 1.1)),
        forgery("another point than the other's", "apart", |a| (a.local1[0], a.world1[0]) = (0.9, 0.9)),
        forgery("a world point off its local one", "in the world", |a| a.world1[0] += 1e-13),
        forgery("no local point", "witness point", |a| a.local1 = NOWHERE),
        forgery("no feature", "has no", |a| a.feature2 = Feature::default()),
        forgery("an unknown face", "has no", |a| a.feature1.ids[0] = 6),
        forgery("an edge that is none", "has no", |a| {
            a.feature1 = Feature { kind: FeatureKind::Edge, ids: [0, 7] };
        }),
    ];
    each_is_refused(&forgeries, &shapes, &touching, &answer);
}

/// Bodies without interior have features of their own: a segment's only edge, the vertex of a point.
#[test]
fn features_of_points_and_segments_are_checked() {
    let shapes = [hull(&[Vector::zeros()]), hull(&[Vector::new(1.0, -1.0, 0.0), Vector::new(1.0, 1.0, 0.0)])];
    let poses = [at(0.0, 0.0, 0.0), at(0.0, 0.25, 0.0)];
    let answer = distance(&shapes[0], &poses[0], &shapes[1], &poses[1]);
    assert_eq!([answer.feature1.kind, answer.feature2.kind], [FeatureKind::Vertex, FeatureKind::Edge]);
    let forgeries = [
        forgery("another vertex", "has no", |a| a.feature1.ids[0] = 1),
        forgery("an edge from nowhere", "has no", |a| a.feature2.ids[0] = 2),
        forgery("an end", "off Feature", |a| a.feature2 = Feature { kind: FeatureKind::Vertex, ids: [1, 0] }),
        forgery("a face", "has no", |a| a.feature2.kind = FeatureKind::Face),
        forgery("a point beyond the end", "out of its object", |a| (a.local2[1], a.world2[1]) = (1.5, 1.75)),
    ];
    each_is_refused(&forgeries, &shapes, &poses, &answer);
}

/// Lengths of such bodies fit doubles, their sums do not. Found by fuzzing: the witness point lay NaN out of its body.
#[test]
fn what_doubles_cannot_check_is_said() {
    let far = Vector::new(4e-16, -1.668390324278999e308, -5.366706752131341e307);
    let line = hull(&[far, -far]);
    let cube =
        hull(&[0.0, 1.0].map(|x| [0.0, 1.0].map(|y| [0.0, 1.0].map(|z| Vector::new(x, y, z)))).concat().concat());
    let (pose1, pose2) = (at(0.0, 0.0, 0.0), at(4.0, 0.5, 0.5));
    let answer = distance(&line, &pose1, &cube, &pose2);
    assert_eq!(answer.outcome, Outcome::Separated);
    // The line passes the edge from (4, 1.5, 0.5) to (4, 1.5, 1.5).
    assert!(answer.lower > 4.0 && answer.upper < 4.0001, "{answer:?}");
    assert!(
        matches!(verify([line.at(&pose1), cube.at(&pose2)], &answer), Err(Error::Argument(m)) if m.contains("too large"))
    );
}

/// Doubles cannot tell a touch from a gap of 1e-17.
#[test]
fn bodies_that_touch_are_not_said_to_be_apart() {
    let cube = cuboid([0.5; 3]);
    let here = at(0.0, 0.0, 0.0);
    let apart = distance(&cube, &at(1.0 + f64::EPSILON, 0.0, 0.0), &cube, &here);
    assert_eq!(apart.outcome, Outcome::Separated);
    verify([cube.at(&at(1.0 + f64::EPSILON, 0.0, 0.0)), cube.at(&here)], &apart).unwrap();
    let touching = at(1.0, 0.0, 0.0);
    let mut forged = PairAnswer { lower: 1e-17, distance: 1e-17, upper: 1e-15, ..apart };
    (forged.local1, forged.world1) = ([-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
    (forged.local2, forged.world2) = ([0.5, 0.0, 0.0], [0.5, 0.0, 0.0]);
    let refused = verify([cube.at(&touching), cube.at(&here)], &forged);
    assert!(matches!(&refused, Err(Error::Unverified(m)) if m.contains("intersect")), "{refused:?}");
    // Nor is a true gap said to be another one.
    let forged = PairAnswer { lower: 1e-17, distance: 1e-17, upper: 1e-16, ..apart };
    let refused = verify([cube.at(&at(1.0 + f64::EPSILON, 0.0, 0.0)), cube.at(&here)], &forged);
    assert!(matches!(&refused, Err(Error::Unverified(m)) if m.contains("their distance")), "{refused:?}");
}

/// Needles as meshes of their own hull's triangles, all slivers that rounding makes. Causes: products of lengths beyond 1e154 were
/// no doubles, and a sliver's sides said that it holds any point of its line; so another polygon was named than the one at the
/// witness point, and `verify` refused it. Noise is from 0 to 1000 roundings of the length.
#[test]
fn the_polygon_named_on_a_needle_is_at_the_witness_point() {
    let mut random = Random::new(5);
    let mut seen = [0; 4];
    for round in 0..4_000 {
        let along = if round % 3 == 0 { random.direction() } else { Vector::new(0.4366, 0.8732, -0.2183) };
        let size = [1e111, 1e30, 1e16, 1e217][round % 4];
        let noise = random.pick(&[0.0, 1e-16, 1e-15, 1e-13]);
        let count = 4 + random.below(5);
        let places: Vec<f64> = (0..count).map(|k| if k == 0 { 1e-20 } else { random.uniform(-2.0, 1.0) }).collect();
        let points: Vec<Vector> =
            places.iter().map(|t| along * (t * size) + random.direction() * (noise * size)).collect();
        let Some(mesh) = mesh_of_hull(&points) else { continue };
        let input =
            random.pick(&[InputPolicy::Strict, InputPolicy::Hull, InputPolicy::Flat, InputPolicy::NearlyConvex]);
        let Ok(needle) = Shape::from_mesh(&mesh, &ShapeOptions { input, ..ShapeOptions::default() }) else { continue };
        let other = hull(&(0..7).map(|_| random.vector()).collect::<Vec<_>>());
        let mut pose = || Pose::new(&random.quarter_turns(), &(random.vector() * 30.0));
        let poses = [pose(), pose()];
        seen[round % 4] += 1;
        let answer = distance(&needle, &poses[0], &other, &poses[1]);
        verify([needle.at(&poses[0]), other.at(&poses[1])], &answer)
            .unwrap_or_else(|error| panic!("{error}: {answer:?} {points:?}"));
    }
    assert!(seen.iter().all(|&count| count > 500), "{seen:?}");
}

/// The triangles of a solid hull.
fn mesh_of_hull(points: &[Vector]) -> Option<PolygonMesh> {
    let hull = convex_hull(points).unwrap();
    if hull.dimension < 3 {
        return None;
    }
    let vertices = hull.vertices.iter().map(|&v| points[v as usize]).collect();
    let place = |v: &u32| hull.vertices.binary_search(v).unwrap() as u32;
    Some(PolygonMesh::new(vertices, hull.triangles.iter().flatten().map(place).collect(), None).unwrap())
}
