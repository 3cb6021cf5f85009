//! Intervals that exclude the truth by one double.

use swiftprox::manifold::Manifold;
use swiftprox::pair::{DepthAnswer, Outcome, PairAnswer};

use crate::swept::Length;

/// Intervals from [lower, best, upper] that begin above the truth or end below it, by one double; as much as can be is kept, or
/// nothing but that double.
fn ends([lower, best, upper]: [f64; 3], truth: &Length) -> [[f64; 3]; 4] {
    let [below, above] = truth.beside([lower, upper]);
    [[above, above.max(best), above.max(upper)], [below.min(lower), below.min(best), below], [above; 3], [below; 3]]
}

/// Of bodies that are apart.
pub fn pairs(answer: &PairAnswer, truth: &Length) -> Vec<PairAnswer> {
    let is_apart = answer.outcome == Outcome::Separated;
    let forged = is_apart.then(|| ends([answer.lower, answer.distance, answer.upper], truth));
    let with = |[lower, distance, upper]: [f64; 3]| PairAnswer { lower, distance, upper, ..*answer };
    forged.into_iter().flatten().map(with).collect()
}

/// Of bodies that have a common point.
pub fn depths(answer: &DepthAnswer, truth: &Length) -> Vec<DepthAnswer> {
    let is_deep = answer.outcome == Outcome::Intersecting;
    let forged = is_deep.then(|| ends([-answer.upper, -answer.depth, -answer.lower], truth));
    let with =
        |[lower, distance, upper]: [f64; 3]| DepthAnswer { lower: -upper, depth: -distance, upper: -lower, ..*answer };
    forged.into_iter().flatten().map(with).collect()
}

/// Of bodies that are not beyond `max_distance`.
pub fn manifolds(manifold: &Manifold, truth: &Length) -> Vec<Manifold> {
    let is_near = matches!(manifold.outcome, Outcome::Separated | Outcome::Intersecting);
    let forged = is_near.then(|| ends([manifold.lower, manifold.lower, manifold.upper], truth));
    forged.into_iter().flatten().map(|[lower, _, upper]| Manifold { lower, upper, ..*manifold }).collect()
}
