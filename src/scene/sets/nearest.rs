//! The nearest pair of two sets, best first: lower bounds by boxes and spheres select the pair to ask next, and the distance
//! known so far is the tolerance of the next query. It ends where no bound is less than that.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::base::error::{Result, check_range};
use crate::base::memory::{extend, push, push_to_heap};
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Placed, Query};
use crate::scene::near::tree::{Branch, Held};
use crate::scene::search::query::PairResult;
use crate::scene::sets::bounds::{of_boxes, of_spheres};
use crate::scene::sets::caches::Caches;
use crate::scene::sets::members::Member;
use crate::scene::sets::others::Others;
use crate::scene::world::content::World;
use crate::scene::world::rows::Spheres;

/// The least distance between two sets of objects. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct LeastDistance {
    /// The least distance is at least this. For sets farther apart than `max_distance`, it is no less than that.
    pub lower: f64,
    /// The least distance is at most this. It is infinite beyond `max_distance`, and if no pair is tested.
    pub upper: f64,
    /// A pair with that distance: object 1 is of the first set, `nearest.answer` the answer. Its ids are null if no pair is within
    /// `max_distance`. Among pairs equally near in doubles, any may be returned.
    pub nearest: PairResult,
}

impl Default for LeastDistance {
    fn default() -> Self {
        LeastDistance { lower: f64::NAN, upper: f64::NAN, nearest: PairResult::default() }
    }
}

/// A candidate that may hold a nearer pair than the nearest known.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SetCandidate {
    /// No pair of it is nearer.
    bound: f64,
    /// Which piece of the first set.
    member: u32,
    target: Target,
}

/// The partner of the first set's piece.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Target {
    /// All pieces of a branch of one of the trees.
    Branch(usize, Branch),
    /// A piece where the scene has it.
    Piece(u32),
    /// A piece of the second set.
    Second(u32),
    /// Another piece of the first set.
    First(u32),
}

impl Eq for SetCandidate {}

impl PartialOrd for SetCandidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for SetCandidate {
    /// The greatest of a heap has the least bound.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.member.cmp(&self.member))
    }
}

/// Room for candidates.
#[derive(Debug, Default)]
pub(crate) struct SetCandidates {
    heap: BinaryHeap<SetCandidate>,
    row: Vec<SetCandidate>,
    /// Pieces that are in no tree.
    loose: Vec<u32>,
}

/// The opposite side of the question to the first set.
#[derive(Clone, Copy)]
pub(crate) enum Against<'a> {
    /// All that is not in the first set.
    Others(Others<'a>),
    /// The second set.
    Set(&'a [Member]),
}

/// The question.
#[derive(Clone, Copy)]
pub(crate) struct NearestQuestion<'a> {
    pub world: &'a World,
    pub members: &'a [Member],
    pub against: Against<'a>,
    /// Pairs of two objects of the first set, too.
    pub among: bool,
    /// Objects of one of the sets are elsewhere for the question.
    pub moved: bool,
    /// Pairs farther apart need not be known.
    pub max_distance: f64,
}

/// So many of a piece's pairs with the least bounds may turn out not to be tested before all are put in order.
const MOST_TRIES: usize = 4;

struct NearestSearch<'a> {
    question: NearestQuestion<'a>,
    candidates: &'a mut SetCandidates,
    caches: &'a mut Caches,
    best: LeastDistance,
    /// Nothing farther apart need be asked: the least upper bound, or the cut-off.
    enough: f64,
}

/// The least distance.
///
/// # Errors
/// [`Error::Argument`](crate::base::error::Error::Argument) for a cut-off that is negative or NaN,
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn least_distance(
    question: NearestQuestion,
    candidates: &mut SetCandidates,
    caches: &mut Caches,
) -> Result<LeastDistance> {
    check_range("max_distance", question.max_distance, 0.0..=f64::INFINITY)?;
    caches.make_room()?;
    candidates.heap.clear();
    let enough = question.max_distance;
    let best = LeastDistance { lower: enough, upper: f64::INFINITY, nearest: PairResult::default() };
    let mut search = NearestSearch { question, candidates, caches, best, enough };
    search.begin()?;
    search.finish()?;
    Ok(search.best)
}

