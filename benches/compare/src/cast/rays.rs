//! Rays at one body beside parry's, round ones among them. On a few vertices our answers are judged by exact rationals; the peer is
//! judged by ours.

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::Ray as ParryRay;
use parry3d_f64::shape::{Ball, Capsule, Cuboid, RoundShape, Shape as ParryShape};
use swiftprox::math::{Pose, Vector};
use swiftprox::ray::{Ray, RayOutcome, cast_ray};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::models::{cuboid, random_hull};
use testkit::random::Random;
use testkit::rays::{Case, SweptCase, check, truth};

use super::scenes::Truth;
use super::{Caster, Row, Said, compare, ours, parry};
use crate::options::Options;
use crate::parry::pose_of;

const SIZES: [usize; 3] = [20, 102, 1002];

/// The exact truth of a ray takes time in the third power of the vertices.
const MOST_FOR_TRUTH: usize = 20;

pub fn measure(options: &Options) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for n in SIZES {
        let mesh = random_hull(n, 1).map_err(|error| error.to_string())?;
        let shape = Shape::from_mesh(&mesh, &ShapeOptions::default()).map_err(|error| error.to_string())?;
        let rays = rays(4 * options.count);
        let ours = Ours { shape: &shape, rays: &rays };
        let truths: Vec<Truth> = (0..rays.len()).map(|i| ours.truth(i)).collect();
        if n <= MOST_FOR_TRUTH {
            rays.iter().for_each(|(pose, ray)| judge(&mesh.vertices, &shape, pose, ray));
        }
        let parry = Parry { shape: Box::new(parry::polyhedron(&mesh)?), rays: rays.iter().map(theirs).collect() };
        let mut methods: Vec<Box<dyn Caster + '_>> = vec![Box::new(ours), Box::new(parry)];
        rows.extend(compare("ray", &format!("rays, {n} vertices"), &mut methods, &truths, options));
    }
    for RoundBody { name, points, radius, theirs: shape } in round_bodies()? {
        let swept = ShapeOptions { input: InputPolicy::Hull, swept_radius: radius, ..ShapeOptions::default() };
        let own = Shape::from_points(&points, &swept).map_err(|error| error.to_string())?;
        let rays = rays(4 * options.count);
        let ours = Ours { shape: &own, rays: &rays };
        let truths: Vec<Truth> = (0..rays.len()).map(|i| ours.truth(i)).collect();
        if points.len() <= MOST_FOR_SWEPT_TRUTH {
            for (pose, ray) in rays.iter().take(options.count) {
                let case = SweptCase { points: points.clone(), radius, pose: *pose, ray: *ray };
                case.check(&cast_ray(own.at(pose), ray).expect("finite rays"));
            }
        }
        let parry = Parry { shape, rays: rays.iter().map(theirs).collect() };
        let mut methods: Vec<Box<dyn Caster + '_>> = vec![Box::new(ours), Box::new(parry)];
        rows.extend(compare("ray", &format!("rays, {name}"), &mut methods, &truths, options));
    }
    Ok(rows)
}

/// The exact truth of a round body takes time in the fourth power of the vertices.
const MOST_FOR_SWEPT_TRUTH: usize = 8;

struct RoundBody {
    name: &'static str,
    points: Vec<Vector>,
    radius: f64,
    theirs: Box<dyn ParryShape>,
}

/// About as large as the hulls, of radius 1.
fn round_bodies() -> Result<[RoundBody; 4], String> {
    let (half, radius) = ([0.6, 0.5, 0.4], 0.1);
    let hull = random_hull(102, 1).map_err(|error| error.to_string())?;
    let end = Vector::new(0.0, 0.0, 0.6);
    Ok([
        RoundBody { name: "ball", points: vec![Vector::zeros()], radius: 0.9, theirs: Box::new(Ball::new(0.9)) },
        RoundBody {
            name: "capsule",
            points: vec![-end, end],
            radius: 0.4,
            theirs: Box::new(Capsule::new_z(end.z, 0.4)),
        },
        RoundBody {
            name: "box of 8, radius 0.1",
            points: cuboid(half).map_err(|error| error.to_string())?.vertices,
            radius,
            theirs: Box::new(RoundShape {
                inner_shape: Cuboid::new(ParryVector::new(half[0], half[1], half[2])),
                border_radius: radius,
            }),
        },
        RoundBody {
            name: "102 vertices, radius 0.1",
            points: hull.vertices.clone(),
            radius,
            theirs: Box::new(RoundShape { inner_shape: parry::polyhedron(&hull)?, border_radius: radius }),
        },
    ])
}

/// From a shell around the body, of radius 1, to about the body: two in three hit.
fn rays(count: usize) -> Vec<(Pose, Ray)> {
    let mut random = Random::new(0x7a75);
    let mut ray = || {
        let pose = Pose::new(&random.rotation(), &random.vector());
        let origin = pose.translation() + random.direction() * random.uniform(1.5, 4.0);
        let aim = pose.translation() + random.direction() * random.uniform(0.0, 1.2);
        (pose, Ray { origin: origin.into(), direction: (aim - origin).into(), t_max: f64::INFINITY })
    };
    (0..count).map(|_| ray()).collect()
}

fn judge(points: &[Vector], shape: &Shape, pose: &Pose, ray: &Ray) {
    let case = Case { points: points.to_vec(), pose: *pose, ray: *ray, truth: truth(points, pose, ray) };
    check(&case, &cast_ray(shape.at(pose), ray).expect("finite rays"));
}

struct Ours<'a> {
    shape: &'a Shape,
    rays: &'a [(Pose, Ray)],
}

impl Ours<'_> {
    fn truth(&self, i: usize) -> Truth {
        let (pose, ray) = &self.rays[i];
        let answer = cast_ray(self.shape.at(pose), ray).expect("finite rays");
        if answer.outcome == RayOutcome::Miss { Truth::Free } else { Truth::Hit(answer.entry) }
    }
}

impl Caster for Ours<'_> {
    fn name(&self) -> &str {
        ours::NAME
    }

    fn cast(&mut self, i: usize) -> Said {
        let (pose, ray) = &self.rays[i];
        match cast_ray(self.shape.at(pose), ray) {
            Ok(answer) if answer.outcome == RayOutcome::Miss => Said::Free,
            Ok(answer) => Said::Hit(answer.entry[0]),
            Err(_) => Said::Unknown,
        }
    }
}

fn theirs((pose, ray): &(Pose, Ray)) -> (ParryPose, ParryRay) {
    let vector = |[x, y, z]: [f64; 3]| ParryVector::new(x, y, z);
    (pose_of(pose.rows.as_flattened()), ParryRay::new(vector(ray.origin), vector(ray.direction)))
}

/// `cast_ray_and_get_normal`.
struct Parry {
    shape: Box<dyn ParryShape>,
    rays: Vec<(ParryPose, ParryRay)>,
}

impl Caster for Parry {
    fn name(&self) -> &str {
        "parry"
    }

    fn cast(&mut self, i: usize) -> Said {
        let (pose, ray) = &self.rays[i];
        match self.shape.cast_ray_and_get_normal(pose, ray, f64::MAX, true) {
            Some(hit) => Said::Hit(hit.time_of_impact),
            None => Said::Free,
        }
    }
}
