//! The inertia tensor of a shape, against textbooks and against integers.

use swiftprox::math::{Matrix, Vector};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::Random;

/// How far an entry may be off, in parts of the largest.
const TOLERANCE: f64 = 1e-13;

fn shape(points: &[Vector]) -> Shape {
    Shape::from_points(points, &ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() }).unwrap()
}

fn check(found: Matrix, expected: Matrix, what: &str) {
    assert!((found - expected).amax() <= TOLERANCE * expected.amax(), "{what}: {found} {expected}");
    assert_eq!(found, found.transpose(), "{what}");
}

#[test]
fn known_bodies_have_the_inertia_of_the_textbook() {
    for half in [[1.0, 1.0, 1.0], [1e6, 1.0, 1.0], [1.0, 1.0, 1e-9], [3.0, 0.5, 2.0]] {
        let corner = |i: usize| Vector::from_fn(|k, _| if i >> k & 1 == 0 { -half[k] } else { half[k] });
        let square = half.map(|h| h * h / 3.0);
        let expected = Vector::new(square[1] + square[2], square[2] + square[0], square[0] + square[1]);
        let body = shape(&(0..8).map(corner).collect::<Vec<_>>());
        check(body.inertia(), Matrix::from_diagonal(&expected), "a box");
    }
    let tetrahedron = shape(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from));
    let expected = Matrix::from_element(1.0 / 80.0) + Matrix::from_diagonal_element(5.0 / 80.0);
    check(tetrahedron.inertia(), expected, "a tetrahedron");
    // Without interior: a square of two sides, a triangle, a segment, a point.
    let square = shape(&[[0.0; 3], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]].map(Vector::from));
    check(square.inertia(), Matrix::from_diagonal(&Vector::new(1.0, 1.0, 2.0)) / 3.0, "a square");
    let segment = shape(&[Vector::new(1.0, 1.0, 1.0), Vector::new(3.0, 1.0, 1.0)]);
    check(segment.inertia(), Matrix::from_diagonal(&Vector::new(0.0, 1.0, 1.0)) / 3.0, "a segment");
    assert_eq!(shape(&[Vector::new(1.0, 2.0, 3.0)]).inertia(), Matrix::zeros());
}

/// 320·V²·E of the hull, V six times its volume and E the mean of x·xᵀ about the centre of mass, and V itself: all integers.
fn exact_covariance(body: &Shape) -> ([[i128; 3]; 3], i128) {
    let polyhedron = body.polyhedron();
    let position = |v: u32| {
        let local = polyhedron.local_position(v);
        [0, 1, 2].map(|k| local[k] as i128)
    };
    let (mut volume, mut first, mut second) = (0, [0; 3], [[0; 3]; 3]);
    for triangle in &polyhedron.triangles {
        let [a, b, c] = triangle.map(position);
        let cross = [0, 1, 2].map(|k| b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3]);
        let weight: i128 = (0..3).map(|k| a[k] * cross[k]).sum();
        volume += weight;
        let sum = [0, 1, 2].map(|k| a[k] + b[k] + c[k]);
        for i in 0..3 {
            first[i] += weight * sum[i];
            for j in 0..3 {
                second[i][j] += weight * (sum[i] * sum[j] + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
            }
        }
    }
    let mean = |i: usize, j: usize| 16 * volume * second[i][j] - 20 * first[i] * first[j];
    ([0, 1, 2].map(|i| [0, 1, 2].map(|j| mean(i, j))), volume)
}

/// Hulls of lattice points, flat and long ones, moved and scaled without rounding.
#[test]
fn it_is_that_of_the_exact_hull() {
    let mut random = Random::new(0x1_1e27);
    for round in 0..60 {
        let sides = [[60.0, 60.0, 60.0], [90.0, 90.0, 1.0], [1.0, 90.0, 2.0]][round % 3];
        let count = 5 + random.below(60);
        let point = |_| Vector::from_fn(|k, _| random.uniform(-sides[k], sides[k]).round());
        let points: Vec<Vector> = (0..count).map(point).collect();
        let body = shape(&points);
        if body.polyhedron().dimension < 3 {
            continue;
        }
        let (scaled, volume) = exact_covariance(&body);
        let unit = 320.0 * (volume as f64).powi(2);
        let covariance = Matrix::from_fn(|i, j| scaled[i][j] as f64 / unit);
        let expected = Matrix::from_diagonal_element(covariance.trace()) - covariance;
        check(body.inertia(), expected, "at the origin");
        for exponent in [-300, 300] {
            let scale = 2.0_f64.powi(exponent);
            let options = ShapeOptions { scale, ..ShapeOptions::default() };
            let body = Shape::from_points(&points, &options).unwrap();
            check(body.inertia() / scale / scale, expected, "very small or large");
        }
        let translation = Vector::new(2.0_f64.powi(40), -(2.0_f64.powi(33)), 12_345_678.0);
        let far = ShapeOptions { translation, ..ShapeOptions::default() };
        check(Shape::from_points(&points, &far).unwrap().inertia(), expected, "far from the origin");
        // Only its vertices are rounded.
        let rotation = random.rotation();
        let turned = Shape::from_points(&points, &ShapeOptions { rotation, ..ShapeOptions::default() }).unwrap();
        let expected = rotation * expected * rotation.transpose();
        assert!((turned.inertia() - expected).amax() <= 1e-12 * expected.amax(), "turned");
    }
}
