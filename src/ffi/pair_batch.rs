//! Many pairs, or many poses of one, at once.

use super::enumerators::{QueryNumber, read_enumerator};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{caught, guard};
use super::pair::{CPairCache, CPairConfig, read_config};
use super::pointers::{array, exclusive, handle, input};
use super::scene::{SceneHandle, change_guarded};
use crate::base::error::Error;
use crate::base::math::Pose;
use crate::base::memory::with_capacity;
use crate::pair::{PairAnswer, PairCache, PairQuestion, Query, batch, distance};
use crate::shape::Shape;

/// One pair of a batch.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPairQuestion {
    /// Shape 1.
    pub shape1: *const Shape,
    /// Pose of shape 1, 12 doubles.
    pub pose1: *const f64,
    /// Shape 2.
    pub shape2: *const Shape,
    /// Pose of shape 2, 12 doubles.
    pub pose2: *const f64,
    /// The pair's own cache; pairs must not share one.
    pub cache: *mut CPairCache,
}

/// Runs the query `kind` for `count` pairs; `answers[k]` belongs to `pairs[k]`. Answers and caches are bit for bit those of
/// swiftprox_pair_intersection, swiftprox_pair_distance, swiftprox_pair_contact or swiftprox_pair_approximate. With a `scene`, its
/// workers share batches of 2,048 pairs or more; null uses only the caller's thread. The scene does not change, but no other call
/// may use it meanwhile.
///
/// A refused pair gets a reset answer, and all others are answered; the message names the first. Null pointers and lack of memory
/// leave all unanswered. SWIFTPROX_ERROR_BUG resets all answers and caches. SWIFTPROX_ERROR_INVALID_ARGUMENT: kind is unknown, or a
/// member of config is out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_batch(
    kind: QueryNumber,
    pairs: *const CPairQuestion,
    count: usize,
    config: *const CPairConfig,
    scene: *mut SceneHandle,
    answers: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    let status = guard(|| unsafe {
        array(answers.cast_const(), count, "answers")?;
        (0..count).for_each(|k| answers.add(k).write(PairAnswer::default()));
        let answers = if count == 0 { &mut [] } else { std::slice::from_raw_parts_mut(answers, count) };
        let kind = read_enumerator::<Query>(kind, "kind", "swiftprox_query_kind")?;
        let config = read_config(config)?;
        let mut read = with_capacity(count)?;
        for (k, pair) in array(pairs, count, "pairs")?.iter().enumerate() {
            read.push(read_pair(pair).map_err(|failure| named(&failure, k))?);
        }
        if scene.is_null() {
            return Ok(batch(kind, &mut read, &config, answers, None)?);
        }
        change_guarded(scene, |scene| Ok(scene.ask_pairs(kind, &mut read, &config, answers)?))
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: the header's pointer rules; the bug came after all pointers had been looked at.
        unsafe {
            (0..count).for_each(|k| answers.add(k).write(PairAnswer::default()));
            (0..count).for_each(|k| (*pairs.add(k)).cache.write(CPairCache::default()));
        }
    }
    status
}

/// A shape at one or many poses, an argument of swiftprox_pair_distances by value. Pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPoses {
    /// The shape.
    pub shape: *const Shape,
    /// 12 doubles per pose, the row-major 3x4 matrix [R|T].
    pub poses: *const f64,
    /// Number of poses; 1 for an object that does not move.
    pub count: usize,
}

/// Computes the distances of one pair at many poses in turn. Answers and cache are bit for bit those of repeated calls of
/// swiftprox_pair_distance. Both objects have the same number of poses, or one has one. `answers` has room for the larger count.
///
/// A refused pose gets a reset answer, and all others are answered; the message names the first. SWIFTPROX_ERROR_INVALID_ARGUMENT:
/// the counts differ, and neither is 1. Other errors as in swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_distances(
    object1: CPoses,
    object2: CPoses,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answers: *mut PairAnswer,
) -> StatusCode {
    let count = if object1.count == 1 { object2.count } else { object1.count };
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    let status = caught(|| unsafe {
        array(answers.cast_const(), count, "answers")?;
        (0..count).for_each(|k| answers.add(k).write(PairAnswer::default()));
        if object2.count != 1 && object2.count != count {
            let message = format!(
                "object1.count is {} and object2.count {}: give as many poses of both, or one of either",
                object1.count, object2.count
            );
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
        }
        let (shape1, shape2) = (handle(object1.shape, "object1.shape")?, handle(object2.shape, "object2.shape")?);
        let poses1 = array(object1.poses.cast::<Pose>(), object1.count, "object1.poses")?;
        let poses2 = array(object2.poses.cast::<Pose>(), object2.count, "object2.poses")?;
        let cache = exclusive(cache.cast::<PairCache>(), "cache")?;
        let config = read_config(config)?;
        let mut first = Ok(());
        for k in 0..count {
            let pose1 = if poses1.len() == 1 { &poses1[0] } else { &poses1[k] };
            let pose2 = if poses2.len() == 1 { &poses2[0] } else { &poses2[k] };
            let answer = &mut *answers.add(k);
            if let Err(error) = distance([shape1.at(pose1), shape2.at(pose2)], cache, &config, answer) {
                *answer = PairAnswer::default();
                first = first.and(Err(refused_pose(error, k)));
            }
        }
        first
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: the header's pointer rules; the bug came after all pointers had been looked at.
        unsafe {
            (0..count).for_each(|k| answers.add(k).write(PairAnswer::default()));
            cache.write(CPairCache::default());
        }
    }
    status
}

/// The message for a refused pose.
#[cold]
fn refused_pose(error: Error, place: usize) -> Failure {
    let failure = Failure::from(error);
    Failure::new(failure.status, format!("pose {place}: {}", failure.message))
}

/// A failure of one of the pairs.
#[cold]
fn named(failure: &Failure, pair: usize) -> Failure {
    Failure::new(failure.status, format!("pairs[{pair}]: {}", failure.message))
}

/// A pair, in Rust's terms.
///
/// # Safety
/// Its pointers meet the header's pointer rules for `'a`.
unsafe fn read_pair<'a>(pair: &CPairQuestion) -> Checked<PairQuestion<'a>> {
    // SAFETY: by the caller; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        let (shape1, pose1) = (handle(pair.shape1, "shape1")?, input(pair.pose1.cast::<Pose>(), "pose1")?);
        let (shape2, pose2) = (handle(pair.shape2, "shape2")?, input(pair.pose2.cast::<Pose>(), "pose2")?);
        let cache = exclusive(pair.cache.cast::<PairCache>(), "cache")?;
        Ok(PairQuestion { bodies: [shape1.at(pose1), shape2.at(pose2)], cache })
    }
}
