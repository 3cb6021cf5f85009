//! Recordings of scenes: records of any content, with checksums that are right and in frames that are whole most of the time, and
//! bytes of any kind. A replay ends, refuses or does what a program could; nothing panics.

use std::io::Cursor;

use arbitrary::{Result, Unstructured};
use swiftprox::error::Error;
use swiftprox::scene::{Replay, Scene};
use swiftprox::shape::Shape;
use swiftprox::shape_file::to_bytes;

use crate::geometry::{any_number, hull_options, points, pose};

const MOST_RECORDS: usize = 48;
const MOST_POINTS: usize = 8;

/// What records of each kind hold: n a number, N a list of them, p a pose, P a list of those, f a flag, u 64 bits, r a real, D a
/// list of pairs, F one of pairs with flags, q a query and what it is about, S a shape.
const LAYOUTS: [&str; 24] = [
    "", "rf", "S", "Npfunn", "n", "n", "nf", "nnn", "nu", "np", "NP", "P", "nnp", "nnf", "nf", "f", "f", "", "fD", "",
    "q", "F", "ffuurru", "",
];

pub fn run(bytes: &[u8]) {
    let mut u = Unstructured::new(bytes);
    let Ok(file) = recording(&mut u) else { return };
    if let Err(error) = play(file) {
        let is_refusal = matches!(
            error,
            Error::File(_)
                | Error::Argument(_)
                | Error::Handle(_)
                | Error::Pose(_)
                | Error::Memory(_)
                | Error::Limit(_)
        );
        assert!(is_refusal, "{error:?}");
    }
    if let Err(error) = play(bytes.to_vec()) {
        assert!(matches!(error, Error::File(_)), "{error:?}");
    }
}

fn play(file: Vec<u8>) -> swiftprox::error::Result<()> {
    let mut replay = Replay::from_reader(Cursor::new(file))?;
    let mut scene = Scene::new();
    while let Some(step) = replay.read()? {
        replay.change(&mut scene)?;
        if step.query.is_some() {
            // An answer need not be the one that these bytes say.
            replay.ask(&mut scene, None).map(|_| ())?;
        }
    }
    Ok(())
}

/// A file whose checksums are right.
fn recording(u: &mut Unstructured) -> Result<Vec<u8>> {
    let mut file = b"SWFTREC\x1a\x01\0\0\0".to_vec();
    let mut sum = checksum(0xcbf2_9ce4_8422_2325, &file);
    for place in 0..MOST_RECORDS {
        if place > 1 && u.is_empty() {
            break;
        }
        // A scene and a shape come first, most of the time.
        let kind = if place < 2 && !u.ratio(1, 32)? { place as u32 + 1 } else { u.int_in_range(0..=24)? };
        let mut content = Vec::new();
        for field in LAYOUTS.get(kind as usize).unwrap_or(&"nn").chars() {
            write(u, field, &mut content)?;
        }
        if u.ratio(1, 24)? && !content.is_empty() {
            let at = u.choose_index(content.len())?;
            content[at] = u.arbitrary()?;
        }
        if u.ratio(1, 48)? {
            content.truncate(u.int_in_range(0..=content.len())?);
        }
        let mut record = [kind.to_le_bytes(), (content.len() as u32).to_le_bytes()].concat();
        record.extend((checksum(sum, &record) as u32).to_le_bytes());
        record.extend(content);
        sum = checksum(sum, &record);
        record.extend(sum.to_le_bytes());
        sum = checksum(sum, &sum.to_le_bytes());
        file.extend(record);
    }
    Ok(file)
}

fn write(u: &mut Unstructured, field: char, to: &mut Vec<u8>) -> Result<()> {
    let mut last = 1.0;
    match field {
        'n' => to.extend(u.int_in_range(0..=5_u32)?.to_le_bytes()),
        'f' => to.push(u8::from(u.arbitrary::<bool>()?)),
        'u' => to.extend(u.arbitrary::<u64>()?.to_le_bytes()),
        'r' => to.extend(any_number(u, &mut last)?.to_le_bytes()),
        'p' => pose(u)?.rows.as_flattened().iter().for_each(|x| to.extend(x.to_le_bytes())),
        'N' | 'P' | 'D' | 'F' => {
            let count = u.int_in_range(0..=4_u32)?;
            to.extend(count.to_le_bytes());
            let item = match field {
                'N' => "n",
                'P' => "p",
                'D' => "nn",
                _ => "nnf",
            };
            for _ in 0..count {
                item.chars().try_for_each(|field| write(u, field, to))?;
            }
        }
        'q' => {
            let subject = u.int_in_range(0..=3_u8)?;
            to.push(subject);
            ["", "n", "np", ""][usize::from(subject)].chars().try_for_each(|field| write(u, field, to))?;
            to.extend(u.int_in_range(0..=3_u32)?.to_le_bytes());
            to.push(u8::from(u.ratio(1, 8)?));
            for _ in 0..5 {
                let number = if u.ratio(1, 8)? { any_number(u, &mut last)? } else { 0.5 };
                to.extend(number.to_le_bytes());
            }
            for most in [9, 2, 3, 3, 3] {
                to.extend(u.int_in_range(0..=most)?.max(u32::from(most == 9)).to_le_bytes());
            }
        }
        _ => {
            let (options, points) = (hull_options(u)?, points(u, MOST_POINTS)?);
            if let Ok(shape) = Shape::from_points(&points, &options) {
                to.extend(to_bytes(&shape).expect("memory"));
            }
        }
    }
    Ok(())
}

/// FNV-1a, going on from `sum`.
fn checksum(sum: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(sum, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3))
}
