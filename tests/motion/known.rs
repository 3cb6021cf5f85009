//! Motions whose answer is known.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI};

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{Callback, CastAnswer, CastConfig, CastOutcome, Motion, verify_cast};
use swiftprox::pair::{FeatureKind, Outcome};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::random::rotation;
use testkit::shapes::{cuboid, hull};

use crate::{at, moving, run, screw, straight};

#[test]
fn a_cube_falls_on_a_cube() {
    let cube = cuboid([0.5; 3]);
    let (still, falling) = (Motion::Fixed(Pose::IDENTITY), straight(at(0.25, 0.125, 3.0), [0.0, 0.0, -4.0]));
    let answer = run(moving([&cube, &cube], [&falling, &still]), &CastConfig::default());
    assert_eq!(answer.outcome, CastOutcome::Hit);
    assert!(
        answer.time_lower < 0.5 && 0.5 <= answer.time_upper && answer.time_upper - answer.time_lower <= 1e-9,
        "{answer:?}"
    );
    // Told where they are still apart; shown to meet by vertex pairs where they do.
    assert_eq!((answer.upper, answer.contact.outcome), (0.0, Outcome::Separated));
    assert!(answer.contact.distance <= 4.0e-9 && answer.proof_count > 0, "{answer:?}");
    assert!((answer.contact.normal[2] - 1.0).abs() < 1e-12, "{answer:?}");
    assert!((answer.contact.world1[2] - 0.5).abs() < 1e-8, "{answer:?}");
    assert!(answer.queries <= 6, "{answer:?}");
}

#[test]
fn a_start_in_contact_is_a_hit_at_the_beginning() {
    let cube = cuboid([0.5; 3]);
    let still = Motion::Fixed(Pose::IDENTITY);
    // Touching, and leaving; and deep.
    for height in [1.0, 0.5] {
        let rising = straight(at(0.0, 0.25, height), [0.0, 0.0, 1.0]);
        let answer = run(moving([&cube, &cube], [&rising, &still]), &CastConfig::default());
        assert_eq!((answer.outcome, answer.time_lower, answer.time_upper), (CastOutcome::Hit, 0.0, 0.0), "{answer:?}");
        assert_eq!(
            (answer.contact.outcome, answer.contact.normal),
            (Outcome::Intersecting, [0.0, 0.0, 1.0]),
            "{answer:?}"
        );
    }
}

/// Cubes that touch: from which one rises, into which one falls, along which one slides; and cubes deep in each other.
#[test]
fn a_touch_from_which_bodies_part_is_ignored_if_asked() {
    let cube = cuboid([0.5; 3]);
    let still = Motion::Fixed(Pose::IDENTITY);
    let config = CastConfig { ignores_parting: true, ..CastConfig::default() };
    let rising = straight(at(0.0, 0.25, 1.0), [0.0, 0.0, 1.0]);
    let bodies = moving([&cube, &cube], [&rising, &still]);
    let answer = run(bodies, &config);
    assert_eq!((answer.outcome, answer.time_lower), (CastOutcome::Free, 1.0), "{answer:?}");
    assert!(answer.time_parted > 0.0 && answer.time_parted <= 1.024e-6, "{answer:?}");
    assert!(answer.clearance > 0.0 && answer.clearance <= answer.time_parted, "{answer:?}");
    verify_cast(bodies, &config, &answer).unwrap();
    for forged in [0.0, 1e-3, -1.0] {
        assert!(verify_cast(bodies, &config, &CastAnswer { time_parted: forged, ..answer }).is_err(), "{forged}");
    }
    assert!(verify_cast(bodies, &CastConfig::default(), &answer).is_err());

    // It rises, and is back at 1/2.
    let arc = |t: f64| at(0.0, 0.25, 1.0 + 4.0 * t * (0.5 - t));
    let back = Motion::Callback(Callback { pose: &arc, bend: 8.0, rounding: 1e-14 });
    let bodies = moving([&cube, &cube], [&back, &still]);
    let answer = run(bodies, &config);
    verify_cast(bodies, &config, &answer).unwrap();
    assert!(answer.outcome == CastOutcome::Hit && answer.time_parted > 0.0, "{answer:?}");
    assert!(
        answer.time_lower < 0.5 + 1e-13
            && answer.time_upper > 0.5 - 1e-13
            && answer.time_upper - answer.time_lower <= 1e-9,
        "{answer:?}"
    );

    for (height, velocity) in [(1.0, [0.0, 0.0, -1.0]), (1.0, [1.0, 0.0, 0.0]), (0.5, [0.0, 0.0, 1.0])] {
        let motion = straight(at(0.0, 0.25, height), velocity);
        let answer = run(moving([&cube, &cube], [&motion, &still]), &config);
        assert_eq!((answer.outcome, answer.time_upper), (CastOutcome::Hit, 0.0), "{answer:?}");
        assert!(answer.time_parted.is_nan());
    }
    // What is apart at the beginning is cast from there.
    let apart = straight(at(0.0, 0.25, 1.5), [0.0, 0.0, 1.0]);
    let answer = run(moving([&cube, &cube], [&apart, &still]), &config);
    assert!(answer.outcome == CastOutcome::Free && answer.time_parted.is_nan(), "{answer:?}");
}

