//! Models: convex polyhedra as polygon meshes, outward faces counter-clockwise.

use swiftprox::body::build::hull::convex_hull;
use swiftprox::error::Result;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use super::random::Random;

/// The three ellipsoids of Ehmann & Lin (2000), section 6: their names and half axes.
pub const ELLIPSOIDS: [(&str, [f64; 3]); 3] =
    [("fat", [1.0, 1.0, 1.0]), ("plate", [1.0, 1.0, 0.1]), ("long", [1.0, 0.1, 0.1])];

/// Hull of `n` random points on an ellipsoid, its centre of mass at the origin, its bounding radius 1.
pub fn ellipsoid(half_axes: [f64; 3], n: usize) -> Result<PolygonMesh> {
    let seed = half_axes.iter().fold(n as u64, |seed, a| seed.rotate_left(21) ^ a.to_bits());
    let mut random = Random::new(seed);
    let half_axes = Vector::from(half_axes);
    let points: Vec<Vector> = (0..n).map(|_| random.direction().component_mul(&half_axes)).collect();
    Ok(normalised(hull_mesh(&points)?))
}

/// A closed triangle mesh with its centre of mass at the origin and a bounding radius of 1.
pub fn normalised(mut mesh: PolygonMesh) -> PolygonMesh {
    let centre = centre_of_mass(&mesh);
    let radius = mesh.vertices.iter().map(|v| (v - centre).norm()).fold(0.0, f64::max);
    for v in &mut mesh.vertices {
        *v = (*v - centre) / radius;
    }
    mesh
}

/// Hull of `n` random points in the unit ball: vertices of very different valence and edges of very different length.
pub fn random_hull(n: usize, seed: u64) -> Result<PolygonMesh> {
    let mut random = Random::new(seed);
    let points: Vec<Vector> = (0..n).map(|_| random.direction() * random.uniform(0.0, 1.0).cbrt()).collect();
    hull_mesh(&points)
}

/// Points spread evenly over the unit sphere, along Fibonacci's spiral (R. Swinbank, R. J. Purser, "Fibonacci grids", 2006).
pub fn spiral(count: usize) -> Vec<Vector> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let point = |k: usize| {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let (sin, cos) = (golden_angle * k as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector::new(r * cos, r * sin, z)
    };
    (0..count).map(point).collect()
}

/// A box around the origin, six quadrilaterals.
pub fn cuboid(half_extents: [f64; 3]) -> Result<PolygonMesh> {
    let [x, y, z] = half_extents;
    let corner = |i: usize| {
        let side = |bit: usize, h: f64| if i & bit == 0 { -h } else { h };
        Vector::new(side(1, x), side(2, y), side(4, z))
    };
    let faces = [0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6];
    PolygonMesh::new((0..8).map(corner).collect(), faces.to_vec(), Some(&[4; 6]))
}

/// A grid of (n + 1)² points on each side of a cube, shared points repeated.
pub fn grid_on_cube(n: usize) -> Vec<Vector> {
    let at = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
    let mut points = Vec::new();
    for axis in 0..3 {
        for i in 0..=n {
            for j in 0..=n {
                for level in [-1.0, 1.0] {
                    let mut p = Vector::zeros();
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (level, at(i), at(j));
                    points.push(p);
                }
            }
        }
    }
    points
}

/// A right prism around the z axis over a regular polygon of `sides` corners on the unit circle.
pub fn prism(sides: u32, half_height: f64) -> Result<PolygonMesh> {
    let corner = |i: u32| on_circle(i, sides, if i < sides { -half_height } else { half_height });
    let mut indices: Vec<u32> = (0..sides).rev().chain(sides..2 * sides).collect();
    let mut valences = vec![sides; 2];
    for i in 0..sides {
        let next = (i + 1) % sides;
        indices.extend([i, next, sides + next, sides + i]);
        valences.push(4);
    }
    PolygonMesh::new((0..2 * sides).map(corner).collect(), indices, Some(&valences))
}

/// A cone over a regular polygon of `sides` corners on the unit circle, which is one face; its apex is on the z axis.
pub fn cone(sides: u32, height: f64) -> Result<PolygonMesh> {
    let mut vertices: Vec<Vector> = (0..sides).map(|i| on_circle(i, sides, 0.0)).collect();
    vertices.push(Vector::new(0.0, 0.0, height));
    let mut indices: Vec<u32> = (0..sides).rev().collect();
    let mut valences = vec![sides];
    for i in 0..sides {
        indices.extend([i, (i + 1) % sides, sides]);
        valences.push(3);
    }
    PolygonMesh::new(vertices, indices, Some(&valences))
}

