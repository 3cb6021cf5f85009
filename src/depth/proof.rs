//! The triangles that prove a depth, for its check.

use super::cache::DepthCache;
use super::scaling::Rescaled;
use crate::base::error::Result;
use crate::base::memory::listed;
use crate::base::simd::{self, Kernel, Lanes};
use crate::depth::polytope::{self, Polytope, SearchStart, WantedDepth, is_in_scale};
use crate::placed::Pair;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// The source of a proof of a depth.
#[derive(Clone, Copy)]
pub enum ProofFrom<'a> {
    /// The polytope that a cache holds.
    Cache(&'a DepthCache),
    /// A search like that of a query whose polytope is too large to be kept, for a lower end of at least so much.
    Search(f64),
}

/// The triangles of a polytope in the pair's poses; none where there is no polytope.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) of bodies that are copied in another unit of length.
///
/// # Panics
/// Fails where there is no memory for the triangles, same as [`in_integers`](crate::base::memory::in_integers).
pub fn proof(pair: &Pair, from: ProofFrom) -> Result<Vec<[VertexPair; 3]>> {
    if let Some(found) = simd::dispatch_to_avx2(&mut Proof { pair: *pair, from }) {
        return Ok(found);
    }
    let Some(copies) = Rescaled::of(pair)? else { return Ok(Vec::new()) };
    let from = match from {
        ProofFrom::Cache(_) => from,
        ProofFrom::Search(lower) => ProofFrom::Search(copies.in_unit(lower)),
    };
    let found = simd::dispatch_to_avx2(&mut Proof { pair: copies.pair(), from });
    Ok(found.unwrap_or_default())
}

struct Proof<'a> {
    pair: Pair<'a>,
    from: ProofFrom<'a>,
}

impl Kernel for Proof<'_> {
    /// `None` of a pair that floating point is not for.
    type Output = Option<Vec<[VertexPair; 3]>>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Self::Output {
        let frame = Frame::<L>::new(&self.pair);
        if !(frame.in_range && is_in_scale(self.pair.polyhedra)) {
            return None;
        }
        let mut polytope = Polytope::<255, 508>::EMPTY;
        match self.from {
            ProofFrom::Cache(cache) => {
                cache.unpack(&frame, &mut polytope);
            }
            ProofFrom::Search(lower) => {
                let start = SearchStart { triangle: None, direction: None, first_triangles: 0, only_known: false };
                let wanted = WantedDepth { width: 0.0, relative: 0.0, steps: u32::MAX, lower };
                polytope::expand::<L, _, _, 4>(&frame, &mut polytope, &start, &wanted);
            }
        }
        Some(listed((0..polytope.triangle_count).map(|triangle| polytope.pairs_of(triangle))))
    }
}
