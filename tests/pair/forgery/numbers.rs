//! Numbers that are none, put into every member of every answer.

use swiftprox::error::Error;
use swiftprox::pair::{Outcome, PairAnswer};

use super::judge::Judge;
use super::scenes::{SCENES, answers};

/// Every number of an answer, with its name.
fn members(answer: &mut PairAnswer) -> Vec<(String, &mut f64)> {
    let PairAnswer { distance, lower, upper, local1, local2, world1, world2, normal, .. } = answer;
    let mut members = vec![("distance".into(), distance), ("lower".into(), lower), ("upper".into(), upper)];
    for (name, vector) in
        [("local1", local1), ("local2", local2), ("world1", world1), ("world2", world2), ("normal", normal)]
    {
        members.extend(vector.iter_mut().enumerate().map(|(axis, x)| (format!("{name}[{axis}]"), x)));
    }
    members
}

/// A NaN in `world1` passed: the length of a vector was computed from its largest coordinate, and a NaN was passed over there.
#[test]
fn no_number_may_be_none() {
    let (mut refused, mut wrong) = (0, Vec::new());
    for scene in SCENES.iter() {
        let judge = Judge::new(scene, scene.poses);
        for (query, answer) in answers(scene) {
            for member in 0..18 {
                for put in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0] {
                    let mut forged = answer;
                    let (what, number) = members(&mut forged).swap_remove(member);
                    let before = std::mem::replace(number, put);
                    // NaN in place of NaN is no forgery. Without points the upper end may be open: that is true of any pair.
                    let is_same = before == put || before.is_nan() && put.is_nan();
                    let may_be_open = forged.outcome == Outcome::Undecided
                        || forged.outcome == Outcome::Separated && forged.local1[0].is_nan();
                    let says_nothing = may_be_open && forged.upper == f64::INFINITY;
                    let is_none = !(put.is_finite() || is_same || what == "upper" && says_nothing);
                    let is_lie = is_none || judge.lie_in(&forged, Some(&answer)).is_some();
                    match scene.verify(&scene.poses, &forged) {
                        Err(Error::Unverified(_)) if is_lie => refused += 1,
                        Err(Error::Unverified(_)) => {}
                        Ok(()) if !is_lie => {}
                        other => wrong.push(format!("{}, {query}: {what} {put}: {other:?}, {answer:?}", scene.name)),
                    }
                }
            }
        }
    }
    wrong.iter().take(20).for_each(|what| println!("{what}"));
    assert_eq!(wrong.len(), 0);
    assert!(refused > 5_000, "{refused}");
}
