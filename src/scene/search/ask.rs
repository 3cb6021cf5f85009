//! A query from top to bottom: the request is checked, the near pairs are brought up to date and gone through, and their answers
//! are listed.

use std::sync::{Arc, Mutex};

use crate::base::error::{Error, Result};
use crate::base::memory::{collected, filled};
use crate::base::simd::environment::{is_default, with_default};
use crate::base::workers::Workers;
use crate::pair::Query;
use crate::scene::near::broad_phase::BroadPhase;
use crate::scene::near::near_pairs::{KINDS_OF_PASSES, NearPair, NearPairs, PairMark};
use crate::scene::search::all_pairs::run_over_all;
use crate::scene::search::events::Events;
use crate::scene::search::findings::{Before, Findings};
use crate::scene::search::gathering::{all_pairs_of, near_pairs_of, pairs_of_last};
use crate::scene::search::narrow_phase::{Own, Pass};
use crate::scene::search::parts::PartFindings;
use crate::scene::search::query::{PlacedBody, SceneAnswer, SceneEvents, SceneQuery, Subject};
use crate::scene::search::request::Request;
use crate::scene::search::shares::{Need, deal};
use crate::scene::search::statistics::SceneStatistics;
use crate::scene::world::content::World;
use crate::scene::world::object::{ObjectId, ObjectTable};
use crate::scene::world::proxies::NewProxy;
use crate::scene::world::rows::Label;
use crate::shape::Shape;

/// The scene that is searched, and the workers that share in that.
pub(crate) struct Searched<'a> {
    pub world: &'a mut World,
    pub near: &'a mut BroadPhase,
    pub workers: &'a Workers,
}

/// The findings of queries, separately for each kind: its answers stay good while queries of other kinds are made.
#[derive(Debug, Default)]
pub(crate) struct Search {
    pub(super) kept: [Kept; KINDS],
    /// The kind of the last query.
    pub(super) latest: usize,
    /// It stopped at its last result.
    pub(super) stopped: bool,
    /// The results that a pass gives again, or what is left of them.
    before: Before,
    /// The findings of each part of a pass.
    parts: Vec<PartFindings>,
    /// The needs of pairs for an error budget.
    needs: Vec<Need>,
    events: Events,
    pub statistics: SceneStatistics,
}

/// The findings of the last query of a kind.
#[derive(Debug, Default)]
pub(super) struct Kept {
    pub findings: Findings,
    /// The number of its pass over all near pairs, if that came to its end, …
    pub pass: Option<u64>,
    /// … and its request.
    pub asked: Option<Request>,
}

/// The kinds over all pairs, whose numbers are those of their marks in the list, and one for what is asked of one body.
const KINDS: usize = KINDS_OF_PASSES + 1;

/// The number of a query's kind.
fn number_of(subject: &Subject<ObjectId, Arc<Shape>>, kind: Query) -> usize {
    match subject {
        Subject::AllPairs => kind as usize,
        Subject::Events => KINDS_OF_PASSES - 1,
        Subject::Object(_) | Subject::Placed(..) => KINDS - 1,
    }
}

impl Search {
    /// Answers a query for each pair that it is about, and lists those that it asks for.
    ///
    /// # Errors
    /// See [`Scene::query_intersection`](crate::scene::Scene::query_intersection); nothing is listed then, and nothing is counted.
    pub fn ask(
        &mut self,
        searched: &mut Searched,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<()> {
        if !is_default() {
            return with_default(move || self.ask(searched, subject, kind, query));
        }
        self.latest = number_of(subject, kind);
        if matches!(subject, Subject::AllPairs) {
            match self.ask_straight(searched, query) {
                Ok(true) => return Ok(()),
                Ok(false) => {}
                Err(error) => return Err(self.fail(error)),
            }
        }
        self.ask_in_full(searched, subject, kind, query)
    }

    #[inline(never)]
    fn ask_in_full(
        &mut self,
        searched: &mut Searched,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<()> {
        searched.world.proxies.settle();
        let found = self.find(searched, subject, kind, query);
        self.stopped = matches!(found, Ok(true));
        if let Err(error) = found {
            return Err(self.fail(error));
        }
        let findings = &mut self.kept[self.latest].findings;
        if self.stopped {
            findings.contacts.keep_last();
        }
        self.statistics.add(&findings.statistics);
        self.statistics.queries += 1;
        if kind != Query::Intersection {
            self.statistics.error_spent += findings.error_spent();
        }
        Ok(())
    }

    /// Nothing is found.
    #[cold]
    fn fail(&mut self, error: Error) -> Error {
        let Kept { findings, pass, .. } = &mut self.kept[self.latest];
        findings.clear();
        (*pass, self.stopped) = (None, false);
        error
    }

    /// Fills the findings of the query's kind; true if it stopped at an intersecting pair, the last result.
    #[inline(always)]
    fn find(
        &mut self,
        searched: &mut Searched,
        subject: &Subject<ObjectId, Arc<Shape>>,
        kind: Query,
        query: &SceneQuery,
    ) -> Result<bool> {
        let request = Request::new(kind, query)?;
        match subject {
            Subject::AllPairs | Subject::Events => self.ask_all(searched, &request),
            Subject::Object(id) => self.ask_object(searched, *id, &request),
            Subject::Placed(body) => {
                body.check()?;
                self.ask_placed(searched, body, &request)
            }
        }
    }

    /// The answer of the last query.
    #[inline(always)]
    pub fn answer(&self) -> SceneAnswer<'_> {
        let Findings { intersecting, contacts, .. } = self.findings();
        let results = self.findings().results();
        let (pairs, found) = if self.stopped { (&[][..], results.last()) } else { (results, None) };
        SceneAnswer { intersecting: *intersecting, pairs, found, contacts: contacts.view() }
    }

    /// The changes among the pairs of objects that the last query found.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the near pairs stay remembered.
    pub fn compare(&mut self, objects: &ObjectTable) -> Result<SceneEvents<'_>> {
        self.events.compare(self.kept[self.latest].findings.results(), objects)
    }

