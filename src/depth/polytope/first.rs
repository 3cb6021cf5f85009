//! The first polytope of a pair: from supports in a few directions.

use super::planes::evaluate;
use super::storage::Polytope;
use super::support::{Support, rough_support, vertex_beyond};
use super::{PairRounding, SHORTEST_NORMAL, centre_of_differences};
use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::distance::enclosure::GENERIC;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;

/// How far the three sides of the bipyramid lean towards its tip, and how far where those are too few vertices. (Equatorial ones
/// leave 23 steps where the first leave 17.)
const LEANS: [f64; 2] = [1.4, 0.35];

/// Makes the first polytope. Returns the point inside from which to look at it; `None` where the differences are flat as far as
/// rounding lets one see.
#[inline(always)]
pub fn make<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    direction: Option<&Vector>,
    supports: &mut u32,
) -> Option<Vector> {
    let centre = centre_of_differences(frame);
    // Nearest is mostly the side on which the origin is.
    let away = -centre;
    let tip = match direction {
        Some(direction) => *direction,
        None if away.norm() > 1e-6 * frame.size => away,
        None => GENERIC,
    };
    for lean in LEANS {
        let is_there = bipyramid(frame, polytope, &tips_and_sides(&tip, lean), supports);
        let count = polytope.triangle_count;
        if is_there && evaluate::<L, V, T>(polytope, rounding, &centre, 0, count).height > rounding.plane {
            return Some(centre);
        }
    }
    tetrahedron(frame, polytope, rounding, &tip, supports)
}

/// Adds a vertex; whether it is a new one.
fn add<const V: usize, const T: usize>(polytope: &mut Polytope<V, T>, pair: VertexPair, position: [f64; 4]) -> bool {
    polytope.find(pair).is_none() && polytope.add_vertex(pair, position).is_some()
}

/// Directions to a bipyramid's three sides, which lean towards its upper tip, to its lower tip and to the upper one.
#[inline(always)]
fn tips_and_sides(tip: &Vector, lean: f64) -> [Vector; 5] {
    let tip = tip.normalize();
    let axis = if tip.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
    let side = tip.cross(&axis).normalize();
    let across = tip.cross(&side);
    let half_root = 0.75_f64.sqrt();
    let around = [side, side * -0.5 + across * half_root, side * -0.5 - across * half_root];
    let [a, b, c] = around.map(|direction| (direction + tip * lean).normalize());
    [a, b, c, -tip, tip]
}

/// Two tips and three vertices around the line between them; those and the lower tip where the upper one is among them. No if two
/// others are one.
#[inline(always)]
fn bipyramid<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    directions: &[Vector; 5],
    supports: &mut u32,
) -> bool {
    polytope.clear();
    let mut has_tip = true;
    for (place, direction) in directions.iter().enumerate() {
        *supports += 1;
        let (pair, position) = rough_support(frame, L::from_vector(direction), None);
        if !add(polytope, pair, position.to_array()) {
            if place < 4 {
                return false;
            }
            has_tip = false;
        }
    }
    for i in 0..3 {
        let (own, following) = (i as u8, ((i + 1) % 3) as u8);
        polytope.corners[i] = [3, following, own, 0];
        if has_tip {
            polytope.corners[3 + i] = [4, own, following, 0];
        }
    }
    if !has_tip {
        polytope.corners[3] = [0, 1, 2, 0];
    }
    polytope.triangle_count = if has_tip { 6 } else { 4 };
    true
}

/// Four differences far from each other, and their mean.
#[inline(always)]
fn tetrahedron<L: Lanes, const V: usize, const T: usize>(
    frame: &Frame<L>,
    polytope: &mut Polytope<V, T>,
    rounding: &PairRounding,
    tip: &Vector,
    supports: &mut u32,
) -> Option<Vector> {
    let mut both = |direction: &Vector| {
        *supports += 2;
        let direction = direction.normalize();
        [direction, -direction].map(|direction| vertex_beyond(frame, rounding, &direction, None))
    };
    let least = 4.0 * rounding.difference;
    let position = |found: &Support| Vector::new(found.position[0], found.position[1], found.position[2]);
    // A line …
    let axes = [*tip, Vector::x(), Vector::y(), Vector::z()];
    let ends = axes.iter().map(&mut both).find(|ends| (position(&ends[0]) - position(&ends[1])).norm() > least)?;
    let [first, second] = ends.map(|end| position(&end));
    let along = (second - first).normalize();
    // … a triangle …
    let mut axis = Vector::zeros();
    axis[along.iamin()] = 1.0;
    let across = along.cross(&axis).normalize();
    let off_line = |found: &Support| {
        let off = position(found) - first;
        (off - along * along.dot(&off)).norm()
    };
    let sides: [[Support; 2]; 2] = [both(&across), both(&along.cross(&across))];
    let third = sides.into_iter().flatten().reduce(|a, b| if off_line(&b) > off_line(&a) { b } else { a })?;
    if !(off_line(&third) > 2.0 * least) {
        return None;
    }
    let normal = (second - first).cross(&(position(&third) - first));
    if !(normal.norm() > SHORTEST_NORMAL) {
        return None;
    }
    // … and the vertex farthest from its plane.
    let normal = normal.normalize();
    let height = |found: &Support| normal.dot(&(position(found) - first));
    let [above, below] = both(&normal);
    let is_above = height(&above) >= -height(&below);
    let fourth = if is_above { above } else { below };
    if !(height(&fourth).abs() > 2.0 * least) {
        return None;
    }
    polytope.clear();
    for found in [&ends[0], &ends[1], &third, &fourth] {
        add(polytope, found.pair, found.position);
    }
    if polytope.vertex_count < 4 {
        return None;
    }
    let [y, z] = if is_above { [2, 1] } else { [1, 2] };
    let corners = [[0, y, z], [y, 0, 3], [z, y, 3], [0, z, 3]];
    for (own, [a, b, c]) in polytope.corners.iter_mut().zip(corners) {
        *own = [a, b, c, 0];
    }
    polytope.triangle_count = 4;
    let centre = (0..4).map(|vertex| polytope.position(vertex)).sum::<Vector>() * 0.25;
    (evaluate::<L, V, T>(polytope, rounding, &centre, 0, 4).height > 0.0).then_some(centre)
}
