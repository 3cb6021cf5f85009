//! Where marching starts: a policy says from what, look-ups or a climb lead to a vertex of each body.

mod alternate;
pub mod policy;

use alternate::LookUps;
use policy::StartFrom;

use crate::base::math::{Pose, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::polyhedron::Polyhedron;
use crate::polyhedron::lookup::{Plan, Table};
use crate::solve::voronoi::climb;
use crate::tables::nearest_vertex::AllVertices;
use crate::tables::{table, tables};

/// Where to start.
// Laid out so that no two of its numbers side by side are read as one (R1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct StartPair {
    /// A vertex of body 1.
    pub first: u32,
    /// Whether the bodies seem to intersect.
    pub guess: Guess,
    /// A vertex of body 2.
    pub second: u32,
}

impl StartPair {
    #[inline(always)]
    fn new([first, second]: [u32; 2], guess: Guess) -> StartPair {
        StartPair { first, guess, second }
    }

    /// A vertex of each body.
    #[inline(always)]
    pub fn vertices(&self) -> [u32; 2] {
        [self.first, self.second]
    }
}

/// What a look into the tables makes one expect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Guess {
    /// Each of the two vertices is on the side of its body that faces the other vertex, or they are farthest along a line along
    /// which the bodies are apart: most such pairs are disjoint.
    Apart,
    /// Only one is, they are not apart along that line, or nobody looked.
    Unclear,
    /// Neither is: most such pairs intersect.
    Overlapping,
}

/// Where to start: as `from` says, as far as both bodies have tables for it, or one of them has and the other needs none; or else
/// at the vertices farthest along the line of the bodies' origins.
#[inline(always)]
pub fn start_pair(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], from: StartFrom) -> StartPair {
    match from {
        StartFrom::Farthest => farthest(polyhedra, poses),
        StartFrom::Centres => look_up(polyhedra, poses, [0; 2], u32::MAX),
        StartFrom::LastVertices { vertices, rounds } => look_up(polyhedra, poses, vertices, rounds),
    }
}

/// At most `rounds` rounds of look-ups from the vertices `last`; where the centres of mass take no more, from these.
#[inline(never)]
fn look_up(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], last: [u32; 2], rounds: u32) -> StartPair {
    let [body1, body2] = polyhedra;
    let from = LookUps { polyhedra, poses, last, most_rounds: rounds };
    // Returned from where it is found (R1).
    match [body1.lookup.plan, body2.lookup.plan] {
        [Plan::Shells { .. }, Plan::Shells { .. }] => {
            if let (Table::Shells(first), Table::Shells(second)) = (table(body1), table(body2)) {
                return from.alternate(first, second);
            }
        }
        [Plan::AllVertices { rounds: wanted }, Plan::Shells { .. }] => {
            if let Table::Shells(second) = table(body2) {
                let first = &AllVertices { polyhedron: body1, rounds: wanted };
                return from.alternate(first, second);
            }
        }
        [Plan::Shells { .. }, Plan::AllVertices { rounds: wanted }] => {
            if let Table::Shells(first) = table(body1) {
                let second = &AllVertices { polyhedron: body2, rounds: wanted };
                return from.alternate(first, second);
            }
        }
        [Plan::Spherical { .. }, Plan::Spherical { .. }] => {
            if let (Table::Spherical(first), Table::Spherical(second)) = (table(body1), table(body2)) {
                let between = centre_of_mass(body2, poses[1]) - centre_of_mass(body1, poses[0]);
                let vertices =
                    [first.towards(&poses[0].rotate_back(&between)), second.towards(&poses[1].rotate_back(&-between))];
                return StartPair::new(vertices, Guess::Unclear);
            }
        }
        _ => {}
    }
    farthest(polyhedra, poses)
}

