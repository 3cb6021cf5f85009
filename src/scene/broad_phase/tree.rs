//! A dynamic tree of boxes: leaves come, go and grow one at a time, all boxes are refitted at once, and it is built anew where it
//! has become loose. Where a call lacks memory the tree is good for nothing but to be built anew.

use crate::base::error::Result;
use crate::base::memory::{push, reserve};
use crate::scene::boxes::Aabb;

/// Room for what traversals and builds have still to visit, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    nodes: Vec<(u32, u32)>,
    ranges: Vec<(usize, usize, u32)>,
    /// The proxies over which a tree is to be built.
    pub proxies: Vec<u32>,
}

/// No node.
pub(crate) const NONE: u32 = u32::MAX;

/// A tree whose boxes have grown to so many times their girth when built is built anew.
const LOOSE: f32 = 1.5;

/// So many leaves may come, go or grow before all boxes are refitted, or a quarter of all.
const FEW_CHANGES: usize = 64;

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Aabb,
    parent: u32,
    /// Two nodes, or [`NONE`] and the proxy of a leaf.
    children: [u32; 2],
}

impl Node {
    fn leaf(proxy: u32, bounds: Aabb, parent: u32) -> Node {
        Node { bounds, parent, children: [NONE, proxy] }
    }

    #[inline(always)]
    fn proxy(&self) -> Option<u32> {
        (self.children[0] == NONE).then_some(self.children[1])
    }
}

/// A binary tree over the boxes of proxies.
#[derive(Debug)]
pub(crate) struct Tree {
    nodes: Vec<Node>,
    root: u32,
    /// Nodes to be used again; with room for all.
    free: Vec<u32>,
    leaf_count: usize,
    /// Leaves that have come, gone or grown since all boxes were refitted.
    changes: usize,
    /// Leaves that have come or gone since it was built: till then parents come before their children.
    patches: usize,
    /// Sum of the girths of all parents when it was built.
    girth_built: f32,
}

impl Default for Tree {
    fn default() -> Self {
        let (nodes, free) = (Vec::new(), Vec::new());
        Tree { nodes, root: NONE, free, leaf_count: 0, changes: 0, patches: 0, girth_built: 0.0 }
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

    /// Adds a leaf, beside what grows least on the way down, and gives its node.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn insert(&mut self, proxy: u32, bounds: Aabb) -> Result<u32> {
        reserve(&mut self.nodes, 2)?;
        let room = self.nodes.len() + 2 - self.free.len();
        reserve(&mut self.free, room)?;
        self.changes += 1;
        self.leaf_count += 1;
        self.patches += 1;
        let leaf = self.add(Node::leaf(proxy, bounds, NONE));
        if self.root == NONE {
            self.root = leaf;
            return Ok(leaf);
        }
        let mut beside = self.root;
        while self.nodes[beside as usize].proxy().is_none() {
            let node = &mut self.nodes[beside as usize];
            node.bounds = node.bounds.union(&bounds);
            let [left, right] = node.children;
            let growth = |child: u32| {
                let old = &self.nodes[child as usize].bounds;
                old.union(&bounds).girth() - 0.5 * old.girth()
            };
            beside = if growth(left) <= growth(right) { left } else { right };
        }
        let Node { parent, bounds: other, .. } = self.nodes[beside as usize];
        let joint = self.add(Node { bounds: other.union(&bounds), parent, children: [beside, leaf] });
        self.nodes[beside as usize].parent = joint;
        self.nodes[leaf as usize].parent = joint;
        self.replace_child(parent, beside, joint);
        Ok(leaf)
    }

    /// There is room for it.
    fn add(&mut self, node: Node) -> u32 {
        if let Some(place) = self.free.pop() {
            self.nodes[place as usize] = node;
            return place;
        }
        self.nodes.push(node);
        self.nodes.len() as u32 - 1
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        if parent == NONE {
            self.root = new;
            return;
        }
        let children = &mut self.nodes[parent as usize].children;
        children[usize::from(children[1] == old)] = new;
    }

