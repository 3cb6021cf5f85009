//! The convex polyhedron that queries run on: the exact hull of the stored vertices, laid out for Voronoi marching.
//!
//! Exact part: `vertices` and `triangles` are the exact convex hull of the vertices that were given. Floating part:
//! planes, unit directions and offsets are data for the search; how far each plane misses the exact hull is its `slack`,
//! an upper bound computed at build time, which goes into every interval (Lin & Canny 1991; Mirtich 1998;
//! Ehmann & Lin 2000, §5.1).
//!
//! Coordinates are *centred*: stored vertex = `centre` + `vertices[i].position`, an exact sum (Sterbenz), so that an
//! object far from its own origin loses no digits. The centre is zero unless an axis range [m−h, m+h] has h ≤ |m|/3.

use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, copied};
use crate::base::normal::unit;
use crate::body::polyhedron::contact_faces::ContactFaces;
use crate::body::polyhedron::fan::{Fan, PointBlock};
use crate::body::polyhedron::lookup::Lookup;
use crate::body::polyhedron::outlines::Outlines;
use crate::body::polyhedron::planes::PlaneBlock;
use crate::body::polyhedron::polygon_search::PolygonSearch;
use std::ops::RangeInclusive;

/// No feature: in the edge slot of a neighbour that is not across an edge of a merged face, as the bevel of a blunt edge.
pub const NONE: u32 = u32::MAX;

/// Magnitudes outside [2⁻²⁰⁰, 2²⁰⁰] are left to integers: the bounds of rounding errors ignore underflow and overflow.
pub const LARGEST: f64 = f64::from_bits((1023 + 200) << 52);
/// See [`LARGEST`].
pub const SMALLEST: f64 = f64::from_bits((1023 - 200) << 52);

/// Up to eight neighbours of a vertex in the triangulated exact hull, diagonals of merged faces included; those along edges
/// come first. Unused lanes repeat lane 0, so that a test over all lanes needs no mask. A point body is its own neighbour, in
/// direction 0.
///
/// Single precision tells a neighbour that is clearly ahead or behind, in half the memory; where it does not,
/// [`Polyhedron::direction_to`] has all digits.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(32))]
pub struct NeighbourBlock {
    /// First components of the unit vectors from the vertex to its neighbours.
    pub x: [f32; 8],
    /// Second components.
    pub y: [f32; 8],
    /// Third components.
    pub z: [f32; 8],
    /// The neighbours.
    pub head: [u32; 8],
    /// The edges along which they lie, or [`NONE`] inside a merged face. The neighbour is the edge's other end, or a flat vertex
    /// within the edge; flat vertices within an edge know it, too.
    pub edge: [u32; 8],
}

/// A vertex of the hull. Two cache lines serve where no neighbour is farther; the third says where to go.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Vertex {
    /// Exact centred coordinates.
    pub position: Vector,
    /// Start of its neighbour blocks beyond the first in `more_neighbours`.
    pub first_more: u32,
    /// How many blocks beyond the first.
    pub more: u32,
    /// The first.
    pub neighbours: NeighbourBlock,
}

/// An edge between two merged faces, from `tail` to `head`, the face `left` of it seen from outside. Once per edge. The members
/// that every query looks at are in the first three cache lines.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct Edge {
    /// The Voronoi region, inside ≥ 0 in all lanes: beyond the tail (`direction·p − direction·tail`), before the head
    /// (`length − lane 0`), outside the prism of the left face (minus the inward side direction of the left face), outside
    /// that of the right face. Lane 0's normal is the unit direction of the edge; minus lane 2's and 3's normals are the
    /// unit inward side directions `n_left × direction` and `direction × n_right`.
    pub planes: PlaneBlock,
    /// Position of the tail.
    pub tail_position: Vector,
    /// Length of the edge.
    pub length: f64,
    /// The largest of the slacks of both faces and of the bevel, and the effect of an edge that leans out of their planes; +∞,
    /// which asks for a closer look, where rounding hides the dihedral angle.
    pub slack: f64,
    /// The vertex or face across each of `planes`: tail, head, left face, right face; [`NONE`] beside a segment, whose lanes 2 and
    /// 3 hold every point. An array, since marching looks up one of
    /// them without knowing which.
    pub across: [u32; 4],
    /// The caller's indices of the two vertices.
    pub labels: [u32; 2],
    /// Unit outward normals of the left and the right face.
    pub normals: [Vector; 2],
    /// 1 / (−n_left·side_right), the reciprocal sine of the exterior dihedral angle; +∞ where that is not positive.
    pub reciprocal_sine: f64,
    /// Index in `bevels` of the plane that halves a sharp edge (n_left·n_right < 0), or [`NONE`].
    pub bevel: u32,
}

