//! Signed distances, contacts, rays, points and proofs, each against all pieces one by one.

use super::bodies::{self, Body, for_each_pair, placed};
use swiftprox::compound::{
    Compound, CompoundAnswer, CompoundCache, CompoundContacts, CompoundSignedDistance, PlacedCompound, cast_ray,
    contacts, distance, intersection, locate_point, signed_distance, verify,
};
use swiftprox::error::Error;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, Outcome, PairConfig, SignedDistance, SignedDistanceCache};
use swiftprox::point::PointLocation;
use swiftprox::progress::Progress;
use swiftprox::ray::{Ray, RayOutcome};
use testkit::random::Random;

/// Two bodies that overlap, are near or apart.
fn cases() -> Vec<(Body, Body, [Pose; 2])> {
    let mut random = Random::new(0x5d);
    (0..60)
        .map(|round| {
            let pair = match round % 3 {
                0 => (bodies::torus(12), bodies::gear(9)),
                1 => (bodies::any(&mut random, 6), bodies::placed_torus(8)),
                _ => (bodies::any(&mut random, 3), bodies::any(&mut random, 5)),
            };
            (pair.0, pair.1, [bodies::pose(&mut random, 1.2), bodies::pose(&mut random, 1.2)])
        })
        .collect()
}

fn asked(placed: [PlacedCompound; 2], cache: &mut CompoundCache, tolerance: f64) -> CompoundSignedDistance {
    let config = PairConfig { max_distance: tolerance, ..PairConfig::default() };
    let mut answer = CompoundSignedDistance::default();
    signed_distance(placed, cache, &config, &mut answer).unwrap();
    answer
}

