//! How deep two bodies are in each other by one facet of C = {x − y} that was the least before, and one deep point.
//!
//! *Lemma.* Let a facet be at heights from l to t > 0 along a unit vector m, at all places up to r aside of the origin, and let q
//! be a point of C at the height −h, a aside. If rh > at and (rh − at)² ≥ t²((r + a)² + (h + t)²), C holds the ball of radius l.
//! For let u = c·e + s·m be a unit vector, e across m and c ≥ 0. C has the points (r, t') and (a', −h) of the plane of e and m, l ≤
//! t' ≤ t, |a'| ≤ a. From the condition r > t and h > t. If s ≥ 0, the first gives rc + t's ≥ l(c + s) ≥ l. At u = −m the second
//! gives h > l. In between, each gives a sinusoid, concave where it is positive; so the greater of both is least at an end, or
//! where they are equal: u is there across the line through both points, which is (rh + t'a')/√((r − a')² + (h + t')²) from the
//! origin, at least (rh − ta)/√((r + a)² + (h + t)²) ≥ t. □
//!
//! *Two discs.* Where the foot is next to a side, as where equal boxes stand on each other, r is too small. Let C have a second
//! disc around the foot, of radius R > t, at heights from l − e > 0 to t. With s = r/t ≤ 1 the ball is in C if R ≥ r + e(1 − s²)/2s
//! and the condition above holds of R. For let θ be the angle of u and m. The first disc gives l·cos θ + r·sin θ ≥ l up to tan(θ/2)
//! = s. The second gives (l − e)cos θ + R·sin θ ≥ l if R ≥ l·tan(θ/2) + e·cot θ, which is convex up to 90°: it holds up to there if
//! at both ends, and beyond 90° as above. If e is no more than rounding, the second disc proves l − e alone. □
//!
//! The second disc is on a face that looks at the other body, or on the corners of a contact face; or, where one side is near, on
//! the facet and on that across the side.
//! Of such a fold by an angle φ the condition is r ≥ t·tan(φ/2), rounding apart, and that is so wherever the facet is the least.
//!
//! *From above*: along m the bodies overlap by no more than both reach.
//!
//! Any facet and any bytes will do: indices are looked at, all else is proved anew. Where the origin's foot is beyond a side of the
//! facet, the next facet across that side is looked at, as in gift wrapping (Chand & Kapur 1970).

use super::search::Facet;
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::{MergedFace, NONE, Polyhedron};
use crate::depth::polytope::farthest;
use crate::placed::exact::VertexPair;
use crate::placed::frame::{Body, Frame};
use crate::placed::state::FeatureId;

/// A depth that a facet proves.
#[derive(Clone, Copy)]
pub struct Proved<L> {
    /// The depth is at least this, more than 0 …
    pub lower: f64,
    /// … and at most this.
    pub upper: f64,
    /// The overlap of the witness points, in between.
    pub depth: f64,
    /// The unit vector, from the inside of C to the boundary, along which the bodies overlap least.
    pub direction: L,
    /// The witness points in centred coordinates.
    pub points: [L; 2],
    /// The features that hold them.
    pub features: [FeatureId; 2],
    /// The facet.
    pub facet: Facet,
    /// Facets walked over.
    pub steps: u32,
}

/// Facets that are looked at.
const MOST_FACETS: u32 = 10;

/// How wide an interval may be over the pair's size or distance: a little less than is promised.
const WIDEST: f64 = 176.0 * U;

/// Lengths that decide nothing but whether the lemma's condition holds are right to far less than this part of themselves.
const SURELY: f64 = 1e-9;

/// The sine's square above which two edges have a facet: the normal's direction errs by 8u over the sine, and the height with it.
const LEAST_SQUARE: f64 = 1e-6;

/// The result of a look at one facet that proves nothing.
enum NextFacet {
    /// The foot is beyond a side of it: the facet there.
    Facet(Facet),
    Nothing,
}

/// The depth that a facet, or one a few steps from it, proves.
///
/// # Errors
/// The last facet that was looked at, if none proves one.
#[inline(always)]
pub fn prove<L: Lanes>(frame: &Frame<L>, facet: Facet) -> Result<Proved<L>, Facet> {
    let [polyhedron1, polyhedron2] = frame.polyhedra();
    let is_suited = |polyhedron: &Polyhedron| polyhedron.dimension == 3 && polyhedron.outlines.shortest > 0.0;
    // Bodies farther apart do not intersect.
    let are_near = frame.separation <= 2.0 * frame.size;
    if !(are_near && is_suited(polyhedron1) && is_suited(polyhedron2)) {
        return Err(facet);
    }
    match look(frame, facet) {
        Ok(proved) => Ok(proved),
        Err(NextFacet::Facet(next)) => L::out_of_line(&mut FacetWalk { frame, next }),
        Err(NextFacet::Nothing) => Err(facet),
    }
}