impl Edge {
    /// First vertex.
    #[inline(always)]
    pub fn tail(&self) -> u32 {
        self.across[0]
    }

    /// Second vertex.
    #[inline(always)]
    pub fn head(&self) -> u32 {
        self.across[1]
    }

    /// Left face.
    #[inline(always)]
    pub fn left(&self) -> u32 {
        self.across[2]
    }

    /// Right face.
    #[inline(always)]
    pub fn right(&self) -> u32 {
        self.across[3]
    }
}

/// A supporting plane through a sharp edge, its normal between those of the two faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bevel {
    /// Unit outward normal: (n_left + n_right)/|·|; for a flat body the in-plane outward normal of the edge.
    pub normal: Vector,
    /// An upper bound of max over the exact hull of n·x minus min over this edge's vertices, flat ones included, of n·x.
    pub slack: f64,
}

/// A face: all exactly or within rounding coplanar triangles merged, a convex polygon of any valence.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C, align(64))]
pub struct MergedFace {
    /// Lane 0: the face's plane, positive outside. Lanes 1–3: its first three sides, each positive inside the polygon's
    /// prism (normal `n × direction` with the edge counter-clockwise). Further sides are in `more_sides`.
    pub planes: PlaneBlock,
    /// σ: an upper bound of max over the exact hull of n·x minus min over this face's own vertices, flat ones included, of n·x.
    pub slack: f64,
    /// Start of the face's sides in `sides`; side i lies in lane 1 + i of `planes` for i < 3, else in lane (i − 3) % 4 of
    /// `more_sides[first_more + (i − 3) / 4]`.
    pub first_side: u32,
    /// Number of sides.
    pub side_count: u32,
    /// Index of the first further plane block; unused lanes of the last block hold normal 0 and offset +∞.
    pub first_more: u32,
    /// One vertex of the face.
    pub vertex: u32,
    /// The caller's polygon that the face is, or [`NONE`] where several were merged into it.
    pub label: u32,
    /// The first three of its `sides`, so that marching on to one of them need not look there: often the face has no more.
    pub first_sides: [u32; 3],
    /// The unit outward normal, as in lane 0 of `planes`.
    pub normal: Vector,
}

/// Volume, centre of mass and the like; for a flat body the area-weighted, for a segment the length-weighted ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Volume; 0 without interior.
    pub volume: f64,
    /// Volume centre of mass, in the caller's frame (after the input transform).
    pub centre_of_mass: Vector,
    /// Largest distance of a vertex from the centre of mass.
    pub radius: f64,
    /// Lower corner of the bounding box in the object's frame.
    pub lower: Vector,
    /// Upper corner.
    pub upper: Vector,
}

impl MassProperties {
    /// Those of the body moved so that its origin comes to `centre`.
    pub fn about(self, centre: &Vector) -> MassProperties {
        MassProperties {
            centre_of_mass: self.centre_of_mass + centre,
            lower: self.lower + centre,
            upper: self.upper + centre,
            ..self
        }
    }
}

