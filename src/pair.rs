//! Pair queries: pure functions of two immutable shapes, two poses and a small cache that the caller owns.

mod cache;
mod config;
mod levels;

pub use cache::PairCache;
pub(crate) use config::check_accuracy;
pub use config::{Bounds, Levels, PairConfig, Start};

pub use crate::answer::{Feature, FeatureKind, Outcome, PairAnswer, Statistics, Status};
use crate::certificate::{Certify, CloserLook, Gap, Interval, Minimum, reciprocal_length};
use crate::contact;
use crate::contact_direction::contact_direction;
pub use crate::descent::Refinement;
use crate::descent::{Leveled, Place};
use crate::enclosure::encloses_origin;
use crate::error::Result;
use crate::frame::{Frame, RIGID_TOGETHER};
use crate::marching::{self, March, Step};
use crate::math::{Pose, ROTATION_LIMIT, Vector, clamp};
use crate::overlap::{self, Decision, Pairs, Wanted};
use crate::polyhedron::Polyhedron;
use crate::separating_axis::{self, NUDGE, Search, Trial};
use crate::shape::Shape;
use crate::simd::{self, Kernel, Lanes, Portable, Work};
use crate::start::{self, Beginning, Guess};
use crate::state::State;
use cache::bits;
use config::check_config;

/// What is asked of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Query {
    Intersection,
    Distance,
    Contact,
    Approximate,
}

