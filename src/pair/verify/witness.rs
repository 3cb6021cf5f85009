//! What an answer says of one object: its witness point, in both frames, and the feature that holds it.

use super::bounds::PointInside;
use super::checks::{between_origins, length, unverified};
use super::polygon::{beyond_nearest, distance_from_segment};
use crate::base::error::Result;
use crate::base::math::{Matrix, Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::memory::listed;
use crate::build::assembly::build;
use crate::pair::answer::{Feature, FeatureKind};
use crate::pair::contact::PlacedPoints;
use crate::pair::radii::Radii;
use crate::polyhedron::{Face, Polyhedron};
use crate::solve::exact;

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
    /// How far it was moved from where it is said to be.
    pub moved: f64,
}

impl<'a> Witness<'a> {
    /// Of both objects: points that were moved by the radii, and the features that hold them.
    pub fn of_both(
        polyhedra: [&'a Polyhedron; 2],
        poses: [&'a Pose; 2],
        radii: &Radii,
        points: &PlacedPoints,
        features: [Feature; 2],
    ) -> [Witness<'a>; 2] {
        std::array::from_fn(|i| Witness {
            object: i + 1,
            polyhedron: polyhedra[i],
            pose: poses[i],
            local: points.local[i].into(),
            world: points.world[i].into(),
            feature: features[i],
            moved: radii.each[i],
        })
    }

    /// In centred coordinates.
    pub fn centred(&self) -> Vector {
        self.local - self.polyhedron.centre
    }

    /// A point that is in the object for sure, near the witness point on its feature; `None` if the object has no such feature.
    pub fn point_inside(&self) -> Option<PointInside> {
        let (polyhedron, point) = (self.polyhedron, &self.centred());
        let [first, second] = self.feature.ids;
        match self.feature.kind {
            FeatureKind::None => None,
            FeatureKind::Vertex => Some(PointInside::vertex(self.vertex(first)?)),
            FeatureKind::Edge => {
                Some(PointInside::on_segment(polyhedron, [self.vertex(first)?, self.vertex(second)?], point))
            }
            FeatureKind::Face => {
                let triangles = self.faces(first).flat_map(|face| triangles_of_face(polyhedron, face));
                let inside = triangles.map(|corners| PointInside::on_triangle(polyhedron, corners, point));
                let missed = inside.map(|inside| (inside, inside.distance(polyhedron, point)));
                missed.reduce(|best, other| if other.1 < best.1 { other } else { best }).map(|(inside, _)| inside)
            }
        }
    }

    /// The vertex that the caller calls `label`.
    fn vertex(&self, label: u32) -> Option<u32> {
        let index = self.polyhedron.vertex_labels.iter().position(|&other| other == label)?;
        Some(index as u32)
    }

    /// The faces that the caller's polygon `label` is part of.
    fn faces(&self, label: u32) -> impl Iterator<Item = u32> {
        (0..self.polyhedron.faces.len() as u32)
            .filter(move |&face| self.polyhedron.labels_of_face(face).contains(&label))
    }

    /// The point is in the object, up to `allowed`, and the same in both frames; `around` are vertices whose hull may hold it.
    pub fn check_point(&self, allowed: f64, around: &[u32]) -> Result<()> {
        let Witness { object, polyhedron, pose, local, world, .. } = self;
        self.check_inside(allowed, around)?;
        // An eighth of everything, so that terms which cancel cannot overflow.
        let [local, world, translation, centre] =
            [*local, *world, pose.translation(), polyhedron.centre].map(|v| 0.125 * v);
        let apart = length(&(pose.rotate(&local) + translation - world));
        // Two ways to compute R·p + T, some ten roundings each, of a point between vertices that the body's size rounds; |R| ≤ 1.8.
        let sizes = 0.125 * (polyhedron.radius + self.moved);
        let rounding = 64.0 * U * (sizes + length(&centre) + length(&translation));
        if !(apart <= rounding + 64.0 * f64::from_bits(1)) {
            let apart = 8.0 * apart;
            return Err(unverified(format!("witness point {object} in the world is {apart:e} off the local one")));
        }
        Ok(())
    }

    /// The point is in the object, up to `allowed`: near a point of its feature, else integers tell.
    fn check_inside(&self, allowed: f64, around: &[u32]) -> Result<()> {
        let Witness { object, polyhedron, .. } = self;
        if self.point_inside().is_some_and(|inside| inside.distance(polyhedron, &self.centred()) <= allowed) {
            return Ok(());
        }
        let outside = self.outside(around)?;
        if outside.compare(allowed).is_le() {
            return Ok(());
        }
        Err(unverified(format!("witness point {object} lies {:e} out of its object", outside.bounds().0)))
    }

    /// How far the point is out of the object, in integers; `around` are vertices whose hull may hold it.
    pub fn outside(&self, around: &[u32]) -> Result<exact::ExactDistance> {
        let at_point = Pose::new(&Matrix::identity(), &self.local);
        let probe = build(&[Vector::zeros()], None)?;
        let near = listed(around.iter().map(|&vertex| [vertex, 0]));
        Ok(exact::distance(self.polyhedron, &Pose::IDENTITY, &probe, &at_point, &near))
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
        let vertex = |label: u32| Some(polyhedron.vertices[self.vertex(label)? as usize].position);
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
                let distance = |face: u32| {
                    let of_face = distance_from_face(polyhedron, &polyhedron.faces[face as usize], point);
                    of_face.max(beyond_nearest(polyhedron, face, first, point))
                };
                let distances = self.faces(first).map(distance);
                distances.reduce(f64::min)
            }
        }
    }
}

/// A face as triangles from its first corner.
fn triangles_of_face(polyhedron: &Polyhedron, face: u32) -> impl Iterator<Item = [u32; 3]> {
    let corner = move |side: u32| polyhedron.corner(face, side);
    (2..polyhedron.faces[face as usize].side_count).map(move |side| [corner(0), corner(side - 1), corner(side)])
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

/// The distance of the witness points.
pub(super) fn distance_between(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], witnesses: &[Witness; 2]) -> f64 {
    length(&difference_of(polyhedra, poses, witnesses))
}

/// From the witness point of object 2 to that of object 1, in the world.
pub(super) fn difference_of(polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], witnesses: &[Witness; 2]) -> Vector {
    let [first, second] = [0, 1].map(|i| poses[i].rotate(&witnesses[i].centred()));
    between_origins(polyhedra, poses) + first - second
}
