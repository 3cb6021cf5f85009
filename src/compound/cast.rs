//! When two moving compounds first meet: pieces that come near each other are cast as pairs, each up to the first contact so far.

use super::MovingCompound;
use super::answer::CompoundCastAnswer;
use super::approach::approach;
use super::cache::{CompoundCache, PieceCaches};
use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::simd::environment::with_default;
use crate::motion::{Carried, CastAnswer, CastConfig, CastOutcome, cast_carried, distance_at, verify_carried};

/// A clearance says a little less than is proved, so that another proof need not find the very axis.
const SHARE: f64 = 1.0 - 1e-9;

/// Whether two moving compounds stay farther apart than `config.max_distance`, or when they first do not. Certain as
/// [`crate::motion::cast`] is; the step budget is for each two pieces.
///
/// A hit names the two pieces that meet first, as far as time intervals tell. It begins where the first of all pairs is no longer
/// proved apart: rounding may hide whether others graze before. Without a hit, the first two pieces that no proof decides are
/// named.
///
/// # Errors
/// As of [`crate::motion::cast`], and [`Error::Pose`] where the product of a compound's and a piece's pose is refused.
/// [`Error::Argument`] also for `config.ignores_parting`: compounds part from some pieces alone. [`Error::Memory`]. Then
/// `answer` is as it was.
pub fn cast(
    bodies: [MovingCompound; 2],
    cache: &mut CompoundCache,
    config: &CastConfig,
    answer: &mut CompoundCastAnswer,
) -> Result<()> {
    cast_pieces(bodies, cache, config, answer)
}

/// The same with any cache.
///
/// # Errors
/// As of [`cast`].
pub(crate) fn cast_pieces<C: PieceCaches>(
    bodies: [MovingCompound; 2],
    cache: &mut C,
    config: &CastConfig,
    answer: &mut CompoundCastAnswer,
) -> Result<()> {
    with_default(|| {
        check_config(config)?;
        let counts = bodies.map(|body| body.compound.piece_count());
        let last = cache.last().nearest(counts);
        let mut first = FirstPieces {
            bodies: &bodies,
            cache,
            config,
            lower: config.time_end,
            until: config.time_end,
            clearance: f64::INFINITY,
            queries: 0,
            named: None,
        };
        if let Some(pieces) = last {
            first.learn(pieces)?;
        }
        let until = first.until;
        let passed = approach(&bodies, config.range(), config.max_distance, until, &mut |pieces| {
            if last != Some(pieces) {
                first.learn(pieces)?;
            }
            Ok(first.until)
        })?;
        first.clearance = first.clearance.min(passed * SHARE);
        *answer = first.finish(counts)?;
        Ok(())
    })
}

/// Re-checks an answer of [`cast`] for the same compounds, motions and configuration.
///
/// The pieces that are named are checked by [`crate::motion::verify_cast`]. All others are proved to be farther apart than
/// `max_distance`, and at least `clearance`, up to `time_lower`: by boxes, whose walk is made anew, or one by one. That boxes
/// contain their pieces is not checked.
///
/// # Errors
/// As of [`crate::motion::verify_cast`]; [`Error::Argument`] also for numbers of pieces that the compounds do not have.
pub fn verify_cast(bodies: [MovingCompound; 2], config: &CastConfig, found: &CompoundCastAnswer) -> Result<()> {
    with_default(|| {
        check_config(config)?;
        let counts = bodies.map(|body| body.compound.piece_count() as u32);
        let (answer, pieces) = (&found.answer, [found.piece1, found.piece2]);
        let is_free = answer.outcome == CastOutcome::Free;
        let named = (pieces[0] < counts[0] && pieces[1] < counts[1]).then_some(pieces);
        if named.is_none() && (!is_free || pieces != counts) {
            let [one, two] = pieces;
            let message = format!("pieces {one} and {two} of compounds that have {} and {}", counts[0], counts[1]);
            return Err(Error::Argument(message));
        }
        // Of free compounds any two pieces stand for all in what the answer says beside its numbers.
        let proved = named.unwrap_or([0, 0]);
        with_carried(&bodies, proved, |carried| verify_carried(carried, config, answer))
            .map_err(|error| about(error, proved))?;
        let beginning = config.time_begin;
        if answer.time_lower == beginning && !is_free {
            return Ok(());
        }
        let least = if is_free { answer.clearance } else { config.max_distance };
        let before = CastConfig { time_end: answer.time_lower, ..*config };
        let apart = CastAnswer {
            outcome: CastOutcome::Free,
            time_lower: answer.time_lower,
            clearance: least,
            ..CastAnswer::default()
        };
        approach(&bodies, before.range(), least, before.time_end, &mut |pieces| {
            if pieces != proved {
                with_carried(&bodies, pieces, |carried| verify_carried(carried, &before, &apart))
                    .map_err(|error| about(error, pieces))?;
            }
            Ok(before.time_end)
        })?;
        Ok(())
    })
}

