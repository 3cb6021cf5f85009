//! The library as a whole: its version, its statuses and what answers say in words, the last error, the log.

use std::ffi::{CStr, c_char, c_void};

use super::enumerators::{DecidedByNumber, FeatureKindNumber, OutcomeNumber, StatusNumber};
use super::failure::{Failure, StatusCode};
use super::guard::{LAST_ERROR, guard};
pub use super::log::LogCallback;
use super::log::set_log;
use crate::base::enumerator::Enumerator;
use crate::pair::{DecidedBy, FeatureKind, Outcome};

/// Major version of this header. Programs need a library with the same one.
pub const VERSION_MAJOR: i32 = 0;
/// Minor version of this header. While the major version is 0, each minor version is another interface.
pub const VERSION_MINOR: i32 = 2;
/// Patch version of this header.
pub const VERSION_PATCH: i32 = 0;

/// Version of the running library as "major.minor.patch". Never null, valid forever.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Checks whether this library fits the program's header. Call it once with SWIFTPROX_VERSION_MAJOR, SWIFTPROX_VERSION_MINOR and
/// SWIFTPROX_VERSION_PATCH.
///
/// SWIFTPROX_ERROR_VERSION: the library is too old or has another interface; the message gives both versions.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_check_version(major: i32, minor: i32, patch: i32) -> StatusCode {
    guard(|| {
        let fits = major == VERSION_MAJOR
            && if major == 0 { minor == VERSION_MINOR } else { (0..=VERSION_MINOR).contains(&minor) };
        if fits {
            return Ok(());
        }
        Err(Failure::new(
            StatusCode::ErrorVersion,
            format!(
                "the program was compiled for version {major}.{minor}.{patch}, the library is {}",
                env!("CARGO_PKG_VERSION")
            ),
        ))
    })
}

/// Returns the text for a status. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_status_string(status: StatusNumber) -> *const c_char {
    const STRINGS: [(StatusCode, &CStr); 17] = [
        (StatusCode::Ok, c"ok"),
        (StatusCode::ErrorNullPointer, c"a pointer is null"),
        (StatusCode::ErrorInvalidArgument, c"an argument is invalid"),
        (StatusCode::ErrorStructSize, c"a struct_size is unknown"),
        (StatusCode::ErrorPose, c"a pose is refused"),
        (StatusCode::ErrorMesh, c"a mesh breaks the contract"),
        (StatusCode::ErrorFile, c"a file cannot be read or written"),
        (StatusCode::ErrorHandle, c"an object id is null, stale or of another scene"),
        (StatusCode::ErrorLimit, c"a limit of the library is reached"),
        (StatusCode::ErrorCancelled, c"a callback asked to stop"),
        (StatusCode::ErrorBug, c"a bug of the library was caught"),
        (StatusCode::ErrorPoisoned, c"the handle met a bug in an earlier call"),
        (StatusCode::ErrorVersion, c"header and library do not go together"),
        (StatusCode::ErrorUnverified, c"the answer does not hold"),
        (StatusCode::ErrorUnsupported, c"the library was built without it"),
        (StatusCode::ErrorMemory, c"there is no memory"),
        (StatusCode::ErrorBusy, c"the scene is in use"),
    ];
    let known = STRINGS.iter().find(|(code, _)| *code as i32 == status);
    known.map_or(c"not a status", |(_, string)| string).as_ptr()
}

/// Returns the text for an outcome of a pair query. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_outcome_string(outcome: OutcomeNumber) -> *const c_char {
    let string = match Outcome::from_number(outcome) {
        Some(Outcome::None) => c"nothing is said",
        Some(Outcome::Separated) => c"separated",
        Some(Outcome::Beyond) => c"beyond max_distance",
        Some(Outcome::Intersecting) => c"intersecting",
        Some(Outcome::Undecided) => c"undecided",
        None => c"not an outcome",
    };
    string.as_ptr()
}

/// Returns the text for the method that decided a pair query. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_decided_by_string(decided_by: DecidedByNumber) -> *const c_char {
    let string = match DecidedBy::from_number(decided_by) {
        Some(DecidedBy::None) => c"nothing",
        Some(DecidedBy::Marching) => c"Voronoi marching",
        Some(DecidedBy::Coherence) => c"what proved the last verdict",
        Some(DecidedBy::Fallback) => c"Gilbert-Johnson-Keerthi",
        Some(DecidedBy::Integers) => c"integer arithmetic",
        Some(DecidedBy::Tolerance) => c"the errors that were allowed",
        Some(DecidedBy::Budget) => c"the step budget, which ran out",
        Some(DecidedBy::BoundingSpheres) => c"the bounding spheres",
        Some(DecidedBy::InscribedSpheres) => c"balls inside the objects",
        None => c"not what decides",
    };
    string.as_ptr()
}

/// Returns the text for a feature kind: "none", "vertex", "edge" or "face". Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_feature_kind_string(kind: FeatureKindNumber) -> *const c_char {
    let string = match FeatureKind::from_number(kind) {
        Some(FeatureKind::None) => c"none",
        Some(FeatureKind::Vertex) => c"vertex",
        Some(FeatureKind::Edge) => c"edge",
        Some(FeatureKind::Face) => c"face",
        None => c"not a feature kind",
    };
    string.as_ptr()
}

/// Message of this thread's last call that did not return SWIFTPROX_OK; empty before the first. Never null; valid until the next
/// such call of the thread, or its end.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_last_error_message() -> *const c_char {
    LAST_ERROR.try_with(|last| last.borrow().as_ptr()).unwrap_or(c"".as_ptr())
}

/// Sets the log of the process. It receives the message of every call that does not return SWIFTPROX_OK. Null (the default) means
/// none. The callback may run in several threads at once. Calls already under way may still use the old one for a moment.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_set_log(callback: LogCallback, user: *mut c_void) {
    set_log(callback, user);
}
