//! Contacts of a body with a ground, with normals of the surface.

use super::PlacedGround;
use super::allowed::Search;
use super::answer::GroundContacts;
use super::corner::{Behind, behind_face};
use super::grouping::{group, least_gap};
use super::inside::{nearest_point, triangle_over};
use super::lowest::{Limit, Lowest};
use super::normals::TILT;
use super::reach::Reach;
use super::room::{Room, Touch};
use super::tree::{Bounds, Visit};
use super::vertices::Vertices;
use crate::base::error::Result;
use crate::base::math::Vector;
use crate::base::memory::push;
use crate::base::simd::environment::with_default;
use crate::manifold::{ManifoldConfig, ManifoldPoint, add_points, manifold_along, witness};
use crate::pair::{self, Outcome, PairAnswer, PairCache, PairConfig, Placed, SignedDistance, SignedDistanceCache};
use crate::shape::{Triangle, TriangleShape};

/// Finds the contacts of a body, which is object 1, with a ground that it meets or is up to `config.max_distance` apart from.
/// Writes them over the contents of `found`.
///
/// The ground pushes out of the front of its triangles. A triangle acts on bodies whose centre of mass is not behind its plane, or
/// not by more than the [thickness](crate::ground::Ground::with_thickness) of the ground.
/// The normal of a contact is the one along which the body and the triangle are nearest, or overlap least, of those in the normal
/// cone of the surface at the touched point. So no contact holds up a body that slides over a flat or concave edge, and none is
/// much deeper than the body is in. Contacts with one normal are one, however many triangles they are on.
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
        let reach = Reach::new(body, ground)?;
        let bounds = reach.bounds;
        let within = PairConfig { max_distance: config.max_distance, ..PairConfig::default() };
        let Room { triangle, touches, points, vertices, .. } = &mut found.room;
        let vertices = Vertices::place(body, vertices)?;
        touches.clear();
        points.clear();
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
            lowest: 0,
            missed: None,
        };
        ground.ground.tree().walk(&bounds, &mut meeting)?;
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
    reach: &'a Reach,
    within: PairConfig,
    all: ManifoldConfig,
    /// The query's triangle.
    shape: &'a mut TriangleShape,
    touches: &'a mut Vec<Touch>,
    points: &'a mut Vec<ManifoldPoint>,
    /// The vertex that was lowest over the last triangle.
    lowest: u32,
    /// Of the contacts with triangles that have no points over them the one that overlaps least.
    missed: Option<(u32, SignedDistance)>,
}

impl Visit for Meeting<'_> {
    fn goes_to(&mut self, _: &Bounds, gap: f64) -> bool {
        gap * self.reach.stretch <= self.all.max_distance
    }

    fn triangle(&mut self, triangle: u32) -> Result<bool> {
        let own = self.ground.ground.triangle(triangle);
        let is_behind = own.normal.dot(&(self.reach.centre - own.corners[0])) < -self.ground.ground.thickness();
        if is_behind || !self.is_near(&Bounds::of(&own.corners)) {
            return Ok(true);
        }
        let nearest = match self.nearest(&own)? {
            Found::Beyond => return Ok(true),
            Found::Nearest(nearest) => Some(nearest),
            Found::Meeting => None,
        };
        let is_allowed = |nearest: &SignedDistance| {
            let normal = self.reach.local_normal(&nearest.normal.into());
            self.ground.ground.allows(triangle, &normal)
        };
        if let Some(nearest) = nearest.filter(is_allowed) {
            self.touch(triangle, &nearest, true, None)?;
            return Ok(true);
        }
        let search = Search::new(self.vertices, self.ground, self.reach, &own);
        let best = search.best(self.lowest);
        let gap = best.gap - self.body.shape.swept_radius();
        let found = nearest.unwrap_or(SignedDistance { outcome: Outcome::Intersecting, ..SignedDistance::default() });
        let is_met = found.outcome == Outcome::Intersecting;
        // What is apart, but behind the triangle along all of its normals by more than rounding, is before another one.
        let rounding = TILT * self.body.shape.polyhedron().radius;
        if !(is_met || gap > -rounding) || gap > self.all.max_distance {
            return Ok(true);
        }
        let (contact, is_over) = search.contact(&best, &found);
        let beside = (is_met && !is_over).then(|| witness(&contact));
        if self.touch(triangle, &contact, is_over, beside)? {
            return Ok(true);
        }
        // The lowest vertex is beside the triangle, and no faces meet over it: another point of the body may be below it.
        if best.is_along_own_normal() {
            let nearest = if nearest.is_some() { found } else { self.signed_distance()? };
            if let Some(inner) = search.inner(&best, &nearest) {
                self.touch(triangle, &inner, true, beside)?;
                return Ok(true);
            }
        }
        let is_less = self.missed.is_none_or(|(_, missed)| contact.upper > missed.upper);
        if is_met && is_less {
            self.missed = Some((triangle, contact));
        }
        Ok(true)
    }
}

