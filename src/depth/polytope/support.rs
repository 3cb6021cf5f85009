//! Support vertices of the Minkowski difference, and the upper bound that they prove.

use super::PairRounding;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::fan::PointBlock;
use crate::body::polyhedron::{Polyhedron, clear_slope};
use crate::body::tables;
use crate::distance::certificate;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::voronoi::{Corner, Rule, STRICT, VertexTest, steepest, test_vertex};

/// A support vertex of the Minkowski difference.
#[derive(Debug, Clone, Copy)]
pub struct Support {
    /// The vertices whose difference it is.
    pub pair: VertexPair,
    /// The position, as computed.
    pub position: [f64; 4],
    /// The value there, as computed.
    pub value: f64,
    /// How much farther the bodies may reach than these vertices.
    pub excess: f64,
    /// An upper bound of the support of the exact bodies along the exact direction of unit length.
    pub upper: f64,
}

/// The support of the Minkowski difference along a direction of unit length as computed, climbed to from a pair of vertices or
/// else from the look-up tables' vertices. A pair that comes to `enough` or more may be left where it ties with others: only its
/// value is reported then, the upper bound is infinite.
#[inline(always)]
pub fn support<L: Lanes>(
    frame: &Frame<L>,
    rounding: &PairRounding,
    direction: &Vector,
    start: Option<VertexPair>,
    enough: f64,
) -> Support {
    let [body1, body2] = &frame.bodies;
    let along = L::from_vector(direction);
    let (towards1, towards2) = (body1.rotate_back(along), body2.rotate_back(along).negate());
    let mut top1 = climb(body1.polyhedron, towards1, start.map(|pair| pair[0]));
    let mut top2 = climb(body2.polyhedron, towards2, start.map(|pair| pair[1]));
    let mut position = difference(frame, top1.vertex, top2.vertex);
    let mut value = along.dot(position);
    let is_open = top1.is_open | top2.is_open;
    if is_open && value >= enough {
        let pair = [top1.vertex, top2.vertex];
        return Support { pair, position: position.to_array(), value, excess: f64::INFINITY, upper: f64::INFINITY };
    }
    if is_open {
        if top1.is_open {
            top1 = settle(body1.polyhedron, towards1, top1.vertex);
        }
        if top2.is_open {
            top2 = settle(body2.polyhedron, towards2, top2.vertex);
        }
        position = difference(frame, top1.vertex, top2.vertex);
        value = along.dot(position);
    }
    let excess = (top1.excess + top2.excess) * (1.0 + 64.0 * U);
    // `plane` covers the product and the length of the direction, as of the normal of a triangle; the sum is less than 8M.
    let upper = value + excess + rounding.plane;
    Support { pair: [top1.vertex, top2.vertex], position: position.to_array(), value, excess, upper }
}

/// A pair of vertices that is about the farthest along a direction, as single precision shows, and their difference.
#[inline(always)]
pub fn rough_support<L: Lanes>(frame: &Frame<L>, direction: L, start: Option<VertexPair>) -> (VertexPair, L) {
    let [body1, body2] = &frame.bodies;
    let towards = [body1.rotate_back(direction), body2.rotate_back(direction).negate()];
    let vertex1 = rough_farthest(body1.polyhedron, towards[0], start.map(|pair| pair[0]));
    let vertex2 = rough_farthest(body2.polyhedron, towards[1], start.map(|pair| pair[1]));
    ([vertex1, vertex2], difference(frame, vertex1, vertex2))
}

/// About the farthest vertex.
#[inline(always)]
fn rough_farthest<L: Lanes>(polyhedron: &Polyhedron, towards: L, start: Option<u32>) -> u32 {
    if polyhedron.rough_blocks.is_empty() {
        return climb(polyhedron, towards, start).vertex;
    }
    // Zeros are behind the vertices.
    towards.farthest_of(&polyhedron.rough_blocks).min(polyhedron.vertices.len() - 1) as u32
}

/// A pair of vertices that is the farthest along a direction but for ties: out of line, for where there are closures (R2).
pub fn vertex_beyond<L: Lanes>(
    frame: &Frame<L>,
    rounding: &PairRounding,
    direction: &Vector,
    start: Option<VertexPair>,
) -> Support {
    L::out_of_line(&mut Beyond { frame, rounding, direction, start })
}

struct Beyond<'a, L> {
    frame: &'a Frame<'a, L>,
    rounding: &'a PairRounding,
    direction: &'a Vector,
    start: Option<VertexPair>,
}

