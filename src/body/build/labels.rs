//! Which of the caller's polygons lie on which merged face.

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashMap};
use std::ops::Range;

use crate::base::angles::around;
use crate::base::error::Result;
use crate::base::locality::places_of;
use crate::base::math::{Matrix, Vector};
use crate::base::memory::{collected, copied, extend, filled, lacking, push, reserve, with_capacity};
use crate::base::progress::Progress;
use crate::body::build::merge::merge_bound;
use crate::body::build::spread::{Polygon, Spread, is_within};
use crate::body::mesh::{Numbers, PolygonMesh};
use crate::body::polyhedron::{MergedFace, Polyhedron};

/// Corners of a polygon whose faces are candidates for it.
const MOST_CORNERS_TRIED: usize = 8;

/// Faces around a vertex beyond which only those that lie in a polygon's direction are candidates for it.
const MOST_FACES_TRIED: usize = 32;

/// The caller's polygons beside a hull.
pub struct ScaledPolygons<'a> {
    /// Their corners by index.
    pub mesh: &'a PolygonMesh,
    /// The vertices of the mesh, centred and scaled like the hull.
    pub points: &'a [Vector],
    /// How far off a face a polygon may be that is over it.
    pub near: f64,
}

/// Labels every face by its own index: for a hull of bare points.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub fn label_by_index(polyhedron: &mut Polyhedron) -> Result<()> {
    let face_count = polyhedron.faces.len() as u32;
    polyhedron.face_labels = collected(0..face_count)?;
    polyhedron.face_label_starts = collected(0..face_count + 1)?;
    Ok(())
}

/// Puts every polygon on the face it lies on, and gives a face that got none the label of a neighbour, or the one that is for
/// bare faces. `numbers` gives the labels of the mesh's faces, if they are not their indices.
///
/// Polygons lie on the hull up to the convexity tolerance, so some of their vertices may not be hull vertices, or by an ulp only
/// of the face beyond an edge. The candidates for a polygon are the faces around its hull vertices, or, where it has none,
/// around the hull's support in its normal's direction. Among those whose planes hold it within rounding, or else hold it
/// best, the one with the closest normal wins. A polygon that this face does not hold within rounding is on all that it lies over
/// and is at most [`ScaledPolygons::near`] off.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on; [`crate::base::error::Error::Memory`].
pub fn label_by_polygons(
    polyhedron: &mut Polyhedron,
    polygons: &ScaledPolygons,
    numbers: Option<&Numbers>,
    progress: &mut Progress,
) -> Result<()> {
    let ScaledPolygons { mesh, points, .. } = *polygons;
    let face_count = polyhedron.faces.len();
    let found = faces_of_polygons(polyhedron, polygons, &mut progress.part(0.0, 0.9))?;
    // From here on in the order of labels.
    let polygons = numbers.map(|numbers| places_of(&numbers.faces)).transpose()?;
    let polygon = |label: u32| polygons.as_ref().map_or(label, |polygons| polygons[label as usize]) as usize;
    let (mut holders, mut labels) = (with_capacity(found.faces.len())?, with_capacity(found.faces.len())?);
    for label in 0..mesh.face_count() as u32 {
        let of_polygon = &found.faces[found.starts[polygon(label)] as usize..found.starts[polygon(label) + 1] as usize];
        extend(&mut holders, of_polygon.iter().copied())?;
        extend(&mut labels, of_polygon.iter().map(|_| label))?;
    }
    let borrowed = match numbers.and_then(|numbers| numbers.bare_face) {
        Some(label) => bare_faces(face_count, &holders, label)?,
        None => borrowed_labels(polyhedron, &holders, &labels, &mut progress.part(0.9, 1.0))?,
    };
    extend(&mut holders, borrowed.iter().map(|(face, _)| *face))?;
    extend(&mut labels, borrowed.iter().map(|(_, label)| *label))?;

    // Counting sort by face; it keeps the order within a face.
    let mut starts = filled(0_u32, face_count + 1)?;
    holders.iter().for_each(|face| starts[*face as usize + 1] += 1);
    for face in 0..face_count {
        starts[face + 1] += starts[face];
    }
    let mut sorted = filled(0, holders.len())?;
    let mut fill = copied(&starts)?;
    for (face, label) in holders.iter().zip(labels) {
        sorted[fill[*face as usize] as usize] = label;
        fill[*face as usize] += 1;
    }

    polyhedron.polygon_starts = with_capacity(sorted.len() + 1)?;
    polyhedron.polygon_starts.push(0);
    for of_face in starts.windows(2) {
        let labels = &sorted[of_face[0] as usize..of_face[1] as usize];
        for &label in labels {
            if labels.len() > 1 {
                extend(&mut polyhedron.polygon_corners, mesh.face(polygon(label)).iter().map(|c| points[*c as usize]))?;
            }
            polyhedron.polygon_starts.push(polyhedron.polygon_corners.len() as u32);
        }
    }
    polyhedron.face_labels = sorted;
    polyhedron.face_label_starts = starts;
    Ok(())
}

