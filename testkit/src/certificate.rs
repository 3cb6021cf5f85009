//! A proof of an answer about polytopes of any size, in exact rational arithmetic over all of their vertices: it is told one to
//! four pairs of indices and trusts nothing of the search that found them.

use dashu_ratio::RBig;

use crate::oracle::{Matrix3x4, Polytope, rational, transform, truth};

const IDENTITY: Matrix3x4 = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// The shortest vector P from B to A, if `pairs` (a vertex of A and one of B each) prove that it is: P is the point nearest to
/// the origin in the affine hull of the pairs' differences. If it lies in their convex hull, it is the difference of a point of
/// A and one of B, so the distance is at most |P|; if along P every vertex of A lies P·P or more above every vertex of B, the
/// distance is at least |P|.
pub fn proved_by(
    points_a: &[[f64; 3]],
    pose_a: &Matrix3x4,
    points_b: &[[f64; 3]],
    pose_b: &Matrix3x4,
    pairs: &[[u32; 2]],
) -> Option<[RBig; 3]> {
    let world =
        |points: &[[f64; 3]], pose| points.iter().map(|p| transform(pose, &p.map(rational))).collect::<Vec<_>>();
    let (a, b) = (world(points_a, pose_a), world(points_b, pose_b));
    let difference = |pair: &[u32; 2]| {
        let (v, w) = (a.get(pair[0] as usize)?, b.get(pair[1] as usize)?);
        Some([&v[0] - &w[0], &v[1] - &w[1], &v[2] - &w[2]])
    };
    let corners = pairs.iter().map(difference).collect::<Option<Vec<_>>>()?;
    let nearest = nearest_in_affine_hull(&corners)?;
    let (hull, point) = (Polytope::from_rationals(corners), Polytope::from_rationals(vec![nearest.clone()]));
    let lowest_of_a = a.iter().map(|v| dot(&nearest, v)).min()?;
    let highest_of_b = b.iter().map(|w| dot(&nearest, w)).max()?;
    let proved = truth(&hull, &IDENTITY, &point, &IDENTITY).intersecting()
        && lowest_of_a - highest_of_b >= dot(&nearest, &nearest);
    proved.then_some(nearest)
}

/// The scalar product.
pub fn dot(a: &[RBig; 3], b: &[RBig; 3]) -> RBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The origin minus its components along an orthogonal basis of the corners' differences (Gram-Schmidt).
fn nearest_in_affine_hull(corners: &[[RBig; 3]]) -> Option<[RBig; 3]> {
    let without = |v: [RBig; 3], along: &[RBig; 3]| {
        let share = dot(&v, along) / dot(along, along);
        [0, 1, 2].map(|k| &v[k] - &share * &along[k])
    };
    let (first, others) = corners.split_first()?;
    let mut basis: Vec<[RBig; 3]> = Vec::new();
    for corner in others {
        let edge = [0, 1, 2].map(|k| &corner[k] - &first[k]);
        let rest = basis.iter().fold(edge, without);
        if rest.iter().any(|c| !c.is_zero()) {
            basis.push(rest);
        }
    }
    Some(basis.iter().fold(first.clone(), without))
}