/// Exact distance with its interval, witness points, normal and features.
///
/// Of an intersecting pair the distance and its interval are 0, `proof` holds the vertex pairs; points, normal and features are
/// not said (see [`contact()`]). Of a pair beyond `config.distance_tolerance` only `lower` is said.
///
/// # Errors
/// [`Error::Pose`](crate::error::Error::Pose) for a pose that is not accepted (not finite, a reflection, an entry of RᵀR − I
/// above `config.rotation_limit`), [`Error::Argument`](crate::error::Error::Argument) for a tolerance or limit that is NaN or
/// negative. Then `answer` and `cache` are as they were.
pub fn distance(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query(Query::Distance, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// The verdict alone: [`Outcome::Separated`] with `lower` > 0 and a valid but not tight `upper`, or [`Outcome::Intersecting`].
///
/// # Errors
/// As [`distance`].
pub fn intersection(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query(Query::Intersection, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// As [`distance`], and for an intersecting pair a common point (as witness points of both objects), a unit normal along which
/// the objects overlap little (where they only touch along a face it separates them) and features: those that hold the point, or if
/// it is deep inside an object the face of it that reaches farthest along the normal.
///
/// # Errors
/// As [`distance`].
pub fn contact(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query(Query::Contact, [shape1, shape2], [pose1, pose2], cache, config, answer)
}

/// The distance as narrow as asked for and no narrower: the interval holds the true distance, and the query stops as soon as
/// `upper − lower` ≤ max(`config.absolute_error`, `config.relative_error` · `lower`). Both 0 ask for the exact distance.
///
/// The verdict is as certain as that of [`distance`], unless the step budget ran out ([`Status::BudgetSpent`]). Points and
/// features are not said of an answer that comes from levels of detail. Of a pair beyond `config.distance_tolerance` only
/// `lower` is said.
///
/// # Errors
/// As [`distance`]; [`Error::Argument`](crate::error::Error::Argument) for an error tolerance that is NaN or negative and a
/// step budget of 0.
pub fn approximate(
    shape1: &Shape,
    pose1: &Pose,
    shape2: &Shape,
    pose2: &Pose,
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    levels::approximate([shape1, shape2], [pose1, pose2], cache, config, answer)
}

#[inline(always)]
fn query(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if config.distance_tolerance < f64::INFINITY {
        // Arrays of their own: those lent to it would have to live in memory here, too.
        let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
        return query_with_tolerance(query, shapes, poses, cache, config, answer);
    }
    let asks_verdict = (query == Query::Intersection) & (config.distance_tolerance == f64::INFINITY);
    query_beyond(query, asks_verdict.then_some(0.0), shapes, poses, cache, config, answer)
}

/// Out of line, with all that follows: mostly there is no tolerance.
#[inline(never)]
fn query_with_tolerance(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    query_beyond(query, Some(config.distance_tolerance), shapes, poses, cache, config, answer)
}

/// A query that needs to know no more than that the bodies are farther apart than is `enough`, if they are.
#[inline(always)]
fn query_beyond(
    query: Query,
    enough: Option<f64>,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    // Made in place and lent: moving it would copy pairs of pointers just written as one, which stalls.
    let mut pair = PairQuery { query, polyhedra, poses, cache, config, answer };
    if let Some(enough) = enough
        && pair.is_farther_than(enough)
    {
        return Ok(());
    }
    if (query == Query::Intersection) && levels::help_verdicts(shapes, config) {
        // Arrays of their own: those lent to it would have to live in memory here, too.
        let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
        return levels::of_large(query, shapes, poses, pair.cache, config, pair.answer);
    }
    let is_common = polyhedra[0].ordinary & polyhedra[1].ordinary & config.start.asks_cache();
    // A NaN is not.
    if is_common & (config.distance_tolerance >= 0.0) & (config.rotation_limit >= RIGID_TOGETHER) {
        if query == Query::Intersection
            && pair.cache.recall_axis(polyhedra).is_some()
            && simd::dispatch(&mut Separation { pair: &mut pair })
        {
            return Ok(());
        }
        match simd::dispatch(&mut Coherent { pair: &mut pair }) {
            Attempt::Done => Ok(()),
            attempt => pair.go_on(attempt, shapes),
        }
    } else {
        pair.begin(shapes)
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The common case: marching, certified
// ---------------------------------------------------------------------------------------------------------------------

/// What became of an attempt.
enum Attempt {
    /// The answer is there.
    Done,
    /// Marching left it open at this state, or its certificate did at a minimum.
    Open { at: State, is_minimum: bool, steps: u32 },
    /// The cache holds no features.
    Cold,
    /// Poses that are not rigid or not of ordinary magnitude.
    Unusual,
}

/// One query.
struct PairQuery<'a> {
    query: Query,
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    cache: &'a mut PairCache,
    config: &'a PairConfig,
    answer: &'a mut PairAnswer,
}

/// The common case, for [ordinary](Polyhedron::ordinary) bodies: the cached features still are the nearest. One state, straight
/// through to the answer, without the loop that would keep so much in registers.
struct Coherent<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for Coherent<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        if !frame.usual {
            return Attempt::Unusual;
        }
        let Some(state) = State::checked(cache.kind, cache.indices, polyhedra) else { return Attempt::Cold };
        let mut judge = Acceptance { query, config, cache, answer, accepted: false };
        let step = marching::visit(&frame, state, &mut judge);
        if judge.accepted {
            judge.answer.statistics = Statistics { marching_steps: 1, ..Statistics::default() };
            return Attempt::Done;
        }
        match step {
            Step::Minimum => Attempt::Open { at: state, is_minimum: true, steps: 1 },
            Step::Move(next) | Step::Behind(next) | Step::Crossing(next) => {
                L::out_of_line(&mut MarchOn { pair: self.pair, frame, start: next, steps: 1, limit: TRIAL_STEPS })
            }
        }
    }
}

impl PairQuery<'_> {
    /// Whether the bounding spheres of [ordinary](Polyhedron::ordinary) bodies, whose centres are their origins, are farther apart
    /// than is enough; the answer then says so, and the cache stays as it is. NaN is for others to refuse.
    #[inline(always)]
    fn is_farther_than(&mut self, enough: f64) -> bool {
        let &mut PairQuery { polyhedra: [body1, body2], poses: [pose1, pose2], .. } = self;
        let reach = body1.radius + body2.radius + enough;
        let [x, y, z] = [0, 1, 2].map(|i| pose1.rows[i][3] - pose2.rows[i][3]);
        (x * x + y * y + z * z > reach * reach) & (enough >= 0.0) & (body1.ordinary & body2.ordinary)
            && simd::dispatch(&mut Spheres { pair: self, enough })
    }
}

/// Bounding spheres that seem farther apart than is enough.
struct Spheres<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
    enough: f64,
}

impl Kernel for Spheres<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let &mut PairQuery { polyhedra, poses, config, ref mut answer, .. } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        let interval = separating_axis::between_spheres(&frame);
        if !(frame.usual & (config.rotation_limit >= RIGID_TOGETHER) & (interval.lower > self.enough)) {
            return false;
        }
        answer.status = Status::BoundingSpheres;
        answer.statistics = Statistics::default();
        set_interval(answer, &interval, frame.separation, config.distance_tolerance);
        let offset = frame.bodies[0].offset;
        contact::fill_normal(answer, offset.mul(L::splat(reciprocal_length(offset.dot(offset)))));
        true
    }
}

