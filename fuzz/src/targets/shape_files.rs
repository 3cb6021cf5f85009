//! Saved shapes: what is saved loads as the same; a file of any content, even with a checksum that is right, is an error or a sound
//! shape, whose answers verify.

use arbitrary::{Result, Unstructured};
use swiftprox::error::Error;
use swiftprox::pair::contact;
use swiftprox::pair::{PairAnswer, PairCache, PairConfig};
use swiftprox::shape::Shape;
use swiftprox::shape_file::{from_bytes, to_bytes};
use swiftprox::verify::verify;

use crate::geometry::{hull_options, points, pose};

const MOST_POINTS: usize = 24;

pub fn run(bytes: &[u8]) {
    let _: Result<()> = run_from(&mut Unstructured::new(bytes));
}

fn run_from(u: &mut Unstructured) -> Result<()> {
    let (options, points) = (hull_options(u)?, points(u, MOST_POINTS)?);
    let Ok(shape) = Shape::from_points(&points, &options) else { return Ok(()) };
    let mut file = to_bytes(&shape).unwrap();
    assert!(from_bytes(&file).is_ok_and(|loaded| loaded == shape), "{options:?} of {points:?}");
    let poses = [pose(u)?, pose(u)?];
    if u.ratio(1, 16)? {
        file.truncate(12);
        file.extend(u.arbitrary::<[u8; 64]>()?);
        file.extend([0; 8]);
    }
    for _ in 0..u.int_in_range(1..=6)? {
        damage(u, &mut file)?;
    }
    if u.ratio(15, 16)? {
        correct_checksum(&mut file);
    }
    match from_bytes(&file) {
        Ok(loaded) => {
            assert!(from_bytes(&to_bytes(&loaded).unwrap()).is_ok_and(|again| again == loaded), "{file:?}");
            check_answers(&loaded, &shape, poses);
        }
        Err(error) => assert!(matches!(error, Error::File(_)), "{error:?}"),
    }
    Ok(())
}

/// Some bytes changed, anywhere; as numbers of 32 bits by little, so that indices stay indices, or at random.
fn damage(u: &mut Unstructured, file: &mut [u8]) -> Result<()> {
    let at = u.choose_index(file.len())?;
    if u.arbitrary()? {
        file[at] = u.arbitrary()?;
    } else {
        let at = at & !3;
        if let Some(word) = file.get_mut(at..at + 4).and_then(|bytes| <&mut [u8; 4]>::try_from(bytes).ok()) {
            *word = u32::from_le_bytes(*word).wrapping_add_signed(u.int_in_range(-2..=2)?).to_le_bytes();
        }
    }
    Ok(())
}

/// The checksum of `shape_file`, FNV-1a.
fn correct_checksum(file: &mut [u8]) {
    if let Some((content, sum)) = file.split_last_chunk_mut::<8>() {
        let fold = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        *sum = content.iter().fold(0xcbf2_9ce4_8422_2325, fold).to_le_bytes();
    }
}

fn check_answers(one: &Shape, other: &Shape, [pose1, pose2]: [swiftprox::math::Pose; 2]) {
    if [pose1, pose2].iter().any(|pose| pose.check().is_err()) {
        return;
    }
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    for _ in 0..2 {
        contact([one.at(&pose1), other.at(&pose2)], &mut cache, &PairConfig::default(), &mut answer)
            .expect("accepted poses");
        match verify([one.at(&pose1), other.at(&pose2)], &answer) {
            // Beyond the range of doubles.
            Ok(()) | Err(Error::Argument(_)) => {}
            Err(error) => panic!("{error}: {answer:?}"),
        }
    }
}
