//! The triangles of a ground: their corners, normals and neighbours, and the tree that finds those near a body.

use std::sync::Arc;

use super::PlacedGround;
use super::covers::Covers;
use super::grid::GroundGrid;
use super::layout::GroundLayout;
use super::marks::Marks;
use super::tree::NodeBounds;
use super::triangles::Soup;
use crate::base::error::{Error, Result, check_range};
use crate::base::mark::Mark;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, in_integers, with_capacity};
use crate::base::simd::environment::with_default;
use crate::body::polyhedron::{LARGEST, SMALLEST};
use crate::shape::{Triangle, TriangleShape};

/// Half-edges are numbers of 32 bits, three of each triangle.
const MOST_TRIANGLES: usize = 1 << 30;

/// A surface of triangles, immutable, shared by any number of owners. The front of a triangle is where its corners go around
/// counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground {
    layout: GroundLayout,
    covers: Covers,
    marks: Vec<Marks>,
    thickness: f64,
    /// The triangle that queries move to where theirs are: a copy for each query, or for each room that is kept.
    shape: Arc<TriangleShape>,
    pub(crate) mark: Mark,
}

/// Heights over a grid in the plane of x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightGrid<'a> {
    /// Along y, at least 2.
    pub rows: usize,
    /// Along x, at least 2.
    pub columns: usize,
    /// From column to column and from row to row, at least 2⁻¹⁹⁹.
    pub spacing: [f64; 2],
    /// Row by row, `rows · columns` of them; a NaN is a hole.
    pub heights: &'a [f64],
}

impl Ground {
    /// From triangles over vertices. Those without area, or smaller than 2⁻²⁰⁰, are left out: nothing meets them; so are copies of
    /// others. Triangles are neighbours at a side that has equal ends and opposite directions; of several there, those that have
    /// nothing before their fronts but each other. A side that lies on another triangle is no rim.
    ///
    /// # Errors
    /// [`Error::Mesh`]: a coordinate is not finite or beyond 2²⁰⁰, a triangle names a vertex that is not there, or no triangle has
    /// an area. [`Error::Limit`] for more than 2³⁰ triangles; [`Error::Memory`].
    pub fn from_triangles(vertices: &[Vector], triangles: &[[u32; 3]]) -> Result<Ground> {
        if let Some(v) = vertices.iter().position(|vertex| !vertex.iter().all(|x| x.abs() <= LARGEST)) {
            let [x, y, z] = <[f64; 3]>::from(vertices[v]);
            return Err(Error::Mesh(format!(
                "vertex {v} of the ground is ({x}, {y}, {z}): coordinates must be finite and at most 2^200"
            )));
        }
        if triangles.len() > MOST_TRIANGLES {
            return Err(Error::Limit(format!("a ground of {} triangles: there may be 2^30", triangles.len())));
        }
        let is_absent = |corner: &u32| *corner as usize >= vertices.len();
        if let Some(t) = triangles.iter().position(|corners| corners.iter().any(is_absent)) {
            return Err(Error::Mesh(format!(
                "triangle {t} of the ground names the vertices {:?} of {}",
                triangles[t],
                vertices.len()
            )));
        }
        // The sum with +0 turns −0 into 0.
        let build = || {
            let vertices = collected(vertices.iter().map(|vertex| vertex.add_scalar(0.0)))?;
            Ground::new(GroundLayout::Soup(Soup::new(vertices, triangles)?))
        };
        in_integers(|| with_default(build))?
    }

    /// From heights over a grid: for column j and row i the vertex i·columns + j is at (j·spacing₁, i·spacing₂, height). Each
    /// cell is cut from its least corner to its greatest, into triangles that look up: 2c, which has the corner along x, and 2c +
    /// 1, with c = i·(columns − 1) + j of the cell's least corner. A cell with a hole at a corner is a hole.
    ///
    /// # Errors
    /// [`Error::Argument`]: fewer than two rows or columns, a spacing that is not finite or less than 2⁻¹⁹⁹, not as many heights as
    /// vertices. Else as [`Ground::from_triangles`].
    pub fn from_heights(grid: &HeightGrid) -> Result<Ground> {
        in_integers(|| with_default(|| Ground::of_heights(grid)))?
    }

