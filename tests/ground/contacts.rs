//! Contacts: no ghost normals, one contact on a plane of many triangles, and only from the front.

use super::{hills, level};
use swiftprox::ground::{Ground, GroundContacts, ground_contacts};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{HalfSpace, Outcome, half_space_distance};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::oracle::{rational, transform};
use testkit::random::Random;
use testkit::shapes::{at, cuboid, hull};

pub fn contacts(body: &Shape, pose: &Pose, ground: &Ground, max_distance: f64, reduces: bool) -> GroundContacts {
    let config = ManifoldConfig { max_distance, reduces };
    let mut found = GroundContacts::default();
    ground_contacts(body.at(pose), ground.at(&Pose::IDENTITY), &config, &mut found).unwrap();
    found
}

/// A sphere of radius 0.5 (a point, swept), a cube and a round hull.
pub fn bodies(random: &mut Random) -> [Shape; 3] {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 0.5, ..ShapeOptions::default() };
    let round: Vec<Vector> = (0..60).map(|_| random.direction() * 0.5).collect();
    [Shape::from_points(&[Vector::zeros()], &options).unwrap(), cuboid([0.5, 0.5, 0.25]), hull(&round)]
}

/// A flat triangle as a piece pushes along the least translation: of 7,070 normals on ground of at most 16° 506 were over 45° off.
/// On a ground none is, though bodies stand as deep in it as they then did, and each that touches it from above has a contact.
#[test]
fn no_normal_on_gentle_hills_is_steep() {
    let mut random = Random::new(0x5_1de);
    let (mut normals, mut deep, mut points) = (0, 0, 0);
    for round in 0..12 {
        let side = [8, 24][round % 2];
        let (mut vertices, triangles) = hills(&mut random, side, f64::tan(16_f64.to_radians()));
        // The corners of cells half as long as a body.
        vertices.iter_mut().for_each(|vertex| *vertex *= [1.0, 0.25][round % 2]);
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        let size = vertices.last().unwrap().x;
        for body in bodies(&mut random) {
            for _ in 0..40 {
                let aside = random.uniform(0.3, 0.7);
                let height = random.uniform(0.15, 0.55);
                let turn = testkit::random::rotation(&random.direction(), random.uniform(0.0, 0.3));
                let pose = Pose::new(&turn, &Vector::new(aside * size, random.uniform(0.3, 0.7) * size, height));
                let found = contacts(&body, &pose, &ground, 0.02, round % 3 == 0);
                for contact in &found.contacts {
                    normals += 1;
                    let up = contact.manifold.normal[2];
                    assert!(up >= f64::cos(16.1_f64.to_radians()), "{round}: {contact:?}");
                    deep += usize::from(contact.manifold.outcome == Outcome::Intersecting);
                    points += contact.manifold.point_count;
                    assert!(contact.manifold.point_count > 0);
                }
                let is_met = {
                    let (query, config) = (swiftprox::pair::Query::Intersection, Default::default());
                    let place = Pose::IDENTITY;
                    let met =
                        swiftprox::ground::ground_distance(query, body.at(&pose), ground.at(&place), &config).unwrap();
                    met.answer.outcome == Outcome::Intersecting
                };
                let is_held = found.contacts.iter().any(|contact| contact.manifold.outcome == Outcome::Intersecting);
                assert_eq!(is_met, is_held, "{round}: {pose:?}");
            }
        }
    }
    println!("{normals} normals, {deep} of them deep, {points} points: none steeper than the ground");
    assert!(normals > 1000 && deep > 500 && points > 2000, "{normals} {deep} {points}");
}

