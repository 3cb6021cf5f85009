//! Depth: against exact integers, against the independent check on many kinds of bodies, whatever the cache holds and the
//! environment is, without allocation; and what the check refuses.

// Any bytes are a cache.
#![allow(unsafe_code)]

mod allocation;
mod bodies;
mod caches;
mod crafted;
mod facets;
mod flat_faces;
mod forgery;
mod magnitudes;
mod resting;
mod streams;
mod truth;

use swiftprox::math::Pose;
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, depth};
use swiftprox::shape::Shape;
use testkit::random::Random;

/// How deep two bodies are in each other, as narrow as can be proved.
fn query(shapes: [&Shape; 2], poses: [&Pose; 2], cache: &mut DepthCache) -> DepthAnswer {
    let mut answer = DepthAnswer::default();
    depth([shapes[0].at(poses[0]), shapes[1].at(poses[1])], cache, &DepthConfig::default(), &mut answer).unwrap();
    answer
}
