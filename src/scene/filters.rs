//! Which pairs queries test: activation, filters, and pairs that the program gives.

use super::{News, Scene};
use crate::base::error::{Error, Result};
use crate::base::memory::{copied, push};
use crate::base::simd::environment::with_callers;
use crate::scene::activation::Activation;
use crate::scene::broad_phase::near_pairs::Testing;
use crate::scene::findings::{Before, Findings};
use crate::scene::object::{Entry, ObjectId, ObjectTable};
use crate::scene::recording::format::Record;
use crate::scene::rows::Label;

impl Scene {
    // --- Activation --------------------------------------------------------------------------------------------------------------

    /// Activates or deactivates the pair of two objects, in either order, with all its pairs of pieces. No effect on two
    /// fixed objects.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one object twice,
    /// [`Error::Memory`]; the pair stays as it is.
    pub fn set_pair_active(&mut self, id1: ObjectId, id2: ObjectId, active: bool) -> Result<()> {
        let pair = self.ordered_pair(id1, id2)?;
        let objects = &self.objects;
        self.activation.set_pair(pair, active, |id| objects.get(id).is_ok())?;
        let testing = if active { Testing::Active } else { Testing::Inactive };
        let [pieces1, pieces2] = [objects.get(pair[0])?.proxies(), objects.get(pair[1])?.proxies()];
        for proxy1 in pieces1 {
            for proxy2 in pieces2.clone() {
                self.broad_phase.near.set_testing(&self.proxies.firsts, [proxy1 as u32, proxy2 as u32], testing);
            }
        }
        self.note(|notes| notes.write(&Record::PairActive([notes.number(id1)?, notes.number(id2)?], active)));
        Ok(())
    }

    /// Activates or deactivates all pairs that an object is in.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn set_object_active(&mut self, id: ObjectId, active: bool) -> Result<()> {
        self.activation.set_object(&mut self.objects.get_mut(id)?.activation, active);
        self.news = self.news.max(News::Activation);
        self.note(|notes| notes.write(&Record::ObjectActive(notes.number(id)?, active)));
        Ok(())
    }

    /// Activates or deactivates all pairs.
    pub fn set_all_active(&mut self, active: bool) {
        self.activation.set_all(active);
        self.news = self.news.max(News::Activation);
        self.note(|notes| notes.write(&Record::AllActive(active)));
    }

    /// Whether queries test the pair of two objects when it is near, given in either order; the filter is not asked.
    ///
    /// # Errors
    /// As [`Scene::set_pair_active`].
    pub fn is_pair_active(&self, id1: ObjectId, id2: ObjectId) -> Result<bool> {
        let pair = self.ordered_pair(id1, id2)?;
        let [object1, object2] = [self.objects.get(pair[0])?, self.objects.get(pair[1])?];
        Ok(self.proxies.may_meet(object1.first_proxy as usize, object2.first_proxy as usize)
            && self.activation.is_active(pair, [object1.activation, object2.activation]))
    }

    /// Two different objects, the earlier created first.
    fn ordered_pair(&self, id1: ObjectId, id2: ObjectId) -> Result<[ObjectId; 2]> {
        let [first1, first2] = [self.objects.get(id1)?.first_proxy, self.objects.get(id2)?.first_proxy];
        match first1.cmp(&first2) {
            std::cmp::Ordering::Less => Ok([id1, id2]),
            std::cmp::Ordering::Equal => {
                Err(Error::Argument(format!("object {id1} is given twice: an object makes no pair with itself")))
            }
            std::cmp::Ordering::Greater => Ok([id2, id1]),
        }
    }

    // --- A program's own word ----------------------------------------------------------------------------------------------------

    /// Asks `filter` of each pair of objects whether it is to be tested, once for each of its pairs of pieces when that becomes
    /// near, and in queries without a tolerance of many objects each time. `None`: none is asked. All pairs that are near are asked
    /// anew. The filter is called with the earlier created object first, and should always say the same of a pair; it cannot use
    /// the scene.
    pub fn set_pair_filter(&mut self, filter: Option<PairFilter>) {
        self.filter = filter;
        self.news = News::Filter;
        let (is_set, is_watched) = (self.filter.is_some(), self.is_recording());
        self.filter_is_watched(is_watched);
        self.note(|notes| notes.write(&Record::Filter(is_set)));
    }

    /// Asks the filter anew of all pairs that are near.
    pub fn filter_again(&mut self) {
        self.news = News::Filter;
        self.note(|notes| notes.write(&Record::FilterAgain));
    }

    /// From now on queries test these pairs of objects and no others, however near: for a program with a broad phase of its own. An
    /// order is not needed, and what is there twice is tested once. Activation, filters and fixed objects are heeded as ever; ids
    /// of objects removed later name no pair. Pairs that stay keep what they remember. `None`: the scene finds the pairs again.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one object twice in a pair,
    /// [`Error::Memory`]; the pairs of before stay.
    pub fn set_pairs(&mut self, pairs: Option<&[[ObjectId; 2]]>) -> Result<()> {
        for (k, [id1, id2]) in pairs.unwrap_or_default().iter().enumerate() {
            self.ordered_pair(*id1, *id2).map_err(|error| match error {
                Error::Handle(message) => Error::Handle(format!("pair {k}: {message}")),
                other => Error::Argument(format!("pair {k}: {}", other.message())),
            })?;
        }
        self.given = pairs.map(copied).transpose()?;
        self.broad_phase.begin_anew();
        self.note(|notes| notes.given(pairs));
        Ok(())
    }

    // --- Near pairs --------------------------------------------------------------------------------------------------------------

    /// Gives back the memory that is kept for later: that of the results, and room for pairs that are no more. What the others
    /// remember stays.
    ///
    /// # Errors
    /// [`Error::Memory`] if there is none to bring the near pairs up to date; no result is lost then.
    pub fn shrink(&mut self) -> Result<()> {
        let tolerance = self.broad_phase.tolerance();
        let updated = self.update_near_pairs(if self.keeps_list(tolerance) { tolerance } else { 0.0 });
        self.note_decisions();
        updated?;
        self.broad_phase.shrink()?;
        (self.findings, self.before, self.last) = (Findings::default(), Before::default(), None);
        self.parts = Vec::new();
        self.note(|notes| notes.write(&Record::Shrink));
        Ok(())
    }

    /// Brings the near pairs up to date: all that a query with this tolerance may list are among them.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub(super) fn update_near_pairs(&mut self, tolerance: f64) -> Result<()> {
        let is_small = self.is_small();
        let (objects, activation, filter) = (&self.objects, &self.activation, &mut self.filter);
        let mut testing = |pair: [&Label; 2]| testing(objects, activation, filter, pair);
        let near = &mut self.broad_phase.near;
        match std::mem::replace(&mut self.news, News::None) {
            News::None => {}
            News::Activation => near.for_each_testing(&self.proxies.labels, |old, pair| match old {
                Testing::Rejected => old,
                _ if is_active(objects, activation, pair) => Testing::Active,
                _ => Testing::Inactive,
            }),
            News::Filter => near.for_each_testing(&self.proxies.labels, |old, pair| {
                // Pairs of objects that are gone are still to be dropped: the program does not know them any more.
                let is_gone = pair.iter().any(|label| label.object == ObjectId::NULL);
                if is_gone { old } else { testing(pair) }
            }),
        }
        match &self.given {
            None => {
                // What was kept of few objects must not be of many.
                if !is_small {
                    self.broad_phase.end_of_all_pairs(tolerance);
                }
                self.broad_phase.update(&mut self.proxies, tolerance, &self.workers, testing)?;
            }
            Some(given) => {
                let rows = |id: ObjectId| objects.get(id).map_or(0..0, Entry::proxies);
                let pieces = |&[id1, id2]: &[ObjectId; 2]| (rows(id1), rows(id2));
                self.broad_phase.take(&mut self.proxies, given.iter().map(pieces), testing)?;
            }
        }
        if self.proxies.has_many_gone()
            && let Some(numbers) = self.broad_phase.renumber(&mut self.proxies)
        {
            self.objects.renumber(&numbers);
        }
        Ok(())
    }
}

