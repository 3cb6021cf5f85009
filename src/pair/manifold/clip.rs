//! The common part of two outlines, in one sweep from left to right: its corners are corners of one inside the other, and
//! crossings. Time in proportion to the corners; nothing is stored.

use super::outline::{Chain, Outline};
use crate::base::math::Vector;

/// A corner of the common part.
#[derive(Debug, Clone, Copy)]
pub enum Corner {
    /// A corner of one outline over the inside of the other.
    Vertex {
        /// 0 or 1: whose corner.
        body: usize,
        /// Which.
        corner: usize,
        /// Where.
        spot: Vector,
    },
    /// Two sides that cross.
    Crossing {
        /// The sides.
        sides: [usize; 2],
        /// Where they are.
        spots: [Vector; 2],
        /// By how much the gap may be off, where they cross at a small angle.
        error: f64,
    },
}

impl Corner {
    /// Where it is across the normal.
    pub fn place(&self) -> Vector {
        match self {
            Corner::Vertex { spot, .. } => *spot,
            Corner::Crossing { spots, .. } => spots[0],
        }
    }
}

/// The last corners, since the same place may come up as several.
const REMEMBERED: usize = 8;

/// Calls `visit` with each corner of the common part of two outlines; of several at one place, up to `rounding`, the first.
pub fn common_part(outlines: &[Outline; 2], rounding: f64, mut visit: impl FnMut(&Corner)) {
    let mut chains = outlines.each_ref().map(Outline::chains);
    let mut recent = Recent { places: [[f64::INFINITY; 2]; REMEMBERED], oldest: 0, rounding };
    // The next event of each chain, first its leftmost corner.
    let mut pending = [[true; 2]; 2];
    while let Some([body, side]) = next_event(&chains, &pending) {
        let chain = chains[body][side];
        // Both chains meet at either end: there the lower one speaks.
        let is_end = !chain.has_begun || chain.segments == 0;
        let other = &chains[1 - body];
        if (side == 0 || !is_end) && is_between(other, &chain.to, rounding) {
            let corner = Corner::Vertex { body, corner: chain.corner, spot: chain.to };
            recent.report(&corner, &mut visit);
        }
        pending[body][side] = chains[body][side].advance();
        if pending[body][side] {
            for other in 0..2 {
                let both = if body == 0 {
                    [&chains[0][side], &chains[1][other]]
                } else {
                    [&chains[0][other], &chains[1][side]]
                };
                if let Some(crossing) = crossing(both, rounding) {
                    recent.report(&crossing, &mut visit);
                }
            }
        }
    }
}

/// The chain whose event is the leftmost one to come.
fn next_event(chains: &[[Chain; 2]; 2], pending: &[[bool; 2]; 2]) -> Option<[usize; 2]> {
    let mut next: Option<([usize; 2], f64)> = None;
    for (body, side) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let x = chains[body][side].to.x;
        // The first in any case, and no NaN is less.
        if pending[body][side] && next.is_none_or(|(_, least)| x < least) {
            next = Some(([body, side], x));
        }
    }
    next.map(|(event, _)| event)
}

/// Whether a place lies between two chains.
fn is_between([lower, upper]: &[Chain; 2], place: &Vector, rounding: f64) -> bool {
    let (low, high) = (lower.at(place.x), upper.at(place.x));
    let is_over = (low.x - place.x).abs() <= rounding && (high.x - place.x).abs() <= rounding;
    is_over && place.y >= low.y - rounding && place.y <= high.y + rounding
}

/// Where the segments of two chains cross, if they do.
fn crossing(chains: [&Chain; 2], rounding: f64) -> Option<Corner> {
    let [first, second] = chains;
    if !(first.has_begun && second.has_begun) {
        return None;
    }
    let left = first.from.x.max(second.from.x);
    let right = first.to.x.min(second.to.x);
    if !(left < right) {
        return None;
    }
    let begin = [first.at(left), second.at(left)];
    let end = [first.at(right), second.at(right)];
    let (before, after) = (begin[0].y - begin[1].y, end[0].y - end[1].y);
    if !((before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0)) {
        return None;
    }
    let share = before / (before - after);
    let spots = [0, 1].map(|i| begin[i] + (end[i] - begin[i]) * share);
    // Where along the segments they cross is off by the rounding over how fast they part.
    let off = (2.0 * rounding / (before - after).abs()).min(1.0);
    let gaps = [begin[0].z - begin[1].z, end[0].z - end[1].z];
    Some(Corner::Crossing { sides: [first.side(), second.side()], spots, error: off * (gaps[0] - gaps[1]).abs() })
}

/// What came last.
struct Recent {
    places: [[f64; 2]; REMEMBERED],
    oldest: usize,
    rounding: f64,
}

impl Recent {
    fn report(&mut self, corner: &Corner, visit: &mut impl FnMut(&Corner)) {
        let place = corner.place();
        let most = 4.0 * self.rounding;
        // `hypot` takes longer than the rest of a corner, and few are as near as to need it.
        let is_near = |known: &[f64; 2]| {
            let (x, y) = (known[0] - place.x, known[1] - place.y);
            x.abs() <= most && y.abs() <= most && x.hypot(y) <= most
        };
        if self.places.iter().any(is_near) {
            return;
        }
        self.places[self.oldest] = [place.x, place.y];
        self.oldest = (self.oldest + 1) % REMEMBERED;
        visit(corner);
    }
}
