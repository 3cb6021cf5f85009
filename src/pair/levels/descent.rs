//! Marching across levels of detail: from coarse levels to finer ones, as far as the query needs (Ehmann & Lin 2000, §3 and
//! §5.2).
//!
//! A level contains its body and stands off by at most its deviation. So bodies are at least as far apart as any two levels of
//! theirs, and at most by the deviations farther. Thus a disjoint pair of levels already bounds the distance from both sides,
//! provably. The level pair P₀/P₀ is not looked at here; that is an ordinary query, for which the search has found a start.

use super::leveled::{LevelState, Leveled};
use crate::answer::{Accuracy, Refinement};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Kernel, Lanes};
use crate::distance::certificate::{Certify, CloserLook, Minimum};
use crate::distance::marching::{self, March, Step, Transition, step_limit};
use crate::pair::start::policy;
use crate::placed::Pair;
use crate::placed::frame::{Frame, Marker};
use crate::placed::state::State;

/// The bounds that a pair of levels gives for its bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelBounds {
    /// The levels and the features where they are nearest.
    pub at: LevelState,
    /// A lower bound of the bodies' distance, above 0: that of the levels' distance.
    pub lower: f64,
    /// An upper bound of the bodies' distance.
    pub upper: f64,
    /// The unit direction, from body 2 to body 1, along which the bodies are `lower` apart.
    pub normal: Vector,
}

/// The result of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Descended {
    /// An interval as narrow as was asked for, or beyond what has to be known: the one found.
    Enough,
    /// The bodies themselves must be looked at, from the state reached.
    Finest,
    /// The pair has jumped since the marker, or the trial took too long.
    Lost,
    /// The steps are spent.
    Spent,
}

/// A search from levels and features on. It is lent to the kernel and keeps what it finds.
pub struct LevelDescent<'a> {
    /// The bodies that are searched.
    pub bodies: Leveled<'a>,
    /// The accuracy that is asked for.
    pub accuracy: Accuracy,
    /// How it goes to finer levels.
    pub refinement: Refinement,
    /// The place of the search; the features are features of the levels.
    pub at: LevelState,
    /// Whether the first levels get but a few steps: they are those of an earlier query, and the bodies may have jumped.
    pub is_trial: bool,
    /// A trial is given up at once if the pair has [jumped](levels_have_jumped) since it had this marker.
    pub marker: Option<Marker>,
    /// Steps of marching that it may make, at least 1.
    pub step_limit: u32,
    /// Steps made.
    pub steps: u32,
    /// The last bounds of a pair of disjoint levels.
    pub found: Option<LevelBounds>,
}

/// Steps of a trial. Marching from the features of an earlier query is given up for a new start after this many: the pair has
/// jumped without being noticed.
pub const TRIAL_STEPS: u32 = 16;

impl Kernel for LevelDescent<'_> {
    type Output = Descended;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Descended {
        while self.at.levels != [0, 0] {
            let LevelState { levels, state } = self.at;
            let polyhedra = self.bodies.polyhedra(levels);
            let frame = Frame::<L>::new(&Pair { polyhedra, poses: self.bodies.poses });
            if frame.in_range {
                if self.is_trial && levels_have_jumped(&frame, &self.bodies, self.marker.as_ref()) {
                    return Descended::Lost;
                }
                let limit =
                    if self.is_trial { TRIAL_STEPS } else { step_limit(polyhedra) }.min(self.step_limit - self.steps);
                let mut keep = Keep::nothing();
                let (march, more) = marching::march(&frame, state, limit, &mut keep);
                self.steps += more;
                let (March::Minimum(at) | March::Open(at) | March::Limit(at)) = march;
                self.at.state = at;
                if march == March::Minimum(at) {
                    // Ties and skewed rotations.
                    if !(keep.interval[0] > f64::NEG_INFINITY) {
                        look_closer(&frame, &mut keep, at);
                    }
                    if let Some(found) = keep.found(&frame, &self.bodies, self.at) {
                        self.found = Some(found);
                        if self.accuracy.is_met_by(found.lower, found.upper) {
                            return Descended::Enough;
                        }
                    }
                }
                if self.steps >= self.step_limit {
                    return Descended::Spent;
                }
                if self.is_trial && march == March::Limit(at) {
                    return Descended::Lost;
                }
            }
            self.is_trial = false;
            self.at = self.bodies.descended(self.at, self.bodies.refined(levels, self.refinement));
        }
        Descended::Finest
    }
}

