//! From near pairs to results: what a first look at rows of numbers settles, and the pair layer for what is left.
//!
//! | first look | settles |
//! |---|---|
//! | outer spheres | pairs farther apart than the tolerance |
//! | odometers | pairs that cannot have come near since they were last found apart |
//! | stamps | pairs of which neither piece has moved since the same query before: its answer is given again |
//! | inner spheres | of queries for intersection alone, pairs that certainly intersect |
//!
//! Only the last two list pairs. The last is a function of the poses, and an answer given again is the one that the
//! same query gave there: what is listed, and with what outcome, does not depend on the past.

use crate::base::error::Result;
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::memory::{push, reserve};
use crate::base::simd::prefetch;
use crate::pair::{DecidedBy, DepthCache, DepthEnding, Outcome, PairAnswer, PairCache, PairConfig, Placed, Reference};
use crate::scene::broad_phase::near_pairs::{NearPair, Testing, UNLISTED};
use crate::scene::contacts::{ContactMemory, Contacts, Details};
use crate::scene::proxies::{Proxies, are_far_apart, overlap_inside};
use crate::scene::query::PairResult;
use crate::scene::statistics::{SceneStatistics, Settled};

/// Pairs that are looked at before the first of them is tested.
pub(crate) const BLOCK: usize = 256;

/// So many tests ahead the memory is asked for poses and caches: one test takes about as long as memory does.
const TEST_AHEAD: usize = 3;

/// So many looks ahead it is asked for spheres and odometers.
const LOOK_AHEAD: usize = 16;

/// The answer of balls that overlap.
const INSCRIBED: PairAnswer = PairAnswer {
    outcome: Outcome::Intersecting,
    decided_by: DecidedBy::InscribedSpheres,
    distance: 0.0,
    lower: 0.0,
    upper: 0.0,
    ..PairAnswer::UNSAID
};

/// One of the pair queries of [`pair`](crate::pair).
pub(crate) type Solver = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>;

/// What one query asks of each pair.
pub(crate) struct Pass<'a> {
    pub proxies: &'a Proxies,
    pub solver: Solver,
    pub config: &'a PairConfig,
    /// Whether the verdict alone is asked for, and only intersecting pairs are listed.
    pub verdict_only: bool,
    /// Beyond this, pairs are not listed.
    pub tolerance: f64,
    /// Stop behind the first intersecting pair.
    pub early_exit: bool,
    /// The number of this pass over the pairs, from 1 on.
    pub number: u64,
    /// The results of the pass before if it asked the same, else none.
    pub before: Option<&'a Before>,
    /// What is asked of listed pairs beside their answers.
    pub details: Option<&'a Details>,
}

/// The results of a pass, when another has begun.
#[derive(Debug, Default)]
pub(crate) struct Before {
    /// They, and what is left of earlier ones.
    pairs: Vec<PairResult>,
    contacts: Contacts,
}

/// What pairs remember, by place.
pub(crate) trait Caches {
    /// For reading.
    fn peek(&self, place: u32) -> &PairCache;
    /// Changes one.
    ///
    /// # Errors
    /// Those of `change`, and [`Error::Memory`](crate::base::error::Error::Memory).
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()>;
    /// Changes what is remembered of one's contact: of its depth where the two intersect.
    ///
    /// # Errors
    /// As of [`Caches::change`].
    fn change_contact(
        &mut self,
        place: u32,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> Result<()>,
    ) -> Result<()>;
}

/// Nobody else uses them.
pub(crate) struct Own<'a> {
    pub caches: &'a mut [PairCache],
    /// None for pairs that are forgotten.
    pub contacts: Option<&'a mut ContactMemory>,
}

impl Caches for Own<'_> {
    #[inline(always)]
    fn peek(&self, place: u32) -> &PairCache {
        &self.caches[place as usize]
    }

    #[inline(always)]
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()> {
        change(&mut self.caches[place as usize])
    }

    fn change_contact(
        &mut self,
        place: u32,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> Result<()>,
    ) -> Result<()> {
        match &mut self.contacts {
            Some(contacts) if intersects => {
                let (reference, cache) = contacts.of_intersecting(place)?;
                change(reference, Some(cache))
            }
            Some(contacts) => change(contacts.reference(place), None),
            None => change(&mut Reference::default(), intersects.then_some(&mut DepthCache::default())),
        }
    }
}

/// What came of a part of the pairs.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// Kept from pass to pass, with what is left of earlier ones behind the results.
    slots: Vec<PairResult>,
    count: usize,
    /// Of each result, where they are asked for.
    pub contacts: Contacts,
    pub statistics: SceneStatistics,
    pub intersecting: bool,
    /// Of one block of pairs those that the first look has not settled.
    left: Vec<(usize, Look)>,
}

