//! Raising a pyramid over the facet of least overlap, once a search has found it.

use super::PairRounding;
use super::pyramid::{MOST_CORNERS, Pyramid};
use super::support::{Support, vertex_beyond};
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// Vertices less far by this much, over the size of the pair, count as ties: above the rounding error of a facet's heights.
const TIE: f64 = f64::from_bits((1023 - 43) << 52);

/// Vertices less far by this much belong to the same face, if its coordinates were rounded to float or to six digits. A pyramid
/// is proved in the end, so more does no harm.
const NEARLY: f64 = f64::from_bits((1023 - 16) << 52);

/// Vertices of a body that tie; for more there is no pyramid.
const MOST_TIED: usize = 64;

/// How far the base reaches around its foot, over the depth, for a ring of four corners to be enough.
const WIDE: f64 = 2.0;

/// The required distance of sides from the origin, over the depth: the pyramid should last for some steps …
const LASTING: f64 = 1.25;

/// … how far it suffices them to be, so that no other apex is tried …
const AMPLE: f64 = 3.0;

/// … and how far they are where the bodies are nearly as deep in each other along some other direction, at an edge.
const LASTING_AT_EDGE: f64 = 1.02;

/// How far beside the opposite of the direction further apices are looked for.
const ASIDE: f64 = 0.7;

/// A pyramid over the facet in a direction along which the bodies overlap by about `depth`, and least; `near` is a pair of vertices
/// that are farthest along it. `None` where there is none that lasts.
#[inline(always)]
pub fn raise<L: Lanes>(frame: &Frame<L>, direction: &Vector, depth: f64, near: VertexPair) -> Option<Pyramid> {
    let polyhedra = frame.polyhedra();
    if polyhedra.iter().any(|polyhedron| polyhedron.dimension < 3) {
        return None;
    }
    let axis = if direction.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let first = direction.cross(&axis).normalize();
    let raising = Raising {
        frame,
        rounding: PairRounding::of(frame),
        direction: *direction,
        across: [first, direction.cross(&first)],
        depth,
    };
    let [tied1, tied2] = [0, 1].map(|body| raising.tied(body, near[body], TIE));
    let base = raising.base([&tied1?, &tied2?])?;
    let plain = ApexCap::of(&raising, &base);
    let mut at_edge = None;
    raising.over(plain, &mut at_edge).or_else(|| raising.over(raising.widened(plain, near)?, &mut at_edge)).or(at_edge)
}

/// Vertices of a body that are as far along the direction as any.
struct TiedVertices {
    vertices: [u32; MOST_TIED],
    count: usize,
}

/// Corners around a base.
struct Base {
    corners: [VertexPair; MOST_CORNERS],
    count: usize,
}

impl Base {
    /// Without what follows its like.
    fn of(all: impl Iterator<Item = VertexPair>) -> Base {
        let mut base = Base { corners: [[0; 2]; MOST_CORNERS], count: 0 };
        for corner in all {
            if !base.pairs().contains(&corner) {
                base.corners[base.count] = corner;
                base.count += 1;
            }
        }
        base
    }

    fn pairs(&self) -> &[VertexPair] {
        &self.corners[..self.count]
    }
}

struct Raising<'a, L> {
    frame: &'a Frame<'a, L>,
    rounding: PairRounding,
    direction: Vector,
    /// Two unit vectors across it, counter-clockwise.
    across: [Vector; 2],
    depth: f64,
}

