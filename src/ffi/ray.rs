//! Rays at shapes.

use std::ffi::c_char;

use super::enumerators::RayOutcomeNumber;
use super::failure::StatusCode;
use super::guard::guard;
use super::pointers::{handle, input, output};
use crate::base::enumerator::Enumerator;
use crate::base::math::Pose;
use crate::ray::{Ray, RayAnswer, RayOutcome, cast_ray};
use crate::shape::Shape;

/// Casts a ray at a shape at a pose and finds the part of the ray inside the closed body, swept radius included. The result is
/// guaranteed; touching is a hit. Ends are intervals that contain the true ones. Their width is at most 2^-40 of the lengths of the
/// ray and the body, divided by that of the direction.
///
/// On failure the answer is reset and its outcome is SWIFTPROX_RAY_OUTCOME_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: origin or
/// direction is not finite, the direction is 0, or t_max is negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_cast_ray(
    shape: *const Shape,
    pose: *const f64,
    ray: *const Ray,
    answer: *mut RayAnswer,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        unsafe {
            output(answer, "answer", RayAnswer::default())?;
            let (shape, pose, ray) = (handle(shape, "shape")?, input(pose.cast::<Pose>(), "pose")?, input(ray, "ray")?);
            output(answer, "answer", cast_ray(shape.at(pose), ray)?)
        }
    })
}

/// Returns the text for a ray outcome. Never null, valid forever, also for unknown numbers.
#[unsafe(no_mangle)]
pub extern "C" fn swiftprox_library_ray_outcome_string(outcome: RayOutcomeNumber) -> *const c_char {
    let string = match RayOutcome::from_number(outcome) {
        Some(RayOutcome::None) => c"nothing was asked",
        Some(RayOutcome::Miss) => c"miss",
        Some(RayOutcome::Hit) => c"hit",
        Some(RayOutcome::Inside) => c"inside",
        Some(RayOutcome::Undecided) => c"undecided",
        None => c"no outcome of a ray cast",
    };
    string.as_ptr()
}