impl<L: Lanes> Work for Beyond<'_, L> {
    type Output = Support;

    #[inline(always)]
    fn run(&mut self) -> Support {
        support(self.frame, self.rounding, self.direction, self.start, f64::NEG_INFINITY)
    }
}

/// The difference of two vertices.
#[inline(always)]
pub fn difference<L: Lanes>(frame: &Frame<L>, vertex1: u32, vertex2: u32) -> L {
    let [body1, body2] = &frame.bodies;
    let (vertices1, vertices2) = (&body1.polyhedron.vertices, &body2.polyhedron.vertices);
    frame.difference(&vertices1[vertex1 as usize].position, &vertices2[vertex2 as usize].position)
}

/// A vertex farthest along a direction of unit length or less, and how much farther the body may reach: 0 where it is provably
/// the farthest. The direction may be off by 6.2u.
#[inline(always)]
pub fn farthest<L: Lanes>(polyhedron: &Polyhedron, towards: L, start: Option<u32>) -> (u32, f64) {
    let mut top = climb(polyhedron, towards, start);
    if top.is_open {
        top = settle(polyhedron, towards, top.vertex);
    }
    (top.vertex, top.excess)
}

/// The end of a climb.
#[derive(Clone, Copy)]
struct Top {
    vertex: u32,
    /// How much farther the body may reach …
    excess: f64,
    /// … unless the vertex ties with others, and that is left open.
    is_open: bool,
}

/// Climbs as long as single precision shows a neighbour to be higher: over edges and, unlike marching, straight across faces.
#[inline(always)]
fn climb<L: Lanes>(polyhedron: &Polyhedron, towards: L, start: Option<u32>) -> Top {
    if !polyhedron.vertex_blocks.is_empty() {
        let (vertex, excess) = farthest_in_blocks(polyhedron, towards);
        return Top { vertex, excess, is_open: false };
    }
    let mut vertex = match start {
        Some(vertex) => vertex,
        None => tables::farthest(polyhedron, &towards.to_vector()).unwrap_or(0),
    };
    let clear = clear_slope(LENGTH);
    // Each step provably leads up, so that no vertex comes twice.
    for _ in 0..=polyhedron.vertices.len() {
        let Some(corner) = Corner::of(polyhedron, vertex) else { break };
        let block = &corner.record.neighbours;
        let is_alone = towards.products_are_below([&block.x, &block.y, &block.z], -clear) & (corner.record.more == 0);
        if is_alone {
            return Top { vertex, excess: 0.0, is_open: false };
        }
        let (slope, _, head) = steepest(corner, towards);
        if slope < -clear {
            return Top { vertex, excess: 0.0, is_open: false };
        }
        // False for a NaN.
        if !((slope > clear) & (f64::from(slope) > CLEARLY)) {
            break;
        }
        vertex = head;
    }
    Top { vertex, excess: 0.0, is_open: true }
}

/// Goes on where a climb left it open.
#[inline(always)]
fn settle<L: Lanes>(polyhedron: &Polyhedron, towards: L, vertex: u32) -> Top {
    L::out_of_line(&mut Settle { polyhedron, towards, vertex })
}

struct Settle<'a, L> {
    polyhedron: &'a Polyhedron,
    towards: L,
    vertex: u32,
}

impl<L: Lanes> Work for Settle<'_, L> {
    type Output = Top;

    #[inline(always)]
    fn run(&mut self) -> Top {
        let &mut Settle { polyhedron, towards, mut vertex } = self;
        let direction = towards.to_vector();
        for _ in 0..=polyhedron.vertices.len() {
            let Some(corner) = Corner::of(polyhedron, vertex) else { break };
            let higher = match test_vertex(Rule::Most, corner, towards, LENGTH, CLEARLY) {
                VertexTest::Strict => return Top { vertex, excess: 0.0, is_open: false },
                VertexTest::Leaves { head, .. } => head,
                VertexTest::Tied { .. } => match plateau(polyhedron, &direction, vertex) {
                    Plateau::Highest(vertex, excess) => return Top { vertex, excess, is_open: false },
                    Plateau::Up(higher) => higher,
                    Plateau::Large => break,
                },
            };
            let top = climb(polyhedron, towards, Some(higher));
            if !top.is_open {
                return top;
            }
            vertex = top.vertex;
        }
        let (vertex, excess) = farthest_of_many(polyhedron, &direction, vertex);
        Top { vertex, excess, is_open: false }
    }
}

