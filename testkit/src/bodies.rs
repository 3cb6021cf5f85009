//! Bodies of every kind and size, with their polygons in the numbering that answers are to use.

use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use crate::cases::Random;
use crate::models::{cuboid, prism, random_hull};

/// A shape with what it was made from.
pub struct Body {
    pub shape: Shape,
    pub points: Vec<Vector>,
    /// The mesh it was made from, if it was not made from bare points.
    mesh: Option<PolygonMesh>,
    /// The corners of the polygon that each face id of an answer stands for.
    pub polygons: Vec<Vec<Vector>>,
}

const OPTIONS: fn() -> ShapeOptions = || ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };

impl Body {
    /// The hull of points: a face's id is its index in the polyhedron.
    pub fn from_points(points: Vec<Vector>) -> Body {
        let shape = Shape::from_points(&points, &OPTIONS()).expect("finite points");
        let hull = shape.polyhedron();
        let corner = |face: u32, side: u32| {
            let edge = &hull.edges[side as usize];
            hull.local_position(if edge.left() == face { edge.tail() } else { edge.head() })
        };
        let polygon = |(id, face): (u32, &swiftprox::body::polyhedron::MergedFace)| {
            let sides = &hull.sides[face.first_side as usize..(face.first_side + face.side_count) as usize];
            sides.iter().map(|&side| corner(id, side)).collect()
        };
        let polygons = (0..).zip(&hull.faces).map(polygon).collect();
        Body { shape, points, mesh: None, polygons }
    }

    /// A convex mesh: a face's id is its index in the mesh.
    pub fn from_mesh(mesh: PolygonMesh) -> Body {
        let shape = Shape::from_mesh(&mesh, &OPTIONS()).expect("a convex mesh");
        let corners = |f| mesh.face(f).iter().map(|&v| mesh.vertices[v as usize]).collect();
        let polygons = (0..mesh.face_count()).map(corners).collect();
        Body { shape, points: mesh.vertices.clone(), mesh: Some(mesh), polygons }
    }

    /// ρ, the radius of the vertices about the centre of the local coordinates.
    pub fn radius(&self) -> f64 {
        self.shape.polyhedron().radius
    }

    /// Centre and radius of the local coordinates together.
    pub fn reach(&self) -> f64 {
        self.radius() + self.shape.polyhedron().centre.norm()
    }

    /// Whether two vertices are joined by an edge, or are the ends of a segment.
    pub fn has_edge(&self, ids: [u32; 2]) -> bool {
        let hull = self.shape.polyhedron();
        let label = |v: u32| hull.vertex_labels[v as usize];
        let joins = |[tail, head]: [u32; 2]| ids == [tail, head] || ids == [head, tail];
        hull.edges.iter().any(|edge| joins([label(edge.tail()), label(edge.head())]))
            || (hull.dimension == 1 && joins([label(0), label(1)]))
    }

    /// Everything that is needed to make it again.
    pub fn describe(&self) -> String {
        let faces = |mesh: &PolygonMesh| (0..mesh.face_count()).map(|f| mesh.face(f).to_vec()).collect::<Vec<_>>();
        match &self.mesh {
            Some(mesh) => format!("mesh of {:?}, faces {:?}", self.points, faces(mesh)),
            None => format!("hull of {:?}", self.points),
        }
    }
}

/// A box, its half extents multiples of 1/8, its sides quadrilaterals or pairs of triangles.
pub fn any_box(random: &mut Random) -> Body {
    let half: [f64; 3] = std::array::from_fn(|_| (1 + random.below(8)) as f64 / 8.0);
    let mesh = cuboid(half).expect("a box");
    Body::from_mesh(if random.below(2) == 0 { mesh } else { triangulated(&mesh) })
}

/// Any body, from a millionth to a million in size.
pub fn any(random: &mut Random) -> Body {
    let size = 10f64.powi(random.below(13) as i32 - 6) * (1.5 + random.signed());
    let of_mesh = |mut mesh: PolygonMesh| {
        mesh.vertices.iter_mut().for_each(|v| *v *= size);
        Body::from_mesh(mesh)
    };
    let hull = |random: &mut Random, n: usize| random_hull(n, random.next_u64()).expect("random points");
    match random.below(10) {
        0 => any_box(random),
        1 => of_mesh(triangulated(&cuboid([1.0, 0.75, 0.5]).expect("a box"))),
        2 => of_mesh(hull(random, 4)),
        3 => of_mesh(prism(3 + random.below(15) as u32, 0.5 + 0.4 * random.signed()).expect("a prism")),
        4 => {
            let n = 5 + random.below(26);
            of_mesh(hull(random, n))
        }
        5 => {
            let n = 4 + random.below(9);
            Body::from_points((0..n).map(|_| random.lattice(2)).collect())
        }
        6 => Body::from_points(polygon(random).iter().map(|p| p * size).collect()),
        7 => {
            // Slivers, needles and plates.
            let thin = |random: &mut Random| [1.0, random.power(-45, -1), 1e-6][random.below(3)];
            let axes = Vector::new(1.0, thin(random), thin(random)) * size;
            let n = 4 + random.below(9);
            Body::from_points(hull(random, n).vertices.iter().map(|p| p.component_mul(&axes)).collect())
        }
        8 => {
            // Far from its own origin.
            let offset = size * 10f64.powi(random.below(10) as i32) * random.vector();
            let n = 4 + random.below(12);
            Body::from_points(hull(random, n).vertices.iter().map(|p| p * size + offset).collect())
        }
        _ => {
            // A point or a segment.
            let n = 1 + random.below(2);
            Body::from_points((0..n).map(|_| random.vector() * size).collect())
        }
    }
}

/// Points of a plane through the origin, exactly.
fn polygon(random: &mut Random) -> Vec<Vector> {
    let (u, v) = (random.lattice(2), random.lattice(2));
    let mut corner = || u * random.lattice(4).x + v * random.lattice(4).y;
    (0..7).map(|_| corner()).collect()
}

/// Every polygon as a fan of triangles.
fn triangulated(mesh: &PolygonMesh) -> PolygonMesh {
    let fan = |f| {
        let face: &[u32] = mesh.face(f);
        (2..face.len()).flat_map(|k| [face[0], face[k - 1], face[k]])
    };
    let indices = (0..mesh.face_count()).flat_map(fan).collect();
    PolygonMesh::new(mesh.vertices.clone(), indices, None).expect("the same vertices")
}