/// A cube flies, a corner ahead, at the face of another that is turned about y by an angle of which sine and cosine are known.
#[test]
fn the_normal_of_a_hit_is_that_of_the_face() {
    let cube = cuboid([0.5; 3]);
    let (sine, cosine) = (0.28, 0.96);
    let turned = Pose { rows: [[cosine, 0.0, sine, 0.0], [0.0, 1.0, 0.0, 0.0], [-sine, 0.0, cosine, 0.0]] };
    let still = Motion::Fixed(turned);
    let mut start = at(0.3, 0.1, 4.0);
    let tilt = rotation(&Vector::new(1.0, 1.0, 0.0).normalize(), 0.7);
    start = Pose::new(&tilt, &start.translation());
    for spin in [[0.0; 3], [0.1, -0.2, 0.3]] {
        let flying = screw(start, [0.0, 0.0, -4.0], spin);
        let bodies = moving([&cube, &cube], [&flying, &still]);
        let answer = run(bodies, &CastConfig::default());
        verify_cast(bodies, &CastConfig::default(), &answer).unwrap();
        let contact = &answer.contact;
        assert_eq!((answer.outcome, contact.outcome), (CastOutcome::Hit, Outcome::Separated), "{answer:?}");
        assert_eq!(
            (contact.feature1.kind, contact.feature2.kind),
            (FeatureKind::Vertex, FeatureKind::Face),
            "{answer:?}"
        );
        let off = Vector::from(contact.normal) - Vector::new(sine, 0.0, cosine);
        assert!(off.norm() < 1e-14, "{answer:?}");
        // Apart by what the flight takes in a nanosecond, no more.
        assert!(contact.distance > 0.0 && contact.distance < 6e-9, "{answer:?}");
    }
}

#[test]
fn a_bullet_does_not_pass_between_samples() {
    let (bullet, plate) = (cuboid([0.01; 3]), cuboid([1.0, 1.0, 5e-4]));
    let (flight, still) = (straight(at(0.1, 0.2, -50.0), [0.0, 0.0, 100.0]), Motion::Fixed(Pose::IDENTITY));
    let answer = run(moving([&bullet, &plate], [&flight, &still]), &CastConfig::default());
    let first = (50.0 - 0.01 - 5e-4) / 100.0;
    assert_eq!(answer.outcome, CastOutcome::Hit);
    assert!(
        answer.time_lower <= first + 1e-15
            && first - 1e-15 <= answer.time_upper
            && answer.time_upper - answer.time_lower <= 1e-9
    );
    assert!(answer.contact.normal[2] < -0.999_999, "{answer:?}");
}

#[test]
fn a_bar_that_turns_hits_a_post_by_its_corner() {
    // A square of half diagonal 1 turns into a wall at x = 0.9: a corner passes when cos(π/4 − t·π/4) = 0.9.
    let half = FRAC_1_SQRT_2;
    let (square, wall) = (cuboid([half, half, 0.5]), cuboid([0.5, 5.0, 5.0]));
    let (turning, still) = (screw(Pose::IDENTITY, [0.0; 3], [0.0, 0.0, FRAC_PI_4]), Motion::Fixed(at(1.4, 0.0, 0.0)));
    let answer = run(moving([&square, &wall], [&turning, &still]), &CastConfig::default());
    let first = 1.0 - 0.9_f64.acos() / FRAC_PI_4;
    assert_eq!(answer.outcome, CastOutcome::Hit);
    assert!(
        answer.time_lower < first + 1e-14
            && first - 1e-14 < answer.time_upper
            && answer.time_upper - answer.time_lower <= 1e-9,
        "{answer:?}"
    );

    // Beyond the corner's reach it is free; the clearance is at most that of the corner and not much less.
    let away = Motion::Fixed(at(1.6, 0.0, 0.0));
    let answer = run(moving([&square, &wall], [&turning, &away]), &CastConfig::default());
    assert_eq!((answer.outcome, answer.time_lower), (CastOutcome::Free, 1.0));
    assert!(answer.clearance > 0.0 && answer.clearance <= 0.1 + 1e-12, "{answer:?}");
    assert!(answer.time_upper.is_nan() && answer.upper.is_nan());
}

