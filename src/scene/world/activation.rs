//! Which pairs of objects are tested: the latest word on a pair holds, whether it was on the pair, on one of its objects or on
//! all.
//!
//! Nothing is enumerated. Every word gets a stamp, and a pair's state is the greatest of the four stamps that concern it. Each
//! call costs O(1) whatever the number of objects, and a pair without any word needs no entry.

use std::collections::HashMap;

use crate::base::error::Result;
use crate::base::memory::{collected, extend, lacking};
use crate::scene::world::object::{ObjectId, Stamp};

/// So many words on pairs are kept without a look at whether their objects are still there.
const LEAST_CROWD: usize = 64;

/// The pairs that a setting applies to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Word {
    All,
    Object(ObjectId),
    Pair([ObjectId; 2]),
}

/// The settings for all pairs and for single ones; the setting for an object is its own stamp.
#[derive(Debug, Default)]
pub(crate) struct Activation {
    latest: Stamp,
    /// Something was deactivated, ever.
    says_no: bool,
    all: Stamp,
    /// Since the last word on all; the earlier created object first. Words on objects removed since do no harm, as no id comes
    /// again.
    pairs: HashMap<[ObjectId; 2], Stamp>,
    /// The number of `pairs` at which those of removed objects are forgotten.
    crowded: usize,
}

impl Activation {
    /// The next word: "active" or not.
    fn say(&mut self, active: bool) -> Stamp {
        self.says_no |= !active;
        self.latest = self.latest.next(active);
        self.latest
    }

    /// Sets all existing pairs.
    pub(crate) fn set_all(&mut self, active: bool) {
        self.all = self.say(active);
        self.pairs.clear();
    }

    /// Sets all existing pairs of one object. A new object must be set active: its pairs are active, regardless of earlier
    /// settings.
    pub(crate) fn set_object(&mut self, stamp: &mut Stamp, active: bool) {
        *stamp = self.say(active);
    }

    /// Sets one pair, the earlier created object first. `is_there` tells the objects that have not been removed.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); nothing is set then.
    pub(crate) fn set_pair(
        &mut self,
        pair: [ObjectId; 2],
        active: bool,
        is_there: impl Fn(ObjectId) -> bool,
    ) -> Result<()> {
        // Looking through all words each time there may be twice as many as were kept costs no more than recording them did.
        if self.pairs.len() >= self.crowded {
            self.pairs.retain(|pair, _| pair.iter().all(|id| is_there(*id)));
            self.crowded = 2 * self.pairs.len() + LEAST_CROWD;
        }
        self.pairs.try_reserve(1).map_err(|e| lacking::<([ObjectId; 2], Stamp)>(self.pairs.len() + 1, &e))?;
        let stamp = self.say(active);
        self.pairs.insert(pair, stamp);
        Ok(())
    }

    /// The settings that may still hold, in the order in which they were made: repeated for these objects they make the same
    /// pairs active.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn words(&self, objects: impl Iterator<Item = (ObjectId, Stamp)>) -> Result<Vec<(Word, bool)>> {
        if !self.says_no {
            return Ok(Vec::new());
        }
        let mut words = collected([(self.all, Word::All)])?;
        extend(&mut words, objects.map(|(id, stamp)| (stamp, Word::Object(id))))?;
        extend(&mut words, self.pairs.iter().map(|(pair, stamp)| (*stamp, Word::Pair(*pair))))?;
        words.sort_unstable_by_key(|(stamp, _)| *stamp);
        collected(words.iter().map(|(stamp, word)| (*word, stamp.active())))
    }

    /// Whether some pair may be inactive.
    pub(crate) fn says_no(&self) -> bool {
        self.says_no
    }

    /// Whether a pair is active, the earlier created object first.
    pub(crate) fn is_active(&self, pair: [ObjectId; 2], [stamp1, stamp2]: [Stamp; 2]) -> bool {
        let stamp = self.pairs.get(&pair).copied().unwrap_or_default();
        self.all.max(stamp1).max(stamp2).max(stamp).active()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::world::object::ObjectTable;
    use swiftprox::random::Random;

    /// Against the plain model, one flag for each pair, set by every word: random words, objects that come and go.
    #[test]
    fn the_latest_word_holds() {
        let mut random = Random::new(1);
        let mut table = ObjectTable::new();
        let mut activation = Activation::default();
        let mut model: HashMap<[ObjectId; 2], bool> = HashMap::new();
        let mut ids: Vec<ObjectId> = Vec::new();
        // Under Miri, which is slow, enough to forget words on removed objects.
        for _ in 0..if cfg!(miri) { 300 } else { 5_000 } {
            let active = random.below(2) == 1;
            match random.below(16) {
                0 => {
                    activation.set_all(active);
                    model.values_mut().for_each(|flag| *flag = active);
                }
                1 | 2 if ids.len() < 12 => {
                    let id = table.insert(0..1).unwrap();
                    activation.set_object(&mut table.get_mut(id).unwrap().activation, true);
                    model.extend(ids.iter().map(|&earlier| ([earlier, id], true)));
                    ids.push(id);
                }
                3 if ids.len() > 2 => {
                    let id = ids.remove(random.below(ids.len()));
                    table.remove(id).unwrap();
                    model.retain(|pair, _| !pair.contains(&id));
                }
                4..8 if !ids.is_empty() => {
                    let id = ids[random.below(ids.len())];
                    activation.set_object(&mut table.get_mut(id).unwrap().activation, active);
                    model.iter_mut().filter(|(pair, _)| pair.contains(&id)).for_each(|(_, flag)| *flag = active);
                }
                8.. if ids.len() > 1 => {
                    let second = 1 + random.below(ids.len() - 1);
                    let pair = [ids[random.below(second)], ids[second]];
                    activation.set_pair(pair, active, |id| table.get(id).is_ok()).unwrap();
                    model.insert(pair, active);
                }
                _ => {}
            }
            for (pair, &flag) in &model {
                let stamps = pair.map(|id| table.get(id).unwrap().activation);
                assert_eq!(activation.is_active(*pair, stamps), flag);
            }
        }
        assert!(ids.len() > 2);
        // 66 pairs of twelve objects, twice, and what is kept without a look.
        assert!(activation.pairs.len() <= 2 * 66 + LEAST_CROWD, "words on removed objects are forgotten");
    }
}
