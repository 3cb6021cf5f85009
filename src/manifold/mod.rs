//! Contact manifolds: where two objects meet or nearly do, as points in pairs along a certified normal, for small gaps and for
//! penetration alike.
//!
//! The reference is the patch most parallel to the normal, a face up to the noise of the input, the incident patch the other
//! object's; the part that both cover, seen along the normal, is the manifold. If no patch is nearly parallel to the normal, as
//! where edges cross, it is the one pair of witness points.

mod answer;
mod sink;
mod id;
mod patch;
mod steady;
mod witness;
mod outline;
mod clip;
mod places;
mod reduction;
mod at_rest;
mod swept;
mod half_space;
mod four;

use crate::answer::{Outcome, PairAnswer, PairConfig, Radii};
use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::memory::push;
use crate::base::simd;
use crate::base::simd::environment::with_default;
use crate::depth::DepthAnswer;
use crate::pair::{SignedDistance, signed_distance};
use crate::placed::Pair;
use crate::placed::frame::between_centres;
use crate::shape::Placed;
use answer::FOUR;
pub(crate) use answer::Reference;
pub use answer::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use at_rest::{Answered, AtRest, Clipping, Writing};
use clip::Precision;
pub(crate) use four::four_of_points;
pub use half_space::half_space_manifold;
pub(crate) use half_space::half_space_manifold_into;
pub(crate) use id::id_of;
use outline::{Axes, Outline};
pub(crate) use patch::{COINCIDENT, PARALLEL};
use patch::{Patches, STICKY, STICKY_INCIDENT, choose, facing};
use places::{CommonPoint, Origin, View};
use reduction::{Thinned, four_of};
pub(crate) use sink::{Fill, Sink};
use steady::name_by_place;
use witness::push_witness;
pub(crate) use witness::witness;

/// The manifold of two objects, written to `points` as far as there is room. For objects farther apart than `max_distance` there is
/// none.
///
/// The normal and the interval are as certain as those of [`crate::pair::distance`] and [`crate::pair::depth`]. Points are those
/// that the two faces have in common along the normal, with a gap of at most `max_distance`; at least one. Equal shapes, poses,
/// normals and caches give equal points in equal order.
///
/// # Errors
/// As of [`crate::pair::depth`]; then nothing is changed.
pub fn manifold(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut [ManifoldPoint],
) -> Result<Manifold> {
    manifold_beside(bodies, cache, config, points, None)
}

/// As [`manifold`], with the signed distance that it is made from: the estimate, and the witness points with their features.
///
/// # Errors
/// As of [`manifold`].
pub fn manifold_with_distance(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut [ManifoldPoint],
) -> Result<(Manifold, SignedDistance)> {
    let mut distance = SignedDistance::default();
    let manifold = manifold_beside(bodies, cache, config, points, Some(&mut distance))?;
    Ok((manifold, distance))
}

fn manifold_beside(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut [ManifoldPoint],
    distance: Option<&mut SignedDistance>,
) -> Result<Manifold> {
    let capacity = points.len();
    let mut write = |place: usize, fill: Fill| fill(&mut points[place]);
    manifold_into(bodies, cache, config, &mut Sink { capacity, written: 0, write: &mut write }, distance)
}

/// Has points added to a list that grows with them.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory), beside the errors of `find`.
pub(crate) fn add_points<A>(points: &mut Vec<ManifoldPoint>, find: impl FnOnce(&mut Sink) -> A) -> Result<A> {
    let mut written = Ok(());
    let mut write = |_: usize, fill: Fill| {
        if written.is_ok() {
            written = push(points, ManifoldPoint::default());
        }
        if let (Ok(()), Some(point)) = (&written, points.last_mut()) {
            fill(point);
        }
    };
    let found = find(&mut Sink { capacity: usize::MAX, written: 0, write: &mut write });
    written.map(|()| found)
}

/// As [`manifold_with_distance`], written to the caller's place.
pub(crate) fn manifold_into(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut Sink,
    contact: Option<&mut SignedDistance>,
) -> Result<Manifold> {
    with_default(|| {
        config.check()?;
        let (is_asked, mut unasked) = (contact.is_some(), SignedDistance::default());
        let contact = contact.unwrap_or(&mut unasked);
        let within = PairConfig { max_distance: config.max_distance, ..PairConfig::default() };
        if cache.depth().resting().is_some() && Radii::of(&bodies).is_none() {
            let mut query = AtRest { bodies: &bodies, cache, config, points, contact, is_asked };
            match simd::dispatch_to_avx2(&mut query) {
                Answered::Whole(manifold) => return Ok(manifold),
                Answered::Contact => {
                    return Ok(make(bodies, &mut cache.reference, config, contact, points));
                }
                Answered::Nothing => {}
            }
        }
        signed_distance(bodies, &mut cache.signed_distance, &within, contact)?;
        Ok(of_bodies(bodies, &mut cache.reference, config, contact, points))
    })
}

