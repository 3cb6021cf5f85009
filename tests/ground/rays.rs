//! Rays at grounds, against all triangles in whole numbers.

use super::level;
use swiftprox::error::Error;
use swiftprox::ground::Ground;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::ray::{Ray, RayOutcome};
use testkit::random::Random;

type Whole = [i128; 3];

fn minus(a: Whole, b: Whole) -> Whole {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn cross(a: Whole, b: Whole) -> Whole {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Whole, b: Whole) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn real(a: Whole) -> [f64; 3] {
    a.map(|x| x as f64)
}

/// Where a line meets a triangle, as a quotient with a divisor above 0. `Err` of one in its plane.
fn meets(origin: Whole, along: Whole, [a, b, c]: [Whole; 3]) -> Result<Option<[i128; 2]>, ()> {
    let normal = cross(minus(b, a), minus(c, a));
    let divisor = dot(normal, along);
    let way = dot(normal, minus(a, origin));
    if divisor == 0 {
        return if way == 0 { Err(()) } else { Ok(None) };
    }
    let sides = [[a, b], [b, c], [c, a]].map(|[from, to]| dot(along, cross(minus(from, origin), minus(to, origin))));
    let is_inside = sides.iter().all(|side| *side >= 0) || sides.iter().all(|side| *side <= 0);
    Ok(is_inside.then_some(if divisor > 0 { [way, divisor] } else { [-way, -divisor] }))
}

/// Soups whose corners, rays and poses are whole numbers: the verdict is right, the interval holds the first place, and the
/// triangle named is hit there.
#[test]
fn rays_meet_the_first_of_all_triangles() {
    let mut random = Random::new(0x6e5);
    let turns = [
        Matrix::identity(),
        Matrix::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0),
        Matrix::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0),
    ];
    let (mut hits, mut misses) = (0, 0);
    for round in 0..3_000 {
        // Small ranges, so that rays pass through corners, along edges and in planes.
        let range = [2, 20, 1_000][round % 3];
        let mut whole =
            |range: i128| -> Whole { std::array::from_fn(|_| random.below(2 * range as usize + 1) as i128 - range) };
        let corners: Vec<Whole> = (0..16).map(|_| whole(range)).collect();
        let (origin, target, shift) = (whole(2 * range), whole(range), whole(100));
        let along = minus(target, origin);
        let triangles: Vec<[u32; 3]> = (0..20).map(|_| std::array::from_fn(|_| random.below(16) as u32)).collect();
        let vertices: Vec<Vector> = corners.iter().map(|corner| real(*corner).into()).collect();
        let (Ok(ground), false) = (Ground::from_triangles(&vertices, &triangles), along == [0; 3]) else { continue };
        let pose = Pose::new(&turns[round / 3 % 3], &real(shift).into());
        let world: Vec<Whole> =
            vertices.iter().map(|v| <[f64; 3]>::from(pose.transform(v)).map(|x| x as i128)).collect();
        let mut first: Option<[i128; 2]> = None;
        let mut is_in_plane = false;
        let mut places = Vec::new();
        for triangle in &triangles {
            let at = triangle.map(|v| world[v as usize]);
            let has_area = cross(minus(at[1], at[0]), minus(at[2], at[0])) != [0; 3];
            let place = if has_area { meets(origin, along, at) } else { Ok(None) };
            is_in_plane |= place.is_err();
            let place = place.unwrap_or(None).filter(|[way, _]| *way >= 0);
            places.push(place);
            if let Some([way, by]) = place
                && first.is_none_or(|[w, b]| way * b < w * by)
            {
                first = Some([way, by]);
            }
        }
        if is_in_plane {
            continue;
        }
        let ray = Ray { origin: real(origin), direction: real(along), t_max: f64::INFINITY };
        let found = ground.at(&pose).cast_ray(&ray).unwrap();
        let Some([way, by]) = first else {
            assert_eq!(found.answer.outcome, RayOutcome::Miss, "{ray:?}");
            assert_eq!(found.triangle, 20);
            misses += 1;
            continue;
        };
        hits += 1;
        assert_eq!(found.answer.outcome, RayOutcome::Hit, "{ray:?}");
        // Quotients of numbers below 2⁵³ are right to half a unit.
        let place = way as f64 / by as f64;
        let [lower, upper] = found.answer.entry;
        assert!(lower <= place.next_up() && place.next_down() <= upper, "{place} in {lower} to {upper}");
        assert!(upper - lower <= 1e-9 * (1.0 + place), "{lower} to {upper}");
        let own = places[found.triangle as usize].map(|[way, by]| way as f64 / by as f64);
        assert!(own.is_some_and(|own| lower <= own.next_up() && own.next_down() <= upper), "{own:?}");
        assert_eq!((found.answer.feature.kind, found.answer.feature.ids[0]), (FeatureKind::Face, found.triangle));
        // A ray that ends before it misses, one that ends behind it hits.
        let ends = |t_max: f64| ground.at(&pose).cast_ray(&Ray { t_max, ..ray }).unwrap().answer.outcome;
        assert_eq!(ends(upper.next_up()), RayOutcome::Hit);
        if lower > 0.0 {
            assert_eq!(ends(lower.next_down()), RayOutcome::Miss);
        }
    }
    assert!(hits > 400 && misses > 400, "{hits} {misses}");
}

