//! Bodies and half-spaces.

use super::depth::{CManifoldConfig, CManifoldRoom, read_manifold_config, writer_to};
use super::failure::StatusCode;
use super::guard::guard;
use super::pair::{CPlaced, body};
use super::pointers::{input, output};
use crate::manifold::{Manifold, Sink, half_space_manifold_into};
use crate::pair::{HalfSpace, SignedDistance, half_space_distance};

/// Computes the signed distance of a shape (object 1) from a half-space (object 2), as swiftprox_pair_signed_distance does. The
/// interval is guaranteed for the exact shape and plane; integers decide touching. The normal is the half-space's, of unit length.
/// The half-space's witness point is on the plane, in world coordinates in both members; its feature is
/// SWIFTPROX_FEATURE_KIND_NONE.
///
/// On failure the answer is reset. SWIFTPROX_ERROR_INVALID_ARGUMENT: the normal is 0, or a number of half_space is not finite.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_half_space_distance(
    object: CPlaced,
    half_space: *const HalfSpace,
    answer: *mut SignedDistance,
) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
        unsafe {
            output(answer, "answer", SignedDistance::default())?;
            let object = body(object, ["object.shape", "object.pose"])?;
            output(answer, "answer", half_space_distance(object, input(half_space, "half_space")?)?)
        }
    })
}

/// Computes where a shape (object 1) meets a half-space or is at most config->max_distance apart. The points are the corners of the
/// face that points most towards the plane, with a gap of at most max_distance. The lowest point is always included. Output is as
/// in swiftprox_pair_manifold. There is no cache, so each call chooses the four points of a reduced manifold anew.
///
/// Same errors as swiftprox_pair_half_space_distance and swiftprox_pair_manifold. On failure the manifold is reset and points are
/// unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_pair_half_space_manifold(
    object: CPlaced,
    half_space: *const HalfSpace,
    config: *const CManifoldConfig,
    room: CManifoldRoom,
    manifold: *mut Manifold,
) -> StatusCode {
    let CManifoldRoom { points, capacity, distance } = room;
    guard(|| {
        // SAFETY: the header's pointer rules.
        let (object, half_space, config) = unsafe {
            output(manifold, "manifold", Manifold::default())?;
            if !distance.is_null() {
                distance.write(SignedDistance::default());
            }
            (
                body(object, ["object.shape", "object.pose"])?,
                input(half_space, "half_space")?,
                read_manifold_config(config)?,
            )
        };
        // SAFETY: the header's pointer rules; the sink stays below its capacity.
        let mut write = unsafe { writer_to(points, capacity) }?;
        let mut sink = Sink { capacity, written: 0, write: &mut write };
        let found = half_space_manifold_into(object, half_space, &config, &mut sink)?;
        // SAFETY: the header's pointer rules.
        unsafe {
            if !distance.is_null() {
                distance.write(half_space_distance(object, half_space)?);
            }
            output(manifold, "manifold", found)
        }
    })
}
