//! Bodies that nearly are of a lower dimension, and placements without a best direction.

use swiftprox::math::Vector;

use super::bodies::{cloud, cuboid, cylinder, dome, hull_of, ordinary, regular_solid, scaled, shifted, sphere};
use super::placing::{Surface, anywhere, frame, gap_ladder, power_of_ten, stretched, touching};
use super::{Family, Sequence};
use crate::orbits::pose_pair;
use crate::random::{Random, rotation};

pub const FAMILIES: &[Family] = &[
    Family {
        name: "needles_plates",
        sweep: 15,
        why: "aspect ratios of 1e2 to 1e6: simplices are slivers, a small turn changes the nearest feature",
        sources: &[
            "https://github.com/jrouwe/JoltPhysics/issues/2065",
            "https://github.com/jrouwe/JoltPhysics/issues/2080",
            "https://github.com/newton-physics/newton/issues/3248",
            "https://github.com/dimforge/rapier/issues/455",
        ],
        make: needles_plates,
    },
    Family {
        name: "stretched",
        sweep: 10,
        why: "up to 1e14 times as long as wide: what was flat is crumpled by the rounding of its length, sides are short beside \
              their faces, and the sides of a needle's tip are parallel up to rounding",
        sources: &[
            "found in this library, by fuzzing and by reading: tests/pair/stretched.rs, tests/pair/flat_edges.rs",
            "https://github.com/jrouwe/JoltPhysics/issues/2080",
        ],
        make: stretched_beyond_rounding,
    },
    Family {
        name: "slivers",
        sweep: 12,
        why: "tetrahedra with a height of 1e-6 to 1e-14, points within rounding of a face: normals of faces lose their digits",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/395",
            "https://github.com/flexible-collision-library/fcl/issues/415",
            "https://github.com/MattiaMontanari/openGJK/issues/41",
            "https://github.com/bepu/bepuphysics1/issues/21",
        ],
        make: slivers,
    },
    Family {
        name: "dihedrals",
        sweep: 20,
        why: "neighbouring faces that meet at 180° less 1e-8 to 1e-12, or at as little: Voronoi regions of edges are thinner than \
              rounding, and a walk crosses them without noticing",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/415",
            "https://github.com/jrouwe/JoltPhysics/issues/2065",
            "Mirtich, V-Clip: Fast and Robust Polyhedral Collision Detection (1998)",
        ],
        make: dihedrals,
    },
    Family {
        name: "coincident",
        sweep: 6,
        why: "the same object in the same pose, or a hair away: the first direction of a search is zero",
        sources: &["https://github.com/danfis/libccd/issues/68", "https://github.com/bulletphysics/bullet3/issues/889"],
        make: coincident,
    },
    Family {
        name: "containment",
        sweep: 14,
        why: "one object deep inside the other, concentric or not: all directions nearly tie",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/545",
            "https://github.com/dimforge/ncollide/issues/181",
        ],
        make: containment,
    },
    Family {
        name: "depth_ties",
        sweep: 14,
        why: "several directions of least depth tie exactly: cube centred in cube, prisms, regular solids",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/545",
            "https://github.com/google-deepmind/mujoco_warp/issues/1526",
            "https://github.com/danfis/libccd/issues/71",
        ],
        make: depth_ties,
    },
];

fn needles_plates(random: &mut Random, index: usize) -> Sequence {
    let thin = 10f64.powi(-2 - (index % 5) as i32);
    let body = |random: &mut Random, kind: usize| {
        let axes = random.pick(&[[1.0, thin, thin], [1.0, 1.0, thin], [1.0, thin.sqrt(), thin]]);
        match kind % 3 {
            0 => scaled(sphere(random, 60), axes),
            1 => cuboid(axes),
            _ => scaled(ordinary(random), axes),
        }
    };
    let bodies = [body(random, index), if index % 7 == 6 { ordinary(random) } else { body(random, index / 3) }];
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses = Vec::new();
    poses.extend((0..8).map(|_| {
        let gap = 0.3 * random.signed();
        touching(random, [&surfaces[0], &surfaces[1]], gap)
    }));
    poses.extend((0..8).map(|_| {
        // As near as they are thick.
        let gap = thin * random.signed();
        touching(random, [&surfaces[0], &surfaces[1]], gap)
    }));
    poses.extend((0..4).map(|_| anywhere(random, 0.5)));
    // Nearly parallel.
    let turn = random.rotation();
    poses.extend((0..10).map(|_| {
        let tilt = rotation(&random.direction(), power_of_ten(random, -12, -2));
        let shift = Vector::new(random.signed(), thin * random.signed(), 3.0 * thin * random.signed());
        pose_pair(&turn, &Vector::zeros(), &(turn * tilt), &(turn * shift))
    }));
    Sequence { name: format!("1e{}", 2 + index % 5), bodies, poses }
}

