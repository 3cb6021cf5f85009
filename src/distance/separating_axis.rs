//! A direction that separates two bodies, from one that did or nearly does: the verdict alone asks for no nearest points.
//!
//! Support vertices are climbed to; where the direction does not separate these it is mirrored at the plane between them (K.
//! Chung and W. Wang, "Quick collision detection of polytopes in virtual environments", 1996). A result proves itself: no
//! neighbour of a support vertex lies ahead, so neither does the body.

use crate::base::math::{Vector, divisor};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::lookup::{Plan, Table};
use crate::body::tables::tables;
use crate::distance::certificate::{Interval, interval, reciprocal_length};
use crate::placed::frame::{Body, Frame};
use crate::placed::voronoi::{Corner, Rule, VertexTest, test_vertex};

/// One query's memory for the next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// A vertex of each body, near those farthest towards the other.
    pub vertices: [u32; 2],
    /// In body 1's axes, from body 2 to body 1, about of unit length. Single precision does: any direction may separate.
    pub direction: [f32; 3],
}

/// The interval of the bodies' distance that their bounding spheres prove, for rigid poses of [simple](Polyhedron::simple)
/// bodies.
///
/// No point of R·P is farther from its centred origin than ρ(1 + 16u): |R|² ≤ 1 + 29u, see [`crate::placed::frame::RIGID_DEFECT`].
/// |Δ| is below `separation` by at most 16u of it: 8u that it was raised by, 2u of Δ, and the rounding of dot product and root.
/// Sums and differences err by 4u of the largest term; `tolerance` is 32u of both together.
#[inline(always)]
pub fn between_spheres<L: Lanes>(frame: &Frame<L>) -> Interval {
    Interval {
        lower: frame.separation - frame.size - frame.tolerance,
        upper: frame.separation + frame.size + frame.tolerance,
    }
}

/// Directions tried beyond the first; marching is better at the cases that they leave open.
const MOST_DIRECTIONS: u32 = 3;

/// The gap along an axis below which the search is given up, as a multiple of the distance of the bodies' origins. (Of plates and
/// long bodies that intersect now and then that saves a tenth to a quarter of a verdict's time at 20° and beyond; −1/10 to −1/6 do
/// about as well, and long bodies of 102 vertices take 5 % longer at 10° and 20°.)
const MUCH_OVERLAP: f64 = -0.125;

/// Vertices looked at before a climb is given up: from the last query's, and from those of the tables.
const LONGEST_CLIMBS: [u32; 2] = [4, 16];

/// A direction perpendicular to an edge or a face has several support vertices, of which none is clear: it is turned so far, in
/// radians at most.
pub const NUDGE: f64 = 1.0 / 32.0;

/// An axis on trial, and what it proves.
pub struct AxisTrial<L> {
    /// In the world, from body 2 to body 1.
    pub direction: L,
    /// The direction's reciprocal length.
    pub inverse: f64,
    /// The support vertices, if `is_clear`.
    pub vertices: [u32; 2],
    /// The interval of the bodies' distance: from the gap along the direction to the distance of the vertices.
    pub interval: Interval,
    /// The difference of the vertices.
    difference: L,
    /// Its length.
    pub distance: f64,
    /// Its part along the direction.
    gap: f64,
    /// Whether both climbs reached a vertex all of whose neighbours lie clearly behind.
    is_clear: bool,
    /// How many vertices have been looked at.
    pub steps: u32,
}

impl<L: Lanes> AxisTrial<L> {
    /// Tries an axis whose vertices the bodies have.
    #[inline(always)]
    pub fn of_axis(frame: &Frame<L>, axis: &Axis) -> AxisTrial<L> {
        let [x, y, z] = axis.direction;
        let direction = frame.bodies[0].rotate(&Vector::new(x.into(), y.into(), z.into()));
        AxisTrial::new(frame, direction, axis.vertices, 0, LONGEST_CLIMBS[0])
    }

    /// Tries a direction from vertices that are about its support vertices.
    #[inline(always)]
    pub fn along(frame: &Frame<L>, direction: L, vertices: [u32; 2]) -> AxisTrial<L> {
        AxisTrial::new(frame, direction, vertices, 0, LONGEST_CLIMBS[1])
    }

    /// Whether the bodies are proved disjoint.
    #[inline(always)]
    pub fn separates(&self) -> bool {
        self.is_clear & (self.interval.lower > 0.0)
    }

    /// Whether the bodies overlap so much along the axis that they mostly intersect, which no axis shows.
    #[inline(always)]
    fn overlaps_much(&self, frame: &Frame<L>) -> bool {
        self.is_clear & (self.gap < MUCH_OVERLAP * frame.separation)
    }

