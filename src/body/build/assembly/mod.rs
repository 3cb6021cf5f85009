//! Builds a [`Polyhedron`] from points and their exact hull: centres the points, orders them for locality, merges faces, bounds how
//! far each plane misses the exact hull, and lays it all out.

mod layout;
mod scale;
mod triangle;

use crate::base::double_double::{WideVector, narrow};
use crate::base::error::Result;
use crate::base::locality::{in_order, sort_along_curve, sort_triangles};
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, copied, filled, push, reserve, with_capacity};
use crate::base::normal::{area_vector, normal_of};
use crate::base::progress::Progress;
use crate::body::build::fan::fan_of;
use crate::body::build::hull::{Hull, convex_hull};
use crate::body::build::labels::{ScaledPolygons, label_by_index, label_by_polygons};
use crate::body::build::mass::mass_properties;
use crate::body::build::merge::{MergedFaces, Triangles, merge_bound, merge_faces};
use crate::body::build::outlines::outlines_of;
use crate::body::build::slack::RiseBounds;
use crate::body::mesh::{Numbers, PolygonMesh};
use crate::body::polyhedron::lookup::Lookup;
use crate::body::polyhedron::outlines::Outlines;
use crate::body::polyhedron::polygon_search::PolygonSearch;
use crate::body::polyhedron::triangulation::Triangulation;
use crate::body::polyhedron::{ContactFaces, LARGEST, NONE, Polyhedron, SMALLEST};
use layout::{MergedHull, neighbours_of};
use scale::{factor_to_middle_scale, scale_back};
pub use triangle::{move_inner, move_outline};

/// The polyhedron of the exact convex hull of `points`. `polygons`, over the same points, gives the faces' labels; they lie on the
/// hull up to a tolerance ([`crate::body::build::check`]). The result depends on the arguments alone: same input, same arrays.
///
/// # Errors
/// No points, too many, or one that is not finite ([`convex_hull`]).
pub fn build(points: &[Vector], polygons: Option<&PolygonMesh>) -> Result<Polyhedron> {
    build_in_steps(points, convex_hull(points)?, polygons, None, &mut Progress::new(&mut |_| true))
}

/// Same as [`build`], for points whose exact hull is known, saying how far it is. `numbers` gives the labels of points and
/// polygons, if they are not their indices.
///
/// # Errors
/// [`crate::base::error::Error::Bug`] if `hull` is not the hull of the points; [`crate::base::error::Error::Cancelled`] when the
/// caller does not want to go on.
pub fn build_in_steps(
    points: &[Vector],
    mut hull: Hull,
    polygons: Option<&PolygonMesh>,
    numbers: Option<&Numbers>,
    progress: &mut Progress,
) -> Result<Polyhedron> {
    let centre = centre_of(points);
    // The sum with +0 turns −0 into 0.
    let centred: Vec<Vector> = collected(points.iter().map(|p| (p - centre).add_scalar(0.0)))?;
    sort_along_curve(&mut hull.vertices, &centred, &mut progress.part(0.0, 0.02))?;

    let factor = factor_to_middle_scale(&centred);
    let scaled: Vec<Vector> = collected(centred.iter().map(|p| p * factor))?;
    // At another scale the centre may be beyond the doubles.
    let about = if factor == 1.0 { centre } else { Vector::zeros() };
    let surface = HullSurface::new(&scaled, hull, &mut progress.part(0.02, 0.1))?;
    let mut polyhedron = surface.lay_out(about, &mut progress.part(0.1, 0.88))?;
    match polygons {
        Some(mesh) if polyhedron.dimension >= 2 && mesh.face_count() > 0 => {
            let near = numbers.map_or(f64::INFINITY, |numbers| numbers.near) * factor;
            let polygons = ScaledPolygons { mesh, points: &scaled, near };
            label_by_polygons(&mut polyhedron, &polygons, numbers, &mut progress.part(0.88, 0.97))?;
        }
        _ => label_by_index(&mut polyhedron)?,
    }
    if factor != 1.0 {
        scale_back(&mut polyhedron, &centred, centre, 1.0 / factor)?;
    }
    // Until here labels are indices of `points`.
    if let Some(Numbers { vertices, .. }) = numbers {
        polyhedron.vertex_labels.iter_mut().for_each(|label| *label = vertices[*label as usize]);
    }
    copy_labels_in_steps(&mut polyhedron, &mut progress.part(0.97, 1.0))?;
    let is_in_range = (SMALLEST..=LARGEST).contains(&polyhedron.radius);
    // A point has no size: all errors are in proportion to its distance.
    polyhedron.simple = centre == Vector::zeros() && (is_in_range || polyhedron.dimension == 0);
    polyhedron.fill_vertex_blocks()?;
    polyhedron.fan = fan_of(&polyhedron)?;
    polyhedron.outlines = outlines_of(&polyhedron)?;
    Ok(polyhedron)
}

