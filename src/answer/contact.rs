//! Witness points, normal and features of an answer, in the caller's frames and numbering.

use crate::answer::pair_answer::{Feature, FeatureKind, PairAnswer};
use crate::base::math::{Matrix, Pose, STRETCH, UNIT_ROUNDOFF, Vector, clamp, length};
use crate::base::simd::{Lanes, Portable};
use crate::body::polyhedron::{Edge, MergedFace, NONE, Polyhedron};
use crate::distance::certificate::Minimum;
use crate::placed::Pair;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use crate::placed::state::FeatureId;
use crate::placed::voronoi::edge_direction;

/// Neighbours of a vertex above which a look through all faces in the order of memory takes less time than one at those around
/// it.
const MOST_NEIGHBOURS: usize = 64;

/// Rounds of refinement of the weights of a contact. Each gains the digits that the inverse has, two where the tetrahedron is 10¹⁴
/// times as long as it is thick; most need one or two.
const MOST_REFINEMENTS: usize = 12;

const NOTHING: [f64; 3] = [f64::NAN; 3];

/// An answer without points and features, only with a normal.
#[inline(always)]
pub fn fill_normal<L: Lanes>(answer: &mut PairAnswer, normal: L) {
    fill_nothing(answer);
    normal.store_vector(&mut answer.normal);
}

/// An answer without points, normal and features.
#[inline(always)]
pub fn fill_nothing(answer: &mut PairAnswer) {
    answer.local1 = NOTHING;
    answer.local2 = NOTHING;
    answer.world1 = NOTHING;
    answer.world2 = NOTHING;
    answer.normal = NOTHING;
    answer.feature1 = Feature::default();
    answer.feature2 = Feature::default();
}

/// The features that hold the nearest points of two polyhedra.
pub struct NearestFeatures {
    pub features: [FeatureId; 2],
    /// How far the surfaces of swept bodies are from the points, along the normal.
    pub outwards: Option<[f64; 2]>,
}

/// From a prepared frame: a minimum, the unit normal from body 2 to body 1, and what holds the points.
#[inline(always)]
pub fn fill_separated<L: Lanes>(
    answer: &mut PairAnswer,
    frame: &Frame<L>,
    minimum: &Minimum<L>,
    normal: L,
    NearestFeatures { features, outwards }: NearestFeatures,
) {
    let ([body1, body2], Minimum { points, rotated, .. }) = (&frame.bodies, minimum);
    let mut local1 = points[0].add(L::from_vector(&body1.polyhedron.centre));
    let mut local2 = points[1].add(L::from_vector(&body2.polyhedron.centre));
    let [mut world1, mut world2] = [rotated[0].add(body1.translation), rotated[1].add(body2.translation)];
    if let Some([out1, out2]) = outwards {
        let [out1, out2] = [L::splat(out1), L::splat(out2)];
        local1 = body1.turn_back(normal).mul_add(out1, local1);
        local2 = body2.turn_back(normal).mul_add(out2, local2);
        world1 = normal.mul_add(out1, world1);
        world2 = normal.mul_add(out2, world2);
    }
    local1.store_vector(&mut answer.local1);
    local2.store_vector(&mut answer.local2);
    world1.store_vector(&mut answer.world1);
    world2.store_vector(&mut answer.world2);
    normal.store_vector(&mut answer.normal);
    answer.feature1 = label(body1.polyhedron, features[0], &points[0].to_vector());
    answer.feature2 = label(body2.polyhedron, features[1], &points[1].to_vector());
}

/// As [`fill_separated`] without a frame, for any magnitudes, and except the normal.
pub fn fill_placed(answer: &mut PairAnswer, pair: &Pair, points: &[Vector; 2], features: [FeatureId; 2]) {
    let PlacedPoints { local, world } = placed_points(pair, points);
    [answer.local1, answer.local2] = local;
    [answer.world1, answer.world2] = world;
    answer.feature1 = label(pair.polyhedra[0], features[0], &points[0]);
    answer.feature2 = label(pair.polyhedra[1], features[1], &points[1]);
}

/// Points of two bodies, in both frames.
pub struct PlacedPoints {
    /// In the bodies' own frames.
    pub local: [[f64; 3]; 2],
    /// In the world.
    pub world: [[f64; 3]; 2],
}

/// Points given in centred coordinates.
pub fn placed_points(pair: &Pair, points: &[Vector; 2]) -> PlacedPoints {
    let Pair { polyhedra, poses } = *pair;
    let local = [points[0] + polyhedra[0].centre, points[1] + polyhedra[1].centre];
    let world = [placed(poses[0], &local[0]), placed(poses[1], &local[1])];
    PlacedPoints { local: local.map(Into::into), world: world.map(Into::into) }
}

