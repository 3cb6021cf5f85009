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

/// Objects that a question is about.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CObjectSet {
    /// Which, in any order.
    pub ids: *const ObjectId,
    /// How many.
    pub count: usize,
    /// 12 doubles for each object: where it is for this question. Null: where the scene has it.
    pub poses: *const f64,
    /// Not 0: pairs of two objects of the set are asked about, too.
    pub among: i32,
}

/// What a ray met in a scene.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CSceneRayAnswer {
    /// In order of where the ray comes in. Owned by the scratch and valid until its next use. Null when count is 0.
    pub hits: *const SceneRayHit,
    /// How many.
    pub count: usize,
}

impl CSceneRayAnswer {
    const EMPTY: CSceneRayAnswer = CSceneRayAnswer { hits: std::ptr::null(), count: 0 };
}

/// Makes room to work in for questions that threads ask a scene at once: about sets of objects, and of rays, grounds and
/// half-spaces. The caller owns it and gives it back with swiftprox_scratch_destroy. One thread at a time uses it, for any scenes.
/// Of sets it keeps what pairs of objects remember, which changes how fast an answer comes and which of several nearest points it
/// gives, never a verdict: where bits matter, take a new one. Rays, grounds and half-spaces remember nothing: whatever it has seen,
/// they are answered bit for bit as with a new one. On failure `*scratch` is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scratch_create(scratch: *mut *mut SetScratch) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        output(scratch, "scratch", std::ptr::null_mut())?;
        scratch.write(Box::into_raw(Box::default()));
        Ok(())
    })
}

/// Gives back what swiftprox_scratch_create made, and what it owns. Null is ignored.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scratch_destroy(scratch: *mut SetScratch) {
    if !scratch.is_null() {
        // SAFETY: the header's pointer rules; every one comes from Box::into_raw.
        drop(unsafe { Box::from_raw(scratch) });
    }
}

/// Makes questions about sets fast after objects were moved, added or removed: they find what is near by the trees of the broad
/// phase, which this brings up to date. It changes no answer. Without it they go through what has changed one by one, and through
/// all pieces if many have.
///
/// SWIFTPROX_ERROR_MEMORY: questions take longer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_prepare(scene: *mut SceneHandle) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe { change(scene, |scene| Ok(scene.prepare()?)) }
}

/// The least distance between two sets of objects, or between a set and all other objects (against is null), with its interval and
/// a pair that has it. Of sets farther apart than cut_off (infinity: none are) no more than that is said.
///
/// Pairs are those that queries test: activation, groups and the filter are heeded. Two fixed objects are left out, unless one of
/// the sets has poses. Any number of threads may ask a scene at once that nobody changes, each with its own scratch; a null scratch
/// is made for the call.
///
/// On failure the answer's numbers are NaN. SWIFTPROX_ERROR_INVALID_ARGUMENT: cut_off is negative or NaN. SWIFTPROX_ERROR_BUSY: the
/// scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER,
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_least_distance(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    against: *const CObjectSet,
    cut_off: f64,
    scratch: *mut SetScratch,
    answer: *mut LeastDistance,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask(scene, set, scratch, answer, LeastDistance::default(), |scene, set, scratch| {
            let against = against.as_ref().map(|against| read_set(against)).transpose()?;
            Ok(scene.least_distance(&set, against.as_ref(), cut_off, scratch)?)
        })
    }
}

/// At which of many times a set of objects is no farther from something than margin: all other objects, and if set->among is not 0
/// one another. poses are 12 doubles for each object at the first time, then at the second, and so on; set->poses is not looked at,
/// nor are poses of times that are not tried. Pairs are those that queries test; both may be fixed. Threads and scratch as of
/// swiftprox_scene_least_distance.
///
/// On failure nothing is said: time and tried are 0, the pair's ids null. Errors as of swiftprox_scene_least_distance;
/// SWIFTPROX_ERROR_INVALID_ARGUMENT also for an empty set, an unknown order, and a margin that is negative, infinite or NaN.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_first_hit(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    poses: *const f64,
    time_count: usize,
    order: PoseOrderNumber,
    margin: f64,
    scratch: *mut SetScratch,
    answer: *mut FirstHit,
) -> StatusCode {
    // SAFETY: the header's pointer rules; a pose is twelve doubles, row by row, as is `Pose`.
    unsafe {
        ask(scene, set, scratch, answer, FirstHit::default(), |scene, set, scratch| {
            let order = read_enumerator(order, "order", "swiftprox_pose_order")?;
            let poses = array(poses.cast::<Pose>(), time_count.saturating_mul(set.ids.len()), "poses")?;
            Ok(scene.first_hit(&set, poses, order, margin, scratch)?)
        })
    }
}

