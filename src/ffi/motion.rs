//! Motions: casts and clearances of pairs.

use std::ffi::{c_char, c_void};
use std::fmt::Display;

use super::enumerators::{CastOutcomeNumber, read_enumerator, unknown};
use super::failure::{Checked, Failure, StatusCode};
use super::ground::{CPlacedGround, read_placed};
use super::guard::{call_out, guard};
use super::pair::CPairCache;
use super::pointers::{exclusive, handle, input, output, reset};
use super::structs::{Versioned, read_struct};
use crate::base::enumerator::{Enumerator, enumerator};
use crate::base::math::{Pose, Vector};
use crate::base::memory::{collected, with_capacity};
use crate::ground::{GroundCastAnswer, ground_cast};
use crate::motion::{
    Callback, CastAnswer, CastConfig, CastOutcome, Clearance, ClearanceConfig, Motion, Moving, Screw, cast, clearance,
    motion_between, verify_cast,
};
use crate::pair::{DecidedBy, FeatureKind, Outcome, PairCache};
use crate::shape::Shape;

/// Kinds of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum MotionKind {
    /// The object stays at start.
    Fixed = 0,
    /// The object turns at a constant rate about a centre c that moves on a line. At time t, with start [R|T], a point p is at
    /// `T + R c + t velocity + exp(t [rotation]) R (p - c)`.
    Screw = 1,
    /// The pose is (1 - t) start + t end, entry by entry. For turns of up to 0.2 radians; larger turns give refused poses in
    /// between.
    Affine = 2,
    /// The callback `pose` gives the pose.
    Callback = 3,
}

enumerator!(MotionKind { Fixed, Screw, Affine, Callback });

/// A [`MotionKind`].
pub type MotionKindNumber = i32;

/// Writes the pose at a time: 12 doubles, row by row. They are NaN before the call, and refused if left so. Equal times must give
/// equal poses. It runs in the calling thread and must return; a C++ exception that leaves it ends the program.
pub type MotionCallback = Option<unsafe extern "C-unwind" fn(user: *mut c_void, time: f64, pose: *mut f64)>;

/// A motion. Only the members of its kind are read.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CMotion {
    /// The kind of motion.
    pub kind: MotionKindNumber,
    /// The pose at time 0. Not for SWIFTPROX_MOTION_KIND_CALLBACK.
    pub start: [f64; 12],
    /// For SWIFTPROX_MOTION_KIND_AFFINE: the pose at time 1.
    pub end: [f64; 12],
    /// For SWIFTPROX_MOTION_KIND_SCREW: the centre of rotation, in the object's frame.
    pub centre: [f64; 3],
    /// For SWIFTPROX_MOTION_KIND_SCREW: the velocity of the centre, in the world.
    pub velocity: [f64; 3],
    /// For SWIFTPROX_MOTION_KIND_SCREW: the angular velocity in the world, along the axis, in radians per unit of time. The total
    /// turn may be 2^20 radians.
    pub rotation: [f64; 3],
    /// For SWIFTPROX_MOTION_KIND_CALLBACK: gives the pose at a time.
    pub pose: MotionCallback,
    /// For SWIFTPROX_MOTION_KIND_CALLBACK: passed to `pose`.
    pub user: *mut c_void,
    /// For SWIFTPROX_MOTION_KIND_CALLBACK: an upper bound of the acceleration of all points of the object over the range of times.
    /// Answers are only as right as bend and rounding.
    pub bend: f64,
    /// For SWIFTPROX_MOTION_KIND_CALLBACK: the largest distance of a point at the callback's pose from its place in the intended
    /// motion.
    pub rounding: f64,
}