    /// Removes a leaf.
    pub fn remove(&mut self, leaf: u32) {
        self.changes += 1;
        self.leaf_count -= 1;
        self.patches += 1;
        let parent = self.nodes[leaf as usize].parent;
        self.free.push(leaf);
        if parent == NONE {
            self.root = NONE;
            return;
        }
        let Node { children, parent: above, .. } = self.nodes[parent as usize];
        let sibling = children[usize::from(children[0] == leaf)];
        self.nodes[sibling as usize].parent = above;
        self.replace_child(above, parent, sibling);
        self.free.push(parent);
    }

    /// Gives a leaf another box, and makes those above hold it.
    pub fn enlarge(&mut self, leaf: u32, bounds: &Aabb) {
        self.changes += 1;
        self.nodes[leaf as usize].bounds = *bounds;
        let mut at = self.nodes[leaf as usize].parent;
        while at != NONE && !self.nodes[at as usize].bounds.contains(bounds) {
            let node = &mut self.nodes[at as usize];
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
            self.list_downwards(scratch)?;
            self.refit_upwards(scratch.nodes.iter().rev().map(|&(node, _)| node), boxes)
        };
        // A NaN, of boxes without end, is as good as any.
        Ok(!(girth > LOOSE * self.girth_built))
    }

    /// All nodes in use, parents before their children.
    fn list_downwards(&self, scratch: &mut Scratch) -> Result<()> {
        let nodes = &mut scratch.nodes;
        nodes.clear();
        if self.root != NONE {
            push(nodes, (self.root, NONE))?;
        }
        let mut next = 0;
        while let Some(&(at, _)) = nodes.get(next) {
            let node = &self.nodes[at as usize];
            if node.proxy().is_none() {
                push(nodes, (node.children[0], NONE))?;
                push(nodes, (node.children[1], NONE))?;
            }
            next += 1;
        }
        Ok(())
    }

    /// Children first; gives the sum of the girths of all parents.
    fn refit_upwards(&mut self, nodes: impl Iterator<Item = u32>, boxes: &[Aabb]) -> f32 {
        let mut girth = 0.0;
        for at in nodes {
            let node = &self.nodes[at as usize];
            self.nodes[at as usize].bounds = match node.proxy() {
                Some(proxy) => boxes[proxy as usize],
                None => {
                    let [left, right] = node.children.map(|child| self.nodes[child as usize].bounds);
                    let bounds = left.union(&right);
                    girth += bounds.girth();
                    bounds
                }
            };
        }
        girth
    }

