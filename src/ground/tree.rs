//! A static tree of boxes over the triangles of a soup, in some 14 bytes a triangle: each node has up to four children, with boxes
//! in single precision. Boxes of triangles are exact: least and greatest coordinates of vertices.

use crate::base::error::Result;
use crate::base::math::{Vector, length};
use crate::base::memory::{copied, push, with_capacity};

/// So many children a node has, and so many triangles a leaf.
pub(super) const FOUR: usize = 4;

/// No child, and no triangle.
const NONE: u32 = u32::MAX;

/// This bit is set in the number of a leaf.
const LEAF: u32 = 1 << 31;

/// A tree of 2³⁰ triangles has less than 16 levels; a walk keeps three nodes for each.
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
        NodeBounds { lower: a.inf(b).inf(c), upper: a.sup(b).sup(c) }
    }

    pub fn union(&self, other: &NodeBounds) -> NodeBounds {
        NodeBounds { lower: self.lower.inf(&other.lower), upper: self.upper.sup(&other.upper) }
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

    /// How far four boxes are from this one, each as by [`gap`](NodeBounds::gap).
    pub fn gaps(&self, boxes: &FourBoxes) -> [f64; FOUR] {
        std::array::from_fn(|lane| boxes.bounds(lane).gap(self))
    }

    /// The shortest way to another box.
    pub fn way_to(&self, other: &NodeBounds) -> Vector {
        let between = |lower: f64, upper: f64| (lower - upper).max(0.0);
        Vector::from_fn(|k, _| between(other.lower[k], self.upper[k]) - between(self.lower[k], other.upper[k]))
    }
}

/// Four boxes, coordinate by coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FourBoxes {
    pub lower: [[f64; FOUR]; 3],
    pub upper: [[f64; FOUR]; 3],
}

impl FourBoxes {
    pub fn bounds(&self, lane: usize) -> NodeBounds {
        let ends = |ends: &[[f64; FOUR]; 3]| Vector::new(ends[0][lane], ends[1][lane], ends[2][lane]);
        NodeBounds { lower: ends(&self.lower), upper: ends(&self.upper) }
    }
}

/// The actions of a walk at what it comes to.
pub(super) trait Visit {
    /// Of the boxes in one node, those with lesser keys come first. Those with an infinite one are passed by.
    fn keys(&self, boxes: &FourBoxes) -> [f64; FOUR];
    /// Whether to go to the triangles in a box.
    fn goes_to(&mut self, bounds: &NodeBounds, key: f64) -> bool;
    /// Comes to a triangle; `false` ends the walk.
    ///
    /// # Errors
    /// The walk's.
    fn triangle(&mut self, triangle: u32) -> Result<bool>;
}

/// Boxes that a walk is yet to come to, the next one last.
pub(super) struct Pending<T, const MOST: usize> {
    boxes: [(T, f64); MOST],
    count: usize,
}

impl<T: Copy, const MOST: usize> Pending<T, MOST> {
    pub fn new(root: T, key: f64) -> Pending<T, MOST> {
        Pending { boxes: [(root, key); MOST], count: 1 }
    }

    pub fn pop(&mut self) -> Option<(T, f64)> {
        self.count = self.count.checked_sub(1)?;
        Some(self.boxes[self.count])
    }

    /// How many there are: those added from here on are one node's.
    pub fn mark(&self) -> usize {
        self.count
    }

    /// Adds one to those of a node, in the order of their keys.
    pub fn add(&mut self, mark: usize, child: T, key: f64) {
        debug_assert!(mark <= self.count && self.count < MOST);
        if key == f64::INFINITY {
            return;
        }
        let mut at = self.count;
        while at > mark && self.boxes[at - 1].1 < key {
            self.boxes[at] = self.boxes[at - 1];
            at -= 1;
        }
        self.boxes[at] = (child, key);
        self.count += 1;
    }
}

/// A node: the boxes of its children, in the tree's units.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GroundNode {
    lower: [[f32; FOUR]; 3],
    upper: [[f32; FOUR]; 3],
    /// Nodes, or leaves by [`LEAF`]; or [`NONE`].
    children: [u32; FOUR],
}

impl GroundNode {
    /// The box of a child.
    fn bounds(&self, lane: usize, units: &TreeUnits) -> NodeBounds {
        let ends = |ends: &[[f32; FOUR]; 3]| Vector::from_fn(|k, _| units.place(k, ends[k][lane]));
        NodeBounds { lower: ends(&self.lower), upper: ends(&self.upper) }
    }

    /// The boxes of its children.
    fn boxes(&self, units: &TreeUnits) -> FourBoxes {
        let mut boxes = FourBoxes { lower: [[0.0; FOUR]; 3], upper: [[0.0; FOUR]; 3] };
        for k in 0..3 {
            for lane in 0..FOUR {
                boxes.lower[k][lane] = units.place(k, self.lower[k][lane]);
                boxes.upper[k][lane] = units.place(k, self.upper[k][lane]);
            }
        }
        boxes
    }
}

