//! How far a mesh is from the boundary of its own convex hull.

use std::cell::OnceCell;
use std::collections::HashSet;

use super::edges::{Matching, match_edges};
use super::violation::{FLAT_HINT, HULL_HINT, violation};
use crate::base::error::{Error, Result};
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, copied, filled, lacking, listed};
use crate::base::normal::{area_vector, normal_of, unit};
use crate::base::predicates::ExactPoints;
use crate::base::progress::Progress;
use crate::body::build::hull::Hull;
use crate::body::mesh::PolygonMesh;

/// In units of the largest coordinate: bounds the rounding of a distance from a plane as computed
/// here (a point relative to an origin: u; a unit normal: relatively 6u, times distances below 4; a
/// scalar product: 3u).
const ROUNDING: f64 = 64.0 * UNIT_ROUNDOFF;

/// A tolerance of this in scaled units, twice the size, allows everything; an infinite one times an area that underflows is NaN.
const WHOLE: f64 = 8.0;

/// How many supporting planes are tried for a face whose own is not good enough. A hull that is
/// flat up to rounding somewhere may have dozens of triangles too narrow for a normal next to each
/// other there.
const MOST_PLANES: usize = 100;

/// The part of [`super::check_mesh`] that looks at coordinates, for a mesh that passed
/// [`super::check_surface`] and its exact hull (`convex_hull(&mesh.vertices)`): not flat unless
/// `allow_flat`, faces plane, convex, not inside out.
///
/// A face passes when all vertices of the mesh are at most `tolerance` (and the rounding of this
/// test, about 1e-14 of the largest coordinate) outside of its plane and its own as close to it on
/// either side. A tiny or narrow face has no reliable plane: a vertex misplaced by the tolerance
/// may tilt it by any angle. Therefore a face also passes when some supporting plane of the hull
/// has all of the face's vertices within the tolerance; it is tried first with the hull's triangles on the face's own corners, of
/// which a face of an exactly convex mesh is made up. Either way the whole face lies within the
/// tolerance of the hull's boundary: for a direction n, no point of the face is deeper inside the
/// hull than max n·hull − min n·face.
///
/// A surface all of whose faces lie at the hull's boundary may still be folded onto a part of it,
/// or wind about it more than once. Moving every vertex by the tolerance changes area and volume by
/// at most the tolerance times all edges' lengths, and all faces' areas; so area and volume must be
/// those of the hull up to twice that.
///
/// The distances come from hill climbing on the exact hull, O(√n) a face and usually less.
///
/// # Errors
/// The first violation found, naming the face and the vertex, or an edge; a tolerance that is negative
/// or not a number; [`Error::Cancelled`] when the caller does not want to go on.
pub fn check_convexity(
    mesh: &PolygonMesh,
    hull: &Hull,
    tolerance: f64,
    allow_flat: bool,
    progress: &mut Progress,
) -> Result<()> {
    if tolerance.is_nan() || tolerance < 0.0 {
        return Err(Error::Argument(format!("the convexity tolerance is {tolerance}")));
    }
    if hull.dimension < 3 && !allow_flat {
        let hint = if hull.dimension == 2 { FLAT_HINT } else { HULL_HINT };
        return violation(format!(
            "the mesh is flat: all vertices lie {}; {hint}",
            match hull.dimension {
                2 => format!(
                    "in the plane of vertices {}, {} and {}",
                    hull.triangles[0][0], hull.triangles[0][1], hull.triangles[0][2]
                ),
                1 => format!("on the line of vertices {} and {}", hull.vertices[0], hull.vertices[1]),
                _ => format!("on vertex {}", hull.vertices[0]),
            }
        ));
    }
    if hull.dimension < 2 {
        return Ok(());
    }
    let exact = ExactPoints::new(&mesh.vertices)?;
    let origin = exact.approximate(hull.vertices[0]);
    let position: Vec<Vector> = collected((0..exact.len() as u32).map(|v| exact.approximate(v) - origin))?;
    let boundary = Boundary::new(hull, &position, &mut progress.part(0.0, 0.2))?;
    let polygon = |f: usize| CheckedPolygon::new(mesh.face(f), &position);
    let surface = SurfaceMeasures::of((0..mesh.face_count()).map(polygon), &mut progress.part(0.2, 0.3))?;
    if hull.dimension == 3 && surface.is_inside_out() {
        return violation("the mesh is inside out: face 0 and all others run clockwise seen from outside".into());
    }
    let allowed = exact.to_scaled(tolerance).min(WHOLE) + ROUNDING;
    let mut search = boundary.search();
    let of_faces = &mut progress.part(0.3, 0.9);
    for f in 0..mesh.face_count() {
        of_faces.steps(mesh.face(f).len() + std::mem::take(&mut search.steps), f, mesh.face_count())?;
        if boundary.has_triangle_under(mesh.face(f), &exact, allowed) {
            continue;
        }
        let polygon = polygon(f);
        let Err(Outside { vertex, distance }) = polygon.check_plane(&position, &mut search, allowed) else {
            continue;
        };
        if polygon.is_near_boundary(&position, &mut search, allowed)? {
            continue;
        }
        if distance.is_infinite() {
            return violation(format!(
                "face {f} has no area and lies more than {tolerance:.3e} below the hull of the mesh"
            ));
        }
        let side = if polygon.corners.contains(&vertex) { "off" } else { "outside of" };
        return violation(format!(
            "face {f}: vertex {vertex} lies {:.3e} {side} its plane (allowed {tolerance:.3e})",
            exact.from_scaled(distance)
        ));
    }
    check_single_cover(mesh, &boundary, &surface, allowed, &mut progress.part(0.9, 1.0))
}

