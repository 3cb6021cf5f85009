//! The points that two patches have in common: the corners of one are slid along the normal onto the plane of the other, in the
//! axes of its body, and compared with its sides, as bits. So are those of the other, where any is needed. For a pair at rest the
//! facet of before proves the depth first.
//!
//! A corner on a side counts as inside, and no side crosses where it ends: so equal faces in line have their corners in common.
//! Many corners, corners nearly on a side and witness points that no corner is as deep as are left to
//! [the sweep](super::clip).

use super::answer::{FOUR, Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, Reference};
use super::id::id_of;
use super::outline::STEEPEST;
use super::patch::{COINCIDENT, Facing, PARALLEL, Patch, Patches, STICKY, STICKY_INCIDENT, choose, facing};
use super::places::{key_of_crossing, key_of_vertex};
use super::reduction::{Place, four_of};
use super::sink::Sink;
use super::steady::is_thin;
use super::witness::push_witness;
use crate::answer::{Feature, FeatureKind, Outcome};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Kernel, Lanes, Work};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::fan::PointBlock;
use crate::depth::facets::{Facet, Proved};
use crate::depth::polytope::is_in_scale;
use crate::depth::prove_at_rest;
use crate::pair::{SignedDistance, fill_at_rest};
use crate::placed::Pair;
use crate::placed::frame::Frame;
use crate::shape::Placed;

/// Corners of a patch: a mask has this many bits.
const MOST: usize = 32;

/// Room for patches of so many fours of corners: of boxes, of hulls, and of all. It is zeroed, and all of it takes as long as the
/// rest of a query.
const ONE: usize = 1;
const FEW: usize = 2;
const MANY: usize = MOST / 4;

/// Within this many times what counts as one place, the sweep takes two corners for one.
const DOUBT: f64 = 4.0;

/// Corners nearer to a side than this part of what is too near to tell are on it: a quarter of what the sweep makes one.
const ON: f64 = 0.0625;

/// The query of a pair that may rest.
pub struct AtRest<'a, 'b> {
    pub bodies: &'a [Placed<'a>; 2],
    pub cache: &'a mut ManifoldCache,
    pub config: &'a ManifoldConfig,
    pub points: &'a mut Sink<'b>,
    /// Filled where a facet proves the depth, if it is asked for or the points are not found.
    pub contact: &'a mut SignedDistance,
    pub is_asked: bool,
}

/// The part of a query that is answered.
pub enum Answered {
    Nothing,
    /// The signed distance.
    Contact,
    /// All.
    Whole(Manifold),
}

impl Kernel for AtRest<'_, '_> {
    type Output = Answered;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Answered {
        let [body1, body2] = self.bodies;
        let polyhedra = [body1.shape.polyhedron(), body2.shape.polyhedron()];
        let frame = Frame::<L>::new(&Pair { polyhedra, poses: [body1.pose, body2.pose] });
        if !(frame.in_range && is_in_scale(polyhedra)) {
            return Answered::Nothing;
        }
        let depth = self.cache.signed_distance.depth_mut();
        let Some(proved) = prove_at_rest(&frame, depth) else { return Answered::Nothing };
        let mut answer = Manifold {
            outcome: Outcome::Intersecting,
            reference: 0,
            lower: -proved.upper,
            upper: -proved.lower,
            normal: [0.0; 3],
            point_count: 1,
            found_count: 1,
        };
        proved.direction.negate().store_vector(&mut answer.normal);
        // Edges that cross mostly have no patch to clip.
        if let Facet::Edges(_) = proved.facet
            && is_steep(&frame, 0, proved.direction)
            && is_steep(&frame, 1, proved.direction.negate())
        {
            fill_at_rest(self.contact, &frame, &proved);
            self.cache.reference = Reference::NONE;
            push_witness(polyhedra, self.contact, self.points);
            answer.point_count = self.points.written as u32;
            return Answered::Whole(answer);
        }
        // In no closure: that would be compiled without vector units (R2).
        let found = match choose_patches(self.bodies, &frame, &proved, &self.cache.reference) {
            Some(patches) => {
                let along = ContactNormal { direction: proved.direction, upper: answer.upper };
                let reference = &mut self.cache.reference;
                Writing { reference, config: self.config, points: self.points }.clip(&frame, &along, &patches)
            }
            None => None,
        };
        if self.is_asked || found.is_none_or(|found| found == 0) {
            fill_at_rest(self.contact, &frame, &proved);
        }
        let Some(found) = found else { return Answered::Contact };
        if found == 0 {
            push_witness(polyhedra, self.contact, self.points);
            answer.point_count = self.points.written as u32;
            return Answered::Whole(answer);
        }
        answer.reference = self.cache.reference.body;
        (answer.point_count, answer.found_count) = (self.points.written as u32, found as u32);
        Answered::Whole(answer)
    }
}

/// The patches that face each other along a facet's normal: mostly those of before.
#[inline(always)]
fn choose_patches<L: Lanes>(
    bodies: &[Placed; 2],
    frame: &Frame<L>,
    proved: &Proved<L>,
    last: &Reference,
) -> Option<Patches> {
    choose([patch_of(bodies, frame, proved, last, 0), patch_of(bodies, frame, proved, last, 1)], last)
}

