//! What grounds are made of, and what they refuse.

use super::{hills, level};
use swiftprox::error::Error;
use swiftprox::ground::{Ground, HeightGrid, ground_distance};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairConfig, Query};
use testkit::random::Random;
use testkit::shapes::{at, cuboid};

/// Memory is what the page says: of a grid, of a soup over shared vertices, and of one in which each triangle has its own.
#[test]
fn triangles_take_few_bytes() {
    let grid = level(101, 101, 1.0);
    assert_eq!((grid.triangle_count(), grid.vertex_count()), (20_000, 10_201));
    assert!(grid.bytes() <= 12 * grid.triangle_count(), "{}", grid.bytes());
    let (vertices, triangles) = hills(&mut Random::new(0x50), 101, 0.1);
    let shared = Ground::from_triangles(&vertices, &triangles).unwrap();
    assert!(shared.bytes() <= 64 * shared.triangle_count(), "{}", shared.bytes());
    let own: Vec<Vector> = triangles.iter().flatten().map(|v| vertices[*v as usize]).collect();
    let corners: Vec<[u32; 3]> = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let soup = Ground::from_triangles(&own, &corners).unwrap();
    assert!(soup.bytes() <= 124 * soup.triangle_count(), "{}", soup.bytes());
    println!("bytes: {} of a grid, {} and {} of soups", grid.bytes(), shared.bytes(), soup.bytes());
}

#[test]
fn refusals_say_what_is_wrong_and_where() {
    let corners = [Vector::zeros(), Vector::x(), Vector::y(), Vector::new(f64::NAN, 0.0, 0.0)];
    let message = |vertices: &[Vector], triangles: &[[u32; 3]]| match Ground::from_triangles(vertices, triangles) {
        Err(Error::Mesh(message)) => message,
        other => panic!("{other:?}"),
    };
    assert!(message(&corners, &[[0, 1, 2]]).contains("vertex 3"));
    assert!(message(&corners[..3], &[[0, 1, 2], [0, 1, 3]]).contains("triangle 1"));
    assert!(message(&corners[..3], &[[0, 1, 1]]).contains("area"));
    assert!(message(&[Vector::zeros(), Vector::x(), Vector::x() * 2.0], &[[0, 1, 2]]).contains("area"));
    assert!(message(&corners[..3], &[]).contains("area"));
    assert!(message(&[Vector::zeros(), Vector::x() * 1e61, Vector::y()], &[[0, 1, 2]]).contains("vertex 1"));
    let grid = |rows, columns, spacing, heights: &[f64]| {
        matches!(Ground::from_heights(&HeightGrid { rows, columns, spacing, heights }), Err(Error::Argument(_)))
    };
    assert!(grid(1, 4, [1.0; 2], &[0.0; 4]) && grid(2, 2, [1.0; 2], &[0.0; 3]));
    assert!(grid(2, 2, [0.0, 1.0], &[0.0; 4]) && grid(2, 2, [1.0, f64::NAN], &[0.0; 4]));
    assert!(grid(2, 2, [f64::MIN_POSITIVE, 1.0], &[0.0; 4]) && grid(2, 2, [1.0, f64::INFINITY], &[0.0; 4]));
    assert!(grid(usize::MAX, 3, [1.0; 2], &[0.0; 4]));
    let message =
        |spacing, heights: &[f64]| match Ground::from_heights(&HeightGrid { rows: 2, columns: 3, spacing, heights }) {
            Err(Error::Mesh(message)) => message,
            other => panic!("{other:?}"),
        };
    assert!(message([1e60, 1.0], &[0.0; 6]).contains("column 2"));
    assert!(message([1.0; 2], &[0.0, 0.0, 0.0, 0.0, f64::INFINITY, 0.0]).contains("vertex 4"));
    assert!(message([1.0; 2], &[0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0]).contains("2 cells"));
}

/// Through a hole a body falls; numbers of triangles are those of a grid without holes.
#[test]
fn a_cell_with_a_hole_at_a_corner_is_a_hole() {
    let mut heights = [0.0; 16];
    heights[0] = f64::NAN;
    let ground =
        Ground::from_heights(&HeightGrid { rows: 4, columns: 4, spacing: [1.0, 2.0], heights: &heights }).unwrap();
    let cube = cuboid([0.125; 3]);
    let ask = |pose: &Pose| {
        ground_distance(Query::Distance, cube.at(pose), ground.at(&Pose::IDENTITY), &PairConfig::default()).unwrap()
    };
    let above_hole = ask(&at(0.5, 1.0, 0.0));
    assert_eq!((above_hole.answer.outcome, above_hole.answer.distance), (Outcome::Separated, 0.375));
    // Cell 4, the middle one: its triangle that has the corner along x.
    let above_ground = ask(&at(1.75, 2.5, 0.5));
    assert_eq!((above_ground.triangle, above_ground.answer.distance), (8, 0.375));
    assert_eq!((ground.triangle_count(), ground.vertex_count()), (18, 16));
}
