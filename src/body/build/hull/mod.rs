//! The exact convex hull of points: every sign that decides is exact, so the result is a convex polytope in the mathematical sense,
//! whatever the input. In three dimensions it is made by [`quickhull`].

mod quickhull;

use quickhull::Quickhull;

use crate::base::error::{Error, Result};
use crate::base::locality::{along_curve, in_order, is_identity, sort_triangles};
use crate::base::math::Vector;
use crate::base::memory::{collected, listed, push, with_capacity};
use crate::base::predicates::ExactPoints;
use crate::base::progress::Progress;
use crate::base::sorting::sort_in_steps;
use crate::body::mesh::check_vertex;

/// The exact convex hull of a point set, as a triangulated surface over the input's indices.
///
/// | dimension | `triangles` |
/// |---|---|
/// | 3 | a closed, consistently oriented 2-manifold of genus 0, counter-clockwise from outside; neighbouring triangles may be exactly coplanar |
/// | 2 | the convex polygon twice, once for each side |
/// | 1, 0 | none |
#[derive(Debug, Clone, PartialEq)]
pub struct Hull {
    /// The exact affine dimension of the points: 0 (one point), 1, 2 or 3.
    pub dimension: u8,
    /// Indices of the extreme points, ascending: those that are not in the hull of the others. For exact duplicates, the lowest
    /// index. In dimension 1 these are the two end points, in dimension 0 the one point.
    pub vertices: Vec<u32>,
    /// Corners as indices into the input points.
    pub triangles: Vec<[u32; 3]>,
}

impl Hull {
    /// The directed edges of the triangles, three each.
    pub(crate) fn edges(&self) -> Result<Vec<(u32, u32)>> {
        let mut edges = with_capacity(3 * self.triangles.len())?;
        edges.extend(self.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]));
        Ok(edges)
    }
}

/// The largest number of points that a hull is made of.
const MOST_POINTS: usize = 1 << 30;

/// The share of a hull's time that putting the points in order takes, about.
const SHARE_OF_ORDER: f64 = 0.05;

/// The exact convex hull of `points`.
///
/// # Errors
/// [`Error::Argument`] for no points, [`Error::Limit`] for more than 2³⁰, [`Error::Mesh`] for one that is not finite.
pub fn convex_hull(points: &[Vector]) -> Result<Hull> {
    convex_hull_in_steps(points, &mut Progress::new(&mut |_| true))
}

/// Same as [`convex_hull`], with progress reports.
///
/// # Errors
/// Same as [`convex_hull`]; [`Error::Cancelled`] when the caller does not want to go on.
pub fn convex_hull_in_steps(points: &[Vector], progress: &mut Progress) -> Result<Hull> {
    check_points(points)?;
    // Along the curve: neighbours on the hull are then near in memory.
    let order = along_curve(points, &mut progress.part(0.0, SHARE_OF_ORDER))?;
    let progress = &mut progress.part(SHARE_OF_ORDER, 1.0);
    if is_identity(&order) {
        return hull_in_order(points, progress);
    }
    let sorted = in_order(points, &order, &mut progress.part(0.0, SHARE_OF_ORDER))?;
    let mut hull = hull_in_order(&sorted, &mut progress.part(SHARE_OF_ORDER, 1.0))?;
    for v in hull.vertices.iter_mut().chain(hull.triangles.iter_mut().flatten()) {
        *v = order[*v as usize];
    }
    hull.vertices.sort_unstable();
    Ok(hull)
}

/// Whether points are some that a hull is made of.
///
/// # Errors
/// Same as [`convex_hull`].
pub fn check_points(points: &[Vector]) -> Result<()> {
    if points.is_empty() {
        return Err(Error::Argument("a convex hull needs at least one point".into()));
    }
    if points.len() > MOST_POINTS {
        return Err(Error::Limit(format!("{} points; a convex hull takes at most {MOST_POINTS}", points.len())));
    }
    points.iter().enumerate().try_for_each(|(v, point)| check_vertex(v, point))
}

