//! Tests of Voronoi regions: planes around edges and faces, neighbours around vertices, prisms over faces.

use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::simd::Lanes;
use crate::body::polyhedron::{
    MergedFace, NONE, NeighbourBlock, PlaneBlock, Polyhedron, Steepest, Vertex, clear_slope,
};
use crate::placed::side_search::{self, MANY_SIDES};

/// Across which plane to go on where several are violated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    /// The most violated one (Ehmann & Lin 2000, §5.1).
    Most,
    /// The first that is found violated, as in V-Clip (Mirtich 1998), and no short cuts: what the other rule is measured against
    /// (`benches/compare`).
    First,
}

impl Rule {
    /// The lane to go on across, of values of which one at least is less than `least`.
    #[inline(always)]
    pub fn violated<L: Lanes>(self, values: L, least: L) -> usize {
        match self {
            Rule::Most => values.least().1,
            Rule::First => least.greater(values).trailing_zeros() as usize,
        }
    }
}

/// How far a vertex's neighbours lie in a direction.
#[derive(Clone, Copy)]
pub enum VertexTest {
    /// All strictly behind, rounding included.
    Strict,
    /// None ahead by more than the tolerance, some not strictly behind.
    Tied {
        /// The edge to the one farthest ahead, or NONE.
        edge: u32,
    },
    /// One is ahead: the edge to it, or NONE where there is no edge between merged faces, and the neighbour.
    Leaves {
        /// The edge, or NONE; for a [flat vertex](Polyhedron::edge_by_flat_vertex) it may lead elsewhere.
        edge: u32,
        /// The neighbour.
        head: u32,
        /// How far the edge should be followed, for a direction of the length of the way to the other body: where the nearest
        /// point on its line is.
        parameter: f32,
    },
}

/// A vertex with its body.
#[derive(Clone, Copy)]
pub struct Corner<'a> {
    /// The body.
    pub polyhedron: &'a Polyhedron,
    /// Its number there.
    pub index: u32,
    /// The body's record of it.
    pub record: &'a Vertex,
}

