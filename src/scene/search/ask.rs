//! A query from top to bottom: what is asked is checked, the near pairs are brought up to date and gone through, and what they
//! answer is listed.

use std::sync::{Arc, Mutex};

use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::collected;
use crate::base::simd::environment::with_default;
use crate::base::workers::Workers;
use crate::pair::Query;
use crate::scene::near::broad_phase::BroadPhase;
use crate::scene::near::near_pairs::{NearPair, NearPairs};
use crate::scene::search::all_pairs::run_over_all;
use crate::scene::search::events::Events;
use crate::scene::search::findings::{Before, Findings};
use crate::scene::search::gathering::{all_pairs_of, near_pairs_of, pairs_of_last};
use crate::scene::search::narrow_phase::{Own, Pass};
use crate::scene::search::parts::{PartFindings, run_in_parts};
use crate::scene::search::query::{SceneAnswer, SceneContacts, SceneEvents, SceneQuery, Subject};
use crate::scene::search::request::Request;
use crate::scene::search::statistics::SceneStatistics;
use crate::scene::world::content::World;
use crate::scene::world::object::{ObjectId, ObjectTable};
use crate::scene::world::proxies::NewProxy;
use crate::scene::world::rows::Label;
use crate::shape::Shape;

/// What is searched, and who shares in that.
pub(crate) struct Ground<'a> {
    pub world: &'a mut World,
    pub near: &'a mut BroadPhase,
    pub workers: &'a Workers,
}

/// What queries have found.
#[derive(Debug, Default)]
pub(crate) struct Search {
    /// What the last pass asked of all pairs, if it came to its end.
    last: Option<Request>,
    findings: Findings,
    /// The results of the pass before, or what is left of them.
    before: Before,
    /// The last query stopped at its last result.
    stopped: bool,
    /// What each part of a pass found.
    parts: Vec<PartFindings>,
    events: Events,
    pub statistics: SceneStatistics,
}

impl Search {
    /// Answers a query for each pair that it is about, and lists those that it asks for.
    ///
    /// # Errors
    /// See [`Scene::query_intersection`](crate::scene::Scene::query_intersection); nothing is listed then, and nothing is counted.
    pub fn ask(
        &mut self,
        ground: &mut Ground,
        subject: &Subject<ObjectId, &Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<SceneAnswer<'_>> {
        let counted = self.statistics;
        let found = with_default(|| match *subject {
            Subject::AllPairs | Subject::Events => self.ask_all(ground, &Request::new(kind, query)?),
            Subject::Object(id) => self.ask_object(ground, id, &Request::new(kind, query)?),
            Subject::Placed(shape, pose) => {
                pose.check(ground.world.rotation_limit)?;
                self.ask_placed(ground, shape, &pose, &Request::new(kind, query)?)
            }
        });
        match found {
            Ok(stopped) => self.stopped = stopped,
            Err(error) => {
                self.forget();
                self.statistics = counted;
                return Err(error);
            }
        }
        if self.stopped {
            self.findings.contacts.keep_last();
        }
        self.statistics.queries += 1;
        if kind != Query::Intersection {
            self.statistics.error_spent += self.findings.error_spent();
        }
        Ok(self.answer())
    }