/// From far away, steeply and along the surface.
#[test]
fn level_ground_is_hit_where_its_plane_is() {
    let ground = level(101, 101, 1.0);
    let at = |origin: [f64; 3], direction: [f64; 3]| {
        ground.at(&Pose::IDENTITY).cast_ray(&Ray { origin, direction, t_max: f64::INFINITY }).unwrap()
    };
    for height in [1.0, 1e3, 1e6] {
        let found = at([50.25, 50.75, height], [0.0, 0.0, -2.0]);
        assert!(found.answer.entry[0] <= 0.5 * height && 0.5 * height <= found.answer.entry[1], "{found:?}");
        assert!((found.answer.normal[2] - 1.0).abs() < 1e-15);
        // From below, the normal is against the ray, too.
        let below = at([50.25, 50.75, -height], [0.0, 0.0, 2.0]);
        assert!((below.answer.normal[2] + 1.0).abs() < 1e-15 && below.triangle == found.triangle);
    }
    assert_eq!(at([50.0, 50.0, 1.0], [1.0, 0.0, 0.0]).answer.outcome, RayOutcome::Miss);
    assert_eq!(at([150.0, 50.0, 1.0], [0.0, 0.0, -1.0]).answer.outcome, RayOutcome::Miss);
}

#[test]
fn rays_out_of_range_are_refused() {
    let ground = level(2, 2, 1.0);
    let ray = Ray { origin: [0.5, 0.25, 1.0], direction: [0.0, 0.0, -1.0], t_max: 2.0 };
    let placed = ground.at(&Pose::IDENTITY);
    assert!(matches!(placed.cast_ray(&Ray { direction: [0.0; 3], ..ray }), Err(Error::Argument(_))));
    assert!(matches!(placed.cast_ray(&Ray { t_max: -1.0, ..ray }), Err(Error::Argument(_))));
    let skewed = Pose::new(&(2.0 * Matrix::identity()), &Vector::zeros());
    assert!(matches!(ground.at(&skewed).cast_ray(&ray), Err(Error::Pose(_))));
    // Lengths whose squares are no doubles rule no box out.
    for scale in [1e-300, 1e-200, 1e200, 1e300] {
        let found = placed.cast_ray(&Ray { direction: [0.0, 0.0, -scale], t_max: f64::INFINITY, ..ray }).unwrap();
        let place = 1.0 / scale;
        let [lower, upper] = found.answer.entry;
        assert!(lower <= place.next_up() && place.next_down() <= upper, "{scale:e}: {found:?}");
    }
}
