//! Names of witness points on bodies thinner than rounding: vertices and edges of theirs are one up to rounding, and which of them
//! holds a point depends on the search. The first of them names the point, so that it keeps its id.

use crate::answer::{Feature, FeatureKind};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::body::polyhedron::Polyhedron;

/// Vertices nearer to each other than this, relative to the radius, are one: positions err by u each, and searches by some more.
const ONE: f64 = 64.0 * U;

/// The vertex or edge that names a point on a feature: the first that is one with it up to rounding. Ordinary bodies have no other,
/// and are told by their volume.
pub fn steady(polyhedron: &Polyhedron, feature: Feature) -> Feature {
    let within = ONE * polyhedron.radius;
    let reach = 2.0 * polyhedron.radius;
    // Thinner than `within` along one direction, and no larger than its ball along the others. False of other bodies' NaN.
    let is_thin = polyhedron.mass.volume <= within * reach * reach;
    if !is_thin {
        return feature;
    }
    let place = |label: u32| {
        let vertex = polyhedron.vertex_labels.iter().position(|&other| other == label);
        vertex.map(|vertex| polyhedron.vertices[vertex].position)
    };
    let are_one = |a: &Vector, b: &Vector| (a - b).amax() <= within;
    match (feature.kind, feature.ids.map(place)) {
        (FeatureKind::Vertex, [Some(own), _]) => {
            let first = polyhedron.vertices.iter().position(|vertex| are_one(&vertex.position, &own));
            first.map_or(feature, |first| Feature { ids: [polyhedron.vertex_labels[first], 0], ..feature })
        }
        (FeatureKind::Edge, [Some(tail), Some(head)]) => {
            let first = polyhedron.edges.iter().find(|edge| {
                let [a, b] = [edge.tail(), edge.head()].map(|vertex| polyhedron.vertices[vertex as usize].position);
                (are_one(&a, &tail) && are_one(&b, &head)) || (are_one(&a, &head) && are_one(&b, &tail))
            });
            first.map_or(feature, |first| Feature { ids: first.labels, ..feature })
        }
        _ => feature,
    }
}
