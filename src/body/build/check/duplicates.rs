//! Points that are exactly equal.

use crate::base::error::Result;
use crate::base::locality::for_each_cell;
use crate::base::math::Vector;
use crate::base::memory::collected;
use crate::base::progress::Progress;

/// For every point the first one with exactly the same coordinates; 0.0 equals -0.0.
pub fn first_of_equal(points: &[Vector], progress: &mut Progress) -> Result<Vec<u32>> {
    // Equal points are in one cell of the curve; there are few in one nearly always.
    let mut first: Vec<u32> = collected(0..points.len() as u32)?;
    for_each_cell(points, progress, |cell| {
        let key = |i: &u32| points[*i as usize].map(|x| (x + 0.0).to_bits());
        cell.sort_unstable_by(|i, j| key(i).iter().cmp(key(j).iter()).then(i.cmp(j)));
        for equal in cell.chunk_by(|i, j| points[*i as usize] == points[*j as usize]) {
            equal.iter().for_each(|i| first[*i as usize] = equal[0]);
        }
    })?;
    Ok(first)
}
