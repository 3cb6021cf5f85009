//! A dynamic tree of boxes: leaves come, go and grow one at a time, all boxes are refitted at once, and it is built anew where it
//! has become loose. If a call lacks memory, the tree can only be built anew.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::{extend, push, reserve_sparingly};
use crate::scene::world::boxes::Aabb;

/// Room for what traversals and builds have still to visit, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    branches: Vec<Branch>,
    pairs: Vec<[Branch; 2]>,
    ranges: Vec<(Range<usize>, ChildSlot)>,
    /// The proxies over which a tree should be built.
    pub proxies: Vec<u32>,
}

/// No node. A proxy without a parent is in no tree.
pub(crate) const NONE: u32 = u32::MAX;

/// The parent of the root.
const TOP: u32 = u32::MAX - 1;

/// A tree whose boxes have grown to this many times their girth when built is built anew.
const LOOSE: f32 = 1.5;

/// This many leaves may come, go or grow before all boxes are refitted, or a quarter of all.
const FEW_CHANGES: usize = 64;

/// A node with two children. Leaves need no node: they are proxies, and the caller keeps their boxes and parents.
#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Aabb,
    /// For a node out of use, the next to be used again.
    parent: u32,
    children: [Branch; 2],
}

/// A node, or with the highest bit a leaf: a proxy.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Branch(u32);

enum Kind {
    Node(u32),
    Leaf(u32),
}

/// The content of a branch.
pub(crate) enum Held {
    Proxy(u32),
    Branches([Branch; 2]),
}

impl Branch {
    const LEAF: u32 = 1 << 31;

    fn leaf(proxy: u32) -> Branch {
        debug_assert!(proxy & Branch::LEAF == 0);
        Branch(proxy | Branch::LEAF)
    }

    #[inline(always)]
    fn kind(self) -> Kind {
        if self.0 & Branch::LEAF == 0 { Kind::Node(self.0) } else { Kind::Leaf(self.0 ^ Branch::LEAF) }
    }
}

/// The position of a node or leaf in the tree: the parent, and which of its children it is.
type ChildSlot = (u32, usize);

/// A binary tree over the boxes of proxies. Each call gets these boxes, and what changes the tree the leaves' parents: `parents`,
/// by proxy.
#[derive(Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    root: Option<Branch>,
    /// The node to be used again, or [`NONE`].
    free: u32,
    leaf_count: usize,
    /// Leaves that have come, gone or grown since all boxes were refitted.
    changes: usize,
    /// Leaves that have come or gone since it was built: till then parents come before their children.
    patches: usize,
    /// Sum of the girths of all parents when it was built.
    girth_built: f32,
    /// Its boxes hold those of its leaves.
    pub is_fitted: bool,
}

impl Default for Tree {
    fn default() -> Self {
        let (nodes, root, free) = (Vec::new(), None, NONE);
        Tree { nodes, root, free, leaf_count: 0, changes: 0, patches: 0, girth_built: 0.0, is_fitted: true }
    }
}

impl Tree {
    pub fn is_empty(&self) -> bool {
        self.leaf_count == 0
    }

    /// Whether so much has changed one by one that all boxes should be refitted.
    pub fn is_worn(&self) -> bool {
        self.changes > FEW_CHANGES.max(self.leaf_count / 4)
    }

    // --- One leaf ----------------------------------------------------------------------------------------------------------------

