//! The best normal that a contact may have. Where the direction in which a body and a triangle are nearest, or overlap least, is
//! no normal of the surface, another is sought among those that are: the triangle's, those across its convex sides and rims, and
//! at a peak those of the body's faces. Best is the one along which they are farthest apart, or overlap least.

use super::PlacedGround;
use super::facing::FacingFaces;
use super::lowest::{PlacedTriangle, is_inside, local_point};
use super::normals::TILT;
use super::reach::GroundReach;
use super::vertices::Vertices;
use crate::answer::{feature_of_vertices, label};
use crate::base::error::Result;
use crate::base::math::{Matrix, UNIT_ROUNDOFF, Vector, is_unit, length};
use crate::body::polyhedron::MergedFace;
use crate::pair::{Feature, FeatureKind, Outcome, Placed, SignedDistance};
use crate::placed::state::FeatureId;

/// So many directions are tried across a side. A round body of 10,000 vertices takes some 20.
const MOST_TRIED: usize = 64;

/// A unit normal in the world, and how far the polyhedron is above the triangle along it; less than 0 where they overlap.
#[derive(Debug, Clone, Copy)]
pub(super) struct LeastOverlap {
    pub normal: Vector,
    pub gap: f64,
    place: OverlapPlace,
}

impl LeastOverlap {
    pub fn is_along_own_normal(&self) -> bool {
        matches!(self.place, OverlapPlace::Face(_))
    }
}

/// What touches what.
#[derive(Debug, Clone, Copy)]
enum OverlapPlace {
    /// A vertex of the body, the triangle's face.
    Face(u32),
    /// The line of two vertices, or a vertex twice, and a side.
    Side(usize, [u32; 2]),
    /// A face of the body, and a corner.
    Corner(usize, u32),
    /// A vertex of the body, and nothing of the triangle: another one's face.
    Beside(u32),
}

/// The lowest vertex along a normal.
#[derive(Debug, Clone, Copy)]
struct Low {
    normal: Vector,
    vertex: u32,
    point: Vector,
}

/// A search for the best normal of a triangle.
pub(super) struct NormalSearch<'a> {
    body: Placed<'a>,
    vertices: Vertices<'a>,
    ground: PlacedGround<'a>,
    reach: &'a GroundReach,
    triangle: &'a PlacedTriangle,
}

