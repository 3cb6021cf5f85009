//! A polytope around a body, cut smaller plane by plane, kept as its polar dual.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use robust::{Coord3D, orient3d};

use super::isotropy::spread_of;
use crate::base::double_double::narrow;
use crate::base::error::Result;
use crate::base::math::{Matrix, UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, listed, push, push_to_heap};
use crate::base::normal::area_vector;
use crate::base::progress::Progress;
use crate::body::build::assembly::build;
use crate::body::build::hull::convex_hull;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::triangulation::Triangulation;
use crate::shape::levels::containment::contains;
use crate::shape::levels::point_distance::{NearestPoint, PointDistance};

/// All planes lie so much farther out than those that touch the body, relative to its radius. A plane's normal and height, its
/// dual point and the corners computed from that each miss by a few u·ρ, at corners far out by some ten times as much.
const MARGIN: f64 = 256.0 * UNIT_ROUNDOFF;

/// Growing a level that rounding left too small all the same: so many times, each by four times as much as before.
const ATTEMPTS: i32 = 16;

/// No more cuts than so many times the requested planes.
const MOST_CUTS: f64 = 4.0;

/// A corner that stands off by less than this fraction of the body's radius is not cut any more: the rest is the body; 2⁻³⁰.
const LEAST_DEVIATION: f64 = f64::from_bits((1023 - 30) << 52);

/// A body to be cut out.
pub struct Block<'a> {
    base: &'a Polyhedron,
    distance: PointDistance<'a>,
    /// The body's centre of mass.
    centre: Vector,
    /// x = centre + spread·y.
    spread: Matrix,
    /// Its inverse.
    whitening: Matrix,
}

impl<'a> Block<'a> {
    /// `None` for a body without interior, or so little of it that rounding leaves none.
    pub fn new(base: &'a Polyhedron) -> Result<Option<Block<'a>>> {
        if base.dimension < 3 {
            return Ok(None);
        }
        let distance = PointDistance::new(base)?;
        let centre = base.mass.centre_of_mass;
        let spread = spread_of(base, &centre);
        let inverse = spread.and_then(|spread| spread.try_inverse());
        Ok(spread.zip(inverse).map(|(spread, whitening)| Block { base, distance, centre, spread, whitening }))
    }
}

/// A triangle of the dual hull: a vertex of the level.
#[derive(Clone, Copy)]
struct DualTriangle {
    /// The three planes that meet there, counter-clockwise from outside.
    planes: [u32; 3],
    /// `neighbours[i]` is across the edge from `planes[i]` to `planes[(i + 1) % 3]`.
    neighbours: [u32; 3],
    /// Its position.
    position: Vector,
    /// The nearest point of the body.
    nearest: Vector,
    /// A vertex of the body near it.
    vertex: u32,
    removed: bool,
}

/// A corner waiting to be cut: the bits of a deviation ≥ 0, which are ordered as the numbers are; among equal ones the oldest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct WaitingCut {
    deviation: u64,
    corner: Reverse<u32>,
}

/// A level under construction.
pub struct Cuts<'a> {
    block: &'a Block<'a>,
    /// The half-spaces q·y ≤ 1.
    dual: Vec<Vector>,
    corners: Vec<DualTriangle>,
    /// Corners that are not removed.
    corner_count: usize,
    queue: BinaryHeap<WaitingCut>,
    /// The new corner whose first plane is this one; valid while the corners of one cut are joined.
    new_corner_from: Vec<u32>,
}

