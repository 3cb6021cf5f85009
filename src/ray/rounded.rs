//! First touch of a line with a point, a segment or a triangle with a ball swept over it, by closed forms in plain doubles. They
//! propose.
//!
//! For a hull of up to four corners with a ball, it is the first of the touches with its points, sides and triangles. The line
//! goes from the origin along a unit vector.

use crate::base::math::{Vector, is_unit};

/// A vertex in the world, relative to the ray's origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    pub vertex: u32,
    pub place: Vector,
}

/// The first touch of a line with a hull of corners with a ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Touch {
    /// How far along the line.
    pub at: f64,
    /// The corners that hold the nearest point of the hull: as many as count, the first repeated.
    pub corners: [Corner; 3],
    pub count: usize,
    /// Their convex weights in that point.
    pub weights: [f64; 3],
    /// That point.
    pub foot: Vector,
    /// The unit vector from there to the line.
    pub normal: Vector,
}

/// The first touch, if the line meets any, for corners without a touch that `new` has no part in.
pub(super) fn first_touch(along: &Vector, radius: f64, kept: &[Corner], new: Corner) -> Option<Touch> {
    debug_assert!(is_unit(along) && radius > 0.0 && kept.len() <= 3);
    let mut first = of_point(along, radius, new);
    let mut look = |touch: Option<Touch>| {
        if let Some(touch) = touch
            && first.is_none_or(|first| touch.at < first.at)
        {
            first = Some(touch);
        }
    };
    for (k, &corner) in kept.iter().enumerate() {
        look(of_segment(along, radius, [new, corner]));
        kept[..k].iter().for_each(|&other| look(of_triangle(along, radius, [new, other, corner])));
    }
    first
}

/// The feature of some corners that is nearest to the line, seen along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Beside {
    /// One or two.
    pub corners: [Corner; 2],
    pub count: usize,
    /// From the line to the nearest point.
    pub across: Vector,
}

/// The nearest to a line that does not pass between the corners, for corners with none nearer that `new` has no part in.
pub(super) fn nearest_beside(along: &Vector, kept: &[Corner], new: Corner) -> Beside {
    let seen = |corner: Corner| corner.place - along * corner.place.dot(along);
    let from = seen(new);
    let mut nearest = Beside { corners: [new; 2], count: 1, across: from };
    for &corner in kept {
        let side = seen(corner) - from;
        let across = from - side * (from.dot(&side) / side.norm_squared());
        let is_between = from.dot(&side) < 0.0 && seen(corner).dot(&side) > 0.0;
        if is_between && across.norm_squared() < nearest.across.norm_squared() {
            nearest = Beside { corners: [new, corner], count: 2, across };
        }
    }
    nearest
}

/// The quadratic equation of a ball.
fn of_point(along: &Vector, radius: f64, corner: Corner) -> Option<Touch> {
    let foot = corner.place;
    let nearest = foot.dot(along);
    let square = (foot - along * nearest).norm_squared();
    // False for a NaN, here as below.
    if !(square <= radius * radius) {
        return None;
    }
    let at = nearest - (radius * radius - square).sqrt();
    let normal = (along * at - foot).normalize();
    Some(Touch { at, corners: [corner; 3], count: 1, weights: [1.0, 0.0, 0.0], foot, normal })
}

/// The quadratic equation of a cylinder, across its axis.
fn of_segment(along: &Vector, radius: f64, [a, b]: [Corner; 2]) -> Option<Touch> {
    let axis = b.place - a.place;
    let length = axis.norm_squared();
    let [slope, start] = [along.dot(&axis) / length, a.place.dot(&axis) / length];
    let (across, place) = (along - axis * slope, a.place - axis * start);
    let spread = across.norm_squared();
    let nearest = across.dot(&place) / spread;
    let square = (place - across * nearest).norm_squared();
    if !(square <= radius * radius) {
        return None;
    }
    let at = nearest - ((radius * radius - square) / spread).sqrt();
    let weight = at * slope - start;
    if !(0.0..=1.0).contains(&weight) {
        return None;
    }
    // Perpendicular to the axis up to rounding of its own length: else a long side would reach far beyond the plane.
    let normal = across * at - place;
    let normal = (normal - axis * (normal.dot(&axis) / length)).normalize();
    Some(Touch {
        at,
        corners: [a, b, a],
        count: 2,
        weights: [1.0 - weight, weight, 0.0],
        foot: a.place + axis * weight,
        normal,
    })
}

/// The plane on the side that the line comes from.
fn of_triangle(along: &Vector, radius: f64, corners: [Corner; 3]) -> Option<Touch> {
    let [a, b, c] = corners.map(|corner| corner.place);
    let (side, other) = (b - a, c - a);
    let across = side.cross(&other);
    let square = across.norm_squared();
    let unit = across / square.sqrt();
    let normal = if unit.dot(along) > 0.0 { -unit } else { unit };
    let at = (normal.dot(&a) + radius) / normal.dot(along);
    let from = along * at - normal * radius - a;
    let second = from.cross(&other).dot(&across) / square;
    let third = side.cross(&from).dot(&across) / square;
    let first = 1.0 - second - third;
    if !(first >= 0.0 && second >= 0.0 && third >= 0.0) {
        return None;
    }
    let foot = a + side * second + other * third;
    Some(Touch { at, corners, count: 3, weights: [first, second, third], foot, normal })
}
