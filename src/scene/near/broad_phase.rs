//! The list of near pairs brought up to date: from trees over boxes, from a grid where all is new, or from what the program gives.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::memory::{extend, push, reserve_sparingly};
use crate::base::workers::Workers;
use crate::scene::near::candidates::Candidates;
use crate::scene::near::grid::Grid;
use crate::scene::near::near_pairs::NearPairs;
use crate::scene::near::tolerance::ListTolerance;
use crate::scene::near::tree::{NONE, Scratch, Tree};
use crate::scene::world::content::World;
use crate::scene::world::object::ObjectId;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::testing::{Decided, Rules, Testing};

/// Above this part of all pieces, one in this many, all are refitted when some have left their boxes.
const MANY_ESCAPED: usize = 12;

/// The list, and what it is found with.
#[derive(Debug)]
pub(crate) struct BroadPhase {
    pub list: NearPairs,
    listing: Listing,
    /// The news on the testing of pairs that the listed pairs have not received yet.
    news: News,
    /// The trees of moving pieces and of fixed ones, which never meet each other.
    trees: [Tree; 2],
    /// The parent of each piece in its tree, or [`NONE`].
    parents: Vec<u32>,
    /// For all moving pieces at once.
    grid: Grid,
    candidates: Candidates,
    scratch: Scratch,
    /// Which of all pieces need their pairs looked for: less memory to read than their rows.
    is_open: Vec<bool>,
    tolerance: ListTolerance,
    /// All pairs of few pieces are listed, regardless of the tolerance.
    lists_few: bool,
}

/// The content of the list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Listing {
    /// Its earlier content does not matter: the next update makes it and the trees anew.
    OutOfDate,
    /// The pairs of boxes that overlap, except those of pieces that have escaped since.
    Overlaps,
    /// The pairs that the program gave last. The trees are out of date.
    Given,
}

/// The news for the near pairs, the later including the earlier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum News {
    None,
    /// Activation has changed.
    Activation,
    /// All must be filtered anew.
    Filter,
}

impl Default for BroadPhase {
    fn default() -> Self {
        BroadPhase {
            list: NearPairs::default(),
            listing: Listing::Overlaps,
            news: News::None,
            trees: Default::default(),
            parents: Vec::new(),
            grid: Grid::default(),
            candidates: Candidates::default(),
            scratch: Scratch::default(),
            is_open: Vec::new(),
            tolerance: ListTolerance::default(),
            lists_few: false,
        }
    }
}

impl BroadPhase {
    // --- Changes -----------------------------------------------------------------------------------------------------------------

