//! How deep two objects are in each other: an interval that holds the least translation that parts them, and where.
//!
//! Floating point searches and proves: for pairs at rest by the earlier facet, else for small bodies by all facets, `facets/`, else
//! by `polytope/`. Integers decide what rounding hides at the ends: objects that touch, flat ones in
//! one plane, objects that hardly overlap.

#[doc(hidden)]
pub mod polytope;
#[doc(hidden)]
pub mod facets;
mod answer;
mod cache;
mod scaling;
mod resting;
mod search;
mod filling;
mod proof;

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::simd;
use crate::base::simd::environment::with_default;
use crate::depth::facets::{Facet, Overlap};
use crate::depth::polytope::{Expansion, Polytope, PolytopeWitness};
use crate::placed::Pair;
use crate::shape::Placed;
pub use answer::{DepthAnswer, DepthConfig, DepthEnding, DepthStatistics};
pub use cache::DepthCache;
pub(crate) use cache::DepthFacets;
use filling::fill;
pub(crate) use proof::{ProofFrom, proof};
pub(crate) use resting::{DepthPlaces, prove_at_rest};
use scaling::Rescaled;
pub(crate) use search::KeptFacets;
use search::{ClosedSurface, DepthQuery, DepthSearch, FoundPolytope};

/// How deep two polyhedra are in each other.
///
/// # Errors
/// Same errors as `pair::depth`.
pub(crate) fn of_polyhedra(
    bodies: &[Placed; 2],
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    with_default(|| answer_query(bodies, cache, config, answer))
}

/// (The bodies by reference: a copy would wait for what the caller has just written, R1.)
fn answer_query(
    bodies: &[Placed; 2],
    cache: &mut DepthCache,
    config: &DepthConfig,
    answer: &mut DepthAnswer,
) -> Result<()> {
    config.check()?;
    let pair = Pair::of(bodies);
    let keeps = KeptFacets::AtRest;
    let mut overlap = Overlap::NONE;
    let query = &mut DepthQuery { pair, config, cache, answer, keeps, overlap: &mut overlap };
    let mut found = simd::dispatch_to_avx2(query);
    if found.is_none() {
        pair.poses.iter().try_for_each(|pose| pose.check())?;
        found = search_rescaled(&pair, config, cache)?;
    }
    fill(answer, &pair, found.as_ref(), &overlap)
}

/// Along which direction two bodies that intersect overlap least, for poses that are accepted: a depth from nothing. And the facet
/// that proves it alone, if one is kept.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none.
pub(crate) fn deepest(pair: &Pair, keeps: KeptFacets) -> Result<(DepthAnswer, Option<Facet>)> {
    let (mut cache, config, mut answer) = (DepthCache::default(), DepthConfig::default(), DepthAnswer::default());
    let mut overlap = Overlap::NONE;
    let mut found = simd::dispatch_to_avx2(&mut DepthQuery {
        pair: *pair,
        config: &config,
        cache: &mut cache,
        answer: &mut answer,
        keeps,
        overlap: &mut overlap,
    });
    let facet = cache.resting();
    if found.is_none() {
        found = search_rescaled(pair, &config, &mut cache)?;
    }
    fill(&mut answer, pair, found.as_ref(), &overlap)?;
    Ok((answer, facet))
}

/// The triangles of the closed polytope with which a search from nothing ends: corners as differences of points of both bodies, in
/// the world's axes. One that is too large to be kept is replaced by that of a less narrow search; none of bodies that need
/// another unit of length, or whose overlap is rounding.
pub(crate) fn for_each_triangle(pair: &Pair, mut visit: impl FnMut([Vector; 3])) {
    let mut surface = ClosedSurface { pair, polytope: Polytope::EMPTY };
    if simd::dispatch_to_avx2(&mut surface) {
        (0..surface.polytope.triangle_count).for_each(|triangle| visit(surface.polytope.positions_of(triangle)));
    }
}

/// The search among copies of the bodies in another unit of length, for poses that are accepted. `None` of a pair that floating
/// point is not for in any unit.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where the copies get none.
#[cold]
#[inline(never)]
fn search_rescaled(pair: &Pair, config: &DepthConfig, cache: &mut DepthCache) -> Result<Option<DepthSearch>> {
    let Some(copies) = Rescaled::of(pair)? else { return Ok(None) };
    let config = DepthConfig { absolute_error: copies.in_unit(config.absolute_error), ..*config };
    let pair = copies.pair();
    let (mut unused, mut overlap) = (DepthAnswer::default(), Overlap::NONE);
    let (config, answer, keeps) = (&config, &mut unused, KeptFacets::None);
    let query = &mut DepthQuery { pair, config, cache, answer, keeps, overlap: &mut overlap };
    // Copies have no fan.
    let Some(DepthSearch::Polytope(found)) = simd::dispatch_to_avx2(query) else { return Ok(None) };
    let FoundPolytope { expansion, witness, .. } = found;
    let upper = copies.upper_of(expansion.upper);
    if upper == f64::INFINITY && expansion.upper < upper {
        return Ok(None);
    }
    Ok(Some(DepthSearch::Polytope(FoundPolytope {
        expansion: Expansion { lower: copies.lower_of(expansion.lower), upper, ..expansion },
        witness: PolytopeWitness { depth: copies.lower_of(witness.depth), ..witness },
        ..found
    })))
}
