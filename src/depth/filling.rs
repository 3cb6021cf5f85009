//! Answers from the result of a search, and from integers where that leaves the verdict open.

use super::answer::{DepthAnswer, DepthEnding, DepthStatistics};
use super::search::{DepthSearch, FoundPolytope, WIDEST};
use crate::answer::{Outcome, contact};
use crate::base::error::Result;
use crate::base::math::{Matrix, Vector, clamp};
use crate::base::memory::in_integers;
use crate::body::polyhedron::Polyhedron;
use crate::depth::facets::Overlap;
use crate::depth::polytope::{Ending, Expansion};
use crate::distance::decide::combinations;
use crate::placed::Pair;
use crate::placed::exact::{self, Differences, ExactAnswer, Position, SupportScope, VertexPair, WayOut};
use crate::placed::state::FeatureId;

/// Answers by the result of the search, `overlap` where all facets gave it, and by integers where that leaves the verdict open.
///
/// # Errors
/// [`Error::Memory`](crate::base::error::Error::Memory) where integers get none: the answer is as it was.
pub fn fill(answer: &mut DepthAnswer, pair: &Pair, found: Option<&DepthSearch>, overlap: &Overlap) -> Result<()> {
    match found {
        None => return decide(answer, pair, None),
        Some(DepthSearch::Apart(direction)) => {
            answer.statistics = DepthStatistics::default();
            fill_separated(answer, DepthEnding::Separated, &-direction);
        }
        Some(DepthSearch::Facets) => {
            answer.statistics = DepthStatistics::default();
            fill_facet(answer, pair, overlap);
        }
        Some(DepthSearch::Polytope(found)) => return fill_by_polytope(answer, pair, found),
        Some(DepthSearch::Answered) => {}
    }
    Ok(())
}

fn fill_by_polytope(answer: &mut DepthAnswer, pair: &Pair, found: &FoundPolytope) -> Result<()> {
    let Expansion { ending, lower, direction, .. } = found.expansion;
    if ending != Ending::Separated && (!(lower > 0.0) || is_lost_in_needle(pair.polyhedra, &found.expansion)) {
        return decide(answer, pair, Some(found));
    }
    answer.statistics = statistics_of(Some(found), 0);
    if ending == Ending::Separated {
        fill_separated(answer, DepthEnding::Separated, &-direction);
        return Ok(());
    }
    answer.ending = match ending {
        Ending::Spent => DepthEnding::Budget,
        Ending::Stuck | Ending::Flat | Ending::Outdated => DepthEnding::Stalled,
        Ending::Narrow | Ending::Separated => DepthEnding::Narrow,
    };
    fill_overlapping(answer, pair, found);
    Ok(())
}

/// The statistics of a search, and of integers after it.
fn statistics_of(found: Option<&FoundPolytope>, exact_iterations: u32) -> DepthStatistics {
    let done = |found: &FoundPolytope| {
        let FoundPolytope { expansion: Expansion { steps, supports, .. }, triangles, .. } = *found;
        DepthStatistics { steps, supports, triangles, exact_iterations }
    };
    found.map_or(DepthStatistics { exact_iterations, ..DepthStatistics::default() }, done)
}

fn fill_facet(answer: &mut DepthAnswer, pair: &Pair, found: &Overlap) {
    let Overlap { lower, upper, depth, direction, witness, .. } = found;
    (answer.outcome, answer.ending) = (Outcome::Intersecting, DepthEnding::Narrow);
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(*depth, *lower, *upper);
    fill_places(answer, pair, &witness.points, witness.features, &-direction);
}

fn fill_overlapping(answer: &mut DepthAnswer, pair: &Pair, found: &FoundPolytope) {
    let FoundPolytope { expansion: Expansion { lower, upper, direction, .. }, witness, .. } = found;
    answer.outcome = Outcome::Intersecting;
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(witness.depth, *lower, *upper);
    let combination = Combination { pairs: &witness.pairs[..witness.count], weights: &witness.weights };
    fill_points(answer, pair, combination, &-direction, upper - lower);
}

