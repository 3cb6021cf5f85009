//! Calls about scenes.

use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::filter::*;
use swiftprox::ffi::object::*;
use swiftprox::ffi::object_query::*;
use swiftprox::ffi::pair::CPlaced;
use swiftprox::ffi::pose::*;
use swiftprox::ffi::query::*;
use swiftprox::ffi::scene::*;
use swiftprox::ffi::shape::swiftprox_shape_retain;
use swiftprox::ffi::tuning::*;
use swiftprox::object::ObjectId;
use swiftprox::pair::Outcome;
use swiftprox::scene::{PairResult, SceneStatistics};
use swiftprox::shape::Shape;

use super::arguments::{Block, any_pose, array, options, or_null, start};
use super::model::{Object, Scene, refuses};
use super::{MOST_OBJECTS, MOST_SCENES, MOST_SHAPES, Program, check_verified, last_message};
use crate::geometry::{any_number, inside};

impl Program {
    pub fn create_or_destroy_scene(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        if u.ratio(1, 3)? && !self.scenes.is_empty() {
            let scene = self.scenes.remove(u.choose_index(self.scenes.len())?);
            self.old_ids.extend(scene.objects.iter().map(|object| object.id));
            // SAFETY: a living scene that is not used again.
            return Ok(unsafe { swiftprox_scene_destroy(scene.handle) });
        }
        let value: CSceneOptions = CSceneOptions::DEFAULT;
        let options = options(u, &value, &[])?;
        let mut handle = null_mut();
        // SAFETY: as large as it says or null, and room for the scene.
        let status = unsafe { swiftprox_scene_create(start(&options), &mut handle) };
        assert_eq!(status == StatusCode::Ok, !handle.is_null());
        if !handle.is_null() {
            if self.scenes.len() < MOST_SCENES {
                self.scenes.push(Scene::new(handle));
            } else {
                // Made and never used.
                // SAFETY: a living scene that is not used again.
                assert_eq!(unsafe { swiftprox_scene_destroy(handle) }, StatusCode::Ok);
            }
        }
        Ok(status)
    }

    /// One of the scenes, made if there is not one yet.
    pub fn scene(&mut self, u: &mut Unstructured) -> Result<usize> {
        if self.scenes.is_empty() {
            let mut handle = null_mut();
            // SAFETY: room for the scene.
            assert_eq!(unsafe { swiftprox_scene_create(null(), &mut handle) }, StatusCode::Ok);
            self.scenes.push(Scene::new(handle));
        }
        u.choose_index(self.scenes.len())
    }

    /// An id that names an object of the scene, most of the time.
    fn id(&self, u: &mut Unstructured, scene: usize) -> Result<ObjectId> {
        let objects = &self.scenes[scene].objects;
        Ok(match u.int_in_range(0..=15)? {
            0 => ObjectId::NULL,
            1 => ObjectId::from_bits(u.arbitrary()?),
            2 if !self.old_ids.is_empty() => *u.choose(&self.old_ids)?,
            3 => {
                let other = u.choose(&self.scenes)?;
                other.objects.last().map_or(ObjectId::NULL, |object| object.id)
            }
            _ if !objects.is_empty() => objects[u.choose_index(objects.len())?].id,
            _ => ObjectId::NULL,
        })
    }

    pub fn add_object(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let (handle, user_data) = (self.scenes[place].handle, u.arbitrary::<u64>()?);
        let fixed = u.ratio(1, 4)?;
        let mut value: CObjectOptions = CObjectOptions::DEFAULT;
        (value.user_data, value.fixed) = (user_data, i32::from(fixed));
        (value.groups, value.mask) = (u.int_in_range(0..=3)?, u.int_in_range(0..=3)?);
        // SAFETY: twelve doubles.
        value.pose = unsafe { any_pose(u)?.at::<[f64; 12]>().read() };
        let given = options(u, &value, &[])?;
        let mut id = ObjectId::from_bits(u64::MAX);
        let mut pieces = Vec::new();
        // SAFETY: living shapes, blocks as large as they say, or null.
        let status = unsafe {
            for _ in 0..u.int_in_range(0..=3)? {
                pieces.push(self.shape(u)?);
            }
            let block = Block::of(&pieces);
            let (array, count) = array(u, block.at::<*const Shape>(), pieces.len())?;
            pieces.truncate(count);
            swiftprox_scene_add_object(handle, array, count, start(&given), &mut id)
        };
        assert_eq!(status == StatusCode::Ok, id != ObjectId::NULL, "{}", last_message());
        if status == StatusCode::Ok {
            self.learn(place, id, pieces.len());
            if self.scenes[place].objects.len() > MOST_OBJECTS {
                let oldest = self.scenes[place].objects[0].id;
                self.remove(place, oldest);
            }
        }
        Ok(status)
    }

