//! The support function of a body, tabulated over a cube map of directions: one look-up bounds how far the body reaches along a
//! direction, and names a point of it that reaches nearly as far.
//!
//! Within a cell of a cube map the directions are (1, u, v), their order and signs apart. The support function is convex and
//! positively homogeneous, so it is convex in u and in v: bilinear interpolation of its values at the corners of the cell bounds
//! it from above. The same weights on the vertices that are farthest at the corners give a point of the body. How far the point
//! stays behind the bound is the *gap*: for a smooth body it shrinks with the square of the cells, at sharp edges with their
//! size.
//!
//! Directions are stretched first by the root of the body's covariance, in whose frame it is about as thick in all directions. So
//! plates and needles need no finer cells than balls.

use nalgebra::SymmetricEigen;

use crate::base::error::Result;
use crate::base::math::{Matrix, UNIT_ROUNDOFF as U, Vector, power_of_two};
use crate::base::memory::{OnNeed, filled};
use crate::body::build::mass::inertia;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::Plan;
use crate::body::tables::tuning;

/// The unit roundoff of single precision, 2⁻²⁴.
pub const U1: f64 = f32::EPSILON as f64 / 2.0;

/// Cells along a side of the cube, from grid to grid.
const RESOLUTIONS: [usize; 4] = [8, 16, 32, 64];

/// The grids of a body, the coarsest first. Each is made when a query first needs it. Bodies that are not to have a map have none.
#[derive(Debug, Clone)]
pub struct SupportMap {
    least_error: f64,
    grids: Vec<OnNeed<MapGrid>>,
}

/// Two grids of one body.
#[derive(Clone, Copy)]
pub struct Grids<'a> {
    /// The one that mostly is fine enough.
    pub coarse: &'a MapGrid,
    /// The next finer one, for where the other is not; the same where there is none.
    pub fine: &'a MapGrid,
}

/// The answer of a body's grids for an error.
pub enum Choice<'a> {
    /// These are fine enough.
    Grids(Grids<'a>),
    /// It takes more than are made.
    NotMade,
    /// None is fine enough.
    TooCoarse,
}

impl SupportMap {
    /// For a body whose look-up table is planned; nothing is made yet.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(polyhedron: &Polyhedron) -> Result<SupportMap> {
        let radius = polyhedron.radius;
        let (count, least_error) = match (has_support_map(polyhedron), has_finest_grid(polyhedron)) {
            (false, _) => (0, f64::INFINITY),
            (true, false) => (RESOLUTIONS.len() - 1, tuning::LEAST_ERROR_OF_GRIDS * radius),
            (true, true) => (RESOLUTIONS.len(), tuning::LEAST_ERROR_OF_FINEST_GRID * radius),
        };
        Ok(SupportMap { least_error, grids: filled(OnNeed::new(), count)? })
    }

    /// The errors of a distance for which it may be fine enough begin here; infinite for bodies that are not to have one.
    #[inline(always)]
    pub fn least_error(&self) -> f64 {
        self.least_error
    }

    /// The grids for a distance that may be off by so much. It depends on the body and the error alone, not on the other grids
    /// that are made.
    #[inline(always)]
    pub fn choose(&self, error: f64) -> Choice<'_> {
        let grids = &self.grids;
        for (i, grid) in grids.iter().enumerate() {
            let Some(coarse) = grid.get() else { return Choice::NotMade };
            let finer = grids.get(i + 1);
            if coarse.suits(error, finer.is_none()) {
                return match finer.map(OnNeed::get) {
                    Some(None) => Choice::NotMade,
                    Some(Some(fine)) => Choice::Grids(Grids { coarse, fine }),
                    None => Choice::Grids(Grids { coarse, fine: coarse }),
                };
            }
            // From grid to grid a gap shrinks to a quarter at best.
            let best = coarse.largest_gap / power_of_two(2 * (grids.len() - 1 - i) as i32);
            if best > error {
                return Choice::TooCoarse;
            }
        }
        Choice::TooCoarse
    }

    /// Makes the grids that [`SupportMap::choose`] lacks for an error. Where memory is lacking they are not made.
    #[cold]
    #[inline(never)]
    pub fn make_for(&self, polyhedron: &Polyhedron, error: f64) {
        while let (Choice::NotMade, Some(i)) = (self.choose(error), self.first_not_made()) {
            if self.grids[i].make(|| MapGrid::new(polyhedron, RESOLUTIONS[i])).is_none() {
                return;
            }
        }
    }

    /// Makes all that any query may need; nothing for bodies without a map.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn insist(&self, polyhedron: &Polyhedron) -> Result<()> {
        let mut grids = self.grids.iter().zip(RESOLUTIONS);
        grids.try_for_each(|(grid, resolution)| grid.insist(|| MapGrid::new(polyhedron, resolution)))
    }

    fn first_not_made(&self) -> Option<usize> {
        self.grids.iter().position(|grid| grid.get().is_none())
    }

    /// Memory held, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.grids[..]) + self.table_bytes()
    }

    /// The part of that memory held by grids that are made.
    pub fn table_bytes(&self) -> usize {
        self.grids.iter().filter_map(OnNeed::get).map(|grid| size_of_val(&grid.nodes[..])).sum()
    }
}

