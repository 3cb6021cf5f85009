//! Two patches clipped: corners inside of the other, and sides that cross.

use super::corners::{FourCorners, MOST, PatchCorners};
use super::points::{Filling, Found, RestSpot, SpotOrigin, Spots};
use super::slid::{Seen, Slid};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::manifold::answer::{FOUR, ManifoldConfig, Reference};
use crate::manifold::patch::{COINCIDENT, Patches};
use crate::manifold::reduction::{Place, four_of};
use crate::manifold::sink::Sink;
use crate::placed::frame::Frame;

/// Room for patches of so many fours of corners: of boxes, of hulls, and of all. It is zeroed, and all of it takes as long as the
/// rest of a query.
const ONE: usize = 1;
const FEW: usize = 2;
const MANY: usize = MOST / 4;

/// Within this many times what counts as one place, the sweep takes two corners for one.
const DOUBT: f64 = 4.0;

/// The normal of a contact.
pub struct ContactNormal<L> {
    /// The unit vector out of body 1.
    pub direction: L,
    /// The distance along it is at most this.
    pub upper: f64,
}

/// The destination of the points, and how many are wanted.
pub struct Writing<'a, 'b> {
    /// That of before, which is replaced where points are written.
    pub reference: &'a mut Reference,
    pub config: &'a ManifoldConfig,
    pub points: &'a mut Sink<'b>,
}

impl Writing<'_, '_> {
    /// Writes the points that both patches have in common, and how many there are. `None`, and nothing is written, where the sweep
    /// must tell.
    #[inline(always)]
    pub fn clip<L: Lanes>(&mut self, frame: &Frame<L>, along: &ContactNormal<L>, patches: &Patches) -> Option<usize> {
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

/// How many times as long lengths may become by a skewed R or its inverse: entries of RᵀR − I are at most 0.01.
const STRETCH: f64 = 1.02;

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

#[cfg(test)]
mod tests {
    use super::super::Clipping;
    use super::*;
    use crate::base::math::{Matrix, Pose};
    use crate::base::simd::dispatch_to_avx2;
    use crate::manifold::answer::ManifoldPoint;
    use crate::manifold::patch::{Facing, Patch};
    use crate::manifold::{add_points, sweep};
    use crate::pair::SignedDistance;
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
