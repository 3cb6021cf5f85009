//! Bodies to make levels of: round and flat, thin and long, smooth and sharp.

use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use testkit::models::{ELLIPSOIDS, cuboid, ellipsoid, prism, random_hull};
use testkit::random::Random;

pub fn polyhedron(mesh: &PolygonMesh) -> Polyhedron {
    build(&mesh.vertices, None).unwrap()
}

/// A circular cone around the z axis.
fn cone(sides: u32, radius: f64, height: f64) -> Vec<Vector> {
    let corner = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(sides);
        Vector::new(radius * angle.cos(), radius * angle.sin(), 0.0)
    };
    (0..sides).map(corner).chain([Vector::new(0.0, 0.0, height)]).collect()
}

/// Names and bodies; the ellipsoids with the given numbers of vertices.
pub fn bodies(counts: &[usize]) -> Vec<(String, Polyhedron)> {
    let mut all = Vec::new();
    for (name, half_axes) in ELLIPSOIDS {
        for &n in counts {
            all.push((format!("{name} {n}"), polyhedron(&ellipsoid(half_axes, n).unwrap())));
        }
    }
    let mut add = |name: &str, points: &[Vector]| all.push((name.to_string(), build(points, None).unwrap()));
    let scaled = |mesh: PolygonMesh, by: [f64; 3]| -> Vec<Vector> {
        mesh.vertices.iter().map(|v| v.component_mul(&Vector::from(by))).collect()
    };
    add("box", &cuboid([1.0, 2.0, 3.0]).unwrap().vertices);
    add("tetrahedron", &[Vector::zeros(), Vector::x(), Vector::y(), Vector::z()]);
    add("prism 64", &prism(64, 0.5).unwrap().vertices);
    add("prism 300, flat", &prism(300, 0.01).unwrap().vertices);
    add("cone 100", &cone(100, 1.0, 2.0));
    add("cone 200, shallow", &cone(200, 1.0, 0.05));
    add("needle 1e4", &scaled(ellipsoid([1.0, 1.0, 1.0], 300).unwrap(), [1.0, 1e-4, 1e-4]));
    add("wafer 1e-4", &scaled(ellipsoid([1.0, 1.0, 1.0], 300).unwrap(), [1.0, 1.0, 1e-4]));
    add("wafer 1e-7", &scaled(ellipsoid([1.0, 1.0, 1.0], 300).unwrap(), [1.0, 1.0, 1e-7]));
    for n in [20, 200, 2000] {
        add(&format!("random hull of {n}"), &random_hull(n, n as u64).unwrap().vertices);
    }
    // Few of the vertices of points in a cube are removable, and those near the faces nearly flat.
    let mut random = Random::new(5);
    let mut in_cube = || Vector::from_fn(|_, _| random.uniform(-1.0, 1.0));
    let points: Vec<Vector> = (0..1000).map(|_| in_cube()).collect();
    add("points in a cube", &points);
    // Vertices on a grid: many are coplanar.
    let rounded: Vec<Vector> =
        ellipsoid([1.0, 1.0, 1.0], 500).unwrap().vertices.iter().map(|v| (v * 16.0).map(f64::round)).collect();
    add("on a grid", &rounded);
    // Far from its own origin, small, large.
    let fat = ellipsoid([1.0, 1.0, 0.3], 200).unwrap().vertices;
    let moved: Vec<Vector> = fat.iter().map(|v| v + Vector::new(1e9, -3e8, 5.0)).collect();
    add("far out", &moved);
    add("beside its origin", &fat.iter().map(|v| v + Vector::new(1.8, 0.0, 0.0)).collect::<Vec<_>>());
    add("small", &fat.iter().map(|v| v * 1e-30).collect::<Vec<_>>());
    add("large", &fat.iter().map(|v| v * 1e30).collect::<Vec<_>>());
    all
}
