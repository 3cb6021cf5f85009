//! The search in floating point: the facet of a pair at rest is looked at first, then all facets of small bodies, else a polytope.

use super::answer::{DepthAnswer, DepthConfig};
use super::cache::DepthCache;
use super::resting::{LeastFacet, look_at_facet};
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::simd::{Kernel, Lanes, Work};
use crate::body::polyhedron::fan::Fan;
use crate::depth::facets::{self, FacetOutcome, Overlap};
use crate::depth::polytope::{
    self, Ending, Expansion, Polytope, PolytopeWitness, SearchStart, WantedDepth, is_in_scale,
};
use crate::placed::Pair;
use crate::placed::frame::Frame;

/// The search in floating point, compiled for the machine's vector units; it keeps the polytope.
pub struct DepthQuery<'a> {
    pub pair: Pair<'a>,
    pub config: &'a DepthConfig,
    pub cache: &'a mut DepthCache,
    /// Filled where the facet of a pair at rest answers.
    pub answer: &'a mut DepthAnswer,
    pub keeps: KeptFacets,
    /// Filled where all facets answer, or find that the bodies are apart.
    pub overlap: &'a mut Overlap,
}

/// Whose facets of least overlap are kept for later queries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeptFacets {
    /// None is kept or looked at.
    None,
    /// For pairs that seem to rest.
    AtRest,
    /// For all that are hardly in each other.
    Shallow,
}

/// The cost of looking at all facets: planes times corners of the pair, see [`facets::work`]. Below this it takes less time than
/// moving on a polytope that was kept …
const LITTLE_WORK: usize = 3_000;

/// … and below this less than making one. One is made there where the direction of least overlap has turned by no more than the
/// angle of this cosine, 4°, since the search before: then the next query moves it on.
const MOST_WORK: usize = 10_000;
const COHERENT: f64 = 0.9975;

/// How wide an interval may be, over the pair's size or distance, a little less than is promised. By all facets it is wider where
/// faces were merged of triangles that lean out of them by rounding, or edges are nearly parallel. A polytope does better then …
pub const WIDEST: f64 = 176.0 * UNIT_ROUNDOFF;

/// … unless it does not finish.
const WIDEST_OF_ALL: f64 = 1e-9;

/// The scale for relative widths: the pair's size, or how far the bodies' origins are apart.
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

/// Room for a polytope whose final state the cache may keep.
const MOST_VERTICES: usize = 64;

/// The most triangles of a closed surface of `MOST_VERTICES` vertices, without holes and handles.
const MOST_TRIANGLES: usize = 124;

/// The result of one search or the other.
pub enum DepthSearch {
    /// An earlier facet: the answer is already complete.
    Answered,
    /// All facets: the query's overlap.
    Facets,
    /// Along this direction, from body 1 to body 2, the bodies are apart.
    Apart(Vector),
    /// A polytope.
    Polytope(FoundPolytope),
}

/// The result of the search by a polytope.
pub struct FoundPolytope {
    pub expansion: Expansion,
    pub witness: PolytopeWitness,
    pub triangles: u32,
}

impl FoundPolytope {
    #[inline(always)]
    fn without_triangles(expansion: Expansion) -> FoundPolytope {
        let witness = PolytopeWitness { pairs: [expansion.farthest; 3], count: 1, weights: [1.0; 4], depth: 0.0 };
        FoundPolytope { expansion, witness, triangles: 0 }
    }

    /// Whether neither a direction that separates the bodies nor an interval that tells them from touching ones has been found,
    /// with room and steps to spare.
    #[inline(always)]
    fn is_open(&self) -> bool {
        match self.expansion.ending {
            // With more room the search begins anew in any case.
            Ending::Separated | Ending::Stuck | Ending::Outdated => false,
            Ending::Narrow => !(self.expansion.lower > 0.0),
            Ending::Spent | Ending::Flat => true,
        }
    }
}

impl Kernel for DepthQuery<'_> {
    /// None of a pair that floating point is not for.
    type Output = Option<DepthSearch>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<DepthSearch> {
        let frame = Frame::<L>::new(&self.pair);
        if !(frame.in_range && is_in_scale(self.pair.polyhedra)) {
            return None;
        }
        if self.keeps != KeptFacets::None && look_at_facet(&frame, self.cache, self.answer) {
            return Some(DepthSearch::Answered);
        }
        let before = self.cache.direction(&frame);
        let found = self.search_anew(&frame)?;
        let facet = self.facet_of(&found).filter(|facet| match self.keeps {
            KeptFacets::None => false,
            KeptFacets::AtRest => facet.rests(before, frame.size),
            KeptFacets::Shallow => facet.is_shallow(frame.size),
        });
        self.cache.rest_no_more();
        if let Some(facet) = facet {
            self.learn(&frame, &facet);
        }
        Some(found)
    }
}

