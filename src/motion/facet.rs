//! Contact shown by the facet of the difference that was touched: three pairs of vertices that tie along the last normal, and the
//! pair farthest behind them.

use super::enclosed_ball::EnclosedBall;
use super::gap::Heights;
use super::moving::Moment;
use crate::base::math::{Pose, Vector};
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::{NONE, Polyhedron};
use crate::placed::Pair;
use crate::placed::exact::VertexPair;

/// Most vertices of a body that may tie, and most pairs of them, of which all threes are tried: a quad with an edge makes 8.
const MOST_TIED: usize = 6;
const MOST_PAIRS: usize = 12;

/// Vertices tie that are lower by less than this part of both radii: the normal comes from a moment before contact, and is rounded.
const TIE: f64 = 1e-9;

/// Bodies whose search costs more than a verdict.
const MOST_VERTICES: usize = 4096;

/// Two bodies about to touch.
pub(super) struct Touch<'a> {
    pub polyhedra: [&'a Polyhedron; 2],
    /// The last moment at which they were apart, along this direction from body 2 to body 1.
    pub here: &'a Moment,
    pub direction: &'a Vector,
    /// A moment at which they may overlap.
    pub there: &'a Moment,
}

impl Touch<'_> {
    /// Pairs whose differences hold a ball around the origin, and its radius: the overlap is at least as deep. How the pairs are
    /// found proves nothing.
    pub fn enclosure(&self) -> Option<([VertexPair; 4], f64)> {
        let pairs = self.pairs()?;
        let poses = [&self.there.poses[0], &self.there.poses[1]];
        Some((pairs, EnclosedBall { pair: Pair { polyhedra: self.polyhedra, poses }, pairs: &pairs }.radius()))
    }

    fn pairs(&self) -> Option<[VertexPair; 4]> {
        let [body1, body2] = self.polyhedra;
        if body1.vertices.len().max(body2.vertices.len()) > MOST_VERTICES {
            return None;
        }
        let [pose1, pose2] = &self.here.poses;
        let towards = [-pose1.rotate_back(self.direction), pose2.rotate_back(self.direction)];
        let tie = TIE * (body1.radius + body2.radius);
        let mut search = TieSearch { polyhedra: self.polyhedra, towards, tie, found: [Tied::default(); 4] };
        simd::dispatch(&mut search);
        let [tied1, tied2, behind1, behind2] = search.found;
        let (tied1, tied2) = (tied1.vertices()?, tied2.vertices()?);
        let behind = [behind1.first, behind2.first];
        let count = tied1.len() * tied2.len();
        if !(3..=MOST_PAIRS).contains(&count) || behind.contains(&NONE) {
            return None;
        }
        let (mut pairs, mut points) = ([[0; 2]; MOST_PAIRS], [Vector::zeros(); MOST_PAIRS]);
        let [there1, there2] = &self.there.poses;
        let apart = there1.transform(&body1.centre) - there2.transform(&body2.centre);
        for (i, &v) in tied1.iter().enumerate() {
            let first = apart + rotated(there1, body1, v);
            for (j, &w) in tied2.iter().enumerate() {
                pairs[i * tied2.len() + j] = [v, w];
                points[i * tied2.len() + j] = first - rotated(there2, body2, w);
            }
        }
        let flat = 1e-12 * body1.radius * body2.radius;
        deepest(&points[..count], self.direction, flat).map(|[p, q, r]| [pairs[p], pairs[q], pairs[r], behind])
    }
}

fn rotated(pose: &Pose, polyhedron: &Polyhedron, vertex: u32) -> Vector {
    pose.rotate(&polyhedron.vertices[vertex as usize].position)
}

/// The triangle of points in which the origin is deepest, seen along a direction; of an area above `flat`.
fn deepest(points: &[Vector], direction: &Vector, flat: f64) -> Option<[usize; 3]> {
    let (mut best, mut most) = (None, 0.0);
    for (i, p) in points.iter().enumerate() {
        for (j, q) in points.iter().enumerate().skip(i + 1) {
            let along = direction.dot(&p.cross(q));
            for (k, r) in points.iter().enumerate().skip(j + 1) {
                // The areas of the parts opposite the three corners.
                let parts = [direction.dot(&q.cross(r)), direction.dot(&r.cross(p)), along];
                let area = parts[0] + parts[1] + parts[2];
                if area.abs() > flat {
                    let least = parts.iter().map(|part| part / area).fold(f64::INFINITY, f64::min);
                    if least > most {
                        (best, most) = (Some([i, j, k]), least);
                    }
                }
            }
        }
    }
    best
}

