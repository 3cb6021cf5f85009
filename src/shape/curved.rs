//! Cylinders, cones and ellipsoids: curved bodies, of which a polyhedron inside is known and how far they reach beyond it.
//!
//! Points of the polyhedron lie in the body however they are rounded: units of length are taken 8u shorter. The hull of points S
//! reaches as near to that of a set T as each point of T is to it, so only the circle and the sphere are measured.

use super::{LARGEST_SWEPT_RADIUS, Shape, ShapeOptions};
use crate::base::error::{Error, Result, check_range};
use crate::base::math::{STRETCH, UNIT_ROUNDOFF as U, Vector, length};
use crate::base::memory::{push, with_capacity};

/// The least length of a body, 2⁻⁹⁶⁰: what underflows in a product with it is less than what points are inside by.
const LEAST_LENGTH: f64 = f64::from_bits((1023 - 960) << 52);

/// Units of length are this long: normalising errs by 4u, a product with a length by u.
const INSIDE: f64 = 1.0 - 8.0 * U;

/// Bounds the error of any measure of a unit circle or sphere.
const ERROR: f64 = 64.0 * U;

/// The default deviation of cylinders and cones, of their radius, and of ellipsoids, of their largest semi-axis.
const DEFAULT_OF_CIRCLE: f64 = 1e-4;
const DEFAULT_OF_SPHERE: f64 = 1e-3;

/// The most sides of a polygon, …
const MOST_SIDES: usize = 2048;

/// … and the most parts into which an edge of the icosahedron is divided, for 4,002 vertices.
const MOST_PARTS: usize = 20;

impl Shape {
    /// The cylinder about the z axis with this radius, from z = −half_height to half_height. Its polyhedron is the prism over a
    /// regular polygon: vertex k of n is at the bottom, at the angle 2πk/n from x, vertex n + k above it.
    ///
    /// The body reaches farther than the polyhedron by at most `deviation`, which 0 sets to 1e-4 of the radius. All answers hold
    /// for the body; the shape's [`Shape::deviation`] widens their intervals.
    ///
    /// # Errors
    /// [`Error::Argument`] unless lengths are from 2⁻⁹⁶⁰ to 2¹⁰⁰⁰, and for a deviation that takes more than 2,048 sides.
    pub fn from_cylinder(radius: f64, half_height: f64, deviation: f64) -> Result<Shape> {
        let (circle, found) = circle(radius, half_height, deviation)?;
        let mut points = with_capacity(2 * circle.len())?;
        for z in [-half_height, half_height] {
            points.extend(circle.iter().map(|[x, y]| Vector::new(x * radius, y * radius, z)));
        }
        curved(&points, found)
    }

    /// The cone about the z axis: its base of this radius at z = −half_height, its tip at half_height. Its polyhedron is the
    /// pyramid over a regular polygon: vertex k of n as for a cylinder, vertex n the tip. The deviation is that of a cylinder.
    ///
    /// # Errors
    /// As of [`Shape::from_cylinder`].
    pub fn from_cone(radius: f64, half_height: f64, deviation: f64) -> Result<Shape> {
        let (circle, found) = circle(radius, half_height, deviation)?;
        let mut points = with_capacity(circle.len() + 1)?;
        points.extend(circle.iter().map(|[x, y]| Vector::new(x * radius, y * radius, -half_height)));
        points.push(Vector::new(0.0, 0.0, half_height));
        curved(&points, found)
    }

    /// The ellipsoid about the origin with these semi-axes along x, y and z. Its polyhedron is the image of a geodesic sphere.
    ///
    /// The body reaches farther than the polyhedron by at most `deviation`, which 0 sets to 1e-3 of the largest semi-axis.
    ///
    /// # Errors
    /// [`Error::Argument`] unless the semi-axes are from 2⁻⁹⁶⁰ to 2¹⁰⁰⁰, and for a deviation that takes more than 4,002 vertices.
    pub fn from_ellipsoid(semi_axes: &Vector, deviation: f64) -> Result<Shape> {
        for (name, axis) in ["semi_axes[0]", "semi_axes[1]", "semi_axes[2]"].into_iter().zip(semi_axes.iter()) {
            check_range(name, *axis, LEAST_LENGTH..=LARGEST_SWEPT_RADIUS)?;
        }
        let largest = semi_axes.max();
        let asked = asked_of_unit(deviation, largest, DEFAULT_OF_SPHERE)?;
        let mut reached = f64::INFINITY;
        for parts in 2..=MOST_PARTS {
            reached = sagitta_of_sphere(parts);
            if reached <= asked {
                let mut points = geodesic_sphere(parts)?;
                points.iter_mut().for_each(|point| point.component_mul_assign(semi_axes));
                return curved(&points, of_body(reached, largest));
            }
        }
        Err(too_fine(deviation, of_body(reached, largest), 10 * MOST_PARTS * MOST_PARTS + 2))
    }
}

