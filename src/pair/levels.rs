//! Queries through levels of detail, and those with a step budget: the search among the levels, then the bodies themselves
//! where that is needed, and where the next query is to start.

use super::attempt::{MarchOn, step_limit};
use super::config::{check_accuracy, check_config};
use super::{
    Attempt, Levels, Outcome, PairAnswer, PairCache, PairConfig, PairQuery, Query, Start, Statistics, Status,
    set_interval,
};
use crate::base::error::Result;
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::base::simd::{self, Kernel, Lanes, Portable};
use crate::levels::hierarchy::{HierarchyKind, Level};
use crate::pair::contact;
use crate::pair::descent::{Accuracy, Descended, Descent, Found, Leveled, Place, TRIAL_STEPS};
use crate::pair::start;
use crate::polyhedron::Polyhedron;
use crate::shape::Shape;
use crate::solve::certificate::Interval;
use crate::solve::decide::Decision;
use crate::solve::enclosure::encloses_origin;
use crate::solve::frame::Frame;
use crate::solve::gjk::{self, Nearest, Simplex};
use crate::solve::state::State;
use crate::solve::voronoi::climb;

/// See [`super::approximate`].
#[inline(always)]
pub(super) fn approximate(
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    if !((config.absolute_error >= 0.0) & (config.relative_error >= 0.0) & (config.step_budget > 0)) {
        check_accuracy(config.absolute_error, config.relative_error, config.step_budget)?;
    }
    let is_large =
        are_large(shapes, MANY_VERTICES) && (config.levels == Levels::Automatic) & !seem_to_intersect(cache, config);
    if is_large | (config.levels == Levels::All) {
        let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
        let mut pair = PairQuery { query: Query::Approximate, polyhedra, poses, cache, config, answer };
        if pair.is_answered_by_last_levels(shapes) {
            return Ok(());
        }
    }
    if is_large {
        let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
        return of_large(Query::Approximate, shapes, poses, cache, config, answer);
    }
    if config.step_budget == u32::MAX && config.levels != Levels::All {
        return super::query(Query::Approximate, shapes, poses, cache, config, answer);
    }
    // Arrays of their own: those lent to it would have to live in memory here, too.
    let (shapes, poses) = ([shapes[0], shapes[1]], [poses[0], poses[1]]);
    through_levels(Query::Approximate, shapes, poses, cache, config, answer)
}

fn through_levels(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    check_config(config)?;
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    let mut pair = PairQuery { query, polyhedra, poses, cache, config, answer };
    if pair.is_farther_than(enough(query, config)) {
        return Ok(());
    }
    pair.begin_descent(shapes)
}

#[inline(always)]
fn are_large(shapes: [&Shape; 2], vertex_count: usize) -> bool {
    shapes[0].polyhedron().vertices.len() + shapes[1].polyhedron().vertices.len() >= vertex_count
}

/// Whether the bodies intersected the last time: they mostly still do, which their cached vertex pairs prove, and levels cannot.
/// (Of round bodies of 100,002 vertices that saves from four fifths at 0.1° to nineteen twentieths of the time at 1° and 10°.)
#[inline(always)]
fn seem_to_intersect(cache: &PairCache, config: &PairConfig) -> bool {
    cache.holds_pairs() & config.start.asks_cache()
}

/// Whether the bodies are so large that levels save time where a verdict is asked for and not settled at a glance.
#[inline(always)]
pub(super) fn help_verdicts(shapes: [&Shape; 2], cache: &PairCache, config: &PairConfig) -> bool {
    are_large(shapes, VERY_MANY_VERTICES) & (config.levels == Levels::Automatic) & !seem_to_intersect(cache, config)
}