/// The common case of the verdict alone: the axis of the last query separates, or nearly.
struct Separation<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for Separation<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let &mut PairQuery { polyhedra, poses, ref mut cache, config, ref mut answer, .. } = self.pair;
        let frame = Frame::<L>::of_rigid(polyhedra, poses);
        let Some(axis) = cache.recall_axis(polyhedra) else { return false };
        if !frame.usual {
            return false;
        }
        let trial = Trial::of_axis(&frame, &axis);
        if trial.separates() && trial.interval.settles(config.distance_tolerance) {
            cache.pairs[0] = trial.vertices;
            fill_trial(&trial, config, answer);
            return true;
        }
        let mut search = Search { frame: &frame, trial };
        L::out_of_line(&mut search);
        let trial = &search.trial;
        let is_answer = trial.separates() && trial.interval.settles(config.distance_tolerance);
        if is_answer {
            let unit = trial.direction.mul(L::splat(trial.inverse));
            cache.remember_axis(trial.vertices, frame.bodies[0].rotate_back(unit).to_vector());
            fill_trial(trial, config, answer);
        }
        is_answer
    }
}

/// The answer of an axis that separates.
#[inline(always)]
fn fill_trial<L: Lanes>(trial: &Trial<L>, config: &PairConfig, answer: &mut PairAnswer) {
    answer.status = Status::Coherent;
    answer.statistics = Statistics { marching_steps: trial.steps, ..Statistics::default() };
    set_interval(answer, &trial.interval, trial.distance, config.distance_tolerance);
    contact::fill_normal(answer, trial.direction.mul(L::splat(trial.inverse)));
}

/// Marching from the cache is given up for a new start after this many steps: the pair has jumped without being noticed.
const TRIAL_STEPS: u32 = 16;

/// Marching from a state to the end.
struct MarchOn<'a, 'b, L> {
    pair: &'a mut PairQuery<'b>,
    frame: Frame<'b, L>,
    start: State,
    /// Those made before.
    steps: u32,
    /// For the first leg: [`TRIAL_STEPS`] from a cache, else [`step_limit`].
    limit: u32,
}

impl<L: Lanes> Work for MarchOn<'_, '_, L> {
    type Output = Attempt;

