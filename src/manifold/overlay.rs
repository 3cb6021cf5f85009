//! The common part of two outlines of few corners, where no corner is near a side of the other: all corners against all sides at
//! once, as bits. It gives the result of the [sweep](super::clip), faster, and leaves any doubtful case to that.

use super::clip::{CommonCorner, error_at_sides, height_over};
use super::outline::Outline;
use super::places::{CommonPoint, Origin, View};
use crate::base::math::Vector;
use crate::base::simd::{self, Kernel, Lanes};

/// Corners of an outline: a mask has this many bits.
pub const FEW: usize = 8;

/// Lanes that hold them.
const FOURS: usize = FEW / 4;

/// Corners of a common part: each is on the boundary of both outlines or a corner of one.
const MOST_CORNERS: usize = 2 * FEW;

/// Within this many times [`coincident`](Precision::coincident), the sweep takes two corners for one.
pub const DOUBT: f64 = 4.0;

/// The points of the common part whose gap is at most `max_distance`; and the witness points, if others are there and none is as
/// deep.
pub struct Overlay {
    places: [CommonPoint; MOST_CORNERS + 1],
    count: usize,
}

/// The corners of an outline and the sides that begin there. Lanes past the last corner repeat it.
struct Few<L> {
    x: [L; FOURS],
    y: [L; FOURS],
    corners: [Vector; FEW],
    count: usize,
    /// 1 if they go around counter-clockwise, else −1.
    turn: f64,
}

impl<L: Lanes> Few<L> {
    #[inline(always)]
    fn none() -> Few<L> {
        let zeros = [L::splat(0.0); FOURS];
        Few { x: zeros, y: zeros, corners: [Vector::zeros(); FEW], count: 0, turn: 0.0 }
    }

    /// Makes them those of an outline that has area and few corners.
    #[inline(always)]
    fn fill(&mut self, outline: &Outline) {
        self.count = outline.count;
        self.turn = if outline.is_counter_clockwise { 1.0 } else { -1.0 };
        for four in 0..self.count.div_ceil(4) {
            let mut positions = [L::splat(0.0); 4];
            for (lane, position) in positions.iter_mut().enumerate() {
                let vertex = outline.vertex((4 * four + lane).min(self.count - 1));
                *position = L::from_vector(&outline.polyhedron.vertices[vertex as usize].position);
            }
            let [x, y, z] = outline.spots(L::components(&positions));
            (self.x[four], self.y[four]) = (x, y);
            let (x, y, z) = (x.to_array(), y.to_array(), z.to_array());
            for lane in 0..4 {
                self.corners[4 * four + lane] = Vector::new(x[lane], y[lane], z[lane]);
            }
        }
    }

    #[inline(always)]
    fn ends(&self, side: usize) -> [&Vector; 2] {
        [&self.corners[side], &self.corners[if side + 1 < self.count { side + 1 } else { 0 }]]
    }

    /// How far inside a side a place is, times the side's length.
    #[inline(always)]
    fn inside(&self, side: usize, place: &Vector) -> f64 {
        let [from, to] = self.ends(side);
        self.turn * ((to.x - from.x) * (place.y - from.y) - (to.y - from.y) * (place.x - from.x))
    }

    /// For each side, the corners of another outline that are outside of it; `None` where one is as near as `doubt`.
    #[inline(always)]
    fn outside(&self, other: &Few<L>, doubt: f64) -> Option<[u8; FEW]> {
        let mut outside = [0; FEW];
        for (side, outside) in outside[..self.count].iter_mut().enumerate() {
            let [from, to] = self.ends(side);
            let (x, y) = (self.turn * (to.x - from.x), self.turn * (to.y - from.y));
            // At least as long as the side: the sum does not underflow where squares do.
            let limit = L::splat(doubt * (x.abs() + y.abs()));
            for four in 0..other.count.div_ceil(4) {
                let across = L::splat(x).mul(other.y[four].sub(L::splat(from.y)));
                let inside = across.sub(L::splat(y).mul(other.x[four].sub(L::splat(from.x))));
                let beyond = limit.negate().greater(inside);
                // A NaN fails both comparisons.
                if (beyond | inside.greater(limit)) & 0b1111 != 0b1111 {
                    return None;
                }
                *outside |= (beyond as u8 & 0b1111) << (4 * four);
            }
            *outside &= (0xff_u32 >> (FEW - other.count)) as u8;
        }
        Some(outside)
    }

    /// Bits of the sides whose ends are on different sides of something, of bits of corners.
    #[inline(always)]
    fn crossing_sides(&self, outside: u8) -> u8 {
        let next = outside >> 1 | (outside & 1) << (self.count - 1);
        outside ^ next
    }
}

impl Overlay {
    pub const NONE: Overlay = Overlay { places: [CommonPoint::NOWHERE; MOST_CORNERS + 1], count: 0 };

