//! The common case of approximate queries through levels of detail: near the features of the levels that the cache holds are the
//! nearest, and they suffice. A direct path to the answer of the search among the levels, to the last bit.

use super::query::{NoBalls, PairQuery};
use crate::answer::DecidedBy;
use crate::base::simd::{self, Kernel, Lanes};
use crate::pair::levels::{LevelState, Leveled, try_first};

impl PairQuery<'_, NoBalls> {
    /// Whether it is the common case; answer and cache are then written.
    #[inline(always)]
    pub(super) fn last_levels_answer(&mut self) -> bool {
        self.may_ask_last_levels() && simd::dispatch(&mut LastLevels { pair: self })
    }
}

struct LastLevels<'a, 'b> {
    pair: &'a mut PairQuery<'b, NoBalls>,
}

impl Kernel for LastLevels<'_, '_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> bool {
        let bodies = Leveled::new(*self.pair.bodies);
        let pair = &mut *self.pair;
        let Some(last) = pair.cache.level_state(&bodies) else { return false };
        let [level1, level2] = bodies.polyhedra(last.levels);
        if (last.levels == [0, 0]) | !(level1.simple & level2.simple) {
            return false;
        }
        let first = try_first::<L>(&bodies, last, pair.last_marker());
        let Some((found, steps, frame)) = first else { return false };
        if !pair.is_met_by(&found) {
            return false;
        }
        pair.fill_found(&found, DecidedBy::Tolerance, steps);
        let most = pair.near_enough(found.lower);
        let stays = bodies.stays(found.at, found.lower, most);
        let next = if stays { found.at } else { coarsened(&bodies, &found.at, found.lower, most) };
        pair.cache.remember_level_state(next, 0);
        if steps > 1 {
            frame.mark(&mut pair.cache.marker);
        }
        true
    }
}

#[cold]
#[inline(never)]
fn coarsened(bodies: &Leveled, from: &LevelState, gap: f64, most: f64) -> LevelState {
    bodies.coarsened(*from, gap, most)
}
