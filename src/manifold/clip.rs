//! The common part of two outlines, in one sweep from left to right: its corners are corners of one inside the other, and
//! crossings. Time in proportion to the corners; nothing is stored.
//!
//! Points nearer to each other than `coincident` count as one place: there a corner represents crossings, and the reference's
//! corner represents the other's. So sides that lie on each other have no crossings, which could be anywhere along them. Nor does
//! it depend on the last bit which of two aligned corners speaks.

use super::outline::{Chain, Outline};
use crate::base::math::Vector;
use std::cmp::Ordering;

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
    /// A point of either patch, which is a point of its body up to the patch's slack and rounding: no plane is taken beyond its
    /// sides.
    pub spots: [Vector; 2],
    /// By how much the gap may be off.
    pub error: f64,
}

impl Spot {
    fn gap(&self) -> f64 {
        self.spots[0].z - self.spots[1].z
    }
}

/// How exact the sweep is.
#[derive(Debug, Clone, Copy)]
pub struct Precision {
    /// The rounding error of a length.
    pub rounding: f64,
    /// Points nearer to each other than this count as one place; much more than the rounding.
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
        if (side == 0 || !is_end)
            && let Some((point, error)) = other_point(outlines, &chains[1 - body], body, &chain.to, precision)
        {
            let corner = CommonCorner::Vertex { body, corner: chain.corner };
            let mut spots = [chain.to; 2];
            spots[1 - body] = point;
            recent.report(Spot { corner, spots, error }, &mut visit);
        }
        pending[body][side] = chains[body][side].advance();
        if pending[body][side] {
            for other in 0..2 {
                let both = if body == 0 {
                    [&chains[0][side], &chains[1][other]]
                } else {
                    [&chains[0][other], &chains[1][side]]
                };
                if let Some(mut crossing) = crossing(both, precision) {
                    crossing.error += error_at_sides(outlines, precision);
                    recent.report(crossing, &mut visit);
                }
            }
        }
    }
    recent.pass(f64::INFINITY, &mut visit);
}

/// The chain with the leftmost next event.
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

/// The other patch's point for a corner of a body's, and by how much the gap of the two may be off. `None` where the corner is
/// neither over that patch nor at one place with a side.
fn other_point(
    outlines: &[Outline; 2],
    others: &[Chain; 2],
    body: usize,
    place: &Vector,
    precision: &Precision,
) -> Option<(Vector, f64)> {
    if is_between(others, place, precision)
        && let Some((height, error)) = height_over(outlines, body, place, precision)
    {
        return Some((Vector::new(place.x, place.y, height), error));
    }
    // The nearer of two sides or, as for a patch that stands upright, the one that is more towards the body.
    let towards = if body == 0 { 1.0 } else { -1.0 };
    let value = |(point, off): (Vector, f64)| (point, towards * point.z - off);
    let near = others.iter().filter_map(|chain| chain.point_near(place, precision.coincident, towards)).map(value);
    let (point, _) = near.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    Some((point, error_at_sides(outlines, precision)))
}

/// How high the other outline is over a corner of a body's, and by how much the gap there may be off. `None` where that outline has
/// no height.
fn height_over(outlines: &[Outline; 2], body: usize, place: &Vector, precision: &Precision) -> Option<(f64, f64)> {
    let (height, error) = outlines[1 - body].height_at(place.x, place.y, precision.rounding)?;
    Some((height, error + outlines[body].slack + precision.rounding))
}

/// By how much the gap may be off between points of corners and sides.
#[inline(always)]
fn error_at_sides(outlines: &[Outline; 2], precision: &Precision) -> f64 {
    outlines[0].slack + outlines[1].slack + 2.0 * precision.rounding
}

/// Whether a place lies between two chains.
fn is_between(chains: &[Chain; 2], place: &Vector, precision: &Precision) -> bool {
    let (low, high) = (chains[0].at(place.x), chains[1].at(place.x));
    let off = (low.x - place.x).abs().max((high.x - place.x).abs());
    off <= precision.rounding && place.y >= low.y && place.y <= high.y
}

/// The point where the segments of two chains cross, if they do, and neither begins nor ends at the other: such an end has a
/// [point there](other_point).
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
    let coincident = precision.coincident;
    let is_near = |chain: &Chain, end: &Vector| chain.point_near(end, coincident, 1.0).is_some();
    if is_near(other, &begun.from) || is_near(another, &ended.to) {
        return None;
    }
    let share = before / (before - after);
    let spots = [begin[0] + (end[0] - begin[0]) * share, begin[1] + (end[1] - begin[1]) * share];
    // The place of the crossing along the segments is off by the rounding over how fast they part.
    let off = (2.0 * precision.rounding / (before - after).abs()).min(1.0);
    let gaps = [begin[0].z - begin[1].z, end[0].z - end[1].z];
    let corner = CommonCorner::Crossing { sides: [first.side(), second.side()] };
    Some(Spot { corner, spots, error: off * (gaps[0] - gaps[1]).abs() })
}

/// Corners that are reported later, as another at the same place may represent them.
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
            // Corners of a patch that stands upright are at one place, however high.
            let counts_more = |known: Spot| match self.rank(&spot).cmp(&self.rank(&known)) {
                Ordering::Less => true,
                Ordering::Equal => spot.gap() < known.gap() - reach,
                Ordering::Greater => false,
            };
            if self.spots[at].is_some_and(counts_more) {
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
