//! Points and support vertices of shapes.

use std::ffi::c_char;

use super::enumerators::PointLocationNumber;
use super::failure::StatusCode;
use super::guard::guard;
use super::pointers::{handle, input, output};
use crate::base::enumerator::Enumerator;
use crate::base::math::Pose;
use crate::point::{PointAnswer, PointLocation, SupportVertex, locate_point, support};
use crate::shape::Shape;

/// Locates a point of the world relative to a shape at a pose: inside, on or outside, distance from the surface and nearest part.
/// The location is guaranteed: integers decide where doubles cannot. The function allocates.
///
/// On failure the answer is reset and its location is SWIFTPROX_POINT_LOCATION_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: the point is
/// not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_locate_point(
    shape: *const Shape,
    pose: *const f64,
    point: *const f64,
    answer: *mut PointAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`, a point three.
        unsafe {
            output(answer, "answer", PointAnswer::default())?;
            let (shape, pose) = (handle(shape, "shape")?, input(pose.cast::<Pose>(), "pose")?);
            let point = input(point.cast::<[f64; 3]>(), "point")?;
            output(answer, "answer", locate_point(shape.at(pose), *point)?)
        }
    })
}

/// Finds the vertex of a shape at a pose that is farthest along a direction of the world. The result is guaranteed. The direction
/// may have any nonzero length. With a swept radius, place and height are those of the ball about the vertex.
///
/// On failure numbers are NaN or 0. SWIFTPROX_ERROR_INVALID_ARGUMENT: the direction is 0 or not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_support(
    shape: *const Shape,
    pose: *const f64,
    direction: *const f64,
    answer: *mut SupportVertex,
) -> StatusCode {
    guard(|| {
        // SAFETY: as above.
        unsafe {
            output(answer, "answer", SupportVertex::default())?;
            let (shape, pose) = (handle(shape, "shape")?, input(pose.cast::<Pose>(), "pose")?);
            let direction = input(direction.cast::<[f64; 3]>(), "direction")?;
            output(answer, "answer", support(shape.at(pose), *direction)?)
        }
    })
}

/// Returns the text for a location. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_point_location_string(location: PointLocationNumber) -> *const c_char {
    let string = match PointLocation::from_number(location) {
        Some(PointLocation::None) => c"nothing was asked",
        Some(PointLocation::Inside) => c"inside",
        Some(PointLocation::On) => c"on the surface",
        Some(PointLocation::Outside) => c"outside",
        Some(PointLocation::Undecided) => c"undecided",
        None => c"no location of a point",
    };
    string.as_ptr()
}
