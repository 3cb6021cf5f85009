//! The smallest polytopes that prove a depth: for pairs at rest, where from step to step the facet of least overlap stays.
//!
//! A *pyramid* has a base in that facet, of three to eight corners, and an apex deep in the Minkowski difference. If the side
//! over an edge of the base would be nearer to the origin than the base is, as at the rim of a plate, the base has a further
//! triangle across that edge, or one in a notch between two such triangles. So around the base and its further triangles runs a
//! *ring* of at most eight corners, and each edge of the ring has a side up to the apex. It proves a depth just as a large
//! polytope does, see the [module](super):
//!
//! 1. *It is closed*, for any indices: the fan of the base has the base's edges as its boundary, a further triangle over an edge
//!    of the ring puts two edges in its place, one in a notch an edge in the place of two, and the sides close the ring. Only the
//!    range of the indices is looked at.
//! 2. *The base is far enough*: with the normal m of three of its corners, which may be any vector, all of it is at least min m·v
//!    from the origin, less the error of a [plane](PairRounding::plane); that is the lower end.
//! 3. *So are the sides and further triangles*: with a triangle's normal N, however rounded, min N·v ≥ |N|·(min m·v) over its
//!    corners. Both are positive, so their squares are compared, and no root is taken. The products err by 3u·|N|M and the
//!    differences by e; squares and |N|² by a few u of themselves, so the height by 3u of itself. The plane's error is 10u·M and e.
//! 4. *It goes around the origin once*: all determinants are provably positive, so that solid angles sum up to more than 0. A
//!    determinant is N·v for a corner v, and errs by less than [`PairRounding::determinant`] times both edges' lengths.
//! 5. *The bodies overlap by no more along m* than both reach along it, see [`reach`]; that is the upper end.
//! 6. *The ends have met*, up to what is provable. Otherwise the pyramid proves nothing.

use super::support::reach;
use super::{PairRounding, is_in_scale};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::memory::listed;
use crate::base::simd::Lanes;
use crate::body::polyhedron::Vertex;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// Corners of the base and its further triangles.
pub const MOST_CORNERS: usize = 8;

/// Further triangles. The base has three corners at least, so that five triangles can bring corners, and as many take one each
/// from a ring of eight, of which three stay.
const MOST_FURTHER: u8 = 10;

/// Triangles of a pyramid: a closed surface of this many corners and an apex has no more.
const MOST_TRIANGLES: usize = 2 * MOST_CORNERS - 2;

/// Which triangles of how many are of the base: a window of four flags begins `fan` flags before the first of the ones.
const IS_NO_BASE: [f64; MOST_CORNERS + MOST_TRIANGLES] = {
    let mut flags = [1.0; MOST_CORNERS + MOST_TRIANGLES];
    let mut at = 0;
    while at < MOST_CORNERS {
        flags[at] = 0.0;
        at += 1;
    }
    flags
};

/// Cross products whose square is less are taken for none: with bodies no longer than 2¹⁰⁰ and no shorter than 2⁻¹⁰⁰ nothing that
/// is compared underflows.
const LEAST_SQUARE: f64 = f64::from_bits((1023 - 600) << 52);

/// A pyramid by its vertex pairs. All zero is none, and any bytes are safe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct Pyramid {
    /// The corners, those of the base first and in order around it, and the apex behind the last.
    pairs: [VertexPair; MOST_CORNERS + 1],
    /// How many corners the base has; less than three where there is no pyramid.
    base: u8,
    further: Further,
    /// For the caller to mark what it keeps beside the pyramid.
    pub mark: u8,
}

/// The further triangles of a base, in order: what each does to the ring.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
struct Further {
    count: u8,
    /// Four bits each, the first lowest: a place of the ring, and whether the corner there is in a notch that the triangle fills;
    /// else a new corner comes behind that place.
    moves: [u8; 5],
}

/// The bits of [`Further::moves`] that mark notches.
const NOTCHES: u64 = 0x88_8888_8888;

/// The effect of one further triangle on the ring.
#[derive(Clone, Copy)]
enum RingMove {
    /// A new corner comes behind this place.
    Corner(usize),
    /// The corner at this place goes.
    Notch(usize),
}