    /// Adds a leaf, beside what grows least on the way down. All others' parents hold their boxes.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn insert(&mut self, proxy: u32, boxes: &[Aabb], parents: &mut [u32]) -> Result<()> {
        debug_assert!(parents[proxy as usize] == NONE);
        reserve_sparingly(&mut self.nodes, 1)?;
        self.changes += 1;
        self.leaf_count += 1;
        self.patches += 1;
        let (leaf, bounds) = (Branch::leaf(proxy), &boxes[proxy as usize]);
        let (mut parent, mut beside) = match self.root {
            Some(root) => (TOP, root),
            None => {
                self.hang((TOP, 0), leaf, parents);
                return Ok(());
            }
        };
        while let Kind::Node(at) = beside.kind() {
            let node = &mut self.nodes[at as usize];
            node.bounds = node.bounds.union(bounds);
            let [left, right] = node.children;
            let growth = |child: Branch| {
                let old = self.bounds(child, boxes);
                old.union(bounds).girth() - 0.5 * old.girth()
            };
            (parent, beside) = (at, if growth(left) <= growth(right) { left } else { right });
        }
        let place = self.place(parent, beside);
        let both = self.bounds(beside, boxes).union(bounds);
        let joint = self.add(Node { bounds: both, parent, children: [beside, leaf] });
        self.hang(place, Branch(joint), parents);
        self.hang((joint, 0), beside, parents);
        self.hang((joint, 1), leaf, parents);
        Ok(())
    }

    /// There is room for it.
    fn add(&mut self, node: Node) -> u32 {
        debug_assert!(self.free != NONE || self.nodes.len() < self.nodes.capacity());
        let at = self.free;
        if at == NONE {
            self.nodes.push(node);
            return self.nodes.len() as u32 - 1;
        }
        self.free = std::mem::replace(&mut self.nodes[at as usize], node).parent;
        at
    }

    /// Which child of its parent a branch is.
    fn place(&self, parent: u32, child: Branch) -> ChildSlot {
        (parent, self.nodes.get(parent as usize).map_or(0, |node| usize::from(node.children[1] == child)))
    }

    /// Makes a branch the child at a place, which for [`TOP`] is the root.
    fn hang(&mut self, (parent, side): ChildSlot, child: Branch, parents: &mut [u32]) {
        match self.nodes.get_mut(parent as usize) {
            Some(node) => node.children[side] = child,
            None => self.root = Some(child),
        }
        match child.kind() {
            Kind::Node(at) => self.nodes[at as usize].parent = parent,
            Kind::Leaf(proxy) => parents[proxy as usize] = parent,
        }
    }

    /// The start of a traversal.
    pub fn root(&self) -> Option<Branch> {
        self.root
    }

    /// The content of a branch.
    #[inline(always)]
    pub fn held(&self, branch: Branch) -> Held {
        match branch.kind() {
            Kind::Leaf(proxy) => Held::Proxy(proxy),
            Kind::Node(at) => Held::Branches(self.nodes[at as usize].children),
        }
    }

    /// The box of a branch.
    #[inline(always)]
    pub fn bounds<'a>(&'a self, branch: Branch, boxes: &'a [Aabb]) -> &'a Aabb {
        match branch.kind() {
            Kind::Node(at) => &self.nodes[at as usize].bounds,
            Kind::Leaf(proxy) => &boxes[proxy as usize],
        }
    }

    /// Removes a leaf.
    pub fn remove(&mut self, proxy: u32, parents: &mut [u32]) {
        debug_assert!(parents[proxy as usize] != NONE && self.leaf_count > 0);
        self.changes += 1;
        self.leaf_count -= 1;
        self.patches += 1;
        let parent = std::mem::replace(&mut parents[proxy as usize], NONE);
        let Some(&Node { children, parent: above, .. }) = self.nodes.get(parent as usize) else {
            self.root = None;
            return;
        };
        let sibling = children[usize::from(children[0] == Branch::leaf(proxy))];
        self.hang(self.place(above, Branch(parent)), sibling, parents);
        self.nodes[parent as usize].parent = std::mem::replace(&mut self.free, parent);
    }

    /// Makes those above a leaf hold its box, which has changed. `parent`: that of the leaf.
    pub fn enlarge(&mut self, parent: u32, bounds: &Aabb) {
        self.changes += 1;
        let mut at = parent;
        while let Some(node) = self.nodes.get_mut(at as usize)
            && !node.bounds.contains(bounds)
        {
            node.bounds = node.bounds.union(bounds);
            at = node.parent;
        }
    }

    // --- All leaves --------------------------------------------------------------------------------------------------------------

    /// Refits all boxes to those of the proxies; false where the tree should be built anew instead.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn refit(&mut self, boxes: &[Aabb], scratch: &mut Scratch) -> Result<bool> {
        if self.patches > self.leaf_count / 2 {
            return Ok(false);
        }
        self.changes = 0;
        let girth = if self.patches == 0 {
            self.refit_upwards((0..self.nodes.len() as u32).rev(), boxes)
        } else {
            let nodes = &mut scratch.branches;
            self.list_downwards(nodes)?;
            self.refit_upwards(nodes.iter().rev().map(|node| node.0), boxes)
        };
        // A NaN, of boxes without end, is as good as any.
        Ok(!(girth > LOOSE * self.girth_built))
    }

    /// All nodes in use, parents before their children.
    fn list_downwards(&self, nodes: &mut Vec<Branch>) -> Result<()> {
        nodes.clear();
        let is_node = |branch: &Branch| matches!(branch.kind(), Kind::Node(_));
        extend(nodes, self.root.filter(is_node))?;
        let mut next = 0;
        while let Some(&Branch(at)) = nodes.get(next) {
            extend(nodes, self.nodes[at as usize].children.into_iter().filter(is_node))?;
            next += 1;
        }
        Ok(())
    }

    /// Children first; gives the sum of the girths.
    fn refit_upwards(&mut self, nodes: impl Iterator<Item = u32>, boxes: &[Aabb]) -> f32 {
        let mut girth = 0.0;
        for at in nodes {
            let [left, right] = self.nodes[at as usize].children.map(|child| self.bounds(child, boxes));
            let bounds = left.union(right);
            girth += bounds.girth();
            self.nodes[at as usize].bounds = bounds;
        }
        girth
    }

    /// Builds it over `scratch.proxies`, top down.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn build(&mut self, scratch: &mut Scratch, boxes: &[Aabb], parents: &mut [u32]) -> Result<()> {
        let Scratch { ranges: open, proxies, .. } = scratch;
        let count = proxies.len();
        *self = Tree { nodes: std::mem::take(&mut self.nodes), leaf_count: count, ..Tree::default() };
        self.nodes.clear();
        reserve_sparingly(&mut self.nodes, count.saturating_sub(1))?;
        open.clear();
        if count > 0 {
            push(open, (0..count, (TOP, 0)))?;
        }
        while let Some((range, place)) = open.pop() {
            if let [proxy] = proxies[range.clone()] {
                self.hang(place, Branch::leaf(proxy), parents);
                continue;
            }
            let node = Branch(self.nodes.len() as u32);
            self.nodes.push(Node { bounds: Aabb::NOWHERE, parent: TOP, children: [node; 2] });
            self.hang(place, node, parents);
            let half = range.start + split(&mut proxies[range.clone()], boxes);
            push(open, (half..range.end, (node.0, 1)))?;
            push(open, (range.start..half, (node.0, 0)))?;
        }
        self.girth_built = self.refit_upwards((0..self.nodes.len() as u32).rev(), boxes);
        Ok(())
    }

    /// Numbers the proxies anew: number k of old becomes `numbers[k]`.
    pub fn renumber(&mut self, numbers: &[u32]) {
        for branch in self.nodes.iter_mut().flat_map(|node| &mut node.children).chain(&mut self.root) {
            // Nodes out of use may hold any number.
            if let Kind::Leaf(proxy) = branch.kind()
                && let Some(&new) = numbers.get(proxy as usize)
            {
                *branch = Branch::leaf(new);
            }
        }
    }

    // --- What overlaps -----------------------------------------------------------------------------------------------------------

    /// Calls `found` with the proxies whose boxes overlap this one.
    ///
    /// # Errors
    /// Those of `found`, and [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn for_each_overlapping(
        &self,
        bounds: &Aabb,
        boxes: &[Aabb],
        scratch: &mut Scratch,
        mut found: impl FnMut(u32) -> Result<()>,
    ) -> Result<()> {
        let open = &mut scratch.branches;
        open.clear();
        extend(open, self.root)?;
        while let Some(branch) = open.pop() {
            if !self.bounds(branch, boxes).overlaps(bounds) {
                continue;
            }
            match branch.kind() {
                Kind::Leaf(proxy) => found(proxy)?,
                Kind::Node(at) => {
                    let [left, right] = self.nodes[at as usize].children;
                    push(open, left)?;
                    push(open, right)?;
                }
            }
        }
        Ok(())
    }

    /// Calls `found` with all pairs of proxies whose boxes overlap, each once.
    ///
    /// # Errors
    /// As [`Tree::for_each_overlapping`].
    pub fn for_each_pair(
        &self,
        boxes: &[Aabb],
        scratch: &mut Scratch,
        found: impl FnMut(u32, u32) -> Result<()>,
    ) -> Result<()> {
        self.cross(self, boxes, scratch, found)
    }

    /// Calls `found` with all pairs of a proxy of this tree and one of the other whose boxes overlap.
    ///
    /// # Errors
    /// As [`Tree::for_each_overlapping`].
    pub fn for_each_pair_with(
        &self,
        other: &Tree,
        boxes: &[Aabb],
        scratch: &mut Scratch,
        found: impl FnMut(u32, u32) -> Result<()>,
    ) -> Result<()> {
        self.cross(other, boxes, scratch, found)
    }

    /// Both trees at once, from their roots down. For a tree against itself, a branch meets itself, too.
    fn cross(
        &self,
        other: &Tree,
        boxes: &[Aabb],
        scratch: &mut Scratch,
        mut found: impl FnMut(u32, u32) -> Result<()>,
    ) -> Result<()> {
        let is_same = std::ptr::eq(self, other);
        let children = |tree: &Tree, at: u32| tree.nodes[at as usize].children;
        let open = &mut scratch.pairs;
        open.clear();
        extend(open, self.root.zip(other.root).map(|(root, other_root)| [root, other_root]))?;
        while let Some([branch, beside]) = open.pop() {
            if is_same && branch == beside {
                if let Kind::Node(at) = branch.kind() {
                    let [left, right] = children(self, at);
                    for pair in [[left, left], [right, right], [left, right]] {
                        push(open, pair)?;
                    }
                }
                continue;
            }
            if !self.bounds(branch, boxes).overlaps(other.bounds(beside, boxes)) {
                continue;
            }
            match (branch.kind(), beside.kind()) {
                (Kind::Leaf(proxy1), Kind::Leaf(proxy2)) => found(proxy1, proxy2)?,
                (Kind::Node(at), Kind::Leaf(_)) => {
                    children(self, at).into_iter().try_for_each(|child| push(open, [child, beside]))?;
                }
                (Kind::Leaf(_), Kind::Node(at)) => {
                    children(other, at).into_iter().try_for_each(|child| push(open, [branch, child]))?;
                }
                (Kind::Node(at), Kind::Node(other_at)) => {
                    for child in children(self, at) {
                        for other_child in children(other, other_at) {
                            push(open, [child, other_child])?;
                        }
                    }
                }
            }
        }
        Ok(())
    }
}

