//! A pair of vertices to start from.

/// A pair of features to start at.
// Laid out so that no two of its numbers side by side are read as one (R1).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct StartPair {
    /// A vertex of body 1.
    pub first: u32,
    /// Whether the bodies seem to intersect.
    pub guess: Guess,
    /// A vertex of body 2.
    pub second: u32,
}

impl StartPair {
    #[inline(always)]
    pub(super) fn new([first, second]: [u32; 2], guess: Guess) -> StartPair {
        StartPair { first, guess, second }
    }

    /// A vertex of each body.
    #[inline(always)]
    pub fn vertices(&self) -> [u32; 2] {
        [self.first, self.second]
    }
}

/// The expectation from a look into the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Guess {
    /// Each of the two vertices is on the side of its body that faces the other vertex, or they are farthest along a line along
    /// which the bodies are apart: most such pairs are disjoint.
    Apart,
    /// Only one is, they are not apart along that line, or nobody looked.
    Unclear,
    /// Neither is: most such pairs intersect.
    Overlapping,
}
