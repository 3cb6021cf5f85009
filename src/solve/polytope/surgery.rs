//! The one way in which a polytope changes: a region of triangles gives way to the cone from a vertex over its horizon.

use super::Rounding;
use super::planes::evaluate;
use super::storage::{HalfEdge, HorizonEdge, NO_PLANE, NO_TRIANGLE, Polytope, half_edge, next, triangle_of};
use crate::base::math::Vector;
use crate::base::simd::{Lanes, Work};
use std::marker::PhantomData;

/// The requirements on new triangles.
#[derive(Debug, Clone, Copy)]
pub struct Demand {
    /// The point inside from which the polytope is looked at.
    pub centre: Vector,
    /// Whether they are to look away from the origin instead of from the centre.
    pub about_origin: bool,
    /// No plane may be nearer to the origin than this.
    pub least: f64,
    /// Whether the region may grow: the triangle behind a triangle that is not as demanded is taken in.
    pub grows: bool,
}

const IN_REGION: u8 = 1 << 7;

/// Triangles of a region beyond which surgery is given up.
const LARGEST_REGION: usize = 200;

/// Triangles of a region beyond which it does not grow for triangles that are not as demanded.
const LARGEST_GROWN: usize = 60;

impl<const V: usize, const T: usize> Polytope<V, T> {
    /// Begins a region.
    #[inline(always)]
    pub fn begin_region(&mut self) -> Region {
        self.marks[..self.triangle_count].fill(0);
        Region { size: 0 }
    }

    #[inline(always)]
    pub fn is_in_region(&self, triangle: usize) -> bool {
        self.marks[triangle] & IN_REGION != 0
    }

    /// Adds a triangle that is not in the region.
    #[inline(always)]
    pub fn add_to_region(&mut self, region: &mut Region, triangle: usize) {
        self.marks[triangle] |= IN_REGION;
        self.region[region.size] = triangle as u16;
        region.size += 1;
    }

    /// Finds a region from its first triangle on: the facets visible from a vertex, by more than rounding. Whether it stayed small.
    #[inline(always)]
    pub fn find_visible(&mut self, region: &mut Region, apex: u8, rounding: &Rounding) -> bool {
        let target = self.position(apex);
        let mut done = 0;
        while done < region.size {
            let triangle = usize::from(self.region[done]);
            done += 1;
            for k in 0..3 {
                let other = triangle_of(self.twin(half_edge(triangle, k)));
                if self.is_in_region(other) {
                    continue;
                }
                let corner = self.position(self.corners[other][0]);
                if self.normal(other).dot(&(target - corner)) > rounding.plane {
                    if region.size >= LARGEST_REGION {
                        return false;
                    }
                    self.add_to_region(region, other);
                }
            }
        }
        true
    }

    /// Walks the loops of edges around the region and lays out a new triangle on each.
    #[inline(always)]
    fn walk_horizon(&mut self, region: &Region, apex: u8, is_known: bool) -> Horizon {
        let (mut edges, mut triangles) = (0, 0);
        for place in 0..region.size {
            self.marks[usize::from(self.region[place])] &= IN_REGION;
        }
        for place in 0..region.size {
            for k in 0..3 {
                let begin = half_edge(usize::from(self.region[place]), k);
                if self.is_walked(begin) || self.is_in_region(triangle_of(self.twin(begin))) {
                    continue;
                }
                let (first_edge, mut at, mut apexes) = (edges, begin, 0);
                loop {
                    self.marks[triangle_of(at)] |= 1 << (at & 3);
                    let (tail, head, outer) = (self.tail(at), self.tail(next(at)), self.twin(at));
                    let mut triangle = NO_TRIANGLE;
                    apexes += u32::from(tail == apex);
                    if tail != apex && head != apex {
                        // A vertex of the polytope must not end up on both sides of an edge.
                        if is_known && self.corners_of(triangle_of(outer)).contains(&apex) {
                            return Horizon::Grow(triangle_of(outer));
                        }
                        let new = self.triangle_count + triangles;
                        if new >= Self::TRIANGLE_ROOM {
                            return Horizon::Refused;
                        }
                        self.corners[new] = [tail, head, apex, 0];
                        triangle = new as u16;
                        triangles += 1;
                    }
                    if edges == T {
                        return Horizon::Refused;
                    }
                    self.horizon[edges] = HorizonEdge { tail, head, ends_loop: false, outer, triangle };
                    edges += 1;
                    match self.following(at, region.size) {
                        Some(following) if following == begin => break,
                        Some(following) => at = following,
                        None => return Horizon::Refused,
                    }
                }
                // The apex once on a loop: twice, and the cone would be pinched.
                if edges - first_edge < 3 || apexes > 1 {
                    return Horizon::Refused;
                }
                self.horizon[edges - 1].ends_loop = true;
            }
        }
        if triangles == 0 { Horizon::Refused } else { Horizon::Closed { edges, triangles } }
    }

