//! The caches of pairs of a question's pieces from one question to the next.

use crate::base::error::Result;
use crate::base::memory::{collected, filled};
use crate::compound::GrowingCache;
use crate::pair::PairCache;

/// Pairs whose cache is kept, a power of two: those of an arm and what is around it.
const SLOTS: usize = 1024;

/// Pairs with a compound whose caches are kept: fewer, since each is larger.
const COMPOUND_SLOTS: usize = 64;

/// Caches of pairs, each at the place given by its pair's numbers: of two pairs at one place the later has it. Whatever a cache
/// holds, it is safe for any pair.
#[derive(Debug, Default)]
pub(crate) struct Caches {
    slots: Vec<CacheSlot>,
    compounds: Vec<([u32; 2], GrowingCache)>,
    /// The pair that hit at the time tried last, of whatever scene; `None` if none did. At the next one it
    /// often hits again.
    pub last_hit: Option<[u32; 2]>,
}

#[derive(Debug, Clone, Copy, Default)]
struct CacheSlot {
    pair: [u32; 2],
    cache: PairCache,
}

impl Caches {
    /// Makes room, the first time.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn make_room(&mut self) -> Result<()> {
        if self.slots.is_empty() {
            self.slots = filled(CacheSlot::default(), SLOTS)?;
        }
        Ok(())
    }

    /// The cache of a pair of pieces; there is room.
    pub fn of(&mut self, pair: [u32; 2]) -> &mut PairCache {
        let slot = &mut self.slots[mixed(pair) % SLOTS];
        if slot.pair != pair {
            *slot = CacheSlot { pair, cache: PairCache::default() };
        }
        &mut slot.cache
    }

    /// The cache of a pair of which one is a compound.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn of_compounds(&mut self, pair: [u32; 2]) -> Result<&mut GrowingCache> {
        if self.compounds.is_empty() {
            self.compounds = collected((0..COMPOUND_SLOTS).map(|_| Default::default()))?;
        }
        let slot = &mut self.compounds[mixed(pair) % COMPOUND_SLOTS];
        if slot.0 != pair {
            *slot = (pair, GrowingCache::default());
        }
        Ok(&mut slot.1)
    }
}

/// By the golden ratio (Knuth 1998, §6.4): numbers of neighbours come far apart.
fn mixed(pair: [u32; 2]) -> usize {
    let [a, b] = pair.map(u64::from);
    ((a.rotate_left(32) ^ b).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize
}
