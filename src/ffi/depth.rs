//! Depths and contact manifolds of pairs.

use super::enumerators::{DepthEndingNumber, read_enumerator};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::pair::{CPairConfig, read_config};
use super::pointers::{array, exclusive, input, output};
use super::structs::{Versioned, read_struct};
use crate::base::math::{Pose, ROTATION_LIMIT};
use crate::pair::verify::{verify_depth, verify_manifold};
use crate::pair::{
    self, DepthAnswer, DepthCache, DepthConfig, DepthEnding, FeatureKind, Fill, Manifold, ManifoldCache,
    ManifoldConfig, ManifoldPoint, Outcome, SignedDistance, Sink, manifold_into,
};
use crate::shape::Shape;
use std::ffi::c_char;

// --- Depth ---------------------------------------------------------------------------------------------------------------

/// What a depth query is asked for. Begin with SWIFTPROX_DEPTH_CONFIG_DEFAULT, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDepthConfig {
    /// Set by SWIFTPROX_DEPTH_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to 1e-2 (the default).
    pub rotation_limit: f64,
    /// upper - lower may be as large as this ... from 0 to infinity.
    pub absolute_error: f64,
    /// ... or as this times lower. Both 0 (the default): as narrow as double precision can prove.
    pub relative_error: f64,
    /// Expansions after which the query stops with what it has, 1 or more; UINT32_MAX (the default): no limit but the library's
    /// own, 400. What is then left of the verdict is decided all the same, in integers.
    pub step_budget: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CDepthConfig {
    const NAME: &'static str = "swiftprox_depth_config";
}

impl CDepthConfig {
    /// What the header calls its default.
    pub const DEFAULT: CDepthConfig = CDepthConfig {
        struct_size: size_of::<CDepthConfig>(),
        rotation_limit: ROTATION_LIMIT,
        absolute_error: 0.0,
        relative_error: 0.0,
        step_budget: u32::MAX,
    };
}

/// What a pair remembers of its depth, for the caller to keep: all zero is cold, any bytes are safe. It changes how fast an answer
/// comes, and which of several directions of least overlap is said; never the verdict, and no depth beyond its interval.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDepthCache {
    /// Not to be looked at.
    pub words: [u32; 352],
}

// A `DepthCache` lives in the words, which leave it room to grow; any bytes make a valid one.
const _: () = {
    assert!(size_of::<DepthCache>() <= size_of::<CDepthCache>());
    assert!(align_of::<DepthCache>() <= align_of::<CDepthCache>());
};

/// How deep two objects are in each other: the least translation that parts them, with a rigorous interval, unit normal, witness
/// points and features. Touching is a depth of 0, decided in integers. Of separated objects only that is said, and a normal that
/// separates them: swiftprox_pair_distance tells how far.
///
/// Arguments and errors as of swiftprox_pair_distance; the cache is one for depths alone, and config may be null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_depth(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CDepthCache,
    config: *const CDepthConfig,
    answer: *mut DepthAnswer,
) -> StatusCode {
    let status = guard(|| {
        if answer.is_null() {
            return Err(Failure::null("answer"));
        }
        // SAFETY: not null, writable by the caller; what was there before is not looked at.
        unsafe { answer.write(DepthAnswer::default()) };
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (shape1, pose1, shape2, pose2, cache, config, answer) = unsafe {
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                exclusive(cache.cast::<DepthCache>(), "cache")?,
                read_struct(config, CDepthConfig::DEFAULT)?,
                exclusive(answer, "answer")?,
            )
        };
        let config = DepthConfig {
            rotation_limit: config.rotation_limit,
            absolute_error: config.absolute_error,
            relative_error: config.relative_error,
            step_budget: config.step_budget,
        };
        Ok(pair::depth([shape1.at(pose1), shape2.at(pose2)], cache, &config, answer)?)
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null or writable by the caller.
        unsafe { reset(cache.cast::<DepthCache>(), answer) };
    }
    status
}

/// Re-checks a depth, trusting nothing of the search that found it; `cache` is that of the query, which holds the proof, or any
/// other: then a proof is searched for. SWIFTPROX_OK: it holds for these shapes and poses.
///
/// Verdict and interval are proved for the exact objects R*v + T, with no tolerance: that they overlap, touch or are separated, and
/// that the depth is in [lower, upper]. The other members are rounded, and hold up to the allowance of swiftprox_pair_verify:
/// points and features, and world2 - world1 is depth * normal up to that and upper - lower. How it ended and the statistics are not
/// checked.
///
/// Takes time linear in the number of vertices and in the size of the cache.
///
/// Errors as of swiftprox_pair_verify.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_depth_verify(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *const CDepthCache,
    answer: *const DepthAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (shape1, pose1, shape2, pose2, cache, answer) = unsafe {
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                input(cache.cast::<DepthCache>(), "cache")?,
                read_depth(answer)?,
            )
        };
        Ok(verify_depth([shape1.at(pose1), shape2.at(pose2)], cache, answer)?)
    })
}