impl<'a> Corner<'a> {
    /// The vertex of that number, if the body has one.
    #[inline(always)]
    pub fn of(polyhedron: &'a Polyhedron, index: u32) -> Option<Corner<'a>> {
        polyhedron.vertices.get(index as usize).map(|record| Corner { polyhedron, index, record })
    }
}

/// Relative error of a computed slope g·ê: 6u of g = RᵀU for |U|, 3u of the stored unit direction, 3u of the product, and
/// the second order.
pub const STRICT: f64 = 16.0 * UNIT_ROUNDOFF;

/// Tests all neighbours of a vertex in direction g (towards the other body), whose length is at most `length`, except the few per
/// cent that a skewed R makes of it: the margins have as much to spare several times over.
#[inline(always)]
pub fn test_vertex<L: Lanes>(rule: Rule, corner: Corner, g: L, length: f64, tolerance: f64) -> VertexTest {
    let record = corner.record;
    if g.products_are_below(directions(&record.neighbours), -clear_slope(length)) & (record.more == 0) {
        return VertexTest::Strict;
    }
    test_vertex_further(rule, corner, g, length, tolerance)
}

/// The rest of [`test_vertex`]: some neighbour is not clearly behind, or there are more than eight.
#[inline(always)]
fn test_vertex_further<L: Lanes>(rule: Rule, corner: Corner, g: L, length: f64, tolerance: f64) -> VertexTest {
    let (slope, edge, head) = steepest(corner, g);
    let clear = clear_slope(length);
    if (slope > clear) & (f64::from(slope) > tolerance) {
        if (edge == NONE) | (rule == Rule::First) {
            leave_by_edge(rule, corner, g.to_vector(), length, head)
        } else {
            VertexTest::Leaves { edge, head, parameter: slope }
        }
    } else if (slope < -clear) | (corner.polyhedron.dimension == 0) {
        // A point, which has no neighbours, is all of its body.
        VertexTest::Strict
    } else {
        test_vertex_closely(corner.polyhedron, corner.index, &g.to_vector(), length, tolerance)
    }
}

/// [`test_vertex`] where single precision does not decide.
#[cold]
fn test_vertex_closely(polyhedron: &Polyhedron, vertex: u32, g: &Vector, length: f64, tolerance: f64) -> VertexTest {
    match polyhedron.steepest_closely(vertex, g, length) {
        Some(Steepest { slope, edge, head }) if slope > tolerance => {
            VertexTest::Leaves { edge, head, parameter: slope as f32 }
        }
        Some(Steepest { slope, edge, .. }) if !(slope < -STRICT * length) => VertexTest::Tied { edge },
        _ => VertexTest::Strict,
    }
}

/// The neighbour with the greatest slope g·ê in single precision: the slope, the edge to it or NONE, and the neighbour itself.
#[inline(always)]
pub fn steepest<L: Lanes>(corner: Corner, g: L) -> (f32, u32, u32) {
    let record = corner.record;
    let mut best = steepest_of_block(&record.neighbours, g);
    for index in record.first_more..record.first_more + record.more {
        let other = steepest_of_block(&corner.polyhedron.more_neighbours[index as usize], g);
        if other.0 > best.0 {
            best = other;
        }
    }
    best
}

/// A vertex farthest in direction g, by steepest hill climbing in plain rounding.
#[inline(always)]
pub fn climb<L: Lanes>(polyhedron: &Polyhedron, g: L, start: u32) -> u32 {
    let length = g.norm1();
    if !(length >= f64::MIN_POSITIVE) {
        return start;
    }
    // Scaled to a length that single precision holds.
    let g = g.mul(L::splat(1.0 / length));
    // Rounding could make steps along edges normal to g go round in circles: a vertex seen at a power of two is met again (Brent).
    let (mut vertex, mut mark) = (start, start);
    for step in 1..=polyhedron.vertices.len() {
        let Some(corner) = Corner::of(polyhedron, vertex) else { break };
        let (slope, _, head) = steepest(corner, g);
        // A NaN does not rise.
        if !(slope > 0.0) || head == mark {
            break;
        }
        if step.is_power_of_two() {
            mark = head;
        }
        vertex = head;
    }
    vertex
}

#[inline(always)]
fn steepest_of_block<L: Lanes>(block: &NeighbourBlock, g: L) -> (f32, u32, u32) {
    let (slope, lane) = g.greatest_product(directions(block));
    (slope, block.edge[lane & 7], block.head[lane & 7])
}

/// If the steepest neighbour is across a merged face, or the steepest is not asked for: leave by the steepest real edge that
/// clearly rises or the first. If none does, a flat vertex leaves by an edge of what it lies in: from neighbour to neighbour
/// inside a face, past where it is nearest, it would go round in circles. A corner leaves to the neighbour.
#[cold]
fn leave_by_edge(rule: Rule, corner: Corner, g: Vector, length: f64, head: u32) -> VertexTest {
    let rough = g.map(|d| d as f32).into();
    let edge = corner.polyhedron.edge_by_flat_vertex(corner.index).unwrap_or(NONE);
    let mut best = (clear_slope(length), VertexTest::Leaves { edge, head, parameter: 0.0 });
    for block in corner.polyhedron.neighbour_blocks(corner.index) {
        for (lane, slope) in block.slopes(rough).into_iter().enumerate() {
            if slope > best.0 && block.edge[lane] != NONE {
                best = (slope, VertexTest::Leaves { edge: block.edge[lane], head: block.head[lane], parameter: slope });
                if rule == Rule::First {
                    return best.1;
                }
            }
        }
    }
    best.1
}

#[inline(always)]
fn directions(block: &NeighbourBlock) -> [&[f32; 8]; 3] {
    [&block.x, &block.y, &block.z]
}

/// Values of the four planes at a point.
#[inline(always)]
pub fn plane_values<L: Lanes>(planes: &PlaneBlock, point: L) -> L {
    let part = L::load(&planes.x).mul_add(point.splat_x(), L::load(&planes.offset));
    let part = L::load(&planes.y).mul_add(point.splat_y(), part);
    L::load(&planes.z).mul_add(point.splat_z(), part)
}

/// Products of the four normals with a direction.
#[inline(always)]
pub fn plane_slopes<L: Lanes>(planes: &PlaneBlock, direction: L) -> L {
    let part = L::load(&planes.x).mul(direction.splat_x());
    let part = L::load(&planes.y).mul_add(direction.splat_y(), part);
    L::load(&planes.z).mul_add(direction.splat_z(), part)
}

/// The unit direction of an edge.
#[inline(always)]
pub fn edge_direction(planes: &PlaneBlock) -> Vector {
    Vector::new(planes.x[0], planes.y[0], planes.z[0])
}

/// The side of a face whose plane is violated by more than the tolerance, by the rule, if there is any. `first` are the values
/// of the face's first block.
#[inline(always)]
pub fn violated_side<L: Lanes>(
    rule: Rule,
    polyhedron: &Polyhedron,
    face: &MergedFace,
    [point, first]: [L; 2],
    tolerance: f64,
) -> Option<u32> {
    if face.side_count >= MANY_SIDES {
        return side_search::most_violated_side(polyhedron, face, &point.to_vector(), tolerance);
    }
    // Lane 0 is not a side.
    let first = first.with_first(L::splat(f64::INFINITY));
    let least = L::splat(-tolerance);
    if rule == Rule::First && least.greater(first) != 0 {
        return Some(rule.violated(first, least) as u32 - 1);
    }
    let (mut worst, lane) = first.least();
    let mut side = (lane as u32).saturating_sub(1);
    for (index, block) in polyhedron.further_sides(face).iter().enumerate() {
        let (value, lane) = plane_values(block, point).least();
        if value < worst {
            (worst, side) = (value, 3 + 4 * index as u32 + lane as u32);
        }
    }
    (worst < -tolerance).then_some(side)
}

/// The point where the way from one point to another leaves the prism over a face: the fraction of the way and the side, or (1,
/// None). `skip` is an edge whose side does not count: the way begins on it.
#[inline(always)]
pub fn exit_of_prism<L: Lanes>(
    polyhedron: &Polyhedron,
    face: &MergedFace,
    [from, to]: [L; 2],
    [from_first, to_first]: [L; 2],
    skip: u32,
) -> (f64, Option<u32>) {
    if face.side_count >= MANY_SIDES {
        return side_search::exit_of_prism(polyhedron, face, [&from.to_vector(), &to.to_vector()], skip);
    }
    // Lane 0 is not a side.
    let never = L::splat(f64::INFINITY);
    let mut fractions = exit_fractions(from_first, to_first).with_first(never);
    if skip != NONE {
        let [_, a, b, c] = fractions.to_array();
        let [side1, side2, side3] = face.first_sides;
        fractions = L::load(&[
            f64::INFINITY,
            if side1 == skip { f64::INFINITY } else { a },
            if side2 == skip { f64::INFINITY } else { b },
            if side3 == skip { f64::INFINITY } else { c },
        ]);
    }
    let (mut exit, lane) = fractions.least();
    let mut side = (lane as u32).saturating_sub(1);
    for (index, block) in polyhedron.further_sides(face).iter().enumerate() {
        let fractions = exit_fractions(plane_values(block, from), plane_values(block, to)).to_array();
        for (lane, fraction) in fractions.into_iter().enumerate() {
            let further = (3 + 4 * index + lane) as u32;
            // Unused lanes, which hold the largest double everywhere, are left never.
            if fraction < exit && polyhedron.side(face, further) != skip {
                (exit, side) = (fraction, further);
            }
        }
    }
    if exit < 1.0 { (exit, Some(side)) } else { (1.0, None) }
}

/// The points where values change sign on the way from the first to the second: the fraction of the way, +∞ where they do not
/// fall below 0.
#[inline(always)]
fn exit_fractions<L: Lanes>(start: L, end: L) -> L {
    let (zero, never) = (L::splat(0.0), L::splat(f64::INFINITY));
    let inside = start.max(zero);
    // Values that do not fall below 0 are made to fall by the least double, so that no 0/0 is computed. (Not by a choice of
    // lanes: LLVM divides first and chooses afterwards.)
    let below = end.negate().max(L::splat(f64::from_bits(1)));
    let fraction = inside.div(inside.add(below));
    fraction.where_greater(zero, end, never).where_greater(start, end, never)
}

/// The end of an edge at which a parameter was clamped.
#[inline(always)]
pub fn end_of(parameter: f64, length: f64, tail: u32, head: u32) -> Option<u32> {
    if parameter <= 0.0 {
        Some(tail)
    } else if parameter >= length {
        Some(head)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::power_of_two;
    use crate::base::simd::{self, Kernel, Portable};
    use crate::body::build::assembly::build;

    struct Test<'a> {
        polyhedron: &'a Polyhedron,
        vertex: u32,
        g: Vector,
        length: f64,
    }

    impl Kernel for Test<'_> {
        type Output = VertexTest;
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> VertexTest {
            let corner = Corner::of(self.polyhedron, self.vertex).unwrap();
            test_vertex(Rule::Most, corner, L::from_vector(&self.g), self.length, 0.0)
        }
    }

