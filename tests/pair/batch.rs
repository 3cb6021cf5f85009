//! Many pairs at once: bit for bit what each is asked for itself, whoever works, and refused pairs among others.

use swiftprox::error::Error;
use swiftprox::math::Pose;
use swiftprox::pair::contact;
use swiftprox::pair::{
    self, Outcome, PairAnswer, PairCache, PairConfig, PairQuestion, Placed, Query, approximate, batch, distance,
    intersection,
};
use swiftprox::scene::Workers;
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::models::ellipsoid;
use testkit::random::Random;
use testkit::shapes::{at, cuboid};

const COUNT: usize = 2500;

fn shapes() -> [Shape; 3] {
    let round = |n: usize| Shape::from_mesh(&ellipsoid([0.7, 0.5, 0.4], n).unwrap(), &ShapeOptions::default()).unwrap();
    [cuboid([0.5, 0.3, 0.7]), round(30), round(200)]
}

/// What some threads do of parts, the last part first.
fn threads() -> Workers {
    Workers::new(3, |parts, work| {
        std::thread::scope(|threads| {
            (0..3).for_each(|thread| _ = threads.spawn(move || (thread..parts).rev().step_by(3).for_each(work)));
        });
    })
}

#[test]
fn the_bits_are_those_of_single_queries() {
    let (shapes, mut random) = (shapes(), Random::new(0xba7c4));
    let mut single = vec![PairCache::default(); COUNT];
    let (mut alone, mut shared) = (single.clone(), single.clone());
    let workers = threads();
    for query in [Query::Distance, Query::Intersection, Query::Contact, Query::Approximate, Query::Distance] {
        let poses: Vec<[Pose; 2]> =
            (0..COUNT).map(|_| [(); 2].map(|()| Pose::new(&random.rotation(), &(random.vector() * 1.5)))).collect();
        let bodies = |k: usize| -> [Placed; 2] { [shapes[k % 3].at(&poses[k][0]), shapes[k / 3 % 3].at(&poses[k][1])] };
        let config = PairConfig { absolute_error: 0.05, ..PairConfig::default() };
        let solver = match query {
            Query::Intersection => intersection,
            Query::Distance => distance,
            Query::Contact => contact,
            Query::Approximate => approximate,
        };
        let mut expected = vec![PairAnswer::default(); COUNT];
        for (k, (cache, answer)) in single.iter_mut().zip(&mut expected).enumerate() {
            solver(bodies(k), cache, &config, answer).unwrap();
        }
        for (caches, workers) in [(&mut alone, None), (&mut shared, Some(&workers))] {
            let mut answers = vec![PairAnswer::default(); COUNT];
            let mut pairs: Vec<PairQuestion> =
                caches.iter_mut().enumerate().map(|(k, cache)| PairQuestion { bodies: bodies(k), cache }).collect();
            batch(query, &mut pairs, &config, &mut answers, workers).unwrap();
            // As text, since NaN is not equal to itself.
            for (answer, expected) in answers.iter().zip(&expected) {
                assert_eq!(format!("{answer:?}"), format!("{expected:?}"));
            }
        }
        assert!(alone == single && shared == single);
    }
}

#[test]
fn a_pair_that_is_refused_keeps_no_other_from_its_answer() {
    let (shapes, poses) = (shapes(), [at(0.0, 0.0, 0.0), at(3.0, 0.0, 0.0), at(f64::NAN, 0.0, 0.0)]);
    let workers = threads();
    for workers in [None, Some(&workers)] {
        let mut caches = vec![PairCache::default(); COUNT];
        let mut answers = vec![PairAnswer { lower: 7.0, ..PairAnswer::default() }; COUNT];
        let pose = |k: usize| if k == 5 || k == 2100 { &poses[2] } else { &poses[1] };
        let mut pairs: Vec<PairQuestion> = caches
            .iter_mut()
            .enumerate()
            .map(|(k, cache)| PairQuestion { bodies: [shapes[0].at(&poses[0]), shapes[1].at(pose(k))], cache })
            .collect();
        let refused = batch(Query::Distance, &mut pairs, &PairConfig::default(), &mut answers, workers);
        assert!(matches!(&refused, Err(Error::Pose(message)) if message.starts_with("pair 5: ")), "{refused:?}");
        for (k, answer) in answers.iter().enumerate() {
            let is_refused = k == 5 || k == 2100;
            assert_eq!(answer.outcome, if is_refused { Outcome::None } else { Outcome::Separated }, "{k}");
            assert_eq!(answer.lower.is_nan(), is_refused, "{k}");
        }
        let few = &mut answers[1..];
        let uneven = pair::batch(Query::Distance, &mut pairs, &PairConfig::default(), few, workers);
        assert!(matches!(&uneven, Err(Error::Argument(message)) if message.contains("2499 answers for 2500 pairs")));
    }
}
