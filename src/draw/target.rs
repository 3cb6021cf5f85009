//! Who receives what is drawn.

use crate::base::math::Vector;

/// What a line, a point or a text shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i32)]
pub enum DrawKind {
    /// An edge of a shape, each once; a point that a shape is. With a swept radius r: the edges of its faces, moved outwards by r,
    /// and circles about the ends of spheres and capsules. Of a ground: the edges of its triangles, each once where two triangles
    /// are neighbours.
    Edge = 0,
    /// An edge of the box around an object of a scene.
    Box = 1,
    /// A line between the centres of two pieces whose boxes overlap, as the last query of the scene left them.
    NearPair = 2,
    /// Both witness points, and the line from that of object 2 to that of object 1; the text is the distance, or minus the depth.
    Witness = 3,
    /// The normal, from the middle between the witness points on.
    Normal = 4,
    /// Both points of a contact point, and the line from object 2 to object 1; the text is the gap.
    Contact = 5,
    /// A feature at which a march was: a point, an edge, or the sides of a face.
    Feature = 6,
    /// The line between the nearest points of two features at which a march was, from object 2 to object 1; of a face the foot on
    /// its plane. The text is the step's number and both features.
    March = 7,
    /// The triangles of the polytope that encloses the origin in the Minkowski difference of overlapping objects, three lines each;
    /// the origin, and the nearest point of the boundary. Places are differences, of a point of object 1 minus one of object 2.
    Polytope = 8,
}

/// Receives what is drawn, in world coordinates.
pub trait Draw {
    /// Whether things of a kind are to be drawn.
    fn wants(&self, _kind: DrawKind) -> bool {
        true
    }

    /// The length of a drawn normal.
    fn normal_length(&self) -> f64 {
        1.0
    }

    /// A straight line.
    fn line(&mut self, kind: DrawKind, start: [f64; 3], end: [f64; 3]);

    /// A point.
    fn point(&mut self, kind: DrawKind, place: [f64; 3]);

    /// A few words at a place.
    fn text(&mut self, kind: DrawKind, place: [f64; 3], text: &str);
}

/// Draws what is wanted and finite: numbers that an answer leaves unset are not.
pub(crate) struct Pen<'a> {
    draw: &'a mut dyn Draw,
}

impl<'a> Pen<'a> {
    pub fn new(draw: &'a mut dyn Draw) -> Pen<'a> {
        Pen { draw }
    }

    pub fn wants(&self, kind: DrawKind) -> bool {
        self.draw.wants(kind)
    }

    pub fn line(&mut self, kind: DrawKind, start: Vector, end: Vector) {
        if self.wants(kind) && is_finite(&start) && is_finite(&end) {
            self.draw.line(kind, start.into(), end.into());
        }
    }

    pub fn point(&mut self, kind: DrawKind, place: Vector) {
        if self.wants(kind) && is_finite(&place) {
            self.draw.point(kind, place.into());
        }
    }

    pub fn text(&mut self, kind: DrawKind, place: Vector, text: impl FnOnce() -> String) {
        if self.wants(kind) && is_finite(&place) {
            self.draw.text(kind, place.into(), &text());
        }
    }

    /// A unit vector that begins at a place.
    pub fn normal(&mut self, place: Vector, normal: Vector) {
        let length = self.draw.normal_length();
        self.line(DrawKind::Normal, place, place + normal * length);
    }

    /// The sides of a polygon.
    pub fn polygon(&mut self, kind: DrawKind, corners: impl Iterator<Item = Vector> + Clone) {
        for (start, end) in corners.clone().zip(corners.cycle().skip(1)) {
            self.line(kind, start, end);
        }
    }
}

fn is_finite(place: &Vector) -> bool {
    place.iter().all(|x| x.is_finite())
}
