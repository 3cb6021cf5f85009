//! The manifold of a pair at rest, whose depth the facet of before proves: the corners of one face are slid along the normal onto
//! the plane of the other, in the axes of its body, and compared with its sides, as bits. So are those of the other, where any is
//! needed.
//!
//! It is for faces as they were built. Contact faces, many corners, corners next to a side and witness points that no corner is as
//! deep as are left to [the outlines](super::outline).

use super::answer::{FOUR, Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, Reference};
use super::id::id_of;
use super::outline::STEEPEST;
use super::overlay::DOUBT;
use super::patch::{COINCIDENT, Facing, Patch, Patches, STICKY, STICKY_INCIDENT, choose, facing};
use super::places::{key_of_crossing, key_of_vertex};
use super::reduction::{Place, four_of};
use super::sink::Sink;
use crate::answer::{Feature, FeatureKind, Outcome};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Kernel, Lanes, Work};
use crate::body::polyhedron::fan::PointBlock;
use crate::body::polyhedron::{Face, Polyhedron};
use crate::depth::facets::Proved;
use crate::depth::polytope::is_in_scale;
use crate::depth::prove_at_rest;
use crate::pair::{SignedDistance, fill_at_rest};
use crate::placed::Pair;
use crate::placed::frame::Frame;
use crate::shape::Placed;

/// Corners of a face: a mask has this many bits.
const MOST: usize = 32;

/// Room for faces of so many fours of corners: of boxes, and of all. It is zeroed, and all of it takes as long as the rest of a
/// query.
const FEW: usize = 2;
const MANY: usize = MOST / 4;

/// The query of a pair that may rest.
pub struct AtRest<'a, 'b> {
    pub bodies: &'a [Placed<'a>; 2],
    pub cache: &'a mut ManifoldCache,
    pub config: &'a ManifoldConfig,
    pub points: &'a mut Sink<'b>,
    /// Filled where a facet proves the depth.
    pub contact: &'a mut SignedDistance,
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
        fill_at_rest(self.contact, &frame, &proved);
        match self.clip(&frame, &proved) {
            Some(manifold) => Answered::Whole(manifold),
            None => Answered::Contact,
        }
    }
}

/// The corners of a face on the plane of the other body's, seen along the normal.
struct Slid<const F: usize> {
    /// In the axes of the plane's body.
    x: [[f64; 4]; F],
    y: [[f64; 4]; F],
    z: [[f64; 4]; F],
    /// How far they were over the plane.
    gaps: [[f64; 4]; F],
    /// For each side of the plane's face the corners that are outside of it, and those outside of any.
    outside: [[u32; 4]; F],
    of_any: u32,
    /// One over the cosine between the plane's normal and the contact's.
    stretch: f64,
}

impl<const F: usize> Slid<F> {
    const NONE: Slid<F> = Slid {
        x: [[0.0; 4]; F],
        y: [[0.0; 4]; F],
        z: [[0.0; 4]; F],
        gaps: [[0.0; 4]; F],
        outside: [[0; 4]; F],
        of_any: 0,
        stretch: 0.0,
    };

