//! An error budget dealt out: which pairs may take a share of it, and how large a share is.
//!
//! Error buys time only where maps of support functions or levels of detail may answer. That takes bodies of many vertices and an
//! error as large as maps are coarse, or as levels stand off. Pairs that need least come first, as many as the budget suffices
//! for; all others are asked for exact distances. So are pairs that the last pass found intersecting: they need no share. Whatever
//! becomes of the pairs, those that take shares are no more than were counted: all of them together stay within the budget.

use crate::base::error::Result;
use crate::base::memory::push;
use crate::pair::least_error;
use crate::scene::near::near_pairs::{NearPair, PairMark};
use crate::scene::search::request::Request;
use crate::scene::world::proxies::Proxies;
use crate::scene::world::rows::are_far_apart;
use crate::scene::world::testing::Testing;

/// The result of dealing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Deal {
    /// The upper limit on `upper − lower` of each pair with a share: a power of two, so that it stays while little changes.
    pub share: f64,
    /// The budget sufficed for all that maps or levels may answer. Else which pairs take shares depends on all others, and answers
    /// of another deal are not given again.
    pub is_for_all: bool,
}

/// The need of the maps or the levels of a pair, and its place in the list.
pub(crate) type Need = (f64, u32);

/// Says of each pair whether it takes a share of the request's budget; none does without one. `marks` are
/// those of the last pass that asked the same.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory).
pub(crate) fn deal(
    request: &Request,
    proxies: &Proxies,
    pairs: &mut [NearPair],
    marks: &[PairMark],
    needs: &mut Vec<Need>,
) -> Result<Deal> {
    needs.clear();
    let budget = request.error_budget.unwrap_or(0.0);
    for (k, (pair, mark)) in (0..).zip(pairs.iter_mut().zip(marks)) {
        pair.takes_share = false;
        let [a, b] = pair.proxies.map(|proxy| proxy as usize);
        let needs_none = mark.is_answered & mark.is_listed() & mark.intersects;
        if (pair.testing != Testing::Active)
            || needs_none
            || are_far_apart(proxies.known_spheres(a), proxies.known_spheres(b), request.tolerance)
        {
            continue;
        }
        let need = least_error([&proxies.shapes[a], &proxies.shapes[b]], request.config.levels);
        if need <= budget {
            push(needs, (need, k))?;
        }
    }
    // In the list's order where they need the same.
    needs.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
    let suffices = |count: usize| needs[count - 1].0 <= share_of(budget, count);
    let (mut enough, mut too_many) = (0, needs.len() + 1);
    while too_many - enough > 1 {
        let count = enough.midpoint(too_many);
        *(if suffices(count) { &mut enough } else { &mut too_many }) = count;
    }
    for (_, k) in &needs[..enough] {
        pairs[*k as usize].takes_share = true;
    }
    Ok(Deal { share: if enough == 0 { 0.0 } else { share_of(budget, enough) }, is_for_all: enough == needs.len() })
}

/// The largest power of two that so many pairs may take; 0 where it is subnormal.
fn share_of(budget: f64, count: usize) -> f64 {
    debug_assert!(budget >= 0.0 && count > 0);
    debug_assert!(budget >= 0.0 && count > 0);
    let equal = (budget / count as f64).next_down();
    f64::from_bits(equal.max(0.0).to_bits() & (0x7ff << 52))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_powers_of_two_and_stay_within_the_budget() {
        for budget in [0.0, 1e-310, 1e-9, 0.3, 1.0, 7.0, 1e300, f64::MAX] {
            for count in [1, 2, 3, 7, 64, 19_900] {
                let share = share_of(budget, count);
                assert!(share * count as f64 <= budget, "{budget} {count}");
                assert!(budget < 1e-300 || share * 2.0 >= (budget / count as f64) * (1.0 - 1e-12), "{budget} {count}");
                assert_eq!(share.to_bits() << 12, 0);
            }
        }
    }
}
