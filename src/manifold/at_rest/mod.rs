//! The points that two patches have in common: the corners of one are slid along the normal onto the plane of the other, in the
//! axes of its body, and compared with its sides, as bits. So are those of the other, where any is needed. For a pair at rest the
//! facet of before proves the depth first.
//!
//! A corner on a side counts as inside, and no side crosses where it ends: so equal faces in line have their corners in common.
//! Many corners, corners nearly on a side and witness points that no corner is as deep as are left to
//! [the sweep](super::clip).

mod corners;
mod slid;
mod points;
mod clip;

use super::answer::{Manifold, ManifoldCache, ManifoldConfig, Reference};
use super::patch::{Facing, PARALLEL, Patch, Patches, STICKY, STICKY_INCIDENT, choose, facing};
use super::sink::Sink;
use super::steady::is_thin;
use super::witness::push_witness;
use crate::answer::Outcome;
use crate::base::math::UNIT_ROUNDOFF as U;
use crate::base::simd::{Kernel, Lanes};
use crate::depth::facets::{Facet, Proved};
use crate::depth::polytope::is_in_scale;
use crate::depth::prove_at_rest;
use crate::pair::{SignedDistance, fill_at_rest};
use crate::placed::Pair;
use crate::placed::frame::Frame;
use crate::shape::Placed;
use clip::ContactNormal;
pub use clip::Writing;

/// The query of a pair that may rest.
pub struct AtRest<'a, 'b> {
    pub bodies: &'a [Placed<'a>; 2],
    pub cache: &'a mut ManifoldCache,
    pub config: &'a ManifoldConfig,
    pub points: &'a mut Sink<'b>,
    /// Filled where a facet proves the depth, if it is asked for or the points are not found.
    pub contact: &'a mut SignedDistance,
    pub is_asked: bool,
}

/// The part of a query that is answered.
pub enum Answered {
    Nothing,
    /// The signed distance.
    Contact,
    /// All.
    Whole(Manifold),
}

impl Kernel for AtRest<'_, '_> {
    type Output = Answered;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Answered {
        let [body1, body2] = self.bodies;
        let polyhedra = [body1.shape.polyhedron(), body2.shape.polyhedron()];
        let frame = Frame::<L>::new(&Pair { polyhedra, poses: [body1.pose, body2.pose] });
        if !(frame.in_range && is_in_scale(polyhedra)) {
            return Answered::Nothing;
        }
        let depth = self.cache.signed_distance.depth_mut();
        let Some(proved) = prove_at_rest(&frame, depth) else { return Answered::Nothing };
        let mut answer = Manifold {
            outcome: Outcome::Intersecting,
            reference: 0,
            lower: -proved.upper,
            upper: -proved.lower,
            normal: [0.0; 3],
            point_count: 1,
            found_count: 1,
        };
        proved.direction.negate().store_vector(&mut answer.normal);
        // Edges that cross mostly have no patch to clip.
        if let Facet::Edges(_) = proved.facet
            && is_steep(&frame, 0, proved.direction)
            && is_steep(&frame, 1, proved.direction.negate())
        {
            fill_at_rest(self.contact, &frame, &proved);
            self.cache.reference = Reference::NONE;
            push_witness(polyhedra, self.contact, self.points);
            answer.point_count = self.points.written as u32;
            return Answered::Whole(answer);
        }
        // In no closure: that would be compiled without vector units (R2).
        let found = match choose_patches(self.bodies, &frame, &proved, &self.cache.reference) {
            Some(patches) => {
                let along = ContactNormal { direction: proved.direction, upper: answer.upper };
                let reference = &mut self.cache.reference;
                Writing { reference, config: self.config, points: self.points }.clip(&frame, &along, &patches)
            }
            None => None,
        };
        if self.is_asked || found.is_none_or(|found| found == 0) {
            fill_at_rest(self.contact, &frame, &proved);
        }
        let Some(found) = found else { return Answered::Contact };
        if found == 0 {
            push_witness(polyhedra, self.contact, self.points);
            answer.point_count = self.points.written as u32;
            return Answered::Whole(answer);
        }
        answer.reference = self.cache.reference.body;
        (answer.point_count, answer.found_count) = (self.points.written as u32, found as u32);
        Answered::Whole(answer)
    }
}

