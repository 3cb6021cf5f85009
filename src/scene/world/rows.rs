//! The scene's data on a placed convex piece, one row of several arrays, and how it moves. Spheres, boxes and bounds of motion
//! err on the safe side.

use std::sync::Arc;

use crate::base::math::{Pose, ROTATION_LIMIT, UNIT_ROUNDOFF, Vector};
use crate::scene::world::boxes::{Aabb, above, below};
use crate::scene::world::object::ObjectId;
#[cfg(doc)]
use crate::scene::world::proxies::Proxies;
use crate::shape::Shape;

const U: f64 = UNIT_ROUNDOFF;

/// Rotations with no entry of RᵀR − I above this count as rigid in bounds of motion.
const RIGID: f64 = 16.0 * U;

/// A box leaves room for this many steps of motion …
const STEPS_OF_ROOM: f32 = 4.0;
/// … but no more than this part of the radius …
const MOST_ROOM: f32 = 0.5;
/// … and this part of it before the first step, which would otherwise leave the box.
const FIRST_ROOM: f32 = 0.04;

/// The limit of a piece that has no box yet, or none that leaves room.
const NO_BOX: f64 = f64::NEG_INFINITY;

/// Below this lengths are taken for nothing: their squares may underflow.
pub(crate) const TINY: f64 = 1e-150;

/// Balls about one centre: the piece is in the outer one, the inner one in the piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spheres {
    pub centre: [f64; 3],
    /// Radius, rounded up; of a row that is [behind](Proxies::settle) a NaN.
    pub outer: f32,
    /// Radius, rounded down; −∞ where there is none.
    pub inner: f32,
}

/// How a piece has moved.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowMotion {
    /// No point of the piece has travelled farther in all its moves.
    pub odometer: f64,
    /// While the odometer is not above this, the piece is in its box.
    pub limit: f64,
    /// The number of passes over the pairs before the last move.
    pub moved: u64,
    /// How far it goes in a step, smoothed, jumps left out; 0 before the first. The move to where it gets its first box is no
    /// step.
    rate: f32,
    /// No entry of RᵀR − I is above [`RIGID`].
    rigid: bool,
    /// Stands in the list of those that have left their boxes.
    pub has_escaped: bool,
}

impl RowMotion {
    /// The motion of a piece that has no box yet.
    pub fn new(rigid: bool) -> RowMotion {
        RowMotion { odometer: 0.0, limit: NO_BOX, moved: 0, rate: 0.0, rigid, has_escaped: false }
    }

    /// Whether the box has no end: however the piece moves, it does not leave it.
    pub fn is_everywhere(&self) -> bool {
        self.limit == f64::INFINITY
    }

    /// It may be out of its box; false if that was known.
    pub fn escape(&mut self) -> bool {
        !std::mem::replace(&mut self.has_escaped, true)
    }
}

/// The owner of a piece.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Label {
    /// Null: the piece is gone.
    pub object: ObjectId,
    pub user_data: u64,
    pub piece: u32,
    /// Two fixed ones are never tested.
    pub fixed: bool,
    /// See [`ObjectOptions`](crate::scene::world::object::ObjectOptions).
    pub groups: u32,
    pub mask: u32,
}

impl Spheres {
    /// Whether they are those of an earlier pose.
    pub fn are_behind(&self) -> bool {
        self.outer.is_nan()
    }
}

impl Label {
    pub fn is_gone(&self) -> bool {
        self.object == ObjectId::NULL
    }
}

/// Some rows next to each other: their holder may move their pieces.
pub(crate) struct Rows<'a> {
    /// The number of the first.
    pub first: usize,
    pub shapes: &'a [Arc<Shape>],
    pub labels: &'a [Label],
    pub poses: &'a mut [Pose],
    pub spheres: &'a mut [Spheres],
    pub motions: &'a mut [RowMotion],
    pub boxes: &'a mut [Aabb],
}