/// What is known of a body and a triangle.
enum Found {
    /// They are farther apart than `max_distance`.
    Beyond,
    Nearest(SignedDistance),
    /// They have points in common; how deep they are is open.
    Meeting,
}

impl Meeting<'_> {
    fn is_near(&mut self, bounds: &Bounds) -> bool {
        self.goes_to(bounds, bounds.gap(&self.reach.bounds))
    }

    /// How near the body is to a triangle, which is shown unless that is beyond `max_distance`.
    fn nearest(&mut self, own: &Triangle) -> Result<Found> {
        let up = self.reach.world_normal(&own.normal);
        let lowest = Lowest::new(&self.vertices, self.ground, own, &up, self.lowest);
        self.lowest = lowest.vertex;
        let limit = Limit { radius: self.body.shape.swept_radius(), max_distance: self.all.max_distance };
        if limit.is_beyond(lowest.lower) {
            return Ok(Found::Beyond);
        }
        let is_meeting = lowest.is_through(self.body, own, self.reach);
        let mut contact = if is_meeting { None } else { lowest.contact(self.body, own, self.reach, limit) };
        if contact.is_none() && !is_meeting {
            contact = match behind_face(self.body, self.ground, own, &lowest, limit) {
                Behind::Beyond => return Ok(Found::Beyond),
                Behind::Nearest(contact) => Some(contact),
                Behind::Meets => {
                    self.shape.show(own);
                    return Ok(Found::Meeting);
                }
                Behind::Open if self.is_aside(own, limit) => return Ok(Found::Beyond),
                Behind::Open => None,
            };
        }
        self.shape.show(own);
        if is_meeting {
            return Ok(Found::Meeting);
        }
        if let Some(contact) = contact {
            return Ok(Found::Nearest(contact));
        }
        // That takes longer than all before.
        if limit.radius == 0.0 {
            let bodies = [self.body, self.shape.complete().at(self.ground.pose)];
            let mut answer = PairAnswer::default();
            pair::distance(bodies, &mut PairCache::default(), &self.within, &mut answer)?;
            return Ok(match answer.outcome {
                Outcome::Intersecting => Found::Meeting,
                Outcome::Beyond => Found::Beyond,
                _ => Found::Nearest((&answer).into()),
            });
        }
        let contact = self.signed_distance()?;
        Ok(if contact.outcome == Outcome::Beyond { Found::Beyond } else { Found::Nearest(contact) })
    }

    /// Whether the body is beyond `max_distance` along the way from the triangle to its centre, or to the vertex that is lowest
    /// there.
    fn is_aside(&self, own: &Triangle, limit: Limit) -> bool {
        let (mut point, mut vertex) = (self.reach.centre, self.lowest);
        (0..2).any(|_| {
            let way = point - nearest_point(&own.corners, &point).0;
            let up = self.ground.pose.rotate(&way);
            let length = up.norm();
            if !(length > f64::MIN_POSITIVE.sqrt()) {
                return false;
            }
            let lowest = Lowest::new(&self.vertices, self.ground, own, &(up / length), vertex);
            (point, vertex) = (self.reach.point(&lowest.world), lowest.vertex);
            limit.is_beyond(lowest.lower)
        })
    }

    /// The signed distance of the body and the triangle that is shown.
    fn signed_distance(&mut self) -> Result<SignedDistance> {
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
        triangle: u32,
        contact: &SignedDistance,
        is_over: bool,
        beside: Option<ManifoldPoint>,
    ) -> Result<bool> {
        let bodies = [self.body, self.shape.shown().at(self.ground.pose)];
        let first_point = self.points.len();
        // A point that is not over the triangle is none of the points that faces have in common, however deep it is.
        let far = SignedDistance { lower: f64::INFINITY, upper: f64::INFINITY, ..*contact };
        let along = if is_over { contact } else { &far };
        let mut manifold = add_points(self.points, |sink| manifold_along(bodies, along, &self.all, sink))?;
        // Without a reference it is the contact's own pair of points.
        if manifold.reference == 0 && !is_over {
            self.points.truncate(first_point);
            return Ok(false);
        }
        (manifold.lower, manifold.upper) = least_gap(&self.points[first_point..]);
        push(self.touches, Touch { triangle, manifold, first_point, beside })?;
        Ok(true)
    }

    fn is_met(&self) -> bool {
        self.touches.iter().any(|touch| touch.manifold.outcome == Outcome::Intersecting)
    }

    /// A body that meets the ground has a contact, if only beside the triangle.
    fn keep_missed(&mut self) -> Result<()> {
        if let Some((triangle, contact)) = self.missed.filter(|_| !self.is_met()) {
            self.shape.show(&self.ground.ground.triangle(triangle));
            self.touch(triangle, &contact, true, None)?;
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
        let own = self.ground.ground.triangle(triangle);
        let contact = Search::new(self.vertices, self.ground, self.reach, &own).push_from_behind();
        // Its centre may be inside where the body is not, as that of an open surface.
        if contact.upper >= 0.0 {
            return Ok(());
        }
        self.shape.show(&own);
        self.touch(triangle, &contact, true, None)?;
        Ok(())
    }

    /// Leaves out contacts whose triangles a body no longer meets once another contact has pushed it out, if they are certainly
    /// more than twice as deep as that or push it back.
    fn leave_out_needless(&mut self) {
        let most_deep = |touch: &Touch| -touch.least_gap()[0];
        self.touches.sort_unstable_by(|a, b| most_deep(a).total_cmp(&most_deep(b)).then(a.triangle.cmp(&b.triangle)));
        let first = self.touches.iter().take_while(|touch| touch.least_gap()[1] >= 0.0).count();
        let mut kept = first;
        for at in first..self.touches.len() {
            let touch = &self.touches[at];
            let (normal, deep) = (Vector::from(touch.manifold.normal), -touch.least_gap()[1]);
            let is_needless = self.touches[first..kept].iter().any(|other| {
                let is_back = normal.dot(&Vector::from(other.manifold.normal)) < 0.0;
                (deep > 2.0 * most_deep(other) || is_back && deep > 0.0) && self.frees(other, touch.triangle)
            });
            if !is_needless {
                self.touches.swap(kept, at);
                kept += 1;
            }
        }
        self.touches.truncate(kept);
    }

    /// Whether a body that a contact has pushed out is clear of a triangle along the contact's normal.
    fn frees(&self, contact: &Touch, triangle: u32) -> bool {
        let normal = Vector::from(contact.manifold.normal);
        let vertex = self.vertices.lowest(&normal, 0);
        let low = normal.dot(&self.vertices.point(vertex)) - self.body.shape.swept_radius();
        let corners = self.ground.ground.triangle(triangle).corners;
        let heights = corners.map(|corner| normal.dot(&self.ground.pose.transform(&corner)));
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        low - contact.least_gap()[0] >= high - TILT * self.body.shape.polyhedron().radius
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
