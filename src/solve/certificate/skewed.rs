//! Minima of pairs whose rotations are not orthonormal: marching measures in a body's own frame, where the transpose stands for
//! the inverse, and its nearest points are off by as much as the rotations are. Here they are put right in world axes. Everything
//! is inlined: so it is compiled for the caller's vector units; out of line every operation on lanes would be a call.

use super::{Minimum, edge_rounding, reciprocal_length};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;
use crate::solve::frame::{Body, Frame};
use crate::solve::state::{FeatureId, State};
use crate::solve::voronoi::edge_direction;

impl<L: Lanes> Minimum<L> {
    /// The same minimum with the points of its edges and faces that are nearest in the world. `None` where they are not nearer, as
    /// for two vertices, or leave their edges; whether they leave their faces is for the certificate.
    #[inline(always)]
    pub(super) fn unskewed(&self, frame: &Frame<L>, state: State) -> Option<Minimum<L>> {
        match state.features() {
            [FeatureId::Edge(edge1), FeatureId::Edge(edge2)] => {
                let [world1, world2] = [self.along(frame, 0, edge1), self.along(frame, 1, edge2)];
                let normal = world1.cross(world2);
                let (cosine, square) = (world1.dot(world2), normal.dot(normal));
                // For parallel edges no two points are nearest, and 0/0 is not computed.
                if !(square > 0.0) {
                    return None;
                }
                let (a, b) = (self.difference.dot(world1), self.difference.dot(world2));
                // The difference with both shifts is perpendicular to both edges.
                let shift1 = (b * cosine - a * world2.dot(world2)) / square;
                let shift2 = (b * world1.dot(world1) - a * cosine) / square;
                let moved = self.slid(frame, 0, edge1, shift1)?.slid(frame, 1, edge2, shift2)?;
                Some(moved.measured(self.direction))
            }
            [FeatureId::Edge(edge), FeatureId::Vertex(_)] => self.across(frame, 0, edge),
            [FeatureId::Vertex(_), FeatureId::Edge(edge)] => self.across(frame, 1, edge),
            [FeatureId::Face(face), FeatureId::Vertex(_)] => Some(self.over(frame, 0, face)),
            [FeatureId::Vertex(_), FeatureId::Face(face)] => Some(self.over(frame, 1, face)),
            _ => None,
        }
    }

    /// R·ê of an edge of body `i`.
    #[inline(always)]
    fn along(&self, frame: &Frame<L>, i: usize, edge: u32) -> L {
        let body = &frame.bodies[i];
        body.rotate(&edge_direction(&body.polyhedron.edges[edge as usize].planes))
    }

    /// The point of body `i` moved along its edge, if it stays within.
    #[inline(always)]
    fn slid(&self, frame: &Frame<L>, i: usize, edge: u32, shift: f64) -> Option<Minimum<L>> {
        let polyhedron = frame.bodies[i].polyhedron;
        let record = &polyhedron.edges[edge as usize];
        let along = edge_direction(&record.planes);
        let world = self.along(frame, i, edge);
        let mut moved = *self;
        moved.points[i] = L::from_vector(&along).mul_add(L::splat(shift), self.points[i]);
        moved.rotated[i] = world.mul_add(L::splat(shift), self.rotated[i]);
        moved.difference = world.mul_add(L::splat(if i == 0 { shift } else { -shift }), self.difference);
        // R·ê, the product and the sum, as where the difference comes from.
        moved.error += 10.0 * U * (shift.abs() + moved.difference.norm1());
        let tail = polyhedron.vertices[record.tail() as usize].position;
        let t = along.dot(&(moved.points[i].to_vector() - tail));
        // Its own rounding and that of the point.
        let margin = 2.0 * edge_rounding(polyhedron);
        (t >= margin && t <= record.length - margin).then_some(moved)
    }

    /// The point on an edge moved to where the difference is perpendicular to it.
    #[inline(always)]
    fn across(&self, frame: &Frame<L>, i: usize, edge: u32) -> Option<Minimum<L>> {
        let world = self.along(frame, i, edge);
        let part = |v: L| v.dot(world) / world.dot(world);
        let shift = part(self.difference);
        let moved = self.slid(frame, i, edge, if i == 0 { -shift } else { shift })?;
        // Rounding leaves a part along the edge that a second time removes.
        let direction = world.negated_mul_add(L::splat(part(moved.difference)), moved.difference);
        Some(moved.measured(direction))
    }

    /// The point in a face of body `i` moved to where the difference is along the direction, which is the face's normal in the
    /// world.
    #[inline(always)]
    fn over(&self, frame: &Frame<L>, i: usize, face: u32) -> Minimum<L> {
        let (body, other) = (&frame.bodies[i], &frame.bodies[1 - i]);
        let normal = L::from_vector(&body.polyhedron.faces[face as usize].normal);
        let part = self.direction.dot(self.difference) / self.direction.dot(self.direction);
        let aside = self.direction.negated_mul_add(L::splat(part), self.difference);
        let aside = if i == 0 { aside.negate() } else { aside };
        // In the face's plane up to rounding, regardless of the inverse's error.
        let shift = inverse(body, aside);
        let shift = normal.negated_mul_add(L::splat(normal.dot(shift)), shift);
        let mut moved = *self;
        moved.points[i] = self.points[i].add(shift);
        moved.rotated[i] = body.rotate_lanes(moved.points[i]);
        // As for any two points of which only R·p and the offset are known, see `Frame::difference`.
        let between = other.offset.add(self.rotated[1 - i]).sub(moved.rotated[i]);
        moved.difference = if i == 0 { between.negate() } else { between };
        moved.height = self.height + shift.norm1();
        moved.measured(self.direction)
    }

    /// With what follows from a difference and a direction.
    #[inline(always)]
    fn measured(&self, direction: L) -> Minimum<L> {
        let inverse = reciprocal_length(direction.dot(direction));
        let distance = self.difference.dot(self.difference).sqrt();
        let projection = direction.dot(self.difference) * inverse;
        Minimum { direction, inverse, distance, projection, ..*self }
    }
}

/// R⁻¹·d, nearly: each round leaves that part of the rest that R is off by.
#[inline(always)]
fn inverse<L: Lanes>(body: &Body<L>, d: L) -> L {
    let mut found = L::from_vector(&Vector::zeros());
    for _ in 0..4 {
        found = found.add(body.rotate_back(d.sub(body.rotate_lanes(found))));
    }
    found
}