impl<L: Lanes> Raising<'_, L> {
    fn own(&self, body: usize, direction: &Vector) -> Vector {
        let own = self.frame.bodies[body].rotate_back(L::from_vector(direction)).to_vector();
        if body == 0 { own } else { -own }
    }

    fn position(&self, [v, w]: VertexPair) -> Vector {
        let [polyhedron1, polyhedron2] = self.frame.polyhedra();
        let (p, q) = (&polyhedron1.vertices[v as usize].position, &polyhedron2.vertices[w as usize].position);
        self.frame.difference(p, q).to_vector()
    }

    /// The vertices that tie: of few all are looked at, of many those next to each other.
    fn tied(&self, body: usize, near: u32, tie: f64) -> Option<TiedVertices> {
        let (polyhedron, towards) = (self.frame.bodies[body].polyhedron, self.own(body, &self.direction));
        let height = |v: u32| polyhedron.vertices[v as usize].position.dot(&towards);
        let tie = tie * self.frame.size;
        let mut tied = TiedVertices { vertices: [near; MOST_TIED], count: 1 };
        let count = polyhedron.vertices.len();
        if count <= MOST_TIED {
            let highest = (0..count as u32).map(height).fold(f64::NEG_INFINITY, f64::max);
            tied.count = 0;
            for vertex in (0..count as u32).filter(|vertex| height(*vertex) >= highest - tie) {
                tied.vertices[tied.count] = vertex;
                tied.count += 1;
            }
            return Some(tied);
        }
        let (highest, mut done) = (height(near), 0);
        while done < tied.count {
            let from = tied.vertices[done];
            done += 1;
            for head in polyhedron.neighbour_blocks(from).flat_map(|block| block.head) {
                if height(head) >= highest - tie && !tied.vertices[..tied.count].contains(&head) {
                    if tied.count == MOST_TIED {
                        return None;
                    }
                    tied.vertices[tied.count] = head;
                    tied.count += 1;
                }
            }
        }
        Some(tied)
    }

    /// A base of the facet, which is made of all pairs of vertices that tie. It takes those that reach farthest in eight
    /// directions across, or in every second of them where these reach far enough around the foot.
    fn base(&self, tied: [&TiedVertices; 2]) -> Option<Base> {
        let [of_first, of_second] = [0, 1].map(|body| self.extremes(body, tied[body]));
        let pair = |at: usize| [of_first[at], of_second[at]];
        let all = Base::of((0..EIGHT).map(pair));
        let (half, room) = self.wider_half(pair);
        let base = if room >= WIDE * self.depth || half.count == all.count { half } else { all };
        if base.count >= 3 { Some(base) } else { self.thin_base(tied) }
    }

    /// A face of three vertices under a vertex, or two edges: a facet so thin that what reaches farthest in eight directions are
    /// not all of its corners.
    fn thin_base(&self, [tied1, tied2]: [&TiedVertices; 2]) -> Option<Base> {
        let ([a, c, e, ..], [b, d, f, ..]) = (tied1.vertices, tied2.vertices);
        let (pairs, count) = match (tied1.count, tied2.count) {
            (1, 3) => ([[a, b], [a, d], [a, f], [a, f]], 3),
            (3, 1) => ([[a, b], [c, b], [e, b], [e, b]], 3),
            (2, 2) => ([[a, b], [c, b], [c, d], [a, d]], 4),
            _ => return None,
        };
        let [p, q, r] = [0, 1, 2].map(|at| self.position(pairs[at]));
        let is_counter_clockwise = self.direction.dot(&(q - p).cross(&(r - p))) > 0.0;
        let pairs = &pairs[..count];
        Some(if is_counter_clockwise { Base::of(pairs.iter().copied()) } else { Base::of(pairs.iter().rev().copied()) })
    }

    /// Every second of eight pairs, of these or of those, and how far inside the foot is.
    fn wider_half(&self, pair: impl Fn(usize) -> VertexPair) -> (Base, f64) {
        let [even, odd] = [0, 1].map(|odd| Base::of((0..EIGHT / 2).map(|at| pair(2 * at + odd))));
        let (room_even, room_odd) = (self.room(&even), self.room(&odd));
        if room_odd > room_even { (odd, room_odd) } else { (even, room_even) }
    }

    fn extremes(&self, body: usize, tied: &TiedVertices) -> [u32; EIGHT] {
        let polyhedron: &Polyhedron = self.frame.bodies[body].polyhedron;
        let [across, up] = self.across.map(|axis| self.own(body, &axis));
        let (mut farthest, mut extremes) = ([f64::NEG_INFINITY; EIGHT], [0; EIGHT]);
        for &vertex in &tied.vertices[..tied.count] {
            let position = &polyhedron.vertices[vertex as usize].position;
            let (x, y) = (across.dot(position), up.dot(position));
            for (at, [cosine, sine]) in AROUND.iter().enumerate() {
                let reach = cosine * x + sine * y;
                if reach > farthest[at] {
                    (farthest[at], extremes[at]) = (reach, vertex);
                }
            }
        }
        extremes
    }

    /// How far inside a base the foot is.
    fn room(&self, base: &Base) -> f64 {
        let foot = self.direction * self.depth;
        let pairs = base.pairs();
        let inside = |at: usize| {
            let [from, to] = [at, (at + 1) % pairs.len()].map(|at| self.position(pairs[at]));
            let along = to - from;
            let length = along.norm();
            if length > 0.0 { self.direction.dot(&along.cross(&(foot - from))) / length } else { f64::NEG_INFINITY }
        };
        if pairs.len() < 3 { f64::NEG_INFINITY } else { (0..pairs.len()).map(inside).fold(f64::INFINITY, f64::min) }
    }

    /// A pyramid is proved in the end: that its vertices are the farthest need not be sure.
    fn support(&self, direction: &Vector, from: Option<VertexPair>) -> Support {
        vertex_beyond(self.frame, &self.rounding, &direction.normalize(), from)
    }

    /// A cap with triangles around its base, out to the rim of a face that is flat only to the noise of its coordinates: there the
    /// facet of least overlap is small, and one of many that hardly lean. The cap is the upper hull of the base and of corners of
    /// the rim, which are wrapped from edge to edge (Chand & Kapur 1970).
    fn widened(&self, mut cap: ApexCap, near: VertexPair) -> Option<ApexCap> {
        let [nearly1, nearly2] = [0, 1].map(|body| self.tied(body, near[body], NEARLY));
        let [of_first, of_second] = [self.extremes(0, &nearly1?), self.extremes(1, &nearly2?)];
        let (rim, _) = self.wider_half(|at| [of_first[at], of_second[at]]);
        let rim = CapRing::of(self, &rim);
        let (mut place, mut done) = (0, 0);
        while done < cap.ring.count {
            let is_wider = match self.pivot(&cap.ring, place, &rim) {
                Some(Pivot::OfRim(at)) => cap.add_across(place, rim.pairs[at], rim.positions[at]),
                Some(Pivot::BesideFrom) => cap.fill_notch(place),
                Some(Pivot::BesideTo) => cap.fill_notch((place + 1) % cap.ring.count),
                None => false,
            };
            (place, done) = if is_wider { (0, 0) } else { (place + 1, done + 1) };
        }
        Some(cap)
    }

    /// Among corners of the rim and of the ring, the one that an edge of the ring makes the least leaning triangle with, outside
    /// the ring; `None` at the rim itself.
    fn pivot(&self, ring: &CapRing, place: usize, rim: &CapRing) -> Option<Pivot> {
        let [from, to] = ring.edge(place);
        let along = to - from;
        let outwards = along.cross(&self.direction);
        let before = (place + ring.count - 1) % ring.count;
        let after = (place + 2) % ring.count;
        let beside = [(Pivot::BesideFrom, ring.positions[before]), (Pivot::BesideTo, ring.positions[after])];
        let of_rim = (0..rim.count).filter(|at| !ring.pairs().contains(&rim.pairs[*at]));
        let of_rim = of_rim.map(|at| (Pivot::OfRim(at), rim.positions[at]));
        let mut best: Option<(Pivot, Vector)> = None;
        for (pivot, position) in beside.into_iter().chain(of_rim) {
            let beyond = position - from;
            if !(outwards.dot(&beyond) > self.rounding.plane * along.norm()) {
                continue;
            }
            if best.is_none_or(|(_, across)| across.dot(&beyond) > 0.0) {
                best = Some((pivot, beyond.cross(&along)));
            }
        }
        best.map(|(pivot, _)| pivot)
    }

    /// The pyramid over a cap: with the apex whose nearest side is the farthest, and with further triangles across edges where a
    /// side is still too near. A result that lasts only at an edge is left in `at_edge`.
    fn over(&self, mut cap: ApexCap, at_edge: &mut Option<Pyramid>) -> Option<Pyramid> {
        let mut apices = [[0; 2]; APICES];
        let mut apex_count = 0;
        loop {
            let mut best = CapSide { distance: f64::NEG_INFINITY, place: 0, apex: [0; 2] };
            for (at, apex) in apices.iter_mut().enumerate() {
                if at == apex_count {
                    let aside = if at == 0 { Vector::zeros() } else { self.aside(at - 1) * ASIDE };
                    *apex = self.support(&(aside - self.direction), None).pair;
                    apex_count += 1;
                }
                let side = cap.ring.nearest_side(self.position(*apex), *apex);
                best = if side.distance > best.distance { side } else { best };
                if best.distance >= AMPLE * self.depth {
                    break;
                }
            }
            cap.pyramid.set_apex(best.apex);
            if best.distance >= LASTING * self.depth {
                return Some(cap.pyramid);
            }
            if best.distance >= LASTING_AT_EDGE * self.depth {
                *at_edge = Some(cap.pyramid);
            }
            let corner = self.beyond(&cap.ring, &best)?;
            if cap.ring.pairs().contains(&corner) || !cap.add_across(best.place, corner, self.position(corner)) {
                return None;
            }
        }
    }

    /// One of four directions across.
    fn aside(&self, at: usize) -> Vector {
        let [x, y] = &self.across;
        [*x, *y, -x, -y][at % 4]
    }

    /// A corner of the facet across the edge of the ring under a side, as far as a few rounds of wrapping find it.
    fn beyond(&self, ring: &CapRing, side: &CapSide) -> Option<VertexPair> {
        let [from, to] = ring.edge(side.place);
        let along = to - from;
        // First half-way down, then as steep as the side is, which has something beyond it if it is no facet.
        let steep = (self.position(side.apex) - from).cross(&along);
        let mut further = (steep.norm_squared() > 0.0).then_some(steep);
        let mut towards = self.direction + along.cross(&self.direction).try_normalize(0.0)?;
        let mut found: Option<Support> = None;
        for _ in 0..WRAPPINGS {
            let next = self.support(&towards, found.map(|support| support.pair));
            let [x, y, z, _] = next.position;
            let across = (Vector::new(x, y, z) - from).cross(&along);
            // Towards a corner of the edge itself there is no plane: what was found ties with it, or is still to be found.
            if !(across.norm() > self.rounding.plane * along.norm()) {
                match further.take().filter(|_| found.is_none()) {
                    Some(steep) => towards = steep,
                    None => break,
                }
                continue;
            }
            if found.is_some_and(|found| found.pair == next.pair) {
                break;
            }
            found = Some(next);
            towards = across;
        }
        let found = found?;
        let [x, y, z, _] = found.position;
        let across = (Vector::new(x, y, z) - from).cross(&along);
        (across.dot(&from) > self.depth * across.norm()).then_some(found.pair)
    }
}

