//! The outline of points seen along a direction.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::base::error::Result;
use crate::base::math::{Vector, length};
use crate::base::memory::{collected, filled, push, with_capacity};

/// A point seen along the direction.
#[derive(Debug, Clone, Copy)]
struct OutlineSpot {
    x: f64,
    y: f64,
    vertex: u32,
}

/// Twice the signed area of a triangle.
fn turn(a: &OutlineSpot, b: &OutlineSpot, c: &OutlineSpot) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The corners of the hull of some vertices, counter-clockwise against a unit normal, without those that are within `tolerance` of
/// the line through their neighbours. Fewer than three where there is no area.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn outline(positions: &[Vector], vertices: &[u32], normal: &Vector, tolerance: f64) -> Result<Vec<u32>> {
    let aside = normal.cross(&Vector::ith(normal.iamin(), 1.0)).normalize();
    let across = normal.cross(&aside);
    let spot = |&vertex: &u32| {
        let position = &positions[vertex as usize];
        OutlineSpot { x: aside.dot(position), y: across.dot(position), vertex }
    };
    let hull = hull_of(collected(vertices.iter().map(spot))?)?;
    without_flat_corners(&hull, tolerance)
}

/// The hull of spots, counter-clockwise (A. M. Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions", 1979).
fn hull_of(mut spots: Vec<OutlineSpot>) -> Result<Vec<OutlineSpot>> {
    spots.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.vertex.cmp(&b.vertex)));
    let mut hull: Vec<OutlineSpot> = with_capacity(2 * spots.len())?;
    for _ in 0..2 {
        let first = hull.len();
        for spot in &spots {
            while hull.len() >= first + 2 && turn(&hull[hull.len() - 2], &hull[hull.len() - 1], spot) <= 0.0 {
                hull.pop();
            }
            hull.push(*spot);
        }
        // It begins the other chain.
        hull.pop();
        spots.reverse();
    }
    Ok(hull)
}

/// Takes corners away while one is within the tolerance of the line through its neighbours, the nearest to it first: outlines only
/// shrink.
fn without_flat_corners(hull: &[OutlineSpot], tolerance: f64) -> Result<Vec<u32>> {
    let count = hull.len();
    let mut neighbours: Vec<[usize; 2]> = collected((0..count).map(|i| [(i + count - 1) % count, (i + 1) % count]))?;
    let mut is_there = filled(true, count)?;
    // The bits of numbers that are not negative are in their order.
    let height = |i: usize, [before, after]: [usize; 2]| {
        let (a, c) = (&hull[before], &hull[after]);
        (turn(a, &hull[i], c) / length(&Vector::new(c.x - a.x, c.y - a.y, 0.0))).abs().to_bits()
    };
    let mut heights = filled(0_u64, count)?;
    // One for each corner, and two more for each that goes.
    let mut next: BinaryHeap<Reverse<(u64, usize)>> = with_capacity(3 * count)?.into();
    for i in 0..count {
        heights[i] = height(i, neighbours[i]);
        next.push(Reverse((heights[i], i)));
    }
    let mut left = count;
    while let Some(Reverse((least, i))) = next.pop()
        && left > 3
        && f64::from_bits(least) <= tolerance
    {
        if !is_there[i] || heights[i] != least {
            continue;
        }
        is_there[i] = false;
        left -= 1;
        let [before, after] = neighbours[i];
        neighbours[before][1] = after;
        neighbours[after][0] = before;
        for j in [before, after] {
            heights[j] = height(j, neighbours[j]);
            next.push(Reverse((heights[j], j)));
        }
    }
    let mut corners = Vec::new();
    for i in (0..count).filter(|i| is_there[*i]) {
        push(&mut corners, hull[i].vertex)?;
    }
    Ok(corners)
}