/// A local point in the world, infinite only where the world is larger than the doubles: not where terms that cancel are.
fn placed(pose: &Pose, local: &Vector) -> Vector {
    let world = pose.transform(local);
    if world.iter().all(|x| x.is_finite()) {
        return world;
    }
    (pose.rotate(&(0.125 * local)) + 0.125 * pose.translation()) * 8.0
}

/// The vertex pairs that prove an intersection, in the caller's numbering.
pub fn fill_proof(answer: &mut PairAnswer, polyhedra: [&Polyhedron; 2], pairs: &[VertexPair]) {
    answer.proof_count = pairs.len() as u32;
    for (out, pair) in answer.proof.iter_mut().zip(pairs) {
        *out = std::array::from_fn(|i| polyhedra[i].vertex_labels[pair[i] as usize]);
    }
}

/// The unit vector of a direction, scaled first so that no square leaves the range of doubles.
pub fn normalised(direction: &Vector) -> [f64; 3] {
    let scaled = direction / direction.amax();
    (scaled / scaled.norm()).into()
}

/// A feature in the caller's numbering; `point` is the witness point in centred coordinates.
#[inline(always)]
pub fn label(polyhedron: &Polyhedron, feature: FeatureId, point: &Vector) -> Feature {
    match feature {
        FeatureId::Vertex(v) => Feature { kind: FeatureKind::Vertex, ids: [polyhedron.vertex_labels[v as usize], 0] },
        FeatureId::Edge(e) => Feature { kind: FeatureKind::Edge, ids: polyhedron.edges[e as usize].labels },
        FeatureId::Face(f) => {
            let label = polyhedron.faces[f as usize].label;
            let id = if label == NONE { polyhedron.polygon_at(f, point) } else { label };
            Feature { kind: FeatureKind::Face, ids: [id, 0] }
        }
    }
}

/// The features that hold the given points (centred) of a simplex of vertex pairs: one vertex, the edge of two, else the face that
/// holds the point; of several the one that looks most towards the other body. A point may be as far as `within` inside its body,
/// seen along the direction.
pub fn features_of_pairs(
    pair: &Pair,
    pairs: &[VertexPair],
    points: &[Vector; 2],
    direction: &Vector,
    within: f64,
) -> [FeatureId; 2] {
    std::array::from_fn(|i| {
        let towards = pair.poses[i].rotate_back(&if i == 0 { -direction } else { *direction });
        let mut vertices = [0; 4];
        let mut count = 0;
        for pair in pairs.iter().take(4) {
            if !vertices[..count].contains(&pair[i]) {
                vertices[count] = pair[i];
                count += 1;
            }
        }
        feature_of_vertices(pair.polyhedra[i], &vertices[..count], &points[i], &towards, within)
    })
}

/// The feature that holds a convex combination of vertices, as [`features_of_pairs`] has it; `towards` in the body's axes.
pub fn feature_of_vertices(
    polyhedron: &Polyhedron,
    vertices: &[u32],
    point: &Vector,
    towards: &Vector,
    within: f64,
) -> FeatureId {
    let &[first, ref others @ ..] = vertices else { return FeatureId::Vertex(0) };
    if others.is_empty() {
        return FeatureId::Vertex(first);
    }
    if polyhedron.dimension == 1 {
        return FeatureId::Edge(0);
    }
    if let &[second] = others {
        let joins = |e: u32| {
            let edge = &polyhedron.edges[e as usize];
            [edge.tail(), edge.head()] == [first, second] || [edge.head(), edge.tail()] == [first, second]
        };
        if let Some(edge) = edges_at(polyhedron, first).find(|&e| joins(e)) {
            return FeatureId::Edge(edge);
        }
    }
    if let Some(face) = face_beside(polyhedron, vertices, point, towards) {
        return FeatureId::Face(face);
    }
    // The faces around the vertices hold the point, except for vertices inside a merged face and slivers that rounding shuffles.
    // The face that holds a convex combination holds all its vertices, so those with many faces around them can be left out.
    let has_few = |v: &&u32| polyhedron.neighbour_capacity(**v) <= MOST_NEIGHBOURS;
    let around = vertices.iter().filter(has_few).flat_map(|&v| faces_at(polyhedron, v));
    let face = face_holding(polyhedron, around, point, towards)
        .or_else(|| face_ahead(polyhedron, first, point, towards, within))
        .or_else(|| nearest_face(polyhedron, point, towards));
    face.map_or(FeatureId::Vertex(first), FeatureId::Face)
}

