//! From nearest points and a direction to a rigorous interval of the distance, rounding included.
//!
//! With x, y points of the two bodies, U any world direction from body 2 to body 1, g₁ = −R₁ᵀU, g₂ = R₂ᵀU and
//! δᵢ ≥ max over the body of gᵢ·z minus gᵢ·(own point), both ≥ 0,
//!
//! ```text
//! (U·(x − y) − δ₁ − δ₂)/|U|  ≤  distance  ≤  |x − y|
//! ```
//!
//! for any matrices R, since the support function of R·K + T in direction U is that of K in direction RᵀU plus U·T. A poor U
//! costs width, never truth. δ is bounded in O(1): 0 at a vertex all of whose neighbours lie strictly behind (on an exact convex
//! hull a local maximum is a global one), else from the planes around the feature, each with its own slack from build time.

mod skewed;

use crate::base::math::{UNIT_ROUNDOFF as U, Vector, clamp};
use crate::base::scalar::{Scalar, constant};
use crate::base::simd::{Lanes, Portable};
use crate::body::polyhedron::{Bevel, Edge, MergedFace, NONE, Polyhedron};
use crate::placed::frame::{Frame, RIGID_DEFECT};
use crate::placed::state::{FeatureId, State};
use crate::placed::voronoi::{Rule, STRICT, edge_direction, plane_values};

/// A rigorous interval of the distance. `lower` may be negative or NaN: then nothing is proved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// distance ≥ lower.
    pub lower: f64,
    /// distance ≤ upper.
    pub upper: f64,
}

impl Interval {
    /// Whether it proves separation and is as tight as answers must be: 2e-14·max(ρ₁ + ρ₂, distance).
    #[inline(always)]
    pub fn is_tight(&self, size: f64) -> bool {
        let width = self.upper - self.lower;
        // Not 2e-14 times the larger: its instruction raises a flag for a NaN, which the compiler would ask for first.
        self.lower > 0.0 && (width <= 2e-14 * size || width <= 2e-14 * self.lower)
    }

    /// Whether it is wholly on one side of a distance tolerance: then no other start would change the answer.
    #[inline(always)]
    pub fn settles(&self, max_distance: f64) -> bool {
        (self.lower > max_distance) | (self.upper <= max_distance)
    }
}

/// Features whose optimality conditions hold up to the frame's tolerance, and the nearest points.
#[derive(Clone, Copy)]
pub struct Minimum<L> {
    /// Nearest points, one of each feature, in the centred local coordinates of their bodies.
    pub points: [L; 2],
    /// The points mapped by their bodies' rotations.
    pub rotated: [L; 2],
    /// x − y for the points x of body 1 and y of body 2 in the world.
    pub difference: L,
    /// The rounding error of `difference` beyond [`Frame::difference_error`].
    pub error: f64,
    /// A world direction from body 2 to body 1, of any length: the difference of the nearest points, or where the features
    /// define it a normal, which keeps its digits at the smallest distance.
    pub direction: L,
    /// The direction's reciprocal length, see [`reciprocal_length`].
    pub inverse: f64,
    /// |difference|.
    pub distance: f64,
    /// The difference projected on the unit direction.
    pub projection: f64,
    /// An upper bound of how far the bodies reach beyond the points, both together, along the unit direction; +∞ where only a
    /// closer look decides.
    pub support_excess: f64,
    /// How far the points may lie out of their bodies, both together; holds where `support_excess` is finite.
    pub point_error: f64,
    /// Value of the face plane at the vertex in a vertex-face state, else 0.
    pub height: f64,
}

impl<L: Lanes> Minimum<L> {
    /// The gap that follows from it, as far as a quick look tells.
    #[inline(always)]
    pub fn gap(&self, frame: &Frame<L>) -> Gap {
        self.gap_with(frame, self.support_excess, self.point_error)
    }

