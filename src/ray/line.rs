//! A line and a placed body in one frame, and the proofs of doubles about them: bounds by planes and by balls, and passing
//! through a polygon.

use super::Ray;
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector, is_unit};
use crate::base::scalar::determinant;
use crate::body::polyhedron::{LARGEST, MergedFace, Polyhedron, SMALLEST};

/// No rotation that is accepted lengthens a vector by more: |RᵀR − I| ≤ 3·10⁻² as a norm.
const LARGEST_STRETCH: f64 = 1.02;

/// Covers underflow in a product of three lengths of [`SMALLEST`] or more: each error below 2⁻¹⁰⁷⁴ times at most 2²⁰². 2⁻⁸⁰⁰.
const UNDERFLOW_GUARD: f64 = f64::from_bits((1023 - 800) << 52);

/// The line of a ray, relative to a placed body. World points are relative to the ray's origin: vertex v is at R·v + `centre`.
pub(super) struct Line<'a> {
    pub polyhedron: &'a Polyhedron,
    pose: &'a Pose,
    /// The radius of the ball that is swept over the polyhedron; 0 without.
    pub swept_radius: f64,
    /// The ray's direction.
    pub direction: Vector,
    /// The centre of the body's coordinates.
    centre: Vector,
    /// R⁻¹, rounded; with a swept radius nothing asks for it.
    inverse: Matrix,
    /// No point of the body is farther from the ray's origin than 1.03 times this: a length that rounding errors are in
    /// proportion to.
    pub reach: f64,
    /// The 1-norm of the direction.
    length: f64,
}

/// Position of a line relative to a directed one that it passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LineSide {
    Left,
    Right,
}

/// The line's stretch on a plane: between these.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlaneCrossing {
    /// Nothing of the body is on the line before the lower end if the plane faces it, or after the upper end if not. The points of
    /// the plane's face are between both.
    pub at: [f64; 2],
    /// Whether the plane's normal is against the line.
    pub faces: bool,
    /// The plane's normal in the world, about of unit length.
    pub normal: Vector,
}

/// How a line passes a ball.
#[derive(Debug, Clone, Copy)]
pub(super) enum Chord {
    Missed,
    /// Rounding hides whether it does.
    Unclear,
    /// Through it: in between the first two places, and out between the others.
    Passed {
        entry: [f64; 2],
        exit: [f64; 2],
    },
}

