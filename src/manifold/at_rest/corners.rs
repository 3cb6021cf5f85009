//! The corners of a patch, in fours.

use crate::answer::{Feature, FeatureKind};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::fan::PointBlock;
use crate::manifold::patch::{Facing, Patch};

/// Corners of a patch: a mask has this many bits.
pub const MOST: usize = 32;

/// The corners of a patch.
pub struct PatchCorners<'a> {
    pub polyhedron: &'a Polyhedron,
    pub patch: Patch,
    /// The plane, positive outside.
    pub normal: &'a Vector,
    pub offset: f64,
    /// By how much the plane of a merged face may be above its corners, which are exact.
    pub slack: f64,
    /// How far the plane and the corners of a contact face are from its body, at most.
    pub thickness: f64,
    pub blocks: &'a [PointBlock],
    pub vertices: &'a [[u32; 4]],
    pub count: usize,
}

/// Room for the corners of a face of a body that has no outlines.
pub struct FourCorners {
    pub block: [PointBlock; 1],
    pub vertices: [[u32; 4]; 1],
}

impl FourCorners {
    pub const NONE: FourCorners =
        FourCorners { block: [PointBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4] }], vertices: [[0; 4]] };

    #[cold]
    pub fn fill(&mut self, polyhedron: &Polyhedron, face: u32, count: usize) {
        let ([block], [vertices]) = (&mut self.block, &mut self.vertices);
        for (lane, vertex) in vertices.iter_mut().enumerate() {
            *vertex = polyhedron.corner(face, lane.min(count - 1) as u32);
            let position = polyhedron.vertices[*vertex as usize].position;
            (block.x[lane], block.y[lane], block.z[lane]) = (position.x, position.y, position.z);
        }
    }
}

impl<'a> PatchCorners<'a> {
    /// `None` of patches of many corners, of flat bodies, and of large ones' that have more than four.
    #[inline(always)]
    pub fn of(
        polyhedron: &'a Polyhedron,
        facing: Option<Facing>,
        room: &'a mut FourCorners,
    ) -> Option<PatchCorners<'a>> {
        let patch = facing?.patch;
        let (count, normal) = (patch.corner_count(polyhedron), patch.normal(polyhedron));
        let (mut blocks, mut vertices) = polyhedron.outlines.corners(patch.number(polyhedron));
        if let Patch::Merged(face) = patch
            && polyhedron.outlines.is_empty()
            && polyhedron.outlines.shortest > 0.0
            && count <= 4
        {
            room.fill(polyhedron, face, count);
            (blocks, vertices) = (&room.block, &room.vertices);
        }
        let (offset, slack, thickness) = match patch {
            Patch::Merged(face) => {
                let record = &polyhedron.faces[face as usize];
                (record.planes.offset[0], record.slack, 0.0)
            }
            Patch::Contact(face) => {
                let record = &polyhedron.contact_faces.faces[face as usize];
                // R makes nothing longer than by 30u, or as [`Seen::stretch`] has it.
                (-record.middle, 0.0, record.slack * (1.0 + 64.0 * U))
            }
        };
        let fits = count <= MOST && blocks.len() == count.div_ceil(4) && vertices.len() == blocks.len();
        fits.then_some(PatchCorners { polyhedron, patch, normal, offset, slack, thickness, blocks, vertices, count })
    }

    /// The plane of a side, inside positive.
    #[inline(always)]
    pub fn side_plane(&self, side: usize) -> [f64; 4] {
        match self.patch {
            Patch::Merged(face) => self.polyhedron.side_plane(&self.polyhedron.faces[face as usize], side),
            Patch::Contact(face) => {
                self.polyhedron.outlines.contact_side(self.polyhedron.faces.len() as u32, face, side)
            }
        }
    }

    pub fn all(&self) -> u32 {
        u32::MAX >> (MOST - self.count)
    }

    pub fn next(&self, corner: usize) -> usize {
        if corner + 1 < self.count { corner + 1 } else { 0 }
    }

    pub fn vertex(&self, corner: usize) -> u32 {
        self.vertices[corner / 4][corner % 4]
    }

    /// On the plane of a contact face.
    pub fn position(&self, corner: usize) -> Vector {
        let (block, lane) = (&self.blocks[corner / 4], corner % 4);
        Vector::new(block.x[lane], block.y[lane], block.z[lane])
    }

    /// The bit of each corner's next one in its place.
    pub fn next_of_all(&self, corners: u32) -> u32 {
        corners >> 1 | (corners & 1) << (self.count - 1)
    }

    pub fn side_label(&self, side: usize) -> Feature {
        let label = |corner: usize| self.polyhedron.vertex_labels[self.vertex(corner) as usize];
        let ids = match self.patch {
            Patch::Merged(face) => {
                let edge = self.polyhedron.side(&self.polyhedron.faces[face as usize], side as u32);
                self.polyhedron.edges[edge as usize].labels
            }
            Patch::Contact(_) => [label(side), label(self.next(side))],
        };
        Feature { kind: FeatureKind::Edge, ids }
    }
}
