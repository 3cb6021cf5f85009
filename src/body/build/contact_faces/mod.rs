//! Faces of meshes that are flat only up to the noise of their coordinates, for manifolds.
//!
//! A turned cube whose corners are floats is a hull of twelve triangles. Seen from a simulator it has six faces. So triangles are
//! grouped by height: a group is grown around a large triangle while vertices could be in one plane, each off by the noise h; then
//! a contact face is made of *all* vertices within a slab of 5h below the support plane along the group's mean normal. Heights,
//! and not angles, as a sliver's normal says nothing. How far a slab reaches above and below its middle is proved
//! ([`RiseBounds`]); which vertices it holds is not, and need not be.
//!
//! Tried, and worse: bands around the normal of a contact at query time (a tower of boxes falls, as the incident face tilts by
//! more than the band), and grouping by angle (88 % of some plates).

mod noise;
mod outline;

use crate::base::double_double::narrow;
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::memory::{collected, copied, filled, listed, push, with_capacity};
use crate::base::normal::{area_vector, normal_of};
use crate::base::progress::Progress;
use crate::base::sorting::sort_in_steps;
use crate::body::build::merge::merge_bound;
use crate::body::build::slack::RiseBounds;
use crate::body::polyhedron::triangulation::{Triangulation, previous};
use crate::body::polyhedron::{ContactFace, ContactFaces, FacePart, LARGEST, Polyhedron, SMALLEST};
pub use noise::default_noise;
use outline::outline;

/// The slab's thickness in units of the noise. Vertices of one plane need 2 where the fit is the best; it is not, and 4.6 have
/// been seen.
const SLAB: f64 = 5.0;

/// A triangle of less altitude, in units of the noise, has no reliable plane: a corner's error turns it by 15°. Corners of an
/// outline that are nearer to the line through their neighbours do not count.
const THIN: f64 = 4.0;

/// How far a point is off that is off by 1 along each axis: √3, rounded up.
const DIAGONAL: f64 = 1.733;

/// Triangles of a group face the same way as its contact face, at least up to this cosine: not the sides of a thin plate, nor its
/// other face.
const SAME_WAY: f64 = 0.5;

/// Groups that a triangle may be in before it gets one and that were none; after that it is left out of the groups of others, so
/// that creeping around smooth bodies has an end.
const MOST_FAILURES: u8 = 8;

/// No group yet.
const NONE: u32 = u32::MAX;

/// The contact faces of a polyhedron whose coordinates may be off by `noise`. None where the noise is no more than rounding,
/// which merged faces allow for; for flat bodies; for bodies beyond [`SMALLEST`] and [`LARGEST`]. Labels have been given.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on; [`crate::base::error::Error::Memory`].
pub fn find_contact_faces(polyhedron: &Polyhedron, noise: f64, progress: &mut Progress) -> Result<ContactFaces> {
    let none = ContactFaces { noise, ..ContactFaces::default() };
    let is_in_range = (SMALLEST..=LARGEST).contains(&polyhedron.radius);
    if polyhedron.dimension < 3 || !is_in_range || SLAB * noise <= merge_bound(polyhedron.radius) {
        return Ok(none);
    }
    let hull = FaceHull::new(polyhedron, noise, &mut progress.part(0.0, 0.3))?;
    let seeds = hull.seeds(&mut progress.part(0.3, 0.5))?;
    if seeds.is_empty() {
        return Ok(none);
    }
    let mut groups = Groups::new(&hull)?;
    let mut rises = RiseBounds::new(&hull.surface, &hull.positions, polyhedron.radius)?;
    let mut found = none;
    let progress = &mut progress.part(0.5, 1.0);
    for (done, &seed) in seeds.iter().enumerate() {
        progress.step(done, seeds.len())?;
        let mut tell = |count| progress.steps(count, done, seeds.len());
        if groups.group_of[seed as usize] == NONE
            && let Some(slab) = groups.slab_around(seed, &mut tell)?
        {
            groups.take_in(&slab, &mut rises, &mut found)?;
        }
    }
    if found.faces.is_empty() {
        return Ok(ContactFaces { noise, ..ContactFaces::default() });
    }
    found.at_vertices.sort_unstable();
    found.parts = groups.parts(&found)?;
    Ok(found)
}

/// A candidate for a contact face: all vertices between a support plane and one a little below.
struct Slab {
    normal: Vector,
    /// A vertex on the support plane.
    top: u32,
    vertices: Vec<u32>,
    /// The corners of the outline, counter-clockwise; three at least.
    corners: Vec<u32>,
}

/// The triangle that a group is measured by while it grows: at least half as large as any among the group's vertices.
struct ReferenceTriangle {
    corners: [Vector; 3],
    normal: Vector,
    /// Twice its area.
    size: f64,
}