    fn is_walked(&self, at: HalfEdge) -> bool {
        self.marks[triangle_of(at)] >> (at & 3) & 1 != 0
    }

    /// The half-edge that follows on the horizon: turning around its head within the region, which has at most three half-edges a
    /// triangle there.
    #[inline(always)]
    fn following(&self, at: HalfEdge, region_size: usize) -> Option<HalfEdge> {
        let mut following = next(at);
        for _ in 0..=3 * region_size {
            let across = self.twin(following);
            if !self.is_in_region(triangle_of(across)) {
                return Some(following);
            }
            following = next(across);
        }
        None
    }

    /// Evaluates the new triangles.
    #[inline(always)]
    fn judge<L: Lanes>(&mut self, edges: usize, triangles: usize, rounding: &Rounding, demand: &Demand) -> Verdict {
        let count = self.triangle_count;
        let least = evaluate::<L, V, T>(self, rounding, &demand.centre, count, count + triangles);
        let side = if demand.about_origin { least.distance } else { least.height };
        if side > 0.0 && least.distance + rounding.plane > demand.least {
            return Verdict::AsDemanded;
        }
        for edge in self.horizon[..edges].iter().filter(|edge| edge.triangle != NO_TRIANGLE) {
            let triangle = usize::from(edge.triangle);
            let corner = self.position(self.corners[triangle][2]);
            let height = || self.normal(triangle).dot(&(corner - demand.centre));
            let side = if demand.about_origin { self.distances[triangle] } else { height() };
            if self.distances[triangle] == NO_PLANE || !(side > 0.0) {
                return Verdict::Grow(triangle_of(edge.outer));
            }
            if !(self.distances[triangle] + rounding.plane > demand.least) {
                break;
            }
        }
        Verdict::Refused
    }

    /// Joins the new triangles to each other and to the surroundings of the region, and fills its place from the end.
    #[inline(always)]
    fn link(&mut self, region: &Region, edges: usize, triangles: usize, apex: u8) {
        for place in 0..region.size {
            for corner in self.corners_of(usize::from(self.region[place])) {
                self.uses[usize::from(corner)] -= 1;
            }
        }
        let mut first = 0;
        while first < edges {
            let length =
                1 + self.horizon[first..edges].iter().position(|edge| edge.ends_loop).unwrap_or(edges - first - 1);
            for i in 0..length {
                let edge = self.horizon[first + i];
                if edge.triangle == NO_TRIANGLE {
                    continue;
                }
                for corner in [edge.tail, edge.head, apex] {
                    self.uses[usize::from(corner)] += 1;
                }
                let triangle = usize::from(edge.triangle);
                let after = self.horizon[first + if i + 1 == length { 0 } else { i + 1 }];
                let before = self.horizon[first + if i == 0 { length - 1 } else { i - 1 }];
                self.join(half_edge(triangle, 0), edge.outer);
                // An edge that ends at the apex is the side of the cone itself.
                let onward = if after.triangle == NO_TRIANGLE { after.outer } else { 4 * after.triangle + 2 };
                let backward = if before.triangle == NO_TRIANGLE { before.outer } else { 4 * before.triangle + 1 };
                self.join(half_edge(triangle, 1), onward);
                self.join(half_edge(triangle, 2), backward);
            }
            first += length;
        }
        let grown = self.triangle_count + triangles;
        self.marks[self.triangle_count..grown].fill(0);
        self.triangle_count = grown;
        for place in (0..region.size).rev() {
            self.fill_hole(place);
        }
    }

