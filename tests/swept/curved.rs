//! Cylinders, cones and ellipsoids: their polyhedra and deviations against support functions in closed form, intervals against
//! distances in closed form, and all answers against the independent checks.

use crate::{sphere, swept};
use std::sync::Arc;
use swiftprox::error::Error;
use swiftprox::manifold::{ManifoldCache, ManifoldConfig, ManifoldPoint, half_space_manifold, manifold};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, Moving, cast, verify_cast};
use swiftprox::object::ObjectOptions;
use swiftprox::pair::{
    DepthAnswer, DepthCache, DepthConfig, HalfSpace, Outcome, PairAnswer, PairCache, PairConfig, Placed,
    SignedDistance, SignedDistanceCache, approximate, contact, depth, distance, half_space_distance, intersection,
    signed_distance,
};
use swiftprox::point::{PointLocation, locate_point, support};
use swiftprox::progress::Progress;
use swiftprox::ray::{Ray, RayOutcome, cast_ray};
use swiftprox::scene::{ContactDetail, RayHits, Scene, SceneQuery, SetScratch};
use swiftprox::shape::Shape;
use swiftprox::shape_file::{from_bytes, to_bytes};
use swiftprox::verify::{verify, verify_depth, verify_manifold};
use testkit::random::Random;
use testkit::shapes::at;

/// What closed forms are off by, of lengths about 1.
const CLOSE: f64 = 1e-13;

#[derive(Clone, Copy, Debug)]
enum Body {
    Cylinder(f64, f64),
    Cone(f64, f64),
    Ellipsoid(Vector),
}

impl Body {
    fn any(random: &mut Random, round: usize) -> Body {
        let mut length = || random.uniform(0.2, 1.5);
        match round % 3 {
            0 => Body::Cylinder(length(), length()),
            1 => Body::Cone(length(), length()),
            _ => Body::Ellipsoid(Vector::new(length(), length(), length())),
        }
    }

    fn shape(&self, deviation: f64) -> Shape {
        match *self {
            Body::Cylinder(radius, half) => Shape::from_cylinder(radius, half, deviation),
            Body::Cone(radius, half) => Shape::from_cone(radius, half, deviation),
            Body::Ellipsoid(axes) => Shape::from_ellipsoid(&axes, deviation),
        }
        .unwrap()
    }

    /// The support function.
    fn height(&self, n: &Vector) -> f64 {
        match *self {
            Body::Cylinder(radius, half) => radius * n.x.hypot(n.y) + half * n.z.abs(),
            Body::Cone(radius, half) => (half * n.z).max(radius * n.x.hypot(n.y) - half * n.z),
            Body::Ellipsoid(axes) => axes.component_mul(n).norm(),
        }
    }

    /// The signed distance of a point of its own frame; of an ellipsoid only outside.
    fn signed_distance(&self, p: &Vector) -> f64 {
        match *self {
            Body::Cylinder(radius, half) => {
                let [across, along] = [p.x.hypot(p.y) - radius, p.z.abs() - half];
                across.max(along).min(0.0) + across.max(0.0).hypot(along.max(0.0))
            }
            Body::Cone(radius, half) => {
                let (rho, z) = (p.x.hypot(p.y), p.z);
                let slant = radius.hypot(2.0 * half);
                // Over the slant, and over the base.
                let over = ((rho - radius) * 2.0 * half + (z + half) * radius) / slant;
                let under = -half - z;
                if over <= 0.0 && under <= 0.0 {
                    return over.max(under);
                }
                let to_segment = |[ax, az]: [f64; 2], [bx, bz]: [f64; 2]| {
                    let (dx, dz) = (bx - ax, bz - az);
                    let t = (((rho - ax) * dx + (z - az) * dz) / (dx * dx + dz * dz)).clamp(0.0, 1.0);
                    (rho - ax - t * dx).hypot(z - az - t * dz)
                };
                to_segment([0.0, half], [radius, -half]).min(to_segment([0.0, -half], [radius, -half]))
            }
            Body::Ellipsoid(axes) => {
                let inside = |t: f64| p.zip_map(&axes, |p, a| a * p / (a * a + t)).norm_squared() < 1.0;
                assert!(!inside(0.0));
                // The nearest point is p·a²/(a² + t), and t grows until it is on the surface.
                let (mut low, mut high) = (0.0, 1e6);
                for _ in 0..200 {
                    let t = 0.5 * (low + high);
                    if inside(t) { high = t } else { low = t }
                }
                p.zip_map(&axes, |p, a| p - p * a * a / (a * a + high)).norm()
            }
        }
    }
}

