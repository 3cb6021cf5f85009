//! The fallback: Gilbert-Johnson-Keerthi on hill-climbed supports, the nearest point of a simplex by signed volumes
//! (Gilbert, Johnson & Keerthi 1988; Montanari, Petrinic & Barbieri 2017).
//!
//! It works on the Minkowski difference in world axes, in plain double precision, and proposes: a separated result is accepted
//! by the certificate, an enclosing tetrahedron by the determinant filter, anything else goes to integers.

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::scalar::{Scalar, dot};
use crate::base::simd::Lanes;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::Table;
use crate::body::tables;
use crate::distance::certificate::{self, Interval};
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::voronoi::climb;

/// Up to four vertices of the Minkowski difference, affinely independent up to rounding, with the convex weights of the point of
/// their hull nearest to the origin.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Simplex {
    /// Entries in use: 1 to 4, 0 in the beginning.
    pub count: usize,
    /// The vertex pairs.
    pub pairs: [VertexPair; 4],
    /// x − y of each pair, in world axes.
    pub differences: [Vector; 4],
    /// Convex weights.
    pub weights: [f64; 4],
}

/// The result of the iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GjkResult {
    /// The simplex is nearest as far as rounding lets one see, at a positive distance.
    Nearest(Nearest),
    /// The simplex seems to hold the origin.
    Enclosed(Simplex),
}

/// A nearest simplex, its certificate included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The simplex.
    pub simplex: Simplex,
    /// Nearest points in centred local coordinates.
    pub points: [Vector; 2],
    /// From body 2 to body 1, not normalised.
    pub direction: Vector,
    /// A rigorous interval; `lower` may be negative.
    pub interval: Interval,
}

/// A proved end comes long before; the limit only ends what rounding makes go round.
const ITERATION_LIMIT: u32 = 128;

/// Support vertices, climbed to from the best of the vertices that were met before.
#[derive(Debug, Clone, Copy)]
pub struct GjkSupports {
    met: [VertexPair; 8],
    count: usize,
    /// The entry to be overwritten next.
    oldest: usize,
}

impl GjkSupports {
    /// From the given pairs (1 to 4, indices in range).
    pub fn new(start: &[VertexPair]) -> GjkSupports {
        let count = start.len().min(4);
        let mut met = [start[0]; 8];
        met[..count].copy_from_slice(&start[..count]);
        GjkSupports { met, count, oldest: count % 8 }
    }

    /// The vertices of both bodies whose difference is farthest along a direction.
    #[inline(always)]
    pub fn farthest<L: Lanes>(&mut self, frame: &Frame<L>, direction: &Vector) -> VertexPair {
        let [g1, g2] = towards(frame, &-direction);
        let [body1, body2] = &frame.bodies;
        let [from1, from2] =
            self.nearest_start([body1.polyhedron, body2.polyhedron], [&g1.to_vector(), &g2.to_vector()]);
        let pair = [climb(body1.polyhedron, g1, from1), climb(body2.polyhedron, g2, from2)];
        self.met[self.oldest] = pair;
        self.oldest = (self.oldest + 1) % self.met.len();
        self.count = (self.count + 1).min(self.met.len());
        pair
    }

    /// The start from the bodies' look-up tables, or else the farthest of the vertices met before and, for large bodies, of a
    /// sample.
    fn nearest_start(&self, polyhedra: [&Polyhedron; 2], towards: [&Vector; 2]) -> VertexPair {
        let mut start = [0; 2];
        for i in 0..2 {
            if let Table::Shells(table) = tables::table(polyhedra[i]) {
                let direction = towards[i] * (1.0 / towards[i].amax());
                start[i] = table.farthest([direction.x as f32, direction.y as f32, direction.z as f32]);
                continue;
            }
            let vertices = &polyhedra[i].vertices;
            let mut highest = f64::NEG_INFINITY;
            let mut look = |vertex: u32| {
                let height = towards[i].dot(&vertices[vertex as usize].position);
                if height > highest {
                    (highest, start[i]) = (height, vertex);
                }
            };
            for pair in &self.met[..self.count] {
                look(pair[i]);
            }
            if vertices.len() >= 4 * SAMPLE {
                for k in 0..SAMPLE {
                    look((k * (vertices.len() / SAMPLE)) as u32);
                }
            }
        }
        start
    }
}

