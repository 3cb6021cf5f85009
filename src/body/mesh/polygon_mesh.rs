//! Polygons as the caller gave them: vertices and faces, only the checks that keep indexing safe. A face may be degenerate here:
//! whether that is an error depends on the use of the mesh.

use crate::base::error::{Error, Result};
use crate::base::locality::places_of;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, extend, filled, push, reserve, with_capacity};
use crate::base::progress::Progress;

/// A polygon mesh in the caller's own numbering.
#[derive(Debug, Clone, PartialEq)]
pub struct PolygonMesh {
    /// The vertices, finite.
    pub vertices: Vec<Vector>,
    /// The vertex indices of all faces, one face after the other, each counter-clockwise seen from outside.
    pub indices: Vec<u32>,
    /// Face `f` owns `indices[starts[f] as usize..starts[f + 1] as usize]`; one more entry than faces.
    pub starts: Vec<u32>,
    /// The coordinates went through single precision (STL): convexity is judged accordingly.
    pub single_precision: bool,
}

/// The caller's numbers of the vertices and the faces of a mesh in another order.
#[derive(Debug, Clone)]
pub struct Numbers {
    /// The caller's index of each vertex.
    pub vertices: Vec<u32>,
    /// The caller's index of each face.
    pub faces: Vec<u32>,
    /// The number of a face of the hull on which no face of the mesh lies; `None`: same as a neighbour.
    pub bare_face: Option<u32>,
    /// How far off a face of the hull a face of the mesh may be that lies on it.
    pub near: f64,
}

impl Default for PolygonMesh {
    /// No vertices, no faces.
    fn default() -> Self {
        PolygonMesh { vertices: Vec::new(), indices: Vec::new(), starts: vec![0], single_precision: false }
    }
}

impl PolygonMesh {
    /// From flat arrays. `valences` gives the number of vertices of each face; without it every face is a triangle.
    ///
    /// # Errors
    /// A coordinate that is not finite, counts that do not match or do not fit 32 bits, an index out of range: each names
    /// the face, corner or vertex.
    pub fn new(vertices: Vec<Vector>, indices: Vec<u32>, valences: Option<&[u32]>) -> Result<PolygonMesh> {
        count_u32(vertices.len(), "vertices")?;
        let index_count = count_u32(indices.len(), "vertex indices of faces")?;
        for (v, position) in vertices.iter().enumerate() {
            check_vertex(v, position)?;
        }
        let starts = match valences {
            Some(valences) => starts_from_valences(valences, index_count)?,
            None if index_count.is_multiple_of(3) => collected((0..=index_count).step_by(3))?,
            None => {
                return Err(Error::Argument(format!(
                    "{index_count} vertex indices are not a whole number of triangles"
                )));
            }
        };
        let mesh = PolygonMesh { vertices, indices, starts, single_precision: false };
        for f in 0..mesh.face_count() {
            check_face(f, mesh.face(f), mesh.vertices.len())?;
        }
        Ok(mesh)
    }

    /// Appends a vertex.
    ///
    /// # Errors
    /// A coordinate that is not finite, or more vertices than fit 32 bits.
    pub fn push_vertex(&mut self, position: Vector) -> Result<()> {
        check_vertex(self.vertices.len(), &position)?;
        count_u32(self.vertices.len() + 1, "vertices")?;
        push(&mut self.vertices, position)
    }

    /// Appends a face over the vertices that are there already.
    ///
    /// # Errors
    /// An index out of range, or more faces or indices than fit 32 bits.
    pub fn push_face(&mut self, corners: &[u32]) -> Result<()> {
        check_face(self.face_count(), corners, self.vertices.len())?;
        count_u32(self.face_count() + 1, "faces")?;
        let end = count_u32(self.indices.len() + corners.len(), "vertex indices of faces")?;
        reserve(&mut self.starts, 1)?;
        extend(&mut self.indices, corners.iter().copied())?;
        self.starts.push(end);
        Ok(())
    }

    /// The number of faces.
    pub fn face_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Whether the starts divide the indices into faces: they are public.
    pub(crate) fn divides_indices(&self) -> bool {
        let ends = [self.starts.first(), self.starts.last()].map(|start| start.map(|start| *start as usize));
        ends == [Some(0), Some(self.indices.len())] && self.starts.is_sorted()
    }

