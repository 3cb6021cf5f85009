//! The search: from the last polytope, or a first one, until both bounds meet.

use super::cycle::{Apex, Demand, Edges, insert, take_out};
use super::planes::{evaluate, nearest};
use super::proposal::{Goal, MOST_PROPOSED, propose};
use super::sliver::{sharpen, straighten};
use super::storage::{NO_PLANE, Polytope};
use super::support::{Support, support};
use super::{PairRounding, centre_of_differences, degree, first};
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// Steps made with a polytope of an earlier query before it is given up for a first one.
const WARM_STEPS: u32 = 48;

/// Steps in all, regardless of the budget; on the hard cases 231 were the most.
const MOST_STEPS: u32 = 400;

/// A polytope with more triangles than this that are nearer than they should be is given up at once: this many expansions take as
/// long as a first polytope.
const MOST_STALE: usize = 8;

/// A polytope with more triangles than this, and than half as many again as the last first polytope had, is given up, too: each
/// query takes time in proportion to them.
const MOST_KEPT: usize = 56;

/// The first polytope is still so coarse that the tables know better where to climb from.
const COARSE: usize = 16;

/// The goal of a search.
#[derive(Debug, Clone, Copy)]
pub struct WantedDepth {
    /// How wide the interval may be; at least [`PairRounding::provable`] counts.
    pub width: f64,
    /// Or how wide as a multiple of its lower end.
    pub relative: f64,
    /// How many steps it may take.
    pub steps: u32,
    /// The value that the lower end must reach, if it can: 0 except in a search for a proof.
    pub lower: f64,
}

/// The start of a search.
#[derive(Debug, Clone, Copy)]
pub struct SearchStart {
    /// The triangle of the polytope whose normal was the direction of least overlap, if there is a polytope.
    pub triangle: Option<usize>,
    /// A direction of small overlap, where no polytope is known.
    pub direction: Option<Vector>,
    /// Triangles of the last first polytope.
    pub first_triangles: usize,
    /// Whether there is a better way than a first polytope where the one that is known is not worth going on with.
    pub only_known: bool,
}

/// How a search ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// A direction separates the bodies.
    Separated,
    /// The interval is as narrow as was wanted.
    Narrow,
    /// The steps were spent.
    Spent,
    /// No triangle could be added where one is needed: the room is full, or rounding hides where.
    Stuck,
    /// The differences are flat as far as rounding lets one see.
    Flat,
    /// The known state was not worth going on with, and nothing else was to be tried.
    Outdated,
}

/// The result of a search.
#[derive(Debug, Clone, Copy)]
pub struct Expansion {
    /// How it ended.
    pub ending: Ending,
    /// The depth of intersecting bodies is at least this; more than 0 only if they provably intersect.
    pub lower: f64,
    /// Along `direction` the bodies overlap by at most this; negative: they are so far apart at least.
    pub upper: f64,
    /// The unit vector, from the inside of the Minkowski difference to the boundary, along which the bodies overlap least.
    pub direction: Vector,
    /// The vertices that reach farthest along it.
    pub farthest: VertexPair,
    /// Triangles of the last first polytope.
    pub first_triangles: usize,
    /// Whether the polytope is the one that the search began with.
    pub is_as_kept: bool,
    /// Expansions.
    pub steps: u32,
    /// Support vertices asked for.
    pub supports: u32,
}