fn check_config(config: &CastConfig) -> Result<()> {
    config.check()?;
    if config.ignores_parting {
        return Err(Error::Argument("ignores_parting is for pairs of bodies: clear it for compounds".into()));
    }
    Ok(())
}

fn about(error: Error, [one, two]: [u32; 2]) -> Error {
    error.about(&format!("pieces {one} and {two}"))
}

/// Two pieces and the motions that carry them along.
fn with_carried<T>(bodies: &[MovingCompound; 2], pieces: [u32; 2], work: impl FnOnce([Carried; 2]) -> T) -> T {
    let carried = |i: usize| {
        let MovingCompound { compound, motion } = bodies[i];
        let piece = &compound.pieces()[pieces[i] as usize];
        Carried { shape: &piece.shape, motion, place: (piece.pose != Pose::IDENTITY).then_some(&piece.pose) }
    };
    work([carried(0), carried(1)])
}

/// The first contact of the pairs of pieces that were cast.
struct FirstPieces<'a, C> {
    bodies: &'a [MovingCompound<'a>; 2],
    cache: &'a mut C,
    config: &'a CastConfig,
    /// All that was cast is apart up to here.
    lower: f64,
    /// Nothing after it counts: the earliest time of a contact, below the range where nothing can be earlier.
    until: f64,
    /// All that was cast and is free is at least so far apart.
    clearance: f64,
    queries: u32,
    named: Option<([u32; 2], CastAnswer)>,
}

impl<C: PieceCaches> FirstPieces<'_, C> {
    fn learn(&mut self, pieces: [u32; 2]) -> Result<()> {
        if self.until < self.config.time_begin {
            return Ok(());
        }
        let config = CastConfig { time_end: self.until, ..*self.config };
        let (cache, mut answer) = (self.cache.of(pieces), CastAnswer::default());
        let range = self.config.range();
        with_carried(self.bodies, pieces, |carried| cast_carried(carried, range, cache, &config, &mut answer))
            .map_err(|error| about(error, pieces))?;
        self.queries = self.queries.saturating_add(answer.queries);
        if answer.outcome == CastOutcome::Free {
            self.clearance = self.clearance.min(answer.clearance);
            return Ok(());
        }
        self.lower = self.lower.min(answer.time_lower);
        let is_first = self.named.as_ref().is_none_or(|(_, known)| match (known.outcome, answer.outcome) {
            (CastOutcome::Hit, CastOutcome::Hit) => answer.time_upper < known.time_upper,
            (CastOutcome::Hit, _) => false,
            (_, CastOutcome::Hit) => true,
            _ => answer.time_lower < known.time_lower,
        });
        if is_first {
            self.named = Some((pieces, answer));
        }
        if answer.outcome == CastOutcome::Hit {
            self.until = self.until.min(answer.time_upper);
            if self.until <= self.config.time_begin {
                self.until = f64::NEG_INFINITY;
            }
        }
        Ok(())
    }

    fn finish(self, counts: [usize; 2]) -> Result<CompoundCastAnswer> {
        let FirstPieces { bodies, cache, config, lower, clearance, queries, named, .. } = self;
        let Some((pieces, mut answer)) = named else {
            let clearance = clearance.max(config.max_distance);
            let (outcome, time_lower) = (CastOutcome::Free, config.time_end);
            let answer = CastAnswer { outcome, time_lower, clearance, queries, ..CastAnswer::default() };
            let [piece1, piece2] = counts.map(|count| count as u32);
            return Ok(CompoundCastAnswer { answer, piece1, piece2 });
        };
        cache.last().remember_nearest(Some(pieces));
        // Others may have come near before these met.
        if lower < answer.time_lower {
            answer.contact = with_carried(bodies, pieces, |carried| distance_at(carried, config, lower))?;
            answer.time_lower = lower;
        }
        answer.queries = queries;
        Ok(CompoundCastAnswer { answer, piece1: pieces[0], piece2: pieces[1] })
    }
}
