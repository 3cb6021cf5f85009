//! Placing bodies in contact, a hair apart or a hair into each other, at spots of every kind.

use swiftprox::body::build::hull::convex_hull;
use swiftprox::math::{Matrix, Vector};
use swiftprox::mesh::PolygonMesh;

use crate::PosePair;
use crate::orbits::pose_pair;
use crate::random::{Random, rotation};

/// A point of a body's surface and an outward direction in which nothing of the body lies higher, up to rounding.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    pub point: Vector,
    pub normal: Vector,
}

/// The surface of a body as a source of spots.
pub struct Surface {
    vertices: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
    pub radius: f64,
}

impl Surface {
    pub fn of(body: &PolygonMesh) -> Surface {
        let hull = convex_hull(&body.vertices).expect("finite points");
        let centre = body.vertices.iter().sum::<Vector>() / body.vertices.len() as f64;
        let radius = body.vertices.iter().map(|v| (v - centre).norm()).fold(0.0, f64::max);
        Surface { vertices: body.vertices.clone(), triangles: hull.triangles, radius }
    }

    /// Inside a face, on an edge or at a vertex, with equal chances.
    pub fn spot(&self, random: &mut Random) -> Spot {
        let kind = if self.triangles.is_empty() { 2 } else { random.below(3) };
        match kind {
            0 => {
                let corners = self.corners(random.below(self.triangles.len()));
                let (mut s, mut t) = (random.uniform(0.0, 1.0), random.uniform(0.0, 1.0));
                if s + t > 1.0 {
                    (s, t) = (1.0 - s, 1.0 - t);
                }
                let point = corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
                Spot { point, normal: normal(&corners) }
            }
            1 => {
                let index = random.below(self.triangles.len());
                let [a, b, _] = self.triangles[index];
                let other = self.triangles.iter().position(|t| (0..3).any(|k| [t[k], t[(k + 1) % 3]] == [b, a]));
                let normals = [index, other.unwrap_or(index)].map(|t| normal(&self.corners(t)));
                let weight = random.uniform(0.0, 1.0);
                let between = normals[0] * weight + normals[1] * (1.0 - weight);
                let [from, to] = [a, b].map(|v| self.vertices[v as usize]);
                let point = from + random.uniform(0.0, 1.0) * (to - from);
                Spot { point, normal: between.try_normalize(1e-9).unwrap_or(normals[0]) }
            }
            _ => {
                let normal = random.direction();
                let higher = |v: &&Vector, w: &&Vector| v.dot(&normal).total_cmp(&w.dot(&normal));
                Spot { point: *self.vertices.iter().max_by(higher).expect("a vertex"), normal }
            }
        }
    }

    fn corners(&self, triangle: usize) -> [Vector; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }
}

/// The unit normal of a triangle, however small or thin, up to rounding.
fn normal(corners: &[Vector; 3]) -> Vector {
    let [u, v] = [corners[1] - corners[0], corners[2] - corners[0]].map(|e| e / e.amax());
    let normal = u.cross(&v);
    normal.try_normalize(0.0).unwrap_or_else(Vector::z)
}

/// The two spots laid on each other, `gap` apart along their common normal (less than 0: into each other), body 2 spun about it at
/// random, everything seen from a random frame around the origin.
pub fn opposed(random: &mut Random, spots: [Spot; 2], gap: f64) -> PosePair {
    let turn = random.rotation();
    let out = turn * spots[0].normal;
    // Body 2's normal against body 1's: a half turn about the line between the two directions.
    let between = (spots[1].normal - out).try_normalize(1e-6);
    let between = between.unwrap_or_else(|| out.cross(&random.direction()).normalize());
    let half_turn = 2.0 * between * between.transpose() - Matrix::identity();
    let turn2 = rotation(&out, random.uniform(0.0, 7.0)) * half_turn;
    pose_pair(&turn, &(turn * -spots[0].point), &turn2, &(gap * out - turn2 * spots[1].point))
}

/// Random spots at `gap`.
pub fn touching(random: &mut Random, surfaces: [&Surface; 2], gap: f64) -> PosePair {
    let spots = surfaces.map(|surface| surface.spot(random));
    opposed(random, spots, gap)
}

/// Gaps of 0, ±10⁻³ … ±10⁻¹⁵, in random order.
pub fn gap_ladder(random: &mut Random) -> Vec<f64> {
    let powers = (3..=15).map(|k| 10f64.powi(-k));
    let mut gaps: Vec<f64> = powers.flat_map(|gap| [gap, -gap]).chain([0.0]).collect();
    shuffle(random, &mut gaps);
    gaps
}

/// Fisher & Yates.
pub fn shuffle<T>(random: &mut Random, items: &mut [T]) {
    for last in (1..items.len()).rev() {
        items.swap(last, random.below(last + 1));
    }
}

/// Both bodies turned the same way and body 2 moved by `shift` in the common frame: exact for quarter turns, up to rounding else.
pub fn side_by_side(turn: &Matrix, origin: &Vector, shift: &Vector) -> PosePair {
    pose_pair(turn, origin, turn, &(turn * shift + origin))
}

/// A quarter turn or, every other time, any rotation.
pub fn frame(random: &mut Random, index: usize) -> Matrix {
    if index.is_multiple_of(2) { random.quarter_turns() } else { random.rotation() }
}

/// Any orientation, the centres up to `reach` apart.
pub fn anywhere(random: &mut Random, reach: f64) -> PosePair {
    let (turn1, turn2) = (random.rotation(), random.rotation());
    pose_pair(&turn1, &Vector::zeros(), &turn2, &(reach * random.vector()))
}

/// Both translations moved, each coordinate rounded once.
pub fn moved(mut pair: PosePair, by: &Vector) -> PosePair {
    for (k, entry) in [3, 7, 11, 15, 19, 23].into_iter().enumerate() {
        pair[entry] += by[k % 3];
    }
    pair
}

/// Both translations multiplied.
pub fn stretched(mut pair: PosePair, factor: f64) -> PosePair {
    for entry in [3, 7, 11, 15, 19, 23] {
        pair[entry] *= factor;
    }
    pair
}

/// 10⁻ᵏ, k at random within the bounds.
pub fn power_of_ten(random: &mut Random, from: i32, to: i32) -> f64 {
    10f64.powi(from + random.below((to - from + 1) as usize) as i32)
}