/// Apices that are tried.
const APICES: usize = 5;

/// Rounds in which a facet across an edge is looked for.
const WRAPPINGS: usize = 6;

/// Directions around, at angles that have nothing to do with those of bodies.
const EIGHT: usize = 8;
const AROUND: [[f64; 2]; EIGHT] = {
    // The cosines and sines of 17° and of 62°.
    let [[c, s], [d, t]] =
        [[0.956_304_755_963_035_5, 0.292_371_704_722_736_7], [0.469_471_562_785_890_8, 0.882_947_592_858_927]];
    [[c, s], [d, t], [-s, c], [-t, d], [-c, -s], [-d, -t], [s, -c], [t, -d]]
};

/// A base and its further triangles, in their current state.
#[derive(Clone, Copy)]
struct ApexCap {
    /// Without an apex.
    pyramid: Pyramid,
    ring: CapRing,
}

impl ApexCap {
    fn of<L: Lanes>(raising: &Raising<L>, base: &Base) -> ApexCap {
        ApexCap { pyramid: Pyramid::new(base.pairs(), [0; 2]), ring: CapRing::of(raising, base) }
    }

    /// Adds a triangle across the edge that begins at a place; whether there is room.
    fn add_across(&mut self, place: usize, corner: VertexPair, position: Vector) -> bool {
        let has_room = self.pyramid.add_across(place, corner);
        if has_room {
            self.ring.insert(place, corner, position);
        }
        has_room
    }