    /// The gap that follows from it by a closer look, for the cases that the quick one leaves open: ties, directions on the
    /// boundary of a cone, skewed rotations.
    #[inline(always)]
    fn gap_closely(&self, frame: &Frame<L>, state: State) -> Gap {
        let towards = [
            frame.bodies[0].rotate_back(self.direction).negate().to_vector(),
            frame.bodies[1].rotate_back(self.direction).to_vector(),
        ];
        let points = [self.points[0].to_vector(), self.points[1].to_vector()];
        let defect = closely(frame.polyhedra(), state, points, towards, self.height);
        self.gap_with(frame, defect.support_excess * self.inverse, defect.point_error)
    }

    #[inline(always)]
    fn gap_with(&self, frame: &Frame<L>, support_excess: f64, point_error: f64) -> Gap {
        let error = frame.difference_error(self.distance) + self.error;
        Gap {
            distance: self.distance,
            interval: interval(self.distance, self.projection, error, support_excess, point_error),
        }
    }

    /// The same minimum with a direction in the planes of the normals at its edges, if it has edges. The direction across an
    /// edge is not quite in the plane of the normals of its faces where these were merged: an edge much shorter than its faces
    /// leans out of their planes by up to 16uρ over its length, and a direction perpendicular to it misses the cone by as much.
    #[inline(always)]
    fn between_planes(&self, frame: &Frame<L>, state: State) -> Option<Minimum<L>> {
        let [body1, body2] = &frame.bodies;
        let towards = [body1.rotate_back(self.direction).negate(), body2.rotate_back(self.direction)];
        let axis = |i: usize, edge: u32| {
            let polyhedron = frame.bodies[i].polyhedron;
            axis_of_cone(polyhedron, &polyhedron.edges[edge as usize], &towards[i].to_vector())
        };
        // The part of a direction towards the other body that is in the plane across an axis, back in the world.
        let across = |i: usize, axis: Vector| {
            let axis = L::from_vector(&axis);
            let part = axis.negated_mul_add(L::splat(axis.dot(towards[i])), towards[i]);
            frame.bodies[i].lift(part)
        };
        let direction = match state.features() {
            [FeatureId::Edge(first), FeatureId::Edge(second)] => {
                let [axis1, axis2] = [axis(0, first)?, axis(1, second)?];
                let normal = body1.rotate(&axis1).cross(body2.rotate(&axis2));
                if normal.dot(self.direction) < 0.0 { normal.negate() } else { normal }
            }
            [FeatureId::Edge(first), _] => across(0, axis(0, first)?).negate(),
            [_, FeatureId::Edge(second)] => across(1, axis(1, second)?),
            _ => return None,
        };
        let inverse = reciprocal_length(direction.dot(direction));
        let projection = direction.dot(self.difference) * inverse;
        Some(Minimum { direction, inverse, projection, ..*self })
    }
}

/// Processes a minimum that marching finds. It is called where the kinds of the features are known to the compiler.
pub trait Certify<L: Lanes> {
    /// Across which plane marching goes on where several are violated.
    const RULE: Rule = Rule::Most;
    /// Whether to ask the memory for what marching may need next, where a state has much of it.
    const LOOKS_AHEAD: bool = true;

    /// Looks whether a minimum is good enough, and puts it where it belongs.
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>);
}

/// A closer look at every minimum; the last one is kept. Along the direction that marching found, or `BETWEEN_PLANES` along
/// another, see [`Minimum::between_planes`].
pub struct CloserLook<L, const BETWEEN_PLANES: bool> {
    /// The minimum and what follows from it.
    pub found: Option<(Minimum<L>, Gap)>,
}

impl<L: Lanes, const BETWEEN_PLANES: bool> Certify<L> for CloserLook<L, BETWEEN_PLANES> {
    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, state: State, minimum: &Minimum<L>) {
        let minimum = if frame.rigid { *minimum } else { minimum.unskewed(frame, state) };
        let minimum = if BETWEEN_PLANES { minimum.between_planes(frame, state) } else { Some(minimum) };
        self.found = minimum.map(|minimum| (minimum, minimum.gap_closely(frame, state)));
    }
}

