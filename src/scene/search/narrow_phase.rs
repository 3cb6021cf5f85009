//! From near pairs to results: a first look at rows of numbers settles some, and the pair layer the rest.
//!
//! | first look | settles |
//! |---|---|
//! | stamps | pairs of which neither piece has moved since the same query before: its answer is given again |
//! | outer spheres | pairs farther apart than the tolerance |
//! | odometers | pairs that cannot have come near since they were last found apart |
//! | inner spheres | of queries for intersection alone, pairs that certainly intersect |
//!
//! Only the first and the last list pairs. The last is a function of the poses, and an answer given again is the one that the
//! same query gave there: what is listed, and with what outcome, does not depend on the past.

use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::{locked, unlocked};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::simd::prefetch;
use crate::compound::GrowingCache;
use crate::manifold::Reference;
use crate::pair::{DecidedBy, DepthCache, DepthEnding, Outcome, PairAnswer, PairCache, PairConfig};
use crate::scene::near::contact_memory::ContactMemory;
use crate::scene::near::near_pairs::{NearPair, PairMark, UNLISTED};
use crate::scene::search::contacts::Details;
use crate::scene::search::findings::{Before, ChosenPair, Findings};
use crate::scene::search::query::{PairResult, PiecePairs};
use crate::scene::search::request::{Request, Solver};
use crate::scene::search::statistics::{SceneStatistics, Settled, level_of};
use crate::scene::world::compounds::{CompoundPair, NamedPieces};
use crate::scene::world::proxies::Proxies;
use crate::scene::world::rows::{are_far_apart, overlap_inside};
use crate::scene::world::testing::Testing;

/// Pairs that are looked at before the first of them is tested.
pub(crate) const BLOCK: usize = 1 << u8::BITS;

/// So many tests ahead the memory is asked for poses and caches: one test takes about as long as memory does.
const TEST_AHEAD: usize = 3;

/// So many looks ahead it is asked for spheres and odometers.
const LOOK_AHEAD: usize = 16;

/// So few pairs are tested one by one, without asking for memory ahead: they are in the cache.
const FEW: usize = LOOK_AHEAD;

/// The answer of balls that overlap.
const INSCRIBED: PairAnswer = PairAnswer {
    outcome: Outcome::Intersecting,
    decided_by: DecidedBy::InscribedSpheres,
    distance: 0.0,
    lower: 0.0,
    upper: 0.0,
    ..PairAnswer::UNSAID
};

/// One pass over pairs: the request to each, and its pieces.
#[derive(Clone, Copy)]
pub(crate) struct Pass<'a> {
    pub request: &'a Request,
    solver: Solver,
    /// The query for pairs with a share of an error budget.
    of_share: Option<PairConfig>,
    /// Copied from the request, since every look needs it.
    is_verdict: bool,
    tolerance: f64,
    pub proxies: &'a Proxies,
    /// The pass before, if it asked the same of the same pairs and its answers are to be given again.
    pub before: Option<&'a Before>,
}

/// The caches of the pairs, by place.
pub(crate) trait PairCaches {
    /// Asks for the memory of one.
    fn prefetch(&self, place: u32);
    /// Changes one.
    ///
    /// # Errors
    /// Those of `change`, and [`Error::Memory`](crate::base::error::Error::Memory).
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()>;
    /// Those of pieces of compounds, none where they are forgotten.
    fn compounds(&self) -> &[Mutex<GrowingCache>];
    /// Changes what is remembered of one's contact: of its depth where the two intersect.
    ///
    /// # Errors
    /// As of [`PairCaches::change`].
    fn change_contact(
        &mut self,
        place: u32,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> Result<()>,
    ) -> Result<()>;
}

/// Nobody else uses them.
pub(crate) struct Own<'a> {
    pub caches: &'a mut [Mutex<PairCache>],
    /// None for pairs that are forgotten.
    pub contacts: Option<&'a mut ContactMemory>,
    /// None as above.
    pub compounds: &'a [Mutex<GrowingCache>],
}

