//! Boxes, spheres and capsules.

use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, distance};
use swiftprox::shape::{LARGEST_SWEPT_RADIUS, Shape};
use swiftprox::verify::verify;
use testkit::shapes::at;

fn gap(shape1: &Shape, shape2: &Shape, x: f64, y: f64, z: f64) -> PairAnswer {
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let here = at(0.0, 0.0, 0.0);
    let there = at(x, y, z);
    let placed = [shape1.at(&here), shape2.at(&there)];
    distance(placed, &mut cache, &PairConfig::default(), &mut answer).unwrap();
    verify(placed, &answer).unwrap();
    answer
}

/// Distances along axes and diagonals, by hand.
#[test]
fn solids_reach_as_far_as_their_numbers_say() {
    let plain = Shape::from_box(&Vector::new(1.0, 2.0, 3.0), 0.0).unwrap();
    let rounded = Shape::from_box(&Vector::new(1.0, 2.0, 3.0), 0.5).unwrap();
    let sphere = Shape::from_sphere(0.25).unwrap();
    let capsule = Shape::from_capsule(2.0, 0.25).unwrap();
    let cases = [
        (&plain, &sphere, [5.0, 0.0, 0.0], 3.75),
        (&plain, &sphere, [0.0, -5.0, 0.0], 2.75),
        (&plain, &sphere, [4.0, 6.0, 0.0], 4.75),
        (&rounded, &sphere, [5.0, 0.0, 0.0], 3.25),
        (&rounded, &sphere, [4.0, 6.0, 0.0], 4.25),
        (&plain, &capsule, [0.0, 0.0, 9.0], 3.75),
        (&plain, &capsule, [5.0, 0.0, 0.0], 3.75),
        (&rounded, &plain, [0.0, 0.0, 8.0], 1.5),
        (&sphere, &sphere, [3.0, 4.0, 0.0], 4.5),
    ];
    for (shape1, shape2, [x, y, z], wanted) in cases {
        let answer = gap(shape1, shape2, x, y, z);
        assert_eq!(answer.outcome, Outcome::Separated);
        assert!(answer.lower <= wanted && wanted <= answer.upper, "{wanted}: {answer:?}");
    }
    assert_eq!(gap(&plain, &sphere, 1.25, 0.0, 0.0).outcome, Outcome::Intersecting, "touching");
    assert_eq!(gap(&capsule, &sphere, 0.0, 0.5, 2.0).outcome, Outcome::Intersecting, "touching");
}

/// Vertex i of a box is told by the bits of i, and the ends of a capsule by 0 and 1.
#[test]
fn features_are_numbered_as_documented() {
    let unit = Shape::from_box(&Vector::new(1.0, 1.0, 1.0), 0.0).unwrap();
    let point = Shape::from_sphere(0.0).unwrap();
    for corner in 0..8 {
        let [x, y, z] = [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 2.0 } else { -2.0 });
        assert_eq!(gap(&unit, &point, x, y, z).feature1.ids[0], corner);
    }
    let capsule = Shape::from_capsule(1.0, 0.5).unwrap();
    assert_eq!(
        [gap(&capsule, &point, 0.0, 0.0, -3.0).feature1.ids[0], gap(&capsule, &point, 0.0, 0.0, 3.0).feature1.ids[0]],
        [0, 1]
    );
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let refused = |made: Result<Shape, Error>, name: &str| match made {
        Err(Error::Argument(message)) => assert!(message.contains(name), "{message}"),
        other => panic!("{name}: {other:?}"),
    };
    for bad in [f64::NAN, -1.0, f64::INFINITY, 2.0 * LARGEST_SWEPT_RADIUS] {
        refused(Shape::from_box(&Vector::new(1.0, bad, 1.0), 0.0), "half_extents[1]");
        refused(Shape::from_box(&Vector::new(1.0, 1.0, 1.0), bad), "radius");
        refused(Shape::from_sphere(bad), "radius");
        refused(Shape::from_capsule(bad, 1.0), "half_length");
        refused(Shape::from_capsule(1.0, bad), "radius");
    }
    refused(Shape::from_box(&Vector::new(0.0, 1.0, 1.0), 0.0), "half_extents[0]");
}
