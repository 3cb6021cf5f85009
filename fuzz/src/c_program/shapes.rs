//! Calls about shapes and pairs of them.

use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::arrays::CMesh;
use swiftprox::ffi::level::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::shape::*;
use swiftprox::ffi::tuning::*;
use swiftprox::pair::{Outcome, PairAnswer};
use swiftprox::shape::Shape;

use super::arguments::{
    Block, any_pose, array, mesh_arrays, mesh_file, options, or_null, pair_config, shape_options, start, temporary_file,
};
use super::readers::reading;
use super::{MOST_POINTS, MOST_SHAPES, Program, check_verified, last_message};
use crate::geometry::{any_points, inside};

impl Program {
    /// Any shape of the program's, or null.
    pub fn shape(&self, u: &mut Unstructured) -> Result<*const Shape> {
        if self.shapes.is_empty() || u.ratio(1, 32)? {
            return Ok(null());
        }
        Ok(*u.choose(&self.shapes)?)
    }

    /// Keeps a shape that was made; on failure nothing is kept.
    pub fn keep(&mut self, status: StatusCode, shape: *const Shape) -> StatusCode {
        assert_eq!(status == StatusCode::Ok, !shape.is_null(), "{}", last_message());
        if !shape.is_null() {
            self.shapes.push(shape);
            if self.shapes.len() > MOST_SHAPES {
                let oldest = self.shapes.remove(0);
                // SAFETY: a living shape whose share is given up.
                unsafe { swiftprox_shape_release(oldest) };
            }
        }
        status
    }

    pub fn shape_from_points(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let options = shape_options(u)?;
        let coordinates: Vec<[f64; 3]> = any_points(u, MOST_POINTS)?.iter().map(|&p| p.into()).collect();
        let block = Block::of(&coordinates);
        let mut shape = null();
        let (array, count) = array(u, block.at(), coordinates.len())?;
        let make = |shape: &mut *const Shape| {
            // SAFETY: what is not null has the room that it claims.
            unsafe { swiftprox_shape_create_from_points(array, count, start(&options), shape) }
        };
        let status = make(&mut shape);
        let mut again = null();
        assert_eq!(inside(self.environment, || make(&mut again)), status, "{:?}", self.environment);
        if !shape.is_null() {
            // SAFETY: both live while they are compared; the second is released once.
            unsafe {
                assert!(*shape == *again, "{:?}: another shape", self.environment);
                swiftprox_shape_release(again);
            }
        }
        Ok(self.keep(status, shape))
    }

    pub fn shape_from_mesh(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let options = shape_options(u)?;
        let arrays = mesh_arrays(u)?;
        let mut shape = null();
        // SAFETY: what is not null has the room that it claims.
        let status = unsafe {
            let [vertices, indices, valences] = [&arrays.vertices, &arrays.indices, &arrays.valences];
            let (vertices, vertex_count) = array(u, vertices.at(), arrays.vertex_count)?;
            let indices = or_null(u, indices.at())?;
            let valences = if arrays.triangles { null_mut() } else { valences.at() };
            let face_count = arrays.face_count;
            let out = if u.ratio(1, 32)? { null_mut() } else { &raw mut shape };
            swiftprox_shape_create_from_mesh(
                CMesh { vertices, vertex_count, indices, valences, face_count },
                start(&options),
                out,
            )
        };
        Ok(self.keep(status, shape))
    }

    pub fn shape_from_file(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let options = shape_options(u)?;
        let path = mesh_file(u)?;
        let mut shape = null();
        let path = path.as_ref().map_or(null(), |path| path.as_ptr());
        // SAFETY: a string or null, and room for the shape.
        let status = reading(|| unsafe { swiftprox_shape_create_from_file(path, start(&options), &mut shape) });
        Ok(self.keep(status, shape))
    }

