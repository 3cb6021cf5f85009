//! The state of a search among facets while it goes on.

use super::placed::PlacedFan;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;
use crate::body::polyhedron::fan::Fan;
use crate::placed::frame::{Frame, RIGID_DEFECT};

/// A facet of the Minkowski difference, by indices of the polyhedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Facet {
    /// A face of body 1 (0) or body 2 (1).
    Face(usize, u32),
    /// An edge of each.
    Edges([u32; 2]),
}

impl Facet {
    /// Its kind, 1 to 3, and its indices.
    #[inline(always)]
    pub fn words(self) -> [u32; 3] {
        match self {
            Facet::Face(0, face) => [1, face, 0],
            Facet::Face(_, face) => [2, face, 0],
            Facet::Edges([first, second]) => [3, first, second],
        }
    }

    /// From any words; the bodies need not have it.
    #[inline(always)]
    pub fn of_words([kind, first, second]: [u32; 3]) -> Option<Facet> {
        match kind {
            1 => Some(Facet::Face(0, first)),
            2 => Some(Facet::Face(1, first)),
            3 => Some(Facet::Edges([first, second])),
            _ => None,
        }
    }
}

/// The amount by which ties may differ, over M: a node this much below the least bound found counts as proved. Computed supports
/// of equal facets differ by less.
pub(super) const TIE: f64 = 12.0 * U;

/// The rounding error of a placed face's normal: RᵀR − I turns it, [`RIGID_DEFECT`]; the product R·n makes 5.3u, the length of n
/// 2.5u.
pub const NORMAL: f64 = RIGID_DEFECT + 8.0 * U;

/// The rounding error of S(f, w), over M = 1.02(ρ₁ + ρ₂) + |Δ|, in units of u, for a face of body 1; body 2's are alike except
/// for Δ.
///
/// | | ρ₁ | ρ₂ | \|Δ\| |
/// |---|--:|--:|--:|
/// | R·n for the unit vector along R⁻ᵀn, see [`NORMAL`] | 37 | 37 | 37 |
/// | how far the body reaches along n | 1 | | |
/// | Δ, and its product with the normal | | | 5 |
/// | their sum | 1 | | 1 |
/// | R·w | | 5.3 | |
/// | its product with the normal | | 3.1 | 0 |
///
/// At most 46.4 of 1.02ρ (of body 1's corners below a plane of body 2 the sum with Δ is one more); the comparison with the
/// threshold is one more of M. For skewed poses normals are by the cofactors of R and normalised, 3 + 5.3 + 3.
pub const NODE: f64 = 48.0 * U;

/// The rounding error of a support along a computed unit vector, over M: vertices 5.3ρ and their sum with Δ 1 + 2, products 3,
/// the difference 1, the vector's length 3.
pub const SUPPORT: f64 = 16.0 * U;

/// The least support so far, as computed over the corners.
#[derive(Clone, Copy)]
pub(super) struct LeastSupport {
    pub(super) value: f64,
    /// About of unit length.
    pub(super) direction: Vector,
    pub(super) facet: Facet,
}

pub(super) struct FacetSearch<'a, L, const C: usize, const F: usize> {
    pub(super) frame: &'a Frame<'a, L>,
    pub(super) fans: [&'a Fan; 2],
    pub(super) placed: [PlacedFan<C, F>; 2],
    /// M: no difference of vertices is longer.
    pub(super) longest: f64,
    pub(super) widest: f64,
    pub(super) best: LeastSupport,
}

impl<L: Lanes, const C: usize, const F: usize> FacetSearch<'_, L, C, F> {
    /// Whether the least support may be less than 0, rounding apart.
    #[inline(always)]
    pub(super) fn is_separated(&self) -> bool {
        self.best.value < -SUPPORT * self.longest
    }

    /// The proved bound on nodes and arcs: T.
    #[inline(always)]
    pub(super) fn threshold(&self) -> f64 {
        self.best.value - TIE * self.longest
    }

    /// A support over the corners, along a direction of about unit length.
    #[inline(always)]
    pub(super) fn support(&self, direction: &Vector) -> f64 {
        let [placed1, placed2] = &self.placed;
        -placed1.least::<L>(&-direction) - placed2.least::<L>(direction)
    }

    /// How far the other body reaches below a face of one.
    #[inline(always)]
    pub(super) fn value_of_face(&self, body: usize, face: usize) -> f64 {
        let placed = &self.placed[body];
        placed.reach(face) - self.placed[1 - body].least::<L>(&placed.normal(face))
    }

    #[inline(always)]
    pub(super) fn take(&mut self, value: f64, direction: &Vector, facet: Facet) {
        if value < self.best.value {
            self.best = LeastSupport { value, direction: *direction, facet };
        }
    }

    #[inline(always)]
    pub(super) fn take_face(&mut self, body: usize, face: usize, value: f64) {
        let normal = self.placed[body].normal(face);
        let direction = if body == 0 { normal } else { -normal };
        self.take(value, &direction, Facet::Face(body, face as u32));
    }
}
