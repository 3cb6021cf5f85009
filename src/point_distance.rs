//! How far a point lies from a polyhedron: a walk over its surface, and where that leads to the far side the pair machinery.
//!
//! Let the surface have no way down from p in distance to a point w. If p is on an edge or a vertex, the directions of the
//! edges and faces there span the whole cone in which the convex body lies, seen from p; all lead away from w to first order,
//! so no point of the body is nearer. If p is inside a face, it is nearest if w is on the outer side of that face. So it is
//! enough to go from vertex to nearer neighbour, then from triangle to nearer triangle across an edge or around a vertex. Only
//! inside a face that looks the other way it has gone wrong: that of a thin body seen from its other side, or of any body seen
//! from inside.
//!
//! What is found is a convex combination of vertices, so that its distance bounds that of the body from above, rounding included,
//! wherever the search ends.

use crate::error::Result;
use crate::math::{Pose, UNIT_ROUNDOFF, Vector, clamp};
use crate::overlap::{self, Decision, Wanted};
use crate::polyhedron::{LARGEST, NONE, Polyhedron, SMALLEST};
use crate::polyhedron_build::build;
use crate::triangulation::{Triangulation, next};

/// A polyhedron to which points are asked for their distance. All is said in its centred coordinates.
#[derive(Debug, Clone)]
pub struct PointDistance<'a> {
    polyhedron: &'a Polyhedron,
    /// `None` for a segment or a point.
    surface: Option<Triangulation>,
    /// One vertex at the origin; its pose carries it to the point, exactly.
    probe: Polyhedron,
}

/// What is nearest to a point outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// The nearest point of the polyhedron, as rounded.
    pub point: Vector,
    /// An upper bound of the distance, rounding included; too much by about 3e-15 of the radius.
    pub upper: f64,
    /// Of the corners of the vertex, edge or triangle that holds the nearest point, the one nearest to the asking point.
    pub vertex: u32,
}

/// A candidate for the nearest point.
#[derive(Clone, Copy)]
struct Candidate {
    point: Vector,
    /// Of its distance.
    square: f64,
    place: Place,
}

#[derive(Clone, Copy)]
enum Place {
    Vertex(u32),
    /// A half-edge.
    Edge(u32),
    Triangle(u32),
}

impl<'a> PointDistance<'a> {
    /// Prepares a polyhedron.
    ///
    /// # Errors
    /// [`Error::Bug`](crate::error::Error::Bug) if its triangles are no closed surface.
    pub fn new(polyhedron: &'a Polyhedron) -> Result<PointDistance<'a>> {
        let surface = if polyhedron.dimension >= 2 {
            let normal = |face: &u32| polyhedron.faces[*face as usize].normal;
            let normals: Vec<Vector> = polyhedron.face_of_triangle.iter().map(normal).collect();
            Some(Triangulation::new(polyhedron.triangles.clone(), &normals, polyhedron.vertices.len())?)
        } else {
            None
        };
        Ok(PointDistance { polyhedron, surface, probe: build(&[Vector::zeros()], None)? })
    }

    /// The polyhedron.
    pub fn polyhedron(&self) -> &'a Polyhedron {
        self.polyhedron
    }

    /// The point of the polyhedron nearest to a `point`, which is itself, at distance 0, if it is inside. `hint` is a vertex
    /// from which to walk, best one near by.
    pub fn nearest(&self, point: &Vector, hint: u32) -> NearestPoint {
        let ends = [0, self.polyhedron.vertices.len() as u32 - 1];
        let Some(surface) = &self.surface else {
            let found = self.on_segment(point, ends, NONE);
            return self.answer(point, &found, &ends);
        };
        let found = self.walk(surface, point, hint);
        match found.place {
            Place::Vertex(v) => self.answer(point, &found, &[v]),
            Place::Edge(h) => self.answer(point, &found, &[surface.tail(h), surface.head(h)]),
            Place::Triangle(t) => {
                let corners = surface.triangles[t as usize];
                let answer = self.answer(point, &found, &corners);
                if self.looks_away(t, point, answer.upper) { self.search(point, &corners) } else { answer }
            }
        }
    }

    /// A convex combination of the vertices `corners` as the nearest point.
    fn answer(&self, point: &Vector, found: &Candidate, corners: &[u32]) -> NearestPoint {
        let upper = self.rounded_up(found.square.sqrt());
        NearestPoint { point: found.point, upper, vertex: self.nearest_of(point, corners) }
    }

    /// The vertex nearest to a point.
    fn nearest_of(&self, point: &Vector, vertices: &[u32]) -> u32 {
        let square = |v: u32| (self.position(v) - point).norm_squared();
        vertices.iter().copied().min_by(|v, w| square(*v).total_cmp(&square(*w))).unwrap_or(0)
    }

    /// A combination a + s·e + t·f of points within ρ, with |e|, |f| ≤ 2ρ, errs by u each for e and f, for the products and the
    /// two sums, and its weights sum to 1 + 2u at most: together less than 16uρ. The difference from the point and the norm err
    /// by 4u of themselves.
    fn rounded_up(&self, distance: f64) -> f64 {
        let rounding = 16.0 * UNIT_ROUNDOFF * self.polyhedron.radius;
        (distance * (1.0 + 8.0 * UNIT_ROUNDOFF) + rounding) * (1.0 + 4.0 * UNIT_ROUNDOFF)
    }

