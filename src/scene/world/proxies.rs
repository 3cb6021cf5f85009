//! The placed convex pieces of a scene: a row of several arrays for each, in the order of results.

use std::ops::Range;
use std::sync::Arc;

use crate::base::error::Result;
use crate::base::math::Pose;
use crate::base::memory::{reserve_sparingly, with_capacity};
use crate::base::simd::environment::with_default;
use crate::scene::world::bodies::RowBodies;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::object::ObjectId;
use crate::scene::world::rows::{Label, RowMotion, Rows, Spheres, placed};
use crate::shape::Shape;

/// A piece to be added.
pub(crate) struct NewProxy {
    pub shape: Arc<Shape>,
    pub pose: Pose,
    pub label: Label,
}

/// Of so few pieces spheres and ways follow when somebody asks for them: a query of few pairs does not.
const FEW_ROWS: usize = 6;

/// A row whose spheres and whose way do not know its last moves yet.
#[derive(Debug)]
struct StaleRow {
    proxy: u32,
    /// The pose that they know.
    pose: Pose,
}

/// The pieces, those of earlier created objects first.
#[derive(Debug, Default)]
pub(crate) struct Proxies {
    /// A box around it where it is a ground or a compound.
    pub shapes: Vec<Arc<Shape>>,
    pub bodies: RowBodies,
    pub poses: Vec<Pose>,
    spheres: Vec<Spheres>,
    behind: Vec<StaleRow>,
    pub motions: Vec<RowMotion>,
    pub boxes: Vec<Aabb>,
    pub labels: Vec<Label>,
    /// The first row of the same object.
    pub firsts: Vec<u32>,
    /// Those that may be out of their boxes, and those whose pairs must be looked for anew.
    pub escaped: Vec<u32>,
    /// Some may be missing there: [`Proxies::list_escaped`].
    pub misses_escaped: bool,
    /// How many are gone.
    pub gone: usize,
    /// Some have come or gone or may meet others than before, since anybody asked.
    pub has_news: bool,
}

impl Proxies {
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Room for `count` more.
    pub fn reserve(&mut self, count: usize) -> Result<()> {
        reserve_sparingly(&mut self.shapes, count)?;
        reserve_sparingly(&mut self.poses, count)?;
        reserve_sparingly(&mut self.spheres, count)?;
        reserve_sparingly(&mut self.motions, count)?;
        reserve_sparingly(&mut self.boxes, count)?;
        reserve_sparingly(&mut self.labels, count)?;
        reserve_sparingly(&mut self.firsts, count)?;
        if self.behind.capacity() == 0 {
            reserve_sparingly(&mut self.behind, FEW_ROWS)?;
        }
        // Each stands there at most once.
        let room = self.labels.len() + count - self.escaped.len();
        reserve_sparingly(&mut self.escaped, room)
    }

    /// Adds a piece for which there is room.
    pub fn push(&mut self, new: NewProxy) {
        debug_assert!(self.labels.len() < self.labels.capacity() && new.label.piece as usize <= self.labels.len());
        let (spheres, rigid) = placed(&new.shape, &new.pose, new.pose.rotation_defect());
        self.shapes.push(new.shape);
        self.poses.push(new.pose);
        self.spheres.push(spheres);
        self.motions.push(RowMotion::new(rigid));
        self.boxes.push(Aabb::EVERYWHERE);
        self.firsts.push(self.labels.len() as u32 - new.label.piece);
        self.labels.push(new.label);
        self.look_for_pairs_of(self.labels.len() - 1);
    }

    /// Adds a row for which there is room and which no other part of the scene hears of; gives its number.
    pub fn push_unseen(&mut self, new: NewProxy) -> usize {
        let has_news = self.has_news;
        self.push(new);
        self.escaped.pop();
        self.has_news = has_news;
        self.len() - 1
    }

