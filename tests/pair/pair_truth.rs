//! Pair queries against the oracle: the right verdict, the true distance inside the interval, the interval as narrow as
//! promised for hard cases, on every case of every family, with a cold cache and with one that another pair has filled.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::contact;
use swiftprox::pair::{DecidedBy, Outcome, PairAnswer, PairCache, PairConfig, Placed, distance, intersection};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use swiftprox::verify::verify;
use testkit::cases::{Case, FAMILIES, Random};
use testkit::oracle::Truth;

const CASES_PER_FAMILY: usize = 250;

#[test]
fn pair_queries_equal_the_oracle() {
    let mut violations = 0;
    for (index, (family, generate)) in FAMILIES.iter().enumerate() {
        let mut random = Random::new(0x1000 + index as u64);
        let (mut in_integers, mut dirty) = (0, PairCache::default());
        for number in 0..CASES_PER_FAMILY {
            let case = generate(&mut random);
            match check(&case, &case.truth(), &mut dirty) {
                Ok(decided_by) => in_integers += usize::from(decided_by == DecidedBy::Integers),
                Err(what) => {
                    violations += 1;
                    println!("{family}, case {number}: {what}\n{}", case.describe());
                }
            }
        }
        println!("{family}: {CASES_PER_FAMILY} cases, {in_integers} of them decided in integers");
    }
    assert_eq!(violations, 0);
}

/// A vertex over an edge whose direction from it, as marching sees it through the transpose, underflows when squared: R leans by
/// `lean` and has an entry next to nothing.
#[test]
fn directions_that_underflow_prove_nothing() {
    let wedge = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.5, -1.0, 0.5], [-0.5, -1.0, 0.5]].map(Vector::from);
    let tip = [[0.0, 0.0, 0.0], [0.1, 1.0, 0.0], [-0.1, 1.0, 0.3], [0.0, 1.0, -0.3]].map(Vector::from);
    for tiny in [1e-160, 1e-162, 1e-165, 1e-170, 1e-200, 1e-300] {
        for lean in [-1e-2, -1e-5, -1e-9, -1e-15] {
            let case = Case {
                points_a: tip.to_vec(),
                pose_a: Pose::new(&Matrix::identity(), &Vector::new(0.0, 0.0, 0.5)),
                points_b: wedge.to_vec(),
                pose_b: Pose::new(&Matrix::new(1.0, 0.0, 0.0, 0.0, 1.0, lean, 0.0, tiny, 1.0), &Vector::zeros()),
            };
            if let Err(what) = check(&case, &case.truth(), &mut PairCache::default()) {
                panic!("{what}\n{}", case.describe());
            }
        }
    }
}

fn shape(points: &[Vector]) -> Result<Shape, String> {
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    Shape::from_points(points, &options).map_err(|e| format!("no shape: {e}"))
}

/// Which tier decided from a cold cache, or what is wrong.
fn check(case: &Case, truth: &Truth, dirty: &mut PairCache) -> Result<DecidedBy, String> {
    let (a, b) = (shape(&case.points_a)?, shape(&case.points_b)?);
    let config = PairConfig::default();
    let mut decided_by = DecidedBy::None;
    for (name, query) in [("distance", distance as Query), ("contact", contact), ("intersection", intersection)] {
        let mut cold = PairCache::default();
        for cache in [&mut cold, &mut *dirty] {
            let mut answer = PairAnswer::default();
            query([a.at(&case.pose_a), b.at(&case.pose_b)], cache, &config, &mut answer).map_err(|e| e.to_string())?;
            let wrong = |what: &str| Err(format!("{name}: {what}: {answer:?}, the truth is {truth:?}"));
            let said = match answer.outcome {
                Outcome::Intersecting => true,
                Outcome::Separated => false,
                _ => return wrong("no verdict"),
            };
            if said != truth.intersecting() {
                return wrong("the verdict is wrong");
            }
            if name != "intersection" {
                if !truth.lies_between(answer.lower, answer.upper) {
                    return wrong("the interval is wrong");
                }
                if answer.upper - answer.lower > widest(case, answer.upper) {
                    return wrong("the interval is too wide");
                }
            } else if !said && !is_lower_bound(answer.lower, truth) {
                return wrong("the lower bound is wrong");
            }
            if name == "contact" && !answer.normal.iter().chain(&answer.local1).all(|x| x.is_finite()) {
                return wrong("a contact without point or normal");
            }
            if let Err(e) = verify([a.at(&case.pose_a), b.at(&case.pose_b)], &answer) {
                return wrong(&format!("it does not verify, {e}"));
            }
            if decided_by == DecidedBy::None {
                decided_by = answer.decided_by;
            }
        }
    }
    Ok(decided_by)
}

type Query = fn([Placed; 2], &mut PairCache, &PairConfig, &mut PairAnswer) -> swiftprox::error::Result<()>;

/// Positive, unless no positive double is small enough.
fn is_lower_bound(lower: f64, truth: &Truth) -> bool {
    truth.lies_between(lower, f64::INFINITY) && (lower > 0.0 || !truth.lies_between(5e-324, f64::INFINITY))
}

/// 1e-13·(L + 2e-3·W): L the larger bounding-box diagonal, or the distance of smaller bodies; W the largest world coordinate.
fn widest(case: &Case, distance: f64) -> f64 {
    let diagonal = |points: &[Vector]| {
        let (lower, upper) =
            points.iter().fold((points[0], points[0]), |(lower, upper), p| (lower.inf(p), upper.sup(p)));
        (upper - lower).norm()
    };
    let largest = |points: &[Vector], pose: &Pose| points.iter().map(|p| pose.transform(p).amax()).fold(0.0, f64::max);
    let size = diagonal(&case.points_a).max(diagonal(&case.points_b)).max(distance);
    let reach = largest(&case.points_a, &case.pose_a).max(largest(&case.points_b, &case.pose_b));
    1e-13 * (size + 2e-3 * reach)
}