/// Defects of both points of a minimum. `towards` are the directions towards the other body, in each body's frame.
#[inline(never)]
fn closely(
    polyhedra: [&Polyhedron; 2],
    state: State,
    points: [Vector; 2],
    towards: [Vector; 2],
    height: f64,
) -> Defect {
    let features = state.features();
    let mut sum = Defect { support_excess: 0.0, point_error: 0.0 };
    for i in 0..2 {
        let (polyhedron, g) = (polyhedra[i], &towards[i]);
        let defect = match features[i] {
            FeatureId::Vertex(v) => Defect { support_excess: of_vertex(polyhedron, v, g), point_error: 0.0 },
            FeatureId::Edge(e) => Defect {
                support_excess: of_edge(polyhedron, &polyhedron.edges[e as usize], Portable::from_vector(g)),
                point_error: edge_rounding(polyhedron),
            },
            FeatureId::Face(f) => of_face(polyhedron, f, g, &points[i], height),
        };
        sum.support_excess += defect.support_excess;
        sum.point_error += defect.point_error;
    }
    sum
}

/// tail + t·ê leaves the segment, and the planes of the faces beside it, by the rounding of ê and of the sum.
#[inline(always)]
pub fn edge_rounding(polyhedron: &Polyhedron) -> f64 {
    8.0 * U * polyhedron.radius
}

/// A quick δ/|U| of an edge's point, for g = RᵀU in the cone of its two normals up to `misfit`·|U|, an upper bound of all
/// rounding: g = c₁n₁ + c₂n₂ + r with |r| ≤ misfit·|U| and c₁ + c₂ ≤ √2|g|, as the normals are at most a right angle apart; the
/// cone of a sharp edge is halved by its bevel, whose normal then stands for one of them. |g| ≤ 1.02|U| for any R, less than
/// 1.06·√2 = 1.5. The slack of an edge that leans out of its faces' planes includes how far the edge misses the cone of their
/// normals.
#[inline(always)]
pub fn of_edge_in_cone(polyhedron: &Polyhedron, edge: &Edge, misfit: f64) -> f64 {
    1.5 * (edge.slack + edge_rounding(polyhedron)) + 2.0 * polyhedron.radius * misfit
}

/// A quick δ/|U| of a point in a face, projected from `height` over it, for g = RᵀU equal to the face's unit normal up to `misfit`.
#[inline(always)]
pub fn of_facing_face(polyhedron: &Polyhedron, face: &MergedFace, height: f64, misfit: f64) -> f64 {
    face.slack + face_rounding(polyhedron.radius, height) + 2.0 * polyhedron.radius * misfit
}

/// The point projected on a face from `height` over it misses the plane by the rounding of height and product; `magnitude` is the
/// larger of the body's radius and the length of the point.
#[inline(always)]
pub fn face_rounding(magnitude: f64, height: f64) -> f64 {
    16.0 * U * (magnitude + height)
}

/// |RᵀU − n| for U = R·n computed, n of unit length and a rigid R: the defect of R, 5.4u for the product, and 12u for what the
/// planes and directions of a feature miss each other by.
pub const RIGID_MISFIT: f64 = RIGID_DEFECT + 18.0 * U;

/// A rigorous interval and |D| beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// |D|, the computed distance of the points.
    pub distance: f64,
    /// The interval.
    pub interval: Interval,
}

/// Square of the shortest direction that proves anything, 2⁻⁸⁰⁰: the loss to underflow in a product with a direction of 2⁻⁴⁰⁰ or
/// more is less than 2⁻⁶⁰⁰ of it, far below the error bound of any [in-range](Frame::in_range) pair.
const SHORTEST_SQUARE: f64 = f64::from_bits((1023 - 800) << 52);

