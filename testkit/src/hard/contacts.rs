//! Features exactly on features: parallel faces, shared coordinates, vertices on faces, crossing edges, cylinders on cylinders.

use std::f64::consts::{PI, TAU};

use swiftprox::math::Vector;

use super::bodies::{cloud, cuboid, cylinder, grid_box, hull_of, ordinary, regular_solid, roof, scaled};
use super::placing::{Surface, frame, gap_ladder, shuffle, side_by_side, touching};
use super::{Family, Sequence};
use crate::orbits::pose_pair;
use crate::random::{Random, rotation};

pub const FAMILIES: &[Family] = &[
    Family {
        name: "parallel_faces",
        sweep: 8,
        why: "two faces exactly parallel at gaps of 1e-3 to 1e-15 and touching: every point of a patch is nearest, simplices \
              collapse to slivers and the support switches from corner to corner without progress",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/2",
            "https://github.com/flexible-collision-library/fcl/issues/408",
            "https://github.com/coal-library/coal/issues/37",
            "https://github.com/andreacasalino/Flexible-GJK-and-EPA/issues/8",
        ],
        make: parallel_faces,
    },
    Family {
        name: "stacked_boxes",
        sweep: 6,
        why: "identical boxes stacked on shared coordinates: faces, edges and corners coincide exactly and all supports tie",
        sources: &[
            "https://github.com/danfis/libccd/issues/25",
            "https://github.com/flexible-collision-library/fcl/issues/493",
            "https://github.com/flexible-collision-library/fcl/issues/495",
            "https://github.com/RobotLocomotion/drake/issues/18704",
        ],
        make: stacked_boxes,
    },
    Family {
        name: "vertex_contact",
        sweep: 6,
        why: "a vertex exactly on a face, an edge or a vertex, or 2^-k off: the nearest feature is not unique and signs of \
              barycentric coordinates are zero",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/390",
            "https://github.com/flexible-collision-library/fcl/issues/408",
            "https://github.com/felipeek/raw-physics/issues/6",
            "Ericson, Real-Time Collision Detection (2005), 9.2",
        ],
        make: vertex_contact,
    },
    Family {
        name: "edge_edge",
        sweep: 6,
        why: "two edges that cross at an angle of 1e-1 to 1e-15, parallel or on one line: the cross product that gives the normal \
              loses all its digits",
        sources: &[
            "https://github.com/bepu/bepuphysics2/issues/329",
            "https://github.com/MattiaMontanari/openGJK/issues/20",
            "Mirtich, V-Clip: Fast and Robust Polyhedral Collision Detection (1998)",
        ],
        make: edge_edge,
    },
    Family {
        name: "conforming",
        sweep: 8,
        why: "cylinders along a ruling, cap on cap, a cylinder on a face: the nearest points are segments or discs that are cut into \
              many small features",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/319",
            "https://github.com/flexible-collision-library/fcl/issues/375",
            "https://github.com/dartsim/dart/issues/2389",
            "https://github.com/RobotLocomotion/drake/issues/10578",
        ],
        make: conforming,
    },
    Family {
        name: "grazing",
        sweep: 8,
        why: "hulls brought to a gap of 1e-3 to 1e-15 or as deep: GJK cannot tell near from touching, EPA starts on a flat simplex",
        sources: &[
            "https://github.com/flexible-collision-library/fcl/issues/366",
            "https://github.com/flexible-collision-library/fcl/issues/399",
            "https://github.com/google-deepmind/mujoco/issues/3383",
            "https://github.com/bulletphysics/bullet3/issues/889",
        ],
        make: grazing,
    },
    Family {
        name: "symmetric",
        sweep: 25,
        why: "regular solids face-on, edge-on and vertex-on along a common axis: supports tie in all directions, and the line of the \
              centres is the answer",
        sources: &[
            "https://github.com/danfis/libccd/issues/25",
            "https://github.com/flexible-collision-library/fcl/issues/508",
        ],
        make: symmetric,
    },
    Family {
        name: "integer",
        sweep: 6,
        why: "random polytopes with small integer vertices at integer offsets: exact ties and exact touching everywhere",
        sources: &[
            "https://github.com/MattiaMontanari/openGJK/issues/13",
            "https://github.com/flexible-collision-library/fcl/issues/508",
            "https://github.com/erincatto/box2d/issues/296",
        ],
        make: integer,
    },
];