/// The hull of finite points in about the order of the curve.
fn hull_in_order(points: &[Vector], progress: &mut Progress) -> Result<Hull> {
    let exact = ExactPoints::new_in_steps(points, &mut progress.part(0.0, 0.05))?;
    match AffineBasis::find(points, &exact, &mut progress.part(0.05, 0.1))? {
        AffineBasis::Point(a) => Ok(Hull { dimension: 0, vertices: listed([a]), triangles: Vec::new() }),
        AffineBasis::Line => Ok(segment(points)),
        AffineBasis::Plane(corners) => polygon(points, &exact, corners, &mut progress.part(0.1, 1.0)),
        AffineBasis::Space(corners) => {
            let hull = Quickhull::run(&exact, corners, &mut progress.part(0.1, 0.85))?;
            let vertices = hull.extreme_vertices(&mut progress.part(0.85, 0.9))?;
            let mut triangles = hull.triangles()?;
            // Euler's formula: a triangulated sphere has half as many vertices as triangles, and two.
            if vertices.len() == triangles.len() / 2 + 2 {
                sort_triangles(&mut triangles, points.len(), &mut progress.part(0.9, 1.0))?;
                Ok(Hull { dimension: 3, vertices, triangles })
            } else {
                hull_of_some(points, &vertices, &mut progress.part(0.9, 1.0))
            }
        }
    }
}

/// The hull of the points named in `some`, ascending and without duplicates.
fn hull_of_some(points: &[Vector], some: &[u32], progress: &mut Progress) -> Result<Hull> {
    debug_assert!(some.is_sorted_by(|a, b| a < b));
    debug_assert!(some.iter().all(|v| (*v as usize) < points.len()));
    let chosen: Vec<Vector> = collected(some.iter().map(|&v| points[v as usize]))?;
    let mut hull = hull_in_order(&chosen, progress)?;
    for v in hull.vertices.iter_mut().chain(hull.triangles.iter_mut().flatten()) {
        *v = some[*v as usize];
    }
    Ok(hull)
}

/// As many points as span the affine hull of a point set; with the exact dimension.
enum AffineBasis {
    Point(u32),
    Line,
    Plane([u32; 3]),
    /// The fourth strictly above the oriented plane of the first three.
    Space([u32; 4]),
}

impl AffineBasis {
    /// Greedy: each next point is about the farthest from the span of those before. Floating point
    /// proposes the point, exact predicates decide whether there is one.
    fn find(points: &[Vector], exact: &ExactPoints, progress: &mut Progress) -> Result<AffineBasis> {
        let count = points.len() as u32;
        let a = lexicographic_extreme(points, |p, best| p < best);
        let differs = |p: u32| points[p as usize] != points[a as usize];
        let far = |p: u32| (exact.approximate(p) - exact.approximate(a)).norm_squared();
        let Some(b) = largest_such(count, far, differs, &mut progress.part(0.0, 0.2))? else {
            return Ok(AffineBasis::Point(a));
        };
        let along = exact.approximate(b) - exact.approximate(a);
        let aside = |p: u32| (exact.approximate(p) - exact.approximate(a)).cross(&along).norm_squared();
        let off_line = |p: u32| !exact.collinear([a, b, p]);
        let Some(c) = largest_such(count, aside, off_line, &mut progress.part(0.2, 0.5))? else {
            return Ok(AffineBasis::Line);
        };
        let plane = exact.plane([a, b, c]);
        let d = largest(count, |p| exact.height(&plane, p).abs(), &mut progress.part(0.5, 1.0))?;
        Ok(match exact.height(&plane, d) {
            0.0 => AffineBasis::Plane([a, b, c]),
            height if height > 0.0 => AffineBasis::Space([a, b, c, d]),
            _ => AffineBasis::Space([a, c, b, d]),
        })
    }
}

