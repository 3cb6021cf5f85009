//! Where marching starts: from the look-up tables when the last query tells little or nothing.

use crate::lookup::{Shells, Table};
use crate::lookup_build::tables;
use crate::math::{Pose, Vector};
use crate::polyhedron::Polyhedron;
use crate::simd::{self, Kernel, Lanes};
use crate::voronoi::climb;

/// Where to start.
// Small enough to come back in registers: through memory it would be written in parts and read as one, which stalls.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beginning {
    /// A vertex of each body.
    pub vertices: [u32; 2],
    /// Whether the bodies seem to intersect.
    pub guess: Guess,
}

/// What a look into the tables makes one expect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u32)]
pub enum Guess {
    /// Each of the two vertices is on the side of its body that faces the other vertex: most such pairs are disjoint.
    Apart,
    /// Only one is, or nobody looked.
    Unclear,
    /// Neither is: most such pairs intersect.
    Overlapping,
}

/// Where to start if not where the last query ended: at the vertices that the tables say, if they are to be asked and there are
/// any, or else at those farthest along the line of the bodies' origins.
#[inline(never)]
pub fn anew(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], ask_tables: bool) -> Beginning {
    let found = if ask_tables { from_tables(polyhedra, poses) } else { None };
    found.unwrap_or_else(|| Beginning { vertices: farthest(polyhedra, poses), guess: Guess::Unclear })
}

/// Whether spheres inside two bodies overlap, as far as their tables know any.
pub fn do_cores_overlap(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> bool {
    let Some([Table::Shells(first), Table::Shells(second)]) = tables(polyhedra) else { return false };
    let between = centre_of_mass(polyhedra[0], poses[0]) - centre_of_mass(polyhedra[1], poses[1]);
    let reach = first.core * polyhedra[0].mass.radius + second.core * polyhedra[1].mass.radius;
    between.norm_squared() < reach * reach
}

/// The support vertices along the line of the bodies' origins.
fn farthest(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> [u32; 2] {
    let origin = |i: usize| poses[i].transform(&polyhedra[i].centre);
    let between = origin(1) - origin(0);
    let towards = [poses[0].rotate_back(&between), poses[1].rotate_back(&-between)];
    [0, 1].map(|i| simd::dispatch(&mut Climb { polyhedron: polyhedra[i], direction: towards[i] }))
}

/// A hill climb for a support vertex.
struct Climb<'a> {
    polyhedron: &'a Polyhedron,
    direction: Vector,
}

impl Kernel for Climb<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> u32 {
        climb(self.polyhedron, L::from_vector(&self.direction), 0)
    }
}

