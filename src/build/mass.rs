//! Volume, centre of mass, radius and box of a hull.

use crate::base::double_double::{DoubleDouble, WideVector, narrow, two_sum, wide_dot, widen};
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::base::progress::Progress;
use crate::polyhedron::MassProperties;

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

/// The area-weighted centre of the surface; of a flat body that of the polygon.
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