/// A query of bodies so large that levels save time where they may answer.
#[inline(never)]
pub(super) fn of_large(
    query: Query,
    shapes: [&Shape; 2],
    poses: [&Pose; 2],
    cache: &mut PairCache,
    config: &PairConfig,
    answer: &mut PairAnswer,
) -> Result<()> {
    check_config(config)?;
    let all = PairConfig { levels: Levels::All, ..*config };
    let polyhedra = [shapes[0].polyhedron(), shapes[1].polyhedron()];
    let mut pair = PairQuery { query, polyhedra, poses, cache, config, answer };
    let error = match query {
        // Nothing is made for a query that is answered without; others have looked.
        Query::Approximate if pair.is_farther_than(enough(query, config)) => return Ok(()),
        Query::Approximate => surely_most_error(config, polyhedra, poses),
        _ => f64::INFINITY,
    };
    let are_worth_it = are_worth_it(shapes, error);
    if are_worth_it && shapes.iter().any(|shape| shape.lacks_levels()) {
        pair.make_levels(shapes)?;
    }
    let goes_through = are_worth_it && may_answer(shapes, error);
    if goes_through || (query == Query::Approximate && config.step_budget != u32::MAX) {
        pair.config = if goes_through { &all } else { config };
        return pair.begin_descent(shapes);
    }
    let none = PairConfig { levels: Levels::None, ..*config };
    super::query(query, shapes, poses, pair.cache, &none, pair.answer)
}

/// The error that a query about bodies at least `gap` apart may make.
#[inline(always)]
pub(super) fn most_error(config: &PairConfig, gap: f64) -> f64 {
    let relative = config.relative_error * gap;
    if relative > config.absolute_error { relative } else { config.absolute_error }
}

