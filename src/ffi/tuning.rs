//! Levels of detail and look-up tables: how they are made, how queries use them, and what a shape has of them.

use std::mem::MaybeUninit;

use super::enumerators::{HierarchyNumber, LevelsNumber, LookupNumber, RefinementNumber, StartNumber, read_enumerator};
use super::failure::{Checked, StatusCode};
use super::guard::guard;
use super::pointers::handle;
use super::structs::{Versioned, read_struct, view_struct, write_struct};
use crate::body::polyhedron::lookup::Plan;
use crate::body::tables::{LookupKind, LookupOptions};
use crate::pair::{Levels, PairConfig, Refinement, Start};
use crate::shape::Shape;
use crate::shape::levels::hierarchy::{HierarchyKind, HierarchyOptions};

// --- How shapes are made -------------------------------------------------------------------------------------------------

/// Levels of detail and look-up table of a new shape, for swiftprox_shape_options.tuning. Initialise with
/// SWIFTPROX_SHAPE_TUNING_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CShapeTuning {
    /// Set by SWIFTPROX_SHAPE_TUNING_DEFAULT.
    pub struct_size: usize,
    /// How to make levels of detail. Default: automatic.
    pub hierarchy: HierarchyNumber,
    /// The table of starting points for queries with a cold cache. The first query that needs it makes it, in less than a quarter
    /// of the time of making the shape. Bodies smaller than 2^-200 or larger than 2^200 have none. Default: automatic.
    pub lookup: LookupNumber,
    /// Fraction of triangles that each level keeps from the next finer one, strictly between 0 and 1. Faces with many corners may
    /// lower it. Default: 0.25. Automatic levels ignore this and the two members below.
    pub decimation: f64,
    /// The least number of triangles in a level. Default: 50.
    pub minimum_triangles: usize,
    /// The largest number of levels. Default: 32.
    pub most_levels: usize,
    /// For a spherical table: radius of the sphere of sample points as a multiple of the body's radius, at least 1. Default: 2.
    pub lookup_radius_factor: f64,
    /// Resolution of the table. Shells: cells along a side of the square of directions, a power of two from 4 to 512. Spherical:
    /// increments from pole to pole, 2 to 512 (32 means 5.625 degrees). Default: 0, chosen by the number of vertices, or 32.
    pub lookup_resolution: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CShapeTuning {
    const NAME: &'static str = "swiftprox_shape_tuning";
}

impl CShapeTuning {
    /// The defaults, as in the header.
    pub const DEFAULT: CShapeTuning = CShapeTuning {
        struct_size: size_of::<CShapeTuning>(),
        hierarchy: HierarchyKind::Automatic as i32,
        lookup: LookupKind::Automatic as i32,
        decimation: 0.25,
        minimum_triangles: 50,
        most_levels: 32,
        lookup_radius_factor: LookupOptions::DEFAULT.radius_factor,
        lookup_resolution: 0,
    };
}

/// Levels and table in Rust's terms; the defaults for null.
///
/// # Safety
/// `tuning` meets the header's pointer rules.
pub(super) unsafe fn read_shape_tuning(tuning: *const CShapeTuning) -> Checked<(HierarchyOptions, LookupOptions)> {
    // SAFETY: by the caller.
    let tuning = unsafe { read_struct(tuning, CShapeTuning::DEFAULT) }?;
    let &CShapeTuning { decimation, minimum_triangles, most_levels, .. } = &tuning;
    let kind = read_enumerator(tuning.hierarchy, "tuning->hierarchy", "swiftprox_hierarchy")?;
    let lookup = LookupOptions {
        kind: read_enumerator(tuning.lookup, "tuning->lookup", "swiftprox_lookup")?,
        resolution: tuning.lookup_resolution,
        radius_factor: tuning.lookup_radius_factor,
    };
    Ok((HierarchyOptions { kind, decimation, minimum_triangles, most_levels }, lookup))
}

// --- How queries use them ------------------------------------------------------------------------------------------------

/// Start and levels of detail of queries, for swiftprox_pair_config.tuning and swiftprox_scene_query.tuning. It affects speed,
/// never the verdict. Initialise with SWIFTPROX_PAIR_TUNING_DEFAULT.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPairTuning {
    /// Set by SWIFTPROX_PAIR_TUNING_DEFAULT.
    pub struct_size: usize,
    /// Where marching starts. Default: the automatic choice.
    pub start: StartNumber,
    /// Which levels of detail queries use. Default: the automatic choice.
    pub levels: LevelsNumber,
    /// How queries go from level to level. Default: adaptive.
    pub refinement: RefinementNumber,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CPairTuning {
    const NAME: &'static str = "swiftprox_pair_tuning";
}

