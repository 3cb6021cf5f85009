//! Where objects of a scene meet a ground or a half-space, which threads may ask at once.

use super::depth::{CManifoldConfig, read_manifold_config};
use super::failure::{Checked, StatusCode};
use super::guard::guard;
use super::object_set::{CObjectSet, read_set};
use super::pointers::{exclusive, input, output};
use super::scene::{SceneHandle, look};
use crate::base::math::Pose;
use crate::ground::Ground;
use crate::pair::{HalfSpace, ManifoldConfig, ManifoldPoint};
use crate::scene::{GroupFilter, ObjectSet, Scene, SceneGroundContact, SceneGroundContacts, SetScratch};

/// Where objects of a scene meet a ground or a half-space. Owned by the scratch and valid until its next use.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneGroundAnswer {
    /// By object, piece and triangle. Null when contact_count is 0.
    pub contacts: *const SceneGroundContact,
    /// How many.
    pub contact_count: usize,
    /// Points of contact c are those from its contact.first_point on, as many as its contact.manifold.point_count. Null when
    /// point_count is 0.
    pub points: *const ManifoldPoint,
    /// How many.
    pub point_count: usize,
}

impl CSceneGroundAnswer {
    const EMPTY: CSceneGroundAnswer =
        CSceneGroundAnswer { contacts: std::ptr::null(), contact_count: 0, points: std::ptr::null(), point_count: 0 };
}

/// Where objects of a scene meet a ground that is in no scene, or are up to config->margin apart from it: piece by piece what
/// swiftprox_pair_ground_contacts says. set is who is asked; null: all objects, in order of creation. An object is asked if its
/// groups have a bit of filter->mask and its mask has a bit of filter->groups; a null filter has group 1 and all bits in its mask.
/// Activation and the scene's filter are about pairs of objects, and do not count. Fixed objects are left out, unless set->poses
/// says where they are; set->among is not looked at. config->rotation_limit is for the ground's pose. Threads as of
/// swiftprox_scene_least_distance; the scratch owns contacts and points and must not be null. Once it is large enough, only
/// integer arithmetic asks for memory.
///
/// On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT, SWIFTPROX_ERROR_STRUCT_SIZE: as of swiftprox_pair_manifold.
/// SWIFTPROX_ERROR_BUSY: the scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER,
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_ground_contacts(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    ground: *const Ground,
    ground_pose: *const f64,
    config: *const CManifoldConfig,
    filter: *const GroupFilter,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
) -> StatusCode {
    let asked = Asked { scene, set, config, filter, scratch, answer };
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        asked.answer(|scene, set, config, filter, scratch| {
            let (ground, place) = (input(ground, "ground")?, input(ground_pose.cast::<Pose>(), "ground_pose")?);
            Ok(scene.ground_contacts(set, ground.at(place), config, filter, scratch)?)
        })
    }
}

/// The same of a half-space: a contact for each piece that is within the margin, as swiftprox_pair_half_space_manifold says; its
/// triangle is UINT32_MAX. Errors as of swiftprox_scene_ground_contacts; SWIFTPROX_ERROR_INVALID_ARGUMENT also as of
/// swiftprox_pair_half_space_distance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_half_space_contacts(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    half_space: *const HalfSpace,
    config: *const CManifoldConfig,
    filter: *const GroupFilter,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
) -> StatusCode {
    let asked = Asked { scene, set, config, filter, scratch, answer };
    // SAFETY: the header's pointer rules.
    unsafe {
        asked.answer(|scene, set, config, filter, scratch| {
            Ok(scene.half_space_contacts(set, input(half_space, "half_space")?, config, filter, scratch)?)
        })
    }
}

/// What both are given.
struct Asked {
    scene: *const SceneHandle,
    set: *const CObjectSet,
    config: *const CManifoldConfig,
    filter: *const GroupFilter,
    scratch: *mut SetScratch,
    answer: *mut CSceneGroundAnswer,
}

impl Asked {
    /// Asks a scene, and writes what it says; nothing where it fails.
    ///
    /// # Safety
    /// The pointers meet the header's pointer rules.
    unsafe fn answer(
        self,
        find: impl for<'a> FnOnce(
            &Scene,
            Option<&ObjectSet>,
            &ManifoldConfig,
            GroupFilter,
            &'a mut SetScratch,
        ) -> Checked<SceneGroundContacts<'a>>,
    ) -> StatusCode {
        // SAFETY: by the caller.
        guard(|| unsafe {
            output(self.answer, "answer", CSceneGroundAnswer::EMPTY)?;
            look(self.scene, |scene| {
                let set = self.set.as_ref().map(|set| read_set(set)).transpose()?;
                let config = read_manifold_config(self.config)?;
                let filter = self.filter.as_ref().copied().unwrap_or_default();
                let scratch = exclusive(self.scratch, "scratch")?;
                let SceneGroundContacts { contacts, points } = find(scene, set.as_ref(), &config, filter, scratch)?;
                self.answer.write(CSceneGroundAnswer {
                    contacts: if contacts.is_empty() { std::ptr::null() } else { contacts.as_ptr() },
                    contact_count: contacts.len(),
                    points: if points.is_empty() { std::ptr::null() } else { points.as_ptr() },
                    point_count: points.len(),
                });
                Ok(())
            })
        })
    }
}