/// The face that alone holds a point, where it is at an edge between two of the vertices: so it is mostly. One that looks away from
/// the other body is not alone, if the body is a plate thinner than rounding.
fn face_beside(polyhedron: &Polyhedron, vertices: &[u32], point: &Vector, towards: &Vector) -> Option<u32> {
    if polyhedron.dimension < 3 || polyhedron.neighbour_capacity(vertices[0]) > MOST_NEIGHBOURS {
        return None;
    }
    let between = edges_at(polyhedron, vertices[0]).map(|edge| &polyhedron.edges[edge as usize]);
    let mut between = between.filter(|edge| vertices.contains(&edge.tail()) && vertices.contains(&edge.head()));
    let looks_there = |face: u32| polyhedron.faces[face as usize].normal.dot(towards) > 0.0;
    let is_alone = |&face: &u32| is_inside(polyhedron, face, point) && looks_there(face);
    between.find_map(|edge| [edge.left(), edge.right()].into_iter().find(is_alone))
}

/// Whether a point on the plane of a face is so far inside its sides that no other face holds it.
fn is_inside(polyhedron: &Polyhedron, face: u32, point: &Vector) -> bool {
    let record = &polyhedron.faces[face as usize];
    record.planes.value(0, point).abs() <= rounding(polyhedron)
        && side_values(polyhedron, record, point).all(|value| value > 2.0 * rounding(polyhedron))
}

/// A point that is farther inside than this many times the rounding is not on the boundary.
const WELL_INSIDE: f64 = 64.0;

/// Faces walked over before all are looked at.
const LONGEST_WALK: usize = 64;

/// The face through which a point inside the body, rounding apart, leaves it along a direction, if that is no farther than
/// `within`: a walk from the faces at a vertex over neighbours whose planes the ray meets earlier. As the least of linear
/// functions the way to the boundary has no other minima than the least.
fn face_ahead(polyhedron: &Polyhedron, vertex: u32, point: &Vector, towards: &Vector, within: f64) -> Option<u32> {
    // A point on the boundary, rounding included, is left to the planes and sides.
    if within <= WELL_INSIDE * rounding(polyhedron) {
        return None;
    }
    let way = |face: u32| {
        let record = &polyhedron.faces[face as usize];
        let slope = record.normal.dot(towards);
        if slope > 0.0 { -record.planes.value(0, point) / slope } else { f64::INFINITY }
    };
    let nearer = |best: (u32, f64), face: u32| {
        let way = way(face);
        if way < best.1 { (face, way) } else { best }
    };
    let mut best = faces_at(polyhedron, vertex).take(MOST_NEIGHBOURS).fold((NONE, f64::INFINITY), nearer);
    if best.0 == NONE {
        // No face at the vertex looks there.
        best = (0..polyhedron.faces.len() as u32).fold(best, nearer);
    }
    for _ in 0..LONGEST_WALK {
        let (face, _) = best;
        let record = polyhedron.faces.get(face as usize)?;
        let range = record.first_side as usize..(record.first_side + record.side_count) as usize;
        let edges = polyhedron.sides[range].iter().map(|&side| &polyhedron.edges[side as usize]);
        best = edges.flat_map(|edge| [edge.left(), edge.right()]).fold(best, nearer);
        if best.0 == face {
            // The plane's height is rounded; `within` may be exactly the way to it in the world, whose lengths a pose shrinks.
            let reach = STRETCH * STRETCH * within + rounding(polyhedron);
            return (misses_face(polyhedron, face, point) <= reach).then_some(face);
        }
    }
    None
}

/// The face that looks most towards the other body, among the faces that hold a point, rounding included.
fn face_holding(
    polyhedron: &Polyhedron,
    faces: impl Iterator<Item = u32>,
    point: &Vector,
    towards: &Vector,
) -> Option<u32> {
    let (mut best, mut steepest) = (None, f64::NEG_INFINITY);
    for face in faces {
        let slope = polyhedron.faces[face as usize].normal.dot(towards);
        // The plane first excludes most that do not hold it.
        let is_on_plane = polyhedron.faces[face as usize].planes.value(0, point).abs() <= rounding(polyhedron);
        if is_on_plane && slope > steepest && misses_face(polyhedron, face, point) == 0.0 {
            (best, steepest) = (Some(face), slope);
        }
    }
    best
}

/// The face nearest to a point in the body, of several the one that looks most towards the other body. It is the face whose plane
/// is nearest: the foot on it lies in the body, so in the face. If rounding leaves several planes, the distances decide.
fn nearest_face(polyhedron: &Polyhedron, point: &Vector, towards: &Vector) -> Option<u32> {
    let height = |face: &MergedFace| face.planes.value(0, point);
    let highest = polyhedron.faces.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
    let (mut best, mut least, mut steepest) = (None, f64::INFINITY, f64::NEG_INFINITY);
    for (face, record) in (0..).zip(&polyhedron.faces) {
        if height(record) >= highest - 2.0 * rounding(polyhedron) {
            let (misses, slope) = (misses_face(polyhedron, face, point), record.normal.dot(towards));
            if misses < least || (misses == least && slope > steepest) {
                (best, least, steepest) = (Some(face), misses, slope);
            }
        }
    }
    best
}

