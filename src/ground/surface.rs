//! The triangles of a ground: their corners, normals and neighbours, and the tree that finds those near a body.

use super::tree::{Bounds, Tree};
use crate::base::error::{Error, Result, check_range};
use crate::base::math::Vector;
use crate::base::memory::{collected, filled, in_integers, with_capacity};
use crate::base::normal::{area_vector, normal_of};
use crate::base::simd::environment::with_default;
use crate::polyhedron::{LARGEST, SMALLEST};
use crate::shape::Triangle;

/// Across no side: the surface ends there, or its triangles there make no surface.
pub(super) const NONE: u32 = u32::MAX;

/// Half-edges are numbers of 32 bits, three of each triangle.
const MOST_TRIANGLES: usize = 1 << 30;

/// A triangle, in 48 bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Record {
    corners: [u32; 3],
    /// The twins of the half-edges 3t + k, from corner k to the next, or [`NONE`].
    twins: [u32; 3],
    /// Unit; 0 of triangles that are left out.
    normal: Vector,
}

/// A surface of triangles, immutable, shared by any number of owners. The front of a triangle is where its corners go around
/// counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Ground {
    vertices: Vec<Vector>,
    records: Vec<Record>,
    tree: Tree,
}

/// Heights over a grid in the plane of x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightGrid<'a> {
    /// Along y, at least 2.
    pub rows: usize,
    /// Along x, at least 2.
    pub columns: usize,
    /// From column to column and from row to row, more than 0.
    pub spacing: [f64; 2],
    /// Row by row, `rows · columns` of them; a NaN is a hole.
    pub heights: &'a [f64],
}

impl Ground {
    /// From triangles over vertices. Those without area, or smaller than 2⁻²⁰⁰, are left out: nothing meets them. Sides with equal
    /// ends are one, if two triangles have it, the one way round and the other.
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
        let build = || Ground::new(collected(vertices.iter().map(|vertex| vertex.add_scalar(0.0)))?, triangles);
        in_integers(|| with_default(build))?
    }

    /// From heights over a grid: for column j and row i the vertex i·columns + j is at (j·spacing₁, i·spacing₂, height). Each
    /// cell is cut from its least corner to its greatest, into triangles that look up: 2c, which has the corner along x, and 2c +
    /// 1, with c = i·(columns − 1) + j of the cell's least corner. A cell with a hole at a corner is a hole.
    ///
    /// # Errors
    /// [`Error::Argument`]: fewer than two rows or columns, a spacing that is not positive and finite, not as many heights as
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
        check_range("spacing[0]", spacing[0], f64::MIN_POSITIVE..=LARGEST)?;
        check_range("spacing[1]", spacing[1], f64::MIN_POSITIVE..=LARGEST)?;
        let mut vertices = with_capacity(heights.len())?;
        for (at, &height) in heights.iter().enumerate() {
            let [x, y] = [(at % columns) as f64 * spacing[0], (at / columns) as f64 * spacing[1]];
            vertices.push(Vector::new(x, y, if height.is_nan() { 0.0 } else { height }));
        }
        let mut triangles = with_capacity(2 * (rows - 1) * (columns - 1))?;
        for least in (0..rows - 1).flat_map(|i| (0..columns - 1).map(move |j| i * columns + j)) {
            let [a, b, c, d] = [least, least + 1, least + columns + 1, least + columns];
            let is_hole = [a, b, c, d].iter().any(|v| heights[*v].is_nan());
            // Left out, as a triangle without area.
            let cell = if is_hole { [[a; 3]; 2] } else { [[a, b, c], [a, c, d]] };
            triangles.extend(cell.map(|corners| corners.map(|v| v as u32)));
        }
        Ground::from_triangles(&vertices, &triangles)
    }

    fn new(vertices: Vec<Vector>, triangles: &[[u32; 3]]) -> Result<Ground> {
        debug_assert!(triangles.as_flattened().iter().all(|v| (*v as usize) < vertices.len()));
        let mut records = with_capacity(triangles.len())?;
        for &corners in triangles {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            let extent = (b - a).amax().max((c - a).amax());
            let is_left_out = extent < 2.0 * SMALLEST;
            let normal = if is_left_out { Vector::zeros() } else { normal_of(&area_vector(&a, &b, &c), &a, &b, &c) };
            records.push(Record { corners, twins: [NONE; 3], normal });
        }
        find_twins(&vertices, &mut records)?;
        let boxes = records.iter().map(|record| {
            let [a, b, c] = record.corners.map(|v| vertices[v as usize]);
            (record.normal != Vector::zeros()).then(|| Bounds::of(&[a, b, c]))
        });
        let Some(tree) = Tree::new(boxes)? else {
            return Err(Error::Mesh(format!("none of the {} triangles of the ground has an area", records.len())));
        };
        Ok(Ground { vertices, records, tree })
    }

    /// How many triangles it has, those included that are left out.
    pub fn triangle_count(&self) -> usize {
        self.records.len()
    }

    /// How many vertices it has.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Memory held, in bytes: less than 200 for each triangle where there are no more vertices than triangles.
    pub fn bytes(&self) -> usize {
        let Ground { vertices, records, tree } = self;
        size_of::<Ground>() + size_of_val(&vertices[..]) + size_of_val(&records[..]) + tree.heap_bytes()
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// A triangle, as the pair layer takes it.
    pub(super) fn triangle(&self, triangle: u32) -> Triangle {
        let Record { corners, normal, .. } = self.records[triangle as usize];
        Triangle { corners: corners.map(|v| self.vertices[v as usize]), normal, labels: corners, label: triangle }
    }

    /// The unit normal of a triangle, out of its front.
    pub(super) fn normal(&self, triangle: u32) -> Vector {
        self.records[triangle as usize].normal
    }

    /// Start of a half-edge.
    pub(super) fn tail(&self, half_edge: u32) -> Vector {
        self.vertices[self.records[half_edge as usize / 3].corners[half_edge as usize % 3] as usize]
    }

    /// The half-edge on the other side, or [`NONE`].
    pub(super) fn twin(&self, half_edge: u32) -> u32 {
        self.records[half_edge as usize / 3].twins[half_edge as usize % 3]
    }
}

