//! Magnitudes: bodies of very different size, far away, tiny and huge; matrices that are no rotations; and everything at once.

use swiftprox::math::{Matrix, Vector};

use super::bodies::{ordinary, scaled, shifted};
use super::placing::{Surface, anywhere, gap_ladder, moved, power_of_ten, stretched, touching};
use super::{Family, Sequence};
use crate::PosePair;
use crate::orbits::pose_pair;
use crate::random::{Random, rotation};

pub const FAMILIES: &[Family] = &[
    Family {
        name: "size_ratio",
        sweep: 12,
        why: "one object 1e-6 to 1e6 times as large as the other: absolute tolerances, and differences of large supports",
        sources: &[
            "https://github.com/danfis/libccd/issues/17",
            "https://github.com/danfis/libccd/issues/30",
            "https://github.com/jsk-ros-pkg/jsk_roseus/issues/616",
            "https://github.com/bulletphysics/bullet3/issues/1703",
        ],
        make: size_ratio,
    },
    Family {
        name: "far_origin",
        sweep: 7,
        why: "both objects 1e3 to 1e9 from the world's origin, or one of them: world coordinates lose the digits that the gap needs",
        sources: &[
            "https://github.com/MattiaMontanari/openGJK/issues/52",
            "https://github.com/dimforge/parry/issues/166",
            "https://github.com/bulletphysics/bullet3/issues/2579",
        ],
        make: far_origin,
    },
    Family {
        name: "far_local_origin",
        sweep: 14,
        why: "vertices 1e3 to 1e9 from their own origin, which the pose brings back: every digit of R·v + T cancels",
        sources: &[
            "https://github.com/MattiaMontanari/openGJK/issues/52",
            "https://github.com/bulletphysics/bullet3/issues/2579",
        ],
        make: far_local_origin,
    },
    Family {
        name: "scales",
        sweep: 10,
        why: "everything tiny, down to 1e-9, or huge, up to 1e9: absolute epsilons decide the verdict",
        sources: &[
            "https://github.com/bulletphysics/bullet3/issues/2579",
            "https://github.com/jrouwe/JoltPhysics/issues/41",
            "https://github.com/flexible-collision-library/fcl/issues/301",
            "https://github.com/coal-library/coal/issues/604",
        ],
        make: scales,
    },
    Family {
        name: "not_orthonormal",
        sweep: 20,
        why: "rotation matrices off by 1e-12 to 1e-4, scaled, drifted or rounded: the transpose is not the inverse, and queries in \
              either local frame disagree",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/408",
            "https://github.com/coal-library/coal/issues/604",
        ],
        make: not_orthonormal,
    },
    Family {
        name: "combined",
        sweep: 12,
        why: "thin, far away, of different size and with matrices that drifted, all at once: bounds that hold one by one have to \
              hold together",
        sources: &[
            "https://github.com/bulletphysics/bullet3/issues/2579",
            "https://github.com/coal-library/coal/issues/604",
        ],
        make: combined,
    },
];

fn size_ratio(random: &mut Random, index: usize) -> Sequence {
    let exponent = [-6, -5, -4, -3, -2, -1, 1, 2, 3, 4, 5, 6][index % 12];
    let ratio = 10f64.powi(exponent);
    let bodies = [ordinary(random), scaled(ordinary(random), [ratio; 3])];
    let surfaces = bodies.each_ref().map(Surface::of);
    let size = ratio.min(1.0);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], size * gap)).collect();
    poses.extend((0..4).map(|_| anywhere(random, 1.5 * ratio.max(1.0))));
    Sequence { name: format!("1e{exponent}"), bodies, poses }
}

fn far_origin(random: &mut Random, index: usize) -> Sequence {
    let exponent = 3 + index % 7;
    let bodies = [ordinary(random), ordinary(random)];
    let surfaces = bodies.each_ref().map(Surface::of);
    let direction = random.direction();
    let direction = random.pick(&[Vector::x(), direction, Vector::repeat(1.0)]);
    let far = 10f64.powi(exponent as i32) * direction;
    let mut poses: Vec<_> = gap_ladder(random)
        .into_iter()
        .map(|gap| moved(touching(random, [&surfaces[0], &surfaces[1]], gap), &far))
        .collect();
    poses.extend((0..6).map(|_| moved(anywhere(random, 2.0), &far)));
    // One there, the other at the origin.
    poses.extend((0..4).map(|_| {
        let mut pair = anywhere(random, 2.0);
        (0..3).for_each(|k| pair[15 + 4 * k] += far[k]);
        pair
    }));
    Sequence { name: format!("1e{exponent}"), bodies, poses }
}