/// The search in a polytope that is closed, or is not but is [no cycle](Edges::are_cycle), with its positions computed; or empty.
#[inline(always)]
pub fn expand<L: Lanes, const V: usize, const T: usize, const W: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    start: &SearchStart,
    wanted: &WantedDepth,
) -> Expansion {
    let rounding = PairRounding::of(frame);
    let mut search = Expander {
        frame,
        share: 1.0 - 1.0 / (1.0 + wanted.relative),
        width: if wanted.width > rounding.provable { wanted.width } else { rounding.provable },
        best: NearestFacet { upper: f64::INFINITY, excess: 0.0, direction: Vector::zeros(), farthest: [0; 2] },
        lower: wanted.lower,
        demand: Demand { centre: centre_of_differences(frame), about_origin: false, least: NO_PLANE, rounding },
        edges: Edges::<V, W>::EMPTY,
        steps: 0,
        supports: 0,
        first_triangles: start.first_triangles,
        is_as_kept: false,
    };
    let ending = search.run(polytope, start, wanted.steps.min(MOST_STEPS));
    let is_sure = ending != Ending::Separated && polytope.triangle_count > 0;
    let lower = if is_sure { nearest::<L, V, T>(polytope).1 } else { 0.0 };
    let lower = if lower > 0.0 && degree::is_positive(polytope, &rounding) { lower } else { 0.0 };
    Expansion {
        ending,
        lower: if lower < search.best.upper { lower } else { search.best.upper.max(0.0) },
        upper: search.best.upper,
        direction: search.best.direction,
        farthest: search.best.farthest,
        first_triangles: search.first_triangles,
        is_as_kept: search.is_as_kept,
        steps: search.steps,
        supports: search.supports,
    }
}

/// The least upper bound so far.
struct NearestFacet {
    upper: f64,
    /// The part of it that is due to ties at the support vertices, which no expansion reduces.
    excess: f64,
    direction: Vector,
    farthest: VertexPair,
}

struct Expander<'a, L, const V: usize, const W: usize> {
    frame: &'a Frame<'a, L>,
    /// How wide the interval may be …
    width: f64,
    /// … or as a share of its upper end.
    share: f64,
    /// See [`WantedDepth::lower`].
    lower: f64,
    best: NearestFacet,
    demand: Demand,
    edges: Edges<V, W>,
    steps: u32,
    supports: u32,
    first_triangles: usize,
    is_as_kept: bool,
}

/// How many triangles of a polytope are nearer than so much.
#[inline(always)]
fn nearer_than<const V: usize, const T: usize>(polytope: &Polytope<V, T>, distance: f64) -> usize {
    polytope.distances[..polytope.triangle_count].iter().filter(|other| **other < distance).count()
}

/// The result of a step.
enum Advance {
    /// Go on.
    On,
    /// Nothing can be done about the nearest triangle.
    Stuck,
    /// The bodies are separated.
    Separated,
}

