//! Objects of a scene: added, removed, moved, and asked what they are.

use std::sync::Arc;

use super::arrays::check_capacity;
use super::failure::{Checked, Failure, StatusCode};
use super::guard::guard;
use super::pointers::{Handle, array, freed, input, output};
use super::scene::{SceneHandle, change, look};
use super::structs::{Versioned, read_struct, write_struct};
use crate::base::math::Pose;
use crate::base::memory::with_capacity;
use crate::compound::Compound;
use crate::ground::Ground;
use crate::scene::Object;
use crate::scene::object::{ObjectId, ObjectOptions};
use crate::shape::Shape;

/// How an object is made. Initialise with SWIFTPROX_OBJECT_OPTIONS_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CObjectOptions {
    /// Set by SWIFTPROX_OBJECT_OPTIONS_DEFAULT.
    pub struct_size: usize,
    /// The caller's number; every result returns it. Default: 0.
    pub user_data: u64,
    /// Its pose, row-major [R|T]. Default: the identity.
    pub pose: [f64; 12],
    /// Not 0: pairs of two fixed objects are never tested. A fixed object can still be moved. Default: 0.
    pub fixed: i32,
    /// Its groups, one bit each. Two objects are tested if each one's mask has a bit of the other's groups. Default: 0, which
    /// means the first group only, 1.
    pub groups: u32,
    /// The groups it is tested against. Default: 0, which means all.
    pub mask: u32,
    /// A ground that the object is, instead of pieces; experimental. It is always fixed. Default: null.
    pub ground: *const Ground,
    /// A compound that the object is, instead of pieces; experimental. Default: null.
    pub compound: *const Compound,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CObjectOptions {
    const NAME: &'static str = "swiftprox_object_options";
}

impl CObjectOptions {
    /// The defaults, as in the header.
    pub const DEFAULT: CObjectOptions = CObjectOptions {
        struct_size: size_of::<CObjectOptions>(),
        user_data: 0,
        pose: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        fixed: 0,
        groups: 0,
        mask: 0,
        ground: std::ptr::null(),
        compound: std::ptr::null(),
    };
}

/// Properties of an object. Set struct_size to sizeof(swiftprox_object_info) before the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct ObjectInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// The caller's number.
    pub user_data: u64,
    /// Number of convex pieces; 0 for a ground or a compound.
    pub piece_count: usize,
    /// Its pose, row-major [R|T].
    pub pose: [f64; 12],
    /// 1 if it is fixed, else 0.
    pub fixed: i32,
    /// Its groups, one bit each.
    pub groups: u32,
    /// The groups it is tested against.
    pub mask: u32,
    /// The ground that it is, or null; experimental. The scene owns the share.
    pub ground: *const Ground,
    /// The compound that it is, or null; experimental. The scene owns the share.
    pub compound: *const Compound,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for ObjectInfo {
    const NAME: &'static str = "swiftprox_object_info";
}

impl ObjectInfo {
    /// The info of no object.
    const UNKNOWN: ObjectInfo = ObjectInfo {
        struct_size: size_of::<ObjectInfo>(),
        user_data: 0,
        piece_count: 0,
        pose: [f64::NAN; 12],
        fixed: 0,
        groups: 0,
        mask: 0,
        ground: std::ptr::null(),
        compound: std::ptr::null(),
    };
}

// --- Objects -------------------------------------------------------------------------------------------------------------

/// Adds an object of one or more convex pieces in one local frame. All its pairs are active. The scene takes its own share of each
/// shape, so the caller may release its shares at once. Null `options` mean the defaults. On failure `*id` is null.
///
/// With options->ground and a piece_count of 0 it adds that ground. Results name the ground as piece 0, and the triangle as a
/// feature that is a face. swiftprox_scene_set_pose moves it. Functions about pieces refuse it. Two grounds make no pair.
///
/// With options->compound and a piece_count of 0 it adds that compound as one body. A pair of objects with it has one result, the
/// first proof or the nearest pieces, named as piece1 or piece2; with a detail one result for each two pieces in reach. Functions
/// about pieces refuse it.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: no pieces, ground or compound, or more than one of them.
/// SWIFTPROX_ERROR_LIMIT: more objects or pieces than a scene holds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_add_object(
    scene: *mut SceneHandle,
    pieces: *const *const Shape,
    piece_count: usize,
    options: *const CObjectOptions,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        add(scene, options, id, || {
            let pieces = array(pieces, piece_count, "pieces")?;
            let mut shares = with_capacity(pieces.len())?;
            for (i, &piece) in pieces.iter().enumerate() {
                shares.push(share(piece, format_args!("pieces[{i}]"))?);
            }
            Ok(shares)
        })
    }
}

