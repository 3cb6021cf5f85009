//! Depths and contact manifolds of pairs.

use super::enumerators::{DepthEndingNumber, read_enumerator};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::pair::{CPairConfig, CPlaced, bodies, read_config};
use super::pointers::{array, exclusive, input, output, reset};
use super::structs::{Versioned, read_struct};
use crate::manifold::{Fill, Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, Sink, manifold_into};
use crate::pair::{self, DepthAnswer, DepthCache, DepthConfig, DepthEnding, FeatureKind, Outcome, SignedDistance};
use crate::verify::{verify_depth, verify_manifold};
use std::ffi::c_char;

// --- Depth ---------------------------------------------------------------------------------------------------------------

/// Options of a depth query. Initialise with SWIFTPROX_DEPTH_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDepthConfig {
    /// Set by SWIFTPROX_DEPTH_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Allowed upper - lower, from 0 to infinity. Default: 0.
    pub absolute_error: f64,
    /// Allowed (upper - lower) / lower, from 0 to infinity. It is enough to meet one of the two errors. Both 0 (the default): as
    /// narrow as double precision can prove.
    pub relative_error: f64,
    /// The largest number of expansions, 1 or more. UINT32_MAX (the default): the library's own limit, 400. After that integers
    /// still decide the verdict.
    pub step_budget: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CDepthConfig {
    const NAME: &'static str = "swiftprox_depth_config";
}

impl CDepthConfig {
    /// The defaults, as in the header.
    pub const DEFAULT: CDepthConfig = CDepthConfig {
        struct_size: size_of::<CDepthConfig>(),
        absolute_error: 0.0,
        relative_error: 0.0,
        step_budget: u32::MAX,
    };
}

/// The depth cache of a pair, owned by the caller. Zero it before the first query; any bytes are safe. It affects speed, and the
/// choice between equal directions of least overlap, but never the verdict or the validity of the interval.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CDepthCache {
    /// Opaque.
    pub words: [u32; 256],
}

// A `DepthCache` lives in the words, which leave it room to grow; any bytes make a valid one.
const _: () = {
    assert!(size_of::<DepthCache>() <= size_of::<CDepthCache>());
    assert!(align_of::<DepthCache>() <= align_of::<CDepthCache>());
};

/// Computes the penetration depth: the length of the least translation that separates two objects. The answer has a rigorous
/// interval, unit normal, witness points and features. Touching is depth 0, decided in integers. For separated objects it gives
/// only the verdict and a separating normal; swiftprox_pair_distance gives the distance.
///
/// Same arguments and errors as swiftprox_pair_distance. The cache is for depths only.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_depth(
    object1: CPlaced,
    object2: CPlaced,
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
        let (bodies, cache, config, answer) = unsafe {
            (
                bodies(object1, object2)?,
                exclusive(cache.cast::<DepthCache>(), "cache")?,
                read_depth_config(config)?,
                exclusive(answer, "answer")?,
            )
        };
        Ok(pair::depth(bodies, cache, &config, answer)?)
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null or writable by the caller.
        unsafe { reset(cache.cast::<DepthCache>(), answer) };
    }
    status
}

/// Checks a depth independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses. The query's
/// `cache` holds the proof; with another cache the function searches for one.
///
/// Verdict (overlapping, touching or separated) and interval are proved without tolerance for the exact objects R*v + T. Other
/// members are checked up to the allowance of swiftprox_pair_verify. world2 - world1 must be depth * normal, up to that and
/// upper - lower. Ending and statistics are not checked.
///
/// Time is linear in the number of vertices and the size of the cache. Same errors as swiftprox_pair_verify.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_depth_verify(
    object1: CPlaced,
    object2: CPlaced,
    cache: *const CDepthCache,
    answer: *const DepthAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (bodies, cache, answer) =
            unsafe { (bodies(object1, object2)?, input(cache.cast::<DepthCache>(), "cache")?, read_depth(answer)?) };
        Ok(verify_depth(bodies, cache, answer)?)
    })
}