/// Decides in integers, with the result of the search.
#[cold]
#[inline(never)]
fn decide(answer: &mut DepthAnswer, pair: &Pair, found: Option<&FoundPolytope>) -> Result<()> {
    let hint = found.map_or(&[][..], |found| &found.witness.pairs[..found.witness.count]);
    let known = found.filter(|found| found.expansion.upper < f64::INFINITY);
    // The bounds have met, next to 0.
    let met = known.filter(|found| found.expansion.ending == Ending::Narrow && has_witness(found, pair));
    let (position, way_out, along_axes) = in_integers(|| {
        let position = exact::locate(pair, hint, SupportScope::Climbed);
        let overlaps = matches!(position, Position::Overlapping(_));
        let way_out = if overlaps { way_out(pair) } else { None };
        let is_unknown = overlaps && way_out.is_none() && known.is_none();
        (position, way_out, is_unknown.then(|| exact::overlap_along_axes(pair)))
    })?;
    answer.ending = DepthEnding::Integers;
    answer.statistics = statistics_of(found, 0);
    match position {
        Position::Separated(apart) => {
            answer.statistics.exact_iterations = apart.iterations;
            fill_separated(answer, DepthEnding::Integers, &apart.direction);
        }
        Position::Touching { normal, common } => {
            answer.outcome = Outcome::Intersecting;
            (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, 0.0);
            fill_common(answer, pair, &common, &normal, 0.0);
        }
        Position::Overlapping(common) => {
            answer.statistics.exact_iterations = common.iterations;
            if let Some(way_out) = way_out {
                fill_way_out(answer, pair, &way_out);
                return Ok(());
            }
            if let Some(found) = met {
                fill_overlapping(answer, pair, found);
                return Ok(());
            }
            // The polytope need not surround the origin, and gives no point.
            let of_polytope = known.map(|found| (found.expansion.upper, -found.expansion.direction));
            let (upper, normal) = of_polytope.or(along_axes).unwrap_or((f64::INFINITY, Vector::x()));
            answer.outcome = Outcome::Intersecting;
            (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, upper);
            // Moved by `upper` along the normal the point leaves each body: there are the faces.
            fill_common(answer, pair, &common, &normal, upper);
        }
    }
    Ok(())
}

/// Which of two bodies is a point and which one has an interior, if they are so.
fn point_and_body(polyhedra: [&Polyhedron; 2]) -> Option<[usize; 2]> {
    match polyhedra.map(|polyhedron| polyhedron.dimension) {
        [0, 3] => Some([0, 1]),
        [3, 0] => Some([1, 0]),
        _ => None,
    }
}

/// The shortest way out for a point inside a body: `None` of other pairs.
fn way_out(pair: &Pair) -> Option<WayOut> {
    let Pair { polyhedra, poses } = *pair;
    let [point, body] = point_and_body(polyhedra)?;
    let mut found = exact::way_out(polyhedra[body], poses[body], polyhedra[point], poses[point])?;
    // The normal, from body 2 to body 1, is rounded: along it the point is out later, by up to u times how far the body reaches.
    let out = contact::normalised(&if point == 0 { found.normal } else { -found.normal });
    if let Some(along) = Differences::new(pair).overlap_along(&out.into()) {
        found.depth[1] = found.depth[1].max(along.bounds().1);
    }
    Some(found)
}

/// Whether all that a search found of a point in a body is an interval that is wider than answers are: in a needle, which is
/// thinner than what vertices at its ends tell apart.
fn is_lost_in_needle(polyhedra: [&Polyhedron; 2], expansion: &Expansion) -> bool {
    let size = polyhedra[0].radius.max(polyhedra[1].radius);
    point_and_body(polyhedra).is_some() && expansion.upper - expansion.lower > WIDEST * size
}

