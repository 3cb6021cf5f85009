//! The exact tier against the oracle, which is another algorithm: the same verdict, and an interval around the true distance
//! that no doubles could narrow, on every case of every family, from any start.

use dashu_ratio::RBig;
use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::placed::Pair;
use swiftprox::placed::exact::{ExactAnswer, VertexPair, encloses_origin, solve};
use testkit::cases::{Case, FAMILIES, Random, coordinates, row_major};
use testkit::certificate::{dot, proved_by};
use testkit::oracle::{Truth, rational, transform};

const CASES_PER_FAMILY: usize = 250;

#[test]
fn exact_tier_equals_the_oracle() {
    let mut violations = 0;
    for (index, (family, generate)) in FAMILIES.iter().enumerate() {
        let mut random = Random::new(index as u64);
        let mut intersecting = 0;
        for number in 0..CASES_PER_FAMILY {
            let case = generate(&mut random);
            let truth = case.truth();
            intersecting += usize::from(truth.intersecting());
            if let Err(what) = check(&case, &truth, &mut random) {
                violations += 1;
                println!("{family}, case {number}: {what}\n{}", case.describe());
            }
        }
        println!("{family}: {CASES_PER_FAMILY} cases, {intersecting} of them intersecting");
        // A family in which every answer is the same tests little.
        assert!(intersecting > 0);
    }
    assert_eq!(violations, 0);
}

fn check(case: &Case, truth: &Truth, random: &mut Random) -> Result<(), String> {
    let hull = |points| build(points, None).map_err(|e| format!("no polyhedron: {e}"));
    let (a, b) = (&hull(&case.points_a)?, &hull(&case.points_b)?);
    let from = |start: &[VertexPair]| solve(&Pair { polyhedra: [a, b], poses: [&case.pose_a, &case.pose_b] }, start);

    let cold = from(&[]);
    check_interval(truth, &cold)?;
    check_proof(case, truth, a, b, &cold)?;
    if encloses_origin(&Pair { polyhedra: [a, b], poses: [&case.pose_a, &case.pose_b] }, &cold.pairs)
        != truth.intersecting()
    {
        return Err("encloses_origin contradicts the truth".into());
    }

    let warm = from(&cold.pairs);
    if (warm.lower, warm.upper) != (cold.lower, cold.upper) || warm.iterations > 2 {
        return Err(format!("started at its own answer {cold:?} it says {warm:?}"));
    }
    // Repeated and out-of-range pairs, too.
    let mut index = |body: &Polyhedron| random.below(body.vertices.len() + 1) as u32;
    let hints = [(); 5].map(|()| [index(a), index(b)]);
    let misled = from(&hints);
    if (misled.intersecting, misled.lower, misled.upper) != (cold.intersecting, cold.lower, cold.upper) {
        return Err(format!("started at {hints:?} it says {misled:?} instead of {cold:?}"));
    }
    Ok(())
}

fn check_interval(truth: &Truth, answer: &ExactAnswer) -> Result<(), String> {
    if answer.intersecting != truth.intersecting() {
        return Err(format!("the verdict of {answer:?} is wrong: {truth:?}"));
    }
    if !truth.lies_between(answer.lower, answer.upper) || answer.upper > answer.lower.next_up() {
        return Err(format!("the interval of {answer:?} is wrong or wide: {truth:?}"));
    }
    Ok(())
}

/// The pairs prove the answer, and weights and direction are those of the nearest point up to rounding.
fn check_proof(case: &Case, truth: &Truth, a: &Polyhedron, b: &Polyhedron, answer: &ExactAnswer) -> Result<(), String> {
    let (points_a, points_b) = (coordinates(&case.points_a), coordinates(&case.points_b));
    let (pose_a, pose_b) = (row_major(&case.pose_a), row_major(&case.pose_b));
    let label = |&[v, w]: &VertexPair| [a.vertex_labels[v as usize], b.vertex_labels[w as usize]];
    let pairs = answer.pairs.iter().map(label).collect::<Vec<_>>();
    let Some(nearest) = proved_by(&points_a, &pose_a, &points_b, &pose_b, &pairs) else {
        return Err(format!("the pairs of {answer:?} prove nothing"));
    };
    let square = dot(&nearest, &nearest);
    if square != truth.squared_distance {
        return Err(format!("the pairs of {answer:?} prove another distance than {truth:?}"));
    }

    let corner = |pair: &[u32; 2]| {
        let v = transform(&pose_a, &points_a[pair[0] as usize].map(rational));
        let w = transform(&pose_b, &points_b[pair[1] as usize].map(rational));
        [0, 1, 2].map(|k| &v[k] - &w[k])
    };
    let corners = pairs.iter().map(corner).collect::<Vec<_>>();
    let miss = corners
        .iter()
        .zip(&answer.weights)
        .fold(nearest.clone(), |rest, (corner, &weight)| [0, 1, 2].map(|k| &rest[k] - rational(weight) * &corner[k]));
    let size = corners.iter().map(|c| dot(c, c)).max().unwrap_or_default();
    if dot(&miss, &miss) > rational(2f64.powi(-100)) * size {
        return Err(format!("the weights of {answer:?} miss the nearest point"));
    }

    let direction: [f64; 3] = answer.direction.into();
    let direction = direction.map(rational);
    let cosine = dot(&direction, &nearest);
    let length = dot(&direction, &direction);
    // sin² = 1 − cos²; and |direction| = 1, or 0 for no direction.
    let across = &length * &square - &cosine * &cosine;
    let is_unit = (length - if answer.intersecting { RBig::ZERO } else { RBig::ONE }).to_f64_fast().abs() < 1e-15;
    if !is_unit || cosine < RBig::ZERO || across > rational(2f64.powi(-100)) * square {
        return Err(format!("the direction of {answer:?} is not that of the nearest point"));
    }
    Ok(())
}
