//! Levels of detail and look-up tables: how they are made, how queries use them, and what a shape has of them.

use std::mem::MaybeUninit;

use super::enumerators::{HierarchyNumber, LevelsNumber, LookupNumber, RefinementNumber, StartNumber, read_enumerator};
use super::failure::{Checked, StatusCode};
use super::guard::guard;
use super::pointers::input;
use super::structs::{Versioned, read_struct, view_struct, write_struct};
use crate::levels::hierarchy::{HierarchyKind, HierarchyOptions};
use crate::pair::{Levels, PairConfig, Refinement, Start};
use crate::polyhedron::lookup::Plan;
use crate::shape::Shape;
use crate::tables::{LookupKind, LookupOptions};

// --- How shapes are made -------------------------------------------------------------------------------------------------

/// Which levels of detail and which look-up table a shape is made with, for swiftprox_shape_options.tuning. Begin with
/// SWIFTPROX_SHAPE_TUNING_DEFAULT, then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CShapeTuning {
    /// Set by SWIFTPROX_SHAPE_TUNING_DEFAULT.
    pub struct_size: usize,
    /// How levels of detail are made. Default: automatic.
    pub hierarchy: HierarchyNumber,
    /// Which table says where a query starts when the last one of the pair tells nothing. It is made by the first query that looks
    /// into it: less than a quarter of the time that making the shape took. A body smaller than 2^-200 or larger than 2^200 has
    /// none. Default: automatic.
    pub lookup: LookupNumber,
    /// The fraction of the triangles that a level has left of those of the next finer one, between 0 and 1, both exclusive; less
    /// where that many would have more features than faces of many corners have. Default: 0.25. This and the two that follow
    /// do not count for automatic levels.
    pub decimation: f64,
    /// No level has fewer triangles. Default: 50.
    pub minimum_triangles: usize,
    /// No more levels than these. Default: 32.
    pub most_levels: usize,
    /// Radius of the sphere of a spherical table's sample points as a multiple of the body's radius, at least 1. Default: 2.
    pub lookup_radius_factor: f64,
    /// Resolution of the table: of shells, cells along a side of the square that all directions are mapped to, a power of two
    /// from 4 to 512; of a spherical table, increments from pole to pole, 2 to 512 (32, 16, 8: 5.625, 11.25, 22.5 degrees).
    /// Default: 0, which means what the number of vertices asks for, or 32.
    pub lookup_resolution: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CShapeTuning {
    const NAME: &'static str = "swiftprox_shape_tuning";
}

impl CShapeTuning {
    /// What the header calls its default.
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

/// Where queries start and which levels of detail they go through, for swiftprox_pair_config.tuning and
/// swiftprox_scene_query.tuning. It changes how fast an answer comes, never the verdict. Begin with SWIFTPROX_PAIR_TUNING_DEFAULT,
/// then change what should differ.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct CPairTuning {
    /// Set by SWIFTPROX_PAIR_TUNING_DEFAULT.
    pub struct_size: usize,
    /// Where marching starts. Default: the automatic choice.
    pub start: StartNumber,
    /// Which levels of detail queries go through. Default: the automatic choice.
    pub levels: LevelsNumber,
    /// How they go from level to level. Default: the adaptive way.
    pub refinement: RefinementNumber,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for CPairTuning {
    const NAME: &'static str = "swiftprox_pair_tuning";
}

impl CPairTuning {
    /// What the header calls its default.
    pub const DEFAULT: CPairTuning = CPairTuning {
        struct_size: size_of::<CPairTuning>(),
        start: Start::Automatic as i32,
        levels: Levels::Automatic as i32,
        refinement: Refinement::Adaptive as i32,
    };
}

/// Where queries start and what levels they go through, in Rust's terms.
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

/// Which levels of detail and which look-up table a shape has. Set struct_size to sizeof(swiftprox_shape_tuning_info) before asking
/// for it.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct TuningInfo {
    /// Set by the caller.
    pub struct_size: usize,
    /// How the levels of detail are made.
    pub hierarchy: HierarchyNumber,
    /// The look-up table that the shape has, never SWIFTPROX_LOOKUP_AUTOMATIC.
    pub lookup: LookupNumber,
    /// The number of levels of detail, the body itself not counted; they are numbered from 1, the finest, on, and the body is
    /// level 0. Automatic ones are made by the first query that goes through them: 0 until then.
    pub level_count: usize,
    /// Of swiftprox_shape_info.bytes, what the levels take, with their look-up tables once queries have made these.
    pub level_bytes: usize,
    /// Of swiftprox_shape_info.bytes, what the table takes, and maps of the support function: 0 until a query, or the making of
    /// levels, looks into the table, which makes it; of maps until an approximate distance does. Those of levels are the levels'.
    pub lookup_bytes: usize,
    /// The table's resolution, as in swiftprox_shape_tuning; 0 without one.
    pub lookup_resolution: u32,
}

// SAFETY: repr(C), struct_size first, any bytes are valid.
unsafe impl Versioned for TuningInfo {
    const NAME: &'static str = "swiftprox_shape_tuning_info";
}

impl TuningInfo {
    /// What is said of no shape.
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

/// Says which levels of detail and which look-up table a shape has: set info->struct_size to sizeof(swiftprox_shape_tuning_info)
/// first. On failure all is 0.
///
/// SWIFTPROX_ERROR_NULL_POINTER: shape or info is null. SWIFTPROX_ERROR_STRUCT_SIZE: info->struct_size is unknown.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn swiftprox_shape_get_tuning_info(shape: *const Shape, info: *mut TuningInfo) -> StatusCode {
    guard(|| {
        // SAFETY: the header's pointer rules.
        unsafe { write_struct(info, "info", &TuningInfo::UNKNOWN) }?;
        // SAFETY: the header's pointer rules.
        let shape = unsafe { input(shape, "shape") }?;
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