    /// The same with its vertices in the given order of all, and its faces in order of their lowest vertices: neighbours near
    /// each other. With it the previous numbers. `None` if the faces are no faces over the vertices.
    ///
    /// # Errors
    /// [`Error::Cancelled`] when the caller does not want to go on.
    pub(crate) fn in_order(&self, order: Vec<u32>, progress: &mut Progress) -> Result<Option<(PolygonMesh, Numbers)>> {
        debug_assert_eq!(order.len(), self.vertices.len());
        let count = self.vertices.len();
        if !self.divides_indices() || self.indices.iter().any(|v| *v as usize >= count) {
            return Ok(None);
        }
        let places = places_of(&order)?;
        let lowest = |f: usize| self.face(f).iter().map(|v| places[*v as usize]).min().unwrap_or(0) as usize;
        // Counting sort; it keeps the order of faces with the same lowest vertex.
        let all = 2 * self.face_count();
        let mut lowest_of: Vec<usize> = with_capacity(self.face_count())?;
        for f in 0..self.face_count() {
            progress.steps(self.face(f).len(), f, all)?;
            lowest_of.push(lowest(f));
        }
        let mut fill = filled(0_u32, count + 1)?;
        lowest_of.iter().for_each(|v| fill[v + 1] += 1);
        for v in 0..count {
            fill[v + 1] += fill[v];
        }
        let mut faces = filled(0, lowest_of.len())?;
        for (f, v) in (0..).zip(lowest_of) {
            faces[fill[v] as usize] = f;
            fill[v] += 1;
        }
        let mut mesh = PolygonMesh {
            vertices: collected(order.iter().map(|v| self.vertices[*v as usize]))?,
            indices: with_capacity(self.indices.len())?,
            starts: with_capacity(self.starts.len())?,
            single_precision: self.single_precision,
        };
        mesh.starts.push(0);
        for (done, &f) in faces.iter().enumerate() {
            progress.steps(self.face(f as usize).len(), all / 2 + done, all)?;
            mesh.indices.extend(self.face(f as usize).iter().map(|v| places[*v as usize]));
            mesh.starts.push(mesh.indices.len() as u32);
        }
        Ok(Some((mesh, Numbers { vertices: order, faces, bare_face: None, near: f64::INFINITY })))
    }

    /// The same with those vertices alone that faces have, and the index of each here. `None` if a face names a vertex
    /// that is not there, or the faces do not divide the indices.
    pub(crate) fn without_unused_vertices(&self) -> Result<Option<(PolygonMesh, Vec<u32>)>> {
        if !self.divides_indices() || self.indices.iter().any(|v| *v as usize >= self.vertices.len()) {
            return Ok(None);
        }
        let mut used = copied(&self.indices)?;
        used.sort_unstable();
        used.dedup();
        let place = |v: &u32| used.binary_search(v).unwrap_or_default() as u32;
        let mesh = PolygonMesh {
            vertices: collected(used.iter().map(|v| self.vertices[*v as usize]))?,
            indices: collected(self.indices.iter().map(place))?,
            starts: copied(&self.starts)?,
            single_precision: self.single_precision,
        };
        Ok(Some((mesh, used)))
    }

    /// Turns every face round; the starts divide the indices.
    pub(crate) fn turn(&mut self) {
        debug_assert!(self.divides_indices());
        for ends in self.starts.windows(2) {
            self.indices[ends[0] as usize..ends[1] as usize].reverse();
        }
    }

    /// The vertex indices of face `f`.
    pub fn face(&self, f: usize) -> &[u32] {
        &self.indices[self.starts[f] as usize..self.starts[f + 1] as usize]
    }
}

/// A count in 32 bits, the width of stored indices.
fn count_u32(count: usize, of: &str) -> Result<u32> {
    u32::try_from(count).map_err(|_| Error::Limit(format!("{count} {of} do not fit 32 bits")))
}

