//! The pair's cache from one query to the next, and which of its content still holds for the bodies at hand. Only this module
//! packs and unpacks it.
//!
//! | it holds | first word | indices | vertex pairs |
//! |---|---|---|---|
//! | nothing | 0, or any other number | | |
//! | features | 1 to 6, the kind of state | of the features | of a separating axis, perhaps |
//! | an enclosure | 8 and how many vertex pairs | | those that proved the last intersection |
//! | … and the facet that proved the last depth | 20 and how many pairs, and 4 times its kind | of the facet | as above |
//! | features of levels | 16 and the kind of state | of the features | the levels, and the steps spent |
//! | a direction | 40 | | a separating axis |
//!
//! Beside all but an enclosure, the last vertex pair records how the axis lay, and by which way approximate queries answer.

use crate::base::math::Vector;
use crate::body::polyhedron::Polyhedron;
use crate::depth::facets::Facet;
use crate::distance::decide::Pairs;
use crate::distance::separating_axis::Axis;
use crate::pair::habit::Habit;
use crate::pair::levels::{LevelState, Leveled};
use crate::placed::exact::VertexPair;
use crate::placed::frame::Marker;
use crate::placed::state::State;

/// A pair's memory of its last query (that its bounding spheres did not answer). Any bytes are safe; all zero is cold.
/// It changes how fast an answer comes, never the verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct PairCache {
    tag: u32,
    indices: [u32; 2],
    pairs: [VertexPair; 4],
    /// Where body 1 saw body 2 when the features were found, or when the enclosure last proved an intersection.
    pub(super) marker: Marker,
}

/// The content of a cache, as its first word gives it.
enum Content {
    Nothing,
    /// The kind of the state.
    Features(u32),
    /// How many vertex pairs.
    Enclosure(usize),
    /// The kind of the state.
    Levels(u32),
    /// An axis without features.
    Direction,
}

/// The first word of an enclosure, and of features of levels, exceeds the number in [`Content`] by this.
const ENCLOSURE: u32 = 8;
const LEVELS: u32 = 16;
const RESTING: u32 = 20;
/// The first word of a direction alone.
const DIRECTION: u32 = 40;

/// Marks a separating axis beside features. If other bytes happen to look like one, no harm is done.
const AXIS: u32 = u32::from_ne_bytes(*b"axis");

impl PairCache {
    #[inline(always)]
    fn content(&self) -> Content {
        match self.tag {
            tag @ 1..=6 => Content::Features(tag),
            tag @ 9..=12 => Content::Enclosure((tag - ENCLOSURE) as usize),
            tag @ 17..=22 => Content::Levels(tag - LEVELS),
            DIRECTION => Content::Direction,
            tag @ 25..=36 => Content::Enclosure(((tag - RESTING - 1) % 4 + 1) as usize),
            _ => Content::Nothing,
        }
    }

    // --- Features, and the axis beside them --------------------------------------------------------------------------------------

    /// The last features, be they any that the bodies have or not.
    #[inline(always)]
    pub(super) fn features(&self) -> Option<State> {
        State::unchecked(self.tag, self.indices)
    }

    /// The last features, if the polyhedra have them.
    #[inline(always)]
    pub(super) fn features_of(&self, polyhedra: [&Polyhedron; 2]) -> Option<State> {
        State::checked(self.tag, self.indices, polyhedra)
    }

    #[inline(always)]
    pub(super) fn remember_features(&mut self, state: State) {
        self.tag = state.kind as u32;
        self.indices = state.indices();
    }

    /// The separating axis of the last verdict, if the cache holds one of vertices that the polyhedra have.
    #[inline(always)]
    pub(super) fn axis(&self, polyhedra: [&Polyhedron; 2]) -> Option<Axis> {
        let [vertices @ [v, w], [x, y], [z, mark], _] = self.pairs;
        let is_known = (mark == AXIS)
            & matches!(self.content(), Content::Features(_) | Content::Direction)
            & ((v as usize) < polyhedra[0].vertices.len())
            & ((w as usize) < polyhedra[1].vertices.len());
        is_known.then_some(Axis { vertices, direction: [x, y, z].map(f32::from_bits) })
    }

    /// Beside features.
    #[inline(always)]
    pub(super) fn remember_axis(&mut self, vertices: [u32; 2], direction: Vector) {
        let [x, y, z] = bits(direction);
        [self.pairs[0], self.pairs[1], self.pairs[2]] = [vertices, [x, y], [z, AXIS]];
    }

    /// The same axis, from other vertices.
    #[inline(always)]
    pub(super) fn move_axis(&mut self, vertices: [u32; 2]) {
        self.pairs[0] = vertices;
    }

    // --- A direction, and how look-ups went --------------------------------------------------------------------------------------

    /// The direction of the last approximate answer in body 1's axes, from body 2 to body 1, and how it lay.
    #[inline(always)]
    pub(super) fn direction(&self) -> Option<(Vector, Lean)> {
        let [_, [x, y], [z, mark], [lean, _]] = self.pairs;
        let is_known = (mark == AXIS) & matches!(self.content(), Content::Features(_) | Content::Direction);
        let [x, y, z] = [x, y, z].map(|bits| f32::from_bits(bits).into());
        is_known.then_some((Vector::new(x, y, z), Lean(f32::from_bits(lean))))
    }

