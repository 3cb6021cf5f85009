//! Whatever triangles there are: slivers, duplicates, points, holes, any scale. Nothing panics, and what is said holds.

use swiftprox::error::Error;
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, ground_contacts, ground_distance};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Query};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;

/// Triangles through few places: many are slivers, lines, points or the same as others.
fn soup(random: &mut Random, scale: f64) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let mut vertices: Vec<Vector> = (0..9).map(|_| random.vector() * scale).collect();
    // On a line up to rounding, hardly beside it, at the same place.
    vertices.push((vertices[0] + vertices[1]) * 0.5);
    vertices.push(vertices[0] + (vertices[1] - vertices[0]) * 0.3 + random.vector() * scale * random.power(-50, -10));
    vertices.push(vertices[2]);
    let triangles = (0..40).map(|_| std::array::from_fn(|_| random.below(vertices.len()) as u32)).collect::<Vec<_>>();
    let twice = triangles.iter().take(5).copied();
    (vertices.clone(), triangles.iter().copied().chain(twice).collect())
}

/// Each triangle as a shape of its own.
fn shapes(vertices: &[Vector], triangles: &[[u32; 3]]) -> Vec<Shape> {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let has_area = |corners: &[Vector; 3]| {
        let [a, b, c] = corners;
        (b - a).cross(&(c - a)).norm() > 1e-10 * (b - a).norm() * (c - a).norm()
    };
    let corners = triangles.iter().map(|triangle| triangle.map(|v| vertices[v as usize]));
    corners.filter(has_area).map(|corners| Shape::from_points(&corners, &options).unwrap()).collect()
}

#[test]
fn any_soup_is_answered_as_its_triangles_are() {
    let mut random = Random::new(0xa77);
    let (mut met, mut apart, mut held) = (0, 0, 0);
    for round in 0..120 {
        let scale = match round % 4 {
            0 => 1.0,
            1 => random.power(-150, -40),
            2 => random.power(40, 150),
            _ => random.power(-8, 8),
        };
        let (vertices, triangles) = soup(&mut random, scale);
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        let cloud: Vec<Vector> = (0..8).map(|_| random.vector() * 0.3 * scale).collect();
        let options = ShapeOptions {
            input: InputPolicy::Hull,
            swept_radius: [0.0, 0.1 * scale][round / 4 % 2],
            ..ShapeOptions::default()
        };
        let body = Shape::from_points(&cloud, &options).unwrap();
        let pose = Pose::new(&random.rotation(), &(random.vector() * 0.7 * scale));
        let place = Pose::new(&random.rotation(), &(random.vector() * 0.1 * scale));
        let config = PairConfig::default();
        let found = ground_distance(Query::Distance, body.at(&pose), ground.at(&place), &config).unwrap();
        let verdict = ground_distance(Query::Intersection, body.at(&pose), ground.at(&place), &config).unwrap();
        assert_eq!(found.answer.outcome, verdict.answer.outcome, "{round}");
        assert!(found.answer.lower <= found.answer.upper, "{round}");
        for triangle in shapes(&vertices, &triangles) {
            let mut own = PairAnswer::default();
            pair::distance([body.at(&pose), triangle.at(&place)], &mut PairCache::default(), &config, &mut own)
                .unwrap();
            assert!(found.answer.lower <= own.upper, "{round}: {own:?}");
            assert!(own.outcome != Outcome::Intersecting || found.answer.outcome == Outcome::Intersecting, "{round}");
        }
        let is_met = found.answer.outcome == Outcome::Intersecting;
        (met, apart) = (met + usize::from(is_met), apart + usize::from(!is_met));
        let mut contacts = GroundContacts::default();
        for (max_distance, reduces) in [(0.0, true), (0.2 * scale, false), (f64::INFINITY, true)] {
            let config = ManifoldConfig { max_distance, reduces };
            ground_contacts(body.at(&pose), ground.at(&place), &config, &mut contacts).unwrap();
            for contact in &contacts.contacts {
                let normal = Vector::from(contact.manifold.normal);
                assert!((normal.norm() - 1.0).abs() < 1e-12, "{round}: {contact:?}");
                assert!(contact.manifold.lower <= contact.manifold.upper && contact.manifold.point_count > 0);
                // Only what intersects is deep.
                assert!(is_met || contact.manifold.outcome != Outcome::Intersecting, "{round}: {contact:?}");
                held += 1;
            }
            let ends =
                contacts.contacts.iter().map(|contact| contact.first_point + contact.manifold.point_count as usize);
            assert_eq!(ends.max().unwrap_or(0), contacts.points.len());
            assert!(contacts.points.iter().all(|point| point.gap_lower <= point.gap_upper), "{round}");
        }
    }
    assert!(met > 15 && apart > 15 && held > 300, "{met} {apart} {held}");
}

#[test]
fn any_heights_make_a_ground_or_an_error() {
    let mut random = Random::new(0x4e1);
    let mut seen = [0; 2];
    for _ in 0..200 {
        let odd = [f64::NAN, f64::INFINITY, -0.0, 1e-320, 1e60, -1e61, 1e-70, f64::MAX];
        let mut heights: Vec<f64> = (0..16).map(|_| random.signed()).collect();
        for _ in 0..random.below(4) {
            heights[random.below(16)] = odd[random.below(odd.len())];
        }
        let spacing = [random.power(-150, 150), random.power(-3, 3)];
        match Ground::from_heights(&HeightGrid { rows: 4, columns: 4, spacing, heights: &heights }) {
            Ok(ground) => {
                let body = testkit::shapes::cuboid([0.5; 3]);
                let mut contacts = GroundContacts::default();
                let (config, pose) = (ManifoldConfig::default(), testkit::shapes::at(spacing[0], spacing[1], 0.5));
                ground_contacts(body.at(&pose), ground.at(&Pose::IDENTITY), &config, &mut contacts).unwrap();
                seen[0] += 1;
            }
            Err(error) => {
                assert!(matches!(error, Error::Mesh(_)), "{error:?}");
                seen[1] += 1;
            }
        }
    }
    assert!(seen.iter().all(|count| *count > 10), "{seen:?}");
}
