//! Bodies as CAD systems and game engines have them: boxes, prisms, bodies of revolution. Their large faces, rims and hubs are what
//! random ellipsoids lack. All have their centre of mass at the origin and a bounding radius of 1.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use swiftprox::error::Result;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;

use crate::models::{cuboid, hull_mesh, normalised, on_circle};
use crate::random::rotation;

/// A body and its name.
pub struct Solid {
    pub name: &'static str,
    points: fn() -> Vec<Vector>,
}

/// How a body came to its coordinates and faces. All but the first are triangulated hulls: what a program that exports triangles
/// hands over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// As [`Form::Plain`], each plane face one polygon.
    Polygons,
    /// Around the z axis, where caps and mantles are exactly plane.
    Plain,
    /// Turned, in doubles: they are plane up to rounding.
    Turned,
    /// Turned and rounded to single precision: what was plane is many slightly bent faces.
    Single,
    /// Turned and rounded to six decimals.
    Decimals,
}

impl Form {
    pub const ALL: [(&'static str, Form); 5] = [
        ("polygons", Form::Polygons),
        ("plain", Form::Plain),
        ("turned", Form::Turned),
        ("single", Form::Single),
        ("decimals", Form::Decimals),
    ];

    fn apply(self, point: &Vector) -> Vector {
        if matches!(self, Form::Plain | Form::Polygons) {
            return *point;
        }
        let turned = rotation(&Vector::new(0.48, -0.6, 0.64), 0.7) * point;
        match self {
            Form::Single => turned.map(|x| f64::from(x as f32)),
            Form::Decimals => turned.map(|x| (x * 1e6).round() / 1e6),
            Form::Polygons | Form::Plain | Form::Turned => turned,
        }
    }
}

impl Solid {
    /// The body as a mesh.
    pub fn mesh(&self, form: Form) -> Result<PolygonMesh> {
        let plain = normalised(hull_mesh(&(self.points)())?);
        let points: Vec<Vector> = plain.vertices.iter().map(|point| form.apply(point)).collect();
        let triangles = hull_mesh(&points)?;
        if form == Form::Polygons { with_polygons(&triangles) } else { Ok(triangles) }
    }
}

/// Normals of triangles that differ by less are those of one plane: rounding turns them by some 1e-15 over the length of an edge.
const PLANE: f64 = 1e-9;

/// The same body, triangles of one plane joined to a polygon.
fn with_polygons(mesh: &PolygonMesh) -> Result<PolygonMesh> {
    let normal = |f: usize| {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.vertices[mesh.face(f)[k] as usize]);
        (b - a).cross(&(c - a)).normalize()
    };
    let mut planes: Vec<(Vector, Vec<usize>)> = Vec::new();
    for f in 0..mesh.face_count() {
        let n = normal(f);
        // A convex body has one face to a normal.
        match planes.iter_mut().find(|(plane, _)| (*plane - n).norm() < PLANE) {
            Some((_, faces)) => faces.push(f),
            None => planes.push((n, vec![f])),
        }
    }
    let (mut indices, mut valences) = (Vec::new(), Vec::new());
    for (_, faces) in planes {
        let edges = faces.iter().flat_map(|&f| [0, 1, 2].map(|k| (mesh.face(f)[k], mesh.face(f)[(k + 1) % 3])));
        let all: BTreeSet<(u32, u32)> = edges.collect();
        // Of the edges that two triangles share none is left; each of the others leads to the next corner.
        let next: BTreeMap<u32, u32> = all.iter().filter(|(a, b)| !all.contains(&(*b, *a))).copied().collect();
        let first = *next.keys().next().expect("triangles have a border");
        let around = std::iter::successors(Some(first), |at| next.get(at).copied().filter(|&to| to != first));
        indices.extend(around);
        valences.push(next.len() as u32);
    }
    PolygonMesh::new(mesh.vertices.clone(), indices, Some(&valences))
}

