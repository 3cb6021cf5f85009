//! Signed distances are those of distance and depth, to the bit, whatever the cache held.

use super::query;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, PairCache, PairConfig, SignedDistance,
    SignedDistanceCache, contact, depth, distance, signed_distance,
};
use swiftprox::shape::Shape;
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

/// Of a stream of poses that goes in and out of contact: boxes, whose facets are all looked at, and hulls, which keep a polytope.
#[test]
fn it_is_the_distance_or_minus_the_depth() {
    let mut random = Random::new(29);
    let cloud: Vec<Vector> = (0..60).map(|_| random.direction() * 0.7).collect();
    for shape in [cuboid([0.5; 3]), hull(&cloud)] {
        let (mut caches, mut seen) = (SignedDistanceCache::default(), [0; 2]);
        let turn = [random.rotation(), random.rotation()];
        for step in 0..400 {
            let apart = 1.2 + 0.6 * (0.1 * f64::from(step)).sin();
            let there = Vector::new(apart, 0.3, 0.1);
            let poses = [Pose::new(&turn[0], &Vector::zeros()), Pose::new(&turn[1], &there)];
            let answer = ask(&shape, &poses, &mut caches, &PairConfig::default());
            let is_deep = answer.outcome == Outcome::Intersecting;
            seen[usize::from(is_deep)] += 1;
            let [lower, upper, best, normal] = if is_deep {
                let mut deep = DepthAnswer::default();
                let bodies = [shape.at(&poses[0]), shape.at(&poses[1])];
                depth(bodies, &mut DepthCache::default(), &DepthConfig::default(), &mut deep).unwrap();
                [-deep.upper, -deep.lower, -deep.depth, Vector::from(deep.normal).norm()]
            } else {
                let mut far = PairAnswer::default();
                let bodies = [shape.at(&poses[0]), shape.at(&poses[1])];
                distance(bodies, &mut PairCache::default(), &PairConfig::default(), &mut far).unwrap();
                [far.lower, far.upper, far.distance, Vector::from(far.normal).norm()]
            };
            // Both intervals hold, and are narrow.
            let narrow = 1e-13;
            assert!((answer.lower - lower).abs() <= narrow && (answer.upper - upper).abs() <= narrow, "{answer:?}");
            assert!((answer.distance - best).abs() <= narrow && (normal - 1.0).abs() < 1e-15);
            assert_eq!(answer.lower > 0.0, !is_deep);
            let [first, second] = [answer.world1, answer.world2].map(Vector::from);
            let off = (first - second) - Vector::from(answer.normal) * answer.distance;
            assert!(off.norm() <= 1e-12, "{answer:?}");
            let mut manifold = ManifoldCache::default();
            let all = ManifoldConfig { max_distance: f64::INFINITY, ..ManifoldConfig::default() };
            let (contact, _) = query([&shape, &shape], [&poses[0], &poses[1]], &mut manifold, &all);
            assert!((contact.lower - answer.lower).abs() <= narrow && (contact.upper - answer.upper).abs() <= narrow);
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
    }
}

/// Of hulls in each other a contact, a depth and a manifold tell of one facet: features and normals are the same.
#[test]
fn contact_depth_and_manifold_tell_of_one_facet() {
    let mut random = Random::new(45);
    let mut compared = 0;
    for _ in 0..300 {
        let shapes = [(); 2].map(|()| hull(&(0..30).map(|_| random.vector()).collect::<Vec<_>>()));
        let poses = [(); 2].map(|()| Pose::new(&random.rotation(), &(random.vector() * 0.5)));
        let bodies = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
        let mut touch = PairAnswer::default();
        contact(bodies, &mut PairCache::default(), &PairConfig::default(), &mut touch).unwrap();
        if touch.outcome != Outcome::Intersecting {
            continue;
        }
        let (mut signed, mut deep) = (SignedDistance::default(), DepthAnswer::default());
        let config = PairConfig::default();
        signed_distance(bodies, &mut SignedDistanceCache::default(), &config, &mut signed).unwrap();
        depth(bodies, &mut DepthCache::default(), &DepthConfig::default(), &mut deep).unwrap();
        let all = ManifoldConfig::default();
        let (manifold, _) =
            query([&shapes[0], &shapes[1]], [&poses[0], &poses[1]], &mut ManifoldCache::default(), &all);
        assert_eq!([touch.feature1, touch.feature2], [signed.feature1, signed.feature2], "{touch:?} {signed:?}");
        assert_eq!([touch.normal, deep.normal, manifold.normal], [signed.normal; 3], "{touch:?} {signed:?}");
        compared += 1;
    }
    assert!(compared > 250, "{compared}");
}

fn ask(shape: &Shape, poses: &[Pose; 2], cache: &mut SignedDistanceCache, config: &PairConfig) -> SignedDistance {
    let mut answer = SignedDistance::default();
    signed_distance([shape.at(&poses[0]), shape.at(&poses[1])], cache, config, &mut answer).unwrap();
    answer
}

#[test]
fn beyond_the_tolerance_a_lower_end_is_all_that_is_said() {
    let shape = cuboid([0.5; 3]);
    let poses = [Pose::IDENTITY, at(3.0, 0.0, 0.0)];
    let config = PairConfig { max_distance: 1.0, ..PairConfig::default() };
    let answer = ask(&shape, &poses, &mut SignedDistanceCache::default(), &config);
    assert_eq!(answer.outcome, Outcome::Beyond);
    assert!(answer.lower > 1.0 && answer.upper == f64::INFINITY && answer.distance == answer.lower, "{answer:?}");
    let bad = PairConfig { max_distance: f64::NAN, ..config };
    let before = SignedDistance { lower: 7.0, ..SignedDistance::default() };
    let mut kept = before;
    let bodies = [shape.at(&poses[0]), shape.at(&poses[1])];
    assert!(signed_distance(bodies, &mut SignedDistanceCache::default(), &bad, &mut kept).is_err());
    assert_eq!(kept.lower, before.lower);
}