/// A convex polyhedron, immutable once built, apart from its look-up table and its search for polygons.
///
/// The members that every query reads come first, together.
#[derive(Debug, Clone, PartialEq)]
#[repr(C, align(64))]
pub struct Polyhedron {
    /// Hull vertices. Those that only lie inside a merged face or edge (flat vertices) are kept for the support climb.
    pub vertices: Vec<Vertex>,
    /// Edges between merged faces.
    pub edges: Vec<Edge>,
    /// ρ: an upper bound of |position| over all vertices.
    pub radius: f64,
    /// Exact affine dimension: 3, or 2 (a two-sided polygon), 1 (a segment: no faces, one edge without any beside it), 0 (a point).
    pub dimension: u8,
    /// Whether it has faces, its centre is its origin, and its radius lies between [`SMALLEST`] and [`LARGEST`].
    pub simple: bool,
    /// Merged faces.
    pub faces: Vec<MergedFace>,
    /// The centre, subtracted exactly from the stored vertices.
    pub centre: Vector,
    /// Volume, centre of mass, radius, box.
    pub mass: MassProperties,
    /// The table that marching starts from when the last query tells nothing.
    pub lookup: Lookup,
    /// Blocks of vertices with more than eight neighbours.
    pub more_neighbours: Vec<NeighbourBlock>,
    /// The exact hull, triangulated, over `vertices`; counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The merged face of each triangle.
    pub face_of_triangle: Vec<u32>,
    /// Edge ids of the faces' sides, counter-clockwise.
    pub sides: Vec<u32>,
    /// Plane blocks of faces with more than three sides.
    pub more_sides: Vec<PlaneBlock>,
    /// Planes that halve sharp edges.
    pub bevels: Vec<Bevel>,
    /// The vertices inside merged faces, ascending, each with its face. A flat body has none.
    pub flat_vertices: Vec<[u32; 2]>,
    /// The caller's index of each vertex: the first one of exactly equal coordinates.
    pub vertex_labels: Vec<u32>,
    /// The caller's polygons merged into each face: face f owns `face_labels[face_label_starts[f]..face_label_starts[f+1]]`,
    /// ascending. For a hull of bare points a face's label is its own index.
    pub face_labels: Vec<u32>,
    /// See `face_labels`; one more entry than faces.
    pub face_label_starts: Vec<u32>,
    /// The corners of polygon `face_labels[k]`, centred, in the caller's order: `polygon_corners[s[k]..s[k + 1]]` with s =
    /// `polygon_starts`. Only kept where a face has several labels; otherwise, and without a mesh, empty.
    pub polygon_corners: Vec<Vector>,
    /// See `polygon_corners`; one more entry than `face_labels`, or empty without a mesh.
    pub polygon_starts: Vec<u32>,
    /// Finds the polygon that holds a point of a face of many.
    pub polygon_search: PolygonSearch,
    /// The vertices in fours, for a body of at most [`MOST_IN_BLOCKS`]: to look at all of them is faster than a climb. The last
    /// block repeats the last vertex.
    pub vertex_blocks: Vec<PointBlock>,
    /// The same in single precision, in eights, where that neither overflows nor underflows. The last block is filled with zeros,
    /// which is the centre.
    pub rough_blocks: Vec<[[f32; 8]; 3]>,
    /// For a body of few corners, the data that its depth in another is read from; see [`Fan`].
    pub fan: Option<Fan>,
    /// The corners of its faces, for what rests on it.
    pub outlines: Outlines,
    /// Faces as manifolds take them. Levels of detail have none.
    pub contact_faces: ContactFaces,
}

/// Radii of bodies whose vertices, and products of these with directions, are numbers of single precision: 2^±100.
const IN_SINGLE_PRECISION: RangeInclusive<f64> =
    f64::from_bits((1023 - 100) << 52)..=f64::from_bits((1023 + 100) << 52);

/// Most vertices of a body that has them in blocks.
pub const MOST_IN_BLOCKS: usize = 256;

