//! Crossings of arcs: directions in which an edge of one body faces an edge of the other.
//!
//! At a crossing of an arc of an edge along e with the turned arc of an edge along g, the unit vector n* is all but perpendicular
//! to both: |n*·e| and |n*·g| are at most the edges' leans. The computed e and g are off by 12.5u each, their product by 5.3u
//! more. So n* is within θ of the computed ±(e × g)/|e × g|, θ = (32u + leans)/|e × g|.

use super::arcs::{Survivors, proved_by_two_corners};
use super::search::{Facet, FacetSearch, NORMAL};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;

/// See above; a factor for e and g, which skewed poses make no unit vectors.
const CROSS: f64 = 32.0 * U;
const STRETCH: f64 = 1.05;

/// The rounding error of n·(l + r) − (1 + l·r)|n| for a unit vector along n on the arc between the normals l and r. With δl and
/// δr off it is δl·(n − r) + δr·(n − l), and |n − l| + |n − r| ≤ 2√2 on the arc: 2√2·37u, see [`NORMAL`]. Computed, the length of
/// n errs by 2.5u, its product with l + r by 3u, l + r by u, all times 2; 1 + l·r and its product by 7u, the sum with this by 2u:
/// 22u.
pub const ON_ARC: f64 = 2.9 * NORMAL + 23.0 * U;

/// Edges with a greater θ are as good as parallel.
const MOST_TILT: f64 = 1e-6;

/// The rounding error of a product of n* with a difference of corners, over M: the difference 10u, product and length of the
/// computed vector 6u, its part along the edges 4u.
const PLANE: f64 = 24.0 * U;

/// A bound this far below the threshold, over M, is worth another look.
const LOOSE: f64 = 48.0 * U;

/// The proved facts about crossings.
pub struct Crossings {
    /// A lower bound of h at all of those looked at.
    pub least: f64,
    /// Whether one has none that is any good.
    pub is_unclear: bool,
}

/// An arc: that of a fan of body 1, or one of body 2's, not turned round.
#[derive(Clone, Copy)]
struct GaussArc {
    /// R·e.
    along: Vector,
    /// The sum of both normals, and 1 + their product: no unit vector of the arc has a lesser product with the sum.
    middle: Vector,
    least: f64,
    /// A corner of the edge.
    corner: Vector,
    lean: f64,
    faces: [u8; 2],
}

impl GaussArc {
    #[inline(always)]
    fn of<L: Lanes, const C: usize, const F: usize>(search: &FacetSearch<L, C, F>, body: usize, edge: u8) -> GaussArc {
        let (placed, edge) = (&search.placed[body], &search.fans[body].edges[usize::from(edge)]);
        let [left, right] = edge.faces;
        let (left, right) = (placed.normal(usize::from(left)), placed.normal(usize::from(right)));
        GaussArc {
            along: search.frame.bodies[body].rotate(&edge.direction).to_vector(),
            middle: left + right,
            least: 1.0 + left.dot(&right),
            corner: placed.point(usize::from(edge.corners[0])),
            lean: edge.lean,
            faces: edge.faces,
        }
    }
}

/// Four arcs of body 2.
struct ArcBlock<L> {
    along: [L; 3],
    middle: [L; 3],
    least: L,
    corner: [L; 3],
    lean: L,
}

impl<L: Lanes> ArcBlock<L> {
    #[inline(always)]
    fn of([a, b, c, d]: &[GaussArc; 4]) -> ArcBlock<L> {
        ArcBlock {
            along: in_lanes(&[&a.along, &b.along, &c.along, &d.along]),
            middle: in_lanes(&[&a.middle, &b.middle, &c.middle, &d.middle]),
            least: L::load(&[a.least, b.least, c.least, d.least]),
            corner: in_lanes(&[&a.corner, &b.corner, &c.corner, &d.corner]),
            lean: L::load(&[a.lean, b.lean, c.lean, d.lean]),
        }
    }
}

#[inline(always)]
fn in_lanes<L: Lanes>([a, b, c, d]: &[&Vector; 4]) -> [L; 3] {
    [L::load(&[a.x, b.x, c.x, d.x]), L::load(&[a.y, b.y, c.y, d.y]), L::load(&[a.z, b.z, c.z, d.z])]
}

impl Crossings {
    /// Looks at all crossings of arcs that are left.
    #[inline(always)]
    pub fn look_at<L: Lanes, const C: usize, const F: usize>(
        &mut self,
        search: &mut FacetSearch<L, C, F>,
        survivors: &[Survivors<C>; 2],
    ) {
        let (first, second) = (survivors[0].edges(), survivors[1].edges());
        for four in second.chunks(4) {
            let last = four.len() - 1;
            let edges = [four[0], four[1.min(last)], four[2.min(last)], four[3.min(last)]];
            let arcs = [
                GaussArc::of(search, 1, edges[0]),
                GaussArc::of(search, 1, edges[1]),
                GaussArc::of(search, 1, edges[2]),
                GaussArc::of(search, 1, edges[3]),
            ];
            let block = ArcBlock::<L>::of(&arcs);
            for &edge in first {
                let arc = GaussArc::of(search, 0, edge);
                // Those that the block repeats are dropped.
                let mut left = may_be_nearer(search, &arc, &block) & ((1 << four.len()) - 1);
                while left != 0 {
                    let lane = left.trailing_zeros() as usize;
                    left &= left - 1;
                    self.settle(search, [edge, edges[lane]], [&arc, &arcs[lane]]);
                    if self.is_unclear {
                        return;
                    }
                }
            }
        }
    }