/// The face most across a direction, which is from the inside of C to its boundary, at vertices that are farthest along it: where a
/// walk may begin. `None` of flat bodies.
#[inline(always)]
pub fn across<L: Lanes>(frame: &Frame<L>, direction: &Vector, vertices: VertexPair) -> Option<Facet> {
    let [polyhedron1, polyhedron2] = frame.polyhedra();
    if polyhedron1.dimension < 3 || polyhedron2.dimension < 3 {
        return None;
    }
    let along = L::from_vector(direction);
    let (face1, cosine1) = most_across(polyhedron1, vertices[0], frame.bodies[0].rotate_back(along));
    let (face2, cosine2) = most_across(polyhedron2, vertices[1], frame.bodies[1].rotate_back(along).negate());
    Some(if cosine1 >= cosine2 { Facet::Face(0, face1) } else { Facet::Face(1, face2) })
}

struct FacetWalk<'a, L> {
    frame: &'a Frame<'a, L>,
    next: Facet,
}

impl<L: Lanes> Work for FacetWalk<'_, L> {
    type Output = Result<Proved<L>, Facet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        for steps in 1..MOST_FACETS {
            match look(self.frame, self.next) {
                Ok(proved) => return Ok(Proved { steps, ..proved }),
                Err(NextFacet::Facet(next)) => self.next = next,
                Err(NextFacet::Nothing) => break,
            }
        }
        Err(self.next)
    }
}

#[inline(always)]
fn look<L: Lanes>(frame: &Frame<L>, facet: Facet) -> Result<Proved<L>, NextFacet> {
    match facet {
        Facet::Face(body, face) => {
            let [polyhedron1, polyhedron2] = frame.polyhedra();
            let are_small = !polyhedron1.vertex_blocks.is_empty() & !polyhedron2.vertex_blocks.is_empty();
            if frame.rigid & are_small {
                look_at_face::<L, true>(frame, body.min(1), face)
            } else {
                L::out_of_line(&mut AtFace { frame, body: body.min(1), face })
            }
        }
        Facet::Edges(edges) => L::out_of_line(&mut AtEdges { frame, edges }),
    }
}

/// By how much the heights of a facet and of the bodies along its normal, of unit length, may be off; also what is taken off
/// lengths across it, twice.
///
/// A face with the stored normal n of a body with the radius ρ is at n·v = −`offset`, up to σ and 4uρ (the heights that `offset` is
/// the middle of err by 3u). In the world m = s·R·n as computed is off by 6.3u, and n·v = (RᵀR·n)·v up to 29u (`RIGID_DEFECT`),
/// with s·`offset` 40.3uρ. Of a skewed R the vector is R⁻ᵀ·n by cofactors, 11u, their determinant 10u, and s 6u: less. The other
/// body's heights take 5.3u for Rᵀm and 3u for the product: 8.3u of its radius. Δ is right to 2u|Δ|, its product to 3u; the sums to
/// 3u of all. m's length is 1 up to 5u, times the depth, at most an eighth of all: u. So 45u, 15u and 11u. With edges m is any
/// vector, of a length right to 5u, and all of these are less.
#[inline(always)]
fn rounding<L>(frame: &Frame<L>, own: &Polyhedron, other: &Polyhedron) -> f64 {
    U * (45.0 * own.radius + 15.0 * other.radius + 11.0 * frame.separation)
}

/// The deepest depth that is proved, over size and distance.
const SHALLOW: f64 = 0.125;

/// Whether an interval is above 0, narrow and shallow; not of a NaN.
#[inline(always)]
fn is_good<L>(frame: &Frame<L>, lower: f64, upper: f64) -> bool {
    let scale = if frame.separation > frame.size { frame.separation } else { frame.size };
    lower > 0.0 && upper - lower <= WIDEST * scale && upper <= SHALLOW * (frame.size + frame.separation)
}

/// How many times as short a length may become that a skewed R places: ‖RᵀR − I‖ is at most 0.03.
const SHORTENED: f64 = 0.98;

/// A vertex that is about the lowest along a direction in the body's axes, its height, and by how much the body may be lower;
/// climbed to from another where there are many.
#[inline(always)]
fn lowest<L: Lanes>(polyhedron: &Polyhedron, along: L, start: Option<u32>) -> (f64, u32, f64) {
    if polyhedron.vertex_blocks.is_empty() {
        return L::out_of_line(&mut LowestOfMany { polyhedron, along, start });
    }
    let (height, vertex) = lowest_in_blocks(polyhedron, along);
    (height, vertex, 0.0)
}

/// The lowest vertex of a body that has them in blocks, and its height.
#[inline(always)]
fn lowest_in_blocks<L: Lanes>(polyhedron: &Polyhedron, along: L) -> (f64, u32) {
    let [x, y, z] = [along.splat_x(), along.splat_y(), along.splat_z()];
    let (mut least, mut place) = (L::splat(f64::INFINITY), L::splat(0.0));
    let (mut at, four) = (L::splat(0.0), L::splat(4.0));
    for block in &polyhedron.vertex_blocks {
        let height = x.mul_add(L::load(&block.x), y.mul_add(L::load(&block.y), z.mul(L::load(&block.z))));
        place = at.where_greater(least, height, place);
        least = least.min(height);
        at = at.add(four);
    }
    let (height, lane) = least.least();
    let vertex = place.to_array()[lane & 3] as usize + lane;
    (height, vertex.min(polyhedron.vertices.len() - 1) as u32)
}

struct LowestOfMany<'a, L> {
    polyhedron: &'a Polyhedron,
    along: L,
    start: Option<u32>,
}

