//! How deep two objects are in each other: an interval that holds the least translation that parts them, and where.
//!
//! Floating point searches and proves: of small bodies by all facets, `solve/facets/`, else by `solve/polytope/`. Integers decide
//! what rounding hides at the ends: objects that touch, flat ones, objects that hardly overlap.

mod answer;
mod cache;
mod scaling;

use crate::base::error::Result;
use crate::base::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF, Vector, clamp};
use crate::base::simd::environment::with_default;
use crate::base::simd::{self, Kernel, Lanes, Work};
use crate::pair::answer::Outcome;
use crate::pair::contact;
use crate::pair::placed::Placed;
use crate::polyhedron::Polyhedron;
use crate::polyhedron::fan::Fan;
use crate::solve::decide::combinations;
use crate::solve::exact::{self, ExactAnswer, Position, Supports, VertexPair};
use crate::solve::facets::{self, Outcome as ByFacets, Overlap};
use crate::solve::frame::Frame;
use crate::solve::polytope::{self, Ending, Expansion, Polytope, SearchStart, Wanted, Witness};
use crate::solve::state::FeatureId;
pub use answer::{DepthAnswer, DepthConfig, DepthEnding, DepthStatistics};
pub use cache::DepthCache;
use cache::{MOST_TRIANGLES, MOST_VERTICES};
use scaling::{Rescaled, is_in_scale};

/// How deep two polyhedra are in each other.
///
/// # Errors
/// As of [`crate::pair::depth`].
pub(super) fn of_polyhedra(
    bodies: [Placed; 2],
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    with_default(|| answer_query(bodies, cache, config, answer))
}

fn answer_query(
    bodies: [Placed; 2],
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    config.check()?;
    let (polyhedra, poses) = (bodies.map(|body| body.shape.polyhedron()), bodies.map(|body| body.pose));
    let mut found = simd::dispatch_to_avx2(&mut DepthQuery { polyhedra, poses, config, cache });
    if found.is_none() {
        poses.iter().try_for_each(|pose| pose.check(config.rotation_limit))?;
        found = search_rescaled(polyhedra, poses, config, cache);
    }
    fill(answer, polyhedra, poses, found.as_ref());
    Ok(())
}

/// Along which direction two bodies that intersect overlap least, for poses that are accepted: a depth from nothing.
pub(super) fn deepest(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> DepthAnswer {
    let (mut cache, config, mut answer) = (DepthCache::default(), DepthConfig::default(), DepthAnswer::default());
    let found = simd::dispatch_to_avx2(&mut DepthQuery { polyhedra, poses, config: &config, cache: &mut cache });
    let found = found.or_else(|| search_rescaled(polyhedra, poses, &config, &mut cache));
    fill(&mut answer, polyhedra, poses, found.as_ref());
    answer
}

/// The search among copies of the bodies in another unit of length, for poses that are accepted. `None` of a pair that floating
/// point is not for in any unit.
#[cold]
#[inline(never)]
fn search_rescaled(
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    config: &DepthConfig,
    cache: &mut DepthCache,
) -> Option<Search> {
    let pair = Rescaled::of(polyhedra, poses)?;
    let config = DepthConfig { absolute_error: pair.in_unit(config.absolute_error), ..*config };
    let (polyhedra, poses) = (pair.polyhedra(), pair.poses());
    // Copies have no fan.
    let Search::Polytope(found) = simd::dispatch_to_avx2(&mut DepthQuery { polyhedra, poses, config: &config, cache })?
    else {
        return None;
    };
    let FoundPolytope { expansion, witness, .. } = found;
    let upper = pair.upper_of(expansion.upper);
    if upper == f64::INFINITY && expansion.upper < upper {
        return None;
    }
    Some(Search::Polytope(FoundPolytope {
        expansion: Expansion { lower: pair.lower_of(expansion.lower), upper, ..expansion },
        witness: Witness { depth: pair.lower_of(witness.depth), ..witness },
        ..found
    }))
}

/// The search in floating point, compiled for the machine's vector units; it keeps the polytope.
struct DepthQuery<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    config: &'a DepthConfig,
    cache: &'a mut DepthCache,
}

