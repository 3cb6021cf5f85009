//! Tetrahedra of vertex differences that provably hold the origin: the proof that two bodies intersect.
//!
//! The filter accepts only what no rounding can undo. A simplex from Gilbert-Johnson-Keerthi often holds the origin on a face
//! or an edge, the rule for symmetric or aligned bodies; it is then grown to a tetrahedron and its corners are exchanged for
//! support vertices beyond the faces that are too near, until the filter accepts or a bound ends it.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::Lanes;
use crate::distance::gjk::{self, GjkSupports};
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// Four vertex pairs whose differences provably hold the origin inside their tetrahedron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// The vertex pairs.
    pub pairs: [VertexPair; 4],
    /// Convex weights of the differences that give the origin, up to rounding.
    pub weights: [f64; 4],
}

/// The faces opposite the four corners, each ordered so that the determinants of a tetrahedron around the origin have one sign.
pub const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// In general position to anything a model or a scene is likely to be aligned with.
pub const GENERIC: Vector = Vector::new(0.48, 0.31, 0.82);

/// Exchanges of a corner before the search is given up: some Minkowski differences have no such tetrahedron, and some bodies hardly
/// overlap.
const EXCHANGE_LIMIT: u32 = 12;

/// Whether the differences of four vertex pairs provably hold the origin in their tetrahedron; then the convex weights.
#[inline(always)]
pub fn encloses_origin<L: Lanes>(frame: &Frame<L>, pairs: &[VertexPair]) -> Option<[f64; 4]> {
    let &[p0, p1, p2, p3] = pairs else { return None };
    let corners = [corner(frame, p0), corner(frame, p1), corner(frame, p2), corner(frame, p3)];
    let sides = sides_of_faces(frame, &corners);
    (sides.certain == 4).then_some(sides.weights)
}

/// A tetrahedron of vertex differences around the origin, from a simplex of one to four pairs that holds the origin up to
/// rounding. `None` if none was found: then nothing is proved.
#[inline(always)]
pub fn enclose<L: Lanes>(frame: &Frame<L>, supports: &mut GjkSupports, simplex: &[VertexPair]) -> Option<Enclosure> {
    let (mut pairs, mut corners) = complete(frame, supports, simplex)?;
    let mut sides = sides_of_faces(frame, &in_lanes(&corners));
    let mut exchanges = 0;
    while sides.certain < 4 {
        let direction = beyond_uncertain_faces(&corners, &sides);
        let pair = supports.farthest(frame, &direction);
        let corner = gjk::difference(frame, pair);
        let error = frame.difference_error(corner.norm());
        // False for a NaN. If the body does not reach beyond the origin by more than rounding, nothing can be proved.
        let reaches_beyond = direction.dot(&corner) > 4.0 * error * direction.norm();
        if !reaches_beyond || exchanges == EXCHANGE_LIMIT {
            return None;
        }
        let mut best = (sides, None);
        best_exchange(frame, &corners, pair, &mut best);
        if best.1.is_none() {
            // No four vertices of an octahedron surround its centre; but the differences of other vertex pairs lie in the
            // Minkowski difference, too.
            for first in [pairs[0][0], pairs[1][0], pairs[2][0], pairs[3][0], pair[0]] {
                for second in [pairs[0][1], pairs[1][1], pairs[2][1], pairs[3][1], pair[1]] {
                    best_exchange(frame, &corners, [first, second], &mut best);
                }
            }
        }
        let (better, Some((k, pair))) = best else { return None };
        sides = better;
        pairs[k] = pair;
        corners[k] = gjk::difference(frame, pair);
        exchanges += 1;
    }
    Some(Enclosure { pairs, weights: sides.weights })
}

/// The difference of a vertex pair.
#[inline(always)]
fn corner<L: Lanes>(frame: &Frame<L>, [v, w]: VertexPair) -> L {
    let [a, b] = frame.polyhedra();
    frame.difference(&a.vertices[v as usize].position, &b.vertices[w as usize].position)
}

#[inline(always)]
fn in_lanes<L: Lanes>([a, b, c, d]: &[Vector; 4]) -> [L; 4] {
    [L::from_vector(a), L::from_vector(b), L::from_vector(c), L::from_vector(d)]
}

/// Puts a pair in the place of each corner; keeps in `best` the best sides and the exchange that made them.
#[inline(always)]
fn best_exchange<L: Lanes>(
    frame: &Frame<L>,
    corners: &[Vector; 4],
    pair: VertexPair,
    best: &mut (Sides, Option<(usize, VertexPair)>),
) {
    let corner = L::from_vector(&gjk::difference(frame, pair));
    let corners = in_lanes(corners);
    for k in 0..4 {
        let mut exchanged = corners;
        exchanged[k] = corner;
        let sides = sides_of_faces(frame, &exchanged);
        if sides.is_better_than(&best.0) {
            *best = (sides, Some((k, pair)));
        }
    }
}

/// On which side of its faces a tetrahedron has the origin.
#[derive(Debug, Clone, Copy)]
pub struct Sides {
    /// Convex weights if all four faces have it inside, else signed ones; −∞ without volume.
    pub weights: [f64; 4],
    /// Whether the origin is certainly on the inner side of the face opposite each corner.
    inside: [bool; 4],
    /// How many faces have it certainly inside.
    pub certain: u32,
}

impl Sides {
    fn is_better_than(&self, other: &Sides) -> bool {
        let least = |sides: &Sides| sides.weights.iter().copied().fold(f64::INFINITY, f64::min);
        self.certain > other.certain || (self.certain == other.certain && least(self) > least(other))
    }
}

