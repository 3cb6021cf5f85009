//! The exact convex hull of points that span space. This is Quickhull (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, "The Quickhull
//! Algorithm for Convex Hulls", ACM Transactions on Mathematical Software 22, 1996) with exact
//! predicates instead of thick facets. A point *sees* a facet when it lies strictly above the
//! facet's plane. Why that is enough, degenerate input included:
//!
//! - Let p be outside the current hull H and p' be p moved by an infinitesimal amount towards an
//!   interior point of H. A plane of H that holds p has p' strictly below it, a plane strictly
//!   below p still is. So the facets that p sees strictly are those that the generic p' sees, and
//!   these form a disk whose boundary, the horizon, is a simple cycle.
//! - Each new triangle (horizon edge, p) has area: p strictly sees the facet on one side of that
//!   edge, so p is not in the plane of that facet, hence not on the line of the edge.
//! - The facet on the other side of the horizon edge is not strictly above p; the new facet's
//!   normal is a combination, with weights ≥ 0, of the normals of the two old facets at that edge:
//!   the new surface is convex (or flat) at every edge.
//! - A point q outside the new hull that saw a removed facet sees a new one: the facets that q saw
//!   form a disk, too. If all of it was removed, what q sees now is new. Otherwise the disk has two
//!   neighbours f, removed, and g, kept, and q is strictly above both, so above the new facet at
//!   their common edge, whose normal lies between theirs. So the points of removed facets need to
//!   be tried against the new facets only, and each point is in at most one facet's list.
//!
//! The farthest point of a facet's list becomes the next vertex. That leads fast to the hull of most bodies, but points can be
//! laid out such that it peels off one at a time. So it is for a limited work only; the points left then are taken in random
//! order, for which the expected number of lists that a point goes through is logarithmic, whatever the points (K. L. Clarkson,
//! P. W. Shor, "Applications of Random Sampling in Computational Geometry, II", Discrete & Computational Geometry 4, 1989). And
//! in a cone of many new facets a point finds one that it sees by bisection (`first_seen_in_fan`).
//!
//! Any of several farthest points may become a vertex, hence also one inside a facet or an edge of the final hull. Such flat
//! vertices are found at the end (fewer than three edges between planes that differ meet there), and the hull is built once more
//! from the vertices without them.

use crate::base::error::Result;
use crate::base::memory::{collected, extend, filled, listed, push, reserve, with_capacity};
use crate::base::predicates::{ExactPoints, FilteredPlane};
use crate::base::progress::Progress;
use crate::body::polyhedron::NONE;

/// New facets beyond which a point looks for one that it sees by bisection.
const MANY_FACETS: usize = 32;

/// Tests of a point and facets made that the farthest points may take, for each point and doubling of their number: a sphere of
/// 32,000 points takes 6.5, a prism 5.
const WORK_OF_FARTHEST: usize = 16;

/// A triangle of the growing hull.
struct HullFacet {
    /// Counter-clockwise from outside.
    corners: [u32; 3],
    /// `neighbours[i]` is across the edge from `corners[i]` to `corners[(i + 1) % 3]`.
    neighbours: [u32; 3],
    plane: FilteredPlane,
    /// The list of points whose turn comes with this facet; all see it. Continued in
    /// `Quickhull::next_outside`.
    first_outside: u32,
    /// The point of the list that becomes a vertex: that with the largest value of [`ApexRule`], the lowest index among equals.
    apex: u32,
    value_of_apex: f64,
    /// Seen by a point that became a vertex; no longer part of the hull.
    removed: bool,
    /// The last point that was found not to see this facet.
    unseen_by: u32,
}

/// The part of the hull that a point sees.
struct Cap {
    /// The facets that it sees.
    visible: Vec<u32>,
    /// The edges at which the rest of the hull begins.
    horizon: Vec<HorizonEdge>,
}