impl Findings {
    /// For another pass.
    pub fn clear(&mut self) {
        self.count = 0;
        self.contacts.clear();
        self.statistics = SceneStatistics::default();
        self.intersecting = false;
    }

    /// Those of the pass, in the scene's order.
    pub fn results(&self) -> &[PairResult] {
        &self.slots[..self.count]
    }

    /// Takes the place of the results of before, and gives it to them.
    pub fn swap_results(&mut self, before: &mut Before) {
        std::mem::swap(&mut self.slots, &mut before.pairs);
        std::mem::swap(&mut self.contacts, &mut before.contacts);
    }

    /// Room for `count` more results.
    fn reserve(&mut self, count: usize) -> Result<()> {
        let missing = (self.count + count).saturating_sub(self.slots.len());
        reserve(&mut self.slots, missing)?;
        self.slots.resize(self.slots.len() + missing, PairResult::default());
        Ok(())
    }

    /// Adds those of another part behind; gives where they begin.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn append(&mut self, part: &Findings) -> Result<u32> {
        let first = self.count;
        self.reserve(part.count)?;
        self.slots[first..first + part.count].copy_from_slice(part.results());
        self.count += part.count;
        self.contacts.append_all(&part.contacts)?;
        self.intersecting |= part.intersecting;
        self.statistics.add(&part.statistics);
        Ok(first as u32)
    }

    /// Sum of `upper − lower` over the results.
    pub fn error_spent(&self) -> f64 {
        self.results().iter().map(|result| result.answer.upper - result.answer.lower).sum()
    }
}

/// What the first look says.
#[derive(Debug, Clone, Copy)]
enum Look {
    Settled,
    /// To be listed as result so-and-so of before.
    Again(u32),
    Intersects,
    Test,
}