/// No point of the polyhedron is out of the body, and no point of the body farther from it than the deviation: all at once by the
/// support functions, which tell it of convex sets.
#[test]
fn the_polyhedron_is_inside_and_as_near_as_said() {
    let mut random = Random::new(0xc0e0);
    for round in 0..60 {
        let body = Body::any(&mut random, round);
        let deviation = random.pick(&[0.0, 0.05, 4e-3, 2e-3]);
        let shape = body.shape(deviation);
        if deviation > 0.0 {
            assert!(shape.deviation() <= deviation, "{body:?}");
        }
        let polyhedron = shape.polyhedron();
        let vertices: Vec<Vector> =
            (0..polyhedron.vertices.len()).map(|v| polyhedron.local_position(v as u32)).collect();
        let mut most = 0.0_f64;
        for _ in 0..400 {
            let n = random.direction();
            let inner = vertices.iter().map(|v| v.dot(&n)).fold(f64::NEG_INFINITY, f64::max);
            let beyond = body.height(&n) - inner;
            assert!(beyond >= -CLOSE && beyond <= shape.deviation() / 1.01 + CLOSE, "{body:?} {beyond:e}");
            most = most.max(beyond);
        }
        assert!(most > 0.2 * shape.deviation() || vertices.len() < 40, "{body:?} {most:e} {}", shape.deviation());
        // Points are 3u inside, and what is computed of them is off by less.
        for v in &vertices {
            let (is_in, slack) = match body {
                Body::Cylinder(radius, half) => (v.z.abs() <= half, 1.0 - v.x.hypot(v.y) / radius),
                Body::Cone(radius, half) => {
                    (v.z.abs() <= half, if v.z > 0.0 { 0.0 } else { 1.0 - v.x.hypot(v.y) / radius })
                }
                Body::Ellipsoid(axes) => (true, 1.0 - v.component_div(&axes).norm()),
            };
            assert!(is_in && slack >= 0.0, "{body:?} {v:?}");
        }
    }
}

