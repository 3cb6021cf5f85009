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

/// Contacts of objects of a scene with a ground or a half-space. Owned by the scratch and valid until its next use.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneGroundAnswer {
    /// Sorted by object, piece and triangle. Null if contact_count is 0.
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

/// Finds the contacts of objects of a scene with a ground (grounds belong to no scene), up to config->max_distance apart. Contacts
/// of each piece are as from swiftprox_pair_ground_contacts. Null set: all objects, in order of creation. Fixed objects are
/// skipped, unless set->poses gives their poses; set->among is not read.
///
/// An object is tested if its groups have a bit of filter->mask, and its mask a bit of filter->groups. A null filter means group 1
/// and a full mask. Activation and the scene's pair filter do not apply. config->rotation_limit is for the ground's pose.
///
/// Threads: as for swiftprox_scene_least_distance. The scratch owns the results and must not be null. Once it is large enough, only
/// integer arithmetic allocates. On failure the answer is empty. Same errors as swiftprox_pair_manifold.
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

/// Like swiftprox_scene_ground_contacts for a half-space: one contact for each piece within max_distance, as from
/// swiftprox_pair_half_space_manifold. Its triangle is UINT32_MAX. Same errors as swiftprox_scene_ground_contacts and
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
