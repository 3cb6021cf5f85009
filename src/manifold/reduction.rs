//! Four of many points: the deepest, the farthest from it, and the extremes on either side of the line between; those of before
//! while they are about as good.

use super::answer::FOUR;
use super::places::CommonPoint;
use crate::base::angles::sin_cos;

/// By how much less deep than the deepest point the earlier deepest may be, relative to the size of the pair: a contact at rest
/// rocks.
const AS_DEEP: f64 = 1e-5;

/// The part of the best area that the earlier points must have.
const AS_LARGE: f64 = 0.9;

/// Distances and areas count as equal that differ by this share.
const ALIKE: f64 = 1e-3;

/// The available places. If there are more, those stay that are the deepest or reach farthest in one of [`DIRECTIONS`]: no other
/// reaches farther by more than 2 % of the manifold.
const ROOM: usize = 64;

/// Directions in which places are told from each other where there is no room.
const DIRECTIONS: usize = 16;

/// Any number of places, thinned out where there is no room.
pub struct Thinned<'a> {
    places: [CommonPoint; ROOM],
    count: usize,
    /// The keys of those that stayed the last time.
    kept: &'a [u32; FOUR],
}

impl Thinned<'_> {
    pub fn new(kept: &[u32; FOUR]) -> Thinned<'_> {
        Thinned { places: [CommonPoint::NOWHERE; ROOM], count: 0, kept }
    }

    pub fn add(&mut self, place: &CommonPoint) {
        if self.count == ROOM {
            self.thin_out();
        }
        self.places[self.count] = *place;
        self.count += 1;
    }

    /// Leaves the deepest place, the earlier ones, and the farthest in each direction: a third of them at most.
    fn thin_out(&mut self) {
        let mut stays = [false; ROOM];
        stays[most(&self.places, |place| -place.gap())] = true;
        for direction in 0..DIRECTIONS {
            let (sine, cosine) = sin_cos(std::f64::consts::TAU * direction as f64 / DIRECTIONS as f64);
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

    pub fn places(&self) -> &[CommonPoint] {
        &self.places[..self.count]
    }
}

/// A place of which four of many are chosen.
pub trait Place {
    /// Its coordinates across the normal.
    fn across(&self) -> [f64; 2];
    /// See [`CommonPoint::gap`].
    fn gap(&self) -> f64;
    /// By how much the gap may be off.
    fn error(&self) -> f64;
    /// See [`CommonPoint::key`].
    fn key(&self) -> u32;
}

impl Place for CommonPoint {
    fn across(&self) -> [f64; 2] {
        [self.spots[0].x, self.spots[0].y]
    }

    fn gap(&self) -> f64 {
        self.gap()
    }

    fn error(&self) -> f64 {
        self.error
    }

    fn key(&self) -> u32 {
        self.key()
    }
}

/// Four places, or fewer.
type Four<'a, P> = [Option<&'a P>; FOUR];

/// Those that stay. `kept` are the keys of those that stayed the last time, in order, 0 for none; `size` is a length next to the
/// pair.
#[inline(always)]
pub fn four_of<'a, P: Place>(places: &'a [P], kept: &[u32; FOUR], size: f64) -> Four<'a, P> {
    if places.len() <= FOUR {
        // A solver that takes four corners one after the other, around, turns the body.
        let order = if places.len() == FOUR { [0, 2, 1, 3] } else { [0, 1, 2, 3] };
        return order.map(|at| places.get(at));
    }
    let best = best_of(places);
    let Some(before) = these(places, kept) else { return best };
    let deepest = |four: &Four<P>| four.iter().flatten().map(|place| place.gap()).fold(f64::INFINITY, f64::min);
    let is_as_good = deepest(&before) <= deepest(&best) + AS_DEEP * size && area(&before) >= AS_LARGE * area(&best);
    if is_as_good { before } else { best }
}

/// Those of such keys; `None` where one of them is no more.
fn these<'a, P: Place>(places: &'a [P], keys: &[u32; FOUR]) -> Option<Four<'a, P>> {
    let mut these = [None; FOUR];
    for (place, key) in these.iter_mut().zip(keys).filter(|(_, key)| **key != 0) {
        *place = Some(places.iter().find(|place| place.key() == *key)?);
    }
    Some(these)
}

fn best_of<P: Place>(places: &[P]) -> Four<'_, P> {
    let first = &places[most(places, |place| -place.gap())];
    let second = &places[first_most(places, |place| apart(first, place).norm_squared())];
    let line = apart(first, second);
    let side = |place: &P| line.perp(&apart(first, place));
    let extreme = |sign: f64| {
        let place = &places[first_most(places, |place| sign * side(place))];
        (sign * side(place) > place.error() * line.norm()).then_some(place)
    };
    [Some(first), Some(second), extreme(1.0), extreme(-1.0)]
}

type Across = nalgebra::Vector2<f64>;

/// From one place to another, across the normal.
#[inline(always)]
fn apart<P: Place>(from: &P, to: &P) -> Across {
    let ([x, y], [to_x, to_y]) = (from.across(), to.across());
    Across::new(to_x - x, to_y - y)
}

/// The place with the most of something; the first of equals.
#[inline(always)]
fn most<P>(places: &[P], measure: impl Fn(&P) -> f64) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (at, place) in places.iter().enumerate() {
        let value = measure(place);
        if value > best.1 {
            best = (at, value);
        }
    }
    best.0
}

/// The first place with nearly the most of something. Corners of a regular body tie: the least motion would exchange them.
#[inline(always)]
fn first_most<P>(places: &[P], measure: impl Fn(&P) -> f64) -> usize {
    let nearly = (1.0 - ALIKE) * measure(&places[most(places, &measure)]);
    places.iter().position(|place| measure(place) >= nearly).unwrap_or(0)
}

/// Twice the area of a quadrilateral whose first two places are one diagonal; one that is missing is where the first is.
fn area<P: Place>(four: &Four<P>) -> f64 {
    let Some(first) = four[0] else { return 0.0 };
    let arm = |place: Option<&P>| place.map_or(Across::zeros(), |place| apart(first, place));
    arm(four[1]).perp(&(arm(four[3]) - arm(four[2]))).abs()
}
