//! How far a body reaches, wherever it is placed: the data for the boxes and spheres of a scene. All of it errs outwards, or
//! inwards where that is the safe side.

use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::base::memory::with_capacity;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;

const U: f64 = UNIT_ROUNDOFF;

/// Bodies of more vertices take the box around their own turned box: looking at all vertices takes 44 ns for 102, 274 ns for 1002.
const MOST_POINTS: usize = 512;

/// Magnitudes outside [2⁻⁸⁰, 2⁸⁰] are left to spheres: within, products of single-precision numbers neither overflow nor lose
/// digits that 2⁻²⁴ρ does not cover.
const LARGEST: f64 = f64::from_bits((1023 + 80) << 52);
const SMALLEST: f64 = f64::from_bits((1023 - 80) << 52);

/// Radii about the centred origin, and the data that boxes are computed from.
#[derive(Debug, Clone)]
pub(crate) struct Extent {
    /// A ball of this radius about the centred origin is in the body; −∞ where no ball is or rounding hides it. For a point or
    /// segment it is 0 or less: if that and a swept radius are more than 0, such a ball is in the swept body.
    pub(crate) inner_radius: f64,
    /// No point of the body is farther from the *local* origin: |centre| + ρ, rounded up.
    pub(crate) lever: f64,
    /// The box in centred coordinates.
    middle: Vector,
    half: Vector,
    /// Vertices in centred coordinates, in single precision, eight at a time; the last one repeated. Empty for bodies with many.
    points: Vec<[[f32; 8]; 3]>,
}

/// How far a placed body reaches from its centre along the world's axes: `lower` ≤ x − centre ≤ `upper` for its points x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reach {
    pub(crate) lower: [f64; 3],
    pub(crate) upper: [f64; 3],
}

impl Extent {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn new(polyhedron: &Polyhedron) -> Result<Extent> {
        let positions = || polyhedron.vertices.iter().map(|vertex| vertex.position);
        let corner = |pick: fn(f64, f64) -> f64| positions().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_default();
        let (lower, upper) = (corner(f64::min), corner(f64::max));
        let middle = 0.5 * lower + 0.5 * upper;
        // For each axis, rounded up: the two halves and their difference are off by at most 4u of the larger end.
        let half =
            Vector::from_fn(|i, _| (0.5 * upper[i] - 0.5 * lower[i]) + 4.0 * U * lower[i].abs().max(upper[i].abs()));
        let radius = polyhedron.radius;
        let mut points = Vec::new();
        if polyhedron.vertices.len() <= MOST_POINTS && (SMALLEST..=LARGEST).contains(&radius) {
            points = with_capacity(polyhedron.vertices.len().div_ceil(8))?;
            for block in polyhedron.vertices.chunks(8) {
                let of = |lane: usize| block[lane.min(block.len() - 1)].position;
                points.push([0, 1, 2].map(|axis| std::array::from_fn(|lane| of(lane)[axis] as f32)));
            }
        }
        let lever = (polyhedron.centre.norm() + radius) * (1.0 + 8.0 * U);
        Ok(Extent { inner_radius: inner_radius(polyhedron), lever, middle, half, points })
    }

    /// The middle of the box in centred coordinates and its half sides, rounded up.
    pub(crate) fn box_about_centre(&self) -> (&Vector, &Vector) {
        (&self.middle, &self.half)
    }

    /// Memory held beside the struct, in bytes.
    pub(crate) fn heap_bytes(&self) -> usize {
        size_of_val(&self.points[..])
    }

    /// How far the body reaches from its centre when placed so; `radius` is that of the placed bounding sphere.
    pub(crate) fn reach(&self, pose: &Pose, radius: f64) -> Reach {
        debug_assert!(radius >= 0.0);
        if self.points.is_empty() { self.reach_of_box(pose, radius) } else { self.reach_of_points(pose, radius) }
    }

    /// |R|·half about R·middle, computed to about 8u of the radius.
    fn reach_of_box(&self, pose: &Pose, radius: f64) -> Reach {
        debug_assert!(radius >= 0.0);
        let error = 32.0 * U * radius;
        let mut reach = Reach { lower: [-radius; 3], upper: [radius; 3] };
        for (axis, [x, y, z, _]) in pose.rows.iter().enumerate() {
            let middle = x * self.middle.x + y * self.middle.y + z * self.middle.z;
            let half = x.abs() * self.half.x + y.abs() * self.half.y + z.abs() * self.half.z + error;
            // A NaN of infinite sizes passes neither comparison.
            if middle - half > -radius {
                reach.lower[axis] = middle - half;
            }
            if middle + half < radius {
                reach.upper[axis] = middle + half;
            }
        }
        reach
    }

    /// Over all vertices, in single precision: R and p rounded, three products and two sums are off by at most 5.2·2⁻²⁴ of
    /// |R's row|·|p| ≤ 1.02ρ, and of the box around something else, whose corners may be out of the ball, √3 of that.
    fn reach_of_points(&self, pose: &Pose, radius: f64) -> Reach {
        debug_assert!(radius >= 0.0);
        let error = 12.0 * f64::from(f32::EPSILON / 2.0) * radius;
        let mut turned = Turned { pose, points: &self.points, ends: [[0.0; 2]; 3] };
        simd::dispatch(&mut turned);
        Reach {
            lower: turned.ends.map(|[least, _]| (f64::from(least) - error).max(-radius)),
            upper: turned.ends.map(|[_, greatest]| (f64::from(greatest) + error).min(radius)),
        }
    }
}

