//! An interval of the distance from look-ups of both bodies' support functions, along a direction that gets better from one to the
//! next.
//!
//! Along a unit direction n from body 2 to body 1, with h₁ and h₂ the heights that the maps give for −R₁ᵀn and R₂ᵀn, x and y the
//! points that go with them, Δ the difference of the origins:
//!
//! ```text
//! n·Δ − h₁ − h₂  ≤  distance  ≤  |Δ + R₁x − R₂y|
//! ```
//!
//! The distance is the largest gap over all directions (the bodies being disjoint), and where n is best the difference of the
//! points is parallel to n. So the next direction is a Newton step towards that, with the curvature of two ellipsoids about as
//! thick as the bodies.
//!
//! Both bodies are looked up at once, in single precision, in a unit of length in which neither is larger than 1. The rounding in
//! that is far less than errors that are worth a look-up; [`SupportSearch::interval`] adds it.

use crate::base::simd::{Lanes, Twins};
use crate::body::tables::support_map::{Grids, MapGrid, MapNode, U1};
use crate::distance::certificate::{Interval, reciprocal_length};
use crate::placed::frame::Frame;

/// Look-ups after which the bodies themselves are asked; three in four searches need one or two.
const MOST_LOOKS: u32 = 8;

/// At these look-ups the direction is that of the shortest difference known, not a Newton step, which may go back and forth
/// between two sides of an edge: without that three to eight of a hundred searches fail.
const SHORTEST_AT: [u32; 2] = [4, 7];

/// From this look-up on the last three differences are combined.
const COMBINED_FROM: u32 = 3;

/// The gap along a direction below which bodies mostly intersect, which no look-up shows, as a multiple of the distance of their
/// origins.
const MUCH_OVERLAP: f32 = -0.125;

/// A difference this near to parallel to its direction (the cosine) shows that the direction is right …
const IS_RIGHT: f32 = 0.995;

/// … and if its own interval is at most this times as wide as the best, then the cells are too wide.
const OWN_WIDTH: f32 = 1.15;

/// A search: look, and unless that suffices, advance. Vectors of the pair stand in both places.
pub struct SupportSearch<'a, L: Lanes> {
    grids: [Grids<'a>; 2],
    is_fine: bool,
    /// A power of two: lengths below are in this unit, except those of slacks.
    unit: f64,
    /// The rounding error that may have been added to a gap, and taken from a distance.
    slacks: [f64; 2],
    /// R of both bodies, rows, and columns times the body's unit.
    rows: [L::Twins; 3],
    columns: [L::Twins; 3],
    /// The bodies' own units.
    units: [f32; 2],
    /// Δ, and an upper bound of its length.
    offset: L::Twins,
    separation: f32,
    /// A unit vector, up to rounding, from body 2 to body 1.
    direction: L::Twins,
    /// The result of the last look-up.
    difference: L::Twins,
    distance: f32,
    gap: f32,
    /// The differences of the last two before.
    last: [L::Twins; 2],
    looks: u32,
    /// The largest gap so far, and its direction.
    best_gap: f32,
    best_direction: L::Twins,
    /// The shortest difference of points so far.
    shortest: L::Twins,
    shortest_distance: f32,
}