#[test]
fn bodies_that_move_together_raise_no_alarm() {
    let cube = cuboid([0.5; 3]);
    let together = [0.3, -0.2, 9.0];
    let motions = [straight(at(1.0 + 1e-12, 0.0, 0.0), together), straight(Pose::IDENTITY, together)];
    let answer = run(moving([&cube, &cuboid([0.5; 3])], [&motions[0], &motions[1]]), &CastConfig::default());
    assert_eq!(answer.outcome, CastOutcome::Free);
    assert_eq!(answer.queries, 1);
}

/// Two points at rest, one of whose poses is off orthonormal. Cause: points have no size, so no frame, and no gap could be proved.
/// Cut-off: bounding spheres, which here are the bodies themselves. Such motions were NEAR, however far apart.
#[test]
fn two_points_at_rest_are_as_far_apart_as_is_proved() {
    let point = hull(&[Vector::zeros()]);
    let [mut first, mut second] = [at(0.0, 0.0, -32.0), at(-32.0, -32.0, -32.0)];
    let off = 4.547_473_508_864e-13;
    (first.rows[0][1], first.rows[1][2], first.rows[2][0]) = (off, off, off);
    (first.rows[1][0], first.rows[2][1], first.rows[0][2]) = (-off, -off, -off);
    second.rows[0][0] = 1.003_906_25;
    let motions = [Motion::Fixed(first), Motion::Fixed(second)];
    let bodies = moving([&point, &point], [&motions[0], &motions[1]]);
    let answer = run(bodies, &CastConfig::default());
    verify_cast(bodies, &CastConfig::default(), &answer).unwrap();
    let apart = 32.0 * 2.0_f64.sqrt();
    assert_eq!(answer.outcome, CastOutcome::Free, "{answer:?}");
    assert!(answer.clearance <= apart && answer.clearance > 0.25 * apart, "{answer:?}");
}

/// Balls are points with a swept radius.
#[test]
fn a_ball_hits_a_ball() {
    let options = ShapeOptions { input: InputPolicy::Hull, swept_radius: 1.0, ..ShapeOptions::default() };
    let ball = Shape::from_points(&[Vector::zeros()], &options).unwrap();
    let (still, flying) = (Motion::Fixed(Pose::IDENTITY), straight(at(-3.0, 0.0, 0.0), [4.0, 0.0, 0.0]));
    let answer = run(moving([&ball, &ball], [&flying, &still]), &CastConfig::default());
    assert_eq!(answer.outcome, CastOutcome::Hit, "{answer:?}");
    assert!(
        answer.time_lower <= 0.25 && 0.25 <= answer.time_upper && answer.time_upper - answer.time_lower <= 1e-9,
        "{answer:?}"
    );
    let past = straight(at(-3.0, 2.5, 0.0), [4.0, 0.0, 0.0]);
    let answer = run(moving([&ball, &ball], [&past, &still]), &CastConfig::default());
    assert!(answer.outcome == CastOutcome::Free && answer.clearance <= 0.5, "{answer:?}");
}

/// A corner that passes a face at 1e-12, or 1e-12 in it, as it turns by.
#[test]
fn grazing_is_told_from_touching() {
    let half = FRAC_1_SQRT_2;
    let (square, wall) = (cuboid([half, half, 0.5]), cuboid([0.5, 5.0, 5.0]));
    let turning = screw(Pose::IDENTITY, [0.0; 3], [0.0, 0.0, 0.5 * PI]);
    for (clearance, outcome) in
        [(1e-6, CastOutcome::Free), (1e-12, CastOutcome::Free), (-1e-6, CastOutcome::Hit), (-1e-12, CastOutcome::Hit)]
    {
        let still = Motion::Fixed(at(1.5 + clearance, 0.0, 0.0));
        let answer = run(moving([&square, &wall], [&turning, &still]), &CastConfig::default());
        assert_eq!(answer.outcome, outcome, "{clearance:e}: {answer:?}");
        assert!(answer.queries < 200, "{clearance:e}: {answer:?}");
        if outcome == CastOutcome::Hit {
            assert!(answer.time_lower < 0.5 && answer.time_upper < 0.501);
        }
    }
    // As near as rounding hides: no verdict, and an upper bound of the distance.
    let still = Motion::Fixed(at(1.5, 0.0, 0.0));
    let answer = run(moving([&square, &wall], [&turning, &still]), &CastConfig::default());
    assert_eq!(answer.outcome, CastOutcome::Near, "{answer:?}");
    assert!(answer.time_lower < 0.5 && answer.upper < 1e-12, "{answer:?}");
}

