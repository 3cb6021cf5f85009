//! How deep listed pairs are in each other and where they meet: what a query of contacts says beside its answers, and what pairs
//! remember of it. Depths are remembered of pairs that intersect alone, in a pool.

use std::sync::Mutex;

use crate::base::error::{Result, check_range};
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{extend, push, reserve, with_capacity};
use crate::pair::{
    self, DepthCache, DepthConfig, DepthEnding, Known, Manifold, ManifoldConfig, ManifoldPoint, Outcome, PairAnswer,
    Placed, Reference, Sink, manifold_of,
};
use crate::scene::query::{Contact, ContactDetail, SceneContacts, SceneQuery};

/// What is asked of each listed pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Details {
    depth: DepthConfig,
    manifold: Option<ManifoldConfig>,
}

impl Details {
    /// What a query of contacts asks beside the answers.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument) for a margin that is out of range. The other members have been
    /// checked.
    pub fn new(query: &SceneQuery) -> Result<Option<Details>> {
        check_range("margin", query.margin, 0.0..=f64::INFINITY)?;
        let reduces = match query.detail {
            ContactDetail::None => return Ok(None),
            ContactDetail::Depth => None,
            ContactDetail::Manifold => Some(false),
            ContactDetail::ReducedManifold => Some(true),
        };
        let SceneQuery { absolute_error, relative_error, step_budget, .. } = *query;
        let depth = DepthConfig { absolute_error, relative_error, step_budget, ..DepthConfig::default() };
        let margin = query.margin.min(query.distance_tolerance).min(f64::MAX);
        let manifold = reduces.map(|reduces| ManifoldConfig { margin, reduces, ..ManifoldConfig::default() });
        Ok(Some(Details { depth, manifold }))
    }

    /// Finds what is asked of two bodies whose distance has been answered, `cache` being there where they intersect.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory) where there is none for the points.
    pub fn find(
        &self,
        bodies: [Placed; 2],
        answer: &PairAnswer,
        reference: &mut Reference,
        cache: Option<&mut DepthCache>,
        found: &mut Contacts,
    ) -> Result<()> {
        let mut contact = Contact { first_point: found.points.len(), ..Contact::default() };
        if let Some(cache) = cache {
            // Nothing is left to refuse: shapes are sound once made, poses and options have been checked.
            pair::depth(bodies, cache, &self.depth, &mut contact.depth)?;
        }
        if let Some(config) = &self.manifold {
            let is_deep = contact.depth.outcome == Outcome::Intersecting;
            let known = if is_deep { Known::Deep(&contact.depth) } else { Known::Apart(answer) };
            contact.manifold = found.points_of(bodies, known, reference, config)?;
        }
        push(&mut found.list, contact)
    }
}

// --- What is found ---------------------------------------------------------------------------------------------------------------

/// Contacts of results, in their order, and all their points.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    list: Vec<Contact>,
    points: Vec<ManifoldPoint>,
}

impl Contacts {
    pub fn clear(&mut self) {
        self.list.clear();
        self.points.clear();
    }

    pub fn view(&self) -> SceneContacts<'_> {
        SceneContacts { contacts: &self.list, points: &self.points }
    }

    fn points_of(
        &mut self,
        bodies: [Placed; 2],
        known: Known,
        reference: &mut Reference,
        config: &ManifoldConfig,
    ) -> Result<Manifold> {
        let mut written = Ok(());
        let mut write = |_: usize, point: &ManifoldPoint| {
            if written.is_ok() {
                written = push(&mut self.points, *point);
            }
        };
        let mut sink = Sink { capacity: usize::MAX, written: 0, write: &mut write };
        let manifold = manifold_of(bodies, known, reference, config, &mut sink);
        written.map(|()| manifold)
    }

    /// Adds one of those of before.
    pub fn again(&mut self, before: &Contacts, at: usize) -> Result<()> {
        self.append(&before.list[at..=at], &before.points)
    }

    /// Adds those of another part behind.
    pub fn append_all(&mut self, part: &Contacts) -> Result<()> {
        self.append(&part.list, &part.points)
    }

    /// Adds contacts, whose points are some of those given.
    fn append(&mut self, list: &[Contact], points: &[ManifoldPoint]) -> Result<()> {
        reserve(&mut self.list, list.len())?;
        for contact in list {
            let first_point = self.points.len();
            let own = &points[contact.first_point..][..contact.manifold.point_count as usize];
            extend(&mut self.points, own.iter().copied())?;
            self.list.push(Contact { first_point, ..*contact });
        }
        Ok(())
    }

    /// Of a query that stopped there is but the last.
    pub fn keep_last(&mut self) {
        let before = self.list.len().saturating_sub(1);
        self.list.drain(..before);
        if let Some(last) = self.list.first_mut() {
            self.points.drain(..last.first_point);
            last.first_point = 0;
        }
    }

    /// How the last depth ended.
    pub fn last_ending(&self) -> Option<DepthEnding> {
        self.list.last().map(|contact| contact.depth.ending)
    }
}

