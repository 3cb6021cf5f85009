//! Does the caller's mesh keep its contract: closed, 2-manifold, oriented, connected, convex? Or a message naming the face, edge
//! or vertex where it is not.

mod violation;
mod duplicates;
mod edges;
mod convexity;
mod proof;

use crate::base::error::Result;
use crate::base::memory::{collected, filled, listed, push, with_capacity};
use crate::base::progress::Progress;
use crate::body::build::hull::convex_hull_in_steps;
use crate::body::mesh::{PolygonMesh, check_vertex};
use convexity::{CheckedSide, most_inward};
pub use convexity::{check_convexity, is_inside_out};
pub(crate) use duplicates::first_of_equal;
use edges::{Matching, match_edges};
pub use proof::{check_hull, check_hull_in_steps};
use violation::violation;
pub use violation::{FLAT_HINT, HULL_HINT};

/// Checks a mesh in the caller's numbering against the contract of `docs/conventions.md`. `tolerance` is the
/// largest distance that a vertex may lie outside a face's plane, in the mesh's units; `allow_flat`
/// admits bodies without interior.
///
/// # Errors
/// The first violation found, naming the face, edge or vertex.
pub fn check_mesh(mesh: &PolygonMesh, tolerance: f64, allow_flat: bool) -> Result<()> {
    check_mesh_in_steps(mesh, tolerance, allow_flat, &mut Progress::new(&mut |_| true))
}

/// Same as [`check_mesh`], with progress reports.
///
/// # Errors
/// Same as [`check_mesh`]; [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
pub fn check_mesh_in_steps(
    mesh: &PolygonMesh,
    tolerance: f64,
    allow_flat: bool,
    progress: &mut Progress,
) -> Result<()> {
    check_surface(mesh, &mut progress.part(0.0, 0.3))?;
    let hull = convex_hull_in_steps(&mesh.vertices, &mut progress.part(0.3, 0.7))?;
    check_convexity(mesh, &hull, tolerance, allow_flat, &mut progress.part(0.7, 1.0))
}

/// The part of [`check_mesh`] that looks at no coordinates, except that exactly equal vertices
/// count as one, and for a message: indices in range, every vertex used, every face with three vertices or more and
/// none twice, every edge in two faces and in opposite directions, the faces around every vertex
/// one fan, the surface connected and of genus 0.
///
/// # Errors
/// The first violation found, naming the face, edge or vertex; [`crate::base::error::Error::Cancelled`] when the caller does not
/// want to go on.
pub fn check_surface(mesh: &PolygonMesh, progress: &mut Progress) -> Result<()> {
    check_indices(mesh)?;
    let corners = MergedCorners::new(mesh, &mut progress.part(0.0, 0.3))?;
    corners.check_faces(&mut progress.part(0.3, 0.4))?;
    if let Some(v) = corners.unused_vertex()? {
        return violation(format!("vertex {v} belongs to no face"));
    }
    let twins = corners.match_edges(&mut progress.part(0.4, 0.7))?;
    corners.check_fans(&twins, &mut progress.part(0.7, 0.85))?;
    corners.check_connected(&twins, &mut progress.part(0.85, 0.95))?;
    corners.check_genus(&twins, mesh, &mut progress.part(0.95, 1.0))
}

/// The first vertex that belongs to no face, if there is one: the hull of all vertices reaches to it, whether or not the surface
/// does.
///
/// # Errors
/// Same as [`check_surface`], for faults of the indices alone.
pub fn vertex_of_no_face(mesh: &PolygonMesh, progress: &mut Progress) -> Result<Option<usize>> {
    check_indices(mesh)?;
    MergedCorners::new(mesh, progress)?.unused_vertex()
}

/// Keeps the other checks from failing on indices: [`PolygonMesh`] has public fields.
pub(crate) fn check_indices(mesh: &PolygonMesh) -> Result<()> {
    let count = mesh.vertices.len();
    if count == 0 || mesh.face_count() == 0 {
        return violation(format!("the mesh has no {}", if count == 0 { "vertices" } else { "faces" }));
    }
    if !mesh.divides_indices() {
        return violation("the faces' starts do not divide the index array".into());
    }
    for f in 0..mesh.face_count() {
        if let Some((i, v)) = mesh.face(f).iter().enumerate().find(|(_, v)| **v as usize >= count) {
            return violation(format!("face {f}: corner {i} is vertex {v}, there are {count} vertices"));
        }
    }
    mesh.vertices.iter().enumerate().try_for_each(|(v, vertex)| check_vertex(v, vertex))
}

