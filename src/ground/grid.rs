//! Triangles over a grid of heights: nothing is stored of them, and the boxes of their tree are ranges of heights, some 14 bytes a
//! cell of two triangles in all.

use super::tree::{FOUR, FourBoxes, NodeBounds, Pending, Visit};
use super::triangles::NONE;
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::memory::{copied, push, with_capacity};
use crate::base::normal::over_length;

/// A box of a level holds so many of the level below along each side, of the first level cells.
const SIDE: usize = 2;

/// Of a grid of 2²⁹ heights there are less than 30 levels, and a walk keeps three boxes for each.
const DEEPEST: usize = 96;

/// Heights over a grid, and their least and greatest by blocks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroundGrid {
    columns: usize,
    rows: usize,
    spacing: [f64; 2],
    /// A NaN is a hole.
    heights: Vec<f64>,
    /// Four cells, four of these, four of those, up to all.
    levels: Vec<GridLevel>,
}

/// The least and the greatest heights of boxes, row by row.
#[derive(Debug, Clone, PartialEq)]
struct GridLevel {
    columns: usize,
    rows: usize,
    /// In a box without triangles the least is more than the greatest.
    ranges: Vec<[f64; 2]>,
}

const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn widened(range: [f64; 2], by: [f64; 2]) -> [f64; 2] {
    [range[0].min(by[0]), range[1].max(by[1])]
}

/// The least and the greatest of heights. Out of line: inlined it is computed of a hole, too, and the least of a NaN is an invalid
/// operation.
#[inline(never)]
fn range_of([a, b, c, d]: [f64; 4]) -> [f64; 2] {
    [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))]
}

impl GridLevel {
    /// The level above one.
    fn above(below: &GridLevel) -> Result<GridLevel> {
        let [columns, rows] = [below.columns, below.rows].map(|count| count.div_ceil(SIDE));
        let mut ranges = with_capacity(columns * rows)?;
        for at in 0..columns * rows {
            let (i, j) = (at / columns, at % columns);
            let parts = (SIDE * i..(SIDE * i + SIDE).min(below.rows))
                .flat_map(|i| (SIDE * j..(SIDE * j + SIDE).min(below.columns)).map(move |j| i * below.columns + j));
            ranges.push(parts.map(|part| below.ranges[part]).fold(EMPTY, widened));
        }
        Ok(GridLevel { columns, rows, ranges })
    }
}

/// The place of a box.
#[derive(Debug, Clone, Copy)]
struct BoxPlace {
    /// 0 of a cell, one more than the number of the level else.
    level: u32,
    row: u32,
    column: u32,
}