/// Whether a body's support function is tabulated, once an approximate distance needs it: for bodies with many vertices and
/// shells.
fn has_support_map(polyhedron: &Polyhedron) -> bool {
    (polyhedron.vertices.len() >= tuning::LEAST_VERTICES_FOR_SUPPORT_MAP)
        & matches!(polyhedron.lookup.plan, Plan::Shells { .. })
        & polyhedron.simple
        & (polyhedron.dimension == 3)
}

#[inline(always)]
fn has_finest_grid(polyhedron: &Polyhedron) -> bool {
    polyhedron.vertices.len() >= tuning::LEAST_VERTICES_FOR_FINEST_GRID
}

/// A corner of cells: a vertex farthest along its direction, and in the fourth place how far the body reaches along it, rounded up;
/// in units of the body.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(16))]
pub struct MapNode(pub [f32; 4]);

/// The support function over one cube map.
#[derive(Debug, Clone)]
pub struct MapGrid {
    /// M, which takes a direction of the body to one of the map: symmetric, by columns, the fourth of each 0.
    pub to_map: [[f32; 4]; 3],
    /// 5C in units, for the covariance C of the body: the ellipsoid of half axes √(5C) is about as thick as the body. As `to_map`.
    pub shape: [[f32; 4]; 3],
    /// A power of two that is more than the radius.
    pub unit: f64,
    /// A bound of what a look-up along g in single precision may lack of the support along g, as a multiple of |g|.
    pub misfit: f64,
    /// How far points of look-ups may lie out of the body.
    pub point_error: f64,
    /// Cells along a side.
    pub resolution: usize,
    /// Face by face and row by row: (resolution + 1)² for each of six faces.
    pub nodes: Vec<MapNode>,
    /// The gap along a unit vector in the middle of a cell, in the mean of all cells.
    mean_gap: f64,
    /// The largest of them.
    largest_gap: f64,
}

/// The direction of a map at (u, v) of a face: faces 2k and 2k + 1 are those where axis k is 1 and −1.
pub fn direction_of_map(face: usize, u: f64, v: f64) -> Vector {
    debug_assert!(face < 6);
    debug_assert!(u.abs() <= 1.0 && v.abs() <= 1.0);
    debug_assert!(face < 6);
    let axis = face / 2;
    let mut direction = Vector::zeros();
    direction[axis] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    direction[(axis + 1) % 3] = u;
    direction[(axis + 2) % 3] = v;
    direction
}

