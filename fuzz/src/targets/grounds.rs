//! Grounds of any triangles or heights, and a body beside them, with a ball swept over it or without: refused exactly if a number
//! is out of range. Distance and verdict are judged by exact rationals of all triangles, and by each triangle as a body of its own;
//! contacts by what holds of each. In the floating-point environment that the last byte chooses the bits are the same.

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::ground::{
    Ground, GroundContacts, GroundDistance, HeightGrid, PlacedGround, ground_contacts, ground_distance,
};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, Placed, Query, distance};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::cases::Case;
use testkit::oracle::rational;
use testkit::swept::Length;

use crate::geometry::{any_number, any_points, inside, last_is_environment, points, poses};

/// The truth takes time in the fourth power of this.
const MOST_POINTS: usize = 5;

const MOST_VERTICES: usize = 12;
const MOST_TRIANGLES: usize = 10;

const MOST_STEPS: usize = 4;

/// The largest coordinate that a ground may have, and the extent below which a triangle is left out.
const LARGEST: f64 = f64::from_bits((1023 + 200) << 52);
const SMALLEST: f64 = f64::from_bits((1023 - 200) << 52);

struct Body {
    points: Vec<Vector>,
    radius: f64,
    shape: Shape,
}

/// A ground, and the corners of its triangles that have an area.
struct Surface {
    ground: Ground,
    triangles: Vec<[Vector; 3]>,
}

pub fn run(bytes: &[u8]) {
    let (environment, bytes) = last_is_environment(bytes);
    // Bytes that end early end the run.
    let _: Result<()> = run_from(&mut Unstructured::new(bytes), environment);
}

fn run_from(u: &mut Unstructured, environment: Environment) -> Result<()> {
    let surface = if u.ratio(1, 4)? { of_heights(u, environment)? } else { of_triangles(u, environment)? };
    let Some(surface) = surface else { return Ok(()) };
    let body = body(u)?;
    let corners: Vec<Vector> = surface.triangles.iter().flatten().copied().collect();
    for _ in 0..MOST_STEPS {
        let [pose, place] = poses(u, [&body.points, &corners])?;
        if [pose, place].iter().all(|pose| pose.check().is_ok()) {
            let placed = (body.shape.at(&pose), surface.ground.at(&place));
            let is_met = check_distance(&body, &surface, placed, environment);
            check_contacts(u, placed, is_met, is_tame(&body, &corners, [&pose, &place]), environment)?;
        }
        if u.is_empty() {
            break;
        }
    }
    Ok(())
}

fn body(u: &mut Unstructured) -> Result<Body> {
    let points = points(u, MOST_POINTS)?;
    let mut last = points[0].amax();
    let radius = if u.arbitrary()? { 0.0 } else { any_number(u, &mut last)?.abs() };
    let make = |swept_radius| {
        let options = ShapeOptions { input: InputPolicy::Hull, swept_radius, ..ShapeOptions::default() };
        Shape::from_points(&points, &options)
    };
    match make(radius) {
        Ok(shape) => Ok(Body { points, radius, shape }),
        // Of a radius that is none.
        Err(_) => Ok(Body { shape: make(0.0).expect("finite points"), points, radius: 0.0 }),
    }
}

fn of_triangles(u: &mut Unstructured, environment: Environment) -> Result<Option<Surface>> {
    let vertices = any_points(u, MOST_VERTICES)?;
    let mut triangles = Vec::new();
    for _ in 0..u.int_in_range(1..=MOST_TRIANGLES)? {
        let corner = |u: &mut Unstructured| Ok(u.choose_index(vertices.len())? as u32);
        triangles.push([corner(u)?, corner(u)?, corner(u)?]);
    }
    if u.ratio(1, 32)? {
        triangles[0][0] = u.arbitrary()?;
    }
    let is_sound = triangles.iter().flatten().all(|&v| (v as usize) < vertices.len());
    let make = || Ground::from_triangles(&vertices, &triangles);
    Ok(made(make, is_sound, &vertices, &triangles, environment))
}

