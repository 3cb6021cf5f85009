//! Sides of a face with many of them, by bisection: a look at each would make marching along its boundary quadratic.
//!
//! Like all of marching it proposes: rounding may lead it one side astray, and no answer rests on that.

use crate::base::math::Vector;
use crate::body::polyhedron::{MergedFace, Polyhedron};

/// Sides from which on bisection is faster than a look at all; it takes some forty products for each doubling.
pub const MANY_SIDES: u32 = 128;

/// Shortenings of a way before it is taken as it is; each brings its end as much nearer as a step of Newton's iteration.
const MOST_SHORTENINGS: u32 = 32;

/// The side of a face whose plane a point violates most, if any is violated by more than the tolerance.
#[inline(never)]
pub fn most_violated_side(polyhedron: &Polyhedron, face: &MergedFace, point: &Vector, tolerance: f64) -> Option<u32> {
    let polygon = SidePolygon::new(polyhedron, face);
    let side = polygon.side_towards(point);
    if polygon.value(side, point) >= 0.0 {
        return None;
    }
    let side = polygon.most_violated_from(side, point);
    (polygon.value(side, point) < -tolerance).then_some(side)
}

/// The point where the way from a point inside a face's prism to another leaves it: the fraction of the way and the side, or (1,
/// None). `skip` is an edge whose side does not count.
#[inline(never)]
pub fn exit_of_prism(
    polyhedron: &Polyhedron,
    face: &MergedFace,
    [from, to]: [&Vector; 2],
    skip: u32,
) -> (f64, Option<u32>) {
    let polygon = SidePolygon::new(polyhedron, face);
    let mut exit = (1.0, None);
    // Every side that the end of the way lies beyond shortens it; the last one that does is where it leaves.
    for _ in 0..MOST_SHORTENINGS {
        let end = from + (to - from) * exit.0;
        let side = polygon.side_towards(&end);
        if polygon.value(side, &end) >= 0.0 || polygon.edge(side) == skip {
            break;
        }
        let start = polygon.value(side, from).max(0.0);
        let fraction = start / (start - polygon.value(side, to));
        // False for a NaN, too.
        if !(fraction < exit.0) {
            break;
        }
        exit = (fraction, Some(side));
    }
    exit
}

/// A face seen as a polygon, its corners counter-clockwise about a point inside.
struct SidePolygon<'a> {
    polyhedron: &'a Polyhedron,
    face: &'a MergedFace,
    centre: Vector,
    /// From the centre to the end of the last side.
    first: Vector,
}

