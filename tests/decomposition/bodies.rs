//! Bodies that are not convex, and surfaces without inside.

use std::f64::consts::TAU;

use swiftprox::math::{Matrix, Vector};
use swiftprox::mesh::PolygonMesh;
use testkit::models::cuboid;
use testkit::random::{Random, rotation};

pub type Named = (&'static str, PolygonMesh);

/// A right prism over a polygon that runs counter-clockwise: its caps are one face each.
pub fn extruded(polygon: &[[f64; 2]], half_height: f64) -> PolygonMesh {
    let count = polygon.len() as u32;
    let mut mesh = PolygonMesh::default();
    for z in [-half_height, half_height] {
        polygon.iter().for_each(|[x, y]| mesh.push_vertex(Vector::new(*x, *y, z)).unwrap());
    }
    mesh.push_face(&(0..count).rev().collect::<Vec<_>>()).unwrap();
    mesh.push_face(&(count..2 * count).collect::<Vec<_>>()).unwrap();
    for i in 0..count {
        let next = (i + 1) % count;
        mesh.push_face(&[i, next, count + next, count + i]).unwrap();
    }
    mesh
}

/// 2 long in x and y, 1 thick; the notch is x > 1, y > 1.
pub fn l_shape() -> PolygonMesh {
    extruded(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 0.5)
}

/// Corners on two circles by turns, `repeats` at a time.
pub fn toothed(count: usize, repeats: usize, inner: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (angle, radius) =
            (TAU * i as f64 / count as f64, if (i / repeats).is_multiple_of(2) { 1.0 } else { inner });
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(corner).collect()
}

pub fn torus(around: u32, across: u32) -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    let angle = |i: u32, count: u32| TAU * f64::from(i) / f64::from(count);
    for i in 0..around {
        for j in 0..across {
            let (a, b) = (angle(i, around), angle(j, across));
            let radius = 1.0 + 0.4 * b.cos();
            mesh.push_vertex(Vector::new(radius * a.cos(), radius * a.sin(), 0.4 * b.sin())).unwrap();
        }
    }
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    for (i, j) in (0..around).flat_map(|i| (0..across).map(move |j| (i, j))) {
        mesh.push_face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]).unwrap();
        mesh.push_face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]).unwrap();
    }
    mesh
}

/// Heights over a grid, above 0.
pub fn terrain(cells: u32, seed: u64) -> PolygonMesh {
    let mut random = Random::new(seed);
    let mut mesh = PolygonMesh::default();
    for (i, j) in (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j))) {
        let step = 2.0 / f64::from(cells);
        let height = random.uniform(0.2, 0.8);
        mesh.push_vertex(Vector::new(step * f64::from(i) - 1.0, step * f64::from(j) - 1.0, height)).unwrap();
    }
    let at = |i: u32, j: u32| i * (cells + 1) + j;
    for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
        mesh.push_face(&[at(i, j), at(i + 1, j), at(i + 1, j + 1)]).unwrap();
        mesh.push_face(&[at(i, j), at(i + 1, j + 1), at(i, j + 1)]).unwrap();
    }
    mesh
}

/// A terrain with walls down to z = 0 and a floor of one face.
pub fn closed_terrain(cells: u32, seed: u64) -> PolygonMesh {
    let mut mesh = terrain(cells, seed);
    let at = |i: u32, j: u32| i * (cells + 1) + j;
    // Around the border, counter-clockwise seen from above.
    let sides = [
        (0..cells).map(|i| at(i, 0)).collect::<Vec<_>>(),
        (0..cells).map(|j| at(cells, j)).collect(),
        (0..cells).map(|i| at(cells - i, cells)).collect(),
        (0..cells).map(|j| at(0, cells - j)).collect(),
    ];
    let border = sides.concat();
    let first = mesh.vertices.len() as u32;
    for v in &border {
        let Vector { data, .. } = mesh.vertices[*v as usize];
        mesh.push_vertex(Vector::new(data.0[0][0], data.0[0][1], 0.0)).unwrap();
    }
    let count = border.len() as u32;
    for i in 0..count {
        let next = (i + 1) % count;
        mesh.push_face(&[first + i, first + next, border[next as usize], border[i as usize]]).unwrap();
    }
    mesh.push_face(&(0..count).rev().map(|i| first + i).collect::<Vec<_>>()).unwrap();
    mesh
}

