//! Bounds of the distance in double-double arithmetic: from below by the gap along a normal, from above by a point of each body.
//! They hold to the last bit; where they do not suffice, nothing is reported, and integers decide.

use crate::base::double_double::{DoubleDouble, WideVector, narrow, two_product, wide_difference, wide_dot, widen};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, binary_order, clamp, divisor, length, power_of_two};
use crate::base::scalar::Ring;
use crate::body::polyhedron::{Polyhedron, Vertex};
use crate::placed::Pair;
use crate::placed::exact::VertexPair;

/// The error of any length computed here, as a multiple of the size of the pair. A coordinate of R₁·x − R₂·y + Δ takes twelve
/// products, off by 8u² each. It takes as many sums, off by 3u² of at most the size. Together they are below 2⁻¹⁰⁰, and so is what
/// a product with a unit vector adds. Underflow takes less than 2⁻¹⁰⁰⁰ of it, see [`Bounds::unit`].
pub const ERROR: f64 = f64::from_bits((1023 - 94) << 52);

/// A pair of placed bodies, of any magnitudes, in a unit of length in which its size is near 1.
pub struct Bounds<'a> {
    pair: Pair<'a>,
    /// A length in units of the pair is this times as large, a power of two. Thus lengths and coordinates are exact except for
    /// underflow, of less than the least double each, where 2⁻⁷⁴ and more are the size: of subnormal lengths not more is left.
    unit: f64,
    /// From the centred origin of body 2 to that of body 1, in the world.
    between: WideVector,
    /// The most by which a length is off.
    error: f64,
}

/// A gap along a normal.
pub struct ProvedGap {
    value: DoubleDouble,
    /// Vertices that face each other across the gap.
    pub vertices: VertexPair,
}

/// The largest exponent of a [unit](Bounds::unit), either way.
const MOST_SCALED: i32 = 1000;