impl<L: Lanes, const V: usize, const W: usize> Expander<'_, L, V, W> {
    #[inline(always)]
    fn run<const T: usize>(&mut self, polytope: &mut Polytope<V, T>, start: &SearchStart, most_steps: u32) -> Ending {
        let mut is_warm = self.takes_over(polytope, start);
        self.is_as_kept = is_warm;
        if self.best.upper < 0.0 {
            return Ending::Separated;
        }
        loop {
            if !is_warm {
                if start.only_known {
                    return Ending::Outdated;
                }
                self.is_as_kept = false;
                // No direction of an earlier query but one that was not kept with its polytope: as a start it saves two steps of
                // 17.
                let known = start.direction.as_ref().filter(|_| start.triangle.is_none());
                let Some(centre) = self.begin(polytope, known, most_steps) else { return self.measure_flat(polytope) };
                self.demand = Demand { centre, about_origin: false, ..self.demand };
            }
            let limit = if is_warm { WARM_STEPS.min(most_steps) } else { most_steps };
            let ending = self.grow(polytope, limit, is_warm);
            if is_warm && matches!(ending, Ending::Stuck | Ending::Spent) && self.steps < most_steps {
                is_warm = false;
                continue;
            }
            if !is_warm {
                self.first_triangles = polytope.triangle_count;
            }
            return ending;
        }
    }

    /// The first polytope, where there is room for a proposal as single precision lets it grow; and the point inside.
    #[inline(always)]
    fn begin<const T: usize>(
        &mut self,
        polytope: &mut Polytope<V, T>,
        known: Option<&Vector>,
        most_steps: u32,
    ) -> Option<Vector> {
        let centre = first::make(self.frame, polytope, &self.demand.rounding, known, &mut self.supports)?;
        if V > MOST_PROPOSED {
            return Some(centre);
        }
        // One step is left for an upper bound.
        let steps = (most_steps - self.steps).saturating_sub(1);
        let goal = Goal { width: self.width, share: self.share, steps };
        let [steps, supports] = propose::<L, V, T, W>(self.frame, polytope, &mut self.edges, &goal);
        self.steps += steps;
        self.supports += supports;
        if evaluate::<L, V, T>(polytope, &self.demand.rounding, &centre, 0, polytope.triangle_count).height > 0.0 {
            return Some(centre);
        }
        // Single precision has turned a triangle over.
        first::make(self.frame, polytope, &self.demand.rounding, known, &mut self.supports)
    }

    /// Upper bounds of differences too flat for a search: across the part of a polytope that exists, and along the axes of the
    /// world.
    #[cold]
    fn measure_flat<const T: usize>(&mut self, polytope: &Polytope<V, T>) -> Ending {
        if polytope.triangle_count > 0 {
            let (triangle, distance) = nearest::<L, V, T>(polytope);
            if distance > NO_PLANE {
                self.ask(&polytope.normal(triangle), None, f64::INFINITY);
            }
        }
        for axis in [Vector::x(), Vector::y(), Vector::z()] {
            self.ask(&axis, None, f64::INFINITY);
            self.ask(&-axis, None, f64::INFINITY);
        }
        if self.best.upper < 0.0 { Ending::Separated } else { Ending::Flat }
    }

    /// Whether the polytope of the last query is worth going on with. Its best direction is tried in any case: at a tie it stays.
    #[inline(always)]
    fn takes_over<const T: usize>(&mut self, polytope: &mut Polytope<V, T>, start: &SearchStart) -> bool {
        let count = polytope.triangle_count;
        let Some(triangle) = start.triangle.filter(|triangle| *triangle < count) else { return false };
        let least = evaluate::<L, V, T>(polytope, &self.demand.rounding, &self.demand.centre, 0, count);
        let distance = polytope.distances[triangle];
        let about_origin = !(least.height > self.demand.rounding.plane);
        // No support makes those fewer that are nearer than the plane that it is beyond.
        let is_far =
            (about_origin && !(least.distance > 0.0)) || nearer_than(polytope, distance - self.width) > MOST_STALE;
        if distance > NO_PLANE {
            // From far away the tables know better where to climb from.
            let [pair, ..] = polytope.pairs_of(triangle);
            self.ask(&polytope.normal(triangle), if is_far { None } else { Some(pair) }, f64::INFINITY);
            if self.best.upper < 0.0 {
                return true;
            }
        }
        if is_far {
            return false;
        }
        self.demand.about_origin = about_origin;
        // Whether it is closed is asked last: for poses far from the last ones it is not needed.
        nearer_than(polytope, self.target()) <= MOST_STALE
            && count <= MOST_KEPT.max(self.first_triangles * 3 / 2)
            && self.edges.are_cycle(&polytope.corners[..count], polytope.vertex_count)
    }

    /// The target for the nearest triangle's distance: so near to the upper bound, and more than 0, which proves the verdict,
    /// where that can be proved.
    #[inline(always)]
    fn target(&self) -> f64 {
        // Nothing bounds it yet, and no share of infinity is 0.
        if self.best.upper == f64::INFINITY {
            return f64::INFINITY;
        }
        let value = self.best.upper - self.best.excess;
        let share = self.share * value;
        let target = value - if share > self.width { share } else { self.width };
        let provable = value - self.demand.rounding.provable;
        let least = if provable > 0.0 { f64::MIN_POSITIVE } else { provable };
        let target = if target > least { target } else { least };
        // If the bounds meet, the planes' error still is between the distance of a triangle and the support beyond it, twice.
        let lower = self.lower.min(value - 2.0 * self.demand.rounding.plane);
        if target > lower { target } else { lower }
    }

    /// Asks for a support, or a pair that reaches `enough`, and takes its direction if the bodies overlap less along it.
    #[inline(always)]
    fn ask(&mut self, direction: &Vector, from: Option<VertexPair>, enough: f64) -> Support {
        self.supports += 1;
        let found = support(self.frame, &self.demand.rounding, direction, from, enough);
        if found.upper < self.best.upper {
            let Support { upper, excess, pair, .. } = found;
            self.best = NearestFacet { upper, excess, direction: *direction, farthest: pair };
        }
        found
    }

    /// Expands until the interval is narrow enough.
    #[inline(always)]
    fn grow<const T: usize>(&mut self, polytope: &mut Polytope<V, T>, most_steps: u32, is_warm: bool) -> Ending {
        let mut straightened = None;
        loop {
            let (triangle, distance) = nearest::<L, V, T>(polytope);
            if distance >= self.target() && self.best.upper < f64::INFINITY {
                return Ending::Narrow;
            }
            if self.steps >= most_steps {
                return Ending::Spent;
            }
            self.is_as_kept = false;
            self.steps += 1;
            match self.step(polytope, triangle, is_warm, &mut straightened) {
                Advance::On => {}
                Advance::Separated => return Ending::Separated,
                Advance::Stuck => return Ending::Stuck,
            }
        }
    }

    /// Expands beyond the nearest triangle; where that fails it gives it a better plane. `straightened` is the triangle that got
    /// one last.
    #[inline(always)]
    fn step<const T: usize>(
        &mut self,
        polytope: &mut Polytope<V, T>,
        triangle: usize,
        is_warm: bool,
        straightened: &mut Option<usize>,
    ) -> Advance {
        if polytope.distances[triangle] > NO_PLANE {
            let normal = polytope.normal(triangle);
            let height = |corner: &u8| normal.dot(&polytope.position(*corner));
            let corners = polytope.corners_of(triangle);
            let highest = corners.iter().fold(corners[0], |a, b| if height(b) > height(&a) { *b } else { a });
            let highest_value = height(&highest);
            let is_coarse = !is_warm && polytope.triangle_count < COARSE;
            let from = (!is_coarse).then_some(polytope.pairs[usize::from(highest)]);
            // Beyond the plane, and no less bound than is known: then it is a vertex to insert, whether it is the farthest or
            // not.
            let beyond = highest_value + 2.0 * self.demand.rounding.plane;
            let found = self.ask(&normal, from, if self.best.upper > beyond { self.best.upper } else { beyond });
            if self.best.upper < 0.0 {
                return Advance::Separated;
            }
            if polytope.distances[triangle] >= self.target() {
                return Advance::On;
            }
            if found.value - highest_value > self.demand.rounding.plane && self.insert(polytope, triangle, &found) {
                *straightened = None;
                return Advance::On;
            }
            if *straightened != Some(triangle) {
                *straightened = Some(triangle);
                if straighten(self.frame, polytope, &self.demand.rounding, triangle) {
                    return Advance::On;
                }
            }
        }
        let direction = (self.best.upper < f64::INFINITY).then_some(&self.best.direction);
        if sharpen(polytope, &self.demand.rounding, triangle, direction) { Advance::On } else { Advance::Stuck }
    }

    /// Inserts a support vertex beyond a triangle. Where the polytope has it already, that has to raise the least distance, so that
    /// the search cannot go round in circles.
    #[inline(always)]
    fn insert<const T: usize>(&mut self, polytope: &mut Polytope<V, T>, triangle: usize, found: &Support) -> bool {
        let known = polytope.find(found.pair);
        let added = || polytope.add_vertex(found.pair, found.position);
        let Some(vertex) = known.or_else(added) else { return false };
        let apex = Apex { vertex, is_known: known.is_some() && polytope.has_triangle(vertex) };
        let before = polytope.distances[triangle];
        let raised = before + self.demand.rounding.plane;
        self.demand.least = if apex.is_known && before > 0.0 { raised + 1e-9 * raised } else { NO_PLANE };
        insert::<L, V, T, W>(polytope, &mut self.edges, triangle, apex, &self.demand)
            || (apex.is_known && take_out::<L, V, T, W>(polytope, &mut self.edges, triangle, &self.demand))
    }
}