    pub fn share_shape(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let shape = self.shape(u)?;
        // SAFETY: living shapes; the program has as many entries as shares.
        unsafe {
            if u.arbitrary()? && self.shapes.len() < MOST_SHAPES {
                if !shape.is_null() {
                    self.shapes.push(shape);
                }
                assert_eq!(swiftprox_shape_retain(shape), shape);
            } else {
                if let Some(place) = self.shapes.iter().position(|&s| s == shape) {
                    self.shapes.remove(place);
                }
                swiftprox_shape_release(shape);
            }
        }
        Ok(StatusCode::Ok)
    }

    pub fn look_at_shape(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let shape = self.shape(u)?;
        // SAFETY: zero is a value of every member.
        let mut info = unsafe { std::mem::zeroed::<ShapeInfo>() };
        info.struct_size = size_of::<ShapeInfo>();
        // SAFETY: a living shape or null, room for the info.
        let status = unsafe { swiftprox_shape_get_info(shape, &mut info) };
        if status != StatusCode::Ok {
            return Ok(status);
        }
        if info.vertex_count.is_multiple_of(3) {
            // SAFETY: a living shape.
            assert_eq!(unsafe { swiftprox_shape_prepare(shape, None, null_mut()) }, StatusCode::Ok);
        }
        let given = options(u, &info, &[])?;
        // SAFETY: as large as it says, or null.
        let _ = unsafe { swiftprox_shape_get_info(shape, start(&given)) };
        if u.ratio(1, 4)? {
            // SAFETY: zero is a value of every member.
            let mut has = unsafe { std::mem::zeroed::<TuningInfo>() };
            has.struct_size = size_of::<TuningInfo>();
            // SAFETY: a living shape, room for the info.
            assert_eq!(unsafe { swiftprox_shape_get_tuning_info(shape, &mut has) }, StatusCode::Ok);
            return self.look_at_level(u, shape, has.level_count);
        }
        if u.ratio(1, 8)? {
            return self.save_and_load(shape);
        }
        let spare = u.int_in_range(0..=3)?;
        // SAFETY: the room that is claimed; labels may be null.
        Ok(unsafe {
            if u.arbitrary()? {
                let capacity = (info.vertex_count + spare).saturating_sub(1);
                let (vertices, labels) = (Block::new(24 * capacity), Block::new(4 * capacity));
                let labels = or_null(u, labels.at())?;
                let status = swiftprox_shape_copy_vertices(shape, vertices.at(), labels, capacity);
                assert_eq!(status == StatusCode::Ok, capacity >= info.vertex_count);
                status
            } else {
                let capacity = (info.triangle_count + spare).saturating_sub(1);
                let corners = Block::new(12 * capacity);
                let status = swiftprox_shape_copy_triangles(shape, corners.at(), capacity);
                assert_eq!(status == StatusCode::Ok, capacity >= info.triangle_count);
                status
            }
        })
    }

    fn look_at_level(&self, u: &mut Unstructured, shape: *const Shape, levels: usize) -> Result<StatusCode> {
        let level = u.int_in_range(0..=levels + 1)?;
        // SAFETY: zero is a value of every member.
        let mut info = unsafe { std::mem::zeroed::<LevelInfo>() };
        info.struct_size = size_of::<LevelInfo>();
        // SAFETY: a living shape, and the room that is claimed.
        Ok(unsafe {
            let status = swiftprox_shape_get_level_info(shape, level, &mut info);
            assert_eq!(status == StatusCode::Ok, level <= levels, "{}", last_message());
            if status != StatusCode::Ok {
                return Ok(status);
            }
            let (vertices, corners) = (Block::new(24 * info.vertex_count), Block::new(12 * info.triangle_count));
            let status = swiftprox_shape_copy_level_vertices(shape, level, vertices.at(), info.vertex_count);
            assert_eq!(status, StatusCode::Ok, "{}", last_message());
            swiftprox_shape_copy_level_triangles(shape, level, corners.at(), info.triangle_count)
        })
    }

