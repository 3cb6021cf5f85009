//! How deep two compounds are in each other: between the depth of their deepest two pieces and the length of a translation that is
//! proved to free them.
//!
//! The translations of compound 1 at which two given pieces overlap are the inside of a convex body, an *obstacle*. The depth is
//! how far the origin is from the nearest point outside all obstacles. Any translation whose pose the tree and the pair layer find
//! free is an upper bound; where it comes from matters to its length alone. They come from
//!
//! - a *push*: every pair that overlaps where the search is adds a half-space, along the normal of its depth. The search goes on to
//!   the nearest point of all half-spaces, and ends where nothing overlaps;
//! - a *sweep* along a direction: where two pieces overlap, on to where they part, until nothing overlaps. The distance is convex
//!   along a line: Newton's method comes down to the parting point from beyond;
//! - a *slide* from a translation that frees: to the nearest point of the half-spaces of pieces that touch there. Pieces in the way
//!   add theirs, until nothing overlaps.
//!
//! Lengths are in a unit of the size of the bodies, a power of two, so that no square leaves the doubles.

use super::PlacedCompound;
use super::answer::{CompoundDepth, CompoundSignedDistance};
use super::between::{Between, Reaches};
use super::cache::{CompoundCache, PieceCaches};
use super::half_spaces::{HalfSpaces, MOST_HALF_SPACES};
use super::placed::with_pieces;
use super::signed_distance::signed_distance;
use super::walk::{Aim, PiecePair, walk};
use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, are_finite, binary_order, length, power_of_two};
use crate::base::simd::environment::with_default;
use crate::depth::{DepthAnswer, DepthCache, DepthConfig};
use crate::pair::{self, DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, Placed};

/// The search looks at no more translations.
const MOST_LOOKS: u32 = 2000;

/// Pairs of pieces that a sweep leaves behind, at most.
const MOST_PARTINGS: usize = 64;

/// Steps of Newton's method until two pieces part.
const MOST_STEPS: usize = 24;

/// Slides in a row.
const MOST_SLIDES: usize = 12;

/// Pairs that touch, of which a slide knows from the beginning.
const MOST_TOUCHING: usize = MOST_HALF_SPACES / 2;

/// The normals of so many overlapping pairs are swept along.
const MOST_NORMALS: usize = 8;

/// A push takes the deepest of so many overlapping pairs: those whose boxes overlap most come first.
const MOST_COMPARED: usize = 4;

/// A sweep goes on to this many times the least length known: slides may shorten what it finds.
const SWEPT: f64 = 1.5;

/// How deep two compounds are in each other: the length of the least translation of compound 1 at which no two pieces overlap, so
/// that a plane has one on either side. Touching is allowed.
///
/// `lower` is the depth of the deepest two pieces, which any such translation parts. `upper` is the length of a translation that
/// is proved to free the compounds, the shortest of those tried. It need not be the least. Without budget or errors it ends after
/// a few dozen tries, 2,000 looks at the compounds at most.
///
/// Stateless: equal arguments give equal answers. Compounds that are apart or touch have depth 0 and translation 0; the signed
/// distance tells how far apart they are.
///
/// # Errors
/// As of [`distance`](super::distance), and [`Error::Argument`](crate::base::error::Error::Argument) for a member of `config` out
/// of range; then `answer` is as it was.
pub fn depth(bodies: [PlacedCompound; 2], config: &DepthConfig, answer: &mut CompoundDepth) -> Result<()> {
    with_default(|| {
        config.check()?;
        let mut cache = CompoundCache::default();
        let mut deepest = CompoundSignedDistance::default();
        signed_distance(bodies, &mut cache, &PairConfig::default(), &mut deepest)?;
        let is_deep = deepest.distance.outcome == Outcome::Intersecting && deepest.distance.lower < 0.0;
        *answer = if is_deep {
            let freed = FreeingSearch::new(&bodies, &mut cache, config, &deepest)?.run(&deepest)?;
            CompoundDepth::new(&bodies, deepest, freed)
        } else {
            CompoundDepth { deepest, lower: 0.0, upper: 0.0, translation: [0.0; 3] }
        };
        Ok(())
    })
}

/// Compound 1 with a translation added to its pose, each number rounded.
pub(super) fn translated(body: &PlacedCompound, translation: &[f64; 3]) -> Pose {
    let mut pose = *body.pose;
    for (row, way) in pose.rows.iter_mut().zip(translation) {
        row[3] += way;
    }
    pose
}

