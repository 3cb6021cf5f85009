//! Casts of scenes against integers: all pieces looked at all along the motion, and the first contact halved.

use std::sync::Arc;

use swiftprox::math::{Pose, Vector};
use swiftprox::motion::{CastConfig, CastOutcome, Motion, Screw};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ObjectSet, Scene, SceneCastAnswer, SetScratch};
use testkit::any_size::integers::place;
use testkit::any_size::nearest::nearest;
use testkit::casts::pose_at;
use testkit::oracle::rational;
use testkit::random::Random;
use testkit::shapes::hull;

/// Times that all pieces are looked at: fractions of a power of two, so that poses without turns are exact there.
const SAMPLES: u32 = 64;

/// Of the time between two samples, until poses without turns would be rounded.
const HALVINGS: u32 = 34;

/// A piece of one of two moving objects, or a body that rests.
struct Piece {
    /// Which object of the set.
    of: Option<usize>,
    points: Vec<[f64; 3]>,
    /// In its object, or in the world.
    place: Pose,
}

/// What moves past what.
struct Course {
    pieces: Vec<Piece>,
    screws: Vec<Screw>,
    max_distance: f64,
    among: bool,
}

/// Points of a lattice, not all in a plane.
fn lattice_points(random: &mut Random) -> Vec<[f64; 3]> {
    let corner = random.lattice(1);
    let sides = [0, 1, 2].map(|axis| Vector::ith(axis, 1.0 + random.below(2) as f64));
    let points = [Vector::zeros(), sides[0], sides[1], sides[2], sides[0] + sides[1] + sides[2]];
    points.map(|p| (corner + p).into()).to_vec()
}

/// Two objects of two pieces each come from two sides into a few bodies; on a lattice, or anyhow and turning.
fn course(random: &mut Random, turns: bool) -> Course {
    let mut pieces = Vec::new();
    for k in 0..9 {
        let of = (k < 4).then_some(k / 2);
        let place = match (turns, of) {
            (true, _) => Pose::new(&random.rotation(), &(random.vector() * if of.is_some() { 1.5 } else { 8.0 })),
            (false, Some(_)) => Pose::new(&random.quarter_turns(), &random.lattice(2)),
            (false, None) => Pose::new(&random.quarter_turns(), &random.lattice(8)),
        };
        pieces.push(Piece { of, points: lattice_points(random), place });
    }
    let screws = (0..2).map(|object| {
        let from = Vector::new(if object == 0 { 16.0 } else { -16.0 }, 0.0, 0.0) + random.lattice(7);
        let velocity = Vector::new(-2.0 * from.x, 0.0, 0.0) + random.lattice(4);
        if turns {
            let start = Pose::new(&random.rotation(), &from);
            return Screw { start, centre: random.vector(), velocity, rotation: random.vector() * 3.0 };
        }
        let start = Pose::new(&random.quarter_turns(), &from);
        Screw { start, centre: random.lattice(3), velocity, rotation: Vector::zeros() }
    });
    let screws = screws.collect();
    Course {
        pieces,
        screws,
        max_distance: if turns { 0.125 } else { random.pick(&[0.0, 0.5]) },
        among: random.below(2) == 0,
    }
}

impl Course {
    /// Where a piece is at a time: by formulas of the test, without turns exactly.
    fn pose(&self, piece: &Piece, time: f64) -> Pose {
        let Some(of) = piece.of else { return piece.place };
        let object = pose_at(&Motion::Screw(self.screws[of]), time);
        Pose::new(&(object.rotation() * piece.place.rotation()), &object.transform(&piece.place.translation()))
    }

    /// Whether some pair is no farther apart than a distance at a time, in integers.
    fn is_within(&self, time: f64, distance: f64) -> bool {
        let poses: Vec<Pose> = self.pieces.iter().map(|piece| self.pose(piece, time)).collect();
        let is_asked = |a: &Piece, b: &Piece| a.of.is_some() && a.of != b.of && (self.among || b.of.is_none());
        let indices = 0..self.pieces.len();
        indices.clone().any(|i| {
            (i + 1..indices.end).any(|k| {
                let [a, b] = [&self.pieces[i], &self.pieces[k]];
                // No point is farther than 6 from its frame's origin.
                let is_near = (poses[i].translation() - poses[k].translation()).norm() < 12.0 + distance;
                is_asked(a, b) && is_near && {
                    let rows = [poses[i].rows, poses[k].rows];
                    let pose_pair = std::array::from_fn(|n| rows[n / 12][n % 12 / 4][n % 4]);
                    let placed = place(&a.points, &b.points, &pose_pair);
                    nearest(&placed).world_square(&placed) <= rational(distance) * rational(distance)
                }
            })
        })
    }

