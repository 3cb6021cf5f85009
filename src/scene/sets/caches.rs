//! The caches of pairs of a question's pieces from one question to the next.

use crate::base::error::Result;
use crate::base::memory::filled;
use crate::pair::PairCache;

/// Pairs whose cache is kept, a power of two: those of an arm and what is around it.
const SLOTS: usize = 1024;

/// Caches of pairs, each at the place given by its pair's numbers: of two pairs at one place the later has it. Whatever a cache
/// holds, it is safe for any pair.
#[derive(Debug, Default)]
pub(crate) struct Caches {
    slots: Vec<CacheSlot>,
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
        let [a, b] = pair.map(u64::from);
        // By the golden ratio (Knuth 1998, §6.4): numbers of neighbours come far apart.
        let mixed = (a.rotate_left(32) ^ b).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let slot = &mut self.slots[(mixed >> 32) as usize % SLOTS];
        if slot.pair != pair {
            *slot = CacheSlot { pair, cache: PairCache::default() };
        }
        &mut slot.cache
    }
}