/// 1/|U| from U·U; NaN, which proves nothing, for a direction too short for products with it.
#[inline(always)]
pub fn reciprocal_length(square: f64) -> f64 {
    if square >= SHORTEST_SQUARE { 1.0 / square.sqrt() } else { f64::NAN }
}

/// The interval from the difference D of two points that is off by at most `error`, its length `distance`, and how far it reaches
/// along a direction, U·D/|U|, its `projection`; the bodies reach at most `support_excess` farther along U/|U| than the points, and
/// these lie at most `point_error` out of the bodies.
#[inline(always)]
pub fn interval(distance: f64, projection: f64, error: f64, support_excess: f64, point_error: f64) -> Interval {
    let [lower, upper] = ends(distance, projection, error, support_excess, point_error);
    Interval { lower, upper }
}

/// The ends of [`interval`].
///
/// U·D errs by 4u|U||D|, root, reciprocal and product by 4u; support_excess has been summed with as much.
#[inline(always)]
pub fn ends<S: Scalar>(distance: S, projection: S, error: S, support_excess: S, point_error: S) -> [S; 2] {
    let [less, more] = [constant::<S>(1.0 - 4.0 * U), constant(1.0 + 4.0 * U)];
    let excess = support_excess * constant(1.0 + 64.0 * U);
    let lower = (projection - excess - error - constant::<S>(8.0 * U) * distance) * less;
    let upper = (distance * more + error + point_error) * more;
    [lower, upper]
}

/// How far a body misses the assumptions at a point of a feature.
struct Defect {
    /// δ: how far the body reaches beyond the point along g.
    support_excess: f64,
    /// How far the point may lie out of the body.
    point_error: f64,
}

/// Rounding error of g = RᵀU relative to |U|, which is at most 1.02|g|.
pub const DIRECTION_ERROR: f64 = 6.2 * U;

/// δ of any vertex of a body in direction g (local).
pub fn of_vertex(polyhedron: &Polyhedron, vertex: u32, g: &Vector) -> f64 {
    let length = norm1_of(g);
    match polyhedron.steepest_closely(vertex, g, length) {
        // A NaN proves nothing.
        Some(steepest) if !(steepest.slope < -STRICT * length) => of_tied_vertex(polyhedron, vertex, g),
        _ => 0.0,
    }
}

/// δ of a vertex that has neighbours not strictly behind it: from the edges at it, whichever proves most; where it has none
/// (a flat vertex, a body without edges) from all vertices.
#[cold]
fn of_tied_vertex(polyhedron: &Polyhedron, vertex: u32, g: &Vector) -> f64 {
    let edges = polyhedron.neighbour_blocks(vertex).flat_map(|block| block.edge);
    let best = edges
        .filter(|&edge| edge != NONE)
        .map(|edge| of_edge(polyhedron, &polyhedron.edges[edge as usize], Portable::from_vector(g)))
        .fold(f64::INFINITY, f64::min);
    if best < f64::INFINITY { best } else { by_all_vertices(polyhedron, vertex, g) }
}

/// δ of a vertex in direction g, from one edge at it; +∞ without an edge.
#[cold]
#[inline(never)]
pub fn of_edge_at_vertex(polyhedron: &Polyhedron, edge: u32, g: &Vector) -> f64 {
    let record = polyhedron.edges.get(edge as usize);
    record.map_or(f64::INFINITY, |record| of_edge(polyhedron, record, Portable::from_vector(g)))
}

/// δ of a vertex, from all vertices.
pub fn by_all_vertices(polyhedron: &Polyhedron, vertex: u32, g: &Vector) -> f64 {
    let own = &polyhedron.vertices[vertex as usize].position;
    let highest = polyhedron.vertices.iter().map(|v| g.dot(&(v.position - own))).fold(0.0, f64::max);
    // |v − own| ≤ 2ρ; difference and product err by 5u, g by DIRECTION_ERROR.
    highest + 2.0 * polyhedron.radius * norm1_of(g) * (5.0 * U + DIRECTION_ERROR)
}