/// Whether all faces of a mesh that passed [`super::check_surface`] run clockwise seen from outside.
///
/// # Errors
/// [`Error::Memory`].
pub fn is_inside_out(mesh: &PolygonMesh, progress: &mut Progress) -> Result<bool> {
    let exact = ExactPoints::new(&mesh.vertices)?;
    let origin = exact.approximate(mesh.indices[0]);
    let position: Vec<Vector> = collected((0..exact.len() as u32).map(|v| exact.approximate(v) - origin))?;
    let polygon = |f: usize| CheckedPolygon::new(mesh.face(f), &position);
    Ok(SurfaceMeasures::of((0..mesh.face_count()).map(polygon), progress)?.is_inside_out())
}

/// A vertex farther from a plane than allowed.
struct Outside {
    vertex: u32,
    distance: f64,
}

/// A face with its measures.
struct CheckedPolygon<'a> {
    corners: &'a [u32],
    /// The mean of the corners.
    centre: Vector,
    /// ½ Σ vᵢ × vᵢ₊₁ (M. E. Newell, 1972): the normal, as long as the area.
    area: Vector,
    perimeter: f64,
}

impl<'a> CheckedPolygon<'a> {
    fn new(corners: &'a [u32], position: &[Vector]) -> CheckedPolygon<'a> {
        let at = |i: usize| position[corners[i % corners.len()] as usize];
        let (mut centre, mut area, mut perimeter) = (Vector::zeros(), Vector::zeros(), 0.0);
        for i in 0..corners.len() {
            centre += at(i);
            area += 0.5 * (at(i) - at(0)).cross(&(at(i + 1) - at(0)));
            perimeter += (at(i + 1) - at(i)).norm();
        }
        CheckedPolygon { corners, centre: centre / corners.len() as f64, area, perimeter }
    }

    /// All vertices of the mesh at most `allowed` outside of the face's plane, its own on either
    /// side.
    fn check_plane(
        &self,
        position: &[Vector],
        search: &mut ExtremeSearch,
        allowed: f64,
    ) -> std::result::Result<(), Outside> {
        // The area of a needle's side may be too small for its square.
        let normal = unit(&self.area);
        if normal == Vector::zeros() {
            return Err(Outside { vertex: self.corners[0], distance: f64::INFINITY });
        }
        let distance = |v: u32| normal.dot(&(position[v as usize] - self.centre));
        search.begin_at(self.corners);
        let own = self.corners.iter().map(|&v| Outside { vertex: v, distance: distance(v).abs() });
        let top = search.extreme_vertex(&normal);
        let outside = Outside { vertex: top, distance: distance(top) };
        own.chain([outside]).find(|o| o.distance > allowed).map_or(Ok(()), Err)
    }

    /// All corners at most `allowed` below some supporting plane of the hull. The planes of the
    /// hull's triangle over the face's centre and of those around it are tried: it alone may be as
    /// tiny as the face, and tilted likewise.
    fn is_near_boundary(&self, position: &[Vector], search: &mut ExtremeSearch, allowed: f64) -> Result<bool> {
        // At a tip of the hull all planes may be those of tiny triangles; but a face as small as
        // the tolerance that has a vertex of the hull is close enough wherever it lies.
        let boundary = search.boundary;
        let distance = |v: u32, w: u32| (position[v as usize] - position[w as usize]).norm();
        let reaches_all = |v: u32| self.corners.iter().all(|&w| distance(v, w) <= allowed);
        if self.corners.iter().any(|&v| boundary.valence(v) > 0 && reaches_all(v)) {
            return Ok(true);
        }
        let triangle = search.walk_to(&self.centre)?;
        Ok(search.boundary.around(triangle)?.into_iter().any(|t| {
            let normal = search.boundary.normal(t);
            if normal == Vector::zeros() {
                return false;
            }
            search.begin_at(&search.boundary.hull.triangles[t]);
            let top = position[search.extreme_vertex(&normal) as usize];
            self.corners.iter().all(|&v| normal.dot(&(top - position[v as usize])) <= allowed)
        }))
    }
}

/// An edge as it runs around one of its faces.
pub(super) struct CheckedSide {
    /// That face and the one across.
    pub(super) faces: [u32; 2],
    pub(super) ends: [u32; 2],
}

/// The side of a closed surface across which a face rises most steeply out of the plane of the other, the first of equals; `None`
/// if none does, rounding apart.
pub(super) fn most_inward(
    mesh: &PolygonMesh,
    sides: impl Iterator<Item = CheckedSide>,
    progress: &mut Progress,
) -> Result<Option<CheckedSide>> {
    let exact = ExactPoints::new(&mesh.vertices)?;
    let position: Vec<Vector> = collected((0..exact.len() as u32).map(|v| exact.approximate(v)))?;
    let polygon = |f: usize| CheckedPolygon::new(mesh.face(f), &position);
    // The faces may all run clockwise.
    let outward =
        SurfaceMeasures::of((0..mesh.face_count()).map(polygon), &mut progress.part(0.0, 0.2))?.volume.signum();
    let mut best = (ROUNDING, None);
    let progress = &mut progress.part(0.2, 1.0);
    for (done, side) in sides.enumerate() {
        let corners = side.faces.map(|f| mesh.face(f as usize).len());
        progress.steps(corners[0] + corners[1], done, mesh.indices.len())?;
        let [normal, across] = side.faces.map(|f| unit(&polygon(f as usize).area));
        let [tail, head] = side.ends.map(|v| position[v as usize]);
        // The sine of the angle between the faces: positive where they bend inward.
        let rise = outward * unit(&(head - tail)).dot(&across.cross(&normal));
        if rise > best.0 {
            best = (rise, Some(side));
        }
    }
    Ok(best.1)
}

/// Measures of a whole surface.
struct SurfaceMeasures {
    area: f64,
    /// Signed: positive when the faces run counter-clockwise seen from outside.
    volume: f64,
    /// The sum over all faces.
    perimeter: f64,
    /// The sum over all faces of the square of the perimeter times the number of corners.
    squares: f64,
    faces: usize,
}

impl SurfaceMeasures {
    fn of<'a>(
        polygons: impl ExactSizeIterator<Item = CheckedPolygon<'a>>,
        progress: &mut Progress,
    ) -> Result<SurfaceMeasures> {
        let mut sum = SurfaceMeasures { area: 0.0, volume: 0.0, perimeter: 0.0, squares: 0.0, faces: 0 };
        let all = polygons.len();
        for p in polygons {
            progress.steps(p.corners.len(), sum.faces, all)?;
            sum.area += p.area.norm();
            sum.volume += p.centre.dot(&p.area) / 3.0;
            sum.perimeter += p.perimeter;
            sum.squares += p.corners.len() as f64 * p.perimeter * p.perimeter;
            sum.faces += 1;
        }
        Ok(sum)
    }