/// A point inside a body, and the place of the surface that is nearest.
fn fill_way_out(answer: &mut DepthAnswer, pair: &Pair, way_out: &WayOut) {
    let Pair { polyhedra, poses } = *pair;
    let WayOut { face, depth: [lower, upper], normal } = *way_out;
    let Some([point, body]) = point_and_body(polyhedra) else { return };
    let middle = 0.5 * lower + 0.5 * upper;
    // No 0, which is on the surface.
    let depth = clamp(if middle > 0.0 { middle } else { upper }, lower, upper).min(f64::MAX);
    (answer.outcome, answer.lower, answer.depth, answer.upper) = (Outcome::Intersecting, lower, depth, upper);
    let (mut points, mut features) = ([polyhedra[point].vertices[0].position; 2], [FeatureId::Vertex(0); 2]);
    // Translations first, so that bodies far out lose no digits. R has an inverse: det R > 0.
    let between = (poses[point].translation() - poses[body].translation())
        + poses[point].rotate(&polyhedra[point].local_position(0));
    let back = poses[body].rotation().try_inverse().unwrap_or_else(Matrix::identity);
    points[body] = back * (between + normal * depth) - polyhedra[body].centre;
    features[body] = FeatureId::Face(face);
    // The normal is from body 2 to body 1: the point goes along the face's.
    let out = if point == 0 { normal } else { -normal };
    fill_places(answer, pair, &points, features, &out);
}

/// Whether the polytope's points are as far apart as they should be, up to what the depth may be: the weights of a triangle that is
/// thin beside bodies of very different sizes may be anything.
fn has_witness(found: &FoundPolytope, pair: &Pair) -> bool {
    let FoundPolytope { expansion: Expansion { upper, direction, .. }, witness, triangles } = found;
    let points = combinations(pair.polyhedra, &witness.pairs[..witness.count], &witness.weights);
    let [world1, world2] = contact::placed_points(pair, &points).world.map(Vector::from);
    let along = Vector::from(contact::normalised(direction)) * clamp(witness.depth, 0.0, *upper);
    // False for a NaN.
    *triangles > 0 && (world2 - world1 + along).norm() <= *upper
}

/// For objects that are apart only a normal is reported.
fn fill_separated(answer: &mut DepthAnswer, ending: DepthEnding, normal: &Vector) {
    let statistics = answer.statistics;
    *answer = DepthAnswer {
        outcome: Outcome::Separated,
        ending,
        depth: 0.0,
        lower: 0.0,
        upper: 0.0,
        normal: contact::normalised(normal),
        statistics,
        ..DepthAnswer::default()
    };
}

/// A common point, up to `within` inside both bodies along the normal.
fn fill_common(answer: &mut DepthAnswer, pair: &Pair, common: &ExactAnswer, normal: &Vector, within: f64) {
    answer.statistics.exact_iterations = common.iterations;
    let mut weights = [0.0; 4];
    for (weight, exact) in weights.iter_mut().zip(&common.weights) {
        *weight = *exact;
    }
    fill_points(answer, pair, Combination { pairs: &common.pairs, weights: &weights }, normal, within);
}

/// Points of both bodies.
struct Combination<'a> {
    pairs: &'a [VertexPair],
    weights: &'a [f64; 4],
}

/// Features are reported for the points, which are up to `within` inside the bodies along the normal.
fn fill_points(answer: &mut DepthAnswer, pair: &Pair, combination: Combination, normal: &Vector, within: f64) {
    let Combination { pairs, weights } = combination;
    let points = combinations(pair.polyhedra, pairs, weights);
    let features = contact::features_of_pairs(pair, pairs, &points, normal, within);
    fill_places(answer, pair, &points, features, normal);
}

fn fill_places(answer: &mut DepthAnswer, pair: &Pair, points: &[Vector; 2], features: [FeatureId; 2], normal: &Vector) {
    let contact::PlacedPoints { local, world } = contact::placed_points(pair, points);
    [answer.local1, answer.local2] = local;
    [answer.world1, answer.world2] = world;
    answer.normal = contact::normalised(normal);
    answer.feature1 = contact::label(pair.polyhedra[0], features[0], &points[0]);
    answer.feature2 = contact::label(pair.polyhedra[1], features[1], &points[1]);
}
