//! Which features of two neighbouring levels belong together (Ehmann & Lin 2000, §4.3): from where to march on after a step from one
//! level to the other. A heuristic for speed; nothing rests on it.

use super::Links;
use super::bounding::faces_in_order;
use crate::error::Result;
use crate::math::Vector;
use crate::point_distance::PointDistance;
use crate::polyhedron::{NONE, Polyhedron};
use crate::state::FeatureId;

/// The child, on `below`, of each feature of `above`, and the parent, on `above`, of each feature of `below`.
pub struct Correspondence {
    /// For the features of the level above.
    pub children: Links,
    /// For the features of the level below.
    pub parents: Links,
}

/// The general scheme: the child of a vertex is the nearest vertex of the nearest feature below, and edges and faces share it with one of
/// their vertices; the parent of a face is the vertex above that is extreme along its normal, and its edges and vertices share it.
///
/// # Errors
/// None that a caller can cause.
pub fn by_position(below: &PointDistance, above: &Polyhedron) -> Result<Correspondence> {
    let polyhedron = below.polyhedron();
    let parent_of_face = extreme_vertices(polyhedron, above);
    let mut parents = Links::new(polyhedron);
    for (face, &parent) in parent_of_face.iter().enumerate() {
        parents.faces[face] = FeatureId::Vertex(parent);
        for edge in sides(polyhedron, face) {
            parents.edges[edge as usize] = FeatureId::Vertex(parent);
        }
    }
    for (corners, &face) in polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle) {
        for &v in corners {
            parents.vertices[v as usize] = FeatureId::Vertex(parent_of_face[face as usize]);
        }
    }

    let hints = hints_for_children(&parents, above);
    let mut children = Links::new(above);
    for (v, vertex) in above.vertices.iter().enumerate() {
        let child = match below.nearest(&vertex.position, hints[v]) {
            Some(nearest) => nearest.vertex,
            None => nearest_vertex_by_walking(polyhedron, &vertex.position, hints[v]),
        };
        children.vertices[v] = FeatureId::Vertex(child);
    }
    for (edge, child) in above.edges.iter().zip(&mut children.edges) {
        *child = children.vertices[edge.tail.max(edge.head) as usize];
    }
    for (corners, &face) in above.triangles.iter().zip(&above.face_of_triangle) {
        children.faces[face as usize] = children.vertices[corners[0] as usize];
    }
    Ok(Correspondence { children, parents })
}

/// The vertex of `above` that is extreme along the normal of each face of `below`.
pub fn extreme_vertices(below: &Polyhedron, above: &Polyhedron) -> Vec<u32> {
    let mut extreme = vec![NONE; below.faces.len()];
    // A face next to this one tells where to begin; there is one nearly always.
    let mut last = 0;
    for face in faces_in_order(below) {
        let known = sides(below, face as usize).find_map(|edge| {
            let edge = &below.edges[edge as usize];
            [edge.left, edge.right].map(|f| extreme[f as usize]).into_iter().find(|v| *v != NONE)
        });
        last = above.support(&below.faces[face as usize].normal, known.unwrap_or(last)).0;
        extreme[face as usize] = last;
    }
    extreme
}

/// The edges of a face.
fn sides(polyhedron: &Polyhedron, face: usize) -> impl Iterator<Item = u32> {
    let face = &polyhedron.faces[face];
    polyhedron.sides[face.first_side as usize..(face.first_side + face.side_count) as usize].iter().copied()
}

/// For each vertex above a vertex below whose parent it is, or that of a neighbour: where to look for its child.
fn hints_for_children(parents: &Links, above: &Polyhedron) -> Vec<u32> {
    let mut hints = vec![NONE; above.vertices.len()];
    let mut queue = Vec::new();
    for (child, parent) in (0..).zip(&parents.vertices) {
        if let FeatureId::Vertex(parent) = *parent
            && hints[parent as usize] == NONE
        {
            hints[parent as usize] = child;
            queue.push(parent);
        }
    }
    let mut done = 0;
    while let Some(&v) = queue.get(done) {
        done += 1;
        for head in above.neighbour_blocks(v).flat_map(|block| block.head) {
            if hints[head as usize] == NONE {
                hints[head as usize] = hints[v as usize];
                queue.push(head);
            }
        }
    }
    hints
}

/// From vertex to nearer neighbour until none is nearer.
fn nearest_vertex_by_walking(polyhedron: &Polyhedron, point: &Vector, start: u32) -> u32 {
    let distance = |v: u32| (polyhedron.vertices[v as usize].position - point).norm_squared();
    let mut nearest = (distance(start), start);
    loop {
        let before = nearest.1;
        for head in polyhedron.neighbour_blocks(before).flat_map(|block| block.head) {
            if distance(head) < nearest.0 {
                nearest = (distance(head), head);
            }
        }
        if nearest.1 == before {
            return before;
        }
    }
}