    fn findings(&self) -> &Findings {
        &self.kept[self.latest].findings
    }

    /// No answer of before is given again.
    pub fn forget(&mut self) {
        self.kept.iter_mut().for_each(|kept| kept.pass = None);
    }

    /// Gives back all room.
    pub fn shrink(&mut self) {
        let (events, statistics) = (std::mem::take(&mut self.events), self.statistics);
        *self = Search { events, statistics, ..Search::default() };
    }

    // --- All pairs ---------------------------------------------------------------------------------------------------------------

    /// True if the query stopped at an intersecting pair, the last result.
    fn ask_all(&mut self, searched: &mut Searched, request: &Request) -> Result<bool> {
        if request.error_budget.is_none() {
            return self.pass_over_all(searched, request);
        }
        if !searched.world.keeps_list(request.tolerance) {
            // Which pairs may take shares is known of near pairs alone.
            return self.pass_over_all(searched, &request.with_share(None));
        }
        self.bring_up_to_date(searched, request.tolerance)?;
        let share = self.share(searched, request)?;
        self.pass_over_all(searched, &request.with_share(Some(share)))
    }

    /// The share of each pair that has one in a budget: while nothing moves, it stays the same.
    fn share(&mut self, searched: &mut Searched, request: &Request) -> Result<f64> {
        let (proxies, list) = (&searched.world.proxies, &mut searched.near.list);
        let Kept { pass, asked, .. } = &mut self.kept[self.latest];
        if let (Some(pass), Some(asked)) = (&pass, &asked)
            && asked.error_budget == request.error_budget
            && asked.tolerance == request.tolerance
            && let Some(share) = asked.share
            && !proxies.motions.iter().any(|motion| motion.moved >= *pass)
        {
            return Ok(share);
        }
        let dealt = deal(request, proxies, &mut list.pairs, &list.marks[self.latest], &mut self.needs)?;
        if !dealt.is_for_all {
            *pass = None;
        }
        Ok(dealt.share)
    }

    /// One pass over the list, or where everything is near over all pairs.
    fn pass_over_all(&mut self, searched: &mut Searched, request: &Request) -> Result<bool> {
        searched.world.passes += 1;
        if searched.world.keeps_list(request.tolerance) {
            match self.bring_up_to_date(searched, request.tolerance) {
                Ok(()) => return self.pass_over_list(searched, request),
                // A list of all pairs saves time; without one they are gone through regardless.
                Err(Error::Memory(_)) if request.tolerance == f64::INFINITY && searched.world.given.is_none() => {}
                Err(error) => return Err(error),
            }
        }
        let Kept { findings, pass, .. } = &mut self.kept[self.latest];
        *pass = None;
        findings.begin(None);
        let (proxies, mut rules, _) = searched.world.parts();
        let pass = Pass::new(request, proxies, None);
        run_over_all(&pass, &mut rules, &mut searched.near.list, findings)
    }

    /// The list, and the marks of passes of this kind.
    fn bring_up_to_date(&self, searched: &mut Searched, tolerance: f64) -> Result<()> {
        searched.near.update(searched.world, tolerance, searched.workers)?;
        searched.near.list.make_marks(self.latest)
    }

