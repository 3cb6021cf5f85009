//! Contacts of a body with a ground, with normals of the surface.

use super::PlacedGround;
use super::allowed::NormalSearch;
use super::answer::GroundContacts;
use super::common::{Meet, add_common};
use super::corner::{FaceVerdict, behind_face};
use super::facing::FacingFaces;
use super::footing::{Footing, Stand};
use super::grouping::{group, least_gap};
use super::inside::triangle_over;
use super::lowest::{Limit, Lowest, PlacedTriangle, inside_by};
use super::normals::TILT;
use super::reach::GroundReach;
use super::room::{Room, TriangleTouch};
use super::simplex::{self, NearestOfTriangle};
use super::vertices::Vertices;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::push;
use crate::base::simd::environment::with_default;
use crate::manifold::{Manifold, ManifoldConfig, ManifoldPoint, add_points, manifold_along, witness};
use crate::pair::{
    self, FeatureKind, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance, SignedDistanceCache,
};
use crate::shape::{Triangle, TriangleShape};

/// Finds the contacts of a body, which is object 1, with a ground that it meets or is up to `config.max_distance` apart from.
/// Writes them over the contents of `found`.
///
/// The ground pushes out of the front of its triangles. A triangle acts on bodies whose centre of mass is not behind its plane, or
/// not by more than the [thickness](crate::ground::Ground::with_thickness) of the ground.
/// The normal of a contact is the one along which the body and the triangle are nearest, or overlap least, of those in the normal
/// cone of the surface at the touched point. So no contact holds up a body that slides over a flat or concave edge, and none is
/// much deeper than the body is in. Contacts with one normal are one, however many triangles they are on; where each neighbour of a
/// triangle is in its plane, points are corners of the body.
///
/// A gap is that of the body's point over the point on the triangle, along the normal, and holds for them. Whether a body touches a
/// triangle is as certain as [`pair::signed_distance`] says. There is no cache, so that four points of a reduced contact are chosen
/// anew each time.
///
/// # Errors
/// Same as `manifold::manifold`; then `found` is empty. [`Error::Memory`](crate::base::error::Error::Memory).
pub fn ground_contacts(
    body: Placed,
    ground: PlacedGround,
    config: &ManifoldConfig,
    found: &mut GroundContacts,
) -> Result<()> {
    found.contacts.clear();
    found.points.clear();
    let asked = add_contacts(body, ground, config, found);
    if asked.is_err() {
        found.contacts.clear();
        found.points.clear();
    }
    asked
}

/// The same, appended to the contents of `found`; contacts that are there after a refusal are part of it.
///
/// # Errors
/// Same as [`ground_contacts`].
pub(crate) fn add_contacts(
    body: Placed,
    ground: PlacedGround,
    config: &ManifoldConfig,
    found: &mut GroundContacts,
) -> Result<()> {
    with_default(|| {
        config.check()?;
        body.pose.check()?;
        ground.pose.check()?;
        body.shape.refuse_deviation("contacts with grounds")?;
        let reach = GroundReach::new(body, ground)?;
        let (bounds, enough) = (reach.bounds, config.max_distance / reach.stretch);
        let within = PairConfig { max_distance: config.max_distance, ..PairConfig::default() };
        let Room { triangle, touches, points, vertices, passed, facing, .. } = &mut found.room;
        let vertices = Vertices::place(body, vertices)?;
        touches.clear();
        points.clear();
        passed.clear();
        let shape = match triangle {
            Some(shape) => shape,
            None => triangle.insert(ground.ground.triangle_shape().copy()?),
        };
        // Four points are chosen of all triangles' together.
        let all = ManifoldConfig { reduces: false, ..*config };
        let mut meeting = Meeting {
            body,
            vertices,
            ground,
            reach: &reach,
            within,
            all,
            shape,
            touches,
            points,
            enough,
            lowest: 0,
            footing: Footing::new(reach.size),
            facing: FacingFaces::new(facing),
            passed,
            passed_through: false,
            looks_again: false,
            missed: None,
        };
        let box_near = bounds.grown(enough);
        ground.ground.layout().overlapping(&box_near, |triangle| meeting.visit(triangle))?;
        meeting.look_again()?;
        meeting.keep_missed()?;
        meeting.push_out()?;
        meeting.leave_out_needless();
        group(found, config.reduces, body.shape.polyhedron().radius)
    })
}

