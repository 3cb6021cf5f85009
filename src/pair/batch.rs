//! Many pairs at once: each is treated as a single one, with the memory of those that follow requested ahead.

use super::cache::PairCache;
use super::queries::{approximate, contact, distance, intersection};
use crate::answer::{PairAnswer, PairConfig, Query};
use crate::base::error::{Error, Result};
use crate::base::simd::prefetch;
use crate::base::workers::Workers;
use crate::shape::Placed;

/// A pair to query, and its cache.
#[derive(Debug)]
pub struct PairQuestion<'a> {
    /// The two bodies.
    pub bodies: [Placed<'a>; 2],
    /// This pair's own cache.
    pub cache: &'a mut PairCache,
}

/// Memory is requested this many pairs ahead: a warm query takes about as long as two lines on their way.
const AHEAD: usize = 4;

/// Asks each pair what `query` names, into the answer at the same place. Answers and caches are bit for bit those of single
/// queries, no matter which `workers` share the work.
///
/// # Errors
/// [`Error::Argument`] unless there is one answer for each pair. For refused pairs it returns the first one's error, named by its
/// number: their answers are empty, and all others are answered. [`Error::Memory`] where workers share.
pub fn batch(
    query: Query,
    pairs: &mut [PairQuestion],
    config: &PairConfig,
    answers: &mut [PairAnswer],
    workers: Option<&Workers>,
) -> Result<()> {
    if pairs.len() != answers.len() {
        return Err(Error::Argument(format!("{} answers for {} pairs", answers.len(), pairs.len())));
    }
    let all = BatchPart { query, config, first: 0, pairs, answers };
    match workers.filter(|workers| workers.share(all.pairs.len())) {
        None => all.ask(),
        Some(workers) => workers.map(all.cut(workers), BatchPart::ask)?.into_iter().collect(),
    }
}

/// Some of the pairs; number `first` is the first of them.
struct BatchPart<'a, 'b> {
    query: Query,
    config: &'a PairConfig,
    first: usize,
    pairs: &'a mut [PairQuestion<'b>],
    answers: &'a mut [PairAnswer],
}

impl<'a, 'b> BatchPart<'a, 'b> {
    fn cut(self, workers: &Workers) -> impl Iterator<Item = BatchPart<'a, 'b>> {
        let BatchPart { query, config, first, pairs, answers } = self;
        let size = workers.part_size(pairs.len());
        let parts = pairs.chunks_mut(size).zip(answers.chunks_mut(size));
        (first..).step_by(size).zip(parts).map(move |(first, (pairs, answers))| BatchPart {
            query,
            config,
            first,
            pairs,
            answers,
        })
    }

    /// The first refusal, once all are asked.
    fn ask(self) -> Result<()> {
        let solver = match self.query {
            Query::Intersection => intersection,
            Query::Distance => distance,
            Query::Contact => contact,
            Query::Approximate => approximate,
        };
        let mut refused = Ok(());
        for k in 0..self.pairs.len() {
            if let Some(ahead) = self.pairs.get(k + AHEAD) {
                ahead.prefetch();
            }
            let PairQuestion { bodies, cache } = &mut self.pairs[k];
            let answer = &mut self.answers[k];
            if let Err(error) = solver(*bodies, cache, self.config, answer) {
                *answer = PairAnswer::default();
                refused = refused.and_then(|()| Err(error.about(&format!("pair {}", self.first + k))));
            }
        }
        refused
    }
}

impl PairQuestion<'_> {
    /// Asks for the memory that its query begins with.
    #[inline(always)]
    fn prefetch(&self) {
        for body in &self.bodies {
            prefetch(body.pose);
            prefetch(body.shape);
        }
        prefetch::<PairCache>(self.cache);
    }
}