impl ReferenceTriangle {
    fn new(corners: [Vector; 3], normal: Vector) -> ReferenceTriangle {
        let [a, b, c] = &corners;
        let size = (b - a).cross(&(c - a)).norm();
        ReferenceTriangle { corners, normal, size }
    }

    /// Whether a point could be in one plane with the triangle if all coordinates are off by the noise.
    fn holds(&self, point: &Vector, noise: f64) -> bool {
        let arms = self.corners.map(|corner| corner - point);
        // Barycentric coordinates, all times `size`.
        let share = |i: usize| self.normal.dot(&arms[(i + 1) % 3].cross(&arms[(i + 2) % 3])).abs();
        let extrapolation = (share(0) + share(1) + share(2)) / self.size;
        self.normal.dot(&arms[0]).abs() <= DIAGONAL * noise * (1.0 + extrapolation)
    }

    /// Takes a point for one of its corners if that makes it twice as large.
    fn enlarge(&mut self, point: &Vector) {
        for k in 0..3 {
            let mut corners = self.corners;
            corners[k] = *point;
            let [a, b, c] = &corners;
            let normal = normal_of(&area_vector(a, b, c), a, b, c);
            let normal = if normal.dot(&self.normal) < 0.0 { -normal } else { normal };
            let larger = ReferenceTriangle::new(corners, normal);
            if larger.size >= 2.0 * self.size {
                *self = larger;
                return;
            }
        }
    }
}

/// The triangles of a hull, and by how much their corners may be off.
struct FaceHull<'a> {
    polyhedron: &'a Polyhedron,
    noise: f64,
    positions: Vec<Vector>,
    surface: Triangulation,
    normals: Vec<Vector>,
    /// Twice the triangles' areas.
    sizes: Vec<f64>,
    /// Whether a merged face has a triangle whose plane is reliable.
    has_plane: Vec<bool>,
}

impl<'a> FaceHull<'a> {
    fn new(polyhedron: &'a Polyhedron, noise: f64, progress: &mut Progress) -> Result<FaceHull<'a>> {
        let positions: Vec<Vector> = collected(polyhedron.vertices.iter().map(|v| v.position))?;
        let count = polyhedron.triangles.len();
        let (mut normals, mut sizes) = (with_capacity(count)?, with_capacity(count)?);
        for (done, triangle) in polyhedron.triangles.iter().enumerate() {
            progress.steps(2, done, 2 * count)?;
            let [a, b, c] = triangle.map(|v| positions[v as usize]);
            let area = area_vector(&a, &b, &c);
            sizes.push(narrow(&area).norm());
            normals.push(normal_of(&area, &a, &b, &c));
        }
        let of_surface = &mut progress.part(0.5, 1.0);
        let triangles = copied(&polyhedron.triangles)?;
        let surface = Triangulation::new_in_steps(triangles, &normals, positions.len(), of_surface)?;
        let has_plane = filled(false, polyhedron.faces.len())?;
        let mut hull = FaceHull { polyhedron, noise, positions, surface, normals, sizes, has_plane };
        for t in 0..count as u32 {
            let face = hull.face(t) as usize;
            hull.has_plane[face] |= !hull.is_thin(t);
        }
        Ok(hull)
    }

    fn corners(&self, triangle: u32) -> [Vector; 3] {
        self.surface.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    fn reference(&self, triangle: u32) -> ReferenceTriangle {
        let (normal, size) = (self.normals[triangle as usize], self.sizes[triangle as usize]);
        ReferenceTriangle { corners: self.corners(triangle), normal, size }
    }

    /// Whether a triangle's plane says nothing.
    fn is_thin(&self, triangle: u32) -> bool {
        let [a, b, c] = self.corners(triangle);
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        // A NaN is thin.
        let has_altitude = self.sizes[triangle as usize] > THIN * self.noise * longest;
        !has_altitude
    }

    /// The corner of the triangle across a half-edge that is not on it.
    fn apex_across(&self, half_edge: u32) -> &Vector {
        &self.positions[self.surface.tail(previous(self.surface.twins[half_edge as usize])) as usize]
    }

    /// Whether a triangle stands for its merged face: where others do, a thin one along a side may as well be the next face's.
    fn counts(&self, triangle: u32) -> bool {
        !self.has_plane[self.face(triangle) as usize] || !self.is_thin(triangle)
    }

    /// The merged face of a triangle.
    fn face(&self, triangle: u32) -> u32 {
        self.polyhedron.face_of_triangle[triangle as usize]
    }

    /// Triangles from which groups may grow, the largest first: those with a plane to tell, in merged faces that have a neighbour
    /// to take in, or one that takes them in.
    fn seeds(&self, progress: &mut Progress) -> Result<Vec<u32>> {
        let count = self.surface.triangles.len() as u32;
        let mut is_open = filled(false, self.polyhedron.faces.len())?;
        for t in 0..count {
            progress.steps(4, t as usize, 3 * count as usize)?;
            let beside = |h: &u32| self.face(self.surface.twins[*h as usize] / 3);
            let mut across = (3 * t..3 * t + 3).filter(|h| beside(h) != self.face(t)).peekable();
            if across.peek().is_none() || self.is_thin(t) {
                continue;
            }
            let reference = self.reference(t);
            for h in across.filter(|h| reference.holds(self.apex_across(*h), self.noise)) {
                is_open[self.face(t) as usize] = true;
                is_open[beside(&h) as usize] = true;
            }
        }
        let mut seeds = Vec::new();
        for t in (0..count).filter(|t| is_open[self.face(*t) as usize] && !self.is_thin(*t)) {
            push(&mut seeds, t)?;
        }
        let size = |t: &u32| self.sizes[*t as usize];
        let larger_first = |s: &u32, t: &u32| size(t).total_cmp(&size(s)).then(s.cmp(t));
        sort_in_steps(&mut seeds, larger_first, &mut progress.part(0.4, 1.0))?;
        Ok(seeds)
    }
}

/// Groups of triangles while they are found.
struct Groups<'a> {
    hull: &'a FaceHull<'a>,
    /// The group of each triangle: its contact face, or [`UNCHANGED`].
    group_of: Vec<u32>,
    /// The last seed whose region a triangle was in.
    region_of: Vec<u32>,
    /// How often each triangle was in a region that was none.
    failures: Vec<u8>,
    /// The last round in which a vertex was found to be in a slab.
    seen_in: Vec<u32>,
    round: u32,
}

/// Marks a triangle whose group is a merged face as it is.
const UNCHANGED: u32 = u32::MAX - 1;

impl<'a> Groups<'a> {
    fn new(hull: &'a FaceHull<'a>) -> Result<Groups<'a>> {
        let count = hull.surface.triangles.len();
        let (group_of, region_of) = (filled(NONE, count)?, filled(NONE, count)?);
        let (failures, seen_in) = (filled(0, count)?, filled(0, hull.positions.len())?);
        Ok(Groups { hull, group_of, region_of, failures, seen_in, round: 0 })
    }

