//! Contacts of a body with a ground, with normals of the surface.

use super::PlacedGround;
use super::answer::GroundContacts;
use super::corner::{Behind, behind_face};
use super::grouping::group;
use super::lowest::{Lowest, Margin, local_point};
use super::reach::{LEAST_STRETCH, Reach};
use super::room::{Room, Touch};
use super::tree::{Bounds, Visit};
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector, is_unit};
use crate::base::memory::push;
use crate::base::simd::environment::with_default;
use crate::pair::{
    self, DepthAnswer, DepthCache, DepthConfig, Feature, FeatureKind, ManifoldConfig, ManifoldPoint, Outcome,
    PairConfig, Placed, SignedDistance, SignedDistanceCache, add_points, manifold_along,
};
use crate::shape::{Triangle, TriangleShape};

/// Finds the contacts of a body, which is object 1, with a ground that it meets or is up to `config.margin` apart from. Writes
/// them over the contents of `found`.
///
/// The ground pushes out of the front of its triangles. A triangle acts on bodies whose centre of mass is not behind its plane.
/// The normal of a contact is the one along which the body and the triangle are nearest, or overlap least, if that is in the
/// normal cone of the surface at the touched point; else it is the triangle's. So no contact holds up a body that slides over a
/// flat or concave edge. Contacts with one normal are one, however many triangles they are on.
///
/// A gap is that of the body's point over the point on the triangle, along the normal, and holds for them. Whether a body touches a
/// triangle is as certain as [`pair::signed_distance`] says. There is no cache, so that four points of a reduced contact are chosen
/// anew each time.
///
/// # Errors
/// Same as [`pair::manifold`]; then `found` is empty. [`Error::Memory`](crate::base::error::Error::Memory).
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
        body.pose.check(config.rotation_limit)?;
        ground.pose.check(config.rotation_limit)?;
        let reach = Reach::new(body, ground)?;
        let bounds = reach.bounds;
        let within = PairConfig {
            distance_tolerance: config.margin,
            rotation_limit: config.rotation_limit,
            ..PairConfig::default()
        };
        let Room { triangle, touches, points, .. } = &mut found.room;
        touches.clear();
        points.clear();
        let shape = match triangle {
            Some(shape) => shape,
            None => triangle.insert(TriangleShape::new()?),
        };
        // Four points are chosen of all triangles' together.
        let all = ManifoldConfig { reduces: false, ..*config };
        let mut meeting = Meeting { body, ground, reach, within, all, shape, touches, points, lowest: 0, missed: None };
        ground.ground.tree().walk(&bounds, &mut meeting)?;
        meeting.keep_missed()?;
        group(found, config.reduces, body.shape.polyhedron().radius)
    })
}

/// The findings of a walk over the triangles near a body.
struct Meeting<'a> {
    body: Placed<'a>,
    ground: PlacedGround<'a>,
    reach: Reach,
    within: PairConfig,
    all: ManifoldConfig,
    /// The query's triangle.
    shape: &'a mut TriangleShape,
    touches: &'a mut Vec<Touch>,
    points: &'a mut Vec<ManifoldPoint>,
    /// The vertex that was lowest over the last triangle.
    lowest: u32,
    /// The deepest contact along the normal of a triangle that has no points over it.
    missed: Option<(u32, SignedDistance)>,
}

impl Visit for Meeting<'_> {
    fn goes_to(&mut self, gap: f64) -> bool {
        gap * LEAST_STRETCH <= self.all.margin
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        let is_behind = own.normal.dot(&(self.reach.centre - own.corners[0])) < 0.0;
        if is_behind || !self.goes_to(Bounds::of(&own.corners).gap(&self.reach.bounds)) {
            return Ok(true);
        }
        let Some(mut contact) = self.nearest(&own)? else { return Ok(true) };
        let normal = self.reach.local_normal(&contact.normal.into());
        let is_allowed = self.ground.ground.allows(triangle, &normal);
        let is_over = is_allowed || {
            let up = self.reach.world_normal(&own.normal);
            let corner = self.ground.pose.transform(&own.corners[0]);
            contact = along(&up, &corner, &contact, &self.body);
            let foot = self.reach.point(&contact.world2.into());
            contact.local2 = foot.into();
            contact.feature2 = Feature { kind: FeatureKind::Face, ids: [triangle, 0] };
            is_over(&own.corners, &own.normal, &foot)
        };
        self.touch(triangle, &contact, is_over)?;
        Ok(true)
    }
}