/// How a depth query ended, in words. Never null, valid for ever; an unknown number gets a string that says so.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_depth_ending_string(ending: DepthEndingNumber) -> *const c_char {
    use crate::base::enumerator::Enumerator;
    let string = match DepthEnding::from_number(ending) {
        Some(DepthEnding::None) => c"nothing was asked",
        Some(DepthEnding::Narrow) => c"narrow",
        Some(DepthEnding::Separated) => c"separated",
        Some(DepthEnding::Integers) => c"integer arithmetic",
        Some(DepthEnding::Budget) => c"the step budget, which ran out",
        Some(DepthEnding::Stalled) => c"stalled",
        None => c"no way to end",
    };
    string.as_ptr()
}

/// Leaves nothing half-written behind a bug.
///
/// # Safety
/// The pointers meet the header's pointer rules.
#[cold]
unsafe fn reset<C: Default, A: Default>(cache: *mut C, answer: *mut A) {
    if !cache.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { cache.write(C::default()) };
    }
    if !answer.is_null() {
        // SAFETY: not null, and writable by the caller.
        unsafe { answer.write(A::default()) };
    }
}

/// The caller's answer to read, its enumerators checked.
///
/// # Safety
/// `answer` meets the header's pointer rules.
unsafe fn read_depth<'a>(answer: *const DepthAnswer) -> Checked<&'a DepthAnswer> {
    if answer.is_null() {
        return Err(Failure::null("answer"));
    }
    // SAFETY: not null, readable by the caller; read as integers, whatever they hold.
    let [outcome, ending, kind1, kind2] = unsafe {
        [
            (&raw const (*answer).outcome).cast::<i32>().read(),
            (&raw const (*answer).ending).cast::<i32>().read(),
            (&raw const (*answer).feature1.kind).cast::<i32>().read(),
            (&raw const (*answer).feature2.kind).cast::<i32>().read(),
        ]
    };
    read_enumerator::<Outcome>(outcome, "answer->outcome", "swiftprox_outcome")?;
    read_enumerator::<DepthEnding>(ending, "answer->ending", "swiftprox_depth_ending")?;
    read_enumerator::<FeatureKind>(kind1, "answer->feature1.kind", "swiftprox_feature_kind")?;
    read_enumerator::<FeatureKind>(kind2, "answer->feature2.kind", "swiftprox_feature_kind")?;
    // SAFETY: its enumerators are valid, and any other bytes are.
    Ok(unsafe { &*answer })
}

// --- Manifolds -----------------------------------------------------------------------------------------------------------

/// What a manifold query is asked for. Begin with SWIFTPROX_MANIFOLD_CONFIG_DEFAULT, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CManifoldConfig {
    /// Set by SWIFTPROX_MANIFOLD_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Largest accepted |RᵀR − I| entry of a pose, from 0 to 1e-2 (the default).
    pub rotation_limit: f64,
    /// Objects up to this far apart have a manifold, and points with a gap of at most this belong to it; at least 0, and infinity
    /// admits all, as in queries of scenes. Default: 0.
    pub margin: f64,
    /// Other than 0: of more than four points four are kept, the deepest, the farthest from it and the extremes on either side of
    /// the line between; none is moved. The four of the last query with the same cache stay while they are about as deep and
    /// cover about as much. 0 (the default): all.
    pub reduces: i32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CManifoldConfig {
    const NAME: &'static str = "swiftprox_manifold_config";
}

impl CManifoldConfig {
    /// What the header calls its default.
    pub const DEFAULT: CManifoldConfig = CManifoldConfig {
        struct_size: size_of::<CManifoldConfig>(),
        rotation_limit: ROTATION_LIMIT,
        margin: 0.0,
        reduces: 0,
    };
}

/// What a pair remembers of its manifold, its distance and its depth, for the caller to keep: all zero is cold, any bytes are
/// safe.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CManifoldCache {
    /// Not to be looked at.
    pub words: [u32; 384],
}

// As for depths.
const _: () = {
    assert!(size_of::<ManifoldCache>() <= size_of::<CManifoldCache>());
    assert!(align_of::<ManifoldCache>() <= align_of::<CManifoldCache>());
};