    /// Takes a new object into the model, as the scene describes it.
    fn learn(&mut self, place: usize, id: ObjectId, pieces: usize) {
        let scene = &mut self.scenes[place];
        assert!(scene.find(id).is_none() && !self.old_ids.contains(&id), "an id twice");
        // SAFETY: zero is a value of every member; a living scene and room for the info.
        let info = unsafe {
            let mut info = std::mem::zeroed::<ObjectInfo>();
            info.struct_size = size_of::<ObjectInfo>();
            assert_eq!(swiftprox_scene_get_object_info(scene.handle, id, &mut info), StatusCode::Ok);
            info
        };
        assert_eq!(info.piece_count, pieces);
        let ObjectInfo { user_data, groups, mask, .. } = info;
        let object = Object { id, pieces, fixed: info.fixed != 0, user_data, groups, mask };
        scene.objects.push(object);
    }

    fn remove(&mut self, place: usize, id: ObjectId) -> StatusCode {
        let scene = &mut self.scenes[place];
        // SAFETY: a living scene.
        let status = unsafe { swiftprox_scene_remove_object(scene.handle, id) };
        match scene.find(id) {
            Some(found) => {
                assert_eq!(status, StatusCode::Ok);
                scene.objects.remove(found);
                self.old_ids.push(id);
            }
            None => assert_eq!(status, StatusCode::ErrorHandle),
        }
        status
    }

    pub fn change_objects(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let id = self.id(u, place)?;
        let found = self.scenes[place].find(id);
        let handle = self.scenes[place].handle;
        let status = match u.int_in_range(0..=2)? {
            0 => return Ok(self.remove(place, id)),
            1 => {
                let mut copy = id;
                // SAFETY: a living scene and room for the id.
                let status = unsafe { swiftprox_scene_copy_object(handle, id, &mut copy) };
                if let Some(found) = found {
                    assert_eq!(status, StatusCode::Ok);
                    let original = self.scenes[place].objects[found].clone();
                    self.learn(place, copy, original.pieces);
                    if self.scenes[place].objects.len() > MOST_OBJECTS {
                        self.remove(place, copy);
                    }
                }
                status
            }
            _ => {
                let user_data = u.arbitrary()?;
                if let Some(found) = found {
                    self.scenes[place].objects[found].user_data = user_data;
                }
                // SAFETY: a living scene.
                unsafe { changed(handle, id, |info| info.user_data = user_data) }
            }
        };
        assert_eq!(status, if found.is_some() { StatusCode::Ok } else { StatusCode::ErrorHandle });
        Ok(status)
    }

    pub fn look_at_object(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let id = self.id(u, place)?;
        let scene = &self.scenes[place];
        let found = scene.find(id).map(|found| &scene.objects[found]);
        // SAFETY: a living scene, a block as large as it says or null, room for the shape.
        unsafe {
            let mut valid = 7;
            assert_eq!(swiftprox_scene_is_object_valid(scene.handle, id, &mut valid), StatusCode::Ok);
            assert_eq!(valid, i32::from(found.is_some()));
            if u.arbitrary()? {
                let mut value = std::mem::zeroed::<ObjectInfo>();
                value.struct_size = size_of::<ObjectInfo>();
                let info = options(u, &value, &[])?;
                return Ok(swiftprox_scene_get_object_info(scene.handle, id, start(&info)));
            }
            let piece = u.int_in_range(0..=3)?;
            let mut shape = null();
            let status = swiftprox_scene_get_piece(scene.handle, id, piece, &mut shape);
            let expected = found.is_some_and(|object| piece < object.pieces);
            assert_eq!((status == StatusCode::Ok, !shape.is_null()), (expected, expected), "{}", last_message());
            if !shape.is_null() && self.shapes.len() < MOST_SHAPES {
                self.shapes.push(swiftprox_shape_retain(shape));
            }
            Ok(status)
        }
    }