    #[inline(always)]
    fn run(&mut self) -> Attempt {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self.pair;
        let mut judge = Acceptance { query, config, cache, answer, accepted: false };
        let (mut state, mut steps, mut limit) = (self.start, self.steps, self.limit);
        let frame = self.frame;
        if limit == TRIAL_STEPS && has_jumped(&frame, &judge.cache.marker) && config.start != Start::Cache {
            let beginning = start::anew(polyhedra, poses, true);
            state = State::vertex_vertex(beginning.vertices);
            limit = step_limit(polyhedra);
            if beginning.guess == Guess::Overlapping {
                return Attempt::Open { at: state, is_minimum: false, steps };
            }
        }
        let (at, is_minimum) = loop {
            let (march, more) = marching::march(&frame, state, limit, &mut judge);
            steps += more;
            state = match march {
                March::Minimum(at) => break (at, true),
                March::Open(at) => break (at, false),
                March::Limit(at) if limit != TRIAL_STEPS => break (at, false),
                March::Limit(at) if config.start == Start::Cache => at,
                March::Limit(_) => State::vertex_vertex(start::anew(polyhedra, poses, true).vertices),
            };
            limit = step_limit(polyhedra);
        };
        if !judge.accepted {
            return Attempt::Open { at, is_minimum, steps };
        }
        judge.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
        // A pair that stays on its features keeps its old marker: they are near.
        judge.cache.marker = bits(frame.marker().0.to_vector());
        Attempt::Done
    }
}

/// The general case: any bodies, poses and caches.
struct General<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
    /// Where to start if the cache holds no features, if that is known.
    beginning: Option<Beginning>,
}

impl Kernel for General<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut PairQuery { polyhedra, poses, ref cache, config, .. } = self.pair;
        let frame = Frame::<L>::new(polyhedra, poses, config.most_skew());
        if !frame.usual {
            return Attempt::Unusual;
        }
        let (start, limit) = match State::checked(cache.kind, cache.indices, polyhedra) {
            Some(state) => (state, TRIAL_STEPS),
            None => {
                let beginning = match self.beginning {
                    Some(beginning) => beginning,
                    None => start::anew(polyhedra, poses, config.start != Start::Cold),
                };
                let state = State::vertex_vertex(beginning.vertices);
                if beginning.guess == Guess::Overlapping {
                    return Attempt::Open { at: state, is_minimum: false, steps: 0 };
                }
                (state, step_limit(polyhedra))
            }
        };
        // A segment or a point has no faces to march over.
        if polyhedra[0].dimension.min(polyhedra[1].dimension) < 2 {
            return Attempt::Open { at: start, is_minimum: false, steps: 0 };
        }
        L::out_of_line(&mut MarchOn { pair: self.pair, frame, start, steps: 0, limit })
    }
}

/// Accepts a minimum whose interval is good enough: answer and cache are then written.
struct Acceptance<'a> {
    query: Query,
    config: &'a PairConfig,
    cache: &'a mut PairCache,
    answer: &'a mut PairAnswer,
    accepted: bool,
}

impl<L: Lanes> Certify<L> for Acceptance<'_> {
    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        let gap = minimum.gap(frame);
        self.accepted = self.is_enough(frame.size, &gap.interval);
        if self.accepted {
            self.fill(frame, state, minimum, &gap);
        }
    }
}

impl Acceptance<'_> {
    /// Whether an interval answers the query.
    #[inline(always)]
    fn is_enough(&self, size: f64, interval: &Interval) -> bool {
        let is_narrow = interval.is_tight(size)
            || match self.query {
                // Without an upper bound a witness point may lie out of its body.
                Query::Approximate => {
                    interval.upper < f64::INFINITY && self.config.accuracy().is_met_by(interval.lower, interval.upper)
                }
                Query::Intersection => interval.lower > 0.0,
                Query::Distance | Query::Contact => {
                    self.config.bounds == Bounds::Verdict && interval.lower > 0.0 && interval.upper < f64::INFINITY
                }
            };
        is_narrow && interval.settles(self.config.distance_tolerance)
    }

    /// Answer, but for the statistics, and cache from a minimum.
    #[inline(always)]
    fn fill<L: Lanes>(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>, gap: &Gap) {
        let answer = &mut *self.answer;
        let normal = minimum.direction.mul(L::splat(minimum.inverse));
        self.cache.remember_state(state);
        answer.status = Status::Marched;
        set_interval(answer, &gap.interval, gap.distance, self.config.distance_tolerance);
        if self.query != Query::Intersection && answer.outcome == Outcome::Separated {
            contact::fill_separated(answer, frame, minimum.points, minimum.rotated, normal, state.features());
        } else {
            contact::fill_normal(answer, normal);
        }
        if self.query == Query::Intersection {
            let nudged = frame.bodies[0].offset.mul_add(L::splat(NUDGE / frame.separation), normal);
            let direction = frame.bodies[0].rotate_back(nudged).to_vector();
            self.cache.remember_axis(state.vertices(frame.polyhedra()), direction);
        }
    }
}

