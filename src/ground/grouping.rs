//! Contacts of triangles with one normal as one: a body on a plane of many triangles has one manifold.

use super::answer::{GroundContact, GroundContacts};
use super::normals::TILT;
use super::room::{Grouping, Room, Touch};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{extend, push};
use crate::pair::{ManifoldPoint, Outcome, four_of_points};

/// A bound of the error of a point's gap along a normal that is turned by [`TILT`], relative to the gap: 1 − cos of the angle is
/// at most half its square, and rounding is less than the rest.
const TURNED: f64 = TILT * TILT;

/// Joins contacts whose normals are the same, up to [`TILT`], with the deepest of them. Adds the joined contacts to the list, by
/// their triangles. One point stays for each id. If `reduces`, four points of a contact stay; `size` is a length next to the
/// body.
pub(super) fn group(found: &mut GroundContacts, reduces: bool, size: f64) -> Result<()> {
    let GroundContacts { contacts, points: listed, room } = found;
    let Room { touches, points, grouping: Grouping { is_taken, own, ids }, .. } = room;
    let first_contact = contacts.len();
    for Touch { manifold, first_point, .. } in &mut *touches {
        let own = &points[*first_point..][..manifold.point_count as usize];
        (manifold.lower, manifold.upper) = least_gap(own);
    }
    touches.sort_unstable_by(|a, b| a.manifold.lower.total_cmp(&b.manifold.lower).then(a.triangle.cmp(&b.triangle)));
    is_taken.clear();
    extend(is_taken, touches.iter().map(|_| false))?;
    for leader in 0..touches.len() {
        if is_taken[leader] {
            continue;
        }
        let Touch { triangle, mut manifold, .. } = touches[leader];
        let normal = Vector::from(manifold.normal);
        own.clear();
        ids.clear();
        for (other, is_taken) in touches.iter().zip(&mut *is_taken).skip(leader) {
            if *is_taken || (Vector::from(other.manifold.normal) - normal).norm() > TILT {
                continue;
            }
            *is_taken = true;
            if other.manifold.outcome == Outcome::Intersecting {
                manifold.outcome = Outcome::Intersecting;
            }
            for point in &points[other.first_point..][..other.manifold.point_count as usize] {
                push(ids, (point.id, own.len()))?;
                push(own, widened(point))?;
            }
        }
        leave_one_of_each(own, ids);
        (manifold.lower, manifold.upper) = least_gap(own);
        manifold.found_count = own.len() as u32;
        let first_point = listed.len();
        if reduces {
            four_of_points(own, &manifold.normal, size).try_for_each(|at| push(listed, own[at]))?;
        } else {
            extend(listed, own.iter().copied())?;
        }
        manifold.point_count = (listed.len() - first_point) as u32;
        push(contacts, GroundContact { triangle, manifold, first_point })?;
    }
    contacts[first_contact..].sort_unstable_by_key(|contact| contact.triangle);
    Ok(())
}

/// The least gap of points, as an interval.
fn least_gap(points: &[ManifoldPoint]) -> (f64, f64) {
    debug_assert!(!points.is_empty());
    let least = |of: fn(&ManifoldPoint) -> f64| points.iter().map(of).fold(f64::INFINITY, f64::min);
    (least(|point| point.gap_lower), least(|point| point.gap_upper))
}

/// The gap of a point along a normal that is turned by [`TILT`] at most.
fn widened(point: &ManifoldPoint) -> ManifoldPoint {
    let [gap_lower, gap_upper] = [point.gap_lower, point.gap_upper];
    let by = TURNED * gap_lower.abs().max(gap_upper.abs());
    ManifoldPoint { gap_lower: gap_lower - by, gap_upper: gap_upper + by, ..*point }
}

/// Keeps the first of the points with one id.
fn leave_one_of_each(points: &mut Vec<ManifoldPoint>, ids: &mut Vec<(u64, usize)>) {
    ids.sort_unstable();
    ids.dedup_by_key(|(id, _)| *id);
    ids.sort_unstable_by_key(|(_, at)| *at);
    for (to, &(_, from)) in ids.iter().enumerate() {
        points[to] = points[from];
    }
    points.truncate(ids.len());
}