impl PairCaches for Own<'_> {
    #[inline(always)]
    fn prefetch(&self, place: u32) {
        prefetch(&self.caches[place as usize]);
    }

    #[inline(always)]
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()> {
        change(unlocked(&mut self.caches[place as usize]))
    }

    fn compounds(&self) -> &[Mutex<GrowingCache>] {
        self.compounds
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

/// The result of the first look.
#[derive(Debug, Clone, Copy)]
enum PairLook {
    Settled,
    /// Its result of before is listed again.
    Again,
    Intersects,
    Test,
}

/// For one block of pairs, those that the first look has not settled, in order; a byte tells which.
struct Left {
    pairs: [(u8, PairLook); BLOCK],
    count: usize,
}

impl Left {
    /// Written whether it counts or not, as what cannot be foretold is better no branch.
    #[inline(always)]
    fn add_if(&mut self, counts: bool, pair: usize, look: PairLook) {
        debug_assert!(pair < 256 && self.count < self.pairs.len());
        self.pairs[self.count] = (pair as u8, look);
        self.count += usize::from(counts);
    }

    #[inline(always)]
    fn get(&self, k: usize) -> Option<(usize, PairLook)> {
        self.pairs[..self.count].get(k).map(|&(pair, look)| (pair.into(), look))
    }
}

impl<'a> Pass<'a> {
    pub fn new(request: &'a Request, proxies: &'a Proxies, before: Option<&'a Before>) -> Pass<'a> {
        let (solver, is_verdict, tolerance) = (request.solver(), request.is_verdict(), request.tolerance);
        Pass { request, solver, of_share: request.of_share(), is_verdict, tolerance, proxies, before }
    }

    /// Looks at pairs in order and adds the listed ones to `findings`; true if it [stopped](Pass::stops) at the last listed.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn run_over<C: PairCaches + ?Sized>(
        &self,
        pairs: &mut [NearPair],
        marks: &mut [PairMark],
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        debug_assert_eq!(marks.len(), pairs.len());
        if pairs.len() <= FEW {
            return self.run_few(pairs, marks, caches, findings);
        }
        let mut left = Left { pairs: [(0, PairLook::Settled); BLOCK], count: 0 };
        for (pairs, marks) in pairs.chunks_mut(BLOCK).zip(marks.chunks_mut(BLOCK)) {
            self.look_at_all(pairs, marks, &mut left, &mut findings.statistics);
            findings.slots.make_room(left.count)?;
            let mut next = 0;
            while let Some((at, look)) = left.get(next) {
                if let Some((ahead, look)) = left.get(next + TEST_AHEAD) {
                    self.prefetch(look, &pairs[ahead], caches);
                }
                if self.follow(look, &mut pairs[at], &mut marks[at], caches, findings)? {
                    return Ok(true);
                }
                next += 1;
            }
        }
        Ok(false)
    }

    fn run_few<C: PairCaches + ?Sized>(
        &self,
        pairs: &mut [NearPair],
        marks: &mut [PairMark],
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        findings.slots.make_room(pairs.len())?;
        for (pair, mark) in pairs.iter_mut().zip(marks) {
            let look = self.look_again(pair, mark, &mut findings.statistics);
            if self.follow(look, pair, mark, caches, findings)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Carries out the result of a look; true if the query is to stop at this pair.
    #[inline(always)]
    fn follow<C: PairCaches + ?Sized>(
        &self,
        look: PairLook,
        pair: &mut NearPair,
        mark: &mut PairMark,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        match look {
            PairLook::Settled => Ok(false),
            PairLook::Again => self.list_again(mark, findings),
            PairLook::Intersects | PairLook::Test => {
                if self.proxies.bodies.has_compounds()
                    && let Some(compounds) = self.compounds(pair)
                {
                    return self.answer_compounds(compounds, pair, mark, caches, findings);
                }
                Ok(self.decide(look, pair, mark, caches, findings)? && self.list(pair, mark, caches, findings)?)
            }
        }
    }

    /// Looks at a block.
    #[inline(always)]
    fn look_at_all(
        &self,
        pairs: &[NearPair],
        marks: &mut [PairMark],
        left: &mut Left,
        statistics: &mut SceneStatistics,
    ) {
        left.count = 0;
        for k in 0..pairs.len().min(marks.len()) {
            if let (Some(pair), Some(mark)) = (pairs.get(k + LOOK_AHEAD), marks.get(k + LOOK_AHEAD))
                && !self.is_unmoved(pair, mark)
            {
                self.prefetch_rows(pair);
            }
            let look = self.look_again(&pairs[k], &mut marks[k], statistics);
            left.add_if(!matches!(look, PairLook::Settled), k, look);
        }
    }

    /// Looks at a pair, first at its result in the pass before.
    #[inline(always)]
    fn look_again(&self, pair: &NearPair, mark: &mut PairMark, statistics: &mut SceneStatistics) -> PairLook {
        if self.is_unmoved(pair, mark) {
            let is_listed = mark.is_listed();
            statistics.count_unmoved(u64::from(!is_listed), 0);
            return if is_listed { PairLook::Again } else { PairLook::Settled };
        }
        mark.is_answered = pair.testing == Testing::Active;
        let look = if mark.is_answered { self.look(pair, statistics) } else { PairLook::Settled };
        if let PairLook::Settled = look {
            mark.result = UNLISTED;
        }
        look
    }

    /// Whether neither piece has moved since the same query before.
    #[inline(always)]
    fn is_unmoved(&self, pair: &NearPair, mark: &PairMark) -> bool {
        self.before.is_some_and(|before| before.answers(pair, mark))
    }

    #[inline(always)]
    fn look(&self, pair: &NearPair, statistics: &mut SceneStatistics) -> PairLook {
        let [a, b] = pair.proxies.map(|proxy| proxy as usize);
        if self.tolerance == f64::INFINITY {
            return PairLook::Test;
        }
        let [spheres1, spheres2] = [self.proxies.known_spheres(a), self.proxies.known_spheres(b)];
        if are_far_apart(spheres1, spheres2, self.tolerance) {
            statistics.count_settled(Settled::BoundingSpheres);
            return PairLook::Settled;
        }
        let [motion1, motion2] = [&self.proxies.motions[a], &self.proxies.motions[b]];
        let travelled = motion1.odometer + motion2.odometer;
        // With s the odometers' sum when the pair was tested and s' now: from fl(s')(1 + 8u) + τ < (s(1 − 8u) + lower)(1 − 8u), all
        // rounded, s' + τ < s + lower follows, and so lower − (s' − s) > τ.
        if travelled * (1.0 + 8.0 * U) + self.tolerance < pair.apart_until {
            statistics.count_settled(Settled::OutOfReach);
            return PairLook::Settled;
        }
        if self.is_verdict && overlap_inside(spheres1, spheres2) { PairLook::Intersects } else { PairLook::Test }
    }

    /// Asks for the memory that a look needs.
    #[inline(always)]
    fn prefetch_rows(&self, pair: &NearPair) {
        for proxy in pair.proxies.map(|proxy| proxy as usize) {
            prefetch(self.proxies.known_spheres(proxy));
            prefetch(&self.proxies.motions[proxy]);
        }
    }

    /// Asks for the memory that a pair's new result needs.
    #[inline(always)]
    fn prefetch<C: PairCaches + ?Sized>(&self, look: PairLook, pair: &NearPair, caches: &C) {
        if let PairLook::Settled | PairLook::Again = look {
            return;
        }
        for proxy in pair.proxies.map(|proxy| proxy as usize) {
            prefetch(&self.proxies.labels[proxy]);
            if let PairLook::Test = look {
                prefetch(&self.proxies.poses[proxy]);
                prefetch(&self.proxies.shapes[proxy]);
            }
        }
        if let PairLook::Test = look {
            caches.prefetch(pair.cache);
        }
    }

    /// Lists a pair with its result of before; true if the query is to stop there.
    #[inline(always)]
    pub fn list_again(&self, mark: &mut PairMark, findings: &mut Findings) -> Result<bool> {
        let at = mark.result as usize;
        mark.result = findings.listed as u32;
        findings.list_again(at)?;
        findings.statistics.count_unmoved(1, mark.level);
        for more in 0..usize::from(mark.more) {
            findings.list_again(at + 1 + more)?;
            findings.statistics.count_unmoved(1, mark.level);
        }
        findings.intersecting |= mark.intersects;
        Ok(mark.intersects & self.request.early_exit)
    }

    /// Answers for a pair in the next free slot; whether the answer is listed.
    #[inline(always)]
    fn decide<C: PairCaches + ?Sized>(
        &self,
        look: PairLook,
        pair: &mut NearPair,
        mark: &mut PairMark,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        let answer = &mut findings.slots.next().answer;
        if let PairLook::Intersects = look {
            *answer = INSCRIBED;
        } else {
            *answer = PairAnswer::default();
            let chosen = findings.chosen;
            caches.change(pair.cache, |cache| self.test(pair, mark, cache, chosen, answer))?;
        }
        let is_listed = self.count_answer(pair, findings);
        if !is_listed {
            mark.result = UNLISTED;
        }
        Ok(is_listed)
    }

    /// Counts the answer of a pair that was written last; whether it is listed.
    #[inline(always)]
    fn count_answer(&self, pair: &NearPair, findings: &mut Findings) -> bool {
        let answer = &findings.slots.next().answer;
        findings.statistics.count(answer);
        is_listed(answer.outcome, self.is_verdict)
            && (self.request.piece_pairs == PiecePairs::Every || findings.choose(pair.cache))
    }

    /// Whether nothing more is asked, of the scene or of the two objects, behind a pair that was listed with this mark.
    #[inline(always)]
    fn stops(&self, mark: &PairMark) -> bool {
        match self.request.piece_pairs {
            PiecePairs::Every => mark.intersects & self.request.early_exit,
            PiecePairs::First => true,
            PiecePairs::Nearest => mark.intersects,
        }
    }

    /// Lists the pair whose answer was written last; true if the query is to stop there.
    #[inline(always)]
    fn list<C: PairCaches + ?Sized>(
        &self,
        pair: &NearPair,
        mark: &mut PairMark,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        let answer = &findings.slots.next().answer;
        (mark.intersects, mark.level) = (answer.outcome == Outcome::Intersecting, level_of(answer));
        if let Some(details) = &self.request.details {
            self.find_details(details, pair, mark, caches, findings)?;
        }
        sign(self.proxies, pair, findings.slots.next());
        mark.result = findings.listed as u32;
        findings.list_new()?;
        findings.intersecting |= mark.intersects;
        Ok(self.stops(mark))
    }

    /// Asks the pair layer.
    #[inline(always)]
    fn test(
        &self,
        pair: &mut NearPair,
        mark: &mut PairMark,
        cache: &mut PairCache,
        chosen: Option<ChosenPair>,
        answer: &mut PairAnswer,
    ) -> Result<()> {
        let [a, b] = pair.proxies.map(|proxy| proxy as usize);
        let placed = |i: usize| self.proxies.shapes[i].at(&self.proxies.poses[i]);
        // Nothing is left to refuse: shapes are sound once made, poses and tolerances have been checked.
        let config = match &self.of_share {
            Some(of_share) if pair.takes_share => of_share,
            _ => &self.request.config,
        };
        let nearer = chosen.map(|chosen| chosen.config(config));
        let config = nearer.as_ref().unwrap_or(config);
        let bodies = [placed(a), placed(b)];
        match self.proxies.bodies.ground_pair(pair.proxies) {
            None => (self.solver)(bodies, cache, config, answer)?,
            Some(ground) => ground.ask(self.request.of_ground(), bodies, config, answer)?,
        }
        pair.apart_until = self.apart_until(answer.lower, a, b);
        // Pairs that a budget left open may go on the next time.
        if answer.decided_by == DecidedBy::Budget {
            mark.is_answered = false;
        }
        Ok(())
    }

    /// Finds the details asked for beside the answer that was written last.
    #[inline(never)]
    fn find_details<C: PairCaches + ?Sized>(
        &self,
        details: &Details,
        pair: &NearPair,
        mark: &mut PairMark,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<()> {
        let Findings { slots, contacts, .. } = findings;
        if self.proxies.bodies.ground_pair(pair.proxies).is_some() {
            return contacts.push_none();
        }
        let answer = &slots.next().answer;
        let bodies =
            pair.proxies.map(|proxy| self.proxies.shapes[proxy as usize].at(&self.proxies.poses[proxy as usize]));
        caches.change_contact(pair.cache, mark.intersects, |reference, cache| {
            details.find(bodies, answer, reference, cache, contacts)
        })?;
        // As of distances.
        if contacts.last_ending() == Some(DepthEnding::Budget) {
            mark.is_answered = false;
        }
        Ok(())
    }

    /// A pair of which one is a compound, or both are.
    #[inline(never)]
    fn compounds(&self, pair: &NearPair) -> Option<CompoundPair<'_>> {
        let placed = |row: u32| self.proxies.shapes[row as usize].at(&self.proxies.poses[row as usize]);
        self.proxies.bodies.compound_pair(pair.proxies, pair.proxies.map(placed))
    }

    /// Asks the compound layer and lists its answer; true if the query is to stop there.
    #[inline(never)]
    fn answer_compounds<C: PairCaches + ?Sized>(
        &self,
        compounds: CompoundPair,
        pair: &mut NearPair,
        mark: &mut PairMark,
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        let mut spare = GrowingCache::default();
        let mut kept = caches.compounds().get(pair.cache as usize).map(locked);
        let cache = kept.as_deref_mut().unwrap_or(&mut spare);
        (mark.result, mark.intersects, mark.more) = (UNLISTED, false, 0);
        if let Some(details) = &self.request.details
            && compounds.ground().is_none()
        {
            return self.list_manifolds((details, compounds), pair, mark, cache, findings);
        }
        findings.slots.make_room(BLOCK + 1)?;
        let result = findings.slots.next();
        result.answer = PairAnswer::default();
        let (query, config) = (self.request.of_ground(), &self.request.config);
        let config = findings.chosen.map_or(*config, |chosen| chosen.config(config));
        let pieces = compounds.ask(query, cache, &config, &mut result.answer)?;
        let [a, b] = pair.proxies.map(|row| row as usize);
        pair.apart_until = self.apart_until(result.answer.lower, a, b);
        if !self.count_answer(pair, findings) {
            return Ok(false);
        }
        if self.request.details.is_some() {
            findings.contacts.push_none()?;
        }
        self.list_pieces(pair, pieces, mark, findings)
    }

    /// Lists the pairs of pieces of two compounds with the details asked for, as those of pieces that are rows.
    fn list_manifolds(
        &self,
        (details, compounds): (&Details, CompoundPair),
        pair: &mut NearPair,
        mark: &mut PairMark,
        cache: &mut GrowingCache,
        findings: &mut Findings,
    ) -> Result<bool> {
        let (near, mut lower) = compounds.near_pieces(self.tolerance)?;
        let (mut first, mut intersects, listed) = (UNLISTED, false, findings.listed);
        let mut kept = cache.take_contacts(near.len());
        for pieces in near {
            findings.slots.make_room(BLOCK + 1)?;
            let own = kept.of(pieces);
            let config = findings.chosen.map_or(self.request.config, |chosen| chosen.config(&self.request.config));
            let is_listed = compounds.with_pieces(pieces, |placed| {
                let answer = &mut findings.slots.next().answer;
                *answer = PairAnswer::default();
                (self.solver)(placed, &mut own.cache, &config, answer)?;
                lower = lower.min(answer.lower);
                if !self.count_answer(pair, findings) {
                    return Ok(false);
                }
                let Findings { slots, contacts, .. } = &mut *findings;
                let answer = &slots.next().answer;
                own.change(answer.outcome == Outcome::Intersecting, |reference, depth| {
                    details.find(placed, answer, reference, depth, contacts)
                })?;
                Ok(true)
            })?;
            if !is_listed {
                continue;
            }
            if findings.contacts.last_ending() == Some(DepthEnding::Budget) {
                mark.is_answered = false;
            }
            let stops = self.list_pieces(pair, compounds.named(pieces), mark, findings)?;
            (first, intersects) = (first.min(mark.result), intersects | mark.intersects);
            if stops {
                cache.keep_contacts(kept);
                return Ok(true);
            }
        }
        cache.keep_contacts(kept);
        let [a, b] = pair.proxies.map(|row| row as usize);
        pair.apart_until = self.apart_until(lower, a, b);
        (mark.result, mark.intersects) = (first, intersects);
        match u8::try_from((findings.listed - listed).saturating_sub(1)) {
            Ok(more) => mark.more = more,
            // More than a mark can hold: they are found anew.
            Err(_) => mark.is_answered = false,
        }
        Ok(false)
    }

    /// Lists the answer that was written last, of these pieces; true if the query is to stop there.
    fn list_pieces(
        &self,
        pair: &NearPair,
        pieces: NamedPieces,
        mark: &mut PairMark,
        findings: &mut Findings,
    ) -> Result<bool> {
        let result = findings.slots.next();
        (mark.intersects, mark.level) = (result.answer.outcome == Outcome::Intersecting, level_of(&result.answer));
        sign(self.proxies, pair, result);
        result.name_pieces(pieces);
        mark.result = findings.listed as u32;
        findings.list_new()?;
        findings.intersecting |= mark.intersects;
        Ok(self.stops(mark))
    }

    /// See [`NearPair::apart_until`] and [`Pass::look`].
    #[inline(always)]
    fn apart_until(&self, lower: f64, a: usize, b: usize) -> f64 {
        if !(lower > 0.0) {
            return f64::NEG_INFINITY;
        }
        let travelled = self.proxies.motions[a].odometer + self.proxies.motions[b].odometer;
        (travelled * (1.0 - 8.0 * U) + lower) * (1.0 - 8.0 * U)
    }
}

/// Whether a pair with this outcome is listed.
#[inline(always)]
pub(crate) fn is_listed(outcome: Outcome, is_verdict: bool) -> bool {
    match outcome {
        // A verdict leaves only curved bodies undecided, and these may intersect.
        Outcome::Intersecting | Outcome::Undecided => true,
        Outcome::Separated => !is_verdict,
        Outcome::Beyond | Outcome::None => false,
    }
}

/// Writes the objects, user data and pieces of a pair into its result.
#[inline(always)]
pub(crate) fn sign(proxies: &Proxies, pair: &NearPair, result: &mut PairResult) {
    let [label1, label2] = pair.proxies.map(|proxy| &proxies.labels[proxy as usize]);
    (result.object1, result.user_data1, result.piece1) = (label1.object, label1.user_data, label1.piece);
    (result.object2, result.user_data2, result.piece2) = (label2.object, label2.user_data, label2.piece);
}