/// Balls and points beside each body, and half-spaces, at rigid poses: the interval holds the closed form, and is no wider than the
/// deviation.
#[test]
fn intervals_hold_closed_forms() {
    let mut random = Random::new(0xc0e1);
    let mut seen = [0; 5];
    for round in 0..1_200 {
        let body = Body::any(&mut random, round);
        let shape = body.shape(random.pick(&[0.05, 4e-3]));
        let pose = Pose::new(&random.rotation(), &(random.vector() * 2.0));
        let out = random.direction();
        // On the surface's side of a support plane, near or far.
        let p = out * body.height(&out) + out * random.pick(&[0.003, 0.03, 0.4, 3.0]);
        let radius = random.pick(&[0.0, 0.02, 0.3]);
        let (ball, there) = (sphere(radius), Pose::new(&random.rotation(), &pose.transform(&p)));
        let truth = body.signed_distance(&p) - radius;
        let bodies = [shape.at(&pose), ball.at(&there)];
        let mut signed = SignedDistance::default();
        signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed).unwrap();
        let told = || format!("{body:?} {p:?} {radius} {truth:e} {signed:?}");
        assert!(signed.lower <= truth + CLOSE && truth - CLOSE <= signed.upper, "{}", told());
        assert!(signed.upper - signed.lower <= shape.deviation() * (1.0 + 1e-9) + CLOSE, "{}", told());
        let expected = match (signed.lower > 0.0, signed.upper <= 0.0) {
            (true, _) => Outcome::Separated,
            (_, true) => Outcome::Intersecting,
            _ => Outcome::Undecided,
        };
        assert_eq!(signed.outcome, expected, "{}", told());
        seen[expected as usize] += 1;
        for query in [distance as Query, contact, approximate, intersection] {
            let answer = ask(query, bodies);
            assert_eq!(answer.outcome, expected, "{answer:?} {}", told());
            assert!(answer.lower <= truth.max(0.0) + CLOSE && truth - CLOSE <= answer.upper, "{answer:?} {}", told());
            verify(bodies, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?} {}", told()));
        }
        let normal = random.vector();
        let height =
            -body.height(&-pose.rotate_back(&normal)) / normal.norm() + pose.translation().dot(&normal) / normal.norm();
        let offset = (height - random.pick(&[-0.3, 1e-5, 1e-3, 0.2])) * normal.norm();
        let half_space = HalfSpace { normal: normal.into(), offset };
        let truth = height - offset / normal.norm();
        let answer = half_space_distance(shape.at(&pose), &half_space).unwrap();
        assert!(answer.lower <= truth + CLOSE && truth - CLOSE <= answer.upper, "{truth:e} {answer:?}");
        let is_hidden = answer.lower <= 0.0 && answer.upper > 0.0;
        assert_eq!(answer.outcome == Outcome::Undecided, is_hidden, "{answer:?}");
        let (mut points, config) =
            ([ManifoldPoint::default(); 64], ManifoldConfig { max_distance: 1.0, reduces: true });
        let found = half_space_manifold(shape.at(&pose), &half_space, &config, &mut points).unwrap();
        assert_eq!((found.outcome, found.lower, found.upper), (answer.outcome, answer.lower, answer.upper));
        let located = locate_point(shape.at(&pose), pose.transform(&p).into()).unwrap();
        let truth = body.signed_distance(&p);
        assert!(located.lower <= truth + CLOSE && truth - CLOSE <= located.upper, "{located:?}");
        assert_eq!(located.location == PointLocation::Undecided, located.lower <= 0.0 && located.upper > 0.0);
        let reached = support(shape.at(&pose), normal.into()).unwrap();
        let highest = body.height(&pose.rotate_back(&normal)) + pose.translation().dot(&normal);
        assert!(reached.height[0] <= highest && highest <= reached.height[1], "{highest:e} {reached:?}");
    }
    assert!([1, 3, 4].iter().all(|&outcome| seen[outcome] > 15), "{seen:?}");
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> Result<(), Error>;

fn ask(query: Query, bodies: [Placed; 2]) -> PairAnswer {
    let mut answer = PairAnswer::default();
    query(bodies, &mut PairCache::default(), &PairConfig::default(), &mut answer).unwrap();
    answer
}

