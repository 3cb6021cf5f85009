//! The faces of the hull that a polygon lies over if it is not all on one: its corners are off a plane by their precision, and
//! the hull's faces over it go their own ways.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{filled, push};
use crate::body::polyhedron::{MergedFace, NONE, Polyhedron};

/// A face looks the way a polygon does if their normals have at least this cosine. A steeper face is another side of the body, or
/// next to nothing of the polygon.
const ALIKE: f64 = 0.5;

/// A search for faces over one polygon after the other.
pub struct Spread<'a> {
    polyhedron: &'a Polyhedron,
    /// How far corners of a polygon may be off the plane of a face over it.
    near: f64,
    /// A bound of the rounding error of a length.
    bound: f64,
    /// The last polygon that came to each face.
    seen: Vec<u32>,
    /// The last polygon that has each vertex as a corner, and which corner that is.
    corner_of: Vec<[u32; 2]>,
    open: Vec<u32>,
}

/// A polygon of the caller's.
pub struct Polygon<'a> {
    pub number: u32,
    /// Counter-clockwise about the normal.
    pub corners: &'a [Vector],
    /// The hull's vertices at the corners.
    pub vertices: &'a [Option<u32>],
    /// Normal of any length.
    pub normal: Vector,
}

impl<'a> Spread<'a> {
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(polyhedron: &'a Polyhedron, near: f64, bound: f64) -> Result<Spread<'a>> {
        let seen = filled(NONE, polyhedron.faces.len())?;
        let corner_of = filled([NONE; 2], polyhedron.vertices.len())?;
        Ok(Spread { polyhedron, near, bound, seen, corner_of, open: Vec::new() })
    }

    /// Adds the faces to `found` that a polygon lies over, and returns how much work it was; `start` is a face near by.
    ///
    /// Seen against a direction the faces that look that way do not overlap. So those over a convex polygon hang together, and from
    /// one of them neighbour by neighbour all are found.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn add_faces(&mut self, polygon: &Polygon, start: u32, found: &mut Vec<u32>) -> Result<usize> {
        debug_assert_eq!(polygon.corners.len(), polygon.vertices.len());
        let length = polygon.normal.norm();
        if !(length > 0.0) {
            return Ok(0);
        }
        let seen = Polygon { normal: polygon.normal / length, ..*polygon };
        for (corner, vertex) in (0..).zip(seen.vertices) {
            if let Some(vertex) = *vertex {
                self.corner_of[vertex as usize] = [seen.number, corner];
            }
        }
        let mut steps = 0;
        let facing = self.facing(&seen, start, &mut steps);
        let start = self.walk(&seen, facing, &mut steps);
        self.seen[start as usize] = seen.number;
        push(&mut self.open, start)?;
        while let Some(face) = self.open.pop() {
            steps += self.polyhedron.faces[face as usize].side_count as usize;
            if !self.lies_over(&seen, face, &mut steps) {
                continue;
            }
            push(found, face)?;
            for side in 0..self.polyhedron.faces[face as usize].side_count {
                let (ends, beside) = self.side(face, side);
                // The polygon does not reach over its own sides.
                if self.seen[beside as usize] != seen.number && !self.is_side(&seen, ends) {
                    self.seen[beside as usize] = seen.number;
                    push(&mut self.open, beside)?;
                }
            }
        }
        Ok(steps)
    }

    /// The ends of a face's side, and the face beside it.
    fn side(&self, face: u32, side: u32) -> ([u32; 2], u32) {
        let edge = &self.polyhedron.edges[self.polyhedron.side(&self.polyhedron.faces[face as usize], side) as usize];
        if edge.left() == face {
            ([edge.tail(), edge.head()], edge.right())
        } else {
            ([edge.head(), edge.tail()], edge.left())
        }
    }

    fn position(&self, vertex: u32) -> Vector {
        self.polyhedron.vertices[vertex as usize].position
    }

    /// A face that looks a polygon's way, from one that need not: rounding may leave a polygon no vertex of the hull but some at
    /// its sides, around which all faces are the next side's. The way is over neighbours that a ray from the centre of mass along
    /// the normal comes to sooner: seen from the centre, faces are corners of the dual polytope, and the ray asks for the highest.
    fn facing(&self, seen: &Polygon, mut face: u32, steps: &mut usize) -> u32 {
        let centre = self.polyhedron.mass.centre_of_mass - self.polyhedron.centre;
        let likeness = |face: u32| self.polyhedron.faces[face as usize].normal.dot(&seen.normal);
        let height = |face: u32| {
            let depth = -self.polyhedron.faces[face as usize].planes.value(0, &centre);
            likeness(face) / depth.max(f64::MIN_POSITIVE)
        };
        while likeness(face) < ALIKE {
            let sides = self.polyhedron.faces[face as usize].side_count;
            *steps += sides as usize;
            let beside = (0..sides).map(|side| self.side(face, side).1);
            match beside.max_by(|a, b| height(*a).total_cmp(&height(*b))) {
                Some(next) if height(next) > height(face) => face = next,
                _ => break,
            }
        }
        if likeness(face) >= ALIKE {
            return face;
        }
        // Slivers look anywhere, and end a way too soon.
        let all = 0..self.polyhedron.faces.len() as u32;
        *steps += self.polyhedron.faces.len();
        all.max_by(|a, b| likeness(*a).total_cmp(&likeness(*b))).unwrap_or(face)
    }

