//! A query allocates nothing but in integer arithmetic, which it counts.

use swiftprox::pair::{DepthAnswer, DepthCache};
use testkit::counting::{Counting, allocations};

use crate::bodies::{large, placed_deep};
use crate::{Random, query};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn depth_queries_allocate_nothing() {
    assert_eq!(size_of::<DepthCache>(), 800);
    let mut random = Random::new(8);
    let shapes = large(&mut random);
    let mut cache = DepthCache::default();
    let mut without_integers = 0;
    for _ in 0..2_000 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let poses = placed_deep(&mut random, pair);
        let mut answer = DepthAnswer::default();
        let count = allocations(|| answer = query(pair, [&poses[0], &poses[1]], &mut cache));
        let is_exact = answer.statistics.exact_iterations > 0;
        assert!(count == 0 || is_exact, "{count} allocations: {answer:?}");
        without_integers += usize::from(!is_exact);
    }
    assert!(without_integers > 1_900, "{without_integers}");
}
