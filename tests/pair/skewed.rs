//! Witness points at poses that stretch, shrink and shear. The shortest connection is one, whichever features hold its ends, and
//! it is known in rational numbers.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{Feature, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::shape::Shape;
use swiftprox::verify::verify;
use testkit::cases::{coordinates, row_major};
use testkit::certificate::proved_by;
use testkit::random::Random;
use testkit::shapes::hull;

/// A rotation off by up to `off` in every entry, along axes, or evenly.
fn skewed(random: &mut Random, off: f64) -> Matrix {
    let turn = random.rotation();
    match random.below(3) {
        0 => turn + Matrix::from_fn(|_, _| off * random.signed()),
        1 => turn * Matrix::from_diagonal(&Vector::new(1.0 + off, 1.0 - off, 1.0)),
        _ => turn * (1.0 + off),
    }
}

/// The vertices of a feature of a simplicial hull without relabelled vertices.
fn corners(shape: &Shape, feature: &Feature) -> Vec<u32> {
    let polyhedron = shape.polyhedron();
    let [first, second] = feature.ids;
    match feature.kind {
        FeatureKind::Vertex => vec![first],
        FeatureKind::Edge => vec![first, second],
        FeatureKind::Face => {
            let face = (0..polyhedron.faces.len() as u32).find(|&face| polyhedron.faces[face as usize].label == first);
            let corner = |side| polyhedron.vertex_labels[polyhedron.corner(face.expect("a face"), side) as usize];
            (0..3).map(corner).collect()
        }
        FeatureKind::None => panic!("no feature"),
    }
}

/// Cause: marching found the nearest points of two edges as if their images were of unit length. Along the common perpendicular the
/// interval is narrow all the same, and points up to 1e-7 beside it passed. Cut-off: rounding, over the sine of the edges' angle.
#[test]
fn witness_points_are_on_the_shortest_connection() {
    let mut random = Random::new(0x5ed3);
    let (mut worst, mut kinds, mut unproved) = ([0.0_f64; 3], [0; 3], 0);
    for round in 0..6_000 {
        let points = [0, 1].map(|_| (0..4 + random.below(5)).map(|_| random.vector()).collect::<Vec<_>>());
        let shapes = points.each_ref().map(|points| hull(points));
        let off = 10f64.powf(random.uniform(-15.0, -2.5));
        let apart = random.direction() * random.uniform(1.0, 6.0);
        let poses =
            [Pose::new(&skewed(&mut random, off), &Vector::zeros()), Pose::new(&skewed(&mut random, off), &apart)];
        let bodies = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
        let mut answer = PairAnswer::default();
        distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
        if answer.outcome != Outcome::Separated {
            continue;
        }
        assert_eq!(verify(bodies, &answer), Ok(()), "{round}");
        let features = [corners(&shapes[0], &answer.feature1), corners(&shapes[1], &answer.feature2)];
        let pairs: Vec<[u32; 2]> = features[0].iter().flat_map(|&a| features[1].iter().map(move |&b| [a, b])).collect();
        let [first, second] = points.each_ref().map(|points| coordinates(points));
        let proved = proved_by(&first, &row_major(&poses[0]), &second, &row_major(&poses[1]), &pairs);
        let Some(shortest) = proved else {
            unproved += 1;
            continue;
        };
        let shortest = Vector::from(shortest.map(|x| x.to_f64().value()));
        let found = poses[0].rotate(&answer.local1.into()) - poses[1].rotate(&answer.local2.into()) - apart;
        let kind = match features.each_ref().map(Vec::len) {
            [2, 2] => 0,
            [3, _] | [_, 3] => 1,
            _ => 2,
        };
        let mut sine = 1.0;
        if kind == 0 {
            let along = |i: usize| {
                let ends = [0, 1].map(|k| points[i][features[i][k] as usize]);
                poses[i].rotate(&(ends[1] - ends[0])).normalize()
            };
            sine = along(0).cross(&along(1)).norm();
        }
        let error = (found - shortest).norm() * sine;
        worst[kind] = worst[kind].max(error);
        kinds[kind] += 1;
    }
    println!("{worst:?} of {kinds:?}, {unproved} unproved");
    assert!(worst.iter().all(|&worst| worst < 2e-14), "{worst:?}");
    assert!(kinds.iter().all(|&count| count > 400) && unproved < 20, "{kinds:?} {unproved}");
}
