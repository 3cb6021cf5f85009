//! Contacts of triangles with one normal as one: a body on a plane of many triangles has one manifold.

use super::answer::{GroundContact, GroundContacts};
use super::normals::TILT;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, push};
use crate::pair::{Manifold, ManifoldPoint, Outcome, four_of_points};

/// What the gap of a point may be off along a normal that is turned by [`TILT`], relative to itself: 1 − cos of the angle is at
/// most half its square, and rounding is less than the rest.
const TURNED: f64 = TILT * TILT;

/// A contact of one triangle, with its points behind each other.
pub(super) struct Touch {
    pub triangle: u32,
    pub manifold: Manifold,
    pub first_point: usize,
}

/// Joins contacts whose normals are the same, up to [`TILT`], with the deepest of them, and lists what comes of that by their
/// triangles. Of points with one id one stays. If `reduces`, four points stay of a contact; `size` is a length next to the body.
pub(super) fn group(
    mut touches: Vec<Touch>,
    points: &[ManifoldPoint],
    reduces: bool,
    size: f64,
    found: &mut GroundContacts,
) -> Result<()> {
    for Touch { manifold, first_point, .. } in &mut touches {
        let own = &points[*first_point..][..manifold.point_count as usize];
        (manifold.lower, manifold.upper) = least_gap(own);
    }
    touches.sort_by(|a, b| a.manifold.lower.total_cmp(&b.manifold.lower).then(a.triangle.cmp(&b.triangle)));
    let mut is_taken = collected(touches.iter().map(|_| false))?;
    let (mut own, mut ids) = (Vec::new(), Vec::new());
    for leader in 0..touches.len() {
        if is_taken[leader] {
            continue;
        }
        let Touch { triangle, mut manifold, .. } = touches[leader];
        let normal = Vector::from(manifold.normal);
        own.clear();
        ids.clear();
        for (other, is_taken) in touches.iter().zip(&mut is_taken).skip(leader) {
            if *is_taken || (Vector::from(other.manifold.normal) - normal).norm() > TILT {
                continue;
            }
            *is_taken = true;
            if other.manifold.outcome == Outcome::Intersecting {
                manifold.outcome = Outcome::Intersecting;
            }
            for point in &points[other.first_point..][..other.manifold.point_count as usize] {
                push(&mut ids, (point.id, own.len()))?;
                push(&mut own, widened(point))?;
            }
        }
        leave_one_of_each(&mut own, &mut ids);
        (manifold.lower, manifold.upper) = least_gap(&own);
        manifold.found_count = own.len() as u32;
        let first_point = found.points.len();
        if reduces {
            four_of_points(&own, &manifold.normal, size).try_for_each(|at| push(&mut found.points, own[at]))?;
        } else {
            own.iter().try_for_each(|point| push(&mut found.points, *point))?;
        }
        manifold.point_count = (found.points.len() - first_point) as u32;
        push(&mut found.contacts, GroundContact { triangle, manifold, first_point })?;
    }
    found.contacts.sort_by_key(|contact| contact.triangle);
    Ok(())
}

/// The least gap of points, as an interval.
fn least_gap(points: &[ManifoldPoint]) -> (f64, f64) {
    let least = |of: fn(&ManifoldPoint) -> f64| points.iter().map(of).fold(f64::INFINITY, f64::min);
    (least(|point| point.gap_lower), least(|point| point.gap_upper))
}

/// The gap of a point along a normal that is turned by [`TILT`] at most.
fn widened(point: &ManifoldPoint) -> ManifoldPoint {
    let [gap_lower, gap_upper] = [point.gap_lower, point.gap_upper];
    let by = TURNED * gap_lower.abs().max(gap_upper.abs());
    ManifoldPoint { gap_lower: gap_lower - by, gap_upper: gap_upper + by, ..*point }
}

/// Of points with one id the first.
fn leave_one_of_each(points: &mut Vec<ManifoldPoint>, ids: &mut Vec<(u64, usize)>) {
    ids.sort_unstable();
    ids.dedup_by_key(|(id, _)| *id);
    ids.sort_unstable_by_key(|(_, at)| *at);
    for (to, &(_, from)) in ids.iter().enumerate() {
        points[to] = points[from];
    }
    points.truncate(ids.len());
}
