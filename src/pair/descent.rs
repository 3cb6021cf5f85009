//! Marching across levels of detail: from coarse levels to ever finer ones, as far as the query needs (Ehmann & Lin 2000, §3
//! and §5.2).
//!
//! A level contains its body and stands off by at most its deviation. So bodies are at least as far apart as any two levels of
//! theirs, and at most by the deviations farther: a pair of levels that is disjoint already bounds the distance from both
//! sides, for sure. The level pair P₀/P₀ is not looked at here; that is an ordinary query, for which the search has found a
//! start.

use super::placed::Placed;
use super::start::policy;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Kernel, Lanes};
use crate::levels::hierarchy::Level;
use crate::polyhedron::Polyhedron;
use crate::solve::certificate::{Certify, CloserLook, Minimum};
use crate::solve::frame::{Frame, Marker};
use crate::solve::marching::{self, March, Step, Transition, step_limit};
use crate::solve::state::{FeatureId, State};

/// Which object goes to a finer level, and by how many, when a pair of levels is too coarse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum Refinement {
    /// The object whose level has the larger deviation, by one.
    #[default]
    Adaptive = 0,
    /// One object by one: that at the coarser level, object 1 where both are at the same.
    Single = 1,
    /// Both by one.
    SingleSingle = 2,
    /// Both by two.
    DoubleDouble = 3,
}

/// How much a query wants to know.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// `upper − lower` may be as large as this …
    pub absolute: f64,
    /// … or as this times `lower`.
    pub relative: f64,
    /// A distance beyond this need not be known.
    pub beyond: f64,
}

impl Accuracy {
    /// Whether an interval proves that the bodies are disjoint and is narrow enough, or beyond what has to be known. A narrow one
    /// is to be wholly on this side of that: another start would not say otherwise.
    #[inline(always)]
    pub fn is_met_by(&self, lower: f64, upper: f64) -> bool {
        let width = upper - lower;
        let is_narrow = (width <= self.absolute) | (width <= self.relative * lower);
        lower > 0.0 && ((is_narrow & (upper <= self.beyond)) | (lower > self.beyond))
    }
}