impl<'a> Rows<'a> {
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Those before a row, and those from it on.
    fn cut_at(self, proxy: usize) -> (Rows<'a>, Rows<'a>) {
        let at = proxy - self.first;
        let (shapes, shapes_behind) = self.shapes.split_at(at);
        let (labels, labels_behind) = self.labels.split_at(at);
        let (poses, poses_behind) = self.poses.split_at_mut(at);
        let (spheres, spheres_behind) = self.spheres.split_at_mut(at);
        let (motions, motions_behind) = self.motions.split_at_mut(at);
        let (boxes, boxes_behind) = self.boxes.split_at_mut(at);
        let behind = Rows {
            first: proxy,
            shapes: shapes_behind,
            labels: labels_behind,
            poses: poses_behind,
            spheres: spheres_behind,
            motions: motions_behind,
            boxes: boxes_behind,
        };
        (Rows { first: self.first, shapes, labels, poses, spheres, motions, boxes }, behind)
    }

    /// Those before the first of some rows, those from it and before the next, and so on, up to the last.
    pub fn cut_at_each(self, proxies: impl Iterator<Item = usize>) -> impl Iterator<Item = Rows<'a>> {
        let mut rest = Some(self);
        proxies.filter_map(move |proxy| {
            let (before, behind) = rest.take()?.cut_at(proxy);
            rest = Some(behind);
            Some(before)
        })
    }

    /// Puts a piece elsewhere. `defect`: that of the rotation. `passes`: how many times queries have looked at the pairs. True if
    /// it has just left its box.
    #[inline(always)]
    pub fn place(&mut self, proxy: usize, pose: &Pose, defect: f64, passes: u64) -> bool {
        let at = proxy - self.first;
        let old = self.poses[at];
        if old == *pose {
            return false;
        }
        self.poses[at] = *pose;
        self.motions[at].moved = passes;
        self.follow(proxy, &old, defect)
    }

    /// Spheres and motion of a piece that has come from another pose. `defect`: that of the rotation. True if it has just left its
    /// box.
    #[inline(always)]
    pub fn follow(&mut self, proxy: usize, old: &Pose, defect: f64) -> bool {
        let at = proxy - self.first;
        let (shape, pose) = (&self.shapes[at], &self.poses[at]);
        let lever = shape.extent().lever;
        let motion = &mut self.motions[at];
        let (spheres, rigid) = placed(shape, pose, defect);
        let way = way_bound(old, pose, lever, motion.rigid & rigid);
        motion.rigid = rigid;
        // Never below the exact sum; infinite sums mean that nothing is known.
        motion.odometer = (motion.odometer + way).next_up();
        motion.rate = match (motion.rate, way as f32) {
            _ if motion.limit == NO_BOX => 0.0,
            (rate, way) if rate == 0.0 || rate.max(way) > MOST_ROOM * spheres.outer => way,
            (rate, way) => 0.75 * rate + 0.25 * way,
        };
        self.spheres[at] = spheres;
        // An infinite odometer is above every limit but an infinite one, which only boxes without end have.
        motion.odometer > motion.limit && motion.escape()
    }

    /// Gives each piece that is there a new box, which two pieces share if they are `tolerance` apart or less.
    pub fn refit_all(&mut self, tolerance: f64) {
        for at in 0..self.len() {
            if !self.labels[at].is_gone() {
                self.refit(self.first + at, tolerance);
            }
        }
    }

    /// The same of one.
    pub fn refit(&mut self, proxy: usize, tolerance: f64) {
        let at = proxy - self.first;
        let motion = &mut self.motions[at];
        let outer = self.spheres[at].outer;
        let most = MOST_ROOM * outer;
        let can_move = !self.labels[at].fixed;
        let room = match motion.rate {
            0.0 if can_move => FIRST_ROOM * outer,
            rate if rate > most => 0.0,
            rate => (STEPS_OF_ROOM * rate).min(most),
        };
        let limit = motion.odometer + f64::from(room);
        // The limit is rounded: it, not the room, decides how far the piece may go. ∞ − ∞ is no room, and every move is then too
        // far.
        let room = (limit - motion.odometer).next_up();
        let is_counted = room < f64::INFINITY;
        let grown = 0.5 * tolerance + if is_counted { room } else { 0.0 };
        motion.limit = match (grown == f64::INFINITY, is_counted) {
            (true, _) => f64::INFINITY,
            (false, true) => limit,
            (false, false) => NO_BOX,
        };
        self.boxes[at] = grown_box(&self.shapes[at], &self.poses[at], &self.spheres[at], grown);
    }
}