/// The same before anything is known but the bounding spheres.
#[inline(always)]
pub(super) fn surely_most_error(config: &PairConfig, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> f64 {
    if config.relative_error > 0.0 {
        most_error(config, gap_of_spheres(polyhedra, poses))
    } else {
        config.absolute_error
    }
}

/// How far the bounding spheres are apart, about; 0 where they overlap. It only says where to look.
fn gap_of_spheres(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> f64 {
    let [centre1, centre2] = [0, 1].map(|i| poses[i].transform(&polyhedra[i].centre));
    let gap = (centre1 - centre2).norm() - (polyhedra[0].radius + polyhedra[1].radius);
    if gap > 0.0 { gap } else { 0.0 }
}

/// Whether automatic levels, made or not, are asked for an answer to within an error. The finest level of an ellipsoid of n
/// vertices stands off by some 20/n of its radius (docs/levels.md); bodies four times as smooth are given the benefit of the
/// doubt.
#[inline(always)]
pub(super) fn are_worth_it(shapes: [&Shape; 2], error: f64) -> bool {
    let standing_off = |shape: &Shape| 5.0 * shape.polyhedron().radius / shape.polyhedron().vertices.len() as f64;
    let are_automatic = shapes.iter().any(|shape| shape.hierarchy().kind == HierarchyKind::Automatic);
    !are_automatic || error >= standing_off(shapes[0]) + standing_off(shapes[1])
}

/// Whether two bodies, or levels, have look-up tables to start from.
fn has_tables([first, second]: [&Polyhedron; 2]) -> bool {
    first.lookup.serves_with(&second.lookup)
}

/// Beyond what distance of the bounding spheres nothing more is asked. Distances without a tolerance have an infinite one.
#[inline(always)]
fn enough(query: Query, config: &PairConfig) -> f64 {
    let is_verdict = (query == Query::Intersection) & (config.distance_tolerance == f64::INFINITY);
    if is_verdict { 0.0 } else { config.distance_tolerance }
}

/// Whether there are levels that may answer to within an error, the finest being the tightest.
#[inline(always)]
pub(super) fn may_answer(shapes: [&Shape; 2], error: f64) -> bool {
    let [levels1, levels2] = shapes.map(|shape| &shape.hierarchy().levels);
    let finest = |levels: &[Level]| levels.first().map_or(0.0, |level| level.deviation);
    !(levels1.is_empty() & levels2.is_empty()) && finest(levels1) + finest(levels2) < error
}

/// Bodies of fewer vertices, both together, are not worth levels in every motion. Measured at 20,004 (at an error of 1 % of the
/// radius up to 2 times slower at 0.1°, 1.3 times at 10° and random poses, 1.4 times faster at 1°; before levels had tables and a
/// short way), 60,004 (up to 1.15 times slower at 0.1°, 1.2 to 5 times faster elsewhere) and 200,004 vertices (1.1 to 1.4 times
/// faster at 0.1°, 1.8 to 8 times elsewhere).
const MANY_VERTICES: usize = 60_000;

/// The same for intersection, which a separating axis answers well: measured at 20,004 (levels up to twice as slow) and 200,004
/// vertices (1.2 times slower at 0.1°, 1.6 to 2 times faster elsewhere).
const VERY_MANY_VERTICES: usize = 200_000;

impl PairQuery<'_> {
    /// Makes the automatic levels that are missing, but for no query that is refused.
    fn make_levels(&self, shapes: [&Shape; 2]) -> Result<()> {
        self.check_poses()?;
        shapes.iter().for_each(|shape| shape.need_levels());
        Ok(())
    }

    /// The query through the levels of detail, from the cache or afresh.
    fn begin_descent(&mut self, shapes: [&Shape; 2]) -> Result<()> {
        if !self.config.start.asks_cache() {
            self.forget()?;
        }
        self.descend(shapes)
    }

    /// The query through the levels of detail, if the configuration wants any.
    #[inline(never)]
    pub(super) fn descend(&mut self, shapes: [&Shape; 2]) -> Result<()> {
        if self.config.levels == Levels::All && shapes.iter().any(|shape| shape.lacks_levels()) {
            self.make_levels(shapes)?;
        }
        let &mut PairQuery { query, polyhedra, poses, ref mut cache, config, .. } = self;
        if let Some(pairs) = cache.recall_pairs(polyhedra) {
            let frame = Frame::<Portable>::new(polyhedra, poses, config.rotation_limit);
            if frame.usual
                && let Some(weights) = encloses_origin(&frame, pairs.as_slice())
            {
                self.answer.status = Status::Coherent;
                self.answer.statistics = Statistics::default();
                self.fill(&Decision::Intersecting { pairs, weights });
                self.remember_marker();
                return Ok(());
            }
        }
        let (before, marker) = (cache.spent_before(), cache.last_marker(config).copied());
        let bodies = Leveled::new(shapes, poses);
        let beyond = config.distance_tolerance;
        let accuracy = match query {
            // A tolerance is to be on one side of the interval.
            Query::Intersection if beyond < f64::INFINITY => Accuracy { absolute: 0.0, relative: 0.0, beyond },
            Query::Intersection => Accuracy { absolute: f64::INFINITY, relative: 0.0, beyond },
            Query::Approximate => config.accuracy(),
            // Only the bodies themselves tell.
            Query::Distance | Query::Contact => Accuracy { absolute: 0.0, relative: 0.0, beyond },
        };
        let (place, is_trial) = self.start(&bodies);
        // Marching in pieces, a budget at a time, does not see that it goes round in circles: penetration, mostly.
        if before > step_limit(polyhedra) {
            let at = bodies.descended(place, [0, 0]).state;
            return self.end(Attempt::Open { at, is_minimum: false, steps: 0 });
        }
        let mut descent = Descent {
            bodies,
            accuracy,
            refinement: config.refinement,
            rotation_limit: config.rotation_limit,
            place,
            is_trial,
            marker,
            step_limit: if query == Query::Approximate { config.step_budget } else { u32::MAX },
            steps: 0,
            found: None,
        };
        let mut descended = simd::dispatch(&mut descent);
        if descended == Descended::Lost {
            if config.start != Start::Cache && has_tables(bodies.polyhedra(place.levels)) {
                descent.place = self.place_anew(&bodies);
            }
            descent.is_trial = false;
            descended = simd::dispatch(&mut descent);
        }
        let Descent { place, is_trial, steps, step_limit, found, .. } = descent;
        match (descended, found) {
            (Descended::Enough, Some(found)) => {
                self.fill_found(&found, Status::WithinTolerance, steps);
                self.remember(&bodies, place, found.lower);
                if steps > 1 {
                    self.remember_marker();
                }
                Ok(())
            }
            (Descended::Finest, _) => self.finish(&bodies, place.state, is_trial, [before, steps], step_limit),
            _ => {
                self.spend(&bodies, found, place, [before, steps]);
                Ok(())
            }
        }
    }

    /// Where the search starts: where the last one ended, else at the coarsest levels. Whether it is the former, too.
    fn start(&self, bodies: &Leveled) -> (Place, bool) {
        let has_levels = self.config.levels == Levels::All;
        let recalled = if self.config.start.asks_cache() { self.cache.recall_place(bodies) } else { None };
        match recalled {
            // An exact query left it.
            Some(place)
                if place.levels == [0, 0]
                    && has_levels
                    && self.query == Query::Approximate
                    && self.cache.spent_before() == 0 =>
            {
                (bodies.climbed(place, f64::INFINITY, self.surely_near_enough()), true)
            }
            Some(place) if has_levels || place.levels == [0, 0] => (place, true),
            _ => (self.place_anew(bodies), false),
        }
    }

    /// Where to start if not where the last search ended: at the levels that may be near enough, at the vertices that their tables
    /// say; without tables at the coarsest levels.
    fn place_anew(&self, bodies: &Leveled) -> Place {
        let asks_tables = self.config.start != Start::Cold;
        let levels = match self.config.levels {
            Levels::All if asks_tables && has_tables(self.polyhedra) => {
                let finest = Place { levels: [0, 0], state: State::vertex_vertex([0, 0]) };
                bodies.climbed(finest, f64::INFINITY, self.surely_near_enough()).levels
            }
            Levels::All => bodies.coarsest(),
            _ => [0, 0],
        };
        let vertices = start::anew(bodies.polyhedra(levels), self.poses, asks_tables).vertices();
        Place { levels, state: State::vertex_vertex(vertices) }
    }

    /// How far levels may stand off from their bodies and still answer a query about bodies `gap` apart.
    fn near_enough(&self, gap: f64) -> f64 {
        if self.config.distance_tolerance < f64::INFINITY || self.query != Query::Approximate {
            return f64::INFINITY;
        }
        most_error(self.config, gap)
    }

    /// The same before anything is known but the bounding spheres.
    fn surely_near_enough(&self) -> f64 {
        self.near_enough(gap_of_spheres(self.polyhedra, self.poses))
    }

    /// The bodies themselves, from a state of theirs, of an earlier query or not; `before` and `steps` are those made by earlier
    /// queries and by this one.
    fn finish(
        &mut self,
        bodies: &Leveled,
        state: State,
        is_trial: bool,
        [before, steps]: [u32; 2],
        step_budget: u32,
    ) -> Result<()> {
        let place = |state| Place { levels: [0, 0], state };
        let left = step_budget - steps;
        if left == 0 {
            self.spend(bodies, None, place(state), [before, steps]);
            return Ok(());
        }
        // The number of trial steps makes a trial of it: right for features of an earlier query, if the budget is no matter.
        let limit = match left {
            u32::MAX if is_trial => TRIAL_STEPS,
            TRIAL_STEPS => TRIAL_STEPS - 1,
            _ => step_limit(self.polyhedra).min(left),
        };
        let attempt = simd::dispatch(&mut Finish { pair: self, start: state, steps, limit });
        if let Attempt::Open { at, is_minimum: false, steps: made } = attempt
            && made - steps == limit
            && left <= limit + 1
        {
            self.spend(bodies, None, place(at), [before, made]);
            return Ok(());
        }
        self.end(attempt)?;
        if self.answer.outcome != Outcome::Intersecting
            && let Some(state) = State::checked(self.cache.kind, self.cache.indices, self.polyhedra)
        {
            self.remember(bodies, Place { levels: [0, 0], state }, self.answer.lower);
        }
        Ok(())
    }

    /// The cache for the next query: as high up as its levels would be disjoint and, where that is all that counts, near enough.
    fn remember(&mut self, bodies: &Leveled, place: Place, gap: f64) {
        if self.config.levels != Levels::All {
            self.cache.remember_state(place.state);
            return;
        }
        let most = self.near_enough(gap);
        self.cache.remember_place(bodies.climbed(place, gap, most));
    }

    /// The answer that a pair of levels gives.
    #[inline(always)]
    pub(super) fn fill_found(&mut self, found: &Found, status: Status, steps: u32) {
        let answer = &mut *self.answer;
        answer.status = status;
        answer.statistics = Statistics { marching_steps: steps, levels: found.place.levels, ..Statistics::default() };
        let interval = Interval { lower: found.lower, upper: found.upper };
        // What a budget leaves open is not beyond.
        let tolerance = self.config.distance_tolerance;
        let tolerance = if interval.settles(tolerance) { tolerance } else { f64::INFINITY };
        set_interval(answer, &interval, found.lower, tolerance);
        contact::fill_nothing(answer);
        answer.normal = found.normal.into();
    }

    /// The answer when the steps are spent: what the levels say, or what a look along the line of two vertices says.
    #[cold]
    fn spend(&mut self, bodies: &Leveled, found: Option<Found>, place: Place, [before, steps]: [u32; 2]) {
        let finest = bodies.descended(place, [0, 0]);
        let vertices = finest.state.vertices(self.polyhedra);
        let glance = simd::dispatch(&mut Glance { polyhedra: self.polyhedra, poses: self.poses, vertices });
        let mut known = Found { place: finest, lower: 0.0, upper: f64::INFINITY, normal: glance.direction };
        if glance.interval.lower > 0.0 {
            known.lower = glance.interval.lower;
            known.normal = contact::normalised(&glance.direction).into();
        }
        if glance.interval.upper < known.upper {
            known.upper = glance.interval.upper;
        }
        if let Some(found) = found {
            if found.lower > known.lower {
                known = Found { upper: known.upper, ..found };
            }
            known.upper = if found.upper < known.upper { found.upper } else { known.upper };
        }
        self.fill_found(&known, Status::BudgetSpent, steps);
        if !(known.lower > 0.0) {
            self.answer.outcome = Outcome::Undecided;
            contact::fill_nothing(self.answer);
        }
        self.cache.remember_place(place);
        self.cache.pairs[1][0] = before.saturating_add(steps);
    }
}

/// Marching at the bodies themselves from a given state.
struct Finish<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
    start: State,
    steps: u32,
    limit: u32,
}