/// Two placed shapes with their levels; level 0 is the body itself, P₀.
#[derive(Clone, Copy)]
pub struct Leveled<'a> {
    /// Body 1 and body 2.
    bodies: [&'a Polyhedron; 2],
    /// Their levels that are made, the finest first.
    levels: [&'a [Level]; 2],
    /// Where they are.
    pub poses: [&'a Pose; 2],
}

/// A pair of levels and a pair of features of theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The levels of body 1 and body 2.
    pub levels: [u16; 2],
    /// Features of these levels.
    pub state: State,
}

impl<'a> Leveled<'a> {
    /// The shapes with the levels that they have now.
    #[inline(always)]
    pub fn new([first, second]: [Placed<'a>; 2]) -> Leveled<'a> {
        Leveled {
            bodies: [first.shape.polyhedron(), second.shape.polyhedron()],
            levels: [&first.shape.hierarchy().levels, &second.shape.hierarchy().levels],
            poses: [first.pose, second.pose],
        }
    }

    /// The coarsest levels.
    #[inline(always)]
    pub fn coarsest(&self) -> [u16; 2] {
        self.levels.map(|levels| u16::try_from(levels.len()).unwrap_or(u16::MAX))
    }

    /// The polyhedra of a pair of levels.
    #[inline(always)]
    pub fn polyhedra(&self, levels: [u16; 2]) -> [&'a Polyhedron; 2] {
        [self.polyhedron(0, levels[0]), self.polyhedron(1, levels[1])]
    }

    /// ρ₁ + ρ₂ of the bodies themselves.
    #[inline(always)]
    fn size(&self) -> f64 {
        self.bodies[0].radius + self.bodies[1].radius
    }

    #[inline(always)]
    fn polyhedron(&self, i: usize, level: u16) -> &'a Polyhedron {
        match level {
            0 => self.bodies[i],
            level => &self.levels[i][usize::from(level) - 1].polyhedron,
        }
    }

    /// How far a level stands off from its body, at most, in the body's own frame.
    #[inline(always)]
    pub fn deviation(&self, i: usize, level: u16) -> f64 {
        match level {
            0 => 0.0,
            level => self.levels[i][usize::from(level) - 1].deviation,
        }
    }

    /// The features of finer (or the same) levels that belong to those of a place.
    pub fn descended(&self, from: Place, to: [u16; 2]) -> Place {
        let mut features = from.state.features();
        for (i, feature) in features.iter_mut().enumerate() {
            for level in (to[i]..from.levels[i]).rev() {
                *feature = self.levels[i][usize::from(level)].children.of(*feature);
            }
        }
        self.place(to, features)
    }

    fn place(&self, levels: [u16; 2], features: [FeatureId; 2]) -> Place {
        let polyhedra = self.polyhedra(levels);
        // There is no state of an edge and a face.
        let vertices = || State::vertex_vertex([0, 1].map(|i| features[i].vertex(polyhedra[i])));
        Place { levels, state: State::of_features(features).unwrap_or_else(vertices) }
    }

    /// Whether [`Leveled::climbed`] stays where it is.
    #[inline(always)]
    pub fn stays(&self, at: Place, gap: f64, most: f64) -> bool {
        let off = self.deviation(0, at.levels[0]) + self.deviation(1, at.levels[1]);
        self.next_rise(at.levels, gap, most - off).is_none()
    }

    /// Where the next query is to start: up the parents for as long as the levels would still be disjoint, the distance `gap`
    /// of the levels being decreased by the differences in deviation (Ehmann & Lin 2000, §5.2), and would together stand off by
    /// no more than `most`.
    pub fn climbed(&self, from: Place, gap: f64, most: f64) -> Place {
        let Place { mut levels, state } = from;
        let mut features = state.features();
        let (mut left, mut off) = (gap, self.deviation(0, levels[0]) + self.deviation(1, levels[1]));
        while let Some((i, rise)) = self.next_rise(levels, left, most - off) {
            left -= rise;
            off += rise;
            features[i] = self.levels[i][usize::from(levels[i])].parents.of(features[i]);
            levels[i] += 1;
        }
        self.place(levels, features)
    }

    /// Which body goes to its next coarser level, and by how much farther that stands off, if there is one by less than `left` and
    /// no more than `most`.
    #[inline(always)]
    fn next_rise(&self, levels: [u16; 2], left: f64, most: f64) -> Option<(usize, f64)> {
        let coarsest = self.coarsest();
        let rise = |i: usize| match levels[i] < coarsest[i] {
            true => self.deviation(i, levels[i] + 1) - self.deviation(i, levels[i]),
            false => f64::INFINITY,
        };
        let rises = [rise(0), rise(1)];
        let i = if rises[0] <= rises[1] { 0 } else { 1 };
        // False where no level is left.
        (rises[i] < left && rises[i] <= most).then_some((i, rises[i]))
    }

    /// The finer levels that come next.
    fn refined(&self, [level1, level2]: [u16; 2], refinement: Refinement) -> [u16; 2] {
        let first = match refinement {
            Refinement::SingleSingle => return [level1.saturating_sub(1), level2.saturating_sub(1)],
            Refinement::DoubleDouble => return [level1.saturating_sub(2), level2.saturating_sub(2)],
            Refinement::Single => level1 >= level2,
            Refinement::Adaptive => self.deviation(0, level1) >= self.deviation(1, level2),
        };
        if level2 == 0 || (first && level1 > 0) { [level1 - 1, level2] } else { [level1, level2 - 1] }
    }
}

/// What a pair of levels says of its bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// The levels and the features where they are nearest.
    pub place: Place,
    /// A lower bound of the bodies' distance, above 0: that of the levels' distance.
    pub lower: f64,
    /// An upper bound of the bodies' distance.
    pub upper: f64,
    /// The unit direction, from body 2 to body 1, along which the bodies are `lower` apart.
    pub normal: Vector,
}

/// What a search came to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Descended {
    /// An interval as narrow as was asked for, or beyond what has to be known: the one found.
    Enough,
    /// The bodies themselves have to be looked at, from the place reached.
    Finest,
    /// The pair has jumped since the marker, or the trial took too long.
    Lost,
    /// The steps are spent.
    Spent,
}

