//! Pair caches of any content, as a caller in C can make them.

use swiftprox::pair::PairCache;

/// The number of 32-bit words in a cache.
pub const WORDS: usize = size_of::<PairCache>() / 4;

/// A cache of these bits.
pub fn cache_of_words(words: [u32; WORDS]) -> PairCache {
    #[allow(unsafe_code, reason = "only so can a caller in Rust do what one in C can")]
    // SAFETY: a `repr(C)` struct of 32-bit unsigned integers only, so of the same size and valid for any bits.
    unsafe {
        std::mem::transmute::<[u32; WORDS], PairCache>(words)
    }
}

/// The cache of a pair of features: the number of their kinds, as `state::StateKind` has it, and their indices.
pub fn cache_of_features(kind: u32, indices: [u32; 2]) -> PairCache {
    let mut words = [0; WORDS];
    (words[0], words[1], words[2]) = (kind, indices[0], indices[1]);
    cache_of_words(words)
}
