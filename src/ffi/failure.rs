//! Why a call did not do what it says: a status and a message.

use crate::base::error::Error;

/// Status of a call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum StatusCode {
    /// Success.
    Ok = 0,
    /// A required pointer is null; the message names the argument.
    ErrorNullPointer = 1,
    /// An argument is out of range, not finite or unknown; the message names it.
    ErrorInvalidArgument = 2,
    /// A struct was not initialised with its SWIFTPROX_..._DEFAULT, or a newer header's struct sets members unknown to this
    /// library.
    ErrorStructSize = 3,
    /// A pose is refused: an entry is not finite, an entry of R^T R - I exceeds the limit, or det R is not positive.
    ErrorPose = 4,
    /// A mesh breaks the rules; the message names the face, edge or vertex in the caller's numbering.
    ErrorMesh = 5,
    /// A file cannot be read, written or parsed; the message names file and line.
    ErrorFile = 6,
    /// An object id is null, stale or from another scene.
    ErrorHandle = 7,
    /// A limit of the library is exceeded: a count does not fit.
    ErrorLimit = 8,
    /// A callback asked to stop.
    ErrorCancelled = 9,
    /// The library caught a bug of its own. Please report the message.
    ErrorBug = 10,
    /// An earlier call on this handle met a bug. It can only be destroyed.
    ErrorPoisoned = 11,
    /// Header and library do not fit together.
    ErrorVersion = 12,
    /// A verify function found that an answer is wrong for these shapes and poses; the message says where.
    ErrorUnverified = 13,
    /// The library was built without this feature.
    ErrorUnsupported = 14,
    /// Memory is lacking; the message says how much was requested. Only caches may have changed. The same call may succeed later.
    ErrorMemory = 15,
    /// The scene is in use by another thread or by an enclosing call. Nothing has changed.
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
