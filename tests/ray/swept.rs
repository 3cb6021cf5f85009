//! Rays at bodies with a swept radius: closed forms, and exact rationals on lattices and anywhere.

use std::cmp::Ordering;

use crate::larger::{Integers, dot, integer, minus};
use dashu_int::IBig;
use swiftprox::base::simd::environment::Environment;
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::FeatureKind;
use swiftprox::ray::{Ray, RayAnswer, RayOutcome, cast_ray};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::cases::row_major;
use testkit::models::{cuboid, ellipsoid, grid_on_cube, prism};
use testkit::oracle::{rational, transform};
use testkit::random::Random;
use testkit::rays::{Case, SweptCase, anywhere, on_lattice, swept};
use testkit::shapes::hull;

fn body(points: &[Vector], swept_radius: f64) -> Shape {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
    Shape::from_points(points, &options).unwrap()
}

fn ball(radius: f64) -> Shape {
    body(&[Vector::zeros()], radius)
}

/// Along z, between −2 and 2 without the ends.
fn capsule() -> Shape {
    body(&[Vector::new(0.0, 0.0, -2.0), Vector::new(0.0, 0.0, 2.0)], 0.5)
}

/// Half sides of 1, 2 and 3, without the ball of 1/2.
fn rounded_box() -> Shape {
    body(&cuboid([1.0, 2.0, 3.0]).unwrap().vertices, 0.5)
}

fn cast(shape: &Shape, pose: &Pose, origin: [f64; 3], direction: [f64; 3]) -> RayAnswer {
    cast_ray(shape.at(pose), &Ray { origin, direction, t_max: f64::INFINITY }).unwrap()
}

/// Whether an interval holds a number, up to its rounding, and is narrow.
fn is_about([low, high]: [f64; 2], truth: f64) -> bool {
    let slack = 1e-12 * (1.0 + truth.abs());
    low - slack <= truth && truth <= high + slack && high - low <= slack
}

struct Known {
    origin: [f64; 3],
    direction: [f64; 3],
    part: [f64; 2],
    normal: [f64; 3],
    kind: FeatureKind,
}

fn check(shape: &Shape, known: &[Known]) {
    for Known { origin, direction, part, normal, kind } in known {
        // Moved and turned a quarter, too.
        let quarter = Matrix::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        for pose in [Pose::IDENTITY, Pose::new(&quarter, &Vector::new(3.0, -1.0, 0.25))] {
            let turned = |v: &[f64; 3]| pose.rotate(&Vector::from(*v));
            let answer = cast(shape, &pose, pose.transform(&Vector::from(*origin)).into(), turned(direction).into());
            assert_eq!((answer.outcome, answer.feature.kind), (RayOutcome::Hit, *kind), "{origin:?} {answer:?}");
            assert_eq!(answer.exact, 0, "{origin:?} {answer:?}");
            assert!(is_about(answer.entry, part[0]) && is_about(answer.exit, part[1]), "{origin:?} {answer:?}");
            assert!((Vector::from(answer.normal) - turned(normal)).norm() < 1e-12, "{origin:?} {answer:?}");
        }
    }
}

/// Before, rays at all bodies with a radius were refused, as a polyhedron's planes and triangles tell nothing of these: every
/// radius but 0 shows it. So it was in the tests below.
#[test]
fn closed_forms_of_balls() {
    let (r3, r8) = (3_f64.sqrt(), 8_f64.sqrt());
    check(
        &ball(1.0),
        &[
            Known {
                origin: [-3.0, 0.0, 0.0],
                direction: [2.0, 0.0, 0.0],
                part: [1.0, 2.0],
                normal: [-1.0, 0.0, 0.0],
                kind: FeatureKind::Vertex,
            },
            Known {
                origin: [-3.0, 0.5, 0.0],
                direction: [1.0, 0.0, 0.0],
                part: [3.0 - 0.5 * r3, 3.0 + 0.5 * r3],
                normal: [-0.5 * r3, 0.5, 0.0],
                kind: FeatureKind::Vertex,
            },
            Known {
                origin: [0.0, 1.0 / 3.0, 5.0],
                direction: [0.0, 0.0, -0.125],
                part: [40.0 - 8.0 * r8 / 3.0, 40.0 + 8.0 * r8 / 3.0],
                normal: [0.0, 1.0 / 3.0, r8 / 3.0],
                kind: FeatureKind::Vertex,
            },
        ],
    );
}