/// A box around a placed shape and everything no farther from it than this; `spheres` are those of [`placed`].
pub(crate) fn grown_box(shape: &Shape, pose: &Pose, spheres: &Spheres, grown: f64) -> Aabb {
    let reach = shape.extent().reach(pose, spheres.outer.into());
    Aabb::around(spheres.centre, &reach, grown + centre_error(shape, pose) + shape.swept_radius() + shape.deviation())
}

/// Balls around and in a placed shape, and whether its rotation is rigid up to rounding.
///
/// With d the largest entry of |RᵀR − I|, the singular values of R are in [√(1 − 3d), √(1 + 3d)], which is within 2d of 1 for
/// d ≤ 1e-2; d as computed is off by at most 4u.
#[inline]
pub(crate) fn placed(shape: &Shape, pose: &Pose, defect: f64) -> (Spheres, bool) {
    debug_assert!((0.0..=ROTATION_LIMIT).contains(&defect));
    let polyhedron = shape.polyhedron();
    let stretch = 2.0 * (defect + 8.0 * U);
    let error = centre_error(shape, pose);
    let centre = if error > 0.0 { pose.transform(&polyhedron.centre) } else { pose.translation() };
    // A pose does not stretch the ball that is swept.
    let swept = shape.swept_radius();
    let outer = (polyhedron.radius * (1.0 + stretch) + error + swept + shape.deviation()) * (1.0 + 10.0 * U);
    let inner = (shape.extent().inner_radius * (1.0 - stretch) - error + swept) * (1.0 - 8.0 * U);
    (Spheres { centre: centre.into(), outer: above(outer), inner: below(inner) }, defect <= RIGID)
}

/// How far rounding may move a placed body's centre T + R·c: three products and three sums in each component.
fn centre_error(shape: &Shape, pose: &Pose) -> f64 {
    let centre = shape.polyhedron().centre;
    if centre == Vector::zeros() {
        return 0.0;
    }
    16.0 * U * (pose.translation().amax() + 2.0 * centre.amax()) + TINY
}

/// No point of a body within `lever` of its local origin travels farther than this: |ΔT| + ‖ΔR‖·lever, rounded up.
///
/// ‖ΔR‖ is at most the root of the sum of squares ‖ΔR‖_F; for rotations, whose difference has the singular values 2 sin θ/2, twice,
/// and 0, it is ‖ΔR‖_F/√2. Rotations within [`RIGID`] are within 24u of exact ones (in norm; 42u in ‖·‖_F), which costs less than
/// 2e-14.
fn way_bound(old: &Pose, new: &Pose, lever: f64, rigid: bool) -> f64 {
    debug_assert!(lever >= 0.0);
    let (mut turned, mut shifted) = (0.0, 0.0);
    for (old, new) in old.rows.iter().zip(&new.rows) {
        let [x, y, z, t] = [0, 1, 2, 3].map(|k| new[k] - old[k]);
        turned += x * x + y * y + z * z;
        shifted += t * t;
    }
    let norm = f64::sqrt(turned) * if rigid { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 } + 2e-14;
    (f64::sqrt(shifted) + norm * lever) * (1.0 + 32.0 * U) + TINY
}

/// Whether two pieces are certainly farther apart than `tolerance`.
///
/// The squares are off by less than 8u of themselves; below [`TINY`] they may underflow.
#[inline(always)]
pub(crate) fn are_far_apart(one: &Spheres, other: &Spheres, tolerance: f64) -> bool {
    let radii = (f64::from(one.outer) + f64::from(other.outer) + tolerance) * (1.0 + 16.0 * U) + TINY;
    square_distance(one, other) > radii * radii
}

/// Whether balls in two pieces certainly overlap.
#[inline(always)]
pub(crate) fn overlap_inside(one: &Spheres, other: &Spheres) -> bool {
    let inner = f64::from(one.inner) + f64::from(other.inner);
    inner > TINY && square_distance(one, other) * (1.0 + 32.0 * U) < inner * inner
}

