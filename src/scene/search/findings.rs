//! The findings of a pass over pairs: new results, and results of the pass before that are listed again.
//!
//! If few pieces have moved, most results are those of the pass before, next to each other. They stay in their array, and move
//! within it by as many places as others have come or gone before them. The new ones are put between them at the end.

use crate::base::error::Result;
use crate::base::memory::{extend, push};
use crate::compound::MORE;
use crate::pair::{Outcome, PairAnswer, PairConfig};
use crate::scene::near::near_pairs::{NearPair, PairMark};
use crate::scene::search::contacts::{self, Contacts};
use crate::scene::search::query::PairResult;
use crate::scene::search::slots::{Run, Slots, Source};
use crate::scene::search::statistics::SceneStatistics;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::rows::RowMotion;
use crate::scene::world::testing::Testing;

/// Above this part of all pieces, one in this many, all pairs are answered anew: new results are then written where they belong,
/// and pairs of two that have not moved are few.
const MANY_MOVED: usize = 2;

/// So many pairs of which neither piece has moved take as long as one that is looked at, …
const UNMOVED_A_LOOK: usize = 16;

/// … and a look that finds contacts as long as so many others.
const LOOKS_A_CONTACT: usize = 8;

/// This many looks of a pass that repeats answers are worth sharing as much as one of a pass that gives none: to put new results
/// between those of before, and to find out what has moved, is left to the caller's thread.
const LOOKS_OF_AGAIN: usize = 4;

/// Whether so many pieces have moved since a pass that all pairs are answered anew.
#[inline(always)]
pub(crate) fn are_many_moved(motions: &[RowMotion], pass: u64) -> bool {
    is_many(motions.iter().map(|motion| usize::from(motion.moved >= pass)).sum(), motions.len())
}

fn is_many(moved: usize, count: usize) -> bool {
    moved * MANY_MOVED >= count
}

/// The findings of a pass, when another has begun.
#[derive(Debug, Default)]
pub(crate) struct Before {
    /// Its results, with what is left of earlier ones behind, while a pass gives them again.
    results: Slots<PairResult>,
    contacts: Contacts,
    /// Which pieces have moved since, …
    has_moved: Vec<bool>,
    /// … and how many.
    moved: usize,
}

impl Before {
    /// Finds out which pieces have moved since a pass; whether they are so few that its answers are given again.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn find_moved(&mut self, proxies: &Proxies, pass: u64) -> Result<bool> {
        self.has_moved.clear();
        extend(&mut self.has_moved, proxies.motions.iter().map(|motion| motion.moved >= pass))?;
        self.moved = self.has_moved.iter().filter(|&&has_moved| has_moved).count();
        Ok(!is_many(self.moved, self.has_moved.len()))
    }

    /// To share a pass over `pairs` that gives answers again is worth as much as to share one that looks at so many.
    pub fn looks(&self, pairs: usize, finds_contacts: bool) -> usize {
        let of_moved = pairs * 2 * self.moved / self.has_moved.len().max(1);
        let of_moved = if finds_contacts { of_moved * LOOKS_A_CONTACT } else { of_moved };
        (of_moved + pairs / UNMOVED_A_LOOK) / LOOKS_OF_AGAIN
    }

    /// Whether neither piece has moved since the pass before answered the pair.
    #[inline(always)]
    pub fn answers(&self, pair: &NearPair, mark: &PairMark) -> bool {
        let [a, b] = pair.proxies.map(|proxy| self.has_moved[proxy as usize]);
        mark.is_answered & (pair.testing == Testing::Active) & !a & !b
    }
}

/// Of two objects of which one pair is listed, that pair, as far as they have been asked.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ChosenPair {
    /// The place of its cache tells which it is.
    pub cache: u32,
    pub upper: f64,
    /// The least lower end of the pairs of these objects that could be listed.
    pub lower: f64,
    /// Whether one of them, of which one piece is curved, is neither apart nor meets for certain.
    may_meet: bool,
}

impl ChosenPair {
    /// What a pair is asked that is listed only if it is nearer.
    pub fn config(&self, config: &PairConfig) -> PairConfig {
        PairConfig { max_distance: config.max_distance.min(self.upper * MORE), ..*config }
    }
}

/// The findings of a part of the pairs.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// New results, …
    pub slots: Slots<PairResult>,
    /// … and of each its contact, where they are asked for.
    pub contacts: Contacts,
    /// In their order all that is listed, new or not.
    runs: Vec<Run>,
    pub listed: usize,
    pub statistics: SceneStatistics,
    pub intersecting: bool,
    /// Where one pair of every two objects is listed, that of those being asked.
    pub chosen: Option<ChosenPair>,
}

impl Findings {
    /// For another pass. If it gives most results of before again these stay where they are, and new ones are written elsewhere
    /// until both are [joined](Findings::join).
    pub fn begin(&mut self, before: Option<&mut Before>) {
        if let Some(before) = before {
            std::mem::swap(&mut self.slots, &mut before.results);
            std::mem::swap(&mut self.contacts, &mut before.contacts);
        }
        self.clear();
    }

