//! Whether levels of detail may answer a query, and how near to their bodies they then have to be.

use super::query::{NoBalls, PairQuery, Sweep};
use super::support_glance;
use crate::answer::{Accuracy, Levels, Query};
use crate::base::error::Result;
use crate::pair::levels::{LevelBounds, LevelDescent, LevelState, Leveled, TRIAL_STEPS};
use crate::placed::Pair;
use crate::shape::Shape;
use crate::shape::levels::hierarchy::HierarchyKind;

/// Whether there are levels that may answer to within an error, the finest being the tightest.
#[inline(always)]
fn may_answer(shapes: [&Shape; 2], error: f64) -> bool {
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

/// Bodies of at least this many vertices, both together, may be worth levels; `None` where only the bodies themselves decide.
#[inline(always)]
fn least_vertices(query: Query) -> Option<usize> {
    match query {
        Query::Approximate => Some(MANY_VERTICES),
        Query::Intersection => Some(VERY_MANY_VERTICES),
        Query::Distance | Query::Contact => None,
    }
}

/// How far the bounding spheres are apart, about; 0 where they overlap. It only guides where to look.
fn gap_of_spheres(pair: &Pair) -> f64 {
    let Pair { polyhedra, poses } = *pair;
    let [centre1, centre2] = [0, 1].map(|i| poses[i].transform(&polyhedra[i].centre));
    let gap = (centre1 - centre2).norm() - (polyhedra[0].radius + polyhedra[1].radius);
    if gap > 0.0 { gap } else { 0.0 }
}

/// Whether automatic levels, made or not, are asked for an answer to within an error.
#[inline(always)]
fn are_worth_it(shapes: [&Shape; 2], error: f64) -> bool {
    !are_automatic(shapes) || error >= standing_off(shapes[0]) + standing_off(shapes[1])
}

#[inline(always)]
fn are_automatic(shapes: [&Shape; 2]) -> bool {
    shapes.iter().any(|shape| shape.hierarchy().kind == HierarchyKind::Automatic)
}

/// How far automatic levels stand off, about. The finest level of an ellipsoid of n vertices does so by some 20/n of its radius
/// (docs/research/levels.md); bodies four times as smooth are given the benefit of the doubt.
#[inline(always)]
fn standing_off(shape: &Shape) -> f64 {
    5.0 * shape.polyhedron().radius / shape.polyhedron().vertices.len() as f64
}

/// The error from which an approximate query about two bodies may be answered faster than exactly, by maps of support functions
/// or by levels; infinite where neither ever does.
pub(crate) fn least_error(shapes: [&Shape; 2], levels: Levels) -> f64 {
    let of_levels = least_error_of_levels(shapes, levels);
    if levels == Levels::Automatic { of_levels.min(support_glance::least_error(shapes)) } else { of_levels }
}

/// The same by levels alone.
fn least_error_of_levels(shapes: [&Shape; 2], levels: Levels) -> f64 {
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

impl<'a, S: Sweep> PairQuery<'a, S> {
    /// Whether the query is to go through levels, may gain by them, or has a step budget. That is decided here, once.
    #[inline(always)]
    pub(super) fn may_ask_levels(&self, query: Query) -> bool {
        match self.config.levels {
            Levels::All => true,
            Levels::None => self.has_budget(query),
            Levels::Automatic => self.has_budget(query) | self.is_large(query),
        }
    }

    /// Whether its steps are counted.
    #[inline(always)]
    pub(super) fn has_budget(&self, query: Query) -> bool {
        (query == Query::Approximate) & (self.config.step_budget != u32::MAX)
    }

    /// Whether the bodies are so large that levels may save time. Those that intersected the last time mostly still do, which
    /// their cached enclosure proves, and levels cannot. (Of round bodies of 100,002 vertices that saves from four fifths at 0.1°
    /// to nineteen twentieths of the time at 1° and 10°.)
    #[inline(always)]
    fn is_large(&self, query: Query) -> bool {
        let Some(least) = least_vertices(query) else { return false };
        let [body1, body2] = self.polyhedra();
        (body1.vertices.len() + body2.vertices.len() >= least) && !(self.cache.holds_enclosure() & self.asks_cache())
    }

    pub(super) fn shapes(&self) -> [&'a Shape; 2] {
        self.bodies.map(|body| body.shape)
    }

    /// The error that the query may make, before anything is known but the bounding spheres.
    #[inline(always)]
    pub(super) fn surely_most_error(&self) -> f64 {
        let config = self.config;
        if config.relative_error > 0.0 { self.most_error(self.gap_of_spheres()) } else { config.absolute_error }
    }

    fn gap_of_spheres(&self) -> f64 {
        gap_of_spheres(&self.pair())
    }

    /// The error that the query may make about bodies at least `gap` apart.
    #[inline(always)]
    pub(super) fn most_error(&self, gap: f64) -> f64 {
        let relative = self.config.relative_error * gap;
        if relative > self.config.absolute_error { relative } else { self.config.absolute_error }
    }
}

impl<'a> PairQuery<'a, NoBalls> {
    /// Whether automatic levels must be gone through. They are made if they are missing.
    fn automatic_levels_may_answer(&self) -> Result<bool> {
        if !self.is_large(self.query) {
            return Ok(false);
        }
        let error = if self.query == Query::Approximate { self.surely_most_error() } else { f64::INFINITY };
        if !are_worth_it(self.shapes(), error) {
            return Ok(false);
        }
        self.make_missing_levels()?;
        Ok(may_answer(self.shapes(), error))
    }

    /// Makes the automatic levels that are missing, unless the query is refused.
    fn make_missing_levels(&self) -> Result<()> {
        if self.shapes().iter().any(|shape| shape.lacks_levels()) {
            self.check_poses()?;
            self.shapes().iter().for_each(|shape| shape.need_levels());
        }
        Ok(())
    }

    /// Whether the levels are gone through, made where they are missing.
    pub(super) fn levels_may_answer(&self) -> Result<bool> {
        match self.config.levels {
            Levels::All => {
                self.make_missing_levels()?;
                Ok(true)
            }
            Levels::Automatic => self.automatic_levels_may_answer(),
            Levels::None => Ok(false),
        }
    }

    /// Whether it is the common case: levels have answered the last query, and are there to answer this one.
    #[inline(always)]
    pub(super) fn may_ask_last_levels(&self) -> bool {
        let &PairQuery { query, bodies: [first, second], ref cache, config, .. } = self;
        let shapes = [first.shape, second.shape];
        let is_common_case = (query == Query::Approximate)
            & cache.holds_level_state()
            & (cache.spent_before() == 0)
            & (config.step_budget >= TRIAL_STEPS)
            & self.asks_cache();
        if !is_common_case || shapes[0].lacks_levels() | shapes[1].lacks_levels() {
            return false;
        }
        if config.levels != Levels::Automatic {
            return true;
        }
        let error = self.surely_most_error();
        are_worth_it(shapes, error) && may_answer(shapes, error)
    }

    /// The accuracy that the query needs.
    fn accuracy_of_levels(&self) -> Accuracy {
        let beyond = self.max_distance();
        match self.query {
            // A tolerance must be on one side of the interval.
            Query::Intersection if beyond < f64::INFINITY => Accuracy { absolute: 0.0, relative: 0.0, beyond },
            Query::Intersection => Accuracy { absolute: f64::INFINITY, relative: 0.0, beyond },
            Query::Approximate => self.accuracy(),
            // Only the bodies themselves decide.
            Query::Distance | Query::Contact => Accuracy { absolute: 0.0, relative: 0.0, beyond },
        }
    }

    /// Whether the bounds of a pair of levels are narrow enough an answer.
    #[inline(always)]
    pub(super) fn is_met_by(&self, found: &LevelBounds) -> bool {
        self.accuracy().is_met_by(found.lower, found.upper)
    }

    /// How far levels may stand off from their bodies and still answer a query about bodies `gap` apart.
    pub(super) fn near_enough(&self, gap: f64) -> f64 {
        // A query for all levels begins at the coarsest where there is a tolerance, as Ehmann & Lin do.
        let asks_coarsest = (self.config.levels == Levels::All) & (self.max_distance() < f64::INFINITY);
        if asks_coarsest | (self.query != Query::Approximate) {
            return f64::INFINITY;
        }
        // The whole interval must be on the bodies' own side of the tolerance.
        let tolerance = self.max_distance();
        if gap > tolerance { gap - tolerance } else { self.most_error(gap).min(tolerance - gap) }
    }

    /// The same before anything is known but the bounding spheres.
    pub(super) fn surely_near_enough(&self) -> f64 {
        self.near_enough(self.gap_of_spheres())
    }

    /// A search among levels, from where one begins.
    pub(super) fn descent(&self, bodies: Leveled<'a>, from: LevelState, is_trial: bool) -> LevelDescent<'a> {
        let config = self.config;
        LevelDescent {
            bodies,
            accuracy: self.accuracy_of_levels(),
            refinement: config.refinement,
            at: from,
            is_trial,
            marker: self.last_marker().copied(),
            step_limit: if self.query == Query::Approximate { config.step_budget } else { u32::MAX },
            steps: 0,
            found: None,
        }
    }
}