#[inline(always)]
fn patch_of<L: Lanes>(
    bodies: &[Placed; 2],
    frame: &Frame<L>,
    proved: &Proved<L>,
    last: &Reference,
    i: usize,
) -> Option<Facing> {
    let towards = if i == 0 { proved.direction } else { proved.direction.negate() };
    let polyhedron = frame.bodies[i].polyhedron;
    let sticky = if last.body == i as u32 + 1 { STICKY } else { STICKY_INCIDENT };
    let known = (1..=2).contains(&last.body).then_some(last.patches[i]);
    if let Some(patch) = known.and_then(|number| Patch::of_number(polyhedron, number)) {
        let parallel = L::from_vector(patch.normal(polyhedron)).dot(frame.bodies[i].rotate_back(towards));
        // No normal is longer than 1, nor R·normal, up to 40u.
        let is_parallel = parallel >= 1.0 + 64.0 * U - sticky;
        if is_parallel || most_parallel(frame, i, towards).is_some_and(|most| parallel >= most - sticky) {
            return Some(Facing { patch, parallel });
        }
    }
    let witness = proved.points[i].to_vector() + polyhedron.centre;
    facing(bodies[i], &towards.to_vector(), &witness, known, sticky)
}

/// The cosine between a direction in the world and the normal of a body that is the most parallel to it, where they are in a fan.
#[inline(always)]
fn most_parallel<L: Lanes>(frame: &Frame<L>, i: usize, towards: L) -> Option<f64> {
    let polyhedron = frame.bodies[i].polyhedron;
    let fan = polyhedron.fan.as_ref().filter(|_| polyhedron.contact_faces.faces.is_empty())?;
    let along = frame.bodies[i].rotate_back(towards);
    let [x, y, z] = [along.splat_x(), along.splat_y(), along.splat_z()];
    let mut most = L::splat(-1.0);
    for block in &fan.planes {
        let cosine = x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))));
        most = most.max(cosine);
    }
    Some(-most.negate().least().0)
}

/// Whether no face of a body is nearly across a direction.
#[inline(always)]
fn is_steep<L: Lanes>(frame: &Frame<L>, i: usize, towards: L) -> bool {
    most_parallel(frame, i, towards).is_some_and(|most| most < PARALLEL)
}

/// The query of a pair whose contact and patches are known. (Thin bodies have their points named by the sweep.)
pub struct Clipping<'a, 'b, 'c> {
    pub bodies: &'a [Placed<'a>; 2],
    pub contact: &'a SignedDistance,
    pub patches: &'a Patches,
    pub writing: &'a mut Writing<'b, 'c>,
}

impl Kernel for Clipping<'_, '_, '_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<usize> {
        let [body1, body2] = self.bodies;
        let polyhedra = [body1.shape.polyhedron(), body2.shape.polyhedron()];
        let frame = Frame::<L>::new(&Pair { polyhedra, poses: [body1.pose, body2.pose] });
        if !(frame.in_range && is_in_scale(polyhedra)) || is_thin(polyhedra[0]) || is_thin(polyhedra[1]) {
            return None;
        }
        let direction = L::from_vector(&self.contact.normal.into()).negate();
        let along = ContactNormal { direction, upper: self.contact.upper };
        self.writing.clip(&frame, &along, self.patches)
    }
}

/// The normal of a contact.
pub struct ContactNormal<L> {
    /// The unit vector out of body 1.
    direction: L,
    /// The distance along it is at most this.
    upper: f64,
}

/// The destination of the points, and how many are wanted.
pub struct Writing<'a, 'b> {
    /// That of before, which is replaced where points are written.
    pub reference: &'a mut Reference,
    pub config: &'a ManifoldConfig,
    pub points: &'a mut Sink<'b>,
}

/// The corners of a patch on the plane of the other body's, seen along the normal.
struct Slid<const F: usize> {
    /// In the axes of the plane's body.
    x: [[f64; 4]; F],
    y: [[f64; 4]; F],
    z: [[f64; 4]; F],
    /// How far they were over the plane.
    gaps: [[f64; 4]; F],
    /// For each side of the plane's face the corners that are outside of it, and those on it.
    sides: [[SideMasks; 4]; F],
    /// The corners outside of any, on any, and on more than one.
    of_any: u32,
    on_any: u32,
    on_more: u32,
    /// Those at a corner of the plane's face.
    at_corners: u32,
    /// One over the cosine between the plane's normal and the contact's.
    stretch: f64,
}

/// The corners of one patch beside a side of the other, as bits.
#[derive(Clone, Copy)]
struct SideMasks {
    outside: u32,
    /// Nearer to its line than corners that are one.
    on: u32,
}

impl<const F: usize> Slid<F> {
    const NONE: Slid<F> = Slid {
        x: [[0.0; 4]; F],
        y: [[0.0; 4]; F],
        z: [[0.0; 4]; F],
        gaps: [[0.0; 4]; F],
        sides: [[SideMasks { outside: 0, on: 0 }; 4]; F],
        of_any: 0,
        on_any: 0,
        on_more: 0,
        at_corners: 0,
        stretch: 0.0,
    };