    /// For another pass that answers so many pairs anew, as the last one did, and finds no contacts: a row for each.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    #[inline(always)]
    pub fn begin_rows(&mut self, count: usize) -> Result<&mut [PairResult]> {
        debug_assert!(self.contacts.view().contacts.is_empty());
        self.slots.clear();
        self.slots.rows(count)
    }

    /// The first of the rows are the results.
    #[inline(always)]
    pub fn end_rows(&mut self, listed: usize, intersecting: bool) {
        self.slots.take(listed);
        (self.listed, self.intersecting) = (listed, intersecting);
    }

    /// Nothing is found.
    pub fn clear(&mut self) {
        self.slots.clear();
        self.listed = 0;
        self.runs.clear();
        self.contacts.clear();
        self.statistics = SceneStatistics::default();
        self.intersecting = false;
        self.chosen = None;
    }

    /// Those of the pass, in the scene's order.
    pub fn results(&self) -> &[PairResult] {
        self.slots.as_slice()
    }

    /// Puts new results between those of before that are listed again, and so their contacts, if these are asked for.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn join(&mut self, before: &mut Before, has_contacts: bool) -> Result<()> {
        before.results.join(&self.slots, &self.runs)?;
        if has_contacts {
            before.contacts.join(&self.contacts, &self.runs)?;
        }
        std::mem::swap(&mut self.slots, &mut before.results);
        std::mem::swap(&mut self.contacts, &mut before.contacts);
        Ok(())
    }

    /// One of before is listed next.
    #[inline(always)]
    pub fn list_again(&mut self, at: usize) -> Result<()> {
        self.list(Source::Before, at)
    }

    /// The new one that has just been written is listed next.
    #[inline(always)]
    pub fn list_new(&mut self) -> Result<()> {
        self.slots.advance();
        self.list(Source::New, self.slots.count() - 1)
    }

    /// Whether the answer that has just been written, that of the pair with this cache, is to be listed: it is the first of its two
    /// objects, or nearer than the one listed so far, which then goes.
    pub fn choose(&mut self, cache: u32) -> bool {
        let PairAnswer { outcome, lower, upper, .. } = self.slots.next().answer;
        let may_meet = outcome == Outcome::Undecided;
        let Some(chosen) = &mut self.chosen else {
            self.chosen = Some(ChosenPair { cache, upper, lower, may_meet });
            return true;
        };
        chosen.lower = chosen.lower.min(lower);
        chosen.may_meet |= may_meet;
        if !(upper < chosen.upper || outcome == Outcome::Intersecting) {
            return false;
        }
        (chosen.cache, chosen.upper) = (cache, upper);
        self.slots.replace_last();
        self.contacts.remove_last();
        self.listed -= 1;
        if let Some(run) = self.runs.last_mut() {
            debug_assert!(run.source == Source::New);
            run.count -= 1;
        }
        true
    }

    /// Ends the choice among the pairs of two objects: the answer of the listed one, if there is one, then holds for both objects.
    pub fn end_choice(&mut self) -> Option<ChosenPair> {
        let chosen = self.chosen.take()?;
        let answer = &mut self.slots.as_mut_slice().last_mut()?.answer;
        answer.lower = chosen.lower;
        // The listed pieces may be apart where others, with a greater upper end, may meet.
        if chosen.may_meet && answer.outcome != Outcome::Intersecting {
            answer.outcome = Outcome::Undecided;
        }
        Some(chosen)
    }

    #[inline(always)]
    fn list(&mut self, source: Source, at: usize) -> Result<()> {
        self.listed += 1;
        match self.runs.last_mut() {
            Some(run) if run.source == source && run.first + run.count == at => {
                run.count += 1;
                Ok(())
            }
            _ => push(&mut self.runs, Run { source, first: at, count: 1 }),
        }
    }

    /// Adds those of another part behind, before whose own `written` are new; results and contacts are still to be copied to their
    /// [rooms](Findings::rooms). Gives how many are listed before them.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn append(&mut self, part: &Findings, written: usize) -> Result<u32> {
        let listed = self.listed;
        extend(&mut self.runs, part.runs.iter().map(|run| run.behind(written)))?;
        self.listed += part.listed;
        self.intersecting |= part.intersecting;
        self.statistics.add(&part.statistics);
        Ok(listed as u32)
    }

    /// The room for the results and contacts of all parts that have been added.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn rooms<'a>(
        &'a mut self,
        parts: impl Iterator<Item = &'a Findings> + Clone,
    ) -> Result<impl Iterator<Item = FindingRoom<'a>>> {
        let results = self.slots.rooms(parts.clone().map(|part| part.slots.count()))?;
        let contacts = self.contacts.rooms(parts.map(|part| &part.contacts))?;
        Ok(results.zip(contacts).map(|(results, contacts)| FindingRoom { results, contacts }))
    }

    /// Sum of `upper − lower` over the results.
    pub fn error_spent(&self) -> f64 {
        self.results().iter().map(|result| result.answer.upper - result.answer.lower).sum()
    }
}

