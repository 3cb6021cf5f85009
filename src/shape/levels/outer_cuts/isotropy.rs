//! Coordinates in which a body's covariance is the identity.

use crate::base::math::{Matrix, UNIT_ROUNDOFF, Vector};
use crate::body::polyhedron::Polyhedron;

/// A matrix S such that the body's covariance is S·Sᵀ, its columns along the principal axes: x = centre + S·y gives coordinates y
/// in which the covariance is the identity. `None` if rounding leaves no interior.
pub fn spread_of(body: &Polyhedron, centre: &Vector) -> Option<Matrix> {
    debug_assert_eq!(body.dimension, 3);
    let mut spread = Matrix::identity() * body.radius;
    // The eigenvalues of a covariance are right to u of the largest, so those of a body of aspect 10⁶ only to 10⁻⁴: the rest is
    // found in the new coordinates.
    for round in 0..4 {
        let covariance = covariance(body, centre, &spread.try_inverse()?)?;
        if (covariance - Matrix::identity()).amax() < 1e-3 {
            break;
        }
        let eigen = covariance.symmetric_eigen();
        let least = UNIT_ROUNDOFF * UNIT_ROUNDOFF * eigen.eigenvalues.amax();
        let roots = Matrix::from_diagonal(&eigen.eigenvalues.map(|value| value.max(least).sqrt()));
        // The first round turns the axes into the principal ones, those that follow keep them.
        spread *= eigen.eigenvectors * roots;
        if round > 0 {
            spread *= eigen.eigenvectors.transpose();
        }
        if spread.determinant() < 0.0 {
            spread = -spread;
        }
    }
    spread.iter().all(|x| x.is_finite()).then_some(spread)
}

/// The covariance of the solid in the coordinates whitening·(x − centre), from the tetrahedra of the centre with the triangles.
fn covariance(body: &Polyhedron, centre: &Vector, whitening: &Matrix) -> Option<Matrix> {
    let (mut volume, mut moments) = (0.0, Matrix::zeros());
    for triangle in &body.triangles {
        let corners = triangle.map(|v| whitening * (body.vertices[v as usize].position - centre));
        let [a, b, c] = corners;
        // The centre is inside: a negative volume is rounding.
        let weight = a.dot(&b.cross(&c)).max(0.0);
        let sum = a + b + c;
        volume += weight;
        moments += (sum * sum.transpose() + corners.iter().map(|p| p * p.transpose()).sum::<Matrix>()) * weight;
    }
    (volume > 0.0).then(|| moments / (20.0 * volume))
}
