//! Names of points on bodies thinner than rounding: vertices, edges and faces of theirs are one up to rounding, and which of them
//! holds a point depends on the proof that the search ends with. The point's place names it, so that it keeps its id.

use super::answer::ManifoldPoint;
use super::id::id_of;
use super::patch::COINCIDENT;
use crate::answer::{Feature, FeatureKind, label};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::body::polyhedron::Polyhedron;
use crate::placed::state::FeatureId;

/// Places nearer to each other than this, relative to the radius, are one: positions err by u each, and searches by some more.
const ONE: f64 = 64.0 * U;

/// Names the features of a point by its place on each body that is thinner than rounding: the first vertex there, else the first
/// edge, else the first face. Ordinary bodies have one feature at a place, and are told by their volume.
pub fn name_by_place(polyhedra: [&Polyhedron; 2], point: &mut ManifoldPoint) {
    let [is_thin1, is_thin2] = polyhedra.map(is_thin);
    if is_thin1 {
        point.feature1 = first_at(polyhedra[0], &point.local1, point.feature1);
    }
    if is_thin2 {
        point.feature2 = first_at(polyhedra[1], &point.local2, point.feature2);
    }
    if is_thin1 || is_thin2 {
        point.id = id_of(&point.feature1, &point.feature2);
    }
}

/// Thinner than [`ONE`] along one direction, and no larger than its ball along the others. False of a NaN.
pub fn is_thin(polyhedron: &Polyhedron) -> bool {
    let reach = 2.0 * polyhedron.radius;
    polyhedron.mass.volume <= ONE * polyhedron.radius * reach * reach
}

fn first_at(polyhedron: &Polyhedron, local: &[f64; 3], feature: Feature) -> Feature {
    let radius = polyhedron.radius;
    let point = Vector::from(*local) - polyhedron.centre;
    // Lengths are over the radius, so that no square of theirs leaves the range. A local point errs by u of its largest
    // coordinate.
    let within = ONE * (1.0 + polyhedron.centre.amax() / radius);
    // Farther apart than this, places are told apart. False of a point's NaN.
    if !(within <= COINCIDENT) {
        return feature;
    }
    let from = |vertex: u32| (point - polyhedron.vertices[vertex as usize].position) / radius;
    let is_vertex = |&vertex: &u32| from(vertex).amax() <= within;
    let is_edge = |&edge: &u32| {
        let edge = &polyhedron.edges[edge as usize];
        let [tail, head] = [edge.tail(), edge.head()].map(from);
        let along = tail - head;
        let share = tail.dot(&along) / along.dot(&along);
        (tail - along * share.clamp(0.0, 1.0)).amax() <= within
    };
    let is_face = |&face: &u32| {
        let face = &polyhedron.faces[face as usize];
        let is_inside = |side| {
            let [x, y, z, offset] = polyhedron.side_plane(face, side);
            (Vector::new(x, y, z).dot(&point) + offset) / radius >= -within
        };
        (face.planes.value(0, &point) / radius).abs() <= within && (0..face.side_count as usize).all(is_inside)
    };
    // What is on an edge is on a face, too, but two points are told apart by their edges.
    let is_on_face = feature.kind == FeatureKind::Face;
    let vertex = (0..polyhedron.vertices.len() as u32).find(is_vertex).map(FeatureId::Vertex);
    let edge = || (0..polyhedron.edges.len() as u32).find(is_edge).map(FeatureId::Edge);
    let face = || (0..polyhedron.faces.len() as u32).find(|face| is_on_face && is_face(face)).map(FeatureId::Face);
    vertex.or_else(edge).or_else(face).map_or(feature, |first| label(polyhedron, first, &point))
}
