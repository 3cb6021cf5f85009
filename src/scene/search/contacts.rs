//! How deep listed pairs are in each other and where they meet: the details of a query of contacts beside its answers.

use crate::base::error::{Error, Result};
use crate::base::memory::with_capacity;
use crate::manifold::{Fill, Known, Manifold, ManifoldConfig, ManifoldPoint, Reference, Sink, manifold_of};
use crate::pair::{self, DepthCache, DepthConfig, DepthEnding, Outcome, PairAnswer, Placed, Query};
use crate::scene::search::query::{Contact, ContactDetail, SceneContacts, SceneQuery};
use crate::scene::search::slots::{Run, Slots, Source};

/// The details asked of each listed pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Details {
    depth: DepthConfig,
    manifold: Option<ManifoldConfig>,
}

impl Details {
    /// The details that a query of contacts asks beside the answers.
    ///
    /// # Errors
    /// [`Error::Argument`] for details that another query cannot give. The other members have been checked.
    pub fn new(kind: Query, query: &SceneQuery) -> Result<Option<Details>> {
        if kind != Query::Contact {
            return match query.detail {
                ContactDetail::None => Ok(None),
                _ => Err(Error::Argument(
                    "detail: only queries of contacts give depths and manifolds; ask swiftprox_scene_query_contact, or with \
                     SWIFTPROX_QUERY_KIND_CONTACT, or leave detail at SWIFTPROX_CONTACT_DETAIL_NONE"
                        .into(),
                )),
            };
        }
        let reduces = match query.detail {
            ContactDetail::None => return Ok(None),
            ContactDetail::Depth => None,
            ContactDetail::Manifold => Some(false),
            ContactDetail::ReducedManifold => Some(true),
        };
        let SceneQuery { absolute_error, relative_error, step_budget, .. } = *query;
        let depth = DepthConfig { absolute_error, relative_error, step_budget };
        let max_distance = query.max_distance.min(f64::MAX);
        let manifold = reduces.map(|reduces| ManifoldConfig { max_distance, reduces });
        Ok(Some(Details { depth, manifold }))
    }

    /// Finds the requested details of two bodies whose distance has been answered, `cache` being there where they intersect.
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
        let mut contact = Contact { first_point: found.points.count(), ..Contact::default() };
        if let Some(cache) = cache {
            // Nothing is left to refuse: shapes are sound once made, poses and options have been checked.
            pair::depth(bodies, cache, &self.depth, &mut contact.depth)?;
        }
        if let Some(config) = &self.manifold {
            let is_deep = matches!(contact.depth.outcome, Outcome::Intersecting | Outcome::Undecided);
            let known = if is_deep { Known::Deep(&contact.depth) } else { Known::Apart(answer) };
            contact.manifold = found.points_of(bodies, known, reference, config)?;
        }
        found.list.push(contact)
    }
}

/// Contacts of results, in their order, and all their points.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    list: Slots<Contact>,
    points: Slots<ManifoldPoint>,
}

impl Contacts {
    pub fn clear(&mut self) {
        self.list.clear();
        self.points.clear();
    }