/// The vertices that the tables of both bodies give, if both have one.
#[inline(always)]
fn from_tables(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> Option<Beginning> {
    match tables(polyhedra)? {
        [Table::Shells(first), Table::Shells(second)] => Some(alternate([first, second], polyhedra, poses)),
        [Table::Spherical(first), Table::Spherical(second)] => {
            let between = centre_of_mass(polyhedra[1], poses[1]) - centre_of_mass(polyhedra[0], poses[0]);
            let vertices =
                [first.towards(&poses[0].rotate_back(&between)), second.towards(&poses[1].rotate_back(&-between))];
            Some(Beginning { vertices, guess: Guess::Unclear })
        }
        _ => None,
    }
}

/// In the world, in plain rounding.
#[inline(always)]
fn centre_of_mass(polyhedron: &Polyhedron, pose: &Pose) -> Vector {
    pose.transform(&polyhedron.mass.centre_of_mass)
}

/// Projects the centre of mass of body 2 on body 1, the vertex found on body 2, that one on body 1, and so on, by the tables.
#[inline(always)]
fn alternate(tables: [&Shells; 2], polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> Beginning {
    let [radius1, radius2] = [polyhedra[0].mass.radius, polyhedra[1].mass.radius];
    let between = centre_of_mass(polyhedra[0], poses[0]) - centre_of_mass(polyhedra[1], poses[1]);
    // From body 1's frame and unit to body 2's, and back.
    let [there, back] = maps(poses, &between, [radius1, radius2]);
    let position = |i: usize, vertex: u32| tables[i].positions[vertex as usize];
    let mut vertex1 = tables[0].nearest(back.offset);
    let mut vertex2 = tables[1].nearest(there.apply(position(0, vertex1)));
    let vertex_count = tables[0].positions.len().max(tables[1].positions.len());
    let rounds = if vertex_count > MANY_VERTICES { 3 } else { 2 };
    for _ in 1..rounds {
        vertex1 = tables[0].nearest(back.apply(position(1, vertex2)));
        vertex2 = tables[1].nearest(there.apply(position(0, vertex1)));
    }
    let faces1 = is_facing(&tables[0].outward, position(0, vertex1), back.apply(position(1, vertex2)));
    let faces2 = is_facing(&tables[1].outward, position(1, vertex2), there.apply(position(0, vertex1)));
    let guess = match (faces1, faces2) {
        (true, true) => Guess::Apart,
        (false, false) => Guess::Overlapping,
        _ => Guess::Unclear,
    };
    Beginning { vertices: [vertex1, vertex2], guess }
}

/// Whether a vertex looks out of its body when it looks at a point.
#[inline(always)]
fn is_facing(outward: &[[f32; 3]; 3], vertex: [f32; 4], point: [f32; 3]) -> bool {
    let [a, b, c] = outward;
    let mut sum = 0.0;
    for i in 0..3 {
        sum += (point[i] - vertex[i]) * (a[i] * vertex[0] + (b[i] * vertex[1] + c[i] * vertex[2]));
    }
    sum > 0.0
}

/// Beyond so many vertices a third round saves more steps than it costs: of plates of 10,002 vertices at random poses two of nine.
const MANY_VERTICES: usize = 4_000;

/// Points relative to one body's centre of mass, in units of its radius, seen from another body in the same way.
#[derive(Clone, Copy)]
struct Map {
    /// What the first, second and third coordinate are multiplied by.
    columns: [[f32; 3]; 3],
    offset: [f32; 3],
}

/// From body 1 to body 2 and back; `between` is the way from the centre of mass of body 2 to that of body 1 in the world. A
/// transpose stands in for an inverse: it is all about a good guess.
#[inline(always)]
fn maps(poses: [&Pose; 2], between: &Vector, [radius1, radius2]: [f64; 2]) -> [Map; 2] {
    let axis = |pose: &Pose, i: usize| Vector::new(pose.rows[0][i], pose.rows[1][i], pose.rows[2][i]);
    let axes1 = [axis(poses[0], 0), axis(poses[0], 1), axis(poses[0], 2)];
    let [unit1, unit2] = [1.0 / radius1, 1.0 / radius2];
    let [there, back] = [(radius1 * unit2) as f32, (radius2 * unit1) as f32];
    let mut maps = [Map { columns: [[0.0; 3]; 3], offset: [0.0; 3] }; 2];
    for i in 0..3 {
        let axis2 = axis(poses[1], i);
        for (j, axis1) in axes1.iter().enumerate() {
            let entry = axis2.dot(axis1) as f32;
            maps[0].columns[j][i] = entry * there;
            maps[1].columns[i][j] = entry * back;
        }
        maps[0].offset[i] = (axis2.dot(between) * unit2) as f32;
        maps[1].offset[i] = (-axes1[i].dot(between) * unit1) as f32;
    }
    maps
}

impl Map {
    #[inline(always)]
    fn apply(&self, [x, y, z, _]: [f32; 4]) -> [f32; 3] {
        let [a, b, c] = &self.columns;
        let mut point = self.offset;
        for i in 0..3 {
            point[i] += a[i] * x + (b[i] * y + c[i] * z);
        }
        point
    }
}