/// The four determinants that put the origin on the inner side of the faces must have the right signs in spite of all
/// rounding. A determinant of three columns of length at most W, each off by at most e, is off by at most
/// 3W²e(1 + e/W)² from its exact value, and its evaluation by 8u times its permanent (Shewchuk 1997, §4.3). That is at most √2·W³:
/// two columns b and c have (|bᵢcⱼ| + |bⱼcᵢ|)² ≤ 2(bᵢ²cⱼ² + bⱼ²cᵢ²), whose sum over the three pairs of rows is at most 2|b|²|c|².
#[inline(always)]
pub fn sides_of_faces<L: Lanes>(frame: &Frame<L>, corners: &[L; 4]) -> Sides {
    let [x, y, z] = L::components(corners);
    let mut longest_square = 0.0;
    for square in z.mul_add(z, y.mul_add(y, x.mul(x))).to_array() {
        longest_square = if square > longest_square { square } else { longest_square };
    }
    let longest = length_above(longest_square);
    let error = frame.difference_error(longest);
    // A bound of their length that is never 0.
    let longest = if longest > error { longest } else { error };
    let bound = determinant_error(longest, error);
    // Written out: code that the compiler leaves out of line, a closure say, is not compiled for these lanes.
    let &[p, q, r, s] = corners;
    let [ax, ay, az] = L::components(&[q, p, p, p]);
    let [bx, by, bz] = L::components(&[s, r, s, q]);
    let [cx, cy, cz] = L::components(&[r, s, q, r]);
    let normal_x = by.mul(cz).sub(bz.mul(cy));
    let normal_y = bz.mul(cx).sub(bx.mul(cz));
    let normal_z = bx.mul(cy).sub(by.mul(cx));
    let values = az.mul_add(normal_z, ay.mul_add(normal_y, ax.mul(normal_x)));
    let [first, second, third, fourth] = values.to_array();
    let volume = first + second + third + fourth;
    // With the sign of the volume; false for a NaN.
    let inside = values.mul(L::splat(volume.signum())).greater(L::splat(bound));
    // Asked for as the weights below are, the compiler would still divide by 0, and throw 0/0 away.
    let divisor = if volume.abs() > f64::MIN_POSITIVE { volume } else { f64::MIN_POSITIVE };
    let shares = values.div(L::splat(divisor)).to_array();
    let weights = if volume == 0.0 { [f64::NEG_INFINITY; 4] } else { shares };
    let inside = [inside & 1 != 0, inside & 2 != 0, inside & 4 != 0, inside & 8 != 0];
    let certain = u32::from(inside[0]) + u32::from(inside[1]) + u32::from(inside[2]) + u32::from(inside[3]);
    Sides { weights, inside, certain }
}

/// A length, rounded up, from its square, which errs by 3u.
#[inline(always)]
pub fn length_above<S: Scalar>(square: S) -> S {
    square.sqrt() * constant(1.0 + 8.0 * U)
}

/// The error of a determinant, for columns of length at most `longest`, each off by at most `error`, see [`sides_of_faces`].
#[inline(always)]
pub fn determinant_error<S: Scalar>(longest: S, error: S) -> S {
    let spread = constant::<S>(1.0) + error / longest;
    let of_columns = constant::<S>(3.0) * error * spread * spread;
    (constant::<S>(12.0 * U) * longest + of_columns) * longest * longest * constant(1.0 + 16.0 * U)
}

/// Sum of the unit outward normals of the faces that do not certainly have the origin inside.
fn beyond_uncertain_faces(corners: &[Vector; 4], sides: &Sides) -> Vector {
    let mut sum = Vector::zeros();
    for (k, [a, b, c]) in FACES.into_iter().enumerate() {
        if !sides.inside[k] {
            let normal = (corners[b] - corners[a]).cross(&(corners[c] - corners[a]));
            let outward = if normal.dot(&(corners[k] - corners[a])) > 0.0 { -normal } else { normal };
            let length = outward.norm();
            if length > 0.0 {
                sum += outward / length;
            }
        }
    }
    sum
}

/// Four affinely independent pairs: those of the simplex and the farthest vertices across its hull.
#[inline(always)]
fn complete<L: Lanes>(
    frame: &Frame<L>,
    supports: &mut GjkSupports,
    simplex: &[VertexPair],
) -> Option<([VertexPair; 4], [Vector; 4])> {
    let mut count = simplex.len().min(4);
    let mut pairs = [[0; 2]; 4];
    pairs[..count].copy_from_slice(&simplex[..count]);
    let mut corners = [Vector::zeros(); 4];
    for k in 0..count {
        corners[k] = gjk::difference(frame, pairs[k]);
    }
    while count < 4 {
        let direction = match count {
            1 => GENERIC,
            2 => (corners[1] - corners[0]).cross(&GENERIC),
            _ => (corners[1] - corners[0]).cross(&(corners[2] - corners[0])),
        };
        let [up, down] = [supports.farthest(frame, &direction), supports.farthest(frame, &-direction)];
        let [high, low] = [gjk::difference(frame, up), gjk::difference(frame, down)];
        let [rise, fall] = [direction.dot(&(high - corners[0])), direction.dot(&(corners[0] - low))];
        (pairs[count], corners[count]) = if rise >= fall { (up, high) } else { (down, low) };
        if pairs[..count].contains(&pairs[count]) {
            return None;
        }
        count += 1;
    }
    Some((pairs, corners))
}
