//! The points that the face of a body over a triangle has in common with it, seen along a contact's normal: corners of one over the
//! other, and crossings of sides. The manifold's rules hold (`manifold`); what is no plain case is left to it.

use super::corner::most_parallel;
use super::lowest::PlacedTriangle;
use super::reach::GroundReach;
use super::vertices::Vertices;
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::memory::push;
use crate::body::polyhedron::{MergedFace, Polyhedron};
use crate::manifold::{COINCIDENT, ManifoldPoint, PARALLEL, id_of, witness};
use crate::pair::{Feature, FeatureKind, SignedDistance};

/// Most corners of a face: the bits of a mask.
const MOST: usize = 32;

/// Within so many times the length up to which points are one, a corner is too near to a side: four, and a projection along the
/// normal onto a plane of two axes stretches by √3 at most.
const DOUBT: f64 = 8.0;

/// Patches that stand more upright have no heights worth dividing by.
const LEAST_COSINE: f64 = 0.05;

/// A contact of a body and a triangle.
pub(super) struct Meet<'a> {
    pub body: &'a Vertices<'a>,
    pub reach: &'a GroundReach,
    pub triangle: &'a PlacedTriangle,
    pub contact: &'a SignedDistance,
    /// The body's lowest vertex along its normal.
    pub lowest: u32,
    /// Whether the contact's own points are on both.
    pub is_over: bool,
    /// Whether corners and sides of the triangle make points, too.
    pub keeps_inner: bool,
    pub max_distance: f64,
}

/// Appends the points. The manifold's reference, 0 where it is the contact's own pair of points; `None` where the manifold has to
/// be asked.
pub(super) fn add_common(meet: &Meet, points: &mut Vec<ManifoldPoint>) -> Result<Option<u32>> {
    let (polyhedron, pose) = (meet.body.polyhedron(), meet.body.pose());
    let is_plain = meet.reach.is_rigid
        && meet.body.body.shape.swept_radius() == 0.0
        && !polyhedron.outlines.is_empty()
        && polyhedron.contact_faces.faces.is_empty();
    let normal = Vector::from(meet.contact.normal);
    if !is_plain {
        return Ok(None);
    }
    let Some(face) = most_parallel(polyhedron, meet.lowest, &pose.rotate_back(&-normal)) else { return Ok(None) };
    let down = pose.rotate(&polyhedron.faces[face as usize].normal);
    let cosines = [-down.dot(&normal), meet.triangle.up.dot(&normal)];
    let reference = if cosines[1] > cosines[0] { 1 } else { 0 };
    let first = points.len();
    if cosines[reference] >= PARALLEL {
        if cosines[1 - reference] < LEAST_COSINE {
            return Ok(None);
        }
        let Some(projected) = Projected::new(meet, face, &normal) else { return Ok(None) };
        projected.add_points(meet, &normal, &down, cosines, points)?;
        // The patches most parallel to the normal need not hold the contact's own points.
        let deep = meet.contact.upper + meet.triangle.error;
        let is_missed = points.len() > first && points[first..].iter().all(|point| point.gap_lower > deep);
        if meet.is_over && meet.keeps_inner && is_missed {
            push(points, witness(meet.contact))?;
        }
    }
    if points.len() > first {
        return Ok(Some(reference as u32 + 1));
    }
    if meet.is_over {
        push(points, witness(meet.contact))?;
    }
    Ok(Some(0))
}

/// A face and a triangle along a normal, on the plane of the two axes that are most across it. The triangle goes around
/// counter-clockwise, the face clockwise.
struct Projected<'a> {
    polyhedron: &'a Polyhedron,
    face: u32,
    count: usize,
    vertices: [u32; MOST],
    /// For each side of the triangle the corners of the face outside of it.
    outside: [u32; 3],
    /// How far inside each side of the face the triangle's corners are, times its length; and for each corner the sides that it is
    /// outside of.
    inside: [[f64; MOST]; 3],
    outside_face: [u32; 3],
}