    pub fn move_objects(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let id = self.id(u, place)?;
        let scene = &self.scenes[place];
        let moving = scene.objects.iter().filter(|object| !object.fixed).count();
        let mut count = moving;
        if u.ratio(1, 8)? {
            count = u.int_in_range(0..=MOST_OBJECTS)?;
        }
        // SAFETY: blocks of the sizes that the header names, or null, and a living scene.
        unsafe {
            let mut all: Vec<[f64; 12]> = Vec::new();
            for _ in 0..count.max(1) {
                all.push(any_pose(u)?.at::<[f64; 12]>().read());
            }
            let rotations: Vec<[f64; 9]> =
                all.iter().map(|p| std::array::from_fn(|k| p[4 * (k / 3) + k % 3])).collect();
            let translations: Vec<[f64; 3]> = all.iter().map(|p| std::array::from_fn(|k| p[4 * k + 3])).collect();
            Ok(match u.int_in_range(0..=3)? {
                0 => {
                    let pose = Block::of(&all[..1]);
                    swiftprox_scene_set_pose(scene.handle, id, or_null(u, pose.at())?)
                }
                1 => {
                    let (rotation, translation) = (Block::of(&rotations[..1]), Block::of(&translations[..1]));
                    swiftprox_scene_set_transform(scene.handle, id, or_null(u, rotation.at())?, translation.at())
                }
                2 => {
                    let poses = Block::of(&all[..count]);
                    swiftprox_scene_set_poses(scene.handle, null(), poses.at(), count)
                }
                _ => {
                    let (rotations, translations) = (Block::of(&rotations[..count]), Block::of(&translations[..count]));
                    swiftprox_scene_set_transforms(
                        scene.handle,
                        null(),
                        rotations.at(),
                        or_null(u, translations.at())?,
                        count,
                    )
                }
            })
        }
    }

    pub fn activate(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let (id1, id2, active) = (self.id(u, place)?, self.id(u, place)?, u.arbitrary::<bool>()?);
        let scene = &mut self.scenes[place];
        let (first, second) = (scene.find(id1), scene.find(id2));
        let both = [id1, id2];
        // SAFETY: a living scene and room for the answer.
        unsafe {
            Ok(match u.int_in_range(0..=3)? {
                0 => {
                    let status = swiftprox_scene_set_pair_active(scene.handle, &id1, &id2, i32::from(active));
                    assert_eq!(status == StatusCode::Ok, first.is_some() && second.is_some() && id1 != id2);
                    if status == StatusCode::Ok {
                        scene.activate(active, |a, b| both.contains(&a.id) && both.contains(&b.id));
                    }
                    status
                }
                1 => {
                    let status = swiftprox_scene_set_pair_active(scene.handle, &id1, null(), i32::from(active));
                    assert_eq!(status == StatusCode::Ok, first.is_some());
                    scene.activate(active, |a, b| a.id == id1 || b.id == id1);
                    status
                }
                2 => {
                    scene.activate(active, |_, _| true);
                    swiftprox_scene_set_pair_active(scene.handle, null(), null(), i32::from(active))
                }
                _ => {
                    let mut answer = 7;
                    let status = swiftprox_scene_get_pair_active(scene.handle, id1, id2, &mut answer);
                    let expected = match (first, second) {
                        (Some(i), Some(j)) if i != j => {
                            scene.is_active(&scene.objects[i.min(j)], &scene.objects[i.max(j)])
                        }
                        _ => false,
                    };
                    assert_eq!(answer, i32::from(expected), "{status:?}");
                    status
                }
            })
        }
    }

    pub fn scene_query(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let scene = &self.scenes[place];
        let mut value: CSceneQuery = CSceneQuery::DEFAULT;
        let mut last = 1.0;
        let tolerance = any_number(u, &mut last)?.to_ne_bytes();
        let levels = u.int_in_range(-1..=2_i32)?;
        let tuning = CPairTuning { levels, ..CPairTuning::DEFAULT };
        if levels != 0 {
            value.tuning = &tuning;
        }
        value.piece_pairs = u.int_in_range(-1..=2)?;
        let changes = [(std::mem::offset_of!(CSceneQuery, max_distance), &tolerance[..])];
        let is_plain: bool = u.arbitrary()?;
        let given = if is_plain { None } else { options(u, &value, &changes)? };
        let query = u.int_in_range(0..=2)?;
        let run =
            [swiftprox_scene_query_intersection, swiftprox_scene_query_distance, swiftprox_scene_query_contact][query];
        let block = Block::new(size_of::<CSceneAnswer>());
        let target = or_null(u, block.at::<CSceneAnswer>())?;
        let handle = or_null(u, scene.handle)?;
        // SAFETY: a living scene or null, blocks as large as they say; the results are the scene's until its next query.
        unsafe {
            let status = inside(self.environment, || run(handle, start(&given), target));
            if target.is_null() {
                return Ok(status);
            }
            let answer = target.read();
            assert_eq!(answer.pairs.is_null(), answer.count == 0);
            let listed: &[PairResult] =
                if answer.count == 0 { &[] } else { std::slice::from_raw_parts(answer.pairs, answer.count) };
            if handle.is_null() {
                assert_eq!((status, answer.count, answer.intersecting), (StatusCode::ErrorNullPointer, 0, 0));
                return Ok(status);
            }
            let key = |r: &PairResult| ([r.object1, r.object2], [r.piece1, r.piece2], [r.user_data1, r.user_data2]);
            let tested = scene.tested();
            // Of contacts only pairs that touch are listed by default.
            if is_plain && query == 1 {
                assert!(
                    listed.iter().map(key).eq(tested.iter().copied()),
                    "{} pairs of {}",
                    listed.len(),
                    tested.len()
                );
            } else {
                let mut rest = tested.iter();
                assert!(listed.iter().all(|result| rest.any(|pair| *pair == key(result))), "not as tested");
            }
            for result in listed.iter().filter(|result| result.answer.outcome != Outcome::None) {
                check_result(scene.handle, result);
            }
            Ok(status)
        }
    }

