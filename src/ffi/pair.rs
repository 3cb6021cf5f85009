//! Pair queries: thin doors to `pair`, in front of functions that take some tens of nanoseconds. Nothing is copied; poses
//! and configuration are read where the caller has them.

use std::mem::MaybeUninit;

use super::enumerators::read_enumerator;
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{caught, guard};
use super::pointers::{exclusive, input};
use super::structs::{Versioned, view_struct};
use super::tuning::{CPairTuning, PairTuning, read_pair_tuning};
use crate::base::error::Result;
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::pair::verify::verify;
use crate::pair::{self, DecidedBy, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, Placed};
use crate::shape::Shape;

/// What a pair query is asked for. Begin with SWIFTPROX_PAIR_CONFIG_DEFAULT, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPairConfig {
    /// Set by SWIFTPROX_PAIR_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Pairs farther apart than this are SWIFTPROX_OUTCOME_BEYOND; from 0 to infinity (the default: none is).
    pub distance_tolerance: f64,
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to 1e-2 (the default).
    pub rotation_limit: f64,
    /// Of swiftprox_pair_approximate: upper - lower may be as large as this ... Other queries do not look at this and the two that
    /// follow, not even whether they are in range: from 0 to infinity, and 1 or more for the budget.
    pub absolute_error: f64,
    /// ... or as this times lower. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// Of swiftprox_pair_approximate: steps of marching after which it stops with what it has, 1 or more; UINT32_MAX (the default):
    /// no limit. What marching leaves open is decided all the same, however long it takes; of bodies that intersect it may leave it
    /// open only after as many steps as a query without a budget may make. The next query with the same cache goes on where this
    /// one stopped, unless tuning->start says that it begin anew, at the tables or afresh: it may then stop there for ever.
    pub step_budget: u32,
    /// Where it starts and which levels of detail it goes through (swiftprox/tuning.h). Default: null, the automatic choice.
    pub tuning: *const CPairTuning,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CPairConfig {
    const NAME: &'static str = "swiftprox_pair_config";
}

impl CPairConfig {
    /// What the header calls its default.
    pub const DEFAULT: CPairConfig = CPairConfig {
        struct_size: size_of::<CPairConfig>(),
        distance_tolerance: f64::INFINITY,
        rotation_limit: ROTATION_LIMIT,
        absolute_error: 0.0,
        relative_error: 0.0,
        step_budget: u32::MAX,
        tuning: std::ptr::null(),
    };
}

/// What a pair remembers from its last query, for the caller to keep: all zero is cold, any bytes are safe. It changes how fast
/// an answer comes, never the verdict. What the words mean is the library's own.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct CPairCache {
    /// Not to be looked at.
    pub words: [u32; 24],
}

// A `PairCache` lives in the words, which leave it room to grow; any bytes make a valid one.
const _: () = {
    assert!(size_of::<PairCache>() <= size_of::<CPairCache>());
    assert!(align_of::<PairCache>() <= align_of::<CPairCache>());
};

/// The distance of two objects with a rigorous interval, witness points, normal and features. Of an intersecting pair the
/// distance is 0 and the proof is given; points, normal and features stay unset (see swiftprox_pair_contact). Of a pair farther
/// apart than config->distance_tolerance less is said, see SWIFTPROX_OUTCOME_BEYOND. What an answer leaves out is NaN, or
/// SWIFTPROX_FEATURE_KIND_NONE.
///
/// A pose is 12 doubles, the row-major 3x4 matrix [R|T]: the object is R*v + T, exactly as the doubles give it. `cache` is what
/// the pair remembers: all zero is cold, hand the same one back for the same pair in the same order, one for each pair.
/// `config` may be null for the defaults. On failure the answer is reset: its outcome is SWIFTPROX_OUTCOME_NONE.
///
/// SWIFTPROX_ERROR_POSE: a pose is refused; the message says why. SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config is out of
/// range; those that are for swiftprox_pair_approximate alone only there. SWIFTPROX_ERROR_NULL_POINTER,
/// SWIFTPROX_ERROR_STRUCT_SIZE: the message names the argument. SWIFTPROX_ERROR_BUG: the cache is reset, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_distance(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::distance, [(shape1, pose1), (shape2, pose2)], cache, config, answer) }
}

/// The verdict alone: SWIFTPROX_OUTCOME_INTERSECTING, or SWIFTPROX_OUTCOME_SEPARATED with lower > 0 and an upper that holds but
/// need not be tight; and SWIFTPROX_OUTCOME_BEYOND with a finite config->distance_tolerance. Faster than the distance where bodies
/// intersect or nearly do. Arguments and errors as of swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_intersection(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::intersection, [(shape1, pose1), (shape2, pose2)], cache, config, answer) }
}

