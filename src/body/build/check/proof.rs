//! An independent proof that a surface is the convex hull of the points it was made from.

use super::duplicates::first_of_equal;
use super::edges::{Matching, match_edges};
use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, filled, with_capacity};
use crate::base::predicates::ExactPoints;
use crate::base::progress::Progress;
use crate::body::build::hull::Hull;

/// Proves with exact predicates that `hull` is what [`Hull`] says of `points`, trusting nothing of
/// the builder. O(n) for points that are hull vertices, and about O(√n) for each other one.
///
/// In three dimensions the following are checked, and together they are a proof:
/// 1. Every edge is used by two triangles, in opposite directions: a closed oriented surface (taken
///    apart where it touches itself in a vertex only).
/// 2. One point c lies strictly behind every triangle. So central projection from c maps every
///    triangle one to one and with the same orientation onto a spherical triangle, triangles that
///    meet at an edge to opposite sides of it: a branched covering of the sphere.
/// 3. One ray from c, through the inside of one triangle, touches no other triangle: the covering
///    has one sheet. So there are no branch points, the projection is one to one, the surface is
///    connected, of genus 0, a 2-manifold at its vertices too, and bounds a body that is
///    star-shaped about c. (Without this a surface may wind twice.)
/// 4. No triangle's third corner is strictly above the plane of a neighbour: the body is locally
///    convex, and closed and connected, hence convex (H. Tietze, 1928; S. Nakajima, 1928).
/// 5. Every other point lies behind the triangle that the ray from c through it meets.
/// 6. Every vertex is extreme: three edges or more meet there between triangles that are not coplanar.
///
/// # Errors
/// [`Error::Bug`], naming the triangle, edge or point at fault; [`Error::Memory`].
pub fn check_hull(points: &[Vector], hull: &Hull) -> Result<()> {
    check_hull_in_steps(points, hull, &mut Progress::new(&mut |_| true))
}

/// Same as [`check_hull`], with progress reports.
///
/// # Errors
/// Same as [`check_hull`]; [`Error::Cancelled`] when the caller does not want to go on.
pub fn check_hull_in_steps(points: &[Vector], hull: &Hull, progress: &mut Progress) -> Result<()> {
    let count = points.len() as u32;
    let named = hull.vertices.iter().chain(hull.triangles.iter().flatten());
    if let Some(v) = named.clone().find(|v| **v >= count) {
        return fault(format!("index {v} is out of range"));
    }
    if !hull.vertices.is_sorted_by(|a, b| a < b) {
        return fault("the vertices are not ascending".into());
    }
    let mut is_vertex = filled(false, points.len())?;
    for &v in &hull.vertices {
        is_vertex[v as usize] = true;
    }
    check_lowest_duplicates(points, &is_vertex, &mut progress.part(0.0, 0.1))?;
    match hull.dimension {
        3 => check_solid(points, hull, &is_vertex, &mut progress.part(0.1, 1.0)),
        2 => check_polygon(points, hull),
        1 => check_segment(points, hull),
        0 => {
            let [v] = hull.vertices[..] else {
                return fault("a point has one vertex".into());
            };
            match points.iter().position(|p| *p != points[v as usize]) {
                Some(i) => fault(format!("point {i} differs from the hull's only vertex {v}")),
                None => Ok(()),
            }
        }
        d => fault(format!("dimension {d}")),
    }
}

fn fault<T>(message: String) -> Result<T> {
    Err(Error::Bug(format!("convex hull: {message}")))
}

/// Among exactly equal points only the first may be a vertex.
fn check_lowest_duplicates(points: &[Vector], is_vertex: &[bool], progress: &mut Progress) -> Result<()> {
    let first = first_of_equal(points, progress)?;
    match (0..points.len()).find(|&i| is_vertex[i] && first[i] != i as u32) {
        Some(i) => fault(format!("vertex {i} equals point {}", first[i])),
        None => Ok(()),
    }
}

/// The two ends of collinear points.
fn check_segment(points: &[Vector], hull: &Hull) -> Result<()> {
    let ([a, b], []) = (&hull.vertices[..], &hull.triangles[..]) else {
        return fault("a segment has two vertices and no triangle".into());
    };
    let key = |i: u32| <[f64; 3]>::from(points[i as usize]);
    let (low, high) = if key(*a) < key(*b) { (*a, *b) } else { (*b, *a) };
    if key(low) == key(high) {
        return fault("a segment's ends coincide".into());
    }
    let exact = ExactPoints::new(points)?;
    for p in 0..points.len() as u32 {
        // On a line, the order by x, then y, then z is the order along the line.
        if !exact.collinear([low, high, p]) || key(p) < key(low) || key(p) > key(high) {
            return fault(format!("point {p} is not on the segment {low}-{high}"));
        }
    }
    Ok(())
}

