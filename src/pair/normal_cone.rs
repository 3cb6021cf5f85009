//! A direction in the normal cones of two bodies where they touch, in a few scans of the neighbours of two vertices, however
//! many these are.
//!
//! Of a pair of vertices that touch, d (from body 2 to body 1) is in both cones if d·k ≤ 0 for all k: the directions of body
//! 2's edges at its vertex, and the reverse of body 1's. That is to separate the origin from the hull of the k, which
//! Gilbert-Johnson-Keerthi does with a scan as support. Where the origin lies in that hull's boundary, as with edges or faces
//! that are flush, d is perpendicular to the part it lies in, and the search goes on across it. Likewise d is perpendicular to
//! the difference of two vertices whose weights with others give a common point.
//!
//! All of it proposes; how far the bodies overlap along d is for the caller to see.

use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::polyhedron::Polyhedron;
use crate::solve::exact::VertexPair;
use crate::solve::gjk::Simplex;

/// Scans before the search is given up.
const MOST_SCANS: u32 = 32;

/// Sines below this are taken for 0.
const PARALLEL: f64 = 1e-9;

/// A world direction, of either sense, that separates two bodies which only touch; `pairs` are vertex pairs whose differences
/// hold the origin in their hull. `None` where the bodies overlap, or rounding leaves nothing.
pub fn separating_direction(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], pairs: &[VertexPair]) -> Option<Vector> {
    let &pair = pairs.first()?;
    let between = poses[0].translation() - poses[1].translation();
    let rotated = |i: usize, pair: &VertexPair| poses[i].rotate(&polyhedra[i].local_position(pair[i]));
    let difference = |pair: &VertexPair| (rotated(0, pair) - rotated(1, pair)) + between;
    let size = polyhedra.iter().map(|p| p.radius + p.centre.norm()).sum::<f64>() + between.norm();
    let differences = pairs.iter().map(difference);
    let longest = differences.clone().reduce(|a, b| if b.norm() > a.norm() { b } else { a })?;
    let mut search = Search { polyhedra, poses, pair, along: Vector::zeros() };
    if longest.norm() > 64.0 * UNIT_ROUNDOFF * size {
        search.along = longest.normalize();
        let across =
            differences.map(|d| search.along.cross(&d)).reduce(|a, b| if b.norm() > a.norm() { b } else { a })?;
        if across.norm() > PARALLEL * longest.norm() {
            return Some(across);
        }
    }
    match search.run() {
        Found::Direction(direction) => Some(direction),
        Found::Flush(along) if search.along == Vector::zeros() => {
            search.along = along;
            match search.run() {
                Found::Direction(direction) => Some(direction),
                Found::Flush(across) => Some(along.cross(&across)),
                Found::Nothing => None,
            }
        }
        Found::Flush(across) => Some(search.along.cross(&across)),
        Found::Nothing => None,
    }
}

struct Search<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    /// The vertices whose edges are looked at.
    pair: VertexPair,
    /// A unit vector to which d has to be perpendicular, or 0.
    along: Vector,
}

enum Found {
    /// In both cones, or perpendicular to a plane that the origin lies in.
    Direction(Vector),
    /// The origin lies between two k that are opposite: along this unit vector.
    Flush(Vector),
    /// None, or not found.
    Nothing,
}

impl Search<'_> {
    fn run(&self) -> Found {
        let centre = |i: usize| self.poses[i].transform(&self.polyhedra[i].mass.centre_of_mass);
        let mut direction = self.across(centre(0) - centre(1));
        if direction == Vector::zeros() {
            direction = self.across(Vector::new(0.48, 0.31, 0.82));
        }
        let mut simplex = Simplex::default();
        for _ in 0..MOST_SCANS {
            let Some((name, k, slope)) = self.steepest(&direction) else { return Found::Nothing };
            if slope <= 0.0 {
                return Found::Direction(direction);
            }
            if !simplex.add(name, k) {
                break;
            }
            let nearest = simplex.reduce();
            if nearest.norm() > PARALLEL {
                direction = -nearest;
                continue;
            }
            let p = &simplex.differences;
            return match simplex.count {
                2 => Found::Flush((p[1] - p[0]).normalize()),
                3 if self.along == Vector::zeros() => Found::Direction((p[1] - p[0]).cross(&(p[2] - p[0]))),
                _ => Found::Nothing,
            };
        }
        // No k leaves it by more than rounding, or the scans have run out.
        Found::Direction(direction)
    }

    /// The part of a vector that is perpendicular to `along`.
    fn across(&self, v: Vector) -> Vector {
        v - self.along * self.along.dot(&v)
    }

    /// The k with the largest product with d: its name (the body, the place among the neighbours), itself and the product.
    fn steepest(&self, direction: &Vector) -> Option<(VertexPair, Vector, f64)> {
        let mut best = None;
        let mut largest = f64::NEG_INFINITY;
        for i in 0..2 {
            // Body 1 looks against d.
            let sense = if i == 0 { -1.0 } else { 1.0 };
            let towards = self.poses[i].rotate_back(direction) * sense;
            // An edge along the line that d is perpendicular to says nothing.
            let along = self.poses[i].rotate_back(&self.along);
            let says_nothing = |edge: &Vector| along.cross(edge).norm() < PARALLEL && along != Vector::zeros();
            for (b, block) in self.polyhedra[i].neighbour_blocks(self.pair[i]).enumerate() {
                for lane in 0..8 {
                    let edge = self.polyhedra[i].direction_to(self.pair[i], block.head[lane]);
                    let slope = edge.dot(&towards);
                    if slope > largest && !says_nothing(&edge) {
                        largest = slope;
                        best = Some(([i as u32, 8 * b as u32 + lane as u32], edge * sense));
                    }
                }
            }
        }
        let (name, edge) = best?;
        let k = self.across(self.poses[name[0] as usize].rotate(&edge));
        Some((name, k, largest))
    }
}