/// The findings of a walk over the triangles near a body.
struct Meeting<'a> {
    body: Placed<'a>,
    vertices: Vertices<'a>,
    ground: PlacedGround<'a>,
    reach: &'a GroundReach,
    within: PairConfig,
    all: ManifoldConfig,
    /// The query's triangle.
    shape: &'a mut TriangleShape,
    touches: &'a mut Vec<TriangleTouch>,
    points: &'a mut Vec<ManifoldPoint>,
    /// `max_distance`, in the frame of the ground.
    enough: f64,
    /// The vertex that was lowest over the last triangle.
    lowest: u32,
    footing: Footing,
    facing: FacingFaces<'a>,
    /// Triangles inside a plane that no corner of the body is over, and whether the body may reach through one.
    passed: &'a mut Vec<u32>,
    passed_through: bool,
    looks_again: bool,
    /// The contact that overlaps least, among those with triangles that have no points over them.
    missed: Option<(u32, SignedDistance)>,
}

impl Meeting<'_> {
    /// Comes to a triangle.
    fn visit(&mut self, triangle: u32) -> Result<()> {
        let ground = self.ground.ground;
        let own = ground.triangle(triangle);
        let is_behind = own.normal.dot(&(self.reach.centre - own.corners[0])) < -ground.thickness();
        if is_behind
            || self.reach.is_over(&own.normal, &own.corners[0], self.enough)
            || self.reach.is_beside(&own.corners, self.enough)
        {
            return Ok(());
        }
        let placed = PlacedTriangle::new(own, self.ground, self.reach);
        if placed.marks.is_inner() {
            match self.footing.stand(&self.vertices, &placed, self.limit()) {
                Stand::Over => {}
                Stand::Beyond => return Ok(()),
                stand => {
                    self.passed_through |= stand == Stand::Through;
                    return push(self.passed, triangle);
                }
            }
        }
        self.meet(&placed)
    }

    /// Looks at triangles that were passed by, where what is around them tells nothing of the body: a contact is to be found, or
    /// whether it meets the ground.
    fn look_again(&mut self) -> Result<()> {
        if self.touches.is_empty() || self.passed_through && !self.is_met() {
            self.looks_again = true;
            for at in 0..self.passed.len() {
                let own = self.ground.ground.triangle(self.passed[at]);
                self.meet(&PlacedTriangle::new(own, self.ground, self.reach))?;
            }
        }
        Ok(())
    }

    /// Finds the contact with a triangle.
    fn meet(&mut self, placed: &PlacedTriangle) -> Result<()> {
        let triangle = placed.own.label;
        let search = NormalSearch::new(self.vertices, self.ground, self.reach, placed);
        let (nearest, best) = match self.nearest(placed)? {
            TriangleFinding::Beyond => return Ok(()),
            TriangleFinding::Nearest(nearest) => {
                let normal = self.reach.local_normal(&nearest.normal.into());
                if self.ground.ground.allows(&placed.own, &normal) {
                    self.touch(placed, &nearest, true, None)?;
                    return Ok(());
                }
                (Some(nearest), search.best(self.lowest, &mut self.facing)?)
            }
            TriangleFinding::Meeting => (None, search.best(self.lowest, &mut self.facing)?),
            TriangleFinding::Through => (None, search.own(self.lowest)),
        };
        let gap = best.gap - self.body.shape.swept_radius();
        let found = nearest.unwrap_or(SignedDistance { outcome: Outcome::Intersecting, ..SignedDistance::default() });
        let is_met = found.outcome == Outcome::Intersecting;
        // What is apart, but behind the triangle along all of its normals by more than rounding, is before another one.
        let rounding = TILT * self.body.shape.polyhedron().radius;
        if !(is_met || gap > -rounding) || gap > self.all.max_distance {
            return Ok(());
        }
        let (contact, is_over) = search.contact(&best, &found);
        let beside = (is_met && !is_over).then(|| witness(&contact));
        if self.touch(placed, &contact, is_over, beside)? {
            return Ok(());
        }
        // The lowest vertex is beside the triangle, and no faces meet over it: another point of the body may be below it.
        if best.is_along_own_normal() && self.keeps_inner(placed) {
            let nearest = if nearest.is_some() { found } else { self.signed_distance(&placed.own)? };
            if let Some(inner) = search.inner(&best, &nearest) {
                self.touch(placed, &inner, true, beside)?;
                return Ok(());
            }
        }
        let is_less = self.missed.is_none_or(|(_, missed)| contact.upper > missed.upper);
        if is_met && is_less {
            self.missed = Some((triangle, contact));
        }
        Ok(())
    }
}

