//! Surfaces that local walks stall on: flat faces cut up, caps of a hundred corners, vertices that are none, bodies without
//! interior.

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use super::bodies::{cuboid, cylinder, double_cone, fan_prism, grid_box, hull_of, ordinary, scaled, sphere};
use super::placing::{Spot, frame};
use super::placing::{Surface, anywhere, gap_ladder, opposed, power_of_ten, shuffle, side_by_side, touching};
use super::{Family, Sequence};
use crate::orbits::pose_pair;
use crate::random::Random;

pub const FAMILIES: &[Family] = &[
    Family {
        name: "coplanar_faces",
        sweep: 8,
        why: "flat faces cut into many triangles, vertices inside faces and edges: local walks see plateaus, every vertex of a face \
              ties",
        sources: &[
            "https://github.com/bepu/bepuphysics2/issues/60",
            "https://github.com/leomccormack/convhull_3d/issues/1",
            "https://github.com/dimforge/parry/issues/166",
        ],
        make: coplanar_faces,
    },
    Family {
        name: "caps_and_fans",
        sweep: 12,
        why: "caps with 100 corners and more, vertices with 100 neighbours and more: support maps with tables of neighbours refuse \
              them, walks look at every neighbour, and a rim turned a little passes through all of them",
        sources: &[
            "https://github.com/bepu/bepuphysics2/issues/60",
            "https://github.com/RobotLocomotion/drake/issues/10578",
            "https://github.com/dartsim/dart/issues/2389",
        ],
        make: caps_and_fans,
    },
    Family {
        name: "extra_vertices",
        sweep: 15,
        why: "vertices that a hull should clean: duplicates, inside the hull, on edges, on faces, within 1e-15 of another or of a \
              face",
        sources: &[
            "https://github.com/bepu/bepuphysics2/issues/60",
            "https://github.com/Mugen87/yuka/issues/11",
            "https://github.com/erincatto/box2d/issues/296",
        ],
        make: extra_vertices,
    },
    Family {
        name: "flat",
        sweep: 50,
        why: "bodies without interior, points, segments, polygons: no normal, no simplex of full dimension; a library may refuse \
              them, but must not hang or lie",
        sources: &[
            "https://github.com/MattiaMontanari/openGJK/issues/3",
            "https://github.com/FEniCS/dolfinx/issues/3653",
            "https://github.com/coal-library/coal/issues/49",
            "https://github.com/bulletphysics/bullet3/issues/93",
        ],
        make: flat,
    },
];

fn coplanar_faces(random: &mut Random, index: usize) -> Sequence {
    let body = |random: &mut Random, kind: usize| match kind % 4 {
        0 => grid_box([1.0, 0.75, 0.5], 2 + random.below(7)),
        1 => fan_prism(5 + random.below(60), 0.5),
        2 => grid_box([0.5; 3], 1 << random.below(4)),
        _ => ordinary(random),
    };
    let bodies = [body(random, index), body(random, index / 2)];
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap)).collect();
    poses.extend((0..8).map(|_| anywhere(random, 3.0)));
    // Face on face, exactly: vertices of the cuts above vertices of the cuts.
    let turn = random.quarter_turns();
    poses.extend((0..8).map(|_| {
        let shift =
            Vector::new(random.lattice(4).x / 4.0, random.lattice(4).y / 4.0, 1.0 + random.below(2) as f64 * 1e-9);
        side_by_side(&turn, &Vector::zeros(), &shift)
    }));
    Sequence { name: format!("{}_{}", index % 4, index / 2 % 4), bodies, poses }
}