impl MapGrid {
    fn new(polyhedron: &Polyhedron, resolution: usize) -> Result<MapGrid> {
        debug_assert!(resolution.is_power_of_two());
        let stretch = Stretch::of(polyhedron);
        let radius = polyhedron.radius;
        // The exponent of a number of the range of simple bodies.
        let unit = power_of_two((radius.to_bits() >> 52) as i32 - 1022);
        let mut grid = MapGrid {
            to_map: columns(&stretch.to_map),
            shape: columns(&(stretch.shape / (unit * unit))),
            unit,
            misfit: radius * stretch.misfit,
            // With u₁ = 2⁻²⁴: rounding moves a vertex by u₁ρ, and by less than 2⁻¹⁴⁷ units where it underflows; two interpolations,
            // one of the results of the other, err by 10u₁ρ a coordinate. Together less than 20u₁ρ.
            point_error: 20.0 * U1 * radius,
            resolution,
            nodes: filled(MapNode([0.0; 4]), 6 * (resolution + 1) * (resolution + 1))?,
            mean_gap: 0.0,
            largest_gap: 0.0,
        };
        grid.fill(polyhedron, &stretch.from_map);
        grid.measure(&stretch.from_map);
        Ok(grid)
    }

    fn fill(&mut self, polyhedron: &Polyhedron, from_map: &Matrix) {
        let side = self.resolution + 1;
        let coordinate = |i: usize| 2.0 * i as f64 / self.resolution as f64 - 1.0;
        let mut row_start = 0;
        for (row, nodes) in self.nodes.chunks_exact_mut(side).enumerate() {
            let mut vertex = row_start;
            for (i, node) in nodes.iter_mut().enumerate() {
                let direction = from_map * direction_of_map(row / side, coordinate(i), coordinate(row % side));
                let highest = highest(polyhedron, &direction, vertex);
                vertex = highest.vertex;
                if i == 0 {
                    row_start = vertex;
                }
                let [x, y, z] = (polyhedron.vertices[vertex as usize].position / self.unit).map(|x| x as f32).into();
                *node = MapNode([x, y, z, rounded_up(highest.height / self.unit)]);
            }
        }
    }

    /// Measures the gaps in the middle of all cells.
    fn measure(&mut self, from_map: &Matrix) {
        let (resolution, side) = (self.resolution, self.resolution + 1);
        let middle = |i: usize| (2.0 * i as f64 + 1.0) / resolution as f64 - 1.0;
        let (mut sum, mut largest) = (0.0, 0.0);
        for face in 0..6 {
            for (j, i) in (0..resolution).flat_map(|j| (0..resolution).map(move |i| (j, i))) {
                let direction = from_map * direction_of_map(face, middle(i), middle(j));
                let first = (face * side + j) * side + i;
                let corners = [first, first + 1, first + side, first + side + 1];
                let [x, y, z, height] = corners
                    .map(|at| self.nodes[at].0.map(|x| 0.25 * f64::from(x)))
                    .into_iter()
                    .fold([0.0; 4], |sum, node| std::array::from_fn(|k| sum[k] + node[k]));
                let gap = (height - direction.dot(&Vector::new(x, y, z))) * self.unit / direction.norm();
                sum += gap;
                largest = f64::max(largest, gap);
            }
        }
        self.mean_gap = sum / (6 * resolution * resolution) as f64;
        self.largest_gap = largest;
    }

    /// Whether it is fine enough for a distance that may be off by so much.
    #[inline(always)]
    fn suits(&self, error: f64, is_finest: bool) -> bool {
        let is_fine = (self.mean_gap + self.misfit <= tuning::MEAN_GAP * error) & (self.largest_gap <= error);
        is_fine | (is_finest & (self.largest_gap <= tuning::LARGEST_GAP_OF_FINEST * error))
    }
}

/// Columns for lanes.
fn columns(matrix: &Matrix) -> [[f32; 4]; 3] {
    std::array::from_fn(|k| [matrix[(0, k)], matrix[(1, k)], matrix[(2, k)], 0.0].map(|x| x as f32))
}

/// The least single-precision number that is not less; the result may be infinite, which is an upper bound, too.
fn rounded_up(x: f64) -> f32 {
    let rounded = x as f32;
    if f64::from(rounded) < x { rounded.next_up() } else { rounded }
}