    /// Ends the rows of [`Proxies::push_unseen`], from the first of them on.
    pub fn end_unseen(&mut self, first: usize) {
        debug_assert!(first <= self.len() && self.behind.is_empty());
        self.shapes.truncate(first);
        self.poses.truncate(first);
        self.spheres.truncate(first);
        self.motions.truncate(first);
        self.boxes.truncate(first);
        self.labels.truncate(first);
        self.firsts.truncate(first);
    }

    /// It may meet others than before: its pairs must be looked for anew.
    pub fn look_for_pairs_of(&mut self, proxy: usize) {
        self.has_news = true;
        if self.motions[proxy].escape() {
            self.escaped.push(proxy as u32);
        }
    }

    /// The objects in order of creation.
    pub fn objects(&self) -> impl Iterator<Item = ObjectId> {
        let is_first = |label: &&Label| label.piece == 0 && label.object != ObjectId::NULL;
        self.labels.iter().filter(is_first).map(|label| label.object)
    }

    /// The rows of each object, in order of creation.
    pub fn of_objects(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = |first: usize| (first + 1..self.len()).find(|&k| self.labels[k].piece == 0).unwrap_or(self.len());
        (0..self.len()).filter(|&k| self.labels[k].piece == 0 && !self.is_gone(k)).map(move |first| first..ends(first))
    }

    /// Whether it is the first piece of an object that is not fixed.
    pub fn leads_movable(&self, proxy: usize) -> bool {
        let label = &self.labels[proxy];
        (label.piece == 0) & !label.fixed & !self.is_gone(proxy)
    }

    pub fn is_gone(&self, proxy: usize) -> bool {
        self.labels[proxy].is_gone()
    }

    /// Ends a piece; its row stays until they are renumbered.
    pub fn end(&mut self, proxy: usize) {
        debug_assert!(!self.is_gone(proxy));
        self.labels[proxy].object = ObjectId::NULL;
        self.bodies.remove(proxy);
        self.gone += 1;
        self.look_for_pairs_of(proxy);
    }

