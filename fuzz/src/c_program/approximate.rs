//! Calls that answer approximately and through levels, levels that a caller gives, and the log.

use std::ffi::{CStr, c_char, c_void};
use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::arrays::CMesh;
use swiftprox::ffi::level::*;
use swiftprox::ffi::library::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::query::*;
use swiftprox::ffi::tuning::*;
use swiftprox::pair::{Levels, Outcome, PairAnswer, Refinement, Start};
use swiftprox::scene::PairResult;

use super::arguments::{Block, any_pose, array, mesh_arrays, options, shape_options, start};
use super::shapes::ask_alike;
use super::{Program, check_verified, last_message};
use crate::geometry::{any_number, inside};

const ERRORS: [f64; 5] = [0.0, 1e-9, 1e-2, 1.0, f64::INFINITY];
const BUDGETS: [u32; 6] = [1, 2, 3, 7, 20, u32::MAX];
const STARTS: [Start; 4] = [Start::Automatic, Start::Cache, Start::Table, Start::Cold];
const LEVELS: [Levels; 3] = [Levels::Automatic, Levels::None, Levels::All];
const REFINEMENTS: [Refinement; 4] =
    [Refinement::Adaptive, Refinement::Single, Refinement::SingleSingle, Refinement::DoubleDouble];

/// A config with every member set; now and then one is out of range, or the struct of another size.
fn any_config(u: &mut Unstructured) -> Result<Option<Block>> {
    let mut last = 1.0;
    let mut config: CPairConfig = CPairConfig::DEFAULT;
    let mut tuning: CPairTuning = CPairTuning::DEFAULT;
    config.max_distance = if u.arbitrary()? { f64::INFINITY } else { any_number(u, &mut last)?.abs() };
    tuning.start = *u.choose(&STARTS)? as i32;
    config.absolute_error = *u.choose(&ERRORS)?;
    config.relative_error = *u.choose(&ERRORS)?;
    config.step_budget = *u.choose(&BUDGETS)?;
    tuning.levels = *u.choose(&LEVELS)? as i32;
    tuning.refinement = *u.choose(&REFINEMENTS)? as i32;
    if !u.ratio(1, 8)? {
        let tuning = Block::of(&[tuning]);
        config.tuning = tuning.at();
        return Ok(Some(Block::of(&[config]).with(Some(tuning))));
    }
    let error = any_number(u, &mut last)?.to_ne_bytes();
    let enumerator = u.int_in_range(-1..=4_i32)?.to_ne_bytes();
    let changes = [
        (std::mem::offset_of!(CPairTuning, start), &enumerator[..]),
        (std::mem::offset_of!(CPairTuning, levels), &enumerator[..]),
        (std::mem::offset_of!(CPairTuning, refinement), &enumerator[..]),
    ];
    let tuning = options(u, &tuning, &changes)?;
    config.tuning = start(&tuning);
    let changes = [
        (std::mem::offset_of!(CPairConfig, absolute_error), &error[..]),
        (std::mem::offset_of!(CPairConfig, relative_error), &error[..]),
        (std::mem::offset_of!(CPairConfig, step_budget), &[0; 4]),
    ];
    Ok(options(u, &config, &changes)?.map(|config| config.with(tuning)))
}

/// What an answer without a verdict says: an interval from 0 on.
fn check_undecided(answer: &PairAnswer) {
    assert!(answer.lower == 0.0 && answer.distance >= 0.0 && answer.distance <= answer.upper, "{answer:?}");
}

/// Receives failures.
extern "C-unwind" fn log(status: i32, message: *const c_char, user: *mut c_void) {
    // SAFETY: a string, by the header.
    let message = unsafe { CStr::from_ptr(message) };
    assert!(status != StatusCode::Ok as i32 && !message.is_empty() && user.is_null(), "{status} {message:?}");
}

