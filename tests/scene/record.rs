//! Recordings: what is done to a scene is done again with the same answers, and no file does harm.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use swiftprox::error::{Error, Result};
use swiftprox::math::Pose;
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::scene::{ContactDetail, PairFilter, PiecePairs, Query, Replay, Scene, SceneQuery, Workers};
use testkit::random_scene::{Random, cuboid, ellipsoid, random_pose};
use testkit::shapes::at;

/// What a recording is written to, kept by the test.
#[derive(Clone, Default)]
pub struct Tape(Arc<Mutex<Vec<u8>>>);

impl Tape {
    pub fn bytes(&self) -> Vec<u8> {
        self.0.lock().unwrap().clone()
    }
}

impl Write for Tape {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// What a replay came to.
#[derive(Debug, Default, PartialEq)]
pub struct Played {
    pub steps: usize,
    pub asked: usize,
    pub identical: usize,
    pub cut_off: bool,
}

/// Plays a recording to its end.
pub fn play(bytes: &[u8], workers: Option<Workers>) -> Result<Played> {
    let mut replay = Replay::from_reader(io::Cursor::new(bytes.to_vec()))?;
    let mut scene = Scene::new();
    scene.set_workers(workers);
    let mut played = Played::default();
    while let Some(step) = replay.read()? {
        replay.change(&mut scene)?;
        played.steps += 1;
        if step.query.is_some() {
            played.asked += 1;
            match replay.ask(&mut scene, None) {
                Ok(answer) => {
                    answer.check?;
                    played.identical += usize::from(answer.is_identical);
                }
                // A query that was refused, and the refusal is cut off.
                Err(Error::Argument(_)) if replay.is_cut_off() => {}
                Err(error) => return Err(error),
            }
        }
    }
    played.cut_off = replay.is_cut_off();
    Ok(played)
}

fn scene() -> Scene {
    Scene::new()
}

/// A filter, which is not asked of objects that are gone.
fn by_threes(object1: ObjectId, object2: ObjectId) -> bool {
    assert!(object1 != ObjectId::NULL && object2 != ObjectId::NULL);
    !(object1.to_bits() + object2.to_bits()).is_multiple_of(3)
}

/// Every call there is, in turns: how many queries it made.
fn session(scene: &mut Scene, rounds: usize) -> usize {
    let mut random = Random::new(0x7ec0);
    let shapes = [cuboid([0.5, 0.3, 0.2]), ellipsoid(&mut random, 40, [0.6, 0.4, 0.2], Default::default())];
    let mut ids: Vec<ObjectId> = Vec::new();
    let mut asked = 0;
    for round in 0..rounds {
        let pieces = [shapes[round % 2].clone(), shapes[1].clone()];
        let options =
            ObjectOptions { pose: random_pose(&mut random, 2.0), user_data: round as u64, ..Default::default() };
        ids.push(scene.add_object(pieces[..1 + round % 2].to_vec(), &options).unwrap());
        let any = ids[random.below(ids.len())];
        match round % 14 {
            0 => scene.set_pose(any, &random_pose(&mut random, 2.0)).unwrap(),
            1 => ids.push(scene.copy_object(any).unwrap()),
            2 => scene.set_piece_pose(any, 0, &random_pose(&mut random, 0.3)).unwrap(),
            3 => scene.set_fixed(any, round % 4 == 1).unwrap(),
            4 => scene.set_filter(any, 2, u32::MAX).unwrap(),
            5 => scene.set_user_data(any, 77).unwrap(),
            6 if ids.len() > 1 => scene.set_pair_active(ids[0], ids[1], false).unwrap(),
            7 => scene.set_object_active(any, round % 4 == 1).unwrap(),
            8 => scene.set_all_active(round % 3 > 0),
            9 => scene.set_pair_filter(Some(PairFilter::new(by_threes))),
            10 => scene.filter_again(),
            11 => scene.set_pairs(Some(&[[ids[0], ids[2]], [ids[1], ids[3]], [ids[4], ids[2]]])).unwrap(),
            12 => scene.set_pairs(None).unwrap(),
            _ => scene.set_pair_filter(None),
        }
        let moving = scene.objects().filter(|object| !object.fixed()).count();
        let poses: Vec<Pose> = (0..moving).map(|_| random_pose(&mut random, 2.0)).collect();
        if round % 3 == 0 {
            scene.set_all_poses(&poses).unwrap();
        } else {
            let some: Vec<ObjectId> = ids.iter().copied().take(3.min(moving)).collect();
            scene.set_poses(&some, &poses[..some.len()]).unwrap();
        }
        let near = SceneQuery {
            max_distance: 0.4,
            early_exit: round % 11 == 0,
            piece_pairs: [PiecePairs::Every, PiecePairs::First, PiecePairs::Nearest][round % 3],
            ..SceneQuery::default()
        };
        let shape = &shapes[round % 2];
        match round % 8 {
            0 => drop(scene.query_intersection(&near).unwrap()),
            1 => drop(scene.query_distance(&near).unwrap()),
            2 => drop(scene.query_contact(&SceneQuery { detail: ContactDetail::Manifold, ..near }).unwrap()),
            3 => drop(scene.query_approximate(&SceneQuery { error_budget: 0.3, ..near }).unwrap()),
            4 => drop(scene.query_object(any, Query::Distance, &near).unwrap()),
            5 => drop(scene.query_placed(shape, &random_pose(&mut random, 1.0), Query::Contact, &near).unwrap()),
            6 => drop(scene.query_events(0.2).unwrap()),
            _ => drop(scene.query_distance(&SceneQuery::default()).unwrap()),
        }
        asked += 1;
        if round % 9 == 8 {
            let gone = ids.remove(5);
            scene.remove_object(gone).unwrap();
        }
        if round % 10 == 7 {
            scene.shrink().unwrap();
        }
        // Refused: nothing changes, and a replay does not trip over it.
        assert!(scene.query_distance(&SceneQuery { max_distance: f64::NAN, ..near }).is_err());
        assert!(scene.set_pose(ObjectId::NULL, &Pose::IDENTITY).is_err());
    }
    asked
}

fn recorded(rounds: usize) -> (Vec<u8>, usize) {
    let (tape, mut scene) = (Tape::default(), scene());
    scene.record_to(tape.clone()).unwrap();
    assert!(scene.is_recording());
    let asked = session(&mut scene, rounds);
    scene.end_recording().unwrap();
    assert!(!scene.is_recording());
    (tape.bytes(), asked)
}

#[test]
fn a_session_played_again_answers_the_same_bits() {
    let (bytes, asked) = recorded(if cfg!(miri) { 15 } else { 120 });
    for workers in [None, Some(Workers::threads(2))] {
        let played = play(&bytes, workers).unwrap();
        assert_eq!((played.asked, played.identical, played.cut_off), (asked, asked, false));
    }
    // Recording what is played gives the recording.
    let (tape, mut replay) = (Tape::default(), Replay::from_reader(io::Cursor::new(bytes.clone())).unwrap());
    let mut scene = Scene::new();
    scene.record_to(tape.clone()).unwrap();
    while let Some(step) = replay.read().unwrap() {
        replay.change(&mut scene).unwrap();
        if step.query.is_some() {
            replay.ask(&mut scene, None).unwrap();
        }
    }
    scene.end_recording().unwrap();
    let again = play(&tape.bytes(), None).unwrap();
    assert_eq!((again.asked, again.identical), (asked, asked));
}

#[test]
fn a_scene_recorded_from_the_middle_of_its_life_lists_the_same() {
    let (tape, mut scene) = (Tape::default(), scene());
    session(&mut scene, 65);
    scene.set_pair_filter(Some(PairFilter::new(|a, b| !(a.to_bits() + b.to_bits()).is_multiple_of(5))));
    scene.query_events(0.3).unwrap();
    scene.record_to(tape.clone()).unwrap();
    let queries = [0.0, 0.2, 1.0].map(|max_distance| SceneQuery { max_distance, ..Default::default() });
    let ids: Vec<ObjectId> = scene.objects().map(|object| object.id()).collect();
    let mut random = Random::new(5);
    for step in 0..30 {
        scene.set_pose(ids[step % ids.len()], &random_pose(&mut random, 2.0)).unwrap();
        scene.query_distance(&queries[step % 3]).unwrap();
        scene.query_events(0.3).unwrap();
    }
    scene.query_distance(&SceneQuery::default()).unwrap();
    drop(scene);
    let played = play(&tape.bytes(), None).unwrap();
    assert_eq!((played.asked, played.cut_off), (61, false));
}

#[test]
fn another_answer_than_the_recorded_one_is_found() {
    let (tape, mut recorded) = (Tape::default(), scene());
    let cube = cuboid([0.5; 3]);
    recorded.record_to(tape.clone()).unwrap();
    for x in [0.0, 2.0] {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..Default::default() };
        recorded.add_object(vec![cube.clone()], &options).unwrap();
    }
    recorded.query_distance(&SceneQuery::default()).unwrap();
    recorded.end_recording().unwrap();
    // The program does what was not recorded.
    for (x, tells) in [(5.0, "nothing in common"), (0.9, "not the recorded one"), (2.0, "")] {
        let mut replay = Replay::from_reader(io::Cursor::new(tape.bytes())).unwrap();
        let mut scene = scene();
        assert!(replay.is_whole());
        replay.read().unwrap();
        assert!(matches!(replay.read(), Err(Error::Argument(_))), "the step is not done");
        assert!(matches!(replay.ask(&mut scene, None), Err(Error::Argument(_))), "the step is not done");
        replay.change(&mut scene).unwrap();
        let second = scene.objects().nth(1).unwrap().id();
        assert_eq!(replay.number(&scene, second).unwrap(), 1);
        scene.set_pose(second, &at(x, 0.0, 0.0)).unwrap();
        let answer = replay.ask(&mut scene, None).unwrap();
        assert_eq!((answer.answer.pairs.len(), answer.is_identical), (1, tells.is_empty()));
        match answer.check {
            Err(Error::Unverified(message)) => assert!(!tells.is_empty() && message.contains(tells), "{message}"),
            other => assert!(tells.is_empty() && other.is_ok()),
        }
    }
}