/// δ of a point of an edge: g as a non-negative combination of the two face normals and a remainder. The second coefficient
/// comes from the remainder of the first: a tiny dihedral angle then leaves a remainder of order u, two independent quotients
/// one of order u/angle.
#[inline(always)]
fn of_edge<L: Lanes>(polyhedron: &Polyhedron, edge: &Edge, g: L) -> f64 {
    let length = g.norm1();
    if edge.left() == NONE {
        // A segment reaches as far beyond its point as the direction leans along it: ê is right to 4u, the product to 3u.
        let leaning = g.dot(L::from_vector(&edge_direction(&edge.planes))).abs();
        return 2.0 * polyhedron.radius * (leaning + (8.0 * U + DIRECTION_ERROR) * length);
    }
    let (first, second, first_slack, second_slack, coefficient) = if edge.bevel == NONE {
        let planes = &edge.planes;
        let outward = L::from_vector(&Vector::new(planes.x[3], planes.y[3], planes.z[3]));
        let [left, right] = [L::from_vector(&edge.normals[0]), L::from_vector(&edge.normals[1])];
        let [left_slack, right_slack] = [edge.left(), edge.right()].map(|face| polyhedron.faces[face as usize].slack);
        (left, right, left_slack, right_slack, g.dot(outward) * edge.reciprocal_sine)
    } else {
        let half = sharp_edge(polyhedron, edge, &polyhedron.bevels[edge.bevel as usize], &g.to_vector());
        let [first, second] = [L::from_vector(&half.normal), L::from_vector(&half.bevel)];
        (first, second, half.slacks[0], half.slacks[1], half.coefficient)
    };
    // A NaN from 0·∞ becomes 0 at an edge without a dihedral angle; there either normal will do.
    let c1 = clamp(coefficient, 0.0, length);
    let (c2, remainder) = beside(g, [first, second], c1);
    let rounding = 8.0 * U * polyhedron.radius;
    c1 * (first_slack + rounding)
        + c2 * (second_slack + rounding)
        + 2.0 * polyhedron.radius * (remainder.norm1() + REMAINDER * (length + c1 + c2) + DIRECTION_ERROR * length)
}

/// The rounding error of the remainder of a direction beside two normals or one, over the lengths of all parts.
pub const REMAINDER: f64 = 3.0 * U;

/// The second coefficient, and the remainder of g.
#[inline(always)]
pub fn beside<L: Lanes>(g: L, [first, second]: [L; 2], c1: f64) -> (f64, L) {
    let rest = first.negated_mul_add(L::splat(c1), g);
    let c2 = clamp(rest.dot(second), 0.0, f64::INFINITY);
    (c2, second.negated_mul_add(L::splat(c2), rest))
}

/// g − c·n.
#[inline(always)]
pub fn beside_one<S: Scalar>(g: [S; 3], normal: [S; 3], c: S) -> [S; 3] {
    [0, 1, 2].map(|k| g[k] - normal[k] * c)
}

/// The unit vector perpendicular to the normals between which an edge's cone, or the half of it that holds g, lies. The difference
/// of two nearly equal normals is exact, which keeps the digits of a product that nearly vanishes.
fn axis_of_cone(polyhedron: &Polyhedron, edge: &Edge, g: &Vector) -> Option<Vector> {
    let [first, second] = match polyhedron.bevels.get(edge.bevel as usize) {
        None => edge.normals,
        Some(bevel) => {
            let half = sharp_edge(polyhedron, edge, bevel, g);
            [half.normal, half.bevel]
        }
    };
    first.cross(&(second - first)).try_normalize(0.0)
}