    /// What the last query found.
    pub fn answer(&self) -> SceneAnswer<'_> {
        let (results, intersecting) = (self.findings.results(), self.findings.intersecting);
        let (pairs, found) = if self.stopped { (&[][..], results.last()) } else { (results, None) };
        SceneAnswer { intersecting, pairs, found, contacts: self.contacts() }
    }

    /// What it found beside its answers.
    pub fn contacts(&self) -> SceneContacts<'_> {
        self.findings.contacts.view()
    }

    /// What has changed among the pairs of objects that the last query found.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); what was near stays remembered.
    pub fn compare(&mut self, objects: &ObjectTable) -> Result<SceneEvents<'_>> {
        self.events.compare(self.findings.results(), objects)
    }

    /// No answer of before is given again.
    pub fn forget(&mut self) {
        self.findings.clear();
        self.last = None;
    }

    /// Gives back all room.
    pub fn shrink(&mut self) {
        let (events, statistics) = (std::mem::take(&mut self.events), self.statistics);
        *self = Search { events, statistics, ..Search::default() };
    }

    // --- All pairs ---------------------------------------------------------------------------------------------------------------

    /// True if the query stopped at an intersecting pair, the last result.
    fn ask_all(&mut self, ground: &mut Ground, request: &Request) -> Result<bool> {
        let Some(budget) = request.error_budget else { return self.pass_over_all(ground, request) };
        // Who shares the budget is found out first: the listed pairs, whatever else is near.
        let counted = self.statistics;
        let verdicts = request.with_error(f64::INFINITY, request.config.relative_error);
        if self.pass_over_all(ground, &verdicts)? {
            return Ok(true);
        }
        self.statistics = counted;
        let share = budget / self.findings.results().len().max(1) as f64;
        self.pass_over_all(ground, &request.with_error(share, 0.0))
    }

    /// One pass over the list, or where everything is near over all pairs.
    fn pass_over_all(&mut self, ground: &mut Ground, request: &Request) -> Result<bool> {
        let last = self.begin_pass(ground.world);
        let stopped = if ground.world.keeps_list(request.tolerance) {
            ground.near.update(ground.world, request.tolerance, ground.workers)?;
            self.pass_over_list(ground, request, last.is_some_and(|last| last.is_same(request)))?
        } else {
            let (proxies, mut rules, _) = ground.world.parts();
            let pass = Pass::new(request, proxies, None);
            run_over_all(&pass, &mut rules, &mut ground.near.list, &mut self.findings)?
        };
        self.statistics.add(&self.findings.statistics);
        if !stopped {
            self.last = Some(*request);
        }
        Ok(stopped)
    }

    /// The same over the list; `is_repeated`: the pass before asked the same.
    fn pass_over_list(&mut self, ground: &mut Ground, request: &Request, is_repeated: bool) -> Result<bool> {
        let (proxies, pass_number) = (&ground.world.proxies, ground.world.passes);
        let list = &mut ground.near.list;
        let gives_again =
            is_repeated && list.last_pass + 1 == pass_number && self.before.find_moved(proxies, pass_number)?;
        if gives_again {
            self.findings.set_apart(&mut self.before);
        }
        if request.details.is_some() {
            list.contacts.make_room(list.caches.len())?;
        }
        let pass = Pass::new(request, proxies, gives_again.then_some(&self.before));
        let stopped = if ground.workers.share(list.pairs.len()) && !request.early_exit {
            run_in_parts(ground.workers, &mut self.parts, &pass, list, &mut self.findings)?;
            false
        } else {
            let NearPairs { pairs, caches, contacts, .. } = list;
            pass.run(pairs, &mut Own { caches, contacts: Some(contacts) }, &mut self.findings)?
        };
        if gives_again {
            self.findings.join(&mut self.before)?;
        }
        if !stopped {
            list.last_pass = pass_number;
            if request.details.is_some() {
                list.forget_depths();
            }
        }
        Ok(stopped)
    }

    /// Makes the last results those of before; what was asked for them if they are all there.
    fn begin_pass(&mut self, world: &mut World) -> Option<Request> {
        self.findings.begin(&mut self.before);
        world.passes += 1;
        self.last.take()
    }

    // --- Pairs of one body -------------------------------------------------------------------------------------------------------

    fn ask_object(&mut self, ground: &mut Ground, id: ObjectId, request: &Request) -> Result<bool> {
        self.begin_pass(ground.world);
        if !ground.world.keeps_list(request.tolerance) {
            let mut pairs = all_pairs_of(ground.world, id)?;
            return self.pass_without_memory(ground.world, &mut pairs, request);
        }
        ground.near.update(ground.world, request.tolerance, ground.workers)?;
        let NearPairs { caches, contacts, .. } = &mut ground.near.list;
        contacts.make_room(if request.details.is_some() { caches.len() } else { 0 })?;
        let mut pairs = near_pairs_of(ground.world, &ground.near.list, id)?;
        let NearPairs { caches, contacts, .. } = &mut ground.near.list;
        let pass = Pass::new(request, &ground.world.proxies, None);
        let stopped = pass.run(&mut pairs, &mut Own { caches, contacts: Some(contacts) }, &mut self.findings)?;
        self.statistics.add(&self.findings.statistics);
        Ok(stopped)
    }

    fn ask_placed(&mut self, ground: &mut Ground, shape: &Arc<Shape>, pose: &Pose, request: &Request) -> Result<bool> {
        self.begin_pass(ground.world);
        // Boxes are good for their tolerance where the scene itself finds the pairs.
        let by_boxes = ground.world.given.is_none() && ground.world.keeps_list(request.tolerance);
        if by_boxes {
            ground.near.update(ground.world, request.tolerance, ground.workers)?;
        }
        ground.world.proxies.reserve(1)?;
        let label = Label { object: ObjectId::NULL, user_data: 0, piece: 0, fixed: false, groups: 0, mask: 0 };
        let own = ground.world.proxies.push_unseen(NewProxy { shape: shape.clone(), pose: *pose, label });
        if by_boxes {
            ground.world.proxies.refit(own, ground.near.tolerance());
        }
        let pairs = pairs_of_last(ground.world, by_boxes);
        let stopped = pairs.and_then(|mut pairs| self.pass_without_memory(ground.world, &mut pairs, request));
        ground.world.proxies.pop_unseen();
        stopped
    }

    /// Over pairs that remember nothing.
    fn pass_without_memory(&mut self, world: &World, pairs: &mut [NearPair], request: &Request) -> Result<bool> {
        let mut caches = collected(pairs.iter().map(|_| Mutex::default()))?;
        let pass = Pass::new(request, &world.proxies, None);
        let stopped = pass.run(pairs, &mut Own { caches: &mut caches, contacts: None }, &mut self.findings)?;
        self.statistics.add(&self.findings.statistics);
        Ok(stopped)
    }
}