impl Polyhedron {
    /// Puts the vertices into blocks, if they are not many.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn fill_vertex_blocks(&mut self) -> Result<()> {
        let few = if self.vertices.len() <= MOST_IN_BLOCKS { &self.vertices[..] } else { &[] };
        self.vertex_blocks = collected(few.chunks(4).map(|four| {
            let of = |axis: usize| std::array::from_fn(|i| four[i.min(four.len() - 1)].position[axis]);
            PointBlock { x: of(0), y: of(1), z: of(2) }
        }))?;
        let few = if IN_SINGLE_PRECISION.contains(&self.radius) { few } else { &[] };
        self.rough_blocks = collected(few.chunks(8).map(|eight| {
            [0, 1, 2]
                .map(|axis| std::array::from_fn(|i| eight.get(i).map_or(0.0, |vertex| vertex.position[axis] as f32)))
        }))?;
        Ok(())
    }

    /// A copy without the look-up table and the search for polygons.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn copy(&self) -> Result<Polyhedron> {
        Ok(Polyhedron {
            vertices: copied(&self.vertices)?,
            edges: copied(&self.edges)?,
            radius: self.radius,
            dimension: self.dimension,
            simple: self.simple,
            faces: copied(&self.faces)?,
            centre: self.centre,
            mass: self.mass,
            lookup: self.lookup.not_made(),
            more_neighbours: copied(&self.more_neighbours)?,
            triangles: copied(&self.triangles)?,
            face_of_triangle: copied(&self.face_of_triangle)?,
            sides: copied(&self.sides)?,
            more_sides: copied(&self.more_sides)?,
            bevels: copied(&self.bevels)?,
            flat_vertices: copied(&self.flat_vertices)?,
            vertex_labels: copied(&self.vertex_labels)?,
            face_labels: copied(&self.face_labels)?,
            face_label_starts: copied(&self.face_label_starts)?,
            polygon_corners: copied(&self.polygon_corners)?,
            polygon_starts: copied(&self.polygon_starts)?,
            polygon_search: PolygonSearch::new(),
            vertex_blocks: copied(&self.vertex_blocks)?,
            rough_blocks: copied(&self.rough_blocks)?,
            fan: self.fan.as_ref().map(Fan::copy).transpose()?,
            outlines: self.outlines.copy()?,
            contact_faces: self.contact_faces.copy()?,
        })
    }

    /// Moves the frame; the centred coordinates stay. The sums of centre and coordinates need not be doubles any more.
    pub fn move_frame(&mut self, by: &Vector) {
        self.centre += by;
        self.simple &= self.centre == Vector::zeros();
        self.mass.centre_of_mass += by;
        self.mass.lower += by;
        self.mass.upper += by;
    }

    /// The edge of a face's side; `side` is less than the face's `side_count`.
    #[inline(always)]
    pub fn side(&self, face: &MergedFace, side: u32) -> u32 {
        match face.first_sides.get(side as usize) {
            Some(&edge) => edge,
            None => self.sides[(face.first_side + side) as usize],
        }
    }

    /// The plane of a face's side, inside positive: its normal and offset; `side` is less than the face's `side_count`.
    #[inline(always)]
    pub fn side_plane(&self, face: &MergedFace, side: usize) -> [f64; 4] {
        let (block, lane) = match side {
            0..3 => (&face.planes, 1 + side),
            _ => (&self.more_sides[face.first_more as usize + (side - 3) / 4], (side - 3) % 4),
        };
        [block.x[lane], block.y[lane], block.z[lane], block.offset[lane]]
    }

    /// The vertex at which a face's side begins, counter-clockwise seen from outside; `side` is less than the face's `side_count`.
    pub fn corner(&self, face: u32, side: u32) -> u32 {
        let edge = &self.edges[self.side(&self.faces[face as usize], side) as usize];
        if edge.left() == face { edge.tail() } else { edge.head() }
    }

    /// A vertex in the object's frame, as the caller gave it (after the input transform).
    pub fn local_position(&self, vertex: u32) -> Vector {
        debug_assert!((vertex as usize) < self.vertices.len());
        self.centre + self.vertices[vertex as usize].position
    }

    /// The caller's polygons merged into a face, ascending; see `face_labels`.
    #[inline]
    pub fn labels_of_face(&self, face: u32) -> &[u32] {
        debug_assert!((face as usize) < self.faces.len());
        let face = face as usize;
        &self.face_labels[self.face_label_starts[face] as usize..self.face_label_starts[face + 1] as usize]
    }

    /// How many of the vertices are corners of merged faces, by Euler's formula; all without faces.
    pub fn corner_count(&self) -> usize {
        if self.faces.is_empty() { self.vertices.len() } else { 2 + self.edges.len() - self.faces.len() }
    }

    /// The edge that a flat vertex lies in, or a side of the face that it lies in. None for a corner.
    #[cold]
    pub fn edge_by_flat_vertex(&self, vertex: u32) -> Option<u32> {
        let [first, ..] = self.vertices[vertex as usize].neighbours.edge;
        match self.edges.get(first as usize) {
            Some(edge) => (edge.tail() != vertex && edge.head() != vertex).then_some(first),
            None => self.face_around(vertex).map(|face| self.faces[face as usize].first_sides[0]),
        }
    }

    /// The face that a vertex is inside of, if it is.
    pub fn face_around(&self, vertex: u32) -> Option<u32> {
        let found = self.flat_vertices.binary_search_by_key(&vertex, |[v, _]| *v).ok()?;
        Some(self.flat_vertices[found][1])
    }

    /// The neighbour blocks of a vertex: the first, then those with neighbours beyond eight.
    #[inline]
    pub fn neighbour_blocks(&self, vertex: u32) -> impl Iterator<Item = &NeighbourBlock> {
        let &Vertex { first_more, more, .. } = &self.vertices[vertex as usize];
        let further = &self.more_neighbours[first_more as usize..(first_more + more) as usize];
        std::iter::once(&self.vertices[vertex as usize].neighbours).chain(further)
    }

    /// The unit vector from a vertex to another, each component right to 4u of the vector.
    #[inline]
    pub fn direction_to(&self, vertex: u32, head: u32) -> Vector {
        let [from, to] = [vertex, head].map(|v| self.vertices[v as usize].position);
        let difference = to - from;
        // Between the ends of the range it overflows; halves of such numbers are exact.
        if difference.amax() <= f64::MAX { unit(&difference) } else { unit(&(to * 0.5 - from * 0.5)) }
    }

    /// Lanes in the neighbour blocks of a vertex: an upper bound of the number of its neighbours, by less than eight.
    #[inline]
    pub fn neighbour_capacity(&self, vertex: u32) -> usize {
        debug_assert!((vertex as usize) < self.vertices.len());
        8 * (1 + self.vertices[vertex as usize].more as usize)
    }

    /// A vertex that is farthest along `direction` as far as plain doubles tell, and the number of steps from `start`: hill
    /// climbing along the steepest edge of the triangulated hull until none leads up.
    pub fn support(&self, direction: &Vector, start: u32) -> (u32, u32) {
        debug_assert!((start as usize) < self.vertices.len());
        // A step is taken only if it certainly leads up, so no vertex comes twice.
        let largest = direction.amax();
        let direction = if largest > 0.0 { direction / largest } else { *direction };
        let rough = direction.map(|d| d as f32).into();
        let length = direction.x.abs() + direction.y.abs() + direction.z.abs();
        let clear = clear_slope(length);
        let (mut vertex, mut steps) = (start, 0);
        loop {
            let mut steepest = clear;
            let mut next = vertex;
            let mut is_any_open = false;
            for block in self.neighbour_blocks(vertex) {
                let slopes = block.slopes(rough);
                is_any_open |= !slopes.iter().all(|slope| *slope < -clear);
                if slopes.iter().any(|slope| *slope > steepest) {
                    for (slope, head) in slopes.into_iter().zip(block.head) {
                        if slope > steepest {
                            (steepest, next) = (slope, head);
                        }
                    }
                }
            }
            // A slope computed with a unit vector that is right to 4u per component is off by less than 8u·|direction|₁.
            if next == vertex
                && is_any_open
                && let Some(closely) = self.steepest_closely(vertex, &direction, length)
                && closely.slope > 8.0 * UNIT_ROUNDOFF * length
            {
                next = closely.head;
            }
            if next == vertex {
                return (vertex, steps);
            }
            vertex = next;
            steps += 1;
        }
    }

    /// The steepest neighbour of a vertex, in double precision, among those that are not [clearly](clear_slope) behind in a
    /// direction g of at most this length.
    #[cold]
    pub fn steepest_closely(&self, vertex: u32, g: &Vector, length: f64) -> Option<Steepest> {
        let (rough, clear) = (g.map(|d| d as f32).into(), clear_slope(length));
        let mut best: Option<Steepest> = None;
        for block in self.neighbour_blocks(vertex) {
            for (lane, slope) in block.slopes(rough).into_iter().enumerate() {
                if slope < -clear {
                    continue;
                }
                let (head, edge) = (block.head[lane], block.edge[lane]);
                let slope = self.direction_to(vertex, head).dot(g);
                // The first of equals, and any if one is a NaN.
                if best.is_none_or(|best| slope > best.slope) {
                    best = Some(Steepest { slope, edge, head });
                }
            }
        }
        best
    }

    /// The plane blocks of a face's sides beyond the third.
    #[inline(always)]
    pub fn further_sides(&self, face: &MergedFace) -> &[PlaneBlock] {
        if face.side_count <= 3 {
            return &[];
        }
        let count = (face.side_count as usize - 3).div_ceil(4);
        &self.more_sides[face.first_more as usize..face.first_more as usize + count]
    }

    /// Memory held, in bytes. All members are named, so that a new one cannot be forgotten.
    pub fn heap_bytes(&self) -> usize {
        let Polyhedron {
            dimension: _,
            simple: _,
            centre: _,
            radius: _,
            vertices,
            more_neighbours,
            triangles,
            edges,
            faces,
            sides,
            more_sides,
            bevels,
            flat_vertices,
            face_of_triangle,
            vertex_labels,
            face_labels,
            face_label_starts,
            polygon_corners,
            polygon_starts,
            polygon_search,
            vertex_blocks,
            rough_blocks,
            fan,
            outlines,
            contact_faces,
            mass: _,
            lookup,
        } = self;
        size_of_val(&vertices[..])
            + size_of_val(&more_neighbours[..])
            + size_of_val(&triangles[..])
            + size_of_val(&edges[..])
            + size_of_val(&faces[..])
            + size_of_val(&sides[..])
            + size_of_val(&more_sides[..])
            + size_of_val(&bevels[..])
            + size_of_val(&flat_vertices[..])
            + size_of_val(&face_of_triangle[..])
            + size_of_val(&vertex_labels[..])
            + size_of_val(&face_labels[..])
            + size_of_val(&face_label_starts[..])
            + size_of_val(&polygon_corners[..])
            + size_of_val(&polygon_starts[..])
            + polygon_search.heap_bytes()
            + size_of_val(&vertex_blocks[..])
            + size_of_val(&rough_blocks[..])
            + fan.as_ref().map_or(0, Fan::heap_bytes)
            + outlines.heap_bytes()
            + contact_faces.heap_bytes()
            + lookup.heap_bytes()
    }
}

