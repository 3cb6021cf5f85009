//! Support vertices of the difference body, and the upper bound that they prove.

use super::Rounding;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;
use crate::polyhedron::Polyhedron;
use crate::polyhedron::lookup::Table;
use crate::solve::certificate;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;
use crate::solve::voronoi::{Corner, Rule, VertexTest, test_vertex};
use crate::tables;

/// A support vertex of the difference body.
#[derive(Debug, Clone, Copy)]
pub struct Support {
    /// The vertices whose difference it is.
    pub pair: VertexPair,
    /// Where it is, as computed.
    pub position: [f64; 4],
    /// How far it reaches along the direction, as computed.
    pub reach: f64,
    /// How much farther the bodies may reach than these vertices.
    pub beyond: f64,
    /// An upper bound of the support of the exact bodies along the exact direction of unit length.
    pub upper: f64,
}

/// Vertices that a body of so few are all looked at.
const FEW: usize = 24;

/// The support of the difference body along a direction of unit length as computed, climbed to from a pair of vertices or else from
/// where the look-up tables say.
#[inline(always)]
pub fn support<L: Lanes>(
    frame: &Frame<L>,
    rounding: &Rounding,
    direction: &Vector,
    start: Option<VertexPair>,
) -> Support {
    let [body1, body2] = &frame.bodies;
    let along = L::from_vector(direction);
    let (vertex1, beyond1) = farthest(body1.polyhedron, body1.rotate_back(along), start.map(|pair| pair[0]));
    let (vertex2, beyond2) = farthest(body2.polyhedron, body2.rotate_back(along).negate(), start.map(|pair| pair[1]));
    let position = frame.difference(
        &body1.polyhedron.vertices[vertex1 as usize].position,
        &body2.polyhedron.vertices[vertex2 as usize].position,
    );
    let reach = along.dot(position);
    let beyond = (beyond1 + beyond2) * (1.0 + 64.0 * U);
    // `plane` covers the product and the length of the direction, as of the normal of a triangle; the sum is less than 8M.
    let upper = reach + beyond + rounding.plane;
    Support { pair: [vertex1, vertex2], position: position.to_array(), reach, beyond, upper }
}

/// A vertex farthest along a direction of about unit length, and how much farther the body may reach.
#[inline(always)]
fn farthest<L: Lanes>(polyhedron: &Polyhedron, towards: L, start: Option<u32>) -> (u32, f64) {
    if polyhedron.vertices.len() <= FEW {
        return farthest_of_few(polyhedron, towards);
    }
    let start = start.unwrap_or_else(|| look_up(polyhedron, &towards.to_vector()));
    // |RᵀU| ≤ 1.02|U|.
    let length = 1.02;
    let mut vertex = start;
    // Each step leads up for sure, so that no vertex comes twice.
    for _ in 0..=polyhedron.vertices.len() {
        let Some(corner) = Corner::of(polyhedron, vertex) else { break };
        match test_vertex(Rule::Most, corner, towards, length, CLEARLY_UP) {
            VertexTest::Strict => return (vertex, 0.0),
            VertexTest::Leaves { head, .. } => vertex = head,
            VertexTest::Tied if vertex == start && polyhedron.face_around(vertex).is_some() => {
                // Inside a face, all neighbours tie along its normal either way: it may be the lowest of all.
                let &[lowest_or_highest, _] = &polyhedron.edges[0].across[..2] else { break };
                return climb_closely(polyhedron, &towards.to_vector(), lowest_or_highest);
            }
            VertexTest::Tied => break,
        }
    }
    (vertex, certificate::of_vertex(polyhedron, vertex, &towards.to_vector()))
}

/// A computed slope, of a unit vector right to 4u a component, along a direction of length 1.02, is off by less: 4u and 3u of the
/// product, each times |g|₁ < 1.8.
const CLEARLY_UP: f64 = 16.0 * U;

/// The same in double precision alone.
#[cold]
fn climb_closely(polyhedron: &Polyhedron, towards: &Vector, start: u32) -> (u32, f64) {
    let (vertex, _) = polyhedron.support(towards, start);
    (vertex, certificate::of_vertex(polyhedron, vertex, towards))
}

/// Of few vertices, all are looked at.
#[inline(always)]
fn farthest_of_few<L: Lanes>(polyhedron: &Polyhedron, towards: L) -> (u32, f64) {
    let towards = towards.to_vector();
    let (mut best, mut highest, mut second) = (0, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (index, vertex) in (0..).zip(&polyhedron.vertices) {
        let height = towards.dot(&vertex.position);
        if height > highest {
            (best, second, highest) = (index, highest, height);
        } else if height > second {
            second = height;
        }
    }
    // A height errs by 3u·|g|·ρ, and g by 6.2u: 10u·ρ for |g| ≤ 1.02, and another for the other vertex.
    let rounding = 20.0 * U * polyhedron.radius;
    (best, if highest - second > rounding { 0.0 } else { rounding })
}

/// Where the look-up tables say.
#[inline(always)]
fn look_up(polyhedron: &Polyhedron, towards: &Vector) -> u32 {
    match tables::table(polyhedron) {
        Table::Shells(table) => table.farthest([towards.x as f32, towards.y as f32, towards.z as f32]),
        Table::Spherical(table) => table.towards(towards),
        Table::None => 0,
    }
}
