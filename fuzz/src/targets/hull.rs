//! The hull of any points: refused if one is not finite, else proved by `check_hull`, laid out without NaN, and admitted again
//! as the mesh of its own triangles.

use arbitrary::{Result, Unstructured};
use swiftprox::body::build::check::check_hull;
use swiftprox::body::build::hull::{Hull, convex_hull};
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use crate::geometry::any_points;

const MOST_POINTS: usize = 96;

pub fn run(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let _: Result<()> = any_points(&mut u, MOST_POINTS).map(|points| check(&points));
}

fn options(input: InputPolicy) -> ShapeOptions {
    ShapeOptions { input, ..ShapeOptions::default() }
}

fn check(points: &[Vector]) {
    let finite = points.iter().flatten().all(|x| x.is_finite());
    let hull = match convex_hull(points) {
        Ok(hull) => hull,
        Err(error) => {
            assert!(!finite && matches!(error, Error::Mesh(_)), "{error:?} for {points:?}");
            return;
        }
    };
    assert!(finite, "a hull of what is not finite");
    check_hull(points, &hull).unwrap_or_else(|error| panic!("{error} of {points:?}"));
    let made = [InputPolicy::Strict, InputPolicy::Flat, InputPolicy::Hull, InputPolicy::NearlyConvex]
        .map(|policy| Shape::from_points(points, &options(policy)));
    for (shape, least) in made.iter().zip([3, 2, 0, 2]) {
        match shape {
            Ok(shape) => assert!(hull.dimension >= least && shape.polyhedron().dimension == hull.dimension),
            Err(error) => assert!(hull.dimension < least && matches!(error, Error::Mesh(_)), "{error:?}: {points:?}"),
        }
    }
    let shape = made[2].as_ref().expect("every finite point set has a hull");
    check_polyhedron(points, &hull, shape.polyhedron());
    check_own_mesh(points, &hull);
}

fn check_polyhedron(points: &[Vector], hull: &Hull, p: &Polyhedron) {
    let what = || format!("{points:?}");
    let mut labels = p.vertex_labels.clone();
    labels.sort_unstable();
    assert_eq!(labels, hull.vertices, "{}", what());
    for (v, &label) in p.vertex_labels.iter().enumerate() {
        let stored = p.local_position(v as u32);
        assert_eq!(stored, points[label as usize], "{}", what());
    }
    // Bounds of the largest bodies are +∞.
    assert!(p.radius >= 0.0, "{}", what());
    let planes = p.faces.iter().map(|face| &face.planes).chain(p.edges.iter().map(|edge| &edge.planes));
    for block in planes.chain(&p.more_sides) {
        let numbers = [block.x, block.y, block.z, block.offset];
        assert!(!numbers.as_flattened().iter().any(|x| x.is_nan()), "{}", what());
    }
    assert!(p.faces.iter().all(|face| face.slack >= 0.0), "{}", what());
    assert!(p.bevels.iter().all(|bevel| bevel.slack >= 0.0), "{}", what());
    assert!(p.edges.iter().all(|edge| edge.length >= 0.0), "{}", what());
    let mass = &p.mass;
    assert!(mass.centre_of_mass.iter().all(|x| x.is_finite()), "{:?}: {}", mass, what());
    assert!(mass.volume >= 0.0 && mass.radius >= 0.0, "{:?}: {}", mass, what());
}

/// The triangles of a solid hull are a convex mesh. (Those of a flat one are no manifold: its two sides share diagonals.)
fn check_own_mesh(points: &[Vector], hull: &Hull) {
    if hull.dimension < 3 {
        return;
    }
    let vertices = hull.vertices.iter().map(|&v| points[v as usize]).collect();
    let place = |v: &u32| hull.vertices.binary_search(v).expect("corners are vertices") as u32;
    let indices = hull.triangles.iter().flatten().map(place).collect();
    let mesh = PolygonMesh::new(vertices, indices, None).expect("triangles over the vertices");
    let shape = Shape::from_mesh(&mesh, &options(InputPolicy::Strict));
    let shape = shape.unwrap_or_else(|error| panic!("{error}: {points:?}"));
    assert_eq!(shape.polyhedron().vertices.len(), hull.vertices.len(), "{points:?}");
}
