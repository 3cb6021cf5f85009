//! Whether a set of objects meets anything at one of many times, given by the poses there, and at which it is found first.

use crate::base::error::{Error, Result, check_range};
use crate::base::math::Pose;
use crate::pair::{self, Outcome, PairAnswer, PairConfig, Placed, Query};
use crate::scene::near::tree::Branch;
use crate::scene::search::query::PairResult;
use crate::scene::sets::caches::Caches;
use crate::scene::sets::members::{self, Boxes, Member, ObjectSet};
use crate::scene::sets::nearest::signed;
use crate::scene::sets::others::Others;
use crate::scene::world::rows::{Spheres, are_far_apart, grown_box};

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
    /// A pair that is no farther apart than `max_distance`, object 1 of the set: of an answer the verdict and its proof, or an
    /// interval of the distance. Null ids if nothing hits.
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
        members::list(others.world, &set, Boxes::Made, room.members).map_err(named)?;
        if let Some(pair) = hit(&others, room, max_distance)? {
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

/// A pair of the set where it is that is no farther apart than `max_distance`.
fn hit(others: &Others, room: &mut FirstHitRoom, max_distance: f64) -> Result<Option<PairResult>> {
    let FirstHitRoom { members, open, found, caches } = room;
    let (world, proxies) = (others.world, &others.world.proxies);
    let mut look = |members: [u32; 2], spheres: [&Spheres; 2], bodies: [Placed; 2]| {
        let [one, other] = spheres;
        if are_far_apart(one, other, max_distance) || !world.is_tested(members.map(|proxy| proxy as usize), true) {
            return Ok(None);
        }
        let mut pieces = [None; 2];
        let ask = |config: &PairConfig, answer: &mut PairAnswer| {
            if let Some(compounds) = proxies.bodies.compound_pair(members, bodies) {
                let cache = caches.of_compounds(members)?;
                pieces = compounds.ask(Query::Intersection, cache, config, answer)?;
                return Ok(());
            }
            match proxies.bodies.ground_pair(members) {
                None => pair::intersection(bodies, caches.of(members), config, answer),
                Some(ground) => ground.ask(Query::Intersection, bodies, config, answer),
            }
        };
        let answer = answer_if_hit(max_distance, ask)?;
        Ok(answer.map(|answer| {
            let mut result = signed(world, members, answer);
            result.name_pieces(pieces);
            result
        }))
    };
    for (k, member) in members.iter().enumerate() {
        let shape = &proxies.shapes[member.proxy as usize];
        let grown = if max_distance > 0.0 {
            grown_box(shape, &member.pose, &member.spheres, max_distance)
        } else {
            member.bounds
        };
        others.list(open, found, |bounds| bounds.overlaps(&grown))?;
        for &other in &**found {
            let at = other as usize;
            let bodies = [member.placed(world), others.placed(at)];
            if let Some(pair) = look([member.proxy, other], [&member.spheres, &proxies.spheres(at)], bodies)? {
                return Ok(Some(pair));
            }
        }
        for second in members[k + 1..].iter().take_while(|_| others.set.among) {
            let bodies = [member.placed(world), second.placed(world)];
            if let Some(pair) = look([member.proxy, second.proxy], [&member.spheres, &second.spheres], bodies)? {
                return Ok(Some(pair));
            }
        }
    }
    Ok(None)
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
