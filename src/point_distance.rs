//! How far a point lies from a polyhedron, for sure: the pair machinery with a one-vertex body.

use crate::error::Result;
use crate::math::{Pose, Vector};
use crate::overlap::{self, Decision, Pairs};
use crate::polyhedron::Polyhedron;
use crate::polyhedron_build::build;

/// A polyhedron to which points are asked for their distance.
#[derive(Debug, Clone)]
pub struct PointDistance<'a> {
    polyhedron: &'a Polyhedron,
    /// One vertex at the origin; its pose carries it to the point, exactly.
    probe: Polyhedron,
}

/// What is nearest to a point outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestPoint {
    /// The nearest point of the polyhedron, as rounded.
    pub point: Vector,
    /// A lower bound of the distance, rounding included; positive unless the distance is below the smallest double.
    pub lower: f64,
    /// An upper bound of the distance, rounding included.
    pub upper: f64,
    /// Of the vertices whose convex combination the nearest point is, the one nearest to the asking point.
    pub vertex: u32,
}

impl<'a> PointDistance<'a> {
    /// For a polyhedron whose `centre` is 0: all is said in its centred coordinates.
    ///
    /// # Errors
    /// None that a caller can cause.
    pub fn new(polyhedron: &'a Polyhedron) -> Result<PointDistance<'a>> {
        debug_assert!(polyhedron.centre == Vector::zeros());
        Ok(PointDistance { polyhedron, probe: build(&[Vector::zeros()], None)? })
    }

    /// The polyhedron.
    pub fn polyhedron(&self) -> &'a Polyhedron {
        self.polyhedron
    }

    /// The point of the polyhedron nearest to `point`; `None` if the point lies in it or on its surface, which is decided
    /// exactly. `hint` is a vertex from which to search, best one near by.
    pub fn nearest(&self, point: &Vector, hint: u32) -> Option<NearestPoint> {
        let mut pose = Pose::IDENTITY;
        for (row, x) in pose.rows.iter_mut().zip(point) {
            row[3] = *x;
        }
        // Beyond these magnitudes the decision is left to integers.
        const LARGEST: f64 = f64::from_bits((1023 + 200) << 52);
        let usual = (1.0 / LARGEST..=LARGEST).contains(&self.polyhedron.radius) && point.amax() <= LARGEST;
        let bodies = [&self.probe, self.polyhedron];
        match overlap::decide(bodies, [&pose, &Pose::IDENTITY], usual, &[[0, hint]], true).0 {
            Decision::Intersecting { .. } => None,
            Decision::Separated { points, interval, pairs, .. } => Some(NearestPoint {
                point: points[1],
                lower: interval.lower,
                upper: interval.upper,
                vertex: self.nearest_of(point, pairs),
            }),
        }
    }

    /// The vertex of the pairs that is nearest to a point.
    fn nearest_of(&self, point: &Vector, pairs: Pairs) -> u32 {
        let distance = |v: u32| (self.polyhedron.vertices[v as usize].position - point).norm_squared();
        let nearest = pairs.as_slice().iter().map(|pair| pair[1]).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        nearest.unwrap_or(0)
    }
}
