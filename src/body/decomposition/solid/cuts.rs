//! Where a cell is cut.

use crate::base::error::Result;
use crate::base::math::{Matrix, Vector};
use crate::base::memory::{collected, extend, push};
use crate::body::decomposition::solid::cell::{CellFacet, CuttingPlane, SolidCell};
use crate::body::decomposition::solid::solid_piece::{BodyCheck, SolidPiece};

/// Edges whose planes are tried.
const EDGES: usize = 8;
/// Points that are tried.
const SAMPLES: usize = 500;
/// Places along each axis.
const PLACES: [f64; 3] = [0.3, 0.5, 0.7];

/// The plane whose two parts have hulls of the least volume.
pub fn best_cut(cell: &SolidCell, piece: &SolidPiece, worst: &Vector, check: &BodyCheck) -> Result<CuttingPlane> {
    let mut planes = Vec::new();
    planes_at_edges(cell, &mut planes)?;
    planes_across_axes(cell, piece, worst, &mut planes)?;
    let directions = directions()?;
    let hollow = Hollow::sampled(piece, check)?;
    let middle =
        CuttingPlane::through(&(0.5 * (piece.low + piece.high)), Vector::ith((piece.high - piece.low).imax(), 1.0));
    let mut best = (f64::INFINITY, middle);
    for (k, plane) in planes.iter().enumerate() {
        let is_near = |other: &CuttingPlane| {
            (other.normal - plane.normal).norm() + (other.height - plane.height).abs() < 1e-6
                || (other.normal + plane.normal).norm() + (other.height + plane.height).abs() < 1e-6
        };
        if planes[..k].iter().any(is_near) {
            continue;
        }
        let parts = cell.split_points(plane, check.tree)?;
        let [Some(below), Some(above)] = [rough_hull(&parts[0], &directions)?, rough_hull(&parts[1], &directions)?]
        else {
            continue;
        };
        let balance = below.volume.min(above.volume) / piece.volume;
        let volume = (below.volume + above.volume) / piece.volume;
        let score = hollow.share_in(&below) + hollow.share_in(&above) + VOLUME * volume - BALANCE * balance
            + REFLEX * cell.reflex_share(plane);
        if score < best.0 {
            best = (score, *plane);
        }
    }
    Ok(best.1)
}

/// What all the hulls' volume and an even cut count, beside the hollows.
const VOLUME: f64 = 0.1;
const BALANCE: f64 = 0.1;
/// What concave edges of both parts count, relative to those of the whole.
const REFLEX: f64 = 0.3;

/// Points of a hull that are outside of the body, each with its distance beyond half the tolerance.
struct Hollow {
    points: Vec<(Vector, f64)>,
    total: f64,
}

impl Hollow {
    fn sampled(piece: &SolidPiece, check: &BodyCheck) -> Result<Hollow> {
        let mut hollow = Hollow { points: Vec::new(), total: 0.0 };
        let (enough, mut near) = (0.5 * check.tolerance, 0);
        for i in 0..SAMPLES {
            // H. Niederreiter, "Random Number Generation and Quasi-Monte Carlo Methods", 1992: multiples of irrational numbers.
            let place = Vector::new(0.8191725133961645, 0.6710436067037893, 0.5497004779019703) * (i as f64 + 0.5);
            let point = piece.low + place.map(f64::fract).component_mul(&(piece.high - piece.low));
            if !piece.holds(&point) {
                continue;
            }
            let distance = check.tree.distance_within(&point, enough, &mut near) - enough;
            if distance > 0.0 && !check.tree.winds_around(&point) {
                push(&mut hollow.points, (point, distance))?;
                hollow.total += distance;
            }
        }
        Ok(hollow)
    }

    fn share_in(&self, hull: &SolidPiece) -> f64 {
        let inside = self.points.iter().filter(|(point, _)| hull.holds(point));
        inside.map(|(_, distance)| distance).sum::<f64>() / self.total.max(f64::MIN_POSITIVE)
    }
}

