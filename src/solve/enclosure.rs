//! Tetrahedra of vertex differences that provably hold the origin: the proof that two bodies intersect.
//!
//! The filter accepts only what no rounding can undo. A simplex from Gilbert-Johnson-Keerthi often holds the origin on a face
//! or an edge, the rule for symmetric or aligned bodies; it is then grown to a tetrahedron and its corners are exchanged for
//! support vertices beyond the faces that are too near, until the filter accepts or a bound ends it.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::Lanes;
use crate::solve::exact::VertexPair;
use crate::solve::frame::Frame;
use crate::solve::gjk::{self, Supports};

/// Four vertex pairs whose differences provably hold the origin inside their tetrahedron.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// The vertex pairs.
    pub pairs: [VertexPair; 4],
    /// Convex weights of the differences that give the origin, up to rounding.
    pub weights: [f64; 4],
}

/// The faces opposite the four corners, each ordered so that the determinants of a tetrahedron around the origin have one sign.
const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Exchanges of a corner before the search is given up: some difference bodies have no such tetrahedron, and some bodies hardly
/// overlap.
const EXCHANGE_LIMIT: u32 = 12;

/// Whether the differences of four vertex pairs provably hold the origin in their tetrahedron; then the convex weights.
#[inline(always)]
pub fn encloses_origin<L: Lanes>(frame: &Frame<L>, pairs: &[VertexPair]) -> Option<[f64; 4]> {
    let &[p0, p1, p2, p3] = pairs else { return None };
    let corners = [
        gjk::difference(frame, p0),
        gjk::difference(frame, p1),
        gjk::difference(frame, p2),
        gjk::difference(frame, p3),
    ];
    let sides = sides_of_faces(frame, &corners);
    (sides.certain == 4).then_some(sides.weights)
}

/// A tetrahedron of vertex differences around the origin, from a simplex of one to four pairs that holds the origin up to
/// rounding. `None` if none was found: then nothing is proved.
#[inline(always)]
pub fn enclose<L: Lanes>(frame: &Frame<L>, supports: &mut Supports, simplex: &[VertexPair]) -> Option<Enclosure> {
    let (mut pairs, mut corners) = complete(frame, supports, simplex)?;
    let mut sides = sides_of_faces(frame, &corners);
    let mut exchanges = 0;
    while sides.certain < 4 {
        let direction = beyond_uncertain_faces(&corners, &sides);
        let pair = supports.farthest(frame, &direction);
        let corner = gjk::difference(frame, pair);
        let error = frame.difference_error(corner.norm());
        // False for a NaN. Where the body does not reach beyond the origin by more than rounding, nothing can be proved.
        let reaches_beyond = direction.dot(&corner) > 4.0 * error * direction.norm();
        if !reaches_beyond || exchanges == EXCHANGE_LIMIT {
            return None;
        }
        let mut best = (sides, None);
        best_exchange(frame, &corners, pair, &mut best);
        if best.1.is_none() {
            // No four vertices of an octahedron surround its centre; but the differences of other vertex pairs lie in the
            // difference body, too.
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

/// Puts a pair in the place of each corner; keeps in `best` the best sides and the exchange that made them.
#[inline(always)]
fn best_exchange<L: Lanes>(
    frame: &Frame<L>,
    corners: &[Vector; 4],
    pair: VertexPair,
    best: &mut (Sides, Option<(usize, VertexPair)>),
) {
    let corner = gjk::difference(frame, pair);
    for k in 0..4 {
        let mut exchanged = *corners;
        exchanged[k] = corner;
        let sides = sides_of_faces(frame, &exchanged);
        if sides.is_better_than(&best.0) {
            *best = (sides, Some((k, pair)));
        }
    }
}

/// On which side of its faces a tetrahedron has the origin.
#[derive(Debug, Clone, Copy)]
struct Sides {
    /// Convex weights if all four faces have it inside, else signed ones; −∞ without volume.
    weights: [f64; 4],
    /// Whether the origin is certainly on the inner side of the face opposite each corner.
    inside: [bool; 4],
    /// How many faces have it certainly inside.
    certain: u32,
}

impl Sides {
    fn is_better_than(&self, other: &Sides) -> bool {
        let least = |sides: &Sides| sides.weights.iter().copied().fold(f64::INFINITY, f64::min);
        self.certain > other.certain || (self.certain == other.certain && least(self) > least(other))
    }
}

/// The four determinants that put the origin on the inner side of the faces must have the right signs in spite of all
/// rounding. A determinant of three columns of length at most W, each off by at most e, is off by at most
/// 3W²e(1 + e/W)² from its exact value, and its evaluation by 8u times its permanent (Shewchuk 1997, §4.3).
#[inline(always)]
fn sides_of_faces<L: Lanes>(frame: &Frame<L>, corners: &[Vector; 4]) -> Sides {
    let mut longest_squared = 0.0_f64;
    for corner in corners {
        longest_squared = longest_squared.max(corner.norm_squared());
    }
    let longest = longest_squared.sqrt() * (1.0 + 8.0 * U);
    sides_within(corners, longest, frame.difference_error(longest))
}

/// [`sides_of_faces`] of corners no longer than `longest`, each off by at most `error`.
fn sides_within(corners: &[Vector; 4], longest: f64, error: f64) -> Sides {
    let spread = 1.0 + error / longest;
    let columns_error = 3.0 * longest * longest * error * spread * spread * (1.0 + 16.0 * U);
    let (mut values, mut bounds) = ([0.0; 4], [0.0; 4]);
    for (k, [a, b, c]) in FACES.into_iter().enumerate() {
        let (value, permanent) = determinant(&corners[a], &corners[b], &corners[c]);
        values[k] = value;
        bounds[k] = 8.0 * U * permanent + columns_error;
    }
    let volume: f64 = values.iter().sum();
    let mut sides = Sides { weights: [0.0; 4], inside: [false; 4], certain: 0 };
    for k in 0..4 {
        // With the sign of the volume; false for a NaN.
        sides.inside[k] = values[k] * volume.signum() > bounds[k];
        sides.certain += u32::from(sides.inside[k]);
        sides.weights[k] = if volume == 0.0 { f64::NEG_INFINITY } else { values[k] / volume };
    }
    sides
}

/// det(a, b, c) and the sum of the absolute values of its six products.
fn determinant(a: &Vector, b: &Vector, c: &Vector) -> (f64, f64) {
    let (x, y, z) = ((b.y * c.z, b.z * c.y), (b.z * c.x, b.x * c.z), (b.x * c.y, b.y * c.x));
    let value = a.x * (x.0 - x.1) + a.y * (y.0 - y.1) + a.z * (z.0 - z.1);
    let permanent =
        a.x.abs() * (x.0.abs() + x.1.abs()) + a.y.abs() * (y.0.abs() + y.1.abs()) + a.z.abs() * (z.0.abs() + z.1.abs());
    (value, permanent)
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
    supports: &mut Supports,
    simplex: &[VertexPair],
) -> Option<([VertexPair; 4], [Vector; 4])> {
    let mut count = simplex.len().min(4);
    let mut pairs = [[0; 2]; 4];
    pairs[..count].copy_from_slice(&simplex[..count]);
    let mut corners = [Vector::zeros(); 4];
    for k in 0..count {
        corners[k] = gjk::difference(frame, pairs[k]);
    }
    // In general position to anything a model or a scene is likely to be aligned with.
    let generic = Vector::new(0.48, 0.31, 0.82);
    while count < 4 {
        let direction = match count {
            1 => generic,
            2 => (corners[1] - corners[0]).cross(&generic),
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
