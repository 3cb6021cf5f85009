//! The independent check of a manifold: verdict, interval and normal are proved as those of a distance or a depth; each point is on
//! both surfaces, on the sides that face each other, and its gap is that of its two places.

use super::apart::verify_disjoint;
use super::bounds::{Bounds, ProvedGap};
use super::checks::{between_origins, in_default, too_large, unverified};
use super::depth::prove_depth;
use super::numbers::{AnswerNumbers, check_numbers};
use super::witness::{Witness, difference_of};
use crate::answer::{FeatureKind, Outcome, PairAnswer, Radii, sum_above, sum_below};
use crate::base::error::{Error, Result};
use crate::base::math::{Vector, length};
use crate::body::polyhedron::{MergedFace, Polyhedron};
use crate::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint, id_of};
use crate::placed::Pair;
use crate::shape::Placed;

/// Relative to the size of the pair: how far a point may be off the surface that it is on, beside noise and rounding. Places up
/// to 2⁻²⁷ of it apart are one; the incident patch is looked at along a normal that may be flat to it.
const NEAR: f64 = f64::from_bits((1023 - 25) << 52);

/// The same of the thickness of contact faces.
const NOISE: f64 = 8.0;

/// How far a point may be out of its body, in units of the rounding: it is over a face up to that, seen along the normal, which may
/// be flat to the face.
const OUT: f64 = 256.0;

/// The cosine between the direction to the other body and the normal of a face beyond which that looks away, by 6° at least.
const AWAY: f64 = -0.1;

/// Re-checks a manifold for the same shapes, poses and configuration; `cache` is that of the query, whose depth it proves, or any
/// other. `points` holds the manifold's points and may hold more.
///
/// | what is said | what is proved or checked |
/// |---|---|
/// | verdict, `lower`, `upper` | proved without tolerance, as by [`super::verify`] and [`super::verify_depth`] |
/// | `normal` | a unit vector; bodies apart are at least `lower` apart along it, others overlap by at most −`lower` |
/// | the counts, `reference` | no more points are written than found, and one at most without a reference; none beyond `max_distance` |
/// | points on the bodies | no farther than c out of them, or than b and the gap's width behind a face that looks at the other body; one point in both frames |
/// | their features | they are there; a point is no farther than b from its vertex or edge |
/// | a gap | that of the two points along the normal is in it, up to the allowance a, and so far from its ends as both are out of the bodies; at most `max_distance` |
/// | … | no interval is below, or above, the gaps of all pairs of points of the bodies; without tolerance |
/// | both points | in line along the normal up to b |
/// | all points | one is as deep as the bodies are, up to b, if none was left out |
/// | `id` | that of the features |
///
/// a is the allowance of [`verify`](super::verify). b is a, 2⁻²⁵ of the size of the pair (both radii and the distance of the
/// centres), and eight times what contact faces are thick at most; c is 256 a and half of what the body's are in the world.
/// That a face is complete is not checked.
///
/// # Errors
/// As of [`verify_depth`](super::verify_depth); [`Error::Argument`] for fewer points than the manifold has.
pub fn verify_manifold(
    bodies: [Placed; 2],
    cache: &ManifoldCache,
    config: &ManifoldConfig,
    manifold: &Manifold,
    points: &[ManifoldPoint],
) -> Result<()> {
    in_default(|| {
        config.check()?;
        bodies.iter().try_for_each(|body| body.pose.check())?;
        let Some(points) = points.get(..manifold.point_count as usize) else {
            return Err(Error::Argument(format!("{} points of {}", points.len(), manifold.point_count)));
        };
        check_counts(config, manifold)?;
        let radii = Radii::of(&bodies).unwrap_or(Radii::NONE);
        let allowed = check_contact(bodies, cache, config, &radii, manifold)?;
        let check = Check::new(Pair::of(&bodies), config, radii, manifold, allowed);
        points
            .iter()
            .enumerate()
            .try_for_each(|(k, point)| check.check_point(point).map_err(|error| error.about(&format!("point {k}"))))?;
        check.check_deepest(points)
    })
}

fn check_counts(config: &ManifoldConfig, manifold: &Manifold) -> Result<()> {
    let Manifold { outcome, reference, point_count, found_count, .. } = *manifold;
    let most = match (outcome, reference) {
        (Outcome::Beyond, 0) => 0,
        (Outcome::Separated | Outcome::Intersecting | Outcome::Undecided, 0) => 1,
        (Outcome::Separated | Outcome::Intersecting | Outcome::Undecided, 1 | 2) => u32::MAX,
        _ => return Err(unverified(format!("body {reference} as the reference of a manifold that is {outcome:?}"))),
    };
    let is_reduced = !config.reduces || point_count <= 4;
    if point_count <= found_count && found_count <= most && is_reduced {
        return Ok(());
    }
    Err(unverified(format!("{point_count} points of {found_count} found")))
}

