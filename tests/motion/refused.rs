//! Motions and configurations that are none: an error that says what, and nothing changed.

use std::cell::Cell;

use swiftprox::error::Error;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{
    Callback, CastAnswer, CastConfig, Clearance, ClearanceConfig, Motion, Screw, cast, clearance, motion_between,
    verify_cast,
};
use swiftprox::pair::PairCache;
use testkit::random::rotation;
use testkit::shapes::cuboid;

use crate::{at, moving, straight};

/// The message of the refusal, of all functions that take motions.
fn refused(motions: [&Motion; 2], config: &CastConfig) -> Error {
    let cube = cuboid([0.5; 3]);
    let bodies = moving([&cube, &cube], motions);
    let mut cache = PairCache::default();
    let before = CastAnswer { queries: 77, ..CastAnswer::default() };
    let mut answer = before;
    let error = cast(bodies, &mut cache, config, &mut answer).unwrap_err();
    assert_eq!((cache, answer.queries), (PairCache::default(), 77));
    assert!(verify_cast(bodies, config, &before).is_err());
    error
}

#[test]
fn numbers_that_are_none_are_refused() {
    let (still, good) = (Motion::Fixed(Pose::IDENTITY), straight(at(0.0, 0.0, 3.0), [0.0, 0.0, -4.0]));
    let usual = CastConfig::default();
    let configs = [
        (CastConfig { time_begin: f64::NAN, ..usual }, "time_begin"),
        (CastConfig { time_end: f64::INFINITY, ..usual }, "time_end"),
        (CastConfig { time_begin: 2.0, ..usual }, "before time_begin"),
        (CastConfig { time_tolerance: 0.0, ..usual }, "time_tolerance"),
        (CastConfig { time_tolerance: 1e-17, ..usual }, "time_tolerance"),
        (CastConfig { time_tolerance: f64::NAN, ..usual }, "time_tolerance"),
        (CastConfig { max_distance: -1.0, ..usual }, "max_distance"),
        (CastConfig { max_distance: f64::NAN, ..usual }, "max_distance"),
        (CastConfig { step_budget: 0, ..usual }, "step_budget"),
    ];
    for (config, name) in configs {
        let error = refused([&good, &still], &config);
        assert!(matches!(&error, Error::Argument(message) if message.contains(name)), "{name}: {error:?}");
    }
    let screw = |velocity: f64, rotation: f64, centre: f64| {
        let [velocity, rotation, centre] = [velocity, rotation, centre].map(|x| Vector::new(0.0, x, 0.0));
        Motion::Screw(Screw { start: Pose::IDENTITY, centre, velocity, rotation })
    };
    let motions = [
        (screw(f64::NAN, 0.0, 0.0), "velocity"),
        (screw(0.0, f64::INFINITY, 0.0), "rotation"),
        (screw(0.0, 0.0, f64::NEG_INFINITY), "centre"),
        (screw(0.0, 1e7, 0.0), "radians"),
        (screw(1e70, 0.0, 0.0), "reaches"),
    ];
    for (motion, name) in &motions {
        for bodies in [[motion, &still], [&still, motion]] {
            let error = refused(bodies, &usual);
            assert!(matches!(&error, Error::Argument(message) if message.contains(name)), "{name}: {error:?}");
        }
    }
    let mut asked = Clearance::default();
    let cube = cuboid([0.5; 3]);
    let config = ClearanceConfig { relative_error: f64::NAN, ..ClearanceConfig::default() };
    let error = clearance(moving([&cube, &cube], [&good, &still]), &mut PairCache::default(), &config, &mut asked);
    assert!(matches!(error, Err(Error::Argument(_))) && asked.lower.is_nan());
}

#[test]
fn poses_beyond_the_limit_are_refused() {
    let still = Motion::Fixed(Pose::IDENTITY);
    let stretched = Pose::new(&(Matrix::identity() * 1.1), &Vector::zeros());
    let turned = Pose::new(&rotation(&Vector::x(), 0.5), &Vector::new(3.0, 0.0, 0.0));
    for motion in [
        Motion::Fixed(stretched),
        straight(stretched, [1.0, 0.0, 0.0]),
        // In the middle of half a radian the entries are 3 % too short.
        Motion::Affine { start: Pose::IDENTITY, end: turned },
        Motion::Callback(Callback { pose: &|_| stretched, bend: 0.0, rounding: 0.0 }),
    ] {
        let error = refused([&motion, &still], &CastConfig::default());
        assert!(matches!(error, Error::Pose(_)), "{motion:?}: {error:?}");
    }
    assert!(matches!(motion_between(&stretched, &Pose::IDENTITY, &Vector::zeros(), 1.0), Err(Error::Pose(_))));
    let far = motion_between(&turned, &Pose::IDENTITY, &Vector::new(0.0, f64::NAN, 0.0), 1.0);
    assert!(matches!(far, Err(Error::Argument(_))));
}

#[test]
fn a_callback_that_breaks_its_bound_is_found_out() {
    let still = Motion::Fixed(Pose::IDENTITY);
    // A parabola whose acceleration is 8, not 1: at its top 1e-3 above the cube.
    let arc = |t: f64| at(8.0 * t - 4.0, 0.0, 1.001 + 4.0 * (t - 0.5) * (t - 0.5));
    let with = |bend: f64| Motion::Callback(Callback { pose: &arc, bend, rounding: 1e-14 });
    let error = refused([&with(1.0), &still], &CastConfig::default());
    assert!(matches!(&error, Error::Argument(message) if message.contains("bend")), "{error:?}");
    // With the right bound it is free.
    let cube = cuboid([0.5; 3]);
    let right = with(8.0);
    let answer = crate::run(moving([&cube, &cube], [&right, &still]), &CastConfig::default());
    assert!(answer.clearance <= 0.001 && answer.clearance > 0.0, "{answer:?}");
    // What is no pose is refused wherever it shows.
    let late = |t: f64| if t > 0.25 { at(f64::NAN, 0.0, 0.0) } else { at(0.0, 0.0, 9.0) };
    let asked = Cell::new(0);
    let counted = |t: f64| {
        asked.set(asked.get() + 1);
        late(t)
    };
    let error = refused(
        [&Motion::Callback(Callback { pose: &counted, bend: 0.0, rounding: 0.0 }), &still],
        &CastConfig::default(),
    );
    assert!(matches!(&error, Error::Pose(message) if message.contains("at time")), "{error:?}");
    assert!(asked.get() > 0);
    for (bend, rounding) in [(f64::NAN, 0.0), (-1.0, 0.0), (0.0, f64::INFINITY)] {
        let motion = Motion::Callback(Callback { pose: &arc, bend, rounding });
        assert!(matches!(refused([&motion, &still], &CastConfig::default()), Error::Argument(_)));
    }
}