#[inline(always)]
fn square_distance(one: &Spheres, other: &Spheres) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|k| one.centre[k] - other.centre[k]);
    x * x + y * y + z * z
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Matrix;
    use crate::compound::{Compound, Piece};
    use crate::shape::{InputPolicy, ShapeOptions};
    use swiftprox::random::Random;

    /// The shape that stands for a compound: its ball and box hold all pieces, and the ball is no larger than it must be about the
    /// origin, where that is the centre.
    #[test]
    fn the_row_of_a_compound_holds_its_pieces() {
        let mut random = Random::new(0xca9);
        for round in 0..if cfg!(miri) { 2 } else { 200 } {
            let scale = [1.0, 1e-30, 1e30][round % 3];
            let far = if round % 4 == 0 { Vector::new(9.0, 1.0, 0.5) } else { Vector::zeros() };
            let swept_radius = [0.0, 0.3][round % 2] * scale;
            let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
            let piece = |random: &mut Random| {
                let middle = random.direction() + far;
                let points: Vec<Vector> = (0..9).map(|_| (random.direction() * 0.4 + middle) * scale).collect();
                Piece { shape: Arc::new(Shape::from_points(&points, &options).unwrap()), pose: Pose::IDENTITY }
            };
            let compound = Compound::new(&[piece(&mut random), piece(&mut random), piece(&mut random)]).unwrap();
            let skewed = Matrix::identity() + Matrix::from_diagonal(&(random.vector() * [0.0, 2e-3][round % 2]));
            let pose = Pose::new(&(random.rotation() * skewed), &(random.vector() * scale));
            let around = compound.surrounding().unwrap();
            let (spheres, _) = placed(&around, &pose, pose.rotation_defect());
            let aabb = grown_box(&around, &pose, &spheres, 0.0);
            let mut farthest = 0.0_f64;
            for Piece { shape, .. } in compound.pieces() {
                for vertex in 0..shape.polyhedron().vertices.len() as u32 {
                    let local = shape.polyhedron().local_position(vertex);
                    let point = pose.transform(&local);
                    let way = (point - Vector::from(spheres.centre)).norm() + swept_radius;
                    assert!(way <= f64::from(spheres.outer), "{round}: {way:e} {spheres:?}");
                    for k in 0..3 {
                        assert!(f64::from(aabb.lower[k]) <= point[k] - swept_radius, "{round}: {point:?} {aabb:?}");
                        assert!(f64::from(aabb.upper[k]) >= point[k] + swept_radius, "{round}: {point:?} {aabb:?}");
                    }
                    farthest = farthest.max(local.norm() + swept_radius);
                }
            }
            assert!(around.extent().lever >= farthest && around.extent().inner_radius < 0.0);
            assert!(around.extent().lever <= farthest * (1.0 + 1e-9));
            if around.polyhedron().centre == Vector::zeros() {
                assert!(f64::from(spheres.outer) <= farthest * 1.02, "{round}: {farthest:e} {spheres:?}");
            }
        }
    }

    /// Random motions, rigid and skewed, of points on a sphere: none travels farther than the bound, which is not far off.
    #[test]
    fn no_point_travels_farther_than_said() {
        let mut random = Random::new(0x0d0);
        for round in 0..2_000 {
            let skew = if round % 3 == 0 { random.vector() * 2e-3 } else { Vector::zeros() };
            let skewed = Matrix::identity() + Matrix::from_diagonal(&skew);
            let small = random.power(-40, 0);
            let old = Pose::new(&(random.rotation() * skewed), &(random.vector() * 10.0));
            let turn = if round % 2 == 0 { random.rotation() } else { small_turn(&mut random, small) };
            let new = Pose::new(&(turn * old.rotation()), &(old.translation() + random.vector() * small));
            let rigid = [&old, &new].iter().all(|pose| pose.rotation_defect() <= RIGID);
            let way = way_bound(&old, &new, 2.0, rigid);
            let mut longest = 0.0_f64;
            for _ in 0..20 {
                let point = random.direction() * 2.0 * (1.0 - 4.0 * U);
                longest = longest.max((new.transform(&point) - old.transform(&point)).norm());
            }
            // The compared value is rounded itself, by a few u of 12.
            assert!(longest <= way + 1e-14, "{longest:e} {way:e}");
            assert!(way <= 3.0 * longest + 1e-13, "{longest:e} {way:e}");
        }
    }

    fn small_turn(random: &mut Random, angle: f64) -> Matrix {
        let axis = random.direction();
        *nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), angle).matrix()
    }
}