    /// Adds a triangle in the notch at a place; whether there is room.
    fn fill_notch(&mut self, place: usize) -> bool {
        let has_room = self.ring.count > 3 && self.pyramid.fill_notch(place);
        if has_room {
            self.ring.remove(place);
        }
        has_room
    }
}

/// The point that completes an edge of the ring to a triangle.
#[derive(Clone, Copy)]
enum Pivot {
    /// A corner of the rim.
    OfRim(usize),
    /// The corner of the ring before the edge, so that it ends the notch at its beginning.
    BesideFrom,
    /// The corner of the ring after the edge.
    BesideTo,
}

/// The ring in its current state.
#[derive(Clone, Copy)]
struct CapRing {
    pairs: [VertexPair; MOST_CORNERS],
    positions: [Vector; MOST_CORNERS],
    count: usize,
}

/// The nearest side under an apex.
struct CapSide {
    distance: f64,
    place: usize,
    apex: VertexPair,
}

impl CapRing {
    fn of<L: Lanes>(raising: &Raising<L>, base: &Base) -> CapRing {
        let mut positions = [Vector::zeros(); MOST_CORNERS];
        for (position, pair) in positions.iter_mut().zip(base.pairs()) {
            *position = raising.position(*pair);
        }
        CapRing { pairs: base.corners, positions, count: base.count }
    }