    /// What of an object decides which pairs are tested, and where its pieces are.
    pub fn change_one(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let id = self.id(u, place)?;
        let scene = &mut self.scenes[place];
        let found = scene.find(id);
        // SAFETY: a living scene, blocks of the sizes that the header names or null.
        let status = unsafe {
            match u.int_in_range(0..=3)? {
                0 => {
                    let fixed: bool = u.arbitrary()?;
                    if let Some(found) = found {
                        scene.objects[found].fixed = fixed;
                    }
                    changed(scene.handle, id, |info| info.fixed = i32::from(fixed))
                }
                1 => {
                    let (groups, mask) = (u.int_in_range(0..=3)?, u.int_in_range(0..=3)?);
                    if let Some(found) = found {
                        scene.objects[found].groups = if groups == 0 { 1 } else { groups };
                        scene.objects[found].mask = if mask == 0 { u32::MAX } else { mask };
                    }
                    changed(scene.handle, id, |info| (info.groups, info.mask) = (groups, mask))
                }
                2 => {
                    let (pose, piece) = (any_pose(u)?, u.int_in_range(0..=3)?);
                    return Ok(swiftprox_scene_set_piece_pose(scene.handle, id, piece, or_null(u, pose.at())?));
                }
                _ => {
                    let mut poses: Vec<[f64; 12]> = Vec::new();
                    for _ in 0..u.int_in_range(0..=3)? {
                        poses.push(any_pose(u)?.at::<[f64; 12]>().read());
                    }
                    let (ids, count) = (vec![id; poses.len()], poses.len());
                    let (ids, poses) = (Block::of(&ids), Block::of(&poses));
                    return Ok(swiftprox_scene_set_poses(scene.handle, or_null(u, ids.at())?, poses.at(), count));
                }
            }
        };
        assert_eq!(status, if found.is_some() { StatusCode::Ok } else { StatusCode::ErrorHandle });
        Ok(status)
    }

    /// The program's own word on which pairs are tested.
    pub fn choose_pairs(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let mut ids = Vec::new();
        for _ in 0..2 * u.int_in_range(0..=4)? {
            ids.push(self.id(u, place)?);
        }
        let scene = &mut self.scenes[place];
        // SAFETY: a living scene, a block of the ids; the callback takes any ids and its number.
        unsafe {
            Ok(match u.int_in_range(0..=2)? {
                0 => {
                    scene.refused = u.arbitrary::<bool>()?.then_some(u.int_in_range(0..=2)?);
                    let callback: PairFilterCallback = if scene.refused.is_some() { Some(says) } else { None };
                    let user = std::ptr::without_provenance_mut(scene.refused.unwrap_or_default() as usize);
                    swiftprox_scene_set_pair_filter(scene.handle, callback, user)
                }
                1 => {
                    scene.given = None;
                    swiftprox_scene_reset_pairs(scene.handle)
                }
                _ => {
                    let pairs: Vec<[ObjectId; 2]> = ids.as_chunks().0.to_vec();
                    let is_pair =
                        |[a, b]: &[ObjectId; 2]| a != b && scene.find(*a).is_some() && scene.find(*b).is_some();
                    let is_good = pairs.iter().all(is_pair);
                    let block = Block::of(&ids);
                    let status = swiftprox_scene_set_pairs(scene.handle, block.at(), pairs.len());
                    assert_eq!(status == StatusCode::Ok, is_good, "{}", last_message());
                    if is_good {
                        scene.given = Some(pairs);
                    }
                    status
                }
            })
        }
    }

