//! Bodies: with faces where coplanar ones are to stay apart, as points elsewhere.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use crate::models;
use crate::random::Random;

/// The hull of points.
pub fn hull_of(points: Vec<Vector>) -> PolygonMesh {
    PolygonMesh::new(points, Vec::new(), None).expect("finite points")
}

pub fn cuboid(half: [f64; 3]) -> PolygonMesh {
    models::cuboid(half).expect("a box")
}

/// A box with half extents of a few eighths.
pub fn dyadic_box(random: &mut Random) -> PolygonMesh {
    cuboid([(); 3].map(|()| (2 + random.below(7)) as f64 / 8.0))
}

/// A right prism over a regular polygon: with many sides a cylinder about z.
pub fn cylinder(sides: usize, radius: f64, half_height: f64) -> PolygonMesh {
    scaled(models::prism(sides as u32, 1.0).expect("a prism"), [radius, radius, half_height])
}

/// `count` random points of the unit ball.
pub fn cloud(random: &mut Random, count: usize) -> PolygonMesh {
    hull_of((0..count).map(|_| random.direction() * random.uniform(0.0, 1.0).cbrt()).collect())
}

/// `count` random points of the unit sphere, all of them vertices.
pub fn sphere(random: &mut Random, count: usize) -> PolygonMesh {
    hull_of((0..count).map(|_| random.direction()).collect())
}

/// The five regular solids, about the origin: tetrahedron, cube, octahedron, icosahedron, dodecahedron.
pub fn regular_solid(kind: usize) -> PolygonMesh {
    let golden = 0.5 + 1.25f64.sqrt();
    let cyclic = |a: f64, b: f64| {
        let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
        signs.into_iter().flat_map(move |(s, t)| {
            [Vector::new(0.0, s * a, t * b), Vector::new(t * b, 0.0, s * a), Vector::new(s * a, t * b, 0.0)]
        })
    };
    match kind % 5 {
        0 => hull_of([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]].map(|p| Vector::from(p.map(f64::from))).into()),
        1 => cuboid([1.0; 3]),
        2 => hull_of((0..6).map(|i| Vector::ith(i / 2, if i % 2 == 0 { 1.0 } else { -1.0 })).collect()),
        3 => hull_of(cyclic(1.0, golden).collect()),
        _ => hull_of(cuboid([1.0; 3]).vertices.into_iter().chain(cyclic(1.0 / golden, golden)).collect()),
    }
}

