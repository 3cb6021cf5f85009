//! Questions about sets of objects, which threads may ask one scene at once.

use super::enumerators::{PoseOrderNumber, RayHitsNumber, read_enumerator};
use super::failure::{Checked, StatusCode};
use super::guard::guard;
use super::motion::{CCastConfig, CMotion, cast_config, with_motions};
use super::pointers::{array, exclusive, input, output};
use super::scene::{SceneHandle, change, look};
use crate::base::math::Pose;
use crate::ray::Ray;
use crate::scene::object::ObjectId;
use crate::scene::{FirstHit, LeastDistance, ObjectSet, Scene, SceneCastAnswer, SceneRayHit, SetScratch};

/// A set of objects for a query.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CObjectSet {
    /// Their ids, in any order.
    pub ids: *const ObjectId,
    /// Number of objects.
    pub count: usize,
    /// 12 doubles per object: its pose for this query. Null: the scene's poses.
    pub poses: *const f64,
    /// Not 0: pairs within the set are tested, too.
    pub among: i32,
}

/// The hits of a ray in a scene.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneRayAnswer {
    /// Hits in order of entry along the ray. Owned by the scratch and valid until its next use. Null if count is 0.
    pub hits: *const SceneRayHit,
    /// Number of hits.
    pub count: usize,
}

impl CSceneRayAnswer {
    const EMPTY: CSceneRayAnswer = CSceneRayAnswer { hits: std::ptr::null(), count: 0 };
}

/// Creates working memory for concurrent queries of object sets, rays, grounds and half-spaces. The caller owns it and frees it
/// with swiftprox_scratch_destroy. It serves one thread at a time, and any scenes. On failure `*scratch` is null.
///
/// For sets it keeps caches of pairs, which affect speed and the choice among several nearest points, or among several pairs that
/// hit at one time, never a verdict. Where bits matter, use a new scratch. Rays, grounds and half-spaces use no cache; a used
/// scratch gives the same bits as a new one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scratch_create(scratch: *mut *mut SetScratch) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(scratch, "scratch", std::ptr::null_mut())?;
        scratch.write(Box::into_raw(Box::default()));
        Ok(())
    })
}

/// Frees a scratch and the results it owns. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scratch_destroy(scratch: *mut SetScratch) {
    if !scratch.is_null() {
        // SAFETY: the header's pointer rules; every one comes from Box::into_raw.
        drop(unsafe { Box::from_raw(scratch) });
    }
}

/// Updates the broad phase after objects were moved, added or removed, so that queries of sets are fast. It changes no answer.
/// Without it, such queries test changed pieces one by one, or all pieces if many have changed.
///
/// SWIFTPROX_ERROR_MEMORY: such queries take longer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_prepare(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.prepare()?)) }
}

/// Returns the least distance between two sets, with its interval and a nearest pair. Null `against` means all other objects. For
/// sets farther apart than max_distance the answer says only that; infinity means no limit. Only pairs that queries test count:
/// activation, groups and the filter are respected. Two fixed objects are skipped, unless one of the sets has poses.
///
/// Any number of threads may query a scene that no call changes, each with its own scratch. A null scratch means a temporary one.
/// On failure the answer's numbers are NaN. SWIFTPROX_ERROR_INVALID_ARGUMENT: max_distance is negative or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_least_distance(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    against: *const CObjectSet,
    max_distance: f64,
    scratch: *mut SetScratch,
    answer: *mut LeastDistance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask(scene, set, scratch, answer, LeastDistance::default(), |scene, set, scratch| {
            let against = against.as_ref().map(|against| read_set(against)).transpose()?;
            Ok(scene.least_distance(&set, against.as_ref(), max_distance, scratch)?)
        })
    }
}

/// Poses of a set of objects at many times, an argument by value. Only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPath {
    /// 12 doubles per object for the first time, then for the second, and so on.
    pub poses: *const f64,
    /// Number of times.
    pub time_count: usize,
    /// The order in which times are tried.
    pub order: PoseOrderNumber,
}

/// Finds a time at which a set of objects is within max_distance of any other object, or of one another if set->among is not 0.
/// A pair that a deviation leaves undecided is one, too. set->poses and poses of untried times are not read. Only pairs that
/// queries test count, but both objects may be fixed. Threads and scratch: as for swiftprox_scene_least_distance.
///
/// On failure time and tried are 0, the pair's ids null. SWIFTPROX_ERROR_INVALID_ARGUMENT: an empty set, an unknown order, or
/// max_distance is negative, infinite or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_first_hit(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    path: CPath,
    max_distance: f64,
    scratch: *mut SetScratch,
    answer: *mut FirstHit,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        ask(scene, set, scratch, answer, FirstHit::default(), |scene, set, scratch| {
            let order = read_enumerator(path.order, "path.order", "swiftprox_pose_order")?;
            let poses = array(path.poses.cast::<Pose>(), path.time_count.saturating_mul(set.ids.len()), "path.poses")?;
            Ok(scene.first_hit(&set, poses, order, max_distance, scratch)?)
        })
    }
}