impl<'a> Projected<'a> {
    /// `None` where a corner is too near to a side, or there are many.
    fn new(meet: &Meet<'a>, face: u32, normal: &Vector) -> Option<Projected<'a>> {
        let polyhedron = meet.body.polyhedron();
        let record = &polyhedron.faces[face as usize];
        let count = record.side_count as usize;
        if count > MOST {
            return None;
        }
        let up = normal.iamax();
        let [right, ahead] = [(up + 1) % 3, (up + 2) % 3];
        let lean = [-normal[right] / normal[up], -normal[ahead] / normal[up]];
        let turn = if normal[up] > 0.0 { 1.0 } else { -1.0 };
        let corners = &meet.triangle.corners;
        let spot = |point: &Vector| {
            let from = point - corners[0];
            [from[right] + lean[0] * from[up], (from[ahead] + lean[1] * from[up]) * turn]
        };
        let own = corners.map(|corner| spot(&corner));
        let size = polyhedron.radius + own.iter().map(|[x, y]| x.abs() + y.abs()).fold(0.0, f64::max);
        let coincident = (2.0 * record.slack).max(COINCIDENT * size);
        let doubt = DOUBT * coincident;
        if !(polyhedron.radius > coincident) {
            return None;
        }
        let (_, fours) = polyhedron.outlines.corners(face);
        let mut vertices = [0; MOST];
        let mut spots = [[0.0; 2]; MOST + 1];
        for (at, &vertex) in fours.as_flattened().iter().take(count).enumerate() {
            vertices[at] = vertex;
            spots[at] = spot(&meet.body.point(vertex));
        }
        spots[count] = spots[0];
        let (mut outside, mut outside_face, mut near) = ([0; 3], [0; 3], false);
        for k in 0..3 {
            let [[x, y], to] = [own[k], own[(k + 1) % 3]];
            let [dx, dy] = [to[0] - x, to[1] - y];
            let limit = doubt * (dx.abs() + dy.abs());
            for (at, spot) in spots[..count].iter().enumerate() {
                let inside = dx * (spot[1] - y) - dy * (spot[0] - x);
                near |= !(inside.abs() > limit);
                outside[k] |= u32::from(inside < 0.0) << at;
            }
        }
        let mut inside = [[0.0; MOST]; 3];
        for at in 0..count {
            let [[x, y], to] = [spots[at], spots[at + 1]];
            let [dx, dy] = [to[0] - x, to[1] - y];
            let limit = doubt * (dx.abs() + dy.abs());
            for k in 0..3 {
                let value = dy * (own[k][0] - x) - dx * (own[k][1] - y);
                near |= !(value.abs() > limit);
                inside[k][at] = value;
                outside_face[k] |= u32::from(value < 0.0) << at;
            }
        }
        (!near).then_some(Projected { polyhedron, face, count, vertices, outside, inside, outside_face })
    }

    /// Heights are over the triangle's plane or below the face's, along the normal.
    ///
    /// Placed points are off by 6u of the lengths of `PlacedTriangle`, a difference of two by u more, its product with a normal by
    /// 12u of it, with that of a face by 28u, whose rotation is one to 16u; the cosine by 12u. A face is in a slab of twice its
    /// slack.
    fn add_points(
        &self,
        meet: &Meet,
        normal: &Vector,
        down: &Vector,
        cosines: [f64; 2],
        points: &mut Vec<ManifoldPoint>,
    ) -> Result<()> {
        let PlacedTriangle { own, up, corners, .. } = meet.triangle;
        let farthest = own.corners.iter().map(|corner| corner.lp_norm(1)).fold(0.0, f64::max);
        let rounding = U * (meet.reach.size + 2.0 * farthest);
        let face = &self.polyhedron.faces[self.face as usize];
        let on_triangle = Feature { kind: FeatureKind::Face, ids: [own.label, 0] };
        let all = u32::MAX >> (MOST - self.count);
        let mut below = all & !(self.outside[0] | self.outside[1] | self.outside[2]);
        let off_over = |height: f64| (24.0 * rounding + 16.0 * U * height.abs()) / cosines[1];
        while below != 0 {
            let vertex = self.vertices[below.trailing_zeros() as usize];
            below &= below - 1;
            let world = meet.body.point(vertex);
            let height = up.dot(&(world - corners[0]));
            let (gap, off) = (height / cosines[1], off_over(height));
            if gap - off <= meet.max_distance {
                let on = world - normal * gap;
                let (feature, local) = (self.vertex(vertex), self.polyhedron.local_position(vertex));
                push(points, point([local, meet.reach.point(&on)], [world, on], [gap, off], [feature, on_triangle]))?;
            }
        }
        if !meet.keeps_inner {
            return Ok(());
        }
        let from = meet.body.point(self.vertices[0]);
        let gap_at = |on: &Vector| {
            let height = down.dot(&(on - from));
            let off = 40.0 * rounding + 2.0 * face.slack + 16.0 * U * height.abs();
            (height / cosines[0], off / cosines[0])
        };
        let local = |world: &Vector| meet.body.pose().rotate_back(&(world - meet.body.pose().translation()));
        for k in (0..3).filter(|k| self.outside_face[*k] == 0) {
            let on = corners[k];
            let (gap, off) = gap_at(&on);
            if gap - off <= meet.max_distance {
                let world = on + normal * gap;
                let corner = Feature { kind: FeatureKind::Vertex, ids: [own.labels[k], 0] };
                push(points, point([local(&world), own.corners[k]], [world, on], [gap, off], [self.patch(), corner]))?;
            }
        }
        for k in 0..3 {
            let (next, outside) = ((k + 1) % 3, self.outside[k]);
            // The next corner's bit beside each: both ends of a side on either side of the triangle's, and the other way round.
            let turned = outside >> 1 | (outside & 1) << (self.count - 1);
            let mut crossed = (outside ^ turned) & (self.outside_face[k] ^ self.outside_face[next]) & all;
            while crossed != 0 {
                let side = crossed.trailing_zeros() as usize;
                crossed &= crossed - 1;
                let [before, after] = [self.inside[k][side], self.inside[next][side]];
                let on = corners[k] + (corners[next] - corners[k]) * (before / (before - after));
                let (gap, off) = gap_at(&on);
                if gap - off <= meet.max_distance {
                    let world = on + normal * gap;
                    let features = [self.side(face, side), edge([own.labels[k], own.labels[next]])];
                    push(points, point([local(&world), meet.reach.point(&on)], [world, on], [gap, off], features))?;
                }
            }
        }
        Ok(())
    }

    fn vertex(&self, vertex: u32) -> Feature {
        Feature { kind: FeatureKind::Vertex, ids: [self.polyhedron.vertex_labels[vertex as usize], 0] }
    }

    fn side(&self, face: &MergedFace, side: usize) -> Feature {
        edge(self.polyhedron.edges[self.polyhedron.side(face, side as u32) as usize].labels)
    }

    fn patch(&self) -> Feature {
        let label = self.polyhedron.labels_of_face(self.face).first().copied().unwrap_or(0);
        Feature { kind: FeatureKind::Face, ids: [label, 0] }
    }
}

fn edge(labels: [u32; 2]) -> Feature {
    Feature { kind: FeatureKind::Edge, ids: labels }
}

/// A point of both, with its gap and by how much that may be off.
fn point(local: [Vector; 2], world: [Vector; 2], [gap, off]: [f64; 2], features: [Feature; 2]) -> ManifoldPoint {
    let ([local1, local2], [world1, world2], [feature1, feature2]) =
        (local.map(Into::into), world.map(Into::into), features);
    let id = id_of(&feature1, &feature2);
    ManifoldPoint { local1, local2, world1, world2, gap_lower: gap - off, gap_upper: gap + off, feature1, feature2, id }
}

#[cfg(test)]
mod tests {
    use super::super::contacts::near_hills::near_hills;
    use super::*;
    use crate::manifold::{ManifoldConfig, add_points, manifold_along};
    use crate::pair::Outcome;
    use crate::shape::TriangleShape;

