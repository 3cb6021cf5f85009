//! An answer's report on one object: its witness point, in both frames, and the feature that holds it. All is measured in the
//! world: a pose may stretch the object, and does not stretch the ball that is swept over it.

use super::bounds::PointInside;
use super::checks::{between_origins, unverified};
use super::polygon::beyond_nearest;
use crate::answer::{Feature, FeatureKind, PairAnswer, Radii};
use crate::base::error::{Error, Result};
use crate::base::math::{Pose, STRETCH, UNIT_ROUNDOFF as U, Vector, length};
use crate::base::memory::listed;
use crate::body::build::assembly::build;
use crate::body::polyhedron::{MergedFace, Polyhedron};
use crate::placed::Pair;
use crate::placed::exact::{self, Differences};

/// A witness point as reported by an answer.
pub struct Witness<'a> {
    /// 1 or 2, for messages.
    pub object: usize,
    /// The object.
    pub polyhedron: &'a Polyhedron,
    /// The pose of the object.
    pub pose: &'a Pose,
    /// The point in the object's frame.
    local: Vector,
    /// The same in the world.
    world: Vector,
    /// The feature that is reported to hold it.
    pub feature: Feature,
    /// The radius of the ball that is swept over the object.
    radius: f64,
    /// From the point to the polyhedron's point that it stands for, in the world.
    inwards: Vector,
}

impl<'a> Witness<'a> {
    /// The witnesses of both objects, from an answer of any kind. The points stand for those a swept radius off along a normal,
    /// or along zeros for themselves.
    pub fn of_both(pair: &Pair<'a>, radii: &Radii, normal: &Vector, answer: &PairAnswer) -> [Witness<'a>; 2] {
        let (locals, worlds) = ([answer.local1, answer.local2], [answer.world1, answer.world2]);
        let features = [answer.feature1, answer.feature2];
        std::array::from_fn(|i| Witness {
            object: i + 1,
            polyhedron: pair.polyhedra[i],
            pose: pair.poses[i],
            local: locals[i].into(),
            world: worlds[i].into(),
            feature: features[i],
            radius: radii.each[i],
            inwards: if radii.each[i] > 0.0 { normal * radii.inwards()[i] } else { Vector::zeros() },
        })
    }

    /// About where the polyhedron's point is, in centred coordinates.
    pub fn centred(&self) -> Vector {
        let said = self.local - self.polyhedron.centre;
        if self.inwards == Vector::zeros() {
            return said;
        }
        // R has an inverse: det R > 0.
        said + self.pose.rotation().try_inverse().map_or(self.inwards, |back| back * self.inwards)
    }

    /// A point that is provably in the object, near the polyhedron's point on its feature; `None` if the object has no such
    /// feature.
    pub fn point_inside(&self) -> Option<PointInside> {
        self.point_of(&self.parts(f64::INFINITY)?)
    }

    /// The same of parts of the feature.
    fn point_of(&self, parts: &[(Vec<u32>, f64)]) -> Option<PointInside> {
        let (polyhedron, point) = (self.polyhedron, &self.centred());
        let inside = |corners: &[u32], k: usize| match *corners {
            [vertex] => PointInside::vertex(vertex),
            [tail, head] => PointInside::on_segment(polyhedron, [tail, head], point),
            _ => PointInside::on_triangle(polyhedron, [corners[0], corners[k - 1], corners[k]], point),
        };
        // A face as triangles from its first corner.
        let each = parts.iter().flat_map(|(corners, _)| (2..corners.len().max(3)).map(|k| inside(corners, k)));
        each.map(|inside| (inside, self.off(&inside))).reduce(|a, b| if b.1 < a.1 { b } else { a }).map(|best| best.0)
    }

    /// The approximate distance of the polyhedron's point from one that is provably in the object.
    pub fn off(&self, inside: &PointInside) -> f64 {
        inside.distance(self.polyhedron, self.pose, &self.local, &self.inwards)
    }

    /// The corners of the feature, and how far the surface may be from their hull, in the object's frame; for a face, those of
    /// each that the caller's polygon is part of, and where no other polygon there is nearer by more than `beyond`. `None` if the
    /// object has none; any two vertices are taken for an edge.
    fn parts(&self, beyond: f64) -> Option<Vec<(Vec<u32>, f64)>> {
        let polyhedron = self.polyhedron;
        let [first, second] = self.feature.ids;
        let vertex = |label: u32| Some(polyhedron.vertex_labels.iter().position(|&other| other == label)? as u32);
        match self.feature.kind {
            FeatureKind::None => None,
            FeatureKind::Vertex => Some(listed([(listed([vertex(first)?]), 0.0)])),
            FeatureKind::Edge => Some(listed([(listed([vertex(first)?, vertex(second)?]), 0.0)])),
            FeatureKind::Face => {
                let faces = (0_u32..).zip(&polyhedron.faces);
                let point = self.centred();
                let own = faces.filter(|(face, _)| {
                    polyhedron.labels_of_face(*face).contains(&first)
                        && (beyond == f64::INFINITY || beyond_nearest(polyhedron, *face, first, &point) <= beyond)
                });
                let part = |(id, face): (u32, &MergedFace)| {
                    (listed((0..face.side_count).map(|side| polyhedron.corner(id, side))), face.slack)
                };
                let parts: Vec<_> = listed(own.map(part));
                (!parts.is_empty()).then_some(parts)
            }
        }
    }

