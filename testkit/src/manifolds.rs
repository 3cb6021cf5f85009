//! The truth about the points of a manifold: what gaps the bodies have, in integers and rationals over all their vertices.

use std::cmp::Ordering;

use dashu_ratio::RBig;
use swiftprox::manifold::ManifoldPoint;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::Placed;

use crate::any_size::integers::place;
use crate::any_size::nearest::nearest;
use crate::cases::row_major;
use crate::oracle::{rational, transform};

/// What is true of two bodies along a normal.
pub struct Gaps<'a> {
    bodies: [Placed<'a>; 2],
    vertices: [Vec<[f64; 3]>; 2],
    along: Vector,
    normal: [RBig; 3],
    /// |normal|².
    square: RBig,
    /// The gaps of all pairs of vertices, times |normal|, are between these.
    ends: [RBig; 2],
}

impl<'a> Gaps<'a> {
    pub fn new(bodies: [Placed<'a>; 2], normal: &[f64; 3]) -> Gaps<'a> {
        let vertices: [Vec<[f64; 3]>; 2] = bodies.map(|body| {
            let polyhedron = body.shape.polyhedron();
            (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v).into()).collect()
        });
        let (along, normal) = (Vector::from(*normal), normal.map(rational));
        let square = normal.iter().map(|x| x * x).fold(RBig::ZERO, |sum, x| sum + x);
        let reach = |i: usize| {
            let heights = vertices[i].iter().map(|v| height(&normal, bodies[i].pose, &v.map(rational)));
            let heights: Vec<RBig> = heights.collect();
            [heights.iter().min().expect("a vertex").clone(), heights.iter().max().expect("a vertex").clone()]
        };
        let ([low1, high1], [low2, high2]) = (reach(0), reach(1));
        let ends = [low1 - high2, high1 - low2];
        Gaps { bodies, vertices, along, normal, square, ends }
    }

    /// What is false about the gap of a point, or how far its two places are out of the bodies.
    ///
    /// No two points of the bodies may have a gap below the interval, or above it; and the points of the bodies that are nearest to
    /// the two places have one in it, up to the rounding of these. Of swept bodies the points are moved by the radii.
    pub fn check(&self, point: &ManifoldPoint) -> Result<[f64; 2], String> {
        let radii = self.bodies.map(|body| rational(body.shape.swept_radius()));
        let both = &radii[0] + &radii[1];
        // Whether a length along the normal, times |normal|, is in the interval widened by something.
        let is_in = |gap: &RBig, by: &RBig, [lower, upper]: [f64; 2]| {
            let reaches = |end: f64, sign: f64| {
                end.is_infinite() || {
                    let end = rational(sign * end) + by + &both * rational(sign);
                    compare(&(gap * rational(sign)), &end, &self.square).is_le()
                }
            };
            reaches(upper, 1.0) && reaches(lower, -1.0)
        };
        let interval = [point.gap_lower, point.gap_upper];
        let [least, most] = &self.ends;
        // The normal is that of the gap but for rounding, an angle of less than 2^-50. Along it a length is shorter by half the
        // square of that, which integers would tell from the gap.
        let short = rational(2_f64.powi(-100)) * (size_of(least) + size_of(most));
        if !(is_in(least, &short, [f64::NEG_INFINITY, interval[1]])
            && is_in(most, &short, [interval[0], f64::INFINITY]))
        {
            return Err(format!("no two points have a gap in {interval:?}: {:?}", self.ends.each_ref().map(double)));
        }
        let locals = [point.local1, point.local2];
        let (mut places, mut outs, mut rounding) = (Vec::new(), [0.0; 2], 0.0);
        for i in 0..2 {
            let Placed { shape, pose } = self.bodies[i];
            // Back from the surface of a swept body, for which the point's pose is another.
            let back = if i == 0 { shape.swept_radius() } else { -shape.swept_radius() };
            let moved = Pose::new(&pose.rotation(), &(pose.translation() + self.along * back));
            let (at, other, local) = (row_major(pose), row_major(&moved), [locals[i]]);
            let poses = std::array::from_fn(|k| if k < 12 { at[k] } else { other[k - 12] });
            let placed = place(&self.vertices[i], &local, &poses);
            let found = nearest(&placed);
            outs[i] = double(&found.world_square(&placed)).sqrt();
            let unit = 2_f64.powi(placed.exponent / 2);
            let unit = rational(unit) * rational(2_f64.powi(placed.exponent - placed.exponent / 2));
            places.push(found.point(&placed.a, 0).map(|x| x * &unit));
            let radius = shape.polyhedron().radius + shape.swept_radius();
            let lengths = radius + Vector::from(locals[i]).lp_norm(1) + pose.translation().lp_norm(1);
            rounding += 16.0 * f64::EPSILON * lengths;
        }
        let apart =
            (0..3).map(|k| &self.normal[k] * (&places[0][k] - &places[1][k])).fold(RBig::ZERO, |sum, x| sum + x);
        if !is_in(&apart, &rational(rounding), interval) {
            let (gap, both) = (double(&apart), double(&both));
            return Err(format!(
                "the nearest points have a gap of {gap:e} less {both:e}, not in {interval:?}; they are {outs:?} off"
            ));
        }
        Ok(outs)
    }
}

/// The product of a normal with a point in the world.
fn height(normal: &[RBig; 3], pose: &Pose, local: &[RBig; 3]) -> RBig {
    let world = transform(&row_major(pose), local);
    normal.iter().zip(&world).map(|(x, y)| x * y).fold(RBig::ZERO, |sum, x| sum + x)
}

/// The order of `a` and b·√square.
fn compare(a: &RBig, b: &RBig, square: &RBig) -> Ordering {
    let (is_negative, is_other_negative) = (*a < RBig::ZERO, *b < RBig::ZERO);
    let by_size = (a * a).cmp(&(b * b * square));
    match (is_negative, is_other_negative) {
        (false, false) => by_size,
        (true, true) => by_size.reverse(),
        (false, true) => Ordering::Greater,
        (true, false) => Ordering::Less,
    }
}

fn size_of(x: &RBig) -> RBig {
    if *x < RBig::ZERO { -x } else { x.clone() }
}

fn double(x: &RBig) -> f64 {
    x.to_f64().value()
}
