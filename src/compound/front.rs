//! The front of two compounds: where a walk has ended, so that the next verdict begins there (the generalized front of S. A. Ehmann
//! & M. C. Lin, "Accurate and Fast Proximity Queries between Polyhedra Using Convex Surface Decomposition", 2001).
//!
//! It is kept as what was done with each pair of nodes, in order: opened, or parted by which test. Whatever bytes these are, a walk
//! that follows them from the roots comes past all pairs of pieces. No bound is kept: from a cache that may hold any bytes it
//! would prove nothing. Pairs of nodes that were opened are opened again without a test; others first meet the test that parted
//! them, and are opened where no test does. The roots and pairs of pieces are always tested.

use super::between::{Between, InLanes, opened};
use super::tree::TreeView;
use super::walk::{Aim, PiecePair, ROOM, root_bound};
use crate::base::error::Result;
use crate::base::memory::{filled, push};
use crate::base::simd::{self, Kernel, Lanes};

/// So many steps are kept. Pairs of nodes behind them are looked at anew.
const MOST_STEPS: usize = 248;

/// A front of more than so many times the steps that it had at first is dropped.
const MOST_GROWTH: u32 = 3;

/// A front is of use while points are, against the other compound, no farther from where it began than about this share of the
/// lesser lever: what it has opened may part there.
const NEAR: f64 = 0.5;

/// What was done with a pair of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum FrontStep {
    Unknown,
    /// It was opened; of two pieces, they were asked.
    Opened,
    /// The boxes along the bodies' axes parted it.
    Fitted,
    /// The turned boxes did.
    Oriented,
}

impl FrontStep {
    #[inline(always)]
    fn of(byte: u8) -> FrontStep {
        match byte {
            1 => FrontStep::Opened,
            2 => FrontStep::Fitted,
            3 => FrontStep::Oriented,
            _ => FrontStep::Unknown,
        }
    }
}

/// The front that a cache keeps. Any bytes are safe; all zero is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub(crate) struct Front {
    /// How the compounds were placed against each other.
    place: [[u32; 4]; 4],
    /// The number of steps at first.
    first_count: u32,
    count: u32,
    steps: [u8; MOST_STEPS],
}

impl Default for Front {
    fn default() -> Self {
        Front { place: [[0; 4]; 4], first_count: 0, count: 0, steps: [0; MOST_STEPS] }
    }
}

impl Front {
    /// Whether a walk at this place is to follow the front: it began near here. A new one begins here.
    pub(super) fn is_near(&mut self, between: &Between) -> bool {
        // False for a NaN.
        let is_near = between.change_since(&self.place) <= NEAR * between.lever();
        if !is_near {
            self.count = 0;
        }
        if self.count == 0 {
            self.place = between.place();
        }
        is_near
    }

    /// The pairs of nodes where the last walk ended: of each tree the first of the node's leaves, and the one behind the last.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub(super) fn tiles(&self, trees: [TreeView; 2]) -> Result<Vec<[[u32; 2]; 2]>> {
        let leaves = trees.map(|tree| [0, tree.nodes.len().div_ceil(2) as u32]);
        let (mut tiles, mut waiting, mut at) = (Vec::new(), filled(([0; 2], leaves), 1)?, 0);
        while let Some((nodes, leaves)) = waiting.pop() {
            let is_opened = self.step(at) == FrontStep::Opened;
            at += 1;
            let halves = opened(trees, nodes);
            let Some([first, second]) = halves.filter(|_| is_opened) else {
                push(&mut tiles, leaves)?;
                continue;
            };
            let side = usize::from(first[0] == nodes[0]);
            // Nodes are in pre-order, and n leaves have 2n − 1 of them.
            let middle = leaves[side][0] + (second[side] - first[side]).div_ceil(2);
            let mut parts = [leaves; 2];
            (parts[0][side][1], parts[1][side][0]) = (middle, middle);
            push(&mut waiting, (second, parts[1]))?;
            push(&mut waiting, (first, parts[0]))?;
        }
        Ok(tiles)
    }

    #[inline(always)]
    fn step(&self, at: usize) -> FrontStep {
        if at < (self.count as usize).min(MOST_STEPS) { FrontStep::of(self.steps[at]) } else { FrontStep::Unknown }
    }

    #[inline(always)]
    fn add(&mut self, step: FrontStep) {
        let count = self.count as usize;
        if count < MOST_STEPS {
            self.steps[count] = step as u8;
            self.count += 1;
        }
    }
}