    fn pairs(&self) -> &[VertexPair] {
        &self.pairs[..self.count]
    }

    fn edge(&self, place: usize) -> [Vector; 2] {
        [self.positions[place], self.positions[(place + 1) % self.count]]
    }

    fn insert(&mut self, place: usize, pair: VertexPair, position: Vector) {
        self.pairs.copy_within(place + 1..self.count, place + 2);
        self.positions.copy_within(place + 1..self.count, place + 2);
        (self.pairs[place + 1], self.positions[place + 1]) = (pair, position);
        self.count += 1;
    }

    fn remove(&mut self, place: usize) {
        self.pairs.copy_within(place + 1..self.count, place);
        self.positions.copy_within(place + 1..self.count, place);
        self.count -= 1;
    }

    fn nearest_side(&self, apex: Vector, pair: VertexPair) -> CapSide {
        let mut nearest = CapSide { distance: f64::INFINITY, place: 0, apex: pair };
        for place in 0..self.count {
            let [from, to] = self.edge(place);
            let across = (apex - from).cross(&(to - from));
            let length = across.norm();
            // An apex on the edge has no side.
            let distance = if length > 0.0 { across.dot(&from) / length } else { f64::NEG_INFINITY };
            if !(distance >= nearest.distance) {
                nearest = CapSide { distance, place, apex: pair };
            }
        }
        nearest
    }
}