/// Vertices of a large body, evenly spread over its numbers, from which a climb may start. Measured at 1,002 vertices: 16 to 24
/// save a quarter of the time of a cold start, 64 cost what they save.
const SAMPLE: usize = 16;

/// Runs from the given vertex pairs (1 to 4, indices in range). Returns the number of iterations too. Unless `tight`, any
/// direction that separates the bodies ends it.
#[inline(always)]
pub fn solve<L: Lanes>(
    frame: &Frame<L>,
    supports: &mut GjkSupports,
    start: &[VertexPair],
    tight: bool,
) -> (GjkResult, u32) {
    let mut simplex = Simplex::default();
    for &pair in start.iter().take(4) {
        simplex.add(pair, difference(frame, pair));
    }
    let mut best: Option<(Simplex, f64)> = None;
    let mut iteration = 0;
    loop {
        iteration += 1;
        let nearest = simplex.reduce();
        let length_squared = nearest.norm_squared();
        if simplex.count == 4 || length_squared == 0.0 {
            return (GjkResult::Enclosed(simplex), iteration);
        }
        let stuck = best.is_some_and(|(_, least)| length_squared >= least) || iteration == ITERATION_LIMIT;
        if stuck && let Some((nearer, _)) = best {
            simplex = nearer;
        }
        best = Some((simplex, length_squared));
        let nearest = simplex.nearest();
        let direction = simplex.direction(&nearest);
        let pair = supports.farthest(frame, &-direction);
        let corner = difference(frame, pair);
        let height = direction.dot(&corner);
        let is_known = simplex.pairs[..simplex.count].contains(&pair);
        // No progress beyond rounding: the simplex is the nearest one.
        let is_nearest = direction.dot(&nearest) - height <= 4.0 * U * direction.norm() * corner.norm();
        let separates = !tight && height > 0.0;
        if stuck || is_known || is_nearest || separates {
            let nearest = certify(frame, simplex, &direction, pair);
            if stuck || is_known || is_nearest || nearest.interval.lower > 0.0 {
                return (GjkResult::Nearest(nearest), iteration);
            }
        }
        simplex.add(pair, corner);
    }
}

/// x − y of a vertex pair, in world axes.
#[inline(always)]
pub fn difference<L: Lanes>(frame: &Frame<L>, [v, w]: VertexPair) -> Vector {
    let [a, b] = [frame.bodies[0].polyhedron, frame.bodies[1].polyhedron];
    frame.difference(&a.vertices[v as usize].position, &b.vertices[w as usize].position).to_vector()
}

/// −R₁ᵀ·direction and R₂ᵀ·direction.
#[inline(always)]
pub fn towards<L: Lanes>(frame: &Frame<L>, direction: &Vector) -> [L; 2] {
    let lanes = L::from_vector(direction);
    [frame.bodies[0].rotate_back(lanes.negate()), frame.bodies[1].rotate_back(lanes)]
}

/// The interval of a simplex from its witness points, and from supports proved at `pair`.
#[inline(always)]
pub fn certify<L: Lanes>(frame: &Frame<L>, simplex: Simplex, direction: &Vector, pair: VertexPair) -> Nearest {
    let points: [Vector; 2] = std::array::from_fn(|i| {
        let polyhedron = frame.bodies[i].polyhedron;
        let position = |k: usize| polyhedron.vertices[simplex.pairs[k][i] as usize].position;
        let first = position(0);
        let add = |sum, k| plus_weighted(sum, first.into(), position(k).into(), simplex.weights[k]);
        (1..simplex.count).fold(first.into(), add).into()
    });
    let interval = supported_interval(frame, points, direction, pair);
    Nearest { simplex, points, direction: *direction, interval }
}

/// A sum and so much of the way from one point to another: see [`COMBINATION`].
#[inline(always)]
pub fn plus_weighted<S: Scalar>(sum: [S; 3], from: [S; 3], to: [S; 3], weight: S) -> [S; 3] {
    let of = |k: usize| sum[k] + (to[k] - from[k]) * weight;
    [of(0), of(1), of(2)]
}

/// How much farther than a point a body reaches along g at a vertex, as computed: see [`EXCESS`].
#[inline(always)]
pub fn height_over<S: Scalar>(g: [S; 3], vertex: [S; 3], point: [S; 3]) -> S {
    dot(g, [vertex[0] - point[0], vertex[1] - point[1], vertex[2] - point[2]])
}