fn parallel_faces(random: &mut Random, index: usize) -> Sequence {
    let half = [1.0, 0.75, 0.5];
    // Bodies with a face up and one down at known heights.
    let (name, bodies, heights) = match index / 2 % 4 {
        0 => ("boxes", [cuboid(half), cuboid([0.5, 1.0, 0.25])], 0.75),
        1 => ("box_on_prism", [cuboid(half), cylinder(6, 0.8, 0.25)], 0.75),
        2 => ("box_on_grid", [cuboid(half), grid_box([0.6, 0.7, 0.25], 1 + random.below(4))], 0.75),
        _ => ("prisms", [cylinder(5, 1.0, 0.5), cylinder(9, 0.7, 0.125)], 0.625),
    };
    let turn = frame(random, index);
    let origin = random.vector();
    let poses = gap_ladder(random).into_iter().map(|gap| {
        // Wholly above, over the border, and beside at a distance of edges or corners.
        let reach = random.pick(&[0.3, 1.5, 3.0]);
        let shift = Vector::new(reach * random.signed(), reach * random.signed(), heights + gap);
        side_by_side(&turn, &origin, &shift)
    });
    Sequence { name: name.into(), poses: poses.collect(), bodies }
}

fn stacked_boxes(random: &mut Random, index: usize) -> Sequence {
    // Sizes that doubles have, and such that they round.
    let size = random.pick(&[1.0, 0.5, 0.1, 0.3, 1.0 / 3.0, 0.7, 1e-3]);
    let half = [size, size * random.pick(&[1.0, 0.5, 2.0]), size];
    let body = cuboid(half);
    let turn = frame(random, index);
    let mut poses = Vec::new();
    for _ in 0..30 {
        let [place1, mut place2] = [random.lattice(4), random.lattice(1)];
        // Half a box along: a vertex on an edge, an edge on a face.
        if random.below(3) == 0 {
            place2[random.below(3)] *= 0.5;
        }
        let at =
            |place: &Vector| Vector::new(place.x * 2.0 * half[0], place.y * 2.0 * half[1], place.z * 2.0 * half[2]);
        let shared = at(&place1);
        poses.push(pose_pair(&turn, &(turn * shared), &turn, &(turn * at(&(place1 + place2)))));
    }
    let name = if index.is_multiple_of(2) { "shared_coordinates" } else { "tilted" };
    Sequence { name: name.into(), bodies: [body.clone(), body], poses }
}

fn vertex_contact(random: &mut Random, index: usize) -> Sequence {
    let half = [1.0, 0.5, 0.25];
    // Its vertex at the origin, everything else of it higher.
    let mut above: Vec<Vector> = (0..3 + random.below(5)).map(|_| random.lattice(8) / 8.0).collect();
    above.iter_mut().for_each(|p| p.z = p.z.abs() + 0.125);
    above.extend([
        Vector::new(1.0, 0.0, 1.0),
        Vector::new(-1.0, 1.0, 1.0),
        Vector::new(-1.0, -1.0, 1.0),
        Vector::zeros(),
    ]);
    let turn = frame(random, index);
    let mut poses = Vec::new();
    for k in 0..40 {
        let inside = random.lattice(7) / 8.0;
        let corner = [random.pick(&[-1.0, 1.0]), random.pick(&[-1.0, 1.0])];
        let (x, y) = match random.below(3) {
            0 => (inside.x, 0.5 * inside.y),
            1 => (corner[0], 0.5 * inside.y),
            _ => (corner[0], 0.5 * corner[1]),
        };
        let off = [0.0, 1.0, -1.0][k % 3] * 2f64.powi(-3 - random.below(48) as i32);
        poses.push(side_by_side(&turn, &Vector::zeros(), &Vector::new(x, y, half[2] + off)));
    }
    let name = if index.is_multiple_of(2) { "exact" } else { "tilted" };
    Sequence { name: name.into(), bodies: [cuboid(half), hull_of(above)], poses }
}

fn edge_edge(random: &mut Random, index: usize) -> Sequence {
    // Body 2 upside down: ridge against ridge.
    let upside_down = rotation(&Vector::x(), PI);
    let bodies = if index.is_multiple_of(3) {
        // The long edges of two boxes, each turned by half a right angle about its own.
        let tilt = rotation(&Vector::x(), PI / 4.0);
        let points = |half: [f64; 3]| {
            let down = Vector::new(0.0, 0.0, half[1].hypot(half[2]));
            hull_of(cuboid(half).vertices.iter().map(|v| tilt * v - down).collect())
        };
        [points([1.0, 0.5, 0.5]), points([1.0, 0.25, 0.25])]
    } else {
        [roof(), roof()]
    };
    let turn = frame(random, index);
    let mut poses = Vec::new();
    for gap in gap_ladder(random) {
        let angle = random.pick(&[0.0, 1.0, -1.0, 1.0]) * power_of_angle(random);
        let anywhere = random.signed();
        let along = Vector::new(random.pick(&[0.0, 0.3, 1.0, 2.0, 2.5, anywhere]), 0.0, gap);
        let turn2 = turn * rotation(&Vector::z(), angle) * upside_down;
        poses.push(pose_pair(&turn, &Vector::zeros(), &turn2, &(turn * along)));
    }
    Sequence { name: if index.is_multiple_of(3) { "boxes".into() } else { "roofs".into() }, bodies, poses }
}