impl<'a> NearestSearch<'a> {
    /// Collects the first candidates: pairs with what is listed, and the trees.
    fn begin(&mut self) -> Result<()> {
        let NearestQuestion { world, members, against, among, .. } = self.question;
        let mut loose = std::mem::take(&mut self.candidates.loose);
        loose.clear();
        if let Against::Others(others) = against {
            extend(&mut loose, others.loose().map(|other| other as u32))?;
        }
        for (k, member) in (0..).zip(members) {
            if among {
                let rest = (0..).zip(members).skip(k as usize + 1);
                self.add_row(k, rest.map(|(other, piece)| (Target::First(other), piece.proxy, piece.spheres)))?;
            }
            match against {
                Against::Set(second) => {
                    let all = (0..).zip(second);
                    self.add_row(k, all.map(|(other, piece)| (Target::Second(other), piece.proxy, piece.spheres)))?;
                }
                Against::Others(others) => {
                    let spheres = |other: u32| world.proxies.spheres(other as usize);
                    let all = loose.iter().map(|&other| (Target::Piece(other), other, spheres(other)));
                    self.add_row(k, all)?;
                    for (tree, fitted) in others.trees.into_iter().flatten().enumerate() {
                        if let Some(root) = fitted.root() {
                            let bound = of_boxes(&member.bounds, fitted.bounds(root, &world.proxies.boxes));
                            self.add(SetCandidate { bound, member: k, target: Target::Branch(tree, root) })?;
                        }
                    }
                }
            }
        }
        self.candidates.loose = loose;
        Ok(())
    }

    /// Pairs of a piece with many: the nearest by its bound is asked at once, so that few others are worth keeping.
    fn add_row(&mut self, member: u32, others: impl Iterator<Item = (Target, u32, Spheres)>) -> Result<()> {
        let Member { proxy, spheres, .. } = self.question.members[member as usize];
        let mut row = std::mem::take(&mut self.candidates.row);
        row.clear();
        for (target, other, of_other) in others {
            let bound = of_spheres(&spheres, &of_other);
            if bound <= self.enough && self.may_meet(proxy, other) {
                push(&mut row, SetCandidate { bound, member, target })?;
            }
        }
        for _ in 0..MOST_TRIES {
            let Some(least) = (0..row.len()).max_by(|&i, &k| row[i].cmp(&row[k])) else { break };
            let candidate = row.swap_remove(least);
            if candidate.bound > self.enough || self.ask(&candidate)? {
                break;
            }
        }
        for candidate in &row {
            self.add(*candidate)?;
        }
        self.candidates.row = row;
        Ok(())
    }

    #[inline(always)]
    fn may_meet(&self, a: u32, b: u32) -> bool {
        let NearestQuestion { world, moved, .. } = self.question;
        let (a, b) = (a as usize, b as usize);
        if moved { world.proxies.may_meet_moved(a, b) } else { world.proxies.may_meet(a, b) }
    }

    fn add(&mut self, candidate: SetCandidate) -> Result<()> {
        if candidate.bound <= self.enough { push_to_heap(&mut self.candidates.heap, candidate) } else { Ok(()) }
    }

    /// Asks the pairs of least bound until none is less than the known distance.
    fn finish(&mut self) -> Result<()> {
        while let Some(candidate) = self.candidates.heap.pop()
            && candidate.bound <= self.enough
            && self.best.upper > 0.0
        {
            match candidate.target {
                Target::Branch(tree, branch) => self.open(candidate.member, tree, branch)?,
                _ => _ = self.ask(&candidate)?,
            }
        }
        Ok(())
    }

