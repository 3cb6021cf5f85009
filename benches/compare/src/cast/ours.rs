//! This library's casts, and its verdicts at times along the motion.

use swiftprox::motion::{CastAnswer, CastOutcome, cast};
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, intersection};
use testkit::casts::Case;

use super::scenes::Scene;
use super::{Caster, Said};

pub const NAME: &str = "swiftprox";

/// `motion::cast`, the pair's cache carried on.
pub struct Cast<'a> {
    cases: &'a [Case],
    cache: PairCache,
    answer: CastAnswer,
}

impl<'a> Cast<'a> {
    pub fn new(scene: &'a Scene) -> Cast<'a> {
        Cast { cases: &scene.cases, cache: PairCache::default(), answer: CastAnswer::default() }
    }
}

impl Caster for Cast<'_> {
    fn name(&self) -> &str {
        NAME
    }

    fn forget(&mut self) {
        self.cache = PairCache::default();
    }

    fn cast(&mut self, motion: usize) -> Said {
        let case = &self.cases[motion];
        match cast(case.bodies(), &mut self.cache, &case.config, &mut self.answer) {
            Ok(()) if self.answer.outcome == CastOutcome::Free => Said::Free,
            Ok(()) if self.answer.outcome == CastOutcome::Hit => Said::Hit(self.answer.time_upper),
            _ => Said::Unknown,
        }
    }

    fn queries(&self) -> f64 {
        f64::from(self.answer.queries)
    }
}

/// Verdicts at equal steps, the cache carried on, until one is contact.
pub struct Samples<'a> {
    cases: &'a [Case],
    count: u32,
    name: String,
    cache: PairCache,
}

impl<'a> Samples<'a> {
    pub fn new(scene: &'a Scene, count: u32) -> Samples<'a> {
        Samples { cases: &scene.cases, count, name: format!("samples-{count}"), cache: PairCache::default() }
    }
}

impl Caster for Samples<'_> {
    fn name(&self) -> &str {
        &self.name
    }

    fn forget(&mut self) {
        self.cache = PairCache::default();
    }

    fn cast(&mut self, motion: usize) -> Said {
        let case = &self.cases[motion];
        let (config, mut answer) = (PairConfig::default(), PairAnswer::default());
        for k in 0..self.count {
            let time = f64::from(k) / f64::from(self.count - 1);
            let poses = case.poses(time);
            let bodies = [case.shapes[0].at(&poses[0]), case.shapes[1].at(&poses[1])];
            if intersection(bodies, &mut self.cache, &config, &mut answer).is_err() {
                return Said::Unknown;
            }
            if answer.outcome == Outcome::Intersecting {
                return Said::Hit(time);
            }
        }
        Said::Free
    }
}