#[test]
fn closed_forms_of_capsules() {
    let s = 0.5_f64.sqrt();
    check(
        &capsule(),
        &[
            // Across, through an end along it, and through the side at a slope.
            Known {
                origin: [-3.0, 0.3, 1.0],
                direction: [1.0, 0.0, 0.0],
                part: [2.6, 3.4],
                normal: [-0.8, 0.6, 0.0],
                kind: FeatureKind::Edge,
            },
            Known {
                origin: [0.3, 0.0, 9.0],
                direction: [0.0, 0.0, -1.0],
                part: [6.6, 11.4],
                normal: [0.6, 0.0, 0.8],
                kind: FeatureKind::Vertex,
            },
            Known {
                origin: [-2.0, 0.0, -2.0],
                direction: [1.0, 0.0, 1.0],
                part: [1.5, 2.5],
                normal: [-1.0, 0.0, 0.0],
                kind: FeatureKind::Edge,
            },
            Known {
                origin: [-2.0, 0.0, 4.0],
                direction: [1.0, 0.0, -1.0],
                part: [2.0 - 0.5 * s, 2.5],
                normal: [-s, 0.0, s],
                kind: FeatureKind::Vertex,
            },
        ],
    );
}

#[test]
fn closed_forms_of_rounded_boxes() {
    let s = 0.5_f64.sqrt();
    check(
        &rounded_box(),
        &[
            // Through faces, through edges beside the box, through corners.
            Known {
                origin: [-5.0, 0.5, 1.5],
                direction: [1.0, 0.0, 0.0],
                part: [3.5, 6.5],
                normal: [-1.0, 0.0, 0.0],
                kind: FeatureKind::Face,
            },
            Known {
                origin: [-5.0, 2.3, 0.5],
                direction: [2.0, 0.0, 0.0],
                part: [1.8, 3.2],
                normal: [-0.8, 0.6, 0.0],
                kind: FeatureKind::Edge,
            },
            Known {
                origin: [-4.0, 5.0, 1.0],
                direction: [1.0, -1.0, 0.0],
                part: [3.0 - 0.5 * s, 5.5],
                normal: [-s, s, 0.0],
                kind: FeatureKind::Edge,
            },
            Known {
                origin: [1.24, 2.18, 9.0],
                direction: [0.0, 0.0, -1.0],
                part: [5.6, 12.4],
                normal: [0.48, 0.36, 0.8],
                kind: FeatureKind::Vertex,
            },
        ],
    );
}

/// The feature that is said is the hull's, in the caller's numbering.
#[test]
fn features_are_those_of_the_hull() {
    let mesh = cuboid([1.0, 2.0, 3.0]).unwrap();
    let options = ShapeOptions { swept_radius: 0.5, ..ShapeOptions::default() };
    let shape = Shape::from_mesh(&mesh, &options).unwrap();
    let met = |origin, direction| cast(&shape, &Pose::IDENTITY, origin, direction).feature;
    let face = met([-5.0, 0.5, 1.5], [1.0, 0.0, 0.0]);
    assert!(mesh.face(face.ids[0] as usize).iter().all(|&v| mesh.vertices[v as usize].x == -1.0), "{face:?}");
    let edge = met([-5.0, 2.3, 0.5], [2.0, 0.0, 0.0]);
    let corners = edge.ids.map(|v| mesh.vertices[v as usize]);
    assert!(corners.iter().all(|corner| (corner.x, corner.y) == (-1.0, 2.0)), "{edge:?}");
    let vertex = met([1.24, 2.18, 9.0], [0.0, 0.0, -1.0]);
    assert_eq!(mesh.vertices[vertex.ids[0] as usize], Vector::new(1.0, 2.0, 3.0));
}