/// Adds a copy of `original` as it is now: its pieces (shared) and their poses, its pose, fixed flag, groups, mask and all user
/// data. All pairs of the copy are active. Pair caches are not copied. On failure nothing is added and `*id` is null.
///
/// SWIFTPROX_ERROR_LIMIT: more objects than a scene holds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_copy_object(
    scene: *mut SceneHandle,
    original: ObjectId,
    id: *mut ObjectId,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            output(id, "id", ObjectId::NULL)?;
            id.write(scene.copy_object(original)?);
            Ok(())
        })
    }
}

/// Removes an object and its pairs. Its id becomes invalid; all other ids stay valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_remove_object(scene: *mut SceneHandle, id: ObjectId) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.remove_object(id)?)) }
}

/// Sets `*valid` to 1 if the id names an object of this scene, else to 0. It is 0 for a null id, an id of another scene, a removed
/// object, and on failure. Two ids name the same object if their bits are equal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_is_object_valid(
    scene: *const SceneHandle,
    id: ObjectId,
    valid: *mut i32,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(valid, "valid", 0)?;
        look(scene, |scene| {
            valid.write(i32::from(scene.object(id).is_ok()));
            Ok(())
        })
    })
}

/// Writes the ids of all objects in order of creation, and their number to `*count`. Results and swiftprox_scene_set_poses use the
/// same order. `ids` has room for `capacity` ids. With capacity 0 it may be null, and only the number is written. On failure
/// `*count` is 0.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: capacity is not 0 and less than the number of objects.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_copy_object_ids(
    scene: *const SceneHandle,
    ids: *mut ObjectId,
    capacity: usize,
    count: *mut usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(count, "count", 0)?;
        look(scene, |scene| {
            if capacity > 0 {
                check_capacity(ids, "ids", capacity, scene.object_count())?;
                for (k, object) in scene.objects().enumerate() {
                    ids.add(k).write(object.id());
                }
            }
            count.write(scene.object_count());
            Ok(())
        })
    })
}

/// Sets an object's user data, pose, fixed flag, groups and mask. Fill info with swiftprox_scene_get_object_info, then change
/// members. An unchanged pose moves nothing. Pair caches are kept.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: piece_count, ground or compound differs from the object's, and nothing has changed; or a
/// ground is not to be fixed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_object_info(
    scene: *mut SceneHandle,
    id: ObjectId,
    info: *const ObjectInfo,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        change(scene, |scene| {
            input(info, "info")?;
            let before = info_of(&scene.object(id)?);
            let after = read_struct(info, before)?;
            let bodies = |info: &ObjectInfo| (info.piece_count, info.ground, info.compound);
            if bodies(&after) != bodies(&before) {
                let message = format!(
                    "info->piece_count is {}, and the object has {}, or info->ground or compound is another; fill info by \
                     swiftprox_scene_get_object_info",
                    after.piece_count, before.piece_count
                );
                return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
            }
            if !after.ground.is_null() && after.fixed == 0 {
                // Refused, before anything has changed.
                scene.set_fixed(id, false)?;
            }
            if after.pose != before.pose {
                scene.set_pose(id, &Pose::from_row_major(&after.pose))?;
            }
            if after.user_data != before.user_data {
                scene.set_user_data(id, after.user_data)?;
            }
            if after.fixed != before.fixed {
                scene.set_fixed(id, after.fixed != 0)?;
            }
            let (groups, mask) = (groups_or_first(after.groups), mask_or_all(after.mask));
            if (groups, mask) != (before.groups, before.mask) {
                scene.set_filter(id, groups, mask)?;
            }
            Ok(())
        })
    }
}

