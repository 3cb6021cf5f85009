//! What is refused, and what the message says.

use swiftprox::error::Error;
use swiftprox::math::Pose;
use swiftprox::ray::{Ray, cast_ray};
use testkit::shapes::{at, cuboid};

#[test]
fn rays_and_poses_out_of_range() {
    let cube = cuboid([1.0; 3]);
    let good = Ray { origin: [0.0; 3], direction: [1.0, 0.0, 0.0], t_max: 1.0 };
    let refusal = |ray: Ray, pose: Pose| cast_ray(cube.at(&pose), &ray).unwrap_err();
    for (ray, named) in [
        (Ray { origin: [0.0, f64::NAN, 0.0], ..good }, "origin[1]"),
        (Ray { direction: [0.0, 0.0, f64::INFINITY], ..good }, "direction[2]"),
        (Ray { direction: [0.0, -0.0, 0.0], ..good }, "direction is 0"),
        (Ray { t_max: -1.0, ..good }, "t_max is -1"),
        (Ray { t_max: f64::NAN, ..good }, "t_max is NaN"),
    ] {
        let error = refusal(ray, Pose::IDENTITY);
        assert!(matches!(&error, Error::Argument(message) if message.contains(named)), "{error:?}");
    }
    assert!(matches!(refusal(good, at(0.0, f64::NAN, 0.0)), Error::Pose(_)));
    let mut skewed = Pose::IDENTITY;
    skewed.rows[0][0] = 1.1;
    assert!(matches!(refusal(good, skewed), Error::Pose(_)));
}
