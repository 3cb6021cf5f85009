//! A depth with a cache against the depth from nothing: a verdict and an interval must not be worse for what came before.

use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::pair::{DepthAnswer, DepthCache, Outcome};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};
use testkit::hard::families;
use testkit::shapes::cuboid;

use crate::{Random, query};

/// Queries of one pair with one cache, each compared with one of its own.
struct Stream<'a> {
    shapes: [&'a Shape; 2],
    cache: DepthCache,
    /// Intersecting pairs, and what was worse of them.
    overlapping: usize,
    worse: Vec<String>,
}

impl<'a> Stream<'a> {
    fn new(shapes: [&'a Shape; 2]) -> Stream<'a> {
        Stream { shapes, cache: DepthCache::default(), overlapping: 0, worse: Vec::new() }
    }

    /// Either interval may be as wide as is promised: 2e-14 of the size, or the distance of the origins.
    fn ask(&mut self, poses: [&Pose; 2]) {
        let warm = query(self.shapes, poses, &mut self.cache);
        let single = query(self.shapes, poses, &mut DepthCache::default());
        let told = || format!("{warm:?}\nalone: {single:?}\n{poses:?}");
        assert_eq!(warm.outcome, single.outcome, "{}", told());
        if single.outcome != Outcome::Intersecting {
            return;
        }
        self.overlapping += 1;
        assert!(warm.lower <= single.upper && single.lower <= warm.upper, "{}", told());
        let size: f64 = self.shapes.iter().map(|shape| shape.polyhedron().radius).sum();
        let apart = (poses[0].translation() - poses[1].translation()).norm();
        let width = |answer: &DepthAnswer| answer.upper - answer.lower;
        if width(&warm) > width(&single).max(2e-14 * size.max(apart)) {
            self.worse.push(told());
        }
    }
}

/// A unit cube at three sides of a cube of 2, faces parallel, 1.157e-6 deep. Cut-off: the polytope kept from the second pose has
/// all its triangles beyond the origin, and is not sure to surround it. Integers then said [0, 1.157e-6].
#[test]
fn what_is_kept_is_given_up_where_it_proves_nothing() {
    let shapes = [cuboid([0.5; 3]), cuboid([1.0; 3])];
    let mut stream = Stream::new([&shapes[0], &shapes[1]]);
    let depth = 1.4999988430422466;
    let turns = [
        (0.6526171884933876, -0.7576878019890424),
        (-0.7213959284745906, 0.6925228619910562),
        (-0.8640940920935978, -0.5033303090505687),
    ];
    let about_z = |(cosine, sine): (f64, f64)| Matrix::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
    let about_y = |(cosine, sine): (f64, f64)| Matrix::new(cosine, 0.0, -sine, 0.0, 1.0, 0.0, sine, 0.0, cosine);
    for pose in [
        Pose::new(&about_z(turns[0]), &Vector::new(-0.83475472150233, 0.8444343792585409, depth)),
        Pose::new(&about_y(turns[1]), &Vector::new(0.42039453896327983, depth, 0.07332210700724544)),
        Pose::new(&about_y(turns[2]), &Vector::new(0.4754355193827394, -depth, -1.1976335060193468)),
    ] {
        stream.ask([&pose, &Pose::IDENTITY]);
    }
    assert!(stream.worse.is_empty() && stream.overlapping == 3, "{:?}", stream.worse);
}

/// Cubes on sides of each other, moved along and turned about the normal.
#[test]
fn resting_cubes_are_as_deep_in_a_stream_as_alone() {
    let shapes = [cuboid([0.5; 3]), cuboid([1.0; 3])];
    let mut random = Random::new(81);
    let (mut overlapping, mut worse) = (0, Vec::new());
    for _ in 0..200 {
        let mut stream = Stream::new([&shapes[0], &shapes[1]]);
        let [depth, step] = [random.power(-40, -2), random.power(-30, 0)];
        let common = if random.below(2) == 0 { Matrix::identity() } else { random.rotation() };
        let (mut x, mut y, mut angle) = (random.signed(), random.signed(), random.signed());
        for _ in 0..20 {
            let (sine, cosine) = f64::sin_cos(angle);
            let turn = Matrix::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
            let on_top = Vector::new(x, y, 1.5 - depth);
            let poses = [Pose::new(&(common * turn), &(common * on_top)), Pose::new(&common, &Vector::zeros())];
            stream.ask([&poses[0], &poses[1]]);
            x += step * random.signed();
            y += step * random.signed();
            angle += if random.below(2) == 0 { step * random.signed() } else { 0.0 };
        }
        overlapping += stream.overlapping;
        worse.append(&mut stream.worse);
    }
    assert!(worse.is_empty() && overlapping > 2_000, "{} of {overlapping} worse: {:?}", worse.len(), worse.first());
}

#[test]
fn hard_families_are_as_deep_in_a_stream_as_alone() {
    let (mut overlapping, mut worse) = (0, Vec::new());
    let options = ShapeOptions { input: InputPolicy::Hull, ..ShapeOptions::default() };
    for family in families() {
        for index in 0..family.sweep.min(8) {
            let sequence = family.sequence(5, index);
            let [Ok(first), Ok(second)] = [0, 1].map(|i| Shape::from_mesh(&sequence.bodies[i], &options)) else {
                continue;
            };
            let mut stream = Stream::new([&first, &second]);
            for pose in sequence.poses.iter().step_by(1 + sequence.poses.len() / 60) {
                let [first, second] = [0, 12].map(|at| Pose::from_row_major(pose[at..at + 12].try_into().unwrap()));
                stream.ask([&first, &second]);
            }
            overlapping += stream.overlapping;
            worse.extend(stream.worse.iter().map(|what| format!("{}, {}: {what}", family.name, sequence.name)));
        }
    }
    assert!(worse.is_empty() && overlapping > 2_000, "{} of {overlapping} worse: {:?}", worse.len(), worse.first());
}
