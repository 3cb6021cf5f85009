//! The faces that meet at an edge.

use crate::base::error::Result;
use crate::base::memory::{copied, filled};
use crate::base::progress::Progress;

/// The corners that share an edge.
pub(super) enum Matching {
    /// The corner across the edge of each corner: each edge is used twice, once in each direction.
    Twins(Vec<u32>),
    /// All uses, ascending, of the first edge (by its lower, then its higher vertex) where that fails.
    Fault(Vec<u32>),
}

/// Finds for every corner the one across its edge. Corner `c` stands for the directed edge
/// `edges[c]` = (tail, head) from it to the next corner of its face; no tail equals its head, and
/// all are below `vertex_count`. In a closed, consistently oriented surface each edge is used
/// twice, once in each direction, and the answer is the twin of each corner.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on; [`crate::base::error::Error::Memory`].
pub(super) fn match_edges(vertex_count: usize, edges: &[(u32, u32)], progress: &mut Progress) -> Result<Matching> {
    let all = 3 * edges.len();
    // Counting sort by the lower vertex, then a sort of the few edges of each by the higher one.
    let low = |c: u32| edges[c as usize].0.min(edges[c as usize].1);
    let high = |c: u32| edges[c as usize].0.max(edges[c as usize].1);
    let corners = 0..edges.len() as u32;
    let mut starts = filled(0_u32, vertex_count + 1)?;
    for c in corners.clone() {
        progress.step(c as usize, all)?;
        starts[low(c) as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut free = copied(&starts)?;
    let mut sorted = filled(0_u32, edges.len())?;
    for c in corners {
        progress.step(edges.len() + c as usize, all)?;
        let place = &mut free[low(c) as usize];
        sorted[*place as usize] = c;
        *place += 1;
    }
    let mut twins = filled(0_u32, edges.len())?;
    for v in 0..vertex_count {
        progress.steps((starts[v + 1] - starts[v]) as usize, 2 * edges.len() + starts[v] as usize, all)?;
        let bucket = &mut sorted[starts[v] as usize..starts[v + 1] as usize];
        bucket.sort_unstable_by_key(|&c| (high(c), c));
        for uses in bucket.chunk_by(|&a, &b| high(a) == high(b)) {
            match *uses {
                [a, b] if edges[a as usize].0 != edges[b as usize].0 => {
                    twins[a as usize] = b;
                    twins[b as usize] = a;
                }
                _ => return Ok(Matching::Fault(copied(uses)?)),
            }
        }
    }
    Ok(Matching::Twins(twins))
}
