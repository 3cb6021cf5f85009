//! Raising a pyramid over the facet of least overlap, once a search has found it.

use super::Rounding;
use super::pyramid::{MOST_CORNERS, Pyramid};
use super::support::{Support, vertex_beyond};
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::polyhedron::Polyhedron;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;

/// What is this much less far, over the size of the pair, ties: above what rounding makes of a facet's heights.
const TIE: f64 = f64::from_bits((1023 - 43) << 52);

/// Vertices of a body that tie; of more there is no pyramid.
const MOST_TIED: usize = 64;

/// How far the base reaches around its foot, over the depth, for a ring of four corners to be enough.
const WIDE: f64 = 2.0;

/// How far sides are to be from the origin, over the depth: the pyramid is to last for some steps …
const LASTING: f64 = 1.25;

/// … and how far it suffices them to be, so that no other apex is tried.
const AMPLE: f64 = 3.0;

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
        rounding: Rounding::of(frame),
        direction: *direction,
        across: [first, direction.cross(&first)],
        depth,
    };
    let [tied1, tied2] = [0, 1].map(|body| raising.tied(body, near[body]));
    let base = raising.base([&tied1?, &tied2?])?;
    raising.over(&base)
}

/// Vertices of a body that are as far along the direction as any.
struct Tied {
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
    rounding: Rounding,
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
    fn tied(&self, body: usize, near: u32) -> Option<Tied> {
        let (polyhedron, towards) = (self.frame.bodies[body].polyhedron, self.own(body, &self.direction));
        let height = |v: u32| polyhedron.vertices[v as usize].position.dot(&towards);
        let tie = TIE * self.frame.size;
        let mut tied = Tied { vertices: [near; MOST_TIED], count: 1 };
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

    /// Of the facet, which is made of all pairs of vertices that tie, those that reach farthest in eight directions across, or in
    /// every second of them where these reach far enough around the foot.
    fn base(&self, tied: [&Tied; 2]) -> Option<Base> {
        let [of_first, of_second] = [0, 1].map(|body| self.extremes(body, tied[body]));
        let pair = |at: usize| [of_first[at], of_second[at]];
        let all = Base::of((0..EIGHT).map(pair));
        let halves = [0, 1].map(|odd| Base::of((0..EIGHT / 2).map(|at| pair(2 * at + odd))));
        let room = halves.each_ref().map(|half| self.room(half));
        let wider = usize::from(room[1] > room[0]);
        let [even, odd] = halves;
        let half = if wider == 1 { odd } else { even };
        let base = if room[wider] >= WIDE * self.depth || half.count == all.count { half } else { all };
        (base.count >= 3).then_some(base)
    }

    fn extremes(&self, body: usize, tied: &Tied) -> [u32; EIGHT] {
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
            self.direction.dot(&along.cross(&(foot - from))) / along.norm()
        };
        if pairs.len() < 3 { f64::NEG_INFINITY } else { (0..pairs.len()).map(inside).fold(f64::INFINITY, f64::min) }
    }

    /// A pyramid is proved in the end: that its vertices are the farthest need not be sure.
    fn support(&self, direction: &Vector, from: Option<VertexPair>) -> Support {
        vertex_beyond(self.frame, &self.rounding, &direction.normalize(), from)
    }

    /// The pyramid over a base: with the apex whose nearest side is the farthest, and with further triangles across edges where a
    /// side is too near all the same.
    fn over(&self, base: &Base) -> Option<Pyramid> {
        let mut apices = [[0; 2]; APICES];
        let mut apex_count = 0;
        let mut pyramid = Pyramid::new(base.pairs(), [0; 2]);
        let mut ring = Ring::of(self, base);
        loop {
            let mut best = Side { distance: f64::NEG_INFINITY, place: 0, apex: [0; 2] };
            for (at, apex) in apices.iter_mut().enumerate() {
                if at == apex_count {
                    let aside = if at == 0 { Vector::zeros() } else { self.aside(at - 1) * ASIDE };
                    *apex = self.support(&(aside - self.direction), None).pair;
                    apex_count += 1;
                }
                let side = ring.nearest_side(self.position(*apex), *apex);
                best = if side.distance > best.distance { side } else { best };
                if best.distance >= AMPLE * self.depth {
                    break;
                }
            }
            if best.distance >= LASTING * self.depth {
                pyramid.set_apex(best.apex);
                return Some(pyramid);
            }
            let corner = self.beyond(&ring, best.place)?;
            if ring.pairs().contains(&corner) || !pyramid.add_across(best.place, corner) {
                return None;
            }
            ring.insert(best.place, corner, self.position(corner));
        }
    }

    /// One of four directions across.
    fn aside(&self, at: usize) -> Vector {
        let [x, y] = &self.across;
        [*x, *y, -x, -y][at % 4]
    }

    /// A corner of the facet across an edge of the ring, as far as a few rounds of wrapping find it.
    fn beyond(&self, ring: &Ring, place: usize) -> Option<VertexPair> {
        let [from, to] = ring.edge(place);
        let along = to - from;
        let mut towards = self.direction + along.cross(&self.direction).normalize();
        let mut found: Option<Support> = None;
        for _ in 0..WRAPPINGS {
            let next = self.support(&towards, found.map(|support| support.pair));
            if found.is_some_and(|found| found.pair == next.pair) {
                break;
            }
            found = Some(next);
            let [x, y, z, _] = next.position;
            let across = (Vector::new(x, y, z) - from).cross(&along);
            // Towards a corner of the edge itself there is no plane.
            if !(across.norm() > self.rounding.plane * along.norm()) {
                return None;
            }
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
    // Of 17° and of 62°.
    let [[c, s], [d, t]] =
        [[0.956_304_755_963_035_5, 0.292_371_704_722_736_7], [0.469_471_562_785_890_8, 0.882_947_592_858_927]];
    [[c, s], [d, t], [-s, c], [-t, d], [-c, -s], [-d, -t], [s, -c], [t, -d]]
};

/// The ring as far as it has come.
struct Ring {
    pairs: [VertexPair; MOST_CORNERS],
    positions: [Vector; MOST_CORNERS],
    count: usize,
}

/// The nearest side under an apex.
struct Side {
    distance: f64,
    place: usize,
    apex: VertexPair,
}

impl Ring {
    fn of<L: Lanes>(raising: &Raising<L>, base: &Base) -> Ring {
        let mut positions = [Vector::zeros(); MOST_CORNERS];
        for (position, pair) in positions.iter_mut().zip(base.pairs()) {
            *position = raising.position(*pair);
        }
        Ring { pairs: base.corners, positions, count: base.count }
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

    fn nearest_side(&self, apex: Vector, pair: VertexPair) -> Side {
        let mut nearest = Side { distance: f64::INFINITY, place: 0, apex: pair };
        for place in 0..self.count {
            let [from, to] = self.edge(place);
            let across = (apex - from).cross(&(to - from));
            let distance = across.dot(&from) / across.norm();
            // A NaN is no side.
            if !(distance >= nearest.distance) {
                nearest =
                    Side { distance: if distance.is_nan() { f64::NEG_INFINITY } else { distance }, place, apex: pair };
            }
        }
        nearest
    }
}