    /// `None` where a corner is as near to a side as `doubt`, or the plane too steep. `out`: along the normal out of the plane's
    /// body.
    #[inline(always)]
    fn fill<L: Lanes>(
        &mut self,
        frame: &Frame<L>,
        (body, face): (usize, &Face),
        corners: &Corners,
        out: L,
        doubt: f64,
    ) -> Option<()> {
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let (normal, towards) = (L::from_vector(&face.normal), own.rotate_back(out));
        let cosine = normal.dot(towards);
        if !(cosine > STEEPEST) {
            return None;
        }
        self.stretch = 1.0 / cosine;
        let [x, y, z] = other.columns();
        let columns = [own.rotate_back(x), own.rotate_back(y), own.rotate_back(z), own.rotate_back(other.offset)];
        let per = self.stretch;
        let gap = [
            normal.dot(columns[0]) * per,
            normal.dot(columns[1]) * per,
            normal.dot(columns[2]) * per,
            (normal.dot(columns[3]) + face.planes.offset[0]) * per,
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
        for side in 0..face.side_count as usize {
            let [a, b, c, d] = own.polyhedron.side_plane(face, side);
            let plane = [L::splat(a), L::splat(b), L::splat(c), L::splat(d)];
            let mut outside = 0;
            for four in 0..corners.blocks.len() {
                let place = [L::load(&self.x[four]), L::load(&self.y[four]), L::load(&self.z[four])];
                let inside = combined(&plane, &place);
                let beyond = far.greater(inside);
                // A NaN fails both comparisons.
                if (beyond | inside.greater(near)) & 0b1111 != 0b1111 {
                    return None;
                }
                outside |= (beyond & 0b1111) << (4 * four);
            }
            outside &= corners.all();
            self.outside[side / 4][side % 4] = outside;
            self.of_any |= outside;
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

    /// The corners that are outside of a side.
    fn outside(&self, side: usize) -> u32 {
        self.outside[side / 4][side % 4]
    }
}

/// The product of a row and a place, and the row's last number.
#[inline(always)]
fn combined<L: Lanes>(row: &[L; 4], place: &[L; 3]) -> L {
    row[0].mul_add(place[0], row[1].mul_add(place[1], row[2].mul_add(place[2], row[3])))
}

/// The corners of a face.
struct Corners<'a> {
    polyhedron: &'a Polyhedron,
    face: u32,
    record: &'a Face,
    blocks: &'a [PointBlock],
    vertices: &'a [[u32; 4]],
    count: usize,
}

impl<'a> Corners<'a> {
    /// `None` of other patches than faces, and of faces of many corners.
    #[inline(always)]
    fn of(polyhedron: &'a Polyhedron, facing: Option<Facing>) -> Option<Corners<'a>> {
        let Patch::Merged(face) = facing?.patch else { return None };
        let record = polyhedron.faces.get(face as usize)?;
        let count = record.side_count as usize;
        let (blocks, vertices) = polyhedron.outlines.corners(face);
        let fits = count <= MOST && blocks.len() == count.div_ceil(4) && vertices.len() == blocks.len();
        fits.then_some(Corners { polyhedron, face, record, blocks, vertices, count })
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

    fn position(&self, corner: usize) -> &'a Vector {
        &self.polyhedron.vertices[self.vertex(corner) as usize].position
    }

    /// Bits of the sides whose ends are on different sides of something, of bits of corners.
    fn crossing_sides(&self, outside: u32) -> u32 {
        outside ^ (outside >> 1 | (outside & 1) << (self.count - 1))
    }

    fn side_label(&self, side: usize) -> Feature {
        let edge = self.polyhedron.side(self.record, side as u32);
        Feature { kind: FeatureKind::Edge, ids: self.polyhedron.edges[edge as usize].labels }
    }
}

/// A corner of the common part.
#[derive(Clone, Copy)]
struct Spot {
    /// Coordinates across the normal; set where one of many is to be chosen.
    across: [f64; 2],
    gap: f64,
    /// By how much the gap may be off.
    error: f64,
    /// A crossing's place along its side of the incident face.
    share: f64,
    corner: Corner,
}

/// The origin of a spot.
#[derive(Clone, Copy)]
enum Corner {
    /// A corner of a body's face.
    Of(u8, u8),
    /// Two sides.
    Crossing(u8, u8),
}

impl Place for Spot {
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
            Corner::Of(body, corner) => key_of_vertex(body.into(), corner.into()),
            Corner::Crossing(first, second) => key_of_crossing([first.into(), second.into()]),
        }
    }
}

/// The corners of a common part.
struct Spots<const F: usize> {
    /// A common part has as many corners as both faces.
    spots: [[Spot; 8]; F],
    count: usize,
    /// Whether one may be as deep as the bodies.
    is_deep: bool,
    max_distance: f64,
    deepest: f64,
}

impl<const F: usize> Spots<F> {
    /// Adds one whose gap is at most `max_distance`. `None` where there is no room.
    #[inline(always)]
    fn push(&mut self, gap: f64, error: f64, share: f64, corner: Corner) -> Option<()> {
        if !(error.is_finite() && gap - error <= self.max_distance) {
            return Some(());
        }
        self.is_deep |= gap - error <= self.deepest;
        *self.spots.as_flattened_mut().get_mut(self.count)? = Spot { across: [0.0; 2], gap, error, share, corner };
        self.count += 1;
        Some(())
    }

    fn all(&mut self) -> &mut [Spot] {
        &mut self.spots.as_flattened_mut()[..self.count]
    }
}

impl AtRest<'_, '_> {
    /// Writes the points that both faces have in common. `None`, and nothing is written, where outlines must tell.
    #[inline(always)]
    fn clip<L: Lanes>(&mut self, frame: &Frame<L>, proved: &Proved<L>) -> Option<Manifold> {
        let Patches { facing, reference } = self.choose_faces(frame, proved)?;
        let polyhedra = frame.polyhedra();
        let corners = [Corners::of(polyhedra[0], facing[0])?, Corners::of(polyhedra[1], facing[1])?];
        let size = frame.size + frame.separation;
        // Outlines make one of corners that are nearer; seen along the normal a side is no shorter than by the cosine of its face.
        if polyhedra[0].outlines.shortest.min(polyhedra[1].outlines.shortest) * STEEPEST <= COINCIDENT * size {
            return None;
        }
        let out = if reference == 0 { proved.direction } else { proved.direction.negate() };
        let seen = Seen { corners, reference, out, size };
        if seen.corners[0].blocks.len() <= FEW && seen.corners[1].blocks.len() <= FEW {
            return self.clip_in::<L, FEW>(frame, &seen);
        }
        L::out_of_line(&mut ClipMany { query: self, frame, seen: &seen })
    }

