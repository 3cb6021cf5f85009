//! The pose of a body in the frame of a ground.

use super::PlacedGround;
use super::tree::NodeBounds;
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

/// Rotations with no entry of RᵀR − I above this are taken for rigid.
const RIGID: f64 = 16.0 * UNIT_ROUNDOFF;

impl PlacedGround<'_> {
    /// A box in the world around all that the ground acts on, a little larger than it need be: its least and its greatest corner.
    pub(crate) fn world_box(&self) -> [Vector; 2] {
        let NodeBounds { lower, upper } = self.ground.layout().bounds();
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

/// The body's own box and its ball, in the frame of the ground.
struct OwnReach {
    /// The middle of the box, its axes in columns, and half its sides.
    middle: Vector,
    axes: Matrix,
    half: Vector,
    /// How far the box reaches from its middle along each of its axes, times their lengths, which are next.
    along: Vector,
    lengths: Vector,
    /// The middle of the ball, and its radius.
    centre: Vector,
    radius: f64,
    /// How far the body may reach beyond both, its swept radius and rounding included.
    slack: f64,
}

/// Lengths along vectors that are of length 1 up to rounding are no longer than this.
const SHORTER: f64 = 1.0 - 32.0 * UNIT_ROUNDOFF;

/// A body beside a ground.
pub(super) struct GroundReach {
    own: OwnReach,
    /// The ground's rotation, its inverse, and where its origin is.
    turn: Matrix,
    inverse: Matrix,
    origin: Vector,
    /// A box around the body, in the frame of the ground, a little larger than it need be.
    pub bounds: NodeBounds,
    /// Its centre of mass there, and in the world.
    pub centre: Vector,
    pub centre_in_world: Vector,
    /// How far both origins are from that of the world, and the body from its own, twice: what rounding errors go by.
    pub size: f64,
    /// Whether the body's rotation is one up to rounding: then its transpose is taken for the inverse.
    pub is_rigid: bool,
    /// A length of the ground's frame is at least so many times as long in the world.
    pub stretch: f64,
}

impl GroundReach {
    /// For poses that are accepted.
    ///
    /// # Errors
    /// [`Error::Bug`].
    pub fn new(body: Placed, ground: PlacedGround) -> Result<GroundReach> {
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
        // A pose does not stretch the ball that is swept, nor a deviation.
        let beyond = (body.shape.swept_radius() + body.shape.deviation()) / stretch + ROUNDING * size;
        let (axes, ends) = (inverse * pose.rotation(), ground.ground.layout().bounds());
        let own = OwnReach {
            middle: at,
            axes,
            half: *half,
            along: (axes.tr_mul(&axes)).abs() * half,
            lengths: Vector::from_fn(|k, _| axes.column(k).norm()),
            centre: local(&polyhedron.centre),
            radius: polyhedron.radius * pose.most_stretched() / stretch,
            slack: beyond + 64.0 * UNIT_ROUNDOFF * (ends.lower.lp_norm(1) + ends.upper.lp_norm(1)),
        };
        let half = (axes.abs() * half).add_scalar(beyond);
        let centre_in_world = pose.transform(&polyhedron.mass.centre_of_mass);
        Ok(GroundReach {
            own,
            turn,
            inverse,
            origin,
            bounds: NodeBounds { lower: at - half, upper: at + half },
            centre: inverse * (centre_in_world - origin),
            centre_in_world,
            size: pose.translation().lp_norm(1)
                + origin.lp_norm(1)
                + 2.0 * (polyhedron.centre.lp_norm(1) + 2.0 * polyhedron.radius),
            is_rigid: pose.rotation_defect() <= RIGID,
            stretch,
        })
    }

    /// Whether all of the body is farther than `enough` over the plane of a triangle, as its box and its ball tell. In the frame of
    /// the ground, as all of these.
    ///
    /// Placed points are off by less than `slack`, the products with the triangle's normal and corners included; lengths along a
    /// vector of length 1 + 4u.
    pub fn is_over(&self, normal: &Vector, corner: &Vector, enough: f64) -> bool {
        let OwnReach { middle, axes, half, centre, radius, slack, .. } = &self.own;
        let [x, y, z] = [0, 1, 2].map(|k| axes.column(k).dot(normal).abs() * half[k]);
        let of_box = normal.dot(&(middle - corner)) - (x + y + z);
        let of_ball = normal.dot(&(centre - corner)) - radius;
        (of_box.max(of_ball) - slack) * SHORTER > enough
    }

    /// Whether a triangle is farther than `enough` from the body's ball, or beside its box along one of its axes.
    pub fn is_beside(&self, corners: &[Vector; 3], enough: f64) -> bool {
        let OwnReach { middle, axes, along, lengths, centre, radius, slack, .. } = &self.own;
        let bounds = NodeBounds::of(corners);
        let outside = (bounds.lower - centre).sup(&(centre - bounds.upper)).sup(&Vector::zeros());
        let far = (enough / SHORTER + radius + slack).max(0.0);
        if outside.norm_squared() * SHORTER > far * far {
            return true;
        }
        let [a, b, c] = corners.map(|corner| corner - middle);
        (0..3).any(|k| {
            let axis = axes.column(k);
            let limit = along[k] + (enough / SHORTER + slack) * lengths[k];
            let heights = [axis.dot(&a), axis.dot(&b), axis.dot(&c)];
            heights.iter().all(|height| *height > limit) || heights.iter().all(|height| *height < -limit)
        })
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
    pub fn gap_along_way(&self, body: Placed, other: &NodeBounds) -> f64 {
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
        let radius = (body.shape.swept_radius() + body.shape.deviation()) * (1.0 + 16.0 * UNIT_ROUNDOFF);
        // Lengths along a vector of length 1 + 4u.
        let gap = low - high - of_vertex(polyhedron, vertex, &downwards) - radius - 64.0 * UNIT_ROUNDOFF * size;
        gap * (1.0 - 16.0 * UNIT_ROUNDOFF)
    }
}
