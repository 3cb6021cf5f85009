//! Which pairs of pieces are near: a list over boxes that leave room for motion, kept from query to query.
//!
//! Every pair of pieces whose distance is at most the list's tolerance τ is in the list: along each axis the gap between the two is
//! then at most τ, and each box is grown by at least τ/2. A query with a larger tolerance has all boxes fitted anew. What else the
//! list holds depends on how the objects came to where they are; so no answer may depend on that.

mod grid;
pub(crate) mod tree;
pub(crate) mod near_pairs;

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::{extend, reserve_sparingly};
use crate::base::workers::Workers;
use crate::scene::object::ObjectId;
use crate::scene::proxies::Proxies;
use crate::scene::rows::Label;
use grid::Grid;
use near_pairs::{Candidates, NearPairs, Testing};
use tree::{NONE, Scratch, Tree};

/// Above this part of all pieces, one in so many, all are refitted when some have left their boxes.
const MANY_ESCAPED: usize = 12;

/// After so many queries with smaller tolerances the list's follows.
const PATIENCE: u32 = 16;

/// Two trees, the boxes' tolerance, and the list.
#[derive(Debug)]
pub(crate) struct BroadPhase {
    pub near: NearPairs,
    /// Of pieces that move and of fixed ones, which never meet each other.
    trees: [Tree; 2],
    /// What each piece hangs on in its tree, or [`NONE`].
    parents: Vec<u32>,
    /// Whose boxes are not those of its pieces.
    is_stale: [bool; 2],
    /// For all moving pieces at once.
    grid: Grid,
    candidates: Candidates,
    scratch: Scratch,
    /// Whose pairs are looked for, of all pieces: less memory to read than their rows.
    is_open: Vec<bool>,
    /// τ: no pair is missing that is so near.
    tolerance: f64,
    /// Queries in a row whose tolerance was smaller, and the largest of those.
    smaller: (u32, f64),
    /// An update was not finished: everything is to be made anew.
    is_broken: bool,
    /// The list holds what the program has given.
    is_given: bool,
}

impl Default for BroadPhase {
    fn default() -> Self {
        BroadPhase {
            near: NearPairs::default(),
            trees: Default::default(),
            parents: Vec::new(),
            is_stale: [false; 2],
            grid: Grid::default(),
            candidates: Candidates::default(),
            scratch: Scratch::default(),
            is_open: Vec::new(),
            tolerance: 0.0,
            smaller: (0, 0.0),
            is_broken: false,
            is_given: false,
        }
    }
}

impl BroadPhase {
    /// Room for `count` more pieces.
    pub fn reserve(&mut self, count: usize) -> Result<()> {
        reserve_sparingly(&mut self.parents, count)
    }

    /// A piece was added.
    pub fn push(&mut self) {
        self.parents.push(NONE);
    }

    /// A piece has ended, or is to go to the other tree.
    pub fn take_out(&mut self, proxy: usize, fixed: bool) {
        if self.is_broken {
            self.parents[proxy] = NONE;
        } else if self.parents[proxy] != NONE {
            self.trees[usize::from(fixed)].remove(proxy as u32, &mut self.parents);
        }
    }

    /// Brings the list up to date for a query with this tolerance. `testing` says whether a pair that is new to it is tested.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the next call makes everything anew.
    pub fn update(
        &mut self,
        proxies: &mut Proxies,
        tolerance: f64,
        workers: &Workers,
        mut testing: impl FnMut([&Label; 2]) -> Testing,
    ) -> Result<()> {
        proxies.list_escaped();
        let refits_all = self.follow_tolerance(tolerance) | self.is_broken;
        if proxies.escaped.is_empty() && !refits_all {
            return Ok(());
        }
        if std::mem::replace(&mut self.is_broken, true) {
            self.parents.fill(NONE);
            self.trees = Default::default();
        }
        self.candidates.clear();
        if refits_all || proxies.escaped.len() * MANY_ESCAPED > proxies.len() - proxies.gone {
            self.refit_all(proxies, workers)?;
            self.find_all(proxies, workers)?;
            let is_tested = |pair: [u32; 2]| testing(pair.map(|proxy| &proxies.labels[proxy as usize]));
            self.near.update(&mut self.candidates, &proxies.firsts, |_| true, is_tested)?;
        } else {
            self.refit_escaped(proxies)?;
            self.find_escaped(proxies)?;
            let is_open = |[a, b]: [u32; 2]| self.is_open[a as usize] | self.is_open[b as usize];
            let is_tested = |pair: [u32; 2]| testing(pair.map(|proxy| &proxies.labels[proxy as usize]));
            self.near.update(&mut self.candidates, &proxies.firsts, is_open, is_tested)?;
        }
        for proxy in proxies.escaped.drain(..) {
            proxies.motions[proxy as usize].has_escaped = false;
        }
        self.is_broken = false;
        Ok(())
    }