    /// Builds it over `scratch.proxies`, top down; `leaves` gets their nodes.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn build(&mut self, scratch: &mut Scratch, boxes: &[Aabb], leaves: &mut [u32]) -> Result<()> {
        let Scratch { ranges: open, proxies, .. } = scratch;
        let count = proxies.len();
        let node_count = (2 * count).saturating_sub(1);
        self.nodes.clear();
        self.free.clear();
        reserve(&mut self.nodes, node_count)?;
        reserve(&mut self.free, node_count)?;
        open.clear();
        if count > 0 {
            push(open, (0, count, NONE))?;
        }
        while let Some((first, end, parent)) = open.pop() {
            let at = self.nodes.len() as u32;
            if let Some(Node { children, .. }) = self.nodes.get_mut(parent as usize) {
                children[usize::from(children[0] != NONE)] = at;
            }
            if let [proxy] = proxies[first..end] {
                self.nodes.push(Node::leaf(proxy, boxes[proxy as usize], parent));
                leaves[proxy as usize] = at;
                continue;
            }
            self.nodes.push(Node { bounds: Aabb::NOWHERE, parent, children: [NONE; 2] });
            let half = first + split(&mut proxies[first..end], boxes);
            push(open, (half, end, at))?;
            push(open, (first, half, at))?;
        }
        self.root = if count == 0 { NONE } else { 0 };
        (self.leaf_count, self.changes, self.patches) = (count, 0, 0);
        self.girth_built = self.refit_upwards((0..node_count as u32).rev(), boxes);
        Ok(())
    }

    /// Numbers the proxies anew: number k of old becomes `numbers[k]`.
    pub fn renumber(&mut self, numbers: &[u32]) {
        for node in &mut self.nodes {
            // Nodes out of use may hold any number.
            if let Some(proxy) = node.proxy()
                && let Some(&new) = numbers.get(proxy as usize)
            {
                node.children[1] = new;
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
        scratch: &mut Scratch,
        mut found: impl FnMut(u32) -> Result<()>,
    ) -> Result<()> {
        let open = &mut scratch.nodes;
        open.clear();
        if self.root != NONE {
            push(open, (self.root, NONE))?;
        }
        while let Some((at, _)) = open.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.overlaps(bounds) {
                continue;
            }
            match node.proxy() {
                Some(proxy) => found(proxy)?,
                None => {
                    push(open, (node.children[0], NONE))?;
                    push(open, (node.children[1], NONE))?;
                }
            }
        }
        Ok(())
    }

    /// Calls `found` with all pairs of proxies whose boxes overlap, each once.
    ///
    /// # Errors
    /// As [`Tree::for_each_overlapping`].
    pub fn for_each_pair(&self, scratch: &mut Scratch, found: impl FnMut(u32, u32) -> Result<()>) -> Result<()> {
        self.cross(self, scratch, found)
    }

    /// Calls `found` with all pairs of a proxy of this tree and one of the other whose boxes overlap.
    ///
    /// # Errors
    /// As [`Tree::for_each_overlapping`].
    pub fn for_each_pair_with(
        &self,
        other: &Tree,
        scratch: &mut Scratch,
        found: impl FnMut(u32, u32) -> Result<()>,
    ) -> Result<()> {
        self.cross(other, scratch, found)
    }

    /// Both trees at once, from their roots down. Of a tree against itself a node meets itself, too.
    fn cross(&self, other: &Tree, scratch: &mut Scratch, mut found: impl FnMut(u32, u32) -> Result<()>) -> Result<()> {
        let is_same = std::ptr::eq(self, other);
        let open = &mut scratch.nodes;
        open.clear();
        if !self.is_empty() && !other.is_empty() {
            push(open, (self.root, other.root))?;
        }
        while let Some((at, beside)) = open.pop() {
            let (node, neighbour) = (&self.nodes[at as usize], &other.nodes[beside as usize]);
            if is_same && at == beside {
                if let ([left, right], None) = (node.children, node.proxy()) {
                    for pair in [(left, left), (right, right), (left, right)] {
                        push(open, pair)?;
                    }
                }
                continue;
            }
            if !node.bounds.overlaps(&neighbour.bounds) {
                continue;
            }
            match (node.proxy(), neighbour.proxy()) {
                (Some(proxy1), Some(proxy2)) => found(proxy1, proxy2)?,
                (None, Some(_)) => node.children.iter().try_for_each(|&child| push(open, (child, beside)))?,
                (Some(_), None) => neighbour.children.iter().try_for_each(|&child| push(open, (at, child)))?,
                (None, None) => {
                    for child in node.children {
                        for other_child in neighbour.children {
                            push(open, (child, other_child))?;
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
                leaves[proxy] = tree.insert(proxy as u32, boxes[proxy]).unwrap();
            } else if random.below(3) == 0 {
                tree.remove(leaves[proxy]);
                leaves[proxy] = NONE;
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
            tree.for_each_pair(&mut scratch, |a, b| push(&mut found, (a.min(b), a.max(b)))).unwrap();
            found.sort_unstable();
            let overlap = |a: u32, b: u32| boxes[a as usize].overlaps(&boxes[b as usize]);
            let pairs = |&a: &u32| inside.iter().filter(move |&&b| a < b && overlap(a, b)).map(move |&b| (a, b));
            let expected: Vec<(u32, u32)> = inside.iter().flat_map(pairs).collect();
            assert_eq!(found, expected);
            let asked = random_box(&mut random);
            let mut near = Vec::new();
            tree.for_each_overlapping(&asked, &mut scratch, |proxy| push(&mut near, proxy)).unwrap();
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
        let above = |&at: &u32| Some(tree.nodes[at as usize].parent).filter(|&parent| parent != NONE);
        let depth = |leaf: u32| std::iter::successors(Some(leaf), above).count();
        assert!(leaves.iter().all(|&leaf| depth(leaf) <= 12));
    }
}