    /// `None` where a corner is as near to a side as `doubt` and not on it, or the plane too steep. `out`: along the normal out of
    /// the plane's body.
    #[inline(always)]
    fn fill<L: Lanes>(
        &mut self,
        frame: &Frame<L>,
        (body, plane): (usize, &PatchCorners),
        corners: &PatchCorners,
        out: L,
        doubt: f64,
    ) -> Option<()> {
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let (normal, towards) = (L::from_vector(plane.normal), own.turn_back(out));
        let cosine = normal.dot(towards);
        if !(cosine > STEEPEST) {
            return None;
        }
        self.stretch = 1.0 / cosine;
        let [x, y, z] = other.columns();
        let columns = [own.turn_back(x), own.turn_back(y), own.turn_back(z), own.turn_back(other.offset)];
        let per = self.stretch;
        let gap = [
            normal.dot(columns[0]) * per,
            normal.dot(columns[1]) * per,
            normal.dot(columns[2]) * per,
            (normal.dot(columns[3]) + plane.offset) * per,
        ];
        let (mut rows, mut gaps) = ([[towards; 4]; 3], [towards; 4]);
        for i in 0..4 {
            gaps[i] = L::splat(gap[i]);
            let slid = towards.negated_mul_add(gaps[i], columns[i]);
            (rows[0][i], rows[1][i], rows[2][i]) = (slid.splat_x(), slid.splat_y(), slid.splat_z());
        }
        for (four, block) in corners.blocks.iter().enumerate() {
            let place = [L::load(&block.x), L::load(&block.y), L::load(&block.z)];
            self.x[four] = combined(&rows[0], &place).to_array();
            self.y[four] = combined(&rows[1], &place).to_array();
            self.z[four] = combined(&rows[2], &place).to_array();
            self.gaps[four] = combined(&gaps, &place).to_array();
        }
        let (near, far) = (L::splat(doubt), L::splat(-doubt));
        for side in 0..plane.count {
            let [a, b, c, d] = plane.side_plane(side);
            let inwards = [L::splat(a), L::splat(b), L::splat(c), L::splat(d)];
            let mut masks = SideMasks { outside: 0, on: 0 };
            for four in 0..corners.blocks.len() {
                let place = [L::load(&self.x[four]), L::load(&self.y[four]), L::load(&self.z[four])];
                let inside = combined(&inwards, &place);
                let beyond = far.greater(inside);
                let is_clear = beyond | inside.greater(near);
                // A NaN fails all comparisons.
                if is_clear & 0b1111 != 0b1111 {
                    let on = L::splat(ON * doubt).greater(inside) & inside.greater(L::splat(-ON * doubt));
                    if (is_clear | on) & 0b1111 != 0b1111 {
                        return None;
                    }
                    masks.on |= (on & 0b1111) << (4 * four);
                }
                masks.outside |= (beyond & 0b1111) << (4 * four);
            }
            masks.outside &= corners.all();
            masks.on &= corners.all();
            self.sides[side / 4][side % 4] = masks;
            self.of_any |= masks.outside;
            self.on_more |= self.on_any & masks.on;
            self.on_any |= masks.on;
        }
        if self.on_any & !self.of_any == 0 {
            Some(())
        } else {
            self.move_onto(plane, &own.rotate_back(out).to_vector(), doubt)
        }
    }

    /// Moves places that are on sides, and may be a little outside, to those sides or their corners: no plane is taken beyond its
    /// sides. `None` where a place is on two of them and at no corner.
    #[cold]
    fn move_onto(&mut self, plane: &PatchCorners, towards: &Vector, doubt: f64) -> Option<()> {
        let mut left = self.on_any & !self.of_any;
        while left != 0 {
            let corner = left.trailing_zeros() as usize;
            left &= left - 1;
            let place = self.place(corner);
            let is_on_more = self.on_more >> corner & 1 == 1;
            // How far it is outside of a side that it is on, as a way back.
            let back = |side: usize, place: &Vector| {
                let [x, y, z, offset] = plane.side_plane(side);
                let inwards = Vector::new(x, y, z);
                inwards * (-(inwards.dot(place) + offset)).max(0.0)
            };
            let mut sides = (0..plane.count).filter(|side| self.sides[side / 4][side % 4].on >> corner & 1 == 1);
            let first = sides.next()?;
            let mut way = back(first, &place);
            if is_on_more {
                let second = sides.next()?;
                way += back(second, &(place + way));
                self.at_corners |= 1 << corner;
                let mut corners = (0..plane.count).map(|other| plane.position(other) - place);
                let to_corner = corners.find(|way| way.amax() <= 0.5 * doubt)?;
                // Beyond the end of a side, rounding apart.
                let is_beyond = back(first, &(place + way)).amax() > 1e-6 * doubt;
                way = if is_beyond { to_corner } else { way };
            }
            let (four, lane) = (corner / 4, corner % 4);
            self.x[four][lane] += way.x;
            self.y[four][lane] += way.y;
            self.z[four][lane] += way.z;
            self.gaps[four][lane] -= way.dot(towards);
        }
        Some(())
    }

    fn place(&self, corner: usize) -> Vector {
        let (four, lane) = (corner / 4, corner % 4);
        Vector::new(self.x[four][lane], self.y[four][lane], self.z[four][lane])
    }

