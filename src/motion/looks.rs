//! The first way of a cast: looks ahead, and one proof for all of it.
//!
//! A forecast proposes moments at which the distance is asked for, up to the end or next to contact; that proves nothing of what
//! lies between. Then the whole way is proved in one step along the last normal, or along the first, or along one that turns
//! (`bound.rs`); halves of it, at looks made before, only where that fails. Most casts need one step. Wherever this gets no
//! farther, the steps of a sweep go on from what is proved.

use super::bound::least_between;
use super::config::CastConfig;
use super::facet::Touch;
use super::forecast::Forecast;
use super::moving::{Moment, MovingPair};
use super::sweep::{BALL, Look, Sweep, after, upper_bound};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::pair::{Outcome, PairAnswer};

/// Looks after which the steps of a sweep go on.
pub(super) const MOST_LOOKS: u32 = 60;

/// Looks that are kept as ends of steps, and room for one more.
const MOST_KNOTS: usize = 24;

/// A look is at most this share of the way before the forecast contact; the first one, which knows no curve, a larger one.
const SHARE: f64 = 1.0 / 64.0;
const FIRST_SHARE: f64 = 1.0 / 16.0;

/// Contact that is forecast within so many time tolerances is looked for, and a look before it keeps so many.
const CLOSE: f64 = 0.55;
const BEFORE: f64 = 0.3;

/// Contact is looked for so many time tolerances behind where it is forecast, and then so many behind the last look.
const BEHIND: f64 = 0.35;
const LAST: f64 = 0.99;

/// A look at which the objects are farther apart than `max_distance`.
#[derive(Debug, Clone, Copy, Default)]
struct Knot {
    moment: Moment,
    /// The normal there,
    direction: Vector,
    /// how much farther apart than `max_distance` they are,
    room: f64,
    /// about how fast that grows,
    speed: f64,
    /// and the motion's gap along the normal, once it is asked for.
    gap: Option<f64>,
}

/// The outcome of the looks.
#[allow(clippy::large_enum_variant, reason = "one for each cast")]
pub(super) enum Way {
    /// The gap is more than `least` up to the end; 0 stands for `max_distance`.
    Free { least: f64 },
    /// Free up to the first time, where the contact was asked for; no farther apart than `max_distance` at the other.
    Hit { times: [f64; 2], contact: PairAnswer, shown: Shown },
    /// Free up to a moment, by `least`; nothing is said of what follows.
    Open { here: Moment, least: f64 },
}

/// The proof of a contact at a moment.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Shown {
    /// The distance of the motion there is at most this.
    pub upper: f64,
    /// Vertex pairs, in the caller's numbering, whose differences hold the origin there.
    pub proof: [[u32; 2]; 4],
    pub proof_count: u32,
}

impl Shown {
    /// By an answer about the poses there, of objects that are in contact.
    pub fn by(answer: &PairAnswer, there: &Moment, max_distance: f64) -> Shown {
        if max_distance > 0.0 {
            return Shown { upper: upper_bound(answer, there), ..Shown::default() };
        }
        Shown { upper: 0.0, proof: answer.proof, proof_count: answer.proof_count }
    }
}

/// The outcome of a proof of the way between looks.
enum WayProof {
    /// All of it.
    Whole,
    /// A look between found contact: what is behind it was dropped.
    Dropped,
    /// It got no farther.
    Stuck,
}

/// The end of the looks.
enum Next {
    /// To the end, or to a look from where one step reaches it.
    End,
    /// Next to contact, which is forecast at a time.
    Contact(f64),
    /// Nowhere in so many looks.
    Nowhere,
}

struct Looks<'a, 'b> {
    pair: &'a MovingPair<'a>,
    sweep: &'b mut Sweep<'a>,
    config: &'b CastConfig,
    /// In the order of times; the first `count` are there. The moment of the next is looked at where it is to stay.
    knots: [Option<Knot>; MOST_KNOTS + 1],
    count: usize,
    /// The way up to this one is proved,
    proved: usize,
    /// by the least of all gaps less what was needed.
    least: f64,
    /// The last step to the end, from the last look, left that.
    tail: Option<f64>,
    /// The last two answers; the one at `front` is about the look at `front_time`.
    answers: [PairAnswer; 2],
    front: usize,
    front_time: f64,
    /// The forecast from the last look,
    forecast: Option<Forecast>,
    /// and that from the one before, unless contact was found between.
    before: Option<Forecast>,
    /// A time at which they are not farther apart, as far as a look says.
    contact_by: Option<f64>,
    at_end: Option<Moment>,
}