/// A minimum that a quick look leaves open, looked at more closely, as [`CloserLook`] does.
struct Closely<'a, const BETWEEN_PLANES: bool> {
    judge: Acceptance<'a>,
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    at: State,
}

impl<const BETWEEN_PLANES: bool> Kernel for Closely<'_, BETWEEN_PLANES> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        let mut closer = CloserLook::<L, BETWEEN_PLANES> { found: None };
        marching::march(&frame, self.at, 1, &mut closer);
        if let Some((minimum, gap)) = &closer.found {
            self.judge.accepted = self.judge.is_enough(frame.size, &gap.interval);
            if self.judge.accepted {
                self.judge.fill(&frame, self.at, minimum, gap);
            }
        }
    }
}

/// More steps than any start needs; only cycles that the cycle detection misses meet it.
#[inline(always)]
fn step_limit(polyhedra: [&Polyhedron; 2]) -> u32 {
    64 + polyhedra[0].vertices.len().max(polyhedra[1].vertices.len()) as u32
}

// What follows is out of line, for the sake of the registers of the common case.

/// Whether the pair has moved so far that the tables know better than the last features where to start. Not for garbage.
#[inline(always)]
fn has_jumped<L: Lanes>(frame: &Frame<L>, last: &[u32; 3]) -> bool {
    let [first, second] = frame.polyhedra();
    has_moved(frame, last, first.lookup.reach * second.lookup.reach)
}

/// Whether the pair has moved so far that a tetrahedron around the origin is no better to begin with than a pair from the tables:
/// by half a radian. (Of fat bodies at random poses the pair saves a tenth of the instructions, at 10° it costs a tenth.)
#[inline(always)]
fn has_turned_away<L: Lanes>(frame: &Frame<L>, last: &[u32; 3]) -> bool {
    has_moved(frame, last, 0.25)
}

/// The square of an angle.
const RADIAN: f64 = 1.0;

/// Whether the square of the angle by which the pair has moved is more than so much.
#[inline(always)]
fn has_moved<L: Lanes>(frame: &Frame<L>, last: &[u32; 3], square: f64) -> bool {
    let (marker, lever) = frame.marker();
    let [x, y, z] = *last;
    let last = Vector::new(f32::from_bits(x).into(), f32::from_bits(y).into(), f32::from_bits(z).into());
    let moved = marker.sub(L::from_vector(&last));
    moved.dot(moved) > lever * lever * square
}

