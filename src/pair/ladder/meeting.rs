//! The verdict of a pair of which nothing is known: a tetrahedron of support vertices of the Minkowski difference walks towards
//! the origin, until it provably holds it or a direction separates the bodies. Marching, which looks for nearest points, would
//! first have to find that there are none.

use super::glance::answer_by_axis;
use super::query::{NoBalls, PairQuery};
use crate::answer::{DecidedBy, Outcome, Query, Start, Statistics, contact};
use crate::base::math::UNIT_ROUNDOFF;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::tables::tuning::TURNED_AWAY;
use crate::depth::polytope::{difference, rough_support};
use crate::distance::certificate::reciprocal_length;
use crate::distance::enclosure::{FACES, GENERIC, sides_of_faces};
use crate::distance::separating_axis::AxisTrial;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::state::State;

/// Exchanged corners before marching takes over: bodies that hardly overlap or hardly miss each other.
const MOST_EXCHANGES: u32 = 10;

/// Where the walk ended; nothing of it is proved yet but the enclosure.
enum WalkEnd<L> {
    /// The tetrahedron holds the origin.
    Encloses([VertexPair; 4]),
    /// No vertex of the difference seems to lie as far as the origin along a direction.
    Apart(L, VertexPair),
    Unclear,
}

impl PairQuery<'_, NoBalls> {
    /// Whether such a walk answers: asked where the cache has neither an axis that separates nor an enclosure that holds.
    #[inline(always)]
    pub(super) fn meets_or_misses(&mut self) -> bool {
        self.query == Query::Intersection
            && self.config.start == Start::Automatic
            && self.is_simple()
            && simd::dispatch_to_avx2(&mut OverlapWalk { pair: self })
    }
}

struct OverlapWalk<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
}

impl Kernel for OverlapWalk<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let pair = &mut *self.pair;
        let frame = pair.frame_of_simple::<L>();
        // The distance of two points may be any double, and its square none.
        if !frame.in_range || frame.size == 0.0 {
            return false;
        }
        let (end, supports) = match pair.cache.enclosure(pair.polyhedra()) {
            // The tetrahedron that held the origin the last time is mostly one corner away from one that does.
            Some(last) if last.as_slice().len() == 4 && !frame.has_moved(&pair.cache.marker, TURNED_AWAY) => {
                let (mut pairs, mut corners) = ([[0; 2]; 4], [L::splat(0.0); 4]);
                pairs.copy_from_slice(last.as_slice());
                for k in 0..4 {
                    corners[k] = difference(&frame, pairs[k][0], pairs[k][1]);
                }
                exchange(&frame, pairs, corners, 0)
            }
            _ => walk(&frame),
        };
        match end {
            WalkEnd::Encloses(pairs) => {
                pair.cache.remember_enclosure(&pairs);
                let polyhedra = pair.polyhedra();
                let answer = &mut *pair.answer;
                answer.outcome = Outcome::Intersecting;
                (answer.distance, answer.lower, answer.upper) = (0.0, 0.0, 0.0);
                contact::fill_proof(answer, polyhedra, &pairs);
                contact::fill_nothing(answer);
            }
            WalkEnd::Apart(direction, vertices) => {
                let mut trial = AxisTrial::along(&frame, direction.negate(), vertices);
                // A face's normal has several support vertices, of which none is clear.
                if !trial.separates() {
                    trial = trial.next(&frame);
                }
                if !(trial.separates() && pair.is_settled_by(&trial.interval)) {
                    return false;
                }
                // From where marching begins, should the bodies come nearer.
                pair.cache.remember_features(State::vertex_vertex(trial.vertices));
                answer_by_axis(&trial, &frame, pair);
            }
            WalkEnd::Unclear => return false,
        }
        frame.mark(&mut pair.cache.marker);
        pair.answer.decided_by = DecidedBy::Fallback;
        pair.answer.statistics = Statistics { fallback_iterations: supports, ..Statistics::default() };
        true
    }
}