/// The beginning of a search alone, the trial at its first levels, for [simple](Polyhedron::simple) levels: its result, if any, the
/// number of steps, and the pair's frame. It is the result that the search would find.
#[inline(always)]
pub fn try_first<'a, L: Lanes>(
    bodies: &Leveled<'a>,
    at: LevelState,
    marker: Option<&Marker>,
) -> Option<(LevelBounds, u32, Frame<'a, L>)> {
    let frame = Frame::<L>::of_rigid(&bodies.pair(at.levels));
    if !frame.in_range || levels_have_jumped(&frame, bodies, marker) {
        return None;
    }
    let mut keep = Keep::nothing();
    // Most often the features still are the nearest: one state (R3).
    let Step { transition, at: mut state } = marching::visit(&frame, at.state, &mut keep);
    let mut steps = 1;
    if transition == Transition::Move {
        let (march, more) = marching::march(&frame, state, TRIAL_STEPS - 1, &mut keep);
        let (March::Minimum(at) | March::Open(at) | March::Limit(at)) = march;
        state = at;
        steps += more;
    }
    // Only a minimum has left something in `keep`.
    let found = keep.found(&frame, bodies, LevelState { state, ..at })?;
    Some((found, steps, frame))
}

/// Whether the pair has jumped since it had a marker.
#[inline(always)]
fn levels_have_jumped<L: Lanes>(frame: &Frame<L>, bodies: &Leveled, marker: Option<&Marker>) -> bool {
    // The levels' lever is that of the bodies. No closure (R2).
    let frame = Frame { size: bodies.size(), ..*frame };
    match marker {
        Some(marker) => policy::has_jumped(&frame, marker),
        None => false,
    }
}

/// An upper bound of ‖R‖₂: ‖RᵀR − I‖₂ is at most three times the largest entry.
#[inline(always)]
fn stretch<L: Lanes>(frame: &Frame<L>, pose: &Pose) -> f64 {
    // Rounding leaves `RIGID_DEFECT` at most, 29u; as computed the largest entry is right to 4u.
    if frame.rigid { 1.0 + 64.0 * U } else { 1.0 + 1.5 * (pose.rotation_defect() + 16.0 * U) }
}

/// The interval of the levels' distance and the unit direction at a minimum.
struct Keep<L> {
    /// Lower and upper end.
    interval: [f64; 2],
    normal: L,
}

impl<L: Lanes> Certify<L> for Keep<L> {
    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, _: State, minimum: &Minimum<L>) {
        let interval = minimum.gap(frame).interval;
        self.interval = [interval.lower, interval.upper];
        self.normal = minimum.direction.mul(L::splat(minimum.inverse));
    }
}

impl<L: Lanes> Keep<L> {
    #[inline(always)]
    fn nothing() -> Self {
        Keep { interval: [f64::NEG_INFINITY, f64::INFINITY], normal: L::splat(0.0) }
    }

    /// The bounds on the bodies, if the search proves that the levels are disjoint.
    #[inline(always)]
    fn found(&self, frame: &Frame<L>, bodies: &Leveled, at: LevelState) -> Option<LevelBounds> {
        let [lower, upper] = self.interval;
        if !(lower > 0.0) {
            return None;
        }
        // Ends of the shortest connection of the levels have points of the bodies within the deviations.
        let off1 = bodies.deviation(0, at.levels[0]) * stretch(frame, bodies.poses[0]);
        let off2 = bodies.deviation(1, at.levels[1]) * stretch(frame, bodies.poses[1]);
        let upper = (upper + off1 + off2) * (1.0 + 8.0 * U);
        Some(LevelBounds { at, lower, upper, normal: self.normal.to_vector() })
    }
}

/// A closer look at a minimum that a quick look leaves open.
#[inline(always)]
fn look_closer<L: Lanes>(frame: &Frame<L>, keep: &mut Keep<L>, at: State) {
    let mut closer = CloserLook::<L, false> { found: None };
    marching::visit(frame, at, &mut closer);
    if let Some((minimum, gap)) = &closer.found {
        keep.interval = [gap.interval.lower, gap.interval.upper];
        keep.normal = minimum.direction.mul(L::splat(minimum.inverse));
    }
}
