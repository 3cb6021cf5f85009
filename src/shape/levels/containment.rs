//! Whether one convex polyhedron contains another, exactly.

use crate::base::double_double::narrow;
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{copied, filled, with_capacity};
use crate::base::normal::area_vector;
use crate::base::predicates::ExactPoints;
use crate::body::polyhedron::Polyhedron;

/// Whether the exact hull of `outer`'s vertices contains that of `inner`'s, surfaces included; both in the same centred
/// coordinates (their `centre` is the same). `false` if `outer` has no interior.
///
/// Each triangle (a, b, c) of the outer hull is tried, exactly, on every vertex of the inner one that may be farthest along the
/// triangle's normal N. Those with N·x ≥ N·v are a connected part of the inner hull's graph for any vertex v of it (a local
/// maximum of a linear function over a convex surface is global), so from a v found by climbing it is enough to search all
/// neighbours that are not *certainly* lower. If the climb ended too low the search is larger, and that is all.
///
/// Time in proportion to the triangles of `outer` and the vertices of `inner` as long as neighbouring triangles have
/// neighbouring extreme vertices, as those of a level of detail have.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn contains(outer: &Polyhedron, inner: &Polyhedron) -> Result<bool> {
    debug_assert!(outer.centre == inner.centre);
    if outer.dimension < 3 {
        return Ok(false);
    }
    let (first_inner, count) = (outer.vertices.len() as u32, inner.vertices.len());
    let mut points = with_capacity(outer.vertices.len() + count)?;
    points.extend(outer.vertices.iter().chain(&inner.vertices).map(|v| v.position));
    let exact = ExactPoints::new(&points)?;
    let (seen_in, stack) = (filled(0, count)?, with_capacity(count)?);
    let mut search = ContainmentSearch { inner, exact: &exact, first_inner, seen_in, round: 0, stack };

    // The vertices are in an order that keeps neighbours together, the triangles are not.
    let mut order: Vec<[u32; 3]> = copied(&outer.triangles)?;
    order.sort_unstable_by_key(|corners| corners.iter().copied().min());
    let mut extreme = filled(None, outer.vertices.len())?;
    let mut last = 0;
    for corners in order {
        let start = corners.iter().find_map(|&v| extreme[v as usize]).unwrap_or(last);
        match search.extreme_vertex_below(corners, start) {
            Some(vertex) => last = vertex,
            None => return Ok(false),
        }
        for v in corners {
            extreme[v as usize] = Some(last);
        }
    }
    Ok(true)
}

/// Scratch for one containment test.
struct ContainmentSearch<'a> {
    inner: &'a Polyhedron,
    /// The vertices of the outer polyhedron and then those of the inner one.
    exact: &'a ExactPoints,
    first_inner: u32,
    /// Marks that need no clearing between searches.
    seen_in: Vec<u32>,
    round: u32,
    /// A search puts each vertex there at most once: there is room for all.
    stack: Vec<u32>,
}

impl ContainmentSearch<'_> {
    /// If no vertex of the inner polyhedron lies above a triangle: one that is about the farthest along its normal.
    fn extreme_vertex_below(&mut self, corners: [u32; 3], start: u32) -> Option<u32> {
        let [a, b, c] = corners.map(|v| self.exact.approximate(v));
        let normal = narrow(&area_vector(&a, &b, &c));
        // Each component of the normal is right to u of itself and 2⁻¹⁰⁰·|b − a||c − a| (and what underflows is covered below).
        const RELATIVE: f64 = f64::from_bits((1023 - 98) << 52); // 2⁻⁹⁸, as |·|₁ ≤ √3|·|
        let area = RELATIVE * (b - a).norm() * (c - a).norm();
        let plane = self.exact.plane(corners);
        let (top, _) = self.inner.support(&normal, start);
        let origin = self.position(top);

        self.round += 1;
        self.seen_in[top as usize] = self.round;
        self.stack.clear();
        self.stack.push(top);
        while let Some(v) = self.stack.pop() {
            if self.exact.height(&plane, self.first_inner + v) > 0.0 {
                return None;
            }
            for head in self.inner.neighbour_blocks(v).flat_map(|block| block.head) {
                if self.seen_in[head as usize] == self.round {
                    continue;
                }
                self.seen_in[head as usize] = self.round;
                // The difference, the product and two sums are right to u each, the normal to the bound above.
                const GUARD: f64 = f64::from_bits((1023 - 1000) << 52); // for underflow, as in predicates.rs
                let d = self.position(head) - origin;
                let terms = normal.component_mul(&d).map(f64::abs);
                let error = 6.0 * UNIT_ROUNDOFF * (terms.x + terms.y + terms.z) + area * d.norm() + GUARD;
                if normal.dot(&d) >= -error {
                    self.stack.push(head);
                }
            }
        }
        Some(top)
    }

    /// A vertex of the inner polyhedron in the scaled coordinates of the predicates.
    fn position(&self, vertex: u32) -> Vector {
        self.exact.approximate(self.first_inner + vertex)
    }
}