impl Pass<'_> {
    /// Looks at pairs in order and adds the listed ones to `findings`; true if it stopped at an intersecting one, the last listed.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn run<C: Caches + ?Sized>(
        &self,
        pairs: &mut [NearPair],
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        for pairs in pairs.chunks_mut(BLOCK) {
            findings.left.clear();
            for k in 0..pairs.len() {
                if let Some(ahead) = pairs.get(k + LOOK_AHEAD) {
                    prefetch(&self.proxies.spheres[ahead.proxies[1] as usize]);
                    prefetch(&self.proxies.motions[ahead.proxies[1] as usize]);
                }
                match self.look(&mut pairs[k], &mut findings.statistics) {
                    Look::Settled => pairs[k].result = UNLISTED,
                    look => push(&mut findings.left, (k, look))?,
                }
            }
            findings.reserve(findings.left.len())?;
            for k in 0..findings.left.len() {
                if let Some((ahead, look)) = findings.left.get(k + TEST_AHEAD) {
                    let ahead = &pairs[*ahead];
                    prefetch(&self.proxies.labels[ahead.proxies[1] as usize]);
                    if let Look::Test = look {
                        prefetch(caches.peek(ahead.cache));
                        for proxy in ahead.proxies {
                            prefetch(&self.proxies.poses[proxy as usize]);
                        }
                    }
                }
                let (at, look) = findings.left[k];
                if self.list(look, &mut pairs[at], caches, findings)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    #[inline(always)]
    fn look(&self, pair: &mut NearPair, statistics: &mut SceneStatistics) -> Look {
        if pair.testing != Testing::Active {
            return Look::Settled;
        }
        let before = std::mem::replace(&mut pair.looked_at, self.number);
        let [a, b] = pair.proxies.map(|proxy| proxy as usize);
        let [spheres1, spheres2] = [&self.proxies.spheres[a], &self.proxies.spheres[b]];
        if are_far_apart(spheres1, spheres2, self.tolerance) {
            statistics.count_settled(Settled::BoundingSpheres);
            return Look::Settled;
        }
        let [motion1, motion2] = [&self.proxies.motions[a], &self.proxies.motions[b]];
        let travelled = motion1.odometer + motion2.odometer;
        // With s the odometers' sum when the pair was tested and s' now: from fl(s')(1 + 8u) + τ < (s(1 − 8u) + lower)(1 − 8u), all
        // rounded, s' + τ < s + lower follows, and so lower − (s' − s) > τ.
        if travelled * (1.0 + 8.0 * U) + self.tolerance < pair.apart_until {
            statistics.count_settled(Settled::OutOfReach);
            return Look::Settled;
        }
        if self.before.is_some() & (before + 1 == self.number) & (motion1.moved < before) & (motion2.moved < before) {
            if pair.result != UNLISTED {
                return Look::Again(pair.result);
            }
            statistics.count_settled(Settled::Unmoved);
            return Look::Settled;
        }
        if self.verdict_only && overlap_inside(spheres1, spheres2) { Look::Intersects } else { Look::Test }
    }

    /// Adds the pair's result if it is listed; true if the query is to stop there.
    #[inline(always)]
    fn list<C: Caches + ?Sized>(
        &self,
        look: Look,
        pair: &mut NearPair,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        let at = findings.count;
        let answer = &mut findings.slots[at].answer;
        match look {
            Look::Settled => {}
            Look::Again(result) => {
                if let Some(before) = self.before {
                    *answer = before.pairs[result as usize].answer;
                }
                findings.statistics.count_again(answer);
            }
            Look::Intersects => {
                *answer = INSCRIBED;
                findings.statistics.count(answer);
            }
            Look::Test => {
                *answer = PairAnswer::default();
                caches.change(pair.cache, |cache| self.test(pair, cache, answer))?;
                findings.statistics.count(answer);
            }
        }
        let is_listed = match answer.outcome {
            Outcome::Intersecting => true,
            Outcome::Separated | Outcome::Undecided => !self.verdict_only,
            Outcome::Beyond | Outcome::None => false,
        };
        if !is_listed {
            pair.result = UNLISTED;
            return Ok(false);
        }
        let intersects = answer.outcome == Outcome::Intersecting;
        if let Some(details) = self.details {
            self.find_details(details, look, pair, at, caches, findings)?;
        }
        pair.result = at as u32;
        self.sign(pair, &mut findings.slots[at]);
        findings.count += 1;
        findings.intersecting |= intersects;
        Ok(intersects & self.early_exit)
    }

    /// Asks the pair layer.
    #[inline(always)]
    fn test(&self, pair: &mut NearPair, cache: &mut PairCache, answer: &mut PairAnswer) -> Result<()> {
        let [a, b] = pair.proxies.map(|proxy| proxy as usize);
        let placed = |i: usize| self.proxies.shapes[i].at(&self.proxies.poses[i]);
        // Nothing is left to refuse: shapes are sound once made, poses and tolerances have been checked.
        (self.solver)([placed(a), placed(b)], cache, self.config, answer)?;
        pair.apart_until = self.apart_until(answer, a, b);
        // What a budget left open may go on the next time.
        if answer.decided_by == DecidedBy::Budget {
            pair.looked_at = 0;
        }
        Ok(())
    }

    /// What is asked beside the answer, which is the one at `at`.
    #[inline(never)]
    fn find_details<C: Caches + ?Sized>(
        &self,
        details: &Details,
        look: Look,
        pair: &mut NearPair,
        at: usize,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<()> {
        let Findings { slots, contacts, .. } = findings;
        if let (Look::Again(result), Some(before)) = (look, self.before) {
            return contacts.again(&before.contacts, result as usize);
        }
        let answer = &slots[at].answer;
        let bodies =
            pair.proxies.map(|proxy| self.proxies.shapes[proxy as usize].at(&self.proxies.poses[proxy as usize]));
        caches.change_contact(pair.cache, answer.outcome == Outcome::Intersecting, |reference, cache| {
            details.find(bodies, answer, reference, cache, contacts)
        })?;
        // As of distances.
        if contacts.last_ending() == Some(DepthEnding::Budget) {
            pair.looked_at = 0;
        }
        Ok(())
    }

    /// Whose result it is.
    #[inline(always)]
    fn sign(&self, pair: &NearPair, result: &mut PairResult) {
        let [label1, label2] = pair.proxies.map(|proxy| &self.proxies.labels[proxy as usize]);
        (result.object1, result.user_data1, result.piece1) = (label1.object, label1.user_data, label1.piece);
        (result.object2, result.user_data2, result.piece2) = (label2.object, label2.user_data, label2.piece);
    }

    /// See [`NearPair::apart_until`] and [`Pass::look`].
    #[inline(always)]
    fn apart_until(&self, answer: &PairAnswer, a: usize, b: usize) -> f64 {
        if !(answer.lower > 0.0) {
            return f64::NEG_INFINITY;
        }
        let travelled = self.proxies.motions[a].odometer + self.proxies.motions[b].odometer;
        (travelled * (1.0 - 8.0 * U) + answer.lower) * (1.0 - 8.0 * U)
    }
}