/// Proves verdict and interval, and checks the normal; returns the rounding allowance for a length.
fn check_contact(
    bodies: [Placed; 2],
    cache: &ManifoldCache,
    config: &ManifoldConfig,
    radii: &Radii,
    manifold: &Manifold,
) -> Result<f64> {
    let pair = &Pair::of(&bodies);
    let Manifold { outcome, lower, upper, normal, .. } = *manifold;
    let is_sound = match outcome {
        // Deeper than the largest double.
        Outcome::Intersecting if lower == f64::NEG_INFINITY => return Err(too_large()),
        Outcome::Intersecting => lower <= upper && upper <= 0.0,
        Outcome::Separated => {
            0.0 <= lower
                && lower <= config.max_distance
                && lower <= upper
                && (upper < f64::INFINITY || lower == f64::MAX)
        }
        Outcome::Beyond => config.max_distance <= lower && lower <= upper && lower < f64::INFINITY,
        Outcome::Undecided => radii.deviation > 0.0 && lower <= 0.0 && 0.0 < upper && upper < f64::INFINITY,
        Outcome::None => return Err(Error::Argument("the manifold holds no outcome".into())),
    };
    if !is_sound {
        return Err(unverified(format!("an interval from lower to upper of {lower:e}, {upper:e}: {outcome:?}")));
    }
    if outcome == Outcome::Intersecting {
        let (_, allowed) = prove_depth(pair, cache.depth(), radii, &normal.into(), [-upper, -lower])?;
        return Ok(allowed);
    }
    let apart = PairAnswer { outcome, lower, distance: lower, upper, normal, ..PairAnswer::UNSAID };
    verify_disjoint(pair, radii, &apart)
}

/// The reference that points are checked against.
struct Check<'a> {
    pair: Pair<'a>,
    config: &'a ManifoldConfig,
    radii: Radii,
    manifold: &'a Manifold,
    /// The rounding allowance for a length.
    allowed: f64,
    /// How far a point may be off its surface.
    near: f64,
    /// How far a point may be out of each body.
    out: [f64; 2],
    /// The least gap of two points of the bodies along the normal, and minus the largest; `None` where double-doubles do not reach.
    reach: Option<(Bounds<'a>, [ProvedGap; 2])>,
}