    /// The polyhedron's point is in it, up to `allowed`, and the point the same in both frames.
    pub fn check_point(&self, allowed: f64) -> Result<()> {
        self.check_within(&[allowed], &[])?;
        self.check_frames()
    }

    /// The same of a point that is no farther from the polyhedron than the swept radius, up to `allowed`; `around` are vertices
    /// whose hull may hold it.
    pub fn check_swept_point(&self, allowed: f64, around: &[u32]) -> Result<()> {
        self.check_within(&[self.radius, allowed], around)?;
        self.check_frames()
    }

    /// The point is the same in both frames.
    fn check_frames(&self) -> Result<()> {
        let Witness { object, polyhedron, pose, local, world, radius, .. } = self;
        // An eighth of everything, so that terms which cancel cannot overflow.
        let [local, world, translation, centre] =
            [*local, *world, pose.translation(), polyhedron.centre].map(|v| 0.125 * v);
        let apart = length(&(pose.rotate(&local) + translation - world));
        // Two ways to compute R·p + T, some ten roundings each, of a point between vertices that the body's size rounds; |R| ≤ 1.8.
        // Beside a far longer body a point may be as far out as that body's rounding, and it is p that rounds.
        let sizes = 0.125 * (polyhedron.radius + radius) + length(&local);
        let rounding = 64.0 * U * (sizes + length(&centre) + length(&translation));
        if !(apart <= rounding + 64.0 * f64::from_bits(1)) {
            let apart = 8.0 * apart;
            return Err(unverified(format!("witness point {object} in the world is {apart:e} off the local one")));
        }
        Ok(())
    }

    /// The polyhedron is no farther than a sum of lengths: a point of the feature is near, else integers tell.
    fn check_within(&self, lengths: &[f64], around: &[u32]) -> Result<()> {
        let most: f64 = lengths.iter().sum();
        if self.point_inside().is_some_and(|inside| self.off(&inside) <= most) {
            return Ok(());
        }
        let outside = self.outside(around)?;
        if outside.compare_sum(lengths).is_le() {
            return Ok(());
        }
        Err(unverified(format!("witness point {} lies {:e} out of its object", self.object, outside.bounds().0)))
    }

    /// How far the polyhedron is from its point, in integers; `around` are vertices whose hull may hold it.
    pub fn outside(&self, around: &[u32]) -> Result<exact::ExactDistance> {
        let near = listed(around.iter().map(|&vertex| [vertex, 0]));
        self.beside_probe(|pair| exact::distance(pair, &near))
    }

    /// The object beside a body of one vertex, the polyhedron's point. The translation, which both have in common, is left out:
    /// beside it rounding would move the point more than is allowed.
    fn beside_probe<T>(&self, tell: impl FnOnce(&Pair) -> T) -> Result<T> {
        let (probe, rotation) = (build(&[self.local], None)?, self.pose.rotation());
        let [here, there] = [Vector::zeros(), self.inwards].map(|at| Pose::new(&rotation, &at));
        Ok(tell(&Pair { polyhedra: [self.polyhedron, &probe], poses: [&here, &there] }))
    }

    /// The object has the feature.
    pub fn check_feature(&self) -> Result<()> {
        let polyhedron = self.polyhedron;
        let ids = |labels: [u32; 2]| [labels, [labels[1], labels[0]]].contains(&self.feature.ids);
        let is_there = match (self.feature.kind, polyhedron.dimension) {
            (FeatureKind::Edge, 1) => ids([polyhedron.vertex_labels[0], polyhedron.vertex_labels[1]]),
            (FeatureKind::Edge, _) => polyhedron.edges.iter().any(|edge| ids(edge.labels)),
            _ => self.parts(f64::INFINITY).is_some(),
        };
        if is_there { Ok(()) } else { Err(self.has_none()) }
    }

    fn has_none(&self) -> Error {
        unverified(format!("object {} has no {:?}", self.object, self.feature))
    }

    /// The point is on the feature, up to `allowed` and what faces and edges were merged within: near a point that is on it, else
    /// integers tell.
    pub fn check_on_feature(&self, allowed: f64) -> Result<()> {
        self.parts(f64::INFINITY).ok_or_else(|| self.has_none())?;
        let allowed = allowed + 64.0 * U * self.polyhedron.radius;
        let parts = self.parts(allowed).unwrap_or_default();
        if self.point_of(&parts).is_some_and(|inside| self.off(&inside) <= allowed) {
            return Ok(());
        }
        let (is_near, distance) = self.beside_probe(|pair| {
            let differences = Differences::new(pair);
            let (mut is_near, mut least) = (false, f64::INFINITY);
            for (corners, slack) in &parts {
                let pairs = listed(corners.iter().map(|&corner| [corner, 0]));
                let Some(distance) = differences.distance_of_hull(&pairs) else { continue };
                is_near |= distance.compare_sum(&[allowed, slack * STRETCH]).is_le();
                least = least.min(distance.bounds().0);
            }
            (is_near, least)
        })?;
        if is_near {
            return Ok(());
        }
        Err(unverified(format!("witness point {} lies {distance:e} off {:?}", self.object, self.feature)))
    }
}

/// From the point of object 2 to that of object 1, those of the polyhedra, in the world.
pub(super) fn difference_of(pair: &Pair, witnesses: &[Witness; 2]) -> Vector {
    let [first, second] = [0, 1].map(|i| {
        let Witness { local, inwards, .. } = &witnesses[i];
        pair.poses[i].rotate(&(local - pair.polyhedra[i].centre)) + inwards
    });
    between_origins(pair) + first - second
}