    fn gap(&self, corner: usize) -> f64 {
        self.gaps[corner / 4][corner % 4]
    }

    /// The sides of the corners' patch, as bits, that cross the line of a side of the other: of those that end on it, that end
    /// speaks.
    fn crossing(&self, corners: &PatchCorners, side: usize) -> u32 {
        let SideMasks { outside, on } = self.sides[side / 4][side % 4];
        (outside ^ corners.next_of_all(outside)) & !(on | corners.next_of_all(on))
    }
}

/// The product of a row and a place, and the row's last number.
#[inline(always)]
fn combined<L: Lanes>(row: &[L; 4], place: &[L; 3]) -> L {
    row[0].mul_add(place[0], row[1].mul_add(place[1], row[2].mul_add(place[2], row[3])))
}

/// The corners of a patch.
struct PatchCorners<'a> {
    polyhedron: &'a Polyhedron,
    patch: Patch,
    /// The plane, positive outside.
    normal: &'a Vector,
    offset: f64,
    /// By how much the plane of a merged face may be above its corners, which are exact.
    slack: f64,
    /// How far the plane and the corners of a contact face are from its body, at most.
    thickness: f64,
    blocks: &'a [PointBlock],
    vertices: &'a [[u32; 4]],
    count: usize,
}

/// Room for the corners of a face of a body that has no outlines.
struct FourCorners {
    block: [PointBlock; 1],
    vertices: [[u32; 4]; 1],
}

