//! When moving objects first meet others: boxes around what they sweep over select the candidates, and each such pair is cast up
//! to the earliest time that is known.

use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::push;
use crate::compound::{self, Compound, CompoundCastAnswer, MovingCompound};
use crate::ground::{GroundCastAnswer, PlacedGround, ground_cast_carried};
use crate::motion::{self, Carried, CastAnswer, CastConfig, CastOutcome, Motion, PartEnd, Swept};
use crate::scene::near::tree::Branch;
use crate::scene::search::query::PairResult;
use crate::scene::sets::caches::Caches;
use crate::scene::sets::members;
use crate::scene::sets::nearest::signed;
use crate::scene::sets::others::Others;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::compounds::NamedPieces;
use crate::scene::world::content::World;
use crate::scene::world::grounds::face;
use crate::scene::world::rows::{grown_box, placed};

/// How a cast of moving objects through a scene came out. Unset numbers are NaN.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct SceneCastAnswer {
    /// The answer for the pair that ends the motion; free if all pairs are.
    pub outcome: CastOutcome,
    /// Certified queries made.
    pub queries: u32,
    /// All pairs are farther apart than `max_distance` from the beginning up to here: the last valid time.
    pub time_lower: f64,
    /// For a hit: a time at which its pair is no farther apart than `max_distance`, the earliest that is known.
    pub time_upper: f64,
    /// For a hit: its pair's distance at `time_upper` is at most this. For a near miss: the same at its `time_lower`.
    pub upper: f64,
    /// The pair that ends it, object 1 moving, with what [`CastAnswer::contact`] says; null ids if all are free.
    pub pair: PairResult,
}

impl Default for SceneCastAnswer {
    fn default() -> Self {
        SceneCastAnswer {
            outcome: CastOutcome::None,
            queries: 0,
            time_lower: f64::NAN,
            time_upper: f64::NAN,
            upper: f64::NAN,
            pair: PairResult::default(),
        }
    }
}

/// The question.
#[derive(Clone, Copy)]
pub(crate) struct CastQuestion<'a> {
    pub others: Others<'a>,
    /// One for all objects of the set, or one for each.
    pub motions: &'a [Motion<'a>],
    pub config: &'a CastConfig,
}

/// The room that the question is worked in.
pub(crate) struct CastRoom<'a> {
    pub movers: &'a mut Vec<Mover>,
    pub boxes: &'a mut Vec<SweptBox>,
    pub open: &'a mut Vec<Branch>,
    pub found: &'a mut Vec<u32>,
    pub approaches: &'a mut Vec<Approach>,
    pub caches: &'a mut Caches,
}

/// A moving piece.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mover {
    proxy: u32,
    /// Which object of the set it is of.
    of: u32,
    /// The pose of a piece that has one of its own.
    place: Option<Pose>,
    /// The first of its boxes, and the one behind its last.
    boxes: [u32; 2],
}

/// A box that a piece does not leave from one time to the next, grown by `max_distance`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SweptBox {
    from: f64,
    bounds: Aabb,
}

/// A pair that may be no farther apart than `max_distance`, but not before a time.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Approach {
    from: f64,
    mover: u32,
    target: CastTarget,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum CastTarget {
    /// A piece where the scene has it.
    Piece(u32),
    /// Another moving piece.
    Mover(u32),
}

/// The earliest time at which a moving object is no farther from another one than `max_distance`.
///
/// # Errors
/// [`Error::Handle`] for an id that names no object of the scene; [`Error::Argument`] unless there is one motion or one for each
/// object, and same as for [`crate::motion::cast`]; [`Error::Pose`], [`Error::Memory`].
pub(crate) fn cast(question: CastQuestion, room: &mut CastRoom) -> Result<SceneCastAnswer> {
    question.config.check()?;
    room.caches.make_room()?;
    list_movers(&question, room)?;
    list_approaches(&question, room)?;
    cast_all(&question, room)
}

impl<'a> CastQuestion<'a> {
    fn motion(&self, of: u32) -> &'a Motion<'a> {
        // One for all, or one for each.
        &self.motions[(of as usize).min(self.motions.len() - 1)]
    }

    fn carried<'b>(&self, mover: &'b Mover) -> Carried<'b>
    where
        'a: 'b,
    {
        let shape = &self.others.world.proxies.shapes[mover.proxy as usize];
        Carried { shape, motion: self.motion(mover.of), place: mover.place.as_ref() }
    }
}

