//! Four of many points: the deepest, the farthest from it, and the extremes on either side of the line between; those of before
//! while they are about as good.

use super::answer::FOUR;
use super::places::CommonPoint;
use crate::base::math::Vector;

/// By how much less deep than the deepest the deepest of before may be, relative to the size of the pair: a contact at rest rocks.
const AS_DEEP: f64 = 1e-5;

/// The part of the area that those of before must have of the best.
const AS_LARGE: f64 = 0.9;

/// Places at hand, as of two outlines of few corners, so that less has to be cleared …
pub const LITTLE_ROOM: usize = 24;

/// … and as of any. Of more, those stay that are the deepest or reach farthest in one of [`DIRECTIONS`]: no other reaches farther
/// by more than 2 % of the manifold.
pub const ROOM: usize = 64;

/// Directions in which places are told from each other where there is no room.
const DIRECTIONS: usize = 16;

/// Places of which some stay.
pub struct Reduction<const N: usize> {
    places: [CommonPoint; N],
    count: usize,
    /// The keys of those that stayed the last time, in order; 0 for none.
    kept: [u32; FOUR],
    /// What is a length next to the pair.
    size: f64,
}

impl<const N: usize> Reduction<N> {
    pub fn new(kept: [u32; FOUR], size: f64) -> Reduction<N> {
        Reduction { places: [CommonPoint::NOWHERE; N], count: 0, kept, size }
    }

    pub fn add(&mut self, place: &CommonPoint) {
        if self.count == N {
            self.thin_out();
        }
        self.places[self.count] = *place;
        self.count += 1;
    }

    /// Leaves the deepest place, those of before, and the farthest in each direction: a third of them at most.
    fn thin_out(&mut self) {
        let mut stays = [false; N];
        stays[most(&self.places, |place| -place.gap())] = true;
        for direction in 0..DIRECTIONS {
            let (sine, cosine) = (std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64).sin_cos();
            stays[most(&self.places, |place| cosine * place.spots[0].x + sine * place.spots[0].y)] = true;
        }
        self.count = 0;
        for (at, stays) in stays.into_iter().enumerate() {
            if stays || self.kept.contains(&self.places[at].key()) {
                self.places[self.count] = self.places[at];
                self.count += 1;
            }
        }
    }

    /// Those that stay, and their keys.
    pub fn chosen(&self) -> ([Option<CommonPoint>; FOUR], [u32; FOUR]) {
        let places = &self.places[..self.count];
        if self.count <= FOUR {
            let chosen = std::array::from_fn(|i| places.get(i).copied());
            return (chosen, keys_of(&chosen));
        }
        let best = self.best();
        let before = self.kept.map(|key| places.iter().find(|place| key != 0 && place.key() == key).copied());
        let deepest = |chosen: &[Option<CommonPoint>; FOUR]| {
            chosen.iter().flatten().map(CommonPoint::gap).fold(f64::INFINITY, f64::min)
        };
        let is_as_good = keys_of(&before) == self.kept
            && deepest(&before) <= deepest(&best) + AS_DEEP * self.size
            && area(&before) >= AS_LARGE * area(&best);
        let chosen = if is_as_good { before } else { best };
        (chosen, keys_of(&chosen))
    }

    fn best(&self) -> [Option<CommonPoint>; FOUR] {
        let places = &self.places[..self.count];
        let first = &places[most(places, |place| -place.gap())];
        let second = &places[most(places, |place| apart(first, place).norm_squared())];
        let line = apart(first, second);
        let side = |place: &CommonPoint| line.perp(&apart(first, place));
        let extreme = |sign: f64| {
            let place = &places[most(places, |place| sign * side(place))];
            (sign * side(place) > place.error * line.norm()).then_some(*place)
        };
        [Some(*first), Some(*second), extreme(1.0), extreme(-1.0)]
    }
}

type Across = nalgebra::Vector2<f64>;

/// From one place to another, across the normal.
fn apart(from: &CommonPoint, to: &CommonPoint) -> Across {
    let difference: Vector = to.spots[0] - from.spots[0];
    difference.xy()
}

/// The place with the most of something; the first of equals.
fn most(places: &[CommonPoint], measure: impl Fn(&CommonPoint) -> f64) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (at, place) in places.iter().enumerate() {
        let value = measure(place);
        if value > best.1 {
            best = (at, value);
        }
    }
    best.0
}

fn keys_of(chosen: &[Option<CommonPoint>; FOUR]) -> [u32; FOUR] {
    chosen.map(|place| place.map_or(0, |place| place.key()))
}

/// Twice the area of a quadrilateral whose first two places are one diagonal; one that is missing is where the first is.
fn area(chosen: &[Option<CommonPoint>; FOUR]) -> f64 {
    let Some(first) = &chosen[0] else { return 0.0 };
    let arm = |place: &Option<CommonPoint>| place.map_or(Across::zeros(), |place| apart(first, &place));
    arm(&chosen[1]).perp(&(arm(&chosen[3]) - arm(&chosen[2]))).abs()
}
