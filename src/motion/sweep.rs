//! A sweep along a motion: proved free step by step, as far as it goes.

use super::bound::least_between;
use super::forecast::Forecast;
use super::moving::{Moment, MovingPair};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::pair::{self, DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig};

/// Lengths of a step that are tried by a forecast that takes the gap for smooth; those that follow are a quarter of each other,
/// so that a few dozen reach the shortest step.
const SMOOTH_TRIALS: u32 = 3;

/// Lengths of a step after which the distance there is asked for.
const MOST_SIGHTS: u32 = 4;

/// A ball proves contact where it is this many times as large as rounding: the check of an answer asks for a depth to within its
/// half.
pub(super) const BALL: f64 = 4.0;

/// Contact is looked for after 1, 2, 4 … 2¹⁰ time tolerances.
pub(super) const MOST_DOUBLINGS: i32 = 10;

/// The same of bodies that have to go in as far as they deviate from their polyhedra.
const MOST_DOUBLINGS_OF_CURVED: i32 = 30;

/// The goal of a sweep.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweepGoal {
    /// Farther apart than this.
    pub max_distance: f64,
    /// Whether gaps are to exceed `max_distance` by [`MovingPair::slack`].
    pub with_slack: bool,
    /// The shortest step.
    pub shortest: f64,
}

/// A pair that was proved free from one moment to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeStep {
    pub ends: [Moment; 2],
    /// Along these directions at both ends, about of unit length …
    pub directions: [Vector; 2],
    /// … the motion's gaps are at least so much,
    pub gaps: [f64; 2],
    /// and at all times between, along one that turns from the first to the second, at least so much.
    pub least: f64,
    /// The least amount by which `least` exceeds `max_distance`.
    pub slack: f64,
}

/// Why a sweep ended where it is.
pub(super) enum Ahead {
    /// A step forward.
    Free(FreeStep),
    /// They are no farther apart than `max_distance` at a later moment, or at this one.
    Contact(Moment, PairAnswer),
    /// Neither a step nor contact could be proved.
    Open,
}

/// The result that one moment proves about contact.
#[allow(clippy::large_enum_variant, reason = "made in the end of a cast, and not kept")]
pub(super) enum Look {
    /// No farther apart than `max_distance`.
    Contact(PairAnswer),
    /// Farther apart, along that direction.
    Apart([f64; 3]),
    /// Rounding hides it.
    Open,
}

/// The state carried along a sweep.
pub(super) struct Sweep<'a> {
    pair: &'a MovingPair<'a>,
    /// The cache of the pair's queries.
    pub cache: PairCache,
    /// Certified queries made, those of gaps apart.
    pub queries: u32,
    /// The iterations in integers of these.
    pub exact_iterations: u64,
    /// Support vertices of the last gap, if one was asked for.
    pub vertices: Option<[u32; 2]>,
    /// The step before.
    last: Option<[Moment; 2]>,
    /// The forecast that the last step came from.
    before: Option<Forecast>,
    sight: Option<Sight>,
}

/// The facts known about a moment at which a step has ended, or might have.
struct Sight {
    time: f64,
    near: PairAnswer,
    /// Along its normal.
    gap: f64,
}

