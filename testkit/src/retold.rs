//! The same pair told in another way: numbering, and motions that are exact in doubles.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;

use crate::cases::Random;

/// Fisher & Yates.
pub fn shuffled<T: Clone>(items: &[T], random: &mut Random) -> Vec<T> {
    let mut items = items.to_vec();
    for last in (1..items.len()).rev() {
        items.swap(last, random.below(last + 1));
    }
    items
}

/// Vertices and faces in another order, every face begun at another corner.
pub fn renumbered(mesh: &PolygonMesh, random: &mut Random) -> PolygonMesh {
    let order = shuffled(&(0..mesh.vertices.len()).collect::<Vec<_>>(), random);
    let mut new_index = vec![0; order.len()];
    for (new, &old) in (0..).zip(&order) {
        new_index[old] = new;
    }
    let vertices = order.iter().map(|&old| mesh.vertices[old]).collect();
    let (mut indices, mut valences) = (Vec::new(), Vec::new());
    for face in shuffled(&(0..mesh.face_count()).collect::<Vec<_>>(), random) {
        let mut corners: Vec<u32> = mesh.face(face).iter().map(|&v| new_index[v as usize]).collect();
        let first = random.below(corners.len());
        corners.rotate_left(first);
        valences.push(corners.len() as u32);
        indices.extend(corners);
    }
    PolygonMesh::new(vertices, indices, Some(&valences)).expect("a permutation")
}

/// The rotation of a pose by a signed permutation: exact.
pub fn product(turn: &Matrix, pose: &Pose) -> Pose {
    Pose::new(&(turn * pose.rotation()), &(turn * pose.translation()))
}

/// A pose of a body whose own coordinates were turned by a signed permutation: the same points of the world, exactly.
pub fn reframed(turn: &Matrix, pose: &Pose) -> Pose {
    Pose::new(&(pose.rotation() * turn.transpose()), &pose.translation())
}

/// x ↦ −x.
pub fn mirror() -> Matrix {
    Matrix::from_diagonal(&Vector::new(-1.0, 1.0, 1.0))
}

/// A pose in the mirrored world, of a body that is mirrored itself, so that the matrix is a rotation as before.
pub fn mirrored(pose: &Pose) -> Pose {
    Pose::new(&(mirror() * pose.rotation() * mirror()), &(mirror() * pose.translation()))
}

/// The pose moved, if no coordinate of the sum is rounded.
pub fn shifted_exactly(pose: &Pose, step: &Vector) -> Option<Pose> {
    let sum = pose.translation() + step;
    // By Knuth's TwoSum the error of x + s is (x − (sum − (sum − x))) + (s − (sum − x)).
    let is_exact = (0..3).all(|k| {
        let (x, s) = (pose.translation()[k], step[k]);
        let part = sum[k] - x;
        x == sum[k] - part && s == part
    });
    is_exact.then(|| Pose::new(&pose.rotation(), &sum))
}

/// L, the larger bounding-box diagonal of two bodies, and W, the largest coordinate that a motion rounds: of positions in the
/// world, but of a body far from its own origin also those in its frame and of its translation.
pub fn extent(bodies: [&[Vector]; 2], poses: [&Pose; 2]) -> (f64, f64) {
    let diagonal = |points: &[Vector]| {
        let corner = |pick: fn(f64, f64) -> f64| points.iter().copied().reduce(|a, b| a.zip_map(&b, pick));
        let sides = corner(f64::max).zip(corner(f64::min)).map_or(Vector::zeros(), |(high, low)| high - low);
        // Not the root of a sum of squares, which may underflow.
        sides.x.hypot(sides.y).hypot(sides.z)
    };
    let largest = |points: &[Vector], pose: &Pose| {
        let positions = points.iter().flat_map(|p| [p.amax(), pose.transform(p).amax()]);
        positions.fold(pose.translation().amax(), f64::max)
    };
    let size = diagonal(bodies[0]).max(diagonal(bodies[1]));
    (size, largest(bodies[0], poses[0]).max(largest(bodies[1], poses[1])))
}
