//! Bounds on rounding, proved of the code that runs: see docs/proofs.md.
//!
//! The library's kernels are generic over their lanes, and its formulas over their scalars. Here they run on lanes and scalars
//! that write down what is done to them: a [`tape`]. On the tape a value is a polynomial of the inputs, and what rounding may make
//! of each of its coefficients is an interval of rationals ([`count`]). Gappa proves these intervals again, Coq the polynomials
//! and what follows from both ([`scripts`]).

pub mod library;
pub mod tape;
pub mod symbolic;
pub mod kernels;
pub mod count;
pub mod rows;
pub mod scripts;

// The testkit's generator alone: the rest of it takes long to compile.
#[allow(dead_code, reason = "a part of it is used")]
#[path = "../../testkit/src/random.rs"]
mod random;