/// A table of many triangles says of a body what one of two triangles does: whether they meet, and how deep. On its inside the
/// body's own corners alone make points. Half of the bodies stand over its rim, and tables are turned.
#[test]
fn fine_tables_are_as_coarse_ones() {
    let mut random = Random::new(0xf1e);
    let (mut met, mut apart, mut over_rim, mut points) = (0, 0, 0, 0);
    let (coarse, fine) = (level(2, 2, 4.0), level(33, 33, 0.125));
    let at_rest = |body: &Shape, pose: &Pose, ground: &Ground, place: &Pose| {
        let mut found = GroundContacts::default();
        let config = ManifoldConfig { max_distance: 0.01, reduces: false };
        ground_contacts(body.at(pose), ground.at(place), &config, &mut found).unwrap();
        found
    };
    for round in 0..300 {
        let bodies = bodies(&mut random);
        let body = &bodies[round % 3];
        // Turned by eighths, level ground has coordinates that are rounded.
        let place = if round % 4 < 2 { Pose::IDENTITY } else { Pose::new(&random.rotation(), &random.vector()) };
        let lean = random.uniform(0.0, [1e-9, 1e-3, 0.3][round % 5 % 3]);
        let turn = testkit::random::rotation(&Vector::z(), random.uniform(0.0, 6.0));
        let turn = testkit::random::rotation(&Vector::x(), lean) * turn;
        let is_over_rim = round % 2 == 0;
        let aside = if is_over_rim { random.uniform(-0.3, 0.3) } else { random.uniform(1.0, 3.0) };
        // Its lowest point is so high.
        let low = Pose::new(&turn, &Vector::zeros());
        let mut height = 0.01 - random.uniform(0.0, 0.02);
        let plane = HalfSpace { normal: [0.0, 0.0, 1.0], offset: -10.0 };
        height += 10.0 - half_space_distance(body.at(&low), &plane).unwrap().distance;
        let over = Pose::new(&turn, &Vector::new(aside, random.uniform(1.0, 3.0), height));
        let pose = Pose::new(&(place.rotation() * over.rotation()), &place.transform(&over.translation()));
        let [one, many] = [&coarse, &fine].map(|ground| at_rest(body, &pose, ground, &place));
        let least = |found: &GroundContacts| {
            let gaps = found.contacts.iter().map(|contact| (contact.manifold.lower, contact.manifold.outcome));
            gaps.fold((f64::INFINITY, Outcome::Beyond), |least, one| if one.0 < least.0 { one } else { least })
        };
        let ((gap, outcome), (fine_gap, fine_outcome)) = (least(&one), least(&many));
        assert_eq!(outcome, fine_outcome, "{round}: {gap} {fine_gap}");
        // A rim has normals that lean, where a triangle inside has not.
        if !is_over_rim {
            assert!(gap == fine_gap || (gap - fine_gap).abs() < 1e-9, "{round}: {gap} {fine_gap}");
            let of_body = |found: &GroundContacts| found.points.iter().map(|point| point.feature1).collect::<Vec<_>>();
            let [coarse_points, fine_points] = [of_body(&one), of_body(&many)];
            assert!(many.contacts.len() <= 1, "{round}: {:?}", many.contacts);
            assert!(fine_points.len() <= coarse_points.len(), "{round}: {fine_points:?} {coarse_points:?}");
        }
        for (outcome, count) in [(Outcome::Intersecting, &mut met), (Outcome::Separated, &mut apart)] {
            *count += usize::from(fine_outcome == outcome);
        }
        over_rim += usize::from(is_over_rim && fine_outcome == Outcome::Intersecting);
        points += many.points.len();
    }
    assert!(met > 60 && apart > 30 && over_rim > 20, "{met} {apart} {over_rim} {points}");
}

/// Where no corner of a body is over the inside of a table, the table's rim holds it, and a dome its middle.
#[test]
fn what_no_corner_is_over_holds_a_body() {
    let (plate, fine) = (cuboid([9.0, 9.0, 0.5]), level(33, 33, 0.125));
    let found = contacts(&plate, &at(2.0, 2.0, 0.499), &fine, 0.0, true);
    let [contact] = found.contacts[..] else { panic!("{:?}", found.contacts) };
    assert_eq!((contact.manifold.outcome, contact.manifold.point_count), (Outcome::Intersecting, 4));
    // It bends by less from cell to cell than what counts as a plane.
    let side = 201;
    let bow = |at: usize| (at as f64 - 100.0) * (at as f64 - 100.0);
    let heights: Vec<f64> = (0..side * side).map(|v| -1e-7 * (bow(v % side) + bow(v / side))).collect();
    let grid = swiftprox::ground::HeightGrid { rows: side, columns: side, spacing: [1.0; 2], heights: &heights };
    let dome = Ground::from_heights(&grid).unwrap();
    for (sunk, is_met) in [(2e-4, true), (-1e-5, false)] {
        // Its corners are 4e-4 above the dome, those of the dome in its middle below.
        let found = contacts(&cuboid([45.0, 45.0, 1.0]), &at(100.3, 100.4, 1.0 - sunk), &dome, 1e-4, false);
        assert!(!found.contacts.is_empty());
        let is_deep = found.contacts.iter().any(|contact| contact.manifold.outcome == Outcome::Intersecting);
        assert_eq!(is_deep, is_met);
    }
}

/// A box on a level ground stands on its four corners, however many triangles are below it.
#[test]
fn a_plane_of_many_triangles_is_one_contact() {
    let cube = cuboid([0.5, 0.5, 0.5]);
    for (spacing, depth) in [(10.0, 0.0), (0.3, 0.001), (0.1, -0.001), (0.07, 0.25)] {
        let ground = level(41, 41, spacing);
        let middle = 20.0 * spacing + 0.013;
        let found = contacts(&cube, &at(middle, middle, 0.5 - depth), &ground, 0.01, true);
        let [contact] = found.contacts[..] else { panic!("{spacing}: {:?}", found.contacts) };
        assert!((Vector::from(contact.manifold.normal) - Vector::z()).norm() < 1e-15, "{contact:?}");
        assert_eq!(contact.manifold.outcome == Outcome::Intersecting, depth >= 0.0);
        assert_eq!((found.points.len(), contact.first_point), (4, 0));
        for point in &found.points {
            assert!(
                point.gap_lower <= -depth && -depth <= point.gap_upper && point.gap_upper - point.gap_lower < 1e-10
            );
            assert!((point.world1[0] - middle).abs() > 0.49 && (point.world1[1] - middle).abs() > 0.49, "{point:?}");
        }
    }
}