    /// Moves the last triangle that is not in the region to the place of the region's triangle; those after it are in it, and go.
    #[inline(always)]
    fn fill_hole(&mut self, place: usize) {
        while self.triangle_count > 0 && self.is_in_region(self.triangle_count - 1) {
            self.triangle_count -= 1;
        }
        let hole = usize::from(self.region[place]);
        if hole >= self.triangle_count {
            return;
        }
        let last = self.triangle_count - 1;
        self.triangle_count = last;
        self.corners[hole] = self.corners[last];
        self.distances[hole] = self.distances[last];
        self.certain[hole] = self.certain[last];
        for axis in &mut self.normals {
            axis[hole] = axis[last];
        }
        self.marks[hole] = 0;
        for k in 0..3 {
            let twin = self.twins[last][k];
            // If a triangle is its own neighbour, both half-edges move.
            let twin = if triangle_of(twin) == last { half_edge(hole, usize::from(twin & 3)) } else { twin };
            self.join(half_edge(hole, k), twin);
        }
    }
}

/// Puts the cone from a vertex over the region's horizon in the place of the region. Unless all new triangles are as demanded, the
/// answer is no, and only the vertex has been added.
#[inline(always)]
pub fn replace<L: Lanes, const V: usize, const T: usize>(
    polytope: &mut Polytope<V, T>,
    region: Region,
    apex: u8,
    rounding: &Rounding,
    demand: &Demand,
) -> bool {
    L::out_of_line(&mut Replacement { polytope, region, apex, rounding, demand, lanes: PhantomData::<L> })
}

/// Out of line, since it is much and asked for in two places.
struct Replacement<'a, L, const V: usize, const T: usize> {
    polytope: &'a mut Polytope<V, T>,
    region: Region,
    apex: u8,
    rounding: &'a Rounding,
    demand: &'a Demand,
    lanes: PhantomData<L>,
}

impl<L: Lanes, const V: usize, const T: usize> Work for Replacement<'_, L, V, T> {
    type Output = bool;

    #[inline(always)]
    fn run(&mut self) -> bool {
        let Replacement { polytope, region, apex, rounding, demand, .. } = self;
        let is_known = polytope.uses[usize::from(*apex)] > 0;
        loop {
            let verdict = match polytope.walk_horizon(region, *apex, is_known) {
                Horizon::Closed { edges, triangles } => match polytope.judge::<L>(edges, triangles, rounding, demand) {
                    Verdict::AsDemanded => {
                        polytope.link(region, edges, triangles, *apex);
                        return true;
                    }
                    // If the region has become large, growing on does not help.
                    Verdict::Grow(triangle) if region.size <= LARGEST_GROWN => Verdict::Grow(triangle),
                    Verdict::Grow(_) | Verdict::Refused => Verdict::Refused,
                },
                Horizon::Grow(triangle) => Verdict::Grow(triangle),
                Horizon::Refused => Verdict::Refused,
            };
            // The rest must be a surface, and the region must fit in its list.
            match verdict {
                Verdict::Grow(triangle)
                    if demand.grows && region.size + 4 < polytope.triangle_count && region.size < LARGEST_REGION =>
                {
                    polytope.add_to_region(region, triangle);
                }
                _ => return false,
            }
        }
    }
}

/// A set of triangles: the first `size` of [`Polytope::region`].
#[derive(Debug, Clone, Copy)]
pub struct Region {
    pub(super) size: usize,
}

/// The result of a walk around a region.
enum Horizon {
    /// The numbers of edges, and of new triangles on them.
    Closed { edges: usize, triangles: usize },
    /// A triangle that must be taken into the region.
    Grow(usize),
    /// No horizon for a cone.
    Refused,
}

/// The verdict on the new triangles.
enum Verdict {
    AsDemanded,
    /// With this triangle in the region they may be.
    Grow(usize),
    Refused,
}
