//! Four of points that exist already, for instance those of several manifolds with one normal.

use super::answer::{FOUR, ManifoldPoint};
use super::clip::CommonCorner;
use super::outline::Axes;
use super::places::{CommonPoint, Origin};
use super::reduction::{Thinned, four_of};
use crate::base::math::Vector;
use nalgebra::Vector2;

/// For points with one normal, the places of those that stay in a reduced manifold; `size` is a length next to the pair. Among
/// points as deep as the deepest, the farthest out counts as the deepest: where inner edges of a plane are crossed, no point is a
/// corner of what is covered.
pub(crate) fn four_of_points(points: &[ManifoldPoint], normal: &[f64; 3], size: f64) -> impl Iterator<Item = usize> {
    let normal = Vector::from(*normal);
    let axes = Axes::new(&normal, &normal);
    let origin = points.first().map_or(Vector::zeros(), |point| point.world1.into());
    let spot = |point: &ManifoldPoint| axes.spot(&(Vector::from(point.world1) - origin)).xy();
    let middle = points.iter().map(spot).sum::<Vector2<f64>>() / points.len() as f64;
    let deepest = points.iter().map(|point| point.gap_upper).fold(f64::INFINITY, f64::min);
    let how_far = |point: &ManifoldPoint| (spot(point) - middle).norm_squared();
    let as_deep = points.iter().enumerate().filter(|(_, point)| point.gap_lower <= deepest);
    let outermost = as_deep.max_by(|(_, a), (_, b)| how_far(a).total_cmp(&how_far(b))).map_or(0, |(corner, _)| corner);
    let none_before = [0; FOUR];
    let mut thinned = Thinned::new(&none_before);
    for (corner, point) in points.iter().enumerate() {
        let height = 0.5 * point.gap_lower + 0.5 * point.gap_upper;
        let gap = if corner == outermost { f64::NEG_INFINITY } else { height };
        let across = spot(point);
        let spots = [gap, 0.0].map(|height| Vector::new(across.x, across.y, height));
        let origin = Origin::Corner(CommonCorner::Vertex { body: 0, corner });
        thinned.add(&CommonPoint { origin, spots, error: 0.5 * (point.gap_upper - point.gap_lower) });
    }
    let place_of = |place: Option<&CommonPoint>| match place?.origin {
        Origin::Corner(CommonCorner::Vertex { corner, .. }) => Some(corner),
        _ => None,
    };
    four_of(thinned.places(), &none_before, size).map(place_of).into_iter().flatten()
}
