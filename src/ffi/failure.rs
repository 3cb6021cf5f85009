//! Why a call did not do what it says: a status and a message.

use crate::base::error::Error;

/// What a call returns. The numbers are never reused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum StatusCode {
    /// The call did what it says.
    Ok = 0,
    /// A pointer that must not be null is null: the message names the argument.
    ErrorNullPointer = 1,
    /// An argument is out of range, not finite or unknown: the message names it.
    ErrorInvalidArgument = 2,
    /// A struct_size is unknown: the struct was not begun with its SWIFTPROX_..._DEFAULT. Or the struct comes from a newer header and
    /// sets what this library does not know.
    ErrorStructSize = 3,
    /// A pose is refused: an entry is not finite, an entry of R^T R - I is beyond the limit, or det R is not positive.
    ErrorPose = 4,
    /// A mesh breaks the contract: the message names the face, edge or vertex in the caller's numbering.
    ErrorMesh = 5,
    /// A file cannot be read or written, or does not parse: the message names the file and the line.
    ErrorFile = 6,
    /// An object id is null, stale or of another scene.
    ErrorHandle = 7,
    /// A limit of the library is reached: a count that does not fit.
    ErrorLimit = 8,
    /// A callback asked to stop.
    ErrorCancelled = 9,
    /// A bug of the library, caught: please report the message.
    ErrorBug = 10,
    /// The handle met a bug in an earlier call; all that can be done with it is to destroy it.
    ErrorPoisoned = 11,
    /// The program was compiled with a header that does not go with this library.
    ErrorVersion = 12,
    /// The answer given to swiftprox_pair_verify does not hold for these shapes and poses: the message says what does not.
    ErrorUnverified = 13,
    /// The library was built without what the call is about.
    ErrorUnsupported = 14,
    /// There is no memory for an array in proportion to what the caller gave or to a scene, of which the message says how much was
    /// asked for, or for an integer of the exact tier. Nothing has changed but what a cache remembers of a search, and the same
    /// call may succeed when there is more.
    ErrorMemory = 15,
    /// The scene is in use: by another thread, which the rules for threads forbid, or by a call that this one was made in. Nothing
    /// has changed.
    ErrorBusy = 16,
}

/// Why a call did not do what it says.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) status: StatusCode,
    pub(super) message: String,
}

/// The result of what runs inside the guard.
pub(super) type Checked<T> = Result<T, Failure>;

impl Failure {
    #[cold]
    pub(super) fn new(status: StatusCode, message: impl Into<String>) -> Failure {
        Failure { status, message: message.into() }
    }

    #[cold]
    pub(super) fn null(name: &str) -> Failure {
        Failure::new(StatusCode::ErrorNullPointer, format!("the pointer `{name}` is null"))
    }
}

impl From<Error> for Failure {
    #[cold]
    fn from(error: Error) -> Failure {
        let status = match error {
            Error::Argument(_) => StatusCode::ErrorInvalidArgument,
            Error::Pose(_) => StatusCode::ErrorPose,
            Error::Mesh(_) => StatusCode::ErrorMesh,
            Error::File(_) => StatusCode::ErrorFile,
            Error::Handle(_) => StatusCode::ErrorHandle,
            Error::Limit(_) => StatusCode::ErrorLimit,
            Error::Memory(_) => StatusCode::ErrorMemory,
            Error::Cancelled(_) => StatusCode::ErrorCancelled,
            Error::Unverified(_) => StatusCode::ErrorUnverified,
            Error::Bug(_) => StatusCode::ErrorBug,
        };
        Failure::new(status, error.message())
    }
}