impl FourCorners {
    const NONE: FourCorners =
        FourCorners { block: [PointBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4] }], vertices: [[0; 4]] };

    #[cold]
    fn fill(&mut self, polyhedron: &Polyhedron, face: u32, count: usize) {
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
    fn of(polyhedron: &'a Polyhedron, facing: Option<Facing>, room: &'a mut FourCorners) -> Option<PatchCorners<'a>> {
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
    fn side_plane(&self, side: usize) -> [f64; 4] {
        match self.patch {
            Patch::Merged(face) => self.polyhedron.side_plane(&self.polyhedron.faces[face as usize], side),
            Patch::Contact(face) => {
                self.polyhedron.outlines.contact_side(self.polyhedron.faces.len() as u32, face, side)
            }
        }
    }

    fn all(&self) -> u32 {
        u32::MAX >> (MOST - self.count)
    }

    fn next(&self, corner: usize) -> usize {
        if corner + 1 < self.count { corner + 1 } else { 0 }
    }

    fn vertex(&self, corner: usize) -> u32 {
        self.vertices[corner / 4][corner % 4]
    }

    /// On the plane of a contact face.
    fn position(&self, corner: usize) -> Vector {
        let (block, lane) = (&self.blocks[corner / 4], corner % 4);
        Vector::new(block.x[lane], block.y[lane], block.z[lane])
    }

    /// The bit of each corner's next one in its place.
    fn next_of_all(&self, corners: u32) -> u32 {
        corners >> 1 | (corners & 1) << (self.count - 1)
    }

    fn side_label(&self, side: usize) -> Feature {
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

/// A corner of the common part.
#[derive(Clone, Copy)]
struct RestSpot {
    /// Coordinates across the normal; set where one of many is to be chosen.
    across: [f64; 2],
    gap: f64,
    /// By how much the gap may be off.
    error: f64,
    /// A crossing's place along its side of the incident face.
    share: f64,
    corner: SpotOrigin,
}

/// The origin of a spot.
#[derive(Clone, Copy)]
enum SpotOrigin {
    /// A corner of a body's face.
    Of(u8, u8),
    /// Two sides.
    Crossing(u8, u8),
}

impl Place for RestSpot {
    fn across(&self) -> [f64; 2] {
        self.across
    }

    fn gap(&self) -> f64 {
        self.gap
    }

    fn error(&self) -> f64 {
        self.error
    }

    fn key(&self) -> u32 {
        match self.corner {
            SpotOrigin::Of(body, corner) => key_of_vertex(body.into(), corner.into()),
            SpotOrigin::Crossing(first, second) => key_of_crossing([first.into(), second.into()]),
        }
    }
}

/// The corners of a common part.
struct Spots<const F: usize> {
    /// A common part has as many corners as both faces.
    spots: [[RestSpot; 8]; F],
    count: usize,
    /// Whether one may be as deep as the bodies.
    is_deep: bool,
    max_distance: f64,
    deepest: f64,
}

impl<const F: usize> Spots<F> {
    /// Adds one whose gap is at most `max_distance`. `None` where there is no room.
    #[inline(always)]
    fn push(&mut self, gap: f64, error: f64, share: f64, corner: SpotOrigin) -> Option<()> {
        if !(error.is_finite() && gap - error <= self.max_distance) {
            return Some(());
        }
        self.is_deep |= gap - error <= self.deepest;
        *self.spots.as_flattened_mut().get_mut(self.count)? = RestSpot { across: [0.0; 2], gap, error, share, corner };
        self.count += 1;
        Some(())
    }

    fn all(&mut self) -> &mut [RestSpot] {
        &mut self.spots.as_flattened_mut()[..self.count]
    }
}

impl Writing<'_, '_> {
    /// Writes the points that both patches have in common, and how many there are. `None`, and nothing is written, where the sweep
    /// must tell.
    #[inline(always)]
    fn clip<L: Lanes>(&mut self, frame: &Frame<L>, along: &ContactNormal<L>, patches: &Patches) -> Option<usize> {
        let Patches { facing, reference } = *patches;
        let polyhedra = frame.polyhedra();
        let (mut room1, mut room2) = (FourCorners::NONE, FourCorners::NONE);
        let corners = [
            PatchCorners::of(polyhedra[0], facing[0], &mut room1)?,
            PatchCorners::of(polyhedra[1], facing[1], &mut room2)?,
        ];
        let size = frame.size + frame.separation;
        let coincident = (2.0 * (corners[0].thickness + corners[1].thickness)).max(COINCIDENT * size);
        // The sweep makes one of corners that are nearer. Seen along the normal, a side is no shorter than by the cosine of its
        // face.
        let cosine = facing.iter().flatten().map(|facing| facing.parallel).fold(1.0, f64::min);
        if !(polyhedra[0].outlines.shortest.min(polyhedra[1].outlines.shortest) * cosine > 4.0 * DOUBT * coincident) {
            return None;
        }
        let out = if reference == 0 { along.direction } else { along.direction.negate() };
        let stretch = if frame.rigid { 1.0 } else { STRETCH };
        let seen = Seen { corners, reference, out, size, coincident, upper: along.upper, stretch };
        let fours = seen.corners[0].blocks.len().max(seen.corners[1].blocks.len());
        if fours <= ONE {
            self.clip_in::<L, ONE>(frame, &seen)
        } else if fours <= FEW {
            L::out_of_line(&mut ClipMore::<L, FEW> { writing: self, frame, seen: &seen })
        } else {
            L::out_of_line(&mut ClipMore::<L, MANY> { writing: self, frame, seen: &seen })
        }
    }

    #[inline(always)]
    fn clip_in<L: Lanes, const F: usize>(&mut self, frame: &Frame<L>, seen: &Seen<L>) -> Option<usize> {
        let Seen { corners, reference, out, size, .. } = seen;
        let (reference, incident) = (*reference, 1 - *reference);
        // The places of corners seen from the other body, and their gaps as numbers of the plane's axes: columns of both rotations
        // err by 9.2u of a radius, products with a normal by 5.2u and sums by 5u, Δ by 10u, the plane's offset by 8u; and Rᵀ is for
        // R⁻¹ up to 29u, or cofactors and determinant err by 25u. That is less than 64u of all lengths, which the sweep
        // allows for as well.
        let (rounding, doubt) = (64.0 * U * size, DOUBT * seen.coincident);
        let mut slid = [Slid::<F>::NONE, Slid::NONE];
        // Slid onto the plane of a body are the other's corners.
        slid[reference].fill(frame, (reference, &corners[reference]), &corners[incident], *out, doubt)?;
        let is_inside = slid[reference].of_any | slid[reference].on_any == 0;
        if !is_inside {
            slid[incident].fill(frame, (incident, &corners[incident]), &corners[reference], out.negate(), doubt)?;
        }
        let none = RestSpot { across: [0.0; 2], gap: 0.0, error: 0.0, share: 0.0, corner: SpotOrigin::Of(0, 0) };
        let (max_distance, deepest) = (self.config.max_distance, seen.upper + rounding);
        let mut spots = Spots::<F> { spots: [[none; 8]; F], count: 0, is_deep: false, max_distance, deepest };
        for body in 0..2 {
            if is_inside && body == reference {
                continue;
            }
            let slid = &slid[1 - body];
            let error = seen.error(1 - body, slid.stretch, rounding);
            let mut inside = corners[body].all() & !slid.of_any;
            if body == incident {
                // The reference's corner speaks for both.
                inside &= !slid.at_corners;
            }
            while inside != 0 {
                let corner = inside.trailing_zeros() as usize;
                inside &= inside - 1;
                spots.push(slid.gap(corner), error, 0.0, SpotOrigin::Of(body as u8, corner as u8))?;
            }
        }
        if !is_inside {
            let mut crossing = Crossing { seen, slid: &slid, rounding, doubt, spots: &mut spots };
            L::out_of_line(&mut crossing)?;
        }
        if spots.count > 0 && !spots.is_deep {
            return None;
        }
        self.write(frame, &Found { seen, slid: &slid }, &mut spots);
        Some(spots.count)
    }

    #[inline(always)]
    fn write<L: Lanes, const F: usize>(&mut self, frame: &Frame<L>, found: &Found<L, F>, spots: &mut Spots<F>) {
        let Writing { reference: last, config, points } = self;
        let Seen { corners, reference, size, .. } = found.seen;
        let [corners1, corners2] = corners;
        let numbers = [corners1.patch.number(corners1.polyhedron), corners2.patch.number(corners2.polyhedron)];
        let mut now = Reference { body: *reference as u32 + 1, patches: numbers, kept: [0; FOUR] };
        let labels = [corners1.patch.label(corners1.polyhedron), corners2.patch.label(corners2.polyhedron)];
        let mut push = |spot| points.push(|point| L::out_of_line(&mut Filling { found, frame, labels, spot, point }));
        if config.reduces {
            if spots.count > FOUR {
                found.see_across(frame, spots);
            }
            let is_same = (last.body, last.patches) == (now.body, now.patches);
            let kept = if is_same { last.kept } else { [0; FOUR] };
            let four = four_of(spots.all(), &kept, *size);
            for (spot, key) in four.into_iter().zip(&mut now.kept) {
                let Some(spot) = spot else { continue };
                *key = spot.key();
                push(spot);
            }
        } else {
            spots.all().iter().for_each(push);
        }
        **last = now;
    }
}

/// Adds the points where sides cross.
struct Crossing<'a, L, const F: usize> {
    seen: &'a Seen<'a, L>,
    slid: &'a [Slid<F>; 2],
    rounding: f64,
    doubt: f64,
    spots: &'a mut Spots<F>,
}

impl<L: Lanes, const F: usize> Work for Crossing<'_, L, F> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(&mut self) -> Option<()> {
        let Crossing { seen, slid, rounding, doubt, .. } = *self;
        let (corners, reference) = (&seen.corners, seen.reference);
        let mut places = [[[0.0; 3]; 8]; F];
        let places = places.as_flattened_mut();
        let mut count = 0;
        let incident = &corners[1 - reference];
        let on = &slid[reference];
        let moved = on.on_any & !on.of_any;
        let crossed_by = |second: usize| slid[1].crossing(&corners[0], second);
        for first in 0..corners[0].count {
            let mut seconds = slid[0].crossing(&corners[1], first);
            while seconds != 0 {
                let second = seconds.trailing_zeros() as usize;
                seconds &= seconds - 1;
                if crossed_by(second) >> first & 1 == 0 {
                    continue;
                }
                let (side, edge) = if reference == 0 { (first, second) } else { (second, first) };
                let [a, b, c, d] = corners[reference].side_plane(side);
                let inside = |place: &Vector| a * place.x + b * place.y + c * place.z + d;
                // An end on another side has been moved onto it.
                if moved >> edge & 1 | moved >> incident.next(edge) & 1 == 1 {
                    return None;
                }
                let (from, to) = (on.place(edge), on.place(incident.next(edge)));
                let [before, after] = [inside(&from), inside(&to)];
                let share = before / (before - after);
                let place = from + (to - from) * share;
                // At a corner as sharp as that crossings may be at one place though the corner is not.
                let is_near = |other: &[f64; 3]| (0..3).all(|i| (other[i] - place[i]).abs() <= doubt);
                if places[..count].iter().any(is_near) {
                    return None;
                }
                *places.get_mut(count)? = place.into();
                count += 1;
                let rise = on.gap(incident.next(edge)) - on.gap(edge);
                // Both ends are right to the rounding, so the share is to twice that over how fast the side is crossed; and the
                // gap is that of the plane, in which the reference's side is up to its slack.
                let off = (2.0 * rounding / (before - after).abs()).min(1.0);
                let error = seen.error(reference, on.stretch, rounding) + off * rise.abs();
                let gap = on.gap(edge) + rise * share;
                self.spots.push(gap, error, share, SpotOrigin::Crossing(first as u8, second as u8))?;
            }
        }
        Some(())
    }
}