/// Returns the text for a depth ending. Never null, valid forever, also for unknown numbers.
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

/// The options of a depth query, or the defaults for null.
///
/// # Safety
/// `config` meets the header's pointer rules.
pub(super) unsafe fn read_depth_config(config: *const CDepthConfig) -> Checked<DepthConfig> {
    // SAFETY: by the caller.
    let config = unsafe { read_struct(config, CDepthConfig::DEFAULT) }?;
    let CDepthConfig { absolute_error, relative_error, step_budget, .. } = config;
    Ok(DepthConfig { absolute_error, relative_error, step_budget })
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

/// Output of swiftprox_pair_manifold, by value. `{points, capacity, NULL}` requests only points.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CManifoldRoom {
    /// Room for `capacity` points; null if that is 0.
    pub points: *mut ManifoldPoint,
    /// Room in points. Further points are left out; swiftprox_manifold.found_count counts them too.
    pub capacity: usize,
    /// Receives the result of swiftprox_pair_signed_distance without a further search; may be null.
    pub distance: *mut SignedDistance,
}

/// Options of a manifold query. Initialise with SWIFTPROX_MANIFOLD_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CManifoldConfig {
    /// Set by SWIFTPROX_MANIFOLD_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Largest gap of objects that have a manifold, and of its points: from 0 (the default) to infinity, which admits all.
    pub max_distance: f64,
    /// Nonzero: at most four points are kept, none is moved. They are the deepest, the farthest from it and the extremes on either
    /// side of the line through both. The last query's four, from the cache, stay while about as deep and as wide. 0 (the default):
    /// all.
    pub reduces: i32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CManifoldConfig {
    const NAME: &'static str = "swiftprox_manifold_config";
}

impl CManifoldConfig {
    /// The defaults, as in the header.
    pub const DEFAULT: CManifoldConfig =
        CManifoldConfig { struct_size: size_of::<CManifoldConfig>(), max_distance: 0.0, reduces: 0 };
}

/// The cache of a pair for manifold, signed distance and depth, owned by the caller. Zero it before the first query; any bytes are
/// safe.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CManifoldCache {
    /// Opaque.
    pub words: [u32; 384],
}

// As for depths.
const _: () = {
    assert!(size_of::<ManifoldCache>() <= size_of::<CManifoldCache>());
    assert!(align_of::<ManifoldCache>() <= align_of::<CManifoldCache>());
};

/// Computes the distance of separated objects, or minus the penetration depth of overlapping ones; touching is 0. The answer has
/// one rigorous interval, unit normal, witness points and features. It is as reliable as swiftprox_pair_distance and
/// swiftprox_pair_depth.
///
/// Pairs beyond config->max_distance get less, see SWIFTPROX_OUTCOME_BEYOND. Allowed errors and step budget are ignored. Same
/// arguments and errors as swiftprox_pair_distance, but with a manifold cache.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_signed_distance(
    object1: CPlaced,
    object2: CPlaced,
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
        let (bodies, cache, config, answer) = unsafe {
            (
                bodies(object1, object2)?,
                exclusive(cache.cast::<ManifoldCache>(), "cache")?,
                read_config(config)?,
                exclusive(answer, "answer")?,
            )
        };
        Ok(pair::signed_distance(bodies, &mut cache.signed_distance, &config, answer)?)
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null or writable by the caller.
        unsafe { reset(cache.cast::<ManifoldCache>(), answer) };
    }
    status
}