    /// Boxes overlap of all that are not farther apart than this.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Gives back all room but what the near pairs need; the next update looks for all pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); nothing has changed then.
    pub fn shrink(&mut self) -> Result<()> {
        self.near.shrink()?;
        *self = BroadPhase {
            near: std::mem::take(&mut self.near),
            parents: std::mem::take(&mut self.parents),
            tolerance: self.tolerance,
            is_broken: true,
            ..BroadPhase::default()
        };
        Ok(())
    }

    /// A list of all pairs becomes one of those that are not farther apart than this.
    pub fn end_of_all_pairs(&mut self, tolerance: f64) {
        if self.tolerance == f64::INFINITY {
            (self.tolerance, self.smaller) = (tolerance, (0, 0.0));
            self.begin_anew();
        }
    }

    /// The next update looks for all pairs.
    pub fn begin_anew(&mut self) {
        self.is_broken = true;
        self.is_given = false;
    }

    /// Makes the list hold the pairs of these pieces, if it does not, each pair's in a range each.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the next call tries again.
    pub fn take(
        &mut self,
        proxies: &mut Proxies,
        pieces: impl Iterator<Item = (Range<usize>, Range<usize>)>,
        mut testing: impl FnMut([&Label; 2]) -> Testing,
    ) -> Result<()> {
        // Pieces that have moved or come stay in the list of escaped ones; of those gone the pairs have to go.
        if self.is_given && !proxies.has_news {
            return Ok(());
        }
        self.is_given = false;
        self.candidates.clear();
        for (pieces1, pieces2) in pieces {
            for piece1 in pieces1 {
                for piece2 in pieces2.clone() {
                    self.candidates.add_if_meeting(proxies, piece1 as u32, piece2 as u32)?;
                }
            }
        }
        let is_tested = |pair: [u32; 2]| testing(pair.map(|proxy| &proxies.labels[proxy as usize]));
        self.near.update(&mut self.candidates, &proxies.firsts, |_| true, is_tested)?;
        proxies.has_news = false;
        self.is_given = true;
        Ok(())
    }

    /// Makes room for a tolerance; whether all boxes are to be fitted anew.
    fn follow_tolerance(&mut self, tolerance: f64) -> bool {
        if tolerance >= self.tolerance {
            self.smaller = (0, 0.0);
            return std::mem::replace(&mut self.tolerance, tolerance) < tolerance;
        }
        let (count, largest) = self.smaller;
        self.smaller = (count + 1, largest.max(tolerance));
        if count < PATIENCE {
            return false;
        }
        self.tolerance = self.smaller.1;
        self.smaller = (0, 0.0);
        true
    }

    // --- All pieces --------------------------------------------------------------------------------------------------------------

    fn refit_all(&mut self, proxies: &mut Proxies, workers: &Workers) -> Result<()> {
        self.is_stale = [true; 2];
        let mut rows = proxies.rows();
        let count = rows.len();
        if workers.share(count) {
            let size = workers.part_size(count);
            let ends = (size..count).step_by(size).chain([count]);
            workers.map(rows.cut_at_each(ends), |mut rows| rows.refit_all(self.tolerance))?;
        } else {
            rows.refit_all(self.tolerance);
        }
        Ok(())
    }

    fn find_all(&mut self, proxies: &Proxies, workers: &Workers) -> Result<()> {
        self.fit_tree(true, proxies)?;
        self.list_tree(false, proxies)?;
        if self.grid.fill(&proxies.boxes, &self.scratch.proxies)? {
            return self.find_by_grid(proxies, workers);
        }
        self.fit_tree(false, proxies)?;
        let (candidates, scratch) = (&mut self.candidates, &mut self.scratch);
        let mut found = |a: u32, b: u32| candidates.add_if_meeting(proxies, a, b);
        let [moving, fixed] = &self.trees;
        moving.for_each_pair(&proxies.boxes, scratch, &mut found)?;
        moving.for_each_pair_with(fixed, &proxies.boxes, scratch, found)
    }

    /// Moving pieces meet each other in the grid, but for large ones, and fixed ones in their tree.
    fn find_by_grid(&mut self, proxies: &Proxies, workers: &Workers) -> Result<()> {
        if !self.grid.large.is_empty() {
            self.fit_tree(false, proxies)?;
        }
        let count = self.grid.cell_count();
        let find = |cells, candidates: &mut Candidates| {
            self.grid.for_each_pair(cells, |a, b| candidates.add_if_meeting(proxies, a, b))
        };
        let (candidates, scratch) = (&mut self.candidates, &mut self.scratch);
        if workers.share(proxies.len()) {
            let size = workers.part_size(count);
            let parts = (0..count).step_by(size).map(|first| first..(first + size).min(count));
            let find_part = |cells| {
                let mut candidates = Candidates::default();
                find(cells, &mut candidates).map(|()| candidates)
            };
            for part in workers.map(parts, find_part)? {
                candidates.append(&part?)?;
            }
        } else {
            find(0..count, candidates)?;
        }
        let [moving, fixed] = &self.trees;
        for &large in &self.grid.large {
            let found = |other: u32| candidates.add_if_meeting(proxies, large, other);
            moving.for_each_overlapping(&proxies.boxes[large as usize], &proxies.boxes, scratch, found)?;
        }
        if fixed.is_empty() {
            return Ok(());
        }
        for proxy in 0..proxies.len() as u32 {
            if belongs(proxies, proxy, false) {
                let found = |other: u32| candidates.add_if_meeting(proxies, proxy, other);
                fixed.for_each_overlapping(&proxies.boxes[proxy as usize], &proxies.boxes, scratch, found)?;
            }
        }
        Ok(())
    }

