//! How deep listed pairs are in each other and where they meet: what a query of contacts says beside its answers.

use crate::base::error::{Result, check_range};
use crate::base::memory::{extend, push, reserve};
use crate::pair::{
    self, DepthCache, DepthConfig, DepthEnding, Fill, Known, Manifold, ManifoldConfig, ManifoldPoint, Outcome,
    PairAnswer, Placed, Reference, Sink, manifold_of,
};
use crate::scene::search::query::{Contact, ContactDetail, SceneContacts, SceneQuery};

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

    pub fn are_there(&self) -> bool {
        !self.list.is_empty()
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
        let mut write = |_: usize, fill: Fill| {
            if written.is_ok() {
                written = push(&mut self.points, ManifoldPoint::default());
            }
            if let (Ok(()), Some(point)) = (&written, self.points.last_mut()) {
                fill(point);
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
