//! Convex cells, the part of a surface in each, and their cutting by planes.

use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, push, with_capacity};
use crate::body::decomposition::solid::boundary::{ReflexEdge, SolidBoundary, area_vector};
use crate::body::decomposition::solid::surface_tree::SurfaceTree;

/// A point this close to a plane is on it; lengths are about 1, so that rounding of what was cut before is far less.
const ON_PLANE: f64 = 1e-11;
/// Whether a cell's corner is inside the body is asked this far towards the cell's middle: the surface may touch the corner.
const INWARD: f64 = 1e-9;

/// The points with n·x = d; n is of length 1.
#[derive(Debug, Clone, Copy)]
pub struct CuttingPlane {
    pub normal: Vector,
    pub height: f64,
}

impl CuttingPlane {
    pub fn through(point: &Vector, normal: Vector) -> CuttingPlane {
        CuttingPlane { normal, height: normal.dot(point) }
    }

    fn side(&self, point: &Vector) -> f64 {
        let side = self.normal.dot(point) - self.height;
        if side.abs() <= ON_PLANE { 0.0 } else { side }
    }
}

/// Where a segment from below to above meets the plane: the same point whichever its direction, as both polygons at it need.
fn crossing(a: (&Vector, f64), b: (&Vector, f64)) -> Vector {
    let key = |p: &Vector| [p.x, p.y, p.z];
    let (first, last) = if key(a.0) < key(b.0) { (a, b) } else { (b, a) };
    first.0 + (last.0 - first.0) * (first.1 / (first.1 - last.1))
}

/// A convex polygon of the surface, or a face of a cell.
#[derive(Debug, Clone)]
pub struct CellFacet {
    pub corners: Vec<Vector>,
    pub normal: Vector,
}

impl CellFacet {
    /// Appends the parts below and above a plane; a facet in the plane goes to the side on which the body is.
    fn cut(&self, plane: &CuttingPlane, parts: [&mut Vec<CellFacet>; 2]) -> Result<()> {
        let [below, above] = parts;
        let sides: Vec<f64> = collected(self.corners.iter().map(|p| plane.side(p)))?;
        let (is_below, is_above) = (sides.iter().any(|s| *s < 0.0), sides.iter().any(|s| *s > 0.0));
        if !(is_below && is_above) {
            let goes_above = is_above || !is_below && self.normal.dot(&plane.normal) < 0.0;
            return push(if goes_above { above } else { below }, self.clone());
        }
        let mut polygons = [with_capacity(sides.len() + 2)?, with_capacity(sides.len() + 2)?];
        for (i, (p, s)) in self.corners.iter().zip(&sides).enumerate() {
            let next = (i + 1) % sides.len();
            if *s <= 0.0 {
                push(&mut polygons[0], *p)?;
            }
            if *s >= 0.0 {
                push(&mut polygons[1], *p)?;
            }
            if s * sides[next] < 0.0 {
                let point = crossing((p, *s), (&self.corners[next], sides[next]));
                polygons.iter_mut().try_for_each(|polygon| push(polygon, point))?;
            }
        }
        for (corners, part) in polygons.into_iter().zip([below, above]) {
            if corners.len() >= 3 {
                push(part, CellFacet { corners, normal: self.normal })?;
            }
        }
        Ok(())
    }
}

/// A convex cell of space, with the part of the surface in it.
pub struct SolidCell {
    walls: Vec<CellFacet>,
    pub surface: Vec<CellFacet>,
    pub reflex: Vec<ReflexEdge>,
    /// Its corners in the body.
    inner_corners: Vec<Vector>,
}