/// The distance of objects that are apart, minus the depth of those that overlap, with one rigorous interval through zero, unit
/// normal, witness points and features: as certain as swiftprox_pair_distance and swiftprox_pair_depth. Touching is 0.
///
/// Of a pair farther apart than config->distance_tolerance less is said, see SWIFTPROX_OUTCOME_BEYOND; errors asked for and step
/// budgets are not looked at. Arguments and errors as of swiftprox_pair_distance; the cache is that of the pair's manifolds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_signed_distance(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CManifoldCache,
    config: *const CPairConfig,
    answer: *mut SignedDistance,
) -> StatusCode {
    let status = guard(|| {
        if answer.is_null() {
            return Err(Failure::null("answer"));
        }
        // SAFETY: not null, writable by the caller; what was there before is not looked at.
        unsafe { answer.write(SignedDistance::default()) };
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (shape1, pose1, shape2, pose2, cache, config, answer) = unsafe {
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                exclusive(cache.cast::<ManifoldCache>(), "cache")?,
                read_config(config)?,
                exclusive(answer, "answer")?,
            )
        };
        let bodies = [shape1.at(pose1), shape2.at(pose2)];
        Ok(pair::signed_distance(bodies, &mut cache.signed_distance, &config, answer)?)
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null or writable by the caller.
        unsafe { reset(cache.cast::<ManifoldCache>(), answer) };
    }
    status
}

/// Where two objects meet, or are up to config->margin apart: pairs of points along the normal of least overlap or of the shortest
/// connection, each with its gap. `points` has room for `capacity` of them; what is beyond is left out, and manifold->found_count
/// says how many there are. Objects farther apart have none, and their outcome is SWIFTPROX_OUTCOME_BEYOND.
///
/// Manifolds are made over faces as they were meant: what could lie in one plane up to the shape's face_noise
/// (swiftprox_shape_options). Gap intervals hold for the exact objects: they contain by how much such a face is not flat. Points
/// are on their objects up to half of what it is thick, and in line up to twice that and 7.5e-9 of the pair's size. Corners nearer
/// to each other than 3e-8 of it, or four times what such faces are thick, are one. One of the points is as deep as the objects
/// are. It is not certified that a face is complete.
///
/// Arguments and errors as of swiftprox_pair_distance; the cache is one for manifolds alone. points may be null if capacity is 0.
/// On failure the manifold is reset, and points are as they were.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_manifold(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CManifoldCache,
    config: *const CManifoldConfig,
    points: *mut ManifoldPoint,
    capacity: usize,
    manifold: *mut Manifold,
) -> StatusCode {
    let mut distance = SignedDistance::default();
    // SAFETY: the header's pointer rules.
    unsafe {
        swiftprox_pair_manifold_with_distance(
            shape1,
            pose1,
            shape2,
            pose2,
            cache,
            config,
            points,
            capacity,
            manifold,
            &raw mut distance,
        )
    }
}

/// As swiftprox_pair_manifold, with what swiftprox_pair_signed_distance says of the pair, at no further search: the distance or
/// minus the depth, and the witness points. `distance` is reset on failure, too.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_manifold_with_distance(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *mut CManifoldCache,
    config: *const CManifoldConfig,
    points: *mut ManifoldPoint,
    capacity: usize,
    manifold: *mut Manifold,
    distance: *mut SignedDistance,
) -> StatusCode {
    let status = guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (shape1, pose1, shape2, pose2, cache, config, distance) = unsafe {
            output(manifold, "manifold", Manifold::default())?;
            output(distance, "distance", SignedDistance::default())?;
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                exclusive(cache.cast::<ManifoldCache>(), "cache")?,
                read_manifold_config(config)?,
                exclusive(distance, "distance")?,
            )
        };
        check_room(points, "points", capacity)?;
        let mut write = |place: usize, fill: Fill| {
            // SAFETY: not null, place < capacity, and it is written before it is a reference.
            fill(unsafe {
                points.add(place).write(ManifoldPoint::default());
                &mut *points.add(place)
            });
        };
        let mut sink = Sink { capacity, written: 0, write: &mut write };
        let bodies = [shape1.at(pose1), shape2.at(pose2)];
        let found = manifold_into(bodies, cache, &config, &mut sink, distance)?;
        // SAFETY: not null, writable by the caller.
        unsafe { manifold.write(found) };
        Ok(())
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null or writable by the caller.
        unsafe {
            reset(cache.cast::<ManifoldCache>(), manifold);
            reset(cache.cast::<ManifoldCache>(), distance);
        }
    }
    status
}

