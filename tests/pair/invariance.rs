//! Answers do not depend on how the same pair is told: numbering, order of the objects, the frame they are seen from, the
//! thread that asks.

use std::sync::Barrier;

use swiftprox::math::{Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::contact;
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, distance, intersection};
use swiftprox::shape::{Shape, ShapeOptions};
use testkit::cases::{Case, FAMILIES, Random};
use testkit::retold::{extent, mirror, mirrored, product, reframed, renumbered, shifted_exactly, shuffled};
use testkit::shapes::hull;

use testkit::models::{cuboid, ellipsoid, prism, random_hull};

const CASES_PER_FAMILY: usize = 1_000;

/// The answer to [`distance`] from a cold cache.
fn ask(shape1: &Shape, pose1: &Pose, shape2: &Shape, pose2: &Pose) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let (mut cache, config) = (PairCache::default(), PairConfig::default());
    distance([shape1.at(pose1), shape2.at(pose2)], &mut cache, &config, &mut answer).expect("accepted poses");
    answer
}

fn answer_to(case: &Case) -> PairAnswer {
    ask(&hull(&case.points_a), &case.pose_a, &hull(&case.points_b), &case.pose_b)
}

/// The same verdict, intervals with a common point. If not, the oracle tells whether the first is wrong.
fn assert_same_truth(what: &str, case: &Case, one: &PairAnswer, other: &PairAnswer) {
    if one.outcome != other.outcome || one.lower > other.upper || other.lower > one.upper {
        let truth = case.truth();
        let verdict = truth.intersecting() == (one.outcome == Outcome::Intersecting);
        let interval = truth.lies_between(one.lower, one.upper);
        panic!("{what}: {one:?} (right: {verdict}, {interval})\nbut {other:?}\n{}", case.describe());
    }
}

/// Every case of every family with its answer and what tells it another way.
fn for_every_case(seed: u64, mut check: impl FnMut(&Case, &PairAnswer, &mut Random)) {
    for (index, (family, generate)) in FAMILIES.iter().enumerate() {
        let mut random = Random::new(seed + index as u64);
        let mut intersecting = 0;
        for _ in 0..CASES_PER_FAMILY {
            let case = generate(&mut random);
            let answer = answer_to(&case);
            intersecting += usize::from(answer.outcome == Outcome::Intersecting);
            check(&case, &answer, &mut random);
        }
        println!("{family}: {CASES_PER_FAMILY} cases, {intersecting} of them intersecting");
    }
}

#[test]
fn numbering_and_order_change_nothing() {
    for_every_case(0x2000, |case, answer, random| {
        let renumbered =
            Case { points_a: shuffled(&case.points_a, random), points_b: shuffled(&case.points_b, random), ..*case };
        assert_same_truth("renumbered vertices", case, answer, &answer_to(&renumbered));
        let swapped = ask(&hull(&case.points_b), &case.pose_b, &hull(&case.points_a), &case.pose_a);
        assert_same_truth("swapped objects", case, answer, &swapped);
    });
}

#[test]
fn motions_without_rounding_change_nothing() {
    let mut translated = 0;
    for_every_case(0x3000, |case, answer, random| {
        let turn = random.quarter_turns();
        let turned = |pose: &Pose| product(&turn, pose);
        let world = Case {
            points_a: case.points_a.clone(),
            pose_a: turned(&case.pose_a),
            points_b: case.points_b.clone(),
            pose_b: turned(&case.pose_b),
        };
        assert_same_truth("the world turned by quarters", case, answer, &answer_to(&world));

        // Axes renamed and mirrored in one body's frame and in its matrix: the same points of the world.
        let local = Case {
            points_a: case.points_a.iter().map(|p| turn * p).collect(),
            pose_a: reframed(&turn, &case.pose_a),
            points_b: case.points_b.clone(),
            ..*case
        };
        assert_same_truth("one frame turned by quarters", case, answer, &answer_to(&local));

        // A mirrored world needs mirrored bodies for its matrices to be rotations.
        let points = |points: &[Vector]| points.iter().map(|p| mirror() * p).collect();
        let world = Case {
            points_a: points(&case.points_a),
            pose_a: mirrored(&case.pose_a),
            points_b: points(&case.points_b),
            pose_b: mirrored(&case.pose_b),
        };
        assert_same_truth("everything mirrored", case, answer, &answer_to(&world));

        let step = random.lattice(1 << 20);
        let moved = [case.pose_a, case.pose_b].map(|pose| shifted_exactly(&pose, &step));
        if let [Some(pose_a), Some(pose_b)] = moved {
            translated += 1;
            let (points_a, points_b) = (case.points_a.clone(), case.points_b.clone());
            let moved = Case { points_a, pose_a, points_b, pose_b };
            assert_same_truth("a translation", case, answer, &answer_to(&moved));
        }
    });
    println!("{translated} translations rounded nothing");
    assert!(translated > CASES_PER_FAMILY);
}

