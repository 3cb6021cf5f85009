//! How far the exact hull rises above a vertex along a floating direction: a rigorous upper bound without scanning all
//! vertices and without exact arithmetic.
//!
//! The vertices x with n·x ≥ n·s form a connected part of the triangulated hull's graph, flat vertices included: a vertex that is
//! not a global maximum of n·x has a neighbour with a strictly larger value (a local maximum of a linear function over a convex
//! surface is global), and the vertices where the maximum is attained are connected. So a search from s over all vertices whose
//! *computed* n·(x − s) is not provably negative meets every vertex that matters.
//!
//! A search that meets the apex of a cone looks at all its neighbours, and for all faces of the cone together that would be the
//! square of their number. So the effort is limited, and the rest is bounded by the planes of two triangles at an edge, which
//! takes no search: with their exact outward normals mᵢ and a vertex a of both, mᵢ·(x − a) ≤ 0 on the whole hull, hence n·(x − a)
//! ≤ |n − c₁m₁ − c₂m₂|·|x − a| for all cᵢ ≥ 0.

use crate::base::double_double::{wide_difference, wide_dot, widen};
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{filled, with_capacity};
use crate::base::scalar::Scalar;
use crate::body::polyhedron::triangulation::Triangulation;

/// How far, as an angle, a computed unit normal of a triangle ([`crate::base::normal::normal_of`]) may miss the exact one: what
/// normalising it has in common for all components only scales it; each component has its own rounding of the wide product and
/// of the quotient, 2u, and less than 0.1u of the product's error.
const NORMAL_ERROR: f64 = 2.5 * UNIT_ROUNDOFF;

/// Below this Σ|nᵢ||xᵢ − sᵢ| the products might underflow; 2⁻⁹⁰⁰.
const SMALLEST: f64 = f64::from_bits((1023 - 900) << 52);

/// A hull whose extent along directions is queried, with scratch for it.
#[derive(Debug, Clone)]
pub struct RiseBounds<'a> {
    surface: &'a Triangulation,
    positions: &'a [Vector],
    radius: f64,
    /// Errors beyond this are worth double-double: uρ/4.
    coarse: f64,
    /// Marks that need no clearing between searches.
    seen_in: Vec<u32>,
    round: u32,
    /// A search puts each vertex there at most once: there is room for all.
    stack: Vec<u32>,
}

impl<'a> RiseBounds<'a> {
    /// For a hull within `radius` of the local origin.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(surface: &'a Triangulation, positions: &'a [Vector], radius: f64) -> Result<RiseBounds<'a>> {
        let coarse = 0.25 * UNIT_ROUNDOFF * radius;
        let (seen_in, stack) = (filled(0, positions.len())?, with_capacity(positions.len())?);
        Ok(RiseBounds { surface, positions, radius, coarse, seen_in, round: 0, stack })
    }

    /// An upper bound, rounded up, of max over the hull of n·x minus n·(position of `start`); at least 0. `None` if that takes a
    /// look at more than `effort` neighbours of vertices.
    pub fn rise(&mut self, normal: &Vector, start: u32, mut effort: usize) -> Option<f64> {
        debug_assert!((start as usize) < self.positions.len());
        self.round += 1;
        self.stack.clear();
        self.stack.push(start);
        self.seen_in[start as usize] = self.round;
        let origin = &self.positions[start as usize];
        let mut highest = 0.0_f64;
        while let Some(v) = self.stack.pop() {
            let around = self.surface.around(v);
            effort = effort.checked_sub(around.len())?;
            for &h in around {
                let w = self.surface.head(h);
                if self.seen_in[w as usize] == self.round {
                    continue;
                }
                self.seen_in[w as usize] = self.round;
                let (mut height, mut error) = height(normal, &self.positions[w as usize], origin);
                if height >= -error && error > self.coarse {
                    (height, error) = fine_height(normal, &self.positions[w as usize], origin);
                }
                if height >= -error {
                    highest = highest.max(height + error);
                    self.stack.push(w);
                }
            }
        }
        // For the rounding of the sum; the factor is larger than 1 + u after rounding.
        Some(highest * (1.0 + 4.0 * UNIT_ROUNDOFF))
    }

    /// The same from the planes of the two triangles at a half-edge, whose computed unit normals are `beside`: a good bound if n
    /// lies between them.
    pub fn rise_beside(&self, normal: &Vector, start: u32, half_edge: u32, beside: [&Vector; 2]) -> f64 {
        let [from_first, between] = [normal - beside[0], beside[1] - beside[0]];
        let square = between.norm_squared();
        // c₁ = 1 − t, c₂ = t. Where the normals are equal, or the result is a NaN, either will do.
        let t = if square > 0.0 { (from_first.dot(&between) / square).clamp(0.0, 1.0) } else { 0.0 };
        let t = if t.is_nan() { 0.0 } else { t };
        let rest = from_first - between * t;
        // Both differences, the product and the last difference round: at most 2u of the first and 4u of the second part.
        let rounding = UNIT_ROUNDOFF * (2.0 * from_first.abs().sum() + 4.0 * t * between.abs().sum());
        let angle = rest.norm() * (1.0 + 8.0 * UNIT_ROUNDOFF) + rounding + NORMAL_ERROR;
        let (height, error) = fine_height(
            normal,
            &self.positions[self.surface.tail(half_edge) as usize],
            &self.positions[start as usize],
        );
        (2.0 * self.radius * angle + (height + error).max(0.0)) * (1.0 + 8.0 * UNIT_ROUNDOFF)
    }

    /// An upper bound, rounded up, of n·(position of `start`) minus min over `vertices` of n·x; at least 0.
    pub fn fall(&self, normal: &Vector, start: u32, vertices: impl IntoIterator<Item = u32>) -> f64 {
        let origin = &self.positions[start as usize];
        let mut lowest = 0.0_f64;
        for w in vertices {
            let (mut height, mut error) = height(normal, &self.positions[w as usize], origin);
            if error > self.coarse {
                (height, error) = fine_height(normal, &self.positions[w as usize], origin);
            }
            lowest = lowest.max(error - height);
        }
        lowest * (1.0 + 4.0 * UNIT_ROUNDOFF)
    }
}