impl<'a, L: Lanes> SupportSearch<'a, L> {
    /// From a unit vector; the bodies are placed by rotations that are right up to rounding.
    ///
    /// The slacks, with u₁ = 2⁻²⁴, s for the sum of the radii and D for |Δ|; R has an entry's rounding u₁, |R| ≤ 1.01 and
    /// ‖R‖ ≤ 1.75 in Frobenius's norm:
    ///
    /// | of a gap | at most |
    /// |---|--:|
    /// | Rᵀn: entries and three products, 4u₁‖R‖, times the radii | 7.2u₁s |
    /// | n·Δ: Δ rounded, three products | 5.1u₁D |
    /// | sums of heights, and their difference | 2.2u₁(s + D) |
    /// | the length of n, 1 up to 5u₁, which divides the gap | 5.1u₁(s + D) |
    ///
    /// That is less than 16u₁(s + D). The error of the maps' own directions is added. For a distance: R·x as Rᵀn, 7.2u₁s; Δ, u₁D;
    /// sums, 3.1u₁(s + D); root and square, 4u₁(s + D); a combination of differences, 9.1u₁(s + D). That is less than 32u₁(s +
    /// D), and points lie a little out of their bodies.
    #[inline(always)]
    pub fn new(frame: &Frame<L>, grids: [Grids<'a>; 2], direction: L) -> Self {
        let [body1, body2] = &frame.bodies;
        let [grid1, grid2] = [grids[0].coarse, grids[1].coarse];
        let unit = if grid1.unit > grid2.unit { grid1.unit } else { grid2.unit };
        let in_units = 1.0 / unit;
        let units = [(grid1.unit * in_units) as f32, (grid2.unit * in_units) as f32];
        let scale = L::Twins::splat(units[0], units[1]);
        let ([a, b, c], [x, y, z]) = (body1.rows(), body2.rows());
        let ([p, q, r], [u, v, w]) = (body1.columns(), body2.columns());
        let offset = body1.offset.mul(L::splat(in_units));
        let extent = frame.size + frame.separation;
        let direction = direction.twins(direction);
        let zero = L::Twins::splat(0.0, 0.0);
        SupportSearch {
            grids,
            is_fine: false,
            unit,
            slacks: [
                16.0 * U1 * extent + 1.02 * (grid1.misfit + grid2.misfit),
                32.0 * U1 * extent + grid1.point_error + grid2.point_error,
            ],
            rows: [a.twins(x), b.twins(y), c.twins(z)],
            columns: [p.twins(u).mul(scale), q.twins(v).mul(scale), r.twins(w).mul(scale)],
            units,
            offset: offset.twins(offset),
            separation: (frame.separation * in_units) as f32,
            direction,
            difference: zero,
            distance: 0.0,
            gap: 0.0,
            last: [zero; 2],
            looks: 0,
            best_gap: f32::NEG_INFINITY,
            best_direction: direction,
            shortest: zero,
            shortest_distance: f32::INFINITY,
        }
    }

    /// The interval proved so far. `lower` may be negative.
    #[inline(always)]
    pub fn interval(&self) -> Interval {
        Interval {
            lower: f64::from(self.best_gap) * self.unit - self.slacks[0],
            upper: f64::from(self.shortest_distance) * self.unit + self.slacks[1],
        }
    }

    /// The unit vector along which the gap is at least `lower`.
    #[inline(always)]
    pub fn normal(&self) -> L {
        let [x, y, z, ..] = self.best_direction.to_array();
        let direction = L::load(&[x.into(), y.into(), z.into(), 0.0]);
        direction.mul(L::splat(reciprocal_length(direction.dot(direction))))
    }

    /// Looks up both bodies along the direction.
    #[inline(always)]
    pub fn look(&mut self) {
        let [first, second] = &self.grids;
        let grids = if self.is_fine { [first.fine, second.fine] } else { [first.coarse, second.coarse] };
        let towards = L::Twins::product(&self.rows, self.direction).negate_first();
        let Supports { points, heights } = look_up::<L>(grids, towards);
        let rotated = L::Twins::product(&self.columns, points);
        self.difference = self.offset.sub(rotated.negate_first().sum());
        self.distance = self.difference.dot(self.difference).sqrt();
        self.gap = self.direction.dot(self.offset) - (heights[0] * self.units[0] + heights[1] * self.units[1]);
        self.looks += 1;
        if self.gap > self.best_gap {
            (self.best_gap, self.best_direction) = (self.gap, self.direction);
        }
        if self.distance < self.shortest_distance {
            (self.shortest_distance, self.shortest) = (self.distance, self.difference);
        }
        if self.looks >= COMBINED_FROM {
            let combined = nearest_of_triangle([self.last[0], self.last[1], self.difference]);
            let distance = combined.dot(combined).sqrt();
            if distance < self.shortest_distance {
                (self.shortest_distance, self.shortest) = (distance, combined);
            }
        }
        self.last = if self.looks == 1 { [self.difference; 2] } else { [self.last[1], self.difference] };
    }

    /// Goes on to a better direction or to finer grids; false where neither is worth a try.
    #[inline(always)]
    pub fn advance(&mut self) -> bool {
        if (self.looks >= MOST_LOOKS) | !(self.gap > MUCH_OVERLAP * self.separation) {
            return false;
        }
        let alignment = self.difference.dot(self.direction);
        let width = self.shortest_distance - self.best_gap;
        if (self.distance - self.gap < OWN_WIDTH * width) & (alignment > IS_RIGHT * self.distance) {
            if self.is_fine {
                return false;
            }
            self.is_fine = true;
        }
        let next = if SHORTEST_AT.contains(&self.looks) { self.shortest } else { self.newton_step(alignment) };
        let inverse = 1.0 / next.dot(next).sqrt();
        self.direction = next.mul(L::Twins::splat(inverse, inverse));
        true
    }

    /// n + S⁻¹(w − (w·n)n), up to a positive factor, for the difference w and S the Hessian of |w|·|n|²/2 minus the gap of two
    /// ellipsoids. As S·n = |w|n that is n(1 − w·n/|w|) + S⁻¹w; S⁻¹ is the matrix of S's cofactors over its determinant.
    #[inline(always)]
    fn newton_step(&self, alignment: f32) -> L::Twins {
        let (n, w, distance) = (self.direction, self.difference, self.distance);
        let [a, b, c] = self.hessian();
        let diagonal = [[distance, 0.0, 0.0, 0.0], [0.0, distance, 0.0, 0.0], [0.0, 0.0, distance, 0.0]];
        let a = a.sum().add(L::Twins::load(&diagonal[0], &diagonal[0]));
        let b = b.sum().add(L::Twins::load(&diagonal[1], &diagonal[1]));
        let c = c.sum().add(L::Twins::load(&diagonal[2], &diagonal[2]));
        let cofactors = [b.cross(c), c.cross(a), a.cross(b)];
        let along = (1.0 - alignment / distance.max(f32::MIN_POSITIVE)) * a.dot(cofactors[0]);
        n.mul_add(L::Twins::splat(along, along), L::Twins::product(&cofactors, w))
    }

    /// The columns of the Hessians of √(nᵀQn) of both bodies, for Q = R·5C·Rᵀ: Q/h − Qn·(Qn)ᵀ/h³, h the root.
    #[inline(always)]
    fn hessian(&self) -> [L::Twins; 3] {
        let ([grids1, grids2], [row1, row2, row3]) = (&self.grids, self.rows);
        let shape = columns::<L>(&grids1.coarse.shape, &grids2.coarse.shape);
        let units = L::Twins::splat(self.units[0], self.units[1]);
        let x = L::Twins::product(&self.columns, L::Twins::product(&shape, row1)).mul(units);
        let y = L::Twins::product(&self.columns, L::Twins::product(&shape, row2)).mul(units);
        let z = L::Twins::product(&self.columns, L::Twins::product(&shape, row3)).mul(units);
        let q = L::Twins::product(&[x, y, z], self.direction);
        let [square1, square2] = q.dots(self.direction);
        let scale = L::Twins::splat(inverse_root(square1), inverse_root(square2));
        let scaled = q.mul(scale.mul(scale.mul(scale)));
        [
            scaled.negated_mul_add(q.splat_x(), x.mul(scale)),
            scaled.negated_mul_add(q.splat_y(), y.mul(scale)),
            scaled.negated_mul_add(q.splat_z(), z.mul(scale)),
        ]
    }
}

/// 1/√x, of 0 a large number.
#[inline(always)]
fn inverse_root(x: f32) -> f32 {
    1.0 / x.max(f32::MIN_POSITIVE).sqrt()
}

/// The columns of a matrix of each body.
#[inline(always)]
fn columns<L: Lanes>(first: &[[f32; 4]; 3], second: &[[f32; 4]; 3]) -> [L::Twins; 3] {
    [
        L::Twins::load(&first[0], &second[0]),
        L::Twins::load(&first[1], &second[1]),
        L::Twins::load(&first[2], &second[2]),
    ]
}

/// The supports of both bodies from a look-up, in the units of each.
pub struct Supports<T> {
    /// A point of each, up to the grid's `point_error`.
    pub points: T,
    /// It reaches no farther, up to the grid's `misfit`.
    pub heights: [f32; 2],
}

/// Looks up the supports along a direction of each body.
#[inline(always)]
pub fn look_up<L: Lanes>(grids: [&MapGrid; 2], towards: L::Twins) -> Supports<L::Twins> {
    let [grid1, grid2] = grids;
    let to_map = columns::<L>(&grid1.to_map, &grid2.to_map);
    let [a, b, c, _, x, y, z, _] = L::Twins::product(&to_map, towards).to_array();
    let (cell1, cell2) = (Cell::of(grid1, [a, b, c]), Cell::of(grid2, [x, y, z]));
    let (side1, side2) = (grid1.resolution + 1, grid2.resolution + 1);
    let node00 = L::Twins::load(&cell1.nodes[0].0, &cell2.nodes[0].0);
    let node10 = L::Twins::load(&cell1.nodes[1].0, &cell2.nodes[1].0);
    let node01 = L::Twins::load(&cell1.nodes[side1].0, &cell2.nodes[side2].0);
    let node11 = L::Twins::load(&cell1.nodes[side1 + 1].0, &cell2.nodes[side2 + 1].0);
    let across = L::Twins::splat(cell1.across, cell2.across);
    let along = L::Twins::splat(cell1.along, cell2.along);
    let near = node10.sub(node00).mul_add(across, node00);
    let far = node11.sub(node01).mul_add(across, node01);
    let node = far.sub(near).mul_add(along, near);
    let [.., height1, _, _, _, height2] = node.to_array();
    Supports { points: node, heights: [cell1.length * height1, cell2.length * height2] }
}

/// The cell where a direction meets the map of a body.
struct Cell<'a> {
    /// From the first corner of the cell on; the second row begins a side later.
    nodes: &'a [MapNode],
    /// The direction is this times (1, u, v).
    length: f32,
    /// The places of u and v in the cell, from 0 to 1.
    across: f32,
    along: f32,
}