    /// All of them, for moving.
    pub fn rows(&mut self) -> Rows<'_> {
        let Proxies { shapes, poses, spheres, motions, boxes, labels, .. } = self;
        Rows { first: 0, shapes, labels, poses, spheres, motions, boxes }
    }

    /// Whether a piece that is put elsewhere may [stay behind](Proxies::put).
    #[inline(always)]
    pub fn may_stay_behind(&self, proxy: usize) -> bool {
        self.labels.len() <= FEW_ROWS && self.motions[proxy].is_everywhere()
    }

    /// Puts a piece elsewhere that [may stay behind](Proxies::may_stay_behind): its spheres and its way follow when they are
    /// [asked for](Proxies::settle).
    #[inline(always)]
    pub fn put(&mut self, proxy: usize, pose: &Pose, passes: u64) {
        debug_assert!(self.may_stay_behind(proxy));
        let old = &mut self.poses[proxy];
        if *old == *pose {
            return;
        }
        self.motions[proxy].moved = passes;
        if !self.spheres[proxy].are_behind() {
            debug_assert!(self.behind.len() < self.behind.capacity());
            self.behind.push(StaleRow { proxy: proxy as u32, pose: *old });
            self.spheres[proxy].outer = f32::NAN;
        }
        *old = *pose;
    }

    /// Spheres and ways of all rows are up to date from now on. The way from the last known pose to this one is a bound of any
    /// way between, as far as anybody has looked.
    #[inline(always)]
    pub fn settle(&mut self) {
        if !self.behind.is_empty() {
            self.settle_all();
        }
    }

    #[inline(never)]
    fn settle_all(&mut self) {
        let mut behind = std::mem::take(&mut self.behind);
        for StaleRow { proxy, pose } in behind.drain(..) {
            let proxy = proxy as usize;
            let defect = self.poses[proxy].rotation_defect();
            let has_escaped = self.rows().follow(proxy, &pose, defect);
            debug_assert!(!has_escaped, "a box without end is not left");
        }
        // With its room.
        self.behind = behind;
    }

    /// Balls around and in a piece, also where a row is behind.
    #[inline(always)]
    pub fn spheres(&self, proxy: usize) -> Spheres {
        let known = self.spheres[proxy];
        if known.are_behind() { self.spheres_now(proxy) } else { known }
    }

    #[cold]
    #[inline(never)]
    fn spheres_now(&self, proxy: usize) -> Spheres {
        let pose = &self.poses[proxy];
        with_default(|| placed(&self.shapes[proxy], pose, pose.rotation_defect()).0)
    }

    /// The same where none is behind.
    #[inline(always)]
    pub fn known_spheres(&self, proxy: usize) -> &Spheres {
        debug_assert!(!self.spheres[proxy].are_behind());
        &self.spheres[proxy]
    }

    /// Puts a piece elsewhere: [`Rows::place`].
    #[inline(always)]
    pub fn place(&mut self, proxy: usize, pose: &Pose, defect: f64, passes: u64) {
        if self.may_stay_behind(proxy) {
            self.put(proxy, pose, passes);
        } else if self.rows().place(proxy, pose, defect, passes) {
            self.escaped.push(proxy as u32);
        }
    }

    /// Completes the list of those that have escaped. There is room for all.
    pub fn list_escaped(&mut self) {
        if std::mem::take(&mut self.misses_escaped) {
            self.escaped.clear();
            self.escaped.extend((0..).zip(&self.motions).filter(|(_, motion)| motion.has_escaped).map(|(k, _)| k));
        }
    }

    /// Gives a piece a new box: [`Rows::refit`].
    pub fn refit(&mut self, proxy: usize, tolerance: f64) {
        self.rows().refit(proxy, tolerance);
    }

    /// Whether two pieces may make a pair.
    #[inline(always)]
    pub fn may_meet(&self, a: usize, b: usize) -> bool {
        self.may_meet_moved(a, b) & !(self.labels[a].fixed & self.labels[b].fixed)
    }

    /// The same of pieces of which one is elsewhere for a question: both may be of fixed objects.
    #[inline(always)]
    pub fn may_meet_moved(&self, a: usize, b: usize) -> bool {
        let [one, other] = [&self.labels[a], &self.labels[b]];
        let are_masked = (one.groups & other.mask == 0) | (other.groups & one.mask == 0);
        (one.object != other.object) & !are_masked & !self.is_gone(a) & !self.is_gone(b)
    }

    /// Whether the rows of pieces that are gone should be dropped.
    pub fn has_many_gone(&self) -> bool {
        self.gone > 64.max(self.len() / 4)
    }

    /// The number of each row once those of pieces that are gone have been dropped.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn renumbering(&self) -> Result<Vec<u32>> {
        let mut numbers = with_capacity(self.len())?;
        let mut next = 0;
        for proxy in 0..self.len() {
            numbers.push(next);
            next += u32::from(!self.is_gone(proxy));
        }
        Ok(numbers)
    }

    /// Drops the rows of pieces that are gone.
    pub fn compact(&mut self) {
        debug_assert!(self.behind.is_empty());
        let labels = std::mem::take(&mut self.labels);
        let stays = |k: usize| labels[k].object != ObjectId::NULL;
        fn keep<T>(rows: &mut Vec<T>, stays: impl Fn(usize) -> bool) {
            let mut k = 0;
            rows.retain(|_| {
                k += 1;
                stays(k - 1)
            });
        }
        keep(&mut self.shapes, stays);
        keep(&mut self.poses, stays);
        keep(&mut self.spheres, stays);
        keep(&mut self.motions, stays);
        keep(&mut self.boxes, stays);
        self.labels = labels;
        self.labels.retain(|label| label.object != ObjectId::NULL);
        self.firsts.clear();
        self.firsts.extend((0..).zip(&self.labels).map(|(proxy, label)| proxy - label.piece));
        self.gone = 0;
        self.misses_escaped = true;
        self.list_escaped();
    }
}