/// Two cones on one rim: two vertices with `sides` neighbours each.
pub fn bipyramid(sides: u32, height: f64) -> Result<PolygonMesh> {
    let mut vertices: Vec<Vector> = (0..sides).map(|i| on_circle(i, sides, 0.0)).collect();
    vertices.extend([Vector::new(0.0, 0.0, height), Vector::new(0.0, 0.0, -height)]);
    let around = |i: u32| [i, (i + 1) % sides, sides, (i + 1) % sides, i, sides + 1];
    PolygonMesh::new(vertices, (0..sides).flat_map(around).collect(), None)
}

/// Two regular polygons of `sides` corners, one turned by half a side, joined by triangles.
pub fn antiprism(sides: u32, half_height: f64) -> Result<PolygonMesh> {
    let lower = (0..sides).map(|i| on_circle(2 * i, 2 * sides, -half_height));
    let upper = (0..sides).map(|i| on_circle(2 * i + 1, 2 * sides, half_height));
    let mut indices: Vec<u32> = (0..sides).rev().chain(sides..2 * sides).collect();
    let mut valences = vec![sides; 2];
    for i in 0..sides {
        let next = (i + 1) % sides;
        indices.extend([i, next, sides + i, next, sides + next, sides + i]);
        valences.extend([3, 3]);
    }
    PolygonMesh::new(lower.chain(upper).collect(), indices, Some(&valences))
}

/// The dual of an antiprism: two vertices in which `sides` kites meet each, quadrilaterals that rounding leaves not quite plane.
pub fn trapezohedron(sides: u32, height: f64) -> Result<PolygonMesh> {
    let half_angle = std::f64::consts::PI / f64::from(2 * sides);
    let rise = height * half_angle.tan().powi(2);
    let mut vertices: Vec<Vector> =
        (0..2 * sides).map(|i| on_circle(i, 2 * sides, if i % 2 == 0 { rise } else { -rise })).collect();
    vertices.extend([Vector::new(0.0, 0.0, height), Vector::new(0.0, 0.0, -height)]);
    let (top, bottom) = (2 * sides, 2 * sides + 1);
    let around = |i: u32| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| (2 * i + k) % (2 * sides));
        [top, a, b, c, bottom, d, c, b]
    };
    PolygonMesh::new(vertices, (0..sides).flat_map(around).collect(), Some(&vec![4; 2 * sides as usize]))
}

/// The hull of `n` points (t, t², t³), t in [−1, 1]: a cyclic polytope, whose ends have all vertices for neighbours.
pub fn moment_curve(n: usize) -> Result<PolygonMesh> {
    let point = |i: usize| {
        let t = 2.0 * i as f64 / (n - 1) as f64 - 1.0;
        Vector::new(t, t * t, t * t * t)
    };
    hull_mesh(&(0..n).map(point).collect::<Vec<_>>())
}

/// Corner `i` of a regular polygon on the unit circle at height z.
pub(crate) fn on_circle(i: u32, sides: u32, z: f64) -> Vector {
    let angle = std::f64::consts::TAU * f64::from(i % sides) / f64::from(sides);
    Vector::new(angle.cos(), angle.sin(), z)
}

/// The hull of points as a mesh over the hull's own vertices.
pub fn hull_mesh(points: &[Vector]) -> Result<PolygonMesh> {
    let hull = convex_hull(points)?;
    let mut own = vec![0; points.len()];
    for (new, &old) in (0..).zip(&hull.vertices) {
        own[old as usize] = new;
    }
    let vertices = hull.vertices.iter().map(|&i| points[i as usize]).collect();
    let indices = hull.triangles.iter().flatten().map(|&i| own[i as usize]).collect();
    PolygonMesh::new(vertices, indices, None)
}

/// The volume centre of mass of a closed triangle mesh: the sum over the tetrahedra with the origin.
fn centre_of_mass(mesh: &PolygonMesh) -> Vector {
    let (mut volume, mut moment) = (0.0, Vector::zeros());
    for f in 0..mesh.face_count() {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[mesh.face(f)[k] as usize]);
        let sixfold = a.dot(&b.cross(&c));
        volume += sixfold;
        moment += (a + b + c) * (sixfold / 4.0);
    }
    moment / volume
}
