//! Small pairs of polytopes that are hard in every way known to us, from fixed seeds.

pub use crate::random::Random;
use swiftprox::base::double_double::{wide_dot, widen};
use swiftprox::math::{Matrix, Pose, Vector};

use crate::models;
use crate::oracle::{Matrix3x4, Polytope, Truth, truth};

/// Two point sets, each standing for its convex hull, at their poses.
pub struct Case {
    pub points_a: Vec<Vector>,
    pub pose_a: Pose,
    pub points_b: Vec<Vector>,
    pub pose_b: Pose,
}

impl Case {
    /// Verdict and distance by the oracle.
    pub fn truth(&self) -> Truth {
        let polytope = |points: &[Vector]| Polytope::new(&coordinates(points));
        let (a, b) = (polytope(&self.points_a), polytope(&self.points_b));
        truth(&a, &row_major(&self.pose_a), &b, &row_major(&self.pose_b))
    }

    /// Everything that is needed to repeat the case, exactly.
    pub fn describe(&self) -> String {
        format!(
            "A = {:?}\npose A = {:?}\nB = {:?}\npose B = {:?}",
            self.points_a, self.pose_a.rows, self.points_b, self.pose_b.rows
        )
    }
}

/// Points as the oracle takes them.
pub fn coordinates(points: &[Vector]) -> Vec<[f64; 3]> {
    points.iter().map(|p| (*p).into()).collect()
}

/// A pose as the oracle takes it.
pub fn row_major(pose: &Pose) -> Matrix3x4 {
    std::array::from_fn(|k| pose.rows[k / 4][k % 4])
}

pub type Generator = fn(&mut Random) -> Case;

/// A name and a generator for every kind of difficulty.
pub const FAMILIES: &[(&str, Generator)] = &[
    ("lattice polytopes", lattice),
    ("boxes in a grid", boxes),
    ("tetrahedra at any rotation", tetrahedra),
    ("rotations off orthonormal", off_orthonormal),
    ("slivers", slivers),
    ("vertex near a face", vertex_near_face),
    ("crossing edges", crossing_edges),
    ("parallel faces", parallel_faces),
    ("flat bodies, segments, points", flat),
    ("flat vertices inside faces and edges", flat_vertices),
    ("short sides of long faces", leaning_sides),
    ("one inside the other", contained),
    ("far from the origin", far),
    ("far local origins that cancel", far_local_origin),
    ("any scale", scales),
];

fn translated(t: Vector) -> Pose {
    Pose::new(&Matrix::identity(), &t)
}

/// The eight corners of a box about the origin.
fn box_points(half: Vector) -> Vec<Vector> {
    models::cuboid(half.into()).expect("a box").vertices
}

/// A distance that is nothing, tiny or small, of either sign.
pub fn gap(random: &mut Random) -> f64 {
    random.pick(&[0.0, 1.0, -1.0]) * random.power(-60, -10)
}

fn lattice_points(random: &mut Random, n: usize) -> Vec<Vector> {
    let count = 4 + random.below(5);
    (0..count).map(|_| random.lattice(n)).collect()
}

fn random_points(random: &mut Random, count: usize) -> Vec<Vector> {
    (0..count).map(|_| random.vector()).collect()
}

/// Small integers throughout: about half of these touch or overlap, many exactly along faces and edges.
fn lattice(random: &mut Random) -> Case {
    Case {
        points_a: lattice_points(random, 2),
        pose_a: Pose::new(&random.quarter_turns(), &random.lattice(2)),
        points_b: lattice_points(random, 2),
        pose_b: Pose::new(&random.quarter_turns(), &random.lattice(2)),
    }
}

/// Faces, edges and corners in line; gaps of 0 or a half.
fn boxes(random: &mut Random) -> Case {
    let half = |random: &mut Random| 0.5 * (random.lattice(1) + Vector::repeat(2.0));
    Case {
        points_a: box_points(half(random)),
        pose_a: Pose::new(&random.quarter_turns(), &Vector::zeros()),
        points_b: box_points(half(random)),
        pose_b: Pose::new(&random.quarter_turns(), &(0.5 * random.lattice(6))),
    }
}

fn tetrahedra(random: &mut Random) -> Case {
    let reach = random.power(-2, 3);
    Case {
        points_a: random_points(random, 4),
        pose_a: Pose::new(&random.rotation(), &random.vector()),
        points_b: random_points(random, 4),
        pose_b: Pose::new(&random.rotation(), &(reach * random.vector())),
    }
}