/// The hull of the points that are extreme along some directions, both ways.
fn rough_hull(points: &[Vector], directions: &[Vector]) -> Result<Option<SolidPiece>> {
    if points.len() <= 40 {
        return SolidPiece::new(points);
    }
    let mut extreme = Vec::new();
    for direction in directions {
        let (mut high, mut low) = ((f64::NEG_INFINITY, 0), (f64::INFINITY, 0));
        for (k, point) in points.iter().enumerate() {
            let height = point.dot(direction);
            if height > high.0 {
                high = (height, k);
            }
            if height < low.0 {
                low = (height, k);
            }
        }
        extend(&mut extreme, [high.1, low.1])?;
    }
    extreme.sort_unstable();
    extreme.dedup();
    let some: Vec<Vector> = collected(extreme.iter().map(|i| points[*i]))?;
    SolidPiece::new(&some)
}

/// Towards the surface of a grid of five by five by five, one of each two that are opposite.
fn directions() -> Result<Vec<Vector>> {
    let cells = (0..62).map(|i| [i % 5, i / 5 % 5, i / 25].map(|k| f64::from(k) - 2.0));
    collected(cells.filter(|cell| cell.iter().any(|x| x.abs() == 2.0)).map(Vector::from))
}

/// Along both faces of the longest and sharpest concave edges, and between them.
fn planes_at_edges(cell: &SolidCell, planes: &mut Vec<CuttingPlane>) -> Result<()> {
    let weight = |k: &usize| {
        let edge = &cell.reflex[*k];
        (edge.ends[1] - edge.ends[0]).norm() * (edge.normals[1] - edge.normals[0]).norm()
    };
    let mut order: Vec<usize> = collected(0..cell.reflex.len())?;
    order.sort_by(|a, b| weight(b).total_cmp(&weight(a)));
    for k in order.into_iter().take(EDGES) {
        let edge = &cell.reflex[k];
        let between = edge.normals[1] - edge.normals[0];
        for normal in [edge.normals[0], edge.normals[1], between / between.norm()] {
            push(planes, CuttingPlane::through(&edge.ends[0], normal))?;
        }
    }
    Ok(())
}

/// Across the axes of coordinates and those of the points' spread.
fn planes_across_axes(
    cell: &SolidCell,
    piece: &SolidPiece,
    worst: &Vector,
    planes: &mut Vec<CuttingPlane>,
) -> Result<()> {
    let middle = piece.corners.iter().sum::<Vector>() / piece.corners.len() as f64;
    let spread: Matrix = piece.corners.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    let spread = spread.symmetric_eigen().eigenvectors;
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    for axis in axes.into_iter().chain((0..3).map(|k| spread.column(k).into_owned())) {
        let heights = || piece.corners.iter().map(|p| axis.dot(p));
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
        let gap = widest_gap(&cell.surface, &axis)?;
        let places = PLACES.map(|place| low + place * (high - low));
        for height in places.into_iter().chain([axis.dot(worst)]).chain(gap) {
            push(planes, CuttingPlane { normal: axis, height })?;
        }
    }
    Ok(())
}

/// The middle of the longest part of an axis across which there is no surface.
fn widest_gap(surface: &[CellFacet], axis: &Vector) -> Result<Option<f64>> {
    let heights = |facet: &CellFacet| {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        facet.corners.iter().map(|p| axis.dot(p)).fold(start, |(low, high), h| (low.min(h), high.max(h)))
    };
    let mut spans = collected(surface.iter().map(heights))?;
    spans.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let (mut end, mut widest) = (f64::INFINITY, (1e-6, None));
    for (low, high) in spans {
        if low - end > widest.0 {
            widest = (low - end, Some(0.5 * (low + end)));
        }
        end = if end.is_finite() { end.max(high) } else { high };
    }
    Ok(widest.1)
}