    fn is_inside_out(&self) -> bool {
        self.volume < -self.volume_rounding()
    }

    /// Each face's term is at most its area times the size (below 4 in scaled units) over 3, the
    /// sum's rounding at most that of all times their number. The cross products that make the area
    /// of a long narrow face are off by 4u of the lengths' product, each below a quarter of the
    /// perimeter's square, not of the area.
    fn volume_rounding(&self) -> f64 {
        2.0 * UNIT_ROUNDOFF * ((self.faces as f64 + 16.0) * self.area + self.squares)
    }
}

/// The surface has the area and the volume of its hull.
fn check_single_cover(
    mesh: &PolygonMesh,
    boundary: &Boundary,
    surface: &SurfaceMeasures,
    allowed: f64,
    progress: &mut Progress,
) -> Result<()> {
    let position = boundary.position;
    let whole =
        SurfaceMeasures::of(boundary.hull.triangles.iter().map(|t| CheckedPolygon::new(t, position)), progress)?;
    let area_allowed = 2.0 * allowed * (surface.perimeter + whole.perimeter);
    let volume_allowed =
        2.0 * allowed * (surface.area + whole.area) + surface.volume_rounding() + whole.volume_rounding();
    let area_fits = (surface.area - whole.area).abs() <= area_allowed;
    let volume_fits = (surface.volume - whole.volume).abs() <= volume_allowed;
    if area_fits && volume_fits {
        return Ok(());
    }
    let mut sides: HashSet<(u32, u32)> = HashSet::new();
    let most = mesh.indices.len();
    sides.try_reserve(most).map_err(|e| lacking::<(u32, u32)>(most, &e))?;
    for f in 0..mesh.face_count() {
        let corners = mesh.face(f);
        for (i, &v) in corners.iter().enumerate() {
            let w = corners[(i + 1) % corners.len()];
            sides.insert((v.min(w), v.max(w)));
        }
    }
    let length = |e: &(u32, u32)| (position[e.1 as usize] - position[e.0 as usize]).norm();
    let missing = boundary.sharp_edges()?.filter(|e| !sides.contains(e));
    let gap = match missing.max_by(|d, e| length(d).total_cmp(&length(e))) {
        Some((v, w)) => format!("; the hull's edge {v}-{w} is no edge of the mesh"),
        None => String::new(),
    };
    violation(format!(
        "the mesh is not convex: it covers {:.6} times the area of its convex hull{gap}",
        surface.area / whole.area
    ))
}