/// g·(v − x) for a support vertex v and a point x of a body, over ρ|g|: g errs by 6.2u, which v − x feels, up to 2ρ; their
/// difference by u and the product by 3u, both of 2ρ: 20.4u.
pub const EXCESS: f64 = 24.0 * U;

/// How far a combination a + w₁(b − a) + w₂(c − a) lies out of the body, over ρ. w₁ + w₂ ≤ 1 + 3u, which takes it out by 3u·2ρ;
/// both differences and products err by 2u·2ρ together, the two sums by uρ each: 12u, and the second-order part is covered by the
/// factors of [`certificate::interval`].
pub const COMBINATION: f64 = 12.0 * U;

/// The interval of two points (convex combinations of vertices) and a direction, with supports proved at the given vertices.
#[inline(always)]
fn supported_interval<L: Lanes>(
    frame: &Frame<L>,
    points: [Vector; 2],
    direction: &Vector,
    pair: VertexPair,
) -> Interval {
    let towards = towards(frame, direction);
    let towards = [towards[0].to_vector(), towards[1].to_vector()];
    let mut support_excess = 0.0;
    let mut point_error = 0.0;
    for i in 0..2 {
        let polyhedron = frame.bodies[i].polyhedron;
        let g = &towards[i];
        let support = polyhedron.vertices[pair[i] as usize].position;
        support_excess += height_over((*g).into(), support.into(), points[i].into()).max(0.0)
            + certificate::of_vertex(polyhedron, pair[i], g)
            + EXCESS * polyhedron.radius * g.abs().sum();
        point_error += COMBINATION * polyhedron.radius;
    }
    let difference = frame.difference(&points[0], &points[1]);
    let direction = L::from_vector(direction);
    let inverse = certificate::reciprocal_length(direction.dot(direction));
    let distance = difference.dot(difference).sqrt();
    let projection = direction.dot(difference) * inverse;
    certificate::interval(distance, projection, frame.difference_error(distance), support_excess * inverse, point_error)
}

impl Simplex {
    /// Adds a vertex pair and its difference, if it is not there yet; returns whether it did. There are at most three before.
    pub fn add(&mut self, pair: VertexPair, difference: Vector) -> bool {
        let is_new = !self.pairs[..self.count].contains(&pair);
        if is_new {
            self.pairs[self.count] = pair;
            self.differences[self.count] = difference;
            self.count += 1;
        }
        is_new
    }

    /// Σ weightₖ·differenceₖ.
    fn nearest(&self) -> Vector {
        (0..self.count).map(|k| self.differences[k] * self.weights[k]).sum()
    }

    /// Drops the vertices that the nearest point does not need, sets the weights and returns the nearest point. All four stay
    /// when they seem to enclose the origin.
    pub fn reduce(&mut self) -> Vector {
        let p = &self.differences;
        let mut weights = [0.0; 4];
        match self.count {
            1 => weights[0] = 1.0,
            2 => nearest_on_segment(p, [0, 1], &mut weights),
            3 => nearest_on_triangle(p, [0, 1, 2], &mut weights),
            _ => nearest_on_tetrahedron(p, &mut weights),
        }
        let mut kept = 0;
        for (k, weight) in weights.into_iter().enumerate().take(self.count) {
            if weight > 0.0 {
                self.pairs[kept] = self.pairs[k];
                self.differences[kept] = self.differences[k];
                self.weights[kept] = weight;
                kept += 1;
            }
        }
        self.count = kept;
        self.nearest()
    }

    /// The direction from the origin to the nearest point as the simplex defines it: near contact the difference of two points
    /// has no digits left, an edge or a triangle still has its perpendicular.
    fn direction(&self, nearest: &Vector) -> Vector {
        let p = &self.differences;
        match self.count {
            2 => {
                let along = p[1] - p[0];
                let scale = along.norm_squared();
                let mut d = *nearest;
                d -= along * (d.dot(&along) / scale);
                d -= along * (d.dot(&along) / scale);
                if d.norm_squared() > 0.0 { d } else { *nearest }
            }
            3 => {
                let normal = triangle_normal(p, [0, 1, 2]);
                if normal.norm_squared() == 0.0 {
                    *nearest
                } else if normal.dot(&p[0]) < 0.0 {
                    -normal
                } else {
                    normal
                }
            }
            _ => *nearest,
        }
    }
}