/// Two curved bodies, or one and a hull, a ball or a rounded hull, at poses that stretch by up to 1e-2, apart, deep, or nearly
/// touching: along no direction are the bodies themselves farther apart than the upper end, points in them are no nearer than the
/// lower one, all passes the checks, and an interval that leaves out a part of the deviation does not.
#[test]
fn answers_hold_for_bodies_and_pass_their_checks() {
    let mut random = Random::new(0xc0e2);
    let (mut seen, mut refused) = ([0; 5], 0);
    let cloud: Vec<Vector> = (0..12).map(|_| random.vector()).collect();
    for round in 0..240 {
        let (body, other) = (Body::any(&mut random, round), Body::any(&mut random, round / 3));
        let deviation = random.pick(&[0.05, 4e-3]);
        let first = body.shape(deviation);
        let is_curved = round % 2 == 0;
        let second = match round % 4 {
            0 | 2 => other.shape(random.pick(&[0.05, 4e-3])),
            1 => swept(&cloud, 0.0),
            _ => swept(&cloud, 0.1),
        };
        let skew = random.pick(&[0.0, 1e-6, 4e-3]);
        let mut turn = || random.rotation() * Matrix::from_diagonal(&Vector::new(1.0 + skew, 1.0, 1.0 - skew));
        let turns = [turn(), turn()];
        let mut poses = [Pose::new(&turns[0], &Vector::zeros()), Pose::new(&turns[1], &(random.direction() * 6.0))];
        let near = ask(distance, [first.at(&poses[0]), second.at(&poses[1])]);
        // Towards each other until so much is left.
        let left = random.pick(&[-0.3, -1e-3, 0.0, 1e-9, 0.3 * deviation, 0.9 * deviation, 1.5 * deviation, 0.5]);
        let shift = Vector::from(near.normal) * (near.upper - left);
        poses[1] = Pose::new(&turns[1], &(poses[1].translation() + shift));
        let bodies = [first.at(&poses[0]), second.at(&poses[1])];
        let told = || format!("{round}: {body:?} {other:?} {poses:?}");
        let mut signed = SignedDistance::default();
        signed_distance(bodies, &mut SignedDistanceCache::default(), &PairConfig::default(), &mut signed).unwrap();
        seen[signed.outcome as usize] += 1;
        let height = |i: usize, n: &Vector| {
            let local = poses[i].rotate_back(n);
            let of_hull =
                || cloud.iter().map(|v| v.dot(&local)).fold(f64::NEG_INFINITY, f64::max) + second.swept_radius();
            let own = if i == 0 {
                body.height(&local)
            } else if is_curved {
                other.height(&local)
            } else {
                of_hull()
            };
            own + poses[i].translation().dot(n)
        };
        // The signed distance is the largest of the gaps along all directions.
        let gap = |n: &Vector| -height(0, &-n) - height(1, n);
        for _ in 0..20 {
            let n =
                (Vector::from(signed.normal) + random.direction() * random.pick(&[0.0, 1e-3, 1e-2, 0.1])).normalize();
            assert!(gap(&n) <= signed.upper + CLOSE, "{} {signed:?}", told());
        }
        // Uphill from the normal: the best direction that is found leaves no more than it says.
        let mut best = Vector::from(signed.normal);
        for step in 0..60 {
            let n = (best + random.direction() * 0.1 * 0.9_f64.powi(step)).normalize();
            if gap(&n) > gap(&best) {
                best = n;
            }
        }
        assert!(gap(&best) >= signed.lower - 1e-3, "{} {signed:?}", told());
        for query in [distance as Query, contact, approximate, intersection] {
            let answer = ask(query, bodies);
            verify(bodies, &answer).unwrap_or_else(|error| panic!("{error}: {answer:?} {}", told()));
            assert_eq!(answer.outcome, signed.outcome, "{answer:?} {}", told());
            let width = answer.upper - answer.lower;
            if answer.outcome == Outcome::Separated && answer.local1[0].is_finite() && width > 1e-4 {
                let part = answer.lower + 0.01 * width;
                for forged in [
                    PairAnswer { lower: part, distance: answer.upper, ..answer },
                    PairAnswer { upper: answer.upper - 0.01 * width, distance: answer.lower, ..answer },
                ] {
                    assert!(matches!(verify(bodies, &forged), Err(Error::Unverified(_))), "{forged:?} {}", told());
                    refused += 1;
                }
            }
            if answer.outcome == Outcome::Undecided {
                let forged = PairAnswer { upper: 0.5 * answer.upper, distance: 0.0, ..answer };
                assert!(matches!(verify(bodies, &forged), Err(Error::Unverified(_))), "{forged:?} {}", told());
                refused += 1;
            }
        }
        let (mut deep, mut cache) = (DepthAnswer::default(), DepthCache::default());
        depth(bodies, &mut cache, &DepthConfig::default(), &mut deep).unwrap();
        verify_depth(bodies, &cache, &deep).unwrap_or_else(|error| panic!("{error}: {deep:?} {}", told()));
        for max_distance in [0.0, 0.6] {
            let (config, mut cache) =
                (ManifoldConfig { max_distance, ..ManifoldConfig::default() }, ManifoldCache::default());
            let mut points = vec![ManifoldPoint::default(); 600];
            let found = manifold(bodies, &mut cache, &config, &mut points).unwrap();
            points.truncate(found.point_count as usize);
            verify_manifold(bodies, &cache, &config, &found, &points)
                .unwrap_or_else(|error| panic!("{error}: {found:?} {points:?} {}", told()));
        }
    }
    assert!([1, 3, 4].iter().all(|&outcome| seen[outcome] > 20) && refused > 100, "{seen:?} {refused}");
}