/// The faces on which polygons lie: polygon p on `faces[starts[p]..starts[p + 1]]`, one at least.
struct FacesOfPolygons {
    faces: Vec<u32>,
    starts: Vec<u32>,
}

/// The faces on which each polygon lies, or over which, where it is at most [`ScaledPolygons::near`] off them.
fn faces_of_polygons(
    polyhedron: &Polyhedron,
    &ScaledPolygons { mesh, points, near }: &ScaledPolygons,
    progress: &mut Progress,
) -> Result<FacesOfPolygons> {
    debug_assert!(mesh.divides_indices());
    debug_assert!(near >= 0.0);
    let around = FacesAround::new(polyhedron, &mut progress.part(0.0, 0.4))?;
    let progress = &mut progress.part(0.4, 1.0);
    let hull_vertices = hull_vertices_of(polyhedron, points)?;
    let bound = 2.0 * merge_bound(polyhedron.radius);
    let mut found =
        FacesOfPolygons { faces: with_capacity(mesh.face_count())?, starts: with_capacity(mesh.face_count() + 1)? };
    let mut spread = Spread::new(polyhedron, near, bound)?;
    let (mut vertices, mut own) = (Vec::new(), OwnCorners::default());
    let mut start = 0;
    for polygon in 0..mesh.face_count() {
        let corners = mesh.face(polygon);
        let normal = polygon_normal(points, corners);
        // A few corners all around; those with few faces first, as the hub of a fan has thousands.
        let tried = corners.iter().step_by(corners.len().div_ceil(MOST_CORNERS_TRIED));
        vertices.clear();
        vertices.extend(tried.filter_map(|c| hull_vertices[*c as usize]));
        if vertices.is_empty() {
            vertices.push(polyhedron.support(&normal, start).0);
        }
        vertices.sort_by_key(|v| around.range(*v).len());
        start = vertices[0];

        let misfit = |face: u32| {
            let planes = &polyhedron.faces[face as usize].planes;
            let plane = Vector::new(planes.x[0], planes.y[0], planes.z[0]);
            let distance = corners.iter().map(|c| planes.value(0, &points[*c as usize]).abs()).fold(bound, f64::max);
            let likeness = plane.dot(&normal);
            // Behind a thin plate the same corners may have a face that fits them better.
            (likeness < 0.0, distance, -likeness)
        };
        let centre = corners.iter().map(|c| points[*c as usize]).sum::<Vector>() / corners.len() as f64;
        let mut best = ((true, f64::INFINITY, f64::INFINITY), 0);
        for &vertex in &vertices {
            for face in around.towards(vertex, &centre) {
                progress.steps(corners.len(), polygon, mesh.face_count())?;
                let misfit = misfit(face);
                if misfit < best.0 {
                    best = (misfit, face);
                }
            }
            if !best.0.0 && best.0.1 <= bound {
                break;
            }
        }
        found.starts.push(found.faces.len() as u32);
        let ((_, misfit, _), face) = best;
        own.take(points, &hull_vertices, corners)?;
        let holds = |(point, vertex): (&Vector, &Option<u32>)| {
            vertex.is_some_and(|v| around.towards(v, &centre).any(|other| other == face))
                || is_within(polyhedron, face, point, bound)
        };
        if !(misfit <= bound && own.points.iter().zip(&own.vertices).all(holds)) {
            let seen = Polygon { number: polygon as u32, corners: &own.points, vertices: &own.vertices, normal };
            let steps = spread.add_faces(&seen, face, &mut found.faces)?;
            progress.steps(steps, polygon, mesh.face_count())?;
        }
        if found.faces.len() == found.starts[polygon] as usize {
            push(&mut found.faces, face)?;
        }
    }
    found.starts.push(found.faces.len() as u32);
    Ok(found)
}

/// The corners of a polygon, and the hull's vertices there.
#[derive(Default)]
struct OwnCorners {
    points: Vec<Vector>,
    vertices: Vec<Option<u32>>,
}

impl OwnCorners {
    fn take(&mut self, points: &[Vector], hull_vertices: &[Option<u32>], corners: &[u32]) -> Result<()> {
        self.points.clear();
        self.vertices.clear();
        extend(&mut self.points, corners.iter().map(|c| points[*c as usize]))?;
        extend(&mut self.vertices, corners.iter().map(|c| hull_vertices[*c as usize]))
    }
}

