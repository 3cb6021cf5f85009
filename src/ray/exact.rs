//! A ray cast in integers, for a body of any dimension and any magnitudes.
//!
//! The hull's surface is made of closed triangles. Three volumes tell whether the line meets one: those of its direction with the
//! triangle's sides. The line enters through one of those that it meets from outside, wherever on the triangle that is, corners
//! and sides included: of all planes through a point at which a line enters a convex body, one faces the line. Doubles decide
//! most signs. A body without interior that holds the line in its plane is met along its edges.

use std::cmp::Ordering;

use dashu_int::IBig;

use super::line::{Line, LineSide};
use super::{Ray, RayAnswer, RayOutcome};
use crate::answer::{label, normalised};
use crate::base::math::{Pose, Vector};
use crate::body::polyhedron::Polyhedron;
use crate::placed::exact::body::ExactBody;
use crate::placed::exact::dyadic::{
    DyadicVector, IntVector, bounds_of_quotient_by_root, cross, decode, dot, leading_bits,
};
use crate::placed::state::FeatureId;

/// A place on the line: numerator / denominator · 2^exponent, with a positive denominator.
#[derive(Debug, Clone)]
struct RayPlace {
    numerator: IBig,
    denominator: IBig,
    exponent: i32,
}

/// The part of the line in the body.
struct RayPart {
    entry: RayPlace,
    exit: RayPlace,
    /// The feature that it enters through.
    feature: FeatureId,
}

/// Casts the ray anew; `line` tells signs where doubles do.
pub(super) fn cast(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, line: Option<&Line>, answer: &mut RayAnswer) {
    let cast = ExactCast {
        polyhedron,
        body: ExactBody::new(polyhedron, pose),
        origin: DyadicVector::from_doubles(ray.origin),
        direction: DyadicVector::from_doubles(ray.direction),
        line,
    };
    answer.exact = 1;
    answer.outcome = RayOutcome::Miss;
    let Some(RayPart { entry, exit, feature }) = cast.part() else { return };
    if exit.is_negative() || entry.compare(ray.t_max).is_gt() {
        return;
    }
    answer.exit = if exit.compare(ray.t_max).is_gt() { [ray.t_max; 2] } else { exit.bounds() };
    if entry.is_negative() {
        answer.outcome = RayOutcome::Inside;
        answer.entry = [0.0; 2];
        return;
    }
    answer.outcome = RayOutcome::Hit;
    answer.entry = entry.bounds();
    answer.normal = cast.normal(feature);
    answer.feature = label(polyhedron, feature, &point(polyhedron, pose, ray, answer.entry[0]));
}

struct ExactCast<'a> {
    polyhedron: &'a Polyhedron,
    body: ExactBody<'a>,
    origin: DyadicVector,
    direction: DyadicVector,
    line: Option<&'a Line<'a>>,
}

/// Position of a triangle relative to the line.
#[derive(PartialEq, Eq)]
enum Met {
    /// From outside.
    Entering,
    /// From inside.
    Leaving,
    /// Not, or along its plane.
    No,
}