/// Rotations as far from orthonormal as a pose may be by default.
fn off_orthonormal(random: &mut Random) -> Case {
    let mut case = tetrahedra(random);
    for pose in [&mut case.pose_a, &mut case.pose_b] {
        let error = random.power(-40, -9);
        pose.rows.iter_mut().flat_map(|row| &mut row[..3]).for_each(|x| *x += error * random.signed());
    }
    case
}

/// Tetrahedra and boxes flattened by up to 2⁻⁴⁵, near each other.
fn slivers(random: &mut Random) -> Case {
    let points = |random: &mut Random| {
        let mut points = if random.below(2) == 0 {
            random_points(random, 4)
        } else {
            box_points(random.vector() + Vector::repeat(1.5))
        };
        let thin = Vector::new(1.0, [1.0, random.power(-45, -5)][random.below(2)], random.power(-45, -5));
        points.iter_mut().for_each(|p| *p = p.component_mul(&thin));
        points
    };
    Case {
        points_a: points(random),
        pose_a: Pose::new(&random.rotation(), &Vector::zeros()),
        points_b: points(random),
        pose_b: Pose::new(&random.rotation(), &(random.power(-6, 1) * random.vector())),
    }
}

/// Both bodies placed by the same rotation and B moved by `shift` in the common frame: exact for quarter turns, else touching
/// up to rounding.
fn side_by_side(random: &mut Random, points_a: Vec<Vector>, points_b: Vec<Vector>, shift: Vector) -> Case {
    let rotation = if random.below(2) == 0 { random.quarter_turns() } else { random.rotation() };
    Case {
        points_a,
        pose_a: Pose::new(&rotation, &Vector::zeros()),
        points_b,
        pose_b: Pose::new(&rotation, &(rotation * shift)),
    }
}

/// A vertex of B above a face of A, at 0 or ±2⁻ᵏ.
fn vertex_near_face(random: &mut Random) -> Case {
    let points_a = box_points(Vector::new(1.0, 2.0, 0.5));
    let mut points_b = random_points(random, 5);
    points_b.iter_mut().for_each(|p| p.z = p.z.abs() + 0.125);
    points_b.push(Vector::zeros());
    let shift = Vector::new(random.signed(), random.signed(), 0.5 + gap(random));
    side_by_side(random, points_a, points_b, shift)
}

/// An edge of B across an edge of A, at any angle down to 2⁻⁴⁰ and at 0 or ±2⁻ᵏ.
fn crossing_edges(random: &mut Random) -> Case {
    let roof = |down: f64, slope: f64| {
        let ridge = Vector::new(1.0, slope, 0.0);
        vec![ridge, -ridge, Vector::new(0.25, 1.0, down), Vector::new(-0.25, -1.0, down)]
    };
    let slope = random.power(-40, 0);
    let shift = Vector::new(0.25 * random.signed(), 0.0, gap(random));
    side_by_side(random, roof(-0.5, 0.0), roof(0.75, slope), shift)
}

/// Boxes face to face, edge to edge or corner to corner, at 0 or ±2⁻ᵏ.
fn parallel_faces(random: &mut Random) -> Case {
    let (half_a, half_b) = (Vector::new(1.0, 0.75, 0.5), Vector::new(0.5, 1.0, 0.25));
    let mut shift = random.vector();
    for axis in 0..=random.below(3) {
        shift[axis] = half_a[axis] + half_b[axis] + gap(random);
    }
    side_by_side(random, box_points(half_a), box_points(half_b), shift)
}

/// Polygons, segments and points, with each other and with solids.
fn flat(random: &mut Random) -> Case {
    let points = |random: &mut Random| match random.below(4) {
        0 => vec![random.lattice(1)],
        1 => vec![random.lattice(2), random.lattice(2)],
        2 => {
            let (origin, u, v) = (random.lattice(1), random.lattice(1), random.lattice(1));
            let mut corner = || origin + random.lattice(1).x * u + random.lattice(1).y * v;
            (0..6).map(|_| corner()).collect()
        }
        _ => lattice_points(random, 1),
    };
    let mut case = Case {
        points_a: points(random),
        pose_a: Pose::new(&random.quarter_turns(), &random.lattice(1)),
        points_b: points(random),
        pose_b: Pose::new(&random.quarter_turns(), &random.lattice(1)),
    };
    if random.below(3) == 0 {
        case.pose_b = Pose::new(&random.rotation(), &random.vector());
    }
    case
}

