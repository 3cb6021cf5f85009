//! Poses that are hard for a given pair of bodies.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::Outcome;

use testkit::bodies::Body;
use testkit::cases::{Random, gap};
use testkit::properties::{Placed, Session};
use testkit::random::rotation;

/// Any orientation, mostly near enough to meet: where one body stands for the other of a similar size.
pub fn anywhere(bodies: [&Body; 2], random: &mut Random) -> [Pose; 2] {
    let size = bodies[0].radius() + bodies[1].radius();
    let reach = random.power(-3, 2) * size;
    let poses = bodies.map(|body| (random.rotation(), body)).map(|(turn, body)| about_centre(body, &turn));
    moved_far([poses[0], moved(&poses[1], &(reach * random.vector()))], random)
}

/// The body's centre, by its bounding box, at the world's origin up to rounding.
fn about_centre(body: &Body, turn: &Matrix) -> Pose {
    let mass = &body.shape.polyhedron().mass;
    Pose::new(turn, &(turn * -(0.5 * mass.lower + 0.5 * mass.upper)))
}

fn moved(pose: &Pose, by: &Vector) -> Pose {
    Pose::new(&pose.rotation(), &(pose.translation() + by))
}

/// One time in four both poses together 10³ to 10⁹ away.
fn moved_far(poses: [Pose; 2], random: &mut Random) -> [Pose; 2] {
    if random.below(4) != 0 {
        return poses;
    }
    let far = 10f64.powi(3 + random.below(7) as i32) * random.vector();
    poses.map(|pose| moved(&pose, &far))
}

/// Body 2 comes towards body 1 along a random line by bisection, until they lie one rounding apart or the bodies miss each
/// other: every step is checked, with the cache of the last.
pub fn approach(bodies: [&Body; 2], session: &mut Session) {
    let random = &mut session.random;
    let size = bodies[0].radius() + bodies[1].radius();
    let start = anywhere(bodies, random);
    let [turn1, turn2] = [start[0].rotation(), start[1].rotation()];
    let (pose1, meeting) = (about_centre(bodies[0], &turn1), about_centre(bodies[1], &turn2));
    let poses = moved_far([pose1, meeting], random);
    let line = random.vector().normalize();
    let (mut inside, mut outside) = (0.0, 2.5 * size);
    for _ in 0..48 {
        let middle = 0.5 * (inside + outside);
        let placed = Placed { bodies, poses: [poses[0], moved(&poses[1], &(middle * line))] };
        match session.check(&placed).map(|answer| answer.outcome) {
            Some(Outcome::Intersecting) => inside = middle,
            Some(_) => outside = middle,
            None => return,
        }
    }
}

/// A point on the surface of each body brought together up to a gap of 0 or ±2⁻ᵏ, the faces there parallel or tilted a little.
pub fn touching(bodies: [&Body; 2], random: &mut Random) -> [Pose; 2] {
    let [(point1, normal1), (point2, normal2)] = bodies.map(|body| surface_point(body, random));
    let turn1 = if random.below(2) == 0 { random.quarter_turns() } else { random.rotation() };
    let out = turn1 * normal1;
    // Body 2's normal against body 1's: a half turn about the line between the two directions.
    let between = (normal2 - out).try_normalize(1e-9).unwrap_or_else(|| normal2.cross(&random.vector()).normalize());
    let half_turn = 2.0 * between * between.transpose() - Matrix::identity();
    let spin = rotation(&out, 3.2 * random.signed() * random.below(2) as f64);
    let tilt = rotation(&random.vector().normalize(), tiny_angle(random));
    let turn2 = tilt * spin * half_turn;
    let size = bodies[0].radius().min(bodies[1].radius());
    let pose1 = Pose::new(&turn1, &Vector::zeros());
    let meeting = pose1.transform(&point1) + out * (size * gap(random));
    moved_far([pose1, Pose::new(&turn2, &(meeting - turn2 * point2))], random)
}

/// 0, or 10⁻¹² to 10⁻³ radians.
fn tiny_angle(random: &mut Random) -> f64 {
    [0.0, 10f64.powi(-3 - random.below(10) as i32) * random.signed()][random.below(2)]
}

/// A vertex, a point of an edge or of a face, and an outward normal there.
fn surface_point(body: &Body, random: &mut Random) -> (Vector, Vector) {
    let hull = body.shape.polyhedron();
    let Some(face) = hull.faces.get(random.below(hull.faces.len().max(1))) else {
        return (body.points[0], random.vector().normalize());
    };
    let normal = Vector::new(face.planes.x[0], face.planes.y[0], face.planes.z[0]);
    let side = random.below(face.side_count as usize) as u32;
    let edge = &hull.edges[hull.sides[(face.first_side + side) as usize] as usize];
    let [tail, head] = [edge.tail(), edge.head()].map(|v| hull.local_position(v));
    let on_edge = tail + (head - tail) * (0.5 + 0.5 * random.signed());
    match random.below(4) {
        0 => (tail, normal),
        1 => (on_edge, normal),
        // An edge or a vertex first.
        2 => (on_edge, (edge.normals[0] + edge.normals[1]).try_normalize(1e-9).unwrap_or(normal)),
        _ => {
            let other = hull.local_position(face.vertex);
            (on_edge + (other - on_edge) * (0.5 + 0.5 * random.signed()), normal)
        }
    }
}

/// Boxes on a grid of quarters: faces in line, touching, one in the other, upright or off by a little.
pub fn on_grid(_: [&Body; 2], random: &mut Random) -> [Pose; 2] {
    [(); 2].map(|()| {
        let tilt = if random.below(4) == 0 {
            rotation(&random.vector().normalize(), tiny_angle(random))
        } else {
            Matrix::identity()
        };
        Pose::new(&(random.quarter_turns() * tilt), &(0.25 * random.lattice(5)))
    })
}