/// The tree.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct GroundTree {
    units: TreeUnits,
    bounds: NodeBounds,
    nodes: Vec<GroundNode>,
    /// The triangles in the order of leaves.
    leaves: Vec<[u32; FOUR]>,
}

/// Single precision of coordinates from a middle, times a power of two that keeps them below 2: x is about `base` + `from`·n.
#[derive(Debug, Clone, Copy, PartialEq)]
struct TreeUnits {
    base: Vector,
    to: f64,
    from: f64,
}

impl TreeUnits {
    fn new(bounds: &NodeBounds) -> TreeUnits {
        let base = 0.5 * bounds.lower + 0.5 * bounds.upper;
        let most = (bounds.upper - bounds.lower).amax().max(f64::MIN_POSITIVE);
        // A power of two next to 1/most, within the normal doubles.
        let exponent = (most.to_bits() >> 52) as i64 - 1023;
        let power = |exponent: i64| f64::from_bits(((1023 + exponent.clamp(-1000, 1000)) as u64) << 52);
        TreeUnits { base, to: power(-exponent), from: power(exponent) }
    }

    /// Less than x, in these units, and at most any number whose own [`up`](TreeUnits::up) is at least this: rounding keeps the
    /// order. One step of single precision is more than the difference and the sum of [`place`](TreeUnits::place) round.
    fn down(&self, k: usize, x: f64) -> f32 {
        (((x - self.base[k]) * self.to) as f32).next_down()
    }

    /// The same for an upper end.
    fn up(&self, k: usize, x: f64) -> f32 {
        (((x - self.base[k]) * self.to) as f32).next_up()
    }

    /// The double that a number in these units stands for.
    fn place(&self, k: usize, n: f32) -> f64 {
        self.base[k] + f64::from(n) * self.from
    }
}

impl GroundTree {
    /// From triangles and their boxes; there is one at least.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(items: &mut [TreeItem]) -> Result<GroundTree> {
        debug_assert!(!items.is_empty());
        let bounds = items.iter().fold(items[0].1, |all, (_, one)| all.union(one));
        let leaf_count = items.len().div_ceil(FOUR);
        let mut tree = GroundTree {
            units: TreeUnits::new(&bounds),
            bounds,
            nodes: Vec::new(),
            leaves: with_capacity(leaf_count)?,
        };
        tree.grow_node(items)?;
        tree.nodes = copied(&tree.nodes)?;
        Ok(tree)
    }

    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn try_clone(&self) -> Result<GroundTree> {
        Ok(GroundTree { nodes: copied(&self.nodes)?, leaves: copied(&self.leaves)?, ..*self })
    }

    /// The box of all triangles.
    pub fn bounds(&self) -> &NodeBounds {
        &self.bounds
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.leaves[..])
    }

    /// Goes to all triangles in leaves that have points in common with a box.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn overlapping(&self, body: &NodeBounds, mut visit: impl FnMut(u32) -> Result<()>) -> Result<()> {
        let units = &self.units;
        let lower: [f32; 3] = std::array::from_fn(|k| units.down(k, body.lower[k]));
        let upper: [f32; 3] = std::array::from_fn(|k| units.up(k, body.upper[k]));
        let (mut pending, mut count) = ([0_u32; DEEPEST], 1);
        while count > 0 {
            count -= 1;
            let node = &self.nodes[pending[count] as usize];
            let mut meets = [true; FOUR];
            // Not branched on axis by axis (rule R4).
            for k in 0..3 {
                for (lane, meets) in meets.iter_mut().enumerate() {
                    *meets &= (node.lower[k][lane] <= upper[k]) & (lower[k] <= node.upper[k][lane]);
                }
            }
            for (child, meets) in node.children.into_iter().zip(meets) {
                if !meets || child == NONE {
                    continue;
                }
                if child & LEAF == 0 {
                    pending[count] = child;
                    count += 1;
                    continue;
                }
                for triangle in self.leaf(child) {
                    visit(triangle)?;
                }
            }
        }
        Ok(())
    }

    /// Goes to all triangles that `visit` wants.
    ///
    /// # Errors
    /// Those of `visit`.
    pub fn walk(&self, visit: &mut impl Visit) -> Result<()> {
        // A child by its node and its lane; the root is no child.
        const ROOT: (u32, usize) = (0, FOUR);
        let mut pending = Pending::<_, DEEPEST>::new(ROOT, 0.0);
        while let Some(((parent, lane), key)) = pending.pop() {
            let mut number = 0;
            if lane < FOUR {
                let node = &self.nodes[parent as usize];
                if !visit.goes_to(&node.bounds(lane, &self.units), key) {
                    continue;
                }
                number = node.children[lane];
            }
            if number & LEAF != 0 {
                for triangle in self.leaf(number) {
                    if !visit.triangle(triangle)? {
                        return Ok(());
                    }
                }
                continue;
            }
            let (node, mark) = (&self.nodes[number as usize], pending.mark());
            let keys = visit.keys(&node.boxes(&self.units));
            for (lane, key) in keys.into_iter().enumerate().filter(|(lane, _)| node.children[*lane] != NONE) {
                pending.add(mark, (number, lane), key);
            }
        }
        Ok(())
    }

    fn leaf(&self, number: u32) -> impl Iterator<Item = u32> + '_ {
        self.leaves[(number & !LEAF) as usize].into_iter().take_while(|triangle| *triangle != NONE)
    }

    /// Adds a node over some triangles, and those below it.
    fn grow_node(&mut self, items: &mut [TreeItem]) -> Result<u32> {
        let number = self.nodes.len();
        // Finite: a difference of infinite ends would be an invalid operation.
        let empty = [[f32::MAX; FOUR]; 3];
        push(
            &mut self.nodes,
            GroundNode { lower: empty, upper: empty.map(|ends| ends.map(|x: f32| -x)), children: [NONE; FOUR] },
        )?;
        let (before, behind) = split(items);
        let ((a, b), (c, d)) = (split(before), split(behind));
        for (lane, part) in [a, b, c, d].into_iter().filter(|part| !part.is_empty()).enumerate() {
            let bounds = part.iter().fold(part[0].1, |all, (_, one)| all.union(one));
            let child = if part.len() <= FOUR { self.grow_leaf(part)? } else { self.grow_node(part)? };
            let node = &mut self.nodes[number];
            node.children[lane] = child;
            for k in 0..3 {
                node.lower[k][lane] = self.units.down(k, bounds.lower[k]);
                node.upper[k][lane] = self.units.up(k, bounds.upper[k]);
            }
        }
        Ok(number as u32)
    }

    fn grow_leaf(&mut self, items: &[TreeItem]) -> Result<u32> {
        debug_assert!((1..=FOUR).contains(&items.len()));
        let mut leaf = [NONE; FOUR];
        leaf.iter_mut().zip(items).for_each(|(to, (triangle, _))| *to = *triangle);
        push(&mut self.leaves, leaf)?;
        Ok((self.leaves.len() - 1) as u32 | LEAF)
    }
}

