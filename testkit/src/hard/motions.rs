//! Flights that make a warm start wrong, or keep it on the border of being right.

use std::f64::consts::PI;

use swiftprox::math::Vector;

use super::bodies::{cloud, cuboid, cylinder, grid_box, ordinary, regular_solid, scaled, sphere};
use super::placing::{Surface, anywhere, frame, gap_ladder, moved, power_of_ten, side_by_side, touching};
use super::{Family, Sequence};
use crate::orbits::pose_pair;
use crate::random::{Random, rotation};

pub const FAMILIES: &[Family] = &[
    Family {
        name: "teleport",
        sweep: 8,
        why: "consecutive poses far apart: jumps to the far side, half turns, through each other; a warm start is as wrong as it can \
              be",
        sources: &[
            "Ehmann and Lin, Accelerated Proximity Queries Between Convex Polyhedra By Multi-Level Voronoi Marching (2000), 6",
            "Mirtich, V-Clip: Fast and Robust Polyhedral Collision Detection (1998)",
        ],
        make: teleport,
    },
    Family {
        name: "straight_through",
        sweep: 6,
        why: "one object flies straight through the other: the separating direction turns over within a step, and on an axis of \
              symmetry it is nowhere defined inside",
        sources: &[
            "https://github.com/danfis/libccd/issues/25",
            "https://github.com/flexible-collision-library/fcl/issues/545",
            "Mirtich, V-Clip: Fast and Robust Polyhedral Collision Detection (1998)",
        ],
        make: straight_through,
    },
    Family {
        name: "sliding",
        sweep: 8,
        why: "contact kept while faces slide over each other or a box rolls over its edge: touching at every step, features change by \
              ties",
        sources: &[
            "https://github.com/RobotLocomotion/drake/issues/10578",
            "https://github.com/flexible-collision-library/fcl/issues/319",
            "https://github.com/google-deepmind/mujoco_warp/issues/1526",
        ],
        make: sliding,
    },
    Family {
        name: "creeping",
        sweep: 6,
        why: "steps of a unit in the last place through contact and back: the verdict turns over between neighbouring doubles, and \
              what the last query proved holds no more by a rounding",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/366",
            "https://github.com/bulletphysics/bullet3/issues/889",
            "https://github.com/google-deepmind/mujoco/issues/3383",
        ],
        make: creeping,
    },
    Family {
        name: "voronoi_trap",
        sweep: 6,
        why: "a small object jumps across a plate or sits behind a face: a vertex below a face's plane, yet inside all its Voronoi \
              planes, is the local minimum of walks over features",
        sources: &[
            "Mirtich, V-Clip: Fast and Robust Polyhedral Collision Detection (1998)",
            "Ericson, Real-Time Collision Detection (2005), 9.2.1, figure 9.4",
            "Lin and Canny, A Fast Algorithm for Incremental Distance Calculation (1991)",
        ],
        make: voronoi_trap,
    },
    Family {
        name: "big_spheres",
        sweep: 3,
        why: "10,000-vertex spheres nearly touching: thousands of nearly coplanar small faces, many tiny steps",
        sources: &[
            "https://github.com/coal-library/coal/issues/318",
            "Ehmann and Lin, Accelerated Proximity Queries Between Convex Polyhedra By Multi-Level Voronoi Marching (2000), 7",
        ],
        make: big_spheres,
    },
];

fn teleport(random: &mut Random, index: usize) -> Sequence {
    let body = |random: &mut Random, kind: usize| match kind % 4 {
        0 => sphere(random, 102),
        1 => scaled(sphere(random, 102), [1.0, 1.0, 0.1]),
        2 => scaled(sphere(random, 102), [1.0, 0.1, 0.1]),
        _ => ordinary(random),
    };
    let bodies = [body(random, index), body(random, index / 2)];
    let (turn1, mut turn2, mut place) = (random.rotation(), random.rotation(), 1.5 * random.direction());
    let mut poses = Vec::new();
    for _ in 0..40 {
        match random.below(5) {
            0 => place = -place,
            1 => turn2 *= rotation(&Vector::ith(random.below(3), 1.0), PI),
            2 => turn2 *= rotation(&random.direction(), PI),
            3 => (turn2, place) = (random.rotation(), random.uniform(0.2, 2.5) * random.direction()),
            // Away, and back the next time.
            _ => place = random.pick(&[1e-3, 1.0, 1e3]) * random.direction(),
        }
        poses.push(pose_pair(&turn1, &Vector::zeros(), &turn2, &place));
    }
    Sequence { name: format!("{}_{}", index % 4, index / 2 % 4), bodies, poses }
}