impl Cell<'_> {
    #[inline(always)]
    fn of(grid: &MapGrid, direction: [f32; 3]) -> Cell<'_> {
        const NEXT: [usize; 3] = [1, 2, 0];
        let [x, y, z] = [direction[0].abs(), direction[1].abs(), direction[2].abs()];
        let (axis, length) = if x >= y { (0, x) } else { (1, y) };
        let (axis, length) = if z > length { (2, z) } else { (axis, length) };
        let face = 2 * axis + usize::from(direction[axis] < 0.0);
        let (column, across) = place(direction[NEXT[axis]] / length, grid.resolution);
        let (row, along) = place(direction[NEXT[NEXT[axis]]] / length, grid.resolution);
        let side = grid.resolution + 1;
        let first = (face * side + row) * side + column;
        Cell { nodes: &grid.nodes[first..first + side + 2], length, across, along }
    }
}

/// The cell of a row in which a coordinate from −1 to 1 is, and where in it.
#[inline(always)]
fn place(coordinate: f32, resolution: usize) -> (usize, f32) {
    // Half a power of two: the product is exact, the sum at most the resolution. A NaN is in cell 0 and makes all NaN.
    let half = 0.5 * resolution as f32;
    let place = coordinate * half + half;
    let cell = (place as usize).min(resolution - 1);
    (cell, place - cell as f32)
}