/// Walks from nothing, and counts the support vertices.
#[inline(always)]
fn walk<L: Lanes>(frame: &Frame<L>) -> (WalkEnd<L>, u32) {
    let mut pairs = [[0; 2]; 4];
    let mut corners = [L::splat(0.0); 4];
    // From the centres' difference to the origin, then back, around the line between both, and out of the triangle.
    let centre = frame.bodies[0].offset;
    let is_off = centre.dot(centre) > 1e-12 * frame.size * frame.size;
    let mut direction = if is_off { centre.negate() } else { L::from_vector(&GENERIC) };
    for k in 0..4 {
        let Some(unit) = unit(direction) else { return (WalkEnd::Unclear, k as u32) };
        let (pair, corner) = rough_support(frame, unit, None);
        if unit.dot(corner) < 0.0 {
            return (WalkEnd::Apart(unit, pair), k as u32 + 1);
        }
        (pairs[k], corners[k]) = (pair, corner);
        direction = match k {
            0 => corner.negate(),
            1 => across(corners[0], corner.sub(corners[0])),
            _ => towards_origin(corners[0], corners[1].sub(corners[0]).cross(corner.sub(corners[0]))),
        };
    }
    exchange(frame, pairs, corners, 4)
}

/// Exchanges corners until the tetrahedron holds the origin: each time the vertex farthest beyond the worst face comes in, and the
/// corner opposite that face goes. `made` supports came before.
#[inline(always)]
fn exchange<L: Lanes>(
    frame: &Frame<L>,
    mut pairs: [VertexPair; 4],
    mut corners: [L; 4],
    made: u32,
) -> (WalkEnd<L>, u32) {
    for supports in made..made + MOST_EXCHANGES {
        let sides = sides_of_faces(frame, &corners);
        if sides.certain == 4 {
            return (WalkEnd::Encloses(pairs), supports);
        }
        let mut outermost = 0;
        for k in 1..4 {
            if sides.weights[k] < sides.weights[outermost] {
                outermost = k;
            }
        }
        let [a, b, c] = FACES[outermost].map(|k| corners[k]);
        let normal = b.sub(a).cross(c.sub(a));
        let is_inward = normal.dot(corners[outermost].sub(a)) > 0.0;
        let Some(outward) = unit(if is_inward { normal.negate() } else { normal }) else {
            return (WalkEnd::Unclear, supports);
        };
        let (pair, corner) = rough_support(frame, outward, None);
        if outward.dot(corner) < 0.0 {
            return (WalkEnd::Apart(outward, pair), supports + 1);
        }
        if pairs.contains(&pair) {
            return (WalkEnd::Unclear, supports + 1);
        }
        (pairs[outermost], corners[outermost]) = (pair, corner);
    }
    (WalkEnd::Unclear, made + MOST_EXCHANGES)
}

/// A direction scaled to unit length; `None` if it is too short for that.
#[inline(always)]
fn unit<L: Lanes>(direction: L) -> Option<L> {
    let square = direction.dot(direction);
    // False for a NaN.
    (square >= f64::MIN_POSITIVE).then(|| direction.mul(L::splat(reciprocal_length(square))))
}

/// Perpendicular to a line, towards the origin; of a line through the origin, to any side.
#[inline(always)]
fn across<L: Lanes>(point: L, along: L) -> L {
    // A product of three lengths might overflow when it is squared.
    let along = unit(along).unwrap_or(along);
    let plane = along.cross(point.negate());
    let is_through = plane.dot(plane) <= 16.0 * UNIT_ROUNDOFF * point.dot(point);
    if is_through { along.cross(L::from_vector(&GENERIC)) } else { plane.cross(along) }
}

/// A normal of a plane through a point, turned so that it leads to the origin's side.
#[inline(always)]
fn towards_origin<L: Lanes>(point: L, normal: L) -> L {
    if normal.dot(point) > 0.0 { normal.negate() } else { normal }
}
