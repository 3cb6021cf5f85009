//! The surface while vertices are removed from it: the hull of those that are left.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, filled, push, with_capacity};
use crate::base::normal::{area_vector, normal_of};
use crate::base::predicates::ExactPoints;
use crate::body::polyhedron::triangulation::Triangulation;
use crate::body::polyhedron::{NONE, Polyhedron};

/// The levels of a body, one after the other.
pub struct DobkinKirkpatrick<'a> {
    pub(super) base: &'a Polyhedron,
    pub(super) exact: ExactPoints,
    /// The body's vertices as seen from its centre of mass.
    pub(super) rays: Vec<Vector>,
    /// Free ones, to be reused, only while vertices are removed.
    pub(super) triangles: Vec<SurfaceTriangle>,
    pub(super) free: Vec<u32>,
    /// For each vertex that is left one of its triangles; NONE for the others.
    pub(super) triangle_at: Vec<u32>,
    /// For each removed vertex the next one in the same region, or NONE.
    pub(super) next_in_region: Vec<u32>,
    pub(super) triangle_count: usize,
    /// The vertices that are left, ascending.
    pub(super) left: Vec<u32>,
}

/// A triangle of the hull of the vertices that are left.
pub(super) struct SurfaceTriangle {
    /// Counter-clockwise from outside; vertices of the body.
    pub(super) corners: [u32; 3],
    /// `neighbours[k]` is across the edge from `corners[k]` to `corners[(k + 1) % 3]`.
    pub(super) neighbours: [u32; 3],
    /// Unit outward normal.
    pub(super) normal: Vector,
    /// The first of the removed vertices of the body in this triangle's centre-of-mass region, or NONE; then
    /// [`DobkinKirkpatrick::next_in_region`].
    pub(super) region: u32,
    pub(super) is_free: bool,
}

impl<'a> DobkinKirkpatrick<'a> {
    /// Begins with a body of dimension 3.
    ///
    /// # Errors
    /// [`Error::Bug`](crate::base::error::Error::Bug) if its triangles are no closed surface,
    /// [`crate::base::error::Error::Memory`].
    pub fn new(base: &'a Polyhedron) -> Result<DobkinKirkpatrick<'a>> {
        debug_assert_eq!(base.dimension, 3);
        let positions: Vec<Vector> = collected(base.vertices.iter().map(|v| v.position))?;
        let centre = base.mass.centre_of_mass - base.centre;
        let normal_of = |corners: &[u32; 3]| normal(&positions, *corners);
        let normals: Vec<Vector> = collected(base.triangles.iter().map(normal_of))?;
        let surface = Triangulation::new(copied(&base.triangles)?, &normals, positions.len())?;
        let mut triangle_at = filled(NONE, positions.len())?;
        let mut triangles = with_capacity(base.triangles.len())?;
        for (t, (&corners, &normal)) in base.triangles.iter().zip(&normals).enumerate() {
            let neighbours = [0, 1, 2].map(|k| surface.twins[3 * t + k] / 3);
            triangles.push(SurfaceTriangle { corners, neighbours, normal, region: NONE, is_free: false });
            for v in corners {
                triangle_at[v as usize] = t as u32;
            }
        }
        Ok(DobkinKirkpatrick {
            base,
            exact: ExactPoints::new(&positions)?,
            rays: collected(positions.iter().map(|p| p - centre))?,
            triangle_count: triangles.len(),
            left: collected(0..positions.len() as u32)?,
            triangles,
            free: Vec::new(),
            triangle_at,
            next_in_region: filled(NONE, positions.len())?,
        })
    }

    /// Triangles that are left.
    pub fn triangle_count(&self) -> usize {
        self.triangle_count
    }

    /// The triangles around a vertex, counter-clockwise.
    pub(super) fn star(&self, v: u32, star: &mut Vec<u32>) -> Result<()> {
        debug_assert!(self.triangle_at[v as usize] != NONE);
        star.clear();
        let first = self.triangle_at[v as usize];
        let mut t = first;
        loop {
            push(star, t)?;
            let triangle = &self.triangles[t as usize];
            t = triangle.neighbours[(place_of(triangle, v) + 2) % 3];
            if t == first {
                break;
            }
        }
        Ok(())
    }

    /// The removed vertices in a region, from its first.
    pub(super) fn region(&self, first: u32) -> impl Iterator<Item = u32> {
        let some = |q: u32| (q != NONE).then_some(q);
        std::iter::successors(some(first), move |q| some(self.next_in_region[*q as usize]))
    }

    /// How far the plane of a triangle is from the centre of mass.
    pub(super) fn height(&self, t: u32) -> f64 {
        let triangle = &self.triangles[t as usize];
        triangle.normal.dot(&self.rays[triangle.corners[0] as usize])
    }

    /// The corner of a triangle after a vertex.
    pub(super) fn following(&self, t: u32, v: u32) -> u32 {
        let triangle = &self.triangles[t as usize];
        triangle.corners[(place_of(triangle, v) + 1) % 3]
    }

    /// The corner of a triangle opposite to its edge that begins at `from`.
    pub(super) fn opposite(&self, t: u32, from: u32) -> u32 {
        let triangle = &self.triangles[t as usize];
        triangle.corners[(place_of(triangle, from) + 2) % 3]
    }
}

/// The corner of a triangle that a vertex is.
pub(super) fn place_of(triangle: &SurfaceTriangle, v: u32) -> usize {
    debug_assert!(triangle.corners.contains(&v));
    triangle.corners.iter().position(|w| *w == v).unwrap_or(0)
}

/// The unit normal of a triangle.
pub(super) fn normal(positions: &[Vector], corners: [u32; 3]) -> Vector {
    let [a, b, c] = corners.map(|v| positions[v as usize]);
    normal_of(&area_vector(&a, &b, &c), &a, &b, &c)
}
