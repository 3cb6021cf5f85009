//! The pose of a body in the frame of a ground.

use super::PlacedGround;
use super::tree::Bounds;
use crate::base::error::{Error, Result};
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF, Vector, is_unit};
use crate::distance::certificate::of_vertex;
use crate::pair::Placed;

/// The least and, inverted, the greatest factor by which an accepted rotation changes lengths: where no entry of RᵀR − I exceeds
/// d, |R·v|² is within 3d·|v|² of |v|², and √(1 − x) ≥ 1 − x for x from 0 to 1.
fn least_stretch(pose: &Pose) -> f64 {
    1.0 - 3.0 * (pose.rotation_defect() + 8.0 * UNIT_ROUNDOFF)
}

/// A bound of the rounding of an entry of R⁻¹, of products with it and of sums of a few of these, relative to the lengths that go
/// in, with a margin of 4.
pub(super) const ROUNDING: f64 = 256.0 * UNIT_ROUNDOFF;

impl PlacedGround<'_> {
    /// A box in the world around all that the ground acts on, a little larger than it need be: its least and its greatest corner.
    pub(crate) fn world_box(&self) -> [Vector; 2] {
        let Bounds { lower, upper } = *self.ground.tree().bounds();
        let (middle, half) = (0.5 * lower + 0.5 * upper, 0.5 * upper - 0.5 * lower);
        let at = self.pose.transform(&middle);
        let size = self.pose.translation().lp_norm(1) + 2.0 * (middle.lp_norm(1) + half.lp_norm(1));
        // What is inside a closed surface is inside its box.
        let thickness = Some(self.ground.thickness()).filter(|thickness| thickness.is_finite()).unwrap_or(0.0);
        let beyond = thickness * self.pose.most_stretched() + ROUNDING * size;
        let half = (self.pose.rotation().abs() * half).add_scalar(beyond);
        [at - half, at + half]
    }
}

/// A body beside a ground.
pub(super) struct Reach {
    /// The ground's rotation, its inverse, and where its origin is.
    turn: Matrix,
    inverse: Matrix,
    origin: Vector,
    /// A box around the body, in the frame of the ground, a little larger than it need be.
    pub bounds: Bounds,
    /// Its centre of mass there.
    pub centre: Vector,
    /// A length of the ground's frame is at least so many times as long in the world.
    pub stretch: f64,
}

impl Reach {
    /// For poses that are accepted.
    ///
    /// # Errors
    /// [`Error::Argument`] for a curved body; [`Error::Bug`].
    pub fn new(body: Placed, ground: PlacedGround) -> Result<Reach> {
        body.shape.refuse_deviation("grounds")?;
        let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
        let (turn, origin) = (ground.pose.rotation(), ground.pose.translation());
        let Some(inverse) = turn.try_inverse() else {
            return Err(Error::Bug("a rotation that was accepted has no inverse".into()));
        };
        let (middle, half) = body.shape.extent().box_about_centre();
        let local = |point: &Vector| inverse * (pose.transform(point) - origin);
        let at = local(&(polyhedron.centre + middle));
        let size = pose.translation().lp_norm(1)
            + origin.lp_norm(1)
            + 2.0 * (polyhedron.centre.lp_norm(1) + middle.lp_norm(1) + half.lp_norm(1));
        let stretch = least_stretch(ground.pose);
        let swept = body.shape.swept_radius() / stretch;
        let half = ((inverse * pose.rotation()).abs() * half).add_scalar(swept + ROUNDING * size);
        let centre = local(&polyhedron.mass.centre_of_mass);
        Ok(Reach { turn, inverse, origin, bounds: Bounds { lower: at - half, upper: at + half }, centre, stretch })
    }

    /// A normal of the world as one of the ground's frame, of unit length: Rᵀ takes normals back.
    pub fn local_normal(&self, world: &Vector) -> Vector {
        debug_assert!(is_unit(world));
        self.turn.tr_mul(world).normalize()
    }

    /// A normal of the ground's frame as one of the world.
    pub fn world_normal(&self, local: &Vector) -> Vector {
        self.inverse.tr_mul(local).normalize()
    }

    /// A point of the world in the frame of the ground.
    pub fn point(&self, world: &Vector) -> Vector {
        self.inverse * (world - self.origin)
    }

    /// How far a body is at least from what is in a box, along the way from box to box. That is about the distance where both are
    /// small beside it; between the boxes alone it is less, by what a turned body's box is larger than the body.
    ///
    /// The products are right to 4u, their factors to 8u, for the ends of the box as for the points that
    /// [`Lowest`](super::lowest::Lowest) bounds.
    pub fn gap_along_way(&self, body: Placed, other: &Bounds) -> f64 {
        let (polyhedron, pose) = (body.shape.polyhedron(), body.pose);
        let way = self.turn * other.way_to(&self.bounds);
        let length = way.norm();
        if !(length > f64::MIN_POSITIVE.sqrt()) {
            return 0.0;
        }
        let up = way / length;
        let downwards = pose.rotate_back(&-up);
        let (vertex, _) = polyhedron.support(&downwards, 0);
        let low = up.dot(&(pose.transform(&polyhedron.local_position(vertex)) - self.origin));
        let in_ground = self.turn.tr_mul(&up);
        let high = in_ground.component_mul(&other.lower).sup(&in_ground.component_mul(&other.upper)).sum();
        let size = pose.translation().lp_norm(1)
            + self.origin.lp_norm(1)
            + 2.0 * (polyhedron.centre.lp_norm(1) + 2.0 * polyhedron.radius)
            + 2.0 * (other.lower.lp_norm(1) + other.upper.lp_norm(1));
        let radius = body.shape.swept_radius() * (1.0 + 16.0 * UNIT_ROUNDOFF);
        // Lengths along a vector of length 1 + 4u.
        let gap = low - high - of_vertex(polyhedron, vertex, &downwards) - radius - 64.0 * UNIT_ROUNDOFF * size;
        gap * (1.0 - 16.0 * UNIT_ROUNDOFF)
    }
}