/// What looking at all facets takes: planes times corners of the pair, see [`facets::work`]. Below this it takes less time than
/// moving on a polytope that was kept …
const LITTLE_WORK: usize = 3_000;

/// … and below this less than making one.
const MOST_WORK: usize = 16_000;

/// How wide an interval may be, over the pair's size or distance, a little less than is promised. By all facets it is wider where
/// faces were merged of triangles that lean out of them by rounding, or edges are nearly parallel. A polytope does better then …
const WIDEST: f64 = 176.0 * UNIT_ROUNDOFF;

/// … unless it comes to no end.
const WIDEST_OF_ALL: f64 = 1e-9;

/// What widths are relative to: the pair's size, or how far the bodies' origins are apart.
#[inline(always)]
fn scale_of<L: Lanes>(frame: &Frame<L>) -> f64 {
    if frame.separation > frame.size { frame.separation } else { frame.size }
}

/// Whether an interval is no wider than this: then it is as narrow as is promised though rounding hides where the polytope could
/// grow, as it does where vertices tie.
#[inline(always)]
fn is_narrow(expansion: &Expansion, widest: f64) -> bool {
    expansion.lower > 0.0 && expansion.upper - expansion.lower <= widest
}

/// What one search or the other found.
enum Search {
    /// All facets.
    Facets(Overlap),
    /// Along this direction, from body 1 to body 2, the bodies are apart.
    Apart(Vector),
    /// A polytope.
    Polytope(FoundPolytope),
}

/// What the search by a polytope found.
struct FoundPolytope {
    expansion: Expansion,
    witness: Witness,
    triangles: u32,
}

impl FoundPolytope {
    /// Whether neither a direction that separates the bodies nor an interval that tells them from touching ones has been found,
    /// with room and steps to spare.
    #[inline(always)]
    fn is_open(&self) -> bool {
        match self.expansion.ending {
            // With more room the search begins anew in any case.
            Ending::Separated | Ending::Stuck => false,
            Ending::Narrow => !(self.expansion.lower > 0.0),
            Ending::Spent | Ending::Flat => true,
        }
    }
}

impl Kernel for DepthQuery<'_> {
    /// None of a pair that floating point is not for.
    type Output = Option<Search>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<Search> {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, self.config.rotation_limit);
        if !(frame.in_range && is_in_scale(self.polyhedra)) {
            return None;
        }
        if self.facets_come_first()
            && let Some(found) = self.search_facets(&frame, WIDEST)
        {
            return Some(found);
        }
        L::out_of_line(&mut ByPolytope { query: self, frame: &frame })
    }
}

/// The search by a polytope, and by facets where that does not come to an end.
struct ByPolytope<'a, 'b, L> {
    query: &'a mut DepthQuery<'b>,
    frame: &'a Frame<'a, L>,
}

impl<L: Lanes> Work for ByPolytope<'_, '_, L> {
    type Output = Option<Search>;

    #[inline(always)]
    fn run(&mut self) -> Option<Search> {
        let ByPolytope { query, frame } = self;
        let mut polytope = Polytope::<MOST_VERTICES, { MOST_TRIANGLES + 4 }>::EMPTY;
        let start = query.cache.unpack(frame, &mut polytope);
        let steps = query.config.step_budget;
        let mut found = query.search(frame, &mut polytope, &start, steps);
        let was_told = start.triangle.is_some() || start.direction.is_some();
        // What an earlier query left must not make an answer worse.
        if was_told && found.is_open() && found.expansion.steps < steps {
            let mut again = SearchAgain { search: query, frame, polytope: &mut polytope, first: &found };
            found = L::out_of_line(&mut again);
        }
        if found.expansion.ending != Ending::Stuck {
            return Some(Search::Polytope(found));
        }
        if let Some(found) = query.search_facets(frame, WIDEST_OF_ALL) {
            return Some(found);
        }
        let start = SearchStart { triangle: None, direction: None, ..start };
        Some(Search::Polytope(L::out_of_line(&mut InLarge { search: query, frame, start })))
    }
}