/// Vertices about farthest along a direction.
#[derive(Clone, Copy)]
struct Tied {
    vertices: [u32; MOST_TIED],
    /// How many there are; more than there is room for are not kept.
    count: usize,
    /// The first of them.
    first: u32,
}

impl Default for Tied {
    fn default() -> Tied {
        Tied { vertices: [NONE; MOST_TIED], count: 0, first: NONE }
    }
}

impl Tied {
    fn vertices(&self) -> Option<&[u32]> {
        self.vertices.get(..self.count)
    }

    #[inline(always)]
    fn add(&mut self, vertex: u32) {
        if self.count == 0 {
            self.first = vertex;
        }
        if let Some(place) = self.vertices.get_mut(self.count) {
            *place = vertex;
        }
        self.count += 1;
    }
}

/// The vertices that tie towards the other body, of both, and then those farthest from it.
struct TieSearch<'a> {
    polyhedra: [&'a Polyhedron; 2],
    towards: [Vector; 2],
    tie: f64,
    found: [Tied; 4],
}

impl Kernel for TieSearch<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        for (i, polyhedron) in self.polyhedra.into_iter().enumerate() {
            let towards = self.towards[i];
            self.found[i] = tied::<L>(polyhedron, &towards, self.tie);
            self.found[2 + i] = tied::<L>(polyhedron, &-towards, 0.0);
        }
    }
}

/// The vertices less than `tie` below the farthest. A NaN finds none.
#[inline(always)]
fn tied<L: Lanes>(polyhedron: &Polyhedron, direction: &Vector, tie: f64) -> Tied {
    let mut found = Tied::default();
    let count = polyhedron.vertices.len() as u32;
    if polyhedron.vertex_blocks.is_empty() {
        let height = |v: u32| direction.dot(&polyhedron.vertices[v as usize].position);
        let least = (0..count).map(height).fold(f64::NEG_INFINITY, f64::max) - tie;
        (0..count).filter(|v| height(*v) >= least).for_each(|v| found.add(v));
        return found;
    }
    let heights = Heights::<L>::new(direction);
    let least = L::splat(heights.farthest(polyhedron) - tie);
    for (block, vertices) in (0..).zip(&polyhedron.vertex_blocks) {
        let mut bits = least.at_most(heights.of(vertices));
        while bits != 0 {
            let vertex = 4 * block + bits.trailing_zeros();
            // The last block repeats its last vertex.
            if vertex < count {
                found.add(vertex);
            }
            bits &= bits - 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Shape, ShapeOptions};

    fn cube() -> Shape {
        let corner =
            |k: u32| Vector::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) - Vector::repeat(0.5);
        Shape::from_points(&(0..8).map(corner).collect::<Vec<_>>(), &ShapeOptions::default()).unwrap()
    }

    /// A corner of one cube goes 1e-3 into the top face of another: a ball of no more than that is found, and not much less.
    #[test]
    fn a_corner_in_a_face_is_shown_by_four_pairs() {
        let (cube, axis) = (cube(), Vector::new(1.0, 1.0, 1.0).normalize());
        // The diagonal of the first cube stands upright.
        let across = axis.cross(&Vector::z()).normalize();
        let upright = crate::base::math::Matrix::from_rows(&[
            across.transpose(),
            axis.cross(&across).transpose(),
            axis.transpose(),
        ]);
        let at = |depth: f64| Moment {
            time: 0.0,
            poses: [Pose::new(&upright, &Vector::new(0.1, 0.2, 0.5 + 0.75_f64.sqrt() - depth)), Pose::IDENTITY],
            rounding: 0.0,
        };
        let polyhedra = [cube.polyhedron(), cube.polyhedron()];
        let (here, direction) = (at(-1e-6), Vector::z());
        let ball = |depth: f64| {
            Touch { polyhedra, here: &here, direction: &direction, there: &at(depth) }.enclosure().map(|(_, ball)| ball)
        };
        let ball_inside = ball(1e-3).unwrap();
        assert!(ball_inside <= 1e-3 && ball_inside > 0.99e-3, "{ball_inside:e}");
        // Above the face nothing is held.
        assert_eq!(ball(-1e-3), Some(0.0));
    }
}