impl ExactCast<'_> {
    /// A vertex relative to the ray's origin.
    fn vertex(&self, vertex: u32) -> DyadicVector {
        self.body.world_vertex(vertex).difference(self.origin.clone())
    }

    /// Vertices relative to the ray's origin, over one power of two.
    fn vertices<const N: usize>(&self, vertices: [u32; N]) -> ([IntVector; N], i32) {
        let mut all = vertices.map(|v| self.vertex(v));
        let exponent = all.iter().map(|v| v.exponent).min().unwrap_or(0);
        all.iter_mut().for_each(|v| v.refine(exponent));
        (all.map(|v| v.components), exponent)
    }

    fn part(&self) -> Option<RayPart> {
        match self.polyhedron.dimension {
            0 => self.at_point(),
            1 => {
                let places = self.on_segment([0, 1]);
                let places = || places.iter().flatten();
                let (entry, exit) = (places().min_by(order)?.clone(), places().max_by(order)?.clone());
                Some(RayPart { entry, exit, feature: FeatureId::Edge(0) })
            }
            _ => self.through_triangles().or_else(|| self.in_plane()),
        }
    }

    /// Between the triangles that it comes in and goes out through.
    fn through_triangles(&self) -> Option<RayPart> {
        let (mut entering, mut leaving) = (None, None);
        for (triangle, &corners) in (0..).zip(&self.polyhedron.triangles) {
            match self.meets(corners) {
                Met::Entering => entering = entering.or(Some(triangle)),
                Met::Leaving => leaving = leaving.or(Some(triangle)),
                Met::No => continue,
            }
            if let (Some(entering), Some(leaving)) = (entering, leaving) {
                let face = self.polyhedron.face_of_triangle[entering as usize];
                return Some(RayPart {
                    entry: self.on_plane(entering),
                    exit: self.on_plane(leaving),
                    feature: FeatureId::Face(face),
                });
            }
        }
        None
    }

    /// How the line meets a closed triangle. The sum of the three volumes is the product of direction and normal.
    fn meets(&self, [a, b, c]: [u32; 3]) -> Met {
        let (mut lefts, mut rights) = (0, 0);
        for side in [[a, b], [b, c], [c, a]] {
            match self.side(side) {
                Some(LineSide::Left) => lefts += 1,
                Some(LineSide::Right) => rights += 1,
                None => {}
            }
            if lefts > 0 && rights > 0 {
                return Met::No;
            }
        }
        match (lefts, rights) {
            (0, 0) => Met::No,
            (_, 0) => Met::Entering,
            _ => Met::Leaving,
        }
    }

    /// On which side the line passes by another; none where both are in one plane.
    fn side(&self, [tail, head]: [u32; 2]) -> Option<LineSide> {
        if let Some(side) = self.line.and_then(|line| line.side([tail, head])) {
            return Some(side);
        }
        let ([from, to], _) = self.vertices([tail, head]);
        // The head relative to the tail or to the origin: across the tail it is the same.
        match dot(&self.direction.components, &cross(&to, &from)).cmp(&IBig::ZERO) {
            Ordering::Greater => Some(LineSide::Left),
            Ordering::Less => Some(LineSide::Right),
            Ordering::Equal => None,
        }
    }

    /// The line's crossing with the plane of a triangle that is not along it.
    fn on_plane(&self, triangle: u32) -> RayPlace {
        let ([a, b, c], exponent) = self.vertices(self.polyhedron.triangles[triangle as usize]);
        let normal = cross(&minus(&b, &a), &minus(&c, &a));
        self.place(dot(&normal, &a), dot(&normal, &self.direction.components), exponent)
    }

    /// The part of a line that may be in the plane of a flat body, from where it meets the sides of the body's triangles.
    fn in_plane(&self) -> Option<RayPart> {
        if self.polyhedron.dimension != 2 {
            return None;
        }
        let mut part: Option<RayPart> = None;
        for (&[a, b, c], &face) in self.polyhedron.triangles.iter().zip(&self.polyhedron.face_of_triangle) {
            for place in [[a, b], [b, c], [c, a]].into_iter().flat_map(|side| self.on_segment(side)).flatten() {
                match &mut part {
                    None => part = Some(RayPart { entry: place.clone(), exit: place, feature: FeatureId::Face(face) }),
                    Some(part) if order(&&place, &&part.entry).is_lt() => {
                        (part.entry, part.feature) = (place, FeatureId::Face(face));
                    }
                    Some(part) if order(&&place, &&part.exit).is_gt() => part.exit = place,
                    Some(_) => {}
                }
            }
        }
        part
    }

    /// The line's meeting with a segment: nowhere, in a point, or from one end to the other.
    fn on_segment(&self, ends: [u32; 2]) -> [Option<RayPlace>; 2] {
        // Far from most segments.
        if self.line.is_some_and(|line| line.side(ends).is_some()) {
            return [None, None];
        }
        let ([from, to], exponent) = self.vertices(ends);
        let direction = &self.direction.components;
        let along = minus(&to, &from);
        let (across, from_line) = (cross(direction, &along), cross(&from, direction));
        let square = dot(&across, &across);
        if square.is_zero() {
            if !is_zero(&from_line) {
                return [None, None];
            }
            let length = dot(direction, direction);
            return [&from, &to].map(|end| Some(self.place(dot(direction, end), length.clone(), exponent)));
        }
        // t·d = from + s·along: multiplied across `along`, t·across = from × along; across d, s·across = from × d.
        if !dot(&from, &across).is_zero() {
            return [None, None];
        }
        let share = dot(&from_line, &across);
        if share < IBig::ZERO || share > square {
            return [None, None];
        }
        [Some(self.place(dot(&cross(&from, &along), &across), square, exponent)), None]
    }

    fn at_point(&self) -> Option<RayPart> {
        let ([vertex], exponent) = self.vertices([0]);
        let direction = &self.direction.components;
        if !is_zero(&cross(&vertex, direction)) {
            return None;
        }
        let place = self.place(dot(&vertex, direction), dot(direction, direction), exponent);
        Some(RayPart { entry: place.clone(), exit: place, feature: FeatureId::Vertex(0) })
    }

    /// The place t with t·denominator = numerator; `exponent` is that of the vertices in the numerator.
    fn place(&self, numerator: IBig, denominator: IBig, exponent: i32) -> RayPlace {
        let exponent = exponent - self.direction.exponent;
        match denominator < IBig::ZERO {
            true => RayPlace { numerator: -numerator, denominator: -denominator, exponent },
            false => RayPlace { numerator, denominator, exponent },
        }
    }

    /// The outward unit normal of a feature in the world, rounded.
    fn normal(&self, feature: FeatureId) -> [f64; 3] {
        let against = -leading_bits(&self.direction.components);
        let FeatureId::Face(face) = feature else { return normalised(&against) };
        // The normal of the widest triangle, so that for a merged face it is about the face's.
        let of_face =
            self.polyhedron.face_of_triangle.iter().zip(&self.polyhedron.triangles).filter(|(f, _)| **f == face);
        let normals = of_face.map(|(_, corners)| {
            let ([a, b, c], exponent) = self.vertices(*corners);
            (cross(&minus(&b, &a), &minus(&c, &a)), exponent)
        });
        let widest = normals.max_by(|(m, of_m), (n, of_n)| {
            let (mut squares, exponents) = ([dot(m, m), dot(n, n)], [*of_m, *of_n]);
            let least = exponents[0].min(exponents[1]);
            // The exponent of a normal is twice that of its vertices, that of a square four times.
            squares.iter_mut().zip(exponents).for_each(|(square, own)| *square <<= 4 * (own - least) as usize);
            squares[0].cmp(&squares[1])
        });
        widest.map_or(normalised(&against), |(normal, _)| normalised(&leading_bits(&normal)))
    }
}

