//! Rays at any body at any pose, with a ball of any radius swept over it: refused exactly if a number is out of range, else judged
//! by exact rationals; and in the floating-point environment that the last byte chooses the bits are the same.

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::ray::{Ray, cast_ray};
use swiftprox::shape::{LARGEST_SWEPT_RADIUS, Shape, ShapeOptions};
use testkit::rays::{Case, SweptCase, check, check_intervals, truth};

use crate::geometry::{any_number, hull_options, inside, last_is_environment, points, pose};

/// The truth takes time in the third power of this …
const MOST_POINTS: usize = 10;

/// … and with a swept radius in the fourth of this.
const MOST_SWEPT_POINTS: usize = 6;

const MOST_RAYS: usize = 4;

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes), environment);
}

fn run_from(u: &mut Unstructured, environment: Environment) -> Result<()> {
    let radius = if u.arbitrary()? { any_number(u, &mut 1.0)?.abs() } else { 0.0 };
    let radius = if radius <= LARGEST_SWEPT_RADIUS { radius } else { 0.0 };
    let most = if radius > 0.0 { MOST_SWEPT_POINTS } else { MOST_POINTS };
    let (points, pose, options) = (points(u, most)?, pose(u)?, hull_options(u)?);
    let options = ShapeOptions { swept_radius: radius, ..options };
    // Not every body has levels.
    let Ok(shape) = Shape::from_points(&points, &options) else { return Ok(()) };
    for _ in 0..MOST_RAYS {
        let ray = ray(u, &points, &pose)?;
        let answer = cast_ray(shape.at(&pose), &ray);
        let again = inside(environment, || cast_ray(shape.at(&pose), &ray));
        assert_eq!(format!("{again:?}"), format!("{answer:?}"), "{environment:?}");
        let accepted = pose.check().is_ok();
        match answer {
            Ok(answer) => {
                assert!(accepted && is_sound(&ray), "{ray:?} {pose:?}");
                if radius > 0.0 {
                    SweptCase { points: points.clone(), radius, pose, ray }.check_part(&answer);
                    continue;
                }
                let case = Case { truth: truth(&points, &pose, &ray), points: points.clone(), pose, ray };
                check_intervals(&case, &answer);
                if is_tame(&case) {
                    check(&case, &answer);
                }
            }
            Err(Error::Pose(_)) => assert!(!accepted),
            Err(Error::Argument(_)) => assert!(!is_sound(&ray), "{ray:?}"),
            Err(error) => panic!("{error}: {ray:?}"),
        }
        if u.is_empty() {
            break;
        }
    }
    Ok(())
}

/// Mostly towards a corner, or the middle of two.
fn ray(u: &mut Unstructured, points: &[Vector], pose: &Pose) -> Result<Ray> {
    let mut last = 1.0;
    let mut vector = |u: &mut Unstructured| -> Result<Vector> {
        Ok(Vector::new(any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?))
    };
    let origin = vector(u)?;
    let direction = if u.ratio(1, 4)? {
        vector(u)?
    } else {
        let [a, b] = [points[u.choose_index(points.len())?], points[u.choose_index(points.len())?]];
        pose.transform(&(a * 0.5 + b * 0.5)) - origin
    };
    let t_max = if u.arbitrary()? { f64::INFINITY } else { any_number(u, &mut last)? };
    Ok(Ray { origin: origin.into(), direction: direction.into(), t_max })
}

fn is_sound(ray: &Ray) -> bool {
    let finite = ray.origin.iter().chain(&ray.direction).all(|x| x.is_finite());
    finite && ray.direction != [0.0; 3] && ray.t_max >= 0.0
}

/// Whether all numbers are so far inside the doubles that a normal can be measured in them.
fn is_tame(case: &Case) -> bool {
    let Case { points, pose, ray, .. } = case;
    let places = pose.rows.map(|row| row[3]);
    let numbers = points.iter().flatten().chain(&places).chain(&ray.origin).chain(&ray.direction);
    numbers.into_iter().all(|&x| x == 0.0 || (1e-30..1e30).contains(&x.abs()))
}