impl SolidCell {
    /// A box around the whole surface, with room.
    pub fn around(surface: &SolidBoundary) -> Result<SolidCell> {
        let corner = |x: i32, y: i32, z: i32| Vector::new(f64::from(x), f64::from(y), f64::from(z)) * 2.0;
        let mut walls = with_capacity(6)?;
        for axis in 0..3 {
            for sign in [-1, 1] {
                let place = |u: i32, v: i32| {
                    let mut at = [sign; 3];
                    (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (u, v);
                    corner(at[0], at[1], at[2])
                };
                let corners = collected([place(-1, -1), place(1, -1), place(1, 1), place(-1, 1)])?;
                walls.push(CellFacet { corners, normal: Vector::ith(axis, f64::from(sign)) });
            }
        }
        let mut facets = with_capacity(surface.triangles.len())?;
        for triangle in &surface.triangles {
            let corners = collected(triangle.iter().copied())?;
            facets.push(CellFacet { corners, normal: area_vector(triangle).normalize() });
        }
        let reflex = collected(surface.reflex.iter().copied())?;
        Ok(SolidCell { walls, surface: facets, reflex, inner_corners: Vec::new() })
    }

    /// The points whose hull is that of the body in the cell.
    pub fn points(&self) -> Result<Vec<Vector>> {
        let corners = self.surface.iter().flat_map(|facet| facet.corners.iter());
        collected(corners.chain(&self.inner_corners).copied())
    }

    /// The points as by [`SolidCell::points`] of both parts; what lies in the plane is in both.
    pub fn split_points(&self, plane: &CuttingPlane, tree: &SurfaceTree) -> Result<[Vec<Vector>; 2]> {
        let mut points = [Vec::new(), Vec::new()];
        let mut sides = Vec::new();
        for facet in &self.surface {
            sides.clear();
            extend(&mut sides, facet.corners.iter().map(|p| plane.side(p)))?;
            let flat_above = self.lies_above(facet, plane, &sides);
            for (i, (p, s)) in facet.corners.iter().zip(&sides).enumerate() {
                let next = (i + 1) % sides.len();
                match flat_above {
                    Some(above) => push(&mut points[usize::from(above)], *p)?,
                    None => {
                        if *s <= 0.0 {
                            push(&mut points[0], *p)?;
                        }
                        if *s >= 0.0 {
                            push(&mut points[1], *p)?;
                        }
                        if s * sides[next] < 0.0 {
                            let point = crossing((p, *s), (&facet.corners[next], sides[next]));
                            points.iter_mut().try_for_each(|points| push(points, point))?;
                        }
                    }
                }
            }
        }
        for p in &self.inner_corners {
            push(&mut points[usize::from(plane.side(p) > 0.0)], *p)?;
        }
        let section = self.section(plane)?;
        for p in inner(&section, tree)? {
            points.iter_mut().try_for_each(|points| push(points, p))?;
        }
        Ok(points)
    }

    /// Whether all of a facet is on one side, and which.
    fn lies_above(&self, facet: &CellFacet, plane: &CuttingPlane, sides: &[f64]) -> Option<bool> {
        let (is_below, is_above) = (sides.iter().any(|s| *s < 0.0), sides.iter().any(|s| *s > 0.0));
        match (is_below, is_above) {
            (true, true) => None,
            (false, false) => Some(facet.normal.dot(&plane.normal) < 0.0),
            (_, above) => Some(above),
        }
    }

    /// The number of concave edges of both parts, relative to the cell's: an edge in the plane is gone, one across it counts twice.
    pub fn reflex_share(&self, plane: &CuttingPlane) -> f64 {
        let count = |edge: &ReflexEdge| {
            let sides = edge.ends.map(|p| plane.side(&p));
            usize::from(sides[0] < 0.0 || sides[1] < 0.0) + usize::from(sides[0] > 0.0 || sides[1] > 0.0)
        };
        self.reflex.iter().map(count).sum::<usize>() as f64 / self.reflex.len().max(1) as f64
    }

    /// The corners of the cell's section with a plane.
    fn section(&self, plane: &CuttingPlane) -> Result<Vec<Vector>> {
        let mut section = Vec::new();
        for wall in &self.walls {
            for (i, p) in wall.corners.iter().enumerate() {
                let next = &wall.corners[(i + 1) % wall.corners.len()];
                let sides = [plane.side(p), plane.side(next)];
                if sides[0] == 0.0 {
                    push(&mut section, *p)?;
                } else if sides[0] * sides[1] < 0.0 {
                    push(&mut section, crossing((p, sides[0]), (next, sides[1])))?;
                }
            }
        }
        unique(&mut section);
        Ok(section)
    }

    /// Both parts.
    pub fn cut(&self, plane: &CuttingPlane, tree: &SurfaceTree) -> Result<[SolidCell; 2]> {
        let (mut surface, mut walls) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
        for facet in &self.surface {
            let [below, above] = &mut surface;
            facet.cut(plane, [below, above])?;
        }
        for wall in &self.walls {
            let [below, above] = &mut walls;
            wall.cut(plane, [below, above])?;
        }
        let cap = around(self.section(plane)?, &plane.normal);
        let mut reflex = [Vec::new(), Vec::new()];
        for edge in &self.reflex {
            let sides = edge.ends.map(|p| plane.side(&p));
            let mut parts = [edge.ends; 2];
            if sides[0] * sides[1] < 0.0 {
                let at = crossing((&edge.ends[0], sides[0]), (&edge.ends[1], sides[1]));
                (parts[0][usize::from(sides[0] < 0.0)], parts[1][usize::from(sides[0] > 0.0)]) = (at, at);
            }
            for (part, ends) in parts.into_iter().enumerate() {
                // An edge in the plane is in neither part: the cut took it away.
                if if part == 0 { sides.iter().any(|s| *s < 0.0) } else { sides.iter().any(|s| *s > 0.0) } {
                    push(&mut reflex[part], ReflexEdge { ends, ..*edge })?;
                }
            }
        }
        let [below, above] = surface;
        let [walls_below, walls_above] = walls;
        let [reflex_below, reflex_above] = reflex;
        let mut parts = [
            SolidCell { walls: walls_below, surface: below, reflex: reflex_below, inner_corners: Vec::new() },
            SolidCell { walls: walls_above, surface: above, reflex: reflex_above, inner_corners: Vec::new() },
        ];
        for (part, normal) in parts.iter_mut().zip([plane.normal, -plane.normal]) {
            push(&mut part.walls, CellFacet { corners: cap.clone(), normal })?;
            let mut corners = collected(part.walls.iter().flat_map(|wall| wall.corners.iter().copied()))?;
            unique(&mut corners);
            part.inner_corners = inner(&corners, tree)?;
        }
        Ok(parts)
    }
}

/// Those in the body, which is asked a little towards their middle.
fn inner(corners: &[Vector], tree: &SurfaceTree) -> Result<Vec<Vector>> {
    let middle = corners.iter().sum::<Vector>() / corners.len().max(1) as f64;
    collected(corners.iter().filter(|p| tree.winds_around(&(**p + (middle - **p) * INWARD))).copied())
}

fn unique(points: &mut Vec<Vector>) {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z)));
    points.dedup();
}

/// The corners of a convex polygon in their order around it.
fn around(mut corners: Vec<Vector>, normal: &Vector) -> Vec<Vector> {
    let middle = corners.iter().sum::<Vector>() / corners.len().max(1) as f64;
    let Some(first) = corners.first().map(|p| p - middle) else { return corners };
    let side = normal.cross(&first);
    // Grows with the angle from the first corner on, from 0 to 4.
    let turn = |p: &Vector| {
        let (x, y) = ((p - middle).dot(&first), (p - middle).dot(&side));
        let length = x.abs() + y.abs();
        if y >= 0.0 { 1.0 - x / length } else { 3.0 + x / length }
    };
    corners.sort_unstable_by(|a, b| turn(a).total_cmp(&turn(b)));
    corners
}