    /// Makes it that of two outlines; `None` where the sweep must decide. In place, as it is large.
    pub fn fill(&mut self, view: &View) -> Option<()> {
        let are_few = |outline: &Outline| outline.patch.is_some() && (3..=FEW).contains(&outline.count);
        if !view.outlines.iter().all(are_few) {
            return None;
        }
        simd::dispatch_to_avx2(&mut OverlayFilling { overlay: self, view })
    }

    /// Adds one that is near; whether it may be as deep as the witness points. `None` where there is no room, for instance for
    /// outlines that are not convex.
    #[inline(always)]
    fn push(&mut self, view: &View, place: CommonPoint) -> Option<bool> {
        if !view.is_near(&place) {
            return Some(false);
        }
        let is_deep = view.is_deep(&place);
        *self.places[..MOST_CORNERS].get_mut(self.count)? = place;
        self.count += 1;
        Some(is_deep)
    }

    pub fn places(&self) -> &[CommonPoint] {
        &self.places[..self.count]
    }
}

struct OverlayFilling<'a> {
    overlay: &'a mut Overlay,
    view: &'a View<'a>,
}

impl Kernel for OverlayFilling<'_> {
    type Output = Option<()>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<()> {
        let View { outlines, precision, .. } = self.view;
        let mut few = [Few::<L>::none(), Few::none()];
        few[0].fill(&outlines[0]);
        few[1].fill(&outlines[1]);
        let doubt = DOUBT * precision.coincident;
        let outside = [few[0].outside(&few[1], doubt)?, few[1].outside(&few[0], doubt)?];
        let mut is_deep = false;
        for body in 0..2 {
            let of_any = outside[1 - body].iter().fold(0, |any, corners| any | corners);
            for corner in 0..few[body].count {
                if of_any >> corner & 1 == 1 {
                    continue;
                }
                let spot = few[body].corners[corner];
                let Some((height, error)) = height_over(outlines, body, &spot, precision) else { continue };
                let mut spots = [spot; 2];
                spots[1 - body].z = height;
                let origin = Origin::Corner(CommonCorner::Vertex { body, corner });
                is_deep |= self.overlay.push(self.view, CommonPoint { origin, spots, error })?;
            }
        }
        let mut crossings = [[0.0; 2]; MOST_CORNERS];
        let mut crossing_count = 0;
        let crossed = outside[1].map(|outside| few[0].crossing_sides(outside));
        for (first, &beyond) in outside[0][..few[0].count].iter().enumerate() {
            let mut seconds = few[1].crossing_sides(beyond);
            while seconds != 0 {
                let second = seconds.trailing_zeros() as usize;
                seconds &= seconds - 1;
                if crossed[second] >> first & 1 == 0 {
                    continue;
                }
                let (spots, error) = crossing(&few, [first, second], precision.rounding);
                // At a corner as sharp as that crossings may be at one place though the corner is not.
                for [x, y] in &crossings[..crossing_count] {
                    if (x - spots[0].x).abs() <= doubt && (y - spots[0].y).abs() <= doubt {
                        return None;
                    }
                }
                *crossings.get_mut(crossing_count)? = [spots[0].x, spots[0].y];
                crossing_count += 1;
                let origin = Origin::Corner(CommonCorner::Crossing { sides: [first, second] });
                let error = error + error_at_sides(outlines, precision);
                is_deep |= self.overlay.push(self.view, CommonPoint { origin, spots, error })?;
            }
        }
        if self.overlay.count > 0 && !is_deep {
            self.overlay.places[self.overlay.count] = self.view.witness();
            self.overlay.count += 1;
        }
        Some(())
    }
}

/// The point where two sides cross on either outline, and how much the gap there may be off because they cross at a small angle.
///
/// How far an end is inside the other's line is off by less than twice the `rounding`, so the share of the side up to the crossing
/// by that over how far both ends are apart across the line; each height changes along its side by so much of its rise.
#[inline(always)]
fn crossing<L: Lanes>(few: &[Few<L>; 2], sides: [usize; 2], rounding: f64) -> ([Vector; 2], f64) {
    let mut error = 0.0;
    let mut spots = [Vector::zeros(); 2];
    for body in 0..2 {
        let (other, side) = (&few[1 - body], sides[1 - body]);
        let [from, to] = few[body].ends(sides[body]);
        let [before, after] = [other.inside(side, from), other.inside(side, to)];
        let [tail, head] = other.ends(side);
        let length = (head.x - tail.x).abs() + (head.y - tail.y).abs();
        spots[body] = from + (to - from) * (before / (before - after));
        let off = (2.0 * rounding * length / (before - after).abs()).min(1.0);
        error += off * (to.z - from.z).abs();
    }
    (spots, error)
}