impl<'a> NormalSearch<'a> {
    pub fn new(
        vertices: Vertices<'a>,
        ground: PlacedGround<'a>,
        reach: &'a GroundReach,
        triangle: &'a PlacedTriangle,
    ) -> NormalSearch<'a> {
        NormalSearch { body: vertices.body, vertices, ground, reach, triangle }
    }

    /// The triangle's own normal, along which a vertex is lowest.
    pub fn own(&self, vertex: u32) -> LeastOverlap {
        self.upwards(&Low { normal: self.triangle.up, vertex, point: self.point(vertex) })
    }

    fn upwards(&self, low: &Low) -> LeastOverlap {
        let gap = low.normal.dot(&(low.point - self.triangle.corners[0]));
        LeastOverlap { normal: low.normal, gap, place: OverlapPlace::Face(low.vertex) }
    }

    /// The best normal. Rounding may hide which of two that are about as good is better.
    /// `vertex` is the lowest along the triangle's own.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn best(&self, vertex: u32, facing: &mut FacingFaces) -> Result<LeastOverlap> {
        let PlacedTriangle { own, marks, up, .. } = self.triangle;
        let low = Low { normal: *up, vertex, point: self.point(vertex) };
        let mut best = self.upwards(&low);
        for k in (0..3).filter(|k| marks.has_far_normal(*k)) {
            if let Some(far) = self.ground.ground.far_normal(3 * own.label + k as u32) {
                self.across(k, low, &self.reach.world_normal(&far), &mut best);
            }
        }
        let mut peaks = (0..3).filter(|k| marks.may_be_peak(*k)).peekable();
        if best.gap < 0.0
            && peaks.peek().is_some()
            && self.body.shape.polyhedron().dimension == 3
            && let Some(inverse) = self.body.pose.rotation().try_inverse()
        {
            let faces = facing.at(self.body.shape.polyhedron(), &inverse, self.triangle)?;
            peaks.for_each(|k| self.at_peak(k as u32, &inverse, faces, &mut best));
        }
        Ok(best)
    }

    fn lowest(&self, normal: &Vector, start: u32) -> Low {
        debug_assert!(is_unit(normal));
        let vertex = self.vertices.lowest(normal, start);
        Low { normal: *normal, vertex, point: self.point(vertex) }
    }

    fn point(&self, vertex: u32) -> Vector {
        self.vertices.point(vertex)
    }

    /// Looks for better normals across a side, from the triangle's own to the one at the other end. Along each the body is as far
    /// above the side as its lowest vertex. Between two normals it is at most as far as the lowest vertices of both are; where that
    /// is better than the best, the lowest vertex there either is one of them or divides what is left in two.
    fn across(&self, k: usize, own: Low, far: &Vector, best: &mut LeastOverlap) {
        let [tail, head] = [self.triangle.corners[k], self.triangle.corners[(k + 1) % 3]];
        // Along the normals between, the vertex that is below the side is a height of which the ends are the most, while it is
        // negative.
        if best.gap < 0.0 && far.dot(&(own.point - tail)) <= best.gap && own.normal.dot(&(own.point - tail)) <= best.gap
        {
            return;
        }
        let end = self.lowest(far, own.vertex);
        let gap = far.dot(&(end.point - tail));
        if gap > best.gap {
            *best = LeastOverlap { normal: *far, gap, place: OverlapPlace::Beside(end.vertex) };
        }
        // No step is for the sake of rounding.
        let least_step =
            64.0 * UNIT_ROUNDOFF * (self.body.shape.polyhedron().radius + (head - tail).norm() + gap.abs());
        let mut open = [(own, end); MOST_TRIED];
        let (mut count, mut tried) = (1, 0);
        while count > 0 && tried < MOST_TRIED {
            count -= 1;
            let (one, other) = open[count];
            let Some((normal, bound, vertices)) = highest_between(&one, &other, &tail) else { continue };
            if !(bound > best.gap + least_step) {
                continue;
            }
            tried += 1;
            let low = self.lowest(&normal, one.vertex);
            let height = normal.dot(&(low.point - tail));
            if height >= bound - least_step {
                *best = LeastOverlap { normal, gap: bound, place: OverlapPlace::Side(k, vertices) };
                continue;
            }
            // Two vertices may be as low as this at the normal that divides.
            if height > best.gap {
                *best = LeastOverlap { normal, gap: height, place: OverlapPlace::Side(k, [low.vertex; 2]) };
            }
            if count + 2 <= MOST_TRIED {
                (open[count], open[count + 1]) = ((one, low), (low, other));
                count += 2;
            }
        }
    }

    /// Looks for a better normal at a corner, among those of these faces of the body: where overlaps are least inside a peak's
    /// cone, three vertices are lowest. `inverse` is that of the body's rotation.
    fn at_peak(&self, k: u32, inverse: &Matrix, faces: &[u32], best: &mut LeastOverlap) {
        let (polyhedron, pose) = (self.body.shape.polyhedron(), self.body.pose);
        debug_assert!(polyhedron.dimension == 3);
        let corner = self.triangle.corners[k as usize];
        let local = inverse * (corner - pose.translation()) - polyhedron.centre;
        // No normal at the corner leads out along a side of it.
        let sides = [1, 2].map(|by| self.triangle.corners[(k as usize + by) % 3] - corner);
        let most = sides.map(|side| 4.0 * TILT * side.norm());
        for &face in faces {
            let plane = &polyhedron.faces[face as usize];
            // In the body's frame, where lengths are a little others if its rotation is not quite rigid.
            let gap = plane.planes.value(0, &local);
            if !(gap > 1.05 * best.gap && gap <= 0.0) {
                continue;
            }
            // The face's inward normal in the world, also of a pose that is not quite rigid.
            let normal = -inverse.tr_mul(&plane.normal);
            if normal.dot(&sides[0]) > most[0] || normal.dot(&sides[1]) > most[1] {
                continue;
            }
            let normal = normal.normalize();
            if !self
                .ground
                .ground
                .is_normal_at_vertex(3 * self.triangle.own.label + k, &self.reach.local_normal(&normal))
            {
                continue;
            }
            let gap = normal.dot(&(self.lowest(&normal, plane.vertex).point - corner));
            if gap > best.gap {
                *best = LeastOverlap { normal, gap, place: OverlapPlace::Corner(k as usize, face) };
            }
        }
    }

    /// The contact of a body behind the triangle, along the triangle's normal.
    pub fn push_from_behind(&self) -> SignedDistance {
        let low = self.lowest(&self.triangle.up, 0);
        let gap = self.triangle.up.dot(&(low.point - self.triangle.corners[0]));
        let label = self.body.shape.polyhedron().vertex_labels[low.vertex as usize];
        let features = [(FeatureKind::Vertex, label), (FeatureKind::Face, self.triangle.own.label)];
        let features = features.map(|(kind, label)| Feature { kind, ids: [label, 0] });
        let found = SignedDistance { outcome: Outcome::Intersecting, ..SignedDistance::default() };
        self.between(&self.triangle.up, &low.point, &(low.point - self.triangle.up * gap), features, &found)
    }

    /// The contact along the best normal, with the outcome of `found`, and whether its points are on both. If not, they are the
    /// body's lowest and the one below it.
    pub fn contact(&self, best: &LeastOverlap, found: &SignedDistance) -> (SignedDistance, bool) {
        let LeastOverlap { normal, gap, place } = *best;
        let polyhedron = self.body.shape.polyhedron();
        let vertex =
            |vertex: u32| Feature { kind: FeatureKind::Vertex, ids: [polyhedron.vertex_labels[vertex as usize], 0] };
        let face_feature = Feature { kind: FeatureKind::Face, ids: [self.triangle.own.label, 0] };
        match place {
            OverlapPlace::Face(lowest) => {
                let point = self.point(lowest);
                let contact =
                    self.between(&normal, &point, &(point - normal * gap), [vertex(lowest), face_feature], found);
                let is_over = self.is_over(&contact.local2.into());
                (contact, is_over)
            }
            OverlapPlace::Beside(lowest) => {
                let point = self.point(lowest);
                (self.between(&normal, &point, &(point - normal * gap), [vertex(lowest), face_feature], found), false)
            }
            OverlapPlace::Side(k, [one, other]) => {
                let [tail, side] =
                    [self.triangle.corners[k], self.triangle.corners[(k + 1) % 3] - self.triangle.corners[k]];
                let [a, line] = [self.point(one), self.point(other) - self.point(one)];
                let ([s, t], is_over) = nearest_of_lines(&(a - tail), &side, &line);
                let labels = [self.triangle.own.labels[k], self.triangle.own.labels[(k + 1) % 3]];
                let feature2 = Feature { kind: FeatureKind::Edge, ids: labels };
                let own = a + line * t;
                let feature1 = self.feature_between([one, other], &normal, &own);
                // The lowest point is the one that counts where the lines do not cross.
                let on = if is_over { tail + side * s } else { own - normal * gap };
                (self.between(&normal, &own, &on, [feature1, feature2], found), is_over)
            }
            OverlapPlace::Corner(k, face) => {
                let on = self.triangle.corners[k];
                let own = on + normal * gap;
                let local = local_point(self.body.pose, &own) - polyhedron.centre;
                let lengths = polyhedron.radius + own.lp_norm(1) + self.body.pose.translation().lp_norm(1);
                let is_off =
                    |face: &MergedFace| face.planes.value(0, &local) > face.slack + 256.0 * UNIT_ROUNDOFF * lengths;
                if polyhedron.faces.iter().any(is_off) {
                    let Low { vertex: lowest, point, .. } = self.lowest(&normal, 0);
                    let on = point - normal * gap;
                    return (self.between(&normal, &point, &on, [vertex(lowest), face_feature], found), false);
                }
                let feature1 = label(polyhedron, FeatureId::Face(face), &local);
                let feature2 = Feature { kind: FeatureKind::Vertex, ids: [self.triangle.own.labels[k], 0] };
                (self.between(&normal, &own, &on, [feature1, feature2], found), true)
            }
        }
    }

    /// Another point of the body that is below the triangle: that of the direction in which they overlap least.
    pub fn inner(&self, best: &LeastOverlap, nearest: &SignedDistance) -> Option<SignedDistance> {
        let (normal, towards) = (best.normal, Vector::from(nearest.normal));
        let own = Vector::from(nearest.world1) + towards * self.body.shape.swept_radius();
        let face = Feature { kind: FeatureKind::Face, ids: [self.triangle.own.label, 0] };
        let height = normal.dot(&(own - self.triangle.corners[0]));
        let inner = self.between(&normal, &own, &(own - normal * height), [nearest.feature1, face], nearest);
        let is_below = normal.dot(&towards) > 0.0 && self.is_over(&inner.local2.into());
        is_below.then_some(inner)
    }

    /// The feature that holds a point between two vertices, which need not have an edge.
    fn feature_between(&self, vertices: [u32; 2], normal: &Vector, own: &Vector) -> Feature {
        let (polyhedron, pose) = (self.body.shape.polyhedron(), self.body.pose);
        let vertices = if vertices[0] == vertices[1] { &vertices[..1] } else { &vertices[..] };
        let (local, towards) = (local_point(pose, own) - polyhedron.centre, pose.rotate_back(&-normal));
        let within = 64.0 * UNIT_ROUNDOFF * (polyhedron.radius + own.lp_norm(1) + pose.translation().lp_norm(1));
        label(polyhedron, feature_of_vertices(polyhedron, vertices, &local, &towards, within), &local)
    }

    /// The contact of a point of the polyhedron and one of the triangle's plane. Its interval holds for them.
    fn between(
        &self,
        normal: &Vector,
        own: &Vector,
        on: &Vector,
        [feature1, feature2]: [Feature; 2],
        found: &SignedDistance,
    ) -> SignedDistance {
        let radius = self.body.shape.swept_radius();
        let lowest = own - normal * radius;
        let gap = normal.dot(&(lowest - on));
        // Points are right to some 8u of where they are, the normal to 8u, and so are the product and the radius.
        let error = 64.0 * UNIT_ROUNDOFF * (lowest.lp_norm(1) + on.lp_norm(1) + radius);
        SignedDistance {
            distance: gap,
            lower: gap - error,
            upper: gap + error,
            // The sum with +0 turns −0 into 0.
            normal: normal.add_scalar(0.0).into(),
            local1: local_point(self.body.pose, &lowest).into(),
            local2: self.reach.point(on).into(),
            world1: lowest.into(),
            world2: (*on).into(),
            feature1,
            feature2,
            ..*found
        }
    }

    /// Whether a point of the plane of the triangle, in the ground's frame, is in it, rounding included.
    fn is_over(&self, point: &Vector) -> bool {
        let farthest = self.triangle.own.corners.iter().map(|corner| corner.lp_norm(1)).fold(0.0, f64::max);
        is_inside(&self.triangle.own, point, -64.0 * UNIT_ROUNDOFF * (point.lp_norm(1) + farthest))
    }
}