    #[inline(always)]
    fn new(frame: &Frame<L>, direction: L, mut vertices: [u32; 2], mut steps: u32, longest_climb: u32) -> AxisTrial<L> {
        let [body1, body2] = &frame.bodies;
        let square = direction.dot(direction);
        let inverse = reciprocal_length(square);
        // |RᵀU| ≤ 1.02|U|.
        let length = 1.02 * square.sqrt();
        let towards = [body1.rotate_back(direction).negate(), body2.rotate_back(direction)];
        let [climb1, climb2] = towards.map(|towards| AxisClimb { towards, length, longest: longest_climb });
        let is_clear =
            climb1.run(body1, &mut vertices[0], &mut steps) && climb2.run(body2, &mut vertices[1], &mut steps);
        let position1 = &body1.polyhedron.vertices[vertices[0] as usize].position;
        let position2 = &body2.polyhedron.vertices[vertices[1] as usize].position;
        let difference = frame.difference(position1, position2);
        let distance = difference.dot(difference).sqrt();
        let gap = direction.dot(difference) * inverse;
        let interval = interval(distance, gap, frame.difference_error(distance), 0.0, 0.0);
        AxisTrial { direction, inverse, vertices, interval, difference, distance, gap, is_clear, steps }
    }

    /// The next axis to try.
    #[inline(always)]
    pub fn next(&self, frame: &Frame<L>) -> AxisTrial<L> {
        let unit = self.direction.mul(L::splat(self.inverse));
        let direction = if self.is_clear {
            self.difference.negated_mul_add(L::splat(2.0 * self.gap / divisor(self.distance * self.distance)), unit)
        } else {
            self.difference.mul_add(L::splat(NUDGE / divisor(self.distance)), unit)
        };
        AxisTrial::new(frame, direction, self.vertices, self.steps, LONGEST_CLIMBS[1])
    }
}

/// The search where the last axis does not separate: from the line of the origins, and the vertices from the tables.
pub struct AxisSearch<'a, L> {
    /// The pair.
    pub frame: &'a Frame<'a, L>,
    /// The first trial, and where there is a better one the last.
    pub trial: AxisTrial<L>,
}

impl<L: Lanes> Work for AxisSearch<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run(&mut self) {
        let frame = self.frame;
        let direction = frame.bodies[0].offset.mul(L::splat(1.0 / divisor(frame.separation)));
        let vertices = farthest(frame, direction).unwrap_or(self.trial.vertices);
        self.trial = AxisTrial::new(frame, direction, vertices, self.trial.steps, LONGEST_CLIMBS[1]);
        for _ in 1..MOST_DIRECTIONS {
            if self.trial.separates() | self.trial.overlaps_much(frame) {
                return;
            }
            self.trial = self.trial.next(frame);
        }
    }
}

/// Vertices nearly farthest towards the other body, by the tables.
#[inline(always)]
fn farthest<L: Lanes>(frame: &Frame<L>, direction: L) -> Option<[u32; 2]> {
    let [body1, body2] = &frame.bodies;
    if !matches!(body1.polyhedron.lookup.plan, Plan::Shells { .. }) {
        return None;
    }
    match tables([body1.polyhedron, body2.polyhedron])? {
        [Table::Shells(table1), Table::Shells(table2)] => {
            let [x, y, z] = body1.rotate_back(direction).negate().to_vector().into();
            let vertex1 = table1.farthest([x as f32, y as f32, z as f32]);
            let [x, y, z] = body2.rotate_back(direction).to_vector().into();
            Some([vertex1, table2.farthest([x as f32, y as f32, z as f32])])
        }
        _ => None,
    }
}

/// A climb to a vertex all of whose neighbours lie clearly behind in a direction.
struct AxisClimb<L> {
    towards: L,
    /// At least that of the direction.
    length: f64,
    /// The most vertices to look at.
    longest: u32,
}

impl<L: Lanes> AxisClimb<L> {
    /// Climbs from a vertex; whether it reached such a one.
    #[inline(always)]
    fn run(&self, body: &Body<L>, vertex: &mut u32, steps: &mut u32) -> bool {
        for _ in 0..self.longest {
            *steps += 1;
            let Some(corner) = Corner::of(body.polyhedron, *vertex) else { return false };
            match test_vertex(Rule::Most, corner, self.towards, self.length, 0.0) {
                VertexTest::Strict => return true,
                VertexTest::Tied { .. } => return false,
                VertexTest::Leaves { head, .. } => *vertex = head,
            }
        }
        false
    }
}