impl Further {
    fn bits(&self) -> u64 {
        let [a, b, c, d, e] = self.moves;
        u64::from_le_bytes([a, b, c, d, e, 0, 0, 0])
    }

    /// How many bring a corner.
    fn corners(&self) -> usize {
        let are_there = (1u64 << (4 * self.count.min(MOST_FURTHER))) - 1;
        usize::from(self.count) - (self.bits() & NOTCHES & are_there).count_ones() as usize
    }

    fn moves(&self) -> impl Iterator<Item = RingMove> {
        let bits = self.bits();
        (0..self.count.min(MOST_FURTHER)).map(move |index| {
            let one = bits >> (4 * index);
            let place = (one & 7) as usize;
            if one & 8 == 0 { RingMove::Corner(place) } else { RingMove::Notch(place) }
        })
    }

    /// Whether there is room.
    fn push(&mut self, one: RingMove) -> bool {
        if self.count >= MOST_FURTHER {
            return false;
        }
        let four = match one {
            RingMove::Corner(place) => place as u8,
            RingMove::Notch(place) => 8 | place as u8,
        };
        self.moves[usize::from(self.count / 2)] |= four << (4 * (self.count % 2));
        self.count += 1;
        true
    }
}

/// Three corners of a pyramid, by their places among the pairs; the fourth is any.
type CornerPlaces = [u8; 4];

/// The triangles of a pyramid.
#[derive(Clone, Copy)]
struct PyramidSurface {
    triangles: [CornerPlaces; MOST_TRIANGLES + 2],
    count: usize,
    /// How many of them, the first, are of the base.
    fan: usize,
}

/// A depth that a pyramid proves.
#[derive(Clone, Copy)]
pub struct Rest<L> {
    /// The depth is at least this, more than 0 …
    pub lower: f64,
    /// … and at most this.
    pub upper: f64,
    /// The overlap of the witness points, about in between.
    pub depth: f64,
    /// The unit vector, from the inside of the Minkowski difference to the boundary, along which the bodies overlap least.
    pub direction: L,
    /// The witness points in centred coordinates: convex combinations of the vertices of `pairs`.
    pub points: [L; 2],
    /// The triangle of the base that holds them.
    pub pairs: [VertexPair; 3],
    /// Which that is.
    pub triangle: u8,
    /// Triangles of the pyramid.
    pub triangles: u32,
}

/// Why a pyramid proves nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProofFailure {
    /// There is none, or it does not enclose the ball that it should.
    Enclosure,
    /// The bodies reach farther than the base.
    Reach,
}

impl Pyramid {
    /// Over a base, with an apex.
    pub fn new(base: &[VertexPair], apex: VertexPair) -> Pyramid {
        let count = base.len().min(MOST_CORNERS);
        let mut pyramid = Pyramid { base: count as u8, ..Pyramid::default() };
        pyramid.pairs[..count].copy_from_slice(&base[..count]);
        pyramid.set_apex(apex);
        pyramid
    }

    /// Adds a triangle from the edge that begins at a place of the ring to a corner; whether there is room.
    pub fn add_across(&mut self, place: usize, corner: VertexPair) -> bool {
        let (corners, apex) = (self.corners(), self.apex());
        if corners >= MOST_CORNERS || !self.further.push(RingMove::Corner(place)) {
            return false;
        }
        self.pairs[corners] = corner;
        self.set_apex(apex);
        true
    }

    /// Adds a triangle of the corner at a place of the ring and both beside it, so that it is in the ring no more; whether there is
    /// room.
    pub fn fill_notch(&mut self, place: usize) -> bool {
        self.further.push(RingMove::Notch(place))
    }

    pub fn set_apex(&mut self, apex: VertexPair) {
        self.pairs[self.corners()] = apex;
    }

    /// Whether there is one.
    #[inline(always)]
    pub fn is_there(&self) -> bool {
        self.base >= 3
    }