    /// What is near one object, or a shape put somewhere, and what has changed.
    pub fn near_query(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let (id, shape) = (self.id(u, place)?, self.shape(u)?);
        let scene = &self.scenes[place];
        let mut value: CSceneQuery = CSceneQuery::DEFAULT;
        let mut last = 1.0;
        value.max_distance = any_number(u, &mut last)?;
        value.piece_pairs = u.int_in_range(-1..=2)?;
        let given = options(u, &value, &[])?;
        let kind = u.int_in_range(-1..=4_i32)?;
        let pose = any_pose(u)?;
        // SAFETY: a living scene, a living shape or null, blocks of the sizes that the header names.
        unsafe {
            let mut answer = std::mem::zeroed::<CSceneAnswer>();
            let status = match u.int_in_range(0..=2)? {
                0 => swiftprox_scene_query_object(scene.handle, id, kind, start(&given), &mut answer),
                1 => swiftprox_scene_query_placed(
                    scene.handle,
                    &CPlaced { shape, pose: pose.at() },
                    1,
                    kind,
                    start(&given),
                    &mut answer,
                ),
                _ => {
                    let mut events = std::mem::zeroed::<CSceneEvents>();
                    let status = swiftprox_scene_query_events(scene.handle, value.max_distance, &mut events);
                    assert_eq!(events.began.is_null(), events.began_count == 0);
                    assert_eq!(events.ended.is_null(), events.ended_count == 0);
                    return Ok(status);
                }
            };
            assert_eq!(answer.pairs.is_null(), answer.count == 0);
            for k in 0..answer.count {
                let result = &*answer.pairs.add(k);
                if result.object2 == ObjectId::NULL {
                    continue;
                }
                assert!(result.object1 == id || result.object2 == id);
                let [one, other] = [result.object1, result.object2].map(|id| &scene.objects[scene.find(id).unwrap()]);
                assert!(scene.is_tested(one, other));
                check_result(scene.handle, result);
            }
            Ok(status)
        }
    }

    pub fn shrink(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let handle = or_null(u, self.scenes[place].handle)?;
        // SAFETY: a living scene or null.
        Ok(unsafe { swiftprox_scene_shrink(handle) })
    }

    pub fn statistics(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let handle = or_null(u, self.scenes[place].handle)?;
        let block = Block::new(size_of::<SceneStatistics>());
        let target = or_null(u, block.at())?;
        // SAFETY: a living scene or null, a block of the size of the statistics or null.
        Ok(unsafe {
            if u.arbitrary()? {
                swiftprox_scene_get_statistics(handle, target)
            } else {
                swiftprox_scene_reset_statistics(handle)
            }
        })
    }
}

/// A filter whose user pointer is the number of what it refuses.
unsafe extern "C-unwind" fn says(a: ObjectId, b: ObjectId, user: *mut std::ffi::c_void) -> i32 {
    i32::from(!refuses(user.addr() as u64, a, b))
}

/// A listed answer holds for the pieces and poses that the scene has.
///
/// # Safety
/// The scene lives and the result is its.
pub unsafe fn check_result(scene: *const SceneHandle, result: &PairResult) {
    let placed = |id, piece: u32| {
        // SAFETY: a living scene and room for shape and pose.
        unsafe {
            let mut shape = null();
            assert_eq!(swiftprox_scene_get_piece(scene, id, piece as usize, &mut shape), StatusCode::Ok);
            let mut pose = [0.0; 12];
            assert_eq!(swiftprox_scene_get_piece_pose(scene, id, piece, pose.as_mut_ptr()), StatusCode::Ok);
            (shape, pose)
        }
    };
    let ((shape1, pose1), (shape2, pose2)) =
        (placed(result.object1, result.piece1), placed(result.object2, result.piece2));
    // SAFETY: living shapes and twelve doubles each.
    unsafe { check_verified([shape1, shape2], [pose1.as_ptr(), pose2.as_ptr()], &result.answer) };
}

/// Reads what an object is, and writes it back with a change.
///
/// # Safety
/// A living scene.
unsafe fn changed(handle: *mut SceneHandle, id: ObjectId, change: impl FnOnce(&mut ObjectInfo)) -> StatusCode {
    let mut info = std::mem::MaybeUninit::<ObjectInfo>::uninit();
    // SAFETY: room for an info, whose size is written first; a living scene by the caller.
    unsafe {
        info.as_mut_ptr().cast::<usize>().write(size_of::<ObjectInfo>());
        let status = swiftprox_scene_get_object_info(handle, id, info.as_mut_ptr());
        let mut info = info.assume_init();
        change(&mut info);
        let second = swiftprox_scene_set_object_info(handle, id, &info);
        assert_eq!(status, second, "{}", last_message());
        second
    }
}
