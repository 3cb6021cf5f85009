//! Support vertices of the Minkowski difference, and the upper bound that they prove.

use super::Rounding;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;
use crate::polyhedron::{NONE, Polyhedron, clear_slope};
use crate::solve::certificate;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;
use crate::solve::voronoi::{Corner, Rule, STRICT, VertexTest, test_vertex};
use crate::tables;

/// A support vertex of the Minkowski difference.
#[derive(Debug, Clone, Copy)]
pub struct Support {
    /// The vertices whose difference it is.
    pub pair: VertexPair,
    /// Where it is, as computed.
    pub position: [f64; 4],
    /// The value there, as computed.
    pub value: f64,
    /// How much farther the bodies may reach than these vertices.
    pub excess: f64,
    /// An upper bound of the support of the exact bodies along the exact direction of unit length.
    pub upper: f64,
}

/// Vertices that a body of so few are all looked at.
const FEW: usize = 24;

/// The support of the Minkowski difference along a direction of unit length as computed, climbed to from a pair of vertices or else
/// from where the look-up tables say.
#[inline(always)]
pub fn support<L: Lanes>(
    frame: &Frame<L>,
    rounding: &Rounding,
    direction: &Vector,
    start: Option<VertexPair>,
) -> Support {
    let [body1, body2] = &frame.bodies;
    let along = L::from_vector(direction);
    let (vertex1, excess1) = farthest(body1.polyhedron, body1.rotate_back(along), start.map(|pair| pair[0]));
    let (vertex2, excess2) = farthest(body2.polyhedron, body2.rotate_back(along).negate(), start.map(|pair| pair[1]));
    let position = frame.difference(
        &body1.polyhedron.vertices[vertex1 as usize].position,
        &body2.polyhedron.vertices[vertex2 as usize].position,
    );
    let value = along.dot(position);
    let excess = (excess1 + excess2) * (1.0 + 64.0 * U);
    // `plane` covers the product and the length of the direction, as of the normal of a triangle; the sum is less than 8M.
    let upper = value + excess + rounding.plane;
    Support { pair: [vertex1, vertex2], position: position.to_array(), value, excess, upper }
}

/// How far a body reaches along a direction of about unit length, right to the rounding of a height: as far as the farthest of some
/// vertices, those of one body of pairs, where none else can be farther; else as far as all vertices or a climb tell.
#[inline(always)]
pub fn reach<L: Lanes>(polyhedron: &Polyhedron, towards: L, among: &[VertexPair], body: usize) -> f64 {
    if let Some(fan) = &polyhedron.fan
        && fan.corners.len() == polyhedron.vertices.len()
    {
        let [x, y, z] = [towards.splat_x(), towards.splat_y(), towards.splat_z()];
        let mut farthest = L::splat(f64::NEG_INFINITY);
        for block in &fan.points {
            let part = x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))));
            farthest = farthest.max(part);
        }
        return -farthest.negate().least().0;
    }
    let vertices = &polyhedron.vertices;
    if hold_farthest(polyhedron, towards, among, body) {
        let mut farthest = f64::NEG_INFINITY;
        for pair in among {
            let height = towards.dot(L::from_vector(&vertices[pair[body] as usize].position));
            farthest = if height > farthest { height } else { farthest };
        }
        return farthest;
    }
    let (vertex, excess) = farthest(polyhedron, towards, among.first().map(|pair| pair[body]));
    towards.dot(L::from_vector(&vertices[vertex as usize].position)) + excess * (1.0 + 64.0 * U)
}

/// Whether a farthest vertex is among some: if all neighbours of theirs that are not are clearly lower. For from the farthest of
/// them, were it not the body's, an edge would lead strictly up.
#[inline(always)]
fn hold_farthest<L: Lanes>(polyhedron: &Polyhedron, towards: L, among: &[VertexPair], body: usize) -> bool {
    let clear = clear_slope(LENGTH);
    let mut last = NONE;
    for pair in among {
        let vertex = pair[body];
        let record = &polyhedron.vertices[vertex as usize];
        let block = &record.neighbours;
        let is_alone = (record.more == 0) & towards.products_are_below([&block.x, &block.y, &block.z], -clear);
        if !(is_alone || vertex == last || ties_with_these(polyhedron, &towards.to_vector(), vertex, among, body)) {
            return false;
        }
        last = vertex;
    }
    true
}