impl<L: Lanes> Work for LowestOfMany<'_, L> {
    type Output = (f64, u32, f64);

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        let LowestOfMany { polyhedron, along, start } = *self;
        let (vertex, excess) = farthest(polyhedron, along.negate(), start);
        let height = along.dot(L::from_vector(&polyhedron.vertices[vertex as usize].position));
        (height, vertex, excess * (1.0 + 64.0 * U))
    }
}

/// Whether the lemma's condition holds: of a disc of radius `r` at heights up to `top`, and a point `h` below the origin, `a`
/// aside.
#[inline(always)]
fn encloses(r: f64, [h, a]: [f64; 2], top: f64) -> bool {
    let (arm, rise) = (r + a, h + top);
    let over = r * h - a * top;
    r > 0.0 && h > 0.0 && over > 0.0 && over * over * (1.0 - SURELY) >= top * top * (arm * arm + rise * rise)
}

/// How deep below the origin the middles of both bodies are along a direction, and how far aside. Each middle is a convex
/// combination of vertices, right to (2 + count)·uρ: each of its sums errs by u of itself.
#[inline(always)]
fn middle<L: Lanes>(frame: &Frame<L>, own: &Body<L>, other: &Body<L>, m: L, error: f64) -> [f64; 2] {
    let (middle1, middle2) = (&own.polyhedron.outlines.middle, &other.polyhedron.outlines.middle);
    let apart = own.rotate(middle1).sub(other.rotate(middle2)).add(own.offset);
    let height = m.dot(apart);
    let aside = m.negated_mul_add(L::splat(height), apart);
    let count = own.polyhedron.vertices.len() + other.polyhedron.vertices.len();
    let off = 2.0 * error + (8 + count) as f64 * U * frame.size;
    [-height - off, aside.dot(aside).sqrt() + off]
}

/// A face of large bodies or of skewed ones.
struct AtFace<'a, L> {
    frame: &'a Frame<'a, L>,
    body: usize,
    face: u32,
}

impl<L: Lanes> Work for AtFace<'_, L> {
    type Output = Result<Proved<L>, NextFacet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        look_at_face::<L, false>(self.frame, self.body, self.face)
    }
}

/// A face of a body over the other's lowest vertex. `PLAIN`: of small bodies in rigid poses.
#[inline(always)]
fn look_at_face<L: Lanes, const PLAIN: bool>(frame: &Frame<L>, body: usize, face: u32) -> Result<Proved<L>, NextFacet> {
    let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
    let Some(record) = own.polyhedron.faces.get(face as usize) else { return Err(NextFacet::Nothing) };
    let normal = L::from_vector(&record.normal);
    let turned = if PLAIN { own.rotate_lanes(normal) } else { own.lift(normal) };
    // Of unit length up to 3u: 1/√(1 + x) is 1 − x/2 for an x of 44u, as of rigid poses.
    let square = turned.dot(turned);
    let scale = if PLAIN || frame.rigid { 1.5 - 0.5 * square } else { 1.0 / square.sqrt() };
    let m = turned.mul(L::splat(scale));
    let down = other.rotate_back(m);
    let (height, vertex, excess) = if PLAIN {
        let (height, vertex) = lowest_in_blocks(other.polyhedron, down);
        (height, vertex, 0.0)
    } else {
        lowest(other.polyhedron, down, None)
    };
    let depth = m.dot(own.offset) - scale * record.planes.offset[0] - height;
    let error = rounding(frame, own.polyhedron, other.polyhedron);
    // |RᵀR⁻ᵀn| is 1.
    let slack = if PLAIN { record.slack } else { record.slack * scale };
    let (lower, upper) = (depth - slack - error, depth + slack + error + excess);
    if !is_good(frame, lower, upper) {
        return Err(NextFacet::Nothing);
    }
    let deepest = &other.polyhedron.vertices[vertex as usize].position;
    let below = other.rotate(deepest).sub(own.offset);
    let mut below = if PLAIN { own.rotate_back(below) } else { own.turn_back(below) };
    if !(PLAIN || frame.rigid) {
        // On the face, in the direction of m.
        let along = own.turn_back(m);
        let height = (normal.dot(below) + record.planes.offset[0]) / normal.dot(along);
        below = along.negated_mul_add(L::splat(height), below);
    }
    // Sides and their offsets are right to some 10u of 3ρ, the place to less than twice `error`.
    let (inside, side) = least_inside(own.polyhedron, record, below);
    // A foot on a side, rounding apart, is under faces that are parallel, or never far from the next facet.
    if !(inside > -error) {
        let (edge, away) = side_of(own, record, side);
        return Err(L::out_of_line(&mut GiftWrap { frame, body, edge, vertex, m, away, from: [face, NONE] }));
    }
    let around = middle(frame, own, other, m, error);
    let small = Disc { radius: (inside - 2.0 * error) * shortest_of_unit(frame), lower };
    let facet = Facet::Face(body, face);
    let lower = if encloses(small.radius, around, upper) {
        lower
    } else {
        let (patch, _) = most_across(other.polyhedron, vertex, other.rotate_back(m).negate());
        let (edge, away) = side_of(own, record, side);
        let wrap = GiftWrap { frame, body, edge, vertex, m, away, from: [face, NONE] };
        match L::out_of_line(&mut WideDisc { wrap, facet, faces: [face, patch], error, small, upper, around }) {
            Some(lower) => lower,
            None => return Err(NextFacet::Nothing),
        }
    };
    let (mut points, mut features) =
        ([on_face(record, below), L::from_vector(deepest)], [FeatureId::Face(face), FeatureId::Vertex(vertex)]);
    let mut direction = m;
    if body == 1 {
        (points, features, direction) = ([points[1], points[0]], [features[1], features[0]], m.negate());
    }
    Ok(Proved { lower, upper, depth, direction, points, features, facet, steps: 0 })
}

