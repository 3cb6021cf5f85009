//! A closed surface, oriented, in a frame where lengths are about 1.

use crate::base::error::{Error, Result};
use crate::base::math::{Vector, binary_order, power_of_two};
use crate::base::memory::{collected, extend, filled, push, with_capacity};
use crate::base::predicates::ExactPoints;
use crate::base::progress::Progress;
use crate::body::build::check::{check_indices, first_of_equal};
use crate::body::decomposition::surface::{NONE, triangles_of};
use crate::body::mesh::PolygonMesh;

/// The frame of the computation: the box's centre is the origin, and its diagonal is from 1 to 2 long.
#[derive(Debug, Clone, Copy)]
pub struct UnitFrame {
    centre: Vector,
    exponent: i32,
    /// The diagonal of the box.
    pub diagonal: f64,
}

impl UnitFrame {
    fn new(points: &[Vector]) -> UnitFrame {
        let start = [Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)];
        let [low, high] = points.iter().fold(start, |[low, high], p| [low.inf(p), high.sup(p)]);
        // Halves, so that no finite coordinate overflows.
        let half = 0.5 * high - 0.5 * low;
        let mut frame = UnitFrame { centre: 0.5 * high + 0.5 * low, exponent: 0, diagonal: 1.0 };
        if half.amax() > 0.0 {
            let order = binary_order(half.amax());
            frame.exponent = -order - 1;
            let scaled = half.map(|x| frame.scaled(x));
            frame.exponent -= binary_order(2.0 * scaled.norm());
            frame.diagonal = 2.0 * half.map(|x| frame.scaled(x)).norm();
        }
        frame
    }

    /// In two steps: the power of two itself may be no double.
    fn scaled(&self, x: f64) -> f64 {
        let half = self.exponent / 2;
        x * power_of_two(half) * power_of_two(self.exponent - half)
    }

    fn unit(&self, point: &Vector) -> Vector {
        (point - self.centre).map(|x| self.scaled(x))
    }

    /// A point of the caller's frame.
    pub fn original(&self, point: &Vector) -> Vector {
        let back = UnitFrame { exponent: -self.exponent, ..*self };
        point.map(|x| back.scaled(x)) + self.centre
    }
}

/// Less is rounding: lengths are about 1.
const LEAST_VOLUME: f64 = 1e-15;

/// An edge at which the surface is concave.
#[derive(Debug, Clone, Copy)]
pub struct ReflexEdge {
    pub ends: [Vector; 2],
    /// The outward normals of its two triangles.
    pub normals: [Vector; 2],
}

/// The triangles around a body: the points around which they wind. Triangles without area are left out.
pub struct SolidBoundary {
    pub frame: UnitFrame,
    pub triangles: Vec<[Vector; 3]>,
    pub reflex: Vec<ReflexEdge>,
}

/// The triangles over numbered vertices.
struct Sheets<'a> {
    triangles: Vec<[u32; 3]>,
    faces: Vec<u32>,
    points: &'a [Vector],
}

impl SolidBoundary {
    /// Turns faces that are oriented unlike their neighbours, the smaller area of each sheet.
    ///
    /// # Errors
    /// [`Error::Mesh`] for a mesh that has no inside, or whose inside its edges leave open.
    pub fn new(mesh: &PolygonMesh, progress: &mut Progress) -> Result<SolidBoundary> {
        check_indices(mesh)?;
        let frame = UnitFrame::new(&mesh.vertices);
        let points = collected(mesh.vertices.iter().map(|point| frame.unit(point)))?;
        let first = first_of_equal(&mesh.vertices, &mut progress.part(0.0, 0.3))?;
        let exact = ExactPoints::new_in_steps(&mesh.vertices, &mut progress.part(0.3, 0.4))?;
        let (triangles, faces) = triangles_of(mesh, &first, &exact, &mut progress.part(0.4, 1.0))?;
        let mut sheets = Sheets { triangles, faces, points: &points };
        let edges = sheets.edges()?;
        sheets.check_closed(&edges)?;
        sheets.orient(&edges)?;
        // Turned triangles have other numbers of edges.
        let edges = sheets.edges()?;
        sheets.check_balance(&edges)?;
        let mut surface =
            SolidBoundary { frame, triangles: with_capacity(sheets.triangles.len())?, reflex: Vec::new() };
        for corners in &sheets.triangles {
            let triangle = corners.map(|v| points[v as usize]);
            if area_vector(&triangle).norm() > 0.0 {
                push(&mut surface.triangles, triangle)?;
            }
        }
        if !(sheets.volume().abs() > LEAST_VOLUME) {
            return Err(Error::Mesh("the mesh encloses no volume".into()));
        }
        surface.reflex = sheets.reflex(&edges)?;
        Ok(surface)
    }
}

/// As long as the area.
pub fn area_vector([a, b, c]: &[Vector; 3]) -> Vector {
    0.5 * (b - a).cross(&(c - a))
}