/// The length of the translation, as given and as added to the pose; rounded up.
pub(super) fn freeing_length(body: &PlacedCompound, translation: &[f64; 3]) -> f64 {
    let way = translated(body, translation).translation() - body.pose.translation();
    length(&way).max(length(&Vector::from(*translation))) * (1.0 + 8.0 * U)
}

/// A translation of so much moves two pieces by that, up to this: the place of one that is not at the identity is R·t + T, off by u
/// of it along each axis at either pose.
pub(super) fn placing_error(body: &PlacedCompound, translation: f64) -> f64 {
    let placing = body.compound.reach.placing;
    let lengths = placing + body.pose.translation().lp_norm(1) + translation;
    if placing > 0.0 { 8.0 * U * lengths } else { 0.0 }
}

impl CompoundDepth {
    fn new(bodies: &[PlacedCompound; 2], deepest: CompoundSignedDistance, freed: Option<[f64; 3]>) -> CompoundDepth {
        let translation = freed.unwrap_or([f64::NAN; 3]);
        let upper = if freed.is_some() { freeing_length(&bodies[0], &translation) } else { f64::INFINITY };
        let off = placing_error(&bodies[0], upper);
        let lower = (-deepest.distance.upper - off).max(0.0);
        debug_assert!(lower <= upper);
        CompoundDepth { deepest, lower, upper, translation }
    }
}

/// Two pieces that overlap, in the search's unit.
#[derive(Debug, Clone, Copy)]
struct PieceOverlap {
    pieces: [u32; 2],
    /// Unit, from piece 2 to piece 1.
    normal: Vector,
    /// At most so deep along it.
    depth: f64,
}

struct FreeingSearch<'a> {
    bodies: &'a [PlacedCompound<'a>; 2],
    cache: &'a mut CompoundCache,
    /// The unit of length; the world's lengths times its inverse are the search's.
    unit: f64,
    inverse: f64,
    /// So much beyond parting, rounding parts pieces, too.
    margin: f64,
    /// A length that is short enough.
    enough: f64,
    /// Longer translations would leave the doubles.
    longest: f64,
    looks: u32,
    /// The shortest translation known to free.
    best: Option<Vector>,
    best_length: f64,
}

