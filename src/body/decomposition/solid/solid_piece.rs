//! Pieces, and how far their hulls are from the body.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, push};
use crate::base::progress::Progress;
use crate::body::build::hull::convex_hull;
use crate::body::decomposition::solid::cell::{CellFacet, CuttingPlane};
use crate::body::decomposition::solid::surface_tree::SurfaceTree;

/// A plane cuts off what is higher above it than this: rounding of heights is far less, as lengths are about 1.
const ON_PLANE: f64 = 1e-12;
/// What is thinner than this has no volume: rounding of a cut makes such flakes.
const FLAT: f64 = 1e-10;
/// Boxes of less than this part of the tolerance that are still open count as beyond it.
const FINEST: f64 = 1.0 / 8.0;

/// The hull of some points of the body.
pub struct SolidPiece {
    /// Its corners.
    pub corners: Vec<Vector>,
    triangles: Vec<[Vector; 3]>,
    planes: Vec<CuttingPlane>,
    pub low: Vector,
    pub high: Vector,
    pub volume: f64,
}

/// What a piece is compared with.
pub struct BodyCheck<'a> {
    pub tree: &'a SurfaceTree,
    /// How far from the body a point of a piece may be.
    pub tolerance: f64,
    /// The work that is done, of 2³⁰.
    pub done: usize,
}

/// All of the work.
pub const ALL: usize = 1 << 30;

impl SolidPiece {
    /// `None` where the points are in a plane, up to rounding.
    pub fn new(points: &[Vector]) -> Result<Option<SolidPiece>> {
        if points.len() < 4 {
            return Ok(None);
        }
        let hull = convex_hull(points)?;
        if hull.dimension < 3 {
            return Ok(None);
        }
        let corners: Vec<Vector> = collected(hull.vertices.iter().map(|v| points[*v as usize]))?;
        let triangles: Vec<[Vector; 3]> = collected(hull.triangles.iter().map(|t| t.map(|v| points[v as usize])))?;
        let mut planes: Vec<CuttingPlane> = Vec::new();
        let (mut volume, origin) = (0.0, corners[0]);
        for [a, b, c] in &triangles {
            let area = (b - a).cross(&(c - a));
            volume += area.dot(&(a - origin)) / 6.0;
            // Of thin triangles the normal is rough: through the farthest corner, all of the hull is below it all the same.
            let normal = area / area.norm();
            let height = corners.iter().map(|p| normal.dot(p)).fold(f64::NEG_INFINITY, f64::max);
            let plane = CuttingPlane { normal, height };
            let is_new = |other: &CuttingPlane| !((other.normal - plane.normal).norm_squared() < 1e-20);
            if area.norm() > 1e-18 && planes.last().is_none_or(is_new) {
                push(&mut planes, plane)?;
            }
        }
        let depth = |plane: &CuttingPlane| {
            corners.iter().map(|p| plane.height - plane.normal.dot(p)).fold(f64::NEG_INFINITY, f64::max)
        };
        if planes.iter().any(|plane| depth(plane) < FLAT) {
            return Ok(None);
        }
        let low = corners.iter().fold(corners[0], |low, p| low.inf(p));
        let high = corners.iter().fold(corners[0], |high, p| high.sup(p));
        Ok(Some(SolidPiece { corners, triangles, planes, low, high, volume }))
    }

    /// Whether the surface in it lies on its hull and its middle is in the body: then it is the body there.
    pub fn is_bounded_by(&self, surface: &[CellFacet], tree: &SurfaceTree) -> bool {
        let middle = self.corners.iter().sum::<Vector>() / self.corners.len() as f64;
        tree.winds_around(&middle)
            && surface.iter().all(|facet| {
                let is_on =
                    |plane: &CuttingPlane| facet.corners.iter().all(|p| plane.height - plane.normal.dot(p) <= FLAT);
                self.planes.iter().any(is_on)
            })
    }

    fn holds_box(&self, centre: &Vector, half: &Vector) -> bool {
        self.planes.iter().all(|plane| plane.normal.dot(centre) + plane.normal.abs().dot(half) <= plane.height)
    }

    pub fn holds(&self, point: &Vector) -> bool {
        self.planes.iter().all(|plane| plane.normal.dot(point) <= plane.height)
    }
}

/// A box that a hull may pass through.
#[derive(Debug, Clone, Copy)]
struct HullPart {
    centre: Vector,
    half: Vector,
    /// A triangle of the surface next to it, as a rule.
    near: u32,
    cutting: usize,
}

impl HullPart {
    /// Puts the planes that may cut the box first, and counts them; `None` where it is above one.
    fn sort_planes(&self, planes: &mut [CuttingPlane]) -> Option<usize> {
        let (mut cutting, mut k) = (self.cutting, 0);
        while k < cutting {
            let height = planes[k].normal.dot(&self.centre) - planes[k].height;
            let reach = planes[k].normal.abs().dot(&self.half);
            if height > reach {
                return None;
            }
            if height < -reach {
                cutting -= 1;
                planes.swap(k, cutting);
            } else {
                k += 1;
            }
        }
        Some(cutting)
    }
}

