//! The input transform: applied to vertices before a shape is made of them.

use crate::base::double_double::{DoubleDouble, two_product};
use crate::base::error::{Error, Result};
use crate::base::math::{Matrix, Pose, Vector};
use crate::base::memory::{copied, with_capacity};
use crate::base::progress::Progress;
use crate::body::mesh::check_vertex;

/// Stored vertex = scale·(rotation·v) + translation.
#[derive(Debug, Clone, Copy)]
pub(super) struct InputTransform {
    pub(super) rotation: Matrix,
    pub(super) translation: Vector,
    pub(super) scale: f64,
}

/// scale·(rotation·v) + translation for all points, each coordinate rounded once: computed in double-double, so off by u of
/// itself and 2⁻⁹⁶ of the largest term.
pub(super) fn transformed(points: &[Vector], by: &InputTransform, progress: &mut Progress) -> Result<Vec<Vector>> {
    let InputTransform { rotation, translation, scale } = by;
    if !(*scale > 0.0 && scale.is_finite()) {
        return Err(Error::Argument(format!("scale is {scale:?}, it must be positive and finite")));
    }
    Pose::new(rotation, translation)
        .check()
        .map_err(|e| Error::Argument(format!("the input transform: {}", e.message())))?;
    if (*rotation, *translation, *scale) == (Matrix::identity(), Vector::zeros(), 1.0) {
        return copied(points);
    }
    let coordinate = |p: &Vector, row: usize| {
        let mut rotated = DoubleDouble::default();
        for column in 0..3 {
            rotated = rotated + two_product(rotation[(row, column)], p[column]);
        }
        (rotated * DoubleDouble::from(*scale) + translation[row].into()).hi
    };
    let mut transform = |(v, p): (usize, &Vector)| {
        progress.step(v, points.len())?;
        check_vertex(v, p)?;
        let image = Vector::from_fn(|row, _| coordinate(p, row));
        if image.iter().all(|x| x.is_finite()) {
            Ok(image)
        } else {
            Err(Error::Argument(format!("the input transform moves vertex {v} out of the range of doubles")))
        }
    };
    let mut images = with_capacity(points.len())?;
    for point in points.iter().enumerate() {
        images.push(transform(point)?);
    }
    Ok(images)
}
