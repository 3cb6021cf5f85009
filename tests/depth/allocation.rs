//! A query allocates nothing but in integer arithmetic, which it counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use swiftprox::pair::DepthCache;

use crate::bodies::{large, placed_deep};
use crate::{Random, query};

struct Counting;

thread_local! {
    /// Of this thread alone: the test harness allocates in others.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is handed to the system's allocator unchanged; the counter neither allocates nor has a destructor.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.set(ALLOCATIONS.get() + 1);
        // SAFETY: the caller's promise, passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise, passed on; `alloc` hands out the system's pointers.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn depth_queries_allocate_nothing() {
    assert_eq!(size_of::<DepthCache>(), 1396);
    let mut random = Random::new(8);
    let shapes = large(&mut random);
    let mut cache = DepthCache::default();
    let mut without_integers = 0;
    for _ in 0..2_000 {
        let pair = [&shapes[random.below(shapes.len())], &shapes[random.below(shapes.len())]];
        let poses = placed_deep(&mut random, pair);
        let before = ALLOCATIONS.get();
        let answer = query(pair, [&poses[0], &poses[1]], &mut cache);
        let count = ALLOCATIONS.get() - before;
        let is_exact = answer.statistics.exact_iterations > 0;
        assert!(count == 0 || is_exact, "{count} allocations: {answer:?}");
        without_integers += usize::from(!is_exact);
    }
    assert!(without_integers > 1_900, "{without_integers}");
}