/// As swiftprox_pair_distance, and of an intersecting pair a common point (as witness point of both objects), the unit normal along
/// which the objects overlap least and the features that meet there: those of swiftprox_pair_depth, which says how deep they are in
/// each other, and where. Arguments and errors as of swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_contact(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::contact, [(shape1, pose1), (shape2, pose2)], cache, config, answer) }
}

/// The distance as narrow as asked for, or as exact answers are: the query stops as soon as upper - lower is at most
/// config->absolute_error or config->relative_error * lower; both 0 ask for the exact distance. [lower, upper] holds the
/// distance, `distance` is the lower end unless the answer is exact. The verdict is as certain as that of swiftprox_pair_distance,
/// unless config->step_budget ran out: then decided_by is SWIFTPROX_DECIDED_BY_BUDGET, and the next call with the same cache
/// goes on from there, unless config->tuning->start says that it begin anew. Points and features stay unset in an answer that
/// comes from maps of support functions or from levels of detail. Arguments and errors as of swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_approximate(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::approximate, [(shape1, pose1), (shape2, pose2)], cache, config, answer) }
}

/// Re-checks an answer, trusting nothing of the search that found it. SWIFTPROX_OK: it holds for these shapes and poses.
///
/// Verdict and interval are proved for the exact objects R*v + T, with no tolerance. Separated and beyond: the distance is not 0,
/// and it is in [lower, upper]; a lower of 0 is said only of a distance below all doubles, or beyond a tolerance. Intersecting: the
/// differences of the proof's vertex pairs hold the origin in their hull. Undecided: the distance is at most upper. `distance` is
/// in the interval.
///
/// The other members are rounded, so they hold up to an allowance of 2^-47 (radius 1 + radius 2 + distance of the centres in the
/// world and of each from its local origin). The normal is of unit length; along it separated objects are at least lower apart.
/// The witness points are in their objects, and the same in both frames. Those of separated objects are on their features, at a
/// distance in [lower, upper]; those of a contact are one point. What an answer does not say is NaN. decided_by and statistics are
/// not checked, nor is more of a contact's normal than its length.
///
/// Takes time linear in the number of vertices: double-double arithmetic proves most intervals, integers the others.
///
/// SWIFTPROX_ERROR_UNVERIFIED: it does not hold; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT: an enumerator in the
/// answer is unknown, it holds no outcome, its proof has no such vertex, or a normal or points are said of objects so large or far
/// apart that doubles cannot tell. SWIFTPROX_ERROR_POSE, SWIFTPROX_ERROR_NULL_POINTER: as of swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_verify(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    answer: *const PairAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (shape1, pose1, shape2, pose2, answer) = unsafe {
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                read_answer(answer)?,
            )
        };
        Ok(verify([shape1.at(pose1), shape2.at(pose2)], answer)?)
    })
}

/// Checks the arguments of a query and runs it. `run` is one of the functions of `pair`, as a type of its own rather than as a
/// pointer: the call is direct.
///
/// # Safety
/// The pointers meet the header's pointer rules.
#[inline(always)]
unsafe fn query(
    run: impl Fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>,
    [(shape1, pose1), (shape2, pose2)]: [(*const Shape, *const f64); 2],
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the caller's; a pose is twelve doubles, row by row, as is `Pose`.
    let status = caught(move || unsafe {
        let answer = write_answer(answer)?;
        let shape1 = input(shape1, "shape1")?;
        let pose1 = input(pose1.cast::<Pose>(), "pose1")?;
        let shape2 = input(shape2, "shape2")?;
        let pose2 = input(pose2.cast::<Pose>(), "pose2")?;
        let cache = exclusive(cache.cast::<PairCache>(), "cache")?;
        let config = read_config(config)?;
        Ok(run([shape1.at(pose1), shape2.at(pose2)], cache, &config, answer)?)
    });
    if status != StatusCode::Ok {
        // SAFETY: the caller's.
        unsafe { reset(status, cache, answer) };
    }
    status
}

/// Leaves nothing half-written behind a failed query.
///
/// # Safety
/// The pointers meet the header's pointer rules.
#[cold]
#[inline(never)]
unsafe fn reset(status: StatusCode, cache: *mut CPairCache, answer: *mut PairAnswer) {
    if !answer.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { answer.write(PairAnswer::default()) };
    }
    if status == StatusCode::ErrorBug && !cache.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { cache.write(CPairCache::default()) };
    }
}

/// The caller's configuration in Rust's terms, or the defaults for null.
///
/// # Safety
/// `config` and its tuning meet the header's pointer rules.
#[inline(always)]
pub(super) unsafe fn read_config(config: *const CPairConfig) -> Checked<PairConfig> {
    if config.is_null() {
        return Ok(PairConfig::default());
    }
    let mut older = MaybeUninit::uninit();
    // SAFETY: not null, the rest by the caller.
    let config = unsafe { view_struct(config, &CPairConfig::DEFAULT, &mut older) }?;
    // SAFETY: by the caller.
    let PairTuning { start, levels, refinement } = unsafe { read_pair_tuning(config.tuning) }?;
    Ok(PairConfig {
        distance_tolerance: config.distance_tolerance,
        rotation_limit: config.rotation_limit,
        start,
        absolute_error: config.absolute_error,
        relative_error: config.relative_error,
        step_budget: config.step_budget,
        levels,
        refinement,
    })
}

