//! Queries through levels of detail, and those with a step budget: the search among the levels, and where the next query is to
//! start.

use super::attempt::Leg;
use super::config::PairConfig;
use super::contact;
use super::descent::{Accuracy, Descended, Descent, Found, Leveled, Place};
use super::query::{Attempt, Open, PairQuery, Query, set_interval};
use super::start::policy::StartFrom;
use super::start::start_pair;
use super::{DecidedBy, Levels, Outcome, Start, Statistics};
use crate::base::error::Result;
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::base::simd::{self, Kernel, Lanes, Portable};
use crate::levels::hierarchy::HierarchyKind;
use crate::polyhedron::Polyhedron;
use crate::shape::Shape;
use crate::solve::certificate::Interval;
use crate::solve::decide::Decision;
use crate::solve::enclosure::encloses_origin;
use crate::solve::frame::Frame;
use crate::solve::gjk::{self, Nearest, Simplex};
use crate::solve::marching::step_limit;
use crate::solve::state::State;
use crate::solve::voronoi::climb;

/// What a search among levels came to.
pub(super) enum Searched<'a> {
    /// The answer is there.
    Answered,
    /// There are no levels that may answer.
    Bodies,
    /// Marching at the bodies themselves from the place that the search came to ended so; where the next is to start is still to be
    /// remembered.
    Marched(LevelSearch<'a>, Attempt),
}

/// A search among levels.
pub(super) struct LevelSearch<'a> {
    bodies: Leveled<'a>,
    /// Whether it goes through levels, or has a budget alone.
    has_levels: bool,
    /// Steps of earlier queries whose budget ran out.
    before: u32,
}

/// Whether there are levels that may answer to within an error, the finest being the tightest.
#[inline(always)]
pub(super) fn may_answer(shapes: [&Shape; 2], error: f64) -> bool {
    let [levels1, levels2] = shapes.map(|shape| &shape.hierarchy().levels);
    !(levels1.is_empty() & levels2.is_empty()) && finest_deviation(shapes[0]) + finest_deviation(shapes[1]) < error
}

/// How far the finest level of those that are made stands off; 0 where there is none.
#[inline(always)]
fn finest_deviation(shape: &Shape) -> f64 {
    shape.hierarchy().levels.first().map_or(0.0, |level| level.deviation)
}

/// Bodies of fewer vertices, both together, are not worth levels in every motion. Measured at 20,004 (at an error of 1 % of the
/// radius up to 2 times slower at 0.1°, 1.3 times at 10° and random poses, 1.4 times faster at 1°; before levels had tables and a
/// short way), 60,004 (up to 1.15 times slower at 0.1°, 1.2 to 5 times faster elsewhere) and 200,004 vertices (1.1 to 1.4 times
/// faster at 0.1°, 1.8 to 8 times elsewhere).
const MANY_VERTICES: usize = 60_000;

/// The same for intersection, which a separating axis answers well: measured at 20,004 (levels up to twice as slow) and 200,004
/// vertices (1.2 times slower at 0.1°, 1.6 to 2 times faster elsewhere).
const VERY_MANY_VERTICES: usize = 200_000;

/// Bodies of at least so many vertices, both together, may be worth levels; `None` where only the bodies themselves tell.
#[inline(always)]
fn least_vertices(query: Query) -> Option<usize> {
    match query {
        Query::Approximate => Some(MANY_VERTICES),
        Query::Intersection => Some(VERY_MANY_VERTICES),
        Query::Distance | Query::Contact => None,
    }
}

/// The error that a query about bodies at least `gap` apart may make.
#[inline(always)]
pub(super) fn most_error(config: &PairConfig, gap: f64) -> f64 {
    let relative = config.relative_error * gap;
    if relative > config.absolute_error { relative } else { config.absolute_error }
}

