//! Pairs of one body: an object of the scene, or one that is put somewhere for the question alone.

use crate::base::error::Result;
use crate::base::memory::{collected, push};
use crate::scene::near::near_pairs::{NearPair, NearPairs};
use crate::scene::world::content::World;
use crate::scene::world::object::ObjectId;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::testing::Testing;

/// The pairs of an object that are in the list, with the memory that they have there.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn near_pairs_of(world: &World, list: &NearPairs, id: ObjectId) -> Result<Vec<NearPair>> {
    let rows = world.rows_of(id);
    let is_own = |pair: &&NearPair| pair.proxies.iter().any(|&proxy| rows.contains(&(proxy as usize)));
    collected(list.pairs.iter().filter(is_own).copied())
}

/// The tested pairs of an object with all others.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn all_pairs_of(world: &mut World, id: ObjectId) -> Result<Vec<NearPair>> {
    let own = world.rows_of(id);
    let (proxies, mut rules, _) = world.parts();
    let mut pairs = Vec::new();
    for other in proxies.of_objects() {
        let [one, other] = if other.start < own.start { [other, own.clone()] } else { [own.clone(), other] };
        for a in one {
            for b in other.clone() {
                let labels = [&proxies.labels[a], &proxies.labels[b]];
                if proxies.may_meet(a, b) && rules.testing(labels) == Testing::Active {
                    add(&mut pairs, [a, b])?;
                }
            }
        }
    }
    Ok(pairs)
}

/// The pairs of the rows from `first` on, which are of one body, with those before it of objects whose groups have a bit of the
/// mask, if there is one: with all of these, or with those whose boxes overlap.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn pairs_of_last(
    proxies: &Proxies,
    first: usize,
    mask: Option<u32>,
    by_boxes: bool,
) -> Result<Vec<NearPair>> {
    debug_assert!(first <= proxies.len());
    let is_asked = |other: &usize| {
        let label = &proxies.labels[*other];
        !label.is_gone() && mask.is_none_or(|mask| label.groups & mask != 0)
    };
    let are_near = |other: usize, own: usize| !by_boxes || proxies.boxes[other].overlaps(&proxies.boxes[own]);
    let mut pairs = Vec::new();
    for other in (0..first).filter(is_asked) {
        for own in (first..proxies.len()).filter(|&own| are_near(other, own)) {
            add(&mut pairs, [other, own])?;
        }
    }
    Ok(pairs)
}

/// One more pair, with a cache of its own.
fn add(pairs: &mut Vec<NearPair>, [a, b]: [usize; 2]) -> Result<()> {
    let cache = pairs.len() as u32;
    push(pairs, NearPair { cache, ..NearPair::new([a as u32, b as u32]) })
}