/// Gaps are heights over the triangle that is named, in rational numbers; points of the body are in its box.
#[test]
fn gaps_are_heights_over_the_triangle() {
    let mut random = Random::new(0x9a9);
    let mut seen = 0;
    let cube = cuboid([0.5; 3]);
    for _ in 0..60 {
        let (vertices, triangles) = hills(&mut random, 6, 0.25);
        let ground = Ground::from_triangles(&vertices, &triangles).unwrap();
        let place = Vector::new(random.uniform(1.5, 3.5), random.uniform(1.5, 3.5), random.uniform(0.3, 0.6));
        let pose = Pose::new(&testkit::random::rotation(&random.direction(), random.uniform(0.0, 0.2)), &place);
        let found = contacts(&cube, &pose, &ground, 0.05, false);
        for contact in &found.contacts {
            let own = &found.points[contact.first_point..][..contact.manifold.point_count as usize];
            let least = own.iter().map(|point| point.gap_lower).fold(f64::INFINITY, f64::min);
            assert_eq!(least, contact.manifold.lower);
            for point in own {
                let rows: [f64; 12] = std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
                let world = transform(&rows, &point.local1.map(rational));
                let along = (0..3)
                    .map(|k| (world[k].clone() - rational(point.world2[k])) * rational(contact.manifold.normal[k]));
                let gap = along.fold(rational(0.0), |sum, part| sum + part);
                // The normal is of length 1 up to rounding, the points are rounded.
                let rounding = rational(1e-13);
                assert!(rational(point.gap_lower) - &rounding <= gap && gap <= rational(point.gap_upper) + &rounding);
                assert!(point.local1.iter().all(|x| x.abs() <= 0.5 + 1e-12), "{point:?}");
                seen += 1;
            }
        }
    }
    assert!(seen > 200, "{seen}");
}

/// The back of a triangle pushes nobody; a body that is more than half through is pushed to the front.
#[test]
fn the_ground_pushes_out_of_its_front() {
    let ground = level(3, 3, 10.0);
    let cube = cuboid([0.5; 3]);
    let below = contacts(&cube, &at(11.0, 12.0, -0.4), &ground, 0.2, true);
    assert!(below.contacts.is_empty() && below.points.is_empty());
    // A wedge whose centre of mass is above, and whose greater part of the height is below.
    let wedge = hull(&[
        Vector::new(-1.0, -1.0, 0.1),
        Vector::new(1.0, -1.0, 0.1),
        Vector::new(1.0, 1.0, 0.1),
        Vector::new(-1.0, 1.0, 0.1),
        Vector::new(0.0, 0.0, -0.25),
    ]);
    let through = contacts(&wedge, &at(11.0, 12.0, 0.0), &ground, 0.0, true);
    let [contact] = through.contacts[..] else { panic!("{:?}", through.contacts) };
    assert!((Vector::from(contact.manifold.normal) - Vector::z()).norm() < 1e-15, "{contact:?}");
    assert!(contact.manifold.lower <= -0.25 && -0.25 <= contact.manifold.upper, "{contact:?}");
}

/// On a ridge a body stands along the normal between the two slopes; in a valley along theirs.
#[test]
fn ridges_have_normals_of_their_own_and_valleys_have_not() {
    let of = |height: f64| {
        let heights = [0.0, height, 0.0, 0.0, height, 0.0];
        let grid = swiftprox::ground::HeightGrid { rows: 2, columns: 3, spacing: [4.0, 8.0], heights: &heights };
        Ground::from_heights(&grid).unwrap()
    };
    let cube = cuboid([0.5; 3]);
    let on_ridge = contacts(&cube, &at(4.0, 4.0, 1.49), &of(1.0), 0.0, true);
    let [contact] = on_ridge.contacts[..] else { panic!("{:?}", on_ridge.contacts) };
    assert!((Vector::from(contact.manifold.normal) - Vector::z()).norm() < 1e-12);
    assert!(contact.manifold.lower <= -0.01 + 1e-12 && contact.manifold.upper >= -0.01 - 1e-12);
    let slope = Vector::new(1.0, 0.0, 4.0).normalize();
    let in_valley = contacts(&cube, &at(4.0, 4.0, -0.4), &of(-1.0), 0.0, true);
    assert_eq!(in_valley.contacts.len(), 2);
    for contact in &in_valley.contacts {
        let normal = Vector::from(contact.manifold.normal);
        assert!((Vector::new(normal.x.abs(), normal.y, normal.z) - slope).norm() < 1e-12, "{contact:?}");
    }
}