/// A disc of C around the origin's foot, across a direction up to what its lowest place is lower.
#[derive(Clone, Copy)]
struct Disc {
    radius: f64,
    /// No place of it is lower along the direction.
    lower: f64,
}

/// The face at a vertex whose normal is most along a direction in the body's axes, and the cosine.
#[inline(always)]
fn most_across<L: Lanes>(polyhedron: &Polyhedron, vertex: u32, along: L) -> (u32, f64) {
    let (mut best, mut most) = (0, f64::NEG_INFINITY);
    for block in polyhedron.neighbour_blocks(vertex) {
        // No closures: the compiler may leave them without the vector unit's instructions (R2).
        for edge in block.edge {
            if edge == NONE {
                continue;
            }
            let edge = &polyhedron.edges[edge as usize];
            // Around the vertex each face comes with one edge as its left one.
            let at = usize::from(edge.tail() != vertex);
            let cosine = L::from_vector(&edge.normals[at]).dot(along);
            if cosine > most {
                (best, most) = ([edge.left(), edge.right()][at], cosine);
            }
        }
    }
    (best, most)
}

/// How long a vector of length 1 is at least that is placed.
#[inline(always)]
fn shortest_of_unit<L>(frame: &Frame<L>) -> f64 {
    if frame.rigid { 1.0 } else { SHORTENED }
}

/// The wide one of two discs: a face of a body less one low point of the other, which is on a face that looks at it; the corners
/// of a contact face less such a point; or the facet and the one across its nearest side.
struct WideDisc<'a, L> {
    /// Across the facet's nearest side; its body is the one whose face it is.
    wrap: GiftWrap<'a, L>,
    facet: Facet,
    /// Of this body and the other.
    faces: [u32; 2],
    error: f64,
    small: Disc,
    upper: f64,
    /// How deep below the origin C has a point, and how far aside.
    around: [f64; 2],
}

impl<L: Lanes> Work for WideDisc<'_, L> {
    /// What the depth is at least, if both discs prove it.
    type Output = Option<f64>;

    #[inline(always)]
    fn run(&mut self) -> Option<f64> {
        if let Some(wide) = self.on_patch()
            && let Some(lower) = self.prove(wide)
        {
            return Some(lower);
        }
        self.prove_by_contact_faces().or_else(|| self.prove_by_fold())
    }
}