    /// Its base and apex, if its base has no further triangles.
    pub fn plain(&self) -> Option<(&[VertexPair], VertexPair)> {
        (self.further.count == 0).then(|| (&self.pairs[..usize::from(self.base)], self.apex()))
    }

    pub fn apex(&self) -> VertexPair {
        self.pairs[self.corners()]
    }

    /// How many corners the base and its further triangles have.
    #[inline(always)]
    fn corners(&self) -> usize {
        let base = usize::from(self.base);
        if self.further.count == 0 { base } else { base + self.further.corners() }
    }

    /// Whether there is one, of vertices that the bodies have.
    #[inline(always)]
    pub fn is_of<L: Lanes>(&self, frame: &Frame<L>) -> bool {
        if !(3..=MOST_CORNERS).contains(&usize::from(self.base)) || self.further.count > MOST_FURTHER {
            return false;
        }
        let corners = self.corners();
        if corners > MOST_CORNERS {
            return false;
        }
        let [polyhedron1, polyhedron2] = frame.polyhedra();
        let (count1, count2) = (polyhedron1.vertices.len(), polyhedron2.vertices.len());
        let mut largest = [0; 2];
        for pair in &self.pairs[..=corners] {
            largest = [largest[0].max(pair[0]), largest[1].max(pair[1])];
        }
        (largest[0] as usize) < count1 && (largest[1] as usize) < count2
    }

    /// The triangles, counter-clockwise from outside; four at a time can be read.
    #[inline(always)]
    fn surface(&self) -> PyramidSurface {
        if self.further.count == 0 { PLAIN[usize::from(self.base)] } else { self.surface_with_further() }
    }

    fn surface_with_further(&self) -> PyramidSurface {
        let (base, apex) = (usize::from(self.base), self.corners() as u8);
        let fan = base - 2;
        let mut surface = PyramidSurface { triangles: [[0; 4]; MOST_TRIANGLES + 2], count: 0, fan };
        for corner in 1..=fan as u8 {
            surface.push([0, corner, corner + 1]);
        }
        let (mut order, mut ring, mut corner) = ([0, 1, 2, 3, 4, 5, 6, 7], base, base as u8);
        for one in self.further.moves() {
            match one {
                RingMove::Corner(place) => {
                    let after = place % ring;
                    surface.push([order[after], corner, order[(after + 1) % ring]]);
                    order.copy_within(after + 1..ring, after + 2);
                    order[after + 1] = corner;
                    (ring, corner) = (ring + 1, corner + 1);
                }
                // A ring of three has none.
                RingMove::Notch(place) if ring > 3 => {
                    let at = place % ring;
                    surface.push([order[(at + ring - 1) % ring], order[(at + 1) % ring], order[at]]);
                    order.copy_within(at + 1..ring, at);
                    ring -= 1;
                }
                RingMove::Notch(_) => {}
            }
        }
        for place in 0..ring {
            let following = if place + 1 == ring { 0 } else { place + 1 };
            surface.push([order[place], apex, order[following]]);
        }
        // Four at a time: the last stands in for missing ones.
        let (last, end) = (surface.triangles[surface.count - 1], (surface.count + 3).min(surface.triangles.len()));
        surface.triangles[surface.count..end].fill(last);
        surface
    }

    /// The vertex pairs of its triangles, if it is one of these bodies.
    ///
    /// # Panics
    /// Fails where there is no memory for them, same as [`in_integers`](crate::base::memory::in_integers).
    pub fn triangles<L: Lanes>(&self, frame: &Frame<L>) -> Vec<[VertexPair; 3]> {
        if !self.is_of(frame) {
            return Vec::new();
        }
        let surface = self.surface();
        let pairs = |[a, b, c, _]: &CornerPlaces| [a, b, c].map(|corner| self.pairs[usize::from(*corner)]);
        listed(surface.triangles[..surface.count].iter().map(pairs))
    }

    /// The first pair of its base.
    pub fn first(&self) -> VertexPair {
        self.pairs[0]
    }