/// Options of a cast. Initialise with SWIFTPROX_CAST_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CCastConfig {
    /// Set by SWIFTPROX_CAST_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Start of the time range. Default: 0.
    pub time_begin: f64,
    /// End of the time range, at least time_begin. Default: 1.
    pub time_end: f64,
    /// Allowed width of a hit's time interval, and the shortest step. At least 2^-50 of the larger end. Default: 1e-9.
    pub time_tolerance: f64,
    /// Objects farther apart than this are free; at least 0. Default: 0.
    pub max_distance: f64,
    /// The largest number of queries, 1 or more. Then the cast stops with the bounds so far. Default: 100,000.
    pub step_budget: u32,
    /// Not 0: objects that are in contact at the beginning, and part within 1,024 time tolerances, are cast from there on; see
    /// swiftprox_cast_answer.time_parted. Default: 0, such a start is a hit.
    pub ignores_parting: i32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CCastConfig {
    const NAME: &'static str = "swiftprox_cast_config";
}

impl CCastConfig {
    /// The defaults, as in the header.
    pub fn defaults() -> CCastConfig {
        let CastConfig { time_begin, time_end, time_tolerance, max_distance, step_budget, ignores_parting } =
            CastConfig::default();
        let (struct_size, ignores_parting) = (size_of::<CCastConfig>(), i32::from(ignores_parting));
        CCastConfig { struct_size, time_begin, time_end, time_tolerance, max_distance, step_budget, ignores_parting }
    }
}

/// Options of a clearance. Initialise with SWIFTPROX_CLEARANCE_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CClearanceConfig {
    /// Set by SWIFTPROX_CLEARANCE_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Start of the time range. Default: 0.
    pub time_begin: f64,
    /// End of the time range, at least time_begin. Default: 1.
    pub time_end: f64,
    /// Allowed upper - lower, from 0 to infinity. Default: 0.
    pub absolute_error: f64,
    /// Allowed (upper - lower) / lower. Default: 0.01. It is enough to meet one of the two errors. Both 0: as narrow as possible.
    pub relative_error: f64,
    /// The largest number of queries, 1 or more. Then the search stops with the bounds so far. Default: 100,000.
    pub step_budget: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CClearanceConfig {
    const NAME: &'static str = "swiftprox_clearance_config";
}

impl CClearanceConfig {
    /// The defaults, as in the header.
    pub fn defaults() -> CClearanceConfig {
        let ClearanceConfig { time_begin, time_end, absolute_error, relative_error, step_budget } =
            ClearanceConfig::default();
        let struct_size = size_of::<CClearanceConfig>();
        CClearanceConfig { struct_size, time_begin, time_end, absolute_error, relative_error, step_budget }
    }
}