/// The merged faces around each hull vertex, flat vertices included.
struct FacesAround<'a> {
    polyhedron: &'a Polyhedron,
    /// Each face once, or, where there are more than `MOST_FACES_TRIED`, once for each of its triangles, by angle.
    faces: Vec<u32>,
    starts: Vec<u32>,
    /// In the latter case, the angles of the triangles about the axis to the centre of mass, ascending.
    angles: Vec<f64>,
}

impl FacesAround<'_> {
    fn new<'a>(polyhedron: &'a Polyhedron, progress: &mut Progress) -> Result<FacesAround<'a>> {
        let count = polyhedron.vertices.len();
        let mut starts = filled(0_u32, count + 1)?;
        for v in polyhedron.triangles.iter().flatten() {
            starts[*v as usize + 1] += 1;
        }
        for v in 0..count {
            starts[v + 1] += starts[v];
        }
        let mut triangles = filled(0, 3 * polyhedron.triangles.len())?;
        let mut fill = copied(&starts)?;
        let all = 2 * polyhedron.triangles.len();
        for (t, corners) in (0..).zip(&polyhedron.triangles) {
            progress.steps(3, t as usize, all)?;
            for v in corners {
                triangles[fill[*v as usize] as usize] = t;
                fill[*v as usize] += 1;
            }
        }
        let mut around =
            FacesAround { polyhedron, faces: Vec::new(), starts: with_capacity(count + 1)?, angles: Vec::new() };
        around.starts.push(0);
        let mut distinct = Vec::new();
        for v in 0..count {
            let [first, last] = [starts[v], starts[v + 1]].map(|start| start as usize);
            progress.steps(last - first, all / 2 + first / 3, all)?;
            around.add(v as u32, &triangles[starts[v] as usize..starts[v + 1] as usize], &mut distinct)?;
        }
        Ok(around)
    }

    /// Adds the next vertex; `distinct` is scratch.
    fn add(&mut self, vertex: u32, triangles: &[u32], distinct: &mut Vec<u32>) -> Result<()> {
        let face = |t: &u32| self.polyhedron.face_of_triangle[*t as usize];
        distinct.clear();
        extend(distinct, triangles.iter().map(face))?;
        distinct.sort_unstable();
        distinct.dedup();
        if distinct.len() <= MOST_FACES_TRIED {
            extend(&mut self.faces, distinct.iter().copied())?;
        } else {
            let position = |v: u32| self.polyhedron.vertices[v as usize].position;
            let centre = |t: &u32| self.polyhedron.triangles[*t as usize].map(position).iter().sum::<Vector>() / 3.0;
            let with_angle = |t: &u32| (self.angle(vertex, &centre(t)), *t);
            let mut sorted: Vec<(f64, u32)> = collected(triangles.iter().map(with_angle))?;
            sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let missing = self.faces.len() + sorted.len() - self.angles.len();
            reserve(&mut self.angles, missing)?;
            reserve(&mut self.faces, sorted.len())?;
            self.angles.resize(self.faces.len(), 0.0);
            self.angles.extend(sorted.iter().map(|(angle, _)| *angle));
            let polyhedron = self.polyhedron;
            self.faces.extend(sorted.iter().map(|(_, t)| polyhedron.face_of_triangle[*t as usize]));
        }
        push(&mut self.starts, self.faces.len() as u32)
    }

    fn range(&self, vertex: u32) -> Range<usize> {
        self.starts[vertex as usize] as usize..self.starts[vertex as usize + 1] as usize
    }

    /// The faces around a vertex; if there are many, those at the angle of a point. Seen along an axis into the body the faces
    /// around a vertex do not overlap.
    fn towards(&self, vertex: u32, point: &Vector) -> impl Iterator<Item = u32> {
        let range = self.range(vertex);
        let (faces, count) = (&self.faces[range.clone()], range.len());
        let (first, tried) = if count <= MOST_FACES_TRIED {
            (0, count)
        } else {
            let angle = self.angle(vertex, point);
            let place = self.angles[range].partition_point(|other| *other < angle);
            (place + count - MOST_FACES_TRIED / 2, MOST_FACES_TRIED)
        };
        (first..first + tried).map(move |i| faces[i % count])
    }

    /// A measure of the angle of a point about the axis from a vertex to the centre of mass.
    fn angle(&self, vertex: u32, point: &Vector) -> f64 {
        let position = &self.polyhedron.vertices[vertex as usize].position;
        let axis = self.polyhedron.mass.centre_of_mass - self.polyhedron.centre - position;
        let across = axis.cross(&Matrix::identity().column(axis.iamin()));
        let from = point - position;
        // Both are as long as the axis times the part across it.
        around(from.dot(&across) * axis.norm(), from.dot(&axis.cross(&across)))
    }
}