#[cfg(test)]
mod tests {
    use super::super::clip::Precision;
    use super::*;
    use crate::base::math::{Pose, UNIT_ROUNDOFF as U};
    use crate::body::build::assembly::build;
    use crate::body::polyhedron::Polyhedron;
    use crate::manifold::outline::Axes;
    use crate::manifold::patch::{COINCIDENT, Patch};
    use crate::pair::SignedDistance;
    use crate::random::Random;

    /// A prism over a convex polygon of this many corners.
    fn prism(corners: usize, random: &mut Random) -> Polyhedron {
        let angles: Vec<f64> = (0..corners).map(|k| (k as f64 + 0.4 * random.signed()) / corners as f64).collect();
        let around = |share: &f64| (std::f64::consts::TAU * share).sin_cos();
        let at = |(sine, cosine): (f64, f64), z: f64| Vector::new(cosine, sine, z);
        let points: Vec<Vector> = angles.iter().map(around).flat_map(|at_| [at(at_, -0.5), at(at_, 0.5)]).collect();
        build(&points, None).unwrap()
    }

    /// The face whose normal is most along a direction.
    fn face(polyhedron: &Polyhedron, towards: Vector) -> Option<Patch> {
        let along = |face: usize| polyhedron.faces[face].normal.dot(&towards);
        let best = (0..polyhedron.faces.len()).reduce(|a, b| if along(b) > along(a) { b } else { a })?;
        Some(Patch::Merged(best as u32))
    }

    /// A point of a common part in a form that can be sorted, and where it is.
    fn told(place: &CommonPoint) -> (usize, [usize; 2], [Vector; 2], f64) {
        let (kind, sides) = match place.origin {
            Origin::Corner(CommonCorner::Vertex { body, corner }) => (body, [corner, 0]),
            Origin::Corner(CommonCorner::Crossing { sides }) => (2, sides),
            Origin::Witness => (3, [0; 2]),
        };
        (kind, sides, place.spots, place.error)
    }

    /// Faces beside each other, in each other, far apart and tilted: the same corners at the same places as the sweep's; and hardly
    /// ever is one left to it.
    #[test]
    fn an_overlay_is_what_the_sweep_finds() {
        let mut random = Random::new(29);
        let (mut compared, mut left) = (0, 0);
        for round in 0..3_000 {
            let bodies = [prism(3 + round % 6, &mut random), prism(3 + round / 6 % 6, &mut random)];
            let tilt = if round % 3 == 0 { 0.0 } else { 0.3 * random.signed() };
            let turn = crate::base::math::Matrix::new(
                tilt.cos(),
                0.0,
                tilt.sin(),
                0.0,
                1.0,
                0.0,
                -tilt.sin(),
                0.0,
                tilt.cos(),
            );
            let poses = [Pose::new(&turn, &Vector::zeros()), Pose::IDENTITY];
            let axes = Axes::new(&Vector::z(), &random.direction());
            let offset = Vector::new(1.5 * random.signed(), 1.5 * random.signed(), -1.0);
            let patches = [face(&bodies[0], Vector::z()), face(&bodies[1], -Vector::z())];
            let outlines = [(0, offset), (1, Vector::zeros())]
                .map(|(i, offset)| Outline::new(&bodies[i], &poses[i], offset, &axes, patches[i]));
            let size = 4.0;
            let precision = Precision { rounding: 64.0 * U * size, coincident: COINCIDENT * size, reference: 0 };
            // Witness points that are no deeper than any other.
            let contact = SignedDistance { lower: 0.0, upper: f64::INFINITY, ..SignedDistance::default() };
            let view = View {
                outlines: &outlines,
                poses: [&poses[0], &poses[1]],
                precision,
                max_distance: f64::INFINITY,
                contact: &contact,
                witness_spots: [Vector::zeros(); 2],
            };
            let mut overlay = Overlay::NONE;
            if overlay.fill(&view).is_none() {
                left += 1;
                continue;
            }
            let mut swept = Vec::new();
            view.sweep(|place| swept.push(told(place)));
            let mut found: Vec<_> = overlay.places().iter().map(told).collect();
            let by_corner = |a: &(usize, [usize; 2], [Vector; 2], f64), b: &(usize, [usize; 2], [Vector; 2], f64)| {
                (a.0, a.1).cmp(&(b.0, b.1))
            };
            swept.sort_by(by_corner);
            found.sort_by(by_corner);
            assert_eq!(found.len(), swept.len(), "{round}: {found:?} {swept:?}");
            for (own, other) in found.iter().zip(&swept) {
                assert_eq!((own.0, own.1), (other.0, other.1), "{round}");
                for k in 0..2 {
                    let off = own.2[k] - other.2[k];
                    let allowed = precision.rounding + 4.0 * (own.3 + other.3);
                    assert!(off.xy().norm() <= 1e-9 && off.z.abs() <= 1e-9 + allowed, "{round} {off:?}");
                }
            }
            compared += 1;
        }
        assert!(compared > 2_900 && left < 30, "{compared} {left}");
    }
}
