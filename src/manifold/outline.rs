//! The outline of a patch seen along the normal of a contact, or of a body that has no faces.

use super::patch::Patch;
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF, Vector, divisor, length};
use crate::body::polyhedron::Polyhedron;
use nalgebra::Vector2;

/// Axes of a contact: two across its normal, and that.
#[derive(Debug, Clone, Copy)]
pub struct Axes {
    pub across: [Vector; 2],
    pub normal: Vector,
}

impl Axes {
    /// For a unit normal; the first axis is turned away from a direction by an angle that has nothing to do with it, as edges along
    /// the second axis would stand upright.
    pub fn new(normal: &Vector, beside: &Vector) -> Axes {
        let part = beside - normal * normal.dot(beside);
        let aside = if part.norm() > 1e-6 * beside.norm() { part } else { normal.cross(&least_axis(normal)) };
        let first = aside.normalize();
        let second = normal.cross(&first);
        let (cosine, sine) = (0.823_7, 0.567_020_026_8);
        let turned = (first * cosine + second * sine).normalize();
        Axes { across: [turned, normal.cross(&turned)], normal: *normal }
    }

    /// A point of the world from its coordinates.
    pub fn point(&self, spot: &Vector) -> Vector {
        self.across[0] * spot.x + self.across[1] * spot.y + self.normal * spot.z
    }

    /// The coordinates of a point of the world.
    pub fn spot(&self, point: &Vector) -> Vector {
        Vector::new(self.across[0].dot(point), self.across[1].dot(point), self.normal.dot(point))
    }
}

fn least_axis(v: &Vector) -> Vector {
    let mut axis = Vector::zeros();
    axis[v.iamin()] = 1.0;
    axis
}

/// A side of a patch, as a vector in its body's frame; 0 without a patch.
pub fn first_side(polyhedron: &Polyhedron, patch: Option<Patch>) -> Vector {
    let between = |[tail, head]: [u32; 2]| {
        polyhedron.vertices[head as usize].position - polyhedron.vertices[tail as usize].position
    };
    match patch {
        Some(Patch::Merged(face)) => {
            let edge = &polyhedron.edges[polyhedron.faces[face as usize].first_sides[0] as usize];
            between([edge.tail(), edge.head()])
        }
        Some(Patch::Contact(face)) => {
            let first = polyhedron.contact_faces.faces[face as usize].first_corner as usize;
            between([polyhedron.contact_faces.corners[first], polyhedron.contact_faces.corners[first + 1]])
        }
        None => Vector::zeros(),
    }
}

/// A polygon of a placed body: a patch, or the segment or point that the body is. Everything is measured from the centred origin of
/// body 2.
pub struct Outline<'a> {
    pub polyhedron: &'a Polyhedron,
    /// The body's own centred origin.
    pub offset: Vector,
    pub axes: &'a Axes,
    /// From the body's axes to those of the contact, and where its origin is there.
    turn: Matrix,
    origin: Vector,
    /// `None` for a body without faces.
    pub patch: Option<Patch>,
    pub count: usize,
    /// Whether its corners go around counter-clockwise, seen against the normal.
    pub is_counter_clockwise: bool,
    /// R⁻¹.
    inverse: Option<Matrix>,
    /// How far a point of its corners and sides is from a point of the body, at most: half the thickness of the slab that the
    /// patch stands for; 0 of a merged face, whose corners are exact.
    pub slack: f64,
    /// The patch's normal up to its length, in the axes of the contact, and that length.
    normal: Option<(Vector, f64)>,
    /// The position of the first corner.
    first: Vector,
}