/// Whether directions have hardly turned in either body's axes.
#[inline(always)]
fn are_alike(before: Option<[Vector; 2]>, after: Option<[Vector; 2]>) -> bool {
    let (Some([a, b]), Some([c, d])) = (before, after) else { return false };
    a.dot(&c) > COHERENT && b.dot(&d) > COHERENT
}

/// The search by a polytope, and by facets where that does not finish.
struct ByPolytope<'a, 'b, L> {
    query: &'a mut DepthQuery<'b>,
    frame: &'a Frame<'a, L>,
}

impl<L: Lanes> Work for ByPolytope<'_, '_, L> {
    type Output = Option<DepthSearch>;

    #[inline(always)]
    fn run(&mut self) -> Option<DepthSearch> {
        let ByPolytope { query, frame } = self;
        let mut polytope = Polytope::<MOST_VERTICES, { MOST_TRIANGLES + 4 }>::EMPTY;
        let mut start = query.cache.unpack(frame, &mut polytope);
        let steps = query.config.step_budget;
        start.only_known = start.triangle.is_some() && query.work() <= MOST_WORK;
        let mut found = query.search::<L, _, _, 1>(frame, &mut polytope, &start, steps);
        if found.expansion.ending == Ending::Outdated {
            if let Some(found) = query.search_facets(frame, WIDEST) {
                return Some(found);
            }
            start = SearchStart { triangle: None, direction: None, only_known: false, ..start };
            polytope.clear();
            found = query.search::<L, _, _, 1>(frame, &mut polytope, &start, steps);
        }
        let was_told = start.triangle.is_some() || start.direction.is_some();
        // State from an earlier query must not make an answer worse.
        if was_told && found.is_open() && found.expansion.steps < steps {
            let mut again = SearchAgain { search: query, frame, polytope: &mut polytope, first: &found };
            found = L::out_of_line(&mut again);
        }
        if found.expansion.ending != Ending::Stuck {
            return Some(DepthSearch::Polytope(found));
        }
        if let Some(found) = query.search_facets(frame, WIDEST_OF_ALL) {
            return Some(found);
        }
        let start = SearchStart { triangle: None, direction: None, only_known: false, ..start };
        Some(DepthSearch::Polytope(L::out_of_line(&mut InLarge { search: query, frame, start })))
    }
}

impl<'a> DepthQuery<'a> {
    /// Keeps a facet, if it or one near it alone proves a depth.
    #[inline(always)]
    fn learn<L: Lanes>(&mut self, frame: &Frame<L>, found: &LeastFacet) {
        let known = match found.facet {
            Some(facet) => Some(facet),
            None => facets::across(frame, &found.direction, found.farthest),
        };
        let Some(facet) = known else { return };
        if let Ok(proved) = facets::prove(frame, facet) {
            self.cache.rest_on(proved.facet);
        }
    }

    /// `None` where the search was not sure of one.
    #[inline(always)]
    fn facet_of(&self, found: &DepthSearch) -> Option<LeastFacet> {
        match found {
            DepthSearch::Facets => {
                let Overlap { upper, direction, facet, .. } = *self.overlap;
                Some(LeastFacet { upper, direction, farthest: [0; 2], facet: Some(facet) })
            }
            DepthSearch::Polytope(FoundPolytope { expansion, .. }) => {
                let Expansion { ending, lower, upper, direction, farthest, .. } = *expansion;
                (ending == Ending::Narrow && lower > 0.0).then_some(LeastFacet {
                    upper,
                    direction,
                    farthest,
                    facet: None,
                })
            }
            DepthSearch::Apart(_) | DepthSearch::Answered => None,
        }
    }

    /// Without what rested before.
    #[inline(always)]
    fn search_anew<L: Lanes>(&mut self, frame: &Frame<L>) -> Option<DepthSearch> {
        let work = self.work();
        if work <= LITTLE_WORK || (work <= MOST_WORK && !self.cache.has_polytope()) {
            let before = self.cache.facet_directions();
            let found = self.search_facets(frame, WIDEST);
            if work <= LITTLE_WORK && found.is_some() {
                return found;
            }
            let is_coherent =
                matches!(found, Some(DepthSearch::Facets)) && are_alike(before, self.cache.facet_directions());
            if found.is_some() && !is_coherent {
                return found;
            }
        }
        L::out_of_line(&mut ByPolytope { query: self, frame })
    }

