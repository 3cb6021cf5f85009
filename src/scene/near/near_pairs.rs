//! The pairs that are near, in the order of results, with the cache of each. They stay from query to query; a walk along the
//! sorted candidates tells which come and which go.

use std::ops::Range;
use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{collected, copied, extend, reserve, with_capacity};
use crate::compound::GrowingCache;
use crate::pair::PairCache;
use crate::scene::near::candidates::{Candidates, order};
use crate::scene::near::contact_memory::ContactMemory;
use crate::scene::world::rows::Label;
use crate::scene::world::testing::Testing;

/// Two proxies whose boxes overlap, the earlier first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NearPair {
    pub proxies: [u32; 2],
    /// While both odometers together are below this by more than a tolerance, the pieces are farther apart than that.
    pub apart_until: f64,
    /// The index of its cache.
    pub cache: u32,
    pub testing: Testing,
    /// Whether it takes a share of an error budget, as it was dealt out last.
    pub takes_share: bool,
}

/// The finding of the last pass of one kind over the list for a pair.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairMark {
    /// The index of its own result in that pass's results, [`OUTDONE`] or [`UNLISTED`].
    pub result: u32,
    /// The pass looked at it and left nothing open.
    pub is_answered: bool,
    /// For a listed pair, whether it intersects, …
    pub intersects: bool,
    /// … and where among [`SceneStatistics::by_level`](crate::scene::SceneStatistics::by_level) its answer counts.
    pub level: u8,
    /// So many more results of its own follow the first: pairs of compounds have one for each contact of theirs.
    pub more: u8,
}

/// Passes of one kind give answers of the last one of their kind again.
pub(crate) const KINDS_OF_PASSES: usize = 5;

/// The index for a pair that a pass does not list.
pub(crate) const UNLISTED: u32 = u32::MAX;

/// The same where the pass lists another pair of the two objects instead.
pub(crate) const OUTDONE: u32 = UNLISTED - 1;

impl NearPair {
    pub fn new(proxies: [u32; 2]) -> NearPair {
        NearPair { proxies, apart_until: f64::NEG_INFINITY, cache: 0, testing: Testing::Active, takes_share: false }
    }
}

impl PairMark {
    /// The mark of a pair that no pass has looked at.
    pub const NONE: PairMark = PairMark { result: UNLISTED, is_answered: false, intersects: false, level: 0, more: 0 };

    /// Whether the pass lists it.
    #[inline(always)]
    pub fn is_listed(&self) -> bool {
        self.result < OUTDONE
    }

    /// Its result, found among those of a part of the pairs, stands this many places later among all.
    pub fn shift_result(&mut self, places: u32) {
        if self.is_listed() {
            self.result += places;
        }
    }
}

/// The number of sorted pairs before another one; found faster the fewer come behind.
fn count_before(pairs: &[NearPair], firsts: &[u32], proxies: [u32; 2]) -> usize {
    let place = order(firsts, proxies);
    let mut behind = 0;
    let mut step = 1;
    while step <= pairs.len() && order(firsts, pairs[pairs.len() - step].proxies) > place {
        (behind, step) = (step, 2 * step);
    }
    let begin = pairs.len().saturating_sub(step);
    let is_before = |pair: &NearPair| order(firsts, pair.proxies) < place;
    begin + pairs[begin..pairs.len() - behind].partition_point(is_before)
}

/// The list.
#[derive(Debug, Default)]
pub(crate) struct NearPairs {
    pub pairs: Vec<NearPair>,
    /// For each kind of pass, a mark for each pair, in their order; kinds that were not made have none.
    pub marks: [Vec<PairMark>; KINDS_OF_PASSES],
    /// The caches of the pairs' queries, in no order: pairs move when others come and go, caches do not. Several threads may
    /// change theirs at once: [`locked`].
    pub caches: Vec<Mutex<PairCache>>,
    /// … and of contacts, at the same places, …
    pub contacts: ContactMemory,
    /// … and of pieces of compounds, where there are compounds.
    pub compounds: Vec<Mutex<GrowingCache>>,
    /// Caches without a pair; with room for all.
    free: Vec<u32>,
    /// Pairs that come, until they are merged.
    arrivals: Vec<NearPair>,
}