/// The relation of a body and a triangle.
enum TriangleFinding {
    /// They are farther apart than `max_distance`.
    Beyond,
    Nearest(SignedDistance),
    /// They have points in common; how deep they are is open.
    Meeting,
    /// The same, and they overlap least along the triangle's own normal.
    Through,
}

impl Meeting<'_> {
    fn limit(&self) -> Limit {
        Limit { radius: self.body.shape.swept_radius(), max_distance: self.all.max_distance }
    }

    /// How near the body is to a triangle. Sets the lowest vertex.
    fn nearest(&mut self, triangle: &PlacedTriangle) -> Result<TriangleFinding> {
        let lowest = Lowest::new(&self.vertices, triangle, &triangle.up, self.lowest);
        self.lowest = lowest.vertex;
        let limit = self.limit();
        if limit.is_beyond(lowest.lower) {
            return Ok(TriangleFinding::Beyond);
        }
        let inside = inside_by(triangle, &(lowest.world - lowest.up * lowest.height));
        if lowest.is_through(&self.reach.centre_in_world, triangle) {
            return Ok(if lowest.is_least(triangle, inside) {
                TriangleFinding::Through
            } else {
                TriangleFinding::Meeting
            });
        }
        if let Some(contact) = lowest.contact(self.body, &triangle.own, self.reach, limit, inside) {
            return Ok(TriangleFinding::Nearest(contact));
        }
        match behind_face(self.body, self.reach, triangle, &lowest, limit) {
            FaceVerdict::Beyond => return Ok(TriangleFinding::Beyond),
            FaceVerdict::Nearest(contact) => return Ok(TriangleFinding::Nearest(contact)),
            FaceVerdict::Meets => return Ok(TriangleFinding::Meeting),
            FaceVerdict::Open => {}
        }
        match simplex::nearest(&self.vertices, self.reach, triangle, &lowest, limit) {
            NearestOfTriangle::Beyond => return Ok(TriangleFinding::Beyond),
            NearestOfTriangle::Apart(contact) => return Ok(TriangleFinding::Nearest(contact)),
            NearestOfTriangle::Meeting if limit.radius == 0.0 => return Ok(TriangleFinding::Meeting),
            NearestOfTriangle::Meeting | NearestOfTriangle::Open => {}
        }
        // That takes longer than all before.
        if limit.radius == 0.0 {
            self.shape.show(&triangle.own);
            let bodies = [self.body, self.shape.complete().at(self.ground.pose)];
            let mut answer = PairAnswer::default();
            pair::distance(bodies, &mut PairCache::default(), &self.within, &mut answer)?;
            return Ok(match answer.outcome {
                Outcome::Intersecting => TriangleFinding::Meeting,
                Outcome::Beyond => TriangleFinding::Beyond,
                _ => TriangleFinding::Nearest((&answer).into()),
            });
        }
        let contact = self.signed_distance(&triangle.own)?;
        Ok(if contact.outcome == Outcome::Beyond { TriangleFinding::Beyond } else { TriangleFinding::Nearest(contact) })
    }

    /// The signed distance of the body and a triangle.
    fn signed_distance(&mut self, triangle: &Triangle) -> Result<SignedDistance> {
        self.shape.show(triangle);
        let bodies = [self.body, self.shape.complete().at(self.ground.pose)];
        let mut contact = SignedDistance::default();
        pair::signed_distance(bodies, &mut SignedDistanceCache::default(), &self.within, &mut contact)?;
        Ok(contact)
    }
}

