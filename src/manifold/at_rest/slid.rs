//! The corners of one patch slid onto the plane of the other, and on which side of its sides they are, as bits.

use super::corners::PatchCorners;
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::manifold::outline::STEEPEST;
use crate::placed::frame::Frame;

/// Corners nearer to a side than this part of what is too near to tell are on it: a quarter of what the sweep makes one.
const ON: f64 = 0.0625;

/// The corners of a patch on the plane of the other body's, seen along the normal.
pub struct Slid<const F: usize> {
    /// In the axes of the plane's body.
    pub x: [[f64; 4]; F],
    pub y: [[f64; 4]; F],
    pub z: [[f64; 4]; F],
    /// How far they were over the plane.
    pub gaps: [[f64; 4]; F],
    /// For each side of the plane's face the corners that are outside of it, and those on it.
    pub sides: [[SideMasks; 4]; F],
    /// The corners outside of any, on any, and on more than one.
    pub of_any: u32,
    pub on_any: u32,
    pub on_more: u32,
    /// Those at a corner of the plane's face.
    pub at_corners: u32,
    /// One over the cosine between the plane's normal and the contact's.
    pub stretch: f64,
}

/// The corners of one patch beside a side of the other, as bits.
#[derive(Clone, Copy)]
pub struct SideMasks {
    pub outside: u32,
    /// Nearer to its line than corners that are one.
    pub on: u32,
}

impl<const F: usize> Slid<F> {
    pub const NONE: Slid<F> = Slid {
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
    pub fn fill<L: Lanes>(
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
    pub fn move_onto(&mut self, plane: &PatchCorners, towards: &Vector, doubt: f64) -> Option<()> {
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

    pub fn place(&self, corner: usize) -> Vector {
        let (four, lane) = (corner / 4, corner % 4);
        Vector::new(self.x[four][lane], self.y[four][lane], self.z[four][lane])
    }

    pub fn gap(&self, corner: usize) -> f64 {
        self.gaps[corner / 4][corner % 4]
    }

    /// The sides of the corners' patch, as bits, that cross the line of a side of the other: of those that end on it, that end
    /// speaks.
    pub fn crossing(&self, corners: &PatchCorners, side: usize) -> u32 {
        let SideMasks { outside, on } = self.sides[side / 4][side % 4];
        (outside ^ corners.next_of_all(outside)) & !(on | corners.next_of_all(on))
    }
}

/// The product of a row and a place, and the row's last number.
#[inline(always)]
fn combined<L: Lanes>(row: &[L; 4], place: &[L; 3]) -> L {
    row[0].mul_add(place[0], row[1].mul_add(place[1], row[2].mul_add(place[2], row[3])))
}

/// Two faces that are seen along the normal.
pub struct Seen<'a, L> {
    pub corners: [PatchCorners<'a>; 2],
    pub reference: usize,
    /// The normal, out of the reference's body.
    pub out: L,
    /// A length next to the pair.
    pub size: f64,
    /// Points nearer to each other than this count as one place.
    pub coincident: f64,
    /// The distance along the normal is at most this.
    pub upper: f64,
    /// How many times as far a plane may be moved along the normal as in its body.
    pub stretch: f64,
}

impl<L> Seen<'_, L> {
    /// By how much the gap between the plane of a body and a corner of the other, or a side that crosses one of its own, may be
    /// off: the plane and the corner by what they are thick, the plane by its slack as well, and by that of the point that it is
    /// measured from.
    #[inline(always)]
    pub fn error(&self, plane: usize, stretch: f64, rounding: f64) -> f64 {
        let (own, other) = (&self.corners[plane], &self.corners[1 - plane]);
        self.stretch * ((2.0 * (own.slack + rounding) + own.thickness) * stretch + other.thickness + rounding)
    }
}
