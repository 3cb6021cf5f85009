//! Pair queries: thin doors to `pair`, in front of functions that take some tens of nanoseconds. Nothing is copied; poses
//! and configuration are read where the caller has them.

use std::mem::MaybeUninit;

use super::enumerators::read_enumerator;
use super::failure::{Checked, Failure, StatusCode};
use super::guard::{caught, guard};
use super::pointers::{exclusive, handle, input};
use super::structs::{Versioned, view_struct};
use super::tuning::{CPairTuning, PairTuning, read_pair_tuning};
use crate::base::error::Result;
use crate::base::math::Pose;
use crate::pair::{self, DecidedBy, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance};
use crate::shape::Shape;
use crate::verify::verify;

/// Options of a pair query. Initialise with SWIFTPROX_PAIR_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPairConfig {
    /// Set by SWIFTPROX_PAIR_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Pairs farther apart than this get SWIFTPROX_OUTCOME_BEYOND. From 0 to infinity (the default: never).
    pub max_distance: f64,
    /// For swiftprox_pair_approximate: allowed upper - lower, from 0 to infinity. Default: 0. Other queries ignore this and the two
    /// members below, even out of range.
    pub absolute_error: f64,
    /// For swiftprox_pair_approximate: allowed (upper - lower) / lower, from 0 to infinity. It is enough to meet one of the two
    /// errors. Both 0 (the default): as narrow as exact answers.
    pub relative_error: f64,
    /// For swiftprox_pair_approximate: the largest number of marching steps, 1 or more. UINT32_MAX (the default): no limit. It does
    /// not limit the methods that decide what marching leaves open. The next query with the same cache continues, unless
    /// tuning->start makes it begin anew; then it may stop there every time.
    pub step_budget: u32,
    /// Start and levels of detail (swiftprox/tuning.h). Default: null, the automatic choice.
    pub tuning: *const CPairTuning,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CPairConfig {
    const NAME: &'static str = "swiftprox_pair_config";
}

impl CPairConfig {
    /// The defaults, as in the header.
    pub const DEFAULT: CPairConfig = CPairConfig {
        struct_size: size_of::<CPairConfig>(),
        max_distance: f64::INFINITY,
        absolute_error: 0.0,
        relative_error: 0.0,
        step_budget: u32::MAX,
        tuning: std::ptr::null(),
    };
}

/// A shape at a pose, an argument of pair queries by value. Both pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPlaced {
    /// The shape.
    pub shape: *const Shape,
    /// 12 doubles, the row-major 3x4 matrix [R|T].
    pub pose: *const f64,
}

/// The cache of a pair, owned by the caller. Zero it before the first query; any bytes are safe. It affects speed, never the
/// verdict.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct CPairCache {
    /// Opaque.
    pub words: [u32; 24],
}

// A `PairCache` lives in the words, which leave it room to grow; any bytes make a valid one.
const _: () = {
    assert!(size_of::<PairCache>() <= size_of::<CPairCache>());
    assert!(align_of::<PairCache>() <= align_of::<CPairCache>());
};

/// Computes the distance of two objects: a rigorous interval, witness points, normal and features. For intersecting pairs the
/// distance is 0 and the answer holds the proof; points, normal and features are unset (see swiftprox_pair_contact). Pairs beyond
/// config->max_distance get less, see SWIFTPROX_OUTCOME_BEYOND. Unset numbers are NaN, unset features
/// SWIFTPROX_FEATURE_KIND_NONE.
///
/// Keep one `cache` per pair, zeroed at first, and pass the objects in the same order. On failure the answer is reset and its
/// outcome is SWIFTPROX_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config is out of range.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_distance(
    object1: CPlaced,
    object2: CPlaced,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::distance, [object1, object2], cache, config, answer) }
}

/// Decides only whether two objects intersect. The outcome is SWIFTPROX_OUTCOME_INTERSECTING, SWIFTPROX_OUTCOME_SEPARATED with
/// lower > 0 and an upper that may be loose, or, with a finite config->max_distance, SWIFTPROX_OUTCOME_BEYOND. It is faster
/// than the distance for bodies that intersect or nearly do. Same arguments and errors as swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_intersection(
    object1: CPlaced,
    object2: CPlaced,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::intersection, [object1, object2], cache, config, answer) }
}

/// Like swiftprox_pair_distance, but intersecting pairs also get a common point, the unit normal of least overlap and the features
/// there. The common point is the witness point of both objects. Normal and features are those of swiftprox_pair_depth, which also
/// gives the depth. Same arguments and errors as swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_contact(
    object1: CPlaced,
    object2: CPlaced,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::contact, [object1, object2], cache, config, answer) }
}

/// Computes the distance to a given error: it stops when upper - lower is at most config->absolute_error or
/// config->relative_error * lower. [lower, upper] contains the distance; `distance` is lower unless the answer is exact. Points and
/// features are unset in answers from support maps or levels of detail.
///
/// The verdict is guaranteed as in swiftprox_pair_distance, unless the step budget ran out (SWIFTPROX_DECIDED_BY_BUDGET). The next
/// call with the same cache then continues, unless config->tuning->start makes it begin anew. Same arguments and errors as
/// swiftprox_pair_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_approximate(
    object1: CPlaced,
    object2: CPlaced,
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { query(pair::approximate, [object1, object2], cache, config, answer) }
}