/// The labels of a polyhedron's vertices and faces: the members of the same names of [`Polyhedron`].
#[derive(Debug, Clone, PartialEq)]
pub struct Labels {
    /// See [`Polyhedron::vertex_labels`].
    pub vertex_labels: Vec<u32>,
    /// See [`Polyhedron::face_labels`].
    pub face_labels: Vec<u32>,
    /// See [`Polyhedron::face_label_starts`].
    pub face_label_starts: Vec<u32>,
    /// See [`Polyhedron::polygon_corners`].
    pub polygon_corners: Vec<Vector>,
    /// See [`Polyhedron::polygon_starts`].
    pub polygon_starts: Vec<u32>,
}

impl Labels {
    /// Gives a polyhedron other labels. `false`, and nothing is changed, if they are not labels of such a polyhedron.
    ///
    /// # Errors
    /// [`crate::base::error::Error::Memory`].
    pub fn give_to(self, polyhedron: &mut Polyhedron) -> Result<bool> {
        let divide = |starts: &[u32], parts: usize, whole: usize| {
            starts.len() == parts + 1 && starts[0] == 0 && starts[parts] as usize == whole && starts.is_sorted()
        };
        let Labels { vertex_labels, face_labels, face_label_starts, polygon_corners, polygon_starts } = self;
        let every_face_has_one = face_label_starts.windows(2).all(|pair| pair[0] < pair[1]);
        // A polygon is only kept where it has to be found among several.
        let polygons = match polygon_starts.len() {
            0 => polygon_corners.is_empty(),
            _ => divide(&polygon_starts, face_labels.len(), polygon_corners.len()),
        };
        let fit = vertex_labels.len() == polyhedron.vertices.len()
            && are_distinct(&vertex_labels)?
            && divide(&face_label_starts, polyhedron.faces.len(), face_labels.len())
            && every_face_has_one
            && polygons
            && polygon_corners.iter().flat_map(|corner| corner.iter()).all(|x| x.is_finite());
        if fit {
            polyhedron.vertex_labels = vertex_labels;
            polyhedron.face_labels = face_labels;
            polyhedron.face_label_starts = face_label_starts;
            polyhedron.polygon_corners = polygon_corners;
            polyhedron.polygon_starts = polygon_starts;
            copy_labels(polyhedron);
        }
        Ok(fit)
    }
}

fn are_distinct(numbers: &[u32]) -> Result<bool> {
    let mut sorted = copied(numbers)?;
    sorted.sort_unstable();
    Ok(sorted.windows(2).all(|pair| pair[0] != pair[1]))
}

/// Puts the labels where an answer reads them together with the feature; to be called when they have changed.
pub fn copy_labels(polyhedron: &mut Polyhedron) {
    copy_labels_in_steps(polyhedron, &mut Progress::new(&mut |_| true)).expect("nobody cancels");
}

fn copy_labels_in_steps(polyhedron: &mut Polyhedron, progress: &mut Progress) -> Result<()> {
    let all = polyhedron.edges.len() + polyhedron.faces.len();
    for (done, edge) in polyhedron.edges.iter_mut().enumerate() {
        progress.step(done, all)?;
        edge.labels = [edge.tail(), edge.head()].map(|v| polyhedron.vertex_labels[v as usize]);
    }
    for face in 0..polyhedron.faces.len() {
        progress.step(polyhedron.edges.len() + face, all)?;
        let label = match *polyhedron.labels_of_face(face as u32) {
            [label] => label,
            _ => NONE,
        };
        polyhedron.faces[face].label = label;
    }
    Ok(())
}

