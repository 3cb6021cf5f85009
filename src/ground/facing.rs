//! The faces of a body that look down at a triangle. Only these have normals that a peak of the ground may have; a round body has
//! many others.

use super::lowest::PlacedTriangle;
use crate::base::error::Result;
use crate::base::math::{Matrix, Vector};
use crate::base::memory::push;
use crate::body::polyhedron::Polyhedron;

/// By so much the faces reach beyond those that a triangle asks for, so that they serve the triangles around it, too: normals of
/// hills of 16° are up to 0.55 apart.
const BEYOND: f64 = 0.5;

/// A bound of what accepted poses of body and ground do to the product of two normals: of 0.06 to their angle, 0.02 to a length.
const SKEW: f64 = 0.1;

/// The faces whose inward normals are in a ball about a direction.
pub(super) struct FacingFaces<'a> {
    faces: &'a mut Vec<u32>,
    up: Vector,
    /// The ball's radius; less than 0 before the first triangle.
    radius: f64,
}

impl FacingFaces<'_> {
    /// Of no triangle yet; `faces` is room.
    pub fn new(faces: &mut Vec<u32>) -> FacingFaces<'_> {
        FacingFaces { faces, up: Vector::zeros(), radius: -1.0 }
    }

    /// Some faces, ascending, among them all along whose inward normals contacts with a triangle may be. `inverse` is that of the
    /// body's rotation.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn at(&mut self, polyhedron: &Polyhedron, inverse: &Matrix, triangle: &PlacedTriangle) -> Result<&[u32]> {
        let up = &triangle.up;
        // How far a unit vector at the widest angle is from the triangle's normal: 2·sin(θ/2).
        let widest = triangle.marks.tan_half().map_or(2.0, |tan| 2.0 * tan / (1.0 + tan * tan).sqrt());
        if !(widest + (up - self.up).norm() <= self.radius) {
            (self.up, self.radius) = (*up, widest + BEYOND);
            self.faces.clear();
            let (down, least) = (-(inverse * up), 1.0 - 0.5 * self.radius * self.radius - SKEW);
            for (face, plane) in (0..).zip(&polyhedron.faces) {
                if plane.normal.dot(&down) >= least {
                    push(self.faces, face)?;
                }
            }
        }
        Ok(self.faces)
    }
}

#[cfg(test)]
mod tests {
    use super::super::contacts::near_hills::near_hills;
    use super::*;
    use crate::random::Random;
    use crate::shape::{Shape, ShapeOptions};

    /// Of a body as skewed as poses may be no face is left out whose normal, as placed, is within a triangle's widest angle.
    #[test]
    fn no_face_that_a_peak_may_ask_for_is_left_out() {
        let mut random = Random::new(0xfac);
        let points: Vec<Vector> = (0..60).map(|_| random.direction()).collect();
        let shape = Shape::from_points(&points, &ShapeOptions::default()).unwrap();
        let polyhedron = shape.polyhedron();
        let (mut asked, mut left_out) = (0, 0);
        for _ in 0..4 {
            let skew = Matrix::from_fn(|_, _| random.pick(&[-0.0049, 0.0, 0.0049]));
            let rotation = random.rotation() * (Matrix::identity() + skew);
            let inverse = rotation.try_inverse().unwrap();
            let mut room = Vec::new();
            let mut facing = FacingFaces::new(&mut room);
            near_hills(0xfac, 30, |near, _| {
                let Some(tan) = near.triangle.marks.tan_half() else { return };
                let least = (1.0 - tan * tan) / (1.0 + tan * tan);
                let faces = facing.at(polyhedron, &inverse, near.triangle).unwrap();
                for (face, plane) in (0..).zip(&polyhedron.faces) {
                    let inward = -(inverse.transpose() * plane.normal).normalize();
                    let is_asked = inward.dot(&near.triangle.up) >= least;
                    assert!(!is_asked || faces.contains(&face), "{inward:?} {tan} {:?}", near.triangle.up);
                    asked += usize::from(is_asked);
                    left_out += usize::from(!faces.contains(&face));
                }
            });
        }
        assert!(cfg!(miri) || asked > 1_000 && left_out > 1_000, "{asked} {left_out}");
    }
}
