//! The common case of approximate queries through levels of detail: near the features of the levels that the cache holds are the
//! nearest, and they say enough. Straight through to the answer that the search among the levels comes to, to the last bit.

use super::descent::{self, Leveled, Place, TRIAL_STEPS};
use super::levels::{are_worth_it, may_answer};
use super::query::{PairQuery, Query};
use super::{DecidedBy, Levels};
use crate::base::simd::{self, Kernel, Lanes};

impl PairQuery<'_> {
    /// Whether it is the common case; answer and cache are then written.
    #[inline(always)]
    pub(super) fn last_levels_answer(&mut self) -> bool {
        let &mut PairQuery { query, bodies: [first, second], ref cache, config, .. } = self;
        let shapes = [first.shape, second.shape];
        // A limit below rounding asks for a closer look at the poses.
        let is_common_case = (query == Query::Approximate)
            & cache.holds_place()
            & (cache.spent_before() == 0)
            & (config.step_budget >= TRIAL_STEPS)
            & config.admits_rounding()
            & config.start.asks_cache();
        if !is_common_case || shapes[0].lacks_levels() | shapes[1].lacks_levels() {
            return false;
        }
        if config.levels == Levels::Automatic {
            let error = self.surely_most_error();
            if !(are_worth_it(shapes, error) && may_answer(shapes, error)) {
                return false;
            }
        }
        simd::dispatch(&mut LastLevels { pair: self })
    }
}

struct LastLevels<'a, 'b> {
    pair: &'a mut PairQuery<'b>,
}

impl Kernel for LastLevels<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let bodies = Leveled::new(*self.pair.bodies);
        let &mut PairQuery { ref cache, config, .. } = self.pair;
        let Some(place) = cache.place(&bodies) else { return false };
        let [level1, level2] = bodies.polyhedra(place.levels);
        if (place.levels == [0, 0]) | !(level1.simple & level2.simple) {
            return false;
        }
        let first = descent::try_first::<L>(&bodies, place, cache.last_marker(config));
        let Some((found, steps, frame)) = first else { return false };
        if !config.accuracy().is_met_by(found.lower, found.upper) {
            return false;
        }
        self.pair.fill_found(&found, DecidedBy::Tolerance, steps);
        let most = self.pair.near_enough(found.lower);
        let stays = bodies.stays(found.place, found.lower, most);
        let next = if stays { found.place } else { climbed(&bodies, &found.place, found.lower, most) };
        self.pair.cache.remember_place(next, 0);
        if steps > 1 {
            frame.mark(&mut self.pair.cache.marker);
        }
        true
    }
}

#[cold]
#[inline(never)]
fn climbed(bodies: &Leveled, from: &Place, gap: f64, most: f64) -> Place {
    bodies.climbed(*from, gap, most)
}
