//! Adversarial families (`testkit::casts`), judged by exact verdicts all along each motion and by bisection in integers;
//! `examples/hard_motions.rs` does so for hundreds of thousands.

use swiftprox::motion::{CastOutcome, verify_cast};
use testkit::casts::families::{FAMILIES, case};
use testkit::casts::judge::{by_bisection, by_samples};
use testkit::random::Random;

use crate::run;

/// Motions, of all families alike.
const COUNT: usize = 320;

#[test]
fn no_answer_is_refuted_and_all_verify() {
    let mut random = Random::new(0x600d);
    let mut counts = [0; 5];
    for round in 0..COUNT {
        let case = case(&mut random, round);
        let answer = run(case.bodies(), &case.config);
        let family = FAMILIES[round % FAMILIES.len()];
        let judged = by_samples(&case, &answer, 48)
            .and_then(|()| by_bisection(&case, &answer))
            .and_then(|()| verify_cast(case.bodies(), &case.config, &answer).map_err(|error| error.to_string()));
        if let Err(why) = judged {
            panic!("round {round}, {family}: {why}\n{:?}\n{:?}\n{answer:?}", case.motions, case.config);
        }
        counts[answer.outcome as usize] += 1;
    }
    let [_, free, hit, near, budget] = counts;
    assert!(free > 50 && hit > 50, "{counts:?}");
    // Lattice bodies that touch without overlapping, and little else.
    assert!(near < 30 && budget == 0, "{counts:?}");
    assert_eq!(CastOutcome::Budget as usize, 4);
}
