//! How a query runs: over the near pairs, or where everything is near over all pairs.

use std::ops::Range;
use std::sync::{Arc, Mutex};

use super::filters::testing;
use super::{Asked, Scene};
use crate::base::error::{Result, check_range};
use crate::base::locks::{locked, unlocked};
use crate::base::memory::{collected, with_capacity};
use crate::base::simd::environment::with_default;
use crate::pair::{self, PairCache, PairConfig, Query};
use crate::scene::broad_phase::near_pairs::{NearPair, NearPairs, Testing, order};
use crate::scene::contacts::Details;
use crate::scene::findings::{Before, Findings};
use crate::scene::narrow_phase::{BLOCK, Own, Pass};
use crate::scene::object::ObjectId;
use crate::scene::parts::run_in_parts;
use crate::scene::proxies::Proxies;
use crate::scene::query::{SceneAnswer, SceneQuery};
use crate::scene::recording::format::Subject;
use crate::scene::rows::Label;
use crate::shape::Shape;

/// Without a tolerance all pairs are near: so many are kept with what they remember, beyond that none is.
const MOST_KEPT: usize = 1 << 14;

impl Scene {
    /// Answers a query for each pair and lists those that it asks for.
    ///
    /// # Errors
    /// See [`Scene::query_intersection`]; nothing is listed then, and nothing is counted.
    pub(super) fn run(&mut self, query: &SceneQuery, kind: Query) -> Result<SceneAnswer<'_>> {
        self.answer(&Subject::AllPairs, kind, query, |scene| scene.find(query, kind))
    }

    /// What a search found that says whether it stopped at an intersecting pair, the last result.
    ///
    /// # Errors
    /// Those of the search; nothing is listed then, and nothing is counted.
    pub(super) fn answer(
        &mut self,
        subject: &Subject<ObjectId, &Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
        search: impl FnOnce(&mut Scene) -> Result<bool>,
    ) -> Result<SceneAnswer<'_>> {
        let counted = self.statistics;
        self.note_question(subject, kind, query);
        let stopped = with_default(|| search(self));
        match stopped {
            Ok(false) => {}
            Ok(true) => self.findings.contacts.keep_last(),
            Err(_) => {
                self.findings.clear();
                self.statistics = counted;
            }
        }
        self.note_answer(stopped.as_ref().ok().copied());
        let stopped = stopped?;
        self.statistics.queries += 1;
        if kind != Query::Intersection {
            self.statistics.error_spent += self.findings.error_spent();
        }
        Ok(self.said(stopped))
    }

    /// True if the query stopped at an intersecting pair, the last result.
    pub(super) fn find(&mut self, query: &SceneQuery, kind: Query) -> Result<bool> {
        let asked = Asked::new(query, kind)?;
        if kind != Query::Approximate || query.error_budget == f64::INFINITY {
            return self.ask(asked, query.early_exit);
        }
        // Who shares the budget is found out first: the listed pairs, whatever else is near.
        let counted = self.statistics;
        let verdicts = PairConfig { absolute_error: f64::INFINITY, ..asked.config };
        if self.ask(Asked { config: verdicts, ..asked }, query.early_exit)? {
            return Ok(true);
        }
        self.statistics = counted;
        let share = query.error_budget / self.findings.results().len().max(1) as f64;
        let config = PairConfig { absolute_error: share, relative_error: 0.0, ..asked.config };
        self.ask(Asked { config, ..asked }, query.early_exit)
    }

    /// One pass over the pairs.
    fn ask(&mut self, asked: Asked, early_exit: bool) -> Result<bool> {
        let is_repeated = self.begin_pass() == Some(asked);
        let tolerance = asked.tolerance();
        let keeps_list = self.keeps_list(tolerance);
        if keeps_list {
            self.update_near_pairs(tolerance)?;
        }
        let near = &mut self.broad_phase.near;
        let gives_again = is_repeated
            && keeps_list
            && near.last_pass + 1 == self.passes
            && self.before.find_moved(&self.proxies, self.passes)?;
        if gives_again {
            self.findings.set_apart(&mut self.before);
        }
        let pass = asked.pass(&self.proxies, early_exit, gives_again.then_some(&self.before));
        if asked.details.is_some() {
            near.contacts.make_room(near.caches.len())?;
        }
        let stopped = if keeps_list {
            if self.workers.share(near.pairs.len()) && !early_exit {
                run_in_parts(&self.workers, &mut self.parts, &pass, near, &mut self.findings)?;
                false
            } else {
                let NearPairs { pairs, caches, contacts, .. } = near;
                pass.run(pairs, &mut Own { caches, contacts: Some(contacts) }, &mut self.findings)?
            }
        } else {
            let (objects, activation, filter) = (&self.objects, &self.activation, &mut self.filter);
            let rows = collected(self.proxies.of_objects())?;
            ask_all(&pass, &rows, near, |labels| testing(objects, activation, filter, labels), &mut self.findings)?
        };
        if gives_again {
            self.findings.join(&mut self.before)?;
        }
        self.statistics.add(&self.findings.statistics);
        if !stopped {
            if keeps_list {
                near.last_pass = self.passes;
            }
            if asked.details.is_some() && keeps_list {
                near.forget_depths();
            }
            self.last = Some(asked);
        }
        Ok(stopped)
    }

    /// Makes the last results those of before; what was asked for them if they are all there.
    pub(super) fn begin_pass(&mut self) -> Option<Asked> {
        self.findings.begin(&mut self.before);
        self.passes += 1;
        self.last.take()
    }

    /// Whether all that a query with this tolerance may list is kept in a list.
    pub(super) fn keeps_list(&self, tolerance: f64) -> bool {
        tolerance < f64::INFINITY || self.is_small() || self.given.is_some()
    }

    /// Whether all pairs may be kept.
    pub(super) fn is_small(&self) -> bool {
        let count = self.proxies.len() - self.proxies.gone;
        count * count.saturating_sub(1) / 2 <= MOST_KEPT
    }
}

