//! How deep two intersecting convex hulls are in each other, in integers: the least translation that leaves their interiors
//! disjoint is the distance of the origin from the surface of the Minkowski difference M = A − B. A polytope of vertices of M is
//! grown at its facet nearest to the origin until that facet lies on the surface of M (the expanding polytope algorithm, G. van
//! den Bergen, Proximity Queries and Penetration Depth Computation on 3D Game Objects, GDC 2001). The facets prove that the
//! depth is not less, the supporting plane that it is not more.

use std::cmp::Ordering;
use std::collections::HashSet;

use dashu_int::ops::BitTest;
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;

use super::integers::{IntegerPair, Point, cross, difference, dot, is_zero, negative};
use super::nearest::affine_minimiser;

/// The depth, or where it lies when the polytope was not grown to the end.
pub struct Depth {
    /// The squares of a lower and an upper bound; equal when the search came to its end. 0: touching.
    pub lower_square: RBig,
    pub upper_square: RBig,
    /// Moving B along this direction, which runs from A to B, by the upper bound separates the interiors.
    pub direction: Point,
    /// A deepest point of A and one of B, apart by the depth along the direction; none unless the search came to its end.
    pub points: Option<[[RBig; 3]; 2]>,
}

/// A vertex of the Minkowski difference.
struct Vertex {
    pair: [usize; 2],
    position: Point,
}

/// A triangle of the inner polytope; normal·x = offset on it, less inside.
struct Facet {
    corners: [usize; 3],
    normal: Point,
    offset: IBig,
    /// Roughly log2 of the plane's distance from the origin; -∞ when that lies outside.
    rank: f64,
}

/// The depth of two hulls that intersect, in units of the placed vertices; `limit` vertices at most are looked for.
pub fn depth(placed: &IntegerPair, limit: usize) -> Depth {
    let Some(mut vertices) = tetrahedron(placed) else {
        // Nothing to move out of: the Minkowski difference has no interior.
        return Depth {
            lower_square: RBig::ZERO,
            upper_square: RBig::ZERO,
            direction: [IBig::ONE, IBig::ZERO, IBig::ZERO],
            points: None,
        };
    };
    let mut facets: Vec<Facet> = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]].map(|c| facet(&vertices, c)).into();
    let mut best: Option<(RBig, Point)> = None;
    for _ in 0..limit {
        let lowest = (0..facets.len()).min_by(|&i, &j| facets[i].rank.total_cmp(&facets[j].rank)).expect("a facet");
        let normal = facets[lowest].normal.clone();
        let vertex = support(placed, &normal);
        let height = dot(&normal, &vertex.position);
        let square = square_over(&height, &normal);
        if best.as_ref().is_none_or(|(least, _)| square < *least) {
            best = Some((square, normal));
        }
        if height == facets[lowest].offset {
            // On the surface. The ranks are rounded: another facet may be nearer by less.
            let nearest = (0..facets.len()).min_by(|&i, &j| closer(&facets[i], &facets[j])).expect("a facet");
            if closer(&facets[nearest], &facets[lowest]) != Ordering::Less {
                return finished(placed, &vertices, &facets, lowest);
            }
            facets[nearest].rank = f64::NEG_INFINITY;
            continue;
        }
        grow(&mut vertices, &mut facets, vertex);
    }
    let lowest = (0..facets.len()).min_by(|&i, &j| closer(&facets[i], &facets[j])).expect("a facet");
    let Facet { offset, normal, .. } = &facets[lowest];
    let lower_square = if *offset > IBig::ZERO { square_over(offset, normal) } else { RBig::ZERO };
    let (upper_square, direction) = best.expect("a limit above 0");
    Depth { lower_square, upper_square, direction, points: None }
}

/// The answer, given a facet on the surface that is as near to the origin as any.
fn finished(placed: &IntegerPair, vertices: &[Vertex], facets: &[Facet], nearest: usize) -> Depth {
    let Facet { offset, normal, .. } = &facets[nearest];
    let square = square_over(offset, normal);
    // The origin's projection lies in one of the triangles of the same plane.
    let same_plane = facets.iter().filter(|f| closer(f, &facets[nearest]) == Ordering::Equal);
    let found = same_plane
        .map(|f| (f, affine_minimiser(&f.corners.map(|c| vertices[c].position.clone()))))
        .find(|(_, weights)| weights.iter().all(|w| *w >= RBig::ZERO));
    let points = found.as_ref().map(|(f, weights)| {
        [0, 1].map(|side| {
            let body = if side == 0 { &placed.a } else { &placed.b };
            let corner = |c: usize| body.vertex(vertices[c].pair[side]);
            [0, 1, 2].map(|k| {
                f.corners
                    .iter()
                    .zip(weights)
                    .fold(RBig::ZERO, |sum, (&c, w)| sum + w * RBig::from(corner(c)[k].clone()))
            })
        })
    });
    let direction = found.map_or(normal, |(f, _)| &f.normal).clone();
    Depth { lower_square: square.clone(), upper_square: square, direction, points }
}