    /// Instead of features, which the bodies leave behind. The vertices of the axis stay where they are: a climb starts there.
    #[inline(always)]
    pub(super) fn remember_direction(&mut self, direction: Vector, lean: Lean) {
        let [[v, w], _, [_, mark], [_, habit]] = self.pairs;
        let is_beside = matches!(self.content(), Content::Features(_) | Content::Direction);
        let vertices = if is_beside & (mark == AXIS) { [v, w] } else { [0; 2] };
        self.tag = DIRECTION;
        self.remember_axis(vertices, direction);
        self.pairs[3] = [lean.0.to_bits(), habit];
    }

    /// Whether the support functions are looked up this time, where they may be: not of bodies that intersected the last time.
    #[inline(always)]
    pub(super) fn looks_up(&self) -> bool {
        !self.holds_enclosure() && Habit::of(self.pairs[3][1]).looks_up()
    }

    /// Notes that look-ups have answered; `is_still`: the pair has hardly moved since the last time.
    #[inline(always)]
    pub(super) fn note_look_ups(&mut self, is_still: bool) {
        self.pairs[3][1] = Habit::of(self.pairs[3][1]).looked_up(is_still).word();
    }

    /// Notes how many steps marching took where look-ups might have answered, and whether they were tried without success.
    #[inline(always)]
    pub(super) fn note_marching(&mut self, steps: u32, in_vain: bool) {
        if !self.holds_enclosure() {
            let habit = Habit::of(self.pairs[3][1]);
            self.pairs[3][1] = if in_vain { habit.failed() } else { habit.marched(steps) }.word();
        }
    }

    // --- An enclosure ------------------------------------------------------------------------------------------------------------

    /// The enclosure that proved the last intersection, if the cache holds one of vertices that the polyhedra have.
    #[inline(always)]
    pub(crate) fn enclosure(&self, polyhedra: [&Polyhedron; 2]) -> Option<Pairs> {
        let Content::Enclosure(count) = self.content() else { return None };
        let pairs = &self.pairs[..count];
        let [count1, count2] = [polyhedra[0].vertices.len(), polyhedra[1].vertices.len()];
        let known = |&[v, w]: &VertexPair| (v as usize) < count1 && (w as usize) < count2;
        pairs.iter().all(known).then(|| Pairs::new(pairs))
    }

    /// The facet that proved the last depth, whether or not the bodies have it.
    #[inline(always)]
    pub(super) fn facet(&self) -> Option<Facet> {
        let [first, second] = self.indices;
        Facet::of_words([self.tag.wrapping_sub(RESTING + 1) / 4, first, second])
    }

    /// Beside an enclosure.
    #[inline(always)]
    pub(super) fn remember_facet(&mut self, facet: Facet) {
        if let Content::Enclosure(count) = self.content() {
            let [kind, first, second] = facet.words();
            (self.tag, self.indices) = (RESTING + 4 * kind + count as u32, [first, second]);
        }
    }

    /// Whether it holds an enclosure, whether or not the bodies have its vertices.
    #[inline(always)]
    pub(super) fn holds_enclosure(&self) -> bool {
        matches!(self.content(), Content::Enclosure(_))
    }

    pub(super) fn remember_enclosure(&mut self, pairs: &[VertexPair]) {
        self.tag = ENCLOSURE + pairs.len() as u32;
        self.pairs[..pairs.len()].copy_from_slice(pairs);
    }

    // --- Features of levels ------------------------------------------------------------------------------------------------------

    /// Whether the last answer came from levels of detail.
    #[inline(always)]
    pub(super) fn holds_level_state(&self) -> bool {
        matches!(self.content(), Content::Levels(_))
    }

    /// Levels and features of theirs, if the bodies have them. Features without levels are those of the bodies themselves.
    #[inline(always)]
    pub(super) fn level_state(&self, bodies: &Leveled) -> Option<LevelState> {
        let (kind, levels) = match self.content() {
            Content::Levels(kind) => (kind, self.pairs[0]),
            Content::Features(kind) => (kind, [0, 0]),
            Content::Nothing | Content::Enclosure(_) | Content::Direction => return None,
        };
        let coarsest = bodies.coarsest();
        let levels = [u16::try_from(levels[0]).ok()?, u16::try_from(levels[1]).ok()?];
        if levels[0] > coarsest[0] || levels[1] > coarsest[1] {
            return None;
        }
        State::checked(kind, self.indices, bodies.polyhedra(levels)).map(|state| LevelState { levels, state })
    }

    /// `spent`: steps that queries whose budget ran out have made on the way there.
    #[inline(always)]
    pub(super) fn remember_level_state(&mut self, at: LevelState, spent: u32) {
        self.tag = LEVELS + at.state.kind as u32;
        self.indices = at.state.indices();
        self.pairs[0] = at.levels.map(u32::from);
        self.pairs[1] = [spent, 0];
    }

    /// Steps that queries whose budget ran out have made on the way to the features of levels that it holds.
    #[inline(always)]
    pub(super) fn spent_before(&self) -> u32 {
        if self.holds_level_state() { self.pairs[1][0] } else { 0 }
    }
}

/// How a direction lies to the line between the origins: its cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lean(f32);

impl Lean {
    #[inline(always)]
    pub(super) fn of(cosine: f64) -> Lean {
        Lean(cosine as f32)
    }

    /// Whether it lies about as it did: one direction in ten does so by chance. A NaN does not.
    #[inline(always)]
    pub(super) fn is_near(self, cosine: f64) -> bool {
        const ABOUT: f64 = 0.1;
        (cosine - f64::from(self.0)).abs() < ABOUT
    }
}

/// The single-precision bits of a vector.
#[inline(always)]
fn bits(v: Vector) -> [u32; 3] {
    [(v.x as f32).to_bits(), (v.y as f32).to_bits(), (v.z as f32).to_bits()]
}