impl<'a> DepthQuery<'a> {
    /// Of a pair of small bodies.
    #[inline(always)]
    fn fans(&self) -> Option<[&'a Fan; 2]> {
        let [polyhedron1, polyhedron2] = self.polyhedra;
        Some([polyhedron1.fan.as_ref()?, polyhedron2.fan.as_ref()?])
    }

    /// Whether all facets are looked at before a polytope is.
    #[inline(always)]
    fn facets_come_first(&self) -> bool {
        let Some(fans) = self.fans() else { return false };
        let work = facets::work(fans);
        work <= LITTLE_WORK || (work <= MOST_WORK && self.cache.is_cold())
    }

    #[inline(always)]
    fn search_facets<L: Lanes>(&mut self, frame: &Frame<L>, widest: f64) -> Option<Search> {
        let fans = self.fans()?;
        match facets::search(frame, fans, self.cache.facet(), widest * scale_of(frame)) {
            ByFacets::Separated(direction, facet) => {
                self.cache.keep_facet(frame, facet, &direction, false);
                Some(Search::Apart(direction))
            }
            ByFacets::Overlapping(overlap) => {
                self.cache.keep_facet(frame, overlap.facet, &overlap.direction, true);
                Some(Search::Facets(overlap))
            }
            ByFacets::Unclear => None,
        }
    }

    #[inline(always)]
    fn search<L: Lanes, const V: usize, const T: usize>(
        &mut self,
        frame: &Frame<L>,
        polytope: &mut Polytope<V, T>,
        start: &SearchStart,
        steps: u32,
    ) -> FoundPolytope {
        let DepthConfig { absolute_error, relative_error, .. } = *self.config;
        let wanted = Wanted { width: absolute_error, relative: relative_error, steps, lower: 0.0 };
        let mut expansion = polytope::expand(frame, polytope, start, &wanted);
        if expansion.ending == Ending::Stuck && is_narrow(&expansion, WIDEST * scale_of(frame)) {
            expansion.ending = Ending::Narrow;
        }
        if polytope.triangle_count == 0 || !(expansion.upper < f64::INFINITY) {
            *self.cache = DepthCache::default();
            let witness = Witness { pairs: [expansion.farthest; 3], count: 1, weights: [1.0; 4], depth: 0.0 };
            return FoundPolytope { expansion, witness, triangles: 0 };
        }
        let (witness, triangle) = polytope::witness(frame, polytope, &expansion);
        if expansion.is_as_kept {
            self.cache.keep(frame, triangle, &expansion.direction);
        } else {
            self.cache.pack(frame, polytope, triangle, &expansion.direction, expansion.first_triangles);
        }
        FoundPolytope { expansion, witness, triangles: polytope.triangle_count as u32 }
    }
}

/// The search from the beginning, with more room: of bodies that are nearly as deep in each other everywhere.
struct InLarge<'a, 'b, L> {
    search: &'a mut DepthQuery<'b>,
    frame: &'a Frame<'a, L>,
    start: SearchStart,
}

impl<L: Lanes> Work for InLarge<'_, '_, L> {
    type Output = FoundPolytope;

    #[inline(always)]
    fn run(&mut self) -> FoundPolytope {
        let mut polytope = Polytope::<255, 508>::EMPTY;
        self.search.search(self.frame, &mut polytope, &self.start, self.search.config.step_budget)
    }
}

/// The search from nothing, after one that what was kept led nowhere. Its answer is that of a first query, as long as the steps do.
struct SearchAgain<'a, 'b, L> {
    search: &'a mut DepthQuery<'b>,
    frame: &'a Frame<'a, L>,
    polytope: &'a mut Polytope<MOST_VERTICES, { MOST_TRIANGLES + 4 }>,
    first: &'a FoundPolytope,
}

impl<L: Lanes> Work for SearchAgain<'_, '_, L> {
    type Output = FoundPolytope;

    #[inline(always)]
    fn run(&mut self) -> FoundPolytope {
        let Expansion { steps, supports, .. } = self.first.expansion;
        let start = SearchStart { triangle: None, direction: None, first_triangles: 0 };
        self.polytope.clear();
        let left = self.search.config.step_budget - steps;
        let mut found = self.search.search(self.frame, self.polytope, &start, left);
        found.expansion.steps += steps;
        found.expansion.supports += supports;
        found
    }
}

