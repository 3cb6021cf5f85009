//! The walk down two trees at once: depth first, of each two pairs of nodes that with the lesser bound first. So a verdict comes to
//! the deepest overlap of boxes first, a distance to the nearest.

use super::between::{Between, opened};
use super::tree::{DEEPEST, TreeView};
use crate::base::error::Result;
use crate::base::simd::{self, Kernel, Lanes};

/// A pair of nodes is replaced by two, one of which is opened next: one waits for each step down either tree.
pub(super) const ROOM: usize = 2 * DEEPEST + 2;

/// Two trees of so many nodes together are small, as those of 8 pieces each: less room takes less to make.
const SMALL: usize = 32;

/// The questions of a walk about boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Aim {
    /// Whether they are apart.
    Verdict,
    /// How far.
    Distance,
}

/// Two nodes that are to be looked at.
#[derive(Clone, Copy)]
struct WaitingNodes {
    /// The signed distance of all in them is at least this.
    bound: f64,
    nodes: [u32; 2],
}

/// Two trees, and what is asked of them.
#[derive(Clone, Copy)]
pub(super) struct PiecePair<'a> {
    pub trees: [TreeView<'a>; 2],
    pub between: &'a Between,
    pub aim: Aim,
}

/// The signed distance of all is at least this.
#[inline(always)]
pub(super) fn root_bound(pair: &PiecePair) -> f64 {
    simd::dispatch(&mut Roots { pair })
}

/// Calls `ask` for each pair of pieces that boxes do not show to be farther apart than `enough`. It returns what is enough from
/// then on, or `None` to end the walk. Unless that ended it, the signed distance of all that was not asked is at least what is
/// returned.
///
/// # Errors
/// Those of `ask`.
#[inline(always)]
pub(super) fn walk(pair: PiecePair, enough: f64, ask: impl FnMut([u32; 2]) -> Result<Option<f64>>) -> Result<f64> {
    let root = root_bound(&pair);
    // Before there is room for a walk in memory: bodies that are far apart need none.
    if root > enough { Ok(root) } else { descend(pair, root, enough, ask) }
}

#[inline(never)]
fn descend(pair: PiecePair, root: f64, enough: f64, ask: impl FnMut([u32; 2]) -> Result<Option<f64>>) -> Result<f64> {
    let root = WaitingNodes { bound: root, nodes: [0; 2] };
    if pair.trees[0].nodes.len() + pair.trees[1].nodes.len() <= SMALL {
        // A tree of n pieces has 2n − 1 nodes and is no deeper than n − 1.
        descend_with(&mut [root; SMALL / 2 + 2], pair, enough, ask)
    } else {
        descend_with(&mut [root; ROOM], pair, enough, ask)
    }
}

fn descend_with(
    waiting: &mut [WaitingNodes],
    pair: PiecePair,
    enough: f64,
    mut ask: impl FnMut([u32; 2]) -> Result<Option<f64>>,
) -> Result<f64> {
    let mut walk = TreeWalk { pair, enough, passed: f64::INFINITY, waiting, count: 1 };
    while let Some(pieces) = simd::dispatch(&mut TreeDescent { walk: &mut walk }) {
        match ask(pieces)? {
            Some(enough) => walk.enough = enough,
            None => break,
        }
    }
    Ok(walk.passed)
}

/// A walk.
struct TreeWalk<'a> {
    pair: PiecePair<'a>,
    /// Pairs that are farther apart are passed by.
    enough: f64,
    /// All that has been passed by is at least this far apart.
    passed: f64,
    waiting: &'a mut [WaitingNodes],
    count: usize,
}

impl TreeWalk<'_> {
    /// Keeps a pair of nodes in mind, or passes it by.
    #[inline(always)]
    fn push(&mut self, waiting: WaitingNodes) {
        // False for a NaN, which rules nothing out.
        if waiting.bound > self.enough {
            self.pass(waiting.bound);
        } else {
            self.waiting[self.count] = waiting;
            self.count += 1;
        }
    }

    #[inline(always)]
    fn pass(&mut self, bound: f64) {
        if bound < self.passed {
            self.passed = bound;
        }
    }
}

/// The bound of all pieces together.
struct Roots<'a> {
    pair: &'a PiecePair<'a>,
}

impl Kernel for Roots<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> f64 {
        let PiecePair { trees: [a, b], between, .. } = self.pair;
        between.in_lanes::<L>().of_fitted(&a.nodes[0].fitted, &b.nodes[0].fitted)
    }
}

/// A NaN raises nothing.
#[inline(always)]
fn raise(bound: &mut f64, other: f64) {
    if other > *bound {
        *bound = other;
    }
}

/// Down to the next pair of pieces.
struct TreeDescent<'a, 'b> {
    walk: &'a mut TreeWalk<'b>,
}

impl Kernel for TreeDescent<'_, '_> {
    type Output = Option<[u32; 2]>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<[u32; 2]> {
        let walk = &mut *self.walk;
        if walk.count == 0 {
            return None;
        }
        let PiecePair { trees, between, aim } = walk.pair;
        let between = between.in_lanes::<L>();
        let [tree_a, tree_b] = trees;
        let crosses = aim == Aim::Verdict;
        while walk.count > 0 {
            walk.count -= 1;
            let WaitingNodes { bound, nodes } = walk.waiting[walk.count];
            if bound > walk.enough {
                walk.pass(bound);
                continue;
            }
            let Some(pairs) = opened(trees, nodes) else {
                let pieces = [tree_a.nodes[nodes[0] as usize].piece(), tree_b.nodes[nodes[1] as usize].piece()];
                let [Some(a), Some(b)] = pieces else { continue };
                return Some([a, b]);
            };
            let mut bounds = [0.0; 2];
            for (bound, pair) in bounds.iter_mut().zip(&pairs) {
                let [a, b] = [pair[0] as usize, pair[1] as usize];
                // Once it is known, the axis parts most.
                *bound = between.along_axis(&tree_a.oriented[a], &tree_b.oriented[b]);
                if !(*bound > walk.enough) {
                    raise(bound, between.of_fitted(&tree_a.nodes[a].fitted, &tree_b.nodes[b].fitted));
                }
                if !(*bound > walk.enough) {
                    raise(bound, between.of_oriented(&tree_a.oriented[a], &tree_b.oriented[b], crosses));
                }
            }
            let first = usize::from(bounds[1] < bounds[0]);
            walk.push(WaitingNodes { bound: bounds[1 - first], nodes: pairs[1 - first] });
            walk.push(WaitingNodes { bound: bounds[first], nodes: pairs[first] });
        }
        None
    }
}