    /// What was saved loads as the same.
    fn save_and_load(&mut self, shape: *const Shape) -> Result<StatusCode> {
        let path = temporary_file("shape");
        let mut loaded = null();
        // SAFETY: a living shape, a path, and room for the shape; both shapes live while they are compared.
        let status = unsafe {
            assert_eq!(swiftprox_shape_save(shape, path.as_ptr()), StatusCode::Ok, "{}", last_message());
            let status = swiftprox_shape_load(path.as_ptr(), None, null_mut(), &mut loaded);
            assert_eq!(status, StatusCode::Ok, "{}", last_message());
            assert!(*shape == *loaded, "loaded is not what was saved");
            status
        };
        Ok(self.keep(status, loaded))
    }

    pub fn pair_query(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let (shape1, shape2) = (self.shape(u)?, self.shape(u)?);
        let (pose1, pose2) = (any_pose(u)?, any_pose(u)?);
        let (pointer1, pointer2) = (or_null(u, pose1.at::<f64>())?, or_null(u, pose2.at::<f64>())?);
        let config = pair_config(u)?;
        let query = *u.choose(&[swiftprox_pair_distance, swiftprox_pair_intersection, swiftprox_pair_contact])?;
        let slot = u.choose_index(self.caches.len())?;
        if u.ratio(1, 8)? {
            self.caches[slot].words = u.arbitrary()?;
        }
        let cache = or_null(u, &raw mut self.caches[slot])?;
        let answer = Block::new(size_of::<PairAnswer>());
        let target = or_null(u, answer.at::<PairAnswer>())?;
        // SAFETY: living shapes, blocks of the sizes that the header names, or null.
        unsafe {
            let ask = || {
                query(
                    CPlaced { shape: shape1, pose: pointer1 },
                    CPlaced { shape: shape2, pose: pointer2 },
                    cache,
                    start(&config),
                    target,
                )
            };
            let status = ask_alike(self.environment, cache, target, ask);
            if target.is_null() {
                assert_eq!(status, StatusCode::ErrorNullPointer);
                return Ok(status);
            }
            // Also after a failure the answer is one.
            let said = target.read();
            assert_eq!(status == StatusCode::Ok, said.outcome != Outcome::None, "{}", last_message());
            if status == StatusCode::Ok {
                check_verified([shape1, shape2], [pointer1, pointer2], &said);
            }
            self.answer = Some(said);
            Ok(status)
        }
    }

    /// An answer about other shapes and poses than the program now gives, perhaps changed.
    pub fn verify(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let (shape1, shape2) = (self.shape(u)?, self.shape(u)?);
        let (pose1, pose2) = (any_pose(u)?, any_pose(u)?);
        let answer = match &self.answer {
            Some(answer) => Block::of(std::slice::from_ref(answer)),
            None => Block::new(size_of::<PairAnswer>()),
        };
        for _ in 0..u.int_in_range(0..=3)? {
            // SAFETY: inside the block.
            unsafe { answer.start.add(u.choose_index(size_of::<PairAnswer>())?).write(u.arbitrary()?) };
        }
        let answer = or_null(u, answer.at::<PairAnswer>())?;
        // SAFETY: living shapes, blocks of the sizes that the header names, or null.
        Ok(unsafe {
            inside(self.environment, || {
                swiftprox_pair_verify(
                    CPlaced { shape: shape1, pose: pose1.at() },
                    CPlaced { shape: shape2, pose: pose2.at() },
                    answer,
                )
            })
        })
    }
}

/// Asks in the default environment, and what is answered again in another one: bit for bit the same.
///
/// # Safety
/// `ask` asks for `answer` with `cache`, which are null or can be written.
pub unsafe fn ask_alike(
    environment: Environment,
    cache: *mut CPairCache,
    answer: *mut PairAnswer,
    ask: impl Fn() -> StatusCode,
) -> StatusCode {
    // SAFETY: not null, readable.
    let before = (!cache.is_null()).then(|| unsafe { cache.read() });
    let status = ask();
    if let Some(before) = before
        && status == StatusCode::Ok
    {
        // SAFETY: what is answered had both.
        let told = || unsafe { (format!("{:?}", answer.read()), cache.read().words) };
        let first = told();
        // SAFETY: as above.
        unsafe { cache.write(before) };
        assert_eq!(inside(environment, &ask), status, "{environment:?}");
        assert_eq!(told(), first, "{environment:?}");
    }
    status
}