/// Calls `ask` for each pair of pieces that boxes do not show to be apart, until it returns false. If it never does, the signed
/// distance of all that was not asked is at least what is returned. It goes along the front, and leaves its own there.
///
/// # Errors
/// Those of `ask`.
pub(super) fn follow(front: &mut Front, pair: PiecePair, mut ask: impl FnMut([u32; 2]) -> Result<bool>) -> Result<f64> {
    debug_assert!(pair.aim == Aim::Verdict);
    let root = root_bound(&pair);
    if root > 0.0 {
        return Ok(root);
    }
    let mut walk = FrontWalk {
        pair,
        before: front,
        at: 0,
        now: Front { count: 0, ..*front },
        waiting: [[0; 2]; ROOM],
        count: 1,
        new_from: usize::MAX,
        passed: f64::INFINITY,
    };
    while let Some(pieces) = simd::dispatch(&mut walk) {
        if !ask(pieces)? {
            break;
        }
    }
    let FrontWalk { mut now, passed, .. } = walk;
    let first_count = if front.count == 0 { now.count } else { front.first_count };
    let is_cut_off = now.count > first_count && now.count as usize == MOST_STEPS;
    now.first_count = first_count;
    if is_cut_off || now.count > first_count.saturating_mul(MOST_GROWTH) {
        now.count = 0;
    }
    *front = now;
    Ok(passed)
}

/// A walk along a front.
struct FrontWalk<'a> {
    pair: PiecePair<'a>,
    before: &'a Front,
    /// The next step of before.
    at: usize,
    now: Front,
    waiting: [[u32; 2]; ROOM],
    count: usize,
    /// Pairs of nodes that wait from here on come of one that was parted before: the front knows no step of theirs.
    new_from: usize,
    /// All that was parted is at least this far apart.
    passed: f64,
}

impl FrontWalk<'_> {
    #[inline(always)]
    fn part(&mut self, bound: f64, step: FrontStep) {
        if bound < self.passed {
            self.passed = bound;
        }
        self.now.add(step);
    }
}

