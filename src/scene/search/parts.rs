//! The near pairs of one pass in parts, for several threads. Each pair's answer rests on its poses and its own cache alone, so
//! results, their order and the caches are bit for bit those of one thread.

use std::sync::Mutex;

use crate::base::error::Result;
use crate::base::locks::locked;
use crate::base::memory::{push, reserve, with_capacity};
use crate::base::simd::prefetch;
use crate::base::workers::Workers;
use crate::compound::GrowingCache;
use crate::manifold::Reference;
use crate::pair::{DepthCache, PairCache};
use crate::scene::near::contact_memory::ContactMemory;
use crate::scene::near::near_pairs::{NearPair, NearPairs, PairMark};
use crate::scene::search::findings::Findings;
use crate::scene::search::narrow_phase::{BLOCK, PairCaches, Pass};
use crate::scene::search::slots::split;

/// The findings of a part, kept from pass to pass.
#[derive(Debug, Default)]
pub(crate) struct PartFindings {
    findings: Findings,
    written: Written,
}

/// The contacts that a part has changed, by places: put there once no other part reads them.
#[derive(Debug, Default)]
struct Written {
    references: Vec<(u32, Reference)>,
    /// The depths of pairs that had none.
    depths: Vec<(u32, DepthCache)>,
}

impl Written {
    fn clear(&mut self) {
        self.references.clear();
        self.depths.clear();
    }

    fn put(&self, contacts: &mut ContactMemory) -> Result<()> {
        for (place, reference) in &self.references {
            *contacts.reference(*place) = *reference;
        }
        for (place, cache) in &self.depths {
            *contacts.of_intersecting(*place)?.1 = *cache;
        }
        Ok(())
    }
}

/// The caches of pairs while several threads look at them. Each pair is looked at by one: no lock is waited for.
struct Together<'a> {
    caches: &'a [Mutex<PairCache>],
    contacts: &'a ContactMemory,
    compounds: &'a [Mutex<GrowingCache>],
    written: &'a mut Written,
}

impl PairCaches for Together<'_> {
    #[inline(always)]
    fn prefetch(&self, place: u32) {
        prefetch(&self.caches[place as usize]);
    }

    #[inline(always)]
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()> {
        change(&mut locked(&self.caches[place as usize]))
    }

    fn compounds(&self) -> &[Mutex<GrowingCache>] {
        self.compounds
    }

    fn change_contact(
        &mut self,
        place: u32,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> Result<()>,
    ) -> Result<()> {
        let (mut reference, cache) = self.contacts.peek(place);
        match cache {
            _ if !intersects => change(&mut reference, None)?,
            Some(cache) => change(&mut reference, Some(&mut locked(cache)))?,
            None => {
                let mut cache = DepthCache::default();
                change(&mut reference, Some(&mut cache))?;
                push(&mut self.written.depths, (place, cache))?;
            }
        }
        push(&mut self.written.references, (place, reference))
    }
}

impl Pass<'_> {
    /// As [`Pass::run`] over all near pairs with the marks of a kind, which never stops early, by several threads.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn run_in_parts(
        &self,
        workers: &Workers,
        kept: &mut Vec<PartFindings>,
        near: &mut NearPairs,
        kind: usize,
        findings: &mut Findings,
    ) -> Result<()> {
        let NearPairs { pairs, marks, caches, contacts, compounds, .. } = near;
        let marks = &mut marks[kind];
        let size = workers.part_size(pairs.len()).next_multiple_of(BLOCK);
        let sizes = self.part_sizes(pairs, size)?;
        let count = sizes.len();
        reserve(kept, count.saturating_sub(kept.len()))?;
        kept.resize_with(count.max(kept.len()), PartFindings::default);
        let kept = &mut kept[..count];
        let run = |((pairs, marks), found): ((&mut [NearPair], &mut [PairMark]), &mut PartFindings)| {
            let PartFindings { findings, written } = found;
            findings.clear();
            written.clear();
            self.run(pairs, marks, &mut Together { caches, contacts, compounds, written }, findings)
        };
        let [of_pairs, of_marks] = [0; 2].map(|_| sizes.iter().copied());
        let parts = split(pairs, of_pairs).zip(split(marks, of_marks));
        let results = workers.map(parts.zip(kept.iter_mut()), run)?;
        let (mut firsts, mut new) = (with_capacity(count)?, 0);
        for (result, PartFindings { findings: found, written }) in results.into_iter().zip(&*kept) {
            result?;
            firsts.push(findings.append(found, new)?);
            new += found.slots.count();
            written.put(contacts)?;
        }
        let rooms = findings.rooms(kept.iter().map(|part| &part.findings))?;
        let parts = split(marks, sizes.iter().copied()).zip(firsts).zip(rooms).zip(&*kept);
        workers.map(parts, |(((marks, first), mut room), part)| {
            room.fill(&part.findings);
            marks.iter_mut().for_each(|mark| mark.shift_result(first));
        })?;
        Ok(())
    }
}