/// The lowest of `count` indices with the largest value.
fn largest(count: u32, value: impl Fn(u32) -> f64, progress: &mut Progress) -> Result<u32> {
    let (mut best, mut best_value) = (0, f64::NEG_INFINITY);
    for p in 0..count {
        let v = value(p);
        if v > best_value {
            (best, best_value) = (p, v);
        }
        progress.step(p as usize, count as usize)?;
    }
    Ok(best)
}

/// The same if it is such a one, else the lowest of such.
fn largest_such(
    count: u32,
    value: impl Fn(u32) -> f64,
    is_such: impl Fn(u32) -> bool,
    progress: &mut Progress,
) -> Result<Option<u32>> {
    let best = largest(count, value, &mut progress.part(0.0, 0.5))?;
    if is_such(best) {
        return Ok(Some(best));
    }
    let progress = &mut progress.part(0.5, 1.0);
    for p in 0..count {
        if is_such(p) {
            return Ok(Some(p));
        }
        progress.step(p as usize, count as usize)?;
    }
    Ok(None)
}

/// The lowest index of the first point in the order by x, then y, then z that `before` tells.
fn lexicographic_extreme(points: &[Vector], before: impl Fn([f64; 3], [f64; 3]) -> bool) -> u32 {
    let mut best = 0;
    for (i, p) in points.iter().enumerate() {
        if before((*p).into(), points[best].into()) {
            best = i;
        }
    }
    best as u32
}

/// The hull of collinear points: on a line, the order by x, then y, then z is the order along the
/// line.
fn segment(points: &[Vector]) -> Hull {
    let mut vertices =
        listed([lexicographic_extreme(points, |p, best| p < best), lexicographic_extreme(points, |p, best| p > best)]);
    vertices.sort_unstable();
    Hull { dimension: 1, vertices, triangles: Vec::new() }
}

/// The hull of coplanar points that span a plane: its strictly convex corners, by the monotone
/// chain (A. M. Andrew, "Another efficient algorithm for convex hulls in two dimensions",
/// Information Processing Letters 9, 1979).
fn polygon(points: &[Vector], exact: &ExactPoints, basis: [u32; 3], progress: &mut Progress) -> Result<Hull> {
    // Dropping a coordinate along which the plane's normal does not vanish is a bijection of the
    // plane that keeps lines, so any such coordinate is as good as another.
    let axis = (0..3).find(|k| exact.projected_orientation(*k, basis) != 0.0).unwrap_or(2);
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let key = |i: &u32| (points[*i as usize][first], points[*i as usize][second]);
    let mut order: Vec<u32> = collected(0..points.len() as u32)?;
    // The coordinates are finite, and 0.0 equals -0.0 here as everywhere.
    let before = |i: &u32, j: &u32| key(i).partial_cmp(&key(j)).expect("coordinates are finite").then(i.cmp(j));
    sort_in_steps(&mut order, before, &mut progress.part(0.0, 0.5))?;
    order.dedup_by(|later, kept| key(later) == key(kept));

    let mut corners: Vec<u32> = Vec::new();
    let mut extend = |sequence: &mut dyn Iterator<Item = u32>, progress: &mut Progress| -> Result<()> {
        let start = corners.len();
        for (done, p) in sequence.enumerate() {
            // As many corners are taken back as were added.
            progress.steps(2, done, order.len())?;
            while let [.., q, r] = corners[start..] {
                if exact.projected_orientation(axis, [q, r, p]) > 0.0 {
                    break;
                }
                corners.pop();
            }
            push(&mut corners, p)?;
        }
        // The last point begins the other chain.
        corners.pop();
        Ok(())
    };
    extend(&mut order.iter().copied(), &mut progress.part(0.5, 0.75))?;
    extend(&mut order.iter().rev().copied(), &mut progress.part(0.75, 1.0))?;

    let fan = corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]);
    let triangles = collected(fan.clone().chain(fan.map(|[a, b, c]| [a, c, b])))?;
    corners.sort_unstable();
    Ok(Hull { dimension: 2, vertices: corners, triangles })
}