/// Says all of a point, called by the caller of lanes' code (R2).
struct Filling<'a, L, const F: usize> {
    found: &'a Found<'a, L, F>,
    frame: &'a Frame<'a, L>,
    /// Labels of both patches.
    labels: [u32; 2],
    spot: &'a RestSpot,
    point: &'a mut ManifoldPoint,
}

impl<L: Lanes, const F: usize> Work for Filling<'_, L, F> {
    type Output = ();

    #[inline(always)]
    fn run(&mut self) {
        self.found.fill(self.frame, self.labels, self.spot, self.point);
    }
}

/// Two faces that are seen along the normal.
struct Seen<'a, L> {
    corners: [PatchCorners<'a>; 2],
    reference: usize,
    /// The normal, out of the reference's body.
    out: L,
    /// A length next to the pair.
    size: f64,
    /// Points nearer to each other than this count as one place.
    coincident: f64,
    /// See [`ContactNormal`].
    upper: f64,
    /// How many times as far a plane may be moved along the normal as in its body.
    stretch: f64,
}

/// How many times as long lengths may become by a skewed R or its inverse: entries of RᵀR − I are at most 0.01.
const STRETCH: f64 = 1.02;

impl<L> Seen<'_, L> {
    /// By how much the gap between the plane of a body and a corner of the other, or a side that crosses one of its own, may be
    /// off: the plane and the corner by what they are thick, the plane by its slack as well, and by that of the point that it is
    /// measured from.
    #[inline(always)]
    fn error(&self, plane: usize, stretch: f64, rounding: f64) -> f64 {
        let (own, other) = (&self.corners[plane], &self.corners[1 - plane]);
        self.stretch * ((2.0 * (own.slack + rounding) + own.thickness) * stretch + other.thickness + rounding)
    }
}

/// For patches of more than four corners.
struct ClipMore<'a, 'b, 'c, L, const F: usize> {
    writing: &'a mut Writing<'b, 'c>,
    frame: &'a Frame<'a, L>,
    seen: &'a Seen<'a, L>,
}

