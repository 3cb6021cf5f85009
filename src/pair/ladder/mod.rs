//! The ladder: every way in which an answer comes about, the cheapest first. Each rung answers, or hands on its findings; the
//! last one, integers, always answers.

mod query;
mod balls;
mod glance;
mod acceptance;
mod marching;
mod meeting;
mod decision;
mod support_glance;
mod level_choice;
mod level_search;
mod level_glance;
mod steps;

use crate::answer::{PairAnswer, PairConfig, Query};
use crate::base::error::Result;
use crate::base::simd::Portable;
use crate::base::simd::environment::{self, with_default};
use crate::distance::decide::Pairs;
use crate::pair::cache::PairCache;
use crate::pair::start::policy::StartFrom;
use crate::pair::start::{Guess, start_pair};
use crate::shape::Placed;
pub(super) use balls::{BallQuery, Balls};
use decision::Hint;
pub use glance::{shrunk, square_between, square_of_rigid, together};
pub(crate) use level_choice::least_error;
use level_search::LevelSearched;
use query::{Attempt, Glances};
pub(super) use query::{NoBalls, PairQuery, Sweep};
pub(crate) use steps::for_each_state;

/// A query of two bodies.
///
/// # Errors
/// As of [`distance`](crate::pair::distance).
#[inline(always)]
pub(super) fn ask<S: Sweep>(pair: PairQuery<S>) -> Result<()> {
    // Before there is a query in memory (R6), and before a number is refused, which comparing and printing may trap.
    if !environment::is_default() {
        return ask_in_default(pair);
    }
    // Not by `?`, which looks again whether the error in memory is one, and keeps what it needs if not in registers (R3).
    if !pair.config.is_in_range(pair.query) {
        return Err(pair.config.first_fault());
    }
    ask_checked(pair)
}

/// The same in the default environment of floating point, with a configuration whose members are in range.
#[inline(always)]
pub(super) fn ask_checked<S: Sweep>(mut pair: PairQuery<S>) -> Result<()> {
    debug_assert!(environment::is_default() && pair.config.is_in_range(pair.query));
    answer(pair.query, &mut pair, Glances::Asked)
}

/// The verdict alone, of marching: neither bounding spheres nor the last separating axis are asked.
///
/// # Errors
/// As of [`distance`](crate::pair::distance).
pub(super) fn intersection_by_marching(
    bodies: &[Placed; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    found: &mut PairAnswer,
) -> Result<()> {
    let query = Query::Intersection;
    with_default(|| {
        if !config.is_in_range(query) {
            return Err(config.first_fault());
        }
        answer(
            query,
            &mut PairQuery { query, bodies, cache, config, answer: found, sweep: &mut NoBalls },
            Glances::LeftOut,
        )
    })
}

/// In the default environment of floating point, as the program has set another.
#[cold]
#[inline(never)]
fn ask_in_default<S: Sweep>(pair: PairQuery<S>) -> Result<()> {
    with_default(|| ask(pair))
}

/// From the first rung. The query is also handed on by value (R6).
#[inline(always)]
fn answer<S: Sweep>(query: Query, pair: &mut PairQuery<S>, glances: Glances) -> Result<()> {
    if glances == Glances::Asked && pair.spheres_are_far_apart() {
        return Ok(());
    }
    if glances == Glances::Asked && pair.inner_balls_overlap(query) {
        return Ok(());
    }
    if pair.may_ask_support_maps(query) {
        return S::ask_polyhedra(pair, |pair| answer_by_support_maps(pair, glances));
    }
    if pair.may_ask_levels(query) {
        return S::ask_polyhedra(pair, |pair| answer_by_levels(pair, glances));
    }
    match answer_at_once(query, pair, glances) {
        Attempt::Answered => Ok(()),
        attempt => S::ask_polyhedra(pair, |pair| answer_on(pair, attempt)),
    }
}

/// Maps of support functions, unless the pair does better by marching at the moment; else as without them.
#[inline(never)]
fn answer_by_support_maps(pair: &mut PairQuery<NoBalls>, glances: Glances) -> Result<()> {
    let looks_up = pair.cache.looks_up();
    if looks_up && pair.support_maps_answer()? {
        return Ok(());
    }
    if pair.may_ask_levels(pair.query) {
        answer_by_levels(pair, glances)?
    } else {
        answer_by_bodies(pair.query, pair, glances)?
    }
    pair.cache.note_marching(pair.answer.statistics.marching_steps, looks_up);
    Ok(())
}

/// Levels of detail, where they may answer; else the bodies themselves.
#[inline(never)]
fn answer_by_levels(pair: &mut PairQuery<NoBalls>, glances: Glances) -> Result<()> {
    if pair.last_levels_answer() {
        return Ok(());
    }
    match pair.search_levels()? {
        LevelSearched::Answered => Ok(()),
        LevelSearched::Bodies => answer_by_bodies(pair.query, pair, glances),
        LevelSearched::Marched(search, attempt) => {
            answer_on(pair, attempt)?;
            search.remember(pair);
            Ok(())
        }
    }
}

/// The bodies themselves.
#[inline(always)]
fn answer_by_bodies(query: Query, pair: &mut PairQuery<NoBalls>, glances: Glances) -> Result<()> {
    match answer_at_once(query, pair, glances) {
        Attempt::Answered => Ok(()),
        attempt => answer_on(pair, attempt),
    }
}

/// From what the cache holds.
#[inline(always)]
fn answer_at_once<S: Sweep>(query: Query, pair: &mut PairQuery<S>, glances: Glances) -> Attempt {
    if !(pair.is_simple() & pair.asks_cache()) {
        return Attempt::Untried;
    }
    if glances == Glances::Asked && pair.last_axis_separates(query) {
        return Attempt::Answered;
    }
    if pair.cache.holds_enclosure() {
        return S::ask_polyhedra(pair, |pair| pair.look_at_last_proof());
    }
    pair.march_from_last_features()
}

/// The rest, for the less common cases.
#[inline(never)]
fn answer_on(pair: &mut PairQuery<NoBalls>, mut attempt: Attempt) -> Result<()> {
    pair.forget()?;
    if matches!(attempt, Attempt::Untried | Attempt::NotEnclosed) && pair.meets_or_misses() {
        return Ok(());
    }
    let enclosure = pair.cache.enclosure(pair.polyhedra());
    if matches!(attempt, Attempt::Untried) && enclosure.is_none() {
        attempt = pair.march(None);
    }
    let is_known_open = matches!(attempt, Attempt::NotEnclosed);
    let mut hint = match (attempt, enclosure) {
        (Attempt::Untried | Attempt::NotEnclosed, Some(pairs)) => Hint { pairs, steps: 0 },
        (attempt, _) => match pair.look_closer(attempt) {
            None => return Ok(()),
            Some(hint) => hint,
        },
    };
    // Made in place: it is large.
    let frame = pair.frame::<Portable>();
    if !frame.in_range {
        pair.check_poses()?;
        return pair.decide(None, &hint);
    }
    if !is_known_open && pair.is_enclosed(&frame, &hint)? {
        return Ok(());
    }
    if pair.may_have_come_apart(&frame) {
        let start = start_pair(&pair.pair(), StartFrom::Centres);
        if pair.has_turned_away(&frame) {
            hint.pairs = Pairs::new(&[start.vertices()]);
        }
        if start.guess == Guess::Apart {
            let attempt = pair.march(Some(start));
            match pair.look_closer(attempt) {
                None => return Ok(()),
                Some(nearer) => hint = nearer,
            }
        }
    }
    pair.decide(Some(&frame), &hint)
}