/// Replaces the facets that a vertex lies above by a cone over their common border.
fn grow(vertices: &mut Vec<Vertex>, facets: &mut Vec<Facet>, vertex: Vertex) {
    let mut border: HashSet<[usize; 2]> = HashSet::new();
    facets.retain(|f| {
        let seen = dot(&f.normal, &vertex.position) > f.offset;
        if seen {
            for k in 0..3 {
                let (from, to) = (f.corners[k], f.corners[(k + 1) % 3]);
                // An edge between two facets that go is met once in each direction.
                if !border.remove(&[to, from]) {
                    border.insert([from, to]);
                }
            }
        }
        !seen
    });
    vertices.push(vertex);
    let apex = vertices.len() - 1;
    let mut border: Vec<[usize; 2]> = border.into_iter().collect();
    border.sort_unstable();
    facets.extend(border.into_iter().map(|[from, to]| facet(vertices, [from, to, apex])));
}

fn facet(vertices: &[Vertex], corners: [usize; 3]) -> Facet {
    let [p, q, r] = corners.map(|c| &vertices[c].position);
    let normal = cross(&difference(q, p), &difference(r, p));
    let offset = dot(&normal, p);
    let rank = if offset < IBig::ZERO {
        f64::NEG_INFINITY
    } else if offset.is_zero() {
        f64::MIN
    } else {
        logarithm(&offset) - 0.5 * logarithm(&dot(&normal, &normal))
    };
    Facet { corners, normal, offset, rank }
}

/// log2 of a positive integer, rounded.
fn logarithm(x: &IBig) -> f64 {
    let bits = UBig::try_from(x.clone()).expect("a positive integer").bit_len();
    let surplus = bits.saturating_sub(64);
    (x >> surplus).to_f64().value().log2() + surplus as f64
}

/// height²/|normal|².
fn square_over(height: &IBig, normal: &Point) -> RBig {
    RBig::from_parts(height * height, UBig::try_from(dot(normal, normal)).expect("a square"))
}

/// Which plane is nearer to the origin, those with the origin above them first.
fn closer(f: &Facet, g: &Facet) -> Ordering {
    let signed = |f: &Facet, g: &Facet| {
        let square = &f.offset * &f.offset * dot(&g.normal, &g.normal);
        if f.offset < IBig::ZERO { -square } else { square }
    };
    signed(f, g).cmp(&signed(g, f))
}

/// The vertex of the Minkowski difference farthest along a direction.
fn support(placed: &IntegerPair, direction: &Point) -> Vertex {
    let pair = [placed.a.farthest(direction), placed.b.farthest(&negative(direction))];
    Vertex { pair, position: difference(&placed.a.vertex(pair[0]), &placed.b.vertex(pair[1])) }
}

/// Four vertices of the Minkowski difference that are not in a plane, if there are such, the last below the plane of the others.
fn tetrahedron(placed: &IntegerPair) -> Option<Vec<Vertex>> {
    let axes = [0, 1, 2].map(|k| [0, 1, 2].map(|i| if i == k { IBig::ONE } else { IBig::ZERO }));
    let first = support(placed, &axes[0]);
    // The farthest from the first point along ±directions that span what is still open; `None` when nothing sticks out.
    let off = |directions: &[Point]| {
        let both = directions.iter().flat_map(|d| [d.clone(), negative(d)]);
        both.filter(|d| !is_zero(d))
            .map(|d| (support(placed, &d), d))
            .find(|(vertex, d)| !dot(d, &difference(&vertex.position, &first.position)).is_zero())
            .map(|(vertex, _)| vertex)
    };
    let second = off(&axes)?;
    let along = difference(&second.position, &first.position);
    let third = off(&axes.each_ref().map(|axis| cross(&along, axis)))?;
    let normal = cross(&along, &difference(&third.position, &first.position));
    let fourth = off(std::slice::from_ref(&normal))?;
    let is_below = dot(&normal, &difference(&fourth.position, &first.position)) < IBig::ZERO;
    Some(if is_below { vec![first, second, third, fourth] } else { vec![first, third, second, fourth] })
}
