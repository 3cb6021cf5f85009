//! The triangles of a mesh, and which of them meet at an edge.

use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, extend, filled, push, with_capacity};
use crate::base::predicates::{ExactPoints, FilteredPlane};
use crate::base::progress::Progress;
use crate::body::build::check::{check_indices, first_of_equal};
use crate::body::decomposition::triangulation::triangulate;
use crate::body::mesh::PolygonMesh;

/// No triangle.
pub const NONE: u32 = u32::MAX;

/// The plane of three points, with a margin in which other points count as on it.
#[derive(Debug, Clone, Copy)]
pub struct CutPlane {
    filtered: FilteredPlane,
    /// The margin times the length of the normal.
    slack: f64,
}

/// A surface of triangles, oriented and with at most two at an edge.
pub struct MeshSurface {
    pub points: ExactPoints,
    pub position: Vec<Vector>,
    /// Their corners; among exactly equal vertices, the first.
    pub triangles: Vec<[u32; 3]>,
    /// The face of the mesh that each is a part of.
    pub faces: Vec<u32>,
    /// The triangle across the edge from corner `k` of triangle `t` to the next is `across[t][k]`, or [`NONE`].
    pub across: Vec<[u32; 3]>,
    /// Whether there is a body below each triangle: it is in a closed part that holds a volume.
    pub is_solid: Vec<bool>,
    /// How close to a plane a point is on it, in the units of `position`.
    margin: f64,
}

impl MeshSurface {
    /// From a mesh in the caller's numbering. `margin` is a length.
    ///
    /// # Errors
    /// Same as [`decompose`](crate::body::decomposition::decompose).
    pub fn new(mesh: &PolygonMesh, margin: f64, progress: &mut Progress) -> Result<MeshSurface> {
        debug_assert!(margin >= 0.0);
        check_indices(mesh)?;
        let first = first_of_equal(&mesh.vertices, &mut progress.part(0.0, 0.3))?;
        let points = ExactPoints::new_in_steps(&mesh.vertices, &mut progress.part(0.3, 0.4))?;
        let (triangles, faces) = triangles_of(mesh, &first, &points, &mut progress.part(0.4, 0.8))?;
        let mut surface = MeshSurface {
            position: collected((0..points.len() as u32).map(|v| points.approximate(v)))?,
            margin: points.to_scaled(margin),
            across: across_edges(&triangles, &faces)?,
            is_solid: filled(false, triangles.len())?,
            points,
            triangles,
            faces,
        };
        if !(0..surface.triangles.len()).any(|t| surface.doubled_area(t) > 0.0) {
            return Err(Error::Mesh("no face of the mesh has an area".into()));
        }
        surface.find_inside(&mut progress.part(0.8, 1.0))?;
        Ok(surface)
    }

    /// The plane through three points.
    pub fn plane(&self, corners: [u32; 3]) -> CutPlane {
        let slack = if self.margin == 0.0 { 0.0 } else { self.margin * self.normal(corners).norm() };
        CutPlane { filtered: self.points.plane(corners), slack }
    }

    /// Positive above a plane, negative below, 0 on it. Exact where there is no margin.
    pub fn side(&self, plane: &CutPlane, v: u32) -> f64 {
        let height = self.points.height(&plane.filtered, v);
        if height.abs() <= plane.slack { 0.0 } else { height }
    }

    /// Twice the area, rounded; 0 where it underflows.
    pub fn doubled_area(&self, t: usize) -> f64 {
        self.normal(self.triangles[t]).norm()
    }

    /// As long as twice the area, rounded.
    pub fn normal(&self, corners: [u32; 3]) -> Vector {
        let [a, b, c] = corners.map(|v| self.position[v as usize]);
        (b - a).cross(&(c - a))
    }

    /// How close points count as equal to what they are on.
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Finds the parts of the surface that hold a volume. If some hold a negative one and none a positive one, all is turned: the
    /// mesh is inside out. Beside bodies, a negative part is a cavity, or inside out by mistake.
    fn find_inside(&mut self, progress: &mut Progress) -> Result<()> {
        let mut signs = filled(0.0, self.triangles.len())?;
        let mut part_of = filled(NONE, self.triangles.len())?;
        let (mut open, mut part) = (Vec::new(), Vec::new());
        for first in 0..self.triangles.len() as u32 {
            if part_of[first as usize] != NONE {
                continue;
            }
            part.clear();
            part_of[first as usize] = first;
            push(&mut open, first)?;
            let mut is_closed = true;
            while let Some(t) = open.pop() {
                progress.step(part.len(), self.triangles.len())?;
                push(&mut part, t)?;
                for next in self.across[t as usize] {
                    if next == NONE {
                        is_closed = false;
                    } else if part_of[next as usize] == NONE {
                        part_of[next as usize] = first;
                        push(&mut open, next)?;
                    }
                }
            }
            let sign = if is_closed { self.sign_of_volume(&part) } else { 0.0 };
            part.iter().for_each(|t| signs[*t as usize] = sign);
        }
        let is_inside_out = signs.contains(&-1.0) && !signs.contains(&1.0);
        if is_inside_out {
            self.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
            // The edges from corner 0 to 1, 1 to 2 and 2 to 0 were the last, the second and the first.
            self.across.iter_mut().for_each(|across| across.swap(0, 2));
        }
        let inside = if is_inside_out { -1.0 } else { 1.0 };
        self.is_solid = collected(signs.iter().map(|sign| *sign == inside))?;
        Ok(())
    }