impl CPairTuning {
    /// The defaults, as in the header.
    pub const DEFAULT: CPairTuning = CPairTuning {
        struct_size: size_of::<CPairTuning>(),
        start: Start::Automatic as i32,
        levels: Levels::Automatic as i32,
        refinement: Refinement::Adaptive as i32,
    };
}

/// Start and levels of queries, in Rust's terms.
pub(super) struct PairTuning {
    pub start: Start,
    pub levels: Levels,
    pub refinement: Refinement,
}

/// The tuning of a query; the defaults for null.
///
/// # Safety
/// `tuning` meets the header's pointer rules.
#[inline(always)]
pub(super) unsafe fn read_pair_tuning(tuning: *const CPairTuning) -> Checked<PairTuning> {
    if tuning.is_null() {
        let PairConfig { start, levels, refinement, .. } = PairConfig::default();
        return Ok(PairTuning { start, levels, refinement });
    }
    let mut older = MaybeUninit::uninit();
    // SAFETY: not null, the rest by the caller.
    let tuning = unsafe { view_struct(tuning, &CPairTuning::DEFAULT, &mut older) }?;
    Ok(PairTuning {
        start: read_enumerator(tuning.start, "tuning->start", "swiftprox_start")?,
        levels: read_enumerator(tuning.levels, "tuning->levels", "swiftprox_levels")?,
        refinement: read_enumerator(tuning.refinement, "tuning->refinement", "swiftprox_refinement")?,
    })
}

// --- What a shape has ----------------------------------------------------------------------------------------------------

/// Levels of detail and look-up table of a shape. Set struct_size to sizeof(swiftprox_shape_tuning_info) before the call.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct TuningInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// How the levels of detail are made.
    pub hierarchy: HierarchyNumber,
    /// The look-up table, never SWIFTPROX_LOOKUP_AUTOMATIC.
    pub lookup: LookupNumber,
    /// Number of levels of detail without the body, which is level 0. Level 1 is the finest. Automatic levels count after the first
    /// query that uses them.
    pub level_count: usize,
    /// The part of swiftprox_shape_info.bytes for levels, including their look-up tables once made.
    pub level_bytes: usize,
    /// The part of swiftprox_shape_info.bytes for the shape's table and support maps. The table is made when a query or the making
    /// of levels needs it; maps when an approximate distance does. Those of levels are in level_bytes.
    pub lookup_bytes: usize,
    /// The table's resolution as in swiftprox_shape_tuning; 0 without a table.
    pub lookup_resolution: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for TuningInfo {
    const NAME: &'static str = "swiftprox_shape_tuning_info";
}

impl TuningInfo {
    /// The info of no shape.
    const UNKNOWN: TuningInfo = TuningInfo {
        struct_size: size_of::<TuningInfo>(),
        hierarchy: 0,
        lookup: 0,
        level_count: 0,
        level_bytes: 0,
        lookup_bytes: 0,
        lookup_resolution: 0,
    };
}

/// Writes which levels of detail and look-up table a shape has. Set info->struct_size to sizeof(swiftprox_shape_tuning_info) first.
/// On failure all members are 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_tuning_info(shape: *const Shape, info: *mut TuningInfo) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &TuningInfo::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { handle(shape, "shape") }?;
        let (polyhedron, hierarchy) = (shape.polyhedron(), shape.hierarchy());
        let (lookup, resolution) = match polyhedron.lookup.plan {
            Plan::None | Plan::AllVertices { .. } => (LookupKind::None, 0),
            Plan::Shells { resolution } => (LookupKind::Shells, resolution),
            Plan::Spherical { resolution, .. } => (LookupKind::Spherical, resolution),
        };
        let value = TuningInfo {
            struct_size: size_of::<TuningInfo>(),
            hierarchy: hierarchy.kind as i32,
            lookup: lookup as i32,
            level_count: hierarchy.levels.len(),
            level_bytes: hierarchy.heap_bytes(),
            // What few vertices are looked at in is the shape's own.
            lookup_bytes: match lookup {
                LookupKind::None => 0,
                _ => polyhedron.lookup.heap_bytes() + shape.support_map.table_bytes(),
            },
            lookup_resolution: resolution as u32,
        };
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &value) }
    })
}
