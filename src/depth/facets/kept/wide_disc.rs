//! The wide one of two discs around the foot: see the lemma of [`kept`](super).

use super::facet::{Disc, GiftWrap, NextFacet, SURELY, encloses, is_good, least_inside, on_face, shortest_of_unit};
use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::Polyhedron;
use crate::depth::facets::search::Facet;
use crate::placed::frame::Frame;

/// The wide one of two discs: a face of a body less one low point of the other, which is on a face that looks at it; the corners
/// of a contact face less such a point; or the facet and the one across its nearest side.
pub struct WideDisc<'a, L> {
    /// Across the facet's nearest side; its body is the one whose face it is.
    pub wrap: GiftWrap<'a, L>,
    pub facet: Facet,
    /// Of this body and the other.
    pub faces: [u32; 2],
    pub error: f64,
    pub small: Disc,
    pub upper: f64,
    /// How deep below the origin C has a point, and how far aside.
    pub around: [f64; 2],
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