/// How far the bounding spheres are apart, about; 0 where they overlap. It only says where to look.
fn gap_of_spheres(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> f64 {
    let [centre1, centre2] = [0, 1].map(|i| poses[i].transform(&polyhedra[i].centre));
    let gap = (centre1 - centre2).norm() - (polyhedra[0].radius + polyhedra[1].radius);
    if gap > 0.0 { gap } else { 0.0 }
}

/// Whether automatic levels, made or not, are asked for an answer to within an error.
#[inline(always)]
pub(super) fn are_worth_it(shapes: [&Shape; 2], error: f64) -> bool {
    !are_automatic(shapes) || error >= standing_off(shapes[0]) + standing_off(shapes[1])
}

#[inline(always)]
fn are_automatic(shapes: [&Shape; 2]) -> bool {
    shapes.iter().any(|shape| shape.hierarchy().kind == HierarchyKind::Automatic)
}

/// How far automatic levels stand off, about. The finest level of an ellipsoid of n vertices does so by some 20/n of its radius
/// (docs/levels.md); bodies four times as smooth are given the benefit of the doubt.
#[inline(always)]
fn standing_off(shape: &Shape) -> f64 {
    5.0 * shape.polyhedron().radius / shape.polyhedron().vertices.len() as f64
}

/// From which error on levels may answer an approximate query about two bodies; infinite where they never do.
pub(crate) fn least_error(shapes: [&Shape; 2], levels: Levels) -> f64 {
    let vertices = shapes.iter().map(|shape| shape.polyhedron().vertices.len()).sum::<usize>();
    let may_be_asked = match levels {
        Levels::None => false,
        Levels::All => true,
        Levels::Automatic => vertices >= MANY_VERTICES,
    };
    let has_levels = |shape: &&Shape| shape.lacks_levels() || !shape.hierarchy().levels.is_empty();
    if !may_be_asked || !shapes.iter().any(has_levels) {
        return f64::INFINITY;
    }
    let of_levels = shapes.map(finest_deviation).iter().sum::<f64>().next_up();
    if are_automatic(shapes) { of_levels.max(shapes.map(standing_off).iter().sum()) } else { of_levels }
}

impl<'a> PairQuery<'a> {
    /// Whether the query is to go through levels, may gain by them, or has a step budget. That is decided here, once.
    #[inline(always)]
    pub(super) fn may_ask_levels(&self) -> bool {
        match self.config.levels {
            Levels::All => true,
            Levels::None => self.has_budget(),
            Levels::Automatic => self.has_budget() | self.is_large(),
        }
    }

    #[inline(always)]
    fn has_budget(&self) -> bool {
        (self.query == Query::Approximate) & (self.config.step_budget != u32::MAX)
    }

    /// Whether the bodies are so large that levels may save time. Those that intersected the last time mostly still do, which
    /// their cached enclosure proves, and levels cannot. (Of round bodies of 100,002 vertices that saves from four fifths at 0.1°
    /// to nineteen twentieths of the time at 1° and 10°.)
    #[inline(always)]
    fn is_large(&self) -> bool {
        let Some(least) = least_vertices(self.query) else { return false };
        let [body1, body2] = self.polyhedra();
        (body1.vertices.len() + body2.vertices.len() >= least)
            && !(self.cache.holds_enclosure() & self.config.start.asks_cache())
    }

    fn shapes(&self) -> [&'a Shape; 2] {
        self.bodies.map(|body| body.shape)
    }

    /// The error that the query may make, before anything is known but the bounding spheres.
    #[inline(always)]
    pub(super) fn surely_most_error(&self) -> f64 {
        let config = self.config;
        if config.relative_error > 0.0 { most_error(config, self.gap_of_spheres()) } else { config.absolute_error }
    }

    fn gap_of_spheres(&self) -> f64 {
        gap_of_spheres(self.polyhedra(), self.poses())
    }

    /// Whether automatic levels are to be gone through. They are made if they are missing.
    fn automatic_levels_may_answer(&self) -> Result<bool> {
        if !self.is_large() {
            return Ok(false);
        }
        let error = if self.query == Query::Approximate { self.surely_most_error() } else { f64::INFINITY };
        if !are_worth_it(self.shapes(), error) {
            return Ok(false);
        }
        self.make_missing_levels()?;
        Ok(may_answer(self.shapes(), error))
    }

    /// Makes the automatic levels that are missing, but for no query that is refused.
    fn make_missing_levels(&self) -> Result<()> {
        if self.shapes().iter().any(|shape| shape.lacks_levels()) {
            self.check_poses()?;
            self.shapes().iter().for_each(|shape| shape.need_levels());
        }
        Ok(())
    }

    /// The query through the levels of detail, from the cache or afresh.
    #[inline(never)]
    pub(super) fn search_levels(&mut self) -> Result<Searched<'a>> {
        let has_levels = match self.config.levels {
            Levels::All => {
                self.make_missing_levels()?;
                true
            }
            Levels::Automatic => self.automatic_levels_may_answer()?,
            Levels::None => false,
        };
        if !(has_levels || self.has_budget()) {
            return Ok(Searched::Bodies);
        }
        self.forget()?;
        if self.is_still_enclosed() {
            return Ok(Searched::Answered);
        }
        let search = LevelSearch { bodies: Leveled::new(*self.bodies), has_levels, before: self.cache.spent_before() };
        Ok(search.run(self))
    }

    /// Whether what proved the last intersection proves this one.
    fn is_still_enclosed(&mut self) -> bool {
        let Some(pairs) = self.cache.enclosure(self.polyhedra()) else { return false };
        let frame = Frame::<Portable>::new(self.polyhedra(), self.poses(), self.config.rotation_limit);
        if !frame.in_range {
            return false;
        }
        let Some(weights) = encloses_origin(&frame, pairs.as_slice()) else { return false };
        self.answer.decided_by = DecidedBy::Coherence;
        self.answer.statistics = Statistics::default();
        self.fill(&Decision::Intersecting { pairs, weights });
        frame.mark(&mut self.cache.marker);
        true
    }

    /// What the query wants to know.
    fn accuracy(&self) -> Accuracy {
        let beyond = self.config.distance_tolerance;
        match self.query {
            // A tolerance is to be on one side of the interval.
            Query::Intersection if beyond < f64::INFINITY => Accuracy { absolute: 0.0, relative: 0.0, beyond },
            Query::Intersection => Accuracy { absolute: f64::INFINITY, relative: 0.0, beyond },
            Query::Approximate => self.config.accuracy(),
            // Only the bodies themselves tell.
            Query::Distance | Query::Contact => Accuracy { absolute: 0.0, relative: 0.0, beyond },
        }
    }

    /// How far levels may stand off from their bodies and still answer a query about bodies `gap` apart.
    pub(super) fn near_enough(&self, gap: f64) -> f64 {
        // Who asks for all levels begins at the coarsest where there is a tolerance, as Ehmann & Lin do.
        let asks_coarsest = (self.config.levels == Levels::All) & (self.config.distance_tolerance < f64::INFINITY);
        if asks_coarsest | (self.query != Query::Approximate) {
            return f64::INFINITY;
        }
        // The whole interval is to be on the bodies' own side of the tolerance.
        let tolerance = self.config.distance_tolerance;
        if gap > tolerance { gap - tolerance } else { most_error(self.config, gap).min(tolerance - gap) }
    }

    /// The same before anything is known but the bounding spheres.
    fn surely_near_enough(&self) -> f64 {
        self.near_enough(self.gap_of_spheres())
    }

    /// The answer that a pair of levels gives.
    #[inline(always)]
    pub(super) fn fill_found(&mut self, found: &Found, decided_by: DecidedBy, steps: u32) {
        let answer = &mut *self.answer;
        answer.decided_by = decided_by;
        answer.statistics = Statistics { marching_steps: steps, levels: found.place.levels, ..Statistics::default() };
        let interval = Interval { lower: found.lower, upper: found.upper };
        // What a budget leaves open is not beyond.
        let tolerance = self.config.distance_tolerance;
        let tolerance = if interval.settles(tolerance) { tolerance } else { f64::INFINITY };
        set_interval(answer, &interval, found.lower, tolerance);
        contact::fill_nothing(answer);
        answer.normal = found.normal.into();
    }
}