impl<L: Lanes> WideDisc<'_, L> {
    #[inline(always)]
    fn prove(&self, wide: Disc) -> Option<f64> {
        let &WideDisc { wrap: GiftWrap { frame, .. }, small, upper, around, .. } = self;
        if !(encloses(wide.radius, around, upper) && wide.lower > 0.0 && wide.radius > upper * (1.0 + SURELY)) {
            return None;
        }
        if wide.lower >= small.lower || is_good(frame, wide.lower, upper) {
            return Some(wide.lower.min(small.lower));
        }
        if !(small.radius > 0.0 && small.radius <= upper) {
            return None;
        }
        let (s, e) = (small.radius / upper, small.lower - wide.lower);
        let needed = small.radius + e * (1.0 - s * s) / (2.0 * s);
        // False for a NaN.
        (wide.radius * (1.0 - SURELY) >= needed).then_some(small.lower)
    }

    /// The place of the other body that is chosen may be any that is in it: the middle of this body's face, or where that is not
    /// below the other's, the nearest place on the way to the middle of that.
    #[inline(always)]
    fn on_patch(&self) -> Option<Disc> {
        let &WideDisc { wrap: GiftWrap { frame, body, m, .. }, faces: [face, patch], error, .. } = self;
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let record = own.polyhedron.faces.get(face as usize)?;
        let patch = other.polyhedron.faces.get(patch as usize)?;
        let from = on_face(record, L::from_vector(&own.polyhedron.outlines.middle));
        let from = on_face(patch, other.turn_back(own.rotate_lanes(from).add(own.offset)));
        let to = on_face(patch, L::from_vector(&other.polyhedron.outlines.middle));
        let way = to.sub(from);
        let (start, _) = least_inside(other.polyhedron, patch, from);
        let (end, _) = least_inside(other.polyhedron, patch, to);
        // Sides are right to far less; what is inside by this is in the face.
        let least = 4.0 * error;
        // False for a NaN.
        if !(end > least) {
            return None;
        }
        let share = if start >= least { 0.0 } else { (least - start) / (end - start) };
        // A point of the other body up to what the face is thick: least heights of sides are concave along the way.
        let point = way.mul_add(L::splat(share), from);
        let below = own.turn_back(other.rotate_lanes(point).sub(own.offset));
        // Along m the origin is over this place of the face.
        let (normal, along, up) = (L::from_vector(&record.normal), own.turn_back(m), own.rotate_back(m));
        let cosine = normal.dot(along);
        if !(cosine > 0.5) {
            return None;
        }
        let height = (-record.planes.offset[0] - normal.dot(below)) / cosine;
        let foot = along.mul_add(L::splat(height), below);
        let (inside, _) = least_inside(own.polyhedron, record, foot);
        // All are of length 1 up to 45u, or 0.02 of skewed poses, which may make slack as much more, too.
        let lean = normal.negated_mul_add(L::splat(normal.dot(up)), up);
        let sine = lean.dot(lean).sqrt() + 64.0 * U;
        let (aside, thick) = (4.0 * error, 1.02 * (record.slack + patch.slack));
        // The point is off its plane, and the foot off its own, by less than `error` each.
        let lower = height - inside * sine - thick - 2.0 * error;
        let short = shortest_of_unit(frame) * shortest_of_unit(frame);
        (inside > aside).then_some(Disc { radius: (inside - aside) * (cosine - 64.0 * U) * short, lower })
    }

    /// By the corners of the contact face at the nearest side, less the middle of the other body's: a plane whose corners are
    /// rounded to single precision is many facets, and the foot may be near a corner of some.
    #[inline(always)]
    fn prove_by_contact_faces(&self) -> Option<f64> {
        let &WideDisc { wrap: GiftWrap { frame, body, edge, vertex, m, .. }, faces: [_, patch], error, .. } = self;
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let tail = own.polyhedron.edges[edge as usize].tail();
        let corners = contact_corners(own.polyhedron, tail, own.rotate_back(m))?;
        let middle = match contact_corners(other.polyhedron, vertex, other.rotate_back(m).negate()) {
            Some(corners) => mean(corners.iter().map(|v| other.polyhedron.vertices[*v as usize].position)),
            None => {
                let sides = other.polyhedron.faces[patch as usize].side_count.min(MOST_SIDES as u32);
                mean(
                    (0..sides)
                        .map(|side| other.polyhedron.vertices[other.polyhedron.corner(patch, side) as usize].position),
                )
            }
        };
        let mut polygon = FacetPolygon::EMPTY;
        polygon.count = corners.len();
        for (corner, vertex) in polygon.corners.get_mut(..polygon.count)?.iter_mut().zip(corners) {
            let place = &own.polyhedron.vertices[*vertex as usize].position;
            let [p, q] = if body == 0 { [place, &middle] } else { [&middle, place] };
            *corner = frame.difference(p, q).to_vector();
        }
        let out = if body == 0 { m } else { m.negate() }.to_vector();
        let places = polygon.corners[..polygon.count].iter();
        let least = places.map(|corner| out.dot(corner)).fold(f64::INFINITY, f64::min);
        let ([room, _], _) = polygon.rooms(&out);
        // The mean of up to 32 corners is right to 34u of its body's radius.
        self.prove(Disc { radius: room - 4.0 * error, lower: least - 6.0 * error })
    }

    /// By the facet and that across its nearest side: seen along the normal, a disc that is inside of all other sides of both is on
    /// them.
    #[inline(always)]
    fn prove_by_fold(&self) -> Option<f64> {
        let WideDisc { wrap, facet, error, upper, .. } = self;
        let NextFacet::Facet(next) = wrap.next() else { return None };
        let first = FacetPolygon::of(wrap.frame, *facet, wrap.vertex)?;
        let second = FacetPolygon::of(wrap.frame, next, wrap.vertex)?;
        let out = if wrap.body == 0 { wrap.m } else { wrap.m.negate() }.to_vector();
        let ([_, room1], side1) = first.rooms(&out);
        let ([_, room2], side2) = second.rooms(&out);
        let ([a, b], [c, d]) = (first.side(side1), second.side(side2));
        if !((a == d && b == c) || (a == c && b == d)) {
            return None;
        }
        let [p, q, r] = [0, second.count / 3, 2 * second.count / 3].map(|corner| second.corners[corner]);
        let normal = (q - p).cross(&(r - p)).normalize();
        let normal = if normal.dot(&out) < 0.0 { -normal } else { normal };
        let cosine = normal.dot(&out);
        // False for a NaN.
        if !(cosine > 0.1) {
            return None;
        }
        let corners = second.corners[..second.count].iter();
        let least = corners.map(|corner| normal.dot(corner)).fold(f64::INFINITY, f64::min);
        let (level, slope) = ((least - 2.0 * error) / cosine, (normal - out * cosine).norm() / cosine);
        // Products of computed corners are right to some 10u of the lengths.
        let room = if room1 < room2 { room1 } else { room2 } - 4.0 * error;
        for reach in REACHES {
            let radius = reach * upper;
            if radius <= room
                && let Some(lower) = self.prove(Disc { radius, lower: level - radius * (slope + 64.0 * U) })
            {
                return Some(lower);
            }
        }
        None
    }
}

/// Radii of a wide disc on a fold, over the depth: a larger one lies lower, a smaller one needs a point farther below.
const REACHES: [f64; 3] = [1.1, 1.5, 2.5];

/// Sides of a facet that is looked at as a polygon.
const MOST_SIDES: usize = 32;

/// The corners of a facet as computed, in order.
struct FacetPolygon {
    corners: [Vector; MOST_SIDES],
    count: usize,
}

