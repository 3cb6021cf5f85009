//! A sweep along a motion: proved free step by step, as far as it goes.

use super::bound::least_between;
use super::moving::{Moment, MovingPair};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::pair::{self, DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig};

/// Lengths of a step that are tried by a forecast that takes the gap for smooth; those that follow are a quarter of each other, so
/// that a few dozen come to the shortest step.
const SMOOTH_TRIALS: u32 = 3;

/// Contact is looked for after 1, 2, 4 … 2¹⁰ time tolerances.
const MOST_DOUBLINGS: i32 = 10;

/// What a sweep wants to know.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    /// Farther apart than this.
    pub margin: f64,
    /// Whether gaps are to exceed the margin by [`MovingPair::slack`].
    pub with_slack: bool,
    /// The shortest step.
    pub shortest: f64,
}

/// A pair that was proved free from one moment to another.
#[derive(Debug, Clone, Copy)]
pub(super) struct FreeStep {
    pub ends: [Moment; 2],
    /// Along this direction, about of unit length …
    pub direction: Vector,
    /// … the motion's gaps at both ends are at least so much,
    pub gaps: [f64; 2],
    /// and at all times between at least so much.
    pub least: f64,
    /// What `least` exceeds the margin by at least.
    pub slack: f64,
}

/// Why a sweep ended where it is.
pub(super) enum Ahead {
    /// A step forward.
    Free(FreeStep),
    /// They are no farther apart than the margin at a later moment, or at this one.
    Contact(Moment, PairAnswer),
    /// Neither a step nor contact could be proved.
    Open,
}

/// What one moment proves about contact.
#[allow(clippy::large_enum_variant, reason = "made in the end of a cast, and not kept")]
enum Look {
    /// No farther apart than the margin.
    Contact(PairAnswer),
    /// Farther apart, along that direction.
    Apart([f64; 3]),
    /// Rounding hides it.
    Open,
}

/// What is carried along.
pub(super) struct Sweep<'a> {
    pair: &'a MovingPair<'a>,
    /// Of the pair's queries.
    pub cache: PairCache,
    /// Certified queries made, those of gaps apart.
    pub queries: u32,
    /// Support vertices of the last gap.
    vertices: [u32; 2],
    /// The step before.
    last: Option<[Moment; 2]>,
}

impl<'a> Sweep<'a> {
    pub fn new(pair: &'a MovingPair<'a>, cache: &PairCache) -> Sweep<'a> {
        Sweep { pair, cache: *cache, queries: 0, vertices: [0; 2], last: None }
    }

    /// The distance at a moment.
    pub fn distance(&mut self, moment: &Moment) -> Result<PairAnswer> {
        let mut answer = PairAnswer::default();
        self.queries += 1;
        pair::distance(self.pair.placed(moment), &mut self.cache, &PairConfig::default(), &mut answer)?;
        Ok(answer)
    }

    /// On from a moment, whose distance is known, to `end` at most.
    pub fn on(&mut self, here: &Moment, near: &PairAnswer, end: f64, wanted: &Wanted) -> Result<Ahead> {
        if near.outcome == Outcome::Separated && near.lower > wanted.margin {
            if let Some(step) = self.step(here, near, end, wanted)? {
                return Ok(Ahead::Free(step));
            }
        } else if let Look::Contact(answer) = self.look(here, wanted.margin)? {
            return Ok(Ahead::Contact(*here, answer));
        }
        self.contact_ahead(here, end, wanted)
    }

    /// The longest step along the direction of the distance that is found.
    fn step(&mut self, here: &Moment, near: &PairAnswer, end: f64, wanted: &Wanted) -> Result<Option<FreeStep>> {
        let direction = Vector::from(near.normal);
        let mut trial = Trial::new(self.pair, here, direction, wanted, &mut self.vertices);
        if !(trial.room() > 0.0) {
            return Ok(None);
        }
        let speed = self.pair.speed(here, &direction, [&near.local1, &near.local2])?;
        let longest = end - here.time;
        let shortest = wanted.shortest.min(longest);
        let mut forecast = Forecast { room: trial.room(), speed, curve: 0.0, acceleration: trial.acceleration };
        let mut limit = longest;
        for trials in 1.. {
            let length = forecast.step(limit, shortest);
            let there = self.pair.at(if length < longest { after(here.time, length) } else { end })?;
            let step = trial.to(&there, &mut self.vertices);
            if step.least > trial.needed {
                return self.took(step).map(Some);
            }
            if length <= shortest {
                break;
            }
            let rise = step.gaps[1] - step.gaps[0];
            if trials < SMOOTH_TRIALS {
                forecast.learn_curve(rise, length);
                limit = 0.7 * length;
            } else {
                forecast.learn_kink(rise, length);
                limit = 0.25 * length;
            }
        }
        Ok(None)
    }

    /// Contact within some time tolerances; or a step along the axis that separates the bodies at the first of these.
    fn contact_ahead(&mut self, here: &Moment, end: f64, wanted: &Wanted) -> Result<Ahead> {
        for doubling in 0..=MOST_DOUBLINGS {
            let time = after(here.time, wanted.shortest * f64::from(1 << doubling)).min(end);
            if time <= here.time {
                break;
            }
            let there = self.pair.at(time)?;
            match self.look(&there, wanted.margin)? {
                Look::Contact(answer) => return Ok(Ahead::Contact(there, answer)),
                Look::Apart(direction) if doubling == 0 => {
                    let mut trial = Trial::new(self.pair, here, direction.into(), wanted, &mut self.vertices);
                    let step = trial.to(&there, &mut self.vertices);
                    if step.least > trial.needed {
                        return self.took(step).map(Ahead::Free);
                    }
                }
                Look::Apart(_) | Look::Open => {}
            }
            if time >= end {
                break;
            }
        }
        Ok(Ahead::Open)
    }

    /// Whether the motion is in contact at a moment, for sure. Without a margin the poses have to be deeper in each other than they
    /// are rounded; with one their distance has to be so much less.
    fn look(&mut self, moment: &Moment, margin: f64) -> Result<Look> {
        self.queries += 1;
        let mut answer = PairAnswer::default();
        if margin == 0.0 && moment.rounding > 0.0 {
            let depth = depth_at(self.pair, moment, &mut DepthCache::default())?;
            if depth.outcome != Outcome::Intersecting {
                return Ok(Look::Apart(depth.normal));
            }
            if !(depth.lower > moment.rounding) {
                return Ok(Look::Open);
            }
        }
        pair::contact(self.pair.placed(moment), &mut self.cache, &PairConfig::default(), &mut answer)?;
        let is_contact = is_contact(&answer, moment, margin);
        let is_apart = answer.outcome == Outcome::Separated && answer.lower > margin;
        Ok(match (is_contact, is_apart) {
            (true, _) => Look::Contact(answer),
            (false, true) => Look::Apart(answer.normal),
            (false, false) => Look::Open,
        })
    }

    /// Whether the motion has its objects in contact at a moment, for sure.
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
fn after(time: f64, length: f64) -> f64 {
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

/// Whether an answer about the poses of a moment says that the motion has its objects no farther apart than the margin, if those
/// that intersect without a margin are deep enough in each other.
pub(super) fn is_contact(answer: &PairAnswer, moment: &Moment, margin: f64) -> bool {
    match answer.outcome {
        Outcome::Intersecting => margin == 0.0 || moment.rounding <= margin,
        Outcome::Separated => margin > 0.0 && upper_bound(answer, moment) <= margin,
        _ => false,
    }
}

/// The distance of the motion at a moment is at most this, by an answer about its poses.
pub(super) fn upper_bound(answer: &PairAnswer, moment: &Moment) -> f64 {
    if moment.rounding == 0.0 { answer.upper } else { (answer.upper + moment.rounding).next_up() }
}

/// Steps from one moment along one direction.
struct Trial<'a> {
    pair: &'a MovingPair<'a>,
    here: Moment,
    direction: Vector,
    gap: f64,
    acceleration: f64,
    slack: f64,
    /// What the least gap has to exceed.
    needed: f64,
}