    #[inline(always)]
    fn clip_in<L: Lanes, const F: usize>(&mut self, frame: &Frame<L>, seen: &Seen<L>) -> Option<Manifold> {
        let Seen { corners, reference, out, size } = seen;
        let (reference, incident) = (*reference, 1 - *reference);
        // The places of corners seen from the other body, and their gaps as numbers of the plane's axes: columns of both rotations
        // err by 9.2u of a radius, products with a normal by 5.2u and sums by 5u, Δ by 10u, the plane's offset by 4u; and Rᵀ is for
        // R⁻¹ up to 29u. That is less than 64u of all lengths, which outlines allow for as well.
        let (rounding, doubt) = (64.0 * U * size, DOUBT * COINCIDENT * size);
        let mut slid = [Slid::<F>::NONE, Slid::NONE];
        // Slid onto the plane of a body are the other's corners.
        slid[reference].fill(frame, (reference, corners[reference].record), &corners[incident], *out, doubt)?;
        let is_inside = slid[reference].of_any == 0;
        if !is_inside {
            slid[incident].fill(
                frame,
                (incident, corners[incident].record),
                &corners[reference],
                out.negate(),
                doubt,
            )?;
        }
        let none = Spot { across: [0.0; 2], gap: 0.0, error: 0.0, share: 0.0, corner: Corner::Of(0, 0) };
        let (max_distance, deepest) = (self.config.max_distance, self.contact.upper + rounding);
        let mut spots = Spots::<F> { spots: [[none; 8]; F], count: 0, is_deep: false, max_distance, deepest };
        for body in 0..2 {
            if is_inside && body == reference {
                continue;
            }
            let slid = &slid[1 - body];
            let slack = corners[1 - body].record.slack;
            // The plane may be off by its slack, and what it is measured from.
            let error = 2.0 * (slack + rounding) * slid.stretch + rounding;
            let mut inside = corners[body].all() & !slid.of_any;
            while inside != 0 {
                let corner = inside.trailing_zeros() as usize;
                inside &= inside - 1;
                spots.push(slid.gap(corner), error, 0.0, Corner::Of(body as u8, corner as u8))?;
            }
        }
        if !is_inside {
            let mut crossing = Crossing { corners, slid: &slid, reference, rounding, doubt, spots: &mut spots };
            L::out_of_line(&mut crossing)?;
        }
        if spots.count == 0 || !spots.is_deep {
            return None;
        }
        Some(self.write(frame, &Found { seen, slid: &slid }, &mut spots))
    }

    /// The patches that face each other: mostly those of before.
    #[inline(always)]
    fn choose_faces<L: Lanes>(&self, frame: &Frame<L>, proved: &Proved<L>) -> Option<Patches> {
        let last = &self.cache.reference;
        choose([self.face_of(frame, proved, 0), self.face_of(frame, proved, 1)], last)
    }

    #[inline(always)]
    fn face_of<L: Lanes>(&self, frame: &Frame<L>, proved: &Proved<L>, i: usize) -> Option<Facing> {
        let last = &self.cache.reference;
        let towards = if i == 0 { proved.direction } else { proved.direction.negate() };
        let along = frame.bodies[i].rotate_back(towards);
        let sticky = if last.body == i as u32 + 1 { STICKY } else { STICKY_INCIDENT };
        let known = (1..=2).contains(&last.body).then_some(last.patches[i]);
        if let Some(number) = known
            && let Some(face) = frame.bodies[i].polyhedron.faces.get(number as usize)
        {
            // No normal is longer than 1, nor R·normal, up to 40u.
            let parallel = L::from_vector(&face.normal).dot(along);
            if parallel >= 1.0 + 64.0 * U - sticky {
                return Some(Facing { patch: Patch::Merged(number), parallel });
            }
        }
        let witness = Vector::from(if i == 0 { self.contact.local1 } else { self.contact.local2 });
        facing(self.bodies[i], &towards.to_vector(), &witness, known, sticky)
    }

    #[inline(always)]
    fn write<L: Lanes, const F: usize>(
        &mut self,
        frame: &Frame<L>,
        found: &Found<L, F>,
        spots: &mut Spots<F>,
    ) -> Manifold {
        let AtRest { cache, config, points, contact, .. } = self;
        let last = cache.reference;
        let Seen { corners, reference, size, .. } = found.seen;
        let numbers = [corners[0].face, corners[1].face];
        let mut now = Reference { body: *reference as u32 + 1, patches: numbers, kept: [0; FOUR] };
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
                points.push(|point| L::out_of_line(&mut Filling { found, frame, spot, point }));
            }
        } else {
            for spot in spots.all().iter() {
                points.push(|point| L::out_of_line(&mut Filling { found, frame, spot, point }));
            }
        }
        cache.reference = now;
        Manifold {
            outcome: Outcome::Intersecting,
            reference: now.body,
            lower: contact.lower,
            upper: contact.upper,
            normal: contact.normal,
            point_count: points.written as u32,
            found_count: spots.count as u32,
        }
    }
}

