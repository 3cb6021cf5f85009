//! A body in solid convex pieces, within a tolerance.
//!
//! Space is cut into convex cells, as CoACD does (X. Wei et al., "Approximate convex decomposition for 3D meshes with
//! collision-aware concavity and tree search", ACM Transactions on Graphics 41(4), 2022). The hull of the body in a cell is the
//! hull of two kinds of points: corners of the surface's polygons clipped to the cell, and corners of the cell in the body. So
//! no cut is capped, and the surface may have edges of any even number of faces. Where that hull has a point farther from the
//! body than the tolerance the cell is cut. Pieces are joined in the end while their hulls stay within the tolerance.
//!
//! Cuts are heuristic; the promise does not rest on them:
//!
//! 1. the cells fill space, so the pieces hold the body, up to 1e-8 of its size, which rounding of cuts may take;
//! 2. each hull passes [`BodyCheck::point_beyond`](solid_piece::BodyCheck::point_beyond), which errs on the safe side.

mod boundary;
mod surface_tree;
mod cell;
mod solid_piece;
mod cuts;
mod merging;

use crate::base::error::{Error, Result, check_range};
use crate::base::math::Vector;
use crate::base::memory::{collected, in_integers, push, with_capacity};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::mesh::PolygonMesh;
use boundary::SolidBoundary;
use cell::SolidCell;
use cuts::best_cut;
use merging::merge;
use solid_piece::{ALL, BodyCheck, SolidPiece};
use surface_tree::SurfaceTree;

/// The least tolerance: work grows as one over its square.
pub const LEAST_TOLERANCE: f64 = 1e-4;
/// The largest number of pieces before they are joined.
const MOST_PIECES: usize = 2048;

/// Points whose hulls are convex pieces: together they hold the body, up to 1e-8 of the box's diagonal, and no point of them is
/// farther from the body than `tolerance` times the diagonal.
///
/// The body is where the surface winds around a point. Faces that are oriented unlike their neighbours are turned, as the smaller
/// area; edges may have more than two faces.
///
/// # Errors
/// [`Error::Argument`] for a tolerance below [`LEAST_TOLERANCE`] or above 1; [`Error::Mesh`] for a mesh that encloses no
/// volume, for an edge of an odd number of faces, for one around which inside and outside cannot be told, and for a face that
/// crosses itself, with their numbers; [`Error::Limit`] where more than 2,048 cells are needed; [`Error::Cancelled`] when the
/// caller does not want to go on.
pub fn decompose_solid(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Vec<Vec<Vector>>> {
    check_range("tolerance", tolerance, LEAST_TOLERANCE..=1.0)?;
    in_integers(|| with_default(|| decomposed(mesh, tolerance, progress)))?
}

fn decomposed(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Vec<Vec<Vector>>> {
    let surface = SolidBoundary::new(mesh, &mut progress.part(0.0, 0.05))?;
    let tree = SurfaceTree::new(&surface.triangles)?;
    // Rounding of a distance is far below a part in 2⁴⁰.
    let length = tolerance * surface.frame.diagonal * (1.0 - f64::from(f32::EPSILON));
    let mut check = BodyCheck { tree: &tree, tolerance: length, done: 0 };
    let root = SolidCell::around(&surface)?;
    let pieces = pieces_of_cells(root, &mut check, &mut progress.part(0.05, 0.6)).map_err(|error| match error {
        Error::Limit(message) => Error::Limit(format!("tolerance is {tolerance:?}: {message}")),
        other => other,
    })?;
    let pieces = merge(pieces, &mut check, &mut progress.part(0.6, 1.0))?;
    let mut points = with_capacity(pieces.len())?;
    for piece in &pieces {
        points.push(collected(piece.corners.iter().map(|p| surface.frame.original(p)))?);
    }
    progress.report(1.0)?;
    Ok(points)
}

/// Cells are cut until the hull of the body in each is within the tolerance.
fn pieces_of_cells(root: SolidCell, check: &mut BodyCheck, progress: &mut Progress) -> Result<Vec<SolidPiece>> {
    let mut pieces = Vec::new();
    // Each with its share of the work.
    let mut open = Vec::new();
    push(&mut open, (root, ALL))?;
    while let Some((cell, share)) = open.pop() {
        progress.steps(64 * cell.surface.len(), check.done, ALL)?;
        let piece = SolidPiece::new(&cell.points()?)?;
        let beyond = match &piece {
            Some(piece) if !piece.is_bounded_by(&cell.surface, check.tree) => {
                check.point_beyond(piece, &[], progress)?
            }
            _ => None,
        };
        match (piece, beyond) {
            (Some(piece), Some(beyond)) => {
                if pieces.len() + open.len() >= MOST_PIECES {
                    return Err(Error::Limit(format!(
                        "more than {MOST_PIECES} cells are needed; a larger one needs fewer"
                    )));
                }
                let plane = best_cut(&cell, &piece, &beyond, check)?;
                let [below, above] = cell.cut(&plane, check.tree)?;
                push(&mut open, (below, share / 2))?;
                push(&mut open, (above, share - share / 2))?;
            }
            (piece, _) => {
                check.done += share;
                piece.map_or(Ok(()), |piece| push(&mut pieces, piece))?;
            }
        }
    }
    Ok(pieces)
}