/// The rounding error by which a point of a face may miss its plane and its sides' planes.
fn rounding(polyhedron: &Polyhedron) -> f64 {
    64.0 * UNIT_ROUNDOFF * polyhedron.radius
}

/// The edges at a vertex.
fn edges_at(polyhedron: &Polyhedron, vertex: u32) -> impl Iterator<Item = u32> {
    polyhedron.neighbour_blocks(vertex).flat_map(|block| block.edge).filter(|&edge| edge != NONE)
}

/// The faces at a vertex, each twice.
pub fn faces_at(polyhedron: &Polyhedron, vertex: u32) -> impl Iterator<Item = u32> {
    let beside = edges_at(polyhedron, vertex).flat_map(|edge| {
        let edge = &polyhedron.edges[edge as usize];
        [edge.left(), edge.right()]
    });
    // A segment's has none.
    beside.filter(|&face| face != NONE)
}

/// The distance of a point from a face; 0 within the rounding of its planes. At the sharp corner of a sliver a point may
/// violate the sides by next to nothing and still be far away, so that the sides only tell whether it is clearly inside: of a
/// sliver thinner than rounding they tell nothing.
fn misses_face(polyhedron: &Polyhedron, face: u32, point: &Vector) -> f64 {
    let record = &polyhedron.faces[face as usize];
    let clearly = 0.5 * rounding(polyhedron);
    let misses = if side_values(polyhedron, record, point).all(|value| value > clearly) {
        record.planes.value(0, point).abs()
    } else {
        let range = record.first_side as usize..(record.first_side + record.side_count) as usize;
        let edges = polyhedron.sides[range].iter().map(|&side| &polyhedron.edges[side as usize]);
        edges.map(|edge| distance_to_edge(polyhedron, edge, point)).fold(f64::INFINITY, f64::min)
    };
    if misses <= rounding(polyhedron) { 0.0 } else { misses }
}

/// How far inside each side of a face a point is.
fn side_values<'a>(
    polyhedron: &'a Polyhedron,
    record: &'a MergedFace,
    point: &'a Vector,
) -> impl Iterator<Item = f64> + 'a {
    let first = (1..4).map(|lane| record.planes.value(lane, point));
    let further = polyhedron.further_sides(record).iter();
    first.chain(further.flat_map(|block| (0..4).map(|lane| block.value(lane, point))))
}

fn distance_to_edge(polyhedron: &Polyhedron, edge: &Edge, point: &Vector) -> f64 {
    let from_tail = point - polyhedron.vertices[edge.tail() as usize].position;
    let direction = edge_direction(&edge.planes);
    let t = clamp(from_tail.dot(&direction), 0.0, edge.length);
    length(&(from_tail - direction * t))
}

/// Convex weights of an enclosing tetrahedron, improved by iterative refinement: those from its determinants lose digits where it
/// is thin, and the two witness points of a contact must coincide.
pub fn refined_weights(pair: &Pair, pairs: &[VertexPair], mut weights: [f64; 4]) -> [f64; 4] {
    let polyhedra = pair.polyhedra;
    let &[p0, p1, p2, p3] = pairs else { return weights };
    let frame = Frame::<Portable>::new(pair);
    if !frame.in_range {
        return weights;
    }
    let corners = [p0, p1, p2, p3].map(|[v, w]| {
        let [vertex1, vertex2] = [&polyhedra[0].vertices[v as usize], &polyhedra[1].vertices[w as usize]];
        frame.difference(&vertex1.position, &vertex2.position).to_vector()
    });
    let sides = Matrix::from_columns(&[corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]]);
    let Some(inverse) = sides.try_inverse() else { return weights };
    let missed = |weights: &[f64; 4]| -> Vector { (0..4).map(|k| corners[k] * weights[k]).sum() };
    for _ in 0..MOST_REFINEMENTS {
        let step = inverse * missed(&weights);
        let mut better = weights;
        for k in 0..3 {
            better[k + 1] -= step[k];
        }
        better[0] = 1.0 - better[1] - better[2] - better[3];
        // Refinement ends where rounding does not let it gain; a weight that leaves [0, 1] would leave the bodies.
        let is_convex = better.iter().all(|weight| (0.0..=1.0).contains(weight));
        if !is_convex || missed(&better).norm() >= missed(&weights).norm() {
            break;
        }
        weights = better;
    }
    weights
}