/// The faces over merged vertices: exactly equal ones are replaced by the first, and a vertex that
/// thus follows itself in a face is left out once. A corner of a face stands for the directed edge
/// to the next corner.
struct MergedCorners {
    /// For every vertex of the mesh the first one that equals it.
    first: Vec<u32>,
    /// The (first equal) vertex of each corner, face by face.
    vertex: Vec<u32>,
    /// The same as the caller numbers it.
    given: Vec<u32>,
    /// The face of each corner.
    face: Vec<u32>,
    /// Start of each face's corners; one more entry than faces.
    starts: Vec<u32>,
}

impl MergedCorners {
    fn new(mesh: &PolygonMesh, progress: &mut Progress) -> Result<MergedCorners> {
        let mut corners = MergedCorners {
            first: first_of_equal(&mesh.vertices, &mut progress.part(0.0, 0.5))?,
            vertex: with_capacity(mesh.indices.len())?,
            given: with_capacity(mesh.indices.len())?,
            face: with_capacity(mesh.indices.len())?,
            starts: with_capacity(mesh.face_count() + 1)?,
        };
        corners.starts.push(0);
        let progress = &mut progress.part(0.5, 1.0);
        for f in 0..mesh.face_count() {
            let polygon = mesh.face(f);
            for (i, &v) in polygon.iter().enumerate() {
                progress.step(f, mesh.face_count())?;
                let vertex = corners.first[v as usize];
                let next = corners.first[polygon[(i + 1) % polygon.len()] as usize];
                if vertex != next {
                    corners.vertex.push(vertex);
                    corners.given.push(v);
                    corners.face.push(f as u32);
                }
            }
            corners.starts.push(corners.vertex.len() as u32);
        }
        Ok(corners)
    }

    fn next(&self, corner: u32) -> u32 {
        let f = self.face[corner as usize] as usize;
        if corner + 1 == self.starts[f + 1] { self.starts[f] } else { corner + 1 }
    }

    fn previous(&self, corner: u32) -> u32 {
        let f = self.face[corner as usize] as usize;
        if corner == self.starts[f] { self.starts[f + 1] - 1 } else { corner - 1 }
    }

    /// At least three vertices in each face, none of them twice.
    fn check_faces(&self, progress: &mut Progress) -> Result<()> {
        // The last face that each vertex was seen in.
        let mut seen_in = filled(u32::MAX, self.first.len())?;
        for (f, range) in self.starts.windows(2).enumerate() {
            let mut distinct = 0;
            let mut repeated = None;
            for corner in range[0] as usize..range[1] as usize {
                progress.step(corner, self.vertex.len())?;
                let last = &mut seen_in[self.vertex[corner] as usize];
                if *last == f as u32 {
                    repeated = repeated.or(Some(self.given[corner]));
                } else {
                    *last = f as u32;
                    distinct += 1;
                }
            }
            if distinct < 3 {
                return violation(format!("face {f} is degenerate: it has fewer than three distinct vertices"));
            }
            if let Some(v) = repeated {
                return violation(format!("face {f} passes through vertex {v} more than once"));
            }
        }
        Ok(())
    }

    /// The first vertex that no face has, nor one exactly equal to it.
    fn unused_vertex(&self) -> Result<Option<usize>> {
        let mut used = filled(false, self.first.len())?;
        for &v in &self.vertex {
            used[v as usize] = true;
        }
        Ok(self.first.iter().position(|&v| !used[v as usize]))
    }