    /// Replaces a branch by its content.
    fn open(&mut self, member: u32, tree: usize, branch: Branch) -> Result<()> {
        let NearestQuestion { world, members, against: Against::Others(others), .. } = self.question else {
            return Ok(());
        };
        let Some(fitted) = others.trees.map(|trees| &trees[tree]) else { return Ok(()) };
        let Member { proxy, spheres, bounds, .. } = &members[member as usize];
        match fitted.held(branch) {
            Held::Branches(parts) => parts.into_iter().try_for_each(|part| {
                let bound = of_boxes(bounds, fitted.bounds(part, &world.proxies.boxes));
                self.add(SetCandidate { bound, member, target: Target::Branch(tree, part) })
            }),
            Held::Proxy(other) => {
                if !(others.has_in_tree(other as usize) && self.may_meet(*proxy, other)) {
                    return Ok(());
                }
                let by_boxes = of_boxes(bounds, &world.proxies.boxes[other as usize]);
                let bound = by_boxes.max(of_spheres(spheres, &world.proxies.spheres(other as usize)));
                self.add(SetCandidate { bound, member, target: Target::Piece(other) })
            }
        }
    }

    /// Asks the pair of a candidate, if it is tested; whether it is.
    fn ask(&mut self, candidate: &SetCandidate) -> Result<bool> {
        let NearestQuestion { world, members, against, moved, .. } = self.question;
        let member = &members[candidate.member as usize];
        let other = match (candidate.target, against) {
            (Target::Piece(proxy), _) => {
                let at = proxy as usize;
                (proxy, world.proxies.shapes[at].at(&world.proxies.poses[at]))
            }
            (Target::First(k), _) => (members[k as usize].proxy, members[k as usize].placed(world)),
            (Target::Second(k), Against::Set(second)) => (second[k as usize].proxy, second[k as usize].placed(world)),
            (Target::Second(_) | Target::Branch(..), _) => return Ok(false),
        };
        if !world.is_tested([member.proxy as usize, other.0 as usize], moved) {
            return Ok(false);
        }
        self.learn([member.proxy, other.0], [member.placed(world), other.1])?;
        Ok(true)
    }

    /// The distance of a pair, if it is less than the known distance.
    fn learn(&mut self, pair: [u32; 2], bodies: [Placed; 2]) -> Result<()> {
        let mut answer = PairAnswer::default();
        let config = PairConfig { max_distance: self.enough, ..PairConfig::default() };
        let (rows, mut pieces) = (&self.question.world.proxies.bodies, [None; 2]);
        if let Some(compounds) = rows.compound_pair(pair, bodies) {
            pieces = compounds.ask(Query::Distance, self.caches.of_compounds(pair)?, &config, &mut answer)?;
        } else if let Some(ground) = rows.ground_pair(pair) {
            ground.ask(Query::Distance, bodies, &config, &mut answer)?;
        } else {
            pair::distance(bodies, self.caches.of(pair), &config, &mut answer)?;
        }
        if answer.outcome == Outcome::Beyond {
            return Ok(());
        }
        // If intervals overlap, any of them may be that of the nearest.
        self.best.lower = self.best.lower.min(answer.lower);
        if answer.upper < self.best.upper {
            self.enough = answer.upper;
            self.best.upper = answer.upper;
            self.best.nearest = signed(self.question.world, pair, answer);
            self.best.nearest.name_pieces(pieces);
        }
        Ok(())
    }
}

/// Labels an answer with the objects, user data and pieces of its pair.
pub(crate) fn signed(world: &World, pair: [u32; 2], answer: PairAnswer) -> PairResult {
    let [label1, label2] = pair.map(|proxy| &world.proxies.labels[proxy as usize]);
    PairResult {
        object1: label1.object,
        object2: label2.object,
        user_data1: label1.user_data,
        user_data2: label2.user_data,
        piece1: label1.piece,
        piece2: label2.piece,
        answer,
    }
}