/// All meshes as one.
pub fn together(meshes: &[PolygonMesh]) -> PolygonMesh {
    let mut all = PolygonMesh::default();
    for mesh in meshes {
        let first = all.vertices.len() as u32;
        mesh.vertices.iter().for_each(|v| all.push_vertex(*v).unwrap());
        for f in 0..mesh.face_count() {
            all.push_face(&mesh.face(f).iter().map(|v| first + v).collect::<Vec<_>>()).unwrap();
        }
    }
    all
}

/// Every face the other way round.
pub fn turned_round(mesh: &PolygonMesh) -> PolygonMesh {
    let mut turned = mesh.clone();
    turned.starts.windows(2).for_each(|ends| turned.indices[ends[0] as usize..ends[1] as usize].reverse());
    turned
}

pub fn moved(mesh: &PolygonMesh, rotation: &Matrix, by: Vector) -> PolygonMesh {
    let mut moved = mesh.clone();
    moved.vertices.iter_mut().for_each(|v| *v = rotation * *v + by);
    moved
}

/// As it comes out of a program that turned it: plane faces are plane up to rounding.
pub fn turned(mesh: &PolygonMesh) -> PolygonMesh {
    moved(mesh, &rotation(&Vector::new(0.48, -0.6, 0.64), 0.7), Vector::zeros())
}

/// Bodies: closed, with an inside.
pub fn bodies() -> Vec<Named> {
    let hollow = [cuboid([1.0; 3]).unwrap(), turned_round(&cuboid([0.5; 3]).unwrap())];
    let apart = [l_shape(), moved(&l_shape(), &Matrix::identity(), Vector::new(4.0, 0.0, 0.0))];
    // A block with a slot from above as deep as half of it.
    let slot = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.2, 1.0], [0.2, 0.0], [-0.2, 0.0], [-0.2, 1.0], [-1.0, 1.0]];
    vec![
        ("cuboid", cuboid([1.0, 0.5, 0.25]).unwrap()),
        ("L", l_shape()),
        ("slot", extruded(&slot, 0.3)),
        ("star", extruded(&toothed(10, 1, 0.4), 0.3)),
        ("gear", extruded(&toothed(24, 2, 0.8), 0.2)),
        ("turned gear", turned(&extruded(&toothed(24, 2, 0.8), 0.2))),
        ("torus", torus(9, 6)),
        ("hollow", together(&hollow)),
        ("two Ls", together(&apart)),
        ("terrain 1", closed_terrain(4, 1)),
        ("terrain 2", closed_terrain(5, 2)),
        ("terrain 3", turned(&closed_terrain(4, 3))),
    ]
}

/// Surfaces without inside.
pub fn sheets() -> Vec<Named> {
    let mut bowl = turned(&cuboid([1.0, 1.0, 0.5]).unwrap());
    bowl.starts.pop();
    bowl.indices.truncate(*bowl.starts.last().unwrap() as usize);
    let mut flat = terrain(3, 0);
    flat.vertices.iter_mut().for_each(|v| v.z = 0.0);
    // Two-sided, and not convex.
    let polygon = l_shape();
    let mut leaf = PolygonMesh::default();
    polygon.vertices[..6].iter().for_each(|v| leaf.push_vertex(*v).unwrap());
    leaf.push_face(&[0, 1, 2, 3, 4, 5]).unwrap();
    leaf.push_face(&[5, 4, 3, 2, 1, 0]).unwrap();
    vec![
        ("bowl", bowl),
        ("grid", flat),
        ("leaf", leaf),
        ("open terrain", terrain(4, 4)),
        ("turned open terrain", turned(&terrain(4, 5))),
    ]
}