/// The normal between two, across a side from `tail`, along which the lower of their lowest vertices is highest; how high that is,
/// and whose it is. `None` where it is at an end. It ignores how far points are along the side.
fn highest_between(one: &Low, other: &Low, tail: &Vector) -> Option<(Vector, f64, [u32; 2])> {
    // In the plane across the side, with the first normal ahead and the other to the left.
    let ahead = one.normal;
    let left = other.normal - ahead * ahead.dot(&other.normal);
    let left = left / left.norm();
    let flat = |v: &Vector| [v.dot(&ahead), v.dot(&left)];
    let end = flat(&other.normal);
    let is_between = |[x, y]: [f64; 2]| y > 0.0 && x * end[1] - y * end[0] > 0.0;
    let along = |[x, y]: [f64; 2], point: [f64; 2]| x * point[0] + y * point[1];
    let [p, q] = [one.point, other.point].map(|point| flat(&(point - tail)));
    let unit = |[x, y]: [f64; 2]| {
        let norm = length(&Vector::new(x, y, 0.0));
        [x / norm, y / norm]
    };
    let mut best: Option<([f64; 2], f64, [u32; 2])> = None;
    let mut consider = |way: [f64; 2], height: f64, vertices: [u32; 2]| {
        if is_between(way) && best.is_none_or(|(_, before, _)| height > before) {
            best = Some((way, height, vertices));
        }
    };
    // Straight towards one of them where the other is no lower.
    for (own, beside, vertex) in [(p, q, one.vertex), (q, p, other.vertex)] {
        let way = unit(own);
        if along(way, own) <= along(way, beside) {
            consider(way, along(way, own), [vertex; 2]);
        }
    }
    // Where both are as high.
    if one.vertex != other.vertex {
        let way = unit([p[1] - q[1], q[0] - p[0]]);
        for way in [way, way.map(|x| -x)] {
            consider(way, along(way, p).min(along(way, q)), [one.vertex, other.vertex]);
        }
    }
    let ([x, y], height, vertices) = best?;
    // A NaN is no bound.
    (height.is_finite()).then(|| ((ahead * x + left * y).normalize(), height, vertices))
}

/// Where a side from the origin and a line from a point are nearest, as parts of them, and whether that is on both. A line of no
/// length is a point.
fn nearest_of_lines(from: &Vector, side: &Vector, line: &Vector) -> ([f64; 2], bool) {
    let across = side.cross(line);
    let square = across.norm_squared();
    let parts = if *line == Vector::zeros() {
        [from.dot(side) / side.norm_squared(), 0.0]
    } else {
        [from.cross(line).dot(&across) / square, from.cross(side).dot(&across) / square]
    };
    // A NaN, of lines that are parallel, is on neither.
    let is_on_both = parts.iter().all(|part| (0.0..=1.0).contains(part));
    if is_on_both { (parts, true) } else { ([0.0; 2], false) }
}
