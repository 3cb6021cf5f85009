//! A ground of one triangle, whose rim lets contacts have all normals but those to its back: the normal is then that along which
//! body and triangle are nearest, or overlap least, whichever way it was found.

use super::contacts::bodies;
use swiftprox::ground::{Ground, GroundContacts, PlacedGround, ground_contacts};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig, Placed, SignedDistance, SignedDistanceCache, signed_distance};
use swiftprox::shape::Shape;
use testkit::random::{Random, rotation};
use testkit::shapes::hull;

/// How far a body is from a triangle along a direction: less than 0 where they overlap.
fn gap(body: Placed, triangle: PlacedGround, corners: &[Vector; 3], normal: &Vector) -> f64 {
    let polyhedron = body.shape.polyhedron();
    let heights =
        (0..polyhedron.vertices.len() as u32).map(|v| normal.dot(&body.pose.transform(&polyhedron.local_position(v))));
    let lowest = heights.fold(f64::INFINITY, f64::min) - body.shape.swept_radius();
    let highest =
        corners.map(|corner| normal.dot(&triangle.pose.transform(&corner))).into_iter().fold(f64::MIN, f64::max);
    lowest - highest
}

fn pair_of(bodies: [Placed; 2]) -> SignedDistance {
    let mut found = SignedDistance::default();
    signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut found).unwrap();
    found
}

#[test]
fn normals_are_those_of_the_least_way() {
    let mut random = Random::new(0x1ea5);
    let (config, mut found) =
        (ManifoldConfig { max_distance: 0.05, ..ManifoldConfig::default() }, GroundContacts::default());
    // Deep, apart, and beyond `max_distance`.
    let mut seen = [0; 3];
    for round in 0..1200 {
        let size = [0.3, 1.0, 4.0][round % 3];
        let corners = [(); 3].map(|()| {
            let flat = random.vector() * size;
            Vector::new(flat.x, flat.y, flat.z * 0.1)
        });
        let Ok(ground) = Ground::from_triangles(&corners, &[[0, 1, 2]]) else { continue };
        let triangle = hull(&corners);
        let shapes: [Shape; 3] = bodies(&mut random);
        let shape = &shapes[round / 3 % 3];
        let aside = if round % 2 == 0 { Vector::zeros() } else { random.vector() * 100.0 };
        let skew = if round % 5 == 0 { random.vector() * 1e-3 } else { Vector::zeros() };
        let skewed = Matrix::identity() + Matrix::from_diagonal(&skew);
        let place = Pose::new(&(random.rotation() * skewed), &aside);
        // Over some point of it, on either side, as high as its lowest vertex makes it stand.
        let weights = [(); 3].map(|()| random.uniform(-0.1, 1.0));
        let point =
            (corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]) / weights.iter().sum::<f64>();
        let up = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
        let turn = rotation(&random.direction(), random.uniform(0.0, 0.4)) * skewed;
        let at = |height: f64| Pose::new(&(place.rotation() * turn), &place.transform(&(point + up * height)));
        let pose = at(0.0);
        let above = pair_of([shape.at(&pose), triangle.at(&place)]).distance;
        let pose = at(-above + random.uniform(-0.02, 0.1));
        let (body, own) = (shape.at(&pose), ground.at(&place));
        let truth = pair_of([body, triangle.at(&place)]);
        ground_contacts(body, own, &config, &mut found).unwrap();
        let is_near = truth.lower <= config.max_distance;
        let Some(contact) = found.contacts.first() else {
            // Beyond `max_distance`, or it acts on what is in front of it alone.
            let centre = pose.transform(&shape.polyhedron().mass.centre_of_mass);
            let height =
                place.rotation().try_inverse().unwrap().tr_mul(&up).dot(&(centre - place.transform(&corners[0])));
            assert!(!is_near || height < 1e-9, "{round}: {truth:?}");
            seen[2] += 1;
            continue;
        };
        let manifold = &contact.manifold;
        assert_eq!(manifold.outcome == Outcome::Intersecting, truth.outcome == Outcome::Intersecting, "{round}");
        assert!(truth.lower <= config.max_distance, "{round}: {truth:?}");
        let normal = Vector::from(manifold.normal);
        let along = gap(body, own, &corners, &normal);
        let rounding = 1e-12 * (1.0 + aside.norm());
        // Where the least way leads to the triangle's back, it is the best across a side.
        let (back, slope) =
            (place.rotation().tr_mul(&Vector::from(truth.normal)), place.rotation().tr_mul(&normal).normalize());
        let is_back = back.dot(&up) < 1e-6;
        assert!(slope.dot(&up) > -1e-6, "{round}: {slope:?}");
        assert!((along - truth.distance).abs() <= rounding || is_back, "{round}: {along:e} {truth:?} {manifold:?}");
        for step in 0..30 {
            let [tail, head] = [corners[step % 3], corners[(step + 1) % 3]];
            let outward = (head - tail).cross(&up).normalize();
            let (sine, cosine) = random.uniform(0.0, std::f64::consts::FRAC_PI_2).sin_cos();
            let other = place.rotation().try_inverse().unwrap().tr_mul(&(up * cosine + outward * sine)).normalize();
            assert!(gap(body, own, &corners, &other) <= along + rounding, "{round}: {other:?} {manifold:?}");
        }
        // No direction parts them farther.
        assert!(along <= truth.upper + rounding, "{round}");
        seen[usize::from(truth.outcome != Outcome::Intersecting)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 90), "{seen:?}");
}