#[test]
fn every_part_of_a_file_is_read_to_its_last_whole_record() {
    let (bytes, _) = recorded(6);
    let whole = play(&bytes, None).unwrap();
    let mut steps = 0;
    for length in (0..bytes.len()).step_by(if cfg!(miri) { 997 } else { 7 }) {
        match play(&bytes[..length], None) {
            Ok(played) => {
                assert!(played.cut_off && played.steps >= steps && played.steps <= whole.steps, "{length}: {played:?}");
                steps = played.steps;
            }
            Err(Error::File(message)) => assert!(length < 60, "{length}: {message}"),
            other => panic!("{length}: {other:?}"),
        }
    }
    assert!(steps + 1 >= whole.steps);
    let mut longer = bytes.clone();
    longer.push(0);
    assert!(matches!(play(&longer, None), Err(Error::File(message)) if message.contains("it is the last")));
}

#[test]
fn a_changed_byte_is_found_and_its_place_told() {
    let (bytes, _) = recorded(4);
    let mut random = Random::new(8);
    for _ in 0..if cfg!(miri) { 10 } else { 2_000 } {
        let mut changed = bytes.clone();
        let place = random.below(changed.len());
        changed[place] ^= 1 << random.below(8);
        match play(&changed, None) {
            Err(Error::File(message)) => {
                let told: Option<usize> = message
                    .split("at byte ")
                    .nth(1)
                    .and_then(|rest| rest.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok());
                assert!(place < 12 || told.is_some_and(|start| start <= place), "{place}: {message}");
            }
            other => panic!("{place}: {other:?}"),
        }
    }
}