/// Checks an answer independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses.
///
/// Verdict and interval are proved without tolerance for the exact objects R*v + T. `distance` must be in the interval. Other
/// members may be off by 2^-47 * (both radii + distances of the centres from each other and from their local origins). The
/// normal must have unit length, and separate separated objects by at least lower. Witness points must lie in their objects and
/// agree in both frames: on the features if separated, one common point for a contact. decided_by, statistics and the direction
/// of a contact's normal are not checked. Time is linear in the number of vertices.
///
/// SWIFTPROX_ERROR_UNVERIFIED: the answer is wrong; the message says where. SWIFTPROX_ERROR_INVALID_ARGUMENT: the answer has an
/// unknown enumerator, no outcome or no such vertex, or objects are too large or far apart for doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_verify(
    object1: CPlaced,
    object2: CPlaced,
    answer: *const PairAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (bodies, answer) = unsafe { (bodies(object1, object2)?, read_answer(answer)?) };
        Ok(verify(bodies, answer)?)
    })
}

/// A shape where it is, in Rust's terms.
///
/// # Safety
/// The pointers meet the header's pointer rules for `'a`.
#[inline(always)]
pub(super) unsafe fn body<'a>(object: CPlaced, names: [&str; 2]) -> Checked<Placed<'a>> {
    // SAFETY: by the caller; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe { Ok(handle(object.shape, names[0])?.at(input(object.pose.cast::<Pose>(), names[1])?)) }
}

/// The two of a pair.
///
/// # Safety
/// As of [`body`].
#[inline(always)]
pub(super) unsafe fn bodies<'a>(object1: CPlaced, object2: CPlaced) -> Checked<[Placed<'a>; 2]> {
    // SAFETY: by the caller.
    unsafe {
        Ok([body(object1, ["object1.shape", "object1.pose"])?, body(object2, ["object2.shape", "object2.pose"])?])
    }
}

/// Checks the arguments of a query and runs it. `run` is one of the functions of `pair`, as a type of its own rather than as a
/// pointer: the call is direct.
///
/// # Safety
/// The pointers meet the header's pointer rules.
#[inline(always)]
unsafe fn query(
    run: impl Fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<()>,
    [object1, object2]: [CPlaced; 2],
    cache: *mut CPairCache,
    config: *const CPairConfig,
    answer: *mut PairAnswer,
) -> StatusCode {
    // SAFETY: the caller's; a pose is twelve doubles, row by row, as is `Pose`.
    let status = caught(move || unsafe {
        let answer = write_answer(answer)?;
        let bodies = bodies(object1, object2)?;
        let cache = exclusive(cache.cast::<PairCache>(), "cache")?;
        let config = read_config(config)?;
        Ok(run(bodies, cache, &config, answer)?)
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
        max_distance: config.max_distance,
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
    // SAFETY: not null, readable by the caller.
    unsafe { check_enumerators(answer, "answer") }?;
    // SAFETY: its enumerators are valid, and any other bytes are.
    Ok(unsafe { &*answer })
}

/// Refuses an answer of the caller's with an unknown enumerator; `name` is what the header calls it.
///
/// # Safety
/// `answer` is not null, and readable by the caller.
pub(super) unsafe fn check_enumerators(answer: *const PairAnswer, name: &str) -> Checked<()> {
    // SAFETY: by the caller; read as integers, whatever they hold.
    let [outcome, decided_by, kind1, kind2] = unsafe {
        [
            (&raw const (*answer).outcome).cast::<i32>().read(),
            (&raw const (*answer).decided_by).cast::<i32>().read(),
            (&raw const (*answer).feature1.kind).cast::<i32>().read(),
            (&raw const (*answer).feature2.kind).cast::<i32>().read(),
        ]
    };
    read_enumerator::<Outcome>(outcome, format_args!("{name}->outcome"), "swiftprox_outcome")?;
    read_enumerator::<DecidedBy>(decided_by, format_args!("{name}->decided_by"), "swiftprox_decided_by")?;
    read_enumerator::<FeatureKind>(kind1, format_args!("{name}->feature1.kind"), "swiftprox_feature_kind")?;
    read_enumerator::<FeatureKind>(kind2, format_args!("{name}->feature2.kind"), "swiftprox_feature_kind")?;
    Ok(())
}

/// The same of a signed distance; `name` is that of the struct itself.
///
/// # Safety
/// As of [`check_enumerators`].
pub(super) unsafe fn check_signed_enumerators(answer: *const SignedDistance, name: &str) -> Checked<()> {
    // SAFETY: by the caller; read as integers, whatever they hold.
    let [outcome, kind1, kind2] = unsafe {
        [
            (&raw const (*answer).outcome).cast::<i32>().read(),
            (&raw const (*answer).feature1.kind).cast::<i32>().read(),
            (&raw const (*answer).feature2.kind).cast::<i32>().read(),
        ]
    };
    read_enumerator::<Outcome>(outcome, format_args!("{name}.outcome"), "swiftprox_outcome")?;
    read_enumerator::<FeatureKind>(kind1, format_args!("{name}.feature1.kind"), "swiftprox_feature_kind")?;
    read_enumerator::<FeatureKind>(kind2, format_args!("{name}.feature2.kind"), "swiftprox_feature_kind")?;
    Ok(())
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
            let objects = poses.each_ref().map(|pose| CPlaced { shape: &shape, pose: pose.as_ptr() });
            // SAFETY: every pointer is valid, and cache and answer are this call's.
            unsafe {
                if inject {
                    query(|_, _, _, _| panic!("injected"), objects, cache, null(), answer)
                } else {
                    swiftprox_pair_distance(objects[0], objects[1], cache, null(), answer)
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
