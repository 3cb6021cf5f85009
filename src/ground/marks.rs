//! Which normals contacts with a triangle may have, summed up in two bytes when a ground is made.

/// By so much the cosine of the widest angle is less than that between normals: more than what [`TILT`](super::normals::TILT) adds.
const SPARE: f64 = 1e-5;

/// So many parts of 1 the tangent is kept in; one more is for angles above 90°.
const PARTS: f64 = 254.0;

/// The marks of a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Marks {
    /// Bits 0 to 2: a side has a far normal. Bits 3 to 5: a corner may have normals that none of its sides has. Bit 6: there is a
    /// neighbour in its plane at each side.
    bits: u8,
    tan_half: u8,
}

impl Marks {
    /// Those of a triangle that is left out.
    pub const NONE: Marks = Marks { bits: 0, tan_half: u8::MAX };

    pub fn set_far_normal(&mut self, side: usize) {
        debug_assert!(side < 3);
        self.bits |= 1 << side;
    }

    pub fn set_peak(&mut self, corner: usize) {
        debug_assert!(corner < 3);
        self.bits |= 8 << corner;
    }

    pub fn set_inner(&mut self) {
        self.bits |= 1 << 6;
    }

    /// Whether at each side there is a neighbour in its plane.
    pub fn is_inner(self) -> bool {
        self.bits >> 6 & 1 == 1
    }

    /// Sets the widest angle between the triangle's own normal and another that its contacts may have.
    pub fn set_widest(&mut self, cosine: f64) {
        debug_assert!((-1.001..=1.001).contains(&cosine));
        self.tan_half = u8::MAX;
        if cosine >= 0.0 {
            let cosine = (cosine - SPARE).max(0.0);
            let tan_half = ((1.0 - cosine) / (1.0 + cosine)).sqrt();
            self.tan_half = (PARTS * tan_half).ceil().min(PARTS) as u8;
        }
    }

    pub fn has_far_normal(self, side: usize) -> bool {
        debug_assert!(side < 3);
        self.bits >> side & 1 == 1
    }

    pub fn may_be_peak(self, corner: usize) -> bool {
        debug_assert!(corner < 3);
        self.bits >> (3 + corner) & 1 == 1
    }

    /// At least the tangent of half the widest angle between the triangle's own normal and another that its contacts may have.
    /// `None` where that is above 90°.
    pub fn tan_half(self) -> Option<f64> {
        (self.tan_half != u8::MAX).then(|| f64::from(self.tan_half) / PARTS)
    }

    /// Whether all those normals are within 45° of the triangle's own.
    pub fn are_gentle(self) -> bool {
        // tan 22.5° is 0.41421.
        self.tan_half().is_some_and(|tan| tan <= 0.4142)
    }
}