/// A search from a place on. It is lent to the kernel and keeps what it finds.
pub struct Descent<'a> {
    /// What is searched.
    pub bodies: Leveled<'a>,
    /// What is asked for.
    pub accuracy: Accuracy,
    /// How it goes to finer levels.
    pub refinement: Refinement,
    /// Largest accepted entry of |RᵀR − I|.
    pub rotation_limit: f64,
    /// Where it is; the features are features of the levels.
    pub place: Place,
    /// Whether the first levels get but a few steps: the place is that of an earlier query, and the bodies may have jumped.
    pub is_trial: bool,
    /// Where a trial is given up at once if the pair has [jumped](levels_have_jumped) since it had this marker.
    pub marker: Option<Marker>,
    /// Steps of marching that it may make, at least 1.
    pub step_limit: u32,
    /// Steps made.
    pub steps: u32,
    /// The last that a pair of disjoint levels said.
    pub found: Option<Found>,
}

/// Steps of a trial. Marching from the features of an earlier query is given up for a new start after so many: the pair has jumped
/// without being noticed.
pub(crate) const TRIAL_STEPS: u32 = 16;

impl Kernel for Descent<'_> {
    type Output = Descended;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Descended {
        while self.place.levels != [0, 0] {
            let Place { levels, state } = self.place;
            let polyhedra = self.bodies.polyhedra(levels);
            let frame = Frame::<L>::new(polyhedra, self.bodies.poses, self.rotation_limit);
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
                self.place.state = at;
                if march == March::Minimum(at) {
                    // Ties and skewed rotations.
                    if !(keep.interval[0] > f64::NEG_INFINITY) {
                        look_closer(&frame, &mut keep, at);
                    }
                    if let Some(found) = keep.found(&frame, &self.bodies, self.place) {
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
            self.place = self.bodies.descended(self.place, self.bodies.refined(levels, self.refinement));
        }
        Descended::Finest
    }
}

/// The beginning of a search alone, the trial at its first levels, for [simple](Polyhedron::simple) levels and a rotation limit
/// of at least [`RIGID_TOGETHER`](crate::solve::frame::RIGID_TOGETHER): what it finds, if anything, in how many steps, and the
/// pair's frame. It is what the search would find.
#[inline(always)]
pub fn try_first<'a, L: Lanes>(
    bodies: &Leveled<'a>,
    place: Place,
    marker: Option<&Marker>,
) -> Option<(Found, u32, Frame<'a, L>)> {
    let frame = Frame::<L>::of_rigid(bodies.polyhedra(place.levels), bodies.poses);
    if !frame.in_range || levels_have_jumped(&frame, bodies, marker) {
        return None;
    }
    let mut keep = Keep::nothing();
    // Most often the features still are the nearest: one state (R3).
    let Step { transition, at: mut state } = marching::visit(&frame, place.state, &mut keep);
    let mut steps = 1;
    if transition == Transition::Move {
        let (march, more) = marching::march(&frame, state, TRIAL_STEPS - 1, &mut keep);
        let (March::Minimum(at) | March::Open(at) | March::Limit(at)) = march;
        state = at;
        steps += more;
    }
    // Of a minimum alone it has kept something.
    let found = keep.found(&frame, bodies, Place { state, ..place })?;
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
    // Rounding leaves 25u at most, see `certificate::RIGID_MISFIT`; as computed the defect is right to 4u.
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

    /// What it says of the bodies, if it proves that the levels are disjoint.
    #[inline(always)]
    fn found(&self, frame: &Frame<L>, bodies: &Leveled, place: Place) -> Option<Found> {
        let [lower, upper] = self.interval;
        if !(lower > 0.0) {
            return None;
        }
        // Ends of the shortest connection of the levels have points of the bodies within the deviations.
        let off1 = bodies.deviation(0, place.levels[0]) * stretch(frame, bodies.poses[0]);
        let off2 = bodies.deviation(1, place.levels[1]) * stretch(frame, bodies.poses[1]);
        let upper = (upper + off1 + off2) * (1.0 + 8.0 * U);
        Some(Found { place, lower, upper, normal: self.normal.to_vector() })
    }
}