fn curved(points: &[Vector], deviation: f64) -> Result<Shape> {
    Ok(Shape::from_points(points, &ShapeOptions::default())?.with_deviation(deviation))
}

/// The deviation of a body whose largest length is this, from that of the unit circle or sphere: at any pose, rounded up.
fn of_body(of_unit: f64, largest: f64) -> f64 {
    of_unit * (STRETCH * largest) * (1.0 + 4.0 * U)
}

/// The deviation of the unit circle or sphere that a caller's allows.
fn asked_of_unit(deviation: f64, largest: f64, default: f64) -> Result<f64> {
    check_range("deviation", deviation, 0.0..=LARGEST_SWEPT_RADIUS)?;
    let of_unit = if deviation == 0.0 { default } else { deviation / largest };
    Ok(of_unit / STRETCH * (1.0 - 8.0 * U))
}

#[cold]
fn too_fine(deviation: f64, least: f64, vertices: usize) -> Error {
    // Rounded up where it is printed.
    let least = least * 1.001;
    Error::Argument(format!(
        "deviation is {deviation:?}, it must be at least {least:.3e}, which takes {vertices} vertices, or 0"
    ))
}

/// A regular polygon in the unit circle, and the deviation of a cylinder or cone that has it.
fn circle(radius: f64, half_height: f64, deviation: f64) -> Result<(Vec<[f64; 2]>, f64)> {
    for (name, length) in [("radius", radius), ("half_height", half_height)] {
        check_range(name, length, LEAST_LENGTH..=LARGEST_SWEPT_RADIUS)?;
    }
    let asked = asked_of_unit(deviation, radius, DEFAULT_OF_CIRCLE)?;
    // The sagitta of n sides is 1 − cos π/n.
    let sides = (std::f64::consts::PI / (2.0 * asked).sqrt()).ceil();
    let mut quarter = if sides < MOST_SIDES as f64 { (sides as usize).div_ceil(4).max(2) } else { MOST_SIDES / 4 };
    loop {
        let polygon = regular_polygon(quarter)?;
        let reached = sagitta_of_circle(&polygon[..=quarter]);
        if reached <= asked {
            return Ok((polygon, of_body(reached, radius)));
        }
        if 4 * quarter >= MOST_SIDES {
            return Err(too_fine(deviation, of_body(reached, radius), 2 * MOST_SIDES));
        }
        quarter += 1;
    }
}

/// A polygon of 4·quarter sides; a quarter is turned by right angles. No library's sine is asked, so that all machines make the
/// same bodies; corners need not be where angles are equal, as deviations are measured.
fn regular_polygon(quarter: usize) -> Result<Vec<[f64; 2]>> {
    debug_assert!(quarter >= 2);
    let angle = std::f64::consts::FRAC_PI_2 / quarter as f64;
    let square = angle * angle;
    // The series to the power of 17: what is left out is less than u for angles up to π/4.
    let (mut sine, mut cosine) = (1.0, 1.0);
    for k in (1..=8).rev() {
        let k = f64::from(2 * k);
        sine = 1.0 - square / (k * (k + 1.0)) * sine;
        cosine = 1.0 - square / (k * (k - 1.0)) * cosine;
    }
    let sine = sine * angle;
    let mut polygon = with_capacity(4 * quarter)?;
    let (mut x, mut y) = (1.0, 0.0);
    for _ in 0..quarter {
        let length = f64::sqrt(x * x + y * y);
        (x, y) = (x / length, y / length);
        polygon.push([x * INSIDE, y * INSIDE]);
        (x, y) = (x * cosine - y * sine, x * sine + y * cosine);
    }
    for k in 0..3 * quarter {
        let [x, y] = polygon[k];
        polygon.push([-y, x]);
    }
    Ok(polygon)
}