/// The moving pieces, and the boxes that each sweeps over.
fn list_movers(question: &CastQuestion, room: &mut CastRoom) -> Result<()> {
    let CastQuestion { others, motions, config, .. } = question;
    let (world, ids) = (others.world, others.set.ids);
    let CastRoom { movers, boxes, .. } = room;
    movers.clear();
    boxes.clear();
    if ids.is_empty() || !(motions.len() == 1 || motions.len() == ids.len()) {
        let are = format!("{} motions for a set of {} objects", motions.len(), ids.len());
        return Err(Error::Argument(format!("{are}: give one for all together, or one for each")));
    }
    for (of, id) in (0..).zip(ids) {
        let named = |error: Error| error.about(&format!("object {of} of {} of the set", ids.len()));
        let object = world.objects.get(*id).map_err(named)?;
        members::refuse_ground(world, *id).map_err(named)?;
        let piece_poses = object.arrangement.as_ref().map_or(&[][..], |arrangement| &arrangement.piece_poses);
        for (piece, proxy) in object.proxies().enumerate() {
            let first = boxes.len() as u32;
            // A product with the identity is exact.
            let place = piece_poses.get(piece).filter(|place| **place != Pose::IDENTITY).copied();
            let mover = Mover { proxy: proxy as u32, of, place, boxes: [first; 2] };
            list_boxes(question.carried(&mover), config, boxes).map_err(named)?;
            push(movers, Mover { boxes: [first, boxes.len() as u32], ..mover })?;
        }
    }
    Ok(())
}

/// Boxes around the region that one piece sweeps over, grown by `max_distance`.
fn list_boxes(body: Carried, config: &CastConfig, boxes: &mut Vec<SweptBox>) -> Result<()> {
    let swept = Swept::new(body, config.range())?;
    let mut before = None;
    for place in swept.places() {
        let PartEnd { time, pose, off } = place?;
        let (spheres, _) = placed(body.shape, &pose, pose.rotation_defect());
        let here = grown_box(body.shape, &pose, &spheres, (off + config.max_distance).next_up());
        if let Some((from, there)) = before.replace((time, here)) {
            push(boxes, SweptBox { from, bounds: here.union(&there) })?;
        }
    }
    Ok(())
}

/// The pairs whose boxes overlap, the earliest first.
fn list_approaches(question: &CastQuestion, room: &mut CastRoom) -> Result<()> {
    let CastQuestion { others, .. } = question;
    let CastRoom { movers, boxes, open, found, approaches, .. } = room;
    approaches.clear();
    let boxes_of = |mover: &Mover| &boxes[mover.boxes[0] as usize..mover.boxes[1] as usize];
    for (k, mover) in (0..).zip(&**movers) {
        for swept in boxes_of(mover) {
            others.list(open, found, |bounds| bounds.overlaps(&swept.bounds))?;
            for &other in &**found {
                push(approaches, Approach { from: swept.from, mover: k, target: CastTarget::Piece(other) })?;
            }
        }
        for second in (k + 1..movers.len() as u32).take_while(|_| others.set.among) {
            let beside = boxes_of(&movers[second as usize]);
            let overlapping = boxes_of(mover).iter().find(|a| beside.iter().any(|b| b.bounds.overlaps(&a.bounds)));
            if overlapping.is_some() {
                let from = question.config.time_begin;
                push(approaches, Approach { from, mover: k, target: CastTarget::Mover(second) })?;
            }
        }
    }
    // For each pair, the earliest counts.
    approaches.sort_unstable_by(|a, b| (a.mover, a.target).cmp(&(b.mover, b.target)).then(a.from.total_cmp(&b.from)));
    approaches.dedup_by_key(|approach| (approach.mover, approach.target));
    approaches.sort_unstable_by(|a, b| a.from.total_cmp(&b.from).then((a.mover, a.target).cmp(&(b.mover, b.target))));
    Ok(())
}

/// Casts the pairs, each up to the earliest time that is known.
fn cast_all(question: &CastQuestion, room: &mut CastRoom) -> Result<SceneCastAnswer> {
    let CastQuestion { others, config, .. } = question;
    let CastRoom { movers, approaches, caches, .. } = room;
    let world = others.world;
    let mut earliest =
        SceneCastAnswer { outcome: CastOutcome::Free, time_lower: config.time_end, ..SceneCastAnswer::default() };
    let mut until = config.time_end;
    for approach in &**approaches {
        // Before that time the pair is free; and nothing is earlier than the beginning.
        if earliest.outcome != CastOutcome::Free && (approach.from > until || until <= config.time_begin) {
            break;
        }
        let mover = &movers[approach.mover as usize];
        let rests;
        let (other, second) = match approach.target {
            CastTarget::Mover(k) => (movers[k as usize].proxy, question.carried(&movers[k as usize])),
            CastTarget::Piece(proxy) => {
                rests = Motion::Fixed(world.proxies.poses[proxy as usize]);
                let shape = &world.proxies.shapes[proxy as usize];
                (proxy, Carried { shape, motion: &rests, place: None })
            }
        };
        let pair = [mover.proxy, other];
        if !world.is_tested(pair.map(|proxy| proxy as usize), true) {
            continue;
        }
        let bodies = [question.carried(mover), second];
        let (mut answer, mut pieces) = (CastAnswer::default(), [None; 2]);
        let config = CastConfig { time_end: until, ..**config };
        let rests = matches!(approach.target, CastTarget::Piece(_));
        if let Some(found) = cast_compounds((world, pair), bodies, rests, &config, caches)? {
            (answer, pieces) = found;
        } else {
            match (world.proxies.bodies.ground(other as usize), approach.target) {
                (Some(ground), CastTarget::Piece(_)) => {
                    let place = &world.proxies.poses[other as usize];
                    let GroundCastAnswer { answer: found, triangle } =
                        ground_cast_carried(bodies[0], ground.at(place), &config)?;
                    answer = found;
                    answer.contact.feature2 = face(triangle);
                }
                _ => motion::cast_carried(bodies, config.range(), caches.of(pair), &config, &mut answer)?,
            }
        }
        earliest.queries = earliest.queries.saturating_add(answer.queries);
        if answer.outcome == CastOutcome::Free {
            continue;
        }
        let is_earlier = match answer.outcome {
            CastOutcome::Hit => !(earliest.time_upper <= answer.time_upper),
            _ => answer.time_lower < earliest.time_lower,
        };
        if is_earlier {
            let CastAnswer { outcome, time_upper, upper, contact, .. } = answer;
            let time_lower = earliest.time_lower.min(answer.time_lower);
            until = if outcome == CastOutcome::Hit { time_upper } else { answer.time_lower };
            let mut pair = signed(world, pair, contact);
            pair.name_pieces(pieces);
            earliest = SceneCastAnswer { outcome, queries: earliest.queries, time_lower, time_upper, upper, pair };
        } else {
            earliest.time_lower = earliest.time_lower.min(answer.time_lower);
        }
    }
    Ok(earliest)
}