fn caps_and_fans(random: &mut Random, index: usize) -> Sequence {
    let sides = random.pick(&[100, 128, 256, 400]);
    let body = |random: &mut Random, kind: usize| match kind % 6 {
        0 => cylinder(sides, 1.0, 0.5),
        1 => double_cone(sides, 1.0, 0.0),
        2 => fan_prism(sides, 0.25),
        3 => double_cone(sides, power_of_ten(random, -8, -1), 0.5),
        4 => cylinder(sides, 1.0, power_of_ten(random, -6, -1)),
        _ => ordinary(random),
    };
    let bodies = [body(random, index), body(random, index / 2 + 1)];
    let surfaces = bodies.each_ref().map(Surface::of);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap)).collect();
    poses.extend((0..8).map(|_| anywhere(random, 3.0)));
    // Tip on the middle of what is below.
    for gap in [0.0, 1e-9, -1e-9] {
        let top = |mesh: &PolygonMesh| mesh.vertices.iter().map(|v| v.z).fold(f64::NEG_INFINITY, f64::max);
        let spots = bodies.each_ref().map(|b| Spot { point: Vector::new(0.0, 0.0, top(b)), normal: Vector::z() });
        poses.push(opposed(random, spots, gap));
    }
    Sequence { name: format!("n{sides}_{}_{}", index % 6, (index / 2 + 1) % 6), bodies, poses }
}

fn extra_vertices(random: &mut Random, index: usize) -> Sequence {
    let clean = match index % 3 {
        0 => cuboid([1.0; 3]),
        1 => sphere(random, 24),
        _ => ordinary(random),
    };
    let count = clean.vertices.len();
    let mut points = clean.vertices.clone();
    for _ in 0..count.min(60) {
        let [a, b, c] = [(); 3].map(|()| clean.vertices[random.below(count)]);
        let hair = random.pick(&[0.0, 1e-15, 1e-16, 1e-12]);
        points.push(match (index / 3 + random.below(2)) % 5 {
            0 => a,
            1 => a * (1.0 - hair),
            2 => 0.5 * (a + b),
            3 => 0.25 * (a + b) + 0.5 * c,
            _ => a + hair * random.vector(),
        });
    }
    shuffle(random, &mut points);
    let body = hull_of(points);
    let surface = Surface::of(&body);
    let other = if index.is_multiple_of(2) { body.clone() } else { ordinary(random) };
    let other_surface = Surface::of(&other);
    let mut poses: Vec<_> =
        gap_ladder(random).into_iter().map(|gap| touching(random, [&surface, &other_surface], gap)).collect();
    poses.extend((0..6).map(|_| anywhere(random, 2.5)));
    poses.extend((0..6).map(|_| side_by_side(&frame(random, 0), &Vector::zeros(), &random.lattice(2))));
    Sequence { name: format!("{}", index % 3), bodies: [body, other], poses }
}

fn flat(random: &mut Random, index: usize) -> Sequence {
    // Half of them on a lattice: touching and lying in each other exactly.
    let is_exact = index.is_multiple_of(2);
    let body = |random: &mut Random, kind: usize| {
        let mut point = || if is_exact { random.lattice(2) } else { random.vector() };
        let points = match kind % 5 {
            0 => vec![point()],
            1 => vec![point(), point()],
            2 => vec![point(), point(), point()],
            3 => {
                let (origin, u, v) = (point(), point(), point());
                [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.5, 0.5), (2.0, 1.0), (0.0, 0.5)]
                    .map(|(s, t)| origin + s * u + t * v)
                    .into()
            }
            // One with interior.
            _ => cuboid([1.0, 0.5, 0.75]).vertices,
        };
        let size = if is_exact { 1.0 } else { power_of_ten(random, -3, 3) };
        scaled(hull_of(points), [size; 3])
    };
    let kinds = [index / 2 % 5, (index / 2 + index / 10) % 5];
    let bodies = kinds.map(|kind| body(random, kind));
    let surfaces = bodies.each_ref().map(Surface::of);
    let poses = (0..30).map(|_| {
        if is_exact {
            let (turn1, turn2) = (random.quarter_turns(), random.quarter_turns());
            return pose_pair(&turn1, &random.lattice(1), &turn2, &random.lattice(2));
        }
        let size = surfaces[0].radius + surfaces[1].radius;
        match random.below(3) {
            0 => anywhere(random, size),
            1 => side_by_side(&frame(random, 1), &random.vector(), &(size * random.vector())),
            _ => {
                let gap = random.pick(&[0.0, 1e-3, 1e-9, 1e-15]);
                touching(random, [&surfaces[0], &surfaces[1]], gap)
            }
        }
    });
    Sequence { name: format!("{}_{}", kinds[0], kinds[1]), poses: poses.collect(), bodies }
}
