//! Casts many adversarial motions and judges each answer: by verdicts all along the motion, by bisection in integers, by its proof.
//! Prints a line a family, and every answer that was refuted; the status is 1 if one was.
//!
//!   cargo run --release --example hard_motions -- [--count N] [--seed N] [--samples N]
//!
//! `--count 800000` takes some twenty minutes of one core. Motions of one seed are the same everywhere, so several seeds can share
//! the work.

use std::process::ExitCode;

use swiftprox::motion::{CastAnswer, cast, verify_cast};
use swiftprox::pair::PairCache;
use testkit::casts::Case;
use testkit::casts::families::{FAMILIES, case};
use testkit::casts::judge::{by_bisection, by_samples};
use testkit::random::Random;

const USAGE: &str = "usage: hard_motions [--count N] [--seed N] [--samples N]";

/// Motions from one to the next line of what was done so far.
const REPORT: usize = 20_000;

struct Arguments {
    count: usize,
    seed: u64,
    samples: u32,
}

/// What became of the motions of a family.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    /// By outcome: none, free, hit, near, budget.
    outcomes: [u64; 5],
    /// Hits whose interval is wider than the tolerance.
    wide: u64,
    most_queries: u32,
    wrong: u64,
    unverified: u64,
}

fn main() -> ExitCode {
    let arguments = match arguments() {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("hard_motions: {message}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    let mut random = Random::new(arguments.seed);
    let mut tallies = [Tally::default(); FAMILIES.len()];
    for round in 0..arguments.count {
        let case = case(&mut random, round);
        judge(&case, round, arguments.samples, &mut tallies[round % FAMILIES.len()]);
        if (round + 1) % REPORT == 0 {
            let wrong: u64 = tallies.iter().map(|tally| tally.wrong + tally.unverified).sum();
            eprintln!("{} of {} motions, {wrong} wrong or unproved", round + 1, arguments.count);
        }
    }
    println!("family,free,hit,near,budget,wide,most queries,wrong,unverified");
    for (family, tally) in FAMILIES.iter().zip(&tallies) {
        let [_, free, hit, near, budget] = tally.outcomes;
        let Tally { wide, most_queries, wrong, unverified, .. } = tally;
        println!("{family},{free},{hit},{near},{budget},{wide},{most_queries},{wrong},{unverified}");
    }
    let is_clean = tallies.iter().all(|tally| tally.wrong == 0 && tally.unverified == 0);
    if is_clean { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn judge(case: &Case, round: usize, samples: u32, tally: &mut Tally) {
    let mut answer = CastAnswer::default();
    let asked = cast(case.bodies(), &mut PairCache::default(), &case.config, &mut answer);
    let judged = asked
        .map_err(|error| error.to_string())
        .and_then(|()| by_samples(case, &answer, samples))
        .and_then(|()| by_bisection(case, &answer));
    if let Err(why) = judged {
        tally.wrong += 1;
        println!("{round}: {why}\n{:?}\n{:?}\n{answer:?}", case.motions, case.config);
    }
    if let Err(error) = verify_cast(case.bodies(), &case.config, &answer) {
        tally.unverified += 1;
        println!("{round}: {error}\n{:?}\n{:?}\n{answer:?}", case.motions, case.config);
    }
    tally.outcomes[answer.outcome as usize] += 1;
    tally.wide += u64::from(answer.time_upper - answer.time_lower > case.config.time_tolerance);
    tally.most_queries = tally.most_queries.max(answer.queries);
}

fn arguments() -> Result<Arguments, String> {
    let mut arguments = Arguments { count: 8_000, seed: 1, samples: 150 };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next().ok_or(format!("{word}: a value is missing"))?;
        let number = value.parse::<u64>().map_err(|_| format!("{value}: not a number"))?;
        match word.as_str() {
            "--count" => arguments.count = number as usize,
            "--seed" => arguments.seed = number,
            "--samples" if number > 0 => {
                arguments.samples = number.try_into().map_err(|_| format!("{value}: too many"))?
            }
            _ => return Err(format!("{word} {value}: unknown or out of range")),
        }
    }
    Ok(arguments)
}