/// The facts known about two objects before their manifold is.
pub(crate) enum Known<'a> {
    /// Their distance.
    Apart(&'a PairAnswer),
    /// They intersect.
    Deep(&'a DepthAnswer),
}

/// As [`manifold_into`], in the default floating-point environment and with a config that has been checked.
pub(crate) fn manifold_of(
    bodies: [Placed; 2],
    known: Known,
    reference: &mut Reference,
    config: &ManifoldConfig,
    points: &mut Sink,
) -> Manifold {
    let contact = match known {
        Known::Apart(answer) if answer.lower > config.max_distance => {
            SignedDistance { outcome: Outcome::Beyond, ..answer.into() }
        }
        Known::Apart(answer) => answer.into(),
        Known::Deep(answer) => answer.into(),
    };
    of_bodies(bodies, reference, config, &contact, points)
}

/// As [`manifold_into`], along the normal of any contact: for faces that meet there. If none do, it is the contact's pair of
/// points.
pub(crate) fn manifold_along(
    bodies: [Placed; 2],
    contact: &SignedDistance,
    config: &ManifoldConfig,
    points: &mut Sink,
) -> Manifold {
    of_bodies(bodies, &mut Reference::default(), config, contact, points)
}

/// The manifold of bodies over which balls are swept: that of the polyhedra, with its points moved out to the surfaces.
fn of_bodies(
    bodies: [Placed; 2],
    before: &mut Reference,
    config: &ManifoldConfig,
    contact: &SignedDistance,
    points: &mut Sink,
) -> Manifold {
    let Some(radii) = Radii::of(&bodies) else { return make(bodies, before, config, contact, points) };
    let poses = bodies.map(|body| body.pose);
    let of_polyhedra = swept::contact_of_polyhedra(&radii, poses, contact);
    let config = ManifoldConfig { max_distance: radii.with(config.max_distance), ..*config };
    let mut write = |place: usize, fill: Fill| {
        (points.write)(place, &mut |point| {
            fill(point);
            *point = swept::point_of_bodies(&radii, poses, contact, point);
        });
    };
    let mut sink = Sink { capacity: points.capacity, written: points.written, write: &mut write };
    let manifold = make(bodies, before, &config, &of_polyhedra, &mut sink);
    points.written = sink.written;
    Manifold { outcome: contact.outcome, lower: contact.lower, upper: contact.upper, ..manifold }
}

fn make(
    bodies: [Placed; 2],
    before: &mut Reference,
    config: &ManifoldConfig,
    contact: &SignedDistance,
    points: &mut Sink,
) -> Manifold {
    let mut answer = Manifold {
        outcome: contact.outcome,
        reference: 0,
        lower: contact.lower,
        upper: contact.upper,
        normal: contact.normal,
        point_count: 0,
        found_count: 0,
    };
    let last = std::mem::replace(before, Reference::NONE);
    if contact.outcome == Outcome::Beyond {
        return answer;
    }
    if let Some(patches) = choose_patches(bodies, contact, &last) {
        *before = last;
        let mut writing = Writing { reference: before, config, points };
        let found = simd::dispatch_to_avx2(&mut Clipping {
            bodies: &bodies,
            contact,
            patches: &patches,
            writing: &mut writing,
        });
        let found = match found {
            Some(found) => found,
            None => {
                *writing.reference = Reference::NONE;
                sweep(bodies, contact, &patches, &last, writing)
            }
        };
        if found > 0 {
            answer.reference = patches.reference as u32 + 1;
            (answer.point_count, answer.found_count) = (points.written as u32, found as u32);
            return answer;
        }
    }
    push_witness(bodies.map(|body| body.shape.polyhedron()), contact, points);
    (answer.point_count, answer.found_count) = (points.written as u32, 1);
    answer
}

/// The last reference stays while it is about as parallel. `None` where no patch is nearly parallel to the normal.
fn choose_patches(bodies: [Placed; 2], contact: &SignedDistance, last: &Reference) -> Option<Patches> {
    let normal = Vector::from(contact.normal);
    // One by one (rule R1).
    let towards = |i: usize| {
        let sticky = if last.body == i as u32 + 1 { STICKY } else { STICKY_INCIDENT };
        let direction = if i == 0 { -normal } else { normal };
        let last = (1..=2).contains(&last.body).then_some(last.patches[i]);
        let witness = Vector::from(if i == 0 { contact.local1 } else { contact.local2 });
        facing(bodies[i], &direction, &witness, last, sticky)
    };
    choose([towards(0), towards(1)], last)
}

/// Larger objects are not clipped, and their manifold is the pair of witness points: squares of lengths must not overflow.
const LARGEST: f64 = 1e150;

/// Edges of bodies of which any number of points are named by their places.
const MOST_NAMED: usize = 1024;

/// Writes the points that both patches have in common, of any poses and patches; how many there are.
fn sweep(
    bodies: [Placed; 2],
    contact: &SignedDistance,
    patches: &Patches,
    last: &Reference,
    Writing { reference: now, config, points }: Writing,
) -> usize {
    let pair = &Pair::of(&bodies);
    let Pair { polyhedra, poses } = *pair;
    // For bodies far from their own origins, these sums agree in nearly all digits.
    let (between, cancelled) = if polyhedra.iter().any(|polyhedron| polyhedron.centre != Vector::zeros()) {
        between_centres(pair)
    } else {
        (poses[0].translation() - poses[1].translation(), 0.0)
    };
    let size = polyhedra[0].radius + polyhedra[1].radius + between.norm();
    // False for a NaN.
    if !(size < LARGEST) {
        return 0;
    }
    let rounding = 64.0 * U * (size + U * cancelled);
    let patch = |i: usize| patches.facing[i].map(|facing| facing.patch);
    let beside = outline::first_side(polyhedra[patches.reference], patch(patches.reference));
    let axes = Axes::new(&contact.normal.into(), &poses[patches.reference].rotate(&beside));
    let outlines = [
        Outline::new(polyhedra[0], poses[0], between, &axes, patch(0)),
        Outline::new(polyhedra[1], poses[1], Vector::zeros(), &axes, patch(1)),
    ];
    let noise = 2.0 * (outlines[0].slack + outlines[1].slack);
    let precision = Precision { rounding, coincident: noise.max(COINCIDENT * size), reference: patches.reference };
    // All corners of so small a body are one place: rounding would decide which are over the other's patch. A point has no
    // others.
    if polyhedra.iter().any(|body| body.radius > 0.0 && body.radius <= precision.coincident) {
        return 0;
    }
    let origin = poses[1].transform(&polyhedra[1].centre);
    let witness_spots = [contact.world1, contact.world2].map(|p| axes.spot(&(Vector::from(p) - origin)));
    let view =
        View { outlines: &outlines, poses, precision, max_distance: config.max_distance, contact, witness_spots };

    let numbers = [0, 1].map(|i| patch(i).map_or(0, |patch| patch.number(polyhedra[i])));
    *now = Reference { body: patches.reference as u32 + 1, patches: numbers, kept: [0; FOUR] };
    // Any number of points times all features would take as long as their squares.
    let are_named = config.reduces || polyhedra.iter().all(|polyhedron| polyhedron.edges.len() <= MOST_NAMED);
    let fill = |point: &mut ManifoldPoint, place: &CommonPoint| {
        match place.origin {
            Origin::Witness => *point = witness(contact),
            Origin::Corner(corner) => view.fill(point, place, corner),
        }
        if are_named {
            name_by_place(polyhedra, point);
        }
    };
    if !config.reduces {
        let write = |place: &CommonPoint| match place.origin {
            Origin::Witness => points.insist(|point| fill(point, place)),
            Origin::Corner(_) => points.push(|point| fill(point, place)),
        };
        return view.sweep(write);
    }
    let is_same = (last.body, last.patches) == (now.body, now.patches);
    let kept = if is_same { last.kept } else { [0; FOUR] };
    let mut thinned = Thinned::new(&kept);
    let found = view.sweep(|place| thinned.add(place));
    for (place, key) in four_of(thinned.places(), &kept, size).into_iter().zip(&mut now.kept) {
        let Some(place) = place else { continue };
        *key = place.key();
        points.push(|point| fill(point, place));
    }
    found
}
