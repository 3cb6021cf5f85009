//! Contacts of a scene's objects with a ground or a half-space; threads may ask at once.

use super::failure::{Checked, Failure, StatusCode};
use super::ground::{CPlacedGround, read_placed};
use super::guard::guard;
use super::object_set::{CObjectSet, read_set};
use super::pointers::{exclusive, input, output};
use super::scene::{SceneHandle, look};
use super::structs::{Versioned, read_struct};
use crate::ground::PlacedGround;
use crate::manifold::{ManifoldConfig, ManifoldPoint};
use crate::pair::HalfSpace;
use crate::scene::{GroupFilter, SceneGroundContact, SceneGroundContacts, SetScratch};

/// Contacts of objects of a scene with a ground or a half-space. Owned by the scratch and valid until its next use.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneGroundAnswer {
    /// Sorted by object, piece, ground and triangle. Null if contact_count is 0.
    pub contacts: *const SceneGroundContact,
    /// Number of contacts.
    pub contact_count: usize,
    /// Points of contact c begin at its contact.first_point; there are contact.manifold.point_count. Null if point_count is 0.
    pub points: *const ManifoldPoint,
    /// Number of points.
    pub point_count: usize,
}

impl CSceneGroundAnswer {
    const EMPTY: CSceneGroundAnswer =
        CSceneGroundAnswer { contacts: std::ptr::null(), contact_count: 0, points: std::ptr::null(), point_count: 0 };
}

/// Options of a scene's contacts with a ground or a half-space. Initialise with SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneGroundConfig {
    /// Set by SWIFTPROX_SCENE_GROUND_CONFIG_DEFAULT.
    pub struct_size: usize,
    /// Largest gap of objects that have contacts, and of their points: from 0 (the default) to infinity.
    pub max_distance: f64,
    /// Not 0: at most four points stay on each side of a body (swiftprox_pair_ground_contacts). Default: 0.
    pub reduces: i32,
    /// The ground's groups, one bit each. An object is tested if its mask has a bit of them. Default: 0, which means the first, 1.
    /// Grounds of the scene have their own.
    pub groups: u32,
    /// An object is tested if its groups have a bit of this. Default: 0, which means all.
    pub mask: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CSceneGroundConfig {
    const NAME: &'static str = "swiftprox_scene_ground_config";
}

impl CSceneGroundConfig {
    /// The defaults, as in the header.
    pub const DEFAULT: CSceneGroundConfig = CSceneGroundConfig {
        struct_size: size_of::<CSceneGroundConfig>(),
        max_distance: 0.0,
        reduces: 0,
        groups: 0,
        mask: 0,
    };
}

/// Finds the contacts of objects of a scene with grounds, up to config->max_distance apart. Contacts of each piece are as from
/// swiftprox_pair_ground_contacts. Null set: all objects, in order of creation. Fixed objects are skipped, unless set->poses gives
/// their poses; set->among is not read.
///
/// If ground.ground and ground.pose are null, the grounds are the objects of the scene that are grounds, and the pairs those that
/// queries test. Else it is one that is in no scene: activation and the scene's pair filter do not apply.
///
/// Threads: as for swiftprox_scene_least_distance. The scratch owns the results and must not be null. Once it is large enough, only
/// integer arithmetic allocates. On failure the answer is empty. Same errors as swiftprox_pair_manifold.
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: also for a ground in the set, and for groups or a mask without a ground.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_ground_contacts(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    ground: CPlacedGround,
    config: *const CSceneGroundConfig,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        let is_of_scene = ground.ground.is_null() && ground.pose.is_null();
        let floor = || if is_of_scene { Ok(FloorInput::OfScene) } else { Ok(FloorInput::Ground(read_placed(ground)?)) };
        find(scene, set, floor, config, scratch, answer)
    }
}

/// Like swiftprox_scene_ground_contacts for a half-space: one contact for each piece within config->max_distance, as from
/// swiftprox_pair_half_space_manifold. Its triangle is UINT32_MAX. Same errors as swiftprox_scene_ground_contacts and
/// swiftprox_pair_half_space_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_half_space_contacts(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    half_space: *const HalfSpace,
    config: *const CSceneGroundConfig,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { find(scene, set, || Ok(FloorInput::HalfSpace(input(half_space, "half_space")?)), config, scratch, answer) }
}

/// Asks a scene, and writes its contacts with what `floor` reads; none where it fails.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn find<'a>(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    floor: impl FnOnce() -> Checked<FloorInput<'a>>,
    config: *const CSceneGroundConfig,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
) -> StatusCode {
    // SAFETY: by the caller.
    guard(|| unsafe {
        output(answer, "answer", CSceneGroundAnswer::EMPTY)?;
        look(scene, |scene| {
            let set = set.as_ref().map(|set| read_set(set)).transpose()?;
            let CSceneGroundConfig { max_distance, reduces, groups, mask, .. } =
                read_struct(config, CSceneGroundConfig::DEFAULT)?;
            let config = ManifoldConfig { max_distance, reduces: reduces != 0 };
            let filter = GroupFilter {
                groups: if groups == 0 { 1 } else { groups },
                mask: if mask == 0 { u32::MAX } else { mask },
            };
            let (scratch, set) = (exclusive(scratch, "scratch")?, set.as_ref());
            let SceneGroundContacts { contacts, points } = match floor()? {
                FloorInput::OfScene if groups != 0 || mask != 0 => {
                    let message = "config->groups and mask are those of a ground in no scene: leave them 0, the scene's grounds \
                                   have their own";
                    return Err(Failure::new(StatusCode::ErrorInvalidArgument, message));
                }
                FloorInput::OfScene => scene.own_ground_contacts(set, &config, scratch)?,
                FloorInput::Ground(ground) => scene.ground_contacts(set, ground, &config, filter, scratch)?,
                FloorInput::HalfSpace(half_space) => {
                    scene.half_space_contacts(set, half_space, &config, filter, scratch)?
                }
            };
            answer.write(CSceneGroundAnswer {
                contacts: if contacts.is_empty() { std::ptr::null() } else { contacts.as_ptr() },
                contact_count: contacts.len(),
                points: if points.is_empty() { std::ptr::null() } else { points.as_ptr() },
                point_count: points.len(),
            });
            Ok(())
        })
    })
}

/// The grounds or the half-space that objects may meet.
enum FloorInput<'a> {
    /// Those of the scene.
    OfScene,
    Ground(PlacedGround<'a>),
    HalfSpace(&'a HalfSpace),
}