impl NearPairs {
    /// Brings the list up to date: among the pairs that `is_open`, those stay that are among the candidates, and candidates that
    /// were not there come, `testing` deciding whether they are tested. Candidates are sorted, and no more than a scratch
    /// afterwards.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); pairs may then be missing.
    pub fn update(
        &mut self,
        candidates: &mut Candidates,
        firsts: &[u32],
        is_open: impl Fn([u32; 2]) -> bool,
        testing: impl FnMut([u32; 2]) -> Testing,
    ) -> Result<()> {
        candidates.sort(firsts)?;
        let found = &mut candidates.pairs;
        let (mut new, mut next) = (0, 0);
        // Pairs before the first one that goes stay where they are; those between two that go move together.
        let (mut kept, mut moved) = (0, 0);
        for at in 0..self.pairs.len() {
            let pair = self.pairs[at].proxies;
            if !is_open(pair) {
                continue;
            }
            let place = order(firsts, pair);
            while next < found.len() && order(firsts, found[next]) < place {
                found[new] = found[next];
                (new, next) = (new + 1, next + 1);
            }
            if found.get(next) == Some(&pair) {
                next += 1;
                continue;
            }
            self.free.push(self.pairs[at].cache);
            self.contacts.forget(self.pairs[at].cache);
            if let Some(cache) = self.compounds.get_mut(self.pairs[at].cache as usize) {
                *unlocked(cache) = GrowingCache::default();
            }
            if kept < moved && moved < at {
                self.move_pairs(moved..at, kept);
            }
            (kept, moved) = (kept + at - moved, at + 1);
        }
        self.pairs.drain(kept..moved);
        self.marks_made().for_each(|marks| drop(marks.drain(kept..moved)));
        found.copy_within(next.., new);
        found.truncate(new + found.len() - next);
        self.merge(found, firsts, testing)
    }

    /// Adds sorted pairs that are not there: from the end on, so that each old one moves at most once and in place, with those
    /// next to it.
    fn merge(
        &mut self,
        new_pairs: &[[u32; 2]],
        firsts: &[u32],
        mut testing: impl FnMut([u32; 2]) -> Testing,
    ) -> Result<()> {
        debug_assert!(new_pairs.is_sorted_by(|a, b| order(firsts, *a) < order(firsts, *b)));
        let arrivals = &mut self.arrivals;
        arrivals.clear();
        extend(arrivals, new_pairs.iter().map(|&pair| NearPair::new(pair)))?;
        arrivals.iter_mut().for_each(|pair| pair.testing = testing(pair.proxies));
        reserve(&mut self.pairs, arrivals.len())?;
        for marks in self.marks.iter_mut().filter(|marks| !marks.is_empty()) {
            reserve(marks, arrivals.len())?;
        }
        let more = arrivals.len().saturating_sub(self.free.len());
        reserve(&mut self.caches, more)?;
        let room = self.caches.len() + more - self.free.len();
        reserve(&mut self.free, room)?;
        for pair in arrivals.iter_mut() {
            pair.cache = self.free.pop().unwrap_or(self.caches.len() as u32);
            match self.caches.get_mut(pair.cache as usize) {
                Some(cache) => *unlocked(cache) = PairCache::default(),
                None => self.caches.push(Mutex::default()),
            }
        }
        let (mut old, mut new) = (self.pairs.len(), arrivals.len());
        self.pairs.extend_from_slice(arrivals);
        let count = self.pairs.len();
        self.marks_made().for_each(|marks| marks.resize(count, PairMark::NONE));
        while let Some(arrival) = new.checked_sub(1).map(|last| self.arrivals[last]) {
            let before = count_before(&self.pairs[..old], firsts, arrival.proxies);
            if before < old {
                self.move_pairs(before..old, before + new);
            }
            (old, new) = (before, new - 1);
            self.pairs[old + new] = arrival;
            self.marks_made().for_each(|marks| marks[old + new] = PairMark::NONE);
        }
        Ok(())
    }

    /// The marks of the kinds of passes that were made.
    fn marks_made(&mut self) -> impl Iterator<Item = &mut Vec<PairMark>> {
        self.marks.iter_mut().filter(|marks| !marks.is_empty())
    }

    /// Moves pairs, with their marks, within the list.
    fn move_pairs(&mut self, pairs: Range<usize>, to: usize) {
        self.marks_made().for_each(|marks| marks.copy_within(pairs.clone(), to));
        self.pairs.copy_within(pairs, to);
    }