fn stretched_beyond_rounding(random: &mut Random, index: usize) -> Sequence {
    let exponent = 2 + 3 * (index / 2 % 5) as i32;
    let length = 10f64.powi(exponent);
    if index.is_multiple_of(2) {
        // A plate as thick as its length is rounded, and something beside its short end.
        let thickness = length * random.pick(&[1e-16, 3e-16, 1e-15]);
        let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [0.5 * random.signed(), length]];
        let plate = hull_of(corners.map(|[x, y]| Vector::new(x, y, thickness * random.signed())).to_vec());
        let poses = (0..30).map(|k| {
            let turn = frame(random, k);
            let other = random.rotation();
            let turn2 = random.pick(&[turn, other]);
            let beside = Vector::new(random.pick(&[2.5, -2.5]), random.signed(), 2.0 * random.signed());
            pose_pair(&turn, &Vector::zeros(), &turn2, &(turn * beside))
        });
        let poses = poses.collect();
        return Sequence { name: format!("plate_1e{exponent}"), bodies: [plate, ordinary(random)], poses };
    }
    // A needle, and beyond its tip a body so much larger.
    let (tip, blunt) = (random.direction(), 1e-9 * random.direction());
    let needle = hull_of(vec![tip, blunt, blunt + random.pick(&[1e-17, 1e-16, 1e-12]) * random.direction()]);
    let size = length.min(1e5);
    let large = scaled(cloud(random, 5), [size; 3]);
    let corner = large.vertices[0];
    let poses = (0..30).map(|k| {
        let turn = frame(random, k);
        let along = tip + (tip - blunt) * (size * random.uniform(0.0, 1.0));
        let aside = random.pick(&[0.0, 1e-9, 0.1]) * random.direction();
        pose_pair(&turn, &Vector::zeros(), &turn, &(turn * (along + aside - corner)))
    });
    let poses = poses.collect();
    Sequence { name: format!("needle_1e{exponent}"), bodies: [needle, large], poses }
}

fn slivers(random: &mut Random, index: usize) -> Sequence {
    let exponent = random.pick(&[6, 8, 9, 10, 11, 12, 14]);
    let hair = 10f64.powi(-exponent);
    let body = |random: &mut Random, kind: usize| match kind % 4 {
        0 => {
            let inside = Vector::new(random.uniform(0.3, 0.6), random.uniform(0.1, 0.4), hair);
            hull_of(vec![Vector::zeros(), Vector::x(), Vector::new(0.5, 1.0, 0.0), inside])
        }
        1 => {
            // A box with points within a hair of its top, on either side.
            let over = (0..6).map(|_| Vector::new(random.signed(), random.signed(), 0.5 + hair * random.signed()));
            let points: Vec<Vector> = cuboid([1.0, 1.0, 0.5]).vertices.into_iter().chain(over).collect();
            hull_of(points)
        }
        2 => {
            let count = 4 + random.below(9);
            scaled(cloud(random, count), [1.0, 1.0, hair])
        }
        _ => {
            let count = 4 + random.below(9);
            scaled(cloud(random, count), [1.0, hair.sqrt(), hair])
        }
    };
    let bodies = [body(random, index), if index % 3 == 2 { ordinary(random) } else { body(random, index / 4) }];
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap)).collect();
    poses.extend((0..6).map(|_| anywhere(random, 0.7)));
    // Side by side, so that what is flat is parallel.
    let turn = random.rotation();
    poses.extend((0..6).map(|_| {
        let shift = Vector::new(random.signed(), random.signed(), random.pick(&[0.0, hair, 1e-9, 0.5]));
        pose_pair(&turn, &Vector::zeros(), &turn, &(turn * shift))
    }));
    Sequence { name: format!("1e{exponent}"), bodies, poses }
}