/// An edge between a facet that the new vertex sees and one that it does not see.
struct HorizonEdge {
    /// First vertex, in the order of the facet that is seen.
    tail: u32,
    /// Second vertex.
    head: u32,
    /// The facet that is not seen.
    outer: u32,
}

/// The rule for the next vertex in a facet's list; see this file's head.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ApexRule {
    Farthest,
    Random,
}

/// A number above 0 that has nothing to do with the point (S. Vigna's SplitMix64).
fn random_value(p: u32) -> f64 {
    let mut x = (u64::from(p) + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((x ^ x >> 31) | 1) as f64
}

/// The state of the algorithm of this file's head.
///
/// Exact duplicates need no care: what happens to a point depends on its coordinates alone, so
/// duplicates travel together through the lists, the lowest index becomes the vertex, and the
/// others do not see any facet from then on.
pub(super) struct Quickhull<'a> {
    points: &'a ExactPoints,
    /// Never more than the largest hull on the way has, 2n − 4: removed ones are reused.
    facets: Vec<HullFacet>,
    /// Removed facets.
    free: Vec<u32>,
    /// Facets that had points in their lists, for the next round. One that was removed, and perhaps reused, while it waited does no
    /// harm.
    waiting: Vec<u32>,
    /// The next point in a facet's list, per point.
    next_outside: Vec<u32>,
    /// The new facet whose first corner a point is, per point; valid while the facets of one new
    /// vertex are joined.
    new_facet_from: Vec<u32>,
    choice: ApexRule,
    /// Tests of a point and facets made.
    work: usize,
    vertex_count: usize,
}