/// The cross product of the two shorter edges, which has the smaller rounding error.
fn triangle_normal(p: &[Vector; 4], [a, b, c]: [usize; 3]) -> Vector {
    let (ab, bc, ca) = (p[b] - p[a], p[c] - p[b], p[a] - p[c]);
    let (l, m, n) = (ab.norm_squared(), bc.norm_squared(), ca.norm_squared());
    if l >= m && l >= n {
        bc.cross(&ca)
    } else if m >= n {
        ca.cross(&ab)
    } else {
        ab.cross(&bc)
    }
}

/// Weights of the point of a segment nearest to the origin.
fn nearest_on_segment(p: &[Vector; 4], [a, b]: [usize; 2], weights: &mut [f64; 4]) {
    let along = p[b] - p[a];
    let scale = along.norm_squared();
    // From the nearer end, for the smaller cancellation.
    let t = if p[a].norm_squared() <= p[b].norm_squared() {
        -p[a].dot(&along) / scale
    } else {
        1.0 - p[b].dot(&along) / scale
    };
    // A NaN (equal points) becomes 0.
    let t = if t > 0.0 { t.min(1.0) } else { 0.0 };
    weights[a] = 1.0 - t;
    weights[b] = t;
}

/// Weights of the point of a triangle nearest to the origin (signed areas).
fn nearest_on_triangle(p: &[Vector; 4], corners: [usize; 3], weights: &mut [f64; 4]) {
    let [a, b, c] = corners;
    let normal = triangle_normal(p, corners);
    let scale = normal.norm_squared();
    let foot = normal * (p[a].dot(&normal) / scale);
    // Areas in the coordinate plane where the triangle is largest.
    let drop = normal.iamax();
    let (i, j) = ((drop + 1) % 3, (drop + 2) % 3);
    let area = |u: &Vector, v: &Vector, w: &Vector| (v[i] - u[i]) * (w[j] - u[j]) - (v[j] - u[j]) * (w[i] - u[i]);
    let whole = area(&p[a], &p[b], &p[c]);
    let parts = [area(&foot, &p[b], &p[c]), area(&p[a], &foot, &p[c]), area(&p[a], &p[b], &foot)];
    let signed = parts.map(|part| part * whole.signum());
    let sum: f64 = signed.iter().sum();
    if signed.iter().all(|&part| part > 0.0) && sum > 0.0 {
        for k in 0..3 {
            weights[corners[k]] = signed[k] / sum;
        }
        return;
    }
    let opposite = [[b, c], [c, a], [a, b]];
    let mut least = f64::INFINITY;
    for k in 0..3 {
        // A degenerate triangle gives NaN: then every side is tried.
        let is_inside = signed[k] > 0.0;
        if !is_inside {
            let mut candidate = [0.0; 4];
            nearest_on_segment(p, opposite[k], &mut candidate);
            keep_nearer(p, candidate, &mut least, weights);
        }
    }
}

/// Weights of the point of a tetrahedron nearest to the origin (signed volumes): all four positive when it is inside.
fn nearest_on_tetrahedron(p: &[Vector; 4], weights: &mut [f64; 4]) {
    let volume = |u: &Vector, v: &Vector, w: &Vector| u.dot(&v.cross(w));
    let parts = [
        volume(&p[1], &p[3], &p[2]),
        volume(&p[0], &p[2], &p[3]),
        volume(&p[0], &p[3], &p[1]),
        volume(&p[0], &p[1], &p[2]),
    ];
    let whole: f64 = parts.iter().sum();
    let signed = parts.map(|part| part * whole.signum());
    if whole != 0.0 && signed.iter().all(|&part| part > 0.0) {
        let sum: f64 = signed.iter().sum();
        *weights = signed.map(|part| part / sum);
        return;
    }
    let opposite = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];
    let mut least = f64::INFINITY;
    for k in 0..4 {
        let is_inside = signed[k] > 0.0;
        if !is_inside || whole == 0.0 {
            let mut candidate = [0.0; 4];
            nearest_on_triangle(p, opposite[k], &mut candidate);
            keep_nearer(p, candidate, &mut least, weights);
        }
    }
}

fn keep_nearer(p: &[Vector; 4], candidate: [f64; 4], least: &mut f64, weights: &mut [f64; 4]) {
    let point: Vector = (0..4).map(|k| p[k] * candidate[k]).sum();
    if point.norm_squared() < *least {
        *least = point.norm_squared();
        *weights = candidate;
    }
}
