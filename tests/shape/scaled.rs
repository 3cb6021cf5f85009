//! Copies of shapes at other scales.

use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{self, Levels, PairAnswer, PairCache, PairConfig};
use swiftprox::progress::Progress;
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::{ellipsoid, prism};
use testkit::random::Random;

fn scaled(shape: &Shape, scale: f64) -> Result<Shape, Error> {
    shape.scaled(scale, &mut Progress::new(&mut |_| true))
}

fn shapes() -> Vec<Shape> {
    let with = |kind| ShapeOptions {
        hierarchy: HierarchyOptions { kind, minimum_triangles: 20, ..HierarchyOptions::default() },
        translation: Vector::new(3.0, -1.0, 0.125),
        ..ShapeOptions::default()
    };
    let round = ellipsoid([1.0, 0.7, 0.4], 600).unwrap();
    let kinds =
        [HierarchyKind::Automatic, HierarchyKind::Quadric, HierarchyKind::OuterCuts, HierarchyKind::DobkinKirkpatrick];
    let mut shapes: Vec<Shape> = kinds.into_iter().map(|kind| Shape::from_mesh(&round, &with(kind)).unwrap()).collect();
    shapes.push(Shape::from_mesh(&prism(40, 0.3).unwrap(), &with(HierarchyKind::None)).unwrap());
    shapes
}

/// What the copy is made of is what the same vertices make, each level is there, and answers are those multiplied.
#[test]
fn a_copy_is_the_shape_multiplied() {
    let mut random = Random::new(0x5ca1e);
    for shape in shapes() {
        shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
        for (scale, in_range) in [(0.5, true), (2.0, true), (2.0_f64.powi(70), true), (2.0_f64.powi(-300), false)] {
            let copy = scaled(&shape, scale).unwrap();
            let (old, new) = (shape.polyhedron(), copy.polyhedron());
            assert_eq!(new.triangles, old.triangles);
            assert_eq!(new.vertex_labels, old.vertex_labels);
            assert_eq!(new.face_labels, old.face_labels);
            for v in 0..old.vertices.len() as u32 {
                assert_eq!(new.local_position(v), old.local_position(v) * scale);
            }
            let levels = [&shape, &copy].map(|shape| &shape.hierarchy().levels);
            assert_eq!(levels[0].len(), levels[1].len());
            for (one, other) in levels[0].iter().zip(levels[1]) {
                assert_eq!(one.polyhedron.triangles, other.polyhedron.triangles);
                let ratio = other.deviation / (one.deviation * scale);
                // The walk that measures it takes fourth powers: out of range they underflow, it ends early, and the bound is
                // that of a point farther than the nearest one.
                let most = if in_range { 1.0 + 1e-12 } else { 2.0 };
                assert!((1.0 - 1e-12..=most).contains(&ratio), "a level stands off as far: {ratio} at {scale:e}");
            }
            let back = scaled(&copy, 1.0 / scale).unwrap();
            assert_eq!(back.polyhedron().vertices, old.vertices);
            for _ in 0..20 {
                let rotation = random.rotation();
                let places = [Vector::zeros(), random.vector() * 4.0];
                let ask = |shape: &Shape, scale: f64| {
                    let poses =
                        [Pose::new(&rotation, &places[0]), Pose::new(&rotation.transpose(), &(places[1] * scale))];
                    let config = PairConfig { levels: Levels::All, ..PairConfig::default() };
                    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
                    pair::distance(poses.each_ref().map(|pose| shape.at(pose)), &mut cache, &config, &mut answer)
                        .unwrap();
                    answer
                };
                let (one, other) = (ask(&shape, 1.0), ask(&copy, scale));
                assert_eq!(one.outcome, other.outcome);
                let [low, high] = [other.lower / scale, other.upper / scale];
                assert!(low <= one.upper && one.lower <= high, "{one:?} {other:?}");
            }
        }
    }
}

#[test]
fn what_would_round_is_refused() {
    let shape = Arc::new(shapes().pop().unwrap());
    for scale in [0.0, -2.0, 3.0, 0.1, f64::NAN, f64::INFINITY, 2.0_f64.powi(-1074), 1.0 + f64::EPSILON] {
        let Err(Error::Argument(message)) = scaled(&shape, scale) else { panic!("scale {scale} is taken") };
        assert!(message.contains("power of two") && message.contains("anew"), "{message}");
    }
    let large = scaled(&shape, 2.0_f64.powi(900)).unwrap();
    for (shape, scale) in [(&large, 2.0_f64.powi(200)), (&*shape, 2.0_f64.powi(-1022))] {
        assert!(matches!(scaled(shape, scale), Err(Error::Argument(_))));
    }
    let cancelled = shape.scaled(2.0, &mut Progress::new(&mut |_| false));
    assert!(matches!(cancelled, Err(Error::Cancelled(_))));
}