/// Answers by what the search found, and where that leaves the verdict open by integers.
fn fill(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: Option<&Search>) {
    answer.statistics = DepthStatistics::default();
    let found = match found {
        None => return decide(answer, polyhedra, poses, None),
        Some(Search::Apart(direction)) => return fill_separated(answer, DepthEnding::Separated, &-direction),
        Some(Search::Facets(overlap)) => return fill_facet(answer, polyhedra, poses, overlap),
        Some(Search::Polytope(found)) => found,
    };
    let FoundPolytope { expansion: Expansion { ending, lower, direction, steps, supports, .. }, triangles, .. } =
        *found;
    answer.statistics = DepthStatistics { steps, supports, triangles, exact_iterations: 0 };
    if ending == Ending::Separated {
        return fill_separated(answer, DepthEnding::Separated, &-direction);
    }
    if !(lower > 0.0) {
        return decide(answer, polyhedra, poses, Some(found));
    }
    answer.ending = match ending {
        Ending::Spent => DepthEnding::Budget,
        Ending::Stuck | Ending::Flat => DepthEnding::Stalled,
        Ending::Narrow | Ending::Separated => DepthEnding::Narrow,
    };
    fill_overlapping(answer, polyhedra, poses, found);
}

fn fill_facet(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: &Overlap) {
    let Overlap { lower, upper, depth, direction, witness, .. } = found;
    (answer.outcome, answer.ending) = (Outcome::Intersecting, DepthEnding::Narrow);
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(*depth, *lower, *upper);
    fill_places(answer, polyhedra, poses, &witness.points, witness.features, &-direction);
}

fn fill_overlapping(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: &FoundPolytope) {
    let FoundPolytope { expansion: Expansion { lower, upper, direction, .. }, witness, .. } = found;
    answer.outcome = Outcome::Intersecting;
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(witness.depth, *lower, *upper);
    let combination = Combination { pairs: &witness.pairs[..witness.count], weights: &witness.weights };
    fill_points(answer, polyhedra, poses, combination, &-direction, upper - lower);
}

/// Decides in integers, with what the search has found.
#[cold]
#[inline(never)]
fn decide(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: Option<&FoundPolytope>) {
    let hint = found.map_or(&[][..], |found| &found.witness.pairs[..found.witness.count]);
    let position = exact::locate(polyhedra, poses, hint, Supports::Climbed);
    answer.ending = DepthEnding::Integers;
    match position {
        Position::Separated(apart) => {
            answer.statistics.exact_iterations = apart.iterations;
            fill_separated(answer, DepthEnding::Integers, &apart.direction);
        }
        Position::Touching { normal, common } => {
            answer.outcome = Outcome::Intersecting;
            (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, 0.0);
            fill_common(answer, polyhedra, poses, &common, &normal);
        }
        Position::Overlapping(common) => {
            let known = found.filter(|found| found.expansion.upper < f64::INFINITY);
            match known {
                // The bounds have met, next to 0.
                Some(found) if found.expansion.ending == Ending::Narrow && has_witness(found, polyhedra, poses) => {
                    fill_overlapping(answer, polyhedra, poses, found);
                    answer.statistics.exact_iterations = common.iterations;
                }
                _ => {
                    // The polytope need not surround the origin, and says no point.
                    let (upper, normal) = match known {
                        Some(found) => (found.expansion.upper, -found.expansion.direction),
                        None => exact::overlap_along_axes(polyhedra, poses),
                    };
                    answer.outcome = Outcome::Intersecting;
                    (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, upper);
                    fill_common(answer, polyhedra, poses, &common, &normal);
                }
            }
        }
    }
}

