//! Random and adversarial pairs against the independent check.

use std::f64::consts::TAU;

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, DepthStatus, Outcome};
use swiftprox::progress::Progress;
use swiftprox::shape::Shape;
use swiftprox::verify::verify_depth;

use crate::common::hard::families;
use crate::common::random::rotation;
use crate::shapes::{cuboid, hull};
use crate::{Random, query};

fn prepared(shape: Shape) -> Shape {
    shape.prepare(&mut Progress::new(&mut |_| true)).unwrap();
    shape
}

fn ellipsoid(random: &mut Random, count: usize, half_axes: [f64; 3]) -> Shape {
    let points: Vec<Vector> = (0..count).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
    prepared(hull(&points))
}

/// A prism over a regular polygon.
fn prism(sides: usize, height: f64) -> Shape {
    let corner = |k: usize, z: f64| {
        let angle = TAU * k as f64 / sides as f64;
        Vector::new(angle.cos(), angle.sin(), z)
    };
    let points: Vec<Vector> = (0..sides).flat_map(|k| [corner(k, -height), corner(k, height)]).collect();
    prepared(hull(&points))
}

/// Bodies of many vertices, of many sizes.
pub fn large(random: &mut Random) -> Vec<Shape> {
    let mut shapes = vec![cuboid([0.5, 0.5, 0.5]), cuboid([1.0, 0.3, 0.05]), prism(5, 0.5), prism(64, 0.1)];
    for (count, half_axes) in
        [(30, [1.0, 1.0, 1.0]), (100, [1.0, 1.0, 0.1]), (300, [1.0, 1.0, 1.0]), (200, [1.0, 0.1, 0.1]), (20, [0.2; 3])]
    {
        shapes.push(ellipsoid(random, count, half_axes));
    }
    shapes
}

fn radius(shape: &Shape) -> f64 {
    shape.polyhedron().radius
}

/// Poses in which bodies are likely to overlap: from concentric to barely, some in line with each other, some skewed, some far out.
pub fn placed_deep(random: &mut Random, shapes: [&Shape; 2]) -> [Pose; 2] {
    let reach = radius(shapes[0]).min(radius(shapes[1]));
    let far = random.pick(&[0.0, 0.0, 0.0, 1e3, 1e7]);
    let origin = random.vector() * far;
    [0, 1].map(|i| {
        let turn = match random.below(4) {
            0 => random.quarter_turns(),
            1 => random.quarter_turns() * rotation(&random.direction(), random.power(-50, -3)),
            2 => random.rotation() + Matrix::from_fn(|_, _| random.signed()) * random.power(-40, -10),
            _ => random.rotation(),
        };
        let away = random.direction() * reach * random.pick(&[0.0, 1e-9, 0.2, 0.5, 0.9]) * i as f64;
        Pose::new(&turn, &(origin + away))
    })
}

/// Half of what is promised of ordinary pairs where nothing is far out.
fn width_of(shapes: [&Shape; 2], poses: [&Pose; 2], answer: &DepthAnswer) -> f64 {
    let size = radius(shapes[0]) + radius(shapes[1]);
    let apart = (poses[0].translation() - poses[1].translation()).norm();
    (answer.upper - answer.lower) / size.max(apart).max(f64::MIN_POSITIVE)
}

fn check(shapes: [&Shape; 2], poses: [&Pose; 2], cache: &DepthCache, answer: &DepthAnswer) {
    verify_depth(shapes[0], poses[0], shapes[1], poses[1], cache, answer)
        .unwrap_or_else(|error| panic!("{error}: {poses:?} {answer:?}"));
}

#[test]
fn depths_of_random_pairs_hold() {
    let mut random = Random::new(41);
    let shapes = large(&mut random);
    let (mut overlapping, mut wide, mut widest) = (0, 0, 0.0_f64);
    let mut stalled = 0;
    for _ in 0..4_000 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let mut poses = placed_deep(&mut random, pair);
        let mut cache = DepthCache::default();
        // A few steps on from there.
        let step = random.power(-16, -1);
        for _ in 0..5 {
            let placed = [&poses[0], &poses[1]];
            let answer = query(pair, placed, &mut cache);
            check(pair, placed, &cache, &answer);
            if answer.outcome == Outcome::Intersecting {
                overlapping += 1;
                let width = width_of(pair, placed, &answer);
                widest = widest.max(width);
                wide += usize::from(width > 2e-14);
                if width > 2e-14 { println!("{width:e} {answer:?}"); }
            }
            stalled += usize::from(answer.status == DepthStatus::Stalled);
            let turn = rotation(&random.direction(), step);
            let moved = poses[1].translation() + random.vector() * step * radius(pair[1]);
            poses[1] = Pose::new(&(turn * poses[1].rotation()), &moved);
        }
    }
    println!("{overlapping} overlap, {stalled} stalled, {wide} wide, the widest {widest:e}");
    assert!(overlapping > 10_000, "{overlapping}");
}

#[test]
fn depths_of_hard_families_hold() {
    let (mut overlapping, mut wide, mut widest) = (0, 0, 0.0_f64);
    for family in families() {
        for index in 0..family.sweep.min(6) {
            let sequence = family.sequence(5, index);
            let [Ok(first), Ok(second)] = [0, 1].map(|i| {
                let options = swiftprox::shape::ShapeOptions {
                    input: swiftprox::shape::InputPolicy::Hull,
                    ..swiftprox::shape::ShapeOptions::default()
                };
                Shape::from_mesh(&sequence.bodies[i], &options)
            }) else {
                continue;
            };
            let pair = [&first, &second];
            let mut cache = DepthCache::default();
            for pose in sequence.poses.iter().step_by(1 + sequence.poses.len() / 40) {
                let [first, second] = [0, 12].map(|at| Pose::from_row_major(pose[at..at + 12].try_into().unwrap()));
                let placed = [&first, &second];
                let answer = query(pair, placed, &mut cache);
                if let Err(error) = verify_depth(pair[0], placed[0], pair[1], placed[1], &cache, &answer) {
                    println!("{} {index} {error} {:?} {answer:?} {:?}", family.name, sequence.bodies, placed);
                    println!("{:?}", pair.map(|p| (p.polyhedron().dimension, p.polyhedron().vertices.len(), p.polyhedron().radius)));
                    continue;
                }
                if answer.outcome == Outcome::Intersecting {
                    overlapping += 1;
                    let width = width_of(pair, placed, &answer);
                    widest = widest.max(width);
                    wide += usize::from(width > 2e-14);
                    if width > 2e-14 { println!("{} {width:e} {answer:?}", family.name); }
                }
            }
        }
    }
    println!("{overlapping} overlap, {wide} wide, the widest {widest:e}");
    assert!(overlapping > 500, "{overlapping}");
}