impl Kernel for Finish<'_, '_> {
    type Output = Attempt;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Attempt {
        let &mut Finish { start, steps, limit, .. } = self;
        let &mut PairQuery { polyhedra, poses, config, .. } = self.pair;
        let frame = Frame::<L>::new(polyhedra, poses, config.rotation_limit);
        if !frame.usual {
            return Attempt::Unusual;
        }
        // A segment or a point has no faces to march over.
        if polyhedra[0].dimension.min(polyhedra[1].dimension) < 2 {
            return Attempt::Open { at: start, is_minimum: false, steps };
        }
        L::out_of_line(&mut MarchOn { pair: self.pair, frame, start, steps, limit })
    }
}

/// What the line through two vertices says of the distance: their distance from above, supports along it from below.
struct Glance<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    vertices: [u32; 2],
}

impl Kernel for Glance<'_> {
    type Output = Nearest;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Nearest {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        let direction = gjk::difference(&frame, self.vertices);
        let simplex =
            Simplex { count: 1, pairs: [self.vertices; 4], differences: [direction; 4], weights: [1.0, 0.0, 0.0, 0.0] };
        let [g1, g2] = gjk::towards(&frame, &direction);
        let [v, w] = self.vertices;
        let supports = [climb(self.polyhedra[0], g1, v), climb(self.polyhedra[1], g2, w)];
        gjk::certify(&frame, simplex, &direction, supports)
    }
}
