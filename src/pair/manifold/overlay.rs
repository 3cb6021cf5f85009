//! The common part of two outlines of few corners, where no corner is near a side of the other: all corners against all sides at
//! once, as bits. It says what the [sweep](super::clip) says, sooner, and leaves to that whatever is in doubt.

use super::clip::{CommonCorner, Precision, Spot};
use super::outline::Outline;
use crate::base::math::Vector;

/// Corners of an outline: a mask has so many bits.
pub const FEW: usize = 8;

/// Corners of a common part: each is on the boundary of both outlines or a corner of one.
const MOST_CORNERS: usize = 2 * FEW;

/// Within so many times what is [`coincident`](Precision::coincident) the sweep takes two corners for one.
const DOUBT: f64 = 4.0;

/// The corners of the common part.
pub struct Overlay {
    spots: [Spot; MOST_CORNERS],
    count: usize,
}

/// The corners of an outline and the sides that begin there.
struct Few {
    corners: [Vector; FEW],
    count: usize,
    /// 1 if they go around counter-clockwise, else −1.
    turn: f64,
}

impl Few {
    fn of(outline: &Outline) -> Option<Few> {
        if outline.patch.is_none() || !(3..=FEW).contains(&outline.count) {
            return None;
        }
        let mut corners = [Vector::zeros(); FEW];
        for (corner, spot) in corners[..outline.count].iter_mut().enumerate() {
            *spot = outline.spot(corner);
        }
        Some(Few { corners, count: outline.count, turn: if outline.is_counter_clockwise { 1.0 } else { -1.0 } })
    }

    fn ends(&self, side: usize) -> [&Vector; 2] {
        [&self.corners[side], &self.corners[if side + 1 < self.count { side + 1 } else { 0 }]]
    }

    /// How far inside a side a place is, times the side's length.
    fn inside(&self, side: usize, place: &Vector) -> f64 {
        let [from, to] = self.ends(side);
        self.turn * ((to.x - from.x) * (place.y - from.y) - (to.y - from.y) * (place.x - from.x))
    }

    /// Of each side the corners of another outline that are outside of it; `None` where one is as near as `doubt`.
    fn outside(&self, other: &Few, doubt: f64) -> Option<[u8; FEW]> {
        let mut outside = [0; FEW];
        let mut is_doubtful = false;
        for (side, outside) in outside[..self.count].iter_mut().enumerate() {
            let [from, to] = self.ends(side);
            let (x, y) = (self.turn * (to.x - from.x), self.turn * (to.y - from.y));
            // At least as long as the side: the sum does not underflow where squares do.
            let limit = doubt * (x.abs() + y.abs());
            for (corner, place) in other.corners[..other.count].iter().enumerate() {
                let inside = x * (place.y - from.y) - y * (place.x - from.x);
                // True of a NaN.
                is_doubtful |= !(inside.abs() > limit);
                *outside |= u8::from(inside < 0.0) << corner;
            }
        }
        (!is_doubtful).then_some(outside)
    }

    /// Bits of the sides whose ends are on different sides of something, of bits of corners.
    fn crossing_sides(&self, outside: u8) -> u8 {
        let next = outside >> 1 | (outside & 1) << (self.count - 1);
        outside ^ next
    }
}