/// A neighbour of a vertex and how far it lies in a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steepest {
    /// The product of the unit vector to it with the direction.
    pub slope: f64,
    /// The edge to it, or [`NONE`].
    pub edge: u32,
    /// The neighbour.
    pub head: u32,
}

/// A slope g·ê of a neighbour, computed in single precision, has the right sign if it is greater in magnitude than this;
/// `length` is at least |g|.
///
/// With u₁ = 2⁻²⁴ the components of ê and of g err by u₁ relatively, each, the product and its sums by at most 5u₁·|g||ê|: 7u₁|g|
/// in all, of 16u₁ that are allowed. A value that leaves the range of single precision is never clear: where g may, this is
/// infinite, and far above all that underflows.
#[inline(always)]
pub fn clear_slope(length: f64) -> f32 {
    // 2⁻²⁰ = 16u₁.
    const HALF_OF_ALLOWED: f32 = 1.0 / (1 << 21) as f32;
    const FAR_ABOVE_UNDERFLOW: f32 = f32::from_bits((127 - 100) << 23);
    (2.0 * length) as f32 * HALF_OF_ALLOWED + FAR_ABOVE_UNDERFLOW
}

impl NeighbourBlock {
    /// The products of the eight directions with another.
    #[inline]
    pub fn slopes(&self, [x, y, z]: [f32; 3]) -> [f32; 8] {
        std::array::from_fn(|lane| self.x[lane] * x + self.y[lane] * y + self.z[lane] * z)
    }
}
