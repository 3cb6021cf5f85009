//! The objects of a scene, for reading.

use std::ops::Range;
use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::compound::Compound;
use crate::ground::Ground;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::object::{Entry, ObjectId, ObjectOptions, ObjectTable};
use crate::scene::world::piece_data::PieceData;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::rows::{Label, grown_box};
use crate::shape::Shape;

/// All of a scene.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Objects<'a> {
    pub table: &'a ObjectTable,
    pub proxies: &'a Proxies,
    pub piece_data: &'a PieceData,
}

impl<'a> Objects<'a> {
    /// The object of an id.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's.
    pub fn get(self, id: ObjectId) -> Result<Object<'a>> {
        self.table.get(id).map(|entry| Object { entry, proxies: self.proxies, piece_data: self.piece_data })
    }

    /// In order of creation.
    pub fn iter(self) -> impl Iterator<Item = Object<'a>> {
        self.proxies.objects().filter_map(move |id| self.get(id).ok())
    }
}

/// One or several convex pieces that move together, a ground or a compound.
#[derive(Debug, Clone, Copy)]
pub struct Object<'a> {
    pub(crate) entry: &'a Entry,
    proxies: &'a Proxies,
    piece_data: &'a PieceData,
}

impl<'a> Object<'a> {
    /// Its id.
    pub fn id(&self) -> ObjectId {
        self.label().object
    }

    /// Its convex pieces, shared, in one local frame; at least one, but none of a ground or a compound. They are never tested
    /// against each other.
    pub fn pieces(&self) -> &'a [Arc<Shape>] {
        let is_whole = self.proxies.bodies.get(self.entry.first_proxy as usize).is_some();
        if is_whole { &[] } else { &self.proxies.shapes[self.entry.proxies()] }
    }

    /// The ground that it is, if it is one.
    pub fn ground(&self) -> Option<&'a Arc<Ground>> {
        self.proxies.bodies.ground(self.entry.first_proxy as usize)
    }

    /// The compound that it is, if it is one.
    pub fn compound(&self) -> Option<&'a Arc<Compound>> {
        self.proxies.bodies.compound(self.entry.first_proxy as usize)
    }

    /// Refuses a piece that it does not have.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub(crate) fn refuse_absent(&self, piece: usize) -> Result<()> {
        match self.pieces().len() {
            0 if self.compound().is_some() => Err(Error::Argument(format!(
                "piece {piece} of an object that is a compound, whose pieces stay as they were made: ask the compound, or add an \
                 object of pieces"
            ))),
            0 => Err(Error::Argument(format!(
                "piece {piece} of an object that is a ground, which has no pieces: ask or set what is the object's"
            ))),
            count if piece >= count => Err(Error::Argument(format!("piece {piece} of an object of {count} pieces"))),
            _ => Ok(()),
        }
    }

    /// Its rows among the proxies.
    pub(crate) fn proxies(&self) -> Range<usize> {
        self.entry.proxies()
    }

    /// The pose of the object.
    pub fn pose(&self) -> &'a Pose {
        match &self.entry.arrangement {
            Some(arrangement) => &arrangement.pose,
            None => &self.proxies.poses[self.entry.first_proxy as usize],
        }
    }

    /// The pose of a piece in the object.
    ///
    /// # Panics
    /// Without such a piece.
    pub fn piece_pose(&self, piece: usize) -> &'a Pose {
        self.check(piece);
        self.piece_poses().get(piece).unwrap_or(&Pose::IDENTITY)
    }

    /// The pose of a piece in the world: the pose for which queries answer.
    ///
    /// # Panics
    /// Without such a piece.
    pub fn piece_pose_in_world(&self, piece: usize) -> Pose {
        self.check(piece);
        self.proxies.poses[self.entry.first_proxy as usize + piece]
    }

    /// The least and the greatest corner of a box along the world's axes that contains the object, swept radii included. It is
    /// wider than the object by less than 10⁻⁵ of the radius and the place of each piece; around a piece of more than 512 vertices
    /// it is the box of its own turned box.
    pub fn world_box(&self) -> [[f64; 3]; 2] {
        let Proxies { shapes, poses, .. } = self.proxies;
        let of_piece = |row: usize| grown_box(&shapes[row], &poses[row], &self.proxies.spheres(row), 0.0);
        let all = self.proxies().map(of_piece).fold(Aabb::NOWHERE, |all, piece| all.union(&piece));
        [all.lower, all.upper].map(|corner| corner.map(f64::from))
    }

    fn check(&self, piece: usize) {
        let count = self.pieces().len();
        assert!(piece < count, "piece {piece} of {count}");
    }

    /// The pose of each piece in the object; none if all are at its origin.
    pub(crate) fn piece_poses(&self) -> &'a [Pose] {
        let of_pieces = self.entry.arrangement.as_ref().filter(|arrangement| arrangement.compound.is_none());
        of_pieces.map_or(&[], |arrangement| &arrangement.piece_poses)
    }

    /// The options it was made with, except the pieces.
    pub(crate) fn options(&self) -> ObjectOptions {
        let Label { fixed, user_data, groups, mask, .. } = *self.label();
        ObjectOptions { pose: *self.pose(), fixed, user_data, groups, mask }
    }

    /// The groups it is in.
    pub fn groups(&self) -> u32 {
        self.label().groups
    }

    /// The groups it is tested against.
    pub fn mask(&self) -> u32 {
        self.label().mask
    }

    /// Whether it is fixed.
    pub fn fixed(&self) -> bool {
        self.label().fixed
    }

    /// The caller's own number.
    pub fn user_data(&self) -> u64 {
        self.label().user_data
    }

    /// The caller's own number of a piece; 0 unless it was set.
    ///
    /// # Panics
    /// Without such a piece.
    pub fn piece_user_data(&self, piece: usize) -> u64 {
        self.check(piece);
        self.piece_data.get(self.id(), piece)
    }

    /// Those of all pieces; none where none was set.
    pub(crate) fn piece_numbers(&self) -> &'a [u64] {
        self.piece_data.of(self.id())
    }

    /// That of its first piece: all are alike, except in the piece's number.
    fn label(&self) -> &'a Label {
        &self.proxies.labels[self.entry.first_proxy as usize]
    }
}
