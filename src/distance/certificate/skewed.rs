//! Minima over faces of pairs whose rotations are not orthonormal: marching finds the foot on a face in the body's own frame, where
//! the transpose stands for the inverse, and the foot is off by as much as the rotation is. Here it is put right in world axes.
//! Everything is inlined: so it is compiled for the caller's vector units; out of line every operation on lanes would be a call.

use super::Minimum;
use crate::base::simd::Lanes;
use crate::placed::frame::Frame;
use crate::placed::state::{FeatureId, State};

impl<L: Lanes> Minimum<L> {
    /// The same minimum with the point of a face, if it has one, that is nearest in the world. Whether it is in the face is for the
    /// certificate to tell.
    #[inline(always)]
    pub(super) fn unskewed(&self, frame: &Frame<L>, state: State) -> Minimum<L> {
        match state.features() {
            [FeatureId::Face(face), _] => self.over(frame, 0, face),
            [_, FeatureId::Face(face)] => self.over(frame, 1, face),
            _ => *self,
        }
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
        // In the face's plane up to rounding.
        let shift = body.invert(aside);
        let shift = normal.negated_mul_add(L::splat(normal.dot(shift)), shift);
        let mut moved = *self;
        moved.points[i] = self.points[i].add(shift);
        moved.rotated[i] = body.rotate_lanes(moved.points[i]);
        // As for any two points of which only R·p and the offset are known, see `Frame::difference`.
        let between = other.offset.add(self.rotated[1 - i]).sub(moved.rotated[i]);
        moved.difference = if i == 0 { between.negate() } else { between };
        moved.height = self.height + shift.norm1();
        moved.distance = moved.difference.dot(moved.difference).sqrt();
        moved.projection = self.direction.dot(moved.difference) * self.inverse;
        moved
    }
}