    /// The same over the list. If the last pass of the kind asked the same, it repeats the answers of the pairs at rest.
    fn pass_over_list(&mut self, searched: &mut Searched, request: &Request) -> Result<bool> {
        let (kind, proxies, list) = (self.latest, &searched.world.proxies, &mut searched.near.list);
        let Kept { findings, pass: last_pass, asked } = &mut self.kept[kind];
        let has_compounds = proxies.bodies.has_compounds();
        // Compounds have many contacts, and a query that stops lists one.
        let may_list_many = has_compounds && request.early_exit && request.details.is_some();
        let asked_same =
            last_pass.take().filter(|_| !may_list_many && asked.as_ref().is_some_and(|asked| asked.is_same(request)));
        if has_compounds {
            list.make_compound_room()?;
        }
        let gives_again = match asked_same {
            Some(last_pass) => self.before.find_moved(proxies, last_pass)?,
            None => false,
        };
        findings.begin(gives_again.then_some(&mut self.before));
        let (pairs, finds_contacts) = (list.pairs.len(), request.details.is_some());
        if finds_contacts {
            list.contacts.make_room(list.caches.len())?;
        }
        let pass = Pass::new(request, proxies, gives_again.then_some(&self.before));
        let looks = if gives_again { self.before.looks(pairs, finds_contacts) } else { pairs };
        let stopped = if searched.workers.share(looks) && !request.early_exit {
            pass.run_in_parts(searched.workers, &mut self.parts, list, kind, findings)?;
            false
        } else {
            let NearPairs { pairs, marks, caches, contacts, compounds, .. } = list;
            pass.run(pairs, &mut marks[kind], &mut Own { caches, contacts: Some(contacts), compounds }, findings)?
        };
        if gives_again {
            findings.join(&mut self.before, finds_contacts)?;
        }
        if !stopped {
            // A request is large: an existing one is not written again, unless its budgets may differ.
            if asked_same.is_none() || request.error_budget.is_some() {
                *asked = Some(*request);
            }
            *last_pass = Some(searched.world.passes);
            if finds_contacts {
                list.forget_depths(kind);
            }
        }
        Ok(stopped)
    }

    // --- Pairs of one body -------------------------------------------------------------------------------------------------------

    fn ask_object(&mut self, searched: &mut Searched, id: ObjectId, request: &Request) -> Result<bool> {
        searched.world.passes += 1;
        if !searched.world.keeps_list(request.tolerance) {
            let mut pairs = all_pairs_of(searched.world, id)?;
            return self.pass_without_memory(searched.world, &mut pairs, request);
        }
        searched.near.update(searched.world, request.tolerance, searched.workers)?;
        let mut pairs = near_pairs_of(searched.world, &searched.near.list, id)?;
        if searched.world.proxies.bodies.has_compounds() {
            searched.near.list.make_compound_room()?;
        }
        let NearPairs { caches, contacts, compounds, .. } = &mut searched.near.list;
        if request.details.is_some() {
            contacts.make_room(caches.len())?;
        }
        let memory = Own { caches, contacts: Some(contacts), compounds };
        self.pass_over_few(searched.world, &mut pairs, memory, request)
    }

    fn ask_placed(
        &mut self,
        searched: &mut Searched,
        body: &PlacedBody<Arc<Shape>>,
        request: &Request,
    ) -> Result<bool> {
        searched.world.passes += 1;
        // Boxes are good for their tolerance where the scene itself finds the pairs.
        let by_boxes = searched.world.given.is_none() && searched.world.keeps_list(request.tolerance);
        if by_boxes {
            searched.near.update(searched.world, request.tolerance, searched.workers)?;
        }
        let proxies = &mut searched.world.proxies;
        let first = proxies.len();
        proxies.reserve(body.pieces.len())?;
        for (piece, (shape, pose)) in (0..).zip(&*body.pieces) {
            let label = Label { object: ObjectId::NULL, user_data: 0, piece, fixed: false, groups: 0, mask: 0 };
            let own = proxies.push_unseen(NewProxy { shape: shape.clone(), pose: *pose, label });
            if by_boxes {
                proxies.refit(own, searched.near.tolerance());
            }
        }
        let pairs = pairs_of_last(proxies, first, body.mask, by_boxes);
        let stopped = pairs.and_then(|mut pairs| self.pass_without_memory(searched.world, &mut pairs, request));
        searched.world.proxies.end_unseen(first);
        stopped
    }

    /// Over pairs without caches.
    fn pass_without_memory(&mut self, world: &World, pairs: &mut [NearPair], request: &Request) -> Result<bool> {
        let mut caches = collected(pairs.iter().map(|_| Mutex::default()))?;
        self.pass_over_few(world, pairs, Own { caches: &mut caches, contacts: None, compounds: &[] }, request)
    }

    fn pass_over_few(
        &mut self,
        world: &World,
        pairs: &mut [NearPair],
        mut memory: Own,
        request: &Request,
    ) -> Result<bool> {
        let findings = &mut self.kept[self.latest].findings;
        findings.begin(None);
        let mut marks = filled(PairMark::NONE, pairs.len())?;
        Pass::new(request, &world.proxies, None).run(pairs, &mut marks, &mut memory, findings)
    }
}