/// A program's word on which pairs of objects are tested, the earlier created first.
pub struct PairFilter {
    filter: Box<Filter>,
    /// What it has decided and is not yet written down, of a scene that is recorded.
    decided: Option<Result<Vec<Decided>>>,
}

/// Whether a pair is tested.
type Decided = ([ObjectId; 2], bool);

type Filter = dyn FnMut(ObjectId, ObjectId) -> bool + Send + Sync;

impl PairFilter {
    /// A filter that calls a function.
    pub fn new(filter: impl FnMut(ObjectId, ObjectId) -> bool + Send + Sync + 'static) -> PairFilter {
        PairFilter { filter: Box::new(filter), decided: None }
    }

    /// Whether it remembers what it decides.
    pub(super) fn watch(&mut self, watched: bool) {
        self.decided = watched.then(|| Ok(Vec::new()));
    }

    /// What it has decided since the last time; an error if not all is known.
    pub(super) fn decided(&mut self) -> Option<Result<Vec<Decided>>> {
        self.decided.as_mut().map(|decided| std::mem::replace(decided, Ok(Vec::new())))
    }

    fn accepts(&mut self, pair: [ObjectId; 2]) -> bool {
        let [object1, object2] = pair;
        let accepts = with_callers(|| (self.filter)(object1, object2));
        if let Some(Ok(decided)) = &mut self.decided
            && let Err(error) = push(decided, (pair, accepts))
        {
            self.decided = Some(Err(error));
        }
        accepts
    }
}

impl std::fmt::Debug for PairFilter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("PairFilter")
    }
}

/// Whether a near pair is tested, the earlier created object first.
pub(super) fn testing(
    objects: &ObjectTable,
    activation: &Activation,
    filter: &mut Option<PairFilter>,
    labels: [&Label; 2],
) -> Testing {
    let pair = labels.map(|label| label.object);
    if !filter.as_mut().is_none_or(|filter| filter.accepts(pair)) {
        return Testing::Rejected;
    }
    if is_active(objects, activation, labels) { Testing::Active } else { Testing::Inactive }
}

fn is_active(objects: &ObjectTable, activation: &Activation, labels: [&Label; 2]) -> bool {
    if !activation.says_no() {
        return true;
    }
    let pair = labels.map(|label| label.object);
    match pair.map(|id| objects.get(id)) {
        [Ok(object1), Ok(object2)] => activation.is_active(pair, [object1.activation, object2.activation]),
        _ => false,
    }
}