/// How far a quarter of the unit circle is from the sides between these corners, at most: 1 less the height of a side's middle.
fn sagitta_of_circle(corners: &[[f64; 2]]) -> f64 {
    let height = |side: &[[f64; 2]]| 0.5 * length(&Vector::new(side[0][0] + side[1][0], side[0][1] + side[1][1], 0.0));
    1.0 - corners.windows(2).map(height).fold(1.0, f64::min) + ERROR
}

/// The icosahedron's corners: (0, ±1, ±φ) and turned.
const PHI: f64 = 1.618_033_988_749_895;
const CORNERS: [[f64; 3]; 12] = [
    [0.0, 1.0, PHI],
    [0.0, -1.0, PHI],
    [0.0, 1.0, -PHI],
    [0.0, -1.0, -PHI],
    [1.0, PHI, 0.0],
    [-1.0, PHI, 0.0],
    [1.0, -PHI, 0.0],
    [-1.0, -PHI, 0.0],
    [PHI, 0.0, 1.0],
    [PHI, 0.0, -1.0],
    [-PHI, 0.0, 1.0],
    [-PHI, 0.0, -1.0],
];

/// A face's point of the unit sphere, of parts i, j and k of its corners. Points of an edge are the same from both faces: a sum
/// with one term of 0 does not depend on the order.
fn on_sphere(face: &[Vector; 3], [i, j, k]: [usize; 3]) -> Vector {
    let [a, b, c] = [face[0] * i as f64, face[1] * j as f64, face[2] * k as f64];
    let sum = a + b + c;
    sum * (INSIDE / sum.norm())
}

/// All faces: three corners that are two apart, the length of an edge.
fn faces() -> impl Iterator<Item = [Vector; 3]> {
    let is_edge = |a: usize, b: usize| (Vector::from(CORNERS[a]) - Vector::from(CORNERS[b])).norm_squared() < 5.0;
    let triples = (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| [a, b, c])));
    triples
        .filter(move |&[a, b, c]| is_edge(a, b) && is_edge(b, c) && is_edge(a, c))
        .map(|face| face.map(|corner| CORNERS[corner].into()))
}

/// The places on a face whose edges are divided into parts.
fn places(parts: usize) -> impl Iterator<Item = [usize; 3]> {
    (0..=parts).flat_map(move |i| (0..=parts - i).map(move |j| [i, j, parts - i - j]))
}

/// The icosahedron with divided edges, on the unit sphere.
///
/// # Errors
/// [`Error::Memory`].
fn geodesic_sphere(parts: usize) -> Result<Vec<Vector>> {
    let mut points: Vec<Vector> = with_capacity(10 * (parts + 1) * (parts + 2))?;
    for face in faces() {
        for place in places(parts) {
            push(&mut points, on_sphere(&face, place))?;
        }
    }
    let by_coordinates =
        |a: &Vector, b: &Vector| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z));
    points.sort_unstable_by(by_coordinates);
    points.dedup();
    debug_assert_eq!(points.len(), 10 * parts * parts + 2);
    Ok(points)
}

/// How far the unit sphere is from the geodesic one, at most. Along each direction a triangle is passed, no nearer to the origin
/// than its plane; all faces are turned images of the first.
fn sagitta_of_sphere(parts: usize) -> f64 {
    let Some(face) = faces().next() else { return f64::INFINITY };
    let height = |corners: [[usize; 3]; 3]| {
        let [a, b, c] = corners.map(|place| on_sphere(&face, place));
        let normal = (b - a).cross(&(c - a));
        a.dot(&normal).abs() / normal.norm()
    };
    let mut least = 1.0_f64;
    for [i, j, k] in places(parts) {
        if k > 0 {
            least = least.min(height([[i, j, k], [i + 1, j, k - 1], [i, j + 1, k - 1]]));
        }
        if i > 0 && j > 0 {
            least = least.min(height([[i, j, k], [i - 1, j, k + 1], [i, j - 1, k + 1]]));
        }
    }
    // The cross product of sides 1/20 long errs by 400 times as much as the corners.
    1.0 - least + 512.0 * ERROR
}