impl Meeting<'_> {
    /// Notes where faces meet along a contact's normal; where they do not, the contact's own points if they are over the triangle.
    /// Whether there are any.
    fn touch(
        &mut self,
        triangle: &PlacedTriangle,
        contact: &SignedDistance,
        is_over: bool,
        beside: Option<ManifoldPoint>,
    ) -> Result<bool> {
        let first_point = self.points.len();
        let (body, reach, max_distance) = (&self.vertices, self.reach, self.all.max_distance);
        let keeps_inner = self.keeps_inner(triangle);
        let normal = Vector::from(contact.normal);
        let lowest = body.lowest(&normal, 0);
        let meet = Meet { body, reach, triangle, contact, lowest, is_over, keeps_inner, max_distance };
        let reference = match add_common(&meet, self.points)? {
            Some(reference) => reference,
            None => {
                self.shape.show(&triangle.own);
                let bodies = [self.body, self.shape.shown().at(self.ground.pose)];
                // A point that is not over the triangle is none of the points that faces have in common, however deep it is.
                let far = SignedDistance { lower: f64::INFINITY, upper: f64::INFINITY, ..*contact };
                let along = if is_over { contact } else { &far };
                let found = add_points(self.points, |sink| manifold_along(bodies, along, &self.all, sink))?;
                if keeps_inner || found.reference == 0 {
                    found.reference
                } else {
                    self.leave_corners(first_point, contact, is_over)?
                }
            }
        };
        // Without a reference it is the contact's own pair of points.
        if reference == 0 && !is_over {
            self.points.truncate(first_point);
            return Ok(false);
        }
        let (lower, upper) = least_gap(&self.points[first_point..]);
        let count = (self.points.len() - first_point) as u32;
        let outcome = contact.outcome;
        let manifold = Manifold {
            outcome,
            reference,
            lower,
            upper,
            normal: contact.normal,
            point_count: count,
            found_count: count,
        };
        let lowest = normal.dot(&self.vertices.point(lowest));
        push(self.touches, TriangleTouch { triangle: triangle.own.label, manifold, first_point, lowest, beside })?;
        Ok(true)
    }

    /// Leaves out points that are no corners of the body, unless all are. The reference of those left.
    fn leave_corners(&mut self, first: usize, contact: &SignedDistance, is_over: bool) -> Result<u32> {
        let mut count = first;
        for at in first..self.points.len() {
            if self.points[at].feature1.kind == FeatureKind::Vertex {
                self.points[count] = self.points[at];
                count += 1;
            }
        }
        self.points.truncate(count);
        if count > first {
            return Ok(2);
        }
        if is_over {
            push(self.points, witness(contact))?;
        }
        Ok(0)
    }

    /// Whether what is on the inside of a triangle or on its sides makes points, beside the body's corners.
    fn keeps_inner(&self, triangle: &PlacedTriangle) -> bool {
        self.looks_again || !triangle.marks.is_inner()
    }

    fn is_met(&self) -> bool {
        self.touches.iter().any(|touch| touch.manifold.outcome == Outcome::Intersecting)
    }

    /// A body that meets the ground has a contact, if only beside the triangle.
    fn keep_missed(&mut self) -> Result<()> {
        if let Some((triangle, contact)) = self.missed.filter(|_| !self.is_met()) {
            let placed = PlacedTriangle::new(self.ground.ground.triangle(triangle), self.ground, self.reach);
            self.touch(&placed, &contact, true, None)?;
        }
        Ok(())
    }
}

