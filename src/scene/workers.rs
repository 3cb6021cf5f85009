//! The near pairs of one pass, shared out among threads: parts of the list, put together again in order. Each pair's answer rests
//! on its poses and its own memory alone, so results, their order and what pairs remember are bit for bit those of one thread.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use crate::base::error::Result;
use crate::base::memory::{collected, push, reserve};
use crate::base::simd::environment::with_default;
use crate::pair::{DepthCache, PairCache, Reference};
use crate::scene::broad_phase::near_pairs::{NearPair, NearPairs};
use crate::scene::contacts::ContactMemory;
use crate::scene::findings::Findings;
use crate::scene::narrow_phase::{BLOCK, Caches, Pass};

/// Fewer pairs are left to one thread: waking another takes as long as some dozen tests, and its first ones miss the memory.
pub(crate) const FEWEST_SHARED: usize = 2048;

/// So many parts for each thread, as some take longer than others.
const PARTS_EACH: usize = 4;

/// Who works on the queries of a scene.
pub struct Workers {
    count: usize,
    run: Box<RunParts>,
}

/// Calls the function once for each number below the first argument, in any threads, and returns when all calls have returned.
type RunParts = dyn Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync;

impl Workers {
    /// The program's own `count` threads: `run` is to call the function that it gets once for each number below the one that it
    /// gets, in any threads, several at once, and to return when all calls have returned.
    pub fn new(count: usize, run: impl Fn(usize, &(dyn Fn(usize) + Sync)) + Send + Sync + 'static) -> Workers {
        Workers { count, run: Box::new(run) }
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.count
    }
}

impl fmt::Debug for Workers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Workers({})", self.count)
    }
}

/// What a part found, kept from pass to pass.
#[derive(Debug, Default)]
pub(crate) struct PartFindings {
    findings: Findings,
    written: Written,
}

/// What a part has changed, by places.
#[derive(Debug, Default)]
struct Written {
    caches: Vec<(u32, PairCache)>,
    references: Vec<(u32, Reference)>,
    depths: Vec<(u32, DepthCache)>,
}

impl Written {
    fn clear(&mut self) {
        self.caches.clear();
        self.references.clear();
        self.depths.clear();
    }

    fn put(&self, caches: &mut [PairCache], contacts: &mut ContactMemory) -> Result<()> {
        for (place, cache) in &self.caches {
            caches[*place as usize] = *cache;
        }
        for (place, reference) in &self.references {
            *contacts.reference(*place) = *reference;
        }
        for (place, cache) in &self.depths {
            *contacts.of_intersecting(*place)?.1 = *cache;
        }
        Ok(())
    }
}

/// Some pairs next to each other, and who looks at them.
struct Part<'a> {
    pairs: &'a mut [NearPair],
    found: &'a mut PartFindings,
    /// Once it is done.
    result: Option<Result<bool>>,
}

/// Caches that others read, too: what changes is written down.
struct Shared<'a> {
    caches: &'a [PairCache],
    contacts: &'a ContactMemory,
    written: &'a mut Written,
}

impl Caches for Shared<'_> {
    #[inline(always)]
    fn peek(&self, place: u32) -> &PairCache {
        &self.caches[place as usize]
    }

    #[inline(always)]
    fn change(&mut self, place: u32, change: impl FnOnce(&mut PairCache) -> Result<()>) -> Result<()> {
        let mut cache = self.caches[place as usize];
        change(&mut cache)?;
        push(&mut self.written.caches, (place, cache))
    }

    fn change_contact(
        &mut self,
        place: u32,
        intersects: bool,
        change: impl FnOnce(&mut Reference, Option<&mut DepthCache>) -> Result<()>,
    ) -> Result<()> {
        let (mut reference, cache) = self.contacts.peek(place);
        if intersects {
            let mut cache = cache.copied().unwrap_or_default();
            change(&mut reference, Some(&mut cache))?;
            push(&mut self.written.depths, (place, cache))?;
        } else {
            change(&mut reference, None)?;
        }
        push(&mut self.written.references, (place, reference))
    }
}

impl Part<'_> {
    /// Does the part if it is not done.
    fn run(&mut self, pass: &Pass, caches: &[PairCache], contacts: &ContactMemory) {
        if self.result.is_none() {
            let PartFindings { findings, written } = &mut *self.found;
            let mut caches = Shared { caches, contacts, written };
            self.result = Some(with_default(|| pass.run(self.pairs, &mut caches, findings)));
        }
    }
}

/// As [`Pass::run`] over all near pairs, which never stops early.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn run_in_parts(
    workers: &Workers,
    pass: &Pass,
    near: &mut NearPairs,
    kept: &mut Vec<PartFindings>,
    findings: &mut Findings,
) -> Result<()> {
    let NearPairs { pairs, caches, contacts, .. } = near;
    let size = pairs.len().div_ceil(PARTS_EACH * workers.count()).next_multiple_of(BLOCK);
    let count = pairs.len().div_ceil(size);
    reserve(kept, count.saturating_sub(kept.len()))?;
    kept.resize_with(count.max(kept.len()), PartFindings::default);
    for PartFindings { findings, written } in kept.iter_mut() {
        findings.clear();
        written.clear();
    }
    let part = |(pairs, found)| Mutex::new(Part { pairs, found, result: None });
    let parts = collected(pairs.chunks_mut(size).zip(kept.iter_mut()).map(part))?;
    let work = |k: usize| {
        if let Some(part) = parts.get(k) {
            // A part that a panic has left is not done, and the panic goes on its way.
            part.lock().unwrap_or_else(PoisonError::into_inner).run(pass, caches, contacts);
        }
    };
    (workers.run)(count, &work);
    // Whoever shares the work out may have left something.
    (0..count).for_each(work);
    for part in parts {
        let Part { pairs, found, result } = part.into_inner().unwrap_or_else(PoisonError::into_inner);
        result.transpose()?;
        let first = findings.append(&found.findings)?;
        for pair in pairs {
            pair.shift_result(first);
        }
        found.written.put(caches, contacts)?;
    }
    Ok(())
}
