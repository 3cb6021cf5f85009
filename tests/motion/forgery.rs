//! Forged answers are refused.

use swiftprox::error::Error;
use swiftprox::math::Pose;
use swiftprox::motion::{CastAnswer, CastConfig, CastOutcome, Motion, verify_cast};
use testkit::shapes::cuboid;

use crate::{at, moving, run, screw, straight};

#[test]
fn forged_answers_are_refused() {
    let (cube, bar) = (cuboid([0.5; 3]), cuboid([0.1, 0.2, 2.0]));
    let still = Motion::Fixed(Pose::IDENTITY);
    let hitting = screw(at(3.0, 0.1, 0.2), [-4.0, 0.0, 0.0], [1.0, 2.0, 0.5]);
    let missing = screw(at(-4.0, 3.2, 0.2), [8.0, 0.0, 0.0], [0.4, 0.2, 0.5]);
    let margin = CastConfig { margin: 0.1, ..CastConfig::default() };
    for config in [CastConfig::default(), margin] {
        let hit = moving([&bar, &cube], [&hitting, &still]);
        let answer = run(hit, &config);
        assert_eq!(answer.outcome, CastOutcome::Hit);
        verify_cast(hit, &config, &answer).unwrap();
        let later = CastAnswer { t_lo: answer.t_hi, ..answer };
        let sooner = CastAnswer { t_hi: answer.t_lo, ..answer };
        let outside = CastAnswer { t_hi: 1.5, ..answer };
        let swapped = CastAnswer { t_lo: answer.t_hi, t_hi: answer.t_lo, ..answer };
        let no_contact = CastAnswer { contact: Default::default(), ..answer };
        let none = CastAnswer { t_lo: f64::NAN, ..answer };
        let free =
            CastAnswer { outcome: CastOutcome::Free, t_lo: 1.0, clearance: config.margin, ..CastAnswer::default() };
        let beyond = CastAnswer { outcome: CastOutcome::Budget, t_lo: 0.9, ..CastAnswer::default() };
        for forged in [later, sooner, outside, swapped, no_contact, none, free, beyond] {
            let refused = verify_cast(hit, &config, &forged);
            assert!(matches!(refused, Err(Error::Unverified(_))), "{forged:?}: {refused:?}");
        }
        let said_nothing = verify_cast(hit, &config, &CastAnswer::default());
        assert!(matches!(said_nothing, Err(Error::Argument(_))), "{said_nothing:?}");

        let free = moving([&bar, &cube], [&missing, &still]);
        let answer = run(free, &config);
        assert_eq!(answer.outcome, CastOutcome::Free, "{answer:?}");
        verify_cast(free, &config, &answer).unwrap();
        let too_far = CastAnswer { clearance: 5.0, ..answer };
        let too_near = CastAnswer { clearance: config.margin - 0.01, ..answer };
        let partial = CastAnswer { t_lo: 0.5, ..answer };
        let with_time = CastAnswer { t_hi: 0.5, ..answer };
        let as_near = CastAnswer { outcome: CastOutcome::Near, upper: 0.01, ..answer };
        for forged in [too_far, too_near, partial, with_time, as_near] {
            let refused = verify_cast(free, &config, &forged);
            assert!(matches!(refused, Err(Error::Unverified(_))), "{forged:?}: {refused:?}");
        }
        // Of other motions neither holds.
        let other = straight(at(3.0, 0.1, 0.2), [-4.0, 0.0, 0.0]);
        assert!(verify_cast(moving([&bar, &cube], [&other, &still]), &config, &answer).is_err());
    }
}