fn of_heights(u: &mut Unstructured, environment: Environment) -> Result<Option<Surface>> {
    let (rows, columns) = (u.int_in_range(1..=3_usize)?, u.int_in_range(1..=3_usize)?);
    let mut last = 1.0;
    let spacing = [any_number(u, &mut last)?, any_number(u, &mut last)?];
    let mut heights = Vec::new();
    for _ in 0..rows * columns {
        heights.push(any_number(u, &mut last)?);
    }
    let make = || Ground::from_heights(&HeightGrid { rows, columns, spacing, heights: &heights });
    let is_grid = rows > 1 && columns > 1 && spacing.iter().all(|apart| (2.0 * SMALLEST..=LARGEST).contains(apart));
    if !is_grid {
        assert!(matches!(make(), Err(Error::Argument(_))), "{spacing:?}");
        return Ok(None);
    }
    let height = |v: usize| if heights[v].is_nan() { 0.0 } else { heights[v] };
    let place = |v: usize| {
        let (row, column) = (v / columns, v % columns);
        Vector::new(column as f64 * spacing[0], row as f64 * spacing[1], height(v))
    };
    let vertices: Vec<Vector> = (0..rows * columns).map(place).collect();
    let mut triangles = Vec::new();
    for cell in (0..rows - 1).flat_map(|row| (0..columns - 1).map(move |column| row * columns + column)) {
        let [a, b, c, d] = [cell, cell + 1, cell + columns + 1, cell + columns];
        if ![a, b, c, d].iter().any(|&v| heights[v].is_nan()) {
            triangles.extend([[a, b, c], [a, c, d]].map(|corners| corners.map(|v| v as u32)));
        }
    }
    Ok(made(make, true, &vertices, &triangles, environment))
}

/// A ground that is as sound as its numbers.
fn made(
    make: impl Fn() -> swiftprox::error::Result<Ground>,
    is_sound: bool,
    vertices: &[Vector],
    triangles: &[[u32; 3]],
    environment: Environment,
) -> Option<Surface> {
    let ground = make();
    assert_eq!(format!("{:?}", inside(environment, make)), format!("{ground:?}"), "{environment:?}");
    let is_sound = is_sound && vertices.iter().flatten().all(|x| x.abs() <= LARGEST);
    if !is_sound {
        assert!(matches!(ground, Err(Error::Mesh(_))), "{vertices:?} {triangles:?}");
        return None;
    }
    let corners = triangles.iter().map(|corners| corners.map(|v| vertices[v as usize]));
    let with_area: Vec<[Vector; 3]> = corners.filter(has_area).collect();
    match ground {
        Ok(ground) => {
            assert!(!with_area.is_empty(), "{vertices:?} {triangles:?}");
            Some(Surface { ground, triangles: with_area })
        }
        Err(error) => {
            assert!(with_area.is_empty() && matches!(error, Error::Mesh(_)), "{error}: {vertices:?} {triangles:?}");
            None
        }
    }
}

/// Exactly: three points on no line, not all within 2⁻²⁰⁰.
fn has_area(corners: &[Vector; 3]) -> bool {
    let [a, b, c] = corners;
    let is_extended = (b - a).amax().max((c - a).amax()) >= 2.0 * SMALLEST;
    let [a, b, c] = corners.map(|corner| <[f64; 3]>::from(corner).map(rational));
    let across = |i: usize, j: usize| (&b[i] - &a[i]) * (&c[j] - &a[j]) - (&b[j] - &a[j]) * (&c[i] - &a[i]);
    is_extended && [(1, 2), (2, 0), (0, 1)].iter().any(|&(i, j)| !across(i, j).is_zero())
}

/// Returns whether body and ground intersect.
fn check_distance(
    body: &Body,
    surface: &Surface,
    (placed, ground): (Placed, PlacedGround),
    environment: Environment,
) -> bool {
    let ask = |query: Query| ground_distance(query, placed, ground, &PairConfig::default()).expect("accepted poses");
    let told = |query: Query| (ask(query), inside(environment, || ask(query)));
    let [found, verdict] = [Query::Distance, Query::Intersection].map(|query| {
        let (answer, again) = told(query);
        assert_eq!(format!("{again:?}"), format!("{answer:?}"), "{environment:?}");
        answer
    });
    let described = || {
        let Body { points, radius, .. } = body;
        format!(
            "{found:?}\n{points:?} of radius {radius:?} at {:?}\n{:?} at {:?}",
            placed.pose, surface.triangles, ground.pose
        )
    };
    let GroundDistance { answer, triangle } = &found;
    let is_met = answer.outcome == Outcome::Intersecting;
    assert_eq!(verdict.answer.outcome == Outcome::Intersecting, is_met, "{verdict:?} {}", described());
    assert!((*triangle as usize) < surface.ground.triangle_count(), "{}", described());
    let lengths: Vec<Length> =
        surface.triangles.iter().map(|corners| truth(body, placed.pose, corners, ground.pose)).collect();
    assert_eq!(is_met, lengths.iter().any(|length| length.compared_with(0.0).is_le()), "{}", described());
    if !is_met {
        assert!(lengths.iter().all(|length| length.compared_with(answer.lower).is_ge()), "{}", described());
        assert!(lengths.iter().any(|length| length.compared_with(answer.upper).is_le()), "{}", described());
        assert!(
            lengths.iter().all(|length| length.compared_with(verdict.answer.lower).is_ge()),
            "{verdict:?} {}",
            described()
        );
    }
    for corners in &surface.triangles {
        let own = of_triangle(placed, corners, ground.pose);
        assert!(
            answer.lower <= own.upper && (is_met || own.outcome != Outcome::Intersecting),
            "{own:?} {}",
            described()
        );
    }
    is_met
}

