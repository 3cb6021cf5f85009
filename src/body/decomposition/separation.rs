//! Planes and lines between the hull of a patch and another part of the surface.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, with_capacity};
use crate::body::build::hull::convex_hull;
use crate::body::decomposition::surface::{CutPlane, MeshSurface};

/// A plane with a hull below or on it, not all on it, and a triangle above or on it. So the triangle has no point of the hull's
/// inside, relative to the plane of a flat hull (R. T. Rockafellar, "Convex Analysis", 1970, theorem 20.2).
#[derive(Debug, Clone, Copy)]
pub struct Separation {
    plane: CutPlane,
    /// 1, or −1 where above and below are exchanged.
    sign: f64,
}

impl Separation {
    /// Whether the hull may grow by this vertex.
    pub fn is_kept_by(&self, surface: &MeshSurface, vertex: u32) -> bool {
        self.sign * surface.side(&self.plane, vertex) <= 0.0
    }

    /// A plane, if it separates.
    fn by(surface: &MeshSurface, plane: CutPlane, hull: &[u32], triangle: [u32; 3]) -> Option<Separation> {
        let sides = triangle.map(|v| surface.side(&plane, v));
        [1.0, -1.0].into_iter().find_map(|sign| {
            let mut is_below = false;
            let holds = sides.iter().all(|side| sign * side >= 0.0)
                && hull.iter().all(|v| {
                    let side = sign * surface.side(&plane, *v);
                    is_below |= side < 0.0;
                    side <= 0.0
                });
            (holds && is_below).then_some(Separation { plane, sign })
        })
    }
}

/// The hull of a patch.
pub struct HullOfPatch {
    triangles: Vec<[u32; 3]>,
    is_solid: bool,
}

impl HullOfPatch {
    /// The hull of some vertices; it only proposes planes, so that their rounded positions are good enough.
    pub fn new(surface: &MeshSurface, vertices: &[u32]) -> Result<HullOfPatch> {
        let positions: Vec<Vector> = collected(vertices.iter().map(|v| surface.position[*v as usize]))?;
        let hull = convex_hull(&positions)?;
        let mut triangles = with_capacity(hull.triangles.len())?;
        triangles.extend(hull.triangles.iter().map(|corners| corners.map(|i| vertices[i as usize])));
        Ok(HullOfPatch { triangles, is_solid: hull.dimension == 3 })
    }

    /// A plane between it and a triangle. If one separates two polytopes then one does that touches them in three points that span
    /// it: it is the plane of a face of either, or of an edge of one and a vertex of the other.
    pub fn separation(&self, surface: &MeshSurface, vertices: &[u32], triangle: [u32; 3]) -> Option<Separation> {
        let by = |corners: [u32; 3]| Separation::by(surface, surface.plane(corners), vertices, triangle);
        let is_inside = |v: u32| self.triangles.iter().all(|corners| surface.side(&surface.plane(*corners), v) < 0.0);
        if self.is_solid && triangle.into_iter().any(is_inside) {
            return None;
        }
        let edges_of = |corners: &[u32; 3]| [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
        // Each edge of the hull is in two of its triangles, once in each direction.
        let edges = || self.triangles.iter().flat_map(edges_of).filter(|[tail, head]| tail < head);
        let faces = self.triangles.iter().copied();
        let at_edges = edges().flat_map(|[tail, head]| triangle.map(|v| [tail, head, v]));
        let at_vertices =
            edges_of(&triangle).into_iter().flat_map(|[tail, head]| vertices.iter().map(move |v| [tail, head, *v]));
        faces.chain(at_edges).chain(at_vertices).find_map(by)
    }
}

/// A quickly found plane between a patch and a triangle: that of the triangle, or of one of the patch.
pub fn near_separation(
    surface: &MeshSurface,
    planes: &[CutPlane],
    vertices: &[u32],
    triangle: [u32; 3],
) -> Option<Separation> {
    let own = Separation::by(surface, surface.plane(triangle), vertices, triangle);
    own.or_else(|| {
        // Nothing of the patch is above them.
        let is_above = |plane: &&CutPlane| triangle.iter().all(|v| surface.side(plane, *v) >= 0.0);
        planes.iter().filter(is_above).find_map(|plane| Separation::by(surface, *plane, vertices, triangle))
    })
}

/// A directed line in the plane of a flat patch: the patch is on its left or on it, not all of it on it, and a segment on its right
/// or on it.
#[derive(Debug, Clone, Copy)]
pub struct SeparatingLine {
    ends: [u32; 2],
    normal: Vector,
}

impl SeparatingLine {
    /// Between a flat patch and a segment in its plane: the segment's own line, or that of an edge of the patch.
    pub fn between(
        surface: &MeshSurface,
        normal: Vector,
        vertices: &[u32],
        triangles: &[u32],
        segment: [u32; 2],
    ) -> Option<SeparatingLine> {
        let [p, q] = segment;
        let edges = triangles.iter().flat_map(|t| {
            let corners = surface.triangles[*t as usize];
            [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]])
        });
        [[p, q], [q, p]].into_iter().chain(edges).map(|ends| SeparatingLine { ends, normal }).find(|line| {
            let on_the_right = segment.iter().all(|v| line.left_of(surface, *v) <= 0.0);
            on_the_right
                && vertices.iter().all(|v| line.is_kept_by(surface, *v))
                && vertices.iter().any(|v| line.left_of(surface, *v) > 0.0)
        })
    }

    /// Whether the patch may grow by this vertex.
    pub fn is_kept_by(&self, surface: &MeshSurface, vertex: u32) -> bool {
        self.left_of(surface, vertex) >= 0.0
    }

    /// Positive on the left, seen against the normal; exact where there is no margin.
    fn left_of(&self, surface: &MeshSurface, vertex: u32) -> f64 {
        let axis = self.normal.iamax();
        let [tail, head] = self.ends;
        let turn = surface.points.projected_orientation(axis, [tail, head, vertex]) * self.normal[axis].signum();
        let [from, to, at] = [tail, head, vertex].map(|v| surface.position[v as usize]);
        let along = to - from;
        // The distance from the line.
        if along.cross(&(at - from)).norm() <= surface.margin() * along.norm() { 0.0 } else { turn }
    }
}
