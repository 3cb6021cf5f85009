//! The tree of boxes over the pieces of a compound. Boxes contain their pieces, rounding included.

use super::fit::{Cloud, Fitted, Oriented, axes_of};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, push, with_capacity};
use crate::shape::Shape;

/// Where a tree is this deep, nodes are split in halves.
const DEEP: usize = 40;

/// A tree of the most pieces that there may be (2²⁰) is no deeper: 20 halvings below [`DEEP`].
pub(super) const DEEPEST: usize = DEEP + 20;

/// A node: a box along the body's axes, and one that fits better.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PieceNode {
    pub fitted: Fitted,
    /// The square of half the diagonal.
    pub size: f64,
    /// The children; of a leaf the piece and [`LEAF`].
    children: [u32; 2],
}

const LEAF: u32 = u32::MAX;

impl PieceNode {
    /// The piece of a leaf.
    #[inline(always)]
    pub fn piece(&self) -> Option<u32> {
        (self.children[1] == LEAF).then_some(self.children[0])
    }

    /// The children of a node that is no leaf.
    #[inline(always)]
    pub fn children(&self) -> [u32; 2] {
        debug_assert!(self.children[1] != LEAF);
        self.children
    }

    /// The node of one piece.
    pub fn leaf(fitted: Fitted, piece: u32) -> PieceNode {
        PieceNode { fitted, size: fitted.size(), children: [piece, LEAF] }
    }
}

/// A tree for reading, wherever its nodes are.
#[derive(Debug, Clone, Copy)]
pub(super) struct TreeView<'a> {
    pub nodes: &'a [PieceNode],
    pub oriented: &'a [Oriented],
}

/// The tree; node 0 holds all pieces.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PieceTree {
    pub nodes: Vec<PieceNode>,
    /// The same nodes' other boxes.
    pub oriented: Vec<Oriented>,
}

/// A piece as the tree sees it.
#[derive(Debug)]
pub(super) struct Leaf<'a> {
    /// Vertices in the body's frame, off by less than `margin`, which includes the swept radius.
    pub points: &'a [Vector],
    pub margin: f64,
    /// No vertex is farther from the body's origin.
    pub reach: f64,
    /// The piece's triangles, for axes that fit.
    pub shape: &'a Shape,
}

impl PieceTree {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(leaves: &[Leaf]) -> Result<PieceTree> {
        debug_assert!(!leaves.is_empty());
        let count = 2 * leaves.len() - 1;
        let mut order: Vec<u32> = collected(0..leaves.len() as u32)?;
        let own = [Vector::x(), Vector::y(), Vector::z()];
        let boxes = collected(leaves.iter().map(|leaf| Extremes::of(&leaf.cloud(&[leaf.points]).box_along(&own))))?;
        let tree = PieceTree { nodes: with_capacity(count)?, oriented: with_capacity(count)? };
        let mut growth = Growth { leaves, boxes, tree };
        growth.grow(&mut order, 0)?;
        Ok(growth.tree)
    }

    #[inline(always)]
    pub fn view(&self) -> TreeView<'_> {
        TreeView { nodes: &self.nodes, oriented: &self.oriented }
    }

    /// The turned boxes so many levels below the root, and those of leaves above: the middle and half of three edges of each.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn boxes(&self, level: usize) -> Result<Vec<[Vector; 4]>> {
        let (mut boxes, mut open) = (Vec::new(), vec![(0, level)]);
        while let Some((number, below)) = open.pop() {
            let node = &self.nodes[number as usize];
            if below > 0 && node.piece().is_none() {
                node.children().into_iter().try_for_each(|child| push(&mut open, (child, below - 1)))?;
                continue;
            }
            let Oriented { fitted: Fitted { centre, half }, axes } = self.oriented[number as usize];
            let of = |numbers: [f64; 4], by: f64| Vector::new(numbers[0], numbers[1], numbers[2]) * by;
            push(&mut boxes, [of(centre, 1.0), of(axes[0], half[0]), of(axes[1], half[1]), of(axes[2], half[2])])?;
        }
        Ok(boxes)
    }

    /// Memory held beside the struct, in bytes.
    pub fn heap_bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.oriented[..])
    }
}

impl Leaf<'_> {
    fn cloud<'a>(&self, groups: &'a [&'a [Vector]]) -> Cloud<'a> {
        Cloud { groups, margin: self.margin, reach: self.reach }
    }

    /// Axes along faces and their edges.
    fn axes_of_faces(&self) -> impl Iterator<Item = [Vector; 3]> {
        /// So many products of axes and points are worth the better box.
        const MOST_PRODUCTS: usize = 1 << 14;
        let triangles = &self.shape.polyhedron().triangles;
        let step = (triangles.len() * self.points.len()).div_ceil(MOST_PRODUCTS).max(1);
        triangles.iter().step_by(step).flat_map(|corners| {
            let [a, b, c] = corners.map(|v| self.points[v as usize]);
            let normal = (b - a).cross(&(c - a));
            [b - a, c - b, a - c].into_iter().filter_map(move |side| axes_of(&normal, &side))
        })
    }
}