impl Asked {
    /// What a query asks of each pair, its budget aside.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error::Argument) for a member that is out of range.
    pub(super) fn new(query: &SceneQuery, kind: Query) -> Result<Asked> {
        check_range("distance_tolerance", query.distance_tolerance, 0.0..=f64::INFINITY)?;
        pair::check_accuracy(query.absolute_error, query.relative_error, query.step_budget)?;
        check_range("error_budget", query.error_budget, 0.0..=f64::INFINITY)?;
        let config = PairConfig {
            distance_tolerance: if kind == Query::Intersection { f64::INFINITY } else { query.distance_tolerance },
            absolute_error: query.absolute_error,
            relative_error: query.relative_error,
            step_budget: query.step_budget,
            levels: query.levels,
            refinement: query.refinement,
            start: query.start,
            ..PairConfig::default()
        };
        let details = if kind == Query::Contact { Details::new(query)? } else { None };
        Ok(Asked { config, query: kind, details })
    }

    /// Pairs farther apart are not listed.
    pub(super) fn tolerance(&self) -> f64 {
        if self.query == Query::Intersection { 0.0 } else { self.config.distance_tolerance }
    }

    /// One pass over pairs; see [`Pass::before`].
    pub(super) fn pass<'a>(&'a self, proxies: &'a Proxies, early_exit: bool, before: Option<&'a Before>) -> Pass<'a> {
        let solver = match self.query {
            Query::Intersection => pair::intersection,
            Query::Distance => pair::distance,
            // The depth says the rest.
            Query::Contact if self.details.is_some() => pair::distance,
            Query::Contact => pair::contact,
            Query::Approximate => pair::approximate,
        };
        let verdict_only = self.query == Query::Intersection;
        let (config, tolerance) = (&self.config, self.tolerance());
        Pass { proxies, solver, config, verdict_only, tolerance, early_exit, before, details: self.details.as_ref() }
    }
}

/// One pass over all pairs there are, a block at a time; `objects` are the rows of each in order of creation. What near pairs
/// remember is used and kept, for others nothing is.
fn ask_all(
    pass: &Pass,
    objects: &[Range<usize>],
    near: &mut NearPairs,
    mut testing: impl FnMut([&Label; 2]) -> Testing,
    findings: &mut Findings,
) -> Result<bool> {
    let proxies = pass.proxies;
    let mut block = Block { pairs: with_capacity(BLOCK)?, caches: with_capacity(BLOCK)?, kept: with_capacity(BLOCK)? };
    // Both go through the pairs in the same order.
    let mut next = 0;
    for (k, object1) in objects.iter().enumerate() {
        for object2 in &objects[k + 1..] {
            for a in object1.clone() {
                for b in object2.clone() {
                    if !proxies.may_meet(a, b) || testing([&proxies.labels[a], &proxies.labels[b]]) != Testing::Active {
                        continue;
                    }
                    let pair = [a as u32, b as u32];
                    let place = order(&proxies.firsts, pair);
                    let is_before = |known: &NearPair| order(&proxies.firsts, known.proxies) < place;
                    while near.pairs.get(next).is_some_and(is_before) {
                        next += 1;
                    }
                    let known = near.pairs.get(next).filter(|known| known.proxies == pair).map(|_| next);
                    block.add(NearPair::new(pair), known.map(|known| near.pairs[known].cache), near);
                    if block.pairs.len() == BLOCK && block.run(pass, near, findings)? {
                        return Ok(true);
                    }
                }
            }
        }
    }
    block.run(pass, near, findings)
}

/// Pairs to be looked at together.
struct Block {
    pairs: Vec<NearPair>,
    caches: Vec<Mutex<PairCache>>,
    /// Those that near pairs have.
    kept: Vec<Option<u32>>,
}

impl Block {
    fn add(&mut self, pair: NearPair, kept: Option<u32>, near: &NearPairs) {
        self.pairs.push(NearPair { cache: self.caches.len() as u32, ..pair });
        let known = kept.map(|kept| *locked(&near.caches[kept as usize]));
        self.caches.push(Mutex::new(known.unwrap_or_default()));
        self.kept.push(kept);
    }

    fn run(&mut self, pass: &Pass, near: &mut NearPairs, findings: &mut Findings) -> Result<bool> {
        let stopped = pass.run(&mut self.pairs, &mut Own { caches: &mut self.caches, contacts: None }, findings)?;
        for (kept, cache) in self.kept.iter().zip(&mut self.caches) {
            if let Some(kept) = kept {
                *unlocked(&mut near.caches[*kept as usize]) = *unlocked(cache);
            }
        }
        self.pairs.clear();
        self.caches.clear();
        self.kept.clear();
        Ok(stopped)
    }
}
