//! An order that keeps neighbours in space near in memory: along a Z-order curve (G. M. Morton, 1966). Whatever walks over a
//! surface of a million triangles waits for memory unless neighbours are neighbours there, too.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, extend, filled, with_capacity};
use crate::base::progress::Progress;
use crate::base::sorting::sort_in_steps;

/// Fewer points than these, and the data built from them, are in the caches in any order.
const FEWEST: usize = 4096;

/// The indices of all points in their order along the curve, those in one cell of it by index; as they are where they are few. So
/// of exact duplicates the lowest index comes first.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on, here and below.
pub fn along_curve(points: &[Vector], progress: &mut Progress) -> Result<Vec<u32>> {
    debug_assert!(u32::try_from(points.len()).is_ok());
    let mut order: Vec<u32> = collected(0..points.len() as u32)?;
    if points.len() >= FEWEST {
        sort_along_curve(&mut order, points, progress)?;
    }
    Ok(order)
}

/// Sorts indices of points along the curve through these, those in one cell of it by index.
pub fn sort_along_curve(indices: &mut [u32], points: &[Vector], progress: &mut Progress) -> Result<()> {
    let coded = cells(indices, points, progress)?;
    for (index, (_, i)) in indices.iter_mut().zip(coded) {
        *index = i;
    }
    Ok(())
}

/// Calls `visit` with the indices of the points in each cell of the curve that holds more than one, ascending.
pub fn for_each_cell(points: &[Vector], progress: &mut Progress, mut visit: impl FnMut(&mut [u32])) -> Result<()> {
    let all: Vec<u32> = collected(0..points.len() as u32)?;
    let mut inside = Vec::new();
    for cell in cells(&all, points, progress)?.chunk_by(|a, b| a.0 == b.0) {
        if cell.len() > 1 {
            inside.clear();
            extend(&mut inside, cell.iter().map(|(_, i)| *i))?;
            visit(&mut inside);
        }
    }
    Ok(())
}

/// The number of each point's cell along the curve, with its index; in order.
fn cells(indices: &[u32], points: &[Vector], progress: &mut Progress) -> Result<Vec<(u64, u32)>> {
    debug_assert!(indices.iter().all(|i| (*i as usize) < points.len()));
    let mut low = Vector::repeat(f64::INFINITY);
    let mut high = Vector::repeat(f64::NEG_INFINITY);
    for &i in indices {
        low = low.inf(&points[i as usize]);
        high = high.sup(&points[i as usize]);
    }
    // Halves, so that the size of the largest box does not overflow.
    let (low, half_size) = (0.5 * low, (0.5 * high - 0.5 * low).amax());
    // Points that are all one are all in the first cell.
    let half_size = if half_size > 0.0 { half_size } else { 1.0 };
    let cell = |x: f64, low: f64| ((0.5 * x - low) / half_size * f64::from((1_u32 << 21) - 1)) as u64;
    let code = |i: u32| {
        let p = &points[i as usize];
        spread(cell(p.x, low.x)) | spread(cell(p.y, low.y)) << 1 | spread(cell(p.z, low.z)) << 2
    };
    let mut coded: Vec<(u64, u32)> = with_capacity(indices.len())?;
    let of_codes = &mut progress.part(0.0, 0.2);
    for &i in indices {
        of_codes.step(coded.len(), indices.len())?;
        coded.push((code(i), i));
    }
    // Fast where long parts are in order, as points that come from a polyhedron are.
    sort_in_steps(&mut coded, Ord::cmp, &mut progress.part(0.2, 1.0))?;
    Ok(coded)
}

/// The points in an order of some of them.
pub fn in_order(points: &[Vector], order: &[u32], progress: &mut Progress) -> Result<Vec<Vector>> {
    let mut ordered = with_capacity(order.len())?;
    for &v in order {
        progress.step(ordered.len(), order.len())?;
        ordered.push(points[v as usize]);
    }
    Ok(ordered)
}

/// Whether an order of 0..n changes nothing.
pub fn is_identity(order: &[u32]) -> bool {
    order.iter().zip(0..).all(|(i, place)| *i == place)
}

/// The place of each index of 0..n in an order of them.
pub fn places_of(order: &[u32]) -> Result<Vec<u32>> {
    let mut places = filled(0, order.len())?;
    for (place, i) in (0..).zip(order) {
        places[*i as usize] = place;
    }
    Ok(places)
}

/// The low 21 bits of x, two zeros after each.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

/// Turns each triangle so that it begins at its lowest corner, all below `vertex_count`, and sorts the triangles.
pub fn sort_triangles(triangles: &mut Vec<[u32; 3]>, vertex_count: usize, progress: &mut Progress) -> Result<()> {
    debug_assert!(triangles.as_flattened().iter().all(|v| (*v as usize) < vertex_count));
    let all = 3 * triangles.len();
    // Counting sort by the lowest corner, then a sort of the few of each: in time linear where a comparison sort is not.
    let mut starts = filled(0_u32, vertex_count + 1)?;
    for (done, t) in triangles.iter_mut().enumerate() {
        progress.step(done, all)?;
        let lowest = (0..3).min_by_key(|k| t[*k]).unwrap_or(0);
        t.rotate_left(lowest);
        starts[t[0] as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut sorted = filled([0; 3], triangles.len())?;
    let mut fill = copied(&starts)?;
    for (done, t) in triangles.iter().enumerate() {
        progress.step(all / 3 + done, all)?;
        let place = &mut fill[t[0] as usize];
        sorted[*place as usize] = *t;
        *place += 1;
    }
    for range in starts.windows(2) {
        progress.steps((range[1] - range[0]) as usize, all / 3 * 2 + range[0] as usize, all)?;
        sorted[range[0] as usize..range[1] as usize].sort_unstable();
    }
    *triangles = sorted;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    #[test]
    fn the_order_is_one_of_all_and_equal_points_keep_theirs() {
        let mut random = Random::new(5);
        let mut points: Vec<Vector> = (0..FEWEST).map(|_| random.direction()).collect();
        points[7].x = 0.0;
        points.extend_from_within(..100);
        points[FEWEST + 7].x = -0.0;
        points.swap(FEWEST, FEWEST + 50);
        let mut go_on = |_| true;
        let progress = &mut Progress::new(&mut go_on);
        let order = along_curve(&points, progress).unwrap();
        let places = places_of(&order).unwrap();
        assert!((0..).zip(&order).all(|(place, i)| places[*i as usize] == place) && !is_identity(&order));
        let twin = |i: usize| (0..i).find(|j| points[*j] == points[i]).unwrap();
        assert!((FEWEST..points.len()).all(|i| places[twin(i)] < places[i]));
        // All in one cell.
        let equal = vec![Vector::new(1e308, -1e308, 0.0); FEWEST];
        assert!(is_identity(&along_curve(&equal, progress).unwrap()));
        let mut cells = 0;
        for_each_cell(&points, progress, |cell| {
            assert!(cell.is_sorted());
            cells += 1;
        })
        .unwrap();
        assert!((100..120).contains(&cells), "{cells}");
    }

    #[test]
    fn triangles_begin_at_their_lowest_corner_and_are_in_order() {
        let mut triangles = vec![[3, 4, 1], [2, 0, 3], [0, 1, 2], [1, 2, 4]];
        sort_triangles(&mut triangles, 5, &mut Progress::new(&mut |_| true)).unwrap();
        assert_eq!(triangles, [[0, 1, 2], [0, 3, 2], [1, 2, 4], [1, 3, 4]]);
    }
}