    /// Room for `count` more pieces.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn reserve(&mut self, count: usize) -> Result<()> {
        reserve_sparingly(&mut self.parents, count)
    }

    /// Pieces were added, up to `count`; there is room for them.
    pub fn grow(&mut self, count: usize) {
        debug_assert!(count >= self.parents.len());
        self.parents.resize(count, NONE);
    }

    /// Pieces are to end, or to go to the other tree.
    pub fn take_out(&mut self, pieces: Range<usize>, fixed: bool) {
        for proxy in pieces {
            if self.listing != Listing::Overlaps {
                self.parents[proxy] = NONE;
            } else if self.parents[proxy] != NONE {
                self.trees[usize::from(fixed)].remove(proxy as u32, &mut self.parents);
            }
        }
    }

    /// A setting on the testing of pairs was made.
    pub fn hear(&mut self, news: News) {
        self.news = self.news.max(news);
    }

    /// The pair of two objects was activated or deactivated.
    pub fn set_active(&mut self, world: &World, [object1, object2]: [ObjectId; 2], active: bool) {
        let testing = if active { Testing::Active } else { Testing::Inactive };
        for proxy1 in world.rows_of(object1) {
            for proxy2 in world.rows_of(object2) {
                self.list.set_testing(&world.proxies.firsts, [proxy1 as u32, proxy2 as u32], testing);
            }
        }
    }

    /// The next update looks for all pairs.
    pub fn begin_anew(&mut self) {
        self.listing = Listing::OutOfDate;
    }

    /// Gives back all room but what the near pairs need; the next update looks for all pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); nothing has changed then.
    pub fn shrink(&mut self) -> Result<()> {
        self.list.shrink()?;
        *self = BroadPhase {
            list: std::mem::take(&mut self.list),
            listing: Listing::OutOfDate,
            news: self.news,
            parents: std::mem::take(&mut self.parents),
            tolerance: ListTolerance::new(self.tolerance.value()),
            lists_few: self.lists_few,
            ..BroadPhase::default()
        };
        Ok(())
    }

    // --- For a query -------------------------------------------------------------------------------------------------------------

    /// Boxes overlap of all that are not farther apart than this.
    pub fn tolerance(&self) -> f64 {
        self.tolerance.value()
    }

    /// The filter's decisions on the pairs that are near.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn decisions(&self, world: &World) -> Result<Vec<Decided>> {
        let mut decisions = Vec::new();
        for pair in &self.list.pairs {
            let ids = pair.proxies.map(|proxy| world.proxies.labels[proxy as usize].object);
            if ids.iter().all(|id| world.objects.get(*id).is_ok()) {
                push(&mut decisions, (ids, pair.testing != Testing::Rejected))?;
            }
        }
        Ok(decisions)
    }

    /// The trees, of moving pieces and of fixed ones, while each piece is in one of them, except some of those that have escaped,
    /// and is in the boxes there unless it has escaped.
    pub fn fitted_trees(&self, proxies: &Proxies) -> Option<&[Tree; 2]> {
        let are_fitted = self.trees.iter().all(|tree| tree.is_fitted);
        (self.listing == Listing::Overlaps && are_fitted && !proxies.misses_escaped).then_some(&self.trees)
    }

    /// Brings the list and both trees up to date, so that there are [fitted trees](BroadPhase::fitted_trees) and nothing has
    /// escaped; for pairs that the program gives there are none.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the next call tries again.
    pub fn fit_trees(&mut self, world: &mut World, workers: &Workers) -> Result<()> {
        self.update(world, 0.0, workers)?;
        if world.given.is_none() {
            self.fit_tree(false, &world.proxies)?;
            self.fit_tree(true, &world.proxies)?;
        }
        Ok(())
    }

    /// Brings the list up to date: all that a query with this tolerance may list are among its pairs.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); the next call tries again.
    #[inline]
    pub fn update(&mut self, world: &mut World, tolerance: f64, workers: &Workers) -> Result<()> {
        world.proxies.settle();
        // A first look at each of few pairs takes less than boxes that follow their pieces.
        let tolerance = if world.has_few_pairs() { f64::INFINITY } else { tolerance };
        if self.is_up_to_date(world, tolerance) { Ok(()) } else { self.catch_up(world, tolerance, workers) }
    }

    /// Whether the list holds all pairs there are, which are few.
    #[inline(always)]
    pub fn lists_all(&self, world: &World) -> bool {
        world.has_few_pairs() && self.is_up_to_date(world, f64::INFINITY)
    }

    /// Whether boxes overlap as they did before.
    #[inline(always)]
    fn is_up_to_date(&self, world: &World, tolerance: f64) -> bool {
        let proxies = &world.proxies;
        (self.news == News::None)
            & (self.listing == Listing::Overlaps)
            & self.tolerance.is(tolerance)
            & proxies.escaped.is_empty()
            & !proxies.misses_escaped
            & world.given.is_none()
    }

    #[inline(never)]
    fn catch_up(&mut self, world: &mut World, tolerance: f64, workers: &Workers) -> Result<()> {
        self.tell_news(world);
        if world.given.is_some() {
            self.list_given(world)?;
        } else {
            self.list_overlaps(world, tolerance, workers)?;
        }
        if world.proxies.has_many_gone() {
            self.renumber(world);
        }
        Ok(())
    }

    /// Applies the settings on the testing of near pairs to them.
    fn tell_news(&mut self, world: &mut World) {
        let (proxies, mut rules, _) = world.parts();
        match std::mem::replace(&mut self.news, News::None) {
            News::None => {}
            News::Activation => self.list.for_each_testing(&proxies.labels, |old, pair| match old {
                Testing::Rejected => old,
                Testing::Active | Testing::Inactive => rules.active(pair),
            }),
            News::Filter => self.list.for_each_testing(&proxies.labels, |old, pair| {
                // Pairs of objects that are gone are still to be dropped: the program does not know them any more.
                if pair.iter().any(|label| label.is_gone()) { old } else { rules.testing(pair) }
            }),
        }
    }

    /// Makes the list hold the pairs that the program gives, if it does not.
    fn list_given(&mut self, world: &mut World) -> Result<()> {
        let (proxies, mut rules, given) = world.parts();
        // Pieces that have moved or come stay in the list of escaped ones; the pairs of those gone have to go.
        if self.listing == Listing::Given && !proxies.has_news {
            return Ok(());
        }
        self.listing = Listing::OutOfDate;
        self.candidates.clear();
        for [id1, id2] in given.unwrap_or_default() {
            for piece1 in rules.objects.rows_of(*id1) {
                for piece2 in rules.objects.rows_of(*id2) {
                    self.candidates.add_if_meeting(proxies, piece1 as u32, piece2 as u32)?;
                }
            }
        }
        self.list.update(&mut self.candidates, &proxies.firsts, |_| true, of_proxies(proxies, &mut rules))?;
        proxies.has_news = false;
        self.listing = Listing::Given;
        Ok(())
    }

    /// Makes the list hold the pairs of boxes that overlap.
    fn list_overlaps(&mut self, world: &mut World, tolerance: f64, workers: &Workers) -> Result<()> {
        // A list kept for few objects must not serve many.
        let lists_few = std::mem::replace(&mut self.lists_few, world.has_few_pairs());
        if self.tolerance.value() == f64::INFINITY && (!world.is_small() || lists_few && !self.lists_few) {
            self.tolerance = ListTolerance::new(tolerance);
            self.listing = Listing::OutOfDate;
        }
        let (proxies, mut rules, _) = world.parts();
        proxies.list_escaped();
        let refits_all = self.tolerance.follow(tolerance) | (self.listing != Listing::Overlaps);
        if proxies.escaped.is_empty() && !refits_all {
            return Ok(());
        }
        if std::mem::replace(&mut self.listing, Listing::OutOfDate) != Listing::Overlaps {
            self.parents.fill(NONE);
            self.trees = Default::default();
        }
        self.candidates.clear();
        if refits_all || proxies.escaped.len() * MANY_ESCAPED > proxies.len() - proxies.gone {
            self.refit_all(proxies, workers)?;
            self.find_all(proxies, workers)?;
            self.list.update(&mut self.candidates, &proxies.firsts, |_| true, of_proxies(proxies, &mut rules))?;
        } else {
            self.refit_escaped(proxies)?;
            self.find_escaped(proxies)?;
            let is_open = |[a, b]: [u32; 2]| self.is_open[a as usize] | self.is_open[b as usize];
            self.list.update(&mut self.candidates, &proxies.firsts, is_open, of_proxies(proxies, &mut rules))?;
        }
        for proxy in proxies.escaped.drain(..) {
            proxies.motions[proxy as usize].has_escaped = false;
        }
        self.listing = Listing::Overlaps;
        Ok(())
    }

    // --- All pieces --------------------------------------------------------------------------------------------------------------

    fn refit_all(&mut self, proxies: &mut Proxies, workers: &Workers) -> Result<()> {
        self.trees.iter_mut().for_each(|tree| tree.is_fitted = false);
        let mut rows = proxies.rows();
        let count = rows.len();
        if workers.share(count) {
            let size = workers.part_size(count);
            let ends = (size..count).step_by(size).chain([count]);
            workers.map(rows.cut_at_each(ends), |mut rows| rows.refit_all(self.tolerance.value()))?;
        } else {
            rows.refit_all(self.tolerance.value());
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

    /// Moving pieces meet each other in the grid, except large ones, and fixed ones in their tree.
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
        if self.trees[tree].is_fitted {
            return Ok(());
        }
        let is_missing = |&proxy: &u32| self.parents[proxy as usize] == NONE && belongs(proxies, proxy, fixed);
        let has_all = !(0..proxies.len() as u32).any(|proxy| is_missing(&proxy));
        if !(has_all && self.trees[tree].refit(&proxies.boxes, &mut self.scratch)?) {
            self.list_tree(fixed, proxies)?;
            self.trees[tree].build(&mut self.scratch, &proxies.boxes, &mut self.parents)?;
        }
        self.trees[tree].is_fitted = true;
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
                proxies.refit(proxy, self.tolerance.value());
            }
        }
        for fixed in [false, true] {
            let tree = &mut self.trees[usize::from(fixed)];
            tree.is_fitted &= !tree.is_worn();
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

    /// Drops the rows of pieces that are gone, if there is memory. No pair of theirs is in an up-to-date list.
    fn renumber(&mut self, world: &mut World) {
        let World { proxies, objects, .. } = world;
        let Ok(numbers) = proxies.renumbering() else { return };
        self.list.renumber(&numbers);
        self.trees.iter_mut().for_each(|tree| tree.renumber(&numbers));
        let mut proxy = 0;
        self.parents.retain(|_| {
            proxy += 1;
            !proxies.is_gone(proxy - 1)
        });
        proxies.bodies.renumber(&numbers);
        proxies.compact();
        objects.renumber(&numbers);
    }
}

/// Whether pairs of pieces are tested.
fn of_proxies<'a>(proxies: &'a Proxies, rules: &'a mut Rules<'_>) -> impl FnMut([u32; 2]) -> Testing {
    |pair| rules.testing(pair.map(|proxy| &proxies.labels[proxy as usize]))
}

/// Whether a piece belongs in the tree of fixed ones, or in the other.
fn belongs(proxies: &Proxies, proxy: u32, fixed: bool) -> bool {
    let label = &proxies.labels[proxy as usize];
    (label.object != ObjectId::NULL) & (label.fixed == fixed)
}
