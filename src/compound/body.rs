//! A compound: its pieces and the tree over them.

use std::sync::{Arc, OnceLock};

use super::fit::Fitted;
use super::tree::{Leaf, PieceTree};
use crate::base::error::{Error, Result, check_range};
use crate::base::mark::Mark;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, length};
use crate::base::memory::{collected, copied, push, with_capacity};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::decomposition::decompose;
use crate::body::decomposition::solid::decompose_solid;
use crate::body::mesh::PolygonMesh;
use crate::shape::{InputPolicy, Shape, ShapeOptions};

/// The largest number of pieces.
const MOST_PIECES: usize = 1 << 20;

/// A piece of a compound.
#[derive(Debug, Clone)]
pub struct Piece {
    /// Its geometry.
    pub shape: Arc<Shape>,
    /// Its pose in the compound.
    pub pose: Pose,
}

/// A body of several convex pieces: their union. Immutable, shared by any number of owners.
///
/// A piece at the identity is exactly where the pose of the compound takes it. Any other is at the product of both poses, each
/// number rounded, as pieces of an object in a scene are.
#[derive(Debug, Clone)]
pub struct Compound {
    pieces: Vec<Piece>,
    pub(super) tree: PieceTree,
    pub(super) reach: CompoundReach,
    /// A box around it, for scenes; made when one needs it.
    around: OnceLock<Arc<Shape>>,
    pub(crate) mark: Mark,
}

/// How far the pieces reach, whatever the pose; rounded up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CompoundReach {
    /// No point of the compound, swept radii included, is farther from its origin.
    pub lever: f64,
    /// The lengths that go into the places of pieces that are not at the identity, at most; 0 where all are.
    pub placing: f64,
    /// The largest entry of |RᵀR − I| of a piece's pose.
    pub skew: f64,
}

impl Compound {
    /// From pieces, which may overlap.
    ///
    /// # Errors
    /// [`Error::Argument`] without pieces, [`Error::Limit`] for more than 2²⁰, [`Error::Pose`] for a pose that no query accepts,
    /// with the number of the piece; [`Error::Memory`].
    pub fn new(pieces: &[Piece]) -> Result<Compound> {
        with_default(|| Compound::of_pieces(collected(pieces.iter().cloned())?))
    }

