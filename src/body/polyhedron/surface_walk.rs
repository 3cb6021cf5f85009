//! A walk over the surface of a polyhedron to the point nearest to a point outside.
//!
//! Let the surface have no way down from p in distance to a point w. If p is on an edge or a vertex, the directions of the
//! edges and faces there span the whole cone in which the convex body lies, seen from p; all lead away from w to first order,
//! so no point of the body is nearer. If p is inside a face, it is nearest if w is on the outer side of that face. So it is
//! enough to go from vertex to nearer neighbour, then from triangle to nearer triangle across an edge or around a vertex. Only
//! inside a face that looks the other way it has gone wrong: that of a thin body seen from its other side, or of any body seen
//! from inside.

use crate::base::error::Result;
use crate::base::math::{Vector, clamp};
use crate::base::memory::{collected, copied};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::triangulation::{Triangulation, next};

/// The surface of a polyhedron with an area. All values are in its centred coordinates.
#[derive(Debug, Clone)]
pub struct Surface<'a> {
    polyhedron: &'a Polyhedron,
    triangulation: Triangulation,
}

/// A candidate for the nearest point.
#[derive(Debug, Clone, Copy)]
pub struct Candidate {
    /// Its position.
    pub point: Vector,
    /// The square of its distance.
    pub square: f64,
    /// The feature that holds it.
    pub feature: SurfaceFeature,
}

/// A feature that holds a point of the surface.
#[derive(Debug, Clone, Copy)]
pub enum SurfaceFeature {
    /// A vertex.
    Vertex(u32),
    /// A half-edge.
    Edge(u32),
    /// The inside of a triangle.
    Triangle(u32),
}