/// A strictly convex polygon, twice, that holds all points.
fn check_polygon(points: &[Vector], hull: &Hull) -> Result<()> {
    let exact = ExactPoints::new(points)?;
    let sides = hull.triangles.len() / 2;
    let (front, back) = hull.triangles.split_at(sides);
    let (Some(&first), true) = (front.first(), hull.vertices.len() == sides + 2) else {
        return fault(format!("{} triangles on {} vertices", hull.triangles.len(), hull.vertices.len()));
    };
    let is_fan = front.windows(2).all(|t| t[0][0] == t[1][0] && t[0][2] == t[1][1]);
    let is_mirrored = front.iter().zip(back).all(|(f, b)| [f[0], f[2], f[1]] == *b);
    if back.len() != sides || !is_fan || !is_mirrored {
        return fault("the triangles of a flat hull are not a fan and its mirror image".into());
    }
    let corners: Vec<u32> = collected(first[..2].iter().copied().chain(front.iter().map(|t| t[2])))?;
    let mut sorted = copied(&corners)?;
    sorted.sort_unstable();
    if sorted != hull.vertices {
        return fault("the triangles do not use the vertices".into());
    }
    let Some(axis) = (0..3).find(|k| exact.projected_orientation(*k, first) != 0.0) else {
        return fault(format!("the corners {first:?} of a flat hull are collinear"));
    };
    let side = exact.projected_orientation(axis, first).signum();
    let turn = |a: u32, b: u32, c: u32| side * exact.projected_orientation(axis, [a, b, c]);
    let corner = |i: usize| corners[i % corners.len()];
    for i in 0..corners.len() {
        if turn(corner(i), corner(i + 1), corner(i + 2)) <= 0.0 {
            return fault(format!("the polygon is not strictly convex at vertex {}", corner(i + 1)));
        }
    }
    // Left turns alone do not keep a polygon from winding twice; a fan of triangles of one
    // orientation does.
    if let Some(t) = front.iter().find(|t| turn(t[0], t[1], t[2]) <= 0.0) {
        return fault(format!("triangle {t:?} of a flat hull is turned over"));
    }
    for p in 0..points.len() as u32 {
        if exact.orientation(first, p) != 0.0 {
            return fault(format!("point {p} is not in the plane of a flat hull"));
        }
        // The triangle of the fan whose wedge holds p, by bisection on the spokes.
        let wedge = front[1..].partition_point(|t| turn(t[0], t[1], p) >= 0.0);
        let [a, b, c] = front[wedge];
        let holds =
            turn(a, corner(1), p) >= 0.0 && turn(corners[corners.len() - 1], a, p) >= 0.0 && turn(b, c, p) >= 0.0;
        if !holds {
            return fault(format!("point {p} is outside of a flat hull"));
        }
    }
    Ok(())
}