fn dihedrals(random: &mut Random, index: usize) -> Sequence {
    let exponent = 8 + index % 5;
    let hair = 10f64.powi(-(exponent as i32));
    let body = |random: &mut Random, kind: usize| match kind % 4 {
        // A square with its middle raised.
        0 => {
            let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vector::new(x, y, 0.0));
            hull_of(square.into_iter().chain([Vector::new(0.0, 0.0, hair), Vector::new(0.0, 0.0, -1.0)]).collect())
        }
        1 => dome(2 + random.below(4), hair),
        // A wedge whose faces meet at hair.
        2 => {
            let side = |z: f64| [Vector::new(1.0, -1.0, z), Vector::new(1.0, 1.0, z)];
            let edge = [Vector::new(0.0, -1.0, 0.0), Vector::new(0.0, 1.0, 0.0)];
            hull_of(edge.into_iter().chain(side(hair)).chain(side(-0.5 * hair)).collect())
        }
        // A cap of facets that are turned by hair.
        _ => scaled(dome(3, 0.5), [1.0, hair.sqrt(), hair]),
    };
    let bodies = [body(random, index), if index % 3 == 2 { ordinary(random) } else { body(random, index / 4) }];
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap)).collect();
    poses.extend((0..6).map(|_| anywhere(random, 1.5)));
    // Across the nearly flat top, a hair above it.
    let turn = random.rotation();
    let upside_down = rotation(&Vector::x(), std::f64::consts::PI);
    poses.extend((0..12).map(|k| {
        let over = Vector::new(0.2 * f64::from(k) - 1.1, 0.3 * random.signed(), random.pick(&[1e-3, hair, 3.0 * hair]));
        pose_pair(&turn, &Vector::zeros(), &(turn * upside_down), &(turn * over))
    }));
    Sequence { name: format!("1e{exponent}_{}", index % 4), bodies, poses }
}

fn coincident(random: &mut Random, index: usize) -> Sequence {
    let body = match index % 3 {
        0 => regular_solid(random.below(5)),
        1 => ordinary(random),
        _ => scaled(ordinary(random), [1.0, 0.1, power_of_ten(random, -6, -1)]),
    };
    let turn = frame(random, index / 3);
    let origin = random.pick(&[0.0, 1.0, 1e3]) * random.vector();
    let mut poses = vec![pose_pair(&turn, &origin, &turn, &origin)];
    for _ in 0..20 {
        let hair = power_of_ten(random, -16, -1);
        let shift = hair * if random.below(2) == 0 { Vector::x() } else { random.direction() };
        let tilt = rotation(&random.direction(), hair);
        let turn2 = random.pick(&[turn, turn * tilt]);
        poses.push(pose_pair(&turn, &origin, &turn2, &(origin + shift)));
    }
    // The same set of points, numbered otherwise.
    let quarter = random.quarter_turns();
    poses.push(pose_pair(&turn, &origin, &(turn * quarter), &origin));
    Sequence { name: format!("{}", index % 3), bodies: [body.clone(), body], poses }
}

fn containment(random: &mut Random, index: usize) -> Sequence {
    let size = 10f64.powi(-((index % 7) as i32)) * 0.4;
    let outer = if index.is_multiple_of(2) { sphere(random, 102) } else { ordinary(random) };
    let inner = scaled(ordinary(random), [size; 3]);
    let mut poses = vec![stretched(anywhere(random, 1.0), 0.0)];
    // Concentric, near the middle, near the surface.
    poses.extend((0..19).map(|_| {
        let reach = random.pick(&[1e-9, 1e-3, 0.1, 0.3, 0.7]);
        anywhere(random, reach)
    }));
    let bodies = if random.below(2) == 0 { [outer, inner] } else { [inner, outer] };
    Sequence { name: format!("1e-{}", index % 7), bodies, poses }
}

fn depth_ties(random: &mut Random, index: usize) -> Sequence {
    let body = |random: &mut Random, kind: usize| match kind % 7 {
        5 => cylinder(3 + random.below(12), 1.0, 0.75),
        6 => shifted(cuboid([1.0, 0.5, 0.5]), &random.lattice(1)),
        _ => regular_solid(kind),
    };
    let size2 = random.pick(&[1.0, 0.5, 2.0]);
    let bodies = [body(random, index), scaled(body(random, index / 2), [size2; 3])];
    let poses = (0..20).map(|k| {
        // Centred, along a line of symmetry, or off by a hair.
        let shift = match k % 4 {
            0 => Vector::zeros(),
            1 => random.lattice(1) * 0.25,
            2 => random.lattice(1) * power_of_ten(random, -15, -3),
            _ => Vector::repeat(0.5),
        };
        pose_pair(&random.quarter_turns(), &Vector::zeros(), &random.quarter_turns(), &shift)
    });
    Sequence { name: format!("{}_{}", index % 7, index / 2 % 7), poses: poses.collect(), bodies }
}
