//! What `check_mesh` accepts, and that it says where the rest is wrong.

use swiftprox::body::build::check::check_mesh;
use swiftprox::body::build::hull::convex_hull;
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use testkit::models::spiral;

use super::turned;

fn mesh(vertices: &[Vector], faces: &[&[u32]]) -> PolygonMesh {
    let mut starts = vec![0];
    for f in faces {
        starts.push(starts[starts.len() - 1] + f.len() as u32);
    }
    PolygonMesh { vertices: vertices.to_vec(), indices: faces.concat(), starts, single_precision: false }
}

/// The triangulated hull of points as a mesh of these points.
fn hull_mesh(points: &[Vector]) -> PolygonMesh {
    let triangles = convex_hull(points).unwrap().triangles;
    mesh(points, &triangles.iter().map(|t| &t[..]).collect::<Vec<_>>())
}

#[track_caller]
fn refusal(mesh: &PolygonMesh, tolerance: f64) -> String {
    check_mesh(mesh, tolerance, false).expect_err("accepted").to_string()
}

#[track_caller]
fn refused(mesh: &PolygonMesh, tolerance: f64, message: &str) {
    assert_eq!(refusal(mesh, tolerance), message);
}

/// Refused because of a vertex outside of a face's plane: that vertex is as far outside as the message says, and no vertex is
/// farther. Returns the face and the vertex.
#[track_caller]
fn refused_for_vertex_outside(mesh: &PolygonMesh, tolerance: f64) -> (usize, u32) {
    let message = refusal(mesh, tolerance);
    let words: Vec<&str> = message.split_whitespace().collect();
    let ["face", face, "vertex", vertex, "lies", distance, "outside", "of", "its", "plane", "(allowed", allowed] =
        words[..]
    else {
        panic!("{message}");
    };
    assert_eq!(allowed, format!("{tolerance:.3e})"), "{message}");
    let face: usize = face.strip_suffix(':').unwrap().parse().unwrap();
    let (vertex, distance): (usize, f64) = (vertex.parse().unwrap(), distance.parse().unwrap());
    let corners: Vec<Vector> = mesh.face(face).iter().map(|v| mesh.vertices[*v as usize]).collect();
    let [a, b, c] = corners[..] else { panic!("a triangle was to be named: {message}") };
    let normal = (b - a).cross(&(c - a)).normalize();
    let height = |v: &Vector| normal.dot(&(v - a));
    let highest = mesh.vertices.iter().map(height).fold(0.0, f64::max);
    let named = height(&mesh.vertices[vertex]);
    assert!(named > tolerance && highest - named < 1e-13, "{message}: {named:e}, another one {highest:e}");
    assert!((named - distance).abs() <= 1e-3 * distance, "{message}: {named:e}");
    (face, vertex as u32)
}

#[track_caller]
fn accepted(mesh: &PolygonMesh, tolerance: f64) {
    check_mesh(mesh, tolerance, false).unwrap_or_else(|e| panic!("{e}"));
}