/// Whether all neighbours of a vertex that are not among some are clearly lower.
fn ties_with_these(polyhedron: &Polyhedron, towards: &Vector, vertex: u32, among: &[VertexPair], body: usize) -> bool {
    let (rough, clear) = (towards.map(|d| d as f32).into(), clear_slope(LENGTH));
    polyhedron.neighbour_blocks(vertex).all(|block| {
        let slopes = block.slopes(rough).into_iter().zip(&block.head);
        // A NaN is not clearly lower.
        slopes.filter(|(slope, _)| !(*slope < -clear)).all(|(_, head)| among.iter().any(|pair| pair[body] == *head))
    })
}

/// A vertex farthest along a direction of unit length or less, and how much farther the body may reach: 0 where it is the farthest
/// for sure. The direction may be off by 6.2u.
#[inline(always)]
pub fn farthest<L: Lanes>(polyhedron: &Polyhedron, towards: L, start: Option<u32>) -> (u32, f64) {
    if polyhedron.vertices.len() <= FEW {
        return farthest_of_all(polyhedron, &towards.to_vector());
    }
    let mut vertex = start.unwrap_or_else(|| tables::farthest(polyhedron, &towards.to_vector()).unwrap_or(0));
    // Each step leads up for sure, so that no vertex comes twice.
    for _ in 0..=polyhedron.vertices.len() {
        let Some(corner) = Corner::of(polyhedron, vertex) else { break };
        vertex = match test_vertex(Rule::Most, corner, towards, LENGTH, CLEARLY) {
            VertexTest::Strict => return (vertex, 0.0),
            VertexTest::Leaves { head, .. } => head,
            VertexTest::Tied => match plateau(polyhedron, &towards.to_vector(), vertex) {
                Plateau::Highest(vertex, excess) => return (vertex, excess),
                Plateau::Up(head) => head,
                Plateau::Large => break,
            },
        }
    }
    farthest_of_many(polyhedron, &towards.to_vector(), vertex)
}

/// Of a vertex that ties with very many how much farther the body may reach, if the planes around it tell; or the farthest of all
/// vertices. The planes of a merged face tell. Of a face that noise has left in triangles they do not: its vertices may tie while
/// it is at the other side of the body.
#[cold]
#[inline(never)]
fn farthest_of_many(polyhedron: &Polyhedron, towards: &Vector, vertex: u32) -> (u32, f64) {
    let excess = certificate::of_vertex(polyhedron, vertex, towards);
    // False for a NaN.
    if excess <= WIDE * polyhedron.radius { (vertex, excess) } else { farthest_of_all(polyhedron, towards) }
}

/// An upper bound of |RᵀU|.
const LENGTH: f64 = 1.02;

/// A computed slope beyond this has the right sign, see [`STRICT`].
const CLEARLY: f64 = STRICT * LENGTH;

/// Vertices of a plateau that are looked at.
const LARGEST_PLATEAU: usize = 32;

/// An excess over the radius beyond which all vertices are looked at: half of how wide an interval is promised to be over the sum
/// of both radii.
const WIDE: f64 = 90.0 * U;

/// What is around a vertex that ties with neighbours of it.
enum Plateau {
    /// The highest of those that it ties with, and how much higher the body may be.
    Highest(u32, f64),
    /// A vertex that is higher for sure.
    Up(u32),
    /// Too many.
    Large,
}

