//! The lowest vertex of a body over the plane of a triangle. It tells most triangles that are out of reach; where it is over the
//! triangle and not below, it is the nearest point.

use super::PlacedGround;
use super::marks::Marks;
use super::reach::GroundReach;
use super::vertices::Vertices;
use crate::answer::Radii;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, clamp, is_unit};
use crate::pair::{Feature, FeatureKind, Outcome, Placed, SignedDistance};
use crate::shape::Triangle;

/// A triangle in the world.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlacedTriangle {
    pub own: Triangle,
    pub marks: Marks,
    /// Its normal and its corners.
    pub up: Vector,
    pub corners: [Vector; 3],
    /// How far heights over it, and feet on it, may be off.
    pub error: f64,
}

impl PlacedTriangle {
    /// For a ground beside a body, both with poses that are accepted.
    ///
    /// A point that is placed is right to 6u of its translation and of twice its local length, the difference of two to u of
    /// both, the product with a direction to 4u of it, the length of the direction to 4u, the order of two heights to 8u, and the
    /// direction inside the body to 7u of twice its radius: all in all less than 64u of those lengths.
    pub fn new(own: Triangle, ground: PlacedGround, reach: &GroundReach) -> PlacedTriangle {
        let corners = own.corners.map(|corner| ground.pose.transform(&corner));
        let lengths = own.corners.iter().map(|corner| corner.lp_norm(1)).sum::<f64>();
        let (marks, up) = (ground.ground.marks(own.label), reach.world_normal(&own.normal));
        PlacedTriangle { own, marks, up, corners, error: 64.0 * U * (reach.size + 2.0 * lengths) }
    }
}

/// The vertex of the polyhedron that is lowest, up to an excess that counts in `lower`.
pub(super) struct Lowest {
    pub vertex: u32,
    /// Its position.
    pub world: Vector,
    /// The direction that is up: the triangle's normal in the world, or another.
    pub up: Vector,
    /// Its height over the first corner of the triangle; all of the polyhedron is at least `lower` over the triangle.
    pub height: f64,
    pub lower: f64,
    pub error: f64,
}

impl Lowest {
    /// For a body and a triangle; a climb begins at `start`.
    ///
    /// Whichever direction is taken for the normal, the difference of heights along it is a lower bound.
    pub fn new(body: &Vertices, triangle: &PlacedTriangle, up: &Vector, start: u32) -> Lowest {
        debug_assert!(is_unit(up));
        let vertex = body.lowest(up, start);
        let world = body.point(vertex);
        let PlacedTriangle { corners, error, .. } = triangle;
        let above_first = |point: &Vector| up.dot(&(point - corners[0]));
        let highest = above_first(&corners[1]).max(above_first(&corners[2])).max(0.0);
        let height = above_first(&world);
        let lower = height - highest - body.excess(vertex, up) - error;
        Lowest { vertex, world, up: *up, height, lower, error: *error }
    }

    /// The signed distance of body and triangle where it is certain that the vertex is nearest: it is over the triangle, and the
    /// polyhedron above it. `inside` is how far its foot is inside the triangle's sides.
    pub fn contact(
        &self,
        body: Placed,
        triangle: &Triangle,
        reach: &GroundReach,
        limit: Limit,
        inside: f64,
    ) -> Option<SignedDistance> {
        if !(self.lower > 0.0 && inside >= 4.0 * self.error) {
            return None;
        }
        let foot = self.world - self.up * self.height;
        let distance = limit.distance([self.lower, self.height + self.error], self.height)?;
        let lowest = self.world - self.up * limit.radius;
        let label = body.shape.polyhedron().vertex_labels[self.vertex as usize];
        Some(SignedDistance {
            local1: local_point(body.pose, &lowest).into(),
            local2: reach.point(&foot).into(),
            world1: lowest.into(),
            world2: foot.into(),
            normal: self.up.into(),
            feature1: Feature { kind: FeatureKind::Vertex, ids: [label, 0] },
            feature2: Feature { kind: FeatureKind::Face, ids: [triangle.label, 0] },
            ..distance
        })
    }

