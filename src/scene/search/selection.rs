//! Which pairs of two objects are listed: every one, or one of them.
//!
//! Where one is listed, all pairs of two objects are asked in one go, or their result of before is given again. It is, if none of
//! their pieces that meet has moved, none of their pairs has come, and the listed one has not gone.

use crate::base::error::Result;
use crate::base::memory::with_capacity;
use crate::scene::near::near_pairs::{NearPair, OUTDONE, PairMark};
use crate::scene::search::findings::Findings;
use crate::scene::search::narrow_phase::{PairCaches, Pass};
use crate::scene::search::query::PiecePairs;
use crate::scene::world::testing::Testing;

impl Pass<'_> {
    /// Looks at pairs in order and adds the listed ones to `findings`; true if it stopped at an intersecting one, the last listed.
    /// Where one pair of two objects is listed, `pairs` holds all of these objects.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn run<C: PairCaches + ?Sized>(
        &self,
        pairs: &mut [NearPair],
        marks: &mut [PairMark],
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        if self.request.piece_pairs == PiecePairs::Every {
            return self.run_over(pairs, marks, caches, findings);
        }
        let mut anew = *self;
        anew.before = None;
        let mut rest = marks;
        for pairs in pairs.chunk_by_mut(|one, other| self.are_of_same_objects(one, other)) {
            let (marks, behind) = std::mem::take(&mut rest).split_at_mut(pairs.len());
            rest = behind;
            let stopped = if self.are_unmoved(pairs, marks) {
                self.list_objects_again(marks, findings)?
            } else {
                anew.ask_objects(pairs, marks, caches, findings)?
            };
            if stopped {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Asks the pairs of two objects, without a pass before; true if the query is to stop there.
    fn ask_objects<C: PairCaches + ?Sized>(
        &self,
        pairs: &mut [NearPair],
        marks: &mut [PairMark],
        caches: &mut C,
        findings: &mut Findings,
    ) -> Result<bool> {
        // Those behind the last one that is asked stay answered as long as it is listed.
        for (pair, mark) in pairs.iter().zip(&mut *marks) {
            *mark = PairMark { is_answered: pair.testing == Testing::Active, ..PairMark::NONE };
        }
        debug_assert!(self.before.is_none());
        self.run_over(pairs, marks, caches, findings)?;
        let Some(chosen) = findings.end_choice() else { return Ok(false) };
        let mut intersects = false;
        // A budget then leaves open depths alone, and what is not listed has none.
        let has_details = self.request.details.is_some();
        for (pair, mark) in pairs.iter().zip(marks) {
            if pair.cache == chosen.cache {
                intersects = mark.intersects;
            } else {
                let is_answered = mark.is_answered || has_details && pair.testing == Testing::Active;
                *mark = PairMark { result: OUTDONE, is_answered, ..PairMark::NONE };
            }
        }
        Ok(intersects & self.request.early_exit)
    }

    /// Whether the pass before answers for all pairs of two objects together.
    fn are_unmoved(&self, pairs: &[NearPair], marks: &[PairMark]) -> bool {
        let Some(before) = self.before else { return false };
        let is_still_inactive = |pair: &NearPair, mark: &PairMark| {
            (pair.testing != Testing::Active) & !mark.is_answered & !mark.is_listed()
        };
        let has = |found: fn(&PairMark) -> bool| marks.iter().any(|mark| mark.is_answered && found(mark));
        pairs.iter().zip(marks).all(|(pair, mark)| before.answers(pair, mark) || is_still_inactive(pair, mark))
            && (has(PairMark::is_listed) || !has(|mark| mark.result == OUTDONE))
    }

    /// Lists the result of two objects again, if they have one; true if the query is to stop there.
    fn list_objects_again(&self, marks: &mut [PairMark], findings: &mut Findings) -> Result<bool> {
        let mut stopped = false;
        for mark in marks.iter_mut().filter(|mark| mark.is_answered) {
            if mark.is_listed() {
                stopped = self.list_again(mark, findings)?;
            } else {
                findings.statistics.count_unmoved(1, 0);
            }
        }
        Ok(stopped)
    }

    /// The sizes of parts of about `size` pairs, each of which may be [run](Pass::run) by itself.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn part_sizes(&self, pairs: &[NearPair], size: usize) -> Result<Vec<usize>> {
        debug_assert!(size > 0);
        let mut sizes = with_capacity(pairs.len().div_ceil(size))?;
        let mut rest = pairs;
        while !rest.is_empty() {
            let mut end = size.min(rest.len());
            while end < rest.len() && !self.may_part(&rest[end - 1], &rest[end]) {
                end += 1;
            }
            sizes.push(end);
            rest = &rest[end..];
        }
        Ok(sizes)
    }

    /// Whether two pairs, one behind the other, may be in different parts.
    pub fn may_part(&self, one: &NearPair, next: &NearPair) -> bool {
        self.request.piece_pairs == PiecePairs::Every || !self.are_of_same_objects(one, next)
    }

    fn are_of_same_objects(&self, one: &NearPair, other: &NearPair) -> bool {
        let objects = |pair: &NearPair| pair.proxies.map(|proxy| self.proxies.firsts[proxy as usize]);
        objects(one) == objects(other)
    }
}