/// The hull's boundary, for floating-point searches.
struct Boundary<'a> {
    hull: &'a Hull,
    position: &'a [Vector],
    /// The triangle across each of its edges, three each; empty for a flat hull. An exactly convex mesh never asks for it.
    across: OnceCell<Vec<u32>>,
    /// The neighbours of vertex v (an input index) are `neighbours[starts[v]..starts[v + 1]]`.
    neighbours: Vec<u32>,
    /// The triangle left of the edge to each of `neighbours`.
    beside: Vec<u32>,
    starts: Vec<u32>,
    /// A point inside.
    centre: Vector,
}

impl<'a> Boundary<'a> {
    fn new(hull: &'a Hull, position: &'a [Vector], progress: &mut Progress) -> Result<Boundary<'a>> {
        let edges = hull.edges()?;
        // In a hull of dimension 3 each directed edge occurs once; in a flat one twice, which does
        // no harm.
        let mut starts = filled(0_u32, position.len() + 1)?;
        for (done, &(tail, _)) in edges.iter().enumerate() {
            progress.step(done, 2 * edges.len())?;
            starts[tail as usize + 1] += 1;
        }
        for v in 0..position.len() {
            starts[v + 1] += starts[v];
        }
        let mut free = copied(&starts)?;
        let (mut neighbours, mut beside) = (filled(0, edges.len())?, filled(0, edges.len())?);
        for (corner, &(tail, head)) in edges.iter().enumerate() {
            progress.step(edges.len() + corner, 2 * edges.len())?;
            let place = free[tail as usize] as usize;
            (neighbours[place], beside[place]) = (head, corner as u32 / 3);
            free[tail as usize] += 1;
        }
        let centre = hull.vertices.iter().map(|v| position[*v as usize]).sum::<Vector>() / hull.vertices.len() as f64;
        Ok(Boundary { hull, position, across: OnceCell::new(), neighbours, beside, starts, centre })
    }

    fn across(&self) -> Result<&[u32]> {
        if self.across.get().is_none() && self.hull.dimension == 3 {
            let mut across =
                match match_edges(self.position.len(), &self.hull.edges()?, &mut Progress::new(&mut |_| true))? {
                    Matching::Twins(twins) => twins,
                    Matching::Fault(_) => Vec::new(),
                };
            across.iter_mut().for_each(|corner| *corner /= 3);
            let _ = self.across.set(across);
        }
        Ok(self.across.get().map_or(&[], Vec::as_slice))
    }

    /// Edges (lower vertex first) between triangles of clearly different planes, once each.
    fn sharp_edges(&self) -> Result<impl Iterator<Item = (u32, u32)>> {
        let across = self.across()?;
        let flat = self.hull.dimension == 2;
        let triangles = &self.hull.triangles;
        let rim_spokes = [0, triangles.len() / 2 - 1];
        Ok((0..3 * triangles.len()).filter_map(move |corner| {
            let (t, side) = (corner / 3, corner % 3);
            let (tail, head) = (triangles[t][side], triangles[t][(side + 1) % 3]);
            let sharp = if flat {
                // A fan: its middle sides, and the first and the last spoke, are the boundary.
                t < triangles.len() / 2
                    && (side == 1 || (side == 0 && t == rim_spokes[0]) || (side == 2 && t == rim_spokes[1]))
            } else {
                let other = across[corner] as usize;
                t < other && self.normal(t).dot(&self.normal(other)) < 0.999
            };
            sharp.then(|| (tail.min(head), tail.max(head)))
        }))
    }

    /// The unit normal of a triangle; zero if its corners are collinear up to rounding. In plain doubles that of a triangle a
    /// billion times as long as wide would be off by more than a tolerance of 1e-9.
    fn normal(&self, t: usize) -> Vector {
        let [a, b, c] = self.hull.triangles[t].map(|v| self.position[v as usize]);
        normal_of(&area_vector(&a, &b, &c), &a, &b, &c)
    }

    /// How many neighbours a vertex of the mesh has on the hull; 0 when it is no hull vertex.
    fn valence(&self, v: u32) -> u32 {
        self.starts[v as usize + 1] - self.starts[v as usize]
    }

    /// Whether the plane of one of the hull's triangles on a face's own corners, which supports the hull, has all of them within
    /// `allowed`.
    fn has_triangle_under(&self, corners: &[u32], exact: &ExactPoints, allowed: f64) -> bool {
        // Looked for at the corner where there are few.
        let on_hull = corners.iter().copied().filter(|&v| self.valence(v) > 0);
        let Some(v) = on_hull.min_by_key(|&v| self.valence(v)) else { return false };
        self.beside[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize].iter().any(|&t| {
            let triangle = self.hull.triangles[t as usize];
            let is_on_corners = triangle.iter().all(|w| corners.contains(w));
            let lies_under = || {
                let plane = exact.plane(triangle);
                corners.iter().all(|&w| exact.distance_bound(&plane, w) <= allowed)
            };
            is_on_corners && (corners.len() == 3 || lies_under())
        })
    }

    /// Triangle `start` and those nearest to it, counted in edges crossed; for a flat hull only `start`.
    fn around(&self, start: usize) -> Result<Vec<usize>> {
        let across = self.across()?;
        let mut found = listed([start]);
        let mut done = 0;
        while done < found.len() && found.len() < MOST_PLANES && !across.is_empty() {
            for next in &across[3 * found[done]..3 * found[done] + 3] {
                if !found.contains(&(*next as usize)) {
                    found.push(*next as usize);
                }
            }
            done += 1;
        }
        Ok(found)
    }

    fn largest_triangle(&self) -> usize {
        let area = |t: &usize| CheckedPolygon::new(&self.hull.triangles[*t], self.position).area.norm();
        (0..self.hull.triangles.len()).max_by(|s, t| area(s).total_cmp(&area(t))).unwrap_or(0)
    }

    fn search(&'a self) -> ExtremeSearch<'a> {
        ExtremeSearch { boundary: self, vertex: self.hull.vertices[0], triangle: None, steps: 0 }
    }
}

