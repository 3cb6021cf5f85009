//! Witness points, normals and contact points of answers.

use super::target::{DrawKind, Pen};
use crate::base::math::Vector;
use crate::manifold::ManifoldPoint;
use crate::pair::SignedDistance;

impl Pen<'_> {
    /// Witness points and normal, as far as they are set.
    pub fn witness(&mut self, answer: &SignedDistance) {
        let [point1, point2] = [answer.world1, answer.world2].map(Vector::from);
        let middle = (point1 + point2) * 0.5;
        self.points(DrawKind::Witness, [point1, point2], answer.distance);
        self.normal(middle, answer.normal.into());
    }

    /// The points of a manifold.
    pub fn contacts(&mut self, points: &[ManifoldPoint]) {
        for point in points {
            self.points(DrawKind::Contact, [point.world1, point.world2].map(Vector::from), point.gap());
        }
    }

    /// A point of each object, and how far they are apart: to as many digits as single precision has.
    fn points(&mut self, kind: DrawKind, [point1, point2]: [Vector; 2], distance: f64) {
        self.point(kind, point1);
        self.point(kind, point2);
        self.line(kind, point2, point1);
        self.text(kind, (point1 + point2) * 0.5, || (distance as f32).to_string());
    }
}