/// The corners of the contact face at a vertex that looks most along a direction in the body's axes, if there is one.
#[inline(always)]
fn contact_corners<L: Lanes>(polyhedron: &Polyhedron, vertex: u32, along: L) -> Option<&[u32]> {
    let contact = &polyhedron.contact_faces;
    let cosine = |face: u32| L::from_vector(&contact.faces[face as usize].normal).dot(along);
    let number = contact.at(vertex).max_by(|a, b| cosine(*a).total_cmp(&cosine(*b)))?;
    let face = &contact.faces[number as usize];
    let corners = &contact.corners[face.first_corner as usize..][..face.corner_count as usize];
    (corners.len() <= MOST_SIDES).then_some(corners)
}

/// A convex combination of points, as computed.
#[inline(always)]
fn mean(points: impl ExactSizeIterator<Item = Vector>) -> Vector {
    let count = points.len() as f64;
    points.sum::<Vector>() / count
}

impl FacetPolygon {
    const EMPTY: FacetPolygon = FacetPolygon { corners: [Vector::new(0.0, 0.0, 0.0); MOST_SIDES], count: 0 };

    /// A face with a vertex of the other body, or two edges. `None` of many sides.
    #[inline(always)]
    fn of<L: Lanes>(frame: &Frame<L>, facet: Facet, vertex: u32) -> Option<FacetPolygon> {
        let [polyhedron1, polyhedron2] = frame.polyhedra();
        let mut polygon = FacetPolygon { count: 4, ..FacetPolygon::EMPTY };
        let mut pairs = [[vertex; 2]; MOST_SIDES];
        match facet {
            Facet::Face(body, face) => {
                let polyhedron = frame.bodies[body].polyhedron;
                polygon.count = polyhedron.faces[face as usize].side_count as usize;
                for (side, pair) in (0..).zip(pairs.get_mut(..polygon.count)?) {
                    pair[body] = polyhedron.corner(face, side);
                }
            }
            Facet::Edges([first, second]) => {
                let (edge1, edge2) = (&polyhedron1.edges[first as usize], &polyhedron2.edges[second as usize]);
                for (at, pair) in pairs[..4].iter_mut().enumerate() {
                    *pair = [
                        if at == 1 || at == 2 { edge1.head() } else { edge1.tail() },
                        if at < 2 { edge2.tail() } else { edge2.head() },
                    ];
                }
            }
        }
        for (corner, [v, w]) in polygon.corners.iter_mut().zip(&pairs[..polygon.count]) {
            let (p, q) = (&polyhedron1.vertices[*v as usize].position, &polyhedron2.vertices[*w as usize].position);
            *corner = frame.difference(p, q).to_vector();
        }
        Some(polygon)
    }

    #[inline(always)]
    fn side(&self, side: usize) -> [Vector; 2] {
        [self.corners[side], self.corners[if side + 1 < self.count { side + 1 } else { 0 }]]
    }

    /// How far the origin is inside the nearest two sides, seen along a direction, and which is the nearest.
    #[inline(always)]
    fn rooms(&self, along: &Vector) -> ([f64; 2], usize) {
        let middle = self.corners[..self.count].iter().sum::<Vector>() / self.count as f64;
        let (mut rooms, mut nearest) = ([f64::INFINITY; 2], 0);
        for side in 0..self.count {
            let [from, to] = self.side(side);
            let across = (to - from).cross(along);
            let sign = if across.dot(&(middle - from)) < 0.0 { 1.0 } else { -1.0 };
            let room = sign * across.dot(&from) / across.norm();
            if room < rooms[0] {
                (rooms, nearest) = ([room, rooms[0]], side);
            } else if room < rooms[1] {
                rooms[1] = room;
            }
        }
        (rooms, nearest)
    }
}

/// The foot of a point on a face's plane.
#[inline(always)]
fn on_face<L: Lanes>(face: &MergedFace, point: L) -> L {
    let normal = L::from_vector(&face.normal);
    normal.negated_mul_add(L::splat(normal.dot(point) + face.planes.offset[0]), point)
}

/// How far a place is inside the nearest side of a face, and which that is.
#[inline(always)]
fn least_inside<L: Lanes>(polyhedron: &Polyhedron, face: &MergedFace, place: L) -> (f64, usize) {
    let [x, y, z] = [place.splat_x(), place.splat_y(), place.splat_z()];
    let planes = &face.planes;
    let value = x.mul_add(
        L::load(&planes.x),
        y.mul_add(L::load(&planes.y), z.mul_add(L::load(&planes.z), L::load(&planes.offset))),
    );
    let (mut least, mut first) = (value.with_first(L::splat(f64::INFINITY)), L::splat(-1.0));
    let (mut at, four) = (L::splat(3.0), L::splat(4.0));
    for planes in polyhedron.further_sides(face) {
        let value = x.mul_add(
            L::load(&planes.x),
            y.mul_add(L::load(&planes.y), z.mul_add(L::load(&planes.z), L::load(&planes.offset))),
        );
        first = at.where_greater(least, value, first);
        least = least.min(value);
        at = at.add(four);
    }
    let (inside, lane) = least.least();
    (inside, (first.to_array()[lane & 3] + lane as f64) as usize)
}