    /// Of one shape at a place, which may be a curved one.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub(crate) fn of_single(shape: Arc<Shape>, pose: Pose) -> Result<Compound> {
        Compound::of_checked(collected([Piece { shape, pose }])?)
    }

    /// From the convex pieces of a mesh. With a `tolerance` of 0 they are those into which [`decompose`] cuts its surface: vertices
    /// keep the mesh's numbers, and so do triangles where faces are triangles; a body wholly inside the mesh may touch no piece.
    /// Otherwise they are solid, as by [`decompose_solid`]: they hold the body and reach beyond it by at most `tolerance` times the
    /// diagonal of its box.
    ///
    /// # Errors
    /// Same as [`decompose`] or [`decompose_solid`], and [`Shape::from_mesh`].
    pub fn from_mesh(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Compound> {
        check_range("tolerance", tolerance, 0.0..=1.0)?;
        if tolerance > 0.0 {
            return Compound::solid(mesh, tolerance, progress);
        }
        let found = decompose(mesh, 0.0, &mut progress.part(0.0, 0.5))?;
        let options = ShapeOptions { input: InputPolicy::Patch, ..ShapeOptions::default() };
        Compound::of_shapes(found.piece_count(), &mut progress.part(0.5, 1.0), |k| {
            let corners = collected(found.piece(k).iter().copied().flatten())?;
            Shape::from_mesh(&PolygonMesh::new(copied(&mesh.vertices)?, corners, None)?, &options)
        })
    }

    fn solid(mesh: &PolygonMesh, tolerance: f64, progress: &mut Progress) -> Result<Compound> {
        let pieces = decompose_solid(mesh, tolerance, &mut progress.part(0.0, 0.9))?;
        Compound::of_shapes(pieces.len(), &mut progress.part(0.9, 1.0), |k| {
            Shape::from_points(&pieces[k], &ShapeOptions::default())
        })
    }

    fn of_shapes(count: usize, progress: &mut Progress, shape: impl Fn(usize) -> Result<Shape>) -> Result<Compound> {
        let mut pieces = with_capacity(count)?;
        for k in 0..count {
            progress.report(k as f64 / count as f64)?;
            let shape = shape(k).map_err(|error| error.about(&format!("piece {k}")))?;
            push(&mut pieces, Piece { shape: Arc::new(shape), pose: Pose::IDENTITY })?;
        }
        progress.report(1.0)?;
        with_default(|| Compound::of_pieces(pieces))
    }

    fn of_pieces(pieces: Vec<Piece>) -> Result<Compound> {
        if pieces.is_empty() {
            return Err(Error::Argument("a compound needs at least one piece".into()));
        }
        if pieces.len() > MOST_PIECES {
            return Err(Error::Limit(format!("{} pieces, more than the limit of {MOST_PIECES}", pieces.len())));
        }
        for (k, piece) in pieces.iter().enumerate() {
            let sound = piece.pose.check().and_then(|()| piece.shape.refuse_deviation("compounds"));
            sound.map_err(|error| error.about(&format!("piece {k}")))?;
        }
        Compound::of_checked(pieces)
    }

    fn of_checked(pieces: Vec<Piece>) -> Result<Compound> {
        let mut points: Vec<Vec<Vector>> = with_capacity(pieces.len())?;
        for Piece { shape, pose } in &pieces {
            let vertices = (0..shape.polyhedron().vertices.len() as u32).map(|v| shape.polyhedron().local_position(v));
            let is_placed = *pose != Pose::IDENTITY;
            points.push(collected(vertices.map(|point| if is_placed { pose.transform(&point) } else { point }))?);
        }
        let mut reach = CompoundReach { lever: 0.0, placing: 0.0, skew: 0.0 };
        let mut leaves = with_capacity(pieces.len())?;
        for (piece, points) in pieces.iter().zip(&points) {
            // A vertex is centre + position, off by u of that. R·v + T is off by 8u·(|R||v| + |T|), ‖|R|‖ ≤ √3·1.015.
            let lengths = 2.0 * piece.shape.extent().lever + piece.pose.translation().lp_norm(1);
            let swept = (piece.shape.swept_radius() + piece.shape.deviation()) * (1.0 + 4.0 * U);
            let farthest = points.iter().map(length).fold(0.0, f64::max) * (1.0 + 8.0 * U);
            let margin = swept + 32.0 * U * lengths;
            leaves.push(Leaf { points, margin, reach: farthest, shape: &piece.shape });
            reach.lever = reach.lever.max((farthest + margin) * (1.0 + 4.0 * U));
            if piece.pose != Pose::IDENTITY {
                reach.skew = reach.skew.max(piece.pose.rotation_defect());
                reach.placing = reach.placing.max(lengths);
            }
        }
        let tree = PieceTree::new(&leaves)?;
        drop(leaves);
        Ok(Compound { pieces, tree, reach, around: OnceLock::new(), mark: Mark::new() })
    }

    /// Its pieces.
    #[inline(always)]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// The number of its pieces.
    #[inline(always)]
    pub fn piece_count(&self) -> usize {
        self.pieces.len()
    }

    /// The boxes of its tree so many levels below the root, for pictures: the middle and half of three edges of each.
    ///
    /// # Errors
    /// [`Error::Memory`].
    #[doc(hidden)]
    pub fn tree_boxes(&self, level: usize) -> Result<Vec<[Vector; 4]>> {
        self.tree.boxes(level)
    }

    /// Memory held, in bytes; shapes do not count: others share them.
    pub fn bytes(&self) -> usize {
        size_of::<Compound>() + size_of_val(&self.pieces[..]) + self.tree.heap_bytes()
    }

    /// Whether a piece is not at the identity.
    #[inline(always)]
    pub(crate) fn has_placed_pieces(&self) -> bool {
        self.reach.placing > 0.0
    }

    /// A box around it as a shape, one for all scenes.
    ///
    /// # Errors
    /// [`Error::Argument`] for a compound that reaches beyond 2¹⁰⁰⁰; [`Error::Memory`].
    pub(crate) fn surrounding(&self) -> Result<Arc<Shape>> {
        if let Some(around) = self.around.get() {
            return Ok(around.clone());
        }
        let Fitted { centre, half } = self.tree.nodes[0].fitted;
        // Ends are rounded: by u of the lever.
        let end = |sign: f64| Vector::from_fn(|k, _| centre[k] + sign * (half[k] + 4.0 * U * self.reach.lever));
        let around = Arc::new(Shape::surrounding(&[end(-1.0), end(1.0)], self.reach.lever)?);
        Ok(self.around.get_or_init(|| around).clone())
    }
}
