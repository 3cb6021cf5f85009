//! The truth about a pair of convex polytopes of any size, in integers and rationals, without the library: whether they
//! intersect, how far apart they are, how deep they are in each other. Slower than doubles by some thousand times, but linear in
//! the number of vertices in each step, where the oracle beside it is O(n⁴).

pub mod decimal;
pub mod depth;
pub mod integers;
pub mod nearest;
