//! Caches made to mislead the check of a depth.

use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Feature, FeatureKind, Outcome};
use swiftprox::shape::Shape;
use swiftprox::verify::verify_depth;
use testkit::shapes::hull;

use crate::Random;
use crate::caches::of_bytes;

/// A pyramid from its tip, which is vertex 0, up or down to the corners of a triangle at a height of 1.
fn pyramid(tip: Vector, up: f64) -> Shape {
    let corner = |x: f64, y: f64| Vector::new(x, y, up);
    hull(&[tip, corner(2.0, 0.0), corner(-1.0, 1.75), corner(-1.0, -1.75)])
}

/// Where a cache has its pairs, triangles and counts: behind 24 bytes, behind 56 pairs, and behind 108 triangles.
const PAIRS: usize = 24;
const TRIANGLES: usize = PAIRS + 56 * 8;
const COUNTS: usize = TRIANGLES + 108 * 3;
const _: () = assert!(size_of::<DepthCache>() == COUNTS + 4);

/// A tetrahedron of four differences of the pyramids' vertices: tip and tip, and the corners of the first over the other tip.
fn tetrahedron(shapes: [&Shape; 2]) -> DepthCache {
    let index = |shape: &Shape, label: u32| {
        shape.polyhedron().vertex_labels.iter().position(|known| *known == label).unwrap() as u32
    };
    let mut bytes = [0; size_of::<DepthCache>()];
    bytes[COUNTS..COUNTS + 2].copy_from_slice(&[4, 4]);
    for label in 0..4 {
        let pair = [index(shapes[0], label), index(shapes[1], 0)];
        for (i, vertex) in pair.into_iter().enumerate() {
            let at = PAIRS + 8 * label as usize + 4 * i;
            bytes[at..at + 4].copy_from_slice(&vertex.to_ne_bytes());
        }
    }
    for (triangle, corners) in [[0, 1, 2], [0, 2, 3], [0, 3, 1], [3, 2, 1]].into_iter().enumerate() {
        bytes[TRIANGLES + 3 * triangle..][..3].copy_from_slice(&corners);
    }
    of_bytes(&bytes)
}

/// Two tips of bodies of size 1 are 5e-34 apart. Their difference is noise in double-double arithmetic: in some turns it lies on
/// the wrong side of the origin, and a tetrahedron from it seems to surround the origin. Cut-off: determinants were taken for clear
/// as if each column were right to u of itself, and an upper end passed where the bodies do not overlap along the normal.
#[test]
fn noise_does_not_surround_the_origin() {
    // The first tip is half a unit off the second, and so far the first body is moved: exactly.
    let tips = [Vector::new(0.3 - 0.5, 0.4, 1e-34), Vector::new(0.3, 0.4, -4e-34)];
    let shapes = [pyramid(tips[0], 1.0), pyramid(tips[1], -1.0)];
    let cache = tetrahedron([&shapes[0], &shapes[1]]);
    let mut random = Random::new(71);
    for _ in 0..400 {
        let turn = random.rotation();
        let poses = [Pose::new(&turn, &(turn.column(0) * 0.5)), Pose::new(&turn, &Vector::zeros())];
        let [world1, world2] = [0, 1].map(|i| poses[i].transform(&tips[i]).into());
        let tip = Feature { kind: FeatureKind::Vertex, ids: [0, 0] };
        let forged = DepthAnswer {
            outcome: Outcome::Intersecting,
            depth: 1e-30,
            lower: 1e-35,
            upper: 1e-20,
            normal: turn.column(2).normalize().into(),
            local1: tips[0].into(),
            local2: tips[1].into(),
            world1,
            world2,
            feature1: tip,
            feature2: tip,
            ..DepthAnswer::default()
        };
        let checked = verify_depth([shapes[0].at(&poses[0]), shapes[1].at(&poses[1])], &cache, &forged);
        assert!(checked.is_err(), "{poses:?}");
    }
}
