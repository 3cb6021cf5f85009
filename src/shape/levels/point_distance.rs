//! Distance of a point from a polyhedron: a walk over its surface, and where that leads to the far side the pair machinery.
//!
//! The point found is a convex combination of vertices, so that its distance bounds that of the body from above, rounding
//! included, wherever the search ends.

use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF, Vector};
use crate::base::memory::listed;
use crate::body::build::assembly::build;
use crate::body::polyhedron::surface_walk::{Candidate, Surface, SurfaceFeature, nearest_of, on_segment};
use crate::body::polyhedron::{LARGEST, NONE, Polyhedron, SMALLEST};
use crate::distance::decide::{self, Decision, Wanted};
use crate::placed::Pair;

/// A polyhedron for which distances of points are queried. All values are in its centred coordinates.
#[derive(Debug, Clone)]
pub struct PointDistance<'a> {
    polyhedron: &'a Polyhedron,
    /// `None` for a segment or a point.
    surface: Option<Surface<'a>>,
    /// One vertex at the origin; its pose carries it to the point, exactly.
    probe: Polyhedron,
}

/// The point of a polyhedron nearest to a point outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// The nearest point of the polyhedron, as rounded.
    pub point: Vector,
    /// An upper bound of the distance, rounding included; too much by about 3e-15 of the radius.
    pub upper: f64,
    /// The corner nearest to the query point, among those of the vertex, edge or triangle that holds the nearest point.
    pub vertex: u32,
}

impl<'a> PointDistance<'a> {
    /// Prepares a polyhedron.
    ///
    /// # Errors
    /// [`Error::Bug`](crate::base::error::Error::Bug) if its triangles are no closed surface.
    pub fn new(polyhedron: &'a Polyhedron) -> Result<PointDistance<'a>> {
        let surface = if polyhedron.dimension >= 2 { Some(Surface::new(polyhedron)?) } else { None };
        Ok(PointDistance { polyhedron, surface, probe: build(&[Vector::zeros()], None)? })
    }

    /// The polyhedron.
    pub fn polyhedron(&self) -> &'a Polyhedron {
        self.polyhedron
    }

    /// The point of the polyhedron nearest to a `point`, which is itself, at distance 0, if it is inside. `hint` is a vertex
    /// from which to walk, best one near by.
    pub fn nearest(&self, point: &Vector, hint: u32) -> NearestPoint {
        debug_assert!((hint as usize) < self.polyhedron.vertices.len());
        let ends = [0, self.polyhedron.vertices.len() as u32 - 1];
        let Some(surface) = &self.surface else {
            return self.answer(point, &on_segment(self.polyhedron, point, ends, NONE), &ends);
        };
        let found = surface.nearest(point, hint);
        let corners = surface.corners(found.feature);
        let answer = self.answer(point, &found, &corners);
        match found.feature {
            SurfaceFeature::Triangle(t) if self.looks_away(t, point, answer.upper) => self.search(point, &corners),
            _ => answer,
        }
    }

    /// A convex combination of the vertices `corners` as the nearest point.
    fn answer(&self, point: &Vector, found: &Candidate, corners: &[u32]) -> NearestPoint {
        let upper = self.rounded_up(found.square.sqrt());
        NearestPoint { point: found.point, upper, vertex: nearest_of(self.polyhedron, point, corners) }
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
        let in_range = (SMALLEST..=LARGEST).contains(&self.polyhedron.radius) && point.amax() <= LARGEST;
        let hint = corners.map(|v| [0, v]);
        let pair = Pair { polyhedra: [&self.probe, self.polyhedron], poses: [&pose, &Pose::IDENTITY] };
        let wanted = Wanted { tight: true, max_distance: f64::INFINITY };
        let (pairs, found, upper) = match decide::decide(&pair, in_range, &hint, wanted).0 {
            Decision::Intersecting { pairs, .. } => (pairs, *point, 0.0),
            Decision::Separated { points, interval, pairs, .. } => (pairs, points[1], interval.upper),
        };
        let corners = listed(pairs.as_slice().iter().map(|pair| pair[1]));
        NearestPoint { point: found, upper, vertex: nearest_of(self.polyhedron, point, &corners) }
    }
}