/// The way from a moment, whose distance is asked for, to the end of the range; `at_end` may be known.
pub(super) fn look_ahead<'a>(
    pair: &'a MovingPair<'a>,
    sweep: &mut Sweep<'a>,
    start: &Moment,
    at_end: Option<Moment>,
    config: &CastConfig,
) -> Result<Way> {
    debug_assert!(start.time < config.time_end);
    let mut looks = Looks {
        pair,
        sweep,
        config,
        knots: [None; MOST_KNOTS + 1],
        count: 0,
        proved: 0,
        least: f64::INFINITY,
        tail: None,
        answers: [PairAnswer::default(); 2],
        front: 0,
        front_time: f64::NAN,
        forecast: None,
        before: None,
        contact_by: None,
        at_end,
    };
    looks.next().moment = *start;
    if !looks.look()? {
        looks.sweep.keep_sight(start.time, &looks.answers[1]);
        return Ok(Way::Open { here: *start, least: f64::INFINITY });
    }
    looks.add_last();
    looks.run()
}

impl Looks<'_, '_> {
    fn run(&mut self) -> Result<Way> {
        loop {
            let next = self.go_on()?;
            if matches!(next, Next::Nowhere) {
                break;
            }
            match self.prove()? {
                WayProof::Whole => {}
                WayProof::Dropped => continue,
                WayProof::Stuck => break,
            }
            let Next::Contact(root) = next else {
                return Ok(Way::Free { least: self.tail.map_or(self.least, |tail| self.least.min(tail)) });
            };
            if let Some((time, shown)) = self.contact_at(root)? {
                let times = [self.knot(self.proved).moment.time, time];
                let contact = self.answer_at(self.proved)?;
                return Ok(Way::Hit { times, contact, shown });
            }
            if !self.pass(root)? {
                break;
            }
        }
        Ok(Way::Open { here: self.knot(self.proved).moment, least: self.least })
    }

    fn knot(&self, k: usize) -> &Knot {
        self.knots[k].as_ref().expect("only those below the count are asked for")
    }

    /// The place of the next look.
    fn next(&mut self) -> &mut Knot {
        self.knots[self.count].get_or_insert_with(Knot::default)
    }

    /// Whether there is no room for another look.
    fn is_exhausted(&self) -> bool {
        self.count == MOST_KNOTS || self.sweep.queries >= MOST_LOOKS
    }

    /// Asks for the distance at the next moment; the answer is the one that is not at `front`. Whether they are farther apart than
    /// `max_distance`.
    fn look(&mut self) -> Result<bool> {
        let (pair, max_distance) = (self.pair, self.config.max_distance);
        let answer = &mut self.answers[1 - self.front];
        let knot = self.knots[self.count].as_mut().expect("its moment is set");
        self.sweep.ask(&knot.moment, answer)?;
        knot.room = answer.distance - max_distance;
        if answer.outcome != Outcome::Separated || !(answer.lower > max_distance && knot.room < f64::INFINITY) {
            return Ok(false);
        }
        knot.direction = Vector::from(answer.normal);
        knot.speed = pair.speed(&knot.moment, &knot.direction, answer)?;
        knot.gap = None;
        Ok(true)
    }

    /// Keeps the next look, which is the last then.
    fn add_last(&mut self) {
        self.before = self.forecast.take();
        (self.front, self.front_time) = (1 - self.front, self.knot(self.count).moment.time);
        self.count += 1;
    }

    /// The distance at a look.
    fn answer_at(&mut self, k: usize) -> Result<PairAnswer> {
        let here = &self.knots[k].as_ref().expect("only those below the count are asked for").moment;
        if self.front_time != here.time {
            self.sweep.ask(here, &mut self.answers[self.front])?;
        }
        Ok(self.answers[self.front])
    }

    /// The gap at one look along the normal of another.
    fn gap_between(&mut self, at: usize, along: usize) -> f64 {
        let [knot, other] =
            [at, along].map(|k| self.knots[k].as_ref().expect("only those below the count are asked for"));
        self.pair.gap(&knot.moment, &other.direction, &mut self.sweep.vertices)
    }

    fn gap_of(&mut self, k: usize) -> f64 {
        if let Some(gap) = self.knot(k).gap {
            return gap;
        }
        let gap = self.gap_between(k, k);
        if let Some(knot) = &mut self.knots[k] {
            knot.gap = Some(gap);
        }
        gap
    }

    fn needed(&self, moment: &Moment) -> f64 {
        self.config.max_distance + self.pair.slack(moment)
    }