/// Casts a pair of which one is a compound, or both are; none of other pairs. `rests`: body 2 is where the scene has it, and may
/// be a ground.
fn cast_compounds(
    (world, pair): (&World, [u32; 2]),
    bodies: [Carried; 2],
    rests: bool,
    config: &CastConfig,
    caches: &mut Caches,
) -> Result<Option<(CastAnswer, NamedPieces)>> {
    let rows = &world.proxies.bodies;
    let compounds = pair.map(|row| rows.compound(row as usize));
    if let [Some(moving), None] = compounds
        && rests
        && let Some(ground) = rows.ground(pair[1] as usize)
    {
        let place = ground.at(&world.proxies.poses[pair[1] as usize]);
        return cast_at_ground((moving, bodies[0].motion), place, config).map(Some);
    }
    if compounds.iter().all(Option::is_none) {
        return Ok(None);
    }
    let whole = |k: usize| match compounds[k] {
        Some(compound) => Ok(compound.clone()),
        None => {
            let shape = world.proxies.shapes[pair[k] as usize].clone();
            Compound::of_single(shape, bodies[k].place.copied().unwrap_or(Pose::IDENTITY)).map(Arc::new)
        }
    };
    let [one, other] = [whole(0)?, whole(1)?];
    let moving = [
        MovingCompound { compound: &one, motion: bodies[0].motion },
        MovingCompound { compound: &other, motion: bodies[1].motion },
    ];
    let mut found = CompoundCastAnswer::default();
    compound::cast_pieces(moving, caches.of_compounds(pair)?, config, &mut found)?;
    let named = |k: usize, piece: u32| compounds[k].map(|_| piece);
    Ok(Some((found.answer, [named(0, found.piece1), named(1, found.piece2)])))
}

/// Casts a compound at a ground that rests, piece by piece.
fn cast_at_ground(
    (compound, motion): (&Compound, &Motion),
    ground: PlacedGround,
    config: &CastConfig,
) -> Result<(CastAnswer, NamedPieces)> {
    let mut config = *config;
    let (mut first, mut named, mut queries) = (CastAnswer::default(), None, 0_u32);
    for (number, piece) in (0..).zip(compound.pieces()) {
        let place = (piece.pose != Pose::IDENTITY).then_some(&piece.pose);
        let carried = Carried { shape: &piece.shape, motion, place };
        let GroundCastAnswer { mut answer, triangle } = ground_cast_carried(carried, ground, &config)?;
        queries = queries.saturating_add(answer.queries);
        let is_first = match (first.outcome, answer.outcome) {
            (CastOutcome::None, _) => true,
            (_, CastOutcome::Free) => false,
            (CastOutcome::Free, _) => true,
            (CastOutcome::Hit, CastOutcome::Hit) => answer.time_upper < first.time_upper,
            _ => answer.time_lower < first.time_lower,
        };
        let lower = if first.outcome == CastOutcome::None { f64::INFINITY } else { first.time_lower };
        if answer.outcome != CastOutcome::Free {
            answer.contact.feature2 = face(triangle);
        }
        if is_first {
            (first, named) = (answer, (answer.outcome != CastOutcome::Free).then_some(number));
        }
        first.time_lower = lower.min(answer.time_lower);
        config.time_end = match answer.outcome {
            CastOutcome::Free => config.time_end,
            CastOutcome::Hit => answer.time_upper,
            _ => answer.time_lower,
        };
        if config.time_end <= config.time_begin {
            break;
        }
    }
    first.queries = queries;
    Ok((first, [named, None]))
}
