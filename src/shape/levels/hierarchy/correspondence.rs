//! Which features of two neighbouring levels belong together (Ehmann & Lin 2000, §4.3): from where to march on after a step
//! from one level to the other. A heuristic for speed; nothing rests on it.

use super::bounding::faces_in_order;
use super::links::Links;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, filled, push};
use crate::body::polyhedron::{NONE, Polyhedron};
use crate::placed::state::FeatureId;
use crate::shape::levels::point_distance::PointDistance;

/// The child, on `below`, of each feature of `above`, and the parent, on `above`, of each feature of `below`.
pub struct Correspondence {
    /// For the features of the level above.
    pub children: Links,
    /// For the features of the level below.
    pub parents: Links,
}

/// The general scheme: the child of a vertex is the nearest vertex of the nearest feature below, and edges and faces share it
/// with one of their vertices; the parent of a face is the vertex above that is extreme along its normal, and its edges and
/// vertices share it.
///
/// # Errors
/// [`Error::Bug`](crate::base::error::Error::Bug) if the triangles of a polyhedron are no closed surface.
pub fn by_position(below: &PointDistance, above: &Polyhedron) -> Result<Correspondence> {
    let polyhedron = below.polyhedron();
    let parent_of_face = extreme_vertices(polyhedron, above)?;
    let mut parents = Links::new(polyhedron)?;
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

    let hints = hints_for_children(&parents, above)?;
    let mut children = Links::new(above)?;
    for (v, vertex) in above.vertices.iter().enumerate() {
        // The nearest point lies in a triangle; the face that the triangle is a part of may have vertices that are nearer.
        let start = below.nearest(&vertex.position, hints[v]).vertex;
        children.vertices[v] = FeatureId::Vertex(nearest_vertex_by_walking(polyhedron, &vertex.position, start));
    }
    for (edge, child) in above.edges.iter().zip(&mut children.edges) {
        *child = children.vertices[edge.tail().max(edge.head()) as usize];
    }
    for (corners, &face) in above.triangles.iter().zip(&above.face_of_triangle) {
        children.faces[face as usize] = children.vertices[corners[0] as usize];
    }
    Ok(Correspondence { children, parents })
}

/// The scheme of a hierarchy whose levels have vertices of the body, moved. A feature that is kept corresponds to itself, a new
/// edge or face to the vertex that was removed there, and that to its replacement, by position. `ids` gives for the vertices of
/// `below` and of `above` which of the body they are, `filled` for the new triangles the removed vertex.
///
/// The paper says so for children; its parents "are different", no more. A removed vertex gets a neighbour that is kept, the
/// faces around it the vertex that is extreme along their normals.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn by_identity(
    [below, above]: [&Polyhedron; 2],
    ids: [&[u32]; 2],
    filled: &[([u32; 3], u32)],
    count: usize,
) -> Result<Correspondence> {
    debug_assert!(ids[0].len() == below.vertices.len() && ids[1].len() == above.vertices.len() && filled.is_sorted());
    let [in_below, in_above] = [index_of(ids[0], count)?, index_of(ids[1], count)?];
    let vertex_below = |id: u32| in_below[id as usize];

    // A vertex of the level below may have been left out there, where rounding put it into a face.
    let nearest_below = |v: u32| nearest_vertex_by_walking(below, &above.vertices[v as usize].position, 0);
    let mut children = Links::new(above)?;
    for (v, id) in (0..).zip(ids[1]) {
        let kept = vertex_below(*id);
        children.vertices[v as usize] = FeatureId::Vertex(if kept == NONE { nearest_below(v) } else { kept });
    }
    let triangles_below = triangles_by_ids(below, ids[0])?;
    let removed_at = |corners: &[u32; 3]| {
        let found = filled.binary_search_by_key(corners, |(corners, _)| *corners).ok();
        found.map(|i| vertex_below(filled[i].1)).filter(|v| *v != NONE)
    };
    for (corners, face) in triangles_by_ids(above, ids[1])? {
        let kept = triangles_below.binary_search_by_key(&corners, |(corners, _)| *corners).ok();
        children.faces[face as usize] = match (kept, removed_at(&corners)) {
            (Some(i), _) => FeatureId::Face(triangles_below[i].1),
            (None, Some(removed)) => FeatureId::Vertex(removed),
            // Neither: rounding has turned a diagonal over.
            (None, None) => children.vertices[in_above[corners[0] as usize] as usize],
        };
    }
    for (edge, child) in above.edges.iter().zip(&mut children.edges) {
        let ends = [edge.tail(), edge.head()].map(|v| vertex_below(ids[1][v as usize]));
        let mut beside = [edge.right(), edge.left()].map(|f| children.faces[f as usize]).into_iter();
        *child = match edge_between(below, ends) {
            Some(kept) => FeatureId::Edge(kept),
            None => beside
                .find(|child| matches!(child, FeatureId::Vertex(_)))
                .unwrap_or(children.vertices[edge.tail() as usize]),
        };
    }

    let mut parents = Links::new(below)?;
    for (parent, extreme) in parents.faces.iter_mut().zip(extreme_vertices(below, above)?) {
        *parent = FeatureId::Vertex(extreme);
    }
    for (edge, parent) in below.edges.iter().zip(&mut parents.edges) {
        *parent = parents.faces[edge.right() as usize];
    }
    for (v, id) in (0..).zip(ids[0]) {
        let kept = in_above[*id as usize];
        let position = |w: u32| above.vertices[w as usize].position;
        let distance = |w: &u32| (position(*w) - below.vertices[v as usize].position).norm_squared();
        let neighbours = below.neighbour_blocks(v).flat_map(|block| block.head);
        let near = neighbours.map(|w| in_above[ids[0][w as usize] as usize]).filter(|w| *w != NONE);
        let nearest = || near.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
        parents.vertices[v as usize] = FeatureId::Vertex(if kept == NONE { nearest() } else { kept });
    }
    for (f, child) in (0..).zip(&children.faces) {
        if let FeatureId::Face(below) = *child {
            parents.faces[below as usize] = FeatureId::Face(f);
        }
    }
    for (e, child) in (0..).zip(&children.edges) {
        if let FeatureId::Edge(below) = *child {
            parents.edges[below as usize] = FeatureId::Edge(e);
        }
    }
    Ok(Correspondence { children, parents })
}

