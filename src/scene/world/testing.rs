//! Which pairs queries test: activation, and the program's own word.

use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::{locked, unlocked};
use crate::base::memory::push;
use crate::base::simd::environment::with_callers;
use crate::scene::world::activation::Activation;
use crate::scene::world::object::{ObjectId, ObjectTable};
use crate::scene::world::rows::Label;

/// Whether a near pair is tested.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Testing {
    Active,
    /// Deactivated for now.
    Inactive,
    /// The program's filter rejected the pair.
    Rejected,
}

/// A program's word on which pairs of objects are tested, the earlier created first.
pub struct PairFilter {
    /// Behind a lock for questions that several threads ask at once.
    filter: Mutex<Box<Filter>>,
    /// The decisions that are not yet written down, for a scene that is recorded.
    decided: Option<Result<Vec<Decided>>>,
}

/// Whether a pair is tested.
pub(crate) type Decided = ([ObjectId; 2], bool);

type Filter = dyn FnMut(ObjectId, ObjectId) -> bool + Send + Sync;

impl PairFilter {
    /// A filter that calls a function.
    pub fn new(filter: impl FnMut(ObjectId, ObjectId) -> bool + Send + Sync + 'static) -> PairFilter {
        PairFilter { filter: Mutex::new(Box::new(filter)), decided: None }
    }

    /// Whether it remembers what it decides.
    pub(crate) fn watch(&mut self, watched: bool) {
        self.decided = watched.then(|| Ok(Vec::new()));
    }

    /// The decisions since it is watched; an error if not all are known.
    pub(crate) fn decided(&mut self) -> Result<Vec<Decided>> {
        self.decided.take().unwrap_or(Ok(Vec::new()))
    }

    fn accepts(&mut self, pair: [ObjectId; 2]) -> bool {
        let [object1, object2] = pair;
        let filter = unlocked(&mut self.filter);
        let accepts = with_callers(|| filter(object1, object2));
        if let Some(Ok(decided)) = &mut self.decided
            && let Err(error) = push(decided, (pair, accepts))
        {
            self.decided = Some(Err(error));
        }
        accepts
    }

    /// The filter's decision on a pair, for a question that is not written down.
    fn asked(&self, [object1, object2]: [ObjectId; 2]) -> bool {
        let mut filter = locked(&self.filter);
        with_callers(|| filter(object1, object2))
    }
}

impl std::fmt::Debug for PairFilter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("PairFilter")
    }
}

/// The rules on the testing of pairs.
pub(crate) struct Rules<'a> {
    pub objects: &'a ObjectTable,
    pub activation: &'a Activation,
    pub filter: Option<&'a mut PairFilter>,
}

impl Rules<'_> {
    /// Whether a near pair is tested, the earlier created object first.
    pub fn testing(&mut self, labels: [&Label; 2]) -> Testing {
        let pair = labels.map(|label| label.object);
        if !self.filter.as_mut().is_none_or(|filter| filter.accepts(pair)) {
            return Testing::Rejected;
        }
        self.active(labels)
    }

    /// The same, regardless of the filter.
    pub fn active(&self, labels: [&Label; 2]) -> Testing {
        if !self.activation.says_no() {
            return Testing::Active;
        }
        match labels.map(|label| self.objects.get(label.object)) {
            [Ok(object1), Ok(object2)] => {
                let pair = labels.map(|label| label.object);
                if self.activation.is_active(pair, [object1.activation, object2.activation]) {
                    Testing::Active
                } else {
                    Testing::Inactive
                }
            }
            _ => Testing::Inactive,
        }
    }
}

/// Whether questions that change nothing test a pair of objects, the earlier created first.
pub(crate) fn is_tested(
    objects: &ObjectTable,
    activation: &Activation,
    filter: Option<&PairFilter>,
    labels: [&Label; 2],
) -> bool {
    let rules = Rules { objects, activation, filter: None };
    rules.active(labels) == Testing::Active
        && filter.is_none_or(|filter| filter.asked(labels.map(|label| label.object)))
}