/// The hull vertex at each point, if there is one; exact duplicates share it.
fn hull_vertices_of(polyhedron: &Polyhedron, points: &[Vector]) -> Result<Vec<Option<u32>>> {
    // The points are free of −0, so equal coordinates have equal bits.
    let key = |p: &Vector| [p.x.to_bits(), p.y.to_bits(), p.z.to_bits()];
    let mut found = filled(None, points.len())?;
    for (v, &label) in polyhedron.vertex_labels.iter().enumerate() {
        found[label as usize] = Some(v as u32);
    }
    if found.iter().any(Option::is_none) {
        let count = polyhedron.vertices.len();
        let mut by_position: HashMap<[u64; 3], u32> = HashMap::new();
        by_position.try_reserve(count).map_err(|e| lacking::<([u64; 3], u32)>(count, &e))?;
        by_position.extend(polyhedron.vertices.iter().enumerate().map(|(v, x)| (key(&x.position), v as u32)));
        for (vertex, point) in found.iter_mut().zip(points) {
            *vertex = vertex.or_else(|| by_position.get(&key(point)).copied());
        }
    }
    Ok(found)
}

/// The area-weighted normal of a polygon (M. E. Newell), not of unit length.
fn polygon_normal(points: &[Vector], corners: &[u32]) -> Vector {
    let origin = points[corners[0] as usize];
    let offset = |c: u32| points[c as usize] - origin;
    corners[1..].windows(2).map(|pair| offset(pair[0]).cross(&offset(pair[1]))).sum()
}

/// The faces that hold no polygon, with one label for all of them.
fn bare_faces(face_count: usize, holders: &[u32], label: u32) -> Result<Vec<(u32, u32)>> {
    let mut is_bare = filled(true, face_count)?;
    holders.iter().for_each(|face| is_bare[*face as usize] = false);
    collected((0..).zip(is_bare).filter(|(_, is_bare)| *is_bare).map(|(face, _)| (face, label)))
}

/// Labels for the faces that hold no polygon, with those faces. They spread from faces that have one, across the flattest edge
/// first: if a polygon is not quite plane, and so several faces of the hull, all get its label before any gets another's.
fn borrowed_labels(
    polyhedron: &Polyhedron,
    holders: &[u32],
    labels: &[u32],
    progress: &mut Progress,
) -> Result<Vec<(u32, u32)>> {
    let mut lowest = filled(None, polyhedron.faces.len())?;
    for (face, label) in holders.iter().zip(labels).rev() {
        lowest[*face as usize] = Some(*label);
    }
    let mut links = BinaryHeap::new();
    for (face, label) in (0..).zip(&lowest) {
        if let Some(label) = *label {
            add_links(&mut links, polyhedron, &lowest, face, label)?;
        }
    }
    let mut borrowed = Vec::new();
    while let Some(Link { face, label, .. }) = links.pop() {
        progress.step(borrowed.len(), lowest.len())?;
        if lowest[face as usize].is_none() {
            lowest[face as usize] = Some(label);
            push(&mut borrowed, (face, label))?;
            add_links(&mut links, polyhedron, &lowest, face, label)?;
        }
    }
    Ok(borrowed)
}

/// An edge from a face with a label to one without. The greatest comes first: the flattest, then that of the lowest numbers.
struct Link {
    /// The cosine between the normals.
    flatness: f64,
    /// The face without a label.
    face: u32,
    /// The other one's.
    label: u32,
}

impl Ord for Link {
    fn cmp(&self, other: &Link) -> Ordering {
        let numbers = |link: &Link| (link.face, link.label);
        self.flatness.total_cmp(&other.flatness).then(numbers(other).cmp(&numbers(self)))
    }
}

impl PartialOrd for Link {
    fn partial_cmp(&self, other: &Link) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Link {
    fn eq(&self, other: &Link) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Link {}

/// From a face to those beside it that have no label.
fn add_links(
    links: &mut BinaryHeap<Link>,
    polyhedron: &Polyhedron,
    lowest: &[Option<u32>],
    face: u32,
    label: u32,
) -> Result<()> {
    let MergedFace { first_side, side_count, .. } = polyhedron.faces[face as usize];
    for side in &polyhedron.sides[first_side as usize..(first_side + side_count) as usize] {
        let edge = &polyhedron.edges[*side as usize];
        let face = if edge.left() == face { edge.right() } else { edge.left() };
        if lowest[face as usize].is_none() {
            links.try_reserve(1).map_err(|e| lacking::<Link>(1, &e))?;
            links.push(Link { flatness: edge.normals[0].dot(&edge.normals[1]), face, label });
        }
    }
    Ok(())
}