fn straight_through(random: &mut Random, index: usize) -> Sequence {
    let bodies = match index % 3 {
        0 => [regular_solid(random.below(5)), regular_solid(random.below(5))],
        1 => [ordinary(random), ordinary(random)],
        _ => [cuboid([1.0, 1.0, 0.01]), ordinary(random)],
    };
    let is_symmetric = index % 6 < 3;
    let (turn1, turn2) = if is_symmetric {
        (random.quarter_turns(), random.quarter_turns())
    } else {
        (random.rotation(), random.rotation())
    };
    let line = if is_symmetric { Vector::ith(random.below(3), 1.0) } else { random.direction() };
    // Through the middle, or along the side of a box exactly.
    let beside = if is_symmetric { random.lattice(1) } else { 0.3 * random.vector() };
    let beside = beside - line * beside.dot(&line);
    let step = random.pick(&[0.125, 0.3, 1.7, 0.05]);
    let poses =
        (-30..=30).map(|k| pose_pair(&turn1, &Vector::zeros(), &turn2, &(beside + line * (step * f64::from(k)))));
    Sequence { name: format!("{}_step_{step}", index % 3), bodies, poses: poses.collect() }
}

fn sliding(random: &mut Random, index: usize) -> Sequence {
    let turn = frame(random, index);
    let gap = random.pick(&[0.0, 1e-15, 1e-9, -1e-9]);
    let step = random.pick(&[0.125, 0.01, 0.1]);
    if index % 4 == 3 {
        // A box rolls over its edges on a floor.
        let bodies = [cuboid([4.0, 4.0, 0.5]), cuboid([0.5; 3])];
        let poses = (0..40).map(|k| {
            let angle = random.pick(&[PI / 40.0, PI / 4.0]) * f64::from(k);
            let height = 0.5 * (angle.sin().abs() + angle.cos().abs());
            let shift = Vector::new(0.05 * f64::from(k) - 1.0, 0.0, 0.5 + height + gap);
            pose_pair(&turn, &Vector::zeros(), &(turn * rotation(&Vector::y(), angle)), &(turn * shift))
        });
        return Sequence { name: format!("rolling_{gap:e}"), poses: poses.collect(), bodies };
    }
    let bodies = match index % 4 {
        0 => [cuboid([1.0, 1.0, 0.5]), cuboid([0.5, 0.5, 0.25])],
        1 => [grid_box([1.0, 1.0, 0.5], 4), grid_box([0.5, 0.5, 0.25], 2)],
        _ => [cylinder(32, 1.0, 0.5), cylinder(7, 0.5, 0.25)],
    };
    let (mut x, mut y) = (-2.0, random.pick(&[0.0, 0.5, 1.0, 1.5]));
    let poses = (0..60).map(|_| {
        x += step;
        y += step * random.pick(&[0.0, 0.0, 1.0, -1.0]);
        pose_pair(&turn, &Vector::zeros(), &turn, &(turn * Vector::new(x, y, 0.75 + gap)))
    });
    Sequence { name: format!("{}_{gap:e}", index % 4), poses: poses.collect(), bodies }
}