impl Meeting<'_> {
    /// The signed distance of the body and a triangle, which is shown; `None` beyond the margin.
    fn nearest(&mut self, own: &Triangle) -> Result<Option<SignedDistance>> {
        let lowest = Lowest::new(self.body, self.ground, own, &self.reach, self.lowest);
        self.lowest = lowest.vertex;
        let margin = Margin { radius: self.body.shape.swept_radius(), margin: self.all.margin };
        if margin.is_beyond(lowest.lower) {
            return Ok(None);
        }
        let mut contact = lowest.contact(self.body, own, &self.reach, margin);
        if contact.is_none() {
            contact = match behind_face(self.body, self.ground, own, &lowest, margin) {
                Behind::Beyond => return Ok(None),
                Behind::Nearest(contact) => Some(contact),
                Behind::Open => None,
            };
        }
        self.shape.show(own);
        if contact.is_some() {
            return Ok(contact);
        }
        // That takes longer than all before.
        let bodies = [self.body, self.shape.complete().at(self.ground.pose)];
        if lowest.is_through(own, &self.reach) {
            let config = DepthConfig { rotation_limit: self.within.rotation_limit, ..DepthConfig::default() };
            let mut deep = DepthAnswer::default();
            pair::depth(bodies, &mut DepthCache::default(), &config, &mut deep)?;
            if deep.outcome == Outcome::Intersecting {
                return Ok(Some((&deep).into()));
            }
        }
        let mut contact = SignedDistance::default();
        pair::signed_distance(bodies, &mut SignedDistanceCache::default(), &self.within, &mut contact)?;
        Ok(Some(contact).filter(|contact| contact.outcome != Outcome::Beyond))
    }
}

impl Meeting<'_> {
    /// Notes where faces meet along a contact's normal; where they do not, the contact's own points if they are over the triangle.
    fn touch(&mut self, triangle: u32, contact: &SignedDistance, is_over: bool) -> Result<()> {
        let bodies = [self.body, self.shape.shown().at(self.ground.pose)];
        let first_point = self.points.len();
        // A point that is not over the triangle is none of the points that faces have in common, however deep it is.
        let far = SignedDistance { lower: f64::INFINITY, upper: f64::INFINITY, ..*contact };
        let along = if is_over { contact } else { &far };
        let manifold = add_points(self.points, |sink| manifold_along(bodies, along, &self.all, sink))?;
        // Without a reference it is the contact's own pair of points.
        if manifold.reference == 0 && !is_over {
            self.points.truncate(first_point);
            let is_deeper = self.missed.is_none_or(|(_, missed)| contact.upper < missed.upper);
            if contact.outcome == Outcome::Intersecting && is_deeper {
                self.missed = Some((triangle, *contact));
            }
            return Ok(());
        }
        push(self.touches, Touch { triangle, manifold, first_point })
    }

    /// A body that meets the ground has a contact, if only beside the triangle.
    fn keep_missed(&mut self) -> Result<()> {
        let is_met = self.touches.iter().any(|touch| touch.manifold.outcome == Outcome::Intersecting);
        if let Some((triangle, contact)) = self.missed.filter(|_| !is_met) {
            self.shape.show(&self.ground.ground.triangle(triangle));
            self.touch(triangle, &contact, true)?;
        }
        Ok(())
    }
}

/// A contact turned to the normal of its triangle, given one of the triangle's corners in the world. Its points are a low point
/// of the body, the witness point unless it was above, and the point below that on the plane. `lower` and `upper` become its
/// height over the plane.
fn along(up: &Vector, corner: &Vector, contact: &SignedDistance, body: &Placed) -> SignedDistance {
    debug_assert!(is_unit(up));
    let (polyhedron, radius) = (body.shape.polyhedron(), body.shape.swept_radius());
    let normal = Vector::from(contact.normal);
    // A point of the polyhedron; from there it is the radius to the ball's lowest.
    let (own, feature1) = if normal.dot(up) > 0.0 {
        (Vector::from(contact.world1) + normal * radius, contact.feature1)
    } else {
        let (vertex, _) = polyhedron.support(&body.pose.rotate_back(&-up), 0);
        let feature = Feature { kind: FeatureKind::Vertex, ids: [polyhedron.vertex_labels[vertex as usize], 0] };
        (body.pose.transform(&polyhedron.local_position(vertex)), feature)
    };
    let lowest = own - up * radius;
    let height = up.dot(&(lowest - corner));
    // Points are right to some 8u of where they are, the normal to 8u, and so are the product and the radius.
    let error = 64.0 * UNIT_ROUNDOFF * (lowest.lp_norm(1) + corner.lp_norm(1) + radius);
    SignedDistance {
        distance: height,
        lower: height - error,
        upper: height + error,
        normal: (*up).into(),
        local1: local_point(body.pose, &lowest).into(),
        world1: lowest.into(),
        world2: (lowest - up * height).into(),
        feature1,
        ..*contact
    }
}

/// Whether a point of the plane of a triangle is in it, rounding included.
fn is_over(corners: &[Vector; 3], normal: &Vector, point: &Vector) -> bool {
    debug_assert!(is_unit(normal));
    (0..3).all(|k| {
        let [tail, head] = [corners[k], corners[(k + 1) % 3]];
        let inward = normal.cross(&(head - tail));
        let rounding = 64.0 * UNIT_ROUNDOFF * (point.lp_norm(1) + tail.lp_norm(1));
        inward.dot(&(point - tail)) >= -rounding * inward.norm()
    })
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
        let (config, mut most) = (ManifoldConfig { margin: 1.0, ..ManifoldConfig::default() }, 0);
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