/// A triangle and its box.
type TreeItem = (u32, NodeBounds);

/// Both halves along the longest side of the box of all, the first of whole leaves; the second is empty for one leaf.
fn split(items: &mut [TreeItem]) -> (&mut [TreeItem], &mut [TreeItem]) {
    if items.len() <= FOUR {
        return items.split_at_mut(items.len());
    }
    let bounds = items.iter().fold(items[0].1, |all, (_, one)| all.union(one));
    let middle = |bounds: &NodeBounds, axis: usize| bounds.lower[axis] + bounds.upper[axis];
    let axis = (bounds.upper - bounds.lower).imax();
    let half = FOUR * (items.len().div_ceil(FOUR) / 2);
    items.select_nth_unstable_by(half, |(t1, b1), (t2, b2)| {
        middle(b1, axis).total_cmp(&middle(b2, axis)).then(t1.cmp(t2))
    });
    items.split_at_mut(half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Ends in single precision are beyond those in double, where they are taken and where they are compared, at any scale.
    #[test]
    fn ends_are_rounded_outward() {
        let mut random = Random::new(0x7ee);
        for round in 0..2_000 {
            let scale = 10.0_f64.powi(round % 121 - 60);
            let far = Vector::repeat(random.uniform(-1e6, 1e6) * scale);
            let [a, b, x, y] = std::array::from_fn(|_| far + random.vector() * scale);
            let bounds = NodeBounds { lower: a.inf(&b), upper: a.sup(&b) };
            let units = TreeUnits::new(&bounds);
            for k in 0..3 {
                let (lower, upper) = (units.down(k, x[k]), units.up(k, x[k]));
                assert!(units.place(k, lower) <= x[k] && x[k] <= units.place(k, upper));
                assert!(y[k] < x[k] || lower <= units.up(k, y[k]));
                assert!(y[k] > x[k] || upper >= units.down(k, y[k]));
            }
        }
    }

    /// The triangles whose boxes meet another are found, each once, and few beside them.
    #[test]
    fn what_overlaps_is_found() {
        let mut random = Random::new(0x7ef);
        for count in [1_usize, 3, 4, 5, 8, 9, 16, 17, 21, 64, 1_000] {
            let boxes: Vec<NodeBounds> = (0..count)
                .map(|_| {
                    let (at, half) = (random.vector() * 10.0, random.vector().abs());
                    NodeBounds { lower: at - half, upper: at + half }
                })
                .collect();
            let tree = GroundTree::new(&mut (0..).zip(boxes.iter().copied()).collect::<Vec<_>>()).unwrap();
            assert!(tree.leaves.len() == count.div_ceil(FOUR));
            for _ in 0..20 {
                let at = random.vector() * 10.0;
                let body = NodeBounds { lower: at.add_scalar(-1.0), upper: at.add_scalar(1.0) };
                let mut found = Vec::new();
                tree.overlapping(&body, |triangle| push(&mut found, triangle)).unwrap();
                found.sort_unstable();
                for (triangle, bounds) in (0..).zip(&boxes) {
                    let is_found = found.binary_search(&triangle).is_ok();
                    assert!(is_found || bounds.gap(&body) > 0.0, "{count}");
                }
                assert!(found.windows(2).all(|two| two[0] < two[1]));
            }
        }
    }
}
