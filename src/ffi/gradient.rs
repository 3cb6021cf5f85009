//! How a pair's signed distance changes as its objects move.

use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::pair::{CPlaced, bodies};
use super::pointers::output;
use crate::base::enumerator::Enumerator;
use crate::pair::{Gradient, Outcome, SignedDistance, gradient};

/// Computes how the signed distance changes as the objects move, from an answer of swiftprox_pair_signed_distance for the same
/// objects, without a further search. A distance's or depth's members serve as well, the depth's with their signs reversed.
///
/// Reference points have 3 numbers, in the world; null: the translation of the pose. An object moves with its reference point and
/// turns about it. docs/gradients.md says where the derivative does not exist; swiftprox_gradient.is_unique is 0 there.
///
/// Time is linear in the number of vertices; nothing is allocated. On failure numbers are NaN. SWIFTPROX_ERROR_INVALID_ARGUMENT:
/// the answer has no normal and witness points (outcomes other than separated and intersecting), or a reference point is not
/// finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_gradient(
    object1: CPlaced,
    object2: CPlaced,
    answer: *const SignedDistance,
    reference1: *const f64,
    reference2: *const f64,
    gradient: *mut Gradient,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`, a reference point three.
        unsafe {
            output(gradient, "gradient", Gradient::default())?;
            let bodies = bodies(object1, object2)?;
            let answer = read_answer(answer)?;
            let references = [reference1, reference2].map(|point| point.cast::<[f64; 3]>().as_ref().copied());
            output(gradient, "gradient", self::gradient(bodies, &answer, references)?)
        }
    })
}

/// The members of an answer that a gradient is made of. Its enumerators may be any numbers.
///
/// # Safety
/// The pointer meets the header's pointer rules.
unsafe fn read_answer(answer: *const SignedDistance) -> Checked<SignedDistance> {
    if answer.is_null() {
        return Err(Failure::null("answer"));
    }
    // SAFETY: not null, readable by the caller's promise; an outcome is an i32, numbers are of any bits.
    unsafe {
        let outcome = (&raw const (*answer).outcome).cast::<i32>().read();
        Ok(SignedDistance {
            outcome: Outcome::from_number(outcome).unwrap_or(Outcome::None),
            lower: (&raw const (*answer).lower).read(),
            upper: (&raw const (*answer).upper).read(),
            world1: (&raw const (*answer).world1).read(),
            world2: (&raw const (*answer).world2).read(),
            normal: (&raw const (*answer).normal).read(),
            ..SignedDistance::default()
        })
    }
}