impl Meeting<'_> {
    /// Pushes a body out of a solid ground in which it touches no triangle: by the nearest one, which its centre of mass is behind.
    fn push_out(&mut self) -> Result<()> {
        if self.is_met() || self.ground.ground.thickness() == 0.0 {
            return Ok(());
        }
        let Some(triangle) = triangle_over(self.ground.ground, &self.reach.centre)? else { return Ok(()) };
        let placed = PlacedTriangle::new(self.ground.ground.triangle(triangle), self.ground, self.reach);
        let contact = NormalSearch::new(self.vertices, self.ground, self.reach, &placed).push_from_behind();
        // Its centre may be inside where the body is not, as that of an open surface.
        if contact.upper >= 0.0 {
            return Ok(());
        }
        self.touch(&placed, &contact, true, None)?;
        Ok(())
    }

    /// Leaves out contacts whose triangles a body no longer meets once another contact has pushed it out, if they are certainly
    /// more than twice as deep as that or push it back.
    fn leave_out_needless(&mut self) {
        let most_deep = |touch: &TriangleTouch| -touch.least_gap()[0];
        self.touches.sort_unstable_by(|a, b| most_deep(a).total_cmp(&most_deep(b)).then(a.triangle.cmp(&b.triangle)));
        let first = self.touches.iter().take_while(|touch| touch.least_gap()[1] >= 0.0).count();
        let mut kept = first;
        for at in first..self.touches.len() {
            let touch = &self.touches[at];
            let (normal, deep) = (Vector::from(touch.manifold.normal), -touch.least_gap()[1]);
            let mut corners = None;
            let is_needless = self.touches[first..kept].iter().any(|other| {
                let is_back = normal.dot(&Vector::from(other.manifold.normal)) < 0.0;
                (deep > 2.0 * most_deep(other) || is_back && deep > 0.0) && {
                    let corners = corners.get_or_insert_with(|| {
                        let points = self.ground.ground.layout().points(touch.triangle);
                        points.map(|corner| self.ground.pose.transform(&corner))
                    });
                    self.frees(other, corners)
                }
            });
            if !is_needless {
                self.touches.swap(kept, at);
                kept += 1;
            }
        }
        self.touches.truncate(kept);
    }

    /// Whether a body that a contact has pushed out is clear of a triangle, along the contact's normal.
    fn frees(&self, contact: &TriangleTouch, corners: &[Vector; 3]) -> bool {
        let normal = Vector::from(contact.manifold.normal);
        let low = contact.lowest - self.body.shape.swept_radius();
        let heights = corners.map(|corner| normal.dot(&corner));
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        low - contact.least_gap()[0] >= high - TILT * self.body.shape.polyhedron().radius
    }
}

/// Bodies beside the triangles of hills.
#[cfg(test)]
pub(super) mod near_hills {
    use super::{GroundReach, PlacedTriangle, Vertices};
    use crate::base::math::{Pose, Vector};
    use crate::ground::surface::{Ground, HeightGrid};
    use crate::random::Random;
    use crate::shape::{Shape, ShapeOptions};