impl<'a> Sweep<'a> {
    pub fn new(pair: &'a MovingPair<'a>, cache: &PairCache) -> Sweep<'a> {
        Sweep {
            pair,
            cache: *cache,
            queries: 0,
            exact_iterations: 0,
            vertices: None,
            last: None,
            before: None,
            sight: None,
        }
    }

    /// The distance at a moment.
    pub fn distance(&mut self, moment: &Moment) -> Result<PairAnswer> {
        match self.sight_at(moment.time) {
            Some(sight) => Ok(sight.near),
            None => {
                let mut answer = PairAnswer::default();
                self.ask(moment, &mut answer)?;
                Ok(answer)
            }
        }
    }

    /// Keeps the answer about a time at which the objects are no farther apart than is asked.
    pub fn keep_sight(&mut self, time: f64, near: &PairAnswer) {
        self.sight = Some(Sight { time, near: *near, gap: f64::NEG_INFINITY });
    }

    fn sight_at(&self, time: f64) -> Option<&Sight> {
        self.sight.as_ref().filter(|sight| sight.time == time)
    }

    pub fn ask(&mut self, moment: &Moment, answer: &mut PairAnswer) -> Result<()> {
        self.queries += 1;
        pair::distance(self.pair.placed(moment), &mut self.cache, &PairConfig::default(), answer)?;
        self.exact_iterations += u64::from(answer.statistics.exact_iterations);
        Ok(())
    }

    /// To the end along the line of centres, of bodies that are far apart: by how much they stay farther apart than asked, without
    /// a query. Keeps the moment there, if it was computed.
    pub fn far(&self, here: &Moment, end: f64, wanted: &SweepGoal, at_end: &mut Option<Moment>) -> Result<Option<f64>> {
        debug_assert!(wanted.with_slack);
        let Some(direction) = self.pair.between_spheres(here) else { return Ok(None) };
        let there = at_end.insert(self.pair.at(end)?);
        let needed = wanted.max_distance + self.pair.slack(here);
        let last = self.pair.gap(there, &direction, &mut None);
        // Of a pair that meets that gap is closed.
        if !(last > needed) {
            return Ok(None);
        }
        let gaps = [self.pair.gap(here, &direction, &mut None), last];
        let least = least_between(gaps, self.pair.sag([here, there], [&direction; 2]));
        Ok((least > needed).then_some(least - needed))
    }

    /// On from a moment, whose distance is known, to `end` at most.
    pub fn on(&mut self, here: &Moment, near: &PairAnswer, end: f64, wanted: &SweepGoal) -> Result<Ahead> {
        if near.outcome == Outcome::Separated && near.lower > wanted.max_distance {
            if let Some(step) = self.step(here, near, end, wanted)? {
                return Ok(Ahead::Free(step));
            }
        } else if let Look::Contact(answer) = self.look(here, wanted.max_distance)? {
            return Ok(Ahead::Contact(*here, answer));
        }
        self.contact_ahead(here, end, wanted)
    }

    /// The longest step that is found: along the normal of the distance, or from there to the normal at its end.
    fn step(&mut self, here: &Moment, near: &PairAnswer, end: f64, wanted: &SweepGoal) -> Result<Option<FreeStep>> {
        let direction = Vector::from(near.normal);
        let trial = match self.sight_at(here.time).map(|sight| sight.gap) {
            Some(gap) => Trial::with_gap(self.pair, here, direction, gap, wanted),
            None => Trial::new(self.pair, here, direction, wanted, &mut self.vertices),
        };
        if !(trial.room() > 0.0) {
            return Ok(None);
        }
        let longest = end - here.time;
        let shortest = wanted.shortest.min(longest);
        // How fast a callback moves takes another call of it. Most often all of a planner's edge is free.
        if self.pair.has_callback() && longest > shortest {
            let step = trial.to(&self.pair.at(end)?, &mut self.vertices);
            if step.least > trial.needed {
                return self.took(step).map(Some);
            }
        }
        let speed = self.pair.speed(here, &direction, near)?;
        let mut forecast = Forecast::new(here.time, trial.room(), speed, trial.acceleration, self.before.as_ref());
        let mut limit = longest;
        for trials in 1.. {
            let (length, closes) = forecast.step(limit, shortest);
            let there = self.pair.at(if length < longest { after(here.time, length) } else { end })?;
            // If bodies turn, the gap along one direction has closed before the distance is about to.
            let turns = trial.acceleration > 0.0 && trials <= MOST_SIGHTS && length > shortest;
            let mut found = if turns && closes { self.turned(&trial, &there)? } else { None };
            let mut rise = 0.0;
            if found.is_none() {
                let step = trial.to(&there, &mut self.vertices);
                rise = step.gaps[1] - step.gaps[0];
                found = (step.least > trial.needed).then_some(step);
            }
            if found.is_none() && turns && !closes {
                found = self.turned(&trial, &there)?;
            }
            if let Some(step) = found {
                self.before = Some(forecast);
                return self.took(step).map(Some);
            }
            if length <= shortest {
                break;
            }
            if trials < SMOOTH_TRIALS {
                forecast.learn_curve(rise, length);
                // Trials that ask for a distance are dear: shorter ones more often hold.
                limit = if turns { 0.5 * length } else { 0.7 * length };
            } else {
                forecast.learn_kink(rise, length);
                limit = 0.25 * length;
            }
        }
        Ok(None)
    }

    /// A step along a direction that turns to the normal at its end. The results there are kept: the next step begins with them.
    fn turned(&mut self, trial: &Trial, there: &Moment) -> Result<Option<FreeStep>> {
        let mut near = PairAnswer::default();
        self.ask(there, &mut near)?;
        if near.outcome != Outcome::Separated {
            return Ok(None);
        }
        let direction = Vector::from(near.normal);
        let gap = self.pair.gap(there, &direction, &mut self.vertices);
        self.sight = Some(Sight { time: there.time, near, gap });
        let step = trial.step(there, direction, gap);
        Ok((step.least > trial.needed).then_some(step))
    }

    /// Contact within some time tolerances; or a step along the axis that separates the bodies at the first of these.
    fn contact_ahead(&mut self, here: &Moment, end: f64, wanted: &SweepGoal) -> Result<Ahead> {
        let most = if self.pair.deviation() > 0.0 { MOST_DOUBLINGS_OF_CURVED } else { MOST_DOUBLINGS };
        for doubling in 0..=most {
            let time = after(here.time, wanted.shortest * f64::from(1 << doubling)).min(end);
            if time <= here.time {
                break;
            }
            let there = self.pair.at(time)?;
            match self.look(&there, wanted.max_distance)? {
                Look::Contact(answer) => return Ok(Ahead::Contact(there, answer)),
                Look::Apart(direction) if doubling == 0 => {
                    let trial = Trial::new(self.pair, here, direction.into(), wanted, &mut self.vertices);
                    let step = trial.to(&there, &mut self.vertices);
                    if step.least > trial.needed {
                        self.before = None;
                        return self.took(step).map(Ahead::Free);
                    }
                }
                // They have passed each other.
                Look::Apart(_) if doubling > MOST_DOUBLINGS => break,
                Look::Apart(_) | Look::Open => {}
            }
            if time >= end {
                break;
            }
        }
        Ok(Ahead::Open)
    }

    /// Whether the motion is provably in contact at a moment. With a `max_distance` of 0 the poses have to be deeper in each other
    /// than they are rounded; with one their distance has to be so much less, and is asked for from no cache: the check asks the
    /// same, and finds the same upper end.
    pub fn look(&mut self, moment: &Moment, max_distance: f64) -> Result<Look> {
        self.queries += 1;
        let (mut answer, mut none) = (PairAnswer::default(), PairCache::default());
        let cache = if max_distance > 0.0 { &mut none } else { &mut self.cache };
        pair::contact(self.pair.placed(moment), cache, &PairConfig::default(), &mut answer)?;
        let is_hidden = max_distance == 0.0 && moment.rounding > 0.0 && answer.outcome == Outcome::Intersecting;
        if is_hidden && !self.is_deep(moment)? {
            return Ok(Look::Open);
        }
        let is_contact = is_contact(&answer, moment, max_distance);
        let is_apart = answer.outcome == Outcome::Separated && answer.lower > max_distance;
        Ok(match (is_contact, is_apart) {
            (true, _) => Look::Contact(answer),
            (false, true) => Look::Apart(answer.normal),
            (false, false) => Look::Open,
        })
    }

    /// Whether poses that a query has just found to intersect are deeper in each other than they are rounded.
    fn is_deep(&self, moment: &Moment) -> Result<bool> {
        if self.pair.enclosed_ball(moment, &self.cache) > BALL * moment.rounding {
            return Ok(true);
        }
        Ok(depth_at(self.pair, moment, &mut DepthCache::default())?.lower > moment.rounding)
    }

    /// Where objects that are in contact, and move apart along the contact's normal, are provably apart along it: soon, or `None`.
    pub fn parted(&mut self, start: &Moment, end: f64, wanted: &SweepGoal) -> Result<Option<Moment>> {
        let needed = wanted.max_distance + self.pair.slack(start);
        let touch = self.contact(start)?;
        let normal = Vector::from(touch.normal);
        // False for the NaN of bodies without a normal.
        let are_parting = self.pair.speed(start, &normal, &touch)? > 0.0;
        if !are_parting || self.pair.gap(start, &normal, &mut self.vertices) > needed {
            return Ok(None);
        }
        for doubling in 0..=MOST_DOUBLINGS {
            let time = after(start.time, wanted.shortest * f64::from(1 << doubling)).min(end);
            if time <= start.time {
                break;
            }
            let there = self.pair.at(time)?;
            if self.pair.gap(&there, &normal, &mut self.vertices) > needed {
                return Ok(Some(there));
            }
        }
        Ok(None)
    }

    /// The contact of the poses of a moment.
    pub fn contact(&mut self, moment: &Moment) -> Result<PairAnswer> {
        self.queries += 1;
        let mut answer = PairAnswer::default();
        pair::contact(self.pair.placed(moment), &mut self.cache, &PairConfig::default(), &mut answer)?;
        Ok(answer)
    }

    /// Whether the motion provably has its objects in contact at a moment.
    pub fn is_contact(&mut self, moment: &Moment) -> Result<bool> {
        Ok(matches!(self.look(moment, 0.0)?, Look::Contact(_)))
    }

    /// A step that is proved, whose ends and the one before may show that a callback is wrong.
    fn took(&mut self, step: FreeStep) -> Result<FreeStep> {
        if let Some([before, start]) = &self.last {
            self.pair.check_bend([before, start, &step.ends[1]])?;
        }
        self.last = Some(step.ends);
        Ok(step)
    }
}

