//! Two moving objects, prepared for one cast: where they are at a time, and the bounds on them between times.

use super::bound::{Travel, is_exact, rounding_of_place};
use super::carried::Carried;
use super::enclosed_ball::EnclosedBall;
use super::gap::Along;
use super::kinds::Motion;
use super::path::Path;
use crate::answer::{Radii, sum_below};
use crate::base::error::{Error, Result};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, is_unit};
use crate::body::polyhedron::Polyhedron;
use crate::pair::{PairAnswer, PairCache, Placed};
use crate::placed::Pair;

/// A pair that moves.
pub(super) struct MovingPair<'a> {
    bodies: [Carried<'a>; 2],
    paths: [Path<'a>; 2],
    travels: [Travel; 2],
    radii: Radii,
    range: [f64; 2],
}

/// The pair at a time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    pub time: f64,
    pub poses: [Pose; 2],
    /// δ of both together: no gap of the motion is farther from that of the poses.
    pub rounding: f64,
}

impl Default for Moment {
    fn default() -> Moment {
        Moment { time: f64::NAN, poses: [Pose::IDENTITY; 2], rounding: 0.0 }
    }
}

impl<'a> MovingPair<'a> {
    /// # Errors
    /// [`Error::Pose`], [`Error::Argument`] for a motion with a number out of its range.
    pub fn new(bodies: [impl Into<Carried<'a>>; 2], range: [f64; 2]) -> Result<MovingPair<'a>> {
        let bodies = bodies.map(Into::into);
        let in_words = |error: Error, object: &str| match error {
            Error::Pose(message) => Error::Pose(format!("{object}: {message}")),
            other => Error::Argument(format!("{object}: {}", other.message())),
        };
        let paths = [Path::new(bodies[0].motion), Path::new(bodies[1].motion)];
        let travel = |i: usize, object: &str| {
            let prepared = bodies[i].motion.check().and_then(|()| Travel::new(&bodies[i], &paths[i], range));
            prepared.map_err(|error| in_words(error, object))
        };
        let travels = [travel(0, "object 1")?, travel(1, "object 2")?];
        // A pose is one for all that is asked of the shapes alone.
        let radii = Radii::of(&bodies.map(|body| body.shape.at(&Pose::IDENTITY))).unwrap_or(Radii::NONE);
        Ok(MovingPair { bodies, paths, travels, radii, range })
    }

    /// # Errors
    /// [`Error::Pose`] for a pose that is not accepted.
    pub fn at(&self, time: f64) -> Result<Moment> {
        let mut moment = Moment::default();
        self.place_at(time, &mut moment)?;
        Ok(moment)
    }

    /// The same where it is to stay: a moment is 200 bytes.
    ///
    /// # Errors
    /// As of [`MovingPair::at`].
    pub fn place_at(&self, time: f64, moment: &mut Moment) -> Result<()> {
        let mut of_motions = 0.0;
        for i in 0..2 {
            moment.poses[i] = self.bodies[i].pose(&self.paths[i], time)?;
            of_motions += if is_exact(self.bodies[i].motion, time) { 0.0 } else { self.travels[i].rounding };
        }
        moment.time = time;
        moment.rounding = (of_motions + self.rounding_of_places(&moment.poses)) * (1.0 + 8.0 * U);
        Ok(())
    }

    fn rounding_of_places(&self, poses: &[Pose; 2]) -> f64 {
        rounding_of_place(&self.bodies[0], &poses[0]) + rounding_of_place(&self.bodies[1], &poses[1])
    }

    /// The sum of the swept radii and deviations, rounded up.
    pub fn swept(&self) -> f64 {
        self.radii.upper
    }

    /// How far the objects reach beyond their polyhedra: contact is proved where these meet, and excluded so far before.
    pub fn deviation(&self) -> f64 {
        self.radii.deviation
    }

    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    pub fn placed<'b>(&'b self, moment: &'b Moment) -> [Placed<'b>; 2] {
        [self.bodies[0].shape.at(&moment.poses[0]), self.bodies[1].shape.at(&moment.poses[1])]
    }

    /// A lower bound of the gap of the motion along a direction of about unit length, from body 2 to body 1.
    pub fn gap(&self, moment: &Moment, direction: &Vector, vertices: &mut Option<[u32; 2]>) -> f64 {
        debug_assert!(direction.norm_squared() <= 1.0 + 1e-6);
        let pair = Pair { polyhedra: self.polyhedra(), poses: [&moment.poses[0], &moment.poses[1]] };
        let gap = Along { pair, direction, vertices }.gap();
        sum_below(sum_below(gap, -self.radii.upper), -moment.rounding)
    }

    /// The unit vector between the centres of the bounding spheres, of bodies that are so far apart that it may separate them.
    pub fn between_spheres(&self, moment: &Moment) -> Option<Vector> {
        let [body1, body2] = self.bodies.map(|body| body.shape.polyhedron());
        let line = moment.poses[0].transform(&body1.centre) - moment.poses[1].transform(&body2.centre);
        let (length, [less, more]) = (line.norm(), [body1.radius.min(body2.radius), body1.radius.max(body2.radius)]);
        (length > less + 0.5 * more).then(|| line / length)
    }

    pub fn polyhedra(&self) -> [&'a Polyhedron; 2] {
        self.bodies.map(|body| body.shape.polyhedron())
    }

    /// K along a vector of at most unit length.
    pub fn acceleration(&self, direction: &Vector) -> f64 {
        self.travels.iter().map(|travel| travel.acceleration(direction)).sum::<f64>() * (1.0 + 4.0 * U)
    }

    /// B of the gap along a direction that turns from the first of two unit vectors at one moment to the second at another;
    /// infinite where they are more than 60 degrees apart.
    pub fn sag(&self, ends: [&Moment; 2], [first, last]: [&Vector; 2]) -> f64 {
        debug_assert!(is_unit(first) && is_unit(last));
        debug_assert!(ends[0].time <= ends[1].time);
        let h = ends[1].time - ends[0].time;
        let of_bend = |acceleration: f64| 0.5 * acceleration * h * h;
        if first == last {
            return of_bend(self.acceleration(first)) * (1.0 + 8.0 * U);
        }
        let turn = last - first;
        if !(turn.norm_squared() < 1.0) {
            return f64::INFINITY;
        }
        let along = self.acceleration(first).max(self.acceleration(last)) + self.acceleration(&turn);
        (of_bend(along) * (1.0 + 8.0 * U) + self.advance(ends, &turn)).max(0.0) * (1.0 + 4.0 * U)
    }

    /// No point of body 1 gains more along a vector of at most unit length on any of body 2, from one moment to another.
    ///
    /// For a body, a point p gains v·ΔT + (ΔRᵀv)·p, most at a corner of its box. ΔRᵀv errs by 13u|v|, its products and sums by
    /// less than 30u of the sizes below, ΔT by u.
    fn advance(&self, ends: [&Moment; 2], along: &Vector) -> f64 {
        debug_assert!(along.norm_squared() <= 1.0 + 1e-9);
        let (mut most, mut size) = (0.0, 0.0);
        for (i, sign) in [(0, 1.0), (1, -1.0)] {
            let [from, to] = ends.map(|moment| &moment.poses[i]);
            if from == to {
                continue;
            }
            let shape = self.bodies[i].shape;
            let (polyhedron, (middle, half)) = (shape.polyhedron(), shape.extent().box_about_centre());
            let step = to.translation() - from.translation();
            let turned = to.rotate_back(along) - from.rotate_back(along);
            let of_middle = along.dot(&step) + turned.dot(&(polyhedron.centre + middle));
            most += sign * of_middle + turned.abs().dot(half);
            size += step.norm() + polyhedron.centre.norm() + 2.0 * polyhedron.radius;
        }
        most + ends[0].rounding + ends[1].rounding + 64.0 * U * size
    }

    /// Whether finding an object's speed takes a call of the caller's function.
    pub fn has_callback(&self) -> bool {
        self.bodies.iter().any(|body| matches!(body.motion, Motion::Callback(_)))
    }

    /// A lower bound of how deep the objects are in each other at a moment, by the differences of vertices that a query has found
    /// to hold the origin; 0 where they prove nothing.
    pub fn enclosed_ball(&self, moment: &Moment, cache: &PairCache) -> f64 {
        let polyhedra = self.polyhedra();
        let poses = [&moment.poses[0], &moment.poses[1]];
        cache
            .enclosure(polyhedra)
            .map_or(0.0, |pairs| EnclosedBall { pair: Pair { polyhedra, poses }, pairs: pairs.as_slice() }.radius())
    }

    /// About how fast the gap along a direction grows, by the witness points of an answer about the moment.
    pub fn speed(&self, moment: &Moment, direction: &Vector, answer: &PairAnswer) -> Result<f64> {
        // A part of the range, towards its farther end.
        let [begin, end] = self.range;
        let part = 1e-6 * (end - begin);
        let part = if moment.time - begin > end - moment.time { -part } else { part };
        let PairAnswer { local1, local2, world1, world2, .. } = answer;
        let velocity = |i: usize, local: &[f64; 3], world: &[f64; 3]| {
            let point = Vector::from(*local);
            let carried = self.bodies[i].place.map_or(point, |place| place.transform(&point));
            self.paths[i].velocity(moment.time, part, [&carried, &Vector::from(*world)])
        };
        let speed = direction.dot(&(velocity(0, local1, world1)? - velocity(1, local2, world2)?));
        Ok(if speed.is_finite() { speed } else { 0.0 })
    }

    /// The amount by which a gap must exceed the requested one, so that another query along another axis, or in other steps,
    /// finds it, too: rounding of poses and of gaps.
    pub fn slack(&self, moment: &Moment) -> f64 {
        let [body1, body2] = self.bodies.map(|body| body.shape.polyhedron());
        let apart = moment.poses[0].translation() - moment.poses[1].translation();
        let size =
            body1.radius + body2.radius + body1.centre.norm() + body2.centre.norm() + apart.norm() + self.swept();
        let of_poses = self.travels[0].rounding + self.travels[1].rounding + self.rounding_of_places(&moment.poses);
        2.0 * of_poses + 64.0 * U * size
    }

    /// Refuses a callback whose bound its own poses at three times show to be wrong: no point is farther from its chord than the
    /// bend allows.
    ///
    /// # Errors
    /// [`Error::Argument`].
    pub fn check_bend(&self, moments: [&Moment; 3]) -> Result<()> {
        for (i, body) in self.bodies.iter().enumerate() {
            let Motion::Callback(callback) = body.motion else { continue };
            let [first, middle, last] = moments.map(|moment| moment.time);
            let (before, after) = (middle - first, last - middle);
            let polyhedron = body.shape.polyhedron();
            for vertex in [0, polyhedron.vertices.len() / 2, polyhedron.vertices.len() - 1] {
                let point = polyhedron.local_position(vertex as u32);
                let [start, between, end] = moments.map(|moment| moment.poses[i].transform(&point));
                let off = (between - (start * after + end * before) / (before + after)).norm();
                let place = body.place.map_or(0.0, |place| place.translation().norm());
                let size = start.norm() + between.norm() + end.norm() + point.norm() + place;
                let allowed = 0.5 * callback.bend * before * after + 2.0 * callback.rounding + 64.0 * U * size;
                if off > allowed * (1.0 + 64.0 * U) {
                    return Err(Error::Argument(format!(
                        "object {}: the motion's callback bends more than its bound: at time {middle:?} vertex {} is {off:e} off the \
                         chord of times {first:?} and {last:?}, where bend {:e} and rounding {:e} allow {allowed:e}",
                        i + 1,
                        polyhedron.vertex_labels[vertex],
                        callback.bend,
                        callback.rounding,
                    )));
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::double_double::two_sum;
    use crate::shape::{Shape, ShapeOptions};

    /// Was one unit in the last place above the truth: −(2 − 2⁻⁵²) less 1.98·2⁻⁵² is −2 − 0.98·2⁻⁵²; it was rounded to −2, and of
    /// the tie of −2 less u·2 the even one is −2 again.
    #[test]
    fn a_gap_less_what_rounding_makes_of_poses_is_rounded_down() {
        let corners: Vec<Vector> =
            (0..8).map(|k| Vector::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * 2.0).collect();
        let cube = Shape::from_points(&corners, &ShapeOptions::default()).unwrap();
        let still = Motion::Fixed(Pose::IDENTITY);
        let mut below_two = 0;
        for step in 0..512 {
            // The gap is about −2 for cubes that overlap nearly wholly; the last places of the place are tried in turn.
            let place = f64::from(step) * f64::EPSILON;
            let motion =
                Motion::Fixed(Pose { rows: [[1.0, 0.0, 0.0, place], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] });
            let bodies = [&motion, &still].map(|motion| Carried { shape: &cube, motion, place: None });
            let pair = MovingPair::new(bodies, [0.0, 1.0]).unwrap();
            let mut moment = pair.at(0.0).unwrap();
            moment.rounding = 0.0;
            let gap = pair.gap(&moment, &Vector::x(), &mut None);
            below_two += i32::from((-2.0..-2.0 + 4.0 * f64::EPSILON).contains(&gap));
            for eighth in 1..64 {
                moment.rounding = f64::from(eighth) * f64::EPSILON / 8.0;
                let exact = two_sum(gap, -moment.rounding);
                let found = pair.gap(&moment, &Vector::x(), &mut None);
                let excess = two_sum(found, -exact.hi);
                assert!(excess.hi - exact.lo <= 0.0, "{gap:e} {:e} {found:e}", moment.rounding);
            }
        }
        assert!(below_two > 0, "no gap next to −2");
    }
}