/// What a quick look at a minimum leaves open.
#[inline(always)]
fn look_closer<L: Lanes>(frame: &Frame<L>, keep: &mut Keep<L>, at: State) {
    let mut closer = CloserLook::<L, false> { found: None };
    marching::visit(frame, at, &mut closer);
    if let Some((minimum, gap)) = &closer.found {
        keep.interval = [gap.interval.lower, gap.interval.upper];
        keep.normal = minimum.direction.mul(L::splat(minimum.inverse));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::hierarchy::{HierarchyKind, HierarchyOptions};
    use crate::shape::{Shape, ShapeOptions};
    use crate::solve::exact;
    use swiftprox::random::Random;

    /// An ellipsoid of 300 vertices with levels by quadric error, and in half its size one with outer cuts.
    fn shapes() -> [Shape; 2] {
        let mut random = Random::new(11);
        let mut points = |half_axes: [f64; 3]| -> Vec<Vector> {
            (0..300).map(|_| random.direction().component_mul(&Vector::from(half_axes))).collect()
        };
        let [large, small] = [points([1.0, 0.8, 0.3]), points([0.5, 0.5, 0.5])];
        let shape = |points: &[Vector], kind, decimation| {
            let hierarchy = HierarchyOptions { kind, decimation, minimum_triangles: 12, ..HierarchyOptions::default() };
            Shape::from_points(points, &ShapeOptions { hierarchy, ..ShapeOptions::default() }).unwrap()
        };
        [shape(&large, HierarchyKind::Quadric, 0.5), shape(&small, HierarchyKind::OuterCuts, 0.25)]
    }

    fn leveled<'a>(shapes: [&'a Shape; 2], poses: [&'a Pose; 2]) -> Leveled<'a> {
        Leveled::new([0, 1].map(|i| Placed { shape: shapes[i], pose: poses[i] }))
    }

    /// The level pairs from the coarsest to P₀/P₀.
    fn path(bodies: &Leveled, refinement: Refinement) -> Vec<[u16; 2]> {
        let next = |&levels: &[u16; 2]| (levels != [0, 0]).then(|| bodies.refined(levels, refinement));
        std::iter::successors(Some(bodies.coarsest()), next).collect()
    }

    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn refinement_goes_as_documented() {
        let [large, small] = shapes();
        let poses = [&Pose::IDENTITY; 2];
        let bodies = leveled([&large, &small], poses);
        assert_eq!(bodies.coarsest(), [5, 2]);
        let single = [[5, 2], [4, 2], [3, 2], [2, 2], [1, 2], [1, 1], [0, 1], [0, 0]];
        assert_eq!(path(&bodies, Refinement::Single), single);
        assert_eq!(path(&bodies, Refinement::SingleSingle), [[5, 2], [4, 1], [3, 0], [2, 0], [1, 0], [0, 0]]);
        assert_eq!(path(&bodies, Refinement::DoubleDouble), [[5, 2], [3, 0], [1, 0], [0, 0]]);
        // The other way round: object 1 goes first where both are at the same level.
        let swapped = leveled([&small, &large], poses);
        let single = [[2, 5], [2, 4], [2, 3], [2, 2], [1, 2], [1, 1], [0, 1], [0, 0]];
        assert_eq!(path(&swapped, Refinement::Single), single);
        assert_eq!(path(&swapped, Refinement::SingleSingle), [[2, 5], [1, 4], [0, 3], [0, 2], [0, 1], [0, 0]]);
        assert_eq!(path(&swapped, Refinement::DoubleDouble), [[2, 5], [0, 3], [0, 1], [0, 0]]);
    }

    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn adaptive_refinement_leaves_the_largest_deviation() {
        let [large, small] = shapes();
        for shapes in [[&large, &small], [&small, &large], [&large, &large]] {
            let bodies = leveled(shapes, [&Pose::IDENTITY; 2]);
            // Whatever the levels, and where both are the same object 1 goes first.
            for level1 in 0..=bodies.coarsest()[0] {
                for level2 in 0..=bodies.coarsest()[1] {
                    let [off1, off2] = [bodies.deviation(0, level1), bodies.deviation(1, level2)];
                    if [level1, level2] != [0, 0] {
                        let next = if off1 >= off2 { [level1 - 1, level2] } else { [level1, level2 - 1] };
                        assert_eq!(bodies.refined([level1, level2], Refinement::Adaptive), next);
                    }
                }
            }
            // From the coarsest levels to P₀/P₀ that is all levels in order of their deviations.
            let mut deviations: Vec<f64> = Vec::new();
            for (i, shape) in shapes.iter().enumerate() {
                deviations.extend((1..=shape.hierarchy().levels.len()).map(|k| bodies.deviation(i, k as u16)));
            }
            deviations.sort_by(|a, b| b.total_cmp(a));
            let path = path(&bodies, Refinement::Adaptive);
            let largest = |levels: &[u16; 2]| bodies.deviation(0, levels[0]).max(bodies.deviation(1, levels[1]));
            assert_eq!(path.iter().map(largest).take(path.len() - 1).collect::<Vec<_>>(), deviations);
        }
    }

    /// Up the parents, the level that stands off least more first, for as long as the levels may be disjoint and near enough.
    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn climbing_stops_before_levels_would_meet_or_stand_off_too_far() {
        let [large, small] = shapes();
        let bodies = leveled([&large, &small], [&Pose::IDENTITY; 2]);
        let off = |levels: [u16; 2]| bodies.deviation(0, levels[0]) + bodies.deviation(1, levels[1]);
        let finest = Place { levels: [0, 0], state: State::edge_edge([7, 9]) };
        let coarsest = bodies.climbed(finest, f64::INFINITY, f64::INFINITY);
        assert_eq!(coarsest.levels, bodies.coarsest());
        let mut random = Random::new(3);
        let mut reached = Vec::new();
        for _ in 0..2000 {
            let [gap, most] = [0, 1].map(|_| off(bodies.coarsest()) * random.power(-12, 1) * random.uniform(0.5, 1.0));
            let most = random.pick(&[most, f64::INFINITY]);
            let Place { levels, state } = bodies.climbed(finest, gap, most);
            assert!(off(levels) < gap && off(levels) <= most, "{levels:?} {gap} {most}");
            // One more of either would not do.
            for i in 0..2 {
                let mut above = levels;
                above[i] += 1;
                if levels[i] < bodies.coarsest()[i] {
                    assert!(off(above) >= gap * (1.0 - 1e-12) || off(above) > most, "{levels:?} {gap} {most}");
                }
            }
            // On from there is the same as at once.
            let on = bodies.climbed(Place { levels, state }, f64::INFINITY, f64::INFINITY);
            assert_eq!(on, coarsest);
            // The features are the parents of the parents.
            let mut features = finest.state.features();
            for i in 0..2 {
                for level in &bodies.levels[i][..usize::from(levels[i])] {
                    features[i] = level.parents.of(features[i]);
                }
            }
            assert_eq!(state, bodies.place(levels, features).state);
            if !reached.contains(&levels) {
                reached.push(levels);
            }
        }
        // Levels of both bodies by turns.
        assert!(reached.len() >= 6, "{reached:?}");
    }

    /// Where climbing promises levels that are disjoint they are: each stands off by no more than its deviation.
    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn levels_climbed_to_are_disjoint() {
        let [large, small] = shapes();
        let mut random = Random::new(4);
        let (mut higher, mut open) = (0, 0);
        for _ in 0..40 {
            let away = random.direction() * random.uniform(0.9, 1.5);
            let poses = [Pose::IDENTITY, Pose::new(&random.rotation(), &away)];
            let bodies = leveled([&large, &small], [&poses[0], &poses[1]]);
            let solve = |levels: [u16; 2]| {
                let [first, second] = bodies.polyhedra(levels);
                exact::solve(first, &poses[0], second, &poses[1], &[])
            };
            let gap = solve([0, 0]).lower;
            if gap > 0.0 {
                let finest = Place { levels: [0, 0], state: State::vertex_vertex([0, 0]) };
                let Place { levels, .. } = bodies.climbed(finest, gap, f64::INFINITY);
                assert!(solve(levels).lower > 0.0, "{levels:?}, {gap} apart");
                higher += usize::from(levels != [0, 0]);
                open += usize::from(levels != bodies.coarsest() && !(solve(bodies.coarsest()).lower > 0.0));
            }
        }
        assert!(higher > 20 && open > 0, "{higher} {open}");
    }
}