/// The latest time that is no more than `length` later.
pub(super) fn after(time: f64, length: f64) -> f64 {
    let later = time + length;
    // Rounding moves it by half a unit in the last place.
    if later - time > length { later.next_down() } else { later }
}

/// How deep the poses of a moment are in each other, to within its half.
pub(super) fn depth_at(pair: &MovingPair, moment: &Moment, cache: &mut DepthCache) -> Result<DepthAnswer> {
    let config = DepthConfig { relative_error: 1.0, ..DepthConfig::default() };
    let mut depth = DepthAnswer::default();
    pair::depth(pair.placed(moment), cache, &config, &mut depth)?;
    Ok(depth)
}

/// Whether an answer about the poses of a moment shows that the motion has its objects no farther apart than `max_distance`, if
/// those that intersect are, where it is 0, deep enough in each other.
pub(super) fn is_contact(answer: &PairAnswer, moment: &Moment, max_distance: f64) -> bool {
    match answer.outcome {
        Outcome::Intersecting => max_distance == 0.0 || moment.rounding <= max_distance,
        Outcome::Separated => max_distance > 0.0 && upper_bound(answer, moment) <= max_distance,
        _ => false,
    }
}

/// The distance of the motion at a moment is at most this, by an answer about its poses.
pub(super) fn upper_bound(answer: &PairAnswer, moment: &Moment) -> f64 {
    debug_assert!(moment.rounding >= 0.0);
    if moment.rounding == 0.0 { answer.upper } else { (answer.upper + moment.rounding).next_up() }
}

