//! Bodies of hundreds of vertices, merged faces among them, against the planes of all triangles in integers.

use dashu_ratio::RBig;
use swiftprox::math::{Pose, Vector};
use swiftprox::ray::{Ray, RayOutcome, cast_ray};
use swiftprox::shape::Shape;
use testkit::models::{ellipsoid, grid_on_cube, prism};
use testkit::oracle::{rational, transform};
use testkit::random::Random;
use testkit::rays::{Case, check};
use testkit::shapes::hull;

pub type Integers = [dashu_int::IBig; 3];

/// What a double or a product of two is a multiple of, here.
const BITS: usize = 400;

pub fn integer(x: &RBig) -> dashu_int::IBig {
    let shifted = x * RBig::from(dashu_int::IBig::ONE << BITS);
    assert!(shifted.denominator().is_one());
    shifted.numerator().clone()
}

pub fn dot(a: &Integers, b: &Integers) -> dashu_int::IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn minus(a: &Integers, b: &Integers) -> Integers {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

/// The planes of a body's triangles in the world: outward normals and points.
fn planes(shape: &Shape, pose: &Pose) -> Vec<(Integers, Integers)> {
    let polyhedron = shape.polyhedron();
    let matrix = std::array::from_fn(|k| pose.rows[k / 4][k % 4]);
    let world: Vec<Integers> = (0..polyhedron.vertices.len() as u32)
        .map(|v| {
            let local = polyhedron.local_position(v);
            transform(&matrix, &[local.x, local.y, local.z].map(rational)).each_ref().map(integer)
        })
        .collect();
    let plane = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|v| &world[v as usize]);
        let (e, f) = (minus(b, a), minus(c, a));
        let minor = |i: usize, j: usize| &e[i] * &f[j] - &e[j] * &f[i];
        ([minor(1, 2), minor(2, 0), minor(0, 1)], a.clone())
    };
    polyhedron.triangles.iter().map(plane).collect()
}

/// The part of the ray's line behind all planes (Cyrus & Beck 1978).
fn clipped(planes: &[(Integers, Integers)], ray: &Ray) -> Option<[RBig; 2]> {
    let [origin, direction] = [ray.origin, ray.direction].map(|v| v.map(|x| integer(&rational(x))));
    let zero = dashu_int::IBig::ZERO;
    let (mut first, mut last): (Option<RBig>, Option<RBig>) = (None, None);
    for (normal, point) in planes {
        let (ahead, along) = (dot(normal, &minus(point, &origin)), dot(normal, &direction));
        if along == zero {
            if ahead < zero {
                return None;
            }
            continue;
        }
        let faces = along < zero;
        let at = RBig::from(ahead) / RBig::from(along);
        match faces {
            true => first = Some(first.map_or(at.clone(), |t| t.max(at))),
            false => last = Some(last.map_or(at.clone(), |t| t.min(at))),
        }
    }
    let (first, last) = (first?, last?);
    (first <= last).then_some([first, last])
}

#[test]
fn against_all_planes() {
    let mut random = Random::new(5);
    let of_mesh = |mesh: swiftprox::mesh::PolygonMesh| mesh.vertices;
    let bodies = [
        of_mesh(ellipsoid([1.0, 0.7, 0.5], 150).unwrap()),
        of_mesh(ellipsoid([1.0, 1.0, 0.01], 150).unwrap()),
        of_mesh(ellipsoid([1.0, 0.02, 0.02], 150).unwrap()),
        of_mesh(prism(60, 0.3).unwrap()),
        grid_on_cube(5),
    ];
    let (mut hits, mut in_doubles, mut count) = (0, 0, 0);
    for points in &bodies {
        let shape = hull(points);
        for turn in 0..4 {
            let rotation = if turn == 0 { random.quarter_turns() } else { random.rotation() };
            let pose = Pose::new(&rotation, &(random.lattice(3) * 0.5));
            let planes = planes(&shape, &pose);
            for _ in 0..40 {
                let mut any = || pose.transform(&points[random.below(points.len())]);
                let (a, b) = (any(), any());
                // Through two corners, through the middle between two, beside a corner, at a distance.
                let apart = if a == b { Vector::y() } else { b - a };
                let direction = [apart, random.direction(), random.lattice(2) + Vector::x() * 0.5][random.below(3)];
                let through = [a, (a + b) * 0.5, a + random.direction() * 0.1][random.below(3)];
                let origin = through - direction * random.uniform(-1.0, 4.0);
                let ray = Ray { origin: origin.into(), direction: direction.into(), t_max: random.uniform(0.0, 9.0) };
                let answer = cast_ray(shape.at(&pose), &ray).unwrap();
                check(&Case { points: points.clone(), pose, ray, truth: clipped(&planes, &ray) }, &answer);
                hits += usize::from(answer.outcome != RayOutcome::Miss);
                in_doubles += usize::from(answer.exact == 0);
                count += 1;
            }
        }
    }
    assert!(hits > count / 4 && in_doubles > count / 2, "{hits} hits, {in_doubles} in doubles, of {count}");
}