    /// The points are those of the manifold: the same features, gaps that agree, and places.
    #[test]
    fn points_are_those_of_the_manifold() {
        let mut shape = TriangleShape::new().unwrap();
        let (mut seen, mut left) = (0, 0);
        near_hills(0xc0e, 240, |near, random| {
            let triangle = near.triangle;
            let normal = (triangle.up + random.vector() * 0.05).normalize();
            let vertex = near.vertices.lowest(&normal, 0);
            let lowest = near.vertices.point(vertex);
            let gap = normal.dot(&(lowest - triangle.corners[0]));
            let contact = SignedDistance {
                outcome: Outcome::Intersecting,
                lower: gap,
                upper: gap,
                world1: lowest.into(),
                world2: (lowest - normal * gap).into(),
                local1: (near.vertices.pose().rotate_back(&(lowest - near.vertices.pose().translation()))).into(),
                local2: near.reach.point(&(lowest - normal * gap)).into(),
                normal: normal.into(),
                ..SignedDistance::default()
            };
            let max_distance = random.uniform(0.0, 0.4);
            let meet = Meet {
                body: near.vertices,
                reach: near.reach,
                triangle,
                contact: &contact,
                lowest: vertex,
                is_over: true,
                keeps_inner: true,
                max_distance,
            };
            let mut points = Vec::new();
            let Some(reference) = add_common(&meet, &mut points).unwrap() else {
                left += 1;
                return;
            };
            let config = ManifoldConfig { max_distance, reduces: false };
            let bodies = [near.vertices.body, shape.of(&triangle.own).at(near.place)];
            let mut truth = Vec::new();
            let manifold = add_points(&mut truth, |sink| manifold_along(bodies, &contact, &config, sink)).unwrap();
            if (manifold.reference == 0) != (reference == 0) || truth.len() != points.len() {
                panic!("{reference} {manifold:?} {points:?} {truth:?}");
            }
            if reference == 0 {
                return;
            }
            for point in &points {
                let Some(other) = truth.iter().find(|other| other.id == point.id) else {
                    // The contact's own pair, which a triangle's corners may name.
                    assert_eq!(point.world1, contact.world1);
                    continue;
                };
                assert!(point.gap_lower <= other.gap_upper && other.gap_lower <= point.gap_upper);
                let far = |one: [f64; 3], other: [f64; 3]| (Vector::from(one) - Vector::from(other)).norm();
                assert!(far(point.world1, other.world1) < 1e-9 && far(point.world2, other.world2) < 1e-9);
                assert!(far(point.local1, other.local1) < 1e-9 && far(point.local2, other.local2) < 1e-9);
                seen += 1;
            }
        });
        assert!(cfg!(miri) || seen > 500 && left < 20, "{seen} {left}");
    }
}
