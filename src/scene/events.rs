//! Which pairs of objects began or ended being near since the last time anybody asked.

use std::cmp::Ordering;

use super::Scene;
use crate::base::error::Result;
use crate::base::memory::{extend, push};
use crate::pair::Query;
use crate::scene::object::ObjectId;
use crate::scene::query::{PairResult, SceneQuery};
use crate::scene::recording::format::Subject;

/// A pair of objects, the earlier created first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C)]
pub struct ObjectPair {
    /// The earlier created object.
    pub object1: ObjectId,
    /// The later created object.
    pub object2: ObjectId,
    /// The caller's own number of object 1.
    pub user_data1: u64,
    /// The caller's own number of object 2.
    pub user_data2: u64,
}

/// What has changed, in order of creation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneEvents<'a> {
    /// Pairs that are near and were not. Owned by the scene until its next query about events.
    pub began: &'a [ObjectPair],
    /// Pairs that were near and are not, those of removed objects and of deactivated pairs among them. Owned as `began` are.
    pub ended: &'a [ObjectPair],
}

/// Where objects stand in the order of creation, for ever.
type Serials = [u64; 2];

/// What the last query about events found.
#[derive(Debug, Default)]
pub(crate) struct Events {
    near: Vec<(Serials, ObjectPair)>,
    /// The list of before, until it is compared.
    before: Vec<(Serials, ObjectPair)>,
    began: Vec<ObjectPair>,
    ended: Vec<ObjectPair>,
}

impl Scene {
    /// Which pairs of objects began or ended touching (`distance` 0), or being within a distance, since the last call; the first
    /// call lists all that are. Objects are near if any of their pieces are. It is a query like others, and [`SceneAnswer::pairs`]
    /// of those before it end.
    ///
    /// [`SceneAnswer::pairs`]: crate::scene::SceneAnswer::pairs
    ///
    /// # Errors
    /// As [`Scene::query_intersection`], for a distance that is negative or NaN; what was near stays remembered.
    pub fn query_events(&mut self, distance: f64) -> Result<SceneEvents<'_>> {
        let query = SceneQuery { distance_tolerance: distance, ..SceneQuery::default() };
        let kind = if distance == 0.0 { Query::Intersection } else { Query::Distance };
        self.answer(&Subject::Events, kind, &query, |scene| scene.find(&query, kind))?;
        let mut now = std::mem::take(&mut self.events.before);
        now.clear();
        let listed = self.list_objects(&mut now);
        self.events.before = now;
        listed?;
        self.events.compare()?;
        Ok(SceneEvents { began: &self.events.began, ended: &self.events.ended })
    }

    /// The pairs of objects of the last results, each once.
    fn list_objects(&self, now: &mut Vec<(Serials, ObjectPair)>) -> Result<()> {
        for result in self.findings.results() {
            let &PairResult { object1, object2, user_data1, user_data2, .. } = result;
            let pair = ObjectPair { object1, object2, user_data1, user_data2 };
            if now.last().is_none_or(|(_, last)| *last != pair) {
                let serials = [self.objects.get(object1)?.serial(), self.objects.get(object2)?.serial()];
                push(now, (serials, pair))?;
            }
        }
        Ok(())
    }
}

impl Events {
    /// Compares what is near, in `before`, with what was, and puts it in its place. Both are in order.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); what was near stays.
    fn compare(&mut self) -> Result<()> {
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