impl<'a> Outline<'a> {
    pub fn new(
        polyhedron: &'a Polyhedron,
        pose: &'a Pose,
        offset: Vector,
        axes: &'a Axes,
        patch: Option<Patch>,
    ) -> Outline<'a> {
        let count = patch.map_or(polyhedron.vertices.len().min(2), |patch| patch.corner_count(polyhedron));
        let rotation = pose.rotation();
        let inverse = if pose.rotation_defect() <= RIGID { Some(rotation.transpose()) } else { rotation.try_inverse() };
        // In the world it is (R⁻¹)ᵀ·n, which is R·n where R is orthonormal up to rounding.
        let normal_of =
            |patch: Patch| inverse.map(|inverse| axes.spot(&(inverse.transpose() * patch.normal(polyhedron))));
        let normal = patch.and_then(normal_of).map(|normal| (normal, normal.norm()));
        let slack = match patch {
            Some(Patch::Contact(face)) => polyhedron.contact_faces.faces[face as usize].slack * pose.most_stretched(),
            _ => 0.0,
        };
        let [first, second] = &axes.across;
        let turn = Matrix::from_rows(&[first.transpose(), second.transpose(), axes.normal.transpose()]) * rotation;
        let origin = axes.spot(&offset);
        let is_counter_clockwise =
            patch.is_none_or(|patch| turn.row(2).transpose().dot(patch.normal(polyhedron)) >= 0.0);
        let first = Vector::zeros();
        let mut outline = Outline {
            polyhedron,
            offset,
            axes,
            turn,
            origin,
            patch,
            count,
            is_counter_clockwise,
            inverse,
            slack,
            normal,
            first,
        };
        outline.first = outline.spot(0);
        outline
    }

    /// The vertex at a corner.
    pub fn vertex(&self, corner: usize) -> u32 {
        self.patch.map_or(corner as u32, |patch| patch.vertex(self.polyhedron, corner))
    }

    /// The position of a corner: two coordinates across the normal, and the height along it. Corners of a contact face are put
    /// into the plane in the middle of its slab, along its own normal: seen from anywhere they are a convex polygon.
    pub fn spot(&self, corner: usize) -> Vector {
        let mut position = self.polyhedron.vertices[self.vertex(corner) as usize].position;
        if let Some(Patch::Contact(face)) = self.patch {
            let face = &self.polyhedron.contact_faces.faces[face as usize];
            position -= face.normal * (face.normal.dot(&position) - face.middle);
        }
        self.turn * position + self.origin
    }

    /// The caller's indices of the ends of the side from a corner to the next.
    pub fn side_labels(&self, side: usize) -> [u32; 2] {
        let label = |corner: usize| self.polyhedron.vertex_labels[self.vertex(corner) as usize];
        match self.patch {
            Some(Patch::Merged(face)) => {
                let record = &self.polyhedron.faces[face as usize];
                self.polyhedron.edges[self.polyhedron.side(record, side as u32) as usize].labels
            }
            Some(Patch::Contact(_)) => [label(side), label((side + 1) % self.count)],
            None => [label(0), label(self.count - 1)],
        }
    }

    /// The height of a patch over two coordinates, and its possible error where lengths are off by `rounding`. `None` for a patch
    /// on edge, and without one.
    ///
    /// A plane that is moved by δ along its unit normal n moves by δ/((R⁻¹)ᵀn)_z along z, whatever R is: so a slab reaches half its
    /// thickness over the cosine up and down. `slack` has a factor by which R may make lengths longer; |(R⁻¹)ᵀn| times that is at
    /// least 1.
    pub fn height_at(&self, x: f64, y: f64, rounding: f64) -> Option<(f64, f64)> {
        let (patch, (normal, length)) = (self.patch?, self.normal?);
        if !(normal.z.abs() > STEEPEST * length) {
            return None;
        }
        let corner = self.first;
        let rise = (normal.x * (x - corner.x) + normal.y * (y - corner.y)) / normal.z;
        // Off by that of the corner it is measured from and by its own.
        let slack = match patch {
            Patch::Merged(face) => self.polyhedron.faces[face as usize].slack,
            Patch::Contact(_) => 0.0,
        };
        let error = (2.0 * (slack + rounding) + self.slack) * length / normal.z.abs();
        Some((corner.z - rise, error))
    }

    /// A point in the body's frame, in centred coordinates.
    pub fn local(&self, spot: &Vector) -> Option<Vector> {
        Some(self.inverse? * (self.axes.point(spot) - self.offset))
    }

    /// The corners of least and of greatest first coordinate.
    fn ends(&self) -> [usize; 2] {
        let (mut ends, mut reaches) = ([0; 2], [f64::INFINITY, f64::NEG_INFINITY]);
        for corner in 0..self.count {
            let x = self.spot(corner).x;
            if x < reaches[0] {
                (ends[0], reaches[0]) = (corner, x);
            }
            if x > reaches[1] {
                (ends[1], reaches[1]) = (corner, x);
            }
        }
        ends
    }

    /// The lower and the upper chain, from left to right.
    pub fn chains(&'a self) -> [Chain<'a>; 2] {
        let [left, right] = self.ends();
        let (forward, backward) = (1, self.count - 1);
        let steps = if self.is_counter_clockwise { [forward, backward] } else { [backward, forward] };
        steps.map(|step| {
            let left_to_right = right + self.count - left;
            let segments = if step == 1 { left_to_right } else { 2 * self.count - left_to_right } % self.count;
            let first = self.spot(left);
            Chain { outline: self, step, segments, corner: left, from: first, to: first, has_begun: false }
        })
    }
}