/// Where a ray enters an ellipsoid or a drum and leaves it, if it meets it, by the quadratic equation; and through a scene of them,
/// in order, hits and what may be hit.
#[test]
fn rays_hold_for_bodies() {
    let mut random = Random::new(0xc0e4);
    let mut seen = [0; 5];
    for round in 0..900 {
        let body = [Body::Cylinder(1.0, 0.5), Body::Ellipsoid(Vector::new(1.0, 0.6, 0.4))][round % 2];
        let shape = body.shape(random.pick(&[0.05, 4e-3]));
        let pose = Pose::new(&random.rotation(), &random.vector());
        // Through a point near the surface, in any direction; from afar, or from there.
        let out = random.direction();
        let place = match body {
            Body::Ellipsoid(axes) => axes.component_mul(&out),
            _ => Vector::new(out.x, out.y, 0.5 * out.z) / out.x.hypot(out.y).max(out.z.abs()),
        };
        let through = place * random.pick(&[0.3, 0.99, 1.0 - 1e-4, 1.0 + 1e-4, 1.001, 1.1]);
        let direction = random.direction();
        let origin = through - direction * random.pick(&[0.0, 3.0]);
        let (a, b) = line_within(&body, &origin, &direction);
        let world = |v: &Vector| pose.rotation() * v;
        let ray = Ray {
            origin: pose.transform(&origin).into(),
            direction: world(&direction).into(),
            t_max: random.pick(&[f64::INFINITY, 10.0]),
        };
        let answer = cast_ray(shape.at(&pose), &ray).unwrap();
        seen[answer.outcome as usize] += 1;
        let told = || format!("{body:?} {origin:?} {direction:?} {a:e} {b:e} {answer:?}");
        let meets = a <= b && b >= 0.0;
        match answer.outcome {
            RayOutcome::Miss => assert!(!meets || b - a < 1e-6 || b < CLOSE, "{}", told()),
            RayOutcome::Hit => assert!(meets && a >= -CLOSE, "{}", told()),
            RayOutcome::Inside => assert!(meets && a <= CLOSE, "{}", told()),
            _ => {}
        }
        if meets && answer.outcome != RayOutcome::Miss && b - a > 1e-6 {
            let entry = a.max(0.0);
            assert!(answer.entry[0] <= entry + 1e-9 && entry - 1e-9 <= answer.entry[1], "{}", told());
            assert!(answer.exit[0] <= b + 1e-9 && b - 1e-9 <= answer.exit[1], "{}", told());
        }
    }
    assert!([1, 2, 3, 4].iter().all(|&outcome| seen[outcome] > 40), "{seen:?}");
    let drum = Arc::new(Shape::from_cylinder(1.0, 0.5, 0.05).unwrap());
    let mut scene = Scene::new();
    for (k, x) in [9.0, 6.0, 3.0].into_iter().enumerate() {
        // The second is passed within its deviation.
        let y = if k == 1 { 1.0 + 1e-3 } else { 0.0 };
        let options = ObjectOptions { pose: at(x, y, 0.0), user_data: k as u64, ..Default::default() };
        scene.add_object(vec![drum.clone()], &options).unwrap();
    }
    let ray = Ray { origin: [0.0; 3], direction: [1.0, 0.0, 0.0], t_max: f64::INFINITY };
    let mut scratch = SetScratch::default();
    let mut hits = |from: f64, wanted: RayHits| {
        let ray = Ray { origin: [from, 0.0, 0.0], ..ray };
        let hits = scene.cast_ray(&ray, wanted, u32::MAX, &mut scratch).unwrap();
        hits.iter().map(|hit| (hit.user_data, hit.answer.outcome == RayOutcome::Undecided)).collect::<Vec<_>>()
    };
    assert_eq!(hits(0.0, RayHits::All), [(2, false), (1, true), (0, false)]);
    assert_eq!(hits(0.0, RayHits::First), [(2, false)]);
    assert_eq!(hits(4.5, RayHits::First), [(1, true)]);
    assert_eq!(hits(4.5, RayHits::Any), [(0, false)]);
}