impl<'a> Bounds<'a> {
    /// `None` of two points in one place, and where the size overflows.
    pub fn new(pair: &Pair<'a>) -> Option<Bounds<'a>> {
        let Pair { polyhedra, poses } = *pair;
        let [translation1, translation2] = poses.map(Pose::translation);
        let apart = wide_difference(&translation1, &translation2);
        // The 1-norm of R·p is at most 1.8|p|, for an accepted R.
        let radii = polyhedra.map(|polyhedron| polyhedron.centre.lp_norm(1) + polyhedron.radius);
        let size = apart.iter().map(|x| x.hi.abs()).sum::<f64>() + 2.0 * (radii[0] + radii[1]);
        if !(size > 0.0 && size < f64::INFINITY) {
            return None;
        }
        let unit = power_of_two(-binary_order(size).clamp(-MOST_SCALED, MOST_SCALED));
        let in_units = |x: DoubleDouble| DoubleDouble { hi: x.hi * unit, lo: x.lo * unit };
        let [centre1, centre2] = [0, 1].map(|i| rotate(poses[i], &widen(&(polyhedra[i].centre * unit))));
        let between = plus_difference(&apart.map(in_units), &centre1, &centre2);
        Some(Bounds { pair: *pair, unit, between, error: ERROR * (size * unit) })
    }

    /// The most by which a coordinate of [`Bounds::difference`] is off.
    pub fn error(&self) -> f64 {
        self.error
    }

    /// A length in units of the pair.
    pub fn in_units(&self, length: f64) -> f64 {
        length * self.unit
    }

    /// The gap along a normal from body 2 to body 1: the lowest vertex of body 1 over the highest of body 2.
    pub fn gap(&self, normal: &Vector) -> ProvedGap {
        let wide = widen(normal);
        let (below1, vertex1) = self.highest(0, &widen(&-normal));
        let (above2, vertex2) = self.highest(1, &wide);
        let value = over_both(&wide, &self.between, below1, above2);
        ProvedGap { value, vertices: [vertex1, vertex2] }
    }

    /// The largest value of a world direction over all vertices of a body, about its centred origin, and a vertex that has it.
    /// Doubles determine which vertices may have it.
    fn highest(&self, body: usize, direction: &WideVector) -> (DoubleDouble, u32) {
        let (polyhedron, unit) = (self.pair.polyhedra[body], self.unit);
        let direction = rotate_back(self.pair.poses[body], direction);
        let rounded = narrow(&direction);
        let value = |vertex: &Vertex| rounded.dot(&(vertex.position * unit));
        let most = polyhedron.vertices.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
        // Each value is off by u for the rounded direction and 3u for product and sums, of |g|₁·ρ. The loss to underflow is less
        // than the error of a length.
        let rounding = 8.0 * U * rounded.lp_norm(1) * self.in_units(polyhedron.radius);
        let mut best = (DoubleDouble::from(f64::NEG_INFINITY), 0);
        for (index, vertex) in (0..).zip(&polyhedron.vertices) {
            if value(vertex) >= most - 2.0 * rounding {
                let wide = wide_dot(&direction, &widen(&(vertex.position * unit)));
                if wide.hi > best.0.hi || (wide.hi == best.0.hi && wide.lo > best.0.lo) {
                    best = (wide, index);
                }
            }
        }
        best
    }

    /// Whether the gap along a normal proves the distance to be at least `lower`: it is at least gap/|normal|.
    pub fn prove_lower(&self, gap: &ProvedGap, normal: &Vector, lower: f64) -> bool {
        let wide = widen(normal);
        // √(1 + x) ≤ 1 + x/2 for every x.
        let excess = (wide_dot(&wide, &wide) - 1.0.into()) * 0.5.into();
        let needed = (excess + 1.0.into()) * self.in_units(lower).into();
        (gap.value - needed).hi > self.error
    }

    /// The difference of two vertices, right to the error of a length in each coordinate.
    pub fn difference(&self, pair: VertexPair) -> WideVector {
        let [point1, point2] = [0, 1].map(|i| {
            let vertex = &self.pair.polyhedra[i].vertices[pair[i] as usize];
            rotate(self.pair.poses[i], &widen(&(vertex.position * self.unit)))
        });
        plus_difference(&self.between, &point1, &point2)
    }

    /// Whether the product of a difference with a vector of at most length 2 is provably more than a double.
    pub fn is_more(&self, product: DoubleDouble, than: f64) -> bool {
        (product - than.into()).hi > 4.0 * self.error
    }

    /// Whether a gap along a normal, which is then an overlap, proves the depth to be at most `upper`: it is at most −gap/|normal|.
    pub fn prove_overlap(&self, gap: &ProvedGap, normal: &Vector, upper: f64) -> bool {
        let wide = widen(normal);
        // √(1 + x) ≥ 1 + x/2 − x² for every x from −1/2 on.
        let excess = wide_dot(&wide, &wide) - 1.0.into();
        let least = excess * 0.5.into() + 1.0.into() - excess * excess;
        (gap.value + least * self.in_units(upper).into()).hi > self.error
    }

    /// Whether a gap along a normal is provably one: the bodies are apart.
    pub fn is_open(&self, gap: &ProvedGap) -> bool {
        gap.value.hi > self.error
    }

    /// Whether a point of each body proves the distance to be at most `upper`.
    pub fn prove_upper(&self, points: &[PointInside; 2], upper: f64) -> bool {
        let [point1, point2] =
            [0, 1].map(|i| rotate(self.pair.poses[i], &points[i].position(self.pair.polyhedra[i], self.unit)));
        let upper = self.in_units(upper);
        let difference = plus_difference(&self.between, &point1, &point2);
        let (square, most) = (wide_dot(&difference, &difference), two_product(upper, upper));
        let length: f64 = difference.iter().map(|x| x.hi.abs()).sum();
        // A difference off by e in each coordinate is longer by less than 2e, its square by 4e·|D| + 4e²; squares err by 2⁻¹⁰⁰.
        let rounding = self.error * (5.0 * length + 5.0 * self.error) + power_of_two(-96) * (square.hi + most.hi);
        (most - square).hi > rounding
    }
}

/// Vectors over the largest of their coordinates: no product of four of them is beyond the range of doubles.
fn in_range<const N: usize>(vectors: [Vector; N]) -> [Vector; N] {
    let largest = vectors.iter().map(Vector::amax).fold(0.0, f64::max);
    if largest > 0.0 { vectors.map(|v| v / largest) } else { vectors }
}

/// R·p.
fn rotate(pose: &Pose, p: &WideVector) -> WideVector {
    turned(&pose.rows.map(|[x, y, z, _]| widen(&Vector::new(x, y, z))), p)
}

/// Rᵀ·d.
fn rotate_back(pose: &Pose, d: &WideVector) -> WideVector {
    let r = &pose.rows;
    turned(&[0, 1, 2].map(|k| widen(&Vector::new(r[0][k], r[1][k], r[2][k]))), d)
}

/// Products of rows with a vector.
#[inline]
pub fn turned<D: Ring>(rows: &[[D; 3]; 3], p: &[D; 3]) -> [D; 3] {
    rows.map(|row| wide_dot(&row, p))
}

/// a + (p − q).
#[inline]
pub fn plus_difference<D: Ring>(a: &[D; 3], p: &[D; 3], q: &[D; 3]) -> [D; 3] {
    [0, 1, 2].map(|k| a[k] + (p[k] - q[k]))
}

/// n·a less the products of n with a vertex of each body.
#[inline]
pub fn over_both<D: Ring>(normal: &[D; 3], a: &[D; 3], first: D, second: D) -> D {
    wide_dot(normal, a) - first - second
}

/// A convex combination of up to three vertices: v₀ + w₁(v₁ − v₀) + w₂(v₂ − v₀), the weights from 0, their sum at most 1.
#[derive(Clone, Copy)]
pub struct PointInside {
    /// v₀, v₁, v₂; those without weight repeat v₀.
    pub vertices: [u32; 3],
    weights: [f64; 2],
}

impl PointInside {
    /// A vertex.
    pub fn vertex(vertex: u32) -> PointInside {
        PointInside { vertices: [vertex; 3], weights: [0.0; 2] }
    }