impl<'a> Trial<'a> {
    fn new(
        pair: &'a MovingPair<'a>,
        here: &Moment,
        direction: Vector,
        wanted: &Wanted,
        vertices: &mut [u32; 2],
    ) -> Trial<'a> {
        let slack = if wanted.with_slack { pair.slack(here) } else { 0.0 };
        let gap = pair.gap(here, &direction, vertices);
        let acceleration = pair.acceleration(&direction);
        Trial { pair, here: *here, direction, gap, acceleration, slack, needed: wanted.margin + slack }
    }

    fn room(&self) -> f64 {
        self.gap - self.needed
    }

    fn to(&mut self, there: &Moment, vertices: &mut [u32; 2]) -> FreeStep {
        let gaps = [self.gap, self.pair.gap(there, &self.direction, vertices)];
        let least = least_between(gaps, self.acceleration, there.time - self.here.time);
        FreeStep { ends: [self.here, *there], direction: self.direction, gaps, least, slack: self.slack }
    }
}

/// A guess at the gap to come, from what is known of it: room + speed·h + curve·h² beyond what is needed.
struct Forecast {
    room: f64,
    speed: f64,
    curve: f64,
    acceleration: f64,
}

/// A step ends so much before where the gap is forecast to close: of what only turns straight on that is right, and its gap closes
/// to the time tolerance in one step; of others that is a guess.
const SHARE_OF_ROOM: f64 = 1.0 / 64.0;

impl Forecast {
    /// The longest step up to a limit that is likely to be proved; no shorter than `shortest`.
    fn step(&self, limit: f64, shortest: f64) -> f64 {
        let mut length = limit;
        if let Some(root) = self.root() {
            let is_straight = self.acceleration == 0.0;
            let before = if is_straight { root - 0.5 * shortest } else { root * (1.0 - SHARE_OF_ROOM) };
            length = length.min(before);
        }
        // What the bend may take away from the chord has to leave something.
        while length > shortest {
            let end = self.room + self.speed * length + self.curve * length * length;
            if least_between([self.room, end], self.acceleration, length) > 0.0 {
                return length;
            }
            length *= 0.75;
        }
        shortest
    }

    /// Where it closes first.
    fn root(&self) -> Option<f64> {
        let Forecast { room, speed, curve, .. } = *self;
        let discriminant = speed * speed - 4.0 * curve * room;
        let steep = -speed + discriminant.sqrt();
        // NaN where it does not close.
        (discriminant >= 0.0 && steep > 0.0).then(|| 2.0 * room / steep)
    }

    /// By how much the gap has grown after a step, if it goes on as smoothly.
    fn learn_curve(&mut self, rise: f64, length: f64) {
        let curve = (rise / length - self.speed) / length;
        if curve.is_finite() {
            self.curve = curve;
        }
    }

    /// The same where other points come nearest soon, say of faces that are parallel: the gap then goes straight from here.
    fn learn_kink(&mut self, rise: f64, length: f64) {
        let speed = rise / length;
        if speed.is_finite() {
            (self.speed, self.curve) = (speed, 0.0);
        }
    }
}