    /// Whether all corners of a triangle are in the last slab.
    fn is_in_slab(&self, triangle: u32) -> bool {
        self.hull.surface.triangles[triangle as usize].iter().all(|v| self.seen_in[*v as usize] == self.round)
    }

    /// The slab around a triangle, unless it stays alone. Tells of steps.
    fn slab_around(&mut self, seed: u32, tell: &mut impl FnMut(usize) -> Result<()>) -> Result<Option<Slab>> {
        let (region, mean_normal) = self.grow(seed, tell)?;
        if region.len() > 1 {
            // Along the mean normal first, then along that of the outline found so.
            let mut slab = self.slab(&mean_normal, seed, tell)?;
            if slab.corners.len() >= 3 {
                slab = self.slab(&outline_normal(&self.hull.positions, &slab.corners), seed, tell)?;
            }
            if slab.corners.len() >= 3 && self.is_in_slab(seed) {
                return Ok(Some(slab));
            }
        }
        region[1..].iter().for_each(|t| self.failures[*t as usize] += 1);
        Ok(None)
    }

    /// Triangles around a seed that could be in one plane with it, and their mean normal.
    fn grow(&mut self, seed: u32, tell: &mut impl FnMut(usize) -> Result<()>) -> Result<(Vec<u32>, Vector)> {
        let FaceHull { surface, normals, sizes, noise, .. } = self.hull;
        let mut reference = self.hull.reference(seed);
        let mut sum = normals[seed as usize] * sizes[seed as usize];
        self.region_of[seed as usize] = seed;
        let mut region = listed([seed]);
        let mut done = 0;
        while done < region.len() {
            let t = region[done];
            done += 1;
            tell(4)?;
            for h in 3 * t..3 * t + 3 {
                let neighbour = (surface.twins[h as usize] / 3) as usize;
                let apex = self.hull.apex_across(h);
                if self.region_of[neighbour] == seed
                    || self.group_of[neighbour] != NONE
                    || self.failures[neighbour] == MOST_FAILURES
                    || normals[neighbour].dot(&reference.normal) <= 0.0
                    || !reference.holds(apex, *noise)
                {
                    continue;
                }
                self.region_of[neighbour] = seed;
                push(&mut region, neighbour as u32)?;
                sum += normals[neighbour] * sizes[neighbour];
                reference.enlarge(apex);
            }
        }
        Ok((region, sum.normalize()))
    }