/// What a ray meets of the objects whose groups have a bit of mask (UINT32_MAX: all in some group): the first convex piece, all in
/// order, or any, found soonest. Each as swiftprox_shape_cast_ray has it; pieces that are met at one place, as far as doubles tell,
/// are in order of creation. Threads as of swiftprox_scene_least_distance; the scratch owns the hits and must not be null.
///
/// On failure the answer is empty. SWIFTPROX_ERROR_INVALID_ARGUMENT: the ray is refused as by swiftprox_shape_cast_ray, or hits is
/// unknown. SWIFTPROX_ERROR_BUSY: the scene is being changed. SWIFTPROX_ERROR_MEMORY, SWIFTPROX_ERROR_NULL_POINTER,
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

/// Whether moving objects stay farther than config->margin from all others, which rest, or when they first do not: certain at all
/// times of the range, as swiftprox_pair_cast is. One motion moves all objects of the set as one body, else each has its own;
/// pieces with poses of their own move with their object. Pairs of two of them are asked about if set->among is not 0; set->poses
/// is not looked at. Pairs are those that queries test; both may be fixed. config->step_budget is that of each pair; config may be
/// null for the defaults. Threads and scratch as of swiftprox_scene_least_distance.
///
/// On failure the answer is reset: its outcome is SWIFTPROX_CAST_OUTCOME_NONE. SWIFTPROX_ERROR_INVALID_ARGUMENT: motion_count is
/// neither 1 nor set->count, or as of swiftprox_pair_cast. SWIFTPROX_ERROR_BUSY: the scene is being changed. Others as of
/// swiftprox_pair_cast, and SWIFTPROX_ERROR_MEMORY,
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_cast(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    motions: *const CMotion,
    motion_count: usize,
    config: *const CCastConfig,
    scratch: *mut SetScratch,
    answer: *mut SceneCastAnswer,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    unsafe {
        ask(scene, set, scratch, answer, SceneCastAnswer::default(), |scene, set, scratch| {
            let config = cast_config(config)?;
            with_motions(array(motions, motion_count, "motions")?, |motions| {
                Ok(scene.cast(&set, motions, &config, scratch)?)
            })
        })
    }
}

/// swiftprox_scene_cast of many edges: answers has room for edge_count. The motions of the edges stand one behind the other: one
/// for each edge, or one for each object of the set at each edge. An edge is valid up to its answer's t_lo.
///
/// SWIFTPROX_ERROR_INVALID_ARGUMENT: motion_count is neither edge_count nor that times set->count. Others as of
/// swiftprox_scene_cast; the message names the edge, and that and all edges behind it have answers that are reset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_scene_cast_batch(
    scene: *const SceneHandle,
    set: *const CObjectSet,
    motions: *const CMotion,
    motion_count: usize,
    config: *const CCastConfig,
    scratch: *mut SetScratch,
    answers: *mut SceneCastAnswer,
    edge_count: usize,
) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe {
        array(answers.cast_const(), edge_count, "answers")?;
        (0..edge_count).for_each(|k| answers.add(k).write(SceneCastAnswer::default()));
        let answers = if edge_count == 0 { &mut [] } else { std::slice::from_raw_parts_mut(answers, edge_count) };
        look(scene, |scene| {
            let (set, config) = (read_set(input(set, "set")?)?, cast_config(config)?);
            let mut own = SetScratch::default();
            let scratch = scratch.as_mut().unwrap_or(&mut own);
            with_motions(array(motions, motion_count, "motions")?, |motions| {
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