impl<'a> Quickhull<'a> {
    pub(super) fn run(
        points: &'a ExactPoints,
        [a, b, c, d]: [u32; 4],
        progress: &mut Progress,
    ) -> Result<Quickhull<'a>> {
        let mut hull = Quickhull {
            points,
            facets: Vec::new(),
            free: Vec::new(),
            waiting: Vec::new(),
            next_outside: filled(NONE, points.len())?,
            new_facet_from: filled(NONE, points.len())?,
            choice: ApexRule::Farthest,
            work: 0,
            vertex_count: 4,
        };
        // d is above (a, b, c). Facet i lacks corner i of [a, b, c, d].
        reserve(&mut hull.facets, 4)?;
        hull.add_facet([b, c, d], [3, 1, 2]);
        hull.add_facet([c, a, d], [3, 2, 0]);
        hull.add_facet([a, b, d], [3, 0, 1]);
        hull.add_facet([a, c, b], [1, 0, 2]);
        let mut outside: Vec<u32> = collected(0..points.len() as u32)?;
        let mut new = listed([0, 1, 2, 3]);
        hull.distribute(&outside, &new, progress)?;
        let work_of_farthest = WORK_OF_FARTHEST * points.len() * points.len().ilog2() as usize;
        let mut cap = Cap { visible: Vec::new(), horizon: Vec::new() };
        let mut round = Vec::new();
        loop {
            if round.is_empty() {
                hull.begin_round(&mut round)?;
            }
            let Some((_, f)) = round.pop() else { break };
            let HullFacet { first_outside, apex, .. } = *hull.facet(f);
            if first_outside != NONE {
                hull.vertex_count += 1;
                if hull.work > work_of_farthest {
                    hull.choice = ApexRule::Random;
                }
                hull.remove_visible(f, apex, &mut cap, progress)?;
                hull.take_outside(&cap.visible, apex, &mut outside, progress)?;
                hull.add_cone(apex, &cap.horizon, &mut new, progress)?;
                hull.distribute(&outside, &new, progress)?;
            }
        }
        Ok(hull)
    }

    /// Moves all that wait into a round, last first: in rounds, so that the hull grows evenly on all sides, and each along the
    /// curve, as points are numbered.
    fn begin_round(&mut self, round: &mut Vec<(u32, u32)>) -> Result<()> {
        extend(round, self.waiting.iter().map(|&f| (self.facet(f).apex, f)))?;
        round.sort_unstable_by(|a, b| b.cmp(a));
        self.waiting.clear();
        Ok(())
    }

    pub(super) fn triangles(&self) -> Result<Vec<[u32; 3]>> {
        collected(self.facets.iter().filter(|f| !f.removed).map(|f| f.corners))
    }

    /// The vertices where three edges or more meet between facets that are not exactly coplanar. At a vertex inside a
    /// facet of the merged hull none do, inside an edge two.
    pub(super) fn extreme_vertices(&self, progress: &mut Progress) -> Result<Vec<u32>> {
        let mut sharp_edges = filled(0_u32, self.points.len())?;
        for (done, facet) in self.facets.iter().enumerate().filter(|(_, f)| !f.removed) {
            progress.steps(2, done, self.facets.len())?;
            for side in 0..3 {
                let (tail, head) = (facet.corners[side], facet.corners[(side + 1) % 3]);
                if tail < head {
                    let other = self.facet(facet.neighbours[side]).corners;
                    let across = other.into_iter().find(|v| *v != tail && *v != head);
                    if across.is_some_and(|v| self.points.height(&facet.plane, v) < 0.0) {
                        sharp_edges[tail as usize] += 1;
                        sharp_edges[head as usize] += 1;
                    }
                }
            }
        }
        collected((0..self.points.len() as u32).filter(|v| sharp_edges[*v as usize] >= 3))
    }

    fn facet(&self, f: u32) -> &HullFacet {
        &self.facets[f as usize]
    }

    /// There is room for it.
    fn add_facet(&mut self, corners: [u32; 3], neighbours: [u32; 3]) -> u32 {
        let facet = HullFacet {
            corners,
            neighbours,
            plane: self.points.plane(corners),
            first_outside: NONE,
            apex: NONE,
            value_of_apex: 0.0,
            removed: false,
            unseen_by: NONE,
        };
        if let Some(f) = self.free.pop() {
            self.facets[f as usize] = facet;
            f
        } else {
            self.facets.push(facet);
            self.facets.len() as u32 - 1
        }
    }

    /// Counts work and reports.
    fn count(&mut self, work: usize, progress: &mut Progress) -> Result<()> {
        self.work += work;
        progress.steps(work, self.vertex_count, self.points.len())
    }

    /// Puts each point into the list of one of `facets` that it sees, the first if they are few; drops it if there is none.
    /// Facets with points then wait for their turn.
    fn distribute(&mut self, points: &[u32], facets: &[u32], progress: &mut Progress) -> Result<()> {
        let fan = if facets.len() > MANY_FACETS { self.fan(facets)? } else { Vec::new() };
        for &p in points {
            let (seen, tests) =
                if fan.is_empty() { self.first_seen(facets, p) } else { self.first_seen_in_fan(&fan, p) };
            if let Some((f, height)) = seen {
                let value = match self.choice {
                    ApexRule::Farthest => height,
                    ApexRule::Random => random_value(p),
                };
                let facet = &mut self.facets[f as usize];
                let is_tie = value == facet.value_of_apex;
                if value > facet.value_of_apex || (is_tie && p < facet.apex) {
                    facet.apex = p;
                    facet.value_of_apex = value;
                }
                self.next_outside[p as usize] = facet.first_outside;
                facet.first_outside = p;
            }
            self.count(tests, progress)?;
        }
        for &f in facets {
            if self.facet(f).first_outside != NONE {
                push(&mut self.waiting, f)?;
            }
        }
        Ok(())
    }

    /// The first of `facets` that a point sees, with its height above it; and the number of tests that took.
    fn first_seen(&self, facets: &[u32], p: u32) -> (Option<(u32, f64)>, usize) {
        for (before, &f) in facets.iter().enumerate() {
            let height = self.points.height(&self.facet(f).plane, p);
            if height > 0.0 {
                return (Some((f, height)), before + 1);
            }
        }
        (None, facets.len())
    }

    /// The facets of a cone, counter-clockwise seen from outside; the last two are not coplanar.
    fn fan(&self, facets: &[u32]) -> Result<Vec<u32>> {
        let mut fan = with_capacity(facets.len())?;
        let mut f = facets[0];
        for _ in facets {
            fan.push(f);
            f = self.facet(f).neighbours[1];
        }
        let bends = |i: &usize| {
            let following = self.facet(fan[(i + 1) % fan.len()]);
            self.points.height(&self.facet(fan[*i]).plane, following.corners[1]) < 0.0
        };
        let bend = (0..fan.len()).find(bends).unwrap_or(0);
        fan.rotate_left((bend + 2) % facets.len());
        Ok(fan)
    }

    /// Same as [`Quickhull::first_seen`], for the facets of [`Quickhull::fan`], but any that it sees.
    ///
    /// The tails v₀ … vₘ₋₁ of the facets go counter-clockwise around the apex r. So v₁ … vⱼ₋₁ are not below the plane (r, v₀, vⱼ),
    /// and vⱼ₊₁ … vₘ₋₁ not above it. A point p that sees neither the first nor the last facet is not above (r, v₀, v₁) and not
    /// below (r, v₀, vₘ₋₁). Bisection finds a j such that it is not above (r, v₀, vⱼ) and not below (r, v₀, vⱼ₊₁), above it unless
    /// j + 1 = m − 1. If r, v₀, vⱼ and vⱼ₊₁ were in one plane, both would tell the same of p, so p would be in it, and
    /// j + 1 = m − 1: the last two facets would be coplanar, which they are not. So if p does not see the facet (vⱼ, vⱼ₊₁, r)
    /// either, it is in the cone from r over v₀, vⱼ and vⱼ₊₁, hence sees no facet at r.
    fn first_seen_in_fan(&self, fan: &[u32], p: u32) -> (Option<(u32, f64)>, usize) {
        let last = fan.len() - 1;
        let (ends, mut tests) = self.first_seen(&[fan[0], fan[last]], p);
        if ends.is_some() {
            return (ends, tests);
        }
        let HullFacet { corners: [start, _, apex], .. } = *self.facet(fan[0]);
        let (mut low, mut high) = (1, last);
        while high - low > 1 {
            let middle = usize::midpoint(low, high);
            let tail = self.facet(fan[middle]).corners[0];
            tests += 1;
            if self.points.orientation([apex, start, tail], p) > 0.0 {
                high = middle;
            } else {
                low = middle;
            }
        }
        let (seen, test) = self.first_seen(&fan[low..=low], p);
        (seen, tests + test)
    }

    /// Removes all facets that `apex` sees, `start` being one, and lists them and their horizon.
    fn remove_visible(
        &mut self,
        start: u32,
        apex: u32,
        Cap { visible, horizon }: &mut Cap,
        progress: &mut Progress,
    ) -> Result<()> {
        visible.clear();
        horizon.clear();
        self.facets[start as usize].removed = true;
        push(visible, start)?;
        let mut done = 0;
        while done < visible.len() {
            let HullFacet { corners, neighbours, .. } = *self.facet(visible[done]);
            done += 1;
            self.count(3, progress)?;
            for side in 0..3 {
                let outer = neighbours[side];
                let facet = &mut self.facets[outer as usize];
                if facet.removed {
                    continue;
                }
                if facet.unseen_by != apex && self.points.height(&facet.plane, apex) > 0.0 {
                    facet.removed = true;
                    push(visible, outer)?;
                } else {
                    facet.unseen_by = apex;
                    push(horizon, HorizonEdge { tail: corners[side], head: corners[(side + 1) % 3], outer })?;
                }
            }
        }
        extend(&mut self.free, visible.iter().copied())
    }

    /// Moves the points of the lists of `removed` facets to `outside`, except the new vertex
    /// `apex`.
    fn take_outside(
        &mut self,
        removed: &[u32],
        apex: u32,
        outside: &mut Vec<u32>,
        progress: &mut Progress,
    ) -> Result<()> {
        outside.clear();
        for &f in removed {
            let mut p = std::mem::replace(&mut self.facets[f as usize].first_outside, NONE);
            while p != NONE {
                if p != apex {
                    push(outside, p)?;
                }
                p = self.next_outside[p as usize];
                progress.step(self.vertex_count, self.points.len())?;
            }
        }
        Ok(())
    }

    /// Joins `apex` to every edge of the horizon; lists the new facets in `new`.
    fn add_cone(
        &mut self,
        apex: u32,
        horizon: &[HorizonEdge],
        new: &mut Vec<u32>,
        progress: &mut Progress,
    ) -> Result<()> {
        new.clear();
        reserve(new, horizon.len())?;
        reserve(&mut self.facets, horizon.len())?;
        for &HorizonEdge { tail, head, outer } in horizon {
            self.count(1, progress)?;
            let f = self.add_facet([tail, head, apex], [outer, NONE, NONE]);
            let outer = &mut self.facets[outer as usize];
            for side in 0..3 {
                if outer.corners[side] == head {
                    outer.neighbours[side] = f;
                }
            }
            self.new_facet_from[tail as usize] = f;
            new.push(f);
        }
        // The horizon is a simple cycle, so one new facet begins at each of its vertices.
        for &f in new.iter() {
            let following = self.new_facet_from[self.facet(f).corners[1] as usize];
            self.facets[f as usize].neighbours[1] = following;
            self.facets[following as usize].neighbours[2] = f;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Vector;
    use swiftprox::random::Random;

    /// A pyramid over a square with many points on its sides, so many facets are coplanar; points of a lattice, so many lie in
    /// planes of facets. Bisection finds a facet that a point sees exactly if there is one.
    #[test]
    fn bisection_in_a_cone_finds_what_a_point_sees() {
        const HALF: i32 = 8;
        let corners = [(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)];
        let rim = (0..4).flat_map(|side| {
            let (from, to) = (corners[side], corners[(side + 1) % 4]);
            (0..2 * HALF).map(move |k| {
                let part = |from: i32, to: i32| f64::from(from + (to - from) / (2 * HALF) * k);
                Vector::new(part(from.0, to.0), part(from.1, to.1), 0.0)
            })
        });
        let mut points: Vec<Vector> = rim.chain([Vector::new(0.0, 0.0, 4.0)]).collect();
        let apex = points.len() as u32 - 1;
        assert!(apex as usize > MANY_FACETS);
        let mut random = Random::new(41);
        points.extend((0..2_000).map(|_| random.lattice(10)));
        let exact = ExactPoints::new(&points).unwrap();
        let mut hull = Quickhull {
            points: &exact,
            facets: Vec::new(),
            free: Vec::new(),
            waiting: Vec::new(),
            next_outside: Vec::new(),
            new_facet_from: Vec::new(),
            choice: ApexRule::Farthest,
            work: 0,
            vertex_count: 4,
        };
        let facets: Vec<u32> =
            (0..apex).map(|v| hull.add_facet([v, (v + 1) % apex, apex], [NONE, (v + 1) % apex, NONE])).collect();
        let mut seen = 0;
        for start in 0..facets.len() {
            let begun = [&facets[start..], &facets[..start]].concat();
            let fan = hull.fan(&begun).unwrap();
            for p in (apex + 1..points.len() as u32).skip(start).step_by(7) {
                let (one, _) = hull.first_seen(&facets, p);
                let (other, tests) = hull.first_seen_in_fan(&fan, p);
                assert_eq!(one.is_some(), other.is_some(), "{:?}", points[p as usize]);
                if let Some((f, height)) = other {
                    assert!(height > 0.0 && height == exact.height(&hull.facet(f).plane, p));
                    seen += 1;
                }
                assert!(tests <= 3 + facets.len().ilog2() as usize + 1, "{tests}");
            }
        }
        assert!(seen > 1_000);
    }
}