    /// Sets the moment of the next look.
    fn move_to(&mut self, time: f64) -> Result<()> {
        let (pair, end) = (self.pair, self.config.time_end);
        if time < end {
            return pair.place_at(time, &mut self.next().moment);
        }
        let at_end = match self.at_end {
            Some(moment) => moment,
            None => *self.at_end.insert(pair.at(end)?),
        };
        self.next().moment = at_end;
        Ok(())
    }

    /// Looks on to the end, or next to contact.
    fn go_on(&mut self) -> Result<Next> {
        let (end, tolerance) = (self.config.time_end, self.config.time_tolerance);
        self.tail = None;
        loop {
            let last = self.count - 1;
            let time = self.knot(last).moment.time;
            if time >= end {
                return Ok(Next::End);
            }
            if self.is_exhausted() {
                return Ok(Next::Nowhere);
            }
            let forecast = self.forecast(last);
            // Infinite where the room does not close.
            let root = forecast.root().unwrap_or(f64::INFINITY);
            if root <= CLOSE * tolerance {
                return Ok(Next::Contact(time + root));
            }
            let share = forecast.share(root, if self.before.is_some() { SHARE } else { FIRST_SHARE });
            let nearly = time + (root - (share * root).max(BEFORE * tolerance));
            let limit = self.contact_by.map_or(end, |contact| 0.5 * (time + contact));
            // Without a root that is infinite or a NaN.
            let next = if nearly < limit { nearly } else { limit };
            if next - time < 0.05 * tolerance {
                return Ok(Next::Contact(time + 0.5 * tolerance));
            }
            self.move_to(next)?;
            if next >= end {
                self.tail = self.rest(last);
                if self.tail.is_some() {
                    return Ok(Next::End);
                }
            }
            // A forecast that was good is better than the gap along a normal that keeps still: a turning face sticks out of that.
            let is_trusted = share > 0.0 && share < SHARE;
            if !is_trusted {
                self.stop_where_it_closes(last, root)?;
            }
            if self.look()? {
                self.add_last();
            } else {
                (self.contact_by, self.before) = (Some(self.next().moment.time), None);
            }
        }
    }

    fn forecast(&mut self, last: usize) -> Forecast {
        let Knot { moment, direction, room, speed, .. } = self.knot(last);
        let acceleration = self.pair.acceleration(direction);
        let forecast = Forecast::new(moment.time, *room, *speed, acceleration, self.before.as_ref());
        *self.forecast.insert(forecast)
    }

    /// One step from the last look to the end along the normal here takes no query: by how much it is free.
    fn rest(&mut self, last: usize) -> Option<f64> {
        let needed = self.needed(&self.knot(last).moment);
        let gap = self.gap_between(last + 1, last);
        if !(gap > needed) {
            return None;
        }
        let gaps = [self.gap_of(last), gap];
        self.least_in_step([last, last + 1], [last; 2], gaps, needed)
    }

    /// Where the gap along the normal here has closed by the next look, objects may intersect there, and that look would be dear:
    /// the look is where the gap's chord closes instead.
    fn stop_where_it_closes(&mut self, last: usize, root: f64) -> Result<()> {
        let Knot { moment: Moment { time, .. }, room, .. } = *self.knot(last);
        let next = self.knot(last + 1).moment.time;
        let (length, tolerance) = (next - time, self.config.time_tolerance);
        if length <= 4.0 * tolerance {
            return Ok(());
        }
        let gap = self.gap_between(last + 1, last) - self.config.max_distance;
        let sooner = length * room / (room - gap);
        if gap > 0.0 || !(root == f64::INFINITY || sooner > 0.5 * root) {
            return Ok(());
        }
        let time = time + sooner.max(BEFORE * tolerance);
        if time < next { self.move_to(time) } else { Ok(()) }
    }