impl<'a> Check<'a> {
    fn new(
        pair: Pair<'a>,
        config: &'a ManifoldConfig,
        radii: Radii,
        manifold: &'a Manifold,
        allowed: f64,
    ) -> Check<'a> {
        let Pair { polyhedra, poses } = pair;
        let between = between_origins(&pair);
        let size = polyhedra[0].radius + polyhedra[1].radius + length(&between);
        let slack =
            |polyhedron: &Polyhedron| polyhedron.contact_faces.faces.iter().map(|face| face.slack).fold(0.0, f64::max);
        let slacks = polyhedra.map(slack);
        let near = allowed + NEAR * size + NOISE * 2.0 * (slacks[0] + slacks[1]);
        // A pose that stretches makes a slab as much thicker.
        let out = [0, 1].map(|i| OUT * allowed + slacks[i] * poses[i].most_stretched());
        let normal = Vector::from(manifold.normal);
        let reach = Bounds::new(&pair).map(|bounds| {
            let gaps = [bounds.gap(&normal), bounds.gap(&-normal)];
            (bounds, gaps)
        });
        Check { pair, config, radii, manifold, allowed, near, out, reach }
    }

    fn check_point(&self, point: &ManifoldPoint) -> Result<()> {
        let normal = Vector::from(self.manifold.normal);
        check_numbers(&AnswerNumbers::of_point(point, &self.manifold.normal))?;
        if point.id != id_of(&point.feature1, &point.feature2) {
            return Err(unverified(format!("the id {:#x} is not that of its features", point.id)));
        }
        let &ManifoldPoint { local1, local2, world1, world2, feature1, feature2, gap_lower, gap_upper, .. } = point;
        let said = PairAnswer {
            local1,
            local2,
            world1,
            world2,
            feature1,
            feature2,
            normal: self.manifold.normal,
            ..PairAnswer::UNSAID
        };
        let witnesses = Witness::of_both(&self.pair, &self.radii, &normal, &said);
        for ((witness, towards), out) in witnesses.iter().zip([-normal, normal]).zip(self.out) {
            witness.check_point(out)?;
            self.check_feature(witness)?;
            self.check_facing(witness, &towards, gap_upper - gap_lower)?;
        }
        let apart = difference_of(&self.pair, &witnesses);
        let along = normal.dot(&apart);
        let gap = along - self.radii.upper;
        let has_end = gap_upper < f64::INFINITY || gap_lower == f64::MAX;
        let is_enclosed = gap_lower - self.allowed <= gap && gap <= gap_upper + self.allowed;
        if !(has_end && is_enclosed && gap_lower <= gap_upper && gap_lower <= self.config.max_distance) {
            return Err(unverified(format!("a gap of {gap:e} is not in [{gap_lower:e}, {gap_upper:e}]")));
        }
        self.check_attained(&witnesses, gap, [gap_lower, gap_upper])?;
        self.check_reach(&normal, [gap_lower, gap_upper])?;
        let sideways = length(&(apart - normal * along));
        if sideways <= self.near {
            return Ok(());
        }
        Err(unverified(format!("its two places are {sideways:e} off a line along the normal")))
    }

    /// The bodies have points with a gap in the interval: near the reported ones, which may be out of them.
    fn check_attained(&self, witnesses: &[Witness; 2], gap: f64, [lower, upper]: [f64; 2]) -> Result<()> {
        let margin = (gap - lower).min(upper - gap) + self.allowed;
        let off = witnesses.each_ref().map(|witness| Some(witness.off(&witness.point_inside()?)));
        let is_within = |[first, second]: [f64; 2]| first + second <= margin + 2.0 * self.allowed;
        if is_within(off.map(|off| off.unwrap_or(f64::INFINITY))) {
            return Ok(());
        }
        let out = [witnesses[0].outside(&[])?.bounds().1, witnesses[1].outside(&[])?.bounds().1];
        if is_within(out) {
            return Ok(());
        }
        Err(unverified(format!(
            "points {:e} and {:e} out of the objects have a gap of {gap:e} in [{lower:e}, {upper:e}]",
            out[0], out[1]
        )))
    }

    /// No points of the bodies have only gaps above the interval, or below. Ends may be negative: for a unit vector, up to
    /// rounding, half of |n|² − 1 is |n| − 1 to 2⁻⁹⁹, which the error of lengths covers.
    fn check_reach(&self, normal: &Vector, [lower, upper]: [f64; 2]) -> Result<()> {
        let Some((bounds, [least, most])) = &self.reach else { return Ok(()) };
        let too_low = bounds.prove_lower(least, normal, sum_above(upper, self.radii.upper));
        let too_high = bounds.prove_lower(most, normal, -sum_below(lower, self.radii.lower));
        if !(too_low || too_high) {
            return Ok(());
        }
        let side = if too_low { "below" } else { "above" };
        Err(unverified(format!("a gap in [{lower:e}, {upper:e}] is {side} that of any points of the objects")))
    }

    /// A point is near its vertex or edge; the face of a point is there, which may be one of several that are one to a manifold.
    fn check_feature(&self, witness: &Witness) -> Result<()> {
        match witness.feature.kind {
            FeatureKind::Face => witness.check_feature(),
            _ => witness.check_on_feature(self.near),
        }
    }

    /// A point is on a face that does not look away from the other body, or as far behind one as the width of its gap allows: a
    /// wide gap means that the point is not known to be where the bodies face each other. For a body without interior all is
    /// surface.
    fn check_facing(&self, witness: &Witness, towards: &Vector, width: f64) -> Result<()> {
        let (polyhedron, point) = (witness.polyhedron, witness.centred());
        // R has an inverse: det R > 0. In the world a face's normal is (R⁻¹)ᵀ·n, and its planes are as much closer as that is
        // longer.
        let Some(back) = witness.pose.rotation().try_inverse() else { return Err(too_large()) };
        if polyhedron.dimension < 3 {
            return Ok(());
        }
        let normals = polyhedron.faces.iter().map(|face| (face, back.transpose() * face.normal));
        let mut facing = normals.filter(|(_, normal)| normal.dot(towards) >= AWAY * normal.norm()).peekable();
        // A needle so thin that faces around it are merged may have none that looks there; its faces prove nothing then.
        let is_told = facing.peek().is_some();
        let behind = self.near + width;
        let is_on = |(face, normal): (&MergedFace, Vector)| {
            face.planes.value(0, &point) + face.slack >= -behind * normal.norm()
        };
        if !is_told || facing.any(is_on) {
            return Ok(());
        }
        Err(unverified(format!("witness point {} is on no face that looks towards the other", witness.object)))
    }

    fn check_deepest(&self, points: &[ManifoldPoint]) -> Result<()> {
        let Manifold { upper, found_count, .. } = *self.manifold;
        let is_deep = |point: &ManifoldPoint| point.gap_lower <= upper + self.near;
        if points.len() < found_count as usize || points.is_empty() || points.iter().any(is_deep) {
            return Ok(());
        }
        Err(unverified(format!("no point is as deep as the objects, {upper:e}")))
    }
}
