//! A C program that arbitrary bytes write: what it holds, and one call after the other.

mod approximate;
mod arguments;
mod grounds;
mod model;
mod readers;
mod recordings;
mod scenes;
mod shapes;

use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::library::*;
use swiftprox::ffi::pair::*;
use swiftprox::ffi::scene::*;
use swiftprox::ffi::shape::*;
use swiftprox::object::ObjectId;
use swiftprox::pair::PairAnswer;
use swiftprox::shape::Shape;

use model::Scene;

/// The message of the last failure.
pub fn last_message() -> String {
    // SAFETY: never null, terminated, unchanged until the next failure of this thread.
    unsafe { CStr::from_ptr(swiftprox_library_last_error_message()) }.to_string_lossy().into_owned()
}

/// All that the program holds.
pub struct Program {
    /// Its floating-point environment.
    environment: Environment,
    /// Shapes, one entry for each share.
    shapes: Vec<*const Shape>,
    scenes: Vec<Scene>,
    /// Ids that were good once, of any scene.
    old_ids: Vec<ObjectId>,
    caches: [CPairCache; 2],
    /// The last answer of a pair query.
    answer: Option<PairAnswer>,
    /// Files that scenes were recorded in.
    recordings: Vec<CString>,
}

const MOST_SHAPES: usize = 12;
const MOST_SCENES: usize = 3;
const MOST_OBJECTS: usize = 8;
const MOST_POINTS: usize = 16;

impl Program {
    /// Before the first call.
    pub fn begin(environment: Environment) -> Program {
        readers::register();
        Program {
            environment,
            shapes: Vec::new(),
            scenes: Vec::new(),
            old_ids: Vec::new(),
            caches: Default::default(),
            answer: None,
            recordings: Vec::new(),
        }
    }

    /// One call, or a few that belong together.
    pub fn call(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        match u.int_in_range(0..=23)? {
            0 | 1 => self.shape_from_points(u),
            2 => self.shape_from_mesh(u),
            3 => self.shape_from_file(u),
            4 => self.share_shape(u),
            5 => self.look_at_shape(u),
            6..=8 => self.pair_query(u),
            9 => self.verify(u),
            10 => self.create_or_destroy_scene(u),
            11..=13 => self.add_object(u),
            14 => self.change_objects(u),
            15 => self.look_at_object(u),
            16 | 17 => self.move_objects(u),
            18 => self.activate(u),
            19..=21 => self.scene_query(u),
            22 => match u.int_in_range(0..=7)? {
                0 => self.statistics(u),
                1 | 2 => self.change_one(u),
                3 | 4 => self.choose_pairs(u),
                5 => self.ground_or_half_space(u),
                _ => self.near_query(u),
            },
            // At the end, so that the bytes of the corpus go on to mean the same calls.
            _ => match u.int_in_range(0..=15)? {
                call @ 0..=5 => library(u, call),
                6..=9 => self.pair_query_through_levels(u),
                10..=12 => self.scene_query_through_levels(u),
                13 => self.shape_from_levels(u),
                14 => self.shrink(u),
                _ if u.int_in_range(0..=3)? == 0 => self.set_log(u),
                _ => self.record(u),
            },
        }
    }

    /// Gives everything back.
    pub fn end(self) {
        swiftprox_library_set_log(None, null_mut());
        readers::take_back();
        // SAFETY: all are alive, and none is used again.
        unsafe {
            for scene in &self.scenes {
                assert_eq!(swiftprox_scene_destroy(scene.handle), StatusCode::Ok);
            }
            for path in &self.recordings {
                std::fs::remove_file(path.to_str().expect("a path in UTF-8")).expect("the file of a recording");
            }
            for &shape in &self.shapes {
                swiftprox_shape_release(shape);
            }
        }
    }
}

/// An answer verifies; beyond the range of doubles `verify` cannot tell. If it does not, all that was asked is printed.
///
/// # Safety
/// The shapes are alive, and each pose is twelve doubles.
unsafe fn check_verified(shapes: [*const Shape; 2], poses: [*const f64; 2], answer: &PairAnswer) {
    // SAFETY: as above.
    let (status, shapes, poses) = unsafe {
        let status = swiftprox_pair_verify(
            CPlaced { shape: shapes[0], pose: poses[0] },
            CPlaced { shape: shapes[1], pose: poses[1] },
            answer,
        );
        (status, shapes.map(|shape| &*shape), poses.map(|pose| &*pose.cast::<[f64; 12]>()))
    };
    let beyond = status == StatusCode::ErrorInvalidArgument && last_message().contains("too large or too far apart");
    let bodies = || shapes.map(|shape| (shape.polyhedron().centre, &shape.polyhedron().vertices));
    let verified = status == StatusCode::Ok || beyond;
    assert!(verified, "{}: {answer:?}\n{poses:?}\n{:?}", last_message(), bodies());
}

/// What has to do with no handle.
fn library(u: &mut Unstructured, call: u32) -> Result<StatusCode> {
    // SAFETY: what is null may be, by the header.
    unsafe {
        match call {
            0 => return Ok(swiftprox_scene_destroy(null_mut())),
            1 => swiftprox_shape_release(null()),
            _ => {
                let _ = swiftprox_library_version();
                let number = u.arbitrary()?;
                let _ = swiftprox_library_status_string(number);
                let _ = swiftprox_library_outcome_string(number);
                let _ = swiftprox_library_feature_kind_string(number);
                let _ = swiftprox_library_decided_by_string(number);
            }
        }
    }
    Ok(StatusCode::Ok)
}
