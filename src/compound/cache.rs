//! The cache of a pair of compounds: pieces that met the last time, the nearest, the front of verdicts, and the caches of some
//! pairs of pieces.

use super::body::Compound;
use super::front::Front;
use crate::base::error::Result;
use crate::base::memory::{filled, with_capacity};
use crate::depth::{DepthCache, DepthFacets};
use crate::manifold::Reference;
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

/// Pieces that met, and the nearest or deepest ones; counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub(crate) struct LastPieces {
    met: [u32; 2],
    nearest: [u32; 2],
}

impl LastPieces {
    /// The pieces that met the last time, of bodies of so many.
    pub fn met(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        known(self.met, counts)
    }

    /// The pieces that were the nearest, or the deepest in each other.
    pub fn nearest(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        known(self.nearest, counts)
    }

    /// Remembers which pieces met.
    pub fn remember_met(&mut self, pieces: Option<[u32; 2]>) {
        self.met = numbered(pieces);
    }

    /// Remembers which were the nearest.
    pub fn remember_nearest(&mut self, pieces: Option<[u32; 2]>) {
        self.nearest = numbered(pieces);
    }
}

/// What a pair of compounds remembers from its last queries. Any bytes are safe; all zero is cold. It changes how fast an answer
/// comes, which of several pairs of pieces is named, and how tight `lower` of a verdict is; never the verdict.
#[derive(Debug, Clone, PartialEq, Eq)]
#[repr(C)]
pub struct CompoundCache {
    last: LastPieces,
    front: Front,
    slots: [PairSlot; SLOTS],
}

impl Default for CompoundCache {
    fn default() -> Self {
        CompoundCache { last: LastPieces::default(), front: Front::default(), slots: [PairSlot::default(); SLOTS] }
    }
}

impl CompoundCache {
    /// The pairs of nodes where the last walk of a verdict ended, for pictures: of each tree the first of the node's leaves, and
    /// the one behind the last.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    #[doc(hidden)]
    pub fn front_tiles(&self, bodies: [&Compound; 2]) -> Result<Vec<[[u32; 2]; 2]>> {
        self.front.tiles(bodies.map(|body| body.tree.view()))
    }
}

/// What a pair remembers of its pieces.
pub(crate) trait PieceCaches {
    /// Which met, and which were the nearest.
    fn last(&mut self) -> &mut LastPieces;
    /// The front of verdicts.
    fn front(&mut self) -> &mut Front;
    /// The cache of two pieces: their own, or a cold one in place of another pair's.
    fn of(&mut self, pieces: [u32; 2]) -> &mut PairCache;
}

impl PieceCaches for CompoundCache {
    fn last(&mut self) -> &mut LastPieces {
        &mut self.last
    }

    fn front(&mut self) -> &mut Front {
        &mut self.front
    }

    #[inline(always)]
    fn of(&mut self, pieces: [u32; 2]) -> &mut PairCache {
        let own = pieces.map(|piece| piece.wrapping_add(1));
        taken(&mut self.slots[slot_number(own, SLOTS)], own)
    }
}

/// The same that begins small and grows with the pairs of pieces that are asked. Where memory is lacking it stays as it is.
#[derive(Debug, Default)]
pub(crate) struct GrowingCache {
    last: LastPieces,
    front: Front,
    /// None, or a power of two.
    slots: Vec<PairSlot>,
    /// For the pieces that are asked while there is no memory.
    spare: PairCache,
    /// Of the pieces that the last query of contacts asked, in order.
    contacts: Vec<ContactSlot>,
}

/// Slots at first.
const FIRST_SLOTS: usize = 4;

impl GrowingCache {
    /// So many slots, with those of before.
    fn grow(&mut self, count: usize) -> bool {
        let Ok(slots) = filled(PairSlot::default(), count) else { return false };
        let old = std::mem::replace(&mut self.slots, slots);
        for slot in old.into_iter().filter(|slot| slot.pieces != [0; 2]) {
            self.slots[slot_number(slot.pieces, count)] = slot;
        }
        true
    }

    /// For a query of contacts that asks so many pairs of pieces in order: what the last one left. Give it back with
    /// [`GrowingCache::keep_contacts`].
    pub fn take_contacts(&mut self, count: usize) -> KeptContacts {
        KeptContacts {
            before: std::mem::take(&mut self.contacts),
            next: 0,
            // None, where memory is lacking, is cold and as good.
            now: with_capacity(count.min(MOST_CONTACTS)).unwrap_or_default(),
            spare: ContactSlot::default(),
        }
    }