impl<'a> Surface<'a> {
    /// The surface of a polyhedron of two or three dimensions.
    ///
    /// # Errors
    /// [`Error::Bug`](crate::base::error::Error::Bug) if its triangles are no closed surface.
    pub fn new(polyhedron: &'a Polyhedron) -> Result<Surface<'a>> {
        let normal = |face: &u32| polyhedron.faces[*face as usize].normal;
        let normals: Vec<Vector> = collected(polyhedron.face_of_triangle.iter().map(normal))?;
        let triangulation = Triangulation::new(copied(&polyhedron.triangles)?, &normals, polyhedron.vertices.len())?;
        Ok(Surface { polyhedron, triangulation })
    }

    /// The vertices of a feature, one to three of them; the first is repeated.
    pub fn corners(&self, feature: SurfaceFeature) -> [u32; 3] {
        match feature {
            SurfaceFeature::Vertex(v) => [v; 3],
            SurfaceFeature::Edge(h) => {
                [self.triangulation.tail(h), self.triangulation.head(h), self.triangulation.tail(h)]
            }
            SurfaceFeature::Triangle(t) => self.triangulation.triangles[t as usize],
        }
    }

    /// Walks from a vertex, best one near by.
    ///
    /// Every step is to a feature that is strictly nearer as computed, and each triangle, edge and vertex has one nearest point as
    /// computed, so that none comes twice.
    pub fn nearest(&self, point: &Vector, hint: u32) -> Candidate {
        let surface = &self.triangulation;
        let mut best = at_vertex(self.polyhedron, point, hint);
        loop {
            let before = best.square;
            let SurfaceFeature::Vertex(vertex) = best.feature else { break };
            for &h in surface.around(vertex) {
                let neighbour = at_vertex(self.polyhedron, point, surface.head(h));
                if neighbour.square < best.square {
                    best = neighbour;
                }
            }
            if !(best.square < before) {
                break;
            }
        }
        loop {
            let Candidate { square: before, feature, .. } = best;
            let mut look = |triangle: u32| {
                let other = self.on_triangle(point, triangle);
                if other.square < best.square {
                    best = other;
                }
            };
            match feature {
                SurfaceFeature::Vertex(vertex) => surface.around(vertex).iter().for_each(|h| look(h / 3)),
                SurfaceFeature::Edge(h) => [h, surface.twins[h as usize]].iter().for_each(|h| look(h / 3)),
                SurfaceFeature::Triangle(_) => {}
            }
            if !(best.square < before) {
                return best;
            }
        }
    }

    /// The nearest point of a triangle: its projection or one of a side. All are tried: for a sliver the test whether the
    /// projection is inside is noise, but then its sides are as near.
    fn on_triangle(&self, point: &Vector, triangle: u32) -> Candidate {
        let surface = &self.triangulation;
        let corners = surface.triangles[triangle as usize];
        let mut best = self.inside_triangle(point, corners, triangle);
        for h in 3 * triangle..3 * triangle + 3 {
            let side = on_segment(self.polyhedron, point, [surface.tail(h), surface.tail(next(h))], h);
            if best.is_none_or(|best| side.square < best.square) {
                best = Some(side);
            }
        }
        best.unwrap_or_else(|| at_vertex(self.polyhedron, point, corners[0]))
    }

    /// The projection of the point on a triangle's plane, if it is inside.
    fn inside_triangle(&self, point: &Vector, corners: [u32; 3], triangle: u32) -> Option<Candidate> {
        let [a, b, c] = corners.map(|v| self.polyhedron.vertices[v as usize].position);
        let (along, aside, from) = (b - a, c - a, point - a);
        let normal = along.cross(&aside);
        let square = normal.norm_squared();
        let s = from.cross(&aside).dot(&normal) / square;
        let t = along.cross(&from).dot(&normal) / square;
        // Nor is it inside a triangle without area, where both are NaN.
        if !(s >= 0.0 && t >= 0.0 && s + t <= 1.0) {
            return None;
        }
        let place = a + along * s + aside * t;
        Some(Candidate {
            point: place,
            square: (place - point).norm_squared(),
            feature: SurfaceFeature::Triangle(triangle),
        })
    }
}

/// The vertex nearest to a point.
pub fn nearest_of(polyhedron: &Polyhedron, point: &Vector, vertices: &[u32]) -> u32 {
    debug_assert!(!vertices.is_empty());
    let square = |v: u32| (polyhedron.vertices[v as usize].position - point).norm_squared();
    vertices.iter().copied().min_by(|v, w| square(*v).total_cmp(&square(*w))).unwrap_or(0)
}

fn at_vertex(polyhedron: &Polyhedron, point: &Vector, vertex: u32) -> Candidate {
    debug_assert!((vertex as usize) < polyhedron.vertices.len());
    let position = polyhedron.vertices[vertex as usize].position;
    Candidate { point: position, square: (position - point).norm_squared(), feature: SurfaceFeature::Vertex(vertex) }
}

/// The nearest point of the segment between two vertices, named `half_edge` unless it is an end.
pub fn on_segment(polyhedron: &Polyhedron, point: &Vector, [tail, head]: [u32; 2], half_edge: u32) -> Candidate {
    let [start, end] = [tail, head].map(|v| polyhedron.vertices[v as usize].position);
    let along = end - start;
    // From the nearer end, so that an end is not missed by rounding. A NaN (no length) becomes 0.
    let (from_start, from_end) = (point - start, point - end);
    let square = along.norm_squared();
    let place = if from_start.norm_squared() <= from_end.norm_squared() {
        let t = clamp(from_start.dot(&along) / square, 0.0, 1.0);
        if t == 0.0 {
            return at_vertex(polyhedron, point, tail);
        }
        start + along * t
    } else {
        let t = clamp(-from_end.dot(&along) / square, 0.0, 1.0);
        if t == 0.0 {
            return at_vertex(polyhedron, point, head);
        }
        end - along * t
    };
    Candidate { point: place, square: (place - point).norm_squared(), feature: SurfaceFeature::Edge(half_edge) }
}