    /// About the point of a segment that is nearest to `point`.
    pub fn on_segment(polyhedron: &Polyhedron, [tail, head]: [u32; 2], point: &Vector) -> PointInside {
        let [from, to] = [tail, head].map(|v| polyhedron.vertices[v as usize].position);
        let [along, aside] = in_range([to - from, point - from]);
        let weight = clamp(aside.dot(&along) / divisor(along.norm_squared()), 0.0, 1.0);
        PointInside { vertices: [tail, head, tail], weights: [weight, 0.0] }
    }

    /// About where `point` is over a triangle, if it is.
    pub fn on_triangle(polyhedron: &Polyhedron, corners: [u32; 3], point: &Vector) -> PointInside {
        let [a, b, c] = corners.map(|v| polyhedron.vertices[v as usize].position);
        let [u, v, r] = in_range([b - a, c - a, point - a]);
        let (uu, uv, vv, ur, vr) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&r), v.dot(&r));
        let determinant = divisor(uu * vv - uv * uv);
        let weight = |numerator: f64| clamp(numerator / determinant, 0.0, 1.0);
        let weights = [weight(vv * ur - uv * vr), weight(uu * vr - uv * ur)];
        let sum = weights[0] + weights[1];
        // So much less than 1 that the exact sum is no more: sum, quotient and products are off by u each. 1 where the sum is less.
        let most = 1.0 - 4.0 * U;
        let scale = most / if sum > most { sum } else { most };
        PointInside { vertices: corners, weights: weights.map(|weight| weight * scale) }
    }

    /// About how far it is in the world from a point of the object's frame that is moved by a vector of the world.
    pub fn distance(&self, polyhedron: &Polyhedron, pose: &Pose, local: &Vector, moved: &Vector) -> f64 {
        // Products in double-double split their factors, which takes 27 bits of the range.
        let unit = power_of_two(if polyhedron.radius > 1.0 { -64 } else { 0 });
        let (inside, said) =
            (self.position(polyhedron, unit), wide_difference(&(local * unit), &(polyhedron.centre * unit)));
        let apart = rotate(pose, &[0, 1, 2].map(|k| inside[k] - said[k]));
        length(&narrow(&[0, 1, 2].map(|k| apart[k] - DoubleDouble::from(moved[k] * unit)))) / unit
    }

    /// In the polyhedron's frame, times a power of two.
    fn position(&self, polyhedron: &Polyhedron, unit: f64) -> WideVector {
        let [a, b, c] = self.vertices.map(|v| polyhedron.vertices[v as usize].position * unit);
        let (u, v) = (wide_difference(&b, &a), wide_difference(&c, &a));
        [0, 1, 2].map(|k| {
            let share = u[k] * self.weights[0].into() + v[k] * self.weights[1].into();
            share + a[k].into()
        })
    }
}