    /// Whether a point with its projection inside a triangle is on the body's side of it. At a `distance` of rounding it does
    /// not matter, and a flat body looks both ways.
    fn looks_away(&self, triangle: u32, point: &Vector, distance: f64) -> bool {
        let face = &self.polyhedron.faces[self.polyhedron.face_of_triangle[triangle as usize] as usize];
        self.polyhedron.dimension == 3
            && distance > 64.0 * UNIT_ROUNDOFF * self.polyhedron.radius
            && face.planes.value(0, point) < 0.0
    }

    /// By the pair machinery, from three vertices.
    #[cold]
    fn search(&self, point: &Vector, corners: &[u32; 3]) -> NearestPoint {
        let mut pose = Pose::IDENTITY;
        for (row, x) in pose.rows.iter_mut().zip(point) {
            row[3] = *x;
        }
        // Beyond these magnitudes the decision is left to integers.
        let usual = (SMALLEST..=LARGEST).contains(&self.polyhedron.radius) && point.amax() <= LARGEST;
        let hint = corners.map(|v| [0, v]);
        let poses = [&pose, &Pose::IDENTITY];
        let wanted = Wanted { tight: true, distance_tolerance: f64::INFINITY };
        let (pairs, found, upper) = match overlap::decide([&self.probe, self.polyhedron], poses, usual, &hint, wanted).0
        {
            Decision::Intersecting { pairs, .. } => (pairs, *point, 0.0),
            Decision::Separated { points, interval, pairs, .. } => (pairs, points[1], interval.upper),
        };
        let corners: Vec<u32> = pairs.as_slice().iter().map(|pair| pair[1]).collect();
        NearestPoint { point: found, upper, vertex: self.nearest_of(point, &corners) }
    }

    fn position(&self, vertex: u32) -> Vector {
        self.polyhedron.vertices[vertex as usize].position
    }

    /// Every step is to a place that is strictly nearer as computed, and each triangle, edge and vertex has one nearest point as
    /// computed, so that none comes twice.
    fn walk(&self, surface: &Triangulation, point: &Vector, hint: u32) -> Candidate {
        let mut best = self.at_vertex(point, hint);
        loop {
            let before = best.square;
            let Place::Vertex(vertex) = best.place else { break };
            for &h in surface.around(vertex) {
                let neighbour = self.at_vertex(point, surface.head(h));
                if neighbour.square < best.square {
                    best = neighbour;
                }
            }
            if !(best.square < before) {
                break;
            }
        }
        loop {
            let Candidate { square: before, place, .. } = best;
            let mut look = |triangle: u32| {
                let other = self.on_triangle(surface, point, triangle);
                if other.square < best.square {
                    best = other;
                }
            };
            match place {
                Place::Vertex(vertex) => surface.around(vertex).iter().for_each(|h| look(h / 3)),
                Place::Edge(h) => [h, surface.twins[h as usize]].iter().for_each(|h| look(h / 3)),
                Place::Triangle(_) => {}
            }
            if !(best.square < before) {
                return best;
            }
        }
    }

    fn at_vertex(&self, point: &Vector, vertex: u32) -> Candidate {
        let position = self.position(vertex);
        Candidate { point: position, square: (position - point).norm_squared(), place: Place::Vertex(vertex) }
    }

    /// The nearest point of the segment between two vertices, named `half_edge` unless it is an end.
    fn on_segment(&self, point: &Vector, [tail, head]: [u32; 2], half_edge: u32) -> Candidate {
        let (start, end) = (self.position(tail), self.position(head));
        let along = end - start;
        // From the nearer end, so that an end is not missed by rounding. A NaN (no length) becomes 0.
        let (from_start, from_end) = (point - start, point - end);
        let square = along.norm_squared();
        let place = if from_start.norm_squared() <= from_end.norm_squared() {
            let t = clamp(from_start.dot(&along) / square, 0.0, 1.0);
            if t == 0.0 {
                return self.at_vertex(point, tail);
            }
            start + along * t
        } else {
            let t = clamp(-from_end.dot(&along) / square, 0.0, 1.0);
            if t == 0.0 {
                return self.at_vertex(point, head);
            }
            end - along * t
        };
        Candidate { point: place, square: (place - point).norm_squared(), place: Place::Edge(half_edge) }
    }

    /// The nearest point of a triangle: its projection or one of a side. All are tried: for a sliver the test whether the
    /// projection is inside is noise, but then its sides are as near.
    fn on_triangle(&self, surface: &Triangulation, point: &Vector, triangle: u32) -> Candidate {
        let corners = surface.triangles[triangle as usize];
        let mut best = self.inside_triangle(point, corners, triangle);
        for h in 3 * triangle..3 * triangle + 3 {
            let side = self.on_segment(point, [surface.tail(h), surface.tail(next(h))], h);
            if best.is_none_or(|best| side.square < best.square) {
                best = Some(side);
            }
        }
        best.unwrap_or_else(|| self.at_vertex(point, corners[0]))
    }

    /// The projection of the point on a triangle's plane, if it is inside.
    fn inside_triangle(&self, point: &Vector, corners: [u32; 3], triangle: u32) -> Option<Candidate> {
        let [a, b, c] = corners.map(|v| self.position(v));
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
        Some(Candidate { point: place, square: (place - point).norm_squared(), place: Place::Triangle(triangle) })
    }
}
