//! How shapes are made: the options, and the callback that learns how far the making is.

use std::ffi::c_void;

use super::{Checked, Failure, StatusCode, Versioned, call_out, guard, output, read_enumerator, read_struct};
use crate::base::error::Result;
use crate::base::math::{Matrix, Vector};
use crate::base::progress::Progress;
use crate::levels::hierarchy::{HierarchyKind, HierarchyOptions};
use crate::shape::{InputPolicy, Shape, ShapeOptions};
use crate::tables::{LookupKind, LookupOptions};

/// Learns how far the building, loading or preparing of a shape is: a fraction from 0 to 1 that never falls, and the pointer given
/// with the callback. Returns 0 to go on; anything else ends the call with SWIFTPROX_ERROR_CANCELLED. It runs in the thread that
/// builds, must return, and must not use what the call is working on; a C++ exception that leaves it ends the program.
pub type ProgressCallback = Option<unsafe extern "C-unwind" fn(user: *mut c_void, fraction: f64) -> i32>;

/// How a shape is made. Fill it with swiftprox_shape_options_init, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CShapeOptions {
    /// Set by swiftprox_shape_options_init.
    pub struct_size: usize,
    /// A swiftprox_input: what to do with input that is not a closed convex mesh with interior. Default: refuse it.
    pub input: i32,
    /// Row-major rotation; with translation and scale the input transform, applied once when the shape is made: stored vertex =
    /// scale * (rotation * v) + translation, rounded to doubles. "Local frame" means the frame after it. Default: identity.
    pub rotation: [f64; 9],
    /// See rotation. Default: 0.
    pub translation: [f64; 3],
    /// See rotation; positive. Default: 1.
    pub scale: f64,
    /// How far a vertex may lie outside a face of accepted input, relative to the bounding-box diagonal. Default: negative,
    /// which means 1e-9, and 1e-6 for meshes that went through single precision (STL).
    pub convexity_tolerance: f64,
    /// A swiftprox_hierarchy: how levels of detail are made. Default: automatic.
    pub hierarchy: i32,
    /// The fraction of the triangles that a level has left of those of the next finer one, between 0 and 1, both exclusive; less
    /// where that many would have more features than faces of many corners have. Default: 0.25. This and the two that follow
    /// do not count for automatic levels.
    pub decimation: f64,
    /// No level has fewer triangles. Default: 50.
    pub minimum_triangles: usize,
    /// No more levels than these. Default: 32.
    pub most_levels: usize,
    /// Learns how far the building of the shape is, and can cancel it. Default: null.
    pub progress: ProgressCallback,
    /// Handed to progress. Default: null.
    pub progress_user: *mut c_void,
    /// A swiftprox_lookup: which table says where a query starts when the last one of the pair tells nothing. It is made by the
    /// first query that looks into it: less than a quarter of the time that making the shape took. A body smaller than 2^-200 or
    /// larger than 2^200 has none. Default: automatic.
    pub lookup: i32,
    /// Resolution of the table: of shells, cells along a side of the square that all directions are mapped to, a power of two
    /// from 4 to 512; of a spherical table, increments from pole to pole, 2 to 512 (32, 16, 8: 5.625, 11.25, 22.5 degrees).
    /// Default: 0, which means what the number of vertices asks for, or 32.
    pub lookup_resolution: u32,
    /// Radius of the sphere of a spherical table's sample points as a multiple of the body's radius, at least 1. Default: 2.
    pub lookup_radius_factor: f64,
}

// SAFETY: repr(C), struct_size first.
unsafe impl Versioned for CShapeOptions {
    const NAME: &'static str = "swiftprox_shape_options";
    const FIRST_SIZE: usize = size_of::<CShapeOptions>();
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
    const DEFAULT: CShapeOptions = CShapeOptions {
        struct_size: size_of::<CShapeOptions>(),
        input: InputPolicy::Strict as i32,
        rotation: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        translation: [0.0; 3],
        scale: 1.0,
        convexity_tolerance: -1.0,
        hierarchy: HierarchyKind::Automatic as i32,
        decimation: 0.25,
        minimum_triangles: 50,
        most_levels: 32,
        progress: None,
        progress_user: std::ptr::null_mut(),
        lookup: LookupKind::Automatic as i32,
        lookup_resolution: 0,
        lookup_radius_factor: LookupOptions::DEFAULT.radius_factor,
    };

    /// The options in Rust's terms. What is left to check, the makers of shapes check.
    fn checked(&self) -> Checked<Making> {
        let input = read_enumerator(self.input, "options->input", "swiftprox_input")?;
        let lookup = read_enumerator(self.lookup, "options->lookup", "swiftprox_lookup")?;
        let kind = read_enumerator(self.hierarchy, "options->hierarchy", "swiftprox_hierarchy")?;
        if self.convexity_tolerance.is_nan() {
            return Err(Failure::new(StatusCode::ErrorInvalidArgument, "options->convexity_tolerance is not a number"));
        }
        let &CShapeOptions { decimation, minimum_triangles, most_levels, progress, progress_user, .. } = self;
        let options = ShapeOptions {
            input,
            rotation: Matrix::from_row_slice(&self.rotation),
            translation: Vector::from(self.translation),
            scale: self.scale,
            convexity_tolerance: (self.convexity_tolerance >= 0.0).then_some(self.convexity_tolerance),
            hierarchy: HierarchyOptions { kind, decimation, minimum_triangles, most_levels },
            lookup: LookupOptions {
                kind: lookup,
                resolution: self.lookup_resolution,
                radius_factor: self.lookup_radius_factor,
            },
        };
        Ok(Making { options, progress, user: progress_user })
    }
}

/// Fills `options` with the defaults, struct_size included.
///
/// SWIFTPROX_ERROR_NULL_POINTER: options is null.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_options_init(options: *mut CShapeOptions) -> StatusCode {
    // SAFETY: the header's pointer rules.
    guard(|| unsafe { output(options, "options", CShapeOptions::DEFAULT) })
}

/// The options, or the defaults for null.
///
/// # Safety
/// `options` meets the header's pointer rules.
pub(super) unsafe fn read_options(options: *const CShapeOptions) -> Checked<Making> {
    // SAFETY: by the caller; any bytes make valid options.
    unsafe { read_struct(options, CShapeOptions::DEFAULT) }?.checked()
}
