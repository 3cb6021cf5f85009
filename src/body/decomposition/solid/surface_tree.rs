//! Distances from a surface, and on which side of it a point is, by a tree of boxes.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, push};

/// Triangles in a leaf, at most.
const LEAF: usize = 4;
/// What comparisons of coordinates of about 1 may be off by.
const ROUNDING: f64 = 1e-14;

struct TreeNode {
    low: Vector,
    high: Vector,
    /// Its triangles; of an inner node its second child is `second`, the first the next node.
    triangles: [u32; 2],
    second: u32,
    /// The node behind its last descendant.
    end: u32,
}

/// A binary tree over the triangles of a closed surface.
pub struct SurfaceTree {
    nodes: Vec<TreeNode>,
    triangles: Vec<[Vector; 3]>,
}

impl SurfaceTree {
    pub fn new(triangles: &[[Vector; 3]]) -> Result<SurfaceTree> {
        let mut tree = SurfaceTree { nodes: Vec::new(), triangles: collected(triangles.iter().copied())? };
        tree.build(0, triangles.len())?;
        Ok(tree)
    }

    fn build(&mut self, start: usize, end: usize) -> Result<()> {
        let part = &mut self.triangles[start..end];
        let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
        part.iter().flatten().for_each(|p| (low, high) = (low.inf(p), high.sup(p)));
        let own = self.nodes.len();
        let triangles = [start as u32, end as u32];
        let axis = (high - low).imax();
        if end - start > LEAF {
            let middle = (end - start) / 2;
            let key = |t: &[Vector; 3]| t[0][axis] + t[1][axis] + t[2][axis];
            part.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
        }
        push(&mut self.nodes, TreeNode { low, high, triangles, second: 0, end: 0 })?;
        if end - start > LEAF {
            let middle = start + (end - start) / 2;
            self.build(start, middle)?;
            self.nodes[own].second = self.nodes.len() as u32;
            self.build(middle, end)?;
        }
        self.nodes[own].end = self.nodes.len() as u32;
        Ok(())
    }

    fn leaf(&self, node: &TreeNode) -> &[[Vector; 3]] {
        &self.triangles[node.triangles[0] as usize..node.triangles[1] as usize]
    }

    /// The distance from the surface; some number up to `enough` where it is not more than that. `near` is a triangle that may be
    /// the nearest, and becomes it.
    pub fn distance_within(&self, point: &Vector, enough: f64, near: &mut u32) -> f64 {
        let (mut best, enough) = (squared_distance(&self.triangles[*near as usize], point), enough * enough.abs());
        let mut stack = [(0_u32, 0.0_f64); 64];
        stack[0] = (0, self.gap(0, point));
        let mut count = 1;
        while count > 0 && best > enough {
            count -= 1;
            let (n, gap) = stack[count];
            if gap >= best {
                continue;
            }
            let node = &self.nodes[n as usize];
            if node.second == 0 {
                for t in node.triangles[0]..node.triangles[1] {
                    let square = squared_distance(&self.triangles[t as usize], point);
                    if square < best {
                        (best, *near) = (square, t);
                    }
                }
                continue;
            }
            let mut children = [n + 1, node.second].map(|child| (child, self.gap(child, point)));
            if children[0].1 < children[1].1 {
                children.swap(0, 1);
            }
            stack[count..count + 2].copy_from_slice(&children);
            count += 2;
        }
        best.sqrt()
    }

    /// Whether a triangle is within a distance of a point.
    pub fn is_near(&self, point: &Vector, distance: f64, triangle: u32) -> bool {
        squared_distance(&self.triangles[triangle as usize], point) <= distance * distance
    }

    /// The square of a point's distance from a node's box.
    #[inline]
    fn gap(&self, n: u32, point: &Vector) -> f64 {
        let node = &self.nodes[n as usize];
        (node.low - point).sup(&(point - node.high)).sup(&Vector::zeros()).norm_squared()
    }

    /// Whether the surface winds around a point, by its signed crossings with a ray along x. Right for points that are farther from
    /// it than rounding.
    pub fn winds_around(&self, point: &Vector) -> bool {
        let (mut windings, mut n) = (0, 0);
        while let Some(node) = self.nodes.get(n) {
            let meets =
                |axis: usize| node.low[axis] <= point[axis] + ROUNDING && point[axis] <= node.high[axis] + ROUNDING;
            let is_met = node.high.x > point.x && meets(1) && meets(2);
            if is_met && node.second == 0 {
                windings += self.leaf(node).iter().map(|t| crossing(t, point)).sum::<i32>();
            }
            n = if is_met { n + 1 } else { node.end as usize };
        }
        windings != 0
    }
}

/// How often, and which way, the ray from a point along x passes through a triangle. Each edge decides the same for both of its
/// triangles, whatever is rounded: no ray slips between them.
fn crossing(triangle: &[Vector; 3], point: &Vector) -> i32 {
    let [a, b, c] = triangle;
    let mut turns = 0;
    for (tail, head) in [(a, b), (b, c), (c, a)] {
        let rises = head.y > point.y;
        if rises == (tail.y > point.y) {
            continue;
        }
        let (low, high) = if rises { (tail, head) } else { (head, tail) };
        if (high.y - low.y) * (point.z - low.z) > (high.z - low.z) * (point.y - low.y) {
            turns += if rises { 1 } else { -1 };
        }
    }
    if turns == 0 || triangle.iter().all(|corner| corner.x <= point.x) {
        return 0;
    }
    let normal = (b - a).cross(&(c - a));
    let is_ahead = triangle.iter().all(|corner| corner.x > point.x) || normal.dot(&(a - point)) * normal.x > 0.0;
    if is_ahead { turns } else { 0 }
}

/// C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
fn squared_distance([a, b, c]: &[Vector; 3], point: &Vector) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ap.norm_squared();
    }
    let bp = point - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return bp.norm_squared();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (ap - ab * (d1 / (d1 - d3))).norm_squared();
    }
    let cp = point - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return cp.norm_squared();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (ap - ac * (d2 / (d2 - d6))).norm_squared();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm_squared();
    }
    let normal = ab.cross(&ac);
    let height = normal.dot(&ap);
    height * height / normal.norm_squared()
}
