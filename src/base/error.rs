//! Every possible failure: the caller's input, a limit of ours, a bug of ours. One enum; every message says what was wrong and
//! where: which face, which vertex, which line of which file.

use std::fmt;
use std::ops::RangeInclusive;

/// Everything that can go wrong in this library.
#[derive(Debug, Clone, PartialEq)]
pub enum Error {
    /// An argument is not acceptable (null, out of range, not finite): the message names it.
    Argument(String),
    /// A pose is refused: not finite, or its rotation farther from orthonormal than the limit.
    Pose(String),
    /// A mesh breaks the contract; the message names the face, edge or vertex in the caller's numbering.
    Mesh(String),
    /// A file cannot be read or does not parse; the message names the file and, where there is one, the line.
    File(String),
    /// An object id is null, stale or of another scene.
    Handle(String),
    /// A limit of the library was reached: a count that does not fit.
    Limit(String),
    /// The memory for an array is not there; the message says how much was requested. Nothing has changed.
    Memory(String),
    /// The caller's callback asked to stop.
    Cancelled(String),
    /// An answer failed its verification; the message says which fact does not hold.
    Unverified(String),
    /// A bug of ours, caught.
    Bug(String),
}

/// The result type of every fallible function of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses a number of the caller's that is out of range or none, by the name it has in Rust and in C.
#[inline]
pub(crate) fn check_range(name: &str, number: f64, range: RangeInclusive<f64>) -> Result<()> {
    if range.contains(&number) { Ok(()) } else { Err(out_of_range(name, number, &range)) }
}

#[cold]
fn out_of_range(name: &str, number: f64, range: &RangeInclusive<f64>) -> Error {
    let (start, end) = (*range.start(), *range.end());
    let least = if start == f64::MIN_POSITIVE { "positive".into() } else { format!("at least {}", Brief(start)) };
    let limits = match end {
        f64::INFINITY => least,
        f64::MAX => format!("finite and {least}"),
        _ => format!("{least} and at most {}", Brief(end)),
    };
    Error::Argument(format!("{name} is {number:?}, it must be {limits}"))
}

/// Digits where they are few, else with an exponent.
struct Brief(f64);

impl fmt::Display for Brief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.to_string();
        if digits.len() <= 20 { f.write_str(&digits) } else { write!(f, "{:e}", self.0) }
    }
}

impl Error {
    /// Another error in place of this one; a lack of memory stays one.
    pub(crate) fn unless_memory(self, other: impl FnOnce(&Error) -> Error) -> Error {
        match self {
            Error::Memory(_) => self,
            _ => other(&self),
        }
    }

    /// The same, with its subject before the message.
    pub(crate) fn about(mut self, what: &str) -> Error {
        let (Error::Argument(m)
        | Error::Pose(m)
        | Error::Mesh(m)
        | Error::File(m)
        | Error::Handle(m)
        | Error::Limit(m)
        | Error::Memory(m)
        | Error::Cancelled(m)
        | Error::Unverified(m)
        | Error::Bug(m)) = &mut self;
        *m = format!("{what}: {m}");
        self
    }

    /// The message without the kind.
    pub fn message(&self) -> &str {
        match self {
            Error::Argument(m)
            | Error::Pose(m)
            | Error::Mesh(m)
            | Error::File(m)
            | Error::Handle(m)
            | Error::Limit(m)
            | Error::Memory(m)
            | Error::Cancelled(m)
            | Error::Unverified(m)
            | Error::Bug(m) => m,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.message())
    }
}

impl std::error::Error for Error {}
