//! What a pass over pairs found: new results, and results of the pass before that are listed again.
//!
//! Where few pieces have moved most results are those of before, next to each other. They stay in their array, and move within it
//! by as many places as others have come or gone before them; the new ones are put between them at the end.

use crate::base::error::Result;
use crate::base::memory::{extend, push, reserve};
use crate::scene::near::near_pairs::{Mark, NearPair};
use crate::scene::search::contacts::Contacts;
use crate::scene::search::query::PairResult;
use crate::scene::search::statistics::SceneStatistics;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::testing::Testing;

/// Above this part of all pieces, one in so many, all pairs are answered anew: new results are then written where they belong, and
/// pairs of two that have not moved are few.
const MANY_MOVED: usize = 2;

/// What a pass found, when another has begun.
#[derive(Debug, Default)]
pub(crate) struct Before {
    /// Its results, with what is left of earlier ones behind, while a pass gives them again.
    results: Vec<PairResult>,
    pub contacts: Contacts,
    /// Which pieces have moved since.
    has_moved: Vec<bool>,
}

impl Before {
    /// Finds out which pieces have moved since a pass; whether they are so few that its answers are given again.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn find_moved(&mut self, proxies: &Proxies, pass: u64) -> Result<bool> {
        self.has_moved.clear();
        extend(&mut self.has_moved, proxies.motions.iter().map(|motion| motion.moved >= pass))?;
        let count = self.has_moved.iter().filter(|&&has_moved| has_moved).count();
        Ok(count * MANY_MOVED < self.has_moved.len())
    }

    /// Whether neither piece has moved since the pass before answered the pair.
    #[inline(always)]
    pub fn answers(&self, pair: &NearPair, mark: &Mark) -> bool {
        let [a, b] = pair.proxies.map(|proxy| self.has_moved[proxy as usize]);
        mark.is_answered & (pair.testing == Testing::Active) & !a & !b
    }
}

/// What came of a part of the pairs.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// New results, kept from pass to pass, with what is left of earlier ones behind.
    pub slots: Vec<PairResult>,
    pub written: usize,
    /// In their order all that is listed, new or not.
    runs: Vec<Run>,
    pub listed: usize,
    /// Of each result, where they are asked for.
    pub contacts: Contacts,
    pub statistics: SceneStatistics,
    pub intersecting: bool,
}

/// Results next to each other.
#[derive(Debug, Clone, Copy)]
struct Run {
    source: Source,
    first: usize,
    count: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Before,
    New,
}

impl Findings {
    /// For another pass. If it gives most results of before again these stay where they are, and new ones are written elsewhere
    /// until both are [joined](Findings::join).
    pub fn begin(&mut self, before: Option<&mut Before>) {
        if let Some(before) = before {
            std::mem::swap(&mut self.slots, &mut before.results);
            if self.contacts.are_there() {
                std::mem::swap(&mut self.contacts, &mut before.contacts);
            }
        }
        self.clear();
    }

    /// Nothing is found.
    pub fn clear(&mut self) {
        (self.written, self.listed) = (0, 0);
        self.runs.clear();
        self.contacts.clear();
        self.statistics = SceneStatistics::default();
        self.intersecting = false;
    }

    /// Those of the pass, in the scene's order.
    pub fn results(&self) -> &[PairResult] {
        &self.slots[..self.written]
    }

    /// Puts new results between those of before that are listed again. These move within their array, each once at most.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn join(&mut self, before: &mut Before) -> Result<()> {
        let joined = &mut before.results;
        make_room(joined, self.listed)?;
        // What goes to earlier places goes before anything is put behind it, what goes to later ones the other way round: then
        // nothing is overwritten that has still to go.
        let mut place = 0;
        for &Run { source, first, count } in &self.runs {
            if source == Source::Before && first > place {
                joined.copy_within(first..first + count, place);
            }
            place += count;
        }
        for &Run { source, first, count } in self.runs.iter().rev() {
            place -= count;
            match source {
                Source::New => joined[place..place + count].copy_from_slice(&self.slots[first..first + count]),
                Source::Before if first < place => joined.copy_within(first..first + count, place),
                Source::Before => {}
            }
        }
        std::mem::swap(&mut self.slots, joined);
        self.written = self.listed;
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
        self.written += 1;
        self.list(Source::New, self.written - 1)
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

    /// Adds those of another part behind, except the results, which go to its [room](Findings::rooms); gives how many are listed
    /// before them.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn append(&mut self, part: &Findings) -> Result<u32> {
        let (written, listed) = (self.written, self.listed);
        extend(&mut self.runs, part.runs.iter().map(|run| run.behind(written)))?;
        self.written += part.written;
        self.listed += part.listed;
        self.contacts.append_all(&part.contacts)?;
        self.intersecting |= part.intersecting;
        self.statistics.add(&part.statistics);
        Ok(listed as u32)
    }

    /// Where the results of all parts go that have been added, so many of each.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn rooms(&mut self, written: impl Iterator<Item = usize>) -> Result<impl Iterator<Item = &mut [PairResult]>> {
        make_room(&mut self.slots, self.written)?;
        let mut rest = &mut self.slots[..];
        Ok(written.map(move |count| {
            let (room, behind) = std::mem::take(&mut rest).split_at_mut(count);
            rest = behind;
            room
        }))
    }

    /// Sum of `upper − lower` over the results.
    pub fn error_spent(&self) -> f64 {
        self.results().iter().map(|result| result.answer.upper - result.answer.lower).sum()
    }
}

impl Run {
    /// The same when so many new results come before its own.
    fn behind(self, count: usize) -> Run {
        match self.source {
            Source::New => Run { first: self.first + count, ..self },
            Source::Before => self,
        }
    }
}

/// At least so many results, that what is written over has not to be made first.
pub(crate) fn make_room(slots: &mut Vec<PairResult>, count: usize) -> Result<()> {
    let missing = count.saturating_sub(slots.len());
    reserve(slots, missing)?;
    slots.resize(slots.len() + missing, PairResult::default());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::PairAnswer;
    use swiftprox::random::Random;

    fn result(number: u64) -> PairResult {
        PairResult { user_data1: number, answer: PairAnswer::default(), ..PairResult::default() }
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
                    make_room(&mut part.slots, part.written + 1).unwrap();
                    part.slots[part.written] = result(expected[expected.len() - 1]);
                    part.list_new().unwrap();
                }
                if place < old.len() && random.below(5) > go {
                    expected.push(old[place]);
                    part.list_again(place).unwrap();
                }
            }
            for part in &parts {
                findings.append(part).unwrap();
            }
            for (room, part) in findings.rooms(parts.iter().map(|part| part.written)).unwrap().zip(&parts) {
                room.copy_from_slice(part.results());
            }
            findings.join(&mut before).unwrap();
            assert_eq!(findings.results().iter().map(|result| result.user_data1).collect::<Vec<_>>(), expected);
        }
    }
}
