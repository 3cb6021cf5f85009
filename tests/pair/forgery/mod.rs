//! A forger against `verify`: answers of every tier about bodies of every kind, each with one thing changed, by a unit in the last
//! place up to all of it. Whatever the oracle finds false must be refused; what the library said itself, and any interval that
//! holds to the last bit, must pass.

mod forgeries;
mod judge;
mod numbers;
mod scenes;

use std::collections::BTreeSet;

use forgeries::forgeries;
use judge::Judge;
use scenes::{SCENES, Scene, answers};
use swiftprox::error::Error;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{Outcome, PairAnswer};
use swiftprox::verify::verify;
use testkit::shapes::{at, cuboid};

impl Scene {
    fn verify(&self, poses: &[Pose; 2], answer: &PairAnswer) -> Result<(), Error> {
        verify([self.shapes[0].at(&poses[0]), self.shapes[1].at(&poses[1])], answer)
    }
}

/// Of the forgeries of each answer one in so many is tried, of every scene others.
const STRIDE: usize = 17;

#[test]
fn no_forgery_passes() {
    let (mut refused, mut passed) = (BTreeSet::new(), 0);
    let mut wrong = Vec::new();
    for (number, scene) in SCENES.iter().enumerate() {
        let judge = Judge::new(scene, scene.poses);
        for (query, answer) in answers(scene) {
            let mut report = |what: String| wrong.push(format!("{}, {query}: {what}: {answer:?}", scene.name));
            if let Err(error) = scene.verify(&scene.poses, &answer) {
                report(format!("the library's own answer is refused, {error}"));
            }
            if let Some(lie) = judge.lie_in(&answer, None) {
                report(format!("the library lies, {lie}"));
            }
            for (what, forged) in forgeries(&answer, &judge).into_iter().skip(number % STRIDE).step_by(STRIDE) {
                match (judge.lie_in(&forged, Some(&answer)), scene.verify(&scene.poses, &forged)) {
                    (Some(lie), Ok(())) => report(format!("{what} passes, though {lie}")),
                    (Some(_), Err(Error::Unverified(_) | Error::Argument(_))) => {
                        refused.insert((scene.family, query, what));
                    }
                    (None, Ok(())) => passed += 1,
                    (None, Err(Error::Unverified(_) | Error::Argument(_))) => {}
                    (_, Err(error)) => report(format!("{what}: {error}")),
                }
            }
        }
    }
    println!("{} kinds of forgeries refused, {passed} changed answers passed that are still true", refused.len());
    wrong.iter().take(20).for_each(|what| println!("{what}"));
    assert_eq!(wrong.len(), 0);
    assert!(refused.len() >= 1_000 && passed >= 1_000);
}

/// An answer for one pose against another, a unit in the last place away or more.
#[test]
fn no_answer_passes_for_another_pose() {
    let mut refused = 0;
    for (number, scene) in SCENES.iter().enumerate() {
        let answers = answers(scene);
        for (axis, steps) in [1, 64, 1 << 40, 1 << 51].into_iter().enumerate() {
            let mut poses = scene.poses;
            let moved = &mut poses[1].rows[(axis + number) % 3][3];
            *moved = f64::from_bits(moved.to_bits() + steps);
            let judge = Judge::new(scene, poses);
            for (query, answer) in &answers {
                if let Some(lie) = judge.lie_in(answer, None) {
                    let what = || format!("{}, {query}, {steps} steps, {lie}: {answer:?}", scene.name);
                    assert!(scene.verify(&poses, answer).is_err(), "{}", what());
                    refused += 1;
                }
            }
        }
    }
    println!("{refused} refused");
    assert!(refused > 300);
}

/// The intervals that hold to the last bit pass, and neither end may be a unit nearer.
#[test]
fn intervals_are_told_to_the_last_bit() {
    let mut told = 0;
    for scene in SCENES.iter() {
        let Some([below, above]) = Judge::new(scene, scene.poses).bounds else { continue };
        let (query, answer) = answers(scene)[0];
        if query != "distance" || below == 0.0 || above == f64::INFINITY {
            continue;
        }
        let said = |lower: f64, upper: f64| {
            scene.verify(&scene.poses, &PairAnswer { lower, distance: lower, upper, ..answer })
        };
        assert_eq!(said(below, above), Ok(()), "{}", scene.name);
        let (first_above, last_below) =
            if below == above { (above.next_up(), below.next_down()) } else { (above, below) };
        assert!(said(first_above, first_above).is_err(), "{}: lower {first_above:e}", scene.name);
        assert!(said(last_below, last_below).is_err(), "{}: upper {last_below:e}", scene.name);
        told += 1;
    }
    println!("{told} told");
    assert!(told > 30);
}

/// The normal tilted, and the interval of the gap along it and a little more.
#[test]
fn a_tilted_normal_proves_no_upper_end() {
    let cube = cuboid([0.5; 3]);
    let (here, there) = (at(0.0, 0.0, 0.0), at(-2.0, 0.0, 0.0));
    let nothing = [f64::NAN; 3];
    let tilted = PairAnswer {
        outcome: Outcome::Separated,
        lower: 0.060,
        distance: 0.060,
        upper: 0.121,
        normal: Vector::new(0.7_f64.cos(), 0.7_f64.sin(), 0.0).into(),
        local1: nothing,
        local2: nothing,
        world1: nothing,
        world2: nothing,
        ..PairAnswer::default()
    };
    let check = |answer: &PairAnswer| verify([cube.at(&here), cube.at(&there)], answer);
    assert!(matches!(check(&tilted), Err(Error::Unverified(m)) if m.contains("their distance is in [1e0, 1e0]")));
    // What it does prove may be said of it.
    assert_eq!(check(&PairAnswer { upper: 1.0, ..tilted }), Ok(()));
    for miss in [3.2e-14, f64::EPSILON / 2.0] {
        let close = PairAnswer { normal: [1.0, 0.0, 0.0], distance: 0.5, upper: 1.0 - miss, ..tilted };
        assert!(matches!(check(&close), Err(Error::Unverified(_))), "an upper end {miss:e} below");
        let close = PairAnswer { lower: 1.0 + 2.0 * miss, distance: 2.0, upper: 2.0, ..close };
        assert!(matches!(check(&close), Err(Error::Unverified(_))), "a lower end {miss:e} above");
    }
}