/// The next half-edge around a triangle.
pub(super) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The half-edge before.
pub(super) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

/// Joins sides whose ends are at equal places. If three triangles share a side, or two that go the same way, none is a neighbour
/// of another.
fn find_twins(vertices: &[Vector], records: &mut [Record]) -> Result<()> {
    let place_of = first_at_same_place(vertices)?;
    let mut sides = with_capacity(3 * records.len())?;
    for (t, record) in records.iter().enumerate().filter(|(_, record)| record.normal != Vector::zeros()) {
        let places = record.corners.map(|v| place_of[v as usize]);
        for k in 0..3 {
            let [from, to] = [places[k], places[(k + 1) % 3]];
            sides.push(([from.min(to), from.max(to)], (3 * t + k) as u32, from < to));
        }
    }
    sides.sort_unstable();
    for same in sides.chunk_by(|one, other| one.0 == other.0) {
        if let &[(_, one, is_upwards), (_, other, is_too)] = same
            && is_upwards != is_too
        {
            records[one as usize / 3].twins[one as usize % 3] = other;
            records[other as usize / 3].twins[other as usize % 3] = one;
        }
    }
    Ok(())
}

/// For each vertex, the first one with equal coordinates.
fn first_at_same_place(vertices: &[Vector]) -> Result<Vec<u32>> {
    let mut order: Vec<u32> = collected(0..vertices.len() as u32)?;
    let key = |v: u32| <[f64; 3]>::from(vertices[v as usize]);
    // No coordinate is a NaN or −0.
    order.sort_unstable_by(|a, b| key(*a).partial_cmp(&key(*b)).unwrap_or(std::cmp::Ordering::Equal).then(a.cmp(b)));
    let mut place_of = filled(0, vertices.len())?;
    for same in order.chunk_by(|a, b| key(*a) == key(*b)) {
        same.iter().for_each(|v| place_of[*v as usize] = same[0]);
    }
    Ok(place_of)
}
