//! A static tree of boxes over the triangles of a ground. Boxes are exact: least and greatest coordinates of vertices.

use crate::base::error::Result;
use crate::base::math::{Vector, length};
use crate::base::memory::{collected, copied, push, with_capacity};

/// So many triangles are looked at one by one.
const LEAF: usize = 4;

/// A tree of 2³⁰ triangles, split at medians, is less deep; a walk keeps one node for each step down.
const DEEPEST: usize = 64;

/// A closed box along the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NodeBounds {
    pub lower: Vector,
    pub upper: Vector,
}

impl NodeBounds {
    /// The bounds of a triangle.
    pub fn of([a, b, c]: &[Vector; 3]) -> NodeBounds {
        let [lower, upper] = [f64::min, f64::max].map(|pick| a.zip_map(b, pick).zip_map(c, pick));
        NodeBounds { lower, upper }
    }

    pub fn union(&self, other: &NodeBounds) -> NodeBounds {
        NodeBounds {
            lower: self.lower.zip_map(&other.lower, f64::min),
            upper: self.upper.zip_map(&other.upper, f64::max),
        }
    }

    /// Whether two boxes have points in common. Not branched on axis by axis (rule R4).
    pub fn meets(&self, other: &NodeBounds) -> bool {
        let is_along = |k: usize| (self.lower[k] <= other.upper[k]) & (other.lower[k] <= self.upper[k]);
        is_along(0) & is_along(1) & is_along(2)
    }

    /// A box that reaches so much farther each way, rounded outward.
    pub fn grown(&self, by: f64) -> NodeBounds {
        debug_assert!(by >= 0.0);
        NodeBounds { lower: self.lower.map(|x| (x - by).next_down()), upper: self.upper.map(|x| (x + by).next_up()) }
    }

    /// How far two boxes are apart, at least: differences of ends are right to u, the norm of them to 5u more. It is finite: a
    /// square or a difference beyond the doubles leaves a length that may be one.
    pub fn gap(&self, other: &NodeBounds) -> f64 {
        (length(&self.way_to(other)) * (1.0 - 8.0 * f64::EPSILON)).min(f64::MAX)
    }

    /// The shortest way to another box.
    pub fn way_to(&self, other: &NodeBounds) -> Vector {
        let between = |lower: f64, upper: f64| (lower - upper).max(0.0);
        Vector::from_fn(|k, _| between(other.lower[k], self.upper[k]) - between(self.lower[k], other.upper[k]))
    }
}

/// A node; the first child of an inner one is the next node.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GroundNode {
    bounds: NodeBounds,
    /// The second child of an inner node; the place of the first triangle of a leaf.
    at: u32,
    /// How many triangles a leaf has; 0 of an inner node.
    count: u32,
}

/// The tree.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroundTree {
    nodes: Vec<GroundNode>,
    /// The triangles in the order of leaves.
    triangles: Vec<u32>,
}

/// The actions of a walk at what it comes to.
pub(super) trait Visit {
    /// Whether to go to the triangles in a box that is so far from the body's.
    fn goes_to(&mut self, bounds: &NodeBounds, gap: f64) -> bool;
    /// Comes to a triangle; `false` ends the walk.
    ///
    /// # Errors
    /// The walk's.
    fn triangle(&mut self, triangle: u32) -> Result<bool>;
}

impl GroundTree {
    /// From the boxes of triangles; those without one are left out. `None` if all are.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(boxes: impl Iterator<Item = Option<NodeBounds>>) -> Result<Option<GroundTree>> {
        let mut items = Vec::new();
        for (triangle, bounds) in (0..).zip(boxes) {
            if let Some(bounds) = bounds {
                push(&mut items, (triangle, bounds))?;
            }
        }
        if items.is_empty() {
            return Ok(None);
        }
        let mut nodes = with_capacity(items.len().next_power_of_two())?;
        grow(&mut nodes, &mut items, 0)?;
        Ok(Some(GroundTree {
            nodes: copied(&nodes)?,
            triangles: collected(items.iter().map(|(triangle, _)| *triangle))?,
        }))
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<GroundTree> {
        Ok(GroundTree { nodes: copied(&self.nodes)?, triangles: copied(&self.triangles)? })
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> &NodeBounds {
        &self.nodes[0].bounds
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.triangles[..])
    }

    /// Goes to all triangles in leaves that have points in common with a box.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn overlapping(&self, body: &NodeBounds, mut visit: impl FnMut(u32) -> Result<()>) -> Result<()> {
        let mut stack = [0_u32; DEEPEST];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let number = stack[depth];
            let node = &self.nodes[number as usize];
            if !node.bounds.meets(body) {
                continue;
            }
            if node.count > 0 {
                for &triangle in &self.triangles[node.at as usize..(node.at + node.count) as usize] {
                    visit(triangle)?;
                }
                continue;
            }
            (stack[depth], stack[depth + 1]) = (node.at, number + 1);
            depth += 2;
        }
        Ok(())
    }

    /// Goes to all triangles that `visit` wants of those near a box, the nearer half of each node first.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn walk(&self, body: &NodeBounds, visit: &mut impl Visit) -> Result<()> {
        let mut stack = [(0_u32, 0.0_f64); DEEPEST];
        let mut depth = 1;
        stack[0] = (0, self.nodes[0].bounds.gap(body));
        while depth > 0 {
            depth -= 1;
            let (number, gap) = stack[depth];
            let node = &self.nodes[number as usize];
            if !visit.goes_to(&node.bounds, gap) {
                continue;
            }
            if node.count > 0 {
                for &triangle in &self.triangles[node.at as usize..(node.at + node.count) as usize] {
                    if !visit.triangle(triangle)? {
                        return Ok(());
                    }
                }
                continue;
            }
            let children = [number + 1, node.at].map(|child| (child, self.nodes[child as usize].bounds.gap(body)));
            let nearer = usize::from(children[1].1 < children[0].1);
            stack[depth] = children[1 - nearer];
            stack[depth + 1] = children[nearer];
            depth += 2;
        }
        Ok(())
    }
}

/// Adds the node of some triangles, the first of which has this place, and those below it.
fn grow(nodes: &mut Vec<GroundNode>, items: &mut [(u32, NodeBounds)], first: usize) -> Result<()> {
    debug_assert!(!items.is_empty());
    let all = items.iter().map(|(_, bounds)| *bounds).reduce(|a, b| a.union(&b));
    let Some(bounds) = all else { return Ok(()) };
    let number = nodes.len();
    let count = if items.len() <= LEAF { items.len() as u32 } else { 0 };
    push(nodes, GroundNode { bounds, at: first as u32, count })?;
    if count > 0 {
        return Ok(());
    }
    let middle = |bounds: &NodeBounds, axis: usize| bounds.lower[axis] + bounds.upper[axis];
    let axis = (bounds.upper - bounds.lower).imax();
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |(t1, b1), (t2, b2)| {
        middle(b1, axis).total_cmp(&middle(b2, axis)).then(t1.cmp(t2))
    });
    let (before, behind) = items.split_at_mut(half);
    grow(nodes, before, first)?;
    nodes[number].at = nodes.len() as u32;
    grow(nodes, behind, first + half)
}