    pub fn view(&self) -> SceneContacts<'_> {
        SceneContacts { contacts: self.list.as_slice(), points: self.points.as_slice() }
    }

    /// Adds one for a pair of which no details are found.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn push_none(&mut self) -> Result<()> {
        self.list.push(Contact { first_point: self.points.count(), ..Contact::default() })
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
                written = self.points.push_with(|point| fill(point));
            }
        };
        let mut sink = Sink { capacity: usize::MAX, written: 0, write: &mut write };
        let manifold = manifold_of(bodies, known, reference, config, &mut sink);
        written.map(|()| manifold)
    }

    /// Puts new contacts between these that are listed again, as their results are.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn join(&mut self, new: &Contacts, runs: &[Run]) -> Result<()> {
        let mut runs_of_points = with_capacity(runs.len())?;
        runs_of_points.extend(runs.iter().map(|run| match run.source {
            Source::Before => self.points_of_run(run),
            Source::New => new.points_of_run(run),
        }));
        self.list.join(&new.list, runs)?;
        self.points.join(&new.points, &runs_of_points)?;
        let (mut place, mut first_point) = (0, 0);
        for (run, points) in runs.iter().zip(&runs_of_points) {
            if points.first != first_point {
                for contact in &mut self.list.as_mut_slice()[place..place + run.count] {
                    contact.first_point = contact.first_point - points.first + first_point;
                }
            }
            (place, first_point) = (place + run.count, first_point + points.count);
        }
        Ok(())
    }

    /// The points of some contacts.
    fn points_of_run(&self, run: &Run) -> Run {
        let contacts = &self.list.as_slice()[run.rows()];
        let [first, .., last] = contacts else {
            let count = contacts.first().map_or(0, |only| only.manifold.point_count as usize);
            return Run { first: contacts.first().map_or(0, |only| only.first_point), count, ..*run };
        };
        let end = last.first_point + last.manifold.point_count as usize;
        Run { first: first.first_point, count: end - first.first_point, ..*run }
    }

    /// The room for the contacts and points of all parts that are still to be copied.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn rooms<'a>(
        &'a mut self,
        parts: impl Iterator<Item = &'a Contacts> + Clone,
    ) -> Result<impl Iterator<Item = ContactRoom<'a>>> {
        let lists = self.list.rooms(parts.clone().map(|part| part.list.count()))?;
        let mut first_point = self.points.count();
        let rooms = self.points.rooms(parts.map(|part| part.points.count()))?;
        Ok(lists.zip(rooms).map(move |(list, points)| {
            let room = ContactRoom { first_point, list, points };
            first_point += room.points.len();
            room
        }))
    }

    /// For a query that stopped, only the last one exists.
    pub fn keep_last(&mut self) {
        let Some(last) = self.list.as_slice().last() else { return };
        self.points.keep_last(last.manifold.point_count as usize);
        self.list.keep_last(1);
        self.list.as_mut_slice()[0].first_point = 0;
    }

    /// The last one goes, if there is any.
    pub fn remove_last(&mut self) {
        if let Some(last) = self.list.as_slice().last() {
            self.points.truncate(last.first_point);
            self.list.truncate(self.list.count() - 1);
        }
    }

    /// How the last depth ended.
    pub fn last_ending(&self) -> Option<DepthEnding> {
        self.list.as_slice().last().map(|contact| contact.depth.ending)
    }
}

/// Room for the contacts of a part among those of all.
pub(crate) struct ContactRoom<'a> {
    /// So many points come before.
    first_point: usize,
    list: &'a mut [Contact],
    points: &'a mut [ManifoldPoint],
}

impl ContactRoom<'_> {
    pub fn fill(&mut self, part: &Contacts) {
        self.points.copy_from_slice(part.points.as_slice());
        for (room, contact) in self.list.iter_mut().zip(part.list.as_slice()) {
            *room = Contact { first_point: self.first_point + contact.first_point, ..*contact };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    /// Contacts of before and new ones, some without points, in one part or two: each keeps its points, which stand without gaps.
    #[test]
    fn contacts_are_joined_with_their_points() {
        let mut random = Random::new(0xc0a7);
        let (mut before, mut numbers) = (Contacts::default(), 0..);
        let mut expected: Vec<Vec<f64>> = Vec::new();
        for _ in 0..if cfg!(miri) { 10 } else { 300 } {
            let (mut parts, mut runs, mut listed) =
                ([Contacts::default(), Contacts::default()], Vec::new(), Vec::new());
            let (split, go) = (random.below(30), random.below(4));
            let mut new = 0;
            for place in 0..=expected.len().max(20) {
                if random.below(3) == 0 && place < 25 {
                    let own: Vec<f64> = numbers.by_ref().take(random.below(4)).map(f64::from).collect();
                    add(&mut parts[usize::from(place > split)], &own);
                    listed.push(own);
                    runs.push(Run { source: Source::New, first: new, count: 1 });
                    new += 1;
                }
                if place < expected.len() && random.below(5) > go {
                    listed.push(expected[place].clone());
                    runs.push(Run { source: Source::Before, first: place, count: 1 });
                }
            }
            let mut found = Contacts::default();
            for (mut room, part) in found.rooms(parts.iter()).unwrap().zip(&parts) {
                room.fill(part);
            }
            before.join(&found, &runs).unwrap();
            expected = listed;
            let SceneContacts { contacts, points } = before.view();
            assert_eq!(points.len(), expected.iter().map(Vec::len).sum::<usize>());
            let mut first_point = 0;
            for (contact, own) in contacts.iter().zip(&expected) {
                assert_eq!((contact.first_point, contact.manifold.point_count as usize), (first_point, own.len()));
                let gaps = points[first_point..][..own.len()].iter().map(|point| point.gap_lower);
                assert!(gaps.eq(own.iter().copied()));
                first_point += own.len();
            }
            assert_eq!(contacts.len(), expected.len());
        }
    }

    fn add(contacts: &mut Contacts, gaps: &[f64]) {
        let manifold = Manifold { point_count: gaps.len() as u32, ..Manifold::default() };
        let first_point = contacts.points.count();
        contacts.list.push(Contact { first_point, manifold, ..Contact::default() }).unwrap();
        for &gap_lower in gaps {
            contacts.points.push(ManifoldPoint { gap_lower, ..ManifoldPoint::default() }).unwrap();
        }
    }
}