/// The part of a line in a cylinder or an ellipsoid; empty where it ends before it begins.
fn line_within(body: &Body, origin: &Vector, direction: &Vector) -> (f64, f64) {
    let roots = |o: Vector, d: Vector| {
        let (a, b, c) = (d.norm_squared(), o.dot(&d), o.norm_squared() - 1.0);
        let root = (b * b - a * c).sqrt();
        if root.is_nan() { (f64::INFINITY, f64::NEG_INFINITY) } else { ((-b - root) / a, (-b + root) / a) }
    };
    match *body {
        Body::Ellipsoid(axes) => roots(origin.component_div(&axes), direction.component_div(&axes)),
        Body::Cylinder(radius, half) => {
            let flat = |v: &Vector| Vector::new(v.x, v.y, 0.0) / radius;
            let (a, b) = roots(flat(origin), flat(direction));
            let ends = [-half, half].map(|z| (z - origin.z) / direction.z);
            (a.max(ends[0].min(ends[1])), b.min(ends[0].max(ends[1])))
        }
        Body::Cone(..) => unreachable!(),
    }
}

/// A cylinder on its way along x to a wall: free where it does not reach it, a hit where it goes in, and near where it stops within
/// the deviation of it. The truth is by hand.
#[test]
fn casts_hold_for_bodies() {
    let (drum, wall) = (Shape::from_cylinder(1.0, 1.0, 0.01).unwrap(), testkit::shapes::cuboid([1.0, 4.0, 4.0]));
    let still = Motion::Fixed(at(4.0, 0.0, 0.0));
    let turn = testkit::random::rotation(&Vector::z(), 0.3);
    // Where it ends, half a side's angle from a corner of the polygon or not.
    for (end, outcome) in [(1.9, CastOutcome::Free), (2.5, CastOutcome::Hit), (1.9999, CastOutcome::Near)] {
        let to = Pose::new(&turn, &Vector::new(end, 0.0, 0.0));
        let motion = Motion::Affine { start: Pose::new(&turn, &Vector::zeros()), end: to };
        let bodies = [Moving { shape: &drum, motion: &motion }, Moving { shape: &wall, motion: &still }];
        let (config, mut answer) = (CastConfig::default(), CastAnswer::default());
        cast(bodies, &mut PairCache::default(), &config, &mut answer).unwrap();
        verify_cast(bodies, &config, &answer).unwrap();
        assert_eq!(answer.outcome, outcome, "{answer:?}");
        let reached = 2.0 / end;
        match outcome {
            CastOutcome::Free => assert!(answer.clearance <= 0.1 && answer.clearance > 0.085, "{answer:?}"),
            CastOutcome::Hit => {
                assert!(answer.time_lower <= reached && reached <= answer.time_upper + 1e-12, "{answer:?}");
                assert!(answer.time_upper - answer.time_lower < 0.01, "{answer:?}");
            }
            _ => assert!(answer.time_lower < reached && answer.time_lower > reached - 0.01, "{answer:?}"),
        }
    }
}