/// Re-checks a manifold, trusting nothing of the search that found it; config is that of the query, and `cache` too, or any other:
/// then a proof of the depth is searched for. `points` holds `count` points, those of the manifold first. SWIFTPROX_OK: it holds
/// for these shapes and poses.
///
/// Verdict and interval are proved for the exact objects R*v + T, with no tolerance, as by swiftprox_pair_verify and
/// swiftprox_pair_depth_verify. The other members are rounded. The normal is of unit length; along it objects that are apart are at
/// least lower apart, others overlap by at most -lower. Each point has a place on either object: no farther than b out of
/// it, no farther than b and the width of the gap behind a face that looks towards the other object, and the same in both frames.
/// The object has its feature; the place is no farther than b from that if it is a vertex or an edge. The gap is that of the two
/// places along the normal, up to the allowance of swiftprox_pair_verify; sideways they are no more than b off. One of the points
/// is as deep as the objects are, if none was left out.
///
/// b is that allowance, 2^-25 of the pair's size (both radii and the distance of the centres) and eight times what contact faces
/// are thick at most. That a face is complete is not checked.
///
/// SWIFTPROX_ERROR_UNVERIFIED: it does not hold; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT also for fewer points than
/// the manifold has. Others as of swiftprox_pair_verify and swiftprox_pair_manifold.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_manifold_verify(
    shape1: *const Shape,
    pose1: *const f64,
    shape2: *const Shape,
    pose2: *const f64,
    cache: *const CManifoldCache,
    config: *const CManifoldConfig,
    points: *const ManifoldPoint,
    count: usize,
    manifold: *const Manifold,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (shape1, pose1, shape2, pose2, cache, config, points, manifold) = unsafe {
            let manifold = read_manifold(manifold)?;
            check_room(points, "points", count)?;
            (
                input(shape1, "shape1")?,
                input(pose1.cast::<Pose>(), "pose1")?,
                input(shape2, "shape2")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                input(cache.cast::<ManifoldCache>(), "cache")?,
                read_manifold_config(config)?,
                read_points(points, count.min(manifold.point_count as usize))?,
                manifold,
            )
        };
        Ok(verify_manifold([shape1.at(pose1), shape2.at(pose2)], cache, &config, manifold, points)?)
    })
}

/// The caller's manifold to read, its enumerator checked.
///
/// # Safety
/// `manifold` meets the header's pointer rules.
unsafe fn read_manifold<'a>(manifold: *const Manifold) -> Checked<&'a Manifold> {
    if manifold.is_null() {
        return Err(Failure::null("manifold"));
    }
    // SAFETY: not null, readable by the caller; read as an integer, whatever it holds.
    let outcome = unsafe { (&raw const (*manifold).outcome).cast::<i32>().read() };
    read_enumerator::<Outcome>(outcome, "manifold->outcome", "swiftprox_outcome")?;
    // SAFETY: not null, and valid, as has been checked.
    Ok(unsafe { &*manifold })
}

/// The caller's points to read, their enumerators checked: those of the manifold, as behind them may be anything.
///
/// # Safety
/// `points` points to `count` points, and meets the header's pointer rules.
unsafe fn read_points<'a>(points: *const ManifoldPoint, count: usize) -> Checked<&'a [ManifoldPoint]> {
    for k in 0..count {
        // SAFETY: not null, readable by the caller; read as integers, whatever they hold.
        let kinds = unsafe {
            let point = points.add(k);
            [&raw const (*point).feature1.kind, &raw const (*point).feature2.kind].map(|kind| kind.cast::<i32>().read())
        };
        for (object, kind) in (1..).zip(kinds) {
            read_enumerator::<FeatureKind>(
                kind,
                &format!("points[{k}].feature{object}.kind"),
                "swiftprox_feature_kind",
            )?;
        }
    }
    // SAFETY: valid, as has been checked.
    unsafe { array(points, count, "points") }
}

/// The caller's configuration in Rust's terms, or the defaults for null.
///
/// # Safety
/// `config` meets the header's pointer rules.
pub(super) unsafe fn read_manifold_config(config: *const CManifoldConfig) -> Checked<ManifoldConfig> {
    // SAFETY: by the caller.
    let config = unsafe { read_struct(config, CManifoldConfig::DEFAULT) }?;
    Ok(ManifoldConfig { rotation_limit: config.rotation_limit, margin: config.margin, reduces: config.reduces != 0 })
}

/// Refuses an array to be filled in that cannot be one.
pub(super) fn check_room<T>(array: *const T, name: &str, capacity: usize) -> Checked<()> {
    if array.is_null() && capacity > 0 {
        return Err(Failure::null(name));
    }
    // No array in memory is longer: a negative count that became a size_t, most likely.
    if capacity > isize::MAX as usize / size_of::<T>() {
        return Err(Failure::new(StatusCode::ErrorLimit, format!("`{name}` cannot have {capacity} entries")));
    }
    Ok(())
}
