//! The cache of a pair of compounds: pieces that met the last time, the nearest, and the caches of some pairs of pieces.

use crate::pair::PairCache;

/// So many pairs of pieces are remembered at a time.
const SLOTS: usize = 128;

/// The cache of two pieces; their numbers are counted from 1, so that 0 is nobody's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
struct PairSlot {
    pieces: [u32; 2],
    cache: PairCache,
}

/// What a pair of compounds remembers from its last queries. Any bytes are safe; all zero is cold. It changes how fast an answer
/// comes, and which of several pairs of pieces is named; never the verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
#[repr(C)]
pub struct CompoundCache {
    /// Pieces that met, and the nearest ones; counted from 1.
    met: [u32; 2],
    nearest: [u32; 2],
    slots: [PairSlot; SLOTS],
}

impl Default for CompoundCache {
    fn default() -> Self {
        CompoundCache { met: [0; 2], nearest: [0; 2], slots: [PairSlot::default(); SLOTS] }
    }
}

impl CompoundCache {
    /// The pieces that met the last time, of compounds of so many.
    pub(super) fn met(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        known(self.met, counts)
    }

    /// The pieces that were the nearest, or the deepest in each other.
    pub(super) fn nearest(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        known(self.nearest, counts)
    }

    pub(super) fn remember_met(&mut self, pieces: Option<[u32; 2]>) {
        self.met = numbered(pieces);
    }

    pub(super) fn remember_nearest(&mut self, pieces: Option<[u32; 2]>) {
        self.nearest = numbered(pieces);
    }

    /// The cache of two pieces: their own, or a cold one in place of another pair's.
    #[inline(always)]
    pub(super) fn of(&mut self, pieces: [u32; 2]) -> &mut PairCache {
        let [a, b] = pieces.map(|piece| piece.wrapping_add(1));
        // Multiples of the golden ratio of 2³² spread what follows in order (D. E. Knuth, The Art of Computer Programming 3, 6.4).
        let spread = a.wrapping_mul(0x9e37_79b1).wrapping_add(b.wrapping_mul(0x85eb_ca77));
        let slot = &mut self.slots[(spread >> (32 - SLOTS.ilog2())) as usize];
        if slot.pieces != [a, b] {
            *slot = PairSlot { pieces: [a, b], cache: PairCache::default() };
        }
        &mut slot.cache
    }
}

fn known(pieces: [u32; 2], counts: [usize; 2]) -> Option<[u32; 2]> {
    let [a, b] = pieces.map(|piece| piece.wrapping_sub(1));
    ((a as usize) < counts[0] && (b as usize) < counts[1]).then_some([a, b])
}

fn numbered(pieces: Option<[u32; 2]>) -> [u32; 2] {
    pieces.map_or([0; 2], |pieces| pieces.map(|piece| piece + 1))
}