impl<'a> FreeingSearch<'a> {
    fn new(
        bodies: &'a [PlacedCompound<'a>; 2],
        cache: &'a mut CompoundCache,
        config: &DepthConfig,
        deepest: &CompoundSignedDistance,
    ) -> Result<FreeingSearch<'a>> {
        let places = bodies.map(|body| body.pose.translation());
        let levers = bodies[0].compound.reach.lever + bodies[1].compound.reach.lever;
        let size = levers + (places[1] - places[0]).lp_norm(1);
        let order = binary_order(size).clamp(-1022, 1022);
        let [unit, inverse] = [power_of_two(order), power_of_two(-order)];
        // Rounding of the distance of pieces, and of a translation added to the pose.
        let margin = 32.0 * U * (size * inverse) + 8.0 * U * (places[0].lp_norm(1) * inverse);
        let least = -deepest.distance.upper;
        let enough = least + config.absolute_error.max(config.relative_error * least);
        let longest = 0.25 * f64::MAX - places[0].lp_norm(1);
        Ok(FreeingSearch {
            bodies,
            cache,
            unit,
            inverse,
            margin: margin.max(f64::MIN_POSITIVE),
            enough: enough * inverse + 4.0 * margin,
            longest: longest * inverse,
            looks: config.step_budget.min(MOST_LOOKS),
            best: None,
            best_length: f64::INFINITY,
        })
    }

    /// The shortest translation found, in the world.
    fn run(mut self, deepest: &CompoundSignedDistance) -> Result<Option<[f64; 3]>> {
        let first = PieceOverlap {
            pieces: [deepest.piece1, deepest.piece2],
            normal: deepest.distance.normal.into(),
            depth: -deepest.distance.lower * self.inverse,
        };
        self.free_by_balls(&first.normal)?;
        // Bodies of round numbers part exactly, and so fit where there is no room for a margin.
        for margin in [0.0, self.margin] {
            let mut spaces = HalfSpaces::new(0.25 * margin + 2.0 * U);
            spaces.add(first.normal, first.depth + margin);
            if self.push(spaces, margin)? {
                break;
            }
        }
        self.slide(self.best)?;
        let mut directions = Directions::new();
        self.gather(&first, &mut directions)?;
        for direction in &directions.all[..directions.count] {
            let found = self.sweep(direction, first.pieces)?;
            self.slide(found)?;
        }
        Ok(self.best.map(|best| self.in_world(&best)))
    }

    fn in_world(&self, x: &Vector) -> [f64; 3] {
        (x * self.unit).into()
    }

    /// Whether a translation of this length is worth a look.
    fn may_look(&self, length: f64, limit: f64) -> bool {
        self.looks > 0 && self.best_length > self.enough && length < limit && length < self.longest
    }

    /// A translation at which nothing overlaps.
    fn keep(&mut self, x: Vector) {
        let length = x.norm();
        if length < self.best_length {
            (self.best, self.best_length) = (Some(x), length);
        }
    }

    /// So far along a direction that balls about both origins are apart: it frees, whatever the budget.
    fn free_by_balls(&mut self, direction: &Vector) -> Result<()> {
        let [one, two] = self.bodies;
        let way = (one.pose.translation() - two.pose.translation()) * self.inverse;
        let levers = (one.compound.reach.lever + two.compound.reach.lever) * self.inverse;
        let length = (way.norm() + levers) * (1.0 + 1e-6) + self.margin;
        // Farther for poses that stretch, whose balls are larger.
        for x in [1.0, 4.0].map(|factor| direction * (factor * length)) {
            // False for a NaN.
            if !(4.0 * length < self.longest) {
                break;
            }
            let there = translated(one, &self.in_world(&x));
            let bodies = [one.compound.at(&there), *two].map(|body| body.placed_pieces());
            if Reaches::new(&bodies)?.between_balls() > 0.0 {
                self.keep(x);
                break;
            }
        }
        Ok(())
    }

    /// Calls `ask` for each two pieces that boxes do not show to be farther apart than `reach` at a translation, until it says no.
    fn look(
        &mut self,
        x: &Vector,
        reach: f64,
        mut ask: impl FnMut([u32; 2], [Placed; 2], &mut PairCache) -> Result<bool>,
    ) -> Result<()> {
        debug_assert!(are_finite(x) && self.looks > 0);
        self.looks -= 1;
        let pose = translated(&self.bodies[0], &self.in_world(x));
        let bodies = [self.bodies[0].compound.at(&pose), self.bodies[1]].map(|body| body.placed_pieces());
        let between = Between::new(&bodies, &Reaches::new(&bodies)?);
        let trees = bodies.map(|body| body.tree);
        let (cache, reach) = (&mut *self.cache, reach * self.unit);
        let aim = if reach > 0.0 { Aim::Distance } else { Aim::Verdict };
        walk(PiecePair { trees, between: &between, aim }, reach, |pieces| {
            let goes_on = with_pieces(&bodies, pieces, |placed| ask(pieces, placed, cache.of(pieces)))?;
            Ok(goes_on.then_some(reach))
        })?;
        Ok(())
    }

    /// The first pairs of pieces that overlap at a translation, at most so many.
    fn overlaps(&mut self, x: &Vector, most: usize, mut visit: impl FnMut(&PieceOverlap)) -> Result<()> {
        let (inverse, mut count) = (self.inverse, 0);
        self.look(x, 0.0, |pieces, placed, cache| {
            if meet(placed, cache)?.is_some()
                && let Some((normal, depth)) = overlap_of(placed)?
            {
                visit(&PieceOverlap { pieces, normal, depth: depth * inverse });
                count += 1;
            }
            Ok(count < most)
        })
    }

    /// Two pieces that overlap at a translation. How deep is asked where they may touch alone, which integers decide.
    fn blocking(&mut self, x: &Vector) -> Result<Option<[u32; 2]>> {
        let mut found = None;
        self.look(x, 0.0, |pieces, placed, cache| {
            let may_touch = |by| by == DecidedBy::Integers || placed.iter().any(|body| body.shape.swept_radius() > 0.0);
            if let Some(by) = meet(placed, cache)?
                && (!may_touch(by) || overlap_of(placed)?.is_some())
            {
                found = Some(pieces);
            }
            Ok(found.is_none())
        })?;
        Ok(found)
    }

    /// From half-spaces on to a translation at which nothing overlaps; whether there is one.
    fn push(&mut self, mut spaces: HalfSpaces, margin: f64) -> Result<bool> {
        while let Some(x) = spaces.nearest() {
            if !self.may_look(x.norm(), self.best_length) {
                break;
            }
            let mut deepest: Option<PieceOverlap> = None;
            self.overlaps(&x, MOST_COMPARED, |found| {
                if deepest.is_none_or(|known| found.depth > known.depth) {
                    deepest = Some(*found);
                }
            })?;
            let Some(PieceOverlap { normal, depth, .. }) = deepest else {
                self.keep(x);
                return Ok(true);
            };
            spaces.add(normal, normal.dot(&x) + depth + margin);
            if spaces.nearest() == Some(x) {
                break;
            }
        }
        Ok(false)
    }

    /// Along a direction, from the origin, to where nothing overlaps; `first` overlaps at the origin.
    fn sweep(&mut self, direction: &Vector, first: [u32; 2]) -> Result<Option<Vector>> {
        let (mut pieces, mut t) = (first, 0.0);
        for _ in 0..MOST_PARTINGS {
            t = self.parting(pieces, direction, t)?;
            let x = direction * t;
            if !self.may_look(t, SWEPT * self.best_length) {
                break;
            }
            let Some(next) = self.blocking(&x)? else {
                self.keep(x);
                return Ok(Some(x));
            };
            pieces = next;
        }
        Ok(None)
    }

    /// About where two pieces part that overlap at t, somewhat beyond.
    fn parting(&mut self, pieces: [u32; 2], direction: &Vector, t: f64) -> Result<f64> {
        let mut s = t + self.way_of_balls(pieces, direction, t);
        if !(s < self.longest) {
            return Ok(f64::INFINITY);
        }
        for _ in 0..MOST_STEPS {
            let near = self.contact_at(&(direction * s), pieces)?;
            let slope = Vector::from(near.normal).dot(direction);
            let step = (near.lower * self.inverse - self.margin) / slope;
            // False for a NaN: of pieces that touch, by rounding.
            if !(near.outcome == Outcome::Separated && slope > 0.0 && step > self.margin) {
                break;
            }
            s = (s - step).max(t);
        }
        Ok(s.max(t + self.margin))
    }

    /// How far it is from t until the balls around two pieces part.
    fn way_of_balls(&self, pieces: [u32; 2], direction: &Vector, t: f64) -> f64 {
        let pose = translated(&self.bodies[0], &self.in_world(&(direction * t)));
        let bodies = [self.bodies[0].compound.at(&pose), self.bodies[1]].map(|body| body.placed_pieces());
        with_pieces(&bodies, pieces, |placed| {
            let centre = |body: Placed| body.pose.transform(&body.shape.polyhedron().centre);
            let radius = |body: Placed| body.shape.polyhedron().radius + body.shape.swept_radius();
            let way = (centre(placed[0]) - centre(placed[1])) * self.inverse;
            let radii = (radius(placed[0]) + radius(placed[1])) * self.inverse * (1.0 + 0.02) + self.margin;
            let along = way.dot(direction);
            (along * along - way.norm_squared() + radii * radii).max(0.0).sqrt() - along + self.margin
        })
    }

    fn contact_at(&mut self, x: &Vector, pieces: [u32; 2]) -> Result<PairAnswer> {
        let pose = translated(&self.bodies[0], &self.in_world(x));
        let bodies = [self.bodies[0].compound.at(&pose), self.bodies[1]].map(|body| body.placed_pieces());
        let (cache, mut answer) = (self.cache.of(pieces), PairAnswer::default());
        with_pieces(&bodies, pieces, |placed| pair::contact(placed, cache, &PairConfig::default(), &mut answer))?;
        Ok(answer)
    }

    /// From a translation that frees to shorter ones.
    fn slide(&mut self, from: Option<Vector>) -> Result<()> {
        let mut last = from;
        for _ in 0..MOST_SLIDES {
            let Some(x) = last else { break };
            last = self.shorter(&x)?;
        }
        Ok(())
    }

    /// A translation that frees and is shorter than one that does: in the half-spaces of pieces that touch there, and of those that
    /// are found in the way.
    fn shorter(&mut self, x: &Vector) -> Result<Option<Vector>> {
        if !self.may_look(0.0, f64::INFINITY) {
            return Ok(None);
        }
        let mut spaces = self.touching(x)?;
        while let Some(y) = spaces.nearest() {
            if !self.may_look(y.norm(), x.norm() * (1.0 - 1e-9)) {
                break;
            }
            let Some(pieces) = self.blocking(&y)? else {
                self.keep(y);
                return Ok(Some(y));
            };
            let near = self.contact_at(x, pieces)?;
            self.bound(&mut spaces, x, &near);
        }
        Ok(None)
    }

    /// The half-spaces of pieces that touch at a translation that frees, about.
    fn touching(&mut self, x: &Vector) -> Result<HalfSpaces> {
        let reach = 8.0 * self.margin + 1e-7 * x.norm();
        let config = PairConfig { max_distance: reach * self.unit, ..PairConfig::default() };
        let mut touching = [PairAnswer::default(); MOST_TOUCHING];
        let mut count = 0;
        self.look(x, reach, |_, placed, cache| {
            let near = &mut touching[count];
            pair::contact(placed, cache, &config, near)?;
            count += usize::from(near.outcome != Outcome::Beyond);
            Ok(count < MOST_TOUCHING)
        })?;
        let mut spaces = HalfSpaces::new(0.25 * self.margin);
        touching[..count].iter().for_each(|near| self.bound(&mut spaces, x, near));
        Ok(spaces)
    }

    /// Adds the half-space of two pieces that are apart or touch at a translation.
    fn bound(&self, spaces: &mut HalfSpaces, x: &Vector, near: &PairAnswer) {
        let normal = Vector::from(near.normal);
        if are_finite(&normal) {
            spaces.add(normal, normal.dot(x) - (near.distance * self.inverse - self.margin).max(0.0));
        }
    }

    /// Directions to sweep along: normals of overlapping pieces, their sum, the way between the middles, the axes and
    /// diagonals of both boxes.
    fn gather(&mut self, first: &PieceOverlap, directions: &mut Directions) -> Result<()> {
        directions.add(&first.normal);
        let mut sum = first.normal * first.depth;
        if self.may_look(0.0, f64::INFINITY) {
            self.overlaps(&Vector::zeros(), MOST_NORMALS, |found| {
                directions.add(&found.normal);
                sum += found.normal * found.depth;
            })?;
        }
        let bodies = self.bodies;
        let middle = |body: &PlacedCompound| {
            let [x, y, z, _] = body.compound.tree.nodes[0].fitted.centre;
            body.pose.transform(&Vector::new(x, y, z)) * self.inverse
        };
        directions.add(&sum);
        directions.add(&(middle(&bodies[0]) - middle(&bodies[1])));
        for body in bodies {
            let [a, b, c] =
                body.compound.tree.oriented[0].axes.map(|[x, y, z, _]| body.pose.rotate(&Vector::new(x, y, z)));
            for way in [a, b, c, a + b + c, a + b - c, a - b + c, a - b - c] {
                directions.add(&way);
                directions.add(&-way);
            }
        }
        Ok(())
    }
}

