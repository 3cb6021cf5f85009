//! Rows that are no convex piece, but a ground or a compound. The row's shape is a box around it.

use std::sync::Arc;

use crate::base::error::Result;
use crate::base::memory::reserve_sparingly;
use crate::compound::Compound;
use crate::ground::Ground;
use crate::pair::Placed;
use crate::scene::world::compounds::{CompoundPair, CompoundSide};
use crate::scene::world::grounds::GroundPair;

/// A body that is no convex piece.
#[derive(Debug, Clone)]
pub(crate) enum RowBody {
    Ground(Arc<Ground>),
    Compound(Arc<Compound>),
}

/// Those of a scene, by row.
#[derive(Debug, Default)]
pub(crate) struct RowBodies {
    /// Ascending; those of objects that are gone are not there.
    rows: Vec<(u32, RowBody)>,
    /// How many of them are compounds.
    compounds: usize,
}

impl RowBodies {
    /// Room for one more.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn reserve(&mut self) -> Result<()> {
        reserve_sparingly(&mut self.rows, 1)
    }

    /// Adds that of a row behind all others; there is room.
    pub fn push(&mut self, row: usize, body: RowBody) {
        debug_assert!(
            self.rows.len() < self.rows.capacity() && self.rows.last().is_none_or(|(last, _)| *last < row as u32)
        );
        self.compounds += usize::from(matches!(body, RowBody::Compound(_)));
        self.rows.push((row as u32, body));
    }

    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    #[inline(always)]
    pub fn has_compounds(&self) -> bool {
        self.compounds > 0
    }

    fn find(&self, row: usize) -> std::result::Result<usize, usize> {
        // Where all rows are bodies, the place is the row.
        match self.rows.get(row) {
            Some((known, _)) if *known == row as u32 => Ok(row),
            _ => self.rows.binary_search_by_key(&(row as u32), |(known, _)| *known),
        }
    }

    /// That of a row.
    pub fn get(&self, row: usize) -> Option<&RowBody> {
        self.find(row).ok().map(|place| &self.rows[place].1)
    }

    /// The ground of a row.
    pub fn ground(&self, row: usize) -> Option<&Arc<Ground>> {
        match self.get(row) {
            Some(RowBody::Ground(ground)) => Some(ground),
            _ => None,
        }
    }

    /// The compound of a row.
    pub fn compound(&self, row: usize) -> Option<&Arc<Compound>> {
        if self.compounds == 0 {
            return None;
        }
        match self.get(row) {
            Some(RowBody::Compound(compound)) => Some(compound),
            _ => None,
        }
    }

    pub fn grounds(&self) -> impl Iterator<Item = (usize, &Ground)> {
        self.rows.iter().filter_map(|(row, body)| match body {
            RowBody::Ground(ground) => Some((*row as usize, &**ground)),
            RowBody::Compound(_) => None,
        })
    }

    /// The object of the row is gone.
    pub fn remove(&mut self, row: usize) {
        if let Ok(place) = self.find(row) {
            let (_, body) = self.rows.remove(place);
            self.compounds -= usize::from(matches!(body, RowBody::Compound(_)));
        }
    }

    /// Numbers the rows anew, in the same order: number k of old becomes `numbers[k]`.
    pub fn renumber(&mut self, numbers: &[u32]) {
        self.rows.iter_mut().for_each(|(row, _)| *row = numbers[*row as usize]);
    }

    /// The ground of a pair of rows, if one is a ground and none a compound.
    #[inline(always)]
    pub fn ground_pair(&self, rows: [u32; 2]) -> Option<GroundPair<'_>> {
        if self.rows.is_empty() { None } else { self.find_ground(rows) }
    }

    #[inline(never)]
    fn find_ground(&self, rows: [u32; 2]) -> Option<GroundPair<'_>> {
        let of = |side: usize| self.ground(rows[side] as usize).map(|ground| GroundPair { ground, side });
        debug_assert!(of(0).is_none() || of(1).is_none(), "two grounds make no pair");
        of(0).or_else(|| of(1))
    }

    /// A pair of rows of which one is a compound, or both are.
    #[inline(always)]
    pub fn compound_pair<'a>(&'a self, rows: [u32; 2], bodies: [Placed<'a>; 2]) -> Option<CompoundPair<'a>> {
        if self.compounds == 0 { None } else { self.find_compounds(rows, bodies) }
    }

    #[inline(never)]
    fn find_compounds<'a>(&'a self, rows: [u32; 2], bodies: [Placed<'a>; 2]) -> Option<CompoundPair<'a>> {
        let side = |k: usize| match self.get(rows[k] as usize) {
            None => CompoundSide::Shape(bodies[k].shape),
            Some(RowBody::Ground(ground)) => CompoundSide::Ground(ground),
            Some(RowBody::Compound(compound)) => CompoundSide::Compound(compound),
        };
        let sides = [side(0), side(1)];
        let is_compound = |side: &CompoundSide| matches!(side, CompoundSide::Compound(_));
        sides.iter().any(is_compound).then(|| CompoundPair { sides, poses: bodies.map(|body| body.pose) })
    }
}
