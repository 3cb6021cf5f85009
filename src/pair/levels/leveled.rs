//! Two placed shapes with their levels of detail, and the way from a pair of levels to finer and coarser ones.

use crate::answer::Refinement;
use crate::base::math::Pose;
use crate::body::polyhedron::Polyhedron;
use crate::placed::Pair;
use crate::placed::state::{FeatureId, State};
use crate::shape::Placed;
use crate::shape::levels::hierarchy::Level;

/// Two placed shapes with their levels; level 0 is the body itself, P₀.
#[derive(Clone, Copy)]
pub struct Leveled<'a> {
    /// Body 1 and body 2.
    bodies: [&'a Polyhedron; 2],
    /// Their levels that are made, the finest first.
    levels: [&'a [Level]; 2],
    /// The poses of the bodies.
    pub poses: [&'a Pose; 2],
}

/// A pair of levels and a pair of features of theirs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelState {
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

    /// A pair of levels where the bodies are.
    #[inline(always)]
    pub fn pair(&self, levels: [u16; 2]) -> Pair<'a> {
        Pair { polyhedra: self.polyhedra(levels), poses: self.poses }
    }

    /// ρ₁ + ρ₂ of the bodies themselves.
    #[inline(always)]
    pub(super) fn size(&self) -> f64 {
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

    /// The features of finer (or the same) levels that belong to the given ones.
    pub fn descended(&self, from: LevelState, to: [u16; 2]) -> LevelState {
        let mut features = from.state.features();
        for (i, feature) in features.iter_mut().enumerate() {
            for level in (to[i]..from.levels[i]).rev() {
                *feature = self.levels[i][usize::from(level)].children.of(*feature);
            }
        }
        self.state_at(to, features)
    }

    fn state_at(&self, levels: [u16; 2], features: [FeatureId; 2]) -> LevelState {
        let polyhedra = self.polyhedra(levels);
        // There is no state of an edge and a face.
        let vertices = || State::vertex_vertex([0, 1].map(|i| features[i].vertex(polyhedra[i])));
        LevelState { levels, state: State::of_features(features).unwrap_or_else(vertices) }
    }

    /// Whether [`Leveled::coarsened`] stays where it is.
    #[inline(always)]
    pub fn stays(&self, at: LevelState, gap: f64, most: f64) -> bool {
        let off = self.deviation(0, at.levels[0]) + self.deviation(1, at.levels[1]);
        self.next_rise(at.levels, gap, most - off).is_none()
    }

    /// The start of the next query: up the parents for as long as the levels would still be disjoint and would together stand off
    /// by no more than `most`. Each step decreases the distance `gap` of the levels by the differences in deviation (Ehmann & Lin
    /// 2000, §5.2).
    pub fn coarsened(&self, from: LevelState, gap: f64, most: f64) -> LevelState {
        let LevelState { mut levels, state } = from;
        let mut features = state.features();
        let (mut left, mut off) = (gap, self.deviation(0, levels[0]) + self.deviation(1, levels[1]));
        while let Some((i, rise)) = self.next_rise(levels, left, most - off) {
            left -= rise;
            off += rise;
            features[i] = self.levels[i][usize::from(levels[i])].parents.of(features[i]);
            levels[i] += 1;
        }
        self.state_at(levels, features)
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
    pub(super) fn refined(&self, [level1, level2]: [u16; 2], refinement: Refinement) -> [u16; 2] {
        let first = match refinement {
            Refinement::SingleSingle => return [level1.saturating_sub(1), level2.saturating_sub(1)],
            Refinement::DoubleDouble => return [level1.saturating_sub(2), level2.saturating_sub(2)],
            Refinement::Single => level1 >= level2,
            Refinement::Adaptive => self.deviation(0, level1) >= self.deviation(1, level2),
        };
        if level2 == 0 || (first && level1 > 0) { [level1 - 1, level2] } else { [level1, level2 - 1] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Vector;
    use crate::placed::exact;
    use crate::shape::levels::hierarchy::{HierarchyKind, HierarchyOptions};
    use crate::shape::{Shape, ShapeOptions};
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
    fn coarser_levels_stop_before_levels_would_meet_or_stand_off_too_far() {
        let [large, small] = shapes();
        let bodies = leveled([&large, &small], [&Pose::IDENTITY; 2]);
        let off = |levels: [u16; 2]| bodies.deviation(0, levels[0]) + bodies.deviation(1, levels[1]);
        let finest = LevelState { levels: [0, 0], state: State::edge_edge([7, 9]) };
        let coarsest = bodies.coarsened(finest, f64::INFINITY, f64::INFINITY);
        assert_eq!(coarsest.levels, bodies.coarsest());
        let mut random = Random::new(3);
        let mut reached = Vec::new();
        for _ in 0..2000 {
            let [gap, most] = [0, 1].map(|_| off(bodies.coarsest()) * random.power(-12, 1) * random.uniform(0.5, 1.0));
            let most = random.pick(&[most, f64::INFINITY]);
            let LevelState { levels, state } = bodies.coarsened(finest, gap, most);
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
            let on = bodies.coarsened(LevelState { levels, state }, f64::INFINITY, f64::INFINITY);
            assert_eq!(on, coarsest);
            // The features are the parents of the parents.
            let mut features = finest.state.features();
            for i in 0..2 {
                for level in &bodies.levels[i][..usize::from(levels[i])] {
                    features[i] = level.parents.of(features[i]);
                }
            }
            assert_eq!(state, bodies.state_at(levels, features).state);
            if !reached.contains(&levels) {
                reached.push(levels);
            }
        }
        // Levels of both bodies by turns.
        assert!(reached.len() >= 6, "{reached:?}");
    }

    /// If going up promises disjoint levels, they are disjoint: each stands off by no more than its deviation.
    #[test]
    #[cfg_attr(miri, ignore = "builds levels, which takes it hours")]
    fn coarsened_levels_are_disjoint() {
        let [large, small] = shapes();
        let mut random = Random::new(4);
        let (mut higher, mut open) = (0, 0);
        for _ in 0..40 {
            let away = random.direction() * random.uniform(0.9, 1.5);
            let poses = [Pose::IDENTITY, Pose::new(&random.rotation(), &away)];
            let bodies = leveled([&large, &small], [&poses[0], &poses[1]]);
            let solve = |levels: [u16; 2]| {
                let [first, second] = bodies.polyhedra(levels);
                exact::solve(&Pair { polyhedra: [first, second], poses: [&poses[0], &poses[1]] }, &[])
            };
            let gap = solve([0, 0]).lower;
            if gap > 0.0 {
                let finest = LevelState { levels: [0, 0], state: State::vertex_vertex([0, 0]) };
                let LevelState { levels, .. } = bodies.coarsened(finest, gap, f64::INFINITY);
                assert!(solve(levels).lower > 0.0, "{levels:?}, {gap} apart");
                higher += usize::from(levels != [0, 0]);
                open += usize::from(levels != bodies.coarsest() && !(solve(bodies.coarsest()).lower > 0.0));
            }
        }
        assert!(higher > 20 && open > 0, "{higher} {open}");
    }
}