    /// The corner across the edge of each corner.
    fn match_edges(&self, progress: &mut Progress) -> Result<Vec<u32>> {
        let head = |corner: u32| self.vertex[self.next(corner) as usize];
        let edge = |c: u32| (self.vertex[c as usize], head(c));
        let edges: Vec<(u32, u32)> = collected((0..self.vertex.len() as u32).map(edge))?;
        let uses = match match_edges(self.first.len(), &edges, progress)? {
            Matching::Twins(twins) => return Ok(twins),
            Matching::Fault(uses) => uses,
        };
        let face = self.face[uses[0] as usize];
        let ends = [uses[0], self.next(uses[0])].map(|c| self.given[c as usize]);
        let (tail, head) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let faces: Vec<String> = uses.iter().take(10).map(|c| self.face[*c as usize].to_string()).collect();
        match uses.len() {
            1 => violation(format!("face {face}: edge {tail}-{head} belongs to no other face")),
            2 => violation(format!(
                "face {face}: edge {tail}-{head} runs in the same direction in face {}: \
                 the faces are not consistently oriented",
                faces[1]
            )),
            count => {
                let more = if count > 10 { ", ..." } else { "" };
                violation(format!(
                    "face {face}: edge {tail}-{head} belongs to {count} faces ({}{more})",
                    faces.join(", ")
                ))
            }
        }
    }

    /// The faces around every vertex follow each other across edges in one cycle.
    fn check_fans(&self, twins: &[u32], progress: &mut Progress) -> Result<()> {
        let mut visited = filled(false, self.vertex.len())?;
        // A face of the fan found at each vertex.
        let mut fan = filled(None, self.first.len())?;
        for start in 0..self.vertex.len() as u32 {
            if visited[start as usize] {
                continue;
            }
            let (v, face) = (self.vertex[start as usize], self.face[start as usize]);
            if let Some(other) = fan[v as usize].replace(face) {
                return violation(format!(
                    "vertex {v}: its faces form more than one fan (face {face} is not in that of face {other})"
                ));
            }
            let mut corner = start;
            while !visited[corner as usize] {
                progress.step(start as usize, self.vertex.len())?;
                visited[corner as usize] = true;
                corner = twins[self.previous(corner) as usize];
            }
        }
        Ok(())
    }

    /// Every face can be reached from the first one across edges.
    fn check_connected(&self, twins: &[u32], progress: &mut Progress) -> Result<()> {
        let mut reached = filled(false, self.starts.len() - 1)?;
        reached[0] = true;
        let mut stack = listed([0_u32]);
        let mut done = 0;
        while let Some(f) = stack.pop() {
            for corner in self.starts[f as usize]..self.starts[f as usize + 1] {
                progress.step(done, self.vertex.len())?;
                done += 1;
                let across = self.face[twins[corner as usize] as usize];
                if !std::mem::replace(&mut reached[across as usize], true) {
                    push(&mut stack, across)?;
                }
            }
        }
        match reached.iter().position(|r| !r) {
            Some(f) => violation(format!("face {f} is not connected with face 0 across edges")),
            None => Ok(()),
        }
    }

    /// Euler's formula. Where it fails no single face is at fault; but somewhere such a surface bends inward or winds about itself
    /// (Gauss & Bonnet): the edge where it bends most is named.
    fn check_genus(&self, twins: &[u32], mesh: &PolygonMesh, progress: &mut Progress) -> Result<()> {
        let mut used = filled(false, self.first.len())?;
        self.vertex.iter().for_each(|v| used[*v as usize] = true);
        let vertices = used.into_iter().filter(|used| *used).count();
        let (v, e, f) = (vertices as i64, twins.len() as i64 / 2, self.starts.len() as i64 - 1);
        if v - e + f == 2 {
            return Ok(());
        }
        let side = |(corner, twin): (u32, &u32)| {
            let ends = [corner, self.next(corner)].map(|c| self.given[c as usize]);
            CheckedSide { faces: [corner, *twin].map(|c| self.face[c as usize]), ends }
        };
        let bend = match most_inward(mesh, (0..).zip(twins).map(side), progress)? {
            Some(CheckedSide { faces: [face, across], ends: [tail, head] }) => {
                let (low, high) = (tail.min(head), tail.max(head));
                format!("; at edge {low}-{high} face {across} bends out of the plane of face {face}")
            }
            None => String::new(),
        };
        violation(format!("the surface has holes: {v} vertices - {e} edges + {f} faces = {}, not 2{bend}", v - e + f))
    }
}
