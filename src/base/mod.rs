//! The base of every stage: errors, memory and files that may be refused, progress, vectors and poses, vector units, arithmetic
//! whose signs and last bits are known, and threads. It knows nothing of polyhedra.

pub mod error;
pub(crate) mod locks;
pub(crate) mod mark;
pub(crate) mod memory;
pub mod files;
pub(crate) mod binary;
pub(crate) mod enumerator;
#[doc(hidden)]
pub mod scalar;
pub mod math;
#[doc(hidden)]
pub mod angles;
#[doc(hidden)]
pub mod double_double;
#[doc(hidden)]
pub mod simd;
pub mod progress;
pub(crate) mod sorting;
pub(crate) mod locality;
pub(crate) mod extended_range;
#[doc(hidden)]
pub mod predicates;
#[doc(hidden)]
pub mod normal;
pub(crate) mod workers;