/// Outcome, interval and best estimate (`distance`, put into the interval) of a separated pair. The interval settles the
/// tolerance: its upper end is beyond it just where the true distance is.
#[inline(always)]
fn set_interval(answer: &mut PairAnswer, interval: &Interval, distance: f64, distance_tolerance: f64) {
    answer.lower = interval.lower;
    answer.proof_count = 0;
    if interval.upper > distance_tolerance {
        answer.outcome = Outcome::Beyond;
        answer.upper = f64::INFINITY;
        answer.distance = interval.lower;
    } else {
        answer.outcome = Outcome::Separated;
        answer.upper = interval.upper;
        answer.distance = clamp(distance, interval.lower, interval.upper);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The rest: proofs re-tested, fallback, exact tier
// ---------------------------------------------------------------------------------------------------------------------

impl PairQuery<'_> {
    /// The whole query, for what is not the common case from the start.
    #[cold]
    fn begin(&mut self, shapes: [&Shape; 2]) -> Result<()> {
        check_config(self.config)?;
        if !self.config.start.asks_cache() {
            self.forget()?;
        }
        self.go_on(Attempt::Unusual, shapes)
    }

    fn check_poses(&self) -> Result<()> {
        self.poses.iter().try_for_each(|pose| pose.check(self.config.most_skew()))
    }

    /// Clears the cache, unless the poses are refused: who is refused finds nothing changed.
    fn forget(&mut self) -> Result<()> {
        self.check_poses()?;
        *self.cache = PairCache::default();
        Ok(())
    }

    /// The rest of a query whose first attempt did not answer it.
    #[inline(never)]
    fn go_on(&mut self, attempt: Attempt, shapes: [&Shape; 2]) -> Result<()> {
        let polyhedra = self.polyhedra;
        let attempt = match attempt {
            Attempt::Unusual | Attempt::Cold => {
                if self.config.levels == Levels::All {
                    return self.descend(shapes);
                }
                if let Some(pairs) = self.cache.recall_pairs(polyhedra) {
                    return self.decide(pairs, 0);
                }
                simd::dispatch(&mut General { pair: self, beginning: None })
            }
            open => open,
        };
        self.end(attempt)
    }

    /// What an attempt at the bodies themselves left open is decided.
    fn end(&mut self, attempt: Attempt) -> Result<()> {
        match self.settle(attempt) {
            None => Ok(()),
            Some((at, steps)) => self.decide(Pairs::new(&[at.vertices(self.polyhedra)]), steps),
        }
    }

    /// What an attempt left open, after a closer look: where to go on and the steps made so far.
    fn settle(&mut self, attempt: Attempt) -> Option<(State, u32)> {
        match attempt {
            Attempt::Done => None,
            Attempt::Open { at, is_minimum: true, steps } if self.closely(at, steps) => None,
            Attempt::Open { at, steps, .. } => Some((at, steps)),
            Attempt::Unusual | Attempt::Cold => Some((State::vertex_vertex([0, 0]), 0)),
        }
    }

    /// Decides what marching left open; `hint` are vertex pairs to begin with, those of an intersection from the cache or one
    /// that marching came to, `steps` those made so far.
    #[inline(never)]
    fn decide(&mut self, mut hint: Pairs, steps: u32) -> Result<()> {
        let &mut PairQuery { query, polyhedra, poses, config, .. } = self;
        let frame = Frame::<Portable>::new(polyhedra, poses, config.most_skew());
        let frame = frame.usual.then_some(frame);
        if frame.is_none() {
            self.check_poses()?;
        }
        let mut statistics = Statistics { marching_steps: steps, ..Statistics::default() };
        // The tetrahedron of the last query: if it still encloses the origin, that is a proof.
        if let Some(frame) = &frame
            && let Some(weights) = encloses_origin(frame, hint.as_slice())
        {
            let decision = Decision::Intersecting { pairs: hint, weights };
            self.answer.statistics = statistics;
            self.answer.status = Status::Coherent;
            self.fill(&decision);
            return Ok(());
        }
        // Bodies that intersected the last time and have jumped apart are for marching. Those whose cores overlap have not, and
        // up to a radian the last tetrahedron is the better hint (of fat bodies at 5° to 45° it saves 15 to 5 of 100
        // instructions).
        if let Some(frame) = &frame
            && config.start != Start::Cache
            && self.cache.recall_pairs(polyhedra).is_some()
            && has_jumped(frame, &self.cache.marker)
            && (has_moved(frame, &self.cache.marker, RADIAN) || !start::do_cores_overlap(polyhedra, poses))
        {
            let beginning = start::anew(polyhedra, poses, true);
            if has_turned_away(frame, &self.cache.marker) {
                hint = Pairs::new(&[beginning.vertices]);
            }
            if beginning.guess == Guess::Apart {
                let attempt = simd::dispatch(&mut General { pair: self, beginning: Some(beginning) });
                match self.settle(attempt) {
                    None => return Ok(()),
                    Some((at, steps)) => {
                        hint = Pairs::new(&[at.vertices(polyhedra)]);
                        statistics.marching_steps = steps;
                    }
                }
            }
        }
        // Cheap bounds or not, nearest points are to be nearest.
        let tight = query != Query::Intersection || config.distance_tolerance < f64::INFINITY;
        let wanted = Wanted { tight, distance_tolerance: config.distance_tolerance };
        let (decision, work) = overlap::decide(polyhedra, poses, frame.is_some(), hint.as_slice(), wanted);
        let overlap::Work { fallback_iterations, exact_iterations } = work;
        statistics.fallback_iterations = fallback_iterations;
        statistics.exact_iterations = exact_iterations;
        self.answer.statistics = statistics;
        self.answer.status = if exact_iterations > 0 { Status::Exact } else { Status::Fallback };
        self.fill(&decision);
        if let Some(frame) = &frame {
            self.cache.marker = bits(frame.marker().0.to_vector());
        }
        Ok(())
    }

    /// Whether a closer look at a minimum accepts it.
    fn closely(&mut self, at: State, steps: u32) -> bool {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self;
        let judge = Acceptance { query, config, cache, answer, accepted: false };
        let mut look = Closely::<false> { judge, polyhedra, poses, at };
        simd::dispatch(&mut look);
        let mut accepted = look.judge.accepted;
        if !accepted {
            let mut look = Closely::<true> { judge: look.judge, polyhedra, poses, at };
            simd::dispatch(&mut look);
            accepted = look.judge.accepted;
        }
        if accepted {
            self.answer.statistics = Statistics { marching_steps: steps, ..Statistics::default() };
            if steps > 1 {
                self.remember_marker();
            }
        }
        accepted
    }

    fn remember_marker(&mut self) {
        let frame = Frame::<Portable>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        self.cache.marker = bits(frame.marker().0.to_vector());
    }

    /// Answer and cache from a decision.
    fn fill(&mut self, decision: &Decision) {
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, ref mut answer } = self;
        match decision {
            Decision::Separated { points, direction, interval, pairs } => {
                set_interval(answer, interval, 0.5 * interval.lower + 0.5 * interval.upper, config.distance_tolerance);
                let vertices = State::vertex_vertex(pairs.as_slice()[0]);
                if query == Query::Intersection {
                    // The points need not be nearest, so no feature need hold them, and to search all takes long.
                    cache.remember_state(vertices);
                } else {
                    let features = contact::features_of_pairs(polyhedra, poses, pairs.as_slice(), points, direction);
                    cache.remember_state(State::of_features(features).unwrap_or(vertices));
                    if answer.outcome == Outcome::Separated {
                        contact::fill_placed(answer, polyhedra, poses, points, direction, features);
                        return;
                    }
                }
                contact::fill_nothing(answer);
                answer.normal = contact::normalised(direction);
            }
            Decision::Intersecting { pairs, weights } => {
                cache.remember_pairs(pairs.as_slice());
                answer.outcome = Outcome::Intersecting;
                answer.distance = 0.0;
                answer.lower = 0.0;
                answer.upper = 0.0;
                contact::fill_proof(answer, polyhedra, pairs.as_slice());
                if query == Query::Contact {
                    let overlap = &contact_direction(polyhedra, poses, pairs.as_slice());
                    let weights = contact::refined_weights(polyhedra, poses, pairs.as_slice(), *weights);
                    let points = overlap::combinations(polyhedra, pairs.as_slice(), &weights);
                    let features = contact::features_of_overlap(polyhedra, poses, pairs.as_slice(), &points, overlap);
                    contact::fill_placed(answer, polyhedra, poses, &points, &overlap.direction, features);
                } else {
                    contact::fill_nothing(answer);
                }
            }
        }
    }
}
