//! The hull of an open surface that lies on it, such as a piece of a decomposition.

use crate::base::error::{Error, Result};
use crate::base::locality::along_curve;
use crate::base::memory::collected;
use crate::base::progress::Progress;
use crate::body::build::assembly::build_in_steps;
use crate::body::build::hull::{check_points, convex_hull_in_steps};
use crate::body::mesh::{Numbers, PolygonMesh};
use crate::body::polyhedron::Polyhedron;

/// The label of a face of a patch's hull on which none of the caller's faces lies: UINT32_MAX.
pub const NO_FACE: u32 = u32::MAX;

/// How far off the hull a face that lies on it may be, in units of the noise of its coordinates: each corner by two roundings along
/// each axis, and another one the other way.
const NOISES: f64 = 4.0;

/// The hull of a patch, every vertex of which is `used`: the caller's index of each. A face without a polygon, up to the noise of
/// coordinates, is [`NO_FACE`].
///
/// # Errors
/// [`Error::Mesh`] for a vertex that is not finite; [`Error::Cancelled`] when the caller does not want to go on.
pub fn hull_of_patch(patch: &PolygonMesh, used: &[u32], noise: f64, progress: &mut Progress) -> Result<Polyhedron> {
    check_points(&patch.vertices)?;
    let order = along_curve(&patch.vertices, &mut progress.part(0.0, 0.04))?;
    let Some((ordered, numbers)) = patch.in_order(order, &mut progress.part(0.04, 0.1))? else {
        return Err(Error::Bug("the faces of a patch are lost in another order".into()));
    };
    let vertices = collected(numbers.vertices.iter().map(|v| used[*v as usize]))?;
    let numbers = Numbers { vertices, bare_face: Some(NO_FACE), near: NOISES * noise, ..numbers };
    let hull = convex_hull_in_steps(&ordered.vertices, &mut progress.part(0.1, 0.4))?;
    build_in_steps(&ordered.vertices, hull, Some(&ordered), Some(&numbers), &mut progress.part(0.4, 1.0))
}
