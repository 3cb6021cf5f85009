//! Whether a set of objects meets anything at one of many times, given by the poses there, and at which it is found first.

use crate::base::error::{Error, Result, check_range};
use crate::base::math::Pose;
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Query};
use crate::scene::near::tree::Branch;
use crate::scene::search::query::PairResult;
use crate::scene::sets::caches::Caches;
use crate::scene::sets::members::{self, Boxes, Member, ObjectSet, PieceSide};
use crate::scene::sets::nearest::signed;
use crate::scene::sets::others::Others;
use crate::scene::world::content::World;
use crate::scene::world::rows::{are_far_apart, grown_box};

/// In which order times are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum PoseOrder {
    /// The first, the middle, the quarters, and so on: what is found is any of those that hit, and found soonest.
    #[default]
    Bisection = 0,
    /// One after the other: what is found is the first that hits.
    InOrder = 1,
}

/// At which of many times a set of objects meets something.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct FirstHit {
    /// The number of the time that was found to hit; how many times there are if none does.
    pub time: usize,
    /// How many times were tried.
    pub tried: usize,
    /// A pair that is no farther apart than `max_distance`, object 1 of the set; the scratch may decide which of several. Of an
    /// answer the verdict and its proof, or an interval of the distance. Null ids if nothing hits.
    pub pair: PairResult,
}

/// The question.
#[derive(Clone, Copy)]
pub(crate) struct FirstHitQuestion<'a> {
    pub others: Others<'a>,
    /// Those of all objects at the first time, then at the second, and so on.
    pub poses: &'a [Pose],
    pub order: PoseOrder,
    /// Pieces no farther apart than this hit.
    pub max_distance: f64,
}

/// The room that the question is worked in.
pub(crate) struct FirstHitRoom<'a> {
    pub members: &'a mut Vec<Member>,
    pub open: &'a mut Vec<Branch>,
    pub found: &'a mut Vec<u32>,
    pub caches: &'a mut Caches,
}

/// The first time in the order that hits. Poses of times that are not tried are not looked at.
///
/// # Errors
/// [`Error::Argument`] for a `max_distance` that is negative or NaN, and for poses that do not come out even, those of
/// [`members::list`].
pub(crate) fn first_hit(question: FirstHitQuestion, room: &mut FirstHitRoom) -> Result<FirstHit> {
    let FirstHitQuestion { others, poses, order, max_distance } = question;
    check_range("max_distance", max_distance, 0.0..=f64::MAX)?;
    let objects = others.set.ids.len();
    if objects == 0 || !poses.len().is_multiple_of(objects) {
        let are = format!("{} poses for a set of {objects} objects", poses.len());
        return Err(Error::Argument(format!("{are}: one for each object at each time")));
    }
    room.caches.make_room()?;
    let count = poses.len() / objects;
    let mut tried = 0;
    for time in in_order(order, count) {
        tried += 1;
        let set = ObjectSet { poses: Some(&poses[time * objects..][..objects]), ..*others.set };
        let named = |error: Error| error.about(&format!("time {time} of {count}"));
        if let Some(pair) = last_hit(&others, &set, room.caches, max_distance).map_err(named)? {
            return Ok(FirstHit { time, tried, pair });
        }
        members::list(others.world, &set, Boxes::Made, room.members).map_err(named)?;
        if let Some(pair) = hit(&others, room, max_distance).map_err(named)? {
            return Ok(FirstHit { time, tried, pair });
        }
    }
    Ok(FirstHit { time: count, tried, pair: PairResult::default() })
}

/// All numbers below a count.
fn in_order(order: PoseOrder, count: usize) -> impl Iterator<Item = usize> {
    // Binary digits the other way round (van der Corput 1935); what is not below the count is left out.
    let digits = usize::BITS - count.saturating_sub(1).leading_zeros();
    let all = if order == PoseOrder::Bisection { 1 << digits } else { count };
    let at = move |k: usize| match order {
        PoseOrder::Bisection if digits > 0 => k.reverse_bits() >> (usize::BITS - digits),
        PoseOrder::Bisection | PoseOrder::InOrder => k,
    };
    (0..all).map(at).filter(move |&time| time < count)
}