impl<'a> Cuts<'a> {
    /// Begins with the half-spaces in some directions y that surround the origin. `None` where in doubles they surround nothing: a
    /// vertex may be 10¹⁷ times as far out as the others.
    pub fn new(block: &'a Block<'a>, directions: &[Vector]) -> Result<Option<Cuts<'a>>> {
        debug_assert!(directions.len() >= 4);
        let mut cuts = Cuts {
            block,
            dual: Vec::new(),
            corners: Vec::new(),
            corner_count: 0,
            queue: BinaryHeap::new(),
            new_corner_from: Vec::new(),
        };
        for direction in directions {
            cuts.add_half_space(block.whitening.tr_mul(direction).normalize(), 0)?;
        }
        // Some may be superfluous; they are left out.
        let hull = convex_hull(&cuts.dual)?;
        if hull.dimension < 3 {
            return Ok(None);
        }
        cuts.dual = collected(hull.vertices.iter().map(|&v| cuts.dual[v as usize]))?;
        let renumbered = |v: u32| hull.vertices.partition_point(|w| *w < v) as u32;
        let triangles: Vec<[u32; 3]> = collected(hull.triangles.iter().map(|t| t.map(renumbered)))?;
        let area = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| cuts.dual[i as usize]);
            (b - a).cross(&(c - a))
        };
        let areas: Vec<Vector> = collected(triangles.iter().map(area))?;
        let surface = Triangulation::new(triangles, &areas, cuts.dual.len())?;
        for (t, &planes) in (0..).zip(&surface.triangles) {
            let neighbours = [0, 1, 2].map(|k| surface.twins[3 * t + k] / 3);
            cuts.add_corner(planes, neighbours, 0)?;
        }
        Ok(Some(cuts))
    }

    /// Cuts until there are `count` planes; `false` if the body needs no more than there are.
    pub fn cut_to(&mut self, count: usize, progress: &mut Progress) -> Result<bool> {
        let start = self.dual.len();
        while self.plane_count() < count {
            // A cut may make planes superfluous; it seldom does.
            let fraction = self.dual.len() as f64 / count as f64;
            if fraction > MOST_CUTS || !self.cut()? {
                return Ok(false);
            }
            if self.dual.len().is_multiple_of(64) {
                let done = (self.dual.len() - start) as f64 / (count - start.min(count - 1)) as f64;
                progress.report(done.min(1.0))?;
            }
        }
        Ok(true)
    }

    /// An upper bound of how far a corner stands off, the rounding of corners apart.
    pub fn deviation(&mut self) -> f64 {
        while let Some(&WaitingCut { deviation, corner: Reverse(corner) }) = self.queue.peek() {
            if !self.corners[corner as usize].removed {
                return f64::from_bits(deviation);
            }
            self.queue.pop();
        }
        0.0
    }

    /// Planes that the level has. A triangulated sphere has half as many vertices as triangles, and two.
    pub fn plane_count(&self) -> usize {
        self.corner_count / 2 + 2
    }

    /// Adds the supporting half-space in a direction, the search for its vertex beginning at `start`: n·(x − centre) ≤ h is
    /// (spreadᵀ·n/h)·y ≤ 1.
    fn add_half_space(&mut self, normal: Vector, start: u32) -> Result<()> {
        let (vertex, _) = self.block.base.support(&normal, start);
        let height = normal.dot(&(self.block.base.vertices[vertex as usize].position - self.block.centre));
        push(&mut self.dual, self.block.spread.tr_mul(&normal) / (height + MARGIN * self.block.base.radius))?;
        push(&mut self.new_corner_from, 0)
    }

    /// The y with q·y = 1 for the three dual points q of a corner: along the normal of their triangle.
    fn place(&self, planes: [u32; 3]) -> Vector {
        let [a, b, c] = planes.map(|i| &self.dual[i as usize]);
        let normal = narrow(&area_vector(a, b, c));
        self.block.centre + self.block.spread * (normal / normal.dot(a))
    }

    fn add_corner(&mut self, planes: [u32; 3], neighbours: [u32; 3], hint: u32) -> Result<u32> {
        let position = self.place(planes);
        let index = self.corners.len() as u32;
        let NearestPoint { point: nearest, upper, vertex } = self.block.distance.nearest(&position, hint);
        push_to_heap(&mut self.queue, WaitingCut { deviation: upper.to_bits(), corner: Reverse(index) })?;
        push(&mut self.corners, DualTriangle { planes, neighbours, position, nearest, vertex, removed: false })?;
        self.corner_count += 1;
        Ok(index)
    }

    /// Cuts off the corner that stands off farthest; `false` if none does.
    fn cut(&mut self) -> Result<bool> {
        while self.deviation() > LEAST_DEVIATION * self.block.base.radius {
            let Some(WaitingCut { corner: Reverse(worst), .. }) = self.queue.pop() else {
                break;
            };
            let DualTriangle { position, nearest, vertex, .. } = self.corners[worst as usize];
            self.add_half_space((position - nearest).normalize(), vertex)?;
            let plane = self.dual.len() as u32 - 1;
            // Rounding may have the plane miss a corner that hardly stands off; then it stays.
            if self.cuts_off(plane, worst) {
                self.insert(plane, worst, vertex)?;
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Whether a corner lies strictly beyond a plane; in the dual, whether the point lies strictly above the triangle. Exact.
    fn cuts_off(&self, plane: u32, corner: u32) -> bool {
        let point = |i: u32| {
            let q = &self.dual[i as usize];
            Coord3D { x: q.x, y: q.y, z: q.z }
        };
        // `robust` is positive for a point below a counter-clockwise triangle.
        let [a, b, c] = self.corners[corner as usize].planes;
        orient3d(point(a), point(b), point(c), point(plane)) < 0.0
    }

    /// Replaces the corners that a plane cuts off, `first` being one, by those where it crosses the edges to the others.
    fn insert(&mut self, plane: u32, first: u32, hint: u32) -> Result<()> {
        debug_assert!(!self.corners[first as usize].removed);
        let mut cut_off = listed([first]);
        let mut crossed = Vec::new();
        self.corners[first as usize].removed = true;
        let mut done = 0;
        while let Some(&corner) = cut_off.get(done) {
            done += 1;
            let DualTriangle { planes, neighbours, .. } = self.corners[corner as usize];
            for side in 0..3 {
                let outer = neighbours[side];
                if self.corners[outer as usize].removed {
                    continue;
                }
                if self.cuts_off(plane, outer) {
                    self.corners[outer as usize].removed = true;
                    push(&mut cut_off, outer)?;
                } else {
                    push(&mut crossed, (planes[side], planes[(side + 1) % 3], outer))?;
                }
            }
        }
        self.corner_count -= cut_off.len();
        let first_new = self.corners.len() as u32;
        for &(tail, head, outer) in &crossed {
            let new = self.add_corner([tail, head, plane], [outer, 0, 0], hint)?;
            let outer = &mut self.corners[outer as usize];
            for side in 0..3 {
                if outer.planes[side] == head && outer.planes[(side + 1) % 3] == tail {
                    outer.neighbours[side] = new;
                }
            }
            self.new_corner_from[tail as usize] = new;
        }
        // The crossed edges are a simple cycle in the dual, so one new corner begins at each of its planes.
        for new in first_new..self.corners.len() as u32 {
            let following = self.new_corner_from[self.corners[new as usize].planes[1] as usize];
            self.corners[new as usize].neighbours[1] = following;
            self.corners[following as usize].neighbours[2] = new;
        }
        Ok(())
    }

    /// The level as it is now; `None` if no margin makes its rounded corners contain the body.
    pub fn level(&self) -> Result<Option<Polyhedron>> {
        let left = self.corners.iter().filter(|c| !c.removed);
        let corners: Vec<Vector> = collected(left.map(|c| c.position))?;
        let mut factor = 1.0;
        for attempt in 0..ATTEMPTS {
            let grown = |p: &Vector| self.block.centre + (p - self.block.centre) * factor;
            let points: Vec<Vector> = collected(corners.iter().map(grown))?;
            let level = build(&points, None)?;
            if level.centre == self.block.base.centre && contains(&level, self.block.base)? {
                return Ok(Some(level));
            }
            factor = 1.0 + MARGIN * 4.0_f64.powi(attempt + 1);
        }
        Ok(None)
    }
}