/// A box whose sides are grids of `cells`² squares, each cut into two triangles: flat edges, vertices inside faces and edges.
pub fn grid_box(half: [f64; 3], cells: usize) -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    let mut known: BTreeMap<[usize; 3], u32> = BTreeMap::new();
    for axis in 0..3 {
        for end in [0, cells] {
            let mut corner = |i: usize, j: usize| {
                let mut place = [end; 3];
                place[(axis + 1) % 3] = i;
                place[(axis + 2) % 3] = j;
                *known.entry(place).or_insert_with(|| {
                    let along = |k: usize| half[k] * (2.0 * place[k] as f64 / cells as f64 - 1.0);
                    mesh.vertices.push(Vector::new(along(0), along(1), along(2)));
                    mesh.vertices.len() as u32 - 1
                })
            };
            let mut triangles = Vec::new();
            for i in 0..cells {
                for j in 0..cells {
                    let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
            for [a, b, c] in triangles {
                mesh.push_face(&if end == 0 { [a, c, b] } else { [a, b, c] }).expect("known corners");
            }
        }
    }
    mesh
}

/// A prism whose two caps are fans about a vertex in their middle: valence `sides` on flat ground.
pub fn fan_prism(sides: usize, half_height: f64) -> PolygonMesh {
    let ring = |z: f64| (0..sides).map(move |i| on_circle(i, sides, z));
    let mut mesh = hull_of(ring(-half_height).chain(ring(half_height)).collect());
    mesh.vertices.extend([Vector::new(0.0, 0.0, -half_height), Vector::new(0.0, 0.0, half_height)]);
    let [bottom, top] = [2 * sides, 2 * sides + 1];
    for i in 0..sides {
        let next = (i + 1) % sides;
        push(&mut mesh, &[bottom, next, i]);
        push(&mut mesh, &[top, sides + i, sides + next]);
        push(&mut mesh, &[i, next, sides + next, sides + i]);
    }
    mesh
}

/// Two cones over a polygon, base to base: two vertices of valence `sides`. With one height 0 the base is a cap of as many
/// corners.
pub fn double_cone(sides: usize, up: f64, down: f64) -> PolygonMesh {
    let mut mesh = hull_of((0..sides).map(|i| on_circle(i, sides, 0.0)).collect());
    let top = mesh.vertices.len();
    mesh.vertices.push(Vector::new(0.0, 0.0, up));
    (0..sides).for_each(|i| push(&mut mesh, &[i, (i + 1) % sides, top]));
    if down > 0.0 {
        mesh.vertices.push(Vector::new(0.0, 0.0, -down));
        (0..sides).for_each(|i| push(&mut mesh, &[(i + 1) % sides, i, top + 1]));
    } else {
        push(&mut mesh, &(0..sides).rev().collect::<Vec<_>>());
    }
    mesh
}

/// A dome of (2·`rings` + 1)² points of z = −flatness·(x² + y²) over a box: neighbouring faces nearly coplanar.
pub fn dome(rings: usize, flatness: f64) -> PolygonMesh {
    let coordinate = |i: usize| i as f64 / rings as f64 - 1.0;
    let over = (0..=2 * rings).flat_map(|i| (0..=2 * rings).map(move |j| (coordinate(i), coordinate(j))));
    let mut points: Vec<Vector> = over.map(|(x, y)| Vector::new(x, y, -flatness * (x * x + y * y))).collect();
    points.extend([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| Vector::new(x, y, -1.0)));
    hull_of(points)
}

/// A roof with its ridge on the x axis, from −1 to 1, over a square 1 below.
pub fn roof() -> PolygonMesh {
    let base = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)].map(|(x, y)| Vector::new(x, y, -1.0));
    hull_of([Vector::new(-1.0, 0.0, 0.0), Vector::new(1.0, 0.0, 0.0)].into_iter().chain(base).collect())
}

/// Coordinates times factors, which keep the orientation.
pub fn scaled(mut mesh: PolygonMesh, factors: [f64; 3]) -> PolygonMesh {
    let factors = Vector::from(factors);
    mesh.vertices.iter_mut().for_each(|v| *v = v.component_mul(&factors));
    mesh
}

pub fn shifted(mut mesh: PolygonMesh, by: &Vector) -> PolygonMesh {
    mesh.vertices.iter_mut().for_each(|v| *v += by);
    mesh
}

/// Everyday bodies of size 1, from 4 to some hundred vertices.
pub fn ordinary(random: &mut Random) -> PolygonMesh {
    match random.below(8) {
        0 => dyadic_box(random),
        1 => regular_solid(random.below(5)),
        2 => cylinder(3 + random.below(40), 1.0, random.uniform(0.1, 1.0)),
        3 => grid_box([1.0, 0.75, 0.5], 1 + random.below(6)),
        4 => cloud(random, 4),
        5 => {
            let count = 5 + random.below(30);
            cloud(random, count)
        }
        6 => {
            let count = 40 + random.below(120);
            sphere(random, count)
        }
        _ => double_cone(3 + random.below(30), 0.5, 0.75),
    }
}

fn on_circle(i: usize, sides: usize, z: f64) -> Vector {
    let angle = TAU * i as f64 / sides as f64;
    Vector::new(angle.cos(), angle.sin(), z)
}

fn push(mesh: &mut PolygonMesh, corners: &[usize]) {
    let corners: Vec<u32> = corners.iter().map(|&c| c as u32).collect();
    mesh.push_face(&corners).expect("known corners");
}
