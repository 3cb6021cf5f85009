//! The triangulated hull as half-edges: half-edge 3t + k runs from corner k of triangle t to the next one
//! counter-clockwise.

use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::{copied, filled};
use crate::base::progress::Progress;

/// A closed triangulated surface and the half-edges out of each vertex.
#[derive(Debug, Clone)]
pub struct Triangulation {
    /// Corners, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The opposite half-edge of each half-edge.
    pub twins: Vec<u32>,
    /// The half-edges out of vertex v, counter-clockwise from outside:
    /// `outgoing[outgoing_starts[v]..outgoing_starts[v + 1]]`.
    outgoing: Vec<u32>,
    outgoing_starts: Vec<u32>,
}

/// The following half-edge in the same triangle.
#[inline]
pub fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 { half_edge - 2 } else { half_edge + 1 }
}

/// The preceding half-edge in the same triangle.
#[inline]
pub fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) { half_edge + 2 } else { half_edge - 1 }
}

impl Triangulation {
    /// Joins the triangles of a hull over vertices 0..`vertex_count`. In a flat hull every diagonal occurs once on each side;
    /// `normals`, one per triangle, tell the sides apart.
    ///
    /// # Errors
    /// [`Error::Bug`] when the triangles are no closed surface or leave a vertex out.
    pub fn new(triangles: Vec<[u32; 3]>, normals: &[Vector], vertex_count: usize) -> Result<Triangulation> {
        Triangulation::new_in_steps(triangles, normals, vertex_count, &mut Progress::new(&mut |_| true))
    }

    /// Same as [`Triangulation::new`], with progress reports.
    ///
    /// # Errors
    /// Same as [`Triangulation::new`]; [`Error::Cancelled`] when the caller does not want to go on.
    pub fn new_in_steps(
        triangles: Vec<[u32; 3]>,
        normals: &[Vector],
        vertex_count: usize,
        progress: &mut Progress,
    ) -> Result<Triangulation> {
        debug_assert_eq!(normals.len(), triangles.len());
        debug_assert!(triangles.as_flattened().iter().all(|v| (*v as usize) < vertex_count));
        let half_edge_count = 3 * triangles.len();
        let mut outgoing_starts = filled(0_u32, vertex_count + 1)?;
        for &corner in triangles.iter().flatten() {
            outgoing_starts[corner as usize + 1] += 1;
        }
        for v in 0..vertex_count {
            outgoing_starts[v + 1] += outgoing_starts[v];
        }
        let mut outgoing = filled(0_u32, half_edge_count)?;
        let mut fill = copied(&outgoing_starts)?;
        let all = 3 * half_edge_count;
        for (h, &corner) in triangles.iter().flatten().enumerate() {
            progress.step(h, all)?;
            let slot = &mut fill[corner as usize];
            outgoing[*slot as usize] = h as u32;
            *slot += 1;
        }

        let mut surface =
            Triangulation { triangles, twins: filled(u32::MAX, half_edge_count)?, outgoing, outgoing_starts };
        for h in 0..half_edge_count as u32 {
            progress.step(half_edge_count + h as usize, all)?;
            if surface.twins[h as usize] == u32::MAX {
                let twin = surface.find_twin(h, normals).ok_or_else(|| open_surface(&surface, h))?;
                surface.twins[h as usize] = twin;
                surface.twins[twin as usize] = h;
            }
        }
        surface.sort_around_vertices(&mut progress.part(2.0 / 3.0, 1.0))?;
        Ok(surface)
    }

    /// The half-edges out of vertex `v`, counter-clockwise from outside.
    #[inline]
    pub fn around(&self, v: u32) -> &[u32] {
        let v = v as usize;
        &self.outgoing[self.outgoing_starts[v] as usize..self.outgoing_starts[v + 1] as usize]
    }

    /// Start of a half-edge.
    #[inline]
    pub fn tail(&self, half_edge: u32) -> u32 {
        self.triangles[half_edge as usize / 3][half_edge as usize % 3]
    }

    /// End of a half-edge.
    #[inline]
    pub fn head(&self, half_edge: u32) -> u32 {
        self.tail(next(half_edge))
    }

    /// A free half-edge opposite to `h`, on the same side of a flat hull if there is one. Looked for at the end of lower
    /// valence, so that a fan of n triangles costs n steps and not n².
    fn find_twin(&self, h: u32, normals: &[Vector]) -> Option<u32> {
        debug_assert!(self.twins[h as usize] == u32::MAX);
        let (tail, head) = (self.tail(h), self.head(h));
        let from_head = self.around(head).len() <= self.around(tail).len();
        let candidates = if from_head { self.around(head) } else { self.around(tail) };
        let mut found = None;
        for &out in candidates {
            let candidate = if from_head { out } else { previous(out) };
            let opposite = self.tail(candidate) == head && self.head(candidate) == tail;
            if opposite && self.twins[candidate as usize] == u32::MAX {
                if normals[h as usize / 3].dot(&normals[candidate as usize / 3]) > 0.0 {
                    return Some(candidate);
                }
                found = Some(candidate);
            }
        }
        found
    }

    /// Puts the half-edges out of each vertex into counter-clockwise order.
    fn sort_around_vertices(&mut self, progress: &mut Progress) -> Result<()> {
        debug_assert!((0..).zip(&self.twins).all(|(h, twin)| self.twins[*twin as usize] == h));
        for v in 0..self.outgoing_starts.len() - 1 {
            let range = self.outgoing_starts[v] as usize..self.outgoing_starts[v + 1] as usize;
            let Some(&first) = self.outgoing.get(range.start).filter(|_| !range.is_empty()) else {
                return Err(Error::Bug(format!("hull vertex {v} belongs to no triangle")));
            };
            let mut h = first;
            progress.steps(range.len(), range.start, self.outgoing.len())?;
            for slot in range {
                self.outgoing[slot] = h;
                h = self.twins[previous(h) as usize];
            }
            if h != first {
                return Err(Error::Bug(format!("the hull pinches at vertex {v}")));
            }
        }
        Ok(())
    }
}

fn open_surface(surface: &Triangulation, h: u32) -> Error {
    let (tail, head) = (surface.tail(h), surface.head(h));
    Error::Bug(format!("the hull is open at the edge from vertex {tail} to vertex {head}"))
}
