//! Contact manifolds: where two objects meet or nearly do, as points in pairs along a certified normal, for small gaps and for
//! penetration alike.
//!
//! The reference is the face most parallel to the normal, the incident face the other object's; what both cover, seen along the
//! normal, is the manifold. Where no face is nearly parallel to the normal, as where edges cross, it is the one pair of witness
//! points.

mod answer;
mod outline;
mod clip;

use super::contact::{label, placed_points};
use super::depth::{DepthAnswer, DepthConfig, depth};
use super::query::{PairQuery, Query, Rungs};
use super::{Feature, FeatureKind, Outcome, PairAnswer, PairConfig};
use crate::base::error::Result;
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::environment::with_default;
use crate::pair::contact::faces_at;
use crate::pair::ladder::climb;
use crate::pair::placed::Placed;
use crate::polyhedron::Polyhedron;
use crate::solve::state::FeatureId;
use crate::tables;
pub(crate) use answer::Reference;
pub use answer::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use clip::{Corner, common_part};
use outline::{Axes, Outline};

/// The manifold of two objects, written to `points` as far as there is room. Of objects farther apart than the margin there is
/// none.
///
/// The normal and the interval are as certain as those of [`crate::pair::distance`] and [`crate::pair::depth`]. Points are those
/// that the two faces have in common along the normal, with a gap of at most the margin; at least one. Equal shapes, poses, normals
/// and caches give equal points in equal order.
///
/// # Errors
/// As of [`crate::pair::depth`]; then nothing is changed.
pub fn manifold(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut [ManifoldPoint],
) -> Result<Manifold> {
    let capacity = points.len();
    let mut write = |place: usize, point: &ManifoldPoint| points[place] = *point;
    manifold_into(bodies, cache, config, &mut Sink { capacity, written: 0, write: &mut write })
}

/// Where points go.
pub(crate) struct Sink<'a> {
    /// How many there is room for.
    pub capacity: usize,
    /// How many have been written.
    pub written: usize,
    /// Writes one at its place.
    pub write: &'a mut dyn FnMut(usize, &ManifoldPoint),
}

impl Sink<'_> {
    fn push(&mut self, point: impl FnOnce() -> ManifoldPoint) {
        if self.written < self.capacity {
            (self.write)(self.written, &point());
            self.written += 1;
        }
    }
}

/// As [`manifold`], to where the caller says.
pub(crate) fn manifold_into(
    bodies: [Placed; 2],
    cache: &mut ManifoldCache,
    config: &ManifoldConfig,
    points: &mut Sink,
) -> Result<Manifold> {
    with_default(|| {
        config.check()?;
        let contact = find_contact(bodies, cache, config)?;
        Ok(make(bodies, &mut cache.reference, config, &contact, points))
    })
}

