//! The statistics of a scene's queries.

#[cfg(doc)]
use crate::pair::Outcome;
use crate::pair::{DecidedBy, PairAnswer};
#[cfg(doc)]
use crate::scene::Scene;

/// Work of a scene's queries since it was made or swiftprox_scene_reset_statistics was called.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct SceneStatistics {
    /// Queries.
    pub queries: u64,
    /// Active pairs of convex pieces that were near enough to be looked at. How near that is depends on earlier queries.
    pub pairs: u64,
    /// … of which Voronoi marching decided.
    pub marched: u64,
    /// … of which the vertex pairs or the separating axis of the query before decided.
    pub coherent: u64,
    /// … of which Gilbert-Johnson-Keerthi in floating point decided.
    pub fallback: u64,
    /// … of which integer arithmetic decided.
    pub exact: u64,
    /// Feature pairs visited by Voronoi marching.
    pub marching_steps: u64,
    /// Iterations of Gilbert-Johnson-Keerthi in floating point.
    pub fallback_iterations: u64,
    /// Iterations in integer arithmetic.
    pub exact_iterations: u64,
    /// Pairs at which an approximate query stopped because their interval was narrow enough.
    pub within_tolerance: u64,
    /// … of which the step budget ran out.
    pub budget_spent: u64,
    /// Of the pairs, how many were answered by which level of detail: the coarser one of the two objects', 0 for the objects
    /// themselves, also where no geometry was asked; the last entry is for all levels beyond, too.
    pub by_level: [u64; 8],
    /// Sum of `upper − lower` over the pairs that queries about distances answered as [`Outcome::Separated`] or left
    /// [`Outcome::Undecided`]. Queries of intersection add nothing: their intervals are wide and only prove the verdict.
    pub error_spent: f64,
    /// Pairs that bounding spheres decided.
    pub bounding_spheres: u64,
    /// … of which balls inside the pieces decided.
    pub inscribed_spheres: u64,
    /// … of which neither piece had moved since the same query before: its answer was given again.
    pub unmoved: u64,
    /// … of which the pieces had not moved far enough since their last test to be listed.
    pub out_of_reach: u64,
}

/// The step that settled a pair that is not listed.
pub(crate) enum Settled {
    BoundingSpheres,
    OutOfReach,
}

impl SceneStatistics {
    /// A pair that geometry decided.
    pub(crate) fn count(&mut self, answer: &PairAnswer) {
        self.pairs += 1;
        *match answer.decided_by {
            DecidedBy::None => return,
            DecidedBy::Marching => &mut self.marched,
            DecidedBy::Coherence => &mut self.coherent,
            DecidedBy::Fallback => &mut self.fallback,
            DecidedBy::Integers => &mut self.exact,
            DecidedBy::Tolerance => &mut self.within_tolerance,
            DecidedBy::Budget => &mut self.budget_spent,
            DecidedBy::BoundingSpheres => &mut self.bounding_spheres,
            DecidedBy::InscribedSpheres => &mut self.inscribed_spheres,
        } += 1;
        self.marching_steps += u64::from(answer.statistics.marching_steps);
        self.fallback_iterations += u64::from(answer.statistics.fallback_iterations);
        self.exact_iterations += u64::from(answer.statistics.exact_iterations);
        self.by_level[usize::from(level_of(answer))] += 1;
    }

    /// Pairs of which neither piece has moved; `level` is that of their answers, as [`level_of`] gives it.
    #[inline(always)]
    pub(crate) fn count_unmoved(&mut self, count: u64, level: u8) {
        self.pairs += count;
        self.unmoved += count;
        self.by_level[usize::from(level)] += count;
    }

    /// A pair that a first look settled.
    #[inline(always)]
    pub(crate) fn count_settled(&mut self, by: Settled) {
        self.pairs += 1;
        self.by_level[0] += 1;
        *match by {
            Settled::BoundingSpheres => &mut self.bounding_spheres,
            Settled::OutOfReach => &mut self.out_of_reach,
        } += 1;
    }

    /// Adds the statistics of a part of a query, except the queries themselves and the error, which are no sums over parts.
    pub(crate) fn add(&mut self, part: &SceneStatistics) {
        self.pairs += part.pairs;
        self.marched += part.marched;
        self.coherent += part.coherent;
        self.fallback += part.fallback;
        self.exact += part.exact;
        self.marching_steps += part.marching_steps;
        self.fallback_iterations += part.fallback_iterations;
        self.exact_iterations += part.exact_iterations;
        self.within_tolerance += part.within_tolerance;
        self.budget_spent += part.budget_spent;
        for (sum, count) in self.by_level.iter_mut().zip(part.by_level) {
            *sum += count;
        }
        self.bounding_spheres += part.bounding_spheres;
        self.inscribed_spheres += part.inscribed_spheres;
        self.unmoved += part.unmoved;
        self.out_of_reach += part.out_of_reach;
    }
}

/// The last entry of [`SceneStatistics::by_level`].
const LAST_LEVEL: u16 = 7;

/// The level under which an answer counts in [`SceneStatistics::by_level`].
pub(crate) fn level_of(answer: &PairAnswer) -> u8 {
    let [level1, level2] = answer.statistics.levels;
    level1.max(level2).min(LAST_LEVEL) as u8
}