/// The unit cube's vertices; vertex i has coordinates (bit 0, bit 1, bit 2 of i).
fn cube_vertices() -> Vec<Vector> {
    (0..8).map(|i| Vector::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect()
}

const CUBE_FACES: [[u32; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

fn cube() -> PolygonMesh {
    mesh(&cube_vertices(), &CUBE_FACES.each_ref().map(|f| &f[..]))
}

/// The faces of the cube [0, 1]³ as grids of n by n squares, each cut into two triangles; vertices
/// not shared between squares (a triangle soup, as STL files are).
fn gridded_cube_soup(n: u32) -> PolygonMesh {
    let corners = cube_vertices();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for [a, b, c, d] in CUBE_FACES.map(|f| f.map(|v| corners[v as usize])) {
        debug_assert_eq!(a + c, b + d);
        let at = |i: u32, j: u32| a + (b - a) * (f64::from(i) / f64::from(n)) + (d - a) * (f64::from(j) / f64::from(n));
        for (i, j) in (0..n * n).map(|k| (k / n, k % n)) {
            let first = vertices.len() as u32;
            vertices.extend([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            vertices.extend([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            faces.extend([[first, first + 1, first + 2], [first + 3, first + 4, first + 5]]);
        }
    }
    mesh(&vertices, &faces.iter().map(|f| &f[..]).collect::<Vec<_>>())
}

#[test]
fn convex_meshes_are_accepted() {
    accepted(&cube(), 0.0);
    accepted(&hull_mesh(&spiral(500)), 1e-9);
    let squashed: Vec<Vector> = spiral(500).iter().map(|v| turned(&Vector::new(v.x, v.y, v.z * 1e-4))).collect();
    accepted(&hull_mesh(&squashed), 1e-9);
    for scale in [1e-200, 1e200, 1e-300, 1e300] {
        let mut scaled = cube();
        scaled.vertices.iter_mut().for_each(|v| *v = turned(v) * scale);
        accepted(&scaled, 1e-9 * scale);
    }
}

/// Beside the largest coordinates those of the others are so small that squares of areas underflow. From fuzzing.
#[test]
fn a_needle_without_area_is_accepted_at_any_tolerance() {
    let (largest, least) = (f64::MAX, f64::from_bits(1));
    let points = [
        Vector::new(-32.0, -least, least),
        Vector::new(-least, least, 1.4e-309),
        Vector::new(largest, -largest, largest),
        Vector::new(-largest, largest, -largest),
        Vector::new(31.0, 1.0, -3.75),
        Vector::new(-1.0, -32.0, -32.0),
    ];
    for tolerance in [0.0, 1.0, 1e300, largest, f64::INFINITY] {
        accepted(&hull_mesh(&points), tolerance);
    }
}

#[test]
fn polygons_of_any_valence() {
    let n = 1000_u32;
    let corner = |i: u32, z: f64| {
        let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        turned(&Vector::new(angle.cos(), angle.sin(), z))
    };
    let vertices: Vec<Vector> = (0..n).map(|i| corner(i, 0.0)).chain((0..n).map(|i| corner(i, 1.0))).collect();
    let mut faces: Vec<Vec<u32>> = (0..n)
        .map(|i| {
            let j = (i + 1) % n;
            vec![i, j, n + j, n + i]
        })
        .collect();
    faces.push((n..2 * n).collect());
    faces.push((0..n).rev().collect());
    accepted(&mesh(&vertices, &faces.iter().map(|f| &f[..]).collect::<Vec<_>>()), 1e-9);
}

#[test]
fn equal_vertices_count_as_one() {
    let soup = gridded_cube_soup(3);
    assert_eq!(soup.vertices.len(), 6 * 9 * 6);
    accepted(&soup, 1e-9);
    // Quads that end in a pole written twice are triangles; and -0.0 is 0.0.
    let vertices = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-0.0, -0.0, 1.0]];
    let poles: [&[u32]; 4] = [&[0, 1, 3, 4], &[1, 2, 4, 3], &[2, 0, 3, 4], &[0, 2, 1]];
    accepted(&mesh(&vertices.map(Vector::from), &poles), 0.0);
}

/// Tiny faces of rounded coordinates have planes tilted by noise; the surface is convex within the
/// noise all the same.
#[test]
fn fine_faces_of_rounded_coordinates_are_accepted() {
    let mut soup = gridded_cube_soup(30);
    for v in &mut soup.vertices {
        *v = turned(v).map(|x| f64::from(x as f32));
    }
    accepted(&soup, 1e-6);
    refused_for_vertex_outside(&soup, 1e-9);
}

/// The exact hull of points that are coplanar up to rounding has triangles too narrow for a normal.
#[test]
fn hulls_with_slivers_are_accepted() {
    let grid: Vec<Vector> = gridded_cube_soup(7).vertices.iter().map(|v| turned(v) / 7.0).collect();
    let hull = convex_hull(&grid).unwrap();
    let corners: Vec<Vector> = hull.vertices.iter().map(|v| grid[*v as usize]).collect();
    accepted(&hull_mesh(&corners), 1e-9);
    // A tip of ever smaller triangles.
    let tip: Vec<Vector> = spiral(300)
        .iter()
        .enumerate()
        .map(|(i, v)| {
            let size = (-0.5 * i as f64).exp();
            Vector::new(v.x * size, v.y * size, 1.0 - size)
        })
        .collect();
    let hull = convex_hull(&tip).unwrap();
    let corners: Vec<Vector> = hull.vertices.iter().map(|v| tip[*v as usize]).collect();
    accepted(&hull_mesh(&corners), 1e-9);
}

/// The area of a needle's side against its length is too small for a square in double precision.
#[test]
fn the_longest_needles_are_accepted() {
    for length in [1e150, 1e200, 1e280, 1e300] {
        let mut points: Vec<Vector> =
            cube_vertices().iter().map(|v| v.component_mul(&Vector::new(13.0, 3.25, length))).collect();
        // In the middle of an edge, so that there are more than the six planes.
        points.push(0.5 * (points[0] + points[1]) + Vector::new(0.0, -1.0, 0.0));
        accepted(&hull_mesh(&points), 1e-9 * length);
    }
}

/// Sides a billion times as long as wide, askew: their normals want more digits than doubles have.
#[test]
fn long_narrow_sides_askew_are_accepted() {
    for apex in [1e7, 1e9, 1e11, 1e13] {
        let mut points: Vec<Vector> = spiral(12).iter().map(|v| turned(v) * 30.0).collect();
        points.push(Vector::new(apex, 1.1 * apex, 0.9 * apex));
        let hull = convex_hull(&points).unwrap();
        let corners: Vec<Vector> = hull.vertices.iter().map(|v| points[*v as usize]).collect();
        accepted(&hull_mesh(&corners), 1e-9 * apex);
    }
}

#[test]
fn a_tolerance_must_be_a_number() {
    for tolerance in [f64::NAN, -1e-9] {
        let refused = check_mesh(&cube(), tolerance, false);
        assert_eq!(refused, Err(Error::Argument(format!("the convexity tolerance is {tolerance}"))));
    }
}

#[test]
fn broken_indices_are_named() {
    let mut m = cube();
    m.indices[5] = 8;
    refused(&m, 1e-9, "face 1: corner 1 is vertex 8, there are 8 vertices");
    let mut m = cube();
    m.starts[3] = 4;
    refused(&m, 1e-9, "the faces' starts do not divide the index array");
    let mut m = cube();
    m.vertices[3].y = f64::NAN;
    refused(&m, 1e-9, "vertex 3: y is not finite (NaN)");
    refused(&PolygonMesh::default(), 1e-9, "the mesh has no vertices");
    let mut m = cube();
    m.vertices.push(Vector::new(0.5, 0.5, 0.5));
    refused(&m, 1e-9, "vertex 8 belongs to no face");
}

#[test]
fn degenerate_faces_are_named() {
    let mut m = cube();
    m.indices.extend([0, 1, 0]);
    m.starts.push(27);
    refused(&m, 1e-9, "face 6 is degenerate: it has fewer than three distinct vertices");
    let mut m = cube();
    m.vertices[5] = m.vertices[4];
    m.vertices[7] = m.vertices[4];
    refused(&m, 1e-9, "face 5 is degenerate: it has fewer than three distinct vertices");
    let mut m = cube();
    m.indices.extend([0, 1, 2, 3, 1]);
    m.starts.push(29);
    refused(&m, 1e-9, "face 6 passes through vertex 1 more than once");
    let mut m = cube();
    m.starts.push(24);
    refused(&m, 1e-9, "face 6 is degenerate: it has fewer than three distinct vertices");
}

#[test]
fn open_and_overused_edges_are_named() {
    let faces: Vec<&[u32]> = CUBE_FACES[..5].iter().map(|f| &f[..]).collect();
    refused(&mesh(&cube_vertices(), &faces), 1e-9, "face 2: edge 4-5 belongs to no other face");
    let mut faces: Vec<&[u32]> = CUBE_FACES.iter().map(|f| &f[..]).collect();
    faces.push(&[0, 1, 7]);
    refused(&mesh(&cube_vertices(), &faces), 1e-9, "face 2: edge 0-1 belongs to 3 faces (2, 4, 6)");
    faces.pop();
    faces[1] = &[1, 5, 7, 3];
    let inconsistent = "face 1: edge 1-3 runs in the same direction in face 4: the faces are not consistently oriented";
    refused(&mesh(&cube_vertices(), &faces), 1e-9, inconsistent);
}

#[test]
fn surfaces_of_the_wrong_topology_are_named() {
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from);
    // Two tetrahedra, apart or with vertex 3 in common.
    let second = tetrahedron.map(|t| t.map(|v: u32| v + 4));
    let faces: Vec<&[u32]> = tetrahedron.iter().chain(&second).map(|t| &t[..]).collect();
    let shifted = |by: Vector| points.iter().copied().chain(points.map(|p| p + by)).collect::<Vec<_>>();
    let apart = mesh(&shifted(Vector::new(3.0, 0.0, 0.0)), &faces);
    refused(&apart, 1e-9, "face 4 is not connected with face 0 across edges");
    let touching = mesh(&shifted(Vector::new(0.0, 0.0, 1.0)), &faces);
    refused(&touching, 1e-9, "vertex 3: its faces form more than one fan (face 4 is not in that of face 1)");
    // A square torus.
    let ring = |r: f64, z: f64| (0..4).map(move |i| Vector::new([r, 0.0, -r, 0.0][i], [0.0, r, 0.0, -r][i], z));
    let vertices: Vec<Vector> =
        ring(1.0, 0.0).chain(ring(2.0, 0.0)).chain(ring(2.0, 1.0)).chain(ring(1.0, 1.0)).collect();
    let quads: Vec<[u32; 4]> = (0..16)
        .map(|k| {
            let (r, s, i, j) = (k / 4, (k / 4 + 1) % 4, k % 4, (k + 1) % 4);
            [4 * r + i, 4 * s + i, 4 * s + j, 4 * r + j]
        })
        .collect();
    let torus = mesh(&vertices, &quads.iter().map(|q| &q[..]).collect::<Vec<_>>());
    // Inside of the ring walls 12 to 15 stand at right angles to each other.
    let holes = "the surface has holes: 16 vertices - 32 edges + 16 faces = 0, not 2";
    let bend = "at edge 0-12 face 15 bends out of the plane of face 12";
    refused(&torus, 1e-9, &format!("{holes}; {bend}"));
    let mut inside_out = torus.clone();
    inside_out.indices.chunks_mut(4).for_each(<[u32]>::reverse);
    refused(&inside_out, 1e-9, &format!("{holes}; at edge 1-13 face 13 bends out of the plane of face 12"));
    // Without an area there is nothing to name.
    let mut straight = torus;
    straight.vertices.iter_mut().zip(0_u8..).for_each(|(v, k)| *v = Vector::x() * f64::from(k));
    refused(&straight, 1e-9, holes);
}

#[test]
fn inside_out_is_named() {
    const INSIDE_OUT: &str = "the mesh is inside out: face 0 and all others run clockwise seen from outside";
    let mut m = cube();
    for face in m.indices.chunks_mut(4) {
        face.reverse();
    }
    refused(&m, 1e-9, INSIDE_OUT);
    // A plate far thinner than the tolerance, too.
    m.vertices.iter_mut().for_each(|v| v.z *= 1e-11);
    refused(&m, 1e-9, INSIDE_OUT);
}

#[test]
fn dents_and_bumps_are_named() {
    // A vertex in the middle of the cube's top (face 5), pushed in.
    for (depth, fine) in [(0.25, false), (1.1e-9, false), (0.9e-9, true), (-1e-3, true)] {
        let mut vertices = cube_vertices();
        vertices.push(Vector::new(0.5, 0.5, 1.0 - depth));
        let mut faces: Vec<&[u32]> = CUBE_FACES[..5].iter().map(|f| &f[..]).collect();
        faces.extend([&[4_u32, 5, 8][..], &[5, 7, 8], &[7, 6, 8], &[6, 4, 8]]);
        let m = mesh(&vertices, &faces);
        if fine {
            accepted(&m, 1e-9);
        } else {
            let (face, vertex) = refused_for_vertex_outside(&m, 1e-9);
            assert!(face == 5 && [6, 7].contains(&vertex), "face {face}, vertex {vertex}");
        }
    }
    // Every edge of a ball flipped inwards.
    let points = spiral(40);
    let triangles = convex_hull(&points).unwrap().triangles;
    for t in 0..triangles.len() {
        let [a, b, c] = triangles[t];
        let other = triangles.iter().position(|o| (0..3).any(|i| (o[i], o[(i + 1) % 3]) == (b, a))).unwrap();
        let d = *triangles[other].iter().find(|v| **v != a && **v != b).unwrap();
        let mut dented = triangles.clone();
        dented[t] = [c, a, d];
        dented[other] = [d, b, c];
        let m = mesh(&points, &dented.iter().map(|t| &t[..]).collect::<Vec<_>>());
        assert_eq!(refused_for_vertex_outside(&m, 1e-9).0, t.min(other));
    }
}

#[test]
fn faces_that_are_not_plane_are_named() {
    let mut m = cube();
    m.vertices[7] *= 1.001;
    refused(&m, 1e-9, "face 1: vertex 1 lies 2.498e-4 off its plane (allowed 1.000e-9)");
    accepted(&m, 1e-3);
}

#[test]
fn flat_bodies_need_the_option() {
    let square = cube_vertices()[..4].to_vec();
    let two_sided = mesh(&square, &[&[0, 1, 3, 2], &[2, 3, 1, 0]]);
    let flat = "the mesh is flat: all vertices lie in the plane of vertices 0, 1 and 3; \
                the input policy Flat (SWIFTPROX_INPUT_FLAT) admits bodies without interior";
    refused(&two_sided, 1e-9, flat);
    check_mesh(&two_sided, 0.0, true).unwrap();
    let mut oblique = two_sided.clone();
    oblique.vertices.iter_mut().for_each(|v| *v = Vector::new(v.x + v.y, 2.0 * v.y - v.x, 3.0 * v.x));
    check_mesh(&oblique, 0.0, true).unwrap();
    // The sides may be cut differently.
    let cut = mesh(&square, &[&[0, 1, 3], &[0, 3, 2], &[2, 3, 1, 0]]);
    check_mesh(&cut, 0.0, true).unwrap();
    let line = [0.0, 1.0, 2.0].map(|x| Vector::new(x, x, 0.0));
    let straight = "the mesh is flat: all vertices lie on the line of vertices 0 and 2; \
                    the input policy Hull (SWIFTPROX_INPUT_HULL) admits segments and points";
    refused(&mesh(&line, &[&[0, 1, 2], &[2, 1, 0]]), 1e-9, straight);
}

#[test]
fn a_flat_body_must_be_convex() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let ell: Vec<Vector> = corners.iter().map(|c| Vector::new(c[0], c[1], 0.0)).collect();
    let m = mesh(&ell, &[&[0, 1, 2, 3, 4, 5], &[5, 4, 3, 2, 1, 0]]);
    let expected = "the mesh is not convex: it covers 0.857143 times the area of its convex hull; \
                    the hull's edge 2-4 is no edge of the mesh";
    assert_eq!(check_mesh(&m, 1e-9, true).unwrap_err().to_string(), expected);
    // Turned off the axes it is no longer exactly flat: no option is needed, and it is refused just
    // the same.
    let mut rotated = m.clone();
    rotated.vertices.iter_mut().for_each(|v| *v = turned(v) / 3.0);
    assert_eq!(convex_hull(&rotated.vertices).unwrap().dimension, 3);
    refused(&rotated, 1e-9, expected);
}