/// The ends of a box along the body's axes, for splitting: nothing rests on their rounding.
#[derive(Debug, Clone, Copy)]
struct Extremes {
    lower: Vector,
    upper: Vector,
}

impl Extremes {
    fn of(fitted: &Fitted) -> Extremes {
        let at = |sign: f64| Vector::from_fn(|k, _| fitted.centre[k] + sign * fitted.half[k]);
        Extremes { lower: at(-1.0), upper: at(1.0) }
    }

    fn union(&self, other: &Extremes) -> Extremes {
        Extremes { lower: self.lower.inf(&other.lower), upper: self.upper.sup(&other.upper) }
    }

    fn surface(&self) -> f64 {
        let side = self.upper - self.lower;
        side.x * side.y + side.y * side.z + side.z * side.x
    }

    fn middle(&self, axis: usize) -> f64 {
        self.lower[axis] + self.upper[axis]
    }
}

struct Growth<'a> {
    leaves: &'a [Leaf<'a>],
    boxes: Vec<Extremes>,
    tree: PieceTree,
}

impl Growth<'_> {
    /// Adds the node of some pieces and those below it; its number.
    fn grow(&mut self, order: &mut [u32], depth: usize) -> Result<u32> {
        debug_assert!(!order.is_empty() && depth <= DEEPEST);
        let number = self.tree.nodes.len() as u32;
        let (fitted, oriented) = match *order {
            [piece] => self.boxes_of_leaf(piece),
            _ => self.boxes_of(order)?,
        };
        push(&mut self.tree.nodes, PieceNode::leaf(fitted, order[0]))?;
        push(&mut self.tree.oriented, oriented)?;
        if order.len() > 1 {
            let (first, second) = self.split(order, depth)?;
            let children = [self.grow(first, depth + 1)?, self.grow(second, depth + 1)?];
            self.tree.nodes[number as usize].children = children;
        }
        Ok(number)
    }

    fn boxes_of_leaf(&self, piece: u32) -> (Fitted, Oriented) {
        let leaf = &self.leaves[piece as usize];
        let groups = [leaf.points];
        let cloud = leaf.cloud(&groups);
        let own = [Vector::x(), Vector::y(), Vector::z()];
        (cloud.box_along(&own), cloud.best_box(leaf.axes_of_faces().chain(cloud.principal_axes())))
    }

    fn boxes_of(&self, order: &[u32]) -> Result<(Fitted, Oriented)> {
        let leaves = || order.iter().map(|piece| &self.leaves[*piece as usize]);
        let groups = collected(leaves().map(|leaf| leaf.points))?;
        let most = |number: fn(&Leaf) -> f64| leaves().map(number).fold(0.0, f64::max);
        let cloud = Cloud { groups: &groups, margin: most(|leaf| leaf.margin), reach: most(|leaf| leaf.reach) };
        let own = [Vector::x(), Vector::y(), Vector::z()];
        Ok((cloud.box_along(&own), cloud.best_box(cloud.principal_axes().into_iter())))
    }

    /// Where the surfaces of both boxes, times the pieces in them, are least together (J. D. MacDonald & K. S. Booth, "Heuristics
    /// for ray tracing using space subdivision", The Visual Computer 6(3), 1990).
    fn split<'b>(&self, order: &'b mut [u32], depth: usize) -> Result<(&'b mut [u32], &'b mut [u32])> {
        let count = order.len();
        let mut best = (f64::INFINITY, copied(order)?, count / 2);
        let mut surfaces = with_capacity(count)?;
        for axis in 0..3 {
            order.sort_unstable_by(|a, b| {
                let middle = |piece: &u32| self.boxes[*piece as usize].middle(axis);
                middle(a).total_cmp(&middle(b)).then(a.cmp(b))
            });
            let boxes = || order.iter().map(|piece| self.boxes[*piece as usize]);
            let grown = |sum: &mut Option<Extremes>, next: Extremes| {
                *sum = Some(sum.map_or(next, |sum| sum.union(&next)));
                sum.map(|sum| sum.surface())
            };
            surfaces.clear();
            surfaces.extend(boxes().rev().scan(None, grown));
            for (place, surface) in boxes().scan(None, grown).enumerate().take(count - 1) {
                let first = place + 1;
                let cost = surface * first as f64 + surfaces[count - 1 - first] * (count - first) as f64;
                let is_better = if depth < DEEP { cost < best.0 } else { first == count / 2 && cost < best.0 };
                if is_better {
                    best.0 = cost;
                    best.1.copy_from_slice(order);
                    best.2 = first;
                }
            }
        }
        order.copy_from_slice(&best.1);
        Ok(order.split_at_mut(best.2))
    }
}