#[test]
fn the_signed_distance_is_the_least_of_all_pairs() {
    let mut seen = [0; 2];
    for (one, two, poses) in cases() {
        let bodies = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
        let mut least = [f64::INFINITY; 2];
        let mut each = Vec::new();
        for_each_pair(bodies, |pieces, placed| {
            let mut found = SignedDistance::default();
            let mut cache = SignedDistanceCache::default();
            pair::signed_distance(placed, &mut cache, &PairConfig::default(), &mut found).unwrap();
            least = [least[0].min(found.lower), least[1].min(found.upper)];
            each.push((pieces, found));
        });
        let mut cache = CompoundCache::default();
        for _ in 0..2 {
            let found = asked(bodies, &mut cache, f64::INFINITY);
            let (lower, upper) = (found.distance.lower, found.distance.upper);
            assert!(lower <= least[1] && least[0] <= upper, "{found:?} {least:?}");
            assert!(upper - lower <= 1e-9, "{found:?}");
            assert_eq!(found.distance.outcome == Outcome::Intersecting, least[1] <= 0.0);
            let (_, named) = each.iter().find(|(pieces, _)| *pieces == [found.piece1, found.piece2]).unwrap();
            assert!(named.lower <= upper && lower <= named.upper);
            seen[usize::from(upper <= 0.0)] += 1;
            if lower > 0.0 {
                let beyond = asked(bodies, &mut cache, 0.5 * lower);
                assert_eq!(beyond.distance.outcome, Outcome::Beyond);
                assert!(beyond.distance.lower >= 0.5 * lower && beyond.distance.lower <= upper);
                assert_eq!(beyond.piece1 as usize, one.compound.piece_count());
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn contacts_are_the_manifolds_of_all_near_pairs() {
    let mut count = 0;
    let config = ManifoldConfig { max_distance: 0.05, ..ManifoldConfig::default() };
    for (one, two, poses) in cases() {
        let bodies = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
        let mut found = CompoundContacts::default();
        contacts(bodies, &config, &mut found).unwrap();
        let mut rest = found.contacts.iter();
        for_each_pair(bodies, |pieces, placed| {
            let mut points = [ManifoldPoint::default(); 64];
            let manifold =
                swiftprox::manifold::manifold(placed, &mut ManifoldCache::default(), &config, &mut points).unwrap();
            if manifold.outcome == Outcome::Beyond {
                return;
            }
            let contact = rest.next().unwrap();
            assert_eq!([contact.piece1, contact.piece2], pieces);
            assert_eq!(contact.manifold, manifold);
            let own = &found.points[contact.first_point as usize..][..manifold.point_count as usize];
            assert_eq!(own, &points[..manifold.point_count as usize]);
            count += 1;
        });
        assert!(rest.next().is_none());
    }
    assert!(count > 60, "{count}");
}

#[test]
fn rays_enter_where_they_first_enter_a_piece() {
    let mut random = Random::new(0x4a);
    let mut seen = [0; 3];
    for (one, _, poses) in cases() {
        let body = one.compound.at(&poses[0]);
        for _ in 0..20 {
            let origin = random.vector() * 3.0;
            let aim = poses[0].translation() + random.vector();
            let t_max = [f64::INFINITY, 0.7][random.below(2)];
            let ray = Ray { origin: origin.into(), direction: (aim - origin).into(), t_max };
            let all: Vec<_> = (0..one.compound.piece_count())
                .map(|k| {
                    let pose = placed(body, k);
                    swiftprox::ray::cast_ray(one.compound.pieces()[k].shape.at(&pose), &ray).unwrap()
                })
                .collect();
            let found = cast_ray(body, &ray).unwrap();
            let of = |outcome| all.iter().filter(move |answer| answer.outcome == outcome);
            if of(RayOutcome::Inside).next().is_some() {
                assert_eq!(found.answer.outcome, RayOutcome::Inside);
                assert_eq!(all[found.piece as usize].exit, found.answer.exit);
                seen[0] += 1;
            } else if of(RayOutcome::Hit).next().is_some() {
                assert_eq!(found.answer.outcome, RayOutcome::Hit);
                let first = of(RayOutcome::Hit).map(|answer| answer.entry);
                let least = first.fold([f64::INFINITY; 2], |least, [a, b]| [least[0].min(a), least[1].min(b)]);
                assert_eq!(found.answer.entry, least);
                assert_eq!(all[found.piece as usize].exit, found.answer.exit);
                seen[1] += 1;
            } else {
                assert_eq!(found.answer.outcome, RayOutcome::Miss);
                assert_eq!(found.piece as usize, one.compound.piece_count());
                assert!(found.answer.entry[0].is_nan());
                seen[2] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 5), "{seen:?}");
    // However long the direction is.
    let row = bodies::torus(8);
    for length in [f64::MAX, 1e200, 1e-200, 1e-300] {
        let ray = Ray { origin: [1.0, 0.0, 5.0], direction: [0.0, 0.0, -length], t_max: f64::INFINITY };
        let found = cast_ray(row.compound.at(&Pose::IDENTITY), &ray).unwrap().answer;
        assert_eq!(found.outcome, RayOutcome::Hit);
        assert!(found.entry[0] <= 4.7 / length && found.entry[1] * (1.0 + 1e-9) >= 4.7 / length, "{found:?}");
    }
}

#[test]
fn points_are_located_by_the_least_of_all_pieces() {
    let mut random = Random::new(0x90);
    let mut inside = 0;
    for (one, _, poses) in cases() {
        let body = one.compound.at(&poses[0]);
        for _ in 0..10 {
            let point = (poses[0].translation() + random.vector() * 1.5).into();
            let all: Vec<_> = (0..one.compound.piece_count())
                .map(|k| {
                    let pose = placed(body, k);
                    swiftprox::point::locate_point(one.compound.pieces()[k].shape.at(&pose), point).unwrap()
                })
                .collect();
            let found = locate_point(body, point).unwrap();
            let least = all.iter().map(|answer| answer.upper).fold(f64::INFINITY, f64::min);
            assert!(found.answer.lower <= least && least <= found.answer.upper);
            assert_eq!(all[found.piece as usize].upper, found.answer.upper);
            let is_inside = all.iter().any(|answer| answer.location == PointLocation::Inside);
            assert_eq!(found.answer.location == PointLocation::Inside, is_inside);
            inside += usize::from(is_inside);
        }
    }
    assert!(inside > 20, "{inside}");
    // Two boxes side by side: on the face that they share, which is inside of both together.
    let corners = |x: f64| -> Vec<Vector> {
        (0..8).map(|i| Vector::new(x + f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
    };
    let boxes = Body::new(vec![(corners(0.0), Pose::IDENTITY), (corners(1.0), Pose::IDENTITY)]);
    let on = locate_point(boxes.compound.at(&Pose::IDENTITY), [1.0, 0.5, 0.5]).unwrap();
    assert_eq!((on.answer.location, on.answer.distance), (PointLocation::On, 0.0));
}

fn is_unverified(placed: [PlacedCompound; 2], answer: &CompoundAnswer) -> bool {
    matches!(verify(placed, answer), Err(Error::Unverified(_)))
}

#[test]
fn right_answers_are_proved_and_forgeries_are_not() {
    let mut seen = [0; 2];
    for (one, two, poses) in cases() {
        let placed = [one.compound.at(&poses[0]), two.compound.at(&poses[1])];
        for query in [distance, intersection] {
            let mut answer = CompoundAnswer::default();
            for tolerance in [f64::INFINITY, 0.3] {
                let config = PairConfig { max_distance: tolerance, ..PairConfig::default() };
                query(placed, &mut CompoundCache::default(), &config, &mut answer).unwrap();
                verify(placed, &answer).unwrap();
            }
            query(placed, &mut CompoundCache::default(), &PairConfig::default(), &mut answer).unwrap();
            if answer.answer.outcome == Outcome::Intersecting {
                seen[0] += 1;
                let mut none = answer;
                (none.piece1, none.piece2) = (one.compound.piece_count() as u32, two.compound.piece_count() as u32);
                assert!(matches!(verify(placed, &none), Err(Error::Argument(_))));
                none.answer.outcome = Outcome::Separated;
                none.answer.upper = f64::INFINITY;
                none.answer.proof_count = 0;
                for lower in [0.0, 1e-300] {
                    (none.answer.lower, none.answer.distance) = (lower, lower);
                    assert!(is_unverified(placed, &none), "{none:?}");
                }
                continue;
            }
            seen[1] += 1;
            // No pair of pieces is farther apart than the nearest.
            let mut far = answer;
            let mut nearest = CompoundAnswer::default();
            distance(placed, &mut CompoundCache::default(), &PairConfig::default(), &mut nearest).unwrap();
            far.answer.lower = nearest.answer.upper * (1.0 + 1e-9);
            far.answer.distance = far.answer.lower;
            far.answer.upper = far.answer.upper.max(2.0 * far.answer.lower);
            assert!(is_unverified(placed, &far), "{far:?}");
            let mut met = answer;
            met.answer.outcome = Outcome::Intersecting;
            assert!(verify(placed, &met).is_err());
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

/// An L of two blocks.
#[test]
fn a_mesh_becomes_a_compound_of_its_pieces() {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let vertices: Vec<Vector> = [0.0, 1.0].iter().flat_map(|z| outline.map(|[x, y]| Vector::new(x, y, *z))).collect();
    let mut indices: Vec<u32> = (0..6).rev().chain(6..12).collect();
    let mut valences = vec![6, 6];
    for k in 0..6 {
        let next = (k + 1) % 6;
        indices.extend([k, next, next + 6, k + 6]);
        valences.push(4);
    }
    let mesh = PolygonMesh::new(vertices, indices, Some(&valences)).unwrap();
    let body = Compound::from_mesh(&mesh, 0.0, &mut Progress::new(&mut |_| true)).unwrap();
    assert!(body.piece_count() >= 2);
    let notch = Pose::new(&swiftprox::math::Matrix::identity(), &Vector::new(1.5, 1.5, 0.0));
    let small = Body::new(vec![(
        (0..8).map(|i| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -0.25 } else { 0.25 })).collect(),
        Pose::IDENTITY,
    )]);
    let mut answer = CompoundAnswer::default();
    let placed = [body.at(&Pose::IDENTITY), small.compound.at(&notch)];
    distance(placed, &mut CompoundCache::default(), &PairConfig::default(), &mut answer).unwrap();
    assert_eq!(answer.answer.outcome, Outcome::Separated);
    assert!(answer.answer.lower <= 0.25 && 0.25 <= answer.answer.upper);
    let cancelled = Compound::from_mesh(&mesh, 0.0, &mut Progress::new(&mut |_| false)).unwrap_err();
    assert!(matches!(cancelled, Error::Cancelled(_)));
}
