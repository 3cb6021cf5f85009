//! What a level may add to a distance: no less than that, and no more than a query allows.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{self, DecidedBy, Levels, PairAnswer, PairCache, PairConfig};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::models::ellipsoid;
use testkit::shapes::at;

/// A ball of radius 1 whose level is an octahedron around it, and a point. Along an axis the octahedron stands off by √3 − 1.
fn ball_and_point() -> [Shape; 2] {
    let axes = [Vector::x(), Vector::y(), Vector::z()];
    let corners = axes.map(|axis| [axis, -axis]).concat();
    let mut octahedron = ellipsoid([1.0; 3], 200).unwrap();
    let mut levels = vec![octahedron.clone()];
    octahedron.vertices = corners;
    octahedron.starts = (0..=8).map(|f| 3 * f).collect();
    octahedron.indices = vec![0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5];
    levels.push(octahedron);
    let ball = Shape::from_levels(&levels, &ShapeOptions::default(), &mut Progress::new(&mut |_| true)).unwrap();
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    [ball, Shape::from_points(&[Vector::zeros()], &options).unwrap()]
}

fn ask(shapes: &[Shape; 2], poses: &[Pose; 2], config: &PairConfig) -> PairAnswer {
    let mut answer = PairAnswer::default();
    let placed = [shapes[0].at(&poses[0]), shapes[1].at(&poses[1])];
    pair::approximate(placed, &mut PairCache::default(), config, &mut answer).unwrap();
    answer
}

/// Rotations may stretch by half a hundredth, and what a level stands off is stretched with them. The upper end of an interval that
/// leaves this out is 0.003 too low where a corner of the level is nearest.
#[test]
fn what_a_level_stands_off_is_stretched_with_its_body() {
    let shapes = ball_and_point();
    let stretched = Pose::new(&(Matrix::identity() * 1.004), &Vector::zeros());
    let poses = [stretched, at(4.0, 0.0, 0.0)];
    let config = PairConfig { absolute_error: 1.0, levels: Levels::All, ..PairConfig::default() };
    let by_level = ask(&shapes, &poses, &config);
    assert_eq!((by_level.decided_by, by_level.statistics.levels), (DecidedBy::Tolerance, [1, 0]));
    let exact = ask(&shapes, &poses, &PairConfig { levels: Levels::None, ..PairConfig::default() });
    assert!(by_level.lower <= exact.lower && exact.upper <= by_level.upper, "{by_level:?} {exact:?}");
}

/// The level alone says so much, and whoever asks for a little less is answered by the body.
#[test]
fn an_answer_is_no_wider_than_asked_for() {
    let shapes = ball_and_point();
    let poses = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0)];
    let levels = Levels::All;
    let generous = ask(&shapes, &poses, &PairConfig { absolute_error: 1.0, levels, ..PairConfig::default() });
    let width = generous.upper - generous.lower;
    assert!(width > 0.5 && generous.statistics.levels == [1, 0], "{generous:?}");
    for share in [0.51, 0.75, 0.999] {
        let absolute = PairConfig { absolute_error: share * width, levels, ..PairConfig::default() };
        let relative = PairConfig { relative_error: share * width / generous.lower, levels, ..PairConfig::default() };
        for config in [absolute, relative] {
            let answer = ask(&shapes, &poses, &config);
            let most = config.absolute_error.max(config.relative_error * answer.lower);
            assert!(answer.upper - answer.lower <= most, "{answer:?} for {config:?}");
        }
    }
}
