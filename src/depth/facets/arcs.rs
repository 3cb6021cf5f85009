//! Nodes and arcs of the fans: which of them one corner of the other body proves.

use super::search::{FacetSearch, NODE, NORMAL};
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::simd::Lanes;
use crate::body::polyhedron::fan::Fan;

/// For each face of a body, the corners w of the other with S(f, w) ≥ T. A face without any lowers T: then its least deep corner
/// is in the mask.
#[inline(always)]
pub fn find_masks<L: Lanes, const C: usize, const F: usize>(
    search: &mut FacetSearch<L, C, F>,
    body: usize,
    masks: &mut [[u64; 4]; F],
) {
    for face in 0..search.frame.bodies[body].polyhedron.faces.len() {
        let (normal, reach) = (search.placed[body].normal(face), search.placed[body].reach(face));
        let other = &search.placed[1 - body];
        let mut mask = other.at_most::<L>(&normal, reach - search.threshold());
        if mask == 0 {
            search.take_face(body, face, search.value_of_face(body, face));
            if search.is_separated() {
                return;
            }
            mask = search.placed[1 - body].at_most::<L>(&normal, reach - search.threshold());
        }
        masks[face / 4][face % 4] = mask;
    }
}

/// Arcs that no single corner proves. A closed surface has fewer edges than three times its corners: there is room for all of them
/// in as many twelves as the corners are fours.
pub struct Survivors<const C: usize> {
    count: usize,
    edges: [[u8; 12]; C],
}

impl<const C: usize> Survivors<C> {
    /// No arc.
    pub const NONE: Survivors<C> = Survivors { count: 0, edges: [[0; 12]; C] };

    /// Their edges.
    #[inline(always)]
    pub fn edges(&self) -> &[u8] {
        &self.edges.as_flattened()[..self.count]
    }

    /// Those of a fan. (Without a branch: the processor would guess it wrong, R4.)
    #[inline(always)]
    pub fn find<const F: usize>(&mut self, fan: &Fan, masks: &[[u64; 4]; F]) {
        let masks = masks.as_flattened();
        for (index, edge) in fan.edges.iter().enumerate() {
            let [left, right] = edge.faces;
            let (left, right) = (masks[usize::from(left)], masks[usize::from(right)]);
            self.edges.as_flattened_mut()[self.count] = index as u8;
            self.count += usize::from(left & right == 0);
        }
    }
}

/// A lower bound of h on an arc between faces a and b by two corners of the other body: one below the plane of a, the other below
/// that of b.
///
/// On the chord n(s) = (1 − s)a + s·b both S are linear, l and m. The set where l(s) ≥ T|n(s)| is an interval from s = 0 on, as l
/// − T|n| is concave for T ≥ 0; where m(s) is, one to s = 1. If both hold at one s, they cover the chord. Any computed s will do.
/// There l and m are off by the bound of [`NODE`] and |n| by [`NORMAL`], both over |n|; the computation of s, l, m and |n| adds
/// less than 4u.
#[inline(always)]
pub fn proved_by_two_corners<L: Lanes, const C: usize, const F: usize>(
    search: &FacetSearch<L, C, F>,
    body: usize,
    faces: [u8; 2],
) -> Option<f64> {
    let (placed, other) = (&search.placed[body], &search.placed[1 - body]);
    let threshold = search.threshold();
    let (left, right) = (usize::from(faces[0]), usize::from(faces[1]));
    let (a, b) = (placed.normal(left), placed.normal(right));
    let (reach_a, reach_b) = (placed.reach(left), placed.reach(right));
    // The values at a and at b of the corner deepest below b of those that prove a, and the other way round.
    let (mut proves_a, mut proves_b) = ([f64::NEG_INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for corner in 0..4 * other.points().len() {
        let point = other.point(corner);
        let depths = [reach_a - a.dot(&point), reach_b - b.dot(&point)];
        if depths[0] >= threshold && depths[1] > proves_a[1] {
            proves_a = depths;
        }
        if depths[1] >= threshold && depths[0] > proves_b[0] {
            proves_b = depths;
        }
    }
    let ([l0, l1], [m0, m1]) = (proves_a, proves_b);
    let s = if l1 >= threshold { 1.0 } else { (l0 - m0) / ((l0 - m0) + (m1 - l1)) };
    // False for a NaN, where one of them is not there.
    if !(0.0..=1.0).contains(&s) {
        return None;
    }
    let length = (a + (b - a) * s).norm();
    let value = (l0 + s * (l1 - l0)).min(m0 + s * (m1 - m0));
    let error = (NODE + NORMAL + 4.0 * U) * search.longest / length;
    (value >= threshold * length).then_some(threshold - error - search.fans[body].face_slack)
}