    /// Whether body and triangle certainly have a point in common: where the way from the vertex below its plane to the centre of
    /// mass above crosses it. The heights of both are off by the error, the place where the way crosses by as much and by the part
    /// of the way that this makes.
    pub fn is_through(&self, centre_of_mass: &Vector, triangle: &PlacedTriangle) -> bool {
        let way = centre_of_mass - self.world;
        let rise = self.up.dot(&way);
        if !(self.height < -self.error && rise + self.height > self.error) {
            return false;
        }
        let error = 8.0 * self.error * (1.0 + way.norm() / rise);
        inside_by(triangle, &(self.world - way * (self.height / rise))) >= error
    }

    /// Whether, where they have points in common, no normal that contacts may have overlaps less than the triangle's own, which is
    /// up here: the vertex's foot is so far inside that along a normal at any of those angles a point of the triangle is as high.
    ///
    /// Be δ the depth and r how far the foot is inside. Along a normal at an angle of θ the point r away from the foot to that side
    /// is cos θ·δ + sin θ·r above the vertex, which is δ or more if r ≥ δ·tan(θ/2). So it is for all lesser angles.
    pub fn is_least(&self, triangle: &PlacedTriangle, inside: f64) -> bool {
        let depth = self.error - self.height;
        triangle.marks.tan_half().is_some_and(|tan| inside >= depth * tan * (1.0 + 1e-5) + 4.0 * self.error)
    }
}

/// How far a point of the plane of a triangle is inside its sides; less than 0 beside it.
pub(super) fn inside_by(triangle: &PlacedTriangle, point: &Vector) -> f64 {
    let PlacedTriangle { corners, up, .. } = triangle;
    let mut least = f64::INFINITY;
    for k in 0..3 {
        let [tail, head] = [corners[k], corners[(k + 1) % 3]];
        let inward = up.cross(&(head - tail));
        least = least.min(inward.dot(&(point - tail)) / inward.norm());
    }
    least
}

/// How near a body has to be that has a swept radius.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    pub radius: f64,
    pub max_distance: f64,
}

impl Limit {
    /// Whether a polyhedron that is at least so far away belongs to a body beyond `max_distance`.
    pub fn is_beyond(&self, lower: f64) -> bool {
        debug_assert!(!lower.is_nan());
        Radii::of_one(self.radius, 0.0).off([lower, lower])[0] > self.max_distance
    }

    /// Outcome, interval and estimate of the body for those of its polyhedron, without points; `None` where rounding hides which
    /// sign the distance has, or whether it is more than `max_distance`.
    pub fn distance(&self, of_polyhedron: [f64; 2], estimate: f64) -> Option<SignedDistance> {
        let [lower, upper] = Radii::of_one(self.radius, 0.0).off(of_polyhedron);
        let is_open = |limit: f64| lower <= limit && upper > limit;
        if is_open(0.0) || is_open(self.max_distance) {
            return None;
        }
        let outcome = if lower > 0.0 { Outcome::Separated } else { Outcome::Intersecting };
        let distance = clamp(estimate - self.radius, lower, upper);
        Some(SignedDistance { outcome, distance, lower, upper, ..SignedDistance::default() })
    }
}

/// A point of the world in the frame of a body, also of one that is not quite rigid.
pub(super) fn local_point(pose: &Pose, world: &Vector) -> Vector {
    let from = world - pose.translation();
    pose.rotation().try_inverse().map_or_else(|| pose.rotate_back(&from), |back| back * from)
}

/// Whether a point of the plane of a triangle is in it, and so far from its sides; less than 0 is so far beside it.
pub(super) fn is_inside(triangle: &Triangle, point: &Vector, distance: f64) -> bool {
    (0..3).all(|k| {
        let [tail, head] = [triangle.corners[k], triangle.corners[(k + 1) % 3]];
        let inward = triangle.normal.cross(&(head - tail));
        inward.dot(&(point - tail)) >= distance * inward.norm()
    })
}
