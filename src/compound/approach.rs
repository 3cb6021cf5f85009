//! Which pieces of two moving compounds may come near each other: both trees are walked in time.
//!
//! In a part of the range, nothing is farther from where it is in the middle of the part than [`MovingFrame::drift`] says. So a
//! bound of the distance there, less both drifts, holds for all of the part. Pairs of nodes that this does not rule out are opened
//! where they are larger than the drift, and wait for both halves of the part where they are smaller. Time goes forward, so that an
//! early contact ends the walk.

use std::collections::HashSet;

use super::MovingCompound;
use super::between::{Between, Reaches, opened};
use crate::base::error::Result;
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::memory::{filled, lacking, push};
use crate::base::simd::{self, Kernel, Lanes};
use crate::motion::{MovingFrame, Stop};

/// A part of the range is halved where the drift is more than this share of half a box's diagonal; the square of it.
const SHARE_SQUARED: f64 = 0.25;

/// No part is halved more often than that in a row.
const MOST_HALVINGS: u32 = 10;

/// Calls `ask` once for each two pieces that boxes do not show to be farther apart than `max_distance` at all times of the range,
/// about in the order in which they come near. It returns the time after which nothing counts any more, as `until` is before;
/// below the range nothing counts at all. What was not asked is at least so far apart as is returned, up to that time.
///
/// # Errors
/// Those of the motions, and of `ask`.
pub(super) fn approach(
    bodies: &[MovingCompound; 2],
    range: [f64; 2],
    max_distance: f64,
    until: f64,
    ask: &mut dyn FnMut([u32; 2]) -> Result<f64>,
) -> Result<f64> {
    debug_assert!(range[0] <= range[1] && max_distance >= 0.0);
    let frame = |i: usize| MovingFrame::new(bodies[i].motion, bodies[i].compound.reach.lever, range);
    let frames =
        [frame(0).map_err(|error| error.about("object 1"))?, frame(1).map_err(|error| error.about("object 2"))?];
    let mut approach = CompoundApproach {
        bodies,
        frames,
        max_distance,
        until,
        passed: f64::INFINITY,
        asked: HashSet::new(),
        open: filled([0; 2], 1)?,
        work: Vec::new(),
        ask,
    };
    let ends = [approach.stops(range[0])?, approach.stops(range[1])?];
    approach.visit([&ends[0], &ends[1]], 0, 0)?;
    Ok(approach.passed)
}

struct CompoundApproach<'a, 'b> {
    bodies: &'b [MovingCompound<'a>; 2],
    frames: [MovingFrame<'a>; 2],
    max_distance: f64,
    /// Nothing after it counts.
    until: f64,
    /// All that was passed by is at least so far apart.
    passed: f64,
    asked: HashSet<[u32; 2]>,
    /// Pairs of nodes that wait for a part of the range, each part's behind those of the part that it is a half of.
    open: Vec<[u32; 2]>,
    /// Those that are looked at in the present part.
    work: Vec<[u32; 2]>,
    ask: &'b mut dyn FnMut([u32; 2]) -> Result<f64>,
}

impl CompoundApproach<'_, '_> {
    fn stops(&self, time: f64) -> Result<[Stop; 2]> {
        Ok([self.frames[0].at(time)?, self.frames[1].at(time)?])
    }

    /// Goes through the pairs of nodes from `first` on in one part of the range.
    fn visit(&mut self, ends: [&[Stop; 2]; 2], first: usize, halvings: u32) -> Result<()> {
        debug_assert!(halvings <= MOST_HALVINGS && self.work.is_empty());
        let [begin, end] = ends.map(|stops| stops[0].time);
        if begin > self.until {
            return Ok(());
        }
        let middle = self.stops((0.5 * begin + 0.5 * end).clamp(begin, end))?;
        let drift = |i: usize| self.frames[i].drift([&ends[0][i], &middle[i], &ends[1][i]]);
        let drift = (drift(0) + drift(1)).next_up();
        let place = |i: usize| self.bodies[i].compound.at(&middle[i].pose).placed_pieces();
        let placed = [place(0), place(1)];
        let between = Between::new(&placed, &Reaches::new(&placed)?);
        let kept = self.open.len();
        for place in first..kept {
            push(&mut self.work, self.open[place])?;
        }
        let left = MOST_HALVINGS - halvings;
        let mut sieve = Sieve { approach: self, between, drift, left };
        while let Some(pieces) = simd::dispatch(&mut sieve)? {
            let approach = &mut *sieve.approach;
            let so_far = approach.asked.len() + 1;
            approach.asked.try_reserve(1).map_err(|e| lacking::<[u32; 2]>(so_far, &e))?;
            if approach.asked.insert(pieces) {
                approach.until = (approach.ask)(pieces)?;
                if begin > approach.until {
                    approach.work.clear();
                }
            }
        }
        if self.open.len() > kept {
            self.visit([ends[0], &middle], kept, halvings + 1)?;
            self.visit([&middle, ends[1]], kept, halvings + 1)?;
        }
        self.open.truncate(kept);
        Ok(())
    }
}

/// Down to the next pair of pieces of one part.
struct Sieve<'a, 'b, 'c> {
    approach: &'c mut CompoundApproach<'a, 'b>,
    between: Between,
    drift: f64,
    /// So often the part may be halved yet.
    left: u32,
}

impl Kernel for Sieve<'_, '_, '_> {
    type Output = Result<Option<[u32; 2]>>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Result<Option<[u32; 2]>> {
        let CompoundApproach { bodies, max_distance, passed, open, work, .. } = &mut *self.approach;
        let [tree_a, tree_b] = [bodies[0].compound.tree.view(), bodies[1].compound.tree.view()];
        let between = self.between.in_lanes::<L>();
        let drift = self.drift;
        let enough = (*max_distance + drift) * (1.0 + 4.0 * U);
        let squared = drift * drift;
        // Half the time takes the drift of a constant speed to half, that of an acceleration to a quarter.
        let in_the_end = squared * 0.0625_f64.powi(self.left as i32);
        while let Some(nodes) = work.pop() {
            let [a, b] = nodes.map(|node| node as usize);
            let mut bound = between.of_fitted(&tree_a.nodes[a].fitted, &tree_b.nodes[b].fitted);
            if !(bound > enough) {
                bound = between.of_oriented(&tree_a.oriented[a], &tree_b.oriented[b], false).max(bound);
            }
            // False for a NaN, which rules nothing out.
            if bound > enough {
                // The difference is off by u of it.
                *passed = passed.min((bound - drift) * (1.0 - 2.0 * U)).max(*max_distance);
                continue;
            }
            let most = SHARE_SQUARED * tree_a.nodes[a].size.max(tree_b.nodes[b].size);
            if squared > most && in_the_end <= most {
                push(open, nodes)?;
                continue;
            }
            match opened([tree_a, tree_b], nodes) {
                Some([one, other]) => {
                    push(work, other)?;
                    push(work, one)?;
                }
                None => {
                    let pieces = [tree_a.nodes[a].piece(), tree_b.nodes[b].piece()];
                    if let [Some(one), Some(other)] = pieces {
                        return Ok(Some([one, other]));
                    }
                }
            }
        }
        Ok(None)
    }
}