    /// 1, −1, or 0 where rounding might have made the sign.
    fn sign_of_volume(&self, part: &[u32]) -> f64 {
        debug_assert!(!part.is_empty());
        let origin = self.position[self.triangles[part[0] as usize][0] as usize];
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for t in part {
            let [a, b, c] = self.triangles[*t as usize].map(|v| self.position[v as usize] - origin);
            sum += a.dot(&b.cross(&c));
            // There are six products of three entries, each below the product of the largest ones.
            magnitude += 6.0 * a.amax() * b.amax() * c.amax();
        }
        // The differences and products of a term are off by 8u of its magnitude, the sum by u of all for each term.
        let bound = (part.len() as f64 + 8.0) * UNIT_ROUNDOFF * magnitude;
        if sum.abs() > bound { sum.signum() } else { 0.0 }
    }
}

/// The triangles of all faces, and the face of each.
pub fn triangles_of(
    mesh: &PolygonMesh,
    first: &[u32],
    points: &ExactPoints,
    progress: &mut Progress,
) -> Result<(Vec<[u32; 3]>, Vec<u32>)> {
    debug_assert_eq!(first.len(), mesh.vertices.len());
    let (mut triangles, mut faces) = (with_capacity(mesh.face_count())?, with_capacity(mesh.face_count())?);
    let mut polygon = Vec::new();
    for f in 0..mesh.face_count() {
        progress.steps(mesh.face(f).len(), f, mesh.face_count())?;
        polygon.clear();
        extend(&mut polygon, mesh.face(f).iter().map(|v| first[*v as usize]))?;
        polygon.dedup();
        while polygon.len() > 1 && polygon.first() == polygon.last() {
            polygon.pop();
        }
        // The rest of a face whose corners are equal: its neighbours meet each other there.
        if polygon.len() < 3 {
            continue;
        }
        if !triangulate(points, &mut polygon, &mut triangles)? {
            return Err(Error::Mesh(format!(
                "face {f} crosses itself, or is far from flat: it cannot be cut into triangles"
            )));
        }
        let added = triangles.len() - faces.len();
        extend(&mut faces, std::iter::repeat_n(f as u32, added))?;
    }
    Ok((triangles, faces))
}

/// The triangles across the edges of each.
fn across_edges(triangles: &[[u32; 3]], faces: &[u32]) -> Result<Vec<[u32; 3]>> {
    debug_assert_eq!(faces.len(), triangles.len());
    let edge = |e: u32| {
        let corners = triangles[e as usize / 3];
        (corners[e as usize % 3], corners[(e as usize + 1) % 3])
    };
    let ends = |e: u32| {
        let (tail, head) = edge(e);
        (tail.min(head), tail.max(head))
    };
    let mut sorted: Vec<u32> = collected(0..3 * triangles.len() as u32)?;
    sorted.sort_unstable_by_key(|e| (ends(*e), *e));
    let mut across = filled([NONE; 3], triangles.len())?;
    let face = |e: u32| faces[e as usize / 3];
    let mut join = |a: u32, b: u32| {
        across[a as usize / 3][a as usize % 3] = b / 3;
        across[b as usize / 3][b as usize % 3] = a / 3;
    };
    let mut between_faces = Vec::new();
    for uses in sorted.chunk_by(|a, b| ends(*a) == ends(*b)) {
        // A cut through a face is no edge of the mesh: two faces over the same corners may be cut alike.
        between_faces.clear();
        for of_face in uses.chunk_by(|a, b| face(*a) == face(*b)) {
            match *of_face {
                [a, b] if edge(a) != edge(b) => join(a, b),
                _ => extend(&mut between_faces, of_face.iter().copied())?,
            }
        }
        match between_faces[..] {
            [] | [_] => {}
            [a, b] if edge(a) != edge(b) => join(a, b),
            [a, b, ..] => {
                let ((low, high), [face, other]) = (ends(a), [a, b].map(face));
                let fault = match between_faces.len() {
                    2 => format!("runs in the same direction in face {other}: the faces are not consistently oriented"),
                    count => format!("belongs to {count} faces, also to face {other}"),
                };
                return Err(Error::Mesh(format!("face {face}: edge {low}-{high} {fault}")));
            }
        }
    }
    Ok(across)
}
