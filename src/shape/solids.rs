//! The plain solids, as shapes: boxes, spheres and capsules about the origin.

use super::{InputPolicy, LARGEST_SWEPT_RADIUS, Shape, ShapeOptions};
use crate::base::error::{Result, check_range};
use crate::base::math::Vector;

impl Shape {
    /// The box [−x, x] × [−y, y] × [−z, z] of these half extents. With a `radius` a ball of it is swept over the box, which rounds
    /// edges and corners and reaches farther by the radius; 0 leaves them sharp. Vertex i has bit 0 of i set where x is positive,
    /// bit 1 for y, bit 2 for z.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error) unless each half extent is positive and both numbers are at most 2¹⁰⁰⁰.
    pub fn from_box(half_extents: &Vector, radius: f64) -> Result<Shape> {
        for (name, half) in
            ["half_extents[0]", "half_extents[1]", "half_extents[2]"].into_iter().zip(half_extents.iter())
        {
            check_range(name, *half, f64::MIN_POSITIVE..=LARGEST_SWEPT_RADIUS)?;
        }
        let side =
            |corner: usize, axis: usize| if corner >> axis & 1 == 1 { half_extents[axis] } else { -half_extents[axis] };
        swept(&[0, 1, 2, 3, 4, 5, 6, 7].map(|corner| Vector::from_fn(|axis, _| side(corner, axis))), radius)
    }

    /// The sphere of this radius.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error) unless the radius is from 0 to 2¹⁰⁰⁰.
    pub fn from_sphere(radius: f64) -> Result<Shape> {
        swept(&[Vector::zeros()], radius)
    }

    /// The capsule of this radius about the segment from (0, 0, −half_length), vertex 0, to (0, 0, half_length), vertex 1.
    ///
    /// # Errors
    /// [`Error::Argument`](crate::base::error::Error) unless both numbers are from 0 to 2¹⁰⁰⁰.
    pub fn from_capsule(half_length: f64, radius: f64) -> Result<Shape> {
        check_range("half_length", half_length, 0.0..=LARGEST_SWEPT_RADIUS)?;
        swept(&[-half_length, half_length].map(|z| Vector::new(0.0, 0.0, z)), radius)
    }
}

/// The hull of points, a ball of this radius swept over it.
fn swept(points: &[Vector], radius: f64) -> Result<Shape> {
    debug_assert!(!points.is_empty());
    check_range("radius", radius, 0.0..=LARGEST_SWEPT_RADIUS)?;
    Shape::from_points(
        points,
        &ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, ..ShapeOptions::default() },
    )
}