/// Parts proxies by the middle of their boxes' middles along the longest side, or where that is lopsided into halves; gives the
/// first of the second part. Neither is empty.
fn split(proxies: &mut [u32], boxes: &[Aabb]) -> usize {
    debug_assert!(proxies.len() >= 2);
    let middle = |proxy: u32| boxes[proxy as usize].doubled_middle();
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for &proxy in &*proxies {
        let at = middle(proxy);
        for k in 0..3 {
            low[k] = low[k].min(at[k]);
            high[k] = high[k].max(at[k]);
        }
    }
    let side = |k: &usize| high[*k] - low[*k];
    let axis = [0, 1, 2].into_iter().max_by(|a, b| side(a).total_cmp(&side(b))).unwrap_or(0);
    let threshold = 0.5 * low[axis] + 0.5 * high[axis];
    let mut first = 0;
    for k in 0..proxies.len() {
        if middle(proxies[k])[axis] < threshold {
            proxies.swap(first, k);
            first += 1;
        }
    }
    let count = proxies.len();
    // A few far from many: by halves the tree stays shallow.
    if first.min(count - first) * 16 >= count && first > 0 {
        return first;
    }
    let half = count / 2;
    proxies.select_nth_unstable_by(half, |&a, &b| middle(a)[axis].total_cmp(&middle(b)[axis]));
    half
}