/// A recorded scene of two cubes that overlap.
fn two_cubes() -> (Tape, Scene, [ObjectId; 2]) {
    let (tape, mut recorded) = (Tape::default(), scene());
    recorded.record_to(tape.clone()).unwrap();
    let cube = cuboid([0.5; 3]);
    let ids = [0.0, 0.5].map(|x| {
        let options = ObjectOptions { pose: at(x, 0.0, 0.0), ..Default::default() };
        recorded.add_object(vec![cube.clone()], &options).unwrap()
    });
    (tape, recorded, ids)
}

#[test]
fn a_question_that_ends_the_program_is_the_last_record() {
    let (tape, mut recorded, ids) = two_cubes();
    let during = Arc::new(Mutex::new(Vec::new()));
    let (seen, copy) = (during.clone(), tape.clone());
    recorded.set_pair_filter(Some(PairFilter::new(move |_, _| {
        *seen.lock().unwrap() = copy.bytes();
        true
    })));
    recorded.set_pose(ids[0], &at(0.1, 0.0, 0.0)).unwrap();
    recorded.query_contact(&SceneQuery::default()).unwrap();
    let bytes = during.lock().unwrap().clone();
    assert_eq!(play(&bytes, None).unwrap(), Played { steps: 1, asked: 1, identical: 0, cut_off: true });
}