/// Rᵀ stands for R⁻¹ where no entry of RᵀR − I exceeds this: then it is as near as a computed inverse is.
const RIGID: f64 = 8.0 * UNIT_ROUNDOFF;

/// A patch whose normal is flatter to the contact's than this has no height over a point.
pub const STEEPEST: f64 = 1e-3;

/// One side of an outline, from its leftmost corner to its rightmost.
#[derive(Clone, Copy)]
pub struct Chain<'a> {
    outline: &'a Outline<'a>,
    /// From corner to corner, around.
    step: usize,
    /// The remaining segments.
    pub segments: usize,
    /// The corner at `to`.
    pub corner: usize,
    /// The ends of the segment; at first both are the leftmost corner.
    pub from: Vector,
    pub to: Vector,
    pub has_begun: bool,
}

/// The length of a vector. The other way takes longer.
fn length_of(v: Vector2<f64>) -> f64 {
    let square = v.norm_squared();
    if (1e-280..1e280).contains(&square) { square.sqrt() } else { length(&Vector::new(v.x, v.y, 0.0)) }
}

impl Chain<'_> {
    /// Whether it has a further event: the corner at `to`.
    pub fn advance(&mut self) -> bool {
        if self.segments == 0 {
            return false;
        }
        self.segments -= 1;
        self.corner = (self.corner + self.step) % self.outline.count;
        (self.from, self.to) = (self.to, self.outline.spot(self.corner));
        self.has_begun = true;
        true
    }

    /// The side that the segment is.
    pub fn side(&self) -> usize {
        if self.step == 1 { (self.corner + self.outline.count - 1) % self.outline.count } else { self.corner }
    }

    /// The segment's point nearest to a place across the normal, if it is within a distance, and how far it is. For a segment
    /// that is no longer than that, seen along the normal, the point is the end that is farther along it, or against it:
    /// `towards` is the sign.
    pub fn point_near(&self, place: &Vector, distance: f64, towards: f64) -> Option<(Vector, f64)> {
        // Most are far from it; twice the distance, as what follows rounds.
        let reach = 2.0 * distance;
        let is_beside = |k: usize| {
            let (a, b) = (self.from[k] - place[k], self.to[k] - place[k]);
            (a > reach) & (b > reach) | (a < -reach) & (b < -reach)
        };
        if is_beside(0) | is_beside(1) {
            return None;
        }
        let (along, arm) = ((self.to - self.from).xy(), (place - self.from).xy());
        let length = length_of(along);
        let direction = along / divisor(length);
        let reach = arm.dot(&direction).clamp(0.0, length);
        let rest = arm - direction * reach;
        if !(rest.x.abs() <= distance && rest.y.abs() <= distance) {
            return None;
        }
        let off = length_of(rest);
        if !(off <= distance) {
            return None;
        }
        let share = if length > distance {
            reach / length
        } else if towards * self.to.z > towards * self.from.z {
            1.0
        } else {
            0.0
        };
        // Exactly the end where it is one.
        Some((if share < 1.0 { self.from + (self.to - self.from) * share } else { self.to }, off))
    }

    /// The segment's point over a first coordinate.
    pub fn at(&self, x: f64) -> Vector {
        let along = self.to - self.from;
        let t = (x - self.from.x) / divisor(along.x);
        self.from + along * t.clamp(0.0, 1.0)
    }
}