/// The patches that face each other along a facet's normal: mostly those of before.
#[inline(always)]
fn choose_patches<L: Lanes>(
    bodies: &[Placed; 2],
    frame: &Frame<L>,
    proved: &Proved<L>,
    last: &Reference,
) -> Option<Patches> {
    choose([patch_of(bodies, frame, proved, last, 0), patch_of(bodies, frame, proved, last, 1)], last)
}

#[inline(always)]
fn patch_of<L: Lanes>(
    bodies: &[Placed; 2],
    frame: &Frame<L>,
    proved: &Proved<L>,
    last: &Reference,
    i: usize,
) -> Option<Facing> {
    let towards = if i == 0 { proved.direction } else { proved.direction.negate() };
    let polyhedron = frame.bodies[i].polyhedron;
    let sticky = if last.body == i as u32 + 1 { STICKY } else { STICKY_INCIDENT };
    let known = (1..=2).contains(&last.body).then_some(last.patches[i]);
    if let Some(patch) = known.and_then(|number| Patch::of_number(polyhedron, number)) {
        let parallel = L::from_vector(patch.normal(polyhedron)).dot(frame.bodies[i].rotate_back(towards));
        // No normal is longer than 1, nor R·normal, up to 40u.
        let is_parallel = parallel >= 1.0 + 64.0 * U - sticky;
        if is_parallel || most_parallel(frame, i, towards).is_some_and(|most| parallel >= most - sticky) {
            return Some(Facing { patch, parallel });
        }
    }
    let witness = proved.points[i].to_vector() + polyhedron.centre;
    facing(bodies[i], &towards.to_vector(), &witness, known, sticky)
}

/// The cosine between a direction in the world and the normal of a body that is the most parallel to it, where they are in a fan.
#[inline(always)]
fn most_parallel<L: Lanes>(frame: &Frame<L>, i: usize, towards: L) -> Option<f64> {
    let polyhedron = frame.bodies[i].polyhedron;
    let fan = polyhedron.fan.as_ref().filter(|_| polyhedron.contact_faces.faces.is_empty())?;
    let along = frame.bodies[i].rotate_back(towards);
    let [x, y, z] = [along.splat_x(), along.splat_y(), along.splat_z()];
    let mut most = L::splat(-1.0);
    for block in &fan.planes {
        let cosine = x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))));
        most = most.max(cosine);
    }
    Some(-most.negate().least().0)
}

/// Whether no face of a body is nearly across a direction.
#[inline(always)]
fn is_steep<L: Lanes>(frame: &Frame<L>, i: usize, towards: L) -> bool {
    most_parallel(frame, i, towards).is_some_and(|most| most < PARALLEL)
}

/// The query of a pair whose contact and patches are known. (Thin bodies have their points named by the sweep.)
pub struct Clipping<'a, 'b, 'c> {
    pub bodies: &'a [Placed<'a>; 2],
    pub contact: &'a SignedDistance,
    pub patches: &'a Patches,
    pub writing: &'a mut Writing<'b, 'c>,
}

impl Kernel for Clipping<'_, '_, '_> {
    type Output = Option<usize>;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> Option<usize> {
        let [body1, body2] = self.bodies;
        let polyhedra = [body1.shape.polyhedron(), body2.shape.polyhedron()];
        let frame = Frame::<L>::new(&Pair { polyhedra, poses: [body1.pose, body2.pose] });
        if !(frame.in_range && is_in_scale(polyhedra)) || is_thin(polyhedra[0]) || is_thin(polyhedra[1]) {
            return None;
        }
        let direction = L::from_vector(&self.contact.normal.into()).negate();
        let along = ContactNormal { direction, upper: self.contact.upper };
        self.writing.clip(&frame, &along, self.patches)
    }
}
