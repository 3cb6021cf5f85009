//! The pose of a body in the frame of a ground.

use super::PlacedGround;
use super::tree::Bounds;
use crate::base::error::{Error, Result};
use crate::base::math::{Matrix, UNIT_ROUNDOFF, Vector, is_unit};
use crate::pair::Placed;

/// The least and, inverted, the greatest factor by which an accepted rotation changes lengths, √(1 ± 3·[`ROTATION_LIMIT`]), with
/// a margin.
///
/// [`ROTATION_LIMIT`]: crate::base::math::ROTATION_LIMIT
pub(super) const LEAST_STRETCH: f64 = 0.98;

/// A bound of the rounding of an entry of R⁻¹, of products with it and of sums of a few of these, relative to the lengths that go
/// in, with a margin of 4.
const ROUNDING: f64 = 256.0 * UNIT_ROUNDOFF;

impl PlacedGround<'_> {
    /// A box in the world around the whole ground, a little larger than it need be: its least and its greatest corner.
    pub(crate) fn world_box(&self) -> [Vector; 2] {
        let Bounds { lower, upper } = *self.ground.tree().bounds();
        let (middle, half) = (0.5 * lower + 0.5 * upper, 0.5 * upper - 0.5 * lower);
        let at = self.pose.transform(&middle);
        let size = self.pose.translation().lp_norm(1) + 2.0 * (middle.lp_norm(1) + half.lp_norm(1));
        let half = (self.pose.rotation().abs() * half).add_scalar(ROUNDING * size);
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
}

impl Reach {
    /// For poses that are accepted.
    ///
    /// # Errors
    /// [`Error::Bug`].
    pub fn new(body: Placed, ground: PlacedGround) -> Result<Reach> {
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
        let swept = body.shape.swept_radius() / LEAST_STRETCH;
        let half = ((inverse * pose.rotation()).abs() * half).add_scalar(swept + ROUNDING * size);
        let centre = local(&polyhedron.mass.centre_of_mass);
        Ok(Reach { turn, inverse, origin, bounds: Bounds { lower: at - half, upper: at + half }, centre })
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
}