/// The frame in which a body is about as thick in all directions.
struct Stretch {
    to_map: Matrix,
    from_map: Matrix,
    shape: Matrix,
    /// Same as [`MapGrid::misfit`], for a body of radius 1.
    misfit: f64,
}

impl Stretch {
    fn of(polyhedron: &Polyhedron) -> Stretch {
        let tensor = inertia(polyhedron);
        let covariance = Matrix::from_diagonal_element(0.5 * tensor.trace()) - tensor;
        let scale = covariance.amax();
        // Eight iterations are the most that was seen; without a result the body counts as round.
        let eigen = SymmetricEigen::try_new(covariance / scale, f64::EPSILON, 64);
        let (axes, widths) = match eigen {
            Some(SymmetricEigen { eigenvectors, eigenvalues }) => {
                let largest = eigenvalues.amax().sqrt();
                (eigenvectors, eigenvalues.map(|x| (x.max(0.0).sqrt() / largest).max(tuning::LEAST_STRETCH)))
            }
            None => (Matrix::identity(), Vector::repeat(1.0)),
        };
        let with = |diagonal: Vector| axes * Matrix::from_diagonal(&diagonal) * axes.transpose();
        let (to_map, from_map) = (with(widths), with(widths.map(|width| 1.0 / width)));
        Stretch { to_map, from_map, shape: 5.0 * covariance, misfit: misfit(&to_map, &from_map) }
    }
}

/// How far a look-up along g in single precision may fall short of the support along g, for M = `to_map`, N = `from_map` and a body
/// of radius 1, as a multiple of |g|. Norms are those of Frobenius, u₁ = 2⁻²⁴.
///
/// The look-up takes d = M·g with M rounded, off by 4u₁‖M‖|g|, and interpolates at a direction e of the map that the rounding of u,
/// v and of the place within the cell moves by at most 9u₁|d|. The support along N·e is that along g up to |g − N·e| ≤
/// (‖I − NM‖ + 13.4u₁‖N‖‖M‖)|g|. Heights at nodes are at most 1.8‖N‖. An interpolation, a + f(b − a), errs by 5u₁ of the largest,
/// one of interpolated numbers by 10u₁, the product with the length by another u₁; the weights together are at most
/// |d| ≤ 1.01‖M‖|g|: 20u₁‖N‖‖M‖|g|. All that is less than 34u₁‖N‖‖M‖. 40u₁ are allowed, for what doubles round, too: the
/// directions of nodes, and the residual.
fn misfit(to_map: &Matrix, from_map: &Matrix) -> f64 {
    (Matrix::identity() - from_map * to_map).norm() + 40.0 * U1 * from_map.norm() * to_map.norm()
}

/// How far a body reaches along a direction.
struct Highest {
    /// A vertex that reaches as far, up to rounding.
    vertex: u32,
    /// No vertex reaches farther; about the centred origin.
    height: f64,
}

/// By a climb with a proved end: on a convex body a vertex all of whose neighbours are behind is the farthest. Where one may be
/// level with it, as along the normal of a face, all vertices are looked at.
fn highest(polyhedron: &Polyhedron, direction: &Vector, start: u32) -> Highest {
    debug_assert!((start as usize) < polyhedron.vertices.len());
    let length = direction.lp_norm(1);
    // Three products and two sums.
    let rounding = 4.0 * U * length * polyhedron.radius;
    let height = |vertex: u32| polyhedron.vertices[vertex as usize].position.dot(direction);
    let (vertex, _) = polyhedron.support(direction, start);
    // A computed slope is off by less than 8u·|direction|₁.
    let steepest = polyhedron.steepest_closely(vertex, direction, length);
    if steepest.is_none_or(|steepest| steepest.slope < -8.0 * U * length) {
        return Highest { vertex, height: height(vertex) + rounding };
    }
    let mut best = (vertex, height(vertex));
    for other in 0..polyhedron.vertices.len() as u32 {
        let height = height(other);
        if height > best.1 {
            best = (other, height);
        }
    }
    Highest { vertex: best.0, height: best.1 + rounding }
}
