//! All pairs of overlapping boxes at once, by a grid of cells: quicker than the tree where boxes are of about one size and fill the
//! space evenly, and not used elsewhere.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::{extend, push, reserve_sparingly};
use crate::scene::world::boxes::Aabb;

/// Fewer boxes are left to the tree.
const FEWEST: usize = 64;

/// Boxes up to this many times as large as half of all make the cells; larger ones are left to the tree.
const LARGE: f64 = 2.0;

/// One box in this many may be larger.
const FEW_LARGE: usize = 50;

/// At most this many cells for each box: with more they are scattered in clusters.
const MOST_CELLS: f64 = 8.0;

/// At most this many boxes share a cell, seen from a box, on average.
const CROWD: usize = 8;

/// Sides of this many boxes determine the median of all.
const ENOUGH_SIDES: usize = 1024;

/// The cell of a box that is too large for the cells, of which there are fewer.
const LARGE_ONE: u32 = u32::MAX;

/// Boxes by cells. Cells are larger than every box in them, which is in that of its lower corner: boxes overlap only where their
/// cells are the same or neighbours.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    /// Sides of some boxes, for finding that of a cell.
    sides: Vec<f64>,
    /// The proxies that are too large for the cells.
    pub large: Vec<u32>,
    /// The cell of each box, or [`LARGE_ONE`].
    cells: Vec<u32>,
    /// The boxes of one cell after the other, with their proxies.
    sorted: Vec<(Aabb, u32)>,
    /// The start of each cell's boxes, and the end of the last one's.
    starts: Vec<u32>,
    /// How many cells there are along each axis.
    counts: [usize; 3],
}