#[test]
fn from_inside_and_on_the_surface() {
    let shapes = [ball(1.0), body(&cuboid([0.5, 0.5, 0.5]).unwrap().vertices, 0.5)];
    for shape in &shapes {
        let inside = cast(shape, &Pose::IDENTITY, [0.0, 0.25, 0.0], [0.0, 4.0, 0.0]);
        assert_eq!((inside.outcome, inside.entry, inside.exact), (RayOutcome::Inside, [0.0; 2], 0));
        assert!(is_about(inside.exit, 0.1875) && inside.normal[0].is_nan());
        assert_eq!(inside.feature.kind, FeatureKind::None);
        let inwards = cast(shape, &Pose::IDENTITY, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!((inwards.outcome, inwards.entry, inwards.exit), (RayOutcome::Hit, [0.0; 2], [2.0; 2]));
        assert_eq!(inwards.normal, [-1.0, 0.0, 0.0]);
        let outwards = cast(shape, &Pose::IDENTITY, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!((outwards.outcome, outwards.entry, outwards.exit), (RayOutcome::Inside, [0.0; 2], [0.0; 2]));
        let beside = cast(shape, &Pose::IDENTITY, [1.0_f64.next_up(), 0.0, 0.0], [1.0, 0.0, 0.0]);
        assert_eq!(beside.outcome, RayOutcome::Miss);
    }
    // Along the surface: a point of the ball, and 1 of the flat side of the box.
    let along = |shape: &Shape, x: f64| cast(shape, &Pose::IDENTITY, [x, 1.0, 0.0], [1.0, 0.0, 0.0]);
    let tangent = along(&shapes[0], 0.0);
    assert_eq!((tangent.outcome, tangent.entry, tangent.normal), (RayOutcome::Hit, [0.0; 2], [0.0, 1.0, 0.0]));
    assert!(tangent.exit[1] < 1e-300, "{tangent:?}");
    let first = along(&shapes[1], -0.5);
    assert_eq!((first.outcome, first.entry), (RayOutcome::Hit, [0.0; 2]));
    assert!(is_about(first.exit, 1.0), "{first:?}");
    let middle = along(&shapes[1], 0.0);
    assert_eq!((middle.outcome, middle.entry), (RayOutcome::Inside, [0.0; 2]));
    assert!(is_about(middle.exit, 0.5), "{middle:?}");
}

/// By integers where doubles cannot tell: at the top of a ball, at the end of a capsule, along a side of a box.
#[test]
fn what_only_touches_is_a_hit() {
    for (shape, top, part) in [
        (ball(1.0), [0.0, 1.0, 0.0], [3.0, 3.0]),
        (capsule(), [0.0, 0.0, 2.5], [3.0, 3.0]),
        (rounded_box(), [0.0, 2.5, 0.0], [2.0, 4.0]),
        (rounded_box(), [0.0, 2.3, 3.4], [2.0, 4.0]),
    ] {
        let from = |scale: f64| [-3.0, top[1] * scale, top[2] * scale];
        let touching = cast(&shape, &Pose::IDENTITY, from(1.0), [1.0, 0.0, 0.0]);
        let case = SweptCase {
            points: shape.polyhedron().vertices.iter().map(|v| v.position).collect(),
            radius: shape.swept_radius(),
            pose: Pose::IDENTITY,
            ray: Ray { origin: from(1.0), direction: [1.0, 0.0, 0.0], t_max: f64::INFINITY },
        };
        case.check(&touching);
        assert!(touching.exact == 1, "{touching:?}");
        // No double is 3.4, nor 2.3: beside the edge it may be on either side.
        if top[2] != 3.4 {
            assert!(is_about(touching.entry, part[0]) && is_about(touching.exit, part[1]), "{touching:?}");
        }
        let beside = cast(&shape, &Pose::IDENTITY, from(1.0 + 4.0 * f64::EPSILON), [1.0, 0.0, 0.0]);
        assert_eq!((beside.outcome, beside.exact), (RayOutcome::Miss, 1), "{beside:?}");
    }
}

#[test]
fn it_ends_at_t_max() {
    for shape in [ball(1.0), body(&[Vector::new(-0.5, 0.0, 0.0), Vector::new(0.5, 0.0, 0.0)], 0.5)] {
        let until = |t_max: f64| {
            let ray = Ray { origin: [-3.0, 0.0, 0.0], direction: [1.0, 0.0, 0.0], t_max };
            cast_ray(shape.at(&Pose::IDENTITY), &ray).unwrap()
        };
        assert_eq!((until(1.0).outcome, until(1.0).exact), (RayOutcome::Miss, 0));
        assert_eq!(until(2.0_f64.next_down()).outcome, RayOutcome::Miss);
        let touching = until(2.0);
        assert_eq!((touching.outcome, touching.entry, touching.exit), (RayOutcome::Hit, [2.0; 2], [2.0; 2]));
        assert_eq!(until(3.5).exit, [3.5; 2]);
        assert_eq!(until(0.0).outcome, RayOutcome::Miss);
        let inside = Ray { origin: [0.25, 0.0, 0.0], direction: [0.0, 1.0, 0.0], t_max: 0.0 };
        let answer = cast_ray(shape.at(&Pose::IDENTITY), &inside).unwrap();
        assert_eq!((answer.outcome, answer.exit), (RayOutcome::Inside, [0.0; 2]));
    }
}

#[test]
fn magnitudes_of_all_doubles() {
    let corners = cuboid([1.0; 3]).unwrap().vertices;
    for exponent in [-1000, -600, -200, -190, 0, 190, 200, 600, 999] {
        let scale = 2_f64.powi(exponent);
        let points: Vec<Vector> = corners.iter().map(|p| p * scale).collect();
        for shape in [body(&points, scale), body(&[Vector::zeros()], 2.0 * scale)] {
            let answer = cast(&shape, &Pose::IDENTITY, [-4.0 * scale, 0.0, 0.0], [scale, 0.0, 0.0]);
            assert_eq!(answer.outcome, RayOutcome::Hit, "{exponent}");
            assert!(is_about(answer.entry, 2.0) && is_about(answer.exit, 6.0), "{exponent} {answer:?}");
            assert_eq!(answer.normal, [-1.0, 0.0, 0.0]);
            assert!(exponent.abs() > 195 || answer.exact == 0, "{exponent} {answer:?}");
        }
    }
    // Where it is, no double says.
    let slow = cast(&ball(1.0), &Pose::IDENTITY, [-1e300, 0.0, 0.0], [5e-324, 0.0, 0.0]);
    assert_eq!((slow.outcome, slow.entry), (RayOutcome::Hit, [f64::MAX, f64::INFINITY]));
    assert_eq!(slow.normal, [-1.0, 0.0, 0.0]);
}

/// A ray begins so near to a corner that the square of the way between them underflows. Divided by its length, as doubles have it,
/// the normal was infinite.
#[test]
fn a_way_whose_square_underflows() {
    let corners = [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0], [2.0, 0.0, -1.0]].map(Vector::from);
    let shape = body(&corners, 1e-300);
    for scale in [5e-324, 1e-320, 1e-310, 1e-308, 1e-301] {
        for way in [[-4.0, 1.0, 2.0], [-4.0, -1.0, 1.0], [-4.0, 2.0, -3.0], [-4.0, 0.0, 0.0]].map(Vector::from) {
            // All of them begin in the ball around the corner, or next to it.
            let answer = cast(&shape, &Pose::IDENTITY, (way * scale).into(), [1.0, 0.25, 0.5]);
            let outcome = if scale < 1e-301 { RayOutcome::Inside } else { answer.outcome };
            assert_eq!(answer.outcome, outcome, "{scale:e} {way:?} {answer:?}");
            assert!(answer.exit[1] > 0.5, "{scale:e} {way:?} {answer:?}");
        }
    }
}

/// A pose does not stretch the ball.
#[test]
fn the_ball_stays_round_in_the_world() {
    let stretched = Pose::new(&(Matrix::identity() * 1.004), &Vector::zeros());
    let of_ball = cast(&ball(1.0), &stretched, [-3.0, 0.5, 0.0], [1.0, 0.0, 0.0]);
    assert!(of_ball.exact == 0 && is_about(of_ball.entry, 3.0 - 0.75_f64.sqrt()), "{of_ball:?}");
    let of_box = cast(&rounded_box(), &stretched, [-3.0, 0.1, 0.2], [1.0, 0.0, 0.0]);
    assert!(of_box.exact == 0 && is_about(of_box.entry, 3.0 - 1.504), "{of_box:?}");
    let of_edge = cast(&rounded_box(), &stretched, [-5.0, 2.0 * 1.004 + 0.3, 0.0], [1.0, 0.0, 0.0]);
    assert!(of_edge.exact == 0 && is_about(of_edge.entry, 5.0 - 1.404), "{of_edge:?}");
}

/// The bits of the same body.
#[test]
fn a_radius_of_0_is_none() {
    let mut random = Random::new(0x5a);
    for _ in 0..500 {
        let Case { points, pose, ray, .. } = anywhere(&mut random);
        let bits = |shape: &Shape| format!("{:?}", cast_ray(shape.at(&pose), &ray).unwrap());
        assert_eq!(bits(&body(&points, 0.0)), bits(&hull(&points)));
    }
}

fn try_case(case: &SweptCase) -> (RayOutcome, bool) {
    let answer = cast_ray(body(&case.points, case.radius).at(&case.pose), &case.ray).unwrap();
    case.check(&answer);
    (answer.outcome, answer.exact == 0)
}

/// Counts of misses, hits and rays from inside, and of those that doubles decided.
fn try_all(seed: u64, count: usize, make: fn(&mut Random) -> Case) -> [usize; 4] {
    let mut random = Random::new(seed);
    let mut counts = [0; 4];
    for _ in 0..count {
        let case = make(&mut random);
        let (outcome, in_doubles) = try_case(&swept(&mut random, case));
        counts[outcome as usize - 1] += 1;
        counts[3] += usize::from(in_doubles);
    }
    counts
}

#[test]
fn on_lattices() {
    let counts = try_all(0x51, 1_500, on_lattice);
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

#[test]
fn rays_anywhere() {
    let counts = try_all(0x52, 1_500, anywhere);
    assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
}

/// Rotations that are off by up to 1e-2, the most that is accepted.
#[test]
fn skewed_poses() {
    let skewed = |random: &mut Random| {
        let mut case = anywhere(random);
        let by = random.pick(&[1e-2, 1e-3, 1e-8, 1e-14]);
        loop {
            let noise = Matrix::from_columns(&[(); 3].map(|()| random.vector())) * by;
            let pose = Pose::new(&(case.pose.rotation() + noise), &case.pose.translation());
            if pose.check().is_ok() {
                case.pose = pose;
                return case;
            }
        }
    };
    let counts = try_all(0x53, 800, skewed);
    assert!(counts.iter().all(|&count| count > 50), "{counts:?}");
}

/// Ten times as many, other ones, for changes of rays: `cargo test --profile checked --test ray -- --ignored`.
#[test]
#[ignore = "takes minutes; the tests above are a tenth of it"]
fn many_more() {
    println!("{:?}", try_all(0x54, 15_000, on_lattice));
    println!("{:?}", try_all(0x55, 15_000, anywhere));
}

/// How the distance of the origin from a triangle, which may have no area, compares with a length: that of a corner, a side or the
/// inside, whichever is the least.
fn compare_triangle([a, b, c]: [&Integers; 3], square_of_length: &IBig) -> Ordering {
    let mut least = [a, b, c].map(|corner| dot(corner, corner).cmp(square_of_length)).into_iter().min().unwrap();
    for [from, to] in [[a, b], [b, c], [c, a]] {
        let side = minus(to, from);
        let (length, along) = (dot(&side, &side), -dot(from, &side));
        if along > IBig::ZERO && along < length {
            least = least.min((dot(from, from) * &length - &along * &along).cmp(&(square_of_length * &length)));
        }
    }
    let [side, other] = [minus(b, a), minus(c, a)];
    let minor = |i: usize, j: usize| &side[i] * &other[j] - &side[j] * &other[i];
    let normal = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let square = dot(&normal, &normal);
    // The weights of the foot, by both sides' squares and products.
    let (ss, oo, so) = (dot(&side, &side), dot(&other, &other), dot(&side, &other));
    let (s, o) = (-dot(a, &side), -dot(a, &other));
    let (second, third) = (&oo * &s - &so * &o, &ss * &o - &so * &s);
    if square > IBig::ZERO && second >= IBig::ZERO && third >= IBig::ZERO && &second + &third <= square {
        let height = dot(&normal, a);
        least = least.min((&height * &height).cmp(&(square_of_length * square)));
    }
    least
}

/// Bodies of a hundred vertices and more, merged faces among them: both ends against the distances of all triangles, and misses
/// against those of the triangles seen along the line.
#[test]
fn larger_bodies() {
    let mut random = Random::new(0x58);
    let bodies = [
        random_points(&mut random, 100),
        ellipsoid([1.0, 0.7, 0.05], 150).unwrap().vertices,
        prism(60, 0.3).unwrap().vertices,
        grid_on_cube(5),
    ];
    let (mut counts, mut exact) = ([0; 2], 0);
    for round in 0..400 {
        let radius = random.pick(&[1e-6, 0.05, 0.5, 20.0]);
        let shape = body(&bodies[round % 4], radius);
        let polyhedron = shape.polyhedron();
        let pose = Pose::new(&random.rotation(), &random.vector());
        let reach = 1.0 + radius;
        let origin = pose.translation() + random.direction() * (reach * random.uniform(1.5, 4.0));
        let aim = pose.translation() + random.direction() * (reach * random.uniform(0.0, 1.1));
        let ray = Ray { origin: origin.into(), direction: (aim - origin).into(), t_max: f64::INFINITY };
        let answer = cast_ray(shape.at(&pose), &ray).unwrap();
        exact += answer.exact;
        let whole = |v: [f64; 3]| v.map(|x| integer(&rational(x)));
        let [start, direction] = [ray.origin, ray.direction].map(whole);
        let world: Vec<Integers> = (0..polyhedron.vertices.len() as u32)
            .map(|v| {
                let local = <[f64; 3]>::from(polyhedron.local_position(v)).map(rational);
                minus(&transform(&row_major(&pose), &local).each_ref().map(integer), &start)
            })
            .collect();
        // Of the body as something shows it, in so many times its size.
        let compare = |size: &IBig, shown: &dyn Fn(&Integers) -> Integers| {
            let places: Vec<Integers> = world.iter().map(shown).collect();
            let length = integer(&rational(radius)) * size;
            let corners = polyhedron.triangles.iter().map(|corners| corners.map(|v| &places[v as usize]));
            corners.map(|corners| compare_triangle(corners, &(&length * &length))).min().unwrap()
        };
        if answer.outcome == RayOutcome::Miss {
            // Each place less its part along the direction.
            let length = dot(&direction, &direction);
            let across = |place: &Integers| {
                let part = dot(place, &direction);
                [0, 1, 2].map(|k| &place[k] * &length - &part * &direction[k])
            };
            assert!(compare(&length, &across).is_gt(), "{ray:?} {answer:?}");
            counts[0] += 1;
            continue;
        }
        assert_eq!(answer.outcome, RayOutcome::Hit);
        let at = |t: f64| {
            let (unit, t) = (integer(&rational(1.0)), integer(&rational(t)));
            compare(&unit, &|place| [0, 1, 2].map(|k| &place[k] * &unit - &t * &direction[k]))
        };
        let [entry, exit] = [answer.entry, answer.exit].map(|ends| ends.map(at));
        assert!(entry[0].is_ge() && entry[1].is_le() && exit[0].is_le() && exit[1].is_ge(), "{ray:?} {answer:?}");
        counts[1] += 1;
    }
    assert!(counts.iter().all(|&count| count > 20) && exact < 20, "{counts:?} {exact}");
}

/// Most rays at bodies as they are used cost no integers.
#[test]
fn doubles_suffice_for_most() {
    let mut random = Random::new(0x56);
    let bodies = [ball(1.0), capsule(), rounded_box(), body(&random_points(&mut random, 60), 0.25)];
    for shape in &bodies {
        let mut exact = 0;
        for _ in 0..2_000 {
            let pose = Pose::new(&random.rotation(), &random.vector());
            let origin = pose.translation() + random.direction() * random.uniform(4.0, 9.0);
            let aim = pose.translation() + random.direction() * random.uniform(0.0, 3.0);
            exact += cast(shape, &pose, origin.into(), (aim - origin).into()).exact;
        }
        assert!(exact <= 4, "{exact} of 2000: {} vertices", shape.polyhedron().vertices.len());
    }
}

fn random_points(random: &mut Random, count: usize) -> Vec<Vector> {
    (0..count).map(|_| random.direction()).collect()
}

#[test]
fn the_floating_point_environment_changes_no_bit() {
    let mut random = Random::new(0x57);
    for _ in 0..60 {
        let case = anywhere(&mut random);
        let case = swept(&mut random, case);
        let shape = body(&case.points, case.radius);
        let plain = format!("{:?}", cast_ray(shape.at(&case.pose), &case.ray).unwrap());
        for environment in Environment::all() {
            let answer = environment.run(|| cast_ray(shape.at(&case.pose), &case.ray).unwrap());
            assert_eq!(format!("{answer:?}"), plain, "{environment:?}");
        }
    }
}