/// A scene lists what all pairs are, undecided ones of verdicts, too; those that may meet are hits.
#[test]
fn a_scene_finds_what_all_pairs_are() {
    let mut random = Random::new(0xc0e3);
    let shapes = [
        Shape::from_cylinder(0.3, 0.2, 0.02).unwrap(),
        Shape::from_cone(0.3, 0.3, 0.02).unwrap(),
        Shape::from_ellipsoid(&Vector::new(0.4, 0.2, 0.1), 0.02).unwrap(),
        sphere(0.2),
    ]
    .map(Arc::new);
    let mut scene = Scene::new();
    let mut ids = Vec::new();
    for k in 0..90 {
        let pose = Pose::new(&random.rotation(), &(random.vector() * 1.5));
        ids.push(scene.add_object(vec![shapes[k % 4].clone()], &ObjectOptions { pose, ..Default::default() }).unwrap());
    }
    let mut seen = [0; 5];
    for round in 0..12 {
        for id in &ids {
            let pose = *scene.object(*id).unwrap().pose();
            let shift = random.vector() * if round % 4 == 3 { 0.3 } else { 0.01 };
            scene.set_pose(*id, &Pose::new(&pose.rotation(), &(pose.translation() + shift))).unwrap();
        }
        let poses: Vec<Pose> = ids.iter().map(|id| *scene.object(*id).unwrap().pose()).collect();
        let tolerance = 0.05;
        let mut expected = Vec::new();
        for a in 0..ids.len() {
            for b in a + 1..ids.len() {
                let (mut answer, config) =
                    (PairAnswer::default(), PairConfig { max_distance: tolerance, ..PairConfig::default() });
                let bodies = [shapes[a % 4].at(&poses[a]), shapes[b % 4].at(&poses[b])];
                distance(bodies, &mut PairCache::default(), &config, &mut answer).unwrap();
                if answer.outcome != Outcome::Beyond {
                    expected.push((ids[a], ids[b], answer.outcome, answer.distance));
                }
            }
        }
        let query = SceneQuery { max_distance: tolerance, ..SceneQuery::default() };
        let answer = scene.query_distance(&query).unwrap();
        assert_eq!(answer.pairs.len(), expected.len());
        for (pair, (a, b, outcome, length)) in answer.pairs.iter().zip(&expected) {
            assert_eq!((pair.object1, pair.object2, pair.answer.outcome), (*a, *b, *outcome));
            assert!((pair.answer.distance - length).abs() < 1e-12);
            seen[*outcome as usize] += 1;
        }
        let may_meet: Vec<_> =
            expected.iter().filter(|pair| matches!(pair.2, Outcome::Intersecting | Outcome::Undecided)).collect();
        let is_certain = expected.iter().any(|pair| pair.2 == Outcome::Intersecting);
        let answer = scene.query_intersection(&SceneQuery::default()).unwrap();
        assert_eq!(answer.intersecting, is_certain);
        assert_eq!(answer.pairs.len(), may_meet.len());
        for (pair, (a, b, outcome, _)) in answer.pairs.iter().zip(&may_meet) {
            assert_eq!((pair.object1, pair.object2, pair.answer.outcome), (*a, *b, *outcome));
        }
        let contacts = SceneQuery { detail: ContactDetail::Manifold, ..query };
        let answer = scene.query_contact(&contacts).unwrap();
        for (pair, contact) in answer.pairs.iter().zip(answer.contacts.contacts) {
            assert_eq!(pair.answer.outcome, contact.manifold.outcome);
            assert!(contact.manifold.point_count > 0);
        }
    }
    assert!([1, 3, 4].iter().all(|&outcome| seen[outcome] > 50), "{seen:?}");
}

