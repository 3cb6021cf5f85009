//! Pairs of overlapping boxes, as they are found and in the order of results.

use crate::base::error::Result;
use crate::base::memory::{extend, push, reserve};
use crate::scene::world::proxies::Proxies;

/// The rank of a pair in the order of results: by object 1, object 2, piece 1, piece 2. For each proxy `firsts` holds the first
/// of its object, which serves as a name for that.
#[inline(always)]
pub(crate) fn order(firsts: &[u32], [proxy1, proxy2]: [u32; 2]) -> (u64, u64) {
    let [object1, object2] = [firsts[proxy1 as usize], firsts[proxy2 as usize]];
    (joined([object1, object2]), joined([proxy1, proxy2]))
}

#[inline(always)]
fn joined([high, low]: [u32; 2]) -> u64 {
    u64::from(high) << 32 | u64::from(low)
}

/// Candidates: pairs of overlapping boxes in any order, then sorted.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    pub pairs: Vec<[u32; 2]>,
    sorted: Vec<[u32; 2]>,
    /// The start of the pairs of each object 1.
    starts: Vec<u32>,
}

impl Candidates {
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    #[inline(always)]
    pub fn add(&mut self, a: u32, b: u32) -> Result<()> {
        debug_assert!(a != b);
        push(&mut self.pairs, if a < b { [a, b] } else { [b, a] })
    }

    /// If the two may make a pair.
    #[inline(always)]
    pub fn add_if_meeting(&mut self, proxies: &Proxies, a: u32, b: u32) -> Result<()> {
        if proxies.may_meet(a as usize, b as usize) { self.add(a, b) } else { Ok(()) }
    }

    /// Adds those that another part has found.
    pub fn append(&mut self, part: &Candidates) -> Result<()> {
        extend(&mut self.pairs, part.pairs.iter().copied())
    }

    /// Sorts them, each once.
    pub fn sort(&mut self, firsts: &[u32]) -> Result<()> {
        if self.pairs.len() < firsts.len() / 4 {
            self.pairs.sort_unstable_by_key(|&pair| order(firsts, pair));
        } else {
            self.sort_by_object(firsts)?;
        }
        self.pairs.dedup();
        Ok(())
    }

    /// One pass puts them where those of their object 1 are, which are few, and sorted there.
    fn sort_by_object(&mut self, firsts: &[u32]) -> Result<()> {
        let object = |pair: &[u32; 2]| firsts[pair[0] as usize] as usize;
        self.starts.clear();
        reserve(&mut self.starts, firsts.len() + 1)?;
        self.starts.resize(firsts.len() + 1, 0);
        self.sorted.clear();
        reserve(&mut self.sorted, self.pairs.len())?;
        self.sorted.resize(self.pairs.len(), [0; 2]);
        for pair in &self.pairs {
            self.starts[object(pair) + 1] += 1;
        }
        for k in 0..firsts.len() {
            self.starts[k + 1] += self.starts[k];
        }
        for pair in &self.pairs {
            let next = &mut self.starts[object(pair)];
            self.sorted[*next as usize] = *pair;
            *next += 1;
        }
        let mut begin = 0;
        for &end in &self.starts[..firsts.len()] {
            self.sorted[begin..end as usize].sort_unstable_by_key(|&pair| order(firsts, pair));
            begin = end as usize;
        }
        std::mem::swap(&mut self.pairs, &mut self.sorted);
        Ok(())
    }
}