fn truth(body: &Body, pose: &Pose, corners: &[Vector; 3], place: &Pose) -> Length {
    let case = Case { points_a: body.points.clone(), pose_a: *pose, points_b: corners.to_vec(), pose_b: *place };
    Length::between(&case.truth(), [body.radius, 0.0])
}

/// The answer about a triangle as a body.
fn of_triangle(body: Placed, corners: &[Vector; 3], place: &Pose) -> PairAnswer {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let triangle = Shape::from_points(corners, &options).expect("finite points");
    let mut answer = PairAnswer::default();
    distance([body, triangle.at(place)], &mut PairCache::default(), &PairConfig::default(), &mut answer)
        .expect("accepted poses");
    answer
}

fn check_contacts(
    u: &mut Unstructured,
    (body, ground): (Placed, PlacedGround),
    is_met: bool,
    measured: bool,
    environment: Environment,
) -> Result<()> {
    let mut last = 1.0;
    let max_distance = if u.arbitrary()? { 0.0 } else { any_number(u, &mut last)? };
    let config = ManifoldConfig { max_distance, reduces: u.arbitrary()? };
    let ask = || {
        let mut found = GroundContacts::default();
        ground_contacts(body, ground, &config, &mut found).map(|()| found)
    };
    let found = ask();
    assert_eq!(format!("{:?}", inside(environment, ask)), format!("{found:?}"), "{environment:?}");
    let found = match found {
        Ok(found) => found,
        Err(error) => {
            assert!(matches!(error, Error::Argument(_)) && (max_distance < 0.0 || max_distance.is_nan()), "{error}");
            return Ok(());
        }
    };
    let mut next = 0;
    for contact in &found.contacts {
        let manifold = &contact.manifold;
        assert_eq!(contact.first_point, next, "{contact:?}");
        next += manifold.point_count as usize;
        let points = &found.points[contact.first_point..next];
        assert!(!points.is_empty() && (!config.reduces || points.len() <= 4), "{contact:?}");
        assert!((contact.triangle as usize) < ground.ground.triangle_count(), "{contact:?}");
        assert!(manifold.lower <= manifold.upper && manifold.lower <= max_distance, "{contact:?}");
        // Only what intersects is deep.
        assert!(is_met || manifold.outcome == Outcome::Separated, "{contact:?}");
        let least = points.iter().map(|point| point.gap_lower).fold(f64::INFINITY, f64::min);
        assert!(manifold.lower <= least, "{contact:?}");
        assert!(
            points.iter().all(|point| point.gap_lower <= point.gap_upper && point.gap_lower <= max_distance),
            "{points:?}"
        );
        let normal = Vector::from(manifold.normal);
        assert!(!measured || (normal.norm() - 1.0).abs() < 1e-12, "{contact:?}");
    }
    assert_eq!(next, found.points.len(), "{found:?}");
    let triangles = found.contacts.iter().map(|contact| contact.triangle);
    assert!(triangles.is_sorted(), "{found:?}");
    Ok(())
}

/// Whether all numbers are so far inside the doubles that a normal can be measured in them.
fn is_tame(body: &Body, corners: &[Vector], poses: [&Pose; 2]) -> bool {
    let coordinates = body.points.iter().chain(corners).flatten().copied().chain([body.radius]);
    let places = poses.into_iter().flat_map(|pose| pose.rows.map(|row| row[3]));
    coordinates.chain(places).all(|x| x == 0.0 || (1e-30..1e30).contains(&x.abs()))
}