impl BodyCheck<'_> {
    /// A point of the piece that is farther from the body than the tolerance, or is less than an eighth of it nearer. `None`: no
    /// point of the piece is farther. The distance changes by no more than the point moves: that decides for whole boxes. What is
    /// in a piece of `known` is known to be within the tolerance.
    pub fn point_beyond(
        &self,
        piece: &SolidPiece,
        known: &[&SolidPiece],
        progress: &mut Progress,
    ) -> Result<Option<Vector>> {
        // Of a union any point will do, of a piece to be cut the worst is sought.
        if let Some(point) = self.sample_beyond(piece, !known.is_empty(), progress)? {
            return Ok(Some(point));
        }
        // A plane above all of a box is above its parts: the planes that may cut a box are the first `cutting` ones.
        let mut planes = copied(&piece.planes)?;
        let start = HullPart {
            centre: 0.5 * (piece.low + piece.high),
            half: 0.5 * (piece.high - piece.low),
            near: 0,
            cutting: planes.len(),
        };
        let mut open = collected([start])?;
        while let Some(part) = open.pop() {
            progress.steps(4, self.done, ALL)?;
            let HullPart { centre, half, mut near, .. } = part;
            let Some(cutting) = part.sort_planes(&mut planes) else { continue };
            if known.iter().any(|known| known.holds_box(&centre, &half)) {
                continue;
            }
            let radius = half.norm();
            let distance = self.tree.distance_within(&centre, self.tolerance - radius, &mut near);
            if distance + radius <= self.tolerance || self.is_near(&part, &planes[..cutting], near) {
                continue;
            }
            let is_decided = distance >= radius || radius <= self.tolerance;
            if is_decided && self.tree.winds_around(&centre) {
                continue;
            }
            let is_beyond = distance > self.tolerance
                && planes[..cutting].iter().all(|plane| plane.normal.dot(&centre) <= plane.height)
                && (is_decided || !self.tree.winds_around(&centre));
            if is_beyond || radius <= FINEST * self.tolerance {
                return Ok(Some(centre));
            }
            let axis = half.imax();
            let mut smaller = half;
            smaller[axis] *= 0.5;
            for sign in [-1.0, 1.0] {
                let mut moved = centre;
                moved[axis] += sign * smaller[axis];
                push(&mut open, HullPart { centre: moved, half: smaller, near, cutting })?;
            }
        }
        Ok(None)
    }

    /// A point of the hull's triangles beyond the tolerance: the worst of some, or `any`.
    fn sample_beyond(&self, piece: &SolidPiece, any: bool, progress: &mut Progress) -> Result<Option<Vector>> {
        let (mut worst, mut found, mut near) = (self.tolerance, None, 0);
        for [a, b, c] in &piece.triangles {
            progress.steps(16, self.done, ALL)?;
            let middle = (a + b + c) / 3.0;
            for point in [middle, 0.5 * (a + b), 0.5 * (a + middle), 0.5 * (b + middle), 0.5 * (c + middle)] {
                // What is no farther than the worst needs no winding number.
                let distance = self.tree.distance_within(&point, worst, &mut near);
                if distance > worst && !self.tree.winds_around(&point) {
                    (worst, found) = (distance, Some(point));
                }
            }
            if any && found.is_some() {
                break;
            }
        }
        Ok(found)
    }

    /// Whether a triangle is within the tolerance of the part of a box that is below a plane: the one that the box reaches farthest
    /// above. The distance from a triangle is a convex function, so it is greatest at a corner of that part.
    fn is_near(&self, part: &HullPart, planes: &[CuttingPlane], near: u32) -> bool {
        let is_near = |point: &Vector| self.tree.is_near(point, self.tolerance, near);
        let corner = |k: usize| {
            let sign = |axis: usize| if k >> axis & 1 == 0 { -1.0 } else { 1.0 };
            part.centre + part.half.component_mul(&Vector::new(sign(0), sign(1), sign(2)))
        };
        let corners: [Vector; 8] = std::array::from_fn(corner);
        let top =
            |plane: &CuttingPlane| plane.normal.dot(&part.centre) + plane.normal.abs().dot(&part.half) - plane.height;
        let Some(plane) = planes.iter().max_by(|a, b| top(a).total_cmp(&top(b))) else {
            return corners.iter().all(is_near);
        };
        let heights = corners.map(|p| plane.normal.dot(&p) - plane.height - ON_PLANE);
        (0..8).all(|k| {
            let crossing = |other: usize| {
                let place = heights[k] / (heights[k] - heights[other]);
                corners[k] + (corners[other] - corners[k]) * place
            };
            let mut cut =
                [k | 1, k | 2, k | 4].into_iter().filter(|other| (heights[k] < 0.0) != (heights[*other] < 0.0));
            (heights[k] > 0.0 || is_near(&corners[k])) && cut.all(|other| is_near(&crossing(other)))
        })
    }
}