/// Computes where two objects meet or are at most config->max_distance apart: pairs of points along the normal, each with its gap.
/// Points are written to room.points up to its capacity; manifold->found_count is the total. room.distance, if not null, receives
/// the signed distance. Objects farther apart get no points and SWIFTPROX_OUTCOME_BEYOND.
///
/// Vertices within the shape's face_noise (swiftprox_shape_options) of one plane are one face; gap intervals are guaranteed for the
/// exact objects. Points are on their objects up to half a face's thickness, and in line up to twice its thickness plus 7.5e-9 of
/// the pair's size. Corners closer than 3e-8 of that size, or four thicknesses, are merged. One point has the full depth.
/// Completeness of a face is not guaranteed.
///
/// Same arguments and errors as swiftprox_pair_distance, but with a manifold cache. On failure the manifold is reset and points are
/// unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_manifold(
    object1: CPlaced,
    object2: CPlaced,
    cache: *mut CManifoldCache,
    config: *const CManifoldConfig,
    room: CManifoldRoom,
    manifold: *mut Manifold,
) -> StatusCode {
    let CManifoldRoom { points, capacity, distance } = room;
    let status = guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (bodies, cache, config, distance) = unsafe {
            output(manifold, "manifold", Manifold::default())?;
            if !distance.is_null() {
                output(distance, "distance", SignedDistance::default())?;
            }
            (
                bodies(object1, object2)?,
                exclusive(cache.cast::<ManifoldCache>(), "cache")?,
                read_manifold_config(config)?,
                distance.as_mut(),
            )
        };
        // SAFETY: the header's pointer rules; the sink stays below its capacity.
        let mut write = unsafe { writer_to(points, capacity) }?;
        let mut sink = Sink { capacity, written: 0, write: &mut write };
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

/// Checks a manifold independently of the search that found it. SWIFTPROX_OK: it is right for these shapes and poses. `config` is
/// that of the query. With another `cache` than the query's, the function searches for a proof of the depth. `points` holds
/// manifold->point_count points.
///
/// Verdict and interval are proved as in swiftprox_pair_verify and swiftprox_pair_depth_verify. The normal must have unit length:
/// along it, separated objects are at least lower apart, others overlap by at most -lower. Points must be on their objects,
/// features and line up to b, and agree in both frames. Behind a face they may also be off by the gap's width. Gaps must match the
/// points. One point must have the full depth, unless points were left out.
///
/// b is the allowance of swiftprox_pair_verify plus 2^-25 of the pair's size (both radii plus the distance of the centres) plus
/// eight times the largest thickness of contact faces. Completeness of faces is not checked.
///
/// Same errors as swiftprox_pair_verify and swiftprox_pair_manifold.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_manifold_verify(
    object1: CPlaced,
    object2: CPlaced,
    cache: *const CManifoldCache,
    config: *const CManifoldConfig,
    points: *const ManifoldPoint,
    manifold: *const Manifold,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        let (bodies, cache, config, points, manifold) = unsafe {
            let manifold = read_manifold(manifold)?;
            check_room(points, "points", manifold.point_count as usize)?;
            (
                bodies(object1, object2)?,
                input(cache.cast::<ManifoldCache>(), "cache")?,
                read_manifold_config(config)?,
                read_points(points, manifold.point_count as usize)?,
                manifold,
            )
        };
        Ok(verify_manifold(bodies, cache, &config, manifold, points)?)
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
            let member = format_args!("points[{k}].feature{object}.kind");
            read_enumerator::<FeatureKind>(kind, member, "swiftprox_feature_kind")?;
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
    Ok(ManifoldConfig { max_distance: config.max_distance, reduces: config.reduces != 0 })
}

/// Writes points to the caller's room; refuses what cannot be one.
///
/// # Safety
/// `points` has room for `capacity` points, and places are below that.
pub(super) unsafe fn writer_to(points: *mut ManifoldPoint, capacity: usize) -> Checked<impl FnMut(usize, Fill)> {
    check_room(points, "points", capacity)?;
    Ok(move |place: usize, fill: Fill| {
        debug_assert!(place < capacity);
        // SAFETY: by the caller not null, place < capacity; it is written before it is a reference.
        fill(unsafe {
            points.add(place).write(ManifoldPoint::default());
            &mut *points.add(place)
        });
    })
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