/// The pair that hit at the last time, of whatever scene and set, if it hits again.
fn last_hit(others: &Others, set: &ObjectSet, caches: &mut Caches, max_distance: f64) -> Result<Option<PairResult>> {
    let (world, Some(pair)) = (others.world, caches.last_hit.take()) else { return Ok(None) };
    let [Some(one), second] = members::find(world, set, pair)? else { return Ok(None) };
    let at = pair[1] as usize;
    match second {
        Some(second) if set.among => ask([&one, &second].map(|member| member.side(world)), world, caches, max_distance),
        None if at < world.proxies.len() && others.has(at) => {
            ask([one.side(world), others.side(at)], world, caches, max_distance)
        }
        _ => Ok(None),
    }
}

/// A pair of the set where it is that is no farther apart than `max_distance`.
fn hit(others: &Others, room: &mut FirstHitRoom, max_distance: f64) -> Result<Option<PairResult>> {
    let FirstHitRoom { members, open, found, caches } = room;
    let world = others.world;
    for (k, member) in members.iter().enumerate() {
        let shape = &world.proxies.shapes[member.proxy as usize];
        let grown = if max_distance > 0.0 {
            grown_box(shape, &member.pose, &member.spheres, max_distance)
        } else {
            member.bounds
        };
        others.list(open, found, |bounds| bounds.overlaps(&grown))?;
        for &other in &**found {
            let sides = [member.side(world), others.side(other as usize)];
            if let Some(pair) = ask(sides, world, caches, max_distance)? {
                return Ok(Some(pair));
            }
        }
        for second in members[k + 1..].iter().take_while(|_| others.set.among) {
            if let Some(pair) = ask([member, second].map(|member| member.side(world)), world, caches, max_distance)? {
                return Ok(Some(pair));
            }
        }
    }
    Ok(None)
}

/// Two pieces, unless they are not tested or are farther apart than `max_distance`.
fn ask(sides: [PieceSide; 2], world: &World, caches: &mut Caches, max_distance: f64) -> Result<Option<PairResult>> {
    let proxies = &world.proxies;
    let (rows, bodies) = (sides.map(|side| side.proxy), sides.map(|side| side.placed));
    if are_far_apart(&sides[0].spheres, &sides[1].spheres, max_distance)
        || !world.is_tested(rows.map(|proxy| proxy as usize), true)
    {
        return Ok(None);
    }
    let mut pieces = [None; 2];
    let answer = answer_if_hit(max_distance, |config, answer| {
        if let Some(compounds) = proxies.bodies.compound_pair(rows, bodies) {
            let cache = caches.of_compounds(rows)?;
            pieces = compounds.ask(Query::Intersection, cache, config, answer)?;
            return Ok(());
        }
        match proxies.bodies.ground_pair(rows) {
            None => pair::intersection(bodies, caches.of(rows), config, answer),
            Some(ground) => ground.ask(Query::Intersection, bodies, config, answer),
        }
    })?;
    Ok(answer.map(|answer| {
        caches.last_hit = Some(rows);
        let mut result = signed(world, rows, answer);
        result.name_pieces(pieces);
        result
    }))
}

/// The answer that `ask` gives for two bodies if they are no farther apart than `max_distance`; otherwise none.
fn answer_if_hit(
    max_distance: f64,
    ask: impl FnOnce(&PairConfig, &mut PairAnswer) -> Result<()>,
) -> Result<Option<PairAnswer>> {
    let mut answer = PairAnswer::default();
    let limit = if max_distance > 0.0 { max_distance } else { f64::INFINITY };
    let config = PairConfig { max_distance: limit, ..PairConfig::default() };
    ask(&config, &mut answer)?;
    let hits = match answer.outcome {
        // Curved bodies that may meet are not free.
        Outcome::Intersecting | Outcome::Undecided => true,
        Outcome::Separated => max_distance > 0.0,
        _ => false,
    };
    Ok(hits.then_some(answer))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_time_comes_once_and_the_middle_early() {
        for count in 0..70 {
            for order in [PoseOrder::Bisection, PoseOrder::InOrder] {
                let mut all: Vec<usize> = in_order(order, count).collect();
                assert!(order == PoseOrder::Bisection || all.is_sorted());
                all.sort_unstable();
                assert_eq!(all, (0..count).collect::<Vec<_>>());
            }
        }
        assert_eq!(in_order(PoseOrder::Bisection, 8).collect::<Vec<_>>(), [0, 4, 2, 6, 1, 5, 3, 7]);
    }
}