/// For a vertex that ties with very many, how much farther the body may reach, if the planes around it tell; or the farthest of
/// all vertices. The planes of a merged face tell. The planes of a face that noise has left in triangles do not: its vertices may
/// tie while it is at the other side of the body.
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

/// The surroundings of a vertex that ties with neighbours of it.
enum Plateau {
    /// The highest of those that it ties with, and how much higher the body may be.
    Highest(u32, f64),
    /// A vertex that is provably higher.
    Up(u32),
    /// Too many.
    Large,
}

/// All vertices that one ties with, and that these tie with or see above them, and so on. From a vertex that is not farthest an
/// edge leads up, even if by less than rounding shows: so if none of them is clearly higher, a farthest vertex is among them.
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
pub const HEIGHTS: f64 = 20.0 * U;

/// Products of four points with a direction.
#[inline(always)]
pub fn heights<L: Lanes>([x, y, z]: [L; 3], block: &PointBlock) -> L {
    x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))))
}

/// By how much the order of two heights in single precision, over the radius, may be wrong. With coordinates and a direction of
/// length ≤ 1.02 rounded to it, and three roundings of a product, a height errs by 5.1·2⁻²⁴; both by 10.4·2⁻²⁴, and their
/// difference by 2⁻²⁴ of itself. What underflows is less than 2⁻¹⁴⁹, of a radius of at least 2⁻¹⁰⁰.
const ROUGH_HEIGHTS: f64 = 12.0 / 16_777_216.0;

/// The farthest of all vertices of a body that has them in blocks: as single precision shows, else as double precision does.
#[inline(always)]
fn farthest_in_blocks<L: Lanes>(polyhedron: &Polyhedron, towards: L) -> (u32, f64) {
    debug_assert!(!(towards.to_vector().norm() > 1.03), "{:?}", towards.to_array());
    let (vertex, [greatest, second]) = towards.farthest_product(&polyhedron.rough_blocks);
    // False for a NaN; and there are zeros behind the vertices.
    if f64::from(greatest - second) > ROUGH_HEIGHTS * polyhedron.radius && vertex < polyhedron.vertices.len() {
        return (vertex as u32, 0.0);
    }
    L::out_of_line(&mut InDoubles { polyhedron, towards })
}

struct InDoubles<'a, L> {
    polyhedron: &'a Polyhedron,
    towards: L,
}

impl<L: Lanes> Work for InDoubles<'_, L> {
    type Output = (u32, f64);

    #[inline(always)]
    fn run(&mut self) -> (u32, f64) {
        farthest_in_doubles(self.polyhedron, self.towards)
    }
}

/// The same in double precision.
#[inline(always)]
fn farthest_in_doubles<L: Lanes>(polyhedron: &Polyhedron, towards: L) -> (u32, f64) {
    let [x, y, z] = [towards.splat_x(), towards.splat_y(), towards.splat_z()];
    // Lane by lane the greatest height, the block that it is in, and the second.
    let lowest = L::splat(f64::NEG_INFINITY);
    let (mut best, mut second, mut place) = (lowest, lowest, L::splat(0.0));
    let (mut at, one) = (L::splat(0.0), L::splat(1.0));
    for block in &polyhedron.vertex_blocks {
        let height = heights([x, y, z], block);
        place = at.where_greater(height, best, place);
        second = second.max(best.min(height));
        best = best.max(height);
        at = at.add(one);
    }
    let (negated, lane) = best.negate().least();
    let count = polyhedron.vertices.len();
    // For a NaN any vertex is found, possibly one that is not there.
    let vertex = (4 * place.to_array()[lane & 3] as usize + lane).min(count - 1);
    let rounding = HEIGHTS * polyhedron.radius;
    let tie = L::splat(-negated - rounding);
    if tie.at_most(second) == 0 && tie.at_most(best).count_ones() == 1 {
        return (vertex as u32, 0.0);
    }
    // The vertex that the last block repeats ties with itself.
    if vertex + 4 > count {
        return farthest_of_all(polyhedron, &towards.to_vector());
    }
    (vertex as u32, rounding)
}

/// The farthest of all vertices.
#[cold]
#[inline(never)]
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
    use crate::body::build::assembly::build;
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

    /// A climb from any vertex reaches a farthest vertex, and reports it but for rounding: on faces that noise leaves in
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