impl<L: Lanes, const F: usize> Work for ClipMore<'_, '_, '_, L, F> {
    type Output = Option<usize>;

    #[inline(always)]
    fn run(&mut self) -> Option<usize> {
        self.writing.clip_in::<L, F>(self.frame, self.seen)
    }
}

/// The parts of a manifold.
struct Found<'a, L, const F: usize> {
    seen: &'a Seen<'a, L>,
    slid: &'a [Slid<F>; 2],
}

impl<L: Lanes, const F: usize> Found<'_, L, F> {
    /// The place of a spot in the axes of the reference's body, along the normal.
    #[inline(always)]
    fn seen(&self, spot: &RestSpot) -> L {
        let on = &self.slid[self.seen.reference];
        match spot.corner {
            SpotOrigin::Of(body, corner) if usize::from(body) == self.seen.reference => {
                L::from_vector(&self.seen.corners[self.seen.reference].position(corner.into()))
            }
            SpotOrigin::Of(_, corner) => L::from_vector(&on.place(corner.into())),
            SpotOrigin::Crossing(first, second) => {
                let edge = usize::from(if self.seen.reference == 0 { second } else { first });
                let from = L::from_vector(&on.place(edge));
                let to = L::from_vector(&on.place(self.seen.corners[1 - self.seen.reference].next(edge)));
                to.sub(from).mul_add(L::splat(spot.share), from)
            }
        }
    }

    /// Sets the coordinates of all across the normal.
    #[inline(always)]
    fn see_across(&self, frame: &Frame<L>, spots: &mut Spots<F>) {
        let normal = frame.bodies[self.seen.reference].rotate_back(self.seen.out);
        let [x, y, z, _] = self.seen.corners[self.seen.reference].side_plane(0);
        let side = L::from_vector(&Vector::new(x, y, z));
        let aside = normal.negated_mul_add(L::splat(normal.dot(side)), side);
        let first = aside.mul(L::splat(1.0 / aside.dot(aside).sqrt()));
        let second = normal.cross(first);
        for spot in spots.all() {
            let place = self.seen(spot);
            spot.across = [first.dot(place), second.dot(place)];
        }
    }

    /// Says all of a point.
    #[inline(always)]
    fn fill(&self, frame: &Frame<L>, labels: [u32; 2], spot: &RestSpot, point: &mut ManifoldPoint) {
        let face = |body: usize| Feature { kind: FeatureKind::Face, ids: [labels[body], 0] };
        let (mut places, features);
        match spot.corner {
            SpotOrigin::Of(body, corner) => {
                let (body, corner) = (usize::from(body), usize::from(corner));
                let own = &self.seen.corners[body];
                let vertex = own.vertex(corner) as usize;
                let label = Feature { kind: FeatureKind::Vertex, ids: [own.polyhedron.vertex_labels[vertex], 0] };
                let other = L::from_vector(&self.slid[1 - body].place(corner));
                places = [L::from_vector(&own.polyhedron.vertices[vertex].position), other];
                features = if body == 0 { [label, face(1)] } else { [face(0), label] };
                if body == 1 {
                    places = [places[1], places[0]];
                }
            }
            SpotOrigin::Crossing(first, second) => {
                let incident = &self.seen.corners[1 - self.seen.reference];
                let edge = usize::from(if self.seen.reference == 0 { second } else { first });
                let from = L::from_vector(&incident.position(edge));
                let to = L::from_vector(&incident.position(incident.next(edge)));
                places = [self.seen(spot), to.sub(from).mul_add(L::splat(spot.share), from)];
                if self.seen.reference == 1 {
                    places = [places[1], places[0]];
                }
                features =
                    [self.seen.corners[0].side_label(first.into()), self.seen.corners[1].side_label(second.into())];
            }
        }
        let [body1, body2] = &frame.bodies;
        places[0].add(L::from_vector(&body1.polyhedron.centre)).store_vector(&mut point.local1);
        places[1].add(L::from_vector(&body2.polyhedron.centre)).store_vector(&mut point.local2);
        body1.rotate_lanes(places[0]).add(body1.translation).store_vector(&mut point.world1);
        body2.rotate_lanes(places[1]).add(body2.translation).store_vector(&mut point.world2);
        (point.gap_lower, point.gap_upper) = (spot.gap - spot.error, spot.gap + spot.error);
        point.id = id_of(&features[0], &features[1]);
        [point.feature1, point.feature2] = features;
    }
}

#[cfg(test)]
mod tests {
    use super::super::{add_points, sweep};
    use super::*;
    use crate::base::math::{Matrix, Pose};
    use crate::base::simd::dispatch_to_avx2;
    use crate::random::Random;
    use crate::shape::{Shape, ShapeOptions};

    /// A prism over a convex polygon of this many corners, whose coordinates are off by up to a noise.
    fn prism(corners: usize, noise: f64, random: &mut Random) -> Shape {
        let angles: Vec<f64> = (0..corners).map(|k| (k as f64 + 0.4 * random.signed()) / corners as f64).collect();
        let around = |share: &f64| (std::f64::consts::TAU * share).sin_cos();
        let at = |(sine, cosine): (f64, f64), z: f64| Vector::new(cosine, sine, z);
        let mut points: Vec<Vector> =
            angles.iter().map(around).flat_map(|turn| [at(turn, -0.5), at(turn, 0.5)]).collect();
        points.iter_mut().for_each(|point| point.iter_mut().for_each(|x| *x += noise * random.signed()));
        let options = ShapeOptions { face_noise: Some(noise), ..ShapeOptions::default() };
        Shape::from_points(&points, &options).unwrap()
    }