    /// The face over the middle of a polygon, from another over neighbours that have the middle on their side of an edge: each
    /// time, as the body is below all planes and above none of the edge's two, the plane over the middle is a lower one.
    fn walk(&self, seen: &Polygon, start: u32, steps: &mut usize) -> u32 {
        let middle = seen.corners.iter().sum::<Vector>() / seen.corners.len() as f64;
        let mut face = start;
        // Rounding may lead round in a circle.
        for _ in 0..self.polyhedron.faces.len() {
            let MergedFace { normal, side_count, .. } = &self.polyhedron.faces[face as usize];
            if !(normal.dot(&seen.normal) > 0.0) {
                break;
            }
            *steps += *side_count as usize;
            let beyond = (0..*side_count).map(|side| self.side(face, side)).find(|&([tail, head], _)| {
                let [tail, head] = [tail, head].map(|v| self.position(v));
                let along = head - tail;
                seen.normal.dot(&along.cross(&(middle - tail))) < -self.bound * along.norm()
            });
            match beyond {
                Some((_, beside)) => face = beside,
                None => return face,
            }
        }
        start
    }

    /// Whether two vertices are the ends of a side of the polygon.
    fn is_side(&self, seen: &Polygon, ends: [u32; 2]) -> bool {
        let [[polygon, first], [other, second]] = ends.map(|v| self.corner_of[v as usize]);
        let apart = first.abs_diff(second);
        polygon == seen.number && other == polygon && (apart == 1 || apart as usize == seen.corners.len() - 1)
    }

    /// Whether a polygon and a face look the same way, near each other, and overlap.
    fn lies_over(&self, seen: &Polygon, face: u32, steps: &mut usize) -> bool {
        let record = &self.polyhedron.faces[face as usize];
        let is_corner = |side: u32| self.corner_of[self.polyhedron.corner(face, side) as usize][0] == seen.number;
        if !(record.normal.dot(&seen.normal) > 0.0) {
            return false;
        }
        if (0..record.side_count).all(is_corner) {
            return true;
        }
        *steps += 2 * seen.corners.len();
        record.normal.dot(&seen.normal) >= ALIKE
            && seen.corners.iter().all(|corner| record.planes.value(0, corner).abs() <= self.near)
            && self.overlap(seen, face)
    }

    /// Whether a polygon and a face, both convex, overlap by more than rounding: no side of either has all of the other beyond it.
    fn overlap(&self, seen: &Polygon, face: u32) -> bool {
        let count = self.polyhedron.faces[face as usize].side_count;
        let corner = |side: u32| self.position(self.polyhedron.corner(face, side % count));
        let next = |i: usize| &seen.corners[(i + 1) % seen.corners.len()];
        let of_polygon = || seen.corners.iter().copied();
        let of_face = || (0..count).map(corner);
        !(0..count).any(|side| self.separates(seen, &corner(side), &corner(side + 1), of_polygon()))
            && !(0..seen.corners.len()).any(|i| self.separates(seen, &seen.corners[i], next(i), of_face()))
    }

    /// Whether points are all beyond a side.
    fn separates(
        &self,
        seen: &Polygon,
        tail: &Vector,
        head: &Vector,
        mut points: impl Iterator<Item = Vector>,
    ) -> bool {
        let across = seen.normal.cross(&(head - tail));
        let length = across.norm();
        length > self.bound && points.all(|point| across.dot(&(point - tail)) <= self.bound * length)
    }
}

/// Whether a point in the plane of a face is within its sides, up to `bound`: by bisection of the fan around its first corner.
pub fn is_within(polyhedron: &Polyhedron, face: u32, point: &Vector, bound: f64) -> bool {
    let record = &polyhedron.faces[face as usize];
    let corner = |side: u32| polyhedron.vertices[polyhedron.corner(face, side) as usize].position;
    let is_left = |tail: &Vector, head: &Vector, bound: f64| {
        let along = head - tail;
        record.normal.dot(&along.cross(&(point - tail))) >= -bound * along.norm()
    };
    let hub = corner(0);
    let (mut low, mut high) = (1, record.side_count - 1);
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if is_left(&hub, &corner(middle), 0.0) { low = middle } else { high = middle }
    }
    let (low, high) = (corner(low), corner(high));
    is_left(&hub, &low, bound) && is_left(&low, &high, bound) && is_left(&high, &hub, bound)
}
