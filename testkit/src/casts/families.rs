//! Adversarial families: lattice touches, slivers, grazing down to 1e-12, edges of planners, screws of up to 100 radians and at
//! scales from 1e-6 to 1e6.

use std::sync::Arc;

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, Motion, Screw, motion_between};
use swiftprox::shape::Shape;

use super::Case;
use crate::random::{Random, rotation};
use crate::shapes::{cuboid, hull};

fn ellipsoid(random: &mut Random, count: usize, half_axes: [f64; 3]) -> Shape {
    let points: Vec<Vector> = (0..count).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect();
    hull(&points)
}

fn body(random: &mut Random, scale: f64) -> Shape {
    let s = scale;
    match random.below(5) {
        0 => cuboid([0.5 * s, 0.5 * s, 0.5 * s]),
        1 => ellipsoid(random, 20, [s, s, s]),
        2 => ellipsoid(random, 60, [s, 0.3 * s, 0.3 * s]),
        // A needle and a plate.
        3 => ellipsoid(random, 12, [s, 1e-3 * s, 1e-3 * s]),
        _ => cuboid([s, s, 1e-3 * s]),
    }
}

fn screw(random: &mut Random, start: Pose, velocity: Vector, rotation: Vector, scale: f64) -> Motion<'static> {
    let centre = if random.below(3) == 0 { random.vector() * scale } else { Vector::zeros() };
    Motion::Screw(Screw { start, centre, velocity, rotation })
}

/// Bodies that pass each other somewhere near the middle, at a scale, turning by some radians.
fn passing(random: &mut Random, scale: f64, radians: f64) -> Case {
    let smaller = scale * random.pick(&[1.0, 1.0, 0.1]);
    let shapes = [body(random, scale), body(random, smaller)];
    let far = random.pick(&[0.0, 0.0, 10.0, 1e4]) * scale;
    let origin = random.vector() * far;
    let config = CastConfig { time_tolerance: random.pick(&[1e-9, 1e-6, 1e-3, 1e-12]), ..CastConfig::default() };
    let motions = [0, 1].map(|i| {
        let velocity = random.direction() * scale * random.pick(&[0.0, 1.0, 4.0, 30.0]);
        let miss = random.direction() * scale * random.pick(&[0.0, 0.5, 1.0, 1.5, 2.0]) * f64::from(i);
        let turn = random.direction() * radians * random.uniform(0.0, 1.0);
        let start = Pose::new(&random.rotation(), &(origin + miss - velocity * random.uniform(0.2, 0.8)));
        screw(random, start, velocity, turn, scale)
    });
    Case { shapes: shapes.map(Arc::new), motions, config, is_exact: false }
}

/// Boxes with corners on a lattice that move by whole steps of it: they touch at corners, edges and faces, or slide along them.
fn lattice(random: &mut Random) -> Case {
    let side = |random: &mut Random| (1 + random.below(3)) as f64 * 0.5;
    let shapes = [0, 1].map(|_| cuboid([side(random), side(random), side(random)]));
    let motions = [0, 1].map(|_| {
        let start = Pose::new(&random.quarter_turns(), &(random.lattice(6) * 0.5));
        let velocity = random.lattice(8);
        Motion::Screw(Screw { start, centre: Vector::zeros(), velocity, rotation: Vector::zeros() })
    });
    Case { shapes: shapes.map(Arc::new), motions, config: CastConfig::default(), is_exact: true }
}

/// Slivers that turn past each other, and touch about edge to edge.
fn slivers(random: &mut Random) -> Case {
    let thin = random.pick(&[1e-2, 1e-4, 1e-6]);
    let shapes = [cuboid([1.0, thin, thin]), cuboid([1.0, 1.0, thin])];
    let motions = [0, 1].map(|i| {
        let start = Pose::new(&random.rotation(), &(random.vector() * 0.7 * f64::from(i)));
        let (velocity, turn) = (random.vector() * 0.5, random.direction() * random.uniform(0.0, 6.0));
        screw(random, start, velocity, turn, 1.0)
    });
    Case { shapes: shapes.map(Arc::new), motions, config: CastConfig::default(), is_exact: false }
}

/// A turning square whose corner passes a wall at a clearance of a power of ten, from 1e-4 to 1e-12, or in it by as much.
fn grazing(random: &mut Random) -> Case {
    let half = random.uniform(0.2, 1.0);
    let shapes = [cuboid([half, half, 0.3]), cuboid([0.5, 5.0, 5.0])];
    let clearance = 10f64.powi(-4 - random.below(9) as i32) * random.pick(&[1.0, -1.0]);
    let world = Pose::new(&random.rotation(), &random.vector());
    let reach = half * 2f64.sqrt();
    let wall = Pose::new(&world.rotation(), &world.transform(&Vector::new(reach + 0.5 + clearance, 0.0, 0.0)));
    let turn = world.rotate(&Vector::z()) * random.uniform(1.0, 3.0);
    let motions = [
        Motion::Screw(Screw { start: world, centre: Vector::zeros(), velocity: Vector::zeros(), rotation: turn }),
        Motion::Fixed(wall),
    ];
    Case { shapes: shapes.map(Arc::new), motions, config: CastConfig::default(), is_exact: false }
}

/// Between two poses, as a planner has them; some of it with entries that change linearly.
fn edges(random: &mut Random) -> Case {
    let shapes = [body(random, 1.0), body(random, 1.0)];
    let motions = [0, 1].map(|i| {
        let first = Pose::new(&random.rotation(), &(random.vector() * 1.5 * f64::from(i)));
        let small = rotation(&random.direction(), random.uniform(0.0, 0.15)) * first.rotation();
        let is_affine = random.below(2) == 0;
        let turned = if is_affine { small } else { random.rotation() };
        let second = Pose::new(&turned, &(first.translation() + random.vector()));
        if is_affine {
            return Motion::Affine { start: first, end: second };
        }
        Motion::Screw(motion_between(&first, &second, &Vector::zeros(), 2.0).unwrap().0)
    });
    let max_distance = random.pick(&[0.0, 0.0, 0.05]);
    Case {
        shapes: shapes.map(Arc::new),
        motions,
        config: CastConfig { max_distance, ..CastConfig::default() },
        is_exact: false,
    }
}

/// The families' names, in the order of `case`.
pub const FAMILIES: [&str; 8] =
    ["lattice", "slivers", "grazing", "edges", "scale 1e6", "scale 1e-6", "100 rad", "screws"];

/// A motion of the family `round % 8`.
pub fn case(random: &mut Random, round: usize) -> Case {
    match round % FAMILIES.len() {
        0 => lattice(random),
        1 => slivers(random),
        2 => grazing(random),
        3 => edges(random),
        4 => passing(random, 1e6, 2.0),
        5 => passing(random, 1e-6, 2.0),
        6 => passing(random, 1.0, 100.0),
        _ => passing(random, 1.0, random_radians(round)),
    }
}

fn random_radians(round: usize) -> f64 {
    [0.0, 0.3, 2.0, 20.0][round / 8 % 4]
}