// --- What pairs remember ---------------------------------------------------------------------------------------------------------

/// Of each near pair, by its place among the caches. It is empty until contacts are asked for more than answers.
#[derive(Debug, Default)]
pub(crate) struct ContactMemory {
    pairs: Vec<Remembered>,
    /// Of pairs that intersected when they were last looked at, in no order.
    depths: Vec<Mutex<DepthCache>>,
    /// Depths without a pair; with room for all.
    free: Vec<u32>,
}

#[derive(Debug, Clone, Copy)]
struct Remembered {
    reference: Reference,
    /// Where its depth is, or [`NO_DEPTH`].
    depth: u32,
}

const NO_DEPTH: u32 = u32::MAX;

const NOTHING: Remembered = Remembered { reference: Reference::NONE, depth: NO_DEPTH };

impl ContactMemory {
    /// Room for so many pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn make_room(&mut self, pairs: usize) -> Result<()> {
        let missing = pairs.saturating_sub(self.pairs.len());
        reserve(&mut self.pairs, missing)?;
        self.pairs.resize(self.pairs.len() + missing, NOTHING);
        Ok(())
    }

    /// For reading: the reference, and the depth if there is one.
    pub fn peek(&self, place: u32) -> (Reference, Option<&Mutex<DepthCache>>) {
        let pair = self.pairs.get(place as usize).copied().unwrap_or(NOTHING);
        (pair.reference, self.depths.get(pair.depth as usize))
    }

    pub fn reference(&mut self, place: u32) -> &mut Reference {
        &mut self.pairs[place as usize].reference
    }

    /// The memory of a pair that intersects: its own, or what another has given back, emptied, or more.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn of_intersecting(&mut self, place: u32) -> Result<(&mut Reference, &mut DepthCache)> {
        let Remembered { reference, depth } = &mut self.pairs[place as usize];
        if *depth == NO_DEPTH {
            *depth = match self.free.pop() {
                Some(free) => free,
                None => {
                    reserve(&mut self.free, self.depths.len() + 1)?;
                    push(&mut self.depths, Mutex::default())?;
                    (self.depths.len() - 1) as u32
                }
            };
            *unlocked(&mut self.depths[*depth as usize]) = DepthCache::default();
        }
        Ok((reference, unlocked(&mut self.depths[*depth as usize])))
    }

    /// A pair is no more.
    pub fn forget(&mut self, place: u32) {
        if let Some(pair) = self.pairs.get_mut(place as usize) {
            let Remembered { depth, .. } = std::mem::replace(pair, NOTHING);
            if depth != NO_DEPTH {
                self.free.push(depth);
            }
        }
    }

    /// A pair intersects no more.
    pub fn forget_depth(&mut self, place: u32) {
        let depth = std::mem::replace(&mut self.pairs[place as usize].depth, NO_DEPTH);
        if depth != NO_DEPTH {
            self.free.push(depth);
        }
    }

    /// A copy without what is free, of pairs that are at these places now and will be at 0, 1, …
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn packed(&self, places: impl ExactSizeIterator<Item = u32>) -> Result<ContactMemory> {
        let mut packed = ContactMemory::default();
        if self.pairs.is_empty() {
            return Ok(packed);
        }
        packed.make_room(places.len())?;
        let [_, used] = self.depth_counts();
        (packed.depths, packed.free) = (with_capacity(used)?, with_capacity(used)?);
        for (new, old) in (0..).zip(places) {
            let (reference, depth) = self.peek(old);
            match depth {
                Some(depth) => {
                    let (own, cache) = packed.of_intersecting(new)?;
                    (*own, *cache) = (reference, *locked(depth));
                }
                None => *packed.reference(new) = reference,
            }
        }
        Ok(packed)
    }

    /// How many depths there is room for, and how many are in use.
    pub fn depth_counts(&self) -> [usize; 2] {
        [self.depths.len(), self.depths.len() - self.free.len()]
    }
}
