//! A surface in convex pieces (S. A. Ehmann & M. C. Lin, "Accurate and fast proximity queries between polyhedra using convex
//! surface decomposition", Computer Graphics Forum 20(3), 2001, section 3): patches grown over neighbouring triangles, and the
//! convex hull of each is a piece.
//!
//! A patch grows by a triangle if
//!
//! 1. all its triangles stay on the boundary of its hull: no vertex lies above the plane of a triangle, and
//! 2. nothing else of the surface passes through the inside of the hull.
//!
//! For a closed surface the hull is therefore inside of the body: next to the patch it is, and the surface does not cut it. So
//! the pieces of bodies that are apart are as far apart as the surfaces. Where a surface has no inside (it is open, or a cavity)
//! its patches are flat, and the hull is a part of the surface itself.
//!
//! Both tests are exact for a tolerance of 0. Otherwise any point closer to a plane than the tolerance counts as on it: for
//! coordinates that were rounded. [`solid`] fills the body instead.

mod triangulation;
mod surface;
mod separation;
mod patch;
pub mod solid;

use crate::base::error::{Result, check_range};
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, filled, in_integers, push, with_capacity};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::mesh::PolygonMesh;
use patch::PatchGrowth;
use surface::MeshSurface;

/// The triangles of a surface, piece by piece.
#[derive(Debug, Clone, PartialEq)]
pub struct Decomposition {
    /// Corners as the caller's vertices (of exactly equal ones the first), counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The caller's face that each triangle is a part of.
    pub faces: Vec<u32>,
    /// Piece `k` owns the triangles from `starts[k]` to before `starts[k + 1]`; one more entry than pieces.
    pub starts: Vec<u32>,
}

impl Decomposition {
    /// The number of pieces.
    pub fn piece_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The triangles of piece `k`.
    pub fn piece(&self, k: usize) -> &[[u32; 3]] {
        debug_assert!(k < self.piece_count());
        debug_assert!(k < self.piece_count());
        &self.triangles[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

/// Decomposes the surface of a mesh, which may be in several parts and need not be convex. `tolerance` is relative to the
/// bounding box's diagonal: a point that close to a plane counts as on it, so that a piece may be that far beyond the surface.
///
/// Faces of more than three corners are cut into triangles; they may be non-convex, and are to be flat about. A face whose
/// corners are on one line, or equal, vanishes. A surface whose closed parts are all inside out is turned.
///
/// # Errors
/// [`crate::base::error::Error::Argument`] for a tolerance out of range; [`crate::base::error::Error::Mesh`] for a mesh without
/// faces that have an area, for an edge of more than two faces or of two in the same direction, and for a face that crosses
/// itself, with their numbers; [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
pub fn decompose(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Decomposition> {
    in_integers(|| with_default(|| decomposed(mesh, tolerance, progress)))?
}

fn decomposed(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Decomposition> {
    check_range("tolerance", tolerance, 0.0..=1.0)?;
    let margin = if tolerance == 0.0 { 0.0 } else { (tolerance * diagonal(&mesh.vertices)).min(f64::MAX) };
    let surface = MeshSurface::new(mesh, margin, &mut progress.part(0.0, 0.1))?;
    let progress = &mut progress.part(0.1, 1.0);
    let count = surface.triangles.len();
    let mut growth = PatchGrowth::new(&surface)?;
    let mut decomposition =
        Decomposition { triangles: with_capacity(count)?, faces: with_capacity(count)?, starts: filled(0, 1)? };
    // Triangles without area come into the patches around them, as a rule.
    let has_area = |t: &u32| surface.doubled_area(*t as usize) > 0.0;
    let mut seeds: Vec<u32> = collected(0..count as u32)?;
    seeds.sort_by_key(|t| !has_area(t));
    for seed in seeds {
        if growth.is_taken(seed) {
            continue;
        }
        let patch = growth.grow(seed, decomposition.triangles.len(), progress)?;
        extend(&mut decomposition.triangles, patch.iter().map(|t| surface.triangles[*t as usize]))?;
        extend(&mut decomposition.faces, patch.iter().map(|t| surface.faces[*t as usize]))?;
        push(&mut decomposition.starts, decomposition.triangles.len() as u32)?;
    }
    Ok(decomposition)
}

/// The diagonal of the bounding box; halves, so that no finite coordinate overflows.
fn diagonal(points: &[Vector]) -> f64 {
    let mut bounds = [Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)];
    for point in points {
        bounds = [bounds[0].inf(point), bounds[1].sup(point)];
    }
    2.0 * (0.5 * bounds[1] - 0.5 * bounds[0]).norm()
}