/// The index of each id in a list of some of 0..`count`; NONE for the others.
fn index_of(ids: &[u32], count: usize) -> Result<Vec<u32>> {
    debug_assert!(ids.iter().all(|id| (*id as usize) < count));
    debug_assert!(ids.iter().all(|id| (*id as usize) < count));
    let mut index = filled(NONE, count)?;
    for (i, id) in (0..).zip(ids) {
        index[*id as usize] = i;
    }
    Ok(index)
}

/// The triangles of a polyhedron by the ids of their corners, ascending, and the faces that they are part of; in order.
fn triangles_by_ids(polyhedron: &Polyhedron, ids: &[u32]) -> Result<Vec<([u32; 3], u32)>> {
    let by_ids = |(corners, face): (&[u32; 3], &u32)| {
        let mut corners = corners.map(|v| ids[v as usize]);
        corners.sort_unstable();
        (corners, *face)
    };
    let mut triangles = collected(polyhedron.triangles.iter().zip(&polyhedron.face_of_triangle).map(by_ids))?;
    triangles.sort_unstable();
    Ok(triangles)
}

/// The edge from one vertex to another, if there is one; they may be NONE.
fn edge_between(polyhedron: &Polyhedron, [tail, head]: [u32; 2]) -> Option<u32> {
    if tail == NONE || head == NONE {
        return None;
    }
    let lanes = polyhedron.neighbour_blocks(tail).flat_map(|block| block.head.into_iter().zip(block.edge));
    lanes.filter(|(_, edge)| *edge != NONE).find(|(neighbour, _)| *neighbour == head).map(|(_, edge)| edge)
}

/// The vertex of `above` that is extreme along the normal of each face of `below`.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn extreme_vertices(below: &Polyhedron, above: &Polyhedron) -> Result<Vec<u32>> {
    let mut extreme = filled(NONE, below.faces.len())?;
    // A face next to this one tells where to begin; there is one nearly always.
    let mut last = 0;
    for face in faces_in_order(below)? {
        let known = sides(below, face as usize).find_map(|edge| {
            let edge = &below.edges[edge as usize];
            [edge.left(), edge.right()].map(|f| extreme[f as usize]).into_iter().find(|v| *v != NONE)
        });
        last = above.support(&below.faces[face as usize].normal, known.unwrap_or(last)).0;
        extreme[face as usize] = last;
    }
    Ok(extreme)
}

/// The edges of a face.
fn sides(polyhedron: &Polyhedron, face: usize) -> impl Iterator<Item = u32> {
    let face = &polyhedron.faces[face];
    polyhedron.sides[face.first_side as usize..(face.first_side + face.side_count) as usize].iter().copied()
}

/// For each vertex above a vertex below whose parent it is, or that of a neighbour: where to look for its child.
fn hints_for_children(parents: &Links, above: &Polyhedron) -> Result<Vec<u32>> {
    let mut hints = filled(NONE, above.vertices.len())?;
    let mut queue = Vec::new();
    for (child, parent) in (0..).zip(&parents.vertices) {
        if let FeatureId::Vertex(parent) = *parent
            && hints[parent as usize] == NONE
        {
            hints[parent as usize] = child;
            push(&mut queue, parent)?;
        }
    }
    let mut done = 0;
    while let Some(&v) = queue.get(done) {
        done += 1;
        for head in above.neighbour_blocks(v).flat_map(|block| block.head) {
            if hints[head as usize] == NONE {
                hints[head as usize] = hints[v as usize];
                push(&mut queue, head)?;
            }
        }
    }
    Ok(hints)
}

/// From vertex to nearer neighbour until none is nearer.
fn nearest_vertex_by_walking(polyhedron: &Polyhedron, point: &Vector, start: u32) -> u32 {
    debug_assert!((start as usize) < polyhedron.vertices.len());
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