    /// Proves the way from what is proved to the last look.
    fn prove(&mut self) -> Result<WayProof> {
        // The looks that steps are still to end at, the nearest last.
        let (mut ends, mut open) = ([0; MOST_KNOTS], 1);
        ends[0] = self.count - 1;
        while open > 0 {
            let to = ends[open - 1];
            if to == self.proved {
                open -= 1;
                continue;
            }
            if let Some(least) = self.step(to) {
                self.least = self.least.min(least);
                (self.proved, open) = (to, open - 1);
                continue;
            }
            if to - self.proved > 1 {
                ends[open] = self.proved + (to - self.proved) / 2;
                open += 1;
                continue;
            }
            let [from, until] = [self.proved, to].map(|k| self.knot(k));
            let length = until.moment.time - from.moment.time;
            if length < 0.5 * self.config.time_tolerance || self.is_exhausted() {
                return Ok(WayProof::Stuck);
            }
            // Where they come nearest, if that is between.
            let part = if from.speed < 0.0 && until.speed > 0.0 {
                (-from.speed / (until.speed - from.speed)).clamp(0.2, 0.8)
            } else {
                0.5
            };
            let between = from.moment.time + part * length;
            self.move_to(between)?;
            if !self.look()? {
                (self.count, self.contact_by, self.before) = (to, Some(between), None);
                return Ok(WayProof::Dropped);
            }
            self.knots[to..=self.count].rotate_right(1);
            self.count += 1;
            ends[..open].iter_mut().for_each(|end| *end += 1);
            ends[open] = to;
            open += 1;
        }
        Ok(WayProof::Whole)
    }

    /// One step from what is proved to a later look: by how much it is free.
    fn step(&mut self, to: usize) -> Option<f64> {
        let from = self.proved;
        let needed = self.needed(&self.knot(from).moment);
        let last = self.gap_of(to);
        if !(last > needed) {
            return None;
        }
        let along_last = [self.gap_between(from, to), last];
        if let Some(least) = self.least_in_step([from, to], [to; 2], along_last, needed) {
            return Some(least);
        }
        let first = self.gap_of(from);
        if !(first > needed) {
            return None;
        }
        let along_first = [first, self.gap_between(to, from)];
        self.least_in_step([from, to], [from; 2], along_first, needed)
            .or_else(|| self.least_in_step([from, to], [from, to], [first, last], needed))
    }

    /// The least gap between two looks, by those at both along the normals of looks, less what is needed; if anything is left.
    fn least_in_step(&self, ends: [usize; 2], along: [usize; 2], gaps: [f64; 2], needed: f64) -> Option<f64> {
        let sag = self.pair.sag(ends.map(|k| &self.knot(k).moment), along.map(|k| &self.knot(k).direction));
        let least = least_between(gaps, sag) - needed;
        (least > 0.0).then_some(least)
    }

    /// Contact within a time tolerance of the last look, about at a time.
    fn contact_at(&mut self, root: f64) -> Result<Option<(f64, Shown)>> {
        let last = self.count - 1;
        let begin = self.knot(last).moment.time;
        let CastConfig { time_end, time_tolerance, max_distance, .. } = *self.config;
        let latest = after(begin, LAST * time_tolerance).min(time_end);
        let times = [(root + BEHIND * time_tolerance).min(latest), latest];
        let by_facet = max_distance == 0.0 && self.pair.swept() == 0.0;
        for (k, time) in times.into_iter().enumerate() {
            if !(time > begin) || (k == 1 && time == times[0] && !by_facet) {
                continue;
            }
            self.move_to(time)?;
            let (polyhedra, here, there) = (self.pair.polyhedra(), self.knot(last), &self.knot(last + 1).moment);
            let touch = Touch { polyhedra, here: &here.moment, direction: &here.direction, there };
            if by_facet
                && let Some((pairs, ball)) = touch.enclosure()
                && ball > BALL * there.rounding
            {
                let labels = polyhedra.map(|polyhedron| &polyhedron.vertex_labels);
                let proof = pairs.map(|[v, w]| [labels[0][v as usize], labels[1][w as usize]]);
                return Ok(Some((time, Shown { upper: 0.0, proof, proof_count: 4 })));
            }
            // A verdict is dear: where a facet may show it, only of the later time.
            let there = &self.knots[last + 1].as_ref().expect("it was set").moment;
            if (k == 1 || !by_facet)
                && let Look::Contact(answer) = self.sweep.look(there, max_distance)?
            {
                return Ok(Some((time, Shown::by(&answer, there, max_distance))));
            }
        }
        Ok(None)
    }

    /// Whether the way is free beyond where contact was forecast.
    fn pass(&mut self, root: f64) -> Result<bool> {
        let begin = self.knot(self.count - 1).moment.time;
        let time = after(begin, LAST * self.config.time_tolerance).min(self.config.time_end);
        if self.is_exhausted() || !(time > begin) || !root.is_finite() {
            return Ok(false);
        }
        self.move_to(time)?;
        if !self.look()? {
            return Ok(false);
        }
        self.add_last();
        self.contact_by = None;
        let Some(least) = self.step(self.count - 1) else { return Ok(false) };
        (self.least, self.proved) = (self.least.min(least), self.count - 1);
        Ok(true)
    }
}