    /// The patch most along a direction: a contact face, if it is one.
    fn patch(shape: &Shape, towards: Vector) -> Option<Facing> {
        let polyhedron = shape.polyhedron();
        let patches = (0..).map_while(|number| Patch::of_number(polyhedron, number));
        let facing = patches.map(|patch| Facing { patch, parallel: patch.normal(polyhedron).dot(&towards) });
        let rank = |facing: &Facing| facing.parallel + if let Patch::Contact(_) = facing.patch { 1e-3 } else { 0.0 };
        facing.reduce(|a, b| if rank(&b) > rank(&a) { b } else { a })
    }

    /// Faces and contact faces beside each other, in each other, far apart and tilted: the points of the masks are those of the
    /// sweep, and hardly ever is a pair left to it.
    #[test]
    fn masks_find_what_the_sweep_finds() {
        let mut random = Random::new(29);
        let (mut compared, mut left) = ([0; 2], [0; 2]);
        for round in 0..3_000 {
            let noise = if round % 4 == 0 { 1e-7 } else { 0.0 };
            let shapes = [prism(3 + round % 10, noise, &mut random), prism(3 + round / 10 % 30, noise, &mut random)];
            let tilt: f64 = if round % 3 == 0 { 0.0 } else { 0.3 * random.signed() };
            let (sine, cosine) = tilt.sin_cos();
            let turn = Matrix::new(cosine, 0.0, sine, 0.0, 1.0, 0.0, -sine, 0.0, cosine);
            let mut poses = [
                Pose::new(&turn, &Vector::new(1.5 * random.signed(), 1.5 * random.signed(), -1.0)),
                Pose::new(&Matrix::identity(), &Vector::zeros()),
            ];
            let mut pair = [&shapes[0], &shapes[1]];
            // Equal ones in line, or moved along a side.
            let in_line = round % 5 == 4;
            if in_line {
                pair = [pair[0]; 2];
                let [a, b] = [0, 2].map(|k| pair[0].polyhedron().vertices[k].position);
                let along = Vector::new(b.x - a.x, b.y - a.y, 0.0) * random.pick(&[0.0, 0.0, 0.5]);
                let aside = random.vector() * random.pick(&[0.0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6]);
                poses[0] = Pose::new(&turn, &(along + aside - Vector::z()));
            }
            let bodies = [pair[0].at(&poses[0]), pair[1].at(&poses[1])];
            let facing = [patch(pair[0], Vector::z()), patch(pair[1], -Vector::z())];
            let patches = Patches { facing, reference: round % 2 };
            // Witness points that are no deeper than any other.
            let contact = SignedDistance {
                lower: 0.0,
                upper: f64::INFINITY,
                normal: [0.0, 0.0, -1.0],
                ..SignedDistance::default()
            };
            let config = ManifoldConfig { max_distance: f64::INFINITY, reduces: false };
            let (mut found, mut swept) = (Vec::new(), Vec::new());
            let mut reference = Reference::NONE;
            let is_found = add_points(&mut found, |points| {
                let writing = &mut Writing { reference: &mut reference, config: &config, points };
                dispatch_to_avx2(&mut Clipping { bodies: &bodies, contact: &contact, patches: &patches, writing })
            });
            add_points(&mut swept, |points| {
                let writing = Writing { reference: &mut reference, config: &config, points };
                sweep(bodies, &contact, &patches, &Reference::NONE, writing)
            })
            .unwrap();
            if is_found.unwrap().is_none() {
                left[usize::from(in_line)] += usize::from(!swept.is_empty());
                continue;
            }
            let by_id = |a: &ManifoldPoint, b: &ManifoldPoint| a.id.cmp(&b.id);
            swept.sort_by(by_id);
            found.sort_by(by_id);
            assert_eq!(found.len(), swept.len(), "{round}: {found:?} {swept:?}");
            for (own, other) in found.iter().zip(&swept) {
                assert_eq!((own.id, own.feature1, own.feature2), (other.id, other.feature1, other.feature2), "{round}");
                let overlap = own.gap_lower <= other.gap_upper && other.gap_lower <= own.gap_upper;
                let off = |a: [f64; 3], b: [f64; 3]| (Vector::from(a) - Vector::from(b)).norm();
                let offs = [off(own.world1, other.world1), off(own.world2, other.world2)];
                // Next to a corner either of its sides may hold the point: they count as one place.
                let one_place = if in_line { 4.0 * COINCIDENT } else { 0.0 };
                assert!(
                    overlap && offs.into_iter().all(|off| off <= 1e-9 + 100.0 * noise + one_place),
                    "{round} {own:?} {other:?}"
                );
            }
            compared[usize::from(in_line)] += 1;
        }
        println!("{compared:?} {left:?}");
        assert!(cfg!(miri) || compared[0] > 1_700 && left[0] < 60, "{compared:?} {left:?}");
        assert!(cfg!(miri) || compared[1] > 300 && left[1] < 300, "{compared:?} {left:?}");
    }
}
