//! Motions: known answers, adversarial families judged by dense sampling, forged answers, refused motions, whatever the cache
//! holds.

// Any bytes are a cache.
#![allow(unsafe_code)]

mod caches;
mod clearances;
mod counts;
mod families;
mod forgery;
mod known;
mod refused;
mod slivers;

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, Motion, Moving, Screw, cast};
use swiftprox::pair::PairCache;
use swiftprox::shape::Shape;
use testkit::shapes::at;

fn moving<'a>(shapes: [&'a Shape; 2], motions: [&'a Motion<'a>; 2]) -> [Moving<'a>; 2] {
    [0, 1].map(|i| Moving { shape: shapes[i], motion: motions[i] })
}

fn run(bodies: [Moving; 2], config: &CastConfig) -> CastAnswer {
    let mut answer = CastAnswer::default();
    cast(bodies, &mut PairCache::default(), config, &mut answer).unwrap();
    answer
}

/// Without turning.
fn straight(start: Pose, velocity: [f64; 3]) -> Motion<'static> {
    screw(start, velocity, [0.0; 3])
}

/// About the local origin.
fn screw(start: Pose, velocity: [f64; 3], rotation: [f64; 3]) -> Motion<'static> {
    Motion::Screw(Screw { start, centre: Vector::zeros(), velocity: velocity.into(), rotation: rotation.into() })
}
