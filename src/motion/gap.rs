//! The gap of two placed bodies along a given direction, rounded down.

use super::bound::UNDERFLOW;
use crate::base::math::{Pose, ROTATION_LIMIT, STRETCH, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::polyhedron::Polyhedron;
use crate::solve::certificate::{by_all_vertices, interval, of_vertex, reciprocal_length};
use crate::solve::frame::Frame;
use crate::solve::gjk::towards;
use crate::solve::voronoi::climb;
use crate::tables;

/// Bodies along a direction.
pub(super) struct Along<'a> {
    pub polyhedra: [&'a Polyhedron; 2],
    pub poses: [&'a Pose; 2],
    /// From body 2 to body 1, about of unit length.
    pub direction: &'a Vector,
    /// The starting points of the climbs to the support vertices, and their ends; `None`: the start from the look-up tables.
    pub vertices: &'a mut Option<[u32; 2]>,
}

impl Along<'_> {
    /// The lowest of body 1 over the highest of body 2, at most: per unit of the direction's length. −∞ where the magnitudes are
    /// beyond what doubles bound. Below 0 it may be too high by 8u of itself, which `least_between` allows for.
    pub fn gap(mut self) -> f64 {
        let gap = simd::dispatch(&mut self);
        if gap > f64::NEG_INFINITY { gap } else { self.gap_of_spheres() }
    }

    /// The same by bounding spheres, which need no frame: two points, over which balls may be swept, have none.
    ///
    /// Each centre in the world errs by 6u of its translation and of twice its local length, their difference by u, its product
    /// with the direction by 4u, and the direction's length by 4u: together less than 32u of all lengths, and of what underflows.
    fn gap_of_spheres(&self) -> f64 {
        let [body1, body2] = self.polyhedra;
        let between = self.poses[0].transform(&body1.centre) - self.poses[1].transform(&body2.centre);
        let radii = (body1.radius + body2.radius) * STRETCH;
        let lengths = self.poses.map(|pose| pose.translation().norm()).iter().sum::<f64>();
        let size = lengths + 2.0 * (body1.centre.norm() + body2.centre.norm()) + radii;
        let gap = self.direction.dot(&between) - radii - 64.0 * U * size - UNDERFLOW;
        // If lengths overflow, nothing is proved.
        if gap.is_finite() { gap } else { f64::NEG_INFINITY }
    }
}

impl Kernel for Along<'_> {
    type Output = f64;

    /// Climbing proposes vertices; what they prove holds whichever they are (`solve/certificate/`).
    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> f64 {
        let frame = Frame::<L>::new(self.polyhedra, self.poses, ROTATION_LIMIT);
        if !frame.in_range {
            return f64::NEG_INFINITY;
        }
        let [towards1, towards2] = towards(&frame, self.direction);
        let [body1, body2] = self.polyhedra;
        let look_up = |body, towards: Vector| tables::farthest(body, &towards).unwrap_or(0);
        let begin = match *self.vertices {
            Some(vertices) => vertices,
            None => [look_up(body1, towards1.to_vector()), look_up(body2, towards2.to_vector())],
        };
        let (vertex1, excess1) = support(body1, towards1, begin[0]);
        let (vertex2, excess2) = support(body2, towards2, begin[1]);
        let (vertices, excess) = ([vertex1, vertex2], excess1 + excess2);
        let [v, w] = vertices.map(|vertex| vertex as usize);
        let difference = frame.difference(&body1.vertices[v].position, &body2.vertices[w].position);
        let direction = L::from_vector(self.direction);
        let inverse = reciprocal_length(direction.dot(direction));
        let distance = difference.dot(difference).sqrt();
        let projection = direction.dot(difference) * inverse;
        let error = frame.difference_error(distance);
        *self.vertices = Some(vertices);
        let lower = interval(distance, projection, error, excess * inverse, 0.0).lower;
        // A NaN proves nothing.
        if lower > f64::NEG_INFINITY { lower } else { f64::NEG_INFINITY }
    }
}

/// A vertex of a body about farthest along a direction, and by how much the body reaches beyond it at most. On slivers a climb may
/// end below the farthest vertex, where edges prove next to nothing: then all vertices tell.
#[inline(always)]
fn support<L: Lanes>(body: &Polyhedron, towards: L, begin: u32) -> (u32, f64) {
    let direction = towards.to_vector();
    let vertex = climb(body, towards, begin);
    let excess = of_vertex(body, vertex, &direction);
    if excess <= 64.0 * U * body.radius * direction.lp_norm(1) { (vertex, excess) } else { of_all(body, &direction) }
}

#[cold]
fn of_all(body: &Polyhedron, direction: &Vector) -> (u32, f64) {
    let height = |vertex: u32| direction.dot(&body.vertices[vertex as usize].position);
    let farthest = (1..body.vertices.len() as u32).fold(0, |best, v| if height(v) > height(best) { v } else { best });
    (farthest, by_all_vertices(body, farthest, direction))
}