/// Running sums of the valences, which must add up to the number of indices.
fn starts_from_valences(valences: &[u32], index_count: u32) -> Result<Vec<u32>> {
    count_u32(valences.len(), "faces")?;
    let mut starts = with_capacity(valences.len() + 1)?;
    let mut end = 0_u32;
    starts.push(end);
    for (f, &valence) in valences.iter().enumerate() {
        end = end.checked_add(valence).filter(|&end| end <= index_count).ok_or_else(|| {
            Error::Argument(format!(
                "face {f} has {valence} vertices, but only {} of {index_count} vertex indices are left",
                index_count - end
            ))
        })?;
        starts.push(end);
    }
    if end == index_count {
        Ok(starts)
    } else {
        Err(Error::Argument(format!(
            "the faces have {end} vertices in all, but there are {index_count} vertex indices"
        )))
    }
}

/// Refuses a vertex with a coordinate that is not finite.
///
/// # Errors
/// [`Error::Mesh`], naming vertex and coordinate.
pub(crate) fn check_vertex(v: usize, position: &Vector) -> Result<()> {
    match position.iter().zip(["x", "y", "z"]).find(|(x, _)| !x.is_finite()) {
        None => Ok(()),
        Some((x, axis)) => Err(Error::Mesh(format!("vertex {v}: {axis} is not finite ({x})"))),
    }
}

fn check_face(f: usize, corners: &[u32], vertex_count: usize) -> Result<()> {
    match corners.iter().position(|&v| v as usize >= vertex_count) {
        None => Ok(()),
        Some(k) => Err(Error::Mesh(format!(
            "face {f}, corner {k}: vertex index {} is out of range ({vertex_count} vertices)",
            corners[k]
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> Vec<Vector> {
        vec![Vector::zeros(), Vector::x(), Vector::y()]
    }

    fn refusal(vertices: Vec<Vector>, indices: &[u32], valences: Option<&[u32]>) -> Error {
        PolygonMesh::new(vertices, indices.to_vec(), valences).unwrap_err()
    }

    #[test]
    fn triangles_need_no_valences() {
        let mesh = PolygonMesh::new(triangle(), vec![0, 1, 2, 0, 2, 1], None).unwrap();
        assert_eq!(mesh.face_count(), 2);
        assert_eq!(mesh.face(1), [0, 2, 1]);
    }

    #[test]
    fn pushed_and_given_at_once_are_the_same() {
        let mut vertices = triangle();
        vertices.push(Vector::new(1.0, 1.0, 0.0));
        let mut pushed = PolygonMesh::default();
        for v in &vertices {
            pushed.push_vertex(*v).unwrap();
        }
        pushed.push_face(&[0, 1, 3, 2]).unwrap();
        pushed.push_face(&[0, 2, 1]).unwrap();
        let given = PolygonMesh::new(vertices, vec![0, 1, 3, 2, 0, 2, 1], Some(&[4, 3])).unwrap();
        assert_eq!(pushed, given);
    }

    #[test]
    fn what_is_degenerate_is_a_mesh() {
        assert_eq!(PolygonMesh::default(), PolygonMesh::new(vec![], vec![], None).unwrap());
        assert_eq!(PolygonMesh::new(triangle(), vec![], None).unwrap().face_count(), 0);
        let mesh = PolygonMesh::new(triangle(), vec![2, 1, 0, 0], Some(&[2, 0, 2])).unwrap();
        assert_eq!((mesh.face(0), mesh.face(1), mesh.face(2)), (&[2, 1][..], &[][..], &[0, 0][..]));
    }

    #[test]
    fn refusals_say_where() {
        let mut bad = triangle();
        bad[1].y = f64::NAN;
        let cases: [(Error, Error); 5] = [
            (refusal(bad, &[], None), Error::Mesh("vertex 1: y is not finite (NaN)".into())),
            (
                refusal(triangle(), &[0, 1, 2, 0], None),
                Error::Argument("4 vertex indices are not a whole number of triangles".into()),
            ),
            (
                refusal(triangle(), &[0, 1, 2], Some(&[3, u32::MAX])),
                Error::Argument("face 1 has 4294967295 vertices, but only 0 of 3 vertex indices are left".into()),
            ),
            (
                refusal(triangle(), &[0, 1, 2, 0], Some(&[3])),
                Error::Argument("the faces have 3 vertices in all, but there are 4 vertex indices".into()),
            ),
            (
                refusal(triangle(), &[0, 1, 3], None),
                Error::Mesh("face 0, corner 2: vertex index 3 is out of range (3 vertices)".into()),
            ),
        ];
        for (got, expected) in cases {
            assert_eq!(got, expected);
        }
    }
}