    /// Keeps what a query of contacts has found for the next one.
    pub fn keep_contacts(&mut self, kept: KeptContacts) {
        self.contacts = kept.now;
    }
}

/// So many pairs of pieces keep their contacts, 180 bytes each.
const MOST_CONTACTS: usize = 256;

/// What two pieces remember of their contact.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ContactSlot {
    pieces: [u32; 2],
    pub cache: PairCache,
    reference: Reference,
    depth: DepthFacets,
}

impl ContactSlot {
    /// Changes what is remembered of the manifold and, of pieces that intersect, of the depth.
    pub fn change<T>(
        &mut self,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> T,
    ) -> T {
        if !intersects {
            self.depth = DepthFacets::default();
            return change(&mut self.reference, None);
        }
        let mut depth = DepthCache::of_facets(&self.depth);
        let changed = change(&mut self.reference, Some(&mut depth));
        self.depth = depth.facets();
        changed
    }
}

/// The contacts of two compounds during a query: those of before and, step by step beside them, those of now.
pub(crate) struct KeptContacts {
    before: Vec<ContactSlot>,
    next: usize,
    now: Vec<ContactSlot>,
    /// For pieces without room.
    spare: ContactSlot,
}

impl KeptContacts {
    /// The memory of two pieces, which come behind those of the last call.
    pub fn of(&mut self, pieces: [u32; 2]) -> &mut ContactSlot {
        debug_assert!(self.now.last().is_none_or(|last| last.pieces < pieces));
        while self.before.get(self.next).is_some_and(|slot| slot.pieces < pieces) {
            self.next += 1;
        }
        let own = self.before.get(self.next).filter(|slot| slot.pieces == pieces);
        let own = own.copied().unwrap_or(ContactSlot { pieces, ..ContactSlot::default() });
        if self.now.len() == self.now.capacity() {
            self.spare = own;
            return &mut self.spare;
        }
        self.now.push(own);
        let last = self.now.len() - 1;
        &mut self.now[last]
    }
}

impl PieceCaches for GrowingCache {
    fn last(&mut self) -> &mut LastPieces {
        &mut self.last
    }

    fn front(&mut self) -> &mut Front {
        &mut self.front
    }

    fn of(&mut self, pieces: [u32; 2]) -> &mut PairCache {
        let own = pieces.map(|piece| piece.wrapping_add(1));
        if self.slots.is_empty() && !self.grow(FIRST_SLOTS) {
            return &mut self.spare;
        }
        loop {
            let count = self.slots.len();
            let holder = self.slots[slot_number(own, count)].pieces;
            let is_others = holder != own && holder != [0; 2];
            if !is_others || count >= SLOTS || !self.grow(2 * count) {
                break;
            }
        }
        let count = self.slots.len();
        taken(&mut self.slots[slot_number(own, count)], own)
    }
}

/// Where the cache of two pieces is among so many slots, a power of two of 2 and more.
#[inline(always)]
fn slot_number([a, b]: [u32; 2], slots: usize) -> usize {
    debug_assert!(slots.is_power_of_two() && slots > 1);
    // Multiples of the golden ratio of 2³² spread what follows in order (D. E. Knuth, The Art of Computer Programming 3, 6.4).
    let spread = a.wrapping_mul(0x9e37_79b1).wrapping_add(b.wrapping_mul(0x85eb_ca77));
    (spread >> (32 - slots.ilog2())) as usize
}

/// The cache in a slot, cold if it was another pair's.
#[inline(always)]
fn taken(slot: &mut PairSlot, own: [u32; 2]) -> &mut PairCache {
    if slot.pieces != own {
        *slot = PairSlot { pieces: own, cache: PairCache::default() };
    }
    &mut slot.cache
}

fn known(pieces: [u32; 2], counts: [usize; 2]) -> Option<[u32; 2]> {
    let [a, b] = pieces.map(|piece| piece.wrapping_sub(1));
    ((a as usize) < counts[0] && (b as usize) < counts[1]).then_some([a, b])
}

fn numbered(pieces: Option<[u32; 2]>) -> [u32; 2] {
    pieces.map_or([0; 2], |pieces| pieces.map(|piece| piece + 1))
}