    /// Makes marks for passes of a kind, if there are none.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn make_marks(&mut self, kind: usize) -> Result<()> {
        debug_assert!(self.marks[kind].is_empty() || self.marks[kind].len() == self.pairs.len());
        let missing = self.pairs.len() - self.marks[kind].len();
        reserve(&mut self.marks[kind], missing)?;
        self.marks[kind].resize(self.pairs.len(), PairMark::NONE);
        Ok(())
    }

    /// Makes room for the pieces of compounds, of all pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn make_compound_room(&mut self) -> Result<()> {
        let missing = self.caches.len().saturating_sub(self.compounds.len());
        reserve(&mut self.compounds, missing)?;
        self.compounds.resize_with(self.caches.len().max(self.compounds.len()), Mutex::default);
        Ok(())
    }

    /// Decides anew for all whether they are tested, from earlier settings.
    pub fn for_each_testing(&mut self, labels: &[Label], mut testing: impl FnMut(Testing, [&Label; 2]) -> Testing) {
        for pair in &mut self.pairs {
            pair.testing = testing(pair.testing, pair.proxies.map(|proxy| &labels[proxy as usize]));
        }
    }

    /// Forgets depths of pairs that do not intersect, as the last pass of this kind has found.
    pub fn forget_depths(&mut self, kind: usize) {
        debug_assert_eq!(self.marks[kind].len(), self.pairs.len());
        for (pair, mark) in self.pairs.iter().zip(&self.marks[kind]) {
            if !mark.is_listed() || !mark.intersects {
                self.contacts.forget_depth(pair.cache);
            }
        }
    }

    /// Gives back the room that the pairs do not need, and all marks.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory) if there is none for smaller lists; nothing has changed then.
    pub fn shrink(&mut self) -> Result<()> {
        let mut pairs = copied(&self.pairs)?;
        let caches = collected(pairs.iter().map(|pair| Mutex::new(*locked(&self.caches[pair.cache as usize]))))?;
        let contacts = self.contacts.packed(pairs.iter().map(|pair| pair.cache))?;
        let free = with_capacity(caches.len())?;
        for (place, pair) in (0..).zip(&mut pairs) {
            pair.cache = place;
        }
        *self = NearPairs { pairs, caches, contacts, free, ..NearPairs::default() };
        Ok(())
    }

    /// Numbers the proxies anew, in the same order: number k of old becomes `numbers[k]`.
    pub fn renumber(&mut self, numbers: &[u32]) {
        for pair in &mut self.pairs {
            pair.proxies = pair.proxies.map(|proxy| numbers[proxy as usize]);
        }
    }

    /// Says of one pair, if it is there, whether it is tested, unless it was rejected.
    pub fn set_testing(&mut self, firsts: &[u32], proxies: [u32; 2], testing: Testing) {
        debug_assert!(proxies[0] < proxies[1]);
        let place = |pair: &NearPair| order(firsts, pair.proxies);
        if let Ok(place) = self.pairs.binary_search_by_key(&order(firsts, proxies), place)
            && self.pairs[place].testing != Testing::Rejected
        {
            self.pairs[place].testing = testing;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, BTreeSet};
    use swiftprox::random::Random;

    /// Against a map: pairs come and go, and each keeps its own memory.
    #[test]
    fn pairs_keep_their_order_and_what_they_remember() {
        let mut random = Random::new(0x9a12);
        let (mut list, mut candidates) = (NearPairs::default(), Candidates::default());
        let mut model: BTreeMap<((u64, u64), [u32; 2]), u32> = BTreeMap::new();
        let kind = 2;
        for round in 1..if cfg!(miri) { 20 } else { 400 } {
            let count = 40;
            // Objects of one, two and three pieces.
            let firsts: Vec<u32> = (0..count as u32).map(|k| k - [0, 0, 1, 0, 1, 2][k as usize % 6]).collect();
            let open: Vec<bool> = (0..count).map(|_| round % 3 == 0 || random.below(5) == 0).collect();
            let is_open = |[a, b]: [u32; 2]| open[a as usize] | open[b as usize];
            let mut found = BTreeSet::new();
            for _ in 0..random.below(300) {
                let [a, b] = [random.below(count) as u32, random.below(count) as u32];
                if a != b && is_open([a, b]) {
                    let pair = [a.min(b), a.max(b)];
                    found.insert((order(&firsts, pair), pair));
                    candidates.add(a, b).unwrap();
                    // Twice is once.
                    candidates.add(b, a).unwrap();
                }
            }
            list.make_marks(kind).unwrap();
            list.update(&mut candidates, &firsts, is_open, |_| Testing::Active).unwrap();
            list.make_marks(kind).unwrap();
            candidates.clear();
            model.retain(|pair, _| !is_open(pair.1) || found.contains(pair));
            for pair in found {
                model.entry(pair).or_insert(UNLISTED);
            }
            assert_eq!(list.caches.len(), list.pairs.len() + list.free.len());
            let caches: BTreeSet<u32> =
                list.pairs.iter().map(|pair| pair.cache).chain(list.free.iter().copied()).collect();
            assert_eq!(caches.len(), list.caches.len(), "no two share one");
            let listed: Vec<([u32; 2], u32)> =
                list.pairs.iter().zip(&list.marks[kind]).map(|(pair, mark)| (pair.proxies, mark.result)).collect();
            assert_eq!(listed, model.iter().map(|(pair, &mark)| (pair.1, mark)).collect::<Vec<_>>());
            for (pair, mark) in list.pairs.iter().zip(&mut list.marks[kind]) {
                mark.result = round;
                model.insert((order(&firsts, pair.proxies), pair.proxies), round);
            }
        }
    }
}