/// Whether spheres inside two bodies overlap, as far as their tables know any; beside a body that needs no table they may.
pub fn may_cores_overlap(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> bool {
    let Some([Table::Shells(first), Table::Shells(second)]) = tables(polyhedra) else {
        return polyhedra.iter().any(|polyhedron| matches!(polyhedron.lookup.plan, Plan::AllVertices { .. }));
    };
    let between = centre_of_mass(polyhedra[0], poses[0]) - centre_of_mass(polyhedra[1], poses[1]);
    let radii = first.core * polyhedra[0].mass.radius + second.core * polyhedra[1].mass.radius;
    between.norm_squared() < radii * radii
}

/// The support vertices along the line of the bodies' origins, and whether the bodies are apart along it.
#[inline(never)]
fn farthest(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> StartPair {
    let origin = |i: usize| poses[i].transform(&polyhedra[i].centre);
    let between = origin(1) - origin(0);
    let towards = [poses[0].rotate_back(&between), poses[1].rotate_back(&-between)];
    let vertices = match polyhedra.map(|polyhedron| polyhedron.lookup.plan) {
        [Plan::AllVertices { .. }, Plan::AllVertices { .. }] => {
            let tables = [table(polyhedra[0]), table(polyhedra[1])];
            simd::dispatch(&mut Supports { polyhedra, tables, directions: &towards })
        }
        _ => [0, 1].map(|i| simd::dispatch(&mut Climb { polyhedron: polyhedra[i], direction: towards[i] })),
    };
    let support = |i: usize| polyhedra[i].vertices[vertices[i] as usize].position.dot(&towards[i]);
    let are_apart = support(0) + support(1) < between.norm_squared();
    StartPair::new(vertices, if are_apart { Guess::Apart } else { Guess::Unclear })
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

/// A look at all vertices of two small bodies: faster than a climb on one and then on the other.
struct Supports<'a> {
    polyhedra: [&'a Polyhedron; 2],
    tables: [&'a Table; 2],
    directions: &'a [Vector; 2],
}

impl Kernel for Supports<'_> {
    type Output = [u32; 2];

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> [u32; 2] {
        [self.support::<L>(0), self.support::<L>(1)]
    }
}

impl Supports<'_> {
    #[inline(always)]
    fn support<L: Lanes>(&self, body: usize) -> u32 {
        let direction = L::from_vector(&self.directions[body]);
        let length = direction.norm1();
        let Table::AllVertices(blocks) = self.tables[body] else { return 0 };
        if !(length >= f64::MIN_POSITIVE) {
            return 0;
        }
        // Of a length that single precision holds.
        let direction = direction.mul(L::splat(1.0 / length));
        let mut best = (f32::NEG_INFINITY, 0);
        for (index, block) in blocks.iter().enumerate() {
            let (height, lane) = direction.greatest_product([&block.x, &block.y, &block.z]);
            if height > best.0 {
                best = (height, 8 * index + lane);
            }
        }
        // Lanes beyond the last vertex repeat it.
        best.1.min(self.polyhedra[body].vertices.len() - 1) as u32
    }
}

/// In the world, in plain rounding.
#[inline(always)]
fn centre_of_mass(polyhedron: &Polyhedron, pose: &Pose) -> Vector {
    pose.transform(&polyhedron.mass.centre_of_mass)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::assembly::build;
    use crate::tables::{LookupOptions, plan_lookup};
    use swiftprox::random::Random;

    /// Climbs on small bodies took half the time of their queries after a jump.
    #[test]
    fn small_bodies_start_at_their_farthest_vertices() {
        let mut random = Random::new(31);
        for count in [4, 7, 8, 9, 16, 25] {
            let size = random.power(-40, 40);
            let points: Vec<Vector> = (0..count).map(|_| random.direction() * size).collect();
            let mut polyhedron = build(&points, None).unwrap();
            polyhedron.lookup = plan_lookup(&polyhedron, &LookupOptions::DEFAULT).unwrap();
            assert!(matches!(table(&polyhedron), Table::AllVertices(_)));
            for _ in 0..50 {
                let [pose1, pose2] = [(); 2].map(|()| Pose::new(&random.rotation(), &(3.0 * size * random.vector())));
                let origin = |pose: &Pose| pose.transform(&polyhedron.centre);
                let between = origin(&pose2) - origin(&pose1);
                let start = start_pair([&polyhedron; 2], [&pose1, &pose2], StartFrom::Farthest);
                for (vertex, towards) in
                    start.vertices().into_iter().zip([pose1.rotate_back(&between), pose2.rotate_back(&-between)])
                {
                    let heights: Vec<f64> = polyhedron.vertices.iter().map(|v| v.position.dot(&towards)).collect();
                    let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    assert!(heights[vertex as usize] >= highest - 1e-6 * size * between.norm(), "{count} {size}");
                }
            }
        }
    }
}