impl Program {
    pub fn pair_query_through_levels(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let (shape1, shape2) = (self.shape(u)?, self.shape(u)?);
        let (pose1, pose2) = (any_pose(u)?, any_pose(u)?);
        let config = any_config(u)?;
        let queries =
            [swiftprox_pair_approximate, swiftprox_pair_distance, swiftprox_pair_contact, swiftprox_pair_intersection];
        let query = *u.choose(&queries)?;
        let slot = u.choose_index(self.caches.len())?;
        let answer = Block::new(size_of::<PairAnswer>());
        // SAFETY: living shapes or null, blocks of the sizes that the header names.
        unsafe {
            let cache = &raw mut self.caches[slot];
            let ask = || {
                query(
                    CPlaced { shape: shape1, pose: pose1.at() },
                    CPlaced { shape: shape2, pose: pose2.at() },
                    cache,
                    start(&config),
                    answer.at(),
                )
            };
            let status = ask_alike(self.environment, cache, answer.at(), ask);
            let said = answer.at::<PairAnswer>().read();
            assert_eq!(status == StatusCode::Ok, said.outcome != Outcome::None, "{}", last_message());
            match said.outcome {
                Outcome::None => {}
                Outcome::Undecided => check_undecided(&said),
                _ => check_verified([shape1, shape2], [pose1.at(), pose2.at()], &said),
            }
            self.answer = Some(said);
            Ok(status)
        }
    }

    pub fn scene_query_through_levels(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let place = self.scene(u)?;
        let scene = &self.scenes[place];
        let mut query: CSceneQuery = CSceneQuery::DEFAULT;
        let mut tuning: CPairTuning = CPairTuning::DEFAULT;
        query.early_exit = i32::from(u.ratio(1, 8)?);
        query.piece_pairs = u.int_in_range(0..=2)?;
        query.absolute_error = *u.choose(&ERRORS)?;
        query.relative_error = *u.choose(&ERRORS)?;
        query.error_budget = *u.choose(&[f64::INFINITY, 0.0, 1.0, -1.0])?;
        query.step_budget = *u.choose(&BUDGETS)?;
        tuning.levels = *u.choose(&LEVELS)? as i32;
        tuning.refinement = *u.choose(&REFINEMENTS)? as i32;
        query.tuning = &tuning;
        let mut answer = CSceneAnswer::EMPTY;
        // SAFETY: a living scene, query and answer; the results are the scene's until its next query.
        unsafe {
            let run = || swiftprox_scene_query_approximate(scene.handle, &query, &mut answer);
            let status = inside(self.environment, run);
            assert_eq!(status == StatusCode::Ok, query.error_budget >= 0.0, "{}", last_message());
            let listed: &[PairResult] =
                if answer.count == 0 { &[] } else { std::slice::from_raw_parts(answer.pairs, answer.count) };
            let stopped = status == StatusCode::Ok && query.early_exit != 0 && answer.intersecting != 0;
            assert_eq!(answer.found.is_null(), !stopped);
            if status == StatusCode::Ok {
                let tested = scene.tested();
                let objects = tested.chunk_by(|(one, ..), (other, ..)| one == other).count();
                let count = if query.piece_pairs == 0 { tested.len() } else { objects };
                assert_eq!(listed.len(), if stopped { 0 } else { count });
            }
            for result in listed.iter().chain(answer.found.as_ref()) {
                match result.answer.outcome {
                    Outcome::Undecided => check_undecided(&result.answer),
                    _ => super::scenes::check_result(scene.handle, result),
                }
            }
            Ok(status)
        }
    }

    pub fn shape_from_levels(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let options = shape_options(u)?;
        let mut arrays = Vec::new();
        for _ in 0..u.int_in_range(0..=3)? {
            arrays.push(mesh_arrays(u)?);
        }
        let levels: Vec<CMesh> = arrays
            .iter()
            .map(|level| CMesh {
                vertices: level.vertices.at(),
                vertex_count: level.vertex_count,
                indices: level.indices.at(),
                valences: if level.triangles { null_mut() } else { level.valences.at() },
                face_count: level.face_count,
            })
            .collect();
        let block = Block::of(&levels);
        let (first, count) = array(u, block.at(), levels.len())?;
        let mut shape = null();
        // SAFETY: what is not null has the room that it claims.
        let status = unsafe { swiftprox_shape_create_from_levels(first, count, start(&options), &mut shape) };
        Ok(self.keep(status, shape))
    }

    pub fn set_log(&self, u: &mut Unstructured) -> Result<StatusCode> {
        let callback: LogCallback = if u.arbitrary()? { Some(log) } else { None };
        swiftprox_library_set_log(callback, null_mut());
        Ok(StatusCode::Ok)
    }
}