impl Grid {
    /// Sorts the boxes of proxies into cells; false where a grid does not suit them.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn fill(&mut self, boxes: &[Aabb], proxies: &[u32]) -> Result<bool> {
        if proxies.len() < FEWEST {
            return Ok(false);
        }
        let most = LARGE * self.median_side(boxes, proxies)?;
        // False for a NaN.
        let is_inside = |bounds: &Aabb| side(bounds) <= most && side(bounds) < f64::INFINITY;
        self.large.clear();
        let mut extent = CornerExtent { lower: [f64::INFINITY; 3], upper: [f64::NEG_INFINITY; 3], cell: 0.0 };
        for &proxy in proxies {
            let bounds = &boxes[proxy as usize];
            if is_inside(bounds) {
                extent.add(bounds);
            } else {
                push(&mut self.large, proxy)?;
            }
        }
        let counts = extent.counts();
        let is_even = counts.iter().product::<f64>() <= MOST_CELLS * proxies.len() as f64;
        if self.large.len() * FEW_LARGE > proxies.len() || !is_even {
            return Ok(false);
        }
        self.counts = counts.map(|count| count as usize);
        let [width, height, _] = self.counts;
        let cell = |bounds: &Aabb| {
            let [x, y, z] = extent.cell_of(bounds);
            ((z * height + y) * width + x) as u32
        };
        let cells = proxies.iter().map(|&proxy| &boxes[proxy as usize]);
        self.cells.clear();
        extend(&mut self.cells, cells.map(|bounds| if is_inside(bounds) { cell(bounds) } else { LARGE_ONE }))?;
        self.sort(boxes, proxies)
    }

    /// The median over all boxes, or over a thousand or two.
    fn median_side(&mut self, boxes: &[Aabb], proxies: &[u32]) -> Result<f64> {
        let some = proxies.iter().step_by(proxies.len().div_ceil(ENOUGH_SIDES));
        self.sides.clear();
        extend(&mut self.sides, some.map(|&proxy| side(&boxes[proxy as usize])))?;
        let half = self.sides.len() / 2;
        let (_, &mut median, _) = self.sides.select_nth_unstable_by(half, f64::total_cmp);
        Ok(median)
    }

    /// False where too many share a cell.
    fn sort(&mut self, boxes: &[Aabb], proxies: &[u32]) -> Result<bool> {
        let inside = || self.cells.iter().zip(proxies).filter(|(cell, _)| **cell != LARGE_ONE);
        let cell_count = self.counts.iter().product::<usize>();
        self.starts.clear();
        reserve_sparingly(&mut self.starts, cell_count + 2)?;
        self.starts.resize(cell_count + 2, 0);
        // Two places ahead, so that counting where to put the next box leaves where each cell begins.
        for (&cell, _) in inside() {
            self.starts[cell as usize + 2] += 1;
        }
        let count = proxies.len() - self.large.len();
        let shared: usize = self.starts.iter().map(|&count| (count as usize).pow(2)).sum();
        if shared > CROWD * count {
            return Ok(false);
        }
        for k in 0..cell_count {
            self.starts[k + 2] += self.starts[k + 1];
        }
        self.sorted.clear();
        reserve_sparingly(&mut self.sorted, count)?;
        self.sorted.resize(count, (Aabb::NOWHERE, 0));
        for (&cell, &proxy) in inside() {
            let next = &mut self.starts[cell as usize + 1];
            self.sorted[*next as usize] = (boxes[proxy as usize], proxy);
            *next += 1;
        }
        Ok(true)
    }

    pub fn cell_count(&self) -> usize {
        self.counts.iter().product()
    }

    /// Calls `found` with all pairs of proxies whose boxes overlap, one in these cells and the other one there or behind, each
    /// once.
    ///
    /// # Errors
    /// Those of `found`.
    pub fn for_each_pair(&self, cells: Range<usize>, mut found: impl FnMut(u32, u32) -> Result<()>) -> Result<()> {
        debug_assert!(cells.start <= cells.end && cells.end <= self.cell_count());
        let [width, height, depth] = self.counts;
        for row in cells.start / width..cells.end.div_ceil(width) {
            let (y, z, first) = (row % height, row / height, row * width);
            for x in cells.start.max(first) - first..cells.end.min(first + width) - first {
                let own = self.cells(x..x + 1, y, z);
                if own.is_empty() {
                    continue;
                }
                // Half of the neighbours: the other half meets this cell as theirs. Those of one row are next to each other.
                let behind = self.cells(x..(x + 2).min(width), y, z).end;
                let beside = x.saturating_sub(1)..(x + 2).min(width);
                let in_row = |y: usize, z: usize| {
                    if y < height && z < depth { self.cells(beside.clone(), y, z) } else { 0..0 }
                };
                let neighbours =
                    [in_row(y + 1, z), in_row(y.wrapping_sub(1), z + 1), in_row(y, z + 1), in_row(y + 1, z + 1)];
                for at in own {
                    let (bounds, proxy) = &self.sorted[at];
                    for others in std::iter::once(at + 1..behind).chain(neighbours.clone()) {
                        for (other, other_proxy) in &self.sorted[others] {
                            if bounds.overlaps(other) {
                                found(*proxy, *other_proxy)?;
                            }
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// The boxes in some cells of a row.
    #[inline(always)]
    fn cells(&self, x: Range<usize>, y: usize, z: usize) -> Range<usize> {
        let row = (z * self.counts[1] + y) * self.counts[0];
        self.starts[row + x.start] as usize..self.starts[row + x.end] as usize
    }
}

/// The longest side; in double precision, where differences of single ones are exact except for very unlike magnitudes.
fn side(bounds: &Aabb) -> f64 {
    (0..3).map(|k| f64::from(bounds.upper[k]) - f64::from(bounds.lower[k])).fold(0.0, f64::max)
}

/// The extent of the lower corners, and the longest side.
struct CornerExtent {
    lower: [f64; 3],
    upper: [f64; 3],
    cell: f64,
}

impl CornerExtent {
    fn add(&mut self, bounds: &Aabb) {
        for k in 0..3 {
            self.lower[k] = self.lower[k].min(bounds.lower[k].into());
            self.upper[k] = self.upper[k].max(bounds.lower[k].into());
        }
        self.cell = self.cell.max(side(bounds) * (1.0 + 1e-6));
    }

    /// Cells along each axis; NaN or infinite where the boxes are points or go to the ends of numbers.
    fn counts(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| ((self.upper[k] - self.lower[k]) / self.cell).floor() + 1.0)
    }

    /// The cell of a box. Lower corners of boxes that overlap along an axis are at most a side apart, the cell's size without its
    /// 1e-6; with fewer than 2³² cells the rounding of two quotients is far below that, so their whole parts differ by at most 1.
    fn cell_of(&self, bounds: &Aabb) -> [usize; 3] {
        [0, 1, 2].map(|k| ((f64::from(bounds.lower[k]) - self.lower[k]) / self.cell) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    #[test]
    fn it_finds_what_overlaps_or_refuses() {
        let mut random = Random::new(0x941d);
        let mut grid = Grid::default();
        let mut fills = 0;
        for round in 0..if cfg!(miri) { 2 } else { 60 } {
            let count = 70 + random.below(400);
            let size = (count as f64 * random.uniform(0.2, 40.0)).cbrt();
            let flat = if round % 5 == 0 { 0.0 } else { 1.0 };
            let at = [1.0, 1e5, 0.0][round % 3];
            let mut boxes: Vec<Aabb> = Vec::new();
            for k in 0..count {
                let side = if k % 60 == 59 { 6.0 } else { random.uniform(0.6, 1.0) };
                let lower =
                    [0, 1, 2].map(|axis| (at + random.uniform(0.0, size) * if axis == 2 { flat } else { 1.0 }) as f32);
                boxes.push(Aabb { lower, upper: lower.map(|x| x + side as f32) });
            }
            let proxies: Vec<u32> = (0..count as u32).filter(|k| k % 7 != 3).collect();
            if !grid.fill(&boxes, &proxies).unwrap() {
                continue;
            }
            fills += 1;
            let mut found = Vec::new();
            let count = grid.cell_count();
            let cut = random.below(count + 1);
            for cells in [0..cut, cut..count] {
                grid.for_each_pair(cells, |a, b| push(&mut found, (a.min(b), a.max(b)))).unwrap();
            }
            found.sort_unstable();
            let is_inside = |k: &&u32| !grid.large.contains(k);
            let mut expected = Vec::new();
            for &a in proxies.iter().filter(is_inside) {
                for &b in proxies.iter().filter(is_inside).filter(|&&b| a < b) {
                    if boxes[a as usize].overlaps(&boxes[b as usize]) {
                        expected.push((a, b));
                    }
                }
            }
            assert_eq!(found, expected);
        }
        assert!(cfg!(miri) || fills > 10, "{fills}");
    }

    #[test]
    fn what_does_not_suit_is_refused() {
        let mut grid = Grid::default();
        let at = |x: f32, side: f32| Aabb { lower: [x, 0.0, 0.0], upper: [x + side, side, side] };
        let proxies: Vec<u32> = (0..1000).collect();
        let even: Vec<Aabb> = (0..1000_u16).map(|k| at(f32::from(k) / 4.0, 1.0)).collect();
        assert!(grid.fill(&even[..100], &proxies[..100]).unwrap());
        // Two clusters far apart, all at one place, many sizes, boxes without end, and points.
        let clusters = (0..1000_u16).map(|k| at(if k % 2 == 0 { 0.0 } else { 1e6 } + f32::from(k) / 300.0, 1.0));
        let together = vec![at(0.0, 1.0); 1000];
        let sizes = (0..1000_u16).map(|k| at(f32::from(k), 1.0 + f32::from(k % 10)));
        for boxes in [
            clusters.collect(),
            together,
            sizes.collect(),
            vec![Aabb::EVERYWHERE; 1000],
            (0..1000_u16).map(|k| at(f32::from(k), 0.0)).collect::<Vec<Aabb>>(),
        ] {
            assert!(!grid.fill(&boxes, &proxies).unwrap(), "{:?}", boxes[0]);
        }
    }
}