/// In the order of tables.
pub const SOLIDS: [Solid; 25] = [
    Solid { name: "box", points: || block([1.0, 0.8, 0.6]) },
    Solid { name: "plank", points: || block([1.0, 0.3, 0.05]) },
    Solid { name: "wedge", points: || revolved(3, &[[1.0, -0.5], [1.0, 0.5]]) },
    Solid { name: "cylinder-16", points: || cylinder(16, 1.0) },
    Solid { name: "cylinder-64", points: || cylinder(64, 1.0) },
    Solid { name: "cylinder-200", points: || cylinder(200, 1.0) },
    Solid { name: "cylinder-500", points: || cylinder(500, 1.0) },
    Solid { name: "cylinder-1000", points: || cylinder(1000, 1.0) },
    Solid { name: "disc-64", points: || cylinder(64, 0.05) },
    Solid { name: "disc-500", points: || cylinder(500, 0.05) },
    Solid { name: "rod-16", points: || cylinder(16, 10.0) },
    Solid { name: "rod-64", points: || cylinder(64, 10.0) },
    Solid { name: "cone-32", points: || revolved(32, &[[1.0, 0.0], [0.0, 2.0]]) },
    Solid { name: "cone-200", points: || revolved(200, &[[1.0, 0.0], [0.0, 2.0]]) },
    Solid { name: "frustum-64", points: || revolved(64, &[[1.0, 0.0], [0.6, 1.5]]) },
    Solid { name: "capsule", points: || revolved(24, &arcs(8, 1.0, 1.0)) },
    Solid { name: "sphere", points: || revolved(32, &arcs(16, 1.0, 0.0)) },
    Solid { name: "half-sphere", points: || revolved(48, &arcs(24, 1.0, 0.0)[..13]) },
    Solid { name: "lens", points: || revolved(64, &arcs(12, 0.2, 0.0)) },
    Solid { name: "torus-hull", points: || revolved(64, &torus()) },
    Solid { name: "rounded-box", points: rounded_box },
    Solid { name: "gear", points: || gear(24) },
    Solid { name: "hexagon-nut", points: || cylinder(6, 0.8) },
    Solid { name: "pipe-fitting", points: || revolved(40, &[[0.5, -1.0], [0.5, -0.4], [1.0, 0.0], [0.7, 0.6]]) },
    Solid { name: "pyramid", points: || revolved(4, &[[1.0, 0.0], [0.0, 1.2]]) },
];

fn block(half_extents: [f64; 3]) -> Vec<Vector> {
    cuboid(half_extents).map_or(Vec::new(), |mesh| mesh.vertices)
}

/// Of radius 1.
fn cylinder(sides: u32, height: f64) -> Vec<Vector> {
    revolved(sides, &[[1.0, -0.5 * height], [1.0, 0.5 * height]])
}

/// Points on rings around the z axis, each given by its radius and height; one of radius 0 is a point.
fn revolved(sides: u32, rings: &[[f64; 2]]) -> Vec<Vector> {
    let ring = |&[radius, z]: &[f64; 2]| {
        let count = if radius == 0.0 { 1 } else { sides };
        (0..count).map(move |i| on_circle(i, sides, 0.0) * radius + Vector::new(0.0, 0.0, z))
    };
    rings.iter().flat_map(ring).collect()
}

/// Rings from pole to pole of a half circle, stretched along the axis, its halves drawn apart by `cylinder`.
fn arcs(steps: u32, stretch: f64, cylinder: f64) -> Vec<[f64; 2]> {
    let ring = |i: u32| {
        let latitude = PI * (f64::from(i) / f64::from(steps) - 0.5);
        let radius = if i == 0 || i == steps { 0.0 } else { latitude.cos() };
        let z = stretch * latitude.sin();
        [radius, if cylinder > 0.0 && 2 * i == steps { 0.0 } else { z + cylinder.copysign(z) }]
    };
    let mut rings: Vec<[f64; 2]> = (0..=steps).map(ring).collect();
    if cylinder > 0.0 {
        // The equator is two rings.
        rings[(steps / 2) as usize] = [1.0, cylinder];
        rings.insert((steps / 2) as usize, [1.0, -cylinder]);
    }
    rings
}

/// The outer half of a tube of radius 0.3 around a circle.
fn torus() -> Vec<[f64; 2]> {
    let ring = |i: i32| {
        let angle = FRAC_PI_2 * f64::from(i) / 4.0;
        [0.7 + 0.3 * angle.cos(), 0.3 * angle.sin()]
    };
    (-4..=4).map(ring).collect()
}

/// An eighth of a small sphere at each corner of a box.
fn rounded_box() -> Vec<Vector> {
    let corners = block([0.8, 0.6, 0.4]);
    let eighth = |corner: &Vector| {
        let outwards = corner.map(f64::signum);
        let at = |i: i32, j: i32| {
            let (up, around) = (FRAC_PI_2 * f64::from(i) / 3.0, FRAC_PI_2 * f64::from(j) / 3.0);
            // A cosine of a right angle is not quite 0, and would bend the box's faces.
            let cos = |angle: f64| if angle == FRAC_PI_2 { 0.0 } else { angle.cos() };
            let point = Vector::new(cos(up) * cos(around), cos(up) * around.sin(), up.sin());
            corner + 0.15 * outwards.component_mul(&point)
        };
        (0..4).flat_map(move |i| (0..4).map(move |j| at(i, j))).collect::<Vec<_>>()
    };
    corners.iter().flat_map(eighth).collect()
}

/// The hull of a gear: flat tips, and no teeth between them.
fn gear(teeth: u32) -> Vec<Vector> {
    let tip = |i: u32| {
        let angle = TAU * (f64::from(i / 2) + 0.4 * f64::from(i % 2)) / f64::from(teeth);
        [-0.2, 0.2].map(|z| Vector::new(angle.cos(), angle.sin(), z))
    };
    (0..2 * teeth).flat_map(tip).collect()
}
