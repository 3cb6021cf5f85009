//! First touch of a line with a point, a segment or a triangle with a ball swept over it, by closed forms in plain doubles. They
//! propose.
//!
//! For a hull of up to four corners with a ball, it is the first of the touches with its points, sides and triangles. The line
//! goes from the origin along a unit vector.

use crate::answer::normalised;
use crate::base::math::{Vector, is_unit};

/// A vertex in the world, relative to the ray's origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct RoundedCorner {
    pub vertex: u32,
    pub place: Vector,
}

/// The first touch of a line with a hull of corners with a ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct RoundedTouch {
    /// How far along the line.
    pub at: f64,
    /// What of the corners holds the nearest point of the hull.
    pub members: Members,
    /// Their convex weights in that point.
    pub weights: [f64; 3],
    /// That point.
    pub foot: Vector,
    /// The unit vector from there to the line.
    pub normal: Vector,
}

/// Up to three of a few corners: as many as count.
#[derive(Debug, Clone, Copy)]
pub(super) struct Members {
    pub indices: [usize; 3],
    pub count: usize,
}

/// The first touch that the first of some corners has a part in, if it is sooner than another.
pub(super) fn sooner_touch(along: &Vector, radius: f64, corners: &[RoundedCorner], than: f64) -> Option<RoundedTouch> {
    debug_assert!(is_unit(along) && radius > 0.0 && corners.len() <= 4);
    let place = |k: usize| &corners[k].place;
    let mut first = of_point(along, radius, place(0)).unwrap_or(f64::INFINITY);
    let (mut members, mut weights) = (Members { indices: [0; 3], count: 1 }, [1.0, 0.0, 0.0]);
    for k in 1..corners.len() {
        if let Some((at, weight)) = of_segment(along, radius, [place(0), place(k)])
            && at < first
        {
            (first, members, weights) = (at, Members { indices: [0, k, 0], count: 2 }, [1.0 - weight, weight, 0.0]);
        }
        for other in 1..k {
            if let Some((at, of_corners)) = of_triangle(along, radius, [place(0), place(other), place(k)])
                && at < first
            {
                (first, members, weights) = (at, Members { indices: [0, other, k], count: 3 }, of_corners);
            }
        }
    }
    if !(first < than) {
        return None;
    }
    let [a, b, c] = members.indices.map(place);
    let (side, other) = (b - a, c - a);
    let foot = a + side * weights[1] + other * weights[2];
    let way = along * first - foot;
    let normal = match members.count {
        1 => way,
        // Perpendicular to a side up to the rounding of its own length: else a long one would reach far beyond the plane.
        2 => way - side * (way.dot(&side) / side.norm_squared()),
        _ => {
            let across = side.cross(&other);
            if across.dot(along) > 0.0 { -across } else { across }
        }
    };
    // For a radius whose square underflows the way may have no length: then this is a NaN, which proves nothing.
    Some(RoundedTouch { at: first, members, weights, foot, normal: normalised(&normal).into() })
}

/// The feature of some corners that is nearest to the line, seen along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    /// One or two.
    pub members: Members,
    /// From the line to the nearest point.
    pub across: Vector,
}

/// The nearest to a line that the first of some corners has a part in; the line does not pass between them.
pub(super) fn nearest_beside(along: &Vector, corners: &[RoundedCorner]) -> Beside {
    let seen = |corner: &RoundedCorner| corner.place - along * corner.place.dot(along);
    let from = seen(&corners[0]);
    let mut nearest = Beside { members: Members { indices: [0; 3], count: 1 }, across: from };
    for (k, corner) in corners.iter().enumerate().skip(1) {
        let to = seen(corner);
        let side = to - from;
        let across = from - side * (from.dot(&side) / side.norm_squared());
        let is_between = from.dot(&side) < 0.0 && to.dot(&side) > 0.0;
        if is_between && across.norm_squared() < nearest.across.norm_squared() {
            nearest = Beside { members: Members { indices: [0, k, 0], count: 2 }, across };
        }
    }
    nearest
}

/// The quadratic equation of a ball.
fn of_point(along: &Vector, radius: f64, place: &Vector) -> Option<f64> {
    let nearest = place.dot(along);
    let square = (place - along * nearest).norm_squared();
    // False for a NaN, here as below.
    (square <= radius * radius).then(|| nearest - (radius * radius - square).sqrt())
}

/// The quadratic equation of a cylinder, across its axis; and the weight of the second end.
fn of_segment(along: &Vector, radius: f64, [a, b]: [&Vector; 2]) -> Option<(f64, f64)> {
    let axis = b - a;
    let inverse = 1.0 / axis.norm_squared();
    let [slope, start] = [along.dot(&axis) * inverse, a.dot(&axis) * inverse];
    let (across, place) = (along - axis * slope, a - axis * start);
    let spread = across.norm_squared();
    let nearest = across.dot(&place) / spread;
    let square = (place - across * nearest).norm_squared();
    if !(square <= radius * radius) {
        return None;
    }
    let at = nearest - ((radius * radius - square) / spread).sqrt();
    let weight = at * slope - start;
    (0.0..=1.0).contains(&weight).then_some((at, weight))
}

/// The plane on the side that the line comes from; and the weights of the corners.
fn of_triangle(along: &Vector, radius: f64, [a, b, c]: [&Vector; 3]) -> Option<(f64, [f64; 3])> {
    let (side, other) = (b - a, c - a);
    let across = side.cross(&other);
    let inverse = 1.0 / across.norm_squared();
    let unit = across * inverse.sqrt();
    let slope = unit.dot(along);
    let outwards = if slope > 0.0 { -radius } else { radius };
    let at = (unit.dot(a) + outwards) / slope;
    let from = along * at - unit * outwards - a;
    let second = from.cross(&other).dot(&across) * inverse;
    let third = side.cross(&from).dot(&across) * inverse;
    let first = 1.0 - second - third;
    (first >= 0.0 && second >= 0.0 && third >= 0.0).then_some((at, [first, second, third]))
}
