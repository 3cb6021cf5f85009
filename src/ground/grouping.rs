//! Contacts of triangles with one normal as one: a body on a plane of many triangles has one manifold.

use super::answer::{GroundContact, GroundContacts};
use super::normals::TILT;
use super::room::{Grouping, Joined, Room, TriangleTouch};
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{extend, push};
use crate::manifold::{ManifoldPoint, four_of_points};
use crate::pair::Outcome;

/// A bound of the error of a point's gap along a normal that is turned by [`TILT`], relative to the gap: 1 − cos of the angle is
/// at most half its square, and rounding is less than the rest.
const TURNED: f64 = TILT * TILT;

/// The cosine up to which normals are on one side of a body: 45°.
const ONE_SIDE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Joins contacts whose normals are the same, up to [`TILT`], with the deepest of them. Adds the joined contacts to the list, by
/// their triangles. One point stays for each id. If `reduces`, four points stay on each side of the body; `size` is a length next
/// to it.
pub(super) fn group(found: &mut GroundContacts, reduces: bool, size: f64) -> Result<()> {
    let GroundContacts { contacts, points: listed, room } = found;
    let Room { touches, points, grouping, .. } = room;
    join(touches, points, grouping)?;
    if reduces {
        keep_four(grouping, size)?;
    }
    let Grouping { joined, gathered, stays, .. } = grouping;
    let first_contact = contacts.len();
    for &Joined { triangle, mut manifold, first_point: first } in &*joined {
        let first_point = listed.len();
        for at in (first..first + manifold.point_count as usize).filter(|at| stays[*at]) {
            push(listed, gathered[at])?;
        }
        if listed.len() > first_point {
            manifold.point_count = (listed.len() - first_point) as u32;
            (manifold.lower, manifold.upper) = least_gap(&listed[first_point..]);
            push(contacts, GroundContact { triangle, manifold, first_point })?;
        }
    }
    contacts[first_contact..].sort_unstable_by_key(|contact| contact.triangle);
    Ok(())
}

/// Joins contacts with one normal, the deepest first; all their points stay.
fn join(touches: &mut [TriangleTouch], points: &[ManifoldPoint], grouping: &mut Grouping) -> Result<()> {
    let Grouping { is_taken, own, ids, joined, gathered, stays, .. } = grouping;
    touches.sort_unstable_by(|a, b| a.manifold.lower.total_cmp(&b.manifold.lower).then(a.triangle.cmp(&b.triangle)));
    is_taken.clear();
    extend(is_taken, touches.iter().map(|_| false))?;
    joined.clear();
    gathered.clear();
    for leader in 0..touches.len() {
        if is_taken[leader] {
            continue;
        }
        let TriangleTouch { triangle, mut manifold, mut beside, .. } = touches[leader];
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
            let deeper = |point: &ManifoldPoint| beside.is_none_or(|before| point.gap_lower < before.gap_lower);
            beside = other.beside.filter(deeper).or(beside);
            for point in &points[other.first_point..][..other.manifold.point_count as usize] {
                push(ids, (point.id, own.len()))?;
                push(own, widened(point))?;
            }
        }
        leave_one_of_each(own, ids);
        // What is beside one of the triangles may be over another.
        if let Some(beside) = beside.filter(|beside| beside.gap_upper < least_gap(own).0) {
            push(own, widened(&beside))?;
        }
        (manifold.found_count, manifold.point_count) = (own.len() as u32, own.len() as u32);
        push(joined, Joined { triangle, manifold, first_point: gathered.len() })?;
        extend(gathered, own.iter().copied())?;
    }
    stays.clear();
    extend(stays, gathered.iter().map(|_| true))
}

/// Keeps four points of the contacts on each side of the body, which is that of the deepest contact.
fn keep_four(grouping: &mut Grouping, size: f64) -> Result<()> {
    let Grouping { is_taken, own, joined, gathered, stays, places, .. } = grouping;
    stays.fill(false);
    is_taken.clear();
    extend(is_taken, joined.iter().map(|_| false))?;
    for leader in 0..joined.len() {
        if is_taken[leader] {
            continue;
        }
        let normal = joined[leader].manifold.normal;
        own.clear();
        places.clear();
        for (other, is_taken) in joined.iter().zip(&mut *is_taken).skip(leader) {
            if *is_taken || Vector::from(other.manifold.normal).dot(&Vector::from(normal)) < ONE_SIDE {
                continue;
            }
            *is_taken = true;
            let range = other.first_point..other.first_point + other.manifold.point_count as usize;
            extend(places, range.clone())?;
            extend(own, gathered[range].iter().copied())?;
        }
        four_of_points(own, &normal, size).for_each(|at| stays[places[at]] = true);
    }
    Ok(())
}

/// The least gap of points, as an interval.
pub(super) fn least_gap(points: &[ManifoldPoint]) -> (f64, f64) {
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