/// An upper bound, rounded up, of max over `points` of n·x minus n·s: in doubles, so up to 5u of their extent too large.
pub fn rise_over(normal: &Vector, points: &[Vector], s: &Vector) -> f64 {
    let rises = points.iter().map(|x| {
        let (height, error) = height(normal, x, s);
        height + error
    });
    // For the rounding of the sum.
    rises.fold(0.0, f64::max) * (1.0 + 4.0 * UNIT_ROUNDOFF)
}

/// n·(x − s) as computed, and a bound of its error.
///
/// Each term has the rounding of the difference, of the product and of two sums: at most (4u + O(u²))·Σ|nᵢ||xᵢ − sᵢ|; 5u covers
/// the rounding of that sum, too. Where all terms vanish, as for boxes along the axes, nothing was rounded.
#[inline]
fn height(normal: &Vector, x: &Vector, s: &Vector) -> (f64, f64) {
    let (height, magnitude) = height_and_magnitude((*normal).into(), (*x).into(), (*s).into());
    let error = if magnitude > SMALLEST {
        HEIGHT * magnitude
    } else if (0..3).all(|k| normal[k] == 0.0 || x[k] - s[k] == 0.0) {
        0.0
    } else {
        SMALLEST
    };
    (height, error)
}

/// See [`height`].
pub const HEIGHT: f64 = 5.0 * UNIT_ROUNDOFF;

/// n·(x − s), and the sum of its terms' magnitudes.
#[inline(always)]
pub fn height_and_magnitude<S: Scalar>(normal: [S; 3], x: [S; 3], s: [S; 3]) -> (S, S) {
    let [a, b, c] = [normal[0] * (x[0] - s[0]), normal[1] * (x[1] - s[1]), normal[2] * (x[2] - s[2])];
    (a + b + c, a.abs() + b.abs() + c.abs())
}

/// The same in double-double: off by 2⁻¹⁰⁰·|n||x − s|, by the rounding to a double, and by what underflows.
fn fine_height(normal: &Vector, x: &Vector, s: &Vector) -> (f64, f64) {
    const RELATIVE: f64 = f64::from_bits((1023 - 96) << 52); // 2⁻⁹⁶, as |·|₁ ≤ √3|·|
    let d = wide_difference(x, s);
    let height = wide_dot(&widen(normal), &d).hi;
    let size = d[0].hi.abs() + d[1].hi.abs() + d[2].hi.abs();
    (height, UNIT_ROUNDOFF * height.abs() + RELATIVE * size + SMALLEST)
}