/// The vector to subtract from all points: per axis the middle m of the range [m−h, m+h] if h ≤ |m|/3, else 0.
///
/// Then every x lies between 2m/3 and 4m/3 (up to rounding), well within [m/2, 2m] where x − m is exact (P. H. Sterbenz,
/// Floating-Point Computation, 1974).
fn centre_of(points: &[Vector]) -> Vector {
    Vector::from_fn(|axis, _| {
        let low = points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let high = points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        // Halves of odd subnormal numbers are rounded; a point is its own centre.
        let middle = if low == high { low } else { 0.5 * low + 0.5 * high };
        let half = (high - middle).max(middle - low);
        if middle.is_finite() && half <= middle.abs() / 3.0 { middle } else { 0.0 }
    })
}

/// The hull over its own vertices in their final order.
struct HullSurface {
    dimension: u8,
    positions: Vec<Vector>,
    labels: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Twice the triangles' area vectors.
    areas: Vec<WideVector>,
    normals: Vec<Vector>,
}

impl HullSurface {
    fn new(points: &[Vector], hull: Hull, progress: &mut Progress) -> Result<HullSurface> {
        let positions = in_order(points, &hull.vertices, &mut progress.part(0.0, 0.05))?;
        let mut index = filled(NONE, points.len())?;
        for (new, &old) in hull.vertices.iter().enumerate() {
            index[old as usize] = new as u32;
        }
        // Like the vertices in order of place, each triangle from its lowest vertex.
        let mut triangles: Vec<[u32; 3]> = with_capacity(hull.triangles.len())?;
        let of_triangles = &mut progress.part(0.05, 0.15);
        for t in &hull.triangles {
            of_triangles.step(triangles.len(), hull.triangles.len())?;
            triangles.push(t.map(|v| index[v as usize]));
        }
        sort_triangles(&mut triangles, positions.len(), &mut progress.part(0.15, 0.3))?;
        let corners = |t: &[u32; 3]| t.map(|v| positions[v as usize]);
        let (mut areas, mut normals) = (with_capacity(triangles.len())?, with_capacity(triangles.len())?);
        let progress = &mut progress.part(0.3, 1.0);
        for (done, [a, b, c]) in triangles.iter().map(corners).enumerate() {
            progress.step(done, triangles.len())?;
            let area = area_vector(&a, &b, &c);
            areas.push(area);
            normals.push(normal_of(&area, &a, &b, &c));
        }
        let (dimension, labels) = (hull.dimension, hull.vertices);
        Ok(HullSurface { dimension, positions, labels, triangles, areas, normals })
    }

