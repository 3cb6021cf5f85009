//! Volume, centre of mass, radius, box and inertia of a hull.

use crate::base::double_double::{
    DoubleDouble, WideVector, narrow, two_sum, wide_cross, wide_difference, wide_dot, widen,
};
use crate::base::error::Result;
use crate::base::math::{Matrix, UNIT_ROUNDOFF, Vector, binary_order, power_of_two};
use crate::base::progress::Progress;
use crate::body::polyhedron::{MassProperties, Polyhedron};

/// Mass properties of a hull. `areas` are the triangles' area vectors (doubled).
///
/// The volume is the sum of the signed tetrahedra over the triangles from the local origin, in double-double: the terms of a
/// plate of aspect 10⁶ cancel to 10⁻⁶ of their size.
///
/// # Errors
/// [`crate::base::error::Error::Cancelled`] when the caller does not want to go on.
pub fn mass_properties(
    dimension: u8,
    positions: &[Vector],
    triangles: &[[u32; 3]],
    areas: &[WideVector],
    progress: &mut Progress,
) -> Result<MassProperties> {
    let (volume, local_centre) = match dimension {
        3 => solid(positions, triangles, areas, progress)?
            .unwrap_or_else(|| (0.0, surface_centre(positions, triangles, areas))),
        2 => (0.0, surface_centre(positions, triangles, areas)),
        // One vertex, or the two ends of a segment.
        _ => (0.0, positions.iter().sum::<Vector>() / positions.len() as f64),
    };
    let farthest = positions.iter().map(|p| (p - local_centre).norm()).fold(0.0, f64::max);
    let [lower, upper] = bounding_box(positions);
    Ok(MassProperties {
        volume,
        centre_of_mass: local_centre,
        radius: farthest * (1.0 + 8.0 * UNIT_ROUNDOFF),
        lower,
        upper,
    })
}

/// Lower and upper corner of the box around positions.
pub fn bounding_box(positions: &[Vector]) -> [Vector; 2] {
    [f64::min, f64::max].map(|pick| positions.iter().copied().reduce(|a, b| a.zip_map(&b, pick)).unwrap_or_default())
}

/// Volume and centre of mass; `None` if the body is so thin that not even double-double sees a volume.
fn solid(
    positions: &[Vector],
    triangles: &[[u32; 3]],
    areas: &[WideVector],
    progress: &mut Progress,
) -> Result<Option<(f64, Vector)>> {
    let mut volume = DoubleDouble::default(); // six times the volume
    let mut moment = WideVector::default(); // twenty-four times the first moment
    for (done, (triangle, area)) in triangles.iter().zip(areas).enumerate() {
        progress.step(done, triangles.len())?;
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let tetrahedron = wide_dot(&widen(&a), area);
        volume = volume + tetrahedron;
        for k in 0..3 {
            let corners = two_sum(a[k], b[k]) + c[k].into();
            moment[k] = moment[k] + tetrahedron * corners;
        }
    }
    let centre = narrow(&moment) / (4.0 * volume.hi);
    let inside = |k: usize| {
        let low = positions.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = positions.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        low <= centre[k] && centre[k] <= high
    };
    Ok((volume.hi > 0.0 && (0..3).all(inside)).then_some((volume.hi / 6.0, centre)))
}

/// The area-weighted centre of the surface; for a flat body, that of the polygon.
fn surface_centre(positions: &[Vector], triangles: &[[u32; 3]], areas: &[WideVector]) -> Vector {
    let mut total = 0.0;
    let mut moment = Vector::zeros();
    for (triangle, area) in triangles.iter().zip(areas) {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let weight = narrow(area).norm();
        total += weight;
        moment += (a + b + c) * weight;
    }
    if total > 0.0 { moment / (3.0 * total) } else { positions.iter().sum::<Vector>() / positions.len() as f64 }
}

/// The inertia tensor of a body of mass 1 about its centre of mass, in the axes of its local frame; for a body without interior,
/// that of its area or length.
///
/// Everything is measured from the centre of mass, from where all tetrahedra over triangles are positive: so nothing cancels, and
/// each entry is off by a few u of the largest. Heights over triangles are in double-double: for a thin body they have the digits
/// that its thickness needs. The error that the centre's own rounding leaves is removed with the first moment.
pub fn inertia(polyhedron: &Polyhedron) -> Matrix {
    // Near size 1: no square of a length leaves the doubles on the way.
    let radius = polyhedron.mass.radius;
    if radius == 0.0 {
        return Matrix::zeros();
    }
    let unit = power_of_two(binary_order(radius).clamp(-1000, 1000));
    let covariance = covariance(polyhedron, 1.0 / unit);
    let tensor = Matrix::from_diagonal_element(covariance.trace()) - covariance;
    tensor * unit * unit
}

/// The mean of x·xᵀ over a body scaled by a power of two, x from the centre of mass.
fn covariance(polyhedron: &Polyhedron, factor: f64) -> Matrix {
    let centre = (polyhedron.mass.centre_of_mass - polyhedron.centre) * factor;
    let corner = |v: u32| wide_difference(&(polyhedron.vertices[v as usize].position * factor), &centre);
    if polyhedron.dimension < 2 {
        let last = polyhedron.vertices.len() as u32 - 1;
        let along = narrow(&corner(last)) - narrow(&corner(0));
        return along * along.transpose() / 12.0;
    }
    // Without a volume the triangles themselves are weighed.
    let is_solid = polyhedron.mass.volume > 0.0;
    let mut sums = Moments::default();
    for triangle in &polyhedron.triangles {
        let [a, b, c] = triangle.map(corner);
        let side = |to: &WideVector| std::array::from_fn(|k| to[k] - a[k]);
        let area = wide_cross(&side(&b), &side(&c));
        let weight = if is_solid { wide_dot(&a, &area).hi } else { narrow(&area).norm() };
        sums.add(weight, [a, b, c].map(|corner| narrow(&corner)));
    }
    // For a tetrahedron with a corner at the origin, and for a triangle: the integrals over their weights.
    let (first, second) = if is_solid { (4.0, 20.0) } else { (3.0, 12.0) };
    let weight = sums.weight.hi;
    let aside = Vector::from_fn(|i, _| sums.first[i].hi / (first * weight));
    Matrix::from_fn(|i, j| sums.second[i][j].hi / (second * weight) - aside[i] * aside[j])
}

/// Weights, and weighted sums over triangles of (a + b + c) and (a + b + c)(a + b + c)ᵀ + aaᵀ + bbᵀ + ccᵀ.
#[derive(Default)]
struct Moments {
    weight: DoubleDouble,
    first: WideVector,
    second: [WideVector; 3],
}

impl Moments {
    fn add(&mut self, weight: f64, corners: [Vector; 3]) {
        let sum = corners[0] + corners[1] + corners[2];
        self.weight = self.weight + weight.into();
        for i in 0..3 {
            self.first[i] = self.first[i] + (weight * sum[i]).into();
            for j in 0..3 {
                let products: f64 = corners.iter().map(|corner| corner[i] * corner[j]).sum();
                self.second[i][j] = self.second[i][j] + (weight * (sum[i] * sum[j] + products)).into();
            }
        }
    }
}