fn power_of_angle(random: &mut Random) -> f64 {
    10f64.powi(-1 - random.below(15) as i32)
}

fn conforming(random: &mut Random, index: usize) -> Sequence {
    let sides = random.pick(&[16, 64, 100, 101, 360]);
    let [radius1, radius2, half1, half2] = [1.0, random.pick(&[1.0, 0.5, 0.1]), 1.0, random.pick(&[1.0, 0.25])];
    let sides2 = random.pick(&[sides, 100, 33]);
    let first = cylinder(sides, radius1, half1);
    let (name, second) = match index % 4 {
        0 => ("rulings", cylinder(sides2, radius2, half2)),
        1 => ("caps", cylinder(sides2, radius2, half2)),
        2 => ("on_a_face", cuboid([2.0, 1.5, 0.5])),
        _ => ("cap_on_a_face", cuboid([2.0, 1.5, 0.5])),
    };
    let turn = frame(random, index / 4);
    let lying = rotation(&Vector::y(), PI / 2.0);
    let mut poses = Vec::new();
    for gap in gap_ladder(random) {
        // Turned by whole facets, half ones, or anyhow.
        let facet = TAU / sides as f64;
        let anyhow = random.signed();
        let about_axis = rotation(&Vector::z(), facet * random.pick(&[0.0, 0.5, 1.0, 3.0, anyhow]));
        let sideways = random.pick(&[0.0, 0.25, 1.0, 1.5]) * random.signed();
        let (turn1, turn2, shift) = match index % 4 {
            0 => {
                // Half a facet more, and the rulings are faces.
                let crossed = rotation(&Vector::x(), random.pick(&[0.0, 0.0, 1e-12, 1e-6, 0.5]));
                (about_axis, crossed, Vector::new(radius1 + radius2 + gap, 0.0, sideways))
            }
            1 => (about_axis, rotation(&Vector::z(), PI), Vector::new(sideways, 0.1 * sideways, half1 + half2 + gap)),
            2 => (
                lying * about_axis,
                rotation(&Vector::z(), 0.0),
                Vector::new(sideways, sideways, -(radius1 + 0.5 + gap)),
            ),
            _ => (about_axis, rotation(&Vector::z(), 0.0), Vector::new(2.0 * sideways, sideways, half1 + 0.5 + gap)),
        };
        poses.push(pose_pair(&(turn * turn1), &Vector::zeros(), &(turn * turn2), &(turn * shift)));
    }
    Sequence { name: format!("{name}_{sides}"), bodies: [first, second], poses }
}

fn grazing(random: &mut Random, index: usize) -> Sequence {
    let count = [12, 40, 102, 402][index % 4];
    let bodies = [cloud(random, count), if index % 8 < 4 { cloud(random, count) } else { ordinary(random) }];
    let surfaces = bodies.each_ref().map(Surface::of);
    let poses = gap_ladder(random).into_iter().map(|gap| touching(random, [&surfaces[0], &surfaces[1]], gap)).collect();
    Sequence { name: format!("n{count}"), bodies, poses }
}

fn symmetric(random: &mut Random, index: usize) -> Sequence {
    let kinds = [index % 5, (index / 5 + index) % 5];
    let size2 = random.pick(&[1.0, 0.5, 0.3]);
    let bodies = [regular_solid(kinds[0]), scaled(regular_solid(kinds[1]), [size2; 3])];
    let frames = [random.quarter_turns(), random.quarter_turns()];
    let mut poses = Vec::new();
    for _ in 0..10 {
        // Along axes, diagonals of faces and of space.
        let line = loop {
            let line = random.lattice(1);
            if line != Vector::zeros() {
                break line;
            }
        };
        for distance in [random.below(8) as f64 / 4.0, 1.0 + size2, random.uniform(0.0, 4.0)] {
            let turn2 = if random.below(2) == 0 { frames[1] } else { random.quarter_turns() };
            poses.push(pose_pair(&frames[0], &Vector::zeros(), &turn2, &(line * distance)));
        }
    }
    shuffle(random, &mut poses);
    Sequence { name: format!("{}_{}", kinds[0], kinds[1]), bodies, poses }
}

fn integer(random: &mut Random, _: usize) -> Sequence {
    let range = 1 + random.below(4);
    let bodies = [(); 2].map(|()| {
        let count = 4 + random.below(12);
        hull_of((0..count).map(|_| random.lattice(range)).collect())
    });
    let poses = (0..30).map(|_| {
        let (turn1, turn2) = (random.quarter_turns(), random.quarter_turns());
        pose_pair(&turn1, &random.lattice(range), &turn2, &random.lattice(2 * range))
    });
    Sequence { name: format!("within_{range}"), poses: poses.collect(), bodies }
}