/// The edge at a side of a face, and the direction in the plane of the face away from it.
#[inline(always)]
fn side_of<L: Lanes>(body: &Body<L>, face: &MergedFace, side: usize) -> (u32, L) {
    let side = side.min(face.side_count as usize - 1);
    let [x, y, z, _] = body.polyhedron.side_plane(face, side);
    (body.polyhedron.side(face, side as u32), body.rotate(&Vector::new(x, y, z)).negate())
}

/// Gift wrapping: the facet across the side that an edge of a body and a vertex of the other make.
struct GiftWrap<'a, L> {
    frame: &'a Frame<'a, L>,
    /// The one with the edge.
    body: usize,
    edge: u32,
    vertex: u32,
    /// The normal of the facet, out of this body.
    m: L,
    /// In its plane, away from it.
    away: L,
    /// The face of this body and the edge of the other that the facet is of.
    from: [u32; 2],
}

impl<L: Lanes> Work for GiftWrap<'_, L> {
    type Output = NextFacet;

    #[inline(always)]
    fn run(&mut self) -> NextFacet {
        self.next()
    }
}

impl<L: Lanes> GiftWrap<'_, L> {
    /// The plane of the facet turns around the side: what it meets after the least angle is the next.
    #[inline(always)]
    fn next(&self) -> NextFacet {
        let GiftWrap { frame, body, edge, vertex, m, away, from } = *self;
        let (own, other) = (&frame.bodies[body], &frame.bodies[1 - body]);
        let record = &own.polyhedron.edges[edge as usize];
        // Next to a half turn.
        let (mut best, mut found) = ([-1.0, f64::MIN_POSITIVE], NextFacet::Nothing);
        for (face, normal) in [record.left(), record.right()].into_iter().zip(&record.normals) {
            let normal = own.rotate(normal);
            let angle = [normal.dot(m), normal.dot(away)];
            if face != from[0] && angle[1] > 0.0 && comes_before(angle, best) {
                (best, found) = (angle, NextFacet::Facet(Facet::Face(body, face)));
            }
        }
        let (down, across) = (other.rotate_back(m), other.rotate_back(away));
        let place = L::from_vector(&other.polyhedron.vertices[vertex as usize].position);
        for block in other.polyhedron.neighbour_blocks(vertex) {
            for (head, turned) in block.head.into_iter().zip(block.edge) {
                if turned == NONE || turned == from[1] {
                    continue;
                }
                let to = L::from_vector(&other.polyhedron.vertices[head as usize].position).sub(place);
                // No vertex is lower, rounding apart.
                let angle = [-to.dot(across), to.dot(down).max(0.0)];
                if comes_before(angle, best) {
                    let edges = if body == 0 { [edge, turned] } else { [turned, edge] };
                    (best, found) = (angle, NextFacet::Facet(Facet::Edges(edges)));
                }
            }
        }
        found
    }
}

/// Whether one angle from 0 to a half turn is less than another, by their cosines and sines up to a factor.
#[inline(always)]
fn comes_before([x, y]: [f64; 2], [other_x, other_y]: [f64; 2]) -> bool {
    x * other_y - y * other_x > 0.0
}

/// A share of the way from one point to another.
#[inline(always)]
fn part_of<L: Lanes>([tail, head]: [&Vector; 2], share: f64) -> L {
    let tail = L::from_vector(tail);
    L::from_vector(head).sub(tail).mul_add(L::splat(share), tail)
}

/// A facet that is the parallelogram of two edges.
struct AtEdges<'a, L> {
    frame: &'a Frame<'a, L>,
    edges: [u32; 2],
}