/// The half of a sharp edge's normal cone that holds g: the coefficients of two nearly opposite normals would grow like
/// 1/sine, so the cone is split at the bevel plane, and each half is at most a right angle.
fn sharp_edge(polyhedron: &Polyhedron, edge: &Edge, bevel: &Bevel, g: &Vector) -> HalfCone {
    let along = edge_direction(&edge.planes);
    // In the plane across the edge, perpendicular to the bevel normal, towards the left face's normal.
    let mut towards_left = along.cross(&bevel.normal);
    if towards_left.dot(&edge.normals[0]) < 0.0 {
        towards_left = -towards_left;
    }
    let part = g.dot(&towards_left);
    let side = if part >= 0.0 { 0 } else { 1 };
    let normal = edge.normals[side];
    HalfCone {
        normal,
        bevel: bevel.normal,
        slacks: [polyhedron.faces[[edge.left(), edge.right()][side] as usize].slack, bevel.slack],
        coefficient: part / normal.dot(&towards_left),
    }
}

/// Half of a sharp edge's normal cone.
struct HalfCone {
    /// The face's normal.
    normal: Vector,
    /// The bevel's normal.
    bevel: Vector,
    /// Slacks of both.
    slacks: [f64; 2],
    /// The coefficient of `normal`.
    coefficient: f64,
}

/// Defects of a point in a face, found by projecting a point at `height` over it.
fn of_face(polyhedron: &Polyhedron, face: u32, g: &Vector, point: &Vector, height: f64) -> Defect {
    let record = &polyhedron.faces[face as usize];
    let length = norm1_of(g);
    let c = clamp(g.dot(&record.normal), 0.0, f64::INFINITY);
    let remainder = Vector::from(beside_one((*g).into(), record.normal.into(), c));
    // A point that is not in the face may be far out of the body, beyond the radius that the frame's bound of the difference is
    // for: that bound lacks 8u(|q| − ρ). The terms below have 11u|q| to spare: of 12u(ρ + |q|) they need 6.2u for g and 2u for the
    // remainder, of 16u(|q| + height) in `rounding` at most 9u.
    let apart = point.norm();
    let magnitude = if apart > polyhedron.radius { apart } else { polyhedron.radius };
    let rounding = face_rounding(magnitude, height);
    let support_excess = c * (record.slack + rounding)
        + (polyhedron.radius + magnitude)
            * (norm1_of(&remainder) + REMAINDER * (length + c) + DIRECTION_ERROR * length);
    // On the boundary of the face nothing is proved about the point; the fallback finds another.
    let is_inside = is_inside_sides(polyhedron, record, Portable::from_vector(point));
    let point_error = if is_inside { record.slack + rounding } else { f64::INFINITY };
    Defect { support_excess, point_error }
}

/// Whether a point q of a face's plane provably lies inside all its sides. Left of every line from corner to corner it lies in
/// the corners' hull, convex polygon or not, as the sides then go around it.
///
/// The margin, 64u·max(ρ, |q|₁), covers every rounding of the sides' planes: their normals are right to 8.5u, twice that where
/// a side leans out of the face's plane by 60°, which q feels over at most ρ + |q|; offsets to 3u·ρ, values at q to 4u·|q|. The
/// lever counts: at the tip of a needle whose sides are 1u apart the computed planes may diverge.
#[inline(always)]
pub fn is_inside_sides<L: Lanes>(polyhedron: &Polyhedron, face: &MergedFace, point: L) -> bool {
    let magnitude = point.norm1();
    let margin = L::splat(64.0 * U * if magnitude > polyhedron.radius { magnitude } else { polyhedron.radius });
    let mut inside = plane_values(&face.planes, point).greater(margin) & 0b1110 == 0b1110;
    if face.side_count > 3 {
        for block in polyhedron.further_sides(face) {
            inside &= plane_values(block, point).greater(margin) == 0b1111;
        }
    }
    inside
}

fn norm1_of(v: &Vector) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}