/// A rotation in doubles is not exact, and what it moves is rounded: the distance may change by 1e-12·L + 2e-15·W.
#[test]
fn other_rigid_motions_change_what_they_round() {
    for_every_case(0x4000, |case, answer, random| {
        let turn = random.rotation();
        let (size, reach) = extent_of(case);
        if !(1e-100..1e100).contains(&size) {
            return;
        }
        let step = size * random.power(-3, 10) * random.vector();
        let moved = |pose: &Pose| Pose::new(&(turn * pose.rotation()), &(turn * pose.translation() + step));
        let case = Case {
            points_a: case.points_a.clone(),
            pose_a: moved(&case.pose_a),
            points_b: case.points_b.clone(),
            pose_b: moved(&case.pose_b),
        };
        let band = 1e-12 * size + 2e-15 * reach.max(extent_of(&case).1);
        let other = answer_to(&case);
        assert!(
            answer.lower - other.upper <= band && other.lower - answer.upper <= band,
            "changed by more than {band:e}: {answer:?}\nto {other:?}\n{}",
            case.describe()
        );
    });
}

fn extent_of(case: &Case) -> (f64, f64) {
    extent([&case.points_a, &case.points_b], [&case.pose_a, &case.pose_b])
}

#[test]
fn numbering_of_faces_changes_nothing() {
    let mut random = Random::new(0x5000);
    for _ in 0..2_000 {
        let meshes = [any_mesh(&mut random), any_mesh(&mut random)];
        let renumbered = meshes.each_ref().map(|mesh| renumbered(mesh, &mut random));
        let shapes = meshes.map(|mesh| Shape::from_mesh(&mesh, &ShapeOptions::default()).expect("a convex mesh"));
        let others = renumbered.map(|mesh| Shape::from_mesh(&mesh, &ShapeOptions::default()).expect("a convex mesh"));
        for _ in 0..10 {
            let pose1 = Pose::new(&random.rotation(), &Vector::zeros());
            let pose2 = Pose::new(&random.quarter_turns(), &(2.0 * random.vector()));
            let one = ask(&shapes[0], &pose1, &shapes[1], &pose2);
            let other = ask(&others[0], &pose1, &others[1], &pose2);
            let overlap = one.lower <= other.upper && other.lower <= one.upper;
            assert!(one.outcome == other.outcome && overlap, "{one:?}\nbut {other:?}");
        }
    }
}

fn any_mesh(random: &mut Random) -> PolygonMesh {
    let mesh = match random.below(3) {
        0 => cuboid([1.0, 0.75, 0.5]),
        1 => prism(3 + random.below(9) as u32, 0.5),
        _ => random_hull(4 + random.below(20), random.next_u64()),
    };
    mesh.expect("a convex mesh")
}

/// Many threads at once over the same shapes, each with caches of its own, give the very bits of one thread alone.
#[test]
fn threads_do_not_matter() {
    const THREADS: usize = 8;
    let shapes: Vec<Shape> = [(); 6]
        .iter()
        .zip(1..)
        .map(|((), seed)| any_mesh(&mut Random::new(seed)))
        .chain([[1.0, 0.1, 0.1], [1.0, 1.0, 0.1]].map(|half_axes| ellipsoid(half_axes, 102).expect("an ellipsoid")))
        .map(|mesh| Shape::from_mesh(&mesh, &ShapeOptions::default()).expect("a convex mesh"))
        .collect();
    let all_answers = || {
        let mut random = Random::new(0x6000);
        let mut answers = Vec::new();
        for (i, shape1) in shapes.iter().enumerate() {
            for shape2 in &shapes[i..] {
                let mut cache = PairCache::default();
                for _ in 0..40 {
                    let pose1 = Pose::new(&random.rotation(), &Vector::zeros());
                    let pose2 = Pose::new(&random.quarter_turns(), &(2.0 * random.vector()));
                    for query in [distance, contact, intersection] {
                        let mut answer = PairAnswer::default();
                        let config = PairConfig::default();
                        query([shape1.at(&pose1), shape2.at(&pose2)], &mut cache, &config, &mut answer)
                            .expect("rotations");
                        answers.push(bits(&answer));
                    }
                }
            }
        }
        answers
    };
    let alone = all_answers();
    let start = Barrier::new(THREADS);
    std::thread::scope(|scope| {
        let together = [(); THREADS].map(|()| {
            scope.spawn(|| {
                start.wait();
                all_answers()
            })
        });
        for thread in together {
            assert!(thread.join().expect("no panic") == alone, "threads disturb each other");
        }
    });
}

/// Everything an answer says; NaN as its bits, so that it equals itself.
fn bits(answer: &PairAnswer) -> (String, Vec<u64>) {
    let PairAnswer { local1, local2, world1, world2, normal, lower, upper, distance, .. } = answer;
    let vectors = [local1, local2, world1, world2, normal].into_iter().flatten();
    let numbers = vectors.chain([lower, upper, distance]).map(|x| x.to_bits()).collect();
    (format!("{answer:?}"), numbers)
}
