//! What a level may add to a distance: no less than that, and no more than a query allows.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{self, DecidedBy, Levels, PairAnswer, PairCache, PairConfig};
use swiftprox::progress::Progress;
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::shapes::at;

/// 26 points on the unit sphere whose level is an octahedron, and a point. Along an axis it stands off by √3 − 1.
fn ball_and_point() -> [Shape; 2] {
    let directions = (0..27).filter(|k| *k != 13).map(|k| [k / 9, k / 3 % 3, k % 3].map(|x| f64::from(x) - 1.0));
    let ball: Vec<Vector> = directions.map(|direction| Vector::from(direction).normalize()).collect();
    let octahedron = [Vector::x(), Vector::y(), Vector::z()].map(|axis| [axis, -axis]).concat();
    let levels = [ball, octahedron].map(|points| PolygonMesh::new(points, Vec::new(), None).unwrap());
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    let ball = Shape::from_levels(&levels, &options, &mut Progress::new(&mut |_| true)).unwrap();
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
    // What the level stands off in its own frame is too little.
    assert!(by_level.lower + (3.0_f64.sqrt() - 1.0) < exact.lower - 1e-3, "{by_level:?} {exact:?}");
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