    /// A pyramid whose tip sees its neighbours at irregular angles.
    fn pyramid() -> Polyhedron {
        let base =
            [[1.0, 0.1], [0.3, 0.9], [-0.8, 0.4], [-0.5, -0.7], [0.4, -1.1]].map(|[x, y]| Vector::new(x, y, 0.0));
        build(&[&base[..], &[Vector::new(0.05, -0.03, 0.7)]].concat(), None).unwrap()
    }

    struct Climb<'a> {
        polyhedron: &'a Polyhedron,
        g: Vector,
        start: u32,
    }

    impl Kernel for Climb<'_> {
        type Output = u32;
        #[inline(always)]
        fn run<L: Lanes>(&mut self) -> u32 {
            climb(self.polyhedron, L::from_vector(&self.g), self.start)
        }
    }

    /// Lengths that single precision cannot hold are as good.
    #[test]
    fn a_climb_ends_at_the_farthest_vertex_whatever_the_length_of_its_direction() {
        let polyhedron = pyramid();
        let towards = [Vector::new(0.2, 0.1, 1.0), Vector::new(-1.0, 0.4, -0.2), Vector::new(0.5, -1.0, 0.1)];
        for (g, start) in towards.into_iter().flat_map(|g| (0..6).map(move |start| (g, start))) {
            let height = |v: u32| polyhedron.vertices[v as usize].position.dot(&g);
            let highest = (0..6).map(height).fold(f64::NEG_INFINITY, f64::max);
            for exponent in [-300, -160, 0, 127, 140, 300] {
                let g = g * power_of_two(exponent);
                let mut climb = Climb { polyhedron: &polyhedron, g, start };
                assert!([simd::dispatch(&mut climb), climb.run::<Portable>()].iter().all(|v| height(*v) == highest));
            }
        }
    }

    /// Single precision overrules nothing: directions perpendicular to an edge up to 1e-3 … 1e-17, of any length that certificates
    /// take for one, which is 2⁻⁴⁰⁰ and more.
    #[test]
    fn a_vertex_is_strictly_farthest_only_if_double_precision_says_so() {
        let polyhedron = pyramid();
        let mut counts = [0; 2];
        let few = if cfg!(miri) { 8 } else { 1 };
        for vertex in 0..polyhedron.vertices.len() as u32 {
            let heads: Vec<u32> = polyhedron.neighbour_blocks(vertex).flat_map(|block| block.head).collect();
            let outward = polyhedron.vertices[vertex as usize].position - Vector::new(0.0, 0.0, 0.2);
            for (k, &head) in heads.iter().enumerate() {
                let edge = polyhedron.direction_to(vertex, head);
                // Miri takes a thousand times as long.
                for tilt in (3..18).step_by(few).map(|e| 10.0_f64.powi(-e)).flat_map(|t| [t, -t]) {
                    let across = outward - edge * edge.dot(&outward);
                    let unit = (across.normalize() + edge * tilt).normalize();
                    for exponent in [-400, -160, -130, -101, -60, 0, 60, 126, 127, 128, 129, 600, 1020]
                        .into_iter()
                        .step_by(few.min(3))
                    {
                        let length = power_of_two(exponent) * (1.0 + 0.9 * (k as f64 / 8.0));
                        let mut test =
                            Test { polyhedron: &polyhedron, vertex, g: unit * length, length: length * 1.01 };
                        let answers = [simd::dispatch(&mut test), test.run::<Portable>()];
                        for answer in answers {
                            let is_strict = matches!(answer, VertexTest::Strict);
                            counts[usize::from(is_strict)] += 1;
                            let slope = |head: u32| polyhedron.direction_to(vertex, head).dot(&unit);
                            assert!(
                                !is_strict || heads.iter().all(|head| slope(*head) < 0.0),
                                "{vertex} {unit:?} {exponent}"
                            );
                        }
                    }
                }
            }
        }
        assert!(counts.iter().all(|count| few * count > 1000), "{counts:?}");
    }
}