impl Overlay {
    /// Of two outlines; `None` where the sweep has to tell.
    pub fn of(outlines: &[Outline; 2], precision: &Precision) -> Option<Overlay> {
        let few = [Few::of(&outlines[0])?, Few::of(&outlines[1])?];
        let doubt = DOUBT * precision.coincident;
        let outside = [few[0].outside(&few[1], doubt)?, few[1].outside(&few[0], doubt)?];
        let mut overlay = Overlay {
            spots: [Spot {
                corner: CommonCorner::Vertex { body: 0, corner: 0 },
                spots: [Vector::zeros(); 2],
                error: 0.0,
            }; MOST_CORNERS],
            count: 0,
        };
        for body in 0..2 {
            let of_any = outside[1 - body].iter().fold(0, |any, corners| any | corners);
            for corner in (0..few[body].count).filter(|corner| of_any >> corner & 1 == 0) {
                let place = few[body].corners[corner];
                overlay.push(Spot { corner: CommonCorner::Vertex { body, corner }, spots: [place; 2], error: 0.0 })?;
            }
        }
        let corner_count = overlay.count;
        let crossed = outside[1].map(|outside| few[0].crossing_sides(outside));
        for (first, &beyond) in outside[0][..few[0].count].iter().enumerate() {
            let mut seconds = few[1].crossing_sides(beyond);
            while seconds != 0 {
                let second = seconds.trailing_zeros() as usize;
                seconds &= seconds - 1;
                if crossed[second] >> first & 1 == 1 {
                    overlay.push(crossing(&few, [first, second], precision.rounding))?;
                }
            }
        }
        // At a corner as sharp as that crossings may be at one place though the corner is not.
        let crossings = &overlay.spots[corner_count..overlay.count];
        for (at, spot) in crossings.iter().enumerate() {
            let is_near = |other: &Spot| {
                let off = other.spots[0] - spot.spots[0];
                off.x.abs() <= doubt && off.y.abs() <= doubt
            };
            if crossings[..at].iter().any(is_near) {
                return None;
            }
        }
        Some(overlay)
    }

    /// `None` where there is no room, as of outlines that are not convex.
    fn push(&mut self, spot: Spot) -> Option<()> {
        *self.spots.get_mut(self.count)? = spot;
        self.count += 1;
        Some(())
    }

    /// The corners of the common part.
    pub fn spots(&self) -> &[Spot] {
        &self.spots[..self.count]
    }
}

/// Where two sides cross.
///
/// How far an end is inside the other's line is off by less than twice the `rounding`, so the share of the side up to the crossing
/// by that over how far both ends are apart across the line; each height changes along its side by so much of its rise.
fn crossing(few: &[Few; 2], sides: [usize; 2], rounding: f64) -> Spot {
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
    Spot { corner: CommonCorner::Crossing { sides }, spots, error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::{Pose, UNIT_ROUNDOFF as U};
    use crate::build::assembly::build;
    use crate::pair::manifold::clip::common_part;
    use crate::pair::manifold::outline::Axes;
    use crate::pair::manifold::patch::{COINCIDENT, Patch};
    use crate::polyhedron::Polyhedron;
    use crate::random::Random;

    /// A prism over a convex polygon of so many corners.
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

    /// A corner of a common part in a form that can be sorted, and where it is.
    fn told(spot: &Spot) -> (usize, [usize; 2], [Vector; 2], f64) {
        let (kind, place) = match spot.corner {
            CommonCorner::Vertex { body, corner } => (body, [corner, 0]),
            CommonCorner::Crossing { sides } => (2, sides),
        };
        (kind, place, spot.spots, spot.error)
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
            let Some(overlay) = Overlay::of(&outlines, &precision) else {
                left += 1;
                continue;
            };
            let mut swept = Vec::new();
            common_part(&outlines, &precision, |spot| swept.push(told(spot)));
            let mut found: Vec<_> = overlay.spots().iter().map(told).collect();
            let by_corner = |a: &(usize, [usize; 2], [Vector; 2], f64), b: &(usize, [usize; 2], [Vector; 2], f64)| {
                (a.0, a.1).cmp(&(b.0, b.1))
            };
            swept.sort_by(by_corner);
            found.sort_by(by_corner);
            assert_eq!(found.len(), swept.len(), "{round}: {found:?} {swept:?}");
            for (own, other) in found.iter().zip(&swept) {
                assert_eq!((own.0, own.1), (other.0, other.1), "{round}");
                for k in 0..2 {
                    // A corner is put over the other outline later; where sides cross both heights count.
                    let off = own.2[k] - other.2[k];
                    let allowed = precision.rounding + 4.0 * (own.3 + other.3);
                    assert!(off.xy().norm() <= 1e-9 && (own.0 < 2 || off.z.abs() <= 1e-9 + allowed), "{round} {off:?}");
                }
            }
            compared += 1;
        }
        assert!(compared > 2_900 && left < 30, "{compared} {left}");
    }
}
