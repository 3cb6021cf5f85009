//! How shapes are made: the options, and the callback that learns how far the making is.

use std::ffi::c_void;

use super::enumerators::{InputNumber, read_enumerator};
use super::failure::{Checked, Failure, StatusCode};
use super::guard::call_out;
use super::structs::{Versioned, read_struct};
use super::tuning::{CShapeTuning, read_shape_tuning};
use crate::base::error::Result;
use crate::base::math::{Matrix, Vector};
use crate::base::progress::Progress;
use crate::shape::{InputPolicy, Shape, ShapeOptions};

/// Receives the progress of a long call: a fraction from 0 to 1 that never falls, and the caller's pointer. It returns 0 to
/// continue; other numbers end the call with SWIFTPROX_ERROR_CANCELLED. It runs in the calling thread, must return and must not use
/// the call's objects. A C++ exception that leaves it ends the program.
pub type ProgressCallback = Option<unsafe extern "C-unwind" fn(user: *mut c_void, fraction: f64) -> i32>;

/// Options of a new shape. Initialise with SWIFTPROX_SHAPE_OPTIONS_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CShapeOptions {
    /// Set by SWIFTPROX_SHAPE_OPTIONS_DEFAULT.
    pub struct_size: usize,
    /// How to treat input that is not a closed convex mesh with interior. Default: refuse it.
    pub input: InputNumber,
    /// Row-major rotation. A stored vertex is scale * (rotation * v) + translation, rounded to doubles once. The local frame is the
    /// frame after this transform. Default: identity.
    pub rotation: [f64; 9],
    /// See rotation. Default: 0.
    pub translation: [f64; 3],
    /// See rotation; positive. Default: 1.
    pub scale: f64,
    /// How far a vertex may lie outside a face, relative to the bounding-box diagonal. Default: negative, which means 1e-9, or 1e-6
    /// for single-precision meshes (STL). With SWIFTPROX_INPUT_NEARLY_CONVEX it is at least the result of
    /// swiftprox_mesh_estimate_tolerance.
    pub convexity_tolerance: f64,
    /// Reports progress and can cancel. Default: null.
    pub progress: ProgressCallback,
    /// Passed to progress. Default: null.
    pub progress_user: *mut c_void,
    /// Levels of detail and look-up table (swiftprox/tuning.h). Default: null, automatic.
    pub tuning: *const CShapeTuning,
    /// Error of input coordinates, before scale. Manifolds treat vertices within it of one plane as one face. Distance and depth do
    /// not change; gap intervals include it. Negative (the default): estimated from the input, at least 1e-6 of half the box's
    /// diagonal. 0: rounding of doubles only. It must be finite (else SWIFTPROX_ERROR_INVALID_ARGUMENT).
    pub face_noise: f64,
    /// Radius of a ball swept over the body, in input units before scale. A point becomes a sphere, a segment a capsule; other
    /// bodies get round edges and corners. All queries are of the swept body: witness points are on it, features are those of the
    /// body without the ball. From 0 (the default) to 2^1000 (else SWIFTPROX_ERROR_INVALID_ARGUMENT).
    pub swept_radius: f64,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CShapeOptions {
    const NAME: &'static str = "swiftprox_shape_options";
}

/// Options in Rust's terms.
pub(super) struct Making {
    options: ShapeOptions,
    progress: ProgressCallback,
    user: *mut c_void,
}

impl Making {
    /// Makes the shape, telling the callback how far it is.
    pub(super) fn run(&self, make: impl FnOnce(&ShapeOptions, &mut Progress) -> Result<Shape>) -> Result<Shape> {
        in_steps(self.progress, self.user, |progress| make(&self.options, progress))
    }
}

/// Does something long, telling the callback how far it is and asking it whether to go on.
pub(super) fn in_steps<T>(
    callback: ProgressCallback,
    user: *mut c_void,
    run: impl FnOnce(&mut Progress) -> Result<T>,
) -> Result<T> {
    run(&mut Progress::new(&mut |fraction| {
        // SAFETY: the callback takes any fraction and its own user pointer (swiftprox_progress_callback).
        callback.is_none_or(|callback| call_out(|| unsafe { callback(user, fraction) }) == 0)
    }))
}

impl CShapeOptions {
    /// The defaults, as in the header.
    pub const DEFAULT: CShapeOptions = CShapeOptions {
        struct_size: size_of::<CShapeOptions>(),
        input: InputPolicy::Strict as i32,
        rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        translation: [0.0; 3],
        scale: 1.0,
        convexity_tolerance: -1.0,
        progress: None,
        progress_user: std::ptr::null_mut(),
        tuning: std::ptr::null(),
        face_noise: -1.0,
        swept_radius: 0.0,
    };

    /// The options in Rust's terms. What is left to check, the makers of shapes check.
    ///
    /// # Safety
    /// The tuning meets the header's pointer rules.
    unsafe fn checked(&self) -> Checked<Making> {
        let input = read_enumerator(self.input, "options->input", "swiftprox_input")?;
        // SAFETY: by the caller.
        let (hierarchy, lookup) = unsafe { read_shape_tuning(self.tuning) }?;
        if self.convexity_tolerance.is_nan() {
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, "options->convexity_tolerance is not a number"));
        }
        if !self.face_noise.is_finite() {
            return Err(Failure::new(
                StatusCode::ErrorInvalidArgument,
                format!(
                    "options->face_noise is {}, it must be finite; less than 0 asks for the default",
                    self.face_noise
                ),
            ));
        }
        let options = ShapeOptions {
            input,
            rotation: Matrix::from_row_slice(&self.rotation),
            translation: Vector::from(self.translation),
            scale: self.scale,
            convexity_tolerance: (self.convexity_tolerance >= 0.0).then_some(self.convexity_tolerance),
            hierarchy,
            lookup,
            face_noise: (self.face_noise >= 0.0).then_some(self.face_noise),
            swept_radius: self.swept_radius,
        };
        Ok(Making { options, progress: self.progress, user: self.progress_user })
    }
}

/// The options, or the defaults for null.
///
/// # Safety
/// `options` and its tuning meet the header's pointer rules.
pub(super) unsafe fn read_options(options: *const CShapeOptions) -> Checked<Making> {
    // SAFETY: by the caller.
    unsafe { read_struct(options, CShapeOptions::DEFAULT)?.checked() }
}