/// Sets the caller's number of a piece; it is 0 at first. swiftprox_scene_get_piece_user_data and the events of listeners return
/// it; other results name the object and the piece.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_set_piece_user_data(
    scene: *mut SceneHandle,
    id: ObjectId,
    piece: u32,
    user_data: u64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.set_piece_user_data(id, piece, user_data)?)) }
}

/// Writes the caller's number of a piece. The time does not grow with the scene. On failure it is 0.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_piece_user_data(
    scene: *const SceneHandle,
    id: ObjectId,
    piece: u32,
    user_data: *mut u64,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(user_data, "user_data", 0)?;
        look(scene, |scene| {
            let object = scene.object(id)?;
            check_piece(&object, piece as usize)?;
            user_data.write(object.piece_user_data(piece as usize));
            Ok(())
        })
    })
}

/// Writes an object's properties. Set info->struct_size to sizeof(swiftprox_object_info) first. On failure the pose is NaN, all
/// else 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_object_info(
    scene: *const SceneHandle,
    id: ObjectId,
    info: *mut ObjectInfo,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        write_struct(info, "info", &ObjectInfo::UNKNOWN)?;
        look(scene, |scene| write_struct(info, "info", &info_of(&scene.object(id)?)))
    })
}

/// Writes the corners of a box along the world's axes that contains the object, swept radii included. Each corner has three
/// numbers. The box exceeds the object by less than 1e-5 of each piece's radius and position. A piece of more than 512 vertices is
/// represented by its oriented box instead. On failure all numbers are NaN.
///
/// SWIFTPROX_ERROR_HANDLE: the id is null, stale or of another scene.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_object_box(
    scene: *const SceneHandle,
    id: ObjectId,
    lower_corner: *mut f64,
    upper_corner: *mut f64,
) -> StatusCode {
    // SAFETY: the header's pointer rules; each has room for three numbers.
    guard(|| unsafe {
        output(lower_corner.cast::<[f64; 3]>(), "lower_corner", [f64::NAN; 3])?;
        output(upper_corner.cast::<[f64; 3]>(), "upper_corner", [f64::NAN; 3])?;
        look(scene, |scene| {
            let [lower, upper] = scene.object(id)?.world_box();
            output(lower_corner.cast(), "lower_corner", lower)?;
            output(upper_corner.cast(), "upper_corner", upper)
        })
    })
}

/// Returns the shape of a piece of an object. `piece` counts from 0; it is a size_t for compatibility, though results use a
/// uint32_t. The scene owns the share. To keep the shape longer than the object, call swiftprox_shape_retain. On failure `*shape`
/// is null.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the object has no such piece.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_get_piece(
    scene: *const SceneHandle,
    id: ObjectId,
    piece: usize,
    shape: *mut *const Shape,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(shape, "shape", std::ptr::null())?;
        look(scene, |scene| {
            let object = scene.object(id)?;
            check_piece(&object, piece)?;
            shape.write(Arc::as_ptr(&object.pieces()[piece]));
            Ok(())
        })
    })
}

// --- What the functions above share --------------------------------------------------------------------------------------

/// An object's options, in C's terms.
fn info_of(object: &Object) -> ObjectInfo {
    ObjectInfo {
        struct_size: size_of::<ObjectInfo>(),
        user_data: object.user_data(),
        piece_count: object.pieces().len(),
        pose: std::array::from_fn(|i| object.pose().rows[i / 4][i % 4]),
        fixed: i32::from(object.fixed()),
        groups: object.groups(),
        mask: object.mask(),
        ground: object.ground().map_or(std::ptr::null(), Arc::as_ptr),
        compound: object.compound().map_or(std::ptr::null(), Arc::as_ptr),
    }
}

/// Refuses a piece that an object does not have.
pub(super) fn check_piece(object: &Object, piece: usize) -> Checked<()> {
    Ok(object.refuse_absent(piece)?)
}

/// What an object is instead of pieces.
pub(super) enum WholeBody {
    Ground(Arc<Ground>),
    Compound(Arc<Compound>),
}