impl<'a> LevelSearch<'a> {
    fn run(self, pair: &mut PairQuery<'a>) -> Searched<'a> {
        let (bodies, config) = (self.bodies, pair.config);
        let (place, is_trial) = self.start(pair);
        // Marching in pieces, a budget at a time, does not see that it goes round in circles: penetration, mostly.
        if self.before > step_limit(pair.polyhedra()) {
            let at = bodies.descended(place, [0, 0]).state;
            return Searched::Marched(self, Attempt::Open(Open { at, is_minimum: false, steps: 0 }));
        }
        let mut descent = Descent {
            bodies,
            accuracy: pair.accuracy(),
            refinement: config.refinement,
            rotation_limit: config.rotation_limit,
            place,
            is_trial,
            marker: pair.cache.last_marker(config).copied(),
            step_limit: if pair.query == Query::Approximate { config.step_budget } else { u32::MAX },
            steps: 0,
            found: None,
        };
        let mut descended = simd::dispatch(&mut descent);
        if descended == Descended::Lost {
            if config.start != Start::Cache && has_tables(bodies.polyhedra(place.levels)) {
                descent.place = self.place_anew(pair);
            }
            descent.is_trial = false;
            descended = simd::dispatch(&mut descent);
        }
        let Descent { place, is_trial, steps, step_limit, found, .. } = descent;
        match (descended, found) {
            (Descended::Enough, Some(found)) => {
                pair.fill_found(&found, DecidedBy::Tolerance, steps);
                self.remember_place(pair, place, found.lower);
                if steps > 1 {
                    pair.remember_marker();
                }
                Searched::Answered
            }
            (Descended::Finest, _) => self.march(pair, place.state, steps, Leg::of(step_limit - steps, is_trial)),
            _ => self.spend(pair, found, place, steps),
        }
    }

    /// Where the search starts: where the last one ended, else at the coarsest levels. Whether it is the former, too.
    fn start(&self, pair: &PairQuery) -> (Place, bool) {
        let recalled = if pair.config.start.asks_cache() { pair.cache.place(&self.bodies) } else { None };
        match recalled {
            // An exact query left it.
            Some(place)
                if place.levels == [0, 0]
                    && self.has_levels
                    && pair.query == Query::Approximate
                    && self.before == 0 =>
            {
                (self.bodies.climbed(place, f64::INFINITY, pair.surely_near_enough()), true)
            }
            Some(place) if self.has_levels || place.levels == [0, 0] => (place, true),
            _ => (self.place_anew(pair), false),
        }
    }

    /// Where to start if not where the last search ended: at the levels that may be near enough, at the vertices that their tables
    /// say; without tables at the coarsest levels.
    fn place_anew(&self, pair: &PairQuery) -> Place {
        let bodies = &self.bodies;
        let levels = if !self.has_levels {
            [0, 0]
        } else if pair.asks_tables() && has_tables(pair.polyhedra()) {
            let finest = Place { levels: [0, 0], state: State::vertex_vertex([0, 0]) };
            bodies.climbed(finest, f64::INFINITY, pair.surely_near_enough()).levels
        } else {
            bodies.coarsest()
        };
        let from = if pair.asks_tables() { StartFrom::Centres } else { StartFrom::Farthest };
        let vertices = start_pair(bodies.polyhedra(levels), pair.poses(), from).vertices();
        Place { levels, state: State::vertex_vertex(vertices) }
    }

    /// Marching at the bodies themselves, from a state of theirs, of an earlier query or not; `steps` are made already.
    fn march(self, pair: &mut PairQuery<'a>, state: State, steps: u32, leg: Leg) -> Searched<'a> {
        let place = |state| Place { levels: [0, 0], state };
        if leg == Leg::Budget(0) {
            return self.spend(pair, None, place(state), steps);
        }
        let attempt = pair.march_on(state, steps, leg);
        if let Attempt::Open(Open { at, is_minimum: false, steps: made }) = attempt
            && leg == Leg::Budget(made - steps)
        {
            return self.spend(pair, None, place(at), made);
        }
        Searched::Marched(self, attempt)
    }

    /// The cache for the next query, after the bodies themselves have answered.
    pub(super) fn remember(&self, pair: &mut PairQuery) {
        if pair.answer.outcome != Outcome::Intersecting
            && let Some(state) = pair.cache.features_of(pair.polyhedra())
        {
            let gap = pair.answer.lower;
            self.remember_place(pair, Place { levels: [0, 0], state }, gap);
        }
    }

    /// The cache for the next query: as high up as its levels would be disjoint and, where that is all that counts, near enough.
    fn remember_place(&self, pair: &mut PairQuery, place: Place, gap: f64) {
        if !self.has_levels {
            pair.cache.remember_features(place.state);
            return;
        }
        let most = pair.near_enough(gap);
        pair.cache.remember_place(self.bodies.climbed(place, gap, most), 0);
    }

    /// The answer when the steps are spent: what the levels say, or what a look along the line of two vertices says.
    #[cold]
    fn spend(&self, pair: &mut PairQuery, found: Option<Found>, place: Place, steps: u32) -> Searched<'a> {
        let (polyhedra, poses) = (pair.polyhedra(), pair.poses());
        let finest = self.bodies.descended(place, [0, 0]);
        let vertices = finest.state.vertices(polyhedra);
        let glance = simd::dispatch(&mut Glance { polyhedra, poses, vertices });
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
        pair.fill_found(&known, DecidedBy::Budget, steps);
        if !(known.lower > 0.0) {
            pair.answer.outcome = Outcome::Undecided;
            contact::fill_nothing(pair.answer);
        }
        pair.cache.remember_place(place, self.before.saturating_add(steps));
        Searched::Answered
    }
}

/// Whether two bodies, or levels, have look-up tables to start from.
fn has_tables([first, second]: [&Polyhedron; 2]) -> bool {
    first.lookup.serves_with(&second.lookup)
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