/// The ends of turned points along the three axes.
struct Turned<'a> {
    pose: &'a Pose,
    points: &'a [[[f32; 8]; 3]],
    ends: [[f32; 2]; 3],
}

impl Kernel for Turned<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        for (ends, row) in self.ends.iter_mut().zip(&self.pose.rows) {
            *ends = L::load(row).extreme_products(self.points);
        }
    }
}

/// The least distance of the origin from the planes of the hull's triangles, rounded down; −∞ unless it is certainly inside.
///
/// The sides p and q of a triangle are differences of exact coordinates, off by u in each component; det(a, p, q) of three columns
/// is then off by less than 16u·|a||p||q|, and |p × q| by less than 8u·|p||q|.
///
/// Of a point or segment it is minus the distance of the origin from the middle, half of |p + q|₁ at most: a tenth of that covers
/// rounding, and what poses stretch.
fn inner_radius(polyhedron: &Polyhedron) -> f64 {
    let ends = &polyhedron.vertices;
    if polyhedron.dimension < 2 && polyhedron.simple {
        return -0.55 * (ends[0].position + ends[ends.len() - 1].position).abs().sum();
    }
    if polyhedron.dimension < 3 || !polyhedron.simple {
        return f64::NEG_INFINITY;
    }
    let distance = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|v| polyhedron.vertices[v as usize].position);
        let (p, q) = (b - a, c - a);
        let normal = p.cross(&q);
        let scale = p.norm() * q.norm();
        let height = a.dot(&normal) - 32.0 * U * a.norm() * scale;
        height / (normal.norm() * (1.0 + 8.0 * U) + 16.0 * U * scale)
    };
    // False for a NaN.
    let least =
        polyhedron.triangles.iter().map(distance).fold(f64::INFINITY, |least, d| if d > least { least } else { d });
    if least > 0.0 && least < polyhedron.radius { least * (1.0 - 16.0 * U) } else { f64::NEG_INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{InputPolicy, Shape, ShapeOptions};
    use swiftprox::random::Random;

    fn hull(points: &[Vector]) -> Shape {
        let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        Shape::from_points(points, &options).unwrap()
    }

    #[test]
    fn nothing_protrudes_and_little_is_given_away() {
        let mut random = Random::new(0xb0);
        for round in 0..if cfg!(miri) { 4 } else { 300 } {
            let half = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.05], [1.0, 0.05, 0.05], [1.0, 1.0, 0.0]][round % 4];
            let count = [8, 60, 700][round % 3];
            let scale = [1.0, 1e-12, 1e20, 1e-60, 1e60][round % 5];
            let offset = if round % 7 == 0 { Vector::new(5.0, 1.0, 0.5) * scale } else { Vector::zeros() };
            let axes = Vector::from(half) * scale;
            let points: Vec<Vector> = (0..count).map(|_| random.direction().component_mul(&axes) + offset).collect();
            let shape = hull(&points);
            let (polyhedron, extent) = (shape.polyhedron(), shape.extent());
            let stretch = [0.0, 1e-3][round % 2];
            let rotation = random.rotation() * (1.0 + stretch);
            let pose = Pose::new(&rotation, &Vector::zeros());
            let radius = polyhedron.radius * (1.0 + 2.1 * stretch + 1e-14);
            let reach = extent.reach(&pose, radius);
            for axis in 0..3 {
                let along = polyhedron.vertices.iter().map(|vertex| pose.rotate(&vertex.position)[axis]);
                let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| (l.min(x), h.max(x)));
                assert!(reach.lower[axis] <= low && high <= reach.upper[axis], "{round}: {reach:?} {low} {high}");
                // The vertices themselves leave rounding; a turned box at most its diagonal.
                let given_away = if count <= MOST_POINTS && scale > 1e-20 && scale < 1e21 { 1e-5 } else { 1.0 };
                assert!(reach.upper[axis] - high <= given_away * radius, "{round}: {reach:?} {high}");
            }
        }
    }

    #[test]
    fn the_inner_ball_is_inside_and_as_large_as_may_be() {
        let cube: Vec<Vector> =
            (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -0.5 } else { 0.5 })).collect();
        let radius = hull(&cube).extent().inner_radius;
        assert!(radius <= 0.5 && radius > 0.5 - 1e-14, "{radius}");
        // A point, its own centre, and a segment about its middle.
        for points in [vec![Vector::zeros()], vec![Vector::x() * 0.7, Vector::x() * -0.7]] {
            assert_eq!(hull(&points).extent().inner_radius, 0.0);
        }
        // Origin on a corner, outside, and no interior.
        let corner: Vec<Vector> = cube.iter().map(|p| p + Vector::repeat(0.5)).collect();
        let outside: Vec<Vector> = cube.iter().map(|p| p + Vector::new(0.9, 0.0, 0.0)).collect();
        for points in [&corner, &outside, &cube[..4].to_vec()] {
            assert_eq!(hull(points).extent().inner_radius, f64::NEG_INFINITY);
        }
    }
}