/// Makes the screw motion from pose1 at time 0 to pose2 at time 1 by the shortest turn. `centre` is in the object's frame; null
/// means its origin. `end_error` may be null. It receives a bound, from rounding and distortion of the rotations: points within
/// `reach` of the centre end at most that far from pose2.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the centre is not finite, or the reach is negative or NaN. Nothing is written then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_motion_between(
    pose1: *const f64,
    pose2: *const f64,
    centre: *const f64,
    reach: f64,
    motion: *mut CMotion,
    end_error: *mut f64,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`, a point three.
        let (pose1, pose2, centre) = unsafe {
            (
                input(pose1.cast::<Pose>(), "pose1")?,
                input(pose2.cast::<Pose>(), "pose2")?,
                centre.cast::<[f64; 3]>().as_ref().map_or(Vector::zeros(), |centre| Vector::from(*centre)),
            )
        };
        let (screw, error) = motion_between(pose1, pose2, &centre, reach)?;
        let made = CMotion {
            kind: MotionKind::Screw as i32,
            start: row_major(pose1),
            end: [f64::NAN; 12],
            centre: screw.centre.into(),
            velocity: screw.velocity.into(),
            rotation: screw.rotation.into(),
            pose: None,
            user: std::ptr::null_mut(),
            bend: f64::NAN,
            rounding: f64::NAN,
        };
        // SAFETY: the header's pointer rules.
        unsafe {
            output(motion, "motion", made)?;
            if !end_error.is_null() {
                end_error.write(error);
            }
        }
        Ok(())
    })
}

/// A shape and how it moves, an argument by value. Both pointers are only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CMoving {
    /// The shape.
    pub shape: *const Shape,
    /// Its motion.
    pub motion: *const CMotion,
}

fn row_major(pose: &Pose) -> [f64; 12] {
    std::array::from_fn(|k| pose.rows[k / 4][k % 4])
}

/// Decides whether two moving objects stay farther apart than config->max_distance, or when they first do not. The answer is
/// guaranteed for the motions as described at all times of the range, with poses' rounding included.
///
/// `cache` may be shared with swiftprox_pair_distance. It affects speed and the choice of times within the guaranteed bounds. On
/// failure the answer is reset and its outcome is SWIFTPROX_CAST_OUTCOME_NONE; SWIFTPROX_ERROR_BUG also resets the cache.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: a member of config or a motion is out of range, or a callback contradicts its bend.
/// SWIFTPROX_ERROR_POSE: a motion's pose is refused; the message gives the time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_cast(
    object1: CMoving,
    object2: CMoving,
    cache: *mut CPairCache,
    config: *const CCastConfig,
    answer: *mut CastAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask([object1, object2], cache, answer, |bodies, cache, answer| {
            let config = cast_config(config)?;
            Ok(cast(bodies, cache, &config, answer)?)
        })
    }
}

/// Decides whether a moving object stays farther from a ground at rest than config->max_distance, or when it first does not.
/// Guarantees and members are as for swiftprox_pair_cast; the ground is object 2, as a set of points, and its triangle is named.
/// There is no cache.
///
/// On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: also if config->ignores_parting is set. Else same errors as
/// swiftprox_pair_cast. The call allocates about 4 kB.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_ground_cast(
    object: CMoving,
    ground: CPlacedGround,
    config: *const CCastConfig,
    answer: *mut GroundCastAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", GroundCastAnswer { answer: CastAnswer::default(), triangle: 0 })?;
        let (shape, motion) = (handle(object.shape, "object.shape")?, input(object.motion, "object.motion")?);
        let pose = called(motion);
        let motion = read_motion(motion, &pose, "object.motion")?;
        let said = ground_cast(Moving { shape, motion: &motion }, read_placed(ground)?, &cast_config(config)?)?;
        output(answer, "answer", said)
    })
}

/// Computes the least distance of two moving objects over the range of times, as a guaranteed interval [lower, upper]. It is as
/// narrow as requested or possible: an exhausted step budget and rounded poses widen it. Same arguments and errors as
/// swiftprox_pair_cast. On failure the numbers are NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_clearance(
    object1: CMoving,
    object2: CMoving,
    cache: *mut CPairCache,
    config: *const CClearanceConfig,
    answer: *mut Clearance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask([object1, object2], cache, answer, |bodies, cache, answer| {
            let given = read_struct(config, CClearanceConfig::defaults())?;
            let CClearanceConfig { time_begin, time_end, absolute_error, relative_error, step_budget, .. } = given;
            let config = ClearanceConfig { time_begin, time_end, absolute_error, relative_error, step_budget };
            Ok(clearance(bodies, cache, &config, answer)?)
        })
    }
}

/// Checks an answer of swiftprox_pair_cast for the same motions and config, independently of its search. SWIFTPROX_OK: it is right.
///
/// It proves without tolerance, at every time: free pairs stay farther apart than max_distance, and at least clearance. Other pairs
/// stay farther apart than max_distance up to time_lower, unless that is the beginning. Hits are at most max_distance and upper
/// apart at time_upper, as `proof` shows. Near misses are at most upper apart at time_lower. swiftprox_pair_verify checks
/// `contact`, of the poses at time_lower. `queries` is not checked.
///
/// Time grows with the number of vertices times the number of steps. After some seconds of integer arithmetic the check gives up,
/// and the message says so.
///
/// SWIFTPROX_ERROR_UNVERIFIED: something is wrong or unproved; the message says what. SWIFTPROX_ERROR_INVALID_ARGUMENT: the answer
/// has an unknown enumerator or no outcome. Other errors as in swiftprox_pair_cast and swiftprox_pair_verify.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_cast_verify(
    object1: CMoving,
    object2: CMoving,
    config: *const CCastConfig,
    answer: *const CastAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (config, answer) = unsafe { (cast_config(config)?, read_answer(answer)?) };
        let verify = |bodies: [Moving; 2]| Ok(verify_cast(bodies, &config, answer)?);
        // SAFETY: the header's pointer rules.
        unsafe { with_bodies([object1, object2], verify) }
    })
}

/// Returns the text for a cast outcome. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_cast_outcome_string(outcome: CastOutcomeNumber) -> *const c_char {
    let string = match CastOutcome::from_number(outcome) {
        Some(CastOutcome::None) => c"nothing was asked",
        Some(CastOutcome::Free) => c"free",
        Some(CastOutcome::Hit) => c"hit",
        Some(CastOutcome::Near) => c"near",
        Some(CastOutcome::Budget) => c"the step budget, which ran out",
        None => c"no outcome of a cast",
    };
    string.as_ptr()
}

/// Checks the arguments of a query about motions and runs it; its answer is reset where it fails.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn ask<A: Default>(
    bodies: [CMoving; 2],
    cache: *mut CPairCache,
    answer: *mut A,
    run: impl FnOnce([Moving; 2], &mut PairCache, &mut A) -> Checked<()>,
) -> StatusCode {
    let status = guard(|| {
        if answer.is_null() {
            return Err(Failure::null("answer"));
        }
        // SAFETY: not null, writable by the caller; what was there before is not looked at.
        unsafe { answer.write(A::default()) };
        // SAFETY: the header's pointer rules.
        let (cache, answer) = unsafe { (exclusive(cache.cast::<PairCache>(), "cache")?, exclusive(answer, "answer")?) };
        // SAFETY: the header's pointer rules.
        unsafe { with_bodies(bodies, |bodies| run(bodies, cache, answer)) }
    });
    if status == StatusCode::ErrorBug {
        // SAFETY: null, or writable by the caller.
        unsafe { reset(cache, answer) };
    }
    status
}

/// Runs what asks about two motions, in Rust's terms.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn with_bodies([object1, object2]: [CMoving; 2], run: impl FnOnce([Moving; 2]) -> Checked<()>) -> Checked<()> {
    // SAFETY: the header's pointer rules.
    let (shape1, motion1, shape2, motion2) = unsafe {
        (
            handle(object1.shape, "object1.shape")?,
            input(object1.motion, "object1.motion")?,
            handle(object2.shape, "object2.shape")?,
            input(object2.motion, "object2.motion")?,
        )
    };
    let (pose1, pose2) = (called(motion1), called(motion2));
    let first = read_motion(motion1, &pose1, "object1.motion")?;
    let second = read_motion(motion2, &pose2, "object2.motion")?;
    run([Moving { shape: shape1, motion: &first }, Moving { shape: shape2, motion: &second }])
}

/// Runs what asks about many motions, in Rust's terms.
pub(super) fn with_motions<T>(motions: &[CMotion], run: impl FnOnce(&[Motion]) -> Checked<T>) -> Checked<T> {
    let poses = collected(motions.iter().map(called))?;
    let mut read = with_capacity(motions.len())?;
    for (k, (motion, pose)) in motions.iter().zip(&poses).enumerate() {
        read.push(read_motion(motion, pose, format_args!("motions[{k}]"))?);
    }
    run(&read)
}

/// The callback of a motion that has one.
pub(super) fn called(motion: &CMotion) -> impl Fn(f64) -> Pose + use<> {
    let (callback, user) = (motion.pose, motion.user);
    move |time| {
        let mut pose = [f64::NAN; 12];
        if let Some(callback) = callback {
            // SAFETY: the callback takes its own user pointer and room for twelve doubles.
            call_out(|| unsafe { callback(user, time, pose.as_mut_ptr()) });
        }
        Pose::from_row_major(&pose)
    }
}

/// The name is put together for a refusal only.
pub(super) fn read_motion<'a>(
    motion: &CMotion,
    pose: &'a dyn Fn(f64) -> Pose,
    name: impl Display,
) -> Checked<Motion<'a>> {
    let start = Pose::from_row_major(&motion.start);
    let Some(kind) = MotionKind::from_number(motion.kind) else {
        return Err(unknown(motion.kind, format_args!("{name}->kind"), "swiftprox_motion_kind"));
    };
    Ok(match kind {
        MotionKind::Fixed => Motion::Fixed(start),
        MotionKind::Screw => Motion::Screw(Screw {
            start,
            centre: motion.centre.into(),
            velocity: motion.velocity.into(),
            rotation: motion.rotation.into(),
        }),
        MotionKind::Affine => Motion::Affine { start, end: Pose::from_row_major(&motion.end) },
        MotionKind::Callback if motion.pose.is_none() => return Err(Failure::null(&format!("{name}->pose"))),
        MotionKind::Callback => Motion::Callback(Callback { pose, bend: motion.bend, rounding: motion.rounding }),
    })
}

/// # Safety
/// `config` meets the header's pointer rules.
pub(super) unsafe fn cast_config(config: *const CCastConfig) -> Checked<CastConfig> {
    // SAFETY: by the caller.
    let given = unsafe { read_struct(config, CCastConfig::defaults())? };
    let CCastConfig { time_begin, time_end, time_tolerance, max_distance, step_budget, ignores_parting, .. } = given;
    let ignores_parting = ignores_parting != 0;
    Ok(CastConfig { time_begin, time_end, time_tolerance, max_distance, step_budget, ignores_parting })
}

/// The caller's answer to read, its enumerators checked.
///
/// # Safety
/// `answer` meets the header's pointer rules.
unsafe fn read_answer<'a>(answer: *const CastAnswer) -> Checked<&'a CastAnswer> {
    if answer.is_null() {
        return Err(Failure::null("answer"));
    }
    // SAFETY: not null, readable by the caller; its enumerators are valid, and any other bytes are.
    unsafe {
        check_cast_enumerators(answer, "answer")?;
        Ok(&*answer)
    }
}

/// Refuses unknown enumerators of an answer, which is called by that name.
///
/// # Safety
/// `answer` is readable.
pub(super) unsafe fn check_cast_enumerators(answer: *const CastAnswer, name: &str) -> Checked<()> {
    // SAFETY: readable by the caller; read as integers, whatever they hold.
    let [outcome, of_contact, decided_by, kind1, kind2] = unsafe {
        let contact = &raw const (*answer).contact;
        [
            (&raw const (*answer).outcome).cast::<i32>().read(),
            (&raw const (*contact).outcome).cast::<i32>().read(),
            (&raw const (*contact).decided_by).cast::<i32>().read(),
            (&raw const (*contact).feature1.kind).cast::<i32>().read(),
            (&raw const (*contact).feature2.kind).cast::<i32>().read(),
        ]
    };
    read_enumerator::<CastOutcome>(outcome, format_args!("{name}->outcome"), "swiftprox_cast_outcome")?;
    read_enumerator::<Outcome>(of_contact, format_args!("{name}->contact.outcome"), "swiftprox_outcome")?;
    read_enumerator::<DecidedBy>(decided_by, format_args!("{name}->contact.decided_by"), "swiftprox_decided_by")?;
    read_enumerator::<FeatureKind>(kind1, format_args!("{name}->contact.feature1.kind"), "swiftprox_feature_kind")?;
    read_enumerator::<FeatureKind>(kind2, format_args!("{name}->contact.feature2.kind"), "swiftprox_feature_kind")?;
    Ok(())
}