/// The caller's answer to write to. It may hold any bytes: those that Rust must never see are replaced first.
///
/// # Safety
/// `answer` meets the header's pointer rules.
#[inline(always)]
unsafe fn write_answer<'a>(answer: *mut PairAnswer) -> Checked<&'a mut PairAnswer> {
    if answer.is_null() {
        return Err(Failure::null("answer"));
    }
    // SAFETY: not null, writable by the caller; with valid enumerators any other bytes make a valid answer.
    unsafe {
        (&raw mut (*answer).outcome).write(Outcome::None);
        (&raw mut (*answer).decided_by).write(DecidedBy::None);
        (&raw mut (*answer).feature1.kind).write(FeatureKind::None);
        (&raw mut (*answer).feature2.kind).write(FeatureKind::None);
        Ok(&mut *answer)
    }
}

/// The caller's answer to read, its enumerators checked.
///
/// # Safety
/// `answer` meets the header's pointer rules.
unsafe fn read_answer<'a>(answer: *const PairAnswer) -> Checked<&'a PairAnswer> {
    if answer.is_null() {
        return Err(Failure::null("answer"));
    }
    // SAFETY: not null, readable by the caller; read as integers, whatever they hold.
    let [outcome, decided_by, kind1, kind2] = unsafe {
        [
            (&raw const (*answer).outcome).cast::<i32>().read(),
            (&raw const (*answer).decided_by).cast::<i32>().read(),
            (&raw const (*answer).feature1.kind).cast::<i32>().read(),
            (&raw const (*answer).feature2.kind).cast::<i32>().read(),
        ]
    };
    read_enumerator::<Outcome>(outcome, "answer->outcome", "swiftprox_outcome")?;
    read_enumerator::<DecidedBy>(decided_by, "answer->decided_by", "swiftprox_decided_by")?;
    read_enumerator::<FeatureKind>(kind1, "answer->feature1.kind", "swiftprox_feature_kind")?;
    read_enumerator::<FeatureKind>(kind2, "answer->feature2.kind", "swiftprox_feature_kind")?;
    // SAFETY: its enumerators are valid, and any other bytes are.
    Ok(unsafe { &*answer })
}

#[cfg(test)]
mod tests {
    use super::super::library::swiftprox_library_last_error_message;
    use super::*;
    use crate::base::math::Vector;
    use crate::shape::ShapeOptions;
    use std::ffi::CStr;
    use std::ptr::null;

    #[test]
    fn a_panic_in_a_query_resets_its_answer_and_cache_and_no_other() {
        let corners = [Vector::zeros(), Vector::x(), Vector::y(), Vector::z()];
        let shape = Shape::from_points(&corners, &ShapeOptions::default()).unwrap();
        let poses = [0.0, 3.0].map(|x| [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let ask = |inject: bool, cache: &mut CPairCache, answer: &mut PairAnswer| {
            let (pose1, pose2) = (poses[0].as_ptr(), poses[1].as_ptr());
            // SAFETY: every pointer is valid, and cache and answer are this call's.
            unsafe {
                if inject {
                    query(
                        |_, _, _, _| panic!("injected"),
                        [(&raw const shape, pose1), (&raw const shape, pose2)],
                        cache,
                        null(),
                        answer,
                    )
                } else {
                    swiftprox_pair_distance(&shape, pose1, &shape, pose2, cache, null(), answer)
                }
            }
        };
        std::thread::scope(|threads| {
            for breaks in [true, false, true, false] {
                threads.spawn(move || {
                    let (mut cache, mut answer) = (CPairCache::default(), PairAnswer::default());
                    for _ in 0..50 {
                        assert_eq!(ask(false, &mut cache, &mut answer), StatusCode::Ok);
                        assert!(answer.lower <= 2.0 && 2.0 <= answer.upper, "{answer:?}");
                        if breaks {
                            assert_ne!(cache.words, [0; 24]);
                            assert_eq!(ask(true, &mut cache, &mut answer), StatusCode::ErrorBug);
                            assert_eq!(cache.words, [0; 24]);
                            // As text, since NaN is not equal to itself.
                            assert_eq!(format!("{answer:?}"), format!("{:?}", PairAnswer::default()));
                            assert!(answer.distance.is_nan() && answer.lower.is_nan() && answer.upper.is_nan());
                            // SAFETY: never null, terminated, unchanged until this thread's next failure.
                            let message = unsafe { CStr::from_ptr(swiftprox_library_last_error_message()) };
                            assert!(message.to_string_lossy().contains("bug in swiftprox"), "{message:?}");
                        }
                    }
                });
            }
        });
    }
}