/// Finds convex pieces and grounds that a ray meets, of objects whose groups have a bit of mask (UINT32_MAX: any group). `hits`
/// selects the first, all in order, or any, found soonest. Each hit is as from swiftprox_shape_cast_ray, or once for each ground as
/// from swiftprox_ground_cast_ray. Hits at the same place are in order of creation. Threads: as for swiftprox_scene_least_distance.
/// The scratch owns the hits and must not be null.
///
/// On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: a ray that swiftprox_shape_cast_ray refuses, or unknown hits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_cast_ray(
    scene: *const SceneHandle,
    ray: *const Ray,
    hits: RayHitsNumber,
    mask: u32,
    scratch: *mut SetScratch,
    answer: *mut CSceneRayAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(answer, "answer", CSceneRayAnswer::EMPTY)?;
        look(scene, |scene| {
            let (ray, scratch) = (input(ray, "ray")?, exclusive(scratch, "scratch")?);
            let wanted = read_enumerator(hits, "hits", "swiftprox_ray_hits")?;
            let met = scene.cast_ray(ray, wanted, mask, scratch)?;
            let hits = if met.is_empty() { std::ptr::null() } else { met.as_ptr() };
            answer.write(CSceneRayAnswer { hits, count: met.len() });
            Ok(())
        })
    })
}

/// Motions of a set of objects over one or many edges, an argument by value. Only read during the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CMotions {
    /// Edge after edge, either one motion, which moves the whole set as one body, or one for each object of the set.
    pub motions: *const CMotion,
    /// Number of motions.
    pub count: usize,
    /// Number of edges, and of answers; 1 for one cast.
    pub edge_count: usize,
}

/// Tests whether moving objects stay farther than config->max_distance from all others, which rest. If not, it finds the first
/// time. The answer is guaranteed for all times of the range, as in swiftprox_pair_cast. Each edge has an answer and is free up to
/// its time_lower. set->among not 0 adds pairs within the set; set->poses is not read.
///
/// Only pairs that queries test count, but both objects may be fixed. config->step_budget applies per pair. Threads and scratch: as
/// for swiftprox_scene_least_distance.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: the number of motions is neither edge_count nor edge_count times set->count; the set has a
/// ground, or config->ignores_parting is set and a body comes near one. Else same errors as swiftprox_pair_cast. The message names
/// the edge; its answer and all later ones are SWIFTPROX_CAST_OUTCOME_NONE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_cast(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    motions: CMotions,
    config: *const CCastConfig,
    scratch: *mut SetScratch,
    answers: *mut SceneCastAnswer,
) -> StatusCode {
    let CMotions { motions, count, edge_count } = motions;
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        array(answers.cast_const(), edge_count, "answers")?;
        (0..edge_count).for_each(|k| answers.add(k).write(SceneCastAnswer::default()));
        let answers = if edge_count == 0 { &mut [] } else { std::slice::from_raw_parts_mut(answers, edge_count) };
        look(scene, |scene| {
            let (set, config) = (read_set(input(set, "set")?)?, cast_config(config)?);
            let mut own = SetScratch::default();
            let scratch = scratch.as_mut().unwrap_or(&mut own);
            with_motions(array(motions, count, "motions.motions")?, |motions| {
                Ok(scene.cast_batch(&set, motions, &config, scratch, answers)?)
            })
        })
    })
}

/// Asks a scene about a set, and writes what it says; `unsaid` where it fails.
///
/// # Safety
/// The pointers meet the header's pointer rules.
unsafe fn ask<A: Copy>(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    scratch: *mut SetScratch,
    answer: *mut A,
    unsaid: A,
    run: impl FnOnce(&Scene, ObjectSet, &mut SetScratch) -> Checked<A>,
) -> StatusCode {
    // SAFETY: by the caller.
    guard(|| unsafe {
        output(answer, "answer", unsaid)?;
        look(scene, |scene| {
            let mut own = SetScratch::default();
            let said = run(scene, read_set(input(set, "set")?)?, scratch.as_mut().unwrap_or(&mut own))?;
            answer.write(said);
            Ok(())
        })
    })
}

/// A set, in Rust's terms.
///
/// # Safety
/// Its pointers meet the header's pointer rules for `'a`.
pub(super) unsafe fn read_set<'a>(set: &CObjectSet) -> Checked<ObjectSet<'a>> {
    // SAFETY: by the caller; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        let poses = match set.poses.is_null() {
            true => None,
            false => Some(array(set.poses.cast::<Pose>(), set.count, "set->poses")?),
        };
        Ok(ObjectSet { ids: array(set.ids, set.count, "set->ids")?, poses, among: set.among != 0 })
    }
}