/// Down to the next pair of pieces.
impl Kernel for FrontWalk<'_> {
    type Output = Option<[u32; 2]>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<[u32; 2]> {
        let PiecePair { trees, between, .. } = self.pair;
        let between: InLanes<L> = between.in_lanes();
        while self.count > 0 {
            self.count -= 1;
            let nodes = self.waiting[self.count];
            let is_new = self.count >= self.new_from;
            let mut step = FrontStep::Unknown;
            if !is_new {
                self.new_from = usize::MAX;
                step = self.before.step(self.at);
                self.at += 1;
            }
            let halves = opened(trees, nodes);
            // Boxes of pieces are tried again: that is cheaper than to ask.
            if step != FrontStep::Opened || halves.is_none() {
                let [a, b] = [nodes[0] as usize, nodes[1] as usize];
                if step != FrontStep::Oriented {
                    let bound = between.of_fitted(&trees[0].nodes[a].fitted, &trees[1].nodes[b].fitted);
                    if bound > 0.0 {
                        self.part(bound, FrontStep::Fitted);
                        continue;
                    }
                }
                let bound = between.of_oriented(&trees[0].oriented[a], &trees[1].oriented[b], true);
                if bound > 0.0 {
                    self.part(bound, FrontStep::Oriented);
                    continue;
                }
                if !is_new {
                    self.new_from = self.count;
                }
            }
            self.now.add(FrontStep::Opened);
            match halves {
                Some([first, second]) => {
                    self.waiting[self.count] = second;
                    self.waiting[self.count + 1] = first;
                    self.count += 2;
                }
                None => {
                    let pieces = [trees[0].nodes[nodes[0] as usize].piece(), trees[1].nodes[nodes[1] as usize].piece()];
                    if let [Some(a), Some(b)] = pieces {
                        return Some([a, b]);
                    }
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{Matrix, Pose, Vector};
    use crate::compound::between::Reaches;
    use crate::compound::placed::{PlacedPieces, with_pieces};
    use crate::compound::{Compound, Piece};
    use crate::pair::{PairConfig, SignedDistance, SignedDistanceCache, signed_distance};
    use crate::shape::{InputPolicy, Shape, ShapeOptions};
    use std::collections::BTreeSet;
    use std::sync::Arc;
    use swiftprox::random::Random;

    fn compound(points_of: impl Fn(usize) -> Vec<Vector>, count: usize) -> Compound {
        let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
        let shape = |k| Arc::new(Shape::from_points(&points_of(k), &options).unwrap());
        let pieces: Vec<Piece> = (0..count).map(|k| Piece { shape: shape(k), pose: Pose::IDENTITY }).collect();
        Compound::new(&pieces).unwrap()
    }

    fn scattered(random: &mut Random, count: usize) -> Compound {
        let clouds: Vec<Vec<Vector>> = (0..count)
            .map(|_| {
                let middle = random.vector();
                (0..4).map(|_| random.vector() * 0.6 + middle).collect()
            })
            .collect();
        compound(|k| clouds[k].clone(), count)
    }

    fn ring(count: usize) -> Compound {
        let corner = |step: usize, radius: f64, z: f64| {
            let angle = std::f64::consts::TAU * step as f64 / count as f64;
            Vector::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        let sector = |k: usize| [k, k + 1].map(|s| [0.7, 1.3].map(|r| [-0.3, 0.3].map(|z| corner(s, r, z))));
        compound(|k| sector(k).as_flattened().as_flattened().to_vec(), count)
    }

    /// The pieces that are asked, and the bound of all others.
    fn followed(front: &mut Front, placed: &[PlacedPieces; 2]) -> (BTreeSet<[u32; 2]>, f64) {
        let between = Between::new(placed, &Reaches::new(placed).unwrap());
        let mut asked = BTreeSet::new();
        let pair = PiecePair { trees: placed.map(|body| body.tree), between: &between, aim: Aim::Verdict };
        let passed = follow(front, pair, |pieces| {
            assert!(asked.insert(pieces), "asked twice");
            Ok(true)
        });
        (asked, passed.unwrap())
    }

    /// Each leaf of the one with each of the other is in one tile.
    fn check_cover(front: &Front, bodies: [&Compound; 2]) {
        let mut covered = vec![0; bodies[0].piece_count() * bodies[1].piece_count()];
        for [a, b] in front.tiles(bodies.map(|body| body.tree.view())).unwrap() {
            for leaf in (a[0]..a[1]).flat_map(|i| (b[0]..b[1]).map(move |j| [i as usize, j as usize])) {
                covered[leaf[0] * bodies[1].piece_count() + leaf[1]] += 1;
            }
        }
        assert!(covered.iter().all(|count| *count == 1), "{covered:?}");
    }

    /// With steps of any bytes, of other bodies and of other poses.
    #[test]
    fn whatever_is_remembered_all_pieces_are_passed() {
        let mut random = Random::new(0xf407);
        let (mut asked_in_all, mut parted_in_all) = (0, 0);
        for round in 0..if cfg!(miri) { 2 } else { 200 } {
            let most = if round % 20 == 0 { 20 } else { 7 };
            let counts = [1 + random.below(most), 1 + random.below(most)];
            let bodies = counts.map(|count| scattered(&mut random, count));
            let mut front = Front::default();
            if round % 2 == 0 {
                front.count = if round % 4 == 0 { random.next_u64() as u32 } else { random.below(120) as u32 };
                front.first_count = if random.below(3) == 0 { 0 } else { random.next_u64() as u32 };
                front.steps = std::array::from_fn(|_| random.below(5 + 50 * (round % 4)) as u8);
                front.place = std::array::from_fn(|_| std::array::from_fn(|_| random.next_u64() as u32));
            }
            check_cover(&front, [&bodies[0], &bodies[1]]);
            for _ in 0..3 {
                let poses = [0, 1].map(|_| Pose::new(&random.rotation(), &(random.vector() * 1.5)));
                let placed = [0, 1].map(|i| bodies[i].at(&poses[i]).placed_pieces());
                let (asked, passed) = followed(&mut front, &placed);
                check_cover(&front, [&bodies[0], &bodies[1]]);
                for pieces in (0..counts[0] as u32).flat_map(|i| (0..counts[1] as u32).map(move |j| [i, j])) {
                    let mut found = SignedDistance::default();
                    with_pieces(&placed, pieces, |placed| {
                        let mut cache = SignedDistanceCache::default();
                        signed_distance(placed, &mut cache, &PairConfig::default(), &mut found).unwrap();
                    });
                    assert!(asked.contains(&pieces) || found.upper >= passed, "{round}: {pieces:?}");
                }
                asked_in_all += asked.len();
                parted_in_all += usize::from(passed > 0.0 && passed < f64::INFINITY);
            }
        }
        assert!(cfg!(miri) || asked_in_all > 300 && parted_in_all > 200, "{asked_in_all} {parted_in_all}");
    }

    /// Linked rings that tremble: the front is kept, and grows by little. Far from where it began there is a new one.
    #[test]
    fn a_front_is_followed_while_it_is_near() {
        let (ring, mut random) = (ring(24), Random::new(0x11f));
        let mut front = Front::default();
        let place = |front: &mut Front, offset: Vector, turn: &Matrix| {
            let poses = [Pose::new(turn, &offset), Pose::IDENTITY];
            let placed = [0, 1].map(|i| ring.at(&poses[i]).placed_pieces());
            let is_near = front.is_near(&Between::new(&placed, &Reaches::new(&placed).unwrap()));
            let (asked, passed) = followed(front, &placed);
            assert!(asked.is_empty() && passed > 0.0);
            is_near
        };
        let upright = Matrix::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
        place(&mut front, Vector::x(), &upright);
        let first = front.count;
        for _ in 0..20 {
            assert!(place(&mut front, Vector::x() + random.vector() * 0.02, &upright));
            assert!(front.count >= first && front.count <= 2 * first, "{first} {}", front.count);
        }
        // Slowly along the other ring: steps are small, the way from where it began is not.
        let is_new = (1..60).map(|step| {
            let (sin, cos) = (0.05 * f64::from(step)).sin_cos();
            let turn = Matrix::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
            !place(&mut front, turn * Vector::x(), &(turn * upright))
        });
        assert!((4..30).contains(&is_new.filter(|is_new| *is_new).count()));
        assert!(!place(&mut front, -Vector::x(), &upright.transpose()));
    }

    /// One that has more than tripled is dropped, and so is one that no longer holds all steps.
    #[test]
    fn a_front_that_has_grown_is_dropped() {
        let ring = ring(24);
        let upright = Pose::new(&Matrix::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0), &Vector::x());
        let placed = [ring.at(&upright).placed_pieces(), ring.at(&Pose::IDENTITY).placed_pieces()];
        let mut fresh = Front::default();
        followed(&mut fresh, &placed);
        assert!(fresh.first_count == fresh.count && fresh.count > 20);
        for (first_count, is_kept) in [(fresh.count, true), (fresh.count / 3 + 1, true), (fresh.count / 3 - 1, false)] {
            let mut front = Front { first_count, ..fresh };
            followed(&mut front, &placed);
            assert_eq!(front.count, if is_kept { fresh.count } else { 0 });
        }
        let opened = Front { count: MOST_STEPS as u32, first_count: 200, steps: [1; MOST_STEPS], ..fresh };
        let mut front = opened;
        followed(&mut front, &placed);
        assert_eq!(front.count, 0);
        front = Front { first_count: MOST_STEPS as u32, ..opened };
        followed(&mut front, &placed);
        assert_eq!(front.count, MOST_STEPS as u32);
    }
}