/// All vertices that one ties with, and that these tie with or see above them, and so on. From a vertex that is not farthest an
/// edge leads up, be it by less than rounding shows: so if none of them is clearly higher, a farthest vertex is among them.
///
/// An edge that leads clearly up from one of them need not end higher than the first is: long edges on the way there may have led
/// down, each by less than rounding shows. Heights decide, or the climb would go round in circles.
#[cold]
#[inline(never)]
fn plateau(polyhedron: &Polyhedron, towards: &Vector, vertex: u32) -> Plateau {
    let height = |v: u32| towards.dot(&polyhedron.vertices[v as usize].position);
    let clearly_higher = height(vertex) + HEIGHTS * polyhedron.radius;
    let (mut tied, mut count, mut done) = ([vertex; LARGEST_PLATEAU], 1, 0);
    let (rough, clear) = (towards.map(|d| d as f32).into(), clear_slope(LENGTH));
    while done < count {
        let from = tied[done];
        done += 1;
        for block in polyhedron.neighbour_blocks(from) {
            for (slope, &head) in block.slopes(rough).into_iter().zip(&block.head) {
                if slope < -clear || tied[..count].contains(&head) {
                    continue;
                }
                if height(head) > clearly_higher {
                    return Plateau::Up(head);
                }
                if polyhedron.direction_to(from, head).dot(towards) >= -CLEARLY {
                    if count == LARGEST_PLATEAU {
                        return Plateau::Large;
                    }
                    tied[count] = head;
                    count += 1;
                }
            }
        }
    }
    let highest = tied[..count].iter().fold(vertex, |a, b| if height(*b) > height(a) { *b } else { a });
    Plateau::Highest(highest, HEIGHTS * polyhedron.radius)
}

/// By how much the order of two heights, over the radius, may be wrong: each errs by 3u·|g|, and g by 6.2u.
const HEIGHTS: f64 = 20.0 * U;

/// The farthest of all vertices.
#[inline(always)]
fn farthest_of_all(polyhedron: &Polyhedron, towards: &Vector) -> (u32, f64) {
    let (mut best, mut highest, mut second) = (0, f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (index, vertex) in (0..).zip(&polyhedron.vertices) {
        let height = towards.dot(&vertex.position);
        if height > highest {
            (best, second, highest) = (index, highest, height);
        } else if height > second {
            second = height;
        }
    }
    let rounding = HEIGHTS * polyhedron.radius;
    (best, if highest - second > rounding { 0.0 } else { rounding })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::simd::Portable;
    use crate::build::assembly::build;
    use crate::random::Random;

    /// Points on the surface of a box, so many along each edge, with noise.
    fn lattice(along: usize, noise: f64, random: &mut Random) -> Vec<Vector> {
        let turn = random.rotation();
        let last = along - 1;
        let all = (0..along.pow(3)).map(|n| [n % along, n / along % along, n / along / along]);
        let is_outside = |place: &[usize; 3]| place.iter().any(|i| *i == 0 || *i == last);
        let at = |place: [usize; 3]| turn * Vector::from(place.map(|i| i as f64 / last as f64 - 0.5));
        all.filter(is_outside).map(|place| at(place) + random.vector() * noise).collect()
    }

    /// Wherever a climb begins it comes to a farthest vertex, and says so but for rounding: on faces that noise leaves in
    /// triangles, too, which it leaves on the other side. Before, a climb went round in circles there, or met more vertices that
    /// tie than it looks at, and the body could reach farther by 2 radii for all that it said.
    #[test]
    fn a_climb_from_anywhere_ends_at_a_farthest_vertex() {
        let mut random = Random::new(101);
        for (along, noise) in [(5, 1e-15), (5, 3e-15), (8, 1e-15), (14, 3e-16), (14, 1e-15), (14, 2e-15), (5, 1e-12)] {
            for _ in 0..4 {
                let body = build(&lattice(along, noise, &mut random), None).unwrap();
                // Across a face, and anyhow.
                let across = body.triangles.iter().map(|[a, b, c]| {
                    let [a, b, c] = [a, b, c].map(|v| body.vertices[*v as usize].position);
                    (b - a).cross(&(c - a)).normalize()
                });
                let directions: Vec<Vector> = across.step_by(17).chain([(); 4].map(|()| random.direction())).collect();
                for towards in directions.iter().flat_map(|towards| [*towards, -towards]) {
                    let height = |v: u32| body.vertices[v as usize].position.dot(&towards);
                    let vertices = 0..body.vertices.len() as u32;
                    let highest = vertices.clone().map(height).fold(f64::NEG_INFINITY, f64::max);
                    for start in vertices {
                        let (found, excess) = farthest(&body, Portable::from_vector(&towards), Some(start));
                        let missed = highest - height(found);
                        let told = || format!("{along} {noise:e} from {start}: {missed:e} {excess:e}");
                        assert!(excess <= WIDE * body.radius && missed <= excess + HEIGHTS * body.radius, "{}", told());
                    }
                }
            }
        }
    }
}