impl RayPlace {
    fn is_negative(&self) -> bool {
        self.numerator < IBig::ZERO
    }

    /// Against a double from 0 on.
    fn compare(&self, other: f64) -> Ordering {
        debug_assert!(other >= 0.0);
        if other == f64::INFINITY {
            return Ordering::Less;
        }
        let (mantissa, exponent) = decode(other);
        self.compare_products(&IBig::from(mantissa), &IBig::ONE, exponent)
    }

    fn compare_products(&self, numerator: &IBig, denominator: &IBig, exponent: i32) -> Ordering {
        let (mut own, mut others) = (&self.numerator * denominator, numerator * &self.denominator);
        let shift = self.exponent.abs_diff(exponent) as usize;
        if self.exponent > exponent {
            own <<= shift;
        } else {
            others <<= shift;
        }
        own.cmp(&others)
    }

    /// The doubles next to it, from 0 on.
    fn bounds(&self) -> [f64; 2] {
        debug_assert!(self.numerator >= IBig::ZERO);
        if self.numerator.is_zero() {
            return [0.0; 2];
        }
        let square = &self.denominator * &self.denominator;
        let (lower, upper) = bounds_of_quotient_by_root(&self.numerator, &square, self.exponent);
        [lower, upper]
    }
}

fn order(a: &&RayPlace, b: &&RayPlace) -> Ordering {
    a.compare_products(&b.numerator, &b.denominator, b.exponent)
}

fn minus(a: &IntVector, b: &IntVector) -> IntVector {
    [&a[0] - &b[0], &a[1] - &b[1], &a[2] - &b[2]]
}

fn is_zero(v: &IntVector) -> bool {
    v.iter().all(IBig::is_zero)
}

/// The ray's point at a time, in centred coordinates, about.
fn point(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, t: f64) -> Vector {
    let at = pose.rotate_back(&(ray.origin() + ray.direction() * t - pose.translation()));
    at - polyhedron.centre
}
