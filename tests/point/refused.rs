//! What is refused, and what the message says.

use swiftprox::error::Error;
use swiftprox::math::Pose;
use swiftprox::point::{locate_point, support};
use testkit::shapes::{at, cuboid};

#[test]
fn numbers_and_poses_out_of_range() {
    let cube = cuboid([1.0; 3]);
    let here = cube.at(&Pose::IDENTITY);
    for (error, named) in [
        (locate_point(here, [0.0, f64::NAN, 0.0]).unwrap_err(), "point[1]"),
        (locate_point(here, [0.0, 0.0, f64::INFINITY]).unwrap_err(), "point[2]"),
        (support(here, [f64::NEG_INFINITY, 0.0, 0.0]).unwrap_err(), "direction[0]"),
        (support(here, [0.0, -0.0, 0.0]).unwrap_err(), "direction is 0"),
    ] {
        assert!(matches!(&error, Error::Argument(message) if message.contains(named)), "{error:?}");
    }
    let nowhere = at(0.0, f64::NAN, 0.0);
    assert!(matches!(locate_point(cube.at(&nowhere), [0.0; 3]), Err(Error::Pose(_))));
    assert!(matches!(support(cube.at(&nowhere), [1.0, 0.0, 0.0]), Err(Error::Pose(_))));
}
