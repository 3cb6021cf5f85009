//! Pieces where they are: those of a compound, or a single shape, with boxes around them.

use super::PlacedCompound;
use super::body::{Compound, CompoundReach, Piece};
use super::fit::{Fitted, Oriented};
use super::tree::{PieceNode, TreeView};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U};
use crate::pair::Placed;
use crate::shape::Shape;

/// The pieces of a placed body.
#[derive(Clone, Copy)]
pub(crate) struct PlacedPieces<'a> {
    pub(super) tree: TreeView<'a>,
    pub(super) reach: CompoundReach,
    parts: PieceSource<'a>,
    pub(super) pose: &'a Pose,
}

#[derive(Clone, Copy)]
enum PieceSource<'a> {
    Compound(&'a Compound),
    Single(&'a Shape),
}

/// A shape as a compound of one piece, without memory of its own on the heap.
pub(crate) struct SinglePiece<'a> {
    shape: &'a Shape,
    nodes: [PieceNode; 1],
    oriented: [Oriented; 1],
    reach: CompoundReach,
}

impl<'a> SinglePiece<'a> {
    /// With its box along the axes of the body. Deviations belong to it as swept radii do.
    pub fn new(shape: &'a Shape) -> SinglePiece<'a> {
        let (centre, extent) = (shape.polyhedron().centre, shape.extent());
        let (middle, half) = extent.box_about_centre();
        // Vertices and the middle are sums, off by u of the lever.
        let margin = (shape.swept_radius() + shape.deviation()) * (1.0 + 4.0 * U) + 64.0 * U * extent.lever;
        let [x, y, z] = [0, 1, 2].map(|k| centre[k] + middle[k]);
        let [a, b, c] = [0, 1, 2].map(|k| half[k] + margin);
        let fitted = Fitted { centre: [x, y, z, 0.0], half: [a, b, c, 0.0] };
        let axes = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let lever = (extent.lever + margin) * (1.0 + 4.0 * U);
        SinglePiece {
            shape,
            nodes: [PieceNode::leaf(fitted, 0)],
            oriented: [Oriented { fitted, axes }],
            reach: CompoundReach { lever, placing: 0.0, skew: 0.0 },
        }
    }

    /// The shape where `pose` says.
    pub fn at<'b>(&'b self, pose: &'b Pose) -> PlacedPieces<'b> {
        let tree = TreeView { nodes: &self.nodes, oriented: &self.oriented };
        PlacedPieces { tree, reach: self.reach, parts: PieceSource::Single(self.shape), pose }
    }
}

impl<'a> PlacedCompound<'a> {
    /// Its pieces.
    #[inline(always)]
    pub(crate) fn placed_pieces(&self) -> PlacedPieces<'a> {
        let PlacedCompound { compound, pose } = *self;
        PlacedPieces { tree: compound.tree.view(), reach: compound.reach, parts: PieceSource::Compound(compound), pose }
    }
}

impl<'a> PlacedPieces<'a> {
    /// The number of pieces.
    #[inline(always)]
    pub fn count(&self) -> usize {
        match self.parts {
            PieceSource::Compound(compound) => compound.piece_count(),
            PieceSource::Single(_) => 1,
        }
    }

    /// The pieces that are not where the pose takes them, among others; of a single shape none.
    pub(super) fn compound_pieces(&self) -> &'a [Piece] {
        match self.parts {
            PieceSource::Compound(compound) => compound.pieces(),
            PieceSource::Single(_) => &[],
        }
    }

    /// A piece where it is; its pose is made in `room`, unless it is that of the body.
    #[inline(always)]
    pub fn piece<'b>(&self, piece: u32, room: &'b mut Pose) -> Placed<'b>
    where
        'a: 'b,
    {
        let part = match self.parts {
            PieceSource::Compound(compound) => &compound.pieces()[piece as usize],
            PieceSource::Single(shape) => return shape.at(self.pose),
        };
        if self.reach.placing > 0.0 && part.pose != Pose::IDENTITY {
            *room = self.pose.after(&part.pose);
            part.shape.at(room)
        } else {
            part.shape.at(self.pose)
        }
    }
}

/// Two pieces where they are.
#[inline(always)]
pub(crate) fn with_pieces<T>(bodies: &[PlacedPieces; 2], pieces: [u32; 2], work: impl FnOnce([Placed; 2]) -> T) -> T {
    let (mut own1, mut own2) = (Pose::IDENTITY, Pose::IDENTITY);
    work([bodies[0].piece(pieces[0], &mut own1), bodies[1].piece(pieces[1], &mut own2)])
}
