//! What a pair remembers from one query to the next, and what of it is still good for the bodies at hand.

use super::{PairConfig, Start};
use crate::base::math::Vector;
use crate::pair::descent::{Leveled, Place};
use crate::polyhedron::Polyhedron;
use crate::solve::decide::Pairs;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Marker;
use crate::solve::separating_axis::Axis;
use crate::solve::state::State;

/// What a pair remembers from its last query (that its bounding spheres did not answer). Any bytes are safe; all zero is cold.
/// It changes how fast an answer comes, never the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct PairCache {
    /// 0: nothing; 1 to 6: a feature pair, the number of its kind; 8 + n: n vertex pairs of an intersection; 16 + the number of
    /// its kind: a feature pair of two levels of detail, which are `pairs[0]`.
    pub(super) kind: u32,
    /// The indices of a feature pair.
    pub(super) indices: [u32; 2],
    /// Vertex pairs. With a feature pair, after a query for the verdict alone: the vertices of a separating axis, its direction
    /// as the bits of single-precision numbers, and [`AXIS`].
    pub(super) pairs: [VertexPair; 4],
    /// With a feature pair: where body 1 saw body 2 when it was found. With vertex pairs: when they last proved an intersection.
    pub(super) marker: Marker,
}

/// `PairCache::kind` of no vertex pairs.
const PAIRS: u32 = 8;

/// What `PairCache::kind` of a feature pair of levels has more.
const LEVELS: u32 = 16;

/// Marks a separating axis in `PairCache::pairs`. Where other pairs happen to look like one no harm is done.
const AXIS: u32 = u32::from_ne_bytes(*b"axis");

impl PairCache {
    /// The vertex pairs of an intersection, if the cache holds any that the polyhedra have.
    #[inline(always)]
    pub(super) fn recall_pairs(&self, polyhedra: [&Polyhedron; 2]) -> Option<Pairs> {
        if !self.holds_pairs() {
            return None;
        }
        let pairs = &self.pairs[..(self.kind - PAIRS) as usize];
        let [count1, count2] = [polyhedra[0].vertices.len(), polyhedra[1].vertices.len()];
        let known = |&[v, w]: &VertexPair| (v as usize) < count1 && (w as usize) < count2;
        pairs.iter().all(known).then(|| Pairs::new(pairs))
    }

    /// Whether it holds vertex pairs of an intersection, be they any that the bodies have or not.
    #[inline(always)]
    pub(super) fn holds_pairs(&self) -> bool {
        (PAIRS + 1..=PAIRS + 4).contains(&self.kind)
    }

    #[inline(always)]
    pub(super) fn remember_state(&mut self, state: State) {
        self.kind = state.kind as u32;
        self.indices = state.indices();
    }

    /// The separating axis of the last verdict, if the cache holds one of vertices that the polyhedra have.
    #[inline(always)]
    pub(super) fn recall_axis(&self, polyhedra: [&Polyhedron; 2]) -> Option<Axis> {
        let [vertices @ [v, w], [x, y], [z, mark], _] = self.pairs;
        let is_known = (mark == AXIS)
            & ((1..=6).contains(&self.kind))
            & ((v as usize) < polyhedra[0].vertices.len())
            & ((w as usize) < polyhedra[1].vertices.len());
        is_known.then_some(Axis { vertices, direction: [x, y, z].map(f32::from_bits) })
    }

    #[inline(always)]
    pub(super) fn remember_axis(&mut self, vertices: [u32; 2], direction: Vector) {
        let [x, y, z] = bits(direction);
        [self.pairs[0], self.pairs[1], self.pairs[2]] = [vertices, [x, y], [z, AXIS]];
    }

    pub(super) fn remember_pairs(&mut self, pairs: &[VertexPair]) {
        self.kind = PAIRS + pairs.len() as u32;
        self.pairs[..pairs.len()].copy_from_slice(pairs);
    }

    /// Whether the last answer came from levels of detail.
    #[inline(always)]
    pub(super) fn holds_levels(&self) -> bool {
        self.kind > LEVELS
    }

    /// From where a pair may have jumped, unless it is to begin at its last features all the same.
    #[inline(always)]
    pub(super) fn last_marker(&self, config: &PairConfig) -> Option<&Marker> {
        (config.start != Start::Cache).then_some(&self.marker)
    }

    /// A place among levels, if the bodies have it. A feature pair without levels is one, too.
    #[inline(always)]
    pub(super) fn recall_place(&self, bodies: &Leveled) -> Option<Place> {
        let (kind, levels) = if self.kind > LEVELS { (self.kind - LEVELS, self.pairs[0]) } else { (self.kind, [0, 0]) };
        let coarsest = bodies.coarsest();
        let levels = [u16::try_from(levels[0]).ok()?, u16::try_from(levels[1]).ok()?];
        if levels[0] > coarsest[0] || levels[1] > coarsest[1] {
            return None;
        }
        State::checked(kind, self.indices, bodies.polyhedra(levels)).map(|state| Place { levels, state })
    }

    #[inline(always)]
    pub(super) fn remember_place(&mut self, place: Place) {
        self.kind = LEVELS + place.state.kind as u32;
        self.indices = place.state.indices();
        self.pairs[0] = place.levels.map(u32::from);
        self.pairs[1] = [0; 2];
    }

    /// Steps that queries whose budget ran out have made on the way to this place.
    #[inline(always)]
    pub(super) fn spent_before(&self) -> u32 {
        if self.kind > LEVELS { self.pairs[1][0] } else { 0 }
    }
}

/// The single-precision bits of a vector.
#[inline(always)]
fn bits(v: Vector) -> [u32; 3] {
    [(v.x as f32).to_bits(), (v.y as f32).to_bits(), (v.z as f32).to_bits()]
}