    fn of_heights(grid: &HeightGrid) -> Result<Ground> {
        let &HeightGrid { rows, columns, spacing, heights } = grid;
        if rows < 2 || columns < 2 || rows.checked_mul(columns) != Some(heights.len()) {
            return Err(Error::Argument(format!(
                "a grid of {rows} rows and {columns} columns with {} heights: there must be at least two of both, and a height \
                 for each vertex",
                heights.len()
            )));
        }
        if heights.len() > MOST_TRIANGLES / 2 {
            return Err(Error::Limit(format!("a grid of {} heights: there may be 2^29", heights.len())));
        }
        check_range("spacing[0]", spacing[0], 2.0 * SMALLEST..=LARGEST)?;
        check_range("spacing[1]", spacing[1], 2.0 * SMALLEST..=LARGEST)?;
        for (name, count, step) in [("column", columns, spacing[0]), ("row", rows, spacing[1])] {
            let last = (count - 1) as f64 * step;
            if !(last <= LARGEST) {
                return Err(Error::Mesh(format!(
                    "{name} {} of the ground is at {last}: coordinates must be at most 2^200",
                    count - 1
                )));
            }
        }
        if let Some(at) = heights.iter().position(|height| !height.is_nan() && height.abs() > LARGEST) {
            return Err(Error::Mesh(format!(
                "vertex {at} of the ground has the height {}: heights must be at most 2^200, and NaN for a hole",
                heights[at]
            )));
        }
        let grid = GroundGrid::new(columns, spacing, collected(heights.iter().map(|height| height + 0.0))?)?;
        if grid.is_empty() {
            return Err(Error::Mesh(format!(
                "none of the {} cells of the ground has an area: each has a hole at a corner",
                grid.triangle_count() / 2
            )));
        }
        Ground::new(GroundLayout::Grid(grid))
    }

    fn new(layout: GroundLayout) -> Result<Ground> {
        let covers = Covers::new(&layout)?;
        let shape = Arc::new(TriangleShape::new()?);
        let mut ground = Ground { layout, covers, marks: Vec::new(), thickness: 0.0, shape, mark: Mark::new() };
        ground.marks = ground.find_marks()?;
        Ok(ground)
    }

    /// From grounds that are placed beside each other or overlap, in the order given: their vertices and triangles behind each
    /// other. So no seam holds up a body. It is as thick as the thickest.
    ///
    /// # Errors
    /// [`Error::Argument`] for none; [`Error::Pose`] for a pose that is no rotation; [`Error::Limit`] for more than 2³⁰ triangles
    /// or 2³² vertices in all. Else as [`Ground::from_triangles`].
    pub fn from_grounds(grounds: &[PlacedGround]) -> Result<Ground> {
        if grounds.is_empty() {
            return Err(Error::Argument("no grounds to make one of".into()));
        }
        let count = |of: fn(&Ground) -> usize| grounds.iter().map(|placed| of(placed.ground)).sum::<usize>();
        if count(Ground::vertex_count) > u32::MAX as usize {
            return Err(Error::Limit("grounds of more than 2^32 vertices".into()));
        }
        let mut vertices = with_capacity(count(Ground::vertex_count))?;
        let mut triangles = with_capacity(count(Ground::triangle_count))?;
        with_default(|| {
            for PlacedGround { ground, pose } in grounds {
                pose.check()?;
                let first = vertices.len() as u32;
                let layout = &ground.layout;
                vertices.extend((0..ground.vertex_count() as u32).map(|v| pose.transform(&layout.vertex(v))));
                triangles.extend((0..ground.triangle_count() as u32).map(|t| layout.corners(t).map(|v| first + v)));
            }
            Ok(())
        })?;
        let thickness = grounds.iter().map(|placed| placed.ground.thickness).fold(0.0, f64::max);
        Ground::from_triangles(&vertices, &triangles)?.with_thickness(thickness)
    }

    /// The ground as a solid: it pushes out bodies whose centres of mass are behind a triangle by at most `thickness`, also those
    /// that touch none. Infinity is for surfaces that are closed; by default it is 0.
    ///
    /// # Errors
    /// [`Error::Argument`] for a thickness that is negative or NaN.
    pub fn with_thickness(self, thickness: f64) -> Result<Ground> {
        check_range("thickness", thickness, 0.0..=f64::INFINITY)?;
        Ok(Ground { thickness, ..self })
    }

