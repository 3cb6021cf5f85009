//! Answers from what a search found, and where that leaves the verdict open from integers.

use super::answer::{DepthAnswer, DepthEnding, DepthStatistics};
use super::search::{FoundPolytope, Search};
use crate::base::math::{Pose, Vector, clamp};
use crate::pair::answer::Outcome;
use crate::pair::contact;
use crate::polyhedron::Polyhedron;
use crate::solve::decide::combinations;
use crate::solve::exact::{self, ExactAnswer, Position, Supports, VertexPair};
use crate::solve::facets::Overlap;
use crate::solve::polytope::{Ending, Expansion};
use crate::solve::state::FeatureId;

/// Answers by what the search found, `overlap` where all facets did, and where that leaves the verdict open by integers.
pub fn fill(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    found: Option<&Search>,
    overlap: &Overlap,
) {
    if !matches!(found, Some(Search::Answered)) {
        answer.statistics = DepthStatistics::default();
    }
    let found = match found {
        None => return decide(answer, polyhedra, poses, None),
        Some(Search::Apart(direction)) => return fill_separated(answer, DepthEnding::Separated, &-direction),
        Some(Search::Facets) => return fill_facet(answer, polyhedra, poses, overlap),
        Some(Search::Polytope(found)) => found,
        Some(Search::Answered) => return,
    };
    let FoundPolytope { expansion: Expansion { ending, lower, direction, steps, supports, .. }, triangles, .. } =
        *found;
    answer.statistics = DepthStatistics { steps, supports, triangles, exact_iterations: 0 };
    if ending == Ending::Separated {
        return fill_separated(answer, DepthEnding::Separated, &-direction);
    }
    if !(lower > 0.0) {
        return decide(answer, polyhedra, poses, Some(found));
    }
    answer.ending = match ending {
        Ending::Spent => DepthEnding::Budget,
        Ending::Stuck | Ending::Flat | Ending::Outdated => DepthEnding::Stalled,
        Ending::Narrow | Ending::Separated => DepthEnding::Narrow,
    };
    fill_overlapping(answer, polyhedra, poses, found);
}

fn fill_facet(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: &Overlap) {
    let Overlap { lower, upper, depth, direction, witness, .. } = found;
    (answer.outcome, answer.ending) = (Outcome::Intersecting, DepthEnding::Narrow);
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(*depth, *lower, *upper);
    fill_places(answer, polyhedra, poses, &witness.points, witness.features, &-direction);
}

fn fill_overlapping(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: &FoundPolytope) {
    let FoundPolytope { expansion: Expansion { lower, upper, direction, .. }, witness, .. } = found;
    answer.outcome = Outcome::Intersecting;
    (answer.lower, answer.upper) = (*lower, *upper);
    answer.depth = clamp(witness.depth, *lower, *upper);
    let combination = Combination { pairs: &witness.pairs[..witness.count], weights: &witness.weights };
    fill_points(answer, polyhedra, poses, combination, &-direction, upper - lower);
}

/// Decides in integers, with what the search has found.
#[cold]
#[inline(never)]
fn decide(answer: &mut DepthAnswer, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2], found: Option<&FoundPolytope>) {
    let hint = found.map_or(&[][..], |found| &found.witness.pairs[..found.witness.count]);
    let position = exact::locate(polyhedra, poses, hint, Supports::Climbed);
    answer.ending = DepthEnding::Integers;
    match position {
        Position::Separated(apart) => {
            answer.statistics.exact_iterations = apart.iterations;
            fill_separated(answer, DepthEnding::Integers, &apart.direction);
        }
        Position::Touching { normal, common } => {
            answer.outcome = Outcome::Intersecting;
            (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, 0.0);
            fill_common(answer, polyhedra, poses, &common, &normal);
        }
        Position::Overlapping(common) => {
            let known = found.filter(|found| found.expansion.upper < f64::INFINITY);
            match known {
                // The bounds have met, next to 0.
                Some(found) if found.expansion.ending == Ending::Narrow && has_witness(found, polyhedra, poses) => {
                    fill_overlapping(answer, polyhedra, poses, found);
                    answer.statistics.exact_iterations = common.iterations;
                }
                _ => {
                    // The polytope need not surround the origin, and says no point.
                    let (upper, normal) = match known {
                        Some(found) => (found.expansion.upper, -found.expansion.direction),
                        None => exact::overlap_along_axes(polyhedra, poses),
                    };
                    answer.outcome = Outcome::Intersecting;
                    (answer.lower, answer.depth, answer.upper) = (0.0, 0.0, upper);
                    fill_common(answer, polyhedra, poses, &common, &normal);
                }
            }
        }
    }
}

/// Whether the polytope's points are as far apart as they should be, up to what the depth may be: the weights of a triangle that is
/// thin beside bodies of very different sizes may be anything.
fn has_witness(found: &FoundPolytope, polyhedra: [&Polyhedron; 2], poses: [&Pose; 2]) -> bool {
    let FoundPolytope { expansion: Expansion { upper, direction, .. }, witness, triangles } = found;
    let points = combinations(polyhedra, &witness.pairs[..witness.count], &witness.weights);
    let [world1, world2] = contact::placed_points(polyhedra, poses, &points).world.map(Vector::from);
    let along = Vector::from(contact::normalised(direction)) * clamp(witness.depth, 0.0, *upper);
    // False for a NaN.
    *triangles > 0 && (world2 - world1 + along).norm() <= *upper
}

/// Of objects that are apart only a normal is said.
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

/// A common point.
fn fill_common(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    common: &ExactAnswer,
    normal: &Vector,
) {
    answer.statistics.exact_iterations = common.iterations;
    let mut weights = [0.0; 4];
    for (weight, exact) in weights.iter_mut().zip(&common.weights) {
        *weight = *exact;
    }
    fill_points(answer, polyhedra, poses, Combination { pairs: &common.pairs, weights: &weights }, normal, 0.0);
}

/// Points of both bodies.
struct Combination<'a> {
    pairs: &'a [VertexPair],
    weights: &'a [f64; 4],
}

/// Of the points the features are said; seen along the normal they are as far as `within` inside the bodies.
fn fill_points(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    combination: Combination,
    normal: &Vector,
    within: f64,
) {
    let Combination { pairs, weights } = combination;
    let points = combinations(polyhedra, pairs, weights);
    let features = contact::features_of_pairs(polyhedra, poses, pairs, &points, normal, within);
    fill_places(answer, polyhedra, poses, &points, features, normal);
}

fn fill_places(
    answer: &mut DepthAnswer,
    polyhedra: [&Polyhedron; 2],
    poses: [&Pose; 2],
    points: &[Vector; 2],
    features: [FeatureId; 2],
    normal: &Vector,
) {
    let contact::PlacedPoints { local, world } = contact::placed_points(polyhedra, poses, points);
    [answer.local1, answer.local2] = local;
    [answer.world1, answer.world2] = world;
    answer.normal = contact::normalised(normal);
    answer.feature1 = contact::label(polyhedra[0], features[0], &points[0]);
    answer.feature2 = contact::label(polyhedra[1], features[1], &points[1]);
}