/// Room for the findings of a part among those of all.
pub(crate) struct FindingRoom<'a> {
    results: &'a mut [PairResult],
    contacts: contacts::ContactRoom<'a>,
}

impl FindingRoom<'_> {
    pub fn fill(&mut self, part: &Findings) {
        self.results.copy_from_slice(part.results());
        self.contacts.fill(&part.contacts);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::PairAnswer;
    use swiftprox::random::Random;

    fn result(number: u64) -> PairResult {
        PairResult { user_data1: number, answer: PairAnswer::default(), ..PairResult::default() }
    }

    /// The answers to pairs of two objects that are listed, and what is said of both objects in the end.
    fn choose(answers: &[(Outcome, f64, f64)]) -> (usize, PairAnswer) {
        let mut findings = Findings::default();
        for (cache, &(outcome, lower, upper)) in (0..).zip(answers) {
            findings.slots.make_room(1).unwrap();
            *findings.slots.next() =
                PairResult { answer: PairAnswer { outcome, lower, upper, ..PairAnswer::default() }, ..result(0) };
            if findings.choose(cache) {
                findings.list_new().unwrap();
            }
        }
        let chosen = findings.end_choice().unwrap();
        assert_eq!((findings.listed, findings.results().len()), (1, 1));
        (chosen.cache as usize, findings.results()[0].answer)
    }

    /// Outcome, lower, upper.
    type BriefAnswer = (Outcome, f64, f64);

    /// The interval of the nearest pair holds the distance of both objects, and they are apart only if all their pairs are.
    #[test]
    fn the_nearest_answers_for_both_objects() {
        use Outcome::{Intersecting, Separated, Undecided};
        let cases: [(&[BriefAnswer], usize, BriefAnswer); 7] = [
            (&[(Separated, 0.9, 1.0), (Separated, 0.85, 1.05)], 0, (Separated, 0.85, 1.0)),
            (&[(Separated, 0.85, 1.05), (Separated, 0.9, 1.0)], 1, (Separated, 0.85, 1.0)),
            (&[(Separated, 1e-3, 1e-3), (Undecided, 0.0, 5.6e-3)], 0, (Undecided, 0.0, 1e-3)),
            (&[(Undecided, 0.0, 5.6e-3), (Separated, 1e-3, 1e-3)], 1, (Undecided, 0.0, 1e-3)),
            (&[(Separated, 1e-2, 1e-2), (Undecided, 0.0, 5.6e-3)], 1, (Undecided, 0.0, 5.6e-3)),
            (&[(Undecided, 0.0, 5.6e-3), (Intersecting, 0.0, 0.0)], 1, (Intersecting, 0.0, 0.0)),
            (&[(Separated, 0.5, 0.5), (Separated, 0.5, 0.5)], 0, (Separated, 0.5, 0.5)),
        ];
        for (answers, place, expected) in cases {
            let (chosen, PairAnswer { outcome, lower, upper, .. }) = choose(answers);
            assert_eq!((chosen, (outcome, lower, upper)), (place, expected), "{answers:?}");
        }
    }

    /// Some results of before go and new ones come, few or many, in one part or two: all stand in their order.
    #[test]
    fn results_of_before_and_new_ones_are_joined() {
        let mut random = Random::new(0x301e);
        let (mut findings, mut before, mut numbers) = (Findings::default(), Before::default(), 0..);
        let mut expected: Vec<u64> = Vec::new();
        for _ in 0..if cfg!(miri) { 10 } else { 500 } {
            findings.begin(Some(&mut before));
            let mut parts = [Findings::default(), Findings::default()];
            let (old, split) = (std::mem::take(&mut expected), random.below(40));
            let [come, go] = [random.below(4), random.below(4)];
            for place in 0..=old.len().max(20) {
                let part = &mut parts[usize::from(place > split)];
                for _ in 0..if place < 25 { random.below(3) * random.below(come + 1) } else { 0 } {
                    expected.extend(numbers.next());
                    part.slots.make_room(1).unwrap();
                    *part.slots.next() = result(expected[expected.len() - 1]);
                    part.list_new().unwrap();
                }
                if place < old.len() && random.below(5) > go {
                    expected.push(old[place]);
                    part.list_again(place).unwrap();
                }
            }
            let mut written = 0;
            for part in &parts {
                findings.append(part, written).unwrap();
                written += part.slots.count();
            }
            for (mut room, part) in findings.rooms(parts.iter()).unwrap().zip(&parts) {
                room.fill(part);
            }
            findings.join(&mut before, false).unwrap();
            assert_eq!(findings.results().iter().map(|result| result.user_data1).collect::<Vec<_>>(), expected);
        }
    }
}
