//! How far the exact hull rises above a vertex along a floating direction: a rigorous upper bound without scanning all
//! vertices and without exact arithmetic.
//!
//! The vertices x with n·x ≥ n·s form a connected part of the triangulated hull's graph, flat vertices included: a vertex
//! that is not a global maximum of n·x has a neighbour with a strictly larger value (a local maximum of a linear function
//! over a convex surface is global), and the vertices where the maximum is attained are connected. So flooding from s over all
//! vertices whose *computed* n·(x − s) is not certainly negative meets every vertex that matters.

use crate::double_double::{wide_difference, wide_dot, widen};
use crate::math::{UNIT_ROUNDOFF, Vector};
use crate::triangulation::Triangulation;

/// Below this Σ|nᵢ||xᵢ − sᵢ| the products might underflow; 2⁻⁹⁰⁰.
const SMALLEST: f64 = f64::from_bits((1023 - 900) << 52);

/// A hull whose extent along directions is asked for, with scratch for it.
#[derive(Debug, Clone)]
pub struct Flood<'a> {
    surface: &'a Triangulation,
    positions: &'a [Vector],
    /// Errors beyond this are worth double-double: uρ/4.
    coarse: f64,
    /// Marks that need no clearing between floods.
    seen_in: Vec<u32>,
    round: u32,
    stack: Vec<u32>,
}

impl<'a> Flood<'a> {
    /// For a hull within `radius` of the local origin.
    pub fn new(surface: &'a Triangulation, positions: &'a [Vector], radius: f64) -> Flood<'a> {
        let coarse = 0.25 * UNIT_ROUNDOFF * radius;
        Flood { surface, positions, coarse, seen_in: vec![0; positions.len()], round: 0, stack: Vec::new() }
    }

    /// An upper bound, rounded up, of max over the hull of n·x minus n·(position of `start`); at least 0.
    pub fn rise(&mut self, normal: &Vector, start: u32) -> f64 {
        self.round += 1;
        self.stack.clear();
        self.stack.push(start);
        self.seen_in[start as usize] = self.round;
        let origin = &self.positions[start as usize];
        let mut highest = 0.0_f64;
        while let Some(v) = self.stack.pop() {
            for &h in self.surface.around(v) {
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
        highest * (1.0 + 4.0 * UNIT_ROUNDOFF)
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

/// n·(x − s) as computed, and a bound of its error.
///
/// Each term has the rounding of the difference, of the product and of two sums: at most (4u + O(u²))·Σ|nᵢ||xᵢ − sᵢ|; 5u covers
/// the rounding of that sum, too. Where all terms vanish, as for boxes along the axes, nothing was rounded.
#[inline]
fn height(normal: &Vector, x: &Vector, s: &Vector) -> (f64, f64) {
    let d = x - s;
    let terms = normal.component_mul(&d);
    let magnitude = terms.x.abs() + terms.y.abs() + terms.z.abs();
    let error = if magnitude > SMALLEST {
        5.0 * UNIT_ROUNDOFF * magnitude
    } else if (0..3).all(|k| normal[k] == 0.0 || d[k] == 0.0) {
        0.0
    } else {
        SMALLEST
    };
    (terms.x + terms.y + terms.z, error)
}

/// The same in double-double: off by 2⁻¹⁰⁰·|n||x − s|, by the rounding to a double, and by what underflows.
fn fine_height(normal: &Vector, x: &Vector, s: &Vector) -> (f64, f64) {
    const RELATIVE: f64 = f64::from_bits((1023 - 96) << 52); // 2⁻⁹⁶, as |·|₁ ≤ √3|·|
    let d = wide_difference(x, s);
    let height = wide_dot(&widen(normal), &d).hi;
    let size = d[0].hi.abs() + d[1].hi.abs() + d[2].hi.abs();
    (height, UNIT_ROUNDOFF * height.abs() + RELATIVE * size + SMALLEST)
}
