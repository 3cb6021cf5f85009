//! What is no surface is refused with a message that says where.

use swiftprox::body::decomposition::decompose;
use swiftprox::error::Error;
use swiftprox::math::Vector;
use swiftprox::mesh::PolygonMesh;
use swiftprox::progress::Progress;
use testkit::models::cuboid;

use crate::bodies::torus;

fn refusal(mesh: &PolygonMesh, tolerance: f64) -> Error {
    decompose(mesh, tolerance, &mut Progress::new(&mut |_| true)).unwrap_err()
}

fn mesh(points: &[[f64; 3]], faces: &[&[u32]]) -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    points.iter().for_each(|p| mesh.push_vertex(Vector::from(*p)).unwrap());
    faces.iter().for_each(|face| mesh.push_face(face).unwrap());
    mesh
}

#[test]
fn refusals_say_where() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 1.0]];
    let crossed = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.5, 1.0, 0.0], [1.0, -3.0, 0.0]];
    let cases = [
        (mesh(&[], &[]), "the mesh has no vertices"),
        (mesh(&corners, &[]), "the mesh has no faces"),
        (mesh(&corners, &[&[0, 0, 1], &[2, 2, 2]]), "no face of the mesh has an area"),
        (
            mesh(&corners, &[&[0, 1, 2], &[0, 1, 4]]),
            "face 0: edge 0-1 runs in the same direction in face 1: the faces are not",
        ),
        (mesh(&corners, &[&[0, 1, 2], &[1, 0, 4], &[1, 0, 3]]), "face 0: edge 0-1 belongs to 3 faces, also to face 1"),
        (mesh(&crossed, &[&[0, 1, 2, 4, 3]]), "face 0 crosses itself"),
    ];
    for (mesh, expected) in cases {
        let Error::Mesh(message) = refusal(&mesh, 0.0) else { panic!("no refusal of a mesh") };
        assert!(message.starts_with(expected), "{message}");
    }
    for tolerance in [-1e-9, f64::NAN, 2.0] {
        assert!(
            matches!(refusal(&cuboid([1.0; 3]).unwrap(), tolerance), Error::Argument(message) if message.contains("tolerance"))
        );
    }
}

#[test]
fn it_can_be_cancelled_and_says_how_far_it_is() {
    let mesh = torus(40, 30);
    let mut last = 0.0;
    decompose(
        &mesh,
        0.0,
        &mut Progress::new(&mut |fraction| {
            assert!(fraction >= last);
            last = fraction;
            true
        }),
    )
    .unwrap();
    assert!(last > 0.5, "{last}");
    let cancelled = decompose(&mesh, 0.0, &mut Progress::new(&mut |fraction| fraction < 0.3));
    assert!(matches!(cancelled, Err(Error::Cancelled(_))));
}