impl<L: Lanes> Work for AtEdges<'_, L> {
    type Output = Result<Proved<L>, NextFacet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        let AtEdges { frame, edges } = *self;
        let [body1, body2] = &frame.bodies;
        let [polyhedron1, polyhedron2] = frame.polyhedra();
        let (Some(edge1), Some(edge2)) =
            (polyhedron1.edges.get(edges[0] as usize), polyhedron2.edges.get(edges[1] as usize))
        else {
            return Err(NextFacet::Nothing);
        };
        let ends = [
            [&edge1.tail_position, &polyhedron1.vertices[edge1.head() as usize].position],
            [&edge2.tail_position, &polyhedron2.vertices[edge2.head() as usize].position],
        ];
        // From body 1's origin, in world axes.
        let [a, b] = [body1.rotate(ends[0][0]), body1.rotate(ends[0][1])];
        let [c, d] = [body2.rotate(ends[1][0]).sub(body1.offset), body2.rotate(ends[1][1]).sub(body1.offset)];
        let (e, g) = (b.sub(a), d.sub(c));
        let across = e.cross(g);
        let [square, of_e, of_g] = [across.dot(across), e.dot(e), g.dot(g)];
        if !(square > LEAST_SQUARE * of_e * of_g) {
            return Err(self.beside(across));
        }
        let unit = across.mul(L::splat(1.0 / square.sqrt()));
        let start = a.sub(c);
        let m = if unit.dot(start) < 0.0 { unit.negate() } else { unit };
        let (top, _, above) = lowest(polyhedron1, body1.rotate_back(m).negate(), Some(edge1.tail()));
        let (bottom, _, below) = lowest(polyhedron2, body2.rotate_back(m), Some(edge2.tail()));
        let error = rounding(frame, polyhedron1, polyhedron2);
        // C reaches as high, and the corners of the parallelogram are as high.
        let upper = m.dot(body1.offset) - top - bottom + above + below + error;
        let heights = [m.dot(a), m.dot(b), m.dot(c), m.dot(d)];
        let mut lower = heights[0].min(heights[1]) - heights[2].max(heights[3]) - error;
        if !is_good(frame, lower, upper) {
            return Err(self.beside(m));
        }
        // How far the origin's foot is from the lines along e through both ends of g, and along g through both ends of e.
        let (beside_e, beside_g) = (m.cross(e), m.cross(g));
        let (per_e, per_g) = (1.0 / of_e.sqrt(), 1.0 / of_g.sqrt());
        let along_e = [beside_e.dot(start) * per_e, beside_e.dot(start.sub(g)) * per_e];
        let along_g = [beside_g.dot(start) * per_g, beside_g.dot(start.add(e)) * per_g];
        let sign_e = if along_e[0] > along_e[1] { 1.0 } else { -1.0 };
        let sign_g = if along_g[0] > along_g[1] { 1.0 } else { -1.0 };
        let inside = [sign_e * along_e[0], -sign_e * along_e[1], sign_g * along_g[0], -sign_g * along_g[1]];
        let mut side = 0;
        for other in 1..4 {
            side = if inside[other] < inside[side] { other } else { side };
        }
        if !(inside[side] > 0.0) {
            return Err(L::out_of_line(&mut self.beyond(side, m, [e, g])));
        }
        let around = middle(frame, body1, body2, m, error);
        let small = Disc { radius: inside[side] - 4.0 * error, lower };
        if !encloses(small.radius, around, upper) {
            let wrap = self.beyond(side, m, [e, g]);
            let faces =
                [self.face_most_across(wrap.body, wrap.m), self.face_most_across(1 - wrap.body, wrap.m.negate())];
            let facet = Facet::Edges(edges);
            match L::out_of_line(&mut WideDisc { wrap, facet, faces, error, small, upper, around }) {
                Some(proved) => lower = proved,
                None => return Err(NextFacet::Nothing),
            }
        }
        // a + s·e is over c + t·g along m.
        let (per, between) = (1.0 / across.dot(m), c.sub(a));
        let (s, t) = (between.cross(g).dot(m) * per, between.cross(e).dot(m) * per);
        let points = [part_of(ends[0], s), part_of(ends[1], t)];
        let (depth, features) = (0.5 * (lower + upper), [FeatureId::Edge(edges[0]), FeatureId::Edge(edges[1])]);
        Ok(Proved { lower, upper, depth, direction: m, points, features, facet: Facet::Edges(edges), steps: 0 })
    }
}

impl<L: Lanes> AtEdges<'_, L> {
    /// The face beside a body's edge whose normal is most along a direction.
    #[inline(always)]
    fn face_most_across(&self, body: usize, direction: L) -> u32 {
        let placed = &self.frame.bodies[body];
        let record = &placed.polyhedron.edges[self.edges[body] as usize];
        let along = placed.rotate_back(direction);
        let [left, right] = &record.normals;
        let is_left = along.dot(L::from_vector(left)) >= along.dot(L::from_vector(right));
        if is_left { record.left() } else { record.right() }
    }

    /// Where the edges have no facet any more: of the faces beside them that which is most across a direction.
    #[inline(always)]
    fn beside(&self, direction: L) -> NextFacet {
        let (mut most, mut best) = (0.0, NextFacet::Nothing);
        for (body, edge) in self.edges.into_iter().enumerate() {
            let placed = &self.frame.bodies[body];
            let record = &placed.polyhedron.edges[edge as usize];
            let along = placed.rotate_back(direction);
            let per = 1.0 / direction.dot(direction).sqrt();
            for (face, normal) in [record.left(), record.right()].into_iter().zip(&record.normals) {
                let cosine = (along.dot(L::from_vector(normal)) * per).abs();
                if cosine > most {
                    (most, best) = (cosine, NextFacet::Facet(Facet::Face(body, face)));
                }
            }
        }
        best
    }

    /// To the facet beyond a side of the parallelogram: along e at the tail or the head of g, or along g at the tail or the head
    /// of e.
    #[inline(always)]
    fn beyond(&self, side: usize, m: L, [e, g]: [L; 2]) -> GiftWrap<'_, L> {
        let AtEdges { frame, edges: [edge1, edge2] } = *self;
        let ends = |body: usize, edge: u32| {
            let record = &frame.bodies[body].polyhedron.edges[edge as usize];
            [record.tail(), record.head()]
        };
        let (body, edge, vertex, normal, along, out, other) = if side < 2 {
            // C is a − c along −g.
            let out = if side == 0 { g } else { g.negate() };
            (0, edge1, ends(1, edge2)[side], m, e, out, edge2)
        } else {
            let out = if side == 2 { e } else { e.negate() };
            (1, edge2, ends(0, edge1)[side - 2], m.negate(), g, out, edge1)
        };
        let across = m.cross(along);
        let away = if across.dot(out) < 0.0 { across.negate() } else { across };
        let away = away.mul(L::splat(1.0 / away.dot(away).sqrt()));
        GiftWrap { frame, body, edge, vertex, m: normal, away, from: [NONE, other] }
    }
}
