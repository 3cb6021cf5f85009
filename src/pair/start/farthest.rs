//! The vertices farthest along the line between two bodies.

use super::start_pair::{Guess, StartPair};
use crate::base::math::Vector;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::{Plan, Table};
use crate::body::tables::table;
use crate::placed::Pair;
use crate::placed::voronoi::climb;

/// The support vertices along the line of the bodies' origins, and whether the bodies are apart along it.
#[inline(never)]
pub(super) fn farthest(pair: &Pair) -> StartPair {
    let Pair { polyhedra, poses } = *pair;
    let origin = |i: usize| poses[i].transform(&polyhedra[i].centre);
    let between = origin(1) - origin(0);
    let towards = [poses[0].rotate_back(&between), poses[1].rotate_back(&-between)];
    let vertices = match polyhedra.map(|polyhedron| polyhedron.lookup.plan) {
        [Plan::AllVertices { .. }, Plan::AllVertices { .. }] => {
            let tables = [table(polyhedra[0]), table(polyhedra[1])];
            simd::dispatch(&mut FarthestSupports { polyhedra, tables, directions: &towards })
        }
        _ => [0, 1].map(|i| simd::dispatch(&mut FarthestClimb { polyhedron: polyhedra[i], direction: towards[i] })),
    };
    let support = |i: usize| polyhedra[i].vertices[vertices[i] as usize].position.dot(&towards[i]);
    let are_apart = support(0) + support(1) < between.norm_squared();
    StartPair::new(vertices, if are_apart { Guess::Apart } else { Guess::Unclear })
}

/// A hill climb for a support vertex.
struct FarthestClimb<'a> {
    polyhedron: &'a Polyhedron,
    direction: Vector,
}

impl Kernel for FarthestClimb<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> u32 {
        climb(self.polyhedron, L::from_vector(&self.direction), 0)
    }
}

/// A look at all vertices of two small bodies: faster than a climb on one and then on the other.
struct FarthestSupports<'a> {
    polyhedra: [&'a Polyhedron; 2],
    tables: [&'a Table; 2],
    directions: &'a [Vector; 2],
}

impl Kernel for FarthestSupports<'_> {
    type Output = [u32; 2];

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> [u32; 2] {
        [self.support::<L>(0), self.support::<L>(1)]
    }
}

impl FarthestSupports<'_> {
    #[inline(always)]
    fn support<L: Lanes>(&self, body: usize) -> u32 {
        let direction = L::from_vector(&self.directions[body]);
        let length = direction.norm1();
        let Table::AllVertices(blocks) = self.tables[body] else { return 0 };
        if !(length >= f64::MIN_POSITIVE) {
            return 0;
        }
        // Scaled to a length that single precision holds.
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