/// Steps from one moment, along a direction there.
struct Trial<'a> {
    pair: &'a MovingPair<'a>,
    here: Moment,
    direction: Vector,
    gap: f64,
    acceleration: f64,
    slack: f64,
    /// The value that the least gap must exceed.
    needed: f64,
}

impl<'a> Trial<'a> {
    fn new(
        pair: &'a MovingPair<'a>,
        here: &Moment,
        direction: Vector,
        wanted: &SweepGoal,
        vertices: &mut Option<[u32; 2]>,
    ) -> Trial<'a> {
        let gap = pair.gap(here, &direction, vertices);
        Trial::with_gap(pair, here, direction, gap, wanted)
    }

    fn with_gap(pair: &'a MovingPair<'a>, here: &Moment, direction: Vector, gap: f64, wanted: &SweepGoal) -> Trial<'a> {
        let slack = if wanted.with_slack { pair.slack(here) } else { 0.0 };
        let acceleration = pair.acceleration(&direction);
        Trial { pair, here: *here, direction, gap, acceleration, slack, needed: wanted.max_distance + slack }
    }

    fn room(&self) -> f64 {
        self.gap - self.needed
    }

    /// Along the same direction.
    fn to(&self, there: &Moment, vertices: &mut Option<[u32; 2]>) -> FreeStep {
        self.step(there, self.direction, self.pair.gap(there, &self.direction, vertices))
    }

    /// To a direction there and the gap along it.
    fn step(&self, there: &Moment, direction: Vector, gap: f64) -> FreeStep {
        let (gaps, sag) = ([self.gap, gap], self.pair.sag([&self.here, there], [&self.direction, &direction]));
        let least = least_between(gaps, sag);
        let (ends, directions) = ([self.here, *there], [self.direction, direction]);
        FreeStep { ends, directions, gaps, least, slack: self.slack }
    }
}