impl<'a> Line<'a> {
    /// None where magnitudes are left to integers.
    pub fn new(polyhedron: &'a Polyhedron, pose: &'a Pose, ray: &Ray, swept_radius: f64) -> Option<Line<'a>> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let translation = pose.translation();
        // For a polyhedron smaller than its ball, what underflows is negligible beside the ball.
        let is_in_range = (SMALLEST..=LARGEST).contains(&polyhedron.radius.max(swept_radius))
            && (SMALLEST..=LARGEST).contains(&direction.amax())
            && origin.amax().max(translation.amax()).max(polyhedron.centre.amax()) <= LARGEST;
        if !is_in_range {
            return None;
        }
        let inverse = if swept_radius > 0.0 { Matrix::zeros() } else { inverse(pose) };
        let from_origin = translation - origin;
        let centre = from_origin + pose.rotate(&polyhedron.centre);
        let reach = norm1(&from_origin) + norm1(&polyhedron.centre) + polyhedron.radius + swept_radius;
        Some(Line { polyhedron, pose, swept_radius, direction, centre, inverse, reach, length: norm1(&direction) })
    }

    /// The position of a vertex.
    ///
    /// Off by at most 8u·`reach`: u for the difference of translation and origin, 3u for each component of the two rotated vectors,
    /// 5.3u of their length, and u for each of the two sums.
    pub fn vertex(&self, vertex: u32) -> Vector {
        debug_assert!((vertex as usize) < self.polyhedron.vertices.len());
        self.pose.rotate(&self.polyhedron.vertices[vertex as usize].position) + self.centre
    }

    /// A direction of the world as the support function of the body takes it, see [`Pose::rotate_back`].
    pub fn rotate_back(&self, direction: &Vector) -> Vector {
        self.pose.rotate_back(direction)
    }

    /// From the centre to about where the line along a unit vector comes into the sphere around the body, or passes it; of length 1
    /// or less.
    pub fn towards_sphere(&self, along: &Vector) -> Vector {
        debug_assert!(is_unit(along));
        let across = along * self.centre.dot(along) - self.centre;
        let depth = (self.sphere() * self.sphere() - across.norm_squared()).max(0.0).sqrt();
        let way = across - along * depth;
        way / way.norm().max(self.sphere())
    }

    /// Its direction in the body's axes, rounded.
    pub fn local_direction(&self) -> Vector {
        debug_assert!(self.swept_radius == 0.0);
        self.inverse * self.direction
    }

    /// The ray's origin in centred coordinates, rounded.
    pub fn local_origin(&self) -> Vector {
        debug_assert!(self.swept_radius == 0.0);
        -(self.inverse * self.centre)
    }

    /// Whether the line passes by the bounding sphere, or the ray leads away from it.
    pub fn passes_sphere(&self) -> bool {
        // The products are off by less than 8u of the lengths, as is the centre.
        let least = self.sphere() * self.length;
        self.direction.cross(&self.centre).norm() > least || self.direction.dot(&self.centre) < -least
    }

    /// The radius of a sphere around `centre`, rounding included, that the body is in.
    fn sphere(&self) -> f64 {
        LARGEST_STRETCH * self.polyhedron.radius + self.swept_radius + 24.0 * U * self.reach
    }

    /// The crossing with the plane of a face, see [`Line::crossing`]; none where rounding hides which way.
    pub fn crossing_of(&self, face: &MergedFace) -> Option<PlaneCrossing> {
        self.crossing(&face.normal, face.slack, face.vertex)
    }

    /// The crossing with the plane through a vertex whose unit outward normal n is given in the body's axes. The body lies behind
    /// that plane, up to its slack.
    pub fn crossing(&self, normal: &Vector, slack: f64, vertex: u32) -> Option<PlaneCrossing> {
        debug_assert!(slack >= 0.0);
        // For any U, and g = RᵀU = n + r: the largest U·(R·p + T) over the body is less than that of the vertex plus the slack
        // plus 2ρ|r|. The computed r is off by 8u.
        debug_assert!(self.swept_radius == 0.0);
        let world = self.inverse.tr_mul(normal);
        let missed = norm1(&(self.pose.rotate_back(&world) - normal)) + 8.0 * U;
        let height = world.dot(&self.vertex(vertex));
        // |U| ≤ 1.02: 8.2u of the reach for the vertex, 3.3u for the product, 1.1u for the sums below.
        self.crossing_at(world, height, slack + 2.0 * self.polyhedron.radius * missed + 16.0 * U * self.reach)
    }

    /// The crossing with the plane that supports the body with its ball along a unit vector, rounded, of the world. `vertex` is
    /// the polyhedron's support vertex, up to an excess.
    pub fn crossing_of_support(&self, normal: &Vector, vertex: u32, excess: f64) -> Option<PlaneCrossing> {
        let [height, error] = self.support(normal, vertex, excess);
        self.crossing_at(*normal, height, error)
    }

    /// Whether all of the ray is on the outer side of such a plane, as far as it is in the sphere around the body.
    pub fn is_in_front(&self, normal: &Vector, vertex: u32, excess: f64, t_max: f64) -> bool {
        let [height, error] = self.support(normal, vertex, excess);
        let square = self.direction.norm_squared();
        let (middle, half) = (self.direction.dot(&self.centre) / square, 1.01 * self.sphere() / square.sqrt());
        let [from, to] = [(middle - half).max(0.0), (middle + half).min(t_max)];
        // These places are within 2.1 times the reach: 6.3u of that for the slope, 2.1u for its product, 3.3u for the difference.
        let along = normal.dot(&self.direction);
        [from, to].iter().all(|t| t * along - height > error + 16.0 * U * self.reach)
    }

    /// How far the body with its ball reaches along a unit vector, and the rounding error: as of a face, with 5u of the radius for
    /// the length of the vector, and 2.1u for the sum.
    fn support(&self, normal: &Vector, vertex: u32, excess: f64) -> [f64; 2] {
        // Of what is no direction this is a NaN, which proves nothing.
        debug_assert!(!((normal.norm() - 1.0).abs() > 8.0 * U), "{normal:?}");
        let height = normal.dot(&self.vertex(vertex)) + self.swept_radius;
        [height, excess * (1.0 + 64.0 * U) + 24.0 * U * self.reach]
    }

    /// The crossing with a plane of a normal of about unit length, the height of which is off by at most an error.
    fn crossing_at(&self, normal: Vector, height: f64, error: f64) -> Option<PlaneCrossing> {
        let along = normal.dot(&self.direction);
        let along_error = 4.0 * U * self.length;
        if !(along.abs() > along_error) {
            return None;
        }
        let at = quotient([height - error, height + error], [along - along_error, along + along_error]);
        Some(PlaneCrossing { at, faces: along < 0.0, normal })
    }

    /// How it passes the ball around a point of the polyhedron, computed from vertices with convex weights; `norm` is that of its
    /// direction.
    ///
    /// Vertices are off by 8u of the reach, such a point by less than 24u. With c the point and d the direction, |c × d|/|d| is the
    /// distance of the line from it, off by 8u more, c·d/|d| the middle of the chord, off by 4u, half the chord by 4u of the
    /// radius. The quotients by |d| are off by 5u of themselves, of 2.1 times the reach; the sums by 5u.
    #[inline(always)]
    pub fn chord(&self, point: &Vector, norm: f64) -> Chord {
        let (inverse, error) = (1.0 / norm, 56.0 * U * self.reach);
        let distance = self.direction.cross(point).norm() * inverse;
        let [nearer, farther] = [(distance - error).max(0.0), distance + error];
        // False for a NaN.
        if !(farther <= self.swept_radius) {
            return if nearer > self.swept_radius { Chord::Missed } else { Chord::Unclear };
        }
        let half = |distance: f64| ((self.swept_radius - distance) * (self.swept_radius + distance)).sqrt();
        let [least, most] = [half(farther) - error, half(nearer) + error];
        let middle = self.direction.dot(point) * inverse;
        let at = |along: f64| along * inverse;
        Chord::Passed { entry: [at(middle - most), at(middle - least)], exit: [at(middle + least), at(middle + most)] }
    }

    /// Whether it provably passes through the hull of corners, given counter-clockwise as seen from where it comes (`faces`) or
    /// goes.
    ///
    /// Seen along the line, they are the corners of a closed polygon. If the line is on the inner side of each of its sides, it
    /// winds around the line, which is then in the hull of the corners, whether these are in one plane or not.
    pub fn passes_through(&self, corners: &[u32], faces: bool) -> bool {
        debug_assert!(corners.len() >= 3);
        let inner = if faces { LineSide::Left } else { LineSide::Right };
        (0..corners.len()).all(|k| self.side([corners[k], corners[(k + 1) % corners.len()]]) == Some(inner))
    }

    /// On which side it passes by the line from one vertex to another, seen along its direction; none where rounding hides it.
    pub fn side(&self, [tail, head]: [u32; 2]) -> Option<LineSide> {
        let [from, to] = [tail, head].map(|v| &self.polyhedron.vertices[v as usize].position);
        let side = self.pose.rotate(&(to - from));
        let volume = determinant([self.direction.into(), side.into(), self.vertex(tail).into()]);
        let error = SIDE * self.length * norm1(&side) * self.reach + UNDERFLOW_GUARD;
        if volume.abs() > error {
            return Some(if volume > 0.0 { LineSide::Left } else { LineSide::Right });
        }
        None
    }

    /// Whether an interval of the line is narrow: 2⁻⁴⁰ of the lengths that rounding errors are in proportion to.
    pub fn is_narrow(&self, [low, high]: [f64; 2]) -> bool {
        const NARROW: f64 = 1.0 / (1_u64 << 40) as f64;
        (high - low) * self.length <= NARROW * self.reach
    }
}