    /// All vertices within the slab below the support plane along a normal: they are connected, as those of a convex body beyond
    /// any plane.
    fn slab(&mut self, normal: &Vector, seed: u32, tell: &mut impl FnMut(usize) -> Result<()>) -> Result<Slab> {
        let FaceHull { polyhedron, noise, positions, surface, .. } = self.hull;
        let (top, _) = polyhedron.support(normal, surface.tail(3 * seed));
        let bottom = normal.dot(&positions[top as usize]) - SLAB * noise;
        self.round += 1;
        self.seen_in[top as usize] = self.round;
        let mut vertices = listed([top]);
        let mut done = 0;
        while done < vertices.len() {
            let around = surface.around(vertices[done]);
            done += 1;
            tell(around.len())?;
            for &h in around {
                let head = surface.head(h);
                if self.seen_in[head as usize] != self.round && normal.dot(&positions[head as usize]) >= bottom {
                    self.seen_in[head as usize] = self.round;
                    push(&mut vertices, head)?;
                }
            }
        }
        let corners = outline(positions, &vertices, normal, THIN * noise)?;
        Ok(Slab { normal: *normal, top, vertices, corners })
    }

    /// Gives a slab's triangles their group, and makes the contact face if it is more than a merged face.
    fn take_in(&mut self, slab: &Slab, rises: &mut RiseBounds, found: &mut ContactFaces) -> Result<()> {
        let hull = self.hull;
        let mut triangles = Vec::new();
        for &h in slab.vertices.iter().flat_map(|v| hull.surface.around(*v)) {
            let t = h / 3;
            // Each once: at its first corner.
            let is_new = h.is_multiple_of(3) && self.group_of[t as usize] == NONE;
            if is_new && self.is_in_slab(t) && hull.normals[t as usize].dot(&slab.normal) > SAME_WAY {
                push(&mut triangles, t)?;
            }
        }
        let mut faces = triangles.iter().filter(|t| hull.counts(**t)).map(|t| hull.face(*t));
        let first = faces.next();
        let is_one = faces.all(|face| Some(face) == first);
        let sides = first.map_or(0, |face| hull.polyhedron.faces[face as usize].side_count);
        // A vertex that slivers keep from the merged face finds it by the contact face alone.
        let is_at_face = |v: &u32| hull.surface.around(*v).iter().any(|h| Some(hull.face(h / 3)) == first);
        if is_one && sides as usize == slab.corners.len() && slab.vertices.iter().all(is_at_face) {
            triangles.iter().for_each(|t| self.group_of[*t as usize] = UNCHANGED);
            return Ok(());
        }
        let number = found.faces.len() as u32;
        triangles.iter().for_each(|t| self.group_of[*t as usize] = number);
        let lowest_label = |t: &u32| hull.polyhedron.labels_of_face(hull.face(*t)).first().copied();
        // Nothing of the body is higher than `rise` above `top`, none of the slab's vertices lower than `fall` below it.
        let rise = rises.rise(&slab.normal, slab.top, usize::MAX).unwrap_or(f64::INFINITY);
        let fall = rises.fall(&slab.normal, slab.top, slab.vertices.iter().copied());
        let face = ContactFace {
            normal: slab.normal,
            middle: slab.normal.dot(&hull.positions[slab.top as usize]) + 0.5 * (rise - fall),
            slack: 0.5 * (rise + fall) * (1.0 + 4.0 * UNIT_ROUNDOFF),
            first_corner: found.corners.len() as u32,
            corner_count: slab.corners.len() as u32,
            label: triangles.iter().filter_map(lowest_label).min().unwrap_or(0),
        };
        push(&mut found.faces, face)?;
        slab.corners.iter().try_for_each(|v| push(&mut found.corners, *v))?;
        slab.vertices.iter().try_for_each(|v| push(&mut found.at_vertices, [*v, number]))
    }

    /// The fate of the merged faces.
    fn parts(&self, found: &ContactFaces) -> Result<Vec<FacePart>> {
        let mut parts = filled(FacePart::Sliver, self.hull.has_plane.len())?;
        for (part, _) in parts.iter_mut().zip(&self.hull.has_plane).filter(|(_, has_plane)| **has_plane) {
            *part = FacePart::Whole;
        }
        for t in 0..self.group_of.len() as u32 {
            if (self.group_of[t as usize] as usize) < found.faces.len() && self.hull.counts(t) {
                parts[self.hull.face(t) as usize] = FacePart::Joined;
            }
        }
        Ok(parts)
    }
}

/// The unit normal of a polygon that is nearly flat, that of its area vector.
fn outline_normal(positions: &[Vector], corners: &[u32]) -> Vector {
    let arm = |v: u32| positions[v as usize] - positions[corners[0] as usize];
    let sum: Vector = corners.windows(2).map(|side| arm(side[0]).cross(&arm(side[1]))).sum();
    sum.normalize()
}