    /// Bounds h at a crossing, if there is one.
    #[inline(always)]
    fn settle<L: Lanes, const C: usize, const F: usize>(
        &mut self,
        search: &mut FacetSearch<L, C, F>,
        [edge1, edge2]: [u8; 2],
        arcs: [&GaussArc; 2],
    ) {
        let across = arcs[0].along.cross(&arcs[1].along);
        let length = across.norm();
        let off = STRETCH * (CROSS + arcs[0].lean + arcs[1].lean);
        if off <= MOST_TILT * length {
            let outward = if across.dot(&arcs[0].middle) < 0.0 { -across } else { across };
            let direction = outward / length;
            let support = search.support(&direction);
            search.take(support, &direction, Facet::Edges([u32::from(edge1), u32::from(edge2)]));
            let tilt = off / length;
            // |h(n*) − h(n)| ≤ M|n* − n|.
            let by_support = support - (STRETCH * tilt + 20.0 * U) * search.longest;
            let bound = by_support.max(bound_by_plane(search.longest, arcs, &direction, length, tilt));
            if bound >= search.threshold() - LOOSE * search.longest {
                self.least = self.least.min(bound);
                return;
            }
            if let Some(better) = proved_by_arcs(search, arcs) {
                self.least = self.least.min(better.max(bound));
                return;
            }
            self.least = self.least.min(bound);
            return;
        }
        match proved_by_arcs(search, arcs) {
            Some(bound) => self.least = self.least.min(bound),
            None => self.is_unclear = true,
        }
    }
}

/// A bound of h all along one arc or the other.
#[inline(always)]
fn proved_by_arcs<L: Lanes, const C: usize, const F: usize>(
    search: &FacetSearch<L, C, F>,
    arcs: [&GaussArc; 2],
) -> Option<f64> {
    proved_by_two_corners(search, 0, arcs[0].faces).or_else(|| proved_by_two_corners(search, 1, arcs[1].faces))
}

/// Which of four arcs may cross this one where h < T: bits.
#[inline(always)]
fn may_be_nearer<L: Lanes, const C: usize, const F: usize>(
    search: &FacetSearch<L, C, F>,
    arc: &GaussArc,
    block: &ArcBlock<L>,
) -> u32 {
    let GaussArc { along, middle, least, corner, lean, .. } = arc;
    let [ex, ey, ez] = [L::splat(along.x), L::splat(along.y), L::splat(along.z)];
    let [gx, gy, gz] = block.along;
    let nx = ez.negated_mul_add(gy, ey.mul(gz));
    let ny = ex.negated_mul_add(gz, ez.mul(gx));
    let nz = ey.negated_mul_add(gx, ex.mul(gy));
    let length = nx.mul_add(nx, ny.mul_add(ny, nz.mul(nz))).sqrt();
    let off = block.lean.add(L::splat(CROSS + lean)).mul(L::splat(STRETCH));
    // By how much a product of n with a sum of two normals is off, times its length.
    let allowed = length.mul_add(L::splat(ON_ARC), off.add(off));
    let inside1 = nx.mul_add(L::splat(middle.x), ny.mul_add(L::splat(middle.y), nz.mul(L::splat(middle.z))));
    let [mx, my, mz] = block.middle;
    let inside2 = nx.mul_add(mx, ny.mul_add(my, nz.mul(mz)));
    let [qx, qy, qz] = block.corner;
    let [px, py, pz] = [L::splat(corner.x).sub(qx), L::splat(corner.y).sub(qy), L::splat(corner.z).sub(qz)];
    let height = nx.mul_add(px, ny.mul_add(py, nz.mul(pz)));
    // Towards the arc of body 1, and away from that of body 2, whose fan is turned round.
    let zero = L::splat(0.0);
    let height = height.where_greater(inside1, zero, height.negate());
    let inside2 = inside2.where_greater(inside1, zero, inside2.negate());
    let inside1 = inside1.max(inside1.negate());
    let needed1 = L::splat(*least).mul(length);
    let needed2 = block.least.mul_add(length, inside2);
    let crosses = needed1.at_most(inside1.add(allowed)) & needed2.at_most(allowed);
    let longest = search.longest;
    let enough = L::splat(search.threshold() + PLANE * longest).mul(length);
    crosses & height.at_most(off.mul_add(L::splat(STRETCH * longest), enough))
}

/// A lower bound of h(n*) by the plane through both edges. With p − q = d·n + t for corners p and q of the edges, and t = −s·e +
/// r·g up to a rest, it is n*·(p − q) ≥ d·cos θ − |s·n*·e| − |r·n*·g| − |rest|: what is along the edges counts by their leans
/// alone, however nearly parallel they are.
#[inline(always)]
fn bound_by_plane(longest: f64, [first, second]: [&GaussArc; 2], direction: &Vector, sine: f64, tilt: f64) -> f64 {
    let (e, g) = (&first.along, &second.along);
    let apart = first.corner - second.corner;
    let height = direction.dot(&apart);
    let (ee, eg, gg) = (e.norm_squared(), e.dot(g), g.norm_squared());
    let (along_e, along_g) = (apart.dot(e), apart.dot(g));
    let square = sine * sine;
    let s = (along_g * eg - along_e * gg) / square;
    let r = (along_g * ee - along_e * eg) / square;
    let rest = (apart - direction * height + e * s - g * r).norm();
    // e and g are off by 12.5u.
    let along_edges = s.abs() * (STRETCH * first.lean + 14.0 * U) + r.abs() * (STRETCH * second.lean + 14.0 * U);
    height - height.abs() * tilt * tilt - rest - along_edges - PLANE * longest
}
