//! Walks from face to face to the one through which a line enters or leaves, as far as plain doubles tell: it proposes.

use super::line::Line;
use crate::base::math::Vector;
use crate::body::polyhedron::lookup::Table;
use crate::body::polyhedron::{Edge, MergedFace, NONE, PlaneBlock, Polyhedron};
use crate::body::tables::table;

/// Which of the two places is looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum End {
    /// The line's entry into the body.
    Entry,
    /// The line's exit from the body.
    Exit,
}

/// The end of a walk.
#[derive(Debug, Clone, Copy)]
pub(super) enum Ended {
    /// At a face whose sides the line passes inside of.
    At(u32),
    /// At an edge that the line passes by, the last of the faces that are seen from where the line comes.
    Beside(u32),
    /// Nowhere.
    Lost,
}

/// A line in centred coordinates, from the point nearest to the body's centre of mass.
pub(super) struct LocalLine<'a> {
    polyhedron: &'a Polyhedron,
    nearest: Vector,
    direction: Vector,
}

impl<'a> LocalLine<'a> {
    pub fn new(line: &Line<'a>) -> LocalLine<'a> {
        let polyhedron = line.polyhedron;
        let direction = line.local_direction();
        // It may have any length that squares of numbers in range have.
        let direction = direction / direction.amax();
        let from = line.local_origin();
        let to_centre = centre_of_mass(polyhedron) - from;
        let nearest = from + direction * (to_centre.dot(&direction) / direction.norm_squared());
        LocalLine { polyhedron, nearest, direction }
    }

    /// The point where it meets the plane of a face.
    pub fn point_on(&self, face: u32) -> Vector {
        self.on_plane(&self.polyhedron.faces[face as usize]).1
    }

    /// How far along the line that is, and the point.
    fn on_plane(&self, face: &MergedFace) -> (f64, Vector) {
        let along = face.normal.dot(&self.direction);
        let at = -face.planes.value(0, &self.nearest) / along;
        (at, self.nearest + self.direction * at)
    }

    /// From a vertex that is near one end, if a table tells, to that end. Adds to the faces visited.
    ///
    /// The line comes in through the last plane that faces it. Where it passes beyond a side of a face, the plane across that side
    /// comes later. So a walk that only goes on to later planes visits no face twice.
    pub fn walk(&self, end: End, steps: &mut u32) -> Ended {
        // Seen from the exit, along the line backwards, the exit is where the line comes in.
        let sign = if end == End::Entry { 1.0 } else { -1.0 };
        let Some(mut face) = self.first_face(sign) else { return Ended::Lost };
        let (mut at, mut point) = self.on_plane(&self.polyhedron.faces[face as usize]);
        loop {
            *steps += 1;
            let beyond = match self.side_beyond(&self.polyhedron.faces[face as usize], &point) {
                Some(side) => side,
                None => return Ended::At(face),
            };
            let edge = &self.polyhedron.edges[beyond as usize];
            let next = if edge.left() == face { edge.right() } else { edge.left() };
            let across = &self.polyhedron.faces[next as usize];
            if !(sign * across.normal.dot(&self.direction) < 0.0) {
                return Ended::Beside(beyond);
            }
            let (later, there) = self.on_plane(across);
            if !(sign * later > sign * at) {
                return Ended::At(face);
            }
            (face, at, point) = (next, later, there);
        }
    }

    /// The edge of the side that a point of the face's plane is farthest beyond, if it is beyond one.
    fn side_beyond(&self, face: &MergedFace, point: &Vector) -> Option<u32> {
        let mut farthest = (0.0, NONE);
        let mut look = |block: &PlaneBlock, lane: usize, side: u32| {
            let value = block.value(lane, point);
            if value < farthest.0 {
                farthest = (value, side);
            }
        };
        (0..face.side_count.min(3)).for_each(|side| look(&face.planes, 1 + side as usize, side));
        for (block, first) in self.polyhedron.further_sides(face).iter().zip((3..).step_by(4)) {
            (first..face.side_count.min(first + 4)).for_each(|side| look(block, (side - first) as usize, side));
        }
        (farthest.1 != NONE).then(|| self.polyhedron.side(face, farthest.1))
    }

    /// A face that is turned against the line.
    fn first_face(&self, sign: f64) -> Option<u32> {
        let start = self.first_vertex(sign);
        // Around the vertex that is farthest against the line there is one.
        self.face_against(start, sign).or_else(|| {
            let (farthest, _) = self.polyhedron.support(&(self.direction * -sign), start);
            self.face_against(farthest, sign)
        })
    }

    /// The face at a vertex that is turned most against the line.
    fn face_against(&self, vertex: u32, sign: f64) -> Option<u32> {
        let mut best = (0.0, None);
        let edges = self.polyhedron.neighbour_blocks(vertex).flat_map(|block| block.edge);
        let of_edges =
            edges.filter_map(|e| self.polyhedron.edges.get(e as usize)).flat_map(|e: &Edge| [e.left(), e.right()]);
        for face in of_edges.chain(self.polyhedron.face_around(vertex)) {
            let along = sign * self.polyhedron.faces[face as usize].normal.dot(&self.direction);
            if along < best.0 {
                best = (along, Some(face));
            }
        }
        best.1
    }

    /// A vertex near where the line meets the sphere around the centre of mass.
    fn first_vertex(&self, sign: f64) -> u32 {
        let Polyhedron { mass, .. } = self.polyhedron;
        let from = self.nearest - centre_of_mass(self.polyhedron);
        let rest = (mass.radius * mass.radius - from.norm_squared()).max(0.0) / self.direction.norm_squared();
        let at = (from - self.direction * (sign * rest.sqrt())) / mass.radius;
        match table(self.polyhedron) {
            Table::Shells(table) => table.nearest([at.x as f32, at.y as f32, at.z as f32]),
            Table::Spherical(table) => table.towards(&at),
            Table::AllVertices(_) | Table::None => 0,
        }
    }
}

fn centre_of_mass(polyhedron: &Polyhedron) -> Vector {
    polyhedron.mass.centre_of_mass - polyhedron.centre
}