#[cfg(test)]
mod tests {
    use super::*;
    use swiftprox::random::Random;

    fn random_box(random: &mut Random) -> Aabb {
        let size = random.uniform(0.0, 1.5) as f32;
        let at: [f32; 3] = std::array::from_fn(|_| random.uniform(0.0, 10.0) as f32);
        Aabb { lower: at, upper: at.map(|x| x + size) }
    }

    /// Leaves that come, go and grow, and trees built and refitted in between, find what a look at all boxes finds.
    #[test]
    fn it_finds_what_overlaps() {
        let mut random = Random::new(0x73ee);
        let rounds = if cfg!(miri) { 40 } else { 600 };
        let (mut tree, mut boxes, mut leaves) = (Tree::default(), Vec::new(), Vec::new());
        let mut scratch = Scratch::default();
        for _ in 0..200 {
            boxes.push(random_box(&mut random));
            leaves.push(NONE);
        }
        for round in 0..rounds {
            let proxy = random.below(200);
            if leaves[proxy] == NONE {
                tree.insert(proxy as u32, &boxes, &mut leaves).unwrap();
            } else if random.below(3) == 0 {
                tree.remove(proxy as u32, &mut leaves);
                assert_eq!(leaves[proxy], NONE);
            } else {
                boxes[proxy] = random_box(&mut random);
                tree.enlarge(leaves[proxy], &boxes[proxy]);
            }
            if round % 37 == 0 {
                boxes.iter_mut().for_each(|bounds| *bounds = random_box(&mut random));
                if !tree.refit(&boxes, &mut scratch).unwrap() {
                    scratch.proxies = (0..200).filter(|&k| leaves[k as usize] != NONE).collect();
                    tree.build(&mut scratch, &boxes, &mut leaves).unwrap();
                }
            }
            let inside: Vec<u32> = (0..200).filter(|&k| leaves[k as usize] != NONE).collect();
            assert_eq!(tree.leaf_count, inside.len());
            let mut found = Vec::new();
            tree.for_each_pair(&boxes, &mut scratch, |a, b| push(&mut found, (a.min(b), a.max(b)))).unwrap();
            found.sort_unstable();
            let overlap = |a: u32, b: u32| boxes[a as usize].overlaps(&boxes[b as usize]);
            let pairs = |&a: &u32| inside.iter().filter(move |&&b| a < b && overlap(a, b)).map(move |&b| (a, b));
            let expected: Vec<(u32, u32)> = inside.iter().flat_map(pairs).collect();
            assert_eq!(found, expected);
            let asked = random_box(&mut random);
            let mut near = Vec::new();
            tree.for_each_overlapping(&asked, &boxes, &mut scratch, |proxy| push(&mut near, proxy)).unwrap();
            near.sort_unstable();
            let expected: Vec<u32> = inside.into_iter().filter(|&k| boxes[k as usize].overlaps(&asked)).collect();
            assert_eq!(near, expected);
        }
    }

    #[test]
    fn boxes_at_one_place_and_without_end_make_no_deep_tree() {
        let boxes = vec![Aabb::EVERYWHERE; 1000];
        let (mut tree, mut leaves) = (Tree::default(), vec![NONE; 1000]);
        let mut scratch = Scratch { proxies: (0..1000).collect(), ..Scratch::default() };
        tree.build(&mut scratch, &boxes, &mut leaves).unwrap();
        let above = |&at: &u32| Some(tree.nodes[at as usize].parent).filter(|&parent| parent != TOP);
        let depth = |parent: u32| std::iter::successors(Some(parent), above).count();
        assert!(leaves.iter().all(|&parent| depth(parent) <= 11));
    }
}