    /// A body and a triangle near it.
    pub struct Near<'a> {
        pub ground: &'a Ground,
        pub place: &'a Pose,
        pub vertices: &'a Vertices<'a>,
        pub reach: &'a GroundReach,
        pub triangle: &'a PlacedTriangle,
    }

    /// Boxes and round bodies over and in random hills that are turned, too; `judge` is called for each triangle near one.
    pub fn near_hills(seed: u64, rounds: usize, mut judge: impl FnMut(&Near, &mut Random)) {
        let mut random = Random::new(seed);
        for round in 0..if cfg!(miri) { 2 } else { rounds } {
            let steep = [0.1, 0.3, 1.0][round % 3];
            let heights: Vec<f64> = (0..49).map(|_| random.uniform(-steep, steep)).collect();
            let ground =
                Ground::from_heights(&HeightGrid { rows: 7, columns: 7, spacing: [1.0; 2], heights: &heights })
                    .unwrap();
            let points: Vec<Vector> = match round % 2 {
                0 => (0..8).map(|k| Vector::from_fn(|axis, _| if k >> axis & 1 == 0 { -0.6 } else { 0.6 })).collect(),
                _ => (0..30).map(|_| random.direction() * 0.7).collect(),
            };
            let shape = Shape::from_points(&points, &ShapeOptions::default()).unwrap();
            let place = Pose::new(&random.rotation(), &(random.vector() * 5.0));
            let turn = if round % 4 < 2 { random.rotation() } else { Pose::IDENTITY.rotation() };
            let over = Vector::new(random.uniform(2.0, 4.0), random.uniform(2.0, 4.0), random.uniform(0.3, 1.0));
            let pose = Pose::new(&(place.rotation() * turn), &place.transform(&over));
            let (body, placed, mut room) = (shape.at(&pose), ground.at(&place), Vec::new());
            let vertices = Vertices::place(body, &mut room).unwrap();
            let reach = GroundReach::new(body, placed).unwrap();
            for triangle in 0..ground.triangle_count() as u32 {
                let own = ground.triangle(triangle);
                let is_behind = own.normal.dot(&(reach.centre - own.corners[0])) < 0.0;
                if is_behind || own.corners.iter().all(|corner| (corner - over).norm() > 2.0) {
                    continue;
                }
                let triangle = &PlacedTriangle::new(own, placed, &reach);
                judge(
                    &Near { ground: &ground, place: &place, vertices: &vertices, reach: &reach, triangle },
                    &mut random,
                );
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::math::Pose;
    use crate::random::Random;
    use crate::shape::{Shape, ShapeOptions, TriangleShape};

    /// A manifold reads only the data of a triangle that [`TriangleShape::show`] moves: the rest is that of another triangle.
    #[test]
    fn a_manifold_needs_no_more_of_a_triangle_than_is_shown() {
        let mut random = Random::new(0x5ee);
        let corners: [Vector; 8] =
            std::array::from_fn(|k| Vector::new(k as f64 % 2.0, (k / 2) as f64 % 2.0, (k / 4) as f64));
        let cube = Shape::from_points(&corners, &ShapeOptions::default()).unwrap();
        let mut shape = TriangleShape::new().unwrap();
        let (config, mut most) = (ManifoldConfig { max_distance: 1.0, ..ManifoldConfig::default() }, 0);
        for _ in 0..300 {
            let corners: [Vector; 3] = std::array::from_fn(|_| random.vector() * 2.0);
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            let own = Triangle { corners, normal, labels: [4, 5, 6], label: 7 };
            let poses = [Pose::new(&random.rotation(), &(random.vector() * 0.5)), Pose::IDENTITY];
            let contact = SignedDistance {
                outcome: Outcome::Intersecting,
                lower: -1.0,
                upper: -1.0,
                local1: [0.0; 3],
                local2: corners[0].into(),
                world1: poses[0].translation().into(),
                world2: corners[0].into(),
                normal: normal.into(),
                ..SignedDistance::default()
            };
            let points_of = |triangle: &Shape| {
                let bodies = [cube.at(&poses[0]), triangle.at(&poses[1])];
                let mut points = Vec::new();
                let found = add_points(&mut points, |sink| manifold_along(bodies, &contact, &config, sink)).unwrap();
                (found, points)
            };
            shape.show(&own);
            let shown = points_of(shape.shown());
            assert_eq!(shown, points_of(shape.complete()));
            most = most.max(shown.1.len());
        }
        assert!(most > 3, "{most}");
    }
}
