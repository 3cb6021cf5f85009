//! Grounds among the objects of a scene. Each has a row as a piece has, so that all that finds, filters and orders pairs takes it
//! for one; the row's shape is a box around the ground. What answers a pair asks here first whether one of the two is a ground.

use std::sync::Arc;

use crate::answer::{Feature, FeatureKind};
use crate::base::error::Result;
use crate::base::memory::reserve_sparingly;
use crate::ground::{Ground, nearest_triangle};
use crate::pair::{PairAnswer, PairConfig, Placed, Query};

/// The grounds of a scene, by row.
#[derive(Debug, Default)]
pub(crate) struct GroundRows {
    /// Ascending; those of objects that are gone are not there.
    rows: Vec<(u32, Arc<Ground>)>,
}

impl GroundRows {
    /// Room for one more.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn reserve(&mut self) -> Result<()> {
        reserve_sparingly(&mut self.rows, 1)
    }

    /// Adds that of a row behind all others; there is room.
    pub fn push(&mut self, row: usize, ground: Arc<Ground>) {
        debug_assert!(
            self.rows.len() < self.rows.capacity() && self.rows.last().is_none_or(|(last, _)| *last < row as u32)
        );
        self.rows.push((row as u32, ground));
    }

    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    fn find(&self, row: usize) -> std::result::Result<usize, usize> {
        self.rows.binary_search_by_key(&(row as u32), |(known, _)| *known)
    }

    /// That of a row.
    pub fn get(&self, row: usize) -> Option<&Arc<Ground>> {
        self.find(row).ok().map(|place| &self.rows[place].1)
    }

    pub fn iter(&self) -> impl Iterator<Item = (usize, &Ground)> {
        self.rows.iter().map(|(row, ground)| (*row as usize, &**ground))
    }

    /// The object of the row is gone.
    pub fn remove(&mut self, row: usize) {
        if let Ok(place) = self.find(row) {
            self.rows.remove(place);
        }
    }

    /// Numbers the rows anew, in the same order: number k of old becomes `numbers[k]`.
    pub fn renumber(&mut self, numbers: &[u32]) {
        self.rows.iter_mut().for_each(|(row, _)| *row = numbers[*row as usize]);
    }

    /// The ground of a pair of rows, if one is a ground.
    #[inline(always)]
    pub fn of_pair(&self, rows: [u32; 2]) -> Option<GroundPair<'_>> {
        if self.rows.is_empty() { None } else { self.find_in_pair(rows) }
    }

    #[inline(never)]
    fn find_in_pair(&self, rows: [u32; 2]) -> Option<GroundPair<'_>> {
        let of = |side: usize| self.get(rows[side] as usize).map(|ground| GroundPair { ground, side });
        debug_assert!(of(0).is_none() || of(1).is_none(), "two grounds make no pair");
        of(0).or_else(|| of(1))
    }
}

/// A pair of which one is a ground.
#[derive(Debug, Clone, Copy)]
pub(crate) struct GroundPair<'a> {
    pub ground: &'a Ground,
    /// Which of the two it is.
    pub side: usize,
}

impl GroundPair<'_> {
    /// Answers a query; of the ground's body only the pose counts. The feature of the ground is the triangle, as a face.
    ///
    /// # Errors
    /// As of [`nearest_triangle`].
    pub fn ask(&self, query: Query, bodies: [Placed; 2], config: &PairConfig, answer: &mut PairAnswer) -> Result<()> {
        let GroundPair { ground, side } = *self;
        let found = nearest_triangle(query, bodies[1 - side], ground.at(bodies[side].pose), config)?;
        *answer = found.answer;
        if (found.triangle as usize) < ground.triangle_count() {
            answer.feature2 = face(found.triangle);
        }
        if side == 0 {
            *answer = answer.reversed();
        }
        Ok(())
    }
}

/// A triangle of a ground as a feature.
pub(crate) fn face(triangle: u32) -> Feature {
    Feature { kind: FeatureKind::Face, ids: [triangle, 0] }
}