    /// The normal of its base, of unit length; it is one of these bodies.
    pub fn direction<L: Lanes>(&self, frame: &Frame<L>) -> Vector {
        let vertices = frame.polyhedra().map(|polyhedron| &polyhedron.vertices);
        let base = usize::from(self.base);
        let [p, q, r] = [0, base / 3, 2 * base / 3].map(|corner| {
            let [v, w] = self.pairs[corner];
            frame.difference(&vertices[0][v as usize].position, &vertices[1][w as usize].position).to_vector()
        });
        (q - p).cross(&(r - p)).normalize()
    }

    /// With other vertices of one body at the corners of its base, where all of these have the same one.
    #[inline(always)]
    pub fn moved_to(&self, farthest: VertexPair) -> Option<Pyramid> {
        let mut moved = *self;
        let [first, others @ ..] = &self.pairs[..usize::from(self.base)] else { return None };
        for body in 0..2 {
            let is_same = others.iter().all(|pair| pair[body] == first[body]);
            if is_same && first[body] != farthest[body] {
                moved.pairs[..usize::from(self.base)].iter_mut().for_each(|pair| pair[body] = farthest[body]);
                moved.mark = 0;
                return Some(moved);
            }
        }
        None
    }

    /// The depth that it proves.
    #[inline(always)]
    pub fn prove<L: Lanes>(&self, frame: &Frame<L>, rounding: &PairRounding) -> Result<Rest<L>, ProofFailure> {
        // Bodies farther apart do not intersect; out of scale squares of determinants overflow, and ∞ ≤ ∞ proves nothing. Flat ones
        // are for the search.
        let [polyhedron1, polyhedron2] = frame.polyhedra();
        let are_solid = (polyhedron1.dimension == 3) & (polyhedron2.dimension == 3);
        if !(are_solid && is_in_scale(frame.polyhedra()) && self.is_of(frame) && frame.separation <= 2.0 * frame.size) {
            return Err(ProofFailure::Enclosure);
        }
        let [vertices1, vertices2] = [&frame.bodies[0].polyhedron.vertices, &frame.bodies[1].polyhedron.vertices];
        let mut positions = [[0.0; 4]; MOST_CORNERS + 1];
        for (position, &[v, w]) in positions.iter_mut().zip(&self.pairs[..=self.corners()]) {
            *position = frame.difference(&vertices1[v as usize].position, &vertices2[w as usize].position).to_array();
        }
        let base = usize::from(self.base);
        let p = L::load(&positions[0]);
        let (q, r) = (L::load(&positions[base / 3]), L::load(&positions[2 * base / 3]));
        let across = q.sub(p).cross(r.sub(p));
        let direction = across.div(L::splat(across.dot(across).max(LEAST_SQUARE).sqrt()));
        let mut height = f64::INFINITY;
        for position in &positions[..base] {
            let own = direction.dot(L::load(position));
            height = if own < height { own } else { height };
        }
        let lower = height - rounding.plane;
        let further;
        let surface = if self.further.count == 0 {
            &PLAIN[base]
        } else {
            further = self.surface_with_further();
            &further
        };
        if !(lower > 0.0 && surface.is_beyond::<L>(&positions, height, rounding)) {
            return Err(ProofFailure::Enclosure);
        }

        let [body1, body2] = &frame.bodies;
        let bases = &self.pairs[..base];
        let reach1 = reach(body1.polyhedron, body1.rotate_back(direction), bases, 0);
        let reach2 = reach(body2.polyhedron, body2.rotate_back(direction).negate(), bases, 1);
        // The heights err by 9.4u of the radii and the offset's product by 5u of it, the sums by 2u·M, and the direction's length
        // by 5u·M: together less than a plane does, which is 20u of the radii and 14u of the offset.
        let upper = reach1 + reach2 + direction.dot(body1.offset) + rounding.plane;
        if !(upper - lower <= rounding.provable) {
            return Err(ProofFailure::Reach);
        }
        self.witness(frame, &positions, surface, &DepthBounds { lower, upper, height, direction })
            .ok_or(ProofFailure::Enclosure)
    }