impl Sheets<'_> {
    /// The tail and the head of the edge from corner `e % 3` of triangle `e / 3`.
    fn edge(&self, e: u32) -> (u32, u32) {
        let corners = self.triangles[e as usize / 3];
        (corners[e as usize % 3], corners[(e as usize + 1) % 3])
    }

    fn ends(&self, e: u32) -> (u32, u32) {
        let (tail, head) = self.edge(e);
        (tail.min(head), tail.max(head))
    }

    /// All edges of all triangles; those with the same ends are neighbours.
    fn edges(&self) -> Result<Vec<u32>> {
        let mut sorted: Vec<u32> = collected(0..3 * self.triangles.len() as u32)?;
        sorted.sort_unstable_by_key(|e| (self.ends(*e), *e));
        Ok(sorted)
    }

    fn check_closed(&self, edges: &[u32]) -> Result<()> {
        for uses in edges.chunk_by(|a, b| self.ends(*a) == self.ends(*b)) {
            if !uses.len().is_multiple_of(2) {
                let fault = match uses.len() {
                    1 => "has no face beyond it: the mesh is open; close the hole or take tolerance 0".into(),
                    count => format!("belongs to {count} faces, an odd number; remove inner walls or take tolerance 0"),
                };
                return Err(self.fault(uses[0], &fault));
            }
        }
        Ok(())
    }

    fn fault(&self, e: u32, fault: &str) -> Error {
        let (low, high) = self.ends(e);
        Error::Mesh(format!("face {}: edge {low}-{high} {fault}", self.faces[e as usize / 3]))
    }

    /// Makes each sheet (triangles joined by edges of two) run one way: as the larger part of its area does.
    fn orient(&mut self, edges: &[u32]) -> Result<()> {
        let mut across = filled([NONE; 3], self.triangles.len())?;
        for uses in edges.chunk_by(|a, b| self.ends(*a) == self.ends(*b)) {
            if let [a, b] = *uses {
                (across[a as usize / 3][a as usize % 3], across[b as usize / 3][b as usize % 3]) = (b, a);
            }
        }
        let mut turned = filled(None, self.triangles.len())?;
        let (mut open, mut sheet) = (Vec::new(), Vec::new());
        for seed in 0..self.triangles.len() as u32 {
            if turned[seed as usize].is_some() {
                continue;
            }
            turned[seed as usize] = Some(false);
            sheet.clear();
            push(&mut open, seed)?;
            let mut areas = [0.0; 2];
            while let Some(t) = open.pop() {
                push(&mut sheet, t)?;
                let own = turned[t as usize] == Some(true);
                areas[usize::from(own)] +=
                    area_vector(&self.triangles[t as usize].map(|v| self.points[v as usize])).norm();
                for (e, next) in (3 * t..).zip(across[t as usize]) {
                    if next == NONE {
                        continue;
                    }
                    let wanted = own ^ (self.edge(e) == self.edge(next));
                    match turned[next as usize / 3] {
                        None => {
                            turned[next as usize / 3] = Some(wanted);
                            push(&mut open, next / 3)?;
                        }
                        Some(found) if found != wanted => {
                            let fault = "joins faces whose two sides are one: the surface is one-sided; split it";
                            return Err(self.fault(next, fault));
                        }
                        Some(_) => {}
                    }
                }
            }
            let keeps_most = areas[0] >= areas[1];
            sheet.iter().for_each(|t| turned[*t as usize] = turned[*t as usize].map(|turned| turned == keeps_most));
        }
        let faulty = (0..).zip(&turned).filter(|(_, turned)| **turned == Some(true)).map(|(t, _): (usize, _)| t);
        faulty.for_each(|t| self.triangles[t].swap(0, 1));
        if self.volume() < 0.0 {
            self.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
        }
        Ok(())
    }

    /// Around each edge as many triangles run one way as the other: the number of windings is whole.
    fn check_balance(&self, edges: &[u32]) -> Result<()> {
        for uses in edges.chunk_by(|a, b| self.ends(*a) == self.ends(*b)) {
            let forward = uses.iter().filter(|e| self.edge(**e).0 < self.edge(**e).1).count();
            if 2 * forward != uses.len() {
                let fault = format!(
                    "belongs to {} faces, {forward} of which run from {} to {}: inside and outside cannot be told; orient them",
                    uses.len(),
                    self.ends(uses[0]).0,
                    self.ends(uses[0]).1
                );
                return Err(self.fault(uses[0], &fault));
            }
        }
        Ok(())
    }

    fn volume(&self) -> f64 {
        let corners = |t: &[u32; 3]| t.map(|v| self.points[v as usize]);
        self.triangles.iter().map(corners).map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum()
    }

    /// The concave edges of two triangles.
    fn reflex(&self, edges: &[u32]) -> Result<Vec<ReflexEdge>> {
        let mut reflex = Vec::new();
        for uses in edges.chunk_by(|a, b| self.ends(*a) == self.ends(*b)) {
            for pair in uses.windows(2) {
                let corners = [0, 1].map(|i| self.triangles[pair[i] as usize / 3].map(|v| self.points[v as usize]));
                let normals = corners.map(|corners| area_vector(&corners).normalize());
                let place = pair[0] as usize % 3;
                let [tail, head, apex] = [0, 1, 2].map(|k| corners[0][(place + k) % 3]);
                let beyond = corners[1][(pair[1] as usize % 3 + 2) % 3];
                // Both apexes' heights: a flat edge of rounded corners is none.
                let rises = normals[0].dot(&(beyond - tail)) > 1e-6 * (beyond - tail).norm()
                    && normals[1].dot(&(apex - tail)) > 1e-6 * (apex - tail).norm();
                if rises {
                    extend(&mut reflex, [ReflexEdge { ends: [tail, head], normals }])?;
                }
            }
        }
        Ok(reflex)
    }
}