    /// Fits a tree to the boxes of all its pieces if it is not.
    fn fit_tree(&mut self, fixed: bool, proxies: &Proxies) -> Result<()> {
        let tree = usize::from(fixed);
        if !self.is_stale[tree] {
            return Ok(());
        }
        let is_missing = |&proxy: &u32| self.parents[proxy as usize] == NONE && belongs(proxies, proxy, fixed);
        let has_all = !(0..proxies.len() as u32).any(|proxy| is_missing(&proxy));
        if !(has_all && self.trees[tree].refit(&proxies.boxes, &mut self.scratch)?) {
            self.list_tree(fixed, proxies)?;
            self.trees[tree].build(&mut self.scratch, &proxies.boxes, &mut self.parents)?;
        }
        self.is_stale[tree] = false;
        Ok(())
    }

    /// The pieces that belong into a tree.
    fn list_tree(&mut self, fixed: bool, proxies: &Proxies) -> Result<()> {
        self.scratch.proxies.clear();
        let inside = (0..proxies.len() as u32).filter(|&proxy| belongs(proxies, proxy, fixed));
        extend(&mut self.scratch.proxies, inside)
    }

    // --- A few pieces ------------------------------------------------------------------------------------------------------------

    fn refit_escaped(&mut self, proxies: &mut Proxies) -> Result<()> {
        for k in 0..proxies.escaped.len() {
            let proxy = proxies.escaped[k] as usize;
            if !proxies.is_gone(proxy) {
                proxies.refit(proxy, self.tolerance);
            }
        }
        for fixed in [false, true] {
            self.is_stale[usize::from(fixed)] |= self.trees[usize::from(fixed)].is_worn();
            self.fit_tree(fixed, proxies)?;
        }
        let is_there = |&&proxy: &&u32| !proxies.is_gone(proxy as usize);
        let tree = |proxy: u32| usize::from(proxies.labels[proxy as usize].fixed);
        // First what is in a tree: a leaf comes beside others only once these are held.
        for &proxy in proxies.escaped.iter().filter(is_there) {
            let parent = self.parents[proxy as usize];
            if parent != NONE {
                self.trees[tree(proxy)].enlarge(parent, &proxies.boxes[proxy as usize]);
            }
        }
        for &proxy in proxies.escaped.iter().filter(is_there) {
            if self.parents[proxy as usize] == NONE {
                self.trees[tree(proxy)].insert(proxy, &proxies.boxes, &mut self.parents)?;
            }
        }
        Ok(())
    }

    fn find_escaped(&mut self, proxies: &Proxies) -> Result<()> {
        self.is_open.clear();
        extend(&mut self.is_open, proxies.motions.iter().map(|motion| motion.has_escaped))?;
        let (candidates, scratch) = (&mut self.candidates, &mut self.scratch);
        let [moving, fixed] = &self.trees;
        for &proxy in &proxies.escaped {
            let at = proxy as usize;
            if proxies.is_gone(at) {
                continue;
            }
            let mut found = |other: u32| candidates.add_if_meeting(proxies, proxy, other);
            moving.for_each_overlapping(&proxies.boxes[at], &proxies.boxes, scratch, &mut found)?;
            if !proxies.labels[at].fixed {
                fixed.for_each_overlapping(&proxies.boxes[at], &proxies.boxes, scratch, found)?;
            }
        }
        Ok(())
    }

    // --- Renumbering -------------------------------------------------------------------------------------------------------------

    /// Drops the rows of pieces that are gone, once there are many, if there is memory. No pair of theirs is in an up-to-date list.
    /// Gives the new numbers.
    pub fn renumber(&mut self, proxies: &mut Proxies) -> Option<Vec<u32>> {
        let numbers = proxies.renumbering().ok()?;
        self.near.renumber(&numbers);
        self.trees.iter_mut().for_each(|tree| tree.renumber(&numbers));
        let mut proxy = 0;
        self.parents.retain(|_| {
            proxy += 1;
            !proxies.is_gone(proxy - 1)
        });
        proxies.compact();
        Some(numbers)
    }
}

/// Whether a piece is to be in the tree of fixed ones, or in the other.
fn belongs(proxies: &Proxies, proxy: u32, fixed: bool) -> bool {
    let label = &proxies.labels[proxy as usize];
    (label.object != ObjectId::NULL) & (label.fixed == fixed)
}