impl GroundGrid {
    /// For at least two rows and columns of heights within 2²⁰⁰, with steps from 2⁻¹⁹⁹ up to where the
    /// last vertices are at 2²⁰⁰.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(columns: usize, spacing: [f64; 2], heights: Vec<f64>) -> Result<GroundGrid> {
        debug_assert!(columns >= 2 && heights.len().is_multiple_of(columns) && heights.len() >= 2 * columns);
        let rows = heights.len() / columns;
        let mut grid = GroundGrid { columns, rows, spacing, heights, levels: Vec::new() };
        let mut level = grid.first_level()?;
        while level.ranges.len() > 1 {
            let above = GridLevel::above(&level)?;
            push(&mut grid.levels, std::mem::replace(&mut level, above))?;
        }
        push(&mut grid.levels, level)?;
        Ok(grid)
    }

    fn first_level(&self) -> Result<GridLevel> {
        let [columns, rows] = [self.columns, self.rows].map(|count| (count - 1).div_ceil(SIDE));
        let mut ranges = with_capacity(columns * rows)?;
        for at in 0..columns * rows {
            let (i, j) = (SIDE * (at / columns), SIDE * (at % columns));
            let cells = (i..(i + SIDE).min(self.rows - 1))
                .flat_map(|i| (j..(j + SIDE).min(self.columns - 1)).map(move |j| (i, j)));
            ranges.push(cells.map(|(i, j)| self.range_of_cell(i, j)).fold(EMPTY, widened));
        }
        Ok(GridLevel { columns, rows, ranges })
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<GroundGrid> {
        let mut levels = with_capacity(self.levels.len())?;
        for level in &self.levels {
            levels.push(GridLevel { ranges: copied(&level.ranges)?, ..*level });
        }
        Ok(GroundGrid { heights: copied(&self.heights)?, levels, ..*self })
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        let levels = self.levels.iter().map(|level| size_of::<GridLevel>() + size_of_val(&level.ranges[..]));
        size_of_val(&self.heights[..]) + levels.sum::<usize>()
    }

    /// How many columns of vertices there are, the steps between columns and rows, and the heights row by row.
    pub fn parts(&self) -> (usize, [f64; 2], &[f64]) {
        (self.columns, self.spacing, &self.heights)
    }

    /// Whether each cell is a hole.
    pub fn is_empty(&self) -> bool {
        self.levels.last().is_none_or(|top| top.ranges == [EMPTY])
    }

    pub fn triangle_count(&self) -> usize {
        2 * (self.columns - 1) * (self.rows - 1)
    }

    pub fn vertex_count(&self) -> usize {
        self.heights.len()
    }

    pub fn vertex(&self, vertex: u32) -> Vector {
        let (i, j) = (vertex as usize / self.columns, vertex as usize % self.columns);
        let height = self.heights[vertex as usize];
        Vector::new(self.x(j), self.y(i), if height.is_nan() { 0.0 } else { height })
    }

    /// Start of a half-edge of a triangle that is there.
    pub fn tail(&self, half_edge: u32) -> Vector {
        let [row, column] = self.cell(half_edge / 3);
        let [ahead, right] = GroundGrid::CORNERS[(half_edge / 3 % 2) as usize][half_edge as usize % 3];
        self.point(row + ahead, column + right)
    }

    /// The corners of a triangle that is there.
    pub fn points(&self, triangle: u32) -> [Vector; 3] {
        let [row, column] = self.cell(triangle);
        GroundGrid::CORNERS[triangle as usize % 2].map(|[ahead, right]| self.point(row + ahead, column + right))
    }

    /// Rows and columns of the corners of both triangles from their cell's.
    const CORNERS: [[[usize; 2]; 3]; 2] = [[[0, 0], [0, 1], [1, 1]], [[0, 0], [1, 1], [1, 0]]];

    fn point(&self, row: usize, column: usize) -> Vector {
        Vector::new(self.x(column), self.y(row), self.heights[row * self.columns + column])
    }

    /// The ways along the six edges at the start of a half-edge; `None` at a rim.
    pub fn ways_around(&self, half_edge: u32) -> Option<[Vector; 6]> {
        let [row, column] = self.cell(half_edge / 3);
        let [ahead, right] = GroundGrid::CORNERS[(half_edge / 3 % 2) as usize][half_edge as usize % 3];
        let (row, column) = (row + ahead, column + right);
        if row == 0 || column == 0 || row + 1 == self.rows || column + 1 == self.columns {
            return None;
        }
        let at = self.point(row, column);
        let to = |row: usize, column: usize| self.point(row, column) - at;
        let (before, behind) = (column - 1, column + 1);
        let ways = [
            to(row, behind),
            to(row + 1, behind),
            to(row + 1, column),
            to(row, before),
            to(row - 1, before),
            to(row - 1, column),
        ];
        // The other two corners of the cells around.
        let others = to(row + 1, before).z + to(row - 1, behind).z;
        let is_whole = !(ways.iter().map(|way| way.z).sum::<f64>() + others).is_nan();
        is_whole.then_some(ways)
    }

    fn x(&self, column: usize) -> f64 {
        column as f64 * self.spacing[0]
    }

    fn y(&self, row: usize) -> f64 {
        row as f64 * self.spacing[1]
    }

    /// Row and column of a triangle's cell.
    fn cell(&self, triangle: u32) -> [usize; 2] {
        let cell = triangle as usize / 2;
        [cell / (self.columns - 1), cell % (self.columns - 1)]
    }

    /// The heights at the corners of a cell, counter-clockwise from the least.
    fn cell_heights(&self, row: usize, column: usize) -> [f64; 4] {
        let least = row * self.columns + column;
        let above = least + self.columns;
        [self.heights[least], self.heights[least + 1], self.heights[above + 1], self.heights[above]]
    }

    fn is_hole(&self, row: usize, column: usize) -> bool {
        self.cell_heights(row, column).iter().any(|height| height.is_nan())
    }

    /// The least and the greatest height; [`EMPTY`] of a hole.
    fn range_of_cell(&self, row: usize, column: usize) -> [f64; 2] {
        let [a, b, c, d] = self.cell_heights(row, column);
        if (a + b + c + d).is_nan() { EMPTY } else { range_of([a, b, c, d]) }
    }

    /// The vertices of a triangle, all one of a hole.
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        let [row, column] = self.cell(triangle);
        let a = (row * self.columns + column) as u32;
        let c = a + self.columns as u32 + 1;
        match triangle & 1 {
            _ if self.is_hole(row, column) => [a; 3],
            0 => [a, a + 1, c],
            _ => [a, c, c - 1],
        }
    }

    /// The unit normal of a triangle, 0 of a hole. Differences of places along the axes have no error (Sterbenz 1974, §4.3.1), so
    /// each product is right to 3u.
    pub fn normal(&self, triangle: u32) -> Vector {
        let [row, column] = self.cell(triangle);
        let [a, b, c, d] = self.cell_heights(row, column);
        if (a + b + c + d).is_nan() {
            return Vector::zeros();
        }
        let (dx, dy) = (self.x(column + 1) - self.x(column), self.y(row + 1) - self.y(row));
        let [rise_x, rise_y] = if triangle & 1 == 0 { [b - a, c - b] } else { [c - d, d - a] };
        // The sums with +0 turn −0 into 0.
        over_length([0.0 - rise_x * dy, 0.0 - rise_y * dx, dx * dy]).into()
    }

    /// The half-edge on the other side, or [`NONE`].
    pub fn twin(&self, half_edge: u32) -> u32 {
        let (triangle, side) = (half_edge / 3, half_edge % 3);
        let [row, column] = self.cell(triangle);
        let (beside, is_upper, of_other) = match (triangle & 1, side) {
            (0, 0) => (row.checked_sub(1).map(|row| [row, column]), true, 1),
            (0, 1) => (Some([row, column + 1]), true, 2),
            (0, _) => (Some([row, column]), true, 0),
            (_, 0) => (Some([row, column]), false, 2),
            (_, 1) => (Some([row + 1, column]), false, 0),
            _ => (column.checked_sub(1).map(|column| [row, column]), false, 1),
        };
        let is_there = |&[row, column]: &[usize; 2]| {
            row + 1 < self.rows && column + 1 < self.columns && !self.is_hole(row, column)
        };
        match beside.filter(is_there) {
            Some(_) if self.is_hole(row, column) => NONE,
            Some([row, column]) => {
                3 * (2 * (row * (self.columns - 1) + column) as u32 + u32::from(is_upper)) + of_other
            }
            None => NONE,
        }
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> NodeBounds {
        self.bounds_of(self.root())
    }

    fn root(&self) -> BoxPlace {
        BoxPlace { level: self.levels.len() as u32, row: 0, column: 0 }
    }

    fn range(&self, place: BoxPlace) -> [f64; 2] {
        let (row, column) = (place.row as usize, place.column as usize);
        match (place.level as usize).checked_sub(1) {
            Some(level) => self.levels[level].ranges[row * self.levels[level].columns + column],
            None => self.range_of_cell(row, column),
        }
    }

    /// Rows and columns of the cells of a box, up to those behind the last.
    fn cells(&self, place: BoxPlace) -> [[usize; 2]; 2] {
        let size = 1_usize << place.level;
        let along = |at: u32, count: usize| [at as usize * size, ((at as usize + 1) * size).min(count - 1)];
        [along(place.row, self.rows), along(place.column, self.columns)]
    }

    fn bounds_of(&self, place: BoxPlace) -> NodeBounds {
        let ([[row, last_row], [column, last_column]], [least, most]) = (self.cells(place), self.range(place));
        NodeBounds {
            lower: Vector::new(self.x(column), self.y(row), least),
            upper: Vector::new(self.x(last_column), self.y(last_row), most),
        }
    }

    /// Goes to all triangles whose boxes have points in common with a box, and some beside them.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn overlapping(&self, body: &NodeBounds, mut visit: impl FnMut(u32) -> Result<()>) -> Result<()> {
        let across = |k: usize, count: usize| cells_across([body.lower[k], body.upper[k]], self.spacing[k], count - 1);
        let (Some([column, last_column]), Some([row, last_row])) = (across(0, self.columns), across(1, self.rows))
        else {
            return Ok(());
        };
        let [lower, upper] = [body.lower.z, body.upper.z];
        for (box_row, box_column) in (row / SIDE..=last_row / SIDE)
            .flat_map(|row| (column / SIDE..=last_column / SIDE).map(move |column| (row, column)))
        {
            let place = BoxPlace { level: 1, row: box_row as u32, column: box_column as u32 };
            let [least, most] = self.range(place);
            if !(least <= upper && lower <= most) {
                continue;
            }
            let [rows, columns] = self.cells(place);
            for i in rows[0].max(row)..rows[1].min(last_row + 1) {
                for j in columns[0].max(column)..columns[1].min(last_column + 1) {
                    let [cell_least, cell_most] = self.range_of_cell(i, j);
                    // False of a hole.
                    if !(cell_least <= upper && lower <= cell_most) {
                        continue;
                    }
                    let first = 2 * (i * (self.columns - 1) + j) as u32;
                    visit(first)?;
                    visit(first + 1)?;
                }
            }
        }
        Ok(())
    }

    /// Goes to all triangles that `visit` wants.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn walk(&self, visit: &mut impl Visit) -> Result<()> {
        let root = self.root();
        let mut pending = Pending::<_, DEEPEST>::new(root, 0.0);
        while let Some((place, key)) = pending.pop() {
            if place.level < root.level && !visit.goes_to(&self.bounds_of(place), key) {
                continue;
            }
            if place.level == 0 {
                let first = 2 * (place.row * (self.columns as u32 - 1) + place.column);
                if !(visit.triangle(first)? && visit.triangle(first + 1)?) {
                    return Ok(());
                }
                continue;
            }
            let mark = pending.mark();
            let (children, boxes) = self.children(place);
            for (child, key) in children.into_iter().zip(visit.keys(&boxes)) {
                if let Some(child) = child {
                    pending.add(mark, child, key);
                }
            }
        }
        Ok(())
    }

    /// The boxes in one that is no cell, those with triangles.
    fn children(&self, place: BoxPlace) -> ([Option<BoxPlace>; FOUR], FourBoxes) {
        let (level, [rows, columns]) = match place.level as usize - 1 {
            0 => (0, [self.rows - 1, self.columns - 1]),
            below => (below as u32, [self.levels[below - 1].rows, self.levels[below - 1].columns]),
        };
        let mut children = [None; FOUR];
        let mut boxes = FourBoxes { lower: [[0.0; FOUR]; 3], upper: [[0.0; FOUR]; 3] };
        for (at, child) in children.iter_mut().enumerate() {
            let (row, column) = (2 * place.row + at as u32 / 2, 2 * place.column + at as u32 % 2);
            if row as usize >= rows || column as usize >= columns {
                continue;
            }
            let part = BoxPlace { level, row, column };
            let NodeBounds { lower, upper } = self.bounds_of(part);
            // A box without triangles has infinite ends, whose differences are no numbers.
            if lower.z > upper.z {
                continue;
            }
            for k in 0..3 {
                (boxes.lower[k][at], boxes.upper[k][at]) = (lower[k], upper[k]);
            }
            *child = Some(part);
        }
        (children, boxes)
    }
}

