//! The common part of two outlines, in one sweep from left to right: its corners are corners of one inside the other, and
//! crossings. Time in proportion to the corners; nothing is stored.
//!
//! What is nearer than `coincident` is at one place: there a corner speaks for crossings, and the reference's corner for the
//! other's. So sides that lie on each other have no crossings, which could be anywhere along them, and which of two aligned
//! corners speaks does not hang on the last bit.

use super::outline::{Chain, Outline};
use crate::base::math::Vector;

/// A corner of the common part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommonCorner {
    /// A corner of one outline over the inside of the other.
    Vertex {
        /// 0 or 1: whose corner.
        body: usize,
        /// Which.
        corner: usize,
    },
    /// Two sides that cross.
    Crossing {
        /// The sides.
        sides: [usize; 2],
    },
}

/// A corner of the common part, and where it is.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    pub corner: CommonCorner,
    /// On either outline; of a vertex its own, twice.
    pub spots: [Vector; 2],
    /// Of a vertex beside the other outline, by no more than is one place, how high the nearest side is: the plane goes on, and where
    /// it is steep leaves the body by many times as much.
    pub beside: Option<f64>,
    /// By how much the gap may be off, where sides cross at a small angle.
    pub error: f64,
}

/// How exact the sweep is.
#[derive(Debug, Clone, Copy)]
pub struct Precision {
    /// What rounding makes of a length.
    pub rounding: f64,
    /// What is nearer than this is at one place; much more than the rounding.
    pub coincident: f64,
    /// The body, 0 or 1, whose corners speak first.
    pub reference: usize,
}

/// Calls `visit` with each corner of the common part of two outlines; of several at one place, with one.
pub fn common_part(outlines: &[Outline; 2], precision: &Precision, mut visit: impl FnMut(&Spot)) {
    let mut chains = outlines.each_ref().map(Outline::chains);
    let mut recent = Recent { spots: [None; REMEMBERED], precision };
    // The next event of each chain, first its leftmost corner.
    let mut pending = [[true; 2]; 2];
    while let Some([body, side]) = next_event(&chains, &pending) {
        let chain = chains[body][side];
        recent.pass(chain.to.x, &mut visit);
        // Both chains meet at either end: there the lower one speaks.
        let is_end = !chain.has_begun || chain.segments == 0;
        let other = &chains[1 - body];
        if (side == 0 || !is_end)
            && let Some(beside) = place_of(other, &chain.to, precision)
        {
            let corner = CommonCorner::Vertex { body, corner: chain.corner };
            recent.report(Spot { corner, spots: [chain.to; 2], beside, error: 0.0 }, &mut visit);
        }
        pending[body][side] = chains[body][side].advance();
        if pending[body][side] {
            for other in 0..2 {
                let both = if body == 0 {
                    [&chains[0][side], &chains[1][other]]
                } else {
                    [&chains[0][other], &chains[1][side]]
                };
                if let Some(crossing) = crossing(both, precision) {
                    recent.report(crossing, &mut visit);
                }
            }
        }
    }
    recent.pass(f64::INFINITY, &mut visit);
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

/// Of a place that lies between two chains nothing; of one that is at one how high that is there.
fn place_of(chains: &[Chain; 2], place: &Vector, precision: &Precision) -> Option<Option<f64>> {
    let [low, high] = [0, 1].map(|side| chains[side].at(place.x));
    let off = (low.x - place.x).abs().max((high.x - place.x).abs());
    if off <= precision.rounding && place.y >= low.y && place.y <= high.y {
        return Some(None);
    }
    let [below, above] = chains.each_ref().map(|chain| chain.nearest(place));
    let (height, distance) = if above.1 < below.1 { above } else { below };
    (distance <= precision.coincident).then_some(Some(height))
}

/// Where the segments of two chains cross, if they do, and neither begins nor ends at the other: such an end
/// [is between](is_between) the other's chains.
fn crossing(chains: [&Chain; 2], precision: &Precision) -> Option<Spot> {
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
    let (begun, other) = if first.from.x > second.from.x { (first, second) } else { (second, first) };
    let (ended, another) = if first.to.x < second.to.x { (first, second) } else { (second, first) };
    if other.nearest(&begun.from).1.min(another.nearest(&ended.to).1) <= precision.coincident {
        return None;
    }
    let share = before / (before - after);
    let spots = [0, 1].map(|i| begin[i] + (end[i] - begin[i]) * share);
    // Where along the segments they cross is off by the rounding over how fast they part.
    let off = (2.0 * precision.rounding / (before - after).abs()).min(1.0);
    let gaps = [begin[0].z - begin[1].z, end[0].z - end[1].z];
    let corner = CommonCorner::Crossing { sides: [first.side(), second.side()] };
    Some(Spot { corner, spots, beside: None, error: off * (gaps[0] - gaps[1]).abs() })
}

/// Corners that are told later, as another at the same place may speak for them.
struct Recent<'a> {
    spots: [Option<Spot>; REMEMBERED],
    precision: &'a Precision,
}

/// There are at most four crossings to the right of the sweep, one of each pair of chains, and few corners at one place.
const REMEMBERED: usize = 8;

impl Recent<'_> {
    /// How far apart corners are at most that are one: about where rounding, or noise, may put two that are at one place.
    fn reach(&self) -> f64 {
        4.0 * self.precision.coincident
    }

    fn rank(&self, spot: &Spot) -> usize {
        match spot.corner {
            CommonCorner::Vertex { body, .. } if body == self.precision.reference => 0,
            CommonCorner::Vertex { .. } => 1,
            CommonCorner::Crossing { .. } => 2,
        }
    }

    fn report(&mut self, spot: Spot, visit: &mut impl FnMut(&Spot)) {
        let (place, reach) = (spot.spots[0], self.reach());
        let is_near = |known: &Option<Spot>| {
            known.is_some_and(|known| {
                let (x, y) = (known.spots[0].x - place.x, known.spots[0].y - place.y);
                x.abs() <= reach && y.abs() <= reach
            })
        };
        if let Some(at) = self.spots.iter().position(is_near) {
            if self.spots[at].is_some_and(|known| self.rank(&spot) < self.rank(&known)) {
                self.spots[at] = Some(spot);
            }
            return;
        }
        let x_of = |at: &usize| self.spots[*at].map_or(f64::NEG_INFINITY, |known| known.spots[0].x);
        let leftmost = (0..REMEMBERED).reduce(|a, b| if x_of(&b) < x_of(&a) { b } else { a }).unwrap_or(0);
        if let Some(known) = self.spots[leftmost].replace(spot) {
            visit(&known);
        }
    }

    /// Tells of what lies left of all that is to come.
    fn pass(&mut self, x: f64, visit: &mut impl FnMut(&Spot)) {
        let reach = self.reach();
        for spot in self.spots.iter_mut() {
            if let Some(known) = spot.take_if(|known| known.spots[0].x < x - reach) {
                visit(&known);
            }
        }
    }
}