    /// A copy.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn try_clone(&self) -> Result<Ground> {
        let (layout, covers) = (self.layout.try_clone()?, self.covers.try_clone()?);
        let (marks, shape) = (copied(&self.marks)?, self.shape.clone());
        Ok(Ground { layout, covers, marks, thickness: self.thickness, shape, mark: Mark::new() })
    }

    /// How far it pushes out what is behind its triangles.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// How many triangles it has, those included that are left out.
    pub fn triangle_count(&self) -> usize {
        self.layout.triangle_count()
    }

    /// How many vertices it has.
    pub fn vertex_count(&self) -> usize {
        self.layout.vertex_count()
    }

    /// Memory held, in bytes: less than 8,192, and 64 a triangle where there are half as many vertices, 12 a triangle of a grid.
    pub fn bytes(&self) -> usize {
        let Ground { layout, covers, marks, shape, .. } = self;
        let lists = layout.heap_bytes() + covers.heap_bytes() + size_of_val(&marks[..]);
        size_of::<Ground>() + shape.shown().bytes() + lists
    }

    /// The least and the greatest corner of a box around its triangles.
    pub(crate) fn bounds(&self) -> [Vector; 2] {
        let NodeBounds { lower, upper } = self.layout.bounds();
        [lower, upper]
    }

    /// The grid that it was made of, if any.
    pub(crate) fn height_grid(&self) -> Option<HeightGrid<'_>> {
        match &self.layout {
            GroundLayout::Grid(grid) => {
                let (columns, spacing, heights) = grid.parts();
                Some(HeightGrid { rows: heights.len() / columns, columns, spacing, heights })
            }
            GroundLayout::Soup(_) => None,
        }
    }

    /// Its vertices, in their order.
    pub(crate) fn vertices(&self) -> impl ExactSizeIterator<Item = Vector> {
        (0..self.vertex_count()).map(|v| self.layout.vertex(v as u32))
    }

    /// `count` triangles from number `first` on: their vertices and where these are. The corners of one that is left out are one
    /// vertex; at a hole its height is 0.
    ///
    /// # Errors
    /// [`Error::Argument`]: there are no such triangles.
    pub fn triangles(
        &self,
        first: usize,
        count: usize,
    ) -> Result<impl ExactSizeIterator<Item = ([u32; 3], [Vector; 3])>> {
        let total = self.triangle_count();
        let Some(end) = first.checked_add(count).filter(|end| *end <= total) else {
            return Err(Error::Argument(format!(
                "{count} triangles from number {first} on of a ground that has {total}"
            )));
        };
        Ok((first as u32..end as u32).map(|t| {
            let corners = self.layout.corners(t);
            (corners, corners.map(|v| self.layout.vertex(v)))
        }))
    }

    /// The ends of each edge: once for the two triangles beside it, and once for a triangle that has no neighbour there.
    pub(crate) fn edges(&self) -> impl Iterator<Item = [Vector; 2]> {
        let layout = &self.layout;
        let is_first = |half_edge: &u32| !layout.is_left_out(half_edge / 3) && *half_edge < layout.twin(*half_edge);
        (0..3 * self.triangle_count() as u32).filter(is_first).map(|half_edge| layout.ends(half_edge))
    }

    /// The vertices of each triangle; of one that is left out they have no area.
    pub(crate) fn corners(&self) -> impl ExactSizeIterator<Item = [u32; 3]> {
        (0..self.triangle_count()).map(|t| self.layout.corners(t as u32))
    }

    /// The triangles.
    pub(super) fn layout(&self) -> &GroundLayout {
        &self.layout
    }

    /// A triangle, as the pair layer takes it.
    pub(super) fn triangle(&self, triangle: u32) -> Triangle {
        let (corners, labels) = (self.layout.points(triangle), self.layout.corners(triangle));
        Triangle { corners, normal: self.layout.normal(triangle), labels, label: triangle }
    }

    /// The unit normal of a triangle, out of its front.
    pub(super) fn normal(&self, triangle: u32) -> Vector {
        self.layout.normal(triangle)
    }

    pub(super) fn marks(&self, triangle: u32) -> Marks {
        self.marks[triangle as usize]
    }

    /// A triangle to be copied and shown.
    pub(super) fn triangle_shape(&self) -> &TriangleShape {
        &self.shape
    }

    /// Start of a half-edge.
    pub(super) fn tail(&self, half_edge: u32) -> Vector {
        self.layout.tail(half_edge)
    }

    /// The triangles that a side without a twin lies on.
    pub(super) fn covers_of_side(&self, half_edge: u32) -> &[(u32, u32)] {
        self.covers.of_side(half_edge)
    }

    /// The triangles on which the start of a half-edge without a twin lies, those around it left out.
    pub(super) fn covers_of_corner(&self, half_edge: u32) -> &[(u32, u32)] {
        self.covers.of_corner(half_edge)
    }

    /// The half-edge on the other side, or [`NONE`].
    pub(super) fn twin(&self, half_edge: u32) -> u32 {
        self.layout.twin(half_edge)
    }
}