#[test]
fn a_margin_is_kept() {
    let cube = cuboid([0.5; 3]);
    let (still, passing) = (Motion::Fixed(Pose::IDENTITY), straight(at(-4.0, 0.0, 1.25), [8.0, 0.0, 0.0]));
    let bodies = moving([&cube, &cube], [&passing, &still]);
    let with = |max_distance: f64| run(bodies, &CastConfig { max_distance, ..CastConfig::default() });
    assert_eq!(with(0.2).outcome, CastOutcome::Free);
    let hit = with(0.5);
    assert_eq!(hit.outcome, CastOutcome::Hit);
    // The edges are 0.5 apart when they are √(0.5² − 0.25²) apart along the path.
    let first = (3.0 - 0.1875_f64.sqrt()) / 8.0;
    assert!(hit.time_lower < first && first < hit.time_upper && hit.time_upper - hit.time_lower <= 1e-9, "{hit:?}");
    assert!(hit.upper <= 0.5 && hit.upper > 0.499_999);
}

#[test]
fn a_range_of_times_is_kept_and_may_be_one_moment() {
    let cube = cuboid([0.5; 3]);
    let (still, falling) = (Motion::Fixed(Pose::IDENTITY), straight(at(0.0, 0.0, 3.0), [0.0, 0.0, -4.0]));
    let bodies = moving([&cube, &cube], [&falling, &still]);
    let of =
        |time_begin: f64, time_end: f64| run(bodies, &CastConfig { time_begin, time_end, ..CastConfig::default() });
    assert_eq!(of(-2.0, 0.4).outcome, CastOutcome::Free);
    assert_eq!(of(0.4, 0.4).outcome, CastOutcome::Free);
    assert_eq!(of(0.75, 3.0).outcome, CastOutcome::Hit);
    assert_eq!(of(1.25, 3.0).outcome, CastOutcome::Free);
    let inside = of(0.6, 0.6);
    assert_eq!((inside.outcome, inside.time_lower, inside.time_upper), (CastOutcome::Hit, 0.6, 0.6));
}

#[test]
fn an_affine_motion_and_a_callback_say_the_same() {
    let cube = cuboid([0.5; 3]);
    let still = Motion::Fixed(Pose::IDENTITY);
    let (start, end) = (at(0.0, 0.25, 3.0), at(0.0, 0.0, -1.0));
    let affine = Motion::Affine { start, end };
    let fall = |t: f64| at(0.0, 0.25 - 0.25 * t, 3.0 - 4.0 * t);
    let callback = Motion::Callback(Callback { pose: &fall, bend: 1e-3, rounding: 1e-14 });
    for motion in [&affine, &callback] {
        let answer = run(moving([&cube, &cube], [motion, &still]), &CastConfig::default());
        assert_eq!(answer.outcome, CastOutcome::Hit);
        assert!(
            answer.time_lower < 0.5 + 1e-14
                && 0.5 - 1e-14 < answer.time_upper
                && answer.time_upper - answer.time_lower <= 1e-9,
            "{answer:?}"
        );
    }
}

#[test]
fn a_budget_ends_it_with_what_is_proved() {
    let half = FRAC_1_SQRT_2;
    let (square, wall) = (cuboid([half, half, 0.5]), cuboid([0.5, 5.0, 5.0]));
    let turning = screw(Pose::IDENTITY, [0.0; 3], [0.0, 0.0, 0.5 * PI]);
    let still = Motion::Fixed(at(1.5 + 1e-9, 0.0, 0.0));
    let config = CastConfig { step_budget: 3, ..CastConfig::default() };
    let answer = run(moving([&square, &wall], [&turning, &still]), &config);
    assert_eq!((answer.outcome, answer.queries), (CastOutcome::Budget, 3));
    assert!(answer.time_lower > 0.1 && answer.time_lower < 0.5, "{answer:?}");
}