/// The first and the last of cells along an axis that a stretch may meet; `None` beside all. A quotient and the places of vertices
/// are right to u each.
fn cells_across([lower, upper]: [f64; 2], spacing: f64, count: usize) -> Option<[usize; 2]> {
    let (first, last) = (lower / spacing * (1.0 - 8.0 * U), upper / spacing * (1.0 + 8.0 * U));
    // False for a NaN.
    if !(first <= count as f64 && last >= 0.0) {
        return None;
    }
    // A conversion from out of the integers' range would be an invalid operation.
    let cell = |x: f64| x.clamp(0.0, (count - 1) as f64) as usize;
    // What begins on a vertex meets the cell before it, too.
    Some([cell(first), cell(last)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::surface::{Ground, HeightGrid};
    use crate::random::Random;

    /// Heights and steps, some with holes.
    fn hills(random: &mut Random, round: usize) -> (usize, [f64; 2], Vec<f64>) {
        let (columns, rows) = (2 + round % 19, 2 + round / 3 % 23);
        let has_holes = round % 2 == 1;
        let height = |random: &mut Random| if has_holes && random.uniform(0.0, 1.0) < 0.1 { f64::NAN } else { 3.0 };
        let heights = (0..columns * rows).map(|_| height(random) * random.uniform(-1.0, 1.0)).collect();
        (columns, [random.uniform(0.01, 2.0), random.uniform(0.01, 2.0)], heights)
    }

    /// A grid has the triangles, neighbours and normals of a soup of the same triangles.
    #[test]
    fn a_grid_is_the_soup_of_its_triangles() {
        let mut random = Random::new(0x941d);
        let (mut twins, mut rims, mut peaks) = (0, 0, 0);
        for round in 0..if cfg!(miri) { 3 } else { 120 } {
            let (columns, spacing, heights) = hills(&mut random, round);
            let rows = heights.len() / columns;
            let Ok(ground) = Ground::from_heights(&HeightGrid { rows, columns, spacing, heights: &heights }) else {
                continue;
            };
            let grid = ground.layout();
            let vertices: Vec<Vector> = (0..ground.vertex_count() as u32).map(|v| grid.vertex(v)).collect();
            let triangles: Vec<[u32; 3]> = (0..ground.triangle_count() as u32).map(|t| grid.corners(t)).collect();
            let twin = Ground::from_triangles(&vertices, &triangles).unwrap();
            let soup = twin.layout();
            // Boxes count holes in.
            let (bounds, least) = (grid.bounds(), soup.bounds());
            assert!(
                bounds == bounds.union(&least) && bounds.lower.z == least.lower.z && bounds.upper.z == least.upper.z
            );
            for t in 0..ground.triangle_count() as u32 {
                assert_eq!(grid.corners(t), soup.corners(t));
                assert!((grid.normal(t) - soup.normal(t)).norm() < 1e-14);
                for half_edge in 3 * t..3 * t + 3 {
                    let lean = random.direction() * random.uniform(0.0, 1.5);
                    let normal = (Vector::z() * if t % 5 == 0 { -1.0 } else { 1.0 } + lean).normalize();
                    let is_peak = ground.is_normal_at_vertex(half_edge, &normal);
                    assert!(grid.is_left_out(t) || is_peak == twin.is_normal_at_vertex(half_edge, &normal));
                    peaks += usize::from(is_peak);
                    assert_eq!(grid.twin(half_edge), soup.twin(half_edge));
                    *if grid.twin(half_edge) == NONE { &mut rims } else { &mut twins } += 1;
                }
            }
        }
        assert!(cfg!(miri) || [twins, rims, peaks].iter().all(|count| *count > 500), "{twins} {rims} {peaks}");
    }

    /// Each triangle whose box meets another is come to, once.
    #[test]
    fn what_overlaps_is_come_to() {
        let mut random = Random::new(0x941e);
        for round in 0..if cfg!(miri) { 3 } else { 120 } {
            let (columns, spacing, heights) = hills(&mut random, round);
            let grid = GroundGrid::new(columns, spacing, heights).unwrap();
            for place in 0..30 {
                let at = random.vector() * 20.0 * spacing[0].max(spacing[1]);
                // Some boxes end on vertices.
                let at = if place % 2 == 0 { at } else { grid.vertex((place % grid.vertex_count()) as u32) };
                let half = random.vector().abs() * 3.0 * f64::from(u8::from(place % 4 < 2));
                let body = NodeBounds { lower: at - half, upper: at + half };
                let mut met = vec![false; grid.triangle_count()];
                grid.overlapping(&body, |triangle| {
                    assert!(!std::mem::replace(&mut met[triangle as usize], true));
                    Ok(())
                })
                .unwrap();
                for triangle in (0..grid.triangle_count() as u32).filter(|t| !met[*t as usize]) {
                    let corners = grid.corners(triangle).map(|v| grid.vertex(v));
                    let is_hole = grid.normal(triangle) == Vector::zeros();
                    assert!(is_hole || NodeBounds::of(&corners).gap(&body) > 0.0);
                }
            }
        }
    }
}
