//! Rows that passes write one behind the other, and rows of the pass before that stay where they are.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::reserve;

/// Rows of the last pass, with what is left of earlier ones behind: what is written over has not to be made first.
#[derive(Debug)]
pub(crate) struct Slots<T> {
    rows: Vec<T>,
    count: usize,
}

/// Rows next to each other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Run {
    pub source: Source,
    pub first: usize,
    pub count: usize,
}

/// The source of rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    Before,
    New,
}

impl Run {
    pub fn rows(&self) -> Range<usize> {
        self.first..self.first + self.count
    }

    /// The same when so many new rows come before its own.
    pub fn behind(self, count: usize) -> Run {
        match self.source {
            Source::New => Run { first: self.first + count, ..self },
            Source::Before => self,
        }
    }
}

/// Rows one behind the other, this many each time.
pub(crate) fn split<T>(rows: &mut [T], counts: impl Iterator<Item = usize>) -> impl Iterator<Item = &mut [T]> {
    let mut rest = rows;
    counts.map(move |count| {
        let (first, behind) = std::mem::take(&mut rest).split_at_mut(count);
        rest = behind;
        first
    })
}

impl<T> Default for Slots<T> {
    fn default() -> Self {
        Slots { rows: Vec::new(), count: 0 }
    }
}

impl<T: Copy + Default> Slots<T> {
    pub fn clear(&mut self) {
        self.count = 0;
    }

    pub fn count(&self) -> usize {
        self.count
    }

    pub fn as_slice(&self) -> &[T] {
        &self.rows[..self.count]
    }

    pub fn as_mut_slice(&mut self) -> &mut [T] {
        &mut self.rows[..self.count]
    }

    /// Room for so many more.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    #[inline(always)]
    pub fn make_room(&mut self, more: usize) -> Result<()> {
        if self.count + more > self.rows.len() { self.grow(more) } else { Ok(()) }
    }

    #[inline(never)]
    fn grow(&mut self, more: usize) -> Result<()> {
        let missing = self.count + more - self.rows.len();
        reserve(&mut self.rows, missing)?;
        self.rows.resize(self.rows.len() + missing, T::default());
        Ok(())
    }

    /// The next slots, for so many rows.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    #[inline(always)]
    pub fn rows(&mut self, count: usize) -> Result<&mut [T]> {
        self.make_room(count)?;
        Ok(&mut self.rows[self.count..self.count + count])
    }

    /// The next slots have been written.
    #[inline(always)]
    pub fn take(&mut self, count: usize) {
        debug_assert!(self.count + count <= self.rows.len());
        self.count += count;
    }

    /// The slot in which the next row is written, for which there is room.
    #[inline(always)]
    pub fn next(&mut self) -> &mut T {
        &mut self.rows[self.count]
    }

    /// The next row has been written.
    #[inline(always)]
    pub fn advance(&mut self) {
        debug_assert!(self.count < self.rows.len());
        self.count += 1;
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn push(&mut self, row: T) -> Result<()> {
        self.push_with(|place| *place = row)
    }

    /// Adds a row, written where it stays.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn push_with(&mut self, write: impl FnOnce(&mut T)) -> Result<()> {
        self.make_room(1)?;
        let row = self.next();
        *row = T::default();
        write(row);
        self.advance();
        Ok(())
    }

    /// Room for the rows that each of several parts has written, this many rows a part, behind the existing ones.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn rooms(&mut self, counts: impl Iterator<Item = usize> + Clone) -> Result<impl Iterator<Item = &mut [T]>> {
        let (first, more) = (self.count, counts.clone().sum());
        self.make_room(more)?;
        self.count += more;
        Ok(split(&mut self.rows[first..], counts))
    }

    /// The row being written takes the place of the last one.
    pub fn replace_last(&mut self) {
        self.rows.swap(self.count - 1, self.count);
        self.count -= 1;
    }

    /// Only the first rows are left.
    pub fn truncate(&mut self, count: usize) {
        debug_assert!(count <= self.count);
        self.count = count;
    }

    /// Becomes the sequence of its own rows and of new ones that `runs` describe, in their order. Its own move within their
    /// array, each once at most.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn join(&mut self, new: &Slots<T>, runs: &[Run]) -> Result<()> {
        let count: usize = runs.iter().map(|run| run.count).sum();
        self.make_room(count.saturating_sub(self.count))?;
        let joined = &mut self.rows;
        // Rows that go to earlier places move before anything is put behind them, rows that go to later ones the other way round.
        // Thus no row that has still to move is overwritten.
        let mut place = 0;
        for run in runs {
            if run.source == Source::Before && run.first > place {
                joined.copy_within(run.rows(), place);
            }
            place += run.count;
        }
        for run in runs.iter().rev() {
            place -= run.count;
            match run.source {
                Source::New => joined[place..place + run.count].copy_from_slice(&new.rows[run.rows()]),
                Source::Before if run.first < place => joined.copy_within(run.rows(), place),
                Source::Before => {}
            }
        }
        self.count = count;
        Ok(())
    }

    /// Only the last of its rows is left, the first from then on.
    pub fn keep_last(&mut self, count: usize) {
        debug_assert!(count <= self.count);
        self.rows.copy_within(self.count - count..self.count, 0);
        self.count = count;
    }
}