/// Adds the points where sides cross.
struct Crossing<'a, const F: usize> {
    corners: &'a [Corners<'a>; 2],
    slid: &'a [Slid<F>; 2],
    reference: usize,
    rounding: f64,
    doubt: f64,
    spots: &'a mut Spots<F>,
}

impl<const F: usize> Work for Crossing<'_, F> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(&mut self) -> Option<()> {
        let Crossing { corners, slid, reference, rounding, doubt, .. } = *self;
        let mut places = [[[0.0; 3]; 8]; F];
        let places = places.as_flattened_mut();
        let mut count = 0;
        let incident = &corners[1 - reference];
        let on = &slid[reference];
        let crossed_by = |second: usize| corners[0].crossing_sides(slid[1].outside(second));
        for first in 0..corners[0].count {
            let mut seconds = corners[1].crossing_sides(slid[0].outside(first));
            while seconds != 0 {
                let second = seconds.trailing_zeros() as usize;
                seconds &= seconds - 1;
                if crossed_by(second) >> first & 1 == 0 {
                    continue;
                }
                let (side, edge) = if reference == 0 { (first, second) } else { (second, first) };
                let [a, b, c, d] = corners[reference].polyhedron.side_plane(corners[reference].record, side);
                let inside = |place: &Vector| a * place.x + b * place.y + c * place.z + d;
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
                let error =
                    2.0 * (corners[reference].record.slack + rounding) * on.stretch + rounding + off * rise.abs();
                let gap = on.gap(edge) + rise * share;
                self.spots.push(gap, error, share, Corner::Crossing(first as u8, second as u8))?;
            }
        }
        Some(())
    }
}

/// Says all of a point, called by the caller of lanes' code (R2).
struct Filling<'a, L, const F: usize> {
    found: &'a Found<'a, L, F>,
    frame: &'a Frame<'a, L>,
    spot: &'a Spot,
    point: &'a mut ManifoldPoint,
}

impl<L: Lanes, const F: usize> Work for Filling<'_, L, F> {
    type Output = ();

    #[inline(always)]
    fn run(&mut self) {
        self.found.fill(self.frame, self.spot, self.point);
    }
}

/// Two faces that are seen along the normal.
struct Seen<'a, L> {
    corners: [Corners<'a>; 2],
    reference: usize,
    /// The normal, out of the reference's body.
    out: L,
    /// A length next to the pair.
    size: f64,
}

/// For faces of many corners.
struct ClipMany<'a, 'b, 'c, L> {
    query: &'a mut AtRest<'b, 'c>,
    frame: &'a Frame<'a, L>,
    seen: &'a Seen<'a, L>,
}

impl<L: Lanes> Work for ClipMany<'_, '_, '_, L> {
    type Output = Option<Manifold>;

    #[inline(always)]
    fn run(&mut self) -> Option<Manifold> {
        self.query.clip_in::<L, MANY>(self.frame, self.seen)
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
    fn seen(&self, spot: &Spot) -> L {
        let on = &self.slid[self.seen.reference];
        match spot.corner {
            Corner::Of(body, corner) if usize::from(body) == self.seen.reference => {
                L::from_vector(self.seen.corners[self.seen.reference].position(corner.into()))
            }
            Corner::Of(_, corner) => L::from_vector(&on.place(corner.into())),
            Corner::Crossing(first, second) => {
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
        let planes = &self.seen.corners[self.seen.reference].record.planes;
        let side = L::from_vector(&Vector::new(planes.x[1], planes.y[1], planes.z[1]));
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
    fn fill(&self, frame: &Frame<L>, spot: &Spot, point: &mut ManifoldPoint) {
        let face = |body: usize| {
            let patch = Patch::Merged(self.seen.corners[body].face);
            Feature { kind: FeatureKind::Face, ids: [patch.label(self.seen.corners[body].polyhedron), 0] }
        };
        let (mut places, features);
        match spot.corner {
            Corner::Of(body, corner) => {
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
            Corner::Crossing(first, second) => {
                let incident = &self.seen.corners[1 - self.seen.reference];
                let edge = usize::from(if self.seen.reference == 0 { second } else { first });
                let from = L::from_vector(incident.position(edge));
                let to = L::from_vector(incident.position(incident.next(edge)));
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
