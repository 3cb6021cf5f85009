//! Numbers by which contact points are known again.

use crate::answer::{Feature, FeatureKind};

/// A number made of two features, the same for the same (SplitMix64's finaliser, Steele, Lea & Flood 2014).
pub fn id_of(feature1: &Feature, feature2: &Feature) -> u64 {
    let mut id = 0_u64;
    for feature in [feature1, feature2] {
        // The ends of an edge either way round.
        let [first, second] = feature.ids;
        let [low, high] =
            if feature.kind == FeatureKind::Edge { [first.min(second), first.max(second)] } else { feature.ids };
        for word in [feature.kind as u64, u64::from(low), u64::from(high)] {
            id = (id ^ word).wrapping_add(0x9e37_79b9_7f4a_7c15);
            id = (id ^ id >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            id = (id ^ id >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            id ^= id >> 31;
        }
    }
    id
}