/// The point of a triangle nearest to the origin, or one about as near: some convex combination in any case.
#[inline(always)]
fn nearest_of_triangle<T: Twins>([a, b, c]: [T; 3]) -> T {
    let normal = b.sub(a).cross(c.sub(a));
    let weights = [b.cross(c).dot(normal), c.cross(a).dot(normal), a.cross(b).dot(normal)];
    if (weights[0] > 0.0) & (weights[1] > 0.0) & (weights[2] > 0.0) {
        let scale = 1.0 / (weights[0] + weights[1] + weights[2]);
        let [p, q, r] = [weights[0] * scale, weights[1] * scale, weights[2] * scale];
        return a.mul_add(T::splat(p, p), b.mul_add(T::splat(q, q), c.mul(T::splat(r, r))));
    }
    let sides = [nearest_of_segment(a, b), nearest_of_segment(b, c), nearest_of_segment(c, a)];
    let mut nearest = sides[0];
    for side in &sides[1..] {
        if side.dot(*side) < nearest.dot(nearest) {
            nearest = *side;
        }
    }
    nearest
}

#[inline(always)]
fn nearest_of_segment<T: Twins>(a: T, b: T) -> T {
    let along = b.sub(a);
    let part = -a.dot(along) / along.dot(along).max(f32::MIN_POSITIVE);
    let part = if part > 0.0 { part.min(1.0) } else { 0.0 };
    along.mul_add(T::splat(part, part), a)
}