    /// The point where the direction from the origin leaves the base, as points of both bodies. `None` where it does not, or
    /// where the base is so thin that its weights are off.
    #[inline(always)]
    fn witness<L: Lanes>(
        &self,
        frame: &Frame<L>,
        positions: &[[f64; 4]; MOST_CORNERS + 1],
        surface: &PyramidSurface,
        bounds: &DepthBounds<L>,
    ) -> Option<Rest<L>> {
        let DepthBounds { lower, upper, height, direction } = *bounds;
        let foot = direction.mul(L::splat(height));
        let (mut weights, mut triangle) = ([1.0, 0.0, 0.0], 0);
        for index in 0..surface.fan {
            let [a, b, c, _] = surface.triangles[index];
            let p = L::load(&positions[usize::from(a)]).sub(foot);
            let q = L::load(&positions[usize::from(b)]).sub(foot);
            let r = L::load(&positions[usize::from(c)]).sub(foot);
            let to_q = direction.cross(q);
            // Twice the areas that the foot spans with two corners each.
            let areas = [to_q.dot(r), direction.cross(r).dot(p), -to_q.dot(p)];
            let (x, y, z) = (positive(areas[0]), positive(areas[1]), positive(areas[2]));
            let share = 1.0 / (x + y + z);
            (weights, triangle) = ([x * share, y * share, z * share], index);
            if (areas[0] >= 0.0) & (areas[1] >= 0.0) & (areas[2] >= 0.0) {
                break;
            }
        }
        let [a, b, c, _] = surface.triangles[triangle];
        let (a, b, c) = (usize::from(a), usize::from(b), usize::from(c));
        let (y, z) = (L::splat(weights[1]), L::splat(weights[2]));
        let first = L::load(&positions[a]);
        let point = L::load(&positions[c]).sub(first).mul_add(z, L::load(&positions[b]).sub(first).mul_add(y, first));
        let off = point.sub(foot);
        let enough = 16.0 * U * (frame.size + frame.separation);
        // False for a NaN, as where the areas are 0.
        if !(off.dot(off) <= enough * enough) {
            return None;
        }
        let pairs = [self.pairs[a], self.pairs[b], self.pairs[c]];
        let points = [
            combination(&frame.bodies[0].polyhedron.vertices, [pairs[0][0], pairs[1][0], pairs[2][0]], [y, z]),
            combination(&frame.bodies[1].polyhedron.vertices, [pairs[0][1], pairs[1][1], pairs[2][1]], [y, z]),
        ];
        let depth = direction.dot(point);
        let (triangle, triangles) = (triangle as u8, surface.count as u32);
        Some(Rest { lower, upper, depth, direction, points, pairs, triangle, triangles })
    }
}

/// The positive part of a number; 0 of a NaN.
#[inline(always)]
fn positive(x: f64) -> f64 {
    if x > 0.0 { x } else { 0.0 }
}

/// The convex combination of three vertices, of the second and the third with these weights: exactly a vertex where all are one.
#[inline(always)]
fn combination<L: Lanes>(vertices: &[Vertex], [first, second, third]: [u32; 3], [y, z]: [L; 2]) -> L {
    let first = L::from_vector(&vertices[first as usize].position);
    let second = L::from_vector(&vertices[second as usize].position).sub(first);
    let third = L::from_vector(&vertices[third as usize].position).sub(first);
    third.mul_add(z, second.mul_add(y, first))
}

/// The bounds on a depth that are proved before its witness points are found.
struct DepthBounds<L> {
    lower: f64,
    upper: f64,
    /// How high the base is over the origin, as computed.
    height: f64,
    direction: L,
}

/// The surfaces of pyramids without further triangles, by the corners of the base.
static PLAIN: [PyramidSurface; MOST_CORNERS + 1] = {
    let none = PyramidSurface { triangles: [[0; 4]; MOST_TRIANGLES + 2], count: 0, fan: 0 };
    let mut surfaces = [none; MOST_CORNERS + 1];
    let mut base = 3;
    while base <= MOST_CORNERS {
        surfaces[base] = PyramidSurface::plain(base);
        base += 1;
    }
    surfaces
};