    fn lay_out(self, centre: Vector, progress: &mut Progress) -> Result<Polyhedron> {
        progress.report(0.0)?;
        let longest = self.positions.iter().map(|p| p.norm()).fold(0.0, f64::max);
        // The norm is right to 3u.
        let radius = longest * (1.0 + 8.0 * UNIT_ROUNDOFF);
        let of_mass = &mut progress.part(0.0, 0.05);
        let mass =
            mass_properties(self.dimension, &self.positions, &self.triangles, &self.areas, of_mass)?.about(&centre);
        let mut polyhedron = Polyhedron {
            dimension: self.dimension,
            centre,
            radius,
            simple: false,
            vertices: Vec::new(),
            more_neighbours: Vec::new(),
            triangles: Vec::new(),
            face_of_triangle: Vec::new(),
            edges: Vec::new(),
            faces: Vec::new(),
            sides: Vec::new(),
            more_sides: Vec::new(),
            bevels: Vec::new(),
            flat_vertices: Vec::new(),
            vertex_labels: self.labels,
            face_labels: Vec::new(),
            face_label_starts: Vec::new(),
            polygon_corners: Vec::new(),
            polygon_starts: Vec::new(),
            polygon_search: PolygonSearch::new(),
            vertex_blocks: Vec::new(),
            rough_blocks: Vec::new(),
            fan: None,
            outlines: Outlines::default(),
            contact_faces: ContactFaces::default(),
            mass,
            lookup: Lookup::none(),
        };
        if self.dimension < 2 {
            let edge = if self.dimension == 1 { 0 } else { NONE };
            if self.dimension == 1 {
                push(&mut polyhedron.edges, layout::segment_edge(&self.positions))?;
            }
            // A segment's ends are each other's neighbours, a point is its own.
            for v in 0..self.positions.len() {
                let other = self.positions.len() - 1 - v;
                polyhedron.add_vertex(&self.positions, v as u32, &[(other as u32, edge)])?;
            }
            return Ok(polyhedron);
        }

        let sizes: Vec<f64> = collected(self.areas.iter().map(|a| narrow(a).norm()))?;
        let of_surface = &mut progress.part(0.05, 0.15);
        let surface = Triangulation::new_in_steps(self.triangles, &self.normals, self.positions.len(), of_surface)?;
        let bound = merge_bound(radius);
        let triangles =
            Triangles { surface: &surface, positions: &self.positions, normals: &self.normals, areas: &sizes };
        let of_merging = &mut progress.part(0.15, 0.3);
        let merged = merge_faces(&triangles, bound, of_merging)?;
        let mut rises = RiseBounds::new(&surface, &self.positions, radius)?;
        let slacks = face_slacks(&surface, &self.normals, &merged, &mut rises, &mut progress.part(0.3, 0.5))?;
        let hull = MergedHull { surface: &surface, positions: &self.positions, merged: &merged, slacks: &slacks };
        let of_edges = &mut progress.part(0.5, 0.7);
        let edge_of = polyhedron.add_edges(&hull, &mut rises, of_edges)?;
        let of_faces = &mut progress.part(0.7, 0.8);
        polyhedron.add_faces(&hull, &edge_of, of_faces)?;
        let of_vertices = &mut progress.part(0.8, 0.9);
        reserve(&mut polyhedron.vertices, self.positions.len())?;
        for v in 0..self.positions.len() as u32 {
            of_vertices.steps(surface.around(v).len(), v as usize, self.positions.len())?;
            polyhedron.add_vertex(&self.positions, v, &neighbours_of(&surface, &edge_of, v, self.dimension == 2)?)?;
        }
        polyhedron.triangles = surface.triangles;
        polyhedron.face_of_triangle = merged.face_of;
        polyhedron.find_flat_vertices(&mut progress.part(0.9, 1.0))?;
        Ok(polyhedron)
    }
}

/// Neighbours of vertices that a search for a face of one triangle may look at; most look at twenty.
const SEARCH_EFFORT: usize = 128;

/// σ of each face: over the whole hull above, over all of the face's own vertices (flat ones included) below. `normals` are the
/// triangles'.
fn face_slacks(
    surface: &Triangulation,
    normals: &[Vector],
    merged: &MergedFaces,
    rises: &mut RiseBounds,
    progress: &mut Progress,
) -> Result<Vec<f64>> {
    let start = |face: usize| surface.tail(merged.first_half_edges[face]);
    let mut triangle_counts = filled(0_usize, merged.normals.len())?;
    merged.face_of.iter().for_each(|face| triangle_counts[*face as usize] += 1);
    let all = merged.normals.len() + surface.triangles.len();
    let mut searched: Vec<Option<f64>> = with_capacity(merged.normals.len())?;
    for (face, (normal, count)) in merged.normals.iter().zip(&triangle_counts).enumerate() {
        // Most look at twenty neighbours, as said above; a face of many triangles looks at some of each.
        progress.steps(16 + 8 * count, face, all)?;
        searched.push(rises.rise(normal, start(face), SEARCH_EFFORT + 16 * count));
    }
    let mut slacks: Vec<f64> = collected(searched.iter().map(|rise| rise.unwrap_or(f64::INFINITY)))?;
    let mut falls = filled(0.0_f64, slacks.len())?;
    for (t, (triangle, &face)) in surface.triangles.iter().zip(&merged.face_of).enumerate() {
        progress.steps(4, merged.normals.len() + t, all)?;
        let face = face as usize;
        let normal = &merged.normals[face];
        falls[face] = falls[face].max(rises.fall(normal, start(face), *triangle));
        if searched[face].is_none() {
            for h in 3 * t..3 * t + 3 {
                let beside = [t, surface.twins[h] as usize / 3].map(|t| &normals[t]);
                slacks[face] = slacks[face].min(rises.rise_beside(normal, start(face), h as u32, beside));
            }
        }
    }
    for (slack, fall) in slacks.iter_mut().zip(falls) {
        *slack = (*slack + fall) * (1.0 + 4.0 * UNIT_ROUNDOFF);
    }
    Ok(slacks)
}
