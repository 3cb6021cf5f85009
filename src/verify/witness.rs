//! What an answer says of one object: its witness point, in both frames, and the feature that holds it.

use super::{length, unverified};
use crate::answer::{Feature, FeatureKind};
use crate::error::Result;
use crate::math::{Pose, UNIT_ROUNDOFF as U, Vector, clamp};
use crate::polyhedron::{Face, Polyhedron};

/// A witness point as an answer says it.
pub struct Witness<'a> {
    /// 1 or 2, for messages.
    pub object: usize,
    /// The object.
    pub polyhedron: &'a Polyhedron,
    /// Where it is.
    pub pose: &'a Pose,
    /// The point in the object's frame.
    pub local: Vector,
    /// The same in the world.
    pub world: Vector,
    /// The feature it is said to be on.
    pub feature: Feature,
}

impl Witness<'_> {
    /// In centred coordinates.
    pub fn centred(&self) -> Vector {
        self.local - self.polyhedron.centre
    }

    /// The point is in the object, up to `allowed`, and the same in both frames.
    pub fn check_point(&self, allowed: f64) -> Result<()> {
        let Witness { object, polyhedron, pose, local, world, .. } = self;
        if local.iter().any(|x| !x.is_finite()) {
            return Err(unverified(format!("witness point {object} is {local:?}")));
        }
        let outside = distance_outside(polyhedron, &self.centred());
        if !(outside <= allowed) {
            return Err(unverified(format!("witness point {object} lies {outside:e} out of its object")));
        }
        // An eighth of everything, so that terms which cancel cannot overflow.
        let [local, world, translation, centre] =
            [*local, *world, pose.translation(), polyhedron.centre].map(|v| 0.125 * v);
        let apart = length(&(pose.rotate(&local) + translation - world));
        // Two ways to compute R·p + T, some ten roundings each, of a point between vertices that the body's size rounds; |R| ≤ 1.8.
        let rounding = 64.0 * U * (0.125 * polyhedron.radius + length(&centre) + length(&translation));
        if !(apart <= rounding + 64.0 * f64::from_bits(1)) {
            let apart = 8.0 * apart;
            return Err(unverified(format!("witness point {object} in the world is {apart:e} off the local one")));
        }
        Ok(())
    }

    /// The object has the feature.
    pub fn check_feature(&self) -> Result<()> {
        self.distance_from_feature().map(|_| ())
    }

    /// The object has the feature, and the point is on it, up to `allowed` and what faces and edges were merged within.
    pub fn check_on_feature(&self, allowed: f64) -> Result<()> {
        let distance = self.distance_from_feature()?;
        if distance <= allowed + 64.0 * U * self.polyhedron.radius {
            return Ok(());
        }
        Err(unverified(format!("witness point {} lies {distance:e} off {:?}", self.object, self.feature)))
    }

    /// How far the point is from the feature, which the object must have.
    fn distance_from_feature(&self) -> Result<f64> {
        let none = || unverified(format!("object {} has no {:?}", self.object, self.feature));
        self.distance_if_there().ok_or_else(none)
    }

    /// The same; `None` if the object has no such feature.
    fn distance_if_there(&self) -> Option<f64> {
        let (polyhedron, point) = (self.polyhedron, &self.centred());
        let [first, second] = self.feature.ids;
        let vertex = |label: u32| {
            let index = polyhedron.vertex_labels.iter().position(|&other| other == label)?;
            Some(polyhedron.vertices[index].position)
        };
        match self.feature.kind {
            FeatureKind::None => None,
            FeatureKind::Vertex => Some(length(&(point - vertex(first)?))),
            FeatureKind::Edge => {
                let ids = |labels: [u32; 2]| labels == [first, second] || labels == [second, first];
                let is_edge = match polyhedron.dimension {
                    1 => ids([polyhedron.vertex_labels[0], polyhedron.vertex_labels[1]]),
                    _ => polyhedron.edges.iter().any(|edge| ids(edge.labels)),
                };
                is_edge.then_some(())?;
                Some(distance_from_segment(&[vertex(first)?, vertex(second)?], point))
            }
            FeatureKind::Face => {
                let faces =
                    (0..polyhedron.faces.len() as u32).filter(|&f| polyhedron.labels_of_face(f).contains(&first));
                let distances = faces.map(|f| distance_from_face(polyhedron, &polyhedron.faces[f as usize], point));
                distances.reduce(f64::min)
            }
        }
    }
}

/// How far a point in centred coordinates lies out of a polyhedron, at least: the largest violation of a plane, less what the
/// plane misses the hull by, which is far more than rounding where a face is a sliver.
fn distance_outside(polyhedron: &Polyhedron, point: &Vector) -> f64 {
    let vertex = |i: usize| polyhedron.vertices[i].position;
    match polyhedron.dimension {
        0 => length(&(point - vertex(0))),
        1 => distance_from_segment(&[vertex(0), vertex(1)], point),
        _ => {
            let over_faces = polyhedron.faces.iter().map(|face| face.planes.value(0, point) - face.slack);
            // A flat body is bounded by its bevels, which lie in its plane.
            let over_bevels = polyhedron
                .edges
                .iter()
                .filter_map(|edge| polyhedron.bevels.get(edge.bevel as usize).map(|bevel| (edge, bevel)))
                .map(|(edge, bevel)| bevel.normal.dot(&(point - vertex(edge.tail() as usize))) - bevel.slack);
            over_faces.chain(over_bevels).fold(0.0, f64::max)
        }
    }
}

fn distance_from_segment(ends: &[Vector; 2], point: &Vector) -> f64 {
    let along = ends[1] - ends[0];
    let whole = length(&along);
    if whole == 0.0 {
        return length(&(point - ends[0]));
    }
    let direction = along / whole;
    let t = clamp((point - ends[0]).dot(&direction) / whole, 0.0, 1.0);
    length(&(point - ends[0] - along * t))
}

/// The distance from the plane, less what that misses the face by, over the polygon, else from the nearest side.
fn distance_from_face(polyhedron: &Polyhedron, face: &Face, point: &Vector) -> f64 {
    let sides = &polyhedron.sides[face.first_side as usize..(face.first_side + face.side_count) as usize];
    let is_over = |i: usize| {
        let (block, lane) = match i {
            0..3 => (&face.planes, 1 + i),
            _ => (&polyhedron.further_sides(face)[(i - 3) / 4], (i - 3) % 4),
        };
        block.value(lane, point) >= 0.0
    };
    if (0..sides.len()).all(is_over) {
        return face.planes.value(0, point).abs() - face.slack;
    }
    let of_side = |side: &u32| {
        let edge = &polyhedron.edges[*side as usize];
        let ends = [edge.tail(), edge.head()].map(|v| polyhedron.vertices[v as usize].position);
        distance_from_segment(&ends, point)
    };
    sides.iter().map(of_side).fold(f64::INFINITY, f64::min)
}
