//! The caller's own numbers of pieces. Few programs give any: objects that have none take no room.

use std::collections::HashMap;

use crate::base::error::Result;
use crate::base::memory::{copied, filled, lacking};
use crate::scene::world::object::ObjectId;

/// A number for each piece of the objects that were given any; those of all others are 0.
#[derive(Debug, Default)]
pub(crate) struct PieceData {
    of_objects: HashMap<ObjectId, Vec<u64>>,
}

impl PieceData {
    /// Those of an object; none where none was set.
    pub fn of(&self, id: ObjectId) -> &[u64] {
        self.of_objects.get(&id).map_or(&[], Vec::as_slice)
    }

    pub fn get(&self, id: ObjectId, piece: usize) -> u64 {
        self.of(id).get(piece).copied().unwrap_or(0)
    }

    /// Sets the number of a piece of an object that has so many.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn set(&mut self, id: ObjectId, [piece, count]: [usize; 2], user_data: u64) -> Result<()> {
        debug_assert!(piece < count);
        if let Some(numbers) = self.of_objects.get_mut(&id) {
            numbers[piece] = user_data;
        } else if user_data != 0 {
            let mut numbers = filled(0, count)?;
            numbers[piece] = user_data;
            self.reserve()?;
            self.of_objects.insert(id, numbers);
        }
        Ok(())
    }

    /// A copy of those of an object, and room for it.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn copy_of(&mut self, id: ObjectId) -> Result<Option<Vec<u64>>> {
        let numbers = self.of_objects.get(&id).map(|numbers| copied(numbers)).transpose()?;
        self.reserve()?;
        Ok(numbers)
    }

    /// Gives an object the result of [`PieceData::copy_of`].
    pub fn put(&mut self, id: ObjectId, numbers: Option<Vec<u64>>) {
        if let Some(numbers) = numbers {
            self.of_objects.insert(id, numbers);
        }
    }

    /// The object is no more.
    pub fn forget(&mut self, id: ObjectId) {
        self.of_objects.remove(&id);
    }

    fn reserve(&mut self) -> Result<()> {
        let count = self.of_objects.len() + 1;
        self.of_objects.try_reserve(1).map_err(|e| lacking::<(ObjectId, Vec<u64>)>(count, &e))
    }
}
