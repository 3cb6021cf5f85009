//! A pass over all pairs there are, where everything is near.

use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{collected, push};
use crate::pair::PairCache;
use crate::scene::near::candidates::order;
use crate::scene::near::near_pairs::{NearPair, NearPairs, PairMark};
use crate::scene::search::findings::Findings;
use crate::scene::search::narrow_phase::{BLOCK, Own, Pass};
use crate::scene::search::query::PiecePairs;
use crate::scene::world::testing::{Rules, Testing};

/// As [`Pass::run`] over all pairs, a block at a time. The caches of near pairs are used and kept, those of others are not.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn run_over_all(
    pass: &Pass,
    rules: &mut Rules,
    near: &mut NearPairs,
    findings: &mut Findings,
) -> Result<bool> {
    let proxies = pass.proxies;
    let objects = collected(proxies.of_objects())?;
    let mut block = PairBlock::default();
    // Both go through the pairs in the same order.
    let mut next = 0;
    for (k, object1) in objects.iter().enumerate() {
        for object2 in &objects[k + 1..] {
            // Of two objects of which one pair is listed, many pairs are asked block by block, too, apart from those of others.
            let is_cut = pass.request.piece_pairs != PiecePairs::Every && object1.len() * object2.len() > BLOCK;
            if is_cut && block.run(pass, near, findings)? {
                return Ok(true);
            }
            'pairs: for a in object1.clone() {
                for b in object2.clone() {
                    let labels = [&proxies.labels[a], &proxies.labels[b]];
                    if !proxies.may_meet(a, b) || rules.testing(labels) != Testing::Active {
                        continue;
                    }
                    let pair = [a as u32, b as u32];
                    let place = order(&proxies.firsts, pair);
                    let is_before = |known: &NearPair| order(&proxies.firsts, known.proxies) < place;
                    while near.pairs.get(next).is_some_and(is_before) {
                        next += 1;
                    }
                    let known = near.pairs.get(next).filter(|known| known.proxies == pair).map(|known| known.cache);
                    if is_cut {
                        if block.pairs.len() >= BLOCK && block.run_over(pass, near, findings)? {
                            break 'pairs;
                        }
                    } else if block.is_full(pass, pair) && block.run(pass, near, findings)? {
                        return Ok(true);
                    }
                    block.add(pair, known, near)?;
                }
            }
            if is_cut {
                block.run_over(pass, near, findings)?;
                findings.end_choice();
                if pass.request.early_exit && findings.intersecting {
                    return Ok(true);
                }
            }
        }
    }
    block.run(pass, near, findings)
}

/// Pairs to be looked at together.
#[derive(Default)]
struct PairBlock {
    pairs: Vec<NearPair>,
    marks: Vec<PairMark>,
    caches: Vec<Mutex<PairCache>>,
    /// Those that near pairs have.
    kept: Vec<Option<u32>>,
}

impl PairBlock {
    /// Whether they are many, and the next pair may be in another block.
    fn is_full(&self, pass: &Pass, next: [u32; 2]) -> bool {
        self.pairs.len() >= BLOCK && self.pairs.last().is_some_and(|last| pass.may_part(last, &NearPair::new(next)))
    }

    fn add(&mut self, pair: [u32; 2], kept: Option<u32>, near: &NearPairs) -> Result<()> {
        push(&mut self.pairs, NearPair { cache: self.caches.len() as u32, ..NearPair::new(pair) })?;
        push(&mut self.marks, PairMark::NONE)?;
        let known = kept.map(|kept| *locked(&near.caches[kept as usize]));
        push(&mut self.caches, Mutex::new(known.unwrap_or_default()))?;
        push(&mut self.kept, kept)
    }

    fn run(&mut self, pass: &Pass, near: &mut NearPairs, findings: &mut Findings) -> Result<bool> {
        let PairBlock { pairs, marks, caches, .. } = self;
        let stopped = pass.run(pairs, marks, &mut Own { caches, contacts: None, compounds: &[] }, findings)?;
        self.end(near);
        Ok(stopped)
    }

    /// The same with pairs of two objects that have others, of which one is listed; true if no more of theirs are to be asked.
    fn run_over(&mut self, pass: &Pass, near: &mut NearPairs, findings: &mut Findings) -> Result<bool> {
        let PairBlock { pairs, marks, caches, .. } = self;
        let stopped = pass.run_over(pairs, marks, &mut Own { caches, contacts: None, compounds: &[] }, findings)?;
        self.end(near);
        Ok(stopped)
    }

    fn end(&mut self, near: &mut NearPairs) {
        for (kept, cache) in self.kept.iter().zip(&mut self.caches) {
            if let Some(kept) = kept {
                *unlocked(&mut near.caches[*kept as usize]) = *unlocked(cache);
            }
        }
        self.pairs.clear();
        self.marks.clear();
        self.caches.clear();
        self.kept.clear();
    }
}