/// Whether the polytope's points are as far apart as they should be, up to what the depth may be: the weights of a triangle that is
/// thin beside bodies of very different sizes may be anything.
fn has_witness(found: &FoundPolytope, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> bool {
    let FoundPolytope { expansion: Expansion { upper, direction, .. }, witness, triangles } = found;
    let points = combinations(polyhedra, &witness.pairs[..witness.count], &witness.weights);
    let [world1, world2] = contact::placed_points(polyhedra, poses, &points).world.map(Vector::from);
    let along = Vector::from(contact::normalised(direction)) * clamp(witness.depth, 0.0, *upper);
    // False for a NaN.
    *triangles > 0 && (world2 - world1 + along).norm() <= *upper
}

/// Of objects that are apart only a normal is said.
fn fill_separated(answer: &mut DepthAnswer, ending: DepthEnding, normal: &Vector) {
    let statistics = answer.statistics;
    *answer = DepthAnswer {
        outcome: Outcome::Separated,
        ending,
        depth: 0.0,
        lower: 0.0,
        upper: 0.0,
        normal: contact::normalised(normal),
        statistics,
        ..DepthAnswer::default()
    };
}

/// A common point.
fn fill_common(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    common: &ExactAnswer,
    normal: &Vector,
) {
    answer.statistics.exact_iterations = common.iterations;
    let mut weights = [0.0; 4];
    for (weight, exact) in weights.iter_mut().zip(&common.weights) {
        *weight = *exact;
    }
    fill_points(answer, polyhedra, poses, Combination { pairs: &common.pairs, weights: &weights }, normal, 0.0);
}

/// Points of both bodies.
struct Combination<'a> {
    pairs: &'a [VertexPair],
    weights: &'a [f64; 4],
}

/// Of the points the features are said; seen along the normal they are as far as `within` inside the bodies.
fn fill_points(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    combination: Combination,
    normal: &Vector,
    within: f64,
) {
    let Combination { pairs, weights } = combination;
    let points = combinations(polyhedra, pairs, weights);
    let features = contact::features_of_pairs(polyhedra, poses, pairs, &points, normal, within);
    fill_places(answer, polyhedra, poses, &points, features, normal);
}

fn fill_places(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    points: &[Vector; 2],
    features: [FeatureId; 2],
    normal: &Vector,
) {
    let contact::PlacedPoints { local, world } = contact::placed_points(polyhedra, poses, points);
    [answer.local1, answer.local2] = local;
    [answer.world1, answer.world2] = world;
    answer.normal = contact::normalised(normal);
    [answer.feature1, answer.feature2] = [0, 1].map(|i| contact::label(polyhedra[i], features[i], &points[i]));
}

/// Where a proof of a depth is looked for.
#[derive(Clone, Copy)]
pub(super) enum ProofFrom<'a> {
    /// The polytope that a cache holds.
    Cache(&'a DepthCache),
    /// A search like that of a query whose polytope is too large to be kept, for a lower end of at least so much.
    Search(f64),
}

/// The triangles of a polytope in the pair's poses; none where there is no polytope.
pub(super) fn proof(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], from: ProofFrom) -> Vec<[VertexPair; 3]> {
    let found = simd::dispatch_to_avx2(&mut Proof { polyhedra, poses, from });
    let rescaled = || {
        let pair = Rescaled::of(polyhedra, poses)?;
        let from = match from {
            ProofFrom::Cache(_) => from,
            ProofFrom::Search(lower) => ProofFrom::Search(pair.in_unit(lower)),
        };
        simd::dispatch_to_avx2(&mut Proof { polyhedra: pair.polyhedra(), poses: pair.poses(), from })
    };
    found.or_else(rescaled).unwrap_or_default()
}

struct Proof<'a> {
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    from: ProofFrom<'a>,
}

impl Kernel for Proof<'_> {
    /// `None` of a pair that floating point is not for.
    type Output = Option<Vec<[VertexPair; 3]>>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Self::Output {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        if !(frame.in_range && is_in_scale(self.polyhedra)) {
            return None;
        }
        let mut polytope = Polytope::<255, 508>::EMPTY;
        match self.from {
            ProofFrom::Cache(cache) => {
                cache.unpack(&frame, &mut polytope);
            }
            ProofFrom::Search(lower) => {
                let start = SearchStart { triangle: None, direction: None, first_triangles: 0 };
                let wanted = Wanted { width: 0.0, relative: 0.0, steps: u32::MAX, lower };
                polytope::expand(&frame, &mut polytope, &start, &wanted);
            }
        }
        Some((0..polytope.triangle_count).map(|triangle| polytope.pairs_of(triangle)).collect())
    }
}