/// Relative to |d||side|·reach: 6.6u for the side, 8.3u for the vertex, 4.2u for their product, 3.2u for the other.
pub const SIDE: f64 = 32.0 * U;

/// R⁻¹ of a pose.
fn inverse(pose: &Pose) -> Matrix {
    let rotation = pose.rotation();
    let columns = [0, 1, 2].map(|k| rotation.row(k).transpose());
    let cofactors = Matrix::from_columns(&[
        columns[1].cross(&columns[2]),
        columns[2].cross(&columns[0]),
        columns[0].cross(&columns[1]),
    ]);
    cofactors / columns[0].dot(&cofactors.column(0))
}

fn norm1(v: &Vector) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// An interval that holds all quotients; no denominator is 0, and all have one sign.
fn quotient(numerators: [f64; 2], denominators: [f64; 2]) -> [f64; 2] {
    debug_assert!(denominators[0] * denominators[1] > 0.0);
    let quotients = numerators.map(|n| denominators.map(|d| n / d));
    let all = quotients.as_flattened();
    let (low, high) = all[1..].iter().fold((all[0], all[0]), |(low, high), &q| (low.min(q), high.max(q)));
    // A denominator and the quotient are rounded once each; numerators are covered by their error.
    [low - 4.0 * U * low.abs(), high + 4.0 * U * high.abs()]
}
