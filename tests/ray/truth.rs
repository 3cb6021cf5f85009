//! Rays against exact rationals.

use swiftprox::ray::{RayOutcome, cast_ray};
use testkit::random::Random;
use testkit::rays::{Case, anywhere, check, on_lattice};
use testkit::shapes::hull;

/// Checks a case; its outcome, and whether doubles sufficed.
fn try_case(case: &Case) -> (RayOutcome, bool) {
    let shape = hull(&case.points);
    let answer = cast_ray(shape.at(&case.pose), &case.ray).unwrap();
    check(case, &answer);
    (answer.outcome, answer.exact == 0)
}

/// Counts of misses, hits and rays from inside, and of those that doubles decided.
fn try_all(seed: u64, count: usize, make: fn(&mut Random) -> Case) -> [usize; 4] {
    let mut random = Random::new(seed);
    let mut counts = [0; 4];
    for _ in 0..count {
        let (outcome, in_doubles) = try_case(&make(&mut random));
        counts[outcome as usize - 1] += 1;
        counts[3] += usize::from(in_doubles);
    }
    counts
}

#[test]
fn on_lattices() {
    let counts = try_all(1, 46_000, on_lattice);
    assert!(counts.iter().all(|&count| count > 2_500), "{counts:?}");
}

#[test]
fn rays_anywhere() {
    let counts = try_all(2, 8_000, anywhere);
    assert!(counts.iter().all(|&count| count > 200), "{counts:?}");
}

/// Ten times as many, other ones, for changes of rays: `cargo test --profile checked --test ray -- --ignored`.
#[test]
#[ignore = "takes minutes; the tests above are a tenth of it"]
fn a_million() {
    println!("{:?}", try_all(3, 920_000, on_lattice));
    println!("{:?}", try_all(4, 80_000, anywhere));
}
