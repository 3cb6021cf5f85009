//! The pairs' caches of contacts: the faces that met and, for pairs that intersect, the depth, in a pool.

use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{push, reserve, with_capacity};
use crate::manifold::Reference;
use crate::pair::DepthCache;

/// The contact cache of each near pair, by its place among the caches. It is empty until contacts are asked for more than
/// answers.
#[derive(Debug, Default)]
pub(crate) struct ContactMemory {
    pairs: Vec<Remembered>,
    /// The depths of pairs that intersected when they were last looked at, in no order.
    depths: Vec<Mutex<DepthCache>>,
    /// Depths without a pair; with room for all.
    free: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Remembered {
    reference: Reference,
    /// The index of its depth, or [`NO_DEPTH`].
    depth: u32,
}

const NO_DEPTH: u32 = u32::MAX;

const NOTHING: Remembered = Remembered { reference: Reference::NONE, depth: NO_DEPTH };

impl ContactMemory {
    /// Room for this many pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn make_room(&mut self, pairs: usize) -> Result<()> {
        let missing = pairs.saturating_sub(self.pairs.len());
        reserve(&mut self.pairs, missing)?;
        self.pairs.resize(self.pairs.len() + missing, NOTHING);
        Ok(())
    }

    /// For reading: the reference, and the depth if there is one.
    pub fn peek(&self, place: u32) -> (Reference, Option<&Mutex<DepthCache>>) {
        let pair = self.pairs.get(place as usize).copied().unwrap_or(NOTHING);
        (pair.reference, self.depths.get(pair.depth as usize))
    }

    pub fn reference(&mut self, place: u32) -> &mut Reference {
        &mut self.pairs[place as usize].reference
    }

    /// The memory of a pair that intersects: its own, or what another has given back, emptied, or more.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn of_intersecting(&mut self, place: u32) -> Result<(&mut Reference, &mut DepthCache)> {
        let Remembered { reference, depth } = &mut self.pairs[place as usize];
        if *depth == NO_DEPTH {
            *depth = match self.free.pop() {
                Some(free) => free,
                None => {
                    reserve(&mut self.free, self.depths.len() + 1)?;
                    push(&mut self.depths, Mutex::default())?;
                    (self.depths.len() - 1) as u32
                }
            };
            *unlocked(&mut self.depths[*depth as usize]) = DepthCache::default();
        }
        Ok((reference, unlocked(&mut self.depths[*depth as usize])))
    }

    /// A pair is no more.
    pub fn forget(&mut self, place: u32) {
        if let Some(pair) = self.pairs.get_mut(place as usize) {
            let Remembered { depth, .. } = std::mem::replace(pair, NOTHING);
            if depth != NO_DEPTH {
                self.free.push(depth);
            }
        }
    }

    /// A pair intersects no more.
    pub fn forget_depth(&mut self, place: u32) {
        let depth = std::mem::replace(&mut self.pairs[place as usize].depth, NO_DEPTH);
        if depth != NO_DEPTH {
            self.free.push(depth);
        }
    }

    /// A copy without what is free, of pairs that are at these places now and will be at 0, 1, …
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn packed(&self, places: impl ExactSizeIterator<Item = u32>) -> Result<ContactMemory> {
        let mut packed = ContactMemory::default();
        if self.pairs.is_empty() {
            return Ok(packed);
        }
        packed.make_room(places.len())?;
        let [_, used] = self.depth_counts();
        (packed.depths, packed.free) = (with_capacity(used)?, with_capacity(used)?);
        for (new, old) in (0..).zip(places) {
            let (reference, depth) = self.peek(old);
            match depth {
                Some(depth) => {
                    let (own, cache) = packed.of_intersecting(new)?;
                    (*own, *cache) = (reference, *locked(depth));
                }
                None => *packed.reference(new) = reference,
            }
        }
        Ok(packed)
    }

    /// How many depths there is room for, and how many are in use.
    pub fn depth_counts(&self) -> [usize; 2] {
        [self.depths.len(), self.depths.len() - self.free.len()]
    }
}