fn far_local_origin(random: &mut Random, index: usize) -> Sequence {
    let exponent = 3 + index % 7;
    let away = |random: &mut Random| 10f64.powi(exponent as i32) * random.vector();
    let first = shifted(ordinary(random), &away(random));
    let second = if index % 14 < 7 { shifted(ordinary(random), &away(random)) } else { ordinary(random) };
    let bodies = [first, second];
    let surfaces = bodies.each_ref().map(Surface::of);
    let poses = gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap));
    Sequence { name: format!("1e{exponent}"), poses: poses.collect(), bodies }
}

fn scales(random: &mut Random, index: usize) -> Sequence {
    let exponent = [-9, 9, -6, 6, -8, 8, -3, 3, -7, 7][index % 10];
    let size = 10f64.powi(exponent);
    let bodies = [ordinary(random), ordinary(random)].map(|body| scaled(body, [size; 3]));
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], size * gap)).collect();
    poses.extend((0..6).map(|_| stretched(anywhere(random, 2.0), size)));
    Sequence { name: format!("1e{exponent}"), bodies, poses }
}

fn not_orthonormal(random: &mut Random, index: usize) -> Sequence {
    let bodies = [ordinary(random), ordinary(random)];
    let surfaces = bodies.each_ref().map(Surface::of);
    let exponent = -4 - 2 * (index / 4 % 5) as i32;
    let poses = gap_ladder(random).into_iter().chain([0.1, 0.3, 1.0]).map(|gap| {
        let pair = touching(random, [&surfaces[0], &surfaces[1]], gap);
        spoilt(random, pair, index % 4, 10f64.powi(exponent))
    });
    let name = ["entries", "scaled", "drifted", "rounded"][index % 4];
    Sequence { name: format!("{name}_1e{exponent}"), poses: poses.collect(), bodies }
}

/// A pair of poses whose matrices are off orthonormal by about `error`.
fn spoilt(random: &mut Random, mut pair: PosePair, kind: usize, error: f64) -> PosePair {
    for base in [0, 12] {
        let entries: Vec<usize> = (0..12).filter(|k| k % 4 != 3).map(|k| base + k).collect();
        match kind {
            0 => entries.iter().for_each(|&k| pair[k] += error * random.signed()),
            1 => {
                let factor = 1.0 + error * random.signed();
                entries.iter().for_each(|&k| pair[k] *= factor);
            }
            2 => {
                // Turned a little very often, as an integrator does, and never made orthonormal again.
                let mut turn = Matrix::from_fn(|row, column| pair[base + 4 * row + column]);
                let step = rotation(&random.direction(), 1.0) + Matrix::repeat(error * 1e-3 * random.signed());
                for _ in 0..1000 {
                    turn = step * turn;
                }
                entries.iter().zip(turn.transpose().iter()).for_each(|(&k, x)| pair[k] = *x);
            }
            _ => {
                // Printed with few digits.
                entries.iter().for_each(|&k| pair[k] = (pair[k] / error).round() * error);
            }
        }
    }
    pair
}

fn combined(random: &mut Random, _: usize) -> Sequence {
    let size = power_of_ten(random, -9, 9);
    let ratio = if random.below(2) == 0 { power_of_ten(random, -6, 6) } else { 1.0 };
    let bodies = [size, size * ratio].map(|size| {
        let mut thin = || if random.below(3) == 0 { power_of_ten(random, -8, -1) } else { 1.0 };
        let axes = [size, size * thin(), size * thin()];
        let body = scaled(ordinary(random), axes);
        let away = if random.below(3) == 0 { power_of_ten(random, 0, 6) } else { 0.0 } * size * random.vector();
        shifted(body, &away)
    });
    let surfaces = bodies.each_ref().map(Surface::of);
    let least = surfaces[0].radius.min(surfaces[1].radius);
    let far = if random.below(2) == 0 { power_of_ten(random, 0, 9) } else { 0.0 } * size * random.vector();
    let kind = random.below(6);
    let error = power_of_ten(random, -14, -4);
    let mut poses = Vec::new();
    for gap in gap_ladder(random).into_iter().take(20) {
        let mut pair = touching(random, [&surfaces[0], &surfaces[1]], least * gap);
        if kind < 4 {
            pair = spoilt(random, pair, kind, error);
        }
        poses.push(moved(pair, &far));
    }
    let turn = random.rotation();
    let shift = (surfaces[0].radius + surfaces[1].radius) * random.vector();
    poses.push(pose_pair(&turn, &far, &turn, &(far + shift)));
    Sequence { name: format!("{size:e}_{ratio:e}"), bodies, poses }
}
