//! The pieces that a ray meets in a scene: the trees' boxes select candidates, and each body's own cast decides. If intervals do
//! not tell which of two comes first, both are cast again in integers.

use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U};
use crate::base::memory::push;
use crate::compound;
use crate::ground::GroundRayAnswer;
use crate::ray::{Ray, RayAnswer, RayOutcome, cast_ray, cast_ray_in_integers};
use crate::scene::near::tree::Branch;
use crate::scene::sets::others::Others;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::grounds::face;
use crate::scene::world::object::ObjectId;
use crate::scene::world::rows::Label;

/// The result of a ray query.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum RayHits {
    /// The first that it meets, or may meet where a curved one is undecided.
    #[default]
    First = 0,
    /// All, in order.
    All = 1,
    /// Any, found soonest; an undecided one where it certainly meets none.
    Any = 2,
}

/// A convex piece that a ray meets, a compound at the first of its pieces, or a ground at its first triangle, a face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct SceneRayHit {
    /// The object.
    pub object: ObjectId,
    /// The caller's own number of the object.
    pub user_data: u64,
    /// Which piece.
    pub piece: u32,
    /// Its place among all pieces of the scene, in order of creation, while none is removed.
    pub row: u32,
    /// The answer for the piece.
    pub answer: RayAnswer,
}

/// The question.
#[derive(Clone, Copy)]
pub(crate) struct RayQuestion<'a> {
    pub others: Others<'a>,
    pub ray: &'a Ray,
    pub hits: RayHits,
    /// The groups that the ray is tested against.
    pub mask: u32,
}

/// The room that the question is worked in.
pub(crate) struct RayRoom<'a> {
    pub open: &'a mut Vec<Branch>,
    pub found: &'a mut Vec<u32>,
    pub nearing: &'a mut Vec<Nearing>,
    pub hits: &'a mut Vec<SceneRayHit>,
}

/// A piece whose box the ray may meet, not before `from`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Nearing {
    from: f64,
    row: u32,
}

/// Lists what the ray meets, as far as requested.
///
/// # Errors
/// [`Error::Argument`](crate::base::error::Error::Argument) for a ray that is refused, as in [`cast_ray`],
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn cast(question: RayQuestion, room: &mut RayRoom) -> Result<()> {
    let RayQuestion { others, ray, hits: wanted, mask } = question;
    ray.check()?;
    let RayRoom { open, found, nearing, hits } = room;
    hits.clear();
    nearing.clear();
    others.list(open, found, |bounds| entry(ray, bounds).is_some())?;
    let proxies = &others.world.proxies;
    for &row in found.iter().filter(|&&row| proxies.labels[row as usize].groups & mask != 0) {
        if let Some(from) = entry(ray, others.box_of(row as usize)) {
            push(nearing, Nearing { from, row })?;
        }
    }
    nearing.sort_unstable_by(|a, b| a.from.total_cmp(&b.from).then(a.row.cmp(&b.row)));
    // Nothing that begins later can be the first.
    let mut until = ray.t_max;
    for &Nearing { from, row } in &**nearing {
        if from > until {
            break;
        }
        let (answer, of_compound) = cast_at(&others, row, &Ray { t_max: until, ..*ray }, false)?;
        if answer.outcome == RayOutcome::Miss {
            continue;
        }
        let Label { object, user_data, piece, .. } = proxies.labels[row as usize];
        push(hits, SceneRayHit { object, user_data, piece: of_compound.unwrap_or(piece), row, answer })?;
        // What is behind one that it may miss may be the first, or the only one.
        let is_certain = answer.outcome != RayOutcome::Undecided;
        match wanted {
            RayHits::Any if is_certain => {
                hits.drain(..hits.len() - 1);
                break;
            }
            RayHits::First if is_certain => until = until.min(answer.entry[1]),
            _ => {}
        }
    }
    if wanted == RayHits::Any {
        hits.truncate(1);
    }
    put_in_order(&others, ray, hits)?;
    if wanted == RayHits::First {
        hits.truncate(1);
        // The exit of the ray was not looked at yet.
        for first in &mut **hits {
            let (row, mut room) = (first.row as usize, Pose::IDENTITY);
            let again = match proxies.bodies.compound(row) {
                Some(compound) => {
                    let pieces = compound.at(&proxies.poses[row]).placed_pieces();
                    cast_ray(pieces.piece(first.piece, &mut room), ray)?
                }
                None => cast_at(&others, first.row, ray, false)?.0,
            };
            first.answer.exit = again.exit;
        }
    }
    Ok(())
}

