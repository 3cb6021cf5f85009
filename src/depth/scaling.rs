//! A pair in another unit of length: the search is for magnitudes whose cubes are numbers.

use crate::base::error::Result;
use crate::base::math::{Pose, Vector, binary_order, power_of_two};
use crate::body::polyhedron::lookup::Plan;
use crate::body::polyhedron::outlines::Outlines;
use crate::body::polyhedron::{LARGEST, Polyhedron};
use crate::placed::Pair;

/// Copies of both bodies and their poses, the larger body near size 1.
pub struct Rescaled {
    polyhedra: [Polyhedron; 2],
    poses: [Pose; 2],
    /// A length in the new unit is this times as large, a power of two.
    unit: f64,
}

impl Rescaled {
    /// `None` where some coordinate would not be the same number in the new unit: for bodies that span the whole range of
    /// doubles, for translations 2²⁰⁰ times as large as both bodies, and for points.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory) where the copies get none.
    pub fn of(pair: &Pair) -> Result<Option<Rescaled>> {
        let Pair { polyhedra, poses } = *pair;
        let [radius1, radius2] = polyhedra.map(|polyhedron| polyhedron.radius);
        let radius = radius1.max(radius2);
        if !(radius > 0.0 && radius < f64::INFINITY) {
            return Ok(None);
        }
        let unit = power_of_two(-binary_order(radius).clamp(-1000, 1000));
        let poses = poses.map(|pose| in_unit_of_pose(pose, unit));
        let [polyhedron1, polyhedron2] = polyhedra.map(|polyhedron| in_unit_of(polyhedron, unit));
        match (polyhedron1?, polyhedron2?, poses) {
            (Some(first), Some(second), [Some(pose1), Some(pose2)]) => {
                Ok(Some(Rescaled { polyhedra: [first, second], poses: [pose1, pose2], unit }))
            }
            _ => Ok(None),
        }
    }

    pub fn pair(&self) -> Pair<'_> {
        Pair { polyhedra: self.polyhedra.each_ref(), poses: self.poses.each_ref() }
    }

    /// A length in the new unit, rounded up where it leaves the range of doubles.
    pub fn in_unit(&self, length: f64) -> f64 {
        above(length, self.unit)
    }

    /// A length in the old unit, and not longer.
    pub fn lower_of(&self, length: f64) -> f64 {
        let old = length / self.unit;
        if old * self.unit > length { old.next_down() } else { old.min(f64::MAX) }
    }

    /// A length in the old unit, and not shorter.
    pub fn upper_of(&self, length: f64) -> f64 {
        let old = length / self.unit;
        if old * self.unit < length { old.next_up() } else { old }
    }
}

fn above(length: f64, unit: f64) -> f64 {
    let scaled = length * unit;
    if scaled / unit < length { scaled.next_up() } else { scaled }
}

/// A vector in another unit, if that is exact.
fn exactly(v: &Vector, unit: f64) -> Option<Vector> {
    let scaled = v * unit;
    (scaled / unit == *v && scaled.amax() <= LARGEST).then_some(scaled)
}

fn in_unit_of_pose(pose: &Pose, unit: f64) -> Option<Pose> {
    Some(Pose::new(&pose.rotation(), &exactly(&pose.translation(), unit)?))
}

/// A body that supports are found by: vertices exactly, slacks as bounds. Planes stay as they are, since no support looks at
/// them, and there is no look-up table and no fan.
fn in_unit_of(polyhedron: &Polyhedron, unit: f64) -> Result<Option<Polyhedron>> {
    let mut copy = polyhedron.copy()?;
    for vertex in &mut copy.vertices {
        let Some(position) = exactly(&vertex.position, unit) else { return Ok(None) };
        vertex.position = position;
    }
    let Some(centre) = exactly(&copy.centre, unit) else { return Ok(None) };
    copy.centre = centre;
    let bound = |x: &mut f64| *x = above(*x, unit);
    bound(&mut copy.radius);
    copy.edges.iter_mut().for_each(|edge| bound(&mut edge.slack));
    copy.faces.iter_mut().for_each(|face| bound(&mut face.slack));
    copy.bevels.iter_mut().for_each(|bevel| bound(&mut bevel.slack));
    copy.mass.centre_of_mass *= unit;
    copy.lookup.plan = Plan::None;
    copy.fill_vertex_blocks()?;
    copy.fan = None;
    copy.outlines = Outlines::default();
    Ok(Some(copy))
}