    /// Asks the scene, its trees fitted or not.
    fn cast(&self, is_prepared: bool) -> SceneCastAnswer {
        let mut scene = Scene::new();
        let shape = |piece: &Piece| Arc::new(hull(&piece.points.iter().map(|p| Vector::from(*p)).collect::<Vec<_>>()));
        for piece in self.pieces.iter().filter(|piece| piece.of.is_none()) {
            let options = ObjectOptions { pose: piece.place, ..ObjectOptions::default() };
            scene.add_object(vec![shape(piece)], &options).unwrap();
        }
        let ids: Vec<ObjectId> = (0..2)
            .map(|object| {
                let pieces: Vec<&Piece> = self.pieces.iter().filter(|piece| piece.of == Some(object)).collect();
                let shapes = pieces.iter().map(|piece| shape(piece)).collect();
                let id = scene.add_object(shapes, &ObjectOptions::default()).unwrap();
                for (k, piece) in (0..).zip(&pieces) {
                    scene.set_piece_pose(id, k, &piece.place).unwrap();
                }
                id
            })
            .collect();
        if is_prepared {
            scene.prepare().unwrap();
        }
        let motions: Vec<Motion> = self.screws.iter().map(|screw| Motion::Screw(*screw)).collect();
        let config = CastConfig { max_distance: self.max_distance, ..CastConfig::default() };
        let set = ObjectSet { ids: &ids, poses: None, among: self.among };
        scene.cast(&set, &motions, &config, &mut SetScratch::default()).unwrap()
    }

    /// Refutes an answer by what integers say; `off` is how far poses of the test may be off. Returns whether there is contact.
    fn judge(&self, answer: &SceneCastAnswer, off: f64) -> bool {
        let told = format!("{answer:?}, max_distance {}", self.max_distance);
        let time = |k: u32| f64::from(k) / f64::from(SAMPLES);
        let first = (0..=SAMPLES).find(|&k| self.is_within(time(k), self.max_distance - off));
        if answer.outcome == CastOutcome::Hit {
            // Poses between fractions of a power of two are rounded.
            assert!(self.is_within(answer.time_upper, self.max_distance + 1e-12), "no contact at time_upper: {told}");
        } else {
            assert_ne!(answer.outcome, CastOutcome::Budget);
        }
        let Some(first) = first else { return false };
        assert_ne!(answer.outcome, CastOutcome::Free, "contact at {}: {told}", time(first));
        // Halved to where contact begins, of several such times to one.
        let (mut apart, mut within) = (time(first.saturating_sub(1)), time(first));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (apart + within);
            *(if self.is_within(middle, self.max_distance - off) { &mut within } else { &mut apart }) = middle;
        }
        // Of the beginning itself nothing is said.
        assert!(answer.time_lower < within || within == 0.0 && answer.time_lower == 0.0, "contact at {within}: {told}");
        if answer.outcome == CastOutcome::Hit {
            assert!(answer.time_upper <= within + 1e-8, "contact at {within}: {told}");
        }
        true
    }
}

/// Pieces that have poses of their own, on a lattice without turns: faces, edges and corners touch, and everything is exact.
#[test]
fn pieces_on_a_lattice_meet_when_integers_say() {
    let mut random = Random::new(0x1a77);
    let mut counts = [0; 2];
    for round in 0..24 {
        let course = course(&mut random, false);
        counts[usize::from(course.judge(&course.cast(round % 2 == 0), 0.0))] += 1;
    }
    assert!(counts.iter().all(|&count| count > 2), "{counts:?}");
}

/// The same anyhow and turning, within `max_distance`.
#[test]
fn turning_pieces_come_near_when_integers_say() {
    let mut random = Random::new(0x7a17);
    let mut counts = [0; 2];
    for round in 0..16 {
        let course = course(&mut random, true);
        counts[usize::from(course.judge(&course.cast(round % 2 == 0), 1e-12))] += 1;
    }
    assert!(counts.iter().all(|&count| count > 2), "{counts:?}");
}