impl<'a> SidePolygon<'a> {
    fn new(polyhedron: &'a Polyhedron, face: &'a MergedFace) -> SidePolygon<'a> {
        let mut polygon = SidePolygon { polyhedron, face, centre: Vector::zeros(), first: Vector::zeros() };
        let count = face.side_count;
        let corners = [count - 1, count / 3, 2 * count / 3].map(|side| polygon.spoke(side));
        polygon.centre = (corners[0] + corners[1] + corners[2]) / 3.0;
        polygon.first = corners[0] - polygon.centre;
        polygon
    }

    fn edge(&self, side: u32) -> u32 {
        self.polyhedron.sides[(self.face.first_side + side) as usize]
    }

    /// From the centre to the corner where a side ends and the next begins.
    fn spoke(&self, side: u32) -> Vector {
        let next = if side + 1 == self.face.side_count { 0 } else { side + 1 };
        let [edge, next] = [side, next].map(|side| &self.polyhedron.edges[self.edge(side) as usize]);
        let corner = if edge.head() == next.tail() || edge.head() == next.head() { edge.head() } else { edge.tail() };
        self.polyhedron.vertices[corner as usize].position - self.centre
    }

    /// The plane of a side at a point, positive inside.
    fn value(&self, side: u32, point: &Vector) -> f64 {
        match side as usize {
            i @ 0..3 => self.face.planes.value(1 + i, point),
            i => {
                let block = self.face.first_more as usize + (i - 3) / 4;
                self.polyhedron.more_sides[block].value((i - 3) % 4, point)
            }
        }
    }

    /// The side that the ray from the centre to over a point leaves the polygon by.
    fn side_towards(&self, point: &Vector) -> u32 {
        let towards = point - self.centre;
        // Counter-clockwise of a by less than half a turn.
        let is_left = |a: &Vector, b: &Vector| self.face.normal.dot(&a.cross(b)) > 0.0;
        let in_first_half = is_left(&self.first, &towards);
        // The corner at the end of side `low` − 1 is not past the ray, that of `high` is.
        let (mut low, mut high) = (0, self.face.side_count - 1);
        while low < high {
            let middle = low + (high - low) / 2;
            let corner = self.spoke(middle);
            let is_past = match (is_left(&self.first, &corner), in_first_half) {
                (false, true) => true,
                (true, false) => false,
                _ => is_left(&towards, &corner),
            };
            (low, high) = if is_past { (low, middle) } else { (middle + 1, high) };
        }
        low
    }

    /// Descends to the side whose plane a point violates most: over the sides in turn, where they are violated, the value is a
    /// convex function of their angle.
    fn most_violated_from(&self, start: u32, point: &Vector) -> u32 {
        let count = self.face.side_count;
        let (mut side, mut least) = (start, self.value(start, point));
        let mut stride = count / 4;
        while stride > 0 {
            let neighbours = [side + stride, side + count - stride].map(|other| other % count);
            let better = neighbours.into_iter().find(|&other| self.value(other, point) < least);
            match better {
                Some(other) => (side, least) = (other, self.value(other, point)),
                None => stride /= 2,
            }
        }
        side
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::build::assembly::build;
    use crate::body::polyhedron::NONE;

    /// A prism over an ellipse of half axes 1 and `width`, its corners unevenly spread.
    fn prism(sides: usize, width: f64) -> Polyhedron {
        let corner = |i: usize| {
            let part = i as f64 / sides as f64;
            let angle = std::f64::consts::TAU * (part + 0.12 * (std::f64::consts::TAU * part).sin());
            [0.0, 1.0].map(|z| Vector::new(angle.cos(), width * angle.sin(), z))
        };
        build(&(0..sides).flat_map(corner).collect::<Vec<_>>(), None).unwrap()
    }

    fn values(polygon: &SidePolygon, point: &Vector) -> Vec<f64> {
        (0..polygon.face.side_count).map(|side| polygon.value(side, point)).collect()
    }

    /// Points in and around the unit square, dyadic and irregular.
    fn points() -> impl Iterator<Item = Vector> {
        (1..if cfg!(miri) { 40 } else { 400 }).map(|k: i32| {
            let part = |step: f64| 3.0 * (f64::from(k) * step).fract() - 1.5;
            Vector::new(part(0.618_033_988), part(0.414_213_562), part(0.732_050_807))
        })
    }

    #[test]
    fn bisection_finds_what_a_look_at_all_sides_finds() {
        let prisms = [(128, 1.0), (1000, 1.0), (1001, 0.1), (500, 0.001), (5000, 0.01)];
        // Miri takes a thousand times as long.
        for &(sides, width) in if cfg!(miri) { &prisms[..1] } else { &prisms } {
            let polyhedron = prism(sides, width);
            let caps: Vec<&MergedFace> =
                polyhedron.faces.iter().filter(|face| face.side_count as usize == sides).collect();
            assert_eq!(caps.len(), 2);
            for face in caps {
                let polygon = SidePolygon::new(&polyhedron, face);
                let mut inside = Vec::new();
                for point in points().map(|p| Vector::new(p.x, p.y * width, p.z)) {
                    let values = values(&polygon, &point);
                    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                    let found = most_violated_side(&polyhedron, face, &point, 1e-15);
                    let expected = (least < -1e-15).then_some(least);
                    assert_eq!(found.map(|side| values[side as usize]), expected, "{sides} {width} {point:?}");
                    if expected.is_none() {
                        inside.push(point);
                    }
                }
                assert!(8 * inside.len() > points().count());
                for (from, to) in inside.iter().zip(points()) {
                    let (start, end) = (values(&polygon, from), values(&polygon, &to));
                    let fractions = start.iter().zip(&end).filter(|(_, e)| **e < 0.0).map(|(s, e)| s / (s - e));
                    let least = fractions.fold(1.0, f64::min);
                    let (fraction, side) = exit_of_prism(&polyhedron, face, [from, &to], NONE);
                    assert!((fraction - least).abs() <= 1e-12, "{sides} {width} {from:?} {to:?}: {fraction}, {least}");
                    assert_eq!(side.is_some(), least < 1.0);
                }
            }
        }
    }
}