/// Boxes with points in the middle of faces and edges: a support climb that starts there ties with every neighbour.
fn flat_vertices(random: &mut Random) -> Case {
    let half = Vector::new(1.0, 1.0, 0.5);
    let mut points = box_points(half);
    for axis in 0..3 {
        let middle = Vector::ith(axis, half[axis]);
        points.extend([middle, -middle]);
    }
    points.push(Vector::new(1.0, 0.0, 0.5));
    let mut shift = random.lattice(1);
    let axis = random.below(3);
    shift[axis] = 2.0 * half[axis] + [gap(random), 0.5, 0.0][random.below(3)];
    side_by_side(random, points.clone(), points, shift)
}

/// A plate that is thinner than rounding along its length, and something beside one of its short sides that is parallel to the
/// long ones: its vertices are coplanar up to rounding, but a short edge leans out of that plane by a lot. Found by fuzzing: the
/// directions across such an edge were taken for the cone of its faces' normals.
fn leaning_sides(random: &mut Random) -> Case {
    let length = random.power(2, 50);
    let thickness = length * random.power(-54, -50);
    let corners = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [0.5 * random.signed(), length]];
    let points_a = corners.map(|[x, y]| Vector::new(x, y, thickness * random.signed())).to_vec();
    let size = random.power(-3, 0);
    let points_b = random_points(random, 5).iter().map(|p| size * p).collect();
    let shift = 3.0 * Vector::new(random.signed(), 0.5 * random.signed(), random.signed());
    side_by_side(random, points_a, points_b, shift)
}

fn contained(random: &mut Random) -> Case {
    let size = random.power(-30, -1);
    let small = random_points(random, 5).iter().map(|p| size * p).collect();
    Case {
        points_a: box_points(Vector::repeat(1.0)),
        pose_a: Pose::new(&random.rotation(), &Vector::zeros()),
        points_b: small,
        pose_b: Pose::new(&random.rotation(), &(0.6 * random.vector())),
    }
}

/// The coordinates' last bits are coarse against the gap.
fn far(random: &mut Random) -> Case {
    let mut case = if random.below(2) == 0 { tetrahedra(random) } else { parallel_faces(random) };
    let distance = 1e9 * random.vector();
    if random.below(2) == 0 {
        let moved = |pose: &Pose| Pose::new(&pose.rotation(), &(pose.translation() + distance));
        (case.pose_a, case.pose_b) = (moved(&case.pose_a), moved(&case.pose_b));
    } else {
        case.points_a.iter_mut().for_each(|p| *p += distance);
        case.pose_a = translated(-distance);
    }
    case
}

/// A point or a body of a few units in the last place, turned about a far local origin and brought back to the world's: all
/// digits of T + R·c cancel, and what rounding leaves is in the other body's T.
fn far_local_origin(random: &mut Random) -> Case {
    let centre = 1e9 * random.vector();
    let rotation = random.rotation();
    let turned = rotation * centre;
    let rest = |k: usize| {
        let row = Vector::new(rotation[(k, 0)], rotation[(k, 1)], rotation[(k, 2)]);
        (wide_dot(&widen(&row), &widen(&centre)) - turned[k].into()).hi
    };
    let points_a = if random.below(2) == 0 {
        vec![centre]
    } else {
        (0..6).map(|_| centre + random.lattice(2) * 2f64.powi(-23)).collect()
    };
    let size = random.power(-60, -20);
    let points_b = random_points(random, 6).iter().map(|p| size * p).collect();
    let apart = size * [0.0, 0.5, 3.0][random.below(3)];
    let pose_b = Pose::new(&random.rotation(), &(Vector::new(rest(0), rest(1), rest(2)) + apart * random.vector()));
    Case { points_a, pose_a: Pose::new(&rotation, &-turned), points_b, pose_b }
}

/// One of the other cases, from subnormal to near overflow, or the two bodies of very different size.
fn scales(random: &mut Random) -> Case {
    let generators: [Generator; 4] = [lattice, boxes, tetrahedra, vertex_near_face];
    let mut case = generators[random.below(4)](random);
    let scale_a = random.power(-1040, 1000);
    let scale_b = if random.below(2) == 0 { scale_a } else { scale_a * random.power(-20, 20) };
    case.points_a.iter_mut().for_each(|p| *p *= scale_a);
    case.points_b.iter_mut().for_each(|p| *p *= scale_b);
    for pose in [&mut case.pose_a, &mut case.pose_b] {
        *pose = Pose::new(&pose.rotation(), &(scale_a * pose.translation()));
    }
    case
}
