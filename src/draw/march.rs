//! The march of a query: the features of each step, and the nearest points of these.

use super::body::{ends, place};
use super::target::{DrawKind, Pen};
use crate::answer::{FeatureKind, label};
use crate::base::math::{Vector, clamp};
use crate::pair::for_each_state;
use crate::placed::state::{FeatureId, State};
use crate::shape::Placed;

impl Pen<'_> {
    /// Each step of the march of two polyhedra.
    pub fn march(&mut self, bodies: &[Placed; 2]) {
        let mut step = 0;
        for_each_state(bodies, |state| {
            step += 1;
            let features = state.features();
            for (body, feature) in bodies.iter().zip(features) {
                self.feature(*body, feature);
            }
            let [point1, point2] = nearest(bodies, state);
            self.line(DrawKind::March, point2, point1);
            self.text(DrawKind::March, (point1 + point2) * 0.5, || {
                let [first, second] =
                    [(0, point1), (1, point2)].map(|(i, point)| name(&bodies[i], features[i], &point));
                format!("{step}: {first}, {second}")
            });
        });
    }
}

/// A feature in the caller's numbering; a face by the polygon at a point.
fn name(body: &Placed, feature: FeatureId, point: &Vector) -> String {
    let polyhedron = body.shape.polyhedron();
    let local = body.pose.rotate_back(&(point - body.pose.translation())) - polyhedron.centre;
    let feature = label(polyhedron, feature, &local);
    match (feature.kind, feature.ids) {
        (FeatureKind::Edge, [tail, head]) => format!("edge {tail}-{head}"),
        (FeatureKind::Face, [face, _]) => format!("face {face}"),
        (_, [vertex, _]) => format!("vertex {vertex}"),
    }
}

/// The nearest points of two features; of a face the foot on its plane.
fn nearest(bodies: &[Placed; 2], state: State) -> [Vector; 2] {
    match state.features() {
        [FeatureId::Face(face), FeatureId::Vertex(vertex)] => {
            let point = place(bodies[1], vertex);
            [foot(bodies[0], face, point), point]
        }
        [FeatureId::Vertex(vertex), FeatureId::Face(face)] => {
            let point = place(bodies[0], vertex);
            [point, foot(bodies[1], face, point)]
        }
        [first, second] => nearest_of_segments([segment(bodies[0], first), segment(bodies[1], second)]),
    }
}

/// The ends of an edge; a vertex twice.
fn segment(body: Placed, feature: FeatureId) -> [Vector; 2] {
    let polyhedron = body.shape.polyhedron();
    let vertices = match feature {
        FeatureId::Edge(edge) => ends(polyhedron, edge),
        other => [other.vertex(polyhedron); 2],
    };
    vertices.map(|vertex| place(body, vertex))
}

/// The foot of a point on a face's plane.
fn foot(body: Placed, face: u32, point: Vector) -> Vector {
    let face = &body.shape.polyhedron().faces[face as usize];
    let normal = body.pose.rotate(&face.normal).normalize();
    point - normal * normal.dot(&(point - place(body, face.vertex)))
}

/// The nearest points of two segments, which may be points (Ericson 2005, §5.1.9).
fn nearest_of_segments([[tail1, head1], [tail2, head2]]: [[Vector; 2]; 2]) -> [Vector; 2] {
    let (along1, along2, between) = (head1 - tail1, head2 - tail2, tail1 - tail2);
    let (square1, square2, product) = (along1.dot(&along1), along2.dot(&along2), along1.dot(&along2));
    let (on1, on2) = (along1.dot(&between), along2.dot(&between));
    let share = |over: f64, under: f64| if under > 0.0 { clamp(over / under, 0.0, 1.0) } else { 0.0 };
    let first = share(product * on2 - on1 * square2, square1 * square2 - product * product);
    let second = share(product * first + on2, square2);
    let first = share(product * second - on1, square1);
    [tail1 + along1 * first, tail2 + along2 * second]
}