/// Where a ray meets a piece, or first a ground or a compound; of that the piece.
fn cast_at(others: &Others, row: u32, ray: &Ray, in_integers: bool) -> Result<(RayAnswer, Option<u32>)> {
    let placed = others.placed(row as usize);
    let bodies = &others.world.proxies.bodies;
    if let Some(compound) = bodies.compound(row as usize) {
        let found = if in_integers {
            compound::cast_ray_in_integers(compound.at(placed.pose), ray)?
        } else {
            compound::cast_ray(compound.at(placed.pose), ray)?
        };
        return Ok((found.answer, Some(found.piece)));
    }
    let Some(ground) = bodies.ground(row as usize) else {
        return Ok((if in_integers { cast_ray_in_integers(placed, ray)? } else { cast_ray(placed, ray)? }, None));
    };
    let ground = ground.at(placed.pose);
    let GroundRayAnswer { mut answer, triangle } =
        if in_integers { ground.cast_ray_in_integers(ray)? } else { ground.cast_ray(ray)? };
    if answer.outcome != RayOutcome::Miss {
        answer.feature = face(triangle);
    }
    Ok((answer, None))
}

/// Puts hits in order of their entries, and those of one entry in order of creation. Entries that overlap are found in integers, as
/// neighbouring doubles.
fn put_in_order(others: &Others, ray: &Ray, hits: &mut [SceneRayHit]) -> Result<()> {
    debug_assert!(hits.iter().all(|hit| hit.answer.entry[0] <= hit.answer.entry[1]));
    let order = |a: &SceneRayHit, b: &SceneRayHit| {
        let [entry1, entry2] = [a.answer.entry, b.answer.entry];
        entry1[0].total_cmp(&entry2[0]).then(entry1[1].total_cmp(&entry2[1])).then(a.row.cmp(&b.row))
    };
    hits.sort_unstable_by(order);
    let mut first = 0;
    while first < hits.len() {
        // Finds the pieces that overlap it, those that overlap them, and so on.
        let (mut last, mut until) = (first + 1, hits[first].answer.entry[1]);
        while last < hits.len() && hits[last].answer.entry[0] <= until {
            until = until.max(hits[last].answer.entry[1]);
            last += 1;
        }
        if last > first + 1 {
            for hit in &mut hits[first..last] {
                if hit.answer.exact == 0 {
                    let exit = hit.answer.exit;
                    let (answer, piece) = cast_at(others, hit.row, ray, true)?;
                    hit.answer = RayAnswer { exit, ..answer };
                    hit.piece = piece.unwrap_or(hit.piece);
                }
            }
            hits[first..last].sort_unstable_by(order);
        }
        first = last;
    }
    Ok(())
}

/// Covers quotients that underflow.
const TINIEST: f64 = f64::MIN_POSITIVE;

/// The earliest point where a ray may enter a box, rounded down, if it may meet it.
///
/// The difference of an end and the origin is off by u of itself, its quotient by the direction by u more: 4u cover both. If the
/// direction has no component, the origin decides, exactly.
fn entry(ray: &Ray, bounds: &Aabb) -> Option<f64> {
    let (mut from, mut to) = (0.0_f64, ray.t_max);
    for k in 0..3 {
        let (origin, direction) = (ray.origin[k], ray.direction[k]);
        let [lower, upper] = [f64::from(bounds.lower[k]), f64::from(bounds.upper[k])];
        if direction == 0.0 {
            if origin < lower || origin > upper {
                return None;
            }
            continue;
        }
        let ends = [(lower - origin) / direction, (upper - origin) / direction];
        let [near, far] = if direction > 0.0 { ends } else { [ends[1], ends[0]] };
        // An infinite value or a NaN bounds nothing: a comparison with a NaN is false.
        let (near, far) = (near - (4.0 * U * near.abs() + TINIEST), far + (4.0 * U * far.abs() + TINIEST));
        if near > from {
            from = near;
        }
        if far < to {
            to = far;
        }
    }
    (from <= to).then_some(from)
}