/// Searches that begin where the last one ended.
struct ExtremeSearch<'a> {
    boundary: &'a Boundary<'a>,
    vertex: u32,
    triangle: Option<usize>,
    /// Neighbours and triangles looked at.
    steps: usize,
}

impl ExtremeSearch<'_> {
    /// Begins the next climb at the vertex of fewest neighbours among those of `corners` that are
    /// hull vertices, if any: the last look around, at the top, costs as many tests as it has
    /// neighbours.
    fn begin_at(&mut self, corners: &[u32]) {
        let b = self.boundary;
        let on_hull = corners.iter().copied().filter(|&v| b.valence(v) > 0);
        self.vertex = on_hull.min_by_key(|&v| b.valence(v)).unwrap_or(self.vertex);
    }

    /// A hull vertex farthest in a direction, by hill climbing: on a convex polytope a local
    /// maximum is a global one. It does not climb by less than rounding errors, so it may end that
    /// much too low for each vertex on the way.
    fn extreme_vertex(&mut self, direction: &Vector) -> u32 {
        let b = self.boundary;
        let height = |v: u32| direction.dot(&b.position[v as usize]);
        let mut level = height(self.vertex);
        loop {
            let v = self.vertex as usize;
            self.steps += b.valence(self.vertex) as usize;
            let (mut best, mut top) = (self.vertex, level + ROUNDING);
            for &w in &b.neighbours[b.starts[v] as usize..b.starts[v + 1] as usize] {
                if height(w) > top {
                    (best, top) = (w, height(w));
                }
            }
            if best == self.vertex {
                return best;
            }
            (self.vertex, level) = (best, top);
        }
    }

    /// About the triangle that the ray from the centre through `p` meets, by a walk from the last one, or else from the largest. A
    /// walk that rounding leads in circles is cut short: it only steers. On a flat hull nothing happens.
    fn walk_to(&mut self, p: &Vector) -> Result<usize> {
        let b = self.boundary;
        let across = b.across()?;
        let mut triangle = self.triangle.unwrap_or_else(|| b.largest_triangle());
        let target = p - b.centre;
        let most_steps = if across.is_empty() { 0 } else { 64 + 4 * across.len().isqrt() };
        for _ in 0..most_steps {
            self.steps += 1;
            let corners = b.hull.triangles[triangle].map(|v| b.position[v as usize] - b.centre);
            let outside = |i: &usize| corners[*i].cross(&corners[(i + 1) % 3]).dot(&target) < 0.0;
            let Some(side) = (0..3).find(outside) else { break };
            triangle = across[3 * triangle + side] as usize;
        }
        self.triangle = Some(triangle);
        Ok(triangle)
    }
}