impl PyramidSurface {
    const fn plain(base: usize) -> PyramidSurface {
        let apex = base as u8;
        let mut surface =
            PyramidSurface { triangles: [[0; 4]; MOST_TRIANGLES + 2], count: 2 * base - 2, fan: base - 2 };
        let mut corner = 0;
        while corner < base {
            let (own, next) = (corner as u8, ((corner + 1) % base) as u8);
            if corner + 2 < base {
                surface.triangles[corner] = [0, own + 1, own + 2, 0];
            }
            surface.triangles[base - 2 + corner] = [own, apex, next, own];
            corner += 1;
        }
        let mut stand_in = surface.count;
        while stand_in < MOST_TRIANGLES + 2 {
            surface.triangles[stand_in] = surface.triangles[surface.count - 1];
            stand_in += 1;
        }
        surface
    }

    fn push(&mut self, [a, b, c]: [u8; 3]) {
        self.triangles[self.count] = [a, b, c, a];
        self.count += 1;
    }

    /// Whether all determinants are provably positive, and all triangles but the base's are at least so far from the origin, up
    /// to a plane's error: 3 and 4 above.
    #[inline(always)]
    fn is_beyond<L: Lanes>(
        &self,
        positions: &[[f64; 4]; MOST_CORNERS + 1],
        height: f64,
        rounding: &PairRounding,
    ) -> bool {
        let (height, determinant) = (L::splat(height), L::splat(rounding.determinant));
        let (height, determinant) = (height.mul(height), determinant.mul(determinant));
        let (zero, least) = (L::splat(0.0), L::splat(LEAST_SQUARE));
        let mut bad = 0;
        let mut first = 0;
        while first < self.count {
            let Some(&[a, b, c, d]) = self.triangles.get(first..first + 4).and_then(|four| four.first_chunk()) else {
                return false;
            };
            let Some(flags) = IS_NO_BASE.get(MOST_CORNERS - self.fan + first..).and_then(|flags| flags.first_chunk())
            else {
                return false;
            };
            let p: [L; 3] = components(positions, [a[0], b[0], c[0], d[0]]);
            let q: [L; 3] = components(positions, [a[1], b[1], c[1], d[1]]);
            let r: [L; 3] = components(positions, [a[2], b[2], c[2], d[2]]);
            let [ex, ey, ez] = [q[0].sub(p[0]), q[1].sub(p[1]), q[2].sub(p[2])];
            let [gx, gy, gz] = [r[0].sub(p[0]), r[1].sub(p[1]), r[2].sub(p[2])];
            let nx = ez.negated_mul_add(gy, ey.mul(gz));
            let ny = ex.negated_mul_add(gz, ez.mul(gx));
            let nz = ey.negated_mul_add(gx, ex.mul(gy));
            let over_p = nx.mul_add(p[0], ny.mul_add(p[1], nz.mul(p[2])));
            let over_q = nx.mul_add(q[0], ny.mul_add(q[1], nz.mul(q[2])));
            let over_r = nx.mul_add(r[0], ny.mul_add(r[1], nz.mul(r[2])));
            let over = over_p.min(over_q).min(over_r);
            let square = nx.mul_add(nx, ny.mul_add(ny, nz.mul(nz)));
            let edges = ex.mul_add(ex, ey.mul_add(ey, ez.mul(ez))).mul(gx.mul_add(gx, gy.mul_add(gy, gz.mul(gz))));
            let over_squared = over.mul(over);
            let good = over.greater(zero)
                & square.greater(least)
                & over_squared.greater(edges.mul(determinant))
                & square.mul(height).mul(L::load(flags)).at_most(over_squared);
            bad |= good ^ 0b1111;
            first += 4;
        }
        bad == 0
    }
}

/// The coordinates of four corners.
#[inline(always)]
fn components<L: Lanes>(positions: &[[f64; 4]; MOST_CORNERS + 1], [a, b, c, d]: [u8; 4]) -> [L; 3] {
    L::components(&[
        L::load(&positions[usize::from(a)]),
        L::load(&positions[usize::from(b)]),
        L::load(&positions[usize::from(c)]),
        L::load(&positions[usize::from(d)]),
    ])
}