/// What is known of two objects before their manifold is.
pub(crate) enum Known<'a> {
    /// Their distance.
    Apart(&'a PairAnswer),
    /// They intersect.
    Deep(&'a DepthAnswer),
}

/// As [`manifold_into`], in the default floating-point environment and with a margin that has been checked.
pub(crate) fn manifold_of(
    bodies: [Placed; 2],
    known: Known,
    reference: &mut Reference,
    config: &ManifoldConfig,
    points: &mut Sink,
) -> Manifold {
    let contact = match known {
        Known::Apart(answer) if answer.lower > config.margin => {
            Contact { outcome: Outcome::Beyond, ..Contact::apart(answer) }
        }
        Known::Apart(answer) => Contact::apart(answer),
        Known::Deep(answer) => Contact::deep(answer),
    };
    make(bodies, reference, config, &contact, points)
}

/// What the pair queries say.
struct Contact {
    outcome: Outcome,
    /// The signed distance.
    interval: [f64; 2],
    normal: Vector,
    /// The pair of witness points.
    witness: ManifoldPoint,
}

impl Contact {
    /// Of objects that are apart.
    fn apart(answer: &PairAnswer) -> Contact {
        let &PairAnswer { local1, local2, world1, world2, feature1, feature2, .. } = answer;
        let (gap_lower, gap_upper) = (answer.lower, answer.upper);
        let id = id_of(&feature1, &feature2);
        Contact {
            outcome: answer.outcome,
            interval: [gap_lower, gap_upper],
            normal: answer.normal.into(),
            witness: ManifoldPoint { local1, local2, world1, world2, gap_lower, gap_upper, feature1, feature2, id },
        }
    }

    /// Of objects that intersect.
    fn deep(answer: &DepthAnswer) -> Contact {
        let &DepthAnswer { local1, local2, world1, world2, feature1, feature2, .. } = answer;
        let (gap_lower, gap_upper) = (-answer.upper, -answer.lower);
        let id = id_of(&feature1, &feature2);
        Contact {
            outcome: answer.outcome,
            interval: [gap_lower, gap_upper],
            normal: answer.normal.into(),
            witness: ManifoldPoint { local1, local2, world1, world2, gap_lower, gap_upper, feature1, feature2, id },
        }
    }
}

/// How far the objects are apart, or how deep in each other. What they were the last time is asked first.
fn find_contact(bodies: [Placed; 2], cache: &mut ManifoldCache, config: &ManifoldConfig) -> Result<Contact> {
    if cache.depth.holds_polytope()
        && let Some(contact) = find_depth(bodies, cache, config)?
    {
        return Ok(contact);
    }
    let mut answer = PairAnswer::default();
    let pair_config = PairConfig {
        distance_tolerance: config.margin,
        rotation_limit: config.rotation_limit,
        ..PairConfig::default()
    };
    let (pair_cache, answer_of) = (&mut cache.pair, &mut answer);
    let mut query = PairQuery {
        query: Query::Distance,
        bodies: &bodies,
        cache: pair_cache,
        config: &pair_config,
        answer: answer_of,
    };
    climb(&mut query, Rungs::ALL)?;
    if answer.outcome == Outcome::Intersecting
        && let Some(contact) = find_depth(bodies, cache, config)?
    {
        return Ok(contact);
    }
    Ok(Contact::apart(&answer))
}

/// `None` of objects that are apart.
fn find_depth(bodies: [Placed; 2], cache: &mut ManifoldCache, config: &ManifoldConfig) -> Result<Option<Contact>> {
    let mut answer = DepthAnswer::default();
    let depth_config = DepthConfig { rotation_limit: config.rotation_limit, ..DepthConfig::default() };
    depth(bodies, &mut cache.depth, &depth_config, &mut answer)?;
    if answer.outcome != Outcome::Intersecting {
        return Ok(None);
    }
    Ok(Some(Contact::deep(&answer)))
}

/// The cosine between a face's normal and the contact's from which on the face may be the reference: 10°.
const PARALLEL: f64 = 0.984_8;

/// By how much less parallel the last reference may be and stay.
const STICKY: f64 = 1e-3;

fn make(
    bodies: [Placed; 2],
    before: &mut Reference,
    config: &ManifoldConfig,
    contact: &Contact,
    points: &mut Sink,
) -> Manifold {
    let mut answer = Manifold {
        outcome: contact.outcome,
        reference: 0,
        lower: contact.interval[0],
        upper: contact.interval[1],
        normal: contact.normal.into(),
        point_count: 0,
        found_count: 0,
    };
    if contact.outcome == Outcome::Beyond {
        *before = [0, 0];
        return answer;
    }
    let (polyhedra, poses) = (bodies.map(|body| body.shape.polyhedron()), bodies.map(|body| body.pose));
    let faces = [0, 1].map(|i| facing(polyhedra[i], poses[i], i, &contact.normal, before));
    let reference = [0, 1].into_iter().reduce(|a, b| if parallel(&faces[b]) > parallel(&faces[a]) { b } else { a });
    let reference = keep_reference(reference.unwrap_or(0), &faces, before);
    if parallel(&faces[reference]) >= PARALLEL {
        *before = [reference as u32 + 1, faces[reference].map_or(0, |facing| facing.face)];
        let found = clip(polyhedra, poses, &faces, reference, config, contact, points);
        if found > 0 {
            answer.reference = reference as u32 + 1;
            (answer.point_count, answer.found_count) = (points.written as u32, found as u32);
            return answer;
        }
    } else {
        *before = [0, 0];
    }
    points.push(|| contact.witness);
    (answer.point_count, answer.found_count) = (points.written as u32, 1);
    answer
}

/// A face that looks towards the other body.
#[derive(Debug, Clone, Copy)]
struct Facing {
    face: u32,
    /// The cosine between its normal and the direction towards the other body.
    parallel: f64,
}

fn parallel(facing: &Option<Facing>) -> f64 {
    facing.map_or(-1.0, |facing| facing.parallel)
}

/// The face most parallel to the normal of those at the vertex that reaches farthest along it; the last reference, if it is about
/// as parallel. `None` of bodies without faces.
fn facing(polyhedron: &Polyhedron, pose: &Pose, body: usize, normal: &Vector, before: &Reference) -> Option<Facing> {
    let towards = pose.rotate_back(&if body == 0 { -normal } else { *normal });
    let cosine = |face: u32| Facing { face, parallel: polyhedron.faces[face as usize].normal.dot(&towards) };
    let better = |a: Facing, b: Facing| if b.parallel > a.parallel { b } else { a };
    let first = polyhedron.edges.first()?.tail();
    let (vertex, _) = polyhedron.support(&towards, tables::farthest(polyhedron, &towards).unwrap_or(first));
    let around = polyhedron.face_around(vertex).into_iter().chain(faces_at(polyhedron, vertex));
    let best = around.map(cosine).reduce(better)?;
    let [last_body, last_face] = *before;
    if last_body == body as u32 + 1 && (last_face as usize) < polyhedron.faces.len() {
        let last = cosine(last_face);
        if last.parallel >= best.parallel - STICKY {
            return Some(last);
        }
    }
    Some(best)
}

/// The last reference's body, if its face is about as parallel.
fn keep_reference(best: usize, faces: &[Option<Facing>; 2], before: &Reference) -> usize {
    match before[0] {
        last @ 1..=2 if parallel(&faces[last as usize - 1]) >= parallel(&faces[best]) - STICKY => last as usize - 1,
        _ => best,
    }
}

/// Larger objects are not clipped, and their manifold is the pair of witness points: squares of lengths must not overflow.
const LARGEST: f64 = 1e150;

/// Writes the points that both faces have in common; how many there are.
fn clip(
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    faces: &[Option<Facing>; 2],
    reference: usize,
    config: &ManifoldConfig,
    contact: &Contact,
    points: &mut Sink,
) -> usize {
    let between = (poses[0].translation() - poses[1].translation())
        + (poses[0].rotate(&polyhedra[0].centre) - poses[1].rotate(&polyhedra[1].centre));
    let size = polyhedra[0].radius + polyhedra[1].radius + between.norm();
    // False for a NaN.
    if !(size < LARGEST) {
        return 0;
    }
    let rounding = 64.0 * U * size;
    let beside = faces[reference].map_or_else(Vector::zeros, |facing| {
        let polyhedron = polyhedra[reference];
        let edge = &polyhedron.edges[polyhedron.faces[facing.face as usize].first_sides[0] as usize];
        let ends = [edge.tail(), edge.head()].map(|v| polyhedron.vertices[v as usize].position);
        poses[reference].rotate(&(ends[1] - ends[0]))
    });
    let axes = Axes::new(&contact.normal, &beside);
    let outline = |i: usize, offset: Vector| {
        Outline::new(polyhedra[i], poses[i], offset, &axes, faces[i].map(|facing| facing.face))
    };
    let view = View {
        outlines: [outline(0, between), outline(1, Vector::zeros())],
        polyhedra,
        poses,
        rounding,
        margin: config.margin,
    };
    let mut found = 0;
    if !config.reduces {
        view.visit(|place| {
            points.push(|| view.point(place));
            found += 1;
        });
        return found;
    }
    view.visit(|_| found += 1);
    let mut write = |place: &Place| points.push(|| view.point(place));
    if found <= FOUR {
        view.visit(&mut write);
    } else {
        view.four().iter().flatten().for_each(write);
    }
    found
}

/// How many points a reduced manifold has.
const FOUR: usize = 4;

/// Two outlines seen along the normal.
struct View<'a> {
    outlines: [Outline<'a>; 2],
    polyhedra: [&'a Polyhedron; 2],
    poses: [&'a Pose; 2],
    /// What rounding makes of a length.
    rounding: f64,
    margin: f64,
}

/// A corner of the common part, with the heights of both faces there.
#[derive(Debug, Clone, Copy)]
struct Place {
    corner: Corner,
    spots: [Vector; 2],
    error: f64,
}

impl Place {
    fn gap(&self) -> f64 {
        self.spots[0].z - self.spots[1].z
    }
}

impl View<'_> {
    /// Calls `visit` with each point whose gap is at most the margin.
    fn visit(&self, mut visit: impl FnMut(&Place)) {
        common_part(&self.outlines, self.rounding, |corner| {
            if let Some(place) = self.place(corner)
                && place.gap() - place.error <= self.margin
            {
                visit(&place);
            }
        });
    }

    fn place(&self, corner: &Corner) -> Option<Place> {
        match *corner {
            Corner::Vertex { body, spot, .. } => {
                let other = &self.outlines[1 - body];
                let (height, error) = other.height_at(spot.x, spot.y, self.rounding)?;
                let mut spots = [spot; 2];
                spots[1 - body].z = height;
                Some(Place { corner: *corner, spots, error: error + self.rounding })
            }
            Corner::Crossing { spots, error, .. } => {
                Some(Place { corner: *corner, spots, error: error + 2.0 * self.rounding })
            }
        }
    }

    /// The deepest point, the farthest from it, and the extremes on either side of the line between them.
    fn four(&self) -> [Option<Place>; FOUR] {
        let deepest = self.most(|place| -place.gap());
        let Some(first) = deepest else { return [None; FOUR] };
        let from = first.corner.place();
        let aside = |place: &Place| {
            let apart = place.corner.place() - from;
            Vector::new(apart.x, apart.y, 0.0)
        };
        let farthest = self.most(|place| aside(place).norm_squared());
        let Some(second) = farthest else { return [deepest, None, None, None] };
        let line = aside(&second);
        let side = |place: &Place| line.x * aside(place).y - line.y * aside(place).x;
        let on_line = self.rounding * line.norm();
        let extreme = |sign: f64| self.most(|place| sign * side(place)).filter(|place| sign * side(place) > on_line);
        [deepest, farthest, extreme(1.0), extreme(-1.0)]
    }

    /// The point with the most of something; the first of equals.
    fn most(&self, measure: impl Fn(&Place) -> f64) -> Option<Place> {
        let mut best: Option<(Place, f64)> = None;
        self.visit(|place| {
            let value = measure(place);
            if best.is_none_or(|(_, most)| value > most) {
                best = Some((*place, value));
            }
        });
        best.map(|(place, _)| place)
    }

    fn point(&self, place: &Place) -> ManifoldPoint {
        let centred = [0, 1].map(|i| match place.corner {
            Corner::Vertex { body, corner, .. } if body == i => {
                let vertex = self.outlines[i].vertex(corner);
                self.polyhedra[i].vertices[vertex as usize].position
            }
            // R has an inverse: det R > 0.
            _ => self.outlines[i].local(&place.spots[i]).unwrap_or_else(Vector::zeros),
        });
        let features = [0, 1].map(|i| self.feature(place, i, &centred[i]));
        let super::contact::PlacedPoints { local, world } = placed_points(self.polyhedra, self.poses, &centred);
        let gap = place.gap();
        ManifoldPoint {
            local1: local[0],
            local2: local[1],
            world1: world[0],
            world2: world[1],
            gap_lower: gap - place.error,
            gap_upper: gap + place.error,
            feature1: features[0],
            feature2: features[1],
            id: id_of(&features[0], &features[1]),
        }
    }

    /// What holds the point on a body: its own vertex, its side, or its face.
    fn feature(&self, place: &Place, body: usize, point: &Vector) -> Feature {
        let outline = &self.outlines[body];
        match place.corner {
            Corner::Vertex { body: own, corner, .. } if own == body => {
                label(self.polyhedra[body], FeatureId::Vertex(outline.vertex(corner)), point)
            }
            Corner::Crossing { sides, .. } => {
                Feature { kind: FeatureKind::Edge, ids: outline.side_labels(sides[body]) }
            }
            Corner::Vertex { .. } => match outline.face {
                // Of several polygons merged into the face the lowest: which of them holds the point may change while it stays.
                Some(face) => Feature {
                    kind: FeatureKind::Face,
                    ids: [self.polyhedra[body].labels_of_face(face).first().copied().unwrap_or(0), 0],
                },
                None => Feature { kind: FeatureKind::Edge, ids: outline.side_labels(0) },
            },
        }
    }
}

/// A number made of two features, the same for the same (SplitMix64's finaliser, Steele, Lea & Flood 2014).
fn id_of(feature1: &Feature, feature2: &Feature) -> u64 {
    let mut id = 0_u64;
    for feature in [feature1, feature2] {
        // The ends of an edge either way round.
        let [first, second] = feature.ids;
        let [low, high] =
            if feature.kind == FeatureKind::Edge { [first.min(second), first.max(second)] } else { feature.ids };
        for word in [feature.kind as u64, u64::from(low), u64::from(high)] {
            id = (id ^ word).wrapping_add(0x9e37_79b9_7f4a_7c15);
            id = (id ^ id >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            id = (id ^ id >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
            id ^= id >> 31;
        }
    }
    id
}