    /// The fans of a pair of small bodies.
    #[inline(always)]
    fn fans(&self) -> Option<[&'a Fan; 2]> {
        let [polyhedron1, polyhedron2] = self.pair.polyhedra;
        Some([polyhedron1.fan.as_ref()?, polyhedron2.fan.as_ref()?])
    }

    /// The cost of looking at all facets; unbounded where that does not suit the pair.
    #[inline(always)]
    fn work(&self) -> usize {
        match self.fans() {
            Some(fans) => facets::work(fans),
            None => usize::MAX,
        }
    }

    #[inline(always)]
    fn search_facets<L: Lanes>(&mut self, frame: &Frame<L>, widest: f64) -> Option<DepthSearch> {
        let fans = self.fans()?;
        let outcome = facets::search(frame, fans, self.cache.facet(), widest * scale_of(frame), self.overlap);
        let Overlap { facet, direction, .. } = &*self.overlap;
        match outcome {
            FacetOutcome::Separated => {
                self.cache.keep_facet(frame, *facet, direction, false);
                Some(DepthSearch::Apart(*direction))
            }
            FacetOutcome::Overlapping => {
                self.cache.keep_facet(frame, *facet, direction, true);
                Some(DepthSearch::Facets)
            }
            FacetOutcome::Unclear => None,
        }
    }

    #[inline(always)]
    fn search<L: Lanes, const V: usize, const T: usize, const W: usize>(
        &mut self,
        frame: &Frame<L>,
        polytope: &mut Polytope<V, T>,
        start: &SearchStart,
        steps: u32,
    ) -> FoundPolytope {
        let DepthConfig { absolute_error, relative_error, .. } = *self.config;
        let wanted = WantedDepth { width: absolute_error, relative: relative_error, steps, lower: 0.0 };
        let mut expansion = polytope::expand::<L, V, T, W>(frame, polytope, start, &wanted);
        if expansion.ending == Ending::Outdated {
            return FoundPolytope::without_triangles(expansion);
        }
        if expansion.ending == Ending::Stuck && is_narrow(&expansion, WIDEST * scale_of(frame)) {
            expansion.ending = Ending::Narrow;
        }
        if polytope.triangle_count == 0 || !(expansion.upper < f64::INFINITY) {
            *self.cache = DepthCache::default();
            return FoundPolytope::without_triangles(expansion);
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

/// The closed polytope with which a search from nothing ends; what the cache keeps of it, so that no search is compiled anew.
pub struct ClosedSurface<'a> {
    pub pair: &'a Pair<'a>,
    pub polytope: Polytope<MOST_VERTICES, { MOST_TRIANGLES + 4 }>,
}

impl Kernel for ClosedSurface<'_> {
    /// Whether there is one around the origin.
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let frame = Frame::<L>::new(self.pair);
        let is_searched = frame.in_range && is_in_scale(self.pair.polyhedra);
        is_searched && WIDER.into_iter().any(|relative_error| self.is_kept(&frame, relative_error))
    }
}

/// Relative errors of searches, of which the first is drawn whose polytope is kept.
const WIDER: [f64; 3] = [0.0, 0.01, 0.1];

impl ClosedSurface<'_> {
    #[inline(always)]
    fn is_kept<L: Lanes>(&mut self, frame: &Frame<L>, relative_error: f64) -> bool {
        let config = &DepthConfig { relative_error, ..DepthConfig::default() };
        let (mut cache, mut overlap, answer) = (DepthCache::default(), Overlap::NONE, &mut DepthAnswer::default());
        let (pair, keeps) = (*self.pair, KeptFacets::None);
        let query = &mut DepthQuery { pair, config, cache: &mut cache, answer, keeps, overlap: &mut overlap };
        let found = L::out_of_line(&mut ByPolytope { query, frame });
        let is_proved = matches!(found, Some(DepthSearch::Polytope(found)) if found.expansion.lower > 0.0);
        is_proved && cache.unpack(frame, &mut self.polytope).triangle.is_some()
    }
}

/// The search from the beginning, with more room: for bodies that are nearly as deep in each other everywhere.
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
        self.search.search::<L, _, _, 4>(self.frame, &mut polytope, &self.start, self.search.config.step_budget)
    }
}

/// The search from nothing, after one from the kept state that led nowhere. Its answer is that of a first query, as long as the
/// steps do.
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
        let start = SearchStart { triangle: None, direction: None, first_triangles: 0, only_known: false };
        self.polytope.clear();
        let left = self.search.config.step_budget - steps;
        let mut found = self.search.search::<L, _, _, 1>(self.frame, self.polytope, &start, left);
        found.expansion.steps += steps;
        found.expansion.supports += supports;
        found
    }
}