#[test]
fn what_another_filter_said_is_not_remembered() {
    let (tape, mut recorded, ids) = two_cubes();
    let touching = SceneQuery { max_distance: 0.0, ..SceneQuery::default() };
    // The pair is liked while it is near; then it is not, and nobody is asked until it is near again.
    recorded.set_pair_filter(Some(PairFilter::new(|_, _| true)));
    for (x, count) in [(0.5, 1), (50.0, 0), (60.0, 0), (0.5, 0)] {
        recorded.set_pose(ids[1], &at(x, 0.0, 0.0)).unwrap();
        if x == 60.0 {
            recorded.set_pair_filter(Some(PairFilter::new(|_, _| false)));
        }
        assert_eq!(recorded.query_distance(&touching).unwrap().pairs.len(), count);
    }
    recorded.end_recording().unwrap();
    let mut replay = Replay::from_reader(io::Cursor::new(tape.bytes())).unwrap();
    let mut scene = scene();
    while replay.read().unwrap().is_some() {
        replay.change(&mut scene).unwrap();
        replay.ask(&mut scene, None).unwrap().check.unwrap();
        // Here all pairs are near.
        scene.query_distance(&SceneQuery::default()).unwrap();
    }
}

/// Takes so many bytes.
struct Full(usize);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 = self.0.checked_sub(bytes.len()).ok_or_else(|| io::Error::other("the disk is full"))?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_write_that_fails_ends_the_recording_and_nothing_else() {
    for room in [0, 1_000, 30_000] {
        let mut scene = scene();
        scene.record_to(Full(room)).unwrap();
        session(&mut scene, 40);
        assert!(!scene.is_recording());
        let error = scene.end_recording().unwrap_err();
        assert!(matches!(&error, Error::File(message) if message.contains("the disk is full")), "{error:?}");
        scene.end_recording().unwrap();
        scene.record_to(Tape::default()).unwrap();
        assert!(scene.is_recording());
    }
}

#[test]
fn files_are_recordings_or_refused() {
    let folder = std::env::temp_dir().join(format!("swiftprox-recordings-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("scene.swiftprox");
    let mut recorded = scene();
    recorded.record(&path).unwrap();
    let asked = session(&mut recorded, 20);
    // Another recording ends the first.
    let second = folder.join("second.swiftprox");
    recorded.record(&second).unwrap();
    recorded.query_distance(&SceneQuery::default()).unwrap();
    drop(recorded);
    assert_eq!(play(&std::fs::read(&path).unwrap(), None).unwrap().identical, asked);
    let mut replay = Replay::open(&second).unwrap();
    assert!(!replay.is_whole());
    assert!(replay.read().unwrap().is_some_and(|step| step.query.is_some() && step.fraction > 0.9));
    assert!(matches!(scene().record(&folder), Err(Error::File(_))));
    for (bytes, tells) in [
        (&b"# swiftprox scene 1\nshape a b\n"[..], "no recording"),
        (b"SWFTREC\x1a\x01\0\0\0", "version 1"),
        (b"SWFTREC\x1a", "before its first record"),
        (b"", "no recording"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let error = Replay::open(&path).unwrap_err();
        assert!(matches!(&error, Error::File(message) if message.contains(tells)), "{error:?}");
    }
    assert!(matches!(Replay::open(&folder.join("none")), Err(Error::File(_))));
    std::fs::remove_dir_all(&folder).unwrap();
}