/// What decided that two pieces intersect, if they do.
fn meet(placed: [Placed; 2], cache: &mut PairCache) -> Result<Option<DecidedBy>> {
    let mut verdict = PairAnswer::default();
    pair::intersection(placed, cache, &PairConfig::default(), &mut verdict)?;
    Ok((verdict.outcome == Outcome::Intersecting).then_some(verdict.decided_by))
}

/// The normal of two pieces that overlap, and how deep they do at most; touching ones do not.
fn overlap_of(placed: [Placed; 2]) -> Result<Option<(Vector, f64)>> {
    let mut deep = DepthAnswer::default();
    pair::depth(placed, &mut DepthCache::default(), &DepthConfig::default(), &mut deep)?;
    Ok((deep.upper > 0.0).then_some((deep.normal.into(), deep.upper)))
}

/// Directions for sweeps, none nearly as another.
struct Directions {
    all: [Vector; MOST_DIRECTIONS],
    count: usize,
}

/// Room for all that are gathered.
const MOST_DIRECTIONS: usize = MOST_NORMALS + 31;

impl Directions {
    fn new() -> Directions {
        Directions { all: [Vector::zeros(); MOST_DIRECTIONS], count: 0 }
    }

    fn add(&mut self, way: &Vector) {
        /// The cosine of about a degree.
        const NEAR: f64 = 0.9998;
        let Some(direction) = way.try_normalize(f64::MIN_POSITIVE) else { return };
        let is_new = self.all[..self.count].iter().all(|known| known.dot(&direction) < NEAR);
        if is_new && are_finite(&direction) && self.count < MOST_DIRECTIONS {
            self.all[self.count] = direction;
            self.count += 1;
        }
    }
}
