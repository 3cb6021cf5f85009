//! Few pairs, all of them listed, that are asked what they were asked the last time: straight down the list.
//!
//! The pair layer answers each in its place among the results. Nothing is looked at first: spheres and ways of pieces need not
//! follow their poses then ([`Proxies::put`]).

use crate::base::error::Result;
use crate::base::locks::unlocked;
use crate::pair::{DecidedBy, Outcome};
use crate::scene::near::near_pairs::{NearPairs, UNLISTED};
use crate::scene::search::ask::{Kept, Search, Searched};
use crate::scene::search::findings::are_many_moved;
use crate::scene::search::narrow_phase::{is_listed, sign};
use crate::scene::search::query::SceneQuery;
use crate::scene::search::statistics::level_of;
#[cfg(doc)]
use crate::scene::world::proxies::Proxies;
use crate::scene::world::testing::Testing;

impl Search {
    /// Answers a query of the latest kind over all pairs, if it is of this sort; whether it is. It counts what it finds, too.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory); nothing is counted then.
    #[inline(always)]
    pub(super) fn ask_straight(&mut self, searched: &mut Searched, query: &SceneQuery) -> Result<bool> {
        let (world, near, kind) = (&mut *searched.world, &mut *searched.near, self.latest);
        let Kept { findings, pass, asked } = &mut self.kept[kind];
        let (Some(last_pass), Some(request)) = (*pass, &*asked) else { return Ok(false) };
        if !request.is_plain(query)
            || !world.proxies.bodies.is_empty()
            || !near.lists_all(world)
            || !are_many_moved(&world.proxies.motions, last_pass)
        {
            return Ok(false);
        }
        let NearPairs { pairs, marks, caches, .. } = &mut near.list;
        let (pairs, marks) = (&mut pairs[..], &mut marks[kind][..]);
        if marks.len() != pairs.len() {
            return Ok(false);
        }
        world.passes += 1;
        *pass = None;
        let (solver, proxies) = (request.solver(), &world.proxies);
        let rows = findings.begin_rows(pairs.len())?;
        // Restored where one of several fails: of one nothing has been counted then.
        let before = (pairs.len() > 1).then_some(self.statistics);
        let (mut listed, mut intersecting, mut stopped, mut error) = (0, false, false, 0.0);
        for (pair, mark) in pairs.iter_mut().zip(marks) {
            let row = &mut rows[listed];
            (mark.result, mark.is_answered) = (UNLISTED, false);
            if pair.testing != Testing::Active {
                continue;
            }
            let [a, b] = pair.proxies.map(|row| row as usize);
            let bodies = [proxies.shapes[a].at(&proxies.poses[a]), proxies.shapes[b].at(&proxies.poses[b])];
            let (cache, answer) = (unlocked(&mut caches[pair.cache as usize]), &mut row.answer);
            // The solver leaves nothing else of an earlier answer.
            answer.proof = [[0; 2]; 4];
            if let Err(error) = solver(bodies, cache, &request.config, answer) {
                if let Some(before) = before {
                    self.statistics = before;
                }
                return Err(error);
            }
            self.statistics.count(answer);
            // Ways are not known.
            pair.apart_until = f64::NEG_INFINITY;
            // Pairs that a budget left open may go on the next time.
            mark.is_answered = answer.decided_by != DecidedBy::Budget;
            if !is_listed(answer.outcome, false) {
                continue;
            }
            (mark.intersects, mark.level) = (answer.outcome == Outcome::Intersecting, level_of(answer));
            mark.result = listed as u32;
            error += answer.upper - answer.lower;
            sign(proxies, pair, row);
            listed += 1;
            intersecting |= mark.intersects;
            if mark.intersects & request.early_exit {
                stopped = true;
                break;
            }
        }
        findings.end_rows(listed, intersecting);
        *pass = (!stopped).then_some(world.passes);
        self.stopped = stopped;
        self.statistics.queries += 1;
        self.statistics.error_spent += error;
        Ok(true)
    }
}
