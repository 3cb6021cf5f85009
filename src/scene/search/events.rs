//! Which pairs of objects began or ended being near since the last time anybody asked.

use std::cmp::Ordering;

use crate::base::error::Result;
use crate::base::memory::{extend, push};
use crate::scene::search::query::{ObjectPair, PairResult, SceneEvents};
use crate::scene::world::object::ObjectTable;

/// The objects' permanent positions in the order of creation.
type Serials = [u64; 2];

/// The findings of the last query about events.
#[derive(Debug, Default)]
pub(crate) struct Events {
    near: Vec<(Serials, ObjectPair)>,
    /// The list of before, until it is compared.
    before: Vec<(Serials, ObjectPair)>,
    began: Vec<ObjectPair>,
    ended: Vec<ObjectPair>,
}

impl Events {
    /// The changes since the last call, now that these pairs of pieces are near.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the near pairs stay.
    pub fn compare(&mut self, results: &[PairResult], objects: &ObjectTable) -> Result<SceneEvents<'_>> {
        self.list_objects(results, objects)?;
        self.compare_lists()?;
        Ok(SceneEvents { began: &self.began, ended: &self.ended })
    }

    /// The pairs of objects, each once, in `before`.
    fn list_objects(&mut self, results: &[PairResult], objects: &ObjectTable) -> Result<()> {
        self.before.clear();
        for result in results {
            let &PairResult { object1, object2, user_data1, user_data2, .. } = result;
            let pair = ObjectPair { object1, object2, user_data1, user_data2 };
            if self.before.last().is_none_or(|(_, last)| *last != pair) {
                let serials = [objects.get(object1)?.serial(), objects.get(object2)?.serial()];
                push(&mut self.before, (serials, pair))?;
            }
        }
        Ok(())
    }

    /// Compares the near pairs, in `before`, with the earlier ones, and puts them in their place. Both are in order.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the near pairs stay.
    fn compare_lists(&mut self) -> Result<()> {
        let Events { near: was, before: is, began, ended } = self;
        began.clear();
        ended.clear();
        let (mut old, mut new) = (was.iter().peekable(), is.iter().peekable());
        while let (Some(&&(was, gone)), Some(&&(is, come))) = (old.peek(), new.peek()) {
            match was.cmp(&is) {
                Ordering::Less => push(ended, gone)?,
                Ordering::Equal => {}
                Ordering::Greater => push(began, come)?,
            }
            if was <= is {
                old.next();
            }
            if is <= was {
                new.next();
            }
        }
        extend(ended, old.map(|(_, pair)| *pair))?;
        extend(began, new.map(|(_, pair)| *pair))?;
        std::mem::swap(was, is);
        Ok(())
    }
}