/// The proof in three dimensions.
fn check_solid(points: &[Vector], hull: &Hull, is_vertex: &[bool], progress: &mut Progress) -> Result<()> {
    let triangles = &hull.triangles;
    let mut used = filled(false, points.len())?;
    for t in triangles {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            return fault(format!("triangle {t:?} repeats a vertex"));
        }
        for v in t {
            used[*v as usize] = true;
        }
    }
    if let Some(i) = (0..points.len()).find(|&i| used[i] != is_vertex[i]) {
        return fault(format!("point {i} is listed as a vertex or used by a triangle, but not both"));
    }
    let edges = hull.edges()?;
    let twins = match match_edges(points.len(), &edges, &mut progress.part(0.0, 0.2))? {
        Matching::Twins(twins) => twins,
        Matching::Fault(uses) => {
            let (tail, head) = edges[uses[0] as usize];
            return fault(format!("edge {tail}-{head} is not used twice in opposite directions"));
        }
    };

    // 2. and 3. with c and the target of the ray in doubles, or if these are not good enough, with
    //    exact averages.
    let Some(start) = largest_triangle(points, triangles) else {
        return fault("no triangles".into());
    };
    let centre = mean(hull.vertices.iter().map(|v| points[*v as usize]));
    let target = mean(triangles[start].iter().map(|v| points[*v as usize]));
    let mut extended = with_capacity(points.len() + 2)?;
    extended.extend_from_slice(points);
    extended.extend([centre, target]);
    let (c, g) = (points.len() as u32, points.len() as u32 + 1);
    let mut exact = ExactPoints::new(&extended)?;
    if !is_proper_ray(&exact, triangles, start, [c, g], &mut progress.part(0.2, 0.4))? {
        let [p, q, r] = triangles[start];
        exact = ExactPoints::new(points)?;
        // A point off the plane of one triangle makes the average of all four strictly interior.
        let Some(s) = hull.vertices.iter().copied().find(|v| exact.orientation([p, q, r], *v) != 0.0) else {
            return fault("a solid hull is flat".into());
        };
        exact.push_average([p, q, r, s])?;
        exact.push_average([p, p, q, r])?;
        let progress = &mut progress.part(0.4, 0.5);
        for (done, t) in triangles.iter().enumerate() {
            progress.step(done, triangles.len())?;
            if exact.orientation(*t, c) >= 0.0 {
                return fault(format!("triangle {t:?} is not strictly in front of an interior point"));
            }
        }
    }
    // Signs of (c, tail, head, g): whether g is on the inner side of the cone over the triangle at
    // that edge.
    let mut inside = filled(0.0, edges.len())?;
    let of_cones = &mut progress.part(0.5, 0.7);
    for (corner, &(tail, head)) in edges.iter().enumerate() {
        of_cones.step(corner, edges.len())?;
        let twin = twins[corner] as usize;
        inside[corner] = if twin < corner { -inside[twin] } else { exact.orientation([c, tail, head], g) };
    }
    for (t, signs) in inside.chunks_exact(3).enumerate() {
        if signs.iter().all(|s| *s >= 0.0) != (t == start) {
            return fault(format!("triangles {:?} and {:?} overlap", triangles[start], triangles[t]));
        }
    }

    let mut sharp_edges = filled(0, points.len())?;
    let of_edges = &mut progress.part(0.7, 0.9);
    for (corner, &twin) in twins.iter().enumerate() {
        of_edges.step(corner, twins.len())?;
        if twin as usize > corner {
            let (tail, head) = edges[corner];
            let across = edges[previous(twin) as usize].0;
            let height = exact.orientation(triangles[corner / 3], across);
            if height > 0.0 {
                return fault(format!("edge {tail}-{head} is not convex"));
            }
            if height < 0.0 {
                sharp_edges[tail as usize] += 1;
                sharp_edges[head as usize] += 1;
            }
        }
    }
    if let Some(v) = hull.vertices.iter().find(|v| sharp_edges[**v as usize] < 3) {
        return fault(format!("vertex {v} is not extreme"));
    }

    let planes = collected(triangles.iter().map(|t| exact.plane(*t)))?;
    let mut at = start;
    let of_others = &mut progress.part(0.9, 1.0);
    for p in (0..points.len() as u32).filter(|p| !is_vertex[*p as usize]) {
        of_others.step(p as usize, points.len())?;
        at = pierced_triangle(&exact, triangles, &twins, [c, p], at);
        if exact.height(&planes[at], p) > 0.0 {
            return fault(format!("point {p} is above triangle {:?}", triangles[at]));
        }
    }
    Ok(())
}

/// The corner before this one in its triangle.
fn previous(corner: u32) -> u32 {
    corner - corner % 3 + (corner + 2) % 3
}

/// Whether c is strictly behind all triangles and the ray from c to g passes through the inside of
/// triangle `start`.
fn is_proper_ray(
    exact: &ExactPoints,
    triangles: &[[u32; 3]],
    start: usize,
    [c, g]: [u32; 2],
    progress: &mut Progress,
) -> Result<bool> {
    for (done, t) in triangles.iter().enumerate() {
        progress.step(done, triangles.len())?;
        if exact.orientation(*t, c) >= 0.0 {
            return Ok(false);
        }
    }
    let [p, q, r] = triangles[start];
    Ok([[c, p, q], [c, q, r], [c, r, p]].iter().all(|side| exact.orientation(*side, g) > 0.0))
}

/// The triangle that the ray from c through p meets, by a walk from `start`. The cones over the
/// triangles of a convex surface are the projection of a convex function's pieces, so the walk
/// cannot run in circles, unless through coplanar triangles; hence the bound, after which every
/// triangle is tried.
fn pierced_triangle(
    exact: &ExactPoints,
    triangles: &[[u32; 3]],
    twins: &[u32],
    [c, p]: [u32; 2],
    start: usize,
) -> usize {
    let exit = |t: usize| {
        let corners = triangles[t];
        (0..3).find(|&i| exact.orientation([c, corners[i], corners[(i + 1) % 3]], p) < 0.0)
    };
    let mut at = start;
    for _ in 0..triangles.len() {
        match exit(at) {
            None => return at,
            Some(side) => at = twins[3 * at + side] as usize / 3,
        }
    }
    (0..triangles.len()).find(|&t| exit(t).is_none()).unwrap_or(at)
}

/// About the mean of some points; each is divided first, so that nothing overflows.
fn mean(points: impl ExactSizeIterator<Item = Vector>) -> Vector {
    let weight = 1.0 / points.len() as f64;
    points.map(|p| p * weight).sum()
}

/// The triangle with about the largest area.
fn largest_triangle(points: &[Vector], triangles: &[[u32; 3]]) -> Option<usize> {
    let scale = points.iter().map(|p| p.amax()).fold(f64::MIN_POSITIVE, f64::max);
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| points[v as usize] / scale);
        (b - a).cross(&(c - a)).norm_squared()
    };
    (0..triangles.len()).max_by(|&s, &t| area(&triangles[s]).total_cmp(&area(&triangles[t])))
}