fn creeping(random: &mut Random, index: usize) -> Sequence {
    let bodies = match index % 3 {
        0 => [cuboid([1.0, 0.75, 0.5]), cuboid([0.5, 1.0, 0.25])],
        1 => [ordinary(random), ordinary(random)],
        _ => [scaled(cloud(random, 20), [1.0, 1.0, 1e-3]), regular_solid(index)],
    };
    // Up to 1e9 away, where a unit in the last place is 1e-7.
    let far = random.pick(&[0.0, 0.0, 1.0, 1e3, 1e6, 1e9]) * random.direction();
    let start = if index.is_multiple_of(3) {
        // Face on face, all coordinates exact.
        side_by_side(&random.quarter_turns(), &Vector::zeros(), &Vector::new(0.25, 0.5, 0.75))
    } else {
        let surfaces = bodies.each_ref().map(Surface::of);
        touching(random, [&surfaces[0], &surfaces[1]], 0.0)
    };
    let start = moved(start, &far);
    let axes: Vec<usize> = (0..3).filter(|_| random.below(2) == 0).chain([2]).collect();
    let towards = if random.below(2) == 0 { f64::next_up } else { f64::next_down };
    let back = if towards(0.0) > 0.0 { f64::next_down } else { f64::next_up };
    let mut pair = start;
    let mut poses = vec![pair];
    for k in 0..40 {
        // Some steps in one direction, then as many and more in the other.
        let step = if k < 14 { towards } else { back };
        for &axis in &axes {
            let entry = &mut pair[15 + 4 * axis];
            // Next to zero are the subnormal numbers: a rounding of the size there.
            *entry = if entry.abs() < 1e-3 { *entry + 1e-16 * step(0.0).signum() } else { step(*entry) };
        }
        poses.push(pair);
    }
    Sequence { name: format!("{}", index % 3), bodies, poses }
}

fn voronoi_trap(random: &mut Random, index: usize) -> Sequence {
    let thickness = random.pick(&[0.3, 0.1, 0.03, 0.01]);
    let plate = match index % 3 {
        0 => cuboid([1.0, 1.0, thickness]),
        1 => grid_box([1.0, 1.0, thickness], 4),
        _ => scaled(cloud(random, 80), [1.0, 1.0, thickness]),
    };
    let size = thickness * random.pick(&[0.13, 0.5, 0.9, 0.01]);
    let small = scaled(regular_solid(2 + index % 2), [size; 3]);
    let turn = random.rotation();
    let mut side = 1.0;
    let poses = (0..40).map(|k| {
        side = -side;
        let reach = random.pick(&[0.5, 1.0]);
        let across = Vector::new(reach * random.signed(), reach * random.signed(), 0.0);
        // Above, below, in between, and behind the rim.
        let height = match k % 4 {
            0 | 1 => side * (thickness + size * random.uniform(0.5, 4.0)),
            2 => thickness * random.signed(),
            _ => side * (thickness + random.uniform(0.0, 1.0)),
        };
        let turn2 = rotation(&random.direction(), random.uniform(0.0, 3.0));
        pose_pair(&turn, &Vector::zeros(), &turn2, &(turn * (across + Vector::z() * height)))
    });
    Sequence { name: format!("{}_{thickness}", index % 3), poses: poses.collect(), bodies: [plate, small] }
}

fn big_spheres(random: &mut Random, index: usize) -> Sequence {
    let body = sphere(random, 10_000);
    let axes = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.1], [1.0, 0.1, 0.1]][index % 3];
    let body = scaled(body, axes);
    let surface = Surface::of(&body);
    let gaps = gap_ladder(random);
    let mut poses: Vec<_> = gaps.into_iter().take(8).map(|gap| touching(random, [&surface, &surface], gap)).collect();
    // One rolls on the other, a hair apart.
    let (axis, turn) = (random.direction(), random.rotation());
    let gap = power_of_ten(random, -12, -3);
    let out = turn * Vector::x();
    let reach = |direction: &Vector| body.vertices.iter().map(|v| v.dot(direction)).fold(f64::NEG_INFINITY, f64::max);
    let angle = random.pick(&[0.002, 0.02, 0.2]);
    for k in 0..8 {
        let turn2 = rotation(&axis, angle * f64::from(k)) * turn;
        let distance = reach(&(turn.transpose() * out)) + reach(&-(turn2.transpose() * out)) + gap;
        poses.push(pose_pair(&turn, &Vector::zeros(), &turn2, &(out * distance)));
    }
    poses.push(anywhere(random, 1.0));
    Sequence { name: format!("{}", index % 3), bodies: [body.clone(), body], poses }
}
