//! The gap of two placed bodies along a given direction, rounded down.

use super::bound::UNDERFLOW;
use crate::base::math::{STRETCH, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::fan::PointBlock;
use crate::body::tables;
use crate::distance::certificate::{by_all_vertices, interval, of_vertex, reciprocal_length};
use crate::distance::gjk::towards;
use crate::placed::Pair;
use crate::placed::frame::Frame;
use crate::placed::voronoi::climb;

/// Bodies along a direction.
pub(super) struct Along<'a> {
    pub pair: Pair<'a>,
    /// From body 2 to body 1, about of unit length.
    pub direction: &'a Vector,
    /// The starting points of the climbs to the support vertices, and their ends; `None`: the start from the look-up tables.
    pub vertices: &'a mut Option<[u32; 2]>,
}

impl Along<'_> {
    /// The lowest of body 1 over the highest of body 2, at most: per unit of the direction's length. −∞ where the magnitudes are
    /// beyond what doubles bound. Below 0 it may be too high by 8u of itself, which `least_between` allows for.
    pub fn gap(mut self) -> f64 {
        if self.pair.polyhedra.iter().all(|polyhedron| !polyhedron.vertex_blocks.is_empty()) {
            return simd::dispatch(&mut OverAll { pair: self.pair, direction: self.direction });
        }
        let gap = simd::dispatch(&mut self);
        if gap > f64::NEG_INFINITY { gap } else { self.gap_of_spheres() }
    }

    /// The same by bounding spheres, which need no frame: two points, over which balls may be swept, have none.
    ///
    /// Each centre in the world errs by 6u of its translation and of twice its local length, their difference by u, its product
    /// with the direction by 4u, and the direction's length by 4u: together less than 32u of all lengths, and of what underflows.
    fn gap_of_spheres(&self) -> f64 {
        let [body1, body2] = self.pair.polyhedra;
        let between = self.pair.poses[0].transform(&body1.centre) - self.pair.poses[1].transform(&body2.centre);
        let radii = (body1.radius + body2.radius) * STRETCH;
        let lengths = self.pair.poses.map(|pose| pose.translation().norm()).iter().sum::<f64>();
        let size = lengths + 2.0 * (body1.centre.norm() + body2.centre.norm()) + radii;
        let gap = self.direction.dot(&between) - radii - 64.0 * U * size - UNDERFLOW;
        // If lengths overflow, nothing is proved.
        if gap.is_finite() { gap } else { f64::NEG_INFINITY }
    }
}

impl Kernel for Along<'_> {
    type Output = f64;

    /// Climbing proposes vertices; what they prove holds whichever they are (`distance/certificate/`).
    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> f64 {
        let frame = Frame::<L>::new(&self.pair);
        if !frame.in_range {
            return f64::NEG_INFINITY;
        }
        let [towards1, towards2] = towards(&frame, self.direction);
        let [body1, body2] = self.pair.polyhedra;
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

/// The same over all vertices of bodies that have them in blocks: no tie and no convexity matters.
struct OverAll<'a> {
    pair: Pair<'a>,
    direction: &'a Vector,
}

impl Kernel for OverAll<'_> {
    type Output = f64;

    /// n·(T₁ − T₂) less the supports of both bodies along g = −R₁ᵀn and R₂ᵀn. Let s be |T₁ − T₂| and the sum of |c| + ρ.
    ///
    /// |n| is 1 up to 4u, ‖R‖ at most 1.015 and ‖|R|‖ 1.76, so |g| < 1.02. A component of g errs by 3u of its terms, g by 5.3u; its
    /// product with a centre or a vertex by 3.1u more: 8.4u(|c| + ρ). T₁ − T₂ errs by u, its product with n by 3.1u. A support is
    /// the sum of two products, the gap of three numbers: these four sums err by u of at most 1.02s each. The length of n changes
    /// the gap by 4u of as much. All together is below 17u·s, and s is right to 8u.
    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> f64 {
        let Self { pair: Pair { polyhedra, poses }, direction } = self;
        let apart = poses[0].translation() - poses[1].translation();
        let towards = [-poses[0].rotate_back(direction), poses[1].rotate_back(direction)];
        let (mut gap, mut size) = (direction.dot(&apart), apart.norm());
        for (polyhedron, g) in polyhedra.iter().zip(&towards) {
            gap -= Heights::<L>::new(g).farthest(polyhedron) + g.dot(&polyhedron.centre);
            size += polyhedron.centre.norm() + polyhedron.radius;
        }
        let lower = gap - 24.0 * U * size - UNDERFLOW;
        // A NaN or a number that overflowed proves nothing.
        if lower.is_finite() { lower } else { f64::NEG_INFINITY }
    }
}

/// Heights of vertices in blocks along a direction, over the centre.
pub(super) struct Heights<L>([L; 3]);

impl<L: Lanes> Heights<L> {
    #[inline(always)]
    pub fn new(direction: &Vector) -> Heights<L> {
        Heights([direction.x, direction.y, direction.z].map(L::splat))
    }

    #[inline(always)]
    pub fn of(&self, block: &PointBlock) -> L {
        let [x, y, z] = self.0;
        x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))))
    }

    /// The greatest, of a body that has blocks.
    #[inline(always)]
    pub fn farthest(&self, polyhedron: &Polyhedron) -> f64 {
        let mut farthest = [L::splat(f64::NEG_INFINITY); 2];
        // Two at a time: one waits for no other.
        let mut pairs = polyhedron.vertex_blocks.chunks_exact(2);
        for pair in &mut pairs {
            farthest = [farthest[0].max(self.of(&pair[0])), farthest[1].max(self.of(&pair[1]))];
        }
        for block in pairs.remainder() {
            farthest[0] = farthest[0].max(self.of(block));
        }
        -farthest[0].max(farthest[1]).negate().least().0
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