/// A deviation comes back from a file and is scaled with a shape; what takes a polyhedron for the body refuses it and says what
/// helps; the least deviation that a message names is accepted.
#[test]
fn deviations_are_kept_or_refused() {
    let cone = Shape::from_cone(2.0, 1.0, 0.01).unwrap();
    assert!(cone.deviation() > 0.005 && cone.deviation() <= 0.01);
    let counts = [Shape::from_cylinder(1.0, 1.0, 0.0), Shape::from_ellipsoid(&Vector::repeat(1.0), 0.0)]
        .map(|made| made.map(|shape| (shape.polyhedron().vertices.len(), shape.deviation())).unwrap());
    assert_eq!(counts.map(|(count, _)| count), [448, 3_242], "docs/shapes.md says so: {counts:?}");
    assert!(counts[0].1 <= 1e-4 && counts[1].1 <= 1e-3, "{counts:?}");
    assert_eq!(from_bytes(&to_bytes(&cone).unwrap()).unwrap(), cone);
    let twice = cone.scaled(2.0, &mut Progress::new(&mut |_| true)).unwrap();
    assert_eq!(twice.deviation(), 2.0 * cone.deviation());
    assert_ne!(
        cone,
        swept(
            &(0..cone.polyhedron().vertices.len())
                .map(|v| cone.polyhedron().local_position(v as u32))
                .collect::<Vec<_>>(),
            0.0
        )
    );
    let cures = |error: Error| {
        assert!(
            matches!(error, Error::Argument(_)) && error.message().contains("swiftprox_shape_create_from_points"),
            "{error}"
        );
    };
    let here = at(0.0, 0.0, 0.0);
    let bodies = [cone.at(&here), cone.at(&here)];
    cures(swiftprox::pair::gradient(bodies, &SignedDistance::default(), [None; 2]).unwrap_err());
    for parts in [0.0, 1e-9] {
        let told =
            |made: Result<Shape, Error>| made.map_or_else(|error| error.message().to_string(), |_| String::new());
        let messages = [
            told(Shape::from_cylinder(1.0, 1.0, parts)),
            told(Shape::from_cone(1.0, 1.0, parts)),
            told(Shape::from_ellipsoid(&Vector::new(1.0, 2.0, 3.0), parts)),
        ];
        for (k, message) in messages.iter().enumerate().filter(|_| parts > 0.0) {
            let least: f64 = message.split("at least ").nth(1).unwrap().split(',').next().unwrap().parse().unwrap();
            let made = match k {
                0 => Shape::from_cylinder(1.0, 1.0, least),
                1 => Shape::from_cone(1.0, 1.0, least),
                _ => Shape::from_ellipsoid(&Vector::new(1.0, 2.0, 3.0), least),
            };
            assert!(made.unwrap().polyhedron().vertices.len() <= 4_096, "{message}");
        }
        assert!(parts > 0.0 || messages.iter().all(String::is_empty), "{messages:?}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
        assert!(Shape::from_cylinder(bad, 1.0, 0.0).is_err() && Shape::from_cone(1.0, bad, 0.0).is_err());
        assert!(Shape::from_ellipsoid(&Vector::new(1.0, bad, 1.0), 0.0).is_err());
        assert!(bad == 0.0 || bad == 1e-300 || Shape::from_cylinder(1.0, 1.0, bad).is_err());
    }
    // As large and as small as lengths may be.
    for length in [1e-280, 1e300] {
        let body = Shape::from_ellipsoid(&Vector::new(length, length, 0.5 * length), 0.1 * length).unwrap();
        let there = at(3.0 * length, 0.0, 0.0);
        let answer = ask(distance, [body.at(&here), body.at(&there)]);
        assert!(answer.lower <= length && length <= answer.upper && answer.lower > 0.7 * length, "{answer:?}");
    }
}
