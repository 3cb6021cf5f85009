//! A line and a placed body in one frame, and what doubles prove of them: bounds by planes, and passing through a polygon.

use super::Ray;
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::scalar::determinant;
use crate::polyhedron::{Face, LARGEST, Polyhedron, SMALLEST};

/// No rotation that is accepted lengthens a vector by more: |RᵀR − I| ≤ 3·10⁻² as a norm.
const LARGEST_STRETCH: f64 = 1.02;

/// Covers what underflows in a product of three lengths of [`SMALLEST`] or more: each error below 2⁻¹⁰⁷⁴ times at most 2²⁰². 2⁻⁸⁰⁰.
const UNDERFLOW_GUARD: f64 = f64::from_bits((1023 - 800) << 52);

/// The line of a ray, relative to a placed body. World points are relative to the ray's origin: vertex v is at R·v + `centre`.
pub(super) struct Line<'a> {
    pub polyhedron: &'a Polyhedron,
    pose: &'a Pose,
    /// Of the ray.
    pub direction: Vector,
    /// Where the centre of the body's coordinates is.
    centre: Vector,
    /// R⁻¹, rounded.
    inverse: Matrix,
    /// No vertex is farther from the ray's origin than 1.03 times this: of lengths that rounding errors are in proportion to.
    reach: f64,
    /// The 1-norm of the direction.
    length: f64,
}

/// Where a line passes by a directed one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// Where the line is on a plane: between these.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// Nothing of the body is on the line before the lower end if the plane faces it, or after the upper end if not. The points of
    /// the plane's face are between both.
    pub at: [f64; 2],
    /// Whether the plane's normal is against the line.
    pub faces: bool,
    /// The plane's normal in the world, about of unit length.
    pub normal: Vector,
}

impl<'a> Line<'a> {
    /// None where magnitudes are left to integers.
    pub fn new(polyhedron: &'a Polyhedron, pose: &'a Pose, ray: &Ray) -> Option<Line<'a>> {
        let (origin, direction) = (ray.origin(), ray.direction());
        let translation = pose.translation();
        let is_in_range = (SMALLEST..=LARGEST).contains(&polyhedron.radius)
            && (SMALLEST..=LARGEST).contains(&direction.amax())
            && origin.amax().max(translation.amax()).max(polyhedron.centre.amax()) <= LARGEST;
        if !is_in_range {
            return None;
        }
        let rotation = pose.rotation();
        let columns = [0, 1, 2].map(|k| rotation.row(k).transpose());
        let cofactors = Matrix::from_columns(&[
            columns[1].cross(&columns[2]),
            columns[2].cross(&columns[0]),
            columns[0].cross(&columns[1]),
        ]);
        let inverse = cofactors / columns[0].dot(&cofactors.column(0));
        let from_origin = translation - origin;
        let centre = from_origin + pose.rotate(&polyhedron.centre);
        let reach = norm1(&from_origin) + norm1(&polyhedron.centre) + polyhedron.radius;
        Some(Line { polyhedron, pose, direction, centre, inverse, reach, length: norm1(&direction) })
    }

    /// Where a vertex is.
    ///
    /// Off by at most 8u·`reach`: u for the difference of translation and origin, 3u for each component of the two rotated vectors,
    /// 5.3u of their length, and u for each of the two sums.
    fn vertex(&self, vertex: u32) -> Vector {
        self.pose.rotate(&self.polyhedron.vertices[vertex as usize].position) + self.centre
    }

    /// Its direction in the body's axes, rounded.
    pub fn local_direction(&self) -> Vector {
        self.inverse * self.direction
    }

    /// The ray's origin in centred coordinates, rounded.
    pub fn local_origin(&self) -> Vector {
        -(self.inverse * self.centre)
    }

    /// Whether the line passes by the bounding sphere, or the ray leads away from it.
    pub fn passes_sphere(&self) -> bool {
        // The products are off by less than 8u of the lengths, as is the centre.
        let least = (LARGEST_STRETCH * self.polyhedron.radius + 24.0 * U * self.reach) * self.length;
        self.direction.cross(&self.centre).norm() > least || self.direction.dot(&self.centre) < -least
    }

    /// Where it crosses the plane of a face, see [`Line::crossing`]; none where rounding hides which way.
    pub fn crossing_of(&self, face: &Face) -> Option<Crossing> {
        self.crossing(&face.normal, face.slack, face.vertex)
    }

    /// Where it crosses the plane through a vertex whose unit outward normal n is given in the body's axes, and behind which, up to
    /// its slack, the body lies.
    pub fn crossing(&self, normal: &Vector, slack: f64, vertex: u32) -> Option<Crossing> {
        // For any U, and g = RᵀU = n + r: of U·(R·p + T) over the body the largest is less than that of the vertex plus the slack
        // plus 2ρ|r|. The computed r is off by 8u.
        let world = self.inverse.tr_mul(normal);
        let missed = norm1(&(self.pose.rotate_back(&world) - normal)) + 8.0 * U;
        let height = world.dot(&self.vertex(vertex));
        // |U| ≤ 1.02: 8.2u of the reach for the vertex, 3.3u for the product, 1.1u for the sums below.
        let error = slack + 2.0 * self.polyhedron.radius * missed + 16.0 * U * self.reach;
        let along = world.dot(&self.direction);
        let along_error = 4.0 * U * self.length;
        if !(along.abs() > along_error) {
            return None;
        }
        let at = quotient([height - error, height + error], [along - along_error, along + along_error]);
        Some(Crossing { at, faces: along < 0.0, normal: world })
    }

    /// Whether it surely passes through the hull of corners, given counter-clockwise as seen from where it comes (`faces`) or goes.
    ///
    /// Seen along the line, they are the corners of a closed polygon. If the line is on the inner side of each of its sides, it
    /// winds around the line, which is then in the hull of the corners, whether these are in one plane or not.
    pub fn passes_through(&self, corners: &[u32], faces: bool) -> bool {
        let inner = if faces { Side::Left } else { Side::Right };
        (0..corners.len()).all(|k| self.side([corners[k], corners[(k + 1) % corners.len()]]) == Some(inner))
    }

    /// On which side it passes by the line from one vertex to another, seen along its direction; none where rounding hides it.
    pub fn side(&self, [tail, head]: [u32; 2]) -> Option<Side> {
        let [from, to] = [tail, head].map(|v| &self.polyhedron.vertices[v as usize].position);
        let side = self.pose.rotate(&(to - from));
        let volume = determinant([self.direction.into(), side.into(), self.vertex(tail).into()]);
        let error = SIDE * self.length * norm1(&side) * self.reach + UNDERFLOW_GUARD;
        if volume.abs() > error {
            return Some(if volume > 0.0 { Side::Left } else { Side::Right });
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

fn norm1(v: &Vector) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// An interval that holds all quotients; no denominator is 0, and all have one sign.
fn quotient(numerators: [f64; 2], denominators: [f64; 2]) -> [f64; 2] {
    let quotients = numerators.map(|n| denominators.map(|d| n / d));
    let all = quotients.as_flattened();
    let (low, high) = all[1..].iter().fold((all[0], all[0]), |(low, high), &q| (low.min(q), high.max(q)));
    // A denominator and the quotient are rounded once each; numerators are covered by their error.
    [low - 4.0 * U * low.abs(), high + 4.0 * U * high.abs()]
}