/// How an object begins, in Rust's terms, and what it is instead of pieces.
///
/// # Safety
/// `options` meets the header's pointer rules.
pub(super) unsafe fn object_options(options: *const CObjectOptions) -> Checked<(ObjectOptions, Option<WholeBody>)> {
    // SAFETY: by the caller.
    let options = unsafe { read_struct(options, CObjectOptions::DEFAULT) }?;
    let own = ObjectOptions {
        pose: Pose::from_row_major(&options.pose),
        fixed: options.fixed != 0,
        user_data: options.user_data,
        groups: groups_or_first(options.groups),
        mask: mask_or_all(options.mask),
    };
    let body = match (options.ground.is_null(), options.compound.is_null()) {
        (true, true) => None,
        // SAFETY: by the caller.
        (false, true) => Some(WholeBody::Ground(unsafe { share(options.ground, "options->ground") }?)),
        // SAFETY: by the caller.
        (true, false) => Some(WholeBody::Compound(unsafe { share(options.compound, "options->compound") }?)),
        (false, false) => {
            let message = "options->ground and options->compound are set: add one object for each";
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
        }
    };
    Ok((own, body))
}

/// Groups as a program gives them: none are the first one.
fn groups_or_first(groups: u32) -> u32 {
    if groups == 0 { 1 } else { groups }
}

/// A mask as a program gives it: none is all.
fn mask_or_all(mask: u32) -> u32 {
    if mask == 0 { u32::MAX } else { mask }
}

/// One more share of a shape, a ground or a compound.
///
/// # Safety
/// `pointer` meets the header's pointer rules.
pub(super) unsafe fn share<T: Handle>(pointer: *const T, name: impl std::fmt::Display) -> Checked<Arc<T>> {
    // SAFETY: a live one by the caller, which came from Arc::into_raw.
    let is_alive = unsafe { pointer.as_ref() }.is_some_and(|shared| shared.mark().is_alive());
    if !is_alive {
        return Err(if pointer.is_null() { Failure::null(&name.to_string()) } else { freed::<T>(&name.to_string()) });
    }
    // SAFETY: a live one by the caller, which came from Arc::into_raw.
    Ok(unsafe {
        Arc::increment_strong_count(pointer);
        Arc::from_raw(pointer)
    })
}

/// Adds an object of the pieces that `make` makes.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn add(
    scene: *mut SceneHandle,
    options: *const CObjectOptions,
    id: *mut ObjectId,
    make: impl FnOnce() -> Checked<Vec<Arc<Shape>>>,
) -> StatusCode {
    let mut made = None;
    // Made outside the scene: a bug in the making of shapes does not spoil it.
    let status = guard(|| {
        // SAFETY: by the caller.
        unsafe { output(id, "id", ObjectId::NULL) }?;
        // SAFETY: by the caller.
        let (options, body) = unsafe { object_options(options) }?;
        let pieces = make()?;
        if body.is_some() && !pieces.is_empty() {
            let message = "options->ground or compound and pieces are set: an object is one or has pieces; add one \
                           object for each";
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
        }
        made = Some((pieces, body, options));
        Ok(())
    });
    let Some((pieces, body, options)) = made else {
        return status;
    };
    // SAFETY: by the caller; `id` was written before.
    unsafe {
        change(scene, |scene| {
            id.write(match body {
                Some(WholeBody::Ground(ground)) => scene.add_ground(ground, &options)?,
                Some(WholeBody::Compound(compound)) => scene.add_compound(compound, &options)?,
                None => scene.add_object(pieces, &options)?,
            });
            Ok(())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::{swiftprox_scene_create, swiftprox_scene_destroy, swiftprox_scene_set_pair_active};
    use super::*;
    use std::ptr::{null, null_mut};

    #[test]
    fn a_panic_in_the_making_of_a_shape_leaves_the_scene_usable() {
        let mut scene = null_mut();
        let mut id = ObjectId::from_bits(7);
        // SAFETY: a living scene, used by this thread only, and room for every output.
        unsafe {
            assert_eq!(swiftprox_scene_create(null(), &mut scene), StatusCode::Ok);
            let status = add(scene, null(), &mut id, || panic!("injected"));
            assert_eq!(status, StatusCode::ErrorBug);
            assert_eq!(id, ObjectId::NULL);
            assert_eq!(swiftprox_scene_set_pair_active(scene, null(), null(), 1), StatusCode::Ok);
            assert_eq!(swiftprox_scene_destroy(scene), StatusCode::Ok);
        }
    }
}
